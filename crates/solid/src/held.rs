//! Whether contact can hold the bodies that nothing else holds, before anything is solved for.

use crate::body::Bodies;
use crate::contact::{Contact, Master};
use crate::rigid_modes::FreeMode;
use crate::step_error::StepError;
use signorini_contact::{WeightedGap, unbalanced};
use signorini_geometry::Point;
use std::collections::HashMap;

/// Whether the contacts, as they were found last, can balance the loads on free motions.
pub(crate) fn check_held<const D: usize>(
    bodies: &Bodies<D>,
    contacts: &[Contact<D>],
    free: &[FreeMode],
    load: &[f64],
) -> Result<(), StepError> {
    let fields: Vec<&[(u32, f64)]> = free.iter().filter_map(|mode| mode.field.as_deref()).collect();
    if fields.is_empty() {
        return Ok(());
    }
    // Motions of each unknown that moves.
    let mut moving: HashMap<u32, Vec<(usize, f64)>> = HashMap::new();
    for (m, field) in fields.iter().enumerate() {
        field.iter().for_each(|(unknown, u)| moving.entry(*unknown).or_default().push((m, *u)));
    }
    let along = |row: &WeightedGap| {
        let mut along = vec![0.0; fields.len()];
        for (unknown, c) in &row.terms {
            moving.get(unknown).into_iter().flatten().for_each(|(m, u)| along[*m] += c * u);
        }
        along
    };
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for contact in contacts {
        let pressures = if contact.bare.is_empty() { &contact.rows } else { &contact.bare };
        for (k, row) in pressures.iter().enumerate() {
            let pressure = along(row);
            match &contact.friction {
                None => rows.push(pressure),
                Some(friction) => {
                    let slips: Vec<Vec<f64>> = contact.slips.rows[k].rows.iter().map(along).collect();
                    rows.extend(cone(friction.law.per_pressure(), pressure, &slips));
                }
            }
        }
    }
    let work = |field: &[(u32, f64)]| field.iter().map(|(i, u)| u * load[*i as usize]).sum::<f64>();
    let works: Vec<f64> = fields.iter().map(|field| work(field)).collect();
    // Work of loads that cancel is round-off.
    let sizes = fields.iter().map(|field| field.iter().map(|(i, u)| (u * load[*i as usize]).abs()).sum::<f64>());
    let way = unbalanced(&rows, &works, 1e-9 * sizes.fold(0.0, f64::max));
    let Some(most) = (0..way.len()).filter(|&m| way[m] != 0.0).max_by(|&a, &b| way[a].abs().total_cmp(&way[b].abs()))
    else {
        return Ok(());
    };
    let modes: Vec<&FreeMode> = free.iter().filter(|mode| mode.field.is_some()).collect();
    let body = &modes[most].body;
    let mut moved: HashMap<u32, f64> = HashMap::new();
    for m in (0..way.len()).filter(|&m| &modes[m].body == body) {
        fields[m].iter().for_each(|(unknown, u)| *moved.entry(*unknown).or_default() += way[m] * u);
    }
    let vertices = bodies.list.iter().filter(|b| &b.name == body).flat_map(|b| b.vertex_unknowns());
    let displacements: Vec<Point<D>> =
        vertices.map(|k| Point::<D>::from_fn(|i, _| moved.get(&((k + i) as u32)).copied().unwrap_or(0.0))).collect();
    let mean = displacements.iter().sum::<Point<D>>() / displacements.len().max(1) as f64;
    let largest = displacements.iter().map(|u| u.norm()).fold(0.0, f64::max);
    let direction = if mean.norm() > 0.5 * largest {
        let axis = mean.iamax();
        format!("along {}{}", if mean[axis] < 0.0 { "-" } else { "+" }, ["x", "y", "z"][axis])
    } else {
        "by turning".to_string()
    };
    let (body, loads) = (body.clone(), resultant_on(bodies, body, load));
    match friction_lacks(contacts, &body, &loads) {
        Some((demanded, available)) => Err(StepError::Slides { body, direction, demanded, available }),
        None => Err(StepError::PulledAway { body, direction }),
    }
}

/// Directions of friction on a surface in space that stand for all: the polygon around them is half a per cent larger.
const DIRECTIONS: usize = 32;

/// What a row can push with: pressure and friction together. Where friction is not in proportion to the pressure its limit
/// is left to the solution.
fn cone(per_pressure: Option<[f64; 2]>, pressure: Vec<f64>, slips: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let with = |t: &[f64]| -> Vec<f64> {
        let friction = |m: usize| slips.iter().zip(t).map(|(s, t)| s[m] * t).sum::<f64>();
        pressure.iter().enumerate().map(|(m, p)| p + friction(m)).collect()
    };
    match (per_pressure, slips) {
        (Some(mu), [_]) => vec![with(&[mu[0]]), with(&[-mu[0]])],
        (Some(mu), _) => {
            let outside = 1.0 / (std::f64::consts::PI / DIRECTIONS as f64).cos();
            let angles = (0..DIRECTIONS).map(|k| std::f64::consts::TAU * k as f64 / DIRECTIONS as f64);
            angles.map(|a| with(&[outside * mu[0] * a.cos(), outside * mu[1] * a.sin()])).collect()
        }
        (None, _) => {
            let both = slips.iter().flat_map(|s| [s.clone(), s.iter().map(|v| -v).collect()]);
            both.chain([pressure]).collect()
        }
    }
}

fn resultant_on<const D: usize>(bodies: &Bodies<D>, name: &str, load: &[f64]) -> Point<D> {
    bodies.list.iter().filter(|b| b.name == name).map(|b| b.resultant(load)).sum()
}

/// The friction that the loads on a body ask for where it is pressed on, and the most that there is; none where no contact
/// with friction presses on it.
fn friction_lacks<const D: usize>(contacts: &[Contact<D>], name: &str, loads: &Point<D>) -> Option<(f64, f64)> {
    for contact in contacts {
        let Some(friction) = &contact.friction else { continue };
        let body = contact.slave.body();
        let master = if let Master::Surface(surface) = &contact.master { Some(surface.body()) } else { None };
        let Some(own) = [Some(body), master].into_iter().flatten().find(|b| b.name == name) else { continue };
        // What a pressure and a friction of one everywhere come to on the body.
        let pushed = |rows: &mut dyn Iterator<Item = &WeightedGap>| {
            let mut forces = vec![0.0; own.first + own.unknowns()];
            for (unknown, c) in rows.flat_map(|row| row.push()) {
                if let Some(force) = forces.get_mut(*unknown as usize) {
                    *force += c;
                }
            }
            own.resultant(&forces)
        };
        let normal = pushed(&mut contact.rows.iter()).normalize();
        let axes: Vec<Point<D>> = (0..D - 1)
            .map(|a| pushed(&mut contact.slips.rows.iter().map(|s| &s.rows[a])))
            .map(|e| e.normalize())
            .collect();
        let pressed = -loads.dot(&normal);
        let along: Vec<f64> = axes.iter().map(|e| e.dot(loads)).collect();
        let along = [along[0], along.get(1).copied().unwrap_or(0.0)];
        let demanded = along[0].hypot(along[1]);
        if pressed > 0.0 && demanded > 0.0 {
            return Some((demanded, demanded / friction.law.utilisation(along, pressed)));
        }
    }
    None
}
