//! Closest points of an ellipse or ellipsoid by one scalar equation.
//!
//! Lagrange's condition gives `y_i = a_i² x_i / (t + a_i²)` with `Σ (a_i x_i / (t + a_i²))² = 1` (Eberly 2013). In the
//! first octant the largest root belongs to the closest point; Newton from below approaches it monotonically, since
//! the function is convex and decreasing there.

/// Every closest point of `x` on `Σ (y_i / a_i)² = 1`; `None` where they form a continuum.
pub fn closest<const K: usize>(a: &[f64; K], x: &[f64; K]) -> Option<Vec<[f64; K]>> {
    let scale = a.iter().fold(0.0f64, |m, v| m.max(*v));
    let least = a.iter().fold(f64::INFINITY, |m, v| m.min(*v));
    let noise = 4.0 * f64::EPSILON * scale;
    let magnitude = x.map(|v| if v.abs() <= noise { 0.0 } else { v.abs() });
    let short: Vec<usize> = (0..K).filter(|&k| a[k] - least <= noise).collect();
    if short.iter().all(|&k| magnitude[k] == 0.0) {
        // In the symmetry plane across the shortest axis: perhaps above the focal set, where the foot leaves it.
        let mut y = [0.0; K];
        let mut sum = 0.0;
        for k in 0..K {
            if !short.contains(&k) {
                y[k] = a[k] * a[k] * x[k] / ((a[k] - least) * (a[k] + least));
                sum += (y[k] / a[k]).powi(2);
            }
        }
        if sum < 1.0 {
            if short.len() > 1 {
                return None;
            }
            let k = short[0];
            let height = least * (1.0 - sum).sqrt();
            let (mut up, mut down) = (y, y);
            up[k] = height;
            down[k] = -height;
            return Some(vec![up, down]);
        }
    }
    // With `s = t + least²` nothing cancels near the centre.
    let beyond = a.map(|v| (v - least) * (v + least));
    let term = |s: f64, k: usize| a[k] * magnitude[k] / (s + beyond[k]);
    let mut s = f64::NEG_INFINITY;
    for k in 0..K {
        if magnitude[k] > 0.0 {
            s = s.max(a[k] * magnitude[k] - beyond[k]);
        }
    }
    for _ in 0..60 {
        let (mut value, mut slope) = (-1.0, 0.0);
        for k in 0..K {
            if magnitude[k] > 0.0 {
                let q = term(s, k);
                value += q * q;
                slope -= 2.0 * q * q / (s + beyond[k]);
            }
        }
        let next = s - value / slope;
        // Rounding ends the monotone approach.
        if next <= s || !next.is_finite() {
            break;
        }
        s = next;
    }
    let mut y = [0.0; K];
    for k in 0..K {
        if magnitude[k] > 0.0 {
            y[k] = a[k] * a[k] * x[k] / (s + beyond[k]);
        }
    }
    Some(vec![y])
}

/// The smaller of `1 - d κ` at a closest point `y` of an ellipsoid to `x`, from the Hessian of the level function in
/// the tangent plane.
pub fn lambda_min(a: &[f64; 3], y: &[f64; 3], x: &[f64; 3]) -> f64 {
    use crate::Vector;
    let gradient = Vector::<3>::from_fn(|k, _| y[k] / (a[k] * a[k]));
    let length = gradient.norm();
    let n = gradient / length;
    let gap: f64 = (0..3).map(|k| (x[k] - y[k]) * n[k]).sum();
    let first = n.cross(&Vector::<3>::ith(n.iamin(), 1.0)).normalize();
    let second = n.cross(&first);
    let shape = |p: &Vector<3>, q: &Vector<3>| (0..3).map(|k| p[k] * q[k] / (a[k] * a[k])).sum::<f64>() / length;
    let (p, q, r) = (shape(&first, &first), shape(&first, &second), shape(&second, &second));
    let (mean, spread) = (0.5 * (p + r), (0.5 * (p - r)).hypot(q));
    // Outside (gap > 0) a convex surface is always in its projection domain.
    (1.0 + gap * (mean - spread)).min(1.0 + gap * (mean + spread))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn feet_satisfy_the_surface_and_the_normal() {
        let a = [2.0, 1.0, 0.5];
        for x in [[3.0, 0.2, 0.1], [0.1, 0.2, 0.3], [0.0, 2.0, 0.0], [0.5, -0.4, 0.0], [1e-9, 1e-9, 1e-9]] {
            for y in closest(&a, &x).unwrap() {
                let level: f64 = (0..3).map(|k| (y[k] / a[k]).powi(2)).sum();
                assert!((level - 1.0).abs() < 1e-14, "{x:?}: {level}");
                let n: [f64; 3] = std::array::from_fn(|k| y[k] / (a[k] * a[k]));
                let d: [f64; 3] = std::array::from_fn(|k| x[k] - y[k]);
                for (i, j) in [(0, 1), (1, 2), (2, 0)] {
                    assert!((n[i] * d[j] - n[j] * d[i]).abs() < 1e-13, "{x:?}");
                }
            }
        }
    }

    #[test]
    fn the_centre_has_two_feet_or_a_circle() {
        assert_eq!(closest(&[2.0, 1.0, 0.5], &[0.0; 3]).unwrap().len(), 2);
        assert!(closest(&[2.0, 1.0, 1.0], &[0.0; 3]).is_none());
    }
}
