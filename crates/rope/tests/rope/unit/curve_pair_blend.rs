//! Of `curve_pair::blend`.

use signorini_rope::curve_pair::blend::Blend;

#[test]
fn shares_pass_smoothly_from_one_to_none() {
    let blend = Blend::new(0.2, 0.5).unwrap();
    let at = |theta: f64| blend.point_share(theta.cos().powi(2));
    assert_eq!((at(0.1).0, at(0.2).0, at(0.6).0), (0.0, 0.0, 1.0));
    let middle = 0.5 * (0.2f64.cos().powi(2) + 0.5f64.cos().powi(2));
    assert!((blend.point_share(middle).0 - 0.5).abs() < 1e-14);
    let e = 1e-6;
    let difference = (blend.point_share(middle + e).0 - blend.point_share(middle - e).0) / (2.0 * e);
    assert!((difference - blend.point_share(middle).1).abs() < 1e-8);
    assert!(Blend::new(0.5, 0.2).is_err());
    // The integral over the parabolic overlap.
    let (penalty, force, radii) = (50.0, 0.8, [0.1, 0.3]);
    let line = blend.line_penalty(penalty, force, radii);
    let (pen, sine) = (force / penalty, 0.35f64.sin());
    let sum: f64 = (0..200_000)
        .map(|k| (k as f64 + 0.5) / 200_000.0 * 4.0 - 2.0)
        .map(|x| line * (pen - x * x * sine * sine / (2.0 * 0.4)).max(0.0) * 4.0 / 200_000.0)
        .sum();
    assert!((sum / force - 1.0).abs() < 1e-6);
}
