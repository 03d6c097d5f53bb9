//! Colours, axes and frames of pictures of bodies.

use super::OutputError;
use super::camera::Camera;
use super::labels::Labels;
use super::render::{Body, Look, render};
use crate::problem::Space;
use plotters::style::RGBColor;
use signorini_contact::GapJet;
use signorini_geometry::Vector;

pub const RIGID: RGBColor = RGBColor(168, 172, 178);
pub const FREE: RGBColor = RGBColor(228, 228, 228);
pub const FRONT: RGBColor = RGBColor(213, 60, 40);

/// The low and the high corner of points.
pub fn bounds<'a>(points: impl Iterator<Item = &'a Vector<3>>) -> [Vector<3>; 2] {
    let all = [Vector::<3>::repeat(f64::INFINITY), Vector::<3>::repeat(f64::NEG_INFINITY)];
    points.fold(all, |[low, high], x| [low.inf(x), high.sup(x)])
}

/// The distance to a rigid body, negative inside.
pub type Gap = Box<dyn Fn(&Vector<3>) -> GapJet<3> + Sync>;

/// What the axes are called.
pub fn axis_names(space: Space, labels: &Labels) -> [String; 3] {
    let first = if space == Space::Axisymmetric { "r" } else { "x" };
    [first, "y", "z"].map(|name| labels.length(name))
}

/// Puts the raster of bodies into a page.
pub fn insert(out: &mut String, bodies: &[Body], camera: &Camera, look: Look) -> Result<(), OutputError> {
    let [left, top, right, bottom] = camera.area;
    render(bodies, camera, look)?.insert(out, (left, right), (top, bottom))
}
