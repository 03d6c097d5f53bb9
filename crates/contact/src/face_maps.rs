//! Faces as the polynomials that they are, through points on them, or as spans of splines: a place is found without the cell
//! behind it.

use crate::face_point::FacePoint;
use signorini_basis::cell_map::CellMap;
use signorini_basis::hierarchic::Values;
use signorini_basis::{CellShape, Local};
use signorini_geometry::Point;

/// What a face is as a map.
pub enum FaceForm<'a, const D: usize> {
    /// A polynomial of this order.
    Polynomial(CellShape, usize),
    /// A span of a spline, with its control points.
    Spline(&'a CellMap, Vec<Point<D>>),
}

/// The maps of a list of faces.
pub struct FaceMaps<const D: usize> {
    maps: Vec<CellMap>,
    /// Its map, and the points of each face: of order 1 in the order of the vertices, else of the nodes of the map.
    faces: Vec<(usize, Vec<Point<D>>)>,
}

impl<const D: usize> FaceMaps<D> {
    /// Faces of the given forms, with the places of points on those that are polynomials.
    pub fn new<'a>(forms: impl Iterator<Item = FaceForm<'a, D>>, at: impl Fn(usize, &Local) -> Point<D>) -> Self {
        let mut maps: Vec<CellMap> = Vec::new();
        let mut faces = Vec::new();
        for (face, form) in forms.enumerate() {
            let (shape, order) = match form {
                FaceForm::Polynomial(shape, order) => (shape, order),
                FaceForm::Spline(map, points) => {
                    faces.push((maps.len(), points));
                    maps.push(map.clone());
                    continue;
                }
            };
            let same = |m: &CellMap| m.is_polynomial(shape, order);
            let map = maps.iter().position(same).unwrap_or_else(|| {
                maps.push(CellMap::new(shape, order));
                maps.len() - 1
            });
            let nodes = if order == 1 { shape.vertices().to_vec() } else { maps[map].nodes() };
            faces.push((map, nodes.iter().map(|s| at(face, s)).collect()));
        }
        FaceMaps { maps, faces }
    }

    /// A point of a face, or near it.
    pub fn at(&self, face: usize, s: &Local) -> FacePoint<D> {
        let (map, points) = &self.faces[face];
        let map = &self.maps[*map];
        let mut out = FacePoint { x: Point::<D>::zeros(), tangents: [Point::<D>::zeros(); 2] };
        let mut add = |x: &Point<D>, value: f64, slopes: [f64; 2]| {
            out.x += x * value;
            (0..D - 1).for_each(|a| out.tangents[a] += x * slopes[a]);
        };
        if map.order() == 1 && map.rational().is_none() {
            let shape = map.shape();
            let list = points.iter().enumerate();
            list.for_each(|(k, x)| add(x, shape.vertex_function(k, s), shape.vertex_slopes(k, s)));
        } else {
            let mut values = Values::default();
            map.tabulate(s, &mut values);
            let list = points.iter().zip(&values.value).zip(&values.gradient);
            list.for_each(|((x, value), slopes)| add(x, *value, [slopes[0], slopes[1]]));
        }
        out
    }
}
