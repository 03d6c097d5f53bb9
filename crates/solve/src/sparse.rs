//! Symmetric sparse matrices, assembled from element matrices.

/// The lower triangle of a symmetric matrix in compressed columns.
#[derive(Clone, Debug, Default)]
pub struct SymmetricMatrix {
    pub(crate) column_start: Vec<usize>,
    pub(crate) row: Vec<usize>,
    pub(crate) value: Vec<f64>,
}

impl SymmetricMatrix {
    /// A zero matrix of size `n` whose pattern couples all unknowns within each clique (the unknowns of an element).
    pub fn from_cliques<C: AsRef<[u32]>>(n: usize, cliques: &[C]) -> Self {
        // Cliques of each unknown, in compressed rows.
        let mut start = vec![0usize; n + 1];
        for &i in cliques.iter().flat_map(|clique| clique.as_ref()) {
            start[i as usize + 1] += 1;
        }
        for i in 0..n {
            start[i + 1] += start[i];
        }
        let mut fill = start.clone();
        let mut member = vec![0u32; start[n]];
        for (c, clique) in cliques.iter().enumerate() {
            for &i in clique.as_ref() {
                member[fill[i as usize]] = c as u32;
                fill[i as usize] += 1;
            }
        }
        let mut column_start = vec![0];
        let mut row = Vec::new();
        let mut seen = vec![usize::MAX; n];
        for j in 0..n {
            let begin = row.len();
            for &c in &member[start[j]..start[j + 1]] {
                for &i in cliques[c as usize].as_ref() {
                    let i = i as usize;
                    if i >= j && seen[i] != j {
                        seen[i] = j;
                        row.push(i);
                    }
                }
            }
            row[begin..].sort_unstable();
            column_start.push(row.len());
        }
        let value = vec![0.0; row.len()];
        Self { column_start, row, value }
    }

    /// The sum of symmetric row-major matrices of a few unknowns each.
    pub fn of_cliques(n: usize, cliques: &[(Vec<u32>, Vec<f64>)]) -> Self {
        let lists: Vec<&[u32]> = cliques.iter().map(|c| c.0.as_slice()).collect();
        let mut out = Self::from_cliques(n, &lists);
        cliques.iter().for_each(|(unknowns, values)| out.add(unknowns, values, 1.0));
        out
    }

    /// `Σ k b bᵀ` of rows `b`, each with its `k`.
    pub fn of_squares(n: usize, rows: &[(&[(u32, f64)], f64)]) -> Self {
        let mut of_unknown: Vec<Vec<(u32, f64)>> = vec![Vec::new(); n];
        for (r, (row, k)) in rows.iter().enumerate() {
            row.iter().for_each(|(j, c)| of_unknown[*j as usize].push((r as u32, k * c)));
        }
        let mut place = vec![usize::MAX; n];
        Self::from_columns(n, |j, out| {
            for (r, factor) in &of_unknown[j] {
                for (i, c) in rows[*r as usize].0.iter().filter(|(i, _)| *i as usize >= j) {
                    let i = *i as usize;
                    if place[i] == usize::MAX {
                        place[i] = out.len();
                        out.push((i, 0.0));
                    }
                    out[place[i]].1 += factor * c;
                }
            }
            out.iter().for_each(|(i, _)| place[*i] = usize::MAX);
        })
    }

    /// The matrix whose columns, from the diagonal down, `column` writes as pairs of row and entry in any order.
    pub fn from_columns(n: usize, mut column: impl FnMut(usize, &mut Vec<(usize, f64)>)) -> Self {
        let mut out = Self { column_start: vec![0], row: Vec::new(), value: Vec::new() };
        let mut entries = Vec::new();
        for j in 0..n {
            entries.clear();
            column(j, &mut entries);
            entries.sort_unstable_by_key(|e| e.0);
            for &(i, v) in &entries {
                out.row.push(i);
                out.value.push(v);
            }
            out.column_start.push(out.row.len());
        }
        out
    }

