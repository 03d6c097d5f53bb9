//! Decks of CalculiX and Abaqus.

use crate::{case_of, deck, refused, written};
use signorini_import::curve::Curve;
use signorini_import::deck::{Deck, Friction, Law, LoadKind, Place};
use signorini_import::{case, read};

/// Two cubes on top of each other; `{model}` stands behind the mesh, `{steps}` at the end.
fn cubes(model: &str, steps: &str) -> String {
    format!(
        "*HEADING
two cubes
** a comment
*NODE, NSET=Nall
1, 0, 0, 0
2, 1, 0, 0
3, 1, 1, 0
4, 0, 1, 0
5, 0, 0, 1
6, 1, 0, 1
7, 1, 1, 1
8, 0, 1, 1
11, 0, 0, 1
12, 1, 0, 1
13, 1, 1, 1
14, 0, 1, 1
15, 0, 0, 2
16, 1, 0, 2
17, 1, 1, 2
18, 0, 1, 2
*ELEMENT, TYPE=C3D8, ELSET=Eall
1, 1, 2, 3, 4,
   5, 6, 7, 8
2, 11, 12, 13, 14, 15, 16, 17, 18
*NSET, NSET=Bottom, GENERATE
1, 4, 1
*NSET, NSET=Top
15, 16
17, 18
*SURFACE, NAME=Low
1, S2
*Surface, Name=High, type=ELEMENT
2, S1
*MATERIAL, NAME=EL
*ELASTIC
210000., .3
*SOLID SECTION, ELSET=EALL, MATERIAL=el
{model}
*BOUNDARY
Bottom, 1, 3
{steps}"
    )
}

const CONTACT: &str = "*CONTACT PAIR, INTERACTION=I1,
 TYPE=SURFACE TO SURFACE
High, Low
*SURFACE INTERACTION, NAME=I1
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
1.e7, 3.
*FRICTION
0.2, 1.e5";

const STEP: &str = "*STEP
*STATIC
0.25, 1.
*DLOAD
2, P2, 10.
*CLOAD
Top, 1, 2.
17, 1, 1.
*NODE PRINT, NSET=Nall
U
*END STEP";

#[test]
fn a_deck_becomes_bodies_supports_loads_and_contacts() {
    let text = cubes(CONTACT, STEP).replace("*SOLID SECTION", "*DENSITY\n7.8e-9,\n*SOLID SECTION");
    let deck = deck("cubes.inp", &text).unwrap();
    assert_eq!(deck.title.as_deref(), Some("two cubes"));
    assert_eq!((deck.nodes.len(), deck.elements.len()), (16, 2));
    assert_eq!(deck.node_sets.get("bottom").unwrap().1, &vec![1, 2, 3, 4]);
    assert_eq!(deck.surfaces.get("LOW").unwrap().1.faces, vec![vec![5, 8, 7, 6]]);
    assert_eq!(deck.contacts[0].friction, Friction::Coulomb(Curve::constant(0.2)));
    let [step] = &deck.steps[..] else { panic!("one step") };
    assert_eq!((step.to, step.increments), (1.0, 4));
    let written = case_of("cubes.inp", &text);
    for line in [
        "# - line 44: the stiffness 10000000.0 of the surfaces is left out; here they do not penetrate (`signorini import --keep-stiffness` keeps it)",
        "density = 7.8e-9",
        "material.linear_elastic = { youngs_modulus = 210000.0, poissons_ratio = 0.3 }",
        "connected_to = 11",
        "sides.pressure = [\"2 2\"]",
        "on = \"Eall:Bottom\"",
        "displacement = [0.0, 0.0, 0.0]",
        "pressure = \"10.0*t\"",
        "between = [\"Eall_2:High\", \"Eall:Low\"]",
        "friction.coulomb = { mu = 0.2 }",
        // The node 17 carries both forces.
        "nodal_force = [\"2.0*t\", 0.0, 0.0]",
        "nodal_force = [\"3.0*t\", 0.0, 0.0]",
        "increments = 4",
    ] {
        assert!(written.lines().any(|l| l == line), "`{line}` is not in\n{written}");
    }
}

