//! Shapes as queries write them.

use std::f64::consts::TAU;

use std::path::Path;
use std::sync::Arc;

use crate::expression::{Names, Scope, parse};
use crate::mesh_file;
use serde_json::{Map, Value};
use signorini_geometry::grid_spline::GridSpline;
use signorini_geometry::implicit::{Function, ImplicitBody, Offset};
use signorini_geometry::implicit_surface::ImplicitSurface;
use signorini_geometry::jet::{Jet, Real};
use signorini_geometry::mesh::TriangleMesh;
use signorini_geometry::shape::{Axes, Curve, Shape, ShapeError, Surface};
use signorini_geometry::{Aabb, Point};

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

/// The types of shapes, in the order of the manual.
pub const TYPES: [&str; 30] = [
    "point",
    "segment",
    "polyline",
    "circle",
    "ellipse",
    "parabola",
    "helix",
    "bezier",
    "nurbs",
    "lagrange",
    "hermite",
    "plane",
    "cylinder",
    "cone",
    "sphere",
    "ellipsoid",
    "torus",
    "graph",
    "revolution",
    "bezier_surface",
    "nurbs_surface",
    "height_field",
    "quad4",
    "quad9",
    "lagrange_quad",
    "tri3",
    "tri6",
    "lagrange_triangle",
    "triangle_mesh",
    "implicit",
];

