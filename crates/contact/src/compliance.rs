//! The compliance of rows `W = B K⁻¹ Bᵀ`, known by columns or by products, and which of the two costs less.
//!
//! By columns each row that carries costs a solve with the bodies once, and each contact state a dense factorisation: for
//! small zones. By products each contact state is found by a Krylov method on the tractions of the rows, one solve with the
//! bodies a step, and nothing is stored but vectors on the rows (as in FETI methods for contact; Dureisseix & Farhat, Int. J.
//! Numer. Meth. Engng 50, 2001): for large ones. What one contact state found out about `W` serves the next one too.
//!
//! By products alone the steps would grow with the number of cells across the zone. So rows that do not give way get springs
//! of stiffness `k`, far above their own: a sparse matrix of the size of the bodies. With `z = ẑ - k B u` and
//! `u = (K + Bᵀ k B)⁻¹ Bᵀ ẑ` the equation `B u = d` of such a row is nearly `ẑ = k d` (the augmented Lagrangian; Fortin &
//! Glowinski 1983), so that a few steps on `ẑ` suffice, whatever the size of the zone.
//!
//! Rows are scaled by their own compliance, so that units do not matter and sizes of cells little. It is taken from the
//! stiffness of the unknowns that a row touches, the others held.

use crate::mortar::WeightedGap;
use crate::softness::Spring;
use nalgebra::{DMatrix, DVector};
use signorini_solve::krylov::{Equations, Products};
use signorini_solve::{Factor, SolveError, SymmetricMatrix};
use std::cell::RefCell;

/// The elastic system as contact sees it: solves with the stiffness, springs included.
pub trait Compliance {
    /// `K_c⁻¹ b` for several right-hand sides, one after the other, to working precision.
    fn solve_columns(&self, b: &mut [f64]) -> Result<(), SolveError>;
    /// `K_c⁻¹ b` for one right-hand side, to working precision.
    fn solve_once(&self, b: &mut [f64]) -> Result<(), SolveError>;
    /// `K_c⁻¹ b`, refined to the round-off of the solution.
    fn solve_accurately(&self, b: &[f64]) -> Result<Vec<f64>, SolveError>;
    /// Number of unknowns.
    fn size(&self) -> usize;
    /// Entries of the factor of `K_c`.
    fn entries(&self) -> f64;
    /// The entries of `K_c` between these unknowns, one row after the other.
    fn block(&self, unknowns: &[u32]) -> Vec<f64>;
    /// The bodies with springs along rows, each with its stiffness: `K_c + Σ k b bᵀ`. None where that cannot be had.
    fn stiffened(&self, _rows: &[(&WeightedGap, f64)]) -> Result<Option<Box<dyn Compliance>>, SolveError> {
        Ok(None)
    }
}

impl Compliance for Factor {
    fn solve_columns(&self, b: &mut [f64]) -> Result<(), SolveError> {
        self.solve_columns(b)
    }

    fn solve_once(&self, b: &mut [f64]) -> Result<(), SolveError> {
        self.solve_once(b)
    }

    fn solve_accurately(&self, b: &[f64]) -> Result<Vec<f64>, SolveError> {
        self.solve_accurately(b)
    }

    fn size(&self) -> usize {
        self.size()
    }

    fn entries(&self) -> f64 {
        self.entries()
    }

    fn block(&self, unknowns: &[u32]) -> Vec<f64> {
        self.block(unknowns)
    }

    fn stiffened(&self, rows: &[(&WeightedGap, f64)]) -> Result<Option<Box<dyn Compliance>>, SolveError> {
        let rows: Vec<(&[(u32, f64)], f64)> = rows.iter().map(|(row, k)| (&row.terms[..], *k)).collect();
        Ok(Some(Box::new(self.plus(&SymmetricMatrix::of_squares(self.size(), &rows))?)))
    }
}

/// How the compliance of the rows is known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Route {
    /// By its columns: dense.
    #[default]
    Columns,
    /// By products, one solve each.
    Products,
}

/// Contact states that are solved for until one stays, as is usual.
const STATES: f64 = 8.0;
/// Products that a contact state needs: an estimate.
const PRODUCTS: f64 = 50.0;
/// How much faster an operation is in dense kernels, and in solves for many columns, than in a solve for one, which waits for
/// memory: an estimate.
const BLOCKED: f64 = 4.0;
/// Memory that columns may take in any case: little beside the mesh and the program.
const LITTLE: f64 = 64.0 * 1024.0 * 1024.0;
/// Else the share of the memory of the factor.
const SHARE: f64 = 0.5;

