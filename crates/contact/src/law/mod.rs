//! Contact laws: from a trial traction to the traction, and its derivative.
//!
//! | symbol | meaning |
//! |---|---|
//! | `ζ = λ - c y` | trial traction: pressure, and two tangential components in the axes of the law |
//! | `p` | pressure, positive where the bodies press on each other |
//! | `Π` | the closest admissible traction |
//! | `P = ∂Π/∂ζ`, `r = ∂Π/∂p` | its generalised derivatives |
//!
//! A law knows neither gaps nor shape functions, and nothing of where the trial comes from: a multiplier, a penalty or an
//! augmented Lagrangian. Tangential components are along the slip of the slave, `-y`; the friction on the slave is their
//! opposite. A law that returns to the closest point of a convex set is associated: the slip is normal to the set (maximum
//! dissipation).

mod cohesion;
mod compliance;
mod coulomb;
mod rate_and_state;
mod scheduled;
mod tied;
mod tresca;
mod viscous;
mod wear;

pub use cohesion::{Cohesion, CohesionKeys, Softening};
pub use compliance::{Compliance, Rough};
pub use coulomb::Coulomb;
pub use rate_and_state::{Evolution, RateAndState, RateAndStateKeys};
pub use scheduled::{Schedule, Scheduled};
pub use tied::Tied;
pub use tresca::Tresca;
pub use viscous::Viscous;
pub use wear::Worn;

/// Whether a point carries, and whether it slips.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Status {
    #[default]
    Open,
    Stick,
    Slip,
}

/// The friction traction under a trial and a pressure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    pub traction: [f64; 2],
    /// `∂traction/∂trial`, symmetric.
    pub by_trial: [[f64; 2]; 2],
    /// `∂traction/∂pressure`.
    pub by_pressure: [f64; 2],
    pub slips: bool,
}

/// The traction under a trial traction: pressure first, then the two tangential components.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Projected {
    pub traction: [f64; 3],
    /// `∂traction/∂trial`.
    pub derivative: [[f64; 3]; 3],
    pub status: Status,
}

/// Coefficients that no law can have.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("a friction law requires finite values that are not negative, not {value}")]
pub struct LawError {
    pub value: f64,
}

/// What a law is told of the point besides its trial.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LawPoint {
    /// The scale `c` of the trial: traction per gap, and per slip.
    pub per_gap: f64,
    /// Time that passes in the increment; zero where none does.
    pub duration: f64,
    /// The largest [`opening`](Law::opening) of the states that were accepted.
    pub opened: f64,
    /// What the law remembers of the last state that was accepted; 0 at the start.
    pub remembered: f64,
    /// Slip of all increments before this one, along the axes.
    pub slipped: [f64; 2],
}

impl LawPoint {
    /// What the trial gains per velocity of slip.
    pub fn per_velocity(&self) -> f64 {
        self.per_gap * self.duration
    }
}

/// A law of contact: friction, and the pressure, which may not be negative if a law says nothing else.
pub trait Law: std::fmt::Debug + Send + Sync {
    /// The admissible friction traction closest to the trial, under a pressure that is positive.
    fn friction(&self, trial: [f64; 2], pressure: f64) -> Friction;

    /// Begins an increment to a time: for laws that change with it.
    fn begin(&mut self, time: f64) {
        let _ = time;
    }

    /// The same for laws that know the point, such as the velocity of slip `(ζ - T)/per_velocity` there.
    fn friction_at(&self, trial: [f64; 2], pressure: f64, point: &LawPoint) -> Friction {
        let _ = point;
        self.friction(trial, pressure)
    }

    /// The pressure under its trial, with its derivative. A law `p = f(g)` that gives way is an implicit function of the trial
    /// `ζ = λ - c g`: `p` with `p = f((p - ζ)/c)`, which is increasing in `ζ` if `f` is decreasing.
    fn pressure(&self, trial: f64, point: &LawPoint) -> [f64; 2] {
        let _ = point;
        unilateral(trial)
    }

    /// The largest gap across which it transmits a traction.
    fn range(&self) -> f64 {
        0.0
    }

    /// Whether [`pressure`](Law::pressure) is another one than that of bodies that may not penetrate.
    fn is_compliant(&self) -> bool {
        false
    }

