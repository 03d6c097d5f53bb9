//! Equilibrium on both sides of the front.

use super::multiplier::{FrontMultipliers, coupling, inner_product};
use crate::equilibrium::elements::Elements;
use crate::equilibrium::free::FreeState;
use crate::equilibrium::ghost::{ghost_pairs, ghost_weight};
use crate::equilibrium::unknowns::{Unknowns, number_where};
use crate::method::ZoneMultiplier;
use crate::problem::Membrane;
use crate::quadrature::{FrontPoint, Quadrature};
use crate::zone::{Zone, contact, contact_of};
use signorini_fem::lagrange::Tabulation;
use signorini_geometry::Vector;
use signorini_solve::{Factor, SolveError, Symbolic, SymmetricMatrix, dense};

/// A row of the coupling between the multiplier along the front and the displacement on one side.
type Row = Vec<(u32, f64)>;

/// The side of the fronts in contact, the multipliers, and what is needed to solve the same equations again.
pub struct Saddle<const D: usize> {
    multiplier: ZoneMultiplier,
    pub(super) fronts: FrontMultipliers,
    /// The multiplier along the fronts, `λ = T ∂_n u⁺`.
    pub(super) lambda: Vec<f64>,
    pub(super) within: Unknowns,
    /// Displacement in the zone, where its nodes are its own.
    pub(super) displacement: Vec<f64>,
    /// `∫ l² ∇q·∇v + q v` over the zone.
    gram: Factor,
    /// `∫ T ∇u·∇v` over the free membrane, stiffened along the fronts by a multiple of the coupling's square, which the
    /// constraint makes up for.
    free: Factor,
    couplings: [Vec<Row>; 2],
    stiffening: Vec<f64>,
    /// The response of the free membrane to each unknown of the multiplier, and of the constraint to that.
    response: Vec<f64>,
    schur: dense::Factor,
}

impl<const D: usize> Saddle<D> {
    /// Solves for both sides, given the free membrane's own matrix and load: this, and the free displacement.
    #[allow(clippy::too_many_arguments)]
    pub(crate) fn solve<Z: Zone<D>>(
        membrane: &Membrane<D>,
        zone: &Z,
        elements: &Elements<D>,
        quadrature: &Quadrature<D>,
        beyond: &Unknowns,
        matrix: SymmetricMatrix,
        load: Vec<f64>,
        multiplier: ZoneMultiplier,
    ) -> Result<(Self, Vec<f64>), SolveError> {
        let within = number_where(membrane, quadrature, |r| contact_of(r).is_some());
        let fronts = FrontMultipliers::new(membrane, zone, quadrature);
        let one = |_: usize| 1.0;
        let couplings = [
            coupling(membrane, quadrature, &fronts, beyond, |p| p.free, one),
            coupling(membrane, quadrature, &fronts, &within, |p| contact(p.side, p.zone), one),
        ];
        let gram = Symbolic::default().factor(gram(membrane, elements, quadrature, &within, multiplier))?;
        let displacement = gram.solve(&projected(membrane, quadrature, &within, multiplier))?;

        let diagonal = matrix.diagonal();
        let stiffening: Vec<f64> = couplings[0]
            .iter()
            .map(|row| {
                let square: f64 = row.iter().map(|(_, v)| v * v).sum();
                let stiffness: f64 = row.iter().map(|(i, v)| v * v * diagonal[*i as usize]).sum();
                if square > 0.0 { stiffness / (square * square) } else { 0.0 }
            })
            .collect();
        let stiffeners: Vec<(Vec<u32>, Vec<f64>)> = couplings[0]
            .iter()
            .zip(&stiffening)
            .map(|(row, r)| {
                let dofs = row.iter().map(|(i, _)| *i).collect();
                (dofs, row.iter().flat_map(|(_, a)| row.iter().map(move |(_, b)| r * a * b)).collect())
            })
            .collect();
        let n = matrix.size();
        let free = Symbolic::default().factor(matrix.plus(&SymmetricMatrix::of_cliques(n, &stiffeners)))?;
        let m = fronts.count;
        let mut response = vec![0.0; n * m];
        for (k, row) in couplings[0].iter().enumerate() {
            row.iter().for_each(|(i, v)| response[k * n + *i as usize] = *v);
        }
        free.solve_columns(&mut response)?;
        let mut schur = vec![0.0; m * m];
        for (k, row) in couplings[0].iter().enumerate() {
            for l in 0..m {
                schur[k * m + l] = row.iter().map(|(i, v)| v * response[l * n + *i as usize]).sum();
            }
            if row.is_empty() {
                // An unknown of no weight.
                schur[k * m + k] = 1.0;
            }
        }
        let schur = dense::Factor::new(m, &schur).ok_or(SolveError::NotFactorised { size: m })?;
        let mut saddle = Self {
            multiplier,
            fronts,
            lambda: Vec::new(),
            within,
            displacement,
            gram,
            free,
            couplings,
            stiffening,
            response,
            schur,
        };
        let trace = saddle.trace(&saddle.displacement);
        let (u, lambda) = saddle.solve_free(&load, &trace)?;
        saddle.lambda = lambda;
        Ok((saddle, u))
    }