/// Values ramp from step to step, follow amplitudes, and removed loads ramp down.
#[test]
fn histories_go_through_all_steps() {
    let steps = "*AMPLITUDE, NAME=A
0., 0., .5, 1., 1., 0.5
*STEP, NLGEOM
*STATIC
1., 2.
*BOUNDARY
Top, 3, 3, -0.4
*CLOAD, AMPLITUDE=A
12, 2, 8.
*END STEP
*STEP, NLGEOM
*STATIC
*BOUNDARY
Top, 3, 3, 0.2
*CLOAD, OP=NEW
*END STEP";
    let deck = deck("steps.inp", &cubes("", steps)).unwrap();
    assert!(deck.finite_strain);
    assert_eq!(deck.steps.iter().map(|s| s.to).collect::<Vec<_>>(), [2.0, 3.0]);
    let top = deck.supports.iter().find(|s| s.on == Place::NodeSet("Top".into())).unwrap();
    let height = top.displacement[2].as_ref().unwrap();
    for (t, v) in [(0.0, 0.0), (1.0, -0.2), (2.0, -0.4), (2.5, -0.1), (3.0, 0.2)] {
        assert!((height.at(t) - v).abs() < 1e-15, "{t}: {}", height.at(t));
    }
    let LoadKind::NodalForce(force) = &deck.loads[0].kind else { panic!("a force") };
    for (t, v) in [(0.25, 4.0), (0.5, 8.0), (1.0, 4.0), (2.0, 4.0), (2.5, 2.0), (3.0, 0.0)] {
        assert!((force[1].at(t) - v).abs() < 1e-15, "{t}: {}", force[1].at(t));
    }
}

#[test]
fn equal_displacements_are_tied_and_included_files_are_read() {
    let model = "*EQUATION\n2\n15, 3, 1., 16, 3, -1.\n2\n16, 3, 1., 17, 3, -1.\n*INCLUDE, INPUT=more.inp";
    let more = "** of the same deck\n*NSET, NSET=one\n15\n*BOUNDARY\none, 1\n";
    let (_folder, path) = written(&[("deck.inp", &cubes(model, STEP)), ("more.inp", more)]);
    let deck = read(&path).unwrap();
    let tied = deck.supports.iter().find(|s| s.tied == [false, false, true]).unwrap();
    assert_eq!(tied.on, Place::Nodes("equal".into(), vec![15, 16, 17]));
    let held = deck.supports.iter().find(|s| s.on == Place::NodeSet("one".into())).unwrap();
    assert!(held.displacement[0].is_some() && held.displacement[1].is_none());
    assert!(case::text(&deck, "deck.inp").unwrap().contains("tied = [false, false, true]"));
}

/// Unlike coefficients, along axes of their own, and the prescribed displacement of a node without elements.
#[test]
fn equations_become_constraints() {
    let model = "*NODE\n99, 0, 0, 0\n*NSET, NSET=turned\n17\n*TRANSFORM, NSET=turned\n0, 1, 0, -1, 0, 0
*EQUATION\n3\n15, 3, 1., 16, 3, -2.,\n99, 1, 4.\n2\n17, 1, 1., 15, 2, 3.\n*BOUNDARY\n99, 1";
    let steps = "*STEP\n*STATIC\n1., 1.\n*BOUNDARY\n99, 1, 1, 0.5\n*END STEP";
    let text = case_of("deck.inp", &cubes(model, steps));
    for line in [
        "    { on = \"Eall_2:node_16\", factor = [0.0, 0.0, -2.0] },",
        "value = \"-2.0*t\"",
        "    { on = \"Eall_2:node_17\", factor = [0.0, 1.0, 0.0] },",
    ] {
        assert!(text.lines().any(|l| l == line), "`{line}` is not in\n{text}");
    }
}

