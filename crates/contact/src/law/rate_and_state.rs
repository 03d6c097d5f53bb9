//! Rate-and-state friction (Dieterich 1979; Ruina 1983), regularised at rest (Rice & Ben-Zion 1996).
//!
//! | symbol | meaning |
//! |---|---|
//! | `V`, `V_0` | velocity of slip, and the one at which the coefficients hold |
//! | `θ`, `D` | state, a time; distance of slip over which it changes |
//! | `T = p a asinh(V/(2 V_0) exp((μ + b ln(V_0 θ/D))/a))` | friction, along the slip |
//! | aging law | `dθ/dt = 1 - V θ/D` |
//! | slip law | `dθ/dt = -(V θ/D) ln(V θ/D)` |
//!
//! At rest the state grows by the aging law, and stays by the slip law; both have `θ = D/V` where slip is steady, with
//! `T = p (μ + (a - b) ln(V/V_0))` but for the regularisation.
//!
//! Within an increment `Δt` the velocity is constant, and the state is that of its end: with `s = V Δt/D`
//!
//! ```text
//! aging:  θ = θ_0 e^-s + Δt (1 - e^-s)/s          slip:  ln θ = e^-s ln θ_0 + (1 - e^-s) ln(D/V)
//! ```
//!
//! The velocity is that at which the trial `|ζ| = ρ V + T(V)` is met, with the trial traction `ρ` per velocity: a root in `ln V`.
//! Where friction falls with the velocity by more than `ρ` there are several; there are none as long as the slip of the increment
//! is below `D a/b`. In no time (`ρ = 0`) it is the law of Coulomb with the coefficient `μ`.

use super::{Coulomb, Friction, Law, LawError, LawPoint, checked};

/// How the state changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Evolution {
    Aging,
    Slip,
}

/// Constants of rate-and-state friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RateAndStateKeys {
    /// Coefficient of friction of steady slip at `velocity`.
    pub mu: f64,
    pub a: f64,
    pub b: f64,
    pub velocity: f64,
    /// Slip over which the state changes.
    pub distance: f64,
    pub evolution: Evolution,
    /// State at the start, a time.
    pub state: f64,
}

/// Rate-and-state friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RateAndState {
    keys: RateAndStateKeys,
    limit: Coulomb,
}

/// Steps to the velocity: bisection alone takes as many as a number has digits, in twice the range of exponents.
const MOST_STEPS: usize = 200;

impl RateAndState {
    /// # Errors
    /// Constants that are negative or not finite, and those that have to be positive (all but `mu` and `b`).
    pub fn new(keys: RateAndStateKeys) -> Result<Self, LawError> {
        let RateAndStateKeys { mu, a, b, velocity, distance, state, .. } = keys;
        checked(&[mu, a, b, velocity, distance, state])?;
        match [a, velocity, distance, state].into_iter().find(|v| *v == 0.0) {
            Some(value) => Err(LawError { value }),
            None => Ok(RateAndState { keys, limit: Coulomb::isotropic(mu)? }),
        }
    }

    /// `ln(θ/θ_start)` at the end of an increment with a velocity, and its derivative in `ln V`.
    pub fn state(&self, before: f64, velocity: f64, duration: f64) -> [f64; 2] {
        let RateAndStateKeys { distance, evolution, state, .. } = self.keys;
        let s = velocity * duration / distance;
        let decay = (-s).exp();
        match evolution {
            Evolution::Aging => {
                let start = state * before.exp();
                let mean = if s > 0.0 { -(-s).exp_m1() / s } else { 1.0 };
                let theta = start * decay + duration * mean;
                let slope = -s * start * decay + duration * (decay - mean);
                [(theta / state).ln(), slope / theta]
            }
            Evolution::Slip => {
                let gone = -(-s).exp_m1();
                // Of a velocity that is zero nothing is gone.
                let steady = if velocity > 0.0 { (distance / (velocity * state)).ln() } else { 0.0 };
                [before * decay + gone * steady, -gone + s * decay * (steady - before)]
            }
        }
    }

