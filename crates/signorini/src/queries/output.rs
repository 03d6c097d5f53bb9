//! The file of answers.

use super::answer::Format;
use super::answered::Answered;
use super::query::QueriesError;
use std::fs::File;
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// A file of answers that grows under another name until it is whole. What is no file, such as a pipe, is written at
/// once.
pub struct Output {
    path: PathBuf,
    part: PathBuf,
    out: BufWriter<File>,
    format: Format,
    rows: usize,
}

impl Output {
    pub fn create(path: &Path) -> Result<Self, QueriesError> {
        let mut part = path.as_os_str().to_owned();
        if !path.exists() || path.is_file() {
            part.push(".part");
        }
        let (path, part, format) = (path.to_path_buf(), PathBuf::from(part), Format::of(path));
        let create = || -> io::Result<BufWriter<File>> {
            let mut out = BufWriter::with_capacity(1 << 20, File::create(&part)?);
            out.write_all(&format.head(0))?;
            Ok(out)
        };
        match create() {
            Ok(out) => Ok(Output { path, part, out, format, rows: 0 }),
            Err(source) => Err(QueriesError::Write { path, source }),
        }
    }

    pub fn format(&self) -> Format {
        self.format
    }

    pub fn write(&mut self, answered: &[Answered]) -> Result<(), QueriesError> {
        let written = answered.iter().try_for_each(|a| self.out.write_all(&a.text));
        self.rows += answered.len();
        written.map_err(|source| QueriesError::Write { path: self.path.clone(), source })
    }

    /// Removes what was written, where it is a file.
    pub fn discard(self) {
        if self.part != self.path {
            let _ = std::fs::remove_file(self.part);
        }
    }

    /// Ends the file and gives it its name.
    pub fn finish(self) -> Result<(), QueriesError> {
        let Output { path, part, mut out, format, rows } = self;
        let finish = || -> io::Result<()> {
            out.write_all(format.tail())?;
            if format == Format::Npy {
                // Now the number of rows is known.
                out.seek(SeekFrom::Start(0))?;
                out.write_all(&format.head(rows))?;
            }
            let file = out.into_inner().map_err(io::IntoInnerError::into_error)?;
            if part == path {
                return Ok(());
            }
            file.sync_all()?;
            std::fs::rename(&part, &path)
        };
        finish().map_err(|source| QueriesError::Write { path: path.clone(), source })
    }
}
