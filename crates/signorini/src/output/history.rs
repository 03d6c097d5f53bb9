//! What changes along a run: areas and forces of contact over time and over what drives it, and how increments converged.

use super::chart::{label, range, viridis};
use super::labels::Labels;
use super::page::{Page, Sign, escaped};
use super::panel::{Axis, Dots, Panel};
use crate::plan::MembranePlan;
use crate::problem::Space;
use crate::report::{ContactReport, Event, StepReport};
use plotters::style::RGBColor;
use std::fmt::Write as _;

const CURVE: RGBColor = RGBColor(31, 81, 140);
const EVENT: RGBColor = RGBColor(213, 60, 40);
/// Colours of several contacts, told apart by everyone (Okabe and Ito).
pub const SERIES: [RGBColor; 5] =
    [CURVE, RGBColor(230, 159, 0), RGBColor(0, 158, 115), RGBColor(204, 121, 167), RGBColor(86, 180, 233)];
const WIDTH: f64 = 860.0;
/// More changes than this are not listed below a history.
const LISTED: usize = 14;

/// What the size of a contact is called.
fn measure(space: Space, labels: &Labels) -> String {
    match space {
        Space::Line | Space::PlaneStrain | Space::PlaneStress => labels.length("contact length"),
        _ => labels.area("contact area"),
    }
}

/// Area and force over time, with the changes of topology, which are numbered and listed below.
pub fn history(
    steps: &[StepReport],
    events: &[Event],
    contacts: &[&str],
    space: Space,
    force: &dyn Fn(&ContactReport) -> f64,
    labels: &Labels,
) -> String {
    // Changes at one time are one line.
    let mut marks: Vec<(f64, String)> = Vec::new();
    for Event { time, kind, .. } in events {
        let word = kind.words();
        match marks.last_mut() {
            Some((t, words)) if *t == *time => {
                if !words.contains(word) {
                    *words += &format!(", {word}");
                }
            }
            _ => marks.push((*time, word.into())),
        }
    }
    let listed = if marks.len() > LISTED { 0 } else { marks.len() };
    let series = |f: &dyn Fn(&ContactReport) -> f64| -> Vec<Vec<(f64, f64)>> {
        let of = |contact: &&str| {
            let converged = steps.iter().filter(|s| s.converged);
            converged.filter_map(|s| Some((s.time, f(s.contacts.get(*contact)?)))).collect()
        };
        contacts.iter().map(of).collect()
    };
    let parts = [(measure(space, labels), series(&|c| c.area)), (labels.force("contact force"), series(force))];
    let below = 22.0 * listed.div_ceil(2) as f64;
    let mut page = Page::new((WIDTH, 640.0 + below), "Contact along the history", "");
    let (_, end) = range(steps.iter().map(|s| s.time));
    let (start, _) = range(steps.iter().map(|s| s.time).chain([0.0]));
    for (k, (name, curves)) in parts.iter().enumerate() {
        let top = 52.0 + 292.0 * k as f64;
        let y = Axis::from_zero(name, range(curves.iter().flatten().map(|p| p.1).chain([0.0])));
        let mut panel = Panel::new(&mut page.svg, [0.0, top, WIDTH, top + 292.0], Axis::new("t", (start, end)), y);
        for (number, (time, _)) in marks.iter().enumerate() {
            let text = if listed > 0 { (number + 1).to_string() } else { String::new() };
            panel.mark(*time, &text, EVENT);
        }
        let mut key = Vec::new();
        for (k, (points, contact)) in curves.iter().zip(contacts).enumerate() {
            let colour = SERIES[k % SERIES.len()];
            panel.line(points, Sign::Line(colour), 2.0);
            if points.len() <= 80 {
                panel.dots(points, colour, 3.2, Dots::Full);
            }
            key.push((Sign::Line(colour), contact.to_string()));
        }
        if key.len() > 1 {
            panel.key(&key);
        }
    }
    for (number, (time, words)) in marks.iter().take(listed).enumerate() {
        let (x, y) = (92.0 + (number % 2) as f64 * 370.0, 652.0 + 22.0 * (number / 2) as f64);
        let _ = write!(
            page.svg,
            "<text x=\"{x}\" y=\"{y}\" font-family=\"{}\" font-size=\"13\" fill=\"rgb(213,60,40)\">{}  t = {}: {}</text>",
            super::chart::FONT,
            number + 1,
            label(*time),
            escaped(words)
        );
    }
    page.finish()
}

/// What drives a membrane along its history: the resultant of the loads, or the height of a body.
pub struct Drive<'a> {
    at: Box<dyn Fn(f64) -> f64 + Sync + 'a>,
    label: String,
}

impl<'a> Drive<'a> {
    /// The first of the two that changes.
    pub fn of<const D: usize>(plan: &'a MembranePlan<D>, steps: &[StepReport], labels: &Labels) -> Option<Self> {
        let load = move |t: f64| -plan.load_resultants(&plan.at(t), t).values().sum::<f64>();
        let moving = plan.contacts.iter().find(|c| !c.displacement.is_empty());
        let height = move |t: f64| moving.map_or(0.0, |c| c.displacement_at(t)[2]);
        let changes = |f: &dyn Fn(f64) -> f64| {
            let times = steps.iter().map(|s| s.time);
            let (low, high) = times.map(f).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
            high - low > 1e-12 * high.abs().max(low.abs())
        };
        if changes(&load) {
            Some(Self { at: Box::new(load), label: labels.force("load, downwards") })
        } else if changes(&height) {
            let body = moving.map_or("", |c| c.body.as_str());
            Some(Self { at: Box::new(height), label: labels.length(&format!("displacement of {body}")) })
        } else {
            None
        }
    }
}

