//! The pictures a person would want to look at first.

use super::chart::{Axes, FONT, Image, axes, failed, label, line, padded, range, rounded, save, svg, viridis, word};
use super::{Folder, OutputError};
use crate::exact;
use crate::plan::MembranePlan;
use crate::problem::Space;
use crate::report::{ContactReport, Event, StepReport, UnitNames};
use crate::snapshot::{DisplayMesh, Snapshot};
use plotters::prelude::*;
use rayon::prelude::*;
use signorini_geometry::{Aabb, Point, polygon};
use signorini_verify::flat_floor::FlatFloor;

const MEMBRANE: RGBColor = RGBColor(31, 81, 140);
const FLOOR: RGBColor = RGBColor(110, 110, 110);
const FRONT: RGBColor = RGBColor(213, 60, 40);
const EXACT: RGBColor = RGBColor(20, 20, 20);
/// Colours of several contacts, told apart by everyone (Okabe and Ito).
const SERIES: [RGBColor; 5] =
    [MEMBRANE, RGBColor(230, 159, 0), RGBColor(0, 158, 115), RGBColor(204, 121, 167), RGBColor(86, 180, 233)];

/// What a field does across the fronts.
#[derive(Clone, Copy, PartialEq)]
enum Across {
    Continuous,
    Jumping,
}

/// Draws all pictures of a run.
pub fn draw<const D: usize>(
    folder: &Folder,
    plan: &MembranePlan<D>,
    mesh: &DisplayMesh<D>,
    s: &Snapshot<D>,
    steps: &[StepReport],
    events: &[Event],
) -> Result<(), OutputError> {
    if mesh.cells.is_empty() {
        // A domain thinner than the display can show.
        return Ok(());
    }
    let units = &Labels(plan.head.unit_names());
    let exact = exact::of(plan, s.time);
    let own = |values: &[f64]| range(values.iter().copied());
    type Drawing<'a> = Box<dyn Fn() -> Result<String, OutputError> + Sync + 'a>;
    let contacts: Vec<&str> = plan.contacts.iter().map(|c| c.name.as_str()).collect();
    let contacts = contacts.as_slice();
    let mut drawings: Vec<(&str, Drawing)> = Vec::new();
    if D == 1 {
        drawings.push(("deflection", Box::new(|| profile(plan, mesh, s, exact, units, heights(s)))));
        if s.has_obstacles() {
            drawings.push(("gap_and_pressure", Box::new(|| gap_profile(mesh, s, units))));
        }
    } else {
        let field = |values: &Vec<f64>, title, label, exact| {
            map(mesh, s, (values, Across::Continuous), title, label, exact, units, own(values))
        };
        drawings.push(("deflection", Box::new(move || field(&s.displacement, "Deflection", units.length("u"), exact))));
        if s.has_obstacles() {
            drawings.push(("gap", Box::new(move || field(&s.gap, "Gap", units.length("gap"), None))));
            drawings.push((
                "pressure",
                Box::new(|| {
                    let pressure = (s.pressure.as_slice(), Across::Jumping);
                    map(mesh, s, pressure, "Contact pressure", units.pressure("p"), None, units, own(&s.pressure))
                }),
            ));
        }
    }
    drawings.push(("convergence", Box::new(|| convergence(steps))));
    if steps.len() > 1 && !contacts.is_empty() {
        drawings.push(("history", Box::new(|| history(steps, events, contacts, plan.space, units))));
    }
    if steps.len() > 1
        && let Some(contact) = plan.contacts.iter().find(|c| c.adhesion.is_some()).or(plan.contacts.first())
        && let Some(drive) = Drive::of(plan, steps, units)
    {
        let name = contact.name.as_str();
        let title = if contact.adhesion.is_some() { "loop" } else { "load_curves" };
        drawings.push((title, Box::new(move || loop_of_states(&drive, steps, events, name, plan.space, units))));
    }
    let drawn: Vec<String> = drawings
        .par_iter()
        .map(|(name, draw)| {
            let text = draw()?;
            save(folder, name, &text)?;
            Ok(text)
        })
        .collect::<Result<_, OutputError>>()?;
    save(folder, "overview", &sheet(&drawn))
}

