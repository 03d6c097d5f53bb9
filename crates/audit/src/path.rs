//! Whether energy goes where it should: with `W` the work of loads, supports and prescribed motions in an increment, `ΔE` what
//! bodies store more and `D ≥ 0` what friction takes, `W - ΔE - D = 0`.
//!
//! Work is taken by the mean of the forces before and after; it is off by half of what the forces changed, times the motion, at
//! most where they change steadily. What vanishes beyond that was lost in a jump, or the dissipation is told wrongly. Energy
//! that appears makes the state none where nothing moves as prescribed: what does so may push harder on the way than before
//! and after.

use crate::balance::of_contact;
use crate::finding::{Check, Finding, Outcome};
use crate::gaps;
use crate::state::{Form, Setting, State, Touch};
use signorini_geometry::Vector;

/// Part of the energies that rounding, iterations and penalties may leave.
const LEFT: f64 = 1e-2;

/// Part of forces times sizes that is rounding, and of the stored energy what iterations leave.
const ROUNDING: f64 = 1e-9;
const STORED: f64 = 1e-6;
/// Rotation in an increment, in radians, beyond which a rotation the other way round is as likely.
const TURN: f64 = 1.5;
/// Rotations that differ by less, in radians, are the same.
const SAME_TURN: f64 = 1e-6;

/// Checks the energy of an increment.
pub fn check(setting: &Setting, before: &State, now: &State) -> Vec<Finding> {
    let mut out = Vec::new();
    let rounding = ROUNDING * forces(setting, now);
    // What is lost or gained is judged below; here only what matters beside the energy that is exchanged.
    let exchanged: f64 = now.forces.iter().filter_map(|f| f.work).map(|[work, _]| work.abs()).sum();
    let contacts = setting.contacts.iter().zip(&now.dissipated).zip(before.contacts.iter().zip(&now.contacts));
    for ((contact, dissipated), (earlier, touches)) in contacts {
        let Some(d) = *dissipated else { continue };
        let taken: f64 = touches.iter().map(|t| t.weight * t.friction.norm() * t.slip.norm()).sum();
        // In motion friction acts by its mean: where it turns round in the increment, along the slip for a part of it.
        let turned = 0.5 * farthest_slip(touches) * friction_changed(earlier, touches);
        let limit = LEFT * (taken + exchanged) + turned + elastic(touches) + rounding;
        if d < -limit {
            let message = format!("the dissipation of friction in `{}` is negative: -{:.3e}", contact.name, -d);
            // By its mean friction may act along the slip for a part of an increment in which that turns round several times.
            let outcome = if now.in_motion { Outcome::Doubt } else { Outcome::Refused };
            let finding = Finding::new(Check::Path, outcome, message).measured(-d, limit);
            out.push(finding.on(&contact.name).remedy("use smaller increments"));
        }
    }
    let plastic = now.dissipated_in_bodies;
    if plastic < -rounding {
        let message = format!("the dissipation of plastic strain is negative: {plastic:.3e}");
        out.push(Finding::new(Check::Path, Outcome::Refused, message).measured(-plastic, rounding));
    }
    out.extend(of_increment(setting, before, now));
    out
}

/// The sum of the sizes of all forces, times the largest size of a body.
fn forces(setting: &Setting, now: &State) -> f64 {
    let acting: f64 = now.forces.iter().map(|f| f.force.norm()).sum();
    let touching: f64 = now.contacts.iter().flatten().filter(|t| t.is_closed).map(|t| t.force().1.norm()).sum();
    (acting + touching) * setting.bodies.iter().map(|b| b.form.size()).fold(0.0, f64::max)
}

/// Energy that what sticks may store in its penalties, as friction along elastic slips, and as pressure on penetrations.
fn elastic(touches: &[Touch]) -> f64 {
    let of = |t: &Touch| {
        let slip = if t.slips { 0.0 } else { t.slip.norm() };
        t.weight * (t.friction.norm() * slip + (t.pressure.abs() + t.friction.norm()) * (t.x - t.foot).norm())
    };
    touches.iter().filter(|t| t.is_closed).map(of).sum()
}

fn farthest_slip(touches: &[Touch]) -> f64 {
    touches.iter().filter(|t| t.is_closed).map(|t| t.slip.norm()).fold(0.0, f64::max)
}

/// How far the friction of a contact changed, of points that came and went too.
fn friction_changed(before: &[Touch], now: &[Touch]) -> f64 {
    let of = |t: &Touch| t.friction * t.weight;
    if before.len() != now.len() {
        return before.iter().chain(now).map(|t| of(t).norm()).sum();
    }
    before.iter().zip(now).map(|(a, b)| (of(a) - of(b)).norm()).sum()
}

