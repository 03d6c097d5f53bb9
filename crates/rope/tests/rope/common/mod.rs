//! A small Newton driver for systems of curves.

pub mod acting;
pub mod bodies;

use faer::linalg::solvers::Solve;
use faer::sparse::{SparseColMat, Triplet};
use signorini_geometry::Vector;
use signorini_mechanics::body::{Body, BodyState, Constraint, Contribution, Hold, Load, Order};

pub type V = Vector<3>;

/// What holds and pushes the bodies, in the numbers of each body.
pub trait Surroundings {
    fn hold(&self, _states: &[BodyState]) -> Vec<(usize, Constraint)> {
        Vec::new()
    }
    /// Adds loads and contact; `first` are the first unknowns of the bodies.
    fn act(&self, states: &[BodyState], first: &[u32], order: Order, out: &mut Contribution);
    /// Told what step was taken.
    fn stepped(&mut self, _states: &[BodyState], _first: &[u32], _step: &[f64]) {}
}

pub fn first_unknowns(bodies: &[&dyn Body]) -> Vec<u32> {
    let mut first = vec![0];
    bodies.iter().for_each(|b| first.push(first[first.len() - 1] + b.unknowns() as u32));
    first
}

/// Adds in the numbers of a body.
pub fn add(first: u32, own: Contribution, out: &mut Contribution) {
    own.forces.iter().enumerate().for_each(|(k, f)| out.forces[first as usize + k] += f);
    for (unknowns, values) in own.blocks {
        out.add_block(&unknowns.iter().map(|u| u + first).collect::<Vec<_>>(), &values);
    }
}

pub fn load_body(
    body: &dyn Body,
    on: Option<&str>,
    load: &Load,
    state: &BodyState,
    order: Order,
    first: u32,
    out: &mut Contribution,
) {
    let mut own = Contribution::new(body.unknowns());
    body.load(on, load, state, order, &mut own).unwrap();
    add(first, own, out);
}

/// Displacements and rotations held at zero.
pub fn clamp(body: &dyn Body, on: &str, state: &BodyState) -> Vec<Constraint> {
    let zero = |_: &V| 0.0;
    let hold = Hold { displacement: [Some(&zero); 3], rotation: [Some(&zero); 3], ..Hold::default() };
    body.hold(Some(on), &hold, state).unwrap()
}

pub fn pin(body: &dyn Body, on: &str, state: &BodyState) -> Vec<Constraint> {
    let zero = |_: &V| 0.0;
    body.hold(Some(on), &Hold { displacement: [Some(&zero); 3], rotation: [None; 3], ..Hold::default() }, state)
        .unwrap()
}

#[derive(Clone, Copy, PartialEq)]
pub enum Search {
    WholeSteps,
    Shares,
}

pub struct Options {
    pub most: usize,
    /// Residual that is none.
    pub tolerance: f64,
    pub search: Search,
}

pub struct Found {
    pub states: Vec<BodyState>,
    pub residuals: Vec<f64>,
    /// Of the last residual: reactions where something is held.
    pub forces: Vec<f64>,
}

impl Found {
    pub fn iterations(&self) -> usize {
        self.residuals.len() - 1
    }
}

