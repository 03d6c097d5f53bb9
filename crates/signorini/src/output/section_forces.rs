//! Charts of what ropes and beams carry along their length.

use super::chart::{label, viridis};
use super::labels::Labels;
use super::page::{Page, Sign};
use super::panel::{Axis, Panel};
use super::system::CurveShown;

const WIDTH: f64 = 900.0;

/// What a curve carries along its length, by the names of the pictures: axial force, and of what bends the rest.
pub fn diagrams(curve: &CurveShown, labels: &Labels, time: f64) -> Vec<(String, String)> {
    let mut out = Vec::new();
    if !curve.forces.is_empty() {
        out.push((
            "axial_force",
            along(curve, axial_forces(curve), ("Axial force", labels.force("axial force")), labels, time),
        ));
    }
    for (file, title, values, axis) in [
        ("bending_moment", "Bending moment", &curve.bending_moments, labels.moment("bending moment")),
        ("shear_force", "Shear force", &curve.shear_forces, labels.force("shear force")),
        ("torque", "Torque", &curve.torques, labels.moment("torque")),
    ] {
        let most = values.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        if most > 0.0 {
            let points = curve.arc.iter().copied().zip(values.iter().copied()).collect();
            out.push((file, along(curve, points, (title, axis), labels, time)));
        }
    }
    out.into_iter().map(|(file, picture)| (format!("{file}_{}", curve.name), picture)).collect()
}

/// The axial force over the length, constant in each piece.
fn axial_forces(curve: &CurveShown) -> Vec<(f64, f64)> {
    (curve.cells.iter().zip(&curve.forces))
        .flat_map(|([a, b], f)| {
            let (a, b) = (curve.arc[*a as usize], curve.arc[*b as usize]);
            // The last cell of a closed curve ends where the first begins.
            if b > a { vec![(a, *f), (b, *f)] } else { Vec::new() }
        })
        .collect()
}

/// Values of a curve over its length.
fn along(
    curve: &CurveShown,
    runs: Vec<(f64, f64)>,
    (title, axis): (&str, String),
    labels: &Labels,
    time: f64,
) -> String {
    let mut page = Page::new((WIDTH, 460.0), &format!("{title} along `{}`, t = {}", curve.name, label(time)), "");
    let range = |of: fn(&(f64, f64)) -> f64| {
        runs.iter().map(of).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)))
    };
    let length = labels.length("length along it");
    let (x, y) = (Axis::around(&length, range(|p| p.0)), Axis::from_zero(&axis, range(|p| p.1)));
    let mut panel = Panel::new(&mut page.svg, [0.0, 46.0, WIDTH, 456.0], x, y);
    panel.line(&runs, Sign::Line(viridis(0.3)), 2.0);
    page.finish()
}
