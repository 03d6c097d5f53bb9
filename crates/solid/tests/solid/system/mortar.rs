//! Contact by mortar in a system: patch test, balance, objectivity.

use super::*;
use signorini_solid::Volumetric;

const NEO_HOOKE: StressLaw = StressLaw::NeoHooke(Volumetric::Quadratic);
const KINDS: [Enforcement; 2] = [Enforcement::Multiplier, Enforcement::Penalty { wanted_penetration: None }];

/// Two blocks pressed together by a dead pressure: the largest deviation from the homogeneous state of one block, relative to
/// its displacement.
fn patch<const D: usize>(meshes: [Mesh<D>; 2], degree: usize, law: StressLaw, mu: Option<f64>) -> f64 {
    let mut system = System::default();
    for (name, mesh) in ["lower", "upper"].into_iter().zip(meshes) {
        system.bodies.push(Box::new(solid(name, mesh, degree, ELASTIC, law.clone())));
    }
    let up = D - 1;
    let sides = ["left", "front"];
    for body in 0..2 {
        for (i, side) in sides.into_iter().enumerate().take(D - 1) {
            system.supports.push(hold(body, side, std::array::from_fn(|k| (k == i).then_some(0.0))));
        }
    }
    system.supports.push(hold(0, "bottom", std::array::from_fn(|k| (k == up).then_some(0.0))));
    system.supports.push(hold(1, "top", std::array::from_fn(|k| (k == up).then_some(-0.1))));
    touch(&mut system, [(1, "bottom"), (0, "top")], Test::Mortar(0), Enforcement::Multiplier, mu);
    let (state, results) = run(&mut system, &[1.0]);
    println!("{}", told(&results));
    // The displacement is linear: lateral stretch the same everywhere.
    let mut worst = 0.0f64;
    let mut lateral = None;
    for (body, state) in system.bodies.iter().zip(&state.bodies) {
        let fields = body.fields(state);
        for (x, u) in fields.points.iter().zip(&fields.displacement) {
            worst = worst.max((u[up] + 0.1 * x[up]).abs());
            if x[0] > 1e-3 {
                let stretch = u[0] / x[0];
                worst = worst.max((stretch - *lateral.get_or_insert(stretch)).abs());
            }
        }
    }
    worst / 0.1
}

#[test]
fn a_patch_passes_in_the_plane() {
    for degree in 1..=3 {
        for law in [StressLaw::LinearElastic, NEO_HOOKE] {
            for mu in [None, Some(0.4)] {
                for cells in [[3, 4], [5, 2]] {
                    let lower = rectangle([0.0, 0.0], [1.0, 0.5], [cells[0], 2], 1, |x| x);
                    let upper = rectangle([0.0, 0.5], [1.0, 1.0], [cells[1], 2], 1, |x| x);
                    let error = patch([lower, upper], degree, law.clone(), mu);
                    println!("degree {degree} {} {mu:?} {cells:?}: {error:.1e}", law.name());
                    assert!(error < 1e-10, "degree {degree} {} {mu:?} {cells:?}: {error:e}", law.name());
                }
            }
        }
    }
}

#[test]
fn a_patch_passes_in_space() {
    for (degree, law, mu, cells) in
        [(1, StressLaw::LinearElastic, None, [2, 3]), (1, NEO_HOOKE, Some(0.4), [3, 2]), (2, NEO_HOOKE, None, [1, 2])]
    {
        let block = |low: f64, high: f64, n: usize| cuboid([0.0, 0.0, low], [1.0, 1.0, high], [n, n, 1], |x| x);
        let error = patch([block(0.0, 0.5, cells[0]), block(0.5, 1.0, cells[1])], degree, law.clone(), mu);
        println!("degree {degree} {} {mu:?} {cells:?}: {error:.1e}", law.name());
        assert!(error < 1e-10, "degree {degree} {} {mu:?} {cells:?}: {error:e}", law.name());
    }
}

