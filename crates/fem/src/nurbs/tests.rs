use super::*;
use crate::hierarchic::Values;
use crate::rules::rule;
use crate::small::determinant;
use signorini_geometry::Point;
use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// A quarter of a ring between two radii, from the x axis to the y axis.
fn quarter(name: &str, [a, b]: [f64; 2], turns: usize) -> NurbsPatch<2> {
    let arc = [[1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let turn = |[x, y]: [f64; 2]| (0..turns).fold([x, y], |[x, y], _| [-y, x]);
    let points = [a, b].iter().flat_map(|r| arc.map(|x| Point::<2>::from(turn(x)) * *r)).collect();
    let weights = [1.0, FRAC_1_SQRT_2, 1.0].repeat(2);
    let knots = [vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], vec![0.0, 0.0, 1.0, 1.0]];
    // The angle first would be left-handed with the radius second.
    let mut patch = NurbsPatch::new(name, [2, 1], knots, points, Some(weights)).unwrap();
    patch.points = (0..2).flat_map(|j| (0..3).rev().map(move |i| 3 * j + i)).map(|k| patch.points[k]).collect();
    patch
}

fn area(mesh: &crate::Mesh<2>, n: usize) -> f64 {
    let mut at = Values::default();
    let mut sum = 0.0;
    for cell in 0..mesh.cell_count() {
        for (x, w) in rule(mesh.shape(cell), n) {
            mesh.map(cell).tabulate(&x, &mut at);
            sum += w * determinant(&mesh.jacobian(cell, &at).1);
        }
    }
    sum
}

#[test]
fn degree_and_knots_are_raised_without_a_change_of_shape() {
    let patch = quarter("", [1.0, 2.0], 0);
    let mut worst = 0.0f64;
    for (degree, cells) in [(2, [1, 1]), (2, [3, 2]), (3, [4, 1]), (5, [2, 3]), (8, [5, 2])] {
        let raised = patch.raised(degree, cells).unwrap();
        for k in 0..50 {
            let t = [(k as f64 * 0.37) % 1.0, (k as f64 * 0.61) % 1.0];
            let (x, y) = (patch.at(&t), raised.at(&t));
            worst = worst.max((x - y).norm()).max((y.norm() - (1.0 + t[1])).abs());
        }
        // As smooth as knots allow: one function more for each cell.
        assert_eq!(raised.counts(), [degree + cells[0], degree + cells[1]]);
    }
    assert!(worst < 1e-13, "{worst:e}");
}

#[test]
fn patches_that_meet_are_one_body() {
    let quarters: Vec<_> =
        (0..4).map(|k| quarter(&format!("q{k}"), [1.0, 2.0], k).raised(3, [2, 1]).unwrap()).collect();
    let mesh = mesh_of_patches(&quarters).unwrap();
    mesh.check().unwrap();
    // 4 times 5 by 4 control points, of which 4 rows of 4 are shared.
    assert_eq!(crate::DofMap::new(&mesh, 3).count(), 4 * 5 * 4 - 4 * 4);
    assert!((area(&mesh, 12) - 3.0 * PI).abs() < 1e-13, "{}", area(&mesh, 12) - 3.0 * PI);
    let sides = |name: &str| mesh.groups().get(name).map_or(0, |g| g.sides.len());
    assert_eq!([sides("bottom"), sides("top"), sides("left"), sides("q1_top"), sides("boundary")], [8, 8, 0, 2, 16]);
    assert_eq!(mesh.boundary().len(), 16);
    // One cell more on one of them does not fit.
    let mut unlike = quarters;
    unlike[2] = quarter("q2", [1.0, 2.0], 2).raised(3, [2, 2]).unwrap();
    let error = mesh_of_patches(&unlike).unwrap_err();
    assert_eq!(error.key, "knots");
    assert!(error.message.contains("`q1`") && error.message.contains("`q2`"), "{error}");
}

#[test]
fn what_is_no_patch_is_refused_with_its_key() {
    let square =
        || vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].into_iter().map(Point::<2>::from).collect::<Vec<_>>();
    let line = || vec![0.0, 0.0, 1.0, 1.0];
    let of = |degree, knots: Vec<f64>, points: Vec<Point<2>>, weights: Option<Vec<f64>>| {
        NurbsPatch::new("", [degree, 1], [knots, line()], points, weights).err().map_or("", |e| e.key)
    };
    assert_eq!(of(1, line(), square(), None), "");
    assert_eq!(of(0, line(), square(), None), "degree");
    assert_eq!(of(9, line(), square(), None), "degree");
    for knots in [
        vec![0.0, 0.0, 1.0],
        vec![0.0, 0.0, 2.0, 1.0, 1.0],
        vec![0.0, 0.0, 0.0, 0.0],
        vec![0.0, 0.5, 1.0, 1.0],
        vec![0.0, 0.0, f64::NAN, 1.0, 1.0],
        vec![0.0, 0.0, 0.5, 0.5, 1.0, 1.0],
    ] {
        assert_eq!(of(1, knots.clone(), square(), None), "knots", "{knots:?}");
    }
    assert_eq!(of(1, line(), square()[..3].to_vec(), None), "points");
    assert_eq!(of(1, line(), square(), Some(vec![1.0; 3])), "weights");
    assert_eq!(of(1, line(), square(), Some(vec![1.0, 0.0, 1.0, 1.0])), "weights");
    let patch = quarter("", [1.0, 2.0], 0);
    assert_eq!(patch.raised(1, [1, 1]).unwrap_err().key, "degree");
    assert_eq!(patch.raised(2, [0, 1]).unwrap_err().key, "cells");
    // Turned over: the map has a negative Jacobian.
    let mut turned = patch;
    turned.points.iter_mut().for_each(|x| x[0] = -x[0]);
    assert!(matches!(
        mesh_of_patches(&[turned.raised(2, [2, 2]).unwrap()]).unwrap().check(),
        Err(crate::MeshError::BadCell { what: "inverted", .. })
    ));
}
