//! Plasticity at a point: cycles, differences, indifference, energies.

use nalgebra::{Matrix3, Rotation3, Vector3};
use signorini_material::law::*;
use signorini_material::{Elastic, Space, StressLaw};

const ELASTIC: Elastic = Elastic { youngs_modulus: 1000.0, poissons_ratio: 0.3 };

fn law(points: &[[f64; 2]], slope: f64, kinematic: f64, is_finite: bool) -> StressLaw {
    let hardening = Hardening::new(points, slope).unwrap();
    StressLaw::ElasticPlastic(ElasticPlastic { hardening, kinematic, is_finite })
}

fn matrix(t: &Tensor) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| t[3 * i + j])
}

/// The stress along a bar at an axial displacement gradient: the lateral one is that without stress, by Newton's method. The
/// history is renewed; the energy dissipated.
fn bar(law: &StressLaw, stretch: f64, history: &mut Vec<f64>) -> (f64, f64, f64) {
    let mut lateral = 1.0;
    for _ in 0..60 {
        let f = Matrix3::from_diagonal(&[stretch, lateral, lateral].into());
        let at = law.response_from(&ELASTIC, &f, history).unwrap();
        let step = at.stress[4] / (at.tangent[(4, 4)] + at.tangent[(4, 8)]);
        lateral -= step;
        if step.abs() < 1e-15 {
            break;
        }
    }
    let f = Matrix3::from_diagonal(&[stretch, lateral, lateral].into());
    let stress = law.response_from(&ELASTIC, &f, history).unwrap().stress[0];
    let found = law.plastic(&ELASTIC, Space::Solid, &f, history).unwrap();
    *history = found.history;
    (stress, lateral, found.dissipated)
}

/// A bar of one dimension by hand: Young's modulus, isotropic and kinematic hardening; plastic strain and yield stress.
struct Bilinear {
    moduli: [f64; 3],
    plastic: f64,
    yields: f64,
}

impl Bilinear {
    /// The stress at a strain, and the energy that was dissipated on the way.
    fn stretched(&mut self, strain: f64) -> [f64; 2] {
        let [e, isotropic, kinematic] = self.moduli;
        let trial = e * (strain - self.plastic) - kinematic * self.plastic;
        let over = trial.abs() - self.yields;
        let mut taken = 0.0;
        if over > 0.0 {
            let step = over / (e + isotropic + kinematic);
            taken = (self.yields + 0.5 * isotropic * step) * step;
            self.plastic += step * trial.signum();
            self.yields += isotropic * step;
        }
        [e * (strain - self.plastic), taken]
    }
}

/// A bar that is drawn, pushed and drawn again: bilinear with isotropic hardening, with kinematic, with both; and the work done is
/// what is stored and dissipated.
#[test]
fn a_cycle_of_a_bar_is_bilinear() {
    let (e, y) = (1000.0, 2.0);
    for [isotropic, kinematic] in [[100.0, 0.0], [0.0, 100.0], [40.0, 60.0], [0.0, 0.0]] {
        let law = law(&[[y, 0.0]], isotropic, kinematic, false);
        let mut history = law.start();
        let mut by_hand = Bilinear { moduli: [e, isotropic, kinematic], plastic: 0.0, yields: y };
        for strain in [0.001, 0.004, 0.01, 0.006, -0.002, -0.012, 0.003, 0.02] {
            let (stress, _, dissipated) = bar(&law, 1.0 + strain, &mut history);
            let [exact, taken] = by_hand.stretched(strain);
            assert!((stress - exact).abs() < 1e-10, "{isotropic} {kinematic} at {strain}: {stress} {exact}");
            assert!((dissipated - taken).abs() < 1e-13, "{dissipated} {taken}");
        }
    }
}

/// At finite strain the same cycle holds for Kirchhoff stress and logarithmic strain, drawn to 1.6 times the length and pressed to
/// half of it; what is done is stored and dissipated.
#[test]
fn a_large_cycle_of_a_bar_is_bilinear() {
    let (e, y, isotropic, kinematic) = (1000.0, 2.0, 3.0, 7.0);
    let law = law(&[[y, 0.0]], isotropic, kinematic, true);
    let mut history = law.start();
    let mut by_hand = Bilinear { moduli: [e, isotropic, kinematic], plastic: 0.0, yields: y };
    for strain in [0.001, 0.1, 0.47, 0.4, -0.2, -0.69, -0.688, 0.3] {
        let stretch = f64::exp(strain);
        let (stress, lateral, dissipated) = bar(&law, stretch, &mut history);
        let [exact, taken] = by_hand.stretched(strain);
        assert!((stress * stretch - exact).abs() < 1e-9, "at {strain}: {} {exact}", stress * stretch);
        assert!((lateral.ln() + 0.3 * exact / e + 0.5 * by_hand.plastic).abs() < 1e-12);
        assert!((dissipated - taken).abs() < 1e-12, "{dissipated} {taken}");
        let f = Matrix3::from_diagonal(&[stretch, lateral, lateral].into());
        // Nothing moves: the state that was reached is the one that goes on.
        let again = law.plastic(&ELASTIC, Space::Solid, &f, &history).unwrap();
        assert!((again.history[0] - history[0]).abs() < 1e-13);
        let energy = law.response_from(&ELASTIC, &f, &history).unwrap().energy;
        assert!((energy - 0.5 * exact * exact / e - 0.5 * kinematic * by_hand.plastic.powi(2)).abs() < 1e-11);
    }
}

