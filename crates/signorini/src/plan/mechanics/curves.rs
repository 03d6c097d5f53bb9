//! Ropes and beams of a system.

use super::Wrong;
use crate::expression::{Expression, Scope};
use crate::plan::placement::PlacementKeys;
use crate::plan::planner::Planner;
use crate::problem::units::{Dimension, FORCE, LENGTH, NONE, PRESSURE};
use crate::problem::{
    self, Beam, BeamModel, CaseError, Continuity, FormulaPath, List, Material, Path as Stated, PathFile, Rope, Value,
};
use signorini_geometry::shape::Axes;
use signorini_geometry::{Point, Vector};
use signorini_mechanics::Body;
use signorini_rope::beam::Beam as BeamBody;
use signorini_rope::cable::Cable;
use signorini_rope::cable::element::Carries;
use signorini_rope::centreline::{self, Closure};
use signorini_rope::chain::Chain;
use signorini_rope::chain::body::ReferenceLength;
use signorini_rope::mass::SectionMass;
use signorini_rope::path::{Path, Sampled};
use signorini_rope::section::{Section, Stiffness};

/// Bending stiffness: a force times an area.
const STIFFNESS: Dimension = [2, 1, 0, 0];
/// Elements of a rope and of a beam whose number is not stated.
const ROPE_CELLS: usize = 50;
const BEAM_CELLS: usize = 20;
/// Elements of a curve, or points of one: more fit into no memory.
const MOST_CELLS: i64 = 1_000_000;
/// Pieces of the spline that follows a formula: their error is below 1e-9 of the size of a curve that turns a few times.
const FORMULA: usize = 1000;

