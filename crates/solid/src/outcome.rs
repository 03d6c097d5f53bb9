//! The forces and results of a solution that was found.

use crate::contact::{Contact, ContactResult, PressureNode};
use crate::friction::friction_result;
use crate::friction::statement::{FrictionAt, Rubbing};
use crate::model::Model;
use crate::state::{Found, State};
use signorini_contact::{ContactZone, NodeState, recovered, zone};
use signorini_geometry::Point;

impl<const D: usize> Model<D> {
    /// Forces and results of a solution. `ends` are the ends of the rows of each contact.
    pub(crate) fn state(&self, found: Found, load: &[f64], ends: &[usize]) -> State<D> {
        let u = found.u;
        let mut forces = self.stiffness.multiply(&u);
        let energy = 0.5 * forces.iter().zip(&u).map(|(f, u)| f * u).sum::<f64>();
        let mut results = Vec::new();
        let mut first = 0;
        let mut contact_force = vec![0.0; forces.len()];
        for (contact, &end) in self.contacts.iter().zip(ends) {
            let rows = first..end;
            let (pressure, gap, active) =
                (&found.pressure[rows.clone()], &found.gap[rows.clone()], &found.active[rows.clone()]);
            first = end;
            // With Nitsche's method rows hold the stress too.
            let bare: Vec<f64> = contact.bare.iter().map(|row| row.at(&u)).collect();
            let gap = if contact.bare.is_empty() { gap } else { &bare };
            let rubbing = found.rubbing.as_ref().map(|f| f.of(rows.clone()));
            results.push(result(contact, pressure, gap, active, rubbing, &mut contact_force));
        }
        if let Some(added) = &self.added {
            contact_force.iter_mut().zip(added.multiply(&u)).for_each(|(f, a)| *f -= a);
        }
        for ((force, load), contact) in forces.iter_mut().zip(load).zip(&contact_force) {
            *force -= load + contact;
        }
        // What is left are the reactions, and nothing on free unknowns.
        let unbalanced = self.reduction.restrict(&forces);
        let scale = forces.iter().chain(&contact_force).chain(load).fold(f64::MIN_POSITIVE, |m, f| m.max(f.abs()));
        // Where no force acts what is left is the rounding of the displacement.
        let moved = u.iter().fold(0.0f64, |m, u| m.max(u.abs()));
        let scale = scale.max(1e-8 * self.stiffness.largest() * moved);
        let imbalance = unbalanced.iter().fold(0.0f64, |m, f| m.max(f.abs())) / scale;
        let support_forces = self.support_forces(&forces, &u);
        State {
            u,
            contacts: results,
            iterations: found.iterations,
            route: found.route,
            residuals: found.residuals,
            support_forces,
            imbalance,
            energy,
            unknowns: self.reduction.unknowns,
            unstable: found.rubbing.is_some_and(|f| f.unstable),
        }
    }
}

/// The result of a contact; its forces are added to those on the unknowns.
fn result<const D: usize>(
    contact: &Contact<D>,
    pressures: &[f64],
    gaps: &[f64],
    actives: &[bool],
    rubbing: Option<&[FrictionAt]>,
    contact_force: &mut [f64],
) -> ContactResult<D> {
    let mut result = ContactResult::<D> {
        nodes: Vec::new(),
        force: Point::<D>::zeros(),
        area: 0.0,
        zone: ContactZone::default(),
        friction: None,
    };
    // With friction a row has a pressure and tractions along its tangents.
    let rubbing = rubbing.filter(|_| contact.friction.is_some());
    let of_rows: Vec<Rubbing<D>> = (rubbing.iter().flat_map(|found| found.iter().enumerate()))
        .map(|(k, found)| contact.rubbing(k, pressures[k], found))
        .collect();
    let mut of_friction = vec![0.0; if rubbing.is_some() { contact_force.len() } else { 0 }];
    let mut own = vec![0.0; contact_force.len()];
    let body = contact.slave.body();
    let directions = body.directions();
    // On the slave, of each row.
    let mut forces = vec![Point::<D>::zeros(); contact.rows.len()];
    for (k, row) in contact.rows.iter().enumerate() {
        for (unknown, c) in row.push() {
            own[*unknown as usize] += c * pressures[k];
            let of_slave = (*unknown as usize).checked_sub(body.first).and_then(|n| *directions.get(n)?);
            if let Some(direction) = of_slave {
                forces[k][direction] += c * pressures[k];
            }
        }
        if let Some(found) = rubbing.map(|f| &f[k]) {
            for (slip, t) in contact.slips.rows[k].rows.iter().zip(&found.traction) {
                for (unknown, c) in slip.push() {
                    own[*unknown as usize] += c * t;
                    of_friction[*unknown as usize] += c * t;
                    let of_slave = (*unknown as usize).checked_sub(body.first).and_then(|n| *directions.get(n)?);
                    if let Some(direction) = of_slave {
                        forces[k][direction] += c * t;
                    }
                }
            }
        }
        if !contact.at_points() {
            result.nodes.push(PressureNode {
                x: contact.nodes.positions[row.node as usize],
                multiplier: pressures[k],
                pressure: pressures[k],
                force: forces[k],
                gap: gaps[k] / row.weight,
                active: actives[k],
                weight: row.weight,
                number: row.node,
                rubbing: of_rows.get(k).copied().unwrap_or_default(),
            });
        }
    }
    result.force = body.resultant(&own);
    contact_force.iter_mut().zip(&own).for_each(|(sum, f)| *sum += f);
    if contact.at_points() {
        result.nodes = contact.averaged(pressures, &forces, gaps, actives);
        if rubbing.is_some() {
            contact.averaged_rubbing(&of_rows, &mut result.nodes);
        }
    }
    let count = contact.nodes.len();
    let (mut multiplier, mut active) = (vec![0.0; count], vec![false; count]);
    let mut states = vec![NodeState::Bare; count];
    let state_of = |n: &PressureNode<D>, gap| if n.active { NodeState::Active } else { NodeState::Open(gap) };
    result.nodes.iter().for_each(|n| states[n.number as usize] = state_of(n, Some(n.gap)));
    for given in &contact.given {
        // A node may have given its function on to one that gave its own away.
        let Some(to) = result.nodes.iter().find(|n| n.number == given.to).copied() else { continue };
        let x = contact.nodes().positions[given.from as usize];
        states[given.from as usize] = state_of(&to, None);
        result.nodes.push(PressureNode { x, weight: 0.0, force: Point::zeros(), number: given.from, ..to });
    }
    for node in &result.nodes {
        let k = node.number as usize;
        (multiplier[k], active[k]) = (node.multiplier, node.active);
    }
    let points = contact.pressed(pressures);
    let pressure = recovered(&contact.slave, &contact.nodes, &points, &multiplier, &active, &contact.given);
    result.zone = zone(&contact.slave, &contact.nodes, &points, &states);
    result.area = result.zone.face_area.iter().sum();
    if let Some(found) = rubbing {
        let sums = (body.resultant(&of_friction), result.area);
        result.friction = Some(friction_result(contact, &of_rows, found, sums));
    }
    for node in &mut result.nodes {
        node.pressure = pressure[node.number as usize];
        // As large a part of what is available as that of the multipliers.
        if let (Some(friction), true) = (&contact.friction, node.active) {
            node.rubbing.traction *= friction.law.gain(node.pressure, node.multiplier);
        }
    }
    result
}
