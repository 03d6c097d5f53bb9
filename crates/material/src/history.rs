//! What a body remembers: the history variables of its law at the quadrature points.

use crate::law::StressLaw;

/// Where the history of each point stands in the internal numbers of a state.
#[derive(Clone, Debug, Default)]
pub struct History {
    /// Variables of a point; none of elastic laws.
    count: usize,
    /// The first point of each cell, and the number of all.
    first: Vec<usize>,
}

impl History {
    /// The places of the variables of a law in cells with so many points.
    pub fn new(law: &StressLaw, points: impl Iterator<Item = usize>) -> Self {
        let count = law.start().len();
        let mut first = vec![0];
        if count > 0 {
            points.for_each(|n| first.push(first[first.len() - 1] + n));
        }
        History { count, first }
    }

    /// The internal numbers at the start.
    pub fn start(&self, law: &StressLaw) -> Vec<f64> {
        law.start().repeat(self.first[self.first.len() - 1])
    }

    /// The history of a point of a cell.
    pub fn at<'a>(&self, internal: &'a [f64], cell: usize, q: usize) -> &'a [f64] {
        if self.count == 0 {
            return &[];
        }
        let start = self.count * (self.first[cell] + q);
        &internal[start..start + self.count]
    }
}
