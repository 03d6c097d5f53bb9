//! Cross-sections of beams and their stiffness.
//!
//! The axes of a section are `d_1` along the beam, `d_2` and `d_3` across. Shear correction factors are those of Cowper
//! (1966); torsion of a rectangle follows Saint-Venant's series.

use crate::mass::SectionMass;
use std::f64::consts::PI;

/// Stiffness of a section: forces per strain, moments per curvature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stiffness {
    /// `EA`.
    pub axial: f64,
    /// `GA` along `d_2` and `d_3`, corrected for shear.
    pub shear: [f64; 2],
    /// `GJ`.
    pub torsion: f64,
    /// `EI` about `d_2` and `d_3`.
    pub bending: [f64; 2],
}

/// The shape of a section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Section {
    Circle {
        radius: f64,
    },
    /// `width` along `d_2`, `height` along `d_3`.
    Rectangle {
        width: f64,
        height: f64,
    },
}

/// A section that is none.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SectionError {
    #[error("{name} = {value}: valid are positive numbers")]
    NotPositive { name: &'static str, value: f64 },
    #[error("Poisson's ratio {value}: valid are numbers between -1 and 0.5")]
    PoissonsRatio { value: f64 },
}

fn positive(name: &'static str, value: f64) -> Result<(), SectionError> {
    if value > 0.0 && value.is_finite() { Ok(()) } else { Err(SectionError::NotPositive { name, value }) }
}

impl Section {
    /// The stiffness of an isotropic section.
    ///
    /// # Errors
    /// Lengths or a modulus that are not positive, a ratio outside (-1, 0.5].
    pub fn stiffness(&self, youngs_modulus: f64, poissons_ratio: f64) -> Result<Stiffness, SectionError> {
        positive("youngs_modulus", youngs_modulus)?;
        if !(poissons_ratio > -1.0 && poissons_ratio <= 0.5) {
            return Err(SectionError::PoissonsRatio { value: poissons_ratio });
        }
        let (e, nu) = (youngs_modulus, poissons_ratio);
        let g = e / (2.0 * (1.0 + nu));
        Ok(match *self {
            Section::Circle { radius } => {
                positive("radius", radius)?;
                let area = PI * radius * radius;
                let inertia = 0.25 * area * radius * radius;
                let shear = 6.0 * (1.0 + nu) / (7.0 + 6.0 * nu) * g * area;
                let bending = e * inertia;
                Stiffness { axial: e * area, shear: [shear; 2], torsion: 2.0 * g * inertia, bending: [bending; 2] }
            }
            Section::Rectangle { width, height } => {
                positive("width", width)?;
                positive("height", height)?;
                let area = width * height;
                let shear = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu) * g * area;
                let bending = [e * area * height * height / 12.0, e * area * width * width / 12.0];
                Stiffness {
                    axial: e * area,
                    shear: [shear; 2],
                    torsion: g * rectangle_torsion_constant(width, height),
                    bending,
                }
            }
        })
    }

    /// Mass and inertia per length with a mass per volume.
    pub fn mass(&self, density: f64) -> SectionMass {
        let (mass, [about_2, about_3]) = match *self {
            Section::Circle { radius } => {
                let area = PI * radius * radius;
                (density * area, [0.25 * radius * radius; 2])
            }
            Section::Rectangle { width, height } => {
                (density * width * height, [height, width].map(|across| across * across / 12.0))
            }
        };
        SectionMass { mass, inertia: [mass * (about_2 + about_3), mass * about_2, mass * about_3] }
    }

    /// The radius of the section about its axis, where it has one: what touches.
    pub fn radius(&self) -> Option<f64> {
        match *self {
            Section::Circle { radius } => Some(radius),
            Section::Rectangle { .. } => None,
        }
    }
}

impl Stiffness {
    /// The same stiffness, if all of it is positive.
    ///
    /// # Errors
    /// The first value that is not.
    pub fn checked(self) -> Result<Self, SectionError> {
        positive("EA", self.axial)?;
        positive("GA_2", self.shear[0])?;
        positive("GA_3", self.shear[1])?;
        positive("GJ", self.torsion)?;
        positive("EI_2", self.bending[0])?;
        positive("EI_3", self.bending[1])?;
        Ok(self)
    }

    /// Of axial force and the two shear forces.
    pub fn of_forces(&self) -> [f64; 3] {
        [self.axial, self.shear[0], self.shear[1]]
    }

    /// Of torque and the two bending moments.
    pub fn of_moments(&self) -> [f64; 3] {
        [self.torsion, self.bending[0], self.bending[1]]
    }
}

/// `J = a b³ (1/3 - 64/π⁵ b/a Σ tanh(k π a / 2b) / k⁵)`, `k = 1, 3, 5…`, `a >= b`.
#[doc(hidden)]
pub fn rectangle_torsion_constant(width: f64, height: f64) -> f64 {
    let (a, b) = (width.max(height), width.min(height));
    // The terms fall as k⁻⁵: the first three hundred leave less than round-off.
    let series: f64 = (0..300).map(|k| 2.0 * k as f64 + 1.0).map(|k| (0.5 * k * PI * a / b).tanh() / k.powi(5)).sum();
    a * b.powi(3) * (1.0 / 3.0 - 64.0 / PI.powi(5) * b / a * series)
}
