//! The temperature of a solid, in the functions of its displacement: conduction, capacity, and heat that comes in.
//!
//! Small strains and rotations or not, heat flows in the reference configuration: the conductivity is that of the undeformed
//! body.

use super::SolidBody;
use super::projection::project;
use super::spatial::spatial;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use signorini_contact::ShapeFunction;
use signorini_fem::Group;
use signorini_fem::hierarchic::Mode;
use signorini_fem::small::{determinant, inverse};
use signorini_geometry::Point;
use signorini_mechanics::body::Field;
use signorini_mechanics::heat::{Block, Blocks, Thermal, ThermalBody};
use signorini_mechanics::{BodyState, PlaceError};
use std::sync::{Arc, OnceLock};

/// A constant of a material by place.
pub type Constant = Arc<dyn Fn(&Point<3>) -> f64 + Send + Sync>;

/// How a solid expands and conducts.
#[derive(Clone)]
pub struct ThermalMaterial {
    /// Thermal strain per temperature, the same in all directions; none of a body that does not expand.
    pub expansion: Option<Constant>,
    /// The temperature without thermal strain.
    pub stress_free: f64,
    /// The temperature at the start.
    pub initial: Constant,
    /// Heat per time, length and temperature; none of a body whose temperature is known.
    pub conductivity: Option<Constant>,
    /// Heat per volume and temperature, `ρ c`.
    pub capacity: Option<f64>,
}

/// The same with what follows from it.
pub(super) struct Heated {
    pub material: ThermalMaterial,
    /// Coefficients of the initial temperature.
    pub initial: Vec<f64>,
    conduction: OnceLock<Blocks>,
    capacity: OnceLock<Blocks>,
}

impl<const D: usize> SolidBody<D> {
    /// The solid with a temperature.
    #[must_use]
    pub fn with_heat(mut self, material: ThermalMaterial) -> Self {
        let initial = self.coefficients_of(&*material.initial);
        let (conduction, capacity) = (OnceLock::new(), OnceLock::new());
        self.heated = Some(Heated { material, initial, conduction, capacity });
        self
    }

    /// Coefficients of a field on the whole body.
    fn coefficients_of(&self, field: Field<'_>) -> Vec<f64> {
        let mesh = self.mesh();
        let cells = (0..mesh.cell_count() as u32).collect();
        let group = Group { cells, sides: mesh.all_sides().collect(), ..Group::default() };
        let mut out = vec![0.0; self.dofs().count()];
        self.fitted(&group, field).into_iter().for_each(|(f, value)| out[f as usize] = value);
        if self.body().degree > 1 && !self.dofs().is_spline() {
            self.fit_interior(field, &mut out);
        }
        out
    }

    /// The coefficients of a field on a group: at vertices its values, on edges and sides the best fit.
    fn fitted(&self, group: &Group, field: Field<'_>) -> Vec<(u32, f64)> {
        let at = |x: &Point<D>| Point::<D>::from_fn(|i, _| if i == 0 { field(&spatial(x)) } else { 0.0 });
        project(self.body(), group, &at).into_iter().map(|(f, value)| (f, value[0])).collect()
    }

    /// Fits the functions inside of cells to what all others leave over.
    fn fit_interior(&self, field: Field<'_>, out: &mut [f64]) {
        let body = self.body();
        for cell in 0..body.mesh.cell_count() {
            let modes = body.dofs.basis(cell).modes();
            let inner: Vec<usize> = (0..modes.len()).filter(|k| matches!(modes[*k], Mode::Interior)).collect();
            if inner.is_empty() {
                continue;
            }
            let table = self.table(cell);
            let list: Vec<(u32, f64)> = body.dofs.cell(cell).collect();
            let n = inner.len();
            let (mut mass, mut rhs) = (DMatrix::<f64>::zeros(n, n), DVector::<f64>::zeros(n));
            for (q, (_, w)) in table.points.iter().enumerate() {
                let (x, jacobian) = body.mesh.jacobian(cell, &table.map[q]);
                let weight = w * determinant(&jacobian).abs();
                let value = &table.basis[q].value;
                let known: f64 = (0..list.len())
                    .filter(|k| !inner.contains(k))
                    .map(|k| list[k].1 * value[k] * out[list[k].0 as usize])
                    .sum();
                let left = field(&spatial(&x)) - known;
                for a in 0..n {
                    rhs[a] += weight * value[inner[a]] * left;
                    (0..n).for_each(|b| mass[(a, b)] += weight * value[inner[a]] * value[inner[b]]);
                }
            }
            if let Some(factor) = mass.cholesky() {
                let found = factor.solve(&rhs);
                inner.iter().zip(found.iter()).for_each(|(k, c)| out[list[*k].0 as usize] = list[*k].1 * c);
            }
        }
    }

    /// Blocks of all cells, of a form of values and gradients at a point.
    fn cell_blocks(&self, form: &(dyn Fn(&Point<D>, f64, f64, &Point<D>, &Point<D>) -> f64 + Sync)) -> Blocks {
        let body = self.body();
        let of = |cell: usize| -> Block {
            let table = self.table(cell);
            let (functions, signs): (Vec<u32>, Vec<f64>) = body.dofs.cell(cell).unzip();
            let n = functions.len();
            let mut values = vec![0.0; n * n];
            for (q, (_, w)) in table.points.iter().enumerate() {
                let (x, jacobian) = body.mesh.jacobian(cell, &table.map[q]);
                let weight = w * determinant(&jacobian) * self.bodies.measure(&x);
                let inverse = inverse(&jacobian);
                let basis = &table.basis[q];
                let slope =
                    |a: usize| Point::<D>::from_fn(|j, _| (0..D).map(|k| basis.gradient[a][k] * inverse[(k, j)]).sum());
                let slopes: Vec<Point<D>> = (0..n).map(slope).collect();
                for (a, row) in values.chunks_mut(n).enumerate() {
                    for (b, value) in row.iter_mut().enumerate() {
                        let own = form(&x, basis.value[a], basis.value[b], &slopes[a], &slopes[b]);
                        *value += weight * signs[a] * signs[b] * own;
                    }
                }
            }
            (functions, values)
        };
        (0..body.mesh.cell_count()).into_par_iter().map(of).collect()
    }
}

