//! Two sides that may touch: how their contact is tested and kept, and what it came to.

pub use signorini_mechanics::Enforcement;

use crate::body::BodySurface;
use crate::friction::statement::{Friction, FrictionResult, RigidMotion, Rubbing, SlipHistory};
use crate::step_error::StepError;
use crate::supports::Reduction;
use nalgebra::{DMatrix, DVector};
use signorini_contact::{
    ContactSurface, ContactZone, Faces, GapJet, GapPoint, Given, Measured, Obstacle, Pressed, PressureNodes, Rigid,
    Tests, WeightedGap, looks_at, rigid_points, segments, shares, unpressed, weighted_gaps, weightless,
};
use signorini_fem::hierarchic::Values;
use signorini_fem::{Local, Side};
use signorini_geometry::Point;
use std::collections::HashMap;

/// The gap of a point to a rigid body with its derivatives.
pub type RigidGap<const D: usize> = Box<dyn Fn(&Point<D>) -> GapJet<D> + Sync>;

/// The other side of a contact.
pub enum Master<const D: usize> {
    Surface(BodySurface<D>),
    Rigid,
}

impl<const D: usize> Master<D> {
    /// The faces; a rigid body has none.
    pub(crate) fn surface(&self) -> Option<&dyn ContactSurface<D>> {
        match self {
            Master::Surface(surface) => Some(surface),
            Master::Rigid => None,
        }
    }
}

/// Where the contact conditions are tested.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// In the mean, with dual functions on cut faces.
    Mortar,
    /// At the pressure nodes of the slave side.
    Node,
    /// At its quadrature points.
    GaussPoint,
}

/// The sides of a surface that look at another one: over the closest point of the other, against its normal. So that of
/// two thin bodies on each other only the faces between them meet.
///
/// # Errors
/// Faces that make no shape, in words.
#[inline(never)]
pub fn facing<const D: usize>(surface: &BodySurface<D>, other: &BodySurface<D>) -> Result<Vec<Side>, String> {
    let faces = Faces::new(other).map_err(|e| e.to_string())?;
    Ok((0..surface.sides.len())
        .filter(|&face| {
            let at = surface.at(face, &surface.shape(face).centre());
            let own = at.area_normal();
            let found = faces.meet(&at.x, &[]);
            found.is_some_and(|found| looks_at(&own, &Point::<D>::from_fn(|k, _| found.normal[k])))
        })
        .map(|face| surface.sides[face])
        .collect())
}

/// Two sides that may touch.
pub struct Contact<const D: usize> {
    pub name: String,
    pub slave: BodySurface<D>,
    pub master: Master<D>,
    pub method: Method,
    pub enforcement: Enforcement,
    /// Without it the sides slide freely.
    pub friction: Option<Friction<D>>,
    /// The slips of the rows, and what they count from.
    pub(crate) slips: SlipHistory<D>,
    pub(crate) nodes: PressureNodes<D>,
    pub(crate) points: Vec<Vec<GapPoint<D>>>,
    pub(crate) rows: Vec<WeightedGap>,
    /// Nodes that share the pressure of another.
    pub(crate) given: Vec<Given>,
    /// Nodes whose Lagrange functions have no integral.
    pub(crate) weightless: Vec<Given>,
    /// Of every pressure node the normal, and the first unknowns of the functions that move it.
    moved_by: Vec<(Point<D>, Vec<u32>)>,
    /// Points under test.
    pub(crate) tests: Tests,
    /// Their gaps at the last configuration.
    pub(crate) measured: Option<Measured>,
    /// Face and coordinates of the rows that are points.
    pub(crate) places: Vec<(usize, Local)>,
    /// Pressure per penetration of the cells behind each face, and behind each row.
    pub(crate) face_stiffness: Vec<f64>,
    pub(crate) stiffness: Vec<f64>,
    /// With Nitsche's method: the rows without the stress, and the stress at their points.
    pub(crate) bare: Vec<WeightedGap>,
    pub(crate) stresses: Vec<Vec<(u32, f64)>>,
}

