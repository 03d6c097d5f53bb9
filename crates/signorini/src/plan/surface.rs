//! The surfaces that a membrane may touch: heights, on which side of it they lie, and how they move.

use super::height::view;
use super::located::{LocatedExpression, field};
use super::planner::{Planner, coordinates};
use crate::expression::{Expression, Scope};
use crate::problem::units::{LENGTH, NONE};
use crate::problem::{self, List, Motion, Orientation, Rigid, Shape, Space};
use crate::problem::{CaseError, Part, Value};
use crate::relief::{LevelSetTop, Sampled};
use crate::report::Warning;

use signorini_geometry::{Point, Vector};
use signorini_membrane::field::Moved;
use signorini_membrane::obstacle::{Obstacle, Side};
use std::sync::Arc;

/// A contact of the membrane: the surface of a rigid body as seen from it.
#[derive(Clone)]
pub struct Contact {
    pub name: String,
    pub body: String,
    pub side: Side,
    pub height: LocatedExpression,
    /// Displacement along x, y, z as expressions of time; empty for a body at rest.
    pub displacement: Vec<LocatedExpression>,
    /// Energy of adhesion per area, where it is sticky.
    pub adhesion: Option<LocatedExpression>,
}

impl Contact {
    /// The body at a time.
    pub fn at<const D: usize>(&self, time: f64) -> Obstacle<D> {
        let mut height = field(&self.height.expression, time);
        let [x, y, z] = self.displacement_at(time);
        if [x, y, z] != [0.0; 3] {
            let shift = Point::from_fn(|k, _| if k == 0 { x } else { y });
            height = Arc::new(Moved { field: height, shift, rise: z });
        }
        Obstacle { side: self.side, height, adhesion: self.adhesion.as_ref().map(|e| field(&e.expression, time)) }
    }

    /// The displacement at a time.
    pub fn displacement_at(&self, time: f64) -> [f64; 3] {
        let at = |p: &LocatedExpression| p.expression.evaluate(&Scope { position: [f64::NAN; 3], time });
        match self.displacement.as_slice() {
            [x, y, z] => [at(x), at(y), at(z)],
            _ => [0.0; 3],
        }
    }
}

/// What a shape is seen from.
pub(super) struct Scene<'a> {
    /// Height at which the membrane is held; none where that is not one number.
    pub level: Option<f64>,
    /// The box round the membrane, and the distance of what it can tell apart.
    pub around: [Vector<2>; 2],
    pub resolution: f64,
    pub warnings: &'a mut Vec<Warning>,
}

/// Reads a contact between the membrane and a rigid body.
pub(super) fn read(
    planner: &Planner<'_>,
    name: &str,
    body: &str,
    rigid: &Rigid,
    scene: &mut Scene<'_>,
) -> Result<Contact, CaseError> {
    let problem = planner.problem;
    if let Some(side @ problem::Side::Inside) = &rigid.side {
        return Err(problem
            .error(side, "contact of a membrane is on the outside of a body")
            .help("for a body above the membrane:  side = \"above\""));
    }
    let displacement = motion(planner, rigid)?;
    let still = LocatedExpression { expression: Expression::number(0.0), key: planner.key(&rigid.shape) };
    let mut contact = Contact {
        name: name.to_string(),
        body: body.to_string(),
        side: Side::Below,
        height: still,
        displacement,
        adhesion: None,
    };
    let rise = contact.displacement_at(0.0)[2];
    contact.side = side(planner, rigid, scene.level.map(|level| level - rise))?;
    contact.height = height(planner, rigid, contact.side, scene)?;
    Ok(contact)
}

/// The side of the membrane on which a body lies: as stated, or as its shape says.
fn side(planner: &Planner<'_>, rigid: &Rigid, level: Option<f64>) -> Result<Side, CaseError> {
    if let Some(smooth) = &rigid.smooth {
        return Err(planner.unavailable(smooth, "a smooth triangle mesh in contact with a membrane"));
    }
    match rigid.side {
        Some(problem::Side::Below) => return Ok(Side::Below),
        Some(problem::Side::Above) => return Ok(Side::Above),
        Some(problem::Side::Outside | problem::Side::Inside) | None => {}
    }
    let last = |values: &List<Value>, dimension| -> Result<f64, CaseError> {
        let Some(z) = values.last().filter(|_| values.len() >= 2) else { return Ok(0.0) };
        planner.reader.number(z, dimension)
    };
    // Up or down, into the body or out of it.
    let by_sign = |up: f64| if up < 0.0 { Side::Above } else { Side::Below };
    let by_centre = |values| {
        let z = last(values, LENGTH)?;
        Ok(if level.is_some_and(|level| z > level) { Side::Above } else { Side::Below })
    };
    let Some(placement) = rigid.shape.closed_form().map(|shape| shape.placement()) else { return Ok(Side::Below) };
    match (placement.orientation, placement.place) {
        (Orientation::Along(direction, sign), _) => Ok(by_sign(sign * last(direction, NONE)?)),
        (Orientation::Round(_), Some(place)) => by_centre(place),
        _ => Ok(Side::Below),
    }
}

