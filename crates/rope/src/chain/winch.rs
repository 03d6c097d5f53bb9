//! A winch that pays out or takes in rope, however much: its element is split when it has become long, and merged with its
//! neighbour when it has become short, with the unstrained length conserved.
//!
//! A node that is put in lies on the chord and divides it as it divides the unstrained length, so that both parts have the
//! tension of the whole. A node that is taken out leaves the sum of both unstrained lengths; where the rope was straight
//! the tension is what it was.

use super::body::{Chain, ChainError};
use super::element::Drive;
use crate::centreline::{Centreline, Closure, Continuity};
use signorini_mechanics::body::BodyState;

/// An element longer than so many nominal ones is split, and one shorter than so much of one is merged.
const LONG: f64 = 1.5;
const SHORT: f64 = 0.5;

/// Which end of a rope a winch is at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WinchEnd {
    Start,
    End,
}

impl Chain {
    /// Winds rope on or off at an end of an open rope: its last element gets another unstrained length, which may be more
    /// than an element, or less than nothing as long as there is rope. Elements that come and go have the length `nominal`.
    /// The rope and its state afterwards: with other numbers of nodes and elements it is another body for a system.
    ///
    /// # Errors
    /// A closed rope, a nominal length that is not positive, a change that is not finite or takes in all of the rope, or all
    /// up to a pulley.
    pub fn wound(
        &self,
        state: &BodyState,
        at: WinchEnd,
        by: f64,
        nominal: f64,
    ) -> Result<(Chain, BodyState), ChainError> {
        super::body::positive("nominal length", nominal)?;
        let left = self.line.length() + by;
        if self.line.closure == Closure::Closed || !left.is_finite() || left < SHORT * nominal {
            let valid = "valid are changes of an open rope that leave half an element";
            return Err(ChainError::Number { name: "wound length", value: by, valid });
        }
        let mut parts = Parts::of(self, state);
        if at == WinchEnd::Start {
            parts.reverse();
        }
        let last = parts.lengths.len() - 1;
        parts.lengths[last] += by;
        while parts.lengths.len() > 1 && parts.lengths[parts.lengths.len() - 1] < SHORT * nominal {
            let taken_out = parts.lengths.len() - 1;
            if parts.pulleys[taken_out].is_some() {
                let node = if at == WinchEnd::End { taken_out } else { 1 };
                return Err(ChainError::Pulley { node, reason: "no rope is left between it and the winch" });
            }
            parts.merge();
        }
        while parts.lengths[parts.lengths.len() - 1] > LONG * nominal {
            parts.split(nominal);
        }
        if at == WinchEnd::Start {
            parts.reverse();
        }
        Ok(parts.chain(self))
    }
}

/// A rope as lists of its nodes, at the start and now, and of its elements.
struct Parts {
    nodes: Vec<[[f64; 3]; 2]>,
    /// What has run through a node that is a pulley.
    pulleys: Vec<Option<f64>>,
    lengths: Vec<f64>,
    drives: Vec<Drive>,
}

impl Parts {
    fn of(chain: &Chain, state: &BodyState) -> Self {
        let count = chain.line.nodes();
        let place = |of: &[f64], n: usize| [of[3 * n], of[3 * n + 1], of[3 * n + 2]];
        let through = |n: usize| chain.pulleys.iter().position(|p| *p == n).map(|k| state.configuration[3 * count + k]);
        Parts {
            nodes: (0..count).map(|n| [place(&chain.start, n), place(&state.configuration, n)]).collect(),
            pulleys: (0..count).map(through).collect(),
            lengths: chain.line.lengths.clone(),
            drives: chain.drives.clone(),
        }
    }

    fn reverse(&mut self) {
        self.nodes.reverse();
        self.pulleys.reverse();
        self.lengths.reverse();
        self.drives.reverse();
    }

    /// Takes out the last node but one.
    fn merge(&mut self) {
        let n = self.lengths.len();
        let taken = self.lengths[n - 1];
        self.lengths[n - 2] += taken;
        self.lengths.pop();
        self.drives.remove(n - 2);
        self.nodes.remove(n - 1);
        self.pulleys.remove(n - 1);
    }

