#![no_main]
use libfuzzer_sys::fuzz_target;
use signorini::case::Document;

fuzz_target!(|text: &str| {
    if let Ok(document) = Document::parse("case.toml", text, &[]) {
        let _ = signorini::plan::plan(&document);
    }
});
