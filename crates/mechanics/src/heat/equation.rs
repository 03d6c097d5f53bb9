//! The equation of heat at one time: assembled, solved, and its flows.

use super::contacts::HeatSite;
use super::{Block, Blocks, ContactFlow, Equation, Heat, HeatError, HeatResult};
use crate::increment_error::IncrementError;
use crate::site_result::SiteResult;
use crate::system::{System, SystemState};
use signorini_geometry::sets::root;
use signorini_solve::cholesky::Symbolic;
use signorini_solve::{SolveError, SymmetricMatrix};

/// Flows relative to the largest that may be left: far above the rounding of a factorisation, far below what could be read off.
const UNBALANCED: f64 = 1e-8;
/// Difference of two prescribed temperatures, relative to their size, that is rounding.
const ROUNDING: f64 = 1e-9;

/// Who holds a coefficient.
#[derive(Clone, Copy, PartialEq)]
enum Holder {
    Support(usize),
    Known(usize),
}

/// The equation of heat of all bodies in a state.
struct Assembled {
    /// First coefficient of each body; none of bodies without temperature.
    first: Vec<Option<u32>>,
    count: usize,
    held: Vec<Option<(f64, Holder)>>,
    conduction: Blocks,
    films: Vec<Blocks>,
    /// Heat that loads bring whatever the temperature.
    loads: Vec<Vec<f64>>,
    contacts: Vec<Vec<HeatSite>>,
    /// `∫ ρ c N_a N_b / Δt`, and the temperatures before; none where nothing is stored.
    storage: Option<(Blocks, Vec<f64>)>,
}

impl System {
    /// The temperatures of all bodies that a state comes to in an increment from another one, the contacts as they are found in
    /// it; bodies without temperature have none.
    pub(super) fn solve_heat(
        &self,
        heat: &Heat,
        from: &SystemState,
        (state, sites): (&SystemState, &[Vec<SiteResult>]),
        time: f64,
    ) -> Result<(Vec<Vec<f64>>, HeatResult), IncrementError> {
        let at = self.assembled_heat(heat, from, (state, sites), time)?;
        let mut blocks: Blocks = at.conduction.clone();
        blocks.extend(at.films.iter().flatten().cloned());
        blocks.extend(at.storage.iter().flat_map(|(blocks, _)| blocks.iter().cloned()));
        let mut rhs = vec![0.0; at.count];
        at.loads.iter().for_each(|own| rhs.iter_mut().zip(own).for_each(|(r, q)| *r += q));
        if let Some((storage, before)) = &at.storage {
            add_product(storage, before, 1.0, &mut rhs);
        }
        for site in at.contacts.iter().flatten() {
            let [(slave, of_slave), (master, of_master)] = &site.sides;
            let terms: Vec<(u32, f64)> = slave.iter().copied().chain(master.iter().map(|(f, a)| (*f, -a))).collect();
            for (f, a) in &terms {
                rhs[*f as usize] -= site.conductance * a * (of_slave - of_master);
            }
            for ((side, _), q) in site.sides.iter().zip(site.friction) {
                side.iter().for_each(|(f, a)| rhs[*f as usize] += a * q);
            }
            if site.conductance > 0.0 {
                let unknowns = terms.iter().map(|t| t.0).collect();
                let value = |k: usize| site.conductance * terms[k / terms.len()].1 * terms[k % terms.len()].1;
                blocks.push((unknowns, (0..terms.len() * terms.len()).map(value).collect()));
            }
        }
        if at.storage.is_none() {
            self.check_floating(&at, &blocks)?;
        }
        let mut solution = rhs.clone();
        if at.held.iter().any(Option::is_none) {
            let mut matrix = SymmetricMatrix::of_cliques(at.count, &blocks);
            let held: Vec<Option<f64>> = at.held.iter().map(|h| h.map(|(value, _)| value)).collect();
            matrix.prescribe(&held, &mut rhs);
            let told = |e: SolveError| HeatError::Solve(e.to_string());
            let factor = Symbolic::default().factor(matrix).map_err(told)?;
            solution = factor.solve_accurately(&rhs).map_err(told)?;
        }
        at.held.iter().zip(&mut solution).for_each(|(held, t)| *t = held.map_or(*t, |(value, _)| value));
        let result = self.heat_flows(heat, &at, &solution, &blocks)?;
        let of_body = |k: usize| match (at.first[k], self.bodies[k].thermal()) {
            (Some(first), Some(body)) => solution[first as usize..first as usize + body.count()].to_vec(),
            _ => Vec::new(),
        };
        Ok(((0..self.bodies.len()).map(of_body).collect(), result))
    }

