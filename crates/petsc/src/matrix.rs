//! A matrix whose rows are distributed: put together here, solved by PETSc.

use crate::memory::iterates;
use crate::numbering::Numbering;
use crate::rows::Rows;
use crate::shim::{self, Compressed, Counts, Entry, Glued, LinearSystem};
use crate::world::World;
use signorini_mechanics::processes::{
    CellBlock, DistributedEquations, DistributedMatrix, Found, Preconditioner, Processes,
};
use signorini_solve::SolveError;

/// Residual relative to the right-hand side that iterations end with, and the most of them, where the options say nothing else.
const TOLERANCE: f64 = 1e-10;
const MOST: usize = 1000;
/// Residual of an equation relative to its terms that is refused, as by a factorisation on one process.
const REFUSED: f64 = 1e-9;
/// Solves again for what is left.
const REFINEMENTS: usize = 3;

/// The rows of this process.
pub struct PetscMatrix {
    world: World,
    /// The process of each unknown.
    owner: Vec<u32>,
    numbering: Numbering,
    rows: Rows,
}

impl PetscMatrix {
    /// Sends what cells add to rows of other processes there; `entries` are in rows of this process.
    pub fn new(world: World, owner: &[u32], cells: &[CellBlock], entries: &[(u32, u32, f64)]) -> Self {
        let numbering = Numbering::new(owner, world.count());
        let rank = world.rank() as u32;
        let others = || cells.iter().flat_map(|cell| cell.list(|row| owner[row as usize] != rank));
        let mut counts = vec![0; world.count()];
        others().for_each(|e| counts[owner[e.0 as usize] as usize] += 1);
        let sent = Counts::new(counts);
        let mut next: Vec<usize> = sent.ranges().map(|range| range.start).collect();
        let mut send = vec![Entry::default(); sent.all()];
        for (row, column, value) in others() {
            let place = &mut next[owner[row as usize] as usize];
            send[*place] = Entry { row, column, value };
            *place += 1;
        }
        let received = shim::exchange(&send, &sent);
        drop(send);
        let first = numbering.first[world.rank()] as u32;
        let own = cells.iter().flat_map(|cell| cell.list(|row| owner[row as usize] == rank));
        let of_others = received.iter().map(|e| (e.row, e.column, e.value));
        let numbered = |(row, column, value): (u32, u32, f64)| {
            (numbering.number[row as usize] - first, numbering.number[column as usize], value)
        };
        let all = own.chain(of_others).chain(entries.iter().copied()).map(numbered);
        let rows = Rows::new(numbering.rows(world.rank()), all);
        PetscMatrix { world, owner: owner.to_vec(), numbering, rows }
    }

    /// The unknown of a row of this process.
    fn unknown(&self, row: usize) -> usize {
        self.numbering.unknown[self.numbering.first[self.world.rank()] + row] as usize
    }

    /// Values by row of this process, for all unknowns and processes.
    fn gathered(&self, own: &[f64]) -> Vec<f64> {
        let counts = Counts::new((0..self.world.count()).map(|p| self.numbering.rows(p)));
        let all = shim::gather(own, &counts);
        self.numbering.number.iter().map(|k| all[*k as usize]).collect()
    }

    fn by_row(&self, of: impl Fn(usize) -> f64) -> Vec<f64> {
        let own: Vec<f64> = (0..self.rows.count()).map(of).collect();
        self.gathered(&own)
    }

    /// The largest value of all processes; NaN if there is one.
    fn largest(&self, own: f64) -> f64 {
        let counts = Counts::new(std::iter::repeat_n(1, self.world.count()));
        let all = shim::gather(&[own], &counts);
        all.into_iter().fold(0.0f64, |m, e| if e > m || e.is_nan() { e } else { m })
    }

