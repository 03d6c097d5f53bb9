//! Where a zone of contact ends: a place within the faces, not a node.
//!
//! Beside the zone of smooth bodies the gap grows with the distance to the power 3/2, so `g^(2/3)` of the open nodes is
//! nearly linear, and vanishes where the zone ends. It is fitted beside every face that has nodes of both states. In the
//! plane the nodes of that face are left out: they have the error of the discretised edge. In space there are enough others
//! to average it, and without the nearest nodes the fit would have to reach too far. Where the slave side or what it faces
//! ends within the zone there are no open nodes, and the zone ends with what is covered.

use crate::multiplier::PressureNodes;
use crate::recovery::Pressed;
use crate::surface::ContactSurface;
use nalgebra::{DMatrix, DVector};
use signorini_basis::{CellShape, Local};
use signorini_geometry::Point;
use std::collections::BTreeSet;

/// What is known of a pressure node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NodeState {
    /// Faces nothing.
    Bare,
    Active,
    /// With its gap where that is its own.
    Open(Option<f64>),
}

/// The part of a slave side that is in contact.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactZone {
    /// Area in contact, by face.
    pub face_area: Vec<f64>,
    /// Face and ends of the pieces where it ends: points in the plane, given twice, and pieces of outlines in space.
    pub boundary: Vec<(usize, [Local; 2])>,
    /// In the plane, the intervals in contact.
    pub intervals: Vec<(usize, [Local; 2])>,
}

/// A polynomial on a tangent plane, positive in the zone.
struct Level<const D: usize> {
    origin: Point<D>,
    axes: Vec<Point<D>>,
    coefficients: Vec<f64>,
}

/// Open nodes that a quadratic fit asks for: in space twice as many as it has coefficients, since they may lie badly.
const fn plenty(dimension: usize) -> usize {
    if dimension == 2 { 3 } else { 12 }
}
/// The most faces that a fit goes away from the edge.
const RINGS: usize = 3;
/// Pieces along an edge of a face that is cut; the outline is straight in each.
const PIECES: usize = 8;

impl<const D: usize> Level<D> {
    fn terms(&self, x: &Point<D>) -> Vec<f64> {
        let at: Vec<f64> = self.axes.iter().map(|a| a.dot(&(x - self.origin))).collect();
        let mut out = vec![1.0];
        out.extend(&at);
        if self.coefficients.len() > D {
            out.extend((0..at.len()).flat_map(|a| (0..=a).map(move |b| (a, b))).map(|(a, b)| at[a] * at[b]));
        }
        out
    }

    fn value(&self, x: &Point<D>) -> f64 {
        self.terms(x).iter().zip(&self.coefficients).map(|(t, c)| t * c).sum()
    }
}

/// The zone of a slave side from the states of its nodes; `points` tell how much of every face is covered.
pub fn zone<const D: usize>(
    slave: &dyn ContactSurface<D>,
    nodes: &PressureNodes<D>,
    points: &[Pressed],
    states: &[NodeState],
) -> ContactZone {
    let count = nodes.face_count();
    let mut faces_of: Vec<Vec<usize>> = vec![Vec::new(); nodes.len()];
    for face in 0..count {
        nodes.of_face(face).iter().for_each(|(k, _)| faces_of[*k as usize].push(face));
    }
    let mut covered: Vec<Vec<&Pressed>> = vec![Vec::new(); count];
    points.iter().filter(|p| p.area > 0.0).for_each(|p| covered[p.face].push(p));
    let states = &without_pinholes(nodes, &faces_of, states);
    let state = |k: &u32| states[*k as usize];
    let has =
        |face: usize, wanted: &dyn Fn(NodeState) -> bool| nodes.of_face(face).iter().any(|(k, _)| wanted(state(k)));
    let active = |face: usize| has(face, &|s| s == NodeState::Active);
    // Nodes without a gap of their own follow others, of other faces too.
    let mixed = |face: usize| active(face) && has(face, &|s| matches!(s, NodeState::Open(Some(_))));
    let levels: Vec<Option<Level<D>>> =
        (0..count).map(|face| mixed(face).then(|| fit(slave, nodes, &faces_of, states, face)).flatten()).collect();
    let mut out = ContactZone { face_area: vec![0.0; count], ..ContactZone::default() };
    for face in (0..count).filter(|&f| active(f)) {
        let whole: f64 = covered[face].iter().map(|p| p.area).sum();
        // A face with active nodes alone is cut where the fit beside it says so.
        let beside: BTreeSet<usize> = if mixed(face) {
            BTreeSet::from([face])
        } else {
            nodes.of_face(face).iter().flat_map(|(k, _)| faces_of[*k as usize].iter().copied()).collect()
        };
        let cuts: Vec<&Level<D>> = beside.iter().filter_map(|f| levels[*f].as_ref()).collect();
        // Of several fits the one nearest by: far away they are extrapolated.
        let level = |x: &Point<D>| {
            let distance = |l: &&&Level<D>| (l.origin - x).norm();
            cuts.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).map_or(f64::INFINITY, |l| l.value(x))
        };
        let Cut { full, inside, boundary, intervals } = cut(slave, face, &level);
        out.face_area[face] = if cuts.is_empty() {
            // Without enough open nodes the zone ends half way between the nodes.
            if mixed(face) { 0.5 * whole } else { whole }
        } else if whole < (1.0 - 1e-9) * full {
            let within = |p: &&&Pressed| level(&slave.at(face, &p.s).x) > 0.0;
            covered[face].iter().filter(within).map(|p| p.area).sum()
        } else {
            inside / full * whole
        };
        out.boundary.extend(boundary.into_iter().map(|ends| (face, ends)));
        out.intervals.extend(intervals.into_iter().map(|ends| (face, ends)));
    }
    out
}

