//! Nothing passes through: how far a way between two states may be followed.
//!
//! Newton's method knows a body by its nearest point only. A site that a step takes from one side of it to the other meets
//! the far side, and is told to go on. Every step is therefore followed no farther than until something has entered a body
//! and come half the way to where the nearest point would be one of another side: there the contact is closed, and pushes
//! back to where the site came from. So are the motions of bodies that are prescribed between two increments.
//!
//! A site goes through if, inside the body, the normal has turned by a right angle since it entered. Where it enters is
//! found by steps as long as the gap, which can miss nothing (sphere tracing, Hart 1996), and inside by steps as long as
//! the depth.

pub use crate::interaction::StatePath;

use crate::body::{Body, BodyState};
use crate::contact::Contact;
use crate::met;
use crate::part::Part;
use crate::points::Master;
use crate::rigid_body::Pose;
use crate::rotation;
use crate::system::{AssemblyError, System, SystemState};
use signorini_geometry::{Point, Vector};
use std::cell::OnceCell;

impl System {
    /// The share of a way between two states that may be followed: 1 where nothing passes through on it.
    pub(crate) fn free_way(&self, from: &SystemState, to: &SystemState) -> Result<f64, AssemblyError> {
        self.first_passage(from, to).map(|found| found.map_or(1.0, |(_, share)| share))
    }

    /// The contact through which something passes first on a way between two states, and the share of it until then.
    pub(crate) fn first_passage(
        &self,
        from: &SystemState,
        to: &SystemState,
    ) -> Result<Option<(usize, f64)>, AssemblyError> {
        let (first, _) = self.numbering();
        let path = StatePath { from: self.bodies_in(from, &first), to: self.bodies_in(to, &first) };
        let mut least = None;
        for (k, contact) in self.contacts.iter().enumerate() {
            let share = contact.free_way(path)?;
            if share < least.map_or(1.0, |(_, s)| s) {
                least = Some((k, share));
            }
        }
        Ok(least)
    }
}

/// Gap of a site, and the normal outward from what it meets.
type Meeting = (f64, Vector<3>);

/// Halvings of an interval in which the normal turns.
const HALVINGS: usize = 30;
/// The first and the longest steps along a surface, where the gap tells none, as parts of the distance of sites: the first
/// ones double, so that thin bodies are seen where a way begins on them.
const FIRST_STEP: f64 = 1.0 / 1024.0;
const LONGEST_STEP: f64 = 0.25;
/// Steps after which the rest of a way is left for the next one.
const MOST_STEPS: usize = 400;

fn meeting(master: &dyn Master, x: &Point<3>, radius: f64) -> Option<Meeting> {
    let (gap, normal) = master.nearest(x, f64::INFINITY, None)?.gap(x)?;
    Some((gap - radius, normal))
}

/// What a point of a surface with an outward normal meets: beside an edge the face that it looks at.
fn looked_at(master: &dyn Master, x: &Point<3>, outward: Vector<3>, spacing: f64) -> Option<Meeting> {
    let nearest = master.nearest(x, f64::INFINITY, None)?;
    met::looked_at(master, (x, Some(outward)), &nearest, spacing).unwrap_or(nearest).gap(x)
}

/// A deformable master on a way: a surface that moves is costly to search, so it is known at a few stages, no farther apart
/// than a quarter of what the sites see.
struct Stages {
    states: Vec<BodyState>,
}

/// The masters of the stages that were asked for.
type MasterStages<'a> = Vec<OnceCell<Option<Box<dyn Master + 'a>>>>;

/// The most stages beside the first.
const MOST_STAGES: f64 = 16.0;

impl Stages {
    fn new(path: StatePath<'_>, master: usize, longest: f64, spacings: impl Iterator<Item = f64>) -> Self {
        if path.from.bodies[master].is_rigid() || !path.moves(master) {
            return Stages { states: Vec::new() };
        }
        let finest = LONGEST_STEP * spacings.fold(f64::INFINITY, f64::min);
        let count = (longest / finest).ceil().clamp(1.0, MOST_STAGES);
        Stages { states: (0..=count as usize).map(|k| path.at(master, k as f64 / count)).collect() }
    }

