//! Fronts within a cell, as implicit shapes.

use super::PlaneZone;
use crate::zone::{Division, FrontsInCell};
use signorini_geometry::{Aabb, ClosedCurve, CurvePoint, ImplicitShape, Point, Vector};

/// The signed distance to one front near a cell.
struct FrontSheet<'a> {
    curve: &'a ClosedCurve,
    seeds: Vec<usize>,
}

impl FrontSheet<'_> {
    fn foot(&self, x: &Point<2>) -> (f64, CurvePoint) {
        self.curve.signed_distance(x, self.seeds.iter().copied())
    }
}

impl ImplicitShape<2> for FrontSheet<'_> {
    fn value(&self, x: &Point<2>) -> f64 {
        self.foot(x).0
    }
    fn gradient(&self, x: &Point<2>) -> Vector<2> {
        self.foot(x).1.normal
    }
    fn value_and_gradient(&self, x: &Point<2>) -> (f64, Vector<2>) {
        let (distance, foot) = self.foot(x);
        (distance, foot.normal)
    }
}

/// The signed distance to a front within a cell that it hardly bends in: to the parabola that touches it nearest to the
/// centre. Third order in the size of the cell.
struct Osculating {
    foot: Point<2>,
    normal: Vector<2>,
    curvature: f64,
}

impl ImplicitShape<2> for Osculating {
    fn value(&self, x: &Point<2>) -> f64 {
        self.value_and_gradient(x).0
    }
    fn gradient(&self, x: &Point<2>) -> Vector<2> {
        self.value_and_gradient(x).1
    }
    fn value_and_gradient(&self, x: &Point<2>) -> (f64, Vector<2>) {
        let d = x - self.foot;
        let tangent = Vector::<2>::new(self.normal[1], -self.normal[0]);
        let (along, bent) = (d.dot(&tangent), self.curvature * d.dot(&tangent));
        (d.dot(&self.normal) + 0.5 * bent * along, self.normal + bent * tangent)
    }
}

/// A zone whose fronts are taken for parabolas within cells that they hardly bend in.
pub(crate) struct Straightened<'a>(pub &'a PlaneZone);

/// Curvature times cell size up to which a front hardly bends.
const HARDLY: f64 = 0.1;

impl Division<2> for Straightened<'_> {
    fn fronts_in(&self, b: &Aabb<2>) -> FrontsInCell<'_, 2> {
        self.0.fronts_within(b, HARDLY)
    }
}

impl PlaneZone {
    /// The fronts in a box, taken for parabolas where their curvature times its size is less than `hardly`.
    fn fronts_within(&self, b: &Aabb<2>, hardly: f64) -> FrontsInCell<'_, 2> {
        let near = self.near_box(b);
        let mut far = self.around(self.grid.cell_containing(&b.center()));
        far.retain(|c| near.iter().all(|(n, _)| n != c));
        let mut found = FrontsInCell { sheets: vec![], fronts: vec![], features: vec![], region: Box::new(|_| 0) };
        for (c, seeds) in near {
            let sheet = FrontSheet { curve: &self.curves[c], seeds };
            let (distance, foot) = sheet.foot(&b.center());
            if distance.abs() > b.radius() {
                if self.encloses(c, distance) {
                    far.push(c);
                }
                continue;
            }
            if foot.curvature.abs() * b.radius() < hardly {
                let CurvePoint { position, normal, curvature, .. } = foot;
                found.sheets.push(Box::new(Osculating { foot: position, normal, curvature }));
            } else {
                let own = &self.boxes[c];
                if (0..2).all(|k| own.min[k] > b.min[k] && own.max[k] < b.max[k]) {
                    found.features.push(own.center());
                }
                found.sheets.push(Box::new(sheet));
            }
            found.fronts.push(c);
        }
        let fronts = found.fronts.clone();
        found.region = Box::new(move |values| {
            let close = fronts.iter().zip(values).filter(|&(&c, &v)| self.encloses(c, v)).map(|(&c, _)| c);
            self.region_within(far.iter().copied().chain(close))
        });
        found
    }
}

impl Division<2> for PlaneZone {
    fn fronts_in(&self, b: &Aabb<2>) -> FrontsInCell<'_, 2> {
        self.fronts_within(b, 0.0)
    }
}
