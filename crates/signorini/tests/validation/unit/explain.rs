//! Of `explain`.

use signorini::explain::explain;

#[test]
fn keys_and_words_are_explained() {
    assert!(explain("iteration_limit").expect("known").contains("more cells"));
    assert!(explain("bodies.film.membrane.tension").expect("known").contains("Force per length"));
    assert!(explain("domain").expect("known").contains("with disc, "));
    assert!(explain("exit status").expect("known").contains("130"));
    assert!(explain("--to").expect("known").contains("NumPy"));
    assert!(explain("near-continuum").expect("known").contains("flat"));
    assert!(explain("touch:max_pressure").expect("known").contains("pressure"));
    assert!(explain("slip_z").expect("known").starts_with("along z: slip"));
    assert!(explain("touch:tensoin").is_err() && explain("tensoin_x").is_err());
    let wrong = explain("tensoin").expect_err("unknown");
    assert!(wrong.help.expect("help").contains("tension"));
    assert!(explain("").is_err());
}

#[test]
fn every_function_is_explained() {
    let all = explain("expressions").expect("known");
    for name in signorini::expression::function_names() {
        assert!(explain(name).expect(name).contains(&format!("{name} (function)")), "{name}");
        assert!(all.split([' ', ';', '(']).any(|w| w == name), "{name}");
    }
}
