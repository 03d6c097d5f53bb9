//! Contact of the recovered boundary with a rigid body, without friction (cell surface to analytical surface, CSTAS, of
//! Konyukhov, Lorenz & Schweizerhof, *Various contact approaches for the finite cell method*, Comput. Mech. 56, 2015).
//!
//! At every point `a` of the boundary, with reference weight `w`, position `x = X + u`, gap `g = d(x)`, `ν = ∇d` and
//! `H = ∇∇d` of the rigid body, and the pressure `q = ⟨λ + s p_σ - c g⟩`:
//!
//! residual `-Σ w q N ν`, linearisation `Σ w N N [χ (c ν ν - s ν (∂p_σ)) - q H]`.
//!
//! | enforcement | `λ` | `s` | `c` |
//! |---|---|---|---|
//! | penalty | 0 | 0 | `ε` |
//! | augmented Lagrangian | kept, `λ ← q` | 0 | `ε` |
//! | Nitsche (θ = 0; Chouly & Hild 2013) | 0 | 1 | `γ_0 E p²/h` |
//!
//! `p_σ = ν·σ(u)n` is the pressure of the body's own stress, with `∂p_σ = ν·σ(·)n + t·H`. The points outnumber the
//! functions on the boundary by far; a pressure that is free at every point ripples, and that of Nitsche's method, a
//! polynomial of the cell with `γ_0 = 1`, does not.

use crate::body::{CellBody, Site};
use crate::error::CellsError;
use crate::place::Place;
use crate::space::Tabulation;
use crate::supports::RowSpace;
use crate::system::{Scaled, System};
use nalgebra::DMatrix;
use signorini_geometry::rigid_shape::GapJet;
use signorini_geometry::{Point, Vector};
use signorini_solve::krylov::conjugate_residuals;
use std::collections::BTreeMap;

/// A rigid body: the gap of a point to it with its derivatives.
pub trait Obstacle<const D: usize>: Sync {
    fn gap(&self, x: &Point<D>) -> GapJet<D>;
}

impl<const D: usize, F: Fn(&Point<D>) -> GapJet<D> + Sync> Obstacle<D> for F {
    fn gap(&self, x: &Point<D>) -> GapJet<D> {
        self(x)
    }
}

/// A rigid shape of space as an obstacle.
pub struct RigidObstacle<'a>(pub &'a dyn signorini_geometry::rigid_shape::RigidShape);

impl Obstacle<3> for RigidObstacle<'_> {
    fn gap(&self, x: &Point<3>) -> GapJet<3> {
        self.0.gap(x)
    }
}

/// Where the gap is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kinematics {
    /// At the place before the body deforms, and linear in the displacement.
    Linearised,
    /// At the place of the point now.
    Current,
}

/// How the gap is kept from closing further.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Enforcement {
    /// Pressure per depth of penetration.
    Penalty { stiffness: f64 },
    /// The same with so many updates of the multipliers; more of them make the pressure ripple.
    AugmentedLagrangian { stiffness: f64, updates: usize },
    /// With a stabilisation relative to `E p²/h`; 1 is best, and more than 3 ripples.
    Nitsche { gamma: f64 },
}

/// Contact with a rigid body.
pub struct RigidContact<'a, const D: usize> {
    pub obstacle: &'a dyn Obstacle<D>,
    /// The part of the boundary that may touch.
    pub on: Place<D>,
    pub kinematics: Kinematics,
    pub enforcement: Enforcement,
}

/// A point that may touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TouchingSite<const D: usize> {
    pub site: Site<D>,
    pub gap: f64,
    /// Outward normal of the rigid body.
    pub normal: Vector<D>,
    /// Pressure per area before the body deforms; zero where it is open.
    pub pressure: f64,
}

/// A body in contact.
#[derive(Clone, Debug)]
pub struct ContactSolution<const D: usize> {
    pub displacement: Vec<f64>,
    pub sites: Vec<TouchingSite<D>>,
    /// Force of the rigid body on the cells.
    pub force: Vector<D>,
    /// Newton iterations, of all updates together.
    pub iterations: usize,
    /// Norm of the residual relative to the forces after each iteration.
    pub residuals: Vec<f64>,
}

