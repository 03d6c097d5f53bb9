//! Quadrature of cells that are not cut.

use crate::cut::QuadraturePoint;
use signorini_geometry::rule::gauss_legendre;
use signorini_geometry::{Aabb, Point};

/// Gauss points per direction in cells that are not cut.
pub(crate) fn whole_order(degree: usize) -> usize {
    degree + 3
}

/// The tensor-product Gauss rule of a box.
pub(crate) fn box_rule<const D: usize>(b: &Aabb<D>, order: usize) -> Vec<QuadraturePoint<D>> {
    let gauss = gauss_legendre(order);
    (0..order.pow(D as u32))
        .map(|mut i| {
            let mut weight = b.volume();
            let x = Point::from_fn(|_, _| {
                let (x, w) = gauss[i % order];
                i /= order;
                weight *= w;
                x
            });
            QuadraturePoint { x: b.at(&x), weight }
        })
        .collect()
}
