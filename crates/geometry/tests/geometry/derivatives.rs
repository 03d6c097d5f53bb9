//! Derivatives, frames and variations against automatic differentiation.

use num_dual::{DualNum, HyperDual64, HyperHyperDual64};
use signorini_geometry::closest::{Query, closest};
use signorini_geometry::frame::{CurveFrame, DarbouxFrame, SurfaceFrame};
use signorini_geometry::measures::{Measures, PartnerJet, Variation};
use signorini_geometry::shape::{Axes, Curve, CurveJet, Shape, Surface, SurfaceJet};
use signorini_geometry::{Point, Vector};

type V3 = Vector<3>;

struct Random(u64);

impl Random {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn vector(&mut self, size: f64) -> V3 {
        V3::from_fn(|_, _| self.between(-size, size))
    }

    fn axes(&mut self) -> Axes {
        let ex = self.vector(1.0).normalize();
        let q = self.vector(1.0);
        let ey = (q - ex * q.dot(&ex)).normalize();
        Axes::new(self.vector(1.0), ex, ey).unwrap()
    }
}

fn close(found: &V3, exact: &V3, what: &str) {
    assert!((found - exact).norm() <= 1e-10 * (1.0 + exact.norm()), "{what}: {found:?}, exact {exact:?}");
}

// ---- generic evaluators -------------------------------------------------------------------------------------------

fn vector<T: DualNum<Primitive = f64>>(v: &V3) -> [T; 3] {
    [T::from(v.x), T::from(v.y), T::from(v.z)]
}

fn add<T: DualNum<Primitive = f64>>(a: &[T; 3], s: &T, b: &[T; 3]) -> [T; 3] {
    std::array::from_fn(|k| a[k].clone() + b[k].clone() * s.clone())
}

fn dot<T: DualNum<Primitive = f64>>(a: &[T; 3], b: &[T; 3]) -> T {
    a[0].clone() * b[0].clone() + a[1].clone() * b[1].clone() + a[2].clone() * b[2].clone()
}

fn in_axes<T: DualNum<Primitive = f64>>(axes: &Axes, x: T, y: T, z: T) -> [T; 3] {
    let sum = add(&vector(&axes.origin), &x, &vector(&axes.ex));
    add(&add(&sum, &y, &vector(&axes.ey)), &z, &vector(&axes.ez))
}

/// Bezier curve of any degree by de Casteljau.
fn casteljau<T: DualNum<Primitive = f64>>(control: &[[T; 3]], t: &T) -> [T; 3] {
    let mut work = control.to_vec();
    for r in (1..work.len()).rev() {
        for i in 0..r {
            let difference: [T; 3] = std::array::from_fn(|k| work[i + 1][k].clone() - work[i][k].clone());
            work[i] = add(&work[i], t, &difference);
        }
    }
    work[0].clone()
}

fn net_at<T: DualNum<Primitive = f64>>(net: &[Vec<[T; 3]>], u: &T, v: &T) -> [T; 3] {
    let rows: Vec<[T; 3]> = net.iter().map(|row| casteljau(row, v)).collect();
    casteljau(&rows, u)
}

fn hodograph<T: DualNum<Primitive = f64>>(control: &[[T; 3]]) -> Vec<[T; 3]> {
    let p = (control.len() - 1) as f64;
    control.windows(2).map(|w| std::array::from_fn(|k| (w[1][k].clone() - w[0][k].clone()) * p)).collect()
}

// ---- derivatives of shapes ----------------------------------------------------------------------------------------

type H3 = HyperHyperDual64;

fn seed(value: f64, parts: [f64; 3]) -> H3 {
    H3::new(value, parts[0], parts[1], parts[2], 0.0, 0.0, 0.0, 0.0)
}

