//! Forces and tangent of cells by a stress law.
//!
//! `Π = Σ_q w_q W(F_q) + α/2 ∫ (ε - ε̄):C:(ε - ε̄)`: the law at the points in the material, and in cut cells a fictitious
//! linear elastic material of small stiffness in the whole box of the cell, which never folds whatever its deformation is
//! (Schillinger, Düster & Rank, *Int. J. Numer. Meth. Engng* 89 (2012) 1171–1202, reset it for the same reason). `C` is that of
//! the typical constants and `ε̄` the mean strain in the box: strains that are the same all over a cell, and turns of the body,
//! leave no fictitious stress. A cell holds a share `η` of material, which controls its mean strain; where that is below `α`,
//! `(α - η)⁺/2 ε̄:C:ε̄` is added.

use crate::body::CellBody;
use crate::cell::Site;
use crate::moments::box_points;
use crate::region::Filling;
use crate::space::Tabulation;
use nalgebra::{DMatrix, DVector, Matrix3};
use rayon::prelude::*;
use signorini_geometry::{Point, Vector};
use signorini_material::law::{Plastic, Response, Tensor};
use signorini_material::{Elastic, SolidMaterial, Space, StrainError, StressLaw};

/// A component of the displacement gradient: its direction, its channel (derivatives, then `N/r` around an axis), and its
/// place in a [`Tensor`].
type Component = (usize, usize, usize);

/// The functions of a cell at its points of quadrature.
pub(crate) struct CellPoints<const D: usize> {
    pub x: Vec<Point<D>>,
    /// Of the undeformed material; around an axis of the whole turn.
    pub weights: Vec<f64>,
    /// Derivatives in space, and `N/r` around an axis: a row for each function, a column for each point.
    channels: Vec<DMatrix<f64>>,
    components: &'static [Component],
}

/// What a cell adds.
pub(crate) struct CellForces {
    pub energy: f64,
    pub forces: DVector<f64>,
    pub tangent: Option<DMatrix<f64>>,
}

impl<const D: usize> CellPoints<D> {
    /// Deformation gradients for the unknowns of the cell, point after point.
    pub fn deformations(&self, own: &[f64]) -> Vec<Matrix3<f64>> {
        let n = self.channels[0].nrows();
        let along: Vec<DVector<f64>> = (0..D).map(|i| DVector::from_fn(n, |f, _| own[D * f + i])).collect();
        let mut out = vec![Matrix3::identity(); self.x.len()];
        for (i, channel, c) in self.components {
            let values = self.channels[*channel].tr_mul(&along[*i]);
            out.iter_mut().zip(values.iter()).for_each(|(f, v)| f[(c / 3, c % 3)] += v);
        }
        out
    }

    /// `Σ_q s_q:∂F_q` by each unknown, `s` told by point and component.
    fn forces(&self, stress: impl Fn(usize, usize) -> f64) -> DVector<f64> {
        let n = self.channels[0].nrows();
        let mut out = DVector::zeros(D * n);
        for (i, channel, c) in self.components {
            let values = DVector::from_fn(self.x.len(), |q, _| stress(q, *c));
            let own = &self.channels[*channel] * values;
            (0..n).for_each(|f| out[D * f + i] += own[f]);
        }
        out
    }

    /// `Σ_q ∂F_q:A_q:∂F_q`, `A` symmetric and told by point and components.
    fn tangent(&self, tangent: impl Fn(usize, usize, usize) -> f64) -> DMatrix<f64> {
        let (n, points) = self.channels[0].shape();
        let mut out = DMatrix::zeros(D * n, D * n);
        for i in 0..D {
            let rows: Vec<&Component> = self.components.iter().filter(|r| r.0 == i).collect();
            let mut left = DMatrix::<f64>::zeros(n, rows.len() * points);
            for (k, row) in rows.iter().enumerate() {
                left.columns_mut(k * points, points).copy_from(&self.channels[row.1]);
            }
            for j in i..D {
                // Points first, so that the product is one of long rows.
                let mut right = DMatrix::<f64>::zeros(n, rows.len() * points);
                for (k, row) in rows.iter().enumerate() {
                    for column in self.components.iter().filter(|s| s.0 == j) {
                        let source = &self.channels[column.1];
                        for q in 0..points {
                            let factor = tangent(q, row.2, column.2);
                            right.column_mut(k * points + q).axpy(factor, &source.column(q), 1.0);
                        }
                    }
                }
                let block = &left * right.transpose();
                for a in 0..n {
                    for b in 0..n {
                        out[(D * a + i, D * b + j)] = block[(a, b)];
                        out[(D * b + j, D * a + i)] = block[(a, b)];
                    }
                }
            }
        }
        out
    }
}

/// A traction, and how it changes.
pub(crate) struct Traction<const D: usize> {
    pub vector: Vector<D>,
    /// Of each unknown of the cell.
    pub changes: Vec<Vector<D>>,
}