/// Of every node that carries, the number of its connected zone: faces join their nodes.
pub fn connected<const D: usize>(nodes: &PressureNodes<D>, active: &[bool]) -> Vec<Option<usize>> {
    let mut faces_of: Vec<Vec<usize>> = vec![Vec::new(); nodes.len()];
    for face in 0..nodes.face_count() {
        nodes.of_face(face).iter().for_each(|(k, _)| faces_of[*k as usize].push(face));
    }
    let mut out = vec![None; nodes.len()];
    let mut count = 0;
    for first in 0..nodes.len() {
        if !active[first] || out[first].is_some() {
            continue;
        }
        out[first] = Some(count);
        let mut reached = vec![first];
        while let Some(k) = reached.pop() {
            for (n, _) in faces_of[k].iter().flat_map(|&face| nodes.of_face(face)) {
                let n = *n as usize;
                if active[n] && out[n].is_none() {
                    out[n] = Some(count);
                    reached.push(n);
                }
            }
        }
        count += 1;
    }
    out
}

/// The states with open nodes among active ones alone as active: a hole about a single node is smaller than the faces can
/// tell, and its gap says nothing of where the zone ends. Nodes without a gap of their own follow those around them.
fn without_pinholes<const D: usize>(
    nodes: &PressureNodes<D>,
    faces_of: &[Vec<usize>],
    states: &[NodeState],
) -> Vec<NodeState> {
    let mut out = states.to_vec();
    for own in [true, false] {
        let before = out.clone();
        let is_of = |k: usize| matches!(before[k], NodeState::Open(gap) if gap.is_some() == own);
        for k in (0..out.len()).filter(|&k| is_of(k)) {
            let mut around = (faces_of[k].iter())
                .flat_map(|&face| nodes.of_face(face))
                .map(|(n, _)| *n as usize)
                .filter(|&n| n != k && before[n] != NodeState::Open(None))
                .peekable();
            if around.peek().is_some() && around.all(|n| before[n] == NodeState::Active) {
                out[k] = NodeState::Active;
            }
        }
    }
    out
}

