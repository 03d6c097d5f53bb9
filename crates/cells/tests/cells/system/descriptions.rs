//! Bodies from plain data: every kind of geometry, in the plane, around an axis and in space.

use super::*;
use signorini_cells::description::{Cells, Description, Geometry, Part as PlacePart, Refinement, Shape, build};
use signorini_cells::image::ImageData;
use signorini_cells::{End, Islands};
use signorini_geometry::Jet;
use signorini_geometry::mesh::TriangleMesh;
use signorini_geometry::rigid_shape::Sphere;
use std::f64::consts::PI;

fn ellipsoid(radius: f64) -> Shape {
    Shape::Ellipsoid { center: [0.0; 3], semi_axes: [radius; 3] }
}

/// `|x|² - r²`, as an expression is.
fn expression(radius: f64) -> Shape {
    Shape::Function(Arc::new(move |x| {
        let value = x.norm_squared() - radius * radius;
        Jet { value, gradient: x * 2.0, hessian: signorini_geometry::Matrix::<3>::identity() * 2.0 }
    }))
}

fn described(geometry: Geometry, space: Space, cells: usize) -> Description {
    let low = if space == Space::Axisymmetric { 0.0 } else { -1.0 };
    Description {
        bounds: Some([[low, -1.0, -1.0], [1.0, 1.0, 1.0]]),
        ..Description::new("body", geometry, space, Cells::Count([cells; 3]), 2, ELASTIC)
    }
}

#[test]
fn every_shape_has_its_volume_in_every_space() {
    let rigid = || Shape::Rigid(Arc::new(Sphere { center: Point::<3>::zeros(), radius: 0.8 }));
    let offset = |of: Shape, distance: f64| Shape::Offset { of: Box::new(of), distance };
    let cuboid = Shape::Cuboid { min: [-0.5, -0.4, -0.3], max: [0.6, 0.7, 0.2] };
    for (shape, plane, solid) in [
        (ellipsoid(0.8), PI * 0.64, 4.0 / 3.0 * PI * 0.512),
        (expression(0.8), PI * 0.64, 4.0 / 3.0 * PI * 0.512),
        (rigid(), PI * 0.64, 4.0 / 3.0 * PI * 0.512),
        (offset(expression(0.7), 0.1), PI * 0.64, 4.0 / 3.0 * PI * 0.512),
        (offset(rigid(), 0.1), PI * 0.81, 4.0 / 3.0 * PI * 0.729),
        (cuboid.clone(), 1.21, 1.21 * 0.5),
        (offset(cuboid.clone(), 0.1), 1.21 + 0.44 + PI * 0.01, f64::INFINITY),
        (Shape::Difference(vec![ellipsoid(0.8), ellipsoid(0.3)]), PI * 0.55, 4.0 / 3.0 * PI * (0.512 - 0.027)),
        (Shape::Union(vec![ellipsoid(0.8), rigid()]), PI * 0.64, 4.0 / 3.0 * PI * 0.512),
        (Shape::Intersection(vec![ellipsoid(0.8), cuboid]), f64::NAN, f64::NAN),
    ] {
        let of = |space, cells| build(&described(Geometry::Shape(shape.clone()), space, cells)).unwrap();
        let around = of(Space::Axisymmetric, 4);
        let flat = of(Space::PlaneStress, 4);
        if plane.is_nan() {
            assert!(flat.volume < 1.21);
            continue;
        }
        assert!((flat.volume / plane - 1.0).abs() < 1e-5, "{} {plane}", flat.volume);
        if solid.is_finite() && plane != 1.21 {
            assert!((around.volume / solid - 1.0).abs() < 1e-4, "{} {solid}", around.volume);
        }
    }
    // Inwards of a box without a ball: a smaller box without a larger ball, with their edges.
    let bored =
        Shape::Difference(vec![Shape::Cuboid { min: [-0.9, -0.8, -0.7], max: [0.9, 0.8, 0.7] }, ellipsoid(0.2)]);
    for (shape, volume) in [
        (expression(0.8), 4.0 / 3.0 * PI * 0.512),
        (offset(expression(0.9), -0.1), 4.0 / 3.0 * PI * 0.512),
        (offset(bored, -0.1), 1.6 * 1.4 * 1.2 - 4.0 / 3.0 * PI * 0.027),
        (offset(Shape::Union(vec![ellipsoid(0.4), ellipsoid(0.7)]), 0.1), 4.0 / 3.0 * PI * 0.512),
    ] {
        let body = build(&described(Geometry::Shape(shape), Space::Solid, 3)).unwrap();
        assert!((body.volume / volume - 1.0).abs() < 1e-4, "{} {volume}", body.volume);
        assert!(!body.body.sites(None, Sampling::GaussPoints).unwrap().is_empty());
    }
}