fn check_curve(curve: &Curve, at: impl Fn(H3) -> [H3; 3], name: &str) {
    let [from, to] = curve.domain();
    for k in 0..5 {
        let t = from + (to - from) * (0.07 + 0.19 * f64::from(k));
        let exact = at(seed(t, [1.0; 3]));
        let jet = curve.jet(t);
        close(&jet.x, &V3::from_fn(|k, _| exact[k].re), name);
        close(&jet.d1, &V3::from_fn(|k, _| exact[k].eps1), name);
        close(&jet.d2, &V3::from_fn(|k, _| exact[k].eps1eps2), name);
        close(&jet.d3, &V3::from_fn(|k, _| exact[k].eps1eps2eps3), name);
    }
}

fn check_surface(surface: &Surface, at: impl Fn(H3, H3) -> [H3; 3], name: &str) {
    let [u, v] = surface.domain();
    for k in 0..6 {
        let s = 0.03 + 0.07 * f64::from(k);
        let (u, v) = (u[0] + (u[1] - u[0]) * s, v[0] + (v[1] - v[0]) * (0.5 - s));
        let jet = surface.jet(u, v);
        let third = [(3, jet.uuu), (2, jet.uuv), (1, jet.uvv), (0, jet.vvv)];
        for (along_u, d3) in third {
            let share = |k: usize| if k < along_u { 1.0 } else { 0.0 };
            let exact = at(seed(u, std::array::from_fn(share)), seed(v, std::array::from_fn(|k| 1.0 - share(k))));
            close(&d3, &V3::from_fn(|k, _| exact[k].eps1eps2eps3), name);
            let second = [jet.vv, jet.uv, jet.uu][usize::min(along_u, 2)];
            close(&second, &V3::from_fn(|k, _| exact[k].eps1eps2), name);
            close(&if along_u > 0 { jet.u } else { jet.v }, &V3::from_fn(|k, _| exact[k].eps1), name);
            close(&jet.x, &V3::from_fn(|k, _| exact[k].re), name);
        }
    }
}

#[test]
fn curves_have_exact_derivatives() {
    let mut r = Random(1);
    let axes = r.axes();
    let circle = Curve::circle(axes, 1.3, [0.2, 3.0], false).unwrap();
    check_curve(&circle, |t| in_axes(&axes, t.cos() * 1.3, t.sin() * 1.3, t * 0.0), "circle");
    let ellipse = Curve::ellipse(axes, 1.3, 0.4, [0.2, 3.0], false).unwrap();
    check_curve(&ellipse, |t| in_axes(&axes, t.cos() * 1.3, t.sin() * 0.4, t * 0.0), "ellipse");
    let helix = Curve::helix(axes, 0.7, 0.3, [-2.0, 9.0]).unwrap();
    check_curve(&helix, |t| in_axes(&axes, t.cos() * 0.7, t.sin() * 0.7, t * 0.3), "helix");
    let parabola = Curve::parabola(axes, 0.8, [-1.0, 2.0]).unwrap();
    check_curve(&parabola, |t| in_axes(&axes, t, t * t * 0.8, t * 0.0), "parabola");
    for n in [2, 4, 6, 9, 12] {
        let points: Vec<Point<3>> = (0..n).map(|_| r.vector(1.0)).collect();
        let weights: Vec<f64> = (0..n).map(|_| r.between(0.3, 3.0)).collect();
        let control: Vec<[H3; 3]> = points.iter().map(vector).collect();
        check_curve(&Curve::bezier(&points, None).unwrap(), |t| casteljau(&control, &t), "bezier");
        let weighted: Vec<[H3; 3]> = points.iter().zip(&weights).map(|(p, w)| vector(&(p * *w))).collect();
        let bare: Vec<[H3; 3]> = weights.iter().map(|w| vector(&V3::new(*w, 0.0, 0.0))).collect();
        let rational = Curve::bezier(&points, Some(&weights)).unwrap();
        let at = |t: H3| {
            let (p, w) = (casteljau(&weighted, &t), casteljau(&bare, &t));
            std::array::from_fn(|k| p[k] / w[0])
        };
        check_curve(&rational, at, "rational bezier");
    }
}

