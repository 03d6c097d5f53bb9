//! Whether a rope holds on a given curve: the generalised theorem of Euler and Eytelwein.
//!
//! A weightless, perfectly flexible rope with tensions `T_0` and `T_1` at its ends is in equilibrium on a given curve if
//! and only if at every point (1) `N = -k_n T > 0`, (2) `|tan α| = |k_g/k_n| <= μ_g`, and between the ends
//! (3) `T_0 exp(∫ω₋ ds) <= T_1 <= T_0 exp(∫ω₊ ds)`, with `ω±` of [`crate::friction`]. (Konyukhov, Contact of ropes and
//! orthotropic rough surfaces, ZAMM 95, 2015; Konyukhov & Izi, Introduction to Computational Contact Mechanics, 2015.)

use crate::PathError;
use crate::curve::Curve;
use crate::darboux::{Darboux, darboux_at};
use crate::friction::{Friction, ROUNDING, Reactions};
use crate::ode::{Control, Next, State, System, integrate};
use crate::quadrature;
use signorini_geometry::Vector;
use signorini_geometry::rigid_shape::RigidShape;

/// Places per smooth piece of a curve at which the conditions are looked at before their limits are located.
const PLACES: usize = 128;
/// Error of the integrals relative to their size.
const TOLERANCE: f64 = 1e-12;

/// A condition of the theorem that does not depend on the tensions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Condition {
    /// (1): the rope is pressed on.
    Pressed,
    /// (2): friction across the rope holds it on the curve.
    Lateral,
}

/// A part of the curve on which a condition fails.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Violation {
    pub condition: Condition,
    /// Arc lengths at which it starts and ends.
    pub from: f64,
    pub to: f64,
    /// Arc length of the worst place.
    pub at: f64,
    /// `k_n` there, or `|tan α|`.
    pub value: f64,
    /// What it must stay below: zero, or `μ_g`.
    pub limit: f64,
}

/// A value and the arc length at which it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extreme {
    pub s: f64,
    pub value: f64,
}

/// What a curve on a surface can hold.
#[derive(Clone, Debug, PartialEq)]
pub struct TensionLimits {
    /// Length of the curve.
    pub length: f64,
    /// `∫ω₋ ds` and `∫ω₊ ds`, the limits of `ln(T_1/T_0)`; of the parts where the conditions hold.
    pub log_ratio: [f64; 2],
    /// In order of arc length.
    pub violations: Vec<Violation>,
    /// The largest `|tan α|` of the places that were looked at.
    pub steepest: Extreme,
    /// The largest `k_n`.
    pub least_pressed: Extreme,
    /// The largest distance of the curve from the surface.
    pub off_surface: f64,
}

/// The answer of the theorem for two end tensions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// In equilibrium. The share of the limit of `ln(T_1/T_0)` that is used.
    Holds {
        utilisation: f64,
    },
    LiftsOff {
        s: f64,
        k_n: f64,
    },
    SlidesSideways {
        s: f64,
        tan_alpha: f64,
        limit: f64,
    },
    /// Towards the end, whose tension is too high, or towards the start.
    SlidesAlong {
        towards: Towards,
        ratio: f64,
        limit: f64,
    },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Towards {
    Start,
    End,
}

impl std::fmt::Display for Verdict {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Verdict::Holds { utilisation } => {
                write!(
                    f,
                    "in equilibrium: {:.1} % of the friction limit along the rope is required",
                    100.0 * utilisation
                )
            }
            Verdict::LiftsOff { s, k_n } => write!(f, "lifts off at s = {s:.4}: k_n = {k_n:.4} >= 0"),
            Verdict::SlidesSideways { s, tan_alpha, limit } => {
                write!(f, "slides sideways at s = {s:.4}: |tan α| = {tan_alpha:.4} > μ_g = {limit:.4}")
            }
            Verdict::SlidesAlong { towards, ratio, limit } => {
                let (end, sign) = match towards {
                    Towards::End => ("end", '>'),
                    Towards::Start => ("start", '<'),
                };
                write!(f, "slides towards its {end}: T_1/T_0 = {ratio:.4} {sign} {limit:.4}")
            }
        }
    }
}

impl TensionLimits {
    /// Whether conditions (1) and (2) hold all along, so that there are tensions in equilibrium.
    pub fn is_admissible(&self) -> bool {
        self.violations.is_empty()
    }

