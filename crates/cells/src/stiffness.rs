//! The elastic integrals of a cell.
//!
//! With `G_ab = ∫ ∂_a N_i ∂_b N_j` the stiffness between the components `a` of function `i` and `b` of function `j` is
//! `λ G_ab + μ (G_ba + δ_ab Σ_c G_cc)`: matrix products over all points at once. Around an axis `N/r` is one more
//! derivative, of the hoop strain. No points are needed outside the material: `K = α K_full + (1 - α) K_in`.
//!
//! The many points of a cut cell, or of voxels with a modulus each, are first turned into weights of `(2p + 1)^D` fixed ones,
//! by which the products of derivatives are integrated alike, direction by direction. For voxels that is the same sum as of
//! matrices computed beforehand for each of them, `Σ_v E_v K_v`, for the weights of points in place of the entries of
//! matrices.

use crate::body::CellBody;
use crate::cell::{Cell, Site};
use crate::moments::box_points;
use crate::moments::fitted;
use crate::region::Filling;
use crate::space::Tabulation;
use crate::tensor_integrals::TensorFunctions;
use nalgebra::{DMatrix, Matrix3};
use rayon::prelude::*;
use signorini_geometry::{Matrix, Point, Vector};
use signorini_material::{Space, StressLaw};
use std::sync::Arc;

/// Fictitious stiffness above which that of cut cells stays positive definite whatever rounding leaves of the fitted weights:
/// some thousand times the unit of rounding, for sums of polynomials that are larger than what they sum up to.
const FITTED_ABOVE: f64 = 1e4 * f64::EPSILON;

impl<const D: usize> CellBody<D> {
    /// The unknowns of a cell: all components of its functions.
    pub fn unknowns_of(&self, cell: usize) -> Vec<u32> {
        let functions = &self.cells()[cell].functions;
        functions.iter().flat_map(|f| (0..D as u32).map(move |k| D as u32 * f + k)).collect()
    }

    /// The stiffness matrices of all cells, at rest.
    pub fn stiffness(&self) -> Vec<Arc<DMatrix<f64>>> {
        self.stiffness_of(&(0..self.cells().len()).collect::<Vec<_>>())
    }

    /// The stiffness matrices of some cells, at rest.
    pub(crate) fn stiffness_of(&self, cells: &[usize]) -> Vec<Arc<DMatrix<f64>>> {
        if !self.is_hooke_at_rest() {
            return self.stiffness_by_law(cells);
        }
        let alike = self.is_homogeneous();
        let on_grid = |cell: &&Cell<D>| self.tree.leaves()[cell.leaf].level == 0;
        // Cells of the grid differ in their place only.
        let shared = self.cells().iter().find(|c| alike && on_grid(c)).map(|c| Arc::new(self.full_stiffness(c)));
        (cells.par_iter())
            .map(|number| {
                let cell = &self.cells()[*number];
                let full = match &shared {
                    Some(shared) if on_grid(&cell) => shared.clone(),
                    _ => Arc::new(self.full_stiffness(cell)),
                };
                if cell.rule.filling == Filling::Full {
                    return full;
                }
                let alpha = self.discretisation.fictitious;
                let points = self.weighted(cell.rule.volume.iter().map(|p| (p.x, p.weight)));
                let order = 2 * self.degree() + 1;
                let fits = self.material.space != Space::Axisymmetric
                    && alpha > FITTED_ABOVE
                    && points.len() >= order.pow(D as u32);
                let inside = if fits {
                    // The modulus of every voxel is in the weights.
                    let fit = fitted(&self.tree.leaves()[cell.leaf].bounds, order, points.into_iter());
                    self.integrate_on_grid(cell, order, &fit.iter().map(|p| p.weight).collect::<Vec<_>>())
                } else {
                    self.integrate(cell, &points)
                };
                Arc::new(inside * (1.0 - alpha) + &*full * alpha)
            })
            .collect()
    }

