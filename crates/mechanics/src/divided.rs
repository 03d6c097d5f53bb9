//! A system that several processes solve together: its cells are divided among them, and with them the rows of the matrix.
//!
//! Each process integrates its own cells. Forces of bodies are summed over the processes; loads, supports and contacts are the same
//! on all, and each process takes the rows of them that it has.

use crate::body::{Body, BodyError, Contribution};
use crate::eliminated::multipliers;
use crate::equilibrium::Problem;
use crate::increment_error::IncrementError;
use crate::linear_solver::Solved;
use crate::partition::bisected;
use crate::processes::{DistributedEquations, DistributedMatrix, Division, Preconditioner, Processes, Share};
use crate::system::{Assembled, System, SystemState};
use signorini_solve::{Symbolic, SymmetricMatrix};
use std::sync::Arc;

/// Why a system cannot be divided.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DivisionError {
    #[error("{processes} processes have only {cells} cells to share: start at most {cells}")]
    TooMany { processes: usize, cells: usize },
    /// A body whose cells cannot be assembled one by one.
    #[error("`{body}` cannot be divided among processes: only solids of finite elements and of finite cells can")]
    Whole { body: String },
}

impl System {
    /// Divides the cells of all bodies among processes: from now on this process has its own only, and all of them solve together.
    /// Bodies without unknowns, which are moved, are on all of them.
    ///
    /// # Errors
    /// Fewer cells than processes; bodies that cannot be divided.
    pub fn divide(&mut self, processes: Arc<dyn Processes>) -> Result<(), DivisionError> {
        let (first, count) = self.numbering();
        let mut cells: Vec<Vec<Vec<u32>>> = Vec::new();
        let mut centres: Vec<[f64; 3]> = Vec::new();
        for body in &self.bodies {
            let (own, places) = (body.cliques(), body.places());
            if body.unknowns() > 0 && (own.is_empty() || places.is_empty()) {
                return Err(DivisionError::Whole { body: body.name().to_string() });
            }
            centres.extend(own.iter().map(|unknowns| centre(unknowns, &places)));
            cells.push(own);
        }
        if centres.len() < processes.count() {
            return Err(DivisionError::TooMany { processes: processes.count(), cells: centres.len() });
        }
        let part = bisected(&centres, processes.count());
        let mut owner = vec![u32::MAX; count];
        let mut done = 0;
        for ((body, own), first) in self.bodies.iter_mut().zip(&cells).zip(first) {
            let parts = &part[done..done + own.len()];
            done += own.len();
            for (unknowns, part) in own.iter().zip(parts) {
                unknowns.iter().for_each(|u| {
                    let place = &mut owner[(first + u) as usize];
                    *place = (*place).min(*part);
                });
            }
            let keep: Vec<bool> = parts.iter().map(|part| *part as usize == processes.rank()).collect();
            if body.unknowns() > 0 && !body.keep_cells(&keep) {
                return Err(DivisionError::Whole { body: body.name().to_string() });
            }
        }
        // What no cell has, such as unknowns that are held for good.
        owner.iter_mut().filter(|owner| **owner == u32::MAX).for_each(|owner| *owner = 0);
        let rank = processes.rank() as u32;
        let first = self.numbering().0;
        let of_bodies = cells.iter().zip(first).flat_map(|(cells, first)| cells.iter().map(move |cell| (cell, first)));
        let own: Vec<(&Vec<u32>, u32)> =
            of_bodies.zip(&part).filter(|(_, p)| **p == rank).map(|(cell, _)| cell).collect();
        let share = Share {
            unknowns: count,
            rows: owner.iter().filter(|owner| **owner == rank).count(),
            components: self.components(),
            in_blocks: own.iter().map(|(cell, _)| cell.len().pow(2)).sum(),
            entries: entries_of(&own, count),
        };
        self.division = Some(Division { processes, owner, share });
        Ok(())
    }

    /// What this process has of a system that is divided.
    pub fn share(&self) -> Option<&Share> {
        self.division.as_ref().map(|division| &division.share)
    }

    /// About what memory a Cholesky factor of all bodies takes, in bytes.
    pub fn factor_memory(&self) -> f64 {
        let of_body = |body: &dyn Body| {
            let pattern = SymmetricMatrix::from_cliques(body.unknowns(), &body.cliques());
            Symbolic::default().cost(&pattern).map_or(0.0, |cost| cost.bytes)
        };
        self.bodies.iter().filter(|body| body.unknowns() > 0).map(|body| of_body(body.as_ref())).sum()
    }

    /// Unknowns of a node, which have the same place: of all bodies the fewest.
    fn components(&self) -> usize {
        let of_body = |body: &dyn Body| {
            let places = body.places();
            places.iter().take_while(|x| **x == places[0]).count()
        };
        let moved = self.bodies.iter().filter(|body| body.unknowns() > 0);
        moved.map(|body| of_body(body.as_ref())).min().unwrap_or(1)
    }
}

