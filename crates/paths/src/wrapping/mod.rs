//! Shortest paths over rigid bodies: ropes without friction, tendons, belts.
//!
//! Between two fixed points a shortest path is a chain of straight lines and geodesics that join along their tangents. It is
//! found by Newton with the exact Jacobian of natural geodesic variations (`newton`); bodies come and go by themselves
//! (`topology`); a path found before is the start of the next one, which keeps its side of every body; without one an
//! elastic band finds the bodies that are in the way (`start`). (Scholz, Sherman, Stavness, Delp & Kecskeméthy, A fast
//! multi-obstacle muscle wrapping method using natural geodesic variations, Multibody System Dynamics 36, 2016.)

mod newton;
mod path;
mod route;
mod start;
mod tensions;
mod topology;
mod touch;

pub use path::{BodyGradient, Contact, Event, EventKind, Minimal, PathPoint, WrappedPath};
pub use route::{Anchor, Body, Route, Station};
pub use tensions::{PathTensions, Sideways};

use crate::PathError;
use newton::{Chain, Workspace, newton};
use route::Leg;
use touch::WrapPoint;

/// A path that follows its bodies: every answer is the start of the next search.
#[derive(Clone, Debug)]
pub struct Wrapping {
    route: Route,
    /// What is known of each leg, once a path is.
    known: Option<Vec<Known>>,
    work: Workspace,
}

/// A leg of a path that was found: the stations of its bodies in the order of the path, and its touches.
#[derive(Clone, Debug)]
struct Known {
    stations: Vec<usize>,
    touches: Vec<WrapPoint>,
}

impl Known {
    fn touches(&self, station: usize) -> bool {
        self.touches.iter().any(|t| self.stations[t.order] == station)
    }
}

impl Wrapping {
    pub fn new(route: Route) -> Self {
        Wrapping { route, known: None, work: Workspace::default() }
    }

    pub fn route(&self) -> &Route {
        &self.route
    }

    /// Moves the start of the path.
    pub fn set_start(&mut self, start: Anchor) {
        self.route.start = start;
    }

    /// Moves the end of the path.
    pub fn set_end(&mut self, end: Anchor) {
        self.route.end = end;
    }

    /// Another route; where it goes around the same bodies in the same parts the path found before is kept as a start.
    pub fn set_route(&mut self, route: Route) {
        let kinds = |r: &Route| -> Vec<Option<usize>> {
            let kind = |s: &Station| if let Station::Around { body, .. } = s { Some(*body) } else { None };
            r.stations.iter().map(kind).collect()
        };
        if kinds(&route) != kinds(&self.route) {
            self.known = None;
        }
        self.route = route;
    }

    /// Forgets the path found before: the next search looks at all of space.
    pub fn forget(&mut self) {
        self.known = None;
    }

