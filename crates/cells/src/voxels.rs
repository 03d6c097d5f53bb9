//! Bodies from images: the surface at a threshold, or a modulus of every voxel.
//!
//! The surface is the level of a cubic spline through smoothed values. Without smoothing the spline follows the
//! staircase of the voxels and its normals never converge; a Gaussian of one voxel mends that, and moves a surface of
//! curvatures `κ_1`, `κ_2` inwards by `σ² (κ_1 + κ_2)/2`.

use crate::error::CellsError;
use crate::region::{Filling, Integration, MaterialRule, Region};
use signorini_fem::QuadraturePoint;
use signorini_fem::cut::End;
use signorini_geometry::grid_spline::GridSpline;
use signorini_geometry::rule::gauss_legendre;
use signorini_geometry::{Aabb, Point};
use std::sync::Arc;

/// Values of voxels, the first index running fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct Voxels<const D: usize> {
    /// Corner of the first voxel.
    pub origin: Point<D>,
    pub spacing: [f64; D],
    pub count: [usize; D],
    pub values: Vec<f64>,
}

impl<const D: usize> Voxels<D> {
    /// # Errors
    /// Counts, spacings or values that cannot be those of an image.
    pub fn new(origin: Point<D>, spacing: [f64; D], count: [usize; D], values: Vec<f64>) -> Result<Self, CellsError> {
        if count.iter().product::<usize>() != values.len() || values.is_empty() {
            let must = "the counts must multiply to the number of values";
            return Err(CellsError::Image { what: "an image", found: [&count[..], &[values.len()]].concat(), must });
        }
        if let Some(h) = spacing.iter().find(|h| !(**h > 0.0 && h.is_finite())) {
            return Err(CellsError::Value { name: "spacing", value: *h, must: "must be positive" });
        }
        if let Some(at) = values.iter().position(|v| !v.is_finite()) {
            let stride = |k: usize| count[..k].iter().product::<usize>();
            let voxel = (0..D).map(|k| at / stride(k) % count[k]).collect();
            return Err(CellsError::Voxel { voxel, value: values[at] });
        }
        Ok(Voxels { origin, spacing, count, values })
    }

    /// The box of all voxels.
    pub fn bounds(&self) -> Aabb<D> {
        let size = Point::from_fn(|k, _| self.spacing[k] * self.count[k] as f64);
        Aabb::new(self.origin, self.origin + size)
    }

    /// The voxel that contains a point, the nearest for points outside.
    pub fn voxel_at(&self, x: &Point<D>) -> usize {
        (0..D).rev().fold(0, |n, k| {
            let t = ((x[k] - self.origin[k]) / self.spacing[k]).floor().max(0.0) as usize;
            n * self.count[k] + t.min(self.count[k] - 1)
        })
    }

    /// Smoothed by a Gaussian with a standard deviation of so many voxels; values go on beyond the image.
    #[must_use]
    pub fn smoothed(&self, sigma: f64) -> Self {
        let mut out = self.clone();
        if sigma <= 0.0 {
            return out;
        }
        let reach = (4.0 * sigma).ceil() as isize;
        let kernel: Vec<f64> = (-reach..=reach).map(|i| (-0.5 * (i as f64 / sigma).powi(2)).exp()).collect();
        let total: f64 = kernel.iter().sum();
        for axis in 0..D {
            let stride: usize = self.count[..axis].iter().product();
            let n = self.count[axis];
            let before = out.values.clone();
            for (place, value) in out.values.iter_mut().enumerate() {
                let at = place / stride % n;
                let first = place - at * stride;
                *value = (kernel.iter().enumerate())
                    .map(|(i, w)| {
                        let j = (at as isize + i as isize - reach).clamp(0, n as isize - 1) as usize;
                        w * before[first + j * stride]
                    })
                    .sum::<f64>()
                    / total;
            }
        }
        out
    }

    /// The shape of what is above a threshold, after smoothing by so many voxels (1 is good).
    ///
    /// # Errors
    /// A threshold with nothing or everything above it; fewer than four voxels in a direction.
    pub fn above(&self, threshold: f64, smoothing: f64) -> Result<Arc<GridSpline<D>>, CellsError> {
        let (least, most) =
            self.values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, m), v| (l.min(*v), m.max(*v)));
        if threshold.is_nan() || most <= threshold || least > threshold {
            return Err(CellsError::Threshold { threshold, least, most });
        }
        if self.count.iter().any(|n| *n < 4) {
            let must = "a surface needs four voxels at least in each direction";
            return Err(CellsError::Image { what: "an image", found: self.count.to_vec(), must });
        }
        let smooth = self.smoothed(smoothing);
        let total = self.values.len();
        // The spline wants the last index to run fastest.
        let values = (0..total).map(|mut i| {
            let mut index = [0; D];
            for k in (0..D).rev() {
                index[k] = i % self.count[k];
                i /= self.count[k];
            }
            threshold - smooth.values[(0..D).rev().fold(0, |n, k| n * self.count[k] + index[k])]
        });
        let middle = Point::<D>::from_fn(|k, _| self.origin[k] + 0.5 * self.spacing[k]);
        let spline = GridSpline::new(middle, self.spacing, self.count, values.collect())
            .map_err(|_| CellsError::Threshold { threshold, least, most })?;
        Ok(Arc::new(spline))
    }
}

