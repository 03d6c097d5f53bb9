//! Of `text_table`.

use signorini::testing::{Numbers, rows};

fn read(text: &str) -> Result<Vec<Vec<f64>>, String> {
    let mut numbers = Numbers::default();
    let rows = rows(text.as_bytes())?;
    let rows = rows.iter().map(|r| r.entries.iter().map(|e| numbers.read(r.line, e)).collect());
    let rows = rows.collect::<Result<_, _>>()?;
    numbers.finish().map(|()| rows)
}

#[test]
fn the_decimal_mark_is_known_or_refused() {
    let right = vec![vec![1.5, -20.25], vec![3.0, 4e-3]];
    for text in [
        "1.5,-20.25\n3,4e-3\n",
        "1.5, -20.25\n3, 4e-3\n",
        "1.5;-20.25\r\n3;4e-3\r\n",
        "1,5;-20,25\n\n# a, comment; with marks\n3;4e-3\n",
        "\u{feff}1,5; -20,25\n3 ;4e-3",
        "1,5\t-20,25\n3\t4e-3\n",
        " 1,5  -20,25\n3 4e-3\n",
        "1.5 -20.25\n3,0 4e-3\n".replace("3,0", "3.0").as_str(),
        "\"1,5\",\"-20,25\"\n\"3\",\"4e-3\"\n",
    ] {
        assert_eq!(read(text), Ok(right.clone()), "{text}");
    }
    for (text, words) in [
        ("1,234;2\n", &["line 1: `1,234` is `1.234` or `1234`"][..]),
        ("# n\n1.5;2\n2;16,73\n", &["line 3: `16,73` has a comma", "`1.5` in line 2"]),
        ("1,5;2.5\n", &["`1,5` has a comma"]),
        ("1,234,567;8\n", &["`1,234,567` is not a number"]),
        ("1,234.5;8\n", &["`1,234.5` is not a number"]),
        ("1,5 2\n2.5 3\n", &["line 1: `1,5` has a comma"]),
    ] {
        let error = read(text).unwrap_err();
        assert!(words.iter().all(|w| error.contains(w)), "{text}: {error}");
    }
    // One number that groups no thousands settles what the others are.
    assert_eq!(read("1,234;0,5\n"), Ok(vec![vec![1.234, 0.5]]));
}
