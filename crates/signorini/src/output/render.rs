//! Bodies in space as a raster: hidden surfaces by a depth buffer, light from above, colours that run evenly over faces,
//! outlines and creases, smoothed by more samples than pixels.

use super::OutputError;
use super::camera::Camera;
use super::chart::{Image, viridis};
use plotters::style::RGBColor;
use signorini_geometry::Vector;

/// Pixels of the raster per unit of the page, and samples per pixel along each side: a few more than those of the PNG where
/// edges are smoothed, and twice as many where edges are drawn as lines on top.
const fn density(look: Look) -> (f64, usize) {
    match look {
        Look::Solid => (1.5, 2),
        Look::Film => (1.0, 2),
        Look::Map => (MAP, 1),
        Look::FilmMap => (1.0, 1),
    }
}

/// Pixels of flat colours per unit of the page: twice those of the PNG along each side, where their edges are smoothed.
pub const MAP: f64 = 2.5;
/// Cosine of the angle between faces from which on their edge is drawn: 30 degrees.
const CREASE: f64 = 0.866;
/// Translucent bodies tint what they are in front of by more than this part of the picture's width, not what they touch.
const TOUCHING: f64 = 2e-3;

/// What a body is coloured by.
#[derive(Clone)]
pub enum Paint {
    Plain(RGBColor),
    /// Values from 0 to 1 at the points, on the colour map.
    Field(Vec<f64>),
}

/// A triangulated body.
#[derive(Clone)]
pub struct Body {
    pub points: Vec<Vector<3>>,
    pub triangles: Vec<[u32; 3]>,
    /// Unit normals at the corners of the triangles, to either side.
    pub normals: Vec<[Vector<3>; 3]>,
    pub paint: Paint,
    /// From 0 to 1; bodies with less than 1 are drawn in front of all others.
    pub opacity: f64,
}

impl Body {
    /// Nothing, to be coloured.
    pub fn empty(paint: Paint) -> Self {
        Body { points: Vec::new(), triangles: Vec::new(), normals: Vec::new(), paint, opacity: 1.0 }
    }

    /// A body of flat polygons, smooth across edges that are no creases.
    ///
    /// Quadrilaterals are divided about their middle, which no diagonal shows in.
    pub fn of_polygons<'a>(
        mut points: Vec<Vector<3>>,
        polygons: impl Iterator<Item = &'a [u32]>,
        mut paint: Paint,
    ) -> Self {
        let mut triangles: Vec<[u32; 3]> = Vec::new();
        for p in polygons {
            if let &[a, b, c, d] = p {
                let middle = points.len() as u32;
                points.push(p.iter().map(|&k| points[k as usize]).sum::<Vector<3>>() / 4.0);
                if let Paint::Field(values) = &mut paint {
                    values.push(p.iter().map(|&k| values[k as usize]).sum::<f64>() / 4.0);
                }
                triangles.extend([[a, b, middle], [b, c, middle], [c, d, middle], [d, a, middle]]);
            } else {
                triangles.extend((2..p.len()).map(|k| [p[0], p[k - 1], p[k]]));
            }
        }
        let x = |k: u32| &points[k as usize];
        let areas: Vec<Vector<3>> = triangles.iter().map(|t| (x(t[1]) - x(t[0])).cross(&(x(t[2]) - x(t[0])))).collect();
        let mut around: Vec<Vec<usize>> = vec![Vec::new(); points.len()];
        for (k, t) in triangles.iter().enumerate() {
            t.iter().for_each(|&p| around[p as usize].push(k));
        }
        let normal = |k: usize, p: u32| {
            let smooth = |l: &&usize| areas[k].dot(&areas[**l]) >= CREASE * areas[k].norm() * areas[**l].norm();
            let sum: Vector<3> = around[p as usize].iter().filter(smooth).map(|&l| areas[l]).sum();
            sum.try_normalize(0.0).unwrap_or_else(Vector::<3>::zeros)
        };
        let normals = triangles.iter().enumerate().map(|(k, t)| t.map(|p| normal(k, p))).collect();
        Body { points, triangles, normals, paint, opacity: 1.0 }
    }

    /// The points that triangles have.
    pub fn seen(&self) -> impl Iterator<Item = &Vector<3>> {
        self.triangles.iter().flatten().map(|&k| &self.points[k as usize])
    }

    /// The part where a function of the points and of the field, taken to be even between the points, is not negative.
    /// The field of a plain body is zero.
    pub fn clipped(&self, height: impl Fn(&Vector<3>, f64) -> f64) -> Self {
        let field = |k: usize| if let Paint::Field(values) = &self.paint { values[k] } else { 0.0 };
        let heights: Vec<f64> = self.points.iter().enumerate().map(|(k, x)| height(x, field(k))).collect();
        self.above(&heights)
    }

    /// The part where a function, known at the points and even between them, is not negative.
    pub fn above(&self, heights: &[f64]) -> Self {
        let field = |k: usize| if let Paint::Field(values) = &self.paint { values[k] } else { 0.0 };
        let mut out = Body { triangles: Vec::new(), normals: Vec::new(), ..self.clone() };
        for (corners, normals) in self.triangles.iter().zip(&self.normals) {
            let mut kept: Vec<(u32, Vector<3>)> = Vec::new();
            for k in 0..3 {
                let (a, b) = (corners[k] as usize, corners[(k + 1) % 3] as usize);
                let (from, to) = (heights[a], heights[b]);
                if from >= 0.0 {
                    kept.push((corners[k], normals[k]));
                }
                if (from >= 0.0) != (to >= 0.0) {
                    let t = from / (from - to);
                    out.points.push(self.points[a] + (self.points[b] - self.points[a]) * t);
                    if let Paint::Field(values) = &mut out.paint {
                        values.push(field(a) + (field(b) - field(a)) * t);
                    }
                    kept.push((out.points.len() as u32 - 1, normals[k] + (normals[(k + 1) % 3] - normals[k]) * t));
                }
            }
            for k in 2..kept.len() {
                out.triangles.push([kept[0].0, kept[k - 1].0, kept[k].0]);
                out.normals.push([kept[0].1, kept[k - 1].1, kept[k].1]);
            }
        }
        out
    }
}

