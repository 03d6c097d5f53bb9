//! The stored pictures, within the page: what is seen without WebGL and in print.

use crate::folder::Results;
use crate::html::escaped;
use crate::naming::sentence;
use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;

/// What all pictures may take, in bytes before they become text.
const ROOM: usize = 900_000;
/// A single main picture may take this much: without it, nothing is seen without WebGL.
const MAIN: usize = 1_400_000;

/// A picture as HTML; the first is the main one.
pub struct Picture {
    pub html: String,
}

/// The pictures of a folder that find room, the main one first, and how many did not.
pub fn pictures(results: &Results) -> (Vec<Picture>, usize) {
    let folder = results.path.join("pictures");
    let mut files: Vec<(String, u64)> = (std::fs::read_dir(&folder).into_iter().flatten())
        .filter_map(|e| {
            let e = e.ok()?;
            Some((e.file_name().into_string().ok()?, e.metadata().ok()?.len()))
        })
        .filter(|(name, _)| name.ends_with(".png"))
        .collect();
    let first = results.summary().and_then(|s| s.first_picture.as_ref()).and_then(|p| p.rsplit('/').next());
    let alone = files.len() == 1;
    // A sheet of all pictures shows nothing more than they do; a film is heavy, and the view has the same states.
    let rank = |name: &str| match name {
        _ if Some(name) == first => 0,
        "scene.png" | "paths.png" | "fit.png" => 1,
        "pressure.png" => 2,
        "film.png" | "overview.png" => 9,
        _ => 3,
    };
    files.sort_by_key(|(name, _)| (rank(name), name.clone()));
    let (mut out, mut used, mut left) = (Vec::new(), 0, 0);
    for (name, size) in files {
        let size = size as usize;
        let is_main = out.is_empty() && size <= MAIN;
        if !is_main && (used + size > ROOM || (rank(&name) == 9 && !alone)) {
            left += usize::from(rank(&name) != 9);
            continue;
        }
        let Ok(bytes) = std::fs::read(folder.join(&name)) else { continue };
        used += bytes.len();
        let title = sentence(name.trim_end_matches(".png"));
        out.push(Picture {
            html: format!(
                "<figure><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"><figcaption>{0}</figcaption></figure>",
                escaped(&title),
                BASE64_STANDARD.encode(&bytes)
            ),
        });
    }
    (out, left)
}
