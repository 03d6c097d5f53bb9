//! The height in which a membrane sees rigid shapes that have closed forms.

use super::planner::Planner;
use super::rigid_shape::{self, ShapeKeys};
use crate::expression::Expression;
use crate::problem::units::{Dimension, LENGTH};
use crate::problem::{CaseError, List, Value};
use crate::problem::{Cylinder, Ellipsoid, Orientation, Rigid, Shape, Space};
use signorini_geometry::Vector;
use signorini_geometry::height_field::View;
use signorini_geometry::rigid_shape::NoHeight;
use signorini_membrane::obstacle::Side;

/// Points without a tangent plane are rounded off by this part of the size of the membrane: far below its cells, and well
/// above round-off.
const ROUNDING: f64 = 1e-6;

/// From where the membrane sees a body.
pub(super) fn view(side: Side) -> View {
    match side {
        Side::Below => View::FromAbove,
        Side::Above => View::FromBelow,
    }
}

/// The height of a shape on one side of a membrane within a box, and the name of the shape; none for shapes without a
/// closed form.
pub(super) fn read(
    planner: &Planner<'_>,
    rigid: &Rigid,
    side: Side,
    [low, high]: [Vector<2>; 2],
) -> Result<Option<(Expression, &'static str)>, CaseError> {
    let keys = BesideMembrane { planner };
    if planner.space == Space::Axisymmetric {
        keys.check_round(&rigid.shape)?;
    }
    let Some((shape, name)) = rigid_shape::read(&keys, &rigid.shape)? else { return Ok(None) };
    match shape.height(view(side), ROUNDING * (high - low).max()) {
        Ok(height) => Ok(Some((Expression::height(height), name))),
        Err(NoHeight::NoFormula) => Ok(None),
        Err(why) => Err(told(planner, &rigid.shape, side, why)),
    }
}

/// What is wrong with the direction of a shape.
fn told(planner: &Planner<'_>, shape: &Shape, side: Side, why: NoHeight) -> CaseError {
    let at = match shape.closed_form().map(|shape| shape.placement().orientation) {
        Some(Orientation::Along(direction, _) | Orientation::Round(Some(direction))) => planner.key(direction),
        _ => planner.key(shape),
    };
    let below = side == Side::Below;
    let (message, help) = match why {
        NoHeight::LooksAway if below => ("the normal does not point towards the membrane", "normal = [0, 0, 1]"),
        NoHeight::LooksAway => ("the normal does not point towards the membrane", "normal = [0, 0, -1]"),
        NoHeight::AxisNotAway if below => ("the axis must point vertically down, into the body", "axis = [0, 0, -1]"),
        NoHeight::AxisNotAway => ("the axis must point vertically up, into the body", "axis = [0, 0, 1]"),
        NoHeight::AxisNotUpright => ("the axis must be vertical", "axis = [0, 0, 1]"),
        NoHeight::AxisNotFlat => {
            ("the axis of a cylinder in contact with a membrane must be horizontal", "axis = [1, 0, 0]")
        }
        NoHeight::NoFormula => return planner.unavailable(&at, "this shape in contact with a membrane"),
    };
    planner.problem.error(&at, message).help(help)
}

/// Shapes beside a membrane: with three coordinates, or two on a line.
struct BesideMembrane<'a, 'b> {
    planner: &'a Planner<'b>,
}

impl BesideMembrane<'_, '_> {
    /// Round an axis of symmetry shapes stand on it and are round themselves.
    fn check_round(&self, shape: &Shape) -> Result<(), CaseError> {
        let Some(place) = shape.closed_form().and_then(|shape| shape.placement().place) else { return Ok(()) };
        let problem = self.planner.problem;
        let at = self.vector(place, LENGTH)?;
        if at[0] != 0.0 || at[1] != 0.0 {
            return Err(problem
                .error(place, "in an axisymmetric problem the shape must be centred on the axis")
                .help("x = y = 0"));
        }
        if let Shape::Ellipsoid(key) = shape {
            let [a, b, _] = self.semi_axes(key)?;
            if a != b {
                return Err(
                    problem.error(&key.semi_axes, "in an axisymmetric problem the first two semi-axes must be equal")
                );
            }
        }
        Ok(())
    }
}

impl ShapeKeys for BesideMembrane<'_, '_> {
    fn planner(&self) -> &Planner<'_> {
        self.planner
    }

    fn vector(&self, values: &List<Value>, dimension: Dimension) -> Result<Vector<3>, CaseError> {
        let reader = &self.planner.reader;
        if values.len() == 2 && self.planner.space != Space::Plane {
            return reader.numbers::<2>(values, dimension).map(|[x, z]| Vector::<3>::new(x, 0.0, z));
        }
        let mut found = Vector::<3>::from(reader.numbers::<3>(values, dimension)?);
        // A string sees places as if they were in its plane.
        if self.planner.space == Space::Line && dimension == LENGTH {
            found[1] = 0.0;
        }
        Ok(found)
    }

    fn cylinder_axis(&self, key: &Cylinder, _: &Shape) -> Result<Vector<3>, CaseError> {
        match &key.axis {
            // On a line a cylinder stands across it.
            None if self.planner.space != Space::Plane => Ok(Vector::<3>::y()),
            None => {
                let error = self.planner.problem.error(&key.point, "the cylinder requires an `axis`");
                Err(error.help("axis = [1, 0, 0]"))
            }
            Some(axis) => self.direction(axis),
        }
    }

    fn semi_axes(&self, key: &Ellipsoid) -> Result<[f64; 3], CaseError> {
        self.planner.reader.numbers::<3>(&key.semi_axes, LENGTH)
    }
}
