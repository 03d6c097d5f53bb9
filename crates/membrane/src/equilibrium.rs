//! Equilibrium of the free membrane outside a given contact zone: the one-sided formulation.
//!
//! In contact the displacement is the floor and the pressure is known, so only the free regions are solved for. On
//! their boundary the displacement is imposed weakly by the symmetric method of Nitsche; a ghost penalty keeps cells
//! that are cut to slivers stable. For every test function `v`
//!
//! ```text
//! ∫ T ∇u·∇v - ∫_Γ T (∂_ν u v + ∂_ν v u) + (β T/h) ∫_Γ u v + s_h(u, v)
//!     = ∫ f v - ∫_Γ T ∂_ν v G + (β T/h) ∫_Γ G v
//! ```
//!
//! with `β = 8 p² + 4`, and the flux `T ∂_n u_h + (β T/h)(u_h - G)` is the variational one: tested against smooth functions
//! it converges with twice the order of the gradient. The matrix is symmetric and positive definite. Each connected
//! free region has unknowns of its own, so a thin wall of contact between two of them couples nothing.

use crate::problem::Membrane;
use crate::published::{Formulation, Saddle};
use crate::quadrature::{Cell, Quadrature, RimPoint};
use crate::thin_parts::hold_thin_parts;
use crate::zone::{Zone, contact_of, is_free};
use rayon::prelude::*;
use signorini_fem::cells::Neighbours;
use signorini_fem::cut::{QuadraturePoint, RegionId};
use signorini_fem::ghost_penalty;
use signorini_fem::lagrange::Tabulation;
use signorini_geometry::{Point, Vector};
use signorini_solve::{Factor, SolveError, Symbolic, SymmetricMatrix};
use std::collections::{BTreeMap, HashMap};
use std::sync::OnceLock;

/// Cells whose local systems are in memory at once.
const CHUNK: usize = 4096;

/// Where the equations are not positive definite, parts that fill no cell to this share are held, one after the other; then
/// slivers are tied to their neighbours by so much more, where fronts that meet the boundary leave wedges.
pub(crate) const HOLDS: [(f64, f64); 4] = [(0.25, 1.0), (1.0, 1.0), (1.0, 4.0), (1.0, 16.0)];

/// Penalty of Nitsche's method, to be divided by the cell size.
pub(crate) fn nitsche_penalty(degree: usize) -> f64 {
    8.0 * (degree * degree) as f64 + 4.0
}

/// The penalty in a cell, `β/h`.
pub(crate) fn penalty<const D: usize>(membrane: &Membrane<D>, cell: usize) -> f64 {
    nitsche_penalty(membrane.cells.degree()) / membrane.cells.size(cell)
}

/// Weight of the ghost penalty at a sliver; smaller ones lose positive definiteness when a straight boundary cuts slivers only.
pub(crate) fn ghost_weight(degree: usize) -> f64 {
    if degree == 1 { 0.5 } else { 0.2 }
}

/// What is left of that weight at a sliver of no size: enough for round-off.
const LEAST: f64 = 1e-4;

/// What does not change from one zone to the next: the matrices of cells that are not divided.
pub struct Elements<const D: usize> {
    /// For each kind of cell.
    kinds: Vec<Element<D>>,
    neighbours: Vec<Neighbours>,
    /// For each kind of neighbours, and for each pair that is like no other, once it was needed.
    ghosts_of_kinds: Vec<OnceLock<Vec<f64>>>,
    ghosts_of_pairs: Vec<OnceLock<Vec<f64>>>,
    tension_constant: Option<f64>,
    symbolic: Symbolic,
}

/// A cell that is not divided.
pub(crate) struct Element<const D: usize> {
    pub tabulated: Vec<Tabulation<D>>,
    /// Stiffness for unit tension, where the tension is constant and the measure plain.
    stiffness: Option<Vec<f64>>,
}

