//! The pressure that is shown, against exact ones, on cells whose functions have no integral: vertices of quadratic
//! triangles, and the axis of a body of revolution.

use crate::pressed::{MORTAR, NITSCHE, Way, pressed};
use signorini_fem::block::block;
use signorini_fem::{CellShape, Mesh, Side};
use signorini_geometry::rigid_shape::Plane;
use signorini_geometry::{Point, Vector};
use signorini_mechanics::SiteResult;
use signorini_solid::{Elastic, Space};

const E: f64 = 1000.0;
const NU: f64 = 0.3;
const MATERIAL: Elastic = Elastic { youngs_modulus: E, poissons_ratio: NU };

fn even(from: f64, to: f64, n: usize) -> Vec<f64> {
    (0..=n).map(|k| from + (to - from) * k as f64 / n as f64).collect()
}

/// Every cell of a box cut into six tetrahedra of order 2 (Kuhn), with the groups of the box.
fn tetrahedra(of: &Mesh<3>) -> Mesh<3> {
    let mut out = Mesh::<3>::new(of.nodes().to_vec());
    for cell in 0..of.cell_count() {
        let nodes = of.cell_nodes(cell);
        let at = |c: [usize; 3]| nodes[c[0] + 3 * (c[1] + 3 * c[2])];
        for (axes, odd) in [
            ([0, 1, 2], false),
            ([1, 2, 0], false),
            ([2, 0, 1], false),
            ([0, 2, 1], true),
            ([2, 1, 0], true),
            ([1, 0, 2], true),
        ] {
            let mut corners = vec![[0usize; 3]];
            for axis in axes {
                let mut next = corners[corners.len() - 1];
                next[axis] = 2;
                corners.push(next);
            }
            if odd {
                corners.swap(1, 2);
            }
            let mut list: Vec<u32> = corners.iter().map(|c| at(*c)).collect();
            for &[a, b] in CellShape::Tetrahedron.edges() {
                list.push(at(std::array::from_fn(|k| (corners[a][k] + corners[b][k]) / 2)));
            }
            out.add_cell(CellShape::Tetrahedron, 2, &list);
        }
    }
    let boundary = out.boundary();
    for (name, group) in of.groups() {
        let on: std::collections::HashSet<u32> = group.sides.iter().flat_map(|s| of.side_vertices(*s)).collect();
        let sides: Vec<Side> =
            boundary.iter().copied().filter(|s| out.side_vertices(*s).iter().all(|v| on.contains(v))).collect();
        out.group_mut(name).sides = sides;
    }
    out
}

/// The nodes of a body on a rigid plane under its bottom: positions at rest, and pressures.
fn on_a_plane<const D: usize>(
    mesh: Mesh<D>,
    space: Space,
    degree: usize,
    way: Way,
    held: &[(&str, [bool; 3])],
    (displacement, parameters): (fn(&Point<3>, &[f64]) -> Point<3>, &[f64]),
) -> Vec<SiteResult> {
    let plane = Plane { point: Point::<3>::zeros(), normal: Vector::<3>::ith(D - 1, 1.0) };
    pressed(mesh, space, (degree, MATERIAL), way, held, displacement, (parameters, plane))
}

/// Where a point was at rest that an exact displacement brought to `x`.
fn at_rest(x: Point<3>, displacement: impl Fn(&Point<3>) -> Point<3>) -> Point<3> {
    (0..60).fold(x, |at, _| x - displacement(&at))
}

/// Bending: `σ_zz = -(p + q x)`, no other stress. Quadratic functions hold it.
fn bent(way: Way, tets: bool, p: f64, q: f64) -> f64 {
    let mesh = block::<3>(&[even(0.0, 1.0, 2), even(0.0, 1.0, 2), even(0.0, 1.0, 1)], 2, |x| x);
    let mesh = if tets { tetrahedra(&mesh) } else { mesh };
    let exact = |x: &Point<3>, of: &[f64]| {
        let (p, q) = (of[0], of[1]);
        let s = -(p + q * x[0]);
        Point::<3>::new(
            NU / E * (p * x[0] + 0.5 * q * (x[0] * x[0] - x[1] * x[1])) + 0.5 * q / E * x[2] * x[2],
            NU / E * (p + q * x[0]) * x[1],
            s / E * x[2],
        )
    };
    let sites = on_a_plane(mesh, Space::Solid, 2, way, &[("top", [true; 3])], (exact, &[p, q]));
    let error = |n: &SiteResult| (n.shown_pressure() / (p + q * at_rest(n.x, |x| exact(x, &[p, q]))[0]) - 1.0).abs();
    sites.iter().filter(|n| n.weight > 0.0).map(error).fold(0.0, f64::max)
}

