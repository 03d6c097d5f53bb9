//! Contact between curves: variations against differences, balance, and problems with known solutions.

mod common;

use common::{Options, Search, Surroundings, V, clamp, first_unknowns, load_body, newton};
use signorini_contact::law::{Coulomb, Status};
use signorini_mechanics::body::{Body, BodyState, Constraint, Contribution, Hold, Load, Order};
use signorini_rope::beam::Beam;
use signorini_rope::cable::Cable;
use signorini_rope::cable::element::Carries;
use signorini_rope::centreline::{Closure, Continuity};
use signorini_rope::chain::body::Rest;
use signorini_rope::curve_body::CurveBody;
use signorini_rope::curve_pair::blend::Blend;
use signorini_rope::curve_pair::contact::{CurveContact, Ends, Form};
use signorini_rope::curve_pair::friction::CurveFriction;
use signorini_rope::curve_pair::measure::{CurvePair, elastic_slip, measure};
use signorini_rope::curve_pair::search::{Between, Searched, crossings};
use signorini_rope::path::Path;
use signorini_rope::quaternion;
use signorini_rope::section::Stiffness;
use std::sync::Arc;

fn beam(name: &str, points: &[V], cells: usize, stiffness: Stiffness, radius: f64) -> Beam {
    let path = match points.len() {
        2 => Path::points(points, Closure::Open),
        _ => Path::spline(points, Closure::Open),
    };
    Beam::new(name, &path.unwrap().sample(cells, Continuity::C1).unwrap(), None, stiffness, radius).unwrap()
}

fn soft() -> Stiffness {
    Stiffness { axial: 100.0, shear: [40.0; 2], torsion: 1.0, bending: [1.0; 2] }
}

/// Two curved beams that cross, or run along each other.
fn two_curves(angle: f64) -> [Beam; 2] {
    let a = [V::new(-2.0, 0.1, 0.0), V::new(0.0, 0.0, 0.3), V::new(2.0, -0.2, 0.1)];
    let (c, s) = (angle.cos(), angle.sin());
    let turned = |x: f64, y: f64, z: f64| V::new(c * x - s * y, s * x + c * y, z);
    let b = [turned(-1.8, 0.1, 0.7), turned(0.1, -0.1, 0.55), turned(2.1, 0.2, 0.8)];
    [beam("a", &a, 3, soft(), 0.2), beam("b", &b, 4, soft(), 0.1)]
}

enum Kind {
    Crossing,
    /// A point of Gauss of the first against the nearest point of the second.
    Line,
    /// The end of the first against the second.
    End,
}

/// The pair of two states, projected anew.
fn pair(bodies: &[Beam; 2], states: &[BodyState], kind: &Kind, order: Order) -> CurvePair {
    let first = first_unknowns(&[&bodies[0], &bodies[1]]);
    let first = [first[0], first[1]];
    let sides = [0, 1].map(|s| Searched { body: &bodies[s], state: &states[s] });
    let foot = |s: usize, e: usize, xi: f64, c: usize| bodies[s].foot(&states[s].configuration, e, xi, c);
    match kind {
        Kind::Crossing => {
            let near = crossings(sides[0], sides[1], Between::Two, 2.0);
            let near = near.iter().find(|n| n.points.iter().all(|p| p.coordinates == 1)).unwrap();
            let feet = [0, 1].map(|s| foot(s, near.points[s].element, near.points[s].xi, 1));
            measure([&feet[0], &feet[1]], first, None, order).unwrap()
        }
        Kind::Line | Kind::End => {
            let a = if matches!(kind, Kind::Line) { foot(0, 1, 0.3, 0) } else { foot(0, 2, 1.0, 0) };
            let master = bodies[1].master(None, &states[1]).unwrap();
            let Some(signorini_mechanics::body::Met::Foot(b)) = master.nearest(&a.jet.x, 5.0, None) else {
                panic!("nothing near")
            };
            assert_eq!(b.coordinates, 1);
            measure([&a, &b], first, None, order).unwrap()
        }
    }
}

/// Values by unknown of the system.
fn gather<T: Copy + std::ops::AddAssign + Default>(n: usize, unknowns: &[u32], values: &[T]) -> Vec<T> {
    let mut out = vec![T::default(); n];
    unknowns.iter().zip(values).for_each(|(u, v)| out[*u as usize] += *v);
    out
}

