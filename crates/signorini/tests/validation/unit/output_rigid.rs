//! Of `output::rigid`.

use signorini::output::rigid::{in_plane, in_space, joined};
use signorini::testing::{CUBES, region, surface};
use signorini_contact::GapJet;
use signorini_geometry::Vector;

#[test]
fn the_edge_of_a_disc_is_a_closed_line_in_its_file() {
    let gap = |x: &Vector<3>| GapJet::ball(x, &Vector::<3>::zeros(), 0.5);
    let corner = Vector::<3>::new(1.0, 1.0, 0.0);
    let (points, cells) = joined(&region(&gap, [-corner, corner]).1, 1e-9);
    assert!(points.len() > 100 && points.iter().all(|x| (x.norm() - 0.5).abs() < 1e-12));
    let mut met = vec![0; points.len()];
    cells.iter().flatten().for_each(|&k| met[k as usize] += 1);
    assert_eq!(met.iter().position(|m| *m != 2), None);
    let text = String::from_utf8(in_plane(&gap, [-corner, corner]).unwrap()).unwrap();
    assert!(text.contains("<Lines>") && text.contains(&format!("NumberOfPoints=\"{}\"", points.len())));
}

/// A file of a body in space, of which there is one in each increment, takes a few bytes for each corner and triangle.
#[test]
fn a_file_of_a_ball_is_small() {
    let gap = |x: &Vector<3>| GapJet::ball(x, &Vector::<3>::zeros(), 0.5);
    let corner = Vector::<3>::repeat(0.75);
    let (points, _, triangles) = surface(&gap, [-corner, corner], CUBES / 2);
    let file = in_space(&points, &triangles).unwrap();
    assert!(triangles.len() > 2000 && file.len() < 12 * triangles.len(), "{} {}", file.len(), triangles.len());
    assert!(String::from_utf8(file).unwrap().contains("vtkZLibDataCompressor"));
}
