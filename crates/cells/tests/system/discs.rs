//! Contact by discs: balance, tangent, and the pore that closes on itself.

use super::*;
use signorini_cells::disc_contact::{Cover, CoverFindings, DiscPairs};
use signorini_cells::discs::Centres;
use signorini_cells::shapes::ball;

const COVER: Cover = Cover { radius: None, spacing: None, centres: Centres::Within };

/// Two balls of cells, or two discs, pressed on each other.
fn pressed<const D: usize>(space: Space) -> (System, SystemState, IncrementResult, Vec<CoverFindings>) {
    let last = D - 1;
    let up = |z: f64| Point::<D>::from_fn(|k, _| if k == last { z } else { 0.0 });
    let half = |low: f64| {
        let corner = |side: f64| [side; D].map(|s| s).map(f64::from);
        let (mut a, mut b) = (corner(0.0), corner(1.0));
        (a[last], b[last]) = (low, low + 1.0);
        aabb(a, b)
    };
    let body = |name: &str, centre: f64, low: f64, facing: f64| {
        let mut places: Vec<(&str, Place<D>)> = vec![("x", Place::low(0))];
        if D == 3 {
            places.push(("y", Place::low(1)));
        }
        places.push(("flat", if facing > 0.0 { Place::low(last) } else { Place::high(last) }));
        places.push(("skin", Place::boundary(move |p| facing * p.normal[last] > 0.8)));
        solid(name, Domain::shape(ball(up(centre), 1.0)), (half(low), [4; D]), 2, space, places)
    };
    let lower = body("lower", -1.0, -1.0, 1.0);
    let upper = body("upper", 1.0, 0.0, -1.0);
    let sides = [(part(0, "skin"), &lower as &dyn Body), (part(1, "skin"), &upper as &dyn Body)];
    let [first, second] = sides;
    let (contact, findings) = DiscPairs::new("touch", first, Some(second), &COVER, None).unwrap();
    let along = |z: f64| if D == 3 { [None, None, constant(z)] } else { [None, constant(z), None] };
    let mut supports = vec![
        support(0, "x", [constant(0.0), None, None]),
        support(1, "x", [constant(0.0), None, None]),
        support(0, "flat", along(0.0)),
        support(1, "flat", along(-0.1)),
    ];
    if D == 3 {
        supports.extend([0, 1].map(|k| support(k, "y", [None, constant(0.0), None])));
    }
    let bodies: Vec<Box<dyn Body>> = vec![Box::new(lower), Box::new(upper)];
    let mut system = System { supports, bodies, contacts: vec![Box::new(contact)], ..System::default() };
    let (state, found) = solve(&mut system);
    (system, state, found, findings)
}

fn check<const D: usize>(space: Space) {
    let (system, state, found, findings) = pressed::<D>(space);
    println!("{findings:?}, {} iterations", found.iterations);
    assert!(findings.iter().all(|f| !f.is_too_small() && !f.is_too_large()));
    let force: Vector<3> = found.sites[0].iter().map(SiteResult::force).sum();
    let last = D - 1;
    let of_support = |k: usize| found.support_forces[k][0][last];
    println!("{force} {} {}", of_support(2), of_support(3));
    assert!(force[last] < -1e-3);
    assert!((force[last] + of_support(2)).abs() < 1e-9 * force[last].abs(), "what is below carries it");
    assert!((of_support(2) + of_support(3)).abs() < 1e-9 * force[last].abs(), "momentum");
    let error = tangent_error(&system, &state, 1e-7, 12);
    println!("tangent {error:e}");
    assert!(error < 1e-6, "{error:e}");
}

#[test]
fn two_bodies_touch_by_discs_in_the_plane_and_in_space() {
    check::<2>(Space::PlaneStrain);
    check::<3>(Space::Solid);
}

#[test]
fn a_radius_that_cannot_serve_is_told() {
    let body = solid(
        "disc",
        Domain::shape(ball(Point::<2>::zeros(), 1.0)),
        (aabb([-1.0, -1.0], [1.0, 1.0]), [4; 2]),
        2,
        Space::PlaneStrain,
        Vec::new(),
    );
    let of = |radius: f64, spacing: f64| {
        let cover = Cover { radius: Some(radius), spacing: Some(spacing), ..COVER };
        DiscPairs::new("touch", (part(0, "boundary"), &body), None, &cover, None).unwrap().1[0]
    };
    let found = of(0.2, 0.2);
    println!("{found:?}");
    assert!((found.thickness - 2.0).abs() < 0.11 && !found.is_too_small() && !found.is_too_large());
    assert!(of(0.05, 0.2).is_too_small());
    assert!(of(1.1, 0.2).is_too_large());
}
