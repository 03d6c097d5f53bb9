//! The boundary of cells as others meet it: the closest point on its smooth sheets where they are now, from the nearest of
//! its quadrature points.
//!
//! Where the closest point on a sheet is no point of the boundary it lies beyond an edge: the sheet on which the boundary
//! goes on is taken in too. On a face there are two coordinates, on an edge one, at a vertex none; in the plane a face is a
//! strip that reaches across it. On facets the closest point is that at which a step along `F^T (x - y)` leads back to it:
//! in a facet, on an edge or at a vertex.
//!
//! Contact of a boundary with itself takes what faces a site across a gap at the start: where the normals oppose each
//! other and each of both points lies before the other, not behind it. Beside the site the normals do not oppose each
//! other.

use super::foot::{Active, Chart, Found, across};
use super::{CellSolid, normal_now};
use crate::jets::FunctionJet;
use crate::shapes::{HalfSpace, spatial};
use rayon::prelude::*;
use signorini_geometry::bvh::Bvh;
use signorini_geometry::shape::{CurveJet, SurfaceJet};
use signorini_geometry::{Aabb, ImplicitShape, Looking, Matrix, Point, Vector};
use signorini_mechanics::pair::axis;
use signorini_mechanics::{Anchor, Foot, Function, Master, MasterProjection, MaterialPoint, Site};
use std::ops::Range;
use std::sync::{Arc, OnceLock};

/// Product of normals above which two points do not face each other.
const FACING: f64 = -0.3;
/// How far beside a point of the boundary material is looked for, in cells.
const BESIDE: f64 = 1e-6;
/// How far from the quadrature point that it started from, in cells, a closest point may lie.
const FARTHEST: f64 = 1.5;
/// Distance to an edge, in cells, that is none: direction and sign of the gap are those of the mean normal.
const TOUCHING: f64 = 1e-9;

/// A surface where it is now.
pub(super) struct BoundaryMaster<'a, const D: usize> {
    solid: &'a CellSolid<D>,
    u: &'a [f64],
    points: Range<usize>,
    /// Positions of the points now, and the tree of them; for searches only.
    now: OnceLock<(Vec<Point<3>>, Bvh)>,
}

/// Whether a point of the boundary with an outward normal of any length lies across a gap from another, at the start: the
/// normals oppose each other, and each of both points lies before the other.
fn faces<const D: usize>(own: &crate::cell::Site<D>, x: &Point<D>, normal: &Vector<D>) -> bool {
    let apart = x - own.x;
    own.normal.dot(normal) < FACING * normal.norm() && apart.dot(&own.normal) > 0.0 && apart.dot(normal) < 0.0
}

/// A closest point, and the sheets on which it lies.
struct OnSheets<const D: usize> {
    at: Found<D>,
    active: Active<D>,
    /// A normal at the start that tells outside from inside on an edge, where that of the sheets together does not.
    outward: Option<Vector<D>>,
}

impl<const D: usize> OnSheets<D> {
    fn new(at: Found<D>, active: Active<D>) -> Self {
        OnSheets { at, active, outward: None }
    }
}

/// Steps of the search on facets, and the last of them in cells: Newton's method then ends it.
const MOST_STEPS: usize = 50;
const LAST_STEP: f64 = 1e-8;

impl<'a, const D: usize> BoundaryMaster<'a, D> {
    pub fn new(solid: &'a CellSolid<D>, points: Range<usize>, u: &'a [f64]) -> Self {
        BoundaryMaster { solid, u, points, now: OnceLock::new() }
    }

    fn place(&self, number: usize) -> Point<3> {
        self.solid.point_now(number, self.u).0
    }

    fn now(&self) -> &(Vec<Point<3>>, Bvh) {
        // By one thread: others may wait for it, none of which it needs.
        self.now.get_or_init(|| with_tree(self.points.clone().map(|k| self.place(k)).collect()))
    }

    /// The nearest of the quadrature points that count.
    fn nearest_point(&self, x: &Point<3>, reach: f64, counts: impl Fn(&crate::cell::Site<D>) -> bool) -> Option<usize> {
        let limit = reach * reach;
        let mut best: Option<(f64, usize)> = None;
        let (now, bvh) = self.now();
        bvh.nearest(x, limit, |k| {
            let least = best.map_or(limit, |b| b.0);
            let number = self.points.start + k;
            if !counts(&self.solid.points[number]) {
                return least;
            }
            let square = (now[k] - x).norm_squared();
            // Of points at the same distance the one with the lowest number.
            let better = best.is_none_or(|b| square < b.0 || (square == b.0 && number < b.1));
            if square > limit || !better {
                return least;
            }
            best = Some((square, number));
            square
        });
        best.map(|b| b.1)
    }

