//! Surfaces that hold each other: a traction `T(δ)` that falls with the opening, to none when the energy is spent.
//!
//! | symbol | meaning |
//! |---|---|
//! | `g`, `e` | gap, and slip since the surfaces were bonded |
//! | `η` | shear strength over strength; none for adhesion, which holds against opening only |
//! | `Δ = (⟨g⟩, η e)`, `δ = |Δ|` | opening, and its size |
//! | `κ` | largest opening so far: what was damaged stays so; with adhesion that heals it is that of the strength |
//! | `T(δ)` | envelope: from the strength at the opening `δ_0`, linear to none or exponential, over which `∫ T dδ = G` |
//! | `a = T(max(δ, κ))/max(δ, κ)` | secant stiffness: `t_n = a g`, `t = η² a e` |
//!
//! With `δ_0 = 0` surfaces are bonded without giving way until the strength is reached, so that there is no stiffness to
//! choose (Camacho & Ortiz 1996; Ortiz & Pandolfi 1999). Mixed modes meet on the ellipse `(t_n/σ)² + (t/ησ)² = 1`.
//! Pressed together the surfaces may not penetrate, and the part `1 - T(κ)/σ` of them rubs (after Raous, Cangémi & Cocou
//! 1999).
//!
//! With the trial `z = (-ζ_n, ζ_t + c e_0)`, where `e_0` is the slip of the last state and `c` the traction per gap, the
//! opening while damage grows solves `(z_n/(T + c δ))² + (z_t/(ηT + c δ/η))² = 1`, which has one root if `c` is above the
//! steepest descent of `T`: the law asks for that ([`least_scale`](Law::least_scale)).

use super::{Friction, Law, LawError, LawPoint, Projected, Status, checked, free, rubbing};

/// How the traction falls once the strength was reached.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Softening {
    Linear,
    Exponential,
}

/// Cohesion or adhesion, with friction where the surfaces press on each other.
#[derive(Debug)]
pub struct Cohesion {
    strength: f64,
    softening: Softening,
    /// Opening at which the strength is reached, and the length over which the traction falls from there.
    first: f64,
    fall: f64,
    /// Shear strength over strength.
    shear: f64,
    heals: bool,
    friction: Box<dyn Law>,
}

/// What [`Cohesion::new`] is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CohesionKeys {
    /// The largest traction, and the energy per area.
    pub strength: f64,
    pub energy: f64,
    pub softening: Softening,
    /// Opening at which the strength is reached; 0 where nothing gives way before.
    pub opening: f64,
    /// Shear strength over strength; 0 where only opening is resisted.
    pub shear: f64,
    /// Whether what was opened holds again once it closes.
    pub heals: bool,
}

/// Fall of an exponential in its lengths beyond which nothing is left but rounding.
const FALLS: f64 = 40.0;
/// Traction per gap of a trial over the steepest descent of the traction.
const STEEPER: f64 = 2.0;
/// Share of the last opening below which none is looked for: its secant stiffness would overflow.
const LEAST: f64 = 1e-14;
/// Steps to the opening: bisection alone takes fewer than that.
const MOST_STEPS: usize = 200;

impl Cohesion {
    /// # Errors
    /// Strength or energy that is not positive, or an opening that the energy does not reach: above `2 G/σ`.
    pub fn new(keys: CohesionKeys, friction: Box<dyn Law>) -> Result<Self, LawError> {
        let CohesionKeys { strength, energy, softening, opening, shear, heals } = keys;
        checked(&[strength, energy, opening, shear])?;
        // Both: the triangle before the strength takes `σ δ_0/2` of the energy.
        let left = energy / strength - 0.5 * opening;
        for value in [strength, energy, left] {
            if !(value.is_finite() && value > 0.0) {
                return Err(LawError { value });
            }
        }
        let fall = match softening {
            Softening::Linear => 2.0 * left,
            Softening::Exponential => left,
        };
        Ok(Cohesion { strength, softening, first: opening, fall, shear, heals, friction })
    }

    /// The opening at which nothing is left.
    fn last(&self) -> f64 {
        self.first + self.fall * if self.softening == Softening::Linear { 1.0 } else { FALLS }
    }

