//! Tables of numbers in text files: what separates the columns, and which mark stands before decimals.
//!
//! The first row tells what separates the columns: semicolons, tabs, commas or blanks, the first of them that it has
//! outside of quotes. Where a comma does not separate, it may be the decimal mark, as spreadsheets of many countries
//! write it (`16,73;18,69`). It is read as one only where the file leaves no doubt: no number of it has a decimal point,
//! and not every comma could just as well group thousands (`1,234`).

use csv::StringRecord;

/// What separates the columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Separator {
    Byte(u8),
    Blanks,
}

/// A row of a table: the line on which it ends, counted from 1, and its entries without the blanks around them.
pub struct Row {
    pub line: u64,
    pub entries: StringRecord,
}

/// Cuts a file into rows. Empty lines and lines that begin with `#` are left out.
///
/// # Errors
/// In words: bytes that are no text in UTF-8.
pub fn rows(bytes: &[u8]) -> Result<Vec<Row>, String> {
    let text = std::str::from_utf8(bytes).map_err(|e| format!("not text: {e}"))?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let is_comment = |line: &str| line.trim_start().starts_with('#') || line.trim().is_empty();
    let first = text.lines().find(|l| !is_comment(l)).unwrap_or("");
    let byte = match separator(first) {
        Separator::Blanks => {
            let lines = text.lines().enumerate().filter(|(_, l)| !is_comment(l));
            let row = |(k, l): (usize, &str)| Row { line: k as u64 + 1, entries: l.split_whitespace().collect() };
            return Ok(lines.map(row).collect());
        }
        Separator::Byte(byte) => byte,
    };
    let mut builder = csv::ReaderBuilder::new();
    builder.delimiter(byte).trim(csv::Trim::All).comment(Some(b'#')).has_headers(false).flexible(true);
    let mut reader = builder.from_reader(text.as_bytes());
    let mut rows = Vec::new();
    let mut entries = StringRecord::new();
    while reader.read_record(&mut entries).map_err(|e| e.to_string())? {
        // A record begins before the comments that are left out: its end tells its line.
        let end = reader.position();
        let ended = text.as_bytes()[..end.byte() as usize].ends_with(b"\n");
        let line = end.line() - u64::from(ended);
        let empty = entries.iter().all(str::is_empty) && entries.len() < 2;
        if !empty && !entries.iter().next().is_some_and(|e| e.starts_with('#')) {
            rows.push(Row { line, entries: entries.clone() });
        }
    }
    Ok(rows)
}

/// What separates the columns of a file with this first row.
fn separator(row: &str) -> Separator {
    let mut quoted = false;
    let outside = row.chars().filter(|c| {
        quoted ^= *c == '"';
        !quoted
    });
    let outside: String = outside.collect();
    let words: Vec<&str> = outside.split_whitespace().collect();
    // Numbers with decimal commas between blanks.
    let numbers = |words: &[&str]| words.iter().all(|w| w.replacen(',', ".", 1).parse::<f64>().is_ok());
    match ";\t,".bytes().find(|b| outside.as_bytes().contains(b)) {
        None => Separator::Blanks,
        Some(b',')
            if words.len() > 1 && numbers(&words) && !words.iter().any(|w| w.starts_with(',') || w.ends_with(',')) =>
        {
            Separator::Blanks
        }
        Some(byte) => Separator::Byte(byte),
    }
}

/// The numbers of a file, and what they tell about its decimal mark.
#[derive(Default)]
pub struct Numbers {
    /// The line and the text of the first number with a decimal point, and of the first with a comma.
    point: Option<(u64, String)>,
    comma: Option<(u64, String)>,
    /// Whether the comma of a number can only be a decimal mark.
    certain: bool,
}

impl Numbers {
    /// The number of an entry.
    ///
    /// # Errors
    /// In words, without the place: the entry is empty or no number.
    pub fn read(&mut self, line: u64, entry: &str) -> Result<f64, String> {
        let mark = match entry.matches(',').count() {
            0 => entry.contains('.').then_some(&mut self.point),
            _ => Some(&mut self.comma),
        };
        let value = entry.replace(',', ".").parse();
        if let (Some(first), true) = (mark, value.is_ok()) {
            first.get_or_insert_with(|| (line, entry.to_string()));
            self.certain |= entry.contains(',') && !groups_thousands(entry);
        }
        value.map_err(|_| match entry {
            "" => "is empty".to_string(),
            _ if entry.contains(',') => {
                format!("`{entry}` is not a number: use a decimal point and no thousands separator")
            }
            _ => format!("`{entry}` is not a number"),
        })
    }

    /// Whether the decimal mark is beyond doubt, once all numbers are read.
    ///
    /// # Errors
    /// In words, with the lines.
    pub fn finish(&self) -> Result<(), String> {
        match (&self.comma, &self.point) {
            (Some((line, comma)), Some((other, point))) => Err(format!(
                "line {line}: `{comma}` has a comma and `{point}` in line {other} a point: use a decimal point and no \
                 thousands separator"
            )),
            (Some((line, comma)), None) if !self.certain => Err(format!(
                "line {line}: `{comma}` is `{}` or `{}`: use a decimal point and no thousands separator",
                comma.replace(',', "."),
                comma.replace(',', "")
            )),
            _ => Ok(()),
        }
    }
}

/// Whether the comma of a number may separate thousands, as in `12,345`.
fn groups_thousands(entry: &str) -> bool {
    let digits = entry.trim_start_matches(['+', '-']);
    digits.split_once(',').is_some_and(|(before, after)| {
        let whole = |s: &str| s.bytes().all(|b| b.is_ascii_digit());
        whole(before) && whole(after) && (1..=3).contains(&before.len()) && after.len() == 3 && !before.starts_with('0')
    })
}
