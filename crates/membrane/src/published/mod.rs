//! The inequality level-set method as it was published: both sides of the front, two multipliers, and the sensitivity of
//! all of it to the shape of the zone.
//!
//! (N. Chevaugeon, M. Graveleau & N. Moës, and M. Graveleau's thesis, 2015.) The displacement is solved for in the contact
//! zone as well as outside it, with nodes of the cells along the front doubled, so that it may jump there. In the zone a
//! multiplier `p` presses it onto the body, along the front another one, `λ`, ties the two sides together:
//!
//! ```text
//! ∫ T ∇u·∇v + ∫_zone (l² ∇p·∇v + p v) + ∫_Γ λ [[v]] = ∫ f v
//!             ∫_zone (l² ∇q·∇u + q u)               = ∫_zone (l² ∇q·∇h + q h)
//!                                     ∫_Γ μ [[u]]   = 0
//! ```
//!
//! The multiplier along the front is the pull of the free membrane, `λ = T ∂_n u⁺`, so the gap opens with the slope
//! `ρ = λ/T - ∂_n h`. Its derivative with respect to the shape is found in the form of integrals over the domain, which
//! asks for no more derivatives than the solution has: the equations keep their matrix, and each mode of the front
//! has its own right-hand side.
//!
//! Here the equations are solved block by block, which gives the same numbers as solving them at once: the displacement
//! in the zone is the projection of the body onto the functions of the cells, whatever happens outside; the free
//! membrane then takes its values along the front; and `p` follows from both.

mod level_set;
mod multiplier;
mod saddle;
mod schedule;
mod sensitivity;
mod velocity;

pub use level_set::NodalLevelSet;
pub use multiplier::{FrontMultipliers, inf_sup};
pub use saddle::Saddle;
pub use schedule::ModeSchedule;
pub use sensitivity::FrontRate;

/// How the equilibrium beside a zone is formulated.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Formulation {
    /// Of the free membrane alone, held along the front by Nitsche's method.
    #[default]
    OneSided,
    /// Of both sides of the front, with multipliers.
    Published(Published),
}

impl Formulation {
    /// How it moves fronts.
    pub fn transport(self) -> Transport {
        match self {
            Formulation::OneSided => Transport::Exact,
            Formulation::Published(published) => published.transport,
        }
    }
}

/// The choices within the published formulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Published {
    pub multiplier: ZoneMultiplier,
    pub transport: Transport,
}

/// How fronts are moved by a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Transport {
    /// As curves: nothing is lost on the way.
    #[default]
    Exact,
    /// As the level set of a function on the nodes of the grid, which becomes the signed distance to the moved front. What is
    /// linear between nodes shifts a front by the square of the cell, every time.
    Redistancing,
    /// As the level set of such a function, carried along by the equation of Hamilton and Jacobi, `φ_t + w |∇φ| = 0`.
    HamiltonJacobi,
}

/// The space of the multiplier in the contact zone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ZoneMultiplier {
    /// With square-integrable gradients, weighed by the square of a length: it can carry the line force along a front that
    /// is not at rest.
    H1 { length: f64 },
    /// Square-integrable only: along such a front it oscillates.
    L2,
}

impl ZoneMultiplier {
    /// The weight of the gradients.
    pub fn gradient_weight(self) -> f64 {
        match self {
            ZoneMultiplier::H1 { length } => length * length,
            ZoneMultiplier::L2 => 0.0,
        }
    }
}
