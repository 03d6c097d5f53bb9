//! What every body that is a curve owes to the system it is in.

use signorini_geometry::Vector;
use signorini_mechanics::body::{Body, BodyState, Contribution, Hold, Load, MasterProjection, Order, Sampling};
use signorini_rope::beam::Beam;
use signorini_rope::cable::Cable;
use signorini_rope::cable::element::Carries;
use signorini_rope::centreline::{Closure, Continuity};
use signorini_rope::chain::Chain;
use signorini_rope::chain::body::ReferenceLength;
use signorini_rope::path::Path;
use signorini_rope::section::Stiffness;

type V = Vector<3>;

fn path(closure: Closure) -> Path {
    let points: Vec<V> =
        (0..9).map(|k| k as f64 * 0.7).map(|t| V::new(t.cos(), t.sin(), 0.2 * (2.0 * t).sin())).collect();
    Path::spline(&points, closure).unwrap()
}

fn stiffness() -> Stiffness {
    Stiffness { axial: 80.0, shear: [30.0, 20.0], torsion: 1.0, bending: [1.5, 2.0] }
}

fn bodies(closure: Closure) -> Vec<Box<dyn Body>> {
    let path = path(closure);
    let smooth = path.sample(6, Continuity::C1).unwrap();
    let straight = path.sample(10, Continuity::C0).unwrap();
    vec![
        Box::new(Chain::new("chain", &straight, 60.0, ReferenceLength::Pretension(3.0), 0.05).unwrap()),
        Box::new(
            Cable::new("cable", &smooth, 60.0, 0.0, Carries::TensionOnly, ReferenceLength::Pretension(2.0), 0.05)
                .unwrap(),
        ),
        Box::new(
            Cable::new("thread", &smooth, 60.0, 1.0, Carries::TensionAndCompression, ReferenceLength::Path, 0.05)
                .unwrap(),
        ),
        Box::new(Beam::new("beam", &smooth, None, stiffness(), 0.05).unwrap()),
    ]
}

fn step(n: usize, seed: f64) -> Vec<f64> {
    (0..n).map(|k| (seed + 1.37 * k as f64).sin()).collect()
}

fn forces(body: &dyn Body, state: &BodyState) -> (f64, Vec<f64>) {
    let mut out = Contribution::new(body.unknowns());
    let energy = body.internal(state, Order::First, &mut out).unwrap();
    (energy, out.forces)
}

#[test]
fn forces_are_derivatives_of_the_energy_and_do_no_work_in_rigid_motions() {
    for closure in [Closure::Open, Closure::Closed] {
        // As they are, and with springs along what may be slack.
        let tightened = bodies(closure).into_iter().map(|mut body| {
            body.add_sag_spring(7.0);
            body
        });
        for body in bodies(closure).into_iter().chain(tightened) {
            let n = body.unknowns();
            let state = body.advance(&body.start(), &step(n, 0.3), 0.02);
            let (_, f) = forces(&*body, &state);
            let v = step(n, 1.9);
            let e = 1e-5;
            let at = |share: f64| forces(&*body, &body.advance(&state, &v, share)).0;
            let power: f64 = f.iter().zip(&v).map(|(f, v)| f * v).sum();
            let difference = (at(e) - at(-e)) / (2.0 * e);
            assert!((difference - power).abs() < 1e-6 * power.abs().max(1.0), "{} {difference} {power}", body.name());
            let size = f.iter().fold(0.0f64, |m, f| m.max(f.abs()));
            for mode in body.rigid_modes(&state) {
                let power: f64 = f.iter().zip(&mode).map(|(f, v)| f * v).sum();
                assert!(power.abs() < 1e-11 * size, "{} {power}", body.name());
            }
            let fields = body.fields(&state);
            assert_eq!(fields.points.len(), fields.displacement.len());
            for (name, components, values) in &fields.cell_data {
                assert_eq!(values.len(), components * fields.cells.len(), "{name}");
            }
            assert!(fields.point_data.iter().all(|(_, c, values)| values.len() == c * fields.points.len()));
            let length: f64 = body.sites(None, Sampling::GaussPoints).unwrap().iter().map(|s| s.weight).sum();
            let nodes: f64 = body.sites(None, Sampling::Nodes).unwrap().iter().map(|s| s.weight).sum();
            assert!((length - body.size()).abs() < 1e-12 && (nodes - body.size()).abs() < 1e-12);
        }
    }
}

#[test]
fn beams_start_without_stress_whatever_their_shape() {
    for closure in [Closure::Open, Closure::Closed] {
        let beam =
            Beam::new("beam", &path(closure).sample(6, Continuity::C1).unwrap(), None, stiffness(), 0.0).unwrap();
        let (energy, f) = forces(&beam, &beam.start());
        assert!(energy < 1e-24 && f.iter().all(|f| f.abs() < 1e-11));
    }
}