#[test]
fn surfaces_have_exact_derivatives() {
    let mut r = Random(2);
    let axes = r.axes();
    let range = [[0.1, 2.0], [-0.7, 0.9]];
    let plane = Surface::plane(axes, range).unwrap();
    check_surface(&plane, |u, v| in_axes(&axes, u, v, u * 0.0), "plane");
    let cylinder = Surface::cylinder(axes, 0.8, range, false).unwrap();
    check_surface(&cylinder, |u, v| in_axes(&axes, u.cos() * 0.8, u.sin() * 0.8, v), "cylinder");
    let cone = Surface::cone(axes, 0.6, 0.8, [[0.1, 2.0], [0.1, 2.0]], false).unwrap();
    check_surface(&cone, |u, v| in_axes(&axes, v * u.cos() * 0.6, v * u.sin() * 0.6, v * 0.8), "cone");
    let sphere = Surface::sphere(axes, 1.2, range, false).unwrap();
    let on_sphere = |u: H3, v: H3| in_axes(&axes, v.cos() * u.cos() * 1.2, v.cos() * u.sin() * 1.2, v.sin() * 1.2);
    check_surface(&sphere, on_sphere, "sphere");
    let ellipsoid = Surface::ellipsoid(axes, [1.2, 0.5, 0.9], range, false).unwrap();
    let on_ellipsoid = |u: H3, v: H3| in_axes(&axes, v.cos() * u.cos() * 1.2, v.cos() * u.sin() * 0.5, v.sin() * 0.9);
    check_surface(&ellipsoid, on_ellipsoid, "ellipsoid");
    let torus = Surface::torus(axes, 1.2, 0.4, range, [false; 2]).unwrap();
    let on_torus = |u: H3, v: H3| {
        let f = v.cos() * 0.4 + 1.2;
        in_axes(&axes, f * u.cos(), f * u.sin(), v.sin() * 0.4)
    };
    check_surface(&torus, on_torus, "torus");
    let graph = Surface::graph(axes, [0.6, -0.4, 0.9], range).unwrap();
    check_surface(&graph, |u, v| in_axes(&axes, u, v, u * u * 0.6 - v * v * 0.4 + u * v * 0.9), "graph");
    let profile =
        Curve::bezier(&[V3::new(0.5, 0.0, 0.0), V3::new(0.9, 0.0, 0.4), V3::new(0.4, 0.0, 1.0)], None).unwrap();
    let turned = Surface::revolution(&profile, V3::zeros(), V3::z(), [0.1, 2.0], false).unwrap();
    let control: Vec<[H3; 3]> =
        [[0.5, 0.0, 0.0], [0.9, 0.0, 0.4], [0.4, 0.0, 1.0]].iter().map(|p| vector(&V3::from(*p))).collect();
    let on_turned = |u: H3, v: H3| {
        let p = casteljau(&control, &v);
        [p[0] * u.cos(), p[0] * u.sin(), p[2]]
    };
    check_surface(&turned, on_turned, "revolution");
    for n in [2, 3, 5] {
        let points: Vec<Vec<Point<3>>> = (0..n).map(|_| (0..n + 1).map(|_| r.vector(1.0)).collect()).collect();
        let weights: Vec<Vec<f64>> = (0..n).map(|_| (0..n + 1).map(|_| r.between(0.4, 2.0)).collect()).collect();
        let net: Vec<Vec<[H3; 3]>> = points.iter().map(|row| row.iter().map(vector).collect()).collect();
        check_surface(&Surface::bezier(&points, None).unwrap(), |u, v| net_at(&net, &u, &v), "bezier");
        let weighted: Vec<Vec<[H3; 3]>> = points
            .iter()
            .zip(&weights)
            .map(|(row, w)| row.iter().zip(w).map(|(p, w)| vector(&(p * *w))).collect())
            .collect();
        let bare: Vec<Vec<[H3; 3]>> =
            weights.iter().map(|row| row.iter().map(|w| vector(&V3::new(*w, 0.0, 0.0))).collect()).collect();
        let at = |u: H3, v: H3| {
            let (p, w) = (net_at(&weighted, &u, &v), net_at(&bare, &u, &v));
            std::array::from_fn(|k| p[k] / w[0])
        };
        check_surface(&Surface::bezier(&points, Some(&weights)).unwrap(), at, "rational bezier");
    }
    let nodes: [Point<3>; 6] = [0; 6].map(|_| r.vector(1.0));
    let n: Vec<[H3; 3]> = nodes.iter().map(vector).collect();
    let on_triangle = |u: H3, v: H3| {
        let l = -(u + v) + 1.0;
        let shape =
            [l * (l * 2.0 - 1.0), u * (u * 2.0 - 1.0), v * (v * 2.0 - 1.0), l * u * 4.0, u * v * 4.0, v * l * 4.0];
        let mut sum = vector(&V3::zeros());
        for k in 0..6 {
            sum = add(&sum, &shape[k], &n[k]);
        }
        sum
    };
    check_surface(&Surface::tri6(&nodes).unwrap(), on_triangle, "tri6");
}