    /// The master at the stage nearest to a share of the way.
    fn at<'a, 'b>(
        &'a self,
        (body, on): (&'a dyn Body, Option<&'a str>),
        known: &'b MasterStages<'a>,
        share: f64,
    ) -> Option<&'b (dyn Master + 'a)> {
        let k = (share * (self.states.len() - 1) as f64).round() as usize;
        known[k].get_or_init(|| body.master(on, &self.states[k]).ok()).as_deref()
    }
}

/// The share of a way on which no point of a slave passes through its master; `outward` tells the normals of points of surfaces at
/// the start of the way.
pub(crate) fn share_of_way(
    parts: [&Part; 2],
    (tested, outward): (Vec<TrackedPoint>, impl Fn(usize) -> Option<Vector<3>>),
    path: StatePath<'_>,
) -> f64 {
    let [slave, master] = [parts[0].body, parts[1].body];
    let bodies = path.from.bodies;
    let is_rigid = bodies[master].is_rigid();
    if slave == master || !(path.moves(slave) || path.moves(master)) {
        return 1.0;
    }
    let on = parts[1].group.as_deref();
    let ends = [0, 1].map(|k| if k == 0 { path.from } else { path.to });
    let masters = [ends[0], ends[1]].map(|end| bodies[master].master(on, &end.states[master]));
    let [Ok(first), Ok(last)] = &masters else { return 1.0 };
    let of_master = longest(bodies[master].as_ref(), path, master);
    let stages = Stages::new(path, master, of_master, tested.iter().map(|point| point.spacing));
    let known: MasterStages<'_> = stages.states.iter().map(|_| OnceCell::new()).collect();
    let mut share = 1.0f64;
    for (number, point) in tested.into_iter().enumerate() {
        let TrackedPoint { from, to, radius, is_surface, spacing } = point;
        let length = (to - from).norm() + of_master;
        // Surfaces of two solids see each other only where they face each other.
        if (is_surface && !is_rigid) || !length.is_finite() {
            continue;
        }
        let Some(start) = meeting(first.as_ref(), &from, radius) else { continue };
        if length <= start.0 {
            continue;
        }
        let is_short = length <= spacing.max(radius);
        if is_short && meeting(last.as_ref(), &to, radius).is_none_or(|end| end.1.dot(&start.1) > 0.0) {
            continue;
        }
        let outward = if is_surface { outward(number) } else { None };
        let met = |t: f64| -> Option<Meeting> {
            let x = from + (to - from) * t;
            let with = |master: &dyn Master| match outward {
                Some(outward) => looked_at(master, &x, outward, spacing),
                None => meeting(master, &x, radius),
            };
            if !path.moves(master) {
                return with(first.as_ref());
            }
            if is_rigid {
                let state = path.at(master, t);
                return with(bodies[master].master(on, &state).ok()?.as_ref());
            }
            meeting(stages.at((bodies[master].as_ref(), on), &known, t)?, &x, radius)
        };
        share = share.min(passage(&met, start, length, spacing).unwrap_or(1.0));
    }
    share
}

impl Contact {
    /// The share of a way on which no site passes through the master.
    pub(crate) fn share_of_way(&self, path: StatePath<'_>) -> f64 {
        if !(path.moves(self.slave.body) || path.moves(self.master.body)) {
            return 1.0;
        }
        let (body, state) = path.from.side(&self.slave);
        let outward = |k: usize| self.sites().get(k).and_then(|site| body.placed(state, site).outward);
        share_of_way([&self.slave, &self.master], (self.tested(path), outward), path)
    }

