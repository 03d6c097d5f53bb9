//! A rope of straight elements as a body.
//!
//! There are three unknowns for each node, and one for each pulley: the length of rope that has run through it towards the
//! end. Weight and other forces per length act per unstrained length.
//!
//! Slack elements have no stiffness. For the tangent alone, never for the forces, they get that of an element under
//! tension: the largest of the rope, or `EA` times the root of round-off where all of it is slack. What solves the
//! equations is not changed by it.

use super::element::{Drive, Stretched, stretched};
use super::winch::Winch;
use crate::centreline::{Centreline, Closure, Continuity};
use crate::curve_body::{self, CurveBody};
use crate::mass;
use crate::path::Sampled;
use crate::place::{self, Line, Part};
use crate::quaternion::axis;
use signorini_geometry::{Matrix, Point, Vector};
use signorini_mechanics::Curve;
use signorini_mechanics::body::{
    Body, BodyError, BodyFields, BodyState, BoxOfMaterial, Constitution, Constraint, ContactSides, Contribution,
    Elimination, Function, Hold, Inertial, Kinematics, Load, Mass, Master, Order, PlaceError, Sampling, Site, Slack,
    SlavePoint,
};

/// A rope that cannot be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ChainError {
    #[error("{name} = {value}: {valid}")]
    Number { name: &'static str, value: f64, valid: &'static str },
    #[error("node {node} cannot be a pulley: {reason}")]
    Pulley { node: usize, reason: &'static str },
    #[error("there is no element {element}: the rope has {count}")]
    NoElement { element: usize, count: usize },
    #[error("a rope of straight elements requires a path sampled with continuity C0")]
    Smooth,
}

/// How long a rope is without tension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ReferenceLength {
    /// As long as its path.
    Path,
    /// Of this length in all, each element by its share of the path.
    Length(f64),
    /// Under this tension along its path.
    Pretension(f64),
}

impl ReferenceLength {
    /// Unstrained length per length of the path.
    pub(crate) fn ratio(self, path: f64, stiffness: f64) -> Result<f64, ChainError> {
        match self {
            ReferenceLength::Path => Ok(1.0),
            ReferenceLength::Length(length) if length > 0.0 && length.is_finite() => Ok(length / path),
            ReferenceLength::Length(value) => {
                Err(ChainError::Number { name: "unstrained_length", value, valid: "valid are positive numbers" })
            }
            ReferenceLength::Pretension(tension) if tension >= 0.0 && tension.is_finite() => {
                Ok(stiffness / (stiffness + tension))
            }
            ReferenceLength::Pretension(value) => Err(ChainError::Number {
                name: "pretension",
                value,
                valid: "valid are 0 and positive numbers: a rope carries tension only",
            }),
        }
    }
}

pub(crate) fn positive(name: &'static str, value: f64) -> Result<(), ChainError> {
    let is_valid = value > 0.0 && value.is_finite();
    if is_valid { Ok(()) } else { Err(ChainError::Number { name, value, valid: "valid are positive numbers" }) }
}

pub(crate) fn check_radius(value: f64) -> Result<(), ChainError> {
    let is_valid = value >= 0.0 && value.is_finite();
    let valid = "valid are 0 and positive numbers";
    if is_valid { Ok(()) } else { Err(ChainError::Number { name: "radius", value, valid }) }
}

/// A rope of straight elements.
#[derive(Clone, Debug)]
pub struct Chain {
    pub(super) name: String,
    /// Its lengths are the unstrained ones.
    pub(super) line: Centreline,
    pub(super) stiffness: f64,
    /// A spring beside, by its force at the unstrained length, for now.
    tightened: f64,
    /// The part of its stiffness that it has for now.
    softened: f64,
    pub(super) radius: f64,
    pub(super) drives: Vec<Drive>,
    /// Nodes through which the rope runs without friction.
    pub(super) pulleys: Vec<usize>,
    pub(super) winch: Option<Winch>,
    pub(super) start: Vec<f64>,
    mass_per_length: Option<f64>,
}

