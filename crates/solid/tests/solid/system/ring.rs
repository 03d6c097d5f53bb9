//! A ring pinched between rigid cylinders until its bore closes: large rotations, and a tangent that only the contact
//! makes definite.

use super::*;
use signorini_geometry::rigid_shape::{Cylinder, Plane};
use signorini_solid::Volumetric;

/// Travel of each tool, its force on the whole ring and the force in the bore, by dual mortar on 36 × 4 quadratic cells
/// in a quarter; on 24 × 3 cells they are within 1e-2.
const KNOWN: [[f64; 3]; 4] = [
    [0.3, 0.0027307025780938477, 0.0],
    [0.6, 0.004656550716478139, 0.0],
    [0.8, 0.005938653926812258, 0.0],
    [0.85, 0.06472379097834345, 0.05643119070175514],
];

/// Half of a ring, whose bore has contact with itself.
#[test]
fn the_bore_of_a_ring_closes_on_itself() {
    let mesh = block::<2>(&[even(0.8, 1.0, 3), even(-0.5, 0.5, 48)], 2, |x| {
        let angle = x[1] * std::f64::consts::PI;
        Point::<2>::new(x[0] * angle.cos(), x[0] * angle.sin())
    });
    let mut system = System::default();
    system.bodies.push(Box::new(solid("ring", mesh, 2, ELASTIC, StressLaw::NeoHooke(Volumetric::Quadratic))));
    for side in [1.0, -1.0] {
        let tool = Cylinder { point: v(0.0, 1.25 * side, 0.0), axis: v(0.0, 0.0, 1.0), radius: 0.25 };
        system.bodies.push(Box::new(rigid(tool, move |t| v(0.0, -t * side, 0.0))));
    }
    system.supports.push(hold(0, "bottom", [Some(0.0), None, None]));
    system.supports.push(hold(0, "top", [Some(0.0), None, None]));
    for tool in [1, 2] {
        touch(&mut system, [(0, "right"), (tool, "")], Test::Mortar(0), Enforcement::Multiplier, None);
    }
    touch(&mut system, [(0, "boundary"), (0, "boundary")], Test::Mortar(0), Enforcement::Multiplier, None);
    let (_, results) = run(&mut system, &[0.15, 0.3, 0.45, 0.6, 0.7, 0.8, 0.825, 0.85]);
    let last = results.last().unwrap();
    let [tool, bore] = [0, 2].map(|k| 2.0 * force(last, k)[1].abs());
    println!("{}: force {tool:.6e}, bore {bore:.6e}", told(&results));
    // Along the axis the force of the tools is 0.0623 there.
    let in_bore = KNOWN[3][2];
    assert!((tool - 0.0623149714).abs() < 5e-3 * tool && (bore - in_bore).abs() < 5e-3 * in_bore);
    assert!(results.iter().all(|r| r.iterations <= 10));
}

fn pinched(to: f64, step: f64, test: Test) -> Vec<(f64, IncrementResult)> {
    let mesh = block::<2>(&[even(0.8, 1.0, 3), even(0.0, std::f64::consts::FRAC_PI_2, 24)], 2, |x| {
        Point::<2>::new(x[0] * x[1].cos(), x[0] * x[1].sin())
    });
    let mut system = System::default();
    system.bodies.push(Box::new(solid("ring", mesh, 2, ELASTIC, StressLaw::NeoHooke(Volumetric::Quadratic))));
    let tool = Cylinder { point: v(0.0, 1.25, 0.0), axis: v(0.0, 0.0, 1.0), radius: 0.25 };
    system.bodies.push(Box::new(rigid(tool, |t| v(0.0, -t, 0.0))));
    let mirror = Plane { point: v(0.0, 0.0, 0.0), normal: v(0.0, 1.0, 0.0) };
    system.bodies.push(Box::new(rigid(mirror, |_| v(0.0, 0.0, 0.0))));
    system.supports.push(hold(0, "bottom", [None, Some(0.0), None]));
    system.supports.push(hold(0, "top", [Some(0.0), None, None]));
    touch(&mut system, [(0, "right"), (1, "")], test, Enforcement::Multiplier, None);
    touch(&mut system, [(0, "left"), (2, "")], test, Enforcement::Multiplier, None);
    let times: Vec<f64> = (1..=(to / step).round() as usize).map(|k| k as f64 * step).collect();
    let (_, results) = run(&mut system, &times);
    times.into_iter().zip(results).collect()
}

fn compare(to: f64, step: f64, test: Test) {
    for (travel, result) in pinched(to, step, test) {
        let (tool, bore) = (-2.0 * force(&result, 0)[1], 2.0 * force(&result, 1)[1]);
        println!("travel {travel:.3}: {} iterations, force {tool:.6e}, bore {bore:.6e}", result.iterations);
        for [known, whole, in_bore] in KNOWN {
            if (known - travel).abs() < 1e-9 {
                assert!((tool - whole).abs() < 1e-2 * whole, "{travel}: {tool} {whole}");
                assert!((bore - in_bore).abs() < 1e-2 * whole, "{travel}: {bore} {in_bore}");
            }
        }
    }
}

#[test]
fn a_ring_is_pinched() {
    compare(0.3, 0.05, Test::Sites(Sampling::Nodes));
}

#[test]
fn a_ring_is_pinched_with_a_mortar() {
    compare(0.3, 0.05, Test::Mortar(0));
}
