//! Images of voxels from files: NPY, raw numbers, NRRD, MetaImage, NIfTI and stacks of TIFF.
//!
//! Every parser takes bytes and gives the numbers with the first index running fastest, along x.

pub mod metaimage;
pub mod nifti;
pub mod npy;
pub mod nrrd;
pub mod raw;
pub mod tiff_stack;

use crate::error::CellsError;
use crate::voxels::Voxels;
use signorini_geometry::Point;
use std::path::Path;

/// An image that cannot be read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ImageError {
    #[error("{file}: {message}")]
    File { file: String, message: String },
    #[error("{file}: {wrong}")]
    Content { file: String, wrong: Wrong },
    #[error("{file}: the ending is not one of {known}")]
    Ending { file: String, known: &'static str },
}

/// What is wrong in the bytes of an image: where, what is there, and what would do.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{place} is {found}; {remedy}")]
pub struct Wrong {
    pub place: String,
    pub found: String,
    pub remedy: &'static str,
}

impl Wrong {
    pub(crate) fn new(place: impl Into<String>, found: impl std::fmt::Display, remedy: &'static str) -> Self {
        Wrong { place: place.into(), found: found.to_string(), remedy }
    }
}

/// Numbers of an image of any dimension, the first index running fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageData {
    pub count: Vec<usize>,
    /// Extent of a voxel in each direction; 1 where the file does not say.
    pub spacing: Vec<f64>,
    /// Corner of the first voxel; 0 where the file does not say.
    pub origin: Vec<f64>,
    pub values: Vec<f64>,
}

impl ImageData {
    /// An image with unit voxels from the origin on.
    pub(crate) fn plain(count: Vec<usize>, values: Vec<f64>) -> Self {
        let n = count.len();
        ImageData { count, spacing: vec![1.0; n], origin: vec![0.0; n], values }
    }

    /// The voxels of an image of the plane or of space.
    ///
    /// # Errors
    /// Another dimension.
    pub fn voxels<const D: usize>(mut self) -> Result<Voxels<D>, CellsError> {
        // A last direction with one voxel is none.
        while self.count.len() > D && self.count.last() == Some(&1) {
            self.count.pop();
        }
        let Ok(count) = <[usize; D]>::try_from(self.count.clone()) else {
            let must = "it must have as many directions as the body";
            return Err(CellsError::Image { what: "an image", found: self.count, must });
        };
        let spacing = std::array::from_fn(|k| self.spacing[k]);
        Voxels::new(Point::from_fn(|k, _| self.origin[k]), spacing, count, self.values)
    }
}

/// How a number is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Number {
    U8,
    I8,
    U16,
    I16,
    U32,
    I32,
    U64,
    I64,
    F32,
    F64,
}

/// The order of the bytes of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Endian {
    Little,
    Big,
}

impl Number {
    pub fn bytes(self) -> usize {
        match self {
            Number::U8 | Number::I8 => 1,
            Number::U16 | Number::I16 => 2,
            Number::U32 | Number::I32 | Number::F32 => 4,
            Number::U64 | Number::I64 | Number::F64 => 8,
        }
    }

    /// As many numbers as the counts say, from the start of some bytes.
    ///
    /// # Errors
    /// Fewer bytes than that.
    pub fn decode(self, bytes: &[u8], endian: Endian, count: &[usize]) -> Result<Vec<f64>, Wrong> {
        let wanted = count.iter().try_fold(self.bytes(), |n, c| n.checked_mul(*c));
        let Some(bytes) = wanted.and_then(|n| bytes.get(..n)) else {
            let found = format!("{} bytes for {count:?} numbers of {} bytes", bytes.len(), self.bytes());
            return Err(Wrong::new("the data", found, "the file is cut off, or its header is not its own"));
        };
        let one = |chunk: &[u8]| {
            // The value in the first bytes, lowest first.
            let mut b = [0u8; 8];
            let n = chunk.len();
            for (i, byte) in chunk.iter().enumerate() {
                b[if endian == Endian::Little { i } else { n - 1 - i }] = *byte;
            }
            let bits = u64::from_le_bytes(b);
            match self {
                Number::U8 | Number::U16 | Number::U32 | Number::U64 => bits as f64,
                Number::I8 => f64::from(bits as u8 as i8),
                Number::I16 => f64::from(bits as u16 as i16),
                Number::I32 => f64::from(bits as u32 as i32),
                Number::I64 => bits as i64 as f64,
                Number::F32 => f64::from(f32::from_bits(bits as u32)),
                Number::F64 => f64::from_bits(bits),
            }
        };
        Ok(bytes.chunks_exact(self.bytes()).map(one).collect())
    }
}

