//! Outlines and pressures as CSV.

use crate::snapshot::Snapshot;
use signorini_geometry::Point;

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

/// Both ends of every piece of the outlines of a contact zone, where it is now; in the plane an end of the zone.
pub fn zone_outline(pieces: &[[Point<3>; 2]], in_space: bool) -> String {
    let dimension = if in_space { 3 } else { 2 };
    let mut text = format!("piece,{}\n", ["x", "y", "z"][..dimension].join(","));
    for (k, ends) in pieces.iter().enumerate() {
        for x in &ends[..dimension - 1] {
            let x: Vec<String> = x.iter().take(dimension).map(|v| format!("{v:.15e}")).collect();
            text += &format!("{k},{}\n", x.join(","));
        }
    }
    text
}