/// A membrane before it touches: on a line its profile over what lies below, in the plane the gap.
pub fn preview<const D: usize>(
    plan: &MembranePlan<D>,
    mesh: &DisplayMesh<D>,
    s: &Snapshot<D>,
) -> Result<String, OutputError> {
    frame(plan, mesh, s, frame_range(s))
}

/// All pictures on one sheet, in rows of two.
fn sheet(pictures: &[String]) -> String {
    const WIDTH: f64 = 760.0;
    // The first line of a picture states its size.
    let size = |text: &str| -> Option<(f64, f64)> {
        let number = |key: &str| text.split_once(key)?.1.split('"').next()?.parse::<f64>().ok();
        Some((number("width=\"")?, number("height=\"")?))
    };
    let (mut body, mut y) = (String::new(), 0.0);
    for row in pictures.chunks(2) {
        let mut highest = 0.0f64;
        for (k, text) in row.iter().enumerate() {
            let Some((w, h)) = size(text) else { continue };
            let height = WIDTH * h / w;
            let inner = text.split_once('>').and_then(|(_, rest)| rest.rsplit_once("</svg>")).map_or("", |(t, _)| t);
            body += &format!(
                "<svg x=\"{}\" y=\"{y}\" width=\"{WIDTH}\" height=\"{height}\" viewBox=\"0 0 {w} {h}\">{inner}</svg>",
                k as f64 * WIDTH
            );
            highest = highest.max(height);
        }
        y += highest;
    }
    let wide = WIDTH * pictures.len().min(2) as f64;
    format!(
        "<svg width=\"{wide}\" height=\"{y:.0}\" viewBox=\"0 0 {wide} {y:.0}\" xmlns=\"http://www.w3.org/2000/svg\" \
         xmlns:xlink=\"http://www.w3.org/1999/xlink\"><rect width=\"100%\" height=\"100%\" fill=\"white\"/>{body}</svg>\n"
    )
}

/// Axis labels with the units of the case.
pub(super) struct Labels(pub Option<UnitNames>);

impl Labels {
    fn with(&self, what: &str, unit: fn(&UnitNames) -> &String) -> String {
        self.0.as_ref().map_or_else(|| what.to_string(), |units| format!("{what} [{}]", unit(units)))
    }

    pub fn length(&self, what: &str) -> String {
        self.with(what, |u| &u.length)
    }

    pub fn area(&self, what: &str) -> String {
        self.with(what, |u| &u.area)
    }

    pub fn force(&self, what: &str) -> String {
        self.with(what, |u| &u.force)
    }

    pub fn pressure(&self, what: &str) -> String {
        self.with(what, |u| &u.pressure)
    }
}

/// One frame of a film: the deflection on a line, the gap in the plane, over a range that holds for all frames.
pub(super) fn frame<const D: usize>(
    plan: &MembranePlan<D>,
    mesh: &DisplayMesh<D>,
    s: &Snapshot<D>,
    (lo, hi): (f64, f64),
) -> Result<String, OutputError> {
    let units = &Labels(plan.head.unit_names());
    if D == 1 {
        return profile(plan, mesh, s, None, units, (lo, hi));
    }
    let (values, title, label) = match s.has_obstacles() {
        true => (&s.gap, "Gap", units.length("gap")),
        false => (&s.displacement, "Deflection", units.length("u")),
    };
    map(mesh, s, (values, Across::Continuous), title, label, None, units, (lo, hi))
}

/// The range of what a frame shows.
pub(super) fn frame_range<const D: usize>(s: &Snapshot<D>) -> (f64, f64) {
    match (D, s.has_obstacles()) {
        (1, _) => heights(s),
        (_, true) => range(s.gap.iter().copied()),
        (_, false) => range(s.displacement.iter().copied()),
    }
}