/// The level beside a face with nodes of both states; none without enough open nodes.
fn fit<const D: usize>(
    slave: &dyn ContactSurface<D>,
    nodes: &PressureNodes<D>,
    faces_of: &[Vec<usize>],
    states: &[NodeState],
    face: usize,
) -> Option<Level<D>> {
    let gap = |k: u32| match states[k as usize] {
        NodeState::Open(Some(gap)) if gap > 0.0 => Some(gap),
        _ => None,
    };
    let own: BTreeSet<u32> = nodes.of_face(face).iter().map(|(k, _)| *k).collect();
    let mut seen: BTreeSet<u32> = own.iter().copied().filter(|&k| gap(k).is_some()).collect();
    let near = seen.clone();
    let mut ring = seen.clone();
    let mut chosen: Vec<u32> = Vec::new();
    for _ in 0..RINGS {
        let next = ring.iter().flat_map(|k| &faces_of[*k as usize]).flat_map(|&f| nodes.of_face(f)).map(|(k, _)| *k);
        ring = next.filter(|&k| gap(k).is_some() && !seen.contains(&k)).collect();
        seen.extend(&ring);
        // The nodes of other faces on the edge have its error too.
        let clear = |k: &u32| {
            let beside = faces_of[*k as usize].iter().flat_map(|&f| nodes.of_face(f));
            D == 3 || !beside.into_iter().any(|(n, _)| states[*n as usize] == NodeState::Active)
        };
        chosen.extend(ring.iter().copied().filter(clear));
        if chosen.len() >= plenty(D) {
            break;
        }
    }
    if D == 3 || chosen.len() < D {
        chosen.extend(near);
    }
    let at = slave.at(face, &slave.shape(face).centre());
    let mut axes: Vec<Point<D>> = vec![at.tangents[0].normalize()];
    if D == 3 {
        axes.push((at.tangents[1] - axes[0] * axes[0].dot(&at.tangents[1])).normalize());
    }
    let quadratic = if D == 2 { 3 } else { 6 };
    let coefficients = vec![0.0; if chosen.len() >= plenty(D) { quadratic } else { D }];
    let mut level = Level { origin: at.x, axes, coefficients };
    if chosen.len() < D {
        return None;
    }
    // Lengths of about one.
    let size = chosen.iter().map(|k| (nodes.positions[*k as usize] - at.x).norm()).fold(f64::MIN_POSITIVE, f64::max);
    let most = chosen.iter().filter_map(|k| gap(*k)).fold(f64::MIN_POSITIVE, f64::max);
    level.axes.iter_mut().for_each(|a| *a /= size);
    let rows: Vec<Vec<f64>> = chosen.iter().map(|k| level.terms(&nodes.positions[*k as usize])).collect();
    let matrix = DMatrix::from_fn(rows.len(), level.coefficients.len(), |r, c| rows[r][c]);
    let values =
        DVector::from_iterator(rows.len(), chosen.iter().map(|k| -(gap(*k).unwrap_or(0.0) / most).powf(2.0 / 3.0)));
    let found = (matrix.transpose() * &matrix).cholesky()?.solve(&(matrix.transpose() * values));
    level.coefficients = found.iter().copied().collect();
    Some(level)
}

/// A face and the part of it where a level is positive: areas, where the level vanishes, and intervals in the plane.
struct Cut {
    full: f64,
    inside: f64,
    boundary: Vec<[Local; 2]>,
    intervals: Vec<[Local; 2]>,
}

fn cut<const D: usize>(slave: &dyn ContactSurface<D>, face: usize, level: &dyn Fn(&Point<D>) -> f64) -> Cut {
    let shape = slave.shape(face);
    let mut out = Cut { full: 0.0, inside: 0.0, boundary: Vec::new(), intervals: Vec::new() };
    let share = |k: usize| k as f64 / PIECES as f64;
    let mut simplices: Vec<Vec<Local>> = Vec::new();
    match shape {
        CellShape::Line => {
            let at = |k: usize| [2.0 * share(k) - 1.0, 0.0, 0.0];
            simplices.extend((0..PIECES).map(|k| vec![at(k), at(k + 1)]));
        }
        _ => {
            let tensor = shape.is_tensor();
            let at = |i: usize, j: usize| {
                let of = |k: usize| if tensor { 2.0 * share(k) - 1.0 } else { share(k) };
                [of(i), of(j), 0.0]
            };
            for i in 0..PIECES {
                for j in 0..PIECES {
                    if tensor || i + j < PIECES {
                        simplices.push(vec![at(i, j), at(i + 1, j), at(i, j + 1)]);
                    }
                    if tensor || i + j + 1 < PIECES {
                        simplices.push(vec![at(i + 1, j + 1), at(i, j + 1), at(i + 1, j)]);
                    }
                }
            }
        }
    }
    for corners in simplices {
        let middle: Local = std::array::from_fn(|k| corners.iter().map(|s| s[k]).sum::<f64>() / corners.len() as f64);
        let point = slave.at(face, &middle);
        let reference = if D == 2 {
            (corners[1][0] - corners[0][0]).abs()
        } else {
            let [a, b]: [Local; 2] = [1, 2].map(|c| std::array::from_fn(|k| corners[c][k] - corners[0][k]));
            0.5 * (a[0] * b[1] - a[1] * b[0]).abs()
        };
        let area = point.area_normal().norm() * slave.measure(&point.x) * reference;
        let values: Vec<f64> = corners.iter().map(|s| level(&slave.at(face, s).x)).collect();
        out.full += area;
        out.inside += area * share_above(&values);
        let crossings: Vec<Local> = (0..values.len())
            .flat_map(|a| (0..a).map(move |b| (a, b)))
            .filter(|&(a, b)| (values[a] > 0.0) != (values[b] > 0.0))
            .map(|(a, b)| {
                let way = values[a] / (values[a] - values[b]);
                std::array::from_fn(|k| corners[a][k] + (corners[b][k] - corners[a][k]) * way)
            })
            .collect();
        match crossings[..] {
            [a] => out.boundary.push([a, a]),
            [a, b] => out.boundary.push([a, b]),
            _ => {}
        }
        if D == 2 && values.iter().any(|v| *v > 0.0) {
            let end = |k: usize| if values[k] > 0.0 { corners[k] } else { crossings[0] };
            out.intervals.push([end(0), end(1)]);
        }
    }
    out
}

