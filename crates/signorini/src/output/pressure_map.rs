//! Maps of the pressure on a surface in space, with the rim of the zone of contact.

use super::OutputError;
use super::camera::{Camera, bounds, corners};
use super::chart::line;
use super::colours::{FREE, FRONT};
use super::labels::Labels;
use super::page::{Page, Scale, Sign};
use super::render::{Body, Look, Paint, insert};
use super::system::ContactShown;
use super::system_scene::{titled, width_for};
use crate::problem::Space;
use signorini_geometry::Vector;
use signorini_mechanics::ShownSurface;
use std::collections::BTreeMap;

/// Pressures below this part of the largest are drawn as none: a colour map does not tell them from zero.
const LEAST: f64 = 0.005;
/// Parts along the sides of a face that the rim crosses.
const FINE: usize = 8;
/// A node on the edge of a face is moved inwards by this part of the way to its middle, and points on the rim beside it by
/// this part of its pieces, where the sides of the rim are told apart.
const INWARDS: f64 = 1e-3;
/// What is seen around the zone of contact, as a part of its size.
const AROUND: f64 = 0.25;
/// The least size of a zone there, as a part of that of the surface.
const SMALLEST: f64 = 0.1;

/// Pressure on a surface where it is now, seen from outside. Beyond the rim of contact there is none.
///
/// # Errors
/// A page without area.
pub fn draw(contact: &ContactShown, surface: &ShownSurface, time: f64, labels: &Labels) -> Result<String, OutputError> {
    let map = Map::new(contact, surface);
    let window = map.window();
    // Along a coordinate axis where the surface is nearly across it.
    let mut towards = contact.outward().try_normalize(0.0).unwrap_or_else(Vector::<3>::z);
    let main = towards.iamax();
    if towards[main].abs() > 0.99 {
        let sign = towards[main].signum();
        towards = Vector::<3>::zeros();
        towards[main] = sign;
    }
    let above = if main == 2 { Vector::<3>::y() } else { Vector::<3>::z() };
    let box_corners: Vec<Vector<3>> = corners(window).collect();
    // The page takes the proportions of what is seen.
    let extent = Camera::new(&towards, &above, box_corners.iter(), [0.0, 0.0, 100.0, 100.0]).extent();
    let title = titled(&format!("Contact pressure of `{}`", contact.fields.name), time);
    let (width, height) = Page::size_for(extent);
    let mut page = Page::new((width.max(width_for(&title)), height), &title, "");
    let camera = Camera::new(&towards, &above, box_corners.iter(), page.room());
    insert(&mut page.svg, &map.bodies(&camera), &camera, Look::Map)?;
    for ends in &surface.boundary {
        line(&mut page.svg, &ends.map(|x| camera.at(&x)), FRONT);
    }
    camera.axes(&mut page.svg, window, labels.axes(Space::ThreeD).each_ref().map(String::as_str));
    page.bar(&Scale::between(0.0, map.most, map.most), &labels.pressure("p"));
    let mut key = Vec::new();
    if map.active.contains(&false) {
        key.push((Sign::Area(FREE), "no contact".to_string()));
    }
    if !surface.boundary.is_empty() {
        key.push((Sign::Line(FRONT), "boundary of contact".into()));
    }
    page.key(&key);
    Ok(page.finish())
}

/// The nodes of a surface with their pressures.
struct Map<'a> {
    surface: &'a ShownSurface,
    points: Vec<Vector<3>>,
    pressure: &'a [f64],
    active: Vec<bool>,
    most: f64,
}

impl<'a> Map<'a> {
    fn new(contact: &'a ContactShown, surface: &'a ShownSurface) -> Self {
        let pressure = contact.fields.array("contact_pressure").unwrap_or_default();
        let most = pressure.iter().fold(0.0f64, |m, p| m.max(*p));
        let count = contact.fields.points.len();
        Map {
            surface,
            points: (0..count).map(|k| contact.at(k)).collect(),
            pressure,
            active: (0..count).map(|k| contact.is_closed(k)).collect(),
            most,
        }
    }

