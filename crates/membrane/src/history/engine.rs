//! What is carried from one increment to the next.

use super::increment::Increment;
use super::path_point::PathPoint;
use super::statement::Statement;
use crate::adhesion::Branch;
use crate::equilibrium::Equilibrium;
use crate::equilibrium::elements::Elements;
use crate::multigrid::large::ByMultigrid;
use crate::prediction;
use crate::problem::Membrane;
use crate::refinement::Refinement;
use crate::scales::Scales;
use serde_json::{Value, json};

/// Solves increments, each from the one before.
pub struct Engine<const D: usize, Z> {
    pub(super) previous: Option<(Z, Scales, Branch)>,
    /// The zone that the case asks to start from, until the first increment.
    pub(super) asked: Option<Z>,
    /// The scales of the problem, once they are known.
    pub(super) scales: Option<Scales>,
    /// The last states of the path and their times.
    pub(super) trail: Vec<(f64, Z)>,
    /// The cells of a state that was found on a path of equilibria, for the next increment.
    pub(super) cells: Option<Membrane<D>>,
    pub(super) refinement: Refinement<D>,
    /// Whether lengths are lengths; without units the problem may be scaled at will.
    pub(super) has_units: bool,
    /// Whether errors are estimated, which takes a solve more.
    pub estimates: bool,
}

/// What an engine carries from one increment to the next.
#[derive(Clone)]
pub struct Saved<Z> {
    previous: Option<(Z, Scales, Branch)>,
    scales: Option<Scales>,
    trail: Vec<(f64, Z)>,
}

impl<Z> Saved<Z> {
    pub fn to_json(&self, zone: impl Fn(&Z) -> Value) -> Value {
        let scales =
            |s: &Scales| json!([s.gap, s.pressure, s.tension, s.length, s.h, s.degree as f64, s.dimension as f64]);
        json!({
            "previous": self.previous.as_ref().map(|(z, s, branch)| {
                json!({"zone": zone(z), "scales": scales(s), "nearest": *branch == Branch::Nearest})
            }),
            "scales": self.scales.as_ref().map(scales),
            "trail": self.trail.iter().map(|(t, z)| json!([t, zone(z)])).collect::<Vec<_>>(),
        })
    }

    pub fn from_json(v: &Value, zone: impl Fn(&Value) -> Option<Z>) -> Option<Self> {
        let scales = |v: &Value| {
            let [gap, pressure, tension, length, h, degree, dimension] =
                serde_json::from_value::<[f64; 7]>(v.clone()).ok()?;
            Some(Scales { gap, pressure, tension, length, h, degree: degree as usize, dimension: dimension as usize })
        };
        let previous = match &v["previous"] {
            Value::Null => None,
            p => {
                let branch = if p["nearest"].as_bool()? { Branch::Nearest } else { Branch::Stable };
                Some((zone(&p["zone"])?, scales(&p["scales"])?, branch))
            }
        };
        Some(Self {
            previous,
            scales: if v["scales"].is_null() { None } else { Some(scales(&v["scales"])?) },
            trail: v["trail"]
                .as_array()?
                .iter()
                .map(|e| Some((e[0].as_f64()?, zone(&e[1])?)))
                .collect::<Option<_>>()?,
        })
    }
}

impl<const D: usize, Z: ByMultigrid<D>> Engine<D, Z> {
    pub fn new(statement: &dyn Statement<D>) -> Self {
        let asked = statement.initial_zone().map(|(side, shape)| {
            let grid = statement.grid();
            Z::empty(grid).united(grid, *side, &mut |x| shape.level(x))
        });
        Self {
            previous: None,
            asked,
            scales: None,
            trail: Vec::new(),
            cells: None,
            refinement: statement.refinement().clone(),
            estimates: false,
            has_units: statement.has_units(),
        }
    }

    /// What the next increment goes on from.
    pub fn save(&self) -> Saved<Z> {
        let Self { previous, scales, trail, .. } = self;
        Saved { previous: previous.clone(), scales: *scales, trail: trail.clone() }
    }

    /// Goes on from what was saved.
    pub fn restore(&mut self, saved: Saved<Z>) {
        self.asked = None;
        Saved { previous: self.previous, scales: self.scales, trail: self.trail } = saved;
    }

    /// The state that the last increment converged to.
    pub fn known(&self, time: f64, increment: &Increment<D>) -> Option<PathPoint<Z>> {
        let (zone, ..) = self.previous.as_ref().filter(|_| increment.converged)?;
        Some(PathPoint {
            time,
            zone: zone.clone(),
            area: increment.area(),
            force: increment.report.as_ref().map_or(0.0, |r| r.force()),
            energy_total: increment.energy_total(),
            margin: increment.stability.margin,
        })
    }

    /// Takes the scales from another time, where those of the beginning say nothing: before any load there are none.
    pub fn measure(&mut self, membrane: &Membrane<D>) -> Option<Scales> {
        let free = Equilibrium::solve(membrane, &Z::empty(&membrane.grid), &mut Elements::new(membrane)).ok()?;
        self.scales = Some(Scales::of_free(&free));
        self.scales
    }

    /// The zone that the last increment converged to.
    pub fn zone(&self) -> Option<Z> {
        self.previous.as_ref().map(|(zone, ..)| zone.clone())
    }

    /// Starts the next increment from another zone, in search of the stable state that follows.
    pub fn start_from(&mut self, zone: Z) {
        self.start_near(zone, Branch::Stable);
    }

    /// Starts the next increment from another zone.
    pub fn start_near(&mut self, zone: Z, branch: Branch) {
        self.trail.clear();
        self.previous = self.scales.map(|scales| (zone, scales, branch));
    }

    /// Starts the next increment from a state that is known to be one, on the cells that it was found on.
    pub fn start_on(&mut self, zone: Z, cells: Membrane<D>) {
        self.start_near(zone, Branch::Nearest);
        self.cells = Some(cells);
    }

    /// The scales of the problem, once a state is known.
    pub fn scales(&self) -> Option<Scales> {
        self.scales
    }

    /// Whether a membrane without contact would penetrate a body; none where that cannot be computed.
    pub fn reaches_obstacle(&self, membrane: &Membrane<D>) -> Option<bool> {
        prediction::reaches_obstacle::<D, Z>(membrane, &mut Elements::new(membrane)).ok()
    }

    /// Whether the case asks for a zone that no increment has started from yet.
    pub fn is_asked(&self) -> bool {
        self.asked.is_some()
    }
}
