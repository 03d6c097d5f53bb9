//! Of `relief`.

use signorini::expression::{Names, parse};
use signorini::relief::{FALL, LevelSetTop, MovedHeight, Sampled};
use signorini_geometry::height_field::{HeightField, View};
use signorini_geometry::mesh::TriangleMesh;
use signorini_geometry::{Jet, Real, Vector};

fn ball(view: View) -> LevelSetTop {
    let names = Names { variables: vec!["x", "y", "z"], ..Names::default() };
    let inside = parse("x^2 + (y - 0.1)^2 + (z + 0.2)^2 - 0.25", &names).expect("an expression");
    LevelSetTop { inside, low: -1.0, high: 1.0, view }
}

#[test]
fn the_top_of_a_ball_is_that_of_its_formula() {
    for view in [View::FromAbove, View::FromBelow] {
        let (top, sign) = (ball(view), view.sign());
        for (x, y) in [(0.0, 0.1), (0.2, -0.1), (-0.3, 0.3)] {
            let [jx, jy] = [Jet::<2>::variable(x, 0), Jet::<2>::variable(y, 1)];
            let c = Jet::<2>::constant;
            let exact = c(-0.2) + c(sign) * (c(0.25) - jx * jx - (jy - c(0.1)) * (jy - c(0.1))).powf(0.5);
            let found = top.jet(&Vector::<2>::new(x, y));
            assert!((found.value - exact.value).abs() < 1e-14, "{found:?} {exact:?}");
            assert!((found.gradient - exact.gradient).norm() < 1e-12);
            assert!((found.hessian - exact.hessian).norm() < 1e-11);
        }
        let beyond = top.jet(&Vector::<2>::new(0.9, 0.0));
        assert_eq!((beyond.value, beyond.gradient.norm()), (-sign, 0.0));
    }
}

/// A turned map is the map of the turned function, and is known in a rectangle of its own.
#[test]
fn a_height_is_turned_and_moved() {
    let values: Vec<f64> = (0..30).map(|k| 0.1 * f64::from(k % 6) - 0.3 * f64::from(k / 6)).collect();
    let map = Sampled::of_rows([0.0; 2], [1.0; 2], 6, &values).expect("a map");
    let moved = MovedHeight { height: map, angle: std::f64::consts::FRAC_PI_2, shift: [10.0, 20.0, 0.5] };
    // What lay at (x, y) lies at (10 - y, 20 + x).
    let found = moved.jet(&Vector::<2>::new(10.0 - 2.5, 20.0 + 3.25));
    assert!((found.value - (0.325 - 0.75 + 0.5)).abs() < 1e-12, "{found:?}");
    assert!((found.gradient - Vector::<2>::new(0.3, 0.1)).norm() < 1e-12 && found.hessian.norm() < 1e-12);
    let [low, high] = moved.known_within().expect("a rectangle");
    assert!((low - Vector::<2>::new(6.0, 20.0)).norm() < 1e-12 && (high - Vector::<2>::new(10.0, 25.0)).norm() < 1e-12);
    let askew = MovedHeight { angle: 0.4, ..moved };
    let [low, high] = askew.known_within().expect("a rectangle");
    for corner in [low, high, Vector::<2>::new(low[0], high[1]), Vector::<2>::new(high[0], low[1])] {
        let back = askew.turn().transpose() * (corner - askew.shift_in_plane());
        assert!((-1e-9..5.0 + 1e-9).contains(&back[0]) && (-1e-9..4.0 + 1e-9).contains(&back[1]), "{back}");
    }
}

#[test]
fn the_top_of_a_mesh_passes_through_its_faces_and_falls_off_beyond() {
    // A pyramid of height 1 over a square of side 2.
    let vertices = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let vertices = vertices.iter().map(|v| signorini_geometry::Point::<3>::from(*v)).collect();
    let faces = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [0, 2, 1], [0, 3, 2]];
    let mesh = TriangleMesh::new(vertices, &faces).expect("a mesh");
    let around = [Vector::<2>::new(-2.0, -2.0), Vector::<2>::new(2.0, 2.0)];
    let top = Sampled::of_mesh(&mesh, around, 0.05, View::FromAbove).expect("heights");
    assert!((top.value(&Vector::<2>::new(0.5, 0.0)) - 0.5).abs() < 1e-3);
    assert!((top.value(&Vector::<2>::new(0.2, 0.55)) - 0.45).abs() < 1e-3);
    assert!((top.value(&Vector::<2>::new(1.5, 0.0)) + 0.5 * FALL).abs() < 0.06);
    let under = Sampled::of_mesh(&mesh, around, 0.05, View::FromBelow).expect("heights");
    assert!(under.value(&Vector::<2>::new(0.3, 0.3)).abs() < 1e-3);
    let apart = [Vector::<2>::new(5.0, 5.0), Vector::<2>::new(6.0, 6.0)];
    assert!(Sampled::of_mesh(&mesh, apart, 0.05, View::FromAbove).is_err());
}
