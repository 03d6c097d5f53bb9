//! Pairs that are equally close along a curve or over a surface.

use signorini_geometry::closest::{Certificate, Query, Uniqueness, closest};
use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::shape::{Axes, Curve, Shape, Surface};
use signorini_geometry::{Point, Vector};
use std::f64::consts::{FRAC_PI_2, TAU};

const TURN: [f64; 2] = [0.0, TAU];

fn point(x: [f64; 3]) -> Shape {
    Shape::Point(Point::<3>::from(x))
}

fn segment(p: [f64; 3], q: [f64; 3]) -> Shape {
    Curve::segment(Point::<3>::from(p), Point::<3>::from(q)).unwrap().into()
}

fn axes(origin: [f64; 3]) -> Axes {
    Axes::standard(Point::<3>::from(origin))
}

/// Axes whose third lies along x.
fn lying(origin: [f64; 3]) -> Axes {
    Axes::new(Point::<3>::from(origin), Point::<3>::y(), Point::<3>::z()).unwrap()
}

fn circle(origin: [f64; 3], radius: f64) -> Shape {
    Curve::circle(axes(origin), radius, TURN, true).unwrap().into()
}

fn ellipse(origin: [f64; 3]) -> Shape {
    Curve::ellipse(axes(origin), 1.0, 0.6, TURN, true).unwrap().into()
}

fn helix(radius: f64) -> Shape {
    Curve::helix(axes([0.0; 3]), radius, 0.1, [0.0, 12.0]).unwrap().into()
}

fn plane(origin: [f64; 3]) -> Shape {
    Surface::plane(axes(origin), [[-1.0, 1.0], [-1.0, 1.0]]).unwrap().into()
}

fn cylinder(axes: Axes, radius: f64) -> Shape {
    Surface::cylinder(axes, radius, [TURN, [-1.0, 1.0]], true).unwrap().into()
}

fn cone(origin: [f64; 3], sin: f64, cos: f64) -> Shape {
    Surface::cone(axes(origin), sin, cos, [TURN, [0.2, 1.5]], true).unwrap().into()
}

/// A cone from its tip.
fn tip() -> Shape {
    Surface::cone(axes([0.0; 3]), 0.6, 0.8, [TURN, [0.0, 1.5]], true).unwrap().into()
}

fn spheroid() -> Shape {
    Surface::ellipsoid(axes([0.0; 3]), [1.0, 1.0, 1.4], [TURN, [-FRAC_PI_2, FRAC_PI_2]], true).unwrap().into()
}

fn sphere(origin: [f64; 3], radius: f64) -> Shape {
    Surface::sphere(axes(origin), radius, [TURN, [-FRAC_PI_2, FRAC_PI_2]], true).unwrap().into()
}

fn torus(origin: [f64; 3], major: f64, minor: f64) -> Shape {
    Surface::torus(axes(origin), major, minor, [TURN, TURN], [true, true]).unwrap().into()
}

