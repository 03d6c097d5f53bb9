//! Grey pictures in one TIFF, or in all of a folder: each is a layer of voxels.

use super::{ImageData, ImageError, Wrong, ending};
use std::path::Path;
use tiff::decoder::{Decoder, DecodingResult};

/// The layers of all TIFF of a folder, in the order of their names, numbers in them by their size.
///
/// # Errors
/// A folder without any, or what [`parse`] says; layers of different sizes.
pub fn of_folder(folder: &Path) -> Result<ImageData, ImageError> {
    let file = folder.display().to_string();
    let told = |file: &str, e: std::io::Error| ImageError::File { file: file.to_string(), message: e.to_string() };
    let mut names = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(|e| told(&file, e))? {
        names.push(entry.map_err(|e| told(&file, e))?.file_name().to_string_lossy().into_owned());
    }
    names.retain(|name| matches!(ending(name).as_str(), "tif" | "tiff"));
    names.sort_by_cached_key(|name| in_parts(name));
    let mut stack: Option<ImageData> = None;
    for name in names {
        let bytes = std::fs::read(folder.join(&name)).map_err(|e| told(&name, e))?;
        let layers = parse(&bytes).map_err(|wrong| ImageError::Content { file: name.clone(), wrong })?;
        match &mut stack {
            None => stack = Some(layers),
            Some(stack) if stack.count[..2] == layers.count[..2] => {
                stack.count[2] += layers.count[2];
                stack.values.extend(layers.values);
            }
            Some(stack) => {
                let found = format!("{:?} for {:?}", &layers.count[..2], &stack.count[..2]);
                let wrong = Wrong::new("the size", found, "all layers must have the size of the first");
                return Err(ImageError::Content { file: name, wrong });
            }
        }
    }
    stack.ok_or_else(|| {
        let wrong =
            Wrong::new("the folder", "without any TIFF", "name the file, or a folder of layers as .tif or .tiff");
        ImageError::Content { file, wrong }
    })
}

/// A name as words and numbers in turn: `s10` follows `s9`.
fn in_parts(name: &str) -> Vec<(String, u128)> {
    let mut parts: Vec<(String, u128)> = vec![(String::new(), 0)];
    let mut in_number = false;
    for c in name.chars() {
        if in_number && !c.is_ascii_digit() {
            parts.push((String::new(), 0));
        }
        in_number = c.is_ascii_digit();
        if let Some((word, number)) = parts.last_mut() {
            match c.to_digit(10) {
                Some(digit) => *number = number.saturating_mul(10).saturating_add(digit.into()),
                None => word.push(c),
            }
        }
    }
    parts
}

/// The layers of a file, the rows of each from its top on.
///
/// # Errors
/// Bytes that are no TIFF; layers in colour or of different sizes.
pub fn parse(bytes: &[u8]) -> Result<ImageData, Wrong> {
    let wrong = |e: tiff::TiffError| Wrong::new("the file", format!("not a TIFF: {e}"), "save the layers as grey TIFF");
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
            _ => return Err(Wrong::new("the type", "not supported", "save integers of 16 bits or floats")),
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
