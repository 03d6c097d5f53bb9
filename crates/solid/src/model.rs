//! A problem of elastic solids in contact, and its solution at one time.

use crate::assembly::{assemble, graph, positions};
use crate::body::Bodies;
use crate::condensed::reduced;
use crate::contact::{Contact, RigidGap};
use crate::friction::refuse_unsupported;
use crate::friction::statement::{FrictionHistory, RigidMotion};
use crate::held::check_held;
use crate::rigid_modes::{FreeMode, free_modes};
use crate::state::{Found, State};
use crate::step_error::StepError;
use crate::supports::{Displacement, Reduction, Support};
use signorini_contact::friction::FrictionalContact;
use signorini_contact::{ActiveSet, ActiveSetError, ContactState, Route, Spring, WeightedGap};
use signorini_solve::cholesky::{Cost, Symbolic};
use signorini_solve::{Factor, SolveError, SymmetricMatrix};

/// Bodies, supports and contacts.
pub struct Model<const D: usize> {
    pub bodies: Bodies<D>,
    pub supports: Vec<Support>,
    pub contacts: Vec<Contact<D>>,
    pub(crate) reduction: Reduction<D>,
    /// Assembled, with what follows from it, when it is first solved with.
    pub(crate) stiffness: SymmetricMatrix,
    /// What Nitsche's method adds to it, as matrices of a few unknowns each until then.
    terms: Vec<(Vec<u32>, Vec<f64>)>,
    pub(crate) added: Option<SymmetricMatrix>,
    /// The stiffness of the unknowns that remain, springs included; handed on to its factor unless contact adds to it.
    pub(crate) reduced: Option<SymmetricMatrix>,
    pub(crate) symbolic: Symbolic,
    pub(crate) factor: Option<Factor>,
    pub(crate) springs: Vec<Spring>,
    free: Vec<FreeMode>,
    active: ActiveSet,
    started: bool,
    /// With friction, what slips count from; none before the first state.
    pub(crate) history: Option<FrictionHistory>,
    pub(crate) rubbing: FrictionalContact,
    pub(crate) route: Option<Route>,
}

/// What may change with time.
pub struct Circumstances<'a, const D: usize> {
    pub displacement: Displacement<'a, D>,
    /// Forces on the unknowns of the bodies.
    pub load: Vec<f64>,
    /// Where rigid masters are, by contact.
    pub rigid: Vec<Option<RigidGap<D>>>,
    /// How their points were displaced since the start, by contact, for friction; where there is none they only move
    /// along their normals.
    pub motion: Vec<Option<RigidMotion<D>>>,
}

/// What a model carries from one time to the next.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Memory {
    /// The rows that were active, of how many.
    pub active: (Vec<usize>, usize),
    /// With friction: what slips count from.
    pub friction: Option<FrictionHistory>,
}

impl<const D: usize> Model<D> {
    /// A model of bodies at rest; nothing is assembled yet.
    ///
    /// # Errors
    /// A support along the normal of what is not flat.
    #[inline(never)]
    pub fn new(bodies: Bodies<D>, supports: Vec<Support>, contacts: Vec<Contact<D>>) -> Result<Self, StepError> {
        let reduction = Reduction::new(&bodies, &supports)?;
        let mut contacts = contacts;
        let mut terms = Vec::new();
        for contact in &mut contacts {
            terms.extend(contact.stress_terms(&bodies));
        }
        refuse_unsupported(&contacts)?;
        let free = free_modes(&bodies, &supports, &reduction);
        Ok(Model {
            bodies,
            supports,
            contacts,
            reduction,
            stiffness: SymmetricMatrix::default(),
            terms,
            added: None,
            reduced: None,
            symbolic: Symbolic::default(),
            factor: None,
            springs: Vec::new(),
            free,
            active: ActiveSet::default(),
            started: false,
            history: None,
            rubbing: FrictionalContact::default(),
            route: None,
        })
    }

    /// Whether the stiffness is there.
    pub fn is_assembled(&self) -> bool {
        self.stiffness.size() > 0
    }