/// Principal axes that turn: a modulus of kinematic hardening that hardly counts gives what none gives; the back stress of a
/// simple shear grows to the end.
#[test]
fn large_shear_with_kinematic_hardening() {
    let shear = |kinematic: f64, steps: usize| {
        let law = law(&[[2.0, 0.0]], 0.5, kinematic, true);
        let mut history = law.start();
        let mut list = Vec::new();
        for k in 1..=steps {
            let mut f = Matrix3::identity();
            f[(0, 1)] = 2.5 * k as f64 / steps as f64;
            let at = law.response_from(&ELASTIC, &f, &history).unwrap();
            list.push((matrix(&at.stress) * f.transpose())[(0, 1)]);
            history = law.plastic(&ELASTIC, Space::Solid, &f, &history).unwrap().history;
        }
        list
    };
    let (without, little) = (shear(0.0, 40), shear(1e-9, 40));
    assert!(without.iter().zip(&little).all(|(a, b)| (a - b).abs() < 1e-7), "{without:?} {little:?}");
    let much = shear(1.5, 40);
    assert!(much.windows(2).all(|w| w[1] > w[0]), "{much:?}");
    // Rigid-plastic: the stress of the isotropic part, and that of Hencky's energy of the whole strain.
    let mut v: Matrix3<f64> = Matrix3::identity();
    v[(0, 1)] = 2.5;
    let eigen = (v * v.transpose()).symmetric_eigen();
    let logarithms = Matrix3::from_diagonal(&eigen.eigenvalues.map(|c| 0.5 * c.ln()));
    let back = (eigen.eigenvectors * logarithms * eigen.eigenvectors.transpose())[(0, 1)] * (2.0 / 3.0 * 1.5);
    let found = much[39] - without[39];
    assert!((found / back - 1.0).abs() < 0.02, "{found} {back}");
}

/// A table is followed exactly: also over several of its rows at once, and beyond the last.
#[test]
fn tables_are_followed_row_by_row() {
    let law = law(&[[2.0, 0.0], [3.0, 0.01], [3.5, 0.05]], 0.0, 0.0, false);
    for (plastic, stress) in [(0.005, 2.5), (0.03, 3.25), (0.2, 3.5)] {
        let (found, _, dissipated) = bar(&law, 1.0 + stress / 1000.0 + plastic, &mut law.start());
        assert!((found - stress).abs() < 1e-11, "{found} {stress}");
        let area: f64 = match plastic {
            0.005 => 2.25 * 0.005,
            0.03 => 0.025 + 0.5 * (3.0 + 3.25) * 0.02,
            _ => 0.025 + 3.25 * 0.04 + 3.5 * 0.15,
        };
        assert!((dissipated - area).abs() < 1e-12);
    }
    assert!(matches!(Hardening::new(&[[2.0, 0.0], [1.5, 0.1]], 0.0), Err(HardeningError::Softening { row: 2, .. })));
    assert!(matches!(Hardening::new(&[[2.0, 0.1]], 0.0), Err(HardeningError::Start { .. })));
    assert!(matches!(Hardening::new(&[[0.0, 0.0]], 0.0), Err(HardeningError::NotPositive { .. })));
}

/// At finite strain a bar carries `σ_y(ln λ - σ/E)` of true stress, whatever the steps; its plastic volume stays, and
/// unloaded it keeps its plastic stretch.
#[test]
fn large_stretches_of_a_bar_are_exact() {
    let (y, slope, e) = (2.0, 10.0, 1000.0);
    let law = law(&[[y, 0.0]], slope, 0.0, true);
    for steps in [1, 7] {
        let mut history = law.start();
        let (mut stress, mut lateral) = (0.0, 1.0);
        let longest: f64 = 2.5;
        for k in 1..=steps {
            (stress, lateral, _) = bar(&law, longest.powf(k as f64 / steps as f64), &mut history);
        }
        // Kirchhoff stress τ = y + slope ε_p, ln λ = τ/E + ε_p.
        let tau = (y + slope * longest.ln()) / (1.0 + slope / e);
        let kirchhoff = stress * longest;
        assert!((kirchhoff - tau).abs() < 1e-10, "{steps}: {kirchhoff} {tau}");
        // ln λ_lateral = -ν τ/E - ε_p/2.
        let exact = -0.3 * tau / e - 0.5 * (longest.ln() - tau / e);
        assert!((lateral.ln() - exact).abs() < 1e-12);
        let a = Matrix3::from_fn(|i, j| history[1 + 3 * i + j]);
        assert!((a.determinant() - 1.0).abs() < 1e-13);
        let (unloaded, _, dissipated) = bar(&law, (longest.ln() - tau / e).exp(), &mut history);
        assert!(unloaded.abs() < 1e-10 && dissipated == 0.0, "{unloaded}");
    }
}

