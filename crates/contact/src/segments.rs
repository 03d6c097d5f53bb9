//! Where a slave surface faces its master: quadrature points on pieces of slave faces, each seeing one master face.
//!
//! The slave faces are cut along the edges of the master faces, so that no point is lost or counted twice and every
//! integrand is smooth. In the plane the pieces are intervals; in space they are polygons, cut in the plane of each
//! slave facet (Puso & Laursen 2004). The gap of a point is measured along the interpolated slave normal.

use crate::multiplier::PressureNodes;
use crate::surface::ContactSurface;
use signorini_fem::hierarchic::Values;
use signorini_fem::rules::{Rule, rule};
use signorini_fem::{CellShape, Local};
use signorini_geometry::bvh::Bvh;
use signorini_geometry::{Aabb, Matrix, Point, Vector};

/// A quadrature point of a slave face.
#[derive(Clone, Debug)]
pub struct GapPoint<const D: usize> {
    pub s: Local,
    /// Area that the point stands for.
    pub weight: f64,
    /// Face and point of the master; `None` for a rigid one.
    pub master: Option<(u32, Local)>,
    /// How the gap grows with the displacement of the slave point; that of the master point counts opposite.
    pub direction: Point<D>,
    pub gap: f64,
}

/// Breakpoints closer than this, in coordinates of the face, are one.
const SNAP: f64 = 1e-13;
/// Faces whose normals enclose less than 120 degrees do not face each other.
const FACING: f64 = -0.5;

/// The points of every slave face that see a master face no farther away than `reach`.
pub fn segments<const D: usize>(
    slave: &dyn ContactSurface<D>,
    master: &dyn ContactSurface<D>,
    nodes: &PressureNodes<D>,
    reach: f64,
) -> Vec<Vec<GapPoint<D>>> {
    let candidates = candidates(slave, master, nodes, reach);
    let cut = |face: usize, extra: usize| {
        let list = &candidates[face];
        if D == 2 {
            intervals(slave, master, nodes, face, list, reach, extra)
        } else {
            polygons(slave, master, nodes, face, list, reach, extra)
        }
    };
    let mut points: Vec<Vec<GapPoint<D>>> = (0..slave.face_count()).map(|face| cut(face, 0)).collect();
    // A constant pressure must load every function of both sides with its integral. On distorted faces the integrands
    // are no polynomials: more points are used as long as they help.
    let exact = [integrals(slave), integrals(master)];
    let mut before = defects(&points, slave, master, &exact);
    for extra in [2, 4, 8, 12] {
        let poor = |face: usize| {
            before[0][face] > ROUND_OFF
                || points[face].iter().any(|p| p.master.is_some_and(|(m, _)| before[1][m as usize] > ROUND_OFF))
        };
        let again: Vec<usize> = (0..points.len()).filter(|&f| !points[f].is_empty() && poor(f)).collect();
        if again.is_empty() {
            break;
        }
        for face in again {
            points[face] = cut(face, extra);
        }
        let now = defects(&points, slave, master, &exact);
        let helps = (0..2).any(|side| now[side].iter().zip(&before[side]).any(|(n, b)| *b > ROUND_OFF && *n < 0.2 * b));
        before = now;
        if !helps {
            break;
        }
    }
    points
}

/// Relative error of integrals that counts as rounding.
const ROUND_OFF: f64 = 1e-14;

/// Integrals of the functions of every face.
fn integrals<const D: usize>(surface: &dyn ContactSurface<D>) -> Vec<Vec<f64>> {
    let mut trace = Vec::new();
    (0..surface.face_count())
        .map(|face| {
            let mut out = Vec::new();
            for (s, w) in rule(surface.shape(face), surface.degree(face) + surface.order(face) + 4) {
                let point = surface.at(face, &s);
                let w = w * point.area_normal().norm() * surface.measure(&point.x);
                trace.clear();
                surface.trace(face, &s, &mut trace);
                out.resize(trace.len(), 0.0);
                out.iter_mut().zip(&trace).for_each(|(sum, (_, v))| *sum += w * v);
            }
            out
        })
        .collect()
}

