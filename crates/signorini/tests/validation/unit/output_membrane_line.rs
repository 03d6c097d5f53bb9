//! Of `output::membrane_line`.

use signorini::testing::{value_at, zones};

#[test]
fn pressure_is_drawn_from_front_to_front() {
    let x = |k: usize| k as f64;
    let pressure: Vec<(f64, f64)> = (0..8).map(|k| (x(k), if (2..5).contains(&k) { 3.0 } else { 0.0 })).collect();
    let touching: Vec<(f64, f64)> = pressure.iter().map(|p| (p.0, f64::from(u8::from(p.1 > 0.0)))).collect();
    let found = zones(&pressure, &touching, &[1.4, 4.75]);
    assert_eq!(found, [vec![(1.4, 3.0), (2.0, 3.0), (3.0, 3.0), (4.0, 3.0), (4.75, 3.0)]]);
    assert_eq!(value_at(&[(0.0, 0.0), (2.0, 4.0)], 0.5), 1.0);
}
