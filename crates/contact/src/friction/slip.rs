//! Weighted slips: the way of the slave along the master, tested with the dual functions of the pressure nodes, on the
//! same points and with the same weights as their gaps.

use crate::mortar::{Shares, WeightedGap, weighted};
use crate::segments::GapPoint;
use crate::surface::ContactSurface;
use signorini_geometry::{Point, Vector};

/// The weighted slips of a pressure node along its `D - 1` tangents, linear in the displacement.
#[derive(Clone, Debug, PartialEq)]
pub struct WeightedSlip<const D: usize> {
    /// A row for every tangent; what is called a gap is a slip.
    pub rows: Vec<WeightedGap>,
    /// The tangents in the mean, of unit length: the axes of the law.
    pub axes: Vec<Point<D>>,
}

/// An axis of friction that is normal to the surface.
#[derive(Clone, Debug, PartialEq)]
pub struct NoAxis<const D: usize> {
    pub x: Point<D>,
}

/// Part of an axis in the tangent plane below which there is none.
const NORMAL: f64 = 1e-6;

/// The weighted slips of all pressure nodes, by number; nodes without a row of their own have none.
///
/// The first tangent is the projection of `axis` on the tangent plane, the second is across it; without an axis they
/// are any smooth ones. `motion` is the displacement of a rigid master at a point of a face.
///
/// # Errors
/// An axis that is normal to the surface somewhere.
pub fn weighted_slips<const D: usize>(
    slave: &dyn ContactSurface<D>,
    master: Option<&dyn ContactSurface<D>>,
    points: &[Vec<GapPoint<D>>],
    shares: &Shares,
    axis: Option<&Point<D>>,
    motion: &dyn Fn(usize, usize) -> Point<D>,
) -> Result<Vec<Option<WeightedSlip<D>>>, NoAxis<D>> {
    let mut mean = vec![Point::<D>::zeros(); shares.weight.len()];
    for (list, of_face) in points.iter().zip(&shares.of_point) {
        for (p, of_point) in list.iter().zip(of_face) {
            of_point.iter().for_each(|(node, share)| mean[*node as usize] += p.direction * *share);
        }
    }
    // The axis of each node that is to be projected: one that is far from normal.
    let along: Vec<Point<D>> = (mean.iter())
        .map(|n| match axis {
            Some(a) => a / a.norm().max(f64::MIN_POSITIVE),
            None => Point::<D>::from_fn(|k, _| f64::from(u8::from(k == n.iamin()))),
        })
        .collect();
    if D == 3 {
        for (face, (list, of_face)) in points.iter().zip(&shares.of_point).enumerate() {
            for (p, of_point) in list.iter().zip(of_face) {
                let normal = p.direction.normalize();
                let lies = |(node, _): &(u32, f64)| {
                    let a = &along[*node as usize];
                    (a - normal * normal.dot(a)).norm() >= NORMAL
                };
                if !of_point.iter().all(lies) {
                    return Err(NoAxis { x: slave.at(face, &p.s).x });
                }
            }
        }
    }
    let mut out: Vec<Option<WeightedSlip<D>>> = (shares.weight.iter())
        .map(|w| (*w > 0.0).then(|| WeightedSlip { rows: Vec::new(), axes: Vec::new() }))
        .collect();
    for which in 0..D - 1 {
        let tangent = |p: &GapPoint<D>, node: u32| tangent(&p.direction, &along[node as usize], which);
        let rows = weighted(slave, master, points, shares, &|face, q, p, node| {
            let e = tangent(p, node);
            (-e.dot(&motion(face, q)), e)
        });
        for (slip, (row, (n, a))) in out.iter_mut().zip(rows.into_iter().zip(mean.iter().zip(&along))) {
            if let Some(slip) = slip {
                slip.rows.push(row);
                slip.axes.push(self::tangent(n, a, which));
            }
        }
    }
    Ok(out)
}

/// A tangent of a surface with this normal, of any length: the projection of the axis, or what is across it; in the plane
/// there is only one.
fn tangent<const D: usize>(normal: &Point<D>, axis: &Point<D>, which: usize) -> Point<D> {
    let n = normal.normalize();
    if D == 2 {
        return Point::<D>::from_fn(|k, _| if k == 0 { n[1] } else { -n[0] });
    }
    let first = (axis - n * n.dot(axis)).normalize();
    if which == 0 {
        return first;
    }
    let space = |v: &Point<D>| Vector::<3>::from_fn(|k, _| v[k]);
    let across = space(&n).cross(&space(&first));
    Point::<D>::from_fn(|k, _| across[k])
}