pub fn newton<S: Surroundings>(
    bodies: &[&dyn Body],
    start: &[BodyState],
    around: &mut S,
    options: &Options,
) -> Result<Found, Found> {
    let first = first_unknowns(bodies);
    let n = first[bodies.len()] as usize;
    let assemble = |around: &S, states: &[BodyState], order: Order| {
        let mut out = Contribution::new(n);
        for (b, body) in bodies.iter().enumerate() {
            let mut own = Contribution::new(body.unknowns());
            body.internal(&states[b], order, &mut own).unwrap();
            add(first[b], own, &mut out);
        }
        around.act(states, &first, order, &mut out);
        out
    };
    let held = |around: &S, states: &[BodyState]| {
        let mut prescribed = vec![None; n];
        for (b, c) in around.hold(states) {
            let terms: Vec<_> = c.terms.iter().filter(|t| t.1 != 0.0).collect();
            assert_eq!(terms.len(), 1);
            prescribed[(first[b] + terms[0].0) as usize] = Some(-c.violation / terms[0].1);
        }
        prescribed
    };
    let measure = |around: &S, states: &[BodyState]| {
        let out = assemble(around, states, Order::First);
        let free = held(around, states);
        let r =
            (0..n).map(|k| free[k].map_or(out.forces[k], |violation| violation)).fold(0.0f64, |m, v| m.max(v.abs()));
        (r, out.forces)
    };
    let mut states = start.to_vec();
    let (mut residual, mut forces) = measure(around, &states);
    let mut residuals = vec![residual];
    for _ in 0..options.most {
        if residual <= options.tolerance {
            return Ok(Found { states, residuals, forces });
        }
        let out = assemble(around, &states, Order::Second);
        let prescribed = held(around, &states);
        let mut right: Vec<f64> = out.forces.iter().map(|f| -f).collect();
        let mut entries = Vec::new();
        for (unknowns, values) in &out.blocks {
            let m = unknowns.len();
            for (r, &row) in unknowns.iter().enumerate().filter(|(_, r)| prescribed[**r as usize].is_none()) {
                for (c, &column) in unknowns.iter().enumerate() {
                    entries.push(Triplet::new(row as usize, column as usize, values[r * m + c]));
                }
            }
        }
        for k in 0..n {
            if let Some(value) = prescribed[k] {
                entries.push(Triplet::new(k, k, 1.0));
                right[k] = value;
            }
        }
        let Some(step) = solve(n, &entries, &right) else { break };
        let advance = |share: f64| -> Vec<BodyState> {
            let of = |b: usize| &step[first[b] as usize..first[b + 1] as usize];
            (0..bodies.len()).map(|b| bodies[b].advance(&states[b], of(b), share)).collect()
        };
        let shares: &[f64] =
            if options.search == Search::Shares { &[1.0, 0.6, 0.35, 0.2, 0.1, 0.05, 0.02] } else { &[1.0] };
        // Steps are no longer than a part of the bodies.
        let largest = step.iter().fold(0.0f64, |m, s| m.max(s.abs()));
        let size = bodies.iter().fold(0.0f64, |m, b| m.max(b.size()));
        let cap = if options.search == Search::Shares { (0.3 * size / largest).min(1.0) } else { 1.0 };
        let mut best: Option<(f64, f64)> = None;
        for share in shares.iter().map(|s| s * cap) {
            let r = measure(around, &advance(share)).0;
            if best.is_none_or(|b| r < b.1) {
                best = Some((share, r));
            }
            if r <= (1.0 - 0.1 * share) * residual {
                break;
            }
        }
        let share = best.map_or(1.0, |b| b.0);
        let next = advance(share);
        let scaled: Vec<f64> = step.iter().map(|s| s * share).collect();
        around.stepped(&states, &first, &scaled);
        states = next;
        (residual, forces) = measure(around, &states);
        residuals.push(residual);
        if !residual.is_finite() {
            break;
        }
        let largest = scaled.iter().fold(0.0f64, |m, s| m.max(s.abs()));
        if largest < 1e-11 {
            return Ok(Found { states, residuals, forces });
        }
    }
    if residual <= options.tolerance {
        return Ok(Found { states, residuals, forces });
    }
    Err(Found { states, residuals, forces })
}

/// Sparse LU with one refinement.
fn solve(n: usize, entries: &[Triplet<usize, usize, f64>], right: &[f64]) -> Option<Vec<f64>> {
    let matrix = SparseColMat::<usize, f64>::try_new_from_triplets(n, n, entries).ok()?;
    let lu = matrix.sp_lu().ok()?;
    let b = faer::Mat::from_fn(n, 1, |i, _| right[i]);
    let x = lu.solve(&b);
    let x = &x + lu.solve(&(&b - &matrix * &x));
    let x: Vec<f64> = (0..n).map(|i| x[(i, 0)]).collect();
    x.iter().all(|v| v.is_finite()).then_some(x)
}
