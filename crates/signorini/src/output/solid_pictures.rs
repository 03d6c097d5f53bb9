//! Pictures of solids: the deformed state with its stress, the contact pressure, forces over time.

use super::chart::{FONT, failed, label, save, svg, viridis};
use super::pictures::Labels;
use super::solid_fields::{ContactDisplay, SolidDisplay, SolidFields};
use super::{Folder, OutputError};
use crate::plan::solid::{Opposite, SolidPlan};
use crate::report::StepReport;
use plotters::prelude::*;
use signorini_geometry::Point;
use std::fmt::Write as _;

const SIZE: (f64, f64) = (900.0, 620.0);
/// Room for the title above, the colour bar to the right and the axes.
const MARGIN: [f64; 4] = [70.0, 46.0, 130.0, 40.0];
/// Place of bodies without stress on the colour map.
const AT_REST: f64 = 0.45;
const LINE: RGBColor = RGBColor(31, 81, 140);

/// Draws all pictures of a run.
pub fn draw<const D: usize>(
    folder: &Folder,
    plan: &SolidPlan<D>,
    time: f64,
    display: &SolidDisplay<D>,
    fields: &SolidFields<D>,
    contacts: &[ContactDisplay<D>],
    steps: &[StepReport],
) -> Result<(), OutputError> {
    let labels = Labels(plan.unit_names());
    save(folder, "deformed", &deformed(plan, time, display, fields, contacts, &labels, None))?;
    if let Some(window) = window(display, contacts) {
        save(folder, "contact_zone", &deformed(plan, time, display, fields, contacts, &labels, Some(window)))?;
    }
    for (contact, shown) in plan.contacts.iter().zip(contacts) {
        let name = if plan.contacts.len() == 1 { "pressure".into() } else { format!("pressure_{}", contact.name) };
        let picture = if D == 2 {
            profile(&contact.name, time, shown, &labels)?
        } else {
            map(&contact.name, time, shown, &labels)
        };
        save(folder, &name, &picture)?;
    }
    if steps.len() > 1 && !plan.contacts.is_empty() {
        save(folder, "history", &history(plan, steps, &labels)?)?;
    }
    Ok(())
}

/// The bodies before they deform.
pub fn preview<const D: usize>(plan: &SolidPlan<D>, display: &SolidDisplay<D>, fields: &SolidFields<D>) -> String {
    deformed(plan, 0.0, display, fields, &[], &Labels(plan.unit_names()), None)
}

/// A view along a direction that holds a set of points.
struct View<const D: usize> {
    right: Point<D>,
    up: Point<D>,
    towards: Point<D>,
    low: [f64; 2],
    scale: f64,
    /// Where the drawing is on the page.
    area: [f64; 4],
}

impl<const D: usize> View<D> {
    fn new(towards: [f64; 3], points: impl Iterator<Item = Point<D>> + Clone) -> Self {
        let unit = |v: [f64; 3]| {
            let n = v.iter().map(|x| x * x).sum::<f64>().sqrt().max(f64::MIN_POSITIVE);
            v.map(|x| x / n)
        };
        let cross = |a: [f64; 3], b: [f64; 3]| {
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        };
        let vector = |v: [f64; 3]| Point::<D>::from_fn(|k, _| v[k]);
        let towards = unit(towards);
        let above = if D == 2 || towards[2].abs() > 0.99 { [0.0, 1.0, 0.0] } else { [0.0, 0.0, 1.0] };
        let right = unit(cross(above, towards));
        let up = cross(towards, right);
        let (right, up, towards) = (vector(right), vector(up), vector(towards));
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for x in points {
            for (k, axis) in [&right, &up].into_iter().enumerate() {
                low[k] = low[k].min(axis.dot(&x));
                high[k] = high[k].max(axis.dot(&x));
            }
        }
        let pad = 0.03 * (high[0] - low[0]).max(high[1] - low[1]);
        let size = [0, 1].map(|k| (high[k] - low[k] + 2.0 * pad).max(1e-300));
        let room = [SIZE.0 - MARGIN[0] - MARGIN[2], SIZE.1 - MARGIN[1] - MARGIN[3]];
        let scale = (room[0] / size[0]).min(room[1] / size[1]);
        let drawn = [size[0] * scale, size[1] * scale];
        let left = MARGIN[0] + 0.5 * (room[0] - drawn[0]);
        let top = MARGIN[1] + 0.5 * (room[1] - drawn[1]);
        View {
            right,
            up,
            towards,
            low: [low[0] - pad, low[1] - pad],
            scale,
            area: [left, top, left + drawn[0], top + drawn[1]],
        }
    }

