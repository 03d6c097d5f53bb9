//! Small sliding, where it is chosen: what sees what is found with the bodies at rest, and gaps and slips are linear in the
//! displacements. Rigid masters are where they are at the time.

use super::Mortar;
use super::cover::Cover;
use super::measure::{Separation, Sides};
use crate::body::{BodyState, PlaceError};
use crate::interaction::Bodies;
use crate::pair::Pair;
use signorini_geometry::Vector;
use std::sync::{Arc, OnceLock};

/// The measures with the bodies at rest, and the displacements from which slips count.
#[derive(Default)]
pub(super) struct SmallSliding {
    /// Found when it is first asked for in an increment.
    at_rest: OnceLock<Arc<AtRest>>,
    /// Displacements of slave and master at the last state.
    pub since: [Vec<f64>; 2],
}

/// Both sides with deformable bodies at rest.
struct AtRest {
    cover: Cover,
    pairs: Vec<Vec<Option<Pair>>>,
    separations: Vec<Option<Separation>>,
    lost: usize,
}

/// What sees what, and its measures in a state.
pub(super) struct Measured {
    pub cover: Cover,
    pub pairs: Vec<Vec<Option<Pair>>>,
    pub separations: Vec<Option<Separation>>,
    pub lost: usize,
}

impl SmallSliding {
    /// Forgets what was found for another time, or before what follows from the last state changed.
    pub fn forget(&mut self) {
        self.at_rest = OnceLock::new();
    }
}

/// A pair whose gap varies as it opens, along a normal that does not turn: what moves the normal only is left out.
fn linear(pair: &Pair) -> Pair {
    let rubs = !pair.slip.is_empty();
    let counts = |k: &usize| pair.opening[*k] != 0.0 || (rubs && pair.slip[*k] != Vector::<3>::zeros());
    let kept: Vec<usize> = (0..pair.unknowns.len()).filter(counts).collect();
    let opening: Vec<f64> = kept.iter().map(|k| pair.opening[*k]).collect();
    let vectors = |list: &[Vector<3>]| kept.iter().filter_map(|k| list.get(*k).copied()).collect();
    let mut out = Pair::default();
    (out.gap, out.normal, out.point, out.stuck) = (pair.gap, pair.normal, pair.point, pair.stuck);
    out.unknowns = kept.iter().map(|k| pair.unknowns[*k]).collect();
    out.slip = vectors(&pair.slip);
    out.d_normal = if rubs { vec![Vector::<3>::zeros(); kept.len()] } else { Vec::new() };
    out.d_gap.clone_from(&opening);
    out.opening = opening;
    out
}

impl Mortar {
    /// What sees what in a state.
    pub(super) fn measured(&self, sides: &Sides<'_>, at: Bodies<'_>) -> Result<Measured, PlaceError> {
        let Some(small) = &self.small else {
            let cover = sides.cover(self);
            let (pairs, lost) = self.pairs(sides, &cover);
            let separations = if self.friction.is_some() { self.separations(sides) } else { Vec::new() };
            return Ok(Measured { cover, pairs, separations, lost });
        };
        let at_rest = match small.at_rest.get() {
            Some(found) => Arc::clone(found),
            None => Arc::clone(small.at_rest.get_or_init({
                let found = Arc::new(self.at_rest(at)?);
                move || found
            })),
        };
        let displacement = |side: usize| &at.side([&self.slave, &self.master][side]).1.configuration[..];
        let now = [displacement(0), displacement(1)];
        let first = sides.first;
        let moved = |unknown: u32, of: [&[f64]; 2]| {
            let side = usize::from(!(first[0]..first[0] + now[0].len() as u32).contains(&unknown));
            of[side].get((unknown - first[side]) as usize).copied().unwrap_or(0.0)
        };
        let mut pairs = at_rest.pairs.clone();
        for pair in pairs.iter_mut().flatten().flatten() {
            pair.gap += pair.unknowns.iter().zip(&pair.d_gap).map(|(u, d)| d * moved(*u, now)).sum::<f64>();
        }
        let mut separations = at_rest.separations.clone();
        let since = small.since.each_ref().map(Vec::as_slice);
        for apart in separations.iter_mut().flatten() {
            let change = |u: u32| moved(u, now) - moved(u, since);
            apart.vector += apart.unknowns.iter().zip(&apart.d_vector).map(|(u, d)| d * change(*u)).sum::<Vector<3>>();
        }
        Ok(Measured { cover: at_rest.cover.clone(), pairs, separations, lost: at_rest.lost })
    }

    fn at_rest(&self, at: Bodies<'_>) -> Result<AtRest, PlaceError> {
        let mut states = vec![BodyState::default(); at.states.len()];
        for part in [&self.slave, &self.master] {
            let (body, state) = at.side(part);
            states[part.body] = if body.is_rigid() { state.clone() } else { body.start() };
        }
        let sides = Sides::new(self, Bodies { states: &states, ..at })?;
        let cover = sides.cover(self);
        let (mut pairs, lost) = self.pairs(&sides, &cover);
        for pair in pairs.iter_mut().flatten().flatten() {
            *pair = linear(pair);
        }
        let mut separations = if self.friction.is_some() { self.separations(&sides) } else { Vec::new() };
        separations.iter_mut().flatten().for_each(|apart| apart.d_normal.fill(Vector::<3>::zeros()));
        Ok(AtRest { cover, pairs, separations, lost })
    }

    /// Makes small sliding the choice: for bodies whose surfaces move by much less than their cells.
    pub fn slides_little(&mut self) {
        self.small = Some(SmallSliding::default());
        self.search.at_rest = true;
    }
}
