//! The result folder.

use std::io;
use std::path::{Path, PathBuf};

/// The file by which a folder is known as one of ours.
pub const MARKER: &str = "log.jsonl";
const FIRST_LINE: &str = "{\"event\":\"signorini\"";
/// Everything a run writes.
const OWN: [&str; 15] = [
    "summary.json",
    "log.jsonl",
    "history.csv",
    "fields.pvd",
    "contact.pvd",
    "fields",
    "contact",
    "pictures",
    "case.toml",
    "pairs.csv",
    "frames",
    "bodies.pvd",
    "checkpoint.json",
    "checkpoint",
    "pairs.pvd",
];

/// Results that could not be written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    #[error("cannot write `{path}`: {source}")]
    Write { path: PathBuf, source: io::Error },
    #[error("the folder `{path}` holds `{entry}`, which no run has written")]
    Foreign { path: PathBuf, entry: String },
    #[error("cannot draw a picture: {0}")]
    Picture(String),
}

/// A folder that belongs to one run.
#[derive(Clone, Debug)]
pub struct Folder {
    path: PathBuf,
}

impl Folder {
    /// Creates the folder, or empties that of an earlier run. A folder that holds anything else is refused.
    pub fn create(path: &Path) -> Result<Self, OutputError> {
        let fail = |source| OutputError::Write { path: path.to_path_buf(), source };
        if path.exists() {
            let entries: Vec<String> = std::fs::read_dir(path)
                .map_err(fail)?
                .filter_map(|e| e.ok().map(|e| e.file_name().to_string_lossy().into_owned()))
                .collect();
            let ours = std::fs::read_to_string(path.join(MARKER)).is_ok_and(|t| t.starts_with(FIRST_LINE));
            let foreign = entries.iter().find(|e| !ours || (!OWN.contains(&e.as_str()) && !e.ends_with(".part")));
            if let Some(entry) = foreign {
                return Err(OutputError::Foreign { path: path.to_path_buf(), entry: entry.clone() });
            }
            for entry in &entries {
                let p = path.join(entry);
                if p.is_dir() { std::fs::remove_dir_all(&p) } else { std::fs::remove_file(&p) }.map_err(fail)?;
            }
        }
        std::fs::create_dir_all(path).map_err(fail)?;
        let folder = Self { path: path.to_path_buf() };
        folder.write(MARKER, format!("{FIRST_LINE},\"version\":\"{}\"}}\n", env!("CARGO_PKG_VERSION")).as_bytes())?;
        Ok(folder)
    }

    /// The folder of an earlier run, as it is.
    pub fn of_earlier_run(path: &Path) -> Self {
        Self { path: path.to_path_buf() }
    }

    /// Removes a file or a folder of ours; what cannot be removed stays.
    pub fn remove(&self, name: &str) {
        let path = self.path.join(name);
        let _ = if path.is_dir() { std::fs::remove_dir_all(path) } else { std::fs::remove_file(path) };
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes a file whole, or not at all.
    pub fn write(&self, name: &str, content: &[u8]) -> Result<(), OutputError> {
        let path = self.path.join(name);
        let part = self.path.join(format!("{name}.part"));
        let write = || -> io::Result<()> {
            if let Some(parent) = path.parent() {
                std::fs::create_dir_all(parent)?;
            }
            let mut file = std::fs::File::create(&part)?;
            io::Write::write_all(&mut file, content)?;
            file.sync_all()?;
            std::fs::rename(&part, &path)
        };
        write().map_err(|source| {
            let _ = std::fs::remove_file(&part);
            OutputError::Write { path, source }
        })
    }

    /// Appends a line to the log.
    pub fn log(&self, line: &serde_json::Value) -> Result<(), OutputError> {
        let path = self.path.join(MARKER);
        let append = || -> io::Result<()> {
            let mut file = std::fs::OpenOptions::new().append(true).open(&path)?;
            io::Write::write_all(&mut file, format!("{line}\n").as_bytes())
        };
        append().map_err(|source| OutputError::Write { path: path.clone(), source })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_of_others_is_refused_and_one_of_ours_is_reused() {
        let root = tempfile::tempdir().unwrap();
        let path = root.path().join("out");
        let folder = Folder::create(&path).unwrap();
        folder.write("fields/a.vtu", b"x").unwrap();
        folder.log(&serde_json::json!({"event": "test"})).unwrap();
        Folder::create(&path).unwrap();
        assert!(!path.join("fields").exists());
        std::fs::write(path.join("thesis.tex"), "precious").unwrap();
        assert!(matches!(Folder::create(&path), Err(OutputError::Foreign { .. })));
        assert!(path.join("thesis.tex").exists());
        let other = root.path().join("other");
        std::fs::create_dir(&other).unwrap();
        std::fs::write(other.join("summary.json"), "{}").unwrap();
        assert!(Folder::create(&other).is_err());
    }

    /// Every write to /dev/full fails as on a full disk.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_is_told_and_leaves_the_earlier_file() {
        let root = tempfile::tempdir().unwrap();
        let folder = Folder::create(&root.path().join("out")).unwrap();
        folder.write("summary.json", b"earlier").unwrap();
        std::os::unix::fs::symlink("/dev/full", folder.path().join("summary.json.part")).unwrap();
        let error = folder.write("summary.json", b"later").unwrap_err();
        assert!(error.to_string().contains("summary.json") && error.to_string().contains("space"), "{error}");
        assert_eq!(std::fs::read(folder.path().join("summary.json")).unwrap(), b"earlier");
        assert!(!folder.path().join("summary.json.part").exists());
    }
}