/// The height of a body as seen from the membrane.
fn height(
    planner: &Planner<'_>,
    rigid: &Rigid,
    side: Side,
    scene: &mut Scene<'_>,
) -> Result<LocatedExpression, CaseError> {
    let problem = planner.problem;
    let view = view(side);
    let placed = |expression, shape: &str| {
        let mut key = planner.key(&rigid.shape);
        key.0.push(Part::Key(shape.into()));
        LocatedExpression { expression, key }
    };
    match &rigid.shape {
        Shape::Height(value) => {
            let expression = planner.reader.expression(value, LENGTH, coordinates(planner.space))?;
            Ok(placed(expression, "height"))
        }
        Shape::HeightMap(map) if planner.space == Space::Plane => {
            let expression = Expression::height(Arc::new(planner.height_map(map)?));
            Ok(placed(expression, "height_map"))
        }
        Shape::HeightMap(_) => Err(problem
            .error(&rigid.shape, "height maps in contact with a membrane that is not in the plane")
            .help("on a line the height is a function of x:  shape.height = \"…\"")),
        Shape::LevelSet(key) => {
            let inside = planner.reader.expression(&key.negative_inside, LENGTH, &["x", "y", "z"])?;
            let ends = [&key.min, &key.max].map(|corner| match corner.len() {
                2 if planner.space != Space::Plane => planner.reader.numbers::<2>(corner, LENGTH).map(|c| c[1]),
                _ => planner.reader.numbers::<3>(corner, LENGTH).map(|c| c[2]),
            });
            let [low, high] = ends;
            let (low, high) = (low?, high?);
            if low >= high {
                return Err(problem
                    .error(&key.max, format!("the box is empty: z from {low} to {high}"))
                    .help("`max` is the upper corner"));
            }
            Ok(placed(Expression::height(Arc::new(LevelSetTop { inside, low, high, view })), "level_set"))
        }
        Shape::Stl(key) if planner.space == Space::Plane => {
            let mesh = planner.closed_mesh(key)?;
            let sampled = Sampled::of_mesh(&mesh, scene.around, scene.resolution, view)
                .map_err(|e| problem.error(&key.file, format!("`{}`: {e}", key.file)))?;
            scene.warnings.push(
                format!(
                    "`{}` is sampled every {:.3e} and interpolated by a bicubic spline: its edges are rounded over \
                     this distance, and outside its vertical projection the height decreases",
                    key.file, scene.resolution
                )
                .into(),
            );
            Ok(placed(Expression::height(Arc::new(sampled)), "stl"))
        }
        Shape::Stl(_) => {
            Err(problem.error(&rigid.shape, "triangle meshes in contact with a membrane that is not in the plane"))
        }
        _ => match super::height::read(planner, rigid, side, scene.around)? {
            Some((expression, shape)) => Ok(placed(expression, shape)),
            None => Err(planner.unavailable(&rigid.shape, "this shape in contact with a membrane")),
        },
    }
}

/// How a body moves: expressions along x, y and z, or none for one at rest.
fn motion(planner: &Planner<'_>, rigid: &Rigid) -> Result<Vec<LocatedExpression>, CaseError> {
    let problem = planner.problem;
    let mut displacement = Vec::new();
    let motion = match &rigid.motion {
        None | Some(Motion::Fixed(_)) => return Ok(displacement),
        Some(free @ Motion::Free(_)) => {
            return Err(planner.unavailable(free, "a free rigid body in contact with a membrane"));
        }
        Some(Motion::Prescribed(motion)) => motion,
    };
    if let Some(rotation) = &motion.rotation {
        for v in rotation {
            if planner.reader.expression(v, NONE, &["t"])?.constant() != Some(0.0) {
                return Err(planner.unavailable(v, "rotation of a body in contact with a membrane"));
            }
        }
    }
    let Some(values) = &motion.displacement else { return Ok(displacement) };
    for v in values {
        let expression = planner.reader.expression(v, LENGTH, &["t"])?;
        displacement.push(LocatedExpression { expression, key: planner.key(v) });
    }
    if planner.space != Space::Plane && displacement.len() == 2 {
        let mut still = displacement[0].clone();
        still.expression = Expression::number(0.0);
        displacement.insert(1, still);
    }
    if displacement.len() != 3 {
        return Err(problem.error(values, format!("expected 3 components, found {}", values.len())));
    }
    let sideways = |p: &LocatedExpression| p.expression.constant() != Some(0.0);
    if planner.space == Space::Axisymmetric && displacement[..2].iter().any(sideways) {
        return Err(problem.error(values, "in an axisymmetric problem a body can move along z only"));
    }
    Ok(displacement)
}
