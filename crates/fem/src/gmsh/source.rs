//! Tokens of a mesh file, or raw numbers where it is binary.

use super::error::GmshError;

/// Reads tokens, or raw numbers where the file is binary.
pub(super) struct Source<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) at: usize,
    pub(super) binary: bool,
    pub(super) swapped: bool,
    pub(super) section: &'static str,
}

impl<'a> Source<'a> {
    pub(super) fn line_number(&self) -> usize {
        1 + self.bytes[..self.at.min(self.bytes.len())].iter().filter(|b| **b == b'\n').count()
    }

    pub(super) fn token(&mut self) -> Result<&'a str, GmshError> {
        while self.bytes.get(self.at).is_some_and(|b| b.is_ascii_whitespace()) {
            self.at += 1;
        }
        let start = self.at;
        while self.bytes.get(self.at).is_some_and(|b| !b.is_ascii_whitespace()) {
            self.at += 1;
        }
        if start == self.at {
            return Err(GmshError::Truncated { section: self.section });
        }
        std::str::from_utf8(&self.bytes[start..self.at]).map_err(|_| self.malformed("text", "bytes"))
    }

    pub(super) fn malformed(&self, wanted: &'static str, found: &str) -> GmshError {
        GmshError::Malformed { line: self.line_number(), wanted, found: found.chars().take(40).collect() }
    }

    /// The rest of the line, for example after a count that binary data follow.
    pub(super) fn end_line(&mut self) {
        while self.bytes.get(self.at).is_some_and(|b| *b != b'\n') {
            self.at += 1;
        }
        self.at = (self.at + 1).min(self.bytes.len());
    }

    pub(super) fn raw<const N: usize>(&mut self) -> Result<[u8; N], GmshError> {
        let slice = self.bytes.get(self.at..self.at + N).ok_or(GmshError::Truncated { section: self.section })?;
        self.at += N;
        let mut out = [0; N];
        out.copy_from_slice(slice);
        if self.swapped {
            out.reverse();
        }
        Ok(out)
    }

    pub(super) fn text_integer(&mut self) -> Result<i64, GmshError> {
        let token = self.token()?;
        token.parse().map_err(|_| self.malformed("a whole number", token))
    }

    /// Four bytes where binary.
    pub(super) fn integer(&mut self) -> Result<i64, GmshError> {
        if self.binary { Ok(i64::from(i32::from_le_bytes(self.raw()?))) } else { self.text_integer() }
    }

    /// Eight bytes where binary.
    pub(super) fn size(&mut self) -> Result<i64, GmshError> {
        if self.binary { Ok(i64::from_le_bytes(self.raw()?)) } else { self.text_integer() }
    }

    pub(super) fn number(&mut self) -> Result<f64, GmshError> {
        if self.binary {
            return Ok(f64::from_le_bytes(self.raw()?));
        }
        let token = self.token()?;
        token.parse().map_err(|_| self.malformed("a number", token))
    }

    /// A count of things, each of which takes at least one byte.
    pub(super) fn count(&self, count: i64) -> Result<usize, GmshError> {
        if count < 0 || count as u64 > self.bytes.len() as u64 {
            return Err(GmshError::Count { section: self.section, count });
        }
        Ok(count as usize)
    }

    /// The head of a section of version 4.1: the number of its blocks, then three that are not needed.
    pub(super) fn blocks(&mut self) -> Result<usize, GmshError> {
        let blocks = self.size()?;
        for _ in 0..3 {
            self.size()?;
        }
        self.count(blocks)
    }

    /// Moves behind the next line that is exactly this one; false at the end of the file.
    pub(super) fn skip_to(&mut self, line: &str) -> bool {
        let mut at = self.at;
        while at < self.bytes.len() {
            let end = self.bytes[at..].iter().position(|b| *b == b'\n').map_or(self.bytes.len(), |n| at + n);
            if self.bytes[at..end].trim_ascii() == line.as_bytes() {
                self.at = (end + 1).min(self.bytes.len());
                return true;
            }
            at = end + 1;
        }
        false
    }
}
