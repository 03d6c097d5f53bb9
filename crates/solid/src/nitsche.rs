//! Nitsche's method: the pressure at a point of the slave side by the stress there, without unknowns of its own.

use crate::body::Bodies;
use crate::contact::{Contact, Enforcement, Method, RigidGap};
use crate::stiffness::{Table, normal_stress};
use signorini_contact::{ContactSurface, GapJet, Shares, Tests, compress, looks_at, weighted_gaps};
use signorini_fem::Local;
use signorini_geometry::Point;
use std::collections::HashMap;

impl<const D: usize> Contact<D> {
    /// Whether every row is a quadrature point.
    pub(crate) fn at_points(&self) -> bool {
        self.method == Method::GaussPoint || self.enforcement == Enforcement::Nitsche
    }

    /// `c` over the stiffness of the adjacent cells.
    pub(crate) fn nitsche_factor(&self) -> f64 {
        (self.slave.body().degree as f64).powi(2)
    }

    /// One row for every point of the segments that looks at a rigid master, or faces another body; rows have the number
    /// of their point.
    pub(crate) fn point_rows(&mut self, rigid: Option<&RigidGap<D>>) {
        self.points = self.cut_at_rest(rigid);
        let mut own = Shares::default();
        let mut places = Vec::new();
        for (face, list) in self.points.iter().enumerate() {
            let mut of_face = Vec::new();
            for p in list {
                let looks = p.master.is_some() || looks_at(&self.slave.at(face, &p.s).area_normal(), &p.direction);
                let weight = if looks { p.weight } else { 0.0 };
                of_face.push(vec![(own.weight.len() as u32, weight)]);
                own.weight.push(weight);
                places.push((face, p.s));
            }
            own.of_point.push(of_face);
        }
        self.rows = weighted_gaps(&self.slave, self.master.surface(), &self.points, &own);
        self.places = self.rows.iter().map(|row| places[row.node as usize]).collect();
        self.tests = Tests::in_the_mean(&self.points, &own);
        self.given = self.weightless.clone();
    }

    /// `1/c ∫ δσ σ` over all points, which the method adds to the stiffness; nothing with other enforcements. The points
    /// do not depend on where a rigid master is.
    pub(crate) fn stress_terms(&mut self, bodies: &Bodies<D>) -> Vec<(Vec<u32>, Vec<f64>)> {
        if self.enforcement != Enforcement::Nitsche {
            return Vec::new();
        }
        let points: Vec<(usize, Local, f64)> = if self.method == Method::Mortar {
            let far: RigidGap<D> = Box::new(|_| GapJet::flat(1.0, Point::<D>::zeros()));
            let cut = self.cut_at_rest(Some(&far));
            cut.iter().enumerate().flat_map(|(face, list)| list.iter().map(move |p| (face, p.s, p.weight))).collect()
        } else {
            let tests = Tests::at_quadrature_points(&self.slave);
            tests.points.iter().zip(&tests.rows).map(|(point, row)| (point.face, point.s, row.weight)).collect()
        };
        let body = self.slave.body();
        let mut stresses = Vec::with_capacity(points.len());
        let mut tables: HashMap<(usize, usize), Table> = HashMap::new();
        let mut out = Vec::new();
        for (face, s, weight) in points {
            let side = self.slave.sides[face];
            let cell = side.cell as usize;
            let basis = body.dofs.basis(cell);
            let key = (body.mesh.map_number(cell), body.dofs.basis_number(cell));
            let table = tables.entry(key).or_insert_with(|| Table::new(&body.mesh, &body.dofs, cell));
            let (xi, _) = basis.shape().on_side(side.side as usize, &s);
            let normal = self.slave.at(face, &s).area_normal().normalize();
            let along = normal_stress(&body.mesh, cell, table, basis, (&body.material, bodies.space), (&xi, &normal));
            let stress: Vec<(u32, f64)> = (body.dofs.cell(cell).enumerate())
                .flat_map(|(a, (f, sign))| {
                    let first = body.first + f as usize * D;
                    let along = &along;
                    (0..D).map(move |i| ((first + i) as u32, sign * along[a * D + i]))
                })
                .collect();
            let factor = weight / (self.nitsche_factor() * self.face_stiffness[face]);
            let matrix = (stress.iter().flat_map(|(_, a)| stress.iter().map(move |(_, b)| factor * a * b))).collect();
            out.push((stress.iter().map(|(unknown, _)| *unknown).collect(), matrix));
            stresses.push(stress);
        }
        self.stresses = stresses;
        out
    }

    /// Rows of `g - σ/c` with `σ = -n·σ n`, whose pressures push with `g + σ/c`: the skew-symmetric variant.
    pub(crate) fn add_stresses(&mut self) {
        self.bare = self.rows.clone();
        let factor = self.nitsche_factor();
        for (row, stiffness) in self.rows.iter_mut().zip(&self.stiffness) {
            let stress = &self.stresses[row.node as usize];
            let share = row.weight / (factor * stiffness);
            row.forces = row.terms.clone();
            row.terms.extend(stress.iter().map(|(unknown, c)| (*unknown, share * c)));
            row.forces.extend(stress.iter().map(|(unknown, c)| (*unknown, -share * c)));
            compress(&mut row.terms);
            compress(&mut row.forces);
        }
    }
}
