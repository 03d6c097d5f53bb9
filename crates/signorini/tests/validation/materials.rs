//! Materials of solids against closed forms: blocks of rubber, fibres, orthotropic bodies, moduli that vary.

use super::solids::at;
use super::{error, last_step, set, summary};
use serde_json::Value;

/// An energy of the stretches, as its manual has it: principal Kirchhoff stresses without the part of the volume.
type Isochoric = fn([f64; 3]) -> [f64; 3];

fn powers(terms: &[[f64; 2]], l: [f64; 3]) -> [f64; 3] {
    let mut out = [0.0; 3];
    for [mu, alpha] in terms {
        let p = l.map(|l| l.powf(*alpha));
        let mean = p.iter().sum::<f64>() / 3.0;
        (0..3).for_each(|k| out[k] += 2.0 * mu / alpha * (p[k] - mean));
    }
    out
}

/// `2 W'(Ī1) (λ_k² - Ī1/3)`.
fn of_first(slope: impl Fn(f64) -> f64, l: [f64; 3]) -> [f64; 3] {
    let first: f64 = l.iter().map(|l| l * l).sum();
    l.map(|l| 2.0 * slope(first) * (l * l - first / 3.0))
}

const BULK: f64 = 20.0;

/// Text, energy and `U'(J)` of laws with a bulk modulus of 20.
const LAWS: [(&str, Isochoric, fn(f64) -> f64); 4] = [
    (
        "mooney_rivlin = { c10 = 0.3, c01 = 0.1, bulk_modulus = 20 }",
        |l| powers(&[[0.6, 2.0], [0.2, -2.0]], l),
        |j| BULK * (j - 1.0),
    ),
    (
        "yeoh = { c = [0.4, -0.02, 0.01], bulk_modulus = 20, volumetric = \"logarithmic\" }",
        |l| of_first(|i| 0.4 - 0.04 * (i - 3.0) + 0.03 * (i - 3.0).powi(2), l),
        |j| BULK * j.ln() / j,
    ),
    (
        "ogden = { mu = [0.63, 0.0012, -0.01], alpha = [1.3, 5, -2], bulk_modulus = 20, volumetric = \"quadratic\" }",
        |l| powers(&[[0.63, 1.3], [0.0012, 5.0], [-0.01, -2.0]], l),
        |j| 0.5 * BULK * (j - 1.0 / j),
    ),
    (
        "arruda_boyce = { mu = 0.5, locking_stretch = 2, bulk_modulus = 20 }",
        |l| {
            const C: [f64; 5] = [0.5, 0.05, 11.0 / 1050.0, 19.0 / 7000.0, 519.0 / 673_750.0];
            let slope = |i: f64| (0..5).map(|k| 0.5 * C[k] * (k + 1) as f64 * (i / 4.0).powi(k as i32)).sum::<f64>();
            of_first(slope, l)
        },
        |j| BULK * (j - 1.0),
    ),
];

/// First Piola stresses in principal directions.
fn piola((_, isochoric, slope): &(&str, Isochoric, fn(f64) -> f64), l: [f64; 3]) -> [f64; 3] {
    let j = l[0] * l[1] * l[2];
    let tau = isochoric(l.map(|l| l / j.cbrt()));
    std::array::from_fn(|k| (tau[k] + j * slope(j)) / l[k])
}