/// The entries of an object, each taken once.
pub struct Fields<'a> {
    path: String,
    object: &'a Map<String, Value>,
    taken: Vec<&'a str>,
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

    fn number_of(&self, key: &str, value: &Value) -> Result<f64, FieldError> {
        match value.as_f64() {
            Some(number) if number.is_finite() => Ok(number),
            _ => Err(self.error(key, format!("{} instead of a finite number", kind(value)))),
        }
    }

    pub fn number(&mut self, key: &'a str) -> Result<f64, FieldError> {
        let value = self.required(key)?;
        self.number_of(key, value)
    }

    fn count(&mut self, key: &'a str) -> Result<usize, FieldError> {
        let value = self.required(key)?;
        value
            .as_u64()
            .and_then(|n| usize::try_from(n).ok())
            .ok_or_else(|| self.error(key, format!("{value} instead of a whole number")))
    }

    fn array_of<'v>(&self, key: &str, value: &'v Value) -> Result<&'v Vec<Value>, FieldError> {
        value.as_array().ok_or_else(|| self.error(key, format!("{} instead of an array", kind(value))))
    }

    fn numbers_of(&self, key: &str, value: &Value) -> Result<Vec<f64>, FieldError> {
        let array = self.array_of(key, value)?;
        array.iter().enumerate().map(|(k, v)| self.number_of(&format!("{key}[{k}]"), v)).collect()
    }

    fn numbers(&mut self, key: &'a str) -> Result<Vec<f64>, FieldError> {
        let value = self.required(key)?;
        self.numbers_of(key, value)
    }

    fn fixed<const N: usize>(&self, key: &str, numbers: Vec<f64>) -> Result<[f64; N], FieldError> {
        let found = numbers.len();
        numbers.try_into().map_err(|_| self.error(key, format!("{found} numbers instead of {N}")))
    }

    fn point_of(&self, key: &str, value: &Value) -> Result<Point<3>, FieldError> {
        Ok(Point::<3>::from(self.fixed::<3>(key, self.numbers_of(key, value)?)?))
    }

    fn point(&mut self, key: &'a str) -> Result<Point<3>, FieldError> {
        let value = self.required(key)?;
        self.point_of(key, value)
    }

    fn points_of(&self, key: &str, value: &Value) -> Result<Vec<Point<3>>, FieldError> {
        let array = self.array_of(key, value)?;
        array.iter().enumerate().map(|(k, v)| self.point_of(&format!("{key}[{k}]"), v)).collect()
    }

    fn points(&mut self, key: &'a str) -> Result<Vec<Point<3>>, FieldError> {
        let value = self.required(key)?;
        self.points_of(key, value)
    }

    fn exactly<const N: usize>(&mut self, key: &'a str) -> Result<[Point<3>; N], FieldError> {
        let points = self.points(key)?;
        let found = points.len();
        points.try_into().map_err(|_| self.error(key, format!("{found} points instead of {N}")))
    }

    fn net(&mut self, key: &'a str) -> Result<Vec<Vec<Point<3>>>, FieldError> {
        let value = self.required(key)?;
        let array = self.array_of(key, value)?;
        array.iter().enumerate().map(|(k, v)| self.points_of(&format!("{key}[{k}]"), v)).collect()
    }

    fn table(&self, key: &str, value: &Value) -> Result<Vec<Vec<f64>>, FieldError> {
        let array = self.array_of(key, value)?;
        array.iter().enumerate().map(|(k, v)| self.numbers_of(&format!("{key}[{k}]"), v)).collect()
    }

    fn range(&mut self) -> Result<[f64; 2], FieldError> {
        let numbers = self.numbers("range")?;
        self.fixed("range", numbers)
    }

    fn ranges(&mut self) -> Result<[[f64; 2]; 2], FieldError> {
        let value = self.required("range")?;
        let rows = self.table("range", value)?;
        let found = rows.len();
        let [u, v]: [Vec<f64>; 2] =
            rows.try_into().map_err(|_| self.error("range", format!("{found} intervals instead of 2")))?;
        Ok([self.fixed("range[0]", u)?, self.fixed("range[1]", v)?])
    }

    fn flag_of(&self, key: &str, value: &Value) -> Result<bool, FieldError> {
        value.as_bool().ok_or_else(|| self.error(key, format!("{} instead of true or false", kind(value))))
    }

    fn closed(&mut self) -> Result<bool, FieldError> {
        self.optional("closed").map_or(Ok(false), |v| self.flag_of("closed", v))
    }

    fn closed_both(&mut self) -> Result<[bool; 2], FieldError> {
        let Some(value) = self.optional("closed") else { return Ok([false; 2]) };
        let array = self.array_of("closed", value)?;
        match array.as_slice() {
            [u, v] => Ok([self.flag_of("closed[0]", u)?, self.flag_of("closed[1]", v)?]),
            _ => Err(self.error("closed", format!("{} entries instead of 2", array.len()))),
        }
    }

    /// `o`, `ex`, `ey` and, where given, `ez`.
    fn axes(&mut self) -> Result<Axes, FieldError> {
        let (o, ex, ey) = (self.point("o")?, self.point("ex")?, self.point("ey")?);
        let axes = match self.optional("ez") {
            Some(value) => Axes::with_third(o, ex, ey, self.point_of("ez", value)?),
            None => Axes::new(o, ex, ey),
        };
        axes.map_err(|e| self.shape_error(&e))
    }

    fn shape_error(&self, error: &ShapeError) -> FieldError {
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

/// Reads one partner of a query; files are looked for in `folder`.
///
/// # Errors
/// An unknown type or key, a missing or malformed field, or data that make no shape.
pub fn shape(path: &str, value: &Value, folder: &Path) -> Result<Shape, FieldError> {
    let mut f = Fields::new(path, value)?;
    let name = f.text("type")?;
    let shape = read(name, &mut f, folder)?;
    f.finish(&[])?;
    Ok(shape)
}

fn read(name: &str, f: &mut Fields<'_>, folder: &Path) -> Result<Shape, FieldError> {
    let optional_numbers = |f: &mut Fields<'_>| -> Result<Option<Vec<f64>>, FieldError> {
        f.optional("weights").filter(|v| !v.is_null()).map(|v| f.numbers_of("weights", v)).transpose()
    };
    let optional_table = |f: &mut Fields<'_>| -> Result<Option<Vec<Vec<f64>>>, FieldError> {
        f.optional("weights").filter(|v| !v.is_null()).map(|v| f.table("weights", v)).transpose()
    };
    let curve = |f: &Fields<'_>, c: Result<Curve, ShapeError>| c.map(Shape::from).map_err(|e| f.shape_error(&e));
    let surface = |f: &Fields<'_>, s: Result<Surface, ShapeError>| s.map(Shape::from).map_err(|e| f.shape_error(&e));
    match name {
        "point" => Ok(Shape::Point(f.point("p")?)),
        "segment" => {
            let (p0, p1) = (f.point("p0")?, f.point("p1")?);
            curve(f, Curve::segment(p0, p1))
        }
        "polyline" => {
            let (points, closed) = (f.points("points")?, f.closed()?);
            curve(f, Curve::polyline(&points, closed))
        }
        "circle" => {
            let (axes, r, range, closed) = (f.axes()?, f.number("r")?, f.range()?, f.closed()?);
            curve(f, Curve::circle(axes, r, range, closed))
        }
        "ellipse" => {
            let (axes, a, b) = (f.axes()?, f.number("a")?, f.number("b")?);
            let (range, closed) = (f.range()?, f.closed()?);
            curve(f, Curve::ellipse(axes, a, b, range, closed))
        }
        "parabola" => {
            let (axes, k, range) = (f.axes()?, f.number("k")?, f.range()?);
            never_closed(f)?;
            curve(f, Curve::parabola(axes, k, range))
        }
        "helix" => {
            let (axes, r, c, range) = (f.axes()?, f.number("r")?, f.number("c")?, f.range()?);
            never_closed(f)?;
            curve(f, Curve::helix(axes, r, c, range))
        }
        "bezier" => {
            let (points, weights) = (f.points("control_points")?, optional_numbers(f)?);
            curve(f, Curve::bezier(&points, weights.as_deref()))
        }
        "nurbs" => {
            let (degree, knots, points) = (f.count("degree")?, f.numbers("knots")?, f.points("control_points")?);
            let (weights, closed) = (optional_numbers(f)?, f.closed()?);
            curve(f, Curve::nurbs(degree, &knots, &points, weights.as_deref(), closed))
        }
        "lagrange" => {
            let nodes = f.points("nodes")?;
            curve(f, Curve::lagrange(&nodes))
        }
        "hermite" => {
            let (points, tangents) = (f.points("points")?, f.points("tangents")?);
            curve(f, Curve::hermite(&points, &tangents))
        }
        "plane" => {
            let (axes, range) = (f.axes()?, f.ranges()?);
            never_closed(f)?;
            surface(f, Surface::plane(axes, range))
        }
        "cylinder" => {
            let (axes, r, range, closed) = (f.axes()?, f.number("r")?, f.ranges()?, first_closed(f)?);
            surface(f, Surface::cylinder(axes, r, range, closed))
        }
        "cone" => {
            let (axes, sin, cos) = (f.axes()?, f.number("sin")?, f.number("cos")?);
            let (range, closed) = (f.ranges()?, first_closed(f)?);
            surface(f, Surface::cone(axes, sin, cos, range, closed))
        }
        "sphere" => {
            let (axes, r, range, closed) = (f.axes()?, f.number("r")?, f.ranges()?, first_closed(f)?);
            surface(f, Surface::sphere(axes, r, range, closed))
        }
        "ellipsoid" => {
            let axes = f.axes()?;
            let abc = f.numbers("abc")?;
            let (abc, range, closed) = (f.fixed("abc", abc)?, f.ranges()?, first_closed(f)?);
            surface(f, Surface::ellipsoid(axes, abc, range, closed))
        }
        "torus" => {
            let (axes, major, minor) = (f.axes()?, f.number("R")?, f.number("r")?);
            let (range, closed) = (f.ranges()?, f.closed_both()?);
            surface(f, Surface::torus(axes, major, minor, range, closed))
        }
        "graph" => {
            let axes = f.axes()?;
            let abc = f.numbers("abc")?;
            let (abc, range) = (f.fixed("abc", abc)?, f.ranges()?);
            never_closed(f)?;
            surface(f, Surface::graph(axes, abc, range))
        }
        "revolution" => {
            let profile = f.required("profile")?;
            let inner = f.error("profile", "").path;
            let Shape::Curve(profile) = shape(&inner, profile, folder)? else {
                return Err(f.error("profile", "not a curve"));
            };
            let (o, axis) = (f.point("o")?, f.point("axis")?);
            let range = match f.optional("range") {
                Some(value) => {
                    let numbers = f.numbers_of("range", value)?;
                    f.fixed("range", numbers)?
                }
                None => [0.0, TAU],
            };
            let closed = f.optional("closed").map_or(Ok(range[1] - range[0] == TAU), |v| f.flag_of("closed", v))?;
            surface(f, Surface::revolution(&profile, o, axis, range, closed))
        }
        "bezier_surface" => {
            let (points, weights) = (f.net("control_points")?, optional_table(f)?);
            surface(f, Surface::bezier(&points, weights.as_deref()))
        }
        "nurbs_surface" => {
            let degree = [f.count("degree_u")?, f.count("degree_v")?];
            let (u, v) = (f.numbers("knots_u")?, f.numbers("knots_v")?);
            let (points, weights, closed) = (f.net("control_points")?, optional_table(f)?, f.closed_both()?);
            surface(f, Surface::nurbs(degree, [&u, &v], &points, weights.as_deref(), closed))
        }
        "height_field" => {
            let axes = f.axes()?;
            let spacing = f.numbers("spacing")?;
            let spacing: [f64; 2] = f.fixed("spacing", spacing)?;
            let heights = f.required("heights")?;
            let heights = f.table("heights", heights)?;
            let degree = match f.optional("degree") {
                Some(_) => f.count("degree")?,
                None => 3,
            };
            surface(f, Surface::height_field(axes, spacing, &heights, degree))
        }
        "quad4" => {
            let nodes = f.exactly::<4>("nodes")?;
            surface(f, Surface::quad4(&nodes))
        }
        "quad9" => {
            let nodes = f.exactly::<9>("nodes")?;
            surface(f, Surface::quad9(&nodes))
        }
        "lagrange_quad" => {
            let nodes = f.net("nodes")?;
            surface(f, Surface::lagrange_quad(&nodes))
        }
        "tri3" => {
            let nodes = f.exactly::<3>("nodes")?;
            surface(f, Surface::tri3(&nodes))
        }
        "tri6" => {
            let nodes = f.exactly::<6>("nodes")?;
            surface(f, Surface::tri6(&nodes))
        }
        "lagrange_triangle" => {
            let nodes = f.points("nodes")?;
            surface(f, Surface::lagrange_triangle(&nodes))
        }
        "triangle_mesh" => mesh(f, folder).map(Shape::from),
        "implicit" => {
            let mut body = f.required("body")?;
            let inner = f.error("body", "").path;
            // A single function may stand for a body.
            let wrapped;
            if let Value::String(_) = body {
                wrapped = serde_json::json!({ "value": body });
                body = &wrapped;
            }
            let bounds = f.required("box")?;
            let corners = f.points_of("box", bounds)?;
            let [min, max] = corners.as_slice() else { return Err(f.error("box", "two corners wanted")) };
            let bounds = Aabb::new(*min, *max);
            let cells = f.optional("cells").map_or(Ok(40), |_| f.count("cells"))?;
            let body = implicit(&inner, body, &bounds, cells, 0)?;
            ImplicitSurface::new(body, bounds, cells).map(Shape::from).map_err(|e| f.shape_error(&e))
        }
        other => Err(f.error("type", format!("`{other}` is no shape; valid are {}", TYPES.join(", ")))),
    }
}

