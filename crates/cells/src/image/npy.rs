//! Arrays of NumPy.

use super::{Endian, ImageData, Number, Wrong, check_counts, numbers, text};

/// An array; of one in C order the last index runs along x.
///
/// # Errors
/// Bytes that are not such an array of numbers.
pub fn parse(bytes: &[u8]) -> Result<ImageData, Wrong> {
    if !bytes.starts_with(b"\x93NUMPY") || bytes.len() < 12 {
        return Err(Wrong::new("the start", "not the mark of an array", "save it with numpy.save"));
    }
    let (length, start) = if bytes[6] == 1 {
        (usize::from(u16::from_le_bytes([bytes[8], bytes[9]])), 10)
    } else {
        (u32::from_le_bytes([bytes[8], bytes[9], bytes[10], bytes[11]]) as usize, 12)
    };
    let Some(header) = bytes.get(start..start + length).map(text) else {
        return Err(Wrong::new("the header", format!("{length} bytes long"), "the file is truncated"));
    };
    let value = |key: &str| {
        let at = header.find(&format!("'{key}'"))?;
        Some(header[at..].split_once(':')?.1.trim_start().to_owned())
    };
    let missing = |key: &str| Wrong::new(format!("`{key}` of the header"), "missing", "save it with numpy.save");
    let kind = value("descr").ok_or_else(|| missing("descr"))?;
    let kind = kind.trim_start_matches('\'').split('\'').next().unwrap_or("").to_owned();
    let endian = if kind.starts_with('>') { Endian::Big } else { Endian::Little };
    let number = match kind.trim_start_matches(['<', '>', '|', '=']) {
        "u1" | "b1" => Number::U8,
        "i1" => Number::I8,
        "u2" => Number::U16,
        "i2" => Number::I16,
        "u4" => Number::U32,
        "i4" => Number::I32,
        "u8" => Number::U64,
        "i8" => Number::I64,
        "f4" => Number::F32,
        "f8" => Number::F64,
        _ => return Err(Wrong::new("the type", format!("`{kind}`"), "convert it with astype(numpy.float32)")),
    };
    let shape = value("shape").ok_or_else(|| missing("shape"))?;
    let shape = shape.split(')').next().unwrap_or("").trim_start_matches('(').to_owned();
    let mut count: Vec<usize> = numbers("the shape", &shape)?;
    check_counts("the shape", &count)?;
    let fortran = value("fortran_order").is_some_and(|v| v.starts_with("True"));
    if !fortran {
        count.reverse();
    }
    let values = number.decode(&bytes[start + length..], endian, &count)?;
    Ok(ImageData::plain(count, values))
}
