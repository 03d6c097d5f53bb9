//! Rigid shapes seen from above: the height of the floor that they make.

use super::Planner;
use crate::case::statement::{Rigid, Shape, Space};
use crate::case::units::{LENGTH, NONE};
use crate::case::{CaseError, Values};
use crate::expression::{Expression, Names, parse};

/// A round shape is followed to this fraction of the way to where it stands upright, and beyond along its tangent: a
/// membrane whose slope matters there is beyond the linear theory.
const FOLLOWED: f64 = 0.98;
/// Axes may be out of line by this much.
const ALIGNED: f64 = 1e-9;

/// The height of a shape at (x, y) as an expression; none for shapes that have another reading.
pub(super) fn height(planner: &Planner<'_>, rigid: &Rigid) -> Result<Option<(Expression, &'static str)>, CaseError> {
    let above = Above { planner, lineal: planner.space != Space::Plane };
    let (text, key) = match rigid.shape.get_ref() {
        Shape::Sphere(s) => {
            let c = above.place(&s.center)?;
            let radius = planner.reader.positive(&s.radius, LENGTH)?;
            (above.round(&above.distance(c), c[2], radius, 1.0), "sphere")
        }
        Shape::Cylinder(s) => {
            let c = above.place(&s.point)?;
            let radius = planner.reader.positive(&s.radius, LENGTH)?;
            let across = match &s.axis {
                // On a line a cylinder stands across it.
                None if above.lineal => above.distance(c),
                None => return Err(above.wrong(s.point.span(), "the cylinder needs an `axis`", "axis = [1, 0, 0]")),
                Some(axis) => {
                    let a = planner.reader.numbers::<3>(axis, NONE)?;
                    let length = a[0].hypot(a[1]);
                    if length == 0.0 || a[2].abs() > ALIGNED * length {
                        return Err(above.wrong(
                            axis.span(),
                            "a cylinder under a membrane lies flat",
                            "axis = [1, 0, 0]",
                        ));
                    }
                    let n = [-a[1] / length, a[0] / length];
                    format!("(({})*(x - ({})) + ({})*(y - ({})))", n[0], c[0], n[1], c[1])
                }
            };
            (above.round(&across, c[2], radius, 1.0), "cylinder")
        }
        Shape::Ellipsoid(s) => {
            let c = above.place(&s.center)?;
            let a = planner.reader.numbers::<3>(&s.semi_axes, LENGTH)?;
            if a.iter().any(|v| *v <= 0.0) {
                return Err(planner.document.error(s.semi_axes.span(), "all semi-axes must be positive"));
            }
            if planner.space == Space::Axisymmetric && a[0] != a[1] {
                return Err(planner
                    .document
                    .error(s.semi_axes.span(), "round an axis the first two semi-axes are equal"));
            }
            let across = above.scaled_distance(c, [a[0], a[1]]);
            (above.round(&across, c[2], 1.0, a[2]), "ellipsoid")
        }
        Shape::Paraboloid(s) => {
            let c = above.place(&s.apex)?;
            above.downwards(&s.axis)?;
            let radius = planner.reader.positive(&s.radius, LENGTH)?;
            (format!("({}) - {}/(2*({radius}))", c[2], square(&above.distance(c))), "paraboloid")
        }
        Shape::Torus(s) => {
            let c = above.place(&s.center)?;
            above.upright(&s.axis)?;
            let (major, minor) =
                (planner.reader.positive(&s.major_radius, LENGTH)?, planner.reader.positive(&s.minor_radius, LENGTH)?);
            let across = format!("({} - ({major}))", above.length(c, major));
            (above.round(&across, c[2], minor, 1.0), "torus")
        }
        _ => return Ok(None),
    };
    let variables = if above.lineal { vec!["x"] } else { vec!["x", "y"] };
    let names = Names { variables, ..Names::default() };
    let expression = parse(&text, &names).map_err(|e| planner.document.error(rigid.shape.span(), e.message))?;
    Ok(Some((expression, key)))
}

