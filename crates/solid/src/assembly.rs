//! The stiffness of all bodies, and where its unknowns are.

use crate::body::Bodies;
use crate::stiffness::{Table, stiffness};
use crate::supports::{Reduction, Support, beds};
use rayon::prelude::*;
use signorini_geometry::Point;
use signorini_solve::SymmetricMatrix;
use std::collections::HashMap;

fn in_space<const D: usize>(x: &Point<D>) -> [f64; 3] {
    std::array::from_fn(|k| if k < D { x[k] } else { 0.0 })
}

/// Where the unknowns that remain are.
pub(crate) fn positions<const D: usize>(bodies: &Bodies<D>, reduction: &Reduction<D>) -> Vec<[f64; 3]> {
    let mut out = vec![[0.0; 3]; reduction.unknowns];
    for body in &bodies.list {
        for (f, x) in body.function_positions().into_iter().enumerate() {
            for i in 0..D {
                for (unknown, _) in reduction.row(body.first + f * D + i) {
                    out[*unknown as usize] = in_space(&x);
                }
            }
        }
    }
    out
}

/// The graph of the functions that move: which share a cell, as the pattern of a matrix, and where they are.
pub(crate) fn graph<const D: usize>(bodies: &Bodies<D>, reduction: &Reduction<D>) -> (SymmetricMatrix, Vec<[f64; 3]>) {
    let moves = |f: usize| (0..D).any(|i| !reduction.is_held(f * D + i));
    let mut places = Vec::new();
    let mut cliques: Vec<Vec<u32>> = Vec::new();
    for body in &bodies.list {
        let first = body.first / D;
        let positions = body.function_positions();
        // Numbers of those that move.
        let mut number = vec![None; positions.len()];
        for f in (0..positions.len()).filter(|&f| moves(first + f)) {
            number[f] = Some(places.len() as u32);
            places.push(in_space(&positions[f]));
        }
        let of_cell = |cell| body.dofs.functions(cell).iter().filter_map(|f| number[*f as usize]).collect();
        cliques.extend((0..body.mesh.cell_count()).map(of_cell));
    }
    (SymmetricMatrix::from_cliques(places.len(), &cliques), places)
}

/// The stiffness of all bodies and elastic beds.
pub fn assemble<const D: usize>(bodies: &Bodies<D>, supports: &[Support]) -> SymmetricMatrix {
    let mut cliques: Vec<Vec<u32>> = Vec::new();
    for body in &bodies.list {
        for cell in 0..body.mesh.cell_count() {
            let unknowns = body
                .dofs
                .functions(cell)
                .iter()
                .flat_map(|f| (0..D).map(move |i| (body.first + *f as usize * D + i) as u32));
            cliques.push(unknowns.collect());
        }
    }
    let beds = beds(bodies, supports);
    let cells = cliques.len();
    cliques.extend(beds.iter().map(|b| b.1.clone()));
    let mut matrix = SymmetricMatrix::from_cliques(bodies.unknowns(), &cliques);
    for ((_, unknowns, values), _) in beds.iter().zip(cells..) {
        matrix.add(unknowns, values, 1.0);
    }
    let mut number = 0;
    for body in &bodies.list {
        let mut tables: HashMap<(usize, usize), Table> = HashMap::new();
        for cell in 0..body.mesh.cell_count() {
            let key = (body.mesh.map_number(cell), body.dofs.basis_number(cell));
            tables.entry(key).or_insert_with(|| Table::new(&body.mesh, &body.dofs, cell));
        }
        // Matrices in parallel, sums in order.
        let all: Vec<usize> = (0..body.mesh.cell_count()).collect();
        for chunk in all.chunks(512) {
            let matrices: Vec<Vec<f64>> = chunk
                .par_iter()
                .map(|&cell| {
                    let table = &tables[&(body.mesh.map_number(cell), body.dofs.basis_number(cell))];
                    let basis = body.dofs.basis(cell);
                    let k = stiffness(&body.mesh, cell, table, basis, &body.material, bodies.space);
                    let signs: Vec<f64> = body.dofs.cell(cell).flat_map(|(_, s)| std::iter::repeat_n(s, D)).collect();
                    let n = signs.len();
                    let mut out = vec![0.0; n * n];
                    for a in 0..n {
                        for b in 0..n {
                            out[a * n + b] = signs[a] * signs[b] * k[(a, b)];
                        }
                    }
                    out
                })
                .collect();
            for values in matrices {
                matrix.add(&cliques[number], &values, 1.0);
                number += 1;
            }
        }
    }
    matrix
}