impl<const D: usize> CellBody<D> {
    pub(crate) fn solid(&self) -> &SolidMaterial {
        &self.material.solid
    }

    /// The typical law.
    pub fn law(&self) -> &StressLaw {
        self.solid().law()
    }

    fn components(&self) -> &'static [Component] {
        match (D, self.space()) {
            (3, _) => {
                &[(0, 0, 0), (0, 1, 1), (0, 2, 2), (1, 0, 3), (1, 1, 4), (1, 2, 5), (2, 0, 6), (2, 1, 7), (2, 2, 8)]
            }
            (_, Space::Axisymmetric) => &[(0, 0, 0), (0, 1, 1), (0, 2, 8), (1, 0, 3), (1, 1, 4)],
            _ => &[(0, 0, 0), (0, 1, 1), (1, 0, 3), (1, 1, 4)],
        }
    }

    /// The functions of a cell at points with weights.
    fn tabulated(&self, cell: usize, points: &[(Point<D>, f64)]) -> CellPoints<D> {
        let n = self.cells()[cell].functions.len();
        let around = self.space() == Space::Axisymmetric;
        let mut channels = vec![DMatrix::zeros(n, points.len()); D + usize::from(around)];
        let mut t = Tabulation::default();
        for (q, (x, _)) in points.iter().enumerate() {
            self.functions_at(cell, x, &mut t);
            for f in 0..n {
                (0..D).for_each(|k| channels[k][(f, q)] = t.gradient[f][k]);
                if around {
                    channels[D][(f, q)] = if x[0] > 0.0 { t.value[f] / x[0] } else { t.gradient[f][0] };
                }
            }
        }
        let weights = points.iter().map(|(x, w)| w * self.turn(x)).collect();
        CellPoints { x: points.iter().map(|p| p.0).collect(), weights, channels, components: self.components() }
    }

    /// The functions of a cell at its points in the material.
    pub(crate) fn cell_points(&self, cell: usize) -> CellPoints<D> {
        self.tabulated(cell, &self.volume_points(&self.cells()[cell]))
    }

    /// The unknowns of a cell.
    pub(crate) fn own(&self, cell: usize, u: &[f64]) -> Vec<f64> {
        self.unknowns_of(cell).iter().map(|k| u[*k as usize]).collect()
    }

    fn law_at(&self, x: &Point<D>) -> (Elastic, StressLaw) {
        self.solid().at(&crate::shapes::spatial(x))
    }

    /// What the law gives at a point.
    fn response_at(&self, x: &Point<D>, f: &Matrix3<f64>, history: &[f64]) -> Result<Response, StrainError> {
        let (elastic, law) = self.law_at(x);
        Ok(law.response_in(&elastic, self.space(), f, history)?.times(self.modulus_factor(x)))
    }

    /// What the law gives at all points of a cell, of which `history` is told by number.
    pub(crate) fn responses<'a>(
        &self,
        at: &CellPoints<D>,
        own: &[f64],
        history: &dyn Fn(usize) -> &'a [f64],
    ) -> Result<Vec<Response>, StrainError> {
        let f = at.deformations(own);
        at.x.iter().zip(&f).enumerate().map(|(q, (x, f))| self.response_at(x, f, history(q))).collect()
    }

    /// What the points of a cell of a law with history came to; nothing of elastic laws.
    pub(crate) fn plastic_points<'a>(
        &self,
        at: &CellPoints<D>,
        own: &[f64],
        history: &dyn Fn(usize) -> &'a [f64],
    ) -> Vec<Plastic> {
        let of = |(q, (x, f)): (usize, (&Point<D>, &Matrix3<f64>))| {
            let (elastic, law) = self.law_at(x);
            law.plastic(&elastic, self.space(), f, history(q))
        };
        at.x.iter().zip(&at.deformations(own)).enumerate().filter_map(of).collect()
    }

    /// Energy, forces and tangent of the material in a cell.
    pub(crate) fn material_forces<'a>(
        &self,
        cell: usize,
        own: &[f64],
        history: &dyn Fn(usize) -> &'a [f64],
        with_tangent: bool,
    ) -> Result<CellForces, StrainError> {
        let at = self.cell_points(cell);
        let responses = self.responses(&at, own, history)?;
        let energy = responses.iter().zip(&at.weights).map(|(r, w)| r.energy * w).sum();
        let forces = at.forces(|q, c| at.weights[q] * responses[q].stress[c]);
        let tangent = with_tangent.then(|| at.tangent(|q, r, c| at.weights[q] * responses[q].tangent[(r, c)]));
        Ok(CellForces { energy, forces, tangent })
    }

    /// Gauss points of the whole box of a cell.
    fn box_of(&self, cell: usize) -> Vec<(Point<D>, f64)> {
        box_points(self.bounds_of(cell), self.full_points())
    }

    /// The fictitious stiffness of those of some cells that are cut: none of full ones.
    pub(crate) fn fictitious_of(&self, cells: &[usize]) -> Vec<Option<DMatrix<f64>>> {
        let alpha = self.discretisation.fictitious;
        let of = |number: &usize| {
            let number = *number;
            let cell = &self.cells()[number];
            if cell.rule.filling == Filling::Full || alpha == 0.0 {
                return None;
            }
            let points = self.box_of(number);
            let at = self.tabulated(number, &points);
            let weights: Vec<f64> = at.weights.iter().zip(&at.x).map(|(w, x)| w * self.modulus_factor(x)).collect();
            let total: f64 = weights.iter().sum();
            // The mean of each component of the gradient by the unknowns, and what stress it makes.
            let mean: Vec<DVector<f64>> =
                (0..9).map(|c| at.forces(|q, own| if own == c { weights[q] / total } else { 0.0 })).collect();
            let hooke = self.hooke();
            let mut of_mean = DMatrix::<f64>::zeros(mean[0].len(), mean[0].len());
            for (r, first) in mean.iter().enumerate() {
                for (c, second) in mean.iter().enumerate() {
                    if hooke[(r, c)] != 0.0 {
                        of_mean.ger(total * hooke[(r, c)], first, second, 1.0);
                    }
                }
            }
            let whole = at.tangent(|q, r, c| weights[q] * hooke[(r, c)]);
            Some((whole - &of_mean) * alpha + of_mean * (alpha - cell.share).max(0.0))
        };
        cells.par_iter().map(of).collect()
    }

    /// Hooke's law of the typical constants, from displacement gradient to stress.
    fn hooke(&self) -> signorini_material::law::Tensor4 {
        let mut out = signorini_material::law::Tensor4::zeros();
        for c in 0..9 {
            let mut gradient = Matrix3::zeros();
            gradient[(c / 3, c % 3)] = 1.0;
            let stress = self.elastic().stress(self.space(), &gradient);
            (0..9).for_each(|r| out[(r, c)] = stress[(r / 3, r % 3)]);
        }
        out
    }

    /// The nominal traction `P N` at a site of an elastic law, by the polynomials of a cell; at rest without displacement.
    pub(crate) fn traction_at(
        &self,
        cell: usize,
        site: &Site<D>,
        u: Option<&[f64]>,
    ) -> Result<Traction<D>, StrainError> {
        let at = self.tabulated(cell, &[(site.x, 1.0)]);
        let start = self.law().start();
        let own = u.map_or_else(|| vec![0.0; D * self.cells()[cell].functions.len()], |u| self.own(cell, u));
        let responses = self.responses(&at, &own, &|_| &start)?;
        Ok(traction(&at, &responses, &[1.0], &site.normal))
    }

    /// Cauchy stress at a point of a cell of an elastic law; not a number where the law does not cover the deformation.
    pub(crate) fn cauchy_at(&self, x: &Point<D>, f: &Matrix3<f64>) -> Matrix3<f64> {
        let (elastic, law) = self.law_at(x);
        match self.response_at(x, f, &law.start()) {
            Ok(at) => law.cauchy(&elastic, self.space(), f, &at.stress, &law.start()),
            Err(_) => Matrix3::repeat(f64::NAN),
        }
    }

    /// Cauchy stress from a first Piola stress at a point.
    pub(crate) fn cauchy_from(&self, x: &Point<D>, f: &Matrix3<f64>, piola: &Tensor, history: &[f64]) -> Matrix3<f64> {
        let (elastic, law) = self.law_at(x);
        law.cauchy(&elastic, self.space(), f, piola, history)
    }

    /// Principal stretches at a point at which a hyperelastic law is not stable.
    pub(crate) fn unstable_at(&self, x: &Point<D>, f: &Matrix3<f64>) -> Option<[f64; 3]> {
        let (elastic, law) = self.law_at(x);
        law.unstable(&elastic, self.space(), f)
    }
}

/// The traction of the stresses at points of a cell, each with its share.
pub(crate) fn traction<const D: usize>(
    at: &CellPoints<D>,
    responses: &[Response],
    shares: &[f64],
    normal: &Vector<D>,
) -> Traction<D> {
    let along = |i: usize| -> (f64, DVector<f64>) {
        let value = |q: usize| -> f64 { (0..D).map(|j| responses[q].stress[3 * i + j] * normal[j]).sum() };
        let change = |q: usize, c: usize| -> f64 {
            shares[q] * (0..D).map(|j| responses[q].tangent[(3 * i + j, c)] * normal[j]).sum::<f64>()
        };
        (shares.iter().enumerate().map(|(q, s)| s * value(q)).sum(), at.forces(change))
    };
    let parts: Vec<(f64, DVector<f64>)> = (0..D).map(along).collect();
    let unknowns = parts[0].1.len();
    Traction {
        vector: Vector::<D>::from_fn(|i, _| parts[i].0),
        changes: (0..unknowns).map(|k| Vector::<D>::from_fn(|i, _| parts[i].1[k])).collect(),
    }
}
