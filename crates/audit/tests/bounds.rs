//! Bounds of forces that balance does not determine, against closed forms.

use signorini_audit::{
    Acting, Body, Carries, Check, Contact, Form, Law, Outcome, Placement, Rigid, Setting, Space, Stability, State,
    Surfaces, Touch, audited, bounds,
};
use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::rigid_shape::GapJet;
use signorini_geometry::{Point, Vector};
use std::collections::BTreeMap;
use std::sync::Arc;

/// What the interior-point method leaves, relative to the loads.
const SOLVED: f64 = 1e-8;
/// Weight of the bodies.
const W: f64 = 3.0;

type V = Vector<3>;

fn v(x: f64, y: f64, z: f64) -> V {
    Vector::<3>::new(x, y, z)
}

/// Where two bodies touch: of which contact, where, with which normal on the first.
#[derive(Clone)]
struct At {
    contact: &'static str,
    x: V,
    normal: V,
    /// Normal force and friction on the first body, as told.
    told: (f64, V),
    slips: bool,
}

fn at(contact: &'static str, x: V, normal: V) -> At {
    At { contact, x, normal: normal.normalize(), told: (1.0, V::zeros()), slips: false }
}

/// Free bodies with a force each at a place, others that hold them, and contacts of pairs of them.
#[derive(Clone)]
struct Case {
    space: Space,
    law: Option<Law>,
    free: Vec<(&'static str, Vec<(Point<3>, V)>)>,
    contacts: Vec<(&'static str, [&'static str; 2])>,
    places: Vec<At>,
}

/// How a case is stated: none of it may matter.
struct Stated {
    length: f64,
    force: f64,
    turn: V,
    shift: V,
    is_reversed: bool,
}

const AS_IT_IS: Stated =
    Stated { length: 1.0, force: 1.0, turn: V::new(0.0, 0.0, 0.0), shift: V::new(0.0, 0.0, 0.0), is_reversed: false };

fn body(name: &str, is_free: bool, size: f64) -> Body {
    let gap = Arc::new(|_: &Point<3>| GapJet::flat(f64::INFINITY, V::zeros()));
    let rigid = Rigid { gap, surface: Vec::new(), balls: Vec::new(), centre: Point::<3>::zeros(), is_free, size };
    Body { name: name.into(), form: Form::Rigid(rigid), rounding: 0.0 }
}

