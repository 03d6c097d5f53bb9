//! Upper bounds of the second and third derivatives of Bezier pieces, from their control nets.

use super::bernstein::{Control, cut, derivative, hull, largest, largest_weight, powers, times_power};
use super::horner::{horner_curve, horner_surface, quotient_curve, quotient_surface};
use super::net::Net;
use crate::similarity::Similarity;
use crate::{Point, Vector};
use std::array::from_fn;
use std::sync::{Arc, LazyLock};

/// Upper bounds of the second and third derivatives of a chart or a part of it.
#[derive(Clone, Copy, Debug)]
pub struct Derivatives<const M: usize> {
    pub second: [[f64; M]; M],
    pub third: [[[f64; M]; M]; M],
}

impl<const M: usize> Derivatives<M> {
    /// Bounds that hold where either does.
    fn or(&self, other: &Self) -> Self {
        Derivatives {
            second: from_fn(|a| from_fn(|b| self.second[a][b].max(other.second[a][b]))),
            third: from_fn(|a| from_fn(|b| from_fn(|c| self.third[a][b][c].max(other.third[a][b][c])))),
        }
    }

    /// The bounds of a chart this many times as large.
    pub fn times(&self, factor: f64) -> Self {
        Derivatives {
            second: self.second.map(|row| row.map(|x| x * factor)),
            third: self.third.map(|rows| rows.map(|row| row.map(|x| x * factor))),
        }
    }

    /// The bounds of a part of the domain in coordinates of its own, `scale` times as long, in those of the whole.
    fn stretched(mut self, scale: [f64; M]) -> Self {
        for a in 0..M {
            for b in 0..M {
                self.second[a][b] *= scale[a] * scale[b];
                for c in 0..M {
                    self.third[a][b][c] *= scale[a] * scale[b] * scale[c];
                }
            }
        }
        self
    }
}

/// A box around a chart or a part of it, low and high corner.
pub type Hull = [Point<3>; 2];

/// The box of a chart that has no better one than its expansions.
pub const EVERYWHERE: Hull = [
    Point::<3>::new(f64::NEG_INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY),
    Point::<3>::new(f64::INFINITY, f64::INFINITY, f64::INFINITY),
];

/// The box around two.
pub fn around(a: &Hull, b: &Hull) -> Hull {
    [a[0].inf(&b[0]), a[1].sup(&b[1])]
}

/// Boxes and bounds for the fields of a regular grid over `[-1, 1]^M`. Derivatives of free-form pieces peak in a corner,
/// and one bound for the whole piece would be many times too large elsewhere.
#[derive(Clone, Debug)]
pub struct BoundsTable<const M: usize> {
    fields: [usize; M],
    hulls: Vec<Hull>,
    /// Made when they are first asked for: they take most of the time to build a shape, and a query that looks at a few
    /// pieces needs those of the few. They do not change as the chart moves, and grow with it by the factor.
    derivatives: Arc<LazyLock<Vec<Derivatives<M>>, Later<M>>>,
    factor: f64,
}

type Later<const M: usize> = Box<dyn FnOnce() -> Vec<Derivatives<M>> + Send>;

impl<const M: usize> BoundsTable<M> {
    /// The table of the moved chart.
    pub fn moved(&self, motion: &Similarity) -> Self {
        let hulls = self.hulls.iter().map(|h| motion.hull(h)).collect();
        BoundsTable { hulls, factor: self.factor * motion.factor, ..self.clone() }
    }

    /// The box around all fields.
    pub fn hull(&self) -> Hull {
        self.hulls.iter().fold(self.hulls[0], |a, b| around(&a, b))
    }

    /// Whether there are bounds of more than one field.
    pub fn is_divided(&self) -> bool {
        self.hulls.len() > 1
    }

    /// The bounds over `middle ± half`.
    pub(super) fn over(&self, middle: &[f64; M], half: &[f64; M]) -> (Hull, Derivatives<M>) {
        if !self.is_divided() {
            return (self.hulls[0], self.derivatives[0].times(self.factor));
        }
        let range = |k: usize| {
            let n = self.fields[k];
            let at = |s: f64| 0.5 * (s + 1.0) * n as f64;
            let low = (at(middle[k] - half[k]) as usize).min(n - 1);
            let high = (at(middle[k] + half[k]).ceil() as usize).clamp(low + 1, n);
            low..high
        };
        let per_row = if M == 1 { 1 } else { self.fields[M - 1] };
        let columns = if M == 1 { 0..1 } else { range(M - 1) };
        let derivatives: &[Derivatives<M>] = &self.derivatives;
        let (hull, bounds) = range(0)
            .flat_map(|i| columns.clone().map(move |j| i * per_row + j))
            .map(|field| (self.hulls[field], derivatives[field]))
            .reduce(|a, b| (around(&a.0, &b.0), a.1.or(&b.1)))
            .expect("one field at least");
        (hull, bounds.times(self.factor))
    }
}

