//! The whole deck, from its histories.

use super::model::{Model, RigidNodes};
use super::steps::{Distributed, DistributedKind};
use crate::ImportError;
use crate::curve::Curve;
use crate::deck::{Deck, Load, LoadKind, Place, RigidMotion};
use crate::element::Space;
use crate::mesh::faces_of;
use std::collections::BTreeSet;

impl Model {
    /// Whether a node moves a rigid body.
    pub(super) fn reference(&self, node: u64) -> bool {
        self.rigid_nodes.iter().any(|r| [r.reference, r.rotation].contains(&Some(node)))
    }

    /// The whole deck.
    pub(super) fn finish(mut self) -> Result<Deck, ImportError> {
        let wrong = |message: &str| ImportError::new(&self.deck.file, None, message);
        if self.histories.steps.is_empty() {
            return Err(wrong("the deck has no *STEP"));
        }
        for (mut pair, interaction) in std::mem::take(&mut self.contacts) {
            if let Some(interaction) = interaction {
                let none = || {
                    let message = format!("*CONTACT PAIR: there is no *SURFACE INTERACTION `{interaction}`");
                    ImportError::new(&self.deck.file, pair.line, message)
                };
                let own = self.interactions.get(&interaction).ok_or_else(none)?;
                (pair.friction, pair.stiffness) = (own.friction.clone(), own.stiffness);
            }
            self.deck.contacts.push(pair);
        }
        for RigidNodes { material, reference, rotation } in &self.rigid_nodes {
            let mut motion = RigidMotion::default();
            for node in [reference, rotation].into_iter().flatten() {
                let is_ended = self.histories.ended.iter().any(|(_, list)| list.keys().iter().any(|k| k.0 == *node));
                if is_ended {
                    let message = format!("the node {node} of a rigid body is released in a step: cannot be imported");
                    return Err(wrong(&message));
                }
            }
            for node in [reference, rotation].into_iter().flatten() {
                let turns = Some(*node) == *rotation && rotation != reference;
                for (direction, curve) in self.histories.supports.take(*node) {
                    motion.components[if turns { direction + 3 } else { direction } % 6] = Some(curve);
                }
                for (direction, curve) in self.histories.forces.take(*node) {
                    motion.force[direction % 3] = Some(curve);
                }
            }
            motion.centre = reference.and_then(|n| self.deck.nodes.get(&n).copied());
            *self.deck.rigid.entry(material) = motion;
        }
        self.check_transformed()?;
        self.deck.equations = self.equations()?;
        self.turn_forces();
        let tied = self.equal.apply(&mut self.histories.supports);
        let mut supports = self.histories.supports.supports(&self.deck, &self.transformed, None);
        for (until, ended) in &self.histories.ended {
            supports.extend(ended.supports(&self.deck, &self.transformed, Some(*until)));
        }
        self.deck.supports = supports;
        self.deck.supports.extend(tied);
        self.deck.loads = self.histories.forces.loads(&self.deck);
        let thickness = self.deck.sections.iter().map(|s| s.thickness).fold(f64::NAN, f64::max);
        if self.deck.space() == Space::PlaneStress || self.deck.space() == Space::PlaneStrain {
            for load in &mut self.deck.loads {
                if let LoadKind::NodalForce(force) = &mut load.kind {
                    force.iter_mut().for_each(|f| *f = f.scaled(1.0 / thickness));
                }
            }
        }
        let distributed = self.distributed_loads()?;
        self.deck.loads.extend(distributed);
        self.deck.steps = self.histories.steps;
        Ok(self.deck)
    }

    /// Distributed loads; faces with the same history are one load.
    fn distributed_loads(&self) -> Result<Vec<Load>, ImportError> {
        let mut out: Vec<Load> = Vec::new();
        for (Distributed { on, kind }, curve) in &self.histories.distributed {
            let along = |axis: usize, curve: &Curve| {
                std::array::from_fn(|k| if k == axis { curve.clone() } else { Curve::constant(0.0) })
            };
            match *kind {
                DistributedKind::Face(face) => {
                    let face = format!("{on} {face}");
                    faces_of(&self.deck, std::slice::from_ref(&face))
                        .map_err(|m| ImportError::new(&self.deck.file, None, format!("*DLOAD: {m}")))?;
                    let same = out.iter_mut().find_map(|load| match (&mut load.on, &load.kind) {
                        (Place::Faces(_, faces), LoadKind::Pressure(c)) if c == curve => Some(faces),
                        _ => None,
                    });
                    match same {
                        Some(faces) => faces.push(face),
                        None => out.push(Load {
                            on: Place::Faces("pressure".into(), vec![face]),
                            kind: LoadKind::Pressure(curve.clone()),
                        }),
                    }
                }
                DistributedKind::Surface => {
                    let none =
                        || ImportError::new(&self.deck.file, None, format!("*DSLOAD: there is no surface `{on}`"));
                    let name = self.deck.surfaces.get(on).ok_or_else(none)?.0.to_string();
                    out.push(Load { on: Place::Surface(name), kind: LoadKind::Pressure(curve.clone()) });
                }
                DistributedKind::Body(axis) => {
                    out.push(Load { on: Place::ElementSet(on.clone()), kind: LoadKind::BodyForce(along(axis, curve)) })
                }
                DistributedKind::Gravity(axis) => {
                    for (place, density) in self.densities(on)? {
                        let curve = curve.scaled(density);
                        out.push(Load { on: place, kind: LoadKind::BodyForce(along(axis, &curve)) });
                    }
                }
            }
        }
        Ok(out)
    }

    /// The densities within a set of elements, by sections.
    fn densities(&self, set: &str) -> Result<Vec<(Place, f64)>, ImportError> {
        let wrong = |message: String| ImportError::new(&self.deck.file, None, format!("*DLOAD, GRAV: {message}"));
        let elements = |set: &str| -> Result<BTreeSet<usize>, ImportError> {
            let list = self.deck.elements_of(Some(set)).ok_or_else(|| wrong(format!("there is no set `{set}`")))?;
            Ok(list.into_iter().collect())
        };
        let wanted = elements(set)?;
        let mut out = Vec::new();
        for section in &self.deck.sections {
            let own = elements(&section.elements)?;
            let place = if own.is_subset(&wanted) {
                &section.elements
            } else if wanted.is_subset(&own) {
                set
            } else if wanted.is_disjoint(&own) {
                continue;
            } else {
                return Err(wrong(format!("`{set}` is a part of several sections; state it for each of them")));
            };
            let density = self.deck.density(&section.material);
            let none = || wrong(format!("the material `{}` has no *DENSITY", section.material));
            out.push((Place::ElementSet(place.to_string()), density.ok_or_else(none)?));
        }
        Ok(out)
    }
}
