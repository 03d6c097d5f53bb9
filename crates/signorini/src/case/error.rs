//! Errors of a statement: what is wrong, where, and what would be right.

use std::ops::Range;

/// Something in a case file that cannot be used.
#[derive(Clone, Debug, thiserror::Error)]
#[error("{message}")]
pub struct CaseError {
    pub message: String,
    /// What to do about it.
    pub help: Option<String>,
    /// Where: file, its text, and the bytes.
    pub place: Option<Place>,
}

/// A place in a text.
#[derive(Clone, Debug)]
pub struct Place {
    pub name: String,
    pub text: String,
    pub span: Range<usize>,
}

impl Place {
    /// Line and column, from one, in characters.
    pub fn line_and_column(&self) -> (usize, usize) {
        let mut end = self.span.start.min(self.text.len());
        while !self.text.is_char_boundary(end) {
            end -= 1;
        }
        let before = &self.text[..end];
        let line = before.matches('\n').count() + 1;
        (line, before.chars().rev().take_while(|c| *c != '\n').count() + 1)
    }
}

impl CaseError {
    pub fn new(message: impl Into<String>) -> Self {
        Self { message: message.into(), help: None, place: None }
    }

    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    pub fn at(mut self, name: &str, text: &str, span: Range<usize>) -> Self {
        self.place = Some(Place { name: name.into(), text: text.into(), span });
        self
    }

    /// File, line, column and message in one line.
    pub fn one_line(&self) -> String {
        match &self.place {
            Some(place) => {
                let (line, column) = place.line_and_column();
                format!("{}:{line}:{column}: {}", place.name, self.message)
            }
            None => self.message.clone(),
        }
    }
}

impl miette::Diagnostic for CaseError {
    fn help<'a>(&'a self) -> Option<Box<dyn std::fmt::Display + 'a>> {
        self.help.as_ref().map(|h| Box::new(h) as _)
    }

    fn source_code(&self) -> Option<&dyn miette::SourceCode> {
        self.place.as_ref().map(|p| p as _)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = miette::LabeledSpan> + '_>> {
        let place = self.place.as_ref()?;
        let end = place.span.end.min(place.text.len());
        let start = place.span.start.min(end);
        Some(Box::new(std::iter::once(miette::LabeledSpan::new_with_span(Some("here".into()), start..end))))
    }
}

impl miette::SourceCode for Place {
    fn read_span<'a>(
        &'a self,
        span: &miette::SourceSpan,
        before: usize,
        after: usize,
    ) -> Result<Box<dyn miette::SpanContents<'a> + 'a>, miette::MietteError> {
        let inner = self.text.read_span(span, before, after)?;
        Ok(Box::new(miette::MietteSpanContents::new_named(
            self.name.clone(),
            inner.data(),
            *inner.span(),
            inner.line(),
            inner.column(),
            inner.line_count(),
        )))
    }
}

/// Turns an error of the TOML reader into ours, with the nearest valid key.
pub fn from_toml(name: &str, text: &str, error: &toml::de::Error) -> CaseError {
    let message = error.message().trim().replace('\n', " ");
    let mut ours = CaseError::new(message.clone());
    if let Some(rest) = message.strip_prefix("unknown field `").or_else(|| message.strip_prefix("unknown variant `"))
        && let Some((key, expected)) = rest.split_once('`')
    {
        let known: Vec<&str> = expected.split('`').skip(1).step_by(2).collect();
        ours.message = format!("unknown {} `{key}`", if quoted(text, error.span()) { "word" } else { "key" });
        ours.help = Some(suggestion(key, &known));
    } else if let Some(key) = message.strip_prefix("missing field `").and_then(|r| r.strip_suffix('`')) {
        ours.message = format!("missing key `{key}`");
        ours.help = Some(format!("add `{key} = …` to this table"));
    } else if let (true, Some(name)) =
        (message.contains("wanted exactly 1 element"), body_without_kind(text, error.span()))
    {
        ours.message = format!("what kind of body `{name}` is, is not said, or said twice");
        ours.help = Some(format!(
            "[bodies.{name}.KIND] with one of the kinds {}",
            super::schema::keys_in("bodies.NAME").join(", ")
        ));
    } else if message.contains("wanted exactly 1 element") || message.contains("wanted string or table") {
        ours.message = "expected a choice: one word in quotes, or a table with exactly one key".into();
        ours.help = key_before(text, error.span()).map(|key| format!("`signorini explain {key}` tells the choices"));
    } else if let Some((found, wanted)) = message
        .strip_prefix("invalid type: ")
        .or_else(|| message.strip_prefix("invalid value: "))
        .and_then(|rest| rest.rsplit_once(", expected "))
    {
        ours.message = format!("expected {}, found {}", in_words(wanted), found_in_words(found));
    }
    let span = error.span().unwrap_or(0..0);
    // An error in a table without a key of its own spans the whole table: its first line says enough.
    let end =
        text[span.start.min(text.len())..span.end.min(text.len())].find('\n').map_or(span.end, |n| span.start + n);
    ours.at(name, text, span.start..end.max(span.start))
}

/// The body without a kind, or with several, that an error at a place is about.
fn body_without_kind(text: &str, span: Option<Range<usize>>) -> Option<String> {
    let document = toml_edit::Document::parse(text).ok()?;
    let bodies = document.get("bodies")?.as_table_like()?;
    let start = span?.start;
    let wrong = |item: &toml_edit::Item| {
        item.as_table_like().is_some_and(|kinds| kinds.len() != 1) && item.span().is_none_or(|s| s.start == start)
    };
    bodies.iter().find(|(_, item)| wrong(item)).map(|(name, _)| name.to_string())
}