/// For every slave and master face that is covered completely, the largest error of those integrals relative to its
/// area; zero for the others, of which nothing can be said.
fn defects<const D: usize>(
    points: &[Vec<GapPoint<D>>],
    slave: &dyn ContactSurface<D>,
    master: &dyn ContactSurface<D>,
    exact: &[Vec<Vec<f64>>; 2],
) -> [Vec<f64>; 2] {
    let mut sums = exact.clone();
    sums.iter_mut().flatten().flatten().for_each(|v| *v = 0.0);
    let mut trace = Vec::new();
    let mut add = |sums: &mut Vec<f64>, surface: &dyn ContactSurface<D>, face: usize, s: &Local, w: f64| {
        trace.clear();
        surface.trace(face, s, &mut trace);
        sums.iter_mut().zip(&trace).for_each(|(sum, (_, v))| *sum += w * v);
    };
    for (face, list) in points.iter().enumerate() {
        for p in list {
            add(&mut sums[0][face], slave, face, &p.s, p.weight);
            if let Some((other, eta)) = &p.master {
                add(&mut sums[1][*other as usize], master, *other as usize, eta, p.weight);
            }
        }
    }
    let worst = |sum: &Vec<f64>, exact: &Vec<f64>| {
        let scale = exact.iter().map(|v| v.abs()).sum::<f64>();
        let worst = sum.iter().zip(exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / scale;
        if worst < 1e-2 { worst } else { 0.0 }
    };
    std::array::from_fn(|side| sums[side].iter().zip(&exact[side]).map(|(s, e)| worst(s, e)).collect())
}

/// The points of every slave face against a rigid body: `gap` gives the distance of a point and the outward normal.
pub fn rigid_points<const D: usize>(
    slave: &dyn ContactSurface<D>,
    gap: &dyn Fn(&Point<D>) -> (f64, Point<D>),
) -> Vec<Vec<GapPoint<D>>> {
    (0..slave.face_count())
        .map(|face| {
            let n = slave.degree(face) + 2 + usize::from(slave.shape(face) == CellShape::Triangle);
            rule(slave.shape(face), n)
                .into_iter()
                .map(|(s, w)| {
                    let at = slave.at(face, &s);
                    let (gap, normal) = gap(&at.x);
                    let weight = w * at.area_normal().norm() * slave.measure(&at.x);
                    GapPoint { s, weight, master: None, direction: normal, gap }
                })
                .collect()
        })
        .collect()
}

/// Master faces that each slave face may see, by boxes swept along the normals.
fn candidates<const D: usize>(
    slave: &dyn ContactSurface<D>,
    master: &dyn ContactSurface<D>,
    nodes: &PressureNodes<D>,
    reach: f64,
) -> Vec<Vec<usize>> {
    let embed = |x: &Point<D>| Point::<3>::from_fn(|k, _| if k < D { x[k] } else { 0.0 });
    let bounds = |points: &[Point<3>], margin: f64| {
        let low = points.iter().fold(points[0], |l, p| l.inf(p));
        let high = points.iter().fold(points[0], |h, p| h.sup(p));
        let pad = Point::<3>::repeat(margin * (high - low).norm());
        Aabb::new(low - pad, high + pad)
    };
    let slave_boxes: Vec<Aabb<3>> = (0..slave.face_count())
        .map(|face| {
            let mut points = Vec::new();
            for (s, (_, normal)) in nodes.map(face).nodes().iter().zip(nodes.of_face(face)) {
                let x = slave.at(face, s).x;
                points.push(embed(&(x + normal * reach)));
                points.push(embed(&(x - normal * reach)));
            }
            bounds(&points, 1e-3)
        })
        .collect();
    let master_boxes: Vec<Aabb<3>> = (0..master.face_count())
        .map(|face| {
            let shape = master.shape(face);
            let mut points: Vec<Point<3>> = shape.vertices().iter().map(|s| embed(&master.at(face, s).x)).collect();
            points.push(embed(&master.at(face, &shape.centre()).x));
            bounds(&points, if master.order(face) > 1 { 0.3 } else { 1e-6 })
        })
        .collect();
    let mut lists = vec![Vec::new(); slave.face_count()];
    if slave_boxes.is_empty() || master_boxes.is_empty() {
        return lists;
    }
    let pairs = Bvh::new(&slave_boxes).pairs_within(&Bvh::new(&master_boxes), (&slave_boxes, &master_boxes), 0.0);
    for (i, j) in pairs {
        lists[i].push(j);
    }
    lists
}

fn cross2<const D: usize>(a: &Point<D>, b: &Point<D>) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// The coordinate of the slave face from whose point the normal passes through `x`.
fn onto_slave<const D: usize>(
    slave: &dyn ContactSurface<D>,
    nodes: &PressureNodes<D>,
    face: usize,
    x: &Point<D>,
    at: &mut Values,
) -> Option<f64> {
    let mut xi: f64 = 0.0;
    for _ in 0..60 {
        // Beyond its ends the face goes on straight, with the normal of the end: polynomials would swing.
        let inside = xi.clamp(-1.0, 1.0);
        let s = [inside, 0.0, 0.0];
        let point = slave.at(face, &s);
        let (normal, mut slopes) = nodes.normal(face, &s, at);
        if inside != xi {
            slopes[0] = Point::<D>::zeros();
        }
        let d = x - (point.x + point.tangents[0] * (xi - inside));
        let value = cross2(&d, &normal);
        let slope = -cross2(&point.tangents[0], &normal) + cross2(&d, &slopes[0]);
        let step = value / slope;
        if !step.is_finite() {
            return None;
        }
        let next = (xi - step).clamp(-3.0, 3.0);
        let moved = (next - xi).abs();
        xi = next;
        if moved < 1e-14 {
            break;
        }
    }
    Some(xi)
}

/// The point of a master face on the line through `x` along `normal`, and the distance along it.
fn onto_master<const D: usize>(
    master: &dyn ContactSurface<D>,
    face: usize,
    x: &Point<D>,
    normal: &Point<D>,
    start: Local,
) -> Option<(Local, f64)> {
    let mut eta = start;
    for _ in 0..60 {
        let point = master.at(face, &eta);
        let d = point.x - x;
        // Components across the normal vanish.
        let moved = if D == 2 {
            let step = cross2(&d, normal) / cross2(&point.tangents[0], normal);
            let next = (eta[0] - step).clamp(-3.0, 3.0);
            let moved = (next - eta[0]).abs();
            eta[0] = next;
            moved
        } else {
            let jacobian = Matrix::<3>::from_columns(&[
                Vector::<3>::from_fn(|k, _| point.tangents[0][k]),
                Vector::<3>::from_fn(|k, _| point.tangents[1][k]),
                Vector::<3>::from_fn(|k, _| -normal[k]),
            ]);
            let step = signorini_fem::small::inverse(&jacobian) * Vector::<3>::from_fn(|k, _| d[k]);
            let mut moved = 0.0f64;
            for k in 0..2 {
                let next = (eta[k] - step[k]).clamp(-3.0, 3.0);
                moved = moved.max((next - eta[k]).abs());
                eta[k] = next;
            }
            moved
        };
        if moved.is_nan() {
            return None;
        }
        if moved < 1e-14 {
            break;
        }
    }
    Some((eta, (master.at(face, &eta).x - x).dot(normal)))
}

/// Both gaps are differences of coordinates: what rounding leaves of a closed gap is none.
fn snapped(gap: f64, magnitude: f64) -> f64 {
    if gap.abs() <= 64.0 * f64::EPSILON * magnitude { 0.0 } else { gap }
}

fn intervals<const D: usize>(
    slave: &dyn ContactSurface<D>,
    master: &dyn ContactSurface<D>,
    nodes: &PressureNodes<D>,
    face: usize,
    candidates: &[usize],
    reach: f64,
    extra: usize,
) -> Vec<GapPoint<D>> {
    let mut at = Values::default();
    let mut spans = Vec::new();
    let mut breaks = vec![-1.0, 1.0];
    let own = slave.at(face, &[0.0; 3]).area_normal().normalize();
    for &other in candidates {
        if own.dot(&master.at(other, &[0.0; 3]).area_normal().normalize()) > FACING {
            continue;
        }
        let ends = [-1.0, 1.0].map(|e| onto_slave(slave, nodes, face, &master.at(other, &[e, 0.0, 0.0]).x, &mut at));
        let [Some(p), Some(q)] = ends else { continue };
        let span = [p.min(q), p.max(q)];
        if span[1] <= -1.0 || span[0] >= 1.0 {
            continue;
        }
        breaks.extend(span.into_iter().filter(|b| b.abs() < 1.0 + SNAP));
        spans.push((other, span));
    }
    breaks.sort_by(f64::total_cmp);
    // Clusters are represented by an end of the face where they hold one, else by their first member.
    let mut clusters: Vec<f64> = Vec::new();
    for b in breaks {
        match clusters.last_mut() {
            Some(last) if b - *last < SNAP => {
                if b == 1.0 {
                    *last = 1.0;
                }
            }
            _ => clusters.push(if (b + 1.0).abs() < SNAP { -1.0 } else { b }),
        }
    }
    let mut points = Vec::new();
    for pair in clusters.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        let middle = 0.5 * (from + to);
        // Where several masters lie behind each other the nearest counts.
        let (normal, _) = nodes.normal(face, &[middle, 0.0, 0.0], &mut at);
        let x = slave.at(face, &[middle, 0.0, 0.0]).x;
        let seen = (spans.iter())
            .filter(|(_, span)| span[0] <= middle && middle <= span[1])
            .filter_map(|(other, _)| {
                let (_, gap) = onto_master(master, *other, &x, &normal.normalize(), [0.0; 3])?;
                (gap.abs() <= reach).then_some((gap.abs(), *other))
            })
            .min_by(|p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1)));
        let Some((_, other)) = seen else { continue };
        let n = slave.degree(face).max(master.degree(other)) + 2 + extra;
        for (s, w) in rule(CellShape::Line, n) {
            let s = [middle + 0.5 * (to - from) * s[0], 0.0, 0.0];
            let point = slave.at(face, &s);
            let (normal, _) = nodes.normal(face, &s, &mut at);
            let normal = normal.normalize();
            let Some((eta, gap)) = onto_master(master, other, &point.x, &normal, [0.0; 3]) else { continue };
            let weight = 0.5 * (to - from) * w * point.area_normal().norm() * slave.measure(&point.x);
            let magnitude = point.x.amax();
            points.push(GapPoint {
                s,
                weight,
                master: Some((other as u32, eta)),
                direction: -normal,
                gap: snapped(gap, magnitude),
            });
        }
    }
    points
}