    /// Divides the last element: what is nearer to the winch stays with it.
    fn split(&mut self, nominal: f64) {
        let n = self.lengths.len();
        let share = nominal / self.lengths[n - 1];
        let [a, b] = [self.nodes[n - 1], self.nodes[n]];
        let between = |k: usize| std::array::from_fn(|i| a[k][i] + share * (b[k][i] - a[k][i]));
        self.nodes.insert(n, [between(0), between(1)]);
        self.pulleys.insert(n, None);
        self.lengths.push(self.lengths[n - 1] - nominal);
        self.lengths[n - 1] = nominal;
        self.drives.insert(n - 1, Drive::Elastic);
    }

    fn chain(self, before: &Chain) -> (Chain, BodyState) {
        let pulleys: Vec<usize> = (0..self.nodes.len()).filter(|n| self.pulleys[*n].is_some()).collect();
        let through: Vec<f64> = self.pulleys.iter().flatten().copied().collect();
        let list = |k: usize| self.nodes.iter().flat_map(move |n| n[k]).collect::<Vec<f64>>();
        let (mut start, mut configuration) = (list(0), list(1));
        start.extend(through.iter().map(|_| 0.0));
        configuration.extend(through);
        let line = Centreline::new(self.lengths, before.line.closure, Continuity::C0, [3, 3]);
        let chain = Chain { line, drives: self.drives, pulleys, start, ..before.clone() };
        (chain, BodyState { configuration, internal: Vec::new() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chain::body::Rest;
    use crate::path::Path;
    use signorini_geometry::Vector;
    use signorini_mechanics::Body;

    #[test]
    fn any_length_is_paid_out_and_taken_in() {
        let path = Path::points(&[Vector::<3>::zeros(), Vector::<3>::new(4.0, 0.0, 3.0)], Closure::Open).unwrap();
        let path = path.sample(10, Continuity::C0).unwrap();
        let rope = Chain::new("rope", &path, 100.0, Rest::Pretension(5.0), 0.1).unwrap();
        let whole =
            |chain: &Chain, s: &BodyState| (0..chain.elements()).map(|e| chain.unstrained_length(s, e)).sum::<f64>();
        let start = rope.start();
        let length = whole(&rope, &start);
        let nominal = length / 10.0;
        for at in [WinchEnd::Start, WinchEnd::End] {
            // Nothing wound: nothing changes.
            let (same, state) = rope.wound(&start, at, 0.0, nominal).unwrap();
            assert!(same.elements() == 10 && state == start);
            for by in [0.3 * nominal, 2.2 * nominal, 25.0 * nominal, -0.4 * nominal, -0.7 * nominal, -6.2 * nominal] {
                let (other, state) = rope.wound(&start, at, by, nominal).unwrap();
                assert!((whole(&other, &state) - length - by).abs() < 1e-12 * length);
                let wanted = (length + by) / nominal;
                assert!((other.elements() as f64 - wanted).abs() <= 0.5 + 1e-9, "{by}: {} {wanted}", other.elements());
                assert_eq!(state.configuration.len(), other.unknowns());
                // All but the elements of the winch have the tension that they had.
                let [n, m] = [other.elements(), rope.elements()];
                for k in 0..n.min(m).saturating_sub(2) {
                    let e = if at == WinchEnd::End { k } else { n - 1 - k };
                    assert!((other.tensions(&state)[e] - 5.0).abs() < 1e-10, "{by} {k}");
                }
                // The ends stay where they are.
                let ends = [other.position(&state, 0), other.position(&state, n)];
                assert!(
                    (ends[0] - rope.position(&start, 0)).norm() + (ends[1] - rope.position(&start, m)).norm() < 1e-14
                );
            }
            // Out and in again.
            let (out, state) = rope.wound(&start, at, 3.0 * nominal, nominal).unwrap();
            let (back, state) = out.wound(&state, at, -3.0 * nominal, nominal).unwrap();
            assert!((whole(&back, &state) - length).abs() < 1e-12 && back.elements() == 10);
        }
        assert!(rope.wound(&start, WinchEnd::End, -length, nominal).is_err());
        assert!(rope.wound(&start, WinchEnd::End, 1.0, 0.0).is_err());
    }
}