    /// `∫_Γ μ v` of a displacement in the zone.
    fn trace(&self, displacement: &[f64]) -> Vec<f64> {
        let value = |row: &Row| row.iter().map(|(i, v)| v * displacement[*i as usize]).sum();
        self.couplings[1].iter().map(value).collect()
    }

    /// The free displacement and the multiplier along the fronts under a load, where the displacement takes the moments
    /// `trace` on the fronts.
    fn solve_free(&self, load: &[f64], trace: &[f64]) -> Result<(Vec<f64>, Vec<f64>), SolveError> {
        let mut load = load.to_vec();
        for ((row, r), g) in self.couplings[0].iter().zip(&self.stiffening).zip(trace) {
            row.iter().for_each(|(i, v)| load[*i as usize] += r * v * g);
        }
        let mut u = self.free.solve(&load)?;
        let excess: Vec<f64> = self.couplings[0]
            .iter()
            .zip(trace)
            .map(|(row, g)| row.iter().map(|(i, v)| v * u[*i as usize]).sum::<f64>() - g)
            .collect();
        let lambda = self.schur.solve(&excess);
        let n = u.len();
        for (k, l) in lambda.iter().enumerate() {
            u.iter_mut().zip(&self.response[k * n..(k + 1) * n]).for_each(|(u, y)| *u -= l * y);
        }
        Ok((u, lambda))
    }

    /// The rate of the multiplier along the fronts, where load and constraints change at given rates.
    pub(super) fn lambda_rate(&self, load: &[f64], within: &[f64], along: &[f64]) -> Result<Vec<f64>, SolveError> {
        let rate = self.gram.solve(within)?;
        let trace: Vec<f64> = self.trace(&rate).iter().zip(along).map(|(t, a)| t + a).collect();
        Ok(self.solve_free(load, &trace)?.1)
    }

    /// A function of the multiplier's space at a quadrature point of the fronts.
    pub(super) fn along(&self, values: &[f64], point: usize) -> f64 {
        self.fronts.shares[point].iter().map(|(k, s)| s * values[*k]).sum()
    }

    pub(super) fn gradient_weight(&self) -> f64 {
        self.multiplier.gradient_weight()
    }

    /// The slope with which the gap opens at each point of the fronts.
    pub(crate) fn slope_jump(&self, free: &FreeState<'_, D>) -> Vec<f64> {
        let membrane = free.membrane;
        let slope = |(i, p): (usize, &FrontPoint<D>)| {
            let h = membrane.obstacles.jet(p.side, &p.x);
            p.side.sign() * (self.along(&self.lambda, i) / membrane.tension.value(&p.x) - h.gradient.dot(&p.normal))
        };
        free.quadrature.front.iter().enumerate().map(slope).collect()
    }