/// A flat part of a face: corners in coordinates of the face and in space.
struct Facet<const D: usize> {
    corners: Vec<Local>,
    x: Vec<Point<D>>,
}

/// Whether a face is flat and has straight edges: its outline is then a polygon, whatever its inner map.
fn is_polygon<const D: usize>(surface: &dyn ContactSurface<D>, face: usize) -> bool {
    let shape = surface.shape(face);
    let order = surface.order(face);
    let corners: Vec<Point<D>> = shape.vertices().iter().map(|s| surface.at(face, s).x).collect();
    let size = (corners[1] - corners[0]).norm().max((corners[2] - corners[0]).norm());
    let normal = surface.at(face, &shape.centre()).area_normal().normalize();
    let flat = |x: &Point<D>| normal.dot(&(x - corners[0])).abs() <= 1e-10 * size;
    let straight = |&[a, b]: &[usize; 2]| {
        (1..=order).all(|k| {
            let t = k as f64 / (order + 1) as f64;
            let (p, q) = (shape.vertices()[a], shape.vertices()[b]);
            let x = surface.at(face, &std::array::from_fn(|i| p[i] + (q[i] - p[i]) * t)).x;
            let chord = (corners[b] - corners[a]).normalize();
            let off = x - corners[a];
            flat(&x) && (off - chord * chord.dot(&off)).norm() <= 1e-10 * size
        })
    };
    shape.edges().iter().all(straight) && flat(&surface.at(face, &shape.centre()).x)
}