#[test]
fn even_and_linear_pressures_on_quadratic_faces_are_exact() {
    for tets in [false, true] {
        for q in [0.0, 5.0] {
            let worst = bent(MORTAR, tets, 10.0, q);
            assert!(worst < 1e-9, "{tets}: {worst:e}");
        }
    }
    // By the stress at points.
    for q in [0.0, 5.0] {
        let worst = bent(NITSCHE, false, 10.0, q);
        assert!(worst < 1e-9, "{worst:e}");
    }
}

/// The largest error within half the radius of `p = 2μ (2A - 6B r²)`, the state of `φ = A (z² - r²/2) + B (z⁴ - 3 z² r² +
/// 3/8 r⁴)` (Green & Zerna 1954: `u_r = (1-2ν) φ_r + z φ_rz`, `u_z = -2(1-ν) φ_z + z φ_zz`), relative to that on the axis.
fn round(way: Way, degree: usize, n: usize, b: f64) -> f64 {
    const A: f64 = 0.01;
    let mesh = block::<2>(&[even(0.0, 1.0, n), even(0.0, 1.0, n)], 1, |x| x);
    let exact = |x: &Point<3>, of: &[f64]| {
        let (r, z, b) = (x[0], x[1], of[0]);
        let slope_r = -A * r + b * (-6.0 * z * z * r + 1.5 * r.powi(3));
        let slope_z = 2.0 * A * z + b * (4.0 * z.powi(3) - 6.0 * z * r * r);
        let curved = 2.0 * A + b * (12.0 * z * z - 6.0 * r * r);
        let radial = (1.0 - 2.0 * NU) * slope_r - 12.0 * b * z * z * r;
        Point::<3>::new(radial, -2.0 * (1.0 - NU) * slope_z + z * curved, 0.0)
    };
    let held = [("top", [true, true, false]), ("right", [true, true, false]), ("left", [true, false, false])];
    let sites = on_a_plane(mesh, Space::Axisymmetric, degree, way, &held, (exact, &[b]));
    let pressure = |r: f64| E / (1.0 + NU) * (2.0 * A - 6.0 * b * r * r);
    let error = |(r, p): (f64, f64)| (p - pressure(r)).abs() / pressure(0.0);
    // The node on the axis has no pressure of its own where its function has no integral.
    let list =
        sites.iter().filter(|n| n.weight > 0.0).map(|n| (at_rest(n.x, |x| exact(x, &[b]))[0], n.shown_pressure()));
    list.filter(|n| n.0 < 0.5).map(error).fold(0.0, f64::max)
}

#[test]
fn pressures_at_the_axis_are_right_for_every_degree() {
    for degree in 1..=5 {
        for way in [MORTAR, NITSCHE] {
            let worst = round(way, degree, 2, 0.0);
            assert!(worst < 1e-9, "even, {way:?}, degree {degree}: {worst:e}");
            if degree > 3 {
                let worst = round(way, degree, 2, 0.001);
                assert!(worst < 1e-9, "{way:?}, degree {degree}: {worst:e}");
            }
        }
    }
}

/// With linear functions but for the logarithm of the cell size; with the plain mean of the slope it is order 1.
#[test]
fn pressures_at_the_axis_are_of_second_order() {
    for degree in [1, 2] {
        let [coarse, fine] = [16, 32].map(|n| round(MORTAR, degree, n, 0.002));
        let order = (coarse / fine).log2();
        println!("degree {degree}: {coarse:e} {fine:e} order {order}");
        assert!(order > if degree == 1 { 1.75 } else { 1.95 }, "degree {degree}: {order}, {fine:e}");
    }
}
