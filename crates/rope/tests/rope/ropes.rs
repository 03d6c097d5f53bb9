//! Ropes and cables against exact solutions.

use crate::common::{Options, Search, Surroundings, V, load_body, newton, pin};
use signorini_mechanics::body::{Body, BodyState, Constraint, Contribution, Load, Order};
use signorini_mechanics::{Part, PlacedLoad, Support, System, TimedLoad, system};
use signorini_rope::cable::Cable;
use signorini_rope::cable::element::Carries;
use signorini_rope::centreline::{Closure, Continuity};
use signorini_rope::chain::Chain;
use signorini_rope::chain::body::ReferenceLength;
use signorini_rope::chain::form::{Member, Net};
use signorini_rope::chain::winch::WinchEnd;
use signorini_rope::path::Path;
use std::sync::Arc;

/// Parameter, lowest point and horizontal force of an inextensible catenary of weight `w` per length between supports
/// `span` apart and `rise` higher at the second one.
fn catenary(span: f64, rise: f64, length: f64, w: f64) -> (f64, f64) {
    // sinh(x)/x = sqrt(L² - v²)/span, x = span/(2a).
    let ratio = (length * length - rise * rise).sqrt() / span;
    let (mut low, mut high) = (1e-9, 50.0f64);
    for _ in 0..200 {
        let x = 0.5 * (low + high);
        if x.sinh() / x > ratio { high = x } else { low = x }
    }
    let a = span / (2.0 * low);
    // Lowest point from the first support: tanh of the middle is v/L.
    let x0 = 0.5 * span - a * (rise / length).atanh();
    let sag = a * ((x0 / a).cosh() - 1.0);
    (w * a, sag)
}

/// Forms a hanging net of one rope.
fn hanging(span: f64, rise: f64, length: f64, w: f64, cells: usize, stiffness: f64) -> Net {
    let positions: Vec<V> = (0..=cells).map(|k| V::new(span, 0.0, rise) * (k as f64 / cells as f64)).collect();
    let h = length / cells as f64;
    Net {
        held: (0..=cells).map(|k| k == 0 || k == cells).collect(),
        members: (0..cells).map(|k| Member { nodes: [k, k + 1], stiffness, unstrained: h }).collect(),
        forces: (0..=cells).map(|_| V::new(0.0, 0.0, -w * h)).collect(),
        positions,
    }
}

#[test]
fn hanging_rope_is_a_catenary() {
    let (span, rise, length, w) = (10.0, 0.0, 12.0, 2.0);
    let (force, sag) = catenary(span, rise, length, w);
    assert!((sag - 2.923437976).abs() < 1e-8 && (force - 9.390830463).abs() < 1e-8);
    for (span, rise, length) in [(span, rise, length), (7.0, 2.0, 11.0)] {
        let (force, _) = catenary(span, rise, length, w);
        let mut errors = Vec::new();
        for cells in [20, 40, 80] {
            let shape = hanging(span, rise, length, w, cells, 1e7 * force).equilibrium().unwrap();
            // The horizontal part of any tension.
            let d = (shape.positions[1] - shape.positions[0]).normalize();
            let lowest = shape.positions.iter().map(|x| -x[2]).fold(0.0, f64::max);
            println!(
                "{cells}: H {:.9} ({force:.9}), lowest {lowest:.6}, residual {:.1e}, {} iterations",
                shape.tensions[0] * d[0],
                shape.residual,
                shape.iterations
            );
            assert!(shape.slack.is_empty() && shape.undetermined.is_empty());
            errors.push((shape.tensions[0] * d[0] / force - 1.0).abs());
        }
        let order = (errors[1] / errors[2]).log2();
        println!("errors {errors:?}, order {order}");
        assert!(order > 1.9 && errors[2] < 1e-3);
    }
}

/// A rope between supports, under its weight.
struct Hanging<'a> {
    body: &'a dyn Body,
    weight: f64,
}

impl Surroundings for Hanging<'_> {
    fn hold(&self, states: &[BodyState]) -> Vec<(usize, Constraint)> {
        pin(self.body, "boundary", &states[0]).into_iter().map(|c| (0, c)).collect()
    }
    fn act(&self, states: &[BodyState], first: &[u32], order: Order, out: &mut Contribution) {
        let weight = |_: &V| V::new(0.0, 0.0, -self.weight);
        load_body(self.body, None, &Load::BodyForce(&weight), &states[0], order, first[0], out);
    }
}

