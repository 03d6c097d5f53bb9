//! When the fronts have come to rest, or are left to smaller cells.

use crate::front::StepKind;

/// Steps after which fronts that do not come to rest are given up.
const MOST_STEPS: usize = 40;
/// Corrections of the zone after which it is given up ...
const MOST_SWEEPS: usize = 12;
/// ... or left to smaller cells.
const MOST_SWEEPS_BEFORE_DIVISION: usize = 2;
/// As many steps are left to smaller cells.
const MOST_STEPS_BEFORE_DIVISION: usize = 15;
/// Fronts whose residual has not fallen for so many steps ...
const PATIENCE: usize = 9;
/// ... or for so many on tips that no cell shows ...
const PATIENCE_AT_TIPS: usize = 1;
/// ... where, after so many, steps are damped ...
const DAMPED_AFTER: usize = 3;
/// ... and that move by less than this fraction of a cell have settled: as a front crosses a grid line the discrete
/// slope jump makes a jump of its own, of the size of the discretisation error, and no position makes it vanish.
pub(crate) const SETTLED: f64 = 1e-3;
/// ... or, where a front is sharper than a cell, or where the slope jump that its modes do not see is larger than the one
/// they do, by less than this.
pub(crate) const SETTLED_COARSE: f64 = 0.03;
/// ... or, on tips that no cell shows where both are so, by less than this.
const SETTLED_AT_TIPS: f64 = 0.1;
/// ... without waiting for more where the last step, a hundred times as long as what then lacks elsewhere, changed the area of
/// contact by less than this part of the square of the membrane's size.
const STILL: f64 = 1e-6;
/// ... or, where they are moved as a level set on nodes, by less than this.
const SETTLED_SHIFTED: f64 = 0.1;
/// A residual that has fallen so often in a row has not settled, however slowly it falls: a front may be on its way to vanish.
const SLOWLY: usize = 5;
/// A front sharper than this, relative to a cell, is no front any more.
pub(crate) const SHARPEST: f64 = 10.0;
/// Fronts that lack no more than so many times the tolerance, and gained nothing by a step, rest: that is little beside what
/// the grid resolves, and a jump of the discrete slope lies in the way.
const STUCK: f64 = 5.0;
/// A step of this fraction of a cell that does not improve on the last is round-off.
const ROUND_OFF: f64 = 1e-8;
/// Fronts that curve by more than this within a cell are left to smaller cells ...
pub(crate) const SHARP: f64 = 0.5;
/// ... where they lack less than this fraction of one ...
const NEARLY: f64 = 0.05;
/// ... or gain nothing by a step that is shorter than this.
const ASTRAY: f64 = 0.5;
/// A step with all of the derivative that leaves more than this part of the residual is followed by so many others.
const GAINED: f64 = 0.5;
const DOUBTED: usize = 2;

/// How far fronts are brought to rest where they curve within a cell: what they lack there is little beside what the grid
/// cannot show of it, and Newton's method converges slowly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StoppingRule {
    /// Until nothing more changes that counts.
    Final,
    /// The same, next to a zone that is one already: it is not corrected where a body is penetrated.
    Uncorrected,
    /// Until the cells about them may as well be divided.
    BeforeDivision,
    /// The same on cells that are divided, perhaps not enough.
    BeforeMoreDivision,
    /// Until they are as true as the grid, which a finer one goes on from.
    BeforeRefinement,
}

impl StoppingRule {
    /// The slope jump in the modes, relative to what they do not see of it, at which fronts sharper than a cell rest.
    fn share(self) -> f64 {
        match self {
            StoppingRule::BeforeDivision => 0.2,
            _ => 1e-3,
        }
    }

    /// The slope jump at which fronts rest, relative to its tolerance.
    fn residual(self) -> f64 {
        match self {
            StoppingRule::BeforeRefinement => 10.0,
            _ => 1.0,
        }
    }

    /// Steps after which fronts that do not come to rest are given up.
    pub fn most_steps(self) -> usize {
        match self {
            StoppingRule::BeforeDivision => MOST_STEPS_BEFORE_DIVISION,
            _ => MOST_STEPS,
        }
    }

    /// Whether fronts are left to smaller cells where those that they lie in are too large for Newton's method.
    fn leaves(self) -> bool {
        matches!(self, StoppingRule::BeforeDivision | StoppingRule::BeforeMoreDivision)
    }

    /// Corrections of the zone after which it is given up.
    pub fn most_sweeps(self) -> usize {
        match self {
            StoppingRule::BeforeDivision => MOST_SWEEPS_BEFORE_DIVISION,
            _ => MOST_SWEEPS,
        }
    }

