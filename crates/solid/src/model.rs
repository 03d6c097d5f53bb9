//! A problem of elastic solids in contact, and its solution at one time.

use crate::body::{Bodies, BodySurface};
use crate::rigid_modes::{FreeMode, free_modes};
use crate::stiffness::{Table, stiffness};
use crate::supports::{Displacement, Reduction, Support, SupportError, beds};
use rayon::prelude::*;
use signorini_contact::{
    ActiveSet, ActiveSetError, Compliance, ContactState, ContactSurface, GapPoint, MasterShapes, Meeting,
    PressureNodes, Softness, Spring, TestPoints, WeightedGap, point_rows, recovered, rigid_points, segments,
    weighted_gaps,
};
use signorini_fem::hierarchic::Values;
use signorini_geometry::Point;
use signorini_solve::cholesky::Symbolic;
use signorini_solve::dissection::nested_dissection;
use signorini_solve::{Factor, SolveError, SymmetricMatrix};
use std::collections::HashMap;

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
    nodes: PressureNodes<D>,
    points: Vec<Vec<GapPoint<D>>>,
    rows: Vec<WeightedGap>,
    /// Face and coordinates of the rows of [`Method::GaussPoint`].
    places: Vec<(usize, signorini_fem::Local)>,
    /// Pressure per penetration of the cells behind each row.
    stiffness: Vec<f64>,
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
            places: Vec::new(),
            stiffness: Vec::new(),
        }
    }

    /// The rows of points against closest points of the master.
    fn search_points(&mut self, test: TestPoints, rigid: Option<&RigidGap<D>>) -> Result<(), StepError> {
        let reach = 0.5 * self.slave.size();
        let found = match &self.master {
            Master::Surface(surface) => {
                if !self.rows.is_empty() {
                    return Ok(());
                }
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
    fn search(&mut self, reduction: &Reduction<D>, rigid: Option<&RigidGap<D>>) -> Result<(), StepError> {
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
                if self.points.is_empty() {
                    let reach = 0.5 * self.slave.size().max(surface.size());
                    self.points = segments(&self.slave, surface, &self.nodes, reach);
                }
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
        self.rows = weighted_gaps(&self.slave, master, &self.nodes, &self.points, &folded);
    }
}

/// Share of its size that a slave side may lie inside the master at the start.
const DEEP: f64 = 0.05;

impl<const D: usize> Contact<D> {
    /// Refuses bodies that lie in each other by far more than small displacements could mend.
    fn check_start(&self) -> Result<(), StepError> {
        let depth = self.rows.iter().map(|r| -r.gap / r.weight).fold(0.0, f64::max);
        let mean: f64 = self.rows.iter().map(|r| r.gap).sum();
        if mean < 0.0 && depth > DEEP * self.slave.size() {
            return Err(StepError::Deep { contact: self.name.clone(), depth });
        }
        Ok(())
    }
}

/// Why a step has no solution.
#[derive(Clone, Debug, thiserror::Error)]
pub enum StepError {
    #[error(transparent)]
    Support(#[from] SupportError),
    #[error(transparent)]
    Solve(#[from] SolveError),
    #[error("contact `{contact}`: {error}")]
    Contact { contact: String, error: ActiveSetError, places: Vec<String> },
    #[error("body `{body}` is free {motion}")]
    Free { body: String, motion: String },
    #[error("contact `{contact}`: a face of the master makes no shape: {message}")]
    Shape { contact: String, message: String },
    /// Most of the slave side is inside the master before anything moves.
    #[error("contact `{contact}`: the bodies start {depth:.4e} deep in each other")]
    Deep { contact: String, depth: f64 },
    #[error("interrupted")]
    Interrupted,
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

/// The solution at one time.
#[derive(Clone, Debug)]
pub struct State<const D: usize> {
    /// Unknowns of all bodies.
    pub u: Vec<f64>,
    pub contacts: Vec<ContactResult<D>>,
    pub iterations: usize,
    /// Nodes that changed in each iteration.
    pub changes: Vec<usize>,
    /// Force of each support on the bodies.
    pub support_forces: Vec<Point<D>>,
    /// Largest unbalanced force relative to the largest of all.
    pub imbalance: f64,
    /// Strain energy.
    pub energy: f64,
    pub unknowns: usize,
}

/// Bodies, supports and contacts.
pub struct Model<const D: usize> {
    pub bodies: Bodies<D>,
    pub supports: Vec<Support>,
    pub contacts: Vec<Contact<D>>,
    reduction: Reduction<D>,
    stiffness: SymmetricMatrix,
    factor: Factor,
    springs: Vec<Spring>,
    free: Vec<FreeMode>,
    active: ActiveSet,
    started: bool,
}

/// What may change with time.
pub struct Circumstances<'a, const D: usize> {
    pub displacement: Displacement<'a, D>,
    /// Forces on the unknowns of the bodies.
    pub load: Vec<f64>,
    /// Where rigid masters are, by contact.
    pub rigid: Vec<Option<RigidGap<D>>>,
}

struct System<'a>(&'a Factor);

impl Compliance for System<'_> {
    fn solve_columns(&self, b: &mut [f64]) -> Result<(), SolveError> {
        self.0.solve_columns(b)
    }

    fn solve_accurately(&self, b: &[f64]) -> Result<Vec<f64>, SolveError> {
        self.0.solve_accurately(b)
    }

    fn size(&self) -> usize {
        self.0.size()
    }
}

impl<const D: usize> Model<D> {
    /// Assembles and factorises the stiffness.
    pub fn new(bodies: Bodies<D>, supports: Vec<Support>, contacts: Vec<Contact<D>>) -> Result<Self, StepError> {
        let reduction = Reduction::new(&bodies, &supports)?;
        let stiffness = assemble(&bodies, &supports);
        let free = if beds(&bodies, &supports).is_empty() { free_modes(&bodies, &reduction) } else { Vec::new() };
        let mut reduced = stiffness.transformed(reduction.unknowns, |i| reduction.row(i));
        let diagonal = reduced.diagonal();
        let mut springs: Vec<Spring> = Vec::new();
        for mode in &free {
            let row = reduction.row(mode.unknown);
            let Some((unknown, _)) = row.iter().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())) else { continue };
            let stiffness = diagonal[*unknown as usize];
            springs.push(Spring { unknown: *unknown, stiffness });
            reduced.add(&[*unknown], &[stiffness], 1.0);
        }
        let mut symbolic = if D == 3 {
            Symbolic::ordered(nested_dissection(&reduced, &positions(&bodies, &reduction)))
        } else {
            Symbolic::default()
        };
        let factor = symbolic.factor(reduced)?;
        Ok(Model {
            bodies,
            supports,
            contacts,
            reduction,
            stiffness,
            factor,
            springs,
            free,
            active: ActiveSet::default(),
            started: false,
        })
    }

    /// Motions that only contact can hold.
    pub fn free_modes(&self) -> &[FreeMode] {
        &self.free
    }

    /// Number of unknowns that are solved for.
    pub fn unknowns(&self) -> usize {
        self.reduction.unknowns
    }

    /// Solves for the displacement at one time. `report` gets the iteration and how many nodes changed, and says
    /// whether to go on.
    pub fn solve(
        &mut self,
        now: &Circumstances<'_, D>,
        report: &mut dyn FnMut(usize, usize) -> bool,
    ) -> Result<State<D>, StepError> {
        let offset = self.reduction.offset(&self.bodies, &self.supports, now.displacement)?;
        let moved = self.stiffness.multiply(&offset);
        let load: Vec<f64> = now.load.iter().zip(&moved).map(|(f, m)| f - m).collect();
        let load = self.reduction.restrict(&load);
        let mut rows = Vec::new();
        let mut ends = Vec::new();
        for (contact, rigid) in self.contacts.iter_mut().zip(&now.rigid) {
            contact.search(&self.reduction, rigid.as_ref())?;
            rows.extend(contact.rows.iter().map(|row| reduced(row, &self.reduction, &offset)));
            ends.push(rows.len());
        }
        if !self.started {
            for contact in &self.contacts {
                contact.check_start()?;
            }
            self.started = true;
        }
        if rows.is_empty() && !self.free.is_empty() {
            return Err(self.free_body(0));
        }
        let mut changes = Vec::new();
        let mut logged = |iteration: usize, changed: usize| {
            changes.push(changed);
            report(iteration, changed)
        };
        let found = match self.solve_enforced(&rows, &ends, &load, &mut logged) {
            Ok(found) => found,
            Err(ActiveSetError::Interrupted) => return Err(StepError::Interrupted),
            Err(ActiveSetError::Free) => return Err(self.free_body(0)),
            Err(error) => {
                let places = match &error {
                    ActiveSetError::Chatter { nodes } => nodes.iter().map(|n| format!("node {n}")).collect(),
                    _ => Vec::new(),
                };
                let contact = self.contacts.first().map(|c| c.name.clone()).unwrap_or_default();
                return Err(StepError::Contact { contact, error, places });
            }
        };
        let u = self.reduction.expand(&found.u, &offset);
        let mut forces = self.stiffness.multiply(&u);
        let energy = 0.5 * forces.iter().zip(&u).map(|(f, u)| f * u).sum::<f64>();
        let mut results = Vec::new();
        let mut first = 0;
        let mut contact_force = vec![0.0; forces.len()];
        for (contact, end) in self.contacts.iter().zip(ends) {
            let mut result = ContactResult::<D> { nodes: Vec::new(), force: Point::<D>::zeros(), area: 0.0 };
            let body = contact.slave.body();
            let vertices: std::collections::HashSet<u32> = (contact.slave.sides.iter())
                .flat_map(|s| body.mesh.side_vertices(*s))
                .filter_map(|v| body.dofs.vertex(v))
                .map(|f| (body.first + D * f as usize) as u32)
                .collect();
            for (k, row) in contact.rows.iter().enumerate() {
                let pressure = found.pressure[first + k];
                for (unknown, c) in &row.terms {
                    contact_force[*unknown as usize] += c * pressure;
                    let i = *unknown as usize % D;
                    if vertices.contains(&(unknown - i as u32)) {
                        result.force[i] += c * pressure;
                    }
                }
                let active = found.active[first + k];
                if active {
                    result.area += row.weight;
                }
                if contact.method != Method::GaussPoint {
                    result.nodes.push(PressureNode {
                        x: contact.nodes.positions[row.node as usize],
                        multiplier: pressure,
                        pressure,
                        gap: found.gap[first + k] / row.weight,
                        active,
                        weight: row.weight,
                        number: row.node,
                    });
                }
            }
            if contact.method == Method::GaussPoint {
                let range = first..end;
                result.nodes =
                    contact.averaged(&found.pressure[range.clone()], &found.gap[range.clone()], &found.active[range]);
            }
            first = end;
            let count = contact.nodes.len();
            let (mut multiplier, mut weight, mut active) = (vec![0.0; count], vec![0.0; count], vec![false; count]);
            for node in &result.nodes {
                let k = node.number as usize;
                (multiplier[k], weight[k], active[k]) = (node.multiplier, node.weight, node.active);
            }
            let pressure = match contact.method {
                Method::Mortar => recovered(&contact.nodes, &contact.points, &multiplier, &weight, &active),
                _ => multiplier,
            };
            result.nodes.iter_mut().for_each(|node| node.pressure = pressure[node.number as usize]);
            results.push(result);
        }
        for ((force, load), contact) in forces.iter_mut().zip(&now.load).zip(&contact_force) {
            *force -= load + contact;
        }
        // What is left are the reactions, and nothing on free unknowns.
        let unbalanced = self.reduction.restrict(&forces);
        let scale = forces.iter().chain(&contact_force).chain(&now.load).fold(f64::MIN_POSITIVE, |m, f| m.max(f.abs()));
        let imbalance = unbalanced.iter().fold(0.0f64, |m, f| m.max(f.abs())) / scale;
        let support_forces = (self.reduction.reactions.iter())
            .map(|list| {
                let mut sum = Point::<D>::zeros();
                for f in list {
                    for i in 0..D {
                        sum[i] += forces[*f as usize * D + i];
                    }
                }
                sum
            })
            .collect();
        Ok(State {
            u,
            contacts: results,
            iterations: found.iterations,
            changes,
            support_forces,
            imbalance,
            energy,
            unknowns: self.reduction.unknowns,
        })
    }

    /// The active set, with outer iterations where the enforcement asks for them.
    fn solve_enforced(
        &mut self,
        rows: &[WeightedGap],
        ends: &[usize],
        load: &[f64],
        report: &mut dyn FnMut(usize, usize) -> bool,
    ) -> Result<ContactState, ActiveSetError> {
        let mut soft = vec![Softness::default(); rows.len()];
        let system = System(&self.factor);
        let range = |k: usize| if k == 0 { 0..ends[0] } else { ends[k - 1]..ends[k] };
        // Multiples of the stiffness of the cells.
        let mut factor = vec![100.0; self.contacts.len()];
        let mut total = 0;
        for outer in 0..MOST_OUTER {
            for (k, contact) in self.contacts.iter().enumerate() {
                if contact.enforcement == Enforcement::Multiplier {
                    continue;
                }
                for (row, stiffness) in range(k).zip(&contact.stiffness) {
                    soft[row].compliance = rows[row].weight / (factor[k] * stiffness);
                }
            }
            let mut found = self.active.solve(&system, rows, &soft, &self.springs, load, report)?;
            total += found.iterations;
            found.iterations = total;
            let mut again = false;
            for (k, contact) in self.contacts.iter().enumerate() {
                let deepest = |rows_of: &mut dyn Iterator<Item = usize>| {
                    rows_of.map(|r| -found.gap[r] / rows[r].weight).fold(0.0, f64::max)
                };
                match contact.enforcement {
                    Enforcement::Multiplier | Enforcement::Penalty { wanted_penetration: None } => {}
                    Enforcement::Penalty { wanted_penetration: Some(wanted) } => {
                        let reached = deepest(&mut range(k));
                        if reached > 0.0 && !(0.98..=1.02).contains(&(reached / wanted)) {
                            factor[k] *= reached / wanted;
                            again = true;
                        }
                    }
                    Enforcement::AugmentedLagrangian => {
                        let moved = found.u.iter().fold(0.0f64, |m, u| m.max(u.abs()));
                        let mut open = range(k).filter(|&r| found.active[r]);
                        let worst = open.by_ref().map(|r| (found.gap[r] / rows[r].weight).abs()).fold(0.0, f64::max);
                        if worst > 1e-11 * moved {
                            range(k).for_each(|r| soft[r].shift = found.pressure[r]);
                            again = true;
                        }
                    }
                }
            }
            if !again || outer + 1 == MOST_OUTER {
                return if again { Err(ActiveSetError::TooMany { iterations: total }) } else { Ok(found) };
            }
        }
        Err(ActiveSetError::TooMany { iterations: total })
    }

    fn free_body(&self, number: usize) -> StepError {
        match self.free.get(number) {
            Some(mode) => StepError::Free { body: mode.body.clone(), motion: mode.motion.clone() },
            None => StepError::Free { body: String::new(), motion: "to move".into() },
        }
    }
}