#[test]
fn variations_of_all_pairs_are_derivatives() {
    for (angle, kind) in [(1.1, Kind::Crossing), (0.4, Kind::Crossing), (0.1, Kind::Line), (0.05, Kind::End)] {
        let bodies = two_curves(angle);
        let first = first_unknowns(&[&bodies[0], &bodies[1]]);
        let n = first[2] as usize;
        let step: Vec<f64> = (0..n).map(|k| (1.0 + 1.3 * k as f64).sin()).collect();
        let start = [bodies[0].start(), bodies[1].start()];
        let moved = |share: f64| -> Vec<BodyState> {
            let of = |b: usize| &step[first[b] as usize..first[b + 1] as usize];
            (0..2).map(|b| bodies[b].advance(&start[b], of(b), share)).collect()
        };
        let now = pair(&bodies, &moved(0.0), &kind, Order::Second);
        let along =
            |values: &[f64]| -> f64 { now.unknowns.iter().zip(values).map(|(u, v)| step[*u as usize] * v).sum() };
        let e = 1e-4;
        let (p, m) = (pair(&bodies, &moved(e), &kind, Order::Second), pair(&bodies, &moved(-e), &kind, Order::Second));
        let first_error = ((p.gap - m.gap) / (2.0 * e) - along(&now.d_gap)).abs();
        let rows = now.unknowns.len();
        let product: Vec<f64> = (0..rows).map(|k| along(&now.d2_gap[k * rows..(k + 1) * rows])).collect();
        // Differences of forces: elements of the pair must be the same.
        assert_eq!(p.unknowns, m.unknowns);
        let second_error =
            (0..rows).map(|k| ((p.d_gap[k] - m.d_gap[k]) / (2.0 * e) - product[k]).abs()).fold(0.0, f64::max);
        let scale = product.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        let parallel_error = ((p.parallel - m.parallel) / (2.0 * e) - along(&now.d_parallel)).abs();
        println!("angle {angle}: {first_error:.1e} {:.1e} {parallel_error:.1e}", second_error / scale);
        assert!(first_error < 1e-6 && second_error < 1e-5 * scale && parallel_error < 1e-6);
        // Richardson: the error of the differences falls with the square of the step, so the rest is theirs.
        let at = |e: f64| {
            let (p, m) =
                (pair(&bodies, &moved(e), &kind, Order::First), pair(&bodies, &moved(-e), &kind, Order::First));
            (p.gap - m.gap) / (2.0 * e)
        };
        let (coarse, fine) = (at(2e-3), at(1e-3));
        assert!(((4.0 * fine - coarse) / 3.0 - along(&now.d_gap)).abs() < 1e-9);
    }
}

#[test]
fn rigid_motions_are_no_slip_and_forces_balance() {
    for (angle, kind) in [(1.1, Kind::Crossing), (0.1, Kind::Line), (0.05, Kind::End)] {
        let bodies = two_curves(angle);
        let states = [bodies[0].start(), bodies[1].start()];
        let first = first_unknowns(&[&bodies[0], &bodies[1]]);
        let n = first[2] as usize;
        let now = pair(&bodies, &states, &kind, Order::Second);
        let gap = gather(n, &now.unknowns, &now.d_gap);
        let modes = [bodies[0].rigid_modes(&states[0]), bodies[1].rigid_modes(&states[1])];
        for k in 0..6 {
            let mode: Vec<f64> = modes[0][k].iter().chain(&modes[1][k]).copied().collect();
            let power: f64 = gap.iter().zip(&mode).map(|(a, b)| a * b).sum();
            assert!(power.abs() < 1e-13, "{power}");
            let slip = now.unknowns.iter().zip(&now.slip).fold(V::zeros(), |s, (u, v)| s + v * mode[*u as usize]);
            let slip = slip - now.normal * now.normal.dot(&slip);
            assert!(slip.norm() < 1e-13, "{k}: {slip}");
        }
    }
}