    /// The points of the slave that are followed: its sites, and on a curve that is stretched on the way as many between
    /// them that they are no farther apart than the sites were.
    fn tested(&self, path: StatePath<'_>) -> Vec<TrackedPoint> {
        let slave = self.slave.body;
        let body = &path.from.bodies[slave];
        let is_curve = body.curve(self.slave.group.as_deref()).is_some();
        let count = self.sites().len() as f64;
        let mut out: Vec<TrackedPoint> = Vec::new();
        for site in self.sites() {
            let ends = [path.from, path.to].map(|end| &end.states[slave]);
            let (from, to, radius, is_surface) = match ends.map(|end| body.position(end, site)) {
                [Some(from), Some(to)] => (from, to, 0.0, true),
                _ => {
                    let [a, b] = ends.map(|end| body.placed(end, site));
                    if a.rests || b.rests {
                        continue;
                    }
                    (a.x, b.x, a.radius, a.outward.is_some())
                }
            };
            // What is smaller than the distance of sites is not seen at rest either.
            let spacing = body.size() / if is_surface { count.sqrt() } else { count };
            let point = TrackedPoint { from, to, radius, is_surface, spacing };
            if let (Some(before), true) = (out.last().copied(), is_curve) {
                let [apart, then] = [point.from - before.from, point.to - before.to].map(|d| d.norm());
                let more = (then / apart.max(spacing)).min(MOST_BETWEEN);
                let more = if more.is_finite() { more.ceil() as usize } else { 0 };
                out.extend((1..more).map(|k| {
                    let s = k as f64 / more as f64;
                    let between = |p: Point<3>, q: Point<3>| p + (q - p) * s;
                    TrackedPoint { from: between(before.from, point.from), to: between(before.to, point.to), ..point }
                }));
            }
            out.push(point);
        }
        out
    }
}

/// A point that is followed.
#[derive(Clone, Copy)]
pub(crate) struct TrackedPoint {
    pub from: Point<3>,
    pub to: Point<3>,
    pub radius: f64,
    /// Whether it is one of a surface.
    pub is_surface: bool,
    /// Distance of such points.
    pub spacing: f64,
}

/// Points between two sites of a curve: a step that stretches it more is none that is followed far.
const MOST_BETWEEN: f64 = 100.0;

/// No point of a body goes farther than this on a way.
fn longest(body: &dyn Body, path: StatePath<'_>, number: usize) -> f64 {
    let [from, to] = [path.from, path.to].map(|end| &end.states[number]);
    if body.is_rigid() {
        let [from, to] = [from, to].map(Pose::of);
        return (to.centre - from.centre).norm() + body.size() * rotation::between(&from.turn, &to.turn).norm();
    }
    let change = from.configuration.iter().zip(&to.configuration).map(|(a, b)| (b - a).powi(2));
    change.sum::<f64>().sqrt()
}

/// The place on a way of a given length from which a site would be pushed on to another side: half way from where it enters
/// to where the normal has turned; none where it never is.
fn passage(met: &dyn Fn(f64) -> Option<Meeting>, start: Meeting, length: f64, spacing: f64) -> Option<f64> {
    let (mut t, mut now) = (0.0, start);
    let mut least = FIRST_STEP * spacing;
    let mut entered = (start.0 < 0.0).then_some((0.0, start.1));
    for _ in 0..MOST_STEPS {
        if t >= 1.0 {
            return None;
        }
        let clear = now.0.abs();
        let next = (t + clear.max(least) / length).min(1.0);
        least = if clear < least { (2.0 * least).min(LONGEST_STEP * spacing) } else { FIRST_STEP * spacing };
        let then = met(next)?;
        if then.0 < 0.0 {
            let (place, normal) = *entered.get_or_insert((t, if now.0 < 0.0 { then.1 } else { now.1 }));
            if let Some(turned) = turn(met, (then.1, normal), [t, next]) {
                return Some(0.5 * (place + turned));
            }
        } else if now.0 < 0.0 {
            let (place, normal) = entered.take()?;
            if let Some(turned) = turn(met, (then.1, normal), [t, next]) {
                return Some(0.5 * (place + turned));
            }
        }
        (t, now) = (next, then);
    }
    Some(t)
}

/// Where between two places the normal has turned by a right angle, if it has at the second, and still inside: what leaves
/// over the end of a surface is outside at once.
fn turn(
    met: &dyn Fn(f64) -> Option<Meeting>,
    (then, normal): (Vector<3>, Vector<3>),
    [mut low, mut high]: [f64; 2],
) -> Option<f64> {
    if then.dot(&normal) > 0.0 {
        return None;
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        match met(middle) {
            Some((_, n)) if n.dot(&normal) > 0.0 => low = middle,
            _ => high = middle,
        }
    }
    met(high).is_none_or(|(gap, _)| gap < 0.0).then_some(low)
}
