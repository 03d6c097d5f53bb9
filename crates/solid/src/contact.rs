//! Two sides that may touch: how their contact is tested and kept, and what it came to.

use crate::body::{Bodies, BodySurface};
use crate::model::StepError;
use crate::stiffness::{Table, normal_stress};
use crate::supports::Reduction;
use signorini_contact::{
    ContactSurface, Faces, GapJet, GapPoint, Given, Measured, Moved, Obstacle, PressureNodes, Rigid, Tests,
    WeightedGap, compress, looks_at, rigid_points, segments, shares, weighted_gaps,
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
    /// By the stress of the slave side, consistently and without unknowns of its own (Nitsche 1971, for contact Chouly &
    /// Hild 2013), skew-symmetric: `p = max(0, -n·σ n - c g)` at every quadrature point, with `c` the stiffness of the
    /// adjacent cells. Small sliding only.
    Nitsche,
    /// Up to a penetration: the one wanted, or what a hundred times the stiffness of the adjacent cells leaves.
    Penalty { wanted_penetration: Option<f64> },
}

/// How far the sides may slide along each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sliding {
    /// Little against the cells and radii: what faces what, and along which normal, stays as it is at rest.
    Small,
    /// Any way: gaps are measured where the bodies are, with the exact second variations in the tangent.
    Finite,
}

