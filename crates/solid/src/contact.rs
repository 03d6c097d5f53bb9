//! Two sides that may touch: how their contact is tested and kept, and what it came to.

use crate::body::BodySurface;
use crate::model::StepError;
use crate::supports::Reduction;
use signorini_contact::{
    ContactSurface, GapPoint, Given, MasterShapes, Meeting, PressureNodes, TestPoints, WeightedGap, point_rows,
    rigid_points, segments, weighted_gaps,
};
use signorini_fem::hierarchic::Values;
use signorini_geometry::Point;

/// The gap of a point to a rigid body, and the outward normal of that body.
pub type RigidGap<const D: usize> = Box<dyn Fn(&Point<D>) -> (f64, Point<D>) + Sync>;

/// The other side of a contact.
pub enum Master<const D: usize> {
    Surface(BodySurface<D>),
    Rigid,
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

/// How the contact conditions are kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Enforcement {
    /// Exactly.
    Multiplier,
    /// Exactly in the limit of outer iterations with a penalty.
    AugmentedLagrangian,
    /// Up to a penetration: the one wanted, or what a hundred times the stiffness of the adjacent cells leaves.
    Penalty { wanted_penetration: Option<f64> },
}

/// Two sides that may touch.
pub struct Contact<const D: usize> {
    pub name: String,
    pub slave: BodySurface<D>,
    pub master: Master<D>,
    pub method: Method,
    pub enforcement: Enforcement,
    pub(crate) nodes: PressureNodes<D>,
    pub(crate) points: Vec<Vec<GapPoint<D>>>,
    pub(crate) rows: Vec<WeightedGap>,
    /// Nodes that share the pressure of another.
    pub(crate) given: Vec<Given>,
    /// Face and coordinates of the rows of [`Method::GaussPoint`].
    places: Vec<(usize, signorini_fem::Local)>,
    /// Pressure per penetration of the cells behind each row.
    pub(crate) stiffness: Vec<f64>,
}

impl<const D: usize> Contact<D> {
    pub fn new(name: &str, slave: BodySurface<D>, master: Master<D>) -> Self {
        let nodes = PressureNodes::new(&slave);
        Contact {
            name: name.to_string(),
            slave,
            master,
            method: Method::Mortar,
            enforcement: Enforcement::Multiplier,
            nodes,
            points: Vec::new(),
            rows: Vec::new(),
            given: Vec::new(),
            places: Vec::new(),
            stiffness: Vec::new(),
        }
    }

    /// The rows of points against closest points of the master.
    fn search_points(&mut self, test: TestPoints, rigid: Option<&RigidGap<D>>) -> Result<(), StepError> {
        let reach = 0.5 * self.slave.size();
        let found = match &self.master {
            Master::Surface(surface) => {
                let shapes = MasterShapes::new(surface)
                    .map_err(|error| StepError::Shape { contact: self.name.clone(), message: error.to_string() })?;
                point_rows(&self.slave, &self.nodes, test, reach, Some(surface), &|x| shapes.meet(surface, x))
            }
            Master::Rigid => point_rows(&self.slave, &self.nodes, test, reach, None, &|x| {
                let (gap, normal) = rigid?(x);
                Some(Meeting { gap, normal, foot: None })
            }),
        };
        (self.rows, self.places) = (found.rows, found.places);
        Ok(())
    }

