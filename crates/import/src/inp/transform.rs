//! `*TRANSFORM`: axes of nodes, along which their supports and forces are stated.

use super::card::Card;
use super::model::Model;
use crate::ImportError;
use crate::curve::Curve;
use crate::deck::Axes;
use crate::element::Space;

type Vector = [f64; 3];

impl Model {
    pub(super) fn transform(&mut self, card: &Card) -> Result<(), ImportError> {
        self.only(card, &["NSET", "TYPE"]);
        let set = card.required("NSET")?;
        let none = || card.wrong(None, format!("there is no set of nodes `{set}`"));
        let nodes = self.deck.node_sets.get(set).ok_or_else(none)?.1.clone();
        let kind = card.value("TYPE").unwrap_or("R").to_uppercase();
        let numbers = card.numbers()?;
        let &[a, b, c, d, e, f] = numbers
            .get(..6)
            .and_then(|n| n.try_into().ok())
            .ok_or_else(|| card.wrong(card.data.first(), "expected two points: six numbers"))?;
        let (first, second) = ([a, b, c], [d, e, f]);
        let axes = match kind.as_str() {
            "R" => Axes::Rectangular([first, second]),
            "C" => Axes::Cylindrical { point: first, axis: [0, 1, 2].map(|k| second[k] - first[k]) },
            _ => return Err(card.wrong(None, format!("TYPE={kind}: valid are R and C"))),
        };
        if axes.at(&[0.0; 3]).is_none() && axes.at(&[1.0, 2.0, 4.0]).is_none() {
            return Err(
                card.wrong(card.data.first(), "the two points make no axes: they are equal, or in line with zero")
            );
        }
        let in_plane = |x: &Vector| x[2] == 0.0;
        let of_plane = match &axes {
            Axes::Rectangular([a, b]) => in_plane(a) && in_plane(b) && a[0] * b[1] > a[1] * b[0],
            Axes::Cylindrical { axis, .. } => axis[0] == 0.0 && axis[1] == 0.0 && axis[2] > 0.0,
        };
        let space = self.deck.space();
        if space.dimension() == 2 && !of_plane
            || space == Space::Axisymmetric && matches!(axes, Axes::Cylindrical { .. })
        {
            return Err(card.wrong(None, "cannot be imported: the third axis of a plane deck has to be z"));
        }
        for node in nodes {
            if axes.is_that_of_space() {
                self.transformed.remove(&node);
            } else {
                self.transformed.insert(node, axes.clone());
            }
        }
        Ok(())
    }

    /// Refuses axes of their own of nodes that move rigid bodies or have equal displacements, and of nodes on their line.
    pub(super) fn check_transformed(&self) -> Result<(), ImportError> {
        let wrong = |message: String| Err(ImportError::new(&self.deck.file, None, message));
        for (node, axes) in &self.transformed {
            if self.reference(*node) {
                return wrong(format!("*TRANSFORM of the node {node}, which moves a rigid body, cannot be imported"));
            }
            if self.equal.contains(*node) {
                return wrong(format!("*TRANSFORM of the node {node}, which an *EQUATION names, cannot be imported"));
            }
            let is_used = self.histories.forces.has(*node) || self.histories.supports.has(*node);
            if is_used && self.deck.nodes.get(node).is_some_and(|x| axes.at(x).is_none()) {
                return wrong(format!("*TRANSFORM of the node {node}: it lies on the line about which the axes turn"));
            }
        }
        Ok(())
    }

    /// Forces along the axes of space in place of those of the nodes.
    pub(super) fn turn_forces(&mut self) {
        for (node, axes) in &self.transformed {
            let Some(e) = self.deck.nodes.get(node).and_then(|x| axes.at(x)) else { continue };
            let own = self.histories.forces.take_named(*node);
            for k in 0..3 {
                let along = own.iter().filter(|(d, _)| e.get(**d).is_some_and(|e| e[k] != 0.0));
                let parts: Vec<(String, Curve)> = along.map(|(d, (n, c))| (n.clone(), c.scaled(e[*d][k]))).collect();
                let Some((name, _)) = parts.first() else { continue };
                let sum = parts.iter().fold(Curve::constant(0.0), |sum, (_, c)| sum.plus(c));
                self.histories.forces.set(*node, k, name, sum);
            }
        }
    }
}