    /// The rows without columns of unknowns that are held, and the right-hand side less what these make, row by row; equations of
    /// multipliers times `scale`. A row that is held keeps its diagonal.
    fn reduced(&self, equations: &DistributedEquations<'_>, scale: impl Fn(usize) -> f64) -> (Compressed, Vec<f64>) {
        let first = self.numbering.first[self.world.rank()];
        let mut out = Compressed { start: vec![0], all: self.numbering.unknown.len(), ..Compressed::default() };
        let mut right = Vec::with_capacity(self.rows.count());
        for row in 0..self.rows.count() {
            let own = self.unknown(row);
            let diagonal = first + row;
            let mut entry = |column: usize, value: f64| {
                out.columns.push(column as i32);
                out.values.push(value);
            };
            if equations.held[own] {
                let value = self.rows.row(row).find(|e| e.0 as usize == diagonal).map_or(1.0, |e| e.1.abs());
                let value = if value > 0.0 { value } else { 1.0 };
                entry(diagonal, value);
                right.push(value * equations.right[own]);
            } else {
                let scale = scale(own);
                let mut known = equations.right[own];
                let mut has_diagonal = false;
                for (column, value) in self.rows.row(row) {
                    let other = self.numbering.unknown[column as usize] as usize;
                    if equations.held[other] {
                        known -= value * equations.right[other];
                        continue;
                    }
                    // PETSc wants every diagonal entry to be there, zero or not.
                    if !has_diagonal && column as usize > diagonal {
                        entry(diagonal, 0.0);
                        has_diagonal = true;
                    }
                    has_diagonal |= column as usize == diagonal;
                    entry(column as usize, scale * value);
                }
                if !has_diagonal {
                    entry(diagonal, 0.0);
                }
                right.push(scale * known);
            }
            out.start.push(out.columns.len() as i32);
        }
        (out, right)
    }

    /// Bodies with springs in place of multipliers, from the rows that are left.
    fn glued(&self, matrix: &Compressed, equations: &DistributedEquations<'_>, by: &Preconditioner) -> Glued {
        let count = equations.of_bodies;
        let rank = self.world.rank();
        let bodies = Numbering::new(&self.owner[..count], self.world.count());
        let rows = bodies.rows(rank);
        let first = bodies.first[rank] as u32;
        let is_free = |e: &&(u32, u32, f64)| !equations.held[e.0 as usize] && !equations.held[e.1 as usize];
        let of_body = |column: i32| {
            let unknown = self.numbering.unknown[column as usize] as usize;
            (unknown < count).then(|| bodies.number[unknown])
        };
        let kept = (0..rows).flat_map(|row| {
            let range = matrix.start[row] as usize..matrix.start[row + 1] as usize;
            range.filter_map(move |e| Some((row as u32, of_body(matrix.columns[e])?, matrix.values[e])))
        });
        let springs = (by.springs.iter().filter(is_free))
            .map(|(i, j, v)| (bodies.number[*i as usize] - first, bodies.number[*j as usize], *v));
        let glued = Rows::new(rows, kept.chain(springs));
        // The unknowns of contact, with all that are coupled with one of them.
        let is_touched = |column: u32| by.touched[bodies.unknown[column as usize] as usize];
        let is_near = |row: &usize| glued.row(*row).any(|(column, _)| is_touched(column));
        let touched = (0..rows).filter(is_near).map(|row| (first as usize + row) as i32).collect();
        let own = |row: usize| bodies.unknown[first as usize + row] as usize;
        let motion = |motion: &Vec<f64>| -> Vec<f64> {
            (0..rows).map(|row| if equations.held[own(row)] { 0.0 } else { motion[own(row)] }).collect()
        };
        let multipliers = rows..self.rows.count();
        let spring = |row: usize| by.multipliers[self.unknown(row) - count];
        Glued {
            matrix: Compressed {
                start: glued.start.iter().map(|s| *s as i32).collect(),
                columns: glued.columns.iter().map(|c| *c as i32).collect(),
                values: glued.values,
                all: count,
            },
            pull: multipliers.clone().map(|row| spring(row).pull / spring(row).scale).collect(),
            spring: multipliers.map(|row| spring(row).stiffness).collect(),
            touched,
            motions: by.motions.iter().flat_map(motion).collect(),
            components: by.components,
        }
    }

    /// The largest residual of an equation relative to its terms, and the residual row by row, of a step of all unknowns. Terms
    /// that are rounding of others count as those would make of the largest values of their kind.
    fn error(&self, x: &[f64], equations: &DistributedEquations<'_>) -> (f64, Vec<f64>) {
        let rounding = 1e3 * x.len() as f64 * f64::EPSILON;
        let kind = |u: usize| usize::from(u >= equations.of_bodies);
        let mut largest = [0.0f64; 2];
        x.iter().enumerate().for_each(|(u, x)| largest[kind(u)] = largest[kind(u)].max(x.abs()));
        let mut worst = 0.0f64;
        let mut left = Vec::with_capacity(self.rows.count());
        for row in 0..self.rows.count() {
            let own = self.unknown(row);
            if equations.held[own] {
                left.push(0.0);
                continue;
            }
            let mut residual = equations.right[own];
            let (mut terms, mut reach) = (residual.abs(), 0.0);
            for (column, value) in self.rows.row(row) {
                let other = self.numbering.unknown[column as usize] as usize;
                residual -= value * x[other];
                terms += (value * x[other]).abs();
                reach += value.abs() * largest[kind(other)];
            }
            if terms <= rounding * reach {
                terms += reach;
            }
            let error = if residual == 0.0 { 0.0 } else { residual.abs() / terms.max(f64::MIN_POSITIVE) };
            if error > worst || error.is_nan() {
                worst = error;
            }
            left.push(residual);
        }
        (self.largest(worst), left)
    }
}

