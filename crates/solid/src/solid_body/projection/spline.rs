//! Coefficients of a field on a group of a spline, whose control points are not on the body.
//!
//! First the functions that are alone at a corner of a patch take the values there, then by least squares those that are left on
//! the edges of patches, on their sides, and in cells. What two groups share has then the same values in both.

use crate::body::Body;
use signorini_contact::FacePoint;
use signorini_fem::hierarchic::Values;
use signorini_fem::rules::rule;
use signorini_fem::small::determinant;
use signorini_fem::{CellShape, Group, Local};
use signorini_geometry::Point;
use signorini_solve::SymmetricMatrix;
use signorini_solve::cholesky::Symbolic;
use std::collections::BTreeMap;

/// An edge, a side or a cell: the places of the functions that do not vanish there, and points with what they stand for.
struct Part {
    cell: usize,
    places: Vec<usize>,
    points: Vec<(Local, f64)>,
}

/// Values smaller than this do not reach a part.
const NOTHING: f64 = 1e-12;

/// The coefficients of all functions of the sides, cells and corners of a group.
pub(in crate::solid_body) fn project<const D: usize>(
    body: &Body<D>,
    group: &Group,
    field: &dyn Fn(&Point<D>) -> Point<D>,
) -> BTreeMap<u32, Point<D>> {
    let mut out = BTreeMap::new();
    for v in super::vertices(body, group) {
        if let Some(f) = body.dofs.vertex(v) {
            out.insert(f, field(&body.mesh.nodes()[v as usize]));
        }
    }
    if D == 3 {
        fit(body, &edges(body, group), field, &mut out);
    }
    fit(body, &sides(body, group), field, &mut out);
    fit(body, &cells(body, group), field, &mut out);
    out
}

/// The edges of patches on the sides of a group.
fn edges<const D: usize>(body: &Body<D>, group: &Group) -> Vec<Part> {
    let mut out = Vec::new();
    let (mut at, mut of_map) = (Values::default(), Values::default());
    for side in &group.sides {
        let cell = side.cell as usize;
        let (basis, shape) = (body.dofs.basis(cell), body.mesh.shape(cell));
        let corners = shape.sides()[side.side as usize];
        for [a, b] in shape.edges().iter().filter(|e| e.iter().all(|v| corners.contains(v))) {
            let [from, to] = [shape.vertices()[*a], shape.vertices()[*b]];
            let along: Local = std::array::from_fn(|k| 0.5 * (to[k] - from[k]));
            let on = |s: f64| -> Local { std::array::from_fn(|k| from[k] + (1.0 + s) * along[k]) };
            basis.tabulate(&on(0.1), &mut at);
            let places: Vec<usize> = (0..basis.len()).filter(|&k| at.value[k].abs() > NOTHING).collect();
            // Inside of a patch more functions reach an edge.
            if places.len() != basis.degree() + 1 {
                continue;
            }
            let point = |(s, w): (Local, f64)| {
                let xi = on(s[0]);
                body.mesh.map(cell).tabulate(&xi, &mut of_map);
                let (_, jacobian) = body.mesh.jacobian(cell, &of_map);
                (xi, w * (jacobian * Point::<D>::from_fn(|k, _| along[k])).norm())
            };
            let points = rule(CellShape::Line, basis.degree() + MORE).into_iter().map(point).collect();
            out.push(Part { cell, places, points });
        }
    }
    out
}

/// Points along each direction beyond the degree: functions are rational.
const MORE: usize = 4;

fn sides<const D: usize>(body: &Body<D>, group: &Group) -> Vec<Part> {
    let part = |side: &signorini_fem::Side| {
        let cell = side.cell as usize;
        let point = |(s, w): (Local, f64)| {
            let (x, tangents) = body.mesh.on_side(*side, &s);
            let xi = body.mesh.shape(cell).on_side(side.side as usize, &s).0;
            (xi, w * FacePoint { x, tangents }.area_normal().norm())
        };
        let points = rule(body.mesh.side_shape(*side), body.degree + MORE).into_iter().map(point).collect();
        Part { cell, places: body.dofs.on_side(*side), points }
    };
    group.sides.iter().map(part).collect()
}