    fn at(&self, x: &Point<D>) -> (f64, f64) {
        (
            self.area[0] + self.scale * (self.right.dot(x) - self.low[0]),
            self.area[3] - self.scale * (self.up.dot(x) - self.low[1]),
        )
    }
}

fn start(title: &str) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\"><rect width=\"100%\" height=\"100%\" fill=\"white\"/>\
         <text x=\"{}\" y=\"28\" font-family=\"{FONT}\" font-size=\"19\" text-anchor=\"middle\">{title}</text>",
        SIZE.0,
        SIZE.1,
        0.5 * SIZE.0
    )
}

fn css(c: RGBColor) -> String {
    format!("rgb({},{},{})", c.0, c.1, c.2)
}

fn polygon(svg: &mut String, corners: &[(f64, f64)], colour: &str) {
    let mut points = String::new();
    for (x, y) in corners {
        let _ = write!(points, "{x:.2},{y:.2} ");
    }
    // The stroke hides the seams between polygons.
    let _ = write!(svg, "<polygon points=\"{points}\" fill=\"{colour}\" stroke=\"{colour}\" stroke-width=\"0.5\"/>");
}

/// A polygon whose colour runs evenly between values at its three or four corners, in pieces of a few points each.
fn shaded(svg: &mut String, corners: &[(f64, f64)], values: &[f64], colour: &dyn Fn(f64) -> RGBColor) {
    let (low, high) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
    let size = (0..corners.len())
        .map(|k| {
            let (p, q) = (corners[k], corners[(k + 1) % corners.len()]);
            (p.0 - q.0).hypot(p.1 - q.1)
        })
        .fold(0.0, f64::max);
    let n = ((size / 6.0).min((high - low) * 24.0).ceil() as usize).clamp(1, 16);
    if n == 1 || corners.len() < 3 {
        polygon(svg, corners, &css(colour(values.iter().sum::<f64>() / values.len() as f64)));
        return;
    }
    // Triangles are quadrilaterals with two corners in one.
    let corner = |k: usize| k.min(corners.len() - 1);
    let at = |s: f64, t: f64| {
        let w = [(1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t];
        let sum = |f: &dyn Fn(usize) -> f64| (0..4).map(|k| w[k] * f(corner(k))).sum::<f64>();
        (sum(&|k| corners[k].0), sum(&|k| corners[k].1), sum(&|k| values[k]))
    };
    for i in 0..n {
        for j in 0..n {
            let share = |k: usize| k as f64 / n as f64;
            let p = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| at(share(i), share(j)));
            let mean = p.iter().map(|p| p.2).sum::<f64>() / 4.0;
            polygon(svg, &p.map(|p| (p.0, p.1)), &css(colour(mean)));
        }
    }
}

/// Begins a group of which nothing outside the area is drawn.
fn clip_to(svg: &mut String, [left, top, right, bottom]: [f64; 4]) {
    let _ = write!(
        svg,
        "<clipPath id=\"c\"><rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{:.1}\" height=\"{:.1}\"/></clipPath><g clip-path=\"url(#c)\">",
        right - left,
        bottom - top
    );
}

