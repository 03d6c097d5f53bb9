//! A winch at an end of a rope: it pays rope out and takes it in by time.
//!
//! The rope has as many elements as when most of it is out. Those that are still on the winch have no length, and their
//! nodes are where the winch is: the support that holds this end of the rope holds them too. Of the elements that are out
//! the last one, next to the winch, has what is left of the unstrained length, from half a nominal element to one and a
//! half; beyond that a node leaves the winch, or comes to it. Counted from the other end, with the lengths `l_k` of the
//! elements and the length `L` that is out, the last one is the largest `k` with `Σ_{j<k} l_j + h/2 <= L`.
//!
//! A node that leaves lies on the chord and divides it as it divides the unstrained length, so that both parts have the
//! tension of the whole. Where a node that comes in lay on a straight line, the tension is what it was.

use super::body::{Chain, ChainError};
use super::element::Drive;
use super::winch::{Length, Winch, WinchEnd};
use crate::centreline::{Centreline, Closure, Continuity};
use signorini_mechanics::body::BodyState;
use std::ops::Range;

/// An element shorter than so much of a nominal one is not out by itself.
const SHORT: f64 = 0.5;

impl Chain {
    /// Puts a winch at an end, that pays out at most a length; more than that is taken by stretching its last element.
    ///
    /// # Errors
    /// A closed rope, one that has a winch, a length that is negative or not finite.
    pub fn with_winch(mut self, at: WinchEnd, most: f64, paid_out: Length) -> Result<Self, ChainError> {
        let is_valid = most >= 0.0 && most.is_finite();
        if self.line.closure == Closure::Closed || self.winch.is_some() || !is_valid {
            let valid = "valid are 0 and positive numbers, and one winch on an open rope";
            return Err(ChainError::Number { name: "length on the winch", value: most, valid });
        }
        let count = self.line.elements();
        let out = self.line.length();
        let nominal = out / count as f64;
        let more = (most / nominal).round() as usize;
        let mut lengths = self.line.lengths.clone();
        let through = self.start.split_off(3 * self.line.nodes());
        let on_winch = |node: [f64; 3]| std::iter::repeat_n(node, more).flatten();
        let node = |k: usize| [self.start[3 * k], self.start[3 * k + 1], self.start[3 * k + 2]];
        let [first, last] = [node(0), node(count)];
        match at {
            WinchEnd::End => {
                lengths.extend(std::iter::repeat_n(nominal, more));
                self.drives.extend(std::iter::repeat_n(Drive::Elastic, more));
                self.start.extend(on_winch(last));
            }
            WinchEnd::Start => {
                lengths.splice(0..0, std::iter::repeat_n(nominal, more));
                self.drives.splice(0..0, std::iter::repeat_n(Drive::Elastic, more));
                self.start.splice(0..0, on_winch(first));
                self.pulleys.iter_mut().for_each(|p| *p += more);
            }
        }
        self.start.extend(through);
        self.line = Centreline::new(lengths, Closure::Open, Continuity::C0, [3, 3]);
        self.winch = Some(Winch { at, paid_out, nominal, out });
        Ok(self)
    }

    /// What is out of the winch in a state: unstrained length since the start.
    fn paid_out(&self, state: &BodyState) -> f64 {
        state.internal.first().copied().unwrap_or(0.0)
    }

    /// Number of an element or, for elements and nodes alike, its place counted from the end that is not on the winch.
    fn counted(&self, k: usize, of: usize) -> usize {
        if self.winch.as_ref().is_some_and(|w| w.at == WinchEnd::Start) { of - 1 - k } else { k }
    }

    /// Number of elements that are out when a length was paid out, and the unstrained length of the last of them.
    fn unwound(&self, paid_out: f64) -> (usize, f64) {
        let count = self.line.elements();
        let Some(winch) = &self.winch else { return (count, self.line.lengths[count - 1]) };
        let mut before = 0.0;
        let mut found = (1, winch.out + paid_out);
        for k in 1..count {
            before += self.line.lengths[self.counted(k - 1, count)];
            if before + SHORT * winch.nominal > winch.out + paid_out {
                break;
            }
            found = (k + 1, winch.out + paid_out - before);
        }
        found
    }

    /// The elements that are out.
    pub fn active(&self, state: &BodyState) -> Range<usize> {
        let count = self.line.elements();
        let (out, _) = self.unwound(self.paid_out(state));
        match &self.winch {
            Some(Winch { at: WinchEnd::Start, .. }) => count - out..count,
            _ => 0..out,
        }
    }

    /// The unstrained length of an element but for what runs through pulleys.
    pub(super) fn wound_length(&self, state: &BodyState, element: usize) -> f64 {
        let Some(_) = &self.winch else { return self.line.lengths[element] };
        let (out, last) = self.unwound(self.paid_out(state));
        match self.counted(element, self.line.elements()) {
            k if k + 1 == out => last,
            k if k < out => self.line.lengths[element],
            _ => 0.0,
        }
    }

    /// The nodes that are on the winch, the end of the rope first; none without a winch.
    pub(super) fn on_winch(&self, state: &BodyState) -> Vec<usize> {
        if self.winch.is_none() {
            return Vec::new();
        }
        let nodes = self.line.nodes();
        let (out, _) = self.unwound(self.paid_out(state));
        (out..nodes).rev().map(|k| self.counted(k, nodes)).collect()
    }

    /// Brings what is out to a time.
    pub(super) fn wind(&self, time: f64, state: &mut BodyState) {
        let Some(winch) = &self.winch else { return };
        let nodes = self.line.nodes();
        let place = |k: usize| 3 * self.counted(k, nodes);
        let (before, _) = self.unwound(self.paid_out(state));
        let paid_out = (winch.paid_out)(time);
        let (now, last) = self.unwound(paid_out);
        let at =
            |state: &BodyState, k: usize| -> [f64; 3] { std::array::from_fn(|i| state.configuration[place(k) + i]) };
        let end = at(state, nodes - 1);
        let from = at(state, before - 1);
        // Nodes that come in are where the winch is; those that leave divide the chord from the last that was out.
        (now..before).for_each(|k| state.configuration[place(k)..place(k) + 3].copy_from_slice(&end));
        let length = |k: usize| self.line.lengths[self.counted(k, nodes - 1)];
        let whole: f64 = (before - 1..now.max(before) - 1).map(length).sum::<f64>() + last;
        let mut s = 0.0;
        for k in before..now {
            s += length(k - 1);
            let x: [f64; 3] = std::array::from_fn(|i| from[i] + s / whole * (end[i] - from[i]));
            state.configuration[place(k)..place(k) + 3].copy_from_slice(&x);
        }
        state.internal = vec![paid_out];
    }
}
