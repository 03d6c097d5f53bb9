//! Supports: on sides of the box by the unknowns themselves, on the recovered boundary by Nitsche's method.
//!
//! On a side of the box the prescribed displacement is projected in the mean square on the functions that do not vanish
//! there. On the recovered boundary, for a held direction `d` and `t = σ(u) n`,
//!
//! `-∫ (d·t(u)) (d·v) - ∫ (d·t(v)) (d·u - ū) + ∫ γ (d·u - ū) (d·v)`,
//!
//! with `γ = 2 λ_c`, `λ_c` the largest eigenvalue of `∫_{Γ_c} t(u)·t(v)` against the energy of the cell. A cell with little
//! material does not control its own stress: the polynomials of a neighbour with more of it, carried on to this cell, give
//! `t` there, so that `γ` stays bounded however small the cut.

use crate::body::{CellBody, Field, Site};
use crate::error::CellsError;
use crate::place::{Place, side_gauss};
use crate::space::Tabulation;
use nalgebra::{DMatrix, DVector};
use signorini_fem::cut::End;
use signorini_geometry::Vector;
use signorini_solve::{Symbolic, SymmetricMatrix};
use std::collections::BTreeMap;
use std::sync::Arc;

/// What is held in a place.
#[derive(Clone)]
pub enum Held<const D: usize> {
    /// The displacement of each component that is held.
    Components([Option<Field<D>>; D]),
    /// The displacement along the outward normal.
    Normal(Field<D>),
}

/// A support.
#[derive(Clone)]
pub struct Support<const D: usize> {
    pub on: Place<D>,
    pub held: Held<D>,
}

impl<const D: usize> Support<D> {
    /// One component held at a value.
    pub fn component(on: Place<D>, axis: usize, value: f64) -> Self {
        let field: Field<D> = Arc::new(move |_| value);
        Support { on, held: Held::Components(std::array::from_fn(|k| (k == axis).then(|| field.clone()))) }
    }

    /// All components held where they are.
    pub fn clamped(on: Place<D>) -> Self {
        let zero: Field<D> = Arc::new(|_| 0.0);
        Support { on, held: Held::Components(std::array::from_fn(|_| Some(zero.clone()))) }
    }

    /// Symmetry: nothing along the normal.
    pub fn symmetric(on: Place<D>) -> Self {
        Support { on, held: Held::Normal(Arc::new(|_| 0.0)) }
    }
}

/// Matrix and right-hand side of the unknowns of a few cells.
#[derive(Clone)]
pub(crate) struct Terms {
    pub unknowns: Vec<u32>,
    pub matrix: Vec<f64>,
    pub forces: Vec<f64>,
}

/// Points of the boundary in one cell, the cell that gives the stress there, and `γ`.
pub(crate) struct NitschePart<const D: usize> {
    pub cell: usize,
    pub stress_cell: usize,
    pub sites: Vec<Site<D>>,
    pub gamma: f64,
}

impl<const D: usize> CellBody<D> {
    /// The unknowns of a side of the box with the values of a function projected on them, for one component.
    pub(crate) fn projected(
        &self,
        axis: usize,
        end: End,
        component: usize,
        value: &Field<D>,
    ) -> Result<Vec<(usize, f64)>, CellsError> {
        let on_side = |f: u32| {
            let mode = self.mode(f as usize);
            mode.ids[axis] == if end == End::High { self.tree.count(mode.level, axis) } else { 0 }
        };
        let mut numbers: BTreeMap<u32, u32> = BTreeMap::new();
        let cells = self.cells_on(axis, end);
        for &c in &cells {
            for &f in self.cells()[c].functions.iter().filter(|f| on_side(**f)) {
                let next = numbers.len() as u32;
                numbers.entry(f).or_insert(next);
            }
        }
        if numbers.is_empty() {
            return Err(self.empty_place("a side of the box"));
        }
        let mut rhs = vec![0.0; numbers.len()];
        let mut parts = Vec::new();
        let mut t = Tabulation::default();
        for &c in &cells {
            let places: Vec<(usize, u32)> = (self.cells()[c].functions.iter().enumerate())
                .filter_map(|(i, f)| Some((i, *numbers.get(f)?)))
                .collect();
            let n = places.len();
            let mut mass = vec![0.0; n * n];
            for p in side_gauss(self.bounds_of(c), axis, end, self.degree() + 4) {
                self.functions_at(c, &p.x, &mut t);
                let target = value(&p.x);
                for (a, (i, row)) in places.iter().enumerate() {
                    rhs[*row as usize] += p.weight * t.value[*i] * target;
                    for (b, (j, _)) in places.iter().enumerate() {
                        mass[a * n + b] += p.weight * t.value[*i] * t.value[*j];
                    }
                }
            }
            parts.push((places.iter().map(|p| p.1).collect::<Vec<u32>>(), mass));
        }
        let mass = SymmetricMatrix::of_cliques(numbers.len(), &parts);
        let values = Symbolic::default().factor(mass)?.solve(&rhs)?;
        Ok(numbers.iter().map(|(f, i)| (D * *f as usize + component, values[*i as usize])).collect())
    }