    /// The closest point from a quadrature point.
    fn closest(&self, target: &Point<D>, number: usize) -> Option<OnSheets<D>> {
        let search = Search::new(self, target, number);
        let own = self.solid.sheets.number(number);
        if own.is_none()
            && let Some(found) = search.on_facets()
        {
            return Some(found);
        }
        let first = vec![self.solid.sheets.at(number, &self.solid.points[number])];
        let face = search.on(&first);
        if own.is_none() || face.as_ref().is_some_and(|f| search.is_face(f, &first[0])) {
            return face.map(|face| OnSheets::new(face, first));
        }
        search.beyond(&first, own.as_slice())
    }

    /// The closest point on the sheet of a quadrature point, where that bounds the body: on its edges too.
    fn on_sheet(&self, target: &Point<D>, number: usize) -> Option<OnSheets<D>> {
        if self.solid.sheets.number(number).is_none() {
            return self.closest(target, number);
        }
        let search = Search::new(self, target, number);
        let alone = vec![self.solid.sheets.at(number, &self.solid.points[number])];
        search.on(&alone).filter(|found| search.is_limit(found)).map(|found| OnSheets::new(found, alone))
    }

    /// The closest point; of the boundary itself one that faces a site across a gap, as the quadrature point did from which
    /// it was looked for: a search along the boundary may end behind the material beside the gap.
    fn met(&self, x: &Point<3>, reach: f64, except: Option<&Site>) -> Option<(usize, OnSheets<D>)> {
        let own = except.map(|site| &self.solid.points[site.patch as usize]);
        let number = self.nearest_point(x, reach, |other| own.is_none_or(|own| faces(own, &other.x, &other.normal)))?;
        let found = self.closest(&Point::<D>::from_fn(|k, _| x[k]), number)?;
        let normal = match &found.outward {
            Some(normal) => *normal,
            None => found.active.iter().filter_map(|s| s.gradient(&found.at.x).try_normalize(0.0)).sum(),
        };
        own.is_none_or(|own| faces(own, &found.at.x, &normal)).then_some((number, found))
    }

    /// Outward normal of a sheet at a point, moved.
    fn normal(&self, at: &Found<D>, sheet: &Arc<dyn ImplicitShape<D>>) -> Vector<3> {
        normal_now(&sheet.gradient(&at.x), &at.u.gradient).try_normalize(0.0).unwrap_or_default()
    }

    /// Where the boundary looks at a closest point.
    fn outward(&self, found: &OnSheets<D>) -> Option<Vector<3>> {
        let OnSheets { at, active, outward } = found;
        let normals = active.iter().map(|s| self.normal(at, s));
        let outward = match outward {
            Some(normal) if active.len() > 1 => normal_now(normal, &at.u.gradient),
            _ => normals.sum::<Vector<3>>(),
        };
        outward.try_normalize(0.0)
    }

    fn foot(&self, x: &Point<3>, number: usize, found: &OnSheets<D>) -> Foot {
        let OnSheets { at, active, .. } = found;
        let outward = self.outward(found);
        let size = self.solid.cell_size(&self.solid.points[number]);
        let is_face = active.len() == 1 || (x - spatial(&at.now())).norm() <= TOUCHING * size;
        let at = &Found { u: self.solid.body.displacement_jet(at.cell, &at.x, self.u, true), ..*at };
        let chart = Chart::new(at, &if is_face { vec![active[0].clone()] } else { active.clone() });
        let ([y1, y2], [y11, y12, y22], y3) = (
            chart.now.0.each_ref().map(spatial),
            chart.now.1.each_ref().map(spatial),
            chart.now.2.each_ref().map(spatial),
        );
        let curve = CurveJet { x: spatial(&at.now()), d1: y1, d2: y11, d3: y3[0] };
        let jet = if D == 2 {
            SurfaceJet::strip(&curve)
        } else {
            SurfaceJet {
                x: curve.x,
                u: y1,
                v: y2,
                uu: y11,
                uv: y12,
                vv: y22,
                uuu: y3[0],
                uuv: y3[1],
                uvv: y3[2],
                vvv: y3[3],
            }
        };
        let mut xi = [0.0; 3];
        xi.iter_mut().zip(at.x.iter()).for_each(|(xi, x)| *xi = *x);
        let functions = self.functions(at, |jet| chart.slopes(jet));
        Foot {
            point: MaterialPoint { patch: number as u32, xi },
            jet,
            coordinates: if is_face { 2 } else { D - active.len() },
            outward,
            radius: 0.0,
            functions,
            spin: Vec::new(),
            spin_bends: Vec::new(),
            frame: Matrix::<3>::identity(),
        }
    }

