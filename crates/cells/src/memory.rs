//! About how much memory a body of cells takes with its equations, before it is made: from a sample of its cells.

use crate::cell::{Cell, SMALL};
use crate::discretisation::{Discretisation, check_values};
use crate::error::CellsError;
use crate::moments::VolumePoints;
use crate::region::{BoundaryPoint, Filling, Region};
use crate::space::{LocalMode, Mode, modes_of};
use crate::tree::{CellTree, Leaf};
use rayon::prelude::*;
use signorini_fem::QuadraturePoint;
use signorini_geometry::Aabb;
use signorini_mechanics::iterative::BESIDE;

/// One cell of so many is looked at beforehand, which costs as much time less.
const ONE_OF: usize = 16;
/// Most cells that are looked at. Of cells of which a tenth are cut it then finds that within a tenth of it.
const MOST: usize = 1024;
/// Share of the memory below which the first look is enough, whatever chance made of it.
const FAR_BELOW: f64 = 0.25;

/// Tells where cells with their equations need more memory than they may take.
///
/// # Errors
/// That they do; values of the shape in the sample that are not finite.
pub(crate) fn check_memory<const D: usize>(
    region: &dyn Region<D>,
    tree: &CellTree<D>,
    discretisation: &Discretisation<D>,
) -> Result<(), CellsError> {
    let leaves = tree.leaves().len();
    if discretisation.memory.is_infinite()
        || bytes_by_sample(region, tree, discretisation, leaves / ONE_OF)? < FAR_BELOW * discretisation.memory
    {
        return Ok(());
    }
    let needed = bytes_by_sample(region, tree, discretisation, leaves)?;
    CellsError::check_memory(leaves as f64, needed, discretisation.memory)
}

/// Bytes that all leaves take, by those of some of them.
fn bytes_by_sample<const D: usize>(
    region: &dyn Region<D>,
    tree: &CellTree<D>,
    discretisation: &Discretisation<D>,
    count: usize,
) -> Result<f64, CellsError> {
    let (leaves, count) = (tree.leaves(), count.min(MOST));
    // Fractions of multiples of the golden ratio are spread evenly, whatever the counts of cells in the directions are.
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let of_sample = |k: usize| {
        let number = (k as f64 * golden).fract() * leaves.len() as f64;
        let leaf = &leaves[(number as usize).min(leaves.len() - 1)];
        check_values(region, leaf)?;
        Ok(bytes_of(region, tree, leaf, discretisation))
    };
    let bytes = (1..=count).into_par_iter().map(of_sample).collect::<Result<Vec<f64>, CellsError>>()?;
    Ok(BESIDE * bytes.iter().sum::<f64>() / count.max(1) as f64 * leaves.len() as f64)
}

/// Bytes that a leaf takes: its points, its functions, its matrix, and the inverses of the preconditioner: around one of its
/// vertices, and its own where it holds little material. Matrices and inverses of full cells of the grid are all the same.
/// A factorisation takes more than these inverses.
fn bytes_of<const D: usize>(
    region: &dyn Region<D>,
    tree: &CellTree<D>,
    leaf: &Leaf<D>,
    discretisation: &Discretisation<D>,
) -> f64 {
    let degree = discretisation.degree;
    let rule_of = |b: &Aabb<D>| region.rule(b, &discretisation.integration, degree);
    let functions = modes_of(tree, leaf, degree, discretisation.products).len() as f64;
    let square = |functions: f64| size_of::<f64>() as f64 * (D as f64 * functions).powi(2);
    let is_alike = |filling: Filling| filling == Filling::Full && leaf.level == 0;
    let b = &leaf.bounds;

    let mut bytes = 0.0;
    let around = rule_of(&Aabb::new(b.min, b.max + b.size())).filling;
    if around != Filling::Void {
        // Rows of the coarse matrix: of each direction those of the vertices around, numbers and columns.
        bytes += 12.0 * (D * D * 3usize.pow(D as u32)) as f64;
        if !is_alike(around) {
            // Of n functions in each direction 2 n - 3 vanish outside of two neighbours. Inverses are kept as triangles.
            bytes += 0.5 * square((2.0 * functions.powf(1.0 / D as f64) - 3.0).powi(D as i32));
        }
    }
    let rule = rule_of(b);
    if rule.filling == Filling::Void {
        return bytes;
    }
    let points = match discretisation.volume_points {
        VolumePoints::Fitted => rule.volume.len().min((2 * degree + 1).pow(D as u32)),
        VolumePoints::InMaterial => rule.volume.len(),
    };
    bytes += (points * size_of::<QuadraturePoint<D>>() + rule.boundary.len() * size_of::<BoundaryPoint<D>>()) as f64;
    // While functions are numbered: each with its numbers, in two maps, by a cell of its support and by all of them.
    let of_function = 2 * size_of::<LocalMode<D>>() + size_of::<Mode<D>>();
    bytes += size_of::<Cell<D>>() as f64 + functions * of_function as f64;
    if !is_alike(rule.filling) {
        bytes += square(functions);
    }
    if rule.measure(b.volume()) < SMALL * b.volume() {
        bytes += 0.5 * square(functions);
    }
    bytes
}