/// The share of a simplex, a line or a triangle, where the linear function with these values at its corners is positive.
fn share_above(values: &[f64]) -> f64 {
    let above: Vec<f64> = values.iter().copied().filter(|v| *v > 0.0).collect();
    let below: Vec<f64> = values.iter().copied().filter(|v| *v <= 0.0).collect();
    let corner = |one: f64, others: &[f64]| others.iter().map(|o| one / (one - o)).product::<f64>();
    match (above.len(), below.len()) {
        (_, 0) => 1.0,
        (0, _) => 0.0,
        (1, _) => corner(above[0], &below),
        _ => 1.0 - corner(below[0], &above),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gaps that grow with the power 3/2 of the distance to the end of the zone give that end, wherever it lies in its face.
    #[test]
    fn the_end_is_that_of_gaps_of_smooth_bodies() {
        let places: Vec<f64> = (0..=12).map(|k| 0.1 * f64::from(k)).collect();
        let slave = crate::testing::Polyline::at(&places, |_| 0.0);
        let nodes = PressureNodes::new(&slave);
        for end in [0.41, 0.45, 0.49] {
            let state = |x: &Point<2>| match x[0] - end {
                d if d > 0.0 => NodeState::Open(Some(0.7 * d.powf(1.5))),
                _ => NodeState::Active,
            };
            let states: Vec<NodeState> = nodes.positions.iter().map(state).collect();
            let found = zone(&slave, &nodes, &crate::recovery::unpressed(&slave, &nodes), &states);
            let length: f64 = found.face_area.iter().sum();
            assert!((length - end).abs() < 1e-12, "{length} of {end}");
        }
    }

    #[test]
    fn faces_join_the_nodes_of_a_zone() {
        let nodes = PressureNodes::new(&crate::testing::Polyline::at(&[0.0, 1.0, 2.0, 3.0, 4.0], |_| 0.0));
        let mut found: Vec<(f64, Option<usize>)> =
            nodes.positions.iter().map(|x| x[0]).zip(connected(&nodes, &[true; 5])).collect();
        assert!(found.iter().all(|(_, zone)| *zone == Some(0)));
        let active: Vec<bool> = nodes.positions.iter().map(|x| x[0] != 2.0).collect();
        found = nodes.positions.iter().map(|x| x[0]).zip(connected(&nodes, &active)).collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        let zones: Vec<Option<usize>> = found.iter().map(|f| f.1).collect();
        assert!(zones[0] == zones[1] && zones[2].is_none() && zones[3] == zones[4] && zones[0] != zones[3]);
    }

    #[test]
    fn shares_of_simplices() {
        for (values, share) in [
            (vec![1.0, -3.0], 0.25),
            (vec![-1.0, 3.0], 0.75),
            (vec![1.0, -1.0, -1.0], 0.25),
            (vec![1.0, 1.0, -1.0], 0.75),
            (vec![2.0, 1.0, 0.5], 1.0),
            (vec![-2.0, -1.0, 0.0], 0.0),
        ] {
            assert_eq!(share_above(&values), share, "{values:?}");
        }
    }
}
