//! Kinks of a body within the contact zone, where the membrane would have to have one too.

use crate::equilibrium::Equilibrium;
use crate::zone::contact_of;
use signorini_geometry::Point;

/// A change of slope counts as a kink beyond so many times what the curvature at both ends explains ...
const UNEXPLAINED: f64 = 4.0;
/// ... and beyond this fraction of the steepest slope in contact.
const NOTABLE: f64 = 0.02;

/// A place in contact where the slope of what is touched changes between two quadrature points by more than its curvature there
/// explains; the worst one, and none where it is smooth.
pub fn kink<const D: usize>(equilibrium: &Equilibrium<D>) -> Option<Point<D>> {
    let mut steepest = 0.0f64;
    let mut worst: (f64, Option<Point<D>>) = (0.0, None);
    let mut last = None;
    equilibrium.for_each_point(|cell, region, x, _| {
        let Some((side, _)) = contact_of(region) else {
            last = None;
            return;
        };
        let h = equilibrium.membrane.obstacles.jet(side, x);
        steepest = steepest.max(h.gradient.norm());
        // A kink may lie between two cells.
        let near = 2.0 * equilibrium.membrane.cells.size(cell);
        if let Some((y, g, curvature)) = last.replace((*x, h.gradient, h.hessian.norm()))
            && (x - y).norm() < near
        {
            let jump = (h.gradient - g).norm();
            let explained = UNEXPLAINED * h.hessian.norm().max(curvature) * (x - y).norm();
            if jump > explained && jump > worst.0 {
                worst = (jump, Some(0.5 * (x + y)));
            }
        }
    });
    worst.1.filter(|_| worst.0 > NOTABLE * steepest)
}
