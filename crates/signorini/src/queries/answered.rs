//! An answer as it is written.

use super::answer::{Answer, Format};
use super::fields::FieldError;
use super::query::PairQuery;
use signorini_geometry::closest::{Certificate, Projection, Uniqueness};
use std::time::Duration;

/// An answer as it is written.
pub struct Answered {
    pub id: String,
    pub line: usize,
    /// Whether the closest points are the only ones and certified, or what is wrong.
    pub found: Result<(Uniqueness, Certificate), FieldError>,
    pub text: Vec<u8>,
    pub time: Duration,
}

impl Answered {
    pub fn new(
        id: String,
        line: usize,
        first: bool,
        format: Format,
        result: Result<(PairQuery, Projection), FieldError>,
    ) -> Self {
        let mut text = Vec::new();
        let found = match result {
            Ok((query, projection)) => {
                format.row(&mut text, &id, first, Ok(&Answer::new(&projection, &query)));
                Ok((projection.uniqueness, projection.certificate))
            }
            Err(error) => {
                format.row(&mut text, &id, first, Err((&error.to_string(), line)));
                Err(error)
            }
        };
        Answered { id, line, found, text, time: Duration::ZERO }
    }
}