/// A colour bar with the smallest and largest value and some between.
fn bar(svg: &mut String, range: (f64, f64), title: &str) {
    let (x, top, bottom) = (SIZE.0 - 95.0, 90.0, SIZE.1 - 70.0);
    let n = 64;
    for k in 0..n {
        let (from, to) = (k as f64 / n as f64, (k + 1) as f64 / n as f64);
        let y = bottom + (top - bottom) * to;
        let _ = write!(
            svg,
            "<rect x=\"{x}\" y=\"{y:.2}\" width=\"18\" height=\"{:.2}\" fill=\"{}\"/>",
            (bottom - top) * (to - from) + 0.6,
            css(viridis(0.5 * (from + to)))
        );
    }
    for k in 0..=5 {
        let t = f64::from(k) / 5.0;
        let value = range.0 + (range.1 - range.0) * t;
        let shown = if value.abs() < 1e-9 * range.1.abs().max(range.0.abs()) { 0.0 } else { value };
        let _ = write!(
            svg,
            "<text x=\"{}\" y=\"{:.1}\" font-family=\"{FONT}\" font-size=\"13\">{}</text>",
            x + 24.0,
            bottom + (top - bottom) * t + 4.0,
            short(shown)
        );
    }
    let _ = write!(
        svg,
        "<text x=\"{}\" y=\"{}\" font-family=\"{FONT}\" font-size=\"14\" text-anchor=\"middle\">{title}</text>",
        x + 22.0,
        top - 16.0
    );
}

/// Three digits.
fn short(v: f64) -> String {
    if v == 0.0 {
        return "0".into();
    }
    let digits = (2 - v.abs().log10().floor() as i32).clamp(0, 6) as usize;
    if v.abs() >= 1e5 || v.abs() < 1e-3 { format!("{v:.1e}") } else { format!("{v:.digits$}") }
}

/// A round factor that makes displacements visible, or one.
fn magnification<const D: usize>(display: &SolidDisplay<D>, fields: &SolidFields<D>) -> f64 {
    let low = display.points.iter().fold(Point::<D>::repeat(f64::INFINITY), |l, x| l.inf(x));
    let high = display.points.iter().fold(Point::<D>::repeat(f64::NEG_INFINITY), |h, x| h.sup(x));
    let largest = fields.displacement.iter().map(|u| u.norm()).fold(0.0, f64::max);
    let wanted = 0.05 * (high - low).norm() / largest.max(f64::MIN_POSITIVE);
    if wanted < 2.0 || !wanted.is_finite() {
        return 1.0;
    }
    let power = 10f64.powf(wanted.log10().floor());
    [5.0, 2.0, 1.0].into_iter().map(|d| d * power).find(|m| *m <= wanted).unwrap_or(1.0)
}

/// In the plane, the surroundings of the contact zone where it is small: low and high corner.
fn window<const D: usize>(display: &SolidDisplay<D>, contacts: &[ContactDisplay<D>]) -> Option<[Point<D>; 2]> {
    let zone: Vec<Point<D>> = (contacts.iter())
        .flat_map(|c| (0..c.points.len()).filter(|&k| c.active[k]).map(|k| c.points[k] + c.displacement[k]))
        .collect();
    if D != 2 || zone.is_empty() {
        return None;
    }
    let low = zone.iter().fold(zone[0], |l, x| l.inf(x));
    let high = zone.iter().fold(zone[0], |h, x| h.sup(x));
    let whole = display.points.iter().fold(0.0f64, |m, x| m.max((x - display.points[0]).norm()));
    let size = (high - low).norm();
    if size > 0.2 * whole || size == 0.0 {
        return None;
    }
    let pad = Point::<D>::repeat(size);
    Some([low - pad, high + pad])
}