impl<const D: usize> Contact<D> {
    #[inline(never)]
    pub fn new(name: &str, slave: BodySurface<D>, master: Master<D>) -> Self {
        let nodes = PressureNodes::new(&slave);
        let mut moved_by = vec![(Point::<D>::zeros(), Vec::new()); nodes.len()];
        let mut trace = Vec::new();
        for face in 0..slave.sides.len() {
            for ((node, normal), s) in nodes.of_face(face).iter().zip(nodes.map(face).nodes()) {
                trace.clear();
                slave.trace(face, &s, &mut trace);
                let functions = trace.iter().filter(|(_, value)| value.abs() > VANISHES).map(|(unknown, _)| *unknown);
                moved_by[*node as usize] = (*normal, functions.collect());
            }
        }
        let weightless = weightless(&slave, &nodes, &|_| false);
        let face_stiffness = (0..slave.sides.len()).map(|face| face_stiffness(&slave, face)).collect();
        Contact {
            name: name.to_string(),
            slave,
            master,
            method: Method::Mortar,
            enforcement: Enforcement::Multiplier,
            friction: None,
            slips: SlipHistory::default(),
            nodes,
            points: Vec::new(),
            rows: Vec::new(),
            given: Vec::new(),
            weightless,
            moved_by,
            tests: Tests::default(),
            measured: None,
            places: Vec::new(),
            face_stiffness,
            stiffness: Vec::new(),
            bare: Vec::new(),
            stresses: Vec::new(),
        }
    }

    /// Finds out what faces what. `rigid` is where a rigid master is now, and `motion` how it came there. Rows between bodies
    /// are found once, with the bodies at rest.
    pub(crate) fn search(
        &mut self,
        reduction: &Reduction<D>,
        (rigid, motion): (Option<&RigidGap<D>>, Option<&RigidMotion<D>>),
    ) -> Result<(), StepError> {
        match self.method {
            _ if matches!(self.master, Master::Surface(_)) && !self.rows.is_empty() => return Ok(()),
            Method::Mortar if self.enforcement == Enforcement::Nitsche => self.point_rows(rigid),
            Method::Mortar => self.search_segments(reduction, rigid, motion)?,
            _ => {
                self.search_points(reduction, rigid)?;
                self.find_slips_of_points(motion)?;
            }
        }
        self.check_side(rigid)?;
        self.find_stiffness();
        if self.enforcement == Enforcement::Nitsche {
            self.add_stresses();
        }
        Ok(())
    }

    /// The rows of points against closest points of the master.
    fn search_points(&mut self, reduction: &Reduction<D>, rigid: Option<&RigidGap<D>>) -> Result<(), StepError> {
        if self.tests.points.is_empty() {
            (self.given, self.tests) = if self.method == Method::GaussPoint {
                (self.weightless.clone(), Tests::at_quadrature_points(&self.slave))
            } else {
                let given = weightless(&self.slave, &self.nodes, &|k| self.is_folded(reduction, k));
                let tests = Tests::at_nodes(&self.slave, &self.nodes, &given);
                (given, tests)
            };
        }
        let faces;
        let body;
        let (obstacle, reach): (&dyn Obstacle<D>, f64) = match (self.master.surface(), rigid) {
            (Some(master), _) => {
                faces = Faces::new(master)
                    .map_err(|error| StepError::Shape { contact: self.name.clone(), message: error.to_string() })?;
                (&faces, 0.5 * self.slave.size())
            }
            (None, Some(rigid)) => {
                body = Rigid(rigid);
                (&body, f64::INFINITY)
            }
            (None, None) => return Ok(()),
        };
        let measured = self.tests.measure(&self.slave, obstacle, reach);
        let rows = measured.rows(&self.tests);
        self.places = rows.iter().filter_map(|(k, _)| self.tests.rows[*k].place).collect();
        self.rows = rows.into_iter().map(|(_, row)| row).collect();
        self.measured = Some(measured);
        Ok(())
    }

    /// The stiffness of the cell behind each row.
    fn find_stiffness(&mut self) {
        let of_face = &self.face_stiffness;
        let mut of_node = vec![0.0f64; self.nodes.len()];
        for face in 0..self.nodes.face_count() {
            for (node, _) in self.nodes.of_face(face) {
                of_node[*node as usize] = of_node[*node as usize].max(of_face[face]);
            }
        }
        self.stiffness = (self.rows.iter().enumerate())
            .map(|(k, row)| match self.method {
                _ if self.at_points() => of_face[self.places[k].0],
                _ => of_node[row.node as usize],
            })
            .collect();
    }

    pub fn nodes(&self) -> &PressureNodes<D> {
        &self.nodes
    }

    pub fn points(&self) -> &[Vec<GapPoint<D>>] {
        &self.points
    }

    /// The weighted gaps at no displacement.
    pub fn rows(&self) -> &[WeightedGap] {
        &self.rows
    }

    /// Where a master faces the slave side, at rest.
    pub(crate) fn cut_at_rest(&self, rigid: Option<&RigidGap<D>>) -> Vec<Vec<GapPoint<D>>> {
        match (&self.master, rigid) {
            (Master::Surface(surface), _) => {
                segments(&self.slave, surface, &self.nodes, 0.5 * self.slave.size().max(surface.size()))
            }
            (_, Some(gap)) => rigid_points(&self.slave, &|x| gap(x)),
            (_, None) => Vec::new(),
        }
    }

