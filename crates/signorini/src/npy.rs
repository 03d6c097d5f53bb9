//! Arrays in the format of NumPy: reading arrays of numbers, writing tables whose columns have names.
//!
//! The format: <https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html>.

/// The first bytes of a file.
pub const MAGIC: &[u8] = b"\x93NUMPY";

/// An array of numbers: its shape, and its values with the last index fastest.
pub struct Array {
    pub shape: Vec<usize>,
    pub values: Vec<f64>,
}

/// Reads an array of real numbers (format 1 to 3) of at most `most` values.
///
/// # Errors
/// In words: another file, a damaged one, numbers of another kind.
pub fn read(bytes: &[u8], most: usize) -> Result<Array, String> {
    if bytes.len() < 10 || !bytes.starts_with(MAGIC) {
        return Err("not an NPY file: its first bytes are wrong".into());
    }
    let at = |k: usize| bytes.get(k).copied().map_or(0, usize::from);
    let (start, length): (usize, usize) = if bytes[6] == 1 {
        (10, at(8) + (at(9) << 8))
    } else {
        (12, at(8) + (at(9) << 8) + (at(10) << 16) + (at(11) << 24))
    };
    let header = bytes.get(start..start.saturating_add(length)).ok_or("the header is truncated")?;
    let header = std::str::from_utf8(header).map_err(|e| format!("the header is not text: {e}"))?;
    let field = |name: &str| {
        let after = header.split(&format!("'{name}'")).nth(1)?;
        Some(after.trim_start().strip_prefix(':')?.trim_start())
    };
    let kind = field("descr").and_then(|d| d.split('\'').nth(1)).ok_or("the header has no number type")?;
    let by_columns = field("fortran_order").is_some_and(|f| f.starts_with("True"));
    let shape = field("shape").and_then(|s| s.strip_prefix('(')?.split(')').next()).ok_or("the header has no shape")?;
    let shape: Vec<usize> = (shape.split(',').map(str::trim).filter(|s| !s.is_empty()))
        .map(|s| s.parse().map_err(|_| format!("`{s}` is not an array size")))
        .collect::<Result<_, _>>()?;
    let count = shape.iter().try_fold(1usize, |n, s| n.checked_mul(*s)).filter(|n| *n <= most);
    let count = count.ok_or_else(|| format!("an array of {shape:?} numbers: the limit is {most}"))?;
    let unknown = || format!("numbers of type `{kind}` are not supported; save as float64");
    let width: usize =
        kind.get(2..).and_then(|w| w.parse().ok()).filter(|w| (1..=8).contains(w)).ok_or_else(unknown)?;
    let data = &bytes[start + length..];
    if data.len() < count.saturating_mul(width) {
        return Err(format!("the header states {count} numbers of {width} bytes, but the file ends before"));
    }
    let big = kind.starts_with('>');
    let number = |piece: &[u8]| -> Option<f64> {
        let mut raw = [0u8; 8];
        for (i, b) in piece.iter().enumerate() {
            raw[if big { width - 1 - i } else { i }] = *b;
        }
        let [a, b, c, d, ..] = raw;
        Some(match kind.get(1..)? {
            "f8" => f64::from_le_bytes(raw),
            "f4" => f64::from(f32::from_le_bytes([a, b, c, d])),
            "u1" => f64::from(a),
            "u2" => f64::from(u16::from_le_bytes([a, b])),
            "u4" => f64::from(u32::from_le_bytes([a, b, c, d])),
            "i1" => f64::from(a as i8),
            "i2" => f64::from(i16::from_le_bytes([a, b])),
            "i4" => f64::from(i32::from_le_bytes([a, b, c, d])),
            "i8" => i64::from_le_bytes(raw) as f64,
            "u8" => u64::from_le_bytes(raw) as f64,
            _ => return None,
        })
    };
    let values = data.chunks_exact(width).take(count).map(number).collect::<Option<Vec<f64>>>();
    let mut values = values.ok_or_else(unknown)?;
    if by_columns {
        values = turned(&shape, &values);
    }
    Ok(Array { shape, values })
}

/// The values with the last index fastest, of an array that has the first one fastest.
fn turned(shape: &[usize], values: &[f64]) -> Vec<f64> {
    let place = |mut k: usize| {
        let (mut place, mut stride) = (0, values.len());
        for n in shape.iter().rev() {
            stride /= n;
            place += stride * (k % n);
            k /= n;
        }
        place
    };
    (0..values.len()).map(|k| values[place(k)]).collect()
}

/// The head of a table of `rows` rows; its length does not depend on their number. A column is a name, the type of its
/// entries as NumPy writes it, and how many of them a row has; the bytes of the rows follow without gaps.
pub fn table_head(columns: &[(&str, &str, usize)], rows: usize) -> Vec<u8> {
    let column = |(name, kind, count): &(&str, &str, usize)| match count {
        1 => format!("('{name}', '{kind}')"),
        n => format!("('{name}', '{kind}', ({n},))"),
    };
    let columns = columns.iter().map(column).collect::<Vec<_>>().join(", ");
    let text = |rows: usize| format!("{{'descr': [{columns}], 'fortran_order': False, 'shape': ({rows},), }}");
    // The format wants 10 bytes and a text that together are a multiple of 64.
    let length = (10 + text(usize::MAX).len() + 1).next_multiple_of(64) - 10;
    let mut head = MAGIC.to_vec();
    head.extend([1, 0]);
    head.extend((length as u16).to_le_bytes());
    head.extend(format!("{:<width$}\n", text(rows), width = length - 1).bytes());
    head
}
