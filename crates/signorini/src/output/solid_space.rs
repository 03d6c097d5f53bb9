//! Pictures of solids in space: the deformed bodies and the rigid ones, a cut through the largest pressure, and maps of the
//! pressure.

use super::OutputError;
use super::camera::Camera;
use super::chart::{label, line, rounded};
use super::labels::Labels;
use super::level::{level, surface};
use super::page::{Page, SIZE, Scale, Sign};
use super::render::{Body, Look, Paint};
use super::solid_fields::ContactDisplay;
use super::solid_state::{FREE, FRONT, Gap, RIGID, State, axis_names, bounds, insert, spatial};
use crate::problem::Space;
use signorini_geometry::Vector;
use std::collections::BTreeMap;

/// Rigid bodies are drawn this far beyond the solids, as a part of their largest extent.
const AROUND: f64 = 0.15;
/// How much a rigid body hides of what is behind it.
const VEIL: f64 = 0.4;
/// The same in a cut, where it is behind the solids or below.
const OPAQUE: f64 = 0.95;
/// Pressures below this part of the largest are drawn as none: a colour map does not tell them from zero.
const LEAST: f64 = 0.005;
/// Parts along the sides of a face that the rim crosses.
const FINE: usize = 8;
/// A node on the edge of a face is moved inwards by this part of the way to its middle, and points on the rim beside it by
/// this part of its pieces, where the sides of the rim are told apart.
const INWARDS: f64 = 1e-3;

/// The surfaces of the rigid bodies around a box.
fn sheets<const D: usize>(state: &State<D>, [low, high]: [Vector<3>; 2]) -> Vec<Body> {
    let pad = Vector::<3>::repeat(AROUND * (high - low).max());
    let sheet = |(_, gap): &(String, Gap)| {
        let (points, normals, triangles) = surface(gap, [low - pad, high + pad]);
        let normals = triangles.iter().map(|t| t.map(|k| normals[k as usize])).collect();
        Body { points, triangles, normals, paint: Paint::Plain(RIGID), opacity: VEIL }
    };
    state.tools.iter().map(sheet).collect()
}

/// The corners of a box.
fn corners([low, high]: [Vector<3>; 2]) -> Vec<Vector<3>> {
    let ends = [low, high];
    (0..8).map(|c| Vector::<3>::from_fn(|k, _| ends[c >> k & 1][k])).collect()
}

/// A page with bodies seen from a side, the axes of a box, names and the colour bar; what is seen is what bodies have, or a
/// box that stays the same through a film.
fn page<const D: usize>(
    state: &State<D>,
    title: &str,
    bodies: &[Body],
    towards: Vector<3>,
    frame: [Vector<3>; 2],
    seen: Option<[Vector<3>; 2]>,
) -> Result<String, OutputError> {
    let mut page = Page::new(SIZE, title, &state.note);
    let inner = page.room();
    // Room for the axes below and to the left.
    let area = [inner[0] + 26.0, inner[1], inner[2] - 10.0, inner[3] - 6.0];
    let points: Vec<Vector<3>> = match seen {
        Some(seen) => corners(seen),
        None => bodies.iter().flat_map(Body::seen).copied().collect(),
    };
    let camera = Camera::new(&towards, &Vector::<3>::z(), points.iter(), area);
    let look = if seen.is_some() { Look::Film } else { Look::Solid };
    state.draw(&mut page, bodies, &camera, look, frame)?;
    state.name_bodies(&mut page, &camera);
    Ok(page.finish())
}

/// Whether contacts look down, so that they are seen from below.
pub fn look_down<const D: usize>(contacts: &[ContactDisplay<D>]) -> bool {
    contacts.iter().map(|c| mean_normal(c).z).sum::<f64>() < 0.0
}