    /// The traction at an opening beyond the first one, and its slope.
    fn envelope(&self, opening: f64) -> [f64; 2] {
        let x = (opening - self.first) / self.fall;
        match self.softening {
            _ if opening >= self.last() => [0.0, 0.0],
            Softening::Linear => [self.strength * (1.0 - x), -self.strength / self.fall],
            Softening::Exponential => [self.strength * (-x).exp(), -self.strength / self.fall * (-x).exp()],
        }
    }

    fn largest(&self, point: &LawPoint) -> f64 {
        if self.heals { self.first } else { point.opened.max(self.first) }
    }

    /// The traction under a trial, and the opening there.
    fn state(&self, trial: [f64; 3], point: &LawPoint) -> (Projected, f64) {
        let c = point.per_gap;
        if trial[0] >= 0.0 {
            return if self.shear == 0.0 { (self.rubbing(trial, point), 0.0) } else { self.pressed(trial, point) };
        }
        let eta = self.shear;
        // Trials of the opening; what is only pulled off has none along the surface.
        let normal = -trial[0];
        let along: [f64; 2] =
            std::array::from_fn(|i| if eta > 0.0 { trial[i + 1] + c * point.slipped[i] } else { 0.0 });
        let size = along[0].hypot(along[1]);
        let kappa = self.largest(point);
        if kappa > 0.0 {
            let a = self.envelope(kappa)[0] / kappa;
            let b = eta * eta * a;
            let opening = (normal / (a + c)).hypot(eta * size / (b + c));
            if opening <= kappa {
                if a == 0.0 {
                    return (Projected::default(), opening);
                }
                let shares = [a / (a + c), b / (b + c)];
                return (linear([trial[0], along[0], along[1]], shares, Status::Stick), opening);
            }
        } else if (normal / self.strength).hypot(if eta > 0.0 { size / (eta * self.strength) } else { 0.0 }) <= 1.0 {
            let share = if eta > 0.0 { 1.0 } else { 0.0 };
            return (linear([trial[0], along[0], along[1]], [1.0, share], Status::Stick), 0.0);
        }
        let last = self.last();
        if (normal / c).hypot(eta * size / c) >= last {
            return (Projected::default(), (normal / c).hypot(eta * size / c));
        }
        let parts = |opening: f64| {
            let [t, slope] = self.envelope(opening);
            let (u, u_by) = (t + c * opening, slope + c);
            let (v, v_by) = (eta * t + c * opening / eta, eta * slope + c / eta);
            (t, slope, [u, u_by], [v, v_by])
        };
        let equation = |opening: f64| {
            let (_, _, [u, u_by], [v, v_by]) = parts(opening);
            let shear = if eta > 0.0 { [(size / v).powi(2), (size / v).powi(2) * v_by / v] } else { [0.0; 2] };
            [(normal / u).powi(2) + shear[0] - 1.0, -2.0 * ((normal / u).powi(2) * u_by / u + shear[1])]
        };
        let opening = root([kappa, last], equation);
        let (t, slope, [u, _], [v, _]) = parts(opening);
        let [_, by_opening] = equation(opening);
        let shear = |x: f64| if eta > 0.0 { x } else { 0.0 };
        // How the opening changes with the trials `(-ζ_n, z_1, z_2)`.
        let by = [2.0 * normal / (u * u), shear(2.0 * along[0] / (v * v)), shear(2.0 * along[1] / (v * v))]
            .map(|g| -g / by_opening);
        let bends = t - opening * slope;
        let gap_by = [opening / u, normal * bends / (u * u)];
        let slip_by = [shear(opening / (eta * v)), shear(bends / (v * v))];
        let mut out = Projected { status: Status::Slip, ..Projected::default() };
        // Not as what the opening leaves of the trial, which may be much larger.
        out.traction[0] = -t * normal / u;
        // With respect to `ζ_n = -z_n` two signs meet.
        for j in 0..3 {
            let sign = if j == 0 { -1.0 } else { 1.0 };
            let own = f64::from(u8::from(j == 0));
            out.derivative[0][j] = -sign * (own - c * (gap_by[0] * own + gap_by[1] * by[j]));
        }
        for i in 0..2 {
            out.traction[i + 1] = shear(eta * t * along[i] / v);
            for j in 0..3 {
                let sign = if j == 0 { -1.0 } else { 1.0 };
                let own = f64::from(u8::from(j == i + 1));
                out.derivative[i + 1][j] = shear(sign * (own - c * (slip_by[0] * own + slip_by[1] * along[i] * by[j])));
            }
        }
        (out, opening)
    }