#[test]
fn slip_follows_material_points_of_both_surfaces() {
    let bodies = two_curves(0.9);
    let first = first_unknowns(&[&bodies[0], &bodies[1]]);
    let n = first[2] as usize;
    let step: Vec<f64> = (0..n).map(|k| (0.4 + 2.3 * k as f64).cos()).collect();
    let start = [bodies[0].start(), bodies[1].start()];
    let moved = |share: f64| -> Vec<BodyState> {
        let of = |b: usize| &step[first[b] as usize..first[b + 1] as usize];
        (0..2).map(|b| bodies[b].advance(&start[b], of(b), share)).collect()
    };
    let now = pair(&bodies, &moved(0.0), &Kind::Crossing, Order::Second);
    // What touches now, followed: its rate is the variation of the slip but for the gap that turns with the normal.
    let at = |states: &[BodyState]| {
        let feet = [0, 1].map(|s| {
            let p = now.stuck.points[s];
            bodies[s].foot(&states[s].configuration, p.patch as usize, p.xi[0], 1)
        });
        elastic_slip(&now.stuck, [&feet[0], &feet[1]], [first[0], first[1]])
    };
    let e = 1e-5;
    let rate = (at(&moved(e)).0 - at(&moved(-e)).0) / (2.0 * e);
    let (apart, unknowns, d_e) = at(&moved(0.0));
    assert!((apart - now.normal * now.gap).norm() < 1e-13);
    let along =
        |unknowns: &[u32], v: &[V]| unknowns.iter().zip(v).fold(V::zeros(), |s, (u, v)| s + v * step[*u as usize]);
    assert!((rate - along(&unknowns, &d_e)).norm() < 1e-8 * rate.norm());
    let turned = along(&now.unknowns, &now.d_normal) * now.gap;
    let slip = along(&now.unknowns, &now.slip);
    let across = |v: V| v - now.normal * now.normal.dot(&v);
    assert!((across(rate - turned - slip)).norm() < 1e-7 * rate.norm());
    let difference = {
        let (p, m) = (
            pair(&bodies, &moved(e), &Kind::Crossing, Order::First),
            pair(&bodies, &moved(-e), &Kind::Crossing, Order::First),
        );
        (p.normal - m.normal) / (2.0 * e)
    };
    assert!((difference - along(&now.unknowns, &now.d_normal)).norm() < 1e-7);
}

/// Cantilevers that cross: the first is pushed at its end, down onto the second.
struct Cantilevers<'a> {
    bodies: [&'a Beam; 2],
    contact: CurveContact,
    push: V,
}

impl Cantilevers<'_> {
    fn sides<'b>(&'b self, states: &'b [BodyState]) -> [Searched<'b>; 2] {
        [0, 1].map(|s| Searched { body: self.bodies[s] as &dyn CurveBody, state: &states[s] })
    }

    fn force(&self, states: &[BodyState]) -> f64 {
        let first = first_unknowns(&[self.bodies[0], self.bodies[1]]);
        let contacts = self.contact.contacts(self.sides(states), [first[0], first[1]], Order::First);
        contacts.iter().map(|c| c.pressing()).sum()
    }
}

impl Surroundings for Cantilevers<'_> {
    fn hold(&self, states: &[BodyState]) -> Vec<(usize, Constraint)> {
        (0..2).flat_map(|b| clamp(self.bodies[b], "start", &states[b]).into_iter().map(move |c| (b, c))).collect()
    }
    fn act(&self, states: &[BodyState], first: &[u32], order: Order, out: &mut Contribution) {
        load_body(self.bodies[0], Some("end"), &Load::Force(self.push), &states[0], order, first[0], out);
        self.contact.act(self.sides(states), [first[0], first[1]], order, out);
    }
    fn stepped(&mut self, states: &[BodyState], first: &[u32], step: &[f64]) {
        let mut contact = self.contact.clone();
        contact.predict(self.sides(states), [first[0], first[1]], step);
        self.contact = contact;
    }
}

fn slender(bending: f64, stiff: f64) -> Stiffness {
    Stiffness { axial: stiff, shear: [stiff; 2], torsion: bending, bending: [bending; 2] }
}

