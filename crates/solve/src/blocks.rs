//! Large matrices as sums of small dense ones, of cells and of contacts: products without a matrix.

use nalgebra::DMatrix;
use rayon::prelude::*;

/// One dense matrix: its unknowns, and its entries row by row. An unknown may be named twice; its entries add up.
pub struct Block<'a> {
    pub unknowns: Vec<u32>,
    pub entries: &'a [f64],
}

/// The sum of dense matrices. Unknowns that are not free have a row and a column of the identity.
pub struct BlockSum<'a> {
    blocks: Vec<Block<'a>>,
    free: Vec<bool>,
    /// Where the places of an unknown in the blocks begin in `places`; each is a block and a place in it.
    start: Vec<usize>,
    places: Vec<(u32, u32)>,
    /// First of the products of each block.
    first: Vec<usize>,
}

impl<'a> BlockSum<'a> {
    /// # Panics
    /// If an unknown is not below the number of `free`, or entries are not as many as the square of the unknowns.
    pub fn new(blocks: Vec<Block<'a>>, free: Vec<bool>) -> Self {
        let mut start = vec![0usize; free.len() + 1];
        let mut first = vec![0];
        for b in &blocks {
            assert_eq!(b.unknowns.len() * b.unknowns.len(), b.entries.len(), "a square matrix");
            b.unknowns.iter().for_each(|u| start[*u as usize + 1] += 1);
            first.push(first[first.len() - 1] + b.unknowns.len());
        }
        (0..free.len()).for_each(|u| start[u + 1] += start[u]);
        let mut fill = start.clone();
        let mut places = vec![(0, 0); start[free.len()]];
        for (number, b) in blocks.iter().enumerate() {
            for (place, u) in b.unknowns.iter().enumerate() {
                places[fill[*u as usize]] = (number as u32, place as u32);
                fill[*u as usize] += 1;
            }
        }
        BlockSum { blocks, free, start, places, first }
    }

    pub fn size(&self) -> usize {
        self.free.len()
    }

    pub fn free(&self) -> &[bool] {
        &self.free
    }

    /// `A x`.
    pub fn multiply(&self, x: &[f64]) -> Vec<f64> {
        self.product(x, &|u| if self.free[u] { x[u] } else { 0.0 }, &|u, sum| if self.free[u] { sum } else { x[u] })
    }

    /// The product with all rows and columns of the sum, those of unknowns that are not free too.
    pub fn multiply_all(&self, x: &[f64]) -> Vec<f64> {
        self.product(x, &|u| x[u], &|_, sum| sum)
    }

    fn product(
        &self,
        x: &[f64],
        take: &(dyn Fn(usize) -> f64 + Sync),
        give: &(dyn Fn(usize, f64) -> f64 + Sync),
    ) -> Vec<f64> {
        let mut products = vec![0.0; self.first[self.blocks.len()]];
        let mut parts: Vec<&mut [f64]> = Vec::with_capacity(self.blocks.len());
        let mut rest = &mut products[..];
        for b in &self.blocks {
            let (own, others) = rest.split_at_mut(b.unknowns.len());
            parts.push(own);
            rest = others;
        }
        (self.blocks.par_iter().zip(parts)).for_each(|(b, out)| {
            let own: Vec<f64> = b.unknowns.iter().map(|u| take(*u as usize)).collect();
            for (row, out) in b.entries.chunks_exact(own.len().max(1)).zip(out) {
                *out = dot(row, &own);
            }
        });
        (0..x.len())
            .into_par_iter()
            .with_min_len(4096)
            .map(|u| {
                let list = &self.places[self.start[u]..self.start[u + 1]];
                let sum = list.iter().map(|(b, k)| products[self.first[*b as usize] + *k as usize]).sum();
                give(u, sum)
            })
            .collect()
    }

    /// The part of some free unknowns, each named once, made symmetric. `place` is room for as many numbers as there are
    /// unknowns, all `u32::MAX`, and is left so.
    pub fn part(&self, unknowns: &[u32], place: &mut [u32]) -> DMatrix<f64> {
        let n = unknowns.len();
        let mut out = DMatrix::<f64>::zeros(n, n);
        unknowns.iter().enumerate().for_each(|(i, u)| place[*u as usize] = i as u32);
        for (i, u) in unknowns.iter().enumerate() {
            for (b, row) in &self.places[self.start[*u as usize]..self.start[*u as usize + 1]] {
                let block = &self.blocks[*b as usize];
                let own = block.unknowns.len();
                let row = &block.entries[*row as usize * own..(*row as usize + 1) * own];
                for (v, value) in block.unknowns.iter().zip(row) {
                    let j = place[*v as usize];
                    if j != u32::MAX {
                        out[(i, j as usize)] += value;
                    }
                }
            }
        }
        unknowns.iter().for_each(|u| place[*u as usize] = u32::MAX);
        for i in 0..n {
            for j in 0..i {
                let mean = 0.5 * (out[(i, j)] + out[(j, i)]);
                (out[(i, j)], out[(j, i)]) = (mean, mean);
            }
        }
        out
    }

    pub fn blocks(&self) -> &[Block<'a>] {
        &self.blocks
    }
}

/// A scalar product in four sums, always in the same order.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (a4, b4) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest: f64 = a4.remainder().iter().zip(b4.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in a4.zip(b4) {
        (0..4).for_each(|k| sums[k] += a[k] * b[k]);
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_and_parts_are_those_of_the_sum() {
        let (a, b) = ([2.0, -1.0, -1.0, 2.0], [1.0, 0.5, 0.25, 3.0, 1.0, 0.0, 2.0, 0.0, 1.0]);
        let blocks =
            || vec![Block { unknowns: vec![0, 1], entries: &a }, Block { unknowns: vec![1, 2, 1], entries: &b }];
        let mut dense = DMatrix::<f64>::zeros(4, 4);
        for block in blocks() {
            let n = block.unknowns.len();
            for i in 0..n {
                for j in 0..n {
                    dense[(block.unknowns[i] as usize, block.unknowns[j] as usize)] += block.entries[i * n + j];
                }
            }
        }
        let x = [1.0, -2.0, 0.5, 4.0];
        let all = BlockSum::new(blocks(), vec![true; 4]);
        let expected = &dense * nalgebra::DVector::from_row_slice(&x);
        assert_eq!(all.multiply(&x), expected.as_slice());
        let some = BlockSum::new(blocks(), vec![true, true, false, false]);
        let y = some.multiply(&x);
        assert_eq!([y[2], y[3]], [0.5, 4.0]);
        assert!((y[1] - (dense[(1, 0)] * x[0] + dense[(1, 1)] * x[1])).abs() < 1e-15);
        let mut place = vec![u32::MAX; 4];
        let part = all.part(&[2, 1], &mut place);
        assert_eq!(part[(0, 0)], dense[(2, 2)]);
        assert!((part[(0, 1)] - 0.5 * (dense[(1, 2)] + dense[(2, 1)])).abs() < 1e-15);
        assert_eq!(place, [u32::MAX; 4]);
    }
}
