//! Heat in solids and through their contacts, against closed forms: thermal stress, conduction, conductance of contacts, heat
//! of friction, and both coupled.

use crate::summary;
use serde_json::Value;

/// The last increment of a case.
fn last(case: &str) -> Value {
    let summary = summary(case, &[]);
    assert_eq!(summary["converged"], true, "{}", summary["verdict"]);
    assert_ne!(summary["answer"]["verdict"], "not_an_answer", "{}", summary["answer"]);
    summary["steps"].as_array().and_then(|steps| steps.last()).cloned().unwrap_or_default()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

fn near(found: &Value, expected: f64, tolerance: f64) {
    let found = number(found);
    assert!((found - expected).abs() <= tolerance * expected.abs().max(1e-300), "{found:.12e} for {expected:.12e}");
}

const E: f64 = 2e5;
const NU: f64 = 0.3;
const ALPHA: f64 = 1.2e-5;
/// The stress that hinders a strain with none across.
const STEEL: &str = "material.linear_elastic = { youngs_modulus = 2e5, poissons_ratio = 0.3 }";

/// Bars whose length is fixed: `σ = -E α ΔT` with a temperature that is given, and where it varies along the bar and all strain
/// across it is hindered too, `-E α ΔT_m/(1 - 2ν)` with the mean.
#[test]
fn a_bar_of_fixed_length_is_compressed() {
    let given = format!(
        "space = \"plane_stress\"\n[bodies.bar.solid]\nmesh.box = {{ min = [0, 0], max = [10, 1], cells = [8, 2] }}\n{STEEL}\n\
         thermal = {{ expansion = 1.2e-5, stress_free_temperature = 20, temperature = \"20 + 100*t\" }}\n\
         [supports.ends]\non = \"bar:left\"\nnormal = 0\n[supports.far]\non = \"bar:right\"\nnormal = 0\n\
         [supports.low]\non = \"bar:bottom\"\nnormal = 0\n[[steps]]\nto = 1\nincrements = 2\n"
    );
    let step = last(&given);
    near(&step["support_forces"]["far"][0], -E * ALPHA * 100.0, 1e-12);
    near(&step["heat"]["bodies"]["bar"]["max"], 120.0, 1e-14);
    for degree in [1, 2, 3] {
        let conducted = format!(
            "space = \"plane_strain\"\n[bodies.bar.solid]\nmesh.box = {{ min = [0, 0], max = [10, 1], cells = [4, 2] }}\n{STEEL}\n\
             degree = {degree}\nthermal = {{ expansion = 1.2e-5, stress_free_temperature = 20, conductivity = 50 }}\n\
             [supports.near]\non = \"bar:left\"\nnormal = 0\ntemperature = 20\n\
             [supports.far]\non = \"bar:right\"\nnormal = 0\ntemperature = 120\n\
             [supports.low]\non = \"bar:bottom\"\nnormal = 0\n[supports.high]\non = \"bar:top\"\nnormal = 0\n\
             [output.probes]\nmiddle = [3.1, 0.4]\n"
        );
        let step = last(&conducted);
        near(&step["support_forces"]["far"][0], -E * ALPHA * 50.0 / (1.0 - 2.0 * NU), 1e-11);
        near(&step["heat"]["supports"]["far"], 50.0 * 100.0 / 10.0, 1e-11);
        near(&step["heat"]["supports"]["near"], -50.0 * 100.0 / 10.0, 1e-11);
        near(&step["probes"]["middle"]["temperature"], 20.0 + 31.0, 1e-11);
        // σ_yy = σ_zz = ν/(1-ν) σ_xx - E α ΔT/(1-ν), by the mean of the cell where the degree is one.
        let mean = if degree == 1 { 37.5 } else { 31.0 };
        let along = -E * ALPHA * 50.0 / (1.0 - 2.0 * NU);
        let across = (NU * along - E * ALPHA * mean) / (1.0 - NU);
        near(&step["probes"]["middle"]["von_mises"], (along - across).abs(), 1e-9);
    }
}

/// A bar of fixed length that yields as it is heated, `σ = -(α ΔT + σ_y/H)/(1/E + 1/H)`, in few increments and in many.
#[test]
fn a_bar_yields_by_heat() {
    let hardening = 1000.0;
    let exact = -(ALPHA * 200.0 + 200.0 / hardening) / (1.0 / E + 1.0 / hardening);
    for increments in [2, 7] {
        let case = format!(
            "space = \"plane_stress\"\n[bodies.bar.solid]\nmesh.box = {{ min = [0, 0], max = [10, 1], cells = [2, 1] }}\n\
             material.elastic_plastic = {{ youngs_modulus = 2e5, poissons_ratio = 0.3, yield_stress = 200, hardening = 1000 }}\n\
             thermal = {{ expansion = 1.2e-5, stress_free_temperature = 20, temperature = \"20 + 200*t\" }}\n\
             [supports.ends]\non = \"bar:left\"\nnormal = 0\n[supports.far]\non = \"bar:right\"\nnormal = 0\n\
             [supports.low]\non = \"bar:bottom\"\nnormal = 0\n[[steps]]\nto = 1\nincrements = {increments}\n"
        );
        near(&last(&case)["support_forces"]["far"][0], exact, 1e-8);
    }
}

/// What is free expands by `α ΔT` without stress, in plane strain by `(1 + ν) α ΔT` with `σ_zz = -E α ΔT`; at finite strain the
/// stretch is `1 + α ΔT` exactly.
#[test]
fn what_is_free_expands_without_stress() {
    let thermal = "thermal = { expansion = 1e-4, stress_free_temperature = 0, temperature = 100 }";
    for (space, factor) in [("plane_stress", 1.0), ("plane_strain", 1.0 + NU), ("axisymmetric", 1.0)] {
        for degree in [1, 2] {
            let held = if space == "axisymmetric" { "" } else { "[supports.side]\non = \"body:left\"\nnormal = 0\n" };
            let case = format!(
                "space = \"{space}\"\n[bodies.body.solid]\nmesh.box = {{ min = [0, 0], max = [2, 1], cells = [3, 2], map = [\"x + 0.1*x*y*(1 - y)\", \"y\"] }}\n\
                 degree = {degree}\n{STEEL}\n{thermal}\n[supports.low]\non = \"body:bottom\"\nnormal = 0\n{held}\
                 [output.probes]\nfar = [2, 1]\n"
            );
            let step = last(&case);
            near(&step["probes"]["far"]["displacement"][0], factor * 0.02, 1e-9);
            near(&step["probes"]["far"]["displacement"][1], factor * 0.01, 1e-9);
            let stress = if space == "plane_strain" { E * 0.01 } else { 0.0 };
            let found = number(&step["probes"]["far"]["von_mises"]);
            assert!((found - stress).abs() < 1e-8 * E * 0.01, "{space}: {found}");
        }
    }
    for (strain, material) in
        [("small", "linear_elastic"), ("finite", "neo_hooke"), ("finite", "saint_venant_kirchhoff")]
    {
        let case = format!(
            "[bodies.body.solid]\nmesh.box = {{ min = [0, 0, 0], max = [2, 1, 1], cells = [2, 2, 1] }}\nstrain = \"{strain}\"\n\
             material.{material} = {{ youngs_modulus = 2e5, poissons_ratio = 0.3 }}\n\
             thermal = {{ expansion = 1e-3, stress_free_temperature = 0, temperature = 100 }}\n\
             [supports.a]\non = \"body:left\"\nnormal = 0\n[supports.b]\non = \"body:front\"\nnormal = 0\n\
             [supports.c]\non = \"body:bottom\"\nnormal = 0\n[output.probes]\nfar = [2, 1, 1]\n"
        );
        let summary = summary(&case, &[]);
        let step = &summary["steps"][0];
        near(&step["probes"]["far"]["displacement"][0], 0.2, 1e-10);
        assert!(number(&step["probes"]["far"]["von_mises"]) < 1e-8 * E, "{strain} {material}");
    }
}

/// Two blocks with other cells, pressed together: the jump of temperature is `q/h`, with `h = h_0 (p/p_0)^m`.
#[test]
fn the_temperature_jumps_where_blocks_touch() {
    // Only mortar passes a uniform pressure through meshes that do not match.
    let methods = [("mortar = {}", 1e-10), ("gauss_point = {}", 1e-4), ("node = {}", 3e-3)];
    for (method, tolerance) in methods {
        for (conductance, h) in [
            ("conductance = 8", 8.0),
            ("conductance = 8, pressure = 40", 8.0 * (10.0f64 / 40.0).powf(0.95)),
            ("conductance = 8, pressure = 40, exponent = 0.5", 4.0),
        ] {
            let case = format!(
                "space = \"plane_strain\"\n[bodies.lower.solid]\nmesh.box = {{ min = [0, 0], max = [3, 1], cells = [3, 2] }}\n{STEEL}\n\
                 thermal = {{ conductivity = 5 }}\n\
                 [bodies.upper.solid]\nmesh.box = {{ min = [0, 1], max = [3, 3], cells = [4, 2] }}\n{STEEL}\n\
                 thermal = {{ conductivity = 20 }}\n\
                 [supports.low]\non = \"lower:bottom\"\nnormal = 0\ntemperature = 0\n\
                 [supports.left]\non = \"lower:left\"\nnormal = 0\n[supports.left_too]\non = \"upper:left\"\nnormal = 0\n\
                 [loads.press]\non = \"upper:top\"\npressure = 10\n[supports.hot]\non = \"upper:top\"\ntemperature = 100\n\
                 [contacts.joint]\nbetween = [\"upper:bottom\", \"lower:top\"]\nslave = \"upper\"\nmethod.{method}\nheat = {{ {conductance} }}\n"
            );
            let step = last(&case);
            let q = 100.0 / (1.0 / 5.0 + 1.0 / h + 2.0 / 20.0);
            near(&step["heat"]["supports"]["hot"], 3.0 * q, tolerance);
            near(&step["heat"]["contacts"]["joint"]["conducted"], 3.0 * q, tolerance);
            if method.starts_with("mortar") {
                near(&step["heat"]["bodies"]["upper"]["min"], 100.0 - q * 2.0 / 20.0, 1e-10);
                near(&step["heat"]["bodies"]["lower"]["max"], q / 5.0, 1e-10);
            }
            let [a, b] = ["hot", "low"].map(|name| number(&step["heat"]["supports"][name]));
            assert!((a + b).abs() < 1e-10 * a, "{a} {b}");
            assert!(number(&step["heat"]["balance"]) < 1e-10);
        }
    }
}

/// A long thick tube with hot inside: temperature `T_a ln(b/r)/ln(b/a)`, hoop stress after Timoshenko and Goodier,
/// *Theory of Elasticity*, §150.
#[test]
fn a_tube_with_hot_inside_is_compressed_there() {
    let (a, b, hot) = (1.0f64, 3.0f64, 100.0);
    let factor = E * ALPHA * hot / (2.0 * (1.0 - NU) * (b / a).ln());
    let hoop = factor * (1.0 - 2.0 * b * b / (b * b - a * a) * (b / a).ln());
    // At the inner radius σ_r = 0; the ends are held: σ_z = ν (σ_r + σ_θ) - E α T.
    let axial = NU * hoop - E * ALPHA * hot;
    let mises = (hoop * hoop + axial * axial - hoop * axial).sqrt();
    for (degree, order) in [(1, 0.8), (2, 1.7), (3, 2.6)] {
        let error = |cells: usize| {
            let case = format!(
                "space = \"axisymmetric\"\n[bodies.tube.solid]\nmesh.box = {{ min = [1, 0], max = [3, 0.5], cells = [{cells}, 1] }}\n\
                 degree = {degree}\n{STEEL}\nthermal = {{ expansion = 1.2e-5, stress_free_temperature = 0, conductivity = 50 }}\n\
                 [supports.in]\non = \"tube:left\"\ntemperature = 100\n[supports.out]\non = \"tube:right\"\ntemperature = 0\n\
                 [supports.low]\non = \"tube:bottom\"\nnormal = 0\n[supports.high]\non = \"tube:top\"\nnormal = 0\n\
                 [output.probes]\ninner = [1, 0.25]\n"
            );
            let step = last(&case);
            let flow = number(&step["heat"]["supports"]["in"]);
            let exact = std::f64::consts::TAU * 0.5 * 50.0 * 100.0 / 3.0f64.ln();
            [(number(&step["probes"]["inner"]["von_mises"]) / mises - 1.0).abs(), (flow / exact - 1.0).abs()]
        };
        let [coarse, fine] = [error(8), error(16)];
        let found = (coarse[0] / fine[0]).log2();
        let of_heat = (coarse[1] / fine[1]).log2();
        println!("degree {degree}: stress {coarse:.2?} {fine:.2?}, orders {found:.2} {of_heat:.2}");
        assert!(found > order, "degree {degree}: order {found} of stress");
        assert!(of_heat > 2.0 * degree as f64 - 0.2, "degree {degree}: order {of_heat} of heat");
    }
}

/// A ring that cools on a shaft, in plane strain: `p = E α |ΔT| (1 - a²/b²)/(2 (1 - ν))`.
#[test]
fn a_ring_shrinks_onto_a_shaft() {
    let p = E * ALPHA * 100.0 * (1.0 - 0.25) / (2.0 * (1.0 - NU));
    for strain in ["small", "finite"] {
        let material = if strain == "small" { "linear_elastic" } else { "saint_venant_kirchhoff" };
        let solid = format!(
            "degree = 2\nstrain = \"{strain}\"\nmaterial.{material} = {{ youngs_modulus = 2e5, poissons_ratio = 0.3 }}"
        );
        let case = format!(
            "space = \"axisymmetric\"\n[bodies.shaft.solid]\nmesh.box = {{ min = [0, 0], max = [1, 0.25], cells = [4, 1] }}\n{solid}\n\
             [bodies.ring.solid]\nmesh.box = {{ min = [1, 0], max = [2, 0.25], cells = [6, 1] }}\n{solid}\n\
             thermal = {{ expansion = 1.2e-5, stress_free_temperature = 120, temperature = \"120 - 100*t\" }}\n\
             [supports.a]\non = \"shaft:bottom\"\nnormal = 0\n[supports.b]\non = \"shaft:top\"\nnormal = 0\n\
             [supports.c]\non = \"ring:bottom\"\nnormal = 0\n[supports.d]\non = \"ring:top\"\nnormal = 0\n\
             [contacts.fit]\nbetween = [\"ring:left\", \"shaft:right\"]\nmethod.mortar = {{}}\n\
             [[steps]]\nto = 1\nincrements = 2\n"
        );
        let step = last(&case);
        let tolerance = if strain == "small" { 2e-4 } else { 5e-3 };
        near(&step["contacts"]["fit"]["max_pressure"], p, tolerance);
    }
}

/// A bar that cools through its ends: `T = sin(πx/L) exp(-k π² t/(ρ c L²))`, of first order in the increment.
#[test]
fn a_bar_cools_with_time() {
    let rate = 2.0 * std::f64::consts::PI.powi(2) / (4.0 * 0.5 * 4.0);
    let exact = (-rate * 0.4f64).exp();
    let error = |increments: usize| {
        let case = format!(
            "space = \"plane_strain\"\nheat.equation = \"transient\"\n[bodies.bar.solid]\nmesh.box = {{ min = [0, 0], max = [2, 0.5], cells = [8, 1] }}\n\
             degree = 3\n{STEEL}\ndensity = 4\nthermal = {{ conductivity = 2, specific_heat = 0.5, initial_temperature = \"sin(pi*x/2)\", stress_free_temperature = 0 }}\n\
             [supports.left]\non = \"bar:left\"\nnormal = 0\ntemperature = 0\n[supports.right]\non = \"bar:right\"\ntemperature = 0\n\
             [supports.low]\non = \"bar:bottom\"\nnormal = 0\n[output.probes]\nmiddle = [1, 0.25]\n\
             [[steps]]\nto = 0.4\nincrements = {increments}\n"
        );
        let step = last(&case);
        // What leaves through the ends was stored.
        let stored = number(&step["heat"]["bodies"]["bar"]["stored"]);
        let left: f64 = ["left", "right"].map(|s| number(&step["heat"]["supports"][s])).iter().sum();
        assert!((stored - left).abs() < 1e-10 * left.abs(), "{stored} {left}");
        number(&step["probes"]["middle"]["temperature"]) - exact
    };
    let [coarse, fine] = [error(10), error(20)];
    let order = (coarse / fine).log2();
    assert!((order - 1.0).abs() < 0.1 && fine.abs() < 0.03 * exact, "{coarse} {fine}");
}

/// A block that is dragged over a rigid floor: the power `μ N v`, split as stated.
#[test]
fn friction_heats_what_slides() {
    let case = "space = \"plane_strain\"\nheat.equation = \"transient\"\n\
        [bodies.block.solid]\nmesh.box = { min = [0, 0], max = [1, 0.5], cells = [4, 2] }\n\
        material.linear_elastic = { youngs_modulus = 2e5, poissons_ratio = 0.3 }\ndensity = 3\n\
        thermal = { conductivity = 2, specific_heat = 0.5, initial_temperature = 10 }\n\
        [bodies.floor.rigid]\nshape.plane = { point = [0, 0], normal = [0, 1] }\n\
        [supports.drag]\non = \"block:top\"\ndisplacement = [\"0.25*t\", -1e-4]\n\
        [contacts.slide]\nbetween = [\"block:bottom\", \"floor\"]\nfriction.coulomb = { mu = 0.3 }\nheat = { friction_share = 0.75 }\n\
        [[steps]]\nto = 2\nincrements = 8\n";
    let summary = summary(case, &[]);
    assert_eq!(summary["converged"], true);
    let steps = summary["steps"].as_array().expect("increments");
    let step = &steps[steps.len() - 1];
    let normal = number(&step["contacts"]["slide"]["force"][1]);
    let power = 0.3 * normal * 0.25;
    near(&step["heat"]["contacts"]["slide"]["friction"], power, 1e-9);
    near(&step["heat"]["contacts"]["slide"]["into"][0], 0.75 * power, 1e-9);
    near(&step["heat"]["contacts"]["slide"]["into"][1], 0.25 * power, 1e-9);
    near(&step["heat"]["bodies"]["block"]["stored"], 0.75 * power, 1e-9);
}

/// Two rods whose gap closes as one is heated (Barber, Dundurs and Comninou 1980): the pressure follows from the temperatures, these from the conductance,
/// and it from the pressure. With hindered strain across, `m = (λ + 2μ)` and `β = 3 K α`:
/// `p (L_1 + L_2) = β ∫ΔT - m g_0`, `q = k_1 (T_1 - T_a)/L_1 = h_0 (p/p_0)^0.95 (T_a - T_b) = k_2 (T_b - T_2)/L_2`.
#[test]
fn rods_that_grow_together_conduct_heat() {
    let (k1, k2, l1, l2, hot, gap) = (20.0, 5.0, 2.0, 3.0, 200.0, 1e-3);
    let m = E * (1.0 - NU) / ((1.0 + NU) * (1.0 - 2.0 * NU));
    let beta = E * ALPHA / (1.0 - 2.0 * NU);
    let at = |p: f64| {
        let h = 0.5 * (p / 100.0f64).powf(0.95);
        let q = hot / (l1 / k1 + 1.0 / h + l2 / k2);
        let (ta, tb) = (hot - q * l1 / k1, q * l2 / k2);
        (q, (beta * (0.5 * (hot + ta) * l1 + 0.5 * tb * l2) - m * gap) / (l1 + l2))
    };
    let (mut low, mut high) = (1e-6, 1e4);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if at(middle).1 > middle { low = middle } else { high = middle }
    }
    let (p, q) = (low, at(low).0);
    let case = format!(
        "space = \"plane_strain\"\n[bodies.one.solid]\nmesh.box = {{ min = [0, 0], max = [2, 1], cells = [4, 2] }}\n{STEEL}\n\
         thermal = {{ expansion = 1.2e-5, stress_free_temperature = 0, conductivity = 20 }}\n\
         [bodies.two.solid]\nmesh.box = {{ min = [2.001, 0], max = [5.001, 1], cells = [5, 3] }}\n{STEEL}\n\
         thermal = {{ expansion = 1.2e-5, stress_free_temperature = 0, conductivity = 5 }}\n\
         [supports.hot]\non = \"one:left\"\nnormal = 0\ntemperature = \"200*t\"\n\
         [supports.cold]\non = \"two:right\"\nnormal = 0\ntemperature = 0\n\
         [supports.a]\non = \"one:bottom\"\nnormal = 0\n[supports.b]\non = \"one:top\"\nnormal = 0\n\
         [supports.c]\non = \"two:bottom\"\nnormal = 0\n[supports.d]\non = \"two:top\"\nnormal = 0\n\
         [contacts.joint]\nbetween = [\"one:right\", \"two:left\"]\nmethod.mortar = {{}}\nheat = {{ conductance = 0.5, pressure = 100 }}\n\
         [[steps]]\nto = 1\nincrements = 4\n"
    );
    let step = last(&case);
    println!("p {p:.6} q {q:.6}, passes {}, history {}", step["heat"]["passes"], step["heat"]["history"]);
    near(&step["contacts"]["joint"]["max_pressure"], p, 1e-7);
    near(&step["heat"]["contacts"]["joint"]["conducted"], q, 1e-7);
}