impl Chain {
    /// A rope along a path: `stiffness` is `EA`, `radius` what touches.
    ///
    /// # Errors
    /// A stiffness, length, tension or radius out of range, a path sampled as a smooth one.
    pub fn new(
        name: &str,
        path: &Sampled,
        stiffness: f64,
        rest: ReferenceLength,
        radius: f64,
    ) -> Result<Self, ChainError> {
        if path.continuity != Continuity::C0 {
            return Err(ChainError::Smooth);
        }
        positive("stiffness", stiffness)?;
        check_radius(radius)?;
        let n = path.positions.len();
        // A chord is never longer than the path: with the lengths of the path a curved rope would start slack.
        let chords: Vec<f64> =
            (0..path.lengths.len()).map(|e| (path.positions[(e + 1) % n] - path.positions[e]).norm()).collect();
        let ratio = rest.ratio(chords.iter().sum(), stiffness)?;
        let lengths: Vec<f64> = chords.iter().map(|h| h * ratio).collect();
        Ok(Chain {
            name: name.to_string(),
            drives: vec![Drive::Elastic; lengths.len()],
            line: Centreline::new(lengths, path.closure, Continuity::C0, [3, 3]),
            stiffness,
            tightened: 0.0,
            softened: 1.0,
            radius,
            pulleys: Vec::new(),
            winch: None,
            start: path.positions.iter().flat_map(|p| [p[0], p[1], p[2]]).collect(),
            mass_per_length: None,
        })
    }

    /// The rope with a mass per unstrained length.
    pub fn with_mass(mut self, mass_per_length: f64) -> Self {
        self.mass_per_length = Some(mass_per_length);
        self
    }

    /// Lets the rope run without friction through pulleys at nodes, which are to be held or borne.
    ///
    /// # Errors
    /// Nodes without two elements, or next to each other.
    pub fn with_pulleys(mut self, nodes: &[usize]) -> Result<Self, ChainError> {
        for (k, &node) in nodes.iter().enumerate() {
            let reason = match self.line.closure {
                _ if node >= self.line.nodes() => Some("there is no such node"),
                Closure::Open if node == 0 || node + 1 == self.line.nodes() => Some("it is an end of the rope"),
                _ if nodes[..k].contains(&node) => Some("it is already a pulley"),
                _ => None,
            };
            if let Some(reason) = reason {
                return Err(ChainError::Pulley { node, reason });
            }
        }
        self.pulleys = nodes.to_vec();
        self.start.extend(std::iter::repeat_n(0.0, nodes.len()));
        Ok(self)
    }

    /// Winds an element up or off: its unstrained length from now on.
    ///
    /// # Errors
    /// No such element, a length that is not positive.
    pub fn set_unstrained_length(&mut self, element: usize, length: f64) -> Result<(), ChainError> {
        positive("unstrained_length", length)?;
        self.check_element(element)?;
        self.drives[element] = Drive::Elastic;
        let mut lengths = self.line.lengths.clone();
        lengths[element] = length;
        self.line = Centreline::new(lengths, self.line.closure, Continuity::C0, [3, 3]);
        Ok(())
    }

    /// Keeps an element, wound by a winch, under a tension.
    ///
    /// # Errors
    /// No such element, a negative tension.
    pub fn set_tension(&mut self, element: usize, tension: f64) -> Result<(), ChainError> {
        self.check_element(element)?;
        if tension < 0.0 || !tension.is_finite() {
            let valid = "valid are 0 and positive numbers: a rope carries tension only";
            return Err(ChainError::Number { name: "tension", value: tension, valid });
        }
        self.drives[element] = Drive::Tension(tension);
        Ok(())
    }

    fn check_element(&self, element: usize) -> Result<(), ChainError> {
        let count = self.line.elements();
        if element < count { Ok(()) } else { Err(ChainError::NoElement { element, count }) }
    }

    /// Pulleys at the ends of an element: the sign with which rope that runs through makes it longer.
    fn pulleys_of(&self, element: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let [a, b] = self.line.ends(element);
        self.pulleys.iter().enumerate().filter_map(move |(k, &node)| match node {
            n if n == a => Some((k, 1.0)),
            n if n == b => Some((k, -1.0)),
            _ => None,
        })
    }

    /// The unstrained length of an element in a state.
    pub fn unstrained_length(&self, state: &BodyState, element: usize) -> f64 {
        let through = |k: usize| state.configuration[3 * self.line.nodes() + k];
        self.wound_length(state, element) + self.pulleys_of(element).map(|(k, sign)| sign * through(k)).sum::<f64>()
    }

