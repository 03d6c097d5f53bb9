//! A solid as it is shown: cells divided into straight ones, with displacement and stress at their points.

use super::SolidBody;
use super::cells::Gradients;
use super::spatial::spatial;
use crate::stiffness::Table;
use nalgebra::{DVector, Matrix3};
use rayon::prelude::*;
use signorini_fem::hierarchic::Values;
use signorini_fem::mesh::Window;
use signorini_fem::{CellShape, Local};
use signorini_geometry::{Point, Vector};
use signorini_material::StressLaw;
use signorini_material::{Elastic, Space, von_mises};
use signorini_mechanics::{BodyFields, BodyState};
use std::collections::HashMap;

/// A cell divided into straight ones.
struct Division {
    table: Table,
    cells: Vec<Vec<u32>>,
}

/// What is shown of a point.
#[derive(Clone, Copy)]
pub(super) struct Shown {
    x: Point<3>,
    pub displacement: Vector<3>,
    /// Cauchy stress.
    pub stress: Matrix3<f64>,
    /// Equivalent plastic strain; zero of elastic laws.
    plastic_strain: f64,
}

impl<const D: usize> SolidBody<D> {
    /// Tetrahedra and wedges are shown as hexahedra with corners that coincide.
    pub(super) fn shown(&self, state: &BodyState) -> BodyFields {
        let body = self.body();
        let mut divisions: HashMap<(usize, usize), Division> = HashMap::new();
        for cell in 0..body.mesh.cell_count() {
            divisions
                .entry((body.mesh.map_number(cell), body.dofs.basis_number(cell)))
                .or_insert_with(|| self.division(cell));
        }
        let of = |cell: usize| &divisions[&(body.mesh.map_number(cell), body.dofs.basis_number(cell))];
        let cells: Vec<usize> = (0..body.mesh.cell_count()).collect();
        let pieces: Vec<usize> = (0..self.pieces.count()).collect();
        let pressures: Vec<Option<DVector<f64>>> = pieces.par_iter().map(|k| self.fitted_pressure(*k, state)).collect();
        let pressure = |cell: usize| pressures[self.pieces.of(cell)].as_ref();
        let found: Vec<Vec<Shown>> =
            (cells.par_iter()).map(|&cell| self.points_of(cell, &of(cell).table, state, pressure(cell))).collect();
        let mut out = BodyFields::default();
        let mut stress = Vec::new();
        let mut equivalent = Vec::new();
        let mut plastic = Vec::new();
        let mut temperature = Vec::new();
        for (cell, points) in found.into_iter().enumerate() {
            let first = out.points.len() as u32;
            if self.heated.is_some() {
                temperature.extend(self.temperatures_at(cell, &of(cell).table, self.temperature_of(state)));
            }
            out.cells.extend(of(cell).cells.iter().map(|c| c.iter().map(|k| first + k).collect()));
            for (q, Shown { x, displacement, stress: mut s, plastic_strain }) in points.into_iter().enumerate() {
                let xi = of(cell).table.points[q].0;
                let inner = body.mesh.shown_at(cell, &xi);
                if inner != xi {
                    s = self.points_of(cell, &self.table_at(cell, &[inner]), state, pressure(cell))[0].stress;
                }
                out.points.push(x);
                out.displacement.push(displacement);
                plastic.push(plastic_strain);
                stress.extend([s[(0, 0)], s[(1, 1)], s[(2, 2)], s[(0, 1)], s[(1, 2)], s[(0, 2)]]);
                equivalent.push(von_mises(&s));
            }
        }
        out.point_data.push(("stress".into(), 6, stress));
        out.point_data.push(("von_mises".into(), 1, equivalent));
        if self.law().has_history() {
            out.point_data.push(("plastic_strain".into(), 1, plastic));
        }
        if self.heated.is_some() {
            out.point_data.push(("temperature".into(), 1, temperature));
        }
        out
    }

    /// What is shown of the points of a table of a cell, with the pressure that is fitted on its piece. Stress and plastic strain of
    /// laws with history are known at the quadrature points, and fitted from there to others.
    pub(super) fn points_of(
        &self,
        cell: usize,
        table: &Table,
        state: &BodyState,
        pressure: Option<&DVector<f64>>,
    ) -> Vec<Shown> {
        if !self.law().has_history() {
            return self.evaluated(cell, table, state, pressure);
        }
        let own = self.own(cell, &state.configuration);
        let known = self.evaluated(cell, self.table(cell), state, pressure);
        let weights = self.gradients(cell, self.table(cell)).weights;
        let fit = self.fit_to(cell, &weights, table);
        let shown = |q: usize| {
            let mut shown = Shown {
                x: spatial(&self.body().mesh.position(cell, &table.map[q])),
                displacement: moved::<D>(&table.basis[q], &own),
                stress: Matrix3::zeros(),
                plastic_strain: 0.0,
            };
            for (k, point) in known.iter().enumerate() {
                let share = fit.as_ref().map_or(1.0 / known.len() as f64, |fit| fit[(q, k)]);
                shown.stress += point.stress * share;
                shown.plastic_strain += point.plastic_strain * share;
            }
            // A fit may fall below zero where plastic strain begins.
            shown.plastic_strain = shown.plastic_strain.max(0.0);
            shown
        };
        (0..table.points.len()).map(shown).collect()
    }

