//! Discrete ropes on the curves of `ropes.json`: the limits of their tensions converge with order two, slip ends where it does.

use serde_json::Value;
use signorini_contact::{Coulomb, Status};
use signorini_geometry::Vector;
use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::rigid_shape::{Cone, Cylinder, Ellipsoid, RigidShape, Sphere, Torus};
use signorini_mechanics::*;
use signorini_rope::centreline::{Closure, Continuity};
use signorini_rope::chain::Chain;
use signorini_rope::chain::body::ReferenceLength;
use signorini_rope::path::{Path, Sampled};
use std::f64::consts::PI;
use std::sync::Arc;

type V = Vector<3>;
type Curve = Box<dyn Fn(f64) -> V>;

fn data() -> Value {
    serde_json::from_str(include_str!("../../../paths/tests/data/ropes.json")).unwrap()
}

fn rigid(shape: Arc<dyn RigidShape>) -> RigidBody {
    let zero = V::zeros();
    let motion = Motion::Prescribed(Arc::new(move |_| RigidMotion::new(zero, zero, zero)));
    RigidBody { name: "body".into(), centre: shape.centre(), shape, motion, sites: Vec::new(), size: 1.0, mass: None }
}

/// The surface and the curve of a row, by a parameter from 0 to 1; none where the curve is no formula.
fn row(case: &Value) -> Option<(Arc<dyn RigidShape>, Curve)> {
    let p = |key: &str| case["params"][key].as_f64().unwrap();
    let name = case["name"].as_str().unwrap();
    let parallel =
        |r: f64, z: f64, phi: f64| -> Curve { Box::new(move |u| V::new(r * (phi * u).cos(), r * (phi * u).sin(), z)) };
    let about_z =
        |radius: f64| -> Arc<dyn RigidShape> { Arc::new(Cylinder { point: V::zeros(), axis: V::z(), radius }) };
    let torus =
        || -> Arc<dyn RigidShape> { Arc::new(Torus { center: V::zeros(), axis: V::z(), major: 3.0, minor: 1.0 }) };
    let ellipsoid = || -> Arc<dyn RigidShape> { Arc::new(Ellipsoid::new(V::zeros(), [2.0, 1.5, 1.0]).unwrap()) };
    Some(match name.split([' ', ',']).next().unwrap() {
        "cylinder" if name.contains("cross-section") => (about_z(p("R")), parallel(p("R"), 0.0, p("phi"))),
        "cylinder" if name.contains("helix") => {
            let (r, slope, phi) = (p("R"), p("R") / p("alpha").tan(), p("theta"));
            (about_z(r), Box::new(move |u| V::new(r * (phi * u).cos(), r * (phi * u).sin(), slope * phi * u)))
        }
        "cylinder" => {
            let (r, lam, a0, a1) = (p("R"), p("lam"), p("alpha0"), p("alpha1"));
            let curve = move |u: f64| {
                let a = a0 + (a1 - a0) * u;
                let theta = ((0.5 * a).tan().ln() - (0.5 * a0).tan().ln()) / lam;
                V::new(r * theta.cos(), r * theta.sin(), r * (1.0 / a0.sin() - 1.0 / a.sin()) / lam)
            };
            (about_z(r), Box::new(curve))
        }
        "sphere" => {
            let (r, psi) = (p("R"), p("psi"));
            (Arc::new(Sphere { center: V::zeros(), radius: r }), parallel(r * psi.sin(), r * psi.cos(), p("phi")))
        }
        "torus" if name.contains("meridian") => {
            (torus(), Box::new(|u| V::new(3.0 + (PI * u).cos(), 0.0, (PI * u).sin())))
        }
        "torus" if name.contains("equator") => (torus(), parallel(4.0, 0.0, PI)),
        "ellipsoid" if name.contains("principal") => {
            (ellipsoid(), Box::new(|u| V::new(2.0 * (PI * u).cos(), 0.0, (PI * u).sin())))
        }
        "ellipsoid" => {
            let (z, k) = (p("z0"), (1.0 - p("z0") * p("z0")).sqrt());
            (ellipsoid(), Box::new(move |u| V::new(2.0 * k * (PI * u).cos(), 1.5 * k * (PI * u).sin(), z)))
        }
        "cone" => {
            let gamma = p("half_angle");
            (Arc::new(Cone { apex: V::zeros(), axis: V::z(), half_angle: gamma }), parallel(gamma.tan(), 1.0, PI))
        }
        _ => return None,
    })
}

fn support(group: &str, at: impl Fn(f64) -> V + Clone + Send + Sync + 'static) -> Support {
    let displacement = [0, 1, 2].map(|k| {
        let at = at.clone();
        let field: system::TimeField = Arc::new(move |_, t| at(t)[k]);
        Some(field)
    });
    let part = Part { body: 0, group: Some(group.into()) };
    Support { name: group.into(), part, displacement, rotation: [None, None, None], ..Support::default() }
}

