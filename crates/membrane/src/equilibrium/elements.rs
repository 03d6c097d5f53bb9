//! What does not change from one zone to the next: the matrices of cells that are not divided.

use crate::problem::{Measure, Membrane};
use signorini_fem::cells::Neighbours;
use signorini_fem::ghost_penalty;
use signorini_fem::lagrange::Tabulation;
use signorini_solve::Symbolic;
use std::sync::OnceLock;

/// Penalty of Nitsche's method, to be divided by the cell size.
pub(crate) fn nitsche_penalty(degree: usize) -> f64 {
    8.0 * (degree * degree) as f64 + 4.0
}

/// The penalty in a cell, `β/h`.
pub(crate) fn penalty<const D: usize>(membrane: &Membrane<D>, cell: usize) -> f64 {
    nitsche_penalty(membrane.cells.degree()) / membrane.cells.size(cell)
}

/// What does not change from one zone to the next: the matrices of cells that are not divided.
pub struct Elements<const D: usize> {
    /// For each kind of cell.
    kinds: Vec<Element<D>>,
    pub(super) neighbours: Vec<Neighbours>,
    /// For each kind of neighbours, and for each pair that is like no other, once it was needed.
    ghosts_of_kinds: Vec<OnceLock<Vec<f64>>>,
    ghosts_of_pairs: Vec<OnceLock<Vec<f64>>>,
    pub(super) tension_constant: Option<f64>,
    pub(super) symbolic: Symbolic,
}

/// A cell that is not divided.
pub(crate) struct Element<const D: usize> {
    pub tabulated: Vec<Tabulation<D>>,
    /// Stiffness for unit tension, where the tension is constant and the measure plain.
    pub(super) stiffness: Option<Vec<f64>>,
}

impl<const D: usize> Elements<D> {
    pub fn new(membrane: &Membrane<D>) -> Self {
        let cells = &*membrane.cells;
        let tension_constant = membrane.tension.constant();
        let plain = tension_constant.is_some() && membrane.measure == Measure::Plain;
        let element = |cell: usize| {
            let rule = cells.rule(cell);
            let tabulated: Vec<Tabulation<D>> = rule
                .iter()
                .map(|p| {
                    let mut t = Tabulation::default();
                    cells.tabulate(cell, &p.x, &mut t);
                    t
                })
                .collect();
            let n = tabulated.first().map_or(0, |t| t.value.len());
            let stiffness = plain.then(|| {
                let mut matrix = vec![0.0; n * n];
                for (p, t) in rule.iter().zip(&tabulated) {
                    add_stiffness(&mut matrix, t, p.weight);
                }
                matrix
            });
            Element { tabulated, stiffness }
        };
        let neighbours = cells.neighbours();
        let empty = |n: usize| (0..n).map(|_| OnceLock::new()).collect();
        let kinds = neighbours.iter().filter_map(|pair| pair.kind).max().map_or(0, |kind| kind + 1);
        Self {
            kinds: cells.kinds().into_iter().map(element).collect(),
            ghosts_of_kinds: empty(kinds),
            ghosts_of_pairs: empty(neighbours.len()),
            neighbours,
            tension_constant,
            symbolic: Symbolic::default(),
        }
    }
}

impl<const D: usize> Elements<D> {
    /// The element of a cell that has others of its kind.
    pub(crate) fn of(&self, membrane: &Membrane<D>, cell: usize) -> Option<&Element<D>> {
        membrane.cells.kind(cell).map(|kind| &self.kinds[kind])
    }

    /// The ghost penalty of a pair of neighbours, by its number.
    pub(crate) fn ghost(&self, membrane: &Membrane<D>, number: usize) -> &[f64] {
        let pair = &self.neighbours[number];
        let place = pair.kind.map_or(&self.ghosts_of_pairs[number], |kind| &self.ghosts_of_kinds[kind]);
        place.get_or_init(|| ghost_penalty(&*membrane.cells, pair))
    }
}

pub(crate) fn add_stiffness<const D: usize>(matrix: &mut [f64], t: &Tabulation<D>, weight: f64) {
    let n = t.value.len();
    for a in 0..n {
        let g = weight * t.gradient[a];
        for b in 0..=a {
            let v = g.dot(&t.gradient[b]);
            matrix[a * n + b] += v;
            if a != b {
                matrix[b * n + a] += v;
            }
        }
    }
}
