use super::*;
use proptest::prelude::*;

/// Laws of every kind, with a pressure and the size of the friction that it makes available.
fn laws() -> Vec<Box<dyn Law>> {
    vec![
        Box::new(Coulomb::isotropic(0.4).unwrap()),
        Box::new(Coulomb::orthotropic([0.7, 0.2]).unwrap()),
        Box::new(Coulomb::orthotropic([0.1, 0.9]).unwrap()),
        Box::new(Coulomb::orthotropic([0.0, 0.5]).unwrap()),
        Box::new(Tresca::new(0.5).unwrap()),
        Box::new(Viscous::new(0.4, 0.3).unwrap()),
    ]
}

fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
}

/// What the derivative at a trial predicts badly after steps along a direction, for two steps of which one is half the
/// other.
fn taylor(law: &dyn Law, trial: [f64; 3], direction: [f64; 3], step: f64) -> [f64; 2] {
    let at = law.project(trial);
    [step, 0.5 * step].map(|h| {
        let moved = law.project(std::array::from_fn(|k| trial[k] + h * direction[k]));
        let predicted: [f64; 3] = std::array::from_fn(|r| {
            at.traction[r] + h * (0..3).map(|c| at.derivative[r][c] * direction[c]).sum::<f64>()
        });
        distance(&moved.traction, &predicted)
    })
}

fn of_second_order([coarse, fine]: [f64; 2]) -> bool {
    // Where a branch is linear nothing is left but round-off.
    coarse < 1e-13 || (3.5..4.5).contains(&(coarse / fine))
}

#[test]
fn derivatives_are_of_second_order_in_every_branch() {
    let trials = [[1.3, 0.05, -0.02], [1.3, 0.9, 0.4], [1.3, -0.02, 1.5], [1.3, 2.0, -1e-3], [-0.7, 0.4, 0.1]];
    let directions = [[0.3, 0.0, 0.0], [0.0, 0.8, -0.1], [0.2, 0.3, 0.5]];
    for law in laws() {
        for trial in trials {
            for direction in directions {
                let errors = taylor(law.as_ref(), trial, direction, 1e-3);
                assert!(of_second_order(errors), "{law:?} at {trial:?} along {direction:?}: {errors:?}");
            }
        }
    }
}

/// Just beyond a switch the derivative is that of the branch entered: into slip, into stick, into open.
#[test]
fn derivatives_beside_a_switch_are_those_of_their_branch() {
    for law in laws() {
        let p = 1.3;
        // Where the trial leaves what is admissible, along a skew direction.
        let along = [0.6, 0.8];
        let limit = 1.0 / law.utilisation(along, p).max(1e-300);
        if limit < 1e-200 {
            continue;
        }
        for (share, outward) in [(1.0 + 1e-12, 1.0), (1.0 - 1e-12, -1.0)] {
            let trial = [p, share * limit * along[0], share * limit * along[1]];
            let status = law.project(trial).status;
            assert_eq!(status, if outward > 0.0 { Status::Slip } else { Status::Stick }, "{law:?}");
            for direction in [[0.0, 0.5, 0.7], [-0.2, 0.4, 0.1]] {
                // Less pressure is outward too.
                let errors = taylor(law.as_ref(), trial, direction.map(|d| outward * d), 1e-3);
                assert!(of_second_order(errors), "{law:?} {outward}: {errors:?}");
            }
        }
        let closed = law.project([1e-12, 0.0, 0.0]);
        assert_eq!(closed.status, Status::Stick);
        assert_eq!(law.project([-1e-12, 0.3, 0.0]), Projected::default());
    }
}

#[test]
fn a_skew_ellipse_at_the_extremes() {
    // Needles, and trials that are far away or nearly on an axis.
    for mu in [[1.0, 1e-6], [1e-6, 1.0], [0.3, 0.30000001]] {
        let law = Coulomb::orthotropic(mu).unwrap();
        for trial in [[1e8, 1.0], [1.0, 1e8], [0.5, 1e-12], [1e-12, 0.5], [3.0, 4.0]] {
            let found = law.friction(trial, 1.0);
            if found.slips {
                assert!((law.utilisation(found.traction, 1.0) - 1.0).abs() < 1e-12, "{mu:?} {trial:?}: {found:?}");
            } else {
                assert_eq!(found.traction, trial);
            }
        }
    }
}

