//! MetaImage: lines `Key = value`, the last of them `ElementDataFile`, and numbers.

use super::nrrd::{Encoding, Header, straight};
use super::{Endian, Number, Wrong, check_counts, check_geometry, numbers, text};

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
    let encoding = if is_true("CompressedData") { Encoding::Packed } else { Encoding::Raw };
    for (key, plain) in [("ElementNumberOfChannels", "1"), ("HeaderSize", "0"), ("BinaryData", "True")] {
        if let Some(found) = field(key).filter(|v| !v.eq_ignore_ascii_case(plain)) {
            let remedy = "save it as one binary number a voxel, without a header between";
            return Err(Wrong::new(format!("`{key}`"), format!("`{found}`"), remedy));
        }
    }
    let kind = needed("ElementType")?;
    let number = match kind.as_str() {
        "MET_UCHAR" => Number::U8,
        "MET_CHAR" => Number::I8,
        "MET_USHORT" => Number::U16,
        "MET_SHORT" => Number::I16,
        "MET_UINT" => Number::U32,
        "MET_INT" => Number::I32,
        "MET_ULONG_LONG" => Number::U64,
        "MET_LONG_LONG" => Number::I64,
        "MET_FLOAT" => Number::F32,
        "MET_DOUBLE" => Number::F64,
        _ => return Err(Wrong::new("`ElementType`", format!("`{kind}`"), "save it as MET_SHORT or MET_FLOAT")),
    };
    let n = count.len();
    let big = is_true("BinaryDataByteOrderMSB") || is_true("ElementByteOrderMSB");
    let mut steps = match field("ElementSpacing").or_else(|| field("ElementSize")) {
        Some(list) => {
            let spacing: Vec<f64> = numbers("`ElementSpacing`", &list)?;
            check_geometry(n, &spacing, &vec![0.0; n])?;
            Some(straight(&spacing))
        }
        None => None,
    };
    let first = field("Offset").or_else(|| field("Position")).or_else(|| field("Origin"));
    let first: Option<Vec<f64>> = first.map(|list| numbers("`Offset`", &list)).transpose()?;
    if let Some(first) = &first {
        check_geometry(n, &vec![1.0; n], first)?;
    }
    if let Some(list) = field("TransformMatrix") {
        let m: Vec<f64> = numbers("`TransformMatrix`", &list)?;
        if m.len() != n * n {
            let remedy = "a vector for each direction is expected";
            return Err(Wrong::new("`TransformMatrix`", format!("`{list}`"), remedy));
        }
        for (k, step) in steps.iter_mut().flatten().enumerate() {
            let h = step[k];
            (0..n).for_each(|a| step[a] = h * m[n * k + a]);
        }
    }
    let file = needed("ElementDataFile")?;
    let endian = if big { Endian::Big } else { Endian::Little };
    let data_file = (file != "LOCAL").then_some(file);
    Ok(Header { count, steps, first, number, endian, encoding, data_start: end, data_file })
}
