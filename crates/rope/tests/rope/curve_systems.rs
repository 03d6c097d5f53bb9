//! Curves that touch, in systems: problems with known solutions.

use crate::common::bodies::*;
use signorini_contact::{Coulomb, Status, Viscous};
use signorini_geometry::Vector;
use signorini_mechanics::body::Body;
use signorini_mechanics::{Enforcement, IncrementResult, Part, PlacedLoad, System, TimedLoad, Unstable};
use signorini_rope::curve_pair::CurveContact;
use signorini_rope::curve_pair::contact::{Form, Penalties};
use signorini_rope::section::Stiffness;

type V = Vector<3>;

/// Two beams of which the upper one is pushed down onto the lower one.
#[derive(Clone, Copy)]
struct Crossing {
    lengths: [f64; 2],
    bending: [f64; 2],
    /// Where they touch, along both.
    at: [f64; 2],
    push: f64,
    gap: f64,
    angle: f64,
    radius: f64,
    /// Elements of each, and points of each element.
    cells: [usize; 2],
    points: usize,
    increments: usize,
    enforcement: Enforcement,
    stated: Option<Penalties>,
    /// That of the angle, if none is given.
    form: Option<Form>,
}

impl Crossing {
    /// Force, deflection where it is pushed, most iterations of an increment.
    fn solve(&self) -> (f64, f64, usize) {
        let direction = V::new(self.angle.cos(), self.angle.sin(), 0.0);
        let below = V::new(self.at[0], 0.0, -self.gap - 2.0 * self.radius) - direction * self.at[1];
        let ends = [V::zeros(), V::x() * self.lengths[0]];
        let stiff = 1e6;
        let upper = beam("upper", &ends, self.cells[0], slender(self.bending[0], stiff), self.radius);
        let lower_ends = [below, below + direction * self.lengths[1]];
        let lower = beam("lower", &lower_ends, self.cells[1], slender(self.bending[1], stiff), self.radius);
        let all: Vec<Box<dyn Body>> =
            vec![Box::new(upper.with_contact_points(self.points)), Box::new(lower.with_contact_points(self.points))];
        let mut system = system(all, |contact| {
            contact.law.enforcement = self.enforcement;
            contact.stated = self.stated;
            contact.form = self.form.unwrap_or(contact.form);
        });
        system.supports = (0..2).map(|b| clamped(b, "start")).collect();
        system.loads.push(pulled(0, "end", V::new(0.0, 0.0, -self.push)));
        system.prepare().unwrap();
        let (mut state, mut result) = (system.start(), IncrementResult::default());
        let mut most = 0;
        for k in 1..=self.increments {
            let time = k as f64 / self.increments as f64;
            (state, result) = system
                .solve(&state, time, &mut |_, _| true)
                .unwrap_or_else(|error| panic!("{}°, increment {k}: {error:?}", self.angle.to_degrees()));
            system.accept(&state).unwrap();
            most = most.max(result.iterations);
        }
        let end = &state.bodies[0].configuration[10 * self.cells[0]..];
        (total(&result.sites[0]), -end[2], most)
    }
}

/// A rope taken across another by ten times their thickness in one increment: they do not pass through each other.
#[test]
fn ropes_that_are_moved_far_do_not_pass_through_each_other() {
    for down in [0.5, 2.0] {
        let ends = |x: V, z: f64| [x * -1.0 + V::z() * z, x + V::z() * z];
        let rod = slender(1.0, 50.0);
        let all: Vec<Box<dyn Body>> = vec![
            Box::new(beam("upper", &ends(V::x(), 0.2), 8, rod, 0.05)),
            Box::new(beam("lower", &ends(V::y(), 0.0), 8, rod, 0.05)),
        ];
        let mut system = system(all, |_| {});
        for group in ["start", "end"] {
            let displacement = [at_zero(), at_zero(), field(move |_: &V, t| -down * t)];
            system.supports.push(held(0, group, displacement, [None, None, None]));
            system.supports.push(held(1, group, [(); 3].map(|()| at_zero()), [None, None, None]));
        }
        // Bent far about each other they are unstable without friction, on finer cells too: here it is where they lie that counts.
        system.unstable = Unstable::Tell;
        system.prepare().unwrap();
        let start = system.start();
        let (state, result) = system.solve(&start, 1.0, &mut |_, _| true).unwrap();
        let told = result.stability.as_ref().map_or(0, |s| s.negative_eigenvalues);
        assert_eq!(told > 0, down > 1.0, "{told}");
        let middle = |b: usize| state.bodies[b].configuration[10 * 4 + 2];
        println!(
            "{down}: middles at {:.4} and {:.4}, force {:.4}, {} iterations",
            middle(0),
            middle(1),
            total(&result.sites[0]),
            result.iterations
        );
        assert!(middle(0) > middle(1) + 0.08 && total(&result.sites[0]) > 0.0);
    }
}

