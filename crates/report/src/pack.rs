//! Arrays as short texts: 16 bits for a value, differences, compressed, base64. Each array is stored once.

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use serde::Serialize;
use std::collections::HashMap;
use std::io::Write as _;

/// Steps between the least and the largest value; the number above them stands for what is not a number.
const STEPS: f64 = 65534.0;
const NOTHING: u16 = u16::MAX;

/// An array as it stands in a page.
#[derive(Clone, Debug, Serialize)]
pub struct Packed {
    /// Number of entries.
    pub count: usize,
    /// Least and largest value of values; absent for numbers of points.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub range: Option<[f64; 2]>,
    /// Differences of entries as two bytes each, first all high bytes and then all low ones; of four bytes each where
    /// numbers of points need them.
    #[serde(skip_serializing_if = "is_two")]
    pub bytes: usize,
    pub data: String,
}

fn is_two(bytes: &usize) -> bool {
    *bytes == 2
}

/// The arrays of a page.
#[derive(Debug, Default, Serialize)]
#[serde(transparent)]
pub struct Arrays {
    list: Vec<Packed>,
    #[serde(skip)]
    known: HashMap<(Vec<u8>, [u64; 2]), usize>,
    /// What they take in the page.
    #[serde(skip)]
    size: usize,
}

impl Arrays {
    /// What they take in a page, in bytes.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Adds values within a range; returns their number.
    pub fn values(&mut self, values: &[f64], range: [f64; 2]) -> usize {
        let span = (range[1] - range[0]).max(f64::MIN_POSITIVE);
        let step = |v: &f64| {
            if !v.is_finite() {
                return NOTHING;
            }
            (((v - range[0]) / span).clamp(0.0, 1.0) * STEPS).round() as u16
        };
        let steps: Vec<u16> = values.iter().map(step).collect();
        let mut before = 0u16;
        let differences = steps.iter().map(|&v| {
            let difference = v.wrapping_sub(before);
            before = v;
            u32::from(difference)
        });
        self.add(&planes(differences.collect(), 2), values.len(), Some(range), 2)
    }

    /// Adds numbers of points; returns their number.
    pub fn numbers(&mut self, numbers: &[u32]) -> usize {
        let bytes = if numbers.iter().all(|&n| n <= u32::from(u16::MAX)) { 2 } else { 4 };
        let mut before = 0u32;
        let differences = numbers.iter().map(|&v| {
            let difference = v.wrapping_sub(before);
            before = v;
            difference
        });
        self.add(&planes(differences.collect(), bytes), numbers.len(), None, bytes)
    }

    fn add(&mut self, planes: &[u8], count: usize, range: Option<[f64; 2]>, bytes: usize) -> usize {
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::new(7));
        // Writing into memory does not fail.
        let _ = encoder.write_all(planes);
        let packed = encoder.finish().unwrap_or_default();
        let key = (packed, range.map_or([count as u64, bytes as u64], |r| r.map(f64::to_bits)));
        if let Some(&known) = self.known.get(&key) {
            return known;
        }
        let data = BASE64_STANDARD.encode(&key.0);
        self.size += data.len() + 80;
        self.known.insert(key, self.list.len());
        self.list.push(Packed { count, range, bytes, data });
        self.list.len() - 1
    }
}

/// The bytes of numbers, first the highest of all of them.
fn planes(numbers: Vec<u32>, bytes: usize) -> Vec<u8> {
    let of = |byte: usize| numbers.iter().map(move |n| (n >> (8 * byte)) as u8);
    (0..bytes).rev().flat_map(of).collect()
}
