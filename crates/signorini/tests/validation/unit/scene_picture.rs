//! Of `scene::picture`.

use signorini::testing::{HEAD, Look, SIZE, Scene, bodies, camera, render, seen};
use signorini_geometry::Vector;

const CASE: &str = "title = \"two triangles\"\nanalysis = \"closest_pairs\"\nframes = 2\n\
    camera = { from = [0, 0, 1], up = [0, 1, 0] }\n\
    [bodies.near]\nparts = [{ name = \"face\", type = \"tri3\", nodes = [[0, 0, 1], [2, 0, 1], [0, 2, 1]] }]\n\
    [bodies.far]\nparts = [{ name = \"face\", type = \"tri3\", nodes = [[0, 0, 0], [4, 0, 0], [0, 4, 0]] }]\n";

#[test]
fn the_nearer_body_hides_the_farther_one_and_the_frame_is_filled() {
    let scene = Scene::parse("test", CASE, std::path::Path::new(".")).unwrap();
    let frame = scene.at(0.0).unwrap();
    let camera = camera(&scene, &seen(&frame));
    let [left, top, right, bottom] = camera.area;
    // Of a triangle as wide as high the height is filled, less two units for outlines.
    assert!((bottom - top - (SIZE.1 - 16.0 - HEAD) - 2.0).abs() < 1e-9, "{:?}", camera.area);
    let image = render(&bodies(&frame, &camera), &camera, Look::Solid).unwrap();
    let at = |x: f64, y: f64| {
        let (px, py) = camera.at(&Vector::<3>::new(x, y, 0.0));
        let share = ((px - left) / (right - left), (py - top) / (bottom - top));
        image.get((share.0 * image.width() as f64) as usize, (share.1 * image.height() as f64) as usize)
    };
    // The far body is the first, more blue than red, the near one more red than blue.
    let (near, far) = (at(0.5, 0.5), at(1.5, 1.5));
    assert!(near.0 > near.2 && far.2 > far.0, "{near:?} {far:?}");
}
