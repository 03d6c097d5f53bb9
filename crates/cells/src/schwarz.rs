//! The sets of a Schwarz preconditioner of a body.
//!
//! One for each *vertex star* (all functions that vanish outside the cells around a vertex), one for each cell with
//! little material (where functions become almost dependent), and one coarse level of all functions of vertices, with coarser ones of larger
//! cells where there are many. The condition is then
//! independent of the cuts, of the number of cells and nearly of the degree: in space the functions themselves, not the
//! cuts, are the larger part of the trouble.

use crate::body::CellBody;
use crate::cell::SMALL;
use crate::region::Filling;
use crate::shapes::spatial;
use signorini_solve::schwarz::Sets;

impl<const D: usize> CellBody<D> {
    /// The sets of unknowns of a preconditioner.
    pub fn schwarz_sets(&self) -> Sets {
        let functions = self.function_count();
        let mut cells_of: Vec<Vec<usize>> = vec![Vec::new(); functions];
        for (c, cell) in self.cells().iter().enumerate() {
            cell.functions.iter().for_each(|f| cells_of[*f as usize].push(c));
        }
        let mut covered = vec![false; functions];
        let mut sets: Vec<Vec<u32>> = Vec::new();
        let vertices: Vec<u32> = (0..functions as u32).filter(|f| self.is_vertex(*f as usize)).collect();
        for v in &vertices {
            let around = &cells_of[*v as usize];
            let mut members: Vec<u32> =
                around.iter().flat_map(|c| self.cells()[*c].functions.iter().copied()).collect();
            members.sort_unstable();
            members.dedup();
            members.retain(|f| cells_of[*f as usize].iter().all(|c| around.binary_search(c).is_ok()));
            members.sort_by_key(|f| place_in_star(self, *f as usize));
            members.iter().for_each(|f| covered[*f as usize] = true);
            sets.push(members);
        }
        for cell in self.cells().iter().filter(|c| c.rule.filling == Filling::Cut && c.share < SMALL) {
            sets.push(cell.functions.clone());
        }
        sets.extend((0..functions).filter(|f| !covered[*f]).map(|f| vec![f as u32]));
        let unknowns = |f: &u32| (0..D as u32).map(move |k| D as u32 * f + k).collect::<Vec<u32>>();
        let coarse = vertices.iter().flat_map(|f| {
            let x: [f64; 3] = spatial(&self.position(*f as usize)).into();
            unknowns(f).into_iter().map(move |u| (u, x))
        });
        Sets {
            local: sets.iter().map(|set| set.iter().flat_map(unknowns).collect()).collect(),
            coarse: coarse.collect(),
            coarser: self.coarser_levels(&vertices),
        }
    }
}

/// Sorts the functions of a star in the same way wherever the star lies.
fn place_in_star<const D: usize>(body: &CellBody<D>, function: usize) -> Vec<usize> {
    let mode = body.mode(function);
    let mut out = vec![mode.level];
    for k in 0..D {
        let n = body.tree().count(mode.level, k);
        let id = mode.ids[k];
        let bubbles = body.degree().max(2) - 1;
        out.extend(if id <= n { [2 * id, 0] } else { [2 * ((id - n - 1) / bubbles) + 1, (id - n - 1) % bubbles] });
    }
    out
}
