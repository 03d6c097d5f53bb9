//! The schema and the reference are those of the types.

use signorini::case::schema;

#[test]
fn the_gallery_fits_the_schema_and_mistakes_do_not() {
    let validator = jsonschema::validator_for(&schema::schema()).expect("a schema");
    let json = |text: &str| serde_json::to_value(text.parse::<toml::Table>().expect("TOML")).expect("JSON");
    for example in &signorini::gallery::GALLERY {
        let case = json(example.case);
        let errors: Vec<String> = validator.iter_errors(&case).map(|e| format!("{}: {e}", e.instance_path())).collect();
        assert!(errors.is_empty(), "{}: {errors:#?}", example.name);
    }
    let good = signorini::gallery::find("flat_disc").expect("a case").case;
    for (from, to) in [
        ("tension", "tensoin"),
        ("space = \"plane\"", "space = \"plain\""),
        ("degree = 4", "degree = \"four\""),
        ("shape.height = \"-0.1\"", "shape.hight = \"-0.1\""),
        ("[contacts.touch]", "[contact.touch]"),
        ("between = [\"film\", \"floor\"]", "between = \"film\""),
    ] {
        assert!(good.contains(from), "{from}");
        assert!(!validator.is_valid(&json(&good.replace(from, to))), "{to}");
    }
}

#[test]
fn the_classes_of_the_python_package_are_up_to_date() {
    let text = schema::schema().to_string();
    let hash = text.bytes().fold(0xcbf2_9ce4_8422_2325, |h: u64, b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3));
    let path = format!("{}/../../python/signorini/_nouns.py", env!("CARGO_MANIFEST_DIR"));
    let classes = std::fs::read_to_string(path).expect("the classes");
    assert!(classes.contains(&format!("'{hash:016x}'")), "run  signorini schema | python3 python/generate.py");
}

#[test]
fn the_reference_is_up_to_date() {
    let path = format!("{}/../../docs/reference.md", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("the reference");
    assert!(text == signorini::explain::reference(), "write it anew: signorini schema --markdown > docs/reference.md");
}
