//! The choices within the method: how the equilibrium beside a zone is formulated, and by what functions fronts move.

/// How the equilibrium beside a zone is formulated.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Formulation {
    /// Of the free membrane alone, held along the front by Nitsche's method.
    #[default]
    OneSided,
    /// Of both sides of the front, with multipliers.
    Published(Published),
}

impl Formulation {
    /// How it moves fronts.
    pub fn transport(self) -> Transport {
        match self {
            Formulation::OneSided => Transport::Exact,
            Formulation::Published(published) => published.transport,
        }
    }
}

/// The choices within the published formulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Published {
    pub multiplier: ZoneMultiplier,
    pub transport: Transport,
}

/// How fronts are moved by a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Transport {
    /// As curves: nothing is lost on the way.
    #[default]
    Exact,
    /// As the level set of a function on the nodes of the grid, which becomes the signed distance to the moved front. What is
    /// linear between nodes shifts a front by the square of the cell, every time.
    Redistancing,
    /// As the level set of such a function, carried along by the equation of Hamilton and Jacobi, `φ_t + w |∇φ| = 0`.
    HamiltonJacobi,
}

/// The space of the multiplier in the contact zone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ZoneMultiplier {
    /// With square-integrable gradients, weighed by the square of a length: it can carry the line force along a front that
    /// is not at rest.
    H1 { length: f64 },
    /// Square-integrable only: along such a front it oscillates.
    L2,
}

impl ZoneMultiplier {
    /// The weight of the gradients.
    pub fn gradient_weight(self) -> f64 {
        match self {
            ZoneMultiplier::H1 { length } => length * length,
            ZoneMultiplier::L2 => 0.0,
        }
    }
}

/// How finely fronts may move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModeSpace {
    /// At most so many modes for each front: for the first, long steps.
    Coarse(usize),
    /// As many as the grid can tell apart.
    Fine,
    /// At most so many trigonometric functions of the arc length for each front, and no more than the grid can tell apart.
    Fourier(usize),
}

/// The functions along a front by which it moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Modes {
    /// Periodic splines, each of which moves a short piece: for fronts of any shape.
    #[default]
    Local,
    /// Trigonometric functions of the arc length: few suffice where fronts are nearly circles.
    Fourier {
        /// How many each front has at most.
        most: usize,
    },
}

impl Modes {
    /// As many as the grid can tell apart.
    pub fn finest(self) -> ModeSpace {
        match self {
            Modes::Local => ModeSpace::Fine,
            Modes::Fourier { most } => ModeSpace::Fourier(most),
        }
    }

    /// At most so many for each front.
    pub fn at_most(self, count: usize) -> ModeSpace {
        match self {
            Modes::Local => ModeSpace::Coarse(count),
            Modes::Fourier { most } => ModeSpace::Fourier(count.min(most)),
        }
    }
}
