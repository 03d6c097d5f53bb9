//! Ever coarser functions of vertices: cells twice as large in each direction, again and again.
//!
//! A coarse cell is copied for each part of the material in it that hangs together there, and a coarse function for each part
//! that hangs together in its support, as those of the body are. So struts on both sides of a pore are not joined by cells
//! that span it. Cells hang together where they share a function of a vertex.

use crate::body::CellBody;
use signorini_solve::multigrid::Transfer;
use std::collections::BTreeMap;

/// Unknowns of a level that are few enough to be factorised.
const FEW: usize = 4000;

/// Cells, and the functions of vertices in each of them.
struct Level<const D: usize> {
    /// Place of each cell, and its functions.
    cells: Vec<([usize; D], Vec<u32>)>,
    /// The vertex of each function.
    vertices: Vec<[usize; D]>,
}

/// Which of some things hang together, by what each of them has: the number of its set for each, in order of the first.
fn joined(has: &[Vec<u32>]) -> Vec<usize> {
    let mut set: Vec<usize> = (0..has.len()).collect();
    fn root(set: &mut [usize], mut i: usize) -> usize {
        while set[i] != i {
            set[i] = set[set[i]];
            i = set[i];
        }
        i
    }
    let mut owner: BTreeMap<u32, usize> = BTreeMap::new();
    for (i, list) in has.iter().enumerate() {
        for what in list {
            let j = *owner.entry(*what).or_insert(i);
            let (a, b) = (root(&mut set, i), root(&mut set, j));
            set[a.max(b)] = a.min(b);
        }
    }
    (0..has.len()).map(|i| root(&mut set, i)).collect()
}

impl<const D: usize> Level<D> {
    /// The next coarser level, and how its functions are made of those of this one.
    fn coarser(&self) -> (Self, Vec<Vec<(u32, f64)>>) {
        let mut groups: BTreeMap<[usize; D], Vec<usize>> = BTreeMap::new();
        for (c, (at, _)) in self.cells.iter().enumerate() {
            groups.entry(at.map(|i| i / 2)).or_default().push(c);
        }
        // Parts of the material in each coarse cell, with the functions of this level in them.
        let mut parts: Vec<([usize; D], Vec<usize>, Vec<u32>)> = Vec::new();
        for (at, members) in groups {
            let has: Vec<Vec<u32>> = members.iter().map(|c| self.cells[*c].1.clone()).collect();
            let mut of_set: BTreeMap<usize, usize> = BTreeMap::new();
            for ((c, functions), set) in members.iter().zip(&has).zip(joined(&has)) {
                let part = *of_set.entry(set).or_insert_with(|| {
                    parts.push((at, Vec::new(), Vec::new()));
                    parts.len() - 1
                });
                parts[part].1.push(*c);
                parts[part].2.extend(functions);
            }
        }
        let mut around: BTreeMap<[usize; D], Vec<usize>> = BTreeMap::new();
        for (p, (at, ..)) in parts.iter().enumerate() {
            for corner in 0..1usize << D {
                around.entry(std::array::from_fn(|k| at[k] + (corner >> k & 1))).or_default().push(p);
            }
        }
        let mut vertices = Vec::new();
        let mut functions: Vec<Vec<u32>> = vec![Vec::new(); parts.len()];
        for (vertex, near) in &around {
            let has: Vec<Vec<u32>> = near.iter().map(|p| parts[*p].2.clone()).collect();
            let mut of_set: BTreeMap<usize, u32> = BTreeMap::new();
            for (p, set) in near.iter().zip(joined(&has)) {
                let number = *of_set.entry(set).or_insert_with(|| {
                    vertices.push(*vertex);
                    vertices.len() as u32 - 1
                });
                functions[*p].push(number);
            }
        }
        let mut rows: Vec<Vec<(u32, f64)>> = vec![Vec::new(); self.vertices.len()];
        for ((_, _, own), coarse) in parts.iter().zip(&functions) {
            for f in own {
                let at = &self.vertices[*f as usize];
                let row = &mut rows[*f as usize];
                if row.is_empty() {
                    let weight = |c: &u32| -> f64 {
                        let v = &vertices[*c as usize];
                        (0..D).map(|k| [1.0, 0.5, 0.0][at[k].abs_diff(2 * v[k]).min(2)]).product()
                    };
                    row.extend(coarse.iter().map(|c| (*c, weight(c))).filter(|(_, w)| *w > 0.0));
                }
            }
        }
        let cells = parts.into_iter().zip(functions).map(|((at, ..), own)| (at, own)).collect();
        (Level { cells, vertices }, rows)
    }
}

impl<const D: usize> CellBody<D> {
    /// How the unknowns of ever coarser functions of vertices are made of those of the last; `vertices` are the functions of
    /// vertices of the body. None on cells that are refined.
    pub(crate) fn coarser_levels(&self, vertices: &[u32]) -> Vec<Transfer> {
        if self.tree().leaves().iter().any(|l| l.level > 0) {
            return Vec::new();
        }
        let mut number = vec![u32::MAX; self.function_count()];
        vertices.iter().enumerate().for_each(|(i, f)| number[*f as usize] = i as u32);
        let own = |functions: &[u32]| -> Vec<u32> {
            functions.iter().map(|f| number[*f as usize]).filter(|n| *n != u32::MAX).collect()
        };
        let mut level = Level {
            cells: (self.cells().iter()).map(|c| (self.tree().leaves()[c.leaf].index, own(&c.functions))).collect(),
            vertices: vertices.iter().map(|f| self.mode(*f as usize).ids).collect(),
        };
        let mut out = Vec::new();
        while D * level.vertices.len() > FEW {
            let (coarser, rows) = level.coarser();
            if 2 * coarser.vertices.len() > level.vertices.len() {
                // Material in many thin parts is not coarsened by larger cells.
                break;
            }
            let unknown = |(c, w): &(u32, f64), k: usize| (D as u32 * c + k as u32, *w);
            let rows = rows.iter().flat_map(|row| (0..D).map(|k| row.iter().map(|e| unknown(e, k)).collect()));
            out.push(Transfer { columns: D * coarser.vertices.len(), rows: rows.collect() });
            level = coarser;
        }
        out
    }
}
