//! A state of solids as it is drawn, in the plane and in space alike.

use super::OutputError;
use super::camera::Camera;
use super::chart::{label, range, word};
use super::labels::Labels;
use super::page::{Page, Scale, Sign, text_width};
use super::render::{Body, Look, Paint, render};
use super::solid_fields::{ContactDisplay, SolidDisplay, SolidFields};
use crate::plan::solid::{Opposite, SolidPlan};
use crate::problem::Space;
use plotters::style::RGBColor;
use signorini_contact::GapJet;
use signorini_geometry::{Point, Vector};

pub const RIGID: RGBColor = RGBColor(168, 172, 178);
pub const FREE: RGBColor = RGBColor(228, 228, 228);
pub const FRONT: RGBColor = RGBColor(213, 60, 40);
const INK: RGBColor = RGBColor(20, 20, 20);
/// Size of the letters of names.
const NAME: f64 = 17.0;

/// What a frame of a film shows, and a picture of the whole.
#[derive(Clone, Debug, PartialEq)]
pub struct SolidFrame<const D: usize> {
    pub time: f64,
    pub displacement: Vec<Point<D>>,
    pub von_mises: Vec<f64>,
    /// In the plane, where the bodies touch, displaced.
    pub zones: Vec<[Point<D>; 2]>,
}

impl<const D: usize> SolidFrame<D> {
    pub fn new(time: f64, fields: &SolidFields<D>, contacts: &[ContactDisplay<D>]) -> Self {
        SolidFrame {
            time,
            displacement: fields.displacement.clone(),
            von_mises: fields.von_mises.clone(),
            zones: contacts.iter().flat_map(|c| c.intervals.iter().copied()).collect(),
        }
    }

    /// How its stresses become colours.
    pub fn scale(&self) -> Scale {
        Scale::of(&self.von_mises)
    }
}

/// A point as one of space.
pub fn spatial<const D: usize>(x: &Point<D>) -> Vector<3> {
    Vector::<3>::from_fn(|k, _| if k < D { x[k] } else { 0.0 })
}

/// The low and the high corner of points.
pub fn bounds<'a>(points: impl Iterator<Item = &'a Vector<3>>) -> [Vector<3>; 2] {
    let all = [Vector::<3>::repeat(f64::INFINITY), Vector::<3>::repeat(f64::NEG_INFINITY)];
    points.fold(all, |[low, high], x| [low.inf(x), high.sup(x)])
}

/// The distance to a rigid body, negative inside.
pub type Gap = Box<dyn Fn(&Vector<3>) -> GapJet<3> + Sync>;

/// The rigid bodies of a plan at a time, by name, each once.
pub fn tools<const D: usize>(plan: &SolidPlan<D>, time: f64) -> Vec<(String, Gap)> {
    let mut found: Vec<(String, Gap)> = Vec::new();
    for contact in &plan.contacts {
        let Opposite::Rigid(body) = &contact.opposite else { continue };
        if found.iter().all(|(name, _)| *name != body.name)
            && let Ok(gap) = body.gap_at(&plan.head.problem, time)
        {
            found.push((body.name.clone(), Box::new(gap)));
        }
    }
    found
}

/// Everything that the pictures of a state show.
pub struct State<'a, const D: usize> {
    pub plan: &'a SolidPlan<D>,
    pub display: &'a SolidDisplay<D>,
    pub labels: &'a Labels,
    pub scale: Scale,
    pub title: String,
    pub note: String,
    /// Displaced points of the display, and their places on the colour map.
    pub moved: Vec<Vector<3>>,
    pub colours: Vec<f64>,
    pub solids: Vec<Body>,
    pub tools: Vec<(String, Gap)>,
    /// Where the bodies touch, in the plane.
    pub zones: Vec<[Vector<3>; 2]>,
}