/// How a raster looks.
#[derive(Clone, Copy, PartialEq)]
pub enum Look {
    /// Lit from above, with outlines and creases.
    Solid,
    /// The same, coarser, for frames of films.
    Film,
    /// Colours as they are on the colour map.
    Map,
    /// The same, coarser, for frames of films.
    FilmMap,
}

impl Look {
    /// Whether colours are those of the colour map.
    fn is_map(self) -> bool {
        matches!(self, Look::Map | Look::FilmMap)
    }

    /// The same for frames of films.
    #[must_use]
    pub fn of_film(self) -> Self {
        if self.is_map() { Look::FilmMap } else { Look::Film }
    }
}

/// What is seen through a sample: the body, counted from one; zero where there is nothing.
#[derive(Clone, Copy, Default)]
struct Sample {
    depth: f32,
    body: u16,
    normal: [i8; 3],
    colour: [u8; 3],
    opacity: u8,
}

/// Draws bodies into the area of a camera, as a raster to be put into a page there.
///
/// # Errors
/// A page without area.
pub fn render(bodies: &[Body], camera: &Camera, look: Look) -> Result<Image, OutputError> {
    render_finer(bodies, camera, look, 1.0)
}

/// The same with `finer` times as many pixels along each side.
///
/// # Errors
/// A page without area.
pub fn render_finer(bodies: &[Body], camera: &Camera, look: Look, finer: f64) -> Result<Image, OutputError> {
    let [left, top, right, bottom] = camera.area;
    let (dense, samples) = density(look);
    let dense = dense * finer;
    let pixels = |length: f64| (length * dense).round().max(1.0) as usize;
    let (width, height) = (pixels(right - left), pixels(bottom - top));
    // The change of depth between samples of a surface at 80 degrees.
    let step = 6.0 / (camera.scale * dense * samples as f64);
    // What is translucent lies on a layer of its own.
    let mut layers: Vec<Vec<Sample>> = Vec::new();
    for translucent in [false, true] {
        let own = || bodies.iter().enumerate().filter(|(_, b)| (b.opacity < 1.0) == translucent);
        if translucent && own().next().is_none() {
            continue;
        }
        let mut layer = vec![Sample::default(); width * height * samples * samples];
        own().for_each(|(k, body)| {
            rasterise(&mut layer, width * samples, body, k as u16 + 1, camera, (look, dense * samples as f64))
        });
        layers.push(if look.is_map() { layer } else { without_cracks(layer, width * samples, samples, step as f32) });
    }
    let lines: Vec<Vec<bool>> = match look {
        Look::Solid | Look::Film => layers.iter().map(|layer| outlines(layer, width * samples, step as f32)).collect(),
        Look::Map | Look::FilmMap => vec![Vec::new(); layers.len()],
    };
    let touching = (TOUCHING * (right - left) / camera.scale) as f32;
    let mut image = Image::new(width as u32, height as u32)?;
    for y in 0..height {
        for x in 0..width {
            let mut sum = [0.0; 3];
            let place = |s: usize| (y * samples + s / samples) * width * samples + x * samples + s % samples;
            if (0..samples * samples).all(|s| layers.iter().all(|layer| layer[place(s)].body == 0)) {
                image.set(x, y, RGBColor(255, 255, 255));
                continue;
            }
            if let [layer] = &layers[..]
                && (0..samples * samples)
                    .all(|s| layer[place(s)].opacity == 255 && !lines[0].get(place(s)).is_some_and(|l| *l))
            {
                // Nothing but a surface.
                for s in 0..samples * samples {
                    (0..3).for_each(|k| sum[k] += f64::from(layer[place(s)].colour[k]));
                }
                let [r, g, b] = sum.map(|c: f64| (c / (samples * samples) as f64 + 0.5) as u8);
                image.set(x, y, RGBColor(r, g, b));
                continue;
            }
            for s in 0..samples * samples {
                let at = place(s);
                let mut colour = [255.0; 3];
                for (layer, lines) in layers.iter().zip(&lines) {
                    let sample = &layer[at];
                    let opaque = &layers[0][at];
                    let hidden = sample.opacity < 255 && opaque.body > 0 && sample.depth < opaque.depth + touching;
                    if sample.body == 0 || hidden {
                        continue;
                    }
                    let share = f64::from(sample.opacity) / 255.0;
                    let own = sample.colour.map(f64::from);
                    for k in 0..3 {
                        colour[k] += (own[k] - colour[k]) * share;
                    }
                    if !look.is_map() && lines[at] {
                        // Lines are light on dark colours.
                        let light = 0.3 * own[0] + 0.59 * own[1] + 0.11 * own[2];
                        let ink = if light < 80.0 { 235.0 } else { 25.0 };
                        colour.iter_mut().for_each(|c| *c += (ink - *c) * 0.7);
                    }
                }
                (0..3).for_each(|k| sum[k] += colour[k]);
            }
            let [r, g, b] = sum.map(|c| (c / (samples * samples) as f64 + 0.5) as u8);
            image.set(x, y, RGBColor(r, g, b));
        }
    }
    Ok(image)
}