/// A rod that is pressed on another and drawn over it, along itself and across: friction by the velocity, and none at rest.
#[test]
fn viscous_friction_between_rods_follows_the_velocity() {
    let (mu, slow) = (0.4, 0.02);
    for (enforcement, way) in [
        (Enforcement::Penalty { wanted_penetration: None }, V::x()),
        (Enforcement::AugmentedLagrangian, V::new(0.6, 0.8, 0.0)),
    ] {
        let ends = |x: V, z: f64| [x * -1.0 + V::z() * z, x + V::z() * z];
        let rod = slender(5.0, 1e3);
        let all: Vec<Box<dyn Body>> = vec![
            Box::new(beam("upper", &ends(V::x(), 0.1), 4, rod, 0.05)),
            Box::new(beam("lower", &ends(V::y(), 0.0), 4, rod, 0.05)),
        ];
        let sides = [(0, all[0].as_ref()), (1, all[1].as_ref())];
        let mut contact = CurveContact::new("touch", sides[0], sides[1], enforcement).unwrap();
        contact.law.friction = Some(Box::new(Viscous::new(mu, slow).unwrap()));
        let mut system = System { bodies: all, contacts: vec![Box::new(contact)], ..System::default() };
        // Down in a unit of time, then along for one, then at rest for many.
        let at = move |t: f64| V::z() * (-0.01 * t.min(1.0)) + way * (slow * (t - 1.0).clamp(0.0, 1.0));
        for (body, group) in [(0, "start"), (0, "end"), (1, "start"), (1, "end")] {
            let still = move |t: f64| if body == 0 { at(t) } else { V::zeros() };
            let displacement = [0, 1, 2].map(|i| field(move |_: &V, t| still(t)[i]));
            system.supports.push(held(body, group, displacement, [(); 3].map(|()| at_zero())));
        }
        system.prepare().unwrap();
        let mut state = system.start();
        for time in [1.0, 1.2, 1.4, 1.6, 1.8, 2.0, 200.0, 20000.0] {
            let (found, result) = system.solve(&state, time, &mut |_, _| true).unwrap();
            system.accept(&found).unwrap();
            state = found;
            let site = result.sites[0].iter().find(|s| s.pressure > 0.0).unwrap();
            let rubbed = -site.friction.dot(&way) / site.pressure;
            println!("{enforcement:?}, t = {time}: {rubbed:.6} of the pressure, {} iterations", result.iterations);
            if time == 2.0 {
                // At the velocity of the law.
                assert!((rubbed / (mu / 2f64.sqrt()) - 1.0).abs() < 2e-2, "{rubbed}");
            } else if time == 20000.0 {
                assert!(rubbed.abs() < 1e-3 * mu, "{rubbed}");
            }
        }
    }
}

fn rows() -> serde_json::Value {
    serde_json::from_str(include_str!("../data/crossing_cantilevers.json")).unwrap()
}

