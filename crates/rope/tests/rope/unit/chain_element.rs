//! Of `chain::element`.

use signorini_geometry::Vector;
use signorini_rope::chain::element::{Drive, Stretched, stretched};

#[test]
fn derivatives_are_exact_and_slack_is_nothing() {
    let (ea, l) = (70.0, 1.1);
    let d = Vector::<3>::new(0.9, -0.7, 0.6);
    for drive in [Drive::Elastic, Drive::Tension(3.0)] {
        let at = |d: &Vector<3>, l: f64| stretched(d, ea, l, drive);
        let now = at(&d, l);
        let e = 1e-5;
        for k in 0..3 {
            let step = Vector::<3>::from_fn(|i, _| if i == k { e } else { 0.0 });
            let (p, m) = (at(&(d + step), l), at(&(d - step), l));
            assert!(((p.energy - m.energy) / (2.0 * e) - now.force[k]).abs() < 1e-8);
            assert!(((p.force - m.force) / (2.0 * e) - now.stiffness.column(k)).norm() < 1e-6);
        }
        let (p, m) = (at(&d, l + e), at(&d, l - e));
        assert!(((p.energy - m.energy) / (2.0 * e) - now.by_length.0).abs() < 1e-7);
        assert!(((p.by_length.0 - m.by_length.0) / (2.0 * e) - now.by_length.1).abs() < 1e-5);
        assert!(((p.force - m.force) / (2.0 * e) - now.by_length.2).norm() < 1e-5);
    }
    assert_eq!(stretched(&d, ea, 1.5, Drive::Elastic), Stretched::default());
}