impl DistributedMatrix for PetscMatrix {
    fn row_sizes(&self, columns: usize) -> Vec<f64> {
        let is_first = |column: u32| (self.numbering.unknown[column as usize] as usize) < columns;
        self.by_row(|row| {
            let own = self.rows.row(row).filter(|(column, _)| is_first(*column));
            own.fold(0.0f64, |m, (_, v)| m.max(v.abs()))
        })
    }

    fn diagonal(&self) -> Vec<f64> {
        let first = self.numbering.first[self.world.rank()];
        self.by_row(|row| self.rows.row(row).filter(|e| e.0 as usize == first + row).map(|e| e.1).sum())
    }

    fn multiply(&self, x: &[f64]) -> Vec<f64> {
        let at = |column: u32| x[self.numbering.unknown[column as usize] as usize];
        self.by_row(|row| self.rows.row(row).map(|(column, v)| v * at(column)).sum())
    }

    fn add_to_diagonal(&mut self, list: &[(u32, f64)]) {
        let rank = self.world.rank();
        let own = self.numbering.first[rank]..self.numbering.first[rank + 1];
        for (unknown, value) in list {
            let number = self.numbering.number[*unknown as usize];
            if own.contains(&(number as usize)) {
                self.rows.add(number as usize - own.start, number, *value);
            }
        }
    }

    fn solve(&self, equations: &DistributedEquations<'_>) -> Result<Found, SolveError> {
        let size = equations.right.len();
        let failed = |_| SolveError::NotFactorised { size };
        if self.rows.columns.len() + self.rows.count() > i32::MAX as usize {
            return Err(SolveError::OutOfMemory { size });
        }
        let by = (equations.preconditioner)(&self.diagonal());
        let iterates = iterates(self.numbering.unknown.len(), by.components);
        let (system, right) = if iterates {
            let scale = |u: usize| u.checked_sub(equations.of_bodies).map_or(1.0, |k| by.multipliers[k].scale);
            let (matrix, right) = self.reduced(equations, scale);
            let glued = self.glued(&matrix, equations, &by);
            (LinearSystem::iterative(&matrix, &glued, (TOLERANCE, MOST)).map_err(failed)?, right)
        } else {
            let (matrix, right) = self.reduced(equations, |_| 1.0);
            (LinearSystem::direct(&matrix, (TOLERANCE, MOST)).map_err(failed)?, right)
        };
        drop(by);
        let mut iterations = 0;
        let mut once = |right: &[f64]| -> Result<Vec<f64>, SolveError> {
            let (own, taken, reason) = system.solve(right).map_err(failed)?;
            iterations += taken;
            match reason {
                1.. => Ok(self.gathered(&own)),
                // The preconditioner, here the factorisation, failed.
                -11 => Err(SolveError::Singular { size }),
                _ => Err(SolveError::Inaccurate { size, residual: TOLERANCE }),
            }
        };
        let mut x = once(&right)?;
        if iterates {
            if x.iter().any(|x| !x.is_finite()) {
                return Err(SolveError::Singular { size });
            }
            return Ok(Found { x, iterations: Some(iterations) });
        }
        let (mut error, mut left) = self.error(&x, equations);
        for _ in 0..REFINEMENTS {
            if error.is_nan() || error <= 4.0 * f64::EPSILON {
                break;
            }
            let Ok(more) = once(&left) else { break };
            let next: Vec<f64> = x.iter().zip(&more).map(|(x, m)| x + m).collect();
            let (next_error, next_left) = self.error(&next, equations);
            if next_error.is_nan() || next_error > 0.5 * error {
                break;
            }
            (x, error, left) = (next, next_error, next_left);
        }
        if error.is_nan() {
            return Err(SolveError::Singular { size });
        }
        if error > REFUSED {
            return Err(SolveError::Inaccurate { size, residual: error });
        }
        Ok(Found { x, iterations: system.iterates().then_some(iterations) })
    }
}