impl Case {
    /// One free body that others hold, each by a contact of its name, under a force at a place.
    fn one(space: Space, mu: f64, load: (Point<3>, V), places: Vec<At>) -> Self {
        let mut contacts: Vec<(&'static str, [&'static str; 2])> = Vec::new();
        for place in &places {
            if contacts.iter().all(|c| c.0 != place.contact) {
                contacts.push((place.contact, ["body", place.contact]));
            }
        }
        let law = (mu > 0.0).then_some(Law::PerPressure([mu; 2]));
        Case { space, law, free: vec![("body", vec![load])], contacts, places }
    }

    fn stated(&self, how: &Stated) -> (Setting, State) {
        let turned = RigidMotion::new(how.turn, Point::<3>::zeros(), V::zeros());
        let x = |x: &V| (turned.vector(x) + how.shift) * how.length;
        let along = |n: &V| turned.vector(n);
        let mut bodies: Vec<Body> = self.free.iter().map(|f| body(f.0, true, how.length)).collect();
        for name in self.contacts.iter().flat_map(|c| c.1) {
            if bodies.iter().all(|b| b.name != name) {
                bodies.push(body(name, false, 0.0));
            }
        }
        let mut contacts = self.contacts.clone();
        let mut places = self.places.clone();
        if how.is_reversed {
            bodies.reverse();
            contacts.reverse();
            places.reverse();
        }
        let number = |name: &str| bodies.iter().position(|b| b.name == name).unwrap();
        // Pressures per a weight that is none of 1.
        let weight = 0.5 * how.length;
        let touch = |at: &At| Touch {
            x: x(&at.x),
            foot: x(&at.x),
            normal: along(&at.normal),
            weight,
            area: weight,
            is_closed: at.told.0 > 0.0,
            slips: at.slips,
            pressure: at.told.0 * how.force / weight,
            friction: along(&at.told.1) * (how.force / weight),
            ..Touch::default()
        };
        let touches = |c: &(&str, _)| places.iter().filter(|p| p.contact == c.0).map(touch).collect();
        let acting = |(name, (place, force)): (&str, &(Point<3>, V))| {
            let force = along(force) * how.force;
            let moment = Some(x(place).cross(&force));
            Acting { name: "load".into(), body: number(name), force, moment, work: None, drives: false, reacts: false }
        };
        let loads = self.free.iter().flat_map(|f| f.1.iter().map(|load| (f.0, load)));
        let law = self.law.map(|law| match law {
            Law::Limit(limit) => Law::Limit(limit * how.force / weight),
            law => law,
        });
        let contact = |c: &(&str, [&str; 2])| Contact {
            name: c.0.into(),
            bodies: c.1.map(number),
            law,
            is_small_sliding: false,
            carries: Carries::Force,
            wanted_penetration: 0.0,
            at_places: true,
            surfaces: Surfaces::default(),
        };
        let rest = Placement::Moved(RigidMotion::new(V::zeros(), Point::<3>::zeros(), V::zeros()));
        let state = State {
            time: 1.0,
            bodies: vec![rest; bodies.len()],
            contacts: contacts.iter().map(touches).collect(),
            forces: loads.map(acting).collect(),
            ..State::default()
        };
        let contacts = contacts.iter().map(contact).collect();
        (Setting { space: self.space, bodies, contacts }, state)
    }

    /// Bounds by the names of contacts, in units of the case as it is.
    fn bounds(&self, how: &Stated) -> BTreeMap<String, (f64, Option<f64>)> {
        let (setting, state) = self.stated(how);
        let told = bounds(&setting, &state);
        assert!(told.is_sorted_by_key(|b| b.contact));
        let scaled = |v: f64| v / how.force;
        let entry = |b: &signorini_audit::ForceBounds| {
            (setting.contacts[b.contact].name.clone(), (scaled(b.least), b.largest.map(scaled)))
        };
        told.iter().map(entry).collect()
    }

    /// What uniqueness comes to, and its sentence.
    fn finding(&self) -> (Outcome, String) {
        let (setting, state) = self.stated(&AS_IT_IS);
        let found = audited(&setting, None, &state, &Stability::NotTested).findings;
        let own = found.into_iter().find(|f| f.check == Check::Uniqueness).expect("a finding");
        (own.outcome, own.message)
    }

    /// Asserts bounds, however the case is stated.
    fn has(&self, expected: &[(&str, f64, Option<f64>)]) {
        let in_plane = self.space == Space::Plane;
        let turn = if in_plane { v(0.0, 0.0, 0.7) } else { v(0.4, -0.7, 1.1) };
        let shift = if in_plane { v(5.0, -3.0, 0.0) } else { v(5.0, -3.0, 2.0) };
        let ways = [
            AS_IT_IS,
            Stated { length: 1e-6, force: 1e6, ..AS_IT_IS },
            Stated { length: 1e6, force: 1e-6, ..AS_IT_IS },
            Stated { turn, shift, ..AS_IT_IS },
            Stated { is_reversed: true, ..AS_IT_IS },
        ];
        for (k, how) in ways.iter().enumerate() {
            let found = self.bounds(how);
            assert_eq!(found.len(), expected.len(), "{k}: {found:?}");
            for (name, least, largest) in expected {
                let (low, high) = found[*name];
                let near = |a: f64, b: f64| (a - b).abs() <= SOLVED * W.max(b);
                let is_right = near(low, *least)
                    && match (high, largest) {
                        (Some(high), Some(largest)) => near(high, *largest),
                        (high, largest) => high.is_none() && largest.is_none(),
                    };
                assert!(is_right, "{k}: {name} from {low} to {high:?}, not from {least} to {largest:?}");
            }
        }
    }
}

/// The load of a weight at a place.
fn weight(x: f64, y: f64) -> (Point<3>, V) {
    (v(x, y, 0.0), v(0.0, -W, 0.0))
}

