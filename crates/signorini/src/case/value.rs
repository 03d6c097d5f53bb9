//! Values: a number, a quantity with a unit, or an expression.

use super::units::{Dimension, Units, describe, is_unit};
use super::{CaseError, Document};
use crate::expression::{Expression, Names, parse};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Deserialize, Deserializer, Visitor};
use std::borrow::Cow;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;
use toml::Spanned;

/// A value as it stands in the file.
#[derive(Clone, Debug, PartialEq)]
pub enum Literal {
    Number(f64),
    Text(String),
}

/// A value with its place.
pub type Value = Spanned<Literal>;
/// A vector of values.
pub type Values = Spanned<Vec<Value>>;

impl JsonSchema for Literal {
    fn schema_name() -> Cow<'static, str> {
        "Value".into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "type": ["number", "string"],
        })
    }
}

impl JsonSchema for OneOrMany {
    fn schema_name() -> Cow<'static, str> {
        "ValueOrVector".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let one = generator.subschema_for::<Literal>();
        json_schema!({
            "anyOf": [one.clone(), { "type": "array", "items": one }],
        })
    }
}

impl<'de> Deserialize<'de> for Literal {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl Visitor<'_> for Reader {
            type Value = Literal;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a number, a quantity such as \"0.1 mm\", or an expression in quotes")
            }
            fn visit_i64<E>(self, v: i64) -> Result<Literal, E> {
                Ok(Literal::Number(v as f64))
            }
            fn visit_f64<E>(self, v: f64) -> Result<Literal, E> {
                Ok(Literal::Number(v))
            }
            fn visit_str<E>(self, v: &str) -> Result<Literal, E> {
                Ok(Literal::Text(v.to_string()))
            }
        }
        deserializer.deserialize_any(Reader)
    }
}

/// A value, or a vector of them.
#[derive(Clone, Debug)]
pub enum OneOrMany {
    One(Literal),
    Many(Vec<Value>),
}

impl<'de> Deserialize<'de> for OneOrMany {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = OneOrMany;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a value, or a vector of values")
            }
            fn visit_i64<E>(self, v: i64) -> Result<OneOrMany, E> {
                Ok(OneOrMany::One(Literal::Number(v as f64)))
            }
            fn visit_f64<E>(self, v: f64) -> Result<OneOrMany, E> {
                Ok(OneOrMany::One(Literal::Number(v)))
            }
            fn visit_str<E>(self, v: &str) -> Result<OneOrMany, E> {
                Ok(OneOrMany::One(Literal::Text(v.to_string())))
            }
            fn visit_seq<A: serde::de::SeqAccess<'de>>(self, mut list: A) -> Result<OneOrMany, A::Error> {
                let mut values = Vec::new();
                while let Some(value) = list.next_element()? {
                    values.push(value);
                }
                Ok(OneOrMany::Many(values))
            }
        }
        deserializer.deserialize_any(Reader)
    }
}

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
    pub document: &'a Document,
    pub units: Option<Units>,
    pub names: Names,
    /// What the values with units were taken for, by their places.
    pub interpreted: RefCell<BTreeMap<usize, Interpreted>>,
}

