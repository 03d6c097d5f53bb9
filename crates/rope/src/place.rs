//! Places of a curve, what holds them and what acts on them, as far as positions go: the same for ropes and beams.

use crate::centreline::{Centreline, Continuity};
use crate::hermite::FOUR;
use crate::quaternion::axis;
use signorini_geometry::{Matrix, Point, Vector};
use signorini_mechanics::body::{Constraint, Contribution, Hold, Load, Order, PlaceError};

/// A part of a curve.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Part {
    /// All of it.
    Whole,
    /// Single nodes.
    Nodes(Vec<usize>),
}

/// Finds `start`, `end`, `boundary` or the whole.
///
/// # Errors
/// Any other name, or an end of a closed curve.
pub fn part(body: &str, line: &Centreline, on: Option<&str>) -> Result<Part, PlaceError> {
    let Some(group) = on else { return Ok(Part::Whole) };
    let known = match line.end_nodes() {
        Some([start, end]) => vec![("start", vec![start]), ("end", vec![end]), ("boundary", vec![start, end])],
        None => Vec::new(),
    };
    match known.iter().find(|(name, _)| *name == group) {
        Some((_, nodes)) => Ok(Part::Nodes(nodes.clone())),
        None => Err(PlaceError::Unknown {
            body: body.to_string(),
            group: group.to_string(),
            known: if known.is_empty() {
                vec!["no groups, it is closed".to_string()]
            } else {
                known.iter().map(|(name, _)| name.to_string()).collect()
            },
        }),
    }
}

/// Where a part is that is a single node.
pub fn point(line: &Centreline, start: &[f64], part: &Part) -> Option<Point<3>> {
    match part {
        Part::Nodes(nodes) if nodes.len() == 1 => Some(line.position(start, nodes[0])),
        _ => None,
    }
}

/// The nodes of a part.
pub fn nodes(line: &Centreline, part: &Part) -> Vec<usize> {
    match part {
        Part::Whole => (0..line.nodes()).collect(),
        Part::Nodes(nodes) => nodes.clone(),
    }
}

/// A curve with its numbers at the start and now.
pub struct Line<'a> {
    pub body: &'a str,
    pub line: &'a Centreline,
    pub start: &'a [f64],
    pub now: &'a [f64],
    /// The part of each element that is there; all of it where none is given.
    pub shares: Option<Vec<f64>>,
}