    /// What moves a point; `along` gives first and second derivatives of a function along the coordinates.
    fn functions(&self, at: &Found<D>, along: impl Fn(&FunctionJet<D>) -> ([f64; 2], [f64; 3])) -> Vec<Function> {
        let own = &self.solid.body.cells()[at.cell].functions;
        let mut out = Vec::with_capacity(D * own.len());
        for (f, jet) in own.iter().zip(&self.solid.body.jets_at(at.cell, &at.x)) {
            let (first, second) = along(jet);
            for i in 0..D {
                let Some(unknown) = self.solid.unknown(*f, i) else { continue };
                let along = |v: f64| axis(i) * v;
                out.push(Function {
                    unknown,
                    value: along(jet.value),
                    slopes: first.map(along),
                    second: second.map(along),
                });
            }
        }
        out
    }
}

fn with_tree(now: Vec<Point<3>>) -> (Vec<Point<3>>, Bvh) {
    let boxes: Vec<Aabb<3>> = now.iter().map(|x| Aabb::new(*x, *x)).collect();
    let tree = Bvh::new(&boxes);
    (now, tree)
}

impl<const D: usize> Master for BoundaryMaster<'_, D> {
    fn prepare(&self) {
        if self.now.get().is_none() {
            let now = self.points.clone().into_par_iter().map(|k| self.place(k)).collect();
            self.now.get_or_init(|| with_tree(now));
        }
    }

    fn nearest(&self, x: &Point<3>, reach: f64, except: Option<&Site>) -> Option<MasterProjection> {
        let (number, found) = self.met(x, reach, except)?;
        let is_within = (spatial(&found.at.now()) - x).norm() <= reach;
        is_within.then(|| MasterProjection::Foot(Box::new(self.foot(x, number, &found))))
    }

    fn facing(&self, x: &Point<3>, looking: &Looking) -> Option<MasterProjection> {
        let looks = |other: &crate::cell::Site<D>| looking.sees(&spatial(&other.normal));
        let number = self.nearest_point(x, f64::INFINITY, looks)?;
        let found = self.on_sheet(&Point::<D>::from_fn(|k, _| x[k]), number)?;
        let outward = self.outward(&found)?;
        let is_under = looking.is_under(&(x - spatial(&found.at.now())), &outward);
        (is_under && looking.sees(&outward)).then(|| MasterProjection::Foot(Box::new(self.foot(x, number, &found))))
    }

    fn gap(&self, x: &Point<3>, reach: f64, except: Option<&Site>) -> Option<f64> {
        let (_, found) = self.met(x, reach, except)?;
        let apart = x - spatial(&found.at.now());
        let outward = self.outward(&found)?;
        Some(apart.norm() * apart.dot(&outward).signum())
    }

    fn at(&self, point: &MaterialPoint) -> Anchor {
        let number = point.patch as usize;
        let own = &self.solid.points[number];
        let x = Point::<D>::from_fn(|k, _| point.xi[k]);
        let at = self.solid.found_near(x, own.cell, self.u);
        let gradient = self.solid.sheets.at(number, own).gradient(&x);
        let tangent = across(&[gradient]).first().copied().unwrap_or_else(Vector::<D>::zeros);
        let functions = self.functions(&at, |jet| ([jet.gradient.dot(&tangent), 0.0], [0.0; 3]));
        Anchor {
            x: spatial(&at.now()),
            tangent: spatial(&(at.deformation() * tangent)),
            functions,
            frame: Matrix::<3>::identity(),
            ..Anchor::default()
        }
    }
}

/// The search for the point of a boundary that is closest to a target, from one of its quadrature points.
struct Search<'a, const D: usize> {
    master: &'a BoundaryMaster<'a, D>,
    target: &'a Point<D>,
    number: usize,
    /// Of the cell of the quadrature point.
    size: f64,
}

