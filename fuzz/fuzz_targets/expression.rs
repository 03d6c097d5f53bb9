#![no_main]
use libfuzzer_sys::fuzz_target;
use signorini::expression::{Names, Scope, parse};

fuzz_target!(|text: &str| {
    let names = Names { variables: vec!["x", "y", "z", "t"], ..Names::default() };
    if let Ok(expression) = parse(text, &names) {
        let _: f64 = expression.evaluate(&Scope { position: [0.3, -0.2, 0.1], time: 0.5 });
    }
});
