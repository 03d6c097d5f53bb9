//! Rigid bodies at rest and on their way there, against statics.

use crate::common::{at_rest, ball, plane, rigid, v};
use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SupportedConeT};
use signorini_contact::Coulomb;
use signorini_geometry::Vector;
use signorini_geometry::rigid_shape::{Cone, GapJet, RigidShape, Torus};
use signorini_mechanics::contact::Contact;
use signorini_mechanics::enforcement::Enforcement;
use signorini_mechanics::increment::IncrementResult;
use signorini_mechanics::increment_error::IncrementError;
use signorini_mechanics::part::Part;
use signorini_mechanics::points::Sampling;
use signorini_mechanics::rigid_body::{Motion, RigidBody};
use signorini_mechanics::stability::Unstable;
use signorini_mechanics::system::{PlacedLoad, System, SystemState, TimedLoad};
use std::sync::Arc;

/// Free discs or balls with a weight each, bodies at rest, and all contacts of what is free.
fn system(
    free: &[(Vector<3>, f64)],
    plane: bool,
    fixed: Vec<RigidBody>,
    weight: &dyn Fn(f64) -> Vector<3>,
    mu: f64,
) -> System {
    let mut system = System::default();
    for (k, (x, r)) in free.iter().enumerate() {
        let mut body = ball(*x, *r, Motion::Free { plane });
        (body.name, body.size) = (format!("b{k}"), 2.0 * r);
        system.bodies.push(Box::new(body));
        let weight = weight(*r);
        let load = TimedLoad::Force(Arc::new(move |_, _| weight));
        system.loads.push(PlacedLoad { name: "weight".into(), part: Part::from(k), load });
    }
    let (n, all) = (free.len(), free.len() + fixed.len());
    fixed.into_iter().for_each(|b| system.bodies.push(Box::new(b)));
    for a in 0..n {
        for b in a + 1..all {
            let of = |k: usize| (Part::from(k), system.bodies[k].as_ref());
            let mut contact =
                Contact::new("touch", of(a), of(b), Sampling::Nodes, Enforcement::AugmentedLagrangian).unwrap();
            contact.law.friction = (mu > 0.0).then(|| Box::new(Coulomb::isotropic(mu).unwrap()) as _);
            system.contacts.push(Box::new(contact));
        }
    }
    system.prepare().unwrap();
    system
}

fn solve(mut system: System) -> Result<(SystemState, IncrementResult), IncrementError> {
    let start = system.start();
    system.solve(&start, 1.0, &mut |_, _| true)
}

fn centre(state: &SystemState, body: usize) -> Vector<3> {
    Vector::<3>::from_column_slice(&state.bodies[body].configuration[..3])
}

fn floor() -> RigidBody {
    plane(Vector::<3>::zeros(), v(0.0, 1.0, 0.0))
}

/// The outside of a shape as the wall of a hole.
struct Hole<S>(S);

impl<S: RigidShape> RigidShape for Hole<S> {
    fn gap(&self, x: &Vector<3>) -> GapJet<3> {
        let found = self.0.gap(x);
        GapJet { gap: -found.gap, normal: -found.normal, hessian: -found.hessian }
    }
    fn around(&self, x: &Vector<3>) -> Vec<GapJet<3>> {
        self.0.around(x)
    }
    fn centre(&self) -> Vector<3> {
        self.0.centre()
    }
}

/// Two discs side by side and one on top of them, at an angle `α` from the vertical: it asks for `tan α/2` of friction, whatever the
/// order of names.
#[test]
fn three_discs_rest_if_friction_holds_them() {
    let (apart, needed) = (1.01f64, (0.5 * (1.01f64 / 2.0).asin()).tan());
    let top = 1.0 + (4.0 - apart * apart).sqrt();
    for order in [[0, 1, 2], [2, 0, 1], [1, 2, 0]] {
        let places = [v(-apart, 1.0, 0.0), v(apart, 1.0, 0.0), v(0.0, top, 0.0)];
        let discs: Vec<_> = order.iter().map(|k| (places[*k], 1.0)).collect();
        for (unit, mu) in [(1.0, 0.5), (1e-9, 1.001 * needed), (1e6, 5.0)] {
            let (state, found) = solve(system(&discs, true, vec![floor()], &|_| v(0.0, -unit, 0.0), mu)).unwrap();
            for (k, place) in order.iter().enumerate() {
                assert_eq!(centre(&state, k), places[*place]);
            }
            let on_floor = |s: &&signorini_mechanics::SiteResult| s.touches_at()[1].abs() < 1e-9 && s.pressure > 0.0;
            for site in found.sites.iter().flatten().filter(on_floor) {
                // The floor holds the lower discs together.
                assert!(site.friction[0] * site.x[0] < 0.0, "{site:?}");
                assert!((site.pressure - 1.5 * unit).abs() < 1e-9 * unit, "{site:?}");
                assert!((site.friction.norm() - 0.5 * unit * needed).abs() < 1e-9 * unit);
            }
        }
        // Less than that, and it sinks between them until it lies on the floor.
        let (state, found) =
            solve(system(&discs, true, vec![floor()], &|_| v(0.0, -1.0, 0.0), 0.999 * needed)).unwrap();
        let upper = order.iter().position(|k| *k == 2).unwrap();
        assert!((centre(&state, upper)[1] - 1.0).abs() < 1e-6, "{}", centre(&state, upper));
        assert!(found.imbalance < 1e-9);
    }
}

