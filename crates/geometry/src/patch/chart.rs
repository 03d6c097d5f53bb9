//! Charts: the smooth maps of which every curve and surface is made, with derivatives and bounds on them.
//!
//! A chart maps `[-1, 1]^M` to space. Polynomial and rational pieces are kept in powers of the local parameters, where
//! Horner's scheme gives value and derivatives for a few operations per coefficient; pieces of high degree are cut
//! until the coefficients decay, which keeps this as accurate as Bernstein form.

use super::bernstein::{Control, powers};
use super::bounds::{BoundsTable, Derivatives, EVERYWHERE, Hull, curve_table, surface_table};
use super::horner::{horner_curve, horner_surface, quotient_curve, quotient_surface};
use super::net::Net;
use crate::{Point, Vector};

/// Position and partial derivatives to second order.
#[derive(Clone, Copy, Debug)]
pub struct Jet2<const M: usize> {
    pub x: Point<3>,
    pub d: [Vector<3>; M],
    pub dd: [[Vector<3>; M]; M],
}

/// A smooth map from `[-1, 1]^M` to space.
pub trait Chart<const M: usize>: Send + Sync {
    fn jet(&self, s: &[f64; M]) -> Jet2<M>;
    fn position(&self, s: &[f64; M]) -> Point<3>;
    /// A box around the part over `middle ± half`, which lies in the domain, and bounds of the derivatives there.
    fn bounds(&self, middle: &[f64; M], half: &[f64; M]) -> (Hull, Derivatives<M>);
    /// The box around the chart, where that is at hand before its bounds are, which take long.
    fn early_hull(&self) -> Option<Hull> {
        None
    }
}

/// The chart of a single point.
#[derive(Clone, Copy, Debug)]
pub struct PointChart(pub Point<3>);

impl Chart<0> for PointChart {
    fn jet(&self, _: &[f64; 0]) -> Jet2<0> {
        Jet2 { x: self.0, d: [], dd: [] }
    }

    fn position(&self, _: &[f64; 0]) -> Point<3> {
        self.0
    }

    fn bounds(&self, _: &[f64; 0], _: &[f64; 0]) -> (Hull, Derivatives<0>) {
        (EVERYWHERE, Derivatives { second: [], third: [] })
    }
}

/// A curve piece.
#[derive(Clone, Debug)]
pub enum CurveChart {
    /// Coefficients of the powers of `s`, homogeneous where `rational`.
    Power { coefficients: Vec<Control>, rational: bool, bounds: BoundsTable<1> },
    /// `origin + a cos t + b sin t + c t`, `t = middle + half s`, with `a` and `b` orthogonal: circle, ellipse, helix.
    Harmonic { origin: Point<3>, a: Vector<3>, b: Vector<3>, c: Vector<3>, middle: f64, half: f64 },
}

impl CurveChart {
    /// A Bezier curve over `s` in `[-1, 1]`.
    pub fn bezier(control: &[Control]) -> Self {
        let rational = is_rational(control);
        let control: Vec<Control> =
            if rational { control.to_vec() } else { control.iter().map(|c| c.map(|v| v / c[3])).collect() };
        let bounds = curve_table(&control, rational);
        let mut coefficients = powers(&control);
        while !rational && coefficients.len() > 1 && coefficients.last() == Some(&[0.0; 4]) {
            coefficients.pop();
        }
        CurveChart::Power { coefficients, rational, bounds }
    }

    /// Position and derivatives to third order with respect to `s`.
    pub fn jet3(&self, s: f64) -> [Vector<3>; 4] {
        match self {
            CurveChart::Power { coefficients, rational, .. } => {
                quotient_curve(horner_curve::<4>(coefficients, s), *rational)
            }
            CurveChart::Harmonic { origin, a, b, c, middle, half } => {
                let (sin, cos) = (middle + half * s).sin_cos();
                let h = *half;
                [
                    origin + a * cos + b * sin + c * (middle + h * s),
                    (b * cos - a * sin + c) * h,
                    -(a * cos + b * sin) * (h * h),
                    (a * sin - b * cos) * (h * h * h),
                ]
            }
        }
    }
}

/// Whether weights differ by more than rounding.
fn is_rational(control: &[Control]) -> bool {
    let w = control[0][3];
    control.iter().any(|c| (c[3] - w).abs() > 16.0 * f64::EPSILON * w)
}

impl Chart<1> for CurveChart {
    #[inline]
    fn jet(&self, s: &[f64; 1]) -> Jet2<1> {
        match self {
            CurveChart::Power { coefficients, rational, .. } => {
                let [x, d, dd] = quotient_curve(horner_curve::<3>(coefficients, s[0]), *rational);
                Jet2 { x, d: [d], dd: [[dd]] }
            }
            CurveChart::Harmonic { .. } => {
                let [x, d, dd, _] = self.jet3(s[0]);
                Jet2 { x, d: [d], dd: [[dd]] }
            }
        }
    }

