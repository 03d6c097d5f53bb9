//! The rows of bodies in contact with friction: their compliance, and the state at one time.

use super::ladder::{FrictionError, solve};
use super::newton::System;
use super::problem::{Friction, Node, Problem, RowCompliance};
use crate::compliance::{Compliance, Route, RowProducts};
use crate::law::{Projected, Status};
use crate::mortar::WeightedGap;
use crate::softness::{SPRINGS_LEFT, Softness, Spring};
use signorini_solve::SolveError;
use std::collections::BTreeMap;

/// Columns solved for at once.
const COLUMNS: usize = 32;

/// What is solved for.
#[derive(Clone, Copy)]
pub struct Bodies<'a> {
    /// The bodies, held by the springs.
    pub system: &'a dyn Compliance,
    /// Rows of gaps and slips, those of a node one after the other.
    pub rows: &'a [WeightedGap],
    pub soft: &'a [Softness],
    pub springs: &'a [Spring],
    pub load: &'a [f64],
}

/// Columns of the compliance, kept as long as the rows stay the same.
#[derive(Default)]
pub struct FrictionalContact {
    rows: Vec<[Vec<(u32, f64)>; 2]>,
    springs: Vec<Spring>,
    columns: BTreeMap<usize, Vec<f64>>,
    /// How the compliance is to be known; what costs less where nothing is said.
    pub route: Option<Route>,
}

/// What was found.
#[derive(Clone, Debug)]
pub struct FrictionState {
    /// Displacement of all unknowns.
    pub u: Vec<f64>,
    /// Tractions, and weighted gaps and slips, of all rows.
    pub traction: Vec<f64>,
    pub gap: Vec<f64>,
    /// Of every node.
    pub status: Vec<Status>,
    /// Solves of the dense system.
    pub iterations: usize,
    /// The step of the ladder that found it.
    pub level: usize,
    /// For every closed node the factor of all friction below which it has one state by itself for every load: `W_nn`
    /// over the most that friction per pressure does on `W_nt`. Infinite for open nodes.
    pub uniqueness: Vec<f64>,
    /// Whether the equilibrium is one that a disturbance leaves: the determinant of its equations has not the sign that
    /// it has without slip. Not looked at by products.
    pub unstable: bool,
    pub route: Route,
}

/// The compliance of the rows, and of the springs after them.
struct Rows<'a> {
    bodies: Bodies<'a>,
    columns: &'a mut BTreeMap<usize, Vec<f64>>,
    /// Gaps, slips and springs without tractions.
    free: Vec<f64>,
    /// The share of the springs that stays.
    left: f64,
    route: Option<Route>,
    /// In place of the columns, where these cost more.
    products: Option<RowProducts<'a>>,
}

impl Rows<'_> {
    fn product(&self, row: usize, u: &[f64]) -> f64 {
        match row.checked_sub(self.bodies.rows.len()) {
            None => self.bodies.rows[row].terms.iter().map(|(i, c)| c * u[*i as usize]).sum(),
            Some(spring) => u[self.bodies.springs[spring].unknown as usize],
        }
    }

    /// All rows at a displacement, without what they give way by themselves.
    fn at(&self, u: &[f64]) -> Vec<f64> {
        let gap = |r: usize| self.bodies.rows.get(r).map_or(0.0, |row| row.gap);
        (0..self.rows()).map(|r| gap(r) + self.product(r, u)).collect()
    }

    /// How rows give way by themselves under tractions.
    fn give(&self, y: &mut [f64], z: &[f64]) {
        for (r, soft) in self.bodies.soft.iter().enumerate().filter(|(_, s)| s.compliance > 0.0) {
            y[r] += soft.compliance * (z[r] - soft.shift);
        }
        for s in self.bodies.rows.len()..z.len() {
            y[s] += self.own(s) * z[s];
        }
    }
}

