//! Honest states pass; states that were spoilt on purpose are refused, by the check that should see it.

use signorini_audit::{
    Acting, Body, Boundary, Carries, Check, Contact, Curve, Form, Law, Placement, Rigid, Setting, Solid, Space,
    Stability, State, Surfaces, Touch, Verdict, audit, gaps,
};
use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::rigid_shape::{Block, Cylinder, Plane, RigidShape, Sphere};
use signorini_geometry::{Matrix, Point, Vector};
use std::f64::consts::PI;
use std::sync::Arc;

/// A setting with the states before and after an increment, and what is known of stability.
#[derive(Clone)]
struct Case {
    setting: Setting,
    before: State,
    now: State,
    stability: Stability,
}

impl Case {
    fn verdict(&self) -> (Verdict, Vec<Check>) {
        let findings = audit(&self.setting, Some(&self.before), &self.now, &self.stability);
        let refused = findings.iter().filter(|f| f.outcome == signorini_audit::Outcome::Refused);
        (Verdict::of(&findings), refused.map(|f| f.check).collect())
    }
}

const MU: f64 = 0.3;

fn v(x: f64, y: f64, z: f64) -> Vector<3> {
    Vector::<3>::new(x, y, z)
}

fn moved(x: f64, y: f64) -> Placement {
    Placement::Moved(RigidMotion::new(Vector::<3>::zeros(), Point::<3>::zeros(), v(x, y, 0.0)))
}

fn turned(angle: f64) -> Placement {
    Placement::Moved(RigidMotion::new(Vector::<3>::z() * angle, Point::<3>::zeros(), Vector::<3>::zeros()))
}

fn rigid(name: &str, shape: impl RigidShape + 'static, is_free: bool, size: f64) -> Body {
    let centre = shape.centre();
    let balls = if is_free { vec![(centre, 0.5 * size)] } else { Vec::new() };
    let gap = Arc::new(move |x: &Point<3>| shape.gap(x));
    Body {
        name: name.into(),
        form: Form::Rigid(Rigid { gap, surface: Vec::new(), balls, centre, is_free, size }),
        rounding: 0.0,
    }
}

fn floor() -> Body {
    rigid("floor", Plane { point: Point::<3>::zeros(), normal: v(0.0, 1.0, 0.0) }, false, 0.0)
}

fn contact(carries: Carries, law: Option<Law>) -> Contact {
    Contact {
        name: "touch".into(),
        bodies: [0, 1],
        law,
        is_small_sliding: false,
        carries,
        wanted_penetration: 0.0,
        at_places: true,
        surfaces: Surfaces::default(),
    }
}

fn acting(body: usize, force: Vector<3>, moment: Option<Vector<3>>, work: f64) -> Acting {
    Acting { name: "force".into(), body, force, moment, work: Some([work, 0.0]), drives: false, reacts: false }
}

/// A disc of radius 1 and weight 1 that leans on nothing but the floor.
fn disc() -> Case {
    let sphere = Sphere { center: v(0.0, 1.0, 0.0), radius: 1.0 };
    let setting = Setting {
        space: Space::Plane,
        bodies: vec![rigid("disc", sphere, true, 2.0), floor()],
        contacts: vec![contact(Carries::Force, Some(Law::PerPressure([MU; 2])))],
    };
    let touch =
        Touch { normal: v(0.0, 1.0, 0.0), weight: 1.0, area: 1.0, is_closed: true, pressure: 1.0, ..Touch::default() };
    let now = State {
        time: 2.0,
        bodies: vec![moved(0.0, 0.0), moved(0.0, 0.0)],
        contacts: vec![vec![touch]],
        forces: vec![acting(0, v(0.0, -1.0, 0.0), Some(Vector::<3>::zeros()), 0.0)],
        stored: Some(0.0),
        dissipated: vec![Some(0.0)],
        dissipated_in_bodies: 0.0,
        ..State::default()
    };
    Case { setting, before: State { time: 1.0, ..now.clone() }, now, stability: Stability::NotTested }
}

