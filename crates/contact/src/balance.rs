//! Whether contact can hold free bodies against their loads: non-negative least squares.
//!
//! The contact forces `Gᵀλ`, `λ ≥ 0`, on the free rigid motions of all bodies can balance the loads `b` on these exactly if
//! the least of `|b + Gᵀλ|` is zero. Otherwise what is left, `r`, is itself a motion that closes no gap, `G r ≥ 0`, on which
//! the loads work, `b·r = |r|² > 0`: the bodies fly away along it (the lemma of Farkas).

use nalgebra::{DMatrix, DVector};

/// The part of the loads that no contact forces balance (Lawson & Hanson 1974, algorithm NNLS).
///
/// `rows` holds, for each contact condition, the change of its gap under each free motion; `load` the work of the loads on
/// each. Zeros come back where the loads are balanced to `tolerance`, in the unit of `load`.
pub fn unbalanced(rows: &[Vec<f64>], load: &[f64], tolerance: f64) -> Vec<f64> {
    let m = load.len();
    let b = DVector::from_column_slice(load);
    // Rows of unit length: their pressures do not matter here.
    let rows: Vec<DVector<f64>> = (rows.iter())
        .map(|row| DVector::from_column_slice(row))
        .filter(|row| row.norm() > 0.0)
        .map(|row| row.normalize())
        .collect();
    let mut carrying: Vec<usize> = Vec::new();
    let mut pressure: Vec<f64> = Vec::new();
    let mut left = b.clone();
    // Each turn lowers what is left, so no set comes twice; the number of sets that are of use is small.
    for _ in 0..30 * (m + 1) {
        let size = left.norm();
        if size <= tolerance {
            return vec![0.0; m];
        }
        let closes = |k: &usize| rows[*k].dot(&left);
        let most = (0..rows.len()).filter(|k| !carrying.contains(k)).min_by(|a, b| closes(a).total_cmp(&closes(b)));
        let Some(most) = most.filter(|k| closes(k) < -1e-12 * size) else { return left.iter().copied().collect() };
        carrying.push(most);
        pressure.push(0.0);
        loop {
            let g = DMatrix::from_fn(m, carrying.len(), |i, k| rows[carrying[k]][i]);
            let Ok(wanted) = g.clone().svd(true, true).solve(&-&b, 1e-14) else { return vec![0.0; m] };
            // As far towards the least squares as no pressure turns negative; the one that stops the way leaves.
            let stop = (0..carrying.len())
                .filter(|&k| wanted[k] <= 0.0)
                .map(|k| (k, if pressure[k] > 0.0 { pressure[k] / (pressure[k] - wanted[k]) } else { 0.0 }))
                .min_by(|a, b| a.1.total_cmp(&b.1));
            let share = stop.map_or(1.0, |s| s.1);
            pressure.iter_mut().zip(wanted.iter()).for_each(|(p, w)| *p += share * (w - *p));
            let Some((stop, _)) = stop else {
                left = &b + &g * &wanted;
                break;
            };
            carrying.remove(stop);
            pressure.remove(stop);
        }
    }
    // Not told apart from balanced loads.
    vec![0.0; m]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_block_on_a_plane_is_held_pressed_down_inside_its_corners_only() {
        // Motions: up, and turned about the middle; gaps at the corners x = -1 and x = 1.
        let rows = [vec![1.0, -1.0], vec![1.0, 1.0]];
        assert_eq!(unbalanced(&rows, &[-1.0, 0.9], 1e-12), [0.0, 0.0]);
        let pulled = unbalanced(&rows, &[1.0, 0.0], 1e-12);
        assert!((pulled[0] - 1.0).abs() < 1e-15 && pulled[1].abs() < 1e-15);
        // A force beyond a corner turns the block about that corner.
        let tipped = unbalanced(&rows, &[-1.0, 1.5], 1e-12);
        assert!((tipped[0] - 0.25).abs() < 1e-15 && (tipped[1] - 0.25).abs() < 1e-15, "{tipped:?}");
    }

    proptest! {
        /// What is left closes no gap, and the loads work on it; else the loads are a sum of contact forces.
        #[test]
        fn what_is_left_is_a_way_out(
            rows in prop::collection::vec(prop::collection::vec(-1.0..1.0, 4), 1..30),
            load in prop::collection::vec(-1.0..1.0f64, 4),
        ) {
            let left = unbalanced(&rows, &load, 1e-9);
            let work = |row: &[f64]| row.iter().zip(&left).map(|(a, b)| a * b).sum::<f64>();
            let square = work(&left);
            prop_assert!((work(&load) - square).abs() <= 1e-12);
            prop_assert!(rows.iter().all(|row| work(row) >= -1e-10));
        }

        #[test]
        fn sums_of_contact_forces_are_balanced(
            rows in prop::collection::vec(prop::collection::vec(-1.0..1.0, 4), 1..30),
            pressure in prop::collection::vec(0.0..1.0f64, 30),
        ) {
            let load: Vec<f64> = (0..4).map(|i| -rows.iter().zip(&pressure).map(|(r, p)| r[i] * p).sum::<f64>()).collect();
            prop_assert_eq!(unbalanced(&rows, &load, 1e-9), [0.0; 4]);
        }
    }
}