/// The range of the membrane and of what it may touch.
fn heights<const D: usize>(s: &Snapshot<D>) -> (f64, f64) {
    range(s.displacement.iter().chain(s.floor.iter().flatten()).chain(s.ceiling.iter().flatten()).copied())
}

/// A field as a colour map, with the contact outlined.
#[allow(clippy::too_many_arguments)]
fn map<const D: usize>(
    mesh: &DisplayMesh<D>,
    s: &Snapshot<D>,
    (values, across): (&[f64], Across),
    title: &str,
    value_label: String,
    exact: Option<FlatFloor>,
    units: &Labels,
    (lo, hi): (f64, f64),
) -> Result<String, OutputError> {
    let bounds = mesh
        .points
        .iter()
        .fold(Aabb::new(mesh.points[0], mesh.points[0]), |b, p| Aabb::new(b.min.inf(p), b.max.sup(p)));
    let extent = bounds.size();
    // The plot keeps the proportions of the domain.
    let aspect = extent[1] / extent[0];
    let (w, h) = if aspect < 1.0 { (600.0, (600.0 * aspect).max(120.0)) } else { ((600.0 / aspect).max(120.0), 600.0) };
    let size = (w as u32 + 240, h as u32 + 110);
    let mut pixels = ((0, 1), (0, 1));
    let mut text = svg(size, |root| {
        let (left, right) = root.split_horizontally(w as i32 + 90);
        let caption = format!("{title}, t = {}", label(s.time));
        let mut chart = ChartBuilder::on(&left)
            .caption(caption, (FONT, 20))
            .margin(8)
            .x_label_area_size(45)
            .y_label_area_size(65)
            .build_cartesian_2d(bounds.min[0]..bounds.max[0], bounds.min[1]..bounds.max[1])
            .map_err(failed)?;
        chart
            .configure_mesh()
            .disable_mesh()
            .x_desc(units.length("x"))
            .y_desc(units.length("y"))
            .x_labels(6)
            .y_labels(6)
            .x_label_formatter(&|v| label(*v))
            .y_label_formatter(&|v| label(*v))
            .label_style((FONT, 15))
            .draw()
            .map_err(failed)?;
        let area = chart.plotting_area().get_pixel_range();
        pixels = ((area.0.start, area.0.end), (area.1.start, area.1.end));
        if let Some(radius) = exact.and_then(|e| e.contact_radius()) {
            let c = bounds.center();
            let dashes = (0..60).map(|k| {
                let at = |j: f64| {
                    let a = std::f64::consts::TAU * (f64::from(k) + j) / 60.0;
                    (c[0] + radius * a.cos(), c[1] + radius * a.sin())
                };
                PathElement::new(vec![at(0.0), at(0.25), at(0.5)], EXACT.stroke_width(2))
            });
            chart.draw_series(dashes).map_err(failed)?;
        }
        colour_bar(&right, (lo, hi), &value_label, s, exact.is_some_and(|e| e.contact_radius().is_some()))
    })?;
    let mut image = Image::new((pixels.0.1 - pixels.0.0).max(1) as u32, (pixels.1.1 - pixels.1.0).max(1) as u32)?;
    fill(&mut image, mesh, s, (values, across), &bounds, (lo, hi));
    let page = |p: (i32, i32)| (f64::from(p.0), f64::from(p.1));
    image.insert(&mut text, page(pixels.0), page(pixels.1))?;
    // The front is drawn in fractions of a pixel, which the chart's own lines are rounded to.
    let at = |p: &Point<D>| {
        let t = (p - bounds.min).component_div(&extent);
        let (x, y) = (f64::from(pixels.0.1 - pixels.0.0), f64::from(pixels.1.1 - pixels.1.0));
        (f64::from(pixels.0.0) + t[0] * x, f64::from(pixels.1.1) - t[1] * y)
    };
    for front in &s.fronts() {
        line(&mut text, &front.iter().map(at).collect::<Vec<_>>(), FRONT);
    }
    // Zones are numbered as the summary lists them.
    let flat = |o: &Vec<Point<D>>| o.iter().map(|p| Point::<2>::new(p[0], p[D - 1])).collect::<Vec<_>>();
    let zones = || s.outlines.iter().filter(|o| polygon::signed_area(&flat(o)) > 0.0);
    if zones().count() > 1 {
        for (k, outline) in zones().enumerate() {
            let middle = outline.iter().sum::<Point<D>>() / outline.len() as f64;
            word(&mut text, at(&middle), &(k + 1).to_string(), FRONT);
        }
    }
    Ok(text)
}