    /// Whole rows, of the unknowns that are wanted, each with its columns and entries.
    pub fn rows(&self, wanted: impl Fn(usize) -> bool) -> Vec<(usize, Vec<(usize, f64)>)> {
        let mut place = vec![usize::MAX; self.size()];
        let mut out: Vec<(usize, Vec<(usize, f64)>)> = Vec::new();
        for i in (0..self.size()).filter(|&i| wanted(i)) {
            place[i] = out.len();
            out.push((i, Vec::new()));
        }
        for j in 0..self.size() {
            for k in self.column_start[j]..self.column_start[j + 1] {
                let (i, v) = (self.row[k], self.value[k]);
                if place[i] != usize::MAX {
                    out[place[i]].1.push((j, v));
                }
                if i != j && place[j] != usize::MAX {
                    out[place[j]].1.push((i, v));
                }
            }
        }
        out
    }

    /// Number of unknowns.
    pub fn size(&self) -> usize {
        self.column_start.len().saturating_sub(1)
    }

    /// Adds `scale` times a symmetric row-major element matrix. Unknowns may be named twice; their entries add up.
    pub fn add(&mut self, unknowns: &[u32], matrix: &[f64], scale: f64) {
        let n = unknowns.len();
        for (b, &j) in unknowns.iter().enumerate() {
            let range = self.column_start[j as usize]..self.column_start[j as usize + 1];
            let rows = &self.row[range.clone()];
            for (a, &i) in unknowns.iter().enumerate() {
                if i >= j
                    && let Ok(at) = rows.binary_search(&(i as usize))
                {
                    self.value[range.start + at] += scale * matrix[a * n + b];
                }
            }
        }
    }

    /// The sum of two matrices of the same size, with the entries of both patterns.
    ///
    /// # Panics
    /// If their sizes differ.
    pub fn plus(&self, other: &Self) -> Self {
        assert_eq!(self.size(), other.size(), "matrices of one size");
        let mut out = Self { column_start: vec![0], row: Vec::new(), value: Vec::new() };
        for j in 0..self.size() {
            let [mut a, mut b] = [self, other].map(|m| (m.column_start[j]..m.column_start[j + 1]).peekable());
            loop {
                let next = [a.peek().map(|&k| self.row[k]), b.peek().map(|&k| other.row[k])];
                let Some(i) = next.into_iter().flatten().min() else { break };
                let of_a = a.next_if(|&k| self.row[k] == i).map_or(0.0, |k| self.value[k]);
                let of_b = b.next_if(|&k| other.row[k] == i).map_or(0.0, |k| other.value[k]);
                out.row.push(i);
                out.value.push(of_a + of_b);
            }
            out.column_start.push(out.row.len());
        }
        out
    }

