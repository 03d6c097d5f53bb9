//! Contact of a body with itself by discs on its recovered boundary (discrete cell to cell, DCTC, of Konyukhov, Lorenz &
//! Schweizerhof, Comput. Mech. 56, 2015): for pores that close.
//!
//! Disc or ball `i` stands for a part `w_i` of the boundary. Its centre is `c_i = X_i - χ n_i + u_i`, so that it touches
//! the boundary from within; as published it is `X_i + u_i`, which makes bodies meet a radius each too early. Pairs on
//! faces that look at each other repel with the energy `½ ε √(w_i w_j) ⟨2χ - |c_i - c_j|⟩²`: with `q = (c_i - c_j)/r` and
//! overlap `o`, force `ε A o q`, tangent `ε A (q q - (o/r)(I - q q))`.
//!
//! Rules for the radius, with the largest spacing `s` of discs: below `s/2` discs slip through between two others; the
//! larger it is the smoother is the contact (the force of a row of discs varies by `s²/16χ` along it); above half of the
//! thickness of the material centres of opposite faces cross. `χ = s` serves. Pairs that overlap before anything moves,
//! or whose normals do not oppose each other (`n_i·n_j > -0.3`), are neighbours and do not touch.

use crate::body::{CellBody, Site};
use crate::error::CellsError;
use crate::place::Place;
use crate::space::Tabulation;
use crate::system::{Scaled, System};
use nalgebra::DMatrix;
use signorini_geometry::{Matrix, Point, Vector};
use signorini_solve::SymmetricMatrix;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// Where the centres of discs are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Centres {
    /// A radius within the material: discs touch the boundary.
    Within,
    /// On the boundary, as published.
    OnBoundary,
}

/// Contact of a body with itself.
#[derive(Clone)]
pub struct DiscContact<const D: usize> {
    pub on: Place<D>,
    /// Least distance of discs; they are spread evenly from the quadrature points of the boundary.
    pub spacing: f64,
    /// Their radius, or the largest spacing.
    pub radius: Option<f64>,
    /// Pressure per overlap.
    pub stiffness: f64,
    pub centres: Centres,
    /// Increments in which loads and prescribed displacements grow.
    pub increments: usize,
}

/// A disc or a ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc<const D: usize> {
    /// Its point of the boundary, with the part of the boundary that it stands for.
    pub site: Site<D>,
    /// Force per length or area of that part, from the discs that it overlaps.
    pub pressure: f64,
    /// Centre before and after the body deforms.
    pub centre: [Point<D>; 2],
}

/// A body that touches itself.
#[derive(Clone, Debug)]
pub struct DiscSolution<const D: usize> {
    pub displacement: Vec<f64>,
    pub discs: Vec<Disc<D>>,
    pub radius: f64,
    /// Largest distance between neighbours.
    pub largest_spacing: f64,
    /// Pairs that touch, with their overlap.
    pub pairs: Vec<(usize, usize, f64)>,
    /// Newton iterations of all increments together.
    pub iterations: usize,
}

/// Product of normals above which two discs are on the same face.
pub(crate) const SAME_FACE: f64 = -0.3;
const CONVERGED: f64 = 1e-9;
const MOST_ITERATIONS: usize = 80;

/// A disc with the functions at its point.
struct Tabulated<const D: usize> {
    site: Site<D>,
    start: Point<D>,
    functions: Vec<u32>,
    values: Vec<f64>,
}

impl<const D: usize> Tabulated<D> {
    fn displacement(&self, u: &[f64]) -> Vector<D> {
        let term = |(f, v): (&u32, &f64)| Vector::<D>::from_fn(|k, _| u[D * *f as usize + k]) * *v;
        self.functions.iter().zip(&self.values).map(term).sum()
    }
}

