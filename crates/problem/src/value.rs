//! Values: a number, a quantity with a unit, an expression, a function of Rust, or samples on a grid.

use super::List;
use super::arrays::Grid2;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Deserialize, Deserializer, MapAccess, SeqAccess, Visitor, value::MapAccessDeserializer};
use serde::ser::{Serialize, Serializer};
use signorini_expression::{FieldFunction, InTime};
use signorini_geometry::Jet;
use std::borrow::Cow;
use std::fmt;

/// A value: constant, or a field over position and time.
#[derive(Clone, Debug)]
pub enum Value {
    /// In the base units.
    Number(f64),
    /// A quantity such as `0.1 mm`, or an expression of x, y, z and t such as `-0.1*x^2`.
    Text(String),
    /// A function of position and time, in the base units.
    Function(FieldFunction),
    /// Values at the points of a grid over x and y, joined by a bicubic spline, in the base units.
    Samples(Grid2),
}

impl Value {
    /// A field from a function of the position, which is evaluated on jets: its derivatives are exact.
    pub fn field(f: impl Fn([Jet<3>; 3]) -> Jet<3> + Send + Sync + 'static) -> Self {
        Self::Function(FieldFunction::new(move |x, _| f(x), InTime::Fixed))
    }

    /// A field that depends on time too.
    pub fn field_in_time(f: impl Fn([Jet<3>; 3], f64) -> Jet<3> + Send + Sync + 'static) -> Self {
        Self::Function(FieldFunction::new(f, InTime::Varying))
    }
}

impl Default for Value {
    fn default() -> Self {
        Self::Number(0.0)
    }
}

impl From<f64> for Value {
    fn from(value: f64) -> Self {
        Self::Number(value)
    }
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Self::Text(text.into())
    }
}

impl From<String> for Value {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl From<Grid2> for Value {
    fn from(samples: Grid2) -> Self {
        Self::Samples(samples)
    }
}

impl JsonSchema for Value {
    fn schema_name() -> Cow<'static, str> {
        "Value".into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": ["number", "string"] })
    }
}

impl Serialize for Value {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Value::Number(v) => serializer.serialize_f64(*v),
            Value::Text(text) => serializer.serialize_str(text),
            // What no text states cannot be read back.
            Value::Function(_) => serializer.serialize_str("a function of the program"),
            Value::Samples(samples) => samples.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for Value {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = Value;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a number, a quantity such as \"0.1 mm\", or an expression in quotes")
            }
            fn visit_i64<E>(self, v: i64) -> Result<Value, E> {
                Ok(Value::Number(v as f64))
            }
            fn visit_f64<E>(self, v: f64) -> Result<Value, E> {
                Ok(Value::Number(v))
            }
            fn visit_str<E>(self, v: &str) -> Result<Value, E> {
                Ok(Value::Text(v.to_string()))
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Value, A::Error> {
                Grid2::deserialize(MapAccessDeserializer::new(map)).map(Value::Samples)
            }
        }
        deserializer.deserialize_any(Reader)
    }
}

/// The components of a vector; one where a scalar is meant.
#[derive(Clone, Debug, Default)]
pub struct Components(pub List<Value>);

impl<V: Into<Value>> From<V> for Components {
    fn from(value: V) -> Self {
        Self(vec![value.into()].into())
    }
}

impl<V: Into<Value>, const N: usize> From<[V; N]> for Components {
    fn from(values: [V; N]) -> Self {
        Self(values.into())
    }
}

impl JsonSchema for Components {
    fn schema_name() -> Cow<'static, str> {
        "ValueOrVector".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let one = generator.subschema_for::<Value>();
        json_schema!({ "anyOf": [one.clone(), { "type": "array", "items": one }] })
    }
}

impl Serialize for Components {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if let [one] = &self.0[..] {
            return serializer.serialize_newtype_struct("Components", one);
        }
        self.0.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Components {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = Components;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a value, or a vector of values")
            }
            fn visit_i64<E>(self, v: i64) -> Result<Components, E> {
                Ok((v as f64).into())
            }
            fn visit_f64<E>(self, v: f64) -> Result<Components, E> {
                Ok(v.into())
            }
            fn visit_str<E>(self, v: &str) -> Result<Components, E> {
                Ok(v.into())
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Components, A::Error> {
                let mut values = Vec::new();
                while let Some(value) = list.next_element()? {
                    values.push(value);
                }
                Ok(Components(values.into()))
            }
        }
        deserializer.deserialize_any(Reader)
    }
}
