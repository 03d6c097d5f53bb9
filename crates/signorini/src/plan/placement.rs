//! Where what a file holds is put: scaled, turned, moved.

use super::planner::Planner;
use crate::problem::units::{LENGTH, NONE};
use crate::problem::{CaseError, Components, List, Value};
use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::similarity::Similarity;
use signorini_geometry::{Point, Vector};

/// The keys of a placement.
pub(super) struct PlacementKeys<'p> {
    pub scale: &'p Option<Value>,
    pub rotate: &'p Option<Components>,
    pub translate: &'p Option<List<Value>>,
}

impl Planner<'_> {
    /// A placement in the plane or in space: scaled about the origin of the file, turned about it, then moved; none where the
    /// keys state none.
    pub(super) fn placement<const D: usize>(&self, keys: &PlacementKeys) -> Result<Option<Similarity>, CaseError> {
        if keys.scale.is_none() && keys.rotate.is_none() && keys.translate.is_none() {
            return Ok(None);
        }
        let scale = keys.scale.as_ref().map_or(Ok(1.0), |scale| self.reader.positive(scale, NONE))?;
        let shift = keys.translate.as_ref().map_or(Ok([0.0; D]), |moved| self.reader.numbers::<D>(moved, LENGTH))?;
        let rotation = keys.rotate.as_ref().map_or(Ok(Vector::<3>::zeros()), |turn| self.rotation_vector::<D>(turn))?;
        let shift = Vector::<3>::from_fn(|k, _| if k < D { shift[k] } else { 0.0 });
        let RigidMotion { rotation, translation, .. } = RigidMotion::new(rotation, Point::<3>::zeros(), shift);
        Ok(Some(Similarity { factor: scale, rotation, translation }))
    }

    /// A rotation vector in space, one angle in the plane.
    pub(super) fn rotation_vector<const D: usize>(&self, turn: &Components) -> Result<Vector<3>, CaseError> {
        let wanted = if D == 2 { 1 } else { 3 };
        if turn.0.len() != wanted {
            return Err(self
                .problem
                .error(turn, format!("expected {wanted} components of the rotation, found {}", turn.0.len()))
                .help("in the plane one angle, in space a rotation vector, in radians"));
        }
        let mut rotation = Vector::<3>::zeros();
        for (k, component) in turn.0.iter().enumerate() {
            rotation[if D == 2 { 2 } else { k }] = self.reader.angle(component)?;
        }
        Ok(rotation)
    }
}
