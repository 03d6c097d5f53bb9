//! Masses of rigid bodies: momenta, and velocities after a step of the midpoint rule.
//!
//! With the step `d` of a displacement the midpoint rule says `v₁ = 2 d/h - v₀`; with the rotation vector `θ` of a step, in
//! space, `ω₁ = 2 θ/h - exp(θ) ω₀`. As `exp(θ)` leaves `θ` where it is, `θ·(π₁ - π₀)/h` is the change of the energy of rotation for
//! `π = R J Rᵀ ω`: without moments momentum and energy stay (Simo & Wong 1991).

use crate::body::{BodyState, PlaceError};
use crate::dynamics::{SpinInertia, angular_velocity_after, momentum_by_spin};
use crate::rotation;
use crate::system::{AssemblyError, System};
use nalgebra::{DMatrix, DVector};
use signorini_geometry::{Matrix, Vector};

/// The inertia of a body against rotation in space, and its spins among all unknowns.
struct Spin {
    body: usize,
    at: [usize; 3],
    own: SpinInertia,
}

/// Masses of all free bodies.
pub struct Masses {
    /// Of displacements, and of rotations about a fixed axis.
    constant: DMatrix<f64>,
    spins: Vec<Spin>,
}

fn at(v: &[f64], at: &[usize; 3]) -> Vector<3> {
    Vector::<3>::new(v[at[0]], v[at[1]], v[at[2]])
}

fn add_block(out: &mut DMatrix<f64>, place: &[usize; 3], block: &Matrix<3>) {
    for i in 0..3 {
        for j in 0..3 {
            out[(place[i], place[j])] += block[(i, j)];
        }
    }
}

impl Masses {
    /// # Errors
    /// A body that moves and has no mass.
    pub fn new(system: &System) -> Result<Self, AssemblyError> {
        let (first, count) = system.numbering();
        let mut out = Masses { constant: DMatrix::zeros(count, count), spins: Vec::new() };
        for (k, (body, first)) in system.bodies.iter().zip(first).enumerate().filter(|(_, (b, _))| b.unknowns() > 0) {
            let Some(mass) = system.masses.get(k).and_then(Option::as_ref) else {
                let message = "it has no mass, so it cannot move with inertia".to_string();
                return Err(PlaceError::Unsuitable { body: body.name().to_string(), message }.into());
            };
            let first = first as usize;
            for (unknowns, values) in &mass.blocks {
                for (row, i) in values.chunks(unknowns.len()).zip(unknowns) {
                    for (m, j) in row.iter().zip(unknowns) {
                        out.constant[(first + *i as usize, first + *j as usize)] += m;
                    }
                }
            }
            for spin in &mass.spins {
                let at = spin.unknowns.map(|u| first + u as usize);
                out.spins.push(Spin { body: k, at, own: spin.clone() });
            }
        }
        Ok(out)
    }

    fn inertia(system: &System, spin: &Spin, bodies: &[BodyState]) -> Matrix<3> {
        spin.own.after(&system.bodies[spin.body].orientation(&bodies[spin.body], spin.own.unknowns))
    }

    /// The mass matrix in a state.
    pub fn matrix(&self, system: &System, bodies: &[BodyState]) -> DMatrix<f64> {
        let mut out = self.constant.clone();
        for spin in &self.spins {
            add_block(&mut out, &spin.at, &Self::inertia(system, spin, bodies));
        }
        out
    }

    /// Momenta of velocities in a state.
    pub fn momenta(&self, system: &System, bodies: &[BodyState], velocities: &[f64]) -> DVector<f64> {
        self.matrix(system, bodies) * DVector::from_column_slice(velocities)
    }

    /// Velocities at the end of a step of a duration, by the midpoint rule.
    pub fn after(&self, step: &[f64], before: &[f64], duration: f64) -> Vec<f64> {
        let mut out: Vec<f64> = step.iter().zip(before).map(|(s, v)| 2.0 * s / duration - v).collect();
        for spin in &self.spins {
            let theta = at(step, &spin.at);
            let omega = angular_velocity_after(&theta, &at(before, &spin.at), duration);
            spin.at.iter().zip(omega.iter()).for_each(|(u, w)| out[*u] = *w);
        }
        out
    }

    /// The derivatives in the step of the momenta at its end, with the bodies as a step leaves them, and of the velocities.
    pub fn derivatives(
        &self,
        system: &System,
        (step, duration): (&[f64], f64),
        (before, after): (&[f64], &[f64]),
        bodies: &[BodyState],
    ) -> [DMatrix<f64>; 2] {
        let n = step.len();
        let over = 2.0 / duration;
        let mut momenta = &self.constant * over;
        let mut velocities = DMatrix::identity(n, n) * over;
        for spin in &self.spins {
            let theta = at(step, &spin.at);
            let inertia = Self::inertia(system, spin, bodies);
            let by_spin = momentum_by_spin(&theta, &inertia, &at(after, &spin.at), duration);
            let spun = rotation::spin(&theta);
            add_block(&mut momenta, &spin.at, &(by_spin * spun));
            let turned = rotation::turn(&theta) * at(before, &spin.at);
            add_block(&mut velocities, &spin.at, &(turned.cross_matrix() * spun));
        }
        [momenta, velocities]
    }

    /// The largest rotation of a step in space.
    pub fn largest_turn(&self, step: &[f64]) -> f64 {
        self.spins.iter().map(|spin| at(step, &spin.at).norm()).fold(0.0, f64::max)
    }
}
