//! The compliance of the rows by columns and by products: the same states, and what large zones cost.

use signorini_contact::{Coulomb, GapJet, Law, Status, Tresca};
use signorini_fem::block::block;
use signorini_geometry::Point;
use signorini_solid::*;

const ELASTIC: Elastic = Elastic { youngs_modulus: 1000.0, poissons_ratio: 0.3 };

fn even(from: f64, to: f64, n: usize) -> Vec<f64> {
    (0..=n).map(|k| from + (to - from) * k as f64 / n as f64).collect()
}

/// Who holds the upper block.
#[derive(Clone, Copy, PartialEq)]
enum Held {
    /// Its top, which is moved.
    Top,
    /// Its top along the surface only; a traction presses it.
    Across,
    /// Nobody but friction.
    Free,
}

/// A block on another one, or on a rigid plane.
struct Blocks<const D: usize> {
    space: Space,
    degree: usize,
    /// Cells across and up.
    cells: [usize; 2],
    /// How much the lower side of the upper block is bent upwards, at its ends.
    bend: f64,
    rigid: bool,
    held: Held,
    law: Option<Box<dyn Law>>,
    method: Method,
    enforcement: Enforcement,
}

impl<const D: usize> Blocks<D> {
    fn new(space: Space, cells: [usize; 2], law: Option<Box<dyn Law>>) -> Self {
        let (method, enforcement) = (Method::Mortar, Enforcement::Multiplier);
        Blocks { space, degree: 1, cells, bend: 0.02, rigid: false, held: Held::Top, law, method, enforcement }
    }

    fn model(self) -> Model<D> {
        let up = D - 1;
        let [across, height] = self.cells;
        let symmetric = self.space == Space::Axisymmetric;
        let mesh = |low: f64, high: f64, n: usize, bend: f64| {
            let first = if symmetric { 0.0 } else { -1.0 };
            let axes: [Vec<f64>; D] =
                std::array::from_fn(|k| if k == up { even(low, high, height) } else { even(first, 1.0, n) });
            block::<D>(&axes, 1, move |mut x| {
                let r2: f64 = (0..up).map(|k| x[k] * x[k]).sum();
                x[up] += bend * r2 * (high - x[up]) / (high - low);
                x
            })
        };
        let mut bodies = Bodies::<D>::new(self.space);
        let mut supports = Vec::new();
        let upper = mesh(0.0, 1.0, across, self.bend);
        let mut hold = |body: usize, group: signorini_fem::Group, which: Vec<bool>| {
            let name = format!("{body} {}", supports.len());
            supports.push(Support { name, body, group, kind: SupportKind::Components(which) });
        };
        let along = |k: usize| (0..D).map(|i| i == k).collect::<Vec<bool>>();
        let groups = upper.groups().clone();
        bodies.add("upper", upper, self.degree, ELASTIC);
        match self.held {
            Held::Top => hold(0, groups["top"].clone(), vec![true; D]),
            Held::Across => hold(0, groups["top"].clone(), (0..D).map(|k| k != up).collect()),
            Held::Free => {}
        }
        if symmetric {
            hold(0, groups["left"].clone(), along(0));
        }
        let master = if self.rigid {
            Master::Rigid
        } else {
            // Unlike meshes.
            let lower = mesh(-0.8, 0.0, across + across / 3 + 1, 0.0);
            let groups = lower.groups().clone();
            bodies.add("lower", lower, self.degree, ELASTIC);
            hold(1, groups["bottom"].clone(), vec![true; D]);
            if symmetric {
                hold(1, groups["left"].clone(), along(0));
            }
            Master::Surface(bodies.surface(1, groups["top"].sides.clone()))
        };
        let slave = bodies.surface(0, groups["bottom"].sides.clone());
        let mut contact = Contact::new("interface", slave, master);
        (contact.method, contact.enforcement) = (self.method, self.enforcement);
        let axis = Point::<D>::from_fn(|k, _| [0.8, 0.6, 0.0][k]);
        contact.friction = self.law.map(|law| Friction { law, axis: Some(axis) });
        Model::new(bodies, supports, vec![contact]).unwrap()
    }
}

