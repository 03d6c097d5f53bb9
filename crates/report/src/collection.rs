//! Which files show which times: the collections (PVD) of a folder, and files that hold at all times.

use std::path::{Path, PathBuf};

/// What a file shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Role {
    /// All deformable bodies of a state.
    Bodies,
    /// The surface of a contact that is tested, or the outlines of the zones of a membrane.
    Contact,
    /// A rigid body.
    Rigid,
    /// The closest pairs of a scene.
    Pairs,
    /// A rope or a yarn.
    Path,
}

/// The files of one thing, by time.
#[derive(Clone, Debug)]
pub struct Source {
    pub role: Role,
    pub name: String,
    /// Without a time, the file holds at all times.
    pub files: Vec<(Option<f64>, PathBuf)>,
}

/// The collections of a folder, and what their files show.
const COLLECTIONS: [(&str, Role); 5] = [
    ("fields.pvd", Role::Bodies),
    ("bodies.pvd", Role::Bodies),
    ("rigid.pvd", Role::Rigid),
    ("contact.pvd", Role::Contact),
    ("pairs.pvd", Role::Pairs),
];

/// All that can be drawn of a folder.
pub fn sources(folder: &Path) -> Vec<Source> {
    let mut out = Vec::new();
    for (file, role) in COLLECTIONS {
        add(folder, &folder.join(file), role, &mut out);
    }
    let paths = folder.join("paths");
    let mut entries: Vec<PathBuf> =
        std::fs::read_dir(&paths).into_iter().flatten().filter_map(|e| Some(e.ok()?.path())).collect();
    entries.sort();
    for entry in entries {
        match entry.extension().and_then(|e| e.to_str()) {
            Some("pvd") => add(&paths, &entry, Role::Path, &mut out),
            Some("vtp") => {
                let name = entry.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
                out.push(Source { role: Role::Path, name, files: vec![(None, entry)] });
            }
            _ => {}
        }
    }
    out
}

/// The times of all files, in order; one where none has any.
pub fn times(sources: &[Source]) -> Vec<f64> {
    let mut times: Vec<f64> = sources.iter().flat_map(|s| &s.files).filter_map(|f| f.0).collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    if times.is_empty() && !sources.is_empty() { vec![0.0] } else { times }
}

impl Source {
    /// The file of a time.
    pub fn at(&self, time: f64) -> Option<&Path> {
        let found = self.files.iter().rev().find(|(t, _)| t.is_none_or(|t| t == time));
        found.map(|(_, path)| path.as_path())
    }
}

/// Adds the files of a collection, those of one name together.
fn add(folder: &Path, collection: &Path, role: Role, out: &mut Vec<Source>) {
    let first = out.len();
    add_files(folder, collection, role, out);
    // Rigid bodies that rest are stored once.
    let is_at_rest = |source: &Source| source.files.len() == 1 && collection.ends_with("bodies.pvd");
    for source in out[first..].iter_mut().filter(|s| is_at_rest(s)) {
        source.files[0].0 = None;
    }
}

fn add_files(folder: &Path, collection: &Path, role: Role, out: &mut Vec<Source>) {
    let Ok(text) = std::fs::read_to_string(collection) else { return };
    for entry in text.split("<DataSet ").skip(1) {
        let (Some(time), Some(file)) = (attribute(entry, "timestep"), attribute(entry, "file")) else { continue };
        let (Ok(time), path) = (time.parse::<f64>(), folder.join(file)) else { continue };
        // Nothing outside the folder is read.
        if !time.is_finite() || file.contains("..") || Path::new(file).is_absolute() || !path.is_file() {
            continue;
        }
        let name = name(&path);
        match out.iter_mut().find(|s| s.role == role && s.name == name) {
            Some(source) => source.files.push((Some(time), path)),
            None => out.push(Source { role, name, files: vec![(Some(time), path)] }),
        }
    }
}

fn attribute<'a>(entry: &'a str, name: &str) -> Option<&'a str> {
    let (_, rest) = entry.split_once(&format!("{name}=\""))?;
    Some(rest.split_once('"')?.0)
}

/// The name of a file without the number of its state.
fn name(path: &Path) -> String {
    let stem = path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    match stem.rsplit_once('_') {
        Some((name, number)) if number == "start" || number.bytes().all(|b| b.is_ascii_digit()) => name.to_string(),
        _ => stem,
    }
}
