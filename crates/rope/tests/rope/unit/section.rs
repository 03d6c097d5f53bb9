//! Of `section`.

use signorini_rope::section::{Section, rectangle_torsion_constant};
use std::f64::consts::PI;

#[test]
fn sections_have_the_values_of_the_tables() {
    // Timoshenko & Goodier: 0.1406 a⁴ for a square, a b³/3 for a strip.
    assert!((rectangle_torsion_constant(1.0, 1.0) - 0.140_577_0).abs() < 1e-6);
    assert!((rectangle_torsion_constant(2.0, 1.0) / 2.0 - 0.228_7).abs() < 1e-4);
    assert!((rectangle_torsion_constant(1e-3, 5.0) / (5.0e-9 / 3.0) - 1.0).abs() < 2e-4);
    let s = Section::Circle { radius: 0.1 }.stiffness(210e9, 0.3).unwrap();
    assert!((s.bending[0] / (210e9 * PI * 1e-4 / 4.0) - 1.0).abs() < 1e-14);
    assert!((s.torsion / s.bending[0] - 1.0 / 1.3).abs() < 1e-14);
    let s = Section::Rectangle { width: 2.0, height: 3.0 }.stiffness(1.0, 0.0).unwrap();
    assert!((s.bending[0] - 4.5).abs() < 1e-14 && (s.bending[1] - 2.0).abs() < 1e-14);
    assert!((s.shear[0] - 2.5).abs() < 1e-14);
    assert!(Section::Circle { radius: -1.0 }.stiffness(1.0, 0.0).is_err());
    assert!(Section::Circle { radius: 1.0 }.stiffness(1.0, 0.7).is_err());
}
