//! Of `spread`.

use signorini_cells::cell::Site;
use signorini_cells::testing::{SAME_FACE, farthest_points};
use signorini_geometry::{Point, Vector};

/// Against choosing by looking at all points each time.
#[test]
fn the_farthest_points_are_the_farthest() {
    let sites: Vec<Site<2>> = (0..400)
        .map(|k| {
            let t = k as f64 * 0.618_033_988_749_895 % 1.0 * std::f64::consts::TAU;
            let normal = Vector::<2>::new(t.cos(), t.sin());
            Site { cell: 0, x: Point::from(normal * (1.0 + 0.1 * (3.0 * t).sin())), weight: 1.0, normal }
        })
        .collect();
    let spacing: Vec<f64> = (0..400).map(|k| 0.1 + 0.05 * f64::from(k % 3)).collect();
    let (chosen, nearest, far) = farthest_points(&sites, &spacing);
    let distance = |i: usize, j: usize| {
        let [a, b] = [&sites[i], &sites[j]];
        if a.normal.dot(&b.normal) <= SAME_FACE { f64::INFINITY } else { (a.x - b.x).norm() / spacing[i] }
    };
    let least = |i: usize, some: &[usize]| {
        some.iter()
            .enumerate()
            .fold((f64::INFINITY, 0), |best, (n, c)| if distance(i, *c) < best.0 { (distance(i, *c), n) } else { best })
    };
    for number in 1..chosen.len() {
        let all = (0..400).map(|i| least(i, &chosen[..number]).0);
        let (at, most) = all.enumerate().fold((0, 0.0), |best, (i, d)| if d > best.1 { (i, d) } else { best });
        assert!(chosen[number] == at && most >= 1.0, "{number}: {} {at}", chosen[number]);
    }
    assert!((0..400).all(|i| nearest[i] == least(i, &chosen).1));
    assert!((0..400).all(|i| least(i, &chosen).0 <= far) && far < 1.0);
}
