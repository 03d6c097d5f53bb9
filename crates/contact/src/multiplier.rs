//! Nodes of the contact pressure on the slave surface, and the normal field through them.
//!
//! The pressure lives on the Gauss-Lobatto nodes of the slave faces, as many per face as the displacement has functions
//! there. On a spline it belongs to the functions of the trace, which reach over several faces, and the node of a function is at
//! its Greville abscissae. A node on a feature edge, where normals differ by more than [`FEATURE_ANGLE`], exists once per side of
//! it; a function of a spline does where the faces that it reaches meet at such an edge.

use crate::surface::ContactSurface;
use signorini_basis::cell_map::CellMap;
use signorini_basis::hierarchic::Values;
use signorini_basis::{CellShape, Local};
use signorini_geometry::Point;
use std::collections::HashMap;

/// Cosine of the angle between face normals beyond which an edge is a feature: 30 degrees.
pub const FEATURE_ANGLE: f64 = 0.866_025_403_784_438_6;

/// Where a node sits, so that faces that meet find the same one.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Place {
    Vertex(u32),
    /// Lower and higher vertex, and the share of the way from the lower, in millionths.
    Edge(u32, u32, u32),
    Interior(u32, u32),
    /// The function of a spline by its unknown.
    Function(u32),
}

/// The nodes of a slave surface.
#[derive(Clone)]
pub struct PressureNodes<const D: usize> {
    maps: Vec<CellMap>,
    map_of: Vec<usize>,
    /// Node number and unit normal, for every node of every face.
    faces: Vec<Vec<(u32, Point<D>)>>,
    pub positions: Vec<Point<D>>,
    /// Face and coordinates of each node.
    places: Vec<(usize, Local)>,
    /// Of the faces of splines the normals at their vertices.
    at_vertices: Vec<Vec<Point<D>>>,
}

impl<const D: usize> PressureNodes<D> {
    pub fn new(surface: &dyn ContactSurface<D>) -> Self {
        let mut maps: Vec<CellMap> = Vec::new();
        let mut map_of = Vec::new();
        // Faces and local nodes at each place, with their unit normals.
        let mut places: HashMap<Place, usize> = HashMap::new();
        let mut members: Vec<Vec<(usize, usize, Point<D>)>> = Vec::new();
        let mut positions_at = Vec::new();
        let mut at_vertices = Vec::new();
        for face in 0..surface.face_count() {
            let (shape, degree) = (surface.shape(face), surface.degree(face));
            let spline = surface.spline(face);
            let same = |m: &CellMap| m.is_polynomial(shape, degree);
            let found = if spline.is_some() { None } else { maps.iter().position(same) };
            let map = found.unwrap_or_else(|| {
                maps.push(spline.map_or_else(|| CellMap::new(shape, degree), |spline| spline.map.clone()));
                maps.len() - 1
            });
            map_of.push(map);
            let vertices = surface.vertices(face);
            let normal_at = |s: &Local| surface.at(face, s).area_normal().normalize();
            at_vertices.push(match spline {
                Some(_) => shape.vertices().iter().map(normal_at).collect(),
                None => Vec::new(),
            });
            for (k, s) in maps[map].nodes().iter().enumerate() {
                let point = surface.at(face, s);
                let normal = point.area_normal().normalize();
                let place = match spline {
                    Some(spline) => Place::Function(spline.unknowns[k]),
                    None => place(shape, &vertices, face, k, s),
                };
                let at = *places.entry(place).or_insert_with(|| {
                    members.push(Vec::new());
                    positions_at.push(point.x);
                    members.len() - 1
                });
                members[at].push((face, k, normal));
            }
        }
        let mut faces: Vec<Vec<(u32, Point<D>)>> =
            map_of.iter().map(|&m| vec![(0, Point::<D>::zeros()); maps[m].len()]).collect();
        let mut positions = Vec::new();
        let mut placed = Vec::new();
        for (list, x) in members.iter().zip(positions_at) {
            // Smooth neighbourhoods of the place, each with its mean normal.
            let mut groups: Vec<Vec<usize>> = Vec::new();
            for (m, (face, _, n)) in list.iter().enumerate() {
                let meets = |o: &usize| match at_vertices[*face].is_empty() {
                    true => list[*o].2.dot(n) >= FEATURE_ANGLE,
                    false => meet_smoothly(surface, &at_vertices, [*face, list[*o].0]),
                };
                let smooth = |g: &Vec<usize>| g.iter().any(meets);
                let mut joined = vec![m];
                groups.retain(|g| {
                    let joins = smooth(g);
                    if joins {
                        joined.extend(g);
                    }
                    !joins
                });
                groups.push(joined);
            }
            groups.sort();
            for group in groups {
                let number = positions.len() as u32;
                // The face on which a function of a spline has its node, and else the first.
                let off = |m: &&usize| beyond(&maps[map_of[list[**m].0]], list[**m].1);
                let own = *group.iter().min_by(|a, b| off(a).total_cmp(&off(b)).then(a.cmp(b))).unwrap_or(&group[0]);
                let (face, k, _) = list[own];
                let s = maps[map_of[face]].nodes()[k];
                positions.push(if at_vertices[face].is_empty() { x } else { surface.at(face, &s).x });
                placed.push((face, s));
                let normal = group.iter().map(|&m| list[m].2).sum::<Point<D>>().normalize();
                for m in group {
                    let (face, k, _) = list[m];
                    faces[face][k] = (number, normal);
                }
            }
        }
        PressureNodes { maps, map_of, faces, positions, places: placed, at_vertices }
    }