impl<const D: usize> DiscContact<D> {
    /// Solves the equations of a body that touches itself, in increments from the state without loads.
    ///
    /// # Errors
    /// Constants out of range, a place without boundary, a body that nothing holds, no convergence.
    pub fn solve(&self, system: &System<'_, D>) -> Result<DiscSolution<D>, CellsError> {
        for (name, value) in
            [("spacing", self.spacing), ("stiffness", self.stiffness), ("radius", self.radius.unwrap_or(1.0))]
        {
            if !(value > 0.0 && value.is_finite()) {
                return Err(CellsError::Value { name, value, must: "must be positive" });
            }
        }
        let modes = system.free_motions();
        if modes > 0 {
            return Err(CellsError::Unsupported { modes });
        }
        let (sites, largest_spacing) = spread(&system.body.points_on(&self.on)?, self.spacing);
        let radius = self.radius.unwrap_or(largest_spacing);
        let discs = self.tabulate(system.body, sites, radius);
        let mut u = vec![0.0; system.body.unknowns()];
        let mut iterations = 0;
        for increment in 1..=self.increments.max(1) {
            let share = increment as f64 / self.increments.max(1) as f64;
            iterations += self.increment(system, &discs, radius, share, &mut u)?;
        }
        let centres = centres(&discs, &u);
        let pairs = touching(&discs, &centres, radius);
        let mut forces = vec![0.0; discs.len()];
        for (i, j, overlap) in &pairs {
            let force = self.stiffness * (discs[*i].site.weight * discs[*j].site.weight).sqrt() * overlap;
            forces[*i] += force;
            forces[*j] += force;
        }
        let discs = (discs.iter().enumerate())
            .map(|(i, d)| Disc { site: d.site, pressure: forces[i] / d.site.weight, centre: [d.start, centres[i]] })
            .collect();
        Ok(DiscSolution { displacement: u, discs, radius, largest_spacing, pairs, iterations })
    }

    fn tabulate(&self, body: &CellBody<D>, sites: Vec<Site<D>>, radius: f64) -> Vec<Tabulated<D>> {
        let offset = if self.centres == Centres::Within { radius } else { 0.0 };
        let mut t = Tabulation::default();
        (sites.into_iter())
            .map(|site| {
                body.functions_at(site.cell, &site.x, &mut t);
                Tabulated {
                    site,
                    start: site.x - site.normal * offset,
                    functions: body.cells()[site.cell].functions.clone(),
                    values: t.value.clone(),
                }
            })
            .collect()
    }

    /// Newton's method at a share of the loads; gives the number of iterations.
    fn increment(
        &self,
        system: &System<'_, D>,
        discs: &[Tabulated<D>],
        radius: f64,
        share: f64,
        u: &mut [f64],
    ) -> Result<usize, CellsError> {
        for (u, value) in u.iter_mut().zip(&system.prescribed) {
            if let Some(value) = value {
                *u = share * value;
            }
        }
        let free: Vec<bool> = system.prescribed.iter().map(Option::is_none).collect();
        let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let mut relative = f64::INFINITY;
        for iteration in 0..MOST_ITERATIONS {
            let now = centres(discs, u);
            let pairs = touching(discs, &now, radius);
            let internal = system.matrix.multiply(u);
            let mut residual: Vec<f64> = internal.iter().zip(&system.forces).map(|(k, f)| k - share * f).collect();
            for &(i, j, overlap) in &pairs {
                let q = (now[i] - now[j]).normalize();
                let force = q * (self.stiffness * (discs[i].site.weight * discs[j].site.weight).sqrt() * overlap);
                for (disc, sign) in [(i, -1.0), (j, 1.0)] {
                    for (f, v) in discs[disc].functions.iter().zip(&discs[disc].values) {
                        (0..D).for_each(|k| residual[D * *f as usize + k] += sign * v * force[k]);
                    }
                }
            }
            residual.iter_mut().zip(&free).filter(|(_, free)| !**free).for_each(|(r, _)| *r = 0.0);
            relative = norm(&residual) / (norm(&internal) + share * norm(&system.forces) + f64::MIN_POSITIVE);
            if iteration > 0 && relative <= CONVERGED {
                return Ok(iteration);
            }
            let step = self.step(system, discs, &now, &pairs, &residual)?;
            // Two rows of discs must not jump through each other.
            let farthest = discs.iter().map(|d| d.displacement(&step).norm()).fold(0.0, f64::max);
            let limited =
                if pairs.is_empty() && iteration == 0 { 1.0 } else { (radius / farthest.max(1e-300)).min(1.0) };
            u.iter_mut().zip(&step).for_each(|(u, s)| *u += limited * s);
        }
        Err(CellsError::NotConverged { iterations: MOST_ITERATIONS, residual: relative })
    }

    fn step(
        &self,
        system: &System<'_, D>,
        discs: &[Tabulated<D>],
        now: &[Point<D>],
        pairs: &[(usize, usize, f64)],
        residual: &[f64],
    ) -> Result<Vec<f64>, CellsError> {
        let minus: Vec<f64> = residual.iter().map(|r| -r).collect();
        let held: Vec<Option<f64>> = system.prescribed.iter().map(|p| p.map(|_| 0.0)).collect();
        let factorise = |turning: f64| {
            let parts: Vec<(Vec<u32>, Vec<f64>)> =
                pairs.iter().map(|p| self.pair_tangent(discs, now, p, turning)).collect();
            let mut matrix = system.matrix.plus(&SymmetricMatrix::of_cliques(residual.len(), &parts));
            matrix.prescribe(&held, &mut vec![0.0; held.len()]);
            Scaled::new(system.body, matrix)
        };
        // The turning of a pair softens; where it softens too much it is left out, and Newton's method is slower.
        factorise(1.0).or_else(|_| factorise(0.0))?.solve(&minus)
    }

