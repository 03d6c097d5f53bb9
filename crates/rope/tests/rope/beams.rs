//! Beams against exact solutions and published results.

use crate::common::{Found, Options, Search, Surroundings, V, clamp, load_body, newton};
use signorini_geometry::Vector;
use signorini_mechanics::body::{Body, BodyState, Constraint, Contribution, Inertial, Kinematics, Load, Order};
use signorini_rope::beam::Beam;
use signorini_rope::cable::Cable;
use signorini_rope::cable::element::Carries;
use signorini_rope::centreline::{Closure, Continuity};
use signorini_rope::chain::body::ReferenceLength;
use signorini_rope::path::Path;
use signorini_rope::section::Stiffness;

enum Push {
    Force(V),
    Moment(V),
    FollowerMoment(V),
}

/// A cantilever loaded at its end.
struct Cantilever<'a> {
    beam: &'a Beam,
    push: Push,
}

impl Surroundings for Cantilever<'_> {
    fn hold(&self, states: &[BodyState]) -> Vec<(usize, Constraint)> {
        clamp(self.beam, "start", &states[0]).into_iter().map(|c| (0, c)).collect()
    }
    fn act(&self, states: &[BodyState], first: &[u32], order: Order, out: &mut Contribution) {
        let load = match self.push {
            Push::Force(f) => Load::Force(f),
            Push::Moment(m) => Load::Moment(m),
            Push::FollowerMoment(m) => Load::FollowerMoment(m),
        };
        load_body(self.beam, Some("end"), &load, &states[0], order, first[0], out);
    }
}

fn solve(beam: &Beam, start: &BodyState, push: Push, tolerance: f64) -> Found {
    let options = Options { most: 40, tolerance, search: Search::WholeSteps };
    newton(&[beam], std::slice::from_ref(start), &mut Cantilever { beam, push }, &options)
        .unwrap_or_else(|f| panic!("residuals {:?}", f.residuals))
}

fn tip(beam: &Beam, state: &BodyState) -> V {
    let n = beam.elements();
    beam.position(state, n)
}

fn straight(length: f64, cells: usize, stiffness: Stiffness) -> Beam {
    let path = Path::points(&[V::zeros(), V::new(length, 0.0, 0.0)], Closure::Open).unwrap();
    let path = path.sample(cells, Continuity::C1).unwrap();
    Beam::new("beam", &path, Some(V::y()), stiffness, 0.0).unwrap()
}

/// Bathe & Bolourchi (1979): an eighth of a circle, loaded across its plane.
fn bend(radius: f64, cells: usize, stiffness: Stiffness) -> Beam {
    let path = Path::circle(V::new(0.0, radius, 0.0), -V::y(), V::x(), radius, std::f64::consts::FRAC_PI_4).unwrap();
    Beam::new("bend", &path.sample(cells, Continuity::C1).unwrap(), Some(V::z()), stiffness, 0.0).unwrap()
}

fn square(width: f64, modulus: f64) -> Stiffness {
    let a = width * width;
    let i = a * a / 12.0;
    Stiffness { axial: modulus * a, shear: [0.5 * modulus * a; 2], torsion: modulus * i, bending: [modulus * i; 2] }
}

