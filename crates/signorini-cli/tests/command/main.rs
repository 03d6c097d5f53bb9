//! The tests of the command as one program.

mod closed_output;
mod runs;
mod sweeps;
