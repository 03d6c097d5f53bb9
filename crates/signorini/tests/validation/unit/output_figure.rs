//! Of `output::figure`.

use signorini::output::figure::{exact, figure, figures, told, told_vector};

#[test]
fn no_digit_is_told_that_a_figure_does_not_have() {
    assert_eq!(figure(11835.258326101, Some(5e-2)), "11835.26");
    assert_eq!(figure(11835.258326101, Some(30.0)), "11840");
    assert_eq!(figure(236.705166520, Some(1e-3)), "236.705");
    assert_eq!(figure(-0.5, Some(30.0)), "0");
    assert_eq!(figure(1.25, None), "1.250");
    assert_eq!(figure(1.25, Some(0.0)), "1.250");
    assert_eq!(figure(1.0 / 3.0, Some(1e-11)), "0.3333333333");
    assert_eq!(figure(1e-9, Some(1e-3)), "0.000");
    assert_eq!(figure(-1e-9, Some(1e-3)), "0.000");
    assert_eq!(figure(0.0, None), "0");
}

#[test]
fn small_and_large_numbers_keep_their_digits() {
    assert_eq!(figure(1.2345678e-8, None), "1.235e-8");
    assert_eq!(figure(1.2345678e-8, Some(2e-10)), "1.23e-8");
    assert_eq!(figure(2.5e12, None), "2.500e12");
    assert_eq!(figure(-3.25e-3, None), "-0.003250");
    assert_eq!(figure(f64::NAN, None), "NaN");
    assert_eq!(told(26.0704, Some(9e-3), "N"), "26.070 ± 9e-3 N");
    assert_eq!(figures(&[-2e-16, 28.4182, -3e-2], None), "(0.00, 28.42, -0.03)");
    assert_eq!(figures(&[0.0, 26.0704], Some(9e-3)), "(0, 26.070)");
    assert_eq!(told_vector(&[0.0, -1e-3], Some(4e-17), "N"), "(0, -0.001000000000) ± 1e-12 N");
    assert_eq!(told(1.10557280900, Some(2e-12), ""), "1.105572809 ± 1e-9");
    assert_eq!(exact(std::f64::consts::PI, "mm"), "3.141593 mm");
    assert_eq!(exact(0.0, "mm"), "0 mm");
    assert_eq!(told(1.5, None, ""), "1.500");
}
