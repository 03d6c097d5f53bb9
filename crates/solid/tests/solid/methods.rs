//! Contact in the mean, at nodes and at quadrature points; kept exactly, by augmented Lagrangians and by penalties.

use signorini_fem::block::block;
use signorini_geometry::Point;
use signorini_solid::*;

fn even(from: f64, to: f64, n: usize) -> Vec<f64> {
    (0..=n).map(|k| from + (to - from) * k as f64 / n as f64).collect()
}

/// Two blocks with a gap between a wavy and a skewed surface, side by side in part.
fn blocks<const D: usize>(degree: usize, method: Method, gap: f64) -> Model<D> {
    let up = D - 1;
    let mesh = |low: f64, high: f64, n: usize, wave: f64| {
        let axes: [Vec<f64>; D] = std::array::from_fn(|k| if k == up { even(low, high, 1) } else { even(0.0, 1.0, n) });
        block::<D>(&axes, 1, |mut x| {
            x[0] += 0.1 * wave * (3.0 * x[up]).sin() + wave;
            x[up] += wave * (2.0 * x[0] + x[D - 2]).sin();
            x
        })
    };
    let (lower, upper) = (mesh(0.0, 0.5, 3, 0.0), mesh(0.5 + gap, 1.0, 2, 0.08));
    let groups = [lower.groups().clone(), upper.groups().clone()];
    let mut bodies = Bodies::<D>::new(if D == 2 { Space::PlaneStrain } else { Space::Solid });
    let material = Elastic { youngs_modulus: 1.0, poissons_ratio: 0.3 };
    bodies.add("lower", lower, degree, material);
    bodies.add("upper", upper, degree, material);
    let fixed = |body: usize, group: &str| Support {
        name: group.into(),
        body,
        group: groups[body][group].clone(),
        kind: SupportKind::Components(vec![true; D]),
    };
    let supports = vec![fixed(0, "bottom"), fixed(1, "top")];
    let slave = bodies.surface(1, groups[1]["bottom"].sides.clone());
    let master = bodies.surface(0, groups[0]["top"].sides.clone());
    let mut contact = Contact::new("touch", slave, Master::Surface(master));
    contact.method = method;
    if method == Method::GaussPoint {
        contact.enforcement = Enforcement::Penalty { wanted_penetration: None };
    }
    Model::new(bodies, supports, vec![contact]).unwrap()
}

