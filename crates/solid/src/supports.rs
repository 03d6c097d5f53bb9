//! Supports: what is prescribed, function by function, and the unknowns that remain.
//!
//! Every vector function of a supported group is constrained along one or more directions; the rest of its directions
//! stay free. `u = T y + c`, with `T` from the directions and `c` from the prescribed values, which may change with time
//! while `T` stays.

use crate::body::{Bodies, Body};
use nalgebra::DMatrix;
use signorini_contact::{ContactSurface, FacePoint};
use signorini_fem::hierarchic::{Mode, Values};
use signorini_fem::rules::rule;
use signorini_fem::{CellShape, Group, Local, Side};
use signorini_geometry::Point;
use std::collections::{BTreeMap, BTreeSet};

/// What a support does.
#[derive(Clone, Debug, PartialEq)]
pub enum SupportKind {
    /// Which components are prescribed.
    Components(Vec<bool>),
    /// The component along the common normal of the group.
    Normal,
    /// Which components are the same everywhere on the group, and otherwise free.
    Uniform(Vec<bool>),
    /// Stiffness per area (or per length in the plane) of an elastic bed.
    Spring(Vec<f64>),
}

/// A support of a group of a body.
#[derive(Clone, Debug)]
pub struct Support {
    pub name: String,
    pub body: usize,
    pub group: Group,
    pub kind: SupportKind,
}

/// Supports that cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SupportError {
    #[error("`normal` needs a flat group: the normals of its sides differ by up to {degrees:.2} degrees")]
    NotFlat { support: String, degrees: f64 },
    #[error(
        "the supports `{first}` and `{second}` prescribe different displacements of the same point {position}: {a} and {b}"
    )]
    Contradiction { first: String, second: String, position: String, a: f64, b: f64 },
}

/// What one constrained direction of a function takes its value from.
#[derive(Clone, Debug)]
enum Source {
    Prescribed {
        support: usize,
    },
    /// The common displacement of a uniform support in one component.
    Tied {
        support: usize,
        unknown: u32,
        vertex: bool,
    },
}

#[derive(Clone, Debug)]
struct Held<const D: usize> {
    direction: Point<D>,
    source: Source,
}

/// The unknowns that remain.
pub struct Reduction<const D: usize> {
    /// `T` in compressed rows.
    start: Vec<u32>,
    entries: Vec<(u32, f64)>,
    pub unknowns: usize,
    tied: u32,
    /// Constrained directions by function (first unknown / D).
    held: BTreeMap<u32, Vec<Held<D>>>,
    /// Vertices of every support with their function, for reactions.
    pub reactions: Vec<Vec<u32>>,
}

/// The displacement a support prescribes at a point, by component; along the normal for [`SupportKind::Normal`].
pub type Displacement<'a, const D: usize> = &'a dyn Fn(usize, &Point<D>) -> Point<D>;

impl<const D: usize> Reduction<D> {
    pub fn new(bodies: &Bodies<D>, supports: &[Support]) -> Result<Self, SupportError> {
        let mut held: BTreeMap<u32, Vec<Held<D>>> = BTreeMap::new();
        let mut reactions = vec![Vec::new(); supports.len()];
        let mut tied = 0u32;
        for (number, support) in supports.iter().enumerate() {
            let body = &bodies.list[support.body];
            let all = functions(bodies, support);
            reactions[number] = vertices(bodies, support)
                .iter()
                .filter_map(|v| body.dofs.vertex(*v))
                .map(|f| global(bodies, support.body, f))
                .collect();
            let mut hold = |direction: Point<D>, source: &dyn Fn(u32) -> Source| {
                for &f in &all {
                    held.entry(f).or_default().push(Held { direction, source: source(f) });
                }
            };
            match &support.kind {
                SupportKind::Components(which) => {
                    for i in (0..D).filter(|&i| which[i]) {
                        hold(axis(i), &|_| Source::Prescribed { support: number });
                    }
                }
                SupportKind::Normal => {
                    let normal = common_normal(bodies, support)?;
                    hold(normal, &|_| Source::Prescribed { support: number });
                }
                SupportKind::Uniform(which) => {
                    let on_vertices: BTreeSet<u32> = reactions[number].iter().copied().collect();
                    for i in (0..D).filter(|&i| which[i]) {
                        let unknown = tied;
                        tied += 1;
                        hold(axis(i), &|f| Source::Tied { support: number, unknown, vertex: on_vertices.contains(&f) });
                    }
                }
                SupportKind::Spring(_) => {}
            }
        }
        let total = bodies.unknowns();
        let mut start = vec![0u32];
        let mut entries = Vec::new();
        let mut next = tied;
        for f in 0..(total / D) as u32 {
            let list = held.get(&f).map_or(&[][..], |l| &l[..]);
            let frame = frame(list);
            let free: Vec<(u32, Point<D>)> = frame[list_rank(list)..]
                .iter()
                .map(|direction| {
                    next += 1;
                    (next - 1, *direction)
                })
                .collect();
            for i in 0..D {
                for (unknown, direction) in &free {
                    if direction[i] != 0.0 {
                        entries.push((*unknown, direction[i]));
                    }
                }
                for h in list {
                    if let Source::Tied { unknown, vertex: true, .. } = h.source
                        && h.direction[i] != 0.0
                    {
                        entries.push((unknown, h.direction[i]));
                    }
                }
                start.push(entries.len() as u32);
            }
        }
        Ok(Reduction { start, entries, unknowns: next as usize, tied, held, reactions })
    }

