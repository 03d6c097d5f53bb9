//! Of `template`.

use signorini::gallery::GALLERY;
use signorini::template::annotated;

#[test]
fn templates_are_the_cases_with_comments() {
    for example in &GALLERY {
        let text = annotated(example);
        let values = |text: &str| text.parse::<toml::Table>().expect("TOML");
        assert_eq!(values(&text), values(example.case), "{}", example.name);
        signorini::case::read(example.name, &text, &[]).expect("a case");
        let comments = text.lines().filter(|l| l.starts_with("# ")).count();
        assert!(comments > 8, "{}: {comments}", example.name);
    }
}
