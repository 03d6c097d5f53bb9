//! Times every class of a file of queries on one thread, shapes built beforehand:
//! `cargo run --release -p signorini --example time_queries -- queries.json`.

use serde_json::Value;
use signorini::queries::{Query, parse, scanner::Scanner};
use signorini_geometry::closest::closest;
use std::collections::BTreeMap;
use std::io::BufReader;
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).ok_or("give a file of queries")?;
    let folder = std::path::Path::new(&path).parent().ok_or("a file, not a folder")?;
    let mut scanner = Scanner::new(BufReader::new(std::fs::File::open(&path)?));
    let mut classes: BTreeMap<String, Vec<(f64, f64)>> = BTreeMap::new();
    while let Some(case) = scanner.next_case()? {
        let comments: Value = serde_json::from_slice(&case.text)?;
        let query = parse(&case.text, folder)?;
        let class = comments["class"].as_str().unwrap_or("all").to_string();
        let mut repetitions = 0;
        let mut pairs = 0;
        let start = Instant::now();
        while repetitions == 0 || start.elapsed().as_micros() < 3000 {
            pairs += closest(&query.a, &query.b, &Query::default()).effort;
            repetitions += 1;
        }
        let n = f64::from(repetitions);
        classes.entry(class).or_default().push((start.elapsed().as_secs_f64() / n, pairs as f64 / n));
    }
    for (class, times) in classes {
        let n = times.len() as f64;
        let mean = times.iter().map(|t| t.0).sum::<f64>() / n;
        let worst = times.iter().map(|t| t.0).fold(0.0, f64::max);
        let pairs = times.iter().map(|t| t.1).sum::<f64>() / n;
        println!(
            "{class:45} {n:4} {:>10.0}/s  mean {:>9.2} us  worst {:>9.2} us {pairs:>9.1} pairs",
            1.0 / mean,
            mean * 1e6,
            worst * 1e6
        );
    }
    Ok(())
}
