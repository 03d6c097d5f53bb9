//! Equations of a side of the box: a prescribed displacement, projected in the mean square on the functions that do not
//! vanish there.

use super::CellSolid;
use crate::body::CellBody;
use crate::error::CellsError;
use crate::place::side_gauss;
use crate::shapes::spatial;
use crate::space::Tabulation;
use signorini_fem::cut::End;
use signorini_geometry::{Point, Vector};
use signorini_mechanics::pair::axis;
use signorini_mechanics::{Constraint, Hold, PlaceError};
use signorini_solve::{Factor, Symbolic, SymmetricMatrix};
use std::collections::BTreeMap;

/// A quadrature point with the functions there, by their place among those of the side.
struct SidePoint<const D: usize> {
    x: Point<D>,
    weight: f64,
    values: Vec<(u32, f64)>,
}

/// The functions that do not vanish on a side of the box.
pub(super) struct SideFunctions<const D: usize> {
    functions: Vec<u32>,
    points: Vec<SidePoint<D>>,
    /// Of their mass on the side.
    mass: Factor,
}

impl<const D: usize> SideFunctions<D> {
    /// # Errors
    /// A side that no cell with material touches.
    pub fn new(body: &CellBody<D>, axis: usize, end: End) -> Result<Self, CellsError> {
        let on_side = |f: u32| {
            let mode = body.mode(f as usize);
            mode.ids[axis] == if end == End::High { body.tree().count(mode.level, axis) } else { 0 }
        };
        let mut numbers: BTreeMap<u32, u32> = BTreeMap::new();
        let cells = body.cells_on(axis, end);
        for &c in &cells {
            for &f in body.cells()[c].functions.iter().filter(|f| on_side(**f)) {
                let next = numbers.len() as u32;
                numbers.entry(f).or_insert(next);
            }
        }
        if numbers.is_empty() {
            return Err(body.empty_place("a side of the box"));
        }
        let (mut points, mut parts) = (Vec::new(), Vec::new());
        let mut t = Tabulation::default();
        for &c in &cells {
            let places: Vec<(usize, u32)> = (body.cells()[c].functions.iter().enumerate())
                .filter_map(|(i, f)| Some((i, *numbers.get(f)?)))
                .collect();
            let n = places.len();
            let mut mass = vec![0.0; n * n];
            for p in side_gauss(body.bounds_of(c), axis, end, body.degree() + 4) {
                body.functions_at(c, &p.x, &mut t);
                let values: Vec<(u32, f64)> = places.iter().map(|(i, number)| (*number, t.value[*i])).collect();
                for (a, (_, v)) in values.iter().enumerate() {
                    for (b, (_, w)) in values.iter().enumerate() {
                        mass[a * n + b] += p.weight * v * w;
                    }
                }
                points.push(SidePoint { x: p.x, weight: p.weight, values });
            }
            parts.push((places.iter().map(|p| p.1).collect::<Vec<u32>>(), mass));
        }
        let mass = Symbolic::default().factor(SymmetricMatrix::of_cliques(numbers.len(), &parts))?;
        let mut functions = vec![0; numbers.len()];
        numbers.iter().for_each(|(f, number)| functions[*number as usize] = *f);
        Ok(SideFunctions { functions, points, mass })
    }

    /// Coefficients of the field that is nearest to a value on the side.
    fn project(&self, value: &dyn Fn(&Point<3>) -> f64) -> Result<Vec<f64>, CellsError> {
        let mut rhs = vec![0.0; self.functions.len()];
        for p in &self.points {
            let target = p.weight * value(&spatial(&p.x));
            p.values.iter().for_each(|(k, v)| rhs[*k as usize] += v * target);
        }
        if rhs.iter().all(|r| *r == 0.0) {
            return Ok(rhs);
        }
        Ok(self.mass.solve(&rhs)?)
    }
}

impl<const D: usize> CellSolid<D> {
    pub(super) fn constraints(
        &self,
        side: &SideFunctions<D>,
        hold: &Hold<'_>,
        u: &[f64],
    ) -> Result<Vec<Constraint>, PlaceError> {
        let mut out = Vec::new();
        for i in 0..D {
            let Some(field) = hold.displacement[i] else { continue };
            let wanted = side.project(field).map_err(|e| self.unsuitable(e.to_string()))?;
            for (&f, wanted) in side.functions.iter().zip(wanted) {
                let Some(unknown) = self.unknown(f, i) else { continue };
                // Forces on the functions that add up to one make the resultant, in their shares.
                let share = self.linear.one[f as usize];
                let (factor, counts) = if share == 0.0 { (1.0, 0.0) } else { (1.0 / share, 1.0) };
                let violation = factor * (u[unknown as usize] - wanted);
                let reaction = [axis(i) * counts, Vector::<3>::zeros()];
                out.push(Constraint { terms: vec![(unknown, factor)], violation, reaction });
            }
        }
        Ok(out)
    }
}
