//! What an increment of a history comes to, and what a history is to those who run it.

use super::event::Event;
use super::increment::Increment;
use super::remark::Remark;
use crate::coexisting::OtherState;
use serde_json::Value;
use signorini_solve::Progress;

/// What came of an increment.
pub enum Advanced<const D: usize> {
    State(Box<Found<D>>),
    /// Nothing: its step of the history has ended before.
    Nothing,
    /// No state was found any more; the last remark says why.
    Lost,
    /// The user asked to stop before there was a state.
    Interrupted,
    /// The data cannot be used at a time.
    Invalid {
        time: f64,
    },
}

/// The state at the end of an increment.
pub struct Found<const D: usize> {
    pub time: f64,
    pub increment: Increment<D>,
    /// Other equilibria at the same time.
    pub others: Vec<OtherState>,
    /// Whether the user asked to stop while events before it were looked for.
    pub interrupted: bool,
}

/// What an increment has to tell besides its state.
#[derive(Default)]
pub struct Messages<const D: usize> {
    pub remarks: Vec<Remark>,
    pub events: Vec<Event<D>>,
}

/// The history of a membrane, whatever its zones are.
pub trait History<const D: usize> {
    /// Solves an increment, from the state of the one before; with what is to be told of it.
    fn advance(&mut self, index: usize, progress: &mut dyn Progress) -> (Advanced<D>, Messages<D>);

    /// The state between two increments, enough to go on from to the same digits.
    fn save(&self) -> Value;

    /// Goes on from what [`History::save`] told; none where that is damaged.
    fn restore(&mut self, state: &Value) -> Option<()>;
}
