//! The fields of objects as queries write them.

use serde_json::{Map, Value};
use signorini_geometry::Point;
use signorini_geometry::shape::{Axes, ShapeError};

/// What is wrong with a shape: the path of the field, and what would be valid.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{path}: {message}")]
pub struct FieldError {
    pub path: String,
    pub message: String,
}

impl FieldError {
    /// The same, of a field of `path`.
    pub fn within(self, path: &str) -> Self {
        let path = if self.path.is_empty() { path.to_string() } else { format!("{path}.{}", self.path) };
        FieldError { path, ..self }
    }
}

/// The entries of an object, each taken once.
pub struct Fields<'a> {
    path: String,
    pub(super) object: &'a Map<String, Value>,
    pub(super) taken: Vec<&'a str>,
}

impl<'a> Fields<'a> {
    pub fn new(path: &str, value: &'a Value) -> Result<Self, FieldError> {
        match value {
            Value::Object(object) => Ok(Fields { path: path.to_string(), object, taken: Vec::new() }),
            other => {
                Err(FieldError { path: path.to_string(), message: format!("{} instead of an object", kind(other)) })
            }
        }
    }

    pub fn error(&self, key: &str, message: impl Into<String>) -> FieldError {
        let path = if self.path.is_empty() { key.to_string() } else { format!("{}.{key}", self.path) };
        FieldError { path, message: message.into() }
    }

