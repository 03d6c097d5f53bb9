//! Friction in its rows: closed solutions on half planes, random compliances, single nodes.

mod half_space;

use super::newton::System;
use super::problem::Friction;
use super::*;
use crate::law::{Coulomb, Law, Status};
use nalgebra::DMatrix;
use signorini_solve::SolveError;
use signorini_verify::friction::{HalfPlanes, orthotropic_incline};

/// A compliance that is known.
struct Known {
    w: DMatrix<f64>,
    q: Vec<f64>,
}

impl RowCompliance for Known {
    fn rows(&self) -> usize {
        self.q.len()
    }

    fn require(&mut self, _: &[usize]) -> Result<(), SolveError> {
        Ok(())
    }

    fn column(&self, column: usize) -> &[f64] {
        let n = self.q.len();
        &self.w.as_slice()[column * n..(column + 1) * n]
    }

    fn values(&self, z: &[f64]) -> Result<Vec<f64>, SolveError> {
        let mut y = self.q.clone();
        for (c, t) in z.iter().enumerate() {
            y.iter_mut().zip(self.column(c)).for_each(|(y, w)| *y += w * t);
        }
        Ok(y)
    }
}

fn nodes(count: usize, tangents: usize, law: &dyn Law) -> Vec<Node<'_>> {
    let directions = [[1.0, 0.0], [0.0, 1.0]];
    (0..count).map(|k| Node { first: k * (1 + tangents), tangents, directions, law: Some(law) }).collect()
}

/// The closed solution of half planes with contact from -1 to 1.
const EXACT: HalfPlanes =
    HalfPlanes { modulus: 1.3, radius: 2.0, friction: 0.35, length: 40.0, force: std::f64::consts::PI * 1.3 / 8.0 };

/// Half planes in cells of equal width, somewhat beyond the contact.
struct HalfPlane {
    x: Vec<f64>,
    h: f64,
    kernel: DMatrix<f64>,
}

impl HalfPlane {
    fn new(cells: usize) -> Self {
        let width = 1.25;
        let h = 2.0 * width / cells as f64;
        let x: Vec<f64> = (0..cells).map(|k| -width + (k as f64 + 0.5) * h).collect();
        let integral = |u: f64| u * u.abs().ln() - u;
        let kernel = DMatrix::from_fn(cells, cells, |i, j| {
            let d = (i as f64 - j as f64) * h;
            2.0 / (std::f64::consts::PI * EXACT.modulus)
                * (h * EXACT.length.ln() - integral(d + 0.5 * h) + integral(d - 0.5 * h))
        });
        HalfPlane { x, h, kernel }
    }

    /// Pressed by the whole approach and shifted, from shifts and slips so far.
    fn compliance(&self, shift: f64, before: &[f64]) -> Known {
        let n = self.x.len();
        let w = DMatrix::from_fn(
            2 * n,
            2 * n,
            |i, j| {
                if i % 2 == j % 2 { self.h * self.kernel[(i / 2, j / 2)] } else { 0.0 }
            },
        );
        let depth = EXACT.approach(EXACT.force);
        let q = (0..2 * n).map(|r| {
            let x = self.x[r / 2];
            self.h * if r % 2 == 0 { x * x / (2.0 * EXACT.radius) - depth } else { shift } - before[r]
        });
        Known { w, q: q.collect() }
    }
}

/// What a shift came to.
struct Shifted {
    solves: usize,
    level: usize,
    tangential: f64,
    dissipation: f64,
}

