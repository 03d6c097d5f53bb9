//! Quasi-static motion of rigid bodies: implicit steps of an overdamped motion in pseudo-time.
//!
//! With the step `v` of all unknowns from the last state, the pseudo-time step `τ` and the metric `M` of the bodies,
//!
//! `M v/τ = f(q + v) + Gᵀ r`,  `0 ≤ g(q + v) ⟂ r_N ≥ 0`,  friction by its law against the slip of the step
//!
//! (Moreau 1988, without inertia). Energy falls from step to step, what can rest rests, and with growing `τ` the steps become those
//! of Newton's method on the equilibrium, in which nothing is left of `M`. Loads and lengths of the problem are its only
//! scales. Within a step gaps, slips along the way and loads are linearised about the last iterate until it changes no more;
//! of the geometric stiffness the part that resists is kept, so that every linear problem has one solution.

use super::complementarity::{Block, Complementarity, Kind};
use super::rest::rest;
use super::touching::{Id, Touching, Twists, Wanted, along, touching};
use crate::body::{BodyState, Contribution};
use crate::contact::Contact;
use crate::interaction::Bodies;
use crate::points::Order;
use crate::system::{AssemblyError, Held, System, SystemState};
use nalgebra::{DMatrix, DVector};
use signorini_geometry::Vector;
use std::collections::{BTreeMap, BTreeSet};

/// A body moves by no more than this part of its size in a step, and turns by no more radians: gaps are linearised.
const FARTHEST: f64 = 0.2;
/// Pseudo-times: the longest, with which a step is one of Newton's method on the equilibrium; one in which a load moves a body
/// by this part of its size; and the shortest.
pub const FIRST: f64 = 0.1;
pub const LONGEST: f64 = 1e6;
pub const SHORTEST: f64 = 1e-7;
/// Gap, relative to the size of the largest free body, with which points touch.
pub const TOUCHES: f64 = 1e-11;
/// Gap, relative to that size, from which a point is looked at before it is needed.
const NEAR: f64 = 1e-3;
/// Change of a step, relative to the sizes, that ends its iterations, or relative to the step itself: the next one mends that;
/// and what rounding leaves at worst.
const SAME: f64 = 1e-13;
const SHARE: f64 = 1e-7;
const ROUNDING: f64 = 1e-10;
const MOST_ITERATIONS: usize = 40;

/// Rigid bodies in contact at a time.
pub struct Motion<'a> {
    pub system: &'a System,
    pub contacts: Vec<&'a Contact>,
    pub first: Vec<u32>,
    /// Of the largest free body.
    pub size: f64,
    /// The largest force that acts.
    pub load: f64,
    /// Of each unknown: whether it turns, and the size of its body.
    pub turns: Vec<bool>,
    pub extent: Vec<f64>,
}

/// A point with the forces on it, gap and friction along its axes.
pub struct Loaded<'a> {
    pub point: Touching<'a>,
    pub force: [f64; 3],
    /// Slip of the step along its axes.
    pub slip: Vector<3>,
}

/// A step that was found.
pub struct Stepped<'a> {
    pub step: Vec<f64>,
    pub bodies: Vec<BodyState>,
    pub loaded: Vec<Loaded<'a>>,
    /// Forces of the supports that couple unknowns.
    pub reactions: Vec<f64>,
    pub iterations: usize,
}

/// Loads on all unknowns, and the derivative of what resists.
pub struct Loads {
    pub forces: Vec<f64>,
    pub stiffness: DMatrix<f64>,
}

impl<'a> Motion<'a> {
    pub fn bodies_of<'b>(&'b self, states: &'b [BodyState]) -> Bodies<'b> {
        Bodies { bodies: &self.system.bodies, states, first: &self.first }
    }

    /// The longest step; nothing bounds it where nothing may touch.
    pub fn farthest(&self) -> f64 {
        if self.contacts.is_empty() { f64::INFINITY } else { FARTHEST }
    }

    fn count(&self) -> usize {
        self.turns.len()
    }

    /// Force per step, of each unknown, of a step in a unit of pseudo-time.
    fn metric(&self, unknown: usize) -> f64 {
        let translation = self.load / self.size;
        if self.turns[unknown] { translation * 0.25 * self.extent[unknown].powi(2) } else { translation }
    }

    /// The largest motion of a step, relative to the sizes: of all bodies the translation, and the rotation; in any axes.
    pub fn largest(&self, step: &[f64]) -> f64 {
        let mut squares = BTreeMap::<(u32, bool), f64>::new();
        for (k, value) in step.iter().enumerate() {
            let body = self.first.partition_point(|f| *f as usize <= k) as u32;
            *squares.entry((body, self.turns[k])).or_default() += self.relative(k, *value).powi(2);
        }
        squares.values().fold(0.0f64, |m, s| if s.is_nan() { f64::NAN } else { m.max(*s) }).sqrt()
    }