impl Line<'_> {
    fn unsuitable(&self, message: impl Into<String>) -> PlaceError {
        PlaceError::Unsuitable { body: self.body.to_string(), message: message.into() }
    }

    /// Equations of prescribed displacements.
    pub fn hold(&self, part: &Part, hold: &Hold<'_>) -> Vec<Constraint> {
        let mut out = Vec::new();
        for node in nodes(self.line, part) {
            let reference = self.line.position(self.start, node);
            let moved = self.line.position(self.now, node) - reference;
            for i in 0..3 {
                if let Some(value) = hold.displacement[i] {
                    let unknown = (node * self.line.unknowns_per_node + i) as u32;
                    out.push(Constraint::of_component(vec![(unknown, 1.0)], moved[i] - value(&reference), i));
                }
            }
        }
        out
    }

    /// Adds what acts on positions.
    ///
    /// # Errors
    /// Loads that need a surface, a section or an end.
    pub fn load(&self, part: &Part, load: &Load<'_>, order: Order, out: &mut Contribution) -> Result<(), PlaceError> {
        match (load, part) {
            (Load::BodyForce(field), Part::Whole) => self.distribute(out, |x| field(x)),
            (Load::Force(force), Part::Whole) => {
                let density = force / self.line.length();
                self.distribute(out, |_| density);
            }
            (Load::Force(force), Part::Nodes(nodes)) => {
                for node in nodes {
                    let first = node * self.line.unknowns_per_node;
                    (0..3).for_each(|i| out.forces[first + i] -= force[i] / nodes.len() as f64);
                }
            }
            (Load::Springs(stiffness), part) => {
                for node in nodes(self.line, part) {
                    let moved = self.line.position(self.now, node) - self.line.position(self.start, node);
                    let first = node * self.line.unknowns_per_node;
                    for i in 0..3 {
                        out.forces[first + i] += stiffness[i] * moved[i];
                        if order == Order::Second && stiffness[i] != 0.0 {
                            out.add_block(&[(first + i) as u32], &[stiffness[i]]);
                        }
                    }
                }
            }
            (Load::Tension(tension), Part::Nodes(nodes)) => {
                nodes.iter().for_each(|&node| self.pull(node, *tension, order, out));
            }
            (Load::Tension(_), Part::Whole) => {
                return Err(self.unsuitable("a tension acts on an end: `start` or `end`"));
            }
            (Load::BodyForce(_), Part::Nodes(_)) => {
                return Err(self.unsuitable("a force per length acts on all of a curve, not on its ends"));
            }
            (Load::Traction(_) | Load::Pressure(_), _) => {
                return Err(self.unsuitable("a curve has no area: give a force, or a force per length"));
            }
            (Load::NodalForce(_), _) => {
                return Err(self.unsuitable("a force on each node is for solids: give a force, or a force per length"));
            }
            (Load::Moment(_) | Load::FollowerMoment(_), _) => {
                return Err(self.unsuitable("only sections of beams with shear have moments"));
            }
        }
        Ok(())
    }

    /// A force per reference length.
    fn distribute(&self, out: &mut Contribution, density: impl Fn(&Point<3>) -> Vector<3>) {
        for e in 0..self.line.elements() {
            let share = self.shares.as_ref().map_or(1.0, |s| s[e]);
            for (xi, weight) in FOUR {
                let length = share * self.line.lengths[e];
                let force = density(&self.line.jet(self.start, e, xi).x) * (weight * length);
                for f in self.line.functions(e, xi) {
                    out.forces[f.unknown as usize] -= f.value.dot(&force);
                }
            }
        }
    }

    /// A force outward along the tangent of an end.
    fn pull(&self, node: usize, tension: f64, order: Order, out: &mut Contribution) {
        let is_start = node == 0;
        let (element, xi, sign) = if is_start { (0, 0.0, -1.0) } else { (self.line.elements() - 1, 1.0, 1.0) };
        let d1 = self.line.jet(self.now, element, xi).d1;
        let length = d1.norm();
        let tangent = d1 / length;
        let first = node * self.line.unknowns_per_node;
        (0..3).for_each(|i| out.forces[first + i] -= sign * tension * tangent[i]);
        if order == Order::First {
            return;
        }
        let across = (Matrix::<3>::identity() - tangent * tangent.transpose()) * (sign * tension / length);
        let functions = self.line.functions(element, xi);
        let mut unknowns: Vec<u32> = (0..3).map(|i| (first + i) as u32).collect();
        unknowns.extend(functions.iter().map(|f| f.unknown));
        let n = unknowns.len();
        let mut block = vec![0.0; n * n];
        for (c, f) in functions.iter().enumerate() {
            let change = across * f.slopes[0];
            (0..3).for_each(|i| block[i * n + 3 + c] -= change[i]);
        }
        out.add_block(&unknowns, &block);
    }

    /// Unit motions: three translations and three turns about the origin, of positions and derivatives.
    pub fn rigid_modes(&self, unknowns: usize) -> [Vec<f64>; 6] {
        std::array::from_fn(|mode| {
            let mut out = vec![0.0; unknowns];
            for node in 0..self.line.nodes() {
                let first = node * self.line.unknowns_per_node;
                let e = axis(mode % 3);
                let put = |out: &mut Vec<f64>, at: usize, v: Vector<3>| (0..3).for_each(|i| out[at + i] = v[i]);
                if mode < 3 {
                    put(&mut out, first, e);
                } else {
                    put(&mut out, first, e.cross(&self.line.position(self.now, node)));
                    if self.line.continuity == Continuity::C1 {
                        put(&mut out, first + 3, e.cross(&self.line.derivative(self.now, node)));
                    }
                }
            }
            out
        })
    }
}