    /// Pressed together without a bond along the surface.
    fn rubbing(&self, trial: [f64; 3], point: &LawPoint) -> Projected {
        // At no pressure they are held, not apart.
        let p = trial[0].max(f64::MIN_POSITIVE);
        let friction = self.friction.friction_at([trial[1], trial[2]], p, point);
        rubbing(&friction, trial[0], [1.0, 0.0, 0.0])
    }

    /// Pressed together, with a bond along the surface: what is damaged of it rubs.
    fn pressed(&self, trial: [f64; 3], point: &LawPoint) -> (Projected, f64) {
        let (c, eta, p) = (point.per_gap, self.shear, trial[0]);
        let along = [trial[1], trial[2]];
        let kappa = self.largest(point);
        let whole: [f64; 2] = std::array::from_fn(|i| along[i] + c * point.slipped[i]);
        if kappa == 0.0 && whole[0].hypot(whole[1]) <= eta * self.strength {
            return (linear([p, whole[0], whole[1]], [1.0, 1.0], Status::Stick), 0.0);
        }
        // The slip in all with a bond of stiffness `b` and a damaged part, with its derivatives in trials, pressure, stiffness
        // and part.
        let slip = |b: f64, damaged: f64| {
            let tau: [f64; 2] = std::array::from_fn(|i| along[i] - b * point.slipped[i]);
            let friction = if damaged * p > 0.0 { self.friction.friction_at(tau, damaged * p, point) } else { free() };
            let new: [f64; 2] = std::array::from_fn(|i| (tau[i] - friction.traction[i]) / (c + b));
            (friction, new)
        };
        let total = |new: [f64; 2]| -> [f64; 2] { std::array::from_fn(|i| point.slipped[i] + new[i]) };
        let at = |opening: f64| {
            let [t, _] = self.envelope(opening);
            let (friction, new) = slip(eta * eta * t / opening, 1.0 - t / self.strength);
            (friction, new, total(new))
        };
        let size = |e: [f64; 2]| eta * e[0].hypot(e[1]);
        let holds = kappa > 0.0 && size(at(kappa).2) <= kappa;
        let last = self.last();
        let (_, _, broken) = at(last);
        let opening = if holds {
            kappa
        } else if size(broken) >= last {
            last
        } else {
            root([kappa.max(LEAST * last), last], |opening| [size(at(opening).2) - opening, f64::NAN])
        };
        let (friction, new, e) = at(opening);
        let [t, slope] = self.envelope(opening);
        let b = eta * eta * t / opening;
        let damaged = 1.0 - t / self.strength;
        let d = friction.by_trial;
        // Slip by trial and pressure, at a constant opening.
        let e_by = |i: usize, j: usize| match j {
            0 => -damaged * friction.by_pressure[i] / (c + b),
            _ => (f64::from(u8::from(i + 1 == j)) - d[i][j - 1]) / (c + b),
        };
        // And by the opening, while damage grows.
        let grows = !holds && t > 0.0;
        let b_by = eta * eta * (slope - t / opening) / opening;
        let by_opening: [f64; 2] = std::array::from_fn(|i| {
            let tau = |k: usize| -b_by * point.slipped[k];
            let t_by = d[i][0] * tau(0) + d[i][1] * tau(1) - friction.by_pressure[i] * p * slope / self.strength;
            (tau(i) - t_by - new[i] * b_by) / (c + b)
        });
        let length = e[0].hypot(e[1]);
        let unit = if length > 0.0 { e.map(|v| v / length) } else { [0.0; 2] };
        let divisor = 1.0 - eta * (unit[0] * by_opening[0] + unit[1] * by_opening[1]);
        let mut out = Projected { status: Status::Slip, ..Projected::default() };
        (out.traction[0], out.derivative[0][0]) = (p, 1.0);
        for j in 0..3 {
            let opens = if grows { eta * (unit[0] * e_by(0, j) + unit[1] * e_by(1, j)) / divisor } else { 0.0 };
            for i in 0..2 {
                let own = f64::from(u8::from(j == i + 1));
                out.derivative[i + 1][j] = own - c * (e_by(i, j) + by_opening[i] * opens);
            }
        }
        (0..2).for_each(|i| out.traction[i + 1] = along[i] - c * new[i]);
        if (holds && t > 0.0) || !friction.slips {
            out.status = Status::Stick;
        }
        (out, if holds { size(e) } else { opening })
    }
}