/// Fields in each direction of the tables of rational and of polynomial pieces of this degree.
fn fields(degree: usize, rational: bool) -> usize {
    match (rational, degree) {
        (true, 2..) => 8,
        (false, 3..) => 4,
        _ => 1,
    }
}

pub(super) fn curve_table(control: &[Control], rational: bool) -> BoundsTable<1> {
    let n = fields(control.len() - 1, rational);
    let mut parts = vec![control.to_vec()];
    while parts.len() < n {
        parts = parts.iter().flat_map(|part| cut(part, 0.5)).collect();
    }
    let hulls = parts.iter().map(|part| hull(part)).collect();
    let later: Later<1> =
        Box::new(move || parts.iter().map(|part| curve_bounds(part, rational).stretched([n as f64])).collect());
    BoundsTable { fields: [n], hulls, derivatives: Arc::new(LazyLock::new(later)), factor: 1.0 }
}

pub(super) fn surface_table(net: &Net, rational: bool) -> BoundsTable<2> {
    let fields = net.degree.map(|degree| fields(degree, rational));
    let hulls = divided(net, fields).iter().map(|part| hull(&part.control)).collect();
    let net = net.clone();
    let later: Later<2> = Box::new(move || {
        let coefficients = net.powers().control;
        let [rows, columns] = fields.map(|n| n as f64);
        divided(&net, fields)
            .iter()
            .enumerate()
            .map(|(k, part)| {
                let (i, j) = (k / fields[1], k % fields[1]);
                let middle = [(2 * i + 1) as f64 / rows - 1.0, (2 * j + 1) as f64 / columns - 1.0];
                let taylor = horner_surface::<3>(net.degree, &coefficients, &middle);
                let mut taylor = quotient_surface(&taylor, rational);
                for a in 0..3 {
                    for b in 0..3 - a {
                        taylor[a][b] /= rows.powi(a as i32) * columns.powi(b as i32);
                    }
                }
                surface_bounds(part, rational.then_some(&taylor)).stretched([rows, columns])
            })
            .collect()
    });
    BoundsTable { fields, hulls, derivatives: Arc::new(LazyLock::new(later)), factor: 1.0 }
}

/// The nets of the fields, row by row.
fn divided(net: &Net, fields: [usize; 2]) -> Vec<Net> {
    let mut parts = vec![net.clone()];
    while parts.len() < fields[0] {
        parts = parts.iter().flat_map(|part| part.cut(0, 0.5)).collect();
    }
    while parts.len() < fields[0] * fields[1] {
        parts = parts.iter().flat_map(|part| part.cut(1, 0.5)).collect();
    }
    parts
}

/// Bounds from control nets. For a rational curve the quadratic Taylor polynomial about the middle is subtracted first
/// (times the weight, in the numerator): what is left has small lower derivatives, and the quotient rule stays tight.
fn curve_bounds(control: &[Control], rational: bool) -> Derivatives<1> {
    if !rational {
        let mut net = control.to_vec();
        let mut p = [0.0; 4];
        for value in &mut p {
            *value = largest(&net);
            net = if net.len() > 1 { derivative(&net) } else { vec![[0.0; 4]] };
        }
        return Derivatives { second: [[p[2]]], third: [[[p[3]]]] };
    }
    let [x, d, dd, _] = quotient_curve(horner_curve::<4>(&powers(control), 0.0), true);
    let mut numerator = times_power(control, 0);
    for (power, term) in [x, d, dd * 0.5].iter().enumerate() {
        for (value, c) in numerator.iter_mut().zip(times_power(control, power)) {
            for k in 0..3 {
                value[k] -= term[k] * c[3];
            }
        }
    }
    let w_min = control.iter().map(|c| c[3]).fold(f64::INFINITY, f64::min);
    let mut p = [0.0; 4];
    let mut w = [0.0; 4];
    for k in 0..4 {
        p[k] = largest(&numerator);
        w[k] = largest_weight(&numerator);
        numerator = derivative(&numerator);
    }
    let x0 = p[0] / w_min;
    let x1 = (p[1] + w[1] * x0) / w_min;
    let x2 = (p[2] + 2.0 * w[1] * x1 + w[2] * x0) / w_min;
    let x3 = (p[3] + 3.0 * w[1] * x2 + 3.0 * w[2] * x1 + w[3] * x0) / w_min;
    Derivatives { second: [[dd.norm() + x3.min(x2)]], third: [[[x3]]] }
}