#[test]
fn triangles_images_and_moduli() {
    // A tetrahedron with its box of its own.
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Point::<3>::from).to_vec();
    let mesh = TriangleMesh::new(corners, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]).unwrap();
    let mut d = described(Geometry::Triangles(Arc::new(mesh)), Space::Solid, 2);
    d.bounds = None;
    d.degree = 1;
    let body = build(&d).unwrap();
    assert!((body.volume - 1.0 / 6.0).abs() < 1e-12 && body.bounds == [[0.0; 3], [1.0; 3]], "{}", body.volume);
    d.space = Space::PlaneStrain;
    assert!(build(&d).err().unwrap().to_string().contains("in the plane"));

    // A grey disc, and a speck beside it that is dropped.
    let n = 24;
    let value = |i: usize| {
        let [x, y] = [i % n, i / n].map(|k| k as f64 + 0.5 - 0.5 * n as f64);
        let disc = 8.0 - x.hypot(y);
        let speck = 1.5 - (x - 10.0).hypot(y - 10.0);
        disc.max(speck).clamp(-0.5, 0.5)
    };
    let image = ImageData {
        count: vec![n, n],
        spacing: vec![0.1; 2],
        origin: vec![0.0; 2],
        values: (0..n * n).map(value).collect(),
    };
    let shape = Shape::Image { image: image.clone(), threshold: 0.0, smoothing: 0.0 };
    let mut d = described(Geometry::Shape(shape), Space::PlaneStrain, 8);
    d.bounds = None;
    assert!(build(&d).err().unwrap().to_string().contains("islands"));
    d.islands = Islands::Drop;
    let body = build(&d).unwrap();
    assert!(body.findings.dropped > 0.02 && (body.volume / (PI * 0.64) - 1.0).abs() < 0.02, "{:?}", body.findings);

    // Voxels of two moduli in a column: what is soft strains more.
    let image = ImageData { count: vec![1, 2], spacing: vec![1.0; 2], origin: vec![0.0; 2], values: vec![1.0, 4.0] };
    let mut d = described(Geometry::Moduli(image), Space::PlaneStress, 2);
    d.material = Elastic { youngs_modulus: 10.0, poissons_ratio: 0.0 }.into();
    d.bounds = None;
    d.cells = Cells::Size(1.0);
    for (name, end) in [("bottom", End::Low), ("top", End::High)] {
        d.places.insert(name.into(), PlacePart::Side { axis: 1, end });
    }
    d.places.insert("left".into(), PlacePart::Side { axis: 0, end: End::Low });
    let built = build(&d).unwrap();
    assert!((built.volume - 2.0).abs() < 1e-12 && built.cells == 2);
    let mut system = System {
        supports: vec![
            support(0, "bottom", [None, constant(0.0), None]),
            support(0, "left", [constant(0.0), None, None]),
        ],
        loads: vec![PlacedLoad {
            name: "push".into(),
            part: part(0, "top"),
            load: TimedLoad::Force(Arc::new(|_, t| v(0.0, -1.0, 0.0) * t)),
        }],
        bodies: vec![built.body],
        ..System::default()
    };
    let (state, _) = solve(&mut system);
    let site = system.bodies[0].sites(Some("top"), Sampling::GaussPoints).unwrap()[0];
    let y = system.bodies[0].placed(&state.bodies[0], &site).x[1];
    assert!((y - (2.0 - 0.1 - 0.025)).abs() < 1e-9, "{y}");
}

#[test]
fn refinement_halves_what_it_names() {
    let mut d = described(Geometry::Shape(ellipsoid(0.8)), Space::PlaneStrain, 4);
    let plain = build(&d).unwrap();
    d.refinement = vec![Refinement::Boundary { levels: 1 }];
    let boundary = build(&d).unwrap();
    d.refinement = vec![Refinement::Near {
        distance: Arc::new(|x: &Point<3>| (x - v(0.0, -0.8, 0.0)).norm()),
        within: 0.05,
        levels: 3,
    }];
    let near = build(&d).unwrap();
    println!("{} {} {}", plain.cells, boundary.cells, near.cells);
    assert!(plain.cells == 16 && boundary.cells > 30 && near.cells > 25 && near.cells < 60);
    // A part of the surface of a body that its box cuts off: boundary and side alike.
    d.bounds = Some([[-1.0, -0.5, 0.0], [1.0, 1.0, 0.0]]);
    d.places.insert("low".into(), PlacePart::Surface(Arc::new(|_, n| n[1] < -0.7)));
    d.places.insert("all".into(), PlacePart::Surface(Arc::new(|_, _| true)));
    let cut = build(&d).unwrap();
    let length = |place| -> f64 {
        let sites = cut.body.sites(Some(place), Sampling::GaussPoints).unwrap();
        sites.iter().map(|s| s.weight).sum()
    };
    let side = 2.0 * (0.64f64 - 0.25).sqrt();
    let arc = 0.8 * (PI + 2.0 * 0.625f64.asin());
    assert!((length("low") - side).abs() < 1e-9, "{} {side}", length("low"));
    assert!((length("all") - side - arc).abs() < 1e-5, "{} {}", length("all"), side + arc);
}
