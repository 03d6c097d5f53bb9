//! A problem in plain types: bodies, what holds and pushes them, who may touch whom, and the history.
//!
//! These types are the grammar of the case file, of Rust and of Python alike. Every variant is a table with one key, and
//! unknown keys are refused. What a key means, and in which unit it stands, is said here once. A problem knows nothing of
//! lines and columns: what is wrong with it is told by the way to a key, [`KeyPath`]; whoever read it from a text says
//! where that stands ([`Source`]).

pub mod arrays;
pub mod body;
pub mod case;
pub mod cells;
mod constraint;
pub mod contact;
pub mod curve;
pub mod error;
pub mod fit;
mod heat;
pub mod history;
pub mod key_path;
pub mod list;
pub mod material;
pub mod nothing;
mod nurbs;
pub mod paths;
pub mod problem_part;
pub mod rigid;
pub mod shape;
mod solution;
pub mod source;
mod support;
mod tree;
pub mod units;
pub mod value;
mod walk;

pub use arrays::{Array, CellArrays, Grid2, MeshArrays, TriangleArrays};
pub use body::*;
pub use cells::*;
pub use constraint::{ConstraintTerm, LinearConstraint};
pub use contact::*;
pub use curve::*;
pub use error::CaseError;
pub use fit::{Fit, FitUnknown, Noise};
pub use heat::{ContactHeat, Convection, Heat, HeatEquation, Thermal};
pub use history::{ArcLength, AreaControl, Control, Dynamics, RayleighDamping, Step};
pub use key_path::{KeyPath, Part};
pub use list::{List, Named};
pub use material::*;
pub use nothing::Nothing;
pub use nurbs::{NurbsMesh, NurbsPatch};
pub use paths::*;
pub use problem_part::ProblemPart;
pub use rigid::*;
pub use shape::*;
pub use signorini_expression::suggestion;
pub use solution::{LinearMethod, Solution};
pub use source::Source;
pub use support::{CylindricalAxes, Support, SupportAxes, Tied};
pub use value::{Components, Value};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// A problem.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Problem {
    /// Free text, copied to the results.
    pub title: Option<String>,
    /// Base units. If left out, numbers are in any consistent units.
    pub units: Option<UnitSystem>,
    /// Kind of analysis; `equilibrium` if left out.
    pub analysis: Option<Analysis>,
    /// Dimension and meaning of the coordinates; `3d` if left out.
    #[serde(default)]
    pub space: Space,
    /// Named numbers for use in expressions.
    #[serde(default)]
    pub constants: Named<Value>,
    /// Named functions of one argument, `t`, for use in expressions.
    #[serde(default)]
    pub functions: Named<TimeFunction>,
    /// Bodies, by names of your own.
    pub bodies: Named<Body>,
    /// Supports and prescribed displacements, by names of your own.
    #[serde(default)]
    pub supports: Named<Support>,
    /// Loads, by names of your own.
    #[serde(default)]
    pub loads: Named<Load>,
    /// Contacts between bodies, by names of your own.
    #[serde(default)]
    pub contacts: Named<Contact>,
    /// Equations between displacements of single nodes of solids, by names of your own.
    #[serde(default)]
    pub constraints: Named<LinearConstraint>,
    /// Acceleration of gravity along each axis, which acts on every body with a mass, also at rest; expressions of t are possible.
    /// None if left out.
    pub gravity: Option<List<Value>>,
    /// How temperatures are found. Steady conduction if left out.
    pub heat: Option<Heat>,
    /// Load steps. Without steps one state is computed at t = 0.
    #[serde(default)]
    pub steps: List<Step>,
    /// Treatment of unstable states of a system; `follow` if left out.
    pub stability: Option<UnstableStates>,
    /// How the equations are solved.
    pub method: Option<Solution>,
    /// What is written to disk.
    #[serde(default)]
    pub output: Output,
    /// Limits of the computation.
    #[serde(default)]
    pub limits: Limits,
    /// With `analysis = "wrapping"`: number of times in [0, 1]; 2 if left out.
    pub frames: Option<i64>,
    /// View direction of pictures of paths.
    pub view: Option<View>,
    /// With `analysis = "wrapping"`: shortest paths, by names of your own.
    #[serde(default)]
    pub paths: Named<ShortestPath>,
    /// With `analysis = "winding"`: paths of yarns, by names of your own.
    #[serde(default)]
    pub winding: Named<Winding>,
    /// With `analysis = "euler_eytelwein"`: ropes on given curves, by names of your own.
    #[serde(default)]
    pub ropes: Named<RopeOnSurface>,
    /// Parameters that `signorini fit` computes from measurements.
    pub fit: Option<Fit>,
    /// Where it was read from.
    #[serde(skip)]
    pub source: Source,
}

