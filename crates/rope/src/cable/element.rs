//! An element of a smooth curve that resists stretch and bending: a cubic Hermite curve.
//!
//! With `a = r'`, `b = r''` (derivatives along the unstrained length): `ε = |a|/λ - 1` and `k = a × b/|a|²`, the energy is
//! `∫ ½ EA ⟨ε⟩² + ½ EI |k|²`; a cable takes tension only. `λ` is `|a|` of the unstrained element. Free of torsion this is exact
//! for beams that are straight without load, of sections with equal bending stiffness both ways, without torque at their
//! ends (Meier, Popp & Wall 2015). A curved start is a bent one.
//!
//! Unknowns of an element, 12: `r_1 t_1 r_2 t_2`. The stretch is integrated with two points of Gauss, which leave
//! `a ∝ P_2(ξ)` without energy: a share of the weights goes to three points, as in a beam with shear. A cable without bending
//! stiffness gets a small constant share instead. Geometric terms take forces predicted from the step before.

use crate::hermite::{self, THREE, TWO};
use nalgebra::{SMatrix, SVector};
use signorini_geometry::{Matrix, Vector};

/// Number of unknowns.
pub const UNKNOWNS: usize = 12;
/// Five axial forces and three vectors of moments.
pub const STRESSES: usize = 14;
/// Share of the bending stiffness that stabilises, as in a beam with shear.
const STABILISATION: f64 = 0.03;

pub type Forces = SVector<f64, UNKNOWNS>;
pub type Tangent = SMatrix<f64, UNKNOWNS, UNKNOWNS>;

/// Forces in the curve at the points of integration.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stresses {
    pub axial: [f64; 5],
    pub moments: [Vector<3>; 3],
}

/// What an element carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carries {
    TensionOnly,
    TensionAndCompression,
}

/// What does not change.
#[derive(Clone, Copy, Debug)]
pub struct Element {
    /// Without strain.
    pub length: f64,
    /// `EA` and `EI`.
    pub axial: f64,
    pub bending: f64,
    pub carries: Carries,
    /// A spring beside, by its force at the unstrained length, for now.
    pub tightened: f64,
    stabilisation: f64,
    /// `λ` at the five points.
    unstrained: [f64; 5],
}

impl Element {
    /// An element of given length without strain; `nodes` give how the length is distributed.
    pub fn new(length: f64, axial: f64, bending: f64, carries: Carries, nodes: &[Vector<3>; 4]) -> Self {
        let stabilisation =
            if bending > 0.0 { (STABILISATION * bending / (axial * length * length)).min(1.0) } else { CABLE_SHARE };
        let mut element =
            Element { length, axial, bending, carries, tightened: 0.0, stabilisation, unstrained: [1.0; 5] };
        let lengths: [f64; 5] = std::array::from_fn(|k| element.first(element.stretch_rule(k).0, nodes).1.norm());
        // Proportions only: the mean is one.
        let mean = (0..3).map(|k| THREE[k].1 * lengths[2 + k]).sum::<f64>();
        element.unstrained = lengths.map(|l| l / mean);
        element
    }

    fn stretch_rule(&self, k: usize) -> (f64, f64) {
        let (xi, weight) = match k {
            0..2 => (TWO[k].0, TWO[k].1 * (1.0 - self.stabilisation)),
            _ => (THREE[k - 2].0, THREE[k - 2].1 * self.stabilisation),
        };
        (xi, weight * self.length)
    }

    fn first(&self, xi: f64, nodes: &[Vector<3>; 4]) -> ([f64; 4], Vector<3>) {
        let c = hermite::cubic_first(xi, self.length).map(|n| n / self.length);
        (c, hermite::sum(&c, nodes))
    }

    fn second(&self, xi: f64, nodes: &[Vector<3>; 4]) -> ([f64; 4], Vector<3>) {
        let c = hermite::cubic_second(xi, self.length).map(|n| n / (self.length * self.length));
        (c, hermite::sum(&c, nodes))
    }

    fn axial_force(&self, strain: f64) -> f64 {
        match self.carries {
            Carries::TensionOnly => self.axial * strain.max(0.0),
            Carries::TensionAndCompression => self.axial * strain,
        }
    }

    /// Whether it is longer than its way by more than a share of its length, and carries nothing.
    pub fn is_slack(&self, nodes: &[Vector<3>; 4], longer: f64) -> bool {
        let strain = |k: usize| self.first(self.stretch_rule(k).0, nodes).1.norm() / self.unstrained[k] - 1.0;
        self.carries == Carries::TensionOnly && self.bending == 0.0 && (0..5).all(|k| strain(k) < -longer)
    }

    /// The forces in a state.
    pub fn stresses(&self, nodes: &[Vector<3>; 4]) -> Stresses {
        self.predicted(nodes, &Forces::zeros())
    }

