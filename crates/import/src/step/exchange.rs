//! The exchange structure of ISO 10303-21: instances with their number, line and parameters.

use std::collections::BTreeMap;

/// A parameter of a record.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Parameter {
    Number(f64),
    Text(String),
    /// Without the dots.
    Enumeration(String),
    Reference(u64),
    List(Vec<Parameter>),
    /// A value with its type, such as `LENGTH_MEASURE(25.4)`.
    Typed(String, Vec<Parameter>),
    /// `$` or `*`.
    Omitted,
}

/// A name with parameters.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Record {
    pub name: String,
    pub parameters: Vec<Parameter>,
}

/// An instance: one record, or several of a complex instance.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Instance {
    /// Counted from one.
    pub line: usize,
    pub records: Vec<Record>,
}

/// What the text is not: the line, and why.
pub(super) type Broken = (usize, String);

struct Tokens<'a> {
    bytes: &'a [u8],
    at: usize,
    line: usize,
}

/// Lists within lists beyond which a text is no model.
const DEEPEST: usize = 64;

/// The instances of the data sections.
pub(super) fn read(bytes: &[u8]) -> Result<BTreeMap<u64, Instance>, Broken> {
    let mut tokens = Tokens { bytes, at: 0, line: 1 };
    tokens.skip();
    if !tokens.take_word("ISO-10303-21") {
        return Err((1, "the file does not begin with `ISO-10303-21;`, so it is no STEP file".into()));
    }
    let mut out = BTreeMap::new();
    tokens.expect(b';')?;
    loop {
        tokens.skip();
        if tokens.take_word("END-ISO-10303-21") {
            return Ok(out);
        }
        if tokens.take_word("DATA") {
            tokens.skip();
            if tokens.peek() == Some(b'(') {
                tokens.list(0)?;
            }
            tokens.expect(b';')?;
            tokens.data(&mut out)?;
            continue;
        }
        if tokens.peek().is_none() {
            return Err((tokens.line, "the file ends before `END-ISO-10303-21;`: it is cut off".into()));
        }
        // Header, anchors, references and signatures say nothing of shapes.
        tokens.statement()?;
    }
}

