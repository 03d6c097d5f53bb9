//! Newton's method with line search, for equations whose states need not be vectors.
//!
//! A residual has two measures. What it is relative to what it is to reach decides when the equations are solved: at most
//! one. It follows the size of the forces of the state, so that it hardly tells a bad state from a worse one. The merit is
//! a norm of the residual itself, in one unit, and decides how far a step is followed.
//!
//! Three searches along the step are known. The monotone one (Armijo 1966) takes the first share of a step that lowers the
//! merit, or the best of all. The watchdog (Chamberlain, Powell, Lemarechal & Pedersen 1982) takes whole steps as they come,
//! and goes back to the best state, and from there by shares, only when none of several was better: for equations whose
//! residual rises before it falls, as that of thin beams, and that of contacts that open and close. A third goes down an energy
//! that is convex.

/// How far a state is from a solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// A norm of the residual in one unit, the same for all states of a solution.
    pub merit: f64,
    /// Residual over what it is to reach.
    pub error: f64,
}

/// Equations with their linearisation.
pub trait Equations {
    type State: Clone;
    type Error;

    /// The residual at a state, measured.
    ///
    /// # Errors
    /// States that cannot be.
    fn measure(&mut self, at: &Self::State) -> Result<Measured, Self::Error>;

    /// The Newton step at a state.
    ///
    /// # Errors
    /// States that cannot be, or a linear system without a solution.
    fn step(&mut self, at: &Self::State) -> Result<Vec<f64>, Self::Error>;

    /// Whether the next step brings prescribed values along: it is taken whole then, as what it does to the residual says
    /// nothing.
    fn is_driven(&self, _at: &Self::State) -> bool {
        false
    }

    /// The largest share of a step that may be followed: that far the linearisation may be trusted.
    fn farthest(&self, _at: &Self::State, _step: &[f64]) -> f64 {
        1.0
    }

    /// The slope of the energy along a step, of equations that have one.
    ///
    /// # Errors
    /// States that cannot be.
    fn slope(&mut self, _at: &Self::State, _step: &[f64]) -> Result<f64, Self::Error> {
        Ok(0.0)
    }

    /// The state after a share of the step.
    fn advance(&self, at: &Self::State, step: &[f64], share: f64) -> Self::State;
}

/// How far a step is followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Search {
    Monotone,
    /// Whole steps, so many without a better state before the search goes back.
    Watchdog {
        patience: usize,
    },
    /// Down the energy: the first share at whose end it hardly rises. For energies that are convex, as of ropes.
    Energy,
}

/// Slope of the energy at the end of a step, relative to minus the one at its start, that hardly rises.
const HARDLY: f64 = 0.5;

/// How the equations are solved.
#[derive(Clone, Copy, Debug)]
pub struct Newton {
    pub most_iterations: usize,
    pub search: Search,
}

/// A solution, with the error before and after each iteration.
#[derive(Clone, Debug)]
pub struct Converged<S> {
    pub state: S,
    pub history: Vec<f64>,
}

/// Why there is none.
#[derive(Clone, Debug)]
pub enum NewtonFailure<S, E> {
    /// The best state, and the errors so far.
    NotConverged {
        best: S,
        history: Vec<f64>,
    },
    /// Told by the equations.
    Equations {
        error: E,
        history: Vec<f64>,
    },
    Interrupted,
}

/// Iterations without a merit that is less by a tenth: the method goes round, or creeps. Of the watchdog so many rounds, each of
/// which goes back to the best state.
const CIRCLES: usize = 20;
const CIRCLING_ROUNDS: usize = 3;
const LESS: f64 = 0.9;

/// Shares of a step that are tried.
const SHARES: [f64; 7] = [1.0, 0.6, 0.35, 0.2, 0.1, 0.05, 0.02];

