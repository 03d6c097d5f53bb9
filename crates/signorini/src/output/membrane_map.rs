//! Pictures of membranes in the plane: a field as colours, with the fronts of contact and the rim of the membrane.

use super::OutputError;
use super::camera::Camera;
use super::chart::{Image, label, line, range, viridis, word};
use super::labels::Labels;
use super::page::{Page, Scale, Sign, css};
use super::render::MAP;
use crate::exact;
use crate::plan::MembranePlan;
use crate::snapshot::{DisplayMesh, Snapshot};
use plotters::style::RGBColor;
use signorini_geometry::{Point, Vector, polygon};
use std::collections::BTreeSet;
use std::fmt::Write as _;

const FRONT: RGBColor = RGBColor(213, 60, 40);
const EXACT: RGBColor = RGBColor(20, 20, 20);
pub const FREE: RGBColor = RGBColor(228, 228, 228);
/// Pixels of the raster per unit of the page: twice as many as those of the PNG.
const DENSITY: f64 = MAP;
/// Numbers of zones are written into them where these are this wide on the page, and beside them otherwise.
const ROOMY: f64 = 34.0;

/// A field to be drawn.
pub struct Field<'a> {
    pub values: &'a [f64],
    pub title: &'a str,
    /// Its letter, with the unit.
    pub name: String,
    pub scale: Scale,
    /// Whether it is one of the contact alone, jumps at the fronts, and is not drawn elsewhere.
    pub of_contact: bool,
}

/// The range of the gap, below which rounding of the deflection is none.
pub fn gap_scale<const D: usize>(s: &Snapshot<D>) -> Scale {
    let size = s.displacement.iter().fold(0.0f64, |m, u| m.max(u.abs()));
    let (low, high) = ends(&s.gap);
    Scale::between(low, high, size)
}

/// The range of values.
pub fn own_scale(values: &[f64]) -> Scale {
    let (low, high) = ends(values);
    Scale::between(low, high, 0.0)
}

fn ends(values: &[f64]) -> (f64, f64) {
    let finite = || values.iter().copied().filter(|v| v.is_finite());
    if finite().next().is_none() {
        (0.0, 0.0)
    } else {
        finite().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)))
    }
}

/// A field as a colour map, with the contact outlined; the exact front too where it is known and wanted.
///
/// # Errors
/// A raster without area.
pub fn map<const D: usize>(
    plan: &MembranePlan<D>,
    mesh: &DisplayMesh<D>,
    s: &Snapshot<D>,
    field: &Field,
    compared: bool,
    labels: &Labels,
) -> Result<String, OutputError> {
    map_dense(plan, mesh, s, field, (compared, DENSITY), labels)
}

/// The same with so many pixels of the raster per unit of the page; without the comparison for frames of films.
///
/// # Errors
/// A raster without area.
pub fn map_dense<const D: usize>(
    plan: &MembranePlan<D>,
    mesh: &DisplayMesh<D>,
    s: &Snapshot<D>,
    field: &Field,
    (compared, density): (bool, f64),
    labels: &Labels,
) -> Result<String, OutputError> {
    let flat = |p: &Point<D>| Vector::<3>::new(p[0], p[D - 1], 0.0);
    let corners = (mesh.points.iter().map(flat))
        .fold([Vector::<3>::repeat(f64::INFINITY), Vector::<3>::repeat(f64::NEG_INFINITY)], |[l, h], x| {
            [l.inf(&x), h.sup(&x)]
        });
    let extent = corners[1] - corners[0];
    let title = format!("{}, t = {}", field.title, label(s.time));
    let mut page = Page::new(Page::size_for([extent.x, extent.y]), &title, "");
    let camera = Camera::of_plane(&corners, page.room());
    let [left, top, right, bottom] = camera.area;
    let at = |p: &Point<D>| camera.at(&flat(p));
    let pixels = |length: f64| (length * density).round().max(1.0) as u32;
    let mut image = Image::new(pixels(right - left), pixels(bottom - top))?;
    let place = |p: &Point<D>| {
        let (x, y) = at(p);
        Point::<2>::new((x - left) * density, (y - top) * density)
    };
    fill(&mut image, mesh, s, field, place);
    if density < DENSITY {
        image.insert_for_now(&mut page.svg, (left, right), (top, bottom))?;
    } else {
        image.insert(&mut page.svg, (left, right), (top, bottom))?;
    }
    rim(&mut page.svg, mesh, at);
    camera.axes(&mut page.svg, corners, ["x", "y", "z"].map(|n| labels.length(n)).each_ref().map(String::as_str));
    for front in &s.fronts() {
        line(&mut page.svg, &front.iter().map(at).collect::<Vec<_>>(), FRONT);
    }
    let mut key = Vec::new();
    if !s.outlines.is_empty() {
        key.push((Sign::Line(FRONT), "contact front".to_string()));
    }
    if let Some(radius) = exact::of(plan, s.time).filter(|_| compared).and_then(|e| e.contact_radius()) {
        let (x, y) = camera.at(&((corners[0] + corners[1]) * 0.5));
        let _ = write!(
            page.svg,
            "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{:.2}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\" stroke-dasharray=\"7 6\"/>",
            radius * camera.scale,
            css(EXACT)
        );
        key.push((Sign::Dashes(EXACT), "exact front".into()));
    }
    if field.of_contact {
        key.push((Sign::Area(FREE), "no contact".into()));
    }
    if !(field.of_contact && s.outlines.is_empty()) {
        page.bar(&field.scale, &field.name);
    }
    page.key(&key);
    number_zones(&mut page.svg, s, at, camera.area);
    Ok(page.finish())
}