fn colour_bar<const D: usize>(
    area: &DrawingArea<SVGBackend<'_>, plotters::coord::Shift>,
    (lo, hi): (f64, f64),
    value_label: &str,
    s: &Snapshot<D>,
    exact: bool,
) -> Result<(), OutputError> {
    let (_, height) = area.dim_in_pixel();
    let (top, bottom) = (60, height as i32 - 110);
    let style = (FONT, 15).into_font();
    area.draw(&Text::new(value_label.to_string(), (10, 34), style.clone())).map_err(failed)?;
    const BANDS: i32 = 64;
    for k in 0..BANDS {
        let y = |k: i32| bottom - (bottom - top) * k / BANDS;
        let colour = viridis((f64::from(k) + 0.5) / f64::from(BANDS));
        area.draw(&Rectangle::new([(10, y(k + 1)), (34, y(k) + 1)], colour.filled())).map_err(failed)?;
    }
    for k in 0..=4 {
        let value = rounded(lo + (hi - lo) * f64::from(k) / 4.0, hi - lo);
        let y = bottom - (bottom - top) * k / 4;
        area.draw(&Text::new(label(value), (42, y - 8), style.clone())).map_err(failed)?;
    }
    let mut y = bottom + 22;
    let mut entry = |colour: RGBColor, text: &str| -> Result<(), OutputError> {
        area.draw(&PathElement::new(vec![(10, y), (34, y)], colour.stroke_width(3))).map_err(failed)?;
        area.draw(&Text::new(text.to_string(), (42, y - 8), style.clone())).map_err(failed)?;
        y += 22;
        Ok(())
    };
    if !s.outlines.is_empty() {
        entry(FRONT, "contact front")?;
    }
    if exact {
        entry(EXACT, "exact front (dashed)")?;
    }
    Ok(())
}

/// Paints the cells of the display mesh, bilinear within each.
fn fill<const D: usize>(
    image: &mut Image,
    mesh: &DisplayMesh<D>,
    s: &Snapshot<D>,
    (values, across): (&[f64], Across),
    bounds: &Aabb<D>,
    (lo, hi): (f64, f64),
) {
    let size = bounds.size();
    let (w, h) = (image.width(), image.height());
    let pixel =
        |p: &Point<D>| ((p[0] - bounds.min[0]) / size[0] * w as f64, (bounds.max[1] - p[1]) / size[1] * h as f64);
    let drawn = |p: &Point<D>| {
        let (x, y) = pixel(p);
        Point::<2>::new(x, y)
    };
    let outlines: Vec<Vec<Point<2>>> = s.outlines.iter().map(|o| o.iter().map(drawn).collect()).collect();
    let touches = |x: &Point<2>| outlines.iter().map(|o| polygon::winding_number(o, x)).sum::<i32>() != 0;
    let triangles = mesh.cells.iter().flat_map(|cell| (2..cell.len()).map(|k| [cell[0], cell[k - 1], cell[k]]));
    for corners in triangles {
        let [a, b, c] = corners.map(|i| pixel(&mesh.points[i as usize]));
        let (x0, x1) = range([a.0, b.0, c.0].into_iter());
        let (y0, y1) = range([a.1, b.1, c.1].into_iter());
        let twice = |p: (f64, f64), q: (f64, f64), r: (f64, f64)| (q.0 - p.0) * (r.1 - p.1) - (q.1 - p.1) * (r.0 - p.0);
        let whole = twice(a, b, c);
        if whole == 0.0 {
            continue;
        }
        let contact = corners.map(|i| s.in_contact[i as usize]);
        let divided = across == Across::Jumping && contact.iter().any(|c| *c != contact[0]);
        for y in y0.floor().max(0.0) as usize..(y1.ceil() as usize).min(h) {
            for x in x0.floor().max(0.0) as usize..(x1.ceil() as usize).min(w) {
                let at = (x as f64 + 0.5, y as f64 + 0.5);
                let mut shares = [twice(at, b, c), twice(a, at, c), twice(a, b, at)].map(|s| s / whole);
                if !shares.iter().all(|s| *s >= -1e-9) {
                    continue;
                }
                if divided {
                    // Only what is on the same side of the front says anything.
                    let side = touches(&Point::<2>::new(at.0, at.1));
                    let own = shares.iter().zip(contact).filter(|(_, c)| *c == side).map(|(s, _)| s).sum::<f64>();
                    if own > 0.0 {
                        shares.iter_mut().zip(contact).for_each(|(s, c)| *s = if c == side { *s / own } else { 0.0 });
                    }
                }
                let v: f64 = shares.iter().zip(&corners).map(|(s, &i)| s * values[i as usize]).sum();
                image.set(x, y, viridis((v - lo) / (hi - lo)));
            }
        }
    }
}

