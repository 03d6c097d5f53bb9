//! The faces of a solid that may touch: the points that are tested on them, tabulated once, and what moves them.

use super::spatial::{depth, spatial};
use crate::body::{Bodies, BodySurface};
use rayon::prelude::*;
use signorini_contact::{FacePoint, PressureNodes, SplineFace};
use signorini_fem::hierarchic::{Derivatives, Values};
use signorini_fem::rules::rule;
use signorini_fem::{CellShape, Group, Local, Side};
use signorini_geometry::{Matrix, Point, Vector};
use signorini_mechanics::pair::axis;
use signorini_mechanics::{Direction, Function, NormalField, Sampling, SecondDerivative, Site, SlavePoint};
use std::collections::{BTreeMap, HashMap};
use std::ops::Range;
use std::sync::OnceLock;

/// A side of a cell.
pub(super) struct Face<const D: usize> {
    pub side: Side,
    pub shape: CellShape,
    pub vertices: Vec<u32>,
    /// Functions that do not vanish on the side: their places in the cell, their numbers and signs.
    places: Vec<usize>,
    functions: Vec<(u32, f64)>,
    /// Degree of the polynomial that the side is when displaced, positions of as many points, and the functions there.
    pub order: usize,
    lattice: Vec<(Point<D>, Vec<f64>)>,
    /// The side as a span of a spline, where it is one.
    pub spline: Option<SplineFace<D>>,
    pub depth: f64,
}

/// A tested point with what moves it.
pub(super) struct TestedPoint<const D: usize> {
    x: Point<D>,
    functions: Vec<(u32, f64)>,
    around: Vec<Tangents<D>>,
    /// What the averaged normal is the sum of.
    averaged: Vec<(f64, Tangents<D>)>,
    depth: f64,
    /// The traction by the stress there in each unknown, once it is asked for.
    pub(super) traction: OnceLock<Vec<(u32, Point<D>)>>,
}

/// The tangents of a face at a tested point, and how functions move them.
#[derive(Clone)]
pub(super) struct Tangents<const D: usize> {
    face: u32,
    at: [Point<D>; 2],
    slopes: Vec<(u32, [f64; 2])>,
}

/// The faces of a group.
pub(super) struct Surface<const D: usize> {
    pub faces: Vec<u32>,
    /// The same as the mortar method sees them.
    pub boundary: BodySurface<D>,
    /// Faces around each vertex.
    pub around: HashMap<u32, Vec<u32>>,
    /// What the averaged normal at each vertex of each face is the sum of, once it is asked for.
    normals: OnceLock<Vec<Vec<Normal<D>>>>,
    /// Whether its normal does not jump, as that of smooth splines, once it is asked for.
    is_smooth: OnceLock<bool>,
    nodes: Tested<D>,
    gauss_points: Tested<D>,
}

/// Area normals of faces with their shares, of which an averaged normal is the sum.
type Normal<const D: usize> = Vec<(f64, Tangents<D>)>;

/// Tested points of a surface.
struct Tested<const D: usize> {
    /// Number of the first one among those of the body, and how many numbers there are.
    numbers: Range<u32>,
    /// Once they are asked for.
    list: OnceLock<Vec<(Site, TestedPoint<D>)>>,
}

/// All faces of the groups of a body.
pub(super) struct Faces<const D: usize> {
    bodies: Bodies<D>,
    list: Vec<Face<D>>,
    surfaces: Vec<Surface<D>>,
    by_group: BTreeMap<String, usize>,
}

/// Cosine of the angle between faces at rest from which on they make one smooth surface: that between two sides of a
/// regular octagon.
pub(super) const SMOOTH: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Difference of unit normals that is none.
const SAME: f64 = 1e-9;

/// Functions smaller than this at a point do not move it: rounding of their values, which are about one.
pub(super) const NOTHING: f64 = 1e-14;

