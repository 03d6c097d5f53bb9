//! Of `output::render`.

use plotters::style::RGBColor;
use signorini::testing::{Body, Camera, Look, Paint, render};
use signorini_geometry::Vector;

/// A square of side 2 at a height, with a colour.
fn square(z: f64, side: f64, paint: Paint) -> Body {
    let at = |x: f64, y: f64| Vector::<3>::new(side * x, side * y, z);
    Body::of_polygons(
        vec![at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)],
        [&[0u32, 1, 2, 3][..]].into_iter(),
        paint,
    )
}

#[test]
fn what_is_in_front_hides_whatever_the_order_of_the_bodies() {
    let (red, blue) = (RGBColor(255, 0, 0), RGBColor(0, 0, 255));
    let near = square(1.0, 0.5, Paint::Plain(red));
    let far = square(0.0, 1.0, Paint::Plain(blue));
    let camera = Camera::new(&Vector::<3>::z(), &Vector::<3>::y(), far.seen(), [0.0, 0.0, 40.0, 40.0]);
    for bodies in [[near.clone(), far.clone()], [far, near]] {
        let image = render(&bodies, &camera, Look::Map).unwrap();
        let middle = image.get(image.width() / 2, image.height() / 2);
        let corner = image.get(image.width() / 8, image.height() / 8);
        assert_eq!((middle, corner), (red, blue));
    }
}

/// A slit between two parts of a body is closed where it is narrower than a pixel.
#[test]
fn parts_that_nearly_meet_show_no_slit() {
    for (half, is_seen) in [(0.009, false), (0.05, true)] {
        let mut body = square(0.0, 1.0, Paint::Plain(RGBColor(200, 0, 0)));
        let other = Body::of_polygons(
            [[half, -1.0], [1.0, -1.0], [1.0, 1.0], [half, 1.0]].map(|[x, y]| Vector::<3>::new(x, y, 0.0)).to_vec(),
            [&[0u32, 1, 2, 3][..]].into_iter(),
            Paint::Plain(RGBColor(200, 0, 0)),
        );
        body.points.iter_mut().for_each(|x| x.x = if x.x > 0.5 { -half } else { x.x.min(-half) });
        let first = body.points.len() as u32;
        body.points.extend(other.points);
        body.triangles.extend(other.triangles.iter().map(|t| t.map(|k| k + first)));
        body.normals.extend(other.normals);
        let camera = Camera::new(&Vector::<3>::z(), &Vector::<3>::y(), body.seen(), [0.0, 0.0, 40.0, 40.0]);
        let image = render(&[body], &camera, Look::Solid).unwrap();
        let row = image.height() / 3;
        let line: Vec<_> = (image.width() / 4..3 * image.width() / 4).map(|x| image.get(x, row)).collect();
        assert_eq!(line.iter().any(|c| *c != line[0]), is_seen, "{half}");
    }
}

#[test]
fn a_clipped_body_keeps_its_field_and_half_of_its_area() {
    let body = square(0.0, 1.0, Paint::Field(vec![0.0, 1.0, 1.0, 0.0]));
    let half = body.clipped(|_, value| value - 0.5);
    let x = |k: u32| half.points[k as usize];
    let area: f64 = half.triangles.iter().map(|t| 0.5 * (x(t[1]) - x(t[0])).cross(&(x(t[2]) - x(t[0]))).norm()).sum();
    assert!((area - 2.0).abs() < 1e-12, "{area}");
    let Paint::Field(values) = &half.paint else { panic!("a field") };
    assert!(half.triangles.iter().flatten().all(|&k| (values[k as usize] - 0.5 * (1.0 + x(k).x)).abs() < 1e-12));
}
