//! Displacement and stress: at a point, on an even lattice, and of the body as a whole.

use crate::body::CellBody;
use crate::shapes::spatial;
use crate::space::Tabulation;
use nalgebra::Matrix3;
use rayon::prelude::*;
use signorini_fem::cut::End;
use signorini_geometry::{Matrix, Point, Vector};
use signorini_material::{Space, von_mises};
use signorini_mechanics::{Means, Samples};

/// The state of a body at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointState<const D: usize> {
    pub displacement: Vector<D>,
    /// `∂u_i / ∂x_j`.
    pub gradient: Matrix<D>,
    /// Cauchy stress, in space; around an axis the third direction is that around it.
    pub stress: Matrix3<f64>,
    /// Equivalent plastic strain; zero of elastic laws.
    pub plastic_strain: f64,
}

impl<const D: usize> CellBody<D> {
    /// The state at a point of a cell, for coefficients of the functions; without stress of a law with history.
    pub fn state_at(&self, cell: usize, x: &Point<D>, u: &[f64]) -> PointState<D> {
        let mut t = Tabulation::default();
        self.functions_at(cell, x, &mut t);
        let (mut displacement, mut gradient) = (Vector::<D>::zeros(), Matrix::<D>::zeros());
        for (f, (value, slope)) in self.cells()[cell].functions.iter().zip(t.value.iter().zip(&t.gradient)) {
            let c = Vector::<D>::from_fn(|k, _| u[D * *f as usize + k]);
            displacement += c * *value;
            gradient += c * slope.transpose();
        }
        let mut in_space = Matrix3::zeros();
        for i in 0..D {
            for j in 0..D {
                in_space[(i, j)] = gradient[(i, j)];
            }
        }
        if self.space() == Space::Axisymmetric {
            in_space[(2, 2)] = if x[0] > 0.0 { displacement[0] / x[0] } else { gradient[(0, 0)] };
        }
        let is_elastic = !self.law().has_history();
        let stress = if is_elastic { self.stress_at(x, &in_space) } else { Matrix3::repeat(f64::NAN) };
        PointState { displacement, gradient, stress, plastic_strain: 0.0 }
    }

    /// The same with the stress of a neighbour in a cell with little material.
    pub(crate) fn shown_at(&self, cell: usize, x: &Point<D>, u: &[f64]) -> PointState<D> {
        let mut state = self.state_at(cell, x, u);
        let stress_cell = self.cells()[cell].stress_cell;
        if stress_cell != cell {
            state.stress = self.state_at(stress_cell, x, u).stress;
        }
        state
    }

    /// The body as a piece of a material that fills its box; none around an axis, where a box is a ring.
    /// `stress` gives the integral of the normal stresses (nominal ones at finite strain) over the material of a cell.
    pub(crate) fn means_of(&self, u: &[f64], stress: &(dyn Fn(usize) -> Vector<3> + Sync)) -> Option<Means> {
        if self.space() == Space::Axisymmetric {
            return None;
        }
        let parts: Vec<Vector<3>> = (0..self.cells().len()).into_par_iter().map(stress).collect();
        let bounds = *self.tree().bounds();
        let mut out = Means { stress: (parts.iter().sum::<Vector<3>>() / bounds.volume()).into(), ..Means::default() };
        for k in 0..D {
            let moved = |end: End| -> Option<f64> {
                let (mut sum, mut area) = (0.0, 0.0);
                let at = end.of(&bounds, k);
                for leaf in self.tree().leaves().iter().filter(|l| end.of(&l.bounds, k) == at) {
                    for p in self.region.side_rule(&leaf.bounds, k, end, self.degree() + 1) {
                        let Some(cell) = self.cell_at(&p.x) else { continue };
                        sum += p.weight * self.state_at(cell, &p.x, u).displacement[k];
                        area += p.weight;
                    }
                }
                (area > 0.0).then(|| sum / area)
            };
            out.strain[k] = moved(End::High).zip(moved(End::Low)).map(|(high, low)| (high - low) / bounds.size()[k]);
        }
        Some(out)
    }

    /// Displacement and stress in the middle of equal boxes that fill the box of the cells, as many along each cell of the
    /// grid as the degree; zero where there is no material. The stress of a cell with little material is that of its
    /// neighbour.
    pub(crate) fn samples_of(&self, shown: &(dyn Fn(usize, &Point<D>) -> PointState<D> + Sync)) -> Samples {
        let bounds = self.tree().bounds();
        let counts: [usize; D] = self.tree().cells().map(|n| n * self.degree());
        let state_in = |number: usize| {
            let mut rest = number;
            let x = bounds.at(&Point::from_fn(|k, _| {
                let i = rest % counts[k];
                rest /= counts[k];
                (i as f64 + 0.5) / counts[k] as f64
            }));
            let cell = self.cell_at(&x).filter(|_| self.region.contains(&x))?;
            Some(shown(cell, &x))
        };
        let states: Vec<Option<PointState<D>>> = (0..counts.iter().product()).into_par_iter().map(state_in).collect();
        let mut out = Samples {
            origin: spatial(&bounds.min).into(),
            spacing: [0.0; 3],
            counts: [0; 3],
            data: [("material", 1), ("displacement", 3), ("stress", 6), ("von_mises", 1), ("plastic_strain", 1)]
                .map(|(name, components)| (name.to_string(), components, Vec::new()))
                .into(),
        };
        for k in 0..D {
            (out.spacing[k], out.counts[k]) = (bounds.size()[k] / counts[k] as f64, counts[k]);
        }
        for state in &states {
            let u = state.as_ref().map_or(Point::<3>::zeros(), |s| spatial(&s.displacement));
            let s = state.as_ref().map_or(Matrix3::zeros(), |s| s.stress);
            out.data[0].2.push(f64::from(u8::from(state.is_some())));
            out.data[1].2.extend(&u);
            out.data[2].2.extend(components(&s));
            out.data[3].2.push(von_mises(&s));
            out.data[4].2.push(state.as_ref().map_or(0.0, |s| s.plastic_strain));
        }
        if !self.law().has_history() {
            out.data.truncate(4);
        }
        out
    }
}

/// Stress as it is shown: xx, yy, zz, xy, yz, xz.
pub(crate) fn components(s: &Matrix3<f64>) -> [f64; 6] {
    [s[(0, 0)], s[(1, 1)], s[(2, 2)], s[(0, 1)], s[(1, 2)], s[(0, 2)]]
}
