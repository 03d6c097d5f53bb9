use signorini_fem::block::{block, graded};
use signorini_geometry::Point;
use signorini_solid::*;

#[test]
fn c1() {
    for (degree, h) in
        [(1, 0.5), (1, 0.25), (1, 0.125), (2, 0.5), (2, 0.25), (2, 0.125), (4, 1.25), (4, 0.625), (6, 1.25)]
    {
        let start = std::time::Instant::now();
        let g = 1.2;
        let axis = |uniform: f64, to: f64| {
            let n = (uniform / h as f64).round() as usize;
            let mut a = vec![0.0];
            a.extend(graded(0.0, uniform, n, 1.0));
            let rest = to - uniform;
            let m = (1..200).find(|&m| h * g * ((g as f64).powi(m) - 1.0) / (g - 1.0) >= rest).unwrap() as usize;
            a.extend(graded(uniform, to, m, g));
            a
        };
        let x = axis(3.75, 20.0);
        let y = axis(1.25, 20.0);
        let mesh = block::<2>(&[x, y], degree, |p| {
            let b = 100.0 - (100.0f64 * 100.0 - p[0] * p[0]).sqrt();
            Point::<2>::new(p[0], b + (20.0 - b) * p[1] / 20.0)
        });
        mesh.check().unwrap();
        let groups = mesh.groups().clone();
        let mut bodies = Bodies::new(Space::PlaneStrain);
        bodies.add("block", mesh, degree, Elastic { youngs_modulus: 1000.0, poissons_ratio: 0.3 });
        let supports = vec![
            Support {
                name: "top".into(),
                body: 0,
                group: groups["top"].clone(),
                kind: SupportKind::Components(vec![true, true]),
            },
            Support { name: "sym".into(), body: 0, group: groups["left"].clone(), kind: SupportKind::Normal },
        ];
        let slave = bodies.surface(0, groups["bottom"].sides.clone());
        let contacts = vec![Contact::new("c", slave, Master::Rigid)];
        let mut model = Model::new(bodies, supports, contacts).unwrap();
        let built = start.elapsed();
        let n = model.bodies.unknowns();
        let now = Circumstances {
            displacement: &|s, _| if s == 0 { Point::<2>::new(0.0, -0.085) } else { Point::<2>::zeros() },
            load: vec![0.0; n],
            rigid: vec![Some(Box::new(|x: &Point<2>| (x[1], Point::<2>::new(0.0, 1.0))))],
        };
        let state = model.solve(&now, &mut |_, _| true).unwrap();
        let c = &state.contacts[0];
        // fit p^2 over r^2 for p > 0.3 max
        let pmax = c.nodes.iter().map(|n| n.pressure).fold(0.0, f64::max);
        let pts: Vec<(f64, f64)> = c
            .nodes
            .iter()
            .filter(|n| n.pressure > 0.3 * pmax)
            .map(|n| (n.x[0] * n.x[0], n.pressure * n.pressure))
            .collect();
        let k = pts.len() as f64;
        let (sx, sy) = (pts.iter().map(|p| p.0).sum::<f64>() / k, pts.iter().map(|p| p.1).sum::<f64>() / k);
        let b = pts.iter().map(|p| (p.0 - sx) * (p.1 - sy)).sum::<f64>()
            / pts.iter().map(|p| (p.0 - sx).powi(2)).sum::<f64>();
        let p0 = (sy - b * sx).sqrt();
        let a = p0 / (-b).sqrt();
        let (rf, ra, rp) = (52.13207231412229, 2.4445512631736683, 13.575381250701758);
        // The half model carries half the force.
        println!(
            "p={degree} h={h}: unknowns {} F {:.4} ({:+.4} %) a {:+.4} % p0 {:+.4} % its {} imbalance {:.1e} force {:?} top {:?} build {:?} total {:?}",
            state.unknowns,
            c.force[1],
            100.0 * (2.0 * c.force[1] / rf - 1.0),
            100.0 * (a / ra - 1.0),
            100.0 * (p0 / rp - 1.0),
            state.iterations,
            state.imbalance,
            c.force.as_slice(),
            state.support_forces[0].as_slice(),
            built,
            start.elapsed()
        );
    }
}