    /// What the law gives at the points of a table: of laws with history those of quadrature.
    fn evaluated(&self, cell: usize, table: &Table, state: &BodyState, pressure: Option<&DVector<f64>>) -> Vec<Shown> {
        let own = self.own(cell, &state.configuration);
        let at = self.gradients_in(cell, table, state);
        let gradients = &at.rows * &own;
        let plane_stress = self.bodies.space == Space::PlaneStress;
        // The pressure as it acts in the cell: projected where the dilatation is.
        let projected =
            pressure.map(|coefficients| self.polynomials(cell, &self.pieces.place(cell), table).tr_mul(coefficients));
        let pressure = |q: usize, f: &Matrix3<f64>, projected: &Option<DVector<f64>>| match projected {
            Some(p) => p[q],
            None => {
                let (elastic, law) = &at.laws[q];
                law.volumetric(elastic, law.dilatation(f).energy).map_or(f64::NAN, |u| u[1])
            }
        };
        (0..table.points.len())
            .map(|q| {
                let f = at.deformation(q, &gradients);
                let (elastic, law) = &at.laws[q];
                let history = self.history.at(&state.internal, cell, q);
                let stress = if plane_stress {
                    law.plane_stress(elastic, &f, history).map(|r| r.stress).unwrap_or_default()
                } else {
                    law.deviatoric(elastic, &f, history).stress
                        + law.dilatation(&f).stress * pressure(q, &f, &projected)
                };
                let cauchy = law.cauchy(elastic, self.bodies.space, &f, &stress, history);
                Shown {
                    x: spatial(&self.body().mesh.position(cell, &table.map[q])),
                    displacement: moved::<D>(&table.basis[q], &own),
                    stress: cauchy,
                    plastic_strain: law
                        .plastic(elastic, self.bodies.space, &f, history)
                        .map_or(0.0, |point| point.history[0]),
                }
            })
            .collect()
    }

    /// Coefficients of the pressure on a piece, where it is projected.
    pub(super) fn fitted_pressure(&self, number: usize, state: &BodyState) -> Option<DVector<f64>> {
        if self.bodies.space == Space::PlaneStress {
            return None;
        }
        let piece = self.piece(number);
        let gradients =
            |(cell, _): &(u32, Window)| self.gradients_in(*cell as usize, self.table(*cell as usize), state);
        let inner: Vec<Gradients> = piece.cells.iter().map(gradients).collect();
        let weights: Vec<&[f64]> = inner.iter().map(|at| at.weights.as_slice()).collect();
        let fit = self.projection(&piece, &weights)?;
        let dilatations = |(at, (cell, _)): (&Gradients, &(u32, Window))| {
            let displacement = &at.rows * self.own(*cell as usize, &state.configuration);
            let of = |(q, (_, law)): (usize, &(Elastic, StressLaw))| {
                law.dilatation(&at.deformation(q, &displacement)).energy
            };
            at.laws.iter().enumerate().map(of).collect::<Vec<f64>>().into()
        };
        let theta = fit.fitted(&inner.iter().zip(piece.cells.iter()).map(dilatations).collect::<Vec<_>>());
        let slope =
            |(t, (elastic, law)): (&f64, &(Elastic, StressLaw))| law.volumetric(elastic, *t).map_or(f64::NAN, |u| u[1]);
        let slopes = |(theta, at): (&DVector<f64>, &Gradients)| {
            theta.iter().zip(&at.laws).map(slope).collect::<Vec<f64>>().into()
        };
        Some(fit.coefficients(&theta.iter().zip(&inner).map(slopes).collect::<Vec<_>>()))
    }

    fn division(&self, cell: usize) -> Division {
        let body = self.body();
        let (map, basis) = (body.mesh.map(cell), body.dofs.basis(cell));
        let (points, cells) = divided(map.shape(), map.order().max(basis.degree()));
        Division { table: self.table_at(cell, &points), cells }
    }

    pub(super) fn table_at(&self, cell: usize, points: &[Local]) -> Table {
        let (map, basis) = (self.body().mesh.map(cell), self.body().dofs.basis(cell));
        let tabulate = |f: &dyn Fn(&Local, &mut Values)| -> Vec<Values> {
            (points.iter())
                .map(|x| {
                    let mut at = Values::default();
                    f(x, &mut at);
                    at
                })
                .collect()
        };
        let (of_map, of_basis) = (tabulate(&|x, at| map.tabulate(x, at)), tabulate(&|x, at| basis.tabulate(x, at)));
        Table { points: points.iter().map(|x| (*x, 0.0)).collect(), map: of_map, basis: of_basis }
    }
}

