//! Weighted slips: the way of the slave along the master, at points or tested with the dual functions of the pressure nodes,
//! on the same points and with the same weights as the gaps.

use crate::kinematics::Kinematics;
use crate::mortar::{Shares, WeightedGap, compress, weighted};
use crate::points::{Measured, Tests};
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
    let along: Vec<Point<D>> = mean.iter().map(|n| projected(n, axis)).collect();
    for (face, (list, of_face)) in points.iter().zip(&shares.of_point).enumerate() {
        for (p, of_point) in list.iter().zip(of_face) {
            if !of_point.iter().all(|(node, _)| lies(&p.direction, &along[*node as usize])) {
                return Err(NoAxis { x: slave.at(face, &p.s).x });
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

/// The slips of the rows of tests, by their place in the list; those that meet nothing have none. `motion` is the
/// displacement of a rigid master at a point of the tests; the axis as for [`weighted_slips`].
///
/// # Errors
/// An axis that is normal to the surface somewhere.
pub fn slips_of_points<const D: usize>(
    slave: &dyn ContactSurface<D>,
    tests: &Tests,
    measured: &Measured,
    axis: Option<&Point<D>>,
    motion: &dyn Fn(usize) -> Point<D>,
) -> Result<Vec<Option<WeightedSlip<D>>>, NoAxis<D>> {
    let normal_of = |pair: &Kinematics| Point::<D>::from_fn(|k, _| pair.normal[k]);
    let met = || tests.points.iter().enumerate().filter_map(|(k, point)| Some((k, point, measured.pair(k)?)));
    let (mut mean, mut weight) = (vec![Point::<D>::zeros(); tests.rows.len()], vec![0.0; tests.rows.len()]);
    for (_, point, pair) in met() {
        for (row, share) in &point.shares {
            mean[*row as usize] += normal_of(pair) * *share;
            weight[*row as usize] += share;
        }
    }
    let along: Vec<Point<D>> = mean.iter().map(|n| projected(n, axis)).collect();
    let row = |k: usize| WeightedGap {
        gap: 0.0,
        weight: weight[k],
        terms: Vec::new(),
        forces: Vec::new(),
        node: tests.rows[k].number,
    };
    let mut out: Vec<Option<WeightedSlip<D>>> = (0..tests.rows.len())
        .map(|k| {
            let axes = || (0..D - 1).map(|a| tangent(&mean[k], &along[k], a)).collect();
            (weight[k] > 0.0).then(|| WeightedSlip { rows: vec![row(k); D - 1], axes: axes() })
        })
        .collect();
    for (k, point, pair) in met() {
        let normal = normal_of(pair);
        for (row, share) in &point.shares {
            let a = &along[*row as usize];
            if !lies(&normal, a) {
                return Err(NoAxis { x: slave.at(point.face, &point.s).x });
            }
            let Some(slip) = &mut out[*row as usize] else { continue };
            for (which, row) in slip.rows.iter_mut().enumerate() {
                let e = tangent(&normal, a, which);
                row.gap -= share * e.dot(&motion(k));
                for (unknown, value) in &pair.apart {
                    let terms = (0..D).filter(|&i| e[i] != 0.0).map(|i| (unknown + i as u32, share * value * e[i]));
                    row.terms.extend(terms);
                }
            }
        }
    }
    out.iter_mut().flatten().flat_map(|slip| &mut slip.rows).for_each(|row| compress(&mut row.terms));
    Ok(out)
}

/// What is projected for the first tangent: the axis, or where there is none a direction that is far from normal.
fn projected<const D: usize>(normal: &Point<D>, axis: Option<&Point<D>>) -> Point<D> {
    match axis {
        Some(a) => a / a.norm().max(f64::MIN_POSITIVE),
        None => Point::<D>::from_fn(|k, _| f64::from(u8::from(k == normal.iamin()))),
    }
}

/// Whether an axis has a projection; in the plane it needs none.
fn lies<const D: usize>(normal: &Point<D>, axis: &Point<D>) -> bool {
    let n = normal.normalize();
    D == 2 || (axis - n * n.dot(axis)).norm() >= NORMAL
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