/// Relative residual at which Newton's method ends.
const CONVERGED: f64 = 1e-10;
const MOST_ITERATIONS: usize = 60;

/// A site with the functions there.
struct Tabulated<const D: usize> {
    site: Site<D>,
    /// Stiffness `c`.
    stiffness: f64,
    functions: Vec<u32>,
    values: Vec<f64>,
    /// Unknowns of the traction and its row of each component; empty where the stress is not asked for.
    unknowns: Vec<u32>,
    tractions: Vec<Vector<D>>,
    lambda: f64,
    start: GapJet<D>,
}

/// The contact at one state of the body.
struct Met<const D: usize> {
    jet: GapJet<D>,
    traction: Vector<D>,
    trial: f64,
}

impl<const D: usize> Tabulated<D> {
    fn displacement(&self, u: &[f64]) -> Vector<D> {
        let term = |(f, v): (&u32, &f64)| Vector::<D>::from_fn(|k, _| u[D * *f as usize + k]) * *v;
        self.functions.iter().zip(&self.values).map(term).sum()
    }

    fn meet(&self, contact: &RigidContact<'_, D>, u: &[f64]) -> Met<D> {
        let d = self.displacement(u);
        let jet = match contact.kinematics {
            Kinematics::Linearised => GapJet::flat(self.start.gap + self.start.normal.dot(&d), self.start.normal),
            Kinematics::Current => contact.obstacle.gap(&(self.site.x + d)),
        };
        let traction: Vector<D> = self.unknowns.iter().zip(&self.tractions).map(|(i, t)| t * u[*i as usize]).sum();
        let trial = self.lambda + jet.normal.dot(&traction) - self.stiffness * jet.gap;
        Met { jet, traction, trial }
    }
}