/// A name, both shapes, their distance and the dimension of the continuum; zero where there is one pair or several.
type Case = (&'static str, Shape, Shape, f64, usize);

fn symmetric() -> Vec<Case> {
    let o = [0.0; 3];
    let (upright, wall) = (|| cylinder(axes(o), 0.5), || cone(o, 0.6, 0.8));
    let ring = || torus(o, 1.0, 0.2);
    vec![
        ("point on the axis of a circle", point([0.0, 0.0, 4.0]), circle(o, 3.0), 5.0, 1),
        ("point on the axis of a cylinder", point([0.0, 0.0, 0.3]), upright(), 0.5, 1),
        ("point on the axis of a cone", point([0.0, 0.0, 1.0]), wall(), 0.6, 1),
        ("centre of a sphere", point(o), sphere(o, 2.0), 2.0, 2),
        ("point on the axis of a torus", point([0.0, 0.0, 0.3]), ring(), 1.09f64.sqrt() - 0.2, 1),
        ("point on the ring of a torus", point([1.0, 0.0, 0.0]), ring(), 0.2, 1),
        ("parallel segments", segment(o, [1.0, 0.0, 0.0]), segment([0.5, 1.0, 0.0], [2.0, 1.0, 0.0]), 1.0, 1),
        ("concentric circles", circle(o, 1.0), circle(o, 2.0), 1.0, 1),
        ("coaxial circles", circle(o, 1.0), circle([0.0, 0.0, 0.75], 2.0), 1.25, 1),
        ("segment above a circle", segment([0.0, 0.0, 1.0], [0.0, 0.0, 2.0]), circle(o, 1.0), 2f64.sqrt(), 1),
        ("segment over a plane", segment([-0.5, 0.2, 1.0], [0.7, -0.3, 1.0]), plane(o), 1.0, 1),
        ("segment over the side of a plane", segment([-0.5, 2.0, 1.0], [0.7, 2.0, 1.0]), plane(o), 2f64.sqrt(), 1),
        ("segment beside a cylinder", segment([2.0, 0.0, -0.5], [2.0, 0.0, 3.0]), upright(), 1.5, 1),
        ("axis of a cylinder", segment([0.0, 0.0, -0.5], [0.0, 0.0, 0.7]), upright(), 0.5, 2),
        ("circle over a plane", circle([0.0, 0.0, 1.0], 0.5), plane(o), 1.0, 1),
        ("circle in a sphere", circle(o, 0.5), sphere(o, 2.0), 1.5, 1),
        ("circle off the centre of a sphere", circle([0.0, 0.0, 0.4], 0.3), sphere(o, 2.0), 1.5, 1),
        ("circle around a cylinder", circle(o, 2.0), upright(), 1.5, 1),
        ("circle in a cone", circle([0.0, 0.0, 0.8], 0.1), wall(), 0.4, 1),
        ("circle around a torus", circle(o, 3.0), ring(), 1.8, 1),
        ("ring of a torus", circle(o, 1.0), ring(), 0.2, 2),
        ("parallel planes", plane(o), plane([0.5, 0.3, 1.0]), 1.0, 2),
        ("cylinder over a plane", cylinder(lying([0.0, 0.0, 2.0]), 0.5), plane(o), 1.5, 1),
        ("cylinder on end over a plane", upright(), plane([0.0, 0.0, 2.0]), 1.0, 1),
        ("parallel cylinders", upright(), cylinder(axes([2.0, 0.0, 0.5]), 0.5), 1.0, 1),
        ("coaxial cylinders", upright(), cylinder(axes(o), 0.8), 0.3, 2),
        ("coaxial cones", wall(), cone([0.0, 0.0, 0.5], 0.6, 0.8), 0.3, 2),
        ("coaxial cones of two angles", wall(), cone([0.0, 0.0, -2.0], 0.28, 0.96), 0.78, 1),
        ("concentric spheres", sphere(o, 1.0), sphere(o, 2.0), 1.0, 2),
        ("sphere in a cylinder", sphere(o, 0.3), upright(), 0.2, 1),
        ("sphere in a torus", sphere(o, 0.3), ring(), 0.5, 1),
        ("sphere in an ellipsoid", sphere(o, 0.3), spheroid(), 0.7, 1),
        ("torus on a plane", torus([0.0, 0.0, 1.0], 0.5, 0.2), plane(o), 0.8, 1),
        ("torus around a cylinder", ring(), upright(), 0.3, 1),
        ("coaxial tori", ring(), torus([0.0, 0.0, 1.0], 1.0, 0.3), 0.5, 1),
        ("tori in each other", ring(), torus(o, 1.0, 0.3), 0.1, 2),
        // No continuum, as near as it may seem.
        ("cylinders end to end", upright(), cylinder(axes([2.0, 0.0, 3.0]), 0.5), 2f64.sqrt(), 0),
        ("segment past the end of a cylinder", segment([2.0, 0.0, 2.0], [2.0, 0.0, 3.0]), upright(), 3.25f64.sqrt(), 0),
        ("circle larger than a plane", circle([0.0, 0.0, 1.0], 2.0), plane(o), (2.0 - 2f64.sqrt()).hypot(1.0), 0),
        ("sphere below the tip of a cone", sphere([0.0, 0.0, -2.0], 0.5), tip(), 1.5, 0),
        ("sphere off the middle of a cylinder", sphere([0.1, 0.0, 0.0], 0.3), upright(), 0.1, 0),
        ("segment tilted over a plane", segment([-0.5, 0.0, 1.0], [0.5, 0.0, 1.001]), plane(o), 1.0, 0),
    ]
}

#[test]
fn continua_are_found_and_certified() {
    let turn = Vector::<3>::new(0.3, -0.8, 0.5);
    let motion = RigidMotion::new(turn, Point::<3>::new(0.2, 0.1, 0.0), Vector::<3>::new(1.0, 2.0, -0.5));
    for (name, a, b, distance, dimension) in symmetric() {
        let moved = [&a, &b].map(|s| motion.shape(s).unwrap());
        for (a, b) in [(&a, &b), (&b, &a), (&moved[0], &moved[1])] {
            let found = closest(a, b, &Query::default());
            assert!((found.distance() - distance).abs() <= 1e-12, "{name}: {found:?}");
            assert_eq!(found.certificate, Certificate::Complete, "{name}: {found:?}");
            assert!(found.certified_to <= 1e-12, "{name}: {found:?}");
            let of_continuum = if let Uniqueness::Continuum { dimension } = found.uniqueness { dimension } else { 0 };
            assert_eq!(of_continuum, dimension, "{name}: {found:?}");
            for pair in std::iter::once(&found.closest).chain(&found.others) {
                for (foot, shape) in [(&pair.a, a), (&pair.b, b)] {
                    let at = |k: usize| foot.parameters().get(k).copied().unwrap_or(0.0);
                    let place = shape.position(foot.element, [at(0), at(1)]).unwrap();
                    assert!((place - foot.point).norm() <= 1e-12, "{name}: {foot:?}");
                }
                assert!(((pair.a.point - pair.b.point).norm() - distance).abs() <= 1e-12, "{name}: {pair:?}");
            }
        }
    }
}

/// Where no symmetry is told, the search may end before its proof, and says so.
#[test]
fn other_continua_are_right_and_honest() {
    let o = [0.0; 3];
    for (name, a, b, distance) in [
        ("shifted ellipses", ellipse(o), ellipse([0.0, 0.0, 0.5]), 0.5),
        ("axis and helix", segment(o, [0.0, 0.0, 1.2]), helix(1.0), 1.0),
        ("coaxial helices", helix(0.5), helix(1.0), 0.5),
        ("segment along a cone", segment([1.4, 0.0, 0.2], [2.0, 0.0, 1.0]), cone(o, 0.6, 0.8), 1.0),
        ("helix in a cylinder", helix(0.3), cylinder(axes(o), 0.5), 0.2),
    ] {
        let found = closest(&a, &b, &Query::default());
        assert!((found.distance() - distance).abs() <= 1e-12, "{name}: {found:?}");
        assert_eq!(found.uniqueness, Uniqueness::Continuum { dimension: 1 }, "{name}: {found:?}");
        assert!(found.certificate == Certificate::Stopped || found.certified_to <= 1e-9, "{name}: {found:?}");
    }
}