/// The displacement at a point with these values of the functions.
fn moved<const D: usize>(at: &Values, own: &DVector<f64>) -> Vector<3> {
    let mut out = Vector::<3>::zeros();
    for (a, v) in at.value.iter().enumerate() {
        (0..D).for_each(|i| out[i] += v * own[a * D + i]);
    }
    out
}

/// Points of a reference cell and the straight cells between them, `n` along each edge; of a tetrahedron at most two.
fn divided(shape: CellShape, n: usize) -> (Vec<Local>, Vec<Vec<u32>>) {
    match shape {
        CellShape::Tetrahedron => tetrahedra(n),
        CellShape::Triangle => triangles(n),
        CellShape::Wedge => wedges(n),
        _ => boxes(shape.dimension(), n),
    }
}

/// A tetrahedron as a hexahedron, and a wedge.
fn tetrahedron([a, b, c, d]: [u32; 4]) -> Vec<u32> {
    vec![a, b, c, c, d, d, d, d]
}

fn wedge([a, b, c]: [u32; 3], [d, e, f]: [u32; 3]) -> Vec<u32> {
    vec![a, b, c, c, d, e, f, f]
}

/// A tetrahedron, or its parts between the middles of its edges: four at the corners, and the octahedron within cut along a
/// diagonal.
fn tetrahedra(n: usize) -> (Vec<Local>, Vec<Vec<u32>>) {
    // Edges 01, 12, 02, 03, 23, 13 are points 4 to 9.
    const PARTS: [[u32; 4]; 8] = [
        [0, 4, 6, 7],
        [4, 1, 5, 9],
        [6, 5, 2, 8],
        [7, 9, 8, 3],
        [4, 6, 7, 8],
        [4, 7, 9, 8],
        [4, 9, 5, 8],
        [4, 5, 6, 8],
    ];
    let vertices = CellShape::Tetrahedron.vertices();
    let mut points = vertices.to_vec();
    if n == 1 {
        return (points, vec![tetrahedron([0, 1, 2, 3])]);
    }
    let middle = |[a, b]: &[usize; 2]| std::array::from_fn(|k| 0.5 * (vertices[*a][k] + vertices[*b][k]));
    points.extend(CellShape::Tetrahedron.edges().iter().map(middle));
    (points, PARTS.map(tetrahedron).to_vec())
}

fn triangles(n: usize) -> (Vec<Local>, Vec<Vec<u32>>) {
    let share = |k: usize| k as f64 / n as f64;
    let points = (0..=n).flat_map(|j| (0..=n - j).map(move |i| [share(i), share(j), 0.0])).collect();
    let at = |i: usize, j: usize| (j * (2 * n + 3 - j) / 2 + i) as u32;
    let mut cells = Vec::new();
    for j in 0..n {
        for i in 0..n - j {
            cells.push(vec![at(i, j), at(i + 1, j), at(i, j + 1)]);
            if i + j + 1 < n {
                cells.push(vec![at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
        }
    }
    (points, cells)
}

fn wedges(n: usize) -> (Vec<Local>, Vec<Vec<u32>>) {
    let (base, triangles) = triangles(n);
    let height = |k: usize| 2.0 * k as f64 / n as f64 - 1.0;
    let points = (0..=n).flat_map(|k| base.iter().map(move |x| [x[0], x[1], height(k)])).collect();
    let layer = |k: usize, t: &[u32]| [0, 1, 2].map(|i| t[i] + (k * base.len()) as u32);
    let cells = (0..n).flat_map(|k| triangles.iter().map(move |t| wedge(layer(k, t), layer(k + 1, t)))).collect();
    (points, cells)
}

/// Lines, quadrilaterals or hexahedra.
fn boxes(dimension: usize, n: usize) -> (Vec<Local>, Vec<Vec<u32>>) {
    let number = |k: usize| if k < dimension { n + 1 } else { 1 };
    let side = |i: usize, k: usize| if k < dimension { 2.0 * i as f64 / n as f64 - 1.0 } else { 0.0 };
    let mut points = Vec::new();
    for k in 0..number(2) {
        for j in 0..number(1) {
            points.extend((0..number(0)).map(|i| [side(i, 0), side(j, 1), side(k, 2)]));
        }
    }
    let at = |i: usize, j: usize, k: usize| ((k * number(1) + j) * number(0) + i) as u32;
    let quad = |[i, j, k]: [usize; 3]| [at(i, j, k), at(i + 1, j, k), at(i + 1, j + 1, k), at(i, j + 1, k)];
    let count = |k: usize| if k < dimension { n } else { 1 };
    let mut cells = Vec::new();
    for k in 0..count(2) {
        for j in 0..count(1) {
            cells.extend((0..n).map(|i| match dimension {
                1 => vec![at(i, 0, 0), at(i + 1, 0, 0)],
                2 => quad([i, j, 0]).to_vec(),
                _ => [quad([i, j, k]), quad([i, j, k + 1])].concat(),
            }));
        }
    }
    (points, cells)
}
