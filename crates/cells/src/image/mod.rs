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
use std::io::Read;
use std::path::Path;

/// An image that cannot be read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ImageError {
    #[error("{file}: {message}")]
    File { file: String, message: String },
    #[error("{file}: {wrong}")]
    Content { file: String, wrong: Wrong },
    #[error("{file}: the file extension is not one of {known}")]
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
    /// Extent of a voxel in each direction; empty where the file does not say.
    pub spacing: Vec<f64>,
    /// Corner of the first voxel; 0 where the file does not say.
    pub origin: Vec<f64>,
    pub values: Vec<f64>,
}

impl ImageData {
    /// An image of which nothing else is known, from the origin on.
    pub(crate) fn plain(count: Vec<usize>, values: Vec<f64>) -> Self {
        let n = count.len();
        ImageData { count, spacing: Vec::new(), origin: vec![0.0; n], values }
    }

    /// An image of which index `k` steps by `steps[k]` from the middle of the first voxel on, with its directions along the
    /// axes: mirrored and exchanged where the steps are. Further directions have one voxel.
    ///
    /// # Errors
    /// Steps that lie along no axis, two along the same one, or none.
    pub(crate) fn framed(
        place: &str,
        mut count: Vec<usize>,
        steps: &[Vec<f64>],
        first: &[f64],
        values: Vec<f64>,
    ) -> Result<Self, Wrong> {
        let n = steps.len();
        if count.iter().skip(n).any(|c| *c != 1) {
            let remedy = "a picture of one time and one number a voxel is expected";
            return Err(Wrong::new(place, format!("of {n} directions for {count:?} voxels"), remedy));
        }
        count.truncate(n);
        let mut of_axis = vec![None; n];
        for (k, step) in steps.iter().enumerate() {
            let axis = (0..n).fold(0, |a, b| if step[b].abs() > step[a].abs() { b } else { a });
            let off = (0..n).filter(|a| *a != axis).map(|a| step[a].abs()).fold(0.0, f64::max);
            if !(off <= TILT * step[axis].abs() && step[axis].is_finite()) || of_axis[axis].replace(k).is_some() {
                let remedy = "resample the image so that its directions are the axes";
                return Err(Wrong::new(place, format!("{steps:?}"), remedy));
            }
        }
        let of_axis: Vec<usize> = of_axis.into_iter().flatten().collect();
        let step: Vec<f64> = (0..n).map(|a| steps[of_axis[a]][a]).collect();
        let spacing: Vec<f64> = step.iter().map(|h| h.abs()).collect();
        let along: Vec<usize> = of_axis.iter().map(|k| count[*k]).collect();
        let low = |a: usize| first[a] + step[a].min(0.0) * (along[a] - 1) as f64 - 0.5 * spacing[a];
        let origin: Vec<f64> = (0..n).map(low).collect();
        check_geometry(n, &spacing, &origin)?;
        let mut stride = vec![1; n];
        (1..n).for_each(|k| stride[k] = stride[k - 1] * count[k - 1]);
        let is_in_order = (0..n).all(|a| of_axis[a] == a && step[a] > 0.0);
        let from = |mut index: usize| -> usize {
            let place = |a: usize| {
                let i = index % along[a];
                index /= along[a];
                stride[of_axis[a]] * if step[a] < 0.0 { along[a] - 1 - i } else { i }
            };
            (0..n).map(place).sum()
        };
        let values = if is_in_order { values } else { (0..values.len()).map(|i| values[from(i)]).collect() };
        Ok(ImageData { count: along, spacing, origin, values })
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
        let (Ok(spacing), true) =
            (<[f64; D]>::try_from(&self.spacing[..self.spacing.len().min(D)]), self.origin.len() >= D)
        else {
            let must = "the voxel size must be known";
            return Err(CellsError::Image { what: "an image", found: self.count, must });
        };
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
            return Err(Wrong::new("the data", found, "the file is truncated, or its header is wrong"));
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

const KNOWN: &str = ".npy, .nrrd, .nhdr, .mha, .mhd, .nii, .nii.gz, .tif, .tiff; a file of numbers alone needs their type \
    and counts";

const ENDINGS: [&str; 9] = ["npy", "nrrd", "nhdr", "mha", "mhd", "nii", "nii.gz", "tif", "tiff"];

/// A slope of a step against its axis that moves the end of a line of 500 voxels by a twentieth of one.
const TILT: f64 = 1e-4;

/// A byte of a stream of deflate makes at most so many.
const MOST_PACKED: usize = 1032;

fn ending(file: &str) -> String {
    let file = file.to_ascii_lowercase();
    let plain = file.strip_suffix(".gz");
    let last = plain.unwrap_or(&file).rsplit('.').next().unwrap_or_default();
    if plain.is_some() { format!("{last}.gz") } else { last.to_owned() }
}

/// Reads an image by the ending of its name.
///
/// # Errors
/// A file that cannot be read, or is not what its ending says. A folder is a stack of the TIFF in it.
pub fn read(path: &Path) -> Result<ImageData, ImageError> {
    let file = path.display().to_string();
    if path.is_dir() {
        return tiff_stack::of_folder(path);
    }
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
        "nii" | "nii.gz" => nifti::parse(bytes).map_err(content),
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

/// The first bytes of what is packed by gzip or zlib, at most so many.
///
/// # Errors
/// A stream that is damaged, or too short for as many bytes.
pub(crate) fn unpacked(packed: &[u8], most: usize) -> Result<Vec<u8>, Wrong> {
    let short = |found: usize| {
        let found = format!("compressed, {found} bytes instead of {most}");
        Wrong::new("the data", found, "the file is truncated, or its header is wrong")
    };
    // What no stream of this length can hold is not asked for.
    if most / MOST_PACKED > packed.len() {
        return Err(short(packed.len().saturating_mul(MOST_PACKED)));
    }
    let mut out = Vec::new();
    let read = if packed.starts_with(&[0x1f, 0x8b]) {
        flate2::read::MultiGzDecoder::new(packed).take(most as u64).read_to_end(&mut out)
    } else {
        flate2::read::ZlibDecoder::new(packed).take(most as u64).read_to_end(&mut out)
    };
    match read {
        Err(e) => Err(Wrong::new("the data", format!("compressed and damaged: {e}"), "save the image again")),
        Ok(n) if n < most => Err(short(n)),
        Ok(_) => Ok(out),
    }
}

/// # Errors
/// Spacings that are not positive, or another number of them than directions.
pub(crate) fn check_geometry(n: usize, spacing: &[f64], origin: &[f64]) -> Result<(), Wrong> {
    if spacing.len() != n || spacing.iter().any(|h| !(*h > 0.0 && h.is_finite())) {
        let remedy = "a positive number for each direction is expected";
        return Err(Wrong::new("the spacing", format!("{spacing:?}"), remedy));
    }
    if origin.len() != n || origin.iter().any(|x| !x.is_finite()) {
        return Err(Wrong::new("the origin", format!("{origin:?}"), "a number for each direction is expected"));
    }
    Ok(())
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
    if count.is_empty() || count.len() > 4 || total == Some(0) {
        return Err(Wrong::new(place, format!("{count:?}"), "one to four counts, none of them zero, are expected"));
    }
    if total.is_none_or(|n| n > 1 << 33) {
        return Err(Wrong::new(
            place,
            format!("{count:?}"),
            "the limit is 2^33 voxels; use a part of the image or a coarser one",
        ));
    }
    Ok(())
}
