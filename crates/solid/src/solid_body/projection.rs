//! The functions of a group, and the coefficients of a field on it: at vertices its values, on edges and sides the best fit.

mod spline;

use crate::body::Body;
use nalgebra::DMatrix;
use signorini_contact::FacePoint;
use signorini_fem::hierarchic::{Mode, Values};
use signorini_fem::rules::rule;
use signorini_fem::{CellShape, Group, Local, Side};
use signorini_geometry::Point;
use std::collections::{BTreeMap, BTreeSet};

/// The vertices of a group.
pub(super) fn vertices<const D: usize>(body: &Body<D>, group: &Group) -> BTreeSet<u32> {
    let mesh = &body.mesh;
    let of_sides = group.sides.iter().flat_map(|side| mesh.side_vertices(*side));
    let of_cells = group.cells.iter().flat_map(|cell| mesh.vertices(*cell as usize));
    group.vertices.iter().copied().chain(of_sides).chain(of_cells).collect()
}

/// All functions of a group.
pub(super) fn functions<const D: usize>(body: &Body<D>, group: &Group) -> BTreeSet<u32> {
    let dofs = &body.dofs;
    let of_side = |side: &Side| {
        let list = dofs.functions(side.cell as usize);
        dofs.on_side(*side).into_iter().map(|k| list[k]).collect::<Vec<u32>>()
    };
    let of_vertices = group.vertices.iter().filter_map(|v| dofs.vertex(*v));
    let of_cells = group.cells.iter().flat_map(|cell| dofs.functions(*cell as usize).iter().copied());
    of_vertices.chain(group.sides.iter().flat_map(of_side)).chain(of_cells).collect()
}

/// Coefficients of a field: its values at vertices, and the best fit on edges and sides.
pub(super) fn project<const D: usize>(
    body: &Body<D>,
    group: &Group,
    displacement: &dyn Fn(&Point<D>) -> Point<D>,
) -> BTreeMap<u32, Point<D>> {
    if body.dofs.is_spline() {
        return spline::project(body, group, displacement);
    }
    let mut out: BTreeMap<u32, Point<D>> = BTreeMap::new();
    let mut scale = 0.0f64;
    for v in vertices(body, group) {
        let value = displacement(&body.mesh.nodes()[v as usize]);
        scale = scale.max(value.amax());
        if let Some(f) = body.dofs.vertex(v) {
            out.insert(f, value);
        }
    }
    if body.degree == 1 {
        return out;
    }
    // What vertices leave over goes to the edges by least squares, and what these leave over to the sides: so that two
    // groups agree on the edge that they share.
    for entity in edges(body, &group.sides).iter().chain(&interiors(body, &group.sides)) {
        fit(body, entity, scale, displacement, &mut out);
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
    body: &Body<D>,
    entity: &Entity,
    scale: f64,
    displacement: &dyn Fn(&Point<D>) -> Point<D>,
    known: &mut BTreeMap<u32, Point<D>>,
) {
    let n = entity.own.len();
    let function = |k: usize| body.dofs.function(entity.cell, k);
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
