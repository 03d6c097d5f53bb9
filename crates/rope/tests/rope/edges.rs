//! Edges of solids as curves: tangents against differences, balance, and forces that are known.

use crate::common::acting::{Touching, balance, laws, taylor};
use crate::common::bodies::cable;
use signorini_fem::block::block;
use signorini_geometry::Vector;
use signorini_mechanics::body::Body;
use signorini_mechanics::interaction::Interaction;
use signorini_mechanics::{Enforcement, Part};
use signorini_rope::curve_pair::blend::Blend;
use signorini_rope::curve_pair::contact::{CurveContact, Form, Penalties};
use signorini_solid::Elastic;
use signorini_solid::{EdgeError, EdgeOf, SolidBody, Space, StressLaw};
use std::collections::BTreeMap;
use std::sync::Arc;

type V = Vector<3>;

fn part(body: usize, group: &str) -> Part {
    Part { body, group: Some(group.to_string()) }
}

fn even(from: f64, to: f64, n: usize) -> Vec<f64> {
    (0..=n).map(|k| from + (to - from) * k as f64 / n as f64).collect()
}

fn edge(surfaces: [&str; 2], radius: f64) -> EdgeOf {
    EdgeOf { surfaces: surfaces.map(str::to_string), radius }
}

const ELASTIC: Elastic = Elastic { youngs_modulus: 100.0, poissons_ratio: 0.3 };

/// A block whose points are mapped, with the edge of two of its sides.
fn cuboid(
    name: &str,
    size: [V; 2],
    cells: [usize; 3],
    degree: usize,
    map: impl FnMut(V) -> V,
    rim: EdgeOf,
) -> Result<SolidBody<3>, EdgeError> {
    let axes: [Vec<f64>; 3] = std::array::from_fn(|k| even(size[0][k], size[1][k], cells[k]));
    let mesh = block::<3>(&axes, 1, map);
    let groups = mesh.groups().clone();
    let law = StressLaw::LinearElastic;
    let body = SolidBody::new(name, Arc::new(mesh), degree, (ELASTIC, law), Space::Solid, groups).unwrap();
    body.with_edges(&BTreeMap::from([("rim".to_string(), rim)]))
}

#[derive(Clone, Copy, Debug)]
enum Case {
    /// A rope across an edge, rounded or sharp.
    Crossing(f64),
    Blended,
    Along,
    /// Two edges, sharp or rounded.
    Edges(f64),
}

const CASES: [Case; 6] =
    [Case::Crossing(0.1), Case::Crossing(0.0), Case::Blended, Case::Along, Case::Edges(0.0), Case::Edges(0.05)];

/// What touches a block from `z = 0` down, whose edge runs along x.
fn touching(case: Case, degree: usize) -> Touching {
    let (radius, angle, form): (f64, f64, Form) = match case {
        Case::Crossing(radius) => (radius, 1.2, Form::Point),
        Case::Blended => (0.1, 0.4, Form::Blend(Blend::new(0.2, 0.6).unwrap())),
        Case::Along => (0.1, 0.03, Form::Line),
        Case::Edges(radius) => (radius, 1.2, Form::Point),
    };
    // A ridge with faces at right angles, bent a little.
    let ridge = |x: V| V::new(x[0], (x[1] - x[2]) / 2f64.sqrt(), (x[1] + x[2]) / 2f64.sqrt() + 0.02 * x[0] * x[0]);
    let size = [V::new(-2.0, -1.0, -1.0), V::zeros()];
    let block = cuboid("block", size, [4, 1, 1], degree, ridge, edge(["back", "top"], radius)).unwrap();
    let (c, s) = (angle.cos(), angle.sin());
    let turned = |x: f64, y: f64, z: f64| V::new(c * x - s * y - 0.9, s * x + c * y, z);
    let other: Box<dyn Body> = match case {
        Case::Edges(_) => {
            // The same upside down.
            let above = 2.0 * radius - 0.012;
            let map = |x: V| {
                let y = ridge(x + V::x());
                turned(y[0], -y[1], above + 0.02 - y[2])
            };
            Box::new(cuboid("other", size, [3, 1, 1], degree, map, edge(["back", "top"], radius)).unwrap())
        }
        _ => {
            let z = 0.2 + radius - 0.012 + 0.02;
            let points = [turned(-1.0, 0.02, z + 0.01), turned(0.02, 0.01, z), turned(0.9, 0.0, z - 0.01)];
            Box::new(cable("rope", &points, 3, 0.2))
        }
    };
    let slave = match case {
        Case::Edges(_) => part(0, "rim"),
        _ => Part::from(0),
    };
    let bodies: Vec<Box<dyn Body>> = vec![other, Box::new(block)];
    let penalty = Enforcement::Penalty { wanted_penetration: None };
    let sides = [(slave, bodies[0].as_ref()), (part(1, "rim"), bodies[1].as_ref())];
    let [own, met] = sides;
    let mut contact = CurveContact::new("touch", own, met, penalty).unwrap();
    contact.form = form;
    contact.stated = Some(Penalties { point: 1e3, line: 1e3 });
    contact.prepare(&bodies, 1.0);
    (bodies, contact)
}

