//! Materials, sections, contacts, supports and loads of a deck.

use super::boundary::{Change, EqualDisplacements};
use super::card::{Card, Data};
use super::mesh::nodes_of;
use super::steps::{Conditions, Distributed, DistributedKind, Histories};
use super::{material, refused};
use crate::ImportError;
use crate::curve::Curve;
use crate::deck::{ContactPair, Deck, Friction, Law, Load, LoadKind, Place, RigidMotion, Section};
use crate::element::Space;
use crate::mesh::faces_of;
use std::collections::{BTreeMap, BTreeSet};

/// What a surface interaction says of the contacts that name it.
#[derive(Clone, Debug, Default)]
struct Interaction {
    friction: Friction,
}

/// A deck that is being read.
pub(super) struct Model {
    deck: Deck,
    /// The material or interaction that cards describe.
    material: Option<String>,
    interaction: Option<String>,
    interactions: BTreeMap<String, Interaction>,
    /// Contacts with the name of their interaction.
    contacts: Vec<(ContactPair, Option<String>)>,
    amplitudes: BTreeMap<String, (bool, Vec<[f64; 2]>)>,
    orientations: BTreeMap<String, [[f64; 3]; 2]>,
    transformed: BTreeSet<u64>,
    equal: EqualDisplacements,
    histories: Histories,
    rigid_nodes: Vec<RigidNodes>,
    in_step: bool,
    /// Whether loads of the step act at once.
    at_once: bool,
    /// The time at the end of the last step.
    time: f64,
}

