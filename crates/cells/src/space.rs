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
