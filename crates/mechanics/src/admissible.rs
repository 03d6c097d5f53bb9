//! What may move: the variations of all unknowns that supports admit, in coordinates of their own.
//!
//! Supports hold single unknowns, or couple several by equations `c·v = 0`. Each equation gives the unknown with its largest
//! term by the others (Gauss-Jordan), so that `v = T y` with the unknowns that are left as `y`.

use crate::system::Held;
use signorini_solve::general::Entries;
use std::collections::BTreeMap;

/// Term of an equation below which it says the same as those before it, relative to its largest.
const SAME: f64 = 1e-10;

/// The map `T` from the coordinates of what may move to all unknowns, row by row.
pub struct Admissible {
    /// By unknown: columns and entries.
    pub rows: Vec<Vec<(u32, f64)>>,
    pub columns: usize,
}

impl Admissible {
    /// Variations of `size` unknowns that the equations of supports admit.
    pub fn new(size: usize, single: &[Held], coupled: &[Held]) -> Self {
        let mut is_held = vec![false; size];
        single.iter().for_each(|h| is_held[h.constraint.terms[0].0 as usize] = true);
        // What is given by others: the unknown, and minus its equation without it.
        let mut given: BTreeMap<u32, BTreeMap<u32, f64>> = BTreeMap::new();
        for held in coupled {
            let mut row: BTreeMap<u32, f64> = BTreeMap::new();
            let largest = held.constraint.terms.iter().fold(0.0f64, |m, t| m.max(t.1.abs()));
            for &(unknown, factor) in held.constraint.terms.iter().filter(|t| !is_held[t.0 as usize]) {
                match given.get(&unknown) {
                    Some(by) => by.iter().for_each(|(u, f)| *row.entry(*u).or_default() += factor * f),
                    None => *row.entry(unknown).or_default() += factor,
                }
            }
            let pivot = row.iter().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())).map(|(u, f)| (*u, *f));
            let Some((unknown, factor)) = pivot.filter(|(_, f)| f.abs() > SAME * largest) else { continue };
            row.remove(&unknown);
            row.values_mut().for_each(|f| *f /= -factor);
            for by in given.values_mut() {
                if let Some(share) = by.remove(&unknown) {
                    row.iter().for_each(|(u, f)| *by.entry(*u).or_default() += share * f);
                }
            }
            given.insert(unknown, row);
        }
        let mut column = vec![None; size];
        let mut columns = 0;
        for u in (0..size).filter(|u| !is_held[*u] && !given.contains_key(&(*u as u32))) {
            column[u] = Some(columns as u32);
            columns += 1;
        }
        let rows = (0..size as u32)
            .map(|u| match (column[u as usize], given.get(&u)) {
                (Some(own), _) => vec![(own, 1.0)],
                (None, Some(by)) => by.iter().filter_map(|(v, f)| Some((column[*v as usize]?, *f))).collect(),
                (None, None) => Vec::new(),
            })
            .collect();
        Admissible { rows, columns }
    }

    /// Adds to `Tᵀ A T` what an entry of `A` is in it.
    pub fn add(&self, [i, j]: [usize; 2], value: f64, to: &mut Entries) {
        for (a, of_a) in &self.rows[i] {
            self.rows[j].iter().for_each(|(b, of_b)| to.add(*a, *b, of_a * of_b * value));
        }
    }

    /// `T y`.
    pub fn expand(&self, y: &[f64]) -> Vec<f64> {
        self.rows.iter().map(|row| row.iter().map(|(c, f)| f * y[*c as usize]).sum()).collect()
    }

    /// The coordinates `y` of an admissible `v = T y`.
    pub fn coordinates(&self, v: &dyn Fn(usize) -> f64) -> Vec<f64> {
        let mut y = vec![0.0; self.columns];
        for (unknown, row) in self.rows.iter().enumerate() {
            if let [(column, 1.0)] = row[..] {
                y[column as usize] = v(unknown);
            }
        }
        y
    }

    /// `Tᵀ v`.
    pub fn gather(&self, v: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.columns];
        for (row, v) in self.rows.iter().zip(v) {
            row.iter().for_each(|(c, f)| out[*c as usize] += f * v);
        }
        out
    }
}
