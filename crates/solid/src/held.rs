//! Whether contact can hold the bodies that nothing else holds, before anything is solved for.

use crate::body::Bodies;
use crate::contact::Contact;
use crate::model::StepError;
use crate::rigid_modes::FreeMode;
use signorini_contact::unbalanced;
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
    let rows: Vec<Vec<f64>> = (contacts.iter().flat_map(|c| if c.bare.is_empty() { &c.rows } else { &c.bare }))
        .map(|row| {
            let mut along = vec![0.0; fields.len()];
            for (unknown, c) in &row.terms {
                moving.get(unknown).into_iter().flatten().for_each(|(m, u)| along[*m] += c * u);
            }
            along
        })
        .collect();
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
    Err(StepError::PulledAway { body: body.clone(), direction })
}
