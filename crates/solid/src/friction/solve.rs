//! The state of stick and slip of all contacts of a model at one time.

use super::statement::{Found, FrictionAt, FrictionHistory};
use crate::condensed::reduced;
use crate::contact::Enforcement;
use crate::model::{Circumstances, Model};
use crate::state::{Found as FoundState, State};
use crate::step_error::StepError;
use signorini_contact::friction::{Bodies, FrictionError, FrictionState, Node};
use signorini_contact::{ActiveSetError, ContactState, Softness, Status, WeightedGap, compress};
use signorini_geometry::Point;
use std::collections::BTreeMap;

/// Part of the weight of a row below which its slips move nothing that is free.
const HELD: f64 = 1e-7;
/// How a slip that supports hold gives way, in terms of the cells behind it: friction that moves nothing is then that of
/// slip under a slip of this share of the deformation, and none without slip.
const YIELDS: f64 = 1e-4;

type ByNode = BTreeMap<(usize, u32), [f64; 3]>;

fn by_node(list: &[(usize, u32, [f64; 3])]) -> ByNode {
    list.iter().map(|(contact, node, v)| ((*contact, *node), *v)).collect()
}

impl<const D: usize> Model<D> {
    /// Whether there is friction anywhere.
    pub fn rubs(&self) -> bool {
        self.contacts.iter().any(|c| c.friction.is_some())
    }

    /// Tractions of all contacts in the unknowns that remain, and displacements under them.
    pub(crate) fn solve_rubbing(
        &mut self,
        offset: &[f64],
        load: &[f64],
        ends: &[usize],
        report: &mut dyn FnMut(usize, usize) -> bool,
    ) -> Result<(ContactState, Found), StepError> {
        let zero;
        let before = match &self.history {
            Some(history) => history,
            None => {
                zero = FrictionHistory { u: vec![0.0; self.bodies.unknowns()], ..FrictionHistory::default() };
                &zero
            }
        };
        let (last, slipped) = (by_node(&before.traction), by_node(&before.slip));
        let mut rows: Vec<WeightedGap> = Vec::new();
        let mut nodes: Vec<Node<'_>> = Vec::new();
        let mut start = Vec::new();
        let mut keys = Vec::new();
        let mut held = Vec::new();
        for (k, contact) in self.contacts.iter().enumerate() {
            for (i, row) in contact.rows.iter().enumerate() {
                let key = (k, row.node);
                let known = last.get(&key).copied().unwrap_or_default();
                let law = contact.friction.as_ref().map(|f| f.law.as_ref());
                let mut node = Node { first: rows.len(), tangents: 0, directions: [[1.0, 0.0], [0.0, 1.0]], law };
                rows.push(reduced(row, &self.reduction, offset));
                start.push(known[0]);
                if law.is_some() {
                    let slips = contact.slips.rows[i].rows.iter().map(|slip| {
                        let moved = slip.at(&before.u) - slip.gap;
                        let slip = WeightedGap { gap: slip.gap - moved, ..slip.clone() };
                        reduced(&slip, &self.reduction, offset)
                    });
                    let (list, directions, of_supports) = separated(slips.collect(), HELD * row.weight);
                    (node.tangents, node.directions) = (list.len(), directions);
                    start.extend(directions.iter().take(list.len()).map(|v| v[0] * known[1] + v[1] * known[2]));
                    let compliance = YIELDS * row.weight / contact.stiffness[i];
                    let which = (rows.len()..rows.len() + list.len()).zip(of_supports).filter(|(_, held)| *held);
                    held.extend(which.map(|(r, _)| (r, compliance)));
                    rows.extend(list);
                }
                nodes.push(node);
                keys.push((key, i));
            }
        }
        let normals: Vec<WeightedGap> = nodes.iter().map(|n| rows[n.first].clone()).collect();
        let Some(factor) = &self.factor else { return Err(self.free_body(&[])) };
        let mut rubbing = std::mem::take(&mut self.rubbing);
        let mut found: Option<FrictionState> = None;
        let solved = self.solve_enforced(&normals, ends, report, &mut |soft, report| {
            let mut all = vec![Softness::default(); rows.len()];
            nodes.iter().zip(soft).for_each(|(node, s)| all[node.first] = *s);
            for ((node, s), ((contact, _), _)) in nodes.iter().zip(soft).zip(&keys) {
                // With a penalty friction gives way as the pressure does, from the traction of the last state.
                if matches!(self.contacts[*contact].enforcement, Enforcement::Penalty { .. }) {
                    let rows = node.rows().skip(1);
                    rows.for_each(|r| all[r] = Softness { compliance: s.compliance, shift: start[r] });
                }
            }
            held.iter().for_each(|(r, compliance)| all[*r] = Softness { compliance: *compliance, shift: 0.0 });
            let bodies = Bodies { system: factor, rows: &rows, soft: &all, springs: &self.springs, load };
            let state = rubbing.solve(bodies, &nodes, &start, report).map_err(|error| self.unsolved(error))?;
            let of_nodes = |list: &[f64]| nodes.iter().map(|n| list[n.first]).collect();
            let out = ContactState {
                u: state.u.clone(),
                pressure: of_nodes(&state.traction),
                gap: of_nodes(&state.gap),
                active: state.status.iter().map(|s| *s != Status::Open).collect(),
                iterations: state.iterations,
                route: state.route,
            };
            found = Some(state);
            Ok(out)
        });
        let axes = |node: &Node<'_>, list: &[f64]| {
            let mut out = [0.0; 2];
            for (row, v) in node.rows().skip(1).zip(&node.directions) {
                out = [out[0] + list[row] * v[0], out[1] + list[row] * v[1]];
            }
            out
        };
        let of_node = |found: &FrictionState, k: usize| {
            let node = &nodes[k];
            let (key, row) = keys[k];
            let status = found.status[k];
            let increment = axes(node, &found.gap);
            let mut slip = slipped.get(&key).copied().unwrap_or_default();
            if status == Status::Slip && node.law.is_some() {
                for (e, y) in self.contacts[key.0].slips.rows[row].axes.iter().zip(increment) {
                    (0..D).for_each(|i| slip[i] += e[i] * y / normals[k].weight);
                }
            }
            FrictionAt {
                status,
                traction: axes(node, &found.traction),
                increment,
                slip,
                closed_before: last.get(&key).is_some_and(|t| t[0] > 0.0),
                uniqueness: found.uniqueness[k],
            }
        };
        let at = found.as_ref().map(|f| (0..nodes.len()).map(|k| of_node(f, k)).collect());
        let unstable = found.is_some_and(|f| f.unstable);
        self.rubbing = rubbing;
        let (state, _) = solved.map_err(|error| self.explained(error, ends))?;
        Ok((state, Found { at: at.unwrap_or_default(), unstable }))
    }

    /// In terms of rows of pressures.
    fn unsolved(&self, error: FrictionError) -> ActiveSetError {
        match error {
            FrictionError::Solve(error) => error.into(),
            FrictionError::Interrupted => ActiveSetError::Interrupted,
            FrictionError::Singular if self.springs.is_empty() => ActiveSetError::Dependent,
            FrictionError::Singular => ActiveSetError::Free { motion: Vec::new() },
            FrictionError::NotFound { solves, nodes } => ActiveSetError::Friction { solves, rows: nodes },
        }
    }

    /// The state found, from which slips count from now on.
    pub(crate) fn rubbed(
        &mut self,
        (found, rubbing): (ContactState, Found),
        residuals: Vec<f64>,
        now: &Circumstances<'_, D>,
        (offset, ends): (&[f64], &[usize]),
    ) -> State<D> {
        let u = self.reduction.expand(&found.u, offset);
        let mut history = FrictionHistory { u: u.clone(), ..FrictionHistory::default() };
        let mut row = 0;
        for (k, contact) in self.contacts.iter_mut().enumerate() {
            history.motion.push(contact.slips.now.iter().flat_map(|u| u.iter().copied()).collect());
            contact.slips.before.clone_from(&contact.slips.now);
            for of in &contact.rows {
                let at = &rubbing.at[row];
                let traction = [found.pressure[row], at.traction[0], at.traction[1]];
                for (list, v) in [(&mut history.traction, traction), (&mut history.slip, at.slip)] {
                    if v != [0.0; 3] {
                        list.push((k, of.node, v));
                    }
                }
                row += 1;
            }
        }
        self.history = Some(history);
        let ContactState { pressure, gap, active, iterations, route, .. } = found;
        let found = FoundState { u, pressure, gap, active, iterations, route, residuals, rubbing: Some(rubbing) };
        self.state(found, &now.load, ends)
    }

    /// Whether a history can be of this model.
    pub(crate) fn has_history(&self, history: &FrictionHistory) -> bool {
        history.u.len() == self.bodies.unknowns()
            && history.motion.len() == self.contacts.len()
            && history.motion.iter().all(|list| list.len() % D == 0)
    }

    /// Goes on from a history.
    pub(crate) fn remember(&mut self, history: Option<FrictionHistory>) {
        for (k, contact) in self.contacts.iter_mut().enumerate() {
            let list = history.as_ref().and_then(|h| h.motion.get(k)).map_or(&[][..], |list| list);
            contact.slips.before = list.chunks_exact(D).map(Point::<D>::from_column_slice).collect();
        }
        self.history = history;
    }
}

