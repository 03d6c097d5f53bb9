//! A moment on the sides of a solid: tractions without resultant.
//!
//! | symbol | meaning |
//! |---|---|
//! | `r = x - c` | arm from the centre `c = ∫x/A` of the place, where it is now (at small strain at rest); integrals over its area at rest |
//! | `J = ∫ (r² I - r rᵀ)` | |
//! | `t = ω × r` with `J ω = M` | the traction: its resultant is zero and its moment `M`, however the place has moved |
//!
//! Of all tractions with this moment it is the one with the least square. Its derivative follows from
//! `δJ ω = ∫ 2 (r·δr) ω - δr (r·ω) - r (δr·ω)`, `δω = -J⁻¹ δJ ω`.

use super::{SolidBody, axis};
use nalgebra::DMatrix;
use signorini_geometry::{Matrix, Vector};
use signorini_material::Space;
use signorini_mechanics::{Contribution, Order, PlaceError};
use std::collections::BTreeMap;

/// The least moment of inertia of a place, relative to the largest, about which it takes a moment.
const THIN: f64 = 1e-12;

impl<const D: usize> SolidBody<D> {
    pub(super) fn moment(
        &self,
        on: Option<&str>,
        moment: &Vector<3>,
        u: &[f64],
        order: Order,
        out: &mut Contribution,
    ) -> Result<(), PlaceError> {
        if self.space() == Space::Axisymmetric {
            return Err(self.unsuitable("a body about an axis takes no moment"));
        }
        if D == 2 && (moment[0] != 0.0 || moment[1] != 0.0) {
            return Err(self.unsuitable("a body in the plane takes a moment about z only"));
        }
        let moves = !self.law().is_small_strain();
        // Points with their areas and functions, each unknown by its place in a list.
        let mut places: BTreeMap<u32, usize> = BTreeMap::new();
        let mut firsts: Vec<u32> = Vec::new();
        let mut points: Vec<(Vector<3>, f64, Vec<(usize, f64)>)> = Vec::new();
        let area = self.on_sides(on, &mut |x, area, list| {
            let mut x = *x;
            let mut own = Vec::with_capacity(list.len());
            for f in list.iter().filter(|f| f.value != 0.0) {
                if moves {
                    (0..D).for_each(|i| x[i] += f.value * u[f.unknown as usize + i]);
                }
                let place = *places.entry(f.unknown).or_insert_with(|| {
                    firsts.push(f.unknown);
                    firsts.len() - 1
                });
                own.push((place, f.value));
            }
            points.push((x, area, own));
        })?;
        let centre = points.iter().map(|(x, w, _)| x * *w).sum::<Vector<3>>() / area;
        let inertia: Matrix<3> = (points.iter())
            .map(|(x, w, _)| (x - centre, *w))
            .map(|(r, w)| (Matrix::<3>::identity() * r.norm_squared() - r * r.transpose()) * w)
            .sum();
        // In the plane about z alone.
        let (least, most) = match D {
            2 => (inertia[(2, 2)], area * self.size.powi(2)),
            _ => (inertia.symmetric_eigenvalues().min(), inertia.symmetric_eigenvalues().max()),
        };
        let thin = || self.unsuitable(format!("`{}` is too thin to take a moment", on.unwrap_or("boundary")));
        if least.is_nan() || least <= THIN * most {
            return Err(thin());
        }
        let inverse = match D {
            2 => axis(2) * axis(2).transpose() / least,
            _ => inertia.try_inverse().ok_or_else(thin)?,
        };
        let omega = inverse * moment;
        for (x, w, own) in &points {
            let force = omega.cross(&(x - centre)) * *w;
            for (f, value) in own {
                (0..D).for_each(|i| out.forces[firsts[*f] as usize + i] -= value * force[i]);
            }
        }
        if !moves || order == Order::First {
            return Ok(());
        }
        // Of each unknown: its part in the centre, and what it does to ω.
        let n = D * firsts.len();
        let mut in_centre = vec![0.0; firsts.len()];
        let mut d_inertia = vec![Vector::<3>::zeros(); n];
        for (x, w, own) in &points {
            let r = x - centre;
            for (f, value) in own {
                in_centre[*f] += w * value / area;
                for i in 0..D {
                    // The centre moves too, but arms add up to nothing.
                    let e = axis(i) * (w * value);
                    d_inertia[D * f + i] += omega * (2.0 * r.dot(&e)) - e * r.dot(&omega) - r * e.dot(&omega);
                }
            }
        }
        let d_omega: Vec<Vector<3>> = d_inertia.iter().map(|d| -(inverse * d)).collect();
        let mut tangent = DMatrix::<f64>::zeros(n, n);
        // Σ w N_f r, of the arms; and Σ w N_f N_g, of the points themselves.
        let mut arms = vec![Vector::<3>::zeros(); firsts.len()];
        let mut mass = DMatrix::<f64>::zeros(firsts.len(), firsts.len());
        let mut parts = vec![0.0; firsts.len()];
        for (x, w, own) in &points {
            for (f, v) in own {
                arms[*f] += (x - centre) * (w * v);
                parts[*f] += w * v;
                own.iter().for_each(|(g, u)| mass[(*f, *g)] += w * v * u);
            }
        }
        for f in 0..firsts.len() {
            for column in 0..n {
                let (g, j) = (column / D, column % D);
                let moved = omega.cross(&axis(j)) * (mass[(f, g)] - parts[f] * in_centre[g]);
                let change = d_omega[column].cross(&arms[f]) + moved;
                (0..D).for_each(|i| tangent[(D * f + i, column)] -= change[i]);
            }
        }
        let unknowns: Vec<u32> = firsts.iter().flat_map(|f| (0..D as u32).map(move |i| f + i)).collect();
        let block: Vec<f64> = (0..n * n).map(|k| tangent[(k / n, k % n)]).collect();
        out.add_block(&unknowns, &block);
        Ok(())
    }
}