/// Points of a line in order, with their values.
fn in_order<const D: usize>(mesh: &DisplayMesh<D>, values: &[f64]) -> Vec<(f64, f64)> {
    let mut points: Vec<(f64, f64)> = mesh.points.iter().zip(values).map(|(p, v)| (p[0], *v)).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points
}

/// Deflection of a string or of the radius of a round membrane.
fn profile<const D: usize>(
    plan: &MembranePlan<D>,
    mesh: &DisplayMesh<D>,
    s: &Snapshot<D>,
    exact: Option<FlatFloor>,
    units: &Labels,
    (lo, hi): (f64, f64),
) -> Result<String, OutputError> {
    let u = in_order(mesh, &s.displacement);
    let x = range(u.iter().map(|p| p.0));
    let axis = if plan.space == Space::Axisymmetric { "r" } else { "x" };
    svg((900, 480), |root| {
        let mut chart = ChartBuilder::on(root)
            .caption(format!("Deflection, t = {}", label(s.time)), (FONT, 20))
            .margin(10)
            .x_label_area_size(45)
            .y_label_area_size(75)
            .build_cartesian_2d(x.0..x.1, padded((lo, hi)))
            .map_err(failed)?;
        chart
            .configure_mesh()
            .light_line_style(WHITE)
            .x_desc(units.length(axis))
            .y_desc(units.length("height"))
            .x_label_formatter(&|v| label(*v))
            .y_label_formatter(&|v| label(rounded(*v, hi - lo)))
            .label_style((FONT, 15))
            .draw()
            .map_err(failed)?;
        for (heights, base) in [(&s.floor, lo - 0.05 * (hi - lo)), (&s.ceiling, hi + 0.05 * (hi - lo))] {
            let Some(heights) = heights else { continue };
            let surface = AreaSeries::new(in_order(mesh, heights), base, FLOOR.mix(0.25)).border_style(FLOOR);
            chart.draw_series(surface).map_err(failed)?;
        }
        chart
            .draw_series(LineSeries::new(u.iter().copied(), MEMBRANE.stroke_width(3)))
            .map_err(failed)?
            .label("membrane")
            .legend(|(x, y)| PathElement::new(vec![(x, y), (x + 20, y)], MEMBRANE.stroke_width(3)));
        if let Some(exact) = exact {
            let middle = if plan.space == Space::Axisymmetric { 0.0 } else { plan.grid.bounds().center()[0] };
            let marks = (0..=40).map(|k| {
                let at = x.0 + (x.1 - x.0) * f64::from(k) / 40.0;
                Circle::new((at, exact.displacement(at - middle)), 3, EXACT)
            });
            chart
                .draw_series(marks)
                .map_err(failed)?
                .label("exact")
                .legend(|(x, y)| Circle::new((x + 10, y), 3, EXACT));
        }
        let axis_point = |p: &&Point<D>| !(plan.space == Space::Axisymmetric && p[0] <= 0.0);
        let ends = s.outlines.iter().flatten().filter(axis_point).map(|p| {
            let v = u.iter().min_by(|a, b| (a.0 - p[0]).abs().total_cmp(&(b.0 - p[0]).abs())).map_or(0.0, |q| q.1);
            Circle::new((p[0], v), 6, FRONT.filled())
        });
        let touches = !s.outlines.is_empty();
        let ends = chart.draw_series(ends).map_err(failed)?;
        if touches {
            ends.label("end of contact").legend(|(x, y)| Circle::new((x + 10, y), 5, FRONT.filled()));
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperMiddle)
            .label_font((FONT, 15))
            .background_style(WHITE.mix(0.8))
            .border_style(FLOOR)
            .draw()
            .map_err(failed)
    })
}

