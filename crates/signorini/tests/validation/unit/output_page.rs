//! Of `output::page`.

use signorini::testing::{Scale, sheet};

#[test]
fn a_scale_does_not_magnify_rounding() {
    let even = Scale::between(-1e-17, 2e-17, 1.0);
    assert!(even.place(2e-17) - even.place(-1e-17) < 1e-9);
    let field = Scale::of(&[3.0, 3.0 + 1e-13, 3.0 - 1e-13]);
    assert!(field.place(3.0 + 1e-13) - field.place(3.0 - 1e-13) < 1e-9);
    let true_field = Scale::between(-2.0, 2.0, 1.0);
    assert_eq!([-2.0, 0.0, 2.0].map(|v| true_field.place(v)), [0.0, 0.5, 1.0]);
}

#[test]
fn rows_of_a_sheet_are_as_wide_as_the_sheet() {
    let picture = |w: u32, h: u32| format!("<svg width=\"{w}\" height=\"{h}\"></svg>");
    let text = sheet(&[picture(900, 600), picture(600, 600), picture(800, 400), picture(500, 500), picture(300, 400)]);
    let numbers = |key: &str| -> Vec<f64> {
        let inner = text.split_once("fill=\"white\"/>").map_or("", |t| t.1);
        inner.split(key).skip(1).filter_map(|t| t.split('"').next()?.parse().ok()).collect()
    };
    let (x, y, width) = (numbers("svg x=\""), numbers(" y=\""), numbers(" width=\""));
    assert_eq!(y.len(), 5);
    for k in [1, 4] {
        assert!((x[k] + width[k] - 1520.0).abs() < 0.2, "{x:?} {width:?}");
    }
    assert_eq!((y[0], y[2]), (y[1], y[4]));
}