    /// Unknowns and tangent of a pair.
    fn pair_tangent(
        &self,
        discs: &[Tabulated<D>],
        now: &[Point<D>],
        &(i, j, overlap): &(usize, usize, f64),
        turning: f64,
    ) -> (Vec<u32>, Vec<f64>) {
        let d = now[i] - now[j];
        let (r, q) = (d.norm(), d.normalize());
        let along = q * q.transpose();
        let stiffness = self.stiffness * (discs[i].site.weight * discs[j].site.weight).sqrt();
        let local = (along - (Matrix::<D>::identity() - along) * (turning * overlap / r)) * stiffness;
        let mut terms: BTreeMap<u32, f64> = BTreeMap::new();
        for (disc, sign) in [(i, 1.0), (j, -1.0)] {
            for (f, v) in discs[disc].functions.iter().zip(&discs[disc].values) {
                *terms.entry(*f).or_insert(0.0) += sign * v;
            }
        }
        let unknowns: Vec<u32> = terms.keys().flat_map(|f| (0..D as u32).map(move |k| D as u32 * f + k)).collect();
        let values: Vec<f64> = terms.values().copied().collect();
        let n = unknowns.len();
        let matrix = DMatrix::from_fn(n, n, |a, b| values[a / D] * values[b / D] * local[(a % D, b % D)]);
        (unknowns, matrix.as_slice().to_vec())
    }
}

fn centres<const D: usize>(discs: &[Tabulated<D>], u: &[f64]) -> Vec<Point<D>> {
    discs.iter().map(|d| d.start + d.displacement(u)).collect()
}

/// Pairs that overlap, with the overlap: by a grid of boxes of the diameter of a disc.
fn touching<const D: usize>(discs: &[Tabulated<D>], now: &[Point<D>], radius: f64) -> Vec<(usize, usize, f64)> {
    let place = |x: &Point<D>| -> [i64; D] { std::array::from_fn(|k| (x[k] / (2.0 * radius)).floor() as i64) };
    let mut boxes: BTreeMap<[i64; D], Vec<usize>> = BTreeMap::new();
    now.iter().enumerate().for_each(|(i, x)| boxes.entry(place(x)).or_default().push(i));
    let mut out = Vec::new();
    for (i, x) in now.iter().enumerate() {
        let at = place(x);
        for neighbour in 0..3usize.pow(D as u32) {
            let key = std::array::from_fn(|k| at[k] + (neighbour / 3usize.pow(k as u32) % 3) as i64 - 1);
            for &j in boxes.get(&key).into_iter().flatten().filter(|j| **j > i) {
                let overlap = 2.0 * radius - (x - now[j]).norm();
                let faces = discs[i].site.normal.dot(&discs[j].site.normal) <= SAME_FACE;
                let apart = (discs[i].start - discs[j].start).norm() >= 2.0 * radius;
                if overlap > 0.0 && faces && apart {
                    out.push((i, j, overlap));
                }
            }
        }
    }
    out.sort_by_key(|p| (p.0, p.1));
    out
}

/// Points spread evenly. Each takes the weight of those nearest to it on its face. Also the largest distance between
/// neighbours.
fn spread<const D: usize>(sites: &[Site<D>], spacing: f64) -> (Vec<Site<D>>, f64) {
    let (chosen, nearest, far) = farthest_points(sites, &vec![spacing; sites.len()]);
    let mut out: Vec<Site<D>> = chosen.iter().map(|c| Site { weight: 0.0, ..sites[*c] }).collect();
    sites.iter().zip(&nearest).for_each(|(s, n)| out[*n].weight += s.weight);
    (out, (2.0 * far * spacing).max(spacing))
}

