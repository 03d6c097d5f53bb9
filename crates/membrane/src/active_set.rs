//! The classical method: linear elements whose nodes are kept off the bodies, by a primal-dual active set.
//!
//! (Hintermüller, Ito & Kunisch, SIAM J. Optim. 13, 2002.) Its contact zone is a set of nodes: a staircase. It serves
//! as a method of its own, to be set beside the level set, and to predict zones that are not one simple patch.

use crate::deferred::Known;
use crate::equilibrium::elements::Elements;
use crate::equilibrium::nitsche_flux;
use crate::equilibrium::system::System;
use crate::obstacle::Side;
use crate::problem::Membrane;
use crate::quadrature::Quadrature;
use crate::zone::Zone;
use signorini_fem::lagrange::Tabulation;
use signorini_geometry::{Point, Vector};
use signorini_solve::{SolveError, Symbolic};

/// Most changes of the active set on one grid.
const MOST_CHANGES: usize = 200;

/// The nodal solution of a membrane of degree 1.
#[derive(Clone, Debug)]
pub struct NodalSolution<const D: usize> {
    /// For each node of the grid: displacement, reaction of the floor, and whether it is in contact. None outside.
    pub nodes: Vec<Option<Node>>,
    /// Changes of the active set on the final grid.
    pub iterations: usize,
    /// Number of nodes that changed in each iteration.
    pub changes: Vec<usize>,
    pub converged: bool,
    pub unknowns: usize,
    /// Force of each support on the membrane.
    pub support_forces: Vec<f64>,
    /// Resultant of the load.
    pub load_force: f64,
    pub energy: f64,
}

/// One node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    pub displacement: f64,
    /// Force of what it touches on the node, along z.
    pub reaction: f64,
    /// The side on which it touches a body.
    pub contact: Option<Side>,
    /// Whether a body can touch the node: whether it lies in the membrane.
    pub inside: bool,
    /// Share of the membrane that belongs to the node: the integral of its shape function.
    pub share: f64,
}

impl Node {
    /// Pressure of what it touches: its reaction over its share.
    pub fn pressure(&self) -> f64 {
        self.contact.map_or(0.0, |side| side.sign() * self.reaction / self.share.max(f64::MIN_POSITIVE))
    }
}

/// How the iteration begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NodalStart {
    /// From the solution on a grid of half the cells, and so on.
    Nested,
    /// From the free solution.
    Cold,
}

/// Solves a membrane, which must be of degree 1, beside its bodies.
pub fn solve<const D: usize, Z: Zone<D>>(
    membrane: &Membrane<D>,
    start: NodalStart,
    interrupted: &dyn Fn() -> bool,
) -> Result<NodalSolution<D>, SolveError> {
    solve_beside::<D, Z>(membrane, start, None, interrupted)
}