    /// The tensions at the end that are in equilibrium with one at the start; `None` where no tension is.
    pub fn end_tensions(&self, start: f64) -> Option<[f64; 2]> {
        self.is_admissible().then(|| self.log_ratio.map(|l| start * l.exp()))
    }

    /// Whether two end tensions are in equilibrium, and if not, why.
    ///
    /// # Errors
    /// A tension that is not positive.
    pub fn verdict(&self, start: f64, end: f64) -> Result<Verdict, PathError> {
        for value in [start, end] {
            if !(value.is_finite() && value > 0.0) {
                return Err(PathError::Input { what: "tension", value, valid: "a number greater than zero" });
            }
        }
        // What lifts off does so under any friction.
        let first = |c: Condition| self.violations.iter().find(|v| v.condition == c);
        if let Some(v) = first(Condition::Pressed) {
            return Ok(Verdict::LiftsOff { s: v.at, k_n: v.value });
        }
        if let Some(v) = first(Condition::Lateral) {
            return Ok(Verdict::SlidesSideways { s: v.at, tan_alpha: v.value, limit: v.limit });
        }
        let log = (end / start).ln();
        let [low, high] = self.log_ratio;
        let limit = if log >= 0.0 { high } else { low };
        if log.abs() <= limit.abs() * (1.0 + ROUNDING) + ROUNDING {
            let utilisation = if log == 0.0 { 0.0 } else { log / limit };
            return Ok(Verdict::Holds { utilisation });
        }
        let towards = if log > 0.0 { Towards::End } else { Towards::Start };
        Ok(Verdict::SlidesAlong { towards, ratio: end / start, limit: limit.exp() })
    }
}

/// The limits of a curve on a surface.
///
/// # Errors
/// Coefficients out of range, a curve without tangent.
pub fn tension_limits(
    surface: &dyn RigidShape,
    curve: &dyn Curve,
    friction: &Friction,
) -> Result<TensionLimits, PathError> {
    friction.check()?;
    let [from, to] = curve.domain();
    let breaks = quadrature::breaks_between(curve, from, to);
    let look = |t: f64| darboux_at(surface, curve, t).map(|(frame, _)| frame);
    let mut parameters = Vec::new();
    for w in breaks.windows(2) {
        let places = (PLACES / (breaks.len() - 1)).max(8);
        parameters.extend((0..places).map(|k| w[0] + (w[1] - w[0]) * k as f64 / places as f64));
    }
    parameters.push(to);
    let frames = parameters.iter().map(|t| look(*t)).collect::<Result<Vec<_>, _>>()?;
    let s_at = |t: f64| quadrature::arc_length(curve, from, t);
    let mut violations = Vec::new();
    for condition in [Condition::Pressed, Condition::Lateral] {
        let margin = |t: f64| look(t).map_or(f64::NAN, |f| margin(condition, &f, friction));
        for (a, b) in failing(&parameters, &margin) {
            let (t, _) = minimum(&margin, a, b);
            let frame = look(t)?;
            let (value, limit) = match condition {
                Condition::Pressed => (frame.k_n, 0.0),
                Condition::Lateral => (frame.tan_alpha().abs(), friction.lateral(&frame)),
            };
            violations.push(Violation { condition, from: s_at(a), to: s_at(b), at: s_at(t), value, limit });
        }
    }
    violations.sort_by(|a, b| a.from.total_cmp(&b.from));
    let (integrals, _) = quadrature::integrate(
        |t| {
            let Ok((frame, speed)) = darboux_at(surface, curve, t) else { return [f64::NAN; 3] };
            let pressed = frame.k_n < 0.0;
            let [low, high] =
                pressed.then(|| friction.range(&frame, frame.k_n, frame.k_g)).flatten().unwrap_or_default();
            [low * speed, high * speed, speed]
        },
        &breaks,
        TOLERANCE,
    );
    let extreme = |of: &dyn Fn(&Darboux) -> f64| {
        let worst = (0..frames.len()).max_by(|&i, &j| of(&frames[i]).total_cmp(&of(&frames[j]))).unwrap_or(0);
        Extreme { s: s_at(parameters[worst]), value: of(&frames[worst]) }
    };
    Ok(TensionLimits {
        length: integrals[2],
        log_ratio: [integrals[0], integrals[1]],
        violations,
        steepest: extreme(&|f| f.tan_alpha().abs()),
        least_pressed: extreme(&|f| f.k_n),
        off_surface: frames.iter().map(|f| f.gap.abs()).fold(0.0, f64::max),
    })
}

