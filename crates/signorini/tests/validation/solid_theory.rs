//! Elastic solids against theory: Hertz (1882) in the plane and around an axis, and contact that conforms.

use super::solids::at;
use super::{last_step, set, summary};

/// An elastic ball on an elastic block, bodies of revolution: Hertz (1882) has p0 = 1492.2719 for a force of 500.
#[test]
fn hertz_between_elastic_bodies() {
    let pressure = |degree: usize, n: usize| {
        // Everything is refined, also where cells grow.
        let growth = 1.2f64.powf(12.0 / n as f64);
        let reach = |m: i32| 0.6 / n as f64 * growth * (growth.powi(m) - 1.0) / (growth - 1.0);
        let growing = (1..).find(|&m| reach(m) >= 16.0).unwrap();
        let case = format!(
            "space = \"axisymmetric\"\n[constants]\nR = 10\n\
             [bodies.block.solid]\nmesh.box = {{ axes = [\
             {{ from = 0, to = [0.6, 16], cells = [{n}, {growing}], growth = [1, {growth}] }}, \
             {{ from = -16, to = [-0.3, 0], cells = [{growing}, {half}], growth = [{shrink}, 1] }} ] }}\n\
             degree = {degree}\nmaterial.linear_elastic = {{ youngs_modulus = 70000, poissons_ratio = 0.33 }}\n\
             [bodies.ball.solid]\nmesh.box = {{ axes = [\
             {{ from = 0, to = [0.6, 8], cells = [{n}, {growing}], growth = [1, {growth}] }}, \
             {{ from = 0, to = [0.3, 10], cells = [{half}, {growing}], growth = [1, {growth}] }} ], \
             map = [\"x\", \"R - sqrt(R^2 - x^2) + y/10*sqrt(R^2 - x^2)\"] }}\n\
             degree = {degree}\nmaterial.linear_elastic = {{ youngs_modulus = 210000, poissons_ratio = 0.3 }}\n\
             [supports.base]\non = \"block:bottom\"\nnormal = 0\n\
             [supports.head]\non = \"ball:top\"\ndisplacement = [\"free\", \"free\"]\nuniform = true\n\
             [loads.press]\non = \"ball:top\"\nforce = [0, -500]\n\
             [contacts.touch]\nbetween = [\"ball:bottom\", \"block:top\"]\nsliding = \"small\"\n",
            half = n / 2,
            shrink = 1.0 / growth,
        );
        let found = summary(&case, &set(&[]));
        let step = last_step(&found);
        assert!((at(step, "/contacts/touch/force/1") / 500.0 - 1.0).abs() < 1e-8);
        at(step, "/contacts/touch/max_pressure") / 1492.271904049647 - 1.0
    };
    // The bodies are finite, which changes the pressure by less than a thousandth. Where in a cell the zone ends changes it
    // by some 1e-4 on all of these meshes, so that an order cannot be observed below that.
    let fine = pressure(2, 24);
    let errors = [6, 12, 24].map(|n| (pressure(1, n) - fine).abs());
    let quadratic = pressure(2, 12) - fine;
    println!("{errors:?} beside {fine:e}; degree 2 {quadratic:e}");
    assert!(fine.abs() < 1e-3 && errors[0] < 1e-3, "{errors:?} beside {fine:e}");
    assert!(errors[1].max(errors[2]).max(quadratic.abs()) < 5e-4, "{errors:?}, {quadratic:e}");
}

