#![no_main]
use libfuzzer_sys::fuzz_target;
use signorini_geometry::Point;
use signorini_geometry::rigid_shape::RigidShape;
use signorini_geometry::similarity::Similarity;
use signorini_import::step::{Pick, StepFile};

fuzz_target!(|bytes: &[u8]| {
    let Ok(file) = StepFile::new(bytes) else { return };
    for (_, solid) in file.solids(&Pick::All, &Similarity::scaling(1.0)).unwrap_or_default() {
        assert!(!solid.gap(&Point::<3>::new(0.3, 0.2, 0.1)).gap.is_nan());
    }
});