/// Whether a place in a text is one in quotes.
fn quoted(text: &str, span: Option<Range<usize>>) -> bool {
    span.and_then(|s| text.get(s.start..)).is_some_and(|value| value.starts_with(['"', '\'']))
}

/// The last word of the key whose value stands at a place, where both are on one line.
fn key_before(text: &str, span: Option<Range<usize>>) -> Option<&str> {
    let before = text.get(..span?.start)?.trim_end().strip_suffix('=')?.trim_end();
    let word = before.rsplit(|c: char| !(c.is_alphanumeric() || c == '_')).next()?;
    (!word.is_empty()).then_some(word)
}

/// What a type of the reader is called in a case file.
fn in_words(wanted: &str) -> String {
    let wanted = wanted.trim();
    match wanted {
        "i64" | "u64" | "usize" | "i32" | "u32" => "a whole number".into(),
        "f64" => "a number".into(),
        "a boolean" | "bool" => "true or false".into(),
        "a string" | "string" => "a text in quotes".into(),
        "a sequence" => "a list in brackets".into(),
        "a map" => "a table".into(),
        other if other.starts_with("struct ") => "a table of keys".into(),
        other if other.starts_with("enum ") => "a choice: a table with exactly one key".into(),
        other if other.starts_with("a tuple of size ") || other.starts_with("an array of length ") => {
            let size = other.rsplit(' ').next().unwrap_or("");
            format!("a list of {size}")
        }
        other => other.to_string(),
    }
}

/// What the reader found, in words of a case file.
fn found_in_words(found: &str) -> String {
    let found = found.trim();
    match found.split_once(' ') {
        Some(("string", text)) => format!("the text `{}`", text.trim_matches('"')),
        Some(("integer" | "boolean", value)) => value.into(),
        Some(("floating", rest)) => rest.trim_start_matches("point ").into(),
        _ => match found {
            "map" => "a table".into(),
            "sequence" => "a list".into(),
            other => other.into(),
        },
    }
}

/// The nearest of the known words, or all of them.
pub fn suggestion(word: &str, known: &[&str]) -> String {
    let nearest = known.iter().map(|k| (distance(word, k), *k)).min();
    match nearest {
        // Another word altogether is no suggestion.
        Some((d, k)) if d <= 1 + word.chars().count() / 3 && d < word.chars().count() => format!("did you mean `{k}`?"),
        Some(_) => format!("known here: {}", known.join(", ")),
        None => "nothing is known here".into(),
    }
}

/// Edit distance.
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, ca) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, cb) in b.iter().enumerate() {
            let change = diagonal + usize::from(ca != *cb);
            diagonal = row[j + 1];
            row[j + 1] = change.min(row[j] + 1).min(row[j + 1] + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No name of a type of the program shows in a message.
    #[test]
    fn wrong_kinds_of_values_are_told_in_words() {
        let head = "space = \"line\"\n[bodies.film.membrane]\ntension = 1.0\n";
        for (line, expected) in [
            ("degree = \"two\"", "expected a whole number, found the text `two`"),
            ("degree = 0.5", "expected a whole number, found `0.5`"),
            ("degree = [1]", "expected a whole number, found a list"),
            ("mesh.grid = 5", "expected a table of keys, found `5`"),
            ("mesh.grid = { cells = 40 }", "expected a list in brackets, found `40`"),
            ("domain = 3", "choice"),
            ("domain = {}", "choice"),
            ("domain = { disc.radius = 1, interval.to = 2 }", "exactly one key"),
            ("domain = \"disk\"", "unknown word `disk`"),
            ("domain.disk.radius = 3", "unknown key `disk`"),
            ("mesh.grid = { cells = [10], refine = 3 }", "expected a table of keys, found `3`"),
        ] {
            let text = format!("{head}{line}\n");
            let error = crate::case::Document::parse("case.toml", &text, &[]).expect_err(line);
            assert!(error.message.contains(expected), "{line}: {}", error.message);
            assert!(!error.message.contains("i64") && !error.message.contains("Key"), "{line}: {}", error.message);
        }
    }

    #[test]
    fn the_choices_of_a_key_are_pointed_to() {
        for line in ["domain = 3", "domain = { disc.radius = 1, interval.to = 2 }", "domain={}"] {
            let text = format!("space = \"line\"\n[bodies.film.membrane]\ntension = 1.0\n{line}\n");
            let error = crate::case::Document::parse("case.toml", &text, &[]).expect_err(line);
            assert!(error.help.is_some_and(|h| h.contains("explain domain")), "{line}");
        }
        assert_eq!(key_before("a = { b.c = 1", Some(12..13)), Some("c"));
        assert_eq!(key_before("[1, 2]", Some(4..5)), None);
    }

    #[test]
    fn near_words_are_suggested_and_places_are_counted_in_characters() {
        assert_eq!(suggestion("tensoin", &["tension", "degree"]), "did you mean `tension`?");
        assert!(suggestion("q", &["tension", "degree"]).contains("known here"));
        assert!(suggestion("q", &["e", "x"]).contains("known here"));
        let place = Place { name: "a".into(), text: "ä = 1\nbé = 2".into(), span: 10..11 };
        assert_eq!(place.line_and_column(), (2, 3));
    }
}