/// A mesh in the query itself or in a file.
fn mesh(f: &mut Fields<'_>, folder: &Path) -> Result<TriangleMesh, FieldError> {
    if f.object.contains_key("file") {
        let name = f.text("file")?;
        return mesh_file::read(&folder.join(name)).map_err(|e| f.error("file", e.to_string()));
    }
    let vertices = f.points("vertices")?;
    let value = f.required("triangles")?;
    let mut triangles = Vec::new();
    for (k, row) in f.array_of("triangles", value)?.iter().enumerate() {
        let numbers: Option<Vec<u32>> =
            row.as_array().and_then(|r| r.iter().map(|v| v.as_u64().and_then(|n| u32::try_from(n).ok())).collect());
        let triangle = numbers.and_then(|n| <[u32; 3]>::try_from(n).ok());
        triangles.push(
            triangle.ok_or_else(|| f.error(&format!("triangles[{k}]"), format!("{row}, not three vertex numbers")))?,
        );
    }
    TriangleMesh::new(vertices, &triangles).map_err(|e| f.shape_error(&e))
}

/// How deep bodies may be nested.
const DEEPEST: usize = 16;

/// A body: `{"value": EXPRESSION}`, `{"union": [...]}`, `{"intersection": [...]}`, `{"difference": [A, B]}`,
/// `{"offset": BODY, "distance": d}` or `{"grid": {...}}`.
fn implicit(
    path: &str,
    value: &Value,
    bounds: &Aabb<3>,
    cells: usize,
    depth: usize,
) -> Result<ImplicitBody<3>, FieldError> {
    let mut f = Fields::new(path, value)?;
    if depth > DEEPEST {
        return Err(FieldError { path: path.into(), message: format!("nested more than {DEEPEST} deep") });
    }
    const KINDS: [&str; 5] = ["value", "union", "intersection", "difference", "offset"];
    let kind = KINDS.into_iter().chain(["grid"]).find(|k| f.object.contains_key(*k));
    let parts = |f: &mut Fields<'_>, key: &'static str| -> Result<Vec<ImplicitBody<3>>, FieldError> {
        let entry = f.object.get(key).ok_or_else(|| f.error(key, "missing"))?;
        f.taken.push(key);
        let array = f.array_of(key, entry)?;
        if array.is_empty() {
            return Err(f.error(key, "empty"));
        }
        array
            .iter()
            .enumerate()
            .map(|(k, v)| implicit(&f.error(&format!("{key}[{k}]"), "").path, v, bounds, cells, depth + 1))
            .collect()
    };
    let body = match kind {
        Some("value") => {
            let text = f.text("value")?;
            let names = Names { variables: vec!["x", "y", "z"], ..Default::default() };
            let expression = parse(text, &names).map_err(|e| f.error("value", format!("`{text}`: {}", e.message)))?;
            let level = move |x: &Point<3>| {
                let position = [0, 1, 2].map(|k| Jet::<3>::variable(x[k], k));
                expression.evaluate(&Scope { position, time: Jet::<3>::constant(0.0) })
            };
            Function(level).into()
        }
        Some("union") => ImplicitBody::Union(parts(&mut f, "union")?),
        Some("intersection") => ImplicitBody::Intersection(parts(&mut f, "intersection")?),
        Some("difference") => {
            let two = parts(&mut f, "difference")?;
            let [a, b] = <[ImplicitBody<3>; 2]>::try_from(two)
                .map_err(|t| f.error("difference", format!("{} bodies instead of 2", t.len())))?;
            a.without(b)
        }
        Some("offset") => {
            let inner = f.required("offset")?;
            let distance = f.number("distance")?;
            let body = implicit(&f.error("offset", "").path, inner, bounds, cells, depth + 1)?;
            let surface = ImplicitSurface::new(body, *bounds, cells).map_err(|e| f.shape_error(&e))?;
            Offset { shape: Arc::new(surface), distance }.into()
        }
        Some("grid") => {
            let grid = f.required("grid")?;
            let mut g = Fields::new(&f.error("grid", "").path, grid)?;
            let (origin, spacing, count) = (g.point("origin")?, g.numbers("spacing")?, g.numbers("count")?);
            let spacing: [f64; 3] = g.fixed("spacing", spacing)?;
            let count: [f64; 3] = g.fixed("count", count)?;
            if count.iter().any(|n| n.fract() != 0.0 || !(4.0..=2000.0).contains(n)) {
                return Err(g.error("count", format!("{count:?}, not whole numbers from 4 to 2000")));
            }
            let values = g.numbers("values")?;
            let field =
                GridSpline::new(origin, spacing, count.map(|n| n as usize), values).map_err(|e| g.shape_error(&e))?;
            g.finish(&[])?;
            field.into()
        }
        _ => {
            return Err(FieldError { path: path.into(), message: format!("one of {}, grid wanted", KINDS.join(", ")) });
        }
    };
    f.finish(&[])?;
    Ok(body)
}

/// Accepts `closed` only where it says no.
fn never_closed(f: &mut Fields<'_>) -> Result<(), FieldError> {
    let says_so = match f.optional("closed") {
        Some(Value::Array(entries)) => entries.iter().any(|e| e != &Value::Bool(false)),
        Some(value) => value != &Value::Bool(false),
        None => false,
    };
    if says_so { Err(f.error("closed", "this shape is never closed")) } else { Ok(()) }
}

fn first_closed(f: &mut Fields<'_>) -> Result<bool, FieldError> {
    match f.closed_both()? {
        [_, true] => Err(f.error("closed[1]", "only the angle can be closed")),
        [u, false] => Ok(u),
    }
}
