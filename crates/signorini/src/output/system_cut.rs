//! Solids in space, cut through the largest pressure.

use super::OutputError;
use super::camera::bounds;
use super::chart::{label, rounded};
use super::labels::Labels;
use super::level::level;
use super::render::{Body, Paint, insert};
use super::system::{SystemShown, moved};
use super::system_bodies::{rigid, solids, tetrahedra};
use super::system_names;
use super::system_scene::{View, bar, page_for, rigid_key, titled, width_for};
use crate::fields::Fields;
use crate::plan::mechanics::MechanicsPlan;
use crate::problem::Space;
use signorini_geometry::Vector;

/// How much a rigid body hides of what is behind it.
const OPAQUE: f64 = 0.95;

/// A plane across an axis, and the side of it that is kept.
struct Plane {
    axis: usize,
    place: f64,
    side: f64,
}

impl Plane {
    /// Through the largest pressure, along the normal of the contact there and a coordinate axis; none where nothing touches.
    fn of(shown: &SystemShown) -> Option<Self> {
        let mut best: Option<(f64, Vector<3>, Vector<3>)> = None;
        for contact in &shown.contacts {
            let pressure = contact.fields.array("contact_pressure").unwrap_or_default();
            for (k, p) in pressure.iter().enumerate().filter(|(_, p)| **p > 0.0) {
                // The first of those that are equal but for rounding.
                if best.as_ref().is_none_or(|b| *p > b.0 * (1.0 + 1e-6)) {
                    best = Some((*p, contact.at(k), contact.outward()));
                }
            }
        }
        let (_, x, normal) = best?;
        // Across the axis that is not that of the contact, the second horizontal one rather than the first.
        let axis = [1, 0, 2].into_iter().find(|&k| k != normal.iamax())?;
        let [low, high] = shown.bounds();
        let side = if high[axis] - x[axis] >= x[axis] - low[axis] { 1.0 } else { -1.0 };
        Some(Plane { axis, place: x[axis], side })
    }

    /// How far a point is on the side that is kept.
    fn height(&self, x: &Vector<3>) -> f64 {
        self.side * (x[self.axis] - self.place)
    }

    /// The direction to the side that is left out.
    fn outwards(&self) -> Vector<3> {
        let mut out = Vector::<3>::zeros();
        out[self.axis] = -self.side;
        out
    }

    /// What of a solid lies in the plane, coloured by its stress.
    fn section(&self, fields: &Fields, view: &View) -> Body {
        let (points, stress) = (moved(fields), fields.array("von_mises").unwrap_or_default());
        let (edges, triangles) = level(tetrahedra(fields), |k| self.height(&points[k as usize]));
        let between = |&(a, b, t): &(u32, u32, f64)| points[a as usize] * (1.0 - t) + points[b as usize] * t;
        let colour = |&(a, b, t): &(u32, u32, f64)| {
            let [a, b] = [a, b].map(|k| view.scale.place(stress.get(k as usize).copied().unwrap_or(0.0)));
            a * (1.0 - t) + b * t
        };
        Body {
            points: edges.iter().map(between).collect(),
            normals: vec![[self.outwards(); 3]; triangles.len()],
            triangles,
            paint: Paint::Field(edges.iter().map(colour).collect()),
            opacity: 1.0,
        }
    }

    /// From where it is seen: a little from aside and from above.
    fn seen_from(&self) -> Vector<3> {
        let mut towards = self.outwards();
        towards[usize::from(self.axis == 0)] += 0.45;
        towards.z += 0.35;
        towards
    }
}

/// The half of everything behind a plane through the largest pressure; none where solids touch nothing.
///
/// # Errors
/// A page without area.
pub fn cut(plan: &MechanicsPlan, shown: &SystemShown, view: &View) -> Result<Option<String>, OutputError> {
    let Some(plane) = Plane::of(shown).filter(|_| plan.space == Space::ThreeD && shown.is_of_solids()) else {
        return Ok(None);
    };
    let labels = Labels(plan.head.unit_names());
    let behind = |body: &Body| body.clipped(|x, _| plane.height(x));
    let mut bodies: Vec<Body> = solids(shown, &view.scale).iter().map(behind).collect();
    bodies.extend(shown.solids().map(|fields| plane.section(fields, view)));
    let kept: Vec<Vector<3>> = bodies.iter().flat_map(Body::seen).copied().collect();
    let sheets = rigid(shown, view.room).into_iter().map(|body| Body { opacity: OPAQUE, ..behind(&body) });
    bodies.extend(sheets);
    let [low, high] = shown.bounds();
    let at = label(rounded(plane.place, high[plane.axis] - low[plane.axis]));
    let title = format!("{}, cut at {} = {at}", titled(&view.what, shown.time), ["x", "y", "z"][plane.axis]);
    let points: Vec<Vector<3>> = bodies.iter().flat_map(Body::seen).copied().collect();
    let directions = [&plane.seen_from(), &Vector::<3>::z()];
    let (mut page, camera) = page_for(directions, points.iter(), [&title, &view.note], width_for(&title));
    insert(&mut page.svg, &bodies, &camera, view.look)?;
    camera.axes(&mut page.svg, bounds(kept.iter()), labels.axes(plan.space).each_ref().map(String::as_str));
    page.key(&rigid_key(shown));
    system_names::write(&mut page, shown, &camera);
    bar(&mut page, shown, &view.scale, &labels);
    Ok(Some(page.finish()))
}
