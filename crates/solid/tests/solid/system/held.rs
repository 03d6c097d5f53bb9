//! Supports: prescribed fields on curved sides, resultants of reactions.

use super::*;

#[test]
fn reactions_add_up_to_the_loads_at_any_degree() {
    for degree in 1..=4 {
        let mesh = rectangle([0.0, 0.0], [2.0, 1.0], [3, 2], 2, |x| Point::<2>::new(x[0], x[1] + 0.1 * x[0] * x[0]));
        let mut system = System::default();
        system.bodies.push(Box::new(solid("beam", mesh, degree, ELASTIC, StressLaw::LinearElastic)));
        system.supports.push(hold(0, "left", [Some(0.0), Some(0.0), None]));
        system.loads.push(load(0, "right", TimedLoad::Force(Arc::new(|_, t| v(0.01, -0.02, 0.0) * t))));
        let (_, results) = run(&mut system, &[1.0]);
        let reaction = results[0].support_forces[0][0];
        assert!((reaction - v(-0.01, 0.02, 0.0)).norm() < 1e-11, "degree {degree}: {reaction}");
    }
}

#[test]
fn a_prescribed_field_is_met_as_well_as_the_functions_can() {
    // A cubic on the boundary is met exactly by cubic functions, and by all at the vertices.
    let field: TimeField = Arc::new(|x, _| 0.01 * x[0].powi(3));
    for degree in [1, 3, 4] {
        let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [2, 2], 1, |x| x);
        let body = solid("body", mesh, degree, ELASTIC, StressLaw::LinearElastic);
        let mut system = System { bodies: vec![Box::new(body)], ..System::default() };
        system.supports.push(Support {
            name: "all round".into(),
            part: part(0, "boundary"),
            displacement: [Some(field.clone()), Some(Arc::new(|_, _| 0.0)), None],
            rotation: [None, None, None],
            ..Support::default()
        });
        let (state, _) = run(&mut system, &[1.0]);
        let fields = system.bodies[0].fields(&state.bodies[0]);
        for (x, u) in fields.points.iter().zip(&fields.displacement) {
            if x[0] * (1.0 - x[0]) * x[1] * (1.0 - x[1]) == 0.0 {
                assert!((u[0] - 0.01 * x[0].powi(3)).abs() < 1e-14, "degree {degree}: {x} {u}");
            }
        }
    }
}

/// A block between two planes, turned as a whole: held along its normals it does what it does along the axes.
#[test]
fn inclined_supports_hold_as_those_along_the_axes_do() {
    let solve = |angle: f64, degree: usize| {
        let (sin, cos) = angle.sin_cos();
        let turned = move |x: Vector<3>| v(cos * x[0] - sin * x[1], sin * x[0] + cos * x[1], x[2]);
        let mesh = cuboid([0.0; 3], [1.0, 0.8, 0.5], [3, 2, 2], turned);
        let mut system = System::default();
        system.bodies.push(Box::new(solid("block", mesh, degree, ELASTIC, StressLaw::LinearElastic)));
        for (group, normal, value) in
            [("left", v(-1.0, 0.0, 0.0), 0.0), ("right", v(1.0, 0.0, 0.0), -0.02), ("bottom", v(0.0, 0.0, -1.0), 0.0)]
        {
            let field: TimeField = Arc::new(move |_, t| value * t);
            system.supports.push(Support { along: Some((turned(normal), field)), ..hold(0, group, [None; 3]) });
        }
        // Along the edges that two supports share, and again what one of them says.
        system.supports.push(Support {
            along: Some((turned(v(2.0, 0.0, 0.0)), Arc::new(|_, _| 0.0))),
            ..hold(0, "left", [None; 3])
        });
        let field: TimeField = Arc::new(|_, t| 0.01 * t);
        system
            .supports
            .push(Support { along: Some((turned(v(0.0, -1.0, 0.0)), field)), ..hold(0, "front", [None; 3]) });
        let (state, results) = run(&mut system, &[1.0]);
        let fields = system.bodies[0].fields(&state.bodies[0]);
        let back = |x: &Vector<3>| v(cos * x[0] + sin * x[1], -sin * x[0] + cos * x[1], x[2]);
        let forces: Vec<Vector<3>> = results[0].support_forces.iter().map(|f| back(&f[0])).collect();
        let moved: Vec<Vector<3>> = fields.displacement.iter().map(back).collect();
        (forces, moved)
    };
    for degree in [1, 3] {
        let (forces, moved) = solve(0.0, degree);
        // Pressed from the sides, free at the back: E = 1, ν = 0.3.
        assert!((forces[1][0] + forces[0][0]).abs() < 1e-12 && forces[0][0] > 0.0);
        let (again, turned) = solve(0.5, degree);
        for (a, b) in forces.iter().zip(&again).chain(moved.iter().zip(&turned)) {
            assert!((a - b).norm() < 1e-11, "degree {degree}: {a} {b}");
        }
    }
}