    fn position(&self, s: &[f64; 1]) -> Point<3> {
        match self {
            CurveChart::Power { coefficients, rational, .. } => {
                quotient_curve(horner_curve::<1>(coefficients, s[0]), *rational)[0]
            }
            CurveChart::Harmonic { .. } => self.jet3(s[0])[0],
        }
    }

    fn bounds(&self, middle: &[f64; 1], half: &[f64; 1]) -> (Hull, Derivatives<1>) {
        match self {
            CurveChart::Power { bounds, .. } => bounds.over(middle, half),
            CurveChart::Harmonic { a, b, half, .. } => {
                let r = a.norm().max(b.norm());
                (EVERYWHERE, Derivatives { second: [[r * half * half]], third: [[[r * half * half * half]]] })
            }
        }
    }
}

/// A surface piece.
#[derive(Clone, Debug)]
pub enum SurfaceChart {
    /// Coefficients of the powers of both parameters, homogeneous where `rational`.
    Power { degree: [usize; 2], coefficients: Vec<Control>, rational: bool, bounds: BoundsTable<2> },
    /// `origin + f(v) (a cos u + b sin u) + g(v) c` with orthogonal axes, `f = f0 + f1 v + f2 cos v`,
    /// `g = g0 + g1 v + g2 sin v`: cylinder, cone, sphere, ellipsoid, torus.
    Quadric { origin: Point<3>, axes: [Vector<3>; 3], f: [f64; 3], g: [f64; 3], middle: [f64; 2], half: [f64; 2] },
    /// A profile curve (second parameter) turned about an axis by the angle `u = middle + half s`.
    Revolved { origin: Point<3>, axis: Vector<3>, profile: CurveChart, middle: f64, half: f64, bounds: Derivatives<2> },
}

/// Position and partial derivatives to third order of a surface.
#[derive(Clone, Copy, Debug)]
pub struct Jet3 {
    pub x: Point<3>,
    pub d: [Vector<3>; 2],
    /// `uu, uv, vv`.
    pub dd: [Vector<3>; 3],
    /// `uuu, uuv, uvv, vvv`.
    pub ddd: [Vector<3>; 4],
}

impl SurfaceChart {
    pub fn bezier(net: &Net) -> Self {
        let rational = is_rational(&net.control);
        let net = if rational {
            net.clone()
        } else {
            Net { degree: net.degree, control: net.control.iter().map(|c| c.map(|v| v / c[3])).collect() }
        };
        let bounds = surface_table(&net, rational);
        SurfaceChart::Power { degree: net.degree, coefficients: net.powers().control, rational, bounds }
    }

    pub fn revolved(origin: Point<3>, axis: Vector<3>, profile: CurveChart, middle: f64, half: f64) -> Self {
        // |r_perp| and |P'| over the profile from its Taylor expansion at the middle.
        let (_, bounds) = profile.bounds(&[0.0], &[1.0]);
        let second = bounds.second[0][0];
        let [x, d, _, _] = profile.jet3(0.0);
        let third = bounds.third[0][0][0];
        let off = x - origin;
        let radius = (off - axis * off.dot(&axis)).norm() + d.norm() + 0.5 * second;
        let speed = d.norm() + second;
        let h = half;
        let uu = radius * h * h;
        let uuv = speed * h * h;
        let uvv = second * h;
        let bounds = Derivatives {
            second: [[uu, speed * h], [speed * h, second]],
            third: [[[uu * h, uuv], [uuv, uvv]], [[uuv, uvv], [uvv, third]]],
        };
        SurfaceChart::Revolved { origin, axis, profile, middle, half, bounds }
    }

    /// Position and derivatives to third order with respect to the local parameters.
    pub fn jet3(&self, s: &[f64; 2]) -> Jet3 {
        match self {
            SurfaceChart::Power { degree, coefficients, rational, .. } => {
                let t = horner_surface::<4>(*degree, coefficients, s);
                let x = quotient_surface(&t, *rational);
                Jet3 {
                    x: x[0][0],
                    d: [x[1][0], x[0][1]],
                    dd: [x[2][0] * 2.0, x[1][1], x[0][2] * 2.0],
                    ddd: [x[3][0] * 6.0, x[2][1] * 2.0, x[1][2] * 2.0, x[0][3] * 6.0],
                }
            }
            SurfaceChart::Quadric { origin, axes, f, g, middle, half } => {
                let (u, v) = (middle[0] + half[0] * s[0], middle[1] + half[1] * s[1]);
                let ((su, cu), (sv, cv)) = (u.sin_cos(), v.sin_cos());
                let f = [f[0] + f[1] * v + f[2] * cv, f[1] - f[2] * sv, -f[2] * cv, f[2] * sv];
                let g = [g[0] + g[1] * v + g[2] * sv, g[1] + g[2] * cv, -g[2] * sv, -g[2] * cv];
                let e = axes[0] * cu + axes[1] * su;
                let e1 = axes[1] * cu - axes[0] * su;
                let c = axes[2];
                let [h, k] = *half;
                Jet3 {
                    x: origin + e * f[0] + c * g[0],
                    d: [e1 * (f[0] * h), (e * f[1] + c * g[1]) * k],
                    dd: [e * (-f[0] * h * h), e1 * (f[1] * h * k), (e * f[2] + c * g[2]) * (k * k)],
                    ddd: [
                        e1 * (-f[0] * h * h * h),
                        e * (-f[1] * h * h * k),
                        e1 * (f[2] * h * k * k),
                        (e * f[3] + c * g[3]) * (k * k * k),
                    ],
                }
            }
            SurfaceChart::Revolved { origin, axis, profile, middle, half, .. } => {
                let [p, p1, p2, p3] = profile.jet3(s[1]);
                let (sin, cos) = (middle + half * s[0]).sin_cos();
                // The turned vector and its derivatives with respect to the angle.
                let turn = |v: &Vector<3>| {
                    let along = axis * v.dot(axis);
                    let across = v - along;
                    let third = axis.cross(&across);
                    let e = across * cos + third * sin;
                    let e1 = third * cos - across * sin;
                    [along + e, e1, -e, -e1]
                };
                let (t0, t1, t2, t3) = (turn(&(p - origin)), turn(&p1), turn(&p2), turn(&p3));
                let h = *half;
                Jet3 {
                    x: origin + t0[0],
                    d: [t0[1] * h, t1[0]],
                    dd: [t0[2] * (h * h), t1[1] * h, t2[0]],
                    ddd: [t0[3] * (h * h * h), t1[2] * (h * h), t2[1] * h, t3[0]],
                }
            }
        }
    }
}