    /// The row of `T` of an unknown of the bodies.
    pub fn row(&self, unknown: usize) -> &[(u32, f64)] {
        &self.entries[self.start[unknown] as usize..self.start[unknown + 1] as usize]
    }

    /// The first so many unknowns are common displacements of uniform supports.
    pub fn tied(&self) -> u32 {
        self.tied
    }

    /// The supports that constrain a vector function, and along which directions.
    pub(crate) fn constraints(&self, function: u32) -> impl Iterator<Item = (usize, Point<D>)> {
        self.held.get(&function).into_iter().flatten().map(|h| match h.source {
            Source::Prescribed { support } | Source::Tied { support, .. } => (support, h.direction),
        })
    }

    /// Whether an unknown of the bodies is prescribed.
    pub fn is_held(&self, unknown: usize) -> bool {
        self.row(unknown).is_empty()
    }

    /// `T y + c`.
    pub fn expand(&self, y: &[f64], offset: &[f64]) -> Vec<f64> {
        (0..offset.len())
            .map(|i| offset[i] + self.row(i).iter().map(|(k, c)| c * y[*k as usize]).sum::<f64>())
            .collect()
    }

    /// `Tᵀ f`.
    pub fn restrict(&self, f: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.unknowns];
        for (i, value) in f.iter().enumerate() {
            for (k, c) in self.row(i) {
                out[*k as usize] += c * value;
            }
        }
        out
    }

    /// The displacement `c` that the supports prescribe.
    pub fn offset(
        &self,
        bodies: &Bodies<D>,
        supports: &[Support],
        displacement: Displacement<'_, D>,
    ) -> Result<Vec<f64>, SupportError> {
        let mut coefficients: Vec<BTreeMap<u32, Point<D>>> = Vec::new();
        for (number, support) in supports.iter().enumerate() {
            coefficients.push(match support.kind {
                SupportKind::Components(_) | SupportKind::Normal => {
                    project(bodies, support, &|x| displacement(number, x))
                }
                _ => BTreeMap::new(),
            });
        }
        // Values of the same point are the same up to the round-off of the fields that they come from.
        let sizes: Vec<f64> = coefficients.iter().map(|c| c.values().map(|u| u.amax()).fold(0.0, f64::max)).collect();
        let mut offset = vec![0.0; bodies.unknowns()];
        for (&f, list) in &self.held {
            let mut known: Vec<(Point<D>, f64)> = Vec::new();
            let mut value = Point::<D>::zeros();
            let mut size = 0.0f64;
            for h in list {
                let Source::Prescribed { support } = h.source else { continue };
                size = size.max(sizes[support]);
                let wanted = coefficients[support].get(&f).map_or(0.0, |c| {
                    if supports[support].kind == SupportKind::Normal { c[0] } else { h.direction.dot(c) }
                });
                let mut rest = h.direction;
                for (b, _) in &known {
                    rest -= b * b.dot(&rest);
                }
                if rest.norm() > 1e-9 {
                    let along = (wanted - h.direction.dot(&value)) / rest.norm();
                    let unit = rest.normalize();
                    value += unit * along;
                    known.push((unit, along));
                } else if (h.direction.dot(&value) - wanted).abs() > 1e-9 * size {
                    let first = list.iter().find_map(|o| match o.source {
                        Source::Prescribed { support: s } if s != support => Some(s),
                        _ => None,
                    });
                    return Err(SupportError::Contradiction {
                        first: supports[first.unwrap_or(support)].name.clone(),
                        second: supports[support].name.clone(),
                        position: place(bodies, f),
                        a: h.direction.dot(&value),
                        b: wanted,
                    });
                }
            }
            for i in 0..D {
                offset[f as usize * D + i] = value[i];
            }
        }
        Ok(offset)
    }
}