impl<const D: usize> Faces<D> {
    pub fn new(bodies: &Bodies<D>, groups: &BTreeMap<String, Group>) -> Self {
        let mut out =
            Faces { bodies: bodies.clone(), list: Vec::new(), surfaces: Vec::new(), by_group: BTreeMap::new() };
        let mut numbers: HashMap<Side, u32> = HashMap::new();
        let mut next = 0;
        for (name, group) in groups.iter().filter(|(_, g)| !g.sides.is_empty()) {
            let mut faces = Vec::with_capacity(group.sides.len());
            for side in &group.sides {
                faces.push(*numbers.entry(*side).or_insert_with(|| {
                    out.list.push(Face::new(bodies, *side));
                    (out.list.len() - 1) as u32
                }));
            }
            let mut around: HashMap<u32, Vec<u32>> = HashMap::new();
            for &f in &faces {
                out.list[f as usize].vertices.iter().for_each(|v| around.entry(*v).or_default().push(f));
            }
            let boundary = bodies.surface(0, group.sides.clone());
            let gauss_points = faces.iter().map(|f| out.face(*f).rule(bodies).len()).sum::<usize>();
            let nodes = faces.iter().map(|f| out.face(*f).lattice.len()).sum::<usize>();
            let mut tested = |count: usize| {
                let numbers = next..next + count as u32;
                next = numbers.end;
                Tested { numbers, list: OnceLock::new() }
            };
            let (nodes, gauss_points) = (tested(nodes), tested(gauss_points));
            out.by_group.insert(name.clone(), out.surfaces.len());
            out.surfaces.push(Surface {
                faces,
                boundary,
                around,
                normals: OnceLock::new(),
                is_smooth: OnceLock::new(),
                nodes,
                gauss_points,
            });
        }
        out
    }

    pub fn face(&self, face: u32) -> &Face<D> {
        &self.list[face as usize]
    }

    /// The surface of a group that has sides.
    pub fn surface(&self, group: &str) -> &Surface<D> {
        &self.surfaces[self.by_group[group]]
    }

    pub fn sites(&self, group: &str, sampling: Sampling) -> Vec<Site> {
        self.tested(self.surface(group), sampling).iter().map(|t| t.0).collect()
    }

    fn tested<'a>(&'a self, surface: &'a Surface<D>, sampling: Sampling) -> &'a [(Site, TestedPoint<D>)] {
        match sampling {
            Sampling::Nodes => surface.nodes.list.get_or_init(|| self.nodes(surface)),
            Sampling::GaussPoints => surface.gauss_points.list.get_or_init(|| self.gauss_points(surface)),
        }
    }

    /// The tested point that a site is.
    pub(super) fn point(&self, site: &Site) -> &TestedPoint<D> {
        let number = site.patch;
        let surface = &self.surfaces[self.surfaces.partition_point(|s| s.nodes.numbers.start <= number) - 1];
        let (sampling, first) = match number < surface.gauss_points.numbers.start {
            true => (Sampling::Nodes, surface.nodes.numbers.start),
            false => (Sampling::GaussPoints, surface.gauss_points.numbers.start),
        };
        &self.tested(surface, sampling)[(number - first) as usize].1
    }

    /// Depth of the cells at a site.
    pub fn depth(&self, site: &Site) -> f64 {
        self.point(site).depth
    }

    /// The faces that a site lies on.
    pub fn faces_of(&self, site: &Site) -> impl Iterator<Item = u32> {
        self.point(site).around.iter().map(|t| t.face)
    }

