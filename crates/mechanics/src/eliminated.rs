//! Newton's step with multipliers eliminated one by one: for many unknowns of bodies that meet in large zones of contact.
//!
//! The equations of contacts and of supports that couple unknowns make a saddle point,
//!
//! ```text
//! K u + Σ a_k λ_k = f
//! b_k·u - d_k λ_k = g_k
//! ```
//!
//! with rows `b_k` near `a_k` where a side touches. With springs `s_k` in the place of `1/d_k`, stiffer than what they hold, the
//! multipliers follow, and `½ (K + Kᵀ) + Σ s_k a_k a_kᵀ` is positive definite: one Cholesky factor, with the fill-in of bodies
//! that are glued together. It preconditions the equations as they stand, which differ by the compliance of the springs, and
//! by what is not symmetric: gaps that are not closed, and friction. The method of generalised conjugate residuals removes that
//! in a few iterations (as augmented Lagrangians do; Fortin & Glowinski 1983; Benzi, Golub & Liesen, *Acta Numerica* 14, 2005).

use crate::processes::SpringOfMultiplier;
use signorini_contact::compress;
use signorini_solve::cholesky::Symbolic;
use signorini_solve::general::{Entries, Matrix};
use signorini_solve::krylov::conjugate_residuals;
use signorini_solve::{Factor, SolveError, SymmetricMatrix};

/// Stiffness of a spring in that of what it holds: so many digits the first iteration leaves right.
const STIFFER: f64 = 1e3;
/// Cosine between the force of a multiplier and the row of its equation from which on it counts as a spring.
const ALIKE: f64 = 0.9;
/// Residual of the iterations relative to the right-hand side, the most of them, and the residual of an equation relative to its
/// terms that is refused.
const TOLERANCE: f64 = 1e-12;
const MOST: usize = 120;
const REFUSED: f64 = 1e-9;

/// A multiplier: its force on bodies, its equation, and what stands on the diagonal.
#[derive(Default)]
pub(crate) struct Multiplier {
    pub force: Vec<(u32, f64)>,
    row: Vec<(u32, f64)>,
    diagonal: f64,
    /// Stiffness of its spring; zero of one whose equation is its own.
    pub spring: f64,
}

/// The multipliers that entries couple with the first `count` unknowns, those of bodies, with springs; `held` names unknowns whose
/// step is known, and `diagonal` is the stiffness of each unknown of bodies.
pub(crate) fn multipliers(
    entries: impl Iterator<Item = (u32, u32, f64)>,
    (count, held): (usize, &[bool]),
    diagonal: &[f64],
) -> Vec<Multiplier> {
    let mut out: Vec<Multiplier> = (count..held.len()).map(|_| Multiplier::default()).collect();
    for (i, j, v) in entries.filter(|(i, j, _)| !held[*i as usize] && !held[*j as usize]) {
        match ((i as usize).checked_sub(count), (j as usize).checked_sub(count)) {
            (None, Some(j)) => out[j].force.push((i, v)),
            (Some(i), None) => out[i].row.push((j, v)),
            (Some(k), Some(j)) if k == j => out[k].diagonal += v,
            _ => {}
        }
    }
    out.iter_mut().for_each(|m| m.choose_spring(diagonal));
    out
}

