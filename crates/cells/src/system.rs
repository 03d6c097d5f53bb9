//! Equilibrium of a body: matrix, forces, and what is prescribed.

use crate::body::CellBody;
use crate::error::CellsError;
use crate::loads::Load;
use crate::place::Place;
use crate::supports::{Held, Support, Terms};
use nalgebra::DMatrix;
use signorini_fem::cut::End;
use signorini_fem::elastic::Space;
use signorini_geometry::{Point, Vector};
use signorini_solve::blocks::{Block, BlockSum};
use signorini_solve::krylov::{Found, Stopped, conjugate_gradients};
use signorini_solve::schwarz::{Inverses, Schwarz};
use signorini_solve::{Factor, SolveError, Symbolic, SymmetricMatrix};
use std::sync::Arc;

/// How the linear equations are solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Solver {
    /// By the number of unknowns.
    Automatic,
    /// Sparse Cholesky factorisation.
    Direct,
    /// Conjugate gradients with Schwarz blocks, to a relative residual in the norm of the preconditioner.
    Iterative { tolerance: f64 },
}

/// What a solver did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Solved {
    Direct { unknowns: usize },
    Iterative { unknowns: usize, iterations: usize, condition: f64 },
}

/// A displacement.
#[derive(Clone, Debug)]
pub struct Solution {
    /// Coefficients of the functions, `D` for each.
    pub displacement: Vec<f64>,
    pub solved: Solved,
}

/// Above this number of unknowns conjugate gradients are faster than the factorisation in space, which grows with the
/// square of the number; in the plane it is ten times as many.
const MANY_UNKNOWNS: usize = 100_000;
const MOST_ITERATIONS: usize = 2000;

/// The equations of a body.
#[derive(Clone)]
pub struct System<'a, const D: usize> {
    pub(crate) body: &'a CellBody<D>,
    /// Stiffness of each cell, for energies and for the constants of Nitsche's method.
    pub(crate) stiffness: Vec<Arc<DMatrix<f64>>>,
    pub(crate) matrix: SymmetricMatrix,
    pub(crate) forces: Vec<f64>,
    pub(crate) prescribed: Vec<Option<f64>>,
    loads: Vec<f64>,
    /// The terms of places that are held by Nitsche's method, which are in the matrix too.
    held_weakly: Vec<Terms>,
    /// Squares of the rigid motions along what is held.
    held: DMatrix<f64>,
}

impl<'a, const D: usize> System<'a, D> {
    /// The equations of a free body.
    pub fn new(body: &'a CellBody<D>) -> Self {
        let stiffness = body.stiffness();
        let mut cliques: Vec<Vec<u32>> = (0..body.cells().len()).map(|c| body.unknowns_of(c)).collect();
        // A cell whose stress comes from another one couples the unknowns of both.
        for (c, cell) in body.cells().iter().enumerate().filter(|(c, cell)| cell.stress_cell != *c) {
            cliques.push(crate::supports::RowSpace::new(body, c, cell.stress_cell).unknowns);
        }
        let n = body.unknowns();
        let mut matrix = SymmetricMatrix::from_cliques(n, &cliques);
        for (unknowns, k) in cliques.iter().zip(&stiffness) {
            matrix.add(unknowns, k.as_slice(), 1.0);
        }
        let mut prescribed = vec![None; n];
        if body.space() == Space::Axisymmetric && body.tree.bounds().min[0] == 0.0 {
            // Nothing leaves the axis: a hoop strain `u/r` there would have infinite energy.
            let on_axis = (0..body.function_count()).filter(|f| body.mode(*f).ids[0] == 0);
            on_axis.for_each(|f| prescribed[D * f] = Some(0.0));
        }
        let motions = rigid_motions(body, &body.tree.bounds().center()).len();
        let held = DMatrix::zeros(motions, motions);
        System {
            body,
            stiffness,
            matrix,
            forces: vec![0.0; n],
            prescribed,
            loads: vec![0.0; n],
            held_weakly: Vec::new(),
            held,
        }
    }

    pub fn body(&self) -> &CellBody<D> {
        self.body
    }