fn cells<const D: usize>(body: &Body<D>, group: &Group) -> Vec<Part> {
    let mut at = Values::default();
    let part = |cell: &u32| {
        let cell = *cell as usize;
        let mut point = |(xi, w): (Local, f64)| {
            body.mesh.map(cell).tabulate(&xi, &mut at);
            (xi, w * determinant(&body.mesh.jacobian(cell, &at).1))
        };
        let points = rule(body.mesh.shape(cell), body.degree + 2).into_iter().map(&mut point).collect();
        Part { cell, places: (0..body.dofs.basis(cell).len()).collect(), points }
    };
    group.cells.iter().map(part).collect()
}

/// Fits the functions of parts that are not known yet to what those known leave over of a field.
fn fit<const D: usize>(
    body: &Body<D>,
    parts: &[Part],
    field: &dyn Fn(&Point<D>) -> Point<D>,
    known: &mut BTreeMap<u32, Point<D>>,
) {
    let mut unknowns: BTreeMap<u32, u32> = BTreeMap::new();
    for part in parts {
        let functions = body.dofs.functions(part.cell);
        for f in part.places.iter().map(|&k| functions[k]).filter(|f| !known.contains_key(f)) {
            unknowns.entry(f).or_insert(0);
        }
    }
    unknowns.values_mut().zip(0..).for_each(|(number, k)| *number = k);
    if unknowns.is_empty() {
        return;
    }
    let mut rhs = vec![vec![0.0; unknowns.len()]; D];
    let (mut cliques, mut matrices): (Vec<Vec<u32>>, Vec<Vec<f64>>) = Default::default();
    let (mut at, mut of_map) = (Values::default(), Values::default());
    for part in parts {
        let functions = body.dofs.functions(part.cell);
        let own: Vec<(usize, u32)> =
            part.places.iter().filter_map(|&k| unknowns.get(&functions[k]).map(|n| (k, *n))).collect();
        let mut matrix = vec![0.0; own.len() * own.len()];
        for (xi, w) in &part.points {
            body.dofs.basis(part.cell).tabulate(xi, &mut at);
            body.mesh.map(part.cell).tabulate(xi, &mut of_map);
            let mut left = field(&body.mesh.position(part.cell, &of_map));
            for &k in &part.places {
                if let Some(c) = known.get(&functions[k]) {
                    left -= c * at.value[k];
                }
            }
            for (a, (k, n)) in own.iter().enumerate() {
                (0..D).for_each(|i| rhs[i][*n as usize] += w * at.value[*k] * left[i]);
                for (b, (l, _)) in own.iter().enumerate() {
                    matrix[a * own.len() + b] += w * at.value[*k] * at.value[*l];
                }
            }
        }
        cliques.push(own.iter().map(|o| o.1).collect());
        matrices.push(matrix);
    }
    let mut mass = SymmetricMatrix::from_cliques(unknowns.len(), &cliques);
    for (clique, matrix) in cliques.iter().zip(&matrices) {
        mass.add(clique, matrix, 1.0);
    }
    // The functions of a spline are independent on every span that they reach: the matrix is positive definite.
    let solved: Vec<Vec<f64>> = match Symbolic::default().factor(mass) {
        Ok(factor) => rhs.iter().map(|r| factor.solve(r).unwrap_or_else(|_| vec![0.0; r.len()])).collect(),
        Err(_) => rhs.iter().map(|r| vec![0.0; r.len()]).collect(),
    };
    for (f, n) in unknowns {
        known.insert(f, Point::<D>::from_fn(|i, _| solved[i][n as usize]));
    }
}