    /// Friction per pressure at the end of an increment with a velocity, and its derivative in `ln V`.
    pub fn coefficient(&self, before: f64, velocity: f64, duration: f64) -> [f64; 2] {
        let RateAndStateKeys { mu, a, b, velocity: reference, distance, state, .. } = self.keys;
        let [psi, slope] = self.state(before, velocity, duration);
        let psi = psi + (reference * state / distance).ln();
        let exponent = (velocity / (2.0 * reference)).ln() + (mu + b * psi) / a;
        let [value, share] = asinh_of_exponential(exponent);
        [a * value, share * (a + b * slope)]
    }

    /// The velocity at which a trial is met: the logarithm of it.
    fn logarithm(&self, size: f64, per_velocity: f64, pressure: f64, point: &LawPoint) -> f64 {
        let residual = |y: f64| {
            let velocity = y.exp();
            let [mu, slope] = self.coefficient(point.remembered, velocity, point.duration);
            [per_velocity * velocity + pressure * mu - size, per_velocity * velocity + pressure * slope]
        };
        // Above: no friction. Below: as little velocity as moves the trial by rounding, or the law by that.
        let mut high = (size / per_velocity).ln();
        let mut low = high - 1.0;
        while residual(low)[0] > 0.0 && low > f64::MIN_POSITIVE.ln() {
            low = high - 2.0 * (high - low);
        }
        let mut y = 0.5 * (low + high);
        for _ in 0..MOST_STEPS {
            let [value, slope] = residual(y);
            if value > 0.0 {
                high = y
            } else {
                low = y
            }
            let next = y - value / slope;
            let next = if next > low && next < high { next } else { 0.5 * (low + high) };
            let moved = (next - y).abs();
            y = next;
            if moved <= 4.0 * f64::EPSILON * y.abs().max(1.0) {
                break;
            }
        }
        y
    }
}

/// `asinh(e^x)` and its derivative, for any `x`.
fn asinh_of_exponential(x: f64) -> [f64; 2] {
    // Beyond it `e^-2x` is below rounding.
    const LARGE: f64 = 20.0;
    if x > LARGE { [x + std::f64::consts::LN_2, 1.0] } else { [x.exp().asinh(), 1.0 / (-x).exp().hypot(1.0)] }
}

impl Law for RateAndState {
    fn friction(&self, trial: [f64; 2], pressure: f64) -> Friction {
        self.limit.friction(trial, pressure)
    }

    fn friction_at(&self, trial: [f64; 2], pressure: f64, point: &LawPoint) -> Friction {
        let rate = point.per_velocity();
        let size = trial[0].hypot(trial[1]);
        if rate <= 0.0 || pressure <= 0.0 {
            return self.limit.friction(trial, pressure);
        }
        if size == 0.0 {
            // At rest friction is as stiff as the exponential, which is far stiffer than the trial.
            return Friction {
                traction: [0.0; 2],
                by_trial: [[1.0, 0.0], [0.0, 1.0]],
                by_pressure: [0.0; 2],
                slips: true,
            };
        }
        let velocity = self.logarithm(size, rate, pressure, point).exp();
        let [mu, slope] = self.coefficient(point.remembered, velocity, point.duration);
        let whole = rate * velocity + pressure * slope;
        let along = [trial[0] / size, trial[1] / size];
        let stiff = 1.0 - rate * velocity / whole;
        let traction = pressure * mu;
        let across = traction / size;
        let entry = |i: usize, j: usize| {
            let own = if i == j { across } else { 0.0 };
            own + (stiff - across) * along[i] * along[j]
        };
        Friction {
            traction: along.map(|u| traction * u),
            by_trial: [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]],
            by_pressure: along.map(|u| mu * rate * velocity / whole * u),
            slips: true,
        }
    }

    fn is_rate_dependent(&self) -> bool {
        true
    }

    fn has_state(&self) -> bool {
        true
    }

    fn remember(&self, trial: [f64; 3], traction: [f64; 3], point: &LawPoint) -> f64 {
        let rate = point.per_velocity();
        if rate <= 0.0 || traction[0] <= 0.0 {
            return point.remembered;
        }
        let size = trial[1].hypot(trial[2]);
        let velocity = if size > 0.0 { self.logarithm(size, rate, traction[0], point).exp() } else { 0.0 };
        self.state(point.remembered, velocity, point.duration)[0]
    }

    fn utilisation(&self, traction: [f64; 2], pressure: f64) -> f64 {
        self.limit.utilisation(traction, pressure)
    }

    fn per_pressure(&self) -> Option<[f64; 2]> {
        self.limit.per_pressure()
    }
}
