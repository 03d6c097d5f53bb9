//! Appended data in raw bytes, which are no XML: the same file with them in base64.
//!
//! ParaView writes its files this way. Each array has its offset from the underscore. Its block is a header of whole numbers and
//! bytes: without compression the count of bytes; with it the number of parts, their size, that of the last, and the compressed
//! size of each. In base64 the header of compressed data is encoded by itself.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

/// The file with its appended data in base64; as it is if it has none in raw bytes.
///
/// # Errors
/// In words: blocks beyond the end of the file, or without a place.
pub(super) fn in_base64(bytes: Vec<u8>) -> Result<Vec<u8>, String> {
    let Some(start) = find(&bytes, b"<AppendedData") else { return Ok(bytes) };
    let cut = || "its appended data are cut short".to_string();
    let tag = find(&bytes[start..], b">").map(|k| start + k + 1).ok_or_else(cut)?;
    let head = String::from_utf8_lossy(&bytes[start..tag]).replace('\'', "\"");
    if !head.contains("encoding=\"raw\"") {
        return Ok(bytes);
    }
    let first = find(&bytes[tag..], b"_").map(|k| tag + k + 1).ok_or_else(cut)?;
    let data = &bytes[first..];
    let text = std::str::from_utf8(&bytes[..start]).map_err(|e| e.to_string())?.replace('\'', "\"");
    let attribute = |tag: &str, name: &str| -> Option<String> {
        Some(tag.split_once(&format!(" {name}=\""))?.1.split_once('"')?.0.to_string())
    };
    let file = text.split_once("<VTKFile").and_then(|(_, rest)| rest.split_once('>')).map_or("", |(tag, _)| tag);
    let header = Header {
        size: if attribute(file, "header_type").as_deref() == Some("UInt64") { 8 } else { 4 },
        is_big: attribute(file, "byte_order").as_deref() == Some("BigEndian"),
        is_compressed: attribute(file, "compressor").is_some(),
    };
    let (mut out, mut appended) = (String::new(), String::new());
    let mut rest = text.as_str();
    while let Some(at) = rest.find("<DataArray") {
        let end = rest[at..].find('>').map(|k| at + k).ok_or_else(cut)?;
        let tag = &rest[at..end];
        out.push_str(&rest[..at]);
        match attribute(tag, "offset") {
            None => out.push_str(tag),
            Some(offset) => {
                let from: usize = offset.parse().map_err(|_| format!("the offset `{offset}` is no whole number"))?;
                let block = data.get(from..).ok_or_else(cut)?;
                out.push_str(
                    &tag.replace(&format!(" offset=\"{offset}\""), &format!(" offset=\"{}\"", appended.len())),
                );
                appended.push_str(&header.encoded(block).ok_or_else(cut)?);
            }
        }
        rest = &rest[end..];
    }
    out.push_str(rest);
    out.push_str("<AppendedData encoding=\"base64\">_");
    out.push_str(&appended);
    out.push_str("</AppendedData></VTKFile>");
    Ok(out.into_bytes())
}

fn find(bytes: &[u8], what: &[u8]) -> Option<usize> {
    bytes.windows(what.len()).position(|w| w == what)
}

/// The whole numbers at the start of a block.
struct Header {
    size: usize,
    is_big: bool,
    is_compressed: bool,
}

impl Header {
    fn number(&self, block: &[u8], place: usize) -> Option<usize> {
        let bytes = block.get(self.size.checked_mul(place)?..)?.get(..self.size)?;
        let fold = |sum: u64, byte: &u8| (sum << 8) | u64::from(*byte);
        let value = if self.is_big { bytes.iter().fold(0, fold) } else { bytes.iter().rev().fold(0, fold) };
        usize::try_from(value).ok()
    }

    /// A block in base64; `None` if it is cut short.
    fn encoded(&self, block: &[u8]) -> Option<String> {
        if !self.is_compressed {
            let length = self.size.checked_add(self.number(block, 0)?)?;
            return Some(STANDARD.encode(block.get(..length)?));
        }
        let parts = self.number(block, 0)?;
        let head = self.size.checked_mul(parts.checked_add(3)?)?;
        let mut length = 0usize;
        // The size of the block bounds the number of parts.
        block.get(..head)?;
        for part in 0..parts {
            length = length.checked_add(self.number(block, 3 + part)?)?;
        }
        let data = block.get(head..)?.get(..length)?;
        Some(STANDARD.encode(&block[..head]) + &STANDARD.encode(data))
    }
}
