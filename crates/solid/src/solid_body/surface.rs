//! A surface of a solid as contact by mortar sees it: faces, points on them, and an averaged normal.

use super::SolidBody;
use super::faces::{Faces, Surface};
use super::spatial::spatial;
use crate::body::BodySurface;
use rayon::prelude::*;
use signorini_fem::Local;
use signorini_geometry::Matrix;
use signorini_mechanics::pair::axis;
use signorini_mechanics::surface::Faces as AnyFaces;
use signorini_mechanics::{Direction, Function, SlavePoint};
use std::any::Any;
use std::sync::OnceLock;

/// A surface where it is now.
pub(super) struct PlacedSurface<'a, const D: usize> {
    faces: &'a Faces<D>,
    surface: &'a Surface<D>,
    u: &'a [f64],
    /// The averaged normal at the corners of each face, once it is asked for.
    corners: OnceLock<Vec<Vec<Direction>>>,
    youngs_modulus: f64,
    degree: f64,
}

impl<const D: usize> SolidBody<D> {
    /// The surface of a group that has sides.
    pub(super) fn placed_surface<'a>(&'a self, group: &str, u: &'a [f64]) -> PlacedSurface<'a, D> {
        let surface = self.faces.surface(group);
        let body = self.body();
        PlacedSurface {
            faces: &self.faces,
            surface,
            u,
            corners: OnceLock::new(),
            youngs_modulus: body.material.youngs_modulus,
            degree: body.degree as f64,
        }
    }
}

impl<const D: usize> signorini_mechanics::Surface for PlacedSurface<'_, D> {
    fn faces(&self) -> (AnyFaces<'_>, &[f64]) {
        let any = &self.surface.boundary as &dyn Any;
        let faces = match (any.downcast_ref::<BodySurface<2>>(), any.downcast_ref::<BodySurface<3>>()) {
            (Some(plane), _) => AnyFaces::Plane(plane),
            (_, Some(space)) => AnyFaces::Space(space),
            _ => unreachable!("a solid is plane or in space"),
        };
        (faces, self.u)
    }

    fn corners(&self, face: usize) -> &[Direction] {
        let of = |list: &Vec<_>| list.iter().map(|normal: &Vec<_>| Faces::<D>::direction(normal, self.u)).collect();
        let all = || self.faces.vertex_normals(self.surface).par_iter().map(of).collect();
        &self.corners.get_or_init(all)[face]
    }

    fn placed(&self, face: usize, s: &Local) -> SlavePoint {
        let number = self.surface.faces[face];
        let list = self.faces.slopes(number, s);
        let at = self.faces.current(number, s, &list, self.u);
        let mut moved = Vec::with_capacity(D * list.len());
        for (f, d) in &list {
            for i in 0..D {
                let unknown = D as u32 * f + i as u32;
                moved.push(Function { unknown, value: axis(i) * d[0], ..Function::default() });
            }
        }
        SlavePoint {
            x: spatial(&at.x),
            outward: Some(spatial(&at.area_normal().normalize())),
            functions: moved,
            frame: Matrix::<3>::identity(),
            ..SlavePoint::default()
        }
    }

    fn depth(&self, face: usize) -> f64 {
        self.faces.face(self.surface.faces[face]).depth
    }

    /// Young's modulus over the depth of the cell, in parts of its degree.
    fn stiffness(&self, face: usize) -> f64 {
        self.youngs_modulus * self.degree / self.depth(face)
    }
}
