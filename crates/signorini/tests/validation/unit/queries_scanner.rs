//! Of `queries::scanner`.

use signorini::queries::scanner::Scanner;

fn read(text: &str) -> (Vec<String>, Option<String>) {
    let mut scanner = Scanner::new(text.as_bytes());
    let mut cases = Vec::new();
    loop {
        match scanner.next_case() {
            Ok(Some(case)) => cases.push(String::from_utf8(case.text).unwrap()),
            Ok(None) => return (cases, None),
            Err(error) => return (cases, Some(error.to_string())),
        }
    }
}

#[test]
fn cases_are_cut_at_their_own_brackets() {
    let (cases, error) = read(r#"{"format":"cpp-corpus-1","cases":[{"a":"]}\\\"{"}, {"b":[1,{"c":NaN}]} ,3]}"#);
    assert_eq!(error, None);
    assert_eq!(cases, [r#"{"a":"]}\\\"{"}"#, r#"{"b":[1,{"c":NaN}]}"#, "3"]);
}

#[test]
fn a_truncated_file_keeps_its_whole_cases() {
    let (cases, error) = read("{\"format\":\"cpp-corpus-1\",\n\"cases\":[{\"a\":1},\n{\"b\":[1,");
    assert_eq!(cases.len(), 1);
    let error = error.unwrap();
    assert!(error.contains("line 3") && error.contains("truncated"), "{error}");
}

#[test]
fn what_is_not_a_corpus_is_refused() {
    for (text, word) in [
        ("", "truncated"),
        ("[]", "expected `{`"),
        ("{}", "no `cases`"),
        (r#"{"format":"x","cases":[]}"#, "valid is \"cpp-corpus-1\""),
        (r#"{"cases":[]}"#, "no `format`"),
        (r#"{"format":"cpp-corpus-1","data":[]}"#, "unknown key `data`"),
        (r#"{"format":"cpp-corpus-1","cases":{}}"#, "expected `[`"),
    ] {
        let error = read(text).1.unwrap();
        assert!(error.contains(word), "{text}: {error}");
    }
}
