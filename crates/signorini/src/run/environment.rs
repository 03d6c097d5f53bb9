//! What may differ between two runs of one case: time, memory, version.

use crate::report::Environment;

/// The `environment` of a summary: of a run since its start, of a case with a text, whose states took so long to check.
pub fn describe(start: std::time::Instant, threads: usize, (text, audit_seconds): (&str, f64)) -> Environment {
    Environment {
        version: env!("CARGO_PKG_VERSION").into(),
        wall_seconds: start.elapsed().as_secs_f64(),
        cpu_seconds: cpu_seconds(),
        peak_memory: peak_memory(),
        estimated_memory: None,
        threads,
        audit_seconds,
        input_hash: format!("{:016x}", fnv1a(text.as_bytes())),
    }
}

/// User and system time of the process, where the system tells.
fn cpu_seconds() -> Option<f64> {
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    // Fields 14 and 15 count ticks of 10 ms; the name before them may hold spaces, but ends with a parenthesis.
    let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks = fields.get(11)?.parse::<f64>().ok()? + fields.get(12)?.parse::<f64>().ok()?;
    Some(ticks / 100.0)
}

/// Largest resident memory in bytes, where the system tells.
fn peak_memory() -> Option<u64> {
    status("VmHWM:")
}

/// Resident memory in bytes, where the system tells.
#[cfg(feature = "petsc")]
pub fn resident_memory() -> Option<u64> {
    status("VmRSS:")
}

/// A number of bytes of the process, by its name.
fn status(name: &str) -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|l| l.strip_prefix(name))?;
    line.trim().trim_end_matches("kB").trim().parse::<u64>().ok().map(|k| k * 1024)
}

/// The 64-bit FNV-1a hash, the same on every machine.
pub fn fnv1a(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |h, b| (h ^ u64::from(*b)).wrapping_mul(0x100_0000_01b3))
}
