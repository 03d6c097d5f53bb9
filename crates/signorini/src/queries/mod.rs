//! Closest points as a service: a file of queries or of points in, a file of answers out.
//!
//! Queries are read as a stream and answered in parallel; answers keep the order of the queries. A query that is wrong
//! gets an answer that says so and stops no other.

pub mod answer;
mod answered;
mod fields;
pub mod geometry;
mod implicit;
mod object;
mod output;
pub(crate) mod points;
mod query;
pub mod scanner;
pub(crate) mod shapes;

use std::collections::HashSet;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::mesh_file;

use answered::Answered;
pub use fields::FieldError;
use object::Object;
use output::Output;
pub use query::{PairQuery, QueriesError};
use rayon::prelude::*;
use scanner::{RawCase, Scanner};
use serde_json::Value;
use shapes::Shapes;
pub use signorini_geometry::closest::Query;
use signorini_geometry::closest::{Certificate, closest};
use signorini_geometry::shape::Shape;
use signorini_geometry::similarity::Similarity;
use signorini_geometry::trimmed::TrimmedSolid;
use signorini_import::step::{Pick, StepError, StepFile};

/// What was done with a file of queries.
#[derive(Clone, Debug, Default)]
pub struct Report {
    pub answered: usize,
    /// The first wrong cases, each with its name and what is wrong.
    pub wrong: Vec<String>,
    pub wrong_count: usize,
    pub not_unique: usize,
    /// Answers for which the search reached its cap of effort before the proof was complete.
    pub not_certified: usize,
    pub elapsed: Duration,
    /// The query that took longest.
    pub slowest: Option<(String, Duration)>,
}

/// Keys of a case that only comment on it.
const ANNOTATIONS: [&str; 5] = ["class", "flags", "expected", "tol", "certificate"];
/// How many wrong cases a report quotes.
const QUOTED: usize = 20;
/// Cases answered between two writes.
const BATCH: usize = 512;

/// One entry of `cases`, before its shapes are built.
struct Case<'a> {
    id: String,
    a: &'a str,
    b: &'a str,
    pair: Option<&'a str>,
}

impl<'a> Case<'a> {
    fn parse(text: &'a [u8]) -> Result<Self, FieldError> {
        let fail = |path: &str, message: String| FieldError { path: path.into(), message };
        let object = Object::parse(text).map_err(|e| e.within("case"))?;
        let (mut id, mut a, mut b, mut pair) = (None, None, None, None);
        for (key, value) in &object.entries {
            let value = value.get();
            match key.as_str() {
                "id" => {
                    let text = serde_json::from_str::<String>(value);
                    id = Some(text.map_err(|_| fail("id", format!("{value} instead of a string")))?);
                }
                "a" => a = Some(value),
                "b" => b = Some(value),
                "pair" => pair = Some(value),
                "scale" if serde_json::from_str::<f64>(value).is_ok_and(|s| s >= 0.0) => {}
                "scale" => return Err(fail("scale", format!("{value} is not a length"))),
                key if ANNOTATIONS.contains(&key) => {}
                key => return Err(fail(key, "unknown key; valid are a, b, id, pair, scale".into())),
            }
        }
        let missing = |key: &str| fail(key, "missing".into());
        let id = id.ok_or_else(|| missing("id"))?;
        Ok(Case { id, a: a.ok_or_else(|| missing("a"))?, b: b.ok_or_else(|| missing("b"))?, pair })
    }

    fn query(&self, shapes: &Shapes) -> Result<PairQuery, FieldError> {
        let a = shapes.partner(self.a).map_err(|e| e.within("a"))?;
        let b = shapes.partner(self.b).map_err(|e| e.within("b"))?;
        if let Some(pair) = self.pair {
            let name = |s: &Shape| ["point", "curve", "surface"][s.dimension()];
            let found = format!("\"{}-{}\"", name(&a), name(&b));
            if pair != found {
                let message = format!("{pair}, but the shapes are a {}", found.trim_matches('"'));
                return Err(FieldError { path: "pair".into(), message });
            }
        }
        Ok(PairQuery { a, b })
    }
}

/// Reads one case; files that it names are looked for in `folder`.
///
/// # Errors
/// What is wrong, with the path of the field.
pub fn parse(text: &[u8], folder: &Path) -> Result<PairQuery, FieldError> {
    Case::parse(text)?.query(&Shapes::new(folder))
}

