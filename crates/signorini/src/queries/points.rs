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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_read_or_refused_with_their_place() {
        let expected = vec![Point::<3>::new(1.0, 2.5, -3.0), Point::<3>::new(4.0, 5.0, 6e-3)];
        for text in ["1,2.5,-3\n4,5,6e-3", "# c\nz;n;x;y\n-3;0;1;2,5\n6e-3;0;4;5\n", "X Y Z\n1 2.5 -3\n4 5 6e-3\n"] {
            assert_eq!(read(text.as_bytes()), Ok(expected.clone()), "{text}");
        }
        let head = |kind: &str, shape: &str| {
            let text = format!("{{'descr': '{kind}', 'fortran_order': True, 'shape': {shape}, }}\n");
            [&b"\x93NUMPY\x01\x00"[..], &(text.len() as u16).to_le_bytes(), text.as_bytes()].concat()
        };
        let columns = [1f64, 4.0, 2.5, 5.0, -3.0, 6e-3].map(f64::to_le_bytes).concat();
        assert_eq!(read(&[head("<f8", "(2, 3)"), columns.clone()].concat()), Ok(expected));
        for (bytes, words) in [
            (&b""[..], "contains no points"),
            (b"x,y,z\n", "contains no points"),
            (b"x,y\n1,2\n", "no columns x, y and z among x, y"),
            (b"1,2\n", "line 1: 2 numbers instead of 3"),
            (b"1,2,3\n1,2\n", "line 2: 2 entries"),
            (b"x,y,z\n1,a,3\n", "line 2, column 2: `a` is no number"),
            (b"1,2,inf\n", "line 1: inf is not finite"),
            (&[head("<f8", "(3, 2)"), columns.clone()].concat(), "points are an array of (n, 3)"),
            (&[head("<f8", "(1, 3)"), [0.0, f64::NAN, 0.0].map(f64::to_le_bytes).concat()].concat(), "row 0: NaN"),
        ] {
            let error = read(bytes).unwrap_err();
            assert!(error.contains(words), "{words}: {error}");
        }
    }
}
