//! Random shapes with an evaluator of their own: nothing here uses the code under test but its constructors.

use signorini_geometry::shape::{Axes, Curve, Shape, Surface};
use signorini_geometry::{Point, Vector};
use std::f64::consts::{FRAC_PI_2, TAU};

/// SplitMix64.
pub struct Random(pub u64);

impl Random {
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    pub fn below(&mut self, n: usize) -> usize {
        ((self.unit() * n as f64) as usize).min(n - 1)
    }

    pub fn vector(&mut self, size: f64) -> Vector<3> {
        Vector::<3>::from_fn(|_, _| self.between(-size, size))
    }

    fn axes(&mut self) -> Axes {
        loop {
            let (p, q) = (self.vector(1.0), self.vector(1.0));
            if p.norm() > 0.1 && p.cross(&q).norm() > 0.1 {
                let ex = p.normalize();
                let ey = (q - ex * q.dot(&ex)).normalize();
                return Axes::new(self.vector(0.5), ex, ey).unwrap();
            }
        }
    }
}

type Evaluator = Box<dyn Fn(f64, f64) -> Point<3> + Send + Sync>;

/// A shape with its own evaluator over a domain.
pub struct Sample {
    pub name: &'static str,
    pub shape: Shape,
    pub at: Evaluator,
    pub domain: [[f64; 2]; 2],
    pub triangle: bool,
}

impl Sample {
    fn curve(name: &'static str, curve: Curve, at: impl Fn(f64) -> Point<3> + Send + Sync + 'static) -> Self {
        let domain = [curve.domain(), [0.0; 2]];
        Sample { name, shape: curve.into(), at: Box::new(move |t, _| at(t)), domain, triangle: false }
    }

    fn surface(
        name: &'static str,
        surface: Surface,
        at: impl Fn(f64, f64) -> Point<3> + Send + Sync + 'static,
    ) -> Self {
        let (domain, triangle) = (surface.domain(), surface.is_triangle());
        Sample { name, shape: surface.into(), at: Box::new(at), domain, triangle }
    }

    pub fn point(p: Point<3>) -> Self {
        Sample {
            name: "point",
            shape: Shape::Point(p),
            at: Box::new(move |_, _| p),
            domain: [[0.0; 2]; 2],
            triangle: false,
        }
    }
}

/// Cox-de Boor by its definition, closed at the end of the domain.
fn basis(knots: &[f64], degree: usize, i: usize, t: f64) -> f64 {
    basis_in(knots, degree, i, t, knots[knots.len() - degree - 1])
}

fn basis_in(knots: &[f64], degree: usize, i: usize, t: f64, last: f64) -> f64 {
    if degree == 0 {
        let inside =
            if t == last { knots[i] < last && knots[i + 1] == last } else { knots[i] <= t && t < knots[i + 1] };
        return f64::from(u8::from(inside));
    }
    let mut value = 0.0;
    if knots[i + degree] > knots[i] {
        value += (t - knots[i]) / (knots[i + degree] - knots[i]) * basis_in(knots, degree - 1, i, t, last);
    }
    if knots[i + degree + 1] > knots[i + 1] {
        value += (knots[i + degree + 1] - t) / (knots[i + degree + 1] - knots[i + 1])
            * basis_in(knots, degree - 1, i + 1, t, last);
    }
    value
}

fn lagrange(n: usize, i: usize, x: f64) -> f64 {
    let node = |k: usize| -1.0 + 2.0 * k as f64 / (n - 1) as f64;
    (0..n).filter(|&j| j != i).map(|j| (x - node(j)) / (node(i) - node(j))).product()
}

fn clamped_knots(random: &mut Random, degree: usize, n: usize) -> Vec<f64> {
    let mut knots = vec![0.0; degree + 1];
    let mut t = 0.0;
    let mut repeats = 0;
    for _ in 0..n - degree - 1 {
        // Now and then a knot is repeated, down to mere continuity.
        if t > 0.0 && random.unit() < 0.15 && repeats < degree - 1 {
            repeats += 1;
        } else {
            t += random.between(0.3, 1.2);
            repeats = 0;
        }
        knots.push(t);
    }
    knots.extend(vec![t + 1.0; degree + 1]);
    knots
}

pub const CURVES: usize = 12;

