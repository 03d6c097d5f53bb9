//! A problem of elastic solids in contact, and its solution at one time.

use crate::assembly::{assemble, positions};
use crate::body::Bodies;
use crate::contact::{Contact, ContactResult, Enforcement, Method, PressureNode, RigidGap};
use crate::rigid_modes::{FreeMode, free_modes};
use crate::supports::{Displacement, Reduction, Support, SupportError};
use signorini_contact::{
    ActiveSet, ActiveSetError, Compliance, ContactState, Softness, Spring, WeightedGap, compress, recovered,
};
use signorini_geometry::Point;
use signorini_solve::cholesky::Symbolic;
use signorini_solve::dissection::nested_dissection;
use signorini_solve::{Factor, SolveError, SymmetricMatrix};

/// Why a step has no solution.
#[derive(Clone, Debug, thiserror::Error)]
pub enum StepError {
    #[error(transparent)]
    Support(#[from] SupportError),
    #[error(transparent)]
    Solve(#[from] SolveError),
    #[error("contact `{contact}`: {error}")]
    Contact { contact: String, error: ActiveSetError, places: Vec<String> },
    #[error("body `{body}` is free {motion}")]
    Free { body: String, motion: String },
    #[error("contact `{contact}`: a face of the master makes no shape: {message}")]
    Shape { contact: String, message: String },
    /// Most of the slave side is inside the master before anything moves.
    #[error("contact `{contact}`: the bodies start {depth:.4e} deep in each other")]
    Deep { contact: String, depth: f64 },
    #[error("interrupted")]
    Interrupted,
}

/// The solution at one time.
#[derive(Clone, Debug)]
pub struct State<const D: usize> {
    /// Unknowns of all bodies.
    pub u: Vec<f64>,
    pub contacts: Vec<ContactResult<D>>,
    pub iterations: usize,
    /// Nodes that changed in each iteration.
    pub changes: Vec<usize>,
    /// Force of each support on the bodies.
    pub support_forces: Vec<Point<D>>,
    /// Largest unbalanced force relative to the largest of all.
    pub imbalance: f64,
    /// Strain energy.
    pub energy: f64,
    pub unknowns: usize,
}

/// Bodies, supports and contacts.
pub struct Model<const D: usize> {
    pub bodies: Bodies<D>,
    pub supports: Vec<Support>,
    pub contacts: Vec<Contact<D>>,
    reduction: Reduction<D>,
    stiffness: SymmetricMatrix,
    factor: Factor,
    springs: Vec<Spring>,
    free: Vec<FreeMode>,
    active: ActiveSet,
    started: bool,
}

/// What may change with time.
pub struct Circumstances<'a, const D: usize> {
    pub displacement: Displacement<'a, D>,
    /// Forces on the unknowns of the bodies.
    pub load: Vec<f64>,
    /// Where rigid masters are, by contact.
    pub rigid: Vec<Option<RigidGap<D>>>,
}

struct System<'a>(&'a Factor);

impl Compliance for System<'_> {
    fn solve_columns(&self, b: &mut [f64]) -> Result<(), SolveError> {
        self.0.solve_columns(b)
    }

    fn solve_accurately(&self, b: &[f64]) -> Result<Vec<f64>, SolveError> {
        self.0.solve_accurately(b)
    }

    fn size(&self) -> usize {
        self.0.size()
    }
}