/// A path of shifts.
fn path(plane: &HalfPlane, shifts: &[f64], from_nothing: bool) -> Vec<Shifted> {
    let law = Coulomb::isotropic(EXACT.friction).unwrap();
    let n = plane.x.len();
    let nodes = nodes(n, 1, &law);
    let problem = Problem { nodes: &nodes, equations: &[] };
    let (mut z, mut slip) = (vec![0.0; 2 * n], vec![0.0; 2 * n]);
    let mut out = Vec::new();
    for &shift in shifts {
        let mut w = plane.compliance(shift, &slip);
        let start = if from_nothing { vec![0.0; 2 * n] } else { z };
        let found = solve(&problem, &mut w, &start, &mut |_, _| true).unwrap();
        (0..n).for_each(|k| slip[2 * k + 1] += found.y[2 * k + 1]);
        z = found.z;
        let tangential = -plane.h * (0..n).map(|k| z[2 * k + 1]).sum::<f64>();
        let dissipation = -(0..n).map(|k| z[2 * k + 1] * found.y[2 * k + 1]).sum::<f64>();
        out.push(Shifted { solves: found.solves, level: found.level, tangential, dissipation });
    }
    out
}

/// Paths of the tangential force in parts of the limit, and the shifts that belong to them.
fn sequences() -> Vec<(Vec<f64>, Vec<f64>)> {
    let grown =
        |list: &[f64]| (list.to_vec(), list.iter().map(|q| EXACT.shift(q * EXACT.limit())).collect::<Vec<f64>>());
    let r = |change: f64| EXACT.reversed_shift(change * EXACT.limit());
    let s = |q: f64| EXACT.shift(q * EXACT.limit());
    let slide = 1.3 * s(1.0);
    vec![
        grown(&[0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.99]),
        (vec![0.85, -0.85, 0.85], vec![s(0.85), -s(0.85), s(0.85)]),
        (
            vec![0.6, 0.3, 0.9, -0.2, 0.5, -0.95],
            vec![s(0.6), s(0.6) + r(-0.3), s(0.9), s(0.9) + r(-1.1), s(0.9) + r(-1.1) + r(0.7), -s(0.95)],
        ),
        (vec![1.0, -1.0, 1.0], vec![slide, -slide, slide]),
    ]
}

#[test]
fn half_planes_follow_every_path_without_a_cycle() {
    let plane = HalfPlane::new(127);
    for (forces, shifts) in sequences() {
        for from_nothing in [false, true] {
            let found = path(&plane, &shifts, from_nothing);
            for (wanted, found) in forces.iter().zip(&found) {
                assert!((found.tangential / EXACT.limit() - wanted).abs() < 3e-4, "{wanted}: {}", found.tangential);
                assert!(found.level == 0 && found.solves <= 10, "{wanted}: {} solves", found.solves);
            }
        }
    }
}

/// The stick zone, the traction and the loop against their closed form, better with finer cells.
#[test]
fn half_planes_converge_to_cattaneo_and_mindlin() {
    let loop_of = [0.85, 0.2833333333333333, 0.0, -0.425, -0.85, 0.85];
    let shifts: Vec<f64> = (loop_of.iter().enumerate())
        .map(|(k, q)| {
            let [peak, q] = [0.85, *q].map(|q| q * EXACT.limit());
            EXACT.shift(peak) + if k == 5 { 0.0 } else { EXACT.reversed_shift(q - peak) }
        })
        .collect();
    let mut errors = Vec::new();
    for cells in [63, 127, 255] {
        let plane = HalfPlane::new(cells);
        let found = path(&plane, &shifts, false);
        let error = |(f, wanted): (&Shifted, f64)| (f.tangential / EXACT.limit() - wanted).abs();
        errors.push(found.iter().zip(loop_of).map(error).fold(0.0, f64::max));
        assert!((found[0].tangential - found[5].tangential).abs() < 1e-9 * EXACT.limit(), "the loop does not close");
        // From the peak to its opposite and back.
        let lost: f64 = found[1..].iter().map(|f| f.dissipation).sum();
        assert!((lost / EXACT.dissipation(0.85 * EXACT.limit()) - 1.0).abs() < 0.3 * plane.h, "{lost}");
        // The traction and the edge of the stick zone at half the limit.
        let law = Coulomb::isotropic(EXACT.friction).unwrap();
        let nodes = nodes(cells, 1, &law);
        let problem = Problem { nodes: &nodes, equations: &[] };
        let mut w = plane.compliance(EXACT.shift(0.5 * EXACT.limit()), &vec![0.0; 2 * cells]);
        let found = solve(&problem, &mut w, &vec![0.0; 2 * cells], &mut |_, _| true).unwrap();
        let stick = plane.x.iter().zip(&found.answers).filter(|(_, a)| a.status == Status::Stick);
        let edge = stick.map(|(x, _)| x.abs()).fold(0.0, f64::max);
        let c = EXACT.stick_half_width(0.5 * EXACT.limit());
        assert!((edge - c).abs() < plane.h, "{edge} {c}");
        let most = EXACT.friction * EXACT.peak_pressure();
        for (k, x) in plane.x.iter().enumerate().filter(|(_, x)| (x.abs() - c).abs() > plane.h && x.abs() < 0.95) {
            let exact = EXACT.traction(*x, 0.5 * EXACT.limit());
            assert!((-found.z[2 * k + 1] - exact).abs() < 0.02 * most, "{x}: {} {exact}", found.z[2 * k + 1]);
        }
    }
    assert!(errors.iter().all(|e| *e < 1e-3) && errors[2] < 0.3 * errors[0], "{errors:?}");
}

