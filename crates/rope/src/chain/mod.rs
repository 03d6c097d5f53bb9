//! Ropes of straight elements that carry tension only.
//!
//! - [`element`]: one element, with its unstrained length as a variable.
//! - [`body`]: a whole rope, with pulleys and winches.
//! - [`winch`]: rope that is wound on and off, with elements that come and go.
//! - [`form`]: equilibrium of nets of any topology, from any start.

pub mod body;
pub mod element;
pub mod form;
mod on_winch;
pub mod winch;

pub use body::{Chain, ChainError};
