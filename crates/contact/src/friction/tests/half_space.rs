//! Spheres in space, of no Poisson's ratio: pressed, shifted to and fro and round.

use super::*;
use signorini_verify::friction::Spheres;

const EXACT: Spheres = Spheres { modulus: 1.0, poissons_ratio: 0.0, radius: 2.0, friction: 0.3, force: 0.5 };

/// Square cells of even pressure somewhat beyond the contact.
struct HalfSpace {
    x: Vec<[f64; 2]>,
    h: f64,
    kernel: DMatrix<f64>,
}

impl HalfSpace {
    fn new(cells: usize) -> Self {
        let width = 1.2 * EXACT.contact_radius();
        let h = 2.0 * width / cells as f64;
        let at = |k: usize| -width + (k as f64 + 0.5) * h;
        let x: Vec<[f64; 2]> = (0..cells * cells).map(|k| [at(k % cells), at(k / cells)]).collect();
        // The integral of 1/r over a rectangle with a corner at the origin (Love 1929).
        let corner = |x: f64, y: f64| x * (y / x.abs()).asinh() + y * (x / y.abs()).asinh();
        let kernel = DMatrix::from_fn(x.len(), x.len(), |i, j| {
            let [[l, r], [b, t]] = [0, 1].map(|k| [-0.5, 0.5].map(|s| x[i][k] - x[j][k] + s * h));
            (corner(r, t) - corner(l, t) - corner(r, b) + corner(l, b)) / (std::f64::consts::PI * EXACT.modulus)
        });
        HalfSpace { x, h, kernel }
    }

    /// The solves, the level and the tangential force of each of a list of shifts.
    fn path(&self, law: &Coulomb, shifts: &[[f64; 2]]) -> Vec<(usize, usize, [f64; 2], Solution)> {
        let n = self.x.len();
        let area = self.h * self.h;
        let nodes = nodes(n, 2, law);
        let problem = Problem { nodes: &nodes, equations: &[] };
        let w = DMatrix::from_fn(
            3 * n,
            3 * n,
            |i, j| if i % 3 == j % 3 { area * self.kernel[(i / 3, j / 3)] } else { 0.0 },
        );
        let mut known = Known { w, q: vec![0.0; 3 * n] };
        let (mut z, mut slip) = (vec![0.0; 3 * n], vec![0.0; 3 * n]);
        let mut out = Vec::new();
        for shift in shifts {
            for (r, q) in known.q.iter_mut().enumerate() {
                let [x, y] = self.x[r / 3];
                *q = match r % 3 {
                    0 => area * ((x * x + y * y) / (2.0 * EXACT.radius) - EXACT.approach(EXACT.force)),
                    k => area * shift[k - 1] - slip[r],
                };
            }
            let found = solve(&problem, &mut known, &z, &mut |_, _| true).unwrap();
            (0..3 * n).filter(|r| r % 3 > 0).for_each(|r| slip[r] += found.y[r]);
            z.clone_from(&found.z);
            let force = [1, 2].map(|k| -area * (0..n).map(|i| z[3 * i + k]).sum::<f64>());
            out.push((found.solves, found.level, force, found));
        }
        out
    }
}

#[test]
fn spheres_follow_cattaneo_and_mindlin() {
    let space = HalfSpace::new(17);
    let law = Coulomb::isotropic(EXACT.friction).unwrap();
    let limit = EXACT.limit();
    // Sideways along an axis that is none of the grid's, to and fro.
    let along = [0.8, 0.6];
    let peak = EXACT.shift(0.75 * limit);
    let turn = peak + EXACT.reversed_shift(-0.75 * limit);
    let list = [0.0, EXACT.shift(0.5 * limit), peak, turn, -peak, peak];
    let found = space.path(&law, &list.map(|s| along.map(|a| a * s)));
    for (wanted, (solves, level, force, _)) in [0.0, 0.5, 0.75, 0.0, -0.75, 0.75].into_iter().zip(&found) {
        assert!(*level == 0 && *solves <= 10, "{wanted}: {solves} solves, level {level}");
        let error = [0, 1].map(|k| force[k] / limit - wanted * along[k]);
        assert!(error[0].hypot(error[1]) < 0.02, "{wanted}: {force:?}");
    }
    let closed = [0, 1].map(|k| (found[2].2[k] - found[5].2[k]).abs());
    assert!(closed[0].max(closed[1]) < 1e-3 * limit, "{closed:?}");
    // The cells that stick lie in a circle.
    let radius = EXACT.stick_radius(0.75 * limit);
    for ([x, y], answer) in space.x.iter().zip(&found[2].3.answers) {
        let r = x.hypot(*y);
        assert!(answer.status != Status::Stick || r < radius + space.h, "{r} {radius}");
        assert!(answer.status != Status::Slip || r > radius - space.h, "{r} {radius}");
    }
}

/// Shifted, back and round a circle, of which one quarter is taken in ten steps; with orthotropic friction too.
#[test]
fn spheres_are_moved_round() {
    let space = HalfSpace::new(13);
    let size = EXACT.shift(0.9 * EXACT.limit());
    let mut shifts = vec![[0.0, 0.0], [size, 0.0], [-size, 0.0]];
    let round = (0..=20).map(|k| std::f64::consts::PI * (1.0 + 0.05 * f64::from(k)));
    shifts.extend(round.map(|a| [size * a.cos(), size * a.sin()]));
    for mu in [[0.3, 0.3], [0.5, 0.2]] {
        let law = Coulomb::orthotropic(mu).unwrap();
        for (k, (solves, level, _, found)) in space.path(&law, &shifts).into_iter().enumerate() {
            assert!(level == 0 && solves <= 10, "{mu:?}, {k}: {solves} solves, level {level}");
            let most = found.z.iter().fold(0.0f64, |m, z| m.max(*z));
            for t in found.z.chunks(3).filter(|t| t[0] > 0.0) {
                assert!(t[0] * (law.utilisation([t[1], t[2]], t[0]) - 1.0) < 1e-7 * most);
            }
        }
    }
}
