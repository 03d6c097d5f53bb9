//! Hyperelastic laws with the change of volume apart.

use crate::expression::Scope;
use crate::plan::planner::Planner;
use crate::problem::units::{NONE, PRESSURE};
use crate::problem::{self, CaseError, List, Space, Value};
use nalgebra::Vector3;
use signorini_geometry::Point;
use signorini_material::law::{
    ArrudaBoyce, Fibre, Isochoric, MOST_TERMS, MooneyRivlin, Ogden, Rubber, Volumetric, Yeoh,
};
use signorini_material::{SolidMaterial, StressLaw};
use std::sync::Arc;

/// What all of these laws state.
struct Common<'a> {
    bulk_modulus: &'a Value,
    volumetric: Option<&'a String>,
    fibre: Option<&'a problem::Fibre>,
}

impl Planner<'_> {
    pub(super) fn mooney_rivlin(&self, key: &problem::MooneyRivlin) -> Result<SolidMaterial, CaseError> {
        let c01 = key.c01.as_ref().map_or(Ok(0.0), |c| self.reader.number(c, PRESSURE))?;
        let law = MooneyRivlin { c10: self.reader.number(&key.c10, PRESSURE)?, c01 };
        let common =
            Common { bulk_modulus: &key.bulk_modulus, volumetric: key.volumetric.as_ref(), fibre: key.fibre.as_ref() };
        self.rubber(key, Isochoric::MooneyRivlin(law), &common)
    }

    pub(super) fn yeoh(&self, key: &problem::Yeoh) -> Result<SolidMaterial, CaseError> {
        if !(1..=3).contains(&key.c.len()) {
            let message = format!("expected 1 to 3 constants, found {}", key.c.len());
            return Err(self.problem.error(&key.c, message).help("c = [c10, c20, c30]"));
        }
        let mut c = [0.0; 3];
        for (c, value) in c.iter_mut().zip(&key.c) {
            *c = self.reader.number(value, PRESSURE)?;
        }
        let common =
            Common { bulk_modulus: &key.bulk_modulus, volumetric: key.volumetric.as_ref(), fibre: key.fibre.as_ref() };
        self.rubber(key, Isochoric::Yeoh(Yeoh(c)), &common)
    }

    pub(super) fn ogden(&self, key: &problem::Ogden) -> Result<SolidMaterial, CaseError> {
        let problem = self.problem;
        if key.mu.len() != key.alpha.len() {
            let message = format!("{} exponents for {} moduli `mu`", key.alpha.len(), key.mu.len());
            return Err(problem.error(&key.alpha, message).help("give one exponent for each modulus"));
        }
        let mut terms = Vec::new();
        for (mu, alpha) in key.mu.iter().zip(&key.alpha) {
            let exponent = self.reader.number(alpha, NONE)?;
            if exponent == 0.0 {
                return Err(problem.error(alpha, "an exponent is 0").help("give exponents that are not 0"));
            }
            terms.push([self.reader.number(mu, PRESSURE)?, exponent]);
        }
        let law = Ogden::new(&terms).ok_or_else(|| {
            problem.error(&key.mu, format!("{} terms", terms.len())).help(format!("valid are 1 to {MOST_TERMS}"))
        })?;
        let common =
            Common { bulk_modulus: &key.bulk_modulus, volumetric: key.volumetric.as_ref(), fibre: key.fibre.as_ref() };
        self.rubber(key, Isochoric::Ogden(law), &common)
    }

    pub(super) fn arruda_boyce(&self, key: &problem::ArrudaBoyce) -> Result<SolidMaterial, CaseError> {
        let locking_stretch = self.reader.number(&key.locking_stretch, NONE)?;
        if locking_stretch <= 1.0 {
            let message = format!("the locking stretch is {locking_stretch}");
            return Err(self.problem.error(&key.locking_stretch, message).help("give a stretch above 1"));
        }
        let law = ArrudaBoyce { mu: self.reader.positive(&key.mu, PRESSURE)?, locking_stretch };
        let common =
            Common { bulk_modulus: &key.bulk_modulus, volumetric: key.volumetric.as_ref(), fibre: key.fibre.as_ref() };
        self.rubber(key, Isochoric::ArrudaBoyce(law), &common)
    }

    /// A law from its parts; `key` is that of the constants of `isochoric`.
    fn rubber<T: problem::ProblemPart>(
        &self,
        key: &T,
        isochoric: Isochoric,
        common: &Common<'_>,
    ) -> Result<SolidMaterial, CaseError> {
        let problem = self.problem;
        let bulk_modulus = self.reader.positive(common.bulk_modulus, PRESSURE)?;
        let volumetric = self.volumetric(common.volumetric, Volumetric::Linear)?;
        let shear = isochoric.shear_modulus();
        if shear.is_nan() || shear <= 0.0 {
            return Err(problem
                .error(key, format!("the shear modulus at rest is {shear:.6}: the material is not stable"))
                .help("give constants with a positive shear modulus"));
        }
        let law = Rubber { isochoric, fibre: None, bulk_modulus, volumetric };
        let elastic = law.elastic();
        if elastic.poissons_ratio <= -1.0 || elastic.poissons_ratio >= 0.5 {
            return Err(problem
                .error(common.bulk_modulus, format!("Poisson's ratio is {} in the numbers of a computer", 0.5))
                .help("give a bulk modulus of at most 1e12 times the shear modulus"));
        }
        match common.fibre {
            None => Ok((elastic, StressLaw::Rubber(law)).into()),
            Some(fibre) => self.with_fibre(fibre, law),
        }
    }

    /// The energy of the change of volume by its word.
    pub(super) fn volumetric(&self, word: Option<&String>, otherwise: Volumetric) -> Result<Volumetric, CaseError> {
        match word.map(|word| (word, word.as_str())) {
            None => Ok(otherwise),
            Some((_, "linear")) if otherwise == Volumetric::Linear => Ok(Volumetric::Linear),
            Some((_, "quadratic")) => Ok(Volumetric::Quadratic),
            Some((_, "logarithmic")) => Ok(Volumetric::Logarithmic),
            Some((key, other)) => {
                let valid = match otherwise {
                    Volumetric::Linear => "valid are linear, quadratic and logarithmic",
                    _ => "valid are quadratic and logarithmic",
                };
                Err(self.problem.error(key, format!("unknown word `{other}`")).help(valid))
            }
        }
    }

    fn with_fibre(&self, key: &problem::Fibre, law: Rubber) -> Result<SolidMaterial, CaseError> {
        let problem = self.problem;
        let [c3, c5] = [&key.c3, &key.c5].map(|value| self.not_negative_stress(value));
        let stretch = self.reader.number(&key.stretch, NONE)?;
        if stretch <= 1.0 {
            let message = format!("fibres are straight at a stretch of {stretch}");
            return Err(problem.error(&key.stretch, message).help("give a stretch above 1"));
        }
        let c4 = self.reader.positive(&key.c4, NONE)?;
        let (direction, is_constant) = self.direction(&key.direction)?;
        let first = if is_constant { direction(&Point::<3>::zeros()).normalize() } else { Vector3::x() };
        let fibre = Fibre { direction: first, c3: c3?, c4, c5: c5?, stretch };
        let typical = Rubber { fibre: Some(fibre), ..law };
        if is_constant {
            return Ok((typical.elastic(), StressLaw::Rubber(typical)).into());
        }
        let of = move |x: &Point<3>| {
            let direction = direction(x).normalize();
            let law = Rubber { fibre: Some(Fibre { direction, ..fibre }), ..law };
            (law.elastic(), StressLaw::Rubber(law))
        };
        Ok(SolidMaterial::varying((typical.elastic(), StressLaw::Rubber(typical)), Arc::new(of)))
    }

    fn not_negative_stress(&self, value: &Value) -> Result<f64, CaseError> {
        let number = self.reader.number(value, PRESSURE)?;
        if number >= 0.0 {
            return Ok(number);
        }
        Err(self.problem.error(value, format!("the value is {number}: it must not be negative")))
    }

    /// A direction by position, of any length, and whether it is the same everywhere: in the plane its third component may be
    /// left out.
    fn direction(
        &self,
        key: &List<Value>,
    ) -> Result<(impl Fn(&Point<3>) -> Vector3<f64> + Send + Sync + 'static, bool), CaseError> {
        let in_plane = self.space != Space::ThreeD;
        if key.len() != 3 && !(in_plane && key.len() == 2) {
            let wanted = if in_plane { "2 or 3" } else { "3" };
            return Err(self.problem.error(key, format!("expected {wanted} components, found {}", key.len())));
        }
        let variables: &[&'static str] = if in_plane { &["x", "y"] } else { &["x", "y", "z"] };
        let read = |v: &Value| self.reader.expression(v, NONE, variables);
        let list = key.iter().map(read).collect::<Result<Vec<_>, _>>()?;
        if list.iter().all(|v| v.constant() == Some(0.0)) {
            return Err(self.problem.error(key, "a direction of zeros").help("direction = [1, 0, 0]"));
        }
        if self.space == Space::PlaneStress && list.get(2).is_some_and(|v| v.constant() != Some(0.0)) {
            return Err(self.problem.error(key, "in plane stress fibres lie in the plane").help("direction = [1, 0]"));
        }
        let is_constant = list.iter().all(|v| v.constant().is_some());
        let of = move |x: &Point<3>| {
            let at = Scope { position: [x[0], x[1], x[2]], time: 0.0 };
            Vector3::from_fn(|k, _| list.get(k).map_or(0.0, |v| v.evaluate(&at)))
        };
        Ok((of, is_constant))
    }
}