/// Cells of a block of 2 by 1.
fn block_body(cells: usize) -> Solid {
    let n = cells + 1;
    let rest: Vec<Point<3>> =
        (0..2 * n).map(|k| v(-1.0 + 2.0 * (k % n) as f64 / cells as f64, (k / n) as f64, 0.0)).collect();
    let cell = |i: usize| [i, i + 1, n + i + 1, n + i].map(|k| k as u32).to_vec();
    let list: Vec<Vec<u32>> = (0..cells).map(cell).collect();
    let boundary = Boundary::new(&rest, &list, false);
    Solid { rest, cells: list, boundary, parts: 1.0, is_cut: false, strain_limit: Some(0.05) }
}

/// A block that is pushed along the floor under its weight of 1, by 0.3 in the increment.
fn block() -> Case {
    let (cells, way) = (16, 0.3);
    let solid = block_body(cells);
    let at = |x: f64| Placement::Points(solid.rest.iter().map(|p| p + v(x, 0.0, 0.0)).collect());
    let touches = |x: f64, slip: f64| -> Vec<Touch> {
        let weight = |k: usize| 2.0 / cells as f64 * if k == 0 || k == cells { 0.5 } else { 1.0 };
        let place = |k: usize| solid.rest[k] + v(x, 0.0, 0.0);
        let touch = |k: usize| Touch {
            x: place(k),
            foot: place(k),
            normal: v(0.0, 1.0, 0.0),
            weight: weight(k),
            area: weight(k),
            is_closed: true,
            slips: true,
            pressure: 0.5,
            friction: v(-0.5 * MU, 0.0, 0.0),
            slip: v(slip, 0.0, 0.0),
            ..Touch::default()
        };
        (0..=cells).map(touch).collect()
    };
    let state = |x: f64, time: f64| State {
        time,
        bodies: vec![at(x), moved(0.0, 0.0)],
        contacts: vec![touches(x, way)],
        forces: vec![acting(0, v(0.0, -1.0, 0.0), None, 0.0), acting(0, v(MU, 0.0, 0.0), None, MU * way)],
        stored: Some(0.0),
        dissipated: vec![Some(MU * way)],
        dissipated_in_bodies: 0.0,
        ..State::default()
    };
    let (before, now) = (state(0.0, 1.0), state(way, 2.0));
    let body = Body { name: "block".into(), form: Form::Solid(solid.clone()), rounding: 0.0 };
    let setting = Setting {
        space: Space::Plane,
        bodies: vec![body, floor()],
        contacts: vec![contact(Carries::Traction, Some(Law::PerPressure([MU; 2])))],
    };
    Case { setting, before, now, stability: Stability::Stable }
}

