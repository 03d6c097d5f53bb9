//! Elastic-plastic solids: cycles of a bar, the tube of Hill, stretches at finite strain, runs that go on.

use super::solids::at;
use super::{last_step, set, summary};
use serde_json::{Value, json};
use signorini::run::{Ending, resume, run};
use signorini_solve::{Iteration, Progress, Silent};

fn steps(summary: &Value) -> &[Value] {
    last_step(summary);
    summary["steps"].as_array().expect("steps")
}

/// The force of a bar of 1 by 1 that is drawn and pushed through a cycle of strains, in increments; the law of one dimension by
/// hand. Work is stored and dissipated, so that the audit finds the balance.
#[test]
fn a_bar_goes_through_a_cycle() {
    let strain = |t: f64| 0.01 * (3.0 * t).sin();
    let (e, yields, isotropic, kinematic) = (1000.0, 2.0, 40.0, 60.0);
    let material = format!(
        "elastic_plastic = {{ youngs_modulus = {e}, poissons_ratio = 0.3, yield_stress = {yields}, \
         hardening = {isotropic}, kinematic_hardening = {kinematic} }}"
    );
    let bars = [
        (
            "3d",
            "min = [0, 0, 0], max = [2, 1, 1], cells = [2, 1, 1]",
            "[supports.a]\non = \"bar:left\"\ndisplacement = [0, \"free\", \"free\"]\n\
             [supports.b]\non = \"bar:front\"\ndisplacement = [\"free\", 0, \"free\"]\n\
             [supports.c]\non = \"bar:bottom\"\ndisplacement = [\"free\", \"free\", 0]\n\
             [supports.pull]\non = \"bar:right\"\ndisplacement = [\"0.02*sin(3*t)\", \"free\", \"free\"]\n",
            "/support_forces/pull/0",
            1.0,
        ),
        (
            "axisymmetric",
            "min = [0, 0], max = [1, 2], cells = [2, 2]",
            "[supports.c]\non = \"bar:bottom\"\ndisplacement = [\"free\", 0]\n\
             [supports.pull]\non = \"bar:top\"\ndisplacement = [\"free\", \"0.02*sin(3*t)\"]\n",
            "/support_forces/pull/1",
            std::f64::consts::PI,
        ),
    ];
    for (space, mesh, supports, force, area) in bars {
        let case = format!(
            "space = \"{space}\"\n[bodies.bar.solid]\nmesh.box = {{ {mesh} }}\nmaterial.{material}\n{supports}\
             [[steps]]\nto = 2\nincrements = 20\n"
        );
        let found = summary(&case, &set(&[]));
        let (mut plastic, mut limit, mut dissipated) = (0.0, yields, 0.0);
        for step in steps(&found).iter().filter(|s| at(s, "/time") > 0.0) {
            let strain = strain(at(step, "/time"));
            let trial = e * (strain - plastic) - kinematic * plastic;
            let over = trial.abs() - limit;
            let mut taken = 0.0;
            if over > 0.0 {
                let more = over / (e + isotropic + kinematic);
                taken = (limit + 0.5 * isotropic * more) * more;
                plastic += more * f64::signum(trial);
                limit += isotropic * more;
            }
            dissipated += taken;
            let exact = area * e * (strain - plastic);
            assert!((at(step, force) - exact).abs() < 1e-8, "{space} at {strain}: {} {exact}", at(step, force));
            assert!((at(step, "/plastic_dissipation") - 2.0 * area * taken).abs() < 1e-10, "{step}");
            let path = step["audit"].as_array().unwrap().iter().find(|f| f["check"] == "path").expect("a balance");
            assert_eq!(path["outcome"], "fine", "{path}");
        }
        assert!(dissipated > 0.05, "{dissipated}");
        assert_eq!(found["materials"]["bar"], "elastic-plastic");
    }
}

/// A thick tube in plane strain, without hardening and hardly compressible, by Hill (1950): a plastic zone to the radius `c` under
/// the pressure `k (2 ln(c/a) + 1 - c²/b²)` with `k = σ_y/√3`, and the outer radius moves by `k c²/(2 G b)`. By its inner
/// displacement `k c²/(2 G a)`.
#[test]
fn hills_tube_yields_from_within() {
    let (e, nu, yields, a, b) = (1000.0, 0.4999, 1.0, 1.0, 2.0);
    let (k, g) = (yields / 3f64.sqrt(), e / (2.0 * (1.0 + nu)));
    let solve = |degree: usize, cells: usize, c: f64| {
        let case = format!(
            "space = \"axisymmetric\"\n[bodies.tube.solid]\n\
             mesh.box = {{ min = [{a}, 0], max = [{b}, 0.2], cells = [{cells}, 1] }}\ndegree = {degree}\n\
             material.elastic_plastic = {{ youngs_modulus = {e}, poissons_ratio = {nu}, yield_stress = {yields} }}\n\
             [supports.low]\non = \"tube:bottom\"\ndisplacement = [\"free\", 0]\n\
             [supports.high]\non = \"tube:top\"\ndisplacement = [\"free\", 0]\n\
             [supports.inner]\non = \"tube:left\"\ndisplacement = [\"{}*t\", \"free\"]\n\
             [output.probes]\nouter = [{b}, 0]\n[[steps]]\nto = 1\nincrements = 6\n",
            k * c * c / (2.0 * g * a)
        );
        let found = summary(&case, &set(&[]));
        let step = last_step(&found);
        // Newton's method squares the residual in the last iterations.
        let history: Vec<f64> = serde_json::from_value(step["residual_history"].clone()).unwrap();
        assert!(history.len() <= 9, "{history:?}");
        let pressure = at(step, "/support_forces/inner/0") / (2.0 * std::f64::consts::PI * a * 0.2);
        (pressure, at(step, "/probes/outer/displacement/0"))
    };
    for c in [1.2, 1.6, 1.9f64] {
        let exact = k * (2.0 * (c / a).ln() + 1.0 - c * c / (b * b));
        let (pressure, outer) = solve(2, 16, c);
        println!("c = {c}: {pressure} {exact}, {outer} {}", k * c * c / (2.0 * g * b));
        assert!((pressure / exact - 1.0).abs() < 1e-3, "{c}: {pressure} {exact}");
        assert!((outer / (k * c * c / (2.0 * g * b)) - 1.0).abs() < 1e-3);
    }
    let exact = k * (2.0 * 1.6f64.ln() + 1.0 - 0.64);
    let errors = [8, 32].map(|n| (solve(1, n, 1.6).0 / exact - 1.0).abs());
    assert!(errors[1] < 2e-3 && errors[0] / errors[1] > 4.0, "{errors:?}");
}

