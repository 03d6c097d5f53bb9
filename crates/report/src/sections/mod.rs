//! The sections of a page, as HTML.

pub mod answers;
pub mod asked;
pub mod convergence;
pub mod environment;
pub mod others;
pub mod pictures;
pub mod results;
pub mod verdict;
pub mod warnings;
