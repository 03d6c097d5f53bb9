//! NIfTI-1 images in one file, also packed by gzip.

use super::{Endian, ImageData, Number, Wrong, check_counts, unpacked};

/// Bytes of the header, and of the mark of extensions behind it.
const HEADER: usize = 352;

/// The image, its directions along the axes.
///
/// # Errors
/// Bytes that are not such an image; directions that are not along the axes.
pub fn parse(bytes: &[u8]) -> Result<ImageData, Wrong> {
    if bytes.starts_with(&[0x1f, 0x8b]) {
        let header = Header::new(&unpacked(bytes, HEADER)?)?;
        return header.image(&unpacked(bytes, header.end())?);
    }
    Header::new(bytes)?.image(bytes)
}

struct Header {
    bytes: Vec<u8>,
    endian: Endian,
    count: Vec<usize>,
    number: Number,
    /// Where the numbers begin.
    start: usize,
}

impl Header {
    fn new(bytes: &[u8]) -> Result<Self, Wrong> {
        if bytes.len() < HEADER || &bytes[344..347] != b"n+1" {
            return Err(Wrong::new(
                "the mark at byte 344",
                "not `n+1`",
                "the file must be a NIfTI-1 image in one file",
            ));
        }
        let endian = match [bytes[0], bytes[1], bytes[2], bytes[3]] {
            b if i32::from_le_bytes(b) == 348 => Endian::Little,
            b if i32::from_be_bytes(b) == 348 => Endian::Big,
            b => return Err(Wrong::new("the size of the header", i32::from_le_bytes(b), "348 is expected")),
        };
        let mut header =
            Header { bytes: bytes[..HEADER].to_vec(), endian, count: Vec::new(), number: Number::U8, start: 0 };
        let dimension = header.short(40);
        if !(1..=4).contains(&dimension) {
            return Err(Wrong::new("`dim[0]`", dimension, "one to four directions are expected"));
        }
        header.count = (0..dimension as usize).map(|k| header.short(42 + 2 * k).max(0) as usize).collect();
        check_counts("`dim`", &header.count)?;
        header.number = match header.short(70) {
            2 => Number::U8,
            4 => Number::I16,
            8 => Number::I32,
            16 => Number::F32,
            64 => Number::F64,
            256 => Number::I8,
            512 => Number::U16,
            768 => Number::U32,
            1024 => Number::I64,
            1280 => Number::U64,
            other => return Err(Wrong::new("`datatype`", other, "save it as 16-bit integers or 32-bit floats")),
        };
        let start = header.float(108);
        if !(352.0..1e9).contains(&start) {
            return Err(Wrong::new("`vox_offset`", start, "352 or more is expected"));
        }
        header.start = start as usize;
        Ok(header)
    }

    fn short(&self, at: usize) -> i16 {
        let b = [self.bytes[at], self.bytes[at + 1]];
        if self.endian == Endian::Little { i16::from_le_bytes(b) } else { i16::from_be_bytes(b) }
    }

    fn float(&self, at: usize) -> f64 {
        let b = [0, 1, 2, 3].map(|i| self.bytes[at + i]);
        f64::from(if self.endian == Endian::Little { f32::from_le_bytes(b) } else { f32::from_be_bytes(b) })
    }

    /// Where the numbers end.
    fn end(&self) -> usize {
        self.start.saturating_add(self.count.iter().product::<usize>().saturating_mul(self.number.bytes()))
    }

    fn image(&self, bytes: &[u8]) -> Result<ImageData, Wrong> {
        let mut values = self.number.decode(bytes.get(self.start..).unwrap_or_default(), self.endian, &self.count)?;
        let (slope, intercept) = (self.float(112), self.float(116));
        if slope != 0.0 && slope.is_finite() && intercept.is_finite() {
            values.iter_mut().for_each(|v| *v = slope * *v + intercept);
        }
        let n = self.count.len().min(3);
        let Some((place, [steps, first])) = self.frame() else {
            return Ok(ImageData::plain(self.count.clone(), values));
        };
        let steps: Vec<Vec<f64>> = (0..n).map(|k| (0..n).map(|a| steps[3 * k + a]).collect()).collect();
        ImageData::framed(place, self.count.clone(), &steps, &first[..n], values)
    }

    /// The steps of the three indices and the middle of the first voxel, by the affine map, the quaternion, or the extents of
    /// voxels alone; none where not even these are known.
    fn frame(&self) -> Option<(&'static str, [Vec<f64>; 2])> {
        let n = self.count.len().min(3);
        let size: Vec<f64> = (0..3).map(|k| if k < n { self.float(80 + 4 * k).abs() } else { 1.0 }).collect();
        if self.short(254) > 0 {
            let rows = |k: usize| (0..3).map(move |a| self.float(280 + 16 * a + 4 * k));
            return Some(("`srow`", [(0..3).flat_map(rows).collect(), rows(3).collect()]));
        }
        if size.iter().any(|h| !(*h > 0.0 && h.is_finite())) {
            return None;
        }
        if self.short(252) <= 0 {
            let steps = (0..9).map(|i| if i % 4 == 0 { size[i / 3] } else { 0.0 }).collect();
            return Some(("`pixdim`", [steps, size.iter().map(|h| 0.5 * h).collect()]));
        }
        let [b, c, d] = [256, 260, 264].map(|at| self.float(at));
        let a = (1.0 - b * b - c * c - d * d).max(0.0).sqrt();
        let turned = [
            [a * a + b * b - c * c - d * d, 2.0 * (b * c + a * d), 2.0 * (b * d - a * c)],
            [2.0 * (b * c - a * d), a * a + c * c - b * b - d * d, 2.0 * (c * d + a * b)],
            [2.0 * (b * d + a * c), 2.0 * (c * d - a * b), a * a + d * d - b * b - c * c],
        ];
        // The third index runs backwards where this is negative.
        let sign = if self.float(76) < 0.0 { -1.0 } else { 1.0 };
        let steps = (0..9).map(|i| turned[i / 3][i % 3] * size[i / 3] * if i < 6 { 1.0 } else { sign }).collect();
        Some(("`quatern`", [steps, [268, 272, 276].map(|at| self.float(at)).to_vec()]))
    }
}