/// The rim of the membrane: edges that one cell has.
fn rim<const D: usize>(svg: &mut String, mesh: &DisplayMesh<D>, at: impl Fn(&Point<D>) -> (f64, f64)) {
    let mut once: BTreeSet<(u32, u32)> = BTreeSet::new();
    for cell in &mesh.cells {
        for k in 0..cell.len() {
            let (a, b) = (cell[k], cell[(k + 1) % cell.len()]);
            let edge = (a.min(b), a.max(b));
            if a != b && !once.remove(&edge) {
                once.insert(edge);
            }
        }
    }
    let mut path = String::new();
    for (a, b) in once {
        let [(x, y), (u, v)] = [a, b].map(|k| at(&mesh.points[k as usize]));
        let _ = write!(path, "M{x:.2} {y:.2}L{u:.2} {v:.2}");
    }
    let _ = write!(svg, "<path d=\"{path}\" stroke=\"#222\" stroke-width=\"1.2\" stroke-linecap=\"round\"/>");
}

/// Numbers zones as the summary lists them, where there are several: in their middle, or beside those too small for it.
fn number_zones<const D: usize>(
    svg: &mut String,
    s: &Snapshot<D>,
    at: impl Fn(&Point<D>) -> (f64, f64),
    [left, _, right, _]: [f64; 4],
) {
    let flat = |o: &Vec<Point<D>>| o.iter().map(|p| Point::<2>::new(p[0], p[D - 1])).collect::<Vec<_>>();
    let zones: Vec<&Vec<Point<D>>> = s.outlines.iter().filter(|o| polygon::signed_area(&flat(o)) > 0.0).collect();
    if zones.len() < 2 {
        return;
    }
    for (k, outline) in zones.iter().enumerate() {
        let places: Vec<(f64, f64)> = outline.iter().map(&at).collect();
        let x = range(places.iter().map(|p| p.0));
        let y = range(places.iter().map(|p| p.1));
        let (middle, centre) = (0.5 * (x.0 + x.1), 0.5 * (y.0 + y.1));
        let roomy = (x.1 - x.0).min(y.1 - y.0) > ROOMY;
        let beside = if x.1 + 14.0 < right || x.0 - 14.0 < left { x.1 + 14.0 } else { x.0 - 14.0 };
        word(svg, if roomy { (middle, centre) } else { (beside, centre) }, &(k + 1).to_string(), FRONT);
    }
}

/// Paints the cells of the display mesh, even within triangles. What jumps at the fronts is taken from the side that a pixel
/// is on.
pub fn fill<const D: usize>(
    image: &mut Image,
    mesh: &DisplayMesh<D>,
    s: &Snapshot<D>,
    field: &Field,
    place: impl Fn(&Point<D>) -> Point<2>,
) {
    let (w, h) = (image.width(), image.height());
    let outlines: Vec<Vec<Point<2>>> = s.outlines.iter().map(|o| o.iter().map(&place).collect()).collect();
    let touches = |x: &Point<2>| outlines.iter().map(|o| polygon::winding_number(o, x)).sum::<i32>() != 0;
    let triangles = mesh.cells.iter().flat_map(|cell| (2..cell.len()).map(|k| [cell[0], cell[k - 1], cell[k]]));
    for corners in triangles {
        let [a, b, c] = corners.map(|i| place(&mesh.points[i as usize]));
        let twice = |p: &Point<2>, q: &Point<2>, r: &Point<2>| (q - p).perp(&(r - p));
        let whole = twice(&a, &b, &c);
        if whole == 0.0 {
            continue;
        }
        let (low, high) = (a.inf(&b).inf(&c), a.sup(&b).sup(&c));
        let contact = corners.map(|i| s.in_contact[i as usize]);
        let divided = field.of_contact && contact.iter().any(|c| *c != contact[0]);
        for y in low.y.floor().max(0.0) as usize..(high.y.ceil() as usize).min(h) {
            for x in low.x.floor().max(0.0) as usize..(high.x.ceil() as usize).min(w) {
                let at = Point::<2>::new(x as f64 + 0.5, y as f64 + 0.5);
                let mut shares = [twice(&at, &b, &c), twice(&a, &at, &c), twice(&a, &b, &at)].map(|s| s / whole);
                if !shares.iter().all(|s| *s >= -1e-9) {
                    continue;
                }
                let mut touching = contact[0];
                if divided {
                    // Only what is on the same side of the front says anything.
                    touching = touches(&at);
                    let own = shares.iter().zip(contact).filter(|(_, c)| *c == touching).map(|(s, _)| s).sum::<f64>();
                    if own > 0.0 {
                        let keep = |(s, c): (&mut f64, bool)| *s = if c == touching { *s / own } else { 0.0 };
                        shares.iter_mut().zip(contact).for_each(keep);
                    }
                }
                let v: f64 = shares.iter().zip(&corners).map(|(s, &i)| s * field.values[i as usize]).sum();
                let colour = if field.of_contact && !touching { FREE } else { viridis(field.scale.place(v)) };
                image.set(x, y, colour);
            }
        }
    }
}