/// At finite strain a bar carries the Kirchhoff stress of its table at `ln λ - τ/E`, in any number of increments.
#[test]
fn a_bar_is_drawn_to_twice_its_length() {
    for increments in [3, 8] {
        let case = format!(
            "space = \"3d\"\n[bodies.bar.solid]\nmesh.box = {{ min = [0, 0, 0], max = [1, 1, 1], cells = [2, 1, 1] }}\n\
             strain = \"finite\"\nmaterial.elastic_plastic = {{ youngs_modulus = 1000, poissons_ratio = 0.3, \
             yield_stress = [[2, 0], [7, 0.5]], hardening = 9 }}\n\
             [supports.a]\non = \"bar:left\"\ndisplacement = [0, \"free\", \"free\"]\n\
             [supports.b]\non = \"bar:front\"\ndisplacement = [\"free\", 0, \"free\"]\n\
             [supports.c]\non = \"bar:bottom\"\ndisplacement = [\"free\", \"free\", 0]\n\
             [supports.pull]\non = \"bar:right\"\ndisplacement = [\"t\", \"free\", \"free\"]\n\
             [[steps]]\nto = 1\nincrements = {increments}\n"
        );
        let found = summary(&case, &set(&[]));
        let strain = 2f64.ln();
        // τ = 7 + 9 (ε_p - 0.5), ε_p = ln λ - τ/E; it hardens by more than it thins, so that no neck forms.
        let tau = (7.0 + 9.0 * (strain - 0.5)) / (1.0 + 9.0 / 1000.0);
        let force = at(last_step(&found), "/support_forces/pull/0");
        assert!((force - tau / 2.0).abs() < 1e-8, "{increments}: {force} {}", tau / 2.0);
        assert_eq!(found["materials"]["bar"], "elastic-plastic, logarithmic strain");
    }
}

/// Stops a run in its increment of that number.
struct Until(usize);

impl Progress for Until {
    fn step(&mut self, index: usize, _: usize, _: f64) {
        self.0 = if index >= self.0 { 0 } else { self.0 };
    }
    fn iteration(&mut self, _: &Iteration) {}
    fn interrupted(&self) -> bool {
        self.0 == 0
    }
}

/// A punch that is pressed into a block and lifted leaves a dent; stopped under load and gone on with, the run gives the same
/// digits.
#[test]
fn a_dent_remains_and_a_resumed_run_gives_the_same_digits() {
    let case = r#"
space = "plane_strain"
[bodies.block.solid]
mesh.box = { min = [0, 0], max = [4, 2], cells = [16, 8] }
material.elastic_plastic = { youngs_modulus = 1000, poissons_ratio = 0.3, yield_stress = 3, hardening = 20 }
[bodies.roller.rigid]
shape.cylinder = { point = [2, 4], radius = 2 }
motion.prescribed = { displacement = [0, "-0.06*sin(pi*t)"] }
[supports.base]
on = "block:bottom"
displacement = [0, 0]
[contacts.touch]
between = ["block:top", "roller"]
[output.probes]
top = [2, 2]
[output]
pictures = false
[[steps]]
to = 1
increments = 8
"#;
    let problem = signorini::case::read("case.toml", case, &[]).expect("a case");
    let folder = tempfile::tempdir().expect("a folder");
    let whole = run(&problem, &folder.path().join("whole"), &mut Silent).expect("a run").summary;
    let path = folder.path().join("parts");
    assert!(run(&problem, &path, &mut Until(5)).expect("a run").ending == Ending::Interrupted);
    let rest = resume(&problem, &path, &mut Silent).expect("a run").summary;
    assert_eq!(json!([rest.steps, rest.warnings]), json!([whole.steps, whole.warnings]));
    let whole = json!(whole);
    let dent = at(last_step(&whole), "/probes/top/displacement/1");
    assert!(dent < -0.05 && dent > -0.06, "{dent}");
    assert!(steps(&whole).iter().map(|s| s["plastic_dissipation"].as_f64().unwrap_or(0.0)).sum::<f64>() > 0.0);
}
