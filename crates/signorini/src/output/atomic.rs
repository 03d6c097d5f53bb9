//! Files that are written whole or not at all.

use std::io::{self, Write};
use std::path::Path;

/// Writes a file under another name, which it then takes.
///
/// # Errors
/// What the file system says. What was written is gone then, and an earlier file stays.
pub fn write(path: &Path, content: &[u8]) -> io::Result<()> {
    let mut part = path.to_path_buf().into_os_string();
    part.push(".part");
    let store = || -> io::Result<()> {
        let mut file = std::fs::File::create(&part)?;
        file.write_all(content)?;
        file.sync_all()?;
        std::fs::rename(&part, path)
    };
    store().inspect_err(|_| {
        let _ = std::fs::remove_file(&part);
    })
}
