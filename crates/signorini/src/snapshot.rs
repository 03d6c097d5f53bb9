//! A state sampled for files and pictures, whatever method found it.

use crate::plan::MembranePlan;
use signorini_geometry::Point;
use signorini_membrane::domain::CellStatus;
use signorini_membrane::problem::Membrane;
use std::collections::BTreeMap;

/// Samples along the longer side of the domain that pictures and files aim at.
const RESOLUTION: usize = 200;

/// Points and cells for display: a line in one dimension, quadrilaterals that follow the boundary in two.
#[derive(Clone, Debug)]
pub struct DisplayMesh<const D: usize> {
    pub points: Vec<Point<D>>,
    /// Two or four points each.
    pub cells: Vec<Vec<u32>>,
}

impl<const D: usize> DisplayMesh<D> {
    pub fn new(plan: &MembranePlan<D>, membrane: &Membrane<D>) -> Self {
        let grid = &plan.grid;
        let longest = grid.cells().into_iter().max().unwrap_or(1);
        let fine = (RESOLUTION / longest).clamp(1, 8).max(grid.degree().min(3));
        let counts = grid.cells().map(|n| n * fine);
        let at = |index: [usize; D]| grid.bounds().at(&Point::from_fn(|k, _| index[k] as f64 / counts[k] as f64));
        let reach = 1.5 * grid.cell_size().max() / fine as f64;
        let mut mesh = Self { points: Vec::new(), cells: Vec::new() };
        let mut number: BTreeMap<[usize; D], Option<u32>> = BTreeMap::new();
        for cell in (0..grid.cell_count()).filter(|&c| plan.domain.status[c] != CellStatus::Outside) {
            let base = grid.cell_index(cell);
            for sub in 0..fine.pow(D as u32) {
                let mut rest = sub;
                let low: [usize; D] = std::array::from_fn(|k| {
                    let v = base[k] * fine + rest % fine;
                    rest /= fine;
                    v
                });
                let corners: Vec<[usize; D]> =
                    corner_offsets::<D>().iter().map(|o| std::array::from_fn(|k| low[k] + o[k])).collect();
                if !corners.iter().any(|c| membrane.contains(&at(*c))) {
                    continue;
                }
                // Corners beyond the boundary are drawn onto it.
                let ids: Option<Vec<u32>> = corners
                    .iter()
                    .map(|c| {
                        *number.entry(*c).or_insert_with(|| {
                            let x = at(*c);
                            let x = if membrane.contains(&x) {
                                Some(x)
                            } else {
                                plan.domain.domain.pulled_inside(&x, reach)
                            }?;
                            mesh.points.push(x);
                            Some(mesh.points.len() as u32 - 1)
                        })
                    })
                    .collect();
                mesh.cells.extend(ids);
            }
        }
        mesh
    }
}

/// Corners of a unit cell, round it.
fn corner_offsets<const D: usize>() -> Vec<[usize; D]> {
    let round: &[[usize; 2]] = if D == 1 { &[[0, 0], [1, 0]] } else { &[[0, 0], [1, 0], [1, 1], [0, 1]] };
    round.iter().map(|o| std::array::from_fn(|k| o[k])).collect()
}

/// Fields at the points of a display mesh, and the edge of the contact.
#[derive(Clone, Debug)]
pub struct Snapshot<const D: usize> {
    pub time: f64,
    pub displacement: Vec<f64>,
    pub gap: Vec<f64>,
    pub pressure: Vec<f64>,
    pub in_contact: Vec<bool>,
    pub floor: Vec<f64>,
    pub outlines: Vec<Vec<Point<D>>>,
    /// Whether there is a floor at all.
    pub has_floor: bool,
}

/// What a method knows of a point.
pub struct Sample {
    pub displacement: f64,
    pub in_contact: bool,
    pub pressure: f64,
}

impl<const D: usize> Snapshot<D> {
    pub fn new(
        mesh: &DisplayMesh<D>,
        membrane: &Membrane<D>,
        time: f64,
        outlines: Vec<Vec<Point<D>>>,
        sample: impl Fn(&Point<D>) -> Option<Sample>,
    ) -> Self {
        let n = mesh.points.len();
        let mut snapshot = Self {
            time,
            displacement: Vec::with_capacity(n),
            gap: Vec::with_capacity(n),
            pressure: Vec::with_capacity(n),
            in_contact: Vec::with_capacity(n),
            floor: Vec::with_capacity(n),
            outlines,
            has_floor: membrane.floor.is_some(),
        };
        for x in &mesh.points {
            let s = sample(x).unwrap_or(Sample { displacement: 0.0, in_contact: false, pressure: 0.0 });
            let floor = membrane.floor.as_ref().map_or(f64::NAN, |h| h.value(x));
            snapshot.displacement.push(s.displacement);
            snapshot.gap.push(if floor.is_nan() { 0.0 } else { s.displacement - floor });
            snapshot.floor.push(if floor.is_nan() { 0.0 } else { floor });
            snapshot.pressure.push(s.pressure);
            snapshot.in_contact.push(s.in_contact);
        }
        snapshot
    }
}
