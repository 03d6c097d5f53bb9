#![no_main]
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    if let Ok(problem) = signorini::case::read("case.toml", text, &[]) {
        let _ = signorini::plan::plan(&problem);
    }
});