/// Two blocks with tractions between them in any state: resultant and moment of what acts, relative to the forces.
fn balance<const D: usize>(meshes: [Mesh<D>; 2]) -> f64 {
    let mut system = System::default();
    for (name, mesh) in ["upper", "lower"].into_iter().zip(meshes) {
        system.bodies.push(Box::new(solid(name, mesh, 2, ELASTIC, StressLaw::LinearElastic)));
    }
    touch(&mut system, [(0, "bottom"), (1, "top")], Test::Mortar(0), Enforcement::Multiplier, Some(0.3));
    system.prepare().unwrap();
    let start = system.start();
    let counts: Vec<usize> = system.bodies.iter().map(|b| b.unknowns()).collect();
    let count: usize = counts.iter().sum();
    let seed = &mut 7u64;
    let mut step: Vec<f64> = (0..count + start.multipliers.len()).map(|_| 0.02 * noise(seed)).collect();
    let mut residual = |traction: f64| {
        step[count..].iter_mut().for_each(|t| *t = traction);
        system.linearise(&system.advance(&start, &step, 1.0), 0.0).unwrap().0
    };
    let (with, without) = (residual(1.0), residual(0.0));
    let state = system.advance(&start, &step, 1.0);
    let forces: Vec<f64> = with.iter().zip(&without).take(count).map(|(a, b)| a - b).collect();
    let size = forces.iter().map(|f| f.abs()).sum::<f64>();
    let mut totals = [0.0; 6];
    let mut first = 0;
    for ((body, state), n) in system.bodies.iter().zip(&state.bodies).zip(counts) {
        for (total, mode) in totals.iter_mut().zip(body.rigid_modes(state)) {
            *total += mode.iter().zip(&forces[first..first + n]).map(|(m, f)| m * f).sum::<f64>();
        }
        first += n;
    }
    totals.iter().fold(0.0f64, |m, t| m.max(t.abs())) / size
}

#[test]
fn forces_and_moments_balance() {
    let upper = rectangle([0.1, 0.1], [0.9, 0.5], [3, 1], 2, |x| x);
    let lower = rectangle([0.0, -0.5], [1.0, 0.0], [4, 1], 2, |x| x);
    let plane = balance([upper, lower]);
    let upper = cuboid([0.1, 0.1, 0.1], [0.9, 0.8, 0.5], [2, 1, 1], |x| x);
    let lower = cuboid([0.0, 0.0, -0.5], [1.0, 1.0, 0.0], [1, 2, 1], |x| x);
    let space = balance([upper, lower]);
    println!("{plane:e} {space:e}");
    assert!(plane < 1e-14 && space < 1e-14, "{plane:e} {space:e}");
}

#[test]
fn what_sticks_turns_without_slip() {
    for kind in KINDS {
        let mut system = System::default();
        let lower = rectangle([0.0, 0.0], [1.0, 0.5], [4, 2], 1, |x| x);
        let upper = rectangle([0.0, 0.5], [1.0, 1.0], [3, 2], 1, |x| x);
        system.bodies.push(Box::new(solid("lower", lower, 2, ELASTIC, NEO_HOOKE)));
        system.bodies.push(Box::new(solid("upper", upper, 2, ELASTIC, NEO_HOOKE)));
        // Pressed at time 1 and sheared, at time 2 both ends are turned by 0.7.
        let held = |body: usize, group: &str, press: [f64; 2]| {
            let mut out = hold(body, group, [None; 3]);
            for i in 0..2 {
                out.displacement[i] = Some(Arc::new(move |x: &Point<3>, t: f64| {
                    let moved = x + v(press[0], press[1], 0.0) * t.min(1.0);
                    let (s, c) = (0.7 * (t - 1.0).max(0.0)).sin_cos();
                    v(c * moved.x - s * moved.y, s * moved.x + c * moved.y, 0.0)[i] - x[i]
                }));
            }
            out
        };
        system.supports.push(held(0, "bottom", [0.0, 0.0]));
        system.supports.push(held(1, "top", [0.01, -0.05]));
        touch(&mut system, [(1, "bottom"), (0, "top")], Test::Mortar(0), kind, Some(0.8));
        let (_, results) = run(&mut system, &[1.0, 2.0]);
        let [before, after] = [0, 1].map(|k| &results[k].sites[0]);
        let slip = after.iter().map(|s| s.increment.norm()).fold(0.0f64, f64::max);
        println!("{kind:?} slip {slip:e}, {}", told(&results));
        assert!(before.iter().all(|s| s.status != signorini_contact::Status::Slip));
        assert!(slip < 1e-12, "{slip:e}");
        let [f, g] = [force(&results[0], 0), force(&results[1], 0)];
        let (s, c) = 0.7f64.sin_cos();
        let turned = v(c * f.x - s * f.y, s * f.x + c * f.y, 0.0);
        assert!((turned - g).norm() < 1e-8 * g.norm(), "{turned} {g}");
    }
}