/// Force, deflection of the end and iterations of crossing cantilevers.
#[expect(clippy::too_many_arguments)] // The constants of a closed form.
fn cross(
    [l_1, l_2]: [f64; 2],
    [ei_1, ei_2]: [f64; 2],
    [a_1, a_2]: [f64; 2],
    [push, gap, angle]: [f64; 3],
    radius: f64,
    points: usize,
    (form, point_penalty, line_penalty): (Form, f64, f64),
    increments: usize,
) -> (f64, f64, usize) {
    // Stiff enough for a beam without shear; less where large steps are to be taken.
    let stiff = if increments == 1 { 1e8 } else { 1e5 };
    let direction = V::new(angle.cos(), angle.sin(), 0.0);
    let below = V::new(a_1, 0.0, -gap - 2.0 * radius) - direction * a_2;
    let one = |l: f64, a: f64| {
        // A node where they touch.
        let cells = (1..).map(|k| k * 2).find(|k| (a * *k as f64 / l).fract().abs() < 1e-9).unwrap();
        if cells < 6 { 8.max(cells * (8 / cells)) } else { cells }
    };
    let bodies = [
        beam("upper", &[V::zeros(), V::new(l_1, 0.0, 0.0)], one(l_1, a_1), slender(ei_1, stiff), radius),
        beam("lower", &[below, below + direction * l_2], one(l_2, a_2), slender(ei_2, stiff), radius),
    ]
    .map(|b| b.with_contact_points(points));
    let mut contact = CurveContact::new(form, Between::Two, point_penalty, line_penalty);
    contact.reach = 2.0;
    let starts = [bodies[0].start(), bodies[1].start()];
    let first = first_unknowns(&[&bodies[0], &bodies[1]]);
    let sides = [0, 1].map(|s| Searched { body: &bodies[s] as &dyn CurveBody, state: &starts[s] });
    contact.follow(sides, [first[0], first[1]]);
    let mut around = Cantilevers { bodies: [&bodies[0], &bodies[1]], contact, push: V::zeros() };
    let options = Options { most: 30, tolerance: 1e-9 * push, search: Search::WholeSteps };
    let (mut states, mut most) = (starts.to_vec(), 0);
    for k in 1..=increments {
        around.push = V::new(0.0, 0.0, -push * k as f64 / increments as f64);
        let found = newton(&[&bodies[0] as &dyn Body, &bodies[1]], &states, &mut around, &options)
            .unwrap_or_else(|f| panic!("increment {k}: {:?}", f.residuals));
        most = most.max(found.iterations());
        states = found.states;
    }
    let tip = -bodies[0].position(&states[0], bodies[0].elements())[2];
    (around.force(&states), tip, most)
}

#[test]
fn crossing_cantilevers_have_the_exact_force() {
    let data: serde_json::Value = serde_json::from_str(include_str!("data/crossing_cantilevers.json")).unwrap();
    // Small: forces and gap by 1e-4.
    let small = 1e-4;
    let check = |lengths: [f64; 2], ei: [f64; 2], a: [f64; 2], [p, g, angle]: [f64; 3], expected: f64, tip: f64| {
        let form = (Form::Point, 1e6, 0.0);
        let (f, w, iterations) = cross(lengths, ei, a, [p * small, g * small, angle], 0.02, 4, form, 1);
        println!(
            "{angle:.3}: F {:.6} ({expected:.6}), tip {:.6} ({tip:.6}), {iterations} iterations",
            f / small,
            w / small
        );
        assert!((f / small - expected).abs() < 3e-5 * expected.max(1.0), "{}", f / small);
        assert!((w / small - tip).abs() < 3e-5 * tip.max(1.0));
        assert!(iterations <= 6);
    };
    for row in data["crossing_cantilevers"]["rows"].as_array().unwrap() {
        let n = |key: &str| row[key].as_f64().unwrap();
        if n("a1") == n("L1") {
            continue;
        }
        let expected = row["penalty_corrected"]["1000000.0"].as_f64().unwrap();
        let load = [n("P_tip"), n("g0"), n("crossing_angle_deg").to_radians()];
        check([n("L1"), n("L2")], [n("EI1"), n("EI2")], [n("a1"), n("a2")], load, expected, n("w1_tip"));
    }
    // Another one, by the formula.
    let (a_1, a_2, g, p) = (7.0f64, 4.0f64, 0.1, 1.7);
    let flexible = [a_1.powi(3) / 600.0, a_2.powi(3) / 450.0];
    let f = (p * a_1 * a_1 * (30.0 - a_1) / 1200.0 - g) / (flexible[0] + flexible[1] + 1e-6);
    let tip = p * 1000.0 / 600.0 - f * a_1 * a_1 * (30.0 - a_1) / 1200.0;
    check([10.0, 8.0], [200.0, 150.0], [a_1, a_2], [p, g, 60f64.to_radians()], f, tip);
}

