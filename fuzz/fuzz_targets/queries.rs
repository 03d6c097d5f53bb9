#![no_main]
use libfuzzer_sys::fuzz_target;
use signorini::queries::{Query, parse};
use signorini_geometry::closest::closest;
use std::path::Path;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(query) = parse(bytes, Path::new("")) {
        assert!(!closest(&query.a, &query.b, &Query::default()).distance().is_nan());
    }
});