/// Numbers in -1..1, the same on every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// Compliances whose rows hardly depend on each other, depend strongly, or do as on a surface.
fn random(kind: usize, count: usize, tangents: usize, random: &mut Random) -> Known {
    let n = count * (1 + tangents);
    let mut w = DMatrix::from_fn(n, n, |_, _| random.next());
    w = match kind {
        0 => &w * w.transpose() * (0.1 / n as f64) + DMatrix::identity(n, n),
        1 => &w * w.transpose() / n as f64 + DMatrix::identity(n, n) * 0.02,
        _ => {
            let places: Vec<f64> = (0..n).map(|r| (r / (1 + tangents)) as f64).collect();
            let near = DMatrix::from_fn(n, n, |i, j| {
                let d = (places[i] - places[j]).abs();
                if i % (1 + tangents) == j % (1 + tangents) {
                    (-0.3 * d).exp()
                } else {
                    0.2 * (places[i] - places[j]) * (-0.5 * d).exp()
                }
            });
            // Symmetric and positive definite whatever came out.
            &near * near.transpose() / n as f64 + DMatrix::identity(n, n) * 0.1
        }
    };
    let q = (0..n).map(|r| if r % (1 + tangents) == 0 { random.next() - 0.4 } else { 2.0 * random.next() }).collect();
    Known { w, q }
}

#[test]
fn random_compliances_have_a_state() {
    let mut numbers = Random(3);
    let mut levels = [0usize; 6];
    let mut solves = 0;
    for tangents in [1, 2] {
        for kind in 0..3 {
            for mu in [0.2, 0.6, 1.5] {
                for trial in 0..20 {
                    let count = 3 + trial * 12 / 19;
                    let law = Coulomb::orthotropic([mu, 0.5 * mu]).unwrap();
                    let nodes = nodes(count, tangents, &law);
                    let mut w = random(kind, count, tangents, &mut numbers);
                    let problem = Problem { nodes: &nodes, equations: &[] };
                    let start = vec![0.0; w.q.len()];
                    let found = solve(&problem, &mut w, &start, &mut |_, _| true);
                    let found = found.unwrap_or_else(|e| panic!("{tangents} {kind} {mu} {trial}: {e}"));
                    levels[found.level] += 1;
                    solves += found.solves;
                    // Every node satisfies its law to the accuracy asked for.
                    let residual = problem.residual(&mut w, Friction::Law, (&found.z, &found.y), 1.0).unwrap();
                    assert!(residual.relative <= 1e-8);
                }
            }
        }
    }
    assert_eq!(levels.iter().sum::<usize>(), 360);
    assert!(levels[0] > 250 && solves < 360 * 12, "{levels:?} {solves}");
}