/// The nodes that move a rigid body.
#[derive(Clone, Debug)]
struct RigidNodes {
    material: String,
    reference: Option<u64>,
    rotation: Option<u64>,
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
            transformed: BTreeSet::new(),
            equal: EqualDisplacements::default(),
            histories: Histories::default(),
            rigid_nodes: Vec::new(),
            in_step: false,
            at_once: false,
            time: 0.0,
        }
    }

    /// Parameters that are not known are left out, which is said.
    fn only(&mut self, card: &Card, known: &[&str]) {
        for name in card.unknown(known) {
            let message = format!("*{}: the parameter {name} is not known and left out", card.keyword);
            self.deck.remark(card.line, message);
        }
    }

    pub(super) fn read(&mut self, card: &Card) -> Result<(), ImportError> {
        match card.name().as_str() {
            "NODE" | "ELEMENT" | "NSET" | "ELSET" | "SURFACE" | "SYSTEM" => Ok(()),
            "HEADING" => {
                let line: Vec<&str> = card.data.iter().take(1).flat_map(|d| d.fields.iter().map(String::as_str)).collect();
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
        self.deck.remark(card.line, format!("*{} is left out: temperatures do not exist here, and none changes", card.keyword));
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
        let &[a, b, c, d, e, f] = numbers.get(..6).and_then(|n| n.try_into().ok()).ok_or_else(|| {
            card.wrong(card.data.first(), "expected two points: six numbers")
        })?;
        self.orientations.insert(card.required("NAME")?.to_uppercase(), [[a, b, c], [d, e, f]]);
        Ok(())
    }

    fn transform(&mut self, card: &Card) -> Result<(), ImportError> {
        let set = card.required("NSET")?;
        let none = || card.wrong(None, format!("there is no set of nodes `{set}`"));
        let nodes = self.deck.node_sets.get(set).ok_or_else(none)?.1.clone();
        let is_identity = card.numbers()?.get(..6).is_some_and(|n| {
            n[0] > 0.0 && [n[1], n[2], n[3], n[5]] == [0.0; 4] && n[4] > 0.0
        });
        if card.value("TYPE").is_some_and(|t| !t.eq_ignore_ascii_case("R")) || !is_identity {
            self.transformed.extend(nodes);
        }
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
        let section =
            Section { elements: set.to_string(), material: material.clone(), axes: None, thickness: 1.0, line: card.line };
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

    fn behaviour(&mut self, card: &Card) -> Result<(), ImportError> {
        let kind = card.value("PRESSUREOVERCLOSURE").unwrap_or("HARD").to_uppercase();
        let Some(interaction) = self.interaction.as_ref().and_then(|name| self.interactions.get_mut(name)) else {
            return Err(card.wrong(None, "expected *SURFACE INTERACTION before it"));
        };
        if kind == "TIED" {
            interaction.friction = Friction::Tied;
        }
        self.deck.remark(
            card.line,
            format!("*{}, {kind}: its stiffness is left out; here surfaces do not penetrate", card.keyword),
        );
        Ok(())
    }

    fn friction(&mut self, card: &Card) -> Result<(), ImportError> {
        let Some(interaction) = self.interaction.as_ref().and_then(|name| self.interactions.get_mut(name)) else {
            return Err(card.wrong(None, "expected *SURFACE INTERACTION before it"));
        };
        let mu = card.data.first().map_or(Ok(None), |d| card.number(d, 0))?.unwrap_or(0.0);
        let friction = if mu > 0.0 { Friction::Coulomb(mu) } else { Friction::None };
        if self.in_step && interaction.friction != friction {
            return Err(card.wrong(None, "cannot be imported: coefficients of friction that change do not exist here"));
        }
        if interaction.friction != Friction::Tied {
            interaction.friction = friction;
        }
        if card.data.first().is_some_and(|d| d.fields.len() > 1) {
            let message = format!("*{}: its stick slope is left out; here contacts stick exactly", card.keyword);
            self.deck.remark(card.line, message);
        }
        Ok(())
    }

    fn contact_pair(&mut self, card: &Card) -> Result<(), ImportError> {
        self.only(card, &["INTERACTION", "TYPE", "SMALLSLIDING", "ADJUST"]);
        if card.has("ADJUST") {
            let message = format!("*{}, ADJUST: nodes are not moved to the surface", card.keyword);
            self.deck.remark(card.line, message);
        }
        let interaction = card.value("INTERACTION").map(str::to_uppercase);
        for data in &card.data {
            let pair = self.pair(card, data, Friction::None)?;
            self.contacts.push((pair, interaction.clone()));
        }
        Ok(())
    }

    fn tie(&mut self, card: &Card) -> Result<(), ImportError> {
        for data in &card.data {
            let pair = self.pair(card, data, Friction::Tied)?;
            self.contacts.push((pair, None));
        }
        Ok(())
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
        Ok(ContactPair { name: format!("{slave}_{master}"), slave, master, friction, line: data.line })
    }

    fn amplitude(&mut self, card: &Card) -> Result<(), ImportError> {
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

    fn equation(&mut self, card: &Card) -> Result<(), ImportError> {
        let mut rest = card.data.iter();
        while let Some(head) = rest.next() {
            let count = card.whole(head, 0, "the number of terms")? as usize;
            let mut terms: Vec<(u64, usize, f64)> = Vec::new();
            while terms.len() < count {
                let data = rest.next().ok_or_else(|| card.wrong(head, "terms are missing"))?;
                for k in (0..data.fields.len()).step_by(3).filter(|k| data.fields.get(k + 2).is_some()) {
                    let coefficient = card.required_number(data, k + 2, "a coefficient")?;
                    let node = card.whole(data, k, "the number of a node")?;
                    terms.push((node, card.whole(data, k + 1, "a direction")? as usize, coefficient));
                }
                if data.fields.len() < 3 {
                    return Err(card.wrong(data, "expected node, direction, coefficient"));
                }
            }
            match terms[..] {
                [(a, d, p), (b, e, q)] if d == e && p == -q && (1..=3).contains(&d) => self.equal.join(d - 1, [a, b]),
                _ => {
                    return Err(card.wrong(
                        head,
                        "cannot be imported: only equal displacements of two nodes in the same direction exist here, such as \
                         4,3,1.,3,3,-1.",
                    ));
                }
            }
        }
        Ok(())
    }

    fn renew(&mut self, card: &Card, what: Conditions) {
        if card.value("OP").is_some_and(|v| v.eq_ignore_ascii_case("NEW")) {
            self.histories.renew(what, card.line);
        }
    }

    fn boundary(&mut self, card: &Card) -> Result<(), ImportError> {
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
                if self.transformed.contains(&node) && !(first == 1 && last >= 3 && value == 0.0) {
                    return Err(card.wrong(
                        data,
                        format!("cannot be imported: the node {node} has directions of its own by *TRANSFORM"),
                    ));
                }
                for direction in first..=last {
                    if direction as usize <= dimension || self.reference(node) {
                        self.histories.support(node, direction as usize - 1, &target, value, &change);
                    }
                }
            }
        }
        Ok(())
    }

    fn nodal_load(&mut self, card: &Card) -> Result<(), ImportError> {
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
                if self.transformed.contains(&node) {
                    let message = format!("cannot be imported: the node {node} has directions of its own by *TRANSFORM");
                    return Err(card.wrong(data, message));
                }
                self.histories.force(node, direction - 1, &data.fields[0], value, &change);
            }
        }
        Ok(())
    }

    fn distributed_load(&mut self, card: &Card) -> Result<(), ImportError> {
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

    fn step(&mut self, card: &Card) -> Result<(), ImportError> {
        self.only(card, &["NLGEOM", "INC", "AMPLITUDE", "NAME", "UNSYMM", "INCF", "TURBULENCEMODEL", "SHOCKSMOOTHING"]);
        if card.has("PERTURBATION") {
            return Err(card.wrong(None, "cannot be imported: PERTURBATION, steps about a loaded state, does not exist here"));
        }
        if card.has("NLGEOM") && !card.value("NLGEOM").is_some_and(|v| v.eq_ignore_ascii_case("NO")) {
            self.deck.finite_strain = true;
        }
        self.at_once = card.value("AMPLITUDE").is_some_and(|v| v.eq_ignore_ascii_case("STEP"));
        self.in_step = true;
        self.interaction = None;
        Ok(())
    }

    fn end_step(&mut self) -> Result<(), ImportError> {
        if let Some((node, line)) = self.histories.end_step() {
            let message = format!("cannot be imported: the node {node} is released here; supports hold at all times");
            return Err(ImportError::new(&self.deck.file, line, format!("*BOUNDARY, OP=NEW: {message}")));
        }
        self.in_step = false;
        self.at_once = false;
        self.time = self.histories.steps.last().map_or(0.0, |s| s.to);
        Ok(())
    }

    /// Whether a node moves a rigid body.
    fn reference(&self, node: u64) -> bool {
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
                pair.friction = self.interactions.get(&interaction).ok_or_else(none)?.friction.clone();
            }
            self.deck.contacts.push(pair);
        }
        for RigidNodes { material, reference, rotation } in &self.rigid_nodes {
            let mut motion = RigidMotion::default();
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
        let tied = self.equal.apply(&mut self.histories.supports);
        self.deck.supports = self.histories.supports.supports(&self.deck);
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
                    let none = || ImportError::new(&self.deck.file, None, format!("*DSLOAD: there is no surface `{on}`"));
                    let name = self.deck.surfaces.get(on).ok_or_else(none)?.0.to_string();
                    out.push(Load { on: Place::Surface(name), kind: LoadKind::Pressure(curve.clone()) });
                }
                DistributedKind::Body(axis) => out.push(Load {
                    on: Place::ElementSet(on.clone()),
                    kind: LoadKind::BodyForce(along(axis, curve)),
                }),
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
            let density = self.deck.materials.get(&section.material).and_then(|(_, m)| m.density);
            let none = || wrong(format!("the material `{}` has no *DENSITY", section.material));
            out.push((Place::ElementSet(place.to_string()), density.ok_or_else(none)?));
        }
        Ok(out)
    }
}