    /// Assembles the stiffness, once.
    pub(crate) fn assemble(&mut self) {
        if self.is_assembled() {
            return;
        }
        let (bodies, reduction) = (&self.bodies, &self.reduction);
        self.stiffness = assemble(bodies, &self.supports);
        let terms = std::mem::take(&mut self.terms);
        self.added = (!terms.is_empty()).then(|| SymmetricMatrix::of_cliques(bodies.unknowns(), &terms));
        let whole = self.added.as_ref().map(|a| self.stiffness.plus(a));
        let whole = whole.as_ref().unwrap_or(&self.stiffness);
        let mut reduced = whole.transformed(reduction.unknowns, |i| reduction.row(i));
        let diagonal = reduced.diagonal();
        for mode in &self.free {
            let row = reduction.row(mode.unknown);
            let Some((unknown, _)) = row.iter().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())) else { continue };
            let stiffness = diagonal[*unknown as usize];
            self.springs.push(Spring { unknown: *unknown, stiffness });
            reduced.add(&[*unknown], &[stiffness], 1.0);
        }
        if D == 3 {
            self.symbolic = Symbolic::dissected(positions(bodies, reduction));
        }
        self.reduced = Some(reduced);
    }

    /// Makes contact know the compliance of its rows in one way, rather than in that which costs less.
    pub fn by_route(&mut self, route: Route) {
        self.route = Some(route);
        (self.active.route, self.rubbing.route) = (Some(route), Some(route));
    }

    /// Motions that only contact can hold.
    pub fn free_modes(&self) -> &[FreeMode] {
        &self.free
    }

    /// What the factorisation takes, and contact beside it, about, without assembling anything: that of the graph of the functions, of which each
    /// stands for its unknowns in all directions.
    ///
    /// # Errors
    /// A structure that does not fit into memory.
    #[inline(never)]
    pub fn cost(&self) -> Result<Cost, SolveError> {
        let (graph, places) = graph(&self.bodies, &self.reduction);
        let mut symbolic = if D == 3 { Symbolic::dissected(places) } else { Symbolic::default() };
        let cost = symbolic.cost(&graph)?;
        let each = self.unknowns() as f64 / graph.size().max(1) as f64;
        let entries = cost.bytes / 8.0 * each.powi(2);
        // With all nodes in contact; each touches the functions of a node on either side.
        let rows = |c: &Contact<D>| c.nodes.len() * if c.friction.is_some() { D } else { 1 };
        let count = self.contacts.iter().map(rows).sum();
        let touched = 2 * D * self.contacts.iter().map(|c| c.nodes.len()).sum::<usize>();
        let of_contact = Route::memory(count, touched, entries);
        Ok(Cost { bytes: 8.0 * entries + of_contact, operations: cost.operations * each.powi(3) })
    }

    /// Number of unknowns that are solved for.
    pub fn unknowns(&self) -> usize {
        self.reduction.unknowns
    }

    /// Solves for the displacement at one time. `report` gets the iteration and what is left (see
    /// [`State::residuals`]), and says whether to go on.
    #[inline(never)]
    pub fn solve(
        &mut self,
        now: &Circumstances<'_, D>,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<State<D>, StepError> {
        let offset = self.reduction.offset(&self.bodies, &self.supports, now.displacement)?;
        self.assemble();
        let mut load = now.load.clone();
        for matrix in std::iter::once(&self.stiffness).chain(&self.added) {
            load.iter_mut().zip(matrix.multiply(&offset)).for_each(|(f, m)| *f -= m);
        }
        let load = self.reduction.restrict(&load);
        let ends = self.search(now)?;
        self.check_held(&now.load)?;
        let rows: Vec<WeightedGap> = (self.contacts.iter())
            .flat_map(|contact| contact.rows.iter().map(|row| reduced(row, &self.reduction, &offset)))
            .collect();
        let mut residuals = Vec::new();
        let mut logged = |iteration: usize, changed: usize| {
            residuals.push(changed as f64);
            report(iteration, changed as f64)
        };
        if let Some(stiffness) = self.reduced.take() {
            self.factor = Some(self.symbolic.factor(stiffness)?);
        }
        if self.rubs() {
            let found = self.solve_rubbing(&offset, &load, &ends, &mut logged)?;
            return Ok(self.rubbed(found, residuals, now, (&offset, &ends)));
        }
        let Some(factor) = &self.factor else { return Err(self.free_body(&[])) };
        let mut active = std::mem::take(&mut self.active);
        let found = self.solve_enforced(&rows, &ends, &mut logged, &mut |soft, report| {
            active.solve(factor, &rows, soft, &self.springs, &load, report)
        });
        self.active = active;
        let (found, _) = found.map_err(|error| self.explained(error, &ends))?;
        let u = self.reduction.expand(&found.u, &offset);
        let ContactState { pressure, gap, active, iterations, route, .. } = found;
        Ok(self.state(
            Found { u, pressure, gap, active, iterations, route, residuals, rubbing: None },
            &now.load,
            &ends,
        ))
    }

    /// Looks without solving whether supports, contacts and loads make sense at a time, with the bodies at rest.
    #[inline(never)]
    pub fn examine(&mut self, now: &Circumstances<'_, D>) -> Result<(), StepError> {
        self.reduction.offset(&self.bodies, &self.supports, now.displacement)?;
        self.started = false;
        let searched = self.search(now);
        self.started = false;
        searched?;
        self.check_held(&now.load)
    }

    /// Looks whether the supports agree with each other at a time, and whether what faces what, as it was found last, can
    /// hold the bodies against the loads.
    #[inline(never)]
    pub fn examine_again(&self, now: &Circumstances<'_, D>) -> Result<(), StepError> {
        self.reduction.offset(&self.bodies, &self.supports, now.displacement)?;
        self.check_held(&now.load)
    }

    /// Whether something saved can be of this model.
    pub fn fits(&self, memory: &Memory) -> bool {
        let (active, rows) = &memory.active;
        active.iter().all(|row| row < rows) && memory.friction.as_ref().is_none_or(|h| self.has_history(h))
    }

    /// What the next time goes on from.
    #[inline(never)]
    pub fn save(&self) -> Memory {
        Memory { active: self.active.save(), friction: self.history.clone() }
    }

    /// Goes on from what was saved; `first` are the circumstances of the first time of all, where the sides were found.
    ///
    /// # Errors
    /// Those of a first search that the model saved did not have.
    #[inline(never)]
    pub fn restore(&mut self, memory: Memory, first: &Circumstances<'_, D>) -> Result<(), StepError> {
        self.started = true;
        self.search(first)?;
        self.active = ActiveSet::restored(memory.active);
        self.active.route = self.route;
        self.remember(memory.friction);
        Ok(())
    }

    /// Finds the rows of all contacts; the ends of those of each contact in the list of all.
    pub(crate) fn search(&mut self, now: &Circumstances<'_, D>) -> Result<Vec<usize>, StepError> {
        let mut ends = Vec::new();
        let mut count = 0;
        let motions = now.motion.iter().map(Option::as_ref).chain(std::iter::repeat(None));
        for ((contact, rigid), motion) in self.contacts.iter_mut().zip(&now.rigid).zip(motions) {
            contact.search(&self.reduction, (rigid.as_ref(), motion))?;
            count += contact.rows.len();
            ends.push(count);
        }
        if !self.started {
            for contact in &self.contacts {
                contact.check_start()?;
            }
            self.started = true;
        }
        if count == 0 && !self.free.is_empty() {
            return Err(self.free_body(&[]));
        }
        Ok(ends)
    }

    /// What failed, in terms of bodies and contacts.
    pub(crate) fn explained(&self, error: ActiveSetError, ends: &[usize]) -> StepError {
        match error {
            ActiveSetError::Interrupted => StepError::Interrupted,
            ActiveSetError::Free { motion } => self.free_body(&motion),
            error => self.contact_error(error, ends),
        }
    }

    /// Whether the contacts, as they were found last, can balance the loads on bodies that nothing else holds.
    pub(crate) fn check_held(&self, load: &[f64]) -> Result<(), StepError> {
        check_held(&self.bodies, &self.contacts, &self.free, load)
    }

    /// The body that moves most under a motion of the springs.
    pub(crate) fn free_body(&self, motion: &[f64]) -> StepError {
        let most = (0..motion.len()).max_by(|&a, &b| motion[a].abs().total_cmp(&motion[b].abs()));
        match self.free.get(most.unwrap_or(0)) {
            Some(mode) => StepError::Free { body: mode.body.clone(), motion: mode.motion.clone() },
            None => StepError::Free { body: String::new(), motion: "to move".into() },
        }
    }

    /// The contact that has no state, and where. `ends` are the ends of the rows of each contact.
    fn contact_error(&self, error: ActiveSetError, ends: &[usize]) -> StepError {
        let mut names: Vec<&str> = Vec::new();
        let mut places = Vec::new();
        if let ActiveSetError::Chatter { rows } | ActiveSetError::Friction { rows, .. } = &error {
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