pub fn curve(random: &mut Random, kind: usize) -> Sample {
    let axes = random.axes();
    let Axes { origin: o, ex, ey, ez } = axes;
    match kind {
        0 => {
            let (p, q) = (random.vector(1.0), random.vector(1.0));
            Sample::curve("segment", Curve::segment(p, q).unwrap(), move |t| p + (q - p) * t)
        }
        1 => {
            let r = random.between(0.3, 1.5);
            let closed = random.unit() < 0.5;
            let from = random.between(-4.0, 4.0);
            let range = [from, if closed { from + TAU } else { from + random.between(0.3, 6.0) }];
            let c = Curve::circle(axes, r, range, closed).unwrap();
            Sample::curve("circle", c, move |t| o + ex * (r * t.cos()) + ey * (r * t.sin()))
        }
        2 => {
            let (a, b) = (random.between(0.3, 1.5), random.between(0.3, 1.5));
            let closed = random.unit() < 0.5;
            let from = random.between(-4.0, 4.0);
            let range = [from, if closed { from + TAU } else { from + random.between(0.3, 6.0) }];
            let c = Curve::ellipse(axes, a, b, range, closed).unwrap();
            Sample::curve("ellipse", c, move |t| o + ex * (a * t.cos()) + ey * (b * t.sin()))
        }
        3 => {
            let k = random.between(-2.0, 2.0);
            let range = [random.between(-1.5, 0.0), random.between(0.1, 1.5)];
            let c = Curve::parabola(axes, k, range).unwrap();
            Sample::curve("parabola", c, move |t| o + ex * t + ey * (k * t * t))
        }
        4 => {
            let (r, c) = (random.between(0.3, 1.0), random.between(-0.4, 0.4));
            let from = random.between(-5.0, 0.0);
            let h = Curve::helix(axes, r, c, [from, from + random.between(1.0, 15.0)]).unwrap();
            Sample::curve("helix", h, move |t| o + ex * (r * t.cos()) + ey * (r * t.sin()) + ez * (c * t))
        }
        5 => {
            let n = 2 + random.below(8);
            let points: Vec<Point<3>> = (0..n).map(|_| random.vector(1.0)).collect();
            let weights: Vec<f64> = (0..n).map(|_| (random.between(-1.5, 1.5)).exp()).collect();
            let rational = random.unit() < 0.5;
            let b = Curve::bezier(&points, rational.then_some(&weights)).unwrap();
            Sample::curve("bezier", b, move |t| {
                let (mut sum, mut total, mut binomial) = (Vector::<3>::zeros(), 0.0, 1.0);
                for i in 0..n {
                    let w = if rational { weights[i] } else { 1.0 };
                    let value = w * binomial * t.powi(i as i32) * (1.0 - t).powi((n - 1 - i) as i32);
                    sum += points[i] * value;
                    total += value;
                    binomial *= (n - 1 - i) as f64 / (i + 1) as f64;
                }
                sum / total
            })
        }
        6 | 7 => {
            let degree = 1 + random.below(4);
            let n = degree + 1 + random.below(12);
            let knots = clamped_knots(random, degree, n);
            let points: Vec<Point<3>> = (0..n).map(|_| random.vector(1.0)).collect();
            let weights: Vec<f64> =
                (0..n).map(|_| if kind == 6 { 1.0 } else { random.between(-1.0, 1.0).exp() }).collect();
            let c = Curve::nurbs(degree, &knots, &points, (kind == 7).then_some(&weights), false).unwrap();
            Sample::curve("nurbs", c, move |t| {
                let (mut sum, mut total) = (Vector::<3>::zeros(), 0.0);
                for i in 0..n {
                    let value = weights[i] * basis(&knots, degree, i, t);
                    sum += points[i] * value;
                    total += value;
                }
                sum / total
            })
        }
        8 => {
            let n = 2 + random.below(5);
            let points: Vec<Point<3>> = (0..n).map(|_| random.vector(1.0)).collect();
            let closed = random.unit() < 0.5;
            let c = Curve::polyline(&points, closed).unwrap();
            Sample::curve("polyline", c, move |t| {
                let k = (t.floor() as usize).min(if closed { n - 1 } else { n - 2 });
                let s = t - k as f64;
                points[k] * (1.0 - s) + points[(k + 1) % n] * s
            })
        }
        9 => {
            let n = 2 + random.below(4);
            let points: Vec<Point<3>> = (0..n).map(|_| random.vector(1.0)).collect();
            let tangents: Vec<Vector<3>> = (0..n).map(|_| random.vector(1.5)).collect();
            let c = Curve::hermite(&points, &tangents).unwrap();
            Sample::curve("hermite", c, move |t| {
                let k = (t.floor() as usize).min(n - 2);
                let s = t - k as f64;
                points[k] * (1.0 - 3.0 * s * s + 2.0 * s.powi(3))
                    + tangents[k] * (s - 2.0 * s * s + s.powi(3))
                    + points[k + 1] * (3.0 * s * s - 2.0 * s.powi(3))
                    + tangents[k + 1] * (s.powi(3) - s * s)
            })
        }
        10 => {
            // A closed spline with uniform periodic knots.
            let (degree, n) = (3, 5 + random.below(6));
            let ring: Vec<Point<3>> = (0..n)
                .map(|k| {
                    let angle = TAU * k as f64 / n as f64;
                    Point::<3>::new(angle.cos(), angle.sin(), 0.0) + random.vector(0.3)
                })
                .collect();
            let points: Vec<Point<3>> = (0..n + degree).map(|k| ring[k % n]).collect();
            let knots: Vec<f64> = (0..n + 2 * degree + 1).map(|k| k as f64).collect();
            let c = Curve::nurbs(degree, &knots, &points, None, true).unwrap();
            Sample::curve("closed nurbs", c, move |t| {
                (0..points.len()).map(|i| points[i] * basis(&knots, degree, i, t)).sum()
            })
        }
        _ => {
            let n = 2 + random.below(4);
            let along = random.vector(1.0);
            let nodes: Vec<Point<3>> = (0..n).map(|k| along * k as f64 / n as f64 + random.vector(0.25)).collect();
            let c = Curve::lagrange(&nodes).unwrap();
            Sample::curve("lagrange", c, move |t| (0..n).map(|i| nodes[i] * lagrange(n, i, t)).sum())
        }
    }
}

