//! Solids of STEP files (ISO 10303-21 with the shapes of AP203, AP214 and AP242): faces on planes, cylinders, cones, spheres,
//! tori, B-splines and swept surfaces, with edges on lines, conics and B-splines.
//!
//! Curves in the parameters of faces are not read: edges in space say the same, and the geometry finds them on the surfaces.

mod bspline;
mod curve;
mod exchange;
mod model;
mod places;
mod solid;
mod surface;
mod units;

use exchange::Instance;
use signorini_geometry::similarity::Similarity;
use signorini_geometry::trimmed::{SolidError, TrimmedSolid};
use std::collections::BTreeMap;

/// What cannot be read: where, what it is, and what helps.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}{message}", at(.line, .id))]
pub struct StepError {
    /// Counted from one.
    pub line: Option<usize>,
    /// The number of the instance.
    pub id: Option<u64>,
    pub message: String,
    pub help: String,
}

fn at(line: &Option<usize>, id: &Option<u64>) -> String {
    let line = line.map_or(String::new(), |l| format!("line {l}, "));
    id.map_or(line.clone(), |id| format!("{line}#{id}: "))
}

/// A STEP file.
#[derive(Debug)]
pub struct StepFile {
    instances: BTreeMap<u64, Instance>,
    solids: Vec<Listed>,
}

/// A solid of a file, with all places where it stands.
#[derive(Debug)]
struct Listed {
    id: u64,
    name: String,
    /// Of the representation: metres and radians of a unit, and the uncertainty in units of length.
    units: units::FileUnits,
    places: Vec<Similarity>,
}

/// Which solids of a file are wanted.
#[derive(Clone, Debug, PartialEq)]
pub enum Pick {
    All,
    Name(String),
    /// Counted from one.
    Number(usize),
}

const AS_SOLID: &str = "export the body as a solid (AP203, AP214 or AP242) from the CAD program";

impl StepFile {
    /// # Errors
    /// A text that is no STEP file, and one without solids.
    pub fn new(bytes: &[u8]) -> Result<Self, StepError> {
        let head = bytes.get(..80).unwrap_or(bytes);
        // The first card of IGES has an S in column 73.
        if head.get(72) == Some(&b'S') && head.is_ascii() && !head.starts_with(b"ISO-10303-21") {
            let message = "this is an IGES file, which is not read".to_string();
            let help = "save it as STEP in a CAD program, such as FreeCAD or gmsh".to_string();
            return Err(StepError { line: None, id: None, message, help });
        }
        let instances = exchange::read(bytes).map_err(|(line, message)| StepError {
            line: Some(line),
            id: None,
            message,
            help: "export the file again as STEP (ISO 10303-21, not XML, not compressed)".into(),
        })?;
        let mut file = StepFile { instances, solids: Vec::new() };
        file.solids = file.list_solids()?;
        if file.solids.is_empty() {
            return Err(StepError {
                line: None,
                id: None,
                message: "the file has no solid".into(),
                help: AS_SOLID.into(),
            });
        }
        Ok(file)
    }

    /// The names of the solids.
    pub fn names(&self) -> Vec<&str> {
        self.solids.iter().map(|s| s.name.as_str()).collect()
    }

    /// Metres of the unit of length.
    pub fn metres(&self) -> f64 {
        self.solids[0].units.metres
    }

    /// The solids that are wanted, each with its name: lengths are those of the file, turned and moved by `placement`.
    ///
    /// # Errors
    /// A name or number that no solid has, entities that are not read, surfaces with gaps.
    pub fn solids(&self, pick: &Pick, placement: &Similarity) -> Result<Vec<(String, TrimmedSolid)>, StepError> {
        let picked: Vec<&Listed> = match pick {
            Pick::All => self.solids.iter().collect(),
            Pick::Name(name) => self.solids.iter().filter(|s| s.name == *name).collect(),
            Pick::Number(n) => self.solids.iter().skip(n.wrapping_sub(1)).take(1).collect(),
        };
        if picked.is_empty() {
            let what = match pick {
                Pick::Name(name) => format!("no solid has the name `{name}`"),
                Pick::Number(n) => format!("there is no solid number {n}"),
                Pick::All => "the file has no solid".into(),
            };
            let list: Vec<String> =
                self.solids.iter().enumerate().map(|(k, s)| format!("{}: `{}`", k + 1, s.name)).collect();
            let help = format!("the solids of the file are {}", list.join(", "));
            return Err(StepError { line: None, id: None, message: what, help });
        }
        let mut out = Vec::new();
        for listed in picked {
            for place in &listed.places {
                // Of files with several units, those of the first solid count.
                let unit = listed.units.metres / self.metres();
                let own = Similarity {
                    factor: placement.factor * unit,
                    rotation: placement.rotation * place.rotation,
                    translation: placement.point(&(place.translation * unit)),
                };
                let (data, ids) = self.solid_data(listed, own)?;
                let solid = TrimmedSolid::new(data).map_err(|error| self.refused(listed.id, &ids, error))?;
                out.push((listed.name.clone(), solid));
            }
        }
        Ok(out)
    }

    fn refused(&self, solid: u64, ids: &solid::Ids, error: SolidError) -> StepError {
        let face = error.face.and_then(|k| ids.faces.get(k));
        let edge = error.edge.and_then(|k| ids.edges.get(k));
        let id = *edge.or(face).unwrap_or(&solid);
        let of = match (face, edge) {
            (Some(face), Some(_)) => format!(" (of face #{face})"),
            _ => String::new(),
        };
        self.error(id, format!("{error}{of}"), error.help())
    }

    /// An error at an instance.
    fn error(&self, id: u64, message: impl Into<String>, help: impl Into<String>) -> StepError {
        let line = self.instances.get(&id).map(|i| i.line);
        let name = self.instances.get(&id).map(|i| i.records[0].name.clone()).unwrap_or_default();
        let message = match &name[..] {
            "" => message.into(),
            name => format!("{name}: {}", message.into()),
        };
        StepError { line, id: Some(id), message, help: help.into() }
    }

    /// An entity that is not read.
    fn unknown(&self, id: u64, what: &str, valid: &str) -> StepError {
        let message = format!("this {what} is not read; those that are: {valid}");
        self.error(id, message, "let the CAD program convert it to B-splines, or export the body another way")
    }
}