// ---- frames -------------------------------------------------------------------------------------------------------

#[test]
fn frames_obey_gauss_weingarten_frenet_and_darboux() {
    let mut r = Random(3);
    let points: Vec<Vec<Point<3>>> =
        (0..4).map(|i| (0..4).map(|j| V3::new(f64::from(i), f64::from(j), 0.0) + r.vector(0.3)).collect()).collect();
    let surface = Surface::bezier(&points, None).unwrap();
    // A curve in the parameter plane: u = 0.2 + 0.5 s + 0.2 s², v = 0.3 + 0.4 s - 0.1 s².
    let parameters =
        |s: f64| ([0.2 + 0.5 * s + 0.2 * s * s, 0.3 + 0.4 * s - 0.1 * s * s], [0.5 + 0.4 * s, 0.4 - 0.2 * s]);
    let frame_at = |s: f64| {
        let ([u, v], velocity) = parameters(s);
        let jet = surface.jet(u, v);
        let frame = SurfaceFrame::new(&jet).unwrap();
        (jet, frame, DarbouxFrame::new(&frame, velocity, [0.4, -0.2]).unwrap(), velocity)
    };
    let s = 0.4;
    let (jet, frame, darboux, velocity) = frame_at(s);
    // Gauss: r_ij = Γ^k_ij r_k + h_ij n.
    for (i, j, second) in [(0, 0, jet.uu), (0, 1, jet.uv), (1, 1, jet.vv)] {
        let sum = frame.base[0] * frame.christoffel[0][(i, j)]
            + frame.base[1] * frame.christoffel[1][(i, j)]
            + frame.normal * frame.curvature[(i, j)];
        close(&sum, &second, "Gauss");
    }
    let [(k1, e1), (k2, e2)] = frame.principal_curvatures();
    assert!(
        (k1 * k2 - frame.gaussian_curvature()).abs() < 1e-12 && (k1 + k2 - 2.0 * frame.mean_curvature()).abs() < 1e-12
    );
    assert!(e1.dot(&e2).abs() < 1e-12 && e1.dot(&frame.normal).abs() < 1e-12);
    // Darboux: differentiate the frame along the curve by arc length; fourth-order differences.
    let h = 1e-3;
    let speed = (jet.u * velocity[0] + jet.v * velocity[1]).norm();
    let rate = |f: &dyn Fn(f64) -> V3| {
        (f(s - 2.0 * h) - f(s - h) * 8.0 + f(s + h) * 8.0 - f(s + 2.0 * h)) / (12.0 * h * speed)
    };
    let tolerance = 1e-8;
    let tangent = rate(&|s| frame_at(s).2.tangent);
    let expected = darboux.side * darboux.geodesic_curvature + darboux.normal * darboux.normal_curvature;
    assert!((tangent - expected).norm() < tolerance, "{tangent:?} {expected:?}");
    let side = rate(&|s| frame_at(s).2.side);
    let expected = -darboux.tangent * darboux.geodesic_curvature + darboux.normal * darboux.geodesic_torsion;
    assert!((side - expected).norm() < tolerance, "{side:?} {expected:?}");
    // Weingarten along the way: n' = -k_n tau - tau_g g.
    let normal = rate(&|s| frame_at(s).2.normal);
    let expected = -darboux.tangent * darboux.normal_curvature - darboux.side * darboux.geodesic_torsion;
    assert!((normal - expected).norm() < tolerance, "{normal:?} {expected:?}");

    let helix = Curve::helix(Axes::standard(V3::zeros()), 2.0, 0.5, [0.0, 20.0]).unwrap();
    let frenet = CurveFrame::frenet(&helix.jet(1.7)).unwrap();
    assert!((frenet.curvature - 2.0 / 4.25).abs() < 1e-14 && (frenet.torsion - 0.5 / 4.25).abs() < 1e-14);
    let straight = Curve::segment(V3::zeros(), V3::new(1.0, 2.0, 3.0)).unwrap();
    assert!(CurveFrame::frenet(&straight.jet(0.5)).is_none());
    let robust = CurveFrame::robust(&straight.jet(0.5), None).unwrap();
    assert!(robust.normal.dot(&robust.tangent).abs() < 1e-15 && robust.curvature == 0.0);
}

