//! The closest point of a solid, the side on which it is seen, and the gap.

use super::face::Face;
use super::spline_tree::Search;
use super::{FaceSurface, Item, TrimmedSolid};
use crate::closest::{Query, closest};
use crate::feature::FeatureKind;
use crate::mass_properties::MassProperties;
use crate::mesh::TriangleMesh;
use crate::rigid_shape::{GapJet, RigidShape};
use crate::shape::{Axes, Curve, Shape};
use crate::{Aabb, Matrix, Point, Vector};
use std::cell::{Cell, RefCell};

/// Where a closest point lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SolidFeature {
    /// Inside a face, at its parameters.
    Face(usize, [f64; 2]),
    /// On an edge, at its parameter.
    Edge(usize, f64),
    Vertex(usize),
    /// At a point of a face where parameters meet, an apex or a pole.
    Pole(usize, [f64; 2]),
}

/// A closest point of a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolidFoot {
    pub distance: f64,
    pub point: Point<3>,
    pub feature: SolidFeature,
}

/// Cosine, less than one by this, of the angle between faces that meet smoothly.
const SMOOTH: f64 = 1e-9;
/// Sizes of a body closer than which a point is on it: the way to the closest point has no direction.
const ON_IT: f64 = 1e-9;
/// Sizes of a body within which closest points are the same: what rounding leaves where the distance is flat.
const APART: f64 = 1e-6;

impl SolidFoot {
    /// Inside a face, on an edge, or at a vertex.
    pub fn kind(&self) -> FeatureKind {
        match self.feature {
            SolidFeature::Face(..) => FeatureKind::Interior,
            SolidFeature::Edge(..) => FeatureKind::Edge,
            SolidFeature::Vertex(_) | SolidFeature::Pole(..) => FeatureKind::Vertex,
        }
    }

    /// The number of its face, edge or vertex; of a pole that of its face.
    pub fn number(&self) -> usize {
        match self.feature {
            SolidFeature::Face(k, _)
            | SolidFeature::Edge(k, _)
            | SolidFeature::Vertex(k)
            | SolidFeature::Pole(k, _) => k,
        }
    }
}

impl TrimmedSolid {
    /// The closest point of the boundary.
    pub fn closest(&self, x: &Point<3>) -> SolidFoot {
        let best = Cell::new(SolidFoot { distance: f64::INFINITY, point: *x, feature: SolidFeature::Vertex(0) });
        self.search(x, &|| best.get().distance, &|foot| {
            if foot.distance < best.get().distance {
                best.set(foot);
            }
        });
        best.get()
    }

    /// The closest point, and others that are as near to within `tie`, the nearest first.
    pub(crate) fn closest_all(&self, x: &Point<3>, tie: f64) -> Vec<SolidFoot> {
        let nearest = self.closest(x);
        let others: RefCell<Vec<SolidFoot>> = RefCell::new(vec![nearest]);
        let limit = nearest.distance + tie;
        self.search(x, &|| limit, &|foot| {
            let mut list = others.borrow_mut();
            let same = |other: &SolidFoot| (other.point - foot.point).norm() <= APART * self.size;
            if foot.distance <= limit && !list.iter().any(same) {
                list.push(foot);
            }
        });
        others.into_inner()
    }

    /// The dimension of the set of closest points where they are a circle or a sphere; else zero.
    pub(crate) fn focal(&self, x: &Point<3>, foot: &SolidFoot) -> usize {
        let SolidFeature::Face(k, _) = foot.feature else { return 0 };
        let near = ON_IT * self.size;
        let off_axis = |axes: &Axes| axes.local(x).xy().norm();
        match &self.faces[k].surface {
            FaceSurface::Sphere { axes, .. } => 2 * usize::from((x - axes.origin).norm() <= near),
            FaceSurface::Cylinder { axes, .. } | FaceSurface::Cone { axes, .. } => usize::from(off_axis(axes) <= near),
            FaceSurface::Torus { axes, minor, .. } => {
                let in_tube = (foot.distance - minor).abs() <= near && foot.distance > 0.0;
                let on_ring = in_tube && axes.local(x).z.abs() <= near;
                usize::from(on_ring || off_axis(axes) <= near)
            }
            _ => 0,
        }
    }

