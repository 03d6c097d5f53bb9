//! Sets of the cells, nodes or vertices of a grid, row by row.

/// Consecutive members of one row, from `begin` up to `end`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Run {
    pub row: usize,
    pub begin: usize,
    pub end: usize,
}

/// Runs of all that a predicate holds for, row by row.
pub fn runs(rows: usize, columns: usize, holds: impl Fn(usize, usize) -> bool) -> Vec<Run> {
    let mut out = Vec::new();
    for row in 0..rows {
        let mut i = 0;
        while i < columns {
            let begin = i;
            while i < columns && holds(i, row) {
                i += 1;
            }
            if begin < i {
                out.push(Run { row, begin, end: i });
            }
            i += 1;
        }
    }
    out
}

/// All that lies at most `reach` rows and columns away from a set, within so many rows and columns.
pub fn dilated(set: &[Run], reach: usize, [columns, rows]: [usize; 2]) -> Vec<Run> {
    let mut all: Vec<Run> = set
        .iter()
        .flat_map(|r| {
            let (begin, end) = (r.begin.saturating_sub(reach), (r.end + reach).min(columns));
            (r.row.saturating_sub(reach)..(r.row + reach + 1).min(rows)).map(move |row| Run { row, begin, end })
        })
        .collect();
    all.sort_unstable();
    let mut out: Vec<Run> = Vec::new();
    for run in all {
        match out.last_mut() {
            Some(last) if last.row == run.row && run.begin <= last.end => last.end = last.end.max(run.end),
            _ => out.push(run),
        }
    }
    out
}

/// What two sets of the same rows have in common.
pub fn common(a: &[Run], b: &[Run], mut visit: impl FnMut(usize, usize)) {
    let (mut a, mut b) = (a.iter().peekable(), b.iter().peekable());
    while let (Some(x), Some(y)) = (a.peek(), b.peek()) {
        let (begin, end) = (x.begin.max(y.begin), x.end.min(y.end));
        if begin < end {
            visit(begin, end);
        }
        if x.end < y.end {
            a.next()
        } else {
            b.next()
        };
    }
}

/// The runs of one row, of a set in ascending order.
pub(super) fn of_row(set: &[Run], row: usize) -> &[Run] {
    let from = &set[set.partition_point(|r| r.row < row)..];
    &from[..from.partition_point(|r| r.row == row)]
}

/// Which run of a set in ascending order a member of a row belongs to.
pub fn find(set: &[Run], row: usize, column: usize) -> Option<usize> {
    let at = set.partition_point(|r| (r.row, r.end) <= (row, column));
    set.get(at).is_some_and(|r| r.row == row && r.begin <= column).then_some(at)
}

/// For each run the number of the part of the set that it belongs to: parts meet nowhere, not even at corners.
pub fn parts(set: &[Run]) -> Vec<usize> {
    let mut root: Vec<usize> = (0..set.len()).collect();
    let mut below = 0;
    for k in 0..set.len() {
        while set[below].row + 1 < set[k].row || (set[below].row < set[k].row && set[below].end < set[k].begin) {
            below += 1;
        }
        let touching = (below..k).take_while(|&j| set[j].row < set[k].row && set[j].begin <= set[k].end);
        touching.for_each(|j| join(&mut root, j, k));
    }
    (0..set.len()).map(|k| root_of(&mut root, k)).collect()
}

/// The least member of the part that a member belongs to.
pub(super) fn root_of(root: &mut [usize], mut k: usize) -> usize {
    while root[k] != k {
        root[k] = root[root[k]];
        k = root[k];
    }
    k
}

/// Makes the parts of two members one.
pub(super) fn join(root: &mut [usize], a: usize, b: usize) {
    let [a, b] = [a, b].map(|k| root_of(root, k));
    root[a.max(b)] = a.min(b);
}