/// The states of two increments: pressed, and pushed aside.
fn states<const D: usize>(mut model: Model<D>, held: Held, route: Option<Route>) -> Vec<State<D>> {
    if let Some(route) = route {
        model.by_route(route);
    }
    let up = D - 1;
    let top = model.bodies.list[0].mesh.groups()["top"].clone();
    let mut out = Vec::new();
    for aside in [0.0, 1.0] {
        // A second increment without any motion would leave open whether nodes at their limit slip.
        let deeper = if model.bodies.space == Space::Axisymmetric { 0.002 * aside } else { 0.0 };
        let aside = if model.bodies.space == Space::Axisymmetric { 0.0 } else { aside };
        let moved = move |support: usize, _: &Point<D>| {
            let is_top = support == 0 && held == Held::Top;
            let shift = |k: usize| {
                if k == up {
                    -0.02 - deeper
                } else if k == 0 {
                    0.003 * aside
                } else {
                    0.001 * aside
                }
            };
            Point::<D>::from_fn(|k, _| if is_top { shift(k) } else { 0.0 })
        };
        let load = if held == Held::Top {
            vec![0.0; model.bodies.unknowns()]
        } else {
            let of = Load { name: "weight".into(), body: 0, group: top.clone(), kind: LoadKind::Traction };
            let push = if held == Held::Free { 0.5 * aside } else { 0.0 };
            loads::forces(&model.bodies, &of, &|_| {
                Point::<D>::from_fn(|k, _| {
                    if k == up {
                        -4.0
                    } else if k == 0 {
                        push
                    } else {
                        0.3 * push
                    }
                })
            })
        };
        let rigid: Option<RigidGap<D>> = matches!(model.contacts[0].master, Master::Rigid).then(|| {
            let normal = Point::<D>::from_fn(|k, _| f64::from(u8::from(k == up)));
            Box::new(move |x: &Point<D>| GapJet::flat(x[up], normal)) as RigidGap<D>
        });
        let now = Circumstances { displacement: &moved, load, rigid: vec![rigid], motion: vec![None] };
        out.push(model.solve(&now, &mut |_, _| true).unwrap());
    }
    out
}

/// Both routes come to the same states; returns whether nodes stick, slip and are open in the last one.
fn compared<const D: usize>(make: &dyn Fn() -> Blocks<D>) -> [bool; 3] {
    let held = make().held;
    let [columns, products] = [Route::Columns, Route::Products].map(|route| states(make().model(), held, Some(route)));
    let mut found = [false; 3];
    for (a, b) in columns.iter().zip(&products) {
        assert_eq!((a.route, b.route), (Route::Columns, Route::Products));
        let size = |v: &[f64]| v.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        let off = |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
        assert!(off(&a.u, &b.u) < 1e-10 * size(&a.u), "displacement {:e}", off(&a.u, &b.u) / size(&a.u));
        assert!(b.imbalance < 1e-10, "{:e}", b.imbalance);
        let (a, b) = (&a.contacts[0], &b.contacts[0]);
        let of = |c: &ContactResult<D>| c.nodes.iter().map(|n| n.multiplier).collect::<Vec<f64>>();
        let most = size(&of(a));
        assert!(most > 0.0 && off(&of(a), &of(b)) < 1e-10 * most, "pressure {:e}", off(&of(a), &of(b)) / most);
        for (a, b) in a.nodes.iter().zip(&b.nodes) {
            assert_eq!((a.active, a.rubbing.status), (b.active, b.rubbing.status), "at {:?}", a.x);
            assert!((a.rubbing.traction - b.rubbing.traction).norm() < 1e-10 * most);
        }
        if let (Some(a), Some(b)) = (&a.friction, &b.friction) {
            // By products it is the least of some nodes only.
            assert!(b.uniqueness >= a.uniqueness * (1.0 - 1e-9), "uniqueness {} {}", a.uniqueness, b.uniqueness);
        }
        found = [Status::Stick, Status::Slip, Status::Open].map(|s| a.nodes.iter().any(|n| n.rubbing.status == s));
        found[2] = a.nodes.iter().any(|n| !n.active);
    }
    found
}

