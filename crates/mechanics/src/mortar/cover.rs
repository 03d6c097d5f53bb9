//! Where the slave side of a mortar contact sees its master: points on the slave faces, and how much each counts for which
//! node of the pressure.
//!
//! Pieces and gaps are those of the current configuration, weights those of the reference one: the dual functions of faces
//! that are covered completely are then always the same.

use super::facing::Facing;
use super::within::Within;
use crate::shown_surface::ShownSurface;
use crate::surface::{Faces, Local, Surface};
use signorini_contact::{
    ContactSurface, GapPoint, MergedNode, Moved, PressureNodes, Sight, Sighting, dual_weights_unmerged, pieces,
    segments, shares, whole_faces,
};
use signorini_geometry::{Point, Vector};
use std::collections::BTreeMap;

/// The nodes of the pressure, with normals of the averaged field.
pub(super) enum Nodes {
    Plane(PressureNodes<2>),
    Space(PressureNodes<3>),
}

/// A point of a face of the master that a point of the slave sees along its averaged normal.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Seen {
    pub face: usize,
    pub s: Local,
    pub gap: f64,
    /// Unit vector from there to the slave.
    pub normal: Vector<3>,
}

/// A point of the slave side.
#[derive(Clone, Debug)]
pub(super) struct CoveredPoint {
    pub face: usize,
    pub s: Local,
    /// What it sees of another surface; none of a rigid master.
    pub master: Option<Seen>,
    /// Nodes, and the dual function of each times the reference area of the point.
    pub shares: Vec<(u32, f64)>,
}

/// The part of the slave side that sees its master.
#[derive(Clone)]
pub(super) struct FacingPart {
    /// By face.
    pub points: Vec<Vec<CoveredPoint>>,
    /// Integral of the dual function of each node.
    pub weight: Vec<f64>,
    /// Nodes whose function another one took.
    pub given: Vec<MergedNode>,
}

impl FacingPart {
    fn none(nodes: usize) -> Self {
        FacingPart { points: Vec::new(), weight: vec![0.0; nodes], given: Vec::new() }
    }
}

/// How pieces are found and integrated.
#[derive(Clone, Debug)]
pub(super) struct Search {
    pub reach: f64,
    /// Points of a piece along each direction beyond those that its degree asks for.
    pub extra: usize,
    pub facing: Facing,
    /// Whether what sees what is found with the bodies at rest, once: by as many points as integrate exactly, and without nodes
    /// that are hardly covered.
    pub at_rest: bool,
}

impl Nodes {
    pub fn new(faces: Faces<'_>) -> Nodes {
        match faces {
            Faces::Plane(faces) => Nodes::Plane(PressureNodes::new(faces)),
            Faces::Space(faces) => Nodes::Space(PressureNodes::new(faces)),
        }
    }

    pub fn is_plane(&self) -> bool {
        matches!(self, Nodes::Plane(_))
    }

    /// Face and point of every node.
    pub fn places(&self) -> Vec<(usize, Local)> {
        match self {
            Nodes::Plane(nodes) => nodes.places().to_vec(),
            Nodes::Space(nodes) => nodes.places().to_vec(),
        }
    }

    /// The numbers of the nodes of each face.
    pub fn of_faces(&self) -> Vec<Vec<u32>> {
        fn list<const D: usize>(nodes: &PressureNodes<D>) -> Vec<Vec<u32>> {
            (0..nodes.face_count()).map(|face| nodes.of_face(face).iter().map(|node| node.0).collect()).collect()
        }
        match self {
            Nodes::Plane(nodes) => list(nodes),
            Nodes::Space(nodes) => list(nodes),
        }
    }

    /// The flat faces between the nodes.
    pub fn faces(&self) -> Option<ShownSurface> {
        match self {
            Nodes::Plane(nodes) => ShownSurface::new(nodes, &Some),
            Nodes::Space(nodes) => ShownSurface::new(nodes, &Some),
        }
    }

    /// All of the slave side; `merged` nodes have no pressure of their own.
    pub fn whole(&self, slave: &dyn Surface, faces: &Facing, merged: &[bool]) -> FacingPart {
        match (self, slave.faces().0) {
            (Nodes::Plane(nodes), Faces::Plane(of)) => whole(nodes, of, faces, merged),
            (Nodes::Space(nodes), Faces::Space(of)) => whole(nodes, of, faces, merged),
            _ => FacingPart::none(merged.len()),
        }
    }

    /// Which faces of a surface see each other in a state.
    pub fn sightings(&self, surface: &dyn Surface, (reach, within): (f64, &Within)) -> Vec<Sighting> {
        match (self, surface.faces()) {
            (Nodes::Plane(nodes), (Faces::Plane(of), u)) => sightings(nodes, of, (surface, u), (reach, within)),
            (Nodes::Space(nodes), (Faces::Space(of), u)) => sightings(nodes, of, (surface, u), (reach, within)),
            _ => Vec::new(),
        }
    }

    /// The points of faces that may face the other side and are near it.
    pub fn near(
        &self,
        slave: &dyn Surface,
        facing: &Facing,
        merged: &[bool],
        is_near: &dyn Fn(usize, &Local) -> bool,
    ) -> FacingPart {
        match (self, slave.faces().0) {
            (Nodes::Plane(nodes), Faces::Plane(of)) => near(nodes, of, facing, merged, is_near),
            (Nodes::Space(nodes), Faces::Space(of)) => near(nodes, of, facing, merged, is_near),
            _ => FacingPart::none(merged.len()),
        }
    }