impl Problem {
    /// Whether there is nothing but an equilibrium at t = 0.
    pub fn is_at_one_time(&self) -> bool {
        matches!(self.analysis, None | Some(Analysis::Equilibrium)) && self.steps.is_empty()
    }

    /// A problem without bodies.
    pub fn new(space: Space) -> Self {
        Self {
            title: None,
            units: None,
            analysis: None,
            space,
            constants: Named::default(),
            functions: Named::default(),
            bodies: Named::default(),
            supports: Named::default(),
            loads: Named::default(),
            contacts: Named::default(),
            constraints: Named::default(),
            gravity: None,
            heat: None,
            steps: List::default(),
            stability: None,
            method: None,
            output: Output::default(),
            limits: Limits::default(),
            frames: None,
            view: None,
            paths: Named::default(),
            winding: Named::default(),
            ropes: Named::default(),
            fit: None,
            source: Source::default(),
        }
    }

    /// Its title, or the name of its file.
    pub fn name(&self) -> &str {
        match &self.title {
            Some(title) => title,
            None if self.source.name.is_empty() => "problem",
            None => &self.source.name,
        }
    }

    /// The way to a part of this problem; that of the whole for what is no part of it.
    pub fn key<T: ProblemPart>(&self, part: &T) -> KeyPath {
        let found = problem_part::find(self, part);
        debug_assert!(found.is_some(), "a {} is no part of the problem", std::any::type_name::<T>());
        found.unwrap_or_default()
    }

    /// What is wrong at a part of this problem, or at a key of it.
    pub fn error(&self, at: &impl Location, message: impl Into<String>) -> CaseError {
        let key = at.key_in(self);
        let place = self.source.place(&key, None);
        CaseError { key: Some(Box::new(key)), place, ..CaseError::new(message) }
    }

    /// What is wrong in some bytes of a value as text.
    pub fn error_within(
        &self,
        value: &Value,
        text: &str,
        bytes: Range<usize>,
        message: impl Into<String>,
    ) -> CaseError {
        let key = self.key(value);
        let place = self.source.place(&key, Some((text, bytes)));
        CaseError { key: Some(Box::new(key)), place, ..CaseError::new(message) }
    }
}

/// Where something is in a problem: a part of it, or the key of one.
pub trait Location {
    fn key_in(&self, problem: &Problem) -> KeyPath;
}

impl<T: ProblemPart> Location for T {
    fn key_in(&self, problem: &Problem) -> KeyPath {
        problem.key(self)
    }
}

impl Location for KeyPath {
    fn key_in(&self, _: &Problem) -> KeyPath {
        self.clone()
    }
}

/// A named system of units, or the names of the base units.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub enum UnitSystem {
    System(String),
    Base(BaseUnits),
}

#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BaseUnits {
    /// Unit of length, such as "mm".
    pub length: String,
    /// Unit of force, such as "N".
    pub force: String,
    /// Unit of time; "s" if left out.
    #[serde(default = "second")]
    pub time: String,
    /// Scale of temperature, "K" or "degC"; "K" if left out.
    #[serde(default = "kelvin")]
    pub temperature: String,
}

fn second() -> String {
    "s".into()
}

fn kelvin() -> String {
    "K".into()
}