    fn assembled_heat(
        &self,
        heat: &Heat,
        from: &SystemState,
        (state, sites): (&SystemState, &[Vec<SiteResult>]),
        time: f64,
    ) -> Result<Assembled, IncrementError> {
        let mut count = 0;
        let first: Vec<Option<u32>> = (self.bodies.iter())
            .map(|body| {
                let own = body.thermal()?.count() as u32;
                count += own;
                Some(count - own)
            })
            .collect();
        let count = count as usize;
        let mut held: Vec<Option<(f64, Holder)>> = vec![None; count];
        for (body, field) in &heat.known {
            if let (Some(first), Some(thermal)) = (first[*body], self.bodies[*body].thermal()) {
                for (k, value) in thermal.coefficients(&|x| field(x, time)).into_iter().enumerate() {
                    held[first as usize + k] = Some((value, Holder::Known(*body)));
                }
            }
        }
        for (k, support) in heat.supports.iter().enumerate().filter(|(_, s)| s.holds_at(time)) {
            let body = support.part.body;
            let (Some(first), Some(thermal)) = (first[body], self.bodies[body].thermal()) else { continue };
            let list = thermal.held(support.part.group.as_deref(), &|x| (support.temperature)(x, time));
            for (f, value) in list.map_err(HeatError::from)? {
                let own = &mut held[(first + f) as usize];
                match own {
                    Some((other, by)) if (*other - value).abs() > ROUNDING * (other.abs() + value.abs()) => {
                        let first = match by {
                            Holder::Support(k) => heat.supports[*k].name.clone(),
                            Holder::Known(body) => self.bodies[*body].name().to_string(),
                        };
                        let (second, body) = (support.name.clone(), self.bodies[body].name().to_string());
                        return Err(HeatError::Contradiction { first, second, body }.into());
                    }
                    Some(_) => {}
                    None => *own = Some((value, Holder::Support(k))),
                }
            }
        }
        let shifted = |first: u32, block: &Block, factor: f64| -> Block {
            (block.0.iter().map(|f| f + first).collect(), block.1.iter().map(|v| factor * v).collect())
        };
        let (mut conduction, mut storage, mut before) = (Blocks::new(), Blocks::new(), vec![0.0; count]);
        let duration = time - from.time;
        for (k, body) in self.bodies.iter().enumerate() {
            let (Some(first), Some(thermal)) = (first[k], body.thermal()) else { continue };
            conduction.extend(thermal.conduction().iter().map(|block| shifted(first, block, 1.0)));
            before[first as usize..first as usize + thermal.count()]
                .copy_from_slice(thermal.temperature(&from.bodies[k]));
            if let Some(capacity) = thermal.capacity().filter(|_| duration > 0.0) {
                storage.extend(capacity.iter().map(|block| shifted(first, block, 1.0 / duration)));
            }
        }
        let stores = heat.equation == Equation::Transient;
        if stores && duration <= 0.0 {
            // At the start the temperatures are the initial ones.
            for (value, own) in before.iter().zip(&mut held) {
                own.get_or_insert((*value, Holder::Support(usize::MAX)));
            }
        }
        let (mut films, mut loads) = (Vec::new(), Vec::new());
        for load in &heat.loads {
            let (mut own, mut film) = (vec![0.0; count], Blocks::new());
            if let (Some(first), Some(thermal)) = (first[load.part.body], self.bodies[load.part.body].thermal()) {
                let range = first as usize..first as usize + thermal.count();
                let found = load.act(thermal, time, &mut own[range]).map_err(HeatError::from)?;
                film.extend(found.iter().map(|block| shifted(first, block, 1.0)));
            }
            films.push(film);
            loads.push(own);
        }
        let mut contacts = Vec::new();
        for (k, sites) in sites.iter().enumerate() {
            contacts.push(self.heat_sites(heat, k, (state, sites), (time, duration), &first)?);
        }
        let storage = (stores && duration > 0.0).then_some((storage, before));
        Ok(Assembled { first, count, held, conduction, films, loads, contacts, storage })
    }