impl<const D: usize> Elements<D> {
    pub fn new(membrane: &Membrane<D>) -> Self {
        let cells = &*membrane.cells;
        let tension_constant = membrane.tension.constant();
        let plain = tension_constant.is_some() && membrane.measure == crate::problem::Measure::Plain;
        let element = |cell: usize| {
            let rule = cells.rule(cell);
            let tabulated: Vec<Tabulation<D>> = rule
                .iter()
                .map(|p| {
                    let mut t = Tabulation::default();
                    cells.tabulate(cell, &p.x, &mut t);
                    t
                })
                .collect();
            let n = tabulated.first().map_or(0, |t| t.value.len());
            let stiffness = plain.then(|| {
                let mut matrix = vec![0.0; n * n];
                for (p, t) in rule.iter().zip(&tabulated) {
                    add_stiffness(&mut matrix, t, p.weight);
                }
                matrix
            });
            Element { tabulated, stiffness }
        };
        let neighbours = cells.neighbours();
        let empty = |n: usize| (0..n).map(|_| OnceLock::new()).collect();
        let kinds = neighbours.iter().filter_map(|pair| pair.kind).max().map_or(0, |kind| kind + 1);
        Self {
            kinds: cells.kinds().into_iter().map(element).collect(),
            ghosts_of_kinds: empty(kinds),
            ghosts_of_pairs: empty(neighbours.len()),
            neighbours,
            tension_constant,
            symbolic: Symbolic::default(),
        }
    }
}

impl<const D: usize> Elements<D> {
    /// The element of a cell that has others of its kind.
    pub(crate) fn of(&self, membrane: &Membrane<D>, cell: usize) -> Option<&Element<D>> {
        membrane.cells.kind(cell).map(|kind| &self.kinds[kind])
    }

    /// The ghost penalty of a pair of neighbours.
    pub(crate) fn ghost(&self, membrane: &Membrane<D>, pair: &GhostPair) -> &[f64] {
        let number = pair.number;
        let pair = &self.neighbours[number];
        let place = pair.kind.map_or(&self.ghosts_of_pairs[number], |kind| &self.ghosts_of_kinds[kind]);
        place.get_or_init(|| ghost_penalty(&*membrane.cells, pair))
    }
}

pub(crate) fn add_stiffness<const D: usize>(matrix: &mut [f64], t: &Tabulation<D>, weight: f64) {
    let n = t.value.len();
    for a in 0..n {
        let g = weight * t.gradient[a];
        for b in 0..=a {
            let v = g.dot(&t.gradient[b]);
            matrix[a * n + b] += v;
            if a != b {
                matrix[b * n + a] += v;
            }
        }
    }
}

/// Unknowns of each cell and region.
pub(crate) struct Unknowns {
    /// For each cell where its regions begin, and for each of these where its unknowns do.
    cells: Vec<u32>,
    regions: Vec<(RegionId, u32)>,
    list: Vec<u32>,
    pub count: usize,
}

/// The state of a membrane with a given contact zone.
pub struct Equilibrium<const D: usize> {
    pub membrane: Membrane<D>,
    pub quadrature: Quadrature<D>,
    unknowns: Unknowns,
    /// None where other means than a factorisation found the displacement.
    factor: Option<Factor>,
    /// Values at the nodes of the free regions.
    u: Vec<f64>,
    /// In the published formulation, the other side and the multipliers.
    saddle: Option<Saddle<D>>,
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

impl<const D: usize> Equilibrium<D> {
    /// Solves for the free membrane around a zone.
    pub fn solve<Z: Zone<D>>(membrane: &Membrane<D>, zone: &Z, elements: &mut Elements<D>) -> Result<Self, SolveError> {
        if let (Formulation::Published(published), false) = (membrane.formulation, zone.is_empty()) {
            let System { quadrature, unknowns, matrix, rhs } = System::assemble(membrane, zone, elements);
            let (saddle, u) =
                Saddle::solve(membrane, zone, elements, &quadrature, &unknowns, matrix, rhs, published.multiplier)?;
            let membrane = membrane.clone();
            return Ok(Self { membrane, quadrature, unknowns, factor: None, u, saddle: Some(saddle) });
        }
        let mut system = System::assemble(membrane, zone, elements);
        let mut factor = elements.symbolic.factor(system.matrix);
        for hold in HOLDS {
            if let Err(SolveError::NotPositiveDefinite { .. }) = factor {
                system = System::held(membrane, system.quadrature, elements, hold);
                factor = elements.symbolic.factor(system.matrix);
            }
        }
        let factor = factor?;
        let u = factor.solve_accurately(&system.rhs)?;
        let System { quadrature, unknowns, .. } = system;
        Ok(Self { membrane: membrane.clone(), quadrature, unknowns, factor: Some(factor), u, saddle: None })
    }

