//! The traction by the stress of a solid of small strains at a tested point, for Nitsche's method.

use super::SolidBody;
use super::faces::Faces;
use super::spatial::spatial;
use crate::stiffness::{Table, traction};
use signorini_geometry::Point;
use signorini_mechanics::{BodyState, Direction, Function, Site};

impl<const D: usize> SolidBody<D> {
    /// `σ n` with the normal at rest, and what changes it; none at edges, and of materials other than uniform linear elastic ones.
    pub(super) fn traction_at(&self, state: &BodyState, site: &Site) -> Option<Direction> {
        if !self.material.is_uniform_hooke() || self.edge_at(site).is_some() {
            return None;
        }
        let rows = self.faces.point(site).traction.get_or_init(|| self.traction_rows(&self.faces, site));
        let mut out = Direction::default();
        for (unknown, value) in rows {
            let value = spatial(value);
            out.vector += value * state.configuration[*unknown as usize];
            out.functions.push(Function { unknown: *unknown, value, ..Function::default() });
        }
        Some(out)
    }

    /// The traction on the first face of a tested point by each unknown of its cell.
    fn traction_rows(&self, faces: &Faces<D>, site: &Site) -> Vec<(u32, Point<D>)> {
        let body = self.body();
        let Some(face) = faces.faces_of(site).next() else { return Vec::new() };
        let side = faces.face(face).side;
        let (cell, s) = (side.cell as usize, [site.xi[0], site.xi[1], 0.0]);
        let basis = body.dofs.basis(cell);
        let (xi, _) = basis.shape().on_side(side.side as usize, &s);
        let normal = faces.reference(face, &s).area_normal().normalize();
        let table = Table::new(&body.mesh, &body.dofs, cell);
        let law = (&body.material, self.bodies.space);
        let values = traction(&body.mesh, cell, &table, basis, law, (&xi, &normal));
        let functions = body.dofs.cell(cell).enumerate();
        let of = |(a, (f, sign)): (usize, (u32, f64))| {
            (0..D).map(|i| (D as u32 * f + i as u32, values[a * D + i] * sign)).collect::<Vec<_>>()
        };
        functions.flat_map(of).collect()
    }
}
