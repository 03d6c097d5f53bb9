//! Values as expressions in base units.

use crate::expression::{Expression, Names, parse};
use crate::problem::units::{Dimension, NONE, Units, describe, is_unit};
use crate::problem::{CaseError, KeyPath, List, Problem, ProblemPart, Value};
use crate::relief::Sampled;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::sync::Arc;

/// What a value with a unit was taken for.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
pub struct Interpreted {
    /// Line of the case file; null for what `--set` says.
    pub line: Option<usize>,
    /// The value as it is written.
    pub text: String,
    /// The value in the base unit; null where it depends on position or time.
    pub value: Option<f64>,
    /// The base unit of the case.
    pub unit: String,
    /// How many base units make one of the stated unit.
    pub factor: f64,
}

/// Turns values into expressions in base units.
pub struct Reader<'a> {
    pub problem: &'a Problem,
    pub units: Option<Units>,
    pub names: Names,
    /// What the values with units were taken for, by their keys.
    pub interpreted: RefCell<BTreeMap<KeyPath, Interpreted>>,
}

impl Reader<'_> {
    /// What the values with units were taken for, in the order of the file.
    pub fn echo(&self) -> Vec<Interpreted> {
        let found = self.interpreted.borrow();
        let mut list: Vec<_> = found.iter().collect();
        if let Some(text) = &self.problem.source.text {
            list.sort_by_key(|(key, _)| text.order(key));
        }
        list.into_iter().map(|(_, told)| told.clone()).collect()
    }

    fn error<T: ProblemPart>(&self, part: &T, message: impl Into<String>) -> CaseError {
        self.problem.error(part, message)
    }

    /// The expression of a value of the given dimension, in which the listed variables are known.
    ///
    /// # Errors
    /// What is no expression, with the place in it; another dimension; a unit where the problem has none; one that depends on
    /// time without steps.
    pub fn expression(
        &self,
        value: &Value,
        dimension: Dimension,
        variables: &[&'static str],
    ) -> Result<Expression, CaseError> {
        let (expression, found) = self.any(value, variables)?;
        match found {
            Some(found) if found != dimension => Err(self
                .error(value, format!("the unit is that of {}", describe(found)))
                .help(format!("expected is {}", describe(dimension)))),
            _ if expression.uses_time() && self.problem.is_at_one_time() => {
                let key = self.problem.key(value);
                Err(self
                    .error(value, format!("`{key}` depends on t, but there are no steps"))
                    .help("add for example  [[steps]]  to = 1.0  increments = 10"))
            }
            _ => Ok(expression),
        }
    }

    /// The expression of a value of any dimension, and the dimension if it has a unit.
    ///
    /// # Errors
    /// Those of [`Self::expression`].
    pub fn any(&self, value: &Value, variables: &[&'static str]) -> Result<(Expression, Option<Dimension>), CaseError> {
        let text = match value {
            Value::Number(v) if v.is_finite() => return Ok((Expression::number(*v), None)),
            Value::Number(v) => return Err(self.error(value, format!("{v} is not a finite number"))),
            Value::Function(_) | Value::Samples(_) if !variables.contains(&"x") => {
                return Err(self.error(value, "give a constant value, not a field"));
            }
            Value::Function(function) => return Ok((Expression::function(function.clone()), None)),
            Value::Samples(samples) => {
                let columns = samples.values.first().map_or(0, Vec::len);
                if let Some(row) = samples.values.iter().position(|row| row.len() != columns) {
                    let found = samples.values[row].len();
                    return Err(
                        self.error(value, format!("row {row} has {found} values, but the first row has {columns}"))
                    );
                }
                let values: Vec<f64> = samples.values.iter().flatten().copied().collect();
                let sampled = Sampled::of_rows(samples.origin, samples.spacing, columns, &values);
                return Ok((Expression::height(Arc::new(sampled.map_err(|e| self.error(value, e))?)), None));
            }
            Value::Text(text) => text,
        };
        let (body, unit) = split_unit(text);
        let names = Names { variables: variables.to_vec(), ..self.names.clone() };
        let expression = parse(body, &names).map_err(|e| {
            let message = format!("in the expression `{text}`: {}", e.message);
            let error = self.problem.error_within(value, text, e.span, message);
            match e.help {
                Some(help) => error.help(help),
                None => error,
            }
        })?;
        let Some(unit) = unit else { return Ok((expression, None)) };
        let of_unit = text.len() - unit.len()..text.len();
        let wrong = |message: String| self.problem.error_within(value, text, of_unit.clone(), message);
        let units = self.units.ok_or_else(|| {
            wrong(format!("`{text}` has a unit, but the file has no `units`"))
                .help("add  units = \"mm-N-MPa\"  (or m-N-Pa, um-uN-MPa) at the top, or leave the unit out")
        })?;
        let (factor, found) = units.factor(unit).map_err(wrong)?;
        let expression = expression.scaled(factor).shifted(units.shift(unit));
        let key = self.problem.key(value);
        let line = self.problem.source.line(&key);
        let echo =
            Interpreted { line, text: text.clone(), value: expression.constant(), unit: units.name_of(found), factor };
        self.interpreted.borrow_mut().insert(key, echo);
        Ok((expression, Some(found)))
    }

    /// A value that must be a number.
    ///
    /// # Errors
    /// Those of [`Self::expression`], and what is no finite number.
    pub fn number(&self, value: &Value, dimension: Dimension) -> Result<f64, CaseError> {
        let number = self.expression(value, dimension, &[])?.constant().unwrap_or(f64::NAN);
        if number.is_finite() {
            return Ok(number);
        }
        Err(self.error(value, format!("the value is {number}, not a finite number")))
    }

    /// A value that must be an angle: in radians, or in degrees with the word.
    ///
    /// # Errors
    /// Those of [`Self::number`].
    pub fn angle(&self, value: &Value) -> Result<f64, CaseError> {
        self.in_degrees(value)?.map_or_else(|| self.number(value, NONE), Ok)
    }

    /// An angle in degrees, in radians; none of what does not end with that word.
    ///
    /// # Errors
    /// Degrees that are no number.
    pub fn in_degrees(&self, value: &Value) -> Result<Option<f64>, CaseError> {
        let Value::Text(text) = value else { return Ok(None) };
        let text = text.trim_end();
        let Some(number) = text.strip_suffix("deg").or_else(|| text.strip_suffix('°')) else { return Ok(None) };
        match number.trim().parse().ok().filter(|degrees: &f64| degrees.is_finite()) {
            Some(degrees) => Ok(Some(degrees.to_radians())),
            None => {
                let message = format!("`{}` is not an angle in degrees", number.trim());
                Err(self.error(value, message).help("give radians, or for example \"25 deg\""))
            }
        }
    }

    /// A value that must be a positive number.
    ///
    /// # Errors
    /// Those of [`Self::number`], and numbers that are not positive.
    pub fn positive(&self, value: &Value, dimension: Dimension) -> Result<f64, CaseError> {
        let number = self.number(value, dimension)?;
        if number > 0.0 {
            return Ok(number);
        }
        Err(self.error(value, format!("the value is {number}: it must be positive")))
    }

    /// A vector of `N` numbers.
    ///
    /// # Errors
    /// Those of [`Self::number`], and another number of them.
    pub fn numbers<const N: usize>(&self, values: &List<Value>, dimension: Dimension) -> Result<[f64; N], CaseError> {
        if values.len() != N {
            return Err(self.error(values, format!("expected {N} numbers, found {}", values.len())));
        }
        let mut out = [0.0; N];
        for (o, v) in out.iter_mut().zip(values) {
            *o = self.number(v, dimension)?;
        }
        Ok(out)
    }
}

/// Splits `"0.1 mm"`, `"0.1mm"` and `"(2 + x) MPa"` into the value and its unit.
#[doc(hidden)]
pub fn split_unit(text: &str) -> (&str, Option<&str>) {
    let trimmed = text.trim_start();
    let offset = text.len() - trimmed.len();
    let sign = usize::from(trimmed.starts_with(['-', '+']));
    let end = if trimmed[sign..].starts_with('(') {
        let mut depth = 0;
        trimmed[sign..].char_indices().find_map(|(i, c)| {
            depth += i32::from(c == '(') - i32::from(c == ')');
            (depth == 0).then_some(sign + i + 1)
        })
    } else {
        match crate::expression::number_length(&trimmed[sign..]) {
            0 => None,
            length => Some(sign + length),
        }
    };
    let Some(end) = end.map(|e| e + offset) else { return (text, None) };
    let rest = &text[end..];
    let unit = rest.trim_start();
    // Without a space between them only what is a unit is one: `150um`, but not `2x`.
    let told = unit.len() < rest.len() || is_unit(unit);
    let is_inverse = unit.starts_with("1/") && is_unit(unit);
    if told && (is_inverse || unit.starts_with(|c: char| c.is_alphabetic())) {
        (&text[..end], Some(unit))
    } else {
        (text, None)
    }
}
