//! What contacts of a system carry, as it is drawn: lines of force or traction at the tested points, and charts along them.

use super::camera::{Camera, bounds};
use super::chart::{label, line, viridis};
use super::colours::FRONT;
use super::labels::Labels;
use super::page::{Page, Sign, three_digits};
use super::panel::{Axis, Dots, Panel};
use super::system::{ContactShown, SystemShown};
use crate::problem::Space;
use crate::report::TractionKind;
use signorini_geometry::Vector;

/// The largest force or traction of a contact is drawn as a line of this part of the extent of the picture.
const LONGEST: f64 = 0.12;
/// At most so many lines for a contact.
const LINES: usize = 40;
/// Least distance of the feet of two lines, which are this wide with what sets them off.
const APART: f64 = 8.0;
/// Status of a point that slips, as files have it.
const SLIPS: f64 = 2.0;
/// Tested points face one way where their normals are within 60 degrees of the mean.
const ONE_WAY: f64 = 0.5;
/// A zone is flat, and has no inside, below this share of its width to its length.
const FLAT: f64 = 0.5;
const WIDTH: f64 = 900.0;
const NORMAL: f64 = 0.3;
const FRICTION: f64 = 0.7;

impl ContactShown {
    /// What a tested point carries: a force, or per length or area, pressure and friction together.
    fn carried(&self, k: usize) -> Vector<3> {
        let of = |name: &str| {
            self.fields
                .array(name)
                .map_or(Vector::<3>::zeros(), |v| Vector::<3>::from_column_slice(&v[3 * k..3 * k + 3]))
        };
        let value = |name: &str| self.fields.array(name).map_or(0.0, |v| v[k]);
        let traction = of("normal") * value("contact_pressure") + of("friction_traction");
        if self.carries == TractionKind::Force { traction * value("weight") } else { traction }
    }

    /// The force at a tested point.
    pub fn force(&self, k: usize) -> Vector<3> {
        let weight = self.fields.array("weight").filter(|_| self.carries != TractionKind::Force).map_or(1.0, |w| w[k]);
        self.carried(k) * weight
    }

    /// The points that touch.
    pub fn closed(&self) -> Vec<usize> {
        let pressure = self.fields.array("contact_pressure").unwrap_or_default();
        (0..pressure.len()).filter(|&k| pressure[k] > 0.0).collect()
    }

    fn slips(&self, k: usize) -> bool {
        self.fields.array("friction_status").is_some_and(|s| s[k] == SLIPS)
    }

    /// Whether a tested point touches.
    pub fn is_closed(&self, k: usize) -> bool {
        self.fields.array("contact_status").is_some_and(|s| s[k] > 0.0)
    }

    /// To where the first body looks, of any length: on the whole where it touches, or everywhere where it touches nothing.
    pub fn outward(&self) -> Vector<3> {
        if let Some(normals) = self.face_normals() {
            return normals;
        }
        let Some(normals) = self.fields.array("normal") else { return Vector::<3>::zeros() };
        let any = (0..self.fields.points.len()).any(|k| self.is_closed(k));
        let counted = (0..self.fields.points.len()).filter(|&k| !any || self.is_closed(k));
        -counted.map(|k| Vector::<3>::from_column_slice(&normals[3 * k..3 * k + 3])).sum::<Vector<3>>()
    }

    /// The area of faces along their normals.
    fn face_normals(&self) -> Option<Vector<3>> {
        let faces = &self.surface.as_ref()?.faces;
        let touches = |face: &&Vec<u32>| face.iter().any(|&k| self.is_closed(k as usize));
        let any = faces.iter().any(|face| touches(&face));
        let normal = |face: &Vec<u32>| {
            let x = |k: usize| self.at(face[k] as usize);
            (x(1) - x(0)).cross(&(x(face.len() - 1) - x(0)))
        };
        Some(faces.iter().filter(|face| !any || touches(face)).map(normal).sum())
    }

    /// Where a tested point is.
    pub fn at(&self, k: usize) -> Vector<3> {
        Vector::<3>::from(self.fields.points[k])
    }

    /// The name of what is carried, with its unit.
    fn unit(&self, labels: &Labels, what: &str) -> String {
        match self.carries {
            TractionKind::Force => labels.force(what),
            TractionKind::LineLoad => labels.force_per_length(what),
            TractionKind::Pressure => labels.pressure(what),
        }
    }
}