#[test]
fn what_two_supports_say_of_the_same_direction_is_to_be_the_same() {
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [2, 2], 1, |x| Point::<2>::new(x[0] - x[1], x[0] + x[1]));
    let mut system = System::default();
    system.bodies.push(Box::new(solid("block", mesh, 1, ELASTIC, StressLaw::LinearElastic)));
    let along = |value: f64| -> Option<(Vector<3>, TimeField)> {
        Some((v(1.0, 1.0, 0.0) / 2f64.sqrt(), Arc::new(move |_, t| value * t)))
    };
    for (name, value) in [("one", 0.1), ("other", 0.2)] {
        system.supports.push(Support { name: name.into(), along: along(value), ..hold(0, "right", [None; 3]) });
    }
    system.prepare().unwrap();
    let start = system.start();
    let error = system.solve(&start, 1.0, &mut |_, _| true).unwrap_err();
    assert!(error.to_string().contains("`one` and `other` contradict each other"), "{error}");
    // What others hold in all directions is held along any.
    system.supports.truncate(1);
    system.supports.push(hold(0, "right", [Some(0.3), Some(0.0), None]));
    let error = system.solve(&start, 1.0, &mut |_, _| true).unwrap_err();
    assert!(matches!(error, IncrementError::Assembly(_)), "{error}");
    let consistent = 0.1 * 2f64.sqrt();
    system.supports[1] = hold(0, "right", [Some(consistent), Some(0.0), None]);
    let (_, result) = system.solve(&start, 1.0, &mut |_, _| true).unwrap();
    assert_eq!(result.support_forces[0][0], v(0.0, 0.0, 0.0));
}

/// A plate on a block, which stays level: the block is pressed out of the middle.
#[test]
fn a_uniform_support_has_one_displacement_and_no_resultant() {
    for degree in [1, 2] {
        let mesh = cuboid([0.0; 3], [1.0, 1.0, 0.5], [4, 3, 2], |x| x);
        let mut system = System::default();
        system.bodies.push(Box::new(solid("block", mesh, degree, ELASTIC, StressLaw::LinearElastic)));
        system.supports.push(hold(0, "bottom", [Some(0.0); 3]));
        system.supports.push(Support { uniform: [false, false, true], ..hold(0, "top", [None; 3]) });
        system.loads.push(load(0, "top", TimedLoad::Traction(Arc::new(|x, t| v(0.0, 0.0, -0.02 * t * x[0])))));
        let (state, results) = run(&mut system, &[1.0]);
        let fields = system.bodies[0].fields(&state.bodies[0]);
        let top = fields.points.iter().zip(&fields.displacement).filter(|(x, _)| x[2] == 0.5);
        let heights: Vec<f64> = top.map(|(_, u)| u[2]).collect();
        assert!(heights[0] < -1e-3 && heights.iter().all(|h| (h - heights[0]).abs() < 1e-13), "{heights:?}");
        let [bottom, plate] = [0, 1].map(|k| results[0].support_forces[k][0]);
        assert!((bottom - v(0.0, 0.0, 0.01)).norm() < 1e-12 && plate.norm() == 0.0, "{bottom} {plate}");
    }
}