#[test]
fn what_cannot_be_is_refused() {
    assert_eq!(Coulomb::isotropic(-0.1), Err(LawError { value: -0.1 }));
    assert!(Coulomb::orthotropic([0.1, f64::NAN]).is_err());
    assert!(Tresca::new(f64::INFINITY).is_err());
}

proptest! {
    /// The traction is admissible and no admissible one is closer: what was taken away is normal to the set, along which
    /// the body slips.
    #[test]
    fn slip_is_associated(
        mu in prop::array::uniform2(0.01..2.0f64),
        trial in prop::array::uniform2(-3.0..3.0f64),
        other in 0.0..std::f64::consts::TAU,
        p in 0.01..3.0f64,
    ) {
        let law = Coulomb::orthotropic(mu).unwrap();
        let found = law.friction(trial, p);
        prop_assert!(law.utilisation(found.traction, p) <= 1.0 + 1e-12);
        let away = [trial[0] - found.traction[0], trial[1] - found.traction[1]];
        // Every other admissible traction does less work on the slip.
        let rival = [mu[0] * p * other.cos(), mu[1] * p * other.sin()];
        let work = |t: [f64; 2]| t[0] * away[0] + t[1] * away[1];
        prop_assert!(work(rival) <= work(found.traction) + 1e-12 * (1.0 + p * p));
        // The most that friction can do on a slip is what the coupling says.
        if found.slips {
            prop_assert!((work(found.traction) - p * law.coupling(away)).abs() <= 1e-11 * (1.0 + p * p));
        }
    }

    /// Isotropic friction turns with the trial; orthotropic friction with its axes exchanged is the same.
    #[test]
    fn friction_is_objective(
        mu in prop::array::uniform2(0.05..2.0f64),
        trial in prop::array::uniform2(-3.0..3.0f64),
        angle in 0.0..std::f64::consts::TAU,
    ) {
        let (s, c) = angle.sin_cos();
        let turn = |v: [f64; 2]| [c * v[0] - s * v[1], s * v[0] + c * v[1]];
        let law = Coulomb::isotropic(mu[0]).unwrap();
        let (still, turned) = (law.friction(trial, 0.8), law.friction(turn(trial), 0.8));
        let expected = turn(still.traction);
        prop_assert!((0..2).all(|k| (turned.traction[k] - expected[k]).abs() < 1e-14));
        // Columns of the derivative turn as vectors, then its rows.
        let half: [[f64; 2]; 2] = std::array::from_fn(|column| turn([still.by_trial[0][column], still.by_trial[1][column]]));
        for r in 0..2 {
            let row = turn([half[0][r], half[1][r]]);
            prop_assert!((0..2).all(|k| (turned.by_trial[r][k] - row[k]).abs() < 1e-14));
        }
        let swap = |v: [f64; 2]| [v[1], v[0]];
        let [one, two] = [(mu, trial), (swap(mu), swap(trial))]
            .map(|(mu, trial)| Coulomb::orthotropic(mu).unwrap().friction(trial, 0.8));
        prop_assert!((0..2).all(|k| (one.traction[k] - two.traction[1 - k]).abs() < 1e-14));
    }

    /// Traction and derivative do not depend on the unit of stress.
    #[test]
    fn units_do_not_matter(
        mu in prop::array::uniform2(0.05..2.0f64),
        trial in prop::array::uniform3(-3.0..3.0f64),
        unit in -9.0..9.0f64,
    ) {
        let law = Coulomb::orthotropic(mu).unwrap();
        let unit = 10f64.powf(unit);
        let (one, other) = (law.project(trial), law.project(trial.map(|t| unit * t)));
        prop_assert_eq!(one.status, other.status);
        for r in 0..3 {
            prop_assert!((unit * one.traction[r] - other.traction[r]).abs() <= 1e-12 * unit);
            prop_assert!((0..3).all(|c| (one.derivative[r][c] - other.derivative[r][c]).abs() < 1e-11));
        }
    }
}

fn rate_and_state(evolution: Evolution, a: f64, b: f64) -> Result<RateAndState, LawError> {
    RateAndState::new(RateAndStateKeys { mu: 0.6, a, b, velocity: 1e-3, distance: 0.02, evolution, state: 20.0 })
}