#[test]
fn laws_of_materials() {
    let law = |cards: &str| {
        let model = format!("*MATERIAL, NAME=M\n{cards}");
        deck("laws.inp", &cubes(&model, STEP)).unwrap().materials.get("M").unwrap().1.law.clone().unwrap()
    };
    let Law::MooneyRivlin { c10, c01, bulk_modulus, .. } = law("*HYPERELASTIC, NEO HOOKE\n0.5, 0.02") else { panic!() };
    assert_eq!((c10, c01, bulk_modulus), (0.5, 0.0, 100.0));
    let Law::Ogden { mu, alpha, bulk_modulus, .. } = law("*HYPERELASTIC, OGDEN, N=2\n1., 2., 3., -2., .01, 0.") else {
        panic!()
    };
    assert_eq!((mu, alpha, bulk_modulus), (vec![1.0, 3.0], vec![2.0, -2.0], 200.0));
    let Law::Yeoh { c, .. } = law("*HYPERELASTIC, YEOH\n.5, -.01, .001, .02") else { panic!() };
    assert_eq!(c, [0.5, -0.01, 0.001]);
    let Law::Plastic { hardening, .. } = law("*ELASTIC\n100., .3\n*PLASTIC, HARDENING=KINEMATIC\n2., 0.\n3., .1")
    else {
        panic!()
    };
    assert_eq!(format!("{hardening:?}"), "Kinematic { yield_stress: 2.0, modulus: 10.0 }");
}

#[test]
fn what_cannot_be_imported_is_named_with_its_line() {
    let line_of = |text: &str, what: &str| text.lines().position(|l| l.contains(what)).map(|k| k + 1);
    for (model, steps, at, told) in [
        ("*FANCY CARD", STEP, "*FANCY", "*FANCY CARD: this keyword is not known"),
        (
            "",
            "*STEP\n*HEAT TRANSFER\n*END STEP",
            "*HEAT",
            "*HEAT TRANSFER: cannot be imported: heat is not imported; state `thermal` of bodies, supports with a temperature and `contacts.NAME.heat` in the case",
        ),
        ("*NSET, NSET=N\n1, 99, Nothing", STEP, "Nothing", "*NSET: there is no set `Nothing`"),
        ("*BOUNDARY\n99, 1", STEP, "99, 1", "*BOUNDARY: there is no node 99"),
        (
            "*ELEMENT, TYPE=S4\n9, 1, 2, 3, 4",
            STEP,
            "TYPE=S4",
            "*ELEMENT: elements of type S4 are not known here: valid are",
        ),
        (
            "*SURFACE, NAME=Odd\n1, S7",
            STEP,
            "1, S7",
            "*SURFACE: the element 1, a hexahedron, has the faces 1 to 6, not 7",
        ),
        (
            "*NODE\n99, 0, 0, 0\n*EQUATION\n2\n15, 3, 1., 99, 3, -2.",
            STEP,
            "\n",
            "*EQUATION: the node 99 belongs to no element",
        ),
        ("*EQUATION\n2\n15, 3, 1., 16, 4, -2.", STEP, "15, 3, 1., 16", "*EQUATION: direction 4: valid are 1 to 3"),
    ] {
        let text = cubes(model, steps);
        let (line, message) = refused("wrong.inp", &text);
        assert!(message.starts_with(told), "{message}");
        if !at.starts_with('\n') {
            assert_eq!(line, line_of(&text, at), "{message}");
        }
    }
}

/// A support holds in the steps that state it, the coefficient of friction is that of its step, and a stiffness may be kept.
#[test]
fn supports_and_friction_change_with_steps() {
    let steps = "*STEP\n*STATIC\n*END STEP\n*STEP\n*STATIC\n1., 2.\n*BOUNDARY, OP=NEW\nTop, 1\n
*CHANGE FRICTION, INTERACTION=I1\n*FRICTION\n0.5\n*END STEP";
    let text = cubes(CONTACT, steps);
    let deck = Deck { keeps_stiffness: true, ..deck("released.inp", &text).unwrap() };
    // One for each direction.
    let mut times: Vec<_> = deck.supports.iter().map(|s| (s.on.clone(), s.from, s.until)).collect();
    times.dedup();
    let set = |name: &str| Place::NodeSet(name.into());
    assert_eq!(times, [(set("Top"), Some(1.0), None), (set("Bottom"), None, Some(1.0))]);
    let Friction::Coulomb(mu) = &deck.contacts[0].friction else { panic!("friction") };
    assert_eq!([mu.at(0.0), mu.at(1.0), mu.at(1.1), mu.at(3.0)], [0.2, 0.2, 0.5, 0.5]);
    let written = case::text(&deck, "released.inp").unwrap();
    for line in [
        "from = 1.0",
        "until = 1.0",
        "friction.coulomb = { mu = \"curve_1(t)\" }",
        "compliance.power = { pressure = 10000000.0, penetration = 1 }",
    ] {
        assert!(written.lines().any(|l| l == line), "`{line}` is not in\n{written}");
    }
}

