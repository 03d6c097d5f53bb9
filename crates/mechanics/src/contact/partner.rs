//! Pairs that are kept during an increment.
//!
//! A body whose strains are small moves linearly. Two points of it that face each other at the start of an increment, `D_0`
//! apart, are `D = x_s(u) - x_m(u)` apart in it, and with the normal `ν` that they had at the start
//!
//! - gap `g = ν·D - R`, slip `e = (1 - νν^T)(D - D_0)`, both linear in the unknowns; slip counts from the start of the increment;
//! - axes of friction are those of the last increment, turned into the surface: friction keeps its components along them.
//!
//! Which points face each other is found once for each increment. The tangent of a frictionless contact is then symmetric and
//! positive, with friction it is the product of the law and of constant rows, and Newton's method ends as soon as it is known
//! which sites are closed and which of them slip; where surfaces slide far, the increments have to be short.

use crate::pair::{Axis, Pair, Stuck};
use crate::points::{Anchor, MaterialPoint, Order, SlavePoint};
use signorini_geometry::Vector;
use std::sync::OnceLock;

/// Where points that face each other are looked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pairing {
    /// Where the bodies are now.
    #[default]
    Now,
    /// Where they are at the start of an increment.
    AtStart,
}

/// What a site faces during an increment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Partner {
    pub point: MaterialPoint,
    /// Outward from the master.
    pub normal: Vector<3>,
    /// The first axis of friction, a unit vector across the normal.
    pub along: Vector<3>,
    /// Radii of sections or balls.
    pub radii: f64,
    /// `D_0`.
    pub apart: Vector<3>,
}

impl Partner {
    /// The pair of a site with the point that it faces; `first` are the first unknowns of slave and master.
    pub fn pair(&self, placed: &SlavePoint, anchor: &Anchor, first: [u32; 2], order: Order) -> Pair {
        let normal = self.normal;
        let of_slave = placed.functions.iter().map(|f| (first[0] + f.unknown, normal.dot(&f.value)));
        let of_master = anchor.functions.iter().map(|f| (first[1] + f.unknown, -normal.dot(&f.value)));
        let (unknowns, d_gap): (Vec<u32>, Vec<f64>) = of_slave.chain(of_master).unzip();
        let n = unknowns.len();
        let mut pair = Pair::default();
        pair.gap = normal.dot(&(placed.x - anchor.x)) - self.radii;
        (pair.normal, pair.point) = (normal, self.point);
        (pair.unknowns, pair.opening) = (unknowns, d_gap.clone());
        pair.d_gap = d_gap;
        pair.d_normal = vec![Vector::<3>::zeros(); n];
        if order == Order::Second {
            pair.d_opening = vec![0.0; n * n];
        }
        pair
    }

    /// Adds slip to a pair that has its gap.
    pub fn add_slip(&self, placed: &SlavePoint, anchor: &Anchor, pair: &mut Pair) {
        let across = |d: Vector<3>| d - self.normal * self.normal.dot(&d);
        let of_slave = placed.functions.iter().map(|f| across(f.value));
        let of_master = anchor.functions.iter().map(|f| -across(f.value));
        pair.slip = of_slave.chain(of_master).collect();
        pair.d_elastic = pair.slip.clone();
        pair.elastic = across(placed.x - anchor.x - self.apart);
        pair.axis = Axis { direction: self.along, variation: vec![Vector::<3>::zeros(); pair.unknowns.len()] };
        pair.stuck = Some(Stuck { point: self.point, on_slave: self.along, on_master: self.normal });
    }
}

/// What every site faces, once it is known.
pub(crate) type Partners = OnceLock<Vec<Option<Partner>>>;
