//! The floor under a membrane: a height, and how it moves.

use super::{Placed, Planner, coordinates};
use crate::case::CaseError;
use crate::case::statement::{Motion, Rigid, Shape, Side, Space};
use crate::case::units::{LENGTH, NONE};
use crate::expression::{Expression, Scope};

/// A floor seen from above.
#[derive(Clone)]
pub struct Floor {
    pub body: String,
    pub height: Placed,
    /// Displacement along x, y, z as expressions of time; empty for a floor at rest.
    pub displacement: Vec<Placed>,
    /// Energy of adhesion per area, where it is sticky.
    pub adhesion: Option<Placed>,
}

impl Floor {
    /// The displacement at a time.
    pub fn displacement_at(&self, time: f64) -> [f64; 3] {
        let at = |p: &Placed| p.expression.evaluate(&Scope { position: [f64::NAN; 3], time });
        match self.displacement.as_slice() {
            [x, y, z] => [at(x), at(y), at(z)],
            _ => [0.0; 3],
        }
    }
}

pub(super) fn read(planner: &Planner<'_>, body: &str, rigid: &Rigid) -> Result<Floor, CaseError> {
    let document = planner.document;
    if let Some(side) = &rigid.side
        && *side.get_ref() == Side::Inside
    {
        return Err(document.error(side.span(), "a floor under a membrane is touched from outside"));
    }
    let key = format!("bodies.{body}.rigid.shape");
    let height = match rigid.shape.get_ref() {
        Shape::Height(value) => {
            let expression = planner.reader.expression(value, LENGTH, coordinates(planner.space))?;
            Placed { expression, span: value.span(), key: format!("{key}.height") }
        }
        Shape::Plane(plane) => {
            let lineal = planner.space != Space::Plane;
            let spatial = |values: &crate::case::Values, dimension| match values.get_ref().len() {
                2 if lineal => planner.reader.numbers::<2>(values, dimension).map(|[x, z]| [x, 0.0, z]),
                _ => planner.reader.numbers::<3>(values, dimension),
            };
            let p = spatial(&plane.point, LENGTH)?;
            let n = spatial(&plane.normal, NONE)?;
            if n[2] <= 0.0 {
                return Err(document
                    .error(plane.normal.span(), format!("the normal {n:?} does not point upwards"))
                    .help(
                        "the normal points out of the rigid body, towards the membrane: its last component is positive",
                    ));
            }
            let text = format!("({}) - ({})*(x - ({})) - ({})*(y - ({}))", p[2], n[0] / n[2], p[0], n[1] / n[2], p[1]);
            let names = crate::expression::Names { variables: vec!["x", "y"], ..Default::default() };
            let expression =
                crate::expression::parse(&text, &names).map_err(|e| document.error(rigid.shape.span(), e.message))?;
            Placed { expression, span: rigid.shape.span(), key: format!("{key}.plane") }
        }
        Shape::HeightMap(map) if planner.space == Space::Plane => Placed {
            expression: Expression::height_map(planner.height_map(map)?),
            span: map.file.span(),
            key: format!("{key}.height_map"),
        },
        Shape::HeightMap(_) => {
            return Err(document
                .error(rigid.shape.span(), "a height map is a floor under a membrane seen from above")
                .help("on a line the height is a function of x:  shape.height = \"…\""));
        }
        _ => match super::shapes::height(planner, rigid)? {
            Some((expression, shape)) => Placed { expression, span: rigid.shape.span(), key: format!("{key}.{shape}") },
            None => return Err(planner.unavailable(rigid.shape.span(), "this shape as the floor of a membrane")),
        },
    };
    let mut displacement = Vec::new();
    match rigid.motion.as_ref().map(|m| (m.get_ref(), m.span())) {
        None | Some((Motion::Fixed(_), _)) => {}
        Some((Motion::Free(_), span)) => return Err(planner.unavailable(span, "a floor that moves freely")),
        Some((Motion::Prescribed(motion), _)) => {
            if let Some(rotation) = &motion.rotation {
                for v in rotation.get_ref() {
                    if planner.reader.expression(v, NONE, &["t"])?.constant() != Some(0.0) {
                        return Err(planner.unavailable(v.span(), "rotation of the floor"));
                    }
                }
            }
            if let Some(values) = &motion.displacement {
                let list = values.get_ref();
                for (k, v) in list.iter().enumerate() {
                    let expression = planner.reader.expression(v, LENGTH, &["t"])?;
                    displacement.push(Placed {
                        expression,
                        span: v.span(),
                        key: format!("bodies.{body}.rigid.motion.prescribed.displacement[{k}]"),
                    });
                }
                if planner.space != Space::Plane && displacement.len() == 2 {
                    let mut still = displacement[0].clone();
                    still.expression = Expression::number(0.0);
                    displacement.insert(1, still);
                }
                if displacement.len() != 3 {
                    return Err(document.error(values.span(), format!("expected 3 components, found {}", list.len())));
                }
                let sideways = |p: &Placed| p.expression.constant() != Some(0.0);
                if planner.space == Space::Axisymmetric && displacement[..2].iter().any(sideways) {
                    return Err(
                        document.error(values.span(), "in an axisymmetric problem the floor moves along z only")
                    );
                }
            }
        }
    }
    Ok(Floor { body: body.to_string(), height, displacement, adhesion: None })
}
