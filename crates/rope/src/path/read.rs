//! Points out of text.

use super::PathError;
use signorini_geometry::Point;

/// The points of a table of three columns.
pub fn points(text: &str) -> Result<Vec<Point<3>>, PathError> {
    let text = text.trim_start_matches('\u{feff}');
    let mut out = Vec::new();
    let mut is_first = true;
    for (index, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let separators: &[char] = match line {
            l if l.contains(';') => &[';'],
            l if l.contains(',') => &[','],
            l if l.contains('\t') => &['\t'],
            _ => &[' '],
        };
        let fields: Vec<&str> =
            line.split(separators).map(str::trim).filter(|f| separators != [' '] || !f.is_empty()).collect();
        let numbers: Vec<Option<f64>> = fields.iter().map(|f| f.parse().ok()).collect();
        let names = is_first && numbers.iter().all(Option::is_none);
        is_first = false;
        if names {
            continue;
        }
        let error = |message: String| PathError::File { line: index as u64 + 1, message };
        if let Some(k) = numbers.iter().position(Option::is_none) {
            let hint =
                if separators == [';'] && fields[k].contains(',') { ", write decimals with a point" } else { "" };
            return Err(error(format!("`{}` is not a number{hint}", fields[k])));
        }
        let values: Vec<f64> = numbers.into_iter().flatten().collect();
        match values[..] {
            [x, y, z] => out.push(Point::<3>::new(x, y, z)),
            _ => return Err(error(format!("{} numbers, but a point has three: x, y, z", values.len()))),
        }
    }
    Ok(out)
}
