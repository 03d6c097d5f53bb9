//! Volume, centre and moments of inertia, by the divergence theorem on the faces.
//!
//! With `N = r_u × r_v`, `∫ f dV = ∮ f x·N / (3 + k) du dv` of every `f` that is homogeneous of degree `k`. Over the triangles of
//! the parameters and the slivers between chords and edges this is summed by Gauss's rule: what it lacks is of high order in
//! the size of the triangles.

use super::TrimmedSolid;
use super::face::Face;
use super::triangulate::{Flat, chords};
use crate::mass_properties::MassProperties;
use crate::{Matrix, Point, Vector};

/// Abscissae and weights on `[0, 1]`.
const GAUSS: [[f64; 2]; 5] = [
    [0.046_910_077_030_668, 0.118_463_442_528_094_5],
    [0.230_765_344_947_158_45, 0.239_314_335_249_683_25],
    [0.5, 0.284_444_444_444_444_45],
    [0.769_234_655_052_841_5, 0.239_314_335_249_683_25],
    [0.953_089_922_969_332, 0.118_463_442_528_094_5],
];

#[derive(Default)]
struct Sums {
    volume: f64,
    first: Vector<3>,
    second: Matrix<3>,
}

impl TrimmedSolid {
    pub(super) fn integrate(&self) -> MassProperties {
        let divided = chords(self);
        let origin = self.bounds.center();
        let mut sums = Sums::default();
        for face in &self.faces {
            let flat = face.triangles(self, &divided);
            face.integrate(self, &flat, &origin, &mut sums);
        }
        let (volume, first, second) = (sums.volume / 3.0, sums.first / 4.0, sums.second / 5.0);
        let mean = first / volume;
        let second = second - mean * mean.transpose() * volume;
        MassProperties { volume, centre: origin + mean, inertia: Matrix::<3>::identity() * second.trace() - second }
    }
}

impl Face {
    /// Adds what a weight, in scaled parameters, at a place carries.
    fn add(&self, z: [f64; 2], weight: f64, origin: &Point<3>, sums: &mut Sums) {
        let [p, q] = self.region.scale;
        let t = self.surface.tangents([z[0] / p, z[1] / q]);
        let x = t.x - origin;
        let own = x.dot(&t.u.cross(&t.v)) * (weight * self.sign / (p * q));
        sums.volume += own;
        sums.first += x * own;
        sums.second += x * x.transpose() * own;
    }

    fn integrate(&self, solid: &TrimmedSolid, flat: &Flat, origin: &Point<3>, sums: &mut Sums) {
        for t in &flat.triangles {
            let [a, b, c] = t.map(|k| flat.corners[k].0);
            let (e, f) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
            let area = e[0] * f[1] - e[1] * f[0];
            // The square pressed onto the triangle.
            for [s, v] in GAUSS {
                for [r, w] in GAUSS {
                    let (p, q) = (s, r * (1.0 - s));
                    let z = [0, 1].map(|k| a[k] + p * e[k] + q * f[k]);
                    self.add(z, area * v * w * (1.0 - s), origin, sums);
                }
            }
        }
        let scale = self.region.scale;
        let periods = self.surface.periods();
        for chord in &flat.chords {
            let use_ = &self.uses[chord.of];
            let curve = &solid.edges[use_.edge].curve;
            let [a, b] = chord.ends;
            let straight = |s: f64| [0, 1].map(|k| a[k] + s * (b[k] - a[k]));
            let bent = |s: f64| {
                let x = curve.position(chord.t[0] + s * (chord.t[1] - chord.t[0]));
                let near = straight(s);
                let z = self.surface.parameters(&x, Some([near[0] / scale[0], near[1] / scale[1]]));
                [0, 1].map(|k| {
                    let d = z[k] * scale[k] - near[k];
                    near[k] + periods[k].map_or(d, |p| d - p * scale[k] * (d / (p * scale[k])).round())
                })
            };
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            // Central differences: their error is of the second order in a sliver that is thin itself.
            let step = 1e-4;
            for [s, v] in GAUSS {
                let (p, c) = (straight(s), bent(s));
                let across = [c[0] - p[0], c[1] - p[1]];
                // At poles no chord follows the parameters.
                if across[0].hypot(across[1]) > 0.5 * length {
                    continue;
                }
                let (before, after) = (bent(s - step), bent(s + step));
                let along = [0, 1].map(|k| (after[k] - before[k]) / (2.0 * step));
                for [r, w] in GAUSS {
                    let run = [0, 1].map(|k| (1.0 - r) * (b[k] - a[k]) + r * along[k]);
                    let area = run[0] * across[1] - run[1] * across[0];
                    let z = [0, 1].map(|k| p[k] + r * across[k]);
                    // Loops have the face on the left where the normal of the surface points outwards.
                    self.add(z, -self.sign * area * v * w, origin, sums);
                }
            }
        }
    }
}
