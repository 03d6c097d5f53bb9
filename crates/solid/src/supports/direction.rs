//! The directions along which a function is constrained, and a frame that begins with them.

use signorini_geometry::Point;

/// What one constrained direction of a function takes its value from.
#[derive(Clone, Debug)]
pub(super) enum Source {
    Prescribed {
        support: usize,
    },
    /// The common displacement of a uniform support in one component.
    Tied {
        support: usize,
        unknown: u32,
        vertex: bool,
    },
}

#[derive(Clone, Debug)]
pub(super) struct Held<const D: usize> {
    pub(super) direction: Point<D>,
    pub(super) source: Source,
}

pub(super) fn axis<const D: usize>(i: usize) -> Point<D> {
    Point::<D>::from_fn(|k, _| f64::from(u8::from(k == i)))
}

pub(super) fn list_rank<const D: usize>(list: &[Held<D>]) -> usize {
    orthonormal(list).len()
}

/// An orthonormal frame that begins with the held directions; the axes themselves where that is possible.
pub(super) fn frame<const D: usize>(list: &[Held<D>]) -> Vec<Point<D>> {
    let mut basis = orthonormal(list);
    while basis.len() < D {
        let candidate = (0..D)
            .map(|i| {
                let mut rest = axis::<D>(i);
                for b in &basis {
                    rest -= b * b.dot(&rest);
                }
                rest
            })
            .max_by(|a, b| a.norm().total_cmp(&b.norm()));
        match candidate {
            Some(c) => basis.push(c.normalize()),
            None => break,
        }
    }
    basis
}

fn orthonormal<const D: usize>(list: &[Held<D>]) -> Vec<Point<D>> {
    let mut basis: Vec<Point<D>> = Vec::new();
    for h in list {
        let mut rest = h.direction;
        for b in &basis {
            rest -= b * b.dot(&rest);
        }
        if rest.norm() > 1e-9 {
            basis.push(rest.normalize());
        }
    }
    basis
}