    /// Offers all local minima that may be nearer than the distance that `limit` tells.
    fn search(&self, x: &Point<3>, limit: &dyn Fn() -> f64, found: &dyn Fn(SolidFoot)) {
        let offer = |distance: f64, point: Point<3>, feature: SolidFeature| {
            found(SolidFoot { distance, point, feature });
        };
        let search: RefCell<Option<(usize, Search<'_>)>> = RefCell::new(None);
        self.tree.nearest(x, f64::INFINITY, |item| {
            match self.items[item] {
                Item::Face(k) => {
                    let face = &self.faces[k];
                    if let Some(found) = face.surface.gap(x).filter(|g| g.gap.abs() < limit()) {
                        let point = x - found.normal * found.gap;
                        let z = face.surface.parameters(&point, None);
                        let is_apex = matches!(face.surface, FaceSurface::Cone { .. }) && face.surface.is_singular(z);
                        if !is_apex && face.contains(z, &point, &self.edges) {
                            offer(found.gap.abs(), point, SolidFeature::Face(k, z));
                        }
                    }
                }
                Item::Leaf(k, leaf) => {
                    let face = &self.faces[k];
                    let (FaceSurface::Spline(surface), Some(tree)) = (&face.surface, &face.tree) else {
                        return limit().powi(2);
                    };
                    let mut kept = search.borrow_mut();
                    if kept.as_ref().is_none_or(|(of, _)| *of != k) {
                        *kept = Some((k, Search::new(surface, &face.region, *x, f64::INFINITY)));
                    }
                    if let Some((_, search)) = kept.as_mut() {
                        search.limit = limit();
                        search.best = None;
                        search.leaf(&tree.leaves[leaf], &|z, x| face.contains(z, x, &self.edges));
                        if let Some(found) = search.best {
                            offer(found.distance, found.x, SolidFeature::Face(k, found.z));
                        }
                    }
                }
                Item::Pole(k, z) => {
                    let point = self.faces[k].surface.position(z);
                    offer((x - point).norm(), point, SolidFeature::Pole(k, z));
                }
                Item::Edge(k) => {
                    let found = closest(&Shape::Point(*x), &self.curves[k], &Query::default()).closest;
                    let &[t] = found.b.parameters() else { return limit().powi(2) };
                    let [from, to] = self.edges[k].curve.domain();
                    let feature = match t {
                        t if t <= from => SolidFeature::Vertex(self.edges[k].ends[0]),
                        t if t >= to => SolidFeature::Vertex(self.edges[k].ends[1]),
                        t => SolidFeature::Edge(k, t),
                    };
                    offer(found.distance, found.b.point, feature);
                }
            }
            limit().powi(2)
        });
    }

    /// Normals of the faces beside an edge at a parameter, with the face and its parameters.
    fn beside(&self, edge: usize, t: f64, x: &Point<3>) -> Vec<(usize, [f64; 2], Vector<3>)> {
        let own = self.uses[edge].iter().filter_map(|&(k, of)| {
            let (normal, z) = self.faces[k].normal_on(of, t, x);
            Some((k, z, normal?))
        });
        own.collect()
    }

    /// The gap to a closest point, with the normal along which it counts and its second derivatives.
    fn gap_to(&self, x: &Point<3>, foot: &SolidFoot) -> GapJet<3> {
        let on_face = |k: usize, z: [f64; 2]| {
            let Face { surface, sign, .. } = &self.faces[k];
            let GapJet { gap, normal, hessian } = surface.gap_from(x, z)?;
            // On a crease the way to the closest point is across no surface.
            let is_along = (gap.abs() - foot.distance).abs() <= ON_IT * (foot.distance + self.size);
            is_along.then(|| GapJet { gap: sign * gap, normal: normal * *sign, hessian: hessian * *sign })
        };
        match foot.feature {
            SolidFeature::Face(k, z) => {
                on_face(k, z).unwrap_or_else(|| self.across(x, foot, self.crease_normal(k, z), None))
            }
            SolidFeature::Edge(edge, t) => {
                let faces = self.beside(edge, t, &foot.point);
                if let [(k, z, n), (_, _, m)] = faces[..]
                    && n.dot(&m) > 1.0 - SMOOTH
                    && let Some(found) = on_face(k, z)
                {
                    return found;
                }
                let normal = faces.iter().map(|f| f.2).sum::<Vector<3>>();
                self.across(x, foot, normal, Some((&self.edges[edge].curve, t)))
            }
            SolidFeature::Vertex(k) => self.across(x, foot, self.vertex_normals[k], None),
            SolidFeature::Pole(k, z) => match self.faces[k].normal(&foot.point, z) {
                Some(normal) => {
                    let flat = self.across(x, foot, normal, None);
                    // The curvature beside the pole: at the pole itself parameters cannot tell it.
                    let beside = self.faces[k].around(z).first().and_then(|z| on_face(k, *z));
                    GapJet { hessian: beside.map_or(Matrix::<3>::zeros(), |b| b.hessian), ..flat }
                }
                None => self.across(x, foot, singular_normal(&self.faces[k], z), None),
            },
        }
    }

    /// The gap to a point of an edge, or to a vertex, with the sign of the side that the pseudo-normal tells.
    fn across(&self, x: &Point<3>, foot: &SolidFoot, pseudo: Vector<3>, edge: Option<(&Curve, f64)>) -> GapJet<3> {
        let d = x - foot.point;
        let distance = foot.distance;
        let sign = if d.dot(&pseudo) < 0.0 { -1.0 } else { 1.0 };
        let mean = pseudo.try_normalize(0.0);
        if distance <= ON_IT * self.size {
            let normal = mean.or_else(|| d.try_normalize(0.0)).unwrap_or(Vector::<3>::z());
            return GapJet { gap: sign * distance, normal, hessian: Matrix::<3>::zeros() };
        }
        let away = d / distance;
        let across = Matrix::<3>::identity() - away * away.transpose();
        let mut hessian = across / distance;
        if let Some((curve, t)) = edge {
            // Along the edge the distance bends as that to its circle of curvature.
            let jet = curve.jet(t);
            let speed = jet.d1.norm_squared();
            let bend = jet.d2.dot(&away) / speed;
            let along = jet.d1 * jet.d1.transpose() / speed;
            hessian -= along * (1.0 / distance + bend / (1.0 - distance * bend));
        }
        GapJet { gap: sign * distance, normal: away * sign, hessian: hessian * sign }
    }

    /// The mean normal at a crease of a spline, of the parts on its sides.
    fn crease_normal(&self, k: usize, z: [f64; 2]) -> Vector<3> {
        let Face { surface, sign, .. } = &self.faces[k];
        let FaceSurface::Spline(s) = surface else { return Vector::<3>::zeros() };
        // Within the parts, and nowhere near their other ends.
        let step = s.domain().map(|d| 1e-9 * (d[1] - d[0]));
        let sides = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
        let normals = sides.into_iter().filter_map(|[p, q]| {
            let beside = [z[0] + p * step[0], z[1] + q * step[1]];
            surface.normal(&surface.position(beside), beside)
        });
        normals.sum::<Vector<3>>() * *sign
    }

    /// The pseudo-normals of all vertices: normals of the faces around, weighted by their angles.
    pub(super) fn find_vertex_normals(&mut self) {
        for face in &self.faces {
            let n = face.uses.len();
            let mut from = 0;
            while from < n {
                let to = (from..n).find(|i| face.uses[*i].of_loop != face.uses[from].of_loop).unwrap_or(n);
                for i in from..to {
                    let next = if i + 1 == to { from } else { i + 1 };
                    let [(_, arriving), (vertex, leaving)] = [(i, true), (next, false)].map(|(i, at_end)| {
                        let use_ = &face.uses[i];
                        let edge = &self.edges[use_.edge];
                        let side = usize::from(use_.forward == at_end);
                        let jet = edge.curve.jet(edge.curve.domain()[side]);
                        (edge.ends[side], use_.along(&jet) * if at_end { -1.0 } else { 1.0 })
                    });
                    let x = self.vertices[vertex];
                    let use_ = &face.uses[next];
                    let t = self.edges[use_.edge].curve.domain()[usize::from(!use_.forward)];
                    let (normal, z) = face.normal_on(next, t, &x);
                    self.vertex_normals[vertex] += match normal {
                        Some(n) => {
                            // From the edge that leaves, around the normal, to the one that arrives.
                            let angle = n.dot(&leaving.cross(&arriving)).atan2(leaving.dot(&arriving));
                            let turn = std::f64::consts::TAU;
                            n * if angle < -ON_IT { angle + turn } else { angle.max(0.0) }
                        }
                        None => singular_normal(face, z),
                    };
                }
                from = to;
            }
        }
    }
}

/// The sum of normals around an apex, weighted by the angles between directions into the face.
fn singular_normal(face: &Face, z: [f64; 2]) -> Vector<3> {
    let all = face.around(z);
    let apex = face.surface.position(z);
    let direction = |z: &[f64; 2]| (face.surface.position(*z) - apex).try_normalize(0.0).unwrap_or_default();
    let n = all.len();
    (0..n)
        .filter_map(|k| {
            let (here, next) = (direction(&all[k]), direction(&all[(k + 1) % n]));
            let normal = face.normal(&face.surface.position(all[k]), all[k])?;
            Some(normal * here.cross(&next).norm().atan2(here.dot(&next)))
        })
        .sum()
}

impl RigidShape for TrimmedSolid {
    fn gap(&self, x: &Point<3>) -> GapJet<3> {
        self.gap_to(x, &self.closest(x))
    }

    /// The origin: the file of a body says no other.
    fn centre(&self) -> Point<3> {
        Point::<3>::zeros()
    }

    fn bounds(&self) -> Option<Aabb<3>> {
        Some(self.bounds)
    }

    fn mass_properties(&self) -> Option<MassProperties> {
        self.mass
    }

    fn mesh(&self) -> Option<&TriangleMesh> {
        TrimmedSolid::mesh(self)
    }
}
