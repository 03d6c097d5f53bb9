//! Friction: stick and slip of bodies on bodies and on rigid ones, small sliding.

use signorini_contact::{Coulomb, GapJet, Status};
use signorini_fem::Group;
use signorini_fem::block::block;
use signorini_geometry::Point;
use signorini_solid::*;
use std::collections::BTreeMap;

mod bodies;
mod rigid;

const E: f64 = 1000.0;
const NU: f64 = 0.3;
const ELASTIC: Elastic = Elastic { youngs_modulus: E, poissons_ratio: NU };

fn even(from: f64, to: f64, n: usize) -> Vec<f64> {
    (0..=n).map(|k| from + (to - from) * k as f64 / n as f64).collect()
}

fn coulomb<const D: usize>(mu: f64) -> Option<Friction<D>> {
    Some(Friction { law: Box::new(Coulomb::isotropic(mu).unwrap()), axis: None })
}

fn support(name: &str, body: usize, groups: &BTreeMap<String, Group>, group: &str, kind: SupportKind) -> Support {
    Support { name: name.into(), body, group: groups[group].clone(), kind }
}

/// A rigid plane through the origin.
fn flat<const D: usize>(normal: Point<D>) -> RigidGap<D> {
    Box::new(move |x| GapJet::flat(x.dot(&normal), normal))
}
