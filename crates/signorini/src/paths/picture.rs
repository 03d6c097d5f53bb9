//! Bodies and paths in space: the path coloured by its normal force, with arrows of that force, and red where it slips or
//! bridges.

use super::PathCase;
use super::output::Line;
use crate::output::camera::Camera;
use crate::output::chart::{save, viridis};
use crate::output::level;
use crate::output::page::{Page, css};
use crate::output::render::{Body, Look, Paint, render};
use crate::output::{Folder, OutputError};
use crate::scene::picture::rod;
use plotters::style::RGBColor;
use signorini_contact::GapJet;
use signorini_geometry::Vector;
use std::fmt::Write as _;

const SIZE: (f64, f64) = (900.0, 620.0);
const AREA: [f64; 4] = [40.0, 60.0, 860.0, 560.0];
const BODIES: [RGBColor; 3] = [RGBColor(158, 182, 214), RGBColor(226, 196, 146), RGBColor(170, 205, 170)];
const IN_THE_AIR: RGBColor = RGBColor(70, 70, 70);
const SLIPS: RGBColor = RGBColor(213, 30, 30);
/// Half the width of a path on the page, and the length of the largest arrow.
const THICK: f64 = 1.8;
const ARROW: f64 = 46.0;
/// Points of a path per arrow.
const EVERY: usize = 3;
/// From where it is seen where no camera is stated.
const FROM: [f64; 3] = [1.0, -1.6, 0.9];

/// The surface of a body in a box.
pub struct Surface {
    pub points: Vec<Vector<3>>,
    pub normals: Vec<Vector<3>>,
    pub triangles: Vec<[u32; 3]>,
}

impl Surface {
    pub fn new(gap: &(dyn Fn(&Vector<3>) -> GapJet<3> + Sync), corners: [Vector<3>; 2]) -> Self {
        let (points, normals, triangles) = level::surface(gap, corners);
        Surface { points, normals, triangles }
    }
}

/// Draws paths over bodies into a folder.
pub fn draw(case: &PathCase, surfaces: &[Surface], lines: &[Line], folder: &Folder) -> Result<(), OutputError> {
    let (from, up) = case.statement.camera.map_or((FROM, [0.0, 0.0, 1.0]), |c| (c.from, c.up));
    let seen = surfaces.iter().flat_map(|s| &s.points).chain(lines.iter().flat_map(|l| l.points.iter().map(|p| &p.x)));
    let camera = Camera::new(&Vector::<3>::from(from), &Vector::<3>::from(up), seen, AREA);
    let mut bodies: Vec<Body> = Vec::new();
    for (k, surface) in surfaces.iter().enumerate() {
        let mut body = Body::empty(Paint::Plain(BODIES[k % BODIES.len()]));
        body.points.clone_from(&surface.points);
        body.triangles.clone_from(&surface.triangles);
        body.normals = surface.triangles.iter().map(|t| t.map(|v| surface.normals[v as usize])).collect();
        bodies.push(body);
    }
    let largest = lines.iter().flat_map(|l| &l.points).map(|p| p.normal_force).fold(0.0, f64::max);
    let radius = THICK / camera.scale;
    for line in lines {
        for w in line.points.windows(2) {
            let touches = w[0].body >= 0 && w[0].body == w[1].body;
            let colour = match (touches, w[0].utilisation.max(w[1].utilisation) > 1.0) {
                (false, _) => IN_THE_AIR,
                (true, true) => SLIPS,
                (true, false) => {
                    viridis(0.5 * (w[0].normal_force + w[1].normal_force) / largest.max(f64::MIN_POSITIVE))
                }
            };
            let mut piece = Body::empty(Paint::Plain(colour));
            rod(&mut piece, [w[0].x, w[1].x], radius, &camera.towards);
            bodies.push(piece);
        }
    }
    bodies.retain(|b| !b.triangles.is_empty());
    let mut page =
        Page::new(SIZE, case.name(), "path coloured by its normal force per length; red where it slips or bridges");
    let [left, top, right, bottom] = camera.area;
    render(&bodies, &camera, Look::Solid)?.insert(&mut page.svg, (left, right), (top, bottom))?;
    for p in lines.iter().flat_map(|l| l.points.iter().step_by(EVERY)).filter(|p| p.body >= 0 && p.normal_force > 0.0) {
        // Only on the side that is seen.
        if p.frame[2].dot(&camera.towards) <= 0.0 {
            continue;
        }
        let length = ARROW / camera.scale * p.normal_force / largest;
        let ((x1, y1), (x2, y2)) = (camera.at(&p.x), camera.at(&(p.x + p.frame[2] * length)));
        let colour = css(viridis(p.normal_force / largest));
        let _ = write!(
            page.svg,
            "<line x1=\"{x1:.2}\" y1=\"{y1:.2}\" x2=\"{x2:.2}\" y2=\"{y2:.2}\" stroke=\"{colour}\" stroke-width=\"1.1\"/>\
             <circle cx=\"{x2:.2}\" cy=\"{y2:.2}\" r=\"1.8\" fill=\"{colour}\"/>"
        );
    }
    save(folder, "paths", &page.finish())
}