/// Gap and pressure along a line, one above the other.
fn gap_profile<const D: usize>(mesh: &DisplayMesh<D>, s: &Snapshot<D>, units: &Labels) -> Result<String, OutputError> {
    svg((900, 640), |root| {
        let parts = root.split_evenly((2, 1));
        for (part, values, title, y) in [
            (&parts[0], &s.gap, "Gap", units.length("gap")),
            (&parts[1], &s.pressure, "Contact pressure", units.pressure("p")),
        ] {
            let points = in_order(mesh, values);
            let x = range(points.iter().map(|p| p.0));
            let mut chart = ChartBuilder::on(part)
                .caption(format!("{title}, t = {}", label(s.time)), (FONT, 18))
                .margin(10)
                .x_label_area_size(40)
                .y_label_area_size(75)
                .build_cartesian_2d(x.0..x.1, padded(range(values.iter().copied().chain([0.0]))))
                .map_err(failed)?;
            chart
                .configure_mesh()
                .light_line_style(WHITE)
                .x_desc(units.length("x"))
                .y_desc(y)
                .x_label_formatter(&|v| label(*v))
                .y_label_formatter(&|v| label(*v))
                .label_style((FONT, 14))
                .draw()
                .map_err(failed)?;
            chart
                .draw_series(AreaSeries::new(points, 0.0, MEMBRANE.mix(0.2)).border_style(MEMBRANE.stroke_width(2)))
                .map_err(failed)?;
        }
        Ok(())
    })
}

/// Residuals of all increments, relative to the tolerance.
fn convergence(steps: &[StepReport]) -> Result<String, OutputError> {
    let histories: Vec<Vec<(f64, f64)>> = steps
        .iter()
        .map(|s| {
            let list = s.residual_history.iter().enumerate();
            list.filter(|(_, v)| **v > 0.0).map(|(i, v)| (i as f64 + 1.0, *v)).collect()
        })
        .collect();
    let longest = histories.iter().flatten().map(|p| p.0).fold(2.0, f64::max);
    let (lo, hi) = histories.iter().flatten().map(|p| p.1).fold((0.1f64, 10.0f64), |(l, h), v| (l.min(v), h.max(v)));
    svg((820, 460), |root| {
        let mut chart = ChartBuilder::on(root)
            .caption("Convergence of the contact front", (FONT, 20))
            .margin(10)
            .x_label_area_size(45)
            .y_label_area_size(80)
            .build_cartesian_2d(1.0..longest, (0.5 * lo..2.0 * hi).log_scale())
            .map_err(failed)?;
        chart
            .configure_mesh()
            .light_line_style(WHITE)
            .x_desc("equilibrium solve")
            .y_desc("residual / tolerance")
            .x_labels(longest.min(12.0) as usize)
            .x_label_formatter(&|v| format!("{v:.0}"))
            .y_label_formatter(&|v| format!("{v:.0e}"))
            .label_style((FONT, 15))
            .draw()
            .map_err(failed)?;
        let count = histories.len();
        for (i, history) in histories.iter().enumerate() {
            let colour = viridis(0.85 * i as f64 / (count.max(2) - 1) as f64);
            chart.draw_series(LineSeries::new(history.iter().copied(), colour.stroke_width(2))).map_err(failed)?;
            chart.draw_series(history.iter().map(|p| Circle::new(*p, 4, colour.filled()))).map_err(failed)?;
        }
        chart
            .draw_series(LineSeries::new([(1.0, 1.0), (longest, 1.0)], FRONT.stroke_width(2)))
            .map_err(failed)
            .map(|_| ())
    })
}