/// A rope over half of a drum of radius 1, that slips by a hundredth: tensions of 1 and e^(μπ).
fn rope() -> Case {
    let (count, slip) = (800, 0.01);
    let angle = |k: usize| PI * k as f64 / count as f64;
    let place = |k: usize| v(angle(k).cos(), angle(k).sin(), 0.0);
    // The limit of Euler and Eytelwein, in steps that balance each by itself.
    let half = PI / count as f64 / 2.0;
    let ratio = (half.cos() + 0.0, half.sin());
    let mut tensions = vec![1.0];
    let mut touches = Vec::new();
    for k in 0..=count {
        let tangent = v(-angle(k).sin(), angle(k).cos(), 0.0);
        let weight = 2.0 * half * if k == 0 || k == count { 0.5 } else { 1.0 };
        let mut touch = Touch {
            x: place(k),
            foot: place(k),
            normal: place(k),
            weight,
            area: weight,
            is_closed: true,
            slips: true,
            slip: tangent * slip,
            ..Touch::default()
        };
        // Chords pull the inner points; at the ends the rope leaves along the tangent.
        let before = tensions[tensions.len() - 1];
        let (c, s) = ratio;
        let [ins, outs] = [if k == 0 { (1.0, 0.0) } else { (c, s) }, if k == count { (1.0, 0.0) } else { (c, s) }];
        let next = before * (ins.0 + MU * ins.1) / (outs.0 - MU * outs.1);
        let pressed = before * ins.1 + next * outs.1;
        touch.pressure = pressed / weight;
        touch.friction = -tangent * (MU * pressed / weight);
        touches.push(touch);
        tensions.push(next);
    }
    let last = tensions[tensions.len() - 1];
    let ends = [v(0.0, -1.0, 0.0), v(0.0, -last, 0.0)];
    let dissipated: f64 = touches.iter().map(|t| t.weight * t.friction.norm() * slip).sum();
    let curve = Curve {
        rest: (0..=count).map(place).collect(),
        pieces: (0..count as u32).map(|k| [k, k + 1]).collect(),
        parts: 1.0,
        radius: 0.0,
        strain_limit: Some(0.05),
        bends: true,
    };
    let now = State {
        time: 2.0,
        bodies: vec![Placement::Points(curve.rest.clone()), moved(0.0, 0.0)],
        contacts: vec![touches],
        forces: vec![
            acting(0, ends[0], Some(v(1.0, 0.0, 0.0).cross(&ends[0])), -slip),
            acting(0, ends[1], Some(v(-1.0, 0.0, 0.0).cross(&ends[1])), last * slip),
        ],
        stored: Some(0.0),
        dissipated: vec![Some(dissipated)],
        dissipated_in_bodies: 0.0,
        ..State::default()
    };
    let drum = Cylinder { point: Point::<3>::zeros(), axis: Vector::<3>::z(), radius: 1.0 };
    let setting = Setting {
        space: Space::ThreeD,
        bodies: vec![
            Body { name: "rope".into(), form: Form::Curve(curve), rounding: 0.0 },
            rigid("drum", drum, false, 2.0),
        ],
        contacts: vec![contact(Carries::LineLoad, Some(Law::PerPressure([MU; 2])))],
    };
    Case { setting, before: State { time: 1.0, ..now.clone() }, now, stability: Stability::NotTested }
}

/// A straight rope above another one, across it, that moves along it by a tenth and touches nothing.
fn crossing_ropes() -> Case {
    let line = |from: Vector<3>, to: Vector<3>| Curve {
        rest: (0..=4).map(|k| from + (to - from) * (k as f64 / 4.0)).collect(),
        pieces: (0..4).map(|k| [k, k + 1]).collect(),
        parts: 1.0,
        radius: 0.0,
        strain_limit: None,
        bends: false,
    };
    let [upper, lower] = [line(v(0.1, -1.0, 0.1), v(0.1, 1.0, 0.1)), line(v(-1.0, 0.0, 0.0), v(1.0, 0.0, 0.0))];
    let now = State {
        time: 2.0,
        bodies: [&upper, &lower].map(|curve| Placement::Points(curve.rest.clone())).into(),
        contacts: vec![Vec::new()],
        forces: Vec::new(),
        stored: Some(0.0),
        dissipated: vec![Some(0.0)],
        dissipated_in_bodies: 0.0,
        in_motion: false,
        way: Vec::new(),
    };
    let setting = Setting {
        space: Space::ThreeD,
        bodies: [("upper", upper), ("lower", lower)]
            .map(|(name, curve)| Body { name: name.into(), form: Form::Curve(curve), rounding: 0.0 })
            .into(),
        contacts: vec![contact(Carries::LineLoad, None)],
    };
    let mut case = Case { setting, before: State { time: 1.0, ..now.clone() }, now, stability: Stability::NotTested };
    shift(&mut case, |_| v(0.1, 0.0, 0.0));
    case
}

#[test]
fn a_rope_may_move_along_above_another_one() {
    assert_eq!(crossing_ropes().verdict().0, Verdict::RightWithin);
}

