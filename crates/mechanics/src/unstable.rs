//! The choice of what is done with unstable states.

/// What is done with a state that is not stable.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Unstable {
    /// It is disturbed, and what follows is followed to a state that is stable.
    #[default]
    Follow,
    /// It is told.
    Tell,
}