    fn search_segments(
        &mut self,
        reduction: &Reduction<D>,
        rigid: Option<&RigidGap<D>>,
        motion: Option<&RigidMotion<D>>,
    ) -> Result<(), StepError> {
        self.points = self.cut_at_rest(rigid);
        self.move_rigid(motion);
        if matches!(self.master, Master::Rigid) {
            // Faces that look away from a rigid body cannot touch it.
            for (face, list) in self.points.iter_mut().enumerate() {
                let looks = |p: &GapPoint<D>| looks_at(&self.slave.at(face, &p.s).area_normal(), &p.direction);
                if !list.iter().any(looks) {
                    list.clear();
                }
            }
        }
        let shares = shares(&self.slave, &self.nodes, &self.points, &|node| self.is_folded(reduction, node));
        self.rows = weighted_gaps(&self.slave, self.master.surface(), &self.points, &shares);
        self.tests = Tests::in_the_mean(&self.points, &shares);
        self.find_slips(&shares)?;
        self.given = shares.given;
        Ok(())
    }

    /// The points of the slave side with the forces on them, from the pressures of the rows.
    pub(crate) fn pressed(&self, pressures: &[f64]) -> Vec<Pressed> {
        let of_row: HashMap<u32, f64> = self.rows.iter().zip(pressures).map(|(row, p)| (row.node, *p)).collect();
        let met = |k: usize| self.measured.as_ref().is_none_or(|m| m.meets(k));
        let forces = (self.tests.points.iter().enumerate()).filter(|(k, _)| met(*k)).map(|(_, point)| {
            let of = |row: u32| of_row.get(&self.tests.rows[row as usize].number).copied().unwrap_or(0.0);
            let force = point.shares.iter().map(|(row, share)| share * of(*row)).sum();
            // Nodes carry forces, but stand for no area of their own.
            let area = if self.at_nodes() { 0.0 } else { point.shares.iter().map(|(_, share)| share).sum() };
            Pressed { face: point.face, s: point.s, area, force }
        });
        let mut out = if self.at_nodes() { unpressed(&self.slave, &self.nodes) } else { Vec::new() };
        out.extend(forces);
        out
    }

    /// Whether every row is a node.
    fn at_nodes(&self) -> bool {
        self.method == Method::Node && !self.at_points()
    }

    /// Whether the displacement of a pressure node is prescribed along its normal: it cannot have a pressure then.
    fn is_folded(&self, reduction: &Reduction<D>, node: u32) -> bool {
        let (normal, functions) = &self.moved_by[node as usize];
        let held = |unknown: usize| (0..D).all(|i| normal[i].abs() < 1e-6 || reduction.is_held(unknown + i));
        !functions.is_empty() && functions.iter().all(|unknown| held(*unknown as usize))
    }
}

/// Value of a function at a node below which it vanishes there: functions are of the order of one.
const VANISHES: f64 = 1e-10;

/// Share of its size that a slave side may lie inside the master at the start.
const DEEP: f64 = 0.05;

impl<const D: usize> Contact<D> {
    /// Where a row is.
    pub(crate) fn position(&self, row: usize) -> Point<D> {
        match self.method {
            _ if self.at_points() => self.slave.at(self.places[row].0, &self.places[row].1).x,
            _ => self.nodes.positions[self.rows[row].node as usize],
        }
    }

    /// Refuses a rigid body around the whole slave side that no part of it looks at: its normal points inwards, or the
    /// wrong side of it was named.
    fn check_side(&self, rigid: Option<&RigidGap<D>>) -> Result<(), StepError> {
        let Some(rigid) = rigid.filter(|_| self.rows.is_empty()) else { return Ok(()) };
        let depths = (0..self.slave.sides.len()).map(|face| {
            let centre = self.slave.shape(face).centre();
            -rigid(&self.slave.at(face, &centre).x).gap
        });
        let (least, most) = depths.fold((f64::INFINITY, 0.0f64), |(l, m), depth| (l.min(depth), m.max(depth)));
        if least > 0.0 && most.is_finite() && most > 0.0 {
            return Err(StepError::Deep { contact: self.name.clone(), depth: most });
        }
        Ok(())
    }

    /// Refuses bodies that lie in each other by far more than small displacements could mend.
    pub(crate) fn check_start(&self) -> Result<(), StepError> {
        let depth = self.rows.iter().map(|r| -r.gap / r.weight).fold(0.0, f64::max);
        let mean: f64 = self.rows.iter().map(|r| r.gap).sum();
        if mean < 0.0 && depth > DEEP * self.slave.size() {
            return Err(StepError::Deep { contact: self.name.clone(), depth });
        }
        Ok(())
    }
}

