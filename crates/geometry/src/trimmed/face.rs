//! Faces: parts of surfaces within loops of edges.

use super::edge::{FaceUse, foot_on, sample};
use super::face_surface::FaceSurface;
use super::region::Region;
use super::spline_tree::SplineTree;
use super::{Edge, SolidError, Wrong};
use crate::shape::Curve;
use crate::{Aabb, Point, Vector};

/// A face as it is stated.
#[derive(Clone, Debug)]
pub struct FaceData {
    pub surface: FaceSurface,
    /// Whether the normal of the surface points out of the body.
    pub is_outward: bool,
    /// Edges one after the other, each with whether it is followed forwards: seen from outside, the face is on the left.
    pub loops: Vec<Vec<(usize, bool)>>,
}

#[derive(Clone, Debug)]
pub(super) struct Face {
    pub surface: FaceSurface,
    /// 1 where the normal of the surface points out of the body, else -1.
    pub sign: f64,
    pub uses: Vec<FaceUse>,
    pub region: Region,
    pub size: f64,
    /// Of a spline.
    pub tree: Option<SplineTree>,
    /// The largest distance of an edge from the surface.
    pub gap: f64,
}

/// Distance of chords from edges, in sizes of the face: a hundred chords for the outline of a disc.
const CHORDS: f64 = 1e-3;
/// Sizes of a face, from an edge, beyond which nothing of it lies.
const FAR: f64 = 10.0;
/// Sizes of a face by which a point within it may be beyond its edges: what rounding leaves of a few operations.
const ROUNDING: f64 = 1e-12;

/// A value of a periodic parameter at which no loop runs, in the middle of the largest gap; none where loops go all around.
fn free_of_edges(uses: &[FaceUse], k: usize, period: f64) -> Option<f64> {
    let mut covered: Vec<[f64; 2]> = Vec::new();
    for w in uses.iter().filter(|u| !u.is_seam).flat_map(|u| u.samples.windows(2)) {
        let (low, high) = (w[0].1[k].min(w[1].1[k]), w[0].1[k].max(w[1].1[k]));
        let from = low.rem_euclid(period);
        covered.push([from, from + high - low]);
    }
    covered.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut end = covered.iter().map(|c| c[1] - period).fold(f64::NEG_INFINITY, f64::max);
    // What reaches over the end of the period covers its beginning.
    let mut best = (0.0, 0.0);
    for [from, to] in covered.iter().copied() {
        if from - end > best.0 {
            best = (from - end, 0.5 * (from + end));
        }
        end = end.max(to);
    }
    if covered.is_empty() {
        return None;
    }
    // A thousandth of a turn is no place between edges.
    (best.0 > 1e-3 * period).then_some(best.1)
}

impl Face {
    pub fn new(number: usize, data: FaceData, edges: &[Edge], tolerance: f64) -> Result<Self, SolidError> {
        let FaceData { surface, is_outward, loops } = data;
        let own: Vec<&Curve> = loops.iter().flatten().map(|(e, _)| &edges[*e].curve).collect();
        let hull = own.iter().map(|c| c.atlas.hull()).map(|h| Aabb::new(h[0], h[1])).reduce(|a, b| a.joined(&b));
        let size = match (&surface, hull) {
            (_, Some(hull)) => hull.size().norm(),
            (FaceSurface::Sphere { radius, .. }, _) => 2.0 * radius,
            (FaceSurface::Torus { major, minor, .. }, _) => 2.0 * (major + minor),
            (FaceSurface::Spline(s), _) => s.size(),
            _ => return Err(SolidError::face(number, Wrong::NoLoop { noun: surface.noun() })),
        };
        let scale = surface.scale(size);
        let mut uses = Vec::new();
        let (mut deviation, mut gap) = (0.0f64, (0.0, Point::<3>::zeros()));
        for (of_loop, list) in loops.iter().enumerate() {
            for &(edge, forward) in list {
                let found = sample(&surface, &edges[edge].curve, scale, CHORDS * size);
                deviation = deviation.max(found.deviation);
                if found.gap.0 > gap.0 {
                    gap = found.gap;
                }
                if found.gap.0 > tolerance {
                    let (distance, at) = found.gap;
                    let wrong = Wrong::OffSurface { noun: surface.noun(), distance, at };
                    return Err(SolidError { edge: Some(edge), ..SolidError::face(number, wrong) });
                }
                let is_seam = loops.iter().flatten().any(|other| *other == (edge, !forward));
                uses.push(FaceUse { edge, forward, of_loop, is_seam, samples: found.list });
            }
        }
        let periods = surface.periods();
        // Where a period begins there is no edge, or else there is where a loop begins, as other loops are likely to do.
        let begin = uses.first().map(|u| if u.forward { u.samples[0].1 } else { u.samples[u.samples.len() - 1].1 });
        let ends = match &surface {
            FaceSurface::Spline(s) => s.domain().map(|d| d[0]),
            _ => [0.0; 2],
        };
        let is_spline = matches!(surface, FaceSurface::Spline(_));
        let free = |k: usize| periods[k].and_then(|p| free_of_edges(&uses, k, p));
        let begin = begin.unwrap_or(ends);
        let start = if is_spline { ends } else { [0, 1].map(|k| free(k).unwrap_or(begin[k])) };
        let region = Region::new(&uses, [scale, start], periods, is_outward, deviation);
        // No face goes on without end.
        let beyond = |k: usize, v: f64| {
            let mut far = begin;
            far[k] += v * FAR * size;
            region.signed(far).0 > 0.0
        };
        let is_endless = match &surface {
            FaceSurface::Plane { .. } => beyond(0, 1.0) || beyond(0, -1.0) || beyond(1, 1.0) || beyond(1, -1.0),
            FaceSurface::Cylinder { .. } => beyond(1, 1.0) || beyond(1, -1.0),
            FaceSurface::Cone { .. } => beyond(1, 1.0),
            _ => false,
        };
        if is_endless {
            return Err(SolidError::face(number, Wrong::Empty { noun: surface.noun() }));
        }
        let sign = if is_outward { 1.0 } else { -1.0 };
        let mut face = Face { surface, sign, uses, region, size, tree: None, gap: gap.0 };
        if let FaceSurface::Spline(s) = &face.surface {
            face.tree = Some(SplineTree::new(s, &face.region));
        }
        Ok(face)
    }