/// Cantilevers of the reference, with small loads.
fn reference(small: f64) -> Crossing {
    Crossing {
        lengths: [10.0, 8.0],
        bending: [200.0, 150.0],
        at: [6.0, 5.0],
        push: small,
        gap: 0.2 * small,
        angle: 0.5 * std::f64::consts::PI,
        radius: 0.02,
        cells: [10, 8],
        points: 4,
        increments: 1,
        enforcement: Enforcement::Penalty { wanted_penetration: None },
        stated: Some(Penalties { point: 1e6, line: 1e6 }),
        form: None,
    }
}

#[test]
fn crossing_cantilevers_have_the_exact_force() {
    let small = 1e-3;
    let check = |case: Crossing, expected: f64, tip: f64, tolerance: f64| {
        let (f, w, iterations) = case.solve();
        let (f, w, angle) = (f / small, w / small, case.angle.to_degrees());
        println!("{angle:.1}°: F {f:.6} ({expected:.6}), tip {w:.6} ({tip:.6}), {iterations} iterations");
        assert!((f - expected).abs() < tolerance * expected.max(1.0) && (w - tip).abs() < tolerance * tip.max(1.0));
        assert!(iterations <= 12);
    };
    for row in rows()["crossing_cantilevers"]["rows"].as_array().unwrap() {
        let n = |key: &str| row[key].as_f64().unwrap();
        let case = Crossing {
            lengths: [n("L1"), n("L2")],
            bending: [n("EI1"), n("EI2")],
            at: [n("a1"), n("a2")],
            push: n("P_tip") * small,
            gap: n("g0") * small,
            angle: n("crossing_angle_deg").to_radians(),
            cells: [n("L1") as usize, n("L2") as usize],
            ..reference(small)
        };
        check(case, row["penalty_corrected"]["1000000.0"].as_f64().unwrap(), n("w1_tip"), 1e-4);
        // Without a penalty in the answer.
        let exact = Crossing { enforcement: Enforcement::AugmentedLagrangian, stated: None, ..case };
        check(exact, n("F_contact"), n("w1_tip"), 1e-4);
    }
    // Another one, by the formula.
    let (a_1, a_2, g, p) = (7.0f64, 4.0f64, 0.1, 1.7);
    let flexible = [a_1.powi(3) / 600.0, a_2.powi(3) / 450.0];
    let f = (p * a_1 * a_1 * (30.0 - a_1) / 1200.0 - g) / (flexible[0] + flexible[1] + 1e-6);
    let tip = p * 1000.0 / 600.0 - f * a_1 * a_1 * (30.0 - a_1) / 1200.0;
    let angle = 60f64.to_radians();
    check(Crossing { at: [a_1, a_2], push: p * small, gap: g * small, angle, ..reference(small) }, f, tip, 1e-4);
}

#[test]
fn ends_bear_parallel_cantilevers() {
    // A leaf spring on a shorter one: the exact reaction is a force at the end of the shorter.
    let small = 1e-3;
    let (l_1, l_2) = (10.0f64, 8.0f64);
    let expected = l_2 * l_2 * (3.0 * l_1 - l_2) / (6.0 * 200.0) / (l_2.powi(3) / 3.0 * (2.0 / 200.0) + 1e-6);
    let case = Crossing {
        bending: [200.0; 2],
        at: [8.0, 8.0],
        gap: 0.0,
        angle: 0.0,
        radius: 0.05,
        form: Some(Form::Point),
        ..reference(small)
    };
    let (f, tip, iterations) = case.solve();
    println!("parallel: F {:.6} ({expected:.6}), tip {:.5} (0.86), {iterations} iterations", f / small, tip / small);
    assert!((f / small - expected).abs() < 1e-4 && (tip / small - 0.86).abs() < 1e-4);
}

/// What the end of a rod is pressed on.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Under {
    /// The end of another one in line with it.
    End,
    /// One across.
    Side,
}

