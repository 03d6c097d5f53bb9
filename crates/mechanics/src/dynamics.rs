//! Motion with inertia: what bodies weigh, and how they are to move.

use crate::body::{Body, BodyState, PlaceError};
use crate::rotation;
use signorini_geometry::{Matrix, Point, Vector};

/// The mass of a body in its unknowns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mass {
    /// Of the unknowns that are displacements: dense symmetric blocks, row by row, of a few unknowns each.
    pub blocks: Vec<(Vec<u32>, Vec<f64>)>,
    /// Of those that are spins.
    pub spins: Vec<SpinInertia>,
}

/// The inertia of a section or a rigid body against rotation.
#[derive(Clone, Debug, PartialEq)]
pub struct SpinInertia {
    /// Its spins about the axes of space.
    pub unknowns: [u32; 3],
    /// Moments of inertia about the axes of space as the body starts.
    pub inertia: Matrix<3>,
}

impl SpinInertia {
    /// About the axes of space after a rotation.
    pub fn after(&self, rotation: &Matrix<3>) -> Matrix<3> {
        rotation * self.inertia * rotation.transpose()
    }
}

/// The angular velocity `2 θ/h - exp(θ) ω` after a rotation vector of a step of the midpoint rule, from that before.
pub(crate) fn angular_velocity_after(theta: &Vector<3>, before: &Vector<3>, duration: f64) -> Vector<3> {
    theta * (2.0 / duration) - rotation::turn(theta) * before
}

/// How the angular momentum at the end of such a step changes with the spin there.
pub(crate) fn momentum_by_spin(theta: &Vector<3>, inertia: &Matrix<3>, after: &Vector<3>, duration: f64) -> Matrix<3> {
    inertia * rotation::of_spin(theta).transpose() * (2.0 / duration) - (inertia * after).cross_matrix()
}

impl Mass {
    /// Adds the momenta of velocities, times a factor: those of displacements only.
    pub fn add_product(&self, velocities: &[f64], factor: f64, out: &mut [f64]) {
        for (unknowns, values) in &self.blocks {
            for (row, i) in values.chunks(unknowns.len()).zip(unknowns) {
                let momentum: f64 = row.iter().zip(unknowns).map(|(m, j)| m * velocities[*j as usize]).sum();
                out[*i as usize] += factor * momentum;
            }
        }
    }

    /// The force `-M a` of an acceleration of space, such as that of gravity, on the unknowns of a body, as a residual.
    pub(crate) fn add_weight(&self, body: &dyn Body, state: &BodyState, acceleration: &Vector<3>, out: &mut [f64]) {
        let modes = body.rigid_modes(state);
        let along = |k: usize| (0..3).map(|i| acceleration[i] * modes[i][k]).sum();
        let field: Vec<f64> = (0..out.len()).map(along).collect();
        self.add_product(&field, -1.0, out);
    }
}

/// How bodies move with inertia.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dynamics {
    /// Spectral radius at high frequencies of the generalised-α method, from 0 to 1.
    pub spectral_radius: f64,
    /// Damping by mass (one over a time) and stiffness (a time) after Rayleigh.
    pub damping: [f64; 2],
    /// Whether the error in time of rigid bodies is asked for, which costs two more solutions; that of others is always known.
    pub tells_error: bool,
}

/// What a body resists to acceleration.
pub trait Inertial {
    /// The mass of the body; none of a body without. Sides that may touch, `None` for the whole surface, carry no mass of their own
    /// where the body can redistribute it.
    ///
    /// # Errors
    /// Sides that the body does not have.
    fn mass(&self, _touching: &[Option<&str>]) -> Result<Option<Mass>, PlaceError> {
        Ok(None)
    }

    /// The velocities of its unknowns with which it starts, where it knows them by itself; none where they are told otherwise.
    fn initial_velocity(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Angular velocities of sections that follow their line, of which the velocities are there; `turning` is how fast the material
    /// at a point turns, for the rotation about the line itself.
    fn turn_sections(&self, _velocities: &mut [f64], _turning: &dyn Fn(&Point<3>) -> Vector<3>) {}

    /// The rotation since the start of the section or body of which these are the spins ([`SpinInertia`]).
    fn orientation(&self, _state: &BodyState, _unknowns: [u32; 3]) -> Matrix<3> {
        Matrix::<3>::identity()
    }
}

/// How the bodies moved in an increment, each by itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Moved {
    pub before: Vec<Moving>,
    pub after: Vec<Moving>,
    /// Resultant of `-M a` at the end, and its moment about the origin; none of bodies that turn.
    pub inertia: Vec<(Vector<3>, Option<Vector<3>>)>,
    /// Energy that damping took.
    pub damped: f64,
    /// Resultants of the forces of damping by stiffness on each body, and their moments about the origin: they balance in the mean of
    /// an increment, not at its end. None without such damping.
    pub damping: Vec<[Vector<3>; 2]>,
    /// Energy that contact gave as it closed or opened, and that could not be taken back: of an increment that is too long for it.
    pub by_contact: f64,
    /// Error that the method added to displacements, per time, in the norm of the mass: the root of twice an energy (Zienkiewicz
    /// and Xie 1991); of rigid bodies by halves of the increment, where it is asked for.
    pub error: f64,
}

/// What moves: kinetic energy and momenta of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moving {
    /// In each direction of the space.
    pub mass: f64,
    pub kinetic_energy: f64,
    pub momentum: Vector<3>,
    /// About the origin.
    pub angular_momentum: Vector<3>,
}
