//! Equilibrium of nets of straight tension-only elements, of any topology, from any start.
//!
//! Two stages. The force-density method (Schek 1974) takes `T/L` of each element as given: one linear system, the Laplacian
//! of the graph, gives a shape in which everything is in tension. Newton's method then finds the equilibrium of the elastic
//! net. Its potential `Σ W(|x_j - x_i|) - Σ F·x` is convex, because `W` grows and is convex and so is a distance: a line
//! search on the potential converges from everywhere. Where elements are much stiffer than their tension needs, a stretchy
//! net is solved first, then stiffer ones. Slack elements get a stiffness in the matrix only; nodes that only slack
//! elements hold are undetermined, and said to be so.

use super::element::{Drive, stretched};
use signorini_geometry::{Matrix, Point, Vector};
use signorini_solve::{SolveError, Symbolic, SymmetricMatrix};

/// An element of a net.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Member {
    pub nodes: [usize; 2],
    /// `EA`.
    pub stiffness: f64,
    /// Length without tension.
    pub unstrained: f64,
}

/// A net: nodes that are held keep their positions.
#[derive(Clone, Debug)]
pub struct Net {
    pub positions: Vec<Point<3>>,
    pub held: Vec<bool>,
    pub members: Vec<Member>,
    /// Dead force on each node.
    pub forces: Vec<Vector<3>>,
}

/// A net in equilibrium.
#[derive(Clone, Debug)]
pub struct Shape {
    pub positions: Vec<Point<3>>,
    pub tensions: Vec<f64>,
    /// Elements without tension.
    pub slack: Vec<usize>,
    /// Nodes that nothing under tension holds, and that no force pulls.
    pub undetermined: Vec<usize>,
    /// Largest component of the sum of forces on a node that is not held.
    pub residual: f64,
    pub iterations: usize,
}