    /// A state whose displacement is found by other means, and given by [`Equilibrium::set_values`]; its fronts cannot
    /// respond to each other.
    pub(crate) fn unsolved(membrane: Membrane<D>, quadrature: Quadrature<D>, unknowns: Unknowns) -> Self {
        let u = vec![0.0; unknowns.count];
        Self { membrane, quadrature, unknowns, factor: None, u, saddle: None }
    }

    pub(crate) fn unknowns(&self) -> &Unknowns {
        &self.unknowns
    }

    /// Whether the response of the membrane to its fronts can be computed.
    pub fn responds(&self) -> bool {
        self.factor.is_some()
    }

    /// The values of the unknowns.
    pub(crate) fn values(&self) -> &[f64] {
        &self.u
    }

    pub(crate) fn set_values(&mut self, value: impl Fn(usize) -> f64) {
        self.u.iter_mut().enumerate().for_each(|(i, u)| *u = value(i));
    }

    /// Number of unknowns of the linear system.
    pub fn size(&self) -> usize {
        self.unknowns.count
    }

    /// Displacement and its gradient at a point of a cell, by the polynomial of one of its regions.
    pub fn evaluate(&self, cell: usize, region: RegionId, x: &Point<D>) -> Option<(f64, Vector<D>)> {
        evaluate(&self.membrane, &self.unknowns, &self.u, cell, region, x)
    }

    /// The regions with unknowns in a cell.
    pub fn free_regions(&self, cell: usize) -> impl Iterator<Item = RegionId> + '_ {
        self.unknowns.of_cell(cell).map(|(region, _)| region)
    }

    /// Calls `visit(cell, region, x, weight)` at every volume point of the membrane.
    pub fn for_each_point(&self, mut visit: impl FnMut(usize, RegionId, &Point<D>, f64)) {
        for cell in 0..self.quadrature.cells.len() {
            for (region, points) in self.quadrature.volumes(&self.membrane, cell) {
                for p in points.iter() {
                    visit(cell, region, &p.x, p.weight);
                }
            }
        }
    }

    /// The other side of the fronts and the multipliers, in the published formulation.
    pub fn saddle(&self) -> Option<&Saddle<D>> {
        self.saddle.as_ref()
    }

    /// The slope with which the gap opens at each point of the fronts, `ρ = ∂_n u + (β/h)(u - h) - ∂_n h`, and its
    /// opposite below a ceiling. In the published formulation the multiplier over the tension is the slope of the membrane.
    pub fn slope_jump(&self) -> Vec<f64> {
        if let Some(saddle) = &self.saddle {
            return saddle.slope_jump(self);
        }
        self.quadrature
            .front
            .iter()
            .map(|p| {
                let (u, gradient) = self.evaluate(p.cell, p.free, &p.x).unwrap_or((0.0, Vector::zeros()));
                let h = self.membrane.obstacles.jet(p.side, &p.x);
                let jump = (gradient - h.gradient).dot(&p.normal) + penalty(&self.membrane, p.cell) * (u - h.value);
                p.side.sign() * jump
            })
            .collect()
    }

    /// The flux `T ∂_ν u` out of the membrane at a point of its boundary; zero on a free edge.
    pub fn support_flux(&self, p: &RimPoint<D>) -> f64 {
        let Some(support) = &self.membrane.supports[p.piece] else { return 0.0 };
        if let Some((side, _)) = contact_of(p.region) {
            // In contact up to the support: the membrane follows the body.
            let slope = self.membrane.obstacles.jet(side, &p.x).gradient;
            self.membrane.tension.value(&p.x) * slope.dot(&p.normal)
        } else {
            let (u, gradient) = self.evaluate(p.cell, p.region, &p.x).unwrap_or((0.0, Vector::zeros()));
            nitsche_flux(&self.membrane, p.cell, &p.x, &p.normal, u - support.displacement.value(&p.x), &gradient)
        }
    }

