//! Nearly raw raster data: a header of lines `field: value`, and numbers.

use super::{Endian, ImageData, Number, Wrong, check_counts, numbers, text};

/// The header of an image.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    pub(super) count: Vec<usize>,
    pub(super) spacing: Vec<f64>,
    pub(super) origin: Vec<f64>,
    pub(super) number: Number,
    pub(super) endian: Endian,
    /// Where the data begins, in this file or in another one.
    pub data_start: usize,
    pub data_file: Option<String>,
}

impl Header {
    /// The image of the header and its data.
    ///
    /// # Errors
    /// Too little data.
    pub fn decode(&self, data: &[u8]) -> Result<ImageData, Wrong> {
        let values = self.number.decode(data, self.endian, &self.count)?;
        // The files give the middle of the first voxel.
        let origin = self.origin.iter().zip(&self.spacing).map(|(o, h)| o - 0.5 * h).collect();
        Ok(ImageData { count: self.count.clone(), spacing: self.spacing.clone(), origin, values })
    }
}

/// The header at the start of a file.
///
/// # Errors
/// Fields that are missing or that are not understood.
pub fn header(bytes: &[u8]) -> Result<Header, Wrong> {
    if !bytes.starts_with(b"NRRD") {
        return Err(Wrong::new("the start", "not `NRRD`", "the file must be of that format"));
    }
    let end = bytes.windows(2).position(|w| w == b"\n\n").map(|p| p + 2);
    let end = end.or_else(|| bytes.windows(4).position(|w| w == b"\r\n\r\n").map(|p| p + 4)).unwrap_or(bytes.len());
    let lines = text(&bytes[..end]);
    let field = |name: &str| {
        lines.lines().find_map(|l| {
            let (key, value) = l.split_once(':')?;
            key.trim().eq_ignore_ascii_case(name).then(|| value.trim().to_owned())
        })
    };
    let needed = |name: &str| {
        field(name).ok_or_else(|| Wrong::new(format!("`{name}` of the header"), "missing", "every such file has it"))
    };
    let count: Vec<usize> = numbers("`sizes`", &needed("sizes")?)?;
    check_counts("`sizes`", &count)?;
    let kind = needed("type")?.to_ascii_lowercase();
    let number = match kind.as_str() {
        "uchar" | "unsigned char" | "uint8" | "uint8_t" => Number::U8,
        "signed char" | "int8" | "int8_t" => Number::I8,
        "ushort" | "unsigned short" | "uint16" | "uint16_t" | "unsigned short int" => Number::U16,
        "short" | "short int" | "int16" | "int16_t" | "signed short" => Number::I16,
        "uint" | "unsigned int" | "uint32" | "uint32_t" => Number::U32,
        "int" | "signed int" | "int32" | "int32_t" => Number::I32,
        "float" => Number::F32,
        "double" => Number::F64,
        _ => return Err(Wrong::new("`type`", format!("`{kind}`"), "an integer or floating-point type is expected")),
    };
    let encoding = needed("encoding")?;
    if encoding != "raw" {
        return Err(Wrong::new("`encoding`", format!("`{encoding}`"), "save it with the encoding `raw`"));
    }
    let endian =
        if field("endian").is_some_and(|e| e.eq_ignore_ascii_case("big")) { Endian::Big } else { Endian::Little };
    let n = count.len();
    let mut spacing = vec![1.0; n];
    if let Some(list) = field("spacings") {
        spacing = numbers("`spacings`", &list)?;
    } else if let Some(list) = field("space directions") {
        let all: Vec<f64> = numbers("`space directions`", &list)?;
        if all.len() != n * n {
            return Err(Wrong::new(
                "`space directions`",
                format!("`{list}`"),
                "a vector for each direction is expected",
            ));
        }
        for k in 0..n {
            if (0..n).any(|j| j != k && all[n * k + j] != 0.0) || all[n * k] < 0.0 {
                let remedy = "resample the image so that its directions are the axes";
                return Err(Wrong::new("`space directions`", format!("`{list}`"), remedy));
            }
            spacing[k] = all[n * k + k];
        }
    }
    let origin = match field("space origin") {
        Some(list) => numbers("`space origin`", &list)?,
        None => spacing.iter().map(|h| 0.5 * h).collect(),
    };
    check_geometry(n, &spacing, &origin)?;
    let data_file = field("data file").or_else(|| field("datafile"));
    Ok(Header { count, spacing, origin, number, endian, data_start: end, data_file })
}

/// # Errors
/// Spacings that are not positive, or another number of them than directions.
pub(super) fn check_geometry(n: usize, spacing: &[f64], origin: &[f64]) -> Result<(), Wrong> {
    if spacing.len() != n || spacing.iter().any(|h| !(*h > 0.0 && h.is_finite())) {
        return Err(Wrong::new(
            "the spacing",
            format!("{spacing:?}"),
            "a positive number for each direction is expected",
        ));
    }
    if origin.len() != n || origin.iter().any(|x| !x.is_finite()) {
        return Err(Wrong::new("the origin", format!("{origin:?}"), "a number for each direction is expected"));
    }
    Ok(())
}
