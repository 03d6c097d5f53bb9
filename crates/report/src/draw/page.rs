//! States as pages: the raster of the bodies, lines on top, axes, the bar of colours.

use super::bodies::State;
use super::wanted::wrong;
use crate::error::ReportError;
use rayon::prelude::*;
use signorini::output::OutputError;
use signorini::output::camera::{Camera, bounds, corners};
use signorini::output::chart::label;
use signorini::output::colours::{EDGE, FRONT, RIGID};
use signorini::output::page::{MARGIN, Page, Scale, Sign, clip_to, css, text_width};
use signorini::output::render::{Body, Look, Paint, render_finer};
use signorini_geometry::Vector;
use std::fmt::Write as _;

/// Size of the letters of titles.
const TITLE: f64 = 19.0;
/// The area of a page whose size is chosen, in its own units: that of pages whose size nothing says. Letters keep their part
/// of it.
const AREA: f64 = 900.0 * 620.0;
/// Pixels per unit of a page whose size nothing says.
const PIXELS: f64 = 1.25;
/// Bodies that deform are in front of those that are rigid, by this part of the picture.
const LIFT: f64 = 1e-3;
/// Length and half the width of the tip of an arrow.
const TIP: [f64; 2] = [9.0, 3.6];
/// Least distance of the feet of two arrows: that their tips are told apart.
const APART: f64 = 8.0;

/// What pages have in common.
pub struct Sheet {
    pub scale: Scale,
    pub direction: Vector<3>,
    pub is_flat: bool,
    /// Whether colours are those of the colour map, without light.
    pub is_map: bool,
    pub pixels: Option<[u32; 2]>,
    /// Whether there are several pages in a row.
    pub moves: bool,
    /// What the colours show, for the bar; none without colours.
    pub caption: Option<String>,
    pub what: String,
    pub note: String,
    pub length: String,
    /// Whether something deforms: rigid bodies alone are no background.
    pub deformable: bool,
    pub is_axisymmetric: bool,
    /// By which heights are multiplied.
    pub heights: f64,
}

/// What all pages show of space.
struct Frame {
    points: Vec<Vector<3>>,
    axes: [Vector<3>; 2],
}

impl Sheet {
    /// The pages of states, and the number of pixels per unit where a size is wanted.
    ///
    /// # Errors
    /// A page too small for what it has to show.
    pub fn draw(&self, states: &[State], times: &[f64]) -> Result<(Vec<String>, Option<f32>), ReportError> {
        let zoom = self.pixels.map(|[w, h]| (f64::from(w) * f64::from(h) / AREA).sqrt());
        let frame = self.frame(states);
        let page = |(state, time): (&State, &f64)| self.page(state, *time, &frame, zoom);
        let pages: Result<Vec<String>, OutputError> = states.par_iter().zip(times).map(page).collect();
        let pages = pages.map_err(|e| wrong(e.to_string(), "choose a larger --size"))?;
        Ok((pages, zoom.map(|z| z as f32)))
    }

    fn frame(&self, states: &[State]) -> Frame {
        let is_of_deformable = |body: &&Body| !self.deformable || !is_rigid(body);
        let of_bodies = |state: &State| -> Vec<Vector<3>> {
            state.bodies.iter().filter(is_of_deformable).flat_map(Body::seen).copied().collect()
        };
        let mut seen: Vec<Vector<3>> = states.iter().flat_map(of_bodies).collect();
        if seen.is_empty() {
            seen = states.iter().flat_map(State::points).copied().collect();
        }
        let [low, high] = bounds(seen.iter());
        if self.is_flat {
            let pad = Vector::<3>::new(1.0, 1.0, 0.0) * (0.06 * (high - low).max());
            let mut from = low - pad;
            if self.is_axisymmetric {
                // There is nothing beyond the axis.
                from.x = from.x.max(low.x.min(0.0));
            }
            return Frame { points: vec![from, high + pad], axes: [from, high + pad] };
        }
        let mut points: Vec<Vector<3>> = states.iter().flat_map(State::points).copied().collect();
        points.extend(corners([low, high]));
        Frame { points, axes: [low, high] }
    }