/// The frame carried with least turning converges with fourth order: around a planar circle it must not turn at all,
/// along a helix it turns against the Frenet frame by the integral of the torsion.
#[test]
fn transported_frames_turn_least() {
    let helix = Curve::helix(Axes::standard(V3::zeros()), 1.0, 0.7, [0.0, 4.0]).unwrap();
    let error = |n: usize| {
        let mut frame = CurveFrame::frenet(&helix.jet(0.0)).unwrap();
        let torsion = frame.torsion * frame.speed * 4.0;
        for k in 0..n {
            let (from, to) = (helix.jet(4.0 * k as f64 / n as f64), helix.jet(4.0 * (k + 1) as f64 / n as f64));
            frame = frame.transported(&from, &to).unwrap();
        }
        let frenet = CurveFrame::frenet(&helix.jet(4.0)).unwrap();
        let angle = frame.normal.dot(&frenet.binormal).atan2(frame.normal.dot(&frenet.normal));
        (angle + torsion).sin().abs()
    };
    let (coarse, fine) = (error(20), error(40));
    let order = (coarse / fine).log2();
    assert!(order > 3.7, "order {order}, errors {coarse:e} {fine:e}");
}

// ---- variations ---------------------------------------------------------------------------------------------------

type H2 = HyperDual64;

/// A Bezier partner whose control points move in two directions.
#[derive(Clone)]
enum Moving {
    Point([V3; 3]),
    Curve(Vec<[V3; 3]>),
    Surface(Vec<Vec<[V3; 3]>>),
}

fn moving(p: &[V3; 3]) -> [H2; 3] {
    std::array::from_fn(|k| H2::new(p[0][k], p[1][k], p[2][k], 0.0))
}

impl Moving {
    fn dimension(&self) -> usize {
        match self {
            Moving::Point(_) => 0,
            Moving::Curve(_) => 1,
            Moving::Surface(_) => 2,
        }
    }

    fn shape(&self) -> Shape {
        match self {
            Moving::Point(p) => Shape::Point(p[0]),
            Moving::Curve(c) => Curve::bezier(&c.iter().map(|p| p[0]).collect::<Vec<_>>(), None).unwrap().into(),
            Moving::Surface(s) => {
                let net: Vec<Vec<V3>> = s.iter().map(|row| row.iter().map(|p| p[0]).collect()).collect();
                Surface::bezier(&net, None).unwrap().into()
            }
        }
    }

    /// Position and first derivatives with moving control points at moving parameters.
    fn at(&self, z: &[H2]) -> ([H2; 3], Vec<[H2; 3]>) {
        match self {
            Moving::Point(p) => (moving(p), Vec::new()),
            Moving::Curve(c) => {
                let c: Vec<[H2; 3]> = c.iter().map(moving).collect();
                (casteljau(&c, &z[0]), vec![casteljau(&hodograph(&c), &z[0])])
            }
            Moving::Surface(s) => {
                let net: Vec<Vec<[H2; 3]>> = s.iter().map(|row| row.iter().map(moving).collect()).collect();
                let along_u: Vec<[H2; 3]> = (0..net.len()).map(|i| casteljau(&net[i], &z[1])).collect();
                let along_v: Vec<[H2; 3]> = (0..net[0].len())
                    .map(|j| casteljau(&net.iter().map(|row| row[j]).collect::<Vec<_>>(), &z[0]))
                    .collect();
                (
                    casteljau(&along_u, &z[0]),
                    vec![casteljau(&hodograph(&along_u), &z[0]), casteljau(&hodograph(&along_v), &z[1])],
                )
            }
        }
    }

