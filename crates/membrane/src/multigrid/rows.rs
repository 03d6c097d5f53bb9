//! The stiffness of a mesh, row by row.

use crate::equilibrium::elements::add_stiffness;
use crate::field::Field;
use signorini_fem::{Cells, MeshCells};
use signorini_solve::SymmetricMatrix;

/// The rows of a matrix: diagonal, then all other entries.
pub(super) struct Rows {
    pub diagonal: Vec<f64>,
    start: Vec<u32>,
    column: Vec<u32>,
    value: Vec<f64>,
}

impl Rows {
    /// The stiffness of all cells under a tension.
    pub fn new(cells: &MeshCells, tension: &dyn Field<2>) -> Self {
        if cells.degree() == 1 { Self::of_corners(cells, tension) } else { Self::of_functions(cells, tension) }
    }

    /// That of functions of higher degree.
    fn of_functions(cells: &MeshCells, tension: &dyn Field<2>) -> Self {
        let n = cells.function_count();
        let functions = |cell: usize| {
            let mut list = Vec::new();
            cells.functions(cell, &mut list);
            list
        };
        let cliques: Vec<Vec<u32>> = (0..cells.count()).map(functions).collect();
        let mut matrix = SymmetricMatrix::from_cliques(n, &cliques);
        for (cell, list) in cliques.iter().enumerate() {
            let mut local = vec![0.0; list.len() * list.len()];
            cells.for_each_point(cell, &mut |p, t| add_stiffness(&mut local, t, p.weight * tension.value(&p.x)));
            matrix.add(list, &local, 1.0);
        }
        drop(cliques);
        let mut start = vec![0u32; n + 1];
        let beside = || matrix.entries().filter(|(i, j, _)| i != j);
        beside().for_each(|(i, j, _)| [i, j].into_iter().for_each(|k| start[k + 1] += 1));
        for k in 1..start.len() {
            start[k] += start[k - 1];
        }
        let mut next = start.clone();
        let (mut column, mut value) = (vec![0; start[n] as usize], vec![0.0; start[n] as usize]);
        for (i, j, v) in beside() {
            for (own, other) in [(i, j), (j, i)] {
                let at = next[own] as usize;
                (column[at], value[at]) = (other as u32, v);
                next[own] += 1;
            }
        }
        Self { diagonal: matrix.diagonal(), start, column, value }
    }

    /// That of functions of degree 1.
    fn of_corners(cells: &MeshCells, tension: &dyn Field<2>) -> Self {
        let nodes = cells.function_count();
        let mut start = vec![0u32; nodes + 1];
        for cell in 0..cells.count() {
            for_each_pair(cells, cell, |pair, is_new, _| {
                pair.iter().filter(|_| is_new).for_each(|&n| start[n as usize + 1] += 1)
            });
        }
        for k in 1..start.len() {
            start[k] += start[k - 1];
        }
        let entries = start[nodes] as usize;
        let mut rows = Self { diagonal: vec![0.0; nodes], start, column: vec![0; entries], value: vec![0.0; entries] };
        let mut next: Vec<u32> = rows.start[..nodes].to_vec();
        let mut entries = Vec::new();
        for cell in 0..cells.count() {
            stiffness(cells, cell, tension, &mut entries);
            for_each_pair(cells, cell, |[a, b], is_new, at| {
                let v = entries[at];
                for (own, other) in [(a as usize, b), (b as usize, a)] {
                    let (begin, end) = (rows.start[own] as usize, &mut next[own]);
                    let known = rows.column[begin..*end as usize].iter().position(|j| *j == other).filter(|_| !is_new);
                    let at = known.map_or(*end as usize, |k| begin + k);
                    if known.is_none() {
                        rows.column[at] = other;
                        *end += 1;
                    }
                    rows.value[at] += v;
                    // Constants are free.
                    rows.diagonal[own] -= v;
                }
            });
        }
        rows
    }

    /// All entries of a row but that of the node itself.
    pub fn others(&self, node: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.start[node] as usize..self.start[node + 1] as usize;
        self.column[range.clone()].iter().map(|j| *j as usize).zip(self.value[range].iter().copied())
    }

    pub fn sum(&self, node: usize, u: &[f64]) -> f64 {
        self.others(node).map(|(j, v)| v * u[j]).sum()
    }

    /// The nodes in an order in which those of one colour, the first that none of their neighbours has, come together.
    pub fn colours(&self) -> Vec<u32> {
        const NONE: u32 = u32::MAX;
        let mut colour = vec![NONE; self.diagonal.len()];
        let mut count: Vec<usize> = Vec::new();
        for node in 0..colour.len() {
            let is_taken = |c: &u32| self.others(node).any(|(j, _)| colour[j] == *c);
            let own = (0..NONE).find(|c| !is_taken(c)).unwrap_or(0);
            colour[node] = own;
            if count.len() <= own as usize {
                count.resize(own as usize + 1, 0);
            }
            count[own as usize] += 1;
        }
        let mut next = 0;
        for c in &mut count {
            (*c, next) = (next, next + *c);
        }
        let mut order = vec![0u32; colour.len()];
        for (node, &c) in colour.iter().enumerate() {
            order[count[c as usize]] = node as u32;
            count[c as usize] += 1;
        }
        order
    }
}

/// Calls `visit` with every pair of nodes that a cell has, whether no cell of smaller number has it, and the place of its
/// entry in the matrix of the cell.
fn for_each_pair(cells: &MeshCells, cell: usize, mut visit: impl FnMut([u32; 2], bool, usize)) {
    let corners = cells.corner_functions(cell);
    let n = corners.len();
    for a in 0..n {
        let b = (a + 1) % n;
        let is_new = cells.across(cell, a).is_none_or(|other| other > cell);
        visit([corners[a], corners[b]], is_new, a * n + b);
    }
    if n == 4 {
        visit([corners[0], corners[2]], true, 2);
        visit([corners[1], corners[3]], true, 7);
    }
}

/// The stiffness of a cell, its vertices in their order.
fn stiffness(cells: &MeshCells, cell: usize, tension: &dyn Field<2>, out: &mut Vec<f64>) {
    out.clear();
    let corners = cells.corner_functions(cell);
    if cells.is_straight(cell) {
        // Half the product of two sides over the double area, each side opposite a corner.
        let x = [0, 1, 2].map(|k| cells.node(corners[k] as usize));
        let side = [x[2] - x[1], x[0] - x[2], x[1] - x[0]];
        let double = side[0].perp(&side[1]);
        let mean = tension.constant().unwrap_or_else(|| {
            let weighted = cells.rule(cell).iter().map(|p| p.weight * tension.value(&p.x)).sum::<f64>();
            2.0 * weighted / double
        });
        let scale = 0.5 * mean / double;
        for a in side {
            out.extend(side.iter().map(|b| scale * a.dot(b)));
        }
        return;
    }
    let n = corners.len();
    let mut matrix = vec![0.0; n * n];
    cells.for_each_point(cell, &mut |p, t| add_stiffness(&mut matrix, t, p.weight * tension.value(&p.x)));
    // From the order of functions to that of vertices.
    let mut functions = Vec::new();
    cells.functions(cell, &mut functions);
    let place = |corner: &u32| functions.iter().position(|f| f == corner).unwrap_or(0);
    for a in corners.iter().map(place) {
        out.extend(corners.iter().map(place).map(|b| matrix[a * n + b]));
    }
}
