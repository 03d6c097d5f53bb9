//! Shapes as queries write them.

use super::fields::{FieldError, Fields};
use super::implicit::implicit;
use crate::mesh_file;
use serde_json::Value;
use signorini_geometry::Aabb;
use signorini_geometry::implicit_surface::ImplicitSurface;
use signorini_geometry::mesh::TriangleMesh;
use signorini_geometry::shape::{Curve, Shape, ShapeError, Surface};
use std::f64::consts::TAU;
use std::path::Path;

/// The types of shapes, in the order of the manual.
pub const TYPES: [&str; 31] = [
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
    "step",
];

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
        "step" => {
            let path = folder.join(f.text("file")?);
            let number = f.optional("solid").map(|_| f.count("solid")).transpose()?;
            let bytes = std::fs::read(&path).map_err(|e| f.error("file", format!("`{}`: {e}", path.display())))?;
            let solid = super::step_solid(&bytes, number);
            solid.map(Shape::from).map_err(|e| f.error("file", format!("`{}`: {e}", path.display())))
        }
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
            let [min, max] = corners.as_slice() else { return Err(f.error("box", "expected two corners")) };
            let bounds = Aabb::new(*min, *max);
            let cells = f.optional("cells").map_or(Ok(40), |_| f.count("cells"))?;
            let body = implicit(&inner, body, &bounds, cells, 0)?;
            ImplicitSurface::new(body, bounds, cells).map(Shape::from).map_err(|e| f.shape_error(&e))
        }
        other => Err(f.error("type", format!("`{other}` is not a shape; valid are {}", TYPES.join(", ")))),
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

/// Accepts `closed` only where it says no.
fn never_closed(f: &mut Fields<'_>) -> Result<(), FieldError> {
    let says_so = match f.optional("closed") {
        Some(Value::Array(entries)) => entries.iter().any(|e| e != &Value::Bool(false)),
        Some(value) => value != &Value::Bool(false),
        None => false,
    };
    if says_so { Err(f.error("closed", "this shape cannot be closed")) } else { Ok(()) }
}

fn first_closed(f: &mut Fields<'_>) -> Result<bool, FieldError> {
    match f.closed_both()? {
        [_, true] => Err(f.error("closed[1]", "only the angle can be closed")),
        [u, false] => Ok(u),
    }
}
