//! Increments without adhesion in which not the time is given but the area of contact, or a length in area and time. The state
//! depends on the time alone then, so the time is the root of an equation, each value of which is an increment of its own:
//! zones may appear, merge and vanish on the way.

use super::statement::{Control, PlannedIncrement};

/// Times that are looked at until the one sought lies between two of them, and between these.
const MOST_PROBES: usize = 16;
const MOST_LOOKS: usize = 40;
/// A longer step than the last one, at most, in search of a time beyond.
const FARTHER: f64 = 4.0;
/// What an area may lack, relative to the membrane's; what it may after looks that gain nothing ...
const EXACT: f64 = 1e-9;
const NEARLY: f64 = 1e-6;
/// ... and where no time lies between two others, which is so much as cells tell an area.
const TOLD: f64 = 1e-3;
/// What the length of an increment may lack of it.
const EVEN: f64 = 1e-4;
/// Times nearer than this part of their step are one.
const SAME: f64 = 1e-8;

/// The area of contact at a time; none where there is no state.
type Area<'a> = dyn FnMut(f64) -> Option<f64> + 'a;

/// Where a step stands.
pub struct AreaController {
    pub step: usize,
    /// The time that the step takes, and the area of the membrane.
    size: [f64; 2],
    /// The area of contact at its beginning.
    begin: f64,
    /// Whether the step has come to its end.
    pub done: bool,
}

impl AreaController {
    /// Begins a step at a state with an area of contact, of a membrane with an area.
    pub fn begin(planned: &PlannedIncrement, begin: f64, membrane: f64) -> Self {
        let [from, to] = planned.range;
        Self { step: planned.step, size: [to - from, membrane], begin, done: false }
    }

    /// The time of the next state after one at a time with an area.
    ///
    /// # Errors
    /// In words, why there is no such time.
    pub fn advance(&mut self, planned: &PlannedIncrement, from: [f64; 2], area: &mut Area<'_>) -> Result<f64, String> {
        match planned.control {
            Control::Time => Ok(planned.time),
            Control::Area { to, part, parts } => {
                let part = part as f64 / parts as f64;
                self.by_area(from, self.begin + (to - self.begin) * part, self.size[0] / parts as f64, area)
            }
            Control::ArcLength(length) => self.by_arc_length(from, length, planned.range[1], area),
        }
    }

    /// The time at which the area is a given one, a step in time away.
    fn by_area(&self, from: [f64; 2], target: f64, step: f64, area: &mut Area<'_>) -> Result<f64, String> {
        let sense = (target - from[1]).signum();
        let lacking = |a: f64| sense * (a - target) / self.size[1];
        let mut value = |t: f64| area(t).map(lacking);
        let (mut low, mut step, mut turned) = ([from[0], lacking(from[1])], step, false);
        if low[1] >= -EXACT {
            return Ok(from[0]);
        }
        for _ in 0..MOST_PROBES {
            let time = (low[0] + step).max(0.0);
            if time == low[0] {
                break;
            }
            let Some(found) = value(time) else {
                step *= 0.5;
                continue;
            };
            if found >= 0.0 {
                let [a, b] = between([low, [time, found]], EXACT, SAME * self.size[0], &mut value);
                let [nearest, other] = if a[1].abs() <= b[1].abs() { [a, b] } else { [b, a] };
                let back = |lacking: f64| target + sense * lacking * self.size[1];
                return match nearest[1].abs() <= TOLD {
                    true => Ok(nearest[0]),
                    false => Err(format!(
                        "no state has a contact area of {target}: near t = {} the area jumps from {} to {}",
                        nearest[0],
                        back(nearest[1]),
                        back(other[1])
                    )),
                };
            }
            let gained = found - low[1];
            if gained < 0.0 {
                if turned {
                    break;
                }
                (turned, step) = (true, -step);
                continue;
            }
            step *= if gained > 0.0 { (-1.1 * found / gained).clamp(0.5, FARTHER) } else { 2.0 };
            low = [time, found];
        }
        let reached = target + sense * low[1] * self.size[1];
        Err(format!("no state with a contact area of {target} was found: it is {reached} at t = {}", low[0]))
    }

    /// The time at which a state is a length away, or the end of the step if that is nearer.
    fn by_arc_length(&mut self, from: [f64; 2], length: f64, to: f64, area: &mut Area<'_>) -> Result<f64, String> {
        let [whole, membrane] = self.size;
        let end = (from[0] + length * whole).min(to);
        let mut value = |t: f64| area(t).map(|a| ((a - from[1]) / membrane).hypot((t - from[0]) / whole) - length);
        let last = value(end).ok_or_else(|| format!("no state was found at t = {end}"))?;
        if last <= EVEN * length {
            self.done = end >= to;
            return Ok(end);
        }
        let [a, b] = between([[from[0], -length], [end, last]], EVEN * length, SAME * whole, &mut value);
        // Where the area jumps the length is that of the jump.
        Ok(if a[1].abs() <= b[1].abs() && a[0] > from[0] { a[0] } else { b[0] })
    }
}

/// Narrows two places, at which a function has different signs, until it vanishes at one of them, or as far as it tells: by the
/// rule of false position, with the weight of a place that stays halved (Illinois; Dowell & Jarratt, BIT 11, 1971).
fn between(
    [mut a, mut b]: [[f64; 2]; 2],
    exact: f64,
    same: f64,
    value: &mut dyn FnMut(f64) -> Option<f64>,
) -> [[f64; 2]; 2] {
    let (mut weights, mut replaced, mut best, mut idle) = ([1.0, 1.0], 2, f64::INFINITY, 0);
    for _ in 0..MOST_LOOKS {
        let least = a[1].abs().min(b[1].abs());
        idle = if least < 0.5 * best { 0 } else { idle + 1 };
        best = best.min(least);
        if best <= exact || (b[0] - a[0]).abs() <= same || (best <= NEARLY && idle >= 2) {
            break;
        }
        let [fa, fb] = [weights[0] * a[1], weights[1] * b[1]];
        let t = (fb * a[0] - fa * b[0]) / (fb - fa);
        let t = if t.is_finite() { t.clamp(a[0].min(b[0]), a[0].max(b[0])) } else { 0.5 * (a[0] + b[0]) };
        let Some(f) = value(t) else { break };
        let side = usize::from((f < 0.0) != (a[1] < 0.0));
        weights[1 - side] = if replaced == side { 0.5 * weights[1 - side] } else { 1.0 };
        (weights[side], replaced) = (1.0, side);
        if side == 0 { a = [t, f] } else { b = [t, f] }
    }
    [a, b]
}