/// Unit pressures make forces without resultant and moment, at any gap: they do no work on rigid motions.
fn balance<const D: usize>() {
    for degree in [1, 2, 5] {
        for method in [Method::Mortar, Method::Node, Method::GaussPoint] {
            for gap in [0.0, 0.03, 0.15] {
                if D == 3 && degree == 5 {
                    continue;
                }
                let mut model = blocks::<D>(degree, method, gap);
                let now = Circumstances {
                    displacement: &|_, _| Point::<D>::zeros(),
                    load: vec![0.0; model.bodies.unknowns()],
                    rigid: vec![None],
                    motion: vec![],
                };
                model.solve(&now, &mut |_, _| true).unwrap();
                let mut modes: Vec<Box<dyn Fn(&Point<D>) -> Point<D>>> = Vec::new();
                for i in 0..D {
                    modes.push(Box::new(move |_| Point::<D>::from_fn(|k, _| f64::from(u8::from(k == i)))));
                    for j in 0..i {
                        modes.push(Box::new(move |x| {
                            let mut u = Point::<D>::zeros();
                            (u[i], u[j]) = (x[j], -x[i]);
                            u
                        }));
                    }
                }
                let rows = model.contacts[0].rows();
                assert!(!rows.is_empty());
                for mode in modes {
                    // On straight cells a rigid motion is carried by the vertices alone.
                    let mut u = vec![0.0; model.bodies.unknowns()];
                    for body in &model.bodies.list {
                        for (node, x) in body.mesh.nodes().iter().enumerate() {
                            let Some(f) = body.dofs.vertex(node as u32) else { continue };
                            let moved = mode(x);
                            for k in 0..D {
                                u[body.first + f as usize * D + k] = moved[k];
                            }
                        }
                    }
                    for row in rows {
                        let work: f64 = row.terms.iter().map(|(i, c)| c * u[*i as usize]).sum();
                        assert!(
                            work.abs() < 1e-12 * row.weight.abs().max(1e-3),
                            "{method:?}, degree {degree}, gap {gap}: {work:e}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn forces_balance_at_any_gap_in_the_plane() {
    balance::<2>();
}

#[test]
fn forces_balance_at_any_gap_in_space() {
    balance::<3>();
}

/// The weighted gaps are linear in the displacement of the slave, and the gap itself where nothing turns: the upper
/// block lowered as a whole.
#[test]
fn gaps_close_as_the_bodies_approach() {
    for method in [Method::Mortar, Method::Node] {
        let [far, near] = [0.10, 0.04].map(|gap| {
            let mut model = blocks::<2>(1, method, gap);
            let now = Circumstances {
                displacement: &|_, _| Point::<2>::zeros(),
                load: vec![0.0; model.bodies.unknowns()],
                rigid: vec![None],
                motion: vec![],
            };
            let state = model.solve(&now, &mut |_, _| true).unwrap();
            state.contacts[0].nodes.iter().map(|n| n.gap).fold(f64::INFINITY, f64::min)
        });
        assert!(near < far && (far - near - 0.06).abs() < 0.01, "{method:?}: {far} and {near}");
    }
}

/// A block pressed on a rigid sphere: all ways to keep the conditions agree as the penetration vanishes.
#[test]
fn enforcements_agree() {
    let solve_on = |n: usize, method: Method, enforcement: Enforcement| {
        let mesh = block::<2>(&[even(0.0, 1.0, 2 * n), even(0.0, 1.0, n)], 1, |x| x);
        let groups = mesh.groups().clone();
        let mut bodies = Bodies::<2>::new(Space::Axisymmetric);
        bodies.add("block", mesh, 2, Elastic { youngs_modulus: 10.0, poissons_ratio: 0.3 });
        let supports = vec![
            Support {
                name: "top".into(),
                body: 0,
                group: groups["top"].clone(),
                kind: SupportKind::Components(vec![false, true]),
            },
            Support { name: "axis".into(), body: 0, group: groups["left"].clone(), kind: SupportKind::Normal },
        ];
        let slave = bodies.surface(0, groups["bottom"].sides.clone());
        let mut contact = Contact::new("touch", slave, Master::Rigid);
        (contact.method, contact.enforcement) = (method, enforcement);
        let mut model = Model::new(bodies, supports, vec![contact]).unwrap();
        let centre = Point::<2>::new(0.0, -2.0);
        let now = Circumstances {
            displacement: &|s, _| Point::<2>::new(0.0, if s == 0 { -0.02 } else { 0.0 }),
            load: vec![0.0; model.bodies.unknowns()],
            rigid: vec![Some(Box::new(move |x: &Point<2>| signorini_contact::GapJet::ball(x, &centre, 2.0)))],
            motion: vec![],
        };
        let state = model.solve(&now, &mut |_, _| true).unwrap();
        let deepest = state.contacts[0].nodes.iter().map(|n| -n.gap).fold(0.0, f64::max);
        assert!(state.imbalance < 1e-10);
        (state.contacts[0].force[1], deepest)
    };
    let solve = |method, enforcement| solve_on(8, method, enforcement);
    let (exact, _) = solve(Method::Mortar, Enforcement::Multiplier);
    // Nitsche's method has the error of the discretisation.
    let (fine, _) = solve_on(32, Method::Mortar, Enforcement::Multiplier);
    for method in [Method::Mortar, Method::GaussPoint] {
        let errors = [8, 16].map(|n| (solve_on(n, method, Enforcement::Nitsche).0 / fine - 1.0).abs());
        assert!(errors[1] < 0.5 * errors[0] && errors[1] < 5e-3, "{method:?}: {errors:?}");
    }
    let (lagrangian, open) = solve(Method::Mortar, Enforcement::AugmentedLagrangian);
    assert!((lagrangian / exact - 1.0).abs() < 1e-8 && open < 1e-10);
    // At quadrature points there are more conditions than the surface can follow: held too tightly, by the grid size.
    let (lagrangian, _) = solve(Method::GaussPoint, Enforcement::AugmentedLagrangian);
    assert!((lagrangian / exact - 1.0).abs() < 0.02, "{lagrangian} {exact}");
    for method in [Method::Mortar, Method::Node, Method::GaussPoint] {
        let mut before = f64::INFINITY;
        for wanted in [1e-4, 1e-5, 1e-6] {
            let (force, deepest) = solve(method, Enforcement::Penalty { wanted_penetration: Some(wanted) });
            if method != Method::GaussPoint {
                assert!((deepest / wanted - 1.0).abs() < 0.03, "{method:?}: {deepest} for {wanted}");
            }
            let error = (force / exact - 1.0).abs();
            if method == Method::GaussPoint {
                // A stiff penalty at every quadrature point holds more than the functions can follow.
                assert!(error < 0.02);
                continue;
            }
            assert!(error < before || error < 3e-3, "{method:?}: {error:e} at {wanted}");
            before = error;
        }
        assert!(method == Method::GaussPoint || before < 5e-3, "{method:?}: {before:e}");
    }
}

/// The equations of Nitsche's method at the solution, integrated anew: `∫ σ(u):ε(v) - ∫ p (δg + δσ/c) + ∫ σ δσ/c = 0` with
/// `p = max(0, σ - c g)`, `σ = -n·σ n`, for any `v` that the supports allow.
#[test]
fn nitsches_equations_hold() {
    use signorini_fem::rules::rule;
    use signorini_solid::stiffness::displacement_at;
    let mesh = block::<2>(&[even(0.0, 1.0, 6), even(0.0, 1.0, 5)], 1, |x| {
        Point::<2>::new(x[0] + 0.05 * (3.0 * x[1]).sin(), x[1] + 0.02 * (5.0 * x[0]).sin())
    });
    let groups = mesh.groups().clone();
    let material = Elastic { youngs_modulus: 10.0, poissons_ratio: 0.3 };
    let mut bodies = Bodies::<2>::new(Space::PlaneStrain);
    bodies.add("block", mesh, 2, material);
    let kind = SupportKind::Components(vec![true, true]);
    let supports = vec![Support { name: "top".into(), body: 0, group: groups["top"].clone(), kind }];
    let slave = bodies.surface(0, groups["bottom"].sides.clone());
    let mut contact = Contact::new("touch", slave, Master::Rigid);
    contact.enforcement = Enforcement::Nitsche;
    let mut model = Model::new(bodies, supports, vec![contact]).unwrap();
    let centre = Point::<2>::new(0.5, -2.0);
    let ball = move |x: &Point<2>| signorini_contact::GapJet::ball(x, &centre, 2.0);
    let now = Circumstances {
        displacement: &|_, _| Point::<2>::new(0.0, -0.03),
        load: vec![0.0; model.bodies.unknowns()],
        rigid: vec![Some(Box::new(ball))],
        motion: vec![],
    };
    let state = model.solve(&now, &mut |_, _| true).unwrap();
    let body = &model.bodies.list[0];
    let held: std::collections::HashSet<u32> = (groups["top"].sides.iter())
        .flat_map(|s| {
            let list = body.dofs.functions(s.cell as usize);
            body.dofs.on_side(*s).into_iter().map(|k| list[k])
        })
        .collect();
    for seed in 1..4 {
        let v: Vec<f64> = (0..body.unknowns())
            .map(|i| if held.contains(&(i as u32 / 2)) { 0.0 } else { ((seed * i) as f64 * 0.731).sin() })
            .collect();
        let at = |cell: usize, xi: &signorini_fem::Local, u: &[f64]| {
            let (x, displacement, gradient) = displacement_at(&body.mesh, &body.dofs, Space::PlaneStrain, cell, xi, u);
            (x, displacement, gradient, material.stress(Space::PlaneStrain, &gradient))
        };
        let mut work = 0.0;
        let mut scale = 0.0;
        for cell in 0..body.mesh.cell_count() {
            let mut map = signorini_fem::hierarchic::Values::default();
            for (xi, w) in rule(body.mesh.shape(cell), 3) {
                body.mesh.map(cell).tabulate(&xi, &mut map);
                let (_, jacobian) = body.mesh.jacobian(cell, &map);
                let (stress, strain) = (at(cell, &xi, &state.u).3, at(cell, &xi, &v).2);
                let density = stress.component_mul(&strain).sum() * w * jacobian.determinant();
                work += density;
                scale += density.abs();
            }
        }
        let mut pressed = 0;
        for side in &groups["bottom"].sides {
            let cell = side.cell as usize;
            // Young's modulus over the depth of the cell along the normal, times the square of the degree.
            let (middle, [tangent, _]) = body.mesh.on_side(*side, &[0.0; 3]);
            let across = Point::<2>::new(tangent[1], -tangent[0]).normalize();
            let depth = (body.mesh.vertices(cell))
                .map(|n| across.dot(&(middle - body.mesh.nodes()[n as usize])))
                .fold(0.0, f64::max);
            let c = 4.0 * 10.0 / depth;
            for (s, w) in rule(signorini_fem::CellShape::Line, 4) {
                let (_, [tangent, _]) = body.mesh.on_side(*side, &s);
                let n = Point::<2>::new(tangent[1], -tangent[0]).normalize();
                let n = nalgebra::Vector3::new(n[0], n[1], 0.0);
                let (xi, _) = body.mesh.shape(cell).on_side(side.side as usize, &s);
                let (x, displacement, _, stress) = at(cell, &xi, &state.u);
                let (_, moved, _, change) = at(cell, &xi, &v);
                let found = ball(&x);
                let (sigma, delta_sigma) = (-n.dot(&(stress * n)), -n.dot(&(change * n)));
                let gap = found.gap + found.normal.dot(&displacement);
                let p = (sigma - c * gap).max(0.0);
                pressed += usize::from(p > 0.0);
                let delta_gap = found.normal.dot(&moved);
                work += w * tangent.norm() * (-p * (delta_gap + delta_sigma / c) + sigma * delta_sigma / c);
            }
        }
        assert!(pressed > 4);
        assert!(work.abs() < 1e-10 * scale, "{work:e} of {scale:e}");
    }
}
