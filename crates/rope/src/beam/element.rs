//! An element of a geometrically exact beam: energy, forces and tangent.
//!
//! Unknowns of an element, 21: `r_1 t_1 θ_1 r_2 t_2 θ_2 θ_m`, where `θ` is the spatial spin of a node or of the middle.
//! With the covector `f_a` of the energy in the quaternion `q_a`, forces are `G_aᵀ f_a` and the tangent is
//! `G_aᵀ K G_b - ¼ δ_ab (q_a·f_a) I`: the second derivative along geodesics, symmetric in every state.
//!
//! Axial and shear strains are integrated with two points of Gauss, curvatures with three: no locking. Two points leave
//! `r' ∝ P_2(ξ)`, the same in all elements, without energy; a share `β = min(1, 0.03 max EI / (min(EA, GA) h²))` of the
//! two-point rule is therefore given to the three-point rule. This stiffness is of the size of that of bending and
//! vanishes in the thin limit: it cures the mode and cannot lock.
//!
//! Geometric terms of the tangent take stresses of their own, predicted from the linear step before (mixed integration
//! points: Magisano, Leonetti & Garcea 2017): without them Newton's method needs many load steps for slender beams.

use super::strain::{Curvature, ForceStrain, curvature, curvature_hessian, force_strain, force_strain_hessian};
use crate::hermite::{self, THREE, TWO};
use crate::quaternion::{Quaternion, spin_map};
use crate::section::Stiffness;
use nalgebra::{SMatrix, SVector};
use signorini_geometry::Vector;

/// Numbers of unknowns of an element.
pub const UNKNOWNS: usize = 21;
/// Stresses of an element: three forces at five points, three moments at three.
pub const STRESSES: usize = 24;
/// Share of the bending stiffness that stabilises: 0.03 keeps the order of convergence between 3.5 and 4, while 1 lowers
/// it to 2.5.
const STABILISATION: f64 = 0.03;

/// Forces on the unknowns of an element.
pub type Forces = SVector<f64, UNKNOWNS>;
/// Their derivative.
pub type Tangent = SMatrix<f64, UNKNOWNS, UNKNOWNS>;
/// Stresses at the points of integration.
pub type Stresses = [Vector<3>; 8];

/// Positions, derivatives and rotations of the nodes of an element.
#[derive(Clone, Copy, Debug)]
pub struct Nodes {
    /// `r_1 t_1 r_2 t_2`.
    pub centreline: [Vector<3>; 4],
    /// First node, last node, middle: in one hemisphere.
    pub rotations: [Quaternion; 3],
}

/// What does not change: length, stiffness, strains of the reference.
#[derive(Clone, Copy, Debug)]
pub struct Element {
    pub length: f64,
    pub stiffness: Stiffness,
    stabilisation: f64,
    /// Strains of the reference: of forces at five points, of moments at three.
    reference: Stresses,
}

/// A point of integration as it is now.
enum Sample {
    Force { c: [f64; 4], l: [f64; 3], r1: Vector<3>, q: Quaternion, strain: ForceStrain },
    Moment { l: [f64; 3], dl: [f64; 3], q: Quaternion, p: Quaternion, strain: Curvature },
}

impl Element {
    /// An element without stress where its nodes are.
    pub fn new(length: f64, stiffness: Stiffness, reference: &Nodes) -> Self {
        let bending = stiffness.bending[0].max(stiffness.bending[1]);
        let stiff = stiffness.axial.min(stiffness.shear[0]).min(stiffness.shear[1]);
        let stabilisation = (STABILISATION * bending / (stiff * length * length)).min(1.0);
        let mut element = Element { length, stiffness, stabilisation, reference: Stresses::default() };
        element.reference = std::array::from_fn(|k| element.strain(&element.sample(k, reference)));
        element
    }

    /// Coordinate and weight of a point of integration: two and three of forces, three of moments.
    fn rule(&self, k: usize) -> (f64, f64) {
        let (xi, weight) = match k {
            0..2 => (TWO[k].0, TWO[k].1 * (1.0 - self.stabilisation)),
            2..5 => (THREE[k - 2].0, THREE[k - 2].1 * self.stabilisation),
            _ => THREE[k - 5],
        };
        (xi, weight * self.length)
    }

    fn sample(&self, k: usize, nodes: &Nodes) -> Sample {
        let xi = self.rule(k).0;
        let l = hermite::quadratic(xi);
        let combine = |l: &[f64; 3]| (0..3).fold(Quaternion::zeros(), |sum, a| sum + nodes.rotations[a] * l[a]);
        let q = combine(&l);
        if k < 5 {
            let c = hermite::cubic_first(xi, self.length).map(|n| n / self.length);
            let r1 = hermite::sum(&c, &nodes.centreline);
            Sample::Force { c, l, r1, q, strain: force_strain(&r1, &q) }
        } else {
            let dl = hermite::quadratic_first(xi).map(|n| n / self.length);
            let p = combine(&dl);
            Sample::Moment { l, dl, q, p, strain: curvature(&q, &p) }
        }
    }

    fn strain(&self, sample: &Sample) -> Vector<3> {
        match sample {
            Sample::Force { strain, .. } => strain.value,
            Sample::Moment { strain, .. } => strain.value,
        }
    }

    fn moduli(&self, k: usize) -> Vector<3> {
        Vector::<3>::from(if k < 5 { self.stiffness.of_forces() } else { self.stiffness.of_moments() })
    }

    fn stress(&self, k: usize, sample: &Sample) -> Vector<3> {
        (self.strain(sample) - self.reference[k]).component_mul(&self.moduli(k))
    }

    /// The stresses in a state.
    pub fn stresses(&self, nodes: &Nodes) -> Stresses {
        std::array::from_fn(|k| self.stress(k, &self.sample(k, nodes)))
    }