/// Lines of the key for contacts.
const MOST_KEYS: usize = 6;

/// Draws for every contact what the first body carries, dots where it slips, and tells for the key how much that is. The
/// pressure of surfaces is shown otherwise.
pub fn draw(
    page: &mut Page,
    shown: &SystemShown,
    camera: &Camera,
    extent: f64,
    labels: &Labels,
) -> Vec<(Sign, String)> {
    let mut key: Vec<(Sign, String)> = Vec::new();
    let mut slips = false;
    let largest = |c: &ContactShown| c.closed().iter().map(|&k| c.carried(k).norm()).fold(0.0, f64::max);
    let drawn: Vec<(&ContactShown, f64)> = (shown.contacts.iter())
        .filter(|c| c.surface.is_none())
        .map(|c| (c, largest(c)))
        .filter(|(_, most)| *most > 0.0)
        .collect();
    // Many have one scale and one line of the key.
    let many = drawn.len() > MOST_KEYS;
    for &(contact, own) in &drawn {
        let closed = contact.closed();
        let is_alike = |(other, _): &&(&ContactShown, f64)| many && other.carries == contact.carries;
        let alike: Vec<f64> = drawn.iter().filter(is_alike).map(|(_, most)| *most).collect();
        let most = alike.iter().fold(own, |most, other| most.max(*other));
        let mut feet: Vec<(f64, f64)> = Vec::new();
        for &k in closed.iter().step_by(closed.len().div_ceil(LINES)) {
            let x = contact.at(k);
            let ends = [x, x + contact.carried(k) * (LONGEST * extent / most)].map(|x| camera.at(&x));
            let [(a, b), (c, d)] = ends;
            if feet.iter().any(|(x, y)| (x - a).hypot(y - b) < APART) {
                continue;
            }
            feet.push((a, b));
            // Seen on any colour.
            page.svg += &format!("<path d=\"M{a:.2} {b:.2}L{c:.2} {d:.2}\" stroke=\"white\" stroke-width=\"5\"/>");
            line(&mut page.svg, &ends, viridis(0.15));
            if contact.slips(k) {
                slips = true;
                Sign::Dot(FRONT).draw(&mut page.svg, a - 11.0, b);
            }
        }
        let on = match shown.contacts.len() {
            1 => "contact".to_string(),
            _ if alike.len() > 1 => format!("{} contacts", alike.len()),
            _ => contact.fields.name.clone(),
        };
        let what = match contact.carries {
            TractionKind::Force => format!("forces on {on}"),
            TractionKind::LineLoad => format!("force per length on {on}"),
            TractionKind::Pressure => format!("traction on {on}"),
        };
        let told = contact.unit(labels, &format!("{what}, up to {}", three_digits(most)));
        if key.iter().all(|(_, known)| *known != told) {
            key.push((Sign::Line(viridis(0.15)), told));
        }
    }
    if slips {
        key.push((Sign::Dot(FRONT), "slips".into()));
    }
    key
}

/// Tested points of a contact in order: how far along they are, and the points; what that length is called.
struct Order {
    places: Vec<(f64, usize)>,
    name: String,
}

/// Points of a curve are in order; those of a surface in the plane are taken along it.
fn order(contact: &ContactShown, plane: Option<Space>, labels: &Labels) -> Option<Order> {
    let points: Vec<Vector<3>> = (0..contact.fields.points.len()).map(|k| contact.at(k)).collect();
    if !contact.fields.cells.is_empty() && points.len() > 2 {
        let mut length = 0.0;
        let along = points.windows(2).map(|pair| {
            length += (pair[1] - pair[0]).norm();
            length
        });
        let places = std::iter::once(0.0).chain(along).zip(0..).collect();
        return Some(Order { places, name: labels.length("length along the contact points") });
    }
    let closed = contact.closed();
    let space = plane.filter(|_| contact.carries == TractionKind::Pressure && closed.len() >= 3)?;
    let along = Along::of(contact, space, labels);
    let mut places: Vec<(f64, usize)> = closed.iter().map(|&k| (along.place(&points[k]), k)).collect();
    places.sort_by(|a, b| a.0.total_cmp(&b.0));
    Some(Order { places, name: along.name })
}