/// Builds a shape from JSON, written like a partner of a query; files that it names are looked for in `folder`.
///
/// # Errors
/// What is wrong, with the path of the field.
pub fn shape(text: &str, folder: &Path) -> Result<Shape, FieldError> {
    shapes::build(text, folder)
}

/// A finite name for a case that has none.
fn name_of(case: &RawCase) -> String {
    serde_json::from_slice::<Value>(&case.text)
        .ok()
        .and_then(|v| v.get("id").and_then(Value::as_str).map(str::to_string))
        .or_else(|| quoted_id(&String::from_utf8_lossy(&case.text)))
        .unwrap_or_else(|| format!("line {}", case.line))
}

/// The id of a case that is not JSON as a whole.
fn quoted_id(text: &str) -> Option<String> {
    let rest = text.split_once("\"id\"")?.1.trim_start().strip_prefix(':')?.trim_start().strip_prefix('"')?;
    Some(rest.split_once('"')?.0.to_string())
}

/// The bytes of a file; - is standard input.
fn read_bytes(path: &Path) -> Result<Vec<u8>, QueriesError> {
    let open = |source| QueriesError::Open { path: path.to_path_buf(), source };
    let mut bytes = Vec::new();
    open_file(path)?.read_to_end(&mut bytes).map_err(open)?;
    Ok(bytes)
}

fn open_file(path: &Path) -> Result<Box<dyn BufRead>, QueriesError> {
    let open = |source| QueriesError::Open { path: path.to_path_buf(), source };
    if path == Path::new("-") {
        return Ok(Box::new(io::stdin().lock()));
    }
    if path.is_dir() {
        return Err(open(io::Error::other("a folder, not a file")));
    }
    Ok(Box::new(BufReader::with_capacity(1 << 20, std::fs::File::open(path).map_err(open)?)))
}

/// Answers a file of queries; `progress` is told the number answered so far and returns whether to go on. The name of
/// the file of answers tells their format: CSV, NPY, else JSON.
///
/// # Errors
/// Files that cannot be read or written, shapes that are wrong, and input that is not a file of queries. The answers up
/// to there are written.
pub fn answer_file(
    queries: &Path,
    answers: &Path,
    query: &Query,
    progress: &mut dyn FnMut(usize) -> bool,
) -> Result<Report, QueriesError> {
    let folder = queries.parent().unwrap_or(Path::new(""));
    let mut scanner = Scanner::new(open_file(queries)?);
    let mut shapes = Shapes::new(folder);
    let mut out = Output::create(answers)?;
    let start = Instant::now();
    let mut report = Report::default();
    let mut names = HashSet::new();
    let mut stopped = None;
    loop {
        let mut batch = Vec::with_capacity(BATCH);
        while batch.len() < BATCH {
            match scanner.next_case() {
                Ok(Some(case)) => batch.push(case),
                Ok(None) => break,
                Err(error) => {
                    stopped = Some(error);
                    break;
                }
            }
        }
        if let Some(RawCase { line, text }) = scanner.take_shapes() {
            let wrong = |source| QueriesError::Shapes { path: queries.to_path_buf(), line, source };
            if let Err(error) = shapes.name(&text) {
                out.discard();
                return Err(wrong(error));
            }
        }
        let last = batch.len() < BATCH;
        let mut cases: Vec<_> = batch.par_iter().map(|raw| Case::parse(&raw.text)).collect();
        let mut ids = Vec::with_capacity(batch.len());
        for (case, raw) in cases.iter_mut().zip(&batch) {
            let mut id = case.as_ref().map_or_else(|_| name_of(raw), |c| c.id.clone());
            if !names.insert(id.clone()) {
                *case = Err(FieldError { path: "id".into(), message: "given twice".into() });
                id = format!("{id} (line {})", raw.line);
                names.insert(id.clone());
            }
            ids.push(id);
        }
        shapes.prepare(cases.iter().flatten().flat_map(|c| [c.a, c.b]));
        let answered = (batch.par_iter().zip(&cases).zip(ids).enumerate()).map(|(k, ((raw, case), id))| {
            let start = Instant::now();
            let first = report.answered + k == 0;
            let pair = case.as_ref().map_err(Clone::clone).and_then(|c| c.query(&shapes));
            let result = pair.map(|pair| {
                let projection = closest(&pair.a, &pair.b, query);
                (pair, projection)
            });
            let answered = Answered::new(id, raw.line, first, out.format(), result);
            Answered { time: start.elapsed(), ..answered }
        });
        let answered: Vec<Answered> = answered.collect();
        out.write(&answered)?;
        answered.iter().for_each(|a| report.note(a));
        if !progress(report.answered) || last {
            break;
        }
    }
    out.finish()?;
    report.elapsed = start.elapsed();
    match stopped {
        Some(source) => Err(QueriesError::Scan { path: queries.to_path_buf(), source, answered: report.answered }),
        None => Ok(report),
    }
}

