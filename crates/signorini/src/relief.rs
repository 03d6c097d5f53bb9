//! Surfaces over a plane that no formula gives: measured heights, level sets and triangle meshes seen from above.

use crate::expression::{Expression, Scope};
use signorini_geometry::grid_spline::GridSpline;
use signorini_geometry::height_field::{HeightField, View};
use signorini_geometry::mesh::TriangleMesh;
use signorini_geometry::{Jet, Matrix, Real, Vector};

/// Samples along a vertical between which a level set changes its sign at most once.
const LAYERS: usize = 96;
/// Halvings of an interval, which end at round-off.
const HALVINGS: usize = 60;

/// The top of a body that is negative inside: along each vertical of a box the highest place where the sign changes, and
/// the bottom of the box where there is none.
#[derive(Clone, Debug)]
pub struct LevelSetTop {
    /// Of x, y and z.
    pub inside: Expression,
    pub low: f64,
    pub high: f64,
    /// From below its lowest places are seen, and the top of the box.
    pub view: View,
}

impl LevelSetTop {
    fn at(&self, x: &Vector<2>, z: f64) -> f64 {
        self.inside.evaluate(&Scope { position: [x[0], x[1], z], time: f64::NAN })
    }

    /// The height along a vertical, if the body is there.
    fn top(&self, x: &Vector<2>) -> Option<f64> {
        let (from, to) = match self.view {
            View::FromAbove => (self.high, self.low),
            View::FromBelow => (self.low, self.high),
        };
        let z = |k: usize| from + (to - from) * k as f64 / LAYERS as f64;
        // What is not a number is told as such, not passed over.
        let mut values = (0..=LAYERS).map(|k| self.at(x, z(k)));
        let entered = values.position(|v| v <= 0.0 || v.is_nan())?;
        if self.at(x, z(entered)).is_nan() {
            return Some(f64::NAN);
        }
        if entered == 0 {
            return Some(from);
        }
        // Between outside and inside, by the secant kept within halves.
        let (mut out, mut inn) = ((z(entered - 1), self.at(x, z(entered - 1))), (z(entered), self.at(x, z(entered))));
        for k in 0..HALVINGS {
            let secant = inn.0 - inn.1 * (out.0 - inn.0) / (out.1 - inn.1);
            let middle = 0.5 * (out.0 + inn.0);
            let next = if k % 3 == 2 || !secant.is_finite() { middle } else { secant };
            if next == out.0 || next == inn.0 {
                break;
            }
            let value = self.at(x, next);
            if value <= 0.0 { inn = (next, value) } else { out = (next, value) }
        }
        Some(if inn.1.abs() <= out.1.abs() { inn.0 } else { out.0 })
    }
}

impl HeightField for LevelSetTop {
    fn value(&self, x: &Vector<2>) -> f64 {
        self.top(x).unwrap_or(match self.view {
            View::FromAbove => self.low,
            View::FromBelow => self.high,
        })
    }

    /// By the implicit function theorem: `h_i = -F_i / F_z`, and once more.
    fn jet(&self, x: &Vector<2>) -> Jet<2> {
        let Some(z) = self.top(x) else { return Jet::constant(self.value(x)) };
        if z == self.low || z == self.high {
            return Jet::constant(z);
        }
        let position = [x[0], x[1], z];
        let jets = [0, 1, 2].map(|k| Jet::<3>::variable(position[k], k));
        let f = self.inside.evaluate(&Scope { position: jets, time: Jet::constant(f64::NAN) });
        let (g, h) = (f.gradient, f.hessian);
        let slope = [-g[0] / g[2], -g[1] / g[2]];
        let bend = |i: usize, j: usize| {
            -(h[(i, j)] + h[(i, 2)] * slope[j] + h[(j, 2)] * slope[i] + h[(2, 2)] * slope[i] * slope[j]) / g[2]
        };
        Jet {
            value: z,
            gradient: slope.into(),
            hessian: Matrix::<2>::new(bend(0, 0), bend(0, 1), bend(1, 0), bend(1, 1)),
        }
    }
}

/// Heights on a grid, joined by a bicubic spline: it passes through all of them and has continuous curvature.
#[derive(Debug)]
pub struct Sampled {
    pub spline: GridSpline<2>,
    /// Whether nothing is known beyond the grid.
    pub ends: bool,
}

impl HeightField for Sampled {
    fn jet(&self, x: &Vector<2>) -> Jet<2> {
        self.spline.jet(x)
    }

    fn known_within(&self) -> Option<[Vector<2>; 2]> {
        self.ends.then(|| self.spline.bounds())
    }
}

/// A height that is turned about the origin of its plane, then moved.
#[derive(Debug)]
pub struct MovedHeight<H> {
    pub height: H,
    /// In radians.
    pub angle: f64,
    pub shift: [f64; 3],
}

impl<H: HeightField> MovedHeight<H> {
    #[doc(hidden)]
    pub fn turn(&self) -> Matrix<2> {
        let (sin, cos) = self.angle.sin_cos();
        Matrix::<2>::new(cos, -sin, sin, cos)
    }

    #[doc(hidden)]
    pub fn shift_in_plane(&self) -> Vector<2> {
        Vector::<2>::new(self.shift[0], self.shift[1])
    }
}

impl<H: HeightField> HeightField for MovedHeight<H> {
    fn jet(&self, x: &Vector<2>) -> Jet<2> {
        let turn = self.turn();
        let Jet { value, gradient, hessian } = self.height.jet(&(turn.transpose() * (x - self.shift_in_plane())));
        Jet { value: value + self.shift[2], gradient: turn * gradient, hessian: turn * hessian * turn.transpose() }
    }