/// All bodies, from above or below; through a film what is seen is a box.
///
/// # Errors
/// A page without area.
pub fn whole<const D: usize>(
    state: &State<D>,
    from_below: bool,
    seen: Option<[Vector<3>; 2]>,
) -> Result<String, OutputError> {
    let towards = Vector::<3>::new(1.0, -1.6, if from_below { -0.9 } else { 0.9 });
    let frame = bounds(state.moved.iter());
    let bodies: Vec<Body> = state.solids.iter().cloned().chain(sheets(state, seen.unwrap_or(frame))).collect();
    page(state, &state.title, &bodies, towards, frame, seen)
}

/// The half of everything behind a plane through the largest pressure, along the normal of the contact there and a
/// coordinate axis; none where nothing touches.
///
/// # Errors
/// A page without area.
pub fn cut<const D: usize>(state: &State<D>, contacts: &[ContactDisplay<D>]) -> Result<Option<String>, OutputError> {
    let mut best: Option<(f64, Vector<3>, Vector<3>)> = None;
    for shown in contacts {
        for (k, p) in shown.pressure.iter().enumerate().filter(|(_, p)| **p > 0.0) {
            // The first of those that are equal but for rounding.
            if best.as_ref().is_none_or(|b| *p > b.0 * (1.0 + 1e-6)) {
                best = Some((*p, spatial(&(shown.points[k] + shown.displacement[k])), mean_normal(shown)));
            }
        }
    }
    let Some((_, place, normal)) = best else { return Ok(None) };
    // Across the axis that is not that of the contact, the second horizontal one rather than the first.
    let axis = [1, 0, 2].into_iter().find(|&k| k != normal.iamax()).unwrap_or(1);
    let [low, high] = bounds(state.moved.iter());
    let side = if high[axis] - place[axis] >= place[axis] - low[axis] { 1.0 } else { -1.0 };
    let height = |x: &Vector<3>| side * (x[axis] - place[axis]);
    let across: Vec<f64> = state.moved.iter().map(height).collect();
    let mut bodies: Vec<Body> = state.solids.iter().map(|b| b.clipped(|x, _| height(x))).collect();
    let mut outwards = Vector::<3>::zeros();
    outwards[axis] = -side;
    for number in 0..state.plan.bodies.len() {
        let own = state.display.tetrahedra().filter(|t| state.display.body[t[0] as usize] as usize == number);
        let (edges, triangles) = level(own, |k| across[k as usize]);
        let mix = |&(a, b, t): &(u32, u32, f64)| state.moved[a as usize] * (1.0 - t) + state.moved[b as usize] * t;
        let colour =
            |&(a, b, t): &(u32, u32, f64)| state.colours[a as usize] * (1.0 - t) + state.colours[b as usize] * t;
        bodies.push(Body {
            points: edges.iter().map(mix).collect(),
            normals: vec![[outwards; 3]; triangles.len()],
            triangles,
            paint: Paint::Field(edges.iter().map(colour).collect()),
            opacity: 1.0,
        });
    }
    let kept: Vec<Vector<3>> = bodies.iter().flat_map(Body::seen).copied().collect();
    for body in sheets(state, [low, high]) {
        bodies.push(Body { opacity: OPAQUE, ..body.clipped(|x, _| height(x)) });
    }
    let mut towards = outwards;
    let aside = [0, 1, 2].into_iter().find(|&k| k != axis && k < 2).unwrap_or(0);
    towards[aside] += 0.45;
    towards.z += 0.35;
    let name = ["x", "y", "z"][axis];
    let title = format!("{}, cut at {name} = {}", state.title, label(rounded(place[axis], high[axis] - low[axis])));
    page(state, &title, &bodies, towards, bounds(kept.iter()), None).map(Some)
}

