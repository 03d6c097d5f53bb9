//! Height maps from files: CSV, NPY and TIFF.
//!
//! The first value is the height at the origin; columns run along x, rows along y. The values are joined by a bicubic
//! spline, which passes through all of them and has continuous curvature.

use crate::npy;
use crate::relief::Sampled;
use crate::text_table::{self, Numbers, Row};
use std::path::Path;

/// The most values of a map.
const MOST: usize = 64 << 20;

/// Rows of heights as a file has them.
struct Table {
    columns: usize,
    values: Vec<f64>,
}

/// Reads a map from the bytes of a file, whose kind its extension tells. `scale` is what one unit of the file stands
/// for.
///
/// # Errors
/// In words: files of another kind, damaged or ragged ones, numbers that are missing or not finite, fewer than four
/// rows or columns, images that are not grey, or of 8 bits.
pub fn read(path: &Path, bytes: &[u8], origin: [f64; 2], spacing: [f64; 2], scale: f64) -> Result<Sampled, String> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    let table = match extension.as_str() {
        "csv" | "txt" => csv(bytes),
        "npy" => npy(bytes),
        "tif" | "tiff" => tiff(bytes),
        other => Err(format!("`{other}` is not a format of height maps; valid are csv, npy and tif")),
    }?;
    let heights: Vec<f64> = table.values.iter().map(|v| scale * v).collect();
    Sampled::of_rows(origin, spacing, table.columns, &heights)
}

/// Rows of numbers.
fn csv(bytes: &[u8]) -> Result<Table, String> {
    let mut numbers = Numbers::default();
    let (mut values, mut columns, mut rows) = (Vec::new(), 0, 0);
    for Row { line, entries } in text_table::rows(bytes)? {
        for (column, entry) in entries.iter().enumerate() {
            let place = |what| format!("line {line}, column {}: {what}", column + 1);
            values.push(numbers.read(line, entry).map_err(place)?);
        }
        let found = entries.len();
        if rows > 0 && found != columns {
            return Err(format!("line {line}: {found} numbers where the lines before have {columns}"));
        }
        (columns, rows) = (found, rows + 1);
        if values.len() > MOST {
            return Err(format!("more than {MOST} heights"));
        }
    }
    numbers.finish()?;
    Ok(Table { columns, values })
}

/// A two-dimensional array.
fn npy(bytes: &[u8]) -> Result<Table, String> {
    let npy::Array { shape, values } = npy::read(bytes, MOST)?;
    let &[_, columns] = &shape[..] else {
        return Err(format!("an array of {} dimensions: a height map has two", shape.len()));
    };
    Ok(Table { columns, values })
}

/// A grey image: integers of 16 bits, or numbers of 32 or 64.
fn tiff(bytes: &[u8]) -> Result<Table, String> {
    let wrong = |e: tiff::TiffError| format!("not a TIFF that can be read: {e}");
    let mut decoder = tiff::decoder::Decoder::new(std::io::Cursor::new(bytes)).map_err(wrong)?;
    let (columns, rows) = decoder.dimensions().map_err(wrong)?;
    let (columns, rows) = (columns as usize, rows as usize);
    if rows.saturating_mul(columns) > MOST {
        return Err(format!("{rows} x {columns} heights are too many"));
    }
    match decoder.colortype().map_err(wrong)? {
        tiff::ColorType::Gray(16 | 32 | 64) => {}
        other => {
            return Err(format!(
                "the image is {other:?}: expected one grey value of 16 bits or more; 8 bits are too coarse for \
                 heights"
            ));
        }
    }
    let values = match decoder.read_image().map_err(wrong)? {
        tiff::decoder::DecodingResult::U16(values) => values.into_iter().map(f64::from).collect::<Vec<f64>>(),
        tiff::decoder::DecodingResult::I16(values) => values.into_iter().map(f64::from).collect(),
        tiff::decoder::DecodingResult::U32(values) => values.into_iter().map(f64::from).collect(),
        tiff::decoder::DecodingResult::I32(values) => values.into_iter().map(f64::from).collect(),
        tiff::decoder::DecodingResult::F32(values) => values.into_iter().map(f64::from).collect(),
        tiff::decoder::DecodingResult::F64(values) => values,
        _ => {
            return Err("the image has an unknown number type: save as float32 or as 16-bit integers".into());
        }
    };
    if values.len() != rows * columns {
        return Err(format!("{} heights, but the header states {rows} x {columns}", values.len()));
    }
    Ok(Table { columns, values })
}
