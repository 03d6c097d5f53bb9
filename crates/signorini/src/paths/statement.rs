//! The keys of paths.

use crate::problem::{Body, Named, TimeFunction, UnitSystem, Value};
use crate::scene::Camera;
use serde::Deserialize;
use signorini_geometry::{Aabb, Point, Vector};
use std::collections::BTreeMap;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Statement {
    pub title: Option<String>,
    pub analysis: Analysis,
    pub units: Option<UnitSystem>,
    /// Of times in [0, 1].
    pub frames: Option<usize>,
    pub camera: Option<Camera>,
    #[serde(default)]
    pub constants: Named<Value>,
    #[serde(default)]
    pub functions: Named<TimeFunction>,
    pub bodies: Named<Body>,
    #[serde(default)]
    pub paths: BTreeMap<String, Path>,
    #[serde(default)]
    pub winding: BTreeMap<String, Winding>,
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Analysis {
    Wrapping,
    Winding,
}

/// A number, or an expression.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
pub enum Number {
    Plain(f64),
    Text(String),
}

/// A point of space, its coordinates numbers or expressions of t; or a point of a body, with which it moves.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
pub enum Place {
    Space([Number; 3]),
    OnBody(OnBody),
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OnBody {
    pub body: String,
    /// Where it is before the body moves.
    pub point: [f64; 3],
}

/// A shortest path.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Path {
    pub from: Place,
    pub to: Place,
    /// Bodies in the order of the path; each is touched where it is in the way. Between via points a list per part.
    #[serde(default)]
    pub around: Around,
    /// Further turns about bodies.
    #[serde(default)]
    pub turns: BTreeMap<String, u32>,
    /// Points through which it runs, in order.
    #[serde(default)]
    pub via: Vec<Place>,
    pub friction: Option<Friction>,
    /// At the start, and at the end: expressions of t.
    pub tension: Option<Number>,
    pub end_tension: Option<Number>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
pub enum Around {
    /// The same bodies on every part.
    All(Vec<String>),
    /// Of each part between fixed points.
    Parts(Vec<Vec<String>>),
}

impl Default for Around {
    fn default() -> Self {
        Around::All(Vec::new())
    }
}

#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Friction {
    Coulomb(Coulomb),
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Coulomb {
    pub mu: Coefficients,
}

/// The same in all directions, or along the path and across it.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged)]
pub enum Coefficients {
    Isotropic(f64),
    Orthotropic([f64; 2]),
}

/// A path of a yarn.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Winding {
    pub on: String,
    pub start: WindingStart,
    /// `λ`, a number or an expression of s, angle, r and z; sought where it is left out and an opening is given.
    pub slippage: Option<Number>,
    /// The coefficient beyond which the yarn slips.
    pub friction: Option<f64>,
    pub polar_opening: Option<PolarOpening>,
    /// Width of the band.
    pub band: Option<f64>,
    pub pattern: Option<PatternKey>,
    /// About which the mandrel turns, through the origin of its shape; z if left out.
    pub axis: Option<[f64; 3]>,
    /// Of a path without an opening or a pattern, or the greatest one to a turn.
    pub length: Option<f64>,
    /// Distance of the points that are written.
    pub spacing: Option<f64>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WindingStart {
    /// Along the axis.
    pub z: f64,
    /// Around it, in radians.
    #[serde(default)]
    pub theta: f64,
    /// From the meridian, in radians or as "25 deg".
    pub angle: Number,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PolarOpening {
    /// Of the edge of the band, which is half its width inside of its middle.
    pub radius: f64,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PatternKey {
    /// A number, or "auto".
    pub circuits: Circuits,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
pub enum Circuits {
    Number(u32),
    Word(String),
}

impl Statement {
    /// The box of all fixed points that are numbers, and twice as much around them: where heights are known.
    pub fn around(&self) -> Aabb<3> {
        let fixed = |p: &Place| match p {
            Place::OnBody(on) => Some(Point::<3>::from(on.point)),
            Place::Space(x) => {
                let number = |n: &Number| if let Number::Plain(v) = n { Some(*v) } else { None };
                Some(Vector::<3>::new(number(&x[0])?, number(&x[1])?, number(&x[2])?))
            }
        };
        let points = self.paths.values().flat_map(|p| [&p.from, &p.to].into_iter().chain(&p.via).filter_map(fixed));
        let points: Vec<Point<3>> = points.chain([Point::<3>::repeat(-1.0), Point::<3>::repeat(1.0)]).collect();
        super::box_around(points.into_iter(), 1.0)
    }
}