    /// Points of the boundary by the cells that they lie in, with the stabilisation of Nitsche's method there.
    pub(crate) fn nitsche_parts(&self, sites: &[Site<D>], stiffness: &[Arc<DMatrix<f64>>]) -> Vec<NitschePart<D>> {
        // By the cell that gives the stress.
        let mut groups: BTreeMap<usize, Vec<&Site<D>>> = BTreeMap::new();
        for site in sites {
            groups.entry(self.cells()[site.cell].stress_cell).or_default().push(site);
        }
        let mut out = Vec::new();
        for (stress_cell, sites) in groups {
            let gamma = 2.0 * self.trace_constant(stress_cell, &sites, &stiffness[stress_cell]);
            let mut by_cell: BTreeMap<usize, Vec<Site<D>>> = BTreeMap::new();
            sites.iter().for_each(|s| by_cell.entry(s.cell).or_default().push(**s));
            out.extend(by_cell.into_iter().map(|(cell, sites)| NitschePart { cell, stress_cell, sites, gamma }));
        }
        out
    }

    /// Nitsche's terms of a support on points of the boundary.
    pub(crate) fn nitsche(&self, sites: &[Site<D>], held: &Held<D>, stiffness: &[Arc<DMatrix<f64>>]) -> Vec<Terms> {
        let parts = self.nitsche_parts(sites, stiffness);
        parts.iter().map(|part| self.nitsche_of_part(part, held)).collect()
    }

    fn nitsche_of_part(&self, part: &NitschePart<D>, held: &Held<D>) -> Terms {
        let gamma = part.gamma;
        let rows = RowSpace::new(self, part.cell, part.stress_cell);
        let n = rows.unknowns.len();
        let (mut matrix, mut forces) = (DMatrix::<f64>::zeros(n, n), vec![0.0; n]);
        for site in &part.sites {
            let at = rows.at(self, site);
            let mut hold = |direction: &Vector<D>, value: f64| {
                let v = at.displacement(direction);
                let f = at.traction(direction);
                matrix.ger(-site.weight, &v, &f, 1.0);
                matrix.ger(-site.weight, &f, &v, 1.0);
                matrix.ger(site.weight * gamma, &v, &v, 1.0);
                for i in 0..n {
                    forces[i] += site.weight * value * (gamma * v[i] - f[i]);
                }
            };
            match held {
                Held::Components(fields) => {
                    for (k, field) in fields.iter().enumerate() {
                        if let Some(field) = field {
                            let e = Vector::<D>::from_fn(|a, _| if a == k { 1.0 } else { 0.0 });
                            hold(&e, field(&site.x));
                        }
                    }
                }
                Held::Normal(field) => hold(&site.normal, field(&site.x)),
            }
        }
        Terms { unknowns: rows.unknowns, matrix: matrix.as_slice().to_vec(), forces }
    }