    /// The partner made of one direction of motion, as a shape: its jets are the variations.
    fn direction(&self, k: usize) -> Moving {
        let pick = |p: &[V3; 3]| [p[k], V3::zeros(), V3::zeros()];
        match self {
            Moving::Point(p) => Moving::Point(pick(p)),
            Moving::Curve(c) => Moving::Curve(c.iter().map(pick).collect()),
            Moving::Surface(s) => Moving::Surface(s.iter().map(|row| row.iter().map(pick).collect()).collect()),
        }
    }

    fn jets(&self, z: &[f64]) -> (V3, Vec<V3>, Vec<Vec<V3>>) {
        match self.shape() {
            Shape::Point(p) => (p, vec![], vec![]),
            Shape::Curve(c) => {
                let j = c.jet(z[0]);
                (j.x, vec![j.d1], vec![vec![j.d2]])
            }
            Shape::Surface(s) => {
                let j = s.jet(z[0], z[1]);
                (j.x, vec![j.u, j.v], vec![vec![j.uu, j.uv], vec![j.uv, j.vv]])
            }
            Shape::Mesh(_) | Shape::Implicit(_) | Shape::Solid(_) => unreachable!("no such shape here"),
        }
    }
}

fn variation<const N: usize>(a: &Moving, b: &Moving, k: usize, z: &[f64]) -> Variation<N> {
    let n = a.dimension();
    let (p, pj, pjj) = a.direction(k).jets(&z[..n]);
    let (q, qj, qjj) = b.direction(k).jets(&z[n..]);
    Variation {
        d: p - q,
        d_a: std::array::from_fn(|i| if i < n { pj[i] } else { -qj[i - n] }),
        d_ab: std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                if i < n && j < n {
                    pjj[i][j]
                } else if i >= n && j >= n {
                    -qjj[i - n][j - n]
                } else {
                    V3::zeros()
                }
            })
        }),
    }
}

enum Jet {
    Point(Point<3>),
    Curve(CurveJet),
    Surface(SurfaceJet),
}

impl Jet {
    fn of(shape: &Shape, z: &[f64]) -> Self {
        match shape {
            Shape::Point(p) => Jet::Point(*p),
            Shape::Curve(c) => Jet::Curve(c.jet(z[0])),
            Shape::Surface(s) => Jet::Surface(s.jet(z[0], z[1])),
            Shape::Mesh(_) | Shape::Implicit(_) | Shape::Solid(_) => unreachable!("no such shape here"),
        }
    }

    fn partner(&self) -> PartnerJet<'_> {
        match self {
            Jet::Point(p) => PartnerJet::Point(p),
            Jet::Curve(c) => PartnerJet::Curve(c),
            Jet::Surface(s) => PartnerJet::Surface(s),
        }
    }
}