/// What drives a membrane along its history: the resultant of the loads, or the height of a body.
struct Drive<'a> {
    at: Box<dyn Fn(f64) -> f64 + Sync + 'a>,
    label: String,
}

impl<'a> Drive<'a> {
    /// The first of the two that changes.
    fn of<const D: usize>(plan: &'a MembranePlan<D>, steps: &[StepReport], units: &Labels) -> Option<Self> {
        let load = move |t: f64| -plan.load_resultants(&plan.at(t), t).values().sum::<f64>();
        let moving = plan.contacts.iter().find(|c| !c.displacement.is_empty());
        let height = move |t: f64| moving.map_or(0.0, |c| c.displacement_at(t)[2]);
        let changes = |f: &dyn Fn(f64) -> f64| {
            let times = steps.iter().map(|s| s.time);
            let (low, high) = times.map(f).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
            high - low > 1e-12 * high.abs().max(low.abs())
        };
        if changes(&load) {
            Some(Self { at: Box::new(load), label: units.force("load, downwards") })
        } else if changes(&height) {
            let body = moving.map_or("", |c| c.body.as_str());
            Some(Self { at: Box::new(height), label: units.length(&format!("displacement of {body}")) })
        } else {
            None
        }
    }
}

/// Area and force over what drives the membrane, and without adhesion too: stable states filled, unstable ones open, jumps
/// as arrows.
fn loop_of_states(
    drive: &Drive,
    steps: &[StepReport],
    events: &[Event],
    contact: &str,
    space: Space,
    units: &Labels,
) -> Result<String, OutputError> {
    let measure = units.area(if space == Space::Line { "length of contact" } else { "area of contact" });
    type Reading = fn(&ContactReport) -> f64;
    let readings: [(Reading, fn(&Event) -> [f64; 2], String); 2] = [
        (|c| c.area, |e| [e.area_before, e.area_after], measure),
        (|c| c.force[2], |e| [e.force_before, e.force_after], units.force("contact force")),
    ];
    let jumps: Vec<&Event> = events.iter().filter(|e| e.energy_released.is_some_and(|v| v != 0.0)).collect();
    svg((820, 720), |root| {
        for (part, (read, ends, y)) in root.split_evenly((2, 1)).iter().zip(&readings) {
            let states: Vec<(f64, f64, bool, f64)> = steps
                .iter()
                .filter_map(|s| {
                    let c = s.contacts.get(contact)?;
                    Some(((drive.at)(s.time), read(c), c.stable != Some(false), s.time))
                })
                .collect();
            let arrows: Vec<[(f64, f64); 2]> = jumps.iter().map(|e| ends(e).map(|v| ((drive.at)(e.time), v))).collect();
            let all = || states.iter().map(|s| (s.0, s.1)).chain(arrows.iter().flatten().copied());
            let [wide, high] = [range(all().map(|p| p.0)), range(all().map(|p| p.1).chain([0.0]))];
            let mut chart = axes(part, &Axes { x: wide, y: high, x_name: &drive.label, y_name: y })?;
            // Between two states the path is a line, broken where it jumps.
            for pair in states.windows(2) {
                let (a, b) = (&pair[0], &pair[1]);
                let mut at = (a.0, a.1);
                for (event, [before, after]) in jumps.iter().zip(&arrows) {
                    if a.3 < event.time && event.time < b.3 {
                        chart.draw_series(LineSeries::new([at, *before], MEMBRANE.stroke_width(2))).map_err(failed)?;
                        at = *after;
                    }
                }
                chart.draw_series(LineSeries::new([at, (b.0, b.1)], MEMBRANE.stroke_width(2))).map_err(failed)?;
            }
            let (height, width) = (chart.y_range(), chart.x_range());
            let (dx, dy) = (0.006 * (width.end - width.start), 0.04 * (height.end - height.start));
            for [before, after] in &arrows {
                let down = if after.1 < before.1 { -1.0 } else { 1.0 };
                let tip = [(after.0 - dx, after.1 - down * dy), *after, (after.0 + dx, after.1 - down * dy)];
                chart.draw_series(LineSeries::new([*before, *after], FRONT.stroke_width(1))).map_err(failed)?;
                chart.draw_series(LineSeries::new(tip, FRONT.stroke_width(2))).map_err(failed)?;
            }
            let dot = |s: &(f64, f64, bool, f64), fill: ShapeStyle| Circle::new((s.0, s.1), 4, fill);
            chart.draw_series(states.iter().map(|s| dot(s, WHITE.filled()))).map_err(failed)?;
            chart
                .draw_series(
                    states.iter().map(|s| dot(s, if s.2 { MEMBRANE.filled() } else { MEMBRANE.stroke_width(1) })),
                )
                .map_err(failed)?;
        }
        Ok(())
    })
}

