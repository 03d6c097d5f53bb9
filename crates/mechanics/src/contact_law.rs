//! The law of a contact and its enforcement at points: from measures to tractions. Sites and nodes of mortar have it in
//! common; curves and discs, whose points are found anew in every state, have law, enforcement and times here.
//!
//! At every point, with gap `g`, slip `e` since the last state and the traction `λ` (pressure, and two components of friction
//! along axes), which is an unknown:
//!
//! - trial `ζ = λ - s (λ - λ_0) + c (-g, e)`, traction `Π(ζ)` by the law;
//! - the equation `(w/c) (Π(ζ) - λ) = 0`, for which `w` is an area (Alart & Curnier 1991).

use crate::assembler::Assembler;
use crate::enforcement::{Enforcement, Outer, SOFTER};
use crate::outer::{OuterIteration, hardened, take_over, towards};
use crate::simpler::SimplerFriction;
use crate::site_result::SiteResult;
use signorini_contact::law::{LawPoint, Projected, frictionless};
use signorini_contact::{Law, Status};

/// The law of a contact, how it is enforced, and the tractions of its points.
#[derive(Debug)]
pub struct ContactLaw {
    /// Friction, and the pressure where it is another one than that of bodies that may not penetrate. Without it the sides slide
    /// freely.
    pub friction: Option<Box<dyn Law>>,
    pub enforcement: Enforcement,
    /// The component of friction that a plane problem has; both in space.
    pub(crate) in_plane: Option<usize>,
    /// Traction per unit of gap, and of slip, of each point: the scale `c` of the trial, not the penalty.
    pub(crate) stiffness: Vec<f64>,
    /// The area of each point, `w`: its equations are weighted by it.
    pub(crate) areas: Vec<f64>,
    /// That scale over the penalty, `s`.
    pub(crate) softness: f64,
    /// The traction of each point at the last state, with friction along its axes: `λ_0`.
    pub(crate) kept: Vec<[f64; 3]>,
    /// What else each point remembers.
    pub(crate) history: Vec<PointHistory>,
    /// Distance of neighbouring points, about, where a bond asks for it.
    pub(crate) spacing: f64,
    /// Whether no state was accepted yet.
    is_new: bool,
    /// Times of the last state and of the one that is looked for.
    pub times: [f64; 2],
    /// The scale of trials relative to the stiffness of cells.
    pub(crate) scale: f64,
    /// Whether trials are scaled down, as they led to the last states.
    pub(crate) is_soft: bool,
    /// What is stated, while a start is looked for with something simpler.
    stated: Option<Stated>,
}

/// What a contact states while something simpler stands in its place.
#[derive(Debug)]
struct Stated {
    /// None where it stayed.
    friction: Option<Box<dyn Law>>,
    enforcement: Enforcement,
    softness: f64,
    /// Where points give way by a stiffness of their own.
    stiffness: Option<Vec<f64>>,
}

/// What a point remembers beside its traction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PointHistory {
    /// The largest opening of a law that holds surfaces together.
    pub opened: f64,
    /// What is worn off; less the gap at the start of what is bonded there.
    pub offset: f64,
    /// The trial of the last state, of a law that softens.
    pub trial: [f64; 3],
    /// What a law with a state remembers.
    pub state: f64,
}

/// The scales of the equation of a multiplier.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row {
    /// Traction per gap, of the trial, and of one that is as stiff as cells.
    pub trial: f64,
    pub stiffness: f64,
    /// That the point stands for.
    pub area: f64,
}

/// What the law is given at a point.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PointMeasure {
    pub gap: f64,
    pub slip: [f64; 2],
    /// Slip of all increments before this one.
    pub slipped: [f64; 2],
    /// Along which axes the sides may slide; none where there is no friction yet, as they were apart at the last state.
    pub slides: Option<[bool; 2]>,
    /// The traction to give way from, where it is not that of the last state.
    pub base: Option<[f64; 3]>,
    /// Friction besides that of the trial about which the law is linearised.
    pub besides: [f64; 2],
    /// Whether what would slip back is linearised as sticking, for a step of Newton's method.
    pub sticks_first: bool,
}

/// Share of the limit of friction within which a point is at it, as what slipped is when the next increment starts. Either
/// derivative serves at a switch; with that of slip a slip zone does not start each increment stuck, to be freed point by
/// point. More than the tolerance of Newton's method, which ends that near to the limit.
const AT_LIMIT: f64 = 1e-7;

/// Gap at the start, relative to the distance of points, up to which a bond holds: more than meshes that do not match leave
/// between curved surfaces.
const BONDED: f64 = 0.02;

/// The part of its scale by which a multiplier resists change within a Newton step, in the tangent alone: what several
/// points of a stiff body carry together need not be unique. Of softer trials it is a smaller part, so that it resists as much.
const UNDETERMINED: f64 = 1e-6;

