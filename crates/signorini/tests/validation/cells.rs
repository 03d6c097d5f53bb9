//! Bodies of finite cells from case files: beside reference solutions on fitted meshes, and mistakes told at their place.

use super::{error, example, last_step, number, set, summary};

/// The disc between two planes, and the pore that closes on itself, against solutions of high order on meshes that follow their
/// edges.
#[test]
fn cells_give_the_forces_of_fitted_meshes() {
    // Of half the disc, 20 cells of degree 2 along its radius.
    let found = summary(example("hertz_cells"), &set(&[]));
    let force = number(&last_step(&found)["contacts"]["touch"]["force"][1]);
    assert!((force / (0.5 * 0.018_384_631_7) - 1.0).abs() < 2e-3, "{force}");
    let found = summary(example("pore"), &set(&[]));
    let step = last_step(&found);
    let force = number(&step["support_forces"]["top"][1]).abs();
    assert!((force / 0.088_867_913_6 - 1.0).abs() < 1e-3, "{force}");
    assert!(number(&step["equilibrium_residual"]) < 1e-10);
}

/// A foam under a plate that presses its whole top: mean stress times the area of the box is the force of the plate, and the
/// floor does not move.
#[test]
fn a_foam_has_a_stress_strain_curve() {
    let found = summary(example("foam"), &set(&[]));
    let step = last_step(&found);
    let means = &step["cells"]["foam"];
    let force = number(&step["contacts"]["plate"]["force"][2]);
    let stress = number(&means["mean_stress"][2]);
    assert!((stress * 36.0 / force - 1.0).abs() < 1e-6, "{stress} {force}");
    let strain = number(&means["mean_strain"][2]);
    assert!((strain + 0.3 / 6.0).abs() < 1e-3, "{strain}");
}

#[test]
fn each_mistake_of_a_body_of_cells_is_told_at_its_place() {
    let table = [
        ("hertz_cells", "degree = 2", "degree = 9", "not between 1 and 8", "9"),
        ("hertz_cells", "radius = 1 }", "radius = -1 }", "must be positive", "-1"),
        ("hertz_cells", "cells = [20, 20],", "", "number of cells", "min"),
        ("hertz_cells", "cells = [20, 20]", "cells = [20, 0]", "0 is not between", "0"),
        ("hertz_cells", "cells = [20, 20]", "cells = [100000, 100000]", "GiB of memory", "cells"),
        ("hertz_cells", "max = [1.02, 1]", "max = [-1.02, 1]", "first must be below the second", "cells"),
        ("hertz_cells", "center = [0, 1]", "center = [9, 9]", "negative nowhere", "geometry"),
        ("hertz_cells", "geometry.sphere", "geometry.spere", "spere", "geometry"),
        ("hertz_cells", "\"disc:left\"", "\"disc:lift\"", "no group `lift`", "disc:lift"),
        (
            "hertz_cells",
            "degree = 2",
            "groups.a = \"y > 7\"\ndegree = 2",
            "no part of the boundary lies in `a`",
            "y > 7",
        ),
        ("hertz_cells", "degree = 2", "alpha = -1\ndegree = 2", "not between 0 and 1", "-1"),
        ("hertz_cells", "degree = 2", "degree = 2\nislands = \"sink\"", "sink", "sink"),
        ("hertz_cells", "material.linear_elastic", "material.neo_hooke", "for finite strain", "material"),
        ("foam", "spacing = [\"0.25 mm\", \"0.25 mm\", \"0.25 mm\"], ", "", "the size of its voxels", "foam.npy"),
        ("foam", "\"0.25 mm\", \"0.25 mm\", \"0.25 mm\"", "1, 1", "expected 3", "1, 1"),
        (
            "plate_holes",
            "displacement = [0, \"free\"]",
            "displacement = [\"free\", 0]",
            "restrains `plate` against",
            "plate",
        ),
        ("foam", "axes = \"zyx\"", "axes = \"zyz\"", "not an order of the directions", "zyz"),
        ("foam", "threshold = 550", "threshold = 99999", "all or none of the image", "geometry"),
        ("foam", ", threshold = 550", "", "neither `threshold` nor", "foam.npy"),
        ("foam", "threshold = 550", "threshold = 550, youngs_modulus = \"value\"", "both `threshold` and", "550"),
        ("foam", "foam.npy", "foam.xyz", "cannot be read", "foam.xyz"),
        ("foam", "foam.npy", ".", "without any TIFF", "."),
        ("pore_discs", "radius = 0.05", "radius = -0.05", "must be positive", "-0.05"),
        ("pore_discs", "radius = 0.05", "radius = nan", "not a finite number", "nan"),
        ("pore_discs", "radius = 0.05", "spacing = 0", "must be positive", "0"),
        ("pore_discs", "radius = 0.05", "raduis = 0.05", "unknown key `raduis`", "raduis"),
        ("pore_discs", "radius = 0.05", "radius = 0.05, centres = \"out\"", "unknown word `out`", "out"),
        ("pore_discs", "radius = 0.05", "penalty.penetration = -1", "must be positive", "-1"),
        (
            "pore_discs",
            "self_contact = \"block\"",
            "self_contact = \"block\"\nfriction.coulomb = { mu = 0.1 }",
            "is frictionless",
            "friction",
        ),
    ];
    for (name, from, to, message, at) in table {
        let case = example(name);
        assert!(case.contains(from), "`{from}` is not in the case");
        let error = error(&case.replacen(from, to, 1));
        let place = error.place.clone().unwrap_or_else(|| panic!("no place: {}", error.message));
        let shown = place.text[place.span.start..place.span.end.min(place.text.len())].to_string();
        let told = format!("{} {}", error.message, error.help.clone().unwrap_or_default());
        assert!(told.contains(message), "{to}: `{told}` has no `{message}`");
        assert!(shown.contains(at), "{to}: points at `{shown}`, not `{at}`");
    }
}

