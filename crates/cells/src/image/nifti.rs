//! NIfTI-1 images in one file, not compressed.

use super::{Endian, ImageData, Number, Wrong, check_counts};

/// The image; directions other than the axes are not turned.
///
/// # Errors
/// Bytes that are not such an image.
pub fn parse(bytes: &[u8]) -> Result<ImageData, Wrong> {
    if bytes.starts_with(&[0x1f, 0x8b]) {
        return Err(Wrong::new("the file", "compressed by gzip", "decompress it with gunzip"));
    }
    if bytes.len() < 352 || &bytes[344..347] != b"n+1" {
        return Err(Wrong::new("the mark at byte 344", "not `n+1`", "the file must be a NIfTI-1 image in one file"));
    }
    let endian = match [bytes[0], bytes[1], bytes[2], bytes[3]] {
        b if i32::from_le_bytes(b) == 348 => Endian::Little,
        b if i32::from_be_bytes(b) == 348 => Endian::Big,
        b => return Err(Wrong::new("the size of the header", i32::from_le_bytes(b), "348 is expected")),
    };
    let short = |at: usize| {
        let b = [bytes[at], bytes[at + 1]];
        if endian == Endian::Little { i16::from_le_bytes(b) } else { i16::from_be_bytes(b) }
    };
    let float = |at: usize| {
        let b = [bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]];
        f64::from(if endian == Endian::Little { f32::from_le_bytes(b) } else { f32::from_be_bytes(b) })
    };
    let dimension = short(40);
    if !(1..=4).contains(&dimension) {
        return Err(Wrong::new("`dim[0]`", dimension, "one to four directions are expected"));
    }
    let n = dimension as usize;
    let count: Vec<usize> = (0..n).map(|k| short(42 + 2 * k).max(0) as usize).collect();
    check_counts("`dim`", &count)?;
    let number = match short(70) {
        2 => Number::U8,
        4 => Number::I16,
        8 => Number::I32,
        16 => Number::F32,
        64 => Number::F64,
        256 => Number::I8,
        512 => Number::U16,
        768 => Number::U32,
        other => return Err(Wrong::new("`datatype`", other, "save it as 16-bit integers or 32-bit floats")),
    };
    let start = float(108);
    if !(352.0..1e9).contains(&start) {
        return Err(Wrong::new("`vox_offset`", start, "352 or more is expected"));
    }
    let spacing: Vec<f64> = (0..n)
        .map(|k| match float(80 + 4 * k).abs() {
            h if h > 0.0 && h.is_finite() => h,
            _ => 1.0,
        })
        .collect();
    let mut values = number.decode(bytes.get(start as usize..).unwrap_or_default(), endian, &count)?;
    let (slope, intercept) = (float(112), float(116));
    if slope != 0.0 && slope.is_finite() && intercept.is_finite() {
        values.iter_mut().for_each(|v| *v = slope * *v + intercept);
    }
    // With an affine map along the axes its last column is the middle of the first voxel.
    let mut origin = vec![0.0; n];
    if short(254) > 0 {
        let along = |k: usize| float(280 + 16 * k + 4 * k);
        let straight =
            (0..n.min(3)).all(|k| (0..3).all(|j| j == k || float(280 + 16 * k + 4 * j) == 0.0) && along(k) > 0.0);
        if !straight {
            return Err(Wrong::new("`srow`", "a turned or mirrored frame", "resample the image along the axes"));
        }
        (0..n.min(3)).for_each(|k| origin[k] = float(280 + 16 * k + 12) - 0.5 * spacing[k]);
    }
    Ok(ImageData { count, spacing, origin, values })
}
