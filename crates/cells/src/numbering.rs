//! The cells and the numbers of their functions, one copy of a function for each connected part of the material in its
//! support.

use crate::body::CellBody;
use crate::cell::Cell;
use crate::components::{PieceGraph, Pieces};
use crate::region::MaterialRule;
use crate::space::{LocalMode, Mode, modes_of, support};
use signorini_geometry::{Aabb, Point};
use std::collections::{BTreeMap, BTreeSet};

/// Pieces of material, and for each of them the copy of a function that it sees, if any.
type PiecesOfSupport = (Vec<usize>, Vec<Option<usize>>);

/// Least share of material in a cell whose own polynomials give the stress on its boundary.
const OWN_STRESS: f64 = 0.3;

impl<const D: usize> CellBody<D> {
    /// Makes a cell of every piece that is kept, and numbers the functions in the order of the cells.
    pub(crate) fn number(&mut self, graph: &PieceGraph<D>, rules: Vec<MaterialRule<D>>, kept: &[bool]) {
        let mut numbers: BTreeMap<(Mode<D>, usize), u32> = BTreeMap::new();
        let mut seen: BTreeMap<Mode<D>, PiecesOfSupport> = BTreeMap::new();
        let mut cell_of_piece = vec![usize::MAX; kept.len()];
        let whole: Vec<f64> = self.tree.leaves().iter().map(|l| l.bounds.volume()).collect();
        for (piece, rule) in rules.into_iter().enumerate().filter(|(p, _)| kept[*p]) {
            let leaf = graph.leaf_of(piece);
            let modes = modes_of(
                &self.tree,
                &self.tree.leaves()[leaf],
                self.discretisation.degree,
                self.discretisation.products,
            );
            let modes: Vec<(LocalMode<D>, usize)> = (modes.into_iter())
                .filter_map(|m| Some((m, self.copy_of(graph, leaf, piece, &m, &mut seen)?)))
                .collect();
            let functions = (modes.iter())
                .map(|&(m, copy)| {
                    let next = numbers.len() as u32;
                    *numbers.entry((m.mode, copy)).or_insert_with(|| {
                        self.functions.push((m.mode, copy));
                        next
                    })
                })
                .collect();
            cell_of_piece[piece] = self.cells.len();
            self.of_leaf[leaf].push(self.cells.len());
            let share = rule.measure(whole[leaf]) / whole[leaf];
            let modes = modes.into_iter().map(|m| m.0).collect();
            self.cells.push(Cell { leaf, modes, functions, rule, share, stress_cell: self.cells.len() });
        }
        let distinct: BTreeSet<Mode<D>> = self.functions.iter().map(|f| f.0).collect();
        self.findings.copies = self.functions.len() - distinct.len();
        for piece in (0..kept.len()).filter(|p| kept[*p]) {
            let cell = cell_of_piece[piece];
            if self.cells[cell].share >= OWN_STRESS || self.cells[cell].rule.boundary.is_empty() {
                continue;
            }
            // The best of the neighbours, or else of their neighbours.
            let next = &graph.touching[piece];
            let farther: Vec<usize> = next.iter().flat_map(|p| graph.touching[*p].iter().copied()).collect();
            for ring in [next, &farther] {
                // Of the largest cells, beyond which polynomials grow least, the one with most material.
                let level = |c: usize| self.tree.leaves()[self.cells[c].leaf].level;
                let order = |a: usize, b: usize| {
                    let by_size = level(b).cmp(&level(a));
                    by_size.then(self.cells[a].share.total_cmp(&self.cells[b].share)).then(b.cmp(&a))
                };
                let best = ring
                    .iter()
                    .map(|p| cell_of_piece[*p])
                    .filter(|c| *c != usize::MAX && self.cells[*c].share >= OWN_STRESS)
                    .max_by(|a, b| order(*a, *b));
                if let Some(best) = best {
                    self.cells[cell].stress_cell = best;
                    break;
                }
            }
        }
    }

    /// Which copy of a function a piece of material sees; none where finer functions say all that it says.
    fn copy_of(
        &self,
        graph: &PieceGraph<D>,
        leaf: usize,
        piece: usize,
        m: &LocalMode<D>,
        seen: &mut BTreeMap<Mode<D>, PiecesOfSupport>,
    ) -> Option<usize> {
        if self.discretisation.pieces == Pieces::Shared {
            return Some(0);
        }
        if m.factors.iter().all(|f| *f > 1) && m.mode.level == self.tree.leaves()[leaf].level {
            return Some(piece);
        }
        let (pieces, copies) = seen.entry(m.mode).or_insert_with(|| self.pieces_of_support(graph, leaf, m));
        pieces.iter().position(|p| *p == piece).and_then(|at| copies[at])
    }

    /// The pieces in the support of a function that is given on a leaf, and the copy that each of them sees.
    ///
    /// A copy on refined cells only, none of which touches a cell of its support that is not refined, is a sum of finer
    /// functions: those vanish nowhere but on sides of cells that are not refined.
    fn pieces_of_support(&self, graph: &PieceGraph<D>, leaf: usize, m: &LocalMode<D>) -> PiecesOfSupport {
        let leaf = &self.tree.leaves()[leaf];
        let cell = leaf.index.map(|i| i >> (leaf.level - m.mode.level));
        let mut pieces = Vec::new();
        let mut unrefined = Vec::new();
        for index in support(&self.tree, m.mode.level, &cell, &m.factors) {
            let b = self.tree.cell_box(m.mode.level, &index);
            if !self.tree.is_refined(m.mode.level, &index) {
                unrefined.push(b);
            }
            pieces.extend(self.leaves_in(&b).flat_map(|l| graph.start[l]..graph.start[l + 1]));
        }
        let copies = graph.connected(&pieces);
        let touches = |piece: &usize| {
            let own = self.tree.leaves()[graph.leaf_of(*piece)].bounds.scaled(1.0 + 1e-9);
            unrefined.iter().any(|b| (0..D).all(|k| own.min[k] <= b.max[k] && own.max[k] >= b.min[k]))
        };
        let needed: BTreeSet<usize> =
            pieces.iter().zip(&copies).filter(|(p, _)| touches(p)).map(|(_, copy)| *copy).collect();
        let copies = copies.into_iter().map(|c| needed.contains(&c).then_some(c)).collect();
        (pieces, copies)
    }

    /// The leaves within a cell of some level: they follow each other.
    fn leaves_in(&self, b: &Aabb<D>) -> impl Iterator<Item = usize> + '_ {
        let corner = b.at(&Point::repeat(1e-9));
        let (first, b) = (self.tree.leaf_at(&corner), *b);
        (first..self.tree.leaves().len()).take_while(move |l| b.contains(&self.tree.leaves()[*l].bounds.center()))
    }
}
