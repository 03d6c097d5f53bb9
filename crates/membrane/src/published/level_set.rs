//! Fronts as the zero level of a function on the nodes of a grid, linear between them: moved as it was published.

use signorini_fem::Grid;
use signorini_geometry::outline::Samples;
use signorini_geometry::{Aabb, Point, Vector};

/// Cells beyond the membrane, so that a zone may run over a free edge.
const MARGIN: usize = 3;
/// The part of a cell that a front crosses in one step of the transport equation.
const COURANT: f64 = 0.5;

/// A level set on the nodes of a grid, negative in the zone.
pub struct NodalLevelSet {
    samples: Samples,
    size: Vector<2>,
}

impl NodalLevelSet {
    /// Evaluates a function at the nodes of a grid and of a few cells round it.
    pub fn of(grid: &Grid<2>, value: impl FnMut(&Point<2>) -> f64) -> Self {
        let size = grid.cell_size();
        let margin = MARGIN as f64 * size;
        let frame = Aabb::new(grid.bounds().min - margin, grid.bounds().max + margin);
        Self { samples: Samples::of(frame, grid.cells().map(|n| n + 2 * MARGIN), value), size }
    }

    /// Carries the level set along for a unit of time: `φ_t + w |∇φ| = 0`, with the speed of the nearest point of the front,
    /// by Godunov's upwind differences. (S. Osher & J. Sethian, J. Comput. Phys. 79, 1988.)
    pub fn carried(mut self, speed: impl Fn(&Point<2>) -> f64) -> Self {
        let [nx, ny] = self.samples.cells;
        let speeds: Vec<f64> = (0..=ny)
            .flat_map(|j| (0..=nx).map(move |i| (i, j)))
            .map(|(i, j)| speed(&self.samples.node(i, j)))
            .collect();
        let fastest = speeds.iter().fold(0.0f64, |m, w| m.max(w.abs()));
        let steps = (fastest / (COURANT * self.size.min())).ceil().max(1.0);
        for _ in 0..steps as usize {
            let before = self.samples.values.clone();
            let at = |i: usize, j: usize| before[j * (nx + 1) + i];
            for j in 0..=ny {
                for i in 0..=nx {
                    let here = at(i, j);
                    let w = speeds[j * (nx + 1) + i];
                    // Beyond the frame the function goes on as it comes.
                    let backward = [
                        if i > 0 { here - at(i - 1, j) } else { at(1, j) - here },
                        if j > 0 { here - at(i, j - 1) } else { at(i, 1) - here },
                    ];
                    let forward = [
                        if i < nx { at(i + 1, j) - here } else { here - at(nx - 1, j) },
                        if j < ny { at(i, j + 1) - here } else { here - at(i, ny - 1) },
                    ];
                    let square: f64 = (0..2)
                        .map(|k| {
                            let (b, f) = (w.signum() * backward[k], w.signum() * forward[k]);
                            (b.max(0.0).max(-f.min(0.0)) / self.size[k]).powi(2)
                        })
                        .sum();
                    self.samples.values[j * (nx + 1) + i] = here - w / steps * square.sqrt();
                }
            }
        }
        self
    }

    /// The zero level, as closed polylines with the zone on their left.
    pub fn outlines(&self) -> Vec<Vec<Point<2>>> {
        self.samples.outlines()
    }
}