/// The step of all unknowns, of which the first `count` are of bodies; `held` names unknowns whose step is known, and stands in
/// `right`. `constant` is what of the stiffness of bodies is not in `tangent`, and `symbolic` is kept from step to step.
///
/// # Errors
/// A stiffness that is not positive definite, or equations that are not solved in so many iterations.
pub(crate) fn eliminated_step(
    (constant, tangent): (Option<&SymmetricMatrix>, &Entries),
    (count, held): (usize, &[bool]),
    right: &[f64],
    symbolic: &mut Symbolic,
) -> Result<Vec<f64>, SolveError> {
    let n = right.len();
    let is_body = |u: u32| (u as usize) < count;
    let mut of_bodies = Entries::default();
    let mut free = Entries::default();
    let mut multipliers: Vec<Multiplier> = (count..n).map(|_| Multiplier::default()).collect();
    for (i, j, v) in tangent.list().filter(|(i, ..)| !held[*i as usize]) {
        free.add(i, j, v);
        if held[j as usize] {
            continue;
        }
        match (is_body(i), is_body(j)) {
            (true, true) => of_bodies.add(i, j, v),
            (true, false) => multipliers[j as usize - count].force.push((i, v)),
            (false, true) => multipliers[i as usize - count].row.push((j, v)),
            (false, false) if i == j => multipliers[i as usize - count].diagonal += v,
            (false, false) => {}
        }
    }
    (0..count as u32).filter(|k| held[*k as usize]).for_each(|k| of_bodies.add(k, k, 1.0));
    let mut stiffness = of_bodies.matrix(count).symmetric_part();
    drop(of_bodies);
    if let Some(constant) = constant {
        stiffness = stiffness.plus(constant);
    }
    let known: Vec<Option<f64>> = held[..count].iter().map(|held| held.then_some(0.0)).collect();
    stiffness.prescribe(&known, &mut vec![0.0; count]);
    let diagonal = stiffness.diagonal();
    multipliers.iter_mut().for_each(|m| m.choose_spring(&diagonal));
    if multipliers.iter().any(|m| m.spring == 0.0 && m.diagonal == 0.0) {
        return Err(SolveError::Singular { size: n });
    }
    let springs: Vec<(&[(u32, f64)], f64)> =
        multipliers.iter().filter(|m| m.spring > 0.0).map(|m| (&m.force[..], m.spring)).collect();
    let factor = symbolic.factor(stiffness.plus(&SymmetricMatrix::of_squares(count, &springs)))?;
    drop(stiffness);
    Saddle { constant, beside: free.matrix(n), factor, multipliers, count, held }.solve(right)
}

impl Multiplier {
    /// By what its equation counts as the force of its spring.
    fn scale(&self) -> f64 {
        let force = self.force.iter().fold(0.0f64, |most, f| most.max(f.1.abs())).max(f64::MIN_POSITIVE);
        if self.spring > 0.0 { self.spring * force } else { force / self.diagonal.abs() }
    }

    /// The spring for other processes to know; one without force or equation is left as it is.
    pub(crate) fn told(&self) -> SpringOfMultiplier {
        let pull = match self.diagonal {
            _ if self.spring > 0.0 => self.spring,
            0.0 => 0.0,
            diagonal => -1.0 / diagonal,
        };
        let scale = Some(self.scale()).filter(|scale| scale.is_normal() && pull != 0.0).unwrap_or(1.0);
        SpringOfMultiplier { stiffness: self.spring, pull, scale }
    }

    /// Sums entries of the same unknown, and takes a spring where force and row are alike.
    fn choose_spring(&mut self, diagonal: &[f64]) {
        [&mut self.force, &mut self.row].into_iter().for_each(compress);
        let product: f64 = {
            let mut row = self.row.iter().peekable();
            let of = |f: &(u32, f64)| {
                while row.next_if(|r| r.0 < f.0).is_some() {}
                row.next_if(|r| r.0 == f.0).map_or(0.0, |r| r.1 * f.1)
            };
            self.force.iter().map(of).sum()
        };
        let square = |list: &[(u32, f64)]| list.iter().map(|e| e.1 * e.1).sum::<f64>();
        let (force, row) = (square(&self.force), square(&self.row));
        if product > ALIKE * (force * row).sqrt() && force > 0.0 {
            let stiffest = self.force.iter().fold(0.0f64, |m, (i, _)| m.max(diagonal[*i as usize]));
            self.spring = STIFFER * stiffest / force;
        }
    }
}

/// The equations, and what preconditions them.
struct Saddle<'a> {
    /// What of the stiffness of bodies does not change.
    constant: Option<&'a SymmetricMatrix>,
    /// All others, without rows of unknowns that are held.
    beside: Matrix,
    factor: Factor,
    multipliers: Vec<Multiplier>,
    count: usize,
    held: &'a [bool],
}