/// Friction is that of the velocity and of the state at the end, with derivatives of second order; steady slip has the steady
/// friction, whatever the increments.
#[test]
fn rate_and_state_friction_is_that_of_its_velocity() {
    let p = 1.3;
    for evolution in [Evolution::Aging, Evolution::Slip] {
        let law = rate_and_state(evolution, 0.01, 0.015).unwrap();
        for (rate, duration, remembered) in [(40.0, 0.5, 0.0), (40.0, 3.0, -1.2), (900.0, 20.0, 0.4)] {
            let at =
                |z: [f64; 3]| law.traction(z, &LawPoint { per_gap: rate, duration, remembered, ..LawPoint::default() });
            for trial in [[0.05, -0.02], [0.6, 0.3], [0.5, -1.2], [-4.0, 3.0]] {
                let z = [p, trial[0], trial[1]];
                let found = at(z);
                let [_, t1, t2] = found.traction;
                let velocity = (trial[0] - t1).hypot(trial[1] - t2) / (rate * duration);
                if velocity > 1e-12 {
                    let known = p * law.coefficient(remembered, velocity, duration)[0];
                    assert!((t1.hypot(t2) - known).abs() < 1e-4 * p, "{evolution:?} {rate} {trial:?}: {known}");
                }
                for direction in [[0.3, 0.0, 0.0], [0.0, 0.8, -0.1], [0.2, 0.3, 0.5]] {
                    let errors = [4e-4, 2e-4].map(|h| {
                        let moved = at(std::array::from_fn(|k| z[k] + h * direction[k])).traction;
                        let linear: [f64; 3] = std::array::from_fn(|r| {
                            found.traction[r] + h * (0..3).map(|c| found.derivative[r][c] * direction[c]).sum::<f64>()
                        });
                        distance(&moved, &linear)
                    });
                    assert!(of_second_order(errors), "{evolution:?} {rate} {trial:?} along {direction:?}: {errors:?}");
                }
            }
        }
        let mut remembered = 0.0;
        for velocity in [1e-3, 1e-2] {
            (0..40).for_each(|_| remembered = law.state(remembered, velocity, 10.0)[0]);
            let steady = 0.6 + (0.01 - 0.015) * f64::ln(velocity / 1e-3);
            let found = law.coefficient(remembered, velocity, 10.0)[0];
            assert!((found - steady).abs() < 1e-10, "{evolution:?}: {found} {steady}");
        }
    }
    assert!(rate_and_state(Evolution::Slip, 0.0, 0.01).is_err());
}

/// A slider of one spring, drawn ten times faster than it slid: with increments it comes to what the differential equations give,
/// in first order. A spring softer than `p (b - a)/D` runs away from a small disturbance, a stiffer one comes to rest.
#[test]
fn a_slider_on_a_spring_is_stable_where_theory_says() {
    let (p, a, b, v0, d) = (1.0, 0.01, 0.015, 1e-3, 0.02);
    for evolution in [Evolution::Aging, Evolution::Slip] {
        let law = rate_and_state(evolution, a, b).unwrap();
        // `k (drawn - x) = T` in increments: the trial has the stiffness of the spring.
        let implicit = |k: f64, speed: f64, end: f64, n: usize| {
            let (mut x, mut drawn, mut remembered) = (0.0, 0.6 * p / k, 0.0);
            let duration = end / n as f64;
            let (mut velocity, mut fastest) = (v0, 0.0f64);
            for _ in 0..n {
                drawn += speed * duration;
                let point = LawPoint { per_gap: k, duration, remembered, ..LawPoint::default() };
                let trial = [p, k * (drawn - x), 0.0];
                let traction = law.traction(trial, &point).traction;
                remembered = law.remember(trial, traction, &point);
                let moved = drawn - traction[1] / k - x;
                (x, velocity) = (x + moved, moved / duration);
                fastest = fastest.max(velocity);
            }
            (k * (drawn - x), velocity, fastest)
        };
        let exact = |k: f64, speed: f64, end: f64| {
            let speed_of = |tau: f64, theta: f64| {
                2.0 * v0 * (tau / (a * p)).sinh() * (-(0.6 + b * (v0 * theta / d).ln()) / a).exp()
            };
            let rate = |[tau, theta]: [f64; 2]| {
                let v = speed_of(tau, theta);
                let omega = v * theta / d;
                let of_state = if evolution == Evolution::Aging { 1.0 - omega } else { -omega * omega.ln() };
                [k * (speed - v), of_state]
            };
            let (mut y, n) = ([0.6 * p, d / v0], 200_000);
            let h = end / n as f64;
            for _ in 0..n {
                let plus = |k: [f64; 2], c: f64| [y[0] + c * h * k[0], y[1] + c * h * k[1]];
                let k1 = rate(y);
                let k2 = rate(plus(k1, 0.5));
                let k3 = rate(plus(k2, 0.5));
                let k4 = rate(plus(k3, 1.0));
                y = std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
            }
            y[0]
        };
        let critical = p * (b - a) / d;
        let known = exact(3.0 * critical, 10.0 * v0, 3.0);
        let errors = [1000, 2000].map(|n| (implicit(3.0 * critical, 10.0 * v0, 3.0, n).0 - known).abs());
        assert!(errors[1] < 2e-5 && errors[0] / errors[1] > 1.8, "{evolution:?}: {errors:?} of {known}");
        // A disturbance by 5 % of the velocity: it dies out, or grows.
        let [(_, rests, stable), (_, _, unstable)] =
            [1.3, 0.7].map(|share| implicit(share * critical, 1.05 * v0, 4000.0, 8000));
        assert!((rests / (1.05 * v0) - 1.0).abs() < 1e-3, "{evolution:?}: {rests}");
        assert!(stable < 1.3 * v0 && unstable > 3.0 * v0, "{evolution:?}: {stable} {unstable}");
    }
}

