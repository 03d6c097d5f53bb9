//! Numbers without a header.

use super::{Endian, ImageData, Number, Wrong, check_counts};

/// What a file of numbers does not say itself.
#[derive(Clone, Debug, PartialEq)]
pub struct RawHeader {
    /// Voxels in each direction, that along x first.
    pub count: Vec<usize>,
    /// Empty where it is not known.
    pub spacing: Vec<f64>,
    pub origin: Vec<f64>,
    pub number: Number,
    pub endian: Endian,
    /// Bytes before the first number.
    pub skip: usize,
}

/// The numbers of a file, x running fastest.
///
/// # Errors
/// A header that contradicts itself or the length of the file.
pub fn parse(bytes: &[u8], header: &RawHeader) -> Result<ImageData, Wrong> {
    check_counts("count", &header.count)?;
    for (name, list) in [("spacing", &header.spacing), ("origin", &header.origin)] {
        let is_unknown = name == "spacing" && list.is_empty();
        if list.len() != header.count.len() && !is_unknown {
            return Err(Wrong::new(name, format!("{list:?}"), "it needs a number for each direction of `count`"));
        }
    }
    let data = bytes.get(header.skip..).unwrap_or_default();
    let wanted = header.count.iter().product::<usize>().saturating_mul(header.number.bytes());
    if data.len() != wanted {
        let found = format!("{} bytes, but {wanted} by count and type", data.len());
        return Err(Wrong::new("the data", found, "count, type or skip do not match this file"));
    }
    let values = header.number.decode(data, header.endian, &header.count)?;
    let (count, spacing, origin) = (header.count.clone(), header.spacing.clone(), header.origin.clone());
    Ok(ImageData { count, spacing, origin, values })
}