    /// Whether a way of heat leads from each coefficient to one that is held, or to a fluid.
    fn check_floating(&self, at: &Assembled, blocks: &Blocks) -> Result<(), HeatError> {
        let mut parent: Vec<u32> = (0..at.count as u32).collect();
        for (functions, _) in blocks {
            for pair in functions.windows(2) {
                let [a, b] = [pair[0], pair[1]].map(|k| root(&mut parent, k));
                parent[a as usize] = b;
            }
        }
        let mut is_told = vec![false; at.count];
        let films = at.films.iter().flatten().filter(|(_, values)| values.iter().any(|v| *v != 0.0));
        let fluids = films.filter_map(|(functions, _)| functions.first().copied());
        // A rigid body of a contact has a temperature of its own.
        let rigid = (at.contacts.iter().flatten())
            .filter(|site| site.conductance > 0.0 && site.sides.iter().any(|(terms, _)| terms.is_empty()));
        let rigid = rigid.filter_map(|site| site.sides.iter().flat_map(|(terms, _)| terms).next().map(|t| t.0));
        let held = (0..at.count as u32).filter(|k| at.held[*k as usize].is_some());
        for k in fluids.chain(rigid).chain(held).collect::<Vec<_>>() {
            is_told[root(&mut parent, k) as usize] = true;
        }
        for (k, first) in at.first.iter().enumerate() {
            let (Some(first), Some(body)) = (first, self.bodies[k].thermal()) else { continue };
            let lost = (0..body.count() as u32).find(|f| !is_told[root(&mut parent, first + f) as usize]);
            if let Some(f) = lost {
                let places = self.bodies[k].places();
                let x = places.get(body.dimension() * f as usize).copied().unwrap_or_default();
                return Err(HeatError::Floating { body: self.bodies[k].name().to_string(), x });
            }
        }
        Ok(())
    }