/// The deformed bodies coloured by the equivalent stress; in the plane with the rigid bodies and the contact zone.
fn deformed<const D: usize>(
    plan: &SolidPlan<D>,
    time: f64,
    display: &SolidDisplay<D>,
    fields: &SolidFields<D>,
    contacts: &[ContactDisplay<D>],
    labels: &Labels,
    window: Option<[Point<D>; 2]>,
) -> String {
    // Magnified displacements would push bodies through rigid ones, which do not deform.
    let touches_rigid = plan.contacts.iter().any(|c| matches!(c.opposite, Opposite::Rigid(_)));
    let factor = if touches_rigid || !plan.contacts.is_empty() { 1.0 } else { magnification(display, fields) };
    let moved: Vec<Point<D>> = display.points.iter().zip(&fields.displacement).map(|(x, u)| x + u * factor).collect();
    let towards = if D == 2 { [0.0, 0.0, 1.0] } else { [1.0, -1.6, if from_below(contacts) { -0.9 } else { 0.9 }] };
    let view = match window {
        Some(corners) => View::<D>::new(towards, corners.into_iter()),
        None => View::<D>::new(towards, moved.iter().copied()),
    };
    let stressed = fields.von_mises.iter().any(|v| *v > 0.0);
    let mut title = if stressed { "Equivalent stress (von Mises), t = " } else { "Bodies at rest, t = " }.to_string();
    title += &label(time);
    if factor != 1.0 {
        title += &format!(", displacements × {factor}");
    }
    let mut out = start(&title);
    if D == 2 {
        rigid_raster(&mut out, plan, time, &view);
    }
    let values = &fields.von_mises;
    // Singular corners would take the whole colour bar for themselves.
    let mut sorted = values.clone();
    sorted.sort_by(f64::total_cmp);
    let largest = sorted[sorted.len() - 1];
    let quantile = sorted[(0.997 * (sorted.len() - 1) as f64) as usize];
    let cut = largest > 1.5 * quantile;
    // A field that is even but for rounding is shown as even.
    let even = largest - sorted[0] <= 1e-9 * largest;
    let range = (if even { 0.0 } else { sorted[0] }, if cut { quantile } else { largest });
    let span = (range.1 - range.0).max(f64::MIN_POSITIVE);
    let [left, top, right, bottom] = view.area;
    clip_to(&mut out, view.area);
    let off_page = |p: &(f64, f64)| p.0 < left - 60.0 || p.0 > right + 60.0 || p.1 < top - 60.0 || p.1 > bottom + 60.0;
    let light = view.towards + view.up * 0.6 - view.right * 0.4;
    let mut list: Vec<(f64, String)> = Vec::new();
    for corners in &display.polygons {
        let x: Vec<Point<D>> = corners.iter().map(|&k| moved[k as usize]).collect();
        let mut shade = 1.0;
        let mut depth = 0.0;
        if D == 3 {
            let (a, b) = (x[1] - x[0], x[x.len() - 1] - x[0]);
            let normal = Point::<D>::from_fn(|k, _| {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                a[i] * b[j] - a[j] * b[i]
            });
            if normal.dot(&view.towards) <= 0.0 {
                continue;
            }
            shade = 0.72 + 0.28 * (normal.dot(&light) / (normal.norm() * light.norm())).max(0.0);
            depth = x.iter().map(|p| view.towards.dot(p)).sum::<f64>() / x.len() as f64;
        }
        let page: Vec<(f64, f64)> = x.iter().map(|p| view.at(p)).collect();
        if page.iter().all(off_page) {
            continue;
        }
        let dim = |c: u8| (f64::from(c) * shade) as u8;
        let colour = |t: f64| {
            let c = viridis(t);
            RGBColor(dim(c.0), dim(c.1), dim(c.2))
        };
        let relative: Vec<f64> = corners
            .iter()
            .map(|&k| if stressed { ((values[k as usize] - range.0) / span).clamp(0.0, 1.0) } else { AT_REST })
            .collect();
        let mut text = String::new();
        shaded(&mut text, &page, &relative, &colour);
        list.push((depth, text));
    }
    list.sort_by(|a, b| a.0.total_cmp(&b.0));
    list.iter().for_each(|(_, text)| out += text);
    if D == 2 {
        // Where the bodies touch.
        for shown in contacts {
            for ends in &shown.intervals {
                let ends = ends.map(|x| view.at(&x));
                let _ = write!(
                    out,
                    "<line x1=\"{:.2}\" y1=\"{:.2}\" x2=\"{:.2}\" y2=\"{:.2}\" stroke=\"#d53c28\" stroke-width=\"3\" stroke-linecap=\"round\"/>",
                    ends[0].0, ends[0].1, ends[1].0, ends[1].1
                );
            }
        }
    }
    out += "</g>";
    ruler(&mut out, &view, labels);
    if stressed {
        bar(&mut out, range, &labels.pressure("σ"));
    }
    if cut {
        let _ = write!(
            out,
            "<text x=\"{}\" y=\"{}\" font-family=\"{FONT}\" font-size=\"13\" text-anchor=\"end\">largest {}</text>",
            SIZE.0 - 20.0,
            SIZE.1 - 40.0,
            short(largest)
        );
    }
    out + "</svg>\n"
}