/// The sides of a surface that look at another one: over the closest point of the other, against its normal. So that of
/// two thin bodies on each other only the faces between them meet.
///
/// # Errors
/// Faces that make no shape, in words.
pub fn facing<const D: usize>(surface: &BodySurface<D>, other: &BodySurface<D>) -> Result<Vec<Side>, String> {
    let faces = Faces::new(other).map_err(|e| e.to_string())?;
    Ok((0..surface.sides.len())
        .filter(|&face| {
            let at = surface.at(face, &surface.shape(face).centre());
            let own = at.area_normal();
            let found = faces.meet(&at.x, &[], false);
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
    pub sliding: Sliding,
    pub(crate) nodes: PressureNodes<D>,
    pub(crate) points: Vec<Vec<GapPoint<D>>>,
    pub(crate) rows: Vec<WeightedGap>,
    /// Nodes that share the pressure of another.
    pub(crate) given: Vec<Given>,
    /// Normal and displacement function of the pressure nodes at vertices.
    vertex_nodes: HashMap<u32, (Point<D>, u32)>,
    /// Points under test where there are some.
    tests: Tests,
    /// Their gaps at the last configuration.
    measured: Option<Measured>,
    /// Face and coordinates of the rows that are points.
    places: Vec<(usize, Local)>,
    /// Pressure per penetration of the cells behind each row.
    pub(crate) stiffness: Vec<f64>,
    /// With Nitsche's method: the rows without the stress, and the stress at their points.
    pub(crate) bare: Vec<WeightedGap>,
    stresses: Vec<Vec<(u32, f64)>>,
}

impl<const D: usize> Contact<D> {
    pub fn new(name: &str, slave: BodySurface<D>, master: Master<D>) -> Self {
        let nodes = PressureNodes::new(&slave);
        let mut vertex_nodes = HashMap::new();
        for face in 0..slave.sides.len() {
            let vertices = slave.vertices(face);
            for (v, place) in nodes.map(face).vertex_nodes().into_iter().enumerate() {
                let (node, normal) = nodes.of_face(face)[place];
                if let Some(function) = slave.body().dofs.vertex(vertices[v]) {
                    vertex_nodes.insert(node, (normal, function));
                }
            }
        }
        Contact {
            name: name.to_string(),
            slave,
            master,
            method: Method::Mortar,
            enforcement: Enforcement::Multiplier,
            sliding: Sliding::Small,
            nodes,
            points: Vec::new(),
            rows: Vec::new(),
            given: Vec::new(),
            vertex_nodes,
            tests: Tests::default(),
            measured: None,
            places: Vec::new(),
            stiffness: Vec::new(),
            bare: Vec::new(),
            stresses: Vec::new(),
        }
    }

    /// Finds out what faces what with the bodies displaced by `u`. `rigid` is where a rigid master is now.
    ///
    /// With small sliding `u` is not read, and rows between bodies are found once. `near` says that `u` is so near the
    /// solution that the cuts of the faces may stay; what each point faces is found anew all the same.
    pub(crate) fn search(
        &mut self,
        reduction: &Reduction<D>,
        rigid: Option<&RigidGap<D>>,
        u: &[f64],
        near: bool,
    ) -> Result<(), StepError> {
        match (self.sliding, self.method) {
            // Between bodies everything is at rest: what was found once stays.
            (Sliding::Small, _) if matches!(self.master, Master::Surface(_)) && !self.rows.is_empty() => return Ok(()),
            (Sliding::Small, Method::Mortar) if self.enforcement == Enforcement::Nitsche => self.point_rows(rigid),
            (Sliding::Small, Method::Mortar) => self.search_segments(reduction, rigid),
            (Sliding::Small, _) => self.search_points(reduction, rigid, None, false)?,
            (Sliding::Finite, _) => self.search_points(reduction, rigid, Some(u), near)?,
        }
        self.check_side(rigid)?;
        self.find_stiffness();
        if self.enforcement == Enforcement::Nitsche {
            self.add_stresses();
        }
        Ok(())
    }

    /// The rows of points against closest points of the master; with a displacement, gaps are linear around it.
    fn search_points(
        &mut self,
        reduction: &Reduction<D>,
        rigid: Option<&RigidGap<D>>,
        u: Option<&[f64]>,
        near: bool,
    ) -> Result<(), StepError> {
        let moved = |surface| u.map(|u| Moved { surface, u });
        let slave = moved(&self.slave);
        let slave: &dyn ContactSurface<D> = slave.as_ref().map_or(&self.slave as _, |m| m as _);
        let master = match &self.master {
            Master::Surface(surface) => Some((surface, moved(surface as _))),
            Master::Rigid => None,
        };
        let master: Option<&dyn ContactSurface<D>> =
            master.as_ref().map(|(surface, moved)| moved.as_ref().map_or(*surface as _, |m| m as _));
        if self.method == Method::Mortar && !near {
            if let Some(master) = master {
                let reach = 0.5 * self.slave.size().max(self.master_size());
                let normals = PressureNodes::new(slave);
                self.points = segments(slave, master, &normals, reach);
                // Pressures count per area at rest.
                for (face, list) in self.points.iter_mut().enumerate() {
                    for p in list {
                        let area = |s: &dyn ContactSurface<D>| s.at(face, &p.s).area_normal().norm();
                        p.weight *= area(&self.slave) / area(slave);
                    }
                }
            } else if self.points.is_empty()
                && let Some(rigid) = rigid
            {
                self.points = rigid_points(&self.slave, &|x| rigid(x));
            }
            let shares = shares(&self.slave, &self.nodes, &self.points, &|k| self.is_folded(reduction, k));
            self.tests = Tests::in_the_mean(&self.points, &shares);
            self.given = shares.given;
        } else if self.method != Method::Mortar && self.tests.points.is_empty() {
            self.tests = match self.method {
                Method::GaussPoint => Tests::at_quadrature_points(&self.slave),
                _ => Tests::at_nodes(&self.slave, &self.nodes),
            };
        }
        let faces;
        let body;
        let (obstacle, reach): (&dyn Obstacle<D>, f64) = match (master, rigid) {
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
        let measured = self.tests.measure(slave, obstacle, reach, u.is_some());
        let rows = measured.rows(&self.tests);
        self.places = rows.iter().filter_map(|(k, _)| self.tests.rows[*k].place).collect();
        self.rows = rows.into_iter().map(|(_, row)| row).collect();
        if let Some(u) = u {
            for row in &mut self.rows {
                row.gap -= row.terms.iter().map(|(k, c)| c * u[*k as usize]).sum::<f64>();
            }
        }
        self.measured = Some(measured);
        Ok(())
    }

    /// What the turning normals add to the tangent under the pressures of the rows, by the numbers of the rows.
    pub(crate) fn curvature(&self, pressure: &HashMap<u32, f64>) -> Vec<(Vec<u32>, Vec<f64>)> {
        let Some(measured) = self.measured.as_ref().filter(|_| self.sliding == Sliding::Finite) else {
            return Vec::new();
        };
        let of_row: Vec<f64> =
            self.tests.rows.iter().map(|row| pressure.get(&row.number).copied().unwrap_or(0.0)).collect();
        measured.curvature(&self.tests, &of_row)
    }

    fn master_size(&self) -> f64 {
        match &self.master {
            Master::Surface(surface) => surface.size(),
            Master::Rigid => 0.0,
        }
    }

    /// Young's modulus over the depth of the cell behind each face.
    fn face_stiffness(&self) -> Vec<f64> {
        let body = self.slave.body();
        (0..self.slave.sides.len())
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
            .collect()
    }

    /// That of the cell behind each row.
    fn find_stiffness(&mut self) {
        let of_face = self.face_stiffness();
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

    /// Where the master faces the slave side.
    fn cut(&self, rigid: Option<&RigidGap<D>>) -> Vec<Vec<GapPoint<D>>> {
        match (&self.master, rigid) {
            (Master::Surface(surface), _) => {
                let reach = 0.5 * self.slave.size().max(surface.size());
                segments(&self.slave, surface, &self.nodes, reach)
            }
            (Master::Rigid, Some(gap)) => rigid_points(&self.slave, &|x| gap(x)),
            (Master::Rigid, None) => Vec::new(),
        }
    }

    fn search_segments(&mut self, reduction: &Reduction<D>, rigid: Option<&RigidGap<D>>) {
        self.points = self.cut(rigid);
        if matches!(self.master, Master::Rigid) {
            // Faces that look away from a rigid body cannot touch it.
            for (face, list) in self.points.iter_mut().enumerate() {
                let looks = |p: &GapPoint<D>| looks_at(&self.slave.at(face, &p.s).area_normal(), &p.direction);
                if !list.iter().any(looks) {
                    list.clear();
                }
            }
        }
        let master = match &self.master {
            Master::Surface(surface) => Some(surface as &dyn ContactSurface<D>),
            Master::Rigid => None,
        };
        let shares = shares(&self.slave, &self.nodes, &self.points, &|node| self.is_folded(reduction, node));
        self.rows = weighted_gaps(&self.slave, master, &self.points, &shares);
        self.given = shares.given;
    }

    /// Whether the displacement of a pressure node is prescribed along its normal: it cannot have a pressure then.
    fn is_folded(&self, reduction: &Reduction<D>, node: u32) -> bool {
        let Some((normal, function)) = self.vertex_nodes.get(&node) else { return false };
        let first = self.slave.body().first + *function as usize * D;
        (0..D).all(|i| normal[i].abs() < 1e-6 || reduction.is_held(first + i))
    }
}

/// Nitsche's method.
impl<const D: usize> Contact<D> {
    /// Whether every row is a quadrature point.
    pub(crate) fn at_points(&self) -> bool {
        self.method == Method::GaussPoint || self.enforcement == Enforcement::Nitsche
    }

    /// `c` over the stiffness of the adjacent cells.
    pub(crate) fn nitsche_factor(&self) -> f64 {
        (self.slave.body().degree as f64).powi(2)
    }

    /// One row for every point of the segments that looks at a rigid master, or faces another body; rows have the number
    /// of their point.
    fn point_rows(&mut self, rigid: Option<&RigidGap<D>>) {
        self.points = self.cut(rigid);
        (self.rows, self.places) = (Vec::new(), Vec::new());
        let mut trace = Vec::new();
        let mut number = 0;
        for (face, list) in self.points.iter().enumerate() {
            for p in list {
                let node = number;
                number += 1;
                if p.master.is_none() && !looks_at(&self.slave.at(face, &p.s).area_normal(), &p.direction) {
                    continue;
                }
                trace.clear();
                self.slave.trace(face, &p.s, &mut trace);
                let of_slave = trace.len();
                if let (Some((other, eta)), Master::Surface(master)) = (&p.master, &self.master) {
                    master.trace(*other as usize, eta, &mut trace);
                }
                let mut terms = Vec::new();
                for (k, (unknown, value)) in trace.iter().enumerate() {
                    let c = if k < of_slave { p.weight * value } else { -p.weight * value };
                    terms.extend((0..D).map(|i| (unknown + i as u32, c * p.direction[i])));
                }
                let (gap, weight) = (p.weight * p.gap, p.weight);
                self.rows.push(WeightedGap { gap, weight, terms, forces: Vec::new(), node });
                self.places.push((face, p.s));
            }
        }
    }

    /// `1/c ∫ δσ σ` over all points, which the method adds to the stiffness; nothing with other enforcements. The points
    /// do not depend on where a rigid master is.
    pub(crate) fn stress_terms(&mut self, bodies: &Bodies<D>) -> Vec<(Vec<u32>, Vec<f64>)> {
        if self.enforcement != Enforcement::Nitsche {
            return Vec::new();
        }
        let points: Vec<(usize, Local, f64)> = if self.method == Method::Mortar {
            let far: RigidGap<D> = Box::new(|_| GapJet::flat(1.0, Point::<D>::zeros()));
            let cut = self.cut(matches!(self.master, Master::Rigid).then_some(&far));
            cut.iter().enumerate().flat_map(|(face, list)| list.iter().map(move |p| (face, p.s, p.weight))).collect()
        } else {
            let tests = Tests::at_quadrature_points(&self.slave);
            tests.points.iter().zip(&tests.rows).map(|(point, row)| (point.face, point.s, row.weight)).collect()
        };
        let body = self.slave.body();
        let stiffness = self.face_stiffness();
        let mut stresses = Vec::with_capacity(points.len());
        let mut tables: HashMap<(usize, usize), Table> = HashMap::new();
        let mut out = Vec::new();
        for (face, s, weight) in points {
            let side = self.slave.sides[face];
            let cell = side.cell as usize;
            let basis = body.dofs.basis(cell);
            let key = (body.mesh.map_number(cell), body.dofs.basis_number(cell));
            let table = tables.entry(key).or_insert_with(|| Table::new(&body.mesh, &body.dofs, cell));
            let (xi, _) = basis.shape().on_side(side.side as usize, &s);
            let normal = self.slave.at(face, &s).area_normal().normalize();
            let along = normal_stress(&body.mesh, cell, table, basis, (&body.material, bodies.space), (&xi, &normal));
            let stress: Vec<(u32, f64)> = (body.dofs.cell(cell).iter().enumerate())
                .flat_map(|(a, (f, sign))| {
                    let first = body.first + *f as usize * D;
                    let along = &along;
                    (0..D).map(move |i| ((first + i) as u32, sign * along[a * D + i]))
                })
                .collect();
            let factor = weight / (self.nitsche_factor() * stiffness[face]);
            let matrix = (stress.iter().flat_map(|(_, a)| stress.iter().map(move |(_, b)| factor * a * b))).collect();
            out.push((stress.iter().map(|(unknown, _)| *unknown).collect(), matrix));
            stresses.push(stress);
        }
        self.stresses = stresses;
        out
    }

    /// Rows of `g - σ/c` with `σ = -n·σ n`, whose pressures push with `g + σ/c`: the skew-symmetric variant.
    fn add_stresses(&mut self) {
        self.bare = self.rows.clone();
        let factor = self.nitsche_factor();
        for (row, stiffness) in self.rows.iter_mut().zip(&self.stiffness) {
            let stress = &self.stresses[row.node as usize];
            let share = row.weight / (factor * stiffness);
            row.forces = row.terms.clone();
            row.terms.extend(stress.iter().map(|(unknown, c)| (*unknown, share * c)));
            row.forces.extend(stress.iter().map(|(unknown, c)| (*unknown, -share * c)));
            compress(&mut row.terms);
            compress(&mut row.forces);
        }
    }
}

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
