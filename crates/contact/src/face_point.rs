//! A point of a face of a surface.

use signorini_geometry::Point;

/// A point of a face.
#[derive(Clone, Copy, Debug)]
pub struct FacePoint<const D: usize> {
    pub x: Point<D>,
    /// Derivatives of the position with respect to the coordinates of the face; the second is zero in the plane.
    pub tangents: [Point<D>; 2],
}

impl<const D: usize> FacePoint<D> {
    /// The outward normal, as long as the area per area of reference coordinates.
    pub fn area_normal(&self) -> Point<D> {
        let [a, b] = &self.tangents;
        if D == 2 {
            return Point::<D>::from_fn(|k, _| if k == 0 { a[1] } else { -a[0] });
        }
        Point::<D>::from_fn(|k, _| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            a[i] * b[j] - a[j] * b[i]
        })
    }
}