/// The area normal of the part in contact, or of the whole slave side where nothing touches.
fn mean_normal<const D: usize>(shown: &ContactDisplay<D>) -> Vector<3> {
    let touching = |f: &Vec<u32>| f.iter().any(|&k| shown.active[k as usize]);
    let any = shown.faces.iter().any(touching);
    (shown.faces.iter().filter(|f| !any || touching(f)))
        .map(|face| {
            let x = |k: usize| spatial(&shown.points[face[k] as usize]);
            (x(1) - x(0)).cross(&(x(face.len() - 1) - x(0)))
        })
        .sum()
}

/// Pressure on the slave side where it is now, seen from outside. Beyond the rim of contact there is none.
///
/// # Errors
/// A page without area.
pub fn pressure<const D: usize>(
    name: &str,
    time: f64,
    shown: &ContactDisplay<D>,
    labels: &Labels,
) -> Result<String, OutputError> {
    let points: Vec<Vector<3>> = shown.points.iter().zip(&shown.displacement).map(|(x, u)| spatial(&(x + u))).collect();
    let zone: Vec<Vector<3>> = (0..points.len()).filter(|&k| shown.active[k]).map(|k| points[k]).collect();
    let [low, high] = bounds(points.iter());
    let window = if zone.is_empty() {
        [low, high]
    } else {
        // A quarter of the zone's size around it, within the side.
        let [from, to] = bounds(zone.iter());
        let pad = Vector::<3>::repeat(0.25 * (to - from).max());
        [low.sup(&(from - pad)), high.inf(&(to + pad))]
    };
    // Along a coordinate axis where the side is nearly across it.
    let mut towards = mean_normal(shown).try_normalize(0.0).unwrap_or_else(Vector::<3>::z);
    let main = towards.iamax();
    if towards[main].abs() > 0.99 {
        let sign = towards[main].signum();
        towards = Vector::<3>::zeros();
        towards[main] = sign;
    }
    let above = if main == 2 { Vector::<3>::y() } else { Vector::<3>::z() };
    let box_corners = corners(window);
    // The page takes the proportions of what is seen.
    let wide = Camera::new(&towards, &above, box_corners.iter(), [0.0, 0.0, 100.0, 100.0]).area;
    let title = format!("Contact pressure of `{name}`, t = {}", label(time));
    let mut page = Page::new(Page::size_for([wide[2] - wide[0], wide[3] - wide[1]]), &title, "");
    let camera = Camera::new(&towards, &above, box_corners.iter(), page.room());
    let most = shown.pressure.iter().fold(0.0f64, |m, p| m.max(*p));
    insert(&mut page.svg, &sides(shown, points, most, &camera), &camera, Look::Map)?;
    for ends in &shown.boundary {
        line(&mut page.svg, &ends.map(|x| camera.at(&spatial(&x))), FRONT);
    }
    camera.axes(&mut page.svg, window, axis_names(Space::ThreeD, labels).each_ref().map(String::as_str));
    page.bar(&Scale::between(0.0, most, most), &labels.pressure("p"));
    let mut key = Vec::new();
    if shown.active.contains(&false) {
        key.push((Sign::Area(FREE), "no contact".to_string()));
    }
    if !shown.boundary.is_empty() {
        key.push((Sign::Line(FRONT), "boundary of contact".into()));
    }
    page.key(&key);
    Ok(page.finish())
}