    /// The largest `∫ |t(u)|²` over some boundary for a unit energy of the cell, by the power method: the energy is scaled
    /// by its diagonal, and rigid motions, which have no stress, get some.
    fn trace_constant(&self, cell: usize, sites: &[&Site<D>], stiffness: &DMatrix<f64>) -> f64 {
        let n = stiffness.nrows();
        let scale: Vec<f64> = (0..n).map(|i| 1.0 / stiffness[(i, i)].max(f64::MIN_POSITIVE).sqrt()).collect();
        let mut g = DMatrix::<f64>::zeros(n, n);
        let mut t = Tabulation::default();
        for site in sites {
            self.functions_at(cell, &site.x, &mut t);
            let tractions = self.tractions(&site.x, &site.normal, &t);
            for k in 0..D {
                let row = DVector::from_fn(n, |i, _| tractions[i][k] * scale[i]);
                g.ger(site.weight, &row, &row, 1.0);
            }
        }
        let mut shift = 1e-11;
        let factor = loop {
            let a = DMatrix::from_fn(n, n, |i, j| {
                stiffness[(i, j)] * scale[i] * scale[j] + if i == j { shift } else { 0.0 }
            });
            match a.cholesky() {
                Some(factor) => break factor,
                None => shift *= 10.0,
            }
        };
        let mut v = DVector::from_fn(n, |i, _| 1.0 + 0.5 * (1.7 * i as f64).sin());
        let mut value = 0.0;
        for _ in 0..60 {
            let norm = v.dot(&(&g * &v)).sqrt();
            if norm == 0.0 {
                break;
            }
            v /= norm;
            // G A⁻¹ G v over G: the Rayleigh quotient of the next step.
            let image = factor.solve(&(&g * &v));
            let next = image.dot(&(&g * &v));
            let change = (next - value).abs();
            value = next;
            v = image;
            if change <= 1e-3 * value {
                break;
            }
        }
        value
    }
}

/// Rows of displacement and traction at points of a cell, over the unknowns of it and of the cell that gives the stress.
pub(crate) struct RowSpace {
    cell: usize,
    stress_cell: usize,
    pub unknowns: Vec<u32>,
    /// Places of the unknowns of the cell of stress.
    places: Vec<usize>,
}

/// The rows at one point.
pub(crate) struct Rows<'a, const D: usize> {
    space: &'a RowSpace,
    values: Vec<f64>,
    tractions: Vec<Vector<D>>,
}

impl RowSpace {
    pub fn new<const D: usize>(body: &CellBody<D>, cell: usize, stress_cell: usize) -> Self {
        let mut unknowns = body.unknowns_of(cell);
        let mut number: BTreeMap<u32, usize> = unknowns.iter().enumerate().map(|(i, u)| (*u, i)).collect();
        let places = (body.unknowns_of(stress_cell).into_iter())
            .map(|u| {
                *number.entry(u).or_insert_with(|| {
                    unknowns.push(u);
                    unknowns.len() - 1
                })
            })
            .collect();
        RowSpace { cell, stress_cell, unknowns, places }
    }

    pub fn at<const D: usize>(&self, body: &CellBody<D>, site: &Site<D>) -> Rows<'_, D> {
        let mut t = Tabulation::default();
        body.functions_at(self.stress_cell, &site.x, &mut t);
        let tractions = body.tractions(&site.x, &site.normal, &t);
        if self.cell != self.stress_cell {
            body.functions_at(self.cell, &site.x, &mut t);
        }
        Rows { space: self, values: t.value, tractions }
    }
}

impl<const D: usize> Rows<'_, D> {
    /// `d·u` as a row.
    pub fn displacement(&self, direction: &Vector<D>) -> DVector<f64> {
        let mut row = DVector::zeros(self.space.unknowns.len());
        for (f, value) in self.values.iter().enumerate() {
            (0..D).for_each(|k| row[D * f + k] = direction[k] * value);
        }
        row
    }

    /// `d·t(u)` as a row.
    pub fn traction(&self, direction: &Vector<D>) -> DVector<f64> {
        let mut row = DVector::zeros(self.space.unknowns.len());
        for (place, traction) in self.space.places.iter().zip(&self.tractions) {
            row[*place] += direction.dot(traction);
        }
        row
    }
}