    /// The flows at a solution, and whether they balance in every body.
    fn heat_flows(&self, heat: &Heat, at: &Assembled, t: &[f64], blocks: &Blocks) -> Result<HeatResult, HeatError> {
        let mut is_unity = vec![false; at.count];
        let mut body_of = vec![usize::MAX; at.count];
        for (k, first) in at.first.iter().enumerate() {
            let (Some(first), Some(body)) = (first, self.bodies[k].thermal()) else { continue };
            let range = *first as usize..*first as usize + body.count();
            is_unity[range.clone()].copy_from_slice(&body.unity());
            body_of[range].fill(k);
        }
        let mut balance = vec![0.0; self.bodies.len()];
        let sum = |list: &[f64]| list.iter().zip(&is_unity).filter(|(_, is)| **is).map(|(q, _)| q).sum::<f64>();
        let mut out = HeatResult { stored: vec![0.0; self.bodies.len()], ..HeatResult::default() };
        // What holders bring: all that the equation lacks where they hold.
        let mut lacking = vec![0.0; at.count];
        let mut sizes = vec![0.0; at.count];
        for (functions, values) in blocks {
            for (row, i) in values.chunks(functions.len().max(1)).zip(functions) {
                let terms = row.iter().zip(functions).map(|(v, j)| v * t[*j as usize]);
                sizes[*i as usize] += terms.clone().map(f64::abs).sum::<f64>();
                lacking[*i as usize] += terms.sum::<f64>();
            }
        }
        for (k, load) in at.loads.iter().enumerate() {
            let mut own = load.clone();
            add_product(&at.films[k], t, -1.0, &mut own);
            lacking.iter_mut().zip(load).for_each(|(r, q)| *r -= q);
            out.loads.push(sum(&own));
            balance[heat.loads[k].part.body] += sum(&own);
        }
        if let Some((storage, before)) = &at.storage {
            let mut own = vec![0.0; at.count];
            add_product(storage, t, 1.0, &mut own);
            let mut old = vec![0.0; at.count];
            add_product(storage, before, 1.0, &mut old);
            for f in 0..at.count {
                lacking[f] -= old[f];
                if is_unity[f] {
                    out.stored[body_of[f]] += own[f] - old[f];
                    balance[body_of[f]] -= own[f] - old[f];
                }
            }
        }
        for (k, sites) in at.contacts.iter().enumerate() {
            let mut flow = ContactFlow::default();
            for site in sites {
                let conducted = site.conductance * site.jump(t);
                flow.conducted += conducted;
                flow.friction += site.friction[0] + site.friction[1];
                flow.into[0] += site.friction[0] - conducted;
                flow.into[1] += site.friction[1] + conducted;
                let known = site.sides[0].1 - site.sides[1].1;
                for (side, sign) in [(0, 1.0), (1, -1.0)] {
                    for (f, a) in &site.sides[side].0 {
                        lacking[*f as usize] += a * (sign * site.conductance * known - site.friction[side]);
                    }
                }
            }
            let bodies = self.contacts[k].bodies();
            (0..2).for_each(|side| balance[bodies[side]] += flow.into[side]);
            out.contacts.push(flow);
        }
        out.supports = vec![0.0; heat.supports.len()];
        out.known = vec![0.0; self.bodies.len()];
        for f in (0..at.count).filter(|f| is_unity[*f]) {
            match at.held[f] {
                Some((_, Holder::Support(k))) if k < out.supports.len() => out.supports[k] += lacking[f],
                Some((_, Holder::Known(body))) => out.known[body] += lacking[f],
                _ => continue,
            }
            balance[body_of[f]] += lacking[f];
        }
        let lists = [&out.supports, &out.loads, &out.known, &out.stored];
        let passing = out.contacts.iter().flat_map(|c| c.into.into_iter().chain([c.conducted]));
        let largest = lists.into_iter().flatten().copied().chain(passing).fold(0.0f64, |m, q| m.max(q.abs()));
        // Where hardly any heat flows what is left is the rounding of temperatures.
        let rounding = f64::EPSILON * sizes.iter().sum::<f64>();
        let left = (at.first.iter().zip(&balance)).filter(|(first, _)| first.is_some());
        let left = left.fold(0.0f64, |m, (_, q)| m.max(q.abs()));
        out.imbalance = if left <= rounding { 0.0 } else { left / largest.max(f64::MIN_POSITIVE) };
        let is_start = heat.equation == Equation::Transient && at.storage.is_none();
        if !is_start && left > rounding / f64::EPSILON.sqrt() && out.imbalance > UNBALANCED || out.imbalance.is_nan() {
            return Err(HeatError::Imbalance { imbalance: out.imbalance });
        }
        Ok(out)
    }
}

/// Adds the product of blocks with a vector, times a factor.
fn add_product(blocks: &[Block], x: &[f64], factor: f64, out: &mut [f64]) {
    for (functions, values) in blocks {
        for (row, i) in values.chunks(functions.len().max(1)).zip(functions) {
            out[*i as usize] += factor * row.iter().zip(functions).map(|(v, j)| v * x[*j as usize]).sum::<f64>();
        }
    }
}
