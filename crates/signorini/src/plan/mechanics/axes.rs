//! The axes of a support.

use crate::plan::planner::Planner;
use crate::problem::units::{Dimension, LENGTH, NONE};
use crate::problem::{CaseError, List, Space, Support, SupportAxes, Value};
use signorini_geometry::Vector;
use signorini_mechanics::Axes;

impl Planner<'_> {
    /// The axes of the displacement that a support prescribes.
    pub(super) fn support_axes(&self, support: &Support, is_solid: bool) -> Result<Option<Axes>, CaseError> {
        let problem = self.problem;
        let Some(key) = &support.axes else { return Ok(None) };
        if !is_solid {
            return Err(problem.error(key, "`axes` is only for solids"));
        }
        if support.displacement.is_none() {
            return Err(problem
                .error(key, "these axes are those of no component")
                .help("add  displacement = [0, \"free\", \"free\"]"));
        }
        if support.normal.is_some() || support.tied.is_some() || support.spring.is_some() {
            return Err(problem
                .error(key, "`normal`, `tied` and `spring` have no other axes than those of space")
                .help("state them in a support of their own"));
        }
        match key {
            SupportAxes::Rectangular(list) => {
                let wanted = if self.space == Space::ThreeD { 2 } else { 1 };
                let directions = list.iter().map(|values| self.support_vector(values, NONE));
                let directions = directions.collect::<Result<Vec<_>, _>>()?;
                let (a, b) = match directions[..] {
                    [a, b] if wanted == 2 => (a, b),
                    [a] if wanted == 1 => (a, Vector::<3>::new(-a.y, a.x, 0.0)),
                    _ => {
                        let message = format!("expected {wanted} directions, found {}", list.len());
                        let help = match wanted {
                            2 => {
                                "the first axis, and a direction in the plane of the first two: [[1, 1, 0], [-1, 1, 0]]"
                            }
                            _ => "the first axis: [[1, 1]]",
                        };
                        return Err(problem.error(list, message).help(help));
                    }
                };
                let parallel = || problem.error(list, "the directions are zero, or parallel to each other");
                Axes::rectangular(&a, &b).map(Some).ok_or_else(parallel)
            }
            SupportAxes::Cylindrical(line) => {
                if self.space == Space::Axisymmetric {
                    let message = "the components of an axisymmetric body are radial and axial already";
                    return Err(problem.error(key, message).help("leave `axes` out"));
                }
                let point = self.support_vector(&line.point, LENGTH)?;
                let axis = match (&line.axis, self.space == Space::ThreeD) {
                    (None, false) => Vector::<3>::z(),
                    (Some(axis), false) => {
                        let message = "in the plane the line is normal to the plane: leave `axis` out";
                        return Err(problem.error(axis, message));
                    }
                    (None, true) => return Err(problem.error(line, "`axis` is missing").help("axis = [0, 0, 1]")),
                    (Some(axis), true) => {
                        let zero = || problem.error(axis, "the direction vector is zero");
                        self.support_vector(axis, NONE)?.try_normalize(0.0).ok_or_else(zero)?
                    }
                };
                Ok(Some(Axes::Cylindrical { point, axis }))
            }
        }
    }

    fn support_vector(&self, values: &List<Value>, dimension: Dimension) -> Result<Vector<3>, CaseError> {
        if self.space == Space::ThreeD {
            return Ok(Vector::<3>::from(self.reader.numbers::<3>(values, dimension)?));
        }
        self.reader.numbers::<2>(values, dimension).map(|[x, y]| Vector::<3>::new(x, y, 0.0))
    }
}
