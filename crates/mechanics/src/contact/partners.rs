//! Pairs that are kept during an increment.
//!
//! A body whose strains are small moves linearly; the gap between two points of it that face each other does too, along the
//! normal `ν` that they had at the start of the increment: `g = ν·(x_s(u) - x_m(u))`. Which points face each other is found
//! once for each increment. The tangent of a frictionless contact is then symmetric and positive, and Newton's method ends
//! as soon as it is known which sites are closed; where surfaces slide far, the increments have to be short.

use super::{Contact, Sides};
use crate::body::PlaceError;
use crate::pair::Pair;
use crate::points::{Anchor, Master, MaterialPoint, Order, Placed};
use rayon::prelude::*;
use signorini_geometry::Vector;
use std::sync::OnceLock;

/// Where points that face each other are looked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pairing {
    /// Where the bodies are now.
    #[default]
    Now,
    /// Where they are at the start of an increment. With friction as `Now`.
    AtStart,
}

/// What a site faces during an increment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Partner {
    pub point: MaterialPoint,
    /// Outward from the master.
    normal: Vector<3>,
    /// Radii of sections or balls.
    radii: f64,
}

impl Partner {
    /// The pair of a site with the point that it faces; `first` are the first unknowns of slave and master.
    pub fn pair(&self, placed: &Placed, anchor: &Anchor, first: [u32; 2], order: Order) -> Pair {
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
}

impl Contact {
    /// What may be touched, ready for many searches; what every site faces in this increment is found where pairs are kept.
    pub(super) fn met<'a>(&self, sides: &Sides<'a>) -> Result<Box<dyn Master + 'a>, PlaceError> {
        let master = sides.master.0.master(self.master.group.as_deref(), sides.master.1)?;
        if self.partners.get().is_none() {
            master.prepare();
            if self.pairing == Pairing::AtStart && self.friction.is_none() {
                self.find_partners(sides, master.as_ref());
            }
        }
        Ok(master)
    }

    fn find_partners(&self, sides: &Sides<'_>, master: &dyn Master) {
        let of = |k: usize| {
            let (placed, found) = self.pair_now(k, sides, (master, f64::INFINITY), |_| false);
            let pair = found?.ok()?.pair;
            let anchor = master.at(&pair.point);
            let radii = pair.normal.dot(&(placed.x - anchor.x)) - pair.gap;
            Some(Partner { point: pair.point, normal: pair.normal, radii })
        };
        let found = (0..self.sites.len()).into_par_iter().map(of).collect();
        self.partners.get_or_init(|| found);
    }
}

/// What every site faces, once it is known.
pub(crate) type Partners = OnceLock<Vec<Option<Partner>>>;