/// Rings of quadratic cells between two radii: a block round the origin with its seam closed.
fn ring(radii: [f64; 2], across: usize, round: usize) -> Mesh<2> {
    let turn = std::f64::consts::TAU;
    let open = block::<2>(&[even(radii[0], radii[1], across), even(0.0, turn, round)], 2, |x| {
        Point::<2>::new(x[0] * x[1].cos(), x[0] * x[1].sin())
    });
    let mut nodes: Vec<Point<2>> = Vec::new();
    let mut number = |x: &Point<2>| {
        let found = nodes.iter().position(|y| (x - y).norm() < 1e-9);
        found.unwrap_or_else(|| {
            nodes.push(*x);
            nodes.len() - 1
        }) as u32
    };
    let of_cell = |cell: usize, number: &mut dyn FnMut(&Point<2>) -> u32| -> Vec<u32> {
        open.cell_nodes(cell).iter().map(|n| number(&open.nodes()[*n as usize])).collect()
    };
    let cells: Vec<Vec<u32>> = (0..open.cell_count()).map(|cell| of_cell(cell, &mut number)).collect();
    let mut out = Mesh::<2>::new(nodes);
    for (cell, list) in cells.iter().enumerate() {
        out.add_cell(open.shape(cell), 2, list);
    }
    let middle = 0.5 * (radii[0] + radii[1]);
    for side in out.boundary() {
        let inner = out.on_side(side, &[0.0; 3]).0.norm() < middle;
        out.group_mut(if inner { "inside" } else { "outside" }).sides.push(side);
    }
    out
}

/// Between rings from `a` to `b` and from `b` to `c`, held at `a` and `c`, of which one is too large for the other by `delta`.
fn pressure_of_lame([a, b, c]: [f64; 3], delta: f64) -> f64 {
    // u = A r + B/r with u = 0 at the far radius, under a unit pressure at b.
    let (e, nu) = (ELASTIC.youngs_modulus, ELASTIC.poissons_ratio);
    let (lame, shear) = (e * nu / (1.0 + nu) / (1.0 - 2.0 * nu), e / 2.0 / (1.0 + nu));
    let moved = |r: f64| {
        let slope = -1.0 / (2.0 * (lame + shear) + 2.0 * shear * r * r / (b * b));
        slope * b - slope * r * r / b
    };
    delta / (moved(c) - moved(a))
}

/// A shaft in a hub that is too small for it: held within and without, the bore turned.
#[test]
fn a_press_fit_slips_at_the_torque_of_its_pressure() {
    let ([a, b, c], delta, mu) = ([1.0, 2.0, 3.0], 0.002, 0.15);
    let mut system = System::default();
    system.bodies.push(Box::new(solid("shaft", ring([a, b + delta], 2, 36), 2, ELASTIC, NEO_HOOKE)));
    system.bodies.push(Box::new(solid("hub", ring([b, c], 2, 28), 2, ELASTIC, NEO_HOOKE)));
    let turned = |t: f64| -> f64 { 0.1 * [0.0, 0.0, 1.0, 2.0, 1.0][t as usize] };
    let mut bore = hold(0, "inside", [None; 3]);
    for i in 0..2 {
        bore.displacement[i] = Some(Arc::new(move |x: &Point<3>, t: f64| {
            let (s, c) = turned(t).sin_cos();
            [c * x.x - s * x.y, s * x.x + c * x.y][i] - x[i]
        }));
    }
    system.supports.push(bore);
    system.supports.push(hold(1, "outside", [Some(0.0), Some(0.0), None]));
    touch(&mut system, [(0, "outside"), (1, "inside")], Test::Mortar(0), Enforcement::Multiplier, Some(mu));
    let (_, results) = run(&mut system, &[1.0, 2.0, 3.0, 4.0]);
    println!("{}", told(&results));
    let pressure = pressure_of_lame([a, b, c], delta);
    let known = std::f64::consts::TAU * b * b * mu * pressure;
    let torque = |r: &IncrementResult| r.sites[0].iter().map(|s| s.x.cross(&s.force()).z).sum::<f64>();
    let found: Vec<f64> = results.iter().map(torque).collect();
    println!("{found:?} of {known}");
    let most = results[0].sites[0].iter().map(|s| s.pressure).fold(0.0f64, f64::max);
    println!("pressure up to {most} of {pressure}");
    assert!((most / pressure - 1.0).abs() < 0.03, "{most} {pressure}");
    assert!(found[0].abs() < 1e-3 * known);
    assert!((found[1] / known + 1.0).abs() < 0.01 && (found[2] / known + 1.0).abs() < 0.01, "{found:?} {known}");
    assert!((found[2] / found[1] - 1.0).abs() < 1e-3, "{found:?}");
    assert!((found[3] / found[2] + 1.0).abs() < 1e-3, "{found:?}");
    assert!(results.iter().all(|r| r.iterations <= 9 && is_quadratic(&r.history)), "{}", told(&results));
}

