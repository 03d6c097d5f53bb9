//! Rigid shapes seen from above or below: the height of the surface that they turn to a membrane.

use super::Planner;
use crate::case::statement::{Rigid, Shape, Space};
use crate::case::units::{LENGTH, NONE};
use crate::case::{CaseError, Values};
use crate::expression::{Expression, Names, parse};
use signorini_membrane::obstacle::Side;

/// A round shape is followed to this fraction of the way to where it stands upright, and beyond along its tangent: a
/// membrane whose slope matters there is beyond the linear theory.
const FOLLOWED: f64 = 0.98;
/// Axes may be out of line by this much.
const ALIGNED: f64 = 1e-9;

/// The height of a shape on one side of a membrane at (x, y) as an expression; none for shapes that have another reading.
pub(super) fn height(
    planner: &Planner<'_>,
    rigid: &Rigid,
    side: Side,
) -> Result<Option<(Expression, &'static str)>, CaseError> {
    let above = Above { planner, lineal: planner.space != Space::Plane, up: side.sign() };
    let (text, key) = match rigid.shape.get_ref() {
        Shape::Plane(s) => {
            let p = above.spatial(&s.point, LENGTH)?;
            let n = above.spatial(&s.normal, NONE)?;
            if n[2] <= 0.0 {
                return Err(above.wrong(
                    s.normal.span(),
                    "the normal does not point towards the membrane",
                    if side == Side::Below { "normal = [0, 0, 1]" } else { "normal = [0, 0, -1]" },
                ));
            }
            let slopes = [n[0] / n[2], n[1] / n[2]];
            (format!("({}) - ({})*(x - ({})) - ({})*(y - ({}))", p[2], slopes[0], p[0], slopes[1], p[1]), "plane")
        }
        Shape::Cone(s) => {
            let c = above.place(&s.apex)?;
            above.downwards(&s.axis)?;
            let angle = planner.reader.positive(&s.half_angle, NONE)?;
            if angle >= std::f64::consts::FRAC_PI_2 {
                return Err(above.wrong(
                    s.half_angle.span(),
                    &format!("the half angle is {angle}"),
                    "an angle in radians below pi/2",
                ));
            }
            (format!("({}) - ({})*{}", c[2], 1.0 / angle.tan(), above.length(c, 1.0)), "cone")
        }
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
    // Of a body above the mirror image was read.
    let text = if side == Side::Above { format!("-({text})") } else { text };
    let variables = vec!["x", "y"];
    let names = Names { variables, ..Names::default() };
    let expression = parse(&text, &names).map_err(|e| planner.document.error(rigid.shape.span(), e.message))?;
    Ok(Some((expression, key)))
}

/// Reads shapes as seen from above; those above a membrane upside down.
struct Above<'a, 'b> {
    planner: &'a Planner<'b>,
    /// Whether positions have one coordinate beside the height.
    lineal: bool,
    /// The sign that heights are multiplied by.
    up: f64,
}

impl Above<'_, '_> {
    fn wrong(&self, span: std::ops::Range<usize>, message: &str, help: &str) -> CaseError {
        self.planner.document.error(span, message).help(help)
    }

    /// A place or direction as x, y, z; on a line [x, z] will do.
    fn spatial(&self, values: &Values, dimension: [i32; 3]) -> Result<[f64; 3], CaseError> {
        let [x, y, z] = match values.get_ref().len() {
            2 if self.lineal => self.planner.reader.numbers::<2>(values, dimension).map(|[x, z]| [x, 0.0, z]),
            _ => self.planner.reader.numbers::<3>(values, dimension),
        }?;
        Ok([x, y, self.up * z])
    }

    /// A place as x, y, z.
    fn place(&self, values: &Values) -> Result<[f64; 3], CaseError> {
        let found = self.spatial(values, LENGTH)?;
        if self.planner.space == Space::Axisymmetric && (found[0] != 0.0 || found[1] != 0.0) {
            return Err(self.wrong(
                values.span(),
                "in an axisymmetric problem the shape stands on the axis",
                "x = y = 0",
            ));
        }
        Ok(found)
    }

    /// An axis that has to point into the body, straight away from the membrane.
    fn downwards(&self, axis: &Values) -> Result<(), CaseError> {
        let a = self.spatial(axis, NONE)?;
        if a[2] < 0.0 && a[0].hypot(a[1]) <= ALIGNED * -a[2] {
            return Ok(());
        }
        let (way, example) = if self.up > 0.0 { ("down", "axis = [0, 0, -1]") } else { ("up", "axis = [0, 0, 1]") };
        Err(self.wrong(axis.span(), &format!("the axis has to point straight {way}, into the body"), example))
    }

    fn upright(&self, axis: &Values) -> Result<(), CaseError> {
        let a = self.spatial(axis, NONE)?;
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