/// See [`curve_bounds`]. Rational surfaces come with their Taylor coefficients at the middle: `taylor[a][b]` of order `a`
/// in the first and `b` in the second parameter, `a + b <= 2`.
fn surface_bounds(net: &Net, taylor: Option<&[[Vector<3>; 3]; 3]>) -> Derivatives<2> {
    let mut numerator = taylor.map_or_else(|| net.clone(), |t| net.less_quadratic(t));
    let centre = taylor.map_or([0.0; 3], |t| [2.0 * t[2][0].norm(), t[1][1].norm(), 2.0 * t[0][2].norm()]);
    let w_min = net.control.iter().map(|c| c[3]).fold(f64::INFINITY, f64::min);
    let mut p = [[0.0; 4]; 4];
    let mut w = [[0.0; 4]; 4];
    let mut across = numerator.clone();
    for a in 0..4 {
        across.clone_from(&numerator);
        for b in 0..4 - a {
            p[a][b] = largest(&across.control);
            w[a][b] = largest_weight(&across.control);
            across.differentiate(1);
        }
        numerator.differentiate(0);
    }
    let mut x = p;
    if taylor.is_some() {
        x[0][0] = p[0][0] / w_min;
        let binomial = [[1.0, 0.0, 0.0, 0.0], [1.0, 1.0, 0.0, 0.0], [1.0, 2.0, 1.0, 0.0], [1.0, 3.0, 3.0, 1.0]];
        for order in 1..4 {
            for a in 0..=order {
                let b = order - a;
                let mut sum = p[a][b];
                for i in 0..=a {
                    for j in 0..=b {
                        if i + j < order {
                            sum += binomial[a][i] * binomial[b][j] * w[a - i][b - j] * x[i][j];
                        }
                    }
                }
                x[a][b] = sum / w_min;
            }
        }
    }
    let second = [x[2][0] + centre[0], x[1][1] + centre[1], x[0][2] + centre[2]];
    Derivatives {
        second: [[second[0], second[1]], [second[1], second[2]]],
        third: [[[x[3][0], x[2][1]], [x[2][1], x[1][2]]], [[x[2][1], x[1][2]], [x[1][2], x[0][3]]]],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::{Chart, SurfaceChart};

    #[test]
    fn bounds_hold_in_every_field() {
        let mut state = 1u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        for degree in [[1, 2], [2, 3], [3, 1], [3, 3], [4, 2]] {
            for spread in [0.0, 3.0] {
                let control = (0..(degree[0] + 1) * (degree[1] + 1))
                    .map(|_| {
                        let w = 1.0 + spread * random();
                        [random() * w, random() * w, random() * w, w]
                    })
                    .collect();
                let chart = SurfaceChart::bezier(&Net { degree, control });
                for field in 0..64 {
                    let middle =
                        [f64::from(2 * (field / 8) + 1) / 8.0 - 1.0, f64::from(2 * (field % 8) + 1) / 8.0 - 1.0];
                    let (hull, Derivatives { second, third }) = chart.bounds(&middle, &[0.125; 2]);
                    for sample in 0..25 {
                        let s = [
                            middle[0] + f64::from(sample / 5 - 2) / 16.0,
                            middle[1] + f64::from(sample % 5 - 2) / 16.0,
                        ];
                        let jet = chart.jet3(&s);
                        let high = |value: f64, bound: f64| assert!(value <= bound + 1e-9, "{degree:?} at {s:?}");
                        for (k, (a, b)) in [(0, 0), (0, 1), (1, 1)].into_iter().enumerate() {
                            high(jet.dd[k].norm(), second[a][b]);
                        }
                        for (k, (a, b, c)) in [(0, 0, 0), (0, 0, 1), (0, 1, 1), (1, 1, 1)].into_iter().enumerate() {
                            high(jet.ddd[k].norm(), third[a][b][c]);
                        }
                        for k in 0..3 {
                            high(hull[0][k], jet.x[k]);
                            high(jet.x[k], hull[1][k]);
                        }
                    }
                }
            }
        }
    }
}
