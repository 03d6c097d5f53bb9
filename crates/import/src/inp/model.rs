//! Materials, sections, contacts, supports and loads of a deck.

use super::boundary::EqualDisplacements;
use super::card::Card;
use super::equation::StatedEquation;
use super::steps::Histories;
use super::{material, refused};
use crate::ImportError;
use crate::deck::{Axes, ContactPair, Deck, Friction, Law, Section, Stiffness};
use std::collections::BTreeMap;

/// What a surface interaction says of the contacts that name it.
#[derive(Clone, Debug, Default)]
pub(super) struct Interaction {
    pub(super) friction: Friction,
    pub(super) stiffness: Option<Stiffness>,
}

/// A deck that is being read.
pub(super) struct Model {
    pub(super) deck: Deck,
    /// The material or interaction that cards describe.
    pub(super) material: Option<String>,
    pub(super) interaction: Option<String>,
    pub(super) interactions: BTreeMap<String, Interaction>,
    /// Contacts with the name of their interaction.
    pub(super) contacts: Vec<(ContactPair, Option<String>)>,
    pub(super) amplitudes: BTreeMap<String, (bool, Vec<[f64; 2]>)>,
    pub(super) orientations: BTreeMap<String, [[f64; 3]; 2]>,
    /// Axes of their own of nodes.
    pub(super) transformed: BTreeMap<u64, Axes>,
    pub(super) equal: EqualDisplacements,
    /// Equations between displacements that are not equal.
    pub(super) equations: Vec<StatedEquation>,
    pub(super) histories: Histories,
    pub(super) rigid_nodes: Vec<RigidNodes>,
    pub(super) in_step: bool,
    /// Whether loads of the step act at once.
    pub(super) at_once: bool,
    /// The time at the end of the last step.
    pub(super) time: f64,
}

/// The nodes that move a rigid body.
#[derive(Clone, Debug)]
pub(super) struct RigidNodes {
    pub(super) material: String,
    pub(super) reference: Option<u64>,
    pub(super) rotation: Option<u64>,
}

impl Model {
    pub(super) fn new(deck: Deck) -> Self {
        Self {
            deck,
            material: None,
            interaction: None,
            interactions: BTreeMap::new(),
            contacts: Vec::new(),
            amplitudes: BTreeMap::new(),
            orientations: BTreeMap::new(),
            transformed: BTreeMap::new(),
            equal: EqualDisplacements::default(),
            equations: Vec::new(),
            histories: Histories::default(),
            rigid_nodes: Vec::new(),
            in_step: false,
            at_once: false,
            time: 0.0,
        }
    }

    /// Parameters that are not known are left out, which is said.
    pub(super) fn only(&mut self, card: &Card, known: &[&str]) {
        for name in card.unknown(known) {
            let message = format!("*{}: the parameter {name} is not known and left out", card.keyword);
            self.deck.remark(card.line, message);
        }
    }

    pub(super) fn read(&mut self, card: &Card) -> Result<(), ImportError> {
        match card.name().as_str() {
            "NODE" | "ELEMENT" | "NSET" | "ELSET" | "SURFACE" | "SYSTEM" => Ok(()),
            "HEADING" => {
                let line: Vec<&str> =
                    card.data.iter().take(1).flat_map(|d| d.fields.iter().map(String::as_str)).collect();
                self.deck.title = Some(line.join(", ")).filter(|t| !t.is_empty());
                Ok(())
            }
            "MATERIAL" => {
                let name = card.required("NAME")?.to_string();
                self.deck.materials.entry(&name).line = card.line;
                self.material = Some(name);
                Ok(())
            }
            "ELASTIC" => self.law(card, material::elastic),
            "HYPERELASTIC" => {
                self.deck.finite_strain = true;
                self.law(card, material::hyperelastic)
            }
            "PLASTIC" => self.plastic(card),
            "DENSITY" => self.density(card),
            "EXPANSION" | "INITIALCONDITIONS" => self.thermal(card),
            "SOLIDSECTION" => self.section(card),
            "ORIENTATION" => self.orientation(card),
            "TRANSFORM" => self.transform(card),
            "RIGIDBODY" => self.rigid_body(card),
            "SURFACEINTERACTION" => {
                let name = card.required("NAME")?.to_uppercase();
                self.interactions.entry(name.clone()).or_default();
                self.interaction = Some(name);
                Ok(())
            }
            "SURFACEBEHAVIOR" => self.behaviour(card),
            "FRICTION" => self.friction(card),
            "CHANGEFRICTION" | "CHANGESURFACEBEHAVIOR" => {
                self.interaction = Some(card.required("INTERACTION")?.to_uppercase());
                Ok(())
            }
            "CONTACTPAIR" => self.contact_pair(card),
            "TIE" => self.tie(card),
            "AMPLITUDE" => self.amplitude(card),
            "EQUATION" => self.equation(card),
            "BOUNDARY" => self.boundary(card),
            "CLOAD" => self.nodal_load(card),
            "DLOAD" | "DSLOAD" => self.distributed_load(card),
            "STEP" => self.step(card),
            "STATIC" => {
                let remark = self.histories.analysis(card)?;
                remark.into_iter().for_each(|r| self.deck.remark(card.line, r));
                Ok(())
            }
            "ENDSTEP" => self.end_step(),
            name if refused::is_without_influence(name) => Ok(()),
            name => Err(match refused::reason(name) {
                Some(reason) => card.wrong(None, format!("cannot be imported: {reason}")),
                None => card.wrong(None, "this keyword is not known"),
            }),
        }
    }