/// Stress at a strain with a history from another: on both sides of yield the tangent is the derivative.
#[test]
fn the_tangent_is_that_of_the_algorithm() {
    let some = Matrix3::new(0.6, 0.4, -0.2, -0.3, -0.5, 0.25, 0.1, -0.4, 0.3);
    let before = Matrix3::new(-0.2, 0.5, 0.3, 0.1, 0.4, -0.2, 0.3, 0.2, -0.1);
    let table: &[[f64; 2]] = &[[2.0, 0.0], [3.0, 0.02], [3.2, 0.2]];
    for (law, size) in [
        (law(table, 5.0, 40.0, false), 1e-3),
        (law(table, 5.0, 40.0, false), 2e-2),
        (law(table, 5.0, 0.0, true), 1e-3),
        (law(table, 5.0, 0.0, true), 2e-2),
        (law(table, 5.0, 0.0, true), 0.4),
        (law(table, 5.0, 40.0, true), 1e-3),
        (law(table, 5.0, 40.0, true), 2e-2),
        (law(table, 5.0, 40.0, true), 0.4),
    ] {
        let first = Matrix3::identity() + before * (0.5 * size);
        let history = law.plastic(&ELASTIC, Space::Solid, &first, &law.start()).unwrap().history;
        let there = Matrix3::identity() + some * size;
        let at = |f: &Matrix3<f64>| law.response_from(&ELASTIC, f, &history).unwrap();
        let here = at(&there);
        let h = 1e-4 * size;
        for k in 0..9 {
            let moved = |h: f64| {
                let mut f = there;
                f[(k / 3, k % 3)] += h;
                at(&f).stress
            };
            // A difference of fourth order.
            let near = (moved(h) - moved(-h)) * (2.0 / (3.0 * h));
            let column = near - (moved(2.0 * h) - moved(-2.0 * h)) / (12.0 * h);
            let error = (column - here.tangent.column(k)).norm() / here.tangent.norm();
            assert!(error < 1e-8, "{} {size}: {error:e}", law.name());
        }
        assert!((here.tangent - here.tangent.transpose()).norm() < 1e-12 * here.tangent.norm());
        let plastic = law.plastic(&ELASTIC, Space::Solid, &there, &history).unwrap().history[0] > history[0];
        assert_eq!(plastic, size > 1e-3, "{} {size}", law.name());
    }
}

/// Turned in space the stress turns with it, and the history stays; in principal directions that coincide too. A simple shear
/// to 3 has the shear stress `σ_y/√3` of large strain within the elastic strain.
#[test]
fn finite_plasticity_is_indifferent_to_the_frame() {
    for kinematic in [0.0, 4.0] {
        indifferent(&law(&[[2.0, 0.0]], 1.0, kinematic, true));
    }
    let perfect = self::law(&[[2.0, 0.0]], 0.0, 0.0, true);
    let (mut history, steps) = (perfect.start(), 3000);
    let mut shear = 0.0;
    for k in 1..=steps {
        let mut f = Matrix3::identity();
        f[(0, 1)] = 3.0 * k as f64 / steps as f64;
        let at = perfect.response_from(&ELASTIC, &f, &history).unwrap();
        shear = (matrix(&at.stress) * f.transpose())[(0, 1)];
        history = perfect.plastic(&ELASTIC, Space::Solid, &f, &history).unwrap().history;
    }
    assert!((shear - 2.0 / 3f64.sqrt()).abs() < 2e-3, "{shear}");
    // Its equivalent plastic strain is γ/√3 less the elastic one.
    assert!((history[0] - 3.0 / 3f64.sqrt()).abs() < 3e-3, "{}", history[0]);
}