/// Ties, and bodies of two materials that share nodes: tied on the faces that they share, with the forces on shared nodes once.
#[test]
fn ties_and_bodies_of_two_materials_are_tied() {
    let model = "*NODE\n21, 0, 0, -1\n22, 1, 0, -1\n23, 1, 1, -1\n24, 0, 1, -1
*ELEMENT, TYPE=C3D8, ELSET=Below\n3, 21, 22, 23, 24, 1, 2, 3, 4
*MATERIAL, NAME=SOFT\n*ELASTIC\n1., 0.\n*SOLID SECTION, ELSET=Below, MATERIAL=SOFT
*ELSET, ELSET=First\n1
*TIE, NAME=T, POSITION TOLERANCE=0.1\nHigh, Low";
    let steps = "*STEP\n*STATIC\n*CLOAD\nBottom, 1, 2.\n*END STEP";
    let written = case_of("two.inp", &cubes(model, steps).replace("Bottom, 1, 3\n", "21, 1, 3\n"));
    let tables: Vec<&str> = written.split("\n\n").collect();
    for table in [
        "[contacts.High_Low]\nbetween = [\"Eall:High\", \"First:Low\"]\ntied = true\ntie_distance = 0.1",
        "[contacts.First_Below_joined]\nbetween = [\"First:to Below\", \"Below:to First\"]\ntied = true",
    ] {
        assert!(tables.iter().any(|t| t.trim() == table), "`{table}` is not in\n{written}");
    }
    assert!(
        written.contains("sides.\"to Below\" = [\"1 1\"]") && written.contains("sides.\"to First\" = [\"3 2\"]"),
        "{written}"
    );
    assert_eq!(written.matches("nodal_force").count(), 1, "{written}");
}

/// Axes of nodes: those of supports are written, forces are turned, the sets stay whole where they overlap.
#[test]
fn transforms_are_axes_of_supports() {
    let steps = "*STEP\n*STATIC\n*BOUNDARY\nAround, 2\nLow, 3\n*CLOAD\n7, 1, 2.\n7, 2, 1.\n*END STEP";
    let sets = "*NSET, NSET=Around\n2, 3, 4, 6\n*NSET, NSET=Low\n1, 2, 3, 4\n*NSET, NSET=Both\n2, 3, 4, 6, 7, 1\n";
    let with =
        |kind: &str, points: &str| cubes(&format!("{sets}*TRANSFORM, NSET=Both, TYPE={kind}\n{points}\n"), steps);
    let about = case_of("turned.inp", &with("C", "0, -1, 0, 0, -1, 1"));
    assert!(about.contains("displacement = [\"free\", 0.0, \"free\"]\naxes.cylindrical = { point = [0.0, -1.0, 0.0], axis = [0.0, 0.0, 1.0] }"), "{about}");
    for set in ["Around\"", "Low nodes\""] {
        assert!(about.contains(set), "{about}");
    }
    // Node 7 is at (1, 1, 1), outwards is (1, 2)/√5: 2 of it and 1 around.
    let found = deck("turned.inp", &with("C", "0, -1, 0, 0, -1, 1")).unwrap();
    let force = found.loads.iter().find_map(|l| match &l.kind {
        LoadKind::NodalForce(f) => Some(f.each_ref().map(|c| c.at(1.0))),
        _ => None,
    });
    let [x, y, z] = force.unwrap();
    assert!(x.abs() < 1e-15 && (y - 5f64.sqrt()).abs() < 1e-15 && z == 0.0, "{x} {y} {z}");
    let inclined = case_of("turned.inp", &with("R", "1, 1, 0, -1, 1, 0"));
    assert!(inclined.contains("axes.rectangular = [[1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]]"), "{inclined}");
    for (kind, points, told) in [
        ("S", "0, 0, 0, 0, 0, 1", "TYPE=S: valid are R and C"),
        ("R", "1, 1, 0, 2, 2, 0", "the two points make no axes"),
        ("C", "1, 0, 0, 1, 0, 1", "it lies on the line about which the axes turn"),
    ] {
        let message = refused("turned.inp", &with(kind, points)).1;
        assert!(message.contains(told), "{message}");
    }
}