    /// Whether fronts may rest after a solve.
    pub fn judge(self, course: &IterationHistory, sight: &Observation<'_>) -> Decision {
        if sight.residual <= 1.0 {
            return Decision::AtRest;
        }
        let sharp = sight.bend >= 1.0;
        let lost = sight.tips && sharp;
        let patience = match (sight.shifted, lost) {
            // A level set on nodes shifts the fronts with every step: there is no coming closer than that.
            (true, _) => DAMPED_AFTER,
            (_, true) => PATIENCE_AT_TIPS,
            _ => PATIENCE,
        };
        let enough = || match (sight.shifted, sharp && sight.bend < SHARPEST) {
            (true, _) => SETTLED_SHIFTED,
            (_, true) if lost && (sight.unseen)(1.0) => SETTLED_AT_TIPS,
            (_, sharp) if sharp || (sight.unseen)(1.0) => SETTLED_COARSE,
            _ => SETTLED,
        };
        let waited = (course.waited >= patience || sight.last) && (sight.shifted || course.falls < SLOWLY);
        let settled = waited && sight.kind != StepKind::Descent && sight.step < enough();
        // Tips that cells hardly show move on and on, each time by a little, when all the rest has long been in its place.
        let at_tips =
            sight.tips && sight.divided && !sight.kinks && sight.step < SETTLED_AT_TIPS && course.grown < STILL;
        let settled = settled || at_tips;
        // Newton's method is slow on fronts as sharp as a cell, and fast on the smaller ones that they want.
        let slow = || at_tips || (course.waited >= 1 && sight.step < ASTRAY) || (sight.farthest)() < NEARLY;
        if self.leaves() && !sight.adhering && sight.bend >= SHARP && slow() {
            // What sharp fronts lack in the end may be less than what other fronts settle with.
            return Decision::Left { settled: settled || sight.step < SETTLED };
        }
        if settled {
            return Decision::Settled;
        }
        let round_off = course.waited >= 1 && sight.step < ROUND_OFF;
        let stuck = sight.kinks && course.waited >= 1 && sight.residual <= STUCK;
        let blunt = || sharp && (sight.unseen)(self.share());
        if sight.residual <= self.residual() || round_off || stuck || blunt() {
            Decision::AtRest
        } else {
            Decision::Moving
        }
    }
}

/// What is known of the fronts after a solve.
pub struct Observation<'a> {
    /// The slope jump relative to its tolerance.
    pub residual: f64,
    /// Length in cells and kind of the step that Newton's method would make.
    pub step: f64,
    pub kind: StepKind,
    /// The largest product of curvature and cell size; 0 in one dimension.
    pub bend: f64,
    /// Whether there are tips on which Newton's method converges slowly.
    pub tips: bool,
    /// Whether the cells are divided about the fronts.
    pub divided: bool,
    /// Whether every step shifts the fronts on its own account.
    pub shifted: bool,
    pub adhering: bool,
    /// Whether the slope jump has kinks of the size of its tolerance, as at degree 1.
    pub kinks: bool,
    /// Whether there is no step after this one.
    pub last: bool,
    /// Whether the modes see less of the slope jump than this part of what they do not see.
    pub unseen: &'a dyn Fn(f64) -> bool,
    /// How far the fronts have to go at the farthest place, in the smallest cells.
    pub farthest: &'a dyn Fn() -> f64,
}

/// Whether fronts may rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decision {
    Moving,
    AtRest,
    /// As near as they come on these cells.
    Settled,
    /// Left to smaller cells; whether they are near enough where there are none.
    Left {
        settled: bool,
    },
}

/// How the residual has gone from step to step.
#[derive(Debug)]
pub struct IterationHistory {
    best: f64,
    previous: f64,
    area: f64,
    /// What the last step changed the area of contact by.
    grown: f64,
    /// Steps since it last fell well below the best before.
    pub waited: usize,
    /// Falls in a row.
    falls: usize,
    last: Option<StepKind>,
    doubted: usize,
}

impl Default for IterationHistory {
    fn default() -> Self {
        Self {
            best: f64::INFINITY,
            previous: f64::INFINITY,
            area: f64::INFINITY,
            grown: f64::INFINITY,
            waited: 0,
            falls: 0,
            last: None,
            doubted: 0,
        }
    }
}

impl IterationHistory {
    /// Takes the residual and the area of contact after a solve into account, from which a step of a kind may follow; fronts
    /// that every step shifts do not fall slowly.
    pub fn take(&mut self, residual: f64, area: f64, kind: StepKind, shifted: bool) {
        (self.grown, self.area) = ((area - self.area).abs(), area);
        let lower = residual < 0.98 * self.best;
        self.waited = if residual < 0.7 * self.best || kind == StepKind::Descent { 0 } else { self.waited + 1 };
        self.best = self.best.min(residual);
        self.falls = if residual < self.previous { self.falls + 1 } else { 0 };
        self.doubted = match self.last {
            // A kink of the discrete slope jump lies between here and where the step came from.
            Some(StepKind::Exact) if residual > GAINED * self.previous => DOUBTED,
            _ => self.doubted.saturating_sub(1),
        };
        self.previous = residual;
        if self.waited >= PATIENCE && self.falls >= SLOWLY && lower && !shifted {
            self.waited = 0;
        }
    }

    /// The step that is made.
    pub fn make(&mut self, kind: StepKind) {
        self.last = Some(kind);
    }

    /// Whether the derivative of the discrete equations is worth its price.
    pub fn is_smooth(&self) -> bool {
        self.doubted == 0
    }

    /// The factor for steps where the derivative does not fit the discrete slope jump: shorter ones find where it vanishes.
    pub fn damping(&self) -> Option<f64> {
        (self.waited >= DAMPED_AFTER).then(|| 0.5f64.powi((self.waited / DAMPED_AFTER) as i32).max(0.1))
    }
}