impl<const D: usize> RigidContact<'_, D> {
    /// Solves the equations of a body with contact.
    ///
    /// # Errors
    /// A place without boundary; constants out of range; a body that nothing holds; no convergence.
    pub fn solve(&self, system: &System<'_, D>) -> Result<ContactSolution<D>, CellsError> {
        self.solve_from(system, &vec![0.0; system.body.unknowns()])
    }

    /// Solves the equations from a displacement that is close, such as that under a smaller load.
    ///
    /// # Errors
    /// Those of [`RigidContact::solve`].
    pub fn solve_from(&self, system: &System<'_, D>, start: &[f64]) -> Result<ContactSolution<D>, CellsError> {
        let updates = match self.enforcement {
            Enforcement::AugmentedLagrangian { updates, .. } => updates,
            _ => 0,
        };
        let mut sites = self.tabulate(system.body)?;
        let n = system.body.unknowns();
        let mut u: Vec<f64> = system.prescribed.iter().zip(start).map(|(v, s)| v.unwrap_or(*s)).collect();
        let (mut iterations, mut residuals) = (0, Vec::new());
        for update in 0..=updates {
            loop {
                let met: Vec<Met<D>> = sites.iter().map(|s| s.meet(self, &u)).collect();
                let mut active: Vec<bool> = met.iter().map(|m| m.trial > 0.0).collect();
                if iterations == 0 && !active.contains(&true) {
                    // Before the body has moved the closest point stands for the contact to come.
                    let closest = (0..met.len()).min_by(|a, b| met[*a].jet.gap.total_cmp(&met[*b].jet.gap));
                    closest.into_iter().for_each(|c| active[c] = true);
                }
                let (residual, scale) = residual(system, &sites, &met, &u);
                if iterations > 0 {
                    residuals.push(norm(&residual) / scale);
                    if norm(&residual) <= CONVERGED * scale {
                        break;
                    }
                }
                if iterations >= MOST_ITERATIONS * (update + 1) {
                    let residual = norm(&residual) / scale;
                    return Err(CellsError::NotConverged { iterations, residual });
                }
                let step = newton_step(system, &sites, &met, &active, &residual)?;
                (0..n).for_each(|i| u[i] += step[i]);
                iterations += 1;
            }
            if update < updates {
                for s in &mut sites {
                    s.lambda = s.meet(self, &u).trial.max(0.0);
                }
            }
        }
        let mut force = Vector::<D>::zeros();
        let sites = (sites.iter())
            .map(|s| {
                let met = s.meet(self, &u);
                let pressure = met.trial.max(0.0);
                force += met.jet.normal * (s.site.weight * pressure);
                TouchingSite { site: s.site, gap: met.jet.gap, normal: met.jet.normal, pressure }
            })
            .collect();
        Ok(ContactSolution { displacement: u, sites, force, iterations, residuals })
    }

    fn tabulate(&self, body: &CellBody<D>) -> Result<Vec<Tabulated<D>>, CellsError> {
        let (given, wants_stress) = match self.enforcement {
            Enforcement::Penalty { stiffness } | Enforcement::AugmentedLagrangian { stiffness, .. } => {
                (stiffness, false)
            }
            Enforcement::Nitsche { gamma } => (gamma, true),
        };
        if !(given > 0.0 && given.is_finite()) {
            let name = if wants_stress { "gamma" } else { "stiffness" };
            return Err(CellsError::Value { name, value: given, must: "must be positive" });
        }
        let mut t = Tabulation::default();
        let mut out = Vec::new();
        for site in body.points_on(&self.on)? {
            let cell = &body.cells()[site.cell];
            let (mut unknowns, mut tractions) = (Vec::new(), Vec::new());
            let mut stiffness = given;
            if wants_stress {
                unknowns = body.unknowns_of(cell.stress_cell);
                body.functions_at(cell.stress_cell, &site.x, &mut t);
                tractions = body.tractions(&site.x, &site.normal, &t);
                let h = body.tree().leaves()[cell.leaf].size();
                stiffness *=
                    body.elastic().youngs_modulus * body.modulus_factor(&site.x) * (body.degree() as f64).powi(2) / h;
            }
            body.functions_at(site.cell, &site.x, &mut t);
            out.push(Tabulated {
                site,
                stiffness,
                functions: cell.functions.clone(),
                values: t.value.clone(),
                unknowns,
                tractions,
                lambda: 0.0,
                start: self.obstacle.gap(&site.x),
            });
        }
        Ok(out)
    }
}