impl RowCompliance for Rows<'_> {
    fn rows(&self) -> usize {
        self.bodies.rows.len() + self.bodies.springs.len()
    }

    fn require(&mut self, rows: &[usize]) -> Result<(), SolveError> {
        let Bodies { system, rows: list, springs, .. } = self.bodies;
        let cheaper = || Route::cheaper(rows.len(), self.rows(), system.entries());
        if self.products.is_none() && self.route.unwrap_or_else(cheaper) == Route::Products {
            self.products = Some(RowProducts::new(system, list, springs)?);
        }
        if let Some(products) = &self.products {
            products.require(rows.iter().copied());
            return Ok(());
        }
        let mut missing: Vec<usize> = rows.iter().copied().filter(|r| !self.columns.contains_key(r)).collect();
        missing.sort_unstable();
        missing.dedup();
        let n = system.size();
        let (of_rows, of_springs): (Vec<usize>, Vec<usize>) = missing.into_iter().partition(|r| *r < list.len());
        for chunk in of_rows.chunks(COLUMNS) {
            let mut b = vec![0.0; n * chunk.len()];
            for (column, &r) in b.chunks_mut(n).zip(chunk) {
                list[r].push().iter().for_each(|(i, c)| column[*i as usize] += c);
            }
            system.solve_columns(&mut b)?;
            for (u, &r) in b.chunks(n).zip(chunk) {
                let column = (0..self.rows()).map(|k| self.product(k, u)).collect();
                self.columns.insert(r, column);
            }
        }
        for r in of_springs {
            // What a spring moves is nearly rigid: only to the last digit does it tell what holds the body.
            let mut unit = vec![0.0; n];
            unit[springs[r - list.len()].unknown as usize] = 1.0;
            let u = system.solve_accurately(&unit)?;
            let column = (0..self.rows()).map(|k| self.product(k, &u)).collect();
            self.columns.insert(r, column);
        }
        Ok(())
    }

    fn column(&self, column: usize) -> &[f64] {
        &self.columns[&column]
    }

    fn products(&self) -> Option<&RowProducts<'_>> {
        self.products.as_ref()
    }

    fn entry(&self, row: usize, column: usize) -> f64 {
        let own = if row == column { self.own(row) } else { 0.0 };
        let between = match &self.products {
            None => self.column(column)[row],
            Some(_) if row.max(column) >= self.bodies.rows.len() => {
                self.products.as_ref().map_or(0.0, |p| p.spring_entry(row, column))
            }
            Some(products) if row == column => products.own(row),
            Some(products) => products.near(row, column),
        };
        between + own
    }

    fn own(&self, row: usize) -> f64 {
        match row.checked_sub(self.bodies.rows.len()) {
            None => self.bodies.soft[row].compliance,
            Some(spring) => -1.0 / (self.bodies.springs[spring].stiffness * (1.0 - self.left)),
        }
    }

    fn values(&self, z: &[f64]) -> Result<Vec<f64>, SolveError> {
        let mut y = self.free.clone();
        if let Some(products) = &self.products {
            y.iter_mut().zip(products.product(z)?).for_each(|(y, w)| *y += w);
            self.give(&mut y, z);
            return Ok(y);
        }
        for (r, t) in z.iter().enumerate().filter(|(_, t)| **t != 0.0) {
            y.iter_mut().zip(&self.columns[&r]).for_each(|(y, w)| *y += t * w);
        }
        self.give(&mut y, z);
        Ok(y)
    }

    fn scale(&self, row: usize) -> f64 {
        match row.checked_sub(self.bodies.rows.len()) {
            None => 1.0 / self.entry(row, row).abs().sqrt(),
            Some(spring) => self.bodies.springs[spring].stiffness.sqrt(),
        }
    }
}