    /// The rate at which the slope of the gap changes on the fronts where the gap itself changes at the rate `data`: the
    /// normal derivative of the field that takes these values there, vanishes on the supports and is in equilibrium without
    /// load. This is the Dirichlet-to-Neumann map, from the factorisation at hand.
    pub fn normal_derivative_of_extension(&self, data: &[f64]) -> Result<Vec<f64>, SolveError> {
        let membrane = &self.membrane;
        let mut rhs = vec![0.0; self.unknowns.count];
        let mut t = Tabulation::default();
        for (p, &value) in self.quadrature.front.iter().zip(data) {
            if value == 0.0 {
                continue;
            }
            let Some(dofs) = self.unknowns.of(p.cell, p.free) else { continue };
            membrane.cells.tabulate(p.cell, &p.x, &mut t);
            let penalty = penalty(membrane, p.cell);
            let w = p.weight * membrane.tension.value(&p.x) * p.side.sign() * value;
            for (a, &i) in dofs.iter().enumerate() {
                rhs[i as usize] += w * (t.gradient[a].dot(&p.normal) + penalty * t.value[a]);
            }
        }
        let z = self.respond(&rhs)?;
        Ok(self
            .quadrature
            .front
            .iter()
            .zip(data)
            .map(|(p, &value)| {
                let (v, gradient) =
                    evaluate(membrane, &self.unknowns, &z, p.cell, p.free, &p.x).unwrap_or((0.0, Vector::zeros()));
                let sign = p.side.sign();
                sign * gradient.dot(&p.normal) + penalty(membrane, p.cell) * (sign * v - value)
            })
            .collect())
    }

    /// What the unknowns are under other forces, by the factorisation at hand.
    pub(crate) fn respond(&self, forces: &[f64]) -> Result<Vec<f64>, SolveError> {
        match &self.factor {
            Some(factor) => factor.solve(forces),
            None => Err(SolveError::NotFactorised { size: forces.len() }),
        }
    }

    /// The displacement at a point in any region: the solution where free, the body in contact, none outside.
    pub fn displacement<Z: Zone<D>>(&self, zone: &Z, x: &Point<D>) -> Option<f64> {
        if !self.membrane.contains(x) {
            return None;
        }
        let cell = self.membrane.cells.containing(x)?;
        let region = match &self.quadrature.cells[cell] {
            Cell::Whole(region) => *region,
            _ => zone.region_at(x),
        };
        match contact_of(region) {
            Some((side, _)) => Some(self.membrane.obstacles.height(side, x)),
            None => self.evaluate(cell, region, x).map(|v| v.0),
        }
    }
}

/// The variational flux `T (∂_ν u - (β/h)(u - G))` through a point where the displacement is imposed weakly.
pub(crate) fn nitsche_flux<const D: usize>(
    membrane: &Membrane<D>,
    cell: usize,
    x: &Point<D>,
    outward: &Vector<D>,
    mismatch: f64,
    gradient: &Vector<D>,
) -> f64 {
    membrane.tension.value(x) * (gradient.dot(outward) - penalty(membrane, cell) * mismatch)
}

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
            matrix.add(&pair.dofs, elements.ghost(membrane, pair), weight * pair.need() * pair.tension);
        }
        if membrane.cells.sum_to_one() {
            matrix.restore_row_sums(&row_sums(membrane, &unknowns, &imposed));
        }
        Self { quadrature, unknowns, matrix, rhs }
    }
}

impl Unknowns {
    /// The regions of a cell with their unknowns.
    pub fn of_cell(&self, cell: usize) -> impl Iterator<Item = (RegionId, &[u32])> {
        (self.cells[cell] as usize..self.cells[cell + 1] as usize).map(|k| {
            let end = self.regions.get(k + 1).map_or(self.list.len(), |r| r.1 as usize);
            (self.regions[k].0, &self.list[self.regions[k].1 as usize..end])
        })
    }

    /// All cells and regions with their unknowns.
    pub fn all(&self) -> impl Iterator<Item = (usize, RegionId, &[u32])> {
        (0..self.cells.len() - 1).flat_map(|cell| self.of_cell(cell).map(move |(region, dofs)| (cell, region, dofs)))
    }

