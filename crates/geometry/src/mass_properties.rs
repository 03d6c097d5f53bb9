//! Volume, centre of mass and moments of inertia of bodies of density one.
//!
//! | body | volume `V` | moments of inertia about the centre of mass |
//! |---|---|---|
//! | ball | `4πR³/3` | `2VR²/5` |
//! | ellipsoid | `4πabc/3` | `V(b² + c²)/5`, ... |
//! | ring about `k` | `2π²Rr²` | `V(R² + 3r²/4)` about `k`, `V(R²/2 + 5r²/8)` across |
//! | polyhedron | sums over the tetrahedra of its triangles and one point | of the second moments `∫ x xᵀ` |
//!
//! In the plane they are those of a plate of thickness one, and its moment is that about z.

use crate::mesh::TriangleMesh;
use crate::{Matrix, Point, Vector};
use std::f64::consts::PI;

/// What a body of density one resists to acceleration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    pub volume: f64,
    /// The centre of mass.
    pub centre: Point<3>,
    /// Moments of inertia about the centre of mass.
    pub inertia: Matrix<3>,
}

impl MassProperties {
    /// A ball.
    pub fn ball(centre: Point<3>, radius: f64) -> Self {
        Self::ellipsoid(centre, [radius; 3])
    }

    /// An ellipsoid along the axes.
    pub fn ellipsoid(centre: Point<3>, semi_axes: [f64; 3]) -> Self {
        let volume = 4.0 / 3.0 * PI * semi_axes.iter().product::<f64>();
        Self::of_second_moments(volume, centre, Vector::<3>::from(semi_axes.map(|a| 0.2 * a * a)))
    }

    /// A plate with an ellipse as its outline; of thickness one.
    pub fn ellipse(centre: Point<3>, [a, b]: [f64; 2]) -> Self {
        Self::of_second_moments(PI * a * b, centre, Vector::<3>::new(0.25 * a * a, 0.25 * b * b, 0.0))
    }

    /// A block along the axes with these edges; with no edge along z a plate of thickness one.
    pub fn block(centre: Point<3>, edges: Vector<3>) -> Self {
        let volume = edges.iter().filter(|e| **e > 0.0).product();
        Self::of_second_moments(volume, centre, edges.component_mul(&edges) / 12.0)
    }

    /// A ring about an axis, with the radii of its middle circle and its tube.
    pub fn ring(centre: Point<3>, axis: &Vector<3>, [major, minor]: [f64; 2]) -> Self {
        let volume = 2.0 * PI * PI * major * minor * minor;
        let about = volume * (major * major + 0.75 * minor * minor);
        let across = volume * (0.5 * major * major + 0.625 * minor * minor);
        MassProperties { volume, centre, inertia: Self::round(axis, about, across) }
    }

    /// Moments of inertia that are the same all across an axis.
    pub fn round(axis: &Vector<3>, about: f64, across: f64) -> Matrix<3> {
        Matrix::<3>::identity() * across + axis * axis.transpose() * (about - across)
    }

    /// The inside of a closed surface of triangles with outward normals.
    pub fn polyhedron(mesh: &TriangleMesh) -> Self {
        let bounds = mesh.bounds();
        let origin = bounds.center();
        let (mut volume, mut first, mut second) = (0.0, Vector::<3>::zeros(), Matrix::<3>::zeros());
        for k in 0..mesh.triangles().len() {
            let [a, b, c] = mesh.corners(k).map(|x| x - origin);
            let own = a.dot(&b.cross(&c)) / 6.0;
            let sum = a + b + c;
            volume += own;
            first += sum * (own / 4.0);
            let squares = a * a.transpose() + b * b.transpose() + c * c.transpose();
            second += (squares + sum * sum.transpose()) * (own / 20.0);
        }
        let mean = first / volume;
        let second = second - mean * mean.transpose() * volume;
        let inertia = Matrix::<3>::identity() * second.trace() - second;
        MassProperties { volume, centre: origin + mean, inertia }
    }

    /// By the mean squares of the coordinates from the centre, along the principal axes.
    fn of_second_moments(volume: f64, centre: Point<3>, mean: Vector<3>) -> Self {
        let moments = Vector::<3>::repeat(mean.sum()) - mean;
        MassProperties { volume, centre, inertia: Matrix::<3>::from_diagonal(&(moments * volume)) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A block as triangles, against its closed form; and a ball by a fine surface, with the error of the chords.
    #[test]
    fn polyhedra_have_the_moments_of_what_they_are() {
        let (low, edges) = (Vector::<3>::new(1.0, -2.0, 0.5), Vector::<3>::new(0.3, 0.7, 1.1));
        let corner = |k: usize| low + Vector::<3>::from_fn(|i, _| if k >> i & 1 == 1 { edges[i] } else { 0.0 });
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles: Vec<[u32; 3]> = faces.iter().flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]]).collect();
        let mesh = TriangleMesh::new((0..8).map(corner).collect(), &triangles).unwrap();
        let (found, exact) = (MassProperties::polyhedron(&mesh), MassProperties::block(low + edges * 0.5, edges));
        assert!((found.volume - exact.volume).abs() < 1e-14);
        assert!((found.centre - exact.centre).norm() < 1e-14);
        assert!((found.inertia - exact.inertia).norm() < 1e-14);
    }
}