#[test]
fn honest_states_are_answers() {
    // All that acts on it passes by the origin, but for rounding.
    let mut below = disc();
    let down = v(1e-11, -2.0, 0.0);
    let sphere = Sphere { center: down + v(0.0, 1.0, 0.0), radius: 1.0 };
    below.setting.bodies = vec![
        rigid("disc", sphere, true, 2.0),
        rigid("floor", Plane { point: down, normal: v(0.0, 1.0, 0.0) }, false, 0.0),
    ];
    for state in [&mut below.before, &mut below.now] {
        state.contacts[0].iter_mut().for_each(|t| (t.x, t.foot) = (down, down));
    }
    for (name, case) in [("disc", disc()), ("below", below), ("block", block()), ("rope", rope())] {
        let findings = audit(&case.setting, Some(&case.before), &case.now, &case.stability);
        assert_eq!(Verdict::of(&findings), Verdict::RightWithin, "{name}: {findings:#?}");
        assert!(findings.len() >= 4, "{name}: {findings:#?}");
    }
}

#[test]
fn a_force_that_iterations_leave_of_none_breaks_no_law() {
    // A wall that carries next to nothing, and that beyond its friction.
    let mut beside = disc();
    let wall = Plane { point: v(1.0, 0.0, 0.0), normal: v(-1.0, 0.0, 0.0) };
    beside.setting.bodies.push(rigid("wall", wall, false, 0.0));
    beside.setting.contacts.push(Contact { name: "wall".into(), bodies: [0, 2], ..beside.setting.contacts[0].clone() });
    for state in [&mut beside.before, &mut beside.now] {
        state.bodies.push(moved(0.0, 0.0));
        let x = v(1.0, 1.0, 0.0);
        let rounding = Touch {
            x,
            foot: x,
            normal: v(-1.0, 0.0, 0.0),
            pressure: 1e-12,
            friction: v(0.0, 1e-10, 0.0),
            ..state.contacts[0][0]
        };
        state.contacts.push(vec![rounding]);
        state.dissipated.push(Some(0.0));
    }
    let findings = audit(&beside.setting, Some(&beside.before), &beside.now, &beside.stability);
    let outcome = |check| findings.iter().filter(|f| f.check == check).map(|f| f.outcome).max();
    assert_eq!(outcome(Check::Tractions), Some(signorini_audit::Outcome::Fine), "{findings:#?}");
    assert_eq!(outcome(Check::Balance), Some(signorini_audit::Outcome::Fine), "{findings:#?}");
}

/// A disc that rolled and slid to where it is: the slip of the whole increment tells nothing of the last one.
#[test]
fn friction_along_the_slip_of_a_body_that_moved_far_is_only_reported() {
    let outcome = |from: Placement| {
        let mut case = disc();
        case.before.bodies[0] = from;
        for touch in touches(&mut case) {
            (touch.slips, touch.slip, touch.friction) = (true, v(0.1, 0.0, 0.0), v(MU, 0.0, 0.0));
        }
        let findings = audit(&case.setting, Some(&case.before), &case.now, &case.stability);
        findings.iter().filter(|f| f.check == Check::Tractions).map(|f| f.outcome).max()
    };
    assert_eq!(outcome(moved(-0.1, 0.0)), Some(signorini_audit::Outcome::Doubt));
    assert_eq!(outcome(moved(-1e-3, 0.0)), Some(signorini_audit::Outcome::Refused));
}

#[test]
fn rounding_of_a_dissipation_is_no_energy() {
    let refused = |dissipated: f64| {
        let mut case = disc();
        case.now.contacts[0].clear();
        case.now.dissipated[0] = Some(dissipated);
        let findings = audit(&case.setting, Some(&case.before), &case.now, &case.stability);
        findings.iter().any(|f| f.message.contains("the dissipation of friction in"))
    };
    assert!(!refused(-1e-12) && refused(-1e-3));
}