impl Route {
    /// The one that costs less for `carrying` rows whose columns have `length` entries, over a factor with `entries`.
    pub fn cheaper(carrying: usize, length: usize, entries: f64) -> Self {
        let (rows, solve) = (carrying as f64, 4.0 * entries);
        let by_columns = (rows * solve + STATES * rows.powi(3) * 2.0 / 3.0) / BLOCKED;
        let by_products = STATES * PRODUCTS * solve;
        let bytes = Self::bytes(carrying, length);
        if by_columns > by_products || bytes > LITTLE.max(SHARE * 8.0 * entries) {
            Route::Products
        } else {
            Route::Columns
        }
    }

    /// Memory of the columns and of their dense system.
    fn bytes(carrying: usize, length: usize) -> f64 {
        8.0 * carrying as f64 * (length as f64 + carrying as f64)
    }

    /// The most memory that contact takes beside the factor of the bodies, if no more than so many rows carry.
    pub fn memory(rows: usize, length: usize, entries: f64) -> f64 {
        match Self::cheaper(rows, length, entries) {
            Route::Columns => Self::bytes(rows, length),
            Route::Products => 8.0 * (3.0 * MOST_PRODUCTS as f64 * rows as f64 + COUPLED * entries),
        }
    }
}

/// Entries of the factor with springs along rows, which couple both sides, over those without, about.
const COUPLED: f64 = 2.0;
/// Products kept, and vectors of the Krylov space, at most.
const MOST_PRODUCTS: usize = 250;
/// Unknowns of a row that its own compliance is taken from: those that it counts most.
const NEAREST: usize = 48;
/// Residual of a contact state relative to what it changes; a few digits above what solves without refinement can reach.
const TOLERANCE: f64 = 1e-12;
/// Residual beyond which there is no solution.
const UNSOLVED: f64 = 1e-7;
/// Corrections of a solution by the same products.
const CORRECTIONS: usize = 3;
/// Motions that rows resist less than this, relative, are not resisted.
const HELD: f64 = 1e-9;

/// Rows that are known by products with their compliance; springs follow after them.
pub struct RowProducts<'a> {
    system: &'a dyn Compliance,
    rows: &'a [WeightedGap],
    springs: &'a [Spring],
    /// Of all rows and springs under a unit force at each spring, and of the springs under each row.
    under_springs: Vec<Vec<f64>>,
    of_springs: Vec<Vec<f64>>,
    /// The own compliance of every row, as far as it was asked for.
    own: RefCell<Vec<f64>>,
    known: RefCell<Products>,
    stiff: RefCell<Option<Stiff>>,
}

/// The bodies with springs along rows.
struct Stiff {
    system: Box<dyn Compliance>,
    /// The stiffness of each row, zero where there is no spring.
    stiffness: Vec<f64>,
}

/// Stiffness of the springs along rows, in terms of the rows' own: enough for a few steps, and few digits are lost.
const STIFF: f64 = 100.0;
/// Rows that may have changed between giving way and not before the bodies are factorised with other springs: each costs a
/// solve or two, and a factorisation as much as some tens of solves.
const CHANGED: usize = 32;

/// A solution of equations in the rows.
pub struct Solved {
    pub x: Vec<f64>,
    /// `W x`.
    pub product: Vec<f64>,
}

impl<'a> RowProducts<'a> {
    pub fn new(system: &'a dyn Compliance, rows: &'a [WeightedGap], springs: &'a [Spring]) -> Result<Self, SolveError> {
        let count = rows.len() + springs.len();
        let mut out = RowProducts {
            system,
            rows,
            springs,
            under_springs: Vec::new(),
            of_springs: Vec::new(),
            own: RefCell::new(vec![0.0; count]),
            known: RefCell::default(),
            stiff: RefCell::default(),
        };
        for spring in springs {
            // What a spring moves is nearly rigid: only to the last digit does it tell what holds the body.
            let mut unit = vec![0.0; system.size()];
            unit[spring.unknown as usize] = 1.0;
            let u = system.solve_accurately(&unit)?;
            out.under_springs.push(out.at(&u));
            let pushed = rows.iter().map(|row| product(row.push(), &u));
            out.of_springs.push(pushed.collect());
        }
        for (s, spring) in springs.iter().enumerate() {
            out.own.borrow_mut()[rows.len() + s] = 1.0 / spring.stiffness;
        }
        Ok(out)
    }

    /// Number of rows, those of springs included.
    pub fn count(&self) -> usize {
        self.rows.len() + self.springs.len()
    }

    /// Number of springs, whose rows come last.
    pub fn springs(&self) -> usize {
        self.springs.len()
    }

