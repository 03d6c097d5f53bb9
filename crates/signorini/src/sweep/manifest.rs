//! What a sweep is to do: `sweep.json`, written before the first run.

use super::SweepError;
use super::design::{Sample, rows};
use super::folder::{MANIFEST, SweepFolder};
use super::vary::{Setting, Variation};
use crate::output::OutputError;
use crate::problem::CaseError;
use crate::run::environment::fnv1a;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use serde_json::json;
use std::path::PathBuf;

/// Version of the keys of the manifest.
const SCHEMA: u32 = 1;

/// What stays of each run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Keep {
    /// Everything that a run writes.
    #[default]
    All,
    /// `summary.json` only.
    Summary,
}

/// A sweep as a user asks for it.
#[derive(Clone, Debug, Default)]
pub struct Wanted {
    /// What the case file is called in messages; files that it names are looked for beside it.
    pub name: String,
    /// The text of the case.
    pub text: String,
    /// Settings of all runs.
    pub set: Vec<String>,
    pub vary: Vec<Variation>,
    pub sample: Option<Sample>,
    pub keep: Keep,
    /// What is collected from the summaries; if empty, the main numbers.
    pub collect: Vec<String>,
}

/// What a sweep is to do.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// Version of the keys of the manifest.
    pub schema: u32,
    /// Version of the program.
    pub version: String,
    /// Hash of all that decides the results: version, case, settings, variations.
    pub hash: String,
    /// Path of the case file.
    pub case: PathBuf,
    /// Its text when the sweep was begun. Later changes of the file change nothing.
    pub text: String,
    /// Settings of all runs.
    pub set: Vec<String>,
    pub vary: Vec<Variation>,
    pub sample: Option<Sample>,
    pub keep: Keep,
    /// What is collected from the summaries; if empty, the main numbers.
    pub collect: Vec<String>,
    /// The values of the varied keys, a row for each run.
    pub rows: Vec<Vec<Setting>>,
}

impl Manifest {
    /// The manifest of a sweep.
    ///
    /// # Errors
    /// Variations that cannot be combined; a value that the case cannot have at its key.
    pub fn new(wanted: &Wanted) -> Result<Self, CaseError> {
        let Wanted { name, text, set, vary, sample, keep, collect } = wanted;
        super::collect::check(collect)?;
        if crate::scene::is_scene(text) {
            return Err(CaseError::new("a scene has no numbers to collect")
                .help("a sweep runs cases with an equilibrium or paths"));
        }
        // A case that is wrong by itself is told as such.
        crate::case::read(name, text, set)?;
        let rows = rows(vary, *sample)?;
        let version = env!("CARGO_PKG_VERSION").to_string();
        let decides = json!([SCHEMA, version, text, set, vary, sample]).to_string();
        let made = Self {
            schema: SCHEMA,
            version,
            hash: format!("{:016x}", fnv1a(decides.as_bytes())),
            case: std::path::absolute(name).unwrap_or_else(|_| name.into()),
            text: text.clone(),
            set: set.clone(),
            vary: vary.clone(),
            sample: *sample,
            keep: *keep,
            collect: collect.clone(),
            rows,
        };
        (0..made.rows.len()).into_par_iter().try_for_each(|k| made.checked(name, k))?;
        Ok(made)
    }

    /// The settings of a row, after those of all runs.
    pub fn settings(&self, index: usize) -> Vec<String> {
        self.set.iter().cloned().chain(self.varied(index)).collect()
    }

