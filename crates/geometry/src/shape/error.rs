//! What is wrong with the data of a shape.

use crate::{Point, Vector};

/// A refused shape: which field, and what would be valid.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{field}`: {message}")]
pub struct ShapeError {
    pub field: &'static str,
    pub message: String,
}

impl ShapeError {
    pub fn new(field: &'static str, message: impl Into<String>) -> Self {
        ShapeError { field, message: message.into() }
    }
}

/// Coordinates beyond this cannot be squared and compared in double precision.
pub const LARGEST_COORDINATE: f64 = 1e140;

pub(crate) fn number(field: &'static str, value: f64) -> Result<f64, ShapeError> {
    if !value.is_finite() {
        return Err(ShapeError::new(field, format!("{value} is not a finite number")));
    }
    if value.abs() > LARGEST_COORDINATE {
        return Err(ShapeError::new(field, format!("{value:e} is beyond {LARGEST_COORDINATE:e}: change the unit")));
    }
    Ok(value)
}

pub(crate) fn positive(field: &'static str, value: f64) -> Result<f64, ShapeError> {
    number(field, value)?;
    if value > 0.0 { Ok(value) } else { Err(ShapeError::new(field, format!("{value} must be greater than zero"))) }
}

pub(crate) fn position(field: &'static str, x: &Point<3>) -> Result<Point<3>, ShapeError> {
    for &value in x.iter() {
        number(field, value)?;
    }
    Ok(*x)
}

pub(crate) fn interval(field: &'static str, range: [f64; 2]) -> Result<[f64; 2], ShapeError> {
    number(field, range[0])?;
    number(field, range[1])?;
    if range[0] < range[1] {
        Ok(range)
    } else {
        Err(ShapeError::new(field, format!("[{}, {}] must increase", range[0], range[1])))
    }
}

/// Knots that do not decrease, repeat at most `degree + 1` times and leave an interval for the curve.
pub(crate) fn knots(field: &'static str, degree: usize, knots: &[f64], controls: usize) -> Result<(), ShapeError> {
    if degree == 0 || degree > crate::patch::bernstein::MAX_DEGREE {
        let most = crate::patch::bernstein::MAX_DEGREE;
        return Err(ShapeError::new("degree", format!("{degree} is not between 1 and {most}")));
    }
    if controls <= degree {
        return Err(ShapeError::new(
            "control_points",
            format!("{controls} in one direction, but degree {degree} needs at least {}", degree + 1),
        ));
    }
    let expected = controls + degree + 1;
    if knots.len() != expected {
        return Err(ShapeError::new(
            field,
            format!("{} numbers, but {controls} control points of degree {degree} need {expected}", knots.len()),
        ));
    }
    for (k, &t) in knots.iter().enumerate() {
        number(field, t)?;
        if k > 0 && t < knots[k - 1] {
            return Err(ShapeError::new(field, format!("knot {k} is {t}, less than {} before it", knots[k - 1])));
        }
    }
    let repeated = knots.windows(degree + 2).find(|w| w[0] == w[degree + 1]);
    if let Some(w) = repeated {
        return Err(ShapeError::new(
            field,
            format!("{} is repeated more than degree + 1 = {} times", w[0], degree + 1),
        ));
    }
    if knots[degree] >= knots[controls] {
        return Err(ShapeError::new(field, "the knots leave no interval for the shape"));
    }
    Ok(())
}

pub(crate) fn weight(value: f64) -> Result<f64, ShapeError> {
    positive("weights", value)
}

/// An origin with three orthonormal axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes {
    pub origin: Point<3>,
    pub ex: Vector<3>,
    pub ey: Vector<3>,
    pub ez: Vector<3>,
}

impl Axes {
    /// Right-handed axes with the third one given by the cross product.
    ///
    /// # Errors
    /// Axes that are not orthonormal to 1e-8.
    pub fn new(origin: Point<3>, ex: Vector<3>, ey: Vector<3>) -> Result<Self, ShapeError> {
        Self::with_third(origin, ex, ey, ex.cross(&ey))
    }

    /// Axes of either handedness.
    ///
    /// # Errors
    /// Axes that are not orthonormal to 1e-8.
    pub fn with_third(origin: Point<3>, ex: Vector<3>, ey: Vector<3>, ez: Vector<3>) -> Result<Self, ShapeError> {
        position("o", &origin)?;
        let unit = |name: &'static str, e: &Vector<3>| {
            position(name, e)?;
            if (e.norm() - 1.0).abs() > 1e-8 {
                return Err(ShapeError::new(name, format!("an axis of length {}, not 1", e.norm())));
            }
            Ok(())
        };
        let across = |name: &'static str, p: &Vector<3>, q: &Vector<3>| {
            if p.dot(q).abs() > 1e-8 {
                return Err(ShapeError::new(name, "not at right angles to the other axes"));
            }
            Ok(())
        };
        unit("ex", &ex)?;
        unit("ey", &ey)?;
        across("ey", &ex, &ey)?;
        unit("ez", &ez)?;
        across("ez", &ex, &ez)?;
        across("ez", &ey, &ez)?;
        Ok(Axes { origin, ex, ey, ez })
    }

    /// The coordinate axes at an origin.
    pub fn standard(origin: Point<3>) -> Self {
        Axes { origin, ex: Vector::<3>::x(), ey: Vector::<3>::y(), ez: Vector::<3>::z() }
    }

    /// Coordinates of a position in these axes.
    pub fn local(&self, x: &Point<3>) -> Vector<3> {
        let d = x - self.origin;
        Vector::<3>::new(d.dot(&self.ex), d.dot(&self.ey), d.dot(&self.ez))
    }
}
