//! A step without impacts: the midpoint rule with impulses of the contacts that are closed.
//!
//! | symbol | meaning |
//! |---|---|
//! | `h`, `s` | duration, step of all unknowns: displacements, and rotation vectors |
//! | `v₀`, `v₁` | velocities before and after: `s` is `h` times their mean ([`Masses`]) |
//! | `p₀`, `p₁` | momenta |
//! | `f`, `G` | loads, and rows of gaps and slips against the axes, in the state at half of the step |
//! | `r` | mean contact forces |
//!
//! `p₁ - p₀ = h f + h Gᵀ r`, `0 ≤ r_N ⟂ u_N ≥ 0` with the velocities `u` of opening and slip at the end, and friction by its law
//! against the slip (Moreau 1988, Jean 1999). Where a contact slips all along, friction acts against the slip of the step, so that its
//! work is that of the step and the order 2; where it comes to stick, `u` vanishes exactly.
//!
//! That velocities stay on the constraint does not keep positions on it. Contacts that carry are therefore put back to gap zero
//! by the least displacement in the metric of the masses (Gear, Gupta & Leimkuhler 1985), of the third order in `h`.

use super::driven::{Driven, HeldInTime};
use super::masses::Masses;
use crate::body::BodyState;
use crate::points::Order;
use crate::rigid_system::complementarity::Complementarity;
use crate::rigid_system::motion::{Loaded, Motion, TOUCHES};
use crate::rigid_system::touching::{Id, Touching, Twists, Wanted, touching};
use crate::system::AssemblyError;
use nalgebra::{DMatrix, DVector};
use signorini_geometry::Vector;
use std::collections::{BTreeMap, BTreeSet};

/// Change of a step, relative to the sizes, that ends its iterations; and what rounding leaves at worst.
const SAME: f64 = 1e-15;
const ROUNDING: f64 = 1e-10;
const MOST_ITERATIONS: usize = 50;
/// Rotation of a step, in radians, beyond which its vector does not tell it from others.
const LARGEST_TURN: f64 = 3.0;
/// Eigenvalues relative to the largest that are rounding.
const RANK: f64 = 1e-11;
/// Cosine of the angle by which slip may turn in a step and still be slip all along.
const TURNED: f64 = 0.5;

/// Mean forces of the contacts.
pub type Forces = BTreeMap<Id, [f64; 3]>;

/// Where bodies move from.
pub struct Start<'b> {
    pub bodies: &'b [BodyState],
    pub velocities: &'b [f64],
}

/// A step that was found.
pub struct Smooth<'a> {
    pub bodies: Vec<BodyState>,
    pub velocities: Vec<f64>,
    /// The contacts that are closed, in the state at half of the step, with mean forces and slips of the step.
    pub loaded: Vec<Loaded<'a>>,
    /// Mean force and moment of each support on the bodies.
    pub supports: Vec<[Vector<3>; 2]>,
    pub iterations: usize,
}

impl<'a> Motion<'a> {
    /// Bodies after a share of a step, prescribed ones as told.
    fn moved(&self, from: &[BodyState], step: &[f64], share: f64, (driven, which): (&Driven, usize)) -> Vec<BodyState> {
        let mut out: Vec<BodyState> = (self.system.bodies.iter().zip(from).zip(&self.first))
            .map(|((body, state), first)| {
                let first = *first as usize;
                body.advance(state, &step[first..first + body.unknowns()], share)
            })
            .collect();
        driven.place(which, &mut out);
        out
    }