/// Why there is no shape.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FormError {
    #[error("member {member} joins node {node}, but there are {count}")]
    NoNode { member: usize, node: usize, count: usize },
    #[error("member {member}: {name} = {value}, valid are positive numbers")]
    NotPositive { member: usize, name: &'static str, value: f64 },
    #[error("node {node} is not connected to a supported node")]
    Loose { node: usize },
    #[error("{given} values of {name} for {needed} nodes")]
    Count { name: &'static str, given: usize, needed: usize },
    #[error("no equilibrium after {iterations} iterations: the residual force is {residual:e}")]
    NotConverged { iterations: usize, residual: f64 },
    #[error(transparent)]
    Solve(#[from] SolveError),
}

/// Least stiffness, as a multiple of the tension, of the first net that is solved, and the factor between one and the next.
const FIRST: f64 = 20.0;
const FACTOR: f64 = 50.0;
const MOST: usize = 400;

impl Net {
    fn check(&self) -> Result<(), FormError> {
        let n = self.positions.len();
        for (name, given) in [("held", self.held.len()), ("forces", self.forces.len())] {
            if given != n {
                return Err(FormError::Count { name, given, needed: n });
            }
        }
        for (k, m) in self.members.iter().enumerate() {
            if let Some(&node) = m.nodes.iter().find(|&&i| i >= n) {
                return Err(FormError::NoNode { member: k, node, count: n });
            }
            for (name, value) in [("stiffness", m.stiffness), ("unstrained length", m.unstrained)] {
                if value <= 0.0 || !value.is_finite() {
                    return Err(FormError::NotPositive { member: k, name, value });
                }
            }
        }
        // Nodes that are joined to held ones, one member further each time.
        let mut neighbours = vec![Vec::new(); n];
        for m in &self.members {
            neighbours[m.nodes[0]].push(m.nodes[1]);
            neighbours[m.nodes[1]].push(m.nodes[0]);
        }
        let mut reached = self.held.clone();
        let mut front: Vec<usize> = (0..n).filter(|&i| self.held[i]).collect();
        while let Some(i) = front.pop() {
            for &j in &neighbours[i] {
                if !reached[j] {
                    reached[j] = true;
                    front.push(j);
                }
            }
        }
        reached.iter().position(|r| !r).map_or(Ok(()), |node| Err(FormError::Loose { node }))
    }

    /// The positions for given force densities `T/L` of the members, in equilibrium with the forces.
    ///
    /// # Errors
    /// A net that is none; densities for which it has no shape.
    pub fn force_density(&self, densities: &[f64]) -> Result<Vec<Point<3>>, FormError> {
        self.check()?;
        let (index, count) = self.numbers();
        let cliques: Vec<Vec<u32>> = self.members.iter().map(|m| free(&index, m).map(|(_, u)| u).collect()).collect();
        let mut matrix = SymmetricMatrix::from_cliques(count, &cliques);
        let mut right = vec![[0.0; 3]; count];
        for (i, force) in self.forces.iter().enumerate() {
            if let Some(u) = index[i] {
                (0..3).for_each(|k| right[u as usize][k] += force[k]);
            }
        }
        for (m, q) in self.members.iter().zip(densities) {
            let own: Vec<(usize, u32)> = free(&index, m).collect();
            let n = own.len();
            let values: Vec<f64> = (0..n * n).map(|k| if k / n == k % n { *q } else { -*q }).collect();
            matrix.add(&own.iter().map(|o| o.1).collect::<Vec<_>>(), &values, 1.0);
            for (side, u) in own {
                let other = m.nodes[1 - side];
                if self.held[other] {
                    (0..3).for_each(|k| right[u as usize][k] += q * self.positions[other][k]);
                }
            }
        }
        let factor = Symbolic::default().factor(matrix)?;
        let mut positions = self.positions.clone();
        for k in 0..3 {
            let x = factor.solve(&right.iter().map(|r| r[k]).collect::<Vec<_>>())?;
            (0..index.len())
                .filter_map(|i| index[i].map(|u| (i, u)))
                .for_each(|(i, u)| positions[i][k] = x[u as usize]);
        }
        Ok(positions)
    }

    /// Numbers of the nodes that are free.
    fn numbers(&self) -> (Vec<Option<u32>>, usize) {
        let mut count = 0;
        let index = (self.held.iter())
            .map(|held| {
                (!held).then(|| {
                    count += 1;
                    count - 1
                })
            })
            .collect();
        (index, count as usize)
    }

    /// A tension of the size of those that will be: of all forces, or of the stretch of the start.
    fn tension_scale(&self) -> f64 {
        let forces: f64 = self.forces.iter().map(|f| f.norm()).sum();
        let stretch = (self.members.iter())
            .map(|m| stretched(&self.between(&self.positions, m), m.stiffness, m.unstrained, Drive::Elastic).tension)
            .fold(0.0, f64::max);
        if forces > 0.0 { forces } else { stretch }
    }

    fn between(&self, positions: &[Point<3>], m: &Member) -> Vector<3> {
        positions[m.nodes[1]] - positions[m.nodes[0]]
    }

    /// The equilibrium.
    ///
    /// # Errors
    /// A net that is none, or no convergence.
    pub fn equilibrium(&self) -> Result<Shape, FormError> {
        let scale = self.tension_scale();
        let mean = self.members.iter().map(|m| m.unstrained).sum::<f64>() / self.members.len().max(1) as f64;
        let initial_multipliers = if scale > 0.0 { scale } else { 1.0 };
        let densities: Vec<f64> =
            self.members.iter().map(|m| initial_multipliers / m.unstrained.max(1e-6 * mean)).collect();
        let mut positions = self.force_density(&densities)?;
        let stiffest = self.members.iter().fold(0.0f64, |s, m| s.max(m.stiffness));
        let mut iterations = 0;
        let mut limit = FIRST * initial_multipliers;
        loop {
            let is_last = limit >= stiffest;
            let stiffness = |m: &Member| m.stiffness.min(limit);
            let residual = self.solve(&mut positions, &stiffness, is_last, &mut iterations)?;
            if is_last {
                return Ok(self.shape(positions, residual, iterations));
            }
            limit *= FACTOR;
        }
    }

    fn potential(&self, positions: &[Point<3>], stiffness: &dyn Fn(&Member) -> f64) -> f64 {
        let stored: f64 = (self.members.iter())
            .map(|m| stretched(&self.between(positions, m), stiffness(m), m.unstrained, Drive::Elastic).energy)
            .sum();
        let work: f64 = self.forces.iter().zip(positions).zip(&self.positions).map(|((f, x), o)| f.dot(&(x - o))).sum();
        stored - work
    }

    fn solve(
        &self,
        positions: &mut Vec<Point<3>>,
        stiffness: &dyn Fn(&Member) -> f64,
        is_last: bool,
        iterations: &mut usize,
    ) -> Result<f64, FormError> {
        let (index, count) = self.numbers();
        let unknowns =
            |m: &Member| -> Vec<u32> { free(&index, m).flat_map(|(_, u)| [3 * u, 3 * u + 1, 3 * u + 2]).collect() };
        let cliques: Vec<Vec<u32>> = self.members.iter().map(unknowns).collect();
        let mut symbolic = Symbolic::default();
        let span = (0..3)
            .map(|k| self.positions.iter().map(|x| x[k]).fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x))))
            .map(|(low, high)| high - low)
            .fold(self.members.iter().fold(0.0f64, |s, m| s.max(m.unstrained)), f64::max);
        for _ in 0..MOST {
            let parts: Vec<_> = (self.members.iter())
                .map(|m| stretched(&self.between(positions, m), stiffness(m), m.unstrained, Drive::Elastic))
                .collect();
            let largest = parts.iter().fold(0.0f64, |t, p| t.max(p.tension));
            let mut right = vec![0.0; 3 * count];
            let mut matrix = SymmetricMatrix::from_cliques(3 * count, &cliques);
            for (i, force) in self.forces.iter().enumerate() {
                if let Some(u) = index[i] {
                    (0..3).for_each(|k| right[3 * u as usize + k] += force[k]);
                }
            }
            let mut rounding = 0.0f64;
            for ((m, p), own) in self.members.iter().zip(&parts).zip(&cliques) {
                // Of a slack element in the matrix only.
                let slack = largest.max(self.tension_scale()).max(stiffness(m) * f64::EPSILON) / m.unstrained;
                let k = if p.tension > 0.0 { p.stiffness } else { Matrix::<3>::identity() * slack };
                let n = own.len();
                let values: Vec<f64> = (0..n * n)
                    .map(|q| {
                        let (r, c) = (q / n, q % n);
                        if r / 3 == c / 3 { k[(r % 3, c % 3)] } else { -k[(r % 3, c % 3)] }
                    })
                    .collect();
                matrix.add(own, &values, 1.0);
                for (side, u) in free(&index, m) {
                    let sign = if side == 0 { 1.0 } else { -1.0 };
                    (0..3).for_each(|k| right[3 * u as usize + k] += sign * p.force[k]);
                }
                if p.tension > 0.0 {
                    rounding = rounding.max(stiffness(m) * f64::EPSILON * span / m.unstrained);
                }
            }
            let residual = right.iter().fold(0.0f64, |m, r| m.max(r.abs()));
            // Positions have the round-off of the span, and tensions that of positions times the stiffness.
            let wanted = (if is_last { 1e-11 } else { 1e-4 }) * largest.max(self.tension_scale());
            if residual <= wanted.max(8.0 * rounding) {
                return Ok(residual);
            }
            let step = symbolic.factor(matrix)?.solve(&right)?;
            let longest = (0..count).map(|u| Vector::<3>::from_column_slice(&step[3 * u..3 * u + 3]).norm());
            let longest = longest.fold(0.0f64, f64::max);
            let before = self.potential(positions, stiffness);
            let slope: f64 = -step.iter().zip(&right).map(|(s, r)| s * r).sum::<f64>();
            let mut share = (0.3 * span / longest).min(1.0);
            loop {
                let next: Vec<Point<3>> = (positions.iter().enumerate())
                    .map(|(i, x)| match index[i] {
                        Some(u) => {
                            x + Vector::<3>::from_column_slice(&step[3 * u as usize..3 * u as usize + 3]) * share
                        }
                        None => *x,
                    })
                    .collect();
                let after = self.potential(&next, stiffness);
                // A potential that no longer changes beyond its rounding is not lowered further.
                let flat = 1e-13 * (before.abs() + after.abs());
                if after <= before + 1e-4 * share * slope + flat || share < 1e-12 {
                    *positions = next;
                    break;
                }
                share *= 0.5;
            }
            *iterations += 1;
            if share < 1e-12 {
                return Err(FormError::NotConverged { iterations: *iterations, residual });
            }
        }
        Err(FormError::NotConverged { iterations: *iterations, residual: f64::NAN })
    }

    fn shape(&self, positions: Vec<Point<3>>, residual: f64, iterations: usize) -> Shape {
        let tensions: Vec<f64> = (self.members.iter())
            .map(|m| stretched(&self.between(&positions, m), m.stiffness, m.unstrained, Drive::Elastic).tension)
            .collect();
        let mut is_determined = self.held.clone();
        for (m, t) in self.members.iter().zip(&tensions) {
            if *t > 0.0 {
                m.nodes.iter().for_each(|&i| is_determined[i] = true);
            }
        }
        Shape {
            slack: (0..tensions.len()).filter(|&k| tensions[k] == 0.0).collect(),
            undetermined: (0..positions.len()).filter(|&i| !is_determined[i]).collect(),
            positions,
            tensions,
            residual,
            iterations,
        }
    }
}

/// Free nodes of a member: which of both, and its number.
fn free<'a>(index: &'a [Option<u32>], member: &'a Member) -> impl Iterator<Item = (usize, u32)> + 'a {
    (0..2).filter_map(|side| index[member.nodes[side]].map(|u| (side, u)))
}