/// Area and force over what drives the membrane, and without adhesion too: stable states filled, unstable ones open, jumps
/// as arrows.
pub fn loop_of_states(
    drive: &Drive,
    steps: &[StepReport],
    events: &[Event],
    contact: &str,
    space: Space,
    labels: &Labels,
) -> String {
    type Reading = fn(&ContactReport) -> f64;
    let readings: [(Reading, fn(&Event) -> [f64; 2], String); 2] = [
        (|c| c.area, |e| [e.area_before, e.area_after], measure(space, labels)),
        (|c| c.force[2], |e| [e.force_before, e.force_after], labels.force("contact force")),
    ];
    let jumps: Vec<&Event> = events.iter().filter(|e| e.energy_released.is_some_and(|v| v != 0.0)).collect();
    let mut page = Page::new((WIDTH, 720.0), "Contact over load or displacement", "");
    for (k, (read, ends, y)) in readings.iter().enumerate() {
        let states: Vec<(f64, f64, bool, f64)> = steps
            .iter()
            .filter_map(|s| {
                let c = s.contacts.get(contact)?;
                Some(((drive.at)(s.time), read(c), c.stable != Some(false), s.time))
            })
            .collect();
        let arrows: Vec<[(f64, f64); 2]> = jumps.iter().map(|e| ends(e).map(|v| ((drive.at)(e.time), v))).collect();
        let all = || states.iter().map(|s| (s.0, s.1)).chain(arrows.iter().flatten().copied());
        let x = Axis::around(&drive.label, range(all().map(|p| p.0)));
        let y = Axis::around(y, range(all().map(|p| p.1).chain([0.0])));
        let top = 46.0 + 334.0 * k as f64;
        let mut panel = Panel::new(&mut page.svg, [0.0, top, WIDTH, top + 334.0], x, y);
        // Between two states the path is a line, broken where it jumps.
        let mut run: Vec<(f64, f64)> = states.first().map(|s| (s.0, s.1)).into_iter().collect();
        for pair in states.windows(2) {
            let (a, b) = (&pair[0], &pair[1]);
            for (event, [before, after]) in jumps.iter().zip(&arrows) {
                if a.3 < event.time && event.time < b.3 {
                    run.push(*before);
                    panel.line(&run, Sign::Line(CURVE), 2.0);
                    run = vec![*after];
                }
            }
            run.push((b.0, b.1));
        }
        panel.line(&run, Sign::Line(CURVE), 2.0);
        arrows.iter().for_each(|[before, after]| panel.arrow(*before, *after, EVENT));
        let dots = |stable: bool| states.iter().filter(|s| s.2 == stable).map(|s| (s.0, s.1)).collect::<Vec<_>>();
        panel.dots(&dots(true), CURVE, 3.2, Dots::Full);
        panel.dots(&dots(false), CURVE, 3.2, Dots::Open);
        let mut key = vec![(Sign::Dot(CURVE), "stable".to_string())];
        if !dots(false).is_empty() {
            key.push((Sign::Ring(CURVE), "unstable".into()));
        }
        if !arrows.is_empty() {
            key.push((Sign::Line(EVENT), "jump".into()));
        }
        if key.len() > 1 {
            panel.key(&key);
        }
    }
    page.finish()
}

/// Residuals of all increments, relative to the tolerance.
pub fn convergence(steps: &[StepReport]) -> String {
    let of_step = |s: &StepReport| -> Vec<(f64, f64)> {
        let list = s.residual_history.iter().enumerate();
        list.filter(|(_, v)| **v > 0.0).map(|(i, v)| (i as f64 + 1.0, *v)).collect()
    };
    let solved = steps.iter().filter(|s| !s.residual_history.is_empty());
    let histories: Vec<(f64, Vec<(f64, f64)>)> = solved.map(|s| (s.time, of_step(s))).collect();
    let all = || histories.iter().flat_map(|h| &h.1);
    let longest = all().map(|p| p.0).fold(2.0, f64::max);
    let (low, high) = all().map(|p| p.1).fold((0.1f64, 10.0f64), |(l, h), v| (l.min(v), h.max(v)));
    let mut page = Page::new((WIDTH, 480.0), "Convergence of the contact front", "");
    let x = Axis::new("equilibrium solve", (0.8, longest + 0.2));
    let y = Axis { log: true, ..Axis::new("residual / tolerance", (0.4 * low, 2.5 * high)) };
    let mut panel = Panel::new(&mut page.svg, [0.0, 46.0, WIDTH, 476.0], x, y);
    panel.line(&[(0.8, 1.0), (longest + 0.2, 1.0)], Sign::Dashes(EVENT), 2.0);
    let count = histories.len();
    let colour = |i: usize| viridis(0.85 * i as f64 / (count.max(2) - 1) as f64);
    for (i, (_, history)) in histories.iter().enumerate() {
        panel.line(history, Sign::Line(colour(i)), 1.6);
        panel.dots(history, colour(i), 3.0, Dots::Full);
    }
    let mut key = vec![(Sign::Dashes(EVENT), "tolerance".to_string())];
    // The first, the last, and what is between them.
    let mut told: Vec<usize> =
        if count <= 5 { (0..count).collect() } else { (0..5).map(|k| k * (count - 1) / 4).collect() };
    told.dedup();
    key.extend(told.into_iter().map(|i| (Sign::Line(colour(i)), format!("t = {}", label(histories[i].0)))));
    panel.key(&key);
    page.finish()
}