#[test]
fn forces_pass_smoothly_from_crossing_to_parallel() {
    let blend = Blend::new(10f64.to_radians(), 25f64.to_radians()).unwrap();
    // Small enough for the linear solution, large enough that tubes overlap over several points of Gauss.
    let (penalty, radius, small) = (130.0, 0.2, 0.2);
    let line = blend.line_penalty(penalty, 0.8 * small, [radius; 2]);
    let at = |angle: f64, form: Form, increments: usize| {
        let load = [small, 0.2 * small, angle.to_radians()];
        let form = (form, penalty, line);
        let (f, _, iterations) = cross([10.0, 8.0], [200.0, 150.0], [6.0, 5.0], load, radius, 12, form, increments);
        (f / small, iterations)
    };
    let mut before: Option<(f64, f64)> = None;
    for angle in [40.0, 32.0, 26.0, 22.0, 18.0, 14.0, 10.0f64] {
        let (f, iterations) = at(angle, Form::Blend(blend), 4);
        println!("{angle}°: F {f:.5}, at most {iterations} iterations");
        assert!(before.is_none_or(|(last, force)| (f - force).abs() < 3e-3 * (last - angle)));
        before = Some((angle, f));
    }
    // Below the band lines bear alone. Nearly parallel curves touch where their slopes agree, far from where they cross: the
    // force is that of points there, but for the softness of both penalties, 1/130 against 0.64 of the beams.
    let (f, iterations) = at(7.0, Form::Blend(blend), 8);
    let (of_points, _) = at(7.0, Form::Point, 8);
    println!("7°: F {f:.5}, as points {of_points:.5}, at most {iterations} iterations");
    assert!((f / of_points - 1.0).abs() < 2.5e-2);
}

/// Two parallel tubes that touch, turned about their common axis at one end.
struct Twisted<'a> {
    bodies: [&'a Beam; 2],
    contact: CurveContact,
    angle: f64,
}

impl Twisted<'_> {
    fn sides<'b>(&'b self, states: &'b [BodyState]) -> [Searched<'b>; 2] {
        [0, 1].map(|s| Searched { body: self.bodies[s] as &dyn CurveBody, state: &states[s] })
    }
}

impl Surroundings for Twisted<'_> {
    fn hold(&self, states: &[BodyState]) -> Vec<(usize, Constraint)> {
        let turn = quaternion::rotation(&quaternion::exponential(&(V::x() * self.angle)));
        let component = |i: usize| move |x: &V| (turn * x - x)[i];
        let (x, y, z) = (component(0), component(1), component(2));
        let (about, zero) = (|_: &V| self.angle, |_: &V| 0.0);
        let hold =
            Hold { displacement: [Some(&x), Some(&y), Some(&z)], rotation: [Some(&about), Some(&zero), Some(&zero)] };
        (0..2)
            .flat_map(|b| {
                let mut all = clamp(self.bodies[b], "start", &states[b]);
                all.extend(self.bodies[b].hold(Some("end"), &hold, &states[b]).unwrap());
                all.into_iter().map(move |c| (b, c))
            })
            .collect()
    }
    fn act(&self, states: &[BodyState], first: &[u32], order: Order, out: &mut Contribution) {
        self.contact.act(self.sides(states), [first[0], first[1]], order, out);
    }
    fn stepped(&mut self, states: &[BodyState], first: &[u32], step: &[f64]) {
        let mut contact = self.contact.clone();
        contact.predict(self.sides(states), [first[0], first[1]], step);
        self.contact = contact;
    }
}

