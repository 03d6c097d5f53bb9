//! A stiff flat punch on an elastic block: `p = P / (π √(a² - x²))` on a half plane (Sadowsky 1928).

use signorini_fem::block::{block, graded};
use signorini_solid::*;

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
    let groups = [below.groups().clone(), punch.groups().clone()];
    let mut bodies = Bodies::<2>::new(Space::PlaneStrain);
    bodies.add("block", below, 2, Elastic { youngs_modulus: 1000.0, poissons_ratio: 0.3 });
    bodies.add("punch", punch, 2, Elastic { youngs_modulus: 1e7, poissons_ratio: 0.3 });
    let support =
        |body: usize, group: &str, kind| Support { name: group.into(), body, group: groups[body][group].clone(), kind };
    let supports = vec![
        support(0, "bottom", SupportKind::Normal),
        support(0, "left", SupportKind::Normal),
        support(1, "left", SupportKind::Normal),
        support(1, "top", SupportKind::Uniform(vec![true, true])),
    ];
    let press = Load { name: "press".into(), body: 1, group: groups[1]["top"].clone(), kind: LoadKind::Force };
    let load = loads::forces(&bodies, &press, &|_| signorini_geometry::Point::<2>::new(0.0, -10.0));
    let slave = bodies.surface(1, groups[1]["bottom"].sides.clone());
    let master = bodies.surface(0, groups[0]["top"].sides.clone());
    let mut model = Model::new(bodies, supports, vec![Contact::new("touch", slave, Master::Surface(master))]).unwrap();
    assert_eq!(model.free_modes().len(), 1, "the punch falls until the block holds it");
    let now = Circumstances {
        displacement: &|_, _| signorini_geometry::Point::<2>::zeros(),
        load,
        rigid: vec![None],
        motion: vec![],
    };
    let state = model.solve(&now, &mut |_, _| true).unwrap();
    let contact = &state.contacts[0];
    assert!((contact.force[1] / 10.0 - 1.0).abs() < 1e-7);
    let exponent = |from: f64, to: f64| {
        let points: Vec<(f64, f64)> = (contact.nodes.iter())
            .filter(|n| n.x[0] >= from && n.x[0] <= to)
            .map(|n| ((1.0 - n.x[0] * n.x[0]).ln(), n.pressure.ln()))
            .collect();
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
    let middle = contact.nodes.iter().filter(|n| n.x[0] < 0.6);
    for node in middle {
        let exact = 20.0 / std::f64::consts::PI / (1.0 - node.x[0] * node.x[0]).sqrt();
        assert!((node.pressure / exact - 1.0).abs() < 0.02, "{} at {}", node.pressure, node.x[0]);
    }
}