    /// Whether a point of the surface with these parameters is of the face; `edges` are those of the body.
    pub fn contains(&self, z: [f64; 2], x: &Point<3>, edges: &[Edge]) -> bool {
        let (distance, _) = self.region.signed(z);
        if distance.abs() > self.region.band {
            return distance > 0.0;
        }
        // The edges themselves decide: the nearest one, or both that meet where it ends.
        let close = self.region.near(z, distance.abs() + 2.0 * self.region.band);
        // Distance, vertex where it is one, foot, and the way into the face.
        let mut found: Vec<(f64, Option<usize>, Point<3>, Vector<3>)> = Vec::new();
        for (of, t) in close {
            let use_ = &self.uses[of];
            let edge = &edges[use_.edge];
            let (t, jet, is_end) = foot_on(&edge.curve, x, t);
            let Some(normal) = self.normal(&jet.x, use_.near(t)) else { continue };
            let inwards = normal.cross(&use_.along(&jet)).try_normalize(0.0).unwrap_or_default();
            let vertex = is_end.then(|| edge.ends[usize::from(t > edge.curve.domain()[0])]);
            found.push(((jet.x - x).norm(), vertex, jet.x, inwards));
        }
        let Some(&(_, vertex, foot, own)) = found.iter().min_by(|a, b| a.0.total_cmp(&b.0)) else {
            return distance > 0.0;
        };
        let both = found.iter().filter(|f| f.1 == vertex).map(|f| f.3).sum::<Vector<3>>();
        (x - foot).dot(&if vertex.is_some() { both } else { own }) >= -ROUNDING * self.size
    }

    /// The unit normal out of the body.
    pub fn normal(&self, x: &Point<3>, z: [f64; 2]) -> Option<Vector<3>> {
        self.surface.normal(x, z).map(|n| n * self.sign)
    }

    /// The outward normal at a point of an edge, and its parameters.
    pub fn normal_on(&self, of: usize, t: f64, x: &Point<3>) -> (Option<Vector<3>>, [f64; 2]) {
        let z = self.surface.parameters(x, Some(self.uses[of].near(t)));
        (self.normal(x, z), z)
    }

    /// A box that holds the face: its edges, and where the surface turns within it.
    pub fn bounds(&self, edges: &[Edge]) -> Aabb<3> {
        if let Some(tree) = &self.tree {
            return tree.bounds();
        }
        let of_edge = |use_: &FaceUse| {
            let [low, high] = *edges[use_.edge].curve.atlas.hull();
            Aabb::new(low, high)
        };
        let mut turns: Vec<Point<3>> = Vec::new();
        for k in 0..6 {
            let e = Vector::<3>::ith(k % 3, if k < 3 { 1.0 } else { -1.0 });
            match &self.surface {
                FaceSurface::Sphere { axes, radius } => turns.push(axes.origin + e * *radius),
                FaceSurface::Torus { axes, major, minor } => {
                    let across = (e - axes.ez * axes.ez.dot(&e)).try_normalize(1e-12).unwrap_or(axes.ex);
                    turns.extend([1.0, -1.0].map(|side| axes.origin + across * (side * major) + e * *minor));
                }
                FaceSurface::Cone { axes, .. } => turns.push(axes.origin),
                _ => {}
            }
        }
        let is_cone = matches!(self.surface, FaceSurface::Cone { .. });
        let turns = turns.into_iter().filter(|x| {
            is_cone && self.has_apex() || !is_cone && self.contains(self.surface.parameters(x, None), x, edges)
        });
        let inner = Aabb::around(turns);
        let outer = self.uses.iter().map(of_edge).reduce(|a, b| a.joined(&b));
        match (inner, outer) {
            (Some(a), Some(b)) => a.joined(&b),
            (Some(a), None) | (None, Some(a)) => a,
            (None, None) => Aabb::new(Point::<3>::zeros(), Point::<3>::zeros()),
        }
    }

    /// Directions around a singular point, at which parameters are looked at.
    const AROUND: usize = 64;

    /// Whether the apex of a cone is of the face.
    pub fn has_apex(&self) -> bool {
        matches!(self.surface, FaceSurface::Cone { .. }) && !self.around([0.0, 0.0]).is_empty()
    }

    /// Where all `u` are one point of the face: parameters of directions that lie within it, a small way off.
    pub fn around(&self, singular: [f64; 2]) -> Vec<[f64; 2]> {
        let (from, length) = match &self.surface {
            FaceSurface::Spline(s) => (s.domain()[0][0], s.domain()[0][1] - s.domain()[0][0]),
            _ => (0.0, std::f64::consts::TAU),
        };
        let away = match &self.surface {
            FaceSurface::Spline(s) => {
                let d = s.domain()[1];
                1e-6 * if singular[1] - d[0] < d[1] - singular[1] { d[1] - d[0] } else { d[0] - d[1] }
            }
            _ => 1e-6 * self.size,
        };
        (0..Self::AROUND)
            .map(|k| [from + length * (k as f64 + 0.5) / Self::AROUND as f64, singular[1] + away])
            .filter(|z| self.region.signed(*z).0 > 0.0)
            .collect()
    }
}
