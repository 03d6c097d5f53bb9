//! Residual and tangent of contact at finite gaps: every pair, method and state, for functions of degree 1, 2 and 5.

use signorini_contact::*;
use signorini_fem::block::block;
use signorini_geometry::Point;
use signorini_solid::*;
use std::collections::HashSet;

/// Numbers in -1..1, the same on every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self, n: usize, size: f64) -> Vec<f64> {
        (0..n).map(|_| size * self.next()).collect()
    }
}

/// A plate that reaches beyond a block below it on all sides, both displaced at random: its points are over faces, edges
/// and corners of the block.
struct Scene<const D: usize> {
    bodies: Bodies<D>,
    slave: BodySurface<D>,
    master: BodySurface<D>,
    u: Vec<f64>,
}

fn scene<const D: usize>(degree: usize, height: f64, cells: usize) -> Scene<D> {
    let up = D - 1;
    let mesh = |low: f64, high: f64, width: f64, n: usize| {
        let axes: [Vec<f64>; D] = std::array::from_fn(|k| {
            if k == up { vec![low, high] } else { (0..=n).map(|i| width * (i as f64 / n as f64 - 0.5)).collect() }
        });
        block::<D>(&axes, 1, |x| x)
    };
    let (lower, upper) = (mesh(-0.5, 0.0, 1.0, cells), mesh(height, height + 0.4, 1.7, cells + 1));
    let groups = [lower.groups().clone(), upper.groups().clone()];
    let mut bodies = Bodies::<D>::new(if D == 2 { Space::PlaneStrain } else { Space::Solid });
    let material = Elastic { youngs_modulus: 1.0, poissons_ratio: 0.3 };
    bodies.add("lower", lower, degree, material);
    bodies.add("upper", upper, degree, material);
    let slave = bodies.surface(1, groups[1]["bottom"].sides.clone());
    let master = bodies.surface(0, groups[0]["top"].sides.clone());
    let mut random = Random(7 + degree as u64);
    let u = random.vector(bodies.unknowns(), 0.04 / degree as f64);
    Scene { bodies, slave, master, u }
}

impl<const D: usize> Scene<D> {
    fn tests(&self, method: Method, rigid: bool) -> Tests {
        let nodes = PressureNodes::new(&self.slave);
        match method {
            Method::Node => Tests::at_nodes(&self.slave, &nodes, &[]),
            Method::GaussPoint => Tests::at_quadrature_points(&self.slave),
            Method::Mortar => {
                let [slave, master] = [&self.slave, &self.master].map(|surface| Moved { surface, u: &self.u });
                let points = if rigid {
                    rigid_points(&self.slave, &|_| GapJet::flat(0.0, Point::<D>::zeros()))
                } else {
                    segments(&slave, &master, &PressureNodes::new(&slave), 1.0)
                };
                Tests::in_the_mean(&points, &shares(&self.slave, &nodes, &points, &|_| false))
            }
        }
    }

    fn measure(&self, tests: &Tests, u: &[f64], rigid: bool) -> Measured {
        let [slave, master] = [&self.slave, &self.master].map(|surface| Moved { surface, u });
        let centre = Point::<D>::from_fn(|k, _| if k + 1 == D { -0.9 } else { 0.1 });
        let ball = move |x: &Point<D>| GapJet::ball(x, &centre, 1.0);
        if rigid {
            tests.measure(&slave, &Rigid(&ball), f64::INFINITY, true)
        } else {
            tests.measure(&slave, &Faces::new(&master).unwrap(), f64::INFINITY, true)
        }
    }

    /// `Wx` for an infinitesimal rotation, and a translation, of the bodies where they are now.
    fn rigid_motions(&self) -> Vec<Vec<f64>> {
        let mut modes = Vec::new();
        for i in 0..D {
            for j in 0..=i {
                let mut mode = vec![0.0; self.u.len()];
                for body in &self.bodies.list {
                    for f in 0..body.dofs.count() {
                        let at = body.first + D * f;
                        let node = (0..body.mesh.nodes().len()).find(|n| body.dofs.vertex(*n as u32) == Some(f as u32));
                        let rest = node.map_or(Point::<D>::zeros(), |n| body.mesh.nodes()[n]);
                        if i == j {
                            mode[at + i] = f64::from(u8::from(node.is_some()));
                        } else {
                            (mode[at + i], mode[at + j]) = (rest[j] + self.u[at + j], -rest[i] - self.u[at + i]);
                        }
                    }
                }
                modes.push(mode);
            }
        }
        modes
    }
}

/// How a row answers its gap.
#[derive(Clone, Copy, Debug)]
enum Law {
    /// The pressure is an unknown of its own.
    Multiplier,
    /// `λ = max(0, shift - g / compliance)`: a penalty with no shift, else a step of the augmented Lagrangian.
    Soft(Softness),
}

/// Residual of forces and conditions at a displacement and pressures.
struct Residual {
    forces: Vec<f64>,
    conditions: Vec<f64>,
}

struct Problem<'a, const D: usize> {
    scene: &'a Scene<D>,
    tests: Tests,
    rigid: bool,
    laws: Vec<Law>,
    /// Rows in contact, by number of the test.
    closed: Vec<bool>,
}

