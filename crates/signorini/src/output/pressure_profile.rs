//! Pressure along a surface in the plane, from rim to rim of the zones of contact.

use super::chart::label;
use super::colours::{FRONT, RIGID};
use super::labels::Labels;
use super::page::{Page, Sign};
use super::panel::{Axis, Dots, Panel};
use super::system::ContactShown;
use super::system_contacts::Along;
use super::system_scene::titled;
use crate::problem::Space;
use plotters::style::RGBColor;
use signorini_geometry::Vector;
use signorini_mechanics::ShownSurface;

const SIZE: (f64, f64) = (860.0, 520.0);
const LINE: RGBColor = RGBColor(31, 81, 140);
/// Of the colours that those who are blind to red or green tell from the line (Okabe & Ito 2008).
const FRICTION: RGBColor = RGBColor(213, 94, 0);
/// What is seen around the zones, as a part of their extent, and their least extent as a part of the surface.
const AROUND: f64 = 0.4;
const LEAST: f64 = 0.02;
/// Pressures beyond this many times of what is usual in the zone are not drawn.
const SINGULAR: f64 = 4.0;
/// Up to so many nodes are marked.
const FEW: usize = 80;
/// Faces that meet do so to this part of the extent of the zones.
const NEAR: f64 = 1e-6;

/// Points of a chart.
type Curve = Vec<(f64, f64)>;

/// Pressure along a surface, where it is now.
pub fn draw(contact: &ContactShown, surface: &ShownSurface, time: f64, space: Space, labels: &Labels) -> String {
    let along = Along::of(contact, space, labels);
    let profile = Profile::new(contact, surface, &along);
    let most = profile.pressure.iter().fold(0.0f64, |m, p| m.max(*p));
    let pressure = labels.pressure("p");
    // At a sharp edge the pressure has no bound, and would leave nothing to see of the rest.
    let bound = SINGULAR * usual(&profile.zones);
    // What holds surfaces together is a pressure below zero, and bounded.
    let least = profile.pressure.iter().fold(0.0f64, |m, p| m.min(*p));
    let (top, note) = match most > bound && bound > 0.0 && least == 0.0 {
        true => (bound, beyond_the_chart(most, &pressure)),
        false => (most, String::new()),
    };
    let title = titled(&format!("Contact pressure of `{}`", contact.fields.name), time);
    let mut page = Page::new(SIZE, &title, &note);
    let (x, y) = (Axis::new(&along.name, profile.range()), Axis::from_zero(&pressure, (least, top)));
    let mut panel = Panel::new(&mut page.svg, [0.0, 46.0, SIZE.0, SIZE.1 - 4.0], x, y);
    // Nothing is drawn where nothing touches: no contact is not a contact without pressure.
    let mut key = vec![if profile.zones.is_empty() {
        (Sign::Line(RIGID), "no contact".to_string())
    } else {
        (Sign::Line(LINE), "pressure, in contact".to_string())
    }];
    for zone in &profile.zones {
        panel.fill(zone, 0.0, LINE, 0.18);
        panel.line(zone, Sign::Line(LINE), 2.2);
    }
    let nodes: Curve = profile.nodes().into_iter().filter(|p| p.1 <= top).collect();
    if nodes.len() <= FEW {
        panel.dots(&nodes, LINE, 2.6, Dots::Full);
    }
    if let Some([friction, available]) = profile.friction(contact) {
        panel.line(&available, Sign::Dashes(FRICTION), 1.4);
        panel.line(&friction, Sign::Line(FRICTION), 2.0);
        key.push((Sign::Line(FRICTION), "friction traction, magnitude".into()));
        key.push((Sign::Dashes(FRICTION), "friction limit".into()));
    }
    let rims: Curve = surface.boundary.iter().map(|b| (along.place(&b[0]), 0.0)).collect();
    if !rims.is_empty() {
        panel.dots(&rims, FRONT, 4.5, Dots::Full);
        key.push((Sign::Dot(FRONT), "boundary of contact".into()));
    }
    panel.key(&key);
    page.finish()
}

/// What is said of a pressure that the chart does not reach.
fn beyond_the_chart(most: f64, pressure: &str) -> String {
    let unit = 10f64.powf(most.abs().max(f64::MIN_POSITIVE).log10().floor() - 2.0);
    let value = label((most / unit).round() * unit);
    format!("largest {}, beyond the chart", pressure.replacen('p', &value, 1).replace(['[', ']'], ""))
}

/// Nodes of a surface: how far along each is, its pressure, whether it touches; and the zones of contact.
struct Profile {
    places: Vec<f64>,
    pressure: Vec<f64>,
    active: Vec<bool>,
    zones: Vec<Curve>,
}

