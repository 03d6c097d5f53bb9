//! Of `units`.

use signorini_problem::units::{AREA, ENERGY, FORCE, FORCE_PER_LENGTH, LENGTH, PRESSURE, Units};

#[test]
fn factors_and_dimensions() {
    let mm = Units::system("mm-N-MPa").unwrap();
    assert!((mm.factor("um").unwrap().0 - 1e-3).abs() < 1e-18);
    assert_eq!(mm.factor("N/m").unwrap().1, FORCE_PER_LENGTH);
    assert!((mm.factor("N/m").unwrap().0 - 1e-3).abs() < 1e-18);
    assert!((mm.factor("MPa").unwrap().0 - 1.0).abs() < 1e-15);
    let um = Units::system("um-uN-MPa").unwrap();
    assert!((um.factor("uN/um^2").unwrap().0 - 1.0).abs() < 1e-12);
    assert!((um.factor("J/m^2").unwrap().0 - 1.0).abs() < 1e-12);
    for micro in ["\u{b5}", "\u{3bc}"] {
        assert_eq!(um.factor(&format!("{micro}N/{micro}m^2")), um.factor("uN/um^2"));
        assert_eq!(mm.factor(&format!("{micro}J/m^2")), mm.factor("uJ/m^2"));
        assert_eq!(Units::system(&format!("{micro}m-{micro}N-MPa")), Some(um));
        assert_eq!(Units::from_names([&format!("{micro}m"), "uN", &format!("{micro}s"), "K"]).unwrap().length, 1e-6);
    }
    assert_eq!([PRESSURE, LENGTH, AREA, ENERGY].map(|d| mm.written(d)), ["MPa", "mm", "mm²", "mJ"]);
    assert_eq!([PRESSURE, LENGTH, FORCE, ENERGY].map(|d| um.written(d)), ["MPa", "µm", "µN", "µN·µm"]);
    assert!(mm.factor("furlong").unwrap_err().contains("unknown unit"));
    assert!(mm.factor("mm^x").is_err() && mm.factor("").is_err());
}
