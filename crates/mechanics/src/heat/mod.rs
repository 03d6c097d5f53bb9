//! Heat in the bodies of a system, and through their contacts.
//!
//! With the temperature `T = Σ N_f T_f` in the functions of each body, conductivity `k`, density `ρ` and specific heat `c`,
//!
//! ```text
//! ∫ ρ c Ṫ δT + ∫ k ∇T·∇δT = ∫ r δT + ∫ q δT + ∫ α (T_∞ - T) δT + contacts
//! contacts: Σ_k w_k h(p_k) (T_m - T_s) (δT_s - δT_m) + P_k (s δT_s + (1 - s) δT_m)
//! ```
//!
//! summed over the sites of contacts that are closed: `w` their areas, `h` the conductance at their pressure `p`, `T_s` and `T_m`
//! the temperatures of both sides, `P` the power of friction, of which the slave takes the share `s`. Of mortar contact a site is
//! a node with the area of its dual function, and `T_s`, `T_m` are means weighted by that function (Hüeber and Wohlmuth,
//! *Comput. Methods Appl. Mech. Engrg.* 198, 2009). Time is integrated by the implicit Euler method.
//!
//! Temperatures act on bodies by thermal strain, bodies on temperatures by pressures and slip. Each is solved for in turn
//! (`staggered`), until the temperatures change no more.

mod contacts;
mod equation;
mod flows;
mod parts;
mod staggered;

pub(crate) use contacts::first_unknowns;
pub use contacts::{Conductance, Conducting, HeatContact, Means};
pub use flows::{ContactFlow, HeatResult};
pub use parts::{HeatLoad, PlacedHeat, PrescribedTemperature};

use crate::body::{BodyState, Field, PlaceError};
use crate::placed::TimeField;
use std::collections::BTreeMap;

/// A dense symmetric block of a few functions, row by row.
pub type Block = (Vec<u32>, Vec<f64>);
/// Several, which add up.
pub type Blocks = Vec<Block>;

/// How temperatures change with time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Equation {
    /// Nothing is stored.
    #[default]
    Steady,
    /// Implicit Euler.
    Transient,
}

/// What is known of the heat in a system.
pub struct Heat {
    pub equation: Equation,
    /// Temperatures of whole bodies that are known, by body: of solids by place and time, of rigid bodies by time.
    pub known: BTreeMap<usize, TimeField>,
    pub supports: Vec<PrescribedTemperature>,
    pub loads: Vec<PlacedHeat>,
    /// Of each contact of the system; none where no heat passes.
    pub contacts: Vec<Option<HeatContact>>,
    /// Largest change of a temperature that ends the passes, relative to the range of temperatures.
    pub tolerance: f64,
    pub most_passes: usize,
}

/// The temperature of a body in the functions of its displacement, one coefficient for each.
pub trait ThermalBody: Sync {
    /// Number of coefficients.
    fn count(&self) -> usize;

    /// Unknowns of the body for each function: unknown `d f + i` moves function `f` along axis `i`.
    fn dimension(&self) -> usize;

    /// Whether heat flows in the body; if not, its temperature is known.
    fn conducts(&self) -> bool;

    /// The coefficients of a state.
    fn temperature<'a>(&self, state: &'a BodyState) -> &'a [f64];

    /// Gives a state other ones, with the thermal strains that belong to them.
    fn set_temperature(&self, state: &mut BodyState, temperature: &[f64]);

    /// Coefficients of a field.
    fn coefficients(&self, field: Field<'_>) -> Vec<f64>;

    /// The functions of a place, with the coefficients that fit a field best.
    ///
    /// # Errors
    /// A place that is not there, or has no functions.
    fn held(&self, on: Option<&str>, field: Field<'_>) -> Result<Vec<(u32, f64)>, PlaceError>;

    /// Whether each function is one of those that sum to one: heat into them is that into the body.
    fn unity(&self) -> Vec<bool>;

    /// `∫ k ∇N_a·∇N_b`, cell by cell; nothing of bodies that do not conduct.
    fn conduction(&self) -> &[Block];

    /// `∫ ρ c N_a N_b`, cell by cell, or an approximation with the same row sums; none where a density or specific heat is not known.
    fn capacity(&self) -> Option<&[Block]>;

    /// Adds `∫ r N_a` over the volume of a place.
    ///
    /// # Errors
    /// A place that is not there, or has no cells.
    fn add_source(&self, on: Option<&str>, source: Field<'_>, out: &mut [f64]) -> Result<(), PlaceError>;

    /// Adds `∫ q N_a` over the sides of a place.
    ///
    /// # Errors
    /// A place that is not there, or has no sides.
    fn add_flux(&self, on: Option<&str>, flux: Field<'_>, out: &mut [f64]) -> Result<(), PlaceError>;

    /// `∫ α N_a N_b` over the sides of a place.
    ///
    /// # Errors
    /// A place that is not there, or has no sides.
    fn film(&self, on: Option<&str>, coefficient: Field<'_>) -> Result<Blocks, PlaceError>;

    /// The least and the largest temperature at points of a state.
    fn range(&self, state: &BodyState) -> [f64; 2];
}

/// A body that may have a temperature.
pub trait Thermal {
    /// The body as one with a temperature; none of others.
    fn thermal(&self) -> Option<&dyn ThermalBody> {
        None
    }
}

/// Why there are no temperatures.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum HeatError {
    /// A part of a body whose temperature nothing tells.
    #[error("nothing tells the temperature of `{body}` about ({}): no path of heat leads to a given temperature, a fluid, or a body that has one", at(.x))]
    Floating { body: String, x: [f64; 3] },
    #[error("the flows of heat do not balance: {imbalance:.1e} of the largest is left")]
    Imbalance { imbalance: f64 },
    #[error("heat and mechanics do not agree after {passes} passes")]
    NotConverged { passes: usize, history: Vec<f64> },
    /// Two supports that ask for different temperatures.
    #[error("supports `{first}` and `{second}` prescribe different temperatures of `{body}`")]
    Contradiction { first: String, second: String, body: String },
    #[error("temperatures cannot be solved for: {0}")]
    Solve(String),
    #[error(transparent)]
    Place(#[from] PlaceError),
}

fn at(x: &[f64; 3]) -> String {
    x.map(|v| format!("{v:.4}")).join(", ")
}
