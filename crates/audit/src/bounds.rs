//! Least and largest forces of contacts whose forces balance does not determine.
//!
//! Of all forces at the places that touch which balance the given loads, push, and lie within the cone of friction, those with
//! the least and the largest sum of normal forces at a contact are wanted. All forces that hold are a convex set (J. J. Moreau,
//! *Unilateral contact and dry friction in finite freedom dynamics*, 1988), and each bound is a second-order cone program
//! (M. S. Lobo, L. Vandenberghe, S. Boyd, H. Lebret, *Applications of second-order cone programming*, 1998, section 3.4: forces
//! of a grasp), in the plane a linear one. They are solved by the interior-point method of `clarabel` (P. Goulart, Y. Chen,
//! 2024), which tells by a certificate where there is no bound: bodies that clamp each other.
//!
//! Friction at a place that slips is known, against the slip and by the normal force. Of friction that differs with the
//! direction the axes are not told: its ellipse is taken for the circle around it, and bounds may be wider than they are.

use crate::groups::{Group, groups, touching};
use crate::place::Friction;
use crate::state::{Setting, Space, State};
use crate::statics::{Independent, Statics};
use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};

/// Places times contacts of a group beyond which bounds are not looked for. Each contact takes two programs, each of a time by the
/// number of places: some 40 µs times this product, so that this many take a tenth of a second.
const MOST: usize = 3000;
/// Part of the loads that forces at the places may not hold, as in the check of balance: beyond it there is no balance to look
/// at.
const LACKS: f64 = 1e-4;
/// Errors of the programs relative to the loads.
const SOLVED: f64 = 1e-10;
/// The same where the set of forces has no inside, so that the last digits are not reached.
const NEARLY: f64 = 1e-7;

/// Between what the normal force of a contact lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceBounds {
    pub contact: usize,
    /// The least sum of the normal forces of its places.
    pub least: f64,
    /// The largest; none where there is no bound.
    pub largest: Option<f64>,
}

impl ForceBounds {
    /// How far apart they are.
    pub fn width(&self) -> f64 {
        self.largest.map_or(f64::INFINITY, |largest| largest - self.least)
    }
}

/// Bounds of the normal force of each contact of rigid bodies that balance does not determine, by contact. Nothing is told of
/// groups that are too large, that a support holds in part, or whose loads no forces balance.
pub fn bounds(setting: &Setting, state: &State) -> Vec<ForceBounds> {
    let mut out: Vec<ForceBounds> =
        groups(setting, state).iter().flat_map(|group| of_group(setting, state, group)).collect();
    out.sort_by_key(|b| b.contact);
    out
}

fn of_group(setting: &Setting, state: &State, group: &Group) -> Vec<ForceBounds> {
    let places = group.places(setting, |k| touching(setting, state, k));
    let at_places = group.contacts.iter().all(|k| setting.contacts[*k].at_places);
    if !at_places || group.is_supported(state) || places.len() * group.contacts.len() > MOST {
        return Vec::new();
    }
    let statics = Statics::new(setting, state, group, places);
    let balance = statics.independent();
    if balance.rows.nrows() == statics.unknowns || balance.lack > LACKS {
        return Vec::new();
    }
    let program = Program::new(setting.space, &statics, &balance);
    group.contacts.iter().filter_map(|k| program.bounds(*k)).collect()
}

/// All forces that hold: `a y + s = b`, with slacks `s` within cones.
struct Program<'a> {
    statics: &'a Statics<'a>,
    a: CscMatrix<f64>,
    b: Vec<f64>,
    cones: Vec<SupportedConeT<f64>>,
}

impl<'a> Program<'a> {
    fn new(space: Space, statics: &'a Statics<'a>, balance: &Independent) -> Self {
        let mut rows = Rows::default();
        for (row, right) in balance.rows.row_iter().zip(balance.right.iter()) {
            rows.add(row.iter().copied().enumerate(), *right);
        }
        rows.cones.push(SupportedConeT::ZeroConeT(balance.rows.nrows()));
        let unit = if statics.force > 0.0 { statics.force } else { 1.0 };
        for (place, first) in statics.places.iter().zip(&statics.first) {
            rows.add_place(space, *first, &place.friction, unit);
        }
        let a = CscMatrix::new_from_triplets(rows.right.len(), statics.unknowns, rows.row, rows.column, rows.value);
        Program { statics, a, b: rows.right, cones: rows.cones }
    }