/// Young's modulus over the depth of the cell behind a face.
fn face_stiffness<const D: usize>(slave: &BodySurface<D>, face: usize) -> f64 {
    let body = slave.body();
    let middle = slave.at(face, &slave.shape(face).centre());
    let normal = middle.area_normal().normalize();
    let depth = (body.mesh.vertices(slave.sides[face].cell as usize))
        .map(|v| normal.dot(&(middle.x - body.mesh.nodes()[v as usize])))
        .fold(0.0, f64::max);
    body.material.youngs_modulus / depth.max(f64::MIN_POSITIVE)
}

/// What a contact came to.
#[derive(Clone, Debug)]
pub struct ContactResult<const D: usize> {
    /// Position, pressure, gap and whether active, of every pressure node.
    pub nodes: Vec<PressureNode<D>>,
    /// Force on the slave.
    pub force: Point<D>,
    /// Area in contact.
    pub area: f64,
    /// The same by face, and where it ends.
    pub zone: ContactZone,
    /// With friction, what it came to.
    pub friction: Option<FrictionResult<D>>,
}

/// The state of a pressure node.
#[derive(Clone, Copy, Debug)]
pub struct PressureNode<const D: usize> {
    pub x: Point<D>,
    /// The multiplier: its product with the weight is the force of the node.
    pub multiplier: f64,
    /// The recovered pressure.
    pub pressure: f64,
    /// On the slave; zero where another node carries the force of this one.
    pub force: Point<D>,
    pub gap: f64,
    pub active: bool,
    pub weight: f64,
    pub number: u32,
    /// With friction.
    pub rubbing: Rubbing<D>,
}

impl<const D: usize> Contact<D> {
    /// Pressures of quadrature points as means over the pressure nodes, and their gaps at the nodes.
    pub(crate) fn averaged(
        &self,
        pressure: &[f64],
        forces: &[Point<D>],
        gap: &[f64],
        active: &[bool],
    ) -> Vec<PressureNode<D>> {
        let count = self.nodes.len();
        let mut resultant = vec![Point::<D>::zeros(); count];
        let (mut weight, mut force, mut gaps, mut area, mut carries) =
            (vec![0.0; count], vec![0.0; count], vec![0.0; count], vec![0.0; count], vec![false; count]);
        let mut at = Values::default();
        let mut of_face: Vec<Vec<usize>> = vec![Vec::new(); self.nodes.face_count()];
        self.places.iter().enumerate().for_each(|(k, (face, _))| of_face[*face].push(k));
        for (face, list) in of_face.iter().enumerate().filter(|(_, list)| !list.is_empty()) {
            let own = self.nodes.of_face(face);
            let mut functions = DMatrix::<f64>::zeros(own.len(), list.len());
            for (q, &k) in list.iter().enumerate() {
                self.nodes.map(face).tabulate(&self.places[k].1, &mut at);
                for (i, ((node, _), v)) in own.iter().zip(&at.value).enumerate() {
                    let (n, w) = (*node as usize, v * self.rows[k].weight);
                    functions[(i, q)] = *v;
                    weight[n] += w;
                    force[n] += w * pressure[k];
                    resultant[n] += forces[k] * *v;
                    carries[n] |= active[k] && *v > 0.1;
                }
            }
            // The polynomial through the gaps of the face; where a few points do not make one, their mean.
            let whole: f64 = list.iter().map(|&k| self.rows[k].weight).sum();
            let mut weighted = functions.clone();
            (list.iter().enumerate()).for_each(|(q, &k)| weighted.column_mut(q).scale_mut(self.rows[k].weight));
            let measured = DVector::from_iterator(list.len(), list.iter().map(|&k| gap[k] / self.rows[k].weight));
            let factor = (&weighted * functions.transpose()).cholesky().filter(|_| list.len() >= own.len());
            let mean = list.iter().map(|&k| gap[k]).sum::<f64>() / whole;
            let values = factor.map_or(DVector::repeat(own.len(), mean), |f| f.solve(&(&weighted * measured)));
            for ((node, _), value) in own.iter().zip(values.iter()) {
                area[*node as usize] += whole;
                gaps[*node as usize] += whole * value;
            }
        }
        self.weightless.iter().for_each(|g| weight[g.from as usize] = 0.0);
        (0..count)
            .filter(|&n| weight[n] > 0.0)
            .map(|n| {
                let mean = (force[n] / weight[n]).max(0.0);
                PressureNode {
                    x: self.nodes.positions[n],
                    multiplier: mean,
                    pressure: mean,
                    force: resultant[n],
                    gap: gaps[n] / area[n],
                    active: carries[n],
                    weight: weight[n],
                    number: n as u32,
                    rubbing: Rubbing::default(),
                }
            })
            .collect()
    }
}