/// The same as accurately as a state at hand.
#[doc(hidden)]
pub fn solve_beside<const D: usize, Z: Zone<D>>(
    membrane: &Membrane<D>,
    start: NodalStart,
    known: Option<&Known<'_, D, Z>>,
    interrupted: &dyn Fn() -> bool,
) -> Result<NodalSolution<D>, SolveError> {
    let coarser = match start {
        NodalStart::Nested => membrane.cells.coarser().map(|cells| membrane.on(cells)),
        NodalStart::Cold => None,
    };
    let guess = match &coarser {
        Some(coarser) => Some((solve_beside::<D, Z>(coarser, start, known, interrupted)?, coarser)),
        None => None,
    };
    let elements = Elements::new(membrane);
    let zone = Z::empty(&membrane.grid);
    let mut system = System::assemble(membrane, &zone, &elements);
    let mut node_of = vec![0usize; system.unknowns.count];
    let mut nodes = Vec::new();
    for (cell, _, dofs) in system.unknowns.all() {
        membrane.cells.functions(cell, &mut nodes);
        for (&dof, &node) in dofs.iter().zip(&nodes) {
            node_of[dof as usize] = node as usize;
        }
    }
    if let Some(known) = known {
        let places: Vec<Point<D>> = node_of.iter().map(|&node| membrane.cells.node(node)).collect();
        system.rhs = known.load(membrane, &system, &places);
    }
    let System { quadrature, unknowns, matrix, rhs } = system;
    // Heights of floor and ceiling at the nodes within the membrane.
    let heights: Vec<Option<[f64; 2]>> = node_of
        .iter()
        .map(|&node| {
            let x = membrane.cells.node(node);
            membrane.contains(&x).then(|| Side::BOTH.map(|side| membrane.obstacles.height(side, &x)))
        })
        .collect();
    let mut active: Vec<Option<Side>> = node_of
        .iter()
        .zip(&heights)
        .map(|(&node, h)| {
            h.as_ref().and(guess.as_ref()).and_then(|(g, coarser)| g.contact(coarser, &membrane.cells.node(node)))
        })
        .collect();
    let mut symbolic = Symbolic::default();
    let mut changes = Vec::new();
    let mut converged = false;
    let (mut u, mut reaction) = (Vec::new(), Vec::new());
    while changes.len() < MOST_CHANGES && !interrupted() {
        let mut constrained = matrix.clone();
        let mut load = rhs.clone();
        let prescribed: Vec<Option<f64>> =
            heights.iter().zip(&active).map(|(h, a)| Some((*h)?[(*a)? as usize])).collect();
        constrained.prescribe(&prescribed, &mut load);
        u = symbolic.factor(constrained)?.solve(&load)?;
        reaction = matrix.multiply(&u);
        for (r, b) in reaction.iter_mut().zip(&rhs) {
            *r -= b;
        }
        let mut changed = 0;
        for i in 0..u.len() {
            let Some(h) = heights[i] else { continue };
            // On active nodes the gap vanishes, on free ones the reaction: one of the two decides.
            let now = match active[i] {
                Some(side) => (side.sign() * reaction[i] > 0.0).then_some(side),
                None => Side::BOTH.into_iter().find(|side| side.sign() * (u[i] - h[*side as usize]) < 0.0),
            };
            changed += usize::from(now != active[i]);
            active[i] = now;
        }
        changes.push(changed);
        if changed == 0 {
            converged = true;
            break;
        }
    }
    let shares = shares(membrane, &quadrature);
    let mut all = vec![None; membrane.cells.function_count()];
    for i in 0..u.len() {
        all[node_of[i]] = Some(Node {
            displacement: u[i],
            reaction: if active[i].is_some() { reaction[i] } else { 0.0 },
            contact: active[i],
            inside: heights[i].is_some(),
            share: shares[node_of[i]],
        });
    }
    let (support_forces, load_force, energy) = totals(membrane, &quadrature, &all);
    Ok(NodalSolution {
        nodes: all,
        iterations: changes.len(),
        changes,
        converged,
        unknowns: unknowns.count,
        support_forces,
        load_force,
        energy,
    })
}

/// The integral of each node's shape function over the membrane.
fn shares<const D: usize>(membrane: &Membrane<D>, quadrature: &Quadrature<D>) -> Vec<f64> {
    let mut t = Tabulation::default();
    let mut numbers = Vec::new();
    let mut shares = vec![0.0; membrane.cells.function_count()];
    for cell in 0..quadrature.cells.len() {
        membrane.cells.functions(cell, &mut numbers);
        for (_, points) in quadrature.volumes(membrane, cell) {
            for p in points.iter() {
                membrane.cells.tabulate(cell, &p.x, &mut t);
                for (&node, v) in numbers.iter().zip(&t.value) {
                    shares[node as usize] += p.weight * v;
                }
            }
        }
    }
    shares
}

/// Force of each support, resultant of the load, and the energy `∫ T/2 |∇u|² - f u`.
fn totals<const D: usize>(
    membrane: &Membrane<D>,
    quadrature: &Quadrature<D>,
    nodes: &[Option<Node>],
) -> (Vec<f64>, f64, f64) {
    let mut t = Tabulation::default();
    let mut numbers = Vec::new();
    let mut evaluate = |cell: usize, x: &Point<D>| {
        membrane.cells.functions(cell, &mut numbers);
        membrane.cells.tabulate(cell, x, &mut t);
        let values = numbers.iter().map(|&node| nodes[node as usize].map_or(0.0, |n| n.displacement));
        values
            .enumerate()
            .fold((0.0, Vector::<D>::zeros()), |(u, g), (i, v)| (u + v * t.value[i], g + v * t.gradient[i]))
    };
    let (mut force, mut energy) = (0.0, 0.0);
    for cell in 0..quadrature.cells.len() {
        for (_, points) in quadrature.volumes(membrane, cell) {
            for p in points.iter() {
                let (u, gradient) = evaluate(cell, &p.x);
                let f = membrane.load.value(&p.x);
                force += p.weight * f;
                energy += p.weight * (0.5 * membrane.tension.value(&p.x) * gradient.norm_squared() - f * u);
            }
        }
    }
    let mut supports = vec![0.0; membrane.support_count];
    for p in &quadrature.rim {
        if let Some(support) = &membrane.supports[p.piece] {
            let (u, gradient) = evaluate(p.cell, &p.x);
            supports[support.index] += p.weight
                * nitsche_flux(membrane, p.cell, &p.x, &p.normal, u - support.displacement.value(&p.x), &gradient);
        }
    }
    (supports, force, energy)
}