impl<const D: usize> Model<D> {
    /// Assembles and factorises the stiffness.
    pub fn new(bodies: Bodies<D>, supports: Vec<Support>, contacts: Vec<Contact<D>>) -> Result<Self, StepError> {
        let reduction = Reduction::new(&bodies, &supports)?;
        let stiffness = assemble(&bodies, &supports);
        let free = free_modes(&bodies, &supports, &reduction);
        let mut reduced = stiffness.transformed(reduction.unknowns, |i| reduction.row(i));
        let diagonal = reduced.diagonal();
        let mut springs: Vec<Spring> = Vec::new();
        for mode in &free {
            let row = reduction.row(mode.unknown);
            let Some((unknown, _)) = row.iter().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())) else { continue };
            let stiffness = diagonal[*unknown as usize];
            springs.push(Spring { unknown: *unknown, stiffness });
            reduced.add(&[*unknown], &[stiffness], 1.0);
        }
        let mut symbolic = if D == 3 {
            Symbolic::ordered(nested_dissection(&reduced, &positions(&bodies, &reduction)))
        } else {
            Symbolic::default()
        };
        let factor = symbolic.factor(reduced)?;
        Ok(Model {
            bodies,
            supports,
            contacts,
            reduction,
            stiffness,
            factor,
            springs,
            free,
            active: ActiveSet::default(),
            started: false,
        })
    }

    /// Motions that only contact can hold.
    pub fn free_modes(&self) -> &[FreeMode] {
        &self.free
    }

    /// Number of unknowns that are solved for.
    pub fn unknowns(&self) -> usize {
        self.reduction.unknowns
    }

    /// Solves for the displacement at one time. `report` gets the iteration and how many nodes changed, and says
    /// whether to go on.
    pub fn solve(
        &mut self,
        now: &Circumstances<'_, D>,
        report: &mut dyn FnMut(usize, usize) -> bool,
    ) -> Result<State<D>, StepError> {
        let offset = self.reduction.offset(&self.bodies, &self.supports, now.displacement)?;
        let moved = self.stiffness.multiply(&offset);
        let load: Vec<f64> = now.load.iter().zip(&moved).map(|(f, m)| f - m).collect();
        let load = self.reduction.restrict(&load);
        let mut rows = Vec::new();
        let mut ends = Vec::new();
        for (contact, rigid) in self.contacts.iter_mut().zip(&now.rigid) {
            contact.search(&self.reduction, rigid.as_ref())?;
            rows.extend(contact.rows.iter().map(|row| reduced(row, &self.reduction, &offset)));
            ends.push(rows.len());
        }
        if !self.started {
            for contact in &self.contacts {
                contact.check_start()?;
            }
            self.started = true;
        }
        if rows.is_empty() && !self.free.is_empty() {
            return Err(self.free_body());
        }
        let mut changes = Vec::new();
        let mut logged = |iteration: usize, changed: usize| {
            changes.push(changed);
            report(iteration, changed)
        };
        let found = match self.solve_enforced(&rows, &ends, &load, &mut logged) {
            Ok(found) => found,
            Err(ActiveSetError::Interrupted) => return Err(StepError::Interrupted),
            Err(ActiveSetError::Free) => return Err(self.free_body()),
            Err(error) => return Err(self.contact_error(error, &ends)),
        };
        let u = self.reduction.expand(&found.u, &offset);
        let mut forces = self.stiffness.multiply(&u);
        let energy = 0.5 * forces.iter().zip(&u).map(|(f, u)| f * u).sum::<f64>();
        let mut results = Vec::new();
        let mut first = 0;
        let mut contact_force = vec![0.0; forces.len()];
        for (contact, end) in self.contacts.iter().zip(ends) {
            let mut result = ContactResult::<D> { nodes: Vec::new(), force: Point::<D>::zeros(), area: 0.0 };
            let body = contact.slave.body();
            let vertices: std::collections::HashSet<u32> = (contact.slave.sides.iter())
                .flat_map(|s| body.mesh.side_vertices(*s))
                .filter_map(|v| body.dofs.vertex(v))
                .map(|f| (body.first + D * f as usize) as u32)
                .collect();
            for (k, row) in contact.rows.iter().enumerate() {
                let pressure = found.pressure[first + k];
                for (unknown, c) in &row.terms {
                    contact_force[*unknown as usize] += c * pressure;
                    let i = *unknown as usize % D;
                    if vertices.contains(&(unknown - i as u32)) {
                        result.force[i] += c * pressure;
                    }
                }
                let active = found.active[first + k];
                if active {
                    result.area += row.weight;
                }
                if contact.method != Method::GaussPoint {
                    result.nodes.push(PressureNode {
                        x: contact.nodes.positions[row.node as usize],
                        multiplier: pressure,
                        pressure,
                        gap: found.gap[first + k] / row.weight,
                        active,
                        weight: row.weight,
                        number: row.node,
                    });
                }
            }
            if contact.method == Method::GaussPoint {
                let range = first..end;
                result.nodes =
                    contact.averaged(&found.pressure[range.clone()], &found.gap[range.clone()], &found.active[range]);
            }
            first = end;
            let count = contact.nodes.len();
            let (mut multiplier, mut weight, mut active) = (vec![0.0; count], vec![0.0; count], vec![false; count]);
            let mut weightless = vec![false; count];
            for given in &contact.given {
                // A node may have given its function on to one that gave its own away.
                let Some(to) = result.nodes.iter().find(|n| n.number == given.to).copied() else { continue };
                let x = contact.nodes().positions[given.from as usize];
                weightless[given.from as usize] = given.weightless;
                result.nodes.push(PressureNode { x, weight: 0.0, number: given.from, ..to });
            }
            for node in &result.nodes {
                let k = node.number as usize;
                (multiplier[k], weight[k], active[k]) = (node.multiplier, node.weight, node.active);
            }
            let pressure = match contact.method {
                Method::Mortar => {
                    recovered(&contact.nodes, &contact.points, &multiplier, &weight, &active, &weightless)
                }
                _ => multiplier,
            };
            result.nodes.iter_mut().for_each(|node| node.pressure = pressure[node.number as usize]);
            results.push(result);
        }
        for ((force, load), contact) in forces.iter_mut().zip(&now.load).zip(&contact_force) {
            *force -= load + contact;
        }
        // What is left are the reactions, and nothing on free unknowns.
        let unbalanced = self.reduction.restrict(&forces);
        let scale = forces.iter().chain(&contact_force).chain(&now.load).fold(f64::MIN_POSITIVE, |m, f| m.max(f.abs()));
        let imbalance = unbalanced.iter().fold(0.0f64, |m, f| m.max(f.abs())) / scale;
        let support_forces = (self.reduction.reactions.iter())
            .map(|list| {
                let mut sum = Point::<D>::zeros();
                for f in list {
                    for i in 0..D {
                        sum[i] += forces[*f as usize * D + i];
                    }
                }
                sum
            })
            .collect();
        Ok(State {
            u,
            contacts: results,
            iterations: found.iterations,
            changes,
            support_forces,
            imbalance,
            energy,
            unknowns: self.reduction.unknowns,
        })
    }

    /// The active set, with outer iterations where the enforcement asks for them.
    fn solve_enforced(
        &mut self,
        rows: &[WeightedGap],
        ends: &[usize],
        load: &[f64],
        report: &mut dyn FnMut(usize, usize) -> bool,
    ) -> Result<ContactState, ActiveSetError> {
        let mut soft = vec![Softness::default(); rows.len()];
        let system = System(&self.factor);
        let range = |k: usize| if k == 0 { 0..ends[0] } else { ends[k - 1]..ends[k] };
        // Multiples of the stiffness of the cells.
        let mut factor = vec![100.0; self.contacts.len()];
        let mut total = 0;
        for outer in 0..MOST_OUTER {
            for (k, contact) in self.contacts.iter().enumerate() {
                if contact.enforcement == Enforcement::Multiplier {
                    continue;
                }
                for (row, stiffness) in range(k).zip(&contact.stiffness) {
                    soft[row].compliance = rows[row].weight / (factor[k] * stiffness);
                }
            }
            let mut found = self.active.solve(&system, rows, &soft, &self.springs, load, report)?;
            total += found.iterations;
            found.iterations = total;
            let mut again = false;
            for (k, contact) in self.contacts.iter().enumerate() {
                let deepest = |rows_of: &mut dyn Iterator<Item = usize>| {
                    rows_of.map(|r| -found.gap[r] / rows[r].weight).fold(0.0, f64::max)
                };
                match contact.enforcement {
                    Enforcement::Multiplier | Enforcement::Penalty { wanted_penetration: None } => {}
                    Enforcement::Penalty { wanted_penetration: Some(wanted) } => {
                        let reached = deepest(&mut range(k));
                        if reached > 0.0 && !(0.98..=1.02).contains(&(reached / wanted)) {
                            factor[k] *= reached / wanted;
                            again = true;
                        }
                    }
                    Enforcement::AugmentedLagrangian => {
                        let moved = found.u.iter().fold(0.0f64, |m, u| m.max(u.abs()));
                        let mut open = range(k).filter(|&r| found.active[r]);
                        let worst = open.by_ref().map(|r| (found.gap[r] / rows[r].weight).abs()).fold(0.0, f64::max);
                        if worst > 1e-11 * moved {
                            range(k).for_each(|r| soft[r].shift = found.pressure[r]);
                            again = true;
                        }
                    }
                }
            }
            if !again || outer + 1 == MOST_OUTER {
                return if again { Err(ActiveSetError::TooMany { iterations: total }) } else { Ok(found) };
            }
        }
        Err(ActiveSetError::TooMany { iterations: total })
    }

    fn free_body(&self) -> StepError {
        match self.free.first() {
            Some(mode) => StepError::Free { body: mode.body.clone(), motion: mode.motion.clone() },
            None => StepError::Free { body: String::new(), motion: "to move".into() },
        }
    }

    /// The contact that has no state, and where. `ends` are the ends of the rows of each contact.
    fn contact_error(&self, error: ActiveSetError, ends: &[usize]) -> StepError {
        let mut names: Vec<&str> = Vec::new();
        let mut places = Vec::new();
        if let ActiveSetError::Chatter { rows } = &error {
            for &row in rows {
                let which = ends.iter().position(|end| row < *end).unwrap_or(0);
                let contact = &self.contacts[which];
                let first = if which == 0 { 0 } else { ends[which - 1] };
                names.push(&contact.name);
                let x: Vec<String> = contact.position(row - first).iter().map(|v| format!("{v:.6}")).collect();
                places.push(format!("({})", x.join(", ")));
            }
        } else {
            names.extend(self.contacts.iter().map(|c| c.name.as_str()));
        }
        names.dedup();
        StepError::Contact { contact: names.join("`, `"), error, places }
    }
}

/// The most outer iterations of a penalty that is adjusted, or of an augmented Lagrangian.
const MOST_OUTER: usize = 60;

/// A row in the unknowns that remain.
fn reduced<const D: usize>(row: &WeightedGap, reduction: &Reduction<D>, offset: &[f64]) -> WeightedGap {
    let mut terms: Vec<(u32, f64)> = Vec::with_capacity(row.terms.len());
    let mut gap = row.gap;
    for (unknown, c) in &row.terms {
        gap += c * offset[*unknown as usize];
        terms.extend(reduction.row(*unknown as usize).iter().map(|(k, t)| (*k, c * t)));
    }
    compress(&mut terms);
    WeightedGap { gap, weight: row.weight, terms, node: row.node }
}