    fn element(&self, state: &BodyState, element: usize) -> (Vector<3>, Stretched) {
        let [a, b] = self.line.ends(element).map(|n| self.line.position(&state.configuration, n));
        let unstrained = self.unstrained_length(state, element);
        let mut found = stretched(&(b - a), self.softened * self.stiffness, unstrained, self.drives[element]);
        if self.tightened > 0.0 {
            let density = self.tightened / unstrained;
            found.energy += 0.5 * density * (b - a).norm_squared();
            found.force += (b - a) * density;
            found.stiffness += Matrix::<3>::identity() * density;
        }
        (b - a, found)
    }

    /// The tension of each element that is out: zero where it is slack.
    pub fn tensions(&self, state: &BodyState) -> Vec<f64> {
        self.active(state).map(|e| self.element(state, e).1.tension).collect()
    }

    /// Elements that are out, and without tension.
    pub fn slack(&self, state: &BodyState) -> Vec<usize> {
        let list = self.active(state).zip(self.tensions(state));
        list.filter(|(_, t)| *t == 0.0).map(|(e, _)| e).collect()
    }

    /// The number of elements.
    pub fn elements(&self) -> usize {
        self.line.elements()
    }

    /// Position of a node.
    pub fn position(&self, state: &BodyState, node: usize) -> Vector<3> {
        self.line.position(&state.configuration, node)
    }

    /// Both ends.
    fn ends(&self) -> Part {
        Part::Nodes(vec![0, self.line.nodes() - 1])
    }

    /// The tangent at a node is that of the parabola through it and its neighbours, by their unstrained distances: with one
    /// of its chords, the axes of friction would be off by half of the turn there.
    fn at_node(&self, state: &BodyState, node: usize, placed: SlavePoint) -> SlavePoint {
        let (nodes, count) = (self.line.nodes(), self.line.elements());
        let (before, after) = match self.line.closure {
            Closure::Open if node == 0 || node + 1 == nodes => return placed,
            Closure::Open => (node - 1, node + 1),
            Closure::Closed => ((node + count - 1) % count, (node + 1) % count),
        };
        let [h, k] = [self.line.lengths[before], self.line.lengths[node]];
        let slopes = [(before, -k / h), (node, k / h - h / k), (after, h / k)];
        let position = |n: usize| self.line.position(&state.configuration, n);
        let tangent = slopes.iter().map(|(n, slope)| position(*n) * *slope).sum();
        let functions = slopes.iter().flat_map(|&(n, slope)| {
            (0..3).map(move |i| {
                let e = axis(i);
                let value = if n == node { e } else { Vector::<3>::zeros() };
                let slopes = [e * slope, Vector::<3>::zeros()];
                Function { unknown: (3 * n + i) as u32, value, slopes, ..Function::default() }
            })
        });
        SlavePoint { tangent: Some(tangent), functions: functions.collect(), ..placed }
    }

    fn line_of<'a>(&'a self, state: &'a BodyState) -> Line<'a> {
        // Weight is that of the rope which is out.
        let shares = self.winch.as_ref().map(|_| {
            let of = |e: usize| self.wound_length(state, e) / self.line.lengths[e];
            (0..self.line.elements()).map(of).collect()
        });
        Line { body: &self.name, line: &self.line, start: &self.start, now: &state.configuration, shares }
    }

    /// A part of the rope, or the nodes that are pulleys: all of them, or one by its number from 1.
    fn part(&self, on: Option<&str>) -> Result<Part, PlaceError> {
        if let Some(rest) = on.and_then(|group| group.strip_prefix("pulley")) {
            let number = rest.strip_prefix('_').and_then(|n| n.parse::<usize>().ok());
            match number.and_then(|n| self.pulleys.get(n.wrapping_sub(1))) {
                Some(node) => return Ok(Part::Nodes(vec![*node])),
                None if rest == "s" && !self.pulleys.is_empty() => return Ok(Part::Nodes(self.pulleys.clone())),
                None => {}
            }
        }
        place::part(&self.name, &self.line, on).map_err(|error| match error {
            PlaceError::Unknown { body, group, mut known } if !self.pulleys.is_empty() => {
                known.extend(std::iter::once("pulleys".to_string()));
                known.extend((1..=self.pulleys.len()).map(|k| format!("pulley_{k}")));
                PlaceError::Unknown { body, group, known }
            }
            other => other,
        })
    }
}

