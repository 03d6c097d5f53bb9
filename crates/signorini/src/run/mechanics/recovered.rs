//! Pressures of bodies of cells whose contact is tested at single nodes.
//!
//! As many nodes as there are functions determine the resultant of neighbours better than the share of each, and the area that a
//! node stands for is known to a point of quadrature: shares alternate around the pressure. So what is told of a node is the force
//! on it and its neighbours over their area, weighted by a hat of twice the distance to the nearest of them, which takes
//! alternating parts of equal distances out.

use crate::plan::mechanics::MechanicsPlan;
use signorini_contact::Status;
use signorini_mechanics::{IncrementResult, OfSurface, SiteResult};

/// Half the width of a hat, in distances to the nearest node.
const REACH: f64 = 2.0;

/// Recovers the pressures of all contacts that are tested at nodes.
pub fn recover_at_nodes(plan: &MechanicsPlan, result: &mut IncrementResult) {
    let of_contacts = result.sites.iter_mut().zip(&plan.contacts);
    of_contacts.filter(|(_, tested)| tested.at_nodes).for_each(|(sites, _)| recover(sites));
}

/// Recovers the pressures of the nodes of a surface.
pub fn recover(sites: &mut [SiteResult]) {
    // Not what lies on the other side of a thin body.
    let is_beside = |a: &SiteResult, b: &SiteResult| a.normal.dot(&b.normal) >= 0.0;
    let recovered: Vec<Option<f64>> = (sites.iter())
        .map(|site| {
            if site.status == Status::Open {
                return None;
            }
            let others = sites.iter().filter(|other| is_beside(site, other));
            let apart = others.map(|other| (other.x - site.x).norm()).filter(|d| *d > 0.0).reduce(f64::min)?;
            let reach = REACH * apart;
            let (mut force, mut area) = (0.0, 0.0);
            for other in sites.iter() {
                let hat = 1.0 - (other.x - site.x).norm() / reach;
                if hat > 0.0 && is_beside(site, other) {
                    let carries = if other.status == Status::Open { 0.0 } else { other.pressure };
                    force += hat * other.weight * carries;
                    area += hat * other.weight;
                }
            }
            (area > 0.0).then(|| force / area)
        })
        .collect();
    for (site, pressure) in sites.iter_mut().zip(recovered) {
        // Friction with it, so that it stays as near to its limit.
        let gain = |pressure: f64| if site.pressure > 0.0 { pressure / site.pressure } else { 0.0 };
        site.of_surface = pressure.map(|pressure| OfSurface {
            pressure,
            friction: site.friction * gain(pressure),
            area: site.weight,
            zone: 0,
        });
    }
}