/// The law of velocity holds for what it returns, with derivatives of second order from creep to slip.
#[test]
fn a_viscous_law_is_that_of_its_velocity() {
    let (mu, v0, p) = (0.4, 0.02, 1.3);
    let law = Viscous::new(mu, v0).unwrap();
    for rate in [1e-3, 0.7, 30.0] {
        for trial in [[1e-3, -2e-3], [0.3, 0.1], [0.5, -0.2], [-4.0, 3.0]] {
            let at = |z: [f64; 3]| law.traction(z, &LawPoint { per_gap: rate, duration: 1.0, ..LawPoint::default() });
            let [_, t1, t2] = at([p, trial[0], trial[1]]).traction;
            let velocity = [(trial[0] - t1) / rate, (trial[1] - t2) / rate];
            let size = velocity[0].hypot(velocity[1]);
            let known = velocity.map(|v| mu * p * v / size.hypot(v0));
            let rounding = 1e-14 * (1.0 + mu * p / (rate * v0));
            assert!((t1 - known[0]).hypot(t2 - known[1]) < rounding, "{rate} {trial:?}: {t1} {t2} {known:?}");
            for direction in [[0.3, 0.0, 0.0], [0.0, 0.8, -0.1], [0.2, 0.3, 0.5]] {
                let z = [p, trial[0], trial[1]];
                // Steps that are short against where the law bends.
                let step = 1e-3 * rate * v0 / (1.0 + rate * v0);
                let found = at(z);
                let errors = [step, 0.5 * step].map(|h| {
                    let moved = at(std::array::from_fn(|k| z[k] + h * direction[k])).traction;
                    let linear: [f64; 3] = std::array::from_fn(|r| {
                        found.traction[r] + h * (0..3).map(|c| found.derivative[r][c] * direction[c]).sum::<f64>()
                    });
                    distance(&moved, &linear)
                });
                assert!(of_second_order(errors), "{rate} {trial:?} along {direction:?}: {errors:?}");
            }
        }
    }
    // In no time, or far beyond the velocity, it is the law of Coulomb.
    let coulomb = Coulomb::isotropic(mu).unwrap();
    assert_eq!(law.project([p, 0.7, 0.2]), coulomb.project([p, 0.7, 0.2]));
    let fast = law.traction([p, 4e3, 3e3], &LawPoint { per_gap: 1.0, duration: 1.0, ..LawPoint::default() }).traction;
    assert!(distance(&fast, &coulomb.project([p, 4e3, 3e3]).traction) < 1e-9);
    assert!(Viscous::new(0.3, 0.0).is_err() && Viscous::new(-0.3, 1.0).is_err());
}