/// `ln T₁/T₀` of a rope that is dragged along a curve at its end, with a straight cell beyond either end of it: its start is
/// pulled by 1.
fn dragged(shape: &Arc<dyn RigidShape>, curve: &Curve, mu: [f64; 2], exact: f64, cells: usize) -> f64 {
    let on: Vec<V> = (0..=cells).map(|k| curve(k as f64 / cells as f64)).collect();
    let e = 1e-5;
    let tau = [(curve(e) - curve(-e)).normalize(), (curve(1.0 + e) - curve(1.0 - e)).normalize()];
    let h = (on[1] - on[0]).norm();
    drawn(shape, (&on, tau, h), mu, exact)
}

/// The same of nodes on a surface, with the directions and the length of the cells beyond.
fn drawn(shape: &Arc<dyn RigidShape>, (on, tau, h): (&[V], [V; 2], f64), mu: [f64; 2], exact: f64) -> f64 {
    let last = on[on.len() - 1] + tau[1] * h;
    let points: Vec<V> = std::iter::once(on[0] - tau[0] * h).chain(on.iter().copied()).chain([last]).collect();
    // Every chord one cell.
    let cells = points.len() - 1;
    let lengths: Vec<f64> = points.windows(2).map(|p| (p[1] - p[0]).norm()).collect();
    let path = Sampled {
        tangents: vec![tau[0]; points.len()],
        positions: points,
        lengths,
        closure: Closure::Open,
        continuity: Continuity::C0,
    };
    let stiffness = 1e7;
    let rope = Chain::new("rope", &path, stiffness, ReferenceLength::Pretension(1.0), 0.0).unwrap();
    let mut system = System::default();
    system.bodies.push(Box::new(rope.clone()));
    system.bodies.push(Box::new(rigid(Arc::clone(shape))));
    let (from, to) = (-tau[0], tau[1]);
    // Twice what stretches all of it: what slides on drifts to the side.
    let way = 2.0 * (exact.exp() - 1.0) * path.lengths.iter().sum::<f64>() / stiffness;
    system.supports.push(support("end", move |t| to * (way * t)));
    let load = TimedLoad::Force(Arc::new(move |_, _| from));
    system.loads.push(PlacedLoad { name: "start".into(), part: Part { body: 0, group: Some("start".into()) }, load });
    let of = |body: usize| (Part { body, group: None }, system.bodies[body].as_ref());
    let mut contact = Contact::new("touch", of(0), of(1), Sampling::Nodes, Enforcement::Multiplier).unwrap();
    contact.law.friction = Some(Box::new(Coulomb::orthotropic(mu).unwrap()));
    contact.axis = AxisChoice::Tangent;
    system.contacts.push(Box::new(contact));
    system.prepare().unwrap();
    let mut state = system.start();
    for step in 0..=4 {
        let (next, _) = system.solve(&state, 0.25 * f64::from(step), &mut |_, _| true).unwrap();
        system.accept(&next).unwrap();
        state = next;
    }
    let tensions = rope.tensions(&state.bodies[0]);
    (tensions[cells - 1] / tensions[0]).ln()
}

#[test]
fn limits_of_discrete_ropes_converge_with_order_two() {
    let data = data();
    let mut done = 0;
    for case in data["cases"].as_array().unwrap().iter().filter(|c| c["status"] == "admissible") {
        let Some((shape, curve)) = row(case) else { continue };
        let exact = case["ln_ratio_max"].as_f64().unwrap();
        let mu = ["mu_tau", "mu_g"].map(|key| case[key].as_f64().unwrap());
        let errors = [12, 24, 48].map(|cells| dragged(&shape, &curve, mu, exact, cells) / exact - 1.0);
        let order = (errors[1] / errors[2]).abs().log2();
        println!("{}: errors {errors:?}, order {order:.2}", case["name"]);
        // On the spiral, errors of either sign cancel on the coarse ropes.
        let is_small = errors.iter().all(|e| e.abs() < 1e-3) && errors[2].abs() < 2e-4;
        assert!(is_small || ((1.7..2.3).contains(&order) && errors[2].abs() < 1e-3), "{}", case["name"]);
        done += 1;
    }
    assert_eq!(done, 10);
}