#[test]
fn two_tubes_are_twisted_by_a_full_turn() {
    let (radius, length, cells) = (0.1, 4.0, 10);
    let stiffness = Stiffness { axial: 400.0, shear: [160.0; 2], torsion: 0.8, bending: [1.0; 2] };
    let tube =
        |name: &str, y: f64| beam(name, &[V::new(0.0, y, 0.0), V::new(length, y, 0.0)], cells, stiffness, radius);
    let bodies = [tube("first", radius), tube("second", -radius)];
    let mut contact = CurveContact::new(Form::Line, Between::Two, 0.0, 2e3);
    contact.ends = Ends::PassBy;
    contact.reach = 0.02;
    let mut around = Twisted { bodies: [&bodies[0], &bodies[1]], contact, angle: 0.0 };
    let mut states = vec![bodies[0].start(), bodies[1].start()];
    let first = first_unknowns(&[&bodies[0], &bodies[1]]);
    let increment = 15f64.to_radians();
    let mut before = (0.0, 0.0);
    for step in 1..=24 {
        around.angle = step as f64 * increment;
        // Every section turns by its share of the angle.
        for b in 0..2 {
            states[b] = bodies[b].moved(&states[b], |x| {
                let q = quaternion::exponential(&(V::x() * (increment * x[0] / length)));
                let moved = quaternion::rotation(&q) * x;
                (moved, q, V::x().cross(&moved) * (increment / length))
            });
        }
        let options = Options { most: 20, tolerance: 1e-10, search: Search::WholeSteps };
        let found = newton(&[&bodies[0] as &dyn Body, &bodies[1]], &states, &mut around, &options)
            .unwrap_or_else(|f| panic!("step {step}: {:?}", f.residuals));
        states = found.states.clone();
        let contacts = around.contact.contacts(around.sides(&states), [first[0], first[1]], Order::First);
        let force: f64 = contacts.iter().map(|c| c.pressing()).sum();
        let active = contacts.iter().filter(|c| c.pressing() > 0.0).count();
        let torque: f64 = (0..2)
            .map(|b| {
                let at = first[b] as usize + 9 * cells;
                let (x, f) = (bodies[b].position(&states[b], cells), &found.forces[at..at + 9]);
                x[1] * f[2] - x[2] * f[1] + f[6]
            })
            .sum();
        if step % 6 == 0 {
            println!(
                "{}°: force {force:.4}, torque {torque:.4}, {active} active, {} iterations, residual {:.1e}",
                15 * step,
                found.iterations(),
                found.residuals[found.iterations()]
            );
        }
        assert!(found.iterations() <= 10, "{:?}", found.residuals);
        assert!(force >= before.0 && torque > before.1);
        before = (force, torque);
        let reference = [(12, 0.7485, 1.3033), (24, 7.519, 2.7674)];
        for (at, f, t) in reference {
            if step == at {
                assert!((force / f - 1.0).abs() < 1e-2 && (torque / t - 1.0).abs() < 2e-3, "{force} {torque}");
                assert!(step == 12 || active == 36, "{active}");
            }
        }
    }
}

#[test]
fn ends_bear_parallel_cantilevers() {
    // A leaf spring on a shorter one: the exact reaction is a force at the end of the shorter.
    let small = 1e-4;
    let (l_1, l_2) = (10.0f64, 8.0f64);
    let expected = l_2 * l_2 * (3.0 * l_1 - l_2) / (6.0 * 200.0) / (l_2.powi(3) / 3.0 * (2.0 / 200.0) + 1e-6);
    let form = (Form::Point, 1e6, 0.0);
    let (f, tip, iterations) = cross([l_1, l_2], [200.0; 2], [8.0, 8.0], [small, 0.0, 0.0], 0.05, 4, form, 1);
    println!("parallel: F {:.6} ({expected:.6}), tip {:.5} (0.86), {iterations} iterations", f / small, tip / small);
    assert!((f / small - expected).abs() < 1e-4 && (tip / small - 0.86).abs() < 1e-4);
    // End on end.
    let (f, tip, iterations) = cross(
        [10.0, 10.0],
        [200.0; 2],
        [10.0, 10.0],
        [2.0 * small, 0.0, std::f64::consts::FRAC_PI_2],
        0.05,
        4,
        form,
        1,
    );
    println!("end on end: F {:.6} (1), tip {:.5} (1.66667), {iterations} iterations", f / small, tip / small);
    assert!((f / small - 1.0).abs() < 1e-4 && (tip / small - 5.0 / 3.0).abs() < 1e-4);
}

#[test]
fn large_motions_do_not_tunnel() {
    // The first iterate passes right through the lower beam.
    let form = (Form::Point, 1e4, 0.0);
    let (f, _, iterations) = cross([10.0, 8.0], [200.0, 150.0], [6.0, 5.0], [1.0, 0.2, 1.2], 0.02, 4, form, 4);
    println!("F {f:.5}, {iterations} iterations");
    assert!((f - 0.8152).abs() < 0.01);
}

