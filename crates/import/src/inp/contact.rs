//! Contacts: pairs of surfaces and what happens between them.

use super::card::{Card, Data};
use super::model::Model;
use crate::ImportError;
use crate::adjust::Adjustment;
use crate::curve::{Curve, JUMP};
use crate::deck::{ContactPair, Friction, Stiffness};

impl Model {
    pub(super) fn behaviour(&mut self, card: &Card) -> Result<(), ImportError> {
        let kind = card.value("PRESSUREOVERCLOSURE").unwrap_or("HARD").to_uppercase();
        let Some(interaction) = self.interaction.as_ref().and_then(|name| self.interactions.get_mut(name)) else {
            return Err(card.wrong(None, "expected *SURFACE INTERACTION before it"));
        };
        if self.in_step && (kind == "TIED") != matches!(interaction.friction, Friction::Tied { .. }) {
            return Err(card.wrong(None, "cannot be imported: surfaces that are tied in some steps only"));
        }
        if kind == "TIED" {
            interaction.friction = Friction::Tied { within: None };
            return Ok(());
        }
        // Hard contact is what there is here.
        if kind != "HARD" {
            let stated = card.data.first().map_or(Ok(None), |d| card.number(d, 0))?;
            interaction.stiffness = None;
            match stated.filter(|k| kind == "LINEAR" && *k > 0.0) {
                Some(value) => interaction.stiffness = Some(Stiffness { value, line: card.line }),
                None => {
                    let message =
                        format!("*{}, {kind}: its stiffness is left out; here surfaces do not penetrate", card.keyword);
                    self.deck.remark(card.line, message);
                }
            }
        }
        Ok(())
    }

    pub(super) fn friction(&mut self, card: &Card) -> Result<(), ImportError> {
        let Some(interaction) = self.interaction.as_ref().and_then(|name| self.interactions.get_mut(name)) else {
            return Err(card.wrong(None, "expected *SURFACE INTERACTION before it"));
        };
        if matches!(interaction.friction, Friction::Tied { .. }) {
            return Ok(());
        }
        let mu = card.data.first().map_or(Ok(None), |d| card.number(d, 0))?.unwrap_or(0.0);
        let before = match &interaction.friction {
            Friction::Coulomb(curve) => Some(curve.clone()),
            _ => None,
        };
        let friction = match before {
            // From the start of the step on.
            before if self.in_step && self.time > 0.0 => {
                let mut curve = before.unwrap_or_else(|| Curve::constant(0.0));
                curve.push(self.time, curve.at(self.time));
                curve.push(self.time * (1.0 + JUMP), mu);
                Friction::Coulomb(curve)
            }
            _ if mu > 0.0 => Friction::Coulomb(Curve::constant(mu)),
            _ => Friction::None,
        };
        interaction.friction = friction;
        if card.data.first().is_some_and(|d| d.fields.len() > 1) {
            let message = format!("*{}: its stick slope is left out; here contacts stick exactly", card.keyword);
            self.deck.remark(card.line, message);
        }
        Ok(())
    }

    pub(super) fn contact_pair(&mut self, card: &Card) -> Result<(), ImportError> {
        self.only(card, &["INTERACTION", "TYPE", "SMALLSLIDING", "ADJUST"]);
        let interaction = card.value("INTERACTION").map(str::to_uppercase);
        for data in &card.data {
            let pair = self.pair(card, data, Friction::None)?;
            if let Some(adjust) = card.value("ADJUST") {
                let (within, nodes) = match adjust.parse::<f64>() {
                    Ok(within) => (Some(within), None),
                    Err(_) => (None, Some(self.node_set(card, adjust)?)),
                };
                let (surface, to) = (pair.slave.clone(), pair.master.clone());
                self.deck.adjustments.push(Adjustment { surface, to, within, nodes });
            }
            self.contacts.push((pair, interaction.clone()));
        }
        Ok(())
    }

    pub(super) fn tie(&mut self, card: &Card) -> Result<(), ImportError> {
        self.only(card, &["NAME", "ADJUST", "POSITIONTOLERANCE"]);
        let within = card.value("POSITIONTOLERANCE").map(|text| {
            text.parse::<f64>().map_err(|_| card.wrong(None, format!("POSITION TOLERANCE={text}: expected a number")))
        });
        let within = within.transpose()?.filter(|within| *within > 0.0);
        for data in &card.data {
            let pair = self.pair(card, data, Friction::Tied { within })?;
            self.contacts.push((pair, None));
        }
        Ok(())
    }

    /// The name of a set of nodes as the deck has it.
    fn node_set(&self, card: &Card, name: &str) -> Result<String, ImportError> {
        let none = || card.wrong(None, format!("there is no set of nodes `{name}`"));
        self.deck.node_sets.get(name).map(|(name, _)| name.to_string()).ok_or_else(none)
    }

    /// The two surfaces of a line: slave, master.
    fn pair(&self, card: &Card, data: &Data, friction: Friction) -> Result<ContactPair, ImportError> {
        let surface = |k: usize| {
            let name = data.fields.get(k).map_or("", String::as_str);
            let none = || {
                card.wrong(data, format!("there is no surface `{name}`; the deck has {}", self.deck.surfaces.names()))
            };
            self.deck.surfaces.get(name).map(|(name, _)| name.to_string()).ok_or_else(none)
        };
        let (slave, master) = (surface(0)?, surface(1)?);
        Ok(ContactPair { name: format!("{slave}_{master}"), slave, master, friction, stiffness: None, line: data.line })
    }
}
