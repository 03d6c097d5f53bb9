//! The linear system of the free membrane around a zone.

use super::elements::{Elements, add_stiffness, penalty};
use super::ghost::{ghost_pairs, ghost_weight};
use super::thin_parts::hold_thin_parts;
use super::unknowns::{Unknowns, number};
use crate::method::Formulation;
use crate::problem::Membrane;
use crate::quadrature::{Cell, Quadrature};
use crate::zone::{Zone, is_free};
use rayon::prelude::*;
use signorini_fem::cut::RegionId;
use signorini_fem::lagrange::Tabulation;
use signorini_geometry::{Point, Vector};
use signorini_solve::SymmetricMatrix;

/// Cells whose local systems are in memory at once.
const CHUNK: usize = 4096;

/// Where the equations are not positive definite, parts that fill no cell to this share are held, one after the other; then
/// slivers are tied to their neighbours by so much more, where fronts that meet the boundary leave wedges.
pub(crate) const HOLDS: [(f64, f64); 4] = [(0.25, 1.0), (1.0, 1.0), (1.0, 4.0), (1.0, 16.0)];

/// The linear system of a membrane around a zone, before it is factorised.
pub(crate) struct System<const D: usize> {
    pub quadrature: Quadrature<D>,
    pub unknowns: Unknowns,
    pub matrix: SymmetricMatrix,
    pub rhs: Vec<f64>,
}

impl<const D: usize> System<D> {
    pub fn assemble<Z: Zone<D>>(membrane: &Membrane<D>, zone: &Z, elements: &Elements<D>) -> Self {
        Self::on(membrane, Quadrature::new(membrane, zone), elements)
    }

    /// The system for a quadrature at hand.
    pub fn on(membrane: &Membrane<D>, quadrature: Quadrature<D>, elements: &Elements<D>) -> Self {
        Self::tied(membrane, quadrature, elements, 1.0)
    }

    /// The same where that is not positive definite: one of [`HOLDS`].
    pub fn held(
        membrane: &Membrane<D>,
        quadrature: Quadrature<D>,
        elements: &Elements<D>,
        (needed, tied): (f64, f64),
    ) -> Self {
        let mut system = Self::tied(membrane, quadrature, elements, tied);
        hold_thin_parts(membrane, elements, &system.quadrature, &system.unknowns, &mut system.matrix, needed);
        system
    }

    /// The same with slivers tied to their neighbours by so much more.
    fn tied(membrane: &Membrane<D>, quadrature: Quadrature<D>, elements: &Elements<D>, tied: f64) -> Self {
        let unknowns = number(membrane, &quadrature);
        let pairs = ghost_pairs(membrane, elements, &quadrature, &unknowns);
        let dofs_of_pairs = pairs.iter().map(|pair| pair.dofs.as_slice());
        let cliques: Vec<&[u32]> = unknowns.all().map(|(_, _, dofs)| dofs).chain(dofs_of_pairs).collect();
        let mut matrix = SymmetricMatrix::from_cliques(unknowns.count, &cliques);
        drop(cliques);
        let mut rhs = vec![0.0; unknowns.count];

        let mut imposed = imposed_points(membrane, &quadrature);
        imposed.sort_by_key(|p| p.cell);
        for begin in (0..quadrature.cells.len()).step_by(CHUNK) {
            let end = (begin + CHUNK).min(quadrature.cells.len());
            let local: Vec<Vec<LocalSystem>> = (begin..end)
                .into_par_iter()
                .map(|cell| {
                    let points = &imposed[imposed.partition_point(|p| p.cell < cell)..];
                    let points = &points[..points.partition_point(|p| p.cell == cell)];
                    local_systems(membrane, elements, &quadrature, &unknowns, cell, points)
                })
                .collect();
            for (cell, systems) in (begin..end).zip(local) {
                for ((_, dofs), system) in unknowns.of_cell(cell).zip(systems) {
                    let Some((local, load)) = system else { continue };
                    match elements.of(membrane, cell).and_then(|e| e.stiffness.as_ref()) {
                        Some(stiffness) if local.is_empty() => {
                            matrix.add(dofs, stiffness, elements.tension_constant.unwrap_or(1.0))
                        }
                        _ => matrix.add(dofs, &local, 1.0),
                    }
                    for (&i, f) in dofs.iter().zip(&load) {
                        rhs[i as usize] += f;
                    }
                }
            }
        }
        let weight = tied * ghost_weight(membrane.cells.degree());
        for pair in &pairs {
            matrix.add(&pair.dofs, elements.ghost(membrane, pair.number), weight * pair.need() * pair.tension);
        }
        if membrane.cells.sum_to_one() {
            matrix.restore_row_sums(&row_sums(membrane, &unknowns, &imposed));
        }
        Self { quadrature, unknowns, matrix, rhs }
    }
}