    /// Visits the volume rules of all cells and regions that have unknowns: the cell, the region, its unknowns, its points.
    pub fn for_each_rule<const D: usize>(
        &self,
        membrane: &Membrane<D>,
        quadrature: &Quadrature<D>,
        mut visit: impl FnMut(usize, RegionId, &[u32], &[QuadraturePoint<D>]),
    ) {
        for cell in 0..quadrature.cells.len() {
            for (region, points) in quadrature.volumes(membrane, cell) {
                if let Some(dofs) = self.of(cell, region) {
                    visit(cell, region, dofs, &points);
                }
            }
        }
    }

    pub fn of(&self, cell: usize, region: RegionId) -> Option<&[u32]> {
        self.of_cell(cell).find(|(r, _)| *r == region).map(|(_, dofs)| dofs)
    }
}

fn evaluate<const D: usize>(
    membrane: &Membrane<D>,
    unknowns: &Unknowns,
    u: &[f64],
    cell: usize,
    region: RegionId,
    x: &Point<D>,
) -> Option<(f64, Vector<D>)> {
    let dofs = unknowns.of(cell, region)?;
    let mut t = Tabulation::default();
    membrane.cells.tabulate(cell, x, &mut t);
    Some(dofs.iter().enumerate().fold((0.0, Vector::zeros()), |(value, gradient), (a, &i)| {
        let c = u[i as usize];
        (value + c * t.value[a], gradient + c * t.gradient[a])
    }))
}

/// Numbers the unknowns, cell by cell: one for each node and free region.
pub(crate) fn number<const D: usize>(membrane: &Membrane<D>, quadrature: &Quadrature<D>) -> Unknowns {
    number_where(membrane, quadrature, is_free)
}

/// Numbers the unknowns, cell by cell: one for each node and region of some kind.
pub(crate) fn number_where<const D: usize>(
    membrane: &Membrane<D>,
    quadrature: &Quadrature<D>,
    wanted: impl Fn(RegionId) -> bool,
) -> Unknowns {
    let mut of_node: BTreeMap<RegionId, Vec<u32>> = BTreeMap::new();
    let mut out = Unknowns { cells: vec![0], regions: Vec::new(), list: Vec::new(), count: 0 };
    let mut nodes = Vec::new();
    for cell in 0..quadrature.cells.len() {
        for region in quadrature.regions(cell).into_iter().filter(|r| wanted(*r)) {
            membrane.cells.functions(cell, &mut nodes);
            let numbers = of_node.entry(region).or_insert_with(|| vec![u32::MAX; membrane.cells.function_count()]);
            out.regions.push((region, out.list.len() as u32));
            for &node in &nodes {
                let number = &mut numbers[node as usize];
                if *number == u32::MAX {
                    *number = out.count as u32;
                    out.count += 1;
                }
                out.list.push(*number);
            }
        }
        out.cells.push(out.regions.len() as u32);
    }
    out
}

/// Two neighbouring cells whose polynomials a ghost penalty holds together.
pub(crate) struct GhostPair {
    /// Among the neighbours of the elements.
    number: usize,
    pub region: RegionId,
    pub dofs: Vec<u32>,
    pub cells: [usize; 2],
    lean: Lean,
    measure: f64,
    pub tension: f64,
}

impl GhostPair {
    /// By how much they need it.
    pub fn need(&self) -> f64 {
        self.measure * self.lean.need()
    }

    /// How fast that changes as shares and lengths do.
    pub fn need_rate(&self, shares: [f64; 2], held: [f64; 2]) -> f64 {
        self.measure * self.lean.rate(shares, held)
    }
}

/// How much two neighbouring cells need each other. A full cell needs no help, a sliver as much as it is held along: the
/// method of Nitsche leans on no more. The weight is continuous in the cut, also as slivers come and go whose neighbours would
/// each have them be different, so the slope jump is continuous in the front.
pub(crate) struct Lean {
    /// What the region fills of each cell.
    shares: [f64; 2],
    /// Along which part of a side each cell is held, at most along a whole one.
    held: [f64; 2],
}

impl Lean {
    fn need(&self) -> f64 {
        let [a, b] = self.shares;
        let along = self.along();
        (1.0 - a.min(b)).powi(2) * (LEAST + (1.0 - LEAST) * along * (2.0 - along))
    }