/// Puts the raster of bodies into a page.
///
/// # Errors
/// A page without area.
pub fn insert(out: &mut String, bodies: &[Body], camera: &Camera, look: Look) -> Result<(), OutputError> {
    let [left, top, right, bottom] = camera.area;
    let image = render(bodies, camera, look)?;
    match look {
        Look::Film | Look::FilmMap => image.insert_for_now(out, (left, right), (top, bottom)),
        Look::Solid | Look::Map => image.insert(out, (left, right), (top, bottom)),
    }
}

/// Puts a body into a layer wherever it is in front.
///
/// The zoom is the number of samples per unit of the page.
fn rasterise(layer: &mut [Sample], width: usize, body: &Body, number: u16, camera: &Camera, (look, zoom): (Look, f64)) {
    let height = layer.len() / width;
    let place: Vec<[f64; 3]> = (body.points.iter())
        .map(|p| {
            let (x, y) = camera.at(p);
            [(x - camera.area[0]) * zoom, (y - camera.area[1]) * zoom, camera.towards.dot(p)]
        })
        .collect();
    let opacity = (255.0 * body.opacity).round() as u8;
    let light = (camera.towards + Vector::<3>::z() * 0.8 - camera.right * 0.4).normalize();
    for (corners, normals) in body.triangles.iter().zip(&body.normals) {
        let [a, b, c] = corners.map(|k| place[k as usize]);
        let twice =
            |p: [f64; 2], q: [f64; 3], r: [f64; 3]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
        let whole = twice([a[0], a[1]], b, c);
        if whole == 0.0 {
            continue;
        }
        let within = |k: usize, most: usize| {
            let low = a[k].min(b[k]).min(c[k]).floor().clamp(0.0, most as f64) as usize;
            let high = a[k].max(b[k]).max(c[k]).ceil().clamp(0.0, most as f64) as usize;
            low..high
        };
        for y in within(1, height) {
            for x in within(0, width) {
                let at = [x as f64 + 0.5, y as f64 + 0.5];
                let w = [twice(at, b, c), twice(at, c, a), twice(at, a, b)].map(|s| s / whole);
                if w.iter().any(|s| *s < -1e-6) {
                    continue;
                }
                let depth = (w[0] * a[2] + w[1] * b[2] + w[2] * c[2]) as f32;
                let sample = &mut layer[y * width + x];
                if sample.body > 0 && sample.depth >= depth {
                    continue;
                }
                let normal = normals[0] * w[0] + normals[1] * w[1] + normals[2] * w[2];
                let seen = normal.try_normalize(0.0).unwrap_or(camera.towards);
                let seen = if seen.dot(&camera.towards) < 0.0 { -seen } else { seen };
                let shade = if look.is_map() { 1.0 } else { 0.76 + 0.24 * seen.dot(&light) };
                let colour = match &body.paint {
                    Paint::Plain(colour) => *colour,
                    Paint::Field(values) => viridis((0..3).map(|k| w[k] * values[corners[k] as usize]).sum()),
                };
                *sample = Sample {
                    depth,
                    body: number,
                    normal: std::array::from_fn(|k| (seen[k] * 127.0 + 128.5) as u8 as i16 - 128).map(|n: i16| n as i8),
                    colour: [colour.0, colour.1, colour.2].map(|c| (f64::from(c) * shade + 0.5) as u8),
                    opacity,
                };
            }
        }
    }
}

