//! Cuts a file of queries into cases without holding more than one in memory, and without letting a case that is not
//! JSON spoil the others.

use std::io::{self, BufRead};

/// The largest case that is read.
pub const LARGEST_CASE: usize = 256 << 20;

/// Why a file cannot be read further.
#[derive(Debug, thiserror::Error)]
pub enum ScanError {
    #[error("cannot read: {0}")]
    Read(#[from] io::Error),
    #[error("line {line}: {message}")]
    Syntax { line: usize, message: String },
}

/// One entry of `cases`, or the shapes, as text, with the line on which it begins.
pub struct RawCase {
    pub line: usize,
    pub text: Vec<u8>,
}

/// A reader of `{"format": ..., "shapes": { ... }, "cases": [ ... ]}`; `shapes` may be left out.
pub struct Scanner<R> {
    input: R,
    line: usize,
    state: State,
    format_seen: bool,
    shapes: Option<RawCase>,
    cases_seen: bool,
}

#[derive(PartialEq)]
enum State {
    Start,
    Keys,
    Cases { first: bool },
    End,
}

impl<R: BufRead> Scanner<R> {
    pub fn new(input: R) -> Self {
        Scanner { input, line: 1, state: State::Start, format_seen: false, shapes: None, cases_seen: false }
    }

    fn fail<T>(&self, message: impl Into<String>) -> Result<T, ScanError> {
        Err(ScanError::Syntax { line: self.line, message: message.into() })
    }

    fn peek(&mut self) -> Result<Option<u8>, ScanError> {
        Ok(self.input.fill_buf()?.first().copied())
    }

    fn take(&mut self) -> Result<Option<u8>, ScanError> {
        let byte = self.peek()?;
        if let Some(byte) = byte {
            self.input.consume(1);
            self.line += usize::from(byte == b'\n');
        }
        Ok(byte)
    }

    /// The next byte that is not white space, left in place.
    fn next_token(&mut self) -> Result<u8, ScanError> {
        loop {
            match self.peek()? {
                Some(b' ' | b'\t' | b'\r' | b'\n') => {
                    self.take()?;
                }
                Some(byte) => return Ok(byte),
                None => return self.fail("the file ends early: it may be truncated"),
            }
        }
    }

    fn expect(&mut self, wanted: u8) -> Result<(), ScanError> {
        let found = self.next_token()?;
        if found != wanted {
            return self.fail(format!("expected `{}`, found `{}`", char::from(wanted), char::from(found)));
        }
        self.take()?;
        Ok(())
    }

    /// The text of the next value: up to the bracket that closes it, or the end of a bare word.
    fn value(&mut self) -> Result<Vec<u8>, ScanError> {
        let mut text = Vec::new();
        // Brackets that are open; one that is never closed ends with the bracket around it.
        let mut open: Vec<u8> = Vec::new();
        let mut in_string = false;
        self.next_token()?;
        loop {
            // Whole stretches at a time: files are large.
            let buffer = self.input.fill_buf()?;
            if buffer.is_empty() {
                return self.fail("the file ends inside a value: it may be truncated");
            }
            let mut used = 0;
            let mut done = false;
            for &byte in buffer {
                if in_string {
                    used += 1;
                    let escaped = text.last() == Some(&b'\\') && odd_backslashes(&text);
                    text.push(byte);
                    if byte == b'"' && !escaped {
                        in_string = false;
                        done = open.is_empty();
                    }
                } else {
                    if open.is_empty() && !text.is_empty() && matches!(byte, b',' | b'}' | b']') {
                        done = true;
                        break;
                    }
                    used += 1;
                    text.push(byte);
                    match byte {
                        b'"' => in_string = true,
                        b'{' | b'[' => open.push(byte),
                        b'}' | b']' => {
                            let partner = if byte == b'}' { b'{' } else { b'[' };
                            if let Some(at) = open.iter().rposition(|&b| b == partner) {
                                open.truncate(at);
                            }
                            done = open.is_empty();
                        }
                        b'\n' => self.line += 1,
                        _ => {}
                    }
                }
                if done {
                    break;
                }
            }
            self.input.consume(used);
            if text.len() > LARGEST_CASE {
                return self.fail(format!("a value of more than {} MiB", LARGEST_CASE >> 20));
            }
            if done {
                return Ok(text);
            }
        }
    }

