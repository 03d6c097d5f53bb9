//! Where a problem was stated: what it is called in messages, and the text it was read from.

use super::KeyPath;
use super::error::Place;
use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

/// A text that states a problem.
pub trait Text: Send + Sync {
    /// The whole of it.
    fn text(&self) -> &str;

    /// Where the value of a key stands, or of the nearest table or list round it; `within` are bytes of the value as text.
    fn place(&self, key: &KeyPath, within: Option<(&str, Range<usize>)>) -> Place;

    /// Where a key stands beside others: the earlier, the less.
    fn order(&self, key: &KeyPath) -> usize;

    /// The line of the file, from one; none for what was set beside the file.
    fn line(&self, key: &KeyPath) -> Option<usize>;
}

/// Where a problem was stated; nowhere but in the program by default.
#[derive(Clone, Default)]
pub struct Source {
    /// What it is called in messages: the path of its file. Files that it names are found from the folder of that.
    pub name: String,
    pub text: Option<Arc<dyn Text>>,
    /// Contents of files that exist in memory only, by the names that the problem gives them. They replace files on disk.
    pub files: Arc<BTreeMap<String, Vec<u8>>>,
    /// Keys of earlier versions that were read: the line of the file, the earlier name and the present one.
    pub renamed: Vec<(usize, String, &'static str)>,
}

impl Source {
    /// The folder in which files are looked for.
    pub fn folder(&self) -> PathBuf {
        std::path::Path::new(&self.name).parent().map_or_else(PathBuf::new, Into::into)
    }

    /// The place of a key, where there is a text; of a part of an expression without one, the expression itself.
    pub fn place(&self, key: &KeyPath, within: Option<(&str, Range<usize>)>) -> Option<Place> {
        match (&self.text, within) {
            (Some(text), within) => Some(text.place(key, within)),
            (None, Some((value, span))) => Some(Place { name: key.to_string(), text: value.into(), span }),
            (None, None) => None,
        }
    }

    /// The content of a file that a problem names.
    ///
    /// # Errors
    /// A file that is not in memory and cannot be read.
    pub fn read(&self, name: &str) -> std::io::Result<Vec<u8>> {
        match self.files.get(name) {
            Some(bytes) => Ok(bytes.clone()),
            None => std::fs::read(self.folder().join(name)),
        }
    }

    /// The keys of earlier versions that were read, and what to do.
    pub fn renamed_keys(&self) -> Option<String> {
        let key = |(line, old, new): &(usize, String, &str)| format!("`{old}` is now `{new}` (line {line})");
        let keys: Vec<String> = self.renamed.iter().map(key).collect();
        let migrate = format!("`signorini migrate {}` rewrites the file", self.name);
        (!keys.is_empty()).then(|| format!("keys have new names: {}; {migrate}", keys.join(", ")))
    }

    pub fn line(&self, key: &KeyPath) -> Option<usize> {
        self.text.as_ref().and_then(|text| text.line(key))
    }
}

impl fmt::Debug for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Source").field("name", &self.name).finish_non_exhaustive()
    }
}
