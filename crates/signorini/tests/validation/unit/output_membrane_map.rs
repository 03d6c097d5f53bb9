//! Of `output::membrane_map`.

use signorini::output::chart::{Image, viridis};
use signorini::snapshot::{DisplayMesh, Snapshot};
use signorini::testing::{FREE, Field, Scale, fill};
use signorini_geometry::Point;

#[test]
fn colours_tell_values_and_pressure_ends_at_the_front() {
    // A square of side 2 in 20 by 20 cells, in contact within a radius of 0.5.
    let n = 21u32;
    let at = |k: u32| -1.0 + 0.1 * f64::from(k);
    let points: Vec<Point<2>> = (0..n * n).map(|k| Point::<2>::new(at(k % n), at(k / n))).collect();
    let cells = (0..20u32 * 20).map(|k| {
        let a = k / 20 * n + k % 20;
        vec![a, a + 1, a + n + 1, a + n]
    });
    let mesh = DisplayMesh { points: points.clone(), cells: cells.collect() };
    let touches: Vec<bool> = points.iter().map(|p| p.norm() < 0.5).collect();
    let round = |k: usize| std::f64::consts::TAU * k as f64 / 200.0;
    let outline: Vec<Point<2>> =
        (0..200).map(|k| Point::<2>::new(0.5 * round(k).cos(), 0.5 * round(k).sin())).collect();
    let s = Snapshot {
        time: 1.0,
        displacement: points.iter().map(|p| p.x).collect(),
        gap: vec![0.0; points.len()],
        pressure: touches.iter().map(|t| if *t { 2.0 } else { 0.0 }).collect(),
        in_contact: touches,
        floor: None,
        ceiling: None,
        within: vec![vec![true; 200]],
        outlines: vec![outline],
    };
    let mut image = Image::new(200, 200).unwrap();
    let place = |p: &Point<2>| Point::<2>::new(100.0 * (p.x + 1.0), 100.0 * (1.0 - p.y));
    let field = |values, scale, of_contact| Field { values, title: "", name: String::new(), scale, of_contact };
    fill(&mut image, &mesh, &s, &field(&s.displacement, Scale::between(-1.0, 1.0, 1.0), false), place);
    assert_eq!(image.get(150, 60), viridis(0.5 * (1.0 + 0.505)));
    fill(&mut image, &mesh, &s, &field(&s.pressure, Scale::between(0.0, 4.0, 4.0), true), place);
    // Half a pixel on either side of the front, between points of the mesh.
    assert_eq!([image.get(148, 100), image.get(151, 100)], [viridis(0.5), FREE]);
    let diagonal = (100.0 + 50.0 * std::f64::consts::FRAC_1_SQRT_2) as usize;
    assert_eq!([image.get(diagonal - 2, diagonal - 2), image.get(diagonal + 2, diagonal + 2)], [viridis(0.5), FREE]);
}