/// A layer without slits of less than a pixel between parts of one smooth surface, where its faces do not fit: beside a
/// curved edge of a large face lie the straight edges of several smaller ones.
fn without_cracks(layer: Vec<Sample>, width: usize, most: usize, step: f32) -> Vec<Sample> {
    let height = layer.len() / width;
    let is_even = |p: &Sample, q: &Sample| {
        let cosine: i32 = (0..3).map(|i| i32::from(p.normal[i]) * i32::from(q.normal[i])).sum();
        f64::from(cosine) >= CREASE * 127.0 * 127.0
    };
    let fits = |p: &Sample, q: &Sample| {
        p.body > 0 && p.body == q.body && (p.depth - q.depth).abs() <= 2.0 * step && is_even(p, q)
    };
    // The samples before and behind a slit of at most so many samples along a line.
    let across = |k: usize, along: usize, at: usize, end: usize| {
        (1..=most).find_map(|width| {
            (1..=width).find_map(|before| {
                let after = width + 1 - before;
                if at < before || at + after >= end {
                    return None;
                }
                let (p, q) = (&layer[k - before * along], &layer[k + after * along]);
                // In a slit the background is seen, what is farther away, or a wall of the slit.
                let is_wall = |s: &Sample| s.depth <= p.depth.max(q.depth) && !is_even(s, p);
                let is_behind = |s: &Sample| s.body == 0 || s.depth < p.depth.min(q.depth) - step || is_wall(s);
                let slit = (1..before).map(|i| k - i * along).chain((0..after).map(|i| k + i * along));
                (p.body > 0 && fits(p, q) && slit.into_iter().all(|l| is_behind(&layer[l]))).then_some(*p)
            })
        })
    };
    // What goes on evenly to either side lies in no slit: of one that is two samples wide, a side is a neighbour.
    let goes_on = |k: usize, along: usize, at: usize, end: usize| {
        let s = &layer[k];
        let with = |t: &Sample| s.body == t.body && (s.body == 0 || (s.depth - t.depth).abs() <= step && is_even(s, t));
        at > 0 && at + 1 < end && with(&layer[k - along]) && with(&layer[k + along]) && most <= 2
    };
    (0..layer.len())
        .map(|k| {
            let (x, y) = (k % width, k / width);
            if goes_on(k, 1, x, width) && goes_on(k, width, y, height) {
                return layer[k];
            }
            across(k, 1, x, width).or_else(|| across(k, width, y, height)).unwrap_or(layer[k])
        })
        .collect()
}

/// Where something ends in front of something else, and where faces meet at an angle.
///
/// Within a body, depth jumps between two samples where it changes there by more than `step` beyond twice of what it does
/// on either side: on a smooth surface, however steep, neighbouring changes are alike.
fn outlines(layer: &[Sample], width: usize, step: f32) -> Vec<bool> {
    let change = |k: usize, l: usize| (layer[k].depth - layer[l].depth).abs();
    let differ = |k: usize, along: usize, before: bool, after: bool| {
        let (p, q) = (&layer[k], &layer[k + along]);
        if p.body != q.body {
            return true;
        }
        if p.body == 0 {
            return false;
        }
        let cosine: i32 = (0..3).map(|i| i32::from(p.normal[i]) * i32::from(q.normal[i])).sum();
        if f64::from(cosine) < CREASE * 127.0 * 127.0 {
            return true;
        }
        let within = |known: bool, a: usize, b: usize| {
            if known && layer[a].body == layer[b].body { change(a, b) } else { f32::INFINITY }
        };
        let beside = || within(before, k, k.wrapping_sub(along)).max(within(after, k + along, k + 2 * along));
        change(k, k + along) > step && change(k, k + along) > step + 2.0 * beside()
    };
    let height = layer.len() / width;
    (0..layer.len())
        .map(|k| {
            let (x, y) = (k % width, k / width);
            (x + 1 < width && differ(k, 1, x > 0, x + 2 < width))
                || (y + 1 < height && differ(k, width, y > 0, y + 2 < height))
        })
        .collect()
}