#[test]
fn loads_have_their_derivatives() {
    let beam =
        Beam::new("beam", &path(Closure::Open).sample(4, Continuity::C1).unwrap(), None, stiffness(), 0.0).unwrap();
    let n = beam.unknowns();
    let state = beam.advance(&beam.start(), &step(n, 0.3), 0.1);
    let v = step(n, 2.2);
    let m = V::new(0.4, -0.9, 0.6);
    let loads: [(Load<'_>, Option<V>); 5] = [
        (Load::Tension(2.0), None),
        (Load::Force(m), None),
        (Load::Springs(V::new(3.0, 0.0, 1.0)), None),
        (Load::Moment(m), Some(m)),
        (Load::FollowerMoment(m), Some(m)),
    ];
    for (load, moment) in &loads {
        for on in ["start", "end"] {
            let act = |state: &BodyState, order: Order| {
                let mut out = Contribution::new(n);
                beam.load(Some(on), load, state, order, &mut out).unwrap();
                out
            };
            let e = 1e-6;
            let now = act(&state, Order::Second);
            let (p, q) =
                (act(&beam.advance(&state, &v, e), Order::First), act(&beam.advance(&state, &v, -e), Order::First));
            let mut product = vec![0.0; n];
            for (unknowns, values) in &now.blocks {
                for (r, &row) in unknowns.iter().enumerate() {
                    for (c, &column) in unknowns.iter().enumerate() {
                        product[row as usize] += values[r * unknowns.len() + c] * v[column as usize];
                    }
                }
            }
            // Of moments the tangent has half the cross matrix of the residual besides.
            if moment.is_some() {
                let node = if on == "start" { 0 } else { 4 };
                let at = 9 * node + 6;
                let spin = V::new(v[at], v[at + 1], v[at + 2]);
                let residual = V::new(now.forces[at], now.forces[at + 1], now.forces[at + 2]);
                let half = residual.cross(&spin) * 0.5;
                (0..3).for_each(|i| product[at + i] -= half[i]);
            }
            let worst =
                (0..n).map(|k| ((p.forces[k] - q.forces[k]) / (2.0 * e) - product[k]).abs()).fold(0.0, f64::max);
            assert!(worst < 1e-8, "{on} {worst}");
        }
    }
    let mut out = Contribution::new(n);
    assert!(beam.load(None, &Load::Moment(m), &state, Order::First, &mut out).is_err());
    assert!(beam.load(Some("end"), &Load::Pressure(&|_| 1.0), &state, Order::First, &mut out).is_err());
    assert!(
        beam.load(Some("middle"), &Load::Force(m), &state, Order::First, &mut out)
            .unwrap_err()
            .to_string()
            .contains("start")
    );
    // All of the weight arrives.
    let weight = |_: &V| V::new(0.0, 0.0, -2.0);
    beam.load(None, &Load::BodyForce(&weight), &state, Order::First, &mut out).unwrap();
    let sum: f64 = beam.rigid_modes(&state)[2].iter().zip(&out.forces).map(|(m, f)| m * f).sum();
    assert!((sum - 2.0 * beam.size()).abs() < 1e-12);
}

#[test]
fn held_rotations_lack_what_is_missing() {
    let beam =
        Beam::new("beam", &path(Closure::Open).sample(4, Continuity::C1).unwrap(), None, stiffness(), 0.0).unwrap();
    let turn = [0.3, -0.8, 0.5];
    let value = |k: usize| move |_: &V| turn[k];
    let (x, y, z) = (value(0), value(1), value(2));
    let hold = Hold { displacement: [None; 3], rotation: [Some(&x), Some(&y), Some(&z)], ..Hold::default() };
    // One step of the whole spin that is lacking is enough.
    let state = beam.advance(&beam.start(), &step(beam.unknowns(), 0.8), 0.3);
    let mut needed = vec![0.0; beam.unknowns()];
    for c in beam.hold(Some("end"), &hold, &state).unwrap() {
        needed[c.terms[0].0 as usize] = -c.violation;
    }
    let state = beam.advance(&state, &needed, 1.0);
    assert!(beam.hold(Some("end"), &hold, &state).unwrap().iter().all(|c| c.violation.abs() < 1e-14));
    // A single component: its rate is what the terms say.
    let hold = Hold { displacement: [None; 3], rotation: [None, Some(&y), None], ..Hold::default() };
    let v = step(beam.unknowns(), 2.9);
    let at = |share: f64| beam.hold(Some("end"), &hold, &beam.advance(&state, &v, share)).unwrap().remove(0);
    let rate: f64 = at(0.0).terms.iter().map(|(u, c)| c * v[*u as usize]).sum();
    assert!(((at(1e-6).violation - at(-1e-6).violation) / 2e-6 - rate).abs() < 1e-8);
    let rope = &bodies(Closure::Open)[0];
    assert!(rope.hold(Some("end"), &hold, &rope.start()).is_err());
}

#[test]
fn the_nearest_point_is_that_of_a_fine_scan() {
    for closure in [Closure::Open, Closure::Closed] {
        for body in bodies(closure) {
            let state = body.start();
            let master = body.master(None, &state).unwrap();
            let sites = body.sites(None, Sampling::Nodes).unwrap();
            let elements = 1 + sites.iter().map(|s| s.patch).max().unwrap();
            for k in 0..40 {
                let t = k as f64;
                let x = V::new(1.4 * (1.1 * t).sin(), 1.4 * (0.7 * t).cos(), 0.5 * (2.3 * t).sin());
                let scan = (0..elements)
                    .flat_map(|e| (0..=200).map(move |k| (e, k as f64 / 200.0)))
                    .map(|(patch, xi)| {
                        let site = signorini_mechanics::body::Site { patch, xi: [xi, 0.0], weight: 1.0 };
                        (body.placed(&state, &site).x - x).norm()
                    })
                    .fold(f64::INFINITY, f64::min);
                let Some(MasterProjection::Foot(foot)) = master.nearest(&x, 10.0, None) else { panic!("nothing") };
                let found = (foot.jet.x - x).norm();
                assert!(found < scan + 1e-12 && found > scan - 1e-4, "{} {found} {scan}", body.name());
                if foot.coordinates == 1 {
                    assert!((foot.jet.x - x).dot(&foot.jet.u).abs() < 1e-10);
                }
                let anchor = master.at(&foot.point);
                assert!((anchor.x - foot.jet.x).norm() < 1e-13);
                assert!(master.nearest(&x, 0.5 * found - 0.05, None).is_none());
            }
        }
    }
}
