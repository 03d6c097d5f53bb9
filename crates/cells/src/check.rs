//! What a discretisation has to be.

use crate::discretisation::{CellMaterial, Discretisation, check_values};
use crate::error::CellsError;
use crate::legendre::MAX_DEGREE;
use crate::memory::check_memory;
use crate::region::{Integration, Region};
use crate::tree::CellTree;
use signorini_material::{Elastic, Space};

/// # Errors
/// Constants out of range, more cells than the memory holds, values of the shape that are not finite.
pub(crate) fn check<const D: usize>(
    region: &dyn Region<D>,
    tree: &CellTree<D>,
    discretisation: &Discretisation<D>,
    material: &CellMaterial<D>,
) -> Result<(), CellsError> {
    let degree = discretisation.degree;
    if !(1..=MAX_DEGREE).contains(&degree) {
        return Err(CellsError::Degree { degree, most: MAX_DEGREE });
    }
    if !(0.0..1.0).contains(&discretisation.fictitious) {
        return Err(CellsError::Fictitious { value: discretisation.fictitious });
    }
    let Elastic { youngs_modulus, poissons_ratio } = *material.elastic();
    if !(youngs_modulus > 0.0 && youngs_modulus.is_finite()) {
        return Err(CellsError::Value { name: "youngs_modulus", value: youngs_modulus, must: "must be positive" });
    }
    if !(poissons_ratio > -1.0 && poissons_ratio < 0.5) {
        let must = "must lie between -1 and 0.5";
        return Err(CellsError::Value { name: "poissons_ratio", value: poissons_ratio, must });
    }
    if let Integration::SubCells { subdivision: 0 } = discretisation.integration {
        return Err(CellsError::Value { name: "subdivision", value: 0.0, must: "must be 1 or more" });
    }
    if material.space == Space::Axisymmetric && tree.bounds().min[0] < 0.0 {
        return Err(CellsError::NegativeRadius { radius: tree.bounds().min[0] });
    }
    check_memory(region, tree, discretisation)?;
    tree.leaves().iter().try_for_each(|leaf| check_values(region, leaf))
}
