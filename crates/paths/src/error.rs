//! Why there is no path.

use signorini_geometry::Point;

/// What stands in the way of a path.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PathError {
    #[error("{what} is {value}; valid is {valid}")]
    Input { what: &'static str, value: f64, valid: &'static str },
    #[error("{what}: {given} given; {valid}")]
    Count { what: &'static str, given: usize, valid: &'static str },
    #[error("the integration along the surface stops after {at} of {of}: the surface is not smooth there")]
    Stalled { at: f64, of: f64 },
    #[error("the point ({}, {}, {}) could not be projected on the surface: it is at a distance of {gap} after \
             {iterations} iterations", .at.x, .at.y, .at.z)]
    NoFoot { at: Point<3>, gap: f64, iterations: usize },
    #[error("the direction is normal to the surface at ({}, {}, {}): a path requires a tangent", .at.x, .at.y, .at.z)]
    NoTangent { at: Point<3> },
    #[error(
        "the {place} of the path lies inside body {body}, {depth:.4e} deep: move it outside by at least this distance"
    )]
    Inside { place: Place, body: usize, depth: f64 },
    #[error("it passes through body {body}, {depth:.4e} deep at ({:.6}, {:.6}, {:.6})", .at.x, .at.y, .at.z)]
    Crosses { body: usize, depth: f64, at: Point<3> },
    #[error("station {station} names body {body}; there are {count}")]
    NoBody { station: usize, body: usize, count: usize },
    #[error(
        "no shortest path was found between {from} and {to}: residuals {}; number of changes of bodies {changes}",
        list(.residuals)
    )]
    NoPath { from: Place, to: Place, residuals: Vec<f64>, changes: usize },
    #[error("the path ends at s = {at} before it reaches {wanted}")]
    NotReached { wanted: String, at: f64 },
    #[error("no slippage within [{}, {}] gives {wanted}: the ends give {} and {}", .range[0], .range[1], .found[0], .found[1])]
    NoSlippage { wanted: String, range: [f64; 2], found: [f64; 2] },
    #[error("no pattern: {reason}")]
    NoPattern { reason: String },
}

/// A fixed point of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    Start,
    /// A via point by its number among the stations.
    Via(usize),
    End,
}

impl std::fmt::Display for Place {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Place::Start => f.write_str("start"),
            Place::Via(k) => write!(f, "via point at station {k}"),
            Place::End => f.write_str("end"),
        }
    }
}

fn list(values: &[f64]) -> String {
    values.iter().map(|v| format!("{v:.1e}")).collect::<Vec<_>>().join(", ")
}
