//! Motion with inertia: what bodies weigh, and how an increment follows from velocities.

use crate::body::PlaceError;
use signorini_geometry::Matrix;

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

/// How bodies move with inertia.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dynamics {
    /// Spectral radius at high frequencies of the generalised-α method, from 0 to 1.
    pub spectral_radius: f64,
    /// Damping by mass (one over a time) and stiffness (a time) after Rayleigh.
    pub damping: [f64; 2],
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

    /// The rotation since the start of the section or body of which these are the spins ([`SpinInertia`]).
    fn orientation(&self, _state: &crate::body::BodyState, _unknowns: [u32; 3]) -> Matrix<3> {
        Matrix::<3>::identity()
    }
}
