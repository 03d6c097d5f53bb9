//! What a solid is made of.

use crate::expression::{Expression, Scope};
use crate::plan::planner::Planner;
use crate::problem::units::{NONE, PRESSURE};
use crate::problem::{self, CaseError, Material, Value};
use signorini_fem::Mesh;
use signorini_geometry::{Point, Vector};
use signorini_material::law::Volumetric;
use signorini_material::{Elastic, SolidMaterial, StressLaw};
use std::sync::Arc;

impl Planner<'_> {
    /// What a solid is made of, and how its stress follows from its strain.
    pub(in crate::plan) fn material(
        &self,
        strain: Option<&String>,
        stated: &Material,
    ) -> Result<SolidMaterial, CaseError> {
        let problem = self.problem;
        let finite = match strain.map(|strain| (strain, strain.as_str())) {
            None | Some((_, "small")) => false,
            Some((_, "finite")) => true,
            Some((strain, other)) => {
                return Err(problem
                    .error(strain, format!("unknown word `{other}`"))
                    .help("valid are small and finite"));
            }
        };
        if finite && matches!(stated, Material::LinearElastic(_)) {
            return Err(problem.error(stated, "`linear_elastic` is a material for small strain").help(
                "with strain = \"finite\":  material.neo_hooke = {…}  or  material.saint_venant_kirchhoff = {…}",
            ));
        }
        let material = match stated {
            Material::LinearElastic(m) => {
                self.hooke(&m.youngs_modulus, &m.poissons_ratio, &StressLaw::LinearElastic)?
            }
            Material::NeoHooke(m) => {
                let volumetric = self.volumetric(m.volumetric.as_ref(), Volumetric::Quadratic)?;
                self.hooke(&m.youngs_modulus, &m.poissons_ratio, &StressLaw::NeoHooke(volumetric))?
            }
            Material::SaintVenantKirchhoff(m) => {
                self.hooke(&m.youngs_modulus, &m.poissons_ratio, &StressLaw::SaintVenantKirchhoff)?
            }
            Material::MooneyRivlin(m) => self.mooney_rivlin(m)?,
            Material::Yeoh(m) => self.yeoh(m)?,
            Material::Ogden(m) => self.ogden(m)?,
            Material::ArrudaBoyce(m) => self.arruda_boyce(m)?,
            Material::Orthotropic(m) => self.orthotropic(m, finite)?,
            Material::ElasticPlastic(m) => self.elastic_plastic(m, finite)?,
        };
        if !finite && !material.law().is_small_strain() {
            return Err(problem.error(stated, "this material is for finite strain").help("strain = \"finite\""));
        }
        Ok(material)
    }

    /// Young's modulus and Poisson's ratio of a material that has these, and no other constants.
    pub(in crate::plan) fn hooke_constants(material: &Material) -> Option<[&Value; 2]> {
        match material {
            Material::LinearElastic(m) => Some([&m.youngs_modulus, &m.poissons_ratio]),
            Material::NeoHooke(m) => Some([&m.youngs_modulus, &m.poissons_ratio]),
            Material::SaintVenantKirchhoff(m) => Some([&m.youngs_modulus, &m.poissons_ratio]),
            _ => None,
        }
    }

    /// A law with the constants of Hooke's, which may vary in space.
    fn hooke(&self, modulus: &Value, ratio: &Value, law: &StressLaw) -> Result<SolidMaterial, CaseError> {
        let law = law.clone();
        let of_modulus = self.reader.expression(modulus, PRESSURE, self.places())?;
        let of_ratio = self.reader.expression(ratio, NONE, self.places())?;
        if of_modulus.constant().is_some() && of_ratio.constant().is_some() {
            return Ok((self.constants(modulus, ratio)?, law).into());
        }
        let at = |expression: &Expression, x: &Point<3>| {
            expression.evaluate(&Scope { position: [x[0], x[1], x[2]], time: 0.0 })
        };
        let constants =
            move |x: &Point<3>| Elastic { youngs_modulus: at(&of_modulus, x), poissons_ratio: at(&of_ratio, x) };
        // Typical constants are those of the points of the mesh, known later.
        let unknown = Elastic { youngs_modulus: f64::NAN, poissons_ratio: f64::NAN };
        Ok(SolidMaterial::varying((unknown, law.clone()), Arc::new(move |x| (constants(x), law.clone()))))
    }

    /// A material that varies with the largest of its constants at the points of a mesh, as typical ones.
    pub(super) fn typical<const D: usize>(
        &self,
        key: &problem::Solid,
        material: SolidMaterial,
        mesh: &Mesh<D>,
    ) -> Result<SolidMaterial, CaseError> {
        if !material.varies() {
            return Ok(material);
        }
        let nodes = mesh.nodes();
        let centre = |cell: usize| {
            let vertices: Vec<u32> = mesh.vertices(cell).collect();
            vertices.iter().map(|v| nodes[*v as usize]).sum::<Vector<D>>() / vertices.len() as f64
        };
        let centres = (0..mesh.cell_count()).map(centre);
        let mut most = Elastic { youngs_modulus: 0.0, poissons_ratio: -1.0 };
        for x in nodes.iter().copied().chain(centres) {
            let x = Point::<3>::from_fn(|k, _| if k < D { x[k] } else { 0.0 });
            let (here, law) = material.at(&x);
            let wrong = |what: &str, value: f64, valid: &str| {
                let place: Vec<String> = x.iter().take(D).map(|v| format!("{v:.6}")).collect();
                let message = format!("{what} is {value} at ({})", place.join(", "));
                self.problem.error(&key.material, message).help(format!("give values {valid}"))
            };
            if law.fibre_direction().is_some_and(|a| !a.iter().all(|v| v.is_finite())) {
                return Err(wrong("the length of the direction of the fibres", 0.0, "that are not all 0"));
            }
            let (e, nu) = (here.youngs_modulus, here.poissons_ratio);
            if !(e > 0.0 && e.is_finite()) {
                return Err(wrong("Young's modulus", e, "above 0"));
            }
            if !(nu > -1.0 && nu < 0.5) {
                return Err(wrong("Poisson's ratio", nu, "above -1 and below 0.5"));
            }
            most.youngs_modulus = most.youngs_modulus.max(e);
            most.poissons_ratio = most.poissons_ratio.max(nu);
        }
        Ok(material.with_typical(most))
    }

    /// Young's modulus and Poisson's ratio that are the same everywhere.
    pub(in crate::plan) fn constants(&self, modulus: &Value, ratio: &Value) -> Result<Elastic, CaseError> {
        let youngs_modulus = self.reader.positive(modulus, PRESSURE)?;
        Ok(Elastic { youngs_modulus, poissons_ratio: self.poissons_ratio(ratio)? })
    }

    pub(in crate::plan) fn poissons_ratio(&self, ratio: &Value) -> Result<f64, CaseError> {
        let poissons_ratio = self.reader.number(ratio, NONE)?;
        if poissons_ratio > -1.0 && poissons_ratio < 0.5 {
            return Ok(poissons_ratio);
        }
        Err(self
            .problem
            .error(ratio, format!("Poisson's ratio is {poissons_ratio}"))
            .help("give a value above -1 and below 0.5; 0.4999, for example, is nearly incompressible"))
    }
}
