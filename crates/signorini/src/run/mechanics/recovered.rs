//! Pressures of bodies of cells whose contact is tested at single nodes.
//!
//! As many nodes as there are functions determine the resultant of neighbours better than the share of each, and the area that a
//! node stands for is known to a point of quadrature: shares alternate around the pressure. So what is told of a node is the force
//! on it and its neighbours over their area, weighted by a hat of twice the distance to the nearest of them, which takes
//! alternating parts of equal distances out.

use signorini_contact::Status;
use signorini_mechanics::{OfSurface, SiteResult};

/// Half the width of a hat, in distances to the nearest node.
const REACH: f64 = 2.0;

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

#[cfg(test)]
mod tests {
    use super::*;
    use signorini_geometry::{Point, Vector};

    #[test]
    fn alternating_shares_are_evened_out() {
        let site = |k: usize| SiteResult {
            x: Point::<3>::new(0.1 * k as f64, 0.0, 0.0),
            normal: Vector::<3>::y(),
            weight: 0.1,
            pressure: 2.0 + if k.is_multiple_of(2) { 1.5 } else { -1.5 },
            status: Status::Slip,
            ..SiteResult::default()
        };
        let mut sites: Vec<SiteResult> = (0..9).map(site).collect();
        recover(&mut sites);
        let told: Vec<f64> = sites[1..8].iter().map(SiteResult::shown_pressure).collect();
        assert!(told.iter().all(|p| (p - 2.0).abs() < 1e-12), "{told:?}");
        // Forces stay what they are.
        assert!((sites[0].force().y - 0.35).abs() < 1e-12);
    }
}