    fn page(&self, state: &State, time: f64, frame: &Frame, zoom: Option<f64>) -> Result<String, OutputError> {
        let title = format!("{}, t = {}", self.what, label(time));
        let directions = [&self.direction, &Vector::<3>::z()];
        let size = match (self.pixels, zoom) {
            (Some([w, h]), Some(zoom)) => (f64::from(w) / zoom, f64::from(h) / zoom),
            _ => {
                let [to, above] = directions;
                let extent = Camera::new(to, above, frame.points.iter(), [0.0, 0.0, 1e3, 1e3]).extent();
                let (width, height) = Page::size_for(extent);
                let text = text_width(&title, TITLE).max(text_width(&self.note, 13.0)) + 40.0;
                (width.max(text), height)
            }
        };
        let mut page = Page::new(size, &title, &self.note);
        let [left, top, right, bottom] = [MARGIN[0], MARGIN[1], size.0 - MARGIN[2], size.1 - MARGIN[3]];
        // In space the axes stand aside, with their names.
        let area =
            if self.is_flat { [left, top, right, bottom] } else { [left + 26.0, top, right - 40.0, bottom - 6.0] };
        let camera = Camera::new(directions[0], directions[1], frame.points.iter(), area);
        let look = if self.is_map { Look::Map } else { Look::Solid };
        let look = if self.moves { look.of_film() } else { look };
        let lift = Vector::<3>::z() * (LIFT * (frame.axes[1] - frame.axes[0]).max());
        let bodies: Vec<Body> = state.bodies.iter().map(|body| self.painted(body, &lift)).collect();
        let finer = zoom.map_or(1.0, |zoom| (zoom / PIXELS).max(0.5));
        let [x0, y0, x1, y1] = camera.area;
        render_finer(&bodies, &camera, look, finer)?.insert(&mut page.svg, (x0, x1), (y0, y1))?;
        if self.is_flat {
            clip_to(&mut page.svg, camera.area);
        }
        lines(&mut page.svg, &camera, &state.edges);
        arrows(&mut page.svg, &camera, &state.arrows);
        if self.is_flat {
            page.svg += "</g>";
        }
        let first = if self.is_axisymmetric { "r" } else { "x" };
        let name = |axis: &str| if self.length.is_empty() { axis.into() } else { format!("{axis} [{}]", self.length) };
        let mut names: [String; 3] = [first, "y", "z"].map(name);
        if self.heights != 1.0 {
            names[2] += &format!(" × {}", label(self.heights));
        }
        camera.axes(&mut page.svg, frame.axes, names.each_ref().map(String::as_str));
        let mut key: Vec<(Sign, String)> = Vec::new();
        if self.deformable {
            let mut names = state.rigid.clone();
            names.dedup();
            let sign = if state.bodies.iter().any(is_rigid) { Sign::Area(RIGID) } else { Sign::Line(EDGE) };
            key.extend(names.into_iter().map(|name| (sign, name)));
        }
        if state.has_outline {
            key.push((Sign::Line(FRONT), "edge of contact".into()));
        }
        if !state.arrows.is_empty() {
            key.push((Sign::Line(FRONT), "contact forces".into()));
        }
        page.key(&key);
        if let Some(caption) = &self.caption {
            page.bar(&self.scale, caption);
        }
        Ok(page.finish())
    }

    /// A body with places on the colour map in place of its values; in the plane, what deforms is in front.
    fn painted(&self, body: &Body, lift: &Vector<3>) -> Body {
        let mut out = body.clone();
        if let Paint::Field(values) = &mut out.paint {
            values.iter_mut().for_each(|v| *v = self.scale.place(*v));
        }
        if self.is_flat && !is_rigid(body) {
            out.points.iter_mut().for_each(|x| *x += lift);
        }
        out
    }
}

fn is_rigid(body: &Body) -> bool {
    matches!(body.paint, Paint::Plain(colour) if colour == RIGID)
}

/// Where bodies in the plane end.
fn lines(svg: &mut String, camera: &Camera, edges: &[[Vector<3>; 2]]) {
    if edges.is_empty() {
        return;
    }
    let mut path = String::new();
    for ends in edges {
        let [(x, y), (u, v)] = ends.each_ref().map(|p| camera.at(p));
        let _ = write!(path, "M{x:.2} {y:.2}L{u:.2} {v:.2}");
    }
    let colour = css(EDGE);
    let _ = write!(
        svg,
        "<path d=\"{path}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.1\" stroke-linecap=\"round\"/>"
    );
}

/// Forces, each from its point on.
fn arrows(svg: &mut String, camera: &Camera, list: &[[Vector<3>; 2]]) {
    let colour = css(FRONT);
    let mut feet: Vec<(f64, f64)> = Vec::new();
    for ends in list {
        let [(x, y), (u, v)] = ends.each_ref().map(|p| camera.at(p));
        let length = (u - x).hypot(v - y);
        if length < 1.0 || feet.iter().any(|(a, b)| (a - x).hypot(b - y) < APART) {
            continue;
        }
        feet.push((x, y));
        let (a, b) = ((u - x) / length, (v - y) / length);
        let [long, wide] = TIP.map(|size| size * (length / TIP[0]).min(1.0));
        let (p, q) = (u - long * a, v - long * b);
        let _ = write!(
            svg,
            "<path d=\"M{x:.1} {y:.1}L{p:.1} {q:.1}\" stroke=\"{colour}\" stroke-width=\"1.6\"/>\
             <path d=\"M{u:.1} {v:.1}L{:.1} {:.1}L{:.1} {:.1}Z\" fill=\"{colour}\"/>",
            p - wide * b,
            q + wide * a,
            p + wide * b,
            q - wide * a
        );
    }
}