    fn key(&mut self) -> Result<String, ScanError> {
        if self.next_token()? != b'"' {
            return self.fail("expected the name of a key in double quotes");
        }
        let text = self.value()?;
        match serde_json::from_slice(&text) {
            Ok(key) => Ok(key),
            Err(_) => self.fail("a key that is not a string"),
        }
    }

    /// The next case; `None` after the last one.
    ///
    /// # Errors
    /// The file cannot be read, or is not of this form; after an error there is nothing more.
    pub fn next_case(&mut self) -> Result<Option<RawCase>, ScanError> {
        let result = self.advance();
        if result.is_err() {
            self.state = State::End;
        }
        result
    }

    /// The named shapes, as text, once a case has been asked for.
    pub fn take_shapes(&mut self) -> Option<RawCase> {
        self.shapes.take()
    }

    fn advance(&mut self) -> Result<Option<RawCase>, ScanError> {
        loop {
            match self.state {
                State::End => return Ok(None),
                State::Start => {
                    self.expect(b'{')?;
                    self.state = State::Keys;
                    if self.next_token()? == b'}' {
                        return self.fail("no `cases`");
                    }
                }
                State::Keys => {
                    let key = self.key()?;
                    self.expect(b':')?;
                    match key.as_str() {
                        "cases" => {
                            self.expect(b'[')?;
                            self.cases_seen = true;
                            self.state = State::Cases { first: true };
                            continue;
                        }
                        "format" => {
                            let format = self.value()?;
                            if serde_json::from_slice::<String>(&format).ok().as_deref() != Some("cpp-corpus-1") {
                                let found = String::from_utf8_lossy(&format).trim().to_string();
                                return self.fail(format!("`format` is {found}, valid is \"cpp-corpus-1\""));
                            }
                            self.format_seen = true;
                        }
                        "shapes" => {
                            if self.cases_seen {
                                return self.fail("`shapes` comes after `cases`: put it before them");
                            }
                            self.next_token()?;
                            let line = self.line;
                            let text = self.value()?;
                            if self.shapes.replace(RawCase { line, text }).is_some() {
                                return self.fail("`shapes` is given twice");
                            }
                        }
                        other => {
                            return self
                                .fail(format!("unknown key `{other}`, valid are `format`, `shapes` and `cases`"));
                        }
                    }
                    self.after_value()?;
                }
                State::Cases { first } => {
                    match self.next_token()? {
                        b']' => {
                            self.take()?;
                            self.after_value()?;
                            continue;
                        }
                        b',' if !first => {
                            self.take()?;
                        }
                        other if !first => {
                            return self
                                .fail(format!("expected `,` or `]` after a case, found `{}`", char::from(other)));
                        }
                        _ => {}
                    }
                    self.state = State::Cases { first: false };
                    self.next_token()?;
                    let line = self.line;
                    let text = self.value()?;
                    return Ok(Some(RawCase { line, text }));
                }
            }
        }
    }

    /// What follows the value of a key at the top.
    fn after_value(&mut self) -> Result<(), ScanError> {
        match self.next_token()? {
            b',' => {
                self.take()?;
                self.state = State::Keys;
                Ok(())
            }
            b'}' => {
                self.take()?;
                self.state = State::End;
                if self.format_seen { Ok(()) } else { self.fail("no `format`; valid is \"cpp-corpus-1\"") }
            }
            other => self.fail(format!("expected `,` or `}}`, found `{}`", char::from(other))),
        }
    }
}

fn odd_backslashes(text: &[u8]) -> bool {
    text.iter().rev().take_while(|&&b| b == b'\\').count() % 2 == 1
}