    /// The bounds of a contact; none where a program could not be solved.
    fn bounds(&self, contact: usize) -> Option<ForceBounds> {
        let [least, largest] = [self.solve(contact, 1.0)?, self.solve(contact, -1.0)?];
        // What is less than what is left of errors is none.
        let told = |v: f64| if v > NEARLY { v * self.statics.force } else { 0.0 };
        let least = told(least?);
        Some(ForceBounds { contact, least, largest: largest.map(|v| told(v).max(least)) })
    }

    /// The normal force of a contact that is least in a direction: none inside where it has no bound.
    fn solve(&self, contact: usize, sign: f64) -> Option<Option<f64>> {
        let mut q = vec![0.0; self.statics.unknowns];
        let own = self.statics.places.iter().zip(&self.statics.first).filter(|(p, _)| p.contact == contact);
        own.for_each(|(_, first)| q[*first] = sign);
        let p = CscMatrix::zeros((q.len(), q.len()));
        let mut solver = DefaultSolver::new(&p, &q, &self.a, &self.b, &self.cones, settings()).ok()?;
        solver.solve();
        match solver.solution.status {
            SolverStatus::Solved | SolverStatus::AlmostSolved => Some(Some(sign * solver.solution.obj_val)),
            SolverStatus::DualInfeasible | SolverStatus::AlmostDualInfeasible => Some(None),
            _ => None,
        }
    }
}

fn settings() -> DefaultSettings<f64> {
    DefaultSettings {
        verbose: false,
        max_threads: 1,
        tol_gap_abs: SOLVED,
        tol_gap_rel: SOLVED,
        tol_feas: SOLVED,
        reduced_tol_gap_abs: NEARLY,
        reduced_tol_gap_rel: NEARLY,
        reduced_tol_feas: NEARLY,
        reduced_tol_infeas_abs: NEARLY,
        reduced_tol_infeas_rel: NEARLY,
        ..DefaultSettings::default()
    }
}

/// Entries of a matrix by row, the right side, and the cones of the slacks.
#[derive(Default)]
struct Rows {
    row: Vec<usize>,
    column: Vec<usize>,
    value: Vec<f64>,
    right: Vec<f64>,
    cones: Vec<SupportedConeT<f64>>,
}

impl Rows {
    fn add(&mut self, entries: impl IntoIterator<Item = (usize, f64)>, right: f64) {
        for (column, value) in entries.into_iter().filter(|e| e.1 != 0.0) {
            self.row.push(self.right.len());
            self.column.push(column);
            self.value.push(value);
        }
        self.right.push(right);
    }

    /// The normal force `first` of a place pushes, and the friction that follows is less than its part of it, or than a constant.
    fn add_place(&mut self, space: Space, first: usize, friction: &Friction, unit: f64) {
        let (part, constant) = match friction {
            Friction::Cone(mu) => (*mu, 0.0),
            Friction::Disc(most) => (0.0, most / unit),
            _ => return self.add_push(first),
        };
        // A cone of friction holds no force that pulls.
        if part == 0.0 {
            self.add_push(first);
        }
        if space == Space::ThreeD {
            self.add([(first, -part)], constant);
            [1, 2].iter().for_each(|k| self.add([(first + k, -1.0)], 0.0));
            self.cones.push(SupportedConeT::SecondOrderConeT(3));
        } else {
            [1.0, -1.0].iter().for_each(|sign| self.add([(first, -part), (first + 1, *sign)], constant));
            self.cones.push(SupportedConeT::NonnegativeConeT(2));
        }
    }

    fn add_push(&mut self, first: usize) {
        self.add([(first, -1.0)], 0.0);
        self.cones.push(SupportedConeT::NonnegativeConeT(1));
    }
}
