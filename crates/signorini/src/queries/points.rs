//! Points from a file: CSV or NPY, told apart by their first bytes.

use crate::npy;
use crate::text_table::{self, Numbers, Row};
use signorini_geometry::Point;

/// The most coordinates of a file.
const MOST: usize = 3 << 26;

/// Reads points, three coordinates each: a text table, with or without a row of names that has `x`, `y` and `z`, or an
/// array of NumPy of shape (n, 3).
///
/// # Errors
/// In words, with the line or the row.
pub fn read(bytes: &[u8]) -> Result<Vec<Point<3>>, String> {
    if bytes.starts_with(npy::MAGIC) {
        let npy::Array { shape, values } = npy::read(bytes, MOST)?;
        if !matches!(shape[..], [_, 3]) {
            return Err(format!("an array of {shape:?} numbers: points are an array of (n, 3)"));
        }
        let points = values.chunks_exact(3).map(Point::<3>::from_column_slice).enumerate();
        return points.map(|(k, p)| finite(p, || format!("row {k}"))).collect();
    }
    let rows = text_table::rows(bytes)?;
    let Some(first) = rows.first() else { return Err("contains no points".into()) };
    let (columns, rows) = match header(first)? {
        Some(columns) => (columns, &rows[1..]),
        None => ([0, 1, 2], &rows[..]),
    };
    let width = first.entries.len();
    let mut numbers = Numbers::default();
    let mut points = Vec::with_capacity(rows.len());
    for Row { line, entries } in rows {
        if entries.len() != width {
            return Err(format!("line {line}: {} entries where the lines before have {width}", entries.len()));
        }
        let mut p = Point::<3>::zeros();
        for (x, &k) in p.iter_mut().zip(&columns) {
            *x = numbers.read(*line, &entries[k]).map_err(|what| format!("line {line}, column {}: {what}", k + 1))?;
        }
        points.push(finite(p, || format!("line {line}"))?);
    }
    numbers.finish()?;
    if points.is_empty() { Err("contains no points".into()) } else { Ok(points) }
}

/// The columns of the coordinates where the first row has names; without names there are three columns.
fn header(row: &Row) -> Result<Option<[usize; 3]>, String> {
    let names: Vec<&str> = row.entries.iter().collect();
    if names.iter().all(|n| Numbers::default().read(0, n).is_err()) {
        let find = |name: &str| names.iter().position(|n| n.eq_ignore_ascii_case(name));
        let columns = [find("x"), find("y"), find("z")];
        let [Some(x), Some(y), Some(z)] = columns else {
            return Err(format!("line {}: no columns x, y and z among {}", row.line, names.join(", ")));
        };
        return Ok(Some([x, y, z]));
    }
    match names.len() {
        3 => Ok(None),
        n => Err(format!("line {}: {n} numbers instead of 3; with more columns, name x, y and z above them", row.line)),
    }
}

fn finite(p: Point<3>, place: impl Fn() -> String) -> Result<Point<3>, String> {
    match p.iter().find(|x| !x.is_finite()) {
        Some(x) => Err(format!("{}: {x} is not finite", place())),
        None => Ok(p),
    }
}
