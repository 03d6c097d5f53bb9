//! Paths over rigid bodies of other programs, at the pose in which their files are written: tendons of MuJoCo (`.xml`), muscles
//! of OpenSim (`.osim`).

mod circle;
mod joints;
mod mjcf;
mod osim;
mod pose;
mod spline;

use crate::ImportError;
use crate::case::names::Names;
use circle::Way;
use nalgebra::Vector2;
use pose::Pose;
use signorini_geometry::Vector;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

pub(crate) use mjcf::read as read_mjcf;
pub(crate) use osim::read as read_osim;

/// The shape of a body, about the origin of its frame; axes along z.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Shape {
    Sphere(f64),
    Cylinder(f64),
    Ellipsoid([f64; 3]),
    Torus { major: f64, minor: f64 },
}

/// A body that paths go around.
#[derive(Clone, Debug)]
struct Wrap {
    name: String,
    shape: Shape,
    pose: Pose,
}

/// A path through points, with the bodies of each part between two of them.
#[derive(Clone, Debug, Default)]
struct Track {
    name: String,
    points: Vec<Vector<3>>,
    /// By the number of the body.
    around: Vec<Vec<usize>>,
}

/// What a file says of paths.
#[derive(Clone, Debug, Default)]
struct Model {
    title: Option<String>,
    units: Option<&'static str>,
    bodies: Vec<Wrap>,
    paths: Vec<Track>,
    remarks: Vec<String>,
}

impl Wrap {
    /// The way of a part around this body as the other program takes it; `None` of a shape for which it is not known.
    fn way(&self, from: &Vector<3>, to: &Vector<3>, side: Option<Vector<3>>) -> Option<Way> {
        let frame = self.pose.inverse();
        let [a, b] = [from, to].map(|x| frame.point(x));
        let (radius, first, second) = match self.shape {
            Shape::Cylinder(radius) => (radius, Vector::<3>::x(), Vector::<3>::y()),
            Shape::Sphere(radius) => {
                let first = a.try_normalize(0.0).unwrap_or_else(Vector::<3>::x);
                let across = b - first * first.dot(&b);
                // Ends in line with the centre: any plane, or that of the side.
                let of_side = side.map(|s| frame.direction(&s)).map(|s| s - first * first.dot(&s));
                let any = || Some(first.cross(&Vector::<3>::ith(first.iamin(), 1.0)));
                let second = across.try_normalize(1e-12 * b.norm());
                let second = second.or_else(|| of_side.and_then(|s| s.try_normalize(0.0))).or_else(any)?;
                (radius, first, second)
            }
            _ => return None,
        };
        let plane = |x: &Vector<3>| Vector2::new(first.dot(x), second.dot(x));
        let side = side.map(|s| plane(&frame.direction(&s)));
        Some(circle::way([plane(&a), plane(&b)], radius, side))
    }

    /// Whether a point lies inside; of a torus, within its tube.
    fn contains(&self, x: &Vector<3>) -> bool {
        let x = self.pose.inverse().point(x);
        match self.shape {
            Shape::Sphere(radius) => x.norm() < radius,
            Shape::Cylinder(radius) => x.x.hypot(x.y) < radius,
            Shape::Ellipsoid(axes) => (0..3).map(|k| (x[k] / axes[k]).powi(2)).sum::<f64>() < 1.0,
            Shape::Torus { major, minor } => (x.x.hypot(x.y) - major).hypot(x.z) < minor,
        }
    }

    fn table(&self) -> String {
        let centre = list(&self.pose.origin);
        let axis = list(&self.pose.direction(&Vector::<3>::z()));
        match self.shape {
            Shape::Sphere(radius) => format!("shape.sphere = {{ center = {centre}, radius = {radius:?} }}\n"),
            Shape::Cylinder(radius) => {
                format!("shape.cylinder = {{ point = {centre}, axis = {axis}, radius = {radius:?} }}\n")
            }
            Shape::Ellipsoid(axes) => {
                let turned = self.pose.rotation_vector();
                let shape = format!("shape.ellipsoid = {{ center = {centre}, semi_axes = {axes:?} }}\n");
                // Semi-axes lie along those of space before the body turns about its centre.
                let motion = format!("motion.prescribed = {{ rotation = {} }}\n", list(&turned));
                if turned == Vector::<3>::zeros() { shape } else { shape + &motion }
            }
            Shape::Torus { major, minor } => format!(
                "shape.torus = {{ center = {centre}, axis = {axis}, major_radius = {major:?}, minor_radius = {minor:?} }}\n"
            ),
        }
    }
}

fn list(x: &Vector<3>) -> String {
    // Zeros of rotations are written without a sign.
    format!("{:?}", [x[0] + 0.0, x[1] + 0.0, x[2] + 0.0])
}

impl Model {
    /// The case, as TOML.
    fn text(&self, file: &Path) -> Result<String, ImportError> {
        if self.paths.is_empty() {
            let why = if self.remarks.is_empty() { "it has none".into() } else { self.remarks.join("; ") };
            return Err(ImportError::new(file, None, format!("no path can be imported: {why}")));
        }
        if self.paths.iter().all(|p| p.around.iter().all(Vec::is_empty)) {
            let message =
                "no path goes around a body: all are straight between their points, and nothing is to be solved";
            return Err(ImportError::new(file, None, message));
        }
        let mut out = String::new();
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let _ = writeln!(out, "# Imported from {name}, at the pose in which it is written.");
        out.push_str(&crate::case::left_out(&self.remarks));
        let title = self.title.clone().unwrap_or_else(|| name.to_string());
        let _ = writeln!(out, "\ntitle = {}\nanalysis = \"wrapping\"", crate::case::quoted(title.trim()));
        if let Some(units) = self.units {
            let _ = writeln!(out, "units = \"{units}\"");
        }
        let mut names = Names::default();
        let mut given: BTreeMap<usize, String> = BTreeMap::new();
        let used = |k: &usize| self.paths.iter().any(|p| p.around.iter().any(|part| part.contains(k)));
        for k in (0..self.bodies.len()).filter(used) {
            let name = names.take(&self.bodies[k].name);
            let _ = write!(out, "\n[bodies.{name}.rigid]\n{}", self.bodies[k].table());
            given.insert(k, name);
        }
        let mut names = Names::default();
        for path in &self.paths {
            let (Some(first), Some(last)) = (path.points.first(), path.points.last()) else { continue };
            let _ = writeln!(out, "\n[paths.{}]", names.take(&path.name));
            let _ = writeln!(out, "from = {}\nto = {}", list(first), list(last));
            let via: Vec<String> = path.points[1..path.points.len() - 1].iter().map(list).collect();
            if !via.is_empty() {
                let _ = writeln!(out, "via = [\n{}]", via.iter().map(|x| format!("    {x},\n")).collect::<String>());
            }
            let part = |part: &Vec<usize>| {
                let names: Vec<String> = part.iter().map(|k| format!("\"{}\"", given[k])).collect();
                format!("[{}]", names.join(", "))
            };
            let parts: Vec<String> = path.around.iter().map(part).collect();
            match &parts[..] {
                [one] if one != "[]" => {
                    let _ = writeln!(out, "around = {one}");
                }
                [_] => {}
                _ if path.around.iter().all(Vec::is_empty) => {}
                many => {
                    let _ = writeln!(out, "around = [{}]", many.join(", "));
                }
            }
        }
        Ok(out)
    }
}
