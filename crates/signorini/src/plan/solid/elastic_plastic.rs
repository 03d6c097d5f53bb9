//! Elastic-plastic solids.

use crate::plan::planner::Planner;
use crate::problem::units::{NONE, PRESSURE};
use crate::problem::{self, CaseError, Value, YieldStress};
use signorini_material::law::{ElasticPlastic, Hardening, HardeningError};
use signorini_material::{SolidMaterial, StressLaw};

impl Planner<'_> {
    pub(super) fn elastic_plastic(
        &self,
        key: &problem::ElasticPlastic,
        finite: bool,
    ) -> Result<SolidMaterial, CaseError> {
        let problem = self.problem;
        let elastic = self.constants(&key.youngs_modulus, &key.poissons_ratio)?;
        let points = match &key.yield_stress {
            YieldStress::Constant(value) => vec![[self.reader.positive(value, PRESSURE)?, 0.0]],
            YieldStress::Table(rows) => rows
                .iter()
                .map(|row| match &row[..] {
                    [stress, strain] => Ok([self.reader.number(stress, PRESSURE)?, self.reader.number(strain, NONE)?]),
                    other => Err(problem
                        .error(row, format!("expected 2 numbers, found {}", other.len()))
                        .help("yield_stress = [[250, 0], [300, 0.05], [320, 0.2]]")),
                })
                .collect::<Result<Vec<_>, CaseError>>()?,
        };
        let modulus = |value: &Option<Value>| value.as_ref().map_or(Ok(0.0), |v| self.reader.number(v, PRESSURE));
        let hardening = Hardening::new(&points, modulus(&key.hardening)?).map_err(|error| match &key.hardening {
            Some(slope) if matches!(error, HardeningError::Slope { .. }) => problem.error(slope, error.to_string()),
            _ => problem
                .error(&key.yield_stress, error.to_string())
                .help("give rows [stress, plastic strain] that begin at a plastic strain of 0 and rise"),
        })?;
        let kinematic = modulus(&key.kinematic_hardening)?;
        if let Some(value) = key.kinematic_hardening.as_ref().filter(|_| kinematic < 0.0) {
            let message = format!("the modulus is {kinematic}: it must not be negative");
            return Err(problem.error(value, message).help("hardening = …"));
        }
        let law = ElasticPlastic { hardening, kinematic, is_finite: finite };
        Ok((elastic, StressLaw::ElasticPlastic(law)).into())
    }
}
