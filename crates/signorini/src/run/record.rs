//! What a run has found so far, and where it writes it.

use crate::fields::ShownState;
use crate::output::{Folder, OutputError, vtk};
use crate::plan::Head;
use crate::plan::reader::Interpreted;
use crate::report::{ContactEvent, ContactReport, Event, Pose, Probe, Reason, StepReport, UnitNames, Warning};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// The number of the fields at t = 0 in the names of their files.
pub const START: &str = "start";

/// The results of a run that are the same for all models.
pub struct Record {
    pub folder: Folder,
    /// The title of the case, or the name of its file.
    pub case: String,
    /// The text of the case.
    pub text: String,
    pub units: Option<UnitNames>,
    pub interpreted: Vec<Interpreted>,
    /// Increments from one file of fields to the next.
    pub every: usize,
    /// Whether pictures are wanted.
    pub pictures: bool,
    pub steps: Vec<StepReport>,
    pub warnings: Vec<Warning>,
    pub events: Vec<Event>,
    pub contact_events: Vec<ContactEvent>,
    /// Times and numbers of the files of fields.
    pub frames: Vec<(f64, String)>,
    /// The most unknowns solved for.
    pub unknowns: usize,
    /// Time that the checks of states took.
    pub audit_seconds: f64,
    /// Whether states are kept in memory.
    pub keeps_states: bool,
    /// The states that are kept in memory.
    pub states: Vec<ShownState>,
}

impl Record {
    /// An empty record.
    pub fn new(head: &Head, folder: Folder) -> Self {
        let problem = &head.problem;
        Self {
            folder,
            case: problem.name().to_string(),
            text: crate::case::text(problem),
            units: head.unit_names(),
            interpreted: head.interpreted.to_vec(),
            every: head.every,
            pictures: head.pictures,
            steps: Vec::new(),
            warnings: head.warnings.to_vec(),
            events: Vec::new(),
            contact_events: Vec::new(),
            frames: Vec::new(),
            unknowns: 0,
            audit_seconds: 0.0,
            keeps_states: false,
            states: Vec::new(),
        }
    }

    /// Adds a warning; what is said of many increments is said once, of the first.
    pub fn warn_once(&mut self, warning: Warning) {
        if !self.warnings.iter().any(|w| w.kind == warning.kind) {
            self.warnings.push(warning);
        }
    }

    /// Enters files of fields, `fields/fields_N.vtu` and for each contact `contact/NAME_N.vtp`, into their collections.
    ///
    /// # Errors
    /// Collections that cannot be written.
    pub fn add_frame(&mut self, time: f64, number: String, contacts: &[&str]) -> Result<(), OutputError> {
        self.frames.push((time, number));
        let fields: Vec<_> = self.frames.iter().map(|(t, n)| (*t, format!("fields/fields_{n}.vtu"))).collect();
        let of_frame =
            |(t, n): &(f64, String)| contacts.iter().map(|c| (*t, format!("contact/{c}_{n}.vtp"))).collect::<Vec<_>>();
        let surfaces: Vec<_> = self.frames.iter().filter(|f| f.1 != START).flat_map(of_frame).collect();
        self.folder.write("fields.pvd", vtk::collection(&fields).as_bytes())?;
        self.folder.write("contact.pvd", vtk::collection(&surfaces).as_bytes())
    }

    /// Enters files of bodies of all frames, `FOLDER/NAME_N.ENDING`, such as `rigid/NAME_N.vtp`, into their collection.
    ///
    /// # Errors
    /// A collection that cannot be written.
    pub fn add_bodies(&self, folder: &str, names: &[String], ending: &str) -> Result<(), OutputError> {
        if names.is_empty() {
            return Ok(());
        }
        let of_frame = |(t, n): &(f64, String)| {
            names.iter().map(|b| (*t, format!("{folder}/{b}_{n}.{ending}"))).collect::<Vec<_>>()
        };
        let files: Vec<_> = self.frames.iter().flat_map(of_frame).collect();
        self.folder.write(&format!("{folder}.pvd"), vtk::collection(&files).as_bytes())
    }

    /// The states of the history, from the one at t = 0 on where that is one of rest.
    pub fn history(&self, begins_at_rest: bool) -> Cow<'_, [StepReport]> {
        match self.steps.first() {
            Some(first) if begins_at_rest => {
                Cow::Owned(std::iter::once(at_rest(first)).chain(self.steps.clone()).collect())
            }
            _ => Cow::Borrowed(&self.steps),
        }
    }

    /// Number of increments that were solved.
    pub fn done(&self) -> usize {
        self.steps.iter().filter(|s| s.converged).count()
    }
}

/// The state at t = 0, where nothing has happened yet, of what a later one tells.
fn at_rest(later: &StepReport) -> StepReport {
    let probe = |p: &Option<Probe>| {
        p.as_ref().map(|p| Probe {
            at: p.at,
            displacement: [0.0; 3],
            in_contact: p.in_contact.map(|_| false),
            pressure: p.pressure.map(|_| 0.0),
            von_mises: p.von_mises.map(|_| 0.0),
            temperature: None,
        })
    };
    let open = |c: &ContactReport| ContactReport {
        carries: c.carries,
        moment: c.moment.map(|_| [0.0; 3]),
        ..ContactReport::default()
    };
    let none = |of: &BTreeMap<String, [f64; 3]>| of.keys().map(|name| (name.clone(), [0.0; 3])).collect();
    StepReport {
        converged: true,
        reason: Reason::Converged,
        energy: later.energy.map(|_| 0.0),
        contacts: later.contacts.iter().map(|(name, c)| (name.clone(), open(c))).collect(),
        support_forces: none(&later.support_forces),
        load_forces: none(&later.load_forces),
        moments_about: later.moments_about,
        support_moments: none(&later.support_moments),
        load_moments: none(&later.load_moments),
        free_bodies: later.free_bodies.keys().map(|name| (name.clone(), Pose::default())).collect(),
        probes: later.probes.iter().map(|(name, p)| (name.clone(), probe(p))).collect(),
        ..StepReport::default()
    }
}

/// The folder of a run that begins, with the text of its case.
///
/// # Errors
/// A folder that cannot be made or holds what no run has written.
pub fn begin(head: &Head, path: &std::path::Path) -> Result<Record, OutputError> {
    let record = Record::new(head, Folder::create(path)?);
    record.folder.write("case.toml", record.text.as_bytes())?;
    Ok(record)
}

/// The record of a run whose results stay in memory.
pub fn in_memory(head: &Head) -> Record {
    Record { keeps_states: true, ..Record::new(head, Folder::default()) }
}

/// The record of a run that goes on in a folder.
pub fn of_earlier_run(head: &Head, path: &std::path::Path) -> Record {
    Record::new(head, Folder::of_earlier_run(path))
}