/// A block between two walls: one place at each, or the corners.
fn between_walls(mu: f64, heights: &[f64]) -> Case {
    let places = heights.iter().flat_map(|y| {
        [at("left", v(-0.5, *y, 0.0), v(1.0, 0.0, 0.0)), at("right", v(0.5, *y, 0.0), v(-1.0, 0.0, 0.0))]
    });
    Case::one(Space::Plane, mu, weight(0.0, 0.0), places.collect())
}

#[test]
fn walls_clamp_a_block_as_hard_as_they_like() {
    let mu = 0.3;
    // Friction of both carries half of the weight.
    let least = W / (2.0 * mu);
    for heights in [&[0.0][..], &[-0.5, 0.5]] {
        between_walls(mu, heights).has(&[("left", least, None), ("right", least, None)]);
    }
    // On a floor nothing has to press: friction may lift it off, or push it down without limit.
    let mut on_floor = between_walls(mu, &[0.0]);
    let floor = [-0.5, 0.5].map(|x| at("floor", v(x, -0.5, 0.0), v(0.0, 1.0, 0.0)));
    on_floor.places.extend(floor);
    on_floor.contacts.push(("floor", ["body", "floor"]));
    on_floor.has(&[("floor", 0.0, None), ("left", 0.0, None), ("right", 0.0, None)]);
    // What touches and was told to carry nothing may carry.
    on_floor.places.iter_mut().filter(|p| p.contact != "floor").for_each(|p| p.told.0 = 0.0);
    on_floor.has(&[("floor", 0.0, None), ("left", 0.0, None), ("right", 0.0, None)]);
    let (setting, mut state) = on_floor.stated(&AS_IT_IS);
    assert_eq!(bounds(&setting, &state).len(), 3);
    // Across a gap nothing does, and the other one presses as far as the floor holds: `N = μ (W + μ N)`.
    let wall = setting.contacts.iter().position(|c| c.name == "right").unwrap();
    state.contacts[wall][0].foot[0] += 1e-6;
    let left = |b: &signorini_audit::ForceBounds| setting.contacts[b.contact].name == "left";
    let found = bounds(&setting, &state).into_iter().find(left).unwrap();
    let most = mu * W / (1.0 - mu * mu);
    assert!(found.largest.is_some_and(|f| (f - most).abs() < SOLVED * W), "{found:?}");
    let (outcome, text) = on_floor.finding();
    assert!(outcome == Outcome::Doubt && text.contains("anything from 0 to ∞, without bound"), "{text}");
}

/// A disc of radius 1 in a groove of two walls by their angles from the horizontal.
fn groove(angles: [f64; 2], mu: f64) -> Case {
    let [a, b] = angles.map(f64::to_radians);
    let normals = [v(a.sin(), a.cos(), 0.0), v(-b.sin(), b.cos(), 0.0)];
    let places = ["left", "right"].iter().zip(normals).map(|(name, n)| at(name, -n, n));
    Case::one(Space::Plane, mu, weight(0.0, 0.0), places.collect())
}

/// Moments about the centre make both friction forces `T` upward along the walls the same; then
/// `N = W sin β / sin(α + β) - T tan((α + β) / 2)`, and the lighter side limits `T`.
#[test]
fn a_disc_in_a_groove_is_clamped_by_the_side_that_carries_less() {
    for (angles, mu) in [([40.0, 40.0], 0.3), ([30.0, 55.0], 0.4), ([30.0, 55.0], 1.2)] {
        let [a, b] = angles.map(f64::to_radians);
        let without = [b, a].map(|other| W * other.sin() / (a + b).sin());
        let k = (0.5 * (a + b)).tan();
        let lighter = without[0].min(without[1]);
        let [down, up] = [mu * lighter / (1.0 + mu * k), mu * lighter / (1.0 - mu * k)];
        let bound = |n: f64| (n - k * down, (mu * k < 1.0).then_some(n + k * up));
        let [left, right] = without.map(bound);
        groove(angles, mu).has(&[("left", left.0, left.1), ("right", right.0, right.1)]);
    }
    // Without friction, or where one side slips, balance tells all.
    assert!(groove([40.0, 40.0], 0.0).bounds(&AS_IT_IS).is_empty());
    let (setting, mut state) = groove([40.0, 40.0], 0.3).stated(&AS_IT_IS);
    state.contacts[0][0].slips = true;
    assert!(bounds(&setting, &state).is_empty());
}