/// The limits of a rope that is known by the frames of its points, in order, and their lengths: what the reactions of a
/// solved rope could be. Violations are the points at which a condition fails.
///
/// # Errors
/// Coefficients out of range.
pub fn limits_of_points(frames: &[(Darboux, f64)], friction: &Friction) -> Result<TensionLimits, PathError> {
    friction.check()?;
    let nowhere = Extreme { s: f64::NAN, value: f64::NEG_INFINITY };
    let mut out = TensionLimits {
        length: frames.iter().map(|(_, length)| length).sum(),
        log_ratio: [0.0; 2],
        violations: Vec::new(),
        steepest: nowhere,
        least_pressed: nowhere,
        off_surface: 0.0,
    };
    for (frame, length) in frames {
        let tan_alpha = if frame.k_g == 0.0 { 0.0 } else { frame.tan_alpha().abs() };
        for (extreme, value) in [(&mut out.steepest, tan_alpha), (&mut out.least_pressed, frame.k_n)] {
            if value > extreme.value {
                *extreme = Extreme { s: frame.s, value };
            }
        }
        for condition in [Condition::Pressed, Condition::Lateral] {
            if margin(condition, frame, friction) < 0.0 {
                let (value, limit) = match condition {
                    Condition::Pressed => (frame.k_n, 0.0),
                    Condition::Lateral => (tan_alpha, friction.lateral(frame)),
                };
                let (from, to) = (frame.s - 0.5 * length, frame.s + 0.5 * length);
                out.violations.push(Violation { condition, from, to, at: frame.s, value, limit });
            }
        }
        if frame.k_n < 0.0
            && let Some([low, high]) = friction.range(frame, frame.k_n, frame.k_g)
        {
            out.log_ratio[0] += low * length;
            out.log_ratio[1] += high * length;
        }
    }
    Ok(out)
}

/// The reactions at given parameters under end tensions that are between the limits, the share of the limit used being the
/// same everywhere: `T = T_0 exp(c ∫ω ds)`.
///
/// # Errors
/// As of [`tension_limits`]; a tension that is not positive; parameters that do not increase.
pub fn reactions(
    surface: &dyn RigidShape,
    curve: &dyn Curve,
    friction: &Friction,
    [start, end]: [f64; 2],
    parameters: &[f64],
) -> Result<Vec<Reactions>, PathError> {
    let limits = tension_limits(surface, curve, friction)?;
    limits.verdict(start, end)?;
    let log = (end / start).ln();
    let side = usize::from(log >= 0.0);
    let share = if log == 0.0 { 0.0 } else { log / limits.log_ratio[side] };
    let from = curve.domain()[0];
    let frames = crate::darboux::darboux(surface, curve, parameters)?;
    let rate = |f: &Darboux| friction.range(f, f.k_n, f.k_g).map_or(0.0, |r| r[side]) * share;
    frames
        .into_iter()
        .zip(parameters)
        .map(|(frame, &t)| {
            let breaks = quadrature::breaks_between(curve, from, t);
            let integral = quadrature::integrate(
                |t| darboux_at(surface, curve, t).map_or([f64::NAN], |(f, speed)| [rate(&f) * speed]),
                &breaks,
                TOLERANCE,
            );
            let tension = start * integral.0[0].exp();
            Ok(Reactions::new(&frame, tension, tension * rate(&frame), friction))
        })
        .collect()
}

/// The end tensions in equilibrium with one at the start, with a constant force per length on the rope (its weight):
/// `T' + T̃ + q_τ = 0`, `k_g T + G + q_g = 0`, `k_n T + N + q_n = 0`, integrated at the two limits of friction.
///
/// # Errors
/// Coefficients out of range; where the rope lifts off or slides sideways on the way.
pub fn loaded_end_tensions(
    surface: &dyn RigidShape,
    curve: &dyn Curve,
    friction: &Friction,
    load: Vector<3>,
    start: f64,
) -> Result<[f64; 2], PathError> {
    friction.check()?;
    let [from, to] = curve.domain();
    let system = Loaded { surface, curve, friction, load, start };
    let mut tensions = State::<2>::repeat(start);
    let control = |length: f64| Control { tolerance: 1e-10, first: length / PLACES as f64 };
    for w in quadrature::breaks_between(curve, from, to).windows(2) {
        let end = integrate(&system, [w[0], w[1]], &tensions, control(w[1] - w[0]), |_, _, _, _| Next::Continue);
        tensions = match end {
            Ok((_, y)) => y,
            Err(PathError::Stalled { at, .. }) => {
                let s = quadrature::arc_length(curve, from, at);
                let wanted =
                    "the end of the rope: there the rope lifts off or slides sideways under its load".to_owned();
                return Err(PathError::NotReached { wanted, at: s });
            }
            Err(other) => return Err(other),
        };
    }
    Ok(tensions.into())
}