    /// The zone of contact with its surroundings, within the surface.
    fn window(&self) -> [Vector<3>; 2] {
        let [low, high] = bounds(self.points.iter());
        // Where no rim is known the faces about single points are the zone.
        let about = self.surface.faces.iter().filter(|list| list.iter().any(|k| self.active[*k as usize])).flatten();
        let zone: Vec<Vector<3>> = match self.surface.boundary.is_empty() {
            true => about.map(|k| self.points[*k as usize]).collect(),
            false => self.points.iter().zip(&self.active).filter(|(_, closed)| **closed).map(|(x, _)| *x).collect(),
        };
        if zone.is_empty() {
            return [low, high];
        }
        let [from, to] = bounds(zone.iter());
        // A single point has no size.
        let pad = Vector::<3>::repeat(AROUND * (to - from).max().max(SMALLEST * (high - low).max()));
        [low.sup(&(from - pad)), high.inf(&(to + pad))]
    }

    /// The surface in contact, coloured by its pressure, and the rest of it.
    fn bodies(&self, camera: &Camera) -> Vec<Body> {
        let rims = self.rims(camera);
        let inner = self.inner();
        let relative: Vec<f64> = self.pressure.iter().map(|p| p / self.most.max(f64::MIN_POSITIVE)).collect();
        // Without a rim of its own a face is where most of its nodes are; without any such face, where any is.
        let touching = |list: &[u32]| list.iter().filter(|k| self.active[**k as usize]).count();
        let is_most = |list: &[u32]| 2 * touching(list) > list.len();
        let is_known = !rims.is_empty() || self.surface.faces.iter().any(|list| is_most(list));
        let (mut whole, mut free, mut cut) = (Vec::new(), Vec::new(), Cut::new());
        for (list, face) in self.surface.faces.iter().zip(&self.surface.of_face) {
            let Some(&within) = inner.get(face) else {
                free.push(list.as_slice());
                continue;
            };
            match rims.get(face) {
                Some(rim) => cut.add((list, within), rim, self, &relative, camera),
                None if is_most(list) || (!is_known && touching(list) > 0) => whole.push(list.as_slice()),
                None => free.push(list.as_slice()),
            }
        }
        let [beyond, inside] = cut.sides(camera);
        // Without a rim the zone ends where the pressure does.
        let whole = Body::of_polygons(self.points.clone(), whole.into_iter(), Paint::Field(relative));
        let free = Body::of_polygons(self.points.clone(), free.into_iter(), Paint::Plain(FREE));
        vec![free, plain(beyond), inside, plain(whole.clipped(|_, p| LEAST - p)), whole.clipped(|_, p| p - LEAST)]
    }

    /// The pieces of the rim on every face, as they are seen.
    fn rims(&self, camera: &Camera) -> BTreeMap<usize, Vec<[[f64; 2]; 2]>> {
        let mut rims: BTreeMap<usize, Vec<[[f64; 2]; 2]>> = BTreeMap::new();
        for (ends, face) in self.surface.boundary.iter().zip(&self.surface.boundary_face) {
            rims.entry(*face).or_default().push(ends.map(|x| seen(camera, &x)));
        }
        rims
    }

    /// The node of every face with the largest pressure, which is in contact where any is.
    fn inner(&self) -> BTreeMap<usize, u32> {
        let mut inner: BTreeMap<usize, u32> = BTreeMap::new();
        for (list, face) in self.surface.faces.iter().zip(&self.surface.of_face) {
            for &k in list.iter().filter(|k| self.active[**k as usize]) {
                let best = inner.entry(*face).or_insert(k);
                if self.pressure[k as usize] > self.pressure[*best as usize] {
                    *best = k;
                }
            }
        }
        inner
    }
}

fn plain(body: Body) -> Body {
    Body { paint: Paint::Plain(FREE), ..body }
}

/// Where a point is seen.
fn seen(camera: &Camera, x: &Vector<3>) -> [f64; 2] {
    [camera.right.dot(x), camera.up.dot(x)]
}

/// Faces that the rim crosses, divided, with the distance of every point to the rim: positive in the zone.
struct Cut {
    points: Vec<Vector<3>>,
    triangles: Vec<[u32; 3]>,
    relative: Vec<f64>,
    distances: Vec<f64>,
}

impl Cut {
    fn new() -> Self {
        Cut { points: Vec::new(), triangles: Vec::new(), relative: Vec::new(), distances: Vec::new() }
    }