/// Points chosen of some that lie on a boundary: again and again the one farthest from all chosen before on its face, until
/// none is as far as its spacing. Gives the chosen ones, for each point the place of the nearest among them, and the
/// largest distance that is left, in spacings.
pub(crate) fn farthest_points<const D: usize>(sites: &[Site<D>], spacing: &[f64]) -> (Vec<usize>, Vec<usize>, f64) {
    let distance = |i: usize, j: usize| {
        let [a, b] = [&sites[i], &sites[j]];
        if a.normal.dot(&b.normal) <= SAME_FACE { f64::INFINITY } else { (a.x - b.x).norm() / spacing[i] }
    };
    let widest = spacing.iter().fold(0.0f64, |m, s| m.max(*s));
    let mut chosen = vec![0];
    let mut nearest: Vec<(f64, usize)> = (0..sites.len()).map(|i| (distance(i, 0), 0)).collect();
    // The farthest first, of several the one with the lowest number; entries that are out of date are passed over. Distances
    // are not negative, so that their bits are in their order.
    let entry = |i: usize, d: f64| (d.to_bits(), Reverse(i));
    let mut queue: BinaryHeap<(u64, Reverse<usize>)> = nearest.iter().enumerate().map(|(i, n)| entry(i, n.0)).collect();
    let mut boxes: Option<Boxes<D>> = None;
    while let Some((bits, Reverse(at))) = queue.pop() {
        let far = nearest[at].0;
        if far.to_bits() != bits {
            continue;
        }
        if far < 1.0 {
            return (chosen, nearest.into_iter().map(|n| n.1).collect(), far);
        }
        let number = chosen.len();
        chosen.push(at);
        let mut take = |i: usize| {
            let d = distance(i, at);
            if d < nearest[i].0 {
                nearest[i] = (d, number);
                queue.push(entry(i, d));
            }
        };
        // Only what lies nearer than the farthest can come nearer.
        let reach = far * widest;
        if !reach.is_finite() {
            (0..sites.len()).for_each(take);
            continue;
        }
        let around = match boxes.take() {
            Some(boxes) if boxes.edge < 2.0 * reach => boxes,
            _ => Boxes::new(sites, reach),
        };
        around.visit(&sites[at].x, &mut take);
        boxes = Some(around);
    }
    (chosen, nearest.into_iter().map(|n| n.1).collect(), 0.0)
}

/// Points in boxes of a grid.
struct Boxes<const D: usize> {
    edge: f64,
    list: BTreeMap<[i64; D], Vec<u32>>,
}

impl<const D: usize> Boxes<D> {
    fn new(sites: &[Site<D>], edge: f64) -> Self {
        let mut out = Boxes { edge, list: BTreeMap::new() };
        for (i, site) in sites.iter().enumerate() {
            let place = out.place(&site.x);
            out.list.entry(place).or_default().push(i as u32);
        }
        out
    }

    fn place(&self, x: &Point<D>) -> [i64; D] {
        std::array::from_fn(|k| (x[k] / self.edge).floor() as i64)
    }

    /// All points that are nearer than an edge, and some more.
    fn visit(&self, x: &Point<D>, take: &mut dyn FnMut(usize)) {
        let at = self.place(x);
        for neighbour in 0..3usize.pow(D as u32) {
            let key: [i64; D] = std::array::from_fn(|k| at[k] + (neighbour / 3usize.pow(k as u32) % 3) as i64 - 1);
            self.list.get(&key).into_iter().flatten().for_each(|i| take(*i as usize));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against choosing by looking at all points each time.
    #[test]
    fn the_farthest_points_are_the_farthest() {
        let sites: Vec<Site<2>> = (0..400)
            .map(|k| {
                let t = k as f64 * 0.618_033_988_749_895 % 1.0 * std::f64::consts::TAU;
                let normal = Vector::<2>::new(t.cos(), t.sin());
                Site { cell: 0, x: Point::from(normal * (1.0 + 0.1 * (3.0 * t).sin())), weight: 1.0, normal }
            })
            .collect();
        let spacing: Vec<f64> = (0..400).map(|k| 0.1 + 0.05 * f64::from(k % 3)).collect();
        let (chosen, nearest, far) = farthest_points(&sites, &spacing);
        let distance = |i: usize, j: usize| {
            let [a, b] = [&sites[i], &sites[j]];
            if a.normal.dot(&b.normal) <= SAME_FACE { f64::INFINITY } else { (a.x - b.x).norm() / spacing[i] }
        };
        let least = |i: usize, some: &[usize]| {
            some.iter().enumerate().fold((f64::INFINITY, 0), |best, (n, c)| {
                if distance(i, *c) < best.0 { (distance(i, *c), n) } else { best }
            })
        };
        for number in 1..chosen.len() {
            let all = (0..400).map(|i| least(i, &chosen[..number]).0);
            let (at, most) = all.enumerate().fold((0, 0.0), |best, (i, d)| if d > best.1 { (i, d) } else { best });
            assert!(chosen[number] == at && most >= 1.0, "{number}: {} {at}", chosen[number]);
        }
        assert!((0..400).all(|i| nearest[i] == least(i, &chosen).1));
        assert!((0..400).all(|i| least(i, &chosen).0 <= far) && far < 1.0);
    }
}