/// A state spoilt on purpose: what, which check should see it, and how.
type Spoilt = (&'static str, Check, Case);

fn spoilt(what: &'static str, check: Check, mut case: Case, spoil: impl FnOnce(&mut Case)) -> Spoilt {
    spoil(&mut case);
    (what, check, case)
}

fn touches(case: &mut Case) -> impl Iterator<Item = &mut Touch> {
    case.now.contacts[0].iter_mut()
}

fn shift(case: &mut Case, by: impl Fn(&Point<3>) -> Vector<3>) {
    if let Placement::Points(points) = &mut case.now.bodies[0] {
        points.iter_mut().for_each(|x| *x += by(x));
    }
}

fn all_spoilt() -> Vec<Spoilt> {
    use Check::{Balance, Gaps, Path, Range, Stability as Stable, Tractions};
    let unstable = || Stability::Unstable { negative: 1, body: "disc".into() };
    vec![
        spoilt("the disc sinks", Gaps, disc(), |c| c.now.bodies[0] = moved(0.0, -0.2)),
        spoilt("the disc carries in the air", Gaps, disc(), |c| {
            c.now.bodies[0] = moved(0.0, 0.5);
            touches(c).for_each(|t| t.x.y += 0.5);
        }),
        spoilt("the disc went through a peg", Gaps, disc(), |c| {
            c.setting.bodies[1] = rigid("peg", Sphere { center: v(0.0, 1.0, 0.0), radius: 0.1 }, false, 0.2);
            (c.before.bodies[0], c.now.bodies[0]) = (moved(-3.0, 0.0), moved(3.0, 0.0));
            touches(c).for_each(|t| (t.is_closed, t.pressure) = (false, 0.0));
            c.now.forces.clear();
        }),
        spoilt("the floor pulls the disc", Tractions, disc(), |c| {
            touches(c).for_each(|t| t.pressure = -1.0);
            c.now.forces[0].force.y = 1.0;
        }),
        spoilt("friction on the disc beyond the cone", Tractions, disc(), |c| {
            touches(c).for_each(|t| t.friction.x = 0.5);
            c.now.forces[0].force.x = -0.5;
        }),
        spoilt("half of the weight of the disc is carried", Balance, disc(), |c| {
            touches(c).for_each(|t| t.pressure = 0.5)
        }),
        spoilt("nothing holds the disc aside", Balance, disc(), |c| c.now.forces[0].force.x = 0.01),
        spoilt("a moment on the disc is held by nothing", Balance, disc(), |c| {
            c.now.forces[0].moment = Some(v(0.0, 0.0, 0.1));
        }),
        spoilt("the disc carries beside its middle", Balance, disc(), |c| {
            touches(c).for_each(|t| (t.x.x, t.foot.x) = (0.05, 0.05));
        }),
        spoilt("forces on the disc are no numbers", Balance, disc(), |c| c.now.forces[0].force.y = f64::NAN),
        spoilt("the disc is on a summit", Stable, disc(), |c| c.stability = unstable()),
        spoilt("the block sinks", Gaps, block(), |c| shift(c, |_| v(0.0, -0.1, 0.0))),
        spoilt("a corner of the block sinks", Gaps, block(), |c| shift(c, |x| v(0.0, -0.06 * (1.0 + x.x), 0.0))),
        spoilt("the block carries in the air", Gaps, block(), |c| {
            shift(c, |_| v(0.0, 0.8, 0.0));
            touches(c).for_each(|t| t.x.y += 0.8);
        }),
        spoilt("the block reaches into the floor where nothing carries", Gaps, block(), |c| {
            shift(c, |_| v(0.0, -0.02, 0.0));
            c.now.contacts[0].clear();
            c.now.forces.clear();
        }),
        spoilt("friction on the block twice its limit", Tractions, block(), |c| {
            touches(c).for_each(|t| t.friction *= 2.0);
            c.now.forces[1].force *= 2.0;
        }),
        spoilt("friction pushes the block on", Tractions, block(), |c| {
            touches(c).for_each(|t| t.friction *= -1.0);
            c.now.forces[1].force *= -1.0;
        }),
        spoilt("half of the friction where the block slips", Tractions, block(), |c| {
            touches(c).for_each(|t| t.friction *= 0.5);
            c.now.forces[1].force *= 0.5;
        }),
        spoilt("a part of the floor pulls the block", Tractions, block(), |c| {
            touches(c).take(4).for_each(|t| t.pressure *= -1.0);
        }),
        spoilt("friction without a law", Tractions, block(), |c| c.setting.contacts[0].law = None),
        spoilt("the push on the block is not told", Balance, block(), |c| c.now.forces.truncate(1)),
        spoilt("the friction on the block gives energy", Path, block(), |c| c.now.dissipated = vec![Some(-MU * 0.3)]),
        spoilt("the block stores energy that nothing gives", Path, block(), |c| c.now.stored = Some(0.1)),
        spoilt("the block loses more energy than is given", Path, block(), |c| {
            c.now.dissipated = vec![Some(2.0 * MU * 0.3)]
        }),
        spoilt("the block is stretched far beyond the theory", Range, block(), |c| {
            shift(c, |x| v(0.5 * x.x, 0.0, 0.0))
        }),
        spoilt("the block slides far on a curved floor by small sliding", Range, block(), |c| {
            c.setting.contacts[0].is_small_sliding = true;
            let drum = Cylinder { point: v(0.0, -50.0, 0.0), axis: Vector::<3>::z(), radius: 50.0 };
            c.setting.bodies[1] = rigid("drum", drum, false, 100.0);
            shift(c, |_| v(1.0, 0.0, 0.0));
            touches(c).for_each(|t| t.x.x += 1.0);
        }),
        spoilt("the floor turns under small sliding", Range, block(), |c| {
            c.setting.contacts[0].is_small_sliding = true;
            c.now.bodies[1] = turned(0.2);
        }),
        spoilt("the block is on a branch that it leaves", Stable, block(), |c| c.stability = unstable()),
        spoilt("a rope goes down through another", Gaps, crossing_ropes(), |c| shift(c, |_| v(0.0, 0.0, -0.3))),
        spoilt("the rope lies in the drum", Gaps, rope(), |c| shift(c, |x| x * -0.05)),
        spoilt("friction of the rope along its slip", Tractions, rope(), |c| touches(c).for_each(|t| t.slip *= -1.0)),
        spoilt("the rope is pulled by more than friction holds", Tractions, rope(), |c| {
            touches(c).for_each(|t| t.friction *= 1.5);
        }),
        spoilt("the rope pulls less at its end", Balance, rope(), |c| c.now.forces[1].force *= 0.98),
        spoilt("the rope gives more than its ends", Path, rope(), |c| c.now.forces[1].work = Some([0.0, 0.0])),
    ]
}

#[test]
fn spoilt_states_are_refused_by_the_check_that_sees_it() {
    let list = all_spoilt();
    assert!(list.len() >= 30);
    let missed: Vec<_> = (list.iter())
        .map(|(what, check, case)| (what, check, case.verdict()))
        .filter(|(_, check, (verdict, refused))| *verdict != Verdict::NotAnAnswer || !refused.contains(check))
        .collect();
    assert!(missed.is_empty(), "{missed:#?}");
    for check in [Check::Gaps, Check::Tractions, Check::Balance, Check::Path, Check::Range, Check::Stability] {
        assert!(list.iter().filter(|(_, c, _)| *c == check).count() >= 2, "{check:?}");
    }
}

#[test]
fn what_starts_deep_inside_is_refused_at_once() {
    let case = block();
    let start = |depth: f64| {
        let mut case = case.clone();
        shift(&mut case, |_| v(0.0, -depth, 0.0));
        Verdict::of(&gaps::check_start(&case.setting, &case.now))
    };
    assert_eq!(start(0.9), Verdict::NotAnAnswer);
    // A little may be meant: a fit that is pressed.
    assert_eq!(start(0.01), Verdict::RightWithin);
}

#[test]
fn forces_that_statics_does_not_tell_and_zones_of_a_cell_are_in_doubt() {
    // A disc in a groove of two walls that stick: four components of force for three equations.
    let mut groove = disc();
    let wall = |s: f64| Touch {
        x: v(0.6 * s, 0.2, 0.0),
        foot: v(0.6 * s, 0.2, 0.0),
        normal: v(-0.6 * s, 0.8, 0.0),
        ..groove.now.contacts[0][0]
    };
    let touch = |s: f64| Touch { pressure: 0.625, ..wall(s) };
    groove.now.contacts[0] = vec![touch(-1.0), touch(1.0)];
    let findings = audit(&groove.setting, Some(&groove.before), &groove.now, &groove.stability);
    let doubt = |check: Check, list: &[signorini_audit::Finding]| {
        list.iter().any(|f| f.check == check && f.outcome == signorini_audit::Outcome::Doubt)
    };
    assert!(doubt(Check::Uniqueness, &findings), "{findings:#?}");
    // A zone of two nodes within the side of the block.
    let mut few = block();
    let force = few.now.forces.clone();
    for (k, t) in touches(&mut few).enumerate() {
        if ![7, 8].contains(&k) {
            (t.is_closed, t.pressure, t.friction, t.area) = (false, 0.0, Vector::<3>::zeros(), 0.0);
        }
    }
    assert_eq!(force.len(), 2);
    let findings = audit(&few.setting, Some(&few.before), &few.now, &few.stability);
    assert!(doubt(Check::Resolution, &findings), "{findings:#?}");
}

#[test]
fn findings_are_the_same_in_other_units() {
    let scaled = |length: f64, force: f64| {
        let mut case = block();
        let scale = |state: &mut State| {
            if let Placement::Points(points) = &mut state.bodies[0] {
                points.iter_mut().for_each(|x| *x *= length);
            }
            for t in &mut state.contacts[0] {
                for x in [&mut t.x, &mut t.foot, &mut t.slip] {
                    *x *= length;
                }
                (t.weight, t.area) = (t.weight * length, t.area * length);
                (t.pressure, t.friction) = (t.pressure * force / length, t.friction * (force / length));
            }
            for f in &mut state.forces {
                f.force *= force;
                f.work = f.work.map(|w| w.map(|w| w * force * length));
            }
            state.dissipated.iter_mut().flatten().for_each(|d| *d *= force * length);
        };
        scale(&mut case.before);
        scale(&mut case.now);
        if let Form::Solid(solid) = &mut case.setting.bodies[0].form {
            solid.rest.iter_mut().for_each(|x| *x *= length);
            solid.boundary = Boundary::new(&solid.rest, &solid.cells, false);
        }
        // Spoilt a little, so that there is something to measure.
        shift(&mut case, |_| v(0.0, -0.01 * length, 0.0));
        let findings = audit(&case.setting, Some(&case.before), &case.now, &case.stability);
        findings
            .iter()
            .map(|f| (f.check, f.outcome, f.value.unwrap_or(0.0) / f.limit.unwrap_or(1.0)))
            .collect::<Vec<_>>()
    };
    let [a, b] = [scaled(1.0, 1.0), scaled(1e-3, 1e6)];
    assert_eq!(a.len(), b.len());
    for (a, b) in a.iter().zip(&b) {
        assert_eq!((a.0, a.1), (b.0, b.1));
        // What is left of sums that cancel is rounding.
        assert!((a.2 - b.2).abs() <= 1e-9 * a.2.abs() + 1e-9, "{a:?} {b:?}");
    }
}

#[test]
fn bodies_that_start_in_each_other_bring_energy() {
    let mut case = block();
    (case.now.stored, case.before.forces) = (Some(0.1), Vec::new());
    let path = |case: &Case| case.verdict().1.contains(&Check::Path);
    assert!(path(&case));
    if let Placement::Points(points) = &mut case.before.bodies[0] {
        points.iter_mut().for_each(|x| x.y -= 1e-4);
    }
    assert!(!path(&case));
}

#[test]
fn a_body_that_shows_nothing_is_no_panic() {
    let mut case = block();
    case.setting.contacts[0].bodies = [1, 0];
    if let Form::Solid(solid) = &mut case.setting.bodies[0].form {
        (solid.rest, solid.cells) = (Vec::new(), Vec::new());
        solid.boundary = Boundary::new(&solid.rest, &solid.cells, false);
    }
    let sphere = Sphere { center: v(0.0, 1.0, 0.0), radius: 1.0 };
    case.setting.bodies[1] = rigid("ball", sphere, true, 2.0);
    for state in [&mut case.before, &mut case.now] {
        state.bodies[0] = Placement::Points(Vec::new());
    }
    assert!(gaps::check_start(&case.setting, &case.now).is_empty());
    case.verdict();
}

/// Rough surfaces are as far apart as their pressure says, and nothing pulls by more than its strength.
#[test]
fn surfaces_act_by_their_law() {
    let refused = |spoil: &dyn Fn(&mut Touch)| {
        let mut case = disc();
        let gap_at: Arc<dyn Fn(f64) -> f64 + Send + Sync> = Arc::new(|p| -0.1 * p);
        case.setting.contacts[0].surfaces =
            Surfaces { strength: [0.5, 0.0], range: 1.0, gap_at: Some(gap_at), wear: 0.0 };
        let touch = &mut case.now.contacts[0][0];
        touch.x = touch.foot - touch.normal * 0.1;
        spoil(touch);
        let found = signorini_audit::tractions::check(&case.setting, None, &case.now, &[]);
        found.into_iter().filter(|f| f.outcome == signorini_audit::Outcome::Refused).count()
    };
    assert_eq!(refused(&|_| ()), 0);
    assert_eq!(refused(&|t| t.x -= t.normal * 0.1), 1);
    assert_eq!(refused(&|t| t.pressure = -0.4), 0);
    assert_eq!(refused(&|t| t.pressure = -0.6), 1);
}

/// What surfaces take is part of the balance of energy: a load that sinks with what is worn off loses nothing.
#[test]
fn worn_surfaces_take_the_work_of_what_sinks() {
    let lost = |worn: f64| {
        let mut case = disc();
        case.setting.contacts[0].surfaces = Surfaces { wear: 1.0, ..Surfaces::default() };
        let touch = &mut case.now.contacts[0][0];
        touch.worn = worn;
        case.now.bodies[0] = moved(0.0, 0.0);
        case.now.forces[0].work = Some([0.1, 0.0]);
        let found = signorini_audit::path::check(&case.setting, &case.before, &case.now);
        found.into_iter().any(|f| f.outcome != signorini_audit::Outcome::Fine)
    };
    assert!(!lost(0.1) && lost(0.0));
}

/// A point that goes round the end of a plate is on its other side afterwards, and went through nothing: its way tells.
#[test]
fn what_goes_round_an_end_does_not_go_through() {
    let plate = Block::new(v(-1.0, 0.0, 0.0), v(2.0, 0.02, 2.0), Matrix::<3>::identity()).unwrap();
    let disc = Sphere { center: Point::<3>::zeros(), radius: 1e-3 };
    let state = |x: f64, y: f64| State {
        bodies: vec![moved(x, y), moved(0.0, 0.0)],
        contacts: vec![Vec::new()],
        dissipated: vec![None],
        ..State::default()
    };
    let setting = Setting {
        space: Space::Plane,
        bodies: vec![rigid("disc", disc, true, 2e-3), rigid("plate", plate, false, 2.0)],
        contacts: vec![contact(Carries::Force, None)],
    };
    let told = |way: Vec<Vec<Placement>>| {
        let now = State { way, ..state(-0.02, -0.03) };
        let findings = audit(&setting, Some(&state(-0.02, 0.03)), &now, &Stability::NotTested);
        findings.iter().any(|f| f.message.contains("passed"))
    };
    assert!(told(Vec::new()));
    assert!(told(vec![vec![moved(-0.03, 0.02), moved(0.0, 0.0)]]));
    assert!(!told([(0.02, 0.03), (0.02, -0.03)].map(|(x, y)| vec![moved(x, y), moved(0.0, 0.0)]).to_vec()));
}