/// The stretch at which a rising stress vanishes.
fn free(stress: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.2, 5.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if stress(middle) < 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// A block of unit edges, distorted cells within, held on its lower sides and by what is stated.
fn block(space: &str, material: &str, rest: &str) -> Value {
    let (shape, sides): (&str, &[(&str, &str)]) = match space {
        "3d" => (
            "min = [0, 0, 0], max = [1, 1, 1], cells = [2, 2, 1], map = [\"x + 0.3*x*(1-x)*y*(1-y)\", \"y\", \"z\"]",
            &[
                ("left", "[0, \"free\", \"free\"]"),
                ("front", "[\"free\", 0, \"free\"]"),
                ("bottom", "[\"free\", \"free\", 0]"),
            ],
        ),
        _ => (
            "min = [0, 0], max = [1, 1], cells = [2, 2], map = [\"x\", \"y + 0.3*x*(1-x)*y*(1-y)\"]",
            &[("left", "[0, \"free\"]"), ("bottom", "[\"free\", 0]")],
        ),
    };
    let supports: String = sides
        .iter()
        .map(|(side, u)| format!("[supports.{side}]\non = \"block:{side}\"\ndisplacement = {u}\n"))
        .collect();
    let case = format!(
        "space = \"{space}\"\n[bodies.block.solid]\nmesh.box = {{ {shape} }}\nstrain = \"finite\"\nmaterial.{material}\n\
         {supports}{rest}[[steps]]\nto = 1\nincrements = 2\n"
    );
    summary(&case, &set(&[]))
}

fn pulled(side: &str, u: &str) -> String {
    format!("[supports.pull_{side}]\non = \"block:{side}\"\ndisplacement = {u}\n")
}

/// Uniaxial tension and pressure, equibiaxial tension and plane strain, in all spaces.
#[test]
fn blocks_of_rubber_are_stretched_as_the_closed_forms_say() {
    let near = |found: f64, exact: f64, what: &str| {
        assert!((found - exact).abs() < 1e-8 * exact.abs().max(1.0), "{what}: {found} {exact}");
    };
    for law in LAWS {
        for stretch in [0.6, 1.8] {
            let pull = stretch - 1.0;
            let lateral = free(|b| piola(&law, [stretch, b, b])[1]);
            let uniaxial = piola(&law, [stretch, lateral, lateral])[0];
            let found = block("3d", law.0, &pulled("right", &format!("[\"{pull}*t\", \"free\", \"free\"]")));
            near(at(last_step(&found), "/support_forces/pull_right/0"), uniaxial, law.0);
            let found = block("plane_stress", law.0, &pulled("right", &format!("[\"{pull}*t\", \"free\"]")));
            near(at(last_step(&found), "/support_forces/pull_right/0"), uniaxial, law.0);
            // Around an axis the block is a rod of radius 1, pulled along it.
            let found = block("axisymmetric", law.0, &pulled("top", &format!("[\"free\", \"{pull}*t\"]")));
            near(at(last_step(&found), "/support_forces/pull_top/1"), std::f64::consts::PI * uniaxial, law.0);
            let held = free(|b| piola(&law, [stretch, b, 1.0])[1]);
            let found = block("plane_strain", law.0, &pulled("right", &format!("[\"{pull}*t\", \"free\"]")));
            near(at(last_step(&found), "/support_forces/pull_right/0"), piola(&law, [stretch, held, 1.0])[0], law.0);
        }
        let stretch = 1.5;
        let across = free(|b| piola(&law, [stretch, stretch, b])[2]);
        let both = pulled("right", "[\"0.5*t\", \"free\"]") + &pulled("top", "[\"free\", \"0.5*t\"]");
        let found = block("plane_stress", law.0, &both);
        near(at(last_step(&found), "/support_forces/pull_top/1"), piola(&law, [stretch, stretch, across])[0], law.0);
    }
}

/// Simple shear keeps the volume; its principal stretches are `λ - 1/λ = γ`, and the shear stress `(τ_1 - τ_2)/sqrt(4 + γ²)`.
#[test]
fn blocks_of_rubber_are_sheared_as_the_closed_forms_say() {
    let gamma: f64 = 0.8;
    for law in LAWS {
        let case = format!(
            "space = \"plane_strain\"\n[bodies.block.solid]\nmesh.box = {{ min = [0, 0], max = [1, 1], cells = [2, 2] }}\n\
             strain = \"finite\"\nmaterial.{}\n[supports.all]\non = \"block:boundary\"\ndisplacement = [\"{gamma}*t*y\", 0]\n",
            law.0
        );
        let found = summary(&case, &set(&[("steps", "[{ to = 1, increments = 2 }]".into())]));
        let stored = at(last_step(&found), "/energy");
        // The energy is the work of the shear stress on γ: by Simpson's rule.
        let work = |n: usize| {
            let h = gamma / n as f64;
            let stress = |g: f64| {
                let l = 0.5 * (g + (4.0 + g * g).sqrt());
                let tau = law.1([l, 1.0 / l, 1.0]);
                (tau[0] - tau[1]) / (4.0 + g * g).sqrt()
            };
            let inner: f64 = (1..n).map(|k| stress(h * k as f64) * if k % 2 == 1 { 4.0 } else { 2.0 }).sum();
            h / 3.0 * (inner + stress(gamma))
        };
        assert!((stored - work(200)).abs() < 1e-9, "{}: {stored} {}", law.0, work(200));
        assert_eq!(found["materials"]["block"].as_str().map(|name| name.contains("U = K/")), Some(true));
    }
}

/// The error of the pressure in a thick tube that is widened to twice its inner radius, nearly incompressible.
fn tube(material: &str, degree: usize, cells: usize) -> f64 {
    let case = format!(
        "space = \"axisymmetric\"\n[bodies.tube.solid]\n\
         mesh.box = {{ min = [1, 0], max = [2, 0.5], cells = [{cells}, 1] }}\ndegree = {degree}\nstrain = \"finite\"\n\
         material.{material}\n[supports.low]\non = \"tube:bottom\"\ndisplacement = [\"free\", 0]\n\
         [supports.high]\non = \"tube:top\"\ndisplacement = [\"free\", 0]\n[supports.inner]\non = \"tube:left\"\ndisplacement = [\"t\", \"free\"]\n[[steps]]\nto = 1\nincrements = 4\n"
    );
    let found = summary(&case, &set(&[]));
    let force = at(last_step(&found), "/support_forces/inner/0");
    // Incompressible with μ = 0.8: p = ∫ μ (λ² - λ⁻²)/r dr over r from 2 to sqrt(7), with R² = r² - 3.
    let n = 2000;
    let (a, b) = (2.0, 7f64.sqrt());
    let h = (b - a) / n as f64;
    let integrand = |k: usize| {
        let r: f64 = a + h * k as f64;
        let square = r * r / (r * r - 3.0);
        0.8 * (square - 1.0 / square) / r
    };
    let inner: f64 = (1..n).map(|k| integrand(k) * if k % 2 == 1 { 4.0 } else { 2.0 }).sum();
    let pressure = h / 3.0 * (integrand(0) + inner + integrand(n));
    // On a ring of radius 2 and height 0.5.
    force / (2.0 * std::f64::consts::PI * 2.0 * 0.5 * pressure) - 1.0
}

#[test]
fn nearly_incompressible_tubes_do_not_lock() {
    for ratio in [1e3, 1e5] {
        let material = format!("mooney_rivlin = {{ c10 = 0.3, c01 = 0.1, bulk_modulus = {} }}", 0.8 * ratio);
        // What a finite bulk modulus changes, from the finest functions.
        let compressible = tube(&material, 3, 8);
        assert!(compressible.abs() < 1.0 / ratio, "{ratio}: {compressible:e}");
        for (degree, meshes, order) in [(1, [8, 16], 1.8), (2, [4, 8], 3.7), (3, [2, 4], 4.5)] {
            let errors = meshes.map(|n| (tube(&material, degree, n) - compressible).abs());
            let found = (errors[0] / errors[1]).log2();
            println!("K/mu {ratio:e} degree {degree}: {errors:?}, order {found:.2}");
            assert!(found > order && errors[1] < 1e-4, "degree {degree}, {ratio}: {errors:?}, order {found}");
        }
    }
}

/// Neo-Hooke without the second constant of Mooney-Rivlin, one law by different keys.
#[test]
fn keys_of_one_law_give_one_result() {
    let pull = pulled("right", "[\"0.7*t\", \"free\", \"free\"]");
    let forces = [
        "mooney_rivlin = { c10 = 0.3, bulk_modulus = 8 }",
        "yeoh = { c = [0.3], bulk_modulus = 8 }",
        "ogden = { mu = [0.6], alpha = [2], bulk_modulus = 8 }",
    ]
    .map(|material| at(last_step(&block("3d", material, &pull)), "/support_forces/pull_right/0"));
    assert!(forces.iter().all(|f| (f - forces[0]).abs() < 1e-12), "{forces:?}");
}

/// Stretched along fibres that lie askew in the block, at nearly constant volume: the stress of the matrix and that of fibres.
#[test]
fn a_block_with_fibres_is_stretched_along_them() {
    let material = "mooney_rivlin = { c10 = 0.3, c01 = 0.1, bulk_modulus = 1e6, \
                    fibre = { direction = [\"1 + 0*x\", 0, 0], c3 = 0.2, c4 = 3, c5 = 1.5, stretch = 1.2 } }";
    for stretch in [0.8, 1.1, 1.4f64] {
        let pull = format!("[\"{}*t\", \"free\", \"free\"]", stretch - 1.0);
        let force = at(last_step(&block("3d", material, &pulled("right", &pull))), "/support_forces/pull_right/0");
        let matrix = 2.0 * (stretch.powi(2) - 1.0 / stretch) * (0.3 + 0.1 / stretch);
        let fibre = match stretch {
            s if s < 1.0 => 0.0,
            s if s < 1.2 => 0.2 * ((3.0 * (s - 1.0)).exp() - 1.0),
            s => 0.2 * (0.6f64.exp() - 1.0) + 1.5 * (s - 1.2),
        };
        let exact = (matrix + fibre) / stretch;
        assert!((force - exact).abs() < 1e-5 * exact.abs(), "{stretch}: {force} {exact}");
    }
}

/// A square whose boundary is moved by the strains of a uniaxial stress at an angle to the axes of the material, shear among them:
/// its energy is half the stress times the strain `1/E = c⁴/S11 + …`, in plane stress by the compliance itself, in plane strain
/// by that without strain across.
#[test]
fn orthotropic_squares_are_stressed_along_one_line() {
    // ε = S σ along the axes of the material.
    let s = [[0.1, -0.03, -0.02], [-0.03, 0.25, -0.35 / 4.0], [-0.02, -0.35 / 4.0, 0.5]];
    for (space, angle) in [("plane_stress", 30.0f64), ("plane_strain", 30.0), ("plane_strain", -65.0)] {
        let (sine, cosine) = angle.to_radians().sin_cos();
        let reduced = |i: usize, j: usize| match space {
            "plane_stress" => s[i][j],
            _ => s[i][j] - s[i][2] * s[j][2] / s[2][2],
        };
        // A stress of 0.1 along x: along the axes of the material, its strains there, and those along x and y.
        let stress = [cosine * cosine, sine * sine, -sine * cosine].map(|v| 0.1 * v);
        let [e1, e2] = [0, 1].map(|i| reduced(i, 0) * stress[0] + reduced(i, 1) * stress[1]);
        let e12 = stress[2] / (2.0 * 2.0);
        let xx = cosine * cosine * e1 + sine * sine * e2 - 2.0 * sine * cosine * e12;
        let yy = sine * sine * e1 + cosine * cosine * e2 + 2.0 * sine * cosine * e12;
        let xy = sine * cosine * (e1 - e2) + (cosine * cosine - sine * sine) * e12;
        let case = format!(
            "space = \"{space}\"\n[bodies.plate.solid]\nmesh.box = {{ min = [0, 0], max = [1, 1], cells = [2, 2] }}\n\
             material.orthotropic = {{ youngs_moduli = [10, 4, 2], poissons_ratios = [0.3, 0.2, 0.35], \
             shear_moduli = [2, 1.5, 0.8], axes = [[{cosine}, {sine}], [{}, {cosine}]] }}\n\
             [supports.all]\non = \"plate:boundary\"\n\
             displacement = [\"{xx}*x + {xy}*y\", \"{xy}*x + {yy}*y\"]\n",
            -sine
        );
        let found = summary(&case, &set(&[]));
        let (energy, exact) = (at(last_step(&found), "/energy"), 0.5 * 0.1 * xx);
        assert!((energy - exact).abs() < 1e-13, "{space} {angle}: {energy} {exact}");
    }
}

/// `u = ∫ σ/E dx` of a bar whose modulus grows along it, by functions of high degree; and neo-Hooke, point by point.
#[test]
fn bars_of_varying_modulus_are_exact() {
    let bar = |strain: &str, material: &str| {
        let case = format!(
            "space = \"plane_strain\"\n[bodies.bar.solid]\nmesh.box = {{ min = [0, 0], max = [10, 1], cells = [4, 1] }}\n\
             degree = 7\nstrain = \"{strain}\"\nmaterial.{material} = {{ youngs_modulus = \"1000*(1 + x/10)\", \
             poissons_ratio = 0 }}\n[supports.all]\non = \"bar:left\"\ndisplacement = [0, 0]\n\
             [loads.pull]\non = \"bar:right\"\ntraction = [300, 0]\n[output.probes]\nend = [10, 0]\n"
        );
        at(last_step(&summary(&case, &set(&[]))), "/probes/end/displacement/0")
    };
    let linear = bar("small", "linear_elastic");
    assert!((linear - 3.0 * 2f64.ln()).abs() < 1e-9, "{linear}");
    // λ - 1/λ = σ/μ(x) with μ = E/2 by Simpson's rule; across the bar nothing moves without a Poisson's ratio.
    let stretch = |x: f64| {
        let ratio = 300.0 / (500.0 * (1.0 + x / 10.0));
        0.5 * (ratio + (ratio * ratio + 4.0f64).sqrt()) - 1.0
    };
    let n = 1000;
    let h = 10.0 / n as f64;
    let inner: f64 = (1..n).map(|k| stretch(h * k as f64) * if k % 2 == 1 { 4.0 } else { 2.0 }).sum();
    let exact = h / 3.0 * (stretch(0.0) + inner + stretch(10.0));
    let neo = bar("finite", "neo_hooke");
    assert!((neo - exact).abs() < 1e-8, "{neo} {exact}");
}

/// Softening is told with its place and stretches; constants that make no sense with their key.
#[test]
fn materials_that_are_none_are_told() {
    let soft = "mooney_rivlin = { c10 = 0.5, c01 = -0.1, bulk_modulus = 100 }";
    let both = pulled("right", "[\"0.7*t\", \"free\"]") + &pulled("top", "[\"free\", \"0.7*t\"]");
    let found = block("plane_stress", soft, &both);
    let warnings = found["warnings"].as_array().expect("warnings");
    let told = warnings.iter().find(|w| w["kind"] == "unstable_material").expect("a warning of the material");
    assert!(told["message"].as_str().is_some_and(|m| m.contains("1.7000, 1.7000")), "{told}");
    let case = |space: &str, strain: &str, material: &str| {
        format!(
            "space = \"{space}\"\n[bodies.block.solid]\nmesh.box = {{ min = [0, 0], max = [1, 1], cells = [2, 2] }}\n\
             strain = \"{strain}\"\nmaterial.{material}\n[supports.all]\non = \"block:left\"\ndisplacement = [0, 0]\n"
        )
    };
    for (space, strain, material, key, words) in [
        ("plane_strain", "small", soft, "material", "finite strain"),
        (
            "plane_strain",
            "finite",
            "mooney_rivlin = { c10 = -0.5, bulk_modulus = 1 }",
            "mooney_rivlin",
            "shear modulus",
        ),
        ("plane_strain", "finite", "yeoh = { c = [], bulk_modulus = 1 }", "yeoh.c", "1 to 3 constants"),
        ("plane_strain", "finite", "ogden = { mu = [1, 2], alpha = [2], bulk_modulus = 1 }", "ogden.alpha", "2 moduli"),
        ("plane_strain", "finite", "ogden = { mu = [1], alpha = [0], bulk_modulus = 1 }", "alpha", "exponent is 0"),
        (
            "plane_strain",
            "finite",
            "arruda_boyce = { mu = 1, locking_stretch = 0.5, bulk_modulus = 1 }",
            "locking_stretch",
            "0.5",
        ),
        (
            "plane_strain",
            "finite",
            "yeoh = { c = [1], bulk_modulus = 1, volumetric = \"cubic\" }",
            "volumetric",
            "cubic",
        ),
        (
            "plane_strain",
            "small",
            "orthotropic = { youngs_moduli = [1, 1, 1], poissons_ratios = [1.2, 0, 0], shear_moduli = [1, 1, 1] }",
            "poissons_ratios",
            "|v12| is 1.2",
        ),
        (
            "plane_strain",
            "small",
            "orthotropic = { youngs_moduli = [1, 1, 1], poissons_ratios = [0, 0, 0], shear_moduli = [1, 1, 1], \
             axes = [[1, 0, 1], [0, 1, 0]] }",
            "axes",
            "along z",
        ),
        (
            "plane_strain",
            "small",
            "linear_elastic = { youngs_modulus = \"x - 0.5\", poissons_ratio = 0.3 }",
            "material",
            "Young's modulus is -0.5 at (0.000000, 0.000000)",
        ),
        (
            "plane_strain",
            "small",
            "elastic_plastic = { youngs_modulus = 1, poissons_ratio = 0.3, yield_stress = [[1, 0], [0.5, 0.1]] }",
            "yield_stress",
            "row 2",
        ),
        (
            "plane_strain",
            "finite",
            "elastic_plastic = { youngs_modulus = 1, poissons_ratio = 0.3, yield_stress = 1, kinematic_hardening = -1 }",
            "kinematic_hardening",
            "must not be negative",
        ),
    ] {
        let found = error(&case(space, strain, material));
        let told = found.key.as_ref().map(|path| path.to_string()).unwrap_or_default();
        assert!(told.contains(key), "{material}: {told}");
        assert!(found.message.contains(words), "{material}: {}", found.message);
    }
}
