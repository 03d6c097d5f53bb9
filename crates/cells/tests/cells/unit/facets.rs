//! Of `facets`.

use signorini_cells::error::CellsError;
use signorini_cells::facets::FacetBody;
use signorini_cells::moments::box_points;
use signorini_cells::region::{Filling, Integration, Region};
use signorini_cells::tree::CellTree;
use signorini_fem::cut::End;
use signorini_geometry::mesh::TriangleMesh;
use signorini_geometry::{Aabb, Point, Vector};

fn cube(low: [f64; 3], high: [f64; 3]) -> TriangleMesh {
    let corner = |i: usize| Point::<3>::from_fn(|k, _| if i >> k & 1 == 1 { high[k] } else { low[k] });
    let triangles = [
        [0, 2, 3],
        [0, 3, 1],
        [4, 5, 7],
        [4, 7, 6],
        [0, 1, 5],
        [0, 5, 4],
        [2, 6, 7],
        [2, 7, 3],
        [0, 4, 6],
        [0, 6, 2],
        [1, 3, 7],
        [1, 7, 5],
    ];
    TriangleMesh::new((0..8).map(corner).collect(), &triangles).unwrap()
}

#[test]
fn moments_and_surface_of_a_cube_are_exact_also_with_its_sides_on_those_of_cells() {
    let tree = CellTree::new(Aabb::new(Point::<3>::zeros(), Point::<3>::repeat(1.0)), [4, 4, 4]).unwrap();
    for (low, high) in [([0.1, 0.2, 0.3], [0.7, 0.9, 0.8]), ([0.25, 0.25, 0.5], [0.75, 1.0, 0.75])] {
        let body = FacetBody::new(cube(low, high)).unwrap();
        let (mut sums, mut area, mut closed) = ([0.0; 2], 0.0, Vector::<3>::zeros());
        for leaf in tree.leaves() {
            let rule = body.rule(&leaf.bounds, &Integration::Exact { points: None }, 2);
            let points: Vec<(Point<3>, f64)> = if rule.filling == Filling::Full {
                box_points(&leaf.bounds, 3)
            } else {
                rule.volume.iter().map(|p| (p.x, p.weight)).collect()
            };
            for (x, w) in points {
                sums[0] += w;
                sums[1] += w * x[0].powi(4) * x[1].powi(3) * x[2].powi(2);
            }
            area += rule.boundary.iter().map(|p| p.weight).sum::<f64>();
            closed += rule.boundary.iter().map(|p| p.normal * p.weight).sum::<Vector<3>>();
        }
        let moment = |k: usize, n: i32| (high[k].powi(n + 1) - low[k].powi(n + 1)) / f64::from(n + 1);
        let exact = [moment(0, 0) * moment(1, 0) * moment(2, 0), moment(0, 4) * moment(1, 3) * moment(2, 2)];
        let d: Vec<f64> = (0..3).map(|k| high[k] - low[k]).collect();
        assert!((sums[0] - exact[0]).abs() < 1e-14 && (sums[1] - exact[1]).abs() < 1e-14, "{sums:?} {exact:?}");
        assert!((area - 2.0 * (d[0] * d[1] + d[1] * d[2] + d[2] * d[0])).abs() < 1e-13 && closed.norm() < 1e-13);
    }
}

/// A piece that is small against a side of its cell touches the cell beside it there.
#[test]
fn small_sections_of_sides_are_found() {
    let body = FacetBody::new(cube([0.0; 3], [1.0; 3])).unwrap();
    let cell = Aabb::new(Point::<3>::repeat(-1.0), Point::<3>::new(0.01, 0.02, 0.03));
    assert!(body.side_rule(&cell, 0, End::High, 0).is_empty());
    for axis in 0..3 {
        assert!(!body.places_on_side(&cell, axis, End::High).is_empty(), "{axis}");
        assert!(body.places_on_side(&cell, axis, End::Low).is_empty(), "{axis}");
    }
}

#[test]
fn an_open_surface_is_told() {
    let closed = cube([0.0; 3], [1.0; 3]);
    let open = TriangleMesh::new(closed.vertices().to_vec(), &closed.triangles()[..10]).unwrap();
    assert!(matches!(FacetBody::new(open), Err(CellsError::OpenSurface { share, .. }) if share > 0.5));
    // Two parts in one another, and a cavity: right, and with its outside inwards.
    let with = |other: TriangleMesh, turned: bool| {
        let vertices = [closed.vertices(), other.vertices()].concat();
        let own = other.triangles().iter().map(|t| t.map(|v| v + 8));
        let own = own.map(|[a, b, c]| if turned { [a, c, b] } else { [a, b, c] });
        let all: Vec<[u32; 3]> = closed.triangles().iter().copied().chain(own).collect();
        FacetBody::new(TriangleMesh::new(vertices, &all).unwrap())
    };
    let inner = || cube([0.3; 3], [0.6; 3]);
    assert!(with(cube([2.0; 3], [3.0; 3]), false).is_ok() && with(inner(), true).is_ok());
    for wrong in [inner(), cube([0.5, 0.2, 0.3], [1.5, 0.9, 0.8])] {
        let Err(CellsError::OverlappingSurface { at }) = with(wrong, false) else { panic!("an overlap") };
        assert!(at.iter().all(|x| (0.2..1.0).contains(x)), "{at:?}");
    }
}