    fn varied(&self, index: usize) -> impl Iterator<Item = String> + '_ {
        let setting =
            |(variation, v): (&Variation, &Setting)| format!("{}={}", variation.key, v.written(&variation.unit));
        self.vary.iter().zip(&self.rows[index]).map(setting)
    }

    /// Whether the case can be read with the values of a row.
    fn checked(&self, name: &str, index: usize) -> Result<(), CaseError> {
        let varied: Vec<String> = self.varied(index).collect();
        let Err(mut error) = crate::case::read(name, &self.text, &self.settings(index)) else { return Ok(()) };
        if let Some(place) = error.place.as_mut().filter(|p| p.name == "--set" && varied.contains(&p.text)) {
            place.name = "--vary".into();
        }
        if let Some(setting) = varied.iter().find(|v| error.message.starts_with(&format!("`--set {v}`"))) {
            error.message = error.message.replacen(&format!("--set {setting}"), &format!("--vary {setting}"), 1);
        }
        Err(error.or_help("signorini explain KEY  tells what belongs there"))
    }

    /// The manifest of a folder.
    ///
    /// # Errors
    /// A folder without one, or with one that is damaged or of another version of the program.
    pub fn read(folder: &SweepFolder) -> Result<Self, CaseError> {
        let file = folder.path().join(MANIFEST);
        let text = std::fs::read_to_string(&file).map_err(|e| {
            CaseError::new(format!("there is no sweep: cannot read `{}`: {e}", file.display()))
                .help("begin one with  signorini sweep CASE --vary KEY=FROM:TO:COUNT")
        })?;
        let again = "begin it anew with --restart";
        let damaged =
            |e: serde_json::Error| CaseError::new(format!("`{}` is damaged: {e}", file.display())).help(again);
        let made: Self = serde_json::from_str(&text).map_err(damaged)?;
        if made.version != env!("CARGO_PKG_VERSION") {
            let message = format!("`{}` was begun by version {} of this program", file.display(), made.version);
            return Err(CaseError::new(message).help(again));
        }
        Ok(made)
    }

    /// Enters a sweep into its folder, or goes on with it there. Returns it as it stands there, and whether it was there
    /// before.
    ///
    /// # Errors
    /// Another sweep in the folder, or anything else; files that cannot be written.
    pub fn enter(self, folder: &SweepFolder, restart: bool) -> Result<(Self, bool), SweepError> {
        if restart {
            folder.clear()?;
        }
        if !folder.is_begun() {
            folder.make()?;
            self.write(folder)?;
            return Ok((self, false));
        }
        let mut earlier = Self::read(folder)?;
        if earlier.hash != self.hash || earlier.keep != self.keep {
            return Err(self.differs(&earlier, folder).into());
        }
        earlier.collects(&self.collect, folder)?;
        Ok((earlier, true))
    }

    /// Collects something else from the summaries, from now on; nothing changes where that is empty.
    ///
    /// # Errors
    /// A path that no summary has, a file that cannot be written.
    pub fn collects(&mut self, collect: &[String], folder: &SweepFolder) -> Result<(), SweepError> {
        super::collect::check(collect)?;
        if !collect.is_empty() && self.collect != collect {
            self.collect = collect.to_vec();
            self.write(folder)?;
        }
        Ok(())
    }

    fn write(&self, folder: &SweepFolder) -> Result<(), OutputError> {
        let text = serde_json::to_string_pretty(self).unwrap_or_default() + "\n";
        folder.write(MANIFEST, text.as_bytes())
    }

    /// Why this is not the sweep in a folder.
    fn differs(&self, earlier: &Self, folder: &SweepFolder) -> CaseError {
        let what = match earlier {
            e if e.text != self.text => "another case, or this one before it was changed",
            e if e.vary != self.vary || e.sample != self.sample => "other variations",
            e if e.set != self.set => "other settings",
            _ => "another choice of --keep",
        };
        CaseError::new(format!("`{}` holds a sweep of {what}", folder.path().display()))
            .help("choose another folder with -o DIR, or begin anew with --restart, which removes its results")
    }

    /// Rows whose runs have not ended.
    pub fn missing(&self, folder: &SweepFolder) -> Vec<usize> {
        (0..self.rows.len()).filter(|k| !folder.has(*k)).collect()
    }
}