    /// Of the two the smaller counts more.
    fn along(&self) -> f64 {
        let ([a, b], [of_a, of_b]) = (self.shares, self.held);
        (of_a * b + of_b * a) / (a + b).max(f64::MIN_POSITIVE)
    }

    fn rate(&self, shares: [f64; 2], held: [f64; 2]) -> f64 {
        let ([a, b], [of_a, of_b]) = (self.shares, self.held);
        let along = self.along();
        let smaller = if a < b { shares[0] } else { shares[1] };
        let grows = held[0] * b + of_a * shares[1] + held[1] * a + of_b * shares[0] - along * (shares[0] + shares[1]);
        let along_rate = grows / (a + b).max(f64::MIN_POSITIVE);
        let missing = 1.0 - a.min(b);
        let leant = LEAST + (1.0 - LEAST) * along * (2.0 - along);
        -2.0 * missing * smaller * leant + missing.powi(2) * (1.0 - LEAST) * 2.0 * (1.0 - along) * along_rate
    }
}

pub(crate) fn ghost_pairs<const D: usize>(
    membrane: &Membrane<D>,
    elements: &Elements<D>,
    quadrature: &Quadrature<D>,
    unknowns: &Unknowns,
) -> Vec<GhostPair> {
    let mut pairs = Vec::new();
    let is_cut = |cell: usize| matches!(quadrature.cells[cell], Cell::Cut(_));
    let held = held_along(membrane, quadrature);
    for (number, neighbours) in elements.neighbours.iter().enumerate() {
        let [lower, upper] = neighbours.cells;
        if !is_cut(lower) && !is_cut(upper) {
            continue;
        }
        for (region, dofs) in unknowns.of_cell(lower) {
            let Some(others) = unknowns.of(upper, region) else { continue };
            // The coefficients where the region is; outside the membrane they may not be defined.
            let x = [lower, upper]
                .iter()
                .find_map(|&cell| match &quadrature.cells[cell] {
                    Cell::Whole(_) => Some(membrane.cells.bounds_of(cell).center()),
                    Cell::Cut(rule) => rule.volume(region).first().map(|p| p.x),
                    Cell::Outside => None,
                })
                .unwrap_or_else(|| membrane.cells.bounds_of(lower).center());
            let lean = Lean {
                shares: neighbours.cells.map(|cell| share(membrane, quadrature, cell, region)),
                held: neighbours.cells.map(|cell| held.get(&cell).map_or(1.0, |along| along.min(1.0))),
            };
            let (measure, tension) = (membrane.measure.weight(&x), membrane.tension.value(&x));
            pairs.push(GhostPair {
                number,
                region,
                dofs: [dofs, others].concat(),
                cells: neighbours.cells,
                lean,
                measure,
                tension,
            });
        }
    }
    pairs
}

/// Along which part of a side the displacement is imposed in each cell; with multipliers slivers lean on other things.
fn held_along<const D: usize>(membrane: &Membrane<D>, quadrature: &Quadrature<D>) -> HashMap<usize, f64> {
    let mut along = HashMap::new();
    if membrane.formulation != Formulation::OneSided {
        return along;
    }
    let fronts = quadrature.front.iter().map(|p| (p.cell, p.x, p.weight));
    let rim = quadrature.rim.iter().map(|p| (p.cell, p.x, p.weight));
    for (cell, x, weight) in fronts.chain(rim) {
        let side = membrane.cells.volume(cell) / membrane.cells.size(cell);
        *along.entry(cell).or_insert(0.0) += weight / membrane.measure.weight(&x) / side;
    }
    along
}

/// The share of a cell that a region fills.
pub(crate) fn share<const D: usize>(
    membrane: &Membrane<D>,
    quadrature: &Quadrature<D>,
    cell: usize,
    region: RegionId,
) -> f64 {
    match &quadrature.cells[cell] {
        Cell::Cut(rule) => {
            let volume: f64 = rule.volume(region).iter().map(|p| p.weight / membrane.measure.weight(&p.x)).sum();
            (volume / membrane.cells.volume(cell)).min(1.0)
        }
        _ => 1.0,
    }
}

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