/// Follows the closest points with Newton in hyper-dual numbers and compares all measures; returns whether the closest
/// points were interior, as this needs.
fn check_pair<const N: usize>(a: &Moving, b: &Moving, penetrating: bool, name: &str) -> bool {
    let (shape_a, shape_b) = (a.shape(), b.shape());
    let answer = closest(&shape_a, &shape_b, &Query::default());
    let z: Vec<f64> = answer.closest.a.parameters().iter().chain(answer.closest.b.parameters()).copied().collect();
    if z.iter().any(|t| *t <= 0.0 || *t >= 1.0) || answer.distance() < 1e-3 {
        return false;
    }
    let n = a.dimension();
    let sign = if penetrating { -1.0 } else { 1.0 };
    let normal = answer.closest.direction().unwrap() * sign;
    let (jet_a, jet_b) = (Jet::of(&shape_a, &z[..n]), Jet::of(&shape_b, &z[n..]));
    let measures = Measures::<N>::new(jet_a.partner(), jet_b.partner(), normal).unwrap();
    let hessian = measures.hessian();
    let inverse = nalgebra::DMatrix::from_fn(N, N, |i, j| hessian[(i, j)]).try_inverse().unwrap();
    let mut moved: Vec<H2> = z.iter().map(|t| H2::from(*t)).collect();
    let evaluate = |moved: &[H2]| {
        let (p, pj) = a.at(&moved[..n]);
        let (q, qj) = b.at(&moved[n..]);
        let d: [H2; 3] = std::array::from_fn(|k| p[k] - q[k]);
        let g: Vec<H2> = pj.iter().map(|j| dot(j, &d)).chain(qj.iter().map(|j| -dot(j, &d))).collect();
        (d, g)
    };
    for _ in 0..6 {
        let (_, g) = evaluate(&moved);
        for i in 0..N {
            for j in 0..N {
                moved[i] -= g[j] * inverse[(i, j)];
            }
        }
    }
    let (d, _) = evaluate(&moved);
    let gap = dot(&d, &d).sqrt() * sign;
    let (v, u) = (variation::<N>(a, b, 1, &z), variation::<N>(a, b, 2, &z));
    let check = |found: f64, exact: f64, what: &str| {
        assert!((found - exact).abs() <= 1e-10 * (1.0 + exact.abs()), "{name} {what}: {found}, exact {exact}");
    };
    check(measures.gap, gap.re, "gap");
    check(measures.gap_variation(&v), gap.eps1, "first variation of the gap");
    check(measures.gap_second_variation(&v, &u), gap.eps1eps2, "second variation of the gap");
    let (first, second) = (measures.coordinate_variation(&v), measures.coordinate_second_variation(&v, &u));
    let scale = 1.0 + second.norm();
    for i in 0..N {
        check(first[i], moved[i].eps1, "first variation of a coordinate");
        check(second[i] / scale, moved[i].eps1eps2 / scale, "second variation of a coordinate");
    }
    true
}

#[test]
fn measures_of_every_pair_vary_as_automatic_differentiation_says() {
    let mut r = Random(11);
    let mut random = |at: V3, noise: f64| [at + r.vector(noise), r.vector(1.0), r.vector(1.0)];
    let mut checked = [0; 6];
    for k in 0..60 {
        let height = 0.3 + 0.02 * f64::from(k);
        let point = Moving::Point(random(V3::new(0.1, 0.2, height), 0.3));
        let other = Moving::Point(random(V3::zeros(), 0.3));
        let mut curve = |height: f64, along: V3| {
            Moving::Curve((0..4).map(|i| random(along * (f64::from(i) - 1.5) * 0.7 + V3::z() * height, 0.25)).collect())
        };
        let (upper, lower) = (curve(height, V3::x()), curve(0.0, V3::y()));
        let mut surface = |height: f64, sag: f64| {
            let net = (0..4)
                .map(|i| {
                    (0..3)
                        .map(|j| {
                            let (x, y) = (f64::from(i) - 1.5, f64::from(j) - 1.0);
                            random(V3::new(x, y, height + sag * (x * x + y * y)), 0.1)
                        })
                        .collect()
                })
                .collect();
            Moving::Surface(net)
        };
        let (above, below) = (surface(height + 0.2, 0.4), surface(0.0, -0.3));
        let inside = k % 2 == 1;
        let done = [
            check_pair::<0>(&point, &other, inside, "point-point"),
            check_pair::<1>(&point, &lower, inside, "point-curve"),
            check_pair::<2>(&point, &below, inside, "point-surface"),
            check_pair::<2>(&upper, &lower, inside, "curve-curve"),
            check_pair::<3>(&upper, &below, inside, "curve-surface"),
            check_pair::<4>(&above, &below, inside, "surface-surface"),
        ];
        for (count, done) in checked.iter_mut().zip(done) {
            *count += usize::from(done);
        }
    }
    assert!(checked.iter().all(|&n| n >= 10), "interior pairs {checked:?}");
}