    /// `Tᵀ A T` with the rows of `T` given as lists of columns and entries.
    pub fn transformed<'a>(&self, columns: usize, row: impl Fn(usize) -> &'a [(u32, f64)]) -> Self {
        let mut start = vec![0usize; columns + 1];
        let each = |visit: &mut dyn FnMut(usize, usize, f64)| {
            for j in 0..self.size() {
                let of_j = row(j);
                for k in self.column_start[j]..self.column_start[j + 1] {
                    let (i, value) = (self.row[k], self.value[k]);
                    for (a, ca) in row(i) {
                        for (b, cb) in of_j {
                            let twice = if i != j && a == b { 2.0 } else { 1.0 };
                            // The diagonal blocks come with both orders of a and b: one of them is kept.
                            if i == j && a < b {
                                continue;
                            }
                            visit((*a).max(*b) as usize, (*a).min(*b) as usize, twice * ca * cb * value);
                        }
                    }
                }
            }
        };
        each(&mut |_, b, _| start[b + 1] += 1);
        for b in 0..columns {
            start[b + 1] += start[b];
        }
        let mut fill = start.clone();
        let mut rows = vec![0usize; start[columns]];
        let mut values = vec![0.0; start[columns]];
        each(&mut |a, b, value| {
            (rows[fill[b]], values[fill[b]]) = (a, value);
            fill[b] += 1;
        });
        // Columns are sorted one by one, and what meets is added up on the way to the front.
        let mut column_start = vec![0];
        let mut end = 0;
        let mut list: Vec<(usize, f64)> = Vec::new();
        for b in 0..columns {
            list.clear();
            list.extend((start[b]..start[b + 1]).map(|k| (rows[k], values[k])));
            list.sort_by_key(|e| e.0);
            let first = end;
            for &(a, value) in &list {
                if end > first && rows[end - 1] == a {
                    values[end - 1] += value;
                } else {
                    (rows[end], values[end]) = (a, value);
                    end += 1;
                }
            }
            column_start.push(end);
        }
        rows.truncate(end);
        values.truncate(end);
        Self { column_start, row: rows, value: values }
    }

    /// The entries between some unknowns, in ascending order, one row after the other.
    pub fn block(&self, unknowns: &[u32]) -> Vec<f64> {
        let n = unknowns.len();
        let mut out = vec![0.0; n * n];
        for (b, &j) in unknowns.iter().enumerate() {
            let range = self.column_start[j as usize]..self.column_start[j as usize + 1];
            let rows = &self.row[range.clone()];
            for (a, &i) in unknowns.iter().enumerate().skip(b) {
                if let Ok(at) = rows.binary_search(&(i as usize)) {
                    (out[a * n + b], out[b * n + a]) = (self.value[range.start + at], self.value[range.start + at]);
                }
            }
        }
        out
    }

    /// The entries of the lower triangle: row, column and value.
    pub fn entries(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        let column = |j: usize| self.column_start[j]..self.column_start[j + 1];
        (0..self.size()).flat_map(move |j| column(j).map(move |k| (self.row[k], j, self.value[k])))
    }

    /// The entries of the diagonal.
    pub fn diagonal(&self) -> Vec<f64> {
        (0..self.size())
            .map(|j| {
                let range = self.column_start[j]..self.column_start[j + 1];
                range.clone().find(|&k| self.row[k] == j).map_or(0.0, |k| self.value[k])
            })
            .collect()
    }

    /// `S A S` with a diagonal `S`.
    pub fn scaled(&self, scale: &[f64]) -> Self {
        let mut out = self.clone();
        for j in 0..self.size() {
            for k in self.column_start[j]..self.column_start[j + 1] {
                out.value[k] *= scale[self.row[k]] * scale[j];
            }
        }
        out
    }

    /// The product with a vector.
    pub fn multiply(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; x.len()];
        for j in 0..self.size() {
            for k in self.column_start[j]..self.column_start[j + 1] {
                let (i, v) = (self.row[k], self.value[k]);
                y[i] += v * x[j];
                if i != j {
                    y[j] += v * x[i];
                }
            }
        }
        y
    }

    /// Restores the sums of all rows to values that are known exactly.
    ///
    /// Stiffness entries grow steeply with the degree, and their round-off makes rows that should cancel against
    /// constants leave a force without a cause. The defect of each row, found in twice the working precision, goes into
    /// its smallest entry, where it is not rounded away again; symmetry passes it on to a later row.
    pub fn restore_row_sums(&mut self, sums: &[f64]) {
        let n = self.size();
        let mut defect: Vec<f64> = sums.iter().map(|s| -s).collect();
        let mut lost = vec![0.0; n];
        let mut add = |i: usize, v: f64| {
            let (total, error) = two_sum(defect[i], v);
            defect[i] = total;
            lost[i] += error;
        };
        for j in 0..n {
            for k in self.column_start[j]..self.column_start[j + 1] {
                add(self.row[k], self.value[k]);
                if self.row[k] != j {
                    add(j, self.value[k]);
                }
            }
        }
        for (d, l) in defect.iter_mut().zip(&lost) {
            *d += l;
        }
        for j in 0..n {
            let column = self.column_start[j]..self.column_start[j + 1];
            let smallest = column
                .clone()
                .filter(|&k| self.row[k] != j)
                .min_by(|&a, &b| self.value[a].abs().total_cmp(&self.value[b].abs()));
            // The last row of a connected part has no later one: its diagonal takes the rest.
            let Some(at) = smallest.or_else(|| column.clone().find(|&k| self.row[k] == j)) else { continue };
            self.value[at] -= defect[j];
            if self.row[at] != j {
                defect[self.row[at]] -= defect[j];
            }
        }
    }

    /// The residual `b - A x`, accumulated in twice the working precision (Dot2 of Ogita, Rump & Oishi 2005), so that
    /// refinement can bring it down to the round-off of `x` itself.
    pub fn residual_in_extended_precision(&self, b: &[f64], x: &[f64]) -> Vec<f64> {
        let mut sum = b.to_vec();
        let mut lost = vec![0.0; b.len()];
        let mut subtract = |i: usize, a: f64, b: f64| {
            let (product, error) = two_product(a, b);
            let (total, error_of_sum) = two_sum(sum[i], -product);
            sum[i] = total;
            lost[i] += error_of_sum - error;
        };
        for j in 0..self.size() {
            for k in self.column_start[j]..self.column_start[j + 1] {
                let (i, v) = (self.row[k], self.value[k]);
                subtract(i, v, x[j]);
                if i != j {
                    subtract(j, v, x[i]);
                }
            }
        }
        sum.iter().zip(&lost).map(|(s, l)| s + l).collect()
    }

    /// The largest absolute entry of each row, which bounds what round-off can do to it.
    pub fn largest(&self) -> f64 {
        self.value.iter().fold(0.0, |m, v| m.max(v.abs()))
    }

    /// Replaces unknown `j` by the given value: its equation becomes `d x_j = d value`, with `d` the diagonal entry, and
    /// the right-hand side of the others is corrected.
    pub fn prescribe(&mut self, prescribed: &[Option<f64>], rhs: &mut [f64]) {
        for j in 0..self.size() {
            for k in self.column_start[j]..self.column_start[j + 1] {
                let i = self.row[k];
                match (prescribed[i], prescribed[j]) {
                    (Some(v), _) if i == j => rhs[j] = self.value[k] * v,
                    (None, None) => {}
                    (Some(v), None) => {
                        rhs[j] -= self.value[k] * v;
                        self.value[k] = 0.0;
                    }
                    (None, Some(v)) => {
                        rhs[i] -= self.value[k] * v;
                        self.value[k] = 0.0;
                    }
                    (Some(_), Some(_)) => self.value[k] = 0.0,
                }
            }
        }
    }
}