struct Above<'a, 'b> {
    planner: &'a Planner<'b>,
    /// Whether positions have one coordinate beside the height.
    lineal: bool,
}

impl Above<'_, '_> {
    fn wrong(&self, span: std::ops::Range<usize>, message: &str, help: &str) -> CaseError {
        self.planner.document.error(span, message).help(help)
    }

    /// A place as x, y, z; on a line [x, z] will do.
    fn place(&self, values: &Values) -> Result<[f64; 3], CaseError> {
        let found = match values.get_ref().len() {
            2 if self.lineal => self.planner.reader.numbers::<2>(values, LENGTH).map(|[x, z]| [x, 0.0, z]),
            _ => self.planner.reader.numbers::<3>(values, LENGTH),
        }?;
        if self.planner.space == Space::Axisymmetric && (found[0] != 0.0 || found[1] != 0.0) {
            return Err(self.wrong(
                values.span(),
                "in an axisymmetric problem the shape stands on the axis",
                "x = y = 0",
            ));
        }
        Ok(found)
    }

    fn direction(&self, axis: &Values) -> Result<[f64; 3], CaseError> {
        match axis.get_ref().len() {
            2 if self.lineal => self.planner.reader.numbers::<2>(axis, NONE).map(|[x, z]| [x, 0.0, z]),
            _ => self.planner.reader.numbers::<3>(axis, NONE),
        }
    }

    /// An axis that has to point into the body, down from the membrane.
    fn downwards(&self, axis: &Values) -> Result<(), CaseError> {
        let a = self.direction(axis)?;
        if a[2] < 0.0 && a[0].hypot(a[1]) <= ALIGNED * -a[2] {
            return Ok(());
        }
        Err(self.wrong(axis.span(), "the axis has to point straight down, into the body", "axis = [0, 0, -1]"))
    }

    fn upright(&self, axis: &Values) -> Result<(), CaseError> {
        let a = self.direction(axis)?;
        if a[2] != 0.0 && a[0].hypot(a[1]) <= ALIGNED * a[2].abs() {
            return Ok(());
        }
        Err(self.wrong(axis.span(), "the axis has to stand upright", "axis = [0, 0, 1]"))
    }

    /// The distance from a point in the plane, each direction in a unit of its own, in a form that is smooth when squared.
    fn scaled_distance(&self, c: [f64; 3], unit: [f64; 2]) -> String {
        if self.lineal {
            return format!("((x - ({}))/({}))", c[0], unit[0]);
        }
        format!("sqrt(((x - ({}))/({}))^2 + ((y - ({}))/({}))^2)", c[0], unit[0], c[1], unit[1])
    }

    fn distance(&self, c: [f64; 3]) -> String {
        self.scaled_distance(c, [1.0, 1.0])
    }

    /// The distance itself, positive, and rounded off at the point by a millionth of `size`.
    fn length(&self, c: [f64; 3], size: f64) -> String {
        format!("sqrt({} + ({}))", square(&self.distance(c)), (1e-6 * size).powi(2))
    }

    /// A circle of the given radius over the distance `across`, `stretch` times as high, about the height `z`.
    fn round(&self, across: &str, z: f64, radius: f64, stretch: f64) -> String {
        let square = square(across);
        let edge = FOLLOWED * radius;
        let height = (radius * radius - edge * edge).sqrt();
        let slope = edge / height;
        format!(
            "({z}) + ({stretch})*if({square} < ({}), sqrt(({}) - {square}), ({height}) - ({slope})*(sqrt({square}) - ({edge})))",
            edge * edge,
            radius * radius
        )
    }
}

/// The square of a distance; that of a root is what stands below it, smooth where it vanishes.
fn square(across: &str) -> String {
    match across.strip_prefix("sqrt(").and_then(|s| s.strip_suffix(')')) {
        Some(inner) => format!("({inner})"),
        None => format!("{across}^2"),
    }
}