fn axis<const D: usize>(i: usize) -> Point<D> {
    Point::<D>::from_fn(|k, _| f64::from(u8::from(k == i)))
}

fn list_rank<const D: usize>(list: &[Held<D>]) -> usize {
    orthonormal(list).len()
}

fn orthonormal<const D: usize>(list: &[Held<D>]) -> Vec<Point<D>> {
    let mut basis: Vec<Point<D>> = Vec::new();
    for h in list {
        let mut rest = h.direction;
        for b in &basis {
            rest -= b * b.dot(&rest);
        }
        if rest.norm() > 1e-9 {
            basis.push(rest.normalize());
        }
    }
    basis
}

/// An orthonormal frame that begins with the held directions; the axes themselves where that is possible.
fn frame<const D: usize>(list: &[Held<D>]) -> Vec<Point<D>> {
    let mut basis = orthonormal(list);
    while basis.len() < D {
        let candidate = (0..D)
            .map(|i| {
                let mut rest = axis::<D>(i);
                for b in &basis {
                    rest -= b * b.dot(&rest);
                }
                rest
            })
            .max_by(|a, b| a.norm().total_cmp(&b.norm()));
        match candidate {
            Some(c) => basis.push(c.normalize()),
            None => break,
        }
    }
    basis
}

fn global<const D: usize>(bodies: &Bodies<D>, body: usize, function: u32) -> u32 {
    (bodies.list[body].first / D) as u32 + function
}

/// Where a function sits, for messages.
fn place<const D: usize>(bodies: &Bodies<D>, f: u32) -> String {
    for body in &bodies.list {
        let first = (body.first / D) as u32;
        if f >= first && f < first + body.dofs.count() as u32 {
            let node = (0..body.mesh.nodes().len() as u32).find(|v| body.dofs.vertex(*v) == Some(f - first));
            if let Some(node) = node {
                let x = &body.mesh.nodes()[node as usize];
                let list: Vec<String> = x.iter().map(|v| format!("{v:.6}")).collect();
                return format!("({}) of `{}`", list.join(", "), body.name);
            }
            return format!("on an edge of `{}`", body.name);
        }
    }
    String::new()
}

/// Vertices of a support's group.
fn vertices<const D: usize>(bodies: &Bodies<D>, support: &Support) -> BTreeSet<u32> {
    let mesh = &bodies.list[support.body].mesh;
    let mut out: BTreeSet<u32> = support.group.vertices.iter().copied().collect();
    for side in &support.group.sides {
        out.extend(mesh.side_vertices(*side));
    }
    for &cell in &support.group.cells {
        out.extend(mesh.vertices(cell as usize));
    }
    out
}

/// All functions of a support's group.
pub(crate) fn functions<const D: usize>(bodies: &Bodies<D>, support: &Support) -> BTreeSet<u32> {
    let body = &bodies.list[support.body];
    let mut out = BTreeSet::new();
    let mut add = |f: u32| out.insert(global(bodies, support.body, f));
    for v in &support.group.vertices {
        body.dofs.vertex(*v).map(&mut add);
    }
    for side in &support.group.sides {
        let list = body.dofs.functions(side.cell as usize);
        for k in body.dofs.on_side(*side) {
            add(list[k]);
        }
    }
    for &cell in &support.group.cells {
        for f in body.dofs.functions(cell as usize) {
            add(*f);
        }
    }
    out
}

