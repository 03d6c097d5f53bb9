//! Orthotropic elasticity.

use crate::plan::planner::Planner;
use crate::problem::units::{NONE, PRESSURE};
use crate::problem::{self, CaseError, List, Space, Value};
use signorini_material::law::{Orthotropic, OrthotropicError};
use signorini_material::{Elastic, SolidMaterial, StressLaw};

impl Planner<'_> {
    pub(super) fn orthotropic(&self, key: &problem::Orthotropic, finite: bool) -> Result<SolidMaterial, CaseError> {
        let problem = self.problem;
        let moduli = self.reader.numbers::<3>(&key.youngs_moduli, PRESSURE)?;
        let ratios = self.reader.numbers::<3>(&key.poissons_ratios, NONE)?;
        let shear = self.reader.numbers::<3>(&key.shear_moduli, PRESSURE)?;
        let axes = key.axes.as_ref().map_or(Ok([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]), |axes| self.two_axes(axes))?;
        let law = Orthotropic::new(moduli, ratios, shear, axes).map_err(|error| {
            let told = error.to_string();
            match (&error, &key.axes) {
                (OrthotropicError::Axes { .. }, Some(axes)) => problem.error(axes, told),
                (OrthotropicError::Modulus { name, .. }, _) if name.starts_with('G') => {
                    problem.error(&key.shear_moduli, told)
                }
                (OrthotropicError::Modulus { .. }, _) => problem.error(&key.youngs_moduli, told),
                _ => problem.error(&key.poissons_ratios, told).help("poissons_ratios = [v12, v13, v23]"),
            }
        })?;
        if let Some(axes) = key.axes.as_ref().filter(|_| self.space != Space::ThreeD && !law.is_of_plane()) {
            return Err(problem
                .error(axes, "no axis of the material is along z, so the body would not stay in the plane")
                .help("axes = [[1, 1, 0], [-1, 1, 0]]"));
        }
        let elastic = Elastic { youngs_modulus: law.largest_modulus(), poissons_ratio: 0.0 };
        Ok((elastic, StressLaw::Orthotropic(if finite { law.at_finite_strain() } else { law })).into())
    }

    fn two_axes(&self, key: &List<List<Value>>) -> Result<[[f64; 3]; 2], CaseError> {
        let [first, second] = &key[..] else {
            let message = format!("expected 2 axes, found {}", key.len());
            return Err(self.problem.error(key, message).help("axes = [[1, 0, 0], [0, 1, 0]]"));
        };
        let axis = |key: &List<Value>| {
            let in_plane = self.space != Space::ThreeD && key.len() == 2;
            let axis = match in_plane {
                true => self.reader.numbers::<2>(key, NONE).map(|[x, y]| [x, y, 0.0])?,
                false => self.reader.numbers::<3>(key, NONE)?,
            };
            if axis == [0.0; 3] {
                return Err(self.problem.error(key, "an axis of zeros"));
            }
            Ok(axis)
        };
        Ok([axis(first)?, axis(second)?])
    }
}
