//! The functions: integrated Legendre functions on the cells of every level of a tree.
//!
//! A function of a level is a product of functions of one direction, each of a vertex (its support are the cells on both
//! sides of it) or of a cell. It is *active* where all cells of its support exist on its level and not all of them are
//! refined (multi-level hp, Zander et al., Comput. Mech. 55, 2015): the active functions are independent, and span all
//! continuous piecewise polynomials on the leaves, without a condition on how refined neighbours are. On a leaf act the
//! active functions of the leaf and of all its ancestors.
//!
//! A function is known by its level and one number in each direction: `v` of vertex `v`, and `n + 1 + e (p - 1) + k - 2`
//! of mode `k` of cell `e` of `n`. Where the material around a function falls into pieces, each piece has a copy of its
//! own (see [`crate::components`]).

use crate::legendre::{MAX_DEGREE, integrated_legendre};
use crate::tree::{CellTree, Leaf};
use signorini_geometry::{Aabb, Point, Vector};

/// Which products of functions of one direction belong to a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Products {
    /// All with a degree up to `p` in each direction.
    Tensor,
    /// Those with the degrees of the bubbles adding up to `p` at most, where there are two or more.
    Trunk,
}

/// A function of a level, without regard to pieces of the material.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Mode<const D: usize> {
    pub level: usize,
    /// The number in each direction.
    pub ids: [usize; D],
}

/// A function as a cell sees it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LocalMode<const D: usize> {
    pub mode: Mode<D>,
    /// Number of the function of one direction on the cell of its level.
    pub factors: [usize; D],
}

/// Value and gradient of the functions of a cell at one point.
#[derive(Clone, Debug, Default)]
pub struct Tabulation<const D: usize> {
    pub value: Vec<f64>,
    pub gradient: Vec<Vector<D>>,
}

/// The active functions on a leaf, those of the coarsest level first.
pub fn modes_of<const D: usize>(
    tree: &CellTree<D>,
    leaf: &Leaf<D>,
    degree: usize,
    products: Products,
) -> Vec<LocalMode<D>> {
    let mut out = Vec::new();
    for level in 0..=leaf.level {
        let cell: [usize; D] = leaf.index.map(|i| i >> (leaf.level - level));
        for mut number in 0..(degree + 1).pow(D as u32) {
            let factors: [usize; D] = std::array::from_fn(|_| {
                let k = number % (degree + 1);
                number /= degree + 1;
                k
            });
            let bubbles: Vec<usize> = factors.iter().copied().filter(|&k| k > 1).collect();
            if products == Products::Trunk && bubbles.len() > 1 && bubbles.iter().sum::<usize>() > degree {
                continue;
            }
            if !is_active(tree, level, &cell, &factors) {
                continue;
            }
            let ids = std::array::from_fn(|k| match factors[k] {
                f @ 0..2 => cell[k] + f,
                f => tree.count(level, k) + 1 + cell[k] * (degree - 1) + f - 2,
            });
            out.push(LocalMode { mode: Mode { level, ids }, factors });
        }
    }
    out
}

/// The cells of its level on which a function given on one of them does not vanish.
pub fn support<const D: usize>(
    tree: &CellTree<D>,
    level: usize,
    cell: &[usize; D],
    factors: &[usize; D],
) -> Vec<[usize; D]> {
    let ranges: [(usize, usize); D] = std::array::from_fn(|k| match factors[k] {
        0 => (cell[k].saturating_sub(1), cell[k]),
        1 => (cell[k], (cell[k] + 1).min(tree.count(level, k) - 1)),
        _ => (cell[k], cell[k]),
    });
    let mut out = vec![[0; D]];
    for k in 0..D {
        let (low, high) = ranges[k];
        out = (low..=high)
            .flat_map(|i| {
                out.iter().map(move |c| {
                    let mut c = *c;
                    c[k] = i;
                    c
                })
            })
            .collect();
    }
    out
}

fn is_active<const D: usize>(tree: &CellTree<D>, level: usize, cell: &[usize; D], factors: &[usize; D]) -> bool {
    let cells = support(tree, level, cell, factors);
    cells.iter().all(|c| tree.exists(level, c)) && !cells.iter().all(|c| tree.is_refined(level, c))
}

/// Values and gradients in space of functions of a leaf at a point, which may lie beyond it.
pub fn tabulate<const D: usize>(
    tree: &CellTree<D>,
    leaf: &Leaf<D>,
    degree: usize,
    modes: &[LocalMode<D>],
    x: &Point<D>,
    out: &mut Tabulation<D>,
) {
    out.value.clear();
    out.gradient.clear();
    let mut level = usize::MAX;
    let mut lines = [[[0.0; 2]; MAX_DEGREE + 1]; D];
    for LocalMode { mode, factors } in modes {
        if mode.level != level {
            level = mode.level;
            let b: Aabb<D> = if level == leaf.level {
                leaf.bounds
            } else {
                tree.cell_box(level, &leaf.index.map(|i| i >> (leaf.level - level)))
            };
            for k in 0..D {
                let size = b.max[k] - b.min[k];
                lines[k] = integrated_legendre(degree, (2.0 * x[k] - b.min[k] - b.max[k]) / size);
                lines[k].iter_mut().for_each(|n| n[1] *= 2.0 / size);
            }
        }
        let factor = |k: usize| lines[k][factors[k]];
        out.value.push((0..D).map(|k| factor(k)[0]).product());
        out.gradient.push(Vector::from_fn(|a, _| (0..D).map(|k| factor(k)[usize::from(k == a)]).product()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DMatrix;
    use signorini_geometry::rule::gauss_legendre;
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
}
