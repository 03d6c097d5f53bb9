//! What cycles leave of the error, for the tests of multigrid.

use signorini_geometry::{ClosedCurve, Point};
use signorini_membrane::equilibrium::{Elements, Equilibrium};
use signorini_membrane::multigrid::{Hierarchy, Regular};
use signorini_membrane::plane_zone::PlaneZone;
use signorini_membrane::problem::Membrane;

/// A curve through so many points round a centre.
pub fn circle(center: Point<2>, radius: impl Fn(f64) -> f64, points: usize) -> ClosedCurve {
    let points: Vec<Point<2>> = (0..points)
        .map(|k| {
            let a = std::f64::consts::TAU * k as f64 / points as f64;
            center + radius(a) * Point::<2>::new(a.cos(), a.sin())
        })
        .collect();
    ClosedCurve::through(&points, 7)
}

/// The contraction of a cycle in the residual's norm, after the first few.
pub fn contraction<R: Regular>(membrane: &Membrane<2>, zone: &PlaneZone) -> f64 {
    let mut hierarchy = Hierarchy::<R>::new(membrane, zone).expect("levels");
    let level = hierarchy.finest();
    level.b.fill(0.0);
    let mut seed = 1u64;
    for u in &mut level.u {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        *u = (seed >> 40) as f64 / f64::from(1u32 << 24) - 0.5;
    }
    level.silence();
    let norm = |h: &mut Hierarchy<R>| h.finest().residual().iter().map(|r| r * r).sum::<f64>().sqrt();
    let mut norms = vec![norm(&mut hierarchy)];
    for _ in 0..9 {
        hierarchy.cycle().expect("a cycle");
        norms.push(norm(&mut hierarchy));
    }
    (norms[9] / norms[5]).powf(0.25)
}

/// After so many cycles, the largest difference of the displacement from that of the direct solver, the number of points
/// where they were compared, and the relative residual.
pub fn beside_the_direct_solver<R: Regular>(
    membrane: &Membrane<2>,
    zone: &PlaneZone,
    cycles: usize,
) -> (f64, usize, f64) {
    let direct = Equilibrium::solve(membrane, zone, &mut Elements::new(membrane)).expect("a solution");
    let mut hierarchy = Hierarchy::<R>::new(membrane, zone).expect("levels");
    assert!(hierarchy.levels.len() > 1);
    for _ in 0..cycles {
        hierarchy.cycle().expect("a cycle");
    }
    let found = hierarchy.finest();
    let (mut worst, mut points) = (0.0f64, 0);
    direct.for_each_point(|cell, region, x, _| {
        let Some((u, _)) = direct.evaluate(cell, region, x) else { return };
        if let Some(v) = found.evaluate(x) {
            worst = worst.max((u - v).abs());
            points += 1;
        }
    });
    (worst, points, found.relative_residual())
}