impl Reader<'_> {
    /// What the values with units were taken for, in the order of the file.
    pub fn echo(&self) -> Vec<Interpreted> {
        self.interpreted.borrow().values().cloned().collect()
    }

    fn error(&self, span: Range<usize>, message: impl Into<String>) -> CaseError {
        self.document.error(span, message)
    }

    /// The expression of a value of the given dimension, in which the listed variables are known.
    pub fn expression(
        &self,
        value: &Value,
        dimension: Dimension,
        variables: &[&'static str],
    ) -> Result<Expression, CaseError> {
        let (expression, found) = self.any(value, variables)?;
        match found {
            Some(found) if found != dimension => Err(self
                .error(value.span(), format!("the unit is that of {}", describe(found)))
                .help(format!("here stands {}", describe(dimension)))),
            _ => Ok(expression),
        }
    }

    /// The expression of a value of any dimension, and the dimension if it has a unit.
    pub fn any(&self, value: &Value, variables: &[&'static str]) -> Result<(Expression, Option<Dimension>), CaseError> {
        let text = match value.get_ref() {
            Literal::Number(v) if v.is_finite() => return Ok((Expression::number(*v), None)),
            Literal::Number(v) => return Err(self.error(value.span(), format!("{v} is not a finite number"))),
            Literal::Text(text) => text,
        };
        let (body, unit) = split_unit(text);
        let names = Names { variables: variables.to_vec(), ..self.names.clone() };
        let expression = parse(body, &names).map_err(|e| {
            let error =
                self.error(self.place_in(value, text, e.span), format!("in the expression `{text}`: {}", e.message));
            match e.help {
                Some(help) => error.help(help),
                None => error,
            }
        })?;
        let Some(unit) = unit else { return Ok((expression, None)) };
        let start = text.len() - unit.len();
        let place = self.place_in(value, text, start..text.len());
        let units = self.units.ok_or_else(|| {
            self.error(place.clone(), format!("`{text}` has a unit, but the file has no `units`"))
                .help("add  units = \"mm-N-MPa\"  (or m-N-Pa, um-uN-MPa) at the top, or leave the unit out")
        })?;
        let (factor, found) = units.factor(unit).map_err(|message| self.error(place, message))?;
        let expression = expression.scaled(factor);
        let line = self.document.line_of(value.span().start);
        let echo =
            Interpreted { line, text: text.clone(), value: expression.constant(), unit: units.name_of(found), factor };
        self.interpreted.borrow_mut().insert(value.span().start, echo);
        Ok((expression, Some(found)))
    }

    /// A value that must be a number.
    pub fn number(&self, value: &Value, dimension: Dimension) -> Result<f64, CaseError> {
        let number = self.expression(value, dimension, &[])?.constant().unwrap_or(f64::NAN);
        if number.is_finite() {
            return Ok(number);
        }
        Err(self.error(value.span(), format!("the value is {number}, not a finite number")))
    }

    /// A value that must be a positive number.
    pub fn positive(&self, value: &Value, dimension: Dimension) -> Result<f64, CaseError> {
        let number = self.number(value, dimension)?;
        if number > 0.0 {
            return Ok(number);
        }
        Err(self.error(value.span(), format!("the value is {number}: it must be positive")))
    }

    /// A vector of `N` numbers.
    pub fn numbers<const N: usize>(&self, values: &Values, dimension: Dimension) -> Result<[f64; N], CaseError> {
        let list = values.get_ref();
        if list.len() != N {
            return Err(self.error(values.span(), format!("expected {N} numbers, found {}", list.len())));
        }
        let mut out = [0.0; N];
        for (o, v) in out.iter_mut().zip(list) {
            *o = self.number(v, dimension)?;
        }
        Ok(out)
    }

    /// Place in the file of a part of a quoted text, if it stands there without escapes.
    fn place_in(&self, value: &Value, text: &str, part: Range<usize>) -> Range<usize> {
        let span = value.span();
        let quoted = self.document.text.get(span.clone()).unwrap_or("");
        match quoted.find(text) {
            Some(at) => span.start + at + part.start..span.start + at + part.end.max(part.start),
            None => span,
        }
    }
}

/// Splits `"0.1 mm"`, `"0.1mm"` and `"(2 + x) MPa"` into the value and its unit.
fn split_unit(text: &str) -> (&str, Option<&str>) {
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
    if told && unit.starts_with(|c: char| c.is_alphabetic()) { (&text[..end], Some(unit)) } else { (text, None) }
}

#[cfg(test)]
mod tests {
    use super::split_unit;

    #[test]
    fn units_are_told_from_expressions() {
        assert_eq!(split_unit("0.1 mm"), ("0.1", Some("mm")));
        assert_eq!(split_unit("-1e-3 N/m"), ("-1e-3", Some("N/m")));
        assert_eq!(split_unit("(2 + x) MPa"), ("(2 + x)", Some("MPa")));
        assert_eq!(split_unit("-(2 + x) kPa"), ("-(2 + x)", Some("kPa")));
        assert_eq!(split_unit("150um"), ("150", Some("um")));
        assert_eq!(split_unit("-1e-3N/m"), ("-1e-3", Some("N/m")));
        assert_eq!(split_unit("(2 + x)kPa"), ("(2 + x)", Some("kPa")));
        assert_eq!(split_unit("2x"), ("2x", None));
        assert_eq!(split_unit("(2 + x)*y"), ("(2 + x)*y", None));
        assert_eq!(split_unit("2*x"), ("2*x", None));
        assert_eq!(split_unit("x"), ("x", None));
        assert_eq!(split_unit(" (1"), (" (1", None));
    }
}
