//! A stiff flat punch on an elastic block: `p = P / (π √(a² - x²))` on a half plane (Sadowsky 1928).

use crate::system::{force, hold, load, part, run, solid};
use signorini_fem::block::{block, graded};
use signorini_geometry::Vector;
use signorini_mechanics::*;
use signorini_solid::{Elastic, StressLaw};
use std::sync::Arc;

fn stretches(from: f64, list: &[(f64, usize, f64)]) -> Vec<f64> {
    let mut out = vec![from];
    for &(to, cells, growth) in list {
        let start = out[out.len() - 1];
        out.extend(graded(start, to, cells, growth));
    }
    out
}

#[test]
fn the_edge_is_singular_like_an_inverse_root() {
    let below = block::<2>(
        &[
            stretches(0.0, &[(1.0, 20, 0.8), (2.0, 16, 1.25), (20.0, 14, 1.25)]),
            stretches(-20.0, &[(-1.0, 12, 0.8), (0.0, 16, 0.8)]),
        ],
        1,
        |x| x,
    );
    let punch = block::<2>(&[stretches(0.0, &[(1.0, 24, 0.8)]), stretches(0.0, &[(1.0, 8, 1.4)])], 1, |x| x);
    let mut system = System::default();
    for (name, mesh, youngs_modulus) in [("block", below, 1000.0), ("punch", punch, 1e7)] {
        let elastic = Elastic { youngs_modulus, poissons_ratio: 0.3 };
        system.bodies.push(Box::new(solid(name, mesh, 2, elastic, StressLaw::LinearElastic)));
    }
    let zero = Some(0.0);
    system.supports.extend([hold(0, "bottom", [None, zero, None]), hold(0, "left", [zero, None, None])]);
    system.supports.push(hold(1, "left", [zero, None, None]));
    let uniform = [true, true, false];
    system.supports.push(Support { name: "head".into(), part: part(1, "top"), uniform, ..Support::default() });
    system.loads.push(load(1, "top", TimedLoad::Force(Arc::new(|_, _| Vector::<3>::new(0.0, -10.0, 0.0)))));
    let of = |(body, group): (usize, &str)| (part(body, group), system.bodies[body].as_ref());
    let mut contact = Mortar::new("touch", of((1, "bottom")), of((0, "top")), Enforcement::Multiplier).unwrap();
    contact.slides_little();
    system.contacts.push(Box::new(contact));
    assert_eq!(
        system.free_motion(1).unwrap().as_deref(),
        Some("moving along y"),
        "the punch falls until the block holds it"
    );
    let (_, results) = run(&mut system, &[1.0]);
    let nodes: Vec<(f64, f64)> = results[0].sites[0].iter().map(|s| (s.x[0], s.shown_pressure())).collect();
    // Forces balance to 1e-10 of the largest within the punch, which is 10 000 times as stiff as the block.
    assert!((force(&results[0], 0)[1] / 10.0 - 1.0).abs() < 1e-6);
    let exponent = |from: f64, to: f64| {
        let points: Vec<(f64, f64)> =
            (nodes.iter()).filter(|n| n.0 >= from && n.0 <= to).map(|(x, p)| ((1.0 - x * x).ln(), p.ln())).collect();
        let count = points.len() as f64;
        let (mx, my) =
            (points.iter().map(|p| p.0).sum::<f64>() / count, points.iter().map(|p| p.1).sum::<f64>() / count);
        points.iter().map(|p| (p.0 - mx) * (p.1 - my)).sum::<f64>()
            / points.iter().map(|p| (p.0 - mx).powi(2)).sum::<f64>()
    };
    for (from, to) in [(0.3, 0.95), (0.6, 0.98), (0.8, 0.99)] {
        let found = exponent(from, to);
        assert!((found / -0.5 - 1.0).abs() < 0.05, "{from} to {to}: {found}");
    }
    // Away from the edge the pressure is that of the half plane but for the finite block.
    for (x, pressure) in nodes.iter().filter(|n| n.0 < 0.6) {
        let exact = 20.0 / std::f64::consts::PI / (1.0 - x * x).sqrt();
        assert!((pressure / exact - 1.0).abs() < 0.02, "{pressure} at {x}");
    }
}
