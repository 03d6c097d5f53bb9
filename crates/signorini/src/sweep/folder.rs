//! The folder of a sweep.

use super::record::Record;
use crate::output::{Folder, OutputError};
use crate::problem::CaseError;
use std::fs::{File, TryLockError};
use std::path::{Path, PathBuf};

/// The file by which a folder is known as that of a sweep.
pub const MANIFEST: &str = "sweep.json";
/// Everything a sweep writes.
const OWN: [&str; 8] = [MANIFEST, "sweep.csv", "sweep.png", "sweep.svg", "sweep.slurm", "sweep.lock", "case", "runs"];

/// A folder that belongs to one sweep.
#[derive(Clone, Debug)]
pub struct SweepFolder {
    path: PathBuf,
    files: Folder,
}

impl SweepFolder {
    /// A folder, as it is.
    pub fn new(path: &Path) -> Self {
        Self { path: path.to_path_buf(), files: Folder::of_earlier_run(path) }
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether a sweep was begun in it.
    pub fn is_begun(&self) -> bool {
        self.path.join(MANIFEST).is_file()
    }

    /// Creates the folder, where there is none.
    ///
    /// # Errors
    /// A folder that cannot be created, or that holds anything but a sweep.
    pub fn make(&self) -> Result<(), OutputError> {
        let fail = |source| OutputError::Write { path: self.path.clone(), source };
        std::fs::create_dir_all(&self.path).map_err(fail)?;
        for entry in std::fs::read_dir(&self.path).map_err(fail)? {
            let entry = entry.map_err(fail)?.file_name().to_string_lossy().into_owned();
            if !self.is_begun() && !["sweep.lock", "case"].contains(&entry.as_str()) && !entry.ends_with(".part") {
                return Err(OutputError::Foreign { path: self.path.clone(), entry });
            }
        }
        Ok(())
    }

    /// Removes an earlier sweep. What no sweep wrote stays.
    ///
    /// # Errors
    /// Files that cannot be removed.
    pub fn clear(&self) -> Result<(), OutputError> {
        if !self.is_begun() {
            return Ok(());
        }
        let kept = ["sweep.lock", MANIFEST];
        // The manifest last: until then the folder is that of a sweep.
        for name in OWN.iter().filter(|name| !kept.contains(name)).chain([&MANIFEST]) {
            let path = self.path.join(name);
            let removed = if path.is_dir() { std::fs::remove_dir_all(&path) } else { std::fs::remove_file(&path) };
            match removed {
                Err(source) if source.kind() != std::io::ErrorKind::NotFound => {
                    return Err(OutputError::Write { path, source });
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Writes a file whole, or not at all.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write(&self, name: &str, content: &[u8]) -> Result<(), OutputError> {
        self.files.write(name, content)
    }

    /// Removes a file; what cannot be removed stays.
    pub fn remove(&self, name: &str) {
        self.files.remove(name);
    }

    /// The name of a row, from 0: `0001` for the first.
    pub fn row_name(index: usize) -> String {
        format!("{:04}", index + 1)
    }

    /// The folder of the run of a row.
    pub fn run_folder(&self, index: usize) -> PathBuf {
        self.path.join("runs").join(Self::row_name(index))
    }

    /// Whether the run of a row has ended.
    pub fn has(&self, index: usize) -> bool {
        self.path.join(Self::record_name(index)).is_file()
    }

    fn record_name(index: usize) -> String {
        format!("runs/{}.json", Self::row_name(index))
    }

    /// Writes what came of a row.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write_record(&self, index: usize, record: &Record) -> Result<(), OutputError> {
        let text = serde_json::to_string_pretty(record).unwrap_or_default() + "\n";
        self.write(&Self::record_name(index), text.as_bytes())
    }

    /// What came of a row; none where its run has not ended.
    ///
    /// # Errors
    /// A record that is damaged.
    pub fn record(&self, index: usize) -> Result<Option<Record>, CaseError> {
        let file = self.path.join(Self::record_name(index));
        let Ok(text) = std::fs::read_to_string(&file) else { return Ok(None) };
        let damaged = |e: serde_json::Error| {
            CaseError::new(format!("`{}` is damaged: {e}", file.display())).help("remove it: its row is run again")
        };
        serde_json::from_str(&text).map(Some).map_err(damaged)
    }

    /// Holds the folder for one caller alone, or for one of many that run single rows. The system lets go of it when the
    /// program ends, however that ends.
    ///
    /// # Errors
    /// A folder that another program holds.
    pub fn lock(&self, alone: bool) -> Result<Option<File>, CaseError> {
        // Without a lock file, or on a file system without locks, nothing is held.
        let Ok(file) = File::create(self.path.join("sweep.lock")) else { return Ok(None) };
        match if alone { file.try_lock() } else { file.try_lock_shared() } {
            Ok(()) => Ok(Some(file)),
            Err(TryLockError::Error(_)) => Ok(None),
            Err(TryLockError::WouldBlock) => {
                let message = format!("another sweep is at work in `{}`", self.path.display());
                Err(CaseError::new(message).help("wait for its end, or choose another folder with -o DIR"))
            }
        }
    }
}
