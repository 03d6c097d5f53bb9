//! Standard output and standard error.
//!
//! A reader of standard output that goes away, as `head` does, ends the printing and nothing else: a run still writes
//! its results, and the exit status is that of the command. Every other failure, such as a full disk, is told on
//! standard error and in the exit status. What standard error does not take is lost: there is nowhere left to tell it. Of
//! several processes that run a case together one prints.

use crate::commands::WRONG_INPUT;
use signorini::processes::speaks;
use std::fmt::Arguments;
use std::io::{Error, ErrorKind, Write, stderr, stdout};
use std::sync::OnceLock;

/// A line on standard output.
macro_rules! say {
    () => { $crate::console::print(format_args!("\n")) };
    ($($text:tt)+) => { $crate::console::print(format_args!("{}\n", format_args!($($text)+))) };
}

/// A line on standard error.
macro_rules! tell {
    ($($text:tt)+) => { $crate::console::print_error(format_args!("{}\n", format_args!($($text)+))) };
}

pub(crate) use {say, tell};

/// Why standard output takes nothing more.
static FAILURE: OnceLock<Error> = OnceLock::new();

/// Prints on standard output, unless that failed before.
pub fn print(text: Arguments<'_>) {
    if !ended() && speaks() {
        note(stdout().write_fmt(text));
    }
}

/// Prints on standard error.
pub fn print_error(text: Arguments<'_>) {
    if speaks() {
        let _ = stderr().write_fmt(text);
    }
}

/// Whether standard output takes nothing more.
pub fn ended() -> bool {
    FAILURE.get().is_some()
}

/// Keeps the first failure of standard output.
pub fn note(printed: Result<(), Error>) {
    if let Err(error) = printed {
        let _ = FAILURE.set(error);
    }
}

/// Empties the buffer of standard output.
pub fn flush() {
    if !ended() {
        note(stdout().flush());
    }
}

/// Empties the buffer of standard output; returns the exit status of a command that would end with `code`.
pub fn finish(code: u8) -> u8 {
    flush();
    match FAILURE.get() {
        Some(error) if error.kind() != ErrorKind::BrokenPipe => {
            tell!("error: cannot write to standard output: {error}");
            code.max(WRONG_INPUT)
        }
        _ => code,
    }
}
