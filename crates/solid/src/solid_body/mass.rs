//! The mass of a solid, and where it is of surfaces that touch.
//!
//! `M_ab = ∫ ρ N_a N_b`. Functions on surfaces that may touch carry no mass of their own (Khenous, Laborde and Renard 2008): each
//! moves with inner ones, `N_c → Σ w_ci N_i`, with weights that reproduce all linear fields. So `M̃ = Pᵀ M P`, with these weights in
//! `P`, has the mass, the centre of mass and the moments of inertia of the body: `P` leaves its rigid motions as they are.

use super::SolidBody;
use super::projection::functions;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use signorini_fem::small::determinant;
use signorini_mechanics::{Mass, PlaceError};
use std::collections::{BTreeMap, BTreeSet};

/// Thickness of a set of vertices relative to its extent, squared, from which it spans space: weights are not large then.
const SPANS: f64 = 1e-3;
/// Layers of cells in which vertices with a mass are sought.
const MOST_LAYERS: usize = 4;

/// By which inner functions each function without a mass moves.
type Weights = BTreeMap<u32, Vec<(u32, f64)>>;

impl<const D: usize> SolidBody<D> {
    /// The solid with a mass per volume.
    #[must_use]
    pub fn with_density(mut self, density: f64) -> Self {
        self.density = Some(density);
        self
    }

    pub(super) fn mass_with(&self, density: f64, touching: &[Option<&str>]) -> Result<Mass, PlaceError> {
        let body = self.body();
        let mut on_surface = BTreeSet::new();
        for on in touching {
            if !on.is_some_and(|name| self.edges.contains_key(name)) {
                on_surface.extend(functions(body, self.group(*on)?));
            }
        }
        // Where too little is inside, the surface keeps its mass.
        let weights = self.weights(&on_surface).unwrap_or_default();
        let of = |cell: usize| {
            let list: Vec<(u32, f64)> = body.dofs.cell(cell).collect();
            let own = self.cell_mass(cell, density);
            let mut terms: BTreeMap<u32, Vec<(usize, f64)>> = BTreeMap::new();
            for (a, (f, sign)) in list.iter().enumerate() {
                match weights.get(f) {
                    Some(inner) => inner.iter().for_each(|(i, w)| terms.entry(*i).or_default().push((a, sign * w))),
                    None => terms.entry(*f).or_default().push((a, *sign)),
                }
            }
            let unknowns: Vec<u32> = terms.keys().flat_map(|f| (0..D as u32).map(move |i| D as u32 * f + i)).collect();
            let terms: Vec<&Vec<(usize, f64)>> = terms.values().collect();
            let n = unknowns.len();
            let mut values = vec![0.0; n * n];
            for (p, of_p) in terms.iter().enumerate() {
                for (q, of_q) in terms.iter().enumerate() {
                    let pairs = of_p.iter().flat_map(|a| of_q.iter().map(move |b| (a, b)));
                    let value: f64 = pairs.map(|((a, v), (b, w))| v * w * own[(*a, *b)]).sum();
                    (0..D).for_each(|i| values[(D * p + i) * n + D * q + i] = value);
                }
            }
            (unknowns, values)
        };
        let blocks = (0..body.mesh.cell_count()).into_par_iter().map(of).collect();
        Ok(Mass { blocks, spins: Vec::new() })
    }

    /// `∫ ρ N_a N_b` of the functions of a cell.
    fn cell_mass(&self, cell: usize, density: f64) -> DMatrix<f64> {
        let body = self.body();
        let table = self.table(cell);
        let n = body.dofs.basis(cell).len();
        let mut out = DMatrix::<f64>::zeros(n, n);
        for (q, (_, w)) in table.points.iter().enumerate() {
            let (x, jacobian) = body.mesh.jacobian(cell, &table.map[q]);
            let value = DVector::from_column_slice(&table.basis[q].value);
            out.ger(density * w * determinant(&jacobian) * self.bodies.measure(&x), &value, &value, 1.0);
        }
        out
    }

    /// The weights of all functions on a surface; none where there are too few vertices inside to move with.
    fn weights(&self, on_surface: &BTreeSet<u32>) -> Option<Weights> {
        let body = self.body();
        let mut cells: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for cell in 0..body.mesh.cell_count() {
            body.dofs.functions(cell).iter().for_each(|f| cells.entry(*f).or_default().push(cell as u32));
        }
        let mut is_vertex = vec![false; body.dofs.count()];
        body.unity_unknowns().for_each(|k| is_vertex[k / D] = true);
        let of = |c: u32| {
            let mut around = BTreeSet::from([c]);
            for _ in 0..MOST_LAYERS {
                let layer: BTreeSet<u32> = around.iter().flat_map(|f| &cells[f]).copied().collect();
                around = layer.iter().flat_map(|cell| body.dofs.functions(*cell as usize)).copied().collect();
                let inner: Vec<u32> =
                    around.iter().copied().filter(|f| is_vertex[*f as usize] && !on_surface.contains(f)).collect();
                if let Some(weights) = self.weights_by(c, is_vertex[c as usize], &inner) {
                    return Some(weights);
                }
            }
            None
        };
        on_surface.iter().map(|c| Some((*c, of(*c)?))).collect()
    }

    /// The smallest weights of inner vertices that reproduce linear fields at a function of the surface, nearer ones more; none of
    /// vertices that do not span space.
    fn weights_by(&self, c: u32, is_vertex: bool, inner: &[u32]) -> Option<Vec<(u32, f64)>> {
        let middle = inner.iter().map(|f| self.position[*f as usize]).sum::<signorini_geometry::Point<D>>()
            / inner.len().max(1) as f64;
        let unity = f64::from(u8::from(is_vertex));
        let at = self.position[c as usize] - middle * unity;
        let about = if is_vertex { self.position[c as usize] } else { middle };
        let away = |f: &u32| (self.position[*f as usize] - about).norm_squared();
        let extent = inner.iter().map(away).fold(0.0, f64::max).sqrt();
        if inner.len() <= D || extent == 0.0 {
            return None;
        }
        let row = |f: u32| {
            let x = (self.position[f as usize] - middle) / extent;
            DVector::from_iterator(D + 1, std::iter::once(1.0).chain(x.iter().copied()))
        };
        let mut moments = DMatrix::<f64>::zeros(D + 1, D + 1);
        let mut spread = DMatrix::<f64>::zeros(D, D);
        let nearness = |f: &u32| 1.0 / (away(f) / (extent * extent)).max(f64::EPSILON);
        for f in inner {
            let own = row(*f);
            moments.ger(nearness(f), &own, &own, 1.0);
            spread.ger(1.0 / inner.len() as f64, &own.rows(1, D), &own.rows(1, D), 1.0);
        }
        let sizes = spread.symmetric_eigenvalues();
        if sizes.min() < SPANS * sizes.max() {
            return None;
        }
        let wanted = DVector::from_iterator(D + 1, std::iter::once(unity).chain(at.iter().map(|v| v / extent)));
        let solved = moments.cholesky()?.solve(&wanted);
        Some(inner.iter().map(|f| (*f, nearness(f) * row(*f).dot(&solved))).filter(|(_, w)| *w != 0.0).collect())
    }
}