/// The outward normal that all sides of a group share.
fn common_normal<const D: usize>(bodies: &Bodies<D>, support: &Support) -> Result<Point<D>, SupportError> {
    let surface = bodies.surface(support.body, support.group.sides.clone());
    let mut normals: Vec<Point<D>> = Vec::new();
    for face in 0..surface.sides.len() {
        let shape = surface.shape(face);
        for s in shape.vertices().iter().copied().chain([shape.centre()]) {
            normals.push(surface.at(face, &s).area_normal().normalize());
        }
    }
    let mean = normals.iter().sum::<Point<D>>().normalize();
    let worst = normals.iter().map(|n| (n - mean).norm()).fold(0.0, f64::max);
    if normals.is_empty() || worst.is_nan() || worst > 1e-6 {
        return Err(SupportError::NotFlat { support: support.name.clone(), degrees: worst.to_degrees() });
    }
    // Normals along an axis are that axis exactly.
    let largest = mean.iamax();
    Ok(if mean[largest].abs() > 1.0 - 1e-12 { axis::<D>(largest) * mean[largest].signum() } else { mean })
}

/// Coefficients of a prescribed displacement: its values at vertices, and the best fit on edges and sides.
pub(crate) fn project<const D: usize>(
    bodies: &Bodies<D>,
    support: &Support,
    displacement: &dyn Fn(&Point<D>) -> Point<D>,
) -> BTreeMap<u32, Point<D>> {
    let body = &bodies.list[support.body];
    let mut out: BTreeMap<u32, Point<D>> = BTreeMap::new();
    let mut scale = 0.0f64;
    for v in vertices(bodies, support) {
        let value = displacement(&body.mesh.nodes()[v as usize]);
        scale = scale.max(value.amax());
        if let Some(f) = body.dofs.vertex(v) {
            out.insert(global(bodies, support.body, f), value);
        }
    }
    if body.degree == 1 {
        return out;
    }
    // What vertices leave over goes to the edges by least squares, and what these leave over to the sides: so that two
    // groups agree on the edge that they share.
    for entity in edges(body, &support.group.sides).iter().chain(&interiors(body, &support.group.sides)) {
        fit(bodies, support.body, entity, scale, displacement, &mut out);
    }
    out
}

/// An edge or a side of a cell: the places of its own functions in the list of the cell, and quadrature points in the
/// coordinates of the cell with their weights.
struct Entity {
    cell: usize,
    own: Vec<usize>,
    points: Vec<(Local, f64)>,
}

/// The edges of sides of cells; those shared by several sides once for each.
fn edges<const D: usize>(body: &Body<D>, sides: &[Side]) -> Vec<Entity> {
    let mut out = Vec::new();
    let mut at = Values::default();
    for side in sides {
        let (cell, shape) = (side.cell as usize, body.mesh.shape(side.cell as usize));
        let corners = shape.sides()[side.side as usize];
        for (e, [a, b]) in shape.edges().iter().enumerate() {
            if !(corners.contains(a) && corners.contains(b)) {
                continue;
            }
            let own = |mode: &Mode| matches!(mode, Mode::Edge(edge, _) if *edge as usize == e);
            let [from, to] = [shape.vertices()[*a], shape.vertices()[*b]];
            let along: Local = std::array::from_fn(|k| 0.5 * (to[k] - from[k]));
            let points = (rule(CellShape::Line, body.degree + 2).into_iter())
                .map(|(s, w)| {
                    let xi: Local = std::array::from_fn(|k| from[k] + (1.0 + s[0]) * along[k]);
                    body.mesh.map(cell).tabulate(&xi, &mut at);
                    let (_, jacobian) = body.mesh.jacobian(cell, &at);
                    (xi, w * (jacobian * Point::<D>::from_fn(|k, _| along[k])).norm())
                })
                .collect();
            out.push(Entity { cell, own: places(body, cell, own), points });
        }
    }
    out
}

/// The sides themselves, in space.
fn interiors<const D: usize>(body: &Body<D>, sides: &[Side]) -> Vec<Entity> {
    let entity = |side: &Side| {
        let (cell, shape) = (side.cell as usize, body.mesh.shape(side.cell as usize));
        let own = |mode: &Mode| matches!(mode, Mode::Side(number, _) if *number == side.side);
        let points = (rule(body.mesh.side_shape(*side), body.degree + 2).into_iter())
            .map(|(s, w)| {
                let (x, tangents) = body.mesh.on_side(*side, &s);
                (shape.on_side(side.side as usize, &s).0, w * FacePoint { x, tangents }.area_normal().norm())
            })
            .collect();
        Entity { cell, own: places(body, cell, own), points }
    };
    if D == 3 { sides.iter().map(entity).collect() } else { Vec::new() }
}