/// Whether the contact zones in space look downwards.
fn from_below<const D: usize>(contacts: &[ContactDisplay<D>]) -> bool {
    D == 3 && contacts.iter().map(|c| mean_normal(c)[2]).sum::<f64>() < 0.0
}

/// The area normal of the part in contact, or of the whole slave side where nothing touches.
fn mean_normal<const D: usize>(shown: &ContactDisplay<D>) -> [f64; 3] {
    let touching = |f: &Vec<u32>| f.iter().any(|&k| shown.active[k as usize]);
    let any = shown.faces.iter().any(touching);
    let mut mean = [0.0; 3];
    for face in shown.faces.iter().filter(|f| !any || touching(f)) {
        let x: Vec<Point<D>> = face.iter().map(|&k| shown.points[k as usize]).collect();
        let (a, b) = (x[1] - x[0], x[x.len() - 1] - x[0]);
        for (k, m) in mean.iter_mut().enumerate() {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            *m += a[i] * b[j] - a[j] * b[i];
        }
    }
    mean
}

/// Grey where a rigid body is.
fn rigid_raster<const D: usize>(out: &mut String, plan: &SolidPlan<D>, time: f64, view: &View<D>) {
    let bodies: Vec<_> = (plan.contacts.iter())
        .filter_map(|c| match &c.opposite {
            Opposite::Rigid(body) => body.gap_at(&plan.document, time).ok(),
            Opposite::Body { .. } => None,
        })
        .collect();
    if bodies.is_empty() {
        return;
    }
    let step = 2.0;
    let [left, top, right, bottom] = view.area;
    let mut y = top;
    while y < bottom {
        // Runs of equal pixels become one rectangle.
        let mut from: Option<f64> = None;
        let mut x = left;
        while x <= right {
            let inside = x < right && {
                let p = [
                    view.low[0] + (x + 0.5 * step - left) / view.scale,
                    view.low[1] + (bottom - y - 0.5 * step) / view.scale,
                ];
                bodies.iter().any(|gap| gap(&Point::<3>::new(p[0], p[1], 0.0)).gap < 0.0)
            };
            match (inside, from) {
                (true, None) => from = Some(x),
                (false, Some(start)) => {
                    let width = x - start;
                    let _ = write!(
                        out,
                        "<rect x=\"{start:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{}\" fill=\"#b9b9b9\"/>",
                        step + 0.2
                    );
                    from = None;
                }
                _ => {}
            }
            x += step;
        }
        if let Some(start) = from {
            let width = right - start;
            let _ = write!(
                out,
                "<rect x=\"{start:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{}\" fill=\"#b9b9b9\"/>",
                step + 0.2
            );
        }
        y += step;
    }
}