fn norm(v: &[f64]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Residual of the unknowns that are free, and the size of the forces in it.
fn residual<const D: usize>(
    system: &System<'_, D>,
    sites: &[Tabulated<D>],
    met: &[Met<D>],
    u: &[f64],
) -> (Vec<f64>, f64) {
    let internal = system.matrix.multiply(u);
    let mut of_contact = vec![0.0; u.len()];
    for (s, m) in sites.iter().zip(met).filter(|(_, m)| m.trial > 0.0) {
        for (f, v) in s.functions.iter().zip(&s.values) {
            for k in 0..D {
                of_contact[D * *f as usize + k] += s.site.weight * m.trial * v * m.jet.normal[k];
            }
        }
    }
    let scale = norm(&internal) + norm(&system.forces) + norm(&of_contact) + f64::MIN_POSITIVE;
    let free = |i: usize| system.prescribed[i].is_none();
    let r = (0..u.len()).map(|i| if free(i) { internal[i] - system.forces[i] - of_contact[i] } else { 0.0 }).collect();
    (r, scale)
}

/// The Newton step. The symmetric part of the linearisation is factorised; what the stress of Nitsche's method adds is
/// not symmetric and enters through conjugate residuals, preconditioned with that factor.
fn newton_step<const D: usize>(
    system: &System<'_, D>,
    sites: &[Tabulated<D>],
    met: &[Met<D>],
    active: &[bool],
    residual: &[f64],
) -> Result<Vec<f64>, CellsError> {
    let n = residual.len();
    let touching: Vec<(&Tabulated<D>, &Met<D>)> =
        sites.iter().zip(met).zip(active).filter(|(_, a)| **a).map(|(p, _)| p).collect();
    let factor = match factorise(system, &touching, Curvature::With) {
        Ok(factor) => (factor, Curvature::With),
        // A convex rigid body softens: its part then joins the unsymmetric one.
        Err(_) => match factorise(system, &touching, Curvature::Without) {
            Ok(factor) => (factor, Curvature::Without),
            Err(error) => {
                let holding = touching.iter().map(|(s, m)| (s.site.x, s.site.weight, m.jet.normal));
                let modes = system.free_motions_with(holding);
                return Err(if modes > 0 { CellsError::Unsupported { modes } } else { error });
            }
        },
    };
    let (factor, curvature) = factor;
    let minus: Vec<f64> = residual.iter().map(|r| -r).collect();
    let start = factor.solve(&minus)?;
    if touching.iter().all(|(s, _)| s.unknowns.is_empty()) && curvature == Curvature::With {
        return Ok(start);
    }
    let product = |v: &[f64]| -> Result<Option<Vec<f64>>, CellsError> {
        let mut image = vec![0.0; n];
        for (s, m) in &touching {
            let d = s.displacement(v);
            let bent = m.jet.hessian * d;
            let mut change =
                -m.jet.normal.dot(&s.unknowns.iter().zip(&s.tractions).map(|(i, t)| t * v[*i as usize]).sum());
            change -= m.traction.dot(&bent);
            let mut force = m.jet.normal * change;
            if curvature == Curvature::Without {
                force -= bent * m.trial.max(0.0);
            }
            for (f, value) in s.functions.iter().zip(&s.values) {
                for k in 0..D {
                    image[D * *f as usize + k] += s.site.weight * value * force[k];
                }
            }
        }
        (0..n).filter(|i| system.prescribed[*i].is_some()).for_each(|i| image[i] = 0.0);
        let mut out = factor.solve_once(&image)?;
        out.iter_mut().zip(v).for_each(|(o, v)| *o += v);
        Ok(Some(out))
    };
    let most = 400;
    conjugate_residuals(start, product, 1e-12, most)?
        .ok_or(CellsError::NotConverged { iterations: most, residual: f64::NAN })
}

#[derive(Clone, Copy, PartialEq)]
enum Curvature {
    With,
    Without,
}

fn factorise<const D: usize>(
    system: &System<'_, D>,
    touching: &[(&Tabulated<D>, &Met<D>)],
    curvature: Curvature,
) -> Result<Scaled, CellsError> {
    let mut matrix = system.matrix.clone();
    let mut by_cell: BTreeMap<usize, Vec<&(&Tabulated<D>, &Met<D>)>> = BTreeMap::new();
    touching.iter().for_each(|p| by_cell.entry(p.0.site.cell).or_default().push(p));
    for (cell, list) in by_cell {
        let unknowns = RowSpace::new(system.body, cell, cell).unknowns;
        let mut k = DMatrix::<f64>::zeros(unknowns.len(), unknowns.len());
        for (s, m) in list {
            let mut local = m.jet.normal * m.jet.normal.transpose() * s.stiffness;
            if curvature == Curvature::With {
                local -= m.jet.hessian * m.trial.max(0.0);
            }
            for (i, vi) in s.values.iter().enumerate() {
                for (j, vj) in s.values.iter().enumerate() {
                    for a in 0..D {
                        for b in 0..D {
                            k[(D * i + a, D * j + b)] += s.site.weight * vi * vj * local[(a, b)];
                        }
                    }
                }
            }
        }
        matrix.add(&unknowns, k.as_slice(), 1.0);
    }
    let held: Vec<Option<f64>> = system.prescribed.iter().map(|p| p.map(|_| 0.0)).collect();
    matrix.prescribe(&held, &mut vec![0.0; held.len()]);
    Scaled::new(system.body, matrix)
}