#[test]
fn bend_of_45_degrees() {
    let published = [(300.0, [22.33, 58.84, 40.08]), (450.0, [18.62, 52.32, 48.39]), (600.0, [15.79, 47.23, 53.37])];
    let reference = [[22.2448, 58.7791, 40.1919], [18.5082, 52.2386, 48.5029], [15.6848, 47.1504, 53.4748]];
    let beam = bend(100.0, 32, square(1.0, 1e7));
    let start = beam.start();
    let mut state = start.clone();
    for (k, (force, paper)) in published.into_iter().enumerate() {
        let found = solve(&beam, &state, Push::Force(V::new(0.0, 0.0, force)), 1e-6);
        state = found.states[0].clone();
        let x = tip(&beam, &state);
        // In the coordinates of the papers, the beam starts along the second axis.
        let x = [x[1], x[0], x[2]];
        println!("P = {force}: {x:?}, {} iterations, {:?}", found.iterations(), found.residuals.last());
        assert!((0..3).all(|i| (x[i] - reference[k][i]).abs() < 5e-4), "{x:?}");
        assert!((0..3).all(|i| (x[i] - paper[i]).abs() < 0.15));
    }
    // In one step, and back.
    let one = solve(&beam, &start, Push::Force(V::new(0.0, 0.0, 600.0)), 1e-6);
    println!("one step: {} iterations {:?}", one.iterations(), one.residuals);
    assert!((tip(&beam, &one.states[0]) - tip(&beam, &state)).norm() < 1e-9);
    assert!(one.iterations() <= 12);
    // Unloaded in two steps: in one, the stiffness of the loaded state throws the first iterate too far for whole steps.
    let half = solve(&beam, &one.states[0], Push::Force(V::new(0.0, 0.0, 300.0)), 1e-6);
    let back = solve(&beam, &half.states[0], Push::Force(V::zeros()), 1e-6);
    let error = (tip(&beam, &back.states[0]) - tip(&beam, &start)).norm();
    println!("unloaded: {error:e}, {} iterations", back.iterations());
    assert!(error < 1e-9);
}

#[test]
fn roll_up_to_a_circle() {
    let length = 10.0;
    let mut errors = Vec::new();
    for (cells, thickness) in [(4, 0.1), (8, 0.1), (16, 0.1), (16, 1e-3)] {
        let stiffness = square(thickness, 1e6 / thickness.powi(4));
        let beam = straight(length, cells, stiffness);
        let mut state = beam.start();
        let mut most = 0;
        for step in 1..=8 {
            let m = std::f64::consts::TAU * stiffness.bending[0] / length * step as f64 / 8.0;
            let found = solve(&beam, &state, Push::Moment(V::new(0.0, 0.0, m)), 1e-9 * stiffness.bending[0]);
            most = most.max(found.iterations());
            state = found.states[0].clone();
        }
        let error = tip(&beam, &state).norm() / length;
        println!("{cells} elements, thickness {thickness}: {error:.3e}, at most {most} iterations a step");
        errors.push(error);
    }
    assert!(errors[0] < 2e-3 && errors[1] < 1.3e-4 && errors[2] < 9e-6);
    assert!((errors[1] / errors[2]).log2() > 3.5);
    // As good where it is thin.
    assert!((errors[3] / errors[2] - 1.0).abs() < 0.05);
}

/// A moment that turns with the end gives a helix, if bending and torsion are equally stiff.
fn helix_errors(kappa: V, length: f64, steps: usize) -> Vec<f64> {
    let stiffness = Stiffness { axial: 1e4, shear: [1e4; 2], torsion: 1.0, bending: [1.0; 2] };
    [8, 16, 32]
        .map(|cells| {
            let beam = straight(length, cells, stiffness);
            let mut state = beam.start();
            for step in 1..=steps {
                let push = Push::FollowerMoment(kappa * (step as f64 / steps as f64));
                state = solve(&beam, &state, push, 1e-11).states[0].clone();
            }
            // r' = R e_1, R' = R [κ]×: about the axis of κ.
            let (k, e) = (kappa.norm(), kappa.normalize());
            let d = V::x();
            let across = d - e * e.dot(&d);
            let exact = e * (e.dot(&d) * length)
                + across * ((k * length).sin() / k)
                + e.cross(&d) * ((1.0 - (k * length).cos()) / k);
            (tip(&beam, &state) - exact).norm() / length
        })
        .to_vec()
}

#[test]
fn helix_by_a_moment() {
    let errors = helix_errors(Vector::<3>::new(1.2, 0.0, 1.6), 10.0, 16);
    println!("helix {errors:?}");
    assert!((errors[1] / errors[2]).log2() > 3.4 && errors[2] < 6e-5);
}