#[test]
fn smooth_cables_converge_to_the_catenary_however_stiff() {
    let (span, length, w) = (10.0, 12.0, 2.0);
    let (force, sag) = catenary(span, 0.0, length, w);
    let mut errors: Vec<[f64; 2]> = Vec::new();
    for cells in [4, 8, 16, 32] {
        // A parabola of about the right sag to start from, a little short of rope.
        let points: Vec<V> =
            (0..=40).map(|k| k as f64 / 40.0).map(|x| V::new(span * x, 0.0, -4.0 * sag * x * (1.0 - x))).collect();
        let path = Path::spline(&points, Closure::Open).unwrap().sample(cells, Continuity::C1).unwrap();
        let mut state: Option<BodyState> = None;
        let mut iterations = Vec::new();
        let mut reached = [0.0; 2];
        // Stretchy ropes first.
        for stretch in [20.0, 1e3, 1e5, 1e7] {
            let ea = stretch * force;
            let cable = Cable::new("cable", &path, ea, 0.0, Carries::TensionOnly, ReferenceLength::Length(length), 0.0)
                .unwrap();
            let start = cable.restart(state.as_ref().unwrap_or(&cable.start()));
            let options = Options { most: 60, tolerance: (1e-9 * force).max(1e-13 * ea), search: Search::Shares };
            let mut around = Hanging { body: &cable, weight: w };
            let found = newton(&[&cable as &dyn Body], &[start], &mut around, &options)
                .unwrap_or_else(|f| panic!("{cells} {stretch:e} {:?}", f.residuals));
            iterations.push(found.iterations());
            assert!(cable.slack(&found.states[0]).is_empty());
            reached =
                [-cable.position(&found.states[0], cells / 2)[2] / sag - 1.0, found.forces[0].abs() / force - 1.0];
            state = Some(found.states[0].clone());
        }
        println!("{cells}: sag error {:.2e}, H error {:.2e}, iterations {iterations:?}", reached[0], reached[1]);
        errors.push(reached);
    }
    let order = (errors[1][0] / errors[3][0]).abs().log2() / 2.0;
    println!("order {order}");
    assert!(order > 2.5 && errors[3][0].abs() < 1e-4 && errors[3][1].abs() < 1e-4);
}

#[test]
fn slack_ropes_carry_nothing() {
    let ends = [V::zeros(), V::x()];
    let path = Path::points(&ends, Closure::Open).unwrap();
    let chain =
        Chain::new("rope", &path.sample(4, Continuity::C0).unwrap(), 50.0, ReferenceLength::Length(1.2), 0.0).unwrap();
    let mut out = Contribution::new(chain.unknowns());
    assert_eq!(chain.internal(&chain.start(), Order::First, &mut out).unwrap(), 0.0);
    assert!(out.forces.iter().all(|f| *f == 0.0) && chain.slack(&chain.start()).len() == 4);
    let pulled =
        Chain::new("rope", &path.sample(4, Continuity::C0).unwrap(), 50.0, ReferenceLength::Pretension(2.0), 0.0)
            .unwrap();
    assert!(pulled.tensions(&pulled.start()).iter().all(|t| (t - 2.0).abs() < 1e-12));
    // A net with a rope that is too long: it stays slack, and the node that only it holds is told.
    let net = Net {
        positions: vec![
            V::zeros(),
            V::new(2.0, 0.0, 0.0),
            V::new(0.7, 0.3, 0.0),
            V::new(0.0, 1.0, 0.0),
            V::new(0.5, 2.0, 0.0),
        ],
        held: vec![true, true, false, true, false],
        members: [[0, 2], [2, 1], [3, 4], [4, 2]]
            .iter()
            .zip([1.2, 1.2, 3.0, 3.0])
            .map(|(nodes, unstrained)| Member { nodes: *nodes, stiffness: 1e4, unstrained })
            .collect(),
        forces: vec![V::zeros(), V::zeros(), V::new(0.0, -3.0, 0.0), V::zeros(), V::zeros()],
    };
    let shape = net.equilibrium().unwrap();
    println!("{shape:?}");
    assert_eq!((shape.slack, shape.undetermined), (vec![2, 3], vec![4]));
    // Two equal ropes carry 3 at their angle.
    let l = 1.2 * (1.0 + shape.tensions[0] / 1e4);
    assert!((2.0 * shape.tensions[0] * (l * l - 1.0).sqrt() / l - 3.0).abs() < 1e-8);
    let loose = Net { held: vec![false; 5], ..net };
    assert!(loose.equilibrium().is_err());
}

