//! Lists of unlike length, one behind the other.

/// So many lists of small things.
pub(crate) struct Lists<T> {
    start: Vec<u32>,
    all: Vec<T>,
}

impl<T: Copy + Default> Lists<T> {
    /// So many lists, of pairs of list and entry that are visited twice, in the same order.
    pub fn new(count: usize, pairs: impl Fn(&mut dyn FnMut(usize, T))) -> Self {
        let mut start = vec![0u32; count + 1];
        pairs(&mut |list, _| start[list + 1] += 1);
        for k in 1..start.len() {
            start[k] += start[k - 1];
        }
        let mut next = start.clone();
        let mut all = vec![T::default(); start[count] as usize];
        pairs(&mut |list, entry| {
            all[next[list] as usize] = entry;
            next[list] += 1;
        });
        Self { start, all }
    }

    pub fn of(&self, list: usize) -> &[T] {
        &self.all[self.start[list] as usize..self.start[list + 1] as usize]
    }
}
