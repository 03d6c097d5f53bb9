//! Reads the keys of rigid shapes that have closed forms, for solids and membranes alike.

use super::planner::Planner;
use crate::problem::units::{Dimension, LENGTH, NONE};
use crate::problem::{self, List, Shape};
use crate::problem::{CaseError, Value};
use crate::text_table;
use signorini_geometry::Vector;
use signorini_geometry::rigid_shape::{
    Cone, Cylinder, Ellipsoid, Paraboloid, Plane, Profile, Revolution, RigidShape, Sphere, Torus,
};
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

/// How places and directions are stated: it depends on the space, and on what the shape lies beside.
pub(super) trait ShapeKeys {
    fn planner(&self) -> &Planner<'_>;

    /// A place or a direction.
    fn vector(&self, values: &List<Value>, dimension: Dimension) -> Result<Vector<3>, CaseError>;

    /// The unit vector along the axis of a cylinder, whose shape is stated at a place of the file.
    fn cylinder_axis(&self, key: &problem::Cylinder, shape: &Shape) -> Result<Vector<3>, CaseError>;

    fn semi_axes(&self, key: &problem::Ellipsoid) -> Result<[f64; 3], CaseError>;

    /// A unit vector.
    fn direction(&self, values: &List<Value>) -> Result<Vector<3>, CaseError> {
        let v = self.vector(values, NONE)?;
        v.try_normalize(0.0).ok_or_else(|| self.planner().problem.error(values, "the direction has no length"))
    }
}

/// A shape that has a closed form, and its name; none for the others.
pub(super) fn read(
    keys: &impl ShapeKeys,
    shape: &Shape,
) -> Result<Option<(Arc<dyn RigidShape>, &'static str)>, CaseError> {
    let planner = keys.planner();
    let (problem, reader) = (planner.problem, &planner.reader);
    let wrong = |error: signorini_geometry::shape::ShapeError| problem.error(shape, error.to_string());
    Ok(Some(match shape {
        Shape::Plane(key) => {
            let (point, normal) = (keys.vector(&key.point, LENGTH)?, keys.direction(&key.normal)?);
            (Arc::new(Plane { point, normal }), "plane")
        }
        Shape::Sphere(key) => {
            let (center, radius) = (keys.vector(&key.center, LENGTH)?, reader.positive(&key.radius, LENGTH)?);
            (Arc::new(Sphere { center, radius }), "sphere")
        }
        Shape::Cylinder(key) => {
            let (axis, point) = (keys.cylinder_axis(key, shape)?, keys.vector(&key.point, LENGTH)?);
            (Arc::new(Cylinder { point, axis, radius: reader.positive(&key.radius, LENGTH)? }), "cylinder")
        }
        Shape::Cone(key) => {
            let half_angle = reader.positive(&key.half_angle, NONE)?;
            if half_angle >= FRAC_PI_2 {
                return Err(problem
                    .error(&key.half_angle, format!("the half angle is {half_angle}"))
                    .help("an angle in radians below pi/2"));
            }
            let (apex, axis) = (keys.vector(&key.apex, LENGTH)?, keys.direction(&key.axis)?);
            (Arc::new(Cone { apex, axis, half_angle }), "cone")
        }
        Shape::Torus(key) => {
            let major = reader.positive(&key.major_radius, LENGTH)?;
            let minor = reader.positive(&key.minor_radius, LENGTH)?;
            if minor >= major {
                return Err(problem.error(
                    &key.minor_radius,
                    format!("the minor radius {minor} is not smaller than the major radius {major}"),
                ));
            }
            let (center, axis) = (keys.vector(&key.center, LENGTH)?, keys.direction(&key.axis)?);
            (Arc::new(Torus { center, axis, major, minor }), "torus")
        }
        Shape::Ellipsoid(key) => {
            let semi_axes = keys.semi_axes(key)?;
            if semi_axes.iter().any(|a| *a <= 0.0) {
                return Err(problem.error(&key.semi_axes, "all semi-axes must be positive"));
            }
            let ellipsoid = Ellipsoid::new(keys.vector(&key.center, LENGTH)?, semi_axes).map_err(wrong)?;
            (Arc::new(ellipsoid), "ellipsoid")
        }
        Shape::Paraboloid(key) => {
            let radius = reader.positive(&key.radius, LENGTH)?;
            let (apex, axis) = (keys.vector(&key.apex, LENGTH)?, keys.direction(&key.axis)?);
            (Arc::new(Paraboloid::new(apex, axis, radius).map_err(wrong)?), "paraboloid")
        }
        Shape::Revolution(key) => {
            let origin = key.origin.as_ref().map_or(Ok(Vector::<3>::zeros()), |o| keys.vector(o, LENGTH))?;
            let axis = keys.direction(&key.axis)?;
            (Arc::new(Revolution { origin, axis, profile: profile(planner, key)? }), "revolution")
        }
        _ => return Ok(None),
    }))
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
                return Err(wrong(format!("line {}: expected two numbers, radius and place along the axis", row.line)));
            }
        }
    }
    Profile::spline(&points).map_err(|e| wrong(e.to_string()))
}
