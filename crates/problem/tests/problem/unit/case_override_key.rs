//! Of `case::override_key`.

use signorini_problem::case::override_key::apply;

#[test]
fn settings_of_what_is_not_there_are_refused() {
    let text = "[bodies.film.membrane]\ntension = 1\n[loads.press]\non = \"film\"\nnormal = \"a\"\n[contacts.touch]\n\
        between = [\"film\", \"floor\"]\n";
    let set = |settings: &[&str]| {
        let list: Vec<String> = settings.iter().map(|s| (*s).to_string()).collect();
        apply("case", text, &list).map(|(text, _)| text)
    };
    for (setting, message, help) in [
        ("loads.pres.normal=-0.5", "there is no load `pres`", "did you mean `press`?"),
        ("bodies.fylm.membrane.degree=3", "there is no body `fylm`", "did you mean `film`?"),
        ("contacts.toch.friction.coulomb.mu=0.1", "there is no contact `toch`", "did you mean `touch`?"),
        ("supports.rim.displacement=0", "there is no support `rim`", "no `supports`"),
        ("constants.b=3", "there is no constant `b`", "no `constants`"),
    ] {
        let error = set(&[setting]).expect_err(setting);
        assert_eq!(error.message, message);
        assert!(error.help.is_some_and(|h| h.contains(help)), "{setting}");
    }
    assert!(set(&["loads.second.on=film", "loads.second.normal=1", "constants.a=3"]).is_ok());
    assert!(set(&["loads.press.normal=-2"]).is_ok());
}

#[test]
fn keys_are_replaced_added_and_refused() {
    let text = "a = 1 # one\n[b.c]\nd = \"x\"\n[[steps]]\nto = 1\n";
    let set = |s: &str| apply("case", text, &[s.to_string()]).map(|(text, _)| text);
    assert!(set("b.c.d=-2*t").unwrap().contains("d = \"-2*t\""));
    assert!(set("a=3").unwrap().starts_with("a = 3 # one"));
    assert!(set("b.e.f=2.5").unwrap().contains("f = 2.5"));
    assert!(set("steps.0.to=4").unwrap().contains("to = 4"));
    assert!(set("a.b=1").is_err() && set("novalue").is_err() && set("..=1").is_err());
}