    /// The points with these names in a state.
    pub(super) fn named(
        &self,
        bodies: &[BodyState],
        twists: &Twists,
        ids: &BTreeSet<Id>,
    ) -> BTreeMap<Id, Touching<'a>> {
        if ids.is_empty() {
            return BTreeMap::new();
        }
        let wanted = Wanted { by: &|_, _| false, reach: -1.0, named: ids };
        let found = touching(&self.contacts, self.bodies_of(bodies), twists, Order::First, &wanted);
        found.into_iter().map(|p| (p.id, p)).collect()
    }

    /// A step between two times with some contacts closed; none where its iterations come to no end.
    ///
    /// # Errors
    /// Loads and supports that cannot act.
    pub(super) fn smooth(
        &self,
        masses: &Masses,
        from: &Start<'_>,
        driven: &Driven,
        (closed, initial): (&BTreeSet<Id>, &Forces),
    ) -> Result<Option<Smooth<'a>>, AssemblyError> {
        let n = self.turns.len();
        let [start, middle, end] = driven.times;
        let h = end - start;
        let (mean, last) = (driven.mean(), driven.at_end());
        let before = masses.momenta(self.system, from.bodies, from.velocities);
        let mut step: Vec<f64> = from.velocities.iter().map(|v| v * h).collect();
        let mut correction = vec![0.0; n];
        let mut forces: Forces =
            initial.iter().filter(|(id, _)| closed.contains(id)).map(|(id, f)| (*id, *f)).collect();
        let mut coupled_forces: Vec<f64> = Vec::new();
        let mut change_before = f64::INFINITY;
        for iteration in 1..=MOST_ITERATIONS {
            if masses.largest_turn(&step) > LARGEST_TURN || !step.iter().all(|s| s.is_finite()) {
                return Ok(None);
            }
            let whole: Vec<f64> = step.iter().zip(&correction).map(|(s, c)| s + c).collect();
            let half_way = self.moved(from.bodies, &step, 0.5, (driven, 1));
            let bodies = self.moved(from.bodies, &whole, 1.0, (driven, 2));
            let HeldInTime { single, coupled, single_rates, coupled_rates } =
                driven.held(self.system, &bodies, true)?;
            coupled_forces.resize(coupled.len(), 0.0);
            let mut after = masses.after(&step, from.velocities, h);
            let mut is_free = vec![true; n];
            let mut change = DVector::zeros(n);
            for (held, rate) in single.iter().zip(&single_rates) {
                let (unknown, factor) = held.constraint.terms[0];
                let k = unknown as usize;
                is_free[k] = false;
                after[k] = -rate / factor;
                change[k] = -held.constraint.violation / factor;
            }
            let free: Vec<usize> = (0..n).filter(|k| is_free[*k]).collect();

            // Contacts at half of the step act, those at its end are kept. A point that has no pair in either is none.
            let acting = self.named(&half_way, &mean, closed);
            let at_end = self.named(&bodies, &last, closed);
            let both = |p: &Touching<'a>| at_end.get(&p.id).filter(|k| k.rows() == p.rows());
            let acting: Vec<Touching<'a>> = acting.into_values().filter(|p| both(p).is_some()).collect();
            let kept: Vec<&Touching<'a>> = acting.iter().filter_map(both).collect();
            let (blocks, act) = self.rows(&acting.iter().collect::<Vec<_>>(), &coupled);
            let (_, keep) = self.rows(&kept, &coupled);
            let of_coupled = &blocks[acting.len()..];
            let mut known = DVector::zeros(act.nrows());
            for (b, p) in blocks.iter().zip(&acting) {
                let force = forces.get(&p.id).copied().unwrap_or_default();
                (0..b.rows).for_each(|k| known[b.first + k] = force[k]);
            }
            of_coupled.iter().zip(&coupled_forces).for_each(|(b, f)| known[b.first] = *f);

            // The balance of momenta with the forces of the last iterate.
            let loads = self.loads(&half_way, middle)?;
            let momenta = masses.momenta(self.system, &bodies, &after);
            let push = DVector::from_column_slice(&loads.forces) + act.tr_mul(&known);
            let lacks = &momenta - &before - push * h;
            let [d_momenta, d_velocities] =
                masses.derivatives(self.system, (&step, h), (from.velocities, &after), &bodies);
            let matrix = d_momenta + &loads.stiffness * (0.5 * h);
            let right = -(&lacks + &matrix * &change);
            let reduced = matrix.select_rows(&free).select_columns(&free).lu();
            let Some(alone) = reduced.solve(&right.select_rows(&free)) else { return Ok(None) };
            let Some(by_force) = reduced.solve(&(act.select_columns(&free).transpose() * h)) else { return Ok(None) };
            let speeds = &keep * d_velocities.select_columns(&free);

            // Velocities of opening and slip.
            let mut q = &speeds * &alone + &keep * DVector::from_column_slice(&after);
            let mut slips = Vec::with_capacity(acting.len());
            for ((b, p), k) in blocks.iter().zip(&acting).zip(&kept) {
                q[b.first] += k.driven_gap;
                let slip = p.slip_of(&step.iter().map(|s| s / h).collect::<Vec<_>>());
                slips.push(slip * h);
                let mut sizes = [[0.0; 2]; 2];
                for i in 1..b.rows {
                    let axis = b.axes[i - 1];
                    let at_end = -k.axes[axis].dot(&k.driven);
                    q[b.first + i] += at_end;
                    let now: f64 = (0..n).map(|j| keep[(b.first + i, j)] * after[j]).sum::<f64>() + at_end;
                    sizes[i - 1] = [now, -p.axes[axis].dot(&slip)];
                }
                // Against the slip of the step where it slips all along.
                let [now, whole] = [0, 1].map(|k| sizes[0][k].hypot(sizes[1][k]));
                let along: f64 = sizes.iter().map(|s| s[0] * s[1]).sum();
                if b.rows == 3 && now > 0.0 && along > TURNED * now * whole {
                    (1..b.rows).for_each(|i| q[b.first + i] += sizes[i - 1][1] / whole * now - sizes[i - 1][0]);
                }
            }
            for (b, rate) in of_coupled.iter().zip(&coupled_rates) {
                q[b.first] += rate;
            }
            // Forces act by the rows of one state, and velocities are those of another one: not quite symmetric. What depends on
            // each other, as the corners of a facet do, does so in both; their mean would have no solution.
            let w = &speeds * &by_force;
            let problem = Complementarity { blocks: blocks.clone(), w, q, known };
            let Some(r) = problem.solve() else { return Ok(None) };
            let moved = alone + by_force * (&r - &problem.known);
            free.iter().zip(moved.iter()).for_each(|(k, v)| change[*k] = *v);
            forces = (blocks.iter().zip(&acting))
                .map(|(b, p)| (p.id, std::array::from_fn(|k| if k < b.rows { r[b.first + k] } else { 0.0 })))
                .collect();
            coupled_forces = of_coupled.iter().map(|b| r[b.first]).collect();
            step.iter_mut().zip(change.iter()).for_each(|(s, c)| *s += c);

            let gaps = (blocks.iter().zip(&kept)).filter_map(|(b, p)| {
                let carries = r[b.first] > 0.0 || p.pair.gap < -TOUCHES * self.size;
                carries.then_some((b.first, p.pair.gap))
            });
            let lengths = of_coupled.iter().zip(&coupled).map(|(b, held)| (b.first, held.constraint.violation));
            let wanted: Vec<(usize, f64)> = gaps.chain(lengths).collect();
            let mass = masses.matrix(self.system, &bodies).select_rows(&free).select_columns(&free);
            let back = self.put_back(&mass, &keep.select_columns(&free), &wanted);
            free.iter().zip(&back).for_each(|(k, c)| correction[*k] += c);

            let mut put_back = vec![0.0; n];
            free.iter().zip(&back).for_each(|(k, c)| put_back[*k] = *c);
            let size = self.largest(change.as_slice()).max(self.largest(&put_back));
            if size <= SAME || (size <= ROUNDING && size >= 0.5 * change_before) {
                let whole: Vec<f64> = step.iter().zip(&correction).map(|(s, c)| s + c).collect();
                let mut velocities = masses.after(&step, from.velocities, h);
                for (held, rate) in single.iter().zip(&single_rates) {
                    let (unknown, factor) = held.constraint.terms[0];
                    velocities[unknown as usize] = -rate / factor;
                }
                let loaded: Vec<Loaded<'a>> = acting
                    .into_iter()
                    .zip(slips)
                    .map(|(point, slip)| Loaded { force: forces[&point.id], point, slip })
                    .collect();
                let mut supports = vec![[Vector::<3>::zeros(); 2]; self.system.supports.len()];
                for held in &single {
                    let (unknown, factor) = held.constraint.terms[0];
                    held.add_reaction(lacks[unknown as usize] / (h * factor), &mut supports);
                }
                coupled.iter().zip(&coupled_forces).for_each(|(held, f)| held.add_reaction(*f, &mut supports));
                return Ok(Some(Smooth {
                    bodies: self.moved(from.bodies, &whole, 1.0, (driven, 2)),
                    velocities,
                    loaded,
                    supports,
                    iterations: iteration,
                }));
            }
            change_before = size;
        }
        Ok(None)
    }

    /// The least displacement in the metric of the masses that closes gaps: of some rows.
    fn put_back(&self, mass: &DMatrix<f64>, rows: &DMatrix<f64>, wanted: &[(usize, f64)]) -> Vec<f64> {
        let n = mass.nrows();
        if wanted.is_empty() || wanted.iter().all(|(_, gap)| *gap == 0.0) {
            return vec![0.0; n];
        }
        let own = rows.select_rows(&wanted.iter().map(|w| w.0).collect::<Vec<_>>());
        let Some(factor) = mass.clone().cholesky() else { return vec![0.0; n] };
        let by_force = factor.solve(&own.transpose());
        let gram = (&own * &by_force).symmetric_eigen();
        let largest = gram.eigenvalues.amax();
        let gaps = DVector::from_iterator(wanted.len(), wanted.iter().map(|w| -w.1));
        let parts = gram.eigenvectors.tr_mul(&gaps);
        let parts = parts.zip_map(&gram.eigenvalues, |p, v| if v > RANK * largest { p / v } else { 0.0 });
        (by_force * (&gram.eigenvectors * parts)).iter().copied().collect()
    }
}
