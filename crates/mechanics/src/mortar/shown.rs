//! What the nodes of a mortar contact show beside the tractions that they carry: the recovered pressure, and the area in
//! contact, which ends within faces.

use super::cover::Nodes;
use super::measured::Measured;
use crate::shown_surface::SharedSite;
use crate::site_result::{OfSurface, SiteResult};
use crate::surface::Faces;
use signorini_contact::{
    ContactSurface, ContactZone, Law, MergedNode, NodeState, Pressed, PressureNodes, Status, connected, recovered, zone,
};

/// Completes the results of the nodes.
pub(super) fn show(
    nodes: &Nodes,
    faces: Faces<'_>,
    points: &Measured,
    law: Option<&dyn Law>,
    results: &mut [SiteResult],
) {
    match (nodes, faces) {
        (Nodes::Plane(nodes), Faces::Plane(faces)) => show_on(nodes, faces, points, law, results),
        (Nodes::Space(nodes), Faces::Space(faces)) => show_on(nodes, faces, points, law, results),
        _ => {}
    }
}

/// The zone of contact of nodes with these results.
pub(super) fn zone_of(nodes: &Nodes, faces: Faces<'_>, points: &Measured, results: &[SiteResult]) -> ContactZone {
    let Carrying { points, states, .. } = Carrying::new(points, results);
    match (nodes, faces) {
        (Nodes::Plane(nodes), Faces::Plane(faces)) => zone(faces, nodes, &points, &states),
        (Nodes::Space(nodes), Faces::Space(faces)) => zone(faces, nodes, &points, &states),
        _ => ContactZone::default(),
    }
}

/// The nodes that gave their function to another one, with their pressures.
pub(super) fn shared_of(nodes: &Nodes, faces: Faces<'_>, points: &Measured, results: &[SiteResult]) -> Vec<SharedSite> {
    let given = &points.cover.given;
    if given.is_empty() {
        return Vec::new();
    }
    let Carrying { points, multiplier, active, .. } = Carrying::new(points, results);
    let pressure = match (nodes, faces) {
        (Nodes::Plane(nodes), Faces::Plane(faces)) => recovered(faces, nodes, &points, &multiplier, &active, given),
        (Nodes::Space(nodes), Faces::Space(faces)) => recovered(faces, nodes, &points, &multiplier, &active, given),
        _ => return Vec::new(),
    };
    let shared = |g: &MergedNode| SharedSite {
        site: g.from,
        with: g.to,
        pressure: pressure[g.from as usize],
        weightless: g.weightless,
    };
    given.iter().map(shared).collect()
}

/// What carries: points and nodes of the slave side.
struct Carrying {
    points: Vec<Pressed>,
    multiplier: Vec<f64>,
    active: Vec<bool>,
    states: Vec<NodeState>,
    /// Where the area about a node without a function of its own counts.
    counts_at: Vec<usize>,
}

fn is_active(result: &SiteResult) -> bool {
    result.status != Status::Open
}

impl Carrying {
    fn new(measured: &Measured, results: &[SiteResult]) -> Self {
        let points = (measured.points())
            .map(|(point, _)| {
                let area = point.shares.iter().map(|(_, share)| share).sum();
                let force = point.shares.iter().map(|(node, share)| share * results[*node as usize].pressure).sum();
                Pressed { face: point.face, s: point.s, area, force }
            })
            .collect();
        let state = |r: &SiteResult| match r.gap {
            None => NodeState::Bare,
            Some(_) if is_active(r) => NodeState::Active,
            Some(gap) => NodeState::Open(Some(gap)),
        };
        let mut out = Carrying {
            points,
            multiplier: results.iter().map(|r| r.pressure).collect(),
            active: results.iter().map(is_active).collect(),
            states: results.iter().map(state).collect(),
            counts_at: (0..results.len()).collect(),
        };
        for given in &measured.cover.given {
            let [from, to] = [given.from as usize, given.to as usize];
            (out.multiplier[from], out.active[from], out.counts_at[from]) = (out.multiplier[to], out.active[to], to);
            out.states[from] =
                if let NodeState::Open(_) = out.states[to] { NodeState::Open(None) } else { out.states[to] };
        }
        out
    }
}

fn show_on<const D: usize>(
    nodes: &PressureNodes<D>,
    faces: &dyn ContactSurface<D>,
    measured: &Measured,
    law: Option<&dyn Law>,
    results: &mut [SiteResult],
) {
    let Carrying { points, multiplier, active, states, counts_at } = Carrying::new(measured, results);
    // What pulls is no pressure that could be recovered as one.
    let pressure = match law.is_some_and(|law| law.strength()[0] > 0.0) {
        true => multiplier,
        false => recovered(faces, nodes, &points, &multiplier, &active, &measured.cover.given),
    };
    let mut area = vec![0.0; results.len()];
    for (face, whole) in zone(faces, nodes, &points, &states).face_area.into_iter().enumerate() {
        let carrying: Vec<usize> =
            nodes.of_face(face).iter().map(|(k, _)| *k as usize).filter(|k| active[*k]).collect();
        carrying.iter().for_each(|k| area[counts_at[*k]] += whole / carrying.len() as f64);
    }
    let zones = connected(nodes, &active);
    // A node without a function of its own has a pressure too, as that on an axis, which may be the largest.
    for ((((result, pressure), area), zone), active) in
        results.iter_mut().zip(pressure).zip(area).zip(zones).zip(active)
    {
        result.of_surface = zone.filter(|_| active).map(|zone| {
            let gain = law.filter(|_| is_active(result)).map_or(1.0, |law| law.gain(pressure, result.pressure));
            OfSurface { pressure, friction: result.friction * gain, area, zone }
        });
    }
}