    /// Whether the law is that of Hooke at rest, with the typical constants.
    fn is_hooke_at_rest(&self) -> bool {
        let law = self.law();
        !self.solid().varies() && law.fibre_direction().is_none() && !matches!(law, StressLaw::Orthotropic(_))
    }

    fn stiffness_by_law(&self, cells: &[usize]) -> Vec<Arc<DMatrix<f64>>> {
        let fictitious = self.fictitious_of(cells);
        let start = self.law().start();
        let of = |(cell, fictitious): (&usize, &Option<DMatrix<f64>>)| {
            let cell = *cell;
            let own = vec![0.0; D * self.cells()[cell].functions.len()];
            let found = self.material_forces(cell, &own, &|_| &start, true).ok().and_then(|f| f.tangent);
            let inside = found.unwrap_or_else(|| DMatrix::zeros(own.len(), own.len()));
            Arc::new(fictitious.as_ref().map_or_else(|| inside.clone(), |f| &inside + f))
        };
        cells.par_iter().zip(&fictitious).map(of).collect()
    }

    fn full_stiffness(&self, cell: &Cell<D>) -> DMatrix<f64> {
        let order = self.full_points();
        let points = self.weighted(box_points(&self.tree.leaves()[cell.leaf].bounds, order).into_iter());
        if self.material.space == Space::Axisymmetric {
            return self.integrate(cell, &points);
        }
        self.integrate_on_grid(cell, order, &points.iter().map(|p| p.1).collect::<Vec<_>>())
    }

    /// Points with their weights times the modulus there, and the circumference around an axis.
    fn weighted(&self, points: impl Iterator<Item = (Point<D>, f64)>) -> Vec<(Point<D>, f64)> {
        points.map(|(x, w)| (x, w * self.turn(&x) * self.modulus_factor(&x))).collect()
    }

    fn integrate(&self, cell: &Cell<D>, points: &[(Point<D>, f64)]) -> DMatrix<f64> {
        let n = cell.functions.len();
        let axis = self.material.space == Space::Axisymmetric;
        let leaf = &self.tree.leaves()[cell.leaf];
        let channels = D + usize::from(axis);
        let mut g: Vec<DMatrix<f64>> = vec![DMatrix::zeros(n, n); channels * channels];
        let mut t = Tabulation::default();
        // As many points at a time as fit into a cache.
        for chunk in points.chunks(512) {
            let mut b: Vec<DMatrix<f64>> = vec![DMatrix::zeros(n, chunk.len()); channels];
            let mut weighted = b.clone();
            for (q, (x, w)) in chunk.iter().enumerate() {
                crate::space::tabulate(&self.tree, leaf, self.degree(), &cell.modes, x, &mut t);
                for i in 0..n {
                    for a in 0..D {
                        b[a][(i, q)] = t.gradient[i][a];
                        weighted[a][(i, q)] = w * t.gradient[i][a];
                    }
                    if axis {
                        b[D][(i, q)] = t.value[i] / x[0];
                        weighted[D][(i, q)] = w * t.value[i] / x[0];
                    }
                }
            }
            for a in 0..channels {
                let transposed = weighted[a].transpose();
                for c in a..channels {
                    // G_ca = ∂_c N_i ∂_a N_j.
                    g[c * channels + a].gemm(1.0, &b[c], &transposed, 1.0);
                }
            }
        }
        self.stiffness_from(g)
    }

    /// Over `order` Gauss points of the leaf in each direction, with weights of their own.
    fn integrate_on_grid(&self, cell: &Cell<D>, order: usize, weights: &[f64]) -> DMatrix<f64> {
        let leaf = &self.tree.leaves()[cell.leaf];
        let functions = TensorFunctions::new(&self.tree, leaf, self.degree(), &cell.modes, order);
        let of = |a: usize, c: usize| if c <= a { functions.products(weights, [a, c]) } else { DMatrix::zeros(0, 0) };
        self.stiffness_from((0..D * D).map(|k| of(k / D, k % D)).collect())
    }

