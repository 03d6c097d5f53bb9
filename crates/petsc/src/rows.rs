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
        let (mut columns, mut values) = (vec![0u32; start[rows]], vec![0.0; start[rows]]);
        for (row, column, value) in entries {
            let place = &mut next[row as usize];
            (columns[*place], values[*place]) = (column, value);
            *place += 1;
        }
        // Rows are summed where they are: none becomes longer.
        let mut of_row: Vec<(u32, f64)> = Vec::new();
        let (mut done, mut ends) = (0, vec![0]);
        for k in 0..rows {
            let own = start[k]..start[k + 1];
            of_row.clear();
            of_row.extend(columns[own.clone()].iter().copied().zip(values[own].iter().copied()));
            // Stable: the order of a sum is that of the entries.
            of_row.sort_by_key(|e| e.0);
            let begin = done;
            for &(column, value) in &of_row {
                if done > begin && columns[done - 1] == column {
                    values[done - 1] += value;
                } else {
                    (columns[done], values[done]) = (column, value);
                    done += 1;
                }
            }
            ends.push(done);
        }
        columns.truncate(done);
        values.truncate(done);
        columns.shrink_to_fit();
        values.shrink_to_fit();
        Rows { start: ends, columns, values }
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
