//! Of `output::panel`.

use signorini::testing::{Axis, Panel};

#[test]
fn points_are_placed_in_fractions_of_a_pixel_and_rounding_is_not_magnified() {
    let mut svg = String::new();
    let y = Axis::around("y", (1.0, 1.0 + 1e-14));
    let panel = Panel::new(&mut svg, [0.0, 0.0, 416.0, 264.0], Axis::new("x", (0.0, 3.0)), y);
    let (x, from) = panel.at((1.0, 1.0));
    assert!((x - (92.0 + 100.0)).abs() < 1e-9, "{x}");
    let (_, to) = panel.at((1.0, 1.0 + 1e-14));
    assert!((from - to).abs() < 1e-3 && from > 12.0 && from < 212.0, "{from} {to}");
    assert!(svg.contains(">1.5<") || svg.contains(">1.0<"), "{svg}");
}

#[test]
fn ticks_of_a_logarithmic_axis_are_powers_of_ten() {
    let axis = Axis { log: true, ..Axis::new("r", (5e-4, 200.0)) };
    let ticks = axis.ticks(500.0);
    assert_eq!(ticks.first().map(|t| t.1.as_str()), Some("1e-3"));
    assert_eq!(ticks.last().map(|t| t.1.as_str()), Some("100"));
    assert!((axis.place(0.1) - (200f64).ln() / (4e5f64).ln()).abs() < 1e-12);
}