    /// Young's modulus over the depth of the cell behind each row.
    fn find_stiffness(&mut self) {
        let body = self.slave.body();
        let of_face: Vec<f64> = (0..self.slave.sides.len())
            .map(|face| {
                let side = self.slave.sides[face];
                let shape = self.slave.shape(face);
                let middle = self.slave.at(face, &shape.centre());
                let normal = middle.area_normal().normalize();
                let depth = (body.mesh.vertices(side.cell as usize))
                    .map(|v| normal.dot(&(middle.x - body.mesh.nodes()[v as usize])))
                    .fold(0.0, f64::max);
                body.material.youngs_modulus / depth.max(f64::MIN_POSITIVE)
            })
            .collect();
        let mut of_node = vec![0.0f64; self.nodes.len()];
        for face in 0..self.nodes.face_count() {
            for (node, _) in self.nodes.of_face(face) {
                of_node[*node as usize] = of_node[*node as usize].max(of_face[face]);
            }
        }
        self.stiffness = (self.rows.iter().enumerate())
            .map(|(k, row)| match self.method {
                Method::GaussPoint => of_face[self.places[k].0],
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

    /// Finds out what faces what. `rigid` is where a rigid master is now.
    pub(crate) fn search(&mut self, reduction: &Reduction<D>, rigid: Option<&RigidGap<D>>) -> Result<(), StepError> {
        // Between bodies everything is at rest: what was found once stays.
        if matches!(self.master, Master::Surface(_)) && !self.rows.is_empty() {
            return Ok(());
        }
        match self.method {
            Method::Mortar => self.search_segments(reduction, rigid),
            Method::Node => self.search_points(TestPoints::Nodes, rigid)?,
            Method::GaussPoint => self.search_points(TestPoints::Gauss, rigid)?,
        }
        self.find_stiffness();
        Ok(())
    }

    fn search_segments(&mut self, reduction: &Reduction<D>, rigid: Option<&RigidGap<D>>) {
        let master = match &self.master {
            Master::Surface(surface) => {
                let reach = 0.5 * self.slave.size().max(surface.size());
                self.points = segments(&self.slave, surface, &self.nodes, reach);
                Some(surface as &dyn ContactSurface<D>)
            }
            Master::Rigid => {
                self.points = match rigid {
                    Some(gap) => rigid_points(&self.slave, &|x| gap(x)),
                    None => Vec::new(),
                };
                None
            }
        };
        // A node whose displacement is prescribed along the normal cannot have a pressure of its own.
        let mut normals = vec![Point::<D>::zeros(); self.nodes.len()];
        let mut functions: Vec<Option<u32>> = vec![None; self.nodes.len()];
        for face in 0..self.slave.sides.len() {
            let map = self.nodes.map(face);
            let places = map.vertex_nodes();
            let vertices = self.slave.vertices(face);
            for (v, place) in places.into_iter().enumerate() {
                let (node, normal) = self.nodes.of_face(face)[place];
                normals[node as usize] = normal;
                functions[node as usize] = self.slave.body().dofs.vertex(vertices[v]);
            }
        }
        let first = self.slave.body().first;
        let folded = |node: u32| {
            let Some(f) = functions[node as usize] else { return false };
            let normal = normals[node as usize];
            (0..D).all(|i| normal[i].abs() < 1e-6 || reduction.is_held(first + f as usize * D + i))
        };
        let found = weighted_gaps(&self.slave, master, &self.nodes, &self.points, &folded);
        (self.rows, self.given) = (found.rows, found.given);
    }
}

/// Share of its size that a slave side may lie inside the master at the start.
const DEEP: f64 = 0.05;

impl<const D: usize> Contact<D> {
    /// Where a row is.
    pub(crate) fn position(&self, row: usize) -> Point<D> {
        match self.method {
            Method::GaussPoint => self.slave.at(self.places[row].0, &self.places[row].1).x,
            _ => self.nodes.positions[self.rows[row].node as usize],
        }
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

/// What a contact came to.
#[derive(Clone, Debug)]
pub struct ContactResult<const D: usize> {
    /// Position, pressure, gap and whether active, of every pressure node.
    pub nodes: Vec<PressureNode<D>>,
    /// Force on the slave.
    pub force: Point<D>,
    /// Area of the nodes in contact.
    pub area: f64,
}

/// The state of a pressure node.
#[derive(Clone, Copy, Debug)]
pub struct PressureNode<const D: usize> {
    pub x: Point<D>,
    /// The multiplier: its product with the weight is the force of the node.
    pub multiplier: f64,
    /// The recovered pressure.
    pub pressure: f64,
    pub gap: f64,
    pub active: bool,
    pub weight: f64,
    pub number: u32,
}

impl<const D: usize> Contact<D> {
    /// Pressures and gaps of quadrature points as means over the pressure nodes.
    pub(crate) fn averaged(&self, pressure: &[f64], gap: &[f64], active: &[bool]) -> Vec<PressureNode<D>> {
        let count = self.nodes.len();
        let (mut weight, mut force, mut gaps, mut carries) =
            (vec![0.0; count], vec![0.0; count], vec![0.0; count], vec![false; count]);
        let mut at = Values::default();
        for (k, (face, s)) in self.places.iter().enumerate() {
            self.nodes.map(*face).tabulate(s, &mut at);
            for ((node, _), v) in self.nodes.of_face(*face).iter().zip(&at.value) {
                let (n, w) = (*node as usize, v * self.rows[k].weight);
                weight[n] += w;
                force[n] += w * pressure[k];
                gaps[n] += v * gap[k];
                carries[n] |= active[k] && *v > 0.1;
            }
        }
        (0..count)
            .filter(|&n| weight[n] > 0.0)
            .map(|n| {
                let mean = (force[n] / weight[n]).max(0.0);
                PressureNode {
                    x: self.nodes.positions[n],
                    multiplier: mean,
                    pressure: mean,
                    gap: gaps[n] / weight[n],
                    active: carries[n],
                    weight: weight[n],
                    number: n as u32,
                }
            })
            .collect()
    }
}