fn coulomb(mu: f64) -> Option<Box<dyn Law>> {
    Some(Box::new(Coulomb::isotropic(mu).unwrap()))
}

#[test]
fn without_friction_in_plane_axisymmetric_and_space() {
    for degree in [1, 2] {
        let of = |space| move || Blocks::<2> { degree, ..Blocks::new(space, [18, 4], None) };
        assert!(compared(&of(Space::PlaneStrain))[2]);
        assert!(compared(&of(Space::Axisymmetric))[2]);
    }
    assert!(compared(&|| Blocks::<3>::new(Space::Solid, [7, 3], None))[2]);
    assert!(compared(&|| Blocks::<3> { rigid: true, ..Blocks::new(Space::Solid, [7, 3], None) })[2]);
}

#[test]
fn without_friction_by_other_enforcements_and_samplings() {
    let plane = || Blocks::<2>::new(Space::PlaneStrain, [18, 4], None);
    for enforcement in
        [Enforcement::Penalty { wanted_penetration: None }, Enforcement::AugmentedLagrangian, Enforcement::Nitsche]
    {
        compared(&|| Blocks { enforcement, ..plane() });
    }
    compared(&|| Blocks { method: Method::Node, ..plane() });
}

#[test]
fn bodies_that_contact_alone_holds() {
    let held = Held::Across;
    compared(&|| Blocks::<2> { held, ..Blocks::new(Space::PlaneStrain, [18, 4], None) });
    compared(&|| Blocks::<3> { held, ..Blocks::new(Space::Solid, [6, 3], None) });
    let flat = |cells| (Held::Free, 0.0, coulomb(0.4), cells);
    let (held, bend, ..) = flat(0);
    compared(&|| Blocks::<2> { held, bend, ..Blocks::new(Space::PlaneStrain, [12, 4], coulomb(0.4)) });
    compared(&|| Blocks::<3> { held, bend, ..Blocks::new(Space::Solid, [5, 2], coulomb(0.4)) });
}

#[test]
fn stick_and_slip_in_plane_axisymmetric_and_space() {
    assert_eq!(compared(&|| Blocks::<2>::new(Space::PlaneStrain, [18, 4], coulomb(0.3))), [true; 3]);
    compared(&|| Blocks::<2> { degree: 2, ..Blocks::new(Space::Axisymmetric, [12, 4], coulomb(0.1)) });
    assert_eq!(compared(&|| Blocks::<3>::new(Space::Solid, [7, 3], coulomb(0.3))), [true; 3]);
    let orthotropic = || Some(Box::new(Coulomb::orthotropic([0.4, 0.2]).unwrap()) as Box<dyn Law>);
    compared(&|| Blocks::<3> { rigid: true, ..Blocks::new(Space::Solid, [7, 3], orthotropic()) });
    let tresca = || Some(Box::new(Tresca::new(2.0).unwrap()) as Box<dyn Law>);
    compared(&|| Blocks::<2>::new(Space::PlaneStrain, [18, 4], tresca()));
    let enforcement = Enforcement::Penalty { wanted_penetration: None };
    compared(&|| Blocks::<2> { enforcement, ..Blocks::new(Space::PlaneStrain, [18, 4], coulomb(0.3)) });
}