/// Area and force over time, with the changes of topology.
fn history(
    steps: &[StepReport],
    events: &[Event],
    contacts: &[&str],
    space: Space,
    units: &Labels,
) -> Result<String, OutputError> {
    // Changes at one time are one line.
    let mut marks: Vec<(f64, String)> = Vec::new();
    for Event { time, kind, .. } in events {
        let word = kind.words();
        match marks.last_mut() {
            Some((t, words)) if *t == *time => {
                if !words.contains(word) {
                    *words += &format!(", {word}");
                }
            }
            _ => marks.push((*time, word.into())),
        }
    }
    let series = |f: &dyn Fn(&ContactReport) -> f64| -> Vec<Vec<(f64, f64)>> {
        let of = |contact: &&str| steps.iter().filter_map(|s| Some((s.time, f(s.contacts.get(*contact)?)))).collect();
        contacts.iter().map(of).collect()
    };
    let area = series(&|c| c.area);
    let force = series(&|c| c.force[2]);
    let measure = units.area(if space == Space::Line { "length of contact" } else { "area of contact" });
    svg((820, 640), |root| {
        let parts = root.split_evenly((2, 1));
        for (part, points, y) in [(&parts[0], &area, measure), (&parts[1], &force, units.force("contact force"))] {
            let x = range(points.iter().flatten().map(|p| p.0));
            let height = range(points.iter().flatten().map(|p| p.1).chain([0.0]));
            let mut chart = axes(part, &Axes { x, y: height, x_name: "t", y_name: &y })?;
            let (low, high) = (chart.y_range().start, chart.y_range().end);
            let style = TextStyle::from((FONT, 12).into_font()).color(&FRONT).transform(FontTransform::Rotate90);
            for (time, words) in &marks {
                let line = [(*time, low), (*time, high)];
                chart.draw_series(LineSeries::new(line, FRONT.stroke_width(1))).map_err(failed)?;
                let text = Text::new(words.clone(), (*time, high), style.clone());
                chart.draw_series(std::iter::once(text)).map_err(failed)?;
            }
            for (k, (points, name)) in points.iter().zip(contacts).enumerate() {
                let colour = SERIES[k % SERIES.len()];
                chart.draw_series(points.iter().map(|p| Circle::new(*p, 4, colour.filled()))).map_err(failed)?;
                chart
                    .draw_series(LineSeries::new(points.iter().copied(), colour.stroke_width(2)))
                    .map_err(failed)?
                    .label(*name)
                    .legend(move |(x, y)| PathElement::new(vec![(x, y), (x + 20, y)], colour.stroke_width(3)));
            }
            if contacts.len() > 1 {
                chart
                    .configure_series_labels()
                    .label_font((FONT, 14))
                    .background_style(WHITE)
                    .draw()
                    .map_err(failed)?;
            }
        }
        Ok(())
    })
}