    /// One unknown of a step relative to the size of its body.
    pub fn relative(&self, unknown: usize, value: f64) -> f64 {
        if self.turns[unknown] { value.abs() } else { value.abs() / self.extent[unknown] }
    }

    /// What acts on the bodies without contact.
    pub fn loads(&self, bodies: &[BodyState], time: f64) -> Result<Loads, AssemblyError> {
        let n = self.count();
        let mut out = Loads { forces: vec![0.0; n], stiffness: DMatrix::zeros(n, n) };
        for load in &self.system.loads {
            let k = load.part.body;
            let (body, first) = (&self.system.bodies[k], self.first[k] as usize);
            let mut own = Contribution::new(body.unknowns());
            load.act(body.as_ref(), &bodies[k], time, Order::Second, &mut own)?;
            own.forces.iter().enumerate().for_each(|(i, f)| out.forces[first + i] -= f);
            for (unknowns, block) in &own.blocks {
                let n = unknowns.len();
                for (i, row) in unknowns.iter().enumerate() {
                    for (j, column) in unknowns.iter().enumerate() {
                        // The part that is symmetric: what else moments do vanishes with their residual.
                        let value = 0.5 * (block[i * n + j] + block[j * n + i]);
                        out.stiffness[(first + *row as usize, first + *column as usize)] += value;
                    }
                }
            }
        }
        Ok(out)
    }