impl CurveBody for Chain {
    fn centreline(&self) -> &Centreline {
        &self.line
    }

    fn radius(&self) -> f64 {
        self.radius
    }

    fn contact_points(&self) -> usize {
        2
    }
}

impl Body for Chain {
    fn name(&self) -> &str {
        &self.name
    }

    fn unknowns(&self) -> usize {
        self.start.len()
    }

    fn start(&self) -> BodyState {
        let internal = self.winch.iter().map(|_| 0.0).collect();
        BodyState { configuration: self.start.clone(), internal }
    }

    fn advance(&self, state: &BodyState, step: &[f64], share: f64) -> BodyState {
        let configuration = state.configuration.iter().zip(step).map(|(x, s)| x + share * s).collect();
        BodyState { configuration, internal: state.internal.clone() }
    }

    fn internal(&self, state: &BodyState, order: Order, out: &mut Contribution) -> Result<f64, BodyError> {
        let floor = self.softened * self.stiffness * f64::EPSILON.sqrt();
        let slack_tension = self.tensions(state).into_iter().fold(floor, f64::max);
        let mut energy = 0.0;
        for e in self.active(state) {
            let (d, s) = self.element(state, e);
            // No rope is left between a pulley and its neighbour.
            if !d.norm().is_finite() || self.unstrained_length(state, e) <= 0.0 {
                return Err(BodyError::Inverted { body: self.name.clone(), cell: e });
            }
            energy += s.energy;
            let [a, b] = self.line.ends(e).map(|n| 3 * n);
            for i in 0..3 {
                out.forces[a + i] -= s.force[i];
                out.forces[b + i] += s.force[i];
            }
            let pulleys: Vec<(usize, f64)> = self.pulleys_of(e).collect();
            let scalar = |k: usize| 3 * self.line.nodes() + k;
            pulleys.iter().for_each(|&(k, sign)| out.forces[scalar(k)] += sign * s.by_length.0);
            if order == Order::First {
                continue;
            }
            // With the spring beside, nothing is without stiffness.
            let is_slack = s.tension == 0.0 && self.tightened == 0.0;
            let own = self.line.lengths[e];
            let stiffness = if is_slack { Matrix::<3>::identity() * (slack_tension / own) } else { s.stiffness };
            let second = if is_slack { self.stiffness / own } else { s.by_length.1 };
            let n = 6 + pulleys.len();
            let mut unknowns: Vec<u32> = (0..3).map(|i| (a + i) as u32).chain((0..3).map(|i| (b + i) as u32)).collect();
            unknowns.extend(pulleys.iter().map(|(k, _)| scalar(*k) as u32));
            let mut block = vec![0.0; n * n];
            for i in 0..6 {
                let side = |i: usize| if i < 3 { -1.0 } else { 1.0 };
                for j in 0..6 {
                    block[i * n + j] = side(i) * side(j) * stiffness[(i % 3, j % 3)];
                }
                for (p, (_, sign)) in pulleys.iter().enumerate() {
                    let value = side(i) * sign * s.by_length.2[i % 3];
                    block[i * n + 6 + p] = value;
                    block[(6 + p) * n + i] = value;
                }
            }
            for (p, (_, x)) in pulleys.iter().enumerate() {
                for (q, (_, y)) in pulleys.iter().enumerate() {
                    block[(6 + p) * n + 6 + q] = x * y * second;
                }
            }
            out.add_block(&unknowns, &block);
        }
        Ok(energy)
    }

    fn hold(&self, on: Option<&str>, hold: &Hold<'_>, state: &BodyState) -> Result<Vec<Constraint>, PlaceError> {
        hold.check_components(&self.name)?;
        if hold.rotation.iter().any(Option::is_some) {
            let message = "the ends of a rope have no rotations: only displacements can be prescribed".to_string();
            return Err(PlaceError::Unsuitable { body: self.name.clone(), message });
        }
        let mut out = self.line_of(state).hold(&self.part(on)?, hold);
        // What is on the winch goes with it.
        let on_winch = self.on_winch(state);
        let Some(end) = on_winch
            .first()
            .filter(|end| self.part(on).is_ok_and(|p| p == Part::Nodes(vec![**end]) || p == self.ends()))
        else {
            return Ok(out);
        };
        let reference = self.line.position(&self.start, *end);
        for node in &on_winch[1..] {
            let moved = self.line.position(&state.configuration, *node) - reference;
            for i in 0..3 {
                if let Some(value) = hold.displacement[i] {
                    let violation = moved[i] - value(&reference);
                    out.push(Constraint::of_component(vec![((3 * node + i) as u32, 1.0)], violation, i));
                }
            }
        }
        Ok(out)
    }