/// A sum and its rounding error (Knuth).
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    let t = s - a;
    (s, (a - (s - t)) + (b - t))
}

/// A product and its rounding error (Dekker, Veltkamp).
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let split = |v: f64| {
        let c = 134_217_729.0 * v;
        let high = c - (c - v);
        (high, v - high)
    };
    let (p, (ah, al), (bh, bl)) = (a * b, split(a), split(b));
    (p, al * bl - (((p - ah * bh) - al * bh) - ah * bl))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extended_precision_sees_what_cancels() {
        let mut a = SymmetricMatrix::from_cliques(2, &[vec![0, 1]]);
        a.add(&[0, 1], &[1e8, 1.0, 1.0, 1e8], 1.0);
        let x = [1.0 + f64::EPSILON, -1e8];
        // 1e8 (1 + eps) - 1e8 = 1e8 eps, which plain arithmetic rounds away or doubles.
        let r = a.residual_in_extended_precision(&[0.0, 0.0], &x);
        assert_eq!(r[0], -1e8 * f64::EPSILON);
    }

    #[test]
    fn row_sums_are_restored_without_changing_more_than_round_off() {
        let cliques = vec![vec![0, 1, 2], vec![1, 2, 3]];
        let mut a = SymmetricMatrix::from_cliques(4, &cliques);
        let element = [1e6, -1e6 + 0.1, -0.1, -1e6 + 0.1, 1e6 + 0.2, -0.3, -0.1, -0.3, 0.4];
        for c in &cliques {
            a.add(c, &element, 1.0 / 3.0);
        }
        let before = a.clone();
        a.restore_row_sums(&[0.0; 4]);
        let sums = a.residual_in_extended_precision(&[0.0; 4], &[1.0; 4]);
        assert!(sums.iter().all(|s| s.abs() < 1e-13), "{sums:?}");
        assert!(a.value.iter().zip(&before.value).all(|(a, b)| (a - b).abs() < 1e-9));
    }

    #[test]
    fn sums_of_squares_are_those_of_their_parts() {
        let rows: [(&[(u32, f64)], f64); 2] = [(&[(0, 2.0), (2, -1.0)], 3.0), (&[(2, 0.5), (1, 4.0)], 2.0)];
        let found = SymmetricMatrix::of_squares(4, &rows);
        let dense = |i: usize, j: usize| {
            let of = |row: &[(u32, f64)], k: usize| row.iter().find(|t| t.0 as usize == k).map_or(0.0, |t| t.1);
            rows.iter().map(|(row, k)| k * of(row, i) * of(row, j)).sum::<f64>()
        };
        for j in 0..4 {
            let unit: Vec<f64> = (0..4).map(|k| f64::from(u8::from(k == j))).collect();
            let column: Vec<f64> = (0..4).map(|i| dense(i, j)).collect();
            assert_eq!(found.multiply(&unit), column);
        }
    }

    #[test]
    fn a_transformation_is_that_of_the_dense_matrix() {
        let mut a = SymmetricMatrix::from_cliques(3, &[vec![0, 1, 2]]);
        let dense = [4.0, -1.0, 0.5, -1.0, 3.0, 0.25, 0.5, 0.25, 2.0];
        a.add(&[0, 1, 2], &dense, 1.0);
        let t: [Vec<(u32, f64)>; 3] = [vec![(0, 2.0), (1, -1.0)], vec![(1, 3.0)], vec![(0, 0.5), (1, 1.5)]];
        let b = a.transformed(2, |i| &t[i]);
        let entry = |i: usize, r: u32| t[i].iter().filter(|e| e.0 == r).map(|e| e.1).sum::<f64>();
        for r in 0..2u32 {
            let mut unit = vec![0.0; 2];
            unit[r as usize] = 1.0;
            let column = b.multiply(&unit);
            for c in 0..2u32 {
                let exact: f64 = (0..9).map(|k| entry(k / 3, c) * dense[k] * entry(k % 3, r)).sum();
                assert!((column[c as usize] - exact).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn assembly_multiplication_and_prescribed_values() {
        let element = [1.0, -1.0, -1.0, 1.0];
        let cliques = vec![vec![0, 1], vec![1, 2], vec![2, 3]];
        let mut a = SymmetricMatrix::from_cliques(4, &cliques);
        for c in &cliques {
            a.add(c, &element, 2.0);
        }
        assert_eq!(a.multiply(&[0.0, 1.0, 4.0, 9.0]), vec![-2.0, -4.0, -4.0, 10.0]);
        let mut rhs = vec![0.0; 4];
        a.prescribe(&[Some(1.0), None, None, Some(4.0)], &mut rhs);
        let x = crate::cholesky::Symbolic::default().factor(a).unwrap().solve(&rhs).unwrap();
        for (i, v) in x.iter().enumerate() {
            assert!((v - (i as f64 + 1.0)).abs() < 1e-14);
        }
    }
}