/// The end of a rod pressed along its axis on the end of another or on its side, in line or a little aside: in line both carry
/// what their compression asks; aside they stick where friction suffices and slide where not, in a few iterations.
#[test]
fn ends_press_on_ends_and_on_sides() {
    let (axial, push, radius) = (50.0, 0.02, 0.05);
    let rod = Stiffness { axial, shear: [20.0; 2], torsion: 1.0, bending: [1.0; 2] };
    for (under, aside, mu, status) in [
        (Under::End, 0.0, None, Status::Slip),
        (Under::End, 0.0, Some(0.3), Status::Stick),
        (Under::End, 0.01, Some(0.3), Status::Stick),
        (Under::End, 0.01, Some(0.05), Status::Slip),
        (Under::End, 0.03, Some(0.2), Status::Slip),
        (Under::Side, 0.01, Some(0.3), Status::Stick),
        (Under::Side, 0.01, Some(0.05), Status::Slip),
    ] {
        let right = [V::new(radius, aside, 0.0), V::new(1.0, aside, 0.0)];
        let left = match under {
            Under::End => [V::new(-1.0, 0.0, 0.0), V::new(-radius, 0.0, 0.0)],
            Under::Side => [V::new(-radius, 0.0, -0.5), V::new(-radius, 0.0, 0.5)],
        };
        let all: Vec<Box<dyn Body>> =
            vec![Box::new(beam("left", &left, 4, rod, radius)), Box::new(beam("right", &right, 4, rod, radius))];
        let mut system = system(all, |contact| {
            contact.law.enforcement = Enforcement::AugmentedLagrangian;
            contact.law.friction = mu.map(|mu| Box::new(Coulomb::isotropic(mu).unwrap()) as _);
        });
        system.supports.push(clamped(0, "start"));
        if under == Under::Side {
            system.supports.push(clamped(0, "end"));
        }
        let along = field(move |_: &V, t| -push * t);
        system.supports.push(held(1, "end", [along, at_zero(), at_zero()], [(); 3].map(|()| at_zero())));
        system.prepare().unwrap();
        let mut state = system.start();
        let mut told = Vec::new();
        for k in 1..=4 {
            let (next, result) = system.solve(&state, 0.25 * f64::from(k), &mut |_, _| true).unwrap();
            system.accept(&next).unwrap();
            state = next;
            let pressed: Vec<_> = result.sites[0].iter().filter(|s| s.pressure > 0.0).collect();
            assert_eq!(pressed.len(), 1);
            let rubbed = pressed[0].friction.norm() / pressed[0].pressure;
            told.push((result.iterations, total(&result.sites[0]), pressed[0].status, rubbed));
        }
        println!("{under:?}, aside {aside}, mu {mu:?}: {told:?}");
        let (_, force, last, rubbed) = told[3];
        // Where one end slips off the other it does so once, far.
        let (most, slips_off) = (if status == Status::Stick { 10 } else { 30 }, mu.is_none());
        let few = |(k, t): (usize, &(usize, f64, Status, f64))| t.0 <= most || (slips_off && k == 1 && t.0 <= 60);
        assert!(told.iter().enumerate().all(few) && last == status);
        if status == Status::Slip {
            assert!((rubbed - mu.unwrap_or(0.0)).abs() < 1e-9);
        }
        // Half of the push each over a length of 0.95.
        let expected = push / (2.0 * (1.0 - radius)) * axial;
        let length = 1.0 - radius;
        if slips_off {
            // The first step is below, the others are above what two cantilevers bear whose ends roll off each other.
            assert!((told[0].1 / (0.25 * expected) - 1.0).abs() < 1e-9, "{told:?}");
            let give_way = |p: f64| (p.sqrt() * length).tan() / p.sqrt() - length + p * length / rod.shear[0];
            let [mut low, mut critical] = [0.0, 1.0];
            for _ in 0..50 {
                let middle = 0.5 * (low + critical);
                if give_way(middle) < radius { low = middle } else { critical = middle }
            }
            assert!(told[1..].iter().all(|t| (t.1 / critical - 1.0).abs() < 5e-3), "{told:?} {critical}");
        } else if aside == 0.0 {
            assert!((force / expected - 1.0).abs() < 1e-9, "{force} {expected}");
        }
    }
}