/// The slave side in contact, coloured by its pressure, and the rest of it. Faces that the rim crosses are divided, and cut
/// where the distance to the rim changes its sign.
fn sides<const D: usize>(shown: &ContactDisplay<D>, points: Vec<Vector<3>>, most: f64, camera: &Camera) -> Vec<Body> {
    let flat = |x: &Vector<3>| [camera.right.dot(x), camera.up.dot(x)];
    let mut rims: BTreeMap<usize, Vec<[[f64; 2]; 2]>> = BTreeMap::new();
    for (ends, face) in shown.boundary.iter().zip(&shown.boundary_face) {
        rims.entry(*face).or_default().push(ends.map(|x| flat(&spatial(&x))));
    }
    // The node of every face with the largest pressure, which is in contact where any is.
    let mut inner: BTreeMap<usize, u32> = BTreeMap::new();
    for (list, face) in shown.faces.iter().zip(&shown.of_face) {
        for &k in list.iter().filter(|k| shown.active[**k as usize]) {
            let best = inner.entry(*face).or_insert(k);
            if shown.pressure[k as usize] > shown.pressure[*best as usize] {
                *best = k;
            }
        }
    }
    let relative: Vec<f64> = shown.pressure.iter().map(|p| p / most.max(f64::MIN_POSITIVE)).collect();
    let (mut whole, mut free, mut cut) = (Vec::new(), Vec::new(), Body::empty(Paint::Field(Vec::new())));
    let mut distances: Vec<f64> = Vec::new();
    for (list, face) in shown.faces.iter().zip(&shown.of_face) {
        let (Some(&within), rim) = (inner.get(face), rims.get(face)) else {
            free.push(list.as_slice());
            continue;
        };
        let Some(rim) = rim else {
            // Without a rim of its own a face is where most of its nodes are.
            let touching = list.iter().filter(|k| shown.active[**k as usize]).count();
            if 2 * touching > list.len() { &mut whole } else { &mut free }.push(list.as_slice());
            continue;
        };
        let centre = list.iter().map(|&k| points[k as usize]).sum::<Vector<3>>() / list.len() as f64;
        // The rim ends on the edges of faces: within them it is crossed or not.
        let node = points[within as usize];
        let rim = directed(rim, flat(&(node + (centre - node) * INWARDS)));
        let first = cut.points.len() as u32;
        // Triangles are quadrilaterals with two corners in one.
        let corner = |k: usize| list[k.min(list.len() - 1)] as usize;
        for k in 0..=FINE * FINE + 2 * FINE {
            let (s, t) = ((k % (FINE + 1)) as f64 / FINE as f64, (k / (FINE + 1)) as f64 / FINE as f64);
            let w = [(1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t];
            let x: Vector<3> = (0..4).map(|c| points[corner(c)] * w[c]).sum();
            let at = flat(&x);
            let nearest = rim.iter().map(|(piece, inwards)| (distance(at, *piece), piece[0], inwards));
            let nearest = nearest.min_by(|p, q| p.0.total_cmp(&q.0));
            distances.push(nearest.map_or(0.0, |(away, on, inwards)| {
                let side = (at[0] - on[0]) * inwards[0] + (at[1] - on[1]) * inwards[1];
                away.copysign(side)
            }));
            if let Paint::Field(values) = &mut cut.paint {
                values.push((0..4).map(|c| relative[corner(c)] * w[c]).sum());
            }
            cut.points.push(x);
        }
        let number = |i: usize, j: usize| first + (j * (FINE + 1) + i) as u32;
        for (i, j) in (0..FINE * FINE).map(|k| (k % FINE, k / FINE)) {
            let [a, b, c, d] = [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)];
            cut.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    cut.normals = vec![[camera.towards; 3]; cut.triangles.len()];
    let beyond: Vec<f64> = distances.iter().map(|d| -d).collect();
    // Without a rim the zone ends where the pressure does.
    let whole = Body::of_polygons(points.clone(), whole.into_iter(), Paint::Field(relative));
    let free = Body::of_polygons(points, free.into_iter(), Paint::Plain(FREE));
    let plain = |body: Body| Body { paint: Paint::Plain(FREE), ..body };
    vec![
        free,
        plain(cut.above(&beyond)),
        cut.above(&distances),
        plain(whole.clipped(|_, p| LEAST - p)),
        whole.clipped(|_, p| p - LEAST),
    ]
}

/// Pieces of the rim within a face, each with the direction across it that leads into the zone: from there a point in the
/// zone is reached without crossing the rim, or by crossing it an even number of times.
pub fn directed(rim: &[[[f64; 2]; 2]], inside: [f64; 2]) -> Vec<([[f64; 2]; 2], [f64; 2])> {
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