/// The slips of a node with their directions in its axes, and which of them supports hold altogether. Where they hold one
/// between the axes, as on a plane of symmetry that is skew to them, the slips are those along it and across.
pub fn separated(slips: Vec<WeightedGap>, limit: f64) -> (Vec<WeightedGap>, [[f64; 2]; 2], [bool; 2]) {
    let plain = [[1.0, 0.0], [0.0, 1.0]];
    let product = |a: &WeightedGap, b: &WeightedGap| {
        let mut sum = 0.0;
        let mut others = b.terms.iter().peekable();
        for (unknown, c) in &a.terms {
            while others.next_if(|(other, _)| other < unknown).is_some() {}
            sum += others.next_if(|(other, _)| other == unknown).map_or(0.0, |(_, d)| c * d);
        }
        sum
    };
    let limit = limit * limit;
    let [first, second] = &slips[..] else {
        let held = slips.iter().all(|s| product(s, s) <= limit);
        return (slips, plain, [held, false]);
    };
    let (a, b, c) = (product(first, first), product(second, second), product(first, second));
    let (mean, spread) = (0.5 * (a + b), (0.5 * (a - b)).hypot(c));
    if mean - spread > limit || mean + spread <= limit {
        return (slips, plain, [mean + spread <= limit; 2]);
    }
    let (s, co) = (0.5 * (2.0 * c).atan2(a - b)).sin_cos();
    let combined = |f: f64, g: f64| {
        let scaled = |list: &[(u32, f64)], f: f64| list.iter().map(|(i, v)| (*i, f * v)).collect::<Vec<_>>();
        let mut terms = scaled(&first.terms, f);
        terms.extend(scaled(&second.terms, g));
        compress(&mut terms);
        WeightedGap { gap: f * first.gap + g * second.gap, terms, ..first.clone() }
    };
    let mut across = combined(-s, co);
    across.terms.clear();
    (vec![combined(co, s), across], [[co, s], [-s, co]], [false, true])
}
