//! A surface of a solid as contact by mortar sees it: faces, points on them, and an averaged normal.

use super::SolidBody;
use super::faces::{Faces, Surface, merge, vertex_function};
use super::master::functions;
use super::spatial;
use crate::body::BodySurface;
use rayon::prelude::*;
use signorini_fem::Local;
use signorini_geometry::shape::{CurveJet, SurfaceJet};
use signorini_geometry::{Matrix, Vector};
use signorini_mechanics::pair::axis;
use signorini_mechanics::surface::Faces as AnyFaces;
use signorini_mechanics::{Bend, Direction, Foot, Function, MaterialPoint, Placed};
use std::any::Any;

/// A surface where it is now.
pub(super) struct PlacedSurface<'a, const D: usize> {
    faces: &'a Faces<D>,
    surface: &'a Surface<D>,
    u: &'a [f64],
    /// The averaged normal at the corners of each face.
    corners: Vec<Vec<Direction>>,
    youngs_modulus: f64,
    degree: f64,
}

impl<const D: usize> SolidBody<D> {
    /// The surface of a group that has sides.
    pub(super) fn placed_surface<'a>(&'a self, group: &str, u: &'a [f64]) -> PlacedSurface<'a, D> {
        let surface = self.faces.surface(group);
        let corners = |of: &Vec<_>| of.iter().map(|normal: &Vec<_>| Faces::<D>::direction(normal, u)).collect();
        let body = self.body();
        PlacedSurface {
            faces: &self.faces,
            surface,
            u,
            corners: self.faces.vertex_normals(surface).par_iter().map(corners).collect(),
            youngs_modulus: body.material.youngs_modulus,
            degree: body.degree as f64,
        }
    }
}

impl<const D: usize> PlacedSurface<'_, D> {
    /// The corners of a face that count at a point, and how much.
    fn shares(&self, face: usize, s: &Local) -> impl Iterator<Item = (f64, &Direction)> {
        let shape = self.faces.face(self.surface.faces[face]).shape;
        let values = shape.vertices().iter().map(|corner| vertex_function(shape, corner, s)).collect::<Vec<_>>();
        values.into_iter().zip(&self.corners[face]).filter(|(v, _)| *v != 0.0)
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

    fn normal(&self, face: usize, s: &Local) -> Vector<3> {
        self.shares(face, s).map(|(share, corner)| corner.vector * share).sum()
    }

    fn placed(&self, face: usize, s: &Local, bends: bool) -> Placed {
        let number = self.surface.faces[face];
        let list = self.faces.slopes(number, s);
        let at = self.faces.current(number, s, &list, self.u);
        let mut averaged = Direction::default();
        for (share, corner) in self.shares(face, s) {
            averaged.vector += corner.vector * share;
            averaged.functions.extend(corner.functions.iter().map(|f| Function { value: f.value * share, ..*f }));
            if bends {
                averaged.bends.extend(corner.bends.iter().map(|b| Bend { value: b.value * share, ..*b }));
            }
        }
        merge(&mut averaged.functions);
        let mut moved = Vec::with_capacity(D * list.len());
        for (f, d) in &list {
            for i in 0..D {
                let unknown = D as u32 * f + i as u32;
                moved.push(Function { unknown, value: axis(i) * d[0], ..Function::default() });
            }
        }
        Placed {
            x: spatial(&at.x),
            outward: Some(spatial(&at.area_normal().normalize())),
            averaged: Some(averaged),
            functions: moved,
            frame: Matrix::<3>::identity(),
            ..Placed::default()
        }
    }

    fn met(&self, face: usize, s: &Local) -> Foot {
        let number = self.surface.faces[face];
        let list = self.faces.slopes(number, s);
        let at = self.faces.current(number, s, &list, self.u);
        let zero = Vector::<3>::zeros();
        let [u, v] = at.tangents.each_ref().map(spatial);
        let x = spatial(&at.x);
        let jet = if D == 2 {
            SurfaceJet::strip(&CurveJet { x, d1: u, d2: zero, d3: zero })
        } else {
            SurfaceJet { x, u, v, uu: zero, uv: zero, vv: zero, uuu: zero, uuv: zero, uvv: zero, vvv: zero }
        };
        Foot {
            point: MaterialPoint { patch: face as u32, xi: *s },
            jet,
            coordinates: 2,
            outward: Some(spatial(&at.area_normal().normalize())),
            radius: 0.0,
            functions: functions::<D>(&list, |d| [d[1], d[2], 0.0, 0.0, 0.0]),
            spin: Vec::new(),
            spin_bends: Vec::new(),
            frame: Matrix::<3>::identity(),
        }
    }

    /// Young's modulus over the depth of the cell, in parts of its degree.
    fn stiffness(&self, face: usize) -> f64 {
        self.youngs_modulus * self.degree / self.faces.face(self.surface.faces[face]).depth
    }
}