    /// Adds a support.
    ///
    /// # Errors
    /// A place without material.
    pub fn support(&mut self, support: &Support<D>) -> Result<&mut Self, CellsError> {
        for site in self.body.points_on(&support.on)? {
            let mut hold = |direction: &Vector<D>| {
                hold_along(self.body, (&site.x, site.weight), direction, &mut self.held);
            };
            match &support.held {
                Held::Normal(_) => hold(&site.normal),
                Held::Components(fields) => (0..D)
                    .filter(|k| fields[*k].is_some())
                    .for_each(|k| hold(&Vector::from_fn(|a, _| if a == k { 1.0 } else { 0.0 }))),
            }
        }
        match (&support.on, &support.held) {
            (Place::Side { axis, end }, Held::Components(fields)) => {
                if *axis >= D {
                    return Err(CellsError::Axis { axis: *axis, dimension: D });
                }
                for (k, field) in fields.iter().enumerate() {
                    if let Some(field) = field {
                        self.prescribe(*axis, *end, k, field)?;
                    }
                }
            }
            (Place::Side { axis, end }, Held::Normal(field)) => {
                if *axis >= D {
                    return Err(CellsError::Axis { axis: *axis, dimension: D });
                }
                let (field, sign) = (field.clone(), end.sign());
                self.prescribe(*axis, *end, *axis, &(Arc::new(move |x: &_| sign * field(x)) as crate::body::Field<D>))?;
            }
            (place, held) => {
                let sites = self.body.points_on(place)?;
                for terms in self.body.nitsche(&sites, held, &self.stiffness) {
                    self.matrix.add(&terms.unknowns, &terms.matrix, 1.0);
                    terms.unknowns.iter().zip(&terms.forces).for_each(|(u, f)| self.forces[*u as usize] += f);
                    self.held_weakly.push(terms);
                }
            }
        }
        Ok(self)
    }

    fn prescribe(&mut self, axis: usize, end: End, k: usize, field: &crate::body::Field<D>) -> Result<(), CellsError> {
        for (unknown, value) in self.body.projected(axis, end, k, field)? {
            self.prescribed[unknown] = Some(value);
        }
        Ok(())
    }

    /// Adds a load.
    ///
    /// # Errors
    /// A place without material.
    pub fn load(&mut self, load: &Load<D>) -> Result<&mut Self, CellsError> {
        let before = self.loads.clone();
        self.body.add_load(load, &mut self.loads)?;
        for (force, (now, before)) in self.forces.iter_mut().zip(self.loads.iter().zip(&before)) {
            *force += now - before;
        }
        Ok(self)
    }

    /// Solves the equations.
    ///
    /// # Errors
    /// A body that nothing holds; iterations that end too early.
    pub fn solve(&self, solver: Solver) -> Result<Solution, CellsError> {
        let modes = self.free_motions();
        if modes > 0 {
            return Err(CellsError::Unsupported { modes });
        }
        let n = self.matrix.size();
        let many = if D < 3 { 10 * MANY_UNKNOWNS } else { MANY_UNKNOWNS };
        let solver = match solver {
            Solver::Automatic if n > many => Solver::Iterative { tolerance: 1e-10 },
            Solver::Automatic => Solver::Direct,
            chosen => chosen,
        };
        let (mut displacement, solved) = match solver {
            Solver::Iterative { tolerance } => {
                let found = self.iterate(tolerance)?;
                let (iterations, condition) = (found.iterations, found.condition);
                (found.x, Solved::Iterative { unknowns: n, iterations, condition })
            }
            _ => {
                let (mut matrix, mut rhs) = (self.matrix.clone(), self.forces.clone());
                matrix.prescribe(&self.prescribed, &mut rhs);
                (Scaled::new(self.body, matrix)?.solve(&rhs)?, Solved::Direct { unknowns: n })
            }
        };
        for (u, value) in displacement.iter_mut().zip(&self.prescribed) {
            if let Some(value) = value {
                *u = *value;
            }
        }
        Ok(Solution { displacement, solved })
    }

    fn iterate(&self, tolerance: f64) -> Result<Found, CellsError> {
        let own = self.stiffness.iter().enumerate();
        let mut blocks: Vec<Block<'_>> =
            own.map(|(c, k)| Block { unknowns: self.body.unknowns_of(c), entries: k.as_slice() }).collect();
        blocks.extend(self.held_weakly.iter().map(|t| Block { unknowns: t.unknowns.clone(), entries: &t.matrix }));
        let a = BlockSum::new(blocks, self.prescribed.iter().map(Option::is_none).collect());
        let known: Vec<f64> = self.prescribed.iter().map(|p| p.unwrap_or(0.0)).collect();
        let moved = a.multiply_all(&known);
        let rhs: Vec<f64> =
            (0..known.len()).map(|k| if a.free()[k] { self.forces[k] - moved[k] } else { 0.0 }).collect();
        let schwarz = Schwarz::new(&a, &self.body.schwarz_sets(), &mut Inverses::default())?;
        conjugate_gradients(&rhs, |x| a.multiply(x), |r| schwarz.apply(r), tolerance, MOST_ITERATIONS).map_err(
            |stopped| match stopped {
                Stopped::Equations(error) => error.into(),
                Stopped::Indefinite => CellsError::Iterations { iterations: 0, residual: 1.0 },
                Stopped::TooMany { iterations, residual } => CellsError::Iterations { iterations, residual },
            },
        )
    }

    /// The number of rigid motions of the body that no support holds.
    pub fn free_motions(&self) -> usize {
        self.free_motions_with(std::iter::empty())
    }

    /// That number where a contact also holds the body: at points that stand for an area, along a normal.
    pub(crate) fn free_motions_with(&self, contact: impl Iterator<Item = (Point<D>, f64, Vector<D>)>) -> usize {
        let mut held = self.held.clone();
        contact.for_each(|(x, weight, normal)| hold_along(self.body, (&x, weight), &normal, &mut held));
        let values = held.symmetric_eigenvalues();
        // What is held by a line instead of an area is still held; round-off is not.
        let most = values.max();
        values.iter().filter(|v| **v <= 1e-10 * most).count()
    }