    /// The largest rectangle of the proportions of the box round the turned one that lies in that; the box itself for
    /// right angles.
    fn known_within(&self) -> Option<[Vector<2>; 2]> {
        let [low, high] = self.height.known_within()?;
        let (half, turn) = ((high - low) * 0.5, self.turn());
        let around = turn.abs() * half;
        let back = turn.abs().transpose() * around;
        let share = (half[0] / back[0]).min(half[1] / back[1]);
        let centre = turn * (low + half) + self.shift_in_plane();
        Some([centre - around * share, centre + around * share])
    }
}

/// Beyond its shadow a mesh falls off with this slope.
#[doc(hidden)]
pub const FALL: f64 = 1.0;

impl Sampled {
    /// Heights by rows along x, of so many columns each, the first at the origin.
    ///
    /// # Errors
    /// In words: fewer than four rows or columns, numbers that are not finite.
    pub fn of_rows(origin: [f64; 2], spacing: [f64; 2], columns: usize, values: &[f64]) -> Result<Self, String> {
        let rows = values.len() / columns.max(1);
        if rows < 4 || columns < 4 {
            return Err(format!("{rows} rows of {columns} heights: at least 4 of each are required"));
        }
        if let Some(k) = values.iter().position(|v| !v.is_finite()) {
            let (row, column) = (k / columns + 1, k % columns + 1);
            return Err(format!("row {row}, column {column} is {}: fill the gap, or crop the map", values[k]));
        }
        // The first index of the spline is that along x.
        let turned = (0..columns).flat_map(|i| (0..rows).map(move |j| values[j * columns + i])).collect();
        let spline =
            GridSpline::new(Vector::<2>::from(origin), spacing, [columns, rows], turned).map_err(|e| e.to_string())?;
        Ok(Self { spline, ends: true })
    }

    /// The top of a triangle mesh over a rectangle, sampled with a spacing; or its underside. Beyond the shadow of the
    /// mesh the surface falls off.
    ///
    /// # Errors
    /// A mesh that has no shadow on the rectangle, or one that cannot be sampled so finely.
    pub fn of_mesh(mesh: &TriangleMesh, [low, high]: [Vector<2>; 2], spacing: f64, view: View) -> Result<Self, String> {
        const MOST: usize = 1 << 24;
        let count: [usize; 2] = std::array::from_fn(|k| ((high[k] - low[k]) / spacing).ceil() as usize + 4);
        if count[0].saturating_mul(count[1]) > MOST {
            return Err(format!("{} x {} samples are too many", count[0], count[1]));
        }
        let origin = low - Vector::<2>::repeat(spacing);
        let sign = view.sign();
        // Row by row along x; the first index of the spline is that along x.
        let mut heights = vec![f64::NEG_INFINITY; count[0] * count[1]];
        for triangle in 0..mesh.triangles().len() {
            let [a, b, c] = mesh.corners(triangle);
            let index = |v: f64, k: usize| (v - origin[k]) / spacing;
            let range = |k: usize| {
                let (least, most) = (a[k].min(b[k]).min(c[k]), a[k].max(b[k]).max(c[k]));
                let last = count[k] as f64 - 1.0;
                let first = index(least, k).ceil().max(0.0);
                (first <= last && index(most, k) >= 0.0)
                    .then(|| first as usize..=index(most, k).floor().min(last) as usize)
            };
            let (Some(columns), Some(rows)) = (range(0), range(1)) else { continue };
            let (u, v) = (b - a, c - a);
            let determinant = u[0] * v[1] - u[1] * v[0];
            if determinant == 0.0 {
                continue;
            }
            for i in columns {
                for j in rows.clone() {
                    let d = [origin[0] + i as f64 * spacing - a[0], origin[1] + j as f64 * spacing - a[1]];
                    let s = (d[0] * v[1] - d[1] * v[0]) / determinant;
                    let t = (u[0] * d[1] - u[1] * d[0]) / determinant;
                    if s >= -1e-12 && t >= -1e-12 && s + t <= 1.0 + 1e-12 {
                        let z = sign * (a[2] + s * u[2] + t * v[2]);
                        let height = &mut heights[i * count[1] + j];
                        *height = height.max(z);
                    }
                }
            }
        }
        if heights.iter().all(|h| h.is_infinite()) {
            return Err("it does not lie below the membrane".into());
        }
        fall_off(&mut heights, count, FALL * spacing);
        let values = heights.into_iter().map(|h| sign * h).collect();
        let spline = GridSpline::new(origin, [spacing; 2], count, values).map_err(|e| e.to_string())?;
        Ok(Self { spline, ends: false })
    }
}

/// Fills what lies beyond the shadow, where heights are infinitely low, by a slope down from the nearest places within, in
/// two sweeps; `step` is the fall from one sample to the next.
fn fall_off(heights: &mut [f64], [nx, ny]: [usize; 2], step: f64) {
    let beyond: Vec<bool> = heights.iter().map(|h| h.is_infinite()).collect();
    for forth in [true, false] {
        let sense = if forth { -1 } else { 1 };
        for n in 0..nx * ny {
            let n = if forth { n } else { nx * ny - 1 - n };
            if !beyond[n] {
                continue;
            }
            let (i, j) = ((n / ny) as isize, (n % ny) as isize);
            for (di, dj) in [(sense, -1), (sense, 0), (sense, 1), (0, sense)] {
                let (k, l) = (i + di, j + dj);
                if (0..nx as isize).contains(&k) && (0..ny as isize).contains(&l) {
                    let fall = step * ((di * di + dj * dj) as f64).sqrt();
                    heights[n] = heights[n].max(heights[k as usize * ny + l as usize] - fall);
                }
            }
        }
    }
}
