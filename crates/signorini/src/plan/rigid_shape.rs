//! Reads the keys of rigid shapes that have closed forms, for solids and membranes alike.

use super::planner::Planner;
use crate::problem::units::{Dimension, LENGTH, NONE};
use crate::problem::{self, CaseError, List, Problem, Shape, ShapeReader, Value};
use crate::text_table;
use signorini_geometry::Vector;
use signorini_geometry::rigid_shape::{Profile, RigidShape};
use std::sync::Arc;

/// How places and directions are stated: it depends on the space, and on what the shape lies beside.
pub(super) trait ShapeKeys {
    fn planner(&self) -> &Planner<'_>;

    /// A place or a direction.
    fn vector(&self, values: &List<Value>, dimension: Dimension) -> Result<Vector<3>, CaseError>;

    /// The unit vector of a direction.
    fn direction(&self, values: &List<Value>) -> Result<Vector<3>, CaseError> {
        let wrong = || self.planner().problem.error(values, "the direction vector is zero");
        self.vector(values, NONE)?.try_normalize(0.0).ok_or_else(wrong)
    }

    /// The unit vector along the axis of a cylinder, whose shape is stated at a place of the file.
    fn cylinder_axis(&self, key: &problem::Cylinder, shape: &Shape) -> Result<Vector<3>, CaseError>;

    fn semi_axes(&self, key: &problem::Ellipsoid) -> Result<[f64; 3], CaseError>;
}

/// Reads the keys of a shape as `ShapeKeys` tells.
struct Reader<'a, K>(&'a K);

impl<K: ShapeKeys> ShapeReader for Reader<'_, K> {
    fn problem(&self) -> &Problem {
        self.0.planner().problem
    }

    fn place(&self, values: &List<Value>) -> Result<Vector<3>, CaseError> {
        self.0.vector(values, LENGTH)
    }

    fn direction(&self, values: &List<Value>) -> Result<Vector<3>, CaseError> {
        self.0.direction(values)
    }

    fn length(&self, value: &Value) -> Result<f64, CaseError> {
        self.0.planner().reader.positive(value, LENGTH)
    }

    fn angle(&self, value: &Value) -> Result<f64, CaseError> {
        let planner = self.0.planner();
        let angle = planner.reader.angle(value)?;
        if angle > 0.0 {
            Ok(angle)
        } else {
            Err(planner.problem.error(value, format!("the value is {angle}: it must be positive")))
        }
    }

    fn cylinder_axis(&self, key: &problem::Cylinder, shape: &Shape) -> Result<Vector<3>, CaseError> {
        self.0.cylinder_axis(key, shape)
    }

    fn semi_axes(&self, key: &problem::Ellipsoid) -> Result<[f64; 3], CaseError> {
        self.0.semi_axes(key)
    }

    fn profile(&self, key: &problem::Revolution) -> Result<Profile, CaseError> {
        profile(self.0.planner(), key)
    }
}

/// A shape that has a closed form, and its name; none for the others.
pub(super) fn read(
    keys: &impl ShapeKeys,
    shape: &Shape,
) -> Result<Option<(Arc<dyn RigidShape>, &'static str)>, CaseError> {
    let Some(stated) = shape.closed_form() else { return Ok(None) };
    Ok(Some((stated.read(&Reader(keys), shape)?, stated.placement().name)))
}

/// The spline through the points of a table.
fn profile(planner: &Planner<'_>, key: &problem::Revolution) -> Result<Profile, CaseError> {
    let (path, bytes) = planner.read_file(&key.profile)?;
    let wrong = |message: String| planner.problem.error(&key.profile, format!("`{}`: {message}", path.display()));
    let mut points = Vec::new();
    for (k, row) in text_table::rows(&bytes).map_err(wrong)?.iter().enumerate() {
        let numbers: Vec<f64> = row.entries.iter().filter_map(|e| e.parse().ok()).collect();
        match numbers[..] {
            [rho, z] => points.push([rho, z]),
            // A head of the table.
            [] if k == 0 => {}
            _ => {
                return Err(wrong(format!(
                    "line {}: expected two numbers, radius and position along the axis",
                    row.line
                )));
            }
        }
    }
    Profile::spline(&points).map_err(|e| wrong(e.to_string()))
}