#[test]
fn the_angle_goes_from_crossing_to_parallel_without_a_jump() {
    let case = Crossing { stated: None, ..reference(1e-3) };
    let at = |angle: f64, form: Option<Form>| {
        let (f, _, iterations) = Crossing { angle: angle.to_radians(), form, ..case }.solve();
        (f / case.push, iterations)
    };
    let mut before: Option<f64> = None;
    let (mut worst, mut most) = ((0.0f64, 0.0), 0);
    for half_degrees in (1..=180).rev() {
        let angle = 0.5 * f64::from(half_degrees);
        let (f, iterations) = at(angle, None);
        // Where slopes agree is ever farther from where axes cross: the last steps move it by more and more.
        let expected = if angle < 2.0 { at(angle, Some(Form::Point)).0 } else { before.unwrap_or(f) };
        let jump = (f / expected - 1.0).abs();
        if angle < 3.0 {
            println!("{angle}°: F {f:.6}, by points {:.6}, {iterations} iterations", at(angle, Some(Form::Point)).0);
        }
        worst = if jump > worst.0 { (jump, angle) } else { worst };
        most = if angle > 0.5 { most.max(iterations) } else { most };
        before = Some(f);
    }
    println!("largest jump {:.1e} at {}°, most {most} iterations", worst.0, worst.1);
    assert!(worst.0 < 5e-3 && most <= 8);
}

/// Two rods that lie on each other all along, the upper one under a force per length or at its end: exactly, and with a
/// penalty that is far stiffer than they are.
#[test]
fn rods_lie_flush_on_each_other() {
    let small = 1e-3;
    let solve = |enforcement: Enforcement, at_end: bool| {
        let ends = |z: f64, length: f64| [V::z() * z, V::x() * length + V::z() * z];
        let all: Vec<Box<dyn Body>> = vec![
            Box::new(beam("upper", &ends(0.1, 10.0), 10, slender(200.0, 1e6), 0.05)),
            Box::new(beam("lower", &ends(0.0, 8.0), 8, slender(200.0, 1e6), 0.05)),
        ];
        let sides = [(0, all[0].as_ref()), (1, all[1].as_ref())];
        let mut contact = CurveContact::new("touch", sides[0], sides[1], enforcement).unwrap();
        contact.form = Form::Line;
        let mut system = System { bodies: all, contacts: vec![Box::new(contact)], ..System::default() };
        system.supports = (0..2).map(|b| clamped(b, "start")).collect();
        if at_end {
            system.loads.push(pulled(0, "end", V::new(0.0, 0.0, -small)));
        } else {
            let weight = TimedLoad::BodyForce(std::sync::Arc::new(move |_, t| V::z() * (-0.1 * small * t)));
            system.loads.push(PlacedLoad { name: "w".into(), part: Part { body: 0, group: None }, load: weight });
        }
        system.prepare().unwrap();
        let start = system.start();
        let mut count = 0;
        let (state, result) = system
            .solve(&start, 1.0, &mut |_, _| {
                count += 1;
                count < 200
            })
            .unwrap();
        let deepest = result.sites[0].iter().filter_map(|s| s.gap).fold(0.0, f64::min);
        let end = -state.bodies[0].configuration[100 + 2] + 0.1;
        println!(
            "{enforcement:?}, at the end {at_end}: F {:.6}, end {:.6}, {count} iterations, {deepest:.1e}",
            total(&result.sites[0]) / small,
            end / small
        );
        (total(&result.sites[0]) / small, end / small)
    };
    for (at_end, force) in [(true, 0.6875), (false, 0.484)] {
        let (exact, end) = solve(Enforcement::AugmentedLagrangian, at_end);
        // At the end of the shorter rod it is the force of a leaf spring; under a force per length what bears the half of it.
        assert!((exact / force - 1.0).abs() < if at_end { 1e-4 } else { 2e-2 });
        let stiff = solve(Enforcement::Penalty { wanted_penetration: Some(1e-10) }, at_end);
        // Where both rods bend alike, what they carry at their ends is not determined as well as how they lie.
        assert!((stiff.0 / exact - 1.0).abs() < 5e-3 && (stiff.1 / end - 1.0).abs() < 1e-4);
    }
}