/// Facets of a face: one where it is a polygon, else as many along each edge as its order.
fn facets<const D: usize>(surface: &dyn ContactSurface<D>, face: usize) -> Vec<Facet<D>> {
    let m = if is_polygon(surface, face) { 1 } else { surface.order(face) };
    let mut out = Vec::new();
    let mut push = |corners: Vec<Local>| {
        let x = corners.iter().map(|s| surface.at(face, s).x).collect();
        out.push(Facet { corners, x });
    };
    let share = |k: usize| k as f64 / m as f64;
    if surface.shape(face) == CellShape::Triangle {
        let p = |i: usize, j: usize| [share(i), share(j), 0.0];
        for j in 0..m {
            for i in 0..m - j {
                push(vec![p(i, j), p(i + 1, j), p(i, j + 1)]);
                if i + j + 1 < m {
                    push(vec![p(i + 1, j), p(i + 1, j + 1), p(i, j + 1)]);
                }
            }
        }
    } else {
        let p = |i: usize, j: usize| [2.0 * share(i) - 1.0, 2.0 * share(j) - 1.0, 0.0];
        for j in 0..m {
            for i in 0..m {
                push(vec![p(i, j), p(i + 1, j), p(i + 1, j + 1), p(i, j + 1)]);
            }
        }
    }
    out
}