impl ContactLaw {
    /// Without friction, and without tractions yet, at points with these scales of trials and areas; none of contacts whose points
    /// are found anew in every state.
    pub fn new(enforcement: Enforcement, stiffness: Vec<f64>, areas: Vec<f64>) -> Self {
        ContactLaw {
            friction: None,
            enforcement,
            in_plane: None,
            softness: enforcement.softness(),
            kept: vec![[0.0; 3]; stiffness.len()],
            history: vec![PointHistory::default(); stiffness.len()],
            spacing: 0.0,
            is_new: true,
            stiffness,
            areas,
            times: [0.0; 2],
            scale: 1.0,
            is_soft: false,
            stated: None,
        }
    }

    /// Time that passes in an increment.
    pub fn duration(&self) -> f64 {
        self.times[1] - self.times[0]
    }

    /// Which components of a traction are unknowns: 0 is the pressure.
    pub(crate) fn slots(&self) -> &'static [usize] {
        match (self.is_tangential(), self.in_plane) {
            (false, _) => &[0],
            (true, None) => &[0, 1, 2],
            (true, Some(0)) => &[0, 1],
            (true, Some(_)) => &[0, 2],
        }
    }

    /// Whether there are tractions along the surface.
    pub(crate) fn is_tangential(&self) -> bool {
        self.friction.as_ref().is_some_and(|law| law.is_tangential())
    }

    /// The gap that is told of a point, and what is worn off there.
    pub(crate) fn gap_and_wear(&self, measured: f64, next: &PointHistory) -> (Option<f64>, f64) {
        let wears = self.friction.as_ref().is_some_and(|law| law.wear() > 0.0);
        (Some(measured + next.offset), if wears { next.offset } else { 0.0 })
    }

    /// The gap up to which a point carries under a trial of its pressure.
    pub(crate) fn farthest(&self, k: usize, pressing: f64) -> f64 {
        let range = self.friction.as_ref().map_or(0.0, |law| law.range());
        (pressing / self.stiffness[k]).max(0.0) + range - self.history[k].offset
    }

    /// What a point remembers of a state with these trials; without them nothing met it there.
    pub(crate) fn remembered(&self, k: usize, at: Option<(&PointMeasure, [f64; 3], &Projected)>) -> PointHistory {
        let before = self.history[k];
        let remembers = |law: &&dyn Law| law.least_scale() > 0.0 || law.wear() > 0.0 || law.has_state();
        let Some(law) = self.friction.as_deref().filter(remembers) else { return before };
        if self.is_new && law.is_bond() {
            return match at {
                Some((measure, ..)) if measure.gap.abs() <= BONDED * self.spacing => {
                    PointHistory { offset: -measure.gap, ..before }
                }
                _ => PointHistory { opened: f64::MAX, ..before },
            };
        }
        let Some((measure, trial, projected)) = at else { return before };
        let point = self.point(k, measure);
        let opening = law.opening(trial, &point);
        let state = law.remember(trial, projected.traction, &point);
        let worn = law.wear() * projected.traction[0] * measure.slip[0].hypot(measure.slip[1]);
        PointHistory { opened: before.opened.max(opening), offset: before.offset + worn, trial, state }
    }

    /// What the law is told of a point besides its trial.
    fn point(&self, k: usize, measure: &PointMeasure) -> LawPoint {
        LawPoint {
            per_gap: self.stiffness[k],
            duration: self.duration(),
            opened: self.history[k].opened,
            remembered: self.history[k].state,
            slipped: measure.slipped,
        }
    }

    /// Raises the scales of trials to what the law asks for.
    pub(crate) fn steepen(&mut self) {
        let least = self.friction.as_ref().map_or(0.0, |law| law.least_scale());
        self.stiffness.iter_mut().for_each(|c| *c = c.max(least));
    }

    /// Whether the tractions are unknowns and hold exactly.
    pub(crate) fn is_exact(&self) -> bool {
        self.enforcement.is_exact() && !self.kept.is_empty()
    }

    /// The scales of the equation of each unknown.
    pub(crate) fn rows(&self) -> impl Iterator<Item = Row> {
        let (slots, scale) = (self.slots(), self.scale);
        let rows = self.stiffness.iter().zip(&self.areas);
        rows.flat_map(move |(c, w)| slots.iter().map(move |_| Row { trial: *c, stiffness: c / scale, area: *w }))
    }

    /// The unknowns of all points as at the last state.
    pub(crate) fn multipliers(&self) -> Vec<f64> {
        self.kept.iter().flat_map(|kept| self.slots().iter().map(|slot| kept[*slot])).collect()
    }

    /// The traction of a point among the unknowns of all.
    pub(crate) fn multiplier(&self, k: usize, multipliers: &[f64]) -> [f64; 3] {
        let slots = self.slots();
        let mut out = [0.0; 3];
        slots.iter().zip(&multipliers[slots.len() * k..]).for_each(|(slot, value)| out[*slot] = *value);
        out
    }

    /// The traction to give way from, by what a point carried at the last state.
    fn base(&self, k: usize) -> [f64; 3] {
        self.enforcement.base(self.kept[k])
    }

    /// The trial of the pressure of a point without a gap.
    pub(crate) fn pressing(&self, k: usize, unknown: f64, base: Option<f64>) -> f64 {
        unknown - self.softness * (unknown - base.unwrap_or_else(|| self.base(k)[0]))
    }

    /// The traction of a point by the law, and its trial.
    pub(crate) fn traction(&self, k: usize, unknown: [f64; 3], measure: &PointMeasure) -> (Projected, [f64; 3]) {
        let c = self.stiffness[k];
        let base = measure.base.unwrap_or_else(|| self.base(k));
        let lambda: [f64; 3] = std::array::from_fn(|i| unknown[i] - self.softness * (unknown[i] - base[i]));
        let pressing = lambda[0] - c * (measure.gap + self.history[k].offset);
        let Some(law) = &self.friction else { return (frictionless(pressing), [pressing, 0.0, 0.0]) };
        let slides = match measure.slides {
            Some(slides) => slides,
            None if law.is_compliant() => [false; 2],
            None => return (frictionless(pressing), [pressing, 0.0, 0.0]),
        };
        let trial = |i: usize| if slides[i] { lambda[i + 1] + c * measure.slip[i] } else { 0.0 };
        let point = self.point(k, measure);
        let project = |trial: [f64; 3]| law.traction(trial, &point);
        let mut besides = [0.0, measure.besides[0], measure.besides[1]];
        // What moved as prescribed has not moved the rest yet: where surfaces hold each other the first step goes on from what
        // they carried, as if all of them were torn apart otherwise.
        let kept = self.kept[k];
        let begins = measure.sticks_first && law.least_scale() > 0.0 && kept[0] != 0.0 && kept == unknown;
        if begins {
            let last = self.history[k].trial;
            besides = [last[0] - pressing, last[1] - trial(0), last[2] - trial(1)];
        }
        let about = |i: usize| if slides[i] { trial(i) + besides[1 + i] } else { 0.0 };
        let mut projected = project([pressing + besides[0], about(0), about(1)]);
        // What slips one way does not slip back in the next step: it sticks first. Else steps send it to and fro.
        // The friction of what pulls in an iterate tells no direction.
        let back = unknown[0] > 0.0 && (1..3).map(|i| unknown[i] * projected.traction[i]).sum::<f64>() < 0.0;
        if measure.sticks_first && projected.status == Status::Slip && back && law.least_scale() == 0.0 {
            besides = [0.0, -trial(0), -trial(1)];
            projected = project([pressing, 0.0, 0.0]);
        }
        for i in (0..2).filter(|i| !slides[*i]) {
            projected.derivative.iter_mut().for_each(|row| row[i + 1] = 0.0);
        }
        let [p, t1, t2] = projected.traction;
        if projected.status == Status::Stick && law.utilisation([t1, t2], p) > 1.0 - AT_LIMIT {
            let beyond = project([pressing, (1.0 + 2.0 * AT_LIMIT) * t1, (1.0 + 2.0 * AT_LIMIT) * t2]);
            (projected.derivative, projected.status) = (beyond.derivative, beyond.status);
        }
        if besides != [0.0; 3] {
            let d = projected.derivative;
            let more = |a: usize| (0..3).map(|b| d[a][b] * besides[b]).sum::<f64>();
            (0..3).for_each(|a| projected.traction[a] -= more(a));
        }
        (projected, [pressing, trial(0), trial(1)])
    }

    /// Adds the equations of a point, without what other unknowns change in them; `row` is the number of the first. A point of
    /// which nothing is known carries nothing.
    pub(crate) fn add_equations(
        &self,
        k: usize,
        row: u32,
        unknown: [f64; 3],
        projected: Option<&Projected>,
        out: &mut Assembler<'_>,
    ) {
        let scale = self.areas[k] / self.stiffness[k];
        // Tractions that nothing determines stay where they are.
        let resists = if projected.is_some() { 1.0 + UNDETERMINED * self.scale } else { 1.0 };
        let projected = projected.copied().unwrap_or_default();
        for (i, &slot) in (0u32..).zip(self.slots()) {
            let traction = projected.traction[slot];
            out.residual[(row + i) as usize] += scale * (traction - unknown[slot]);
            out.sizes[(row + i) as usize] += scale * (traction.abs() + unknown[slot].abs());
            let Some(tangent) = &mut out.tangent else { continue };
            for (j, &other) in (0u32..).zip(self.slots()) {
                let own = if i == j { resists } else { 0.0 };
                let follows = (1.0 - self.softness) * projected.derivative[slot][other];
                if follows != own {
                    tangent.add(row + i, row + j, scale * (follows - own));
                }
            }
        }
    }

    /// Ends an increment.
    pub(crate) fn end(&mut self) {
        self.softness = self.enforcement.softness();
    }

    /// Takes the tractions of a state from which the next increment starts.
    pub fn accept(&mut self, tractions: Vec<[f64; 3]>) {
        self.kept = tractions;
        self.is_new = false;
        self.times[0] = self.times[1];
    }

    /// Forgets what the points carried.
    pub(crate) fn unload(&mut self) {
        self.kept.iter_mut().for_each(|kept| *kept = [0.0; 3]);
    }

    /// Whether an outer iteration takes the tractions that were found as those to give way from.
    pub(crate) fn takes_over(&self) -> bool {
        self.enforcement.outer() == Outer::TakesOver
    }

    /// An outer iteration at a state with these results, and these tractions where it takes them: the largest relative change.
    pub(crate) fn augment(&mut self, found: &[SiteResult], around: &OuterIteration, tractions: &[[f64; 3]]) -> f64 {
        match self.enforcement.outer() {
            Outer::TakesOver => {
                let change = take_over(self.kept.iter_mut().zip(&self.stiffness), tractions, (around, self.softness));
                self.softness = hardened(self.softness, change, around);
                change
            }
            Outer::Towards(wanted) => towards(wanted, found, &mut self.stiffness),
            Outer::Nothing => 0.0,
        }
    }

    /// What [`restore_scales`](ContactLaw::restore_scales) goes on from: scales of trials, the time, and whether trials are soft.
    pub fn scales(&self) -> impl Iterator<Item = f64> {
        self.stiffness.iter().copied().chain([self.times[0], f64::from(self.is_soft)])
    }

    /// Takes what [`scales`](ContactLaw::scales) gave, and leaves what follows it; none of something else.
    pub fn restore_scales<'a>(&mut self, numbers: &'a [f64]) -> Option<&'a [f64]> {
        let (stiffness, rest) = numbers.split_at_checked(self.stiffness.len())?;
        let ([time, soft], rest) = rest.split_first_chunk()?;
        self.stiffness.copy_from_slice(stiffness);
        self.times = [*time; 2];
        self.is_soft = *soft == 1.0;
        Some(rest)
    }

    /// Makes trials soft or as stiff as they were, not those of penalties: whether that changed any.
    pub fn make_trials(&mut self, soft: bool) -> bool {
        // Nitsche's method has its stiffness in the state, and a law that softens asks for one of its own.
        let softens = self.friction.as_ref().is_some_and(|law| law.least_scale() > 0.0);
        if self.is_soft == soft || self.enforcement.takes_stress() || self.kept.is_empty() || softens {
            return false;
        }
        let factor = if soft { SOFTER } else { 1.0 / SOFTER };
        self.is_soft = soft;
        self.stiffness.iter_mut().for_each(|c| *c *= factor);
        self.softness *= factor;
        true
    }

    /// Until [`restore`](ContactLaw::restore): penalties in place of multipliers, and simpler friction where that is asked for.
    /// What has no tractions as unknowns keeps its enforcement.
    pub(crate) fn simplify(&mut self, friction: SimplerFriction) {
        let (enforcement, softness) = (self.enforcement, self.softness);
        let friction = friction.instead_of(&mut self.friction);
        if !self.kept.is_empty() {
            self.enforcement = Enforcement::Penalty { wanted_penetration: None };
            self.softness = self.enforcement.softness();
        }
        self.stated = Some(Stated { friction, enforcement, softness, stiffness: None });
    }

    /// Until [`restore`](ContactLaw::restore): each point gives way by this force per penetration, a function of its gap alone.
    pub(crate) fn give_way(&mut self, force_per_gap: f64) {
        self.simplify(SimplerFriction::Smooth);
        if let Some(stated) = &mut self.stated {
            stated.stiffness = Some(self.stiffness.clone());
        }
        self.softness = 1.0;
        self.stiffness.iter_mut().zip(&self.areas).for_each(|(c, area)| *c = force_per_gap / area);
    }

    /// Whether something simpler stands in its place.
    pub(crate) fn is_simplified(&self) -> bool {
        self.stated.is_some()
    }

    /// Ends what [`simplify`](ContactLaw::simplify) began.
    pub(crate) fn restore(&mut self) {
        let Some(stated) = self.stated.take() else { return };
        if stated.friction.is_some() {
            self.friction = stated.friction;
        }
        (self.enforcement, self.softness) = (stated.enforcement, stated.softness);
        if let Some(stiffness) = stated.stiffness {
            self.stiffness = stiffness;
        }
    }
}