const KNOWN: &str = ".npy, .nrrd, .mha, .mhd, .nii, .tif, .tiff; numbers without a header need `read_raw`";

const ENDINGS: [&str; 8] = ["npy", "nrrd", "nhdr", "mha", "mhd", "nii", "tif", "tiff"];

fn ending(file: &str) -> String {
    file.rsplit('.').next().unwrap_or_default().to_ascii_lowercase()
}

/// Reads an image by the ending of its name.
///
/// # Errors
/// A file that cannot be read, or is not what its ending says.
pub fn read(path: &Path) -> Result<ImageData, ImageError> {
    let file = path.display().to_string();
    if !ENDINGS.contains(&ending(&file).as_str()) {
        return Err(ImageError::Ending { file, known: KNOWN });
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    let load = |name: &str| std::fs::read(folder.join(name)).map_err(|e| e.to_string());
    let first = std::fs::read(path).map_err(|e| ImageError::File { file: file.clone(), message: e.to_string() })?;
    read_with(&file, &first, &load)
}

/// Reads an image by the ending of its name from the bytes of its file; other files that it names are loaded by their names.
///
/// # Errors
/// As of [`read`].
pub fn read_with(
    file: &str,
    bytes: &[u8],
    load: &dyn Fn(&str) -> Result<Vec<u8>, String>,
) -> Result<ImageData, ImageError> {
    let beside = |name: &String| load(name).map_err(|message| ImageError::File { file: name.clone(), message });
    let content = |wrong: Wrong| ImageError::Content { file: file.to_string(), wrong };
    match ending(file).as_str() {
        "npy" => npy::parse(bytes).map_err(content),
        "nii" => nifti::parse(bytes).map_err(content),
        "tif" | "tiff" => tiff_stack::parse(bytes).map_err(content),
        "nrrd" | "nhdr" => {
            let header = nrrd::header(bytes).map_err(content)?;
            let data = match &header.data_file {
                Some(name) => beside(name)?,
                None => bytes.get(header.data_start..).unwrap_or_default().to_vec(),
            };
            header.decode(&data).map_err(content)
        }
        "mha" | "mhd" => {
            let header = metaimage::header(bytes).map_err(content)?;
            let data = match &header.data_file {
                Some(name) => beside(name)?,
                None => bytes.get(header.data_start..).unwrap_or_default().to_vec(),
            };
            header.decode(&data).map_err(content)
        }
        _ => Err(ImageError::Ending { file: file.to_string(), known: KNOWN }),
    }
}

/// Reads numbers without a header.
///
/// # Errors
/// A file that cannot be read or is too short.
pub fn read_raw(path: &Path, header: &raw::RawHeader) -> Result<ImageData, ImageError> {
    let file = path.display().to_string();
    let bytes = std::fs::read(path).map_err(|e| ImageError::File { file: file.clone(), message: e.to_string() })?;
    raw::parse(&bytes, header).map_err(|wrong| ImageError::Content { file, wrong })
}

/// A header of a few kilobytes in text, up to a limit.
pub(crate) fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Numbers between spaces, commas and brackets.
pub(crate) fn numbers<T: std::str::FromStr>(place: &str, text: &str) -> Result<Vec<T>, Wrong> {
    let parts = text.split(|c: char| c.is_whitespace() || "(),".contains(c)).filter(|p| !p.is_empty());
    parts.map(|p| p.parse().map_err(|_| Wrong::new(place, format!("`{p}`"), "numbers are expected here"))).collect()
}

/// # Errors
/// Counts of zero, or so many that memory cannot hold them.
pub(crate) fn check_counts(place: &str, count: &[usize]) -> Result<(), Wrong> {
    let total = count.iter().try_fold(1usize, |n, c| n.checked_mul(*c));
    if count.is_empty() || count.len() > 4 || total.is_none_or(|n| n == 0 || n > 1 << 33) {
        return Err(Wrong::new(place, format!("{count:?}"), "one to four counts, none of them zero, are expected"));
    }
    Ok(())
}

#[cfg(test)]
mod tests;