/// Forces of discs in a tube in zigzag: `W (i tan θ, i)`; they neither rise nor fall.
#[test]
fn discs_in_a_tube_rest_on_each_other() {
    let discs: Vec<_> = (0..5).map(|k| (v(1.0 + 1.2 * f64::from(k % 2), 1.0 + 1.6 * f64::from(k), 0.0), 1.0)).collect();
    let walls =
        || vec![floor(), plane(Vector::<3>::zeros(), v(1.0, 0.0, 0.0)), plane(v(3.2, 0.0, 0.0), v(-1.0, 0.0, 0.0))];
    let (state, found) = solve(system(&discs, true, walls(), &|_| v(0.0, -2.0, 0.0), 0.0)).unwrap();
    let most = found.sites.iter().flatten().map(|s| s.pressure).fold(0.0, f64::max);
    assert!((most - 0.75 * 2.0 * (4.0 + 3.0)).abs() < 1e-9, "{most}");
    (0..5).for_each(|k| assert!((centre(&state, k) - discs[k].0).norm() < 1e-9));
    // From above their places they come down to them.
    let lifted: Vec<_> = discs.iter().map(|(x, r)| (x + v(0.0, 0.03, 0.0), *r)).collect();
    let (state, _) = solve(system(&lifted, true, walls(), &|_| v(0.0, -2.0, 0.0), 0.0)).unwrap();
    (0..5).for_each(|k| assert!((centre(&state, k) - discs[k].0).norm() < 1e-9, "{}", centre(&state, k)));
}

/// A stack of two discs is in equilibrium, and unstable.
#[test]
fn an_upright_stack_falls() {
    let stack = [(v(0.0, 1.0, 0.0), 1.0), (v(0.0, 3.0, 0.0), 1.0)];
    let walls =
        || vec![floor(), plane(v(-1.2, 0.0, 0.0), v(1.0, 0.0, 0.0)), plane(v(1.2, 0.0, 0.0), v(-1.0, 0.0, 0.0))];
    let (state, found) = solve(system(&stack, true, walls(), &|_| v(0.0, -1.0, 0.0), 0.0)).unwrap();
    assert!(found.stability.is_some_and(|s| s.followed > 0 && s.negative_eigenvalues == 0));
    // Wedged: centres apart by 0.4 across, 2 in all.
    assert!((centre(&state, 1)[1] - 1.0 - (4.0f64 - 0.16).sqrt()).abs() < 1e-8, "{}", centre(&state, 1));
}

/// The same stack stays where it is told only.
#[test]
fn an_upright_stack_is_told_where_that_is_asked_for() {
    let stack = [(v(0.0, 1.0, 0.0), 1.0), (v(0.0, 3.0, 0.0), 1.0)];
    let mut stack = system(&stack, true, vec![floor()], &|_| v(0.0, -1.0, 0.0), 0.0);
    stack.unstable = Unstable::Tell;
    let (state, found) = solve(stack).unwrap();
    assert_eq!(centre(&state, 1), v(0.0, 3.0, 0.0));
    let told = found.stability.unwrap();
    assert_eq!((told.negative_eigenvalues, told.followed), (1, 0));
}