/// With other units of length and force the states are the same.
#[test]
fn units_do_not_matter() {
    let law = Coulomb::isotropic(0.6).unwrap();
    for tangents in [1, 2] {
        for kind in 0..3 {
            let nodes = nodes(12, tangents, &law);
            let problem = Problem { nodes: &nodes, equations: &[] };
            let one = random(kind, 12, tangents, &mut Random(11));
            let mut states = Vec::new();
            for (length, force) in [(1.0, 1.0), (1e-6, 1e6), (1e6, 1e-9)] {
                let mut w = Known { w: &one.w * (length / force), q: one.q.iter().map(|q| q * length).collect() };
                let found = solve(&problem, &mut w, &vec![0.0; one.q.len()], &mut |_, _| true).unwrap();
                let z: Vec<f64> = found.z.iter().map(|z| z / force).collect();
                let status: Vec<Status> = found.answers.iter().map(|a| a.status).collect();
                states.push((status, found.solves, z));
            }
            for (status, solves, z) in &states[1..] {
                assert_eq!((status, solves), (&states[0].0, &states[0].1));
                assert!(z.iter().zip(&states[0].2).all(|(a, b)| (a - b).abs() < 1e-9));
            }
        }
    }
}

/// Above a coefficient of friction of `W_nn/|W_nt|` a node may have three states; the one that slips is unstable.
#[test]
fn three_states_of_one_node() {
    let law = Coulomb::isotropic(2.5).unwrap();
    let nodes = nodes(1, 1, &law);
    let problem = Problem { nodes: &nodes, equations: &[] };
    let mut w = Known { w: DMatrix::from_row_slice(2, 2, &[1.0, -0.6, -0.6, 1.0]), q: vec![0.2, -1.0] };
    let states =
        [([0.0, 0.0], Status::Open, 1.0), ([0.625, 1.375], Status::Stick, 1.0), ([0.4, 1.0], Status::Slip, -1.0)];
    for (z, status, sign) in states {
        let found = solve(&problem, &mut w, &z, &mut |_, _| true).unwrap();
        assert_eq!((found.solves, found.answers[0].status), (0, status));
        let residual = problem.residual(&mut w, Friction::Law, (&found.z, &found.y), 1.0).unwrap();
        assert_eq!(System::new(&problem, &w, Friction::Law, &residual).determinant_sign(), Some(sign));
    }
    // The friction that is unique is less by that factor.
    assert!((2.5 / law.coupling([-0.6, 0.0]) - 1.0 / 0.6).abs() < 1e-15);
}

/// A block on an incline with orthotropic friction: where it begins to slide, and which way.
#[test]
fn a_node_on_an_orthotropic_incline() {
    for (psi, mu) in [(35.0, [0.3, 0.6]), (60.0, [0.4, 0.25]), (20.0, [0.2, 0.5])] {
        let down = f64::to_radians(psi);
        let (critical, onset) = orthotropic_incline(down, mu);
        let law = Coulomb::orthotropic(mu).unwrap();
        let nodes = nodes(1, 2, &law);
        let problem = Problem { nodes: &nodes, equations: &[] };
        let state = |angle: f64| {
            // An elastic support: gap and slip are the tractions less the weight.
            let (s, c) = angle.sin_cos();
            let mut w = Known { w: DMatrix::identity(3, 3), q: vec![-c, s * down.cos(), s * down.sin()] };
            solve(&problem, &mut w, &[0.0; 3], &mut |_, _| true).unwrap()
        };
        let (below, above) = (state(critical * (1.0 - 1e-9)), state(critical * (1.0 + 1e-5)));
        assert_eq!(below.answers[0].status, Status::Stick);
        assert_eq!(above.answers[0].status, Status::Slip);
        let pressure = above.z[0];
        assert!((law.utilisation([above.z[1], above.z[2]], pressure) - 1.0).abs() < 1e-12);
        let direction = above.y[2].atan2(above.y[1]);
        assert!((direction - onset).abs() < 1e-4, "{direction} {onset}");
    }
}
