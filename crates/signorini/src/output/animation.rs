//! Pictures in a row as GIF and WebP.

use super::OutputError;
use super::chart::failed;

/// A picture of a row: its pixels, three bytes each, and for how many milliseconds it is shown.
pub struct Shown {
    pub rgb: Vec<u8>,
    pub milliseconds: u16,
}

/// How carefully the colours of a GIF are chosen, from 1, the best, to 30: the usual compromise.
const SPEED: i32 = 10;

/// As a GIF that begins anew at its end, with a palette for every picture.
///
/// # Errors
/// Pictures wider or higher than a GIF can be.
pub fn gif(size: [u32; 2], shown: &[Shown]) -> Result<Vec<u8>, OutputError> {
    use rayon::prelude::*;
    let [width, height] = size.map(u16::try_from);
    let (Ok(width), Ok(height)) = (width, height) else { return Err(failed("a GIF has at most 65535 pixels a side")) };
    let frames: Vec<gif::Frame> = (shown.par_iter())
        .map(|shown| {
            let mut frame = gif::Frame::from_rgb_speed(width, height, &shown.rgb, SPEED);
            // In hundredths of a second.
            frame.delay = shown.milliseconds.div_ceil(10);
            frame
        })
        .collect();
    let mut bytes = Vec::new();
    let mut encoder = gif::Encoder::new(&mut bytes, width, height, &[]).map_err(failed)?;
    encoder.set_repeat(gif::Repeat::Infinite).map_err(failed)?;
    for frame in &frames {
        encoder.write_frame(frame).map_err(failed)?;
    }
    drop(encoder);
    Ok(bytes)
}

/// As a WebP without losses, that begins anew at its end.
///
/// # Errors
/// Pictures wider or higher than a WebP can be.
pub fn webp(size: [u32; 2], shown: &[Shown]) -> Result<Vec<u8>, OutputError> {
    use rayon::prelude::*;
    let [width, height] = size;
    let stills: Vec<Vec<u8>> = (shown.par_iter())
        .map(|shown| {
            let mut bytes = Vec::new();
            image_webp::WebPEncoder::new(&mut bytes)
                .encode(&shown.rgb, width, height, image_webp::ColorType::Rgb8)
                .map_err(failed)?;
            Ok(bytes)
        })
        .collect::<Result<_, OutputError>>()?;
    if let [still] = &stills[..] {
        return Ok(still.clone());
    }
    let three = |v: u32| v.to_le_bytes()[..3].to_vec();
    let side = |v: u32| three(v - 1);
    // The header says that there is an animation; it begins anew without end, on white.
    let mut body = b"WEBP".to_vec();
    chunk(&mut body, b"VP8X", &[vec![2, 0, 0, 0], side(width), side(height)].concat());
    chunk(&mut body, b"ANIM", &[255, 255, 255, 255, 0, 0]);
    for (still, shown) in stills.iter().zip(shown) {
        // A still is `RIFF`, its size, `WEBP` and one chunk with the picture, at the left and the top, without blending.
        let head = [three(0), three(0), side(width), side(height), three(u32::from(shown.milliseconds)), vec![2]];
        chunk(&mut body, b"ANMF", &[head.concat(), still[12..].to_vec()].concat());
    }
    let mut out = b"RIFF".to_vec();
    out.extend((body.len() as u32).to_le_bytes());
    out.extend(body);
    Ok(out)
}

/// Adds a chunk, to an even length.
fn chunk(out: &mut Vec<u8>, name: &[u8; 4], content: &[u8]) {
    out.extend(name);
    out.extend((content.len() as u32).to_le_bytes());
    out.extend(content);
    if content.len() % 2 == 1 {
        out.push(0);
    }
}