/// A block with a parabolic end on a rigid plane, against the half plane of Hertz: for R = 8, E = 200, ν = 0.3 and a line
/// load of 35 the half width is 1.27362 and the pressure 17.4948. Both go with the root of the load; with a ten-thousandth
/// of it the theory holds to what is measured here.
#[test]
fn hertz_of_a_cylinder_on_a_plane() {
    let scale = 1e-2;
    let (half_width, pressure) = (1.2736197156108244 * scale, 17.4947763133355 * scale);
    let solve = |degree: usize, n: usize| {
        let (near, far) = (1.5 * half_width, 150.0 * half_width);
        // Everything is refined, also where cells grow.
        let growth = 1.5f64.powf(12.0 / n as f64);
        let reach = |m: i32| near / n as f64 * growth * (growth.powi(m) - 1.0) / (growth - 1.0);
        let growing = (1..).find(|&m| reach(m) >= far - near).unwrap();
        let case = format!(
            "space = \"plane_strain\"\n[bodies.block.solid]\nmesh.box = {{ axes = [\
             {{ from = 0, to = [{near}, {far}], cells = [{n}, {growing}], growth = [1, {growth}] }}, \
             {{ from = 0, to = [{low}, {far}], cells = [{third}, {growing}], growth = [1, {growth}] }} ], \
             map = [\"x\", \"y + x^2/16*(1 - y/{far})\"] }}\ndegree = {degree}\n\
             material.linear_elastic = {{ youngs_modulus = 200, poissons_ratio = 0.3 }}\n\
             [bodies.plane.rigid]\nshape.plane = {{ point = [0, 0], normal = [0, 1] }}\n\
             [supports.symmetry]\non = \"block:left\"\nnormal = 0\n\
             [supports.head]\non = \"block:top\"\ndisplacement = [\"free\", \"free\"]\nuniform = true\n\
             [loads.press]\non = \"block:top\"\nforce = [0, {force}]\n\
             [contacts.touch]\nbetween = [\"block:bottom\", \"plane\"]\n",
            low = near / 3.0,
            third = n / 3,
            force = -17.5 * scale * scale,
        );
        let found = summary(&case, &set(&[]));
        let step = last_step(&found);
        assert!((at(step, "/contacts/touch/force/1") / (17.5 * scale * scale) - 1.0).abs() < 1e-8);
        [at(step, "/contacts/touch/max_pressure") / pressure - 1.0, at(step, "/contacts/touch/area") / half_width - 1.0]
    };
    let errors = [12, 24, 48].map(|n| solve(1, n)[0].abs());
    let orders = [(errors[0] / errors[1]).log2(), (errors[1] / errors[2]).log2()];
    println!("linear {errors:?}, orders {orders:?}; quadratic {:?}", solve(2, 24));
    assert!(orders.iter().all(|o| *o > 1.4), "{errors:?} {orders:?}");
    let [peak, width] = solve(2, 24);
    // The edge is known to a hundredth of the distance of two nodes.
    assert!(peak.abs() < 5e-4 && width.abs() < 5e-4, "{peak:e} {width:e}");
}

/// A pin in a bore of nearly its radius: the zone reaches far round the pin. The reference is of degree 2 on a finer mesh.
#[test]
fn conforming_pin() {
    let area = |degree: usize, cells: usize, pressed: f64| {
        let case = format!(
            "space = \"plane_strain\"\n[bodies.pin.solid]\nmesh.box = {{ axes = [\
             {{ from = 3, to = [10], cells = [{radial}], growth = [0.85] }}, {{ from = -90, to = [90], cells = [{cells}] }} ], \
             map = [\"x*cos(y*pi/180)\", \"x*sin(y*pi/180)\"] }}\ndegree = {degree}\n\
             material.linear_elastic = {{ youngs_modulus = 1000, poissons_ratio = 0.3 }}\n\
             [bodies.bore.rigid]\nshape.sphere = {{ center = [0, 0.01], radius = 10.01 }}\nside = \"inside\"\n\
             [supports.core]\non = \"pin:left\"\ndisplacement = [0, {pressed}]\n\
             [supports.below]\non = \"pin:bottom\"\nnormal = 0\n[supports.above]\non = \"pin:top\"\nnormal = 0\n\
             [contacts.touch]\nbetween = [\"pin:right\", \"bore\"]\n",
            radial = cells / 4,
        );
        at(last_step(&summary(&case, &set(&[]))), "/contacts/touch/area")
    };
    // Half angles of contact of 67 and 85 degrees.
    for (pressed, angle) in [(-0.02, 67.2), (-0.1, 84.7)] {
        let fine = area(2, 192, pressed);
        assert!((fine / 10.0 - f64::to_radians(angle)).abs() < 2e-3, "{fine}");
        let errors = [48, 96, 192].map(|cells| (area(1, cells, pressed) / fine - 1.0).abs());
        let order = 0.5 * (errors[0] / errors[2]).log2();
        let quadratic = area(2, 48, pressed) / fine - 1.0;
        println!("{angle} degrees: {errors:?}, order {order}; degree 2 {quadratic:e}");
        assert!(order > 1.7 && quadratic.abs() < 1.5e-3, "{errors:?}, {quadratic:e}");
    }
}