/// A block that slides along a floor against a wall: the friction of the floor is known, that of the wall is not.
#[test]
fn friction_where_bodies_slip_is_known() {
    let (mu, push) = (0.3, 2.0);
    let mut case = Case::one(Space::Plane, mu, weight(0.0, 0.0), Vec::new());
    case.free[0].1.push((V::zeros(), v(push, 0.0, 0.0)));
    let floor = [-0.5, 0.5].map(|x| At {
        told: (1.0, v(-mu, 0.0, 0.0)),
        slips: true,
        ..at("floor", v(x, -0.5, 0.0), v(0.0, 1.0, 0.0))
    });
    case.places.extend(floor);
    case.places.push(at("wall", v(0.5, 0.0, 0.0), v(-1.0, 0.0, 0.0)));
    case.contacts = vec![("floor", ["body", "floor"]), ("wall", ["body", "wall"])];
    // `N = Q - μ (W - T)` at the wall, with `|T| ≤ μ N`.
    let [least, largest] = [1.0, -1.0].map(|sign| (push - mu * W) / (1.0 + sign * mu * mu));
    case.has(&[("floor", W - mu * largest, Some(W + mu * least)), ("wall", least, Some(largest))]);
    // The same where it is a constant at each place, of which nothing is told by the pressure.
    let limit = 0.4;
    case.law = Some(Law::Limit(limit));
    case.places.iter_mut().filter(|p| p.slips).for_each(|p| p.told.1 = v(-limit, 0.0, 0.0));
    let wall = push - 2.0 * limit;
    case.has(&[("floor", W - limit, Some(W + limit)), ("wall", wall, Some(wall))]);
    // Rounding tells nothing: as if it stuck.
    case.law = Some(Law::PerPressure([mu; 2]));
    let rounded = |p: &mut At| p.told = (1e-14, v(0.0, -3e-13, 0.0));
    case.places.iter_mut().filter(|p| p.slips).for_each(rounded);
    let mut sticks = case.clone();
    sticks.places.iter_mut().for_each(|p| (p.slips, p.told) = (false, (1.0, V::zeros())));
    assert_eq!(case.bounds(&AS_IT_IS), sticks.bounds(&AS_IT_IS));
}

#[test]
fn friction_up_to_a_constant_shifts_forces_by_it() {
    let (angle, limit) = (40.0f64, 0.5);
    let (s, c) = angle.to_radians().sin_cos();
    let mut case = groove([angle; 2], 0.0);
    case.law = Some(Law::Limit(limit));
    let [least, largest] = [limit, -limit].map(|t| (W / 2.0 - t * s) / c);
    case.has(&[("left", least, Some(largest)), ("right", least, Some(largest))]);
    // With the longer axis where it differs by direction.
    case.law = Some(Law::AtMost([0.1, 0.3]));
    assert_eq!(case.bounds(&AS_IT_IS), groove([angle; 2], 0.3).bounds(&AS_IT_IS));
}

/// By moments about the foot the wall presses with `N = (W / 2 - T) a / h`, where its friction `T` and that of the floor, `N`, are
/// within their cones.
#[test]
fn a_ladder_is_held_between_two_cones() {
    for (angle, mu) in [(60.0f64, 0.3), (60.0, 0.6), (70.0, 0.45)] {
        let (h, a) = angle.to_radians().sin_cos();
        let places = vec![at("foot", v(0.0, 0.0, 0.0), v(0.0, 1.0, 0.0)), at("head", v(a, h, 0.0), v(-1.0, 0.0, 0.0))];
        let case = Case::one(Space::Plane, mu, weight(0.5 * a, 0.5 * h), places);
        let slope = h / a;
        let least = 0.5 * W / (slope + mu);
        let by_wall = if slope > mu { 0.5 * W / (slope - mu) } else { f64::INFINITY };
        let by_floor = if mu * slope < 1.0 { 0.5 * W * mu / (1.0 - mu * slope) } else { f64::INFINITY };
        let largest = by_wall.min(by_floor);
        // The foot carries what the friction `W / 2 - N h / a` of the head does not.
        let foot = |n: f64| 0.5 * W + n * slope;
        case.has(&[("foot", foot(least), Some(foot(largest))), ("head", least, Some(largest))]);
        let (outcome, text) = case.finding();
        assert!(outcome == Outcome::Doubt && text.contains("`foot` may be anything from"), "{text}");
    }
}

