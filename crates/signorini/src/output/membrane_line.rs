//! Pictures of membranes with one coordinate: the deflection between what it may touch, gap and pressure along it.

use super::chart::{label, range};
use super::labels::Labels;
use super::page::{Page, ROUNDING, Sign};
use super::panel::{Axis, Dots, Panel};
use crate::exact;
use crate::plan::MembranePlan;
use crate::problem::Space;
use crate::snapshot::{DisplayMesh, Snapshot};
use plotters::style::RGBColor;
use signorini_geometry::Point;

const MEMBRANE: RGBColor = RGBColor(31, 81, 140);
const BODY: RGBColor = RGBColor(110, 110, 110);
const FRONT: RGBColor = RGBColor(213, 60, 40);
const EXACT: RGBColor = RGBColor(20, 20, 20);
const SIZE: (f64, f64) = (900.0, 500.0);

/// Points of a line in order, with their values.
fn in_order<const D: usize>(mesh: &DisplayMesh<D>, values: &[f64]) -> Vec<(f64, f64)> {
    let mut points: Vec<(f64, f64)> = mesh.points.iter().zip(values).map(|(p, v)| (p[0], *v)).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points
}

/// The value of a line between its points.
pub fn value_at(line: &[(f64, f64)], x: f64) -> f64 {
    let after = line.partition_point(|p| p.0 < x).clamp(1, line.len().max(2) - 1);
    let (Some(a), Some(b)) = (line.get(after - 1), line.get(after)) else { return 0.0 };
    a.1 + (b.1 - a.1) * ((x - a.0) / (b.0 - a.0).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0)
}

/// What the coordinate is called.
fn coordinate<const D: usize>(plan: &MembranePlan<D>, labels: &Labels) -> String {
    labels.length(if plan.space == Space::Axisymmetric { "r" } else { "x" })
}

/// The range of the membrane and of what it may touch.
pub fn heights<const D: usize>(s: &Snapshot<D>) -> (f64, f64) {
    range(s.displacement.iter().chain(s.floor.iter().flatten()).chain(s.ceiling.iter().flatten()).copied())
}

/// Deflection of a string or of the radius of a round membrane.
pub fn profile<const D: usize>(
    plan: &MembranePlan<D>,
    mesh: &DisplayMesh<D>,
    s: &Snapshot<D>,
    compared: bool,
    labels: &Labels,
    (low, high): (f64, f64),
) -> String {
    let u = in_order(mesh, &s.displacement);
    let x = range(u.iter().map(|p| p.0));
    let mut page = Page::new(SIZE, &format!("Deflection, t = {}", label(s.time)), "");
    let (x_name, y_name) = (coordinate(plan, labels), labels.length("height"));
    let y = Axis::around(&y_name, (low, high));
    let (bottom, top) = y.range;
    let mut panel = Panel::new(&mut page.svg, [0.0, 46.0, SIZE.0, SIZE.1 - 4.0], Axis::new(&x_name, x), y);
    let mut key = vec![(Sign::Line(MEMBRANE), "membrane".to_string())];
    for (heights, base, name) in [(&s.floor, bottom, "body below"), (&s.ceiling, top, "body above")] {
        let Some(heights) = heights else { continue };
        let line = in_order(mesh, heights);
        panel.fill(&line, base, BODY, 0.25);
        panel.line(&line, Sign::Line(BODY), 1.2);
        key.push((Sign::Area(RGBColor(219, 219, 219)), name.into()));
    }
    panel.line(&u, Sign::Line(MEMBRANE), 3.0);
    if let Some(exact) = exact::of(plan, s.time).filter(|_| compared) {
        let middle = if plan.space == Space::Axisymmetric { 0.0 } else { plan.grid.bounds().center()[0] };
        let at = |k: usize| x.0 + (x.1 - x.0) * k as f64 / 40.0;
        let marks: Vec<(f64, f64)> = (0..=40).map(|k| (at(k), exact.displacement(at(k) - middle))).collect();
        panel.dots(&marks, EXACT, 2.6, Dots::Open);
        key.push((Sign::Ring(EXACT), "exact".into()));
    }
    let ends: Vec<(f64, f64)> = ends(plan, s).into_iter().map(|x| (x, value_at(&u, x))).collect();
    if !ends.is_empty() {
        panel.dots(&ends, FRONT, 5.0, Dots::Full);
        key.push((Sign::Dot(FRONT), "end of contact".into()));
    }
    panel.key(&key);
    page.finish()
}

