//! The rows of a sparse matrix that one process has, by columns in ascending order.

/// Compressed rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rows {
    pub start: Vec<usize>,
    pub columns: Vec<u32>,
    pub values: Vec<f64>,
}

impl Rows {
    /// From entries `(row, column, value)`, rows counted from the first of this process; entries of the same place are summed in
    /// the order in which they come.
    pub fn new(rows: usize, entries: impl Iterator<Item = (u32, u32, f64)> + Clone) -> Self {
        let mut start = vec![0usize; rows + 1];
        entries.clone().for_each(|(row, ..)| start[row as usize + 1] += 1);
        (0..rows).for_each(|k| start[k + 1] += start[k]);
        let mut next = start.clone();
        let mut list = vec![(0u32, 0.0); start[rows]];
        for (row, column, value) in entries {
            list[next[row as usize]] = (column, value);
            next[row as usize] += 1;
        }
        let mut out = Rows { start: vec![0], columns: Vec::new(), values: Vec::new() };
        for k in 0..rows {
            let row = &mut list[start[k]..start[k + 1]];
            // Stable: the order of a sum is that of the entries.
            row.sort_by_key(|e| e.0);
            let begin = out.columns.len();
            for &(column, value) in row.iter() {
                if out.columns.len() > begin && out.columns.last() == Some(&column) {
                    if let Some(last) = out.values.last_mut() {
                        *last += value;
                    }
                } else {
                    out.columns.push(column);
                    out.values.push(value);
                }
            }
            out.start.push(out.columns.len());
        }
        out
    }

    pub fn count(&self) -> usize {
        self.start.len() - 1
    }

    /// Columns and entries of a row.
    pub fn row(&self, k: usize) -> impl Iterator<Item = (u32, f64)> + '_ {
        (self.start[k]..self.start[k + 1]).map(|e| (self.columns[e], self.values[e]))
    }

    /// Adds to the entry of a row and column, which is put there if it is not.
    pub fn add(&mut self, row: usize, column: u32, value: f64) {
        let own = self.start[row]..self.start[row + 1];
        match self.columns[own.clone()].binary_search(&column) {
            Ok(at) => self.values[own.start + at] += value,
            Err(at) => {
                self.columns.insert(own.start + at, column);
                self.values.insert(own.start + at, value);
                self.start[row + 1..].iter_mut().for_each(|s| *s += 1);
            }
        }
    }
}
