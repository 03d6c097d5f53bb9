//! Features of boxes that meet, against what they are, and their derivatives against differences.

use super::*;
use crate::Matrix;
use nalgebra::Rotation3;

/// A box about a point, with the diagonals of its sides as triangles.
fn block(half: [f64; 3]) -> Features {
    let corner = |k: usize| Point::<3>::from_fn(|i, _| if k >> i & 1 == 1 { half[i] } else { -half[i] });
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles: Vec<[u32; 3]> = faces.iter().flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]]).collect();
    Features::new(TriangleMesh::new((0..8).map(corner).collect(), &triangles).unwrap()).unwrap()
}

fn placed(features: &Features, centre: [f64; 3], turn: [f64; 3]) -> Placed<'_> {
    let rotation: Matrix<3> = Rotation3::from_scaled_axis(Vector::<3>::from(turn)).into_inner();
    Placed { features, rotation, origin: Point::<3>::zeros(), centre: Point::<3>::from(centre) }
}

#[test]
fn a_box_has_six_facets_twelve_edges_and_eight_corners() {
    let found = block([1.0, 2.0, 3.0]);
    assert_eq!([found.facets().len(), found.edges().len(), found.corners().len()], [6, 12, 8]);
    assert!(found.edges().iter().all(|e| e.is_convex));
    assert!((found.width() - 2.0 * 48.0 / 88.0).abs() < 1e-14);
}

/// Boxes on each other touch by the corners of what they share, all along the normal of the plane between them: of the same size,
/// larger below or above, across each other.
#[test]
fn flat_boxes_touch_by_the_corners_of_what_they_share() {
    let small = block([0.5, 0.5, 0.5]);
    let (wide, long) = (block([1.0, 1.0, 0.5]), block([0.3, 2.0, 0.5]));
    let cases = [(&small, &small), (&small, &wide), (&wide, &small), (&wide, &long), (&long, &wide)];
    for (k, (above, below)) in cases.into_iter().enumerate() {
        let found =
            meetings([&placed(above, [0.0, 0.0, 1.0], [0.0; 3]), &placed(below, [0.0; 3], [0.0; 3])], 1e-9, 1e-9);
        assert!(
            found.iter().all(|m| (m.normal - Vector::<3>::z()).norm() < 1e-12 && m.gap.abs() < 1e-12),
            "{k}: {found:?}"
        );
        let mut places: Vec<[i64; 2]> =
            found.iter().map(|m| [0, 1].map(|i| (1e6 * m.points[0][i]).round() as i64)).collect();
        places.sort_unstable();
        places.dedup();
        assert_eq!(places.len(), 4, "{k}: {found:?}");
    }
}

/// The change of gap and normal is that of differences, for every pair of kinds.
#[test]
fn gaps_and_normals_change_as_by_differences() {
    let (a, b) = (block([1.0, 0.4, 0.3]), block([0.5, 0.8, 0.6]));
    use Feature::{Corner, Edge, Facet};
    let pairs = [
        [Corner(3), Facet(2)],
        [Facet(1), Corner(5)],
        [Edge(2), Edge(7)],
        [Corner(0), Edge(4)],
        [Edge(3), Corner(6)],
        [Corner(1), Corner(2)],
    ];
    let centres = [[0.3, 0.2, 1.9], [0.1, -0.3, 0.2]];
    let turns = [[0.3, -0.7, 0.4], [0.5, 0.2, -0.3]];
    let moves = [Vector::<3>::new(0.3, -0.5, 0.7), Vector::<3>::new(-0.2, 0.4, 0.1)];
    let spins = [Vector::<3>::new(0.6, 0.2, -0.4), Vector::<3>::new(-0.3, 0.5, 0.8)];
    let at = |h: f64| {
        [0, 1].map(|k| {
            let shape = if k == 0 { &a } else { &b };
            let mut out = placed(shape, centres[k], turns[k]);
            out.centre += moves[k] * h;
            out.rotation = Rotation3::from_scaled_axis(spins[k] * h).into_inner() * out.rotation;
            out
        })
    };
    // A pair that is near is measured by its distance, one that touched before by a plane.
    for (on, snap) in pairs.iter().flat_map(|on| [(*on, 1e-9), (*on, f64::INFINITY)]) {
        let found = |h: f64| {
            let [p, q] = at(h);
            meeting([&p, &q], on, snap)
        };
        let Some(now) = found(0.0) else { continue };
        let h = 1e-5;
        let (Some(before), Some(after)) = (found(-h), found(h)) else { panic!("{on:?}") };
        let moved: Vec<Vector<3>> =
            (0..2).map(|k| moves[k] + spins[k].cross(&(now.points[k] - at(0.0)[k].centre))).collect();
        let moved = moved[0] - moved[1];
        let rate = now.normal_rate(&moved, spins);
        let difference = (after.normal - before.normal) / (2.0 * h);
        assert!((rate - difference).norm() < 1e-7, "{on:?} {snap}: {rate} {difference}");
        // Of touching features points are apart by no more than rounding, along the normal.
        if snap < 1.0 || !matches!(on, [Corner(_), Corner(_) | Edge(_)] | [Edge(_), Corner(_)]) {
            let difference = (after.gap - before.gap) / (2.0 * h);
            assert!((now.normal.dot(&moved) - difference).abs() < 1e-8, "{on:?} {snap}");
        }
    }
}