#[test]
fn tangents_at_edges_are_derivatives() {
    for case in CASES {
        for degree in [1, 2] {
            for enforcement in [Enforcement::Penalty { wanted_penetration: None }, Enforcement::AugmentedLagrangian] {
                for (law, status) in laws() {
                    let rubs = law.is_some();
                    let [coarse, fine] = taylor(touching(case, degree), (law, status), enforcement);
                    println!("{case:?}, degree {degree}, friction {rubs}, {status:?}: {coarse:.1e} {fine:.1e}");
                    assert!(fine < 1e-8 || (coarse / fine > 1.9 && coarse / fine < 2.1), "{coarse:e} {fine:e}");
                    assert!(fine < 2e-2);
                }
            }
        }
    }
}

#[test]
fn forces_at_edges_have_neither_resultant_nor_moment() {
    for case in CASES {
        for degree in [1, 2] {
            for (law, _) in laws() {
                let (powers, size) = balance(touching(case, degree), law);
                assert!(size > 0.0);
                for power in powers {
                    assert!(power.abs() < 1e-12 * size, "{case:?} {degree}: {power:e} of {size:e}");
                }
            }
        }
    }
}

#[test]
fn edges_that_cannot_touch_say_why() {
    let whole = [V::zeros(), V::new(1.0, 1.0, 1.0)];
    let of = |surfaces: [&str; 2], radius: f64, map: fn(V) -> V| {
        cuboid("block", whole, [2, 2, 2], 1, map, edge(surfaces, radius)).err().map(|e| e.to_string())
    };
    let same = |x: V| x;
    assert_eq!(of(["left", "top"], 0.0, same), None);
    let told = |surfaces, radius, map| of(surfaces, radius, map).unwrap();
    assert!(told(["left", "right"], 0.0, same).contains("have no common edge"));
    assert!(told(["left", "lid"], 0.0, same).contains("there is no group `lid` of sides; valid are"));
    assert!(told(["left", "top"], -1.0, same).contains("the radius is -1"));
    assert!(told(["left", "top"], f64::NAN, same).contains("the radius is NaN"));
    assert!(told(["boundary", "top"], 0.0, same).contains("branches at (0.500000, 0.000000, 1.000000)"));
    let bent = |x: V| V::new(x[0] - 1.5 * (x[1] - 0.5).max(0.0), x[1], x[2]);
    assert!(
        told(["left", "top"], 0.0, bent).contains("a kink at (0.000000, 0.500000, 1.000000), where it turns by 56")
    );
    // Steps: the foot of the upper one is re-entrant, and both front edges are pieces.
    let mut steps = signorini_fem::Mesh::<3>::new(
        (0..24).map(|k| V::new(f64::from(k % 4), f64::from(k / 4 % 2), f64::from(k / 8))).collect(),
    );
    for corner in [0, 1, 2, 8, 10] {
        let at = [0, 1, 4, 5, 8, 9, 12, 13].map(|k| corner + k);
        steps.add_cell(signorini_fem::CellShape::Hexahedron, 1, &at);
    }
    let normal = |mesh: &signorini_fem::Mesh<3>, side| {
        let (_, [a, b]) = mesh.on_side(side, &[0.0; 3]);
        a.cross(&b)
    };
    for side in steps.boundary() {
        let n = normal(&steps, side);
        let (middle, _) = steps.on_side(side, &[0.0; 3]);
        if n[2] > 0.1 && middle[2] < 1.5 {
            steps.group_mut("ditch").sides.push(side);
        }
        if n[0] > 0.1 && middle[0] < 1.5 {
            steps.group_mut("wall").sides.push(side);
        }
        let name = if n[2] > 0.1 {
            "treads"
        } else if n[0].abs() > 0.1 {
            "risers"
        } else {
            "rest"
        };
        steps.group_mut(name).sides.push(side);
    }
    let of_steps = |surfaces| {
        let groups = steps.groups().clone();
        let law = (ELASTIC, StressLaw::LinearElastic);
        let body = SolidBody::new("steps", Arc::new(steps.clone()), 1, law, Space::Solid, groups).unwrap();
        let edges = BTreeMap::from([("rim".to_string(), edge(surfaces, 0.0))]);
        body.with_edges(&edges).err().map(|e| e.to_string()).unwrap()
    };
    assert!(of_steps(["ditch", "wall"]).contains("re-entrant at (1.000000, 0.000000, 1.000000)"));
    assert!(of_steps(["treads", "risers"]).contains("pieces"), "{}", of_steps(["treads", "risers"]));
}