impl FrictionalContact {
    /// Finds the tractions of all rows, from those of the last state; springs hold bodies until contact does.
    ///
    /// `report` gets the number of solves and how many nodes changed; it returns whether to go on.
    ///
    /// # Errors
    /// Nothing found.
    pub fn solve(
        &mut self,
        bodies: Bodies<'_>,
        nodes: &[Node<'_>],
        last: &[f64],
        report: &mut dyn FnMut(usize, usize) -> bool,
    ) -> Result<FrictionState, FrictionError> {
        self.refresh(bodies.rows, bodies.springs);
        let Bodies { system, rows, springs, load, .. } = bodies;
        let free = system.solve_accurately(load)?;
        let mut w =
            Rows { bodies, columns: &mut self.columns, free: Vec::new(), left: 0.0, route: self.route, products: None };
        w.free = w.at(&free);
        let springs: Vec<usize> = (rows.len()..rows.len() + springs.len()).collect();
        let problem = Problem { nodes, equations: &springs };
        let mut start = last.to_vec();
        start.resize(rows.len() + springs.len(), 0.0);
        let mut spent = 0;
        let mut count = |offset: usize, solves: usize, changed: usize| report(offset + solves, changed);
        let mut found = solve(&problem, &mut w, &start, &mut |s, c| count(0, s, c));
        if !springs.is_empty() {
            // States with less and less of the springs, as without friction.
            for left in SPRINGS_LEFT {
                match &found {
                    Err(FrictionError::Singular | FrictionError::NotFound { .. }) => {}
                    _ => break,
                }
                w.left = left;
                let held = Problem { nodes, equations: if left < 1.0 { &springs } else { &[] } };
                start[rows.len()..].fill(0.0);
                if let Ok(near) = solve(&held, &mut w, &start, &mut |s, c| count(spent, s, c)) {
                    spent += near.solves;
                    start = near.z;
                }
                w.left = 0.0;
                let again = solve(&problem, &mut w, &start, &mut |s, c| count(spent, s, c));
                // What is told in the end is why there was nothing from the start.
                if again.is_ok() || matches!(again, Err(FrictionError::Interrupted)) {
                    found = again;
                }
            }
        }
        let mut found = found?;
        found.solves += spent;
        // What closed gaps and sticking slips still lack by the round-off of the columns is made good.
        let mut z = found.z;
        let mut out = FrictionState {
            u: Vec::new(),
            traction: Vec::new(),
            gap: Vec::new(),
            status: found.answers.iter().map(|a| a.status).collect(),
            iterations: found.solves,
            level: found.level,
            uniqueness: uniqueness(nodes, &w, &found.answers)?,
            unstable: false,
            route: if w.products.is_some() { Route::Products } else { Route::Columns },
        };
        let carries = z.iter().any(|z| *z != 0.0);
        for round in 0..2 {
            let mut b = load.to_vec();
            for (row, t) in rows.iter().zip(&z).filter(|(_, t)| **t != 0.0) {
                row.push().iter().for_each(|(i, c)| b[*i as usize] += c * t);
            }
            for (spring, force) in bodies.springs.iter().zip(&z[rows.len()..]) {
                b[spring.unknown as usize] += force;
            }
            out.u = system.solve_accurately(&b)?;
            out.gap = w.at(&out.u);
            if round == 1 || !carries {
                break;
            }
            let mut y = out.gap.clone();
            w.give(&mut y, &z);
            let residual = problem.residual(&mut w, Friction::Law, (&z, &y), 1.0)?;
            let equations = System::new(&problem, &w, Friction::Law, &residual);
            // Without slip every spring that is taken away makes a negative pivot.
            let stuck = if springs.len().is_multiple_of(2) { 1.0 } else { -1.0 };
            out.unstable = equations.determinant_sign().is_some_and(|sign| sign * stuck < 0.0);
            out.status = residual.answers.iter().map(|a| a.status).collect();
            let Some(step) = equations.step(&problem, &w, &residual, (&z, &y))? else { break };
            z.iter_mut().zip(&step).for_each(|(z, s)| *z += s);
        }
        for (node, status) in nodes.iter().zip(&out.status) {
            let first = node.first;
            if *status != Status::Open {
                out.gap[first] = bodies.soft[first].compliance * (bodies.soft[first].shift - z[first]);
            }
            if *status == Status::Stick {
                for r in node.rows().skip(1) {
                    out.gap[r] = bodies.soft[r].compliance * (bodies.soft[r].shift - z[r]);
                }
            }
        }
        out.gap.truncate(rows.len());
        z.truncate(rows.len());
        out.traction = z;
        Ok(out)
    }

    /// Forgets columns of other rows.
    fn refresh(&mut self, rows: &[WeightedGap], springs: &[Spring]) {
        let same = self.rows.len() == rows.len()
            && self.springs == springs
            && self.rows.iter().zip(rows).all(|(a, b)| a[0] == b.terms && a[1] == b.forces);
        if !same {
            self.columns.clear();
            self.rows = rows.iter().map(|r| [r.terms.clone(), r.forces.clone()]).collect();
            self.springs = springs.to_vec();
        }
    }
}

/// Nodes of which the uniqueness is found exactly by products, one solve each: those where the nearest unknowns say that it
/// is least. What they say was seen to be off by a factor of two, so that the least of all nodes may be another one.
const EXACT: usize = 32;

/// The factor of all friction below which each closed node by itself has one state for every load; by products of the nodes
/// where it is least, about.
fn uniqueness(nodes: &[Node<'_>], w: &Rows<'_>, answers: &[Projected]) -> Result<Vec<f64>, SolveError> {
    let of = |k: usize, entry: &dyn Fn(usize) -> f64| {
        let node = &nodes[k];
        let law = node.law.filter(|_| answers[k].status != Status::Open)?;
        let mut along = [0.0; 2];
        for (row, v) in node.rows().skip(1).zip(&node.directions) {
            let coupled = entry(row);
            along = [along[0] + coupled * v[0], along[1] + coupled * v[1]];
        }
        let coupling = law.coupling(along);
        (coupling > 0.0).then(|| entry(node.first) / coupling)
    };
    let about: Vec<f64> =
        (0..nodes.len()).map(|k| of(k, &|row| w.entry(nodes[k].first, row)).unwrap_or(f64::INFINITY)).collect();
    let Some(products) = &w.products else { return Ok(about) };
    let mut least: Vec<usize> = (0..nodes.len()).filter(|&k| about[k].is_finite()).collect();
    least.sort_by(|&a, &b| about[a].total_cmp(&about[b]).then(a.cmp(&b)));
    let mut out = vec![f64::INFINITY; nodes.len()];
    for &k in least.iter().take(EXACT) {
        let column = products.column(nodes[k].first)?;
        let own = |row: usize| column[row] + if row == nodes[k].first { w.own(row) } else { 0.0 };
        out[k] = of(k, &own).unwrap_or(f64::INFINITY);
    }
    Ok(out)
}
