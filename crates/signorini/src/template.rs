//! Cases to begin with: those of the gallery, each key with what it means above it.

use crate::case::schema;
use crate::gallery::Example;

/// The text of a case of the gallery with comments, for an editor that finds the schema beside it.
pub fn annotated(example: &Example) -> String {
    let keys = schema::keys();
    let mut text = format!("#:schema ./{SCHEMA_FILE}\n# {}.\n", capitalised(example.about));
    text += "# Run it with  signorini run case.toml  and ask about any key with  signorini explain KEY\n";
    let mut header = String::new();
    let mut open = 0i32;
    for line in example.case.lines() {
        let plain = line.trim();
        if open == 0 && plain.starts_with('[') {
            header = plain.trim_matches(['[', ']']).to_string();
        } else if open == 0
            && let Some((key, _)) = plain.split_once('=')
            && !plain.starts_with('#')
        {
            let path = if header.is_empty() { key.trim().to_string() } else { format!("{header}.{}", key.trim()) };
            if let Some(found) = keys.iter().find(|k| is_path(&k.path, &path)) {
                text += &format!("# {}\n", found.about);
            }
        }
        open += balance(plain);
        text += line;
        text.push('\n');
    }
    text
}

/// What the schema is called beside a case.
pub const SCHEMA_FILE: &str = "case.schema.json";

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

/// Brackets that a line leaves open, outside of quotes and comments.
fn balance(line: &str) -> i32 {
    let mut quoted = false;
    let mut open = 0;
    for c in line.chars() {
        match c {
            '"' => quoted = !quoted,
            '#' if !quoted => break,
            '[' | '{' if !quoted => open += 1,
            ']' | '}' if !quoted => open -= 1,
            _ => {}
        }
    }
    open
}

/// Whether a path of a case is that of a key, in which `NAME` stands for any name.
fn is_path(key: &str, path: &str) -> bool {
    let (key, path): (Vec<&str>, Vec<&str>) = (key.split('.').collect(), path.split('.').collect());
    key.len() == path.len() && key.iter().zip(&path).all(|(k, p)| *k == "NAME" || k.trim_end_matches("[]") == p.trim())
}
