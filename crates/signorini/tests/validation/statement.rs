//! Problems stated in types: errors by keys, fields and meshes of a program, and the text that states the same.

use signorini::case::read;
use signorini::gallery::GALLERY;
use signorini::plan::plan;
use signorini::problem::*;
use signorini::run::{Ending, keep, solve};
use signorini_solve::Silent;

/// A membrane over a floor on a line, by its floor.
fn string(height: Value) -> Problem {
    let mut problem = Problem::new(Space::Line);
    let grid = GridMesh { cells: Some([20].into()), ..GridMesh::default() };
    let domain = Domain::Interval(Interval { from: (-1.0).into(), to: 1.0.into() });
    let film = Membrane { domain: Some(domain), mesh: Mesh::Grid(grid), degree: Some(2), tension: 1.0.into() };
    problem.bodies.insert("film".into(), Body::Membrane(film));
    problem.bodies.insert("floor".into(), Body::Rigid(Rigid::new(Shape::Height(height))));
    let rim = Support { on: "film:boundary".into(), displacement: Some(0.0.into()), ..Support::default() };
    problem.supports.insert("rim".into(), rim);
    problem.loads.insert("press".into(), Load { on: "film".into(), normal: Some((-1.0).into()), ..Load::default() });
    let between = Some(["film", "floor"].into());
    problem.contacts.insert("touch".into(), Contact { between, ..Contact::default() });
    problem
}

/// Errors of a problem without a text tell the key, and of an expression the place in it.
#[test]
fn errors_tell_the_key() {
    let mut problem = string("-0.1".into());
    let Some(Body::Membrane(film)) = problem.bodies.get_mut("film") else { panic!("a membrane") };
    film.degree = Some(9);
    let error = plan(&problem).err().expect("an error");
    assert_eq!(error.one_line(), "bodies.film.membrane.degree: degree 9 is not between 1 and 6");
    let error = plan(&string("-0.1*q".into())).err().expect("an error");
    assert_eq!(error.key.expect("a key").to_string(), "bodies.floor.rigid.shape.height");
    assert_eq!(error.place.expect("a place").span, 5..6);
}

/// What a text states wrongly is told by its key, as by its place.
#[test]
fn errors_of_texts_tell_the_key() {
    for (text, key) in [
        ("[loads.press]\non = \"film\"\nnromal = 1", "loads.press.nromal"),
        ("[bodies.belt.rope]\npath.points = [[0, true]]", "bodies.belt.rope.path.points[0][1]"),
        ("[bodies.ball.rigid]\nshape.sphree = {}", "bodies.ball.rigid.shape.sphree"),
        ("space = \"plain\"", "space"),
    ] {
        let error = read("case.toml", text, &[]).expect_err("an error");
        assert!(error.place.is_some());
        assert_eq!(error.key.expect("a key").to_string(), key);
    }
}

/// A run that is kept in memory has its states, history and pictures; one in a folder has its states too.
#[test]
fn a_run_is_kept_in_memory() {
    let problem = string("-0.1".into());
    let (outcome, files) = keep(&problem, None, &mut Silent).unwrap();
    assert_eq!((outcome.ending, outcome.states.len()), (Ending::Converged, 1));
    assert!(files.contains_key("history.csv") && files.contains_key("pictures/deflection.png"));
    assert_eq!(outcome.summary.first_picture.as_deref(), Some("pictures/deflection.png"));
    let folder = tempfile::tempdir().unwrap();
    let (again, files) = keep(&problem, Some(&folder.path().join("out")), &mut Silent).unwrap();
    assert!(files.is_empty() && again.states.len() == 1 && folder.path().join("out/fields.pvd").exists());
    assert_eq!(again.summary.steps, outcome.summary.steps);
}

/// A file may exist in memory only.
#[test]
fn a_file_is_read_from_memory() {
    let mut problem = string("-0.1".into());
    assert!(problem.source.read("floor.csv").is_err());
    problem.source.files = std::sync::Arc::new([("floor.csv".to_string(), b"0, 1".to_vec())].into());
    assert_eq!(problem.source.read("floor.csv").unwrap(), b"0, 1");
}