    /// The multiplier that presses the membrane onto the body, at the unknowns of the zone, and its integral: the force of
    /// the membrane on the body, with what acts along the fronts.
    ///
    /// # Errors
    /// Equations that cannot be solved.
    pub fn zone_multiplier(&self, free: &FreeState<'_, D>) -> Result<(Vec<f64>, f64), SolveError> {
        let FreeState { membrane, quadrature, .. } = *free;
        let mut rhs = vec![0.0; self.within.count];
        let mut t = Tabulation::default();
        let mut each_point = |visit: &mut dyn FnMut(&Tabulation<D>, &[u32], &signorini_geometry::Point<D>, f64)| {
            self.within.for_each_rule(membrane, quadrature, |cell, _, dofs, points| {
                for p in points {
                    membrane.cells.tabulate(cell, &p.x, &mut t);
                    visit(&t, dofs, &p.x, p.weight);
                }
            });
        };
        each_point(&mut |t, dofs, x, w| {
            let (_, gradient) = combined(t, dofs, &self.displacement);
            let (f, flux) = (membrane.load.value(x), gradient * membrane.tension.value(x));
            for (a, &i) in dofs.iter().enumerate() {
                rhs[i as usize] += w * (f * t.value[a] - flux.dot(&t.gradient[a]));
            }
        });
        for (row, l) in self.couplings[1].iter().zip(&self.lambda) {
            row.iter().for_each(|(i, v)| rhs[*i as usize] += l * v);
        }
        let p = self.gram.solve(&rhs)?;
        let mut force = 0.0;
        each_point(&mut |t, dofs, _, w| force += w * combined(t, dofs, &p).0);
        Ok((p, force))
    }
}

/// A function and its gradient at a point.
pub(super) fn combined<const D: usize>(t: &Tabulation<D>, dofs: &[u32], values: &[f64]) -> (f64, Vector<D>) {
    dofs.iter().enumerate().fold((0.0, Vector::zeros()), |(value, gradient), (a, &i)| {
        let c = values[i as usize];
        (value + c * t.value[a], gradient + c * t.gradient[a])
    })
}

/// The inner product of the multiplier in the zone, with a ghost penalty for cells cut to slivers.
fn gram<const D: usize>(
    membrane: &Membrane<D>,
    elements: &Elements<D>,
    quadrature: &Quadrature<D>,
    within: &Unknowns,
    multiplier: ZoneMultiplier,
) -> SymmetricMatrix {
    let pairs = ghost_pairs(membrane, elements, quadrature, within);
    let mut cliques: Vec<Vec<u32>> = within.all().map(|(_, _, dofs)| dofs.to_vec()).collect();
    cliques.extend(pairs.iter().map(|pair| pair.dofs.clone()));
    let mut matrix = SymmetricMatrix::from_cliques(within.count, &cliques);
    let gradient_weight = multiplier.gradient_weight();
    within.for_each_rule(membrane, quadrature, |cell, _, dofs, points| {
        matrix.add(dofs, &inner_product(membrane, cell, dofs.len(), points, gradient_weight), 1.0);
    });
    let weight = ghost_weight(membrane.cells.degree());
    let h = membrane.grid.h();
    for pair in &pairs {
        matrix.add(&pair.dofs, elements.ghost(membrane, pair.number), weight * pair.need() * (gradient_weight + h * h));
    }
    matrix
}

/// `∫ l² ∇q·∇h + q h` over the zone, for the height `h` of what it touches.
fn projected<const D: usize>(
    membrane: &Membrane<D>,
    quadrature: &Quadrature<D>,
    within: &Unknowns,
    multiplier: ZoneMultiplier,
) -> Vec<f64> {
    let gradient_weight = multiplier.gradient_weight();
    let mut rhs = vec![0.0; within.count];
    let mut t = Tabulation::default();
    within.for_each_rule(membrane, quadrature, |cell, region, dofs, points| {
        let Some((side, _)) = contact_of(region) else { return };
        for p in points {
            membrane.cells.tabulate(cell, &p.x, &mut t);
            let h = membrane.obstacles.jet(side, &p.x);
            for (a, &i) in dofs.iter().enumerate() {
                rhs[i as usize] += p.weight * (gradient_weight * t.gradient[a].dot(&h.gradient) + t.value[a] * h.value);
            }
        }
    });
    rhs
}