/// A ball in a cone, on a ring and in a tube of its own radius touches along circles.
#[test]
fn a_ball_is_held_by_a_circle() {
    let down = |_: f64| v(0.0, 0.0, -1.0);
    let half_angle = 0.7f64;
    let cone = Cone { apex: Vector::<3>::zeros(), axis: v(0.0, 0.0, 1.0), half_angle };
    let cone = rigid("cone", Hole(cone), at_rest(), Vec::new());
    for start in [v(0.0, 0.0, 1.9), v(0.05, -0.02, 1.8)] {
        let (state, found) = solve(system(&[(start, 1.0)], false, vec![cone.clone()], &down, 0.0)).unwrap();
        assert!((centre(&state, 0) - v(0.0, 0.0, 1.0 / half_angle.sin())).norm() < 1e-8, "{}", centre(&state, 0));
        let sum: f64 = found.sites[0].iter().map(|s| s.pressure).sum();
        assert!((sum - 1.0 / half_angle.sin()).abs() < 1e-9, "{sum}");
    }
    let ring = Torus { center: Vector::<3>::zeros(), axis: v(0.0, 0.0, 1.0), major: 1.0, minor: 0.25 };
    let ring = rigid("ring", ring, at_rest(), Vec::new());
    let (state, found) = solve(system(&[(v(0.0, 0.0, 1.4), 1.0)], false, vec![ring], &down, 0.0)).unwrap();
    let height = (1.25f64.powi(2) - 1.0).sqrt();
    assert!((centre(&state, 0) - v(0.0, 0.0, height)).norm() < 1e-8, "{}", centre(&state, 0));
    let sum: f64 = found.sites[0].iter().map(|s| s.pressure).sum();
    assert!((sum - 1.25 / height).abs() < 1e-8, "{sum}");
}

/// A heap of unlike discs between walls: in balance, within its cones, and the same in other units and another order.
#[test]
fn heaps_do_not_depend_on_units_and_orders() {
    let places =
        [[1.0, 0.9, 0.9], [2.9, 0.75, 0.7], [4.4, 0.65, 0.6], [1.7, 2.6, 0.8], [3.4, 2.3, 0.75], [2.5, 4.2, 0.9]];
    let heap = |length: f64, force: f64, order: &[usize], mu: f64| {
        let discs: Vec<_> =
            order.iter().map(|k| places[*k]).map(|[x, y, r]| (v(x, y, 0.0) * length, r * length)).collect();
        let wall = |x: f64, n: f64| plane(v(x * length, 0.0, 0.0), v(n, 0.0, 0.0));
        let weight = move |r: f64| v(0.0, -force * (r / length).powi(2), 0.0);
        solve(system(&discs, true, vec![floor(), wall(0.0, 1.0), wall(5.2, -1.0)], &weight, mu)).unwrap()
    };
    for mu in [0.0, 0.3] {
        let (state, found) = heap(1.0, 1.0, &[0, 1, 2, 3, 4, 5], mu);
        assert!(found.imbalance < 1e-9);
        for site in found.sites.iter().flatten() {
            assert!(site.gap.unwrap() > -1e-9, "{site:?}");
            assert!(site.friction.norm() <= mu * site.pressure * (1.0 + 1e-8), "{site:?}");
        }
        let order = [4, 2, 0, 5, 3, 1];
        let (other, _) = heap(1e-3, 1e6, &order, mu);
        for (k, place) in order.iter().enumerate() {
            let apart = centre(&state, *place) - centre(&other, k) * 1e3;
            assert!(apart.norm() < 1e-8, "{mu} {apart}");
        }
    }
}

/// What nothing stops is free, and so is a ball that is pushed and rolls.
#[test]
fn what_flies_or_rolls_away_is_free() {
    let pushed = system(&[(v(0.0, 1.0, 0.0), 1.0)], true, vec![floor()], &|_| v(0.1, -1.0, 0.0), 0.3);
    let error = solve(pushed).unwrap_err();
    assert!(matches!(&error, IncrementError::Free { motion, .. } if motion.contains("along (1.000, 0")), "{error}");
}

/// Discs or balls of radius one and weight one on a floor, piled densely: places, and who touches whom with the normal towards the
/// first; the floor is none.
type Touches = Vec<(usize, Option<usize>, Vector<3>)>;

fn pile(levels: usize, in_space: bool) -> (Vec<(Vector<3>, f64)>, Touches) {
    let third = if in_space { v(1.0, (8.0f64 / 3.0).sqrt(), 1.0 / 3.0f64.sqrt()) } else { v(1.0, 3.0f64.sqrt(), 0.0) };
    let second = v(1.0, 0.0, 3.0f64.sqrt());
    let mut places = Vec::new();
    for k in 0..levels {
        for j in 0..if in_space { levels - k } else { 1 } {
            let first = |i: usize| v(2.0 * i as f64, 1.0, 0.0);
            places.extend((0..levels - k - j).map(|i| first(i) + second * j as f64 + third * k as f64));
        }
    }
    let mut touches = Touches::new();
    for (a, x) in places.iter().enumerate() {
        if x[1] < 1.0 + 1e-9 {
            touches.push((a, None, v(0.0, 1.0, 0.0)));
        }
        let others = places.iter().enumerate().skip(a + 1).filter(|(_, y)| (x - *y).norm() < 2.0 + 1e-9);
        touches.extend(others.map(|(b, y)| (a, Some(b), (x - y) * 0.5)));
    }
    (places.into_iter().map(|x| (x, 1.0)).collect(), touches)
}

