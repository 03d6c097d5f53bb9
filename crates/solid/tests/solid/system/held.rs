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