/// A body that its grid cuts off touches with that side, named or not; where a support holds a side, the body is cut off.
#[test]
fn a_body_as_a_whole_touches_with_the_sides_of_its_grid() {
    let case = "space = \"plane_strain\"\n[bodies.post.cells]\n\
        geometry.implicit = { negative_inside = \"abs(x) - 0.37\", min = [-0.5, 0], max = [0.5, 1] }\n\
        mesh.grid = { cells = [2, 2] }\ndegree = 2\nmaterial.linear_elastic = { youngs_modulus = 10, poissons_ratio = 0.3 }\n\
        [bodies.plate.rigid]\nshape.plane = { point = [0, 1], normal = [0, -1] }\n\
        motion.prescribed = { displacement = [0, \"-0.01*t\"] }\n[supports.base]\non = \"post:bottom\"\n\
        displacement = [0, 0]\n[contacts.press]\nbetween = [\"post\", \"plate\"]\n[[steps]]\nto = 1\n";
    let force = |case: &str| {
        let found = summary(case, &set(&[]));
        let contact = last_step(&found)["contacts"]["press"].clone();
        (number(&contact["force"][1]), number(&contact["area"]))
    };
    let (whole, top) = (force(case), force(&case.replace("[\"post\"", "[\"post:top\"")));
    assert!((top.1 - 0.74).abs() < 1e-9 && top.0 < -0.05, "{top:?}");
    assert!((whole.0 / top.0 - 1.0).abs() < 1e-9 && (whole.1 / top.1 - 1.0).abs() < 1e-9, "{whole:?} {top:?}");
    // The same where the base is held along its normal, and aside by its middle.
    let normal =
        case.replace("displacement = [0, 0]", "normal = 0\n[supports.side]\non = \"post\"\nspring = [1e-6, 0]");
    let free = case.replace(
        "displacement = [0, 0]",
        "displacement = [\"free\", 0]\n[supports.side]\non = \"post\"\nspring = [1e-6, 0]",
    );
    assert_eq!(force(&normal), force(&free));
    // Moments about a point: of the support and the plate they cancel, as the forces do.
    let about = case.to_string() + "[output]\nmoments_about = [2, 0]\n";
    let found = summary(&about, &set(&[]));
    let step = last_step(&found);
    let [plate, base] = [&step["contacts"]["press"]["moment"], &step["support_moments"]["base"]].map(|m| number(&m[2]));
    assert!((plate + 2.0 * top.0).abs() < 1e-9 && (base + plate).abs() < 1e-9, "{plate} {base} {}", top.0);
    assert_eq!(number(&step["moments_about"][0]), 2.0);
}

/// Cells of degree 1 lock where the material hardly compresses, which is told.
#[test]
fn cells_that_lock_are_told() {
    let case = example("hertz_cells")
        .replace("degree = 2", "degree = 1")
        .replace("poissons_ratio = 0.3", "poissons_ratio = 0.499");
    let warned = |case: &str| {
        let problem = signorini::case::read("case.toml", case, &[]).expect("a case");
        signorini::run::sizes(&signorini::plan::plan(&problem).expect("a plan")).expect("sizes")["warnings"].to_string()
    };
    assert!(case.contains("0.499") && warned(&case).contains("lock with Poisson's ratio 0.499"), "{}", warned(&case));
    assert!(!warned(example("hertz_cells")).contains("lock"));
}