/// The least force by which friction would have to exceed its cones for a balance with the weights: a second-order cone program.
fn excess((bodies, touches): (usize, &Touches), weight: &Vector<3>, mu: f64) -> f64 {
    let count = 3 * touches.len() + 1;
    let (mut rows, mut right, mut cones) = (Vec::new(), Vec::new(), Vec::new());
    // Of each body three forces and three moments.
    let mut balance = vec![Vec::new(); 6 * bodies];
    for (k, (a, b, normal)) in touches.iter().enumerate() {
        let across = normal.cross(&if normal.x.abs() < 0.9 { v(1.0, 0.0, 0.0) } else { v(0.0, 0.0, 1.0) }).normalize();
        for (i, axis) in [*normal, across, normal.cross(&across)].iter().enumerate() {
            for (body, sign) in [(Some(*a), 1.0), (*b, -1.0)] {
                let Some(body) = body else { continue };
                // The arm is against the normal on the first, along it on the second; so is the force.
                let moment = -normal.cross(axis);
                (0..3).for_each(|c| balance[6 * body + c].push((3 * k + i, sign * axis[c])));
                (0..3).for_each(|c| balance[6 * body + 3 + c].push((3 * k + i, moment[c])));
            }
        }
    }
    for (number, row) in balance.into_iter().enumerate() {
        rows.push(row);
        right.push(if number % 6 < 3 { -weight[number % 6] } else { 0.0 });
    }
    cones.push(SupportedConeT::ZeroConeT(6 * bodies));
    let pushes = (0..touches.len()).map(|k| 3 * k).chain([count - 1]);
    pushes.for_each(|column| rows.push(vec![(column, -1.0)]));
    cones.push(SupportedConeT::NonnegativeConeT(touches.len() + 1));
    for k in 0..touches.len() {
        rows.push(vec![(3 * k, -mu), (count - 1, -1.0)]);
        rows.extend([1, 2].map(|i| vec![(3 * k + i, -1.0)]));
        cones.push(SupportedConeT::SecondOrderConeT(3));
    }
    right.resize(rows.len(), 0.0);
    let entries = || rows.iter().enumerate().flat_map(|(i, row)| row.iter().map(move |(j, value)| (i, *j, *value)));
    let matrix = CscMatrix::new_from_triplets(
        rows.len(),
        count,
        entries().map(|e| e.0).collect(),
        entries().map(|e| e.1).collect(),
        entries().map(|e| e.2).collect(),
    );
    let mut cost = vec![0.0; count];
    cost[count - 1] = 1.0;
    let tight = 1e-10;
    let settings = DefaultSettings {
        verbose: false,
        tol_gap_abs: tight,
        tol_gap_rel: tight,
        tol_feas: tight,
        max_threads: 1,
        ..DefaultSettings::default()
    };
    let none = CscMatrix::zeros((count, count));
    let mut solver = DefaultSolver::new(&none, &cost, &matrix, &right, &cones, settings).unwrap();
    solver.solve();
    solver.solution.obj_val
}

/// Piles stay from the coefficient of friction on with which forces within the cones balance the weights, as a cone program tells it,
/// and not below: discs, balls, and both on a slope.
#[test]
fn piles_stay_where_admissible_forces_hold_them() {
    for (levels, in_space, weight) in [
        (4, false, v(0.0, -1.0, 0.0)),
        (4, false, v(0.1, -1.0, 0.0)),
        (3, true, v(0.0, -1.0, 0.0)),
        (3, true, v(0.05, -1.0, -0.08)),
    ] {
        let (bodies, touches) = pile(levels, in_space);
        let (mut low, mut high) = (0.1, 2.0);
        while high - low > 1e-7 {
            let middle = 0.5 * (low + high);
            *(if excess((bodies.len(), &touches), &weight, middle) > 1e-8 { &mut low } else { &mut high }) = middle;
        }
        let stays = |mu: f64| {
            let mut system = system(&bodies, !in_space, vec![floor()], &|_| weight, mu);
            let start = system.start();
            // What moves is interrupted in its first step.
            match system.solve(&start, 1.0, &mut |_, _| false) {
                Ok((state, found)) => {
                    assert!(found.imbalance < 1e-9, "{}", found.imbalance);
                    (0..bodies.len()).for_each(|k| assert_eq!(centre(&state, k), bodies[k].0));
                    true
                }
                Err(IncrementError::Interrupted) => false,
                Err(other) => panic!("{other}"),
            }
        };
        for share in [1.000_003, 1.0001, 1.01, 2.0] {
            assert!(stays(share * high), "{levels} {in_space} {weight}: {share} of {high}");
        }
        for share in [0.999_99, 0.999, 0.9] {
            assert!(!stays(share * high), "{levels} {in_space} {weight}: {share} of {high}");
        }
    }
}
