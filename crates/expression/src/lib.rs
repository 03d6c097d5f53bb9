//! Expressions of position and time, as users write them in case files.
//!
//! An expression is parsed once and evaluated on plain numbers or on jets, which yields exact first and second
//! derivatives. Errors point at the character.

mod function;
mod parse;
mod scope;
mod suggestion;
mod tree;

pub use function::{FieldFunction, InTime};
pub use parse::{Names, ParseError, function_names, number_length, parse};
pub use scope::Scope;
pub use suggestion::suggestion;
pub use tree::{Definition, Expression, MAX_DEPTH, MAX_TOKENS};
