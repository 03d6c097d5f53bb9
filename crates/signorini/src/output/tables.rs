//! Outlines and pressures as CSV.

use crate::snapshot::Snapshot;

/// Front number and coordinates of every point of the outlines.
pub fn outlines<const D: usize>(s: &Snapshot<D>) -> String {
    let mut text = String::from(if D == 1 { "front,x\n" } else { "front,x,y\n" });
    for (i, outline) in s.outlines.iter().enumerate() {
        for p in outline {
            let x: Vec<String> = p.iter().map(|v| format!("{v:.15e}")).collect();
            text += &format!("{i},{}\n", x.join(","));
        }
    }
    text
}
