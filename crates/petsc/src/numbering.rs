//! The numbers of unknowns when their rows are distributed: those of the first process come first, in their order.

/// Numbers of the system and of the processes.
#[derive(Clone, Debug, PartialEq)]
pub struct Numbering {
    /// Where the rows of each process begin, and their end.
    pub first: Vec<usize>,
    /// The new number of each unknown, and the unknown of each new number.
    pub number: Vec<u32>,
    pub unknown: Vec<u32>,
}

impl Numbering {
    /// From the process of each unknown.
    pub fn new(owner: &[u32], processes: usize) -> Self {
        let mut first = vec![0; processes + 1];
        owner.iter().for_each(|p| first[*p as usize + 1] += 1);
        (0..processes).for_each(|p| first[p + 1] += first[p]);
        let mut next = first.clone();
        let mut number = vec![0; owner.len()];
        let mut unknown = vec![0; owner.len()];
        for (u, p) in owner.iter().enumerate() {
            let place = &mut next[*p as usize];
            number[u] = *place as u32;
            unknown[*place] = u as u32;
            *place += 1;
        }
        Numbering { first, number, unknown }
    }

    /// How many rows a process has.
    pub fn rows(&self, process: usize) -> usize {
        self.first[process + 1] - self.first[process]
    }
}