impl<'a, const D: usize> State<'a, D> {
    /// A state with its own scale of colours, or with that of a film.
    pub fn new(
        plan: &'a SolidPlan<D>,
        display: &'a SolidDisplay<D>,
        frame: &SolidFrame<D>,
        scale: Option<Scale>,
        labels: &'a Labels,
    ) -> Self {
        let factor = magnification(plan, display, frame);
        let moved: Vec<Vector<3>> =
            display.points.iter().zip(&frame.displacement).map(|(x, u)| spatial(&(x + u * factor))).collect();
        let scale = scale.unwrap_or_else(|| frame.scale());
        let colours: Vec<f64> = frame.von_mises.iter().map(|v| scale.place(*v)).collect();
        let solids = (0..plan.bodies.len())
            .map(|number| {
                let own = display.polygons.iter().filter(|p| display.body[p[0] as usize] as usize == number);
                Body::of_polygons(moved.clone(), own.map(Vec::as_slice), Paint::Field(colours.clone()))
            })
            .collect();
        let what = if scale.is_empty() { "Bodies at rest" } else { "Equivalent stress (von Mises)" };
        State {
            plan,
            display,
            labels,
            title: format!("{what}, t = {}", label(frame.time)),
            note: match (frame.displacement.iter().all(|u| u.amax() == 0.0), factor) {
                (true, _) => String::new(),
                (_, 1.0) => "displacements to scale".into(),
                _ => format!("displacements × {factor}"),
            },
            scale,
            moved,
            colours,
            solids,
            tools: tools(plan, frame.time),
            zones: frame.zones.iter().map(|ends| ends.each_ref().map(spatial)).collect(),
        }
    }

    /// What the axes are called.
    pub fn axis_names(&self) -> [String; 3] {
        axis_names(self.plan.space, self.labels)
    }

    /// Draws bodies and the axes of a box into a page, with the key.
    pub fn draw(
        &self,
        page: &mut Page,
        bodies: &[Body],
        camera: &Camera,
        look: Look,
        frame: [Vector<3>; 2],
    ) -> Result<(), OutputError> {
        insert(&mut page.svg, bodies, camera, look)?;
        camera.axes(&mut page.svg, frame, self.axis_names().each_ref().map(String::as_str));
        page.bar(&self.scale, &self.labels.pressure("σ"));
        let mut key: Vec<(Sign, String)> =
            self.tools.iter().map(|(name, _)| (Sign::Area(RIGID), format!("{name} (rigid)"))).collect();
        if !self.zones.is_empty() {
            key.push((Sign::Line(FRONT), "contact".into()));
        }
        page.key(&key);
        Ok(())
    }

    /// Writes the name of every body in its middle, where there are several.
    pub fn name_bodies(&self, page: &mut Page, camera: &Camera) {
        if self.solids.len() < 2 {
            return;
        }
        let [left, top, right, bottom] = camera.area;
        for (number, body) in self.plan.bodies.iter().enumerate() {
            let own = self.moved.iter().zip(&self.display.body).filter(|(_, b)| **b as usize == number);
            let places: Vec<(f64, f64)> = own.map(|(x, _)| camera.at(x)).collect();
            let (x, y) = (range(places.iter().map(|p| p.0)), range(places.iter().map(|p| p.1)));
            // What of the body is seen, and its name beside it where it is wider.
            let (x, y) = ((x.0.max(left), x.1.min(right)), (y.0.max(top), y.1.min(bottom)));
            if x.0 >= x.1 || y.0 >= y.1 {
                continue;
            }
            let width = text_width(&body.name, NAME);
            let beside = width > x.1 - x.0 && x.1 + width + 16.0 < page.room()[2];
            let middle = if beside { x.1 + 8.0 + 0.5 * width } else { 0.5 * (x.0 + x.1) };
            word(&mut page.svg, (middle, 0.5 * (y.0 + y.1)), &body.name, INK);
        }
    }
}

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

/// A round factor that makes displacements visible, or one.
pub fn magnification<const D: usize>(plan: &SolidPlan<D>, display: &SolidDisplay<D>, frame: &SolidFrame<D>) -> f64 {
    if !plan.contacts.is_empty() {
        // Magnified displacements would push bodies through each other.
        return 1.0;
    }
    let low = display.points.iter().fold(Point::<D>::repeat(f64::INFINITY), |l, x| l.inf(x));
    let high = display.points.iter().fold(Point::<D>::repeat(f64::NEG_INFINITY), |h, x| h.sup(x));
    let largest = frame.displacement.iter().map(|u| u.norm()).fold(0.0, f64::max);
    let wanted = 0.05 * (high - low).norm() / largest.max(f64::MIN_POSITIVE);
    if wanted < 2.0 || !wanted.is_finite() {
        return 1.0;
    }
    let power = 10f64.powf(wanted.log10().floor());
    [5.0, 2.0, 1.0].into_iter().map(|d| d * power).find(|m| *m <= wanted).unwrap_or(1.0)
}
