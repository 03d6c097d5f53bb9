//! Forces on parts of the boundary and in the volume.

use crate::body::CellBody;
use crate::error::CellsError;
use crate::place::Place;
use crate::space::Tabulation;
use signorini_geometry::{Point, Vector};
use std::sync::Arc;

/// A vector at a position.
pub type VectorField<const D: usize> = Arc<dyn Fn(&Point<D>) -> Vector<D> + Send + Sync>;

/// A load.
#[derive(Clone)]
pub enum Load<const D: usize> {
    /// Force per length or area before the body deforms.
    Traction { on: Place<D>, value: VectorField<D> },
    /// Pressure on the boundary as it is before the body deforms; positive pushes in.
    Pressure { on: Place<D>, value: crate::body::Field<D> },
    /// Force per volume of material.
    BodyForce { value: VectorField<D> },
}

impl<const D: usize> CellBody<D> {
    /// Adds the work of a load on every unknown to `forces`.
    ///
    /// # Errors
    /// A place without material.
    pub fn add_load(&self, load: &Load<D>, forces: &mut [f64]) -> Result<(), CellsError> {
        let mut t = Tabulation::default();
        let mut add = |cell: usize, x: &Point<D>, force: Vector<D>| {
            self.functions_at(cell, x, &mut t);
            for (f, value) in self.cells()[cell].functions.iter().zip(&t.value) {
                (0..D).for_each(|k| forces[D * *f as usize + k] += force[k] * value);
            }
        };
        match load {
            Load::Traction { on, value } => {
                self.points_on(on)?.iter().for_each(|s| add(s.cell, &s.x, value(&s.x) * s.weight));
            }
            Load::Pressure { on, value } => {
                self.points_on(on)?.iter().for_each(|s| add(s.cell, &s.x, s.normal * (-value(&s.x) * s.weight)));
            }
            Load::BodyForce { value } => self.for_each_volume_point(|cell, x, w| add(cell, x, value(x) * w)),
        }
        Ok(())
    }
}
