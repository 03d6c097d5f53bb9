//! The mass of solids: of rigid motions by closed forms, and the same where surfaces that touch carry none.

use signorini_fem::block::block;
use signorini_geometry::Point;
use signorini_mechanics::{Body, Inertial, Mass};
use signorini_solid::{Elastic, SolidBody, Space, StressLaw};
use std::sync::Arc;

const DENSITY: f64 = 3.0;

/// A sheared block of volume 6: its map has the determinant one.
fn sheared(degree: usize) -> SolidBody<3> {
    let even = |to: f64, n: usize| (0..=n).map(|k| to * k as f64 / n as f64).collect::<Vec<f64>>();
    let axes = [even(1.0, 3), even(2.0, 4), even(3.0, 4)];
    let mesh = block(&axes, 1, |x| Point::<3>::new(x[0] + 0.2 * x[1], x[1] - 0.1 * x[2], x[2]));
    let groups = mesh.groups().clone();
    let law = (Elastic { youngs_modulus: 7.0, poissons_ratio: 0.3 }, StressLaw::LinearElastic);
    SolidBody::new("block", Arc::new(mesh), degree, law, Space::Solid, groups).unwrap().with_density(DENSITY)
}

fn product(mass: &Mass, a: &[f64], b: &[f64]) -> f64 {
    let mut momenta = vec![0.0; a.len()];
    mass.add_product(a, 1.0, &mut momenta);
    momenta.iter().zip(b).map(|(p, v)| p * v).sum()
}

#[test]
fn mass_and_moments_of_inertia_stay_where_surfaces_carry_none() {
    for degree in [1, 2] {
        let body = sheared(degree);
        let modes = body.rigid_modes(&body.start());
        let whole = body.mass(&[]).unwrap().unwrap();
        let moved = body.mass(&[Some("bottom"), Some("left")]).unwrap().unwrap();
        for (i, a) in modes.iter().enumerate() {
            for (j, b) in modes.iter().enumerate() {
                let [found, wanted] = [&moved, &whole].map(|m| product(m, a, b));
                assert!((found - wanted).abs() < 1e-10 * DENSITY * 6.0 * 9.0, "{degree} {i} {j}: {found} {wanted}");
            }
        }
        assert!((product(&whole, &modes[0], &modes[0]) - 6.0 * DENSITY).abs() < 1e-12);
        // The first moment about x of the unit motion along y: `∫ ρ z` of the block.
        let moment = product(&whole, &modes[1], &modes[3]);
        assert!((moment + 6.0 * DENSITY * 1.5).abs() < 1e-11, "{moment}");
        // What lies on the surface has no mass, and what lies inside has some.
        let diagonal = |mass: &Mass| {
            let mut out = vec![0.0; body.unknowns()];
            for (unknowns, values) in &mass.blocks {
                let own = values.iter().step_by(unknowns.len() + 1);
                unknowns.iter().zip(own).for_each(|(u, m)| out[*u as usize] += m);
            }
            out
        };
        let [whole, moved] = [&whole, &moved].map(diagonal);
        let held =
            signorini_mechanics::Hold { displacement: [Some(&|_: &Point<3>| 0.0), None, None], ..Default::default() };
        let on_surface = body.hold(Some("bottom"), &held, &body.start()).unwrap();
        assert!(!on_surface.is_empty() && whole.iter().all(|m| *m > 0.0));
        assert!(on_surface.iter().all(|c| moved[c.terms[0].0 as usize] == 0.0));
        assert!(moved.iter().any(|m| *m > 0.0));
    }
}
