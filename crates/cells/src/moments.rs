//! Moment fitting: the few points of a fixed rule in a box, with weights that integrate polynomials as many points do.
//!
//! With the Lagrange polynomials `L_j` of the Gauss points `y_j` of the box, `w_j = Σ_q w_q L_j(x_q)` (Müller, Kummer &
//! Oberlack, Int. J. Numer. Methods Eng. 96, 2013). Weights may be negative. What is a factor of the given weights, such as
//! a modulus in every voxel, is integrated as exactly as the given points do.

use signorini_fem::QuadraturePoint;
use signorini_geometry::rule::gauss_legendre;
use signorini_geometry::{Aabb, Point};

/// Which points cut cells keep.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum VolumePoints {
    /// Those in the material.
    #[default]
    InMaterial,
    /// Those of one rule in every cell, where they are fewer, that integrate the stiffness alike: for many cells.
    Fitted,
}

/// The weights at the Gauss points of a box, `order` in each direction, with which polynomials of a degree below that are
/// integrated as by the given points.
#[doc(hidden)]
pub fn fitted<const D: usize>(
    b: &Aabb<D>,
    order: usize,
    points: impl Iterator<Item = (Point<D>, f64)>,
) -> Vec<QuadraturePoint<D>> {
    let nodes: Vec<f64> = gauss_legendre(order).into_iter().map(|(t, _)| t).collect();
    let scale: Vec<f64> =
        (0..order).map(|j| (0..order).filter(|m| *m != j).map(|m| 1.0 / (nodes[j] - nodes[m])).product()).collect();
    let size = b.size();
    let mut weights = vec![0.0; order.pow(D as u32)];
    let mut lines: [Vec<f64>; D] = std::array::from_fn(|_| vec![0.0; order]);
    for (x, w) in points {
        for k in 0..D {
            let t = (x[k] - b.min[k]) / size[k];
            for j in 0..order {
                lines[k][j] = (0..order).filter(|m| *m != j).fold(scale[j], |p, m| p * (t - nodes[m]));
            }
        }
        // The last directions together, so that the innermost loop is long and without branches.
        for (block, weights) in weights.chunks_exact_mut(order).enumerate() {
            let mut rest = block;
            let mut factor = w;
            for line in &lines[1..] {
                factor *= line[rest % order];
                rest /= order;
            }
            weights.iter_mut().zip(&lines[0]).for_each(|(sum, l)| *sum += factor * l);
        }
    }
    (box_points(b, order).into_iter().zip(weights)).map(|((x, _), weight)| QuadraturePoint { x, weight }).collect()
}

/// The tensor-product Gauss rule of a box.
#[doc(hidden)]
pub fn box_points<const D: usize>(b: &Aabb<D>, order: usize) -> Vec<(Point<D>, f64)> {
    let gauss = signorini_geometry::rule::gauss_legendre(order);
    (0..order.pow(D as u32))
        .map(|mut i| {
            let mut weight = b.volume();
            let x = b.at(&Point::from_fn(|_, _| {
                let (t, w) = gauss[i % order];
                i /= order;
                weight *= w;
                t
            }));
            (x, weight)
        })
        .collect()
}
