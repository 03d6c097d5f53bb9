//! The tests of the command as one program.

mod closed_output;
mod processes;
mod reports;
mod runs;
mod sweeps;