impl Saddle<'_> {
    fn solve(&self, right: &[f64]) -> Result<Vec<f64>, SolveError> {
        let n = right.len();
        let known: Vec<f64> = (0..n).map(|k| if self.held[k] { right[k] } else { 0.0 }).collect();
        let moved = self.product(&known);
        let left: Vec<f64> = (0..n).map(|k| if self.held[k] { 0.0 } else { right[k] - moved[k] }).collect();
        // Equations of multipliers count as the forces of their springs.
        let of_multipliers = self.multipliers.iter().map(Multiplier::scale);
        let scales: Vec<f64> = std::iter::repeat_n(1.0, self.count).chain(of_multipliers).collect();
        let scaled = |x: &[f64]| x.iter().zip(&scales).map(|(x, s)| x * s).collect::<Vec<f64>>();
        let unscaled = |x: &[f64]| x.iter().zip(&scales).map(|(x, s)| x / s).collect::<Vec<f64>>();
        let product = |y: &[f64]| Ok(Some(scaled(&self.product(&self.preconditioned(&unscaled(y))?))));
        let found = conjugate_residuals(scaled(&left), product, TOLERANCE, MOST)?;
        let found = found.ok_or(SolveError::Inaccurate { size: n, residual: f64::INFINITY })?;
        let mut x = self.preconditioned(&unscaled(&found))?;
        (0..n).filter(|k| self.held[*k]).for_each(|k| x[k] = right[k]);
        let error = self.error(&x, right);
        if error > REFUSED || error.is_nan() {
            return Err(SolveError::Inaccurate { size: n, residual: error });
        }
        Ok(x)
    }

    /// The matrix times a step, but for rows of unknowns that are held.
    fn product(&self, x: &[f64]) -> Vec<f64> {
        let mut out = self.beside.multiply(x);
        if let Some(constant) = self.constant {
            let forces = constant.multiply(&x[..self.count]);
            (0..self.count).filter(|k| !self.held[*k]).for_each(|k| out[k] += forces[k]);
        }
        out
    }

    /// The step that springs in the place of multipliers make of a residual.
    fn preconditioned(&self, residual: &[f64]) -> Result<Vec<f64>, SolveError> {
        let mut u = residual[..self.count].to_vec();
        let mut own = Vec::with_capacity(self.multipliers.len());
        for (m, g) in self.multipliers.iter().zip(&residual[self.count..]) {
            let pull = if m.spring > 0.0 { m.spring * g } else { -g / m.diagonal };
            m.force.iter().for_each(|(i, a)| u[*i as usize] += a * pull);
            own.push(-pull);
        }
        (0..self.count).filter(|k| self.held[*k]).for_each(|k| u[k] = 0.0);
        self.factor.solve_once(&mut u)?;
        for (m, own) in self.multipliers.iter().zip(&mut own).filter(|(m, _)| m.spring > 0.0) {
            *own += m.spring * m.force.iter().map(|(i, a)| a * u[*i as usize]).sum::<f64>();
        }
        u.extend(own);
        Ok(u)
    }

    /// The largest residual relative to the terms of its equation, with displacements as large as the largest.
    fn error(&self, x: &[f64], right: &[f64]) -> f64 {
        let farthest = x[..self.count].iter().fold(0.0f64, |m, x| m.max(x.abs()));
        let moved = self.product(x);
        let left: Vec<f64> = right.iter().zip(moved).map(|(r, m)| r - m).collect();
        let mut sizes: Vec<f64> = right.iter().map(|r| r.abs()).collect();
        for j in 0..x.len() {
            let reach = if j < self.count { farthest } else { x[j].abs() };
            self.beside.column(j).for_each(|(i, v)| sizes[i] += v.abs() * reach);
        }
        for (i, j, v) in self.constant.into_iter().flat_map(SymmetricMatrix::entries) {
            sizes[i] += v.abs() * farthest;
            sizes[j] += v.abs() * farthest;
        }
        let of = |k: usize| if self.held[k] { 0.0 } else { left[k].abs() / sizes[k].max(f64::MIN_POSITIVE) };
        (0..x.len()).map(of).fold(0.0f64, |m, e| if e > m || e.is_nan() { e } else { m })
    }
}