/// A ladder about to slip has one set of forces: with this coefficient of friction the cones meet in one. With less they do not,
/// and nothing can be told of forces that balance.
#[test]
fn what_is_about_to_slip_has_no_choice() {
    let (h, a) = 60.0f64.to_radians().sin_cos();
    let slope = h / a;
    let mu = slope.hypot(1.0) - slope;
    let of = |mu: f64| {
        let places = vec![at("foot", v(0.0, 0.0, 0.0), v(0.0, 1.0, 0.0)), at("head", v(a, h, 0.0), v(-1.0, 0.0, 0.0))];
        Case::one(Space::Plane, mu, weight(0.5 * a, 0.5 * h), places).bounds(&AS_IT_IS)
    };
    for more in [0.0, 1e-9, 1e-6, 1e-3] {
        let (least, largest) = of(mu + more)["head"];
        let expected = [0.5 * W / (slope + mu + more), 0.5 * W / (1.0 / (mu + more) - slope)];
        for (found, expected) in [least, largest.unwrap()].into_iter().zip(expected) {
            assert!((found - expected).abs() < SOLVED * W, "{more}: {found} {expected}");
        }
    }
    assert!(of(mu - 1e-6).is_empty());
}

/// A table on four legs at `(±1, ±1) / 2` without friction.
fn table(load: (Point<3>, V)) -> Case {
    let places = LEGS.map(|(name, i, j)| at(name, v(0.5 * i, 0.5 * j, 0.0), v(0.0, 0.0, 1.0)));
    Case::one(Space::ThreeD, 0.0, load, places.to_vec())
}

const LEGS: [(&str, f64, f64); 4] = [("a", 1.0, 1.0), ("b", -1.0, 1.0), ("c", -1.0, -1.0), ("d", 1.0, -1.0)];

/// Forces of the legs `(±1, ±1)` differ from those of a flexible table by `± s` in turn.
#[test]
fn three_legs_of_a_table_tell_the_fourth() {
    for (x, y) in [(0.0, 0.0), (0.3, 0.0), (0.4, -0.2)] {
        let mut case = table((v(0.5 * x, 0.5 * y, 1.0), v(0.0, 0.0, -W)));
        let flexible = LEGS.map(|(_, i, j)| 0.25 * W * (1.0 + i * x + j * y));
        let bound = |k: usize| {
            let own = flexible[k];
            let [opposite, next, last] = [2, 1, 3].map(|i| flexible[(k + i) % 4]);
            (LEGS[k].0, own - own.min(opposite), Some(own + next.min(last)))
        };
        case.has(&[0, 1, 2, 3].map(bound));
        // Rounding of normals makes no equations.
        for (place, tilt) in case.places.iter_mut().zip([1e-10, -2e-10, 3e-10, 1e-10]) {
            place.normal[0] = tilt;
        }
        case.has(&[0, 1, 2, 3].map(bound));
        if x == 0.0 {
            assert_eq!(bound(0), ("a", 0.0, Some(W / 2.0)));
            let (_, text) = case.finding();
            assert!(
                text.contains("4 contact points") && text.contains("balance gives 3 independent equations"),
                "{text}"
            );
            assert!(text.contains("`a` may be anything from 0 to 1.5"), "{text}");
        }
    }
}