    /// The strain energy `½ a(u, u)` of the cells, fictitious stiffness included.
    pub fn energy(&self, u: &[f64]) -> f64 {
        let of_cell = |c: usize| {
            let local: Vec<f64> = self.body.unknowns_of(c).iter().map(|i| u[*i as usize]).collect();
            let local = nalgebra::DVector::from_vec(local);
            0.5 * local.dot(&(&*self.stiffness[c] * &local))
        };
        (0..self.body.cells().len()).map(of_cell).sum()
    }

    /// The work of the loads on a displacement.
    pub fn work(&self, u: &[f64]) -> f64 {
        self.loads.iter().zip(u).map(|(f, u)| f * u).sum()
    }

    /// The forces with which the supports on sides of the box act on the unknowns: the residual `K u - f`.
    pub fn residual(&self, u: &[f64]) -> Vec<f64> {
        self.matrix.multiply(u).iter().zip(&self.forces).map(|(k, f)| k - f).collect()
    }

    /// The resultant of those forces on a side of the box, of one component: their work on a unit displacement of it.
    ///
    /// # Errors
    /// A side without material.
    pub fn reaction(&self, u: &[f64], axis: usize, end: End, component: usize) -> Result<f64, CellsError> {
        let residual = self.residual(u);
        let one: crate::body::Field<D> = Arc::new(|_| 1.0);
        let unit = self.body.projected(axis, end, component, &one)?;
        Ok(unit.iter().map(|(unknown, value)| residual[*unknown] * value).sum())
    }
}

/// The rigid motions of a body at a point: translations, and turns by a displacement of its size.
fn rigid_motions<const D: usize>(body: &CellBody<D>, x: &Point<D>) -> Vec<Vector<D>> {
    let b = body.tree.bounds();
    let r = (x - b.center()) / b.size().amax();
    let unit = |axis: usize| Vector::<D>::from_fn(|k, _| if k == axis { 1.0 } else { 0.0 });
    if body.space() == Space::Axisymmetric {
        return vec![unit(1)];
    }
    let mut out: Vec<Vector<D>> = (0..D).map(unit).collect();
    for a in 0..D {
        for c in a + 1..D {
            out.push(unit(c) * r[a] - unit(a) * r[c]);
        }
    }
    out
}

/// Adds what holds a point, standing for an area, along a direction, to the matrix of rigid motions that are held.
fn hold_along<const D: usize>(
    body: &CellBody<D>,
    (x, weight): (&Point<D>, f64),
    direction: &Vector<D>,
    held: &mut DMatrix<f64>,
) {
    let row: Vec<f64> = rigid_motions(body, x).iter().map(|m| m.dot(direction)).collect();
    let row = nalgebra::DVector::from_vec(row);
    held.ger(weight, &row, &row, 1.0);
}

/// A factor of a matrix scaled to a unit diagonal: functions with little material have little stiffness.
pub(crate) struct Scaled {
    scale: Vec<f64>,
    factor: Factor,
}

impl Scaled {
    pub fn new<const D: usize>(body: &CellBody<D>, matrix: SymmetricMatrix) -> Result<Self, CellsError> {
        let place = |i: usize| {
            let x = body.position(i / D);
            std::array::from_fn(|k| if k < D { x[k] } else { 0.0 })
        };
        let places: Vec<[f64; 3]> = (0..matrix.size()).map(place).collect();
        let scale: Vec<f64> = matrix.diagonal().iter().map(|d| if *d > 0.0 { 1.0 / d.sqrt() } else { 1.0 }).collect();
        let scaled = matrix.scaled(&scale);
        let mut symbolic = if D == 3 { Symbolic::dissected(places) } else { Symbolic::default() };
        let factor = symbolic.factor(scaled).map_err(|error| match error {
            SolveError::NotPositiveDefinite { pivot, .. } => CellsError::NotPositive {
                at: body.position(pivot / D).iter().copied().collect(),
                fictitious: body.discretisation.fictitious,
            },
            other => other.into(),
        })?;
        Ok(Scaled { factor, scale })
    }

    /// Without refinement.
    pub fn solve_once(&self, b: &[f64]) -> Result<Vec<f64>, CellsError> {
        let mut x: Vec<f64> = b.iter().zip(&self.scale).map(|(b, s)| b * s).collect();
        self.factor.solve_once(&mut x)?;
        x.iter_mut().zip(&self.scale).for_each(|(x, s)| *x *= s);
        Ok(x)
    }

    pub fn solve(&self, b: &[f64]) -> Result<Vec<f64>, CellsError> {
        let scaled: Vec<f64> = b.iter().zip(&self.scale).map(|(b, s)| b * s).collect();
        Ok(self.factor.solve(&scaled)?.iter().zip(&self.scale).map(|(x, s)| x * s).collect())
    }
}