    fn law(
        &mut self,
        card: &Card,
        read: impl Fn(&Card) -> Result<material::Read, ImportError>,
    ) -> Result<(), ImportError> {
        let name = self.material.clone().ok_or_else(|| card.wrong(None, "expected *MATERIAL before it"))?;
        let material::Read { law, remark } = read(card)?;
        self.deck.materials.entry(&name).law = Some(law);
        remark.into_iter().for_each(|r| self.deck.remark(card.line, r));
        Ok(())
    }

    fn plastic(&mut self, card: &Card) -> Result<(), ImportError> {
        let name = self.material.clone().unwrap_or_default();
        let elastic = self.deck.materials.get(&name).and_then(|(_, m)| m.law.clone());
        self.law(card, |card| material::plastic(card, elastic.as_ref()))
    }

    fn density(&mut self, card: &Card) -> Result<(), ImportError> {
        let name = self.material.clone().ok_or_else(|| card.wrong(None, "expected *MATERIAL before it"))?;
        self.deck.materials.entry(&name).density = card.data.first().map_or(Ok(None), |d| card.number(d, 0))?;
        Ok(())
    }

    /// Expansion and temperatures at the start do nothing as long as no temperature changes.
    fn thermal(&mut self, card: &Card) -> Result<(), ImportError> {
        let kind = card.value("TYPE").unwrap_or("TEMPERATURE").to_uppercase();
        if card.name() == "INITIALCONDITIONS" && kind != "TEMPERATURE" {
            return Err(card.wrong(None, format!("TYPE={kind}: initial conditions of this kind do not exist here")));
        }
        self.deck.remark(
            card.line,
            format!("*{} is left out: temperatures are not imported, and none changes", card.keyword),
        );
        Ok(())
    }

    fn section(&mut self, card: &Card) -> Result<(), ImportError> {
        self.only(card, &["ELSET", "MATERIAL", "ORIENTATION", "CONTROLS"]);
        let axes = match card.value("ORIENTATION") {
            None => None,
            Some(name) => {
                let none = || card.wrong(None, format!("there is no *ORIENTATION `{name}` before it"));
                Some(*self.orientations.get(&name.to_uppercase()).ok_or_else(none)?)
            }
        };
        let thickness = card.data.first().map_or(Ok(None), |d| card.number(d, 0))?;
        self.deck.sections.push(Section {
            elements: card.required("ELSET")?.to_string(),
            material: card.required("MATERIAL")?.to_string(),
            axes,
            thickness: thickness.filter(|t| *t > 0.0).unwrap_or(1.0),
            line: card.line,
        });
        Ok(())
    }

    /// Axes by a point on the first one and a point in the plane of the first two.
    fn orientation(&mut self, card: &Card) -> Result<(), ImportError> {
        let system = card.value("SYSTEM").unwrap_or("RECTANGULAR").to_uppercase();
        if !system.starts_with('R') {
            return Err(card.wrong(None, format!("SYSTEM={system}: only RECTANGULAR is read")));
        }
        let numbers = card.numbers()?;
        let &[a, b, c, d, e, f] = numbers
            .get(..6)
            .and_then(|n| n.try_into().ok())
            .ok_or_else(|| card.wrong(card.data.first(), "expected two points: six numbers"))?;
        self.orientations.insert(card.required("NAME")?.to_uppercase(), [[a, b, c], [d, e, f]]);
        Ok(())
    }

    fn rigid_body(&mut self, card: &Card) -> Result<(), ImportError> {
        let Some(set) = card.value("ELSET") else {
            return Err(card.wrong(None, "only rigid bodies of elements (ELSET) are read"));
        };
        let material = format!("rigid {set}");
        let entry = self.deck.materials.entry(&material);
        (entry.law, entry.line) = (Some(Law::Rigid), card.line);
        self.deck.sections.retain(|s| !s.elements.eq_ignore_ascii_case(set));
        let section = Section {
            elements: set.to_string(),
            material: material.clone(),
            axes: None,
            thickness: 1.0,
            line: card.line,
        };
        self.deck.sections.push(section);
        let node = |name: &str| -> Result<Option<u64>, ImportError> {
            let parse = |text: &str| {
                text.parse().map_err(|_| card.wrong(None, format!("{name}={text}: expected the number of a node")))
            };
            card.value(name).map(parse).transpose()
        };
        let (reference, rotation) = (node("REFNODE")?, node("ROTNODE")?);
        self.deck.rigid.entry(&material);
        self.rigid_nodes.push(RigidNodes { material, reference, rotation });
        Ok(())
    }
}
