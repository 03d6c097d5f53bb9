//! Nearly raw raster data: a header of lines `field: value`, and numbers.

use super::{Endian, ImageData, Number, Wrong, check_counts, check_geometry, numbers, text, unpacked};

/// How the numbers of a file are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Raw,
    Text,
    /// By gzip or zlib.
    Packed,
}

/// The header of an image.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    pub(super) count: Vec<usize>,
    /// The step of each index, where the file says it.
    pub(super) steps: Option<Vec<Vec<f64>>>,
    /// The middle of the first voxel; the first voxel begins at the origin, if left out.
    pub(super) first: Option<Vec<f64>>,
    pub(super) number: Number,
    pub(super) endian: Endian,
    pub(super) encoding: Encoding,
    /// Where the data begins, in this file or in another one.
    pub data_start: usize,
    pub data_file: Option<String>,
}

impl Header {
    /// The image of the header and its data.
    ///
    /// # Errors
    /// Too little data, or directions that are not along the axes.
    pub fn decode(&self, data: &[u8]) -> Result<ImageData, Wrong> {
        let count = self.count.clone();
        let values = match self.encoding {
            Encoding::Raw => self.number.decode(data, self.endian, &count)?,
            Encoding::Packed => {
                let wanted = count.iter().product::<usize>().saturating_mul(self.number.bytes());
                self.number.decode(&unpacked(data, wanted)?, self.endian, &count)?
            }
            Encoding::Text => {
                let values: Vec<f64> = numbers("the data", &text(data))?;
                if values.len() != count.iter().product::<usize>() {
                    let found = format!("{} numbers for {count:?} voxels", values.len());
                    return Err(Wrong::new("the data", found, "the file is truncated, or its header is wrong"));
                }
                values
            }
        };
        let Some(steps) = &self.steps else { return Ok(ImageData::plain(count, values)) };
        let half: Vec<f64> = (0..steps.len()).map(|a| 0.5 * steps.iter().map(|s| s[a].abs()).sum::<f64>()).collect();
        ImageData::framed("the frame", count, steps, self.first.as_ref().unwrap_or(&half), values)
    }
}

/// Steps along the axes.
pub(super) fn straight(spacing: &[f64]) -> Vec<Vec<f64>> {
    let n = spacing.len();
    (0..n).map(|k| (0..n).map(|a| if a == k { spacing[k] } else { 0.0 }).collect()).collect()
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
        "ulonglong" | "unsigned long long" | "unsigned long long int" | "uint64" | "uint64_t" => Number::U64,
        "longlong" | "long long" | "long long int" | "signed long long" | "int64" | "int64_t" => Number::I64,
        "float" => Number::F32,
        "double" => Number::F64,
        _ => return Err(Wrong::new("`type`", format!("`{kind}`"), "an integer or floating-point type is expected")),
    };
    let encoding = needed("encoding")?;
    let encoding = match encoding.to_ascii_lowercase().as_str() {
        "raw" => Encoding::Raw,
        "gzip" | "gz" => Encoding::Packed,
        "text" | "txt" | "ascii" => Encoding::Text,
        other => {
            return Err(Wrong::new("`encoding`", format!("`{other}`"), "save it with the encoding `raw` or `gzip`"));
        }
    };
    for key in ["line skip", "lineskip", "byte skip", "byteskip"] {
        if let Some(skip) = field(key).filter(|v| v != "0") {
            return Err(Wrong::new(format!("`{key}`"), format!("`{skip}`"), "save the image without it"));
        }
    }
    let endian =
        if field("endian").is_some_and(|e| e.eq_ignore_ascii_case("big")) { Endian::Big } else { Endian::Little };
    let n = count.len();
    if let Some(dimension) = field("dimension").filter(|d| *d != n.to_string()) {
        let remedy = "as many sizes as directions are expected";
        return Err(Wrong::new("`dimension`", format!("{dimension} for the sizes {count:?}"), remedy));
    }
    let steps = if let Some(list) = field("spacings") {
        let spacing: Vec<f64> = numbers("`spacings`", &list)?;
        check_geometry(n, &spacing, &vec![0.0; n])?;
        Some(straight(&spacing))
    } else if let Some(list) = field("space directions") {
        let all: Vec<f64> = numbers("`space directions`", &list)?;
        if all.len() != n * n {
            let remedy = "a vector for each direction is expected";
            return Err(Wrong::new("`space directions`", format!("`{list}`"), remedy));
        }
        Some(all.chunks(n).map(<[f64]>::to_vec).collect())
    } else {
        None
    };
    let first = field("space origin").map(|list| numbers("`space origin`", &list)).transpose()?;
    if let Some(first) = &first {
        check_geometry(n, &vec![1.0; n], first)?;
    }
    let data_file = field("data file").or_else(|| field("datafile"));
    Ok(Header { count, steps, first, number, endian, encoding, data_start: end, data_file })
}