    /// The stresses that a linear step of the unknowns predicts.
    pub fn predicted(&self, nodes: &Nodes, step: &Forces) -> Stresses {
        let maps = nodes.rotations.map(|q| spin_map(&q));
        std::array::from_fn(|k| {
            let sample = self.sample(k, nodes);
            let rate: Vector<3> = match &sample {
                Sample::Force { c, l, strain, .. } => {
                    let d = force_rows(c, l, &maps) * step;
                    Vector::<3>::from_fn(|a, _| strain.gradient[a].dot(&d))
                }
                Sample::Moment { l, dl, strain, .. } => {
                    let d = moment_rows(l, dl, &maps) * step;
                    Vector::<3>::from_fn(|a, _| strain.gradient[a].dot(&d))
                }
            };
            self.stress(k, &sample) + rate.component_mul(&self.moduli(k))
        })
    }

    /// Energy and forces.
    pub fn forces(&self, nodes: &Nodes) -> (f64, Forces) {
        let maps = nodes.rotations.map(|q| spin_map(&q));
        let mut energy = 0.0;
        let mut forces = Forces::zeros();
        for k in 0..8 {
            let sample = self.sample(k, nodes);
            let weight = self.rule(k).1;
            let strain = self.strain(&sample) - self.reference[k];
            let stress = strain.component_mul(&self.moduli(k));
            energy += 0.5 * weight * stress.dot(&strain);
            match &sample {
                Sample::Force { c, l, strain, .. } => {
                    forces += force_rows(c, l, &maps).transpose() * (contract(&strain.gradient, &stress) * weight);
                }
                Sample::Moment { l, dl, strain, .. } => {
                    forces += moment_rows(l, dl, &maps).transpose() * (contract(&strain.gradient, &stress) * weight);
                }
            }
        }
        (energy, forces)
    }

    /// The derivative of the forces; geometric terms with given stresses ([`Element::stresses`] for the exact derivative).
    pub fn tangent(&self, nodes: &Nodes, stresses: &Stresses) -> Tangent {
        let maps = nodes.rotations.map(|q| spin_map(&q));
        let mut tangent = Tangent::zeros();
        // q_a·f_a of each rotation.
        let mut radial = [0.0; 3];
        for k in 0..8 {
            let sample = self.sample(k, nodes);
            let weight = self.rule(k).1;
            let moduli = self.moduli(k);
            match &sample {
                Sample::Force { c, l, r1, q, strain } => {
                    let mut h = force_strain_hessian(r1, q, &stresses[k]);
                    for a in 0..3 {
                        h += strain.gradient[a] * strain.gradient[a].transpose() * moduli[a];
                    }
                    let f = contract(&strain.gradient, &stresses[k]).fixed_rows::<4>(3).into_owned();
                    for a in 0..3 {
                        radial[a] += weight * l[a] * nodes.rotations[a].dot(&f);
                    }
                    let rows = force_rows(c, l, &maps);
                    tangent += rows.transpose() * (h * weight) * rows;
                }
                Sample::Moment { l, dl, q, p, strain } => {
                    let mut h = curvature_hessian(q, p, &stresses[k]);
                    for a in 0..3 {
                        h += strain.gradient[a] * strain.gradient[a].transpose() * moduli[a];
                    }
                    let f = contract(&strain.gradient, &stresses[k]);
                    let (fq, fp) = (f.fixed_rows::<4>(0), f.fixed_rows::<4>(4));
                    for a in 0..3 {
                        let q = &nodes.rotations[a];
                        radial[a] += weight * (l[a] * q.dot(&fq) + dl[a] * q.dot(&fp));
                    }
                    let rows = moment_rows(l, dl, &maps);
                    tangent += rows.transpose() * (h * weight) * rows;
                }
            }
        }
        for a in 0..3 {
            for i in 0..3 {
                let u = SPINS[a] + i;
                tangent[(u, u)] -= 0.25 * radial[a];
            }
        }
        tangent
    }
}

/// Where the positions and derivatives of the centreline are among the unknowns.
pub const CENTRELINE: [usize; 4] = [0, 3, 9, 12];
/// Where the spins are.
pub const SPINS: [usize; 3] = [6, 15, 18];

fn contract<const N: usize>(gradient: &[SVector<f64, N>; 3], stress: &Vector<3>) -> SVector<f64, N> {
    gradient[0] * stress[0] + gradient[1] * stress[1] + gradient[2] * stress[2]
}

/// The derivative of `(r', Q)` in the unknowns.
fn force_rows(c: &[f64; 4], l: &[f64; 3], maps: &[SMatrix<f64, 4, 3>; 3]) -> SMatrix<f64, 7, UNKNOWNS> {
    let mut rows = SMatrix::<f64, 7, UNKNOWNS>::zeros();
    for n in 0..4 {
        for i in 0..3 {
            rows[(i, CENTRELINE[n] + i)] = c[n];
        }
    }
    for a in 0..3 {
        rows.fixed_view_mut::<4, 3>(3, SPINS[a]).copy_from(&(maps[a] * l[a]));
    }
    rows
}

/// The derivative of `(Q, P)` in the unknowns.
fn moment_rows(l: &[f64; 3], dl: &[f64; 3], maps: &[SMatrix<f64, 4, 3>; 3]) -> SMatrix<f64, 8, UNKNOWNS> {
    let mut rows = SMatrix::<f64, 8, UNKNOWNS>::zeros();
    for a in 0..3 {
        rows.fixed_view_mut::<4, 3>(0, SPINS[a]).copy_from(&(maps[a] * l[a]));
        rows.fixed_view_mut::<4, 3>(4, SPINS[a]).copy_from(&(maps[a] * dl[a]));
    }
    rows
}