impl JsonSchema for UnitSystem {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Units".into()
    }
    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let base = generator.subschema_for::<BaseUnits>();
        schemars::json_schema!({ "anyOf": [{ "type": "string", "examples": ["mm-N-MPa"] }, base] })
    }
}

impl<'de> Deserialize<'de> for UnitSystem {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> serde::de::Visitor<'de> for Reader {
            type Value = UnitSystem;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a system such as \"mm-N-MPa\", or { length = \"mm\", force = \"N\", time = \"s\" }")
            }
            fn visit_str<E>(self, v: &str) -> Result<UnitSystem, E> {
                Ok(UnitSystem::System(v.to_string()))
            }
            fn visit_map<A: serde::de::MapAccess<'de>>(self, map: A) -> Result<UnitSystem, A::Error> {
                BaseUnits::deserialize(serde::de::value::MapAccessDeserializer::new(map)).map(UnitSystem::Base)
            }
        }
        deserializer.deserialize_any(Reader)
    }
}

#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Space {
    /// A string: one coordinate, x.
    Line,
    /// An axisymmetric membrane: x is the radius.
    Axisymmetric,
    /// A membrane seen from above.
    Plane,
    /// Plane strain.
    PlaneStrain,
    /// Plane stress.
    PlaneStress,
    /// Three-dimensional space.
    #[default]
    #[serde(rename = "3d")]
    ThreeD,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum UnstableStates {
    /// Unstable states are left along the eigenvector, and a stable state at the same loads is computed.
    Follow,
    /// Unstable states are retained and reported.
    Tell,
}

/// A function of one argument: a table, or an expression in `t`.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TimeFunction {
    /// Points of a piecewise linear function.
    pub table: Option<Table>,
    /// An expression in t.
    pub expression: Option<Value>,
}

/// A piecewise linear function.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Table {
    /// Arguments in ascending order.
    pub t: List<f64>,
    /// Function values, one for each argument.
    pub value: List<f64>,
}

/// A load.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Load {
    /// Body or group of a body: `BODY` or `BODY:GROUP`.
    pub on: String,
    /// For a membrane: force per area along +z.
    pub normal: Option<Value>,
    /// Force per area along each axis.
    pub traction: Option<List<Value>>,
    /// Force per area against the outward normal.
    pub pressure: Option<Value>,
    /// Resultant force along each axis, distributed uniformly.
    pub force: Option<List<Value>>,
    /// Force along each axis on each node of the group, such as concentrated forces of an input deck.
    pub nodal_force: Option<List<Value>>,
    /// Force per volume along each axis; per length for a rope or beam.
    pub body_force: Option<List<Value>>,
    /// Resultant moment about each axis, on a beam, a free rigid body, or a solid of a system.
    pub moment: Option<List<Value>>,
    /// Tensile force along the end of a rope or beam.
    pub tension: Option<Value>,
    /// Heat per time and area into a solid.
    pub heat_flux: Option<Value>,
    /// Heat per time and volume into a solid.
    pub heat_source: Option<Value>,
    /// Exchange of heat of a solid with a fluid.
    pub convection: Option<Convection>,
}

/// Limits of the computation. At the first limit the run stops after the current iteration and stores its results.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// Wall time in seconds.
    pub max_time: Option<f64>,
    /// Number of iterations over all increments.
    pub max_iterations: Option<i64>,
}

/// What is written to disk.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Number of increments between stored fields.
    pub every: Option<i64>,
    /// Whether pictures are drawn; true if left out.
    pub pictures: Option<bool>,
    /// Points whose history is recorded.
    #[serde(default)]
    pub probes: Named<List<Value>>,
    /// Point about which moments of supports, loads and contacts are reported, lengths; the origin if left out.
    pub moments_about: Option<List<Value>>,
}

/// Inner parts for the tests in `tests`; no part of the interface.
#[doc(hidden)]
pub mod testing {
    use std::ops::Range;

    /// The last word of the key whose value stands at a place.
    pub fn key_before(text: &str, span: Option<Range<usize>>) -> Option<&str> {
        crate::case::toml_error::key_before(text, span)
    }
}