fn places<const D: usize>(body: &Body<D>, cell: usize, own: impl Fn(&Mode) -> bool) -> Vec<usize> {
    let modes = body.dofs.basis(cell).modes();
    (0..modes.len()).filter(|&k| own(&modes[k])).collect()
}

/// Fits the functions of an edge or side to what those known leave over of a displacement, unless that is round-off of
/// `scale`.
fn fit<const D: usize>(
    bodies: &Bodies<D>,
    number: usize,
    entity: &Entity,
    scale: f64,
    displacement: &dyn Fn(&Point<D>) -> Point<D>,
    known: &mut BTreeMap<u32, Point<D>>,
) {
    let body = &bodies.list[number];
    let n = entity.own.len();
    let function = |k: usize| {
        let (f, sign) = body.dofs.function(entity.cell, k);
        (global(bodies, number, f), sign)
    };
    if entity.own.iter().all(|&k| known.contains_key(&function(k).0)) {
        return;
    }
    let (mut at, mut of_map) = (Values::default(), Values::default());
    let mut mass = DMatrix::<f64>::zeros(n, n);
    let mut rhs = DMatrix::<f64>::zeros(n, D);
    let mut worst = 0.0f64;
    for (xi, w) in &entity.points {
        body.dofs.basis(entity.cell).tabulate(xi, &mut at);
        body.mesh.map(entity.cell).tabulate(xi, &mut of_map);
        let mut left = displacement(&body.mesh.position(entity.cell, &of_map));
        for (k, value) in at.value.iter().enumerate() {
            let (f, sign) = function(k);
            if let Some(u) = known.get(&f) {
                left -= u * (sign * value);
            }
        }
        worst = worst.max(left.amax());
        for (a, &k) in entity.own.iter().enumerate() {
            let of = |k: usize| function(k).1 * at.value[k];
            for i in 0..D {
                rhs[(a, i)] += w * of(k) * left[i];
            }
            for (b, &l) in entity.own.iter().enumerate() {
                mass[(a, b)] += w * of(k) * of(l);
            }
        }
    }
    let solved = mass.cholesky().filter(|_| worst > 1e-14 * scale).map(|factor| factor.solve(&rhs));
    for (a, &k) in entity.own.iter().enumerate() {
        let value = solved.as_ref().map_or(Point::<D>::zeros(), |s| Point::<D>::from_fn(|i, _| s[(a, i)]));
        known.insert(function(k).0, value);
    }
}

/// Stiffness of elastic beds: the support, the unknowns of each side, and its matrix.
pub(crate) fn beds<const D: usize>(bodies: &Bodies<D>, supports: &[Support]) -> Vec<(usize, Vec<u32>, Vec<f64>)> {
    let mut out = Vec::new();
    for (number, support) in supports.iter().enumerate() {
        let SupportKind::Spring(stiffness) = &support.kind else { continue };
        let surface = bodies.surface(support.body, support.group.sides.clone());
        let mut trace = Vec::new();
        for face in 0..surface.sides.len() {
            let mut matrix = Vec::new();
            let mut unknowns = Vec::new();
            for (s, w) in rule(surface.shape(face), bodies.list[support.body].degree + 1) {
                let point = surface.at(face, &s);
                let w = w * point.area_normal().norm() * surface.measure(&point.x);
                trace.clear();
                surface.trace(face, &s, &mut trace);
                let n = trace.len() * D;
                if matrix.is_empty() {
                    matrix = vec![0.0; n * n];
                    unknowns = trace.iter().flat_map(|(u, _)| (0..D as u32).map(move |i| u + i)).collect();
                }
                for (a, (_, va)) in trace.iter().enumerate() {
                    for (b, (_, vb)) in trace.iter().enumerate() {
                        for i in 0..D {
                            matrix[(a * D + i) * n + b * D + i] += w * stiffness[i] * va * vb;
                        }
                    }
                }
            }
            out.push((number, unknowns, matrix));
        }
    }
    out
}
