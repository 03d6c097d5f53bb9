//! Laws of materials.

use super::card::Card;
use crate::ImportError;
use crate::deck::{Hardening, Law, Volumetric};

/// Ratio of the bulk modulus to the shear modulus of a material that the deck calls incompressible.
const NEARLY_INCOMPRESSIBLE: f64 = 1e3;

/// The constants that are read.
struct Constants<'a>(&'a Card, Vec<f64>);

impl Constants<'_> {
    fn get(&self, place: usize, what: &str) -> Result<f64, ImportError> {
        let Constants(card, list) = self;
        list.get(place).copied().ok_or_else(|| card.wrong(card.data.first(), format!("{what} is missing")))
    }

    /// The bulk modulus `2/D1`, and whether the deck has none.
    fn bulk_modulus(&self, place: usize, shear_modulus: f64) -> (f64, bool) {
        match self.1.get(place).copied().filter(|d| *d != 0.0) {
            Some(d) => (2.0 / d, false),
            None => (NEARLY_INCOMPRESSIBLE * shear_modulus, true),
        }
    }
}

/// A law, and what is to be said about it.
pub(super) struct Read {
    pub(super) law: Law,
    pub(super) remark: Option<String>,
}

impl From<Law> for Read {
    fn from(law: Law) -> Self {
        Read { law, remark: None }
    }
}

/// Only the first line of the data, for one temperature.
fn constants(card: &Card) -> Result<Constants<'_>, ImportError> {
    Ok(Constants(card, card.numbers()?))
}

/// `*ELASTIC`.
pub(super) fn elastic(card: &Card) -> Result<Read, ImportError> {
    let kind = card.value("TYPE").unwrap_or("ISO").to_uppercase();
    let c = constants(card)?;
    let second_line = card.data.iter().filter(|d| d.fields.iter().any(|f| !f.is_empty())).count() > 1;
    match kind.as_str() {
        "ISO" | "ISOTROPIC" => {
            if second_line {
                return Err(card.wrong(&card.data[1], "constants that depend on temperature do not exist here"));
            }
            Ok(Law::Elastic {
                youngs_modulus: c.get(0, "Young's modulus")?,
                poissons_ratio: c.get(1, "Poisson's ratio")?,
            }
            .into())
        }
        "ENGINEERING CONSTANTS" | "ENGINEERINGCONSTANTS" => {
            let three = |from: usize, what: &str| -> Result<[f64; 3], ImportError> {
                Ok([c.get(from, what)?, c.get(from + 1, what)?, c.get(from + 2, what)?])
            };
            Ok(Law::Orthotropic {
                youngs_moduli: three(0, "E1, E2 or E3")?,
                poissons_ratios: three(3, "nu12, nu13 or nu23")?,
                shear_moduli: three(6, "G12, G13 or G23")?,
            }
            .into())
        }
        other => Err(card.wrong(None, format!("TYPE={other}: valid are ISO and ENGINEERING CONSTANTS"))),
    }
}