/// A scale: a bar of a round length.
fn ruler<const D: usize>(out: &mut String, view: &View<D>, labels: &Labels) {
    let wanted = 0.25 * (view.area[2] - view.area[0]) / view.scale;
    let power = 10f64.powf(wanted.log10().floor());
    let length = [5.0, 2.0, 1.0].into_iter().map(|d| d * power).find(|l| *l <= wanted).unwrap_or(power);
    let (x, y) = (MARGIN[0], SIZE.1 - 18.0);
    let _ = write!(
        out,
        "<line x1=\"{x}\" y1=\"{y}\" x2=\"{:.2}\" y2=\"{y}\" stroke=\"#222\" stroke-width=\"2\"/>\
         <text x=\"{:.2}\" y=\"{:.1}\" font-family=\"{FONT}\" font-size=\"13\">{}</text>",
        x + length * view.scale,
        x + length * view.scale + 8.0,
        y + 4.0,
        labels.length(&label(length)).replace(['[', ']'], "")
    );
}

/// Pressure along the slave side in the plane.
fn profile<const D: usize>(
    name: &str,
    time: f64,
    shown: &ContactDisplay<D>,
    labels: &Labels,
) -> Result<String, OutputError> {
    // Along the coordinate in which the side is longest.
    let extent = |k: usize| {
        let (l, h) =
            shown.points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x[k]), h.max(x[k])));
        h - l
    };
    let axis = (0..D).max_by(|&a, &b| extent(a).total_cmp(&extent(b))).unwrap_or(0);
    let mut order: Vec<usize> = (0..shown.points.len()).collect();
    order.sort_by(|&a, &b| shown.points[a][axis].total_cmp(&shown.points[b][axis]));
    // Around the zone of contact, half as much again on either side.
    let touching: Vec<f64> = order.iter().filter(|&&k| shown.active[k]).map(|&k| shown.points[k][axis]).collect();
    let all = (shown.points[order[0]][axis], shown.points[order[order.len() - 1]][axis]);
    let x = match (touching.first(), touching.last()) {
        (Some(&l), Some(&h)) => {
            let pad = 0.3 * (h - l).max(0.02 * (all.1 - all.0));
            ((l - pad).max(all.0), (h + pad).min(all.1))
        }
        _ => all,
    };
    let points: Vec<(f64, f64)> = order
        .iter()
        .map(|&k| (shown.points[k][axis], shown.pressure[k]))
        .filter(|p| p.0 >= x.0 && p.0 <= x.1)
        .collect();
    let top = 1.08 * points.iter().map(|p| p.1).fold(f64::MIN_POSITIVE, f64::max);
    svg((900, 520), |root| {
        let mut chart = ChartBuilder::on(root)
            .caption(format!("Contact pressure of `{name}`, t = {}", label(time)), (FONT, 20))
            .margin(14)
            .x_label_area_size(45)
            .y_label_area_size(85)
            .build_cartesian_2d(x.0..x.1, 0.0..top)
            .map_err(failed)?;
        chart
            .configure_mesh()
            .light_line_style(WHITE)
            .x_desc(labels.length(["x", "y", "z"][axis]))
            .y_desc(labels.pressure("p"))
            .x_label_formatter(&|v| label(*v))
            .y_label_formatter(&|v| label(*v))
            .label_style((FONT, 15))
            .draw()
            .map_err(failed)?;
        chart
            .draw_series(AreaSeries::new(points.iter().copied(), 0.0, LINE.mix(0.2)).border_style(LINE.stroke_width(2)))
            .map_err(failed)?;
        chart
            .draw_series(points.iter().filter(|p| p.1 > 0.0).map(|p| Circle::new(*p, 3, LINE.filled())))
            .map_err(failed)
            .map(|_| ())
    })
}