    /// The shortest path over the bodies where they are now. After an error the path known before is kept. Where a path in the
    /// stated order of the bodies would go through one of them, they are taken in the order of an elastic band over them
    /// ([`WrappedPath::order`]).
    ///
    /// # Errors
    /// A body that does not exist; a fixed point inside a body that its leg goes around; no path found, or none that goes
    /// through no body.
    pub fn solve(&mut self, bodies: &[Body<'_>]) -> Result<WrappedPath, PathError> {
        self.route.check(bodies.len())?;
        let mut found = Vec::new();
        let mut iterations = 0;
        for (k, mut leg) in self.route.legs(bodies).into_iter().enumerate() {
            leg.pin(bodies)?;
            let warm = self.known.as_ref().and_then(|known| {
                let mut leg = leg.clone();
                leg.arrange(&known[k].stations);
                leg.pin(bodies).ok()?;
                let (chain, steps) = settle(&leg, bodies, known[k].touches.clone(), &mut self.work).ok()?;
                topology::crossing(&leg, bodies, &chain).is_none().then_some((leg, chain, steps))
            });
            let (leg, chain, steps) = match warm {
                Some(found) => found,
                None => anew(leg, bodies, &mut self.work)?,
            };
            iterations += steps;
            found.push((leg, chain));
        }
        let mut path = WrappedPath::new(&self.route, &found);
        path.iterations = iterations;
        path.events = self.events(&found);
        let known = |(leg, chain): (Leg, Chain)| Known { stations: leg.stations(), touches: chain.touches };
        self.known = Some(found.into_iter().map(known).collect());
        Ok(path)
    }

    /// Bodies that are touched now and were not, and the other way round.
    fn events(&self, found: &[(Leg, Chain)]) -> Vec<Event> {
        let Some(known) = &self.known else { return Vec::new() };
        let mut events = Vec::new();
        for ((leg, chain), before) in found.iter().zip(known) {
            for (order, around) in leg.around.iter().enumerate() {
                let was = before.touches(around.station);
                let is = chain.touches.iter().any(|t| t.order == order);
                let kind = match (was, is) {
                    (false, true) => EventKind::Touchdown,
                    (true, false) => EventKind::LiftOff,
                    _ => continue,
                };
                events.push(Event { station: around.station, kind });
            }
        }
        events
    }
}

/// Changes of bodies per body after which a search is given up: each comes and goes, and is divided and closed.
const CHANGES: usize = 6;

/// The path near given touches, with the bodies that are then in the way and without those that are not.
fn settle(
    leg: &Leg,
    bodies: &[Body<'_>],
    mut touches: Vec<WrapPoint>,
    work: &mut Workspace,
) -> Result<(Chain, usize), PathError> {
    let mut iterations = 0;
    let mut history = Vec::new();
    let most = CHANGES * (leg.around.len() + 1);
    let failed = |residuals, changes| PathError::NoPath { from: leg.from.0, to: leg.to.0, residuals, changes };
    for changes in 0..most {
        let (chain, residuals) = newton(leg, bodies, touches, work).map_err(|r| failed(r, changes))?;
        iterations += residuals.len() - 1;
        history.extend(residuals);
        let next = topology::lift_off(&chain).or_else(|| topology::close_bridge(leg, &chain));
        if let Some(next) = next {
            touches = next;
            continue;
        }
        if !topology::is_path(leg, &chain) {
            return Err(failed(history, changes));
        }
        let next = topology::open_bridge(leg, bodies, &chain).or_else(|| topology::touchdown(leg, bodies, &chain));
        match next {
            Some(next) => touches = next,
            None => return Ok((chain, iterations)),
        }
    }
    Err(failed(history, most))
}

/// A path without one to start from that goes through no body: in the stated order, or else in that of a band.
fn anew(leg: Leg, bodies: &[Body<'_>], work: &mut Workspace) -> Result<(Leg, Chain, usize), PathError> {
    let mut search = |leg: &Leg| {
        let (chain, steps) = first(leg, bodies, work)?;
        match topology::crossing(leg, bodies, &chain) {
            None => Ok((chain, steps)),
            Some(error) => Err(error),
        }
    };
    let error = match search(&leg) {
        Ok((chain, steps)) => return Ok((leg, chain, steps)),
        Err(error) => error,
    };
    let mut other = leg.clone();
    other.arrange(&start::order(&leg, bodies));
    other.pin(bodies)?;
    match search(&other) {
        Ok((chain, steps)) => Ok((other, chain, steps)),
        Err(_) => Err(error),
    }
}

/// A path without one to start from: by a band over the bodies, then with the turns that the route asks for.
fn first(leg: &Leg, bodies: &[Body<'_>], work: &mut Workspace) -> Result<(Chain, usize), PathError> {
    let straight = settle(leg, bodies, Vec::new(), work);
    let banded = settle(leg, bodies, start::band(leg, bodies), work);
    let length = |c: &Chain| {
        let lines: f64 = (0..=c.touches.len()).map(|k| c.line(leg, k).length()).sum();
        lines + c.touches.iter().map(|t| t.length).sum::<f64>()
    };
    // Both are local minima: the shorter one is the answer.
    let (chain, mut iterations) = match (straight, banded) {
        (Ok(a), Ok(b)) => {
            let crosses = |found: &(Chain, usize)| topology::crossing(leg, bodies, &found.0).is_some();
            if !crosses(&a) && (crosses(&b) || length(&a.0) < length(&b.0) * (1.0 - 1e-12)) { a } else { b }
        }
        (Ok(one), Err(_)) | (Err(_), Ok(one)) => one,
        (Err(_), Err(error)) => return Err(error),
    };
    if leg.around.iter().all(|a| a.turns == 0) {
        return Ok((chain, iterations));
    }
    let mut chain = chain;
    for (order, around) in leg.around.iter().enumerate() {
        let body = &bodies[around.body];
        for _ in 0..around.turns {
            let mut touches = chain.touches.clone();
            let next = touches.iter().position(|t| t.order >= order).unwrap_or(touches.len());
            if touches.get(next).is_none_or(|t| t.order > order) {
                // The body is not in the way: the turns start where the path is closest to it.
                let line = chain.line(leg, next);
                let closest = topology::deepest(body, &line);
                let Some(touch) = closest.and_then(|c| topology::touch_at(order, body, &line, &c)) else { break };
                touches.insert(next, touch);
            }
            let Some((tau, turn)) = topology::turn(body, &touches[next].x, &touches[next].tau) else { break };
            touches[next].tau = tau;
            touches[next].length += turn;
            let (wound, more) = settle(leg, bodies, touches, work)?;
            chain = wound;
            iterations += more;
        }
    }
    Ok((chain, iterations))
}
