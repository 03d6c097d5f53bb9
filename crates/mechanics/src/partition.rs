//! Parts of a set of points by recursive coordinate bisection (Berger & Bokhari 1987): each cut is across the longest side of the
//! box of the points, and leaves points on both sides in proportion to the parts there.

/// The number of the part of each point. The counts of two parts differ by as little as the sizes of the cuts allow; the same points
/// give the same parts.
pub fn bisected(points: &[[f64; 3]], parts: usize) -> Vec<u32> {
    let mut out = vec![0; points.len()];
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    bisect(points, &mut order, (0, parts.max(1)), &mut out);
    out
}

fn bisect(points: &[[f64; 3]], own: &mut [u32], (first, parts): (usize, usize), out: &mut [u32]) {
    if parts == 1 {
        own.iter().for_each(|k| out[*k as usize] = first as u32);
        return;
    }
    let extent = |axis: usize| {
        let along = own.iter().map(|k| points[*k as usize][axis]);
        let (low, high) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        high - low
    };
    // Of sides that are equally long the first.
    let axis = (1..3).fold(0, |best, axis| if extent(axis) > extent(best) { axis } else { best });
    let before = |a: &u32, b: &u32| points[*a as usize][axis].total_cmp(&points[*b as usize][axis]).then(a.cmp(b));
    let lower = parts / 2;
    let cut = own.len() * lower / parts;
    if cut > 0 && cut < own.len() {
        own.select_nth_unstable_by(cut, before);
    }
    let (below, above) = own.split_at_mut(cut);
    bisect(points, below, (first, lower), out);
    bisect(points, above, (first + lower, parts - lower), out);
}
