//! Supports, loads and steps.

use super::boundary::Change;
use super::card::Card;
use super::mesh::nodes_of;
use super::model::Model;
use super::steps::{Conditions, Distributed, DistributedKind};
use crate::ImportError;

impl Model {
    pub(super) fn amplitude(&mut self, card: &Card) -> Result<(), ImportError> {
        let definition = card.value("DEFINITION").unwrap_or("TABULAR").to_uppercase();
        if definition != "TABULAR" {
            return Err(card.wrong(None, format!("DEFINITION={definition}: only TABULAR is read")));
        }
        let name = card.required("NAME")?.to_uppercase();
        let numbers = card.numbers()?;
        let points = numbers.chunks(2).filter_map(|p| Some([*p.first()?, *p.get(1)?])).collect();
        let total = card.value("TIME").is_some_and(|t| t.to_uppercase().starts_with("TOTAL"));
        self.amplitudes.insert(name, (total, points));
        Ok(())
    }

    /// How the values of a card change within their step.
    fn change(&self, card: &Card) -> Result<Change, ImportError> {
        let Some(name) = card.value("AMPLITUDE") else {
            return Ok(if self.at_once { Change::Jump } else { Change::Ramp });
        };
        let none = || card.wrong(None, format!("there is no *AMPLITUDE `{name}`"));
        let (total, points) = self.amplitudes.get(&name.to_uppercase()).ok_or_else(none)?;
        let start = if *total { self.time } else { 0.0 };
        Ok(Change::Amplitude(points.iter().map(|[t, v]| [t - start, *v]).collect()))
    }

    fn renew(&mut self, card: &Card, what: Conditions) {
        if card.value("OP").is_some_and(|v| v.eq_ignore_ascii_case("NEW")) {
            self.histories.renew(what);
        }
    }

    pub(super) fn boundary(&mut self, card: &Card) -> Result<(), ImportError> {
        self.only(card, &["OP", "AMPLITUDE", "TYPE"]);
        if let Some(kind) = card.value("TYPE").filter(|t| !t.eq_ignore_ascii_case("DISPLACEMENT")) {
            return Err(card.wrong(None, format!("TYPE={kind}: only displacements are prescribed here")));
        }
        if card.has("FIXED") {
            return Err(card.wrong(None, "FIXED: displacements that stay as they are do not exist here"));
        }
        self.renew(card, Conditions::Supports);
        let change = self.change(card)?;
        let dimension = self.deck.space().dimension();
        for data in card.data.iter().filter(|d| d.fields.iter().any(|f| !f.is_empty())) {
            let nodes = nodes_of(card, data, &self.deck)?;
            let target = data.fields[0].clone();
            let label = data.fields.get(1).map_or("", String::as_str).to_uppercase();
            let (first, last) = match label.as_str() {
                "ENCASTRE" | "PINNED" => (1, 3),
                "XSYMM" => (1, 1),
                "YSYMM" => (2, 2),
                "ZSYMM" => (3, 3),
                _ => {
                    let first = card.whole(data, 1, "a direction")?;
                    let stated = data.fields.get(2).is_some_and(|f| !f.is_empty());
                    (first, if stated { card.whole(data, 2, "a direction")? } else { first })
                }
            };
            if first == 0 || last < first || first > 6 {
                return Err(card.wrong(data, format!("directions {first} to {last}: valid are 1 to 6")));
            }
            let value = card.number(data, 3)?.unwrap_or(0.0);
            for node in nodes {
                for direction in first..=last {
                    if direction as usize <= dimension || self.reference(node) {
                        self.histories.support(node, direction as usize - 1, &target, value, &change);
                    }
                }
            }
        }
        Ok(())
    }

    pub(super) fn nodal_load(&mut self, card: &Card) -> Result<(), ImportError> {
        self.only(card, &["OP", "AMPLITUDE"]);
        self.renew(card, Conditions::Forces);
        let change = self.change(card)?;
        for data in card.data.iter().filter(|d| d.fields.iter().any(|f| !f.is_empty())) {
            let nodes = nodes_of(card, data, &self.deck)?;
            let direction = card.whole(data, 1, "a direction")? as usize;
            let value = card.required_number(data, 2, "the force")?;
            if !(1..=3).contains(&direction) {
                return Err(card.wrong(data, format!("direction {direction}: valid are 1 to 3; nodes have no moments")));
            }
            for node in nodes {
                self.histories.force(node, direction - 1, &data.fields[0], value, &change);
            }
        }
        Ok(())
    }

    pub(super) fn distributed_load(&mut self, card: &Card) -> Result<(), ImportError> {
        self.only(card, &["OP", "AMPLITUDE"]);
        self.renew(card, Conditions::Distributed);
        let change = self.change(card)?;
        for data in card.data.iter().filter(|d| d.fields.iter().any(|f| !f.is_empty())) {
            let on = data.fields[0].clone();
            let label = data.fields.get(1).map_or("", String::as_str).to_uppercase();
            let value = card.required_number(data, 2, "the value")?;
            let face = label.strip_prefix('P').and_then(|f| f.parse::<usize>().ok());
            let of_surface = card.name() == "DSLOAD";
            let kind = match label.as_str() {
                "P" if of_surface => DistributedKind::Surface,
                "BX" => DistributedKind::Body(0),
                "BY" => DistributedKind::Body(1),
                "BZ" => DistributedKind::Body(2),
                "GRAV" => {
                    let mut direction = [0.0; 3];
                    for (k, d) in direction.iter_mut().enumerate() {
                        *d = card.number(data, 3 + k)?.unwrap_or(0.0);
                    }
                    for (k, d) in direction.iter().enumerate().filter(|(_, d)| **d != 0.0) {
                        let load = Distributed { on: on.clone(), kind: DistributedKind::Gravity(k) };
                        self.histories.distributed(load, value * d, &change);
                    }
                    continue;
                }
                _ => match face.filter(|_| !of_surface) {
                    Some(face) => DistributedKind::Face(face),
                    None => {
                        let valid = "valid are P1 to P6, BX, BY, BZ, GRAV, and P of *DSLOAD";
                        return Err(card.wrong(data, format!("the load `{label}` does not exist here: {valid}")));
                    }
                },
            };
            self.histories.distributed(Distributed { on, kind }, value, &change);
        }
        Ok(())
    }

    pub(super) fn step(&mut self, card: &Card) -> Result<(), ImportError> {
        self.only(card, &["NLGEOM", "INC", "AMPLITUDE", "NAME", "UNSYMM", "INCF", "TURBULENCEMODEL", "SHOCKSMOOTHING"]);
        if card.has("PERTURBATION") {
            return Err(
                card.wrong(None, "cannot be imported: PERTURBATION, steps about a loaded state, does not exist here")
            );
        }
        if card.has("NLGEOM") && !card.value("NLGEOM").is_some_and(|v| v.eq_ignore_ascii_case("NO")) {
            self.deck.finite_strain = true;
        }
        self.at_once = card.value("AMPLITUDE").is_some_and(|v| v.eq_ignore_ascii_case("STEP"));
        self.in_step = true;
        self.interaction = None;
        Ok(())
    }

    pub(super) fn end_step(&mut self) -> Result<(), ImportError> {
        self.histories.end_step();
        self.in_step = false;
        self.at_once = false;
        self.time = self.histories.steps.last().map_or(0.0, |s| s.to);
        Ok(())
    }
}