/// How much flatter than that of the reference the cylinder is.
const FLATTER: f64 = 0.01;

/// A steel cylinder on aluminium, pressed in four steps, against a reference with the gap across the block: as flat as here
/// the direction of the gap does not matter, and all forces are in proportion. A tenth of radians at the edge of the contact
/// as in the reference is nearly that of friction.
#[test]
fn unlike_bodies_rub_as_they_are_pressed() {
    let axis = |parts: [(f64, f64, usize, f64); 2]| {
        let mut out = vec![parts[0].0];
        parts
            .iter()
            .for_each(|(from, to, n, growth)| out.extend(signorini_fem::block::graded(*from, *to, *n, *growth)));
        out
    };
    let radius: f64 = 50.0;
    let cylinder = block::<2>(
        &[axis([(0.0, 8.0, 8, 1.0), (8.0, 38.0, 6, 1.4)]), axis([(0.0, 4.0, 4, 1.0), (4.0, 40.0, 6, 1.4)])],
        2,
        |x| {
            Point::<2>::new(
                x[0],
                x[1] + (1.0 - x[1] / 40.0) * FLATTER * (radius - (radius * radius - x[0] * x[0]).sqrt()),
            )
        },
    );
    let base = block::<2>(
        &[axis([(0.0, 9.0, 11, 1.0), (9.0, 100.0, 7, 1.5)]), axis([(-100.0, -5.0, 7, 1.0 / 1.5), (-5.0, 0.0, 6, 1.0)])],
        1,
        |x| x,
    );
    let stiff = |e: f64| Elastic { youngs_modulus: e, ..ELASTIC };
    let mut system = System::default();
    system.bodies.push(Box::new(solid("cylinder", cylinder, 2, stiff(210e3), StressLaw::LinearElastic)));
    system.bodies.push(Box::new(solid("block", base, 2, stiff(70e3), StressLaw::LinearElastic)));
    system.supports.push(hold(0, "top", [Some(0.0), Some(-1.2588612 * FLATTER), None]));
    system.supports.push(hold(0, "left", [Some(0.0), None, None]));
    system.supports.push(hold(1, "left", [Some(0.0), None, None]));
    system.supports.push(hold(1, "bottom", [Some(0.0), Some(0.0), None]));
    touch(&mut system, [(0, "bottom"), (1, "top")], Test::Mortar(0), Enforcement::Multiplier, Some(0.1));
    let (_, results) = run(&mut system, &[0.25, 0.5, 0.75, 1.0]);
    let last = &results[3];
    let most = |of: &dyn Fn(&SiteResult) -> f64| last.sites[0].iter().map(of).fold(0.0f64, f64::max) / FLATTER;
    let load = force(last, 0)[1] / FLATTER;
    let [pressure, friction] = [most(&|s| s.pressure), most(&|s| s.friction.norm())];
    println!("{load} {pressure} {friction}, {}", told(&results));
    assert!((load / 17500.0 - 1.0).abs() < 5e-3, "{load}");
    assert!((pressure / 3671.5 - 1.0).abs() < 0.01, "{pressure}");
    assert!((friction / 336.7 - 1.0).abs() < 0.03, "{friction}");
}

