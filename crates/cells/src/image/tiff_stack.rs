//! Grey pictures in one TIFF: each is a layer of voxels.

use super::{ImageData, Wrong};
use tiff::decoder::{Decoder, DecodingResult};

/// The layers of a file, the rows of each from its top on.
///
/// # Errors
/// Bytes that are no TIFF; layers in colour or of different sizes.
pub fn parse(bytes: &[u8]) -> Result<ImageData, Wrong> {
    let wrong = |e: tiff::TiffError| Wrong::new("the file", format!("no TIFF: {e}"), "save the layers as grey TIFF");
    let mut decoder = Decoder::new(std::io::Cursor::new(bytes)).map_err(wrong)?;
    let (width, height) = decoder.dimensions().map_err(wrong)?;
    let mut values = Vec::new();
    let mut layers = 0;
    loop {
        let size = decoder.dimensions().map_err(wrong)?;
        if size != (width, height) {
            let found = format!("{} x {}", size.0, size.1);
            return Err(Wrong::new(
                format!("layer {}", layers + 1),
                found,
                "all layers must have the size of the first",
            ));
        }
        let colour = decoder.colortype().map_err(wrong)?;
        if !matches!(colour, tiff::ColorType::Gray(_)) {
            return Err(Wrong::new(format!("layer {}", layers + 1), format!("{colour:?}"), "convert it to grey"));
        }
        match decoder.read_image().map_err(wrong)? {
            DecodingResult::U8(v) => values.extend(v.into_iter().map(f64::from)),
            DecodingResult::I8(v) => values.extend(v.into_iter().map(f64::from)),
            DecodingResult::U16(v) => values.extend(v.into_iter().map(f64::from)),
            DecodingResult::I16(v) => values.extend(v.into_iter().map(f64::from)),
            DecodingResult::U32(v) => values.extend(v.into_iter().map(f64::from)),
            DecodingResult::I32(v) => values.extend(v.into_iter().map(f64::from)),
            DecodingResult::F32(v) => values.extend(v.into_iter().map(f64::from)),
            DecodingResult::F64(v) => values.extend(v),
            _ => return Err(Wrong::new("the type", "not one of those known", "save integers of 16 bits or floats")),
        }
        layers += 1;
        if !decoder.more_images() {
            break;
        }
        decoder.next_image().map_err(wrong)?;
    }
    let count = vec![width as usize, height as usize, layers];
    if values.len() != count.iter().product::<usize>() {
        let found = format!("{} numbers for {count:?} voxels", values.len());
        return Err(Wrong::new("the data", found, "one grey number for each voxel is expected"));
    }
    Ok(ImageData::plain(count, values))
}