impl Planner<'_> {
    /// A rope, and its radius.
    pub(super) fn rope(&self, name: &str, key: &Rope, wrong: &Wrong) -> Result<(Box<dyn Body>, f64), CaseError> {
        let problem = self.problem;
        let smooth = key.continuity == Some(Continuity::C1);
        let path = self.path(&key.path)?;
        let cells = self.count(key.cells.as_ref(), ROPE_CELLS)?;
        let stiffness = self.reader.positive(&key.stiffness, FORCE)?;
        let radius = self.not_negative_length(key.radius.as_ref())?;
        let rest = match (&key.pretension, &key.unstrained_length) {
            (Some(_), Some(length)) => {
                return Err(problem
                    .error(length, "`pretension` and `unstrained_length` are alternatives")
                    .help("leave one of them out"));
            }
            (Some(tension), None) => {
                let value = self.reader.number(tension, FORCE)?;
                if value < 0.0 {
                    let message = format!("the pretension is {value}, but a rope carries tension only");
                    return Err(problem.error(tension, message).help("give 0 or more"));
                }
                ReferenceLength::Pretension(value)
            }
            (None, Some(length)) => ReferenceLength::Length(self.reader.positive(length, LENGTH)?),
            (None, None) => ReferenceLength::Path,
        };
        let sampled = self.sampled(&path, cells, smooth, &key.path)?;
        let refused = |message: String| problem.error(&key.path, message);
        if !smooth {
            for (stated, what) in [
                (key.bending_stiffness.as_ref().map(|v| self.key(v)), "bending_stiffness"),
                (key.contact_points.as_ref().map(|v| self.key(v)), "contact_points"),
            ] {
                if let Some(at) = stated {
                    return Err(problem
                        .error(&at, format!("`{what}` is for smooth ropes"))
                        .help("continuity = \"C1\""));
                }
            }
            let chain = Chain::new(name, &sampled, stiffness, rest, radius).map_err(|e| refused(e.to_string()))?;
            let chain = match self.mass_per_length(key)? {
                Some(mass) => chain.with_mass(mass),
                None => chain,
            };
            let chain = self.wound(name, key, chain, wrong)?;
            return Ok((Box::new(chain), radius));
        }
        for (stated, what) in [
            (key.pulleys.as_ref().map(|v| self.key(v)), "pulleys"),
            (key.winch.as_ref().map(|v| self.key(&v.at)), "a winch"),
        ] {
            if let Some(at) = stated {
                let message = format!("{what}: only for ropes of straight elements");
                return Err(problem.error(&at, message).help("continuity = \"C0\", or leave it out"));
            }
        }
        let bending = match &key.bending_stiffness {
            Some(value) => self.reader.number(value, STIFFNESS)?,
            None => 0.0,
        };
        let cable = Cable::new(name, &sampled, stiffness, bending, Carries::TensionOnly, rest, radius)
            .map_err(|e| refused(e.to_string()))?;
        let cable = match &key.contact_points {
            Some(n) => cable.with_contact_points(self.count(Some(n), 4)?),
            None => cable,
        };
        let cable = match self.mass_per_length(key)? {
            Some(mass) => cable.with_mass(mass),
            None => cable,
        };
        Ok((Box::new(cable), radius))
    }

    /// A beam, and its radius.
    pub(super) fn beam(&self, name: &str, key: &Beam) -> Result<(Box<dyn Body>, f64), CaseError> {
        let problem = self.problem;
        let path = self.path(&key.path)?;
        let cells = self.count(key.cells.as_ref(), BEAM_CELLS)?;
        let (stiffness, own_radius, mass) = self.section(key)?;
        let radius = match &key.radius {
            Some(_) => self.not_negative_length(key.radius.as_ref())?,
            None => own_radius.unwrap_or(0.0),
        };
        let sampled = self.sampled(&path, cells, true, &key.path)?;
        let points = key.contact_points.as_ref().map(|n| self.count(Some(n), 4)).transpose()?;
        let refused = |message: String| problem.error(&key.path, message);
        if key.model == Some(BeamModel::TorsionFree) {
            if stiffness.bending[0] != stiffness.bending[1] {
                return Err(problem
                    .error(&key.section, "a beam without torsion requires equal bending stiffness about all axes")
                    .help("use a circular section, or model = \"shear\""));
            }
            let (axial, bending) = (stiffness.axial, stiffness.bending[0]);
            let carries = Carries::TensionAndCompression;
            let cable = Cable::new(name, &sampled, axial, bending, carries, ReferenceLength::Path, radius)
                .map_err(|e| refused(e.to_string()))?;
            let cable = points.map_or(cable.clone(), |n| cable.with_contact_points(n));
            let cable = mass.map_or(cable.clone(), |mass| cable.with_mass(mass.mass));
            return Ok((Box::new(cable), radius));
        }
        let orientation = match &key.orientation {
            Some(values) => Some(self.position(values, NONE)?),
            None => None,
        };
        let beam = BeamBody::new(name, &sampled, orientation, stiffness, radius).map_err(|e| refused(e.to_string()))?;
        let beam = points.map_or(beam.clone(), |n| beam.with_contact_points(n));
        let beam = mass.map_or(beam.clone(), |mass| beam.with_mass(mass));
        Ok((Box::new(beam), radius))
    }

    /// The stiffness of a section, its radius if it is round, and its mass if it has one.
    pub(super) fn section(&self, key: &Beam) -> Result<(Stiffness, Option<f64>, Option<SectionMass>), CaseError> {
        let problem = self.problem;
        let section = match &key.section {
            problem::Section::Circle(circle) => {
                Section::Circle { radius: self.reader.positive(&circle.radius, LENGTH)? }
            }
            problem::Section::Rectangle(rectangle) => Section::Rectangle {
                width: self.reader.positive(&rectangle.width, LENGTH)?,
                height: self.reader.positive(&rectangle.height, LENGTH)?,
            },
            problem::Section::Stiffness(stated) => {
                if let Some(material) = &key.material {
                    let message = "a section with given stiffness has no material";
                    return Err(problem.error(material, message));
                }
                let two = |values: &problem::Components, dimension| match &values.0[..] {
                    [one] => self.reader.positive(one, dimension).map(|v| [v, v]),
                    [a, b] => Ok([self.reader.positive(a, dimension)?, self.reader.positive(b, dimension)?]),
                    list => {
                        Err(problem.error(values, format!("{} values: give one, or one for each axis", list.len())))
                    }
                };
                let axial = self.reader.positive(&stated.axial, FORCE)?;
                let bending = two(&stated.bending, STIFFNESS)?;
                return Ok((
                    Stiffness {
                        axial,
                        shear: stated.shear.as_ref().map_or(Ok([axial; 2]), |v| two(v, FORCE))?,
                        torsion: match &stated.torsion {
                            Some(v) => self.reader.positive(v, STIFFNESS)?,
                            None => bending[0],
                        },
                        bending,
                    },
                    None,
                    None,
                ));
            }
        };
        let Some(material) = &key.material else {
            return Err(problem
                .error(&key.section, "the section has a shape, so a material is required")
                .help("material.linear_elastic = { youngs_modulus = …, poissons_ratio = … }"));
        };
        let Material::LinearElastic(elastic) = material else {
            return Err(problem.error(material, "beams are linear elastic").help("material.linear_elastic = { … }"));
        };
        let modulus = self.reader.positive(&elastic.youngs_modulus, PRESSURE)?;
        let ratio = self.reader.number(&elastic.poissons_ratio, NONE)?;
        let stiffness =
            section.stiffness(modulus, ratio).map_err(|e| problem.error(&elastic.poissons_ratio, e.to_string()))?;
        let mass = self.density(key.density.as_ref())?.map(|density| section.mass(density));
        Ok((stiffness, section.radius(), mass))
    }

    fn count(&self, key: Option<&i64>, otherwise: usize) -> Result<usize, CaseError> {
        match key {
            None => Ok(otherwise),
            Some(n) => self.between(n, 1, MOST_CELLS),
        }
    }

    fn not_negative_length(&self, value: Option<&Value>) -> Result<f64, CaseError> {
        let Some(value) = value else { return Ok(0.0) };
        let length = self.reader.number(value, LENGTH)?;
        if length >= 0.0 {
            return Ok(length);
        }
        Err(self.problem.error(value, format!("the radius is {length}")).help("give 0 or more"))
    }

    fn sampled(&self, path: &Path, cells: usize, smooth: bool, key: &Stated) -> Result<Sampled, CaseError> {
        let continuity = if smooth { centreline::Continuity::C1 } else { centreline::Continuity::C0 };
        path.sample(cells, continuity).map_err(|e| self.problem.error(key, e.to_string()))
    }

    fn points(&self, list: &List<List<Value>>) -> Result<Vec<Point<3>>, CaseError> {
        list.iter().map(|x| self.position(x, LENGTH)).collect()
    }

    /// The points of a path that is stated by points; of a formula those at equal steps of its parameter.
    pub(in crate::plan) fn points_of_path(&self, key: &Stated) -> Result<Vec<Point<3>>, CaseError> {
        match key {
            Stated::Points(points) => self.points(points),
            Stated::Spline(spline) => self.points(&spline.points),
            Stated::File(file) => self.points_of_file(file),
            Stated::Formula(formula) => {
                let [from, to] = [self.reader.number(&formula.from, NONE)?, self.reader.number(&formula.to, NONE)?];
                if from == to {
                    let message = format!("the path begins and ends at u = {to}");
                    return Err(self
                        .problem
                        .error(&formula.to, message)
                        .help("give another value than that of `from`"));
                }
                let list = self.formula(formula)?;
                let coordinate = |k: usize, u: f64| {
                    let value = list[k].evaluate(&Scope { position: [u, 0.0, 0.0], time: 0.0 });
                    if value.is_finite() {
                        return Ok(value);
                    }
                    let message = format!("it is {value} at u = {u}: not a finite number");
                    let remedy = "give a formula with finite values from `from` to `to`";
                    Err(self.problem.error(&formula.position[k], message).help(remedy))
                };
                let at = |u: f64| Ok(Point::<3>::new(coordinate(0, u)?, coordinate(1, u)?, coordinate(2, u)?));
                (0..=FORMULA).map(|k| at(from + (to - from) * k as f64 / FORMULA as f64)).collect()
            }
            Stated::Arc(_) | Stated::Helix(_) => Ok(Vec::new()),
        }
    }

    /// The three coordinates of a formula.
    pub(in crate::plan) fn formula(&self, key: &FormulaPath) -> Result<Vec<Expression>, CaseError> {
        if key.position.len() != 3 {
            let message = format!("a point in space has 3 coordinates, found {}", key.position.len());
            return Err(self.problem.error(&key.position, message));
        }
        key.position.iter().map(|v| self.reader.expression(v, LENGTH, &["u"])).collect()
    }

    fn points_of_file(&self, file: &PathFile) -> Result<Vec<Point<3>>, CaseError> {
        let (path, bytes) = self.read_file(&file.file)?;
        let told = |e: String| self.problem.error(&file.file, format!("`{}`: {e}", path.display()));
        let text = String::from_utf8(bytes).map_err(|e| told(e.to_string()))?;
        let mut points = Path::read_points(&text).map_err(|e| told(e.to_string()))?;
        let keys = PlacementKeys { scale: &file.scale, rotate: &file.rotate, translate: &file.translate };
        if let Some(placement) = self.placement::<3>(&keys)? {
            points.iter_mut().for_each(|x| *x = placement.point(x));
        }
        Ok(points)
    }

    pub(in crate::plan) fn path(&self, key: &Stated) -> Result<Path, CaseError> {
        let problem = self.problem;
        let closure = |closed: &Option<bool>| if *closed == Some(true) { Closure::Closed } else { Closure::Open };
        let points = self.points_of_path(key)?;
        let found = match key {
            Stated::Points(_) => Path::points(&points, Closure::Open),
            Stated::Spline(spline) => Path::spline(&points, closure(&spline.closed)),
            Stated::Formula(_) => Path::spline(&points, Closure::Open),
            Stated::File(file) => match file.spline {
                Some(true) => Path::spline(&points, closure(&file.closed)),
                _ => Path::points(&points, closure(&file.closed)),
            },
            Stated::Arc(arc) => {
                let points: [Point<3>; 3] = self.points(&arc.points)?.try_into().map_err(|list: Vec<_>| {
                    problem.error(&arc.points, format!("an arc has 3 points, found {}", list.len()))
                })?;
                Path::arc(points)
            }
            Stated::Helix(helix) => {
                let center = helix.center.as_ref().map_or(Ok(Point::<3>::zeros()), |c| self.position(c, LENGTH))?;
                let direction = |values: &Option<List<Value>>, otherwise: Vector<3>| match values {
                    None => Ok(otherwise),
                    Some(values) => self
                        .position(values, NONE)?
                        .try_normalize(0.0)
                        .ok_or_else(|| problem.error(values, "the direction vector is zero")),
                };
                let axis = direction(&helix.axis, Vector::<3>::z())?;
                let towards = direction(&helix.towards, signorini_mechanics::pair::any_tangent(&axis))?;
                let across = (towards - axis * axis.dot(&towards)).try_normalize(1e-12).ok_or_else(|| {
                    let at = helix.towards.as_ref().map_or(self.key(key), |t| self.key(t));
                    problem.error(&at, "the direction to the start is parallel to the axis")
                })?;
                let axes =
                    Axes::new(center, across, axis.cross(&across)).map_err(|e| problem.error(key, e.to_string()))?;
                let radius = self.reader.positive(&helix.radius, LENGTH)?;
                let pitch = self.reader.number(&helix.pitch, LENGTH)?;
                let turns = self.reader.number(&helix.turns, NONE)?;
                Path::helix(axes, radius, pitch, turns)
            }
        };
        found.map_err(|e| problem.error(key, e.to_string()))
    }
}
