//! Stress and displacement on the recovered boundary, by which Nitsche's method holds it, and the stabilisation `γ` of that.
//!
//! `γ = 2 λ_c`, `λ_c` the largest eigenvalue of `∫_{Γ_c} t(u)·t(v)` with the tractions `t = σ(u) n` against the energy of the
//! cell. A cell with little material does not control its own stress: the polynomials of a neighbour with more of it, carried
//! on to this cell, give `t` there, so that `γ` stays bounded however small the cut.

use crate::body::CellBody;
use crate::cell::Site;
use crate::space::Tabulation;
use nalgebra::{DMatrix, DVector};
use signorini_geometry::Vector;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Points of the boundary in one cell, the cell that gives the stress there, and `γ`.
pub(crate) struct NitschePart<const D: usize> {
    pub cell: usize,
    pub stress_cell: usize,
    pub sites: Vec<Site<D>>,
    pub gamma: f64,
}

impl<const D: usize> CellBody<D> {
    /// Points of the boundary by the cells that they lie in, with the stabilisation of Nitsche's method there; `stiffness` is that of
    /// some cells.
    pub(crate) fn nitsche_parts(
        &self,
        sites: &[Site<D>],
        stiffness: impl Fn(&[usize]) -> Vec<Arc<DMatrix<f64>>>,
    ) -> Vec<NitschePart<D>> {
        // By the cell that gives the stress.
        let mut groups: BTreeMap<usize, Vec<&Site<D>>> = BTreeMap::new();
        for site in sites {
            groups.entry(self.cells()[site.cell].stress_cell).or_default().push(site);
        }
        let stiffness = stiffness(&groups.keys().copied().collect::<Vec<_>>());
        let mut out = Vec::new();
        for ((stress_cell, sites), stiffness) in groups.into_iter().zip(stiffness) {
            let gamma = 2.0 * self.trace_constant(stress_cell, &sites, &stiffness);
            let mut by_cell: BTreeMap<usize, Vec<Site<D>>> = BTreeMap::new();
            sites.iter().for_each(|s| by_cell.entry(s.cell).or_default().push(**s));
            out.extend(by_cell.into_iter().map(|(cell, sites)| NitschePart { cell, stress_cell, sites, gamma }));
        }
        out
    }

    /// The largest `∫ |t(u)|²` over some boundary for a unit energy of the cell, by the power method: the energy is scaled
    /// by its diagonal, and rigid motions, which have no stress, get some.
    fn trace_constant(&self, cell: usize, sites: &[&Site<D>], stiffness: &DMatrix<f64>) -> f64 {
        let n = stiffness.nrows();
        let scale: Vec<f64> = (0..n).map(|i| 1.0 / stiffness[(i, i)].max(f64::MIN_POSITIVE).sqrt()).collect();
        let mut g = DMatrix::<f64>::zeros(n, n);
        let mut t = Tabulation::default();
        for site in sites {
            self.functions_at(cell, &site.x, &mut t);
            let tractions = self.tractions(cell, site, &t);
            for k in 0..D {
                let row = DVector::from_fn(n, |i, _| tractions[i][k] * scale[i]);
                g.ger(site.weight, &row, &row, 1.0);
            }
        }
        let mut shift = 1e-11;
        let factor = loop {
            let a = DMatrix::from_fn(n, n, |i, j| {
                stiffness[(i, j)] * scale[i] * scale[j] + if i == j { shift } else { 0.0 }
            });
            match a.cholesky() {
                Some(factor) => break factor,
                None => shift *= 10.0,
            }
        };
        let mut v = DVector::from_fn(n, |i, _| 1.0 + 0.5 * (1.7 * i as f64).sin());
        let mut value = 0.0;
        for _ in 0..60 {
            let norm = v.dot(&(&g * &v)).sqrt();
            if norm == 0.0 {
                break;
            }
            v /= norm;
            // G A⁻¹ G v over G: the Rayleigh quotient of the next step.
            let image = factor.solve(&(&g * &v));
            let next = image.dot(&(&g * &v));
            let change = (next - value).abs();
            value = next;
            v = image;
            if change <= 1e-3 * value {
                break;
            }
        }
        value
    }
}

/// Rows of displacement and traction at points of a cell, over the unknowns of it and of the cell that gives the stress.
pub(crate) struct RowSpace {
    cell: usize,
    stress_cell: usize,
    pub unknowns: Vec<u32>,
    /// Places of the unknowns of the cell of stress.
    places: Vec<usize>,
}

/// The rows at one point.
pub(crate) struct Rows<'a, const D: usize> {
    space: &'a RowSpace,
    values: Vec<f64>,
    tractions: Vec<Vector<D>>,
}

impl RowSpace {
    pub fn new<const D: usize>(body: &CellBody<D>, cell: usize, stress_cell: usize) -> Self {
        let mut unknowns = body.unknowns_of(cell);
        let mut number: BTreeMap<u32, usize> = unknowns.iter().enumerate().map(|(i, u)| (*u, i)).collect();
        let places = (body.unknowns_of(stress_cell).into_iter())
            .map(|u| {
                *number.entry(u).or_insert_with(|| {
                    unknowns.push(u);
                    unknowns.len() - 1
                })
            })
            .collect();
        RowSpace { cell, stress_cell, unknowns, places }
    }

    pub fn cell(&self) -> usize {
        self.cell
    }

    pub fn stress_cell(&self) -> usize {
        self.stress_cell
    }

    /// Where the unknowns of the cell of stress stand among all.
    pub fn places(&self) -> &[usize] {
        &self.places
    }

    pub fn at<const D: usize>(&self, body: &CellBody<D>, site: &Site<D>) -> Rows<'_, D> {
        let mut t = Tabulation::default();
        body.functions_at(self.stress_cell, &site.x, &mut t);
        let tractions = body.tractions(self.stress_cell, site, &t);
        if self.cell != self.stress_cell {
            body.functions_at(self.cell, &site.x, &mut t);
        }
        Rows { space: self, values: t.value, tractions }
    }
}

impl<const D: usize> Rows<'_, D> {
    /// `d·u` as a row.
    pub fn displacement(&self, direction: &Vector<D>) -> DVector<f64> {
        let mut row = DVector::zeros(self.space.unknowns.len());
        for (f, value) in self.values.iter().enumerate() {
            (0..D).for_each(|k| row[D * f + k] = direction[k] * value);
        }
        row
    }

    /// `d·t(u)` as a row.
    pub fn traction(&self, direction: &Vector<D>) -> DVector<f64> {
        let mut row = DVector::zeros(self.space.unknowns.len());
        for (place, traction) in self.space.places.iter().zip(&self.tractions) {
            row[*place] += direction.dot(traction);
        }
        row
    }
}