    /// Face and coordinates of every node.
    pub fn places(&self) -> &[(usize, Local)] {
        &self.places
    }

    /// Whether a node of a face lies on it: those of splines may lie on other faces.
    pub fn lies_on(&self, face: usize, place: usize) -> bool {
        beyond(self.map(face), place) < 1e-9
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    pub fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// Numbers of the nodes of a face, and the normals there.
    pub fn of_face(&self, face: usize) -> &[(u32, Point<D>)] {
        &self.faces[face]
    }

    pub fn map(&self, face: usize) -> &CellMap {
        &self.maps[self.map_of[face]]
    }

    /// The same nodes with other normals, of any length, by face and place on it.
    pub fn with_normals(&self, normal: &dyn Fn(usize, &Local) -> Point<D>) -> Self {
        let mut out = self.clone();
        for (face, list) in out.faces.iter_mut().enumerate() {
            let places = self.map(face).nodes();
            let corners = out.at_vertices[face].iter_mut().zip(self.map(face).shape().vertices());
            corners.for_each(|(own, s)| *own = normal(face, s));
            list.iter_mut().zip(&places).for_each(|(own, s)| own.1 = normal(face, s));
        }
        out
    }

    /// The normal field, not of unit length, and its derivatives.
    pub fn normal(&self, face: usize, s: &Local, at: &mut Values) -> (Point<D>, [Point<D>; 2]) {
        let mut normal = Point::<D>::zeros();
        let mut slopes = [Point::<D>::zeros(); 2];
        let corners = &self.at_vertices[face];
        if !corners.is_empty() {
            let shape = self.map(face).shape();
            for (c, n) in corners.iter().enumerate() {
                normal += n * shape.vertex_function(c, s);
                let along = shape.vertex_slopes(c, s);
                (0..D - 1).for_each(|k| slopes[k] += n * along[k]);
            }
            return (normal, slopes);
        }
        self.map(face).tabulate(s, at);
        for ((_, n), (value, gradient)) in self.faces[face].iter().zip(at.value.iter().zip(&at.gradient)) {
            normal += n * *value;
            for k in 0..D - 1 {
                slopes[k] += n * gradient[k];
            }
        }
        (normal, slopes)
    }
}

/// How far beyond a face the node of a function of a spline lies, in coordinates of the face; zero of other faces.
fn beyond(map: &CellMap, place: usize) -> f64 {
    map.rational().map_or(0.0, |basis| map.shape().beyond(&basis.greville(place)).max(0.0))
}

/// Whether two faces have a vertex in common at which they are one smooth surface.
fn meet_smoothly<const D: usize>(
    surface: &dyn ContactSurface<D>,
    normals: &[Vec<Point<D>>],
    [a, b]: [usize; 2],
) -> bool {
    let (own, other) = (surface.vertices(a), surface.vertices(b));
    let smooth = |(k, v): (usize, &u32)| {
        let l = other.iter().position(|w| w == v);
        l.and_then(|l| normals[b].get(l)).is_some_and(|n| normals[a][k].dot(n) >= FEATURE_ANGLE)
    };
    own.iter().enumerate().any(smooth)
}

fn place(shape: CellShape, vertices: &[u32], face: usize, node: usize, s: &Local) -> Place {
    let corners = shape.vertices();
    let distance = |a: &Local, b: &Local| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt();
    if let Some(v) = corners.iter().position(|c| distance(c, s) < 1e-9) {
        return Place::Vertex(vertices[v]);
    }
    if shape != CellShape::Line {
        for &[a, b] in shape.edges() {
            let (length, from, to) =
                (distance(&corners[a], &corners[b]), distance(&corners[a], s), distance(&corners[b], s));
            if (from + to - length).abs() < 1e-9 {
                let (low, high) = (vertices[a].min(vertices[b]), vertices[a].max(vertices[b]));
                let share = if vertices[a] == low { from / length } else { to / length };
                return Place::Edge(low, high, (share * 1e6).round() as u32);
            }
        }
    }
    Place::Interior(face as u32, node as u32)
}

/// A node that gave its function to another and shares its pressure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MergedNode {
    pub from: u32,
    pub to: u32,
    /// Because its function has no weight anywhere.
    pub weightless: bool,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Polyline;

    /// Nodes are shared along what is smooth, and exist once for each side of an edge of more than thirty degrees.
    #[test]
    fn nodes_are_double_at_sharp_edges_only() {
        let roof = |height: f64| {
            PressureNodes::new(&Polyline(vec![
                Point::<2>::new(-1.0, 0.0),
                Point::<2>::new(0.0, height),
                Point::<2>::new(1.0, 0.0),
            ]))
        };
        let (blunt, sharp) = (roof(0.2), roof(0.3));
        assert_eq!((blunt.len(), sharp.len()), (3, 4));
        let middle = |nodes: &PressureNodes<2>| [nodes.of_face(0)[1], nodes.of_face(1)[0]];
        let [left, right] = middle(&blunt);
        assert_eq!(left.0, right.0);
        assert!((left.1 - Point::<2>::new(0.0, -1.0)).norm() < 1e-15);
        let [left, right] = middle(&sharp);
        assert!(left.0 != right.0);
        let own = Point::<2>::new(0.3, -1.0).normalize();
        assert!((left.1 - own).norm() < 1e-15 && (right.1 - Point::<2>::new(-own[0], own[1])).norm() < 1e-15);
        assert_eq!(sharp.positions[left.0 as usize], sharp.positions[right.0 as usize]);
    }
}
