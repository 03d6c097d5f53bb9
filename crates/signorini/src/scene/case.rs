//! What a scene states, and its closest pairs at a time.

use serde::Deserialize;
use signorini_geometry::closest::{ClosestPair, Query, closest};
use signorini_geometry::frame::SurfaceFrame;
use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::shape::Shape;
use signorini_geometry::{Point, Vector};
use std::path::Path;

use crate::expression::{Expression, Names, Scope, parse};
use crate::problem::CaseError;
use crate::queries::geometry;

/// The kinds of contact pairs, as dimensions of the partners, the lowest first: of pairs at the same distance the one
/// with the lowest features is the contact.
pub const KINDS: [([usize; 2], &str); 6] = [
    ([0, 0], "point-point"),
    ([0, 1], "point-curve"),
    ([1, 1], "curve-curve"),
    ([0, 2], "point-surface"),
    ([1, 2], "curve-surface"),
    ([2, 2], "surface-surface"),
];

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Statement {
    title: String,
    #[serde(rename = "analysis")]
    _analysis: String,
    frames: usize,
    #[serde(default = "unit_time")]
    time: [f64; 2],
    camera: Camera,
    bodies: toml::Table,
}

fn unit_time() -> [f64; 2] {
    [0.0, 1.0]
}

/// From where the pictures are drawn.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Camera {
    pub from: [f64; 3],
    pub up: [f64; 3],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BodyStatement {
    #[serde(default)]
    motion: Option<Motion>,
    parts: Vec<toml::Table>,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
struct Motion {
    displacement: Option<[String; 3]>,
    rotation: Option<[String; 3]>,
    #[serde(default)]
    centre: [f64; 3],
}

/// A body of a scene.
pub struct SceneBody {
    pub name: String,
    pub parts: Vec<(String, Shape)>,
    displacement: [Expression; 3],
    rotation: [Expression; 3],
    centre: Point<3>,
}

/// A scene that was read.
pub struct Scene {
    pub title: String,
    pub times: Vec<f64>,
    pub camera: Camera,
    pub bodies: [SceneBody; 2],
    pub(super) text: String,
}

/// The closest pair of one kind at one frame.
#[derive(Clone, Debug)]
pub struct ScenePair {
    pub kind: usize,
    /// Numbers of the parts, the first body's first.
    pub parts: [usize; 2],
    pub pair: ClosestPair,
    pub unique: bool,
    /// Unit normal from the second body to the first, and a tangent of the features where there is one.
    pub normal: Option<Vector<3>>,
    pub tangent: Option<Vector<3>>,
}

/// Everything at one time.
pub struct Frame {
    pub time: f64,
    pub shapes: [Vec<Shape>; 2],
    pub pairs: Vec<ScenePair>,
    /// Which of the pairs is the contact pair.
    pub governing: usize,
}

/// Whether a file is a scene rather than a case.
pub fn is_scene(text: &str) -> bool {
    toml::from_str::<toml::Table>(text)
        .is_ok_and(|t| t.get("analysis").and_then(|a| a.as_str()) == Some("closest_pairs"))
}

impl Scene {
    /// Reads a scene; files that its parts name are looked for in `folder`.
    ///
    /// # Errors
    /// What is wrong with it, and what would be valid.
    pub fn parse(name: &str, text: &str, folder: &Path) -> Result<Self, CaseError> {
        let statement: Statement =
            toml::from_str(text).map_err(|e| crate::case::toml_error::from_toml(name, text, &e))?;
        if !(2..=100_000).contains(&statement.frames) {
            return Err(CaseError::new(format!("{name}: `frames` is {}, valid are 2 to 100000", statement.frames)));
        }
        let [start, end] = statement.time;
        if !(start.is_finite() && end.is_finite() && start < end) {
            return Err(CaseError::new(format!(
                "{name}: `time` is [{start}, {end}], two increasing numbers are wanted"
            )));
        }
        let (from, up) = (Vector::<3>::from(statement.camera.from), Vector::<3>::from(statement.camera.up));
        if from.cross(&up).norm().is_nan() || from.cross(&up).norm() <= 1e-6 * from.norm() * up.norm() {
            return Err(CaseError::new(format!("{name}: `camera.from` and `camera.up` have the same direction")));
        }
        let mut bodies = Vec::new();
        for (body, table) in statement.bodies {
            bodies.push(read_body(name, &body, table, folder)?);
        }
        let found = bodies.len();
        let bodies = <[SceneBody; 2]>::try_from(bodies)
            .map_err(|_| CaseError::new(format!("{name}: {found} bodies, a scene has two")))?;
        let last = (statement.frames - 1) as f64;
        let times = (0..statement.frames).map(|k| start + (end - start) * k as f64 / last).collect();
        Ok(Scene { title: statement.title, times, camera: statement.camera, bodies, text: text.to_string() })
    }

    /// The bodies and their closest pairs at one time.
    ///
    /// # Errors
    /// A motion that is not a number.
    pub fn at(&self, time: f64) -> Result<Frame, CaseError> {
        let mut shapes: [Vec<Shape>; 2] = [Vec::new(), Vec::new()];
        for (moved, body) in shapes.iter_mut().zip(&self.bodies) {
            let motion = body.motion(time)?;
            for (part, shape) in &body.parts {
                moved.push(motion.shape(shape).ok_or_else(|| {
                    CaseError::new(format!("`{}.{part}`: an implicit surface cannot be moved", body.name))
                })?);
            }
        }
        let mut pairs: Vec<ScenePair> = Vec::new();
        for (kind, (dimensions, _)) in KINDS.iter().enumerate() {
            let mut best: Option<ScenePair> = None;
            for (i, a) in shapes[0].iter().enumerate() {
                for (j, b) in shapes[1].iter().enumerate() {
                    let found = [a.dimension(), b.dimension()];
                    if found != *dimensions && [found[1], found[0]] != *dimensions {
                        continue;
                    }
                    let projection = closest(a, b, &Query::default());
                    if best.as_ref().is_none_or(|p| projection.distance() < p.pair.distance) {
                        let pair = projection.closest;
                        let unique = projection.uniqueness.is_unique();
                        let tangent = tangent(a, pair.a.parameters()).or_else(|| tangent(b, pair.b.parameters()));
                        let normal = pair.direction().or_else(|| normal(b, pair.b.parameters()));
                        best = Some(ScenePair { kind, parts: [i, j], pair, unique, normal, tangent });
                    }
                }
            }
            pairs.extend(best);
        }
        let least = pairs.iter().map(|p| p.pair.distance).fold(f64::INFINITY, f64::min);
        let size = shapes.iter().flatten().map(Shape::size).fold(0.0, f64::max);
        let governing = pairs
            .iter()
            .position(|p| p.pair.distance <= least + 1e-12 * size)
            .ok_or_else(|| CaseError::new("the bodies have no parts to be paired"))?;
        Ok(Frame { time, shapes, pairs, governing })
    }
}

/// A unit tangent of a curve, or along the first parameter of a surface.
fn tangent(shape: &Shape, parameters: &[f64]) -> Option<Vector<3>> {
    match (shape, parameters) {
        (Shape::Curve(c), [t]) => c.jet(*t).d1.try_normalize(0.0),
        (Shape::Surface(s), [u, v]) => s.jet(*u, *v).u.try_normalize(0.0),
        _ => None,
    }
}

fn normal(shape: &Shape, parameters: &[f64]) -> Option<Vector<3>> {
    match (shape, parameters) {
        (Shape::Surface(s), [u, v]) => SurfaceFrame::new(&s.jet(*u, *v)).map(|f| f.normal),
        _ => None,
    }
}

impl SceneBody {
    fn motion(&self, time: f64) -> Result<RigidMotion, CaseError> {
        let evaluate = |key: &str, e: &[Expression; 3]| -> Result<Vector<3>, CaseError> {
            let scope = Scope { position: [0.0; 3], time };
            let values = Vector::<3>::from_fn(|k, _| e[k].evaluate(&scope));
            if values.iter().all(|v| v.is_finite()) {
                Ok(values)
            } else {
                Err(CaseError::new(format!("`bodies.{}.motion.{key}` is not finite at t = {time}", self.name)))
            }
        };
        Ok(RigidMotion::new(
            evaluate("rotation", &self.rotation)?,
            self.centre,
            evaluate("displacement", &self.displacement)?,
        ))
    }
}

fn read_body(file: &str, name: &str, table: toml::Value, folder: &Path) -> Result<SceneBody, CaseError> {
    let fail = |message: String| CaseError::new(format!("{file}: `bodies.{name}`: {message}"));
    let body: BodyStatement = table.try_into().map_err(|e: toml::de::Error| fail(e.message().to_string()))?;
    let motion = body.motion.unwrap_or_default();
    let expressions = |key: &str, texts: Option<[String; 3]>| -> Result<[Expression; 3], CaseError> {
        let names = Names { variables: vec!["t"], ..Names::default() };
        let zero = || Expression::number(0.0);
        let Some(texts) = texts else { return Ok([zero(), zero(), zero()]) };
        let mut out = [zero(), zero(), zero()];
        for (expression, text) in out.iter_mut().zip(&texts) {
            *expression = parse(text, &names).map_err(|e| fail(format!("`motion.{key}`: `{text}`: {}", e.message)))?;
        }
        Ok(out)
    };
    let displacement = expressions("displacement", motion.displacement)?;
    let rotation = expressions("rotation", motion.rotation)?;
    if !motion.centre.iter().all(|c| c.is_finite()) {
        return Err(fail("`motion.centre` is not finite".into()));
    }
    let mut parts = Vec::new();
    for (k, mut part) in body.parts.into_iter().enumerate() {
        let label = match part.remove("name") {
            Some(toml::Value::String(label)) => label,
            Some(_) => return Err(fail(format!("`parts[{k}].name` is not a string"))),
            None => format!("part {k}"),
        };
        let value = serde_json::to_value(&part).map_err(|e| fail(e.to_string()))?;
        let shape = geometry::shape(&format!("parts[{k}]"), &value, folder).map_err(|e| fail(e.to_string()))?;
        parts.push((label, shape));
    }
    if parts.is_empty() {
        return Err(fail("no parts".into()));
    }
    let centre = Point::<3>::from(motion.centre);
    Ok(SceneBody { name: name.to_string(), parts, displacement, rotation, centre })
}
