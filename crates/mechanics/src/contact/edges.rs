//! Nodes at edges of the slave, which have a site on each smooth part of the surface: only what looks at the other body meets it.

use super::Contact;
use crate::body::{Body, BodyState};
use crate::met::MUCH_MORE;
use crate::points::{MasterProjection, Site, SlavePoint};
use signorini_geometry::Vector;
use std::collections::BTreeMap;

impl Contact {
    /// Whether a face beyond an edge of the slave looks at what a site meets much more than its own: along its own the gap would be
    /// measured aslant, and the node would carry twice.
    pub(super) fn is_met_beyond_an_edge(
        &self,
        k: usize,
        (body, state): (&dyn Body, &BodyState),
        (placed, met): (&SlavePoint, &MasterProjection),
    ) -> bool {
        let others = &self.beyond_edges[k];
        let (Some(own), false) = (placed.outward, others.is_empty()) else { return false };
        let Some(outward) = met.outward() else { return false };
        let looks = |normal: &Vector<3>| -normal.dot(&outward);
        others.iter().filter_map(|site| body.placed(state, site).outward).any(|n| looks(&n) > MUCH_MORE * looks(&own))
    }
}

/// The sites at the node of each site: a node at an edge has one on each smooth part of the surface.
pub(super) fn beyond_edges(sites: &[Site], placed: &[SlavePoint]) -> Vec<Vec<Site>> {
    // A node is moved by unknowns of its own.
    let mut at = BTreeMap::<Vec<u32>, Vec<usize>>::new();
    for (k, point) in placed.iter().enumerate().filter(|(_, point)| point.outward.is_some()) {
        at.entry(point.functions.iter().map(|f| f.unknown).collect()).or_default().push(k);
    }
    let mut out = vec![Vec::new(); sites.len()];
    for list in at.values().filter(|list| list.len() > 1) {
        for k in list {
            let same = |other: &&usize| *other != k && (placed[**other].x - placed[*k].x).norm() == 0.0;
            out[*k] = list.iter().filter(same).map(|other| sites[*other]).collect();
        }
    }
    out
}