    /// A point of faces of a surface, the first of them by its place in it, that stands for an area.
    fn tested_point(
        &self,
        surface: &Surface<D>,
        (place, at): (usize, &[(u32, Local)]),
        (patch, weight): (u32, f64),
    ) -> (Site, TestedPoint<D>) {
        let (face, s) = at[0];
        let functions =
            (self.slopes(face, &s).into_iter()).filter(|(_, d)| d[0].abs() > NOTHING).map(|(f, d)| (f, d[0])).collect();
        let averaged = self.averaged(surface, place, &s);
        let around: Vec<Tangents<D>> = at.iter().map(|(face, s)| self.tangents(*face, s)).collect();
        let depth = at.iter().map(|(f, _)| self.face(*f).depth).fold(f64::INFINITY, f64::min);
        let x = self.reference(face, &s).x;
        let point = TestedPoint { x, functions, around, averaged, depth, traction: OnceLock::new() };
        (Site { patch, xi: [s[0], s[1]], weight }, point)
    }

    fn tangents(&self, face: u32, s: &Local) -> Tangents<D> {
        let slopes = self.slopes(face, s).into_iter().filter(|(_, d)| d[1].abs().max(d[2].abs()) > NOTHING);
        let slopes = slopes.map(|(f, d)| (f, [d[1], d[2]])).collect();
        Tangents { face, at: self.reference(face, s).tangents, slopes }
    }

    /// The terms of the averaged normal at a point of a face of a surface: area normals at its vertices of all faces that go on
    /// smoothly there, over their areas at rest, with the functions of the vertices.
    fn averaged(&self, surface: &Surface<D>, place: usize, s: &Local) -> Normal<D> {
        let shape = self.face(surface.faces[place]).shape;
        let mut out = Vec::new();
        for (k, terms) in self.vertex_normals(surface)[place].iter().enumerate() {
            let value = shape.vertex_function(k, s);
            if value.abs() > NOTHING {
                out.extend(terms.iter().map(|(share, tangents)| (value * share, tangents.clone())));
            }
        }
        out
    }

    /// The same at the vertices of all faces of a surface.
    pub fn vertex_normals<'a>(&'a self, surface: &'a Surface<D>) -> &'a [Vec<Normal<D>>] {
        surface.normals.get_or_init(|| {
            let of = |face: &u32| {
                let vertices = 0..self.face(*face).vertices.len();
                vertices.map(|k| self.averaged_at_vertex(*face, k, &surface.around)).collect()
            };
            surface.faces.par_iter().map(of).collect()
        })
    }

    /// Whether a surface of splines has the same normal on all faces that meet: at rest, and then wherever it goes.
    pub fn is_smooth(&self, surface: &Surface<D>) -> bool {
        let normal = |f: u32, k: usize| {
            let shape = self.face(f).shape;
            self.reference(f, &shape.vertices()[k]).area_normal().normalize()
        };
        let agrees = |v: &u32, faces: &Vec<u32>| {
            let normals = faces.iter().filter_map(|&f| {
                let place = self.face(f).vertices.iter().position(|w| w == v)?;
                Some(normal(f, place))
            });
            let list: Vec<Point<D>> = normals.collect();
            list.iter().all(|n| (n - list[0]).norm() < SAME)
        };
        *surface.is_smooth.get_or_init(|| {
            surface.faces.iter().all(|f| self.face(*f).spline.is_some())
                && surface.around.iter().all(|(v, faces)| agrees(v, faces))
        })
    }

    fn averaged_at_vertex(&self, face: u32, k: usize, around: &HashMap<u32, Vec<u32>>) -> Normal<D> {
        let own = self.face(face);
        let vertex = own.vertices[k];
        let here = self.reference(face, &own.shape.vertices()[k]).area_normal();
        let mut out = Vec::new();
        let mut total = 0.0;
        for &other in &around[&vertex] {
            let face = self.face(other);
            let at = face.vertices.iter().position(|v| *v == vertex).map(|k| face.shape.vertices()[k]);
            let Some(at) = at else { continue };
            let normal = self.reference(other, &at).area_normal();
            if normal.dot(&here) >= SMOOTH * normal.norm() * here.norm() {
                total += normal.norm();
                out.push((1.0, self.tangents(other, &at)));
            }
        }
        out.iter_mut().for_each(|(share, _)| *share /= total);
        out
    }