    pub fn optional(&mut self, key: &'a str) -> Option<&'a Value> {
        self.taken.push(key);
        self.object.get(key)
    }

    pub fn required(&mut self, key: &'a str) -> Result<&'a Value, FieldError> {
        self.optional(key).ok_or_else(|| self.error(key, "missing"))
    }

    pub fn text(&mut self, key: &'a str) -> Result<&'a str, FieldError> {
        let value = self.required(key)?;
        value.as_str().ok_or_else(|| self.error(key, format!("{} instead of a string", kind(value))))
    }

    pub(super) fn number_of(&self, key: &str, value: &Value) -> Result<f64, FieldError> {
        match value.as_f64() {
            Some(number) if number.is_finite() => Ok(number),
            _ => Err(self.error(key, format!("{} instead of a finite number", kind(value)))),
        }
    }

    pub fn number(&mut self, key: &'a str) -> Result<f64, FieldError> {
        let value = self.required(key)?;
        self.number_of(key, value)
    }

    pub(super) fn count(&mut self, key: &'a str) -> Result<usize, FieldError> {
        let value = self.required(key)?;
        value
            .as_u64()
            .and_then(|n| usize::try_from(n).ok())
            .ok_or_else(|| self.error(key, format!("{value} instead of a whole number")))
    }

    pub(super) fn array_of<'v>(&self, key: &str, value: &'v Value) -> Result<&'v Vec<Value>, FieldError> {
        value.as_array().ok_or_else(|| self.error(key, format!("{} instead of an array", kind(value))))
    }

    pub(super) fn numbers_of(&self, key: &str, value: &Value) -> Result<Vec<f64>, FieldError> {
        let array = self.array_of(key, value)?;
        array.iter().enumerate().map(|(k, v)| self.number_of(&format!("{key}[{k}]"), v)).collect()
    }

    pub(super) fn numbers(&mut self, key: &'a str) -> Result<Vec<f64>, FieldError> {
        let value = self.required(key)?;
        self.numbers_of(key, value)
    }

    pub(super) fn fixed<const N: usize>(&self, key: &str, numbers: Vec<f64>) -> Result<[f64; N], FieldError> {
        let found = numbers.len();
        numbers.try_into().map_err(|_| self.error(key, format!("{found} numbers instead of {N}")))
    }

    pub(super) fn point_of(&self, key: &str, value: &Value) -> Result<Point<3>, FieldError> {
        Ok(Point::<3>::from(self.fixed::<3>(key, self.numbers_of(key, value)?)?))
    }

    pub(super) fn point(&mut self, key: &'a str) -> Result<Point<3>, FieldError> {
        let value = self.required(key)?;
        self.point_of(key, value)
    }

    pub(super) fn points_of(&self, key: &str, value: &Value) -> Result<Vec<Point<3>>, FieldError> {
        let array = self.array_of(key, value)?;
        array.iter().enumerate().map(|(k, v)| self.point_of(&format!("{key}[{k}]"), v)).collect()
    }

    pub(super) fn points(&mut self, key: &'a str) -> Result<Vec<Point<3>>, FieldError> {
        let value = self.required(key)?;
        self.points_of(key, value)
    }

    pub(super) fn exactly<const N: usize>(&mut self, key: &'a str) -> Result<[Point<3>; N], FieldError> {
        let points = self.points(key)?;
        let found = points.len();
        points.try_into().map_err(|_| self.error(key, format!("{found} points instead of {N}")))
    }

    pub(super) fn net(&mut self, key: &'a str) -> Result<Vec<Vec<Point<3>>>, FieldError> {
        let value = self.required(key)?;
        let array = self.array_of(key, value)?;
        array.iter().enumerate().map(|(k, v)| self.points_of(&format!("{key}[{k}]"), v)).collect()
    }

    pub(super) fn table(&self, key: &str, value: &Value) -> Result<Vec<Vec<f64>>, FieldError> {
        let array = self.array_of(key, value)?;
        array.iter().enumerate().map(|(k, v)| self.numbers_of(&format!("{key}[{k}]"), v)).collect()
    }

    pub(super) fn range(&mut self) -> Result<[f64; 2], FieldError> {
        let numbers = self.numbers("range")?;
        self.fixed("range", numbers)
    }

    pub(super) fn ranges(&mut self) -> Result<[[f64; 2]; 2], FieldError> {
        let value = self.required("range")?;
        let rows = self.table("range", value)?;
        let found = rows.len();
        let [u, v]: [Vec<f64>; 2] =
            rows.try_into().map_err(|_| self.error("range", format!("{found} intervals instead of 2")))?;
        Ok([self.fixed("range[0]", u)?, self.fixed("range[1]", v)?])
    }

    pub(super) fn flag_of(&self, key: &str, value: &Value) -> Result<bool, FieldError> {
        value.as_bool().ok_or_else(|| self.error(key, format!("{} instead of true or false", kind(value))))
    }

    pub(super) fn closed(&mut self) -> Result<bool, FieldError> {
        self.optional("closed").map_or(Ok(false), |v| self.flag_of("closed", v))
    }

    pub(super) fn closed_both(&mut self) -> Result<[bool; 2], FieldError> {
        let Some(value) = self.optional("closed") else { return Ok([false; 2]) };
        let array = self.array_of("closed", value)?;
        match array.as_slice() {
            [u, v] => Ok([self.flag_of("closed[0]", u)?, self.flag_of("closed[1]", v)?]),
            _ => Err(self.error("closed", format!("{} entries instead of 2", array.len()))),
        }
    }

    /// `o`, `ex`, `ey` and, where given, `ez`.
    pub(super) fn axes(&mut self) -> Result<Axes, FieldError> {
        let (o, ex, ey) = (self.point("o")?, self.point("ex")?, self.point("ey")?);
        let axes = match self.optional("ez") {
            Some(value) => Axes::with_third(o, ex, ey, self.point_of("ez", value)?),
            None => Axes::new(o, ex, ey),
        };
        axes.map_err(|e| self.shape_error(&e))
    }

    pub(super) fn shape_error(&self, error: &ShapeError) -> FieldError {
        self.error(error.field, error.message.clone())
    }

    /// Refuses keys that nobody asked for.
    pub fn finish(self, ignored: &[&str]) -> Result<(), FieldError> {
        for key in self.object.keys() {
            if !self.taken.contains(&key.as_str()) && !ignored.contains(&key.as_str()) {
                let mut valid = self.taken.clone();
                valid.sort_unstable();
                return Err(self.error(key, format!("unknown key; valid are {}", valid.join(", "))));
            }
        }
        Ok(())
    }
}

pub(super) fn kind(value: &Value) -> String {
    match value {
        Value::Null => "null".to_string(),
        Value::Bool(b) => b.to_string(),
        Value::Number(n) => n.to_string(),
        Value::String(s) => format!("\"{}\"", s.chars().take(40).collect::<String>()),
        Value::Array(a) => format!("an array of {}", a.len()),
        Value::Object(_) => "an object".to_string(),
    }
}