/// What is wrong is named with its line, its value, and what would be valid.
#[test]
fn what_makes_no_sense_is_refused() {
    let case = "space = \"plane_strain\"\nunits = { length = \"mm\", force = \"N\", temperature = \"degC\" }\n\
        [bodies.block.solid]\nmesh.box = { min = [0, 0], max = [1, 1], cells = [2, 2] }\n\
        material.linear_elastic = { youngs_modulus = 2e5, poissons_ratio = 0.3 }\n\
        thermal = { expansion = \"12e-6 1/K\", stress_free_temperature = \"293.15 K\", conductivity = \"50 W/(m K)\" }\n\
        [bodies.other.solid]\nmesh.box = { min = [0, -1], max = [1, 0], cells = [2, 2] }\n\
        material.linear_elastic = { youngs_modulus = 2e5, poissons_ratio = 0.3 }\n\
        [supports.hot]\non = \"block:top\"\ntemperature = \"120 degC\"\ndisplacement = [0, 0]\n\
        [supports.low]\non = \"other:bottom\"\ndisplacement = [0, 0]\n\
        [contacts.joint]\nbetween = [\"block:bottom\", \"other:top\"]\n";
    let table = [
        ("\"50 W/(m K)\"", "-50", "the conductivity is -50", "above 0"),
        ("\"50 W/(m K)\"", "\"50 W/m\"", "the unit is", "conductivity, such as W/(m K)"),
        ("\"120 degC\"", "\"120 mm\"", "the unit is that of a length", "a temperature"),
        (
            "temperature = \"120 degC\"\n",
            "",
            "nothing tells the temperature of `block` in the steady state",
            "convection",
        ),
        (
            "on = \"other:bottom\"",
            "on = \"other:bottom\"\ntemperature = 3",
            "`other`, which does not conduct heat",
            "thermal.conductivity",
        ),
        (
            "between",
            "heat = { conductance = 3 }\nbetween",
            "a conductance to `other`, which has no temperature",
            "thermal",
        ),
        ("between", "heat = {}\nbetween", "no heat passes through contact `joint`", "conductance"),
        ("stress_free_temperature = \"293.15 K\", ", "", "free of thermal strain", "stress_free_temperature"),
        (
            "expansion = \"12e-6 1/K\"",
            "expansion = \"12e-6 1/K\", temperature = 3",
            "the temperature of `block` is given",
            "leave out",
        ),
        ("expansion = \"12e-6 1/K\"", "expansion = \"12e-6 1/K\", specific_heat = 3", "no density", "density"),
        (
            "space = \"plane_strain\"",
            "space = \"plane_strain\"\nheat.equation = \"transient\"",
            "nothing tells what it stores",
            "specific_heat",
        ),
        (
            "[contacts.joint]",
            "[loads.sun]\non = \"other:top\"\nheat_flux = 3\n[contacts.joint]",
            "which does not conduct heat",
            "conductivity",
        ),
        (
            "[contacts.joint]",
            "[loads.sun]\non = \"block:tip\"\nheat_flux = 3\n[contacts.joint]",
            "has no group `tip`",
            "",
        ),
        (
            "[contacts.joint]",
            "[loads.sun]\non = \"block:left\"\nheat_flux = 3\npressure = 2\n[contacts.joint]",
            "has 2 values",
            "of their own",
        ),
    ];
    for (from, to, message, help) in table {
        assert!(case.contains(from), "{from}");
        let told = crate::error(&case.replacen(from, to, 1));
        assert!(told.message.contains(message), "{from} -> {to}: {}", told.message);
        assert!(told.help.as_deref().unwrap_or_default().contains(help), "{from} -> {to}: {:?}", told.help);
        assert!(told.place.is_some(), "{from} -> {to}: no place");
    }
    // On the scale of Celsius.
    let step = last(case);
    near(&step["heat"]["bodies"]["block"]["min"], 120.0, 1e-12);
}
