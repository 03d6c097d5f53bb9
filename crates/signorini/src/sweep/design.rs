//! Which values go together: the full grid, or a Latin hypercube.

use super::vary::{Setting, Variation};
use crate::problem::CaseError;
use serde::{Deserialize, Serialize};

/// The most rows of a sweep.
const MOST: usize = 1_000_000;

/// A sample of the ranges in place of a grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Sample {
    pub count: usize,
    pub seed: u64,
}

/// The rows of a sweep.
///
/// # Errors
/// A key that is varied twice, a range without its number of values, more rows than can be.
pub fn rows(vary: &[Variation], sample: Option<Sample>) -> Result<Vec<Vec<Setting>>, CaseError> {
    if vary.is_empty() {
        let help = "write  signorini sweep CASE --vary loads.press.normal=-0.1:-1:10";
        return Err(CaseError::new("nothing is varied").help(help));
    }
    if let Some((k, v)) = vary.iter().enumerate().find(|(k, v)| vary[..*k].iter().any(|w| w.key == v.key)) {
        let first = vary[..k].iter().find(|w| w.key == v.key).map_or("", |w| w.key.as_str());
        return Err(CaseError::new(format!("`{first}` is varied twice")).help("give all its values in one --vary"));
    }
    let rows = match sample {
        Some(Sample { count: 0, .. }) => {
            return Err(CaseError::new("a sample of 0 runs").help("give --sample 1 or more"));
        }
        Some(Sample { count, .. }) if count > MOST => return Err(too_many()),
        Some(sample) => latin_hypercube(vary, sample),
        None => {
            // Before any list is made: one number of values may be more than memory holds.
            let counts = vary.iter().map(Variation::count).collect::<Result<Vec<_>, _>>()?;
            let count = counts.iter().try_fold(1usize, |n, count| n.checked_mul(*count));
            if count.is_none_or(|n| n > MOST) {
                return Err(too_many());
            }
            let values = vary.iter().map(Variation::grid).collect::<Result<Vec<_>, _>>()?;
            grid(&values)
        }
    };
    Ok(rows)
}

fn too_many() -> CaseError {
    CaseError::new(format!("more than {MOST} runs")).help("vary fewer keys, or sample the ranges with --sample N")
}

/// All combinations, the last key changing fastest.
fn grid(values: &[Vec<Setting>]) -> Vec<Vec<Setting>> {
    values.iter().fold(vec![Vec::new()], |rows, list| {
        let extended = |row: &Vec<Setting>| {
            let row = row.clone();
            list.iter().map(move |v| row.iter().cloned().chain([v.clone()]).collect::<Vec<_>>()).collect::<Vec<_>>()
        };
        rows.iter().flat_map(extended).collect()
    })
}

/// As many rows as strata of every key, one value in each: the strata of keys are paired at random.
fn latin_hypercube(vary: &[Variation], Sample { count, seed }: Sample) -> Vec<Vec<Setting>> {
    let mut random = SplitMix(seed);
    let columns: Vec<Vec<Setting>> = vary
        .iter()
        .map(|variation| {
            let mut strata: Vec<usize> = (0..count).collect();
            for k in (1..count).rev() {
                strata.swap(k, (random.unit() * (k + 1) as f64) as usize);
            }
            strata.into_iter().map(|k| variation.at((k as f64 + random.unit()) / count as f64)).collect()
        })
        .collect();
    (0..count).map(|k| columns.iter().map(|column| column[k].clone()).collect()).collect()
}

/// Random numbers after Steele, Lea and Flood: the same on every machine.
struct SplitMix(u64);

impl SplitMix {
    /// A number in [0, 1).
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}