    /// All rows at a displacement, without their gaps.
    fn at(&self, u: &[f64]) -> Vec<f64> {
        let springs = self.springs.iter().map(|s| u[s.unknown as usize]);
        self.rows.iter().map(|row| product(&row.terms, u)).chain(springs).collect()
    }

    /// All rows under tractions of the rows, with these bodies.
    fn under(&self, system: &dyn Compliance, of_rows: &[f64]) -> Result<Vec<f64>, SolveError> {
        let mut b = vec![0.0; system.size()];
        for (row, t) in self.rows.iter().zip(of_rows).filter(|(_, t)| **t != 0.0) {
            row.push().iter().for_each(|(i, c)| b[*i as usize] += c * t);
        }
        system.solve_once(&mut b)?;
        Ok(self.at(&b))
    }

    /// `W z`.
    pub fn product(&self, z: &[f64]) -> Result<Vec<f64>, SolveError> {
        let (of_rows, of_springs) = z.split_at(self.rows.len());
        let mut out = self.under(self.system, of_rows)?;
        for (s, of_spring) in self.of_springs.iter().enumerate() {
            out[self.rows.len() + s] = of_spring.iter().zip(of_rows).map(|(w, t)| w * t).sum();
        }
        for (under, force) in self.under_springs.iter().zip(of_springs) {
            out.iter_mut().zip(under).for_each(|(y, w)| *y += w * force);
        }
        Ok(out)
    }

