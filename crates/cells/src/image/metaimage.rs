//! MetaImage: lines `Key = value`, the last of them `ElementDataFile`, and numbers.

use super::nrrd::{Header, check_geometry};
use super::{Endian, Number, Wrong, check_counts, numbers, text};

/// The header at the start of a file.
///
/// # Errors
/// Keys that are missing or that are not understood.
pub fn header(bytes: &[u8]) -> Result<Header, Wrong> {
    const LAST: &[u8] = b"ElementDataFile";
    let Some(last) = bytes.windows(LAST.len()).position(|w| w == LAST) else {
        return Err(Wrong::new("`ElementDataFile`", "missing", "the file must be a MetaImage"));
    };
    let end = bytes[last..].iter().position(|b| *b == b'\n').map_or(bytes.len(), |p| last + p + 1);
    let lines = text(&bytes[..end]);
    let field = |name: &str| {
        lines.lines().find_map(|l| {
            let (key, value) = l.split_once('=')?;
            (key.trim() == name).then(|| value.trim().to_owned())
        })
    };
    let needed =
        |name: &str| field(name).ok_or_else(|| Wrong::new(format!("`{name}`"), "missing", "every MetaImage has it"));
    let count: Vec<usize> = numbers("`DimSize`", &needed("DimSize")?)?;
    check_counts("`DimSize`", &count)?;
    let is_true = |name: &str| field(name).is_some_and(|v| v.eq_ignore_ascii_case("true"));
    if is_true("CompressedData") {
        return Err(Wrong::new("`CompressedData`", "True", "save the image without compression"));
    }
    let kind = needed("ElementType")?;
    let number = match kind.as_str() {
        "MET_UCHAR" => Number::U8,
        "MET_CHAR" => Number::I8,
        "MET_USHORT" => Number::U16,
        "MET_SHORT" => Number::I16,
        "MET_UINT" => Number::U32,
        "MET_INT" => Number::I32,
        "MET_FLOAT" => Number::F32,
        "MET_DOUBLE" => Number::F64,
        _ => return Err(Wrong::new("`ElementType`", format!("`{kind}`"), "save it as MET_SHORT or MET_FLOAT")),
    };
    let n = count.len();
    let big = is_true("BinaryDataByteOrderMSB") || is_true("ElementByteOrderMSB");
    let spacing = match field("ElementSpacing").or_else(|| field("ElementSize")) {
        Some(list) => numbers("`ElementSpacing`", &list)?,
        None => vec![1.0; n],
    };
    let origin = match field("Offset").or_else(|| field("Position")).or_else(|| field("Origin")) {
        Some(list) => numbers("`Offset`", &list)?,
        None => spacing.iter().map(|h| 0.5 * h).collect(),
    };
    if let Some(list) = field("TransformMatrix") {
        let m: Vec<f64> = numbers("`TransformMatrix`", &list)?;
        if m.len() != n * n || (0..n * n).any(|i| m[i] != f64::from(u8::from(i % (n + 1) == 0))) {
            let remedy = "resample the image so that its directions are the axes";
            return Err(Wrong::new("`TransformMatrix`", format!("`{list}`"), remedy));
        }
    }
    check_geometry(n, &spacing, &origin)?;
    let file = needed("ElementDataFile")?;
    let endian = if big { Endian::Big } else { Endian::Little };
    let data_file = (file != "LOCAL").then_some(file);
    Ok(Header { count, spacing, origin, number, endian, data_start: end, data_file })
}