impl<'a, const D: usize> Search<'a, D> {
    fn new(master: &'a BoundaryMaster<'a, D>, target: &'a Point<D>, number: usize) -> Self {
        Search { master, target, number, size: master.solid.cell_size(&master.solid.points[number]) }
    }

    /// The closest point on active sheets, unless it is far from the start.
    fn on(&self, active: &Active<D>) -> Option<Found<D>> {
        let start = &self.master.solid.points[self.number];
        let found = self.master.solid.closest(self.target, (&start.x, start.cell), active, self.master.u)?;
        ((found.x - start.x).norm() <= FARTHEST * self.size).then_some(found)
    }

    /// The closest point on facets.
    fn on_facets(&self) -> Option<OnSheets<D>> {
        let solid = self.master.solid;
        let start = &solid.points[self.number];
        let mut at = solid.found(start.x, start.cell, self.master.u);
        for _ in 0..MOST_STEPS {
            let ahead = at.x + at.deformation().transpose() * (self.target - at.now());
            let facet = solid.body.region.facet_at(&ahead)?;
            let step = (facet.x - at.x).norm();
            at = solid.found_near(facet.x, at.cell, self.master.u);
            if step > LAST_STEP * self.size {
                continue;
            }
            let active: Active<D> = (facet.planes.iter())
                .map(|normal| Arc::new(HalfSpace { point: facet.x, normal: *normal }) as Arc<dyn ImplicitShape<D>>)
                .collect();
            let found = solid.closest(self.target, (&at.x, at.cell), &active, self.master.u)?;
            return Some(OnSheets { at: found, active, outward: Some(facet.normal) });
        }
        None
    }

    fn is_material(&self, x: &Point<D>) -> bool {
        let body = &self.master.solid.body;
        body.tree().bounds().contains(x) && body.region.contains(x)
    }

    /// Whether the material of the body ends at a point of a sheet, across it.
    fn is_face(&self, at: &Found<D>, sheet: &Arc<dyn ImplicitShape<D>>) -> bool {
        let Some(normal) = sheet.gradient(&at.x).try_normalize(0.0) else { return false };
        let beside = normal * (BESIDE * self.size);
        self.is_material(&(at.x - beside)) && !self.is_material(&(at.x + beside))
    }

    /// Whether there is material beside a point, and also none.
    fn is_limit(&self, at: &Found<D>) -> bool {
        let mut seen = [false; 2];
        for corner in 0..1usize << D {
            let d = Vector::<D>::from_fn(|k, _| if corner >> k & 1 == 1 { 1.0 } else { -1.0 });
            seen[usize::from(self.is_material(&(at.x + d * (BESIDE * self.size))))] = true;
        }
        seen == [true; 2]
    }

    /// The closest point on another face, an edge of the active sheets, or else a vertex.
    fn beyond(&self, active: &Active<D>, taken: &[usize]) -> Option<OnSheets<D>> {
        let sheets = &self.master.solid.sheets.list;
        // What does not vanish as near as a closest point is looked for takes no part.
        let start = &self.master.solid.points[self.number].x;
        let reach = Vector::<D>::repeat(FARTHEST * self.size);
        let around = Aabb::new(start - reach, start + reach);
        let is_near = |k: &usize| sheets[*k].range(&around).is_none_or(|[low, high]| low <= 0.0 && high >= 0.0);
        let near: Vec<usize> = (0..sheets.len()).filter(|k| !taken.contains(k)).filter(is_near).collect();
        let others = || near.iter().copied();
        let mut candidates: Vec<OnSheets<D>> = Vec::new();
        for k in others() {
            let alone = vec![sheets[k].clone()];
            if active.len() == 1
                && let Some(face) = self.on(&alone).filter(|f| self.is_face(f, &alone[0]))
            {
                candidates.push(OnSheets::new(face, alone));
            }
            let both = [&active[..], &[sheets[k].clone()]].concat();
            if let Some(edge) = self.on(&both).filter(|f| self.is_limit(f)) {
                candidates.push(OnSheets::new(edge, both));
            }
        }
        let distance = |c: &OnSheets<D>| (c.at.now() - self.target).norm();
        let nearest = |list: Vec<OnSheets<D>>| list.into_iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        if candidates.is_empty() && active.len() + 1 < D {
            let deeper = others().filter_map(|k| {
                let both = [&active[..], &[sheets[k].clone()]].concat();
                self.beyond(&both, &[taken, &[k]].concat())
            });
            candidates = deeper.collect();
        }
        nearest(candidates)
    }
}