/// The nodes round a point with the values of their functions there; none beyond the cells.
fn shape_functions<const D: usize>(membrane: &Membrane<D>, x: &Point<D>) -> Vec<(usize, f64)> {
    let x = membrane.grid.bounds().clamp(x);
    let Some(cell) = membrane.cells.containing(&x) else { return Vec::new() };
    let mut t = Tabulation::default();
    let mut numbers = Vec::new();
    membrane.cells.functions(cell, &mut numbers);
    membrane.cells.tabulate(cell, &x, &mut t);
    numbers.into_iter().map(|n| n as usize).zip(t.value).collect()
}

/// Interpolates nodal values linearly; `beyond` is the value where there are no cells.
fn interpolate<const D: usize>(
    membrane: &Membrane<D>,
    x: &Point<D>,
    beyond: f64,
    at_node: impl Fn(usize) -> f64,
) -> f64 {
    let around = shape_functions(membrane, x);
    if around.is_empty() { beyond } else { around.into_iter().map(|(node, v)| at_node(node) * v).sum() }
}

impl<const D: usize> NodalSolution<D> {
    /// What the node nearest to `x` touches.
    pub fn contact(&self, membrane: &Membrane<D>, x: &Point<D>) -> Option<Side> {
        self.nearest(membrane, x).and_then(|n| n.contact)
    }

    /// The node whose function is largest at a point.
    fn nearest(&self, membrane: &Membrane<D>, x: &Point<D>) -> Option<Node> {
        let around = shape_functions(membrane, x).into_iter();
        around.max_by(|a, b| a.1.total_cmp(&b.1)).and_then(|(node, _)| self.nodes[node])
    }

    /// A function that is negative in the predicted zone of one side: the distance to its edge, interpolated between the nodes.
    ///
    /// At free nodes it is that which the gap of a parabola tells, `√(2 T g / p)`; at nodes in contact half a cell, or that
    /// which their reaction tells: on a line a node whose front lies a part `δ` of a cell beyond it bears `1 - (1 - δ)² / 2` of
    /// the pressure on a cell.
    pub fn predictor<'a>(
        &'a self,
        membrane: &'a Membrane<D>,
        side: Side,
        by_reaction: bool,
    ) -> impl Fn(&Point<D>) -> f64 + 'a {
        let cells = &*membrane.cells;
        let mut sizes = vec![f64::INFINITY; self.nodes.len()];
        let mut functions = Vec::new();
        for cell in 0..cells.count() {
            cells.functions(cell, &mut functions);
            for &node in &functions {
                let size = &mut sizes[node as usize];
                *size = size.min(cells.size(cell));
            }
        }
        let h = sizes.iter().copied().fold(f64::INFINITY, f64::min);
        let at_node: Vec<f64> = self
            .nodes
            .iter()
            .zip(&sizes)
            .enumerate()
            .map(|(i, (node, &h))| match node {
                Some(n) if n.contact == Some(side) && by_reaction => {
                    let share = n.pressure() / membrane.pressure(side, &membrane.cells.node(i));
                    let beyond = 1.0 - (2.0 * (1.0 - share)).max(0.0).sqrt();
                    -h * if beyond.is_finite() { beyond.clamp(0.05, 1.0) } else { 0.5 }
                }
                Some(n) if n.contact == Some(side) => -0.5 * h,
                Some(n) if n.inside => {
                    let x = membrane.cells.node(i);
                    let pressure = membrane.pressure(side, &x);
                    let gap = membrane.obstacles.gap(side, &x, n.displacement).max(0.0);
                    let distance = (2.0 * membrane.tension.value(&x) * gap / pressure).sqrt();
                    if pressure > 0.0 { distance.clamp(0.05 * h, 2.0 * h) } else { h }
                }
                _ => h,
            })
            .collect();
        move |x| interpolate(membrane, x, h, |node| at_node[node])
    }

    /// Displacement at a point of the membrane.
    pub fn displacement(&self, membrane: &Membrane<D>, x: &Point<D>) -> f64 {
        interpolate(membrane, x, 0.0, |node| self.nodes[node].map_or(0.0, |n| n.displacement))
    }

    /// Pressure at a point: that on the nearest node, its reaction over its share.
    pub fn pressure(&self, membrane: &Membrane<D>, x: &Point<D>) -> f64 {
        self.nearest(membrane, x).map_or(0.0, |n| n.pressure())
    }
}