    /// Adds a face; `within` is a node in contact.
    fn add(
        &mut self,
        (list, within): (&[u32], u32),
        rim: &[[[f64; 2]; 2]],
        map: &Map<'_>,
        relative: &[f64],
        camera: &Camera,
    ) {
        let centre = list.iter().map(|&k| map.points[k as usize]).sum::<Vector<3>>() / list.len() as f64;
        // The rim ends on the edges of faces: within them it is crossed or not.
        let node = map.points[within as usize];
        let rim = directed(rim, seen(camera, &(node + (centre - node) * INWARDS)));
        let first = self.points.len() as u32;
        // Triangles are quadrilaterals with two corners in one.
        let corner = |k: usize| list[k.min(list.len() - 1)] as usize;
        for k in 0..=FINE * FINE + 2 * FINE {
            let (s, t) = ((k % (FINE + 1)) as f64 / FINE as f64, (k / (FINE + 1)) as f64 / FINE as f64);
            let w = [(1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t];
            let x: Vector<3> = (0..4).map(|c| map.points[corner(c)] * w[c]).sum();
            self.distances.push(signed_distance(&rim, seen(camera, &x)));
            self.relative.push((0..4).map(|c| relative[corner(c)] * w[c]).sum());
            self.points.push(x);
        }
        let number = |i: usize, j: usize| first + (j * (FINE + 1) + i) as u32;
        for (i, j) in (0..FINE * FINE).map(|k| (k % FINE, k / FINE)) {
            let [a, b, c, d] = [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)];
            self.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }

    /// What is beyond the rim, and what is in the zone.
    fn sides(self, camera: &Camera) -> [Body; 2] {
        let beyond: Vec<f64> = self.distances.iter().map(|d| -d).collect();
        let body = Body {
            points: self.points,
            normals: vec![[camera.towards; 3]; self.triangles.len()],
            triangles: self.triangles,
            paint: Paint::Field(self.relative),
            opacity: 1.0,
        };
        [body.above(&beyond), body.above(&self.distances)]
    }
}

/// A piece of the rim, and the direction across it that leads into the zone.
type Directed = ([[f64; 2]; 2], [f64; 2]);

/// The distance of a point to the rim, positive in the zone.
fn signed_distance(rim: &[Directed], at: [f64; 2]) -> f64 {
    let nearest = rim.iter().map(|(piece, inwards)| (distance(at, *piece), piece[0], inwards));
    let nearest = nearest.min_by(|p, q| p.0.total_cmp(&q.0));
    nearest.map_or(0.0, |(away, on, inwards)| {
        let side = (at[0] - on[0]) * inwards[0] + (at[1] - on[1]) * inwards[1];
        away.copysign(side)
    })
}

/// Pieces of the rim within a face, each with the direction across it that leads into the zone: from there a point in the
/// zone is reached without crossing the rim, or by crossing it an even number of times.
pub fn directed(rim: &[[[f64; 2]; 2]], inside: [f64; 2]) -> Vec<Directed> {
    let long = rim.iter().filter(|[a, b]| a != b);
    long.map(|&[a, b]| {
        let across = [a[1] - b[1], b[0] - a[0]];
        let beside = [0, 1].map(|k| 0.5 * (a[k] + b[k]) + INWARDS * across[k]);
        let crossed = rim.iter().filter(|piece| crosses([beside, inside], **piece)).count();
        ([a, b], if crossed % 2 == 0 { across } else { across.map(|v| -v) })
    })
    .collect()
}

/// Whether two pieces of lines cross.
fn crosses([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> bool {
    let side =
        |p: [f64; 2], q: [f64; 2], r: [f64; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]) > 0.0;
    side(a, b, c) != side(a, b, d) && side(c, d, a) != side(c, d, b)
}

/// The distance of a point to a piece of a line.
pub fn distance(x: [f64; 2], [a, b]: [[f64; 2]; 2]) -> f64 {
    let (along, from) = ([b[0] - a[0], b[1] - a[1]], [x[0] - a[0], x[1] - a[1]]);
    let length = (along[0] * along[0] + along[1] * along[1]).max(f64::MIN_POSITIVE);
    let t = ((along[0] * from[0] + along[1] * from[1]) / length).clamp(0.0, 1.0);
    (from[0] - t * along[0]).hypot(from[1] - t * along[1])
}