/// Where the contact ends; the axis of a round membrane is no end.
fn ends<const D: usize>(plan: &MembranePlan<D>, s: &Snapshot<D>) -> Vec<f64> {
    let on_axis = |p: &Point<D>| plan.space == Space::Axisymmetric && p[0] <= 0.0;
    s.outlines.iter().flatten().filter(|p| !on_axis(p)).map(|p| p[0]).collect()
}

/// Gap and pressure along a line, one above the other. The pressure is drawn where there is contact, and ends at the fronts.
pub fn gap_and_pressure<const D: usize>(
    plan: &MembranePlan<D>,
    mesh: &DisplayMesh<D>,
    s: &Snapshot<D>,
    labels: &Labels,
) -> String {
    let mut page = Page::new((SIZE.0, 660.0), &format!("Gap and contact pressure, t = {}", label(s.time)), "");
    let x_name = coordinate(plan, labels);
    let ends = ends(plan, s);
    // Gaps below the rounding of the deflection are none.
    let (low, high) = heights(s);
    let floor = ROUNDING * (high - low).max(high.abs()).max(low.abs());
    let gap: Vec<f64> = s.gap.iter().map(|g| if g.abs() < floor { 0.0 } else { *g }).collect();
    let line = in_order(mesh, &gap);
    let x = range(line.iter().map(|p| p.0));
    let name = labels.length("gap");
    let y = Axis::from_zero(&name, range(gap.iter().copied().chain([0.0])));
    let mut panel = Panel::new(&mut page.svg, [0.0, 46.0, SIZE.0, 350.0], Axis::new(&x_name, x), y);
    panel.fill(&line, 0.0, MEMBRANE, 0.15);
    panel.line(&line, Sign::Line(MEMBRANE), 2.2);
    let dots: Vec<(f64, f64)> = ends.iter().map(|x| (*x, 0.0)).collect();
    panel.dots(&dots, FRONT, 4.5, Dots::Full);

    let name = labels.pressure("p");
    let y = Axis::from_zero(&name, range(s.pressure.iter().copied().chain([0.0])));
    let mut panel = Panel::new(&mut page.svg, [0.0, 350.0, SIZE.0, 656.0], Axis::new(&x_name, x), y);
    let touching: Vec<f64> = s.in_contact.iter().map(|c| f64::from(u8::from(*c))).collect();
    let (pressure, touching) = (in_order(mesh, &s.pressure), in_order(mesh, &touching));
    for zone in zones(&pressure, &touching, &ends) {
        panel.fill(&zone, 0.0, MEMBRANE, 0.15);
        panel.line(&zone, Sign::Line(MEMBRANE), 2.2);
    }
    panel.dots(&dots, FRONT, 4.5, Dots::Full);
    let mut key = vec![match touching.iter().any(|t| t.1 > 0.0) {
        true => (Sign::Line(MEMBRANE), "pressure, in contact".to_string()),
        false => (Sign::Line(BODY), "no contact".into()),
    }];
    if !dots.is_empty() {
        key.push((Sign::Dot(FRONT), "end of contact".into()));
    }
    panel.key(&key);
    page.finish()
}

/// The pressure of every zone of contact, carried on to the fronts, where it jumps.
pub fn zones(pressure: &[(f64, f64)], touching: &[(f64, f64)], ends: &[f64]) -> Vec<Vec<(f64, f64)>> {
    let mut zones: Vec<Vec<(f64, f64)>> = Vec::new();
    let (mut zone, mut before): (Vec<(f64, f64)>, f64) = (Vec::new(), f64::NEG_INFINITY);
    // The front between two points, if there is one.
    let front = |a: f64, b: f64| ends.iter().copied().find(|x| *x >= a && *x <= b);
    for (p, t) in pressure.iter().zip(touching) {
        if t.1 > 0.0 {
            if zone.is_empty()
                && let Some(x) = front(before, p.0)
            {
                zone.push((x, p.1));
            }
            zone.push(*p);
        } else if let Some(last) = zone.last().copied() {
            zone.extend(front(last.0, p.0).map(|x| (x, last.1)));
            zones.push(std::mem::take(&mut zone));
        }
        before = p.0;
    }
    zones.extend((!zone.is_empty()).then_some(zone));
    zones
}
