//! Answers as files have them: objects of JSON, lines of CSV, rows of an array of NumPy.

use super::query::PairQuery;
use crate::npy;
use serde::Serialize;
use signorini_geometry::closest::{Certificate, ClosestPair, FeatureKind, Foot, Projection, Uniqueness, signed_gap};
use signorini_geometry::shape::Shape;
use std::io::Write;
use std::path::Path;

/// How answers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    Json,
    Csv,
    Npy,
}

impl Format {
    /// The format that the name of a file tells; JSON where it tells none.
    pub fn of(path: &Path) -> Self {
        match path.extension().map(|e| e.to_string_lossy().to_lowercase()).as_deref() {
            Some("csv") => Format::Csv,
            Some("npy") => Format::Npy,
            _ => Format::Json,
        }
    }
}

/// A pair of closest points.
#[derive(Serialize)]
struct Minimiser<'a> {
    distance: f64,
    a: &'a [f64],
    b: &'a [f64],
    xa: &'a [f64],
    xb: &'a [f64],
    normal: Option<[f64; 3]>,
    feature_a: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    entity_a: Option<String>,
    feature_b: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    entity_b: Option<String>,
    lambda_min: f64,
}

impl<'a> Minimiser<'a> {
    fn new(pair: &'a ClosestPair) -> Self {
        let entity = |f: &Foot| (f.feature.kind != FeatureKind::Point).then(|| f.feature.entity.to_string());
        Minimiser {
            distance: pair.distance,
            a: pair.a.parameters(),
            b: pair.b.parameters(),
            xa: pair.a.point.as_slice(),
            xb: pair.b.point.as_slice(),
            normal: pair.direction().map(Into::into),
            feature_a: feature(pair.a.feature.kind),
            entity_a: entity(&pair.a),
            feature_b: feature(pair.b.feature.kind),
            entity_b: entity(&pair.b),
            lambda_min: pair.lambda_min,
        }
    }
}

fn feature(kind: FeatureKind) -> &'static str {
    match kind {
        FeatureKind::Point => "point",
        FeatureKind::Interior => "interior",
        FeatureKind::Edge => "edge",
        FeatureKind::Vertex => "vertex",
    }
}

/// The answer to a query.
#[derive(Serialize)]
pub struct Answer<'a> {
    #[serde(flatten)]
    closest: Minimiser<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    gap: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    triangle_a: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    triangle_b: Option<usize>,
    unique: bool,
    uniqueness: &'static str,
    continuum_dim: usize,
    certified: bool,
    certified_to: f64,
    others: Vec<Minimiser<'a>>,
}

impl<'a> Answer<'a> {
    pub fn new(projection: &'a Projection, query: &PairQuery) -> Self {
        let (uniqueness, continuum_dim) = match projection.uniqueness {
            Uniqueness::Unique => ("unique", 0),
            Uniqueness::Multiple => ("multiple", 0),
            Uniqueness::Continuum { dimension } => ("continuum", dimension),
            Uniqueness::NearContinuum { .. } => ("near-continuum", 0),
        };
        let triangle = |shape: &Shape, foot: &Foot| matches!(shape, Shape::Mesh(_)).then_some(foot.element);
        Answer {
            closest: Minimiser::new(&projection.closest),
            gap: signed_gap(&projection.closest, &query.b),
            triangle_a: triangle(&query.a, &projection.closest.a),
            triangle_b: triangle(&query.b, &projection.closest.b),
            unique: projection.uniqueness.is_unique(),
            uniqueness,
            continuum_dim,
            certified: projection.certificate == Certificate::Complete,
            certified_to: projection.certified_to,
            others: projection.others.iter().map(Minimiser::new).collect(),
        }
    }

    /// The cells of a table, in the order of [`COLUMNS`].
    fn cells(&self) -> [Cell<'_>; COLUMNS.len()] {
        let c = &self.closest;
        let triangle = |t: Option<usize>| Cell::Count(t.map(|t| t as i64));
        [
            Cell::Numbers(std::slice::from_ref(&c.distance)),
            Cell::Numbers(self.gap.as_slice()),
            Cell::Numbers(c.a),
            Cell::Numbers(c.b),
            Cell::Numbers(c.xa),
            Cell::Numbers(c.xb),
            Cell::Numbers(c.normal.as_ref().map_or(&[], |n| n)),
            Cell::Word(c.feature_a),
            Cell::Word(c.feature_b),
            triangle(self.triangle_a),
            triangle(self.triangle_b),
            Cell::Word(self.uniqueness),
            Cell::Count(Some(self.others.len() as i64)),
            Cell::Numbers(std::slice::from_ref(&c.lambda_min)),
            Cell::Count(Some(i64::from(self.certified))),
            Cell::Numbers(std::slice::from_ref(&self.certified_to)),
        ]
    }
}

