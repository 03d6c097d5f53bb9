//! Forces of the supports on the bodies.
//!
//! A reaction acts along the directions that its support constrains. Where supports meet, the force on a function is the
//! sum of forces along all their directions; a direction that several supports constrain counts with the first of them.
//! So every force is counted once: the forces of all supports, loads and contacts sum to zero.

use crate::model::Model;
use crate::supports::beds;
use nalgebra::{DMatrix, DVector};
use signorini_geometry::Point;
use std::collections::HashSet;

impl<const D: usize> Model<D> {
    /// The force of each support. `unbalanced` is what the supports give to every unknown of the bodies, elastic beds
    /// apart; `u` the displacement.
    pub(crate) fn support_forces(&self, unbalanced: &[f64], u: &[f64]) -> Vec<Point<D>> {
        let mut out = vec![Point::<D>::zeros(); self.supports.len()];
        // Functions of vertices sum to one: forces on them sum to the resultant.
        let vertices: HashSet<usize> = self.bodies.list.iter().flat_map(|b| b.vertex_unknowns()).collect();
        for vertex in self.bodies.list.iter().flat_map(|b| b.vertex_unknowns()) {
            let force = Point::<D>::from_fn(|i, _| unbalanced[vertex + i]);
            let mut directions: Vec<(usize, Point<D>)> = Vec::new();
            let mut basis: Vec<Point<D>> = Vec::new();
            for (support, direction) in self.reduction.constraints((vertex / D) as u32) {
                let mut rest = direction;
                for b in &basis {
                    rest -= b * b.dot(&rest);
                }
                if rest.norm() > 1e-9 {
                    basis.push(rest.normalize());
                    directions.push((support, direction));
                }
            }
            let gram =
                DMatrix::from_fn(directions.len(), directions.len(), |r, c| directions[r].1.dot(&directions[c].1));
            let along = DVector::from_iterator(directions.len(), directions.iter().map(|(_, d)| d.dot(&force)));
            let Some(shares) = gram.cholesky().map(|factor| factor.solve(&along)) else { continue };
            for ((support, direction), share) in directions.iter().zip(shares.iter()) {
                out[*support] += direction * *share;
            }
        }
        for (support, unknowns, matrix) in beds(&self.bodies, &self.supports) {
            let n = unknowns.len();
            let forces = (0..n).map(|r| -(0..n).map(|c| matrix[r * n + c] * u[unknowns[c] as usize]).sum::<f64>());
            let forces: Vec<f64> = forces.collect();
            let on_vertices = (0..n).step_by(D).filter(|&place| vertices.contains(&(unknowns[place] as usize)));
            out[support] += on_vertices.map(|place| Point::<D>::from_fn(|i, _| forces[place + i])).sum::<Point<D>>();
        }
        out
    }
}
