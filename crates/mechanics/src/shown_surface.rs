//! The tested surface of a contact as it is drawn: flat faces between the tested points, and where the zone of contact ends.

use crate::site_result::SiteResult;
use crate::surface::{Faces, Local, Surface};
use signorini_basis::CellShape;
use signorini_basis::cell_map::CellMap;
use signorini_contact::{ContactSurface, ContactZone, NodeState, PressureNodes, Status, unpressed, zone};
use signorini_geometry::Point;
use std::collections::{HashMap, HashSet};

/// A surface of faces between the sites of a contact, where it is in a state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShownSurface {
    /// Flat faces, lines in the plane, by the numbers of their sites.
    pub faces: Vec<Vec<u32>>,
    /// The face of the surface that each of them is a part of.
    pub of_face: Vec<usize>,
    /// Where the zone ends: points in the plane, given twice, and pieces of its outline in space.
    pub boundary: Vec<[Point<3>; 2]>,
    /// The face of the surface that each of these is on.
    pub boundary_face: Vec<usize>,
    /// In the plane, the intervals in contact.
    pub intervals: Vec<[Point<3>; 2]>,
    /// Sites without an equation of their own.
    pub shared: Vec<SharedSite>,
}

/// A site that touches where another one does, such as one on a support or on the axis of rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SharedSite {
    pub site: u32,
    pub with: u32,
    /// The recovered pressure there.
    pub pressure: f64,
    /// Whether no area belongs to it: it lies on the axis.
    pub weightless: bool,
}

impl ShownSurface {
    /// The surface between the pressure nodes of its faces; `site` tells the site that a node is, none where one is none.
    pub(crate) fn new<const D: usize>(nodes: &PressureNodes<D>, site: &dyn Fn(u32) -> Option<u32>) -> Option<Self> {
        let mut out = ShownSurface::default();
        // Functions of splines reach over several faces.
        let mut seen: HashSet<Vec<u32>> = HashSet::new();
        for face in 0..nodes.face_count() {
            let list = nodes.of_face(face);
            let mut parts = flat(nodes.map(face));
            if nodes.map(face).rational().is_some() {
                parts.retain(|part| seen.insert(part.iter().map(|k| list[*k].0).collect()));
            }
            out.of_face.extend(std::iter::repeat_n(face, parts.len()));
            for part in parts {
                out.faces.push(part.iter().map(|k| site(list[*k].0)).collect::<Option<Vec<u32>>>()?);
            }
        }
        Some(out)
    }

    /// With the zone of contact, where the surface is now.
    pub(crate) fn with_zone(mut self, zone: &ContactZone, surface: &dyn Surface) -> Self {
        let moved = |(face, ends): &(usize, [Local; 2])| ends.map(|s| surface.point(*face, &s).x);
        self.boundary = zone.boundary.iter().map(moved).collect();
        self.boundary_face = zone.boundary.iter().map(|b| b.0).collect();
        self.intervals = zone.intervals.iter().map(moved).collect();
        self
    }
}

/// The flat parts of a face between its nodes.
fn flat(map: &CellMap) -> Vec<Vec<usize>> {
    let (shape, n) = (map.shape(), map.order());
    match shape {
        CellShape::Line => (0..n).map(|i| vec![i, i + 1]).collect(),
        CellShape::Triangle if n == 1 => vec![vec![0, 1, 2]],
        // Vertices first, then the middles of the edges.
        CellShape::Triangle => vec![vec![0, 3, 5], vec![3, 1, 4], vec![5, 4, 2], vec![3, 4, 5]],
        _ => {
            let corner = |k: usize| k / n * (n + 1) + k % n;
            (0..n * n).map(|k| [0, 1, n + 2, n + 1].map(|o| corner(k) + o).to_vec()).collect()
        }
    }
}

/// Sites closer than this part of the size of the surface are the same place.
const SAME: f64 = 1e-9;

/// The surface between sites that are the nodes of its faces: `rest` are their places at rest. None where they are not.
pub(crate) fn between_sites(surface: &dyn Surface, rest: &[Point<3>], results: &[SiteResult]) -> Option<ShownSurface> {
    match surface.faces().0 {
        Faces::Plane(faces) => between(surface, faces, rest, results),
        Faces::Space(faces) => between(surface, faces, rest, results),
    }
}

fn between<const D: usize>(
    surface: &dyn Surface,
    faces: &dyn ContactSurface<D>,
    rest: &[Point<3>],
    results: &[SiteResult],
) -> Option<ShownSurface> {
    let nodes = PressureNodes::new(faces);
    let size = rest.iter().map(|x| x.amax()).fold(f64::MIN_POSITIVE, f64::max);
    let key = |x: [f64; 3]| x.map(|v| (v / (SAME * size)).round() as i64);
    let sites: HashMap<[i64; 3], u32> = rest.iter().map(|x| key((*x).into())).zip(0..).collect();
    let place = |x: &Point<D>| key(std::array::from_fn(|k| if k < D { x[k] } else { 0.0 }));
    let site_of: Vec<Option<u32>> = nodes.positions.iter().map(|x| sites.get(&place(x)).copied()).collect();
    let state = |site: &Option<u32>| match site.map(|k| &results[k as usize]) {
        Some(SiteResult { gap: Some(gap), status: Status::Open, .. }) => NodeState::Open(Some(*gap)),
        Some(SiteResult { gap: Some(_), .. }) => NodeState::Active,
        _ => NodeState::Bare,
    };
    let states: Vec<NodeState> = site_of.iter().map(state).collect();
    let zone = zone(faces, &nodes, &unpressed(faces, &nodes), &states);
    Some(ShownSurface::new(&nodes, &|k| site_of[k as usize])?.with_zone(&zone, surface))
}