    /// The averaged normal between the vertices of a face.
    pub fn normal_field(&self, face: u32, s: &Local, at_vertices: &[Direction]) -> NormalField {
        let shape = self.face(face).shape;
        let mut out = NormalField::default();
        for (k, direction) in at_vertices.iter().enumerate() {
            let value = shape.vertex_function(k, s);
            let slopes = shape.vertex_slopes(k, s);
            out.vector += direction.vector * value;
            (0..2).for_each(|a| out.slopes[a] += direction.vector * slopes[a]);
            out.functions.extend(direction.functions.iter().map(|f| Function {
                unknown: f.unknown,
                value: f.value * value,
                slopes: slopes.map(|s| f.value * s),
                ..Function::default()
            }));
            out.bends.extend(
                direction.bends.iter().map(|b| SecondDerivative { unknowns: b.unknowns, value: b.value * value }),
            );
        }
        merge(&mut out.functions);
        out
    }

    /// The averaged normal of its terms, with what moves it.
    pub fn direction(averaged: &[(f64, Tangents<D>)], u: &[f64]) -> Direction {
        let mut out = Direction::default();
        for (share, terms) in averaged {
            let [x1, x2] = terms.now(u).each_ref().map(spatial);
            // In the plane the second tangent goes across it.
            let x2 = if D == 2 { Vector::<3>::z() } else { x2 };
            out.vector += x1.cross(&x2) * *share;
            for (f, [s1, s2]) in &terms.slopes {
                for i in 0..D {
                    let e = axis(i);
                    let turned = if D == 2 { e.cross(&x2) * *s1 } else { e.cross(&x2) * *s1 + x1.cross(&e) * *s2 };
                    out.functions.push(Function {
                        unknown: D as u32 * f + i as u32,
                        value: turned * *share,
                        ..Function::default()
                    });
                }
            }
        }
        merge(&mut out.functions);
        if D == 3 {
            for (share, terms) in averaged {
                for (k, (f, s)) in terms.slopes.iter().enumerate() {
                    for (g, t) in &terms.slopes[k + 1..] {
                        let size = share * (s[0] * t[1] - t[0] * s[1]);
                        for (i, j) in [(0, 1), (1, 2), (2, 0), (1, 0), (2, 1), (0, 2)] {
                            let unknowns = [3 * f + i as u32, 3 * g + j as u32];
                            out.bends.push(SecondDerivative { unknowns, value: axis(i).cross(&axis(j)) * size });
                        }
                    }
                }
            }
        }
        out
    }

    fn gauss_points(&self, surface: &Surface<D>) -> Vec<(Site, TestedPoint<D>)> {
        let mut out = Vec::new();
        for (place, &f) in surface.faces.iter().enumerate() {
            for (s, w) in self.face(f).rule(&self.bodies) {
                let point = self.reference(f, &s);
                let weight = w * point.area_normal().norm() * self.bodies.measure(&point.x);
                let number = surface.gauss_points.numbers.start + out.len() as u32;
                out.push(self.tested_point(surface, (place, &[(f, s)]), (number, weight)));
            }
        }
        out
    }

    /// The nodes of the contact pressure, one on each side of an edge that is a feature.
    fn nodes(&self, surface: &Surface<D>) -> Vec<(Site, TestedPoint<D>)> {
        let nodes = PressureNodes::new(&surface.boundary);
        debug_assert!(nodes.len() <= surface.nodes.numbers.len());
        let mut weights = vec![0.0; nodes.len()];
        let mut points: Vec<(usize, Vec<(u32, Local)>)> = vec![(0, Vec::new()); nodes.len()];
        for (place, &face) in surface.faces.iter().enumerate() {
            let own = nodes.of_face(place);
            for (k, ((node, _), s)) in own.iter().zip(nodes.map(place).nodes()).enumerate() {
                let (first, at) = &mut points[*node as usize];
                if !nodes.lies_on(place, k) && nodes.places()[*node as usize].0 != place {
                    continue;
                }
                if at.is_empty() {
                    *first = place;
                }
                at.push((face, s));
            }
            for ((node, _), w) in own.iter().zip(self.tributary(face, nodes.map(place))) {
                weights[*node as usize] += w;
            }
        }
        let list = points.iter().zip(weights).zip(surface.nodes.numbers.start..);
        list.map(|(((first, at), w), number)| self.tested_point(surface, (*first, at), (number, w))).collect()
    }