type Flat = Vector<2>;

fn area(polygon: &[Flat]) -> f64 {
    let n = polygon.len();
    0.5 * (0..n).map(|k| polygon[k].perp(&polygon[(k + 1) % n])).sum::<f64>()
}

/// The part of a polygon inside a convex one (Sutherland & Hodgman); both run counter-clockwise.
fn clip(subject: &[Flat], window: &[Flat], tolerance: f64) -> Vec<Flat> {
    let mut polygon = subject.to_vec();
    for k in 0..window.len() {
        let (a, b) = (window[k], window[(k + 1) % window.len()]);
        let edge = b - a;
        let length = edge.norm();
        if length <= tolerance {
            continue;
        }
        let distance = |p: &Flat| {
            let d = edge.perp(&(p - a)) / length;
            if d.abs() <= tolerance { 0.0 } else { d }
        };
        let mut next: Vec<Flat> = Vec::with_capacity(polygon.len() + 1);
        for i in 0..polygon.len() {
            let (p, q) = (polygon[i], polygon[(i + 1) % polygon.len()]);
            let (dp, dq) = (distance(&p), distance(&q));
            if dp >= 0.0 {
                next.push(p);
            }
            if dp * dq < 0.0 {
                next.push(p + (q - p) * (dp / (dp - dq)));
            }
        }
        next.dedup_by(|a, b| (*a - *b).norm() <= tolerance);
        if next.len() > 1 && (next[0] - next[next.len() - 1]).norm() <= tolerance {
            next.pop();
        }
        polygon = next;
        if polygon.len() < 3 {
            return Vec::new();
        }
    }
    polygon
}