#[test]
fn slender_beams_are_as_easy_as_thick_ones() {
    let mut all = Vec::new();
    for slenderness in [8.0, 80.0, 800.0, 8000.0] {
        let length = 100.0 * std::f64::consts::FRAC_PI_4;
        let b = length / slenderness;
        // The same bending stiffness and the same load.
        let stiffness = square(b, 1e7 / b.powi(4));
        let force = V::new(0.0, 0.0, 600.0);
        let run = |cells: usize| {
            let beam = bend(100.0, cells, stiffness);
            let found = solve(&beam, &beam.start(), Push::Force(force), 1e-6);
            (tip(&beam, &found.states[0]), found.iterations())
        };
        let ((coarse, iterations), (fine, _)) = (run(8), run(48));
        let error = (coarse - fine).norm()
            / (fine - tip(&bend(100.0, 8, stiffness), &bend(100.0, 8, stiffness).start())).norm();
        println!("L/b = {slenderness}: error {error:.2e}, {iterations} iterations in one step");
        all.push((error, iterations));
    }
    assert!(all.iter().all(|a| a.0 < 1e-3));
    let (least, most) = (all.iter().map(|a| a.1).min().unwrap(), all.iter().map(|a| a.1).max().unwrap());
    assert!(most <= least + 2 && most <= 14);
}

#[test]
fn other_bends_rolls_and_helices() {
    // A bend of other radius, section and load against a mesh eight times as fine.
    let (e, w, h) = (1e7, 1.2, 0.8);
    let stiffness = Stiffness {
        axial: e * w * h,
        shear: [0.5 * e * w * h; 2],
        torsion: e * (w * h * (w * w + h * h) / 12.0) * 0.5,
        bending: [e * w * h.powi(3) / 12.0, e * h * w.powi(3) / 12.0],
    };
    let at = |cells: usize| {
        let beam = bend(80.0, cells, stiffness);
        let found = solve(&beam, &beam.start(), Push::Force(V::new(0.0, 0.0, 400.0)), 1e-6);
        (tip(&beam, &found.states[0]), found.iterations())
    };
    let (reference, _) = at(64);
    let errors: Vec<f64> = [4, 8, 16].map(|n| (at(n).0 - reference).norm()).to_vec();
    println!("R = 80: tip {reference:?}, errors {errors:?}, {} iterations", at(16).1);
    assert!((errors[0] / errors[2]).log2() / 2.0 > 3.4);
    // Two turns.
    let stiffness = square(0.1, 1e10);
    let (beam, mut m) = (straight(10.0, 32, stiffness), 0.0);
    let mut state = beam.start();
    for step in 1..=16 {
        m = 2.0 * std::f64::consts::TAU * stiffness.bending[0] / 10.0 * step as f64 / 16.0;
        state = solve(&beam, &state, Push::Moment(V::new(0.0, 0.0, m)), 1e-9 * stiffness.bending[0]).states[0].clone();
    }
    println!("two turns by {m}: tip/L {:.2e}", tip(&beam, &state).norm() / 10.0);
    assert!(tip(&beam, &state).norm() < 1e-3);
    let errors = helix_errors(V::new(-0.7, 0.5, 1.1), 14.0, 16);
    println!("helix {errors:?}");
    assert!((errors[1] / errors[2]).log2() > 3.4 && errors[2] < 2e-4);
}