/// A rope with so many nodes on a drum, at each of which it turns alike: `ln (1 + μ tan(d/2))/(1 - μ tan(d/2))` each.
#[test]
fn discrete_capstans_have_their_closed_form() {
    let data = data();
    let row = |case: &Value| {
        let nodes = case["nodes_in_contact"].as_u64().unwrap() as usize;
        [case["mu"].as_f64(), case["phi"].as_f64(), Some(nodes as f64), case["ln_ratio"].as_f64()].map(Option::unwrap)
    };
    let rows = data["discrete_capstan"].as_array().unwrap().iter().map(row);
    // Another one, by the formula.
    let half = 12.5f64.to_radians();
    let share = 0.22 * half.tan();
    let other = [0.22, 250f64.to_radians(), 10.0, 10.0 * ((1.0 + share) / (1.0 - share)).ln()];
    for [mu, phi, nodes, exact] in rows.chain([other]) {
        let turn = phi / nodes;
        let at = |angle: f64| V::new(angle.cos(), angle.sin(), 0.0);
        let on: Vec<V> = (0..nodes as usize).map(|k| at(k as f64 * turn)).collect();
        let tau = [-0.5 * turn, phi - 0.5 * turn].map(|angle| at(angle + 0.5 * PI));
        let drum: Arc<dyn RigidShape> = Arc::new(Cylinder { point: V::zeros(), axis: V::z(), radius: 1.0 });
        let found = drawn(&drum, (&on, tau, 4.0 * (0.5 * turn).sin()), [mu, mu], exact);
        println!("{nodes} nodes: ln T1/T0 {found:.7} ({exact:.7})");
        assert!((found - exact).abs() < 1e-5);
    }
}

#[test]
fn slip_ends_within_a_node_of_the_closed_form() {
    let data = data();
    for case in data["partial_slip"].as_array().unwrap() {
        let p = |key: &str| case[key].as_f64().unwrap();
        let mu = 0.3;
        let (r, length, cells) = (mu / p("omega"), p("L"), 100);
        let turn = length / r;
        // It ends along y, where it is pulled.
        let path = Path::circle(
            V::zeros(),
            V::new(turn.cos(), -turn.sin(), 0.0),
            V::new(turn.sin(), turn.cos(), 0.0),
            r,
            turn,
        );
        let path = path.unwrap().sample(cells, Continuity::C0).unwrap();
        // Displacements are those of small strains, in proportion to 1/EA.
        let stiff = 1e3;
        let rope =
            Chain::new("rope", &path, stiff * p("EA"), ReferenceLength::Pretension(p("T_initial")), 0.0).unwrap();
        let mut system = System::default();
        system.bodies.push(Box::new(rope.clone()));
        system.bodies.push(Box::new(rigid(Arc::new(Cylinder { point: V::zeros(), axis: V::z(), radius: r }))));
        system.supports.push(support("start", |_| V::zeros()));
        let [t_0, t_1, t_2] = ["T_initial", "T1", "T2"].map(p);
        let force = move |t: f64| if t <= 1.0 { t_0 + (t_1 - t_0) * t } else { t_1 + (t_2 - t_1) * (t - 1.0) };
        // Along the curve: along the last chord no force would be borne by the last node.
        let load = TimedLoad::Force(Arc::new(move |_, t| V::y() * force(t)));
        system.loads.push(PlacedLoad { name: "pull".into(), part: Part { body: 0, group: Some("end".into()) }, load });
        let of = |body: usize| (Part { body, group: None }, system.bodies[body].as_ref());
        let mut contact = Contact::new("touch", of(0), of(1), Sampling::Nodes, Enforcement::Multiplier).unwrap();
        contact.law.friction = Some(Box::new(Coulomb::isotropic(mu).unwrap()));
        system.contacts.push(Box::new(contact));
        system.prepare().unwrap();
        let mut state = system.start();
        let end = rope.position(&state.bodies[0], cells);
        let node = length / f64::from(cells as u32);
        for step in 0..=20 {
            let (next, result) = system.solve(&state, 0.1 * f64::from(step), &mut |_, _| true).unwrap();
            system.accept(&next).unwrap();
            state = next;
            // What slips on: nodes that came to rest at the limit of friction are still there.
            let sites = || result.sites[0].iter().filter(|s| s.status == Status::Slip);
            let most = sites().map(|s| s.increment.norm()).fold(0.0, f64::max);
            let slips: f64 = sites().filter(|s| s.increment.norm() > 1e-6 * most).map(|s| s.weight).sum();
            let known = match step {
                10 => ["slip_length_loading", "end_displacement_loading"].map(p),
                20 => ["reverse_slip_length", "end_displacement_after_unloading"].map(p),
                _ => continue,
            };
            let moved = stiff * (rope.position(&state.bodies[0], cells) - end).norm();
            println!(
                "slips over {slips:.4} ({:.4}), end moved by {moved:.6} ({:.6}), node {node:.4}",
                known[0], known[1]
            );
            assert!((slips - known[0]).abs() <= node && (moved / known[1] - 1.0).abs() < 1e-2);
        }
    }
}