    /// Whether it has a traction along the surface.
    fn is_tangential(&self) -> bool {
        true
    }

    /// The least traction per gap of a trial with which the law has one traction for each: above its steepest descent.
    fn least_scale(&self) -> f64 {
        0.0
    }

    /// The largest traction against opening, and that along the surface without pressure.
    fn strength(&self) -> [f64; 2] {
        [0.0; 2]
    }

    /// Whether it holds surfaces together for ever.
    fn is_tied(&self) -> bool {
        false
    }

    /// Whether it holds only what touches at the start.
    fn is_bond(&self) -> bool {
        false
    }

    /// The size of the opening under a trial: the largest of all states is what the law remembers.
    fn opening(&self, trial: [f64; 3], point: &LawPoint) -> f64 {
        let _ = (trial, point);
        0.0
    }

    /// Whether friction depends on more than [`opening`](Law::opening) of what was before.
    fn has_state(&self) -> bool {
        false
    }

    /// What it remembers of a state with a trial and its traction.
    fn remember(&self, trial: [f64; 3], traction: [f64; 3], point: &LawPoint) -> f64 {
        let _ = (trial, traction);
        point.remembered
    }

    /// The pressure by the gap, of rough surfaces.
    fn compliance(&self) -> Option<Compliance> {
        None
    }

    /// Depth that is worn off per pressure and slip.
    fn wear(&self) -> f64 {
        0.0
    }

    /// Whether friction depends on the velocity of slip.
    fn is_rate_dependent(&self) -> bool {
        false
    }

    /// How much of the available friction a traction uses: 1 where it slips.
    fn utilisation(&self, traction: [f64; 2], pressure: f64) -> f64;

    /// How much more friction there is at one pressure than at another.
    fn gain(&self, pressure: f64, instead_of: f64) -> f64 {
        let used = [instead_of, pressure].map(|p| self.utilisation([1.0, 0.0], p).max(self.utilisation([0.0, 1.0], p)));
        if used[0].is_finite() && used[0] > 0.0 { used[0] / used[1] } else { 1.0 }
    }

    /// The most friction per pressure along the axes, the semi-axes of an ellipse; none where friction is not in
    /// proportion to the pressure.
    fn per_pressure(&self) -> Option<[f64; 2]>;

    /// The largest product of `w` with the friction that a unit of pressure makes available. With `w` the compliance of
    /// a node between pressure and friction, its state is unique for every load as long as this is less than its
    /// compliance under pressure.
    fn coupling(&self, w: [f64; 2]) -> f64 {
        self.per_pressure().map_or(0.0, |mu| (mu[0] * w[0]).hypot(mu[1] * w[1]))
    }

    /// The admissible traction closest to the trial where no time passes: pressure and friction.
    fn project(&self, trial: [f64; 3]) -> Projected {
        self.traction(trial, &LawPoint::default())
    }

    /// The traction under a trial: pressure, and the friction that it makes available.
    fn traction(&self, trial: [f64; 3], point: &LawPoint) -> Projected {
        let [pressure, by_trial] = self.pressure(trial[0], point);
        if by_trial == 0.0 && pressure == 0.0 {
            return Projected::default();
        }
        if pressure <= 0.0 {
            // Held together: nothing rubs.
            let derivative = [[by_trial, 0.0, 0.0], [0.0; 3], [0.0; 3]];
            return Projected { traction: [pressure, 0.0, 0.0], derivative, status: Status::Slip };
        }
        let friction = self.friction_at([trial[1], trial[2]], pressure, point);
        rubbing(&friction, pressure, [by_trial, 0.0, 0.0])
    }
}

/// A pressure, with its derivatives in the trials, and the friction under it.
fn rubbing(friction: &Friction, pressure: f64, by: [f64; 3]) -> Projected {
    let (t, d, r) = (friction.traction, friction.by_trial, friction.by_pressure);
    let row = |i: usize| [r[i] * by[0], r[i] * by[1] + d[i][0], r[i] * by[2] + d[i][1]];
    Projected {
        traction: [pressure, t[0], t[1]],
        derivative: [by, row(0), row(1)],
        status: if friction.slips { Status::Slip } else { Status::Stick },
    }
}