fn indifferent(law: &StressLaw) {
    let path = [
        Matrix3::from_diagonal(&[1.3, 1.0 / 1.3f64.sqrt(), 1.0 / 1.3f64.sqrt()].into()),
        Matrix3::new(1.4, 0.3, 0.0, -0.2, 0.9, 0.1, 0.0, 0.2, 0.85),
        Matrix3::new(1.4, 0.9, 0.0, -0.2, 0.9, 0.1, 0.3, 0.2, 0.85),
    ];
    let (mut history, mut turned) = (law.start(), law.start());
    for (k, f) in path.iter().enumerate() {
        let r = Rotation3::new(Vector3::new(0.4, 2.1, -0.9) * k as f64).into_inner();
        let here = law.response_from(&ELASTIC, f, &history).unwrap();
        let there = law.response_from(&ELASTIC, &(r * f), &turned).unwrap();
        assert!((matrix(&there.stress) - r * matrix(&here.stress)).norm() < 1e-11);
        history = law.plastic(&ELASTIC, Space::Solid, f, &history).unwrap().history;
        turned = law.plastic(&ELASTIC, Space::Solid, &(r * f), &turned).unwrap().history;
        assert!(history.iter().zip(&turned).all(|(a, b)| (a - b).abs() < 1e-12));
    }
}

/// Paths of plane stress at small strain, and of the logarithms of the stretches and Kirchhoff's stress at finite strain: one
/// direction, two equal ones, pure shear. In one increment and in three, with the strain across by the volume.
#[test]
fn plane_stress_is_exact_along_straight_paths() {
    let (e, nu, y, h) = (1000.0, 0.3, 2.0, 50.0);
    let mu = 0.5 * e / (1.0 + nu);
    let root = 3f64.sqrt();
    for is_finite in [false, true] {
        let law = law(&[[y, 0.0]], h, 0.0, is_finite);
        // Of the equivalent plastic strain: stresses and strains in the plane.
        let paths: [fn(f64, f64, [f64; 4]) -> ([f64; 2], [f64; 2]); 3] = [
            |s, a, [e, nu, ..]| ([s, 0.0], [s / e + a, -nu * s / e - 0.5 * a]),
            |s, a, [e, nu, ..]| ([s, s], [s * (1.0 - nu) / e + 0.5 * a, s * (1.0 - nu) / e + 0.5 * a]),
            |s, a, [_, _, mu, root]| {
                let (t, x) = (s / root, s / root / (2.0 * mu) + 0.5 * root * a);
                ([t, -t], [x, -x])
            },
        ];
        for (path, of) in paths.iter().enumerate() {
            for increments in [1, 3] {
                let mut history = law.start();
                for k in 1..=increments {
                    let alpha = 0.06 * k as f64 / increments as f64;
                    let (stress, strain) = of(y + h * alpha, alpha, [e, nu, mu, root]);
                    let stretch = strain.map(|x| if is_finite { x.exp() } else { 1.0 + x });
                    let f = Matrix3::from_diagonal(&[stretch[0], stretch[1], 1.0].into());
                    let at = law.plane_stress(&ELASTIC, &f, &history).unwrap();
                    let piola = matrix(&at.stress);
                    for i in 0..2 {
                        let found = if is_finite { piola[(i, i)] * stretch[i] } else { piola[(i, i)] };
                        assert!((found - stress[i]).abs() < 1e-10, "{is_finite} path {path}: {found} {}", stress[i]);
                    }
                    assert!(piola[(2, 2)].abs() < 1e-10, "{is_finite} path {path}: {} across", piola[(2, 2)]);
                    history = law.plastic(&ELASTIC, Space::PlaneStress, &f, &history).unwrap().history;
                    assert!((history[0] - alpha).abs() < 1e-12);
                }
            }
        }
    }
}

/// The condensed tangent is the derivative of the stress, loading and unloading, with both kinds of hardening.
#[test]
fn the_tangent_of_plane_stress_is_that_of_the_algorithm() {
    for (kinematic, is_finite) in [(0.0, false), (80.0, false), (0.0, true), (80.0, true)] {
        let law = law(&[[2.0, 0.0], [3.0, 0.02]], 20.0, kinematic, is_finite);
        let f = Matrix3::new(1.012, 0.004, 0.0, 0.002, 0.997, 0.0, 0.0, 0.0, 1.0);
        let history = law.plastic(&ELASTIC, Space::PlaneStress, &f, &law.start()).unwrap().history;
        for there in [Matrix3::new(1.02, 0.01, 0.0, 0.005, 0.99, 0.0, 0.0, 0.0, 1.0), f * 0.9995] {
            let tangent = law.plane_stress(&ELASTIC, &there, &history).unwrap().tangent;
            let scale = tangent.amax();
            for (k, l) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let at = |h: f64| {
                    let mut moved = there;
                    moved[(k, l)] += h;
                    law.plane_stress(&ELASTIC, &moved, &history).unwrap().stress
                };
                let slope = (at(1e-6) - at(-1e-6)) / 2e-6;
                for c in [0, 1, 3, 4] {
                    let error = (slope[c] - tangent[(c, 3 * k + l)]).abs() / scale;
                    assert!(error < 1e-8, "{kinematic} {is_finite}: {error:e} of {c} by {k}{l}");
                }
            }
        }
    }
}
