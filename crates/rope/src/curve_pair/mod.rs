//! Contact between curves with circular sections.
//!
//! - [`measure`]: gap and slip of two points of curves with their variations: crossing, line and end pairs alike.
//! - [`blend`]: from point contact of crossing curves to line contact of nearly parallel ones.
//! - [`search`]: local minima of the distance of two curves, or of a curve to itself.
//! - [`friction`]: friction along the curves and around their sections.
//! - [`contact`]: where curves touch and with which forces; [`interaction`]: as a part of a system.
//! - `side`: on which side of each other curves are, such as edges, which have an inside.
//! - [`history`]: what is kept of contacts; `passage`: how far steps may be followed so that no curve passes through one.

pub mod blend;
pub mod contact;
pub mod friction;
pub mod history;
pub mod interaction;
pub mod measure;
pub(crate) mod passage;
pub mod search;
pub(crate) mod side;

pub use contact::{CurveContact, CurveContactError, Form};