    /// Rows of points and of supports that couple unknowns, with their blocks.
    pub fn rows<'b>(&self, points: &[&Touching<'b>], coupled: &[Held]) -> (Vec<Block<'b>>, DMatrix<f64>) {
        let mut blocks = Vec::new();
        let mut count = 0;
        for p in points {
            let kind = Kind::Contact { law: p.law.filter(|_| p.rows() > 1), weight: p.weight };
            blocks.push(Block { kind, first: count, rows: p.rows(), axes: p.slip_axes() });
            count += p.rows();
        }
        for _ in coupled {
            blocks.push(Block { kind: Kind::Bilateral, first: count, rows: 1, axes: [0, 1] });
            count += 1;
        }
        let mut rows = DMatrix::zeros(count, self.count());
        for (b, p) in blocks.iter().zip(points) {
            for (a, unknown) in p.pair.unknowns.iter().enumerate() {
                rows[(b.first, *unknown as usize)] += p.pair.opening[a];
                for k in 1..b.rows {
                    rows[(b.first + k, *unknown as usize)] -= p.axes[b.axes[k - 1]].dot(&p.pair.slip[a]);
                }
            }
        }
        for (b, held) in blocks[points.len()..].iter().zip(coupled) {
            held.constraint.terms.iter().for_each(|(unknown, factor)| rows[(b.first, *unknown as usize)] += factor);
        }
        (blocks, rows)
    }

    /// The stiffness of a loaded point: pressure on curved sides, and friction on turned ones; symmetric.
    pub fn geometric(&self, point: &Touching<'_>, force: &[f64; 3]) -> DMatrix<f64> {
        let n = point.pair.unknowns.len();
        let axes = point.slip_axes();
        let friction: Vector<3> = (1..point.rows()).map(|k| point.axes[axes[k - 1]] * force[k]).sum();
        let mut out = DMatrix::from_row_slice(n, n, &point.pair.d_opening) * -force[0];
        if point.law.is_some() {
            out += DMatrix::from_row_slice(n, n, &point.pair.slip_hessian(&friction));
        }
        (&out + out.transpose()) * 0.5
    }

    /// The points of some contacts with friction at a share of a step.
    fn rubbing(
        &self,
        from: &SystemState,
        (step, twists): (&[f64], &Twists),
        (share, ids): (f64, &BTreeSet<Id>),
    ) -> BTreeMap<Id, Touching<'a>> {
        if ids.is_empty() {
            return BTreeMap::new();
        }
        let bodies = along(self.bodies_of(&from.bodies), from, (step, twists), share);
        let by = |id: Id, _: f64| ids.contains(&id);
        let wanted = Wanted::near(&by, NEAR * self.size);
        let found = touching(&self.contacts, self.bodies_of(&bodies), twists, Order::First, &wanted);
        found.into_iter().map(|p| (p.id, p)).collect()
    }

    /// The slips of a step by point, along the way: by the rule of Simpson where the place is known all along. `start` keeps the
    /// points of the state before, which are the same for all iterates.
    fn slips(
        &self,
        from: &SystemState,
        way: (&[f64], &Twists),
        points: &[Touching<'_>],
        start: &mut BTreeMap<Id, Touching<'a>>,
    ) -> Vec<Vector<3>> {
        let (step, _) = way;
        let ids: BTreeSet<Id> = points.iter().filter(|p| p.law.is_some() && p.id.place == 0).map(|p| p.id).collect();
        let unknown = ids.iter().filter(|id| !start.contains_key(id)).copied().collect();
        start.extend(self.rubbing(from, way, (0.0, &unknown)));
        let middle = self.rubbing(from, way, (0.5, &ids));
        (points.iter())
            .map(|p| {
                let end = p.slip_of(step);
                let slip = match (start.get(&p.id), middle.get(&p.id)) {
                    (Some(a), Some(b)) => (a.slip_of(step) + b.slip_of(step) * 4.0 + end) / 6.0,
                    _ => end,
                };
                slip - p.pair.normal * p.pair.normal.dot(&slip)
            })
            .collect()
    }

    /// An implicit step; none where its iterations come to no end, or where it leads too far.
    pub fn step(
        &self,
        from: &SystemState,
        twists: &Twists,
        (time, tau): (f64, f64),
        initial_multipliers: &BTreeMap<Id, [f64; 3]>,
    ) -> Result<Option<Stepped<'a>>, AssemblyError> {
        let n = self.count();
        let mut step = vec![0.0; n];
        let mut forces = initial_multipliers.clone();
        let mut seen: BTreeSet<Id> =
            initial_multipliers.iter().filter(|(_, f)| f[0] > 0.0).map(|(id, _)| *id).collect();
        let mut start = BTreeMap::new();
        let mut before = f64::INFINITY;
        for iteration in 1..=MOST_ITERATIONS {
            let bodies = along(self.bodies_of(&from.bodies), from, (&step, twists), 1.0);
            let now = self.bodies_of(&bodies);
            let by = |id: Id, gap: f64| gap < NEAR * self.size || seen.contains(&id);
            let wanted = Wanted::near(&by, NEAR * self.size);
            let points = touching(&self.contacts, now, twists, Order::Second, &wanted);
            seen.extend(points.iter().map(|p| p.id));
            let slips = self.slips(from, (&step, twists), &points, &mut start);
            let loads = self.loads(&bodies, time)?;
            let (single, coupled) = self.system.held(&bodies, time)?;
            let (blocks, rows) = self.rows(&points.iter().collect::<Vec<_>>(), &coupled);

            let mut matrix = loads.stiffness;
            let all: Vec<u32> = (0..n as u32).collect();
            self.keep_resisting(&mut matrix, &all);
            for p in &points {
                let Some(force) = forces.get(&p.id) else { continue };
                let mut own = self.geometric(p, force);
                self.keep_resisting(&mut own, &p.pair.unknowns);
                p.add_to(&mut matrix, &own);
            }
            let mut right = DVector::from_column_slice(&loads.forces);
            for k in 0..n {
                let metric = self.metric(k) / tau;
                matrix[(k, k)] += metric;
                right[k] -= metric * step[k];
            }
            // What supports prescribe by itself is known.
            let mut change = DVector::zeros(n);
            let mut is_free = vec![true; n];
            for held in &single {
                let (unknown, factor) = held.constraint.terms[0];
                is_free[unknown as usize] = false;
                change[unknown as usize] = -held.constraint.violation / factor;
            }
            right -= &matrix * &change;
            let free: Vec<usize> = (0..n).filter(|k| is_free[*k]).collect();
            let reduced = matrix.select_rows(&free).select_columns(&free);
            let Some(factor) = reduced.cholesky() else { return Ok(None) };
            let across = rows.select_columns(&free);
            let compliance = factor.solve(&across.transpose());
            let mut known = DVector::zeros(rows.nrows());
            for (b, p) in blocks.iter().zip(&points) {
                let Some(force) = forces.get(&p.id) else { continue };
                (0..b.rows).for_each(|k| known[b.first + k] = force[k]);
            }
            let alone = factor.solve(&(right.select_rows(&free) + across.tr_mul(&known)));
            let mut q = &across * &alone + &rows * &change;
            for ((b, p), slip) in blocks.iter().zip(&points).zip(&slips) {
                q[b.first] += p.pair.gap;
                (1..b.rows).for_each(|k| q[b.first + k] -= p.axes[b.axes[k - 1]].dot(slip));
            }
            for (b, held) in blocks[points.len()..].iter().zip(&coupled) {
                q[b.first] += held.constraint.violation;
            }
            let w = &across * &compliance;
            let w = (&w + w.transpose()) * 0.5;
            let problem = Complementarity { blocks: blocks.clone(), w, q, known };
            let Some(r) = problem.solve() else { return Ok(None) };
            let moved = alone + compliance * (&r - &problem.known);
            free.iter().zip(moved.iter()).for_each(|(k, v)| change[*k] = *v);
            forces = (blocks.iter().zip(&points))
                .map(|(b, p)| (p.id, std::array::from_fn(|k| if k < b.rows { r[b.first + k] } else { 0.0 })))
                .collect();

            let size = self.largest(change.as_slice());
            step.iter_mut().zip(change.iter()).for_each(|(s, c)| *s += c);
            let far = self.largest(&step);
            // Iterates may lie beyond what is taken in the end.
            if !far.is_finite() || far > 4.0 * self.farthest() {
                return Ok(None);
            }
            if size <= SAME.max(SHARE * far) || (size <= ROUNDING && size >= 0.5 * before) {
                if far > self.farthest() {
                    return Ok(None);
                }
                let bodies = along(self.bodies_of(&from.bodies), from, (&step, twists), 1.0);
                let loaded = (points.into_iter().zip(slips))
                    .map(|(point, slip)| Loaded { force: forces[&point.id], point, slip })
                    .collect();
                let reactions = blocks[blocks.len() - coupled.len()..].iter().map(|b| -r[b.first]).collect();
                return Ok(Some(Stepped { step, bodies, loaded, reactions, iterations: iteration }));
            }
            before = size;
        }
        Ok(None)
    }

    /// The forces with which the bodies rest where they are; none where there are none, or where something is to move.
    pub fn at_rest(&self, bodies: &[BodyState], time: f64) -> Result<Option<Stepped<'a>>, AssemblyError> {
        let n = self.count();
        let still: Twists = vec![None; bodies.len()];
        let touches = TOUCHES * self.size;
        let by = |_: Id, gap: f64| gap <= touches;
        let wanted = Wanted::near(&by, touches);
        let points = touching(&self.contacts, self.bodies_of(bodies), &still, Order::Second, &wanted);
        let (single, coupled) = self.system.held(bodies, time)?;
        let lacks = |h: &Held| h.constraint.violation.abs() > touches;
        if points.iter().any(|p| p.pair.gap < -touches) || single.iter().chain(&coupled).any(lacks) {
            return Ok(None);
        }
        let mut is_free = vec![true; n];
        single.iter().for_each(|h| is_free[h.constraint.terms[0].0 as usize] = false);
        let free: Vec<usize> = (0..n).filter(|k| is_free[*k]).collect();
        let (blocks, rows) = self.rows(&points.iter().collect::<Vec<_>>(), &coupled);
        // Forces and moments in one unit.
        let unit = |k: usize| (self.metric(k) * self.size / self.load).sqrt().recip();
        let scale = DMatrix::from_diagonal(&DVector::from_iterator(free.len(), free.iter().map(|k| unit(*k))));
        let loads = self.loads(bodies, time)?.forces;
        let load = DVector::from_iterator(free.len(), free.iter().map(|k| loads[*k] * unit(*k)));
        let Some(r) = rest(&blocks, &(rows.select_columns(&free) * scale), &load) else { return Ok(None) };
        let force = |b: &Block<'_>| std::array::from_fn(|k| if k < b.rows { r[b.first + k] } else { 0.0 });
        let reactions = blocks[points.len()..].iter().map(|b| -r[b.first]).collect();
        let loaded = (points.into_iter().zip(&blocks))
            .map(|(point, b)| Loaded { point, force: force(b), slip: Vector::<3>::zeros() })
            .collect();
        Ok(Some(Stepped { step: vec![0.0; n], bodies: bodies.to_vec(), loaded, reactions, iterations: 0 }))
    }

    /// The largest force that the motion still takes, relative to the loads.
    pub fn moving(&self, step: &[f64], tau: f64) -> f64 {
        let force = |k: usize| self.metric(k) * step[k] / tau;
        let as_step = |k: usize| if self.turns[k] { force(k) / self.extent[k] } else { force(k) * self.extent[k] };
        self.largest(&(0..step.len()).map(as_step).collect::<Vec<_>>()) / self.load
    }

    /// Leaves of the symmetric stiffness of some unknowns the part that resists, in the metric of the bodies, so that units
    /// of length change nothing.
    fn keep_resisting(&self, stiffness: &mut DMatrix<f64>, unknowns: &[u32]) {
        if stiffness.iter().all(|v| *v == 0.0) {
            return;
        }
        let root = |k: usize| self.metric(unknowns[k] as usize).sqrt();
        let n = unknowns.len();
        let eigen = DMatrix::from_fn(n, n, |i, j| stiffness[(i, j)] / (root(i) * root(j))).symmetric_eigen();
        if eigen.eigenvalues.iter().all(|v| *v >= 0.0) {
            return;
        }
        let kept = DMatrix::from_diagonal(&eigen.eigenvalues.map(|v| v.max(0.0)));
        let scaled = &eigen.eigenvectors * kept * eigen.eigenvectors.transpose();
        *stiffness = DMatrix::from_fn(n, n, |i, j| scaled[(i, j)] * root(i) * root(j));
    }
}