/// What a column of a table holds.
enum Cell<'a> {
    /// Numbers; those that a row lacks are not a number.
    Numbers(&'a [f64]),
    Word(&'a str),
    /// A count; -1 where there is none.
    Count(Option<i64>),
}

/// The columns of a table: the keys of the object of JSON, with the types and numbers of entries of NumPy.
const COLUMNS: [(&str, &str, usize); 16] = [
    ("distance", "<f8", 1),
    ("gap", "<f8", 1),
    ("a", "<f8", 2),
    ("b", "<f8", 2),
    ("xa", "<f8", 3),
    ("xb", "<f8", 3),
    ("normal", "<f8", 3),
    ("feature_a", "|S8", 1),
    ("feature_b", "|S8", 1),
    ("triangle_a", "<i8", 1),
    ("triangle_b", "<i8", 1),
    ("uniqueness", "|S14", 1),
    ("others", "<i8", 1),
    ("lambda_min", "<f8", 1),
    ("certified", "<i8", 1),
    ("certified_to", "<f8", 1),
];

/// The cells of a query that has no answer.
const BLANK: [Cell<'static>; COLUMNS.len()] = {
    use Cell::{Count, Numbers, Word};
    [
        Numbers(&[]),
        Numbers(&[]),
        Numbers(&[]),
        Numbers(&[]),
        Numbers(&[]),
        Numbers(&[]),
        Numbers(&[]),
        Word(""),
        Word(""),
        Count(None),
        Count(None),
        Word(""),
        Count(None),
        Numbers(&[]),
        Count(None),
        Numbers(&[]),
    ]
};

impl Format {
    /// What stands before the answers; of the same length for any number of them.
    pub fn head(self, rows: usize) -> Vec<u8> {
        match self {
            Format::Json => b"{".to_vec(),
            Format::Npy => npy::table_head(&COLUMNS, rows),
            Format::Csv => {
                let names = |&(name, kind, count): &(&str, &str, usize)| match (kind, count) {
                    (_, 2) => format!("{name}_u,{name}_v"),
                    (_, 3) => format!("{name}_x,{name}_y,{name}_z"),
                    _ => name.to_string(),
                };
                let names: Vec<String> = COLUMNS.iter().map(names).collect();
                format!("id,{},error\n", names.join(",")).into_bytes()
            }
        }
    }

    /// One answer, or what is wrong with the query in line `line`. `first` tells whether answers stand before it.
    pub fn row(self, out: &mut Vec<u8>, id: &str, first: bool, answer: Result<&Answer<'_>, (&str, usize)>) {
        match self {
            Format::Json => {
                out.extend_from_slice(if first { b"\n" } else { b",\n" });
                json(out, &id);
                out.extend_from_slice(b": ");
                match answer {
                    Ok(answer) => json(out, answer),
                    Err((error, line)) => json(out, &serde_json::json!({ "error": error, "line": line })),
                }
            }
            Format::Npy => {
                for (cell, (_, kind, count)) in answer.map_or(BLANK, Answer::cells).iter().zip(COLUMNS) {
                    match cell {
                        Cell::Numbers(numbers) => (0..count)
                            .map(|k| numbers.get(k).copied().unwrap_or(f64::NAN))
                            .for_each(|x| out.extend(x.to_le_bytes())),
                        Cell::Count(n) => out.extend(n.unwrap_or(-1).to_le_bytes()),
                        Cell::Word(word) => {
                            let width = kind[2..].parse().unwrap_or(0);
                            out.extend(word.bytes().chain(std::iter::repeat(0)).take(width));
                        }
                    }
                }
            }
            Format::Csv => {
                quoted(out, id);
                for (cell, (_, _, count)) in answer.map_or(BLANK, Answer::cells).iter().zip(COLUMNS) {
                    for k in 0..count {
                        out.push(b',');
                        match cell {
                            Cell::Numbers(numbers) => numbers
                                .get(k)
                                .filter(|x| !x.is_nan())
                                .into_iter()
                                .for_each(|x| json_or_infinity(out, *x)),
                            Cell::Count(n) => n.iter().for_each(|n| json(out, n)),
                            Cell::Word(word) => out.extend(word.bytes()),
                        }
                    }
                }
                out.push(b',');
                answer.err().into_iter().for_each(|(error, _)| quoted(out, error));
                out.push(b'\n');
            }
        }
    }

    /// What stands after the answers.
    pub fn tail(self) -> &'static [u8] {
        if self == Format::Json { b"\n}\n" } else { b"" }
    }
}

/// Writes into memory, which never fails.
fn json(out: &mut Vec<u8>, value: &impl Serialize) {
    let _ = serde_json::to_writer(out, value);
}

/// A number in the shortest form that is read as the same one.
fn json_or_infinity(out: &mut Vec<u8>, x: f64) {
    if x.is_finite() { json(out, &x) } else { out.extend(x.to_string().bytes()) }
}

/// A text as an entry of CSV.
fn quoted(out: &mut Vec<u8>, text: &str) {
    if text.contains(['"', ',', '\n', '\r']) {
        let _ = write!(out, "\"{}\"", text.replace('"', "\"\""));
    } else {
        out.extend(text.bytes());
    }
}