/// Where the unknowns that remain are.
fn positions<const D: usize>(bodies: &Bodies<D>, reduction: &Reduction<D>) -> Vec<[f64; D]> {
    let mut out = vec![[0.0; D]; reduction.unknowns];
    for body in &bodies.list {
        for (f, x) in body.function_positions().into_iter().enumerate() {
            for i in 0..D {
                for (unknown, _) in reduction.row(body.first + f * D + i) {
                    out[*unknown as usize] = std::array::from_fn(|k| x[k]);
                }
            }
        }
    }
    out
}

impl<const D: usize> Contact<D> {
    /// Pressures and gaps of quadrature points as means over the pressure nodes.
    fn averaged(&self, pressure: &[f64], gap: &[f64], active: &[bool]) -> Vec<PressureNode<D>> {
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

/// The most outer iterations of a penalty that is adjusted, or of an augmented Lagrangian.
const MOST_OUTER: usize = 60;

/// A row in the unknowns that remain.
fn reduced<const D: usize>(row: &WeightedGap, reduction: &Reduction<D>, offset: &[f64]) -> WeightedGap {
    let mut terms: Vec<(u32, f64)> = Vec::with_capacity(row.terms.len());
    let mut gap = row.gap;
    for (unknown, c) in &row.terms {
        gap += c * offset[*unknown as usize];
        terms.extend(reduction.row(*unknown as usize).iter().map(|(k, t)| (*k, c * t)));
    }
    terms.sort_by_key(|t| t.0);
    terms.dedup_by(|next, kept| {
        let same = next.0 == kept.0;
        if same {
            kept.1 += next.1;
        }
        same
    });
    WeightedGap { gap, weight: row.weight, terms, node: row.node }
}

/// The stiffness of all bodies and elastic beds.
fn assemble<const D: usize>(bodies: &Bodies<D>, supports: &[Support]) -> SymmetricMatrix {
    let mut cliques: Vec<Vec<u32>> = Vec::new();
    for body in &bodies.list {
        for cell in 0..body.mesh.cell_count() {
            let unknowns = body
                .dofs
                .cell(cell)
                .iter()
                .flat_map(|(f, _)| (0..D).map(move |i| (body.first + *f as usize * D + i) as u32));
            cliques.push(unknowns.collect());
        }
    }
    let beds = beds(bodies, supports);
    let cells = cliques.len();
    cliques.extend(beds.iter().map(|b| b.0.clone()));
    let mut matrix = SymmetricMatrix::from_cliques(bodies.unknowns(), &cliques);
    for ((unknowns, values), _) in beds.iter().zip(cells..) {
        matrix.add(unknowns, values, 1.0);
    }
    let mut number = 0;
    for body in &bodies.list {
        let mut tables: HashMap<(usize, usize), Table> = HashMap::new();
        for cell in 0..body.mesh.cell_count() {
            let key = (body.mesh.map_number(cell), body.dofs.basis_number(cell));
            tables.entry(key).or_insert_with(|| Table::new(&body.mesh, &body.dofs, cell));
        }
        // Matrices in parallel, sums in order.
        let all: Vec<usize> = (0..body.mesh.cell_count()).collect();
        for chunk in all.chunks(512) {
            let matrices: Vec<Vec<f64>> = chunk
                .par_iter()
                .map(|&cell| {
                    let table = &tables[&(body.mesh.map_number(cell), body.dofs.basis_number(cell))];
                    let basis = body.dofs.basis(cell);
                    let k = stiffness(&body.mesh, cell, table, basis, &body.material, bodies.space);
                    let signs: Vec<f64> =
                        body.dofs.cell(cell).iter().flat_map(|(_, s)| std::iter::repeat_n(*s, D)).collect();
                    let n = signs.len();
                    let mut out = vec![0.0; n * n];
                    for a in 0..n {
                        for b in 0..n {
                            out[a * n + b] = signs[a] * signs[b] * k[(a, b)];
                        }
                    }
                    out
                })
                .collect();
            for values in matrices {
                matrix.add(&cliques[number], &values, 1.0);
                number += 1;
            }
        }
    }
    matrix
}