/// Entries of the matrix that cells add up to, of which the unknowns begin at a number each.
fn entries_of(cells: &[(&Vec<u32>, u32)], count: usize) -> usize {
    let mut number = vec![u32::MAX; count];
    let mut numbered = 0;
    let mut own = |u: u32| {
        let place = &mut number[u as usize];
        if *place == u32::MAX {
            *place = numbered;
            numbered += 1;
        }
        *place
    };
    let cliques: Vec<Vec<u32>> =
        cells.iter().map(|(cell, first)| cell.iter().map(|u| own(first + u)).collect()).collect();
    let n = numbered as usize;
    2 * SymmetricMatrix::from_cliques(n, &cliques).entries().count() - n
}

/// The mean of the places of the unknowns of a cell.
fn centre(unknowns: &[u32], places: &[[f64; 3]]) -> [f64; 3] {
    let sum = |axis: usize| unknowns.iter().map(|u| places[*u as usize][axis]).sum::<f64>();
    std::array::from_fn(|axis| sum(axis) / unknowns.len() as f64)
}

impl Division {
    /// Sums over all processes what a body adds on each of them, and its energy. An error of one process is one of all.
    pub(crate) fn summed(&self, added: Result<f64, BodyError>, out: &mut Contribution) -> Result<f64, BodyError> {
        let word = added.as_ref().err().map(ToString::to_string);
        if let Some(message) = self.processes.first_word(word) {
            return Err(BodyError::OfProcess { message });
        }
        out.forces.push(added.unwrap_or_default());
        self.processes.sum(&mut out.forces);
        Ok(out.forces.pop().unwrap_or_default())
    }

    /// The tangent of all processes.
    pub(crate) fn matrix(&self, out: &Assembled) -> Box<dyn DistributedMatrix> {
        let n = out.residual.len();
        let (count, processes) = (self.owner.len(), self.processes.count());
        // Multipliers are spread evenly.
        let more = (count..n).map(|k| ((k - count) * processes / (n - count)) as u32);
        let owner: Vec<u32> = self.owner.iter().copied().chain(more).collect();
        let rank = self.processes.rank() as u32;
        let common: Vec<_> = out.tangent.list().filter(|(row, ..)| owner[*row as usize] == rank).collect();
        self.processes.matrix(&owner, out.of_cells.as_deref().unwrap_or_default(), &common)
    }
}

impl Problem<'_> {
    /// The step of all unknowns, by all processes.
    pub(crate) fn divided_step(
        &mut self,
        division: &Division,
        (at, out): (&SystemState, &Assembled),
        (held, right): (&[bool], &[f64]),
    ) -> Result<Vec<f64>, IncrementError> {
        let mut matrix = division.matrix(out);
        let preconditioner = |diagonal: &[f64]| self.preconditioner(division, (at, out), held, diagonal);
        let of_bodies = self.is_spin.len();
        let equations = DistributedEquations { right, held, of_bodies, preconditioner: &preconditioner };
        let mut found = None;
        if !self.is_free {
            found = matrix.solve(&equations).ok();
        }
        let found = match found {
            Some(found) => found,
            None => {
                let grain = self.grain(out, held, &matrix.row_sizes(self.is_spin.len()));
                matrix.add_to_diagonal(&grain);
                matrix.solve(&equations)?
            }
        };
        let (systems, most) = match self.solved {
            Solved::Distributed { systems, most_iterations, .. } => (systems, most_iterations),
            _ => (0, None),
        };
        self.solved = Solved::Distributed {
            processes: division.processes.count(),
            systems: systems + 1,
            most_iterations: most.max(found.iterations),
        };
        Ok(found.x)
    }

    /// What preconditions iterations of a step from a state.
    fn preconditioner(
        &self,
        division: &Division,
        (at, out): (&SystemState, &Assembled),
        held: &[bool],
        diagonal: &[f64],
    ) -> Preconditioner {
        let count = self.is_spin.len();
        let rank = division.processes.rank() as u32;
        let list = multipliers(out.tangent.list(), (count, held), &diagonal[..count]);
        let mut touched = vec![false; count];
        let mut springs = Vec::new();
        for m in list.iter().filter(|m| m.spring > 0.0) {
            for (i, a) in &m.force {
                touched[*i as usize] = true;
                if division.owner[*i as usize] == rank {
                    springs.extend(m.force.iter().map(|(j, b)| (*i, *j, m.spring * a * b)));
                }
            }
        }
        let system = self.system;
        let (first, _) = system.numbering();
        let mut motions = vec![vec![0.0; count]; 6];
        for ((body, state), first) in system.bodies.iter().zip(&at.bodies).zip(first) {
            for (out, own) in motions.iter_mut().zip(body.rigid_modes(state)) {
                out[first as usize..first as usize + own.len()].copy_from_slice(&own);
            }
        }
        let multipliers = list.iter().map(|m| m.told()).collect();
        Preconditioner { springs, multipliers, touched, motions, components: division.share.components }
    }
}
