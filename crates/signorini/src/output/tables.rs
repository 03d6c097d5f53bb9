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

/// Position, pressure, gap and status of every pressure node of a contact.
pub fn pressure<const D: usize>(shown: &super::solid_fields::ContactDisplay<D>) -> String {
    let mut text = ["x", "y", "z"][..D].join(",") + ",pressure,gap,in_contact\n";
    for k in 0..shown.points.len() {
        let x: Vec<String> = shown.points[k].iter().map(|v| format!("{v:.15e}")).collect();
        text += &format!("{},{:e},{:e},{}\n", x.join(","), shown.pressure[k], shown.gap[k], u8::from(shown.active[k]));
    }
    text
}

/// Both ends of every piece of the outlines of a contact zone, where it is now; in the plane an end of the zone.
pub fn solid_outline<const D: usize>(pieces: &[[signorini_geometry::Point<D>; 2]]) -> String {
    let mut text = format!("piece,{}\n", ["x", "y", "z"][..D].join(","));
    for (k, ends) in pieces.iter().enumerate() {
        for x in &ends[..if D == 2 { 1 } else { 2 }] {
            let x: Vec<String> = x.iter().map(|v| format!("{v:.15e}")).collect();
            text += &format!("{k},{}\n", x.join(","));
        }
    }
    text
}
