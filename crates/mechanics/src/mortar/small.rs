//! Small sliding, where it is chosen: what sees what is found with the bodies at rest, and gaps and slips are linear in the
//! displacements. Rigid masters are where they are at the time.

use super::Mortar;
use super::at_rest::{AtRest, SmallSliding};
use super::face_terms::{FaceTerms, Line, Wanted};
use super::measure::{Facing, Sides};
use super::measured::NodeMeasure;
use super::rigid;
use super::terms::NodeTractions;
use crate::body::{BodyState, PlaceError};
use crate::interaction::Bodies;
use signorini_contact::compress;
use std::collections::BTreeMap;
use std::sync::Arc;

impl SmallSliding {
    /// What is found at rest, and the measures of the nodes in a state.
    ///
    /// # Errors
    /// Bodies that cannot be tested or touched.
    pub fn found(&self, contact: &Mortar, at: Bodies<'_>) -> Result<(Arc<AtRest>, Vec<NodeMeasure>), PlaceError> {
        let at_rest = match self.at_rest.get() {
            Some(found) => Arc::clone(found),
            None => {
                let found = Arc::new(contact.at_rest(at)?);
                Arc::clone(self.at_rest.get_or_init(|| found))
            }
        };
        let parts = [&contact.slave, &contact.master];
        let now = parts.map(|part| &at.side(part).1.configuration[..]);
        let first = parts.map(|part| at.first[part.body]);
        let moved = |unknown: u32, of: [&[f64]; 2]| {
            let side = usize::from(!(first[0]..first[0] + now[0].len() as u32).contains(&unknown));
            of[side].get((unknown - first[side]) as usize).copied().unwrap_or(0.0)
        };
        let since = self.since.each_ref().map(Vec::as_slice);
        let mut measures = at_rest.measures.clone();
        for line in &at_rest.terms.gaps {
            let own = &mut measures[line.node as usize];
            if own.weight <= 0.0 {
                continue;
            }
            own.gap += line.entries.iter().map(|(u, d)| d * moved(*u, now)).sum::<f64>() / own.weight;
        }
        for line in &at_rest.terms.slips {
            let own = &mut measures[line.node as usize];
            if own.matched <= 0.0 {
                continue;
            }
            let change = line.entries.iter().map(|(u, d)| d * (moved(*u, now) - moved(*u, since))).sum::<f64>();
            own.slip[line.slot - 1] += change / own.matched;
        }
        Ok((at_rest, measures))
    }
}

/// The sums of lines of the same node and component.
fn summed(lines: impl Iterator<Item = Line>) -> Vec<Line> {
    let mut sums: BTreeMap<(u32, usize), Vec<(u32, f64)>> = BTreeMap::new();
    lines.for_each(|line| sums.entry((line.node, line.slot)).or_default().extend(line.entries));
    let summed = |((node, slot), mut entries)| {
        compress(&mut entries);
        Line { node, slot, entries }
    };
    sums.into_iter().map(summed).collect()
}

impl Mortar {
    fn at_rest(&self, at: Bodies<'_>) -> Result<AtRest, PlaceError> {
        let mut states = vec![BodyState::default(); at.states.len()];
        for part in [&self.slave, &self.master] {
            let (body, state) = at.side(part);
            states[part.body] = if body.is_rigid() { state.clone() } else { body.start() };
        }
        let sides = Sides::new(self, Bodies { states: &states, ..at })?;
        let measured = sides.measured(self);
        let count = self.whole.len();
        let carried = NodeTractions { contact: self, tractions: vec![[0.0; 3]; count], acts: vec![true; count] };
        let mut faces = Vec::new();
        match sides.facing() {
            Facing::Surfaces(surfaces) => {
                faces
                    .extend(measured.cover.points.iter().map(|points| surfaces.terms(&carried, points, Wanted::Lines)));
                let matched = self.matched.chunk_by(|a, b| a.face == b.face);
                faces.extend(matched.map(|list| surfaces.slips(&carried, list, true)));
            }
            Facing::OnRigid(sides) => {
                let points = measured.cover.points.iter().map(Vec::as_slice);
                let pairs = measured.pairs.iter().map(Vec::as_slice);
                faces.extend(points.zip(pairs).map(|of| sides.terms(&carried, of, Wanted::Lines)));
                let list = self.matched.iter().zip(&measured.matched);
                let list: Vec<_> = list.filter_map(|(m, pair)| Some((m, pair.as_ref()?))).collect();
                let of_faces = list.chunk_by(|a, b| a.0.face == b.0.face);
                faces.extend(of_faces.map(|list| rigid::slips(&carried, list, true)));
            }
        }
        let pushes = summed(faces.iter_mut().flat_map(|terms| std::mem::take(&mut terms.pushes)));
        let slips = summed(faces.iter_mut().flat_map(|terms| std::mem::take(&mut terms.slips)));
        // Along a normal that does not turn a gap varies as it opens.
        let gap = |line: &Line| {
            let entries = line.entries.iter().map(|(u, v)| (*u, -v)).collect();
            Line { entries, ..*line }
        };
        let gaps = pushes.iter().filter(|line| line.slot == 0).map(gap).collect();
        let terms = FaceTerms { pushes, gaps, slips, ..FaceTerms::default() };
        Ok(AtRest { measures: self.measures(&measured), measured: Arc::new(measured), terms })
    }

    /// Makes small sliding the choice: for bodies whose surfaces move by much less than their cells.
    pub fn slides_little(&mut self) {
        self.small = Some(SmallSliding::default());
        self.search.at_rest = true;
    }
}