    /// The stiffness from the integrals `G_ac` with `c <= a`.
    fn stiffness_from(&self, mut g: Vec<DMatrix<f64>>) -> DMatrix<f64> {
        let axis = self.material.space == Space::Axisymmetric;
        let (lambda, mu) = self.material.elastic().lame(self.material.space);
        let channels = D + usize::from(axis);
        let n = g[0].nrows();
        for a in 0..channels {
            for c in a + 1..channels {
                g[a * channels + c] = g[c * channels + a].transpose();
            }
        }
        let mut k = DMatrix::zeros(D * n, D * n);
        for i in 0..n {
            for j in 0..n {
                let at = |a: usize, c: usize| g[a * channels + c][(i, j)];
                let trace: f64 = (0..D).map(|c| at(c, c)).sum();
                for a in 0..D {
                    for c in 0..D {
                        let mut value = lambda * at(a, c) + mu * at(c, a);
                        if a == c {
                            value += mu * trace;
                        }
                        if axis {
                            if a == 0 {
                                value += lambda * at(D, c);
                            }
                            if c == 0 {
                                value += lambda * at(a, D);
                            }
                            if a == 0 && c == 0 {
                                value += (lambda + 2.0 * mu) * at(D, D);
                            }
                        }
                        k[(D * i + a, D * j + c)] = value;
                    }
                }
            }
        }
        k
    }

    /// Whether the stiffness of a full cell does not depend on where it lies.
    fn is_homogeneous(&self) -> bool {
        self.material.modulus.is_none() && self.material.space != Space::Axisymmetric
    }

    /// The factor of Young's modulus at a point, kept above the fictitious stiffness.
    pub(crate) fn modulus_factor(&self, x: &Point<D>) -> f64 {
        match &self.material.modulus {
            Some((factor, most)) => factor(x).max(self.discretisation.fictitious * most),
            None => 1.0,
        }
    }

    /// The traction `σ(N_j e_b) n` at rest of every unknown of a cell at a site, from its functions there.
    pub fn tractions(&self, cell: usize, site: &Site<D>, t: &Tabulation<D>) -> Vec<Vector<D>> {
        let (x, normal) = (&site.x, &site.normal);
        if !self.is_hooke_at_rest() {
            return self.traction_at(cell, site, None).map(|found| found.changes).unwrap_or_default();
        }
        let (lambda, mu) = self.material.elastic().lame(self.material.space);
        let factor = self.modulus_factor(x);
        let mut out = Vec::with_capacity(D * t.value.len());
        for (value, gradient) in t.value.iter().zip(&t.gradient) {
            let along = gradient.dot(normal);
            for b in 0..D {
                let mut divergence = gradient[b];
                if b == 0 && self.material.space == Space::Axisymmetric {
                    divergence += value / x[0];
                }
                let mut traction = normal * (lambda * divergence) + gradient * (mu * normal[b]);
                traction[b] += mu * along;
                out.push(traction * factor);
            }
        }
        out
    }

    /// The traction `σ n` of isotropic Hooke's law at a site, by a displacement and its gradient; none of another law.
    pub fn hooke_traction(&self, site: &Site<D>, displacement: &Vector<D>, gradient: &Matrix<D>) -> Option<Vector<D>> {
        if !self.law().is_linear() || !self.is_hooke_at_rest() {
            return None;
        }
        let (lambda, mu) = self.material.elastic().lame(self.material.space);
        let hoop = if self.material.space == Space::Axisymmetric { displacement[0] / site.x[0] } else { 0.0 };
        let normal = &site.normal;
        let traction = normal * (lambda * (gradient.trace() + hoop)) + (gradient + gradient.transpose()) * normal * mu;
        Some(traction * self.modulus_factor(&site.x))
    }

    /// The Cauchy stress at a point of a cell of an elastic law, from the gradient of the displacement there, in space.
    pub fn stress_at(&self, x: &Point<D>, gradient: &Matrix3<f64>) -> Matrix3<f64> {
        if !self.solid().is_uniform_hooke() {
            return self.cauchy_at(x, &(Matrix3::identity() + gradient));
        }
        self.material.elastic().stress(self.material.space, gradient) * self.modulus_factor(x)
    }
}