fn of_increment(setting: &Setting, before: &State, now: &State) -> Option<Finding> {
    let stored = now.stored? - before.stored?;
    // Loads that are there from the start act at once on what is elastic: what they give too much goes nowhere.
    let at_once = before.forces.is_empty() && now.stored? != 0.0;
    // And bodies that start a little in each other, to be pressed together, bring the energy of that.
    if at_once && gaps::check(setting, before).iter().any(|f| f.value.is_none_or(|depth| depth > 0.0)) {
        return None;
    }
    let [taken, uncertain] = by_surfaces(setting, before, now)?;
    let dissipated = now.dissipated.iter().flatten().sum::<f64>() + taken + now.dissipated_in_bodies;
    let (mut work, mut off, mut size) = (0.0, 0.0, 0.0);
    let mut add = |[w, o]: [f64; 2]| {
        work += w;
        off += o;
        size += w.abs();
    };
    let mut driven = false;
    for acting in &now.forces {
        add(acting.work?);
        driven |= acting.drives;
    }
    for (body, own) in setting.bodies.iter().enumerate() {
        if let Form::Rigid(rigid) = &own.form
            && !rigid.is_free
        {
            let (own, moves) = of_motion(setting, [before, now], body, &rigid.centre)?;
            add(own);
            driven |= moves;
        }
    }
    let slips = now.contacts.iter().map(|touches| farthest_slip(touches)).fold(0.0, f64::max);
    let changed = |(a, b): (&Vec<Touch>, &Vec<Touch>)| friction_changed(a, b);
    off += 0.5 * slips * before.contacts.iter().zip(&now.contacts).map(changed).sum::<f64>();
    off += uncertain;
    let kept: f64 = [before, now].iter().flat_map(|s| &s.contacts).map(|list| elastic(list)).sum();
    let size = size + stored.abs() + dissipated.abs();
    // What moves as a whole may take the work of forces that are rounding.
    off += setting.bodies.iter().map(|b| b.rounding * b.form.size()).sum::<f64>();
    let limit = off + kept + LEFT * size + STORED * now.stored?.abs() + ROUNDING * forces(setting, now);
    let missing = work - stored - dissipated;
    // What is prescribed from the start moves at once too.
    if at_once && (driven || now.time == before.time) && missing.abs() > limit {
        return None;
    }
    if size == 0.0 || !limit.is_finite() {
        return None;
    }
    let (outcome, what, remedy) = match missing {
        m if m < -limit && driven => (
            Outcome::Doubt,
            "more energy appears than the mean of the forces before and after the increment explains",
            Some("use smaller increments"),
        ),
        m if m < -limit => (Outcome::Refused, "energy appears", Some("use smaller increments")),
        m if m > limit && at_once => return None,
        m if m > limit => (
            Outcome::Doubt,
            "energy is lost that nothing dissipates",
            Some("the state jumps, as what falls or snaps does; otherwise use smaller increments"),
        ),
        _ => (Outcome::Fine, "work, stored energy and dissipation are in balance", None),
    };
    let message = format!(
        "{what}: work {work:.4e}, stored energy {stored:.4e}, dissipation {dissipated:.4e} in the increment, \
         tolerance {limit:.1e}"
    );
    let finding = Finding::new(Check::Path, outcome, message).measured(missing.abs(), limit);
    Some(Finding { remedy: remedy.map(str::to_string), ..finding })
}

/// The work that goes into surfaces that hold each other, give way or wear, and how far it may be off; none where the places of
/// before are others.
fn by_surfaces(setting: &Setting, before: &State, now: &State) -> Option<[f64; 2]> {
    let mut out = [0.0; 2];
    for ((contact, old), new) in setting.contacts.iter().zip(&before.contacts).zip(&now.contacts) {
        if !contact.surfaces.take_work() {
            continue;
        }
        if old.len() != new.len() {
            return None;
        }
        for (a, b) in old.iter().zip(new) {
            // The way between the bodies, which wear lengthens.
            let closed = (a.gap() - a.worn) - (b.gap() - b.worn);
            out[0] += 0.5 * (a.pressure * a.weight + b.pressure * b.weight) * closed;
            out[1] += 0.5 * ((b.pressure * b.weight - a.pressure * a.weight) * closed).abs();
        }
    }
    Some(out)
}

/// The work that the prescribed motion of a rigid body does against its contacts, how far it may be off, and whether it moves.
fn of_motion(setting: &Setting, states: [&State; 2], body: usize, centre: &Vector<3>) -> Option<([f64; 2], bool)> {
    let motions = states.map(|s| s.bodies[body].motion());
    let centres = motions.map(|m| m.point(centre));
    let turn = nalgebra::Rotation3::from_matrix_unchecked(motions[1].rotation * motions[0].rotation.transpose());
    // Whole turns are known where both tell them about one axis.
    let told = motions[1].turn - motions[0].turn;
    let agrees = nalgebra::Rotation3::new(told).angle_to(&turn) < SAME_TURN;
    let (moved, turned) = (centres[1] - centres[0], if agrees { told } else { turn.scaled_axis() });
    if !agrees && turned.norm() > TURN {
        return None;
    }
    let resultants = [0, 1].map(|k| {
        let lists = (0..setting.contacts.len()).map(|c| of_contact(setting, states[k], c, body));
        lists
            .flatten()
            .fold([Vector::<3>::zeros(); 2], |[f, m], (x, force)| [f + force, m + (x - centres[k]).cross(&force)])
    });
    let power = |[f, m]: [Vector<3>; 2]| -(f.dot(&moved) + m.dot(&turned));
    let [first, last] = resultants.map(power);
    let moves = moved.norm() > 0.0 || turned.norm() > 0.0;
    Some(([0.5 * (first + last), 0.5 * (last - first).abs()], moves))
}
