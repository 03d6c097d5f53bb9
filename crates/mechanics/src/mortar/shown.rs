//! What the nodes of a mortar contact show beside the tractions that they carry: the recovered pressure, and the area in
//! contact, which ends within faces.

use super::cover::{Cover, Nodes};
use crate::pair::Pair;
use crate::site_result::{OfSurface, SiteResult};
use crate::surface::Faces;
use signorini_contact::{ContactSurface, Law, NodeState, Pressed, PressureNodes, Status, connected, recovered, zone};

/// The points of the slave side, and of each what it met, face by face.
type Points<'a> = (&'a Cover, &'a [Vec<Option<Pair>>]);

/// Completes the results of the nodes.
pub(super) fn show(
    nodes: &Nodes,
    faces: Faces<'_>,
    points: Points<'_>,
    law: Option<&dyn Law>,
    results: &mut [SiteResult],
) {
    match (nodes, faces) {
        (Nodes::Plane(nodes), Faces::Plane(faces)) => show_on(nodes, faces, points, law, results),
        (Nodes::Space(nodes), Faces::Space(faces)) => show_on(nodes, faces, points, law, results),
        _ => {}
    }
}

fn show_on<const D: usize>(
    nodes: &PressureNodes<D>,
    faces: &dyn ContactSurface<D>,
    (cover, pairs): Points<'_>,
    law: Option<&dyn Law>,
    results: &mut [SiteResult],
) {
    let is_active = |r: &SiteResult| r.status != Status::Open;
    let points: Vec<Pressed> = (cover.points.iter().flatten().zip(pairs.iter().flatten()))
        .filter(|(_, pair)| pair.is_some())
        .map(|(point, _)| {
            let area = point.shares.iter().map(|(_, share)| share).sum();
            let force = point.shares.iter().map(|(node, share)| share * results[*node as usize].pressure).sum();
            Pressed { face: point.face, s: point.s, area, force }
        })
        .collect();
    let mut multiplier: Vec<f64> = results.iter().map(|r| r.pressure).collect();
    let mut active: Vec<bool> = results.iter().map(is_active).collect();
    let mut states: Vec<NodeState> = (results.iter())
        .map(|r| match r.gap {
            None => NodeState::Bare,
            Some(_) if is_active(r) => NodeState::Active,
            Some(gap) => NodeState::Open(Some(gap)),
        })
        .collect();
    // Where the area about a node without a function of its own counts.
    let mut counts_at: Vec<usize> = (0..results.len()).collect();
    for given in &cover.given {
        let [from, to] = [given.from as usize, given.to as usize];
        (multiplier[from], active[from], counts_at[from]) = (multiplier[to], active[to], to);
        states[from] = if let NodeState::Open(_) = states[to] { NodeState::Open(None) } else { states[to] };
    }
    let pressure = recovered(faces, nodes, &points, &multiplier, &active, &cover.given);
    let mut area = vec![0.0; results.len()];
    for (face, whole) in zone(faces, nodes, &points, &states).face_area.into_iter().enumerate() {
        let carrying: Vec<usize> =
            nodes.of_face(face).iter().map(|(k, _)| *k as usize).filter(|k| active[*k]).collect();
        carrying.iter().for_each(|k| area[counts_at[*k]] += whole / carrying.len() as f64);
    }
    let zones = connected(nodes, &active);
    for (((result, pressure), area), zone) in results.iter_mut().zip(pressure).zip(area).zip(zones) {
        result.of_surface = zone.filter(|_| is_active(result)).map(|zone| {
            let gain = law.map_or(1.0, |law| law.gain(pressure, result.pressure));
            OfSurface { pressure, friction: result.friction * gain, area, zone }
        });
    }
}