impl Tokens<'_> {
    fn peek(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    fn next(&mut self) -> Option<u8> {
        let byte = self.peek()?;
        self.at += 1;
        self.line += usize::from(byte == b'\n');
        Some(byte)
    }

    /// White space and comments.
    fn skip(&mut self) {
        while let Some(byte) = self.peek() {
            if byte.is_ascii_whitespace() {
                self.next();
            } else if self.bytes[self.at..].starts_with(b"/*") {
                self.at += 2;
                while self.peek().is_some() && !self.bytes[self.at..].starts_with(b"*/") {
                    self.next();
                }
                self.at = (self.at + 2).min(self.bytes.len());
            } else {
                break;
            }
        }
    }

    fn take_word(&mut self, word: &str) -> bool {
        let found = self.bytes[self.at..].starts_with(word.as_bytes());
        let after = self.bytes.get(self.at + word.len());
        let is_whole = !after.is_some_and(|b| b.is_ascii_alphanumeric() || *b == b'_');
        if found && is_whole {
            self.at += word.len();
        }
        found && is_whole
    }

    fn wrong(&self, wanted: &str) -> Broken {
        let rest = &self.bytes[self.at..(self.at + 20).min(self.bytes.len())];
        let shown = String::from_utf8_lossy(rest);
        match shown.lines().next() {
            Some(text) if !text.is_empty() => (self.line, format!("expected {wanted}, found `{text}`")),
            _ => (self.line, format!("expected {wanted}, and the file ends")),
        }
    }

    fn expect(&mut self, byte: u8) -> Result<(), Broken> {
        self.skip();
        if self.peek() != Some(byte) {
            return Err(self.wrong(&format!("`{}`", byte as char)));
        }
        self.next();
        Ok(())
    }

    /// Passes over everything up to a semicolon.
    fn statement(&mut self) -> Result<(), Broken> {
        let from = self.line;
        loop {
            self.skip();
            match self.peek() {
                Some(b'\'') => drop(self.text()?),
                Some(b';') => {
                    self.next();
                    return Ok(());
                }
                Some(_) => drop(self.next()),
                None => return Err((from, "a statement does not end".into())),
            }
        }
    }

    fn data(&mut self, out: &mut BTreeMap<u64, Instance>) -> Result<(), Broken> {
        loop {
            self.skip();
            if self.take_word("ENDSEC") {
                return self.expect(b';');
            }
            let line = self.line;
            self.expect(b'#')?;
            let id = self.digits()?;
            self.expect(b'=')?;
            self.skip();
            let records = if self.peek() == Some(b'(') {
                self.next();
                let mut records = Vec::new();
                loop {
                    self.skip();
                    if self.peek() == Some(b')') {
                        self.next();
                        break records;
                    }
                    records.push(self.record(0)?);
                }
            } else {
                vec![self.record(0)?]
            };
            self.expect(b';')?;
            if out.insert(id, Instance { line, records }).is_some() {
                return Err((line, format!("#{id} is there twice")));
            }
        }
    }

    fn digits(&mut self) -> Result<u64, Broken> {
        let from = self.at;
        while self.peek().is_some_and(|b| b.is_ascii_digit()) {
            self.at += 1;
        }
        let text = std::str::from_utf8(&self.bytes[from..self.at]).unwrap_or("");
        text.parse().map_err(|_| self.wrong("the number of an instance"))
    }

    fn word(&mut self) -> Result<String, Broken> {
        let from = self.at;
        while self.peek().is_some_and(|b| b.is_ascii_alphanumeric() || b == b'_' || b == b'!') {
            self.at += 1;
        }
        if self.at == from {
            return Err(self.wrong("the name of an entity"));
        }
        Ok(String::from_utf8_lossy(&self.bytes[from..self.at]).to_uppercase())
    }

    fn record(&mut self, depth: usize) -> Result<Record, Broken> {
        let name = self.word()?;
        self.skip();
        Ok(Record { name, parameters: self.list(depth)? })
    }

    fn list(&mut self, depth: usize) -> Result<Vec<Parameter>, Broken> {
        if depth > DEEPEST {
            return Err((self.line, "lists are nested too deeply".into()));
        }
        self.expect(b'(')?;
        let mut out = Vec::new();
        loop {
            self.skip();
            match self.peek() {
                Some(b')') => {
                    self.next();
                    return Ok(out);
                }
                Some(b',') if !out.is_empty() => drop(self.next()),
                _ if out.is_empty() => {}
                _ => return Err(self.wrong("`,` or `)`")),
            }
            out.push(self.parameter(depth)?);
        }
    }

    fn parameter(&mut self, depth: usize) -> Result<Parameter, Broken> {
        self.skip();
        Ok(match self.peek() {
            Some(b'$' | b'*') => {
                self.next();
                Parameter::Omitted
            }
            Some(b'#') => {
                self.next();
                Parameter::Reference(self.digits()?)
            }
            Some(b'\'') => Parameter::Text(self.text()?),
            Some(b'"') => {
                // Binary data, which no shape has.
                self.next();
                while self.peek().is_some_and(|b| b != b'"') {
                    self.next();
                }
                self.next();
                Parameter::Omitted
            }
            Some(b'.') => {
                self.next();
                let word = self.word()?;
                self.expect(b'.')?;
                Parameter::Enumeration(word)
            }
            Some(b'(') => Parameter::List(self.list(depth + 1)?),
            Some(b'+' | b'-' | b'0'..=b'9') => {
                let from = self.at;
                while self.peek().is_some_and(|b| b.is_ascii_digit() || b"+-.eE".contains(&b)) {
                    self.at += 1;
                }
                let text = std::str::from_utf8(&self.bytes[from..self.at]).unwrap_or("");
                let value: f64 = text.parse().map_err(|_| (self.line, format!("`{text}` is no number")))?;
                if !value.is_finite() {
                    return Err((self.line, format!("`{text}` is beyond the range of numbers")));
                }
                Parameter::Number(value)
            }
            Some(_) => {
                let Record { name, parameters } = self.record(depth + 1)?;
                Parameter::Typed(name, parameters)
            }
            None => return Err(self.wrong("a value")),
        })
    }

    /// Quotes within are doubled; other characters than those of ASCII stay as they are written.
    fn text(&mut self) -> Result<String, Broken> {
        let line = self.line;
        self.next();
        let mut out = Vec::new();
        loop {
            match self.next() {
                Some(b'\'') if self.peek() == Some(b'\'') => {
                    self.next();
                    out.push(b'\'');
                }
                Some(b'\'') => return Ok(String::from_utf8_lossy(&out).into_owned()),
                // Long texts are broken anywhere.
                Some(b'\n' | b'\r') => {}
                Some(byte) => out.push(byte),
                None => return Err((line, "a text does not end".into())),
            }
        }
    }
}
