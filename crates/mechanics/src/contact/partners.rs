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

use super::traction::STEEP;
use super::{Contact, Sides};
use crate::body::PlaceError;
use crate::pair::{Axis, AxisChoice, Pair, Stuck, any_tangent};
use crate::points::{Anchor, Master, MaterialPoint, Order, SlavePoint};
use rayon::prelude::*;
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
    normal: Vector<3>,
    /// The first axis of friction, a unit vector across the normal.
    along: Vector<3>,
    /// Radii of sections or balls.
    radii: f64,
    /// `D_0`.
    apart: Vector<3>,
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

impl Contact {
    /// What may be touched, ready for many searches; what every site faces in this increment is found where pairs are kept.
    pub(super) fn met<'a>(&self, sides: &Sides<'a>) -> Result<Box<dyn Master + 'a>, PlaceError> {
        let master = sides.master.0.master(self.master.group.as_deref(), sides.master.1)?;
        if self.partners.get().is_none() {
            master.prepare();
            if self.pairing == Pairing::AtStart {
                self.find_partners(sides, master.as_ref());
            }
        }
        Ok(master)
    }

    fn find_partners(&self, sides: &Sides<'_>, master: &dyn Master) {
        let of = |k: usize| {
            let (placed, found) = self.pair_now(k, sides, (master, f64::INFINITY), |_| false);
            let pair = found?.ok()?.pair;
            let (normal, apart) = (pair.normal, placed.x - master.at(&pair.point).x);
            let radii = normal.dot(&apart) - pair.gap;
            Some(Partner { point: pair.point, normal, along: self.first_axis(k, &normal), radii, apart })
        };
        let found = (0..self.sites.len()).into_par_iter().map(of).collect();
        self.partners.get_or_init(|| found);
    }

    /// The first axis of friction across a normal: as stated, or that of the last increment.
    fn first_axis(&self, k: usize, normal: &Vector<3>) -> Vector<3> {
        let direction = match self.axis {
            AxisChoice::OnSlave(v) | AxisChoice::OnMaster(v) => Some(v),
            _ => self.memory[k].stuck.map(|s| s.on_slave),
        };
        let across = direction.and_then(|v| (v - normal * normal.dot(&v)).try_normalize(STEEP * v.norm()));
        across.unwrap_or_else(|| any_tangent(normal))
    }
}

/// What every site faces, once it is known.
pub(crate) type Partners = OnceLock<Vec<Option<Partner>>>;
