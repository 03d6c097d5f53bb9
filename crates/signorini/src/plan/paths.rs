//! From the statement to paths on rigid bodies: shortest ones, those of yarns, ropes on given curves.

mod statement;

pub use statement::{PathPlan, PlannedEnd, PlannedPath, PlannedRope, PlannedStation, PlannedWinding, Task};

use super::located::LocatedExpression;
use super::planner::Planner;
use super::rigid::RigidBody;
use crate::expression::Scope;
use crate::problem::units::{FORCE, LENGTH, NONE};
use crate::problem::{
    Analysis, Around, Body, CaseError, KeyPath, List, Path as Stated, PathEnd, PathFriction, Problem, ProblemPart,
    RopeOnSurface, Shape, ShortestPath, Side, Value, Winding, suggestion,
};
use signorini_geometry::{Aabb, Jet, Point, Real, Vector};
use signorini_paths::curve::{Analytic, Curve, PointSpline};
use signorini_paths::friction::Friction;
use signorini_paths::winding::{At, Slippage};
use std::sync::Arc;

/// Times where no number of them is stated.
const FRAMES: usize = 2;
/// Where the eye is and what is up where it is not stated.
const VIEW: [[f64; 3]; 2] = [[1.0, -1.6, 0.9], [0.0, 0.0, 1.0]];

/// Reads a problem of paths.
///
/// # Errors
/// What is wrong with the problem, with its key.
pub fn plan_paths(problem: &Problem) -> Result<PathPlan, CaseError> {
    Planner::new(problem)?.paths()
}

