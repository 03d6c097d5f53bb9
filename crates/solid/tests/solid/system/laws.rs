//! Laws of contact that give way, against closed forms.

use super::*;
use signorini_contact::Law;
use signorini_contact::law::{Friction, LawPoint};
use signorini_geometry::rigid_shape::Plane;

/// A rough surface: the pressure `p_0 exp(-g/l)` at any gap. As a barrier, nothing penetrates far.
#[derive(Clone, Copy, Debug)]
struct Rough {
    scale: f64,
    length: f64,
}

impl Law for Rough {
    fn friction(&self, _: [f64; 2], _: f64) -> Friction {
        Friction { traction: [0.0; 2], by_trial: [[0.0; 2]; 2], by_pressure: [0.0; 2], slips: true }
    }

    fn utilisation(&self, _: [f64; 2], _: f64) -> f64 {
        0.0
    }

    fn per_pressure(&self) -> Option<[f64; 2]> {
        None
    }

    /// `p + c l y = ζ` with `y = ln(p/p_0)`, convex in `y`: Newton's method comes to it from above.
    fn pressure(&self, trial: f64, point: &LawPoint) -> [f64; 2] {
        let softness = point.per_gap * self.length;
        let mut y = (trial / softness).min((trial / self.scale).max(1.0).ln());
        for _ in 0..100 {
            let p = self.scale * y.exp();
            let step = (p + softness * y - trial) / (p + softness);
            y -= step;
            if step.abs() <= 4.0 * f64::EPSILON * y.abs().max(1.0) {
                break;
            }
        }
        let p = self.scale * y.exp();
        [p, p / (p + softness)]
    }

    fn range(&self) -> f64 {
        f64::INFINITY
    }

    fn is_compliant(&self) -> bool {
        true
    }
}

#[test]
fn the_gap_of_a_rough_surface_is_that_of_its_pressure() {
    let rough = Rough { scale: 0.05, length: 0.01 };
    for (p, c, above) in [(2e-3, 3.0, true), (0.02, 10.0, false), (0.4, 0.7, true)] {
        // The implicit function: the law holds with the gap of the trial, and its derivative is that of differences.
        let point = LawPoint { per_gap: c, duration: 0.0 };
        let trial: f64 = p + c * rough.length * (p / rough.scale).ln();
        let [found, slope] = rough.pressure(trial, &point);
        let near = |h: f64| rough.pressure(trial + h, &point)[0];
        assert!((found / p - 1.0).abs() < 1e-12 && (slope - (near(1e-6) - near(-1e-6)) / 2e-6).abs() < 1e-7, "{above}");
    }
    // A penalty would give way besides the law.
    let enforcements = [Enforcement::Multiplier, Enforcement::AugmentedLagrangian];
    let sites = [Test::Sites(Sampling::GaussPoints), Test::Mortar(0)];
    for (test, enforcement) in sites.into_iter().flat_map(|t| enforcements.map(|e| (t, e))) {
        // Below and above the scale of the law; the block starts apart and ends apart, or inside by a little.
        for p in [0.01, 0.1] {
            let mut system = System::default();
            let block = rectangle([0.0, 0.0], [2.0, 1.0], [4, 2], 1, |x| x);
            system.bodies.push(Box::new(solid("block", block, 1, ELASTIC, StressLaw::LinearElastic)));
            let floor = Plane { point: v(0.0, -0.02, 0.0), normal: v(0.0, 1.0, 0.0) };
            system.bodies.push(Box::new(rigid(floor, |_| Vector::<3>::zeros())));
            for side in ["left", "right"] {
                system.supports.push(hold(0, side, [Some(0.0), None, None]));
            }
            let pressure: TimeField = Arc::new(move |_, t| p * t);
            system.loads.push(load(0, "top", TimedLoad::Pressure(pressure)));
            touch(&mut system, [(0, "bottom"), (1, "")], test, enforcement, None);
            system.contacts[0].law_mut().friction = Some(Box::new(rough));
            let (_, results) = run(&mut system, &[0.5, 1.0]);
            let gap = -rough.length * (p / rough.scale).ln();
            for site in results[1].sites[0].iter().filter(|s| s.weight > 0.0) {
                let error = (site.gap.unwrap() - gap).abs();
                assert!(error < 2e-6 && (site.pressure / p - 1.0).abs() < 1e-6, "{test:?} {enforcement:?}: {error:e}");
            }
            assert!(results.iter().all(|r| r.iterations < 40), "{}", told(&results));
        }
    }
}
