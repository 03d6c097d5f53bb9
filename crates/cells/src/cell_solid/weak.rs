//! Places on the recovered boundary held by Nitsche's method: for each component `d` that is held, with `t = σ(u) n`,
//!
//! `-∫ (d·t(u)) (d·v) - ∫ (d·t(v)) (d·u - ū) + ∫ γ (d·u - ū) (d·v)`,
//!
//! `γ` as in `nitsche`. With a unit translation for `v` its stress vanishes, and the terms are minus the
//! force of the support: `∫ d·t(u) - γ (d·u - ū)`.

use super::CellSolid;
use crate::cell::Site;
use crate::nitsche::{NitschePart, RowSpace, Rows};
use crate::shapes::spatial;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use signorini_geometry::Vector;
use signorini_mechanics::{Contribution, Hold, Order};
use std::sync::OnceLock;

/// The points of a place in one cell.
pub(super) struct Group<const D: usize> {
    pub rows: RowSpace,
    pub sites: Vec<Site<D>>,
    pub gamma: f64,
    /// The terms in `u` of each component, made when they are first asked for.
    matrices: [OnceLock<DMatrix<f64>>; D],
}

/// A place that is held.
pub(super) struct WeakHold<const D: usize> {
    pub groups: Vec<Group<D>>,
}

impl<const D: usize> WeakHold<D> {
    pub fn new(solid: &CellSolid<D>, sites: &[Site<D>]) -> Self {
        let parts = solid.body.nitsche_parts(sites, |cells| solid.stiffness_of(cells));
        let group = |part: NitschePart<D>| Group {
            rows: RowSpace::new(&solid.body, part.cell, part.stress_cell),
            sites: part.sites,
            gamma: part.gamma,
            matrices: std::array::from_fn(|_| OnceLock::new()),
        };
        WeakHold { groups: parts.into_iter().map(group).collect() }
    }
}

impl<const D: usize> Group<D> {
    /// Rows of displacement and traction along a component at a point.
    fn rows_at(&self, solid: &CellSolid<D>, site: &Site<D>, component: usize) -> [DVector<f64>; 2] {
        let at: Rows<'_, D> = self.rows.at(&solid.body, site);
        let d = Vector::<D>::from_fn(|k, _| f64::from(u8::from(k == component)));
        let mut rows = [at.displacement(&d), at.traction(&d)];
        for (i, unknown) in self.rows.unknowns.iter().enumerate() {
            if solid.is_zero[*unknown as usize] {
                rows.iter_mut().for_each(|r| r[i] = 0.0);
            }
        }
        rows
    }

    fn matrix(&self, solid: &CellSolid<D>, component: usize) -> &DMatrix<f64> {
        self.matrices[component].get_or_init(|| {
            let (displacements, halves): (Vec<DVector<f64>>, Vec<DVector<f64>>) = (self.sites.iter())
                .map(|site| {
                    let [v, t] = self.rows_at(solid, site, component);
                    let half = (&v * (0.5 * self.gamma) - t) * site.weight;
                    (v, half)
                })
                .unzip();
            // γ v vᵀ - v tᵀ - t vᵀ is one half of it and its mirror image.
            let half = DMatrix::from_columns(&displacements) * DMatrix::from_columns(&halves).transpose();
            &half + half.transpose()
        })
    }
}

impl<const D: usize> CellSolid<D> {
    /// Adds the terms of a place that is held; gives the force of the support.
    pub(super) fn add_terms(
        &self,
        terms: &WeakHold<D>,
        hold: &Hold<'_>,
        u: &[f64],
        order: Order,
        out: &mut Contribution,
    ) -> Vector<3> {
        let mut force = Vector::<3>::zeros();
        for k in 0..D {
            let Some(field) = hold.displacement[k] else { continue };
            // Fields need not be shared between threads.
            let wanted: Vec<Vec<f64>> =
                terms.groups.iter().map(|g| g.sites.iter().map(|s| field(&spatial(&s.x))).collect()).collect();
            let forces: Vec<DVector<f64>> = (terms.groups.par_iter().zip(&wanted))
                .map(|(group, wanted)| {
                    let own = group.rows.unknowns.iter().map(|i| u[*i as usize]);
                    let mut r = group.matrix(self, k) * DVector::from_iterator(group.rows.unknowns.len(), own);
                    for (site, value) in group.sites.iter().zip(wanted).filter(|(_, v)| **v != 0.0) {
                        let [v, t] = group.rows_at(self, site, k);
                        r -= (v * group.gamma - t) * (site.weight * value);
                    }
                    r
                })
                .collect();
            for (group, r) in terms.groups.iter().zip(&forces) {
                for (unknown, r) in group.rows.unknowns.iter().zip(r) {
                    let unknown = *unknown as usize;
                    out.forces[unknown] += r;
                    if unknown % D == k {
                        force[k] -= self.linear.one[unknown / D] * r;
                    }
                }
                if order == Order::Second {
                    out.add_block(&group.rows.unknowns, group.matrix(self, k).as_slice());
                }
            }
        }
        force
    }
}
