//! Of `space`.

use nalgebra::DMatrix;
use signorini_cells::space::{LocalMode, Mode, Products, Tabulation, modes_of, tabulate};
use signorini_cells::tree::CellTree;
use signorini_geometry::rule::gauss_legendre;
use signorini_geometry::{Aabb, Point};
use std::collections::BTreeMap;

fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1u64 << 53) as f64
}

/// Rank of the mass matrix and the largest jump at sides.
fn check<const D: usize>(cells: [usize; D], degree: usize, times: usize, seed: &mut u64) {
    let b = Aabb::new(Point::<D>::zeros(), Point::<D>::from_fn(|k, _| 1.0 + 0.5 * k as f64));
    let mut tree = CellTree::new(b, cells).unwrap();
    for _ in 0..times {
        let x = b.at(&Point::<D>::from_fn(|_, _| random(seed)));
        let leaf = tree.leaves()[tree.leaf_at(&x)];
        tree.refine(|l| *l == leaf).unwrap();
    }
    let modes: Vec<Vec<LocalMode<D>>> =
        tree.leaves().iter().map(|l| modes_of(&tree, l, degree, Products::Tensor)).collect();
    let mut number: BTreeMap<Mode<D>, usize> = BTreeMap::new();
    for m in modes.iter().flatten() {
        let next = number.len();
        number.entry(m.mode).or_insert(next);
    }
    let n = number.len();
    let mut mass = DMatrix::<f64>::zeros(n, n);
    let gauss = gauss_legendre(degree + 1);
    let mut t = Tabulation::default();
    for (leaf, modes) in tree.leaves().iter().zip(&modes) {
        for mut i in 0..gauss.len().pow(D as u32) {
            let mut weight = 1.0;
            let x = leaf.bounds.at(&Point::<D>::from_fn(|_, _| {
                let (x, w) = gauss[i % gauss.len()];
                i /= gauss.len();
                weight *= w;
                x
            }));
            tabulate(&tree, leaf, degree, modes, &x, &mut t);
            for (a, u) in modes.iter().zip(&t.value) {
                for (c, v) in modes.iter().zip(&t.value) {
                    mass[(number[&a.mode], number[&c.mode])] += weight * u * v;
                }
            }
        }
    }
    let d: Vec<f64> = (0..n).map(|i| mass[(i, i)].sqrt()).collect();
    let scaled = DMatrix::from_fn(n, n, |i, j| mass[(i, j)] / (d[i] * d[j]));
    let least = scaled.symmetric_eigenvalues().min();
    assert!(least > 1e-6, "{least:e}");
    // A random function has no jumps.
    let values: Vec<f64> = (0..n).map(|_| random(seed) - 0.5).collect();
    for leaf in tree.leaves() {
        let k = (random(seed) * D as f64) as usize;
        let mut x = leaf.bounds.at(&Point::<D>::from_fn(|_, _| random(seed)));
        x[k] = leaf.bounds.max[k];
        if x[k] >= b.max[k] {
            continue;
        }
        let mut both = [0.0; 2];
        for (side, value) in both.iter_mut().enumerate() {
            let mut y = x;
            y[k] += 1e-9 * (2.0 * side as f64 - 1.0);
            let at = tree.leaf_at(&y);
            tabulate(&tree, &tree.leaves()[at], degree, &modes[at], &x, &mut t);
            *value = modes[at].iter().zip(&t.value).map(|(m, v)| values[number[&m.mode]] * v).sum();
        }
        assert!((both[0] - both[1]).abs() < 1e-12, "{both:?}");
    }
}

#[test]
fn refined_functions_are_independent_and_continuous() {
    let mut seed = 7;
    for degree in [2, 3] {
        for times in [1, 3, 6] {
            check([2, 3], degree, times, &mut seed);
        }
    }
    check([2, 1, 2], 2, 2, &mut seed);
    check([5], 4, 3, &mut seed);
}

#[test]
fn trunk_spaces_have_their_sizes() {
    let b = Aabb::new(Point::<3>::zeros(), Point::<3>::repeat(1.0));
    let tree = CellTree::new(b, [1; 3]).unwrap();
    let sizes = |p| [Products::Tensor, Products::Trunk].map(|s| modes_of(&tree, &tree.leaves()[0], p, s).len());
    assert_eq!(sizes(4), [125, 50]);
    assert_eq!(sizes(1), [8, 8]);
}