/// Pressure on the slave side in space, seen from outside.
fn map<const D: usize>(name: &str, time: f64, shown: &ContactDisplay<D>, labels: &Labels) -> String {
    let touching = |f: &Vec<u32>| f.iter().any(|&k| shown.active[k as usize]);
    let any = shown.faces.iter().any(touching);
    let near: Vec<Point<D>> = if any {
        let zone: Vec<Point<D>> =
            (0..shown.points.len()).filter(|&k| shown.active[k]).map(|k| shown.points[k]).collect();
        let centre = zone.iter().sum::<Point<D>>() / zone.len() as f64;
        zone.iter().map(|x| centre + (x - centre) * 1.5).collect()
    } else {
        shown.points.clone()
    };
    let view = View::<D>::new(mean_normal(shown), near.iter().copied());
    let mut out = start(&format!("Contact pressure of `{name}`, t = {}", label(time)));
    clip_to(&mut out, view.area);
    let most = shown.pressure.iter().fold(f64::MIN_POSITIVE, |m, p| m.max(*p));
    for face in &shown.faces {
        let corners: Vec<(f64, f64)> = face.iter().map(|&k| view.at(&shown.points[k as usize])).collect();
        if touching(face) {
            let relative: Vec<f64> = face.iter().map(|&k| shown.pressure[k as usize] / most).collect();
            shaded(&mut out, &corners, &relative, &viridis);
        } else {
            polygon(&mut out, &corners, "#e4e4e4");
        }
    }
    for ends in &shown.boundary {
        let [a, b] = ends.map(|x| view.at(&x));
        let _ = write!(
            out,
            "<line x1=\"{:.2}\" y1=\"{:.2}\" x2=\"{:.2}\" y2=\"{:.2}\" stroke=\"#d53c28\" stroke-width=\"2\" stroke-linecap=\"round\"/>",
            a.0, a.1, b.0, b.1
        );
    }
    out += "</g>";
    ruler(&mut out, &view, labels);
    bar(&mut out, (0.0, most), &labels.pressure("p"));
    out + "</svg>\n"
}

/// The force of every contact over time.
fn history<const D: usize>(plan: &SolidPlan<D>, steps: &[StepReport], labels: &Labels) -> Result<String, OutputError> {
    let series: Vec<(String, Vec<(f64, f64)>)> = (plan.contacts.iter())
        .map(|c| {
            let force = |s: &StepReport| {
                let force = s.contacts.get(&c.name)?.force;
                Some((s.time, force.iter().map(|v| v * v).sum::<f64>().sqrt()))
            };
            (c.name.clone(), steps.iter().filter_map(force).collect())
        })
        .collect();
    let all = || series.iter().flat_map(|s| s.1.iter());
    let x = all().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| (l.min(p.0), h.max(p.0)));
    let top = 1.08 * all().map(|p| p.1).fold(f64::MIN_POSITIVE, f64::max);
    svg((860, 480), |root| {
        let mut chart = ChartBuilder::on(root)
            .caption("Contact force", (FONT, 20))
            .margin(14)
            .x_label_area_size(45)
            .y_label_area_size(85)
            .build_cartesian_2d(x.0.min(0.0)..x.1.max(x.0 + f64::MIN_POSITIVE), 0.0..top)
            .map_err(failed)?;
        chart
            .configure_mesh()
            .light_line_style(WHITE)
            .x_desc("t")
            .y_desc(labels.force("force"))
            .x_label_formatter(&|v| label(*v))
            .y_label_formatter(&|v| label(*v))
            .label_style((FONT, 15))
            .draw()
            .map_err(failed)?;
        let count = series.len();
        for (k, (name, points)) in series.iter().enumerate() {
            let colour = viridis(0.8 * k as f64 / (count.max(2) - 1) as f64);
            chart
                .draw_series(LineSeries::new(points.iter().copied(), colour.stroke_width(2)).point_size(3))
                .map_err(failed)?
                .label(name)
                .legend(move |(x, y)| PathElement::new(vec![(x, y), (x + 20, y)], colour.stroke_width(2)));
        }
        if count > 1 {
            chart.configure_series_labels().label_font((FONT, 14)).background_style(WHITE).draw().map_err(failed)?;
        }
        Ok(())
    })
}