/// A floor as a number, an expression, a function and samples is the same floor.
#[test]
fn fields_are_stated_in_any_way() {
    let of = |x: f64| -0.2 + 0.05 * x;
    let samples = (0..5).map(|_| (0..9).map(|k| of(-2.0 + 0.5 * f64::from(k))).collect()).collect::<Vec<Vec<f64>>>();
    let samples = Grid2 { origin: [-2.0, -2.0], spacing: [0.5, 1.0], values: samples.into() };
    let ways: [Value; 3] = ["-0.2 + 0.05*x".into(), Value::field(|[x, _, _]| x * 0.05 - 0.2), samples.into()];
    let found = ways.map(|height| {
        let outcome = solve(&string(height), &mut Silent).expect("a run");
        assert_eq!(outcome.ending, Ending::Converged);
        let state = outcome.states.last().expect("a state");
        assert_eq!(state.bodies[0].name, "film");
        let lowest = state.bodies[0].array("gap").expect("gaps").iter().copied().fold(f64::INFINITY, f64::min);
        assert!(lowest.abs() < 1e-9, "{lowest}");
        outcome.summary.steps[0].contacts["touch"].force[2]
    });
    assert!(found.iter().all(|f| (f - found[0]).abs() < 1e-9 && *f > 0.1), "{found:?}");
}

/// Two quadrilaterals of arrays under a pressure have the stress of a bar, and errors of arrays tell which entry.
#[test]
fn meshes_are_arrays() {
    let bar = |nodes: Vec<Vec<u32>>| {
        let mut problem = Problem::new(Space::PlaneStress);
        let points =
            vec![vec![0.0, 0.0], vec![1.0, 0.0], vec![2.0, 0.0], vec![0.0, 1.0], vec![1.0, 1.0], vec![2.0, 1.0]];
        let mesh = MeshArrays {
            points: points.into(),
            cells: vec![CellArrays { shape: "quadrilateral".into(), nodes: nodes.into() }].into(),
            groups: Named([("left".to_string(), vec![0, 3].into()), ("right".to_string(), vec![2, 5].into())].into()),
        };
        let material = LinearElastic { youngs_modulus: 100.0.into(), poissons_ratio: 0.0.into() };
        let solid = Solid {
            mesh: SolidMesh::Arrays(mesh),
            degree: None,
            material: Material::LinearElastic(material),
            strain: None,
            density: None,
            thermal: None,
            velocity: None,
            edges: Named::default(),
        };
        problem.bodies.insert("bar".into(), Body::Solid(solid));
        let left = Support { on: "bar:left".into(), displacement: Some([0.0, 0.0].into()), ..Support::default() };
        problem.supports.insert("left".into(), left);
        let right = Load { on: "bar:right".into(), traction: Some([1.0, 0.0].into()), ..Load::default() };
        problem.loads.insert("right".into(), right);
        problem
    };
    let outcome = solve(&bar(vec![vec![0, 1, 4, 3], vec![1, 2, 5, 4]]), &mut Silent).expect("a run");
    let fields = &outcome.states[0].bodies[0];
    let moved = fields.array("displacement").expect("displacements");
    for (x, u) in fields.points.iter().zip(moved.chunks(3)) {
        assert!((u[0] - 0.01 * x[0]).abs() < 1e-12 && u[1].abs() < 1e-12, "{x:?}: {u:?}");
    }
    let told = |nodes| plan(&bar(nodes)).err().expect("an error").one_line();
    assert!(told(vec![vec![0, 1, 4]]).contains("cell 0 of the quadrilaterals: no such cell has 3 nodes"));
    assert!(told(vec![vec![0, 1, 9, 3]]).contains("there is no point 9"));
    assert!(told(vec![vec![0, 1, 4, 3]]).starts_with("bodies.bar.solid.mesh.arrays"));
}

/// A problem that is stated in types is the one that its text states.
#[test]
fn a_problem_is_written_as_the_text_that_states_it() {
    for example in GALLERY {
        let problem = read(example.name, example.case, &[]).expect(example.name);
        let written = without_source(&problem);
        let again = read(example.name, &written, &[]).expect(example.name);
        assert_eq!(without_source(&again), written, "{}", example.name);
        assert_eq!(format!("{:?}", again.bodies), format!("{:?}", problem.bodies), "{}", example.name);
    }
}

/// The text of a problem as if no text had stated it.
fn without_source(problem: &Problem) -> String {
    signorini::case::text(&Problem { source: Source::default(), ..problem.clone() })
}