/// A rope over a pulley: both ends held, the pulley held between, its tension the same on both sides.
struct OverPulley<'a> {
    chain: &'a Chain,
    pulley: usize,
    weight: V,
}

impl Surroundings for OverPulley<'_> {
    fn hold(&self, states: &[BodyState]) -> Vec<(usize, Constraint)> {
        let at_pulley = (0..3).map(|i| Constraint::of_component(vec![((3 * self.pulley + i) as u32, 1.0)], 0.0, i));
        pin(self.chain, "boundary", &states[0]).into_iter().chain(at_pulley).map(|c| (0, c)).collect()
    }
    fn act(&self, states: &[BodyState], first: &[u32], order: Order, out: &mut Contribution) {
        let weight = |_: &V| self.weight;
        load_body(self.chain, None, &Load::BodyForce(&weight), &states[0], order, first[0], out);
    }
}

#[test]
fn ropes_run_through_pulleys_and_over_winches() {
    // One side of the pulley is cut shorter: rope runs through until both tensions are the same.
    let path = Path::points(&[V::zeros(), V::new(3.0, 0.0, 0.0), V::new(3.0, -1.0, 0.0)], Closure::Open).unwrap();
    let mut chain = Chain::new("rope", &path.sample(2, Continuity::C0).unwrap(), 100.0, ReferenceLength::Path, 0.0)
        .unwrap()
        .with_pulleys(&[1])
        .unwrap();
    chain.set_unstrained_length(0, 2.8).unwrap();
    let options = Options { most: 20, tolerance: 1e-12, search: Search::WholeSteps };
    let mut around = OverPulley { chain: &chain, pulley: 1, weight: V::zeros() };
    let found = newton(&[&chain as &dyn Body], &[chain.start()], &mut around, &options)
        .unwrap_or_else(|f| panic!("{:?}", f.residuals));
    let tensions = chain.tensions(&found.states[0]);
    // All of the rope, 3.8, is stretched to 4.
    println!("pulley {tensions:?}, {} iterations", found.iterations());
    assert!(tensions.iter().all(|t| (t - 100.0 * (4.0 / 3.8 - 1.0)).abs() < 1e-10));
    let kept = chain.unstrained_length(&found.states[0], 0) + chain.unstrained_length(&found.states[0], 1);
    assert!((kept - 3.8).abs() < 1e-13);
    assert!(
        Chain::new("rope", &path.sample(2, Continuity::C0).unwrap(), 100.0, ReferenceLength::Path, 0.0)
            .unwrap()
            .with_pulleys(&[0])
            .is_err()
    );

    // A winch keeps its tension: a weight between it and a rope is in balance where both pulls are.
    let path = Path::points(&[V::zeros(), V::new(4.0, 0.0, 0.0)], Closure::Open).unwrap();
    let mut chain =
        Chain::new("rope", &path.sample(2, Continuity::C0).unwrap(), 100.0, ReferenceLength::Pretension(1.0), 0.0)
            .unwrap();
    chain.set_tension(1, 5.0).unwrap();
    struct Weight<'a>(&'a Chain);
    impl Surroundings for Weight<'_> {
        fn hold(&self, states: &[BodyState]) -> Vec<(usize, Constraint)> {
            pin(self.0, "boundary", &states[0]).into_iter().map(|c| (0, c)).collect()
        }
        fn act(&self, _: &[BodyState], _: &[u32], _: Order, out: &mut Contribution) {
            out.forces[5] += 2.0;
        }
    }
    let found = newton(&[&chain as &dyn Body], &[chain.start()], &mut Weight(&chain), &options)
        .unwrap_or_else(|f| panic!("{:?}", f.residuals));
    let x = chain.position(&found.states[0], 1);
    let t = chain.tensions(&found.states[0]);
    let pull = |d: V, t: f64| d.normalize() * t;
    let sum = pull(-x, t[0]) + pull(V::new(4.0, 0.0, 0.0) - x, 5.0) + V::new(0.0, 0.0, -2.0);
    println!("winch {t:?} {x:?}, {} iterations", found.iterations());
    assert!(t[1] == 5.0 && sum.norm() < 1e-10);
}

