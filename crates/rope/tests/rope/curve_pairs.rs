//! Contact between curves: gap, slip and tangent against differences, balance, search.

use crate::common::acting::{balance, first_unknowns, laws, taylor};
use crate::common::bodies::{beam, cable};
use signorini_contact::Coulomb;
use signorini_contact::law::Status;
use signorini_geometry::Vector;
use signorini_mechanics::ContactSides;
use signorini_mechanics::body::{Body, BodyState, Order};
use signorini_mechanics::interaction::{Bodies, Interaction, InteractionUnknowns};
use signorini_mechanics::{Curve, Enforcement};
use signorini_rope::beam::Beam;
use signorini_rope::curve_pair::blend::Blend;
use signorini_rope::curve_pair::contact::{CurveContact, Form, Penalties};
use signorini_rope::curve_pair::measure::{CurvePair, Wanted, elastic_slip, measure};
use signorini_rope::curve_pair::search::{SearchScope, Searched, crossings};
use signorini_rope::section::Stiffness;

type V = Vector<3>;

fn soft() -> Stiffness {
    Stiffness { axial: 100.0, shear: [40.0; 2], torsion: 1.0, bending: [1.0; 2] }
}

fn searched<'a>(curve: &'a dyn Curve, state: &'a BodyState) -> Searched<'a> {
    Searched { curve, configuration: &state.configuration }
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
    let curves = [0, 1].map(|s| bodies[s].curve(None).unwrap());
    let sides = [0, 1].map(|s| searched(curves[s].as_ref(), &states[s]));
    let foot = |s: usize, e: usize, xi: f64, c: usize| curves[s].foot(&states[s].configuration, e, xi, c);
    let bends = [0, 1].map(|_| Vec::new());
    let wanted = (Wanted::GapAndSlip(bends.each_ref().map(Vec::as_slice)), order);
    match kind {
        Kind::Crossing => {
            let near = crossings(sides[0], sides[1], SearchScope::Two, 2.0);
            let near = near.iter().find(|n| n.points.iter().all(|p| p.coordinates == 1)).unwrap();
            let feet = [0, 1].map(|s| foot(s, near.points[s].element, near.points[s].xi, 1));
            measure([&feet[0], &feet[1]], first, None, wanted).unwrap()
        }
        Kind::Line | Kind::End => {
            let a = if matches!(kind, Kind::Line) { foot(0, 1, 0.3, 0) } else { foot(0, 2, 1.0, 0) };
            let master = bodies[1].master(None, &states[1]).unwrap();
            let Some(signorini_mechanics::body::MasterProjection::Foot(b)) = master.nearest(&a.jet.x, 5.0, None) else {
                panic!("nothing near")
            };
            assert_eq!(b.coordinates, 1);
            measure([&a, &b], first, None, wanted).unwrap()
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
            bodies[s].curve(None).unwrap().foot(&states[s].configuration, p.patch as usize, p.xi[0], 1)
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

#[test]
fn curves_touch_themselves_but_not_next_to_themselves() {
    // A nearly closed loop: a minimum where it passes itself, none next to any point.
    let loop_points: Vec<V> = (0..=24)
        .map(|k| k as f64 / 24.0 * 1.2 * std::f64::consts::TAU)
        .map(|t| V::new(t.cos(), t.sin(), 0.06 * t))
        .collect();
    let body = beam("loop", &loop_points, 24, soft(), 0.15);
    let state = body.start();
    let curve = body.curve(None).unwrap();
    let side = searched(curve.as_ref(), &state);
    let near = crossings(side, side, SearchScope::Itself, 0.5);
    assert!(!near.is_empty());
    // Turns of the helix pass each other at a pitch of 0.06 · 2π.
    let pitch = 0.06 * std::f64::consts::TAU;
    println!("{near:?}");
    assert!(near.iter().all(|n| (n.distance - pitch).abs() < 0.1 * pitch));
    assert!(near.iter().all(|n| n.points[1].element - n.points[0].element >= 18));
    let straight = beam("straight", &[V::zeros(), V::new(5.0, 0.0, 0.0)], 10, soft(), 0.15);
    let state = straight.start();
    let curve = straight.curve(None).unwrap();
    let side = searched(curve.as_ref(), &state);
    assert!(crossings(side, side, SearchScope::Itself, 0.5).is_empty());
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
        let first = first_unknowns(&[&bodies[0], &bodies[1]]);
        let curves = [0, 1].map(|s| bodies[s].curve(None).unwrap());
        let sides = [0, 1].map(|s| searched(curves[s].as_ref(), &states[s]));
        let penalty = Enforcement::Penalty { wanted_penetration: None };
        let mut contact = CurveContact::new("touch", (0, &bodies[0]), (1, &bodies[1]), penalty).unwrap();
        contact.law.friction = Some(Box::new(Coulomb::isotropic(0.3).unwrap()));
        for form in [contact.form, Form::Point, Form::Line, Form::Blend(Blend::default())] {
            contact.form = form;
            let (found, lost) = contact.touches(sides, [first[0], first[1]], Order::Second, &[]);
            let pressing: f64 = found.iter().map(|c| c.pressing()).sum();
            // Parallel axes have no crossing, so that nothing is lost.
            assert!(lost == 0 && pressing.is_finite() && (pressing > 0.0 || form == Form::Point), "{angle} {pressing}");
            assert!(found.iter().all(|c| c.pair.d2_gap.iter().all(|v| v.is_finite())));
        }
    }
}

/// Which kind of contact is made.
#[derive(Clone, Copy, Debug)]
enum Case {
    Crossing,
    Blended,
    Along,
    Itself,
    /// Two ends, head on and side by side.
    HeadOn,
    EndsCross,
}

/// Curves in contact, and the contact.
fn touching(case: Case, spins: bool) -> crate::common::acting::Touching {
    let one = |name: &str, points: &[V], cells: usize, radius: f64| -> Box<dyn Body> {
        if spins {
            Box::new(beam(name, points, cells, soft(), radius))
        } else {
            Box::new(cable(name, points, cells, radius))
        }
    };
    let (angle, form): (f64, Form) = match case {
        Case::Crossing => (1.1, Form::Point),
        Case::Blended => (0.4, Form::Blend(Blend::new(0.2, 0.6).unwrap())),
        Case::Along => (0.03, Form::Line),
        Case::Itself => (0.0, Form::Blend(Blend::default())),
        Case::HeadOn | Case::EndsCross => (0.0, Form::Point),
    };
    let bodies = if let Case::Itself = case {
        let turns = (0..=12).map(|k| k as f64 / 12.0 * 1.2 * std::f64::consts::TAU);
        let points: Vec<V> = turns.map(|t| V::new(t.cos(), t.sin(), 0.0475 * t)).collect();
        vec![one("loop", &points, 12, 0.15)]
    } else if let Case::HeadOn | Case::EndsCross = case {
        let a = [V::new(-2.0, 0.1, 0.0), V::new(-1.0, 0.02, 0.03), V::zeros()];
        let b = match case {
            Case::HeadOn => [V::new(0.288, 0.02, 0.01), V::new(1.2, 0.1, 0.0), V::new(2.0, 0.3, 0.1)],
            _ => [V::new(0.05, 0.06, 0.28), V::new(0.2, 1.0, 0.3), V::new(0.3, 2.0, 0.5)],
        };
        vec![one("a", &a, 3, 0.2), one("b", &b, 4, 0.1)]
    } else {
        let (c, s) = (angle.cos(), angle.sin());
        let turned = |x: f64, y: f64, z: f64| V::new(c * x - s * y, s * x + c * y, z);
        let a = [V::new(-2.0, 0.1, 0.0), V::new(0.0, 0.0, 0.03), V::new(2.0, -0.2, 0.01)];
        let b = [turned(-1.8, 0.1, 0.29), turned(0.1, -0.1, 0.31), turned(2.1, 0.2, 0.3)];
        vec![one("a", &a, 3, 0.2), one("b", &b, 4, 0.1)]
    };
    let last = bodies.len() - 1;
    let penalty = Enforcement::Penalty { wanted_penetration: None };
    let mut contact =
        CurveContact::new("touch", (0, bodies[0].as_ref()), (last, bodies[last].as_ref()), penalty).unwrap();
    contact.form = form;
    contact.stated = Some(Penalties { point: 1e3, line: 1e3 });
    contact.prepare(&bodies, 1.0);
    (bodies, contact)
}

#[test]
fn tangents_are_derivatives_in_all_regimes() {
    for case in [Case::Crossing, Case::Blended, Case::Along, Case::Itself, Case::HeadOn, Case::EndsCross] {
        for spins in [false, true] {
            for enforcement in [Enforcement::Penalty { wanted_penetration: None }, Enforcement::AugmentedLagrangian] {
                for (law, status) in laws() {
                    let rubs = law.is_some();
                    // Ends whose sections do not turn by themselves roll on each other.
                    let rolls = matches!(case, Case::HeadOn | Case::EndsCross) && !spins;
                    if rolls && rubs && status == Status::Slip {
                        continue;
                    }
                    let [coarse, fine] = taylor(touching(case, spins), (law, status), enforcement);
                    println!("{case:?}, spins {spins}, friction {rubs}, {status:?}: {coarse:.1e} {fine:.1e}");
                    assert!(fine < 1e-8 || (coarse / fine > 1.9 && coarse / fine < 2.1), "{coarse:e} {fine:e}");
                    assert!(fine < 2e-2);
                }
            }
        }
    }
}

#[test]
fn forces_with_friction_have_neither_resultant_nor_moment() {
    for case in [Case::Crossing, Case::Blended, Case::Along, Case::Itself, Case::HeadOn, Case::EndsCross] {
        for spins in [false, true] {
            for (law, _) in laws() {
                let (powers, size) = balance(touching(case, spins), law);
                assert!(size > 0.0);
                for power in powers {
                    assert!(power.abs() < 1e-12 * size, "{case:?} {spins}: {power:e} of {size:e}");
                }
            }
        }
    }
}

#[test]
fn slip_is_limited_and_what_touched_follows() {
    // A step along the slave and one back: friction turns round, and what has slipped adds up.
    let (bodies, mut contact) = touching(Case::Crossing, false);
    contact.law.friction = Some(Box::new(Coulomb::isotropic(0.3).unwrap()));
    let all: Vec<&dyn Body> = bodies.iter().map(|b| b.as_ref()).collect();
    let first = first_unknowns(&all);
    let start: Vec<BodyState> = bodies.iter().map(|b| b.start()).collect();
    let own = InteractionUnknowns { multipliers: &[], first: 0, prediction: &[] };
    let at = |states: &[BodyState], x: f64| {
        let mut states = states.to_vec();
        states[0].configuration.chunks_mut(6).for_each(|c| c[0] += x);
        states
    };
    contact.accept(Bodies { bodies: &bodies, states: &start, first: &first }, own).unwrap();
    let mut slipped = 0.0;
    for (k, x) in [0.02, 0.04, 0.02, 0.0].into_iter().enumerate() {
        let states = at(&start, x);
        let here = Bodies { bodies: &bodies, states: &states, first: &first };
        let site = contact.results(here, own).unwrap().into_iter().find(|s| s.status != Status::Open).unwrap();
        assert_eq!(site.status, Status::Slip);
        assert!((site.friction.norm() - 0.3 * site.pressure).abs() < 1e-9 * site.pressure);
        // Against the motion.
        assert!(if k < 2 { site.friction[0] < 0.0 } else { site.friction[0] > 0.0 });
        assert!((site.slip > slipped) == (k < 2));
        slipped = site.slip;
        contact.accept(here, own).unwrap();
        // The same state again: nothing has slipped since, and the traction is where it was.
        let again = contact.results(here, own).unwrap().into_iter().find(|s| s.status != Status::Open).unwrap();
        assert!((again.friction - site.friction).norm() < 1e-3 * site.friction.norm(), "{again:?} {site:?}");
    }
    let history = contact.history();
    contact.restore(&history).unwrap();
    assert_eq!(contact.history(), history);
    assert!(contact.restore(&[vec![0.0; 5], vec![1.0, 1.0]]).is_err());
}