    /// How one row answers to the traction of another one of the same node, about.
    pub fn near(&self, row: usize, column: usize) -> f64 {
        let (row, column) = (&self.rows[row], &self.rows[column]);
        let nearest = |terms: &[(u32, f64)]| {
            let mut unknowns: Vec<(u32, f64)> = terms.to_vec();
            unknowns.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()).then(a.0.cmp(&b.0)));
            unknowns.into_iter().take(NEAREST).map(|u| u.0).collect::<Vec<u32>>()
        };
        let mut list = [nearest(column.push()), nearest(&row.terms)].concat();
        list.sort_unstable();
        list.dedup();
        let n = list.len();
        let vector = |terms: &[(u32, f64)]| {
            let mut out = DVector::zeros(n);
            for (unknown, c) in terms {
                if let Ok(at) = list.binary_search(unknown) {
                    out[at] += c;
                }
            }
            out
        };
        let block = DMatrix::from_row_slice(n, n, &self.system.block(&list));
        let Some(factor) = block.cholesky() else { return 0.0 };
        vector(&row.terms).dot(&factor.solve(&vector(column.push())))
    }

    /// Column of one row, as by columns.
    pub fn column(&self, row: usize) -> Result<Vec<f64>, SolveError> {
        let mut unit = vec![0.0; self.count()];
        unit[row] = 1.0;
        self.product(&unit)
    }

    /// Makes the own compliance of rows known.
    pub fn require(&self, rows: impl Iterator<Item = usize>) {
        for r in rows {
            if self.own.borrow()[r] == 0.0 {
                let own = self.near(r, r);
                self.own.borrow_mut()[r] = own;
            }
        }
    }

    /// About the compliance of a row that was required.
    pub fn own(&self, row: usize) -> f64 {
        self.own.borrow()[row]
    }

    /// How a row answers to a force at a spring, or a spring to a row.
    pub fn spring_entry(&self, row: usize, column: usize) -> f64 {
        match (row.checked_sub(self.rows.len()), column.checked_sub(self.rows.len())) {
            (_, Some(s)) => self.under_springs[s][row],
            (Some(s), None) => self.of_springs[s][column],
            (None, None) => 0.0,
        }
    }

    /// The motion of the springs that equations resist least, if it is none at all. `image` are the equations, of which the
    /// springs are `y = 0`, and `scale` the sizes of the rows.
    pub fn unheld(&self, scale: &[f64], image: &dyn Fn(&[f64], &[f64]) -> Vec<f64>) -> Option<Vec<f64>> {
        let (n, m) = (self.rows.len(), self.springs.len());
        if m == 0 {
            return None;
        }
        let zero = vec![0.0; self.count()];
        let columns: Vec<DVector<f64>> = (self.under_springs.iter().zip(&scale[n..]))
            .map(|(under, s)| {
                let mut moved = under.clone();
                moved[n..].fill(0.0);
                let image = image(&zero, &moved);
                DVector::from_iterator(n, image[..n].iter().zip(scale).map(|(y, scale)| y / scale * s))
            })
            .collect();
        let triangle = DMatrix::from_columns(&columns).qr().r();
        let svd = triangle.svd(false, true);
        let least = svd.singular_values.argmin();
        let is_free = svd.singular_values.len() < m
            || least.1.is_nan()
            || least.1 <= HELD * svd.singular_values.max().max(f64::MIN_POSITIVE);
        is_free.then(|| svd.v_t.map_or(Vec::new(), |v| v.row(least.0).iter().copied().collect()))
    }

    /// Gives the rows that are `held` springs, unless nearly the same ones have them. Bodies that only contact holds keep
    /// what holds them until then, and so do rows that push otherwise than they measure.
    fn stiffen(&self, held: &[usize]) -> Result<(), SolveError> {
        let mut wanted = vec![false; self.rows.len()];
        held.iter().for_each(|&r| wanted[r] = true);
        let stiff = &mut *self.stiff.borrow_mut();
        if !self.springs.is_empty() || self.rows.iter().any(|row| !row.forces.is_empty()) {
            return Ok(());
        }
        if let Some(stiff) = stiff {
            let changed = wanted.iter().zip(&stiff.stiffness).filter(|(wanted, k)| **wanted != (**k > 0.0)).count();
            if changed <= CHANGED {
                return Ok(());
            }
        }
        *stiff = None;
        self.require(held.iter().copied());
        let stiffness: Vec<f64> =
            (0..wanted.len()).map(|r| if wanted[r] && self.own(r) > 0.0 { STIFF / self.own(r) } else { 0.0 }).collect();
        let rows: Vec<(&WeightedGap, f64)> =
            self.rows.iter().zip(stiffness.iter().copied()).filter(|(_, k)| *k > 0.0).collect();
        if let Some(system) = self.system.stiffened(&rows)? {
            self.known.borrow_mut().clear();
            *stiff = Some(Stiff { system, stiffness });
        }
        Ok(())
    }

    /// Solves equations `image(x, W x) = b` in tractions of rows; those that are not asked for say `x = b`. None where there
    /// is no solution.
    ///
    /// `scale` is the size of the traction of each row; the equations of rows that are `held` say how far they move, or nearly.
    pub fn solve(
        &self,
        scale: &[f64],
        held: &[usize],
        image: &dyn Fn(&[f64], &[f64]) -> Vec<f64>,
        b: &[f64],
    ) -> Result<Option<Solved>, SolveError> {
        self.stiffen(held)?;
        let stiff = self.stiff.borrow();
        let stiffness = |r: usize| stiff.as_ref().and_then(|s| s.stiffness.get(r)).copied().unwrap_or(0.0);
        let over = |v: &[f64]| v.iter().zip(scale).map(|(v, s)| v / s).collect::<Vec<f64>>();
        // Where a row has a spring a traction of its own size times that moves it as a traction did.
        let times = |v: &[f64]| -> Vec<f64> {
            let size = |r: usize| if stiffness(r) > 0.0 { STIFF * scale[r] } else { scale[r] };
            v.iter().enumerate().map(|(r, v)| v * size(r)).collect()
        };
        let tractions = |v: &[f64], wx: &[f64]| -> Vec<f64> {
            times(v).iter().zip(wx).enumerate().map(|(r, (z, y))| z - stiffness(r) * y).collect()
        };
        let scaled = |v: &[f64], wx: &[f64]| over(&image(&tractions(v, wx), wx));
        let product = |v: &[f64]| match stiff.as_ref() {
            Some(stiff) => self.under(stiff.system.as_ref(), &times(v)),
            None => self.product(&times(v)),
        };
        let equations = Equations { product: &product, image: &scaled };
        let known = &mut *self.known.borrow_mut();
        if known.len() > MOST_PRODUCTS / 2 {
            known.clear();
        }
        let mut left = over(b);
        let size = |v: &[f64]| v.iter().map(|v| v * v).sum::<f64>().sqrt();
        let whole = size(&left);
        let mut out = Solved { x: vec![0.0; b.len()], product: vec![0.0; b.len()] };
        for _ in 0..CORRECTIONS {
            let now = size(&left);
            if now <= TOLERANCE * whole {
                return Ok(Some(out));
            }
            let found = equations.least_residual(&left, known, TOLERANCE * whole / now, MOST_PRODUCTS)?;
            let x = tractions(&found.x, &found.product);
            out.x.iter_mut().zip(&x).for_each(|(sum, x)| *sum += x);
            out.product.iter_mut().zip(&found.product).for_each(|(sum, w)| *sum += w);
            let reached = over(&image(&x, &found.product));
            left.iter_mut().zip(&reached).for_each(|(l, r)| *l -= r);
            if found.relative > 0.5 {
                break;
            }
        }
        Ok((size(&left) <= UNSOLVED * whole).then_some(out))
    }
}

fn product(terms: &[(u32, f64)], u: &[f64]) -> f64 {
    terms.iter().map(|(i, c)| c * u[*i as usize]).sum()
}
