//! The functions along fronts by which they move.

use super::{LONG, PlaneZone, curvatures};
use crate::method::ModeSpace;
use crate::mode_matrix::Clique;
use crate::zone::{FrontFoot, ZoneFronts};
use signorini_geometry::{PeriodicBasis, Point, Vector};

/// Functions of the parameter of a front.
enum FrontModes {
    Splines(PeriodicBasis),
    /// One, and the cosine and sine of every wave number up to the highest.
    Waves {
        highest: usize,
    },
}

impl FrontModes {
    fn count(&self) -> usize {
        match self {
            FrontModes::Splines(basis) => basis.count,
            FrontModes::Waves { highest } => 2 * highest + 1,
        }
    }

    /// Calls `visit(mode, value, derivative)` for every function that does not vanish at a parameter.
    fn for_each_at(&self, s: f64, mut visit: impl FnMut(usize, f64, f64)) {
        match self {
            FrontModes::Splines(basis) => {
                let b = basis.bumps(s);
                // Few splines meet themselves round the curve: their bumps are added up.
                for i in 0..b.len.min(basis.count) {
                    let same = (i..b.len).step_by(basis.count);
                    let (value, slope) = same.fold((0.0, 0.0), |(v, d), k| (v + b.value[k], d + b.d1[k]));
                    visit(basis.index(&b, i), value, slope);
                }
            }
            FrontModes::Waves { highest } => {
                visit(0, 1.0, 0.0);
                for k in 1..=*highest {
                    let omega = std::f64::consts::TAU * k as f64;
                    let (sin, cos) = (omega * s).sin_cos();
                    visit(2 * k - 1, cos, -omega * sin);
                    visit(2 * k, sin, omega * cos);
                }
            }
        }
    }
}

impl PlaneZone {
    fn modes(&self, front: usize, space: ModeSpace) -> FrontModes {
        let curve = &self.curves[front];
        let most = self.mode_counts[front];
        match space {
            ModeSpace::Coarse(count) if count < most => FrontModes::Splines(PeriodicBasis { degree: 3, count }),
            ModeSpace::Coarse(_) | ModeSpace::Fine => {
                FrontModes::Splines(PeriodicBasis { degree: curve.degree(), count: most })
            }
            ModeSpace::Fourier(count) => {
                // Waves must be longer than the splines that draw them.
                let told_apart = if self.grid.degree() == 1 { most } else { most / 2 };
                FrontModes::Waves { highest: count.min(told_apart).max(1).div_ceil(2) - 1 }
            }
        }
    }

    /// Displacement of a front by coefficients of the modes, as a function of its parameter.
    pub(super) fn displacement<'a>(
        &self,
        front: usize,
        space: ModeSpace,
        step: &'a [f64],
    ) -> impl Fn(f64) -> f64 + use<'a> {
        let modes = self.modes(front, space);
        let offset = self.mode_offsets(space)[front];
        move |s| {
            let mut sum = 0.0;
            modes.for_each_at(s, |mode, value, _| sum += value * step[offset + mode]);
            sum
        }
    }

    /// The fronts moved by `step` on the same parameter, without any check: for derivatives with respect to the shape.
    pub fn displaced(&self, space: ModeSpace, step: &[f64]) -> Self {
        let curves = self
            .curves
            .iter()
            .enumerate()
            .map(|(i, c)| {
                let w = self.displacement(i, space, step);
                c.offset(4 * c.knots(), |p| w(p.s))
            })
            .collect();
        self.with_curves(&self.grid, curves)
    }
}

impl ZoneFronts<2> for PlaneZone {
    fn foot(&self, front: usize, x: &Point<2>, space: ModeSpace) -> FrontFoot<2> {
        let seeds = self.seeds(self.grid.cell_containing(x), front);
        let foot = match seeds.is_empty() {
            true => self.curves[front].closest(x, 0..self.curves[front].samples().len()),
            false => self.curves[front].closest(x, seeds.into_iter()),
        };
        let offset = self.mode_offsets(space)[front];
        // The normal lies to the right of the direction of travel.
        let along = Vector::<2>::new(-foot.normal[1], foot.normal[0]) / foot.speed;
        let mut modes = Vec::new();
        self.modes(front, space).for_each_at(foot.s, |mode, value, slope| {
            modes.push((offset + mode, value, along * slope));
        });
        FrontFoot {
            position: foot.position,
            parameter: foot.s.rem_euclid(1.0),
            normal: foot.normal,
            curvature: foot.curvature,
            modes,
        }
    }

    fn front_count(&self) -> usize {
        self.curves.len()
    }

    fn mode_offsets(&self, space: ModeSpace) -> Vec<usize> {
        let mut offsets = vec![0];
        for i in 0..self.curves.len() {
            offsets.push(offsets[i] + self.modes(i, space).count());
        }
        offsets
    }

    fn stiffness(&self, space: ModeSpace, front: usize, weight: f64) -> Vec<Clique> {
        let offset = self.mode_offsets(space)[front];
        let modes = self.modes(front, space);
        let curve = &self.curves[front];
        let points = curve.samples().len();
        let at = |k: usize| {
            let s = curve.sample_parameter(k);
            let (mut numbers, mut slopes) = (Vec::new(), Vec::new());
            modes.for_each_at(s, |mode, _, slope| {
                numbers.push((offset + mode) as u32);
                slopes.push(slope);
            });
            let factor = weight / curve.point(s).speed / points as f64;
            let products = slopes.iter().flat_map(|a| slopes.iter().map(move |b| factor * a * b)).collect();
            (numbers, products)
        };
        (0..points).map(at).collect()
    }

    fn sharpest(&self) -> f64 {
        self.curves.iter().flat_map(curvatures).fold(0.0, f64::max)
    }

    fn least_feature(&self) -> f64 {
        let features = self.features(&self.grid, 0.0);
        features.iter().map(|f| f.apart.min(1.0 / f.curvature)).fold(f64::INFINITY, f64::min)
    }

    fn bend(&self) -> f64 {
        (0..self.curves.len()).map(|c| self.bend_of(c)).fold(0.0, f64::max)
    }

    fn fronts_are_long(&self) -> bool {
        self.curves.iter().all(|curve| self.relative_length(curve) >= LONG)
    }

    fn has_tips(&self, bend: f64) -> bool {
        let mut sharp = (0..self.curves.len()).filter(|c| self.bend_of(*c) >= bend).peekable();
        sharp.peek().is_some() && sharp.all(|c| self.relative_length(&self.curves[c]) >= LONG)
    }
}