impl<const D: usize> Problem<'_, D> {
    fn pressure(&self, row: usize, gap: f64, multiplier: f64) -> f64 {
        match (self.closed[row], self.laws[row]) {
            (false, _) => 0.0,
            (true, Law::Multiplier) => multiplier,
            (true, Law::Soft(soft)) => soft.shift - gap / soft.compliance,
        }
    }

    fn residual(&self, u: &[f64], multipliers: &[f64]) -> Residual {
        let measured = self.scene.measure(&self.tests, u, self.rigid);
        let mut out = Residual { forces: vec![0.0; u.len()], conditions: vec![0.0; self.tests.rows.len()] };
        for (k, row) in measured.rows(&self.tests) {
            let pressure = self.pressure(k, row.gap, multipliers[k]);
            for (unknown, c) in &row.terms {
                out.forces[*unknown as usize] -= c * pressure;
            }
            out.conditions[k] = match (self.closed[k], self.laws[k]) {
                (true, Law::Multiplier) => row.gap,
                (false, Law::Multiplier) => multipliers[k],
                _ => 0.0,
            };
        }
        out
    }

    /// The derivative of the residual along a direction.
    fn tangent(&self, u: &[f64], multipliers: &[f64], du: &[f64], dm: &[f64]) -> Residual {
        let measured = self.scene.measure(&self.tests, u, self.rigid);
        let mut out = Residual { forces: vec![0.0; u.len()], conditions: vec![0.0; self.tests.rows.len()] };
        let mut pressures = vec![0.0; self.tests.rows.len()];
        for (k, row) in measured.rows(&self.tests) {
            pressures[k] = self.pressure(k, row.gap, multipliers[k]);
            let along: f64 = row.terms.iter().map(|(unknown, c)| c * du[*unknown as usize]).sum();
            let (pressure, condition) = match (self.closed[k], self.laws[k]) {
                (true, Law::Multiplier) => (dm[k], along),
                (false, Law::Multiplier) => (0.0, dm[k]),
                (true, Law::Soft(soft)) => (-along / soft.compliance, 0.0),
                (false, Law::Soft(_)) => (0.0, 0.0),
            };
            for (unknown, c) in &row.terms {
                out.forces[*unknown as usize] -= c * pressure;
            }
            out.conditions[k] = condition;
        }
        for (unknowns, matrix) in measured.curvature(&self.tests, &pressures) {
            let n = unknowns.len();
            for r in 0..n {
                for c in 0..n {
                    out.forces[unknowns[r] as usize] += matrix[r * n + c] * du[unknowns[c] as usize];
                    assert_eq!(matrix[r * n + c], matrix[c * n + r]);
                }
            }
        }
        out
    }

    /// Orders of the Taylor remainders of forces and conditions along a direction.
    fn check(&self, u: &[f64], multipliers: &[f64], du: &[f64], dm: &[f64], name: &str) {
        let (at, slope) = (self.residual(u, multipliers), self.tangent(u, multipliers, du, dm));
        let size = norm(&slope.forces) + norm(&slope.conditions);
        let remainders: Vec<f64> = [4e-5, 2e-5, 1e-5]
            .iter()
            .map(|t| {
                let add = |a: &[f64], b: &[f64]| -> Vec<f64> { a.iter().zip(b).map(|(a, b)| a + t * b).collect() };
                let moved = self.residual(&add(u, du), &add(multipliers, dm));
                let rest = |a: &[f64], b: &[f64], s: &[f64]| -> f64 {
                    a.iter().zip(b).zip(s).map(|((a, b), s)| (a - b - t * s).powi(2)).sum()
                };
                let forces = rest(&moved.forces, &at.forces, &slope.forces);
                (forces + rest(&moved.conditions, &at.conditions, &slope.conditions)).sqrt()
            })
            .collect();
        // A remainder of rounding has no order.
        if remainders[0] <= 1e-12 * size {
            return;
        }
        for pair in remainders.windows(2) {
            let order = (pair[0] / pair[1]).log2();
            assert!((order - 2.0).abs() < 0.2, "{name}: order {order}, remainders {remainders:?} of {size}");
        }
    }
}

fn norm(v: &[f64]) -> f64 {
    v.iter().map(|v| v * v).sum::<f64>().sqrt()
}