    /// The area of a face as it belongs to its nodes: the integrals of their functions, or where one of these is not
    /// positive, as at the vertices of quadratic triangles or on an axis, in proportion to those of the squares (Hinton,
    /// Rock & Zienkiewicz 1976).
    fn tributary(&self, face: u32, map: &signorini_fem::cell_map::CellMap) -> Vec<f64> {
        let mut at = Values::default();
        let mut whole = vec![0.0; map.len()];
        let mut squares = vec![0.0; map.len()];
        let mut area = 0.0;
        for (s, w) in rule(self.face(face).shape, map.order() + 2) {
            let point = self.reference(face, &s);
            let w = w * point.area_normal().norm() * self.bodies.measure(&point.x);
            map.tabulate(&s, &mut at);
            area += w;
            for (k, v) in at.value.iter().enumerate() {
                whole[k] += w * v;
                squares[k] += w * v * v;
            }
        }
        if whole.iter().all(|w| *w > 1e-9 * area) {
            return whole;
        }
        let total: f64 = squares.iter().sum();
        squares.iter().map(|s| s / total * area).collect()
    }

    /// A point of a face at rest.
    pub fn reference(&self, face: u32, s: &Local) -> FacePoint<D> {
        let (x, tangents) = self.bodies.list[0].mesh.on_side(self.face(face).side, s);
        FacePoint { x, tangents }
    }

    /// The functions that move a point of a face, with their derivatives along its coordinates up to the third.
    pub fn derivatives(&self, face: u32, s: &Local) -> Vec<(u32, Derivatives)> {
        self.derivatives_to(3, face, s)
    }

    /// The functions that move a point of a face, with their slopes along its coordinates.
    pub fn slopes(&self, face: u32, s: &Local) -> Vec<(u32, Derivatives)> {
        self.derivatives_to(1, face, s)
    }

    fn derivatives_to(&self, order: usize, face: u32, s: &Local) -> Vec<(u32, Derivatives)> {
        let face = self.face(face);
        let basis = self.bodies.list[0].dofs.basis(face.side.cell as usize);
        let (x, along) = basis.shape().on_side(face.side.side as usize, s);
        let list = basis.derivatives(&face.places, &x, &along, order);
        list.into_iter().zip(&face.functions).map(|(d, (f, sign))| (*f, d.map(|v| sign * v))).collect()
    }

    /// The points of the lattice of a face where they are now, as points of space.
    pub fn lattice(&self, face: u32, u: &[f64]) -> Vec<Point<3>> {
        let face = self.face(face);
        (face.lattice.iter())
            .map(|(x, values)| {
                let mut x = *x;
                for ((f, _), v) in face.functions.iter().zip(values) {
                    (0..D).for_each(|i| x[i] += v * u[D * *f as usize + i]);
                }
                spatial(&x)
            })
            .collect()
    }

    /// A point of a face where it is now, from the functions there.
    pub fn current(&self, face: u32, s: &Local, list: &[(u32, Derivatives)], u: &[f64]) -> FacePoint<D> {
        let mut point = self.reference(face, s);
        for (f, d) in list {
            for i in 0..D {
                let u = u[D * *f as usize + i];
                point.x[i] += u * d[0];
                (0..D - 1).for_each(|a| point.tangents[a][i] += u * d[1 + a]);
            }
        }
        point
    }

