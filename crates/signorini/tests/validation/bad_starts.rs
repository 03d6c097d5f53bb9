//! Curves that cannot start as they are stated, surfaces that bound nothing, yarns that do not lie: what is told, and the
//! remedy.

use super::example;

/// All that is said of a case: its error with the help, or its verdict, or the warnings of `check`.
fn said(case: &str) -> String {
    let of = |e: signorini::problem::CaseError| format!("{} ({})", e.message, e.help.unwrap_or_default());
    if !case.contains("analysis") {
        let check = || {
            let problem = signorini::case::read("case.toml", case, &[])?;
            signorini::run::sizes(&signorini::plan::plan(&problem)?)
        };
        return check().map_or_else(of, |sizes| sizes["warnings"].to_string());
    }
    let paths = match signorini::paths::PathCase::parse("case.toml", case, &[]) {
        Ok(paths) => paths,
        Err(error) => return of(error),
    };
    let folder = tempfile::tempdir().expect("a folder");
    match signorini::paths::run(&paths, &folder.path().join("out"), &mut signorini::run::Silent) {
        Ok(summary) => summary.verdict,
        Err(signorini::scene::SceneError::Case(error)) => of(error),
        Err(other) => other.to_string(),
    }
}

#[test]
fn bad_starts_are_told_with_the_remedy() {
    let folder = tempfile::tempdir().expect("a folder");
    let open = folder.path().join("open.stl");
    let facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
    std::fs::write(&open, format!("solid open\n{facet}endsolid\n")).expect("a file");
    let open = format!("shape.stl = {{ file = \"{}\" }}", open.display());
    let egg = "shape.ellipsoid = { center = [0, 0, 0], semi_axes = [2, 1.5, 1] }";
    let mandrel = "shape.ellipsoid = { center = [0, 0, 0], semi_axes = [50, 50, 30] }";
    let ring = "shape.torus = { center = [0, 0, 0], axis = [0, 0, 1], major_radius = 50, minor_radius = 15 }";
    let pattern = "pattern = { circuits = \"auto\" }";
    let opening = "polar_opening = { radius = 22 }";
    // Case of the gallery, what stands and what a user writes there, and words of what is told.
    let table: [(&str, &[(&str, &str)], [&str; 2]); 9] = [
        (
            "geodesic",
            &[("from = [-3, \"0.5 + 2*(1 - t)\", 0.3]", "from = [0.5, 0, 0.2]")],
            ["the start of the path `string` lies inside `egg`, 7.", "outside of the body"],
        ),
        (
            "geodesic",
            &[(egg, &open)],
            ["is not closed: 3 edges have one triangle, such as that at (0.5000, 0", "close"],
        ),
        ("geodesic", &[("to = [2.2,", "to = [nan,")], ["not a finite number", ""]),
        (
            "dome",
            &[(opening, "slippage = 0.4\nlength = 60")],
            ["`to_the_opening` slips from s = ", "a larger coefficient"],
        ),
        (
            "dome",
            &[(mandrel, ring), (opening, "slippage = 0\nlength = 200"), ("25 deg", "85 deg"), (pattern, "length = 50")],
            ["`to_the_opening` bridges from s = ", "the mandrel is concave along the yarn"],
        ),
        (
            "crossing",
            &[("0.11],[0,2,0.11]", "0.02],[0,2,0.02]")],
            ["starts 8.0000e-2 deep inside", "at least the sum of the radii"],
        ),
        (
            "capstan",
            &[("pretension = 1.0", "unstrained_length = 1.0")],
            ["`rope` is shorter than the distance of its ends", "a longer `unstrained_length`"],
        ),
        ("capstan", &[("stiffness = 1e4", "stiffness = 0")], ["must be positive", ""]),
        ("knot", &[("u^3 - 3*u", "0*u")], ["the path crosses itself at (", "at the arc lengths"]),
    ];
    for (name, changes, words) in table {
        let mut case = example(name).to_string();
        for (from, to) in changes {
            assert!(case.contains(from), "{name}: `{from}` is not in the case");
            case = case.replacen(from, to, 1);
        }
        let told = said(&case);
        println!("{name}: {told}");
        assert!(words.iter().all(|word| told.contains(word)), "{name}, {changes:?}: {told}");
    }
}

/// A punch at a height over a block, at finite strain; a body of cells over or in a half space.
fn punched(height: f64, contact: &str) -> String {
    format!(
        "space = \"plane_strain\"\n[bodies.block.solid]\nstrain = \"finite\"\ndegree = 1\n\
         material.neo_hooke = {{ youngs_modulus = 10, poissons_ratio = 0.4 }}\n\
         mesh.box = {{ min = [-2, 0], max = [2, 2], cells = [8, 4] }}\n\
         [bodies.punch.rigid]\nshape.cylinder = {{ point = [0.1, {height}], radius = 2 }}\n\
         motion.prescribed = {{ displacement = [0, \"-3*t\"] }}\n[supports.base]\non = \"block:bottom\"\ndisplacement = [0, 0]\n\
         [contacts.press]\nbetween = [\"block:top\", \"punch\"]\n{contact}\n[[steps]]\nto = 0.2\n"
    )
}

#[test]
fn surfaces_that_start_inside_a_rigid_body_are_told() {
    let egg = "space = \"3d\"\n[bodies.egg.cells]\ngeometry.ellipsoid = { center = [0, 0, 0], semi_axes = [10, 8, 12] }\n\
               mesh.grid = { cells = [3, 3, 3] }\ndegree = 1\n\
               material.linear_elastic = { youngs_modulus = 100, poissons_ratio = 0.35 }\ngroups.low = \"z < -11\"\n\
               [bodies.high.rigid]\nshape.plane = { point = [0, 0, 12], normal = [0, 0, 1] }\n\
               [supports.base]\non = \"egg:low\"\ndisplacement = [0, 0, 0]\n[contacts.high]\nbetween = [\"egg\", \"high\"]\n\
               [[steps]]\nto = 1\n";
    for (case, wanted) in [
        (punched(1.0, ""), "`block` starts 9.9"),
        (punched(1.0, "method.node = {}"), "`block` starts 9.9"),
        (egg.to_string(), "`egg` starts 2"),
    ] {
        let error = super::error(&case);
        assert!(error.message.contains(wanted) && error.message.contains("deep inside"), "{}", error.message);
    }
    // A jump into the block is cut, and ends where it does with more increments.
    for contact in ["", "method.node = {}"] {
        let found = super::summary(&punched(4.01, contact), &super::set(&[]));
        let depth = super::number(&super::last_step(&found)["contacts"]["press"]["force"][1]);
        assert!(depth < 0.0, "{depth}");
    }
}