/// Mattiasson (1981), elliptic integrals: deflection and shortening of an inextensible cantilever.
#[test]
fn elastica_with_and_without_shear() {
    for (alpha, w, u) in [(1.0, 0.30172, 0.05643), (10.0, 0.81061, 0.55500)] {
        let path = Path::points(&[V::zeros(), V::x()], Closure::Open).unwrap().sample(16, Continuity::C1).unwrap();
        let stiffness = Stiffness { axial: 1e7, shear: [1e7; 2], torsion: 1.0, bending: [1.0; 2] };
        let beam = Beam::new("beam", &path, None, stiffness, 0.0).unwrap();
        let cable =
            Cable::new("thread", &path, 1e7, 1.0, Carries::TensionAndCompression, ReferenceLength::Path, 0.0).unwrap();
        for (body, name) in [(&beam as &dyn Body, "shear"), (&cable, "torsion-free")] {
            struct Tip<'a>(&'a dyn Body, f64);
            impl Surroundings for Tip<'_> {
                fn hold(&self, states: &[BodyState]) -> Vec<(usize, Constraint)> {
                    clamp(self.0, "start", &states[0]).into_iter().map(|c| (0, c)).collect()
                }
                fn act(&self, states: &[BodyState], first: &[u32], order: Order, out: &mut Contribution) {
                    let load = Load::Force(V::new(0.0, 0.0, self.1));
                    load_body(self.0, Some("end"), &load, &states[0], order, first[0], out);
                }
            }
            let options = Options { most: 40, tolerance: 1e-8, search: Search::WholeSteps };
            let mut states = vec![body.start()];
            let mut iterations = 0;
            for step in 1..=4 {
                let found = newton(&[body], &states, &mut Tip(body, 0.25 * alpha * step as f64), &options)
                    .unwrap_or_else(|f| panic!("{name} {:?}", f.residuals));
                iterations += found.iterations();
                states = found.states;
            }
            let at = if name == "shear" { beam.position(&states[0], 16) } else { cable.position(&states[0], 16) };
            println!("{name} {alpha}: {:.5} {:.5}, {} iterations in four steps", at[2], 1.0 - at[0], iterations);
            assert!((at[2] - w).abs() < 2e-5 && (1.0 - at[0] - u).abs() < 2e-5);
        }
    }
}

/// Mass and moments of a beam: of motions as a rigid body, and of the rotation of its sections.
#[test]
fn a_beam_has_the_mass_of_its_sections() {
    let section = signorini_rope::section::Section::Rectangle { width: 0.2, height: 0.3 };
    let (density, length, area) = (5.0, 2.0, 0.06);
    let beam = straight(length, 3, section.stiffness(7.0, 0.3).unwrap()).with_mass(section.mass(density));
    let found = beam.mass(&[]).unwrap().unwrap();
    let modes = beam.rigid_modes(&beam.start());
    let product = |a: &[f64], b: &[f64]| {
        let mut momenta = vec![0.0; a.len()];
        found.add_product(a, 1.0, &mut momenta);
        momenta.iter().zip(b).map(|(p, v)| p * v).sum::<f64>()
    };
    let mass = density * area * length;
    assert!((product(&modes[1], &modes[1]) - mass).abs() < 1e-13);
    // Turning about y and z through the start.
    assert!((product(&modes[4], &modes[4]) - mass * length * length / 3.0).abs() < 1e-13);
    assert!((product(&modes[1], &modes[5]) - mass * length / 2.0).abs() < 1e-13);
    // Width along y and height along z: moments of the area b h (h², b²)/12 about them.
    let sum = found.spins.iter().map(|s| s.inertia).sum::<signorini_geometry::Matrix<3>>();
    let wanted = [0.04 + 0.09, 0.09, 0.04].map(|square| mass * square / 12.0);
    for (k, wanted) in wanted.into_iter().enumerate() {
        assert!((sum[(k, k)] - wanted).abs() < 1e-14, "{sum}");
    }
}

/// Sections of a bent beam that turns as a rigid body turn with it.
#[test]
fn sections_follow_their_line() {
    let stiffness = square(0.1, 1e3);
    for beam in [straight(2.0, 3, stiffness), bend(1.5, 4, stiffness)] {
        let turns = V::new(0.3, -0.7, 1.1);
        let modes = beam.rigid_modes(&beam.start());
        let wanted: Vec<f64> = (0..beam.unknowns()).map(|k| (0..3).map(|i| turns[i] * modes[3 + i][k]).sum()).collect();
        let mut found = wanted.clone();
        beam.spins().iter().flatten().for_each(|u| found[*u as usize] = 0.0);
        beam.turn_sections(&mut found, &|_| turns);
        for (a, b) in found.iter().zip(&wanted) {
            assert!((a - b).abs() < 1e-13, "{a} {b}");
        }
    }
}