    /// What of the slave side sees the master.
    pub fn cut(&self, slave: &dyn Surface, master: &dyn Surface, search: &Search, merged: &[bool]) -> FacingPart {
        match (self, slave.faces().0, master.faces().0) {
            (Nodes::Plane(nodes), Faces::Plane(a), Faces::Plane(b)) => {
                cut(nodes, [a, b], [slave, master], search, merged)
            }
            (Nodes::Space(nodes), Faces::Space(a), Faces::Space(b)) => {
                cut(nodes, [a, b], [slave, master], search, merged)
            }
            _ => FacingPart::none(merged.len()),
        }
    }
}

fn whole<const D: usize>(
    nodes: &PressureNodes<D>,
    faces: &dyn ContactSurface<D>,
    facing: &Facing,
    merged: &[bool],
) -> FacingPart {
    let mut points = whole_faces(faces);
    points.iter_mut().enumerate().filter(|(face, _)| !facing.slave(*face)).for_each(|(_, list)| list.clear());
    cover(nodes, faces, points, (merged, false))
}

fn near<const D: usize>(
    nodes: &PressureNodes<D>,
    faces: &dyn ContactSurface<D>,
    facing: &Facing,
    merged: &[bool],
    is_near: &dyn Fn(usize, &Local) -> bool,
) -> FacingPart {
    let mut points = whole_faces(faces);
    for (face, list) in points.iter_mut().enumerate() {
        list.retain(|p| facing.slave(face) && is_near(face, &p.s));
    }
    cover(nodes, faces, points, (merged, true))
}

fn cut<const D: usize>(
    nodes: &PressureNodes<D>,
    [slave, master]: [&dyn ContactSurface<D>; 2],
    placed: [&dyn Surface; 2],
    search: &Search,
    merged: &[bool],
) -> FacingPart {
    let nodes = nodes.with_normals(&|face, s| {
        let normal = placed[0].normal(face, s);
        Point::<D>::from_fn(|k, _| normal[k])
    });
    let sees = |face: usize, other: usize| search.facing.sees(face, other);
    let sight = Sight { reach: search.reach, deepest: &|face| search.facing.deepest(face), sees: &sees };
    if search.at_rest {
        let points = segments(slave, master, &nodes, sight);
        return cover(&nodes, slave, points, (merged, true));
    }
    let moved = Moved::new(slave, placed[0].faces().1);
    let other = Moved::new(master, placed[1].faces().1);
    let mut points = pieces(&moved, &other, &nodes, (sight, search.extra));
    for (face, list) in points.iter_mut().enumerate() {
        for point in list {
            let area = |faces: &dyn ContactSurface<D>| {
                let at = faces.at(face, &point.s);
                at.area_normal().norm() * faces.measure(&at.x)
            };
            point.weight *= area(slave) / area(&moved);
        }
    }
    cover(&nodes, slave, points, (merged, false))
}

/// Which faces of a surface see each other, whatever their roles.
fn sightings<const D: usize>(
    nodes: &PressureNodes<D>,
    faces: &dyn ContactSurface<D>,
    (surface, u): (&dyn Surface, &[f64]),
    (reach, within): (f64, &Within),
) -> Vec<Sighting> {
    let nodes = nodes.with_normals(&|face, s| {
        let normal = surface.normal(face, s);
        Point::<D>::from_fn(|k, _| normal[k])
    });
    let moved = Moved::new(faces, u);
    let sees = |face: usize, other: usize| within.may_meet(face, other);
    let sight = Sight { reach, deepest: &|face| within.deepest(face), sees: &sees };
    let points = pieces(&moved, &moved, &nodes, (sight, 0));
    let mut out = Vec::new();
    for (face, list) in points.iter().enumerate() {
        let mut nearest: BTreeMap<u32, f64> = BTreeMap::new();
        for (point, (other, _)) in list.iter().filter_map(|p| Some((p, p.master?))) {
            let distance = nearest.entry(other).or_insert(f64::INFINITY);
            *distance = distance.min(point.gap.abs());
        }
        out.extend(nearest.into_iter().map(|(master, distance)| Sighting { slave: face as u32, master, distance }));
    }
    out
}

fn cover<const D: usize>(
    nodes: &PressureNodes<D>,
    slave: &dyn ContactSurface<D>,
    points: Vec<Vec<GapPoint<D>>>,
    (merged, at_rest): (&[bool], bool),
) -> FacingPart {
    let found = if at_rest { shares } else { dual_weights_unmerged };
    let shares = found(slave, nodes, &points, &|k| merged[k as usize]);
    let of_face = |(face, (list, shares)): (usize, (Vec<GapPoint<D>>, Vec<Vec<(u32, f64)>>))| {
        let list = list.into_iter().zip(shares);
        let seen = |p: &GapPoint<D>| {
            let normal = Vector::<3>::from_fn(|k, _| if k < D { p.direction[k] } else { 0.0 });
            p.master.map(|(other, s)| Seen { face: other as usize, s, gap: p.gap, normal })
        };
        let of = |(p, shares): (GapPoint<D>, Vec<(u32, f64)>)| CoveredPoint { face, s: p.s, master: seen(&p), shares };
        list.map(of).collect()
    };
    let points = points.into_iter().zip(shares.of_point).enumerate().map(of_face).collect();
    FacingPart { points, weight: shares.weight, given: shares.given }
}