#[test]
fn curves_touch_themselves_but_not_next_to_themselves() {
    // A nearly closed loop: a minimum where it passes itself, none next to any point.
    let loop_points: Vec<V> = (0..=24)
        .map(|k| k as f64 / 24.0 * 1.2 * std::f64::consts::TAU)
        .map(|t| V::new(t.cos(), t.sin(), 0.06 * t))
        .collect();
    let body = beam("loop", &loop_points, 24, soft(), 0.15);
    let state = body.start();
    let side = Searched { body: &body, state: &state };
    let near = crossings(side, side, Between::Itself, 0.5);
    assert!(!near.is_empty());
    // Turns of the helix pass each other at a pitch of 0.06 · 2π.
    let pitch = 0.06 * std::f64::consts::TAU;
    println!("{near:?}");
    assert!(near.iter().all(|n| (n.distance - pitch).abs() < 0.1 * pitch));
    assert!(near.iter().all(|n| n.points[1].element - n.points[0].element >= 18));
    let straight = beam("straight", &[V::zeros(), V::new(5.0, 0.0, 0.0)], 10, soft(), 0.15);
    let state = straight.start();
    let side = Searched { body: &straight, state: &state };
    assert!(crossings(side, side, Between::Itself, 0.5).is_empty());
    let master = straight.master(None, &state).unwrap();
    let site = signorini_mechanics::body::Site { patch: 3, xi: [0.2, 0.0], weight: 1.0 };
    assert!(master.nearest(&V::new(1.6, 0.0, 0.0), 0.3, Some(&site)).is_none());
    assert!(master.nearest(&V::new(1.6, 0.0, 0.0), 0.3, None).is_some());
}

#[test]
fn parallel_curves_never_fail() {
    for angle in [0.0f64, 1e-12, 1e-9, 1e-6, 1e-4, 1e-2] {
        let direction = V::new(angle.cos(), angle.sin(), 0.0) * 4.0;
        let shift = V::new(-2.0, 0.0, 0.15);
        let bodies = [
            beam("a", &[V::new(-2.0, 0.0, 0.0), V::new(2.0, 0.0, 0.0)], 5, soft(), 0.1),
            beam("b", &[shift, shift + direction], 7, soft(), 0.1),
        ];
        let states = [bodies[0].start(), bodies[1].start()];
        let sides = [0, 1].map(|s| Searched { body: &bodies[s] as &dyn CurveBody, state: &states[s] });
        let contact = CurveContact::new(Form::Blend(Blend::default()), Between::Two, 1e3, 1e3);
        let first = first_unknowns(&[&bodies[0], &bodies[1]]);
        let found = contact.contacts(sides, [first[0], first[1]], Order::Second);
        let pressing: f64 = found.iter().map(|c| c.pressing()).sum();
        assert!(pressing.is_finite() && pressing > 0.0, "{angle} {pressing}");
        assert!(found.iter().all(|c| c.pair.d2_gap.iter().all(|v| v.is_finite())));
    }
}

/// Curves without sections that turn, a little apart or pressed on each other, with points that touched before.
fn rubbing(mu: [f64; 2], shift: f64) -> ([Cable; 2], Vec<BodyState>, CurveContact) {
    let cable = |name: &str, points: &[V], cells: usize| {
        let path = Path::spline(points, Closure::Open).unwrap().sample(cells, Continuity::C1).unwrap();
        Cable::new(name, &path, 50.0, 1.0, Carries::TensionAndCompression, Rest::Path, 0.1).unwrap()
    };
    let bodies = [
        cable("a", &[V::new(-1.0, 0.02, 0.0), V::new(0.0, 0.0, -0.05), V::new(1.2, 0.1, 0.02)], 2),
        cable("b", &[V::new(0.1, -1.0, -0.3), V::new(0.0, 0.0, -0.25), V::new(-0.1, 1.1, -0.33)], 3),
    ];
    let mut states = vec![bodies[0].start(), bodies[1].start()];
    let first = first_unknowns(&[&bodies[0], &bodies[1]]);
    let step: Vec<f64> = (0..first[2]).map(|k| (0.7 + 1.9 * k as f64).sin()).collect();
    let mut contact = CurveContact::new(Form::Point, Between::Two, 1e3, 0.0);
    contact.friction = Some(CurveFriction { law: Arc::new(Coulomb::orthotropic(mu).unwrap()), penalty: 400.0 });
    contact.reach = 0.2;
    // Pressed together until the gap is next to nothing: terms with gap and turn of the normal are left out of the tangent.
    let sides = |s: &[BodyState]| -> f64 {
        let of = [0, 1].map(|k| Searched { body: &bodies[k] as &dyn CurveBody, state: &s[k] });
        contact.contacts(of, [first[0], first[1]], Order::First)[0].pair.gap
    };
    let lift = |s: &BodyState, z: f64| {
        let mut s = s.clone();
        s.configuration.chunks_mut(6).for_each(|c| c[2] += z);
        s
    };
    for _ in 0..6 {
        let gap = sides(&states);
        states[0] = lift(&states[0], -(gap + 1e-7));
    }
    let of = [0, 1].map(|k| Searched { body: &bodies[k] as &dyn CurveBody, state: &states[k] });
    contact.settle(of, [first[0], first[1]]);
    let of = |b: usize| &step[first[b] as usize..first[b + 1] as usize];
    states = (0..2).map(|b| bodies[b].advance(&states[b], of(b), shift)).collect();
    let gap = {
        let of = [0, 1].map(|k| Searched { body: &bodies[k] as &dyn CurveBody, state: &states[k] });
        contact.contacts(of, [first[0], first[1]], Order::First)[0].pair.gap
    };
    states[0] = lift(&states[0], -(gap + 1e-5));
    (bodies, states, contact)
}

