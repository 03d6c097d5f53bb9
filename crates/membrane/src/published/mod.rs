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

pub(crate) mod level_set;
mod multiplier;
pub(crate) mod saddle;
pub(crate) mod schedule;
mod sensitivity;
pub mod stages;
mod velocity;

pub use level_set::NodalLevelSet;
pub use multiplier::{FrontMultipliers, inf_sup};
pub use saddle::Saddle;
pub use schedule::ModeSchedule;
pub use sensitivity::FrontRate;
