//! Closest points as a service: a file of queries in, a file of answers out.
//!
//! Queries are read as a stream and answered in parallel; answers keep the order of the queries. A query that is wrong
//! gets an answer that says so and stops no other.

pub mod geometry;
pub mod scanner;

use std::collections::HashSet;
use std::io::{self, BufRead, BufReader, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use geometry::{FieldError, Fields};
use rayon::prelude::*;
use scanner::{RawCase, ScanError, Scanner};
use serde_json::{Map, Value, json};
pub use signorini_geometry::closest::Query;
use signorini_geometry::closest::{Certificate, ClosestPair, FeatureKind, Projection, Uniqueness, closest, signed_gap};
use signorini_geometry::shape::Shape;

/// A query: two shapes with a name.
#[derive(Clone, Debug)]
pub struct PairQuery {
    pub id: String,
    pub a: Shape,
    pub b: Shape,
}

/// Why a file of queries could not be answered to its end.
#[derive(Debug, thiserror::Error)]
pub enum QueriesError {
    #[error("{}: cannot read: {source}", path.display())]
    Open { path: PathBuf, source: io::Error },
    #[error("{}: cannot write: {source}", path.display())]
    Write { path: PathBuf, source: io::Error },
    #[error("{}: {source}; the {answered} cases before it are answered", path.display())]
    Scan { path: PathBuf, source: ScanError, answered: usize },
}

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

/// Reads one case; files that it names are looked for in `folder`.
///
/// # Errors
/// What is wrong, with the path of the field.
pub fn parse(text: &[u8], folder: &Path) -> Result<PairQuery, FieldError> {
    let value: Value = serde_json::from_slice(text).map_err(|e| {
        let text = String::from_utf8_lossy(text);
        let word = ["NaN", "Infinity"].into_iter().find(|w| text.contains(w));
        let message = match word {
            Some(word) => format!("{word} is not a number of JSON"),
            None => format!("not JSON: {e}"),
        };
        FieldError { path: "case".into(), message }
    })?;
    let mut fields = Fields::new("", &value)?;
    let id = fields.text("id")?.to_string();
    let (a, b) = (fields.required("a")?, fields.required("b")?);
    let (a, b) = (geometry::shape("a", a, folder)?, geometry::shape("b", b, folder)?);
    if let Some(pair) = fields.optional("pair") {
        let name = |s: &Shape| ["point", "curve", "surface"][s.dimension()];
        let found = format!("{}-{}", name(&a), name(&b));
        if pair.as_str() != Some(&found) {
            return Err(fields.error("pair", format!("{pair}, but the shapes are a {found}")));
        }
    }
    if let Some(scale) = fields.optional("scale")
        && !scale.as_f64().is_some_and(|s| s >= 0.0)
    {
        return Err(fields.error("scale", format!("{scale} is not a length")));
    }
    fields.finish(&ANNOTATIONS)?;
    Ok(PairQuery { id, a, b })
}

/// The answer to a query as JSON.
pub fn answer(projection: &Projection, query: &PairQuery) -> Value {
    let mut out = minimiser(&projection.closest);
    if let Some(gap) = signed_gap(&projection.closest, &query.b) {
        out["gap"] = json!(gap);
    }
    for (key, shape, foot) in [("a", &query.a, &projection.closest.a), ("b", &query.b, &projection.closest.b)] {
        if matches!(shape, Shape::Mesh(_)) {
            out[format!("triangle_{key}")] = json!(foot.element);
        }
    }
    let fields = out.as_object_mut().expect("an object");
    fields.insert("unique".into(), json!(projection.uniqueness.is_unique()));
    let (name, dimension) = match projection.uniqueness {
        Uniqueness::Unique => ("unique", 0),
        Uniqueness::Multiple => ("multiple", 0),
        Uniqueness::Continuum { dimension } => ("continuum", dimension),
        Uniqueness::NearContinuum { .. } => ("near-continuum", 0),
    };
    fields.insert("uniqueness".into(), json!(name));
    fields.insert("continuum_dim".into(), json!(dimension));
    fields.insert("certified".into(), json!(projection.certificate == Certificate::Complete));
    fields.insert("certified_to".into(), json!(projection.certified_to));
    fields.insert("others".into(), projection.others.iter().map(minimiser).collect());
    out
}

fn minimiser(pair: &ClosestPair) -> Value {
    let mut out = Map::new();
    out.insert("distance".into(), json!(pair.distance));
    for (key, foot) in [("a", &pair.a), ("b", &pair.b)] {
        out.insert(key.into(), json!(foot.parameters()));
        out.insert(format!("x{key}"), json!(foot.point.as_slice()));
        out.insert(format!("feature_{key}"), json!(foot.feature.kind.to_string()));
        if foot.feature.kind != FeatureKind::Point {
            out.insert(format!("entity_{key}"), json!(foot.feature.entity.to_string()));
        }
    }
    out.insert("normal".into(), pair.direction().map_or(Value::Null, |n| json!(n.as_slice())));
    out.insert("lambda_min".into(), json!(pair.lambda_min));
    Value::Object(out)
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

struct Answered {
    id: String,
    line: usize,
    /// The projection and what is written of it.
    result: Result<(Projection, Value), FieldError>,
    time: Duration,
}

/// Answers a file of queries; `progress` is told the number answered so far and returns whether to go on.
///
/// # Errors
/// Files that cannot be read or written, and input that is not a file of queries. The answers up to there are written.
pub fn answer_file(
    queries: &Path,
    answers: &Path,
    query: &Query,
    progress: &mut dyn FnMut(usize) -> bool,
) -> Result<Report, QueriesError> {
    let open = |source| QueriesError::Open { path: queries.to_path_buf(), source };
    let write = |source| QueriesError::Write { path: answers.to_path_buf(), source };
    let input: Box<dyn BufRead> = if queries == Path::new("-") {
        Box::new(io::stdin().lock())
    } else {
        if queries.is_dir() {
            return Err(open(io::Error::other("a folder, not a file")));
        }
        Box::new(BufReader::with_capacity(1 << 20, std::fs::File::open(queries).map_err(open)?))
    };
    let folder = queries.parent().unwrap_or(Path::new("")).to_path_buf();
    let mut part = answers.as_os_str().to_owned();
    part.push(".part");
    let part = PathBuf::from(part);
    let mut out = BufWriter::new(std::fs::File::create(&part).map_err(write)?);
    let start = Instant::now();
    let mut report = Report::default();
    let mut scanner = Scanner::new(input);
    let mut names = HashSet::new();
    let mut first = true;
    let mut stopped = None;
    out.write_all(b"{").map_err(write)?;
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
        let last = batch.len() < BATCH;
        let mut done: Vec<Answered> = Vec::with_capacity(batch.len());
        batch.par_iter().map(|case| answer_case(case, query, &folder)).collect_into_vec(&mut done);
        for mut answered in done {
            if !names.insert(answered.id.clone()) {
                answered.result = Err(FieldError { path: "id".into(), message: "given twice".into() });
                answered.id = format!("{} (line {})", answered.id, answered.line);
                names.insert(answered.id.clone());
            }
            report.note(&answered);
            let value = match &answered.result {
                Ok((_, answer)) => answer.clone(),
                Err(error) => json!({ "error": error.to_string(), "line": answered.line }),
            };
            let separator = if first { "\n" } else { ",\n" };
            first = false;
            write!(out, "{separator}{}: {value}", Value::from(answered.id)).map_err(write)?;
        }
        if !progress(report.answered) || last {
            break;
        }
    }
    out.write_all(b"\n}\n").map_err(write)?;
    out.into_inner().map_err(|e| write(e.into_error()))?.sync_all().map_err(write)?;
    std::fs::rename(&part, answers).map_err(write)?;
    report.elapsed = start.elapsed();
    match stopped {
        Some(source) => Err(QueriesError::Scan { path: queries.to_path_buf(), source, answered: report.answered }),
        None => Ok(report),
    }
}

fn answer_case(case: &RawCase, query: &Query, folder: &Path) -> Answered {
    let start = Instant::now();
    let (id, result) = match parse(&case.text, folder) {
        Ok(pair) => {
            let projection = closest(&pair.a, &pair.b, query);
            let value = answer(&projection, &pair);
            (pair.id, Ok((projection, value)))
        }
        Err(error) => (name_of(case), Err(error)),
    };
    Answered { id, line: case.line, result, time: start.elapsed() }
}

impl Report {
    fn note(&mut self, answered: &Answered) {
        self.answered += 1;
        match &answered.result {
            Ok((projection, _)) => {
                self.not_unique += usize::from(!projection.uniqueness.is_unique());
                self.not_certified += usize::from(projection.certificate == Certificate::Stopped);
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
