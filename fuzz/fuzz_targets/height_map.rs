//! Height maps of arbitrary bytes, as CSV, NPY or TIFF, are read or refused in words.
#![no_main]

use libfuzzer_sys::fuzz_target;
use std::path::Path;

fuzz_target!(|data: &[u8]| {
    let Some((kind, bytes)) = data.split_first() else { return };
    let name = ["heights.csv", "heights.npy", "heights.tif"][usize::from(*kind) % 3];
    if let Ok(map) = signorini::height_map::read(Path::new(name), bytes, [0.0; 2], [1.0, 0.5], 2.0) {
        let [low, high] = map.bounds();
        for x in [low, high, [-1e300, 1e300]] {
            let _ = signorini::relief::Relief::jet(&map, &x.into());
        }
    }
});
