//! The inertia of a beam: mass along its line, and sections that turn.

use super::body::{Beam, NODE, NUMBERS};
use crate::mass;
use signorini_geometry::{Matrix, Point, Vector};
use signorini_mechanics::SpinInertia;
use signorini_mechanics::body::{Body, BodyState, Inertial, Mass, PlaceError};
use std::collections::BTreeMap;

impl signorini_mechanics::Thermal for Beam {}

impl Inertial for Beam {
    /// Rotations count at nodes and middles, by Simpson's rule.
    fn mass(&self, _: &[Option<&str>]) -> Result<Option<Mass>, PlaceError> {
        let Some(own) = &self.mass else { return Ok(None) };
        let mut out = mass::consistent(&self.line, own.mass, NODE);
        let mut lengths: BTreeMap<u32, f64> = BTreeMap::new();
        for e in 0..self.elements.len() {
            let parts = self.spins_of(e).into_iter().zip([1.0, 1.0, 4.0]);
            parts.for_each(|(u, part)| *lengths.entry(u).or_default() += self.line.lengths[e] * part / 6.0);
        }
        let start = self.start();
        out.spins = (lengths.into_iter())
            .map(|(first, length)| {
                let frame = self.frame(&start, first);
                let own = Matrix::<3>::from_diagonal(&(Vector::<3>::from(own.inertia) * length));
                let inertia = frame * own * frame.transpose();
                SpinInertia { unknowns: [first, first + 1, first + 2], inertia }
            })
            .collect();
        Ok(Some(out))
    }

    /// A section stays normal to the line: `ω = t × v'/|t| + (ω·t) t`.
    fn turn_sections(&self, velocities: &mut [f64], turning: &dyn Fn(&Point<3>) -> Vector<3>) {
        let mut of_line = vec![0.0; self.start.len()];
        for node in 0..self.line.nodes() {
            of_line[NUMBERS * node..NUMBERS * node + 6].copy_from_slice(&velocities[NODE * node..NODE * node + 6]);
        }
        for element in 0..self.elements.len() {
            for (first, xi) in self.spins_of(element).into_iter().zip([0.0, 1.0, 0.5]) {
                let (at, change) = (self.line.jet(&self.start, element, xi), self.line.jet(&of_line, element, xi));
                let t = at.d1.normalize();
                let spin = t.cross(&change.d1) / at.d1.norm() + t * t.dot(&turning(&at.x));
                velocities[first as usize..first as usize + 3].copy_from_slice(spin.as_slice());
            }
        }
    }

    fn orientation(&self, state: &BodyState, unknowns: [u32; 3]) -> Matrix<3> {
        self.frame(state, unknowns[0]) * self.frame(&self.start(), unknowns[0]).transpose()
    }
}