    fn load(
        &self,
        on: Option<&str>,
        load: &Load<'_>,
        state: &BodyState,
        order: Order,
        out: &mut Contribution,
    ) -> Result<(), PlaceError> {
        self.line_of(state).load(&self.part(on)?, load, order, out)
    }

    fn sites(&self, on: Option<&str>, sampling: Sampling) -> Result<Vec<Site>, PlaceError> {
        curve_body::sites(self, on, sampling)
    }

    fn placed(&self, state: &BodyState, site: &Site) -> SlavePoint {
        let placed = curve_body::placed(self, state, site);
        let node = match site.xi[0] {
            0.0 => self.line.ends(site.patch as usize)[0],
            1.0 => self.line.ends(site.patch as usize)[1],
            _ => return placed,
        };
        let rests = self.on_winch(state).contains(&node);
        SlavePoint { rests, ..self.at_node(state, node, placed) }
    }

    fn master<'a>(&'a self, on: Option<&str>, state: &'a BodyState) -> Result<Box<dyn Master + 'a>, PlaceError> {
        curve_body::master(self, on, state)
    }

    fn site_stiffness(&self, site: &Site) -> f64 {
        self.stiffness / self.line.lengths[site.patch as usize]
    }

    fn rigid_modes(&self, state: &BodyState) -> [Vec<f64>; 6] {
        self.line_of(state).rigid_modes(self.unknowns())
    }

    fn size(&self) -> f64 {
        self.line.length()
    }

    fn fields(&self, state: &BodyState) -> BodyFields {
        let active = self.active(state);
        let lengths: Vec<f64> = active.clone().map(|e| self.unstrained_length(state, e)).collect();
        // What is on a winch is not shown.
        let out = Centreline::new(lengths.clone(), self.line.closure, Continuity::C0, [3, 3]);
        let shown = |numbers: &[f64]| numbers[3 * active.start..3 * (active.start + out.nodes())].to_vec();
        let mut fields = crate::fields::of_curve(&out, &shown(&self.start), &shown(&state.configuration));
        crate::fields::add_element_data(&mut fields, "tension", 1, self.tensions(state));
        crate::fields::add_element_data(&mut fields, "unstrained_length", 1, lengths);
        fields
    }
}

impl Kinematics for Chain {
    fn prescribe(&self, time: f64, state: &mut BodyState) {
        self.wind(time, state);
    }

    fn holds_change(&self) -> bool {
        self.winch.is_some()
    }

    fn point(&self, on: Option<&str>) -> Option<Point<3>> {
        place::point(&self.line, &self.start, &self.part(on).ok()?)
    }
}

impl signorini_mechanics::Thermal for Chain {}

impl Inertial for Chain {
    fn mass(&self, _: &[Option<&str>]) -> Result<Option<Mass>, PlaceError> {
        Ok(self.mass_per_length.map(|mass| mass::lumped(&self.line, mass)))
    }
}

impl Elimination for Chain {}

impl ContactSides for Chain {
    fn curve<'a>(&'a self, on: Option<&str>) -> Option<Box<dyn Curve + 'a>> {
        curve_body::curve(self, on)
    }
}

impl Slack for Chain {
    fn is_slack(&self, state: &BodyState, longer: f64) -> bool {
        let is_long = |e: usize| self.element(state, e).0.norm() < (1.0 - longer) * self.unstrained_length(state, e);
        self.active(state).all(|e| self.drives[e] == Drive::Elastic && is_long(e))
    }

    fn add_sag_spring(&mut self, force: f64) {
        self.tightened = force;
    }

    fn soften(&mut self, share: f64) -> f64 {
        self.softened = share;
        self.stiffness
    }
}

impl BoxOfMaterial for Chain {}

impl Constitution for Chain {}