pub const SURFACES: usize = 17;

pub fn surface(random: &mut Random, kind: usize) -> Sample {
    let axes = random.axes();
    let Axes { origin: o, ex, ey, ez } = axes;
    let full = random.unit() < 0.5;
    let from = random.between(-4.0, 4.0);
    let turn = [from, if full { from + TAU } else { from + random.between(0.3, 6.0) }];
    let length = [random.between(-1.0, 0.0), random.between(0.1, 1.0)];
    let span = if random.unit() < 0.5 {
        [-FRAC_PI_2, FRAC_PI_2]
    } else {
        [random.between(-FRAC_PI_2, 0.0), random.between(0.05, FRAC_PI_2)]
    };
    match kind {
        0 => {
            let range = [length, [random.between(-1.0, 0.0), random.between(0.1, 1.0)]];
            Sample::surface("plane", Surface::plane(axes, range).unwrap(), move |u, v| o + ex * u + ey * v)
        }
        1 => {
            let r = random.between(0.3, 1.2);
            let s = Surface::cylinder(axes, r, [turn, length], full).unwrap();
            Sample::surface("cylinder", s, move |u, v| o + ex * (r * u.cos()) + ey * (r * u.sin()) + ez * v)
        }
        2 => {
            let (sin, cos) = random.between(0.1, 1.4).sin_cos();
            let start = if random.unit() < 0.5 { 0.0 } else { random.between(0.1, 0.8) };
            let s = Surface::cone(axes, sin, cos, [turn, [start, start + random.between(0.3, 1.5)]], full).unwrap();
            Sample::surface("cone", s, move |u, v| o + (ex * u.cos() + ey * u.sin()) * (v * sin) + ez * (v * cos))
        }
        3 => {
            let r = random.between(0.3, 1.5);
            let s = Surface::sphere(axes, r, [turn, span], full).unwrap();
            Sample::surface("sphere", s, move |u, v| {
                o + (ex * u.cos() + ey * u.sin()) * (r * v.cos()) + ez * (r * v.sin())
            })
        }
        4 => {
            let [a, b, c] = [0; 3].map(|_| random.between(0.3, 1.5));
            let s = Surface::ellipsoid(axes, [a, b, c], [turn, span], full).unwrap();
            Sample::surface("ellipsoid", s, move |u, v| {
                o + ex * (a * v.cos() * u.cos()) + ey * (b * v.cos() * u.sin()) + ez * (c * v.sin())
            })
        }
        5 => {
            let (major, minor) = (random.between(0.5, 1.2), random.between(0.1, 0.7));
            let closed_v = random.unit() < 0.5;
            let start = random.between(-4.0, 4.0);
            let around = [start, if closed_v { start + TAU } else { start + random.between(0.5, 6.0) }];
            let s = Surface::torus(axes, major, minor, [turn, around], [full, closed_v]).unwrap();
            Sample::surface("torus", s, move |u, v| {
                o + (ex * u.cos() + ey * u.sin()) * (major + minor * v.cos()) + ez * (minor * v.sin())
            })
        }
        6 => {
            let [a, b, c] = [0; 3].map(|_| random.between(-1.5, 1.5));
            let range = [length, [random.between(-1.0, 0.0), random.between(0.1, 1.0)]];
            let s = Surface::graph(axes, [a, b, c], range).unwrap();
            Sample::surface("graph", s, move |u, v| o + ex * u + ey * v + ez * (a * u * u + b * v * v + c * u * v))
        }
        7 => {
            let (n, m) = (2 + random.below(4), 2 + random.below(4));
            let points = net(random, n, m, 0.4);
            let weights = table(random, n, m, 1.2);
            let rational = random.unit() < 0.5;
            let s = Surface::bezier(&points, rational.then_some(&weights)).unwrap();
            let bernstein = |n: usize, i: usize, t: f64| {
                let binomial: f64 = (0..i).map(|k| (n - 1 - k) as f64 / (k + 1) as f64).product();
                binomial * t.powi(i as i32) * (1.0 - t).powi((n - 1 - i) as i32)
            };
            Sample::surface("bezier", s, move |u, v| {
                let (mut sum, mut total) = (Vector::<3>::zeros(), 0.0);
                for i in 0..n {
                    for j in 0..m {
                        let w = if rational { weights[i][j] } else { 1.0 } * bernstein(n, i, u) * bernstein(m, j, v);
                        sum += points[i][j] * w;
                        total += w;
                    }
                }
                sum / total
            })
        }
        8 | 9 => {
            let degree = [1 + random.below(3), 1 + random.below(3)];
            let (n, m) = (degree[0] + 1 + random.below(5), degree[1] + 1 + random.below(5));
            let (ku, kv) = (clamped_knots(random, degree[0], n), clamped_knots(random, degree[1], m));
            let points = net(random, n, m, 0.3);
            let weights = table(random, n, m, if kind == 8 { 0.0 } else { 1.0 });
            let s = Surface::nurbs(degree, [&ku, &kv], &points, (kind == 9).then_some(&weights), [false; 2]).unwrap();
            Sample::surface("nurbs", s, move |u, v| {
                let along: Vec<f64> = (0..m).map(|j| basis(&kv, degree[1], j, v)).collect();
                let (mut sum, mut total) = (Vector::<3>::zeros(), 0.0);
                for i in 0..n {
                    let b = basis(&ku, degree[0], i, u);
                    for j in 0..m {
                        let w = weights[i][j] * b * along[j];
                        sum += points[i][j] * w;
                        total += w;
                    }
                }
                sum / total
            })
        }
        10 | 11 => {
            let n = kind - 8;
            let mut nodes = net(random, n, n, 0.35);
            if n == 2 && random.unit() < 0.2 {
                // A collapsed side.
                nodes[1][1] = nodes[0][1];
            }
            let s = Surface::lagrange_quad(&nodes).unwrap();
            Sample::surface("quad", s, move |u, v| {
                let mut sum = Vector::<3>::zeros();
                for i in 0..n {
                    for j in 0..n {
                        sum += nodes[i][j] * (lagrange(n, i, u) * lagrange(n, j, v));
                    }
                }
                sum
            })
        }
        12 => {
            let n: [Point<3>; 3] = [0; 3].map(|_| random.vector(1.0));
            Sample::surface("tri3", Surface::tri3(&n).unwrap(), move |u, v| n[0] * (1.0 - u - v) + n[1] * u + n[2] * v)
        }
        13 => {
            // A profile that may meet the axis.
            let touches = random.unit() < 0.3;
            let mut profile: Vec<Point<3>> =
                (0..4).map(|k| Point::<3>::new(0.6, 0.0, 0.5 * k as f64 - 0.7) + random.vector(0.4)).collect();
            if touches {
                profile[3] = Point::<3>::new(0.0, 0.0, 0.9);
            }
            let c = Curve::bezier(&profile, None).unwrap();
            let s = Surface::revolution(&c, Point::<3>::zeros(), Vector::<3>::z(), turn, full).unwrap();
            Sample::surface("revolution", s, move |u, v| {
                let w = 1.0 - v;
                let x = profile[0] * w.powi(3)
                    + profile[1] * (3.0 * w * w * v)
                    + profile[2] * (3.0 * w * v * v)
                    + profile[3] * v.powi(3);
                Point::<3>::new(x.x * u.cos() - x.y * u.sin(), x.x * u.sin() + x.y * u.cos(), x.z)
            })
        }
        14 => {
            let (n, m) = (4 + random.below(4), 4 + random.below(4));
            let heights: Vec<Vec<f64>> = (0..n).map(|_| (0..m).map(|_| random.between(-0.4, 0.4)).collect()).collect();
            let spacing = [random.between(0.2, 0.5), random.between(0.2, 0.5)];
            let s = Surface::height_field(axes, spacing, &heights, 1).unwrap();
            Sample::surface("height field", s, move |u, v| {
                let (a, b) = (u / spacing[0], v / spacing[1]);
                let (i, j) = ((a.floor() as usize).min(n - 2), (b.floor() as usize).min(m - 2));
                let (s, t) = (a - i as f64, b - j as f64);
                let h = heights[i][j] * (1.0 - s) * (1.0 - t)
                    + heights[i + 1][j] * s * (1.0 - t)
                    + heights[i][j + 1] * (1.0 - s) * t
                    + heights[i + 1][j + 1] * s * t;
                o + ex * u + ey * v + ez * h
            })
        }
        15 => {
            let n = 10;
            let c: [Point<3>; 3] = [0; 3].map(|_| random.vector(1.0));
            let mut nodes = Vec::with_capacity(n);
            for j in 0..4 {
                for i in 0..4 - j {
                    let (u, v) = (i as f64 / 3.0, j as f64 / 3.0);
                    nodes.push(c[0] * (1.0 - u - v) + c[1] * u + c[2] * v + random.vector(0.1));
                }
            }
            let s = Surface::lagrange_triangle(&nodes).unwrap();
            Sample::surface("tri10", s, move |u, v| {
                let factor = |k: usize, x: f64| (0..k).map(|m| (3.0 * x - m as f64) / (k - m) as f64).product::<f64>();
                let (mut sum, mut k) = (Vector::<3>::zeros(), 0);
                for j in 0..4 {
                    for i in 0..4 - j {
                        sum += nodes[k] * (factor(i, u) * factor(j, v) * factor(3 - i - j, 1.0 - u - v));
                        k += 1;
                    }
                }
                sum
            })
        }
        _ => {
            let c: [Point<3>; 3] = [0; 3].map(|_| random.vector(1.0));
            let mut middle = |p: Point<3>, q: Point<3>| (p + q) * 0.5 + random.vector(0.25);
            let n = [c[0], c[1], c[2], middle(c[0], c[1]), middle(c[1], c[2]), middle(c[2], c[0])];
            Sample::surface("tri6", Surface::tri6(&n).unwrap(), move |u, v| {
                let l = 1.0 - u - v;
                n[0] * (l * (2.0 * l - 1.0))
                    + n[1] * (u * (2.0 * u - 1.0))
                    + n[2] * (v * (2.0 * v - 1.0))
                    + n[3] * (4.0 * l * u)
                    + n[4] * (4.0 * u * v)
                    + n[5] * (4.0 * v * l)
            })
        }
    }
}

fn net(random: &mut Random, n: usize, m: usize, noise: f64) -> Vec<Vec<Point<3>>> {
    let at = |i: usize, n: usize| -1.0 + 2.0 * i as f64 / (n - 1) as f64;
    (0..n).map(|i| (0..m).map(|j| Point::<3>::new(at(i, n), at(j, m), 0.0) + random.vector(noise)).collect()).collect()
}

fn table(random: &mut Random, n: usize, m: usize, spread: f64) -> Vec<Vec<f64>> {
    (0..n).map(|_| (0..m).map(|_| random.between(-spread, spread).exp()).collect()).collect()
}