/// The tables of each analysis of paths, and how many entries they have.
fn tables(problem: &Problem) -> [(Analysis, &'static str, usize); 3] {
    [
        (Analysis::Wrapping, "paths", problem.paths.len()),
        (Analysis::Winding, "winding", problem.winding.len()),
        (Analysis::EulerEytelwein, "ropes", problem.ropes.len()),
    ]
}

/// There are no tables of another analysis than that of the problem.
///
/// # Errors
/// One that there is.
pub(super) fn none_of_paths(problem: &Problem) -> Result<(), CaseError> {
    let of_paths = [Analysis::Wrapping, Analysis::Winding, Analysis::EulerEytelwein];
    if let (Some(view), false) = (&problem.view, problem.analysis.is_some_and(|a| of_paths.contains(&a))) {
        return Err(problem
            .error(
                view,
                "`view` is only for pictures of paths; for bodies in equilibrium the view is chosen automatically",
            )
            .help("leave it out; other views are available in ParaView"));
    }
    let other = tables(problem).into_iter().find(|(a, _, count)| problem.analysis != Some(*a) && *count > 0);
    let Some((analysis, key, _)) = other else { return Ok(()) };
    let word = match analysis {
        Analysis::Wrapping => "wrapping",
        Analysis::Winding => "winding",
        _ => "euler_eytelwein",
    };
    Err(problem
        .error(&KeyPath::of_keys(&[key]), format!("`{key}` belongs to another analysis"))
        .help(format!("analysis = \"{word}\"")))
}

impl LocatedExpression {
    /// Its value at a time; an error where it is no finite number.
    ///
    /// # Errors
    /// A value that is not finite.
    pub fn at(&self, problem: &Problem, time: f64) -> Result<f64, CaseError> {
        let value = self.expression.evaluate(&Scope { position: [f64::NAN; 3], time });
        if value.is_finite() {
            return Ok(value);
        }
        Err(problem.error(&self.key, format!("`{}` is {value} at t = {time}: not a finite number", self.key)))
    }
}

impl Planner<'_> {
    fn paths(&self) -> Result<PathPlan, CaseError> {
        let problem = self.problem;
        self.check_tables()?;
        let view = self.view()?;
        let (task, around) = match problem.analysis {
            Some(Analysis::Wrapping) => {
                let frames = match &problem.frames {
                    None => FRAMES,
                    Some(n) if (1..=100_000).contains(n) => *n as usize,
                    Some(n) => return Err(problem.error(n, format!("`frames` is {n}; valid are 1 to 100000"))),
                };
                let paths = problem.paths.iter().map(|(n, p)| self.shortest(n, p)).collect::<Result<Vec<_>, _>>()?;
                let around = self.around_paths(&paths)?;
                (Task::Wrapping { frames, paths }, around)
            }
            Some(Analysis::Winding) => {
                let list = problem.winding.iter().map(|(n, w)| self.winding(n, w)).collect::<Result<_, _>>()?;
                (Task::Winding(list), around(std::iter::empty()))
            }
            _ => {
                let list: Vec<PlannedRope> =
                    problem.ropes.iter().map(|(n, r)| self.rope_on_surface(n, r)).collect::<Result<_, _>>()?;
                let ends = list.iter().flat_map(|r| {
                    let [from, to] = r.curve.domain();
                    (0..=16).map(move |k| r.curve.jet(from + (to - from) * f64::from(k) / 16.0).x)
                });
                let box_of_all = around(ends);
                (Task::EulerEytelwein(list), box_of_all)
            }
        };
        let bodies = self.path_bodies(&around)?;
        Ok(PathPlan { head: self.head(Vec::new())?, bodies, view, task })
    }

    /// The tables of the analysis are there, and no others.
    fn check_tables(&self) -> Result<(), CaseError> {
        let problem = self.problem;
        none_of_paths(problem)?;
        for (analysis, key, count) in tables(problem) {
            if problem.analysis == Some(analysis) && count == 0 {
                let message = format!("the case has no path: this analysis requires tables `[{key}.NAME]`");
                return Err(problem.error(&KeyPath::of_keys(&["analysis"]), message));
            }
        }
        let others = [
            ("supports", problem.supports.len()),
            ("loads", problem.loads.len()),
            ("contacts", problem.contacts.len()),
            ("constraints", problem.constraints.len()),
            ("gravity", usize::from(problem.gravity.is_some())),
            ("steps", problem.steps.len()),
        ];
        let (limits, output) = (&problem.limits, &problem.output);
        let keys = [
            (&["limits", "max_time"][..], limits.max_time.is_some()),
            (&["limits", "max_iterations"], limits.max_iterations.is_some()),
            (&["output", "every"], output.every.is_some()),
            (&["output", "probes"], !output.probes.is_empty()),
            (&["output", "moments_about"], output.moments_about.is_some()),
            (&["stability"], problem.stability.is_some()),
        ];
        let tables = others.iter().map(|(key, count)| (std::slice::from_ref(key), *count > 0));
        match tables.chain(keys).find(|(_, is_there)| *is_there) {
            Some((key, _)) => Err(problem
                .error(
                    &KeyPath::of_keys(key),
                    format!("`{}` is for bodies in equilibrium, not for paths", key.join(".")),
                )
                .help("leave it out, or leave out `analysis`")),
            None => Ok(()),
        }
    }

    fn view(&self) -> Result<[Vector<3>; 2], CaseError> {
        let [from, up] = VIEW.map(Vector::<3>::from);
        let Some(view) = &self.problem.view else { return Ok([from, up]) };
        let vector = |list: &List<f64>| match list[..] {
            [x, y, z] if [x, y, z].iter().all(|v| v.is_finite()) => Ok(Vector::<3>::new(x, y, z)),
            _ => Err(self
                .problem
                .error(list, "a direction has three finite components")
                .help("from = [1, -2, 1], with z up")),
        };
        let from = vector(&view.from)?;
        let up = view.up.as_ref().map_or(Ok(up), vector)?;
        if from.cross(&up).norm() <= 1e-6 * from.norm() * up.norm() {
            return Err(self
                .problem
                .error(view, "`from` and `up` are parallel, or one of them is zero")
                .help("from = [1, -2, 1], and up = [0, 0, 1] or left out"));
        }
        Ok([from, up])
    }

    /// The number of a body.
    fn path_body(&self, at: &impl ProblemPart, name: &str) -> Result<usize, CaseError> {
        let names: Vec<&str> = self.problem.bodies.keys().map(String::as_str).collect();
        names
            .iter()
            .position(|n| *n == name)
            .ok_or_else(|| self.problem.error(at, format!("there is no body `{name}`")).help(suggestion(name, &names)))
    }

    fn shortest(&self, name: &str, key: &ShortestPath) -> Result<PlannedPath, CaseError> {
        let problem = self.problem;
        let parts = key.around.iter().filter(|a| matches!(a, Around::Part(_))).count();
        if parts != 0 && (parts != key.around.len() || parts != key.via.len() + 1) {
            let (given, wanted) = (key.around.len(), key.via.len() + 1);
            let message =
                format!("{given} entries, {parts} of them lists, but there are {wanted} parts between fixed points");
            return Err(problem
                .error(&key.around, message)
                .help("give names of bodies, or one list of names for each part"));
        }
        for (body, turns) in &key.turns {
            self.path_body(turns, body)?;
            if !(0..=1000).contains(turns) {
                return Err(problem.error(turns, format!("{turns} additional turns")).help("valid are 0 to 1000"));
            }
        }
        let station = |at: &dyn Fn(&str) -> Result<usize, CaseError>, body: &str| {
            let turns = key.turns.get(body).copied().unwrap_or(0) as u32;
            at(body).map(|body| PlannedStation::Around { body, turns })
        };
        let mut stations = Vec::new();
        for k in 0..=key.via.len() {
            if k > 0 {
                stations.push(PlannedStation::Via(self.path_end(&key.via[k - 1])?));
            }
            for entry in &key.around {
                if let Around::Body(body) = entry {
                    stations.push(station(&|b| self.path_body(entry, b), body)?);
                }
            }
            if let Some(Around::Part(bodies)) = key.around.get(k) {
                for body in bodies {
                    stations.push(station(&|b| self.path_body(body, b), body)?);
                }
            }
        }
        let force = |value: &Option<Value>| value.as_ref().map(|v| self.placed_in_time(v, FORCE)).transpose();
        Ok(PlannedPath {
            name: name.to_string(),
            key: self.key(key),
            from: self.path_end(&key.from)?,
            to: self.path_end(&key.to)?,
            stations,
            friction: key.friction.as_ref().map(|f| self.path_friction(f)).transpose()?,
            tension: force(&key.tension)?,
            end_tension: force(&key.end_tension)?,
        })
    }

    fn placed_in_time(
        &self,
        value: &Value,
        dimension: crate::problem::units::Dimension,
    ) -> Result<LocatedExpression, CaseError> {
        Ok(LocatedExpression { expression: self.reader.expression(value, dimension, &["t"])?, key: self.key(value) })
    }

    fn path_end(&self, end: &PathEnd) -> Result<PlannedEnd, CaseError> {
        match end {
            PathEnd::OnBody(on) => {
                let point = self.reader.numbers::<3>(&on.point, LENGTH)?;
                Ok(PlannedEnd::OnBody(self.path_body(&on.body, &on.body)?, Point::<3>::from(point)))
            }
            PathEnd::Space(values) => {
                let list = values.iter().map(|v| self.placed_in_time(v, LENGTH)).collect::<Result<Vec<_>, _>>()?;
                let found = list.len();
                let list: [LocatedExpression; 3] = list.try_into().map_err(|_| {
                    self.problem.error(values, format!("a point in space has 3 coordinates, found {found}"))
                })?;
                Ok(PlannedEnd::Space(list))
            }
        }
    }

    fn path_friction(&self, key: &PathFriction) -> Result<Friction, CaseError> {
        let PathFriction::Coulomb(key) = key;
        let values = key.mu.0.iter().map(|v| self.reader.number(v, NONE)).collect::<Result<Vec<_>, _>>()?;
        let pair = match values[..] {
            [mu] => [mu, mu],
            [first, second] => [first, second],
            _ => {
                let message = format!("{} coefficients: one, or one along and one across", values.len());
                return Err(self.problem.error(&key.mu, message));
            }
        };
        let friction = match &key.axis {
            None => Friction::Carried { along: pair[0], across: pair[1] },
            Some(axis) => {
                let list = (axis.iter())
                    .map(|v| self.reader.expression(v, NONE, &["x", "y", "z"]))
                    .collect::<Result<Vec<_>, _>>()?;
                if list.len() != 3 {
                    let message = format!("a direction in space has 3 components, found {}", list.len());
                    return Err(self.problem.error(axis, message));
                }
                let direction = move |x: &Point<3>| {
                    let scope = Scope { position: [x.x, x.y, x.z], time: 0.0 };
                    Vector::<3>::from_fn(|k, _| list[k].evaluate(&scope))
                };
                Friction::Attached { coefficients: pair, axis: Arc::new(direction) }
            }
        };
        friction.check().map_err(|e| self.problem.error(&key.mu, e.to_string()))?;
        Ok(friction)
    }

    fn winding(&self, name: &str, key: &Winding) -> Result<PlannedWinding, CaseError> {
        let problem = self.problem;
        let length = |value: &Option<Value>| value.as_ref().map(|v| self.reader.positive(v, LENGTH)).transpose();
        let slippage = match &key.slippage {
            None => None,
            Some(value) => {
                let expression = self.reader.expression(value, NONE, &["s", "angle", "r", "z"]).map_err(|e| {
                    e.or_help("it may contain s, angle (to the meridian), r and z of the yarn, in the base units")
                })?;
                Some(match expression.constant() {
                    Some(value) => Slippage::Constant(value),
                    None => Slippage::Variable(Arc::new(move |at: &At| {
                        expression.evaluate(&Scope { position: [at.angle, at.radius, at.height], time: at.s })
                    })),
                })
            }
        };
        let pattern = match &key.pattern {
            None => None,
            Some(pattern) if key.band.is_none() => {
                return Err(problem.error(pattern, "a pattern requires the width of the `band`"));
            }
            Some(pattern) => Some(match &pattern.circuits {
                Value::Text(word) if word == "auto" => None,
                value => {
                    let n = self.reader.number(value, NONE)?;
                    if n.fract() != 0.0 || !(1.0..=1e6).contains(&n) {
                        let message = format!("{n} is not a valid number of circuits");
                        return Err(problem.error(value, message).help("give 1 to 1000000, or \"auto\""));
                    }
                    Some(n as u32)
                }
            }),
        };
        let axis = key.axis.as_ref().map_or(Ok([0.0, 0.0, 1.0]), |a| self.reader.numbers::<3>(a, NONE))?;
        let axis = Vector::<3>::from(axis).try_normalize(0.0).ok_or_else(|| {
            let at = key.axis.as_ref().map_or_else(|| self.key(key), |a| self.key(a));
            problem.error(&at, "the axis vector is zero")
        })?;
        Ok(PlannedWinding {
            name: name.to_string(),
            key: self.key(key),
            body: self.path_body(&key.on, &key.on)?,
            start: [
                self.reader.number(&key.start.z, LENGTH)?,
                key.start.theta.as_ref().map_or(Ok(0.0), |v| self.reader.angle(v))?,
                self.reader.angle(&key.start.angle)?,
            ],
            slippage,
            friction: key.friction.as_ref().map(|v| self.reader.positive(v, NONE)).transpose()?,
            opening: key.polar_opening.as_ref().map(|o| self.reader.positive(&o.radius, LENGTH)).transpose()?,
            band: length(&key.band)?,
            pattern,
            axis,
            length: length(&key.length)?,
            spacing: length(&key.spacing)?,
        })
    }

    fn rope_on_surface(&self, name: &str, key: &RopeOnSurface) -> Result<PlannedRope, CaseError> {
        let force = |value: &Option<Value>| value.as_ref().map(|v| self.reader.positive(v, FORCE)).transpose();
        Ok(PlannedRope {
            name: name.to_string(),
            key: self.key(key),
            body: self.path_body(&key.on, &key.on)?,
            curve: self.curve(&key.path)?,
            friction: self.path_friction(&key.friction)?,
            tension: force(&key.tension)?.unwrap_or(1.0),
            end_tension: force(&key.end_tension)?,
        })
    }

    /// A stated curve with two derivatives: through points the spline of degree five.
    fn curve(&self, key: &Stated) -> Result<Box<dyn Curve>, CaseError> {
        match key {
            Stated::Formula(formula) => {
                let [from, to] = [self.reader.number(&formula.from, NONE)?, self.reader.number(&formula.to, NONE)?];
                let list = self.formula(formula)?;
                let formula_of = move |u: Jet<1>| {
                    let nothing = Jet::<1>::constant(0.0);
                    let scope = Scope { position: [u, nothing, nothing], time: nothing };
                    std::array::from_fn(|k| list[k].evaluate(&scope))
                };
                let curve = Analytic::new(formula_of, [from, to]);
                Ok(Box::new(curve.map_err(|e| self.problem.error(&formula.to, e.to_string()))?))
            }
            Stated::Points(_) | Stated::Spline(_) | Stated::File(_) => {
                let points = self.points_of_path(key)?;
                Ok(Box::new(PointSpline::new(&points).map_err(|e| self.problem.error(key, e.to_string()))?))
            }
            Stated::Arc(_) | Stated::Helix(_) => Ok(Box::new(self.path(key)?.into_curve())),
        }
    }

    /// The box of the fixed points of paths at the start, and as much around it.
    fn around_paths(&self, paths: &[PlannedPath]) -> Result<Aabb<3>, CaseError> {
        let mut points = Vec::new();
        for path in paths {
            let via =
                path.stations.iter().filter_map(|s| if let PlannedStation::Via(end) = s { Some(end) } else { None });
            for end in [&path.from, &path.to].into_iter().chain(via) {
                points.push(match end {
                    PlannedEnd::OnBody(_, point) => *point,
                    PlannedEnd::Space(x) => {
                        let [x, y, z] = [0, 1, 2].map(|k| x[k].at(self.problem, 0.0));
                        Point::<3>::new(x?, y?, z?)
                    }
                });
            }
        }
        Ok(around(points.into_iter()))
    }

    /// The bodies, of which only the geometry is wanted: all must be rigid and touched from outside. Heights are known in
    /// the box `around`.
    fn path_bodies(&self, around: &Aabb<3>) -> Result<Vec<RigidBody>, CaseError> {
        let problem = self.problem;
        let mut out = Vec::new();
        for (name, body) in &problem.bodies {
            let Body::Rigid(rigid) = body else {
                let message = format!("the body `{name}` is not rigid: paths run over rigid bodies");
                return Err(problem.error(body, message).help("[bodies.NAME.rigid]"));
            };
            if let Some(side @ Side::Inside) = &rigid.side {
                return Err(problem.error(side, "paths inside of bodies"));
            }
            // Triangles have no curvature; the surface through their vertices has.
            let is_mesh = matches!(rigid.shape, Shape::Stl(_) | Shape::File(_) | Shape::Triangles(_));
            out.push(if is_mesh {
                super::rigid::smooth_body::<3>(self, name, rigid)?
            } else {
                super::rigid::read::<3>(self, name, rigid, around)?
            });
        }
        Ok(out)
    }
}

/// The box of points and of a unit cube about the origin, and as much around it.
fn around(points: impl Iterator<Item = Point<3>>) -> Aabb<3> {
    let (mut low, mut high) = (Point::<3>::repeat(-1.0), Point::<3>::repeat(1.0));
    for x in points {
        (low, high) = (low.inf(&x), high.sup(&x));
    }
    let pad = Vector::<3>::repeat((high - low).max());
    Aabb::new(low - pad, high + pad)
}
