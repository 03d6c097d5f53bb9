//! Images of arbitrary bytes in every format are read or refused in words, and become bodies or not.
#![no_main]

use libfuzzer_sys::fuzz_target;
use signorini_cells::image::read_with;

fuzz_target!(|data: &[u8]| {
    let Some((kind, bytes)) = data.split_first() else { return };
    let name = ["a.npy", "a.nrrd", "a.mha", "a.mhd", "a.nii", "a.tif"][usize::from(*kind) % 6];
    // What a header names beside itself is the same bytes.
    let beside = |_: &str| Ok(bytes.to_vec());
    if let Ok(image) = read_with(name, bytes, &beside) {
        assert_eq!(image.count.iter().product::<usize>(), image.values.len());
        if image.values.len() < 4096
            && let Ok(voxels) = image.voxels::<3>()
        {
            let _ = voxels.above(0.5, 1.0);
        }
    }
});