/// A point of a surface where the displacement is imposed.
struct Imposed<const D: usize> {
    cell: usize,
    region: RegionId,
    x: Point<D>,
    weight: f64,
    /// Unit normal, out of the free region.
    outward: Vector<D>,
    value: f64,
}

/// The matrix and right-hand side of one region of one cell.
type LocalSystem = Option<(Vec<f64>, Vec<f64>)>;

/// Where the displacement is imposed by Nitsche's method: on the fronts by what is touched, unless a multiplier does that, on
/// supported boundary by the support.
fn imposed_points<const D: usize>(membrane: &Membrane<D>, quadrature: &Quadrature<D>) -> Vec<Imposed<D>> {
    let fronts = match membrane.formulation {
        Formulation::OneSided => &quadrature.front[..],
        Formulation::Published(_) => &[],
    };
    let fronts = fronts.iter().map(|p| Imposed {
        cell: p.cell,
        region: p.free,
        x: p.x,
        weight: p.weight,
        outward: -p.normal,
        value: membrane.obstacles.height(p.side, &p.x),
    });
    let rim = quadrature.rim.iter().filter(|p| is_free(p.region)).filter_map(|p| {
        let support = membrane.supports[p.piece].as_ref()?;
        let value = support.displacement.value(&p.x);
        Some(Imposed { cell: p.cell, region: p.region, x: p.x, weight: p.weight, outward: p.normal, value })
    });
    fronts.chain(rim).collect()
}

/// What the rows of the matrix sum to: against a constant only the terms of Nitsche's method are left.
fn row_sums<const D: usize>(membrane: &Membrane<D>, unknowns: &Unknowns, imposed: &[Imposed<D>]) -> Vec<f64> {
    let mut sums = vec![0.0; unknowns.count];
    let mut t = Tabulation::default();
    for p in imposed {
        let Some(dofs) = unknowns.of(p.cell, p.region) else { continue };
        membrane.cells.tabulate(p.cell, &p.x, &mut t);
        let penalty = penalty(membrane, p.cell);
        let w = p.weight * membrane.tension.value(&p.x);
        for (a, &i) in dofs.iter().enumerate() {
            sums[i as usize] += w * (penalty * t.value[a] - t.gradient[a].dot(&p.outward));
        }
    }
    sums
}

/// The systems of a cell's regions. The matrix is left empty where it is that of an undivided cell.
fn local_systems<const D: usize>(
    membrane: &Membrane<D>,
    elements: &Elements<D>,
    quadrature: &Quadrature<D>,
    unknowns: &Unknowns,
    cell: usize,
    imposed: &[Imposed<D>],
) -> Vec<LocalSystem> {
    let cells = &*membrane.cells;
    let element = elements.of(membrane, cell).filter(|_| matches!(quadrature.cells[cell], Cell::Whole(_)));
    let plain = imposed.is_empty() && element.is_some_and(|e| e.stiffness.is_some());
    let mut scratch = Tabulation::default();
    let whole = matches!(quadrature.cells[cell], Cell::Whole(_)) && element.is_none();
    let volumes = if whole { Vec::new() } else { quadrature.volumes(membrane, cell) };
    unknowns
        .of_cell(cell)
        .map(|(region, dofs)| {
            let n = dofs.len();
            let mut matrix = if plain { Vec::new() } else { vec![0.0; n * n] };
            let mut load = vec![0.0; n];
            let mut add = |x: &Point<D>, weight: f64, t: &Tabulation<D>| {
                if !plain {
                    add_stiffness(&mut matrix, t, weight * membrane.tension.value(x));
                }
                let f = weight * membrane.load.value(x);
                load.iter_mut().zip(&t.value).for_each(|(l, v)| *l += f * v);
            };
            if whole {
                cells.for_each_point(cell, &mut |p, t| add(&p.x, p.weight * membrane.measure.weight(&p.x), t));
            }
            for (_, rule) in volumes.iter().filter(|(r, _)| *r == region) {
                for (i, p) in rule.iter().enumerate() {
                    let t = match element {
                        Some(element) => &element.tabulated[i],
                        None => {
                            cells.tabulate(cell, &p.x, &mut scratch);
                            &scratch
                        }
                    };
                    add(&p.x, p.weight, t);
                }
            }
            for p in imposed.iter().filter(|p| p.region == region) {
                cells.tabulate(cell, &p.x, &mut scratch);
                let penalty = penalty(membrane, cell);
                let w = p.weight * membrane.tension.value(&p.x);
                let flux: Vec<f64> = scratch.gradient.iter().map(|g| g.dot(&p.outward)).collect();
                for a in 0..n {
                    for b in 0..n {
                        matrix[a * n + b] += w
                            * (penalty * scratch.value[a] * scratch.value[b]
                                - flux[a] * scratch.value[b]
                                - flux[b] * scratch.value[a]);
                    }
                    load[a] += w * p.value * (penalty * scratch.value[a] - flux[a]);
                }
            }
            Some((matrix, load))
        })
        .collect()
}