/// Tractions in proportion to their trials, normal and along.
fn linear(trial: [f64; 3], [normal, along]: [f64; 2], status: Status) -> Projected {
    let shares = [normal, along, along];
    let mut out = Projected { status, ..Projected::default() };
    for i in 0..3 {
        (out.traction[i], out.derivative[i][i]) = (shares[i] * trial[i], shares[i]);
    }
    out
}

/// The root of a function between a place where it is positive and one where it is not, with its slope where that is known.
fn root([mut low, mut high]: [f64; 2], value: impl Fn(f64) -> [f64; 2]) -> f64 {
    let mut x = 0.5 * (low + high);
    // Values at the ends, for the secant where there is no slope (Illinois rule).
    let [mut at_low, mut at_high] = [value(low)[0], value(high)[0]];
    let mut kept = 0i8;
    for _ in 0..MOST_STEPS {
        let [f, slope] = value(x);
        let side = if f > 0.0 {
            (low, at_low) = (x, f);
            1
        } else {
            (high, at_high) = (x, f);
            -1
        };
        if kept == side {
            if side > 0 { at_high *= 0.5 } else { at_low *= 0.5 }
        }
        kept = side;
        let next = if slope.is_finite() { x - f / slope } else { (low * at_high - high * at_low) / (at_high - at_low) };
        let rounding = 2.0 * f64::EPSILON * x.abs();
        if f == 0.0 || (next - x).abs() <= rounding || high - low <= rounding {
            break;
        }
        x = if next > low && next < high { next } else { 0.5 * (low + high) };
    }
    x
}

impl Law for Cohesion {
    fn begin(&mut self, time: f64) {
        self.friction.begin(time);
    }

    fn friction(&self, trial: [f64; 2], pressure: f64) -> Friction {
        self.friction.friction(trial, pressure)
    }

    fn friction_at(&self, trial: [f64; 2], pressure: f64, point: &LawPoint) -> Friction {
        self.friction.friction_at(trial, pressure, point)
    }

    fn pressure(&self, trial: f64, point: &LawPoint) -> [f64; 2] {
        let found = self.state([trial, 0.0, 0.0], point).0;
        [found.traction[0], found.derivative[0][0]]
    }

    fn range(&self) -> f64 {
        self.last()
    }

    fn is_compliant(&self) -> bool {
        true
    }

    fn least_scale(&self) -> f64 {
        STEEPER * self.strength / self.fall * self.shear.max(1.0).powi(2)
    }

    fn strength(&self) -> [f64; 2] {
        [self.strength, self.shear * self.strength]
    }

    fn is_bond(&self) -> bool {
        !self.heals
    }

    fn opening(&self, trial: [f64; 3], point: &LawPoint) -> f64 {
        if self.heals { 0.0 } else { self.state(trial, point).1 }
    }

    fn is_tangential(&self) -> bool {
        self.shear > 0.0 || self.friction.per_pressure() != Some([0.0; 2])
    }

    fn is_rate_dependent(&self) -> bool {
        self.friction.is_rate_dependent()
    }

    /// Of what is bonded along the surface, none: it is not friction that holds it.
    fn utilisation(&self, traction: [f64; 2], pressure: f64) -> f64 {
        if self.shear > 0.0 || pressure <= 0.0 || self.friction.per_pressure() == Some([0.0; 2]) {
            0.0
        } else {
            self.friction.utilisation(traction, pressure)
        }
    }

    fn per_pressure(&self) -> Option<[f64; 2]> {
        self.friction.per_pressure()
    }

    fn traction(&self, trial: [f64; 3], point: &LawPoint) -> Projected {
        self.state(trial, point).0
    }
}