/// Sums each row on its diagonal. Functions of degree one then store heat node by node, and a short increment of time lets no
/// temperature fall where heat comes in beside it.
fn lump((functions, values): &mut Block) {
    let n = functions.len();
    for (a, row) in values.chunks_mut(n).enumerate() {
        let sum = row.iter().sum();
        row.fill(0.0);
        row[a] = sum;
    }
}

impl<const D: usize> Thermal for SolidBody<D> {
    fn thermal(&self) -> Option<&dyn ThermalBody> {
        self.heated.as_ref().map(|_| self as &dyn ThermalBody)
    }
}

impl<const D: usize> ThermalBody for SolidBody<D> {
    fn count(&self) -> usize {
        self.dofs().count()
    }

    fn dimension(&self) -> usize {
        D
    }

    fn conducts(&self) -> bool {
        self.heated.as_ref().is_some_and(|own| own.material.conductivity.is_some())
    }

    fn temperature<'a>(&self, state: &'a BodyState) -> &'a [f64] {
        self.temperature_of(state)
    }

    fn set_temperature(&self, state: &mut BodyState, temperature: &[f64]) {
        self.give_temperature(state, temperature);
    }

    fn coefficients(&self, field: Field<'_>) -> Vec<f64> {
        self.coefficients_of(field)
    }

    fn held(&self, on: Option<&str>, field: Field<'_>) -> Result<Vec<(u32, f64)>, PlaceError> {
        if on.is_none() {
            return Ok((0u32..).zip(self.coefficients_of(field)).collect());
        }
        let group = self.group(on)?;
        if !group.between.is_empty() {
            return Err(self.unsuitable("nodes in the middle of edges hold no temperature: name sides or vertices"));
        }
        let mut list: std::collections::BTreeMap<u32, f64> =
            super::projection::functions(self.body(), group).into_iter().map(|f| (f, 0.0)).collect();
        if list.is_empty() {
            return Err(self.unsuitable(format!("`{}` has nothing that could have a temperature", on.unwrap_or("all"))));
        }
        list.extend(self.fitted(group, field));
        Ok(list.into_iter().collect())
    }

    fn unity(&self) -> Vec<bool> {
        self.vertex_functions()
    }

    fn conduction(&self) -> &[Block] {
        let Some(own) = &self.heated else { return &[] };
        let Some(conductivity) = &own.material.conductivity else { return &[] };
        own.conduction.get_or_init(|| self.cell_blocks(&|x, _, _, a, b| conductivity(&spatial(x)) * a.dot(b)))
    }

    fn capacity(&self) -> Option<&[Block]> {
        let own = self.heated.as_ref()?;
        let capacity = own.material.capacity?;
        Some(own.capacity.get_or_init(|| {
            let mut blocks = self.cell_blocks(&|_, a, b, _, _| capacity * a * b);
            if self.body().degree == 1 {
                blocks.iter_mut().for_each(lump);
            }
            blocks
        }))
    }

    fn add_source(&self, on: Option<&str>, source: Field<'_>, out: &mut [f64]) -> Result<(), PlaceError> {
        self.in_cells(on, "heat per volume", &mut |x, volume, list| {
            let heat = source(x) * volume;
            list.for_each(|(f, v)| out[f as usize] += v * heat);
        })
    }

    fn add_flux(&self, on: Option<&str>, flux: Field<'_>, out: &mut [f64]) -> Result<(), PlaceError> {
        self.on_sides(on, &mut |x, area, list| {
            let heat = flux(x) * area;
            list.iter().for_each(|f| out[f.unknown as usize / D] += f.value * heat);
        })
        .map(|_| ())
    }

    fn film(&self, on: Option<&str>, coefficient: Field<'_>) -> Result<Blocks, PlaceError> {
        let mut out = Blocks::new();
        self.on_sides(on, &mut |x, area, list: &[ShapeFunction]| {
            let (n, value) = (list.len(), coefficient(x) * area);
            let functions = list.iter().map(|f| f.unknown / D as u32).collect();
            out.push((functions, (0..n * n).map(|k| value * list[k / n].value * list[k % n].value).collect()));
        })?;
        Ok(out)
    }

    fn range(&self, state: &BodyState) -> [f64; 2] {
        let t = self.temperature_of(state);
        let vertices = self.vertex_functions();
        // Control points of splines lie beyond the field; values between vertices are left to the quadrature points.
        let at_vertices = t
            .iter()
            .zip(&vertices)
            .filter(|(_, is)| **is && !self.dofs().is_spline())
            .map(|(t, _)| *t)
            .collect::<Vec<_>>();
        let points = (0..self.mesh().cell_count()).flat_map(|cell| self.temperatures_at(cell, self.table(cell), t));
        let inner: Vec<f64> = if self.body().degree > 1 { points.collect() } else { Vec::new() };
        at_vertices.into_iter().chain(inner).fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], t| [l.min(t), h.max(t)])
    }
}
