//! Pictures of solids: forces over time, and in the plane the deformed state with its stress and the contact pressure.

use super::chart::{FONT, failed, label, save, svg, viridis};
use super::page::{MARGIN, SIZE, Scale, css, magnification, start, stress_title};
use super::pictures::Labels;
use super::solid_fields::{ContactDisplay, SolidDisplay, SolidFields};
use super::{Folder, OutputError, solid_space};
use crate::plan::solid::{Opposite, SolidPlan};
use crate::report::StepReport;
use plotters::prelude::*;
use signorini_geometry::Point;
use std::fmt::Write as _;

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
    let labels = Labels(plan.head.unit_names());
    if D == 3 {
        solid_space::draw(folder, plan, time, display, fields, contacts, &labels)?;
    } else {
        save(folder, "deformed", &deformed(plan, time, display, fields, contacts, &labels, None))?;
        if let Some(window) = window(display, contacts) {
            save(folder, "contact_zone", &deformed(plan, time, display, fields, contacts, &labels, Some(window)))?;
        }
        for (contact, shown) in plan.contacts.iter().zip(contacts) {
            let name = if plan.contacts.len() == 1 { "pressure".into() } else { format!("pressure_{}", contact.name) };
            save(folder, &name, &profile(&contact.name, time, shown, &labels)?)?;
        }
    }
    if steps.len() > 1 && !plan.contacts.is_empty() {
        save(folder, "history", &history(plan, steps, &labels)?)?;
    }
    Ok(())
}

/// The bodies before they deform.
///
/// # Errors
/// A picture that cannot be drawn.
pub fn preview<const D: usize>(
    plan: &SolidPlan<D>,
    display: &SolidDisplay<D>,
    fields: &SolidFields<D>,
) -> Result<String, OutputError> {
    let labels = Labels(plan.head.unit_names());
    if D == 3 {
        return solid_space::preview(plan, display, fields, &labels);
    }
    Ok(deformed(plan, 0.0, display, fields, &[], &labels, None))
}

/// A view of the plane that holds a set of points.
struct View {
    low: [f64; 2],
    scale: f64,
    /// Where the drawing is on the page.
    area: [f64; 4],
}

impl View {
    fn new<const D: usize>(points: impl Iterator<Item = Point<D>>) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for x in points {
            for k in 0..2 {
                low[k] = low[k].min(x[k]);
                high[k] = high[k].max(x[k]);
            }
        }
        let pad = 0.03 * (high[0] - low[0]).max(high[1] - low[1]);
        let size = [0, 1].map(|k| (high[k] - low[k] + 2.0 * pad).max(1e-300));
        let room = [SIZE.0 - MARGIN[0] - MARGIN[2], SIZE.1 - MARGIN[1] - MARGIN[3]];
        let scale = (room[0] / size[0]).min(room[1] / size[1]);
        let drawn = [size[0] * scale, size[1] * scale];
        let left = MARGIN[0] + 0.5 * (room[0] - drawn[0]);
        let top = MARGIN[1] + 0.5 * (room[1] - drawn[1]);
        View { low: [low[0] - pad, low[1] - pad], scale, area: [left, top, left + drawn[0], top + drawn[1]] }
    }

    fn at<const D: usize>(&self, x: &Point<D>) -> (f64, f64) {
        (self.area[0] + self.scale * (x[0] - self.low[0]), self.area[3] - self.scale * (x[1] - self.low[1]))
    }
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

/// The deformed bodies in the plane coloured by the equivalent stress, with the rigid bodies and the contact zone.
fn deformed<const D: usize>(
    plan: &SolidPlan<D>,
    time: f64,
    display: &SolidDisplay<D>,
    fields: &SolidFields<D>,
    contacts: &[ContactDisplay<D>],
    labels: &Labels,
    window: Option<[Point<D>; 2]>,
) -> String {
    // Magnified displacements would push bodies through each other.
    let factor = if plan.contacts.is_empty() { magnification(display, fields) } else { 1.0 };
    let moved: Vec<Point<D>> = display.points.iter().zip(&fields.displacement).map(|(x, u)| x + u * factor).collect();
    let view = match window {
        Some(corners) => View::new(corners.into_iter()),
        None => View::new(moved.iter().copied()),
    };
    let scale = Scale::of(&fields.von_mises);
    let mut out = start(&stress_title(&scale, time, factor));
    rigid_raster(&mut out, plan, time, &view);
    let [left, top, right, bottom] = view.area;
    clip_to(&mut out, view.area);
    let off_page = |p: &(f64, f64)| p.0 < left - 60.0 || p.0 > right + 60.0 || p.1 < top - 60.0 || p.1 > bottom + 60.0;
    for corners in &display.polygons {
        let page: Vec<(f64, f64)> = corners.iter().map(|&k| view.at(&moved[k as usize])).collect();
        if page.iter().all(off_page) {
            continue;
        }
        let relative: Vec<f64> = corners.iter().map(|&k| scale.place(fields.von_mises[k as usize])).collect();
        shaded(&mut out, &page, &relative, &viridis);
    }
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
    out += "</g>";
    ruler(&mut out, &view, labels);
    scale.bar(&mut out, &labels.pressure("σ"));
    out + "</svg>\n"
}

/// Grey where a rigid body is.
fn rigid_raster<const D: usize>(out: &mut String, plan: &SolidPlan<D>, time: f64, view: &View) {
    let bodies: Vec<_> = (plan.contacts.iter())
        .filter_map(|c| match &c.opposite {
            Opposite::Rigid(body) => body.gap_at(&plan.head.problem, time).ok(),
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
fn ruler(out: &mut String, view: &View, labels: &Labels) {
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
