//! Disjoint sets: each element names another one of its set, or itself if it stands for the set (Galler and Fischer 1964).

/// The element that stands for the set of `k`; the way there is halved.
pub fn root(parent: &mut [u32], mut k: u32) -> u32 {
    while parent[k as usize] != k {
        parent[k as usize] = parent[parent[k as usize] as usize];
        k = parent[k as usize];
    }
    k
}
