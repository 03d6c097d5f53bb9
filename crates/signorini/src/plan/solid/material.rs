//! What a solid is made of.

use crate::plan::planner::Planner;
use crate::problem::units::{NONE, PRESSURE};
use crate::problem::{self, CaseError, Material};
use signorini_solid::{Elastic, StressLaw, Volumetric};

impl Planner<'_> {
    /// What a solid is made of, and how its stress follows from its strain.
    pub(in crate::plan) fn material(&self, key: &problem::Solid) -> Result<(Elastic, StressLaw), CaseError> {
        let problem = self.problem;
        let finite = match key.strain.as_ref().map(|strain| (strain, strain.as_str())) {
            None | Some((_, "small")) => false,
            Some((_, "finite")) => true,
            Some((strain, other)) => {
                return Err(problem
                    .error(strain, format!("unknown word `{other}`"))
                    .help("valid are small and finite"));
            }
        };
        let (constants, law) = match &key.material {
            Material::LinearElastic(m) => (m, StressLaw::LinearElastic),
            Material::NeoHooke(m) => (m, StressLaw::NeoHooke(Volumetric::default())),
            Material::SaintVenantKirchhoff(m) => (m, StressLaw::SaintVenantKirchhoff),
        };
        if finite && law == StressLaw::LinearElastic {
            return Err(problem.error(&key.material, "`linear_elastic` is a material for small strain").help(
                "with strain = \"finite\":  material.neo_hooke = {…}  or  material.saint_venant_kirchhoff = {…}",
            ));
        }
        if !finite && law != StressLaw::LinearElastic {
            return Err(problem.error(&key.material, "this material is for finite strain").help("strain = \"finite\""));
        }
        let youngs_modulus = self.reader.positive(&constants.youngs_modulus, PRESSURE)?;
        let poissons_ratio = self.reader.number(&constants.poissons_ratio, NONE)?;
        if !(poissons_ratio > -1.0 && poissons_ratio < 0.5) {
            return Err(problem
                .error(&constants.poissons_ratio, format!("Poisson's ratio is {poissons_ratio}"))
                .help("give a value above -1 and below 0.5; 0.4999, for example, is nearly incompressible"));
        }
        Ok((Elastic { youngs_modulus, poissons_ratio }, law))
    }
}