/// Bars that cross edge on edge: one pair, by the nearest points.
#[test]
fn edges_cross() {
    let (a, b) = (block([2.0, 0.1, 0.1]), block([0.1, 2.0, 0.1]));
    let half = 0.1 * 2f64.sqrt();
    let quarter = std::f64::consts::FRAC_PI_4;
    for gap in [0.01, -0.001] {
        let above = placed(&a, [0.0, 0.0, 2.0 * half + gap], [quarter, 0.0, 0.0]);
        let below = placed(&b, [0.0; 3], [0.0, quarter, 0.0]);
        let found = meetings([&above, &below], 0.05, 1e-9);
        let [one] = found[..] else { panic!("{found:?}") };
        assert!((one.gap - gap).abs() < 1e-14 && (one.normal - Vector::<3>::z()).norm() < 1e-12, "{one:?}");
    }
}

/// Bodies that are apart have positive gaps only, however they lie, and the least of them is their distance.
#[test]
fn what_is_apart_has_positive_gaps() {
    let (a, b) = (block([1.0, 0.1, 0.2]), block([0.3, 0.5, 0.1]));
    for k in 0..200 {
        let angle = |i: usize| (0.37 * ((k + 1) * (i + 2)) as f64).sin() * 2.0;
        let direction = Vector::<3>::new(angle(1), angle(2), angle(3)).normalize() * (1.7 + 0.5 * angle(7).abs());
        let first = placed(&a, direction.into(), [angle(3), angle(4), angle(5)]);
        let second = placed(&b, [0.0; 3], [angle(6), angle(8), angle(9)]);
        let found = meetings([&first, &second], 10.0, 1e-9);
        let least = found.iter().map(|m| m.gap).fold(f64::INFINITY, f64::min);
        let moved = |p: &Placed<'_>| p.features.mesh().vertices().iter().map(|x| p.point(x)).collect();
        let mesh = |p: &Placed<'_>| TriangleMesh::new(moved(p), p.features.mesh().triangles()).unwrap();
        let distance = mesh(&first).closest_to_mesh(&mesh(&second)).distance;
        assert!((least - distance).abs() < 1e-12, "{k}: {least} {distance}");
    }
}

/// Two equal boxes side by side, with sides in one plane: what leans into the other overlaps it by its upper corners, which lie on
/// the sides of that one; upright they overlap by corners that lie on its edges. The depth is that of the facet they came through.
#[test]
fn bodies_with_sides_in_one_plane_overlap_by_the_facet_they_came_through() {
    let shape = block([1.5, 1.0, 3.0]);
    let (lean, way) = (0.2f64, 3.5);
    let reaches = 1.5 * lean.cos() + 3.0 * lean.sin();
    for (lean, apart, depth) in [(lean, way, reaches + 1.5 - way), (0.0, 2.999, 1e-3)] {
        let bodies = [placed(&shape, [0.0; 3], [0.0, lean, 0.0]), placed(&shape, [apart, 0.0, 0.0], [0.0; 3])];
        assert!(depth > 0.0);
        for order in [[0, 1], [1, 0]] {
            let found = meetings(order.map(|k| &bodies[k]), 0.0, 1e-9);
            let deepest = found.iter().min_by(|a, b| a.gap.total_cmp(&b.gap)).unwrap();
            assert!((deepest.gap + depth).abs() < 1e-12, "{deepest:?}");
            assert!(deepest.normal.x.abs() > 1.0 - 1e-12);
        }
    }
}