impl Chart<2> for SurfaceChart {
    #[inline]
    fn jet(&self, s: &[f64; 2]) -> Jet2<2> {
        match self {
            SurfaceChart::Power { degree, coefficients, rational, .. } => {
                let t = horner_surface::<3>(*degree, coefficients, s);
                let x = quotient_surface(&t, *rational);
                Jet2 { x: x[0][0], d: [x[1][0], x[0][1]], dd: [[x[2][0] * 2.0, x[1][1]], [x[1][1], x[0][2] * 2.0]] }
            }
            _ => {
                let j = self.jet3(s);
                Jet2 { x: j.x, d: j.d, dd: [[j.dd[0], j.dd[1]], [j.dd[1], j.dd[2]]] }
            }
        }
    }

    fn position(&self, s: &[f64; 2]) -> Point<3> {
        match self {
            SurfaceChart::Power { degree, coefficients, rational, .. } => {
                quotient_surface(&horner_surface::<1>(*degree, coefficients, s), *rational)[0][0]
            }
            _ => self.jet3(s).x,
        }
    }

    fn bounds(&self, middle: &[f64; 2], half: &[f64; 2]) -> (Hull, Derivatives<2>) {
        match self {
            SurfaceChart::Power { bounds, .. } => bounds.over(middle, half),
            SurfaceChart::Revolved { bounds, .. } => (EVERYWHERE, *bounds),
            SurfaceChart::Quadric { axes, f, g, middle, half, .. } => {
                let [h, k] = *half;
                let v = middle[1].abs() + k;
                let radial = axes[0].norm().max(axes[1].norm());
                let f0 = f[0].abs() + f[1].abs() * v + f[2].abs();
                // The cosine alone (sphere): bound it on the range, small near a pole.
                let f0 = if f[0] == 0.0 && f[1] == 0.0 { f[2].abs() * largest_cosine(middle[1], k) } else { f0 };
                let f1 = f[1].abs() + f[2].abs() * largest_sine(middle[1], k);
                let f2 = f[2].abs() * largest_cosine(middle[1], k);
                let f3 = f[2].abs() * largest_sine(middle[1], k);
                let g2 = g[2].abs() * largest_sine(middle[1], k) * axes[2].norm();
                let g3 = g[2].abs() * largest_cosine(middle[1], k) * axes[2].norm();
                let uu = radial * f0 * h * h;
                let uv = radial * f1 * h * k;
                let vv = (radial * f2).hypot(g2) * k * k;
                let (uuv, uvv) = (radial * f1 * h * h * k, radial * f2 * h * k * k);
                let bounds = Derivatives {
                    second: [[uu, uv], [uv, vv]],
                    third: [[[uu * h, uuv], [uuv, uvv]], [[uuv, uvv], [uvv, (radial * f3).hypot(g3) * k * k * k]]],
                };
                (EVERYWHERE, bounds)
            }
        }
    }

    fn early_hull(&self) -> Option<Hull> {
        match self {
            SurfaceChart::Power { bounds, .. } if bounds.is_divided() => Some(bounds.hull()),
            _ => None,
        }
    }
}

fn largest_cosine(middle: f64, half: f64) -> f64 {
    // |cos| grows towards multiples of pi.
    let x = (middle / std::f64::consts::PI).round() * std::f64::consts::PI;
    if (middle - x).abs() <= half { 1.0 } else { (middle - half).cos().abs().max((middle + half).cos().abs()) }
}

fn largest_sine(middle: f64, half: f64) -> f64 {
    largest_cosine(middle - std::f64::consts::FRAC_PI_2, half)
}