/// Local coordinates in a flat facet of a point of its plane, from the corners: barycentric, or bilinear.
fn inside(corners: &[Flat], p: &Flat) -> (Local, f64) {
    if corners.len() == 3 {
        let (a, b) = (corners[1] - corners[0], corners[2] - corners[0]);
        let determinant = a.perp(&b);
        let d = p - corners[0];
        return ([d.perp(&b) / determinant, a.perp(&d) / determinant, 0.0], determinant);
    }
    let mut s = [0.0; 3];
    let mut determinant = 0.0;
    for _ in 0..40 {
        let f = |i: usize| 0.25 * (1.0 + [-1.0, 1.0, 1.0, -1.0][i] * s[0]) * (1.0 + [-1.0, -1.0, 1.0, 1.0][i] * s[1]);
        let x: Flat = (0..4).map(|i| corners[i] * f(i)).sum();
        let along = |i: usize| 0.25 * [-1.0, 1.0, 1.0, -1.0][i] * (1.0 + [-1.0, -1.0, 1.0, 1.0][i] * s[1]);
        let across = |i: usize| 0.25 * [-1.0, -1.0, 1.0, 1.0][i] * (1.0 + [-1.0, 1.0, 1.0, -1.0][i] * s[0]);
        let a: Flat = (0..4).map(|i| corners[i] * along(i)).sum();
        let b: Flat = (0..4).map(|i| corners[i] * across(i)).sum();
        determinant = a.perp(&b);
        let d = p - x;
        let step = [d.perp(&b) / determinant, a.perp(&d) / determinant];
        s[0] += step[0];
        s[1] += step[1];
        if step[0].abs().max(step[1].abs()) < 1e-15 {
            break;
        }
    }
    (s, determinant)
}

/// The coordinates of the face from those of a facet, and the ratio of their areas.
fn of_facet(corners: &[Local], local: &Local) -> (Local, f64) {
    let weights: Vec<f64> = if corners.len() == 3 {
        vec![1.0 - local[0] - local[1], local[0], local[1]]
    } else {
        let f = |i: usize| [-1.0, 1.0, 1.0, -1.0][i] * local[0];
        let g = |i: usize| [-1.0, -1.0, 1.0, 1.0][i] * local[1];
        (0..4).map(|i| 0.25 * (1.0 + f(i)) * (1.0 + g(i))).collect()
    };
    let s = std::array::from_fn(|k| corners.iter().zip(&weights).map(|(c, w)| c[k] * w).sum());
    let flat: Vec<Flat> = corners.iter().map(|c| Flat::new(c[0], c[1])).collect();
    let reference = if corners.len() == 3 { 0.5 } else { 4.0 };
    (s, area(&flat) / reference)
}

/// Moves `s` to the point of a flat face at `x`; returns the area per reference area in the plane of `e1` and `e2`.
fn onto_face<const D: usize>(
    surface: &dyn ContactSurface<D>,
    face: usize,
    (e1, e2): (&Vector<3>, &Vector<3>),
    x: &Vector<3>,
    s: &mut Local,
) -> f64 {
    let space = |x: &Point<D>| Vector::<3>::from_fn(|k, _| x[k]);
    let flat = |x: &Vector<3>| Flat::new(e1.dot(x), e2.dot(x));
    let mut determinant = 0.0;
    for _ in 0..40 {
        let point = surface.at(face, s);
        let [a, b] = point.tangents.map(|t| flat(&space(&t)));
        determinant = a.perp(&b);
        let d = flat(&(x - space(&point.x)));
        let step = [d.perp(&b) / determinant, a.perp(&d) / determinant];
        s[0] += step[0];
        s[1] += step[1];
        if step[0].abs().max(step[1].abs()) < 1e-15 {
            break;
        }
    }
    determinant
}

/// Quadrature points in the plane over a convex polygon.
fn over(polygon: &[Flat], rule: &Rule) -> Vec<(Flat, f64)> {
    let mut out = Vec::new();
    let mut triangle = |a: Flat, b: Flat, c: Flat| {
        let twice = (b - a).perp(&(c - a));
        out.extend(rule.iter().map(|(s, w)| (a + (b - a) * s[0] + (c - a) * s[1], w * twice)));
    };
    if polygon.len() <= 4 {
        for k in 1..polygon.len() - 1 {
            triangle(polygon[0], polygon[k], polygon[k + 1]);
        }
    } else {
        let centre = polygon.iter().sum::<Flat>() / polygon.len() as f64;
        for k in 0..polygon.len() {
            triangle(centre, polygon[k], polygon[(k + 1) % polygon.len()]);
        }
    }
    out
}

