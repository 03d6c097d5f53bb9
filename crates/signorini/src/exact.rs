//! The exact solution of a case, where it is one of those that have one.

use crate::plan::MembranePlan;
use crate::problem::Space;
use signorini_membrane::obstacle::Side;
use signorini_verify::flat_floor::{FlatFloor, Kind};

/// The flat-floor solution at a time, if the case is a string or round membrane with constant data, held at
/// zero, without adhesion.
///
/// The centre of the domain is the middle of its grid.
pub fn of<const D: usize>(plan: &MembranePlan<D>, time: f64) -> Option<FlatFloor> {
    let constant = |e: &crate::expression::Expression| e.at_time(time).constant();
    let tension = constant(&plan.tension.expression)?;
    let load: f64 = plan.loads.values().map(|l| constant(&l.expression)).sum::<Option<f64>>()?;
    let [floor] = plan.contacts.as_slice() else { return None };
    if floor.adhesion.is_some() || floor.side == Side::Above {
        return None;
    }
    let height = constant(&floor.height.expression)? + floor.displacement_at(time)[2];
    let held: Vec<usize> = plan.supports.iter().flat_map(|s| s.pieces.clone()).collect();
    if plan.supports.iter().any(|s| constant(&s.displacement.expression) != Some(0.0)) {
        return None;
    }
    let bounds = plan.grid.bounds();
    let (radius, kind) = match plan.space {
        Space::Line if held.len() == 2 => (0.5 * bounds.size()[0], Kind::String),
        Space::Axisymmetric if bounds.min[0] == 0.0 => (bounds.max[0], Kind::Round),
        Space::Plane => (plan.disc_radius()?, Kind::Round),
        _ => return None,
    };
    (load < 0.0 && height < 0.0).then_some(FlatFloor { tension, load: -load, depth: -height, radius, kind })
}
