//! Pieces of slave faces in space: polygons, cut in the plane of each slave facet.

use super::opposite::{Cut, FACING, GapPoint, onto_master, snapped};
use crate::surface::ContactSurface;
use signorini_basis::hierarchic::Values;
use signorini_basis::rules::{Rule, rule};
use signorini_basis::{CellShape, Local};
use signorini_geometry::{Point, Vector};

/// A flat part of a face: corners in coordinates of the face and in space.
struct Facet<const D: usize> {
    corners: Vec<Local>,
    x: Vec<Point<D>>,
}

/// Distance from a plane, relative to the size of a face, that is none. A face that is cut as one polygon and not in facets has
/// points of quadrature elsewhere, which changes forces by as much: far less than what iterations leave of them.
const FLAT: f64 = 1e-13;

/// Whether a face is flat and has straight edges: its outline is then a polygon, whatever its inner map.
fn is_polygon<const D: usize>(surface: &dyn ContactSurface<D>, face: usize) -> bool {
    let shape = surface.shape(face);
    let order = surface.order(face);
    let corners: Vec<Point<D>> = shape.vertices().iter().map(|s| surface.at(face, s).x).collect();
    let size = (corners[1] - corners[0]).norm().max((corners[2] - corners[0]).norm());
    let normal = surface.at(face, &shape.centre()).area_normal().normalize();
    let flat = |x: &Point<D>| normal.dot(&(x - corners[0])).abs() <= FLAT * size;
    let straight = |&[a, b]: &[usize; 2]| {
        (1..=order).all(|k| {
            let t = k as f64 / (order + 1) as f64;
            let (p, q) = (shape.vertices()[a], shape.vertices()[b]);
            let x = surface.at(face, &std::array::from_fn(|i| p[i] + (q[i] - p[i]) * t)).x;
            let chord = (corners[b] - corners[a]).normalize();
            let off = x - corners[a];
            flat(&x) && (off - chord * chord.dot(&off)).norm() <= FLAT * size
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

pub(super) fn polygons<const D: usize>(cut: Cut<'_, D>, face: usize, candidates: &[usize]) -> Vec<GapPoint<D>> {
    let Cut { slave, master, nodes, sight, extra } = cut;
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
                    if !sight.includes(face, gap) {
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
    if let Some(apart) = hidden_by(slave, face, &points) {
        // Masters lie behind each other: of those on a line the nearest counts.
        points.retain(|p| !is_hidden(cut, face, (candidates, apart), p));
    }
    points
}

/// How much nearer a master is at least that hides another one, if masters may lie behind each other: by anything where points
/// stand for more than the face, by the size of the face where gaps differ by that. What is less may be the same surface, beyond
/// the border of a curved face.
fn hidden_by<const D: usize>(slave: &dyn ContactSurface<D>, face: usize, points: &[GapPoint<D>]) -> Option<f64> {
    let of = |s: &Local| slave.at(face, s).area_normal().norm() * slave.measure(&slave.at(face, s).x);
    let rule = rule(slave.shape(face), slave.degree(face).max(slave.order(face)) + 3);
    let area: f64 = rule.iter().map(|(s, w)| w * of(s)).sum();
    if points.iter().map(|p| p.weight).sum::<f64>() > area * (1.0 + 1e-6) {
        return Some(0.0);
    }
    let corners = slave.shape(face).vertices();
    let size = (slave.at(face, &corners[1]).x - slave.at(face, &corners[0]).x).norm();
    let [low, high] = points.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], p| [l.min(p.gap), h.max(p.gap)]);
    (high - low > size).then_some(size)
}

/// Whether another face of the master is on the line of a point, and nearer.
fn is_hidden<const D: usize>(
    cut: Cut<'_, D>,
    face: usize,
    (candidates, apart): (&[usize], f64),
    point: &GapPoint<D>,
) -> bool {
    let Cut { slave, master, sight, .. } = cut;
    let x = slave.at(face, &point.s).x;
    let n = -point.direction;
    let own = point.master.map(|m| m.0 as usize);
    candidates.iter().filter(|m| Some(**m) != own).any(|&m| {
        let shape = master.shape(m);
        let Some((eta, gap)) = onto_master(master, m, &x, &n, shape.centre()) else { return false };
        let within = if shape == CellShape::Triangle {
            eta[0] > -1e-9 && eta[1] > -1e-9 && eta[0] + eta[1] < 1.0 + 1e-9
        } else {
            eta[0].abs().max(eta[1].abs()) < 1.0 + 1e-9
        };
        // Faces that meet have the same gap along their edge.
        let nearer = point.gap.abs() - gap.abs() > apart.max(1e-6 * (point.gap.abs() + gap.abs()));
        within && nearer && sight.includes(face, gap) && master.at(m, &eta).area_normal().normalize().dot(&n) < FACING
    })
}

/// Unit normal of a triangle or of the mean plane of a quadrilateral.
fn flat_normal(x: &[Vector<3>]) -> Vector<3> {
    let n = if x.len() == 3 { (x[1] - x[0]).cross(&(x[2] - x[0])) } else { (x[2] - x[0]).cross(&(x[3] - x[1])) };
    n.try_normalize(0.0).unwrap_or_default()
}