/// A rope between two points, with a winch at an end that pays out `by * t`; its tensions and the forces of both supports.
fn wound(at: WinchEnd, by: f64, weight: f64, times: &[f64]) -> (Chain, BodyState, Vec<f64>, [V; 2]) {
    let path = Path::points(&[V::zeros(), V::new(4.0, 0.0, 3.0)], Closure::Open).unwrap();
    let path = path.sample(40, Continuity::C0).unwrap();
    let rope = Chain::new("rope", &path, 1e4, ReferenceLength::Pretension(10.0), 0.0).unwrap();
    let rope = rope.with_winch(at, by.max(0.0), Arc::new(move |t| by * t)).unwrap();
    let mut system = System::default();
    system.bodies.push(Box::new(rope.clone()));
    for group in ["start", "end"] {
        let zero = || -> Option<system::TimeField> { Some(Arc::new(|_, _| 0.0)) };
        let part = Part { body: 0, group: Some(group.into()) };
        let displacement = [zero(), zero(), zero()];
        system.supports.push(Support {
            name: group.into(),
            part,
            displacement,
            rotation: [None, None, None],
            ..Support::default()
        });
    }
    let load = TimedLoad::BodyForce(Arc::new(move |_, _| V::z() * -weight));
    system.loads.push(PlacedLoad { name: "weight".into(), part: Part { body: 0, group: None }, load });
    system.prepare().unwrap();
    let mut state = system.start();
    let mut forces = [V::zeros(); 2];
    for &time in times {
        let (next, result) =
            system.solve(&state, time, &mut |_, _| true).unwrap_or_else(|e| panic!("{at:?} {by} {time}: {e}"));
        system.accept(&next).unwrap();
        state = next;
        forces = [result.support_forces[0][0], result.support_forces[1][0]];
    }
    let body = state.bodies[0].clone();
    let tensions = rope.tensions(&body);
    (rope, body, tensions, forces)
}

#[test]
fn a_winch_pays_out_and_takes_in() {
    let out = 5.0 * 1e4 / (1e4 + 10.0);
    for at in [WinchEnd::Start, WinchEnd::End] {
        // Taken in by more than a tenth, cell by cell: the tension of a straight rope.
        let (rope, state, tensions, forces) = wound(at, -0.6, 0.0, &[0.1, 0.3, 0.35, 0.7, 1.0]);
        let exact = 1e4 * (5.0 / (out - 0.6) - 1.0);
        assert!(tensions.iter().all(|t| (t / exact - 1.0).abs() < 1e-9), "{tensions:?} {exact}");
        assert_eq!(tensions.len(), 35);
        let length: f64 = rope.active(&state).map(|e| rope.unstrained_length(&state, e)).sum();
        assert!((length - out + 0.6).abs() < 1e-12 && (forces[0].norm() / exact - 1.0).abs() < 1e-9);
        // Paid out: a catenary of the whole length, with all of its weight.
        let times: Vec<f64> = (1..=10).map(|k| 0.1 * f64::from(k)).collect();
        let (rope, state, tensions, forces) = wound(at, 1.5, 2.0, &times);
        let (horizontal, _) = catenary(4.0, 3.0, out + 1.5, 2.0);
        println!("{at:?}: {} cells out, H {:.6} ({horizontal:.6})", tensions.len(), forces[1][0]);
        assert_eq!((tensions.len(), rope.elements()), (52, 52));
        assert!((forces[1][0] / horizontal - 1.0).abs() < 2e-3 && (forces[0] + forces[1])[0].abs() < 1e-8);
        assert!(((forces[0] + forces[1])[2] / (2.0 * (out + 1.5)) - 1.0).abs() < 1e-9);
        let length: f64 = rope.active(&state).map(|e| rope.unstrained_length(&state, e)).sum();
        assert!((length - out - 1.5).abs() < 1e-12);
    }
}
