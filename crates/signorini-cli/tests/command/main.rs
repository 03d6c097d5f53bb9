//! The tests of the command as one program.

mod closed_output;
mod reports;
mod runs;
mod sweeps;