impl Profile {
    fn new(contact: &ContactShown, surface: &ShownSurface, along: &Along) -> Self {
        let count = contact.fields.points.len();
        let mut out = Profile {
            places: (0..count).map(|k| along.place(&contact.at(k))).collect(),
            pressure: contact.fields.array("contact_pressure").unwrap_or_default().to_vec(),
            active: (0..count).map(|k| contact.is_closed(k)).collect(),
            zones: Vec::new(),
        };
        let pieces = surface.intervals.iter().map(|ends| ends.map(|x| along.place(&x))).filter(|p| along.is_near(p));
        out.zones = zones(&out.nodes(), pieces.map(|[a, b]| [a.min(b), a.max(b)]).collect());
        out
    }

    /// Nodes in contact in order, with their pressure.
    fn nodes(&self) -> Curve {
        self.sorted().into_iter().map(|k| (self.places[k], self.pressure[k])).collect()
    }

    fn sorted(&self) -> Vec<usize> {
        let mut nodes: Vec<usize> = (0..self.places.len()).filter(|&k| self.active[k]).collect();
        nodes.sort_by(|&a, &b| self.places[a].total_cmp(&self.places[b]));
        nodes
    }

    /// Around the contact, nearly half as much again on either side, within the surface.
    fn range(&self) -> (f64, f64) {
        let span = |values: &mut dyn Iterator<Item = f64>| {
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)))
        };
        let all = span(&mut self.places.iter().copied());
        let (low, high) = span(&mut self.zones.iter().flatten().map(|p| p.0));
        if low > high {
            return all;
        }
        let pad = AROUND * (high - low).max(LEAST * (all.1 - all.0));
        ((low - pad).max(all.0), (high + pad).min(all.1))
    }

    /// The size of the friction of nodes in contact, and what is available of it; none without friction.
    fn friction(&self, contact: &ContactShown) -> Option<[Curve; 2]> {
        let traction = contact.fields.array("friction_traction")?;
        let used = contact.fields.array("friction_utilisation")?;
        let size = |k: usize| Vector::<3>::from_column_slice(&traction[3 * k..3 * k + 3]).norm();
        let nodes = self.sorted();
        let friction = nodes.iter().map(|&k| (self.places[k], size(k))).collect();
        let limit = nodes.iter().filter(|&&k| used[k] > 0.0);
        Some([friction, limit.map(|&k| (self.places[k], size(k) / used[k])).collect()])
    }
}

/// The pressure that is not exceeded in nine tenths of the zones.
fn usual(zones: &[Curve]) -> f64 {
    let mut pieces: Vec<(f64, f64)> =
        zones.iter().flat_map(|z| z.windows(2)).map(|w| (0.5 * (w[0].1 + w[1].1), w[1].0 - w[0].0)).collect();
    pieces.sort_by(|a, b| a.0.total_cmp(&b.0));
    let whole: f64 = pieces.iter().map(|p| p.1).sum();
    let mut seen = 0.0;
    let found = pieces.iter().find(|(_, length)| {
        seen += length;
        seen >= 0.9 * whole
    });
    found.map_or(0.0, |p| p.0)
}

/// Place and pressure in every zone of contact, in order, from rim to rim: nodes in contact, and the rims where they are
/// beyond the last of them, to which the pressure goes down. `pieces` are the intervals in contact.
fn zones(nodes: &Curve, mut pieces: Vec<[f64; 2]>) -> Vec<Curve> {
    pieces.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let size = nodes.first().zip(nodes.last()).map_or(0.0, |(a, b)| b.0 - a.0);
    let near = NEAR * pieces.last().map_or(size, |last| (last[1] - pieces[0][0]).max(size));
    let mut joined: Vec<[f64; 2]> = Vec::new();
    for piece in pieces {
        match joined.last_mut() {
            Some(last) if piece[0] <= last[1] + near => last[1] = last[1].max(piece[1]),
            _ => joined.push(piece),
        }
    }
    if joined.is_empty() {
        return if nodes.is_empty() { Vec::new() } else { vec![nodes.clone()] };
    }
    let of_zone = |[from, to]: &[f64; 2]| {
        let within = |p: &&(f64, f64)| p.0 >= from - near && p.0 <= to + near;
        let mut line: Curve = nodes.iter().filter(within).copied().collect();
        if line.first().is_none_or(|p| p.0 > from + near) {
            line.insert(0, (*from, 0.0));
        }
        if line.last().is_none_or(|p| p.0 < to - near) {
            line.push((*to, 0.0));
        }
        line
    };
    joined.iter().map(of_zone).collect()
}
