//! The result folder.

use super::atomic;
use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// The file by which a folder is known as one of ours.
pub const MARKER: &str = "log.jsonl";
const FIRST_LINE: &str = "{\"event\":\"signorini\"";
/// Everything a run writes.
const OWN: [&str; 22] = [
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
    "paths",
    "rigid",
    "rigid.pvd",
    "volume",
    "volume.pvd",
    "fit.csv",
    "report.html",
];

/// Results that could not be written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    #[error("cannot write `{path}`: {source}")]
    Write { path: PathBuf, source: io::Error },
    #[error("the folder `{path}` contains `{entry}`, which was not written by a run")]
    Foreign { path: PathBuf, entry: String },
    #[error("cannot draw a picture: {0}")]
    Picture(String),
}

/// The results of an earlier run, which a new one in their folder replaces.
#[derive(Clone, Debug, PartialEq)]
pub struct Earlier {
    /// Title or file of its case, where it is known.
    pub case: Option<String>,
    /// Date and time of the last of them, in UTC.
    pub written: String,
}

impl Earlier {
    /// Those in a folder; none where no run has written there.
    pub fn in_folder(path: &Path) -> Option<Self> {
        let text = std::fs::read_to_string(path.join(MARKER)).ok()?;
        if !text.starts_with(FIRST_LINE) {
            return None;
        }
        let time = |name: &str| std::fs::metadata(path.join(name)).and_then(|m| m.modified()).ok();
        let last = OWN.iter().filter_map(|name| time(name)).max()?;
        let summary = std::fs::read_to_string(path.join("summary.json")).ok();
        let summary = summary.and_then(|text| serde_json::from_str::<serde_json::Value>(&text).ok());
        let case = summary.and_then(|s| Some(format!("`{}`", s["case"].as_str()?)));
        let seconds = last.duration_since(std::time::UNIX_EPOCH).ok()?.as_secs();
        Some(Self { case, written: date(seconds) })
    }
}

/// Date and time in UTC from seconds since 1970 (days to civil date after Hinnant).
#[doc(hidden)]
pub fn date(seconds: u64) -> String {
    let days = seconds / 86400 + 719_468;
    let (era, day) = (days / 146_097, days % 146_097);
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let of_year = day - (365 * year + year / 4 - year / 100);
    // Months from March on.
    let month = (5 * of_year + 2) / 153;
    let day = of_year - (153 * month + 2) / 5 + 1;
    let (year, month) = if month < 10 { (year, month + 3) } else { (year + 1, month - 9) };
    let (hour, minute) = (seconds / 3600 % 24, seconds / 60 % 60);
    format!("{:04}-{month:02}-{day:02} at {hour:02}:{minute:02} UTC", year + 400 * era)
}

/// Files by their names within the folder of a run.
pub type Files = BTreeMap<String, Vec<u8>>;

/// A folder that belongs to one run; or nothing, where a program keeps the results in its memory.
#[derive(Clone, Debug, Default)]
pub struct Folder {
    path: Option<PathBuf>,
    /// Files that are kept in memory instead.
    memory: Option<Arc<Mutex<Files>>>,
}

impl Folder {
    /// A folder in memory. Only what is written whole is kept: history, pictures, tables.
    pub fn in_memory() -> Self {
        Self { path: None, memory: Some(Arc::default()) }
    }

    /// Whether anything that is written is kept.
    pub fn keeps(&self) -> bool {
        self.path.is_some() || self.memory.is_some()
    }

    /// Takes the files that were kept in memory.
    pub fn take_files(&self) -> Files {
        let lock =
            |memory: &Arc<Mutex<Files>>| std::mem::take(&mut *memory.lock().unwrap_or_else(PoisonError::into_inner));
        self.memory.as_ref().map(lock).unwrap_or_default()
    }

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
        let folder = Self { path: Some(path.to_path_buf()), memory: None };
        folder.write(MARKER, format!("{FIRST_LINE},\"version\":\"{}\"}}\n", env!("CARGO_PKG_VERSION")).as_bytes())?;
        Ok(folder)
    }

    /// The folder of an earlier run, as it is.
    pub fn of_earlier_run(path: &Path) -> Self {
        Self { path: Some(path.to_path_buf()), memory: None }
    }

    /// Removes a file or a folder of ours; what cannot be removed stays.
    pub fn remove(&self, name: &str) {
        let Some(path) = self.path.as_ref().map(|p| p.join(name)) else { return };
        let _ = if path.is_dir() { std::fs::remove_dir_all(path) } else { std::fs::remove_file(path) };
    }

    /// Its path; none of what is nowhere.
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// Writes a file whole, or not at all.
    pub fn write(&self, name: &str, content: &[u8]) -> Result<(), OutputError> {
        if let Some(memory) = &self.memory {
            let mut files = memory.lock().unwrap_or_else(PoisonError::into_inner);
            files.insert(name.to_string(), content.to_vec());
        }
        let Some(folder) = &self.path else { return Ok(()) };
        let path = folder.join(name);
        let parent = path.parent().map_or(Ok(()), std::fs::create_dir_all);
        let written = parent.and_then(|()| atomic::write(&path, content));
        written.map_err(|source| OutputError::Write { path, source })
    }

    /// Appends a line to the log.
    pub fn log(&self, line: &serde_json::Value) -> Result<(), OutputError> {
        let Some(path) = self.path.as_ref().map(|p| p.join(MARKER)) else { return Ok(()) };
        let append = || -> io::Result<()> {
            let mut file = std::fs::OpenOptions::new().append(true).open(&path)?;
            io::Write::write_all(&mut file, format!("{line}\n").as_bytes())
        };
        append().map_err(|source| OutputError::Write { path: path.clone(), source })
    }
}