struct Loaded<'a> {
    surface: &'a dyn RigidShape,
    curve: &'a dyn Curve,
    friction: &'a Friction,
    load: Vector<3>,
    start: f64,
}

impl System<2> for Loaded<'_> {
    fn slope(&self, t: f64, y: &State<2>) -> State<2> {
        let Ok((frame, speed)) = darboux_at(self.surface, self.curve, t) else {
            return State::<2>::repeat(f64::NAN);
        };
        let [q_tau, q_g, q_n] = [frame.tau, frame.g, frame.n].map(|e| self.load.dot(&e));
        State::<2>::from_fn(|side, _| {
            let (normal, lateral) = (frame.k_n * y[side] + q_n, frame.k_g * y[side] + q_g);
            let range = (normal < 0.0).then(|| self.friction.range(&frame, normal, lateral)).flatten();
            range.map_or(f64::NAN, |r| (r[side] - q_tau) * speed)
        })
    }

    fn scale(&self) -> State<2> {
        State::<2>::repeat(self.start)
    }
}

/// Positive where a condition holds.
fn margin(condition: Condition, at: &Darboux, friction: &Friction) -> f64 {
    match condition {
        Condition::Pressed => -at.k_n - ROUNDING * at.k_n.hypot(at.k_g),
        // Where the rope is not pressed on, that is what is wrong with it.
        Condition::Lateral if at.k_n >= 0.0 => 1.0,
        Condition::Lateral => 1.0 + ROUNDING - at.tan_alpha().abs() / friction.lateral(at).max(f64::MIN_POSITIVE),
    }
}

/// The intervals on which a function is negative or zero, from samples; local minima between samples are followed.
fn failing(parameters: &[f64], f: &impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    let mut points: Vec<(f64, f64)> = parameters.iter().map(|t| (*t, f(*t))).collect();
    let narrow: Vec<(f64, f64)> = points
        .windows(3)
        .filter(|w| w[1].1 > 0.0 && w[1].1 <= w[0].1 && w[1].1 <= w[2].1)
        .map(|w| minimum(f, w[0].0, w[2].0))
        .filter(|m| m.1 <= 0.0)
        .collect();
    points.extend(narrow);
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let bad = |v: f64| v <= 0.0;
    let mut out: Vec<(f64, f64)> = Vec::new();
    let mut open = bad(points[0].1).then_some(points[0].0);
    for w in points.windows(2) {
        let [(a, va), (b, vb)] = [w[0], w[1]];
        if bad(va) == bad(vb) {
            continue;
        }
        let (mut low, mut high) = (a, b);
        while high - low > 1e-13 * (b.abs() + a.abs()) {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            if bad(f(middle)) == bad(va) { low = middle } else { high = middle }
        }
        match open.take() {
            Some(start) => out.push((start, low)),
            None => open = Some(high),
        }
    }
    if let Some(start) = open {
        out.push((start, points[points.len() - 1].0));
    }
    out
}

/// The smallest of samples of a function on an interval, made better by golden sections about it.
fn minimum(f: &impl Fn(f64) -> f64, from: f64, to: f64) -> (f64, f64) {
    const SAMPLES: usize = 16;
    let at = |k: usize| from + (to - from) * k as f64 / SAMPLES as f64;
    let best = (0..=SAMPLES).map(|k| (at(k), f(at(k)))).min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((from, f(from)));
    let width = (to - from) / SAMPLES as f64;
    let (mut low, mut high) = ((best.0 - width).max(from), (best.0 + width).min(to));
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let mut found = best;
    for _ in 0..60 {
        let (a, b) = (high - golden * (high - low), low + golden * (high - low));
        let (fa, fb) = (f(a), f(b));
        for point in [(a, fa), (b, fb)] {
            if point.1 < found.1 {
                found = point;
            }
        }
        if fa < fb {
            high = b
        } else {
            low = a
        }
        if high - low <= 1e-9 * (to - from) {
            break;
        }
    }
    found
}