    /// The mean outward unit normal at a tested point.
    pub fn outward(&self, site: &Site, u: &[f64]) -> Vector<3> {
        let point = self.point(site);
        let of = |t: &Tangents<D>| spatial(&FacePoint { x: point.x, tangents: t.now(u) }.area_normal().normalize());
        point.around.iter().map(of).sum::<Vector<3>>().normalize()
    }

    pub fn placed(&self, site: &Site, u: &[f64]) -> SlavePoint {
        let point = self.point(site);
        let mut x = point.x;
        let mut functions = Vec::with_capacity(D * point.functions.len());
        for (f, v) in &point.functions {
            for i in 0..D {
                let unknown = D as u32 * f + i as u32;
                x[i] += v * u[unknown as usize];
                functions.push(Function { unknown, value: axis(i) * *v, ..Function::default() });
            }
        }
        SlavePoint {
            x: spatial(&x),
            outward: Some(self.outward(site, u)),
            averaged: Some(Self::direction(&point.averaged, u)),
            functions,
            frame: Matrix::<3>::identity(),
            ..SlavePoint::default()
        }
    }
}

impl<const D: usize> Tangents<D> {
    /// The tangents where the body is now.
    fn now(&self, u: &[f64]) -> [Point<D>; 2] {
        let mut tangents = self.at;
        for (f, slopes) in &self.slopes {
            for i in 0..D {
                let u = u[D * *f as usize + i];
                (0..D - 1).for_each(|a| tangents[a][i] += u * slopes[a]);
            }
        }
        tangents
    }
}

/// Adds up functions of the same unknown.
pub(super) fn merge(functions: &mut Vec<Function>) {
    functions.sort_by_key(|f| f.unknown);
    functions.dedup_by(|f, kept| {
        let same = f.unknown == kept.unknown;
        if same {
            kept.value += f.value;
            (0..2).for_each(|a| kept.slopes[a] += f.slopes[a]);
        }
        same
    });
}

impl<const D: usize> Face<D> {
    /// The points of Gauss that are tested.
    fn rule(&self, bodies: &Bodies<D>) -> Vec<(Local, f64)> {
        rule(self.shape, bodies.list[0].degree + 1)
    }

    fn new(bodies: &Bodies<D>, side: Side) -> Self {
        let body = &bodies.list[0];
        let cell = side.cell as usize;
        let shape = body.mesh.side_shape(side);
        let places = body.dofs.on_side(side);
        let functions: Vec<(u32, f64)> = places.iter().map(|&k| body.dofs.function(cell, k)).collect();
        let order = body.mesh.map(cell).order().max(body.degree);
        let basis = body.dofs.basis(cell);
        let mut at = Values::default();
        let lattice = (lattice(shape, order).iter())
            .map(|s| {
                let (xi, _) = basis.shape().on_side(side.side as usize, s);
                basis.tabulate(&xi, &mut at);
                let values = places.iter().zip(&functions).map(|(&k, (_, sign))| sign * at.value[k]).collect();
                (body.mesh.on_side(side, s).0, values)
            })
            .collect();
        let vertices = body.mesh.side_vertices(side);
        let spline = body.spline_face(side);
        Face { spline, side, shape, vertices, places, functions, order, lattice, depth: depth(bodies, side) }
    }
}

/// Equidistant points of a face: of a quadrilateral the second coordinate runs fastest, of a triangle the first.
fn lattice(shape: CellShape, n: usize) -> Vec<Local> {
    let share = |k: usize| k as f64 / n as f64;
    let side = |k: usize| 2.0 * share(k) - 1.0;
    match shape {
        CellShape::Line => (0..=n).map(|i| [side(i), 0.0, 0.0]).collect(),
        CellShape::Triangle => (0..=n).flat_map(|j| (0..=n - j).map(move |i| [share(i), share(j), 0.0])).collect(),
        _ => (0..=n).flat_map(|i| (0..=n).map(move |j| [side(i), side(j), 0.0])).collect(),
    }
}