/// Digits of a computation that was saved and restored are those of one that went on.
#[test]
fn it_goes_on_as_it_was_saved() {
    let built = || {
        let mut system = System::default();
        system.bodies.push(Box::new(solid(
            "lower",
            rectangle([0.0, 0.0], [2.0, 0.5], [8, 2], 1, |x| x),
            1,
            ELASTIC,
            NEO_HOOKE,
        )));
        system.bodies.push(Box::new(solid(
            "upper",
            rectangle([0.5, 0.5], [1.1, 0.9], [3, 2], 1, |x| x),
            1,
            ELASTIC,
            NEO_HOOKE,
        )));
        system.supports.push(hold(0, "bottom", [Some(0.0), Some(0.0), None]));
        system.supports.push(hold(1, "top", [Some(0.05), Some(-0.02), None]));
        touch(&mut system, [(1, "bottom"), (0, "top")], Test::Mortar(0), Enforcement::Multiplier, Some(0.4));
        system.prepare().unwrap();
        system
    };
    let mut system = built();
    let mut state = system.start();
    let mut saved = None;
    for time in [1.0, 2.0] {
        saved = Some(system.save(&state));
        state = system.solve(&state, time, &mut |_, _| true).unwrap().0;
        system.accept(&state).unwrap();
    }
    let mut other = built();
    let from = other.restore(saved.unwrap()).unwrap();
    assert_eq!(other.solve(&from, 2.0, &mut |_, _| true).unwrap().0, state);
}

/// Two blocks of unlike cells that slide over each other: everywhere on the ellipse, and slipping normal to it.
#[test]
fn orthotropic_slip_is_associated() {
    for on_master in [true, false] {
        let mut system = System::default();
        let lower = cuboid([-0.3, -0.3, -0.5], [1.3, 1.3, 0.0], [4, 3, 1], |x| x);
        let upper = cuboid([0.0, 0.0, 0.0], [1.0, 1.0, 0.5], [3, 2, 1], |x| x);
        system.bodies.push(Box::new(solid("lower", lower, 1, ELASTIC, NEO_HOOKE)));
        system.bodies.push(Box::new(solid("upper", upper, 1, ELASTIC, NEO_HOOKE)));
        system.supports.push(hold(0, "bottom", [Some(0.0); 3]));
        system.supports.push(hold(1, "top", [Some(0.05), Some(0.02), Some(-0.002)]));
        let (mu, along) = ([0.3, 0.5], v(0.8, 0.6, 0.0));
        let of = |body: usize, group: &str| (part(body, group), system.bodies[body].as_ref());
        let mut contact = Mortar::new("touch", of(1, "bottom"), of(0, "top"), Enforcement::Multiplier).unwrap();
        contact.law.friction = Some(Box::new(Coulomb::orthotropic(mu).unwrap()));
        contact.set_axis(if on_master { AxisChoice::OnMaster(along) } else { AxisChoice::OnSlave(along) });
        system.contacts.push(Box::new(contact));
        let (_, results) = run(&mut system, &[1.0]);
        let carrying: Vec<&SiteResult> = results[0].sites[0].iter().filter(|s| s.pressure > 0.0).collect();
        assert!(carrying.len() > 6, "{}", told(&results));
        for site in carrying {
            let first = (along - site.normal * site.normal.dot(&along)).normalize();
            let axes = [first, site.normal.cross(&first)];
            let [t, s] = [site.friction, site.increment].map(|x| axes.map(|e| e.dot(&x)));
            let used = (t[0] / mu[0]).hypot(t[1] / mu[1]) / site.pressure;
            assert!((used - 1.0).abs() < 1e-6, "{used}");
            let normal = [0, 1].map(|k| -t[k] / mu[k].powi(2));
            let sine = (normal[0] * s[1] - normal[1] * s[0]) / (normal[0].hypot(normal[1]) * s[0].hypot(s[1]));
            assert!(sine.abs() < 1e-6 && normal[0] * s[0] + normal[1] * s[1] > 0.0, "{sine:e}");
        }
    }
}