/// Answers for each point of a file where the shape of another file comes closest to it, like [`answer_file`]; the
/// answers are called after the rows, counted from zero. The shape is a triangle mesh (STL, OBJ, PLY), the solid of a STEP file
/// or, in JSON, a partner of a query.
///
/// # Errors
/// Files that cannot be read or written, points or a shape that are wrong; then nothing is written.
pub fn answer_points(
    points: &Path,
    shape: &Path,
    answers: &Path,
    query: &Query,
    progress: &mut dyn FnMut(usize) -> bool,
) -> Result<Report, QueriesError> {
    let wrong = |path: &Path, message: String| QueriesError::Input { path: path.to_path_buf(), message };
    let start = Instant::now();
    let b = Arc::new(read_shape(shape)?);
    let points = points::read(&read_bytes(points)?).map_err(|e| wrong(points, e))?;
    let mut out = Output::create(answers)?;
    let mut report = Report::default();
    for batch in points.chunks(BATCH) {
        let answered = batch.par_iter().enumerate().map(|(k, p)| {
            let start = Instant::now();
            let row = report.answered + k;
            let pair = PairQuery { a: Arc::new(Shape::Point(*p)), b: b.clone() };
            let projection = closest(&pair.a, &pair.b, query);
            let answered = Answered::new(row.to_string(), row, row == 0, out.format(), Ok((pair, projection)));
            Answered { time: start.elapsed(), ..answered }
        });
        let answered: Vec<Answered> = answered.collect();
        out.write(&answered)?;
        answered.iter().for_each(|a| report.note(a));
        if !progress(report.answered) {
            break;
        }
    }
    out.finish()?;
    report.elapsed = start.elapsed();
    Ok(report)
}

/// The one solid of a STEP file, or that with a number, counted from 1.
fn step_solid(bytes: &[u8], number: Option<usize>) -> Result<TrimmedSolid, String> {
    let told = |e: StepError| format!("{e}; {}", e.help);
    let file = StepFile::new(bytes).map_err(told)?;
    let pick = number.map_or(Pick::All, Pick::Number);
    let mut found = file.solids(&pick, &Similarity::scaling(1.0)).map_err(told)?;
    match found.len() {
        1 => Ok(found.remove(0).1),
        n => Err(format!(
            "{n} solids; a query has one: choose it in JSON by its number, {{\"type\": \"step\", \"file\": \"…\", \"solid\": 1}}"
        )),
    }
}

fn read_shape(path: &Path) -> Result<Shape, QueriesError> {
    let wrong = |message: String| QueriesError::Input { path: path.to_path_buf(), message };
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    match extension.as_str() {
        "stl" | "obj" | "ply" => mesh_file::read(path).map(Shape::from).map_err(|e| wrong(e.message)),
        "step" | "stp" => step_solid(&read_bytes(path)?, None).map(Shape::from).map_err(wrong),
        "json" => {
            let text = String::from_utf8(read_bytes(path)?).map_err(|e| wrong(format!("no text: {e}")))?;
            shapes::build(&text, path.parent().unwrap_or(Path::new(""))).map_err(|e| wrong(e.to_string()))
        }
        other => Err(wrong(format!("`{other}` is not a format of shapes; valid are json, stl, obj, ply and step"))),
    }
}

impl Report {
    fn note(&mut self, answered: &Answered) {
        self.answered += 1;
        match &answered.found {
            Ok((uniqueness, certificate)) => {
                self.not_unique += usize::from(!uniqueness.is_unique());
                self.not_certified += usize::from(*certificate == Certificate::Stopped);
            }
            Err(error) => {
                self.wrong_count += 1;
                if self.wrong.len() < QUOTED {
                    self.wrong.push(format!("{} (line {}): {error}", answered.id, answered.line));
                }
            }
        }
        if self.slowest.as_ref().is_none_or(|(_, time)| answered.time > *time) {
            self.slowest = Some((answered.id.clone(), answered.time));
        }
    }
}