/// A body of voxels with a modulus each, in which voxels without one are empty. Each voxel is integrated exactly.
#[derive(Clone, Debug)]
pub struct ModulusImage<const D: usize> {
    voxels: Voxels<D>,
}

impl<const D: usize> ModulusImage<D> {
    /// A body of voxels whose values are factors of Young's modulus.
    ///
    /// # Errors
    /// Negative values, or none above zero.
    pub fn new(voxels: Voxels<D>) -> Result<Self, CellsError> {
        if let Some(v) = voxels.values.iter().find(|v| **v < 0.0) {
            return Err(CellsError::Value { name: "the modulus of a voxel", value: *v, must: "must not be negative" });
        }
        if voxels.values.iter().all(|v| *v == 0.0) {
            return Err(CellsError::Nothing);
        }
        Ok(ModulusImage { voxels })
    }

    /// The factor of the modulus in space, with its largest value, for [`crate::CellMaterial::modulus`].
    pub fn modulus(&self) -> (crate::cell::Field<D>, f64) {
        let most = self.voxels.values.iter().fold(0.0f64, |m, v| m.max(*v));
        let voxels = self.voxels.clone();
        (Arc::new(move |x: &Point<D>| voxels.values[voxels.voxel_at(x)]), most)
    }

    fn value(&self, x: &Point<D>) -> f64 {
        if self.voxels.bounds().contains(x) { self.voxels.values[self.voxels.voxel_at(x)] } else { 0.0 }
    }

    /// The boxes in which the sides of voxels divide a box.
    fn divided(&self, b: &Aabb<D>) -> Vec<Aabb<D>> {
        let mut out = vec![*b];
        for k in 0..D {
            let (low, high, h) = (b.min[k], b.max[k], self.voxels.spacing[k]);
            if low == high {
                continue;
            }
            let slack = 1e-9 * h;
            let planes: Vec<f64> = (0..=self.voxels.count[k])
                .map(|i| self.voxels.origin[k] + h * i as f64)
                .filter(|x| *x > low + slack && *x < high - slack)
                .collect();
            let ends: Vec<f64> = [low].into_iter().chain(planes).chain([high]).collect();
            out = (out.into_iter())
                .flat_map(|part| {
                    ends.windows(2)
                        .map(move |e| {
                            let mut part = part;
                            (part.min[k], part.max[k]) = (e[0], e[1]);
                            part
                        })
                        .collect::<Vec<_>>()
                })
                .collect();
        }
        out
    }
}

impl<const D: usize> Region<D> for ModulusImage<D> {
    fn rule(&self, b: &Aabb<D>, _: &Integration, degree: usize) -> MaterialRule<D> {
        let mut volume = Vec::new();
        for part in self.divided(b).iter().filter(|p| self.value(&p.center()) > 0.0) {
            let points = crate::moments::box_points(part, degree + 1);
            volume.extend(points.into_iter().map(|(x, weight)| QuadraturePoint { x, weight }));
        }
        let filling = if volume.is_empty() { Filling::Void } else { Filling::Cut };
        MaterialRule { volume, ..MaterialRule::empty(filling) }
    }

    fn side_rule(&self, b: &Aabb<D>, axis: usize, end: End, points: usize) -> Vec<QuadraturePoint<D>> {
        let mut side = *b;
        let at = end.of(b, axis);
        (side.min[axis], side.max[axis]) = (at, at);
        let inwards = -1e-9 * end.sign() * b.size()[axis];
        let gauss = gauss_legendre(points);
        let mut out = Vec::new();
        for part in self.divided(&side) {
            let mut middle = part.center();
            middle[axis] += inwards;
            if self.value(&middle) == 0.0 {
                continue;
            }
            for mut i in 0..points.pow(D as u32 - 1) {
                let mut weight = 1.0;
                let x = Point::from_fn(|k, _| {
                    if k == axis {
                        return at;
                    }
                    let (t, w) = gauss[i % points];
                    i /= points;
                    weight *= w * (part.max[k] - part.min[k]);
                    part.min[k] + t * (part.max[k] - part.min[k])
                });
                out.push(QuadraturePoint { x, weight });
            }
        }
        out
    }

    fn contains(&self, x: &Point<D>) -> bool {
        self.value(x) > 0.0
    }
}
