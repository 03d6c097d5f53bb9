//! Of `plan::reader`.

use signorini::plan::reader::split_unit;

#[test]
fn units_are_told_from_expressions() {
    assert_eq!(split_unit("0.1 mm"), ("0.1", Some("mm")));
    assert_eq!(split_unit("-1e-3 N/m"), ("-1e-3", Some("N/m")));
    assert_eq!(split_unit("(2 + x) MPa"), ("(2 + x)", Some("MPa")));
    assert_eq!(split_unit("-(2 + x) kPa"), ("-(2 + x)", Some("kPa")));
    assert_eq!(split_unit("150um"), ("150", Some("um")));
    assert_eq!(split_unit("-1e-3N/m"), ("-1e-3", Some("N/m")));
    assert_eq!(split_unit("(2 + x)kPa"), ("(2 + x)", Some("kPa")));
    assert_eq!(split_unit("2x"), ("2x", None));
    assert_eq!(split_unit("(2 + x)*y"), ("(2 + x)*y", None));
    assert_eq!(split_unit("2*x"), ("2*x", None));
    assert_eq!(split_unit("x"), ("x", None));
    assert_eq!(split_unit(" (1"), (" (1", None));
}
