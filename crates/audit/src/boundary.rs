//! The boundary of cells: sides that belong to one cell only.

use crate::nearest::{area_normal, centre};
use signorini_geometry::Point;
use std::collections::{BTreeMap, HashMap};

/// Points nearer to each other than this part of the size of the body are one.
const SAME: f64 = 1e-7;
/// Facets that meet at a larger angle (in radians) meet at an edge of the body: a smooth surface in so few facets has no
/// curvature that could be told.
const EDGE: f64 = 0.8;

/// The facets around a body.
#[derive(Clone, Debug, Default)]
pub struct Boundary {
    /// Two points in the plane, three or four in space.
    pub facets: Vec<Vec<u32>>,
    /// The largest angle between the normal of each facet and those beside it, where the surface is smooth.
    pub turn: Vec<f64>,
    /// Every point of a facet, once, and a facet that it is of.
    pub points: Vec<u32>,
    first: Vec<u32>,
    /// The length of each facet in the plane, the side of a square of its area in space; and the largest.
    pub sides: Vec<f64>,
    pub largest: f64,
}

/// Sides of a hexahedron, tetrahedron and wedge by their corners.
const OF_HEXAHEDRON: [&[usize]; 6] =
    [&[0, 3, 2, 1], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]];
const OF_TETRAHEDRON: [&[usize]; 4] = [&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]];
const OF_WEDGE: [&[usize]; 5] = [&[0, 2, 1], &[3, 4, 5], &[0, 1, 4, 3], &[1, 2, 5, 4], &[2, 0, 3, 5]];

/// The sides of a cell, without corners that coincide.
pub fn sides(cell: &[u32], in_space: bool) -> Vec<Vec<u32>> {
    if !in_space {
        return (0..cell.len()).map(|k| vec![cell[k], cell[(k + 1) % cell.len()]]).filter(|s| s[0] != s[1]).collect();
    }
    let list: &[&[usize]] = match cell.len() {
        8 => &OF_HEXAHEDRON,
        6 => &OF_WEDGE,
        4 => &OF_TETRAHEDRON,
        _ => &[],
    };
    let side = |corners: &&[usize]| {
        let mut side: Vec<u32> = corners.iter().map(|k| cell[*k]).collect();
        side.dedup();
        if side.len() > 1 && side.first() == side.last() {
            side.pop();
        }
        side
    };
    list.iter().map(side).filter(|s| s.len() > 2).collect()
}

impl Boundary {
    /// The boundary of cells in space or in the plane. Cells may have points of their own where they meet.
    pub fn new(points: &[Point<3>], cells: &[Vec<u32>], in_space: bool) -> Self {
        let size = points.iter().fold(0.0f64, |m, x| m.max(x.amax())).max(f64::MIN_POSITIVE);
        let mut numbers: HashMap<[i64; 3], u32> = HashMap::new();
        let same: Vec<u32> = (points.iter().enumerate())
            .map(|(k, x)| {
                let key = std::array::from_fn(|i| (x[i] / (SAME * size)).round() as i64);
                *numbers.entry(key).or_insert(k as u32)
            })
            .collect();
        // By the points that it joins, in order, each side and how often it was met.
        let mut met: BTreeMap<Vec<u32>, (usize, Vec<u32>)> = BTreeMap::new();
        for cell in cells {
            let cell: Vec<u32> = cell.iter().map(|k| same[*k as usize]).collect();
            for side in sides(&cell, in_space) {
                let mut key = side.clone();
                key.sort_unstable();
                met.entry(key).or_insert((0, side)).0 += 1;
            }
        }
        let facets: Vec<Vec<u32>> = met.into_values().filter(|(count, _)| *count == 1).map(|(_, side)| side).collect();
        let mut of_point: HashMap<u32, Vec<u32>> = HashMap::new();
        for (k, facet) in facets.iter().enumerate() {
            facet.iter().for_each(|p| of_point.entry(*p).or_default().push(k as u32));
        }
        let normals: Vec<_> = facets.iter().map(|f| area_normal(points, f).try_normalize(0.0)).collect();
        let turn = (facets.iter().enumerate())
            .map(|(k, facet)| {
                let beside = facet.iter().flat_map(|p| &of_point[p]);
                let angle = |l: &u32| Some(normals[k]?.dot(&normals[*l as usize]?).clamp(-1.0, 1.0).acos());
                beside.filter_map(angle).filter(|a| *a < EDGE).fold(0.0, f64::max)
            })
            .collect();
        let mut own: Vec<u32> = of_point.keys().copied().collect();
        own.sort_unstable();
        let first = own.iter().map(|p| of_point[p][0]).collect();
        let side = |f: &Vec<u32>| {
            let size = area_normal(points, f).norm();
            if f.len() == 2 { size } else { size.sqrt() }
        };
        let sides: Vec<f64> = facets.iter().map(side).collect();
        let largest = sides.iter().copied().fold(0.0, f64::max);
        Boundary { facets, turn, points: own, first, sides, largest }
    }

    /// A facet at one of its points.
    pub fn facet_at(&self, point: u32) -> Option<usize> {
        let k = self.points.binary_search(&point).ok()?;
        Some(self.first[k] as usize)
    }

    /// The middle of a facet.
    pub fn centre(&self, points: &[Point<3>], facet: usize) -> Point<3> {
        centre(points, &self.facets[facet])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_hexahedra_with_points_of_their_own_have_ten_facets() {
        let mut points = Vec::new();
        for x in [0.0, 1.0] {
            for k in [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]] {
                points.push(Point::<3>::new(x + f64::from(k[0]), f64::from(k[1]), f64::from(k[2])));
            }
        }
        let cells: Vec<Vec<u32>> = vec![(0..8).collect(), (8..16).collect()];
        let boundary = Boundary::new(&points, &cells, true);
        assert_eq!((boundary.facets.len(), boundary.points.len()), (10, 12));
        // Normals look outward.
        for (k, facet) in boundary.facets.iter().enumerate() {
            let out = boundary.centre(&points, k) - Point::<3>::new(1.0, 0.5, 0.5);
            assert!(area_normal(&points, facet).dot(&out) > 0.0);
        }
    }
}