/// A ring shrunk on another one, then drawn along it: the pressure of Lamé, and the friction of all of it.
#[test]
fn rings_round_an_axis_slide_along_it() {
    let ([a, b, c], delta, mu) = ([1.0, 2.0, 3.0], 0.002, 0.15);
    let mut system = System::default();
    let round = |name: &str, radii: [f64; 2], length: [f64; 2], n: [usize; 2]| {
        let mesh = rectangle([radii[0], length[0]], [radii[1], length[1]], n, 1, |x| x);
        let groups = mesh.groups().clone();
        let law = (ELASTIC, StressLaw::LinearElastic);
        SolidBody::new(name, Arc::new(mesh), 2, law, Space::Axisymmetric, groups).unwrap()
    };
    system.bodies.push(Box::new(round("shaft", [a, b + delta], [0.0, 1.0], [4, 4])));
    system.bodies.push(Box::new(round("hub", [b, c], [0.0, 1.0], [4, 3])));
    // No strain along the axis at time 1.
    for body in [0, 1] {
        for group in ["bottom", "top"] {
            let drawn = if body == 0 { 0.05 } else { 0.0 };
            let mut held = hold(body, group, [None; 3]);
            held.displacement[1] = Some(Arc::new(move |_, t: f64| drawn * (t - 1.0)));
            system.supports.push(held);
        }
    }
    system.supports.push(hold(0, "left", [Some(0.0), None, None]));
    system.supports.push(hold(1, "right", [Some(0.0), None, None]));
    touch(&mut system, [(1, "left"), (0, "right")], Test::Mortar(0), Enforcement::Multiplier, Some(mu));
    let (_, results) = run(&mut system, &[1.0, 2.0]);
    for (k, way) in [(0, 0.0), (1, mu)] {
        for site in results[k].sites[0].iter().filter(|s| s.pressure > 0.0) {
            let (t, p) = (site.friction, site.pressure);
            assert!((t.norm() - way * p).abs() < 1e-6 * p && t.y > (0.99 * way - 1e-6) * p, "{t} {p}");
        }
    }
    let (weight, force) = results[0].sites[0].iter().fold((0.0, 0.0), |(w, f), s| (w + s.weight, f + s.force().x));
    let known = pressure_of_lame([a, b, c], delta);
    assert!((weight / (std::f64::consts::TAU * b) - 1.0).abs() < 2e-3, "{weight}");
    assert!((force / weight / known - 1.0).abs() < 5e-3, "{} {known}", force / weight);
    assert!(results.iter().all(|r| is_quadratic(&r.history)), "{}", told(&results));
}

/// Faces that are flat but for rounding: whether they are cut as one polygon or in facets must not matter more than the
/// tolerance of Newton's method, which went round just above it.
#[test]
fn quadratic_faces_that_stay_flat_converge() {
    let mut system = System::default();
    let pi = std::f64::consts::PI;
    let skewed = |x: Point<3>| Point::<3>::new(x[0] + 0.05 * (pi * x[0]).sin(), x[1] - 0.05 * (pi * x[1]).sin(), x[2]);
    let elastic = Elastic { youngs_modulus: 1000.0, poissons_ratio: 0.3 };
    for (name, low, high, cells) in
        [("lower", [0.0; 3], [1.0, 1.0, 0.5], [3, 3, 1]), ("upper", [0.0, 0.0, 0.5], [1.0; 3], [5, 5, 1])]
    {
        let mesh = cuboid(low, high, cells, |x| if name == "upper" { skewed(x) } else { x });
        system.bodies.push(Box::new(solid(name, mesh, 2, elastic, StressLaw::LinearElastic)));
    }
    system.supports.push(hold(0, "bottom", [None, None, Some(0.0)]));
    for body in 0..2 {
        system.supports.push(hold(body, "left", [Some(0.0), None, None]));
        system.supports.push(hold(body, "front", [None, Some(0.0), None]));
    }
    system.loads.push(load(1, "top", TimedLoad::Pressure(Arc::new(|_, _| 10.0))));
    touch(&mut system, [(0, "top"), (1, "bottom")], Test::Mortar(0), Enforcement::Multiplier, None);
    system.prepare().unwrap();
    let mut iterations = 0;
    let found = system.solve(&system.start(), 1.0, &mut |_, _| {
        iterations += 1;
        iterations < 12
    });
    assert!(found.is_ok(), "{:?}", found.err());
}