#[test]
fn friction_has_its_derivative_in_stick_and_in_slip() {
    for (mu, slips) in [([5e3, 5e3], false), ([0.2, 0.2], true), ([0.15, 0.3], true)] {
        let (bodies, states, contact) = rubbing(mu, 1e-3);
        let first = first_unknowns(&[&bodies[0], &bodies[1]]);
        let n = first[2] as usize;
        let step: Vec<f64> = (0..n).map(|k| (0.2 + 1.1 * k as f64).cos()).collect();
        let moved = |share: f64| -> Vec<BodyState> {
            let of = |b: usize| &step[first[b] as usize..first[b + 1] as usize];
            (0..2).map(|b| bodies[b].advance(&states[b], of(b), share)).collect()
        };
        let act = |states: &[BodyState], order: Order| {
            let sides = [0, 1].map(|k| Searched { body: &bodies[k] as &dyn CurveBody, state: &states[k] });
            let contacts = contact.contacts(sides, [first[0], first[1]], Order::Second);
            let found = contact.tangential(&contacts[0], sides, [first[0], first[1]], order).unwrap();
            assert_eq!(found.status == Status::Slip, slips);
            found
        };
        let now = act(&states, Order::Second);
        let m = now.unknowns.len();
        let e = 1e-7;
        let (p, q) = (act(&moved(e), Order::First).forces, act(&moved(-e), Order::First).forces);
        let mut worst = 0.0f64;
        let mut scale = 0.0f64;
        for k in 0..p.len() {
            let product: f64 = (0..m).map(|l| now.tangent[k * m + l] * step[now.unknowns[l] as usize]).sum();
            worst = worst.max(((p[k] - q[k]) / (2.0 * e) - product).abs());
            scale = scale.max(product.abs());
        }
        println!("mu {mu:?}: {:.1e}, traction {:?}", worst / scale, now.components);
        assert!(worst < 1e-4 * scale);
    }
}

#[test]
fn slip_is_limited_and_the_points_that_touched_follow() {
    let (bodies, states, mut contact) = rubbing([0.3, 0.3], 0.0);
    let first = first_unknowns(&[&bodies[0], &bodies[1]]);
    let ordered = [first[0], first[1]];
    let moved = |x: f64| {
        let mut s = states.clone();
        s[0].configuration.chunks_mut(6).for_each(|c| c[0] += x);
        s
    };
    let at = |contact: &CurveContact, s: &[BodyState]| {
        let sides = [0, 1].map(|k| Searched { body: &bodies[k] as &dyn CurveBody, state: &s[k] });
        let contacts = contact.contacts(sides, ordered, Order::First);
        let t = contact.tangential(&contacts[0], sides, ordered, Order::First).unwrap();
        (t.components, t.status, -contacts[0].force)
    };
    // Stick: by the penalty; then slip: by the pressing force, as far as one goes.
    let limit = 0.3 * at(&contact, &states).2;
    let small = 0.5 * limit / 400.0;
    let (t, status, _) = at(&contact, &moved(small));
    assert!(status == Status::Stick && (t[0].hypot(t[1]) / (400.0 * small) - 1.0).abs() < 1e-2, "{t:?} {small}");
    for k in 1..=5 {
        let s = moved(20.0 * small * k as f64);
        let (t, status, pressing) = at(&contact, &s);
        if pressing == 0.0 {
            break;
        }
        assert!(status == Status::Slip && (t[0].hypot(t[1]) - 0.3 * pressing).abs() < 1e-9 * pressing);
        let sides = [0, 1].map(|k| Searched { body: &bodies[k] as &dyn CurveBody, state: &s[k] });
        contact.settle(sides, ordered);
        // The same state again: nothing has slipped since, and the traction is where it was.
        let (again, _, _) = at(&contact, &s);
        assert!((again[0] - t[0]).abs() < 1e-3 * t[0].abs(), "{again:?} {t:?}");
    }
}