/// Solves the equations. `report` is told each iteration and its error; where it says `false` the solver stops.
///
/// # Errors
/// No convergence, equations that cannot be evaluated, or an interruption.
pub fn newton<E: Equations>(
    equations: &mut E,
    start: &E::State,
    options: &Newton,
    report: &mut dyn FnMut(usize, f64) -> bool,
) -> Result<Converged<E::State>, NewtonFailure<E::State, E::Error>> {
    let mut history = Vec::new();
    macro_rules! told {
        ($found:expr) => {
            match $found {
                Ok(found) => found,
                Err(error) => return Err(NewtonFailure::Equations { error, history }),
            }
        };
    }
    let mut state = start.clone();
    let mut measure = told!(equations.measure(&state));
    history.push(measure.error);
    let mut best = (state.clone(), measure);
    let mut behind = 0;
    let mut fell = (0, measure.merit);
    let circles = match options.search {
        Search::Watchdog { patience } => CIRCLING_ROUNDS * (patience + 1),
        Search::Monotone | Search::Energy => CIRCLES,
    };
    // Until what is prescribed has been brought along.
    let mut brings = true;
    for iteration in 1..=options.most_iterations {
        if measure.error <= 1.0 {
            break;
        }
        let step = told!(equations.step(&state));
        let farthest = equations.farthest(&state, &step);
        let driven = brings && equations.is_driven(&state);
        brings = driven && farthest < 1.0;
        let whole_steps = match options.search {
            Search::Monotone | Search::Energy => driven,
            Search::Watchdog { patience } => driven || behind < patience,
        };
        let by_energy = options.search == Search::Energy && !driven;
        let falls = if by_energy { -told!(equations.slope(&state, &step)) } else { 0.0 };
        let mut reached: Option<(E::State, Measured)> = None;
        for (tried, share) in SHARES.map(|share| farthest * share).into_iter().enumerate() {
            let next = equations.advance(&state, &step, share);
            // A state that cannot be is one that is too far.
            let of_next = match equations.measure(&next) {
                Ok(m) => m,
                Err(error) if tried + 1 == SHARES.len() && reached.is_none() => {
                    return Err(NewtonFailure::Equations { error, history });
                }
                Err(_) => continue,
            };
            if by_energy {
                let is_down = equations.slope(&next, &step).is_ok_and(|slope| slope <= HARDLY * falls);
                reached = Some((next, of_next));
                if is_down || of_next.error <= 1.0 {
                    break;
                }
                continue;
            }
            let better = reached.as_ref().is_none_or(|(_, m)| of_next.merit < m.merit);
            if better && !of_next.merit.is_nan() {
                reached = Some((next, of_next));
            }
            let falls = of_next.merit <= (1.0 - 0.1 * share) * measure.merit;
            if of_next.error <= 1.0 || (whole_steps && of_next.merit.is_finite()) || falls {
                break;
            }
        }
        let Some((next, of_next)) = reached else { break };
        (state, measure) = (next, of_next);
        history.push(measure.error);
        if !report(iteration, measure.error) {
            return Err(NewtonFailure::Interrupted);
        }
        if measure.merit < LESS * fell.1 || driven {
            fell = (iteration, measure.merit);
        } else if iteration - fell.0 >= circles && options.search != Search::Energy {
            break;
        }
        if measure.merit < best.1.merit || driven {
            best = (state.clone(), measure);
            behind = 0;
        } else {
            behind += 1;
            if let Search::Watchdog { patience } = options.search
                && behind == patience
                && measure.error > 1.0
            {
                (state, measure) = best.clone();
            }
        }
    }
    if measure.error <= 1.0 {
        return Ok(Converged { state, history });
    }
    Err(NewtonFailure::NotConverged { best: best.0, history })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `atan x = 0`: whole steps diverge from beyond 1.39.
    struct Arctangent;

    impl Equations for Arctangent {
        type State = f64;
        type Error = ();
        fn measure(&mut self, at: &f64) -> Result<Measured, ()> {
            Ok(Measured { merit: at.atan().abs(), error: at.atan().abs() / 1e-12 })
        }
        fn step(&mut self, at: &f64) -> Result<Vec<f64>, ()> {
            Ok(vec![-at.atan() * (1.0 + at * at)])
        }
        fn advance(&self, at: &f64, step: &[f64], share: f64) -> f64 {
            at + share * step[0]
        }
    }

    /// A convex energy: whole steps go round, and the residual says little.
    struct Valley;

    impl Equations for Valley {
        type State = f64;
        type Error = ();
        fn measure(&mut self, at: &f64) -> Result<Measured, ()> {
            let r = Self::slope_at(*at).abs();
            Ok(Measured { merit: r, error: r / 1e-12 })
        }
        fn step(&mut self, at: &f64) -> Result<Vec<f64>, ()> {
            Ok(vec![-Self::slope_at(*at) / (1.0 / (1.0 + at * at).powf(1.5) + 1e-3)])
        }
        fn slope(&mut self, at: &f64, step: &[f64]) -> Result<f64, ()> {
            Ok(Self::slope_at(*at) * step[0])
        }
        fn advance(&self, at: &f64, step: &[f64], share: f64) -> f64 {
            at + share * step[0]
        }
    }

    impl Valley {
        /// Of the energy `√(1 + x²) + x²/2000`.
        fn slope_at(x: f64) -> f64 {
            x / (1.0 + x * x).sqrt() + 1e-3 * x
        }
    }

    #[test]
    fn the_way_down_a_convex_energy_is_found_from_afar() {
        let options = Newton { most_iterations: 60, search: Search::Energy };
        let found = newton(&mut Valley, &40.0, &options, &mut |_, _| true);
        assert!(found.unwrap().state.abs() < 1e-9);
    }

    #[test]
    fn both_searches_find_what_whole_steps_lose() {
        for search in [Search::Monotone, Search::Watchdog { patience: 3 }] {
            let found = newton(&mut Arctangent, &3.0, &Newton { most_iterations: 40, search }, &mut |_, _| true);
            assert!(found.unwrap().state.abs() < 1e-12, "{search:?}");
        }
        let lost = Newton { most_iterations: 8, search: Search::Watchdog { patience: 100 } };
        let lost = newton(&mut Arctangent, &3.0, &lost, &mut |_, _| true);
        assert!(matches!(lost, Err(NewtonFailure::NotConverged { history, .. }) if history.len() > 1));
    }
}