/// How far along a surface in the plane something is, and what that is called: along the axis that the points in contact
/// extend along most, or around their middle where they lie about it.
pub struct Along {
    pub name: String,
    way: Way,
}

enum Way {
    Axis(usize),
    About(Vector<3>),
}

/// Half a turn.
const HALF: f64 = 180.0;

impl Along {
    pub fn of(contact: &ContactShown, space: Space, labels: &Labels) -> Self {
        let closed = contact.closed();
        let all: Vec<usize> = if closed.is_empty() { (0..contact.fields.points.len()).collect() } else { closed };
        let points: Vec<Vector<3>> = all.iter().map(|&k| contact.at(k)).collect();
        let [low, high] = bounds(points.iter());
        let (size, count) = (high - low, points.len().max(1) as f64);
        let normals = contact.fields.array("normal").unwrap_or_default();
        let normal = |k: usize| Vector::<3>::from_column_slice(&normals[3 * k..3 * k + 3]);
        let mean = all.iter().map(|&k| normal(k)).sum::<Vector<3>>() / count;
        let one_way = all.iter().all(|&k| normal(k).dot(&mean) >= ONE_WAY * mean.norm()) && mean.norm() > ONE_WAY;
        let is_flat = size.x.min(size.y) < FLAT * size.x.max(size.y);
        if one_way || is_flat || contact.closed().is_empty() {
            let axis = usize::from(size.y > size.x);
            return Along { name: labels.axes(space)[axis].clone(), way: Way::Axis(axis) };
        }
        let middle = points.iter().sum::<Vector<3>>() / count;
        Along { name: "angle about the centre [°]".into(), way: Way::About(middle) }
    }

    pub fn place(&self, x: &Vector<3>) -> f64 {
        match self.way {
            Way::Axis(axis) => x[axis],
            Way::About(middle) => (x.y - middle.y).atan2(x.x - middle.x).to_degrees(),
        }
    }

    /// Whether two places near each other are so along the surface too: not where a turn ends.
    pub fn is_near(&self, [a, b]: &[f64; 2]) -> bool {
        matches!(self.way, Way::Axis(_)) || (a - b).abs() < HALF
    }
}

/// What a contact of a curve, or of a surface in the plane, carries along its tested points; none for others.
pub fn chart(contact: &ContactShown, plane: Option<Space>, time: f64, labels: &Labels) -> Option<String> {
    let Order { places, name } = order(contact, plane, labels)?;
    let pressure = contact.fields.array("contact_pressure")?;
    let normal: Vec<(f64, f64)> = places.iter().map(|&(s, k)| (s, pressure[k])).collect();
    let size = |f: &[f64], k: usize| Vector::<3>::from_column_slice(&f[3 * k..3 * k + 3]).norm();
    let friction: Option<Vec<(f64, f64)>> =
        contact.fields.array("friction_traction").map(|f| places.iter().map(|&(s, k)| (s, size(f, k))).collect());
    let title = format!("Contact of `{}`, t = {}", contact.fields.name, label(time));
    let mut page = Page::new((WIDTH, 460.0), &title, "");
    let high = normal.iter().chain(friction.iter().flatten()).map(|p| p.1).fold(0.0f64, f64::max);
    let what =
        contact.unit(labels, if contact.carries == TractionKind::Pressure { "traction" } else { "force per length" });
    let range = (places.first()?.0, places.last()?.0);
    let (x, y) = (Axis::around(&name, range), Axis::from_zero(&what, (0.0, high)));
    let mut panel = Panel::new(&mut page.svg, [0.0, 46.0, WIDTH, 456.0], x, y);
    let colour = viridis;
    panel.line(&normal, Sign::Line(colour(NORMAL)), 2.0);
    let mut key = vec![(Sign::Line(colour(NORMAL)), "normal".to_string())];
    if let Some(friction) = &friction {
        panel.line(friction, Sign::Line(colour(FRICTION)), 2.0);
        key.push((Sign::Line(colour(FRICTION)), "friction".into()));
        let slipping: Vec<(f64, f64)> =
            friction.iter().zip(&places).filter(|(_, (_, k))| contact.slips(*k)).map(|(p, _)| *p).collect();
        if !slipping.is_empty() {
            panel.dots(&slipping, FRONT, 3.0, Dots::Full);
            key.push((Sign::Dot(FRONT), "slips".into()));
        }
    }
    panel.key(&key);
    Some(page.finish())
}