#[test]
fn a_ball_between_walls_needs_friction_in_both_directions() {
    // Half of the load at each wall, `|(Q, W)| / 2 ≤ μ N`; with a floor that of `Q` only.
    let (mu, across) = (0.4, 2.0);
    let walls = [at("left", v(-0.5, 0.0, 0.0), v(1.0, 0.0, 0.0)), at("right", v(0.5, 0.0, 0.0), v(-1.0, 0.0, 0.0))];
    let load = (V::zeros(), v(0.0, across, -W));
    let mut case = Case::one(Space::ThreeD, mu, load, walls.to_vec());
    let least = across.hypot(W) / (2.0 * mu);
    case.has(&[("left", least, None), ("right", least, None)]);
    case.places.push(at("floor", v(0.0, 0.0, -0.5), v(0.0, 0.0, 1.0)));
    case.contacts.push(("floor", ["body", "floor"]));
    let least = across / (2.0 * mu);
    case.has(&[("floor", 0.0, None), ("left", least, None), ("right", least, None)]);
}

/// The set of forces is convex and turns into itself with the walls: its extremes for all walls are symmetric, with friction
/// along the meridians, as across it would turn the ball.
#[test]
fn a_ball_on_three_walls_is_a_disc_in_a_groove() {
    for (angle, mu) in [(40.0f64, 0.3), (60.0, 0.5), (60.0, 0.6)] {
        let (s, c) = angle.to_radians().sin_cos();
        let places = [0.0, 120.0, 240.0f64].map(|around| {
            let (sin, cos) = around.to_radians().sin_cos();
            let normal = v(s * cos, s * sin, c);
            at("walls", -normal * 0.5, normal)
        });
        let case = Case::one(Space::ThreeD, mu, (V::zeros(), v(0.0, 0.0, -W)), places.to_vec());
        case.has(&[("walls", W / (c + mu * s), (c > mu * s).then(|| W / (c - mu * s)))]);
    }
}

