//! Adhesion from measurements: exact data give the truth back, noisy data an interval that holds it.

use signorini::fit::{Estimate, Model, Quantity, fit};
use signorini::plan::{Plan, plan};
use std::path::Path;

const CASE: &str = r#"
space = "axisymmetric"
[bodies.film.membrane]
domain.interval = { from = 0.0, to = 1.0 }
mesh.grid = { cells = [50] }
degree = 3
tension = 1.0
[bodies.floor.rigid]
shape.height = "-0.1"
[supports.rim]
on = "film:boundary"
displacement = 0.0
[loads.press]
on = "film"
normal = "-t"
[contacts.touch]
between = ["film", "floor"]
[[steps]]
to = 1
"#;

/// The contact radius of a blister of radius 1 over a floor at depth 0.1 (see benchmarks of a constrained blister: Zhu,
/// Li, Müftü & Wan, J. Appl. Mech. 84 (2017) 071005).
fn radius(load: f64, energy: f64, tension: f64) -> f64 {
    let slope = |c: f64| {
        let f = load / tension;
        0.5 * f * c + (0.25 * f * (1.0 - c * c) - 0.1) / (c * c.ln())
    };
    let (mut low, mut high) = (0.2, 0.9999);
    for _ in 0..100 {
        let c = 0.5 * (low + high);
        if slope(c) < (2.0 * energy / tension).sqrt() { low = c } else { high = c }
    }
    low
}

fn model(times: &[f64], quantity: Quantity) -> Model {
    let document = signorini::case::read("case.toml", CASE, &[]).expect("a case");
    let Ok(Plan::Line(plan)) = plan(&document) else { panic!("a round membrane") };
    Model::new(&plan, quantity, times).expect("a model")
}

/// Numbers of a normal distribution, the same in every run.
struct Noise(u64);

impl Noise {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
    fn normal(&mut self) -> f64 {
        (-2.0 * self.uniform().max(1e-300).ln()).sqrt() * (std::f64::consts::TAU * self.uniform()).cos()
    }
}

#[test]
fn exact_data_give_the_truth() {
    let loads: Vec<f64> = (0..12).map(|k| 0.5 + 0.3 * f64::from(k)).collect();
    for (quantity, tension) in [(Quantity::Radius, 1.0), (Quantity::Area, 1.0), (Quantity::Radius, 1.3)] {
        let of = |load: &f64| {
            let c = radius(*load, 0.02, tension);
            if quantity == Quantity::Area { std::f64::consts::PI * c * c } else { c }
        };
        let measured: Vec<f64> = loads.iter().map(of).collect();
        let found = Estimate::new(&model(&loads, quantity), &measured, tension != 1.0, true, 0.95);
        assert!(found.converged);
        assert!((found.adhesion.value / 0.02 - 1.0).abs() < 1e-6, "{:?}", found.adhesion);
        if let Some(t) = found.tension {
            assert!((t.value / 1.3 - 1.0).abs() < 1e-6, "{t:?}");
        }
    }
}

/// Of a thousand experiments with 5 % noise, the intervals of 95 % hold the truth in 92 to 98 %.
#[test]
fn the_interval_holds_what_it_promises() {
    let loads: Vec<f64> = (0..20).map(|k| 0.5 + 0.2 * f64::from(k)).collect();
    let model = model(&loads, Quantity::Radius);
    let exact: Vec<f64> = loads.iter().map(|f| radius(*f, 0.02, 1.0)).collect();
    let mut noise = Noise(20);
    let mut held = [0, 0];
    let repeats = 1000;
    for _ in 0..repeats {
        let measured: Vec<f64> = exact.iter().map(|c| (c * (1.0 + 0.05 * noise.normal())).min(0.99)).collect();
        for (k, count) in held.iter_mut().enumerate() {
            let found = Estimate::new(&model, &measured, k == 1, true, 0.95);
            *count += usize::from(found.adhesion.interval[0] <= 0.02 && 0.02 <= found.adhesion.interval[1]);
        }
    }
    let share = held.map(|h| h as f64 / f64::from(repeats));
    assert!(share.iter().all(|s| (0.92..=0.98).contains(s)), "{share:?}");
}

/// Runs a fit of rows of a CSV file.
fn fitted(rows: &str, key: &str) -> Result<serde_json::Value, String> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join("data.csv"), rows).expect("a file");
    let text = format!("{CASE}[fit]\ndata = \"data.csv\"\ntime = \"p\"\n{key}\n");
    let name = folder.path().join("case.toml");
    let document = signorini::case::read(&name.to_string_lossy(), &text, &[]).map_err(|e| e.one_line())?;
    let result = fit(&document, &folder.path().join("out")).map(|f| f.summary).map_err(|e| e.to_string());
    let drawn = folder.path().join("out/pictures/fit.png").is_file();
    assert_eq!(result.is_ok(), drawn && Path::new(&folder.path().join("out/fit.csv")).is_file());
    result
}

#[test]
fn data_that_cannot_tell_are_said_to() {
    // Loads too close to each other.
    let rows: String = (0..8)
        .map(|k| 1.0 + 0.01 * f64::from(k))
        .map(|f| format!("{f},{}\n", radius(f, 0.02, 1.0) * (1.0 + 0.01 * (40.0 * f).sin())))
        .collect();
    let both = fitted(&format!("p,c\n{rows}"), "radius = \"c\"\nunknown = [\"adhesion\", \"tension\"]").expect("a fit");
    assert!(both["warnings"].to_string().contains("do not determine adhesion and tension separately"), "{both}");
    let one = fitted(&format!("p,c\n{rows}"), "radius = \"c\"").expect("a fit");
    assert_eq!(one["warnings"].as_array().map(Vec::len), Some(0), "{one}");
    let range = &one["adhesion_energy"]["interval"];
    assert!(range[0].as_f64() < Some(0.02) && range[1].as_f64() > Some(0.02), "{one}");
}

#[test]
fn wrong_files_are_told() {
    let rows = |last: &str| format!("p,c\n1,0.6\n2,0.7\n3,0.8\n{last}\n");
    for (text, key, word) in [
        (rows("4,"), "radius = \"c\"", "line 5, column `c`: is empty"),
        (rows("4,x"), "radius = \"c\"", "`x` is not a number"),
        (rows("nan,0.8"), "radius = \"c\"", "not finite"),
        (rows("4,1.8"), "radius = \"c\"", "between 0 and"),
        (rows("4,0.8"), "radius = \"cc\"", "no column `cc`"),
        (rows("4,0.8,9"), "radius = \"c\"", "line 5: 3 entries under 2 names"),
        (rows("4,0.8").replace(',', ";").replace("0.7", "0,7"), "radius = \"c\"", "line 3: `0,7` has a comma"),
        ("p,c\n1,0.6\n".into(), "radius = \"c\"", "too few"),
        ("p,c,c\n1,0.6,1\n".into(), "radius = \"c\"", "two columns called `c`"),
        (String::new(), "radius = \"c\"", "is empty"),
        (rows("4,0.8"), "", "`radius` or `area`"),
        (rows("4,0.8"), "radius = \"c\"\nconfidence = 1.5", "between 0 and 1"),
        (rows("4,0.8"), "radius = \"c\"\nunknown = [\"tension\"]", "adhesion energy must be one of the unknowns"),
        (rows("4,0.8"), "radius = \"c\"\nunknown = [\"colour\"]", "colour"),
    ] {
        let found = fitted(&text, key).expect_err(word);
        assert!(found.contains(word), "{key}: {found}");
    }
}