/// What was saved of a block that friction alone holds goes on to the same digits, by both routes.
#[test]
fn a_block_on_an_incline_goes_on_to_the_same_digits() {
    for route in [Route::Columns, Route::Products] {
        let make = || {
            let law = Some(Box::new(Coulomb::orthotropic([0.3, 0.5]).unwrap()) as Box<dyn Law>);
            let held = Held::Free;
            let mut model =
                Blocks::<3> { held, bend: 0.0, rigid: true, ..Blocks::new(Space::Solid, [7, 4], law) }.model();
            model.by_route(route);
            model
        };
        let tilted = |model: &Model<3>, angle: f64| {
            let cells = model.bodies.list[0].mesh.groups()["top"].clone();
            let of = Load { name: "weight".into(), body: 0, group: cells, kind: LoadKind::Traction };
            let weight = Point::<3>::new(angle.sin() * 0.8, angle.sin() * 0.6, -angle.cos());
            let rigid: RigidGap<3> = Box::new(|x: &Point<3>| GapJet::flat(x[2], Point::<3>::z()));
            let load = loads::forces(&model.bodies, &of, &|_| weight);
            Circumstances {
                displacement: &|_, _| Point::<3>::zeros(),
                load,
                rigid: vec![Some(rigid)],
                motion: vec![None],
            }
        };
        let angles = [0.06, 0.12, 0.18, 0.24, 0.26];
        let mut model = make();
        let mut states = Vec::new();
        let mut saved = Vec::new();
        for angle in angles {
            let now = tilted(&model, angle);
            states.push(model.solve(&now, &mut |_, _| true).unwrap());
            saved.push(model.save());
        }
        for k in 1..angles.len() {
            let mut other = make();
            let first = tilted(&other, angles[0]);
            other.restore(saved[k - 1].clone(), &first).unwrap();
            let now = tilted(&other, angles[k]);
            assert_eq!(other.solve(&now, &mut |_, _| true).unwrap().u, states[k].u, "{route:?}, increment {k}");
            assert_eq!(other.save(), saved[k]);
        }
    }
}

/// Memory of the process, the most so far, in GiB; only where the system tells.
fn most_memory() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|l| l.split_whitespace().next()?.parse::<f64>().ok()).unwrap_or(0.0) / f64::from(1u32 << 20)
}

/// Processor time of the process in seconds; only where the system tells.
fn processor_time() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let after = stat.rsplit(')').next().unwrap_or_default();
    after.split_whitespace().skip(11).take(2).filter_map(|v| v.parse::<f64>().ok()).sum::<f64>() / 100.0
}

/// Two blocks with more than 10 000 pressure nodes in contact, without and with friction, beside a plain solve of the same
/// blocks. `SIGNORINI_ACROSS` and `SIGNORINI_HIGH` are other numbers of cells.
#[test]
#[ignore = "minutes"]
fn large_zones() {
    let number = |name: &str, other: usize| std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(other);
    let cells = [number("SIGNORINI_ACROSS", 100), number("SIGNORINI_HIGH", 4)];
    let timed = |name: &str, law: Option<Box<dyn Law>>, contact: bool| {
        let mut model = Blocks::<3> { bend: 0.0, ..Blocks::new(Space::Solid, cells, law) }.model();
        if !contact {
            model.contacts.clear();
        }
        println!("{name}: {} unknowns", model.unknowns());
        for aside in [0.0, 1.0] {
            let start = processor_time();
            let displacement = move |support: usize, _: &Point<3>| {
                if support == 0 { Point::<3>::new(0.003 * aside, 0.001 * aside, -0.02) } else { Point::<3>::zeros() }
            };
            let load = vec![0.0; model.bodies.unknowns()];
            let now = Circumstances { displacement: &displacement, load, rigid: vec![None], motion: vec![None] };
            let state = model.solve(&now, &mut |_, _| true).unwrap();
            let active: Vec<_> = state.contacts.iter().flat_map(|c| &c.nodes).filter(|n| n.active).collect();
            let slipping = active.iter().filter(|n| n.rubbing.status == Status::Slip).count();
            println!(
                "{name}: {:?}, {} of {} active nodes slip, {} iterations, {:.1} s, most memory {:.2} GiB, imbalance {:.0e}",
                state.route,
                slipping,
                active.len(),
                state.iterations,
                processor_time() - start,
                most_memory(),
                state.imbalance
            );
        }
    };
    timed("no contact", None, false);
    timed("no friction", None, true);
    timed("friction", coulomb(0.3), true);
}