/// Two books between two walls: each wall carries one of them.
#[test]
fn books_are_held_by_each_other() {
    let mu = 0.5;
    let heights = [-0.5, 0.5];
    let list = [("left", -0.2, 1.0), ("middle", 0.0, -1.0), ("right", 0.2, -1.0)];
    let of = |(name, x, n): (&'static str, f64, f64)| heights.map(|y| at(name, v(x, y, 0.0), v(n, 0.0, 0.0)));
    let case = Case {
        space: Space::Plane,
        law: Some(Law::PerPressure([mu; 2])),
        free: vec![("first", vec![weight(-0.1, 0.0)]), ("second", vec![weight(0.1, 0.0)])],
        contacts: vec![("left", ["first", "wall"]), ("middle", ["first", "second"]), ("right", ["second", "other"])],
        places: list.into_iter().flat_map(of).collect(),
    };
    case.has(&[("left", W / mu, None), ("middle", W / mu, None), ("right", W / mu, None)]);
}

/// Around an axis: a ring of any friction on a cone.
#[test]
fn a_plug_in_a_cone_is_a_groove_around() {
    let (angle, mu) = (40.0f64, 0.3);
    let (s, c) = angle.to_radians().sin_cos();
    let places = vec![at("cone", v(0.5, 0.0, 0.0), v(-s, c, 0.0))];
    let case = Case::one(Space::Axisymmetric, mu, weight(0.0, 0.0), places);
    let found = case.bounds(&AS_IT_IS)["cone"];
    let near = |a: f64, b: f64| assert!((a - b).abs() < SOLVED * W, "{a} {b}");
    near(found.0, W / (c + mu * s));
    near(found.1.unwrap(), W / (c - mu * s));
}

#[test]
fn forces_outside_of_their_bounds_are_told() {
    let (s, c) = 40.0f64.to_radians().sin_cos();
    let mut case = groove([40.0; 2], 0.3);
    let honest = W / (2.0 * c);
    case.places.iter_mut().for_each(|p| p.told = (honest, V::zeros()));
    let (_, text) = case.finding();
    assert!(text.contains("may be anything from") && !text.contains("was reported as"), "{text}");
    // Balanced by more friction than there is.
    let friction = -0.5 * honest;
    let pressed = (W / 2.0 - friction * s) / c;
    for p in &mut case.places {
        let up = v(-p.normal[1] * p.normal[0].signum(), p.normal[0].abs(), 0.0);
        p.told = (pressed, up * friction);
    }
    let (outcome, text) = case.finding();
    assert!(outcome == Outcome::Doubt && text.contains("was reported as") && text.contains("not between"), "{text}");
}

/// A groove that all but clamps has a bound, however large, and one that just does has none.
#[test]
fn a_large_bound_is_a_bound() {
    let angle = 40.0f64;
    let k = angle.to_radians().tan();
    let open = 0.5 * W / angle.to_radians().cos();
    for little in [1e-2, 1e-4, 1e-6] {
        let largest = open / little;
        let found = groove([angle; 2], (1.0 - little) / k).bounds(&AS_IT_IS)["left"].1.expect("a bound");
        assert!((found / largest - 1.0).abs() < SOLVED / little, "{found} for {largest}");
        assert_eq!(groove([angle; 2], (1.0 + little) / k).bounds(&AS_IT_IS)["left"].1, None);
    }
}

#[test]
fn nothing_is_told_of_what_is_not_known() {
    // A support gives what balances.
    let (setting, mut state) = groove([40.0; 2], 0.3).stated(&AS_IT_IS);
    state.forces[0].reacts = true;
    assert!(bounds(&setting, &state).is_empty());
    // No forces at the places balance such a load.
    let lost = Case::one(Space::Plane, 0.3, (V::zeros(), v(0.0, W, 0.0)), groove([40.0; 2], 0.3).places);
    assert!(lost.bounds(&AS_IT_IS).is_empty());
    let slides = table((V::zeros(), v(0.1, 0.0, -W)));
    assert!(slides.bounds(&AS_IT_IS).is_empty());
    // Of no load and no walls that clamp nothing is left.
    let mut still = groove([40.0; 2], 0.3);
    still.free[0].1[0].1 = V::zeros();
    assert_eq!(still.bounds(&AS_IT_IS)["left"], (0.0, Some(0.0)));
}

/// How long bounds take by the number of places: `cargo test --release -p signorini-audit --test bounds -- --ignored --nocapture`.
#[test]
#[ignore = "prints times"]
fn times() {
    let told = |what: &str, case: Case| {
        let (setting, state) = case.stated(&AS_IT_IS);
        let places = case.places.len();
        let start = std::time::Instant::now();
        let found = bounds(&setting, &state).len();
        let time = start.elapsed().as_secs_f64() * 1e3;
        println!("{what}: {places} places, {} contacts, {found} bounds, {time:.2} ms", case.contacts.len());
    };
    let name = |k: usize| -> &'static str { format!("c{k}").leak() };
    for count in [2, 4, 9, 24, 37, 49] {
        let x = |k: usize| 0.2 * k as f64;
        let places = (0..=count).flat_map(|k| {
            let n = v(if k == 0 { 1.0 } else { -1.0 }, 0.0, 0.0);
            [-0.5, 0.5].map(|y| at(name(k), v(x(k), y * count as f64, 0.0), n))
        });
        let case = Case {
            space: Space::Plane,
            law: Some(Law::PerPressure([0.5; 2])),
            free: (0..count).map(|k| (&*format!("b{k}").leak(), vec![weight(x(k) + 0.1, 0.0)])).collect(),
            contacts: (0..=count)
                .map(|k| (name(k), [&*format!("b{}", k.max(1) - 1).leak(), &*format!("b{}", k.max(1)).leak()]))
                .collect(),
            places: places.collect(),
        };
        let mut case = case;
        case.contacts[0].1 = ["b0", "wall"];
        case.contacts[count].1[1] = "other";
        told(&format!("{count} books"), case);
    }
    for (space, count) in
        [10, 20, 30, 50, 100, 200].into_iter().flat_map(|n| [Space::Plane, Space::ThreeD].map(|s| (s, n)))
    {
        for contacts in [2, 10, count].into_iter().filter(|c| *c <= count) {
            let place = |k: usize| {
                let angle = 0.3 + 2.54 * k as f64 / (count - 1) as f64;
                let z = if space == Space::ThreeD { 0.2 * (1.7 * k as f64).sin() } else { 0.0 };
                let n = v(angle.cos(), angle.sin(), z).normalize();
                at(name(k % contacts), -n, n)
            };
            let case = Case::one(space, 0.3, weight(0.0, 0.0), (0..count).map(place).collect());
            told(&format!("{space:?}"), case);
        }
    }
}