    /// The forces that a linear step of the unknowns predicts.
    pub fn predicted(&self, nodes: &[Vector<3>; 4], step: &Forces) -> Stresses {
        let steps: [Vector<3>; 4] = std::array::from_fn(|n| step.fixed_rows::<3>(3 * n).into_owned());
        Stresses {
            axial: std::array::from_fn(|k| {
                let (c, a) = self.first(self.stretch_rule(k).0, nodes);
                let length = a.norm();
                let longer = length + a.dot(&hermite::sum(&c, &steps)) / length;
                self.axial_force(longer / self.unstrained[k] - 1.0)
            }),
            moments: std::array::from_fn(|k| {
                let ((c, a), (c2, b)) = (self.first(THREE[k].0, nodes), self.second(THREE[k].0, nodes));
                let (da, db) = (hermite::sum(&c, &steps), hermite::sum(&c2, &steps));
                let square = a.norm_squared();
                let curvature = a.cross(&b) / square;
                let change = (da.cross(&b) + a.cross(&db)) / square - curvature * (2.0 * a.dot(&da) / square);
                (curvature + change) * self.bending
            }),
        }
    }

    /// Energy and forces.
    pub fn forces(&self, nodes: &[Vector<3>; 4]) -> (f64, Forces) {
        let mut energy = 0.0;
        let mut forces = Forces::zeros();
        let mut add = |c: &[f64; 4], f: Vector<3>| {
            (0..4).for_each(|n| (0..3).for_each(|i| forces[3 * n + i] += c[n] * f[i]));
        };
        for k in 0..5 {
            let (xi, weight) = self.stretch_rule(k);
            let (c, a) = self.first(xi, nodes);
            let strain = a.norm() / self.unstrained[k] - 1.0;
            let force = self.axial_force(strain);
            // Weights are lengths without strain.
            energy += 0.5 * weight * (self.unstrained[k] * force * strain + self.tightened * a.norm_squared());
            add(&c, a * (weight * (force / a.norm() + self.tightened)));
        }
        if self.bending > 0.0 {
            for (xi, weight) in THREE {
                let weight = weight * self.length;
                let ((c, a), (c2, b)) = (self.first(xi, nodes), self.second(xi, nodes));
                let square = a.norm_squared();
                let curvature = a.cross(&b) / square;
                let moment = curvature * self.bending;
                energy += 0.5 * weight * moment.dot(&curvature);
                add(&c, (b.cross(&moment) / square - a * (2.0 * moment.dot(&curvature) / square)) * weight);
                add(&c2, moment.cross(&a) * (weight / square));
            }
        }
        (energy, forces)
    }

    /// The derivative of the forces; geometric terms with given forces ([`Element::stresses`] for the exact derivative).
    pub fn tangent(&self, nodes: &[Vector<3>; 4], stresses: &Stresses) -> Tangent {
        let mut tangent = Tangent::zeros();
        let mut add = |p: &[f64; 4], q: &[f64; 4], h: Matrix<3>| {
            for m in 0..4 {
                for n in 0..4 {
                    let mut block = tangent.fixed_view_mut::<3, 3>(3 * m, 3 * n);
                    block += h * (p[m] * q[n]);
                }
            }
        };
        let one = Matrix::<3>::identity();
        for k in 0..5 {
            let (xi, weight) = self.stretch_rule(k);
            let (c, a) = self.first(xi, nodes);
            let length = a.norm();
            let along = a * a.transpose() / (length * length);
            let is_taut = self.axial_force(length / self.unstrained[k] - 1.0) != 0.0
                || self.carries == Carries::TensionAndCompression;
            let stiffness = if is_taut { self.axial / self.unstrained[k] } else { 0.0 };
            let geometric = match self.carries {
                Carries::TensionOnly => stresses.axial[k].max(SLACK * self.axial),
                Carries::TensionAndCompression => stresses.axial[k],
            };
            let stiffness = if is_taut { stiffness } else { geometric / length };
            let across = (one - along) * (geometric / length);
            add(&c, &c, (along * stiffness + across + one * self.tightened) * weight);
        }
        if self.bending > 0.0 {
            for (k, (xi, weight)) in THREE.into_iter().enumerate() {
                let weight = weight * self.length;
                let ((c, a), (c2, b)) = (self.first(xi, nodes), self.second(xi, nodes));
                let square = a.norm_squared();
                let curvature = a.cross(&b) / square;
                // ∂k/∂a and ∂k/∂b.
                let ka = -b.cross_matrix() / square - curvature * a.transpose() * (2.0 / square);
                let kb = a.cross_matrix() / square;
                let m = stresses.moments[k];
                // m·∂²k: of the product in both variables, and of the division in a.
                let turned = b.cross(&m);
                let mixed_a = turned * a.transpose();
                let aa = (mixed_a + mixed_a.transpose()) * (-2.0 / (square * square))
                    - one * (2.0 * m.dot(&curvature) / square)
                    + a * a.transpose() * (8.0 * m.dot(&curvature) / (square * square));
                // m·(δa × δb) = δa·(δb × m).
                let ab = -m.cross_matrix() / square - a * m.cross(&a).transpose() * (2.0 / (square * square));
                let stiff = self.bending * weight;
                add(&c, &c, ka.transpose() * ka * stiff + aa * weight);
                let mixed = ka.transpose() * kb * stiff + ab * weight;
                add(&c, &c2, mixed);
                add(&c2, &c, mixed.transpose());
                add(&c2, &c2, kb.transpose() * kb * stiff);
            }
        }
        tangent
    }
}

/// Tension, relative to `EA`, with which slack parts stand in the tangent, though never in the forces: the root of round-off,
/// so that what slackens can still be solved for, and what is taut is not disturbed.
const SLACK: f64 = 1.5e-8;
/// Share of the three-point rule of a cable without bending stiffness.
const CABLE_SHARE: f64 = 0.03;
