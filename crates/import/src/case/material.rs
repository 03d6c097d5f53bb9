//! Materials as keys of a case.

use crate::deck::{Fibre, Hardening, Law, Volumetric};

/// Whether a law exists at finite strain only.
pub(super) fn needs_finite_strain(law: &Law) -> bool {
    !matches!(law, Law::Elastic { .. } | Law::Orthotropic { .. } | Law::Plastic { .. } | Law::Rigid)
}

/// The law as `NAME = { … }`.
pub(super) fn text(law: &Law, axes: Option<&[[f64; 3]; 2]>, finite_strain: bool) -> String {
    match law {
        Law::Elastic { youngs_modulus, poissons_ratio } => {
            let name = if finite_strain { "saint_venant_kirchhoff" } else { "linear_elastic" };
            format!("{name} = {{ youngs_modulus = {youngs_modulus:?}, poissons_ratio = {poissons_ratio:?} }}")
        }
        Law::NeoHooke { youngs_modulus, poissons_ratio, volumetric } => format!(
            "neo_hooke = {{ youngs_modulus = {youngs_modulus:?}, poissons_ratio = {poissons_ratio:?}, volumetric = {} }}",
            name_of(*volumetric)
        ),
        Law::MooneyRivlin { c10, c01, bulk_modulus, volumetric, fibre } => format!(
            "mooney_rivlin = {{ c10 = {c10:?}, c01 = {c01:?}, {}{} }}",
            bulk(*bulk_modulus, *volumetric),
            fibre.as_ref().map_or(String::new(), fibre_text)
        ),
        Law::Yeoh { c, bulk_modulus, volumetric } => {
            format!("yeoh = {{ c = {c:?}, {} }}", bulk(*bulk_modulus, *volumetric))
        }
        Law::Ogden { mu, alpha, bulk_modulus, volumetric } => {
            format!("ogden = {{ mu = {mu:?}, alpha = {alpha:?}, {} }}", bulk(*bulk_modulus, *volumetric))
        }
        Law::ArrudaBoyce { mu, locking_stretch, bulk_modulus, volumetric } => format!(
            "arruda_boyce = {{ mu = {mu:?}, locking_stretch = {locking_stretch:?}, {} }}",
            bulk(*bulk_modulus, *volumetric)
        ),
        Law::Orthotropic { youngs_moduli, poissons_ratios, shear_moduli } => {
            let axes = axes.copied().unwrap_or([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
            format!(
                "orthotropic = {{ youngs_moduli = {youngs_moduli:?}, poissons_ratios = {poissons_ratios:?}, shear_moduli = \
                 {shear_moduli:?}, axes = {axes:?} }}"
            )
        }
        Law::Plastic { youngs_modulus, poissons_ratio, hardening } => {
            let hardening = match hardening {
                Hardening::Isotropic(table) => match table[..] {
                    [[stress, _]] => format!("yield_stress = {stress:?}"),
                    _ => format!("yield_stress = {table:?}"),
                },
                Hardening::Kinematic { yield_stress, modulus } => {
                    format!("yield_stress = {yield_stress:?}, kinematic_hardening = {modulus:?}")
                }
            };
            format!(
                "elastic_plastic = {{ youngs_modulus = {youngs_modulus:?}, poissons_ratio = {poissons_ratio:?}, {hardening} }}"
            )
        }
        // Rigid bodies have no material.
        Law::Rigid => String::new(),
    }
}

fn bulk(bulk_modulus: f64, volumetric: Volumetric) -> String {
    format!("bulk_modulus = {bulk_modulus:?}, volumetric = {}", name_of(volumetric))
}

fn name_of(volumetric: Volumetric) -> &'static str {
    match volumetric {
        Volumetric::Linear => "\"linear\"",
        Volumetric::Logarithmic => "\"logarithmic\"",
    }
}

fn fibre_text(Fibre { direction, c3, c4, c5, stretch }: &Fibre) -> String {
    format!(", fibre = {{ direction = {direction:?}, c3 = {c3:?}, c4 = {c4:?}, c5 = {c5:?}, stretch = {stretch:?} }}")
}