/// `*HYPERELASTIC`; volumetric part `(J - 1)²/D1`.
pub(super) fn hyperelastic(card: &Card) -> Result<Read, ImportError> {
    let c = constants(card)?;
    let order: usize = match card.value("N") {
        None => 1,
        Some(text) => text.parse().map_err(|_| card.wrong(None, format!("N={text}: expected a number")))?,
    };
    let volumetric = Volumetric::Linear;
    let more = |what: &str| card.wrong(None, format!("{what} with N={order} does not exist here"));
    // Further D_i belong to higher powers of J - 1.
    let higher = |from: usize| c.1.iter().skip(from).any(|d| *d != 0.0);
    let (law, none) = if card.has("NEOHOOKE") {
        let c10 = c.get(0, "C10")?;
        let (bulk_modulus, none) = c.bulk_modulus(1, 2.0 * c10);
        (Law::MooneyRivlin { c10, c01: 0.0, bulk_modulus, volumetric, fibre: None }, none)
    } else if card.has("MOONEYRIVLIN") || card.has("POLYNOMIAL") {
        if order != 1 {
            return Err(more("a polynomial"));
        }
        let (c10, c01) = (c.get(0, "C10")?, c.get(1, "C01")?);
        let (bulk_modulus, none) = c.bulk_modulus(2, 2.0 * (c10 + c01));
        (Law::MooneyRivlin { c10, c01, bulk_modulus, volumetric, fibre: None }, none)
    } else if card.has("YEOH") || card.has("REDUCEDPOLYNOMIAL") && order == 3 {
        let list = [c.get(0, "C10")?, c.get(1, "C20")?, c.get(2, "C30")?];
        if higher(4) {
            return Err(card.wrong(None, "D2 and D3 do not exist here: valid is 0"));
        }
        let (bulk_modulus, none) = c.bulk_modulus(3, 2.0 * list[0]);
        (Law::Yeoh { c: list, bulk_modulus, volumetric }, none)
    } else if card.has("REDUCEDPOLYNOMIAL") && order == 1 {
        let c10 = c.get(0, "C10")?;
        let (bulk_modulus, none) = c.bulk_modulus(1, 2.0 * c10);
        (Law::MooneyRivlin { c10, c01: 0.0, bulk_modulus, volumetric, fibre: None }, none)
    } else if card.has("OGDEN") {
        let mut terms = Vec::new();
        for k in 0..order {
            terms.push([c.get(2 * k, "mu")?, c.get(2 * k + 1, "alpha")?]);
        }
        if higher(2 * order + 1) {
            return Err(card.wrong(None, "D2 and more do not exist here: valid is 0"));
        }
        let (bulk_modulus, none) = c.bulk_modulus(2 * order, terms.iter().map(|t| t[0]).sum());
        let [mu, alpha] = [0, 1].map(|k| terms.iter().map(|t| t[k]).collect());
        (Law::Ogden { mu, alpha, bulk_modulus, volumetric }, none)
    } else if card.has("ARRUDABOYCE") {
        let (mu, locking_stretch) = (c.get(0, "mu")?, c.get(1, "lambda_m")?);
        let (bulk_modulus, none) = c.bulk_modulus(2, mu);
        (Law::ArrudaBoyce { mu, locking_stretch, bulk_modulus, volumetric }, none)
    } else {
        let names: Vec<&str> = card.parameters.iter().map(|(n, _)| n.as_str()).collect();
        return Err(card.wrong(
            None,
            format!(
                "{}: valid are NEO HOOKE, MOONEY-RIVLIN, YEOH, REDUCED POLYNOMIAL (N=1, 3), OGDEN, ARRUDA-BOYCE",
                names.join(", ")
            ),
        ));
    };
    let remark = none.then(|| {
        format!("*{}: D1 is zero, an incompressible material; it has {NEARLY_INCOMPRESSIBLE} times its shear modulus as bulk modulus", card.keyword)
    });
    Ok(Read { law, remark })
}

/// `*PLASTIC`, beside the elastic law before it.
pub(super) fn plastic(card: &Card, elastic: Option<&Law>) -> Result<Read, ImportError> {
    let Some(&Law::Elastic { youngs_modulus, poissons_ratio }) = elastic else {
        return Err(card.wrong(None, "expected *ELASTIC with an isotropic law before it"));
    };
    let mut table = Vec::new();
    for data in &card.data {
        if card.number(data, 2)?.is_some_and(|t| t != 0.0) {
            return Err(card.wrong(data, "constants that depend on temperature do not exist here"));
        }
        table.push([card.required_number(data, 0, "the yield stress")?, card.number(data, 1)?.unwrap_or(0.0)]);
    }
    let Some(&[yield_stress, first]) = table.first() else {
        return Err(card.wrong(None, "the yield stress is missing"));
    };
    let hardening = match card.value("HARDENING").unwrap_or("ISOTROPIC").to_uppercase().as_str() {
        "ISOTROPIC" => Hardening::Isotropic(table),
        "KINEMATIC" => match table[..] {
            [_] => Hardening::Kinematic { yield_stress, modulus: 0.0 },
            // Along a bar the stress rises by the modulus for each plastic strain.
            [_, [stress, strain]] => {
                Hardening::Kinematic { yield_stress, modulus: (stress - yield_stress) / (strain - first) }
            }
            _ => return Err(card.wrong(None, "HARDENING=KINEMATIC with more than two points does not exist here")),
        },
        other => return Err(card.wrong(None, format!("HARDENING={other}: valid are ISOTROPIC and KINEMATIC"))),
    };
    Ok(Law::Plastic { youngs_modulus, poissons_ratio, hardening }.into())
}