/// No friction at all.
fn free() -> Friction {
    Friction { traction: [0.0; 2], by_trial: [[0.0; 2]; 2], by_pressure: [0.0; 2], slips: true }
}

/// The pressure of bodies that may not penetrate, with its derivative: its trial, if that presses.
fn unilateral(trial: f64) -> [f64; 2] {
    if trial > 0.0 { [trial, 1.0] } else { [0.0, 0.0] }
}

/// The traction without friction.
pub fn frictionless(trial: f64) -> Projected {
    let [pressure, slope] = unilateral(trial);
    let mut out = Projected { traction: [pressure, 0.0, 0.0], ..Projected::default() };
    out.derivative[0][0] = slope;
    out.status = if slope > 0.0 { Status::Slip } else { Status::Open };
    out
}

/// A law that several contacts share.
impl<L: Law + ?Sized> Law for std::sync::Arc<L> {
    fn friction(&self, trial: [f64; 2], pressure: f64) -> Friction {
        (**self).friction(trial, pressure)
    }
    fn friction_at(&self, trial: [f64; 2], pressure: f64, point: &LawPoint) -> Friction {
        (**self).friction_at(trial, pressure, point)
    }
    fn pressure(&self, trial: f64, point: &LawPoint) -> [f64; 2] {
        (**self).pressure(trial, point)
    }
    fn range(&self) -> f64 {
        (**self).range()
    }
    fn is_compliant(&self) -> bool {
        (**self).is_compliant()
    }
    fn is_tangential(&self) -> bool {
        (**self).is_tangential()
    }
    fn least_scale(&self) -> f64 {
        (**self).least_scale()
    }
    fn strength(&self) -> [f64; 2] {
        (**self).strength()
    }
    fn is_tied(&self) -> bool {
        (**self).is_tied()
    }
    fn is_bond(&self) -> bool {
        (**self).is_bond()
    }
    fn opening(&self, trial: [f64; 3], point: &LawPoint) -> f64 {
        (**self).opening(trial, point)
    }
    fn has_state(&self) -> bool {
        (**self).has_state()
    }
    fn remember(&self, trial: [f64; 3], traction: [f64; 3], point: &LawPoint) -> f64 {
        (**self).remember(trial, traction, point)
    }
    fn compliance(&self) -> Option<Compliance> {
        (**self).compliance()
    }
    fn wear(&self) -> f64 {
        (**self).wear()
    }
    fn is_rate_dependent(&self) -> bool {
        (**self).is_rate_dependent()
    }
    fn utilisation(&self, traction: [f64; 2], pressure: f64) -> f64 {
        (**self).utilisation(traction, pressure)
    }
    fn per_pressure(&self) -> Option<[f64; 2]> {
        (**self).per_pressure()
    }
    fn coupling(&self, w: [f64; 2]) -> f64 {
        (**self).coupling(w)
    }
    fn traction(&self, trial: [f64; 3], point: &LawPoint) -> Projected {
        (**self).traction(trial, point)
    }
}

/// Friction that the trial itself satisfies.
pub fn stuck(trial: [f64; 2]) -> Friction {
    Friction { traction: trial, by_trial: [[1.0, 0.0], [0.0, 1.0]], by_pressure: [0.0; 2], slips: false }
}

/// The return of a trial onto a circle, and the unit vector along it.
fn onto_circle(trial: [f64; 2], radius: f64) -> (Friction, [f64; 2]) {
    let size = trial[0].hypot(trial[1]);
    if size <= radius {
        return (stuck(trial), [0.0; 2]);
    }
    let along = [trial[0] / size, trial[1] / size];
    let share = radius / size;
    let (diagonal, off) = (|k: usize| share * along[1 - k] * along[1 - k], -share * along[0] * along[1]);
    let by_trial = [[diagonal(0), off], [off, diagonal(1)]];
    let traction = along.map(|a| radius * a);
    (Friction { traction, by_trial, by_pressure: [0.0; 2], slips: true }, along)
}

fn checked(values: &[f64]) -> Result<(), LawError> {
    match values.iter().find(|v| !v.is_finite() || **v < 0.0) {
        Some(&value) => Err(LawError { value }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod interface_tests;
#[cfg(test)]
mod tests;