fn check_all<const D: usize>(degree: usize, cells: usize) {
    let soft = |compliance: f64, shift: f64| Law::Soft(Softness { compliance, shift });
    for (height, rigid) in [(0.25, false), (-0.2, false), (0.02, true)] {
        let scene = scene::<D>(degree, height, cells);
        let motions = scene.rigid_motions();
        for method in [Method::Node, Method::GaussPoint, Method::Mortar] {
            // Closest points on faces of degree 5 in space take their time: nodes stand for the other points.
            if D == 3 && degree == 5 && !rigid && (method != Method::Node || height < 0.0) {
                continue;
            }
            let tests = scene.tests(method, rigid);
            let count = tests.rows.len();
            let mut random = Random(11);
            for law in [Law::Multiplier, soft(0.3, 0.0), soft(0.3, 1.5)] {
                let name =
                    format!("{D} dimensions, degree {degree}, {method:?}, {law:?}, height {height}, rigid {rigid}");
                let closed = (0..count).map(|_| random.next() > -0.5).collect();
                let problem = Problem { scene: &scene, tests: tests.clone(), rigid, laws: vec![law; count], closed };
                let multipliers: Vec<f64> = (0..count).map(|_| 1.0 + 0.5 * random.next()).collect();
                let (du, dm) = (random.vector(scene.u.len(), 0.3 / degree as f64), random.vector(count, 0.3));
                problem.check(&scene.u, &multipliers, &du, &dm, &name);
                if rigid {
                    continue;
                }
                // The forces have neither resultant nor moment, whatever the gap.
                let forces = problem.residual(&scene.u, &multipliers).forces;
                let size: f64 = forces.iter().map(|f| f.abs()).sum();
                for motion in &motions {
                    let work: f64 = forces.iter().zip(motion).map(|(f, m)| f * m).sum();
                    assert!(work.abs() < 1e-13 * size, "{name}: {work:e} of {size}");
                }
            }
        }
    }
}

#[test]
fn tangents_in_the_plane() {
    for degree in [1, 2, 5] {
        check_all::<2>(degree, 2);
    }
}

#[test]
fn tangents_in_space() {
    check_all::<3>(1, 2);
    check_all::<3>(2, 1);
    check_all::<3>(5, 1);
}

/// A point a hair's breadth from where its partner or its state changes, moving away from there.
#[test]
fn tangents_beside_a_switch() {
    for degree in [1, 2, 5] {
        let mut scene = scene::<3>(degree, 0.2, 1);
        scene.u.iter_mut().for_each(|u| *u = 0.0);
        // The plate is 1.7 wide, the block 1: its sides are at s = 1 / 1.7, over which faces turn into edges and corners.
        let side = 1.0 / 1.7;
        let mut seen = HashSet::new();
        for away in [1e-12, -1e-12, 1e-6, -1e-6] {
            for (p, q) in [(side, 0.1), (side, side)] {
                let places = [(p + away, q), (p + away, q + away), (p + away, q - away)];
                for (s, t) in places {
                    // In cells of the plate, 2 each way, from -1 to 1.
                    let local = |v: f64| 2.0 * (v - 0.5);
                    let face = (0..scene.slave.face_count())
                        .find(|&f| {
                            let x = scene.slave.at(f, &[0.0; 3]).x;
                            x[0] > 0.0 && x[1] > 0.0
                        })
                        .unwrap();
                    let at = scene.slave.at(face, &[local(s), local(t), 0.0]);
                    // Local axes of the face may be in the other order.
                    let swapped = (at.x[0] - 0.85 * s).abs() > 1e-9;
                    let (a, b) = if swapped { (t, s) } else { (s, t) };
                    let place = [local(a), local(b), 0.0];
                    let x = scene.slave.at(face, &place).x;
                    seen.insert((x[0] > 0.5, x[1] > 0.5));
                    let tests = Tests {
                        points: vec![TestPoint { face, s: place, shares: vec![(0, 1.0)] }],
                        rows: vec![TestRow { number: 0, weight: 1.0, place: None }],
                    };
                    // The plate moves away from the switch, and its gap away from where the contact opens.
                    let mut random = Random(3);
                    let mut du = random.vector(scene.u.len(), 0.05);
                    for body in &scene.bodies.list[1..] {
                        for f in 0..body.dofs.count() {
                            let vertex =
                                (0..body.mesh.nodes().len() as u32).any(|n| body.dofs.vertex(n) == Some(f as u32));
                            for k in 0..2 {
                                let push = if x[k] > 0.5 { 1.0 } else { -1.0 };
                                du[body.first + 3 * f + k] += if vertex { 0.5 * push } else { 0.0 };
                            }
                        }
                    }
                    let measured = scene.measure(&tests, &scene.u, false);
                    let gap = measured.rows(&tests)[0].1.gap;
                    for closeness in [1e-12, -1e-12] {
                        // λ = shift - g / c is 1e-12 beside zero.
                        let law = Softness { compliance: 0.3, shift: gap / 0.3 + closeness };
                        let problem = Problem {
                            scene: &scene,
                            tests: tests.clone(),
                            rigid: false,
                            laws: vec![Law::Soft(law)],
                            closed: vec![closeness > 0.0],
                        };
                        problem.check(&scene.u, &[0.0], &du, &[0.0], &format!("degree {degree}, {away}, {x:?}"));
                        // The state is the one that the law itself takes, and stays so on the way.
                        assert_eq!(law.shift - gap / law.compliance > 0.0, closeness > 0.0);
                    }
                    let problem =
                        Problem { scene: &scene, tests, rigid: false, laws: vec![Law::Multiplier], closed: vec![true] };
                    problem.check(&scene.u, &[1e-12], &du, &[0.4], &format!("degree {degree}, {away}, {x:?}"));
                }
            }
        }
        assert_eq!(seen.len(), 4, "faces, two edges, a corner: {seen:?}");
    }
}