fn polygons<const D: usize>(
    slave: &dyn ContactSurface<D>,
    master: &dyn ContactSurface<D>,
    nodes: &PressureNodes<D>,
    face: usize,
    candidates: &[usize],
    reach: f64,
    extra: usize,
) -> Vec<GapPoint<D>> {
    let space = |x: &Point<D>| Vector::<3>::from_fn(|k, _| x[k]);
    let mut at = Values::default();
    let mut points = Vec::new();
    let masters: Vec<(usize, Vec<Facet<D>>)> = candidates.iter().map(|&m| (m, facets(master, m))).collect();
    let polygon_face = is_polygon(slave, face);
    for facet in facets(slave, face) {
        let x: Vec<Vector<3>> = facet.x.iter().map(space).collect();
        let centre = x.iter().sum::<Vector<3>>() / x.len() as f64;
        let normal = flat_normal(&x);
        let e1 = (x[1] - x[0] - normal * normal.dot(&(x[1] - x[0]))).normalize();
        let e2 = normal.cross(&e1);
        let flat = |p: &Vector<3>| Flat::new(e1.dot(&(p - centre)), e2.dot(&(p - centre)));
        let own: Vec<Flat> = x.iter().map(flat).collect();
        let size = x.iter().map(|p| (p - centre).norm()).fold(0.0, f64::max);
        for (other, list) in &masters {
            let rule = rule(CellShape::Triangle, slave.degree(face).max(master.degree(*other)) + 2 + extra);
            for part in list {
                let y: Vec<Vector<3>> = part.x.iter().map(space).collect();
                if normal.dot(&flat_normal(&y)) > FACING {
                    continue;
                }
                // Facing surfaces turn the other way round.
                let mut window: Vec<Flat> = y.iter().map(flat).collect();
                window.reverse();
                let polygon = clip(&own, &window, 1e-12 * size);
                if polygon.len() < 3 || area(&polygon) < 1e-26 * size * size {
                    continue;
                }
                let unreversed: Vec<Flat> = y.iter().map(flat).collect();
                for (p, w) in over(&polygon, &rule) {
                    let (local, determinant) = inside(&own, &p);
                    let (mut s, ratio) = of_facet(&facet.corners, &local);
                    let mut density = ratio / determinant;
                    if polygon_face {
                        density = 1.0 / onto_face(slave, face, (&e1, &e2), &(centre + e1 * p.x + e2 * p.y), &mut s);
                    }
                    let point = slave.at(face, &s);
                    let (n, _) = nodes.normal(face, &s, &mut at);
                    let n = n.normalize();
                    let (start, _) = of_facet(&part.corners, &inside(&unreversed, &p).0);
                    let Some((eta, gap)) = onto_master(master, *other, &point.x, &n, start) else { continue };
                    if gap.abs() > reach {
                        continue;
                    }
                    let weight = w * density * point.area_normal().norm() * slave.measure(&point.x);
                    let magnitude = point.x.amax();
                    points.push(GapPoint {
                        s,
                        weight,
                        master: Some((*other as u32, eta)),
                        direction: -n,
                        gap: snapped(gap, magnitude),
                    });
                }
            }
        }
    }
    points
}

/// Unit normal of a triangle or of the mean plane of a quadrilateral.
fn flat_normal(x: &[Vector<3>]) -> Vector<3> {
    let n = if x.len() == 3 { (x[1] - x[0]).cross(&(x[2] - x[0])) } else { (x[2] - x[0]).cross(&(x[3] - x[1])) };
    n.try_normalize(0.0).unwrap_or_default()
}
