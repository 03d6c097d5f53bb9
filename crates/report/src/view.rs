//! From where a view is seen first, and how much it is magnified.

use crate::pieces::{Look, Piece};
use crate::scene::Scene;

/// Deflections of a membrane are drawn at least this high, as a part of its width.
const HIGH: f64 = 0.16;
/// Displacements that nothing stops are drawn at least this large, as a part of the extent of the bodies.
const VISIBLE: f64 = 0.05;

/// From where the parts are seen, and how much they are magnified.
pub fn view(scene: &mut Scene, frames: &[Vec<Piece>]) {
    let span: [f64; 3] = std::array::from_fn(|k| scene.high[k] - scene.low[k]);
    let longest = span.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let all = || frames.iter().flatten();
    let has = |look: Look| all().any(|p| p.look == look);
    let in_space = all().any(|p| p.look == Look::Rigid && p.topology.triangles.len() > 2);
    let is_flat = |k: usize| span[k] <= 1e-9 * longest && !in_space;
    let is_line = has(Look::Membrane) && all().all(|p| p.topology.triangles.is_empty());
    scene.plane = match () {
        () if is_line => "xz",
        () if is_flat(2) && !has(Look::Membrane) => "xy",
        () => "space",
    };
    let looks_down = all().filter(|p| p.look == Look::Contact).map(facing).sum::<f64>() < 0.0;
    scene.from = match scene.plane {
        "xy" => [0.0, 0.0, 1.0],
        "xz" => [0.0, -1.0, 0.0],
        _ if looks_down => [1.0, -1.6, -0.9],
        _ => [1.0, -1.6, 0.9],
    };
    (scene.magnified, scene.magnify) = if has(Look::Membrane) {
        ("deflections", round(HIGH * span[0].max(span[1]) / span[2]))
    } else if !(has(Look::Contact) || has(Look::Arrows) || has(Look::Rigid)) && has(Look::Solid) {
        let u = all().filter_map(|p| p.displacement.as_ref()).flatten();
        let largest = u.map(|u| u.iter().map(|c| c * c).sum::<f64>().sqrt()).fold(0.0, f64::max);
        ("displacements", round(VISIBLE * longest / largest))
    } else {
        ("nothing", 1.0)
    };
}

/// The area of a surface upwards, where it touches.
fn facing(piece: &Piece) -> f64 {
    let pressure = piece.fields.iter().find(|f| f.0 == "contact_pressure").map(|f| &f.1);
    let touches = |c: &[u32]| pressure.is_none_or(|p| c.iter().any(|&k| p[k as usize] > 0.0));
    let up = |c: &[u32]| {
        let [a, b, d] = [0, 1, 2].map(|k| piece.points[c[k] as usize]);
        (b[0] - a[0]) * (d[1] - a[1]) - (b[1] - a[1]) * (d[0] - a[0])
    };
    piece.topology.triangles.chunks_exact(3).filter(|c| touches(c)).map(up).sum()
}

/// The largest round number below a factor, at least one.
fn round(factor: f64) -> f64 {
    if !factor.is_finite() || factor < 1.5 {
        return 1.0;
    }
    let power = 10f64.powf(factor.log10().floor());
    [5.0, 2.0, 1.0].into_iter().map(|d| d * power).find(|m| *m <= factor).unwrap_or(1.0)
}
