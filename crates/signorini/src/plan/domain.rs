//! The domain of a membrane and its cells: a background grid, or a mesh from a file.

use super::pieces::Apart;
use super::placement::PlacementKeys;
use super::planner::Planner;
use crate::expression::{Expression, Scope};
use crate::problem::units::{LENGTH, NONE};
use crate::problem::{self, Domain, List, Mesh, Problem, Space};
use crate::problem::{CaseError, KeyPath, Location, Value};
use signorini_fem::mesh_cells::MOST_ON_TRIANGLES;
use signorini_fem::{Cells, Grid, Mesh as FemMesh, MeshCells, RefinedGrid};
use signorini_geometry::{Aabb, Ellipsoid, ImplicitShape, Jet, Point, Real, Vector, polygon};
use signorini_membrane::domain::{
    BoxDomain, CellStatus, Domain as MembraneDomain, DomainOnCells, ImplicitDomain, MeshDomain, PolygonDomain,
};
use signorini_membrane::kernel::Kernel;
use signorini_membrane::refinement::Refinement;
use std::collections::BTreeSet;
use std::sync::Arc;

/// The box of a grid that the boundary cuts is larger than the domain by this factor, so that no boundary runs along
/// its edge.
pub(super) const MARGIN: f64 = 1.03;
/// How often cells are divided at most where the case does not say.
const MOST_DIVISIONS: usize = 8;
/// ... of degree 1, which is not so accurate that smaller ones would gain much.
const MOST_DIVISIONS_LINEAR: usize = 5;
/// How often those of a mesh from a file may be.
const MOST_MESH_DIVISIONS: i64 = 12;
/// Fraction of the free memory that a solve may use.
const MEMORY_SHARE: f64 = 0.8;

/// Named groups of boundary pieces.
pub struct Pieces {
    pub groups: Vec<(String, Vec<usize>)>,
    /// The pieces of a mesh that falls into several, and the pieces of the boundary of each.
    pub(super) apart: Option<(Apart<2>, Vec<BTreeSet<usize>>)>,
}

impl Pieces {
    fn new(groups: &[(&str, &[usize])]) -> Self {
        Self { groups: groups.iter().map(|(n, p)| (n.to_string(), p.to_vec())).collect(), apart: None }
    }
}

/// Reads domains of one dimension.
pub(crate) trait ReadDomain<const D: usize> {
    /// What solves for membranes of this dimension.
    const KERNEL: Kernel<D>;

    /// A shape, its bounding box and its groups.
    fn shape(&self, key: &Domain) -> Result<(Arc<dyn MembraneDomain<D>>, Aabb<D>, Pieces), CaseError>;

    /// The zone of contact that a case asks for, as a shape; sides that reach the membrane's own reach beyond it.
    fn initial_zone(&self, key: &Domain, grid: &Grid<D>) -> Result<Arc<dyn MembraneDomain<D>>, CaseError> {
        let (shape, bounds, _) = self.shape(key)?;
        let whole = grid.bounds();
        if (0..D).any(|k| bounds.max[k] <= whole.min[k] || bounds.min[k] >= whole.max[k]) {
            return Err(self.planner().problem.error(key, "the initial zone lies beside the membrane"));
        }
        if !shape.is_box() {
            return Ok(shape);
        }
        let mut reaching = bounds;
        for k in 0..D {
            let size = whole.size()[k];
            if bounds.min[k] <= whole.min[k] {
                reaching.min[k] = whole.min[k] - size;
            }
            if bounds.max[k] >= whole.max[k] {
                reaching.max[k] = whole.max[k] + size;
            }
        }
        Ok(Arc::new(BoxDomain(reaching)))
    }

    fn planner(&self) -> &Planner<'_>;

    /// Where cells of about the size of a grid's are divided, by themselves and where the case says.
    fn refinement(&self, key: Option<&RefineEntry>, grid: &Grid<D>) -> Result<Refinement<D>, CaseError>;

    /// The cells of a grid, divided where a function says so.
    fn divided(&self, grid: &Grid<D>, wanted: &Wanted<D>) -> Arc<dyn Cells<D>>;

    /// The cells of a mesh from a file.
    fn mesh_of_file(&self, key: &problem::DividedGmshMesh, film: &problem::Membrane) -> Result<OnCells<D>, CaseError>;

    /// The cells of a mesh from arrays.
    fn mesh_of_arrays(&self, key: &problem::MeshArrays, film: &problem::Membrane) -> Result<OnCells<D>, CaseError>;

    /// The domain on its cells.
    fn domain(&self, film: &problem::Membrane) -> Result<OnCells<D>, CaseError> {
        let planner = self.planner();
        let grid = match &film.mesh {
            Mesh::Gmsh(key) => return self.mesh_of_file(key, film),
            Mesh::Arrays(key) => return self.mesh_of_arrays(key, film),
            Mesh::Grid(grid) => grid,
        };
        let degree = planner.degree(film)?.unwrap_or(2);
        let (shape, bounds, pieces) = self.shape(planner.domain_key(film)?)?;
        let (cells, place) = planner.cells(film, grid, &bounds)?;
        planner.check_size(&cells, degree, &place)?;
        let coarse = Grid::new(bounds, cells, degree);
        let refinement = self.refinement(grid.refine.as_ref(), &coarse)?;
        let cells: Arc<dyn Cells<D>> = match &grid.refine {
            Some(key) if key.negative_where.is_some() => self.divided(&coarse, &refinement.always),
            _ => Arc::new(coarse.clone()),
        };
        let grid = coarse;
        let domain = DomainOnCells::new(shape, &*cells);
        if domain.status.iter().all(|s| *s == CellStatus::Outside) {
            let at = film.domain.as_ref().map_or_else(|| planner.key(film), |d| planner.key(d));
            return Err(planner
                .problem
                .error(&at, "the domain is empty: no point of it was found on the grid")
                .help("check the sign (negative inside) and the bounds min, max, or use more cells"));
        }
        Ok(OnCells { cells, grid, domain, pieces, refinement })
    }
}

/// What a case says of where cells are divided.
type RefineEntry = problem::Refine;

/// Whether a cell is divided, from its box and how often it was divided.
type Wanted<const D: usize> = Arc<dyn Fn(&Aabb<D>, usize) -> bool + Send + Sync>;

/// A domain with its cells.
pub(crate) struct OnCells<const D: usize> {
    pub cells: Arc<dyn Cells<D>>,
    pub grid: Grid<D>,
    pub domain: DomainOnCells<D>,
    pub pieces: Pieces,
    pub refinement: Refinement<D>,
}

impl Planner<'_> {
    /// The degree that a membrane states.
    fn degree(&self, film: &problem::Membrane) -> Result<Option<usize>, CaseError> {
        match &film.degree {
            None => Ok(None),
            Some(d) if (1..=6).contains(d) => Ok(Some(*d as usize)),
            Some(d) => Err(self.problem.error(d, format!("degree {} is not between 1 and 6", d))),
        }
    }

    fn cells<const D: usize>(
        &self,
        film: &problem::Membrane,
        grid: &problem::GridMesh,
        bounds: &Aabb<D>,
    ) -> Result<([usize; D], KeyPath), CaseError> {
        let problem = self.problem;
        match (&grid.cells, &grid.cell_size) {
            (Some(cells), None) => {
                if cells.len() != D {
                    return Err(problem.error(cells, format!("expected {D} numbers of cells, found {}", cells.len())));
                }
                let mut out = [0; D];
                for (o, n) in out.iter_mut().zip(cells) {
                    let count = *n;
                    if count < 1 {
                        return Err(problem.error(n, format!("{count} cells: there must be at least one")));
                    }
                    *o = count as usize;
                }
                Ok((out, self.key(cells)))
            }
            (None, Some(size)) => {
                let h = self.reader.positive(size, LENGTH)?;
                let extent = bounds.size();
                let mut out = [0; D];
                for k in 0..D {
                    out[k] = (extent[k] / h).round().clamp(1.0, 1e15) as usize;
                }
                Ok((out, self.key(size)))
            }
            _ => Err(problem
                .error(&film.mesh, "the grid needs either `cells` or `cell_size`")
                .help("mesh.grid = { cells = [40, 40] }")),
        }
    }

    /// Tells before memory ends.
    fn check_size<const D: usize>(
        &self,
        cells: &[usize; D],
        degree: usize,
        at: &impl Location,
    ) -> Result<(), CaseError> {
        let nodes: f64 = cells.iter().map(|&n| n as f64 * degree as f64 + 1.0).product();
        let bytes = memory_estimate(nodes, degree, D).min(multigrid_estimate(nodes, degree, true));
        self.check_bytes(nodes, bytes, at)
    }

    /// Tells where a factorisation needs more memory than there is.
    pub(super) fn check_unknowns<const D: usize>(
        &self,
        nodes: f64,
        degree: usize,
        at: &impl Location,
    ) -> Result<(), CaseError> {
        self.check_bytes(nodes, memory_estimate(nodes, degree, D), at)
    }

    /// Tells where a solve of so many unknowns needs more bytes than there are.
    fn check_bytes(&self, nodes: f64, bytes: f64, at: &impl Location) -> Result<(), CaseError> {
        let free = free_memory();
        if nodes < 2e9 && bytes < MEMORY_SHARE * free {
            return Ok(());
        }
        let gib = |b: f64| b / f64::from(1 << 30);
        Err(self
            .problem
            .error(
                at,
                format!(
                    "{nodes:.1e} unknowns would need about {:.1} GiB, and {:.1} GiB are free",
                    gib(bytes),
                    gib(free)
                ),
            )
            .help("use fewer cells, or a lower degree"))
    }

    fn center(&self, center: &Option<List<Value>>) -> Result<Point<2>, CaseError> {
        match center {
            None => Ok(Point::zeros()),
            Some(v) => self.reader.numbers::<2>(v, LENGTH).map(Point::<2>::from),
        }
    }

    fn box_of(&self, min: &List<Value>, max: &List<Value>) -> Result<Aabb<2>, CaseError> {
        let b = Aabb::new(
            Point::<2>::from(self.reader.numbers::<2>(min, LENGTH)?),
            Point::<2>::from(self.reader.numbers::<2>(max, LENGTH)?),
        );
        if (0..2).all(|k| b.max[k] > b.min[k]) {
            return Ok(b);
        }
        Err(self.problem.error(max, "the domain is empty: `max` must exceed `min` in both directions"))
    }

    fn domain_key<'f>(&self, film: &'f problem::Membrane) -> Result<&'f Domain, CaseError> {
        film.domain.as_ref().ok_or_else(|| {
            self.problem.error(film, "missing key `domain`").help("add for example  domain.disc = { radius = 1.0 }")
        })
    }
}

/// Bytes that a solve with a sparse factorisation takes, measured on this program and rounded up.
pub fn memory_estimate(unknowns: f64, degree: usize, dimension: usize) -> f64 {
    if dimension == 1 {
        return unknowns * 1e3;
    }
    let p = degree as f64;
    unknowns * (600.0 + 120.0 * p * p) + unknowns * unknowns.max(1.0).log2() * 60.0
}

/// Bytes that a solve by multigrid takes with all that is written, measured on this program and rounded up: for each
/// unknown, for each cell, and along the cuts, where the unknowns are as many as the root of all; where the tension is not
/// even the equations too.
pub fn multigrid_estimate(unknowns: f64, degree: usize, is_even: bool) -> f64 {
    let p = degree as f64;
    let stored = if is_even { 0.0 } else { 11.0 * (p + 2.0) * (p + 2.0) };
    unknowns * (450.0 + 300.0 / (p * p) + stored) + unknowns.sqrt() * 4e4 * p * p
}

/// The same on a mesh whose cells were divided, where all equations are stored, and at higher degree those around each vertex.
pub fn mesh_multigrid_estimate(unknowns: f64, degree: usize) -> f64 {
    let around = 2.0 * degree as f64 + 1.0;
    unknowns * (1300.0 + 22.0 * around * around)
}

/// Memory that a solve may take at most.
pub fn memory_at_hand() -> f64 {
    MEMORY_SHARE * free_memory()
}

/// Refuses solids whose equations need more memory than there is; `what` needs it.
pub fn check_memory(problem: &Problem, what: &str, needed: f64) -> Result<(), CaseError> {
    let gib = |bytes: f64| bytes / f64::from(1u32 << 30);
    let free = memory_at_hand();
    if needed <= free {
        return Ok(());
    }
    let message = format!("{what} need about {:.1} GiB, and {:.1} GiB are free for them", gib(needed), gib(free));
    Err(problem
        .error(&problem.space, message)
        .help("fewer cells, a lower degree, symmetry, or cells graded towards the contact"))
}

/// Memory that is free, as the system tells; 8 GiB where it does not.
fn free_memory() -> f64 {
    let text = std::fs::read_to_string("/proc/meminfo").unwrap_or_default();
    let line = text.lines().find_map(|l| l.strip_prefix("MemAvailable:"));
    let kib = line.and_then(|l| l.trim().trim_end_matches("kB").trim().parse::<f64>().ok());
    kib.map_or(8.0 * f64::from(1 << 30), |k| k * 1024.0)
}

/// A shape by an expression that is negative inside.
struct ExpressionShape(Expression);

impl ImplicitShape<2> for ExpressionShape {
    fn value(&self, x: &Point<2>) -> f64 {
        self.0.evaluate(&Scope { position: [x[0], x[1], 0.0], time: f64::NAN })
    }
    fn gradient(&self, x: &Point<2>) -> Vector<2> {
        let position = [Jet::<2>::variable(x[0], 0), Jet::variable(x[1], 1), Jet::constant(0.0)];
        self.0.evaluate(&Scope { position, time: Jet::constant(f64::NAN) }).gradient
    }
}

impl ReadDomain<1> for Planner<'_> {
    const KERNEL: Kernel<1> = Kernel::LINE;

    fn planner(&self) -> &Planner<'_> {
        self
    }

    fn mesh_of_file(&self, key: &problem::DividedGmshMesh, _: &problem::Membrane) -> Result<OnCells<1>, CaseError> {
        Err(self.in_the_plane(&key.file, "a mesh from a file"))
    }

    fn mesh_of_arrays(&self, key: &problem::MeshArrays, _: &problem::Membrane) -> Result<OnCells<1>, CaseError> {
        Err(self.in_the_plane(key, "a mesh from arrays"))
    }

    fn refinement(&self, key: Option<&RefineEntry>, _: &Grid<1>) -> Result<Refinement<1>, CaseError> {
        match key {
            None => Ok(Refinement::default()),
            Some(refine) => Err(self
                .problem
                .error(refine, "cells are divided in the plane only")
                .help("leave `refine` out: in one dimension fronts are points, and more cells cost little")),
        }
    }

    fn divided(&self, grid: &Grid<1>, _: &Wanted<1>) -> Arc<dyn Cells<1>> {
        Arc::new(grid.clone())
    }

    fn shape(&self, key: &Domain) -> Result<(Arc<dyn MembraneDomain<1>>, Aabb<1>, Pieces), CaseError> {
        let Domain::Interval(interval) = key else {
            return Err(self
                .problem
                .error(key, "in one dimension this is an interval")
                .help("interval = { from = -1.0, to = 1.0 }, or space = \"plane\""));
        };
        let (from, to) = (self.reader.number(&interval.from, LENGTH)?, self.reader.number(&interval.to, LENGTH)?);
        if to <= from {
            return Err(self.problem.error(&interval.to, format!("the domain is empty: {to} does not exceed {from}")));
        }
        let axisymmetric = self.space == Space::Axisymmetric;
        if axisymmetric && from < 0.0 {
            return Err(self.problem.error(&interval.from, format!("a radius of {from} is negative")));
        }
        let pieces = if axisymmetric && from == 0.0 {
            // The axis is not a boundary.
            Pieces::new(&[("boundary", &[1]), ("right", &[1])])
        } else {
            Pieces::new(&[("boundary", &[0, 1]), ("left", &[0]), ("right", &[1])])
        };
        let bounds = Aabb::new(Point::<1>::new(from), Point::<1>::new(to));
        Ok((Arc::new(BoxDomain(bounds)), bounds, pieces))
    }
}

impl ReadDomain<2> for Planner<'_> {
    const KERNEL: Kernel<2> = Kernel::PLANE;

    fn planner(&self) -> &Planner<'_> {
        self
    }

    fn refinement(&self, key: Option<&RefineEntry>, grid: &Grid<2>) -> Result<Refinement<2>, CaseError> {
        let most = if grid.degree() == 1 { MOST_DIVISIONS_LINEAR } else { MOST_DIVISIONS };
        let mut refinement = Refinement { most, ..Refinement::default() };
        let Some(refine) = key else { return Ok(refinement) };
        let times = |key: &Option<i64>, otherwise: usize| match key {
            None => Ok(otherwise),
            Some(n) if (0..=8).contains(n) => Ok(*n as usize),
            Some(n) => Err(self.problem.error(n, format!("cells are divided 0 to 8 times, not {}", n))),
        };
        refinement.fronts = times(&refine.fronts, 0)?;
        refinement.most = times(&refine.most, most.max(refinement.fronts))?;
        if refinement.fronts > refinement.most {
            let at = refine.most.as_ref().map_or_else(|| self.key(refine), |m| self.key(m));
            return Err(self.problem.error(
                &at,
                format!(
                    "at fronts cells are divided {} times, which is more than {}",
                    refinement.fronts, refinement.most
                ),
            ));
        }
        let levels = times(&refine.levels, 1)?;
        if let Some(value) = &refine.negative_where {
            let expression = self
                .reader
                .expression(value, NONE, &["x", "y"])
                .or_else(|_| self.reader.expression(value, LENGTH, &["x", "y"]))?;
            let at = move |x: Point<2>| expression.evaluate(&Scope { position: [x[0], x[1], 0.0], time: f64::NAN });
            let center = grid.bounds().center();
            if at(center).is_nan() {
                return Err(self.problem.error(
                    value,
                    format!("`negative_where` is not a number at ({:.6}, {:.6})", center[0], center[1]),
                ));
            }
            let sampled = move |b: &Aabb<2>| {
                (0..9).any(|k| at(b.at(&Point::<2>::new(f64::from(k % 3) / 2.0, f64::from(k / 3) / 2.0))) < 0.0)
            };
            refinement.always = Arc::new(move |b, level| level < levels && sampled(b));
        } else if let Some(levels) = &refine.levels {
            return Err(self
                .problem
                .error(levels, "`levels` says how often, but nothing says where")
                .help("add negative_where = \"hypot(x, y) - 0.3\", or use `fronts`"));
        }
        Ok(refinement)
    }

    fn divided(&self, grid: &Grid<2>, wanted: &Wanted<2>) -> Arc<dyn Cells<2>> {
        Arc::new(RefinedGrid::new(grid, |b, level| wanted(b, level)))
    }

    fn mesh_of_file(&self, key: &problem::DividedGmshMesh, film: &problem::Membrane) -> Result<OnCells<2>, CaseError> {
        let placement = PlacementKeys { scale: &key.scale, turn: &key.turn, moved: &key.moved };
        let mesh = self.gmsh::<2>(&key.file, key.group.as_deref(), &placement)?;
        self.on_mesh(mesh, &self.key(&key.file), key.divisions.as_ref(), key.refine.as_ref(), film)
    }

    fn mesh_of_arrays(&self, key: &problem::MeshArrays, film: &problem::Membrane) -> Result<OnCells<2>, CaseError> {
        let mesh = Planner::mesh_of_arrays::<2>(self, key)?;
        self.on_mesh(mesh, &self.key(key), None, None, film)
    }

    fn shape(&self, key: &Domain) -> Result<(Arc<dyn MembraneDomain<2>>, Aabb<2>, Pieces), CaseError> {
        let problem = self.problem;
        let whole = || Pieces::new(&[("boundary", &[0])]);
        let ellipse = |center: Point<2>, semi_axes: [f64; 2]| {
            let half = Vector::<2>::from(semi_axes);
            let bounds = Aabb::new(center - half, center + half).scaled(MARGIN);
            (Arc::new(ImplicitDomain(Ellipsoid { center, semi_axes })) as Arc<dyn MembraneDomain<2>>, bounds, whole())
        };
        Ok(match key {
            Domain::Disc(disc) => {
                let radius = self.reader.positive(&disc.radius, LENGTH)?;
                ellipse(self.center(&disc.center)?, [radius; 2])
            }
            Domain::Ellipse(e) => {
                let semi_axes = self.reader.numbers::<2>(&e.semi_axes, LENGTH)?;
                if semi_axes.iter().any(|a| *a <= 0.0) {
                    return Err(problem.error(&e.semi_axes, "both semi-axes must be positive"));
                }
                ellipse(self.center(&e.center)?, semi_axes)
            }
            Domain::Rectangle(r) => {
                let bounds = self.box_of(&r.min, &r.max)?;
                let pieces = Pieces::new(&[
                    ("boundary", &[0, 1, 2, 3]),
                    ("left", &[0]),
                    ("right", &[1]),
                    ("bottom", &[2]),
                    ("top", &[3]),
                ]);
                (Arc::new(BoxDomain(bounds)), bounds, pieces)
            }
            Domain::Polygon(p) => self.polygon(&p.points)?,
            Domain::Implicit(i) => {
                let expression = self
                    .reader
                    .expression(&i.negative_inside, NONE, &["x", "y"])
                    .or_else(|_| self.reader.expression(&i.negative_inside, LENGTH, &["x", "y"]))?;
                let bounds = self.box_of(&i.min, &i.max)?;
                let shape = ExpressionShape(expression);
                for k in 0..=20 {
                    for j in 0..=20 {
                        let x = bounds.at(&Point::<2>::new(f64::from(j) / 20.0, f64::from(k) / 20.0));
                        let v = shape.value(&x);
                        if v.is_nan() {
                            return Err(problem.error(
                                &i.negative_inside,
                                format!("`negative_inside` is not a number at ({:.6}, {:.6})", x[0], x[1]),
                            ));
                        }
                    }
                }
                (Arc::new(ImplicitDomain(shape)), bounds, whole())
            }
            Domain::Interval(_) => {
                return Err(problem
                    .error(key, "an interval belongs to a string")
                    .help("space = \"line\" or \"axisymmetric\", or rectangle = { min, max }"));
            }
        })
    }
}

impl Planner<'_> {
    fn polygon(&self, points: &List<List<Value>>) -> Result<(Arc<dyn MembraneDomain<2>>, Aabb<2>, Pieces), CaseError> {
        let mut corners = Vec::new();
        for p in points {
            corners.push(Point::<2>::from(self.reader.numbers::<2>(p, LENGTH)?));
        }
        if corners.len() < 3 {
            return Err(self
                .problem
                .error(points, format!("{} points make no polygon: there must be at least 3", corners.len())));
        }
        let n = corners.len();
        if let Some(i) = (0..n).find(|&i| (corners[i] - corners[(i + 1) % n]).norm() == 0.0) {
            return Err(self
                .problem
                .error(&points[i], "two corners in a row are the same point")
                .help("leave one out; the last corner is joined to the first by itself"));
        }
        if let Some((i, j)) = polygon::self_crossing(&corners) {
            return Err(self
                .problem
                .error(points, format!("the sides {} and {} cross each other", i + 1, j + 1))
                .help("list the corners in the order in which one walks round the domain"));
        }
        if polygon::signed_area(&corners) == 0.0 {
            return Err(self.problem.error(points, "the domain is empty: the polygon has no area"));
        }
        let clockwise = polygon::signed_area(&corners) < 0.0;
        let mut groups = vec![("boundary".to_string(), (0..n).collect::<Vec<_>>())];
        // Sides are numbered as listed; a clockwise list is stored in reverse.
        groups
            .extend((0..n).map(|i| (format!("side_{}", i + 1), vec![if clockwise { (2 * n - 2 - i) % n } else { i }])));
        let bounds =
            corners.iter().fold(Aabb::new(corners[0], corners[0]), |b, p| Aabb::new(b.min.inf(p), b.max.sup(p)));
        Ok((Arc::new(PolygonDomain::new(corners)), bounds.scaled(MARGIN), Pieces { groups, apart: None }))
    }
}

impl Planner<'_> {
    /// A membrane on the cells of a mesh, each divided so often, and where the case says.
    fn on_mesh(
        &self,
        mesh: FemMesh<2>,
        place: &KeyPath,
        divided: Option<&i64>,
        refine: Option<&RefineEntry>,
        film: &problem::Membrane,
    ) -> Result<OnCells<2>, CaseError> {
        let problem = self.problem;
        if let Some(domain) = &film.domain {
            return Err(problem.error(domain, "the mesh is the domain").help("leave `domain` out, or take mesh.grid"));
        }
        let order = (0..mesh.cell_count()).map(|c| mesh.map(c).order()).max().unwrap_or(1);
        let degree = self.degree(film)?.unwrap_or(order);
        let triangles = (0..mesh.cell_count()).any(|c| !mesh.shape(c).is_tensor());
        if triangles && degree > MOST_ON_TRIANGLES {
            let at = film.degree.as_ref().map_or_else(|| place.clone(), |d| self.key(d));
            return Err(problem
                .error(&at, format!("degree {degree} on a mesh with triangles"))
                .help("triangles have degree 1 or 2, quadrilaterals 1 to 6"));
        }
        let divisions = divided.copied().unwrap_or(0);
        let at = divided.map_or_else(|| place.clone(), |d| self.key(d));
        if !(0..=MOST_MESH_DIVISIONS).contains(&divisions) {
            let message = format!("cells are divided 0 to {MOST_MESH_DIVISIONS} times, not {divisions}");
            return Err(problem.error(&at, message));
        }
        // Triangles are twice as many as their vertices.
        let share = |cell: usize| if mesh.shape(cell).is_tensor() { 1.0 } else { 0.5 };
        let vertices = (0..mesh.cell_count()).map(share).sum::<f64>() * 4f64.powi(divisions as i32);
        let unknowns = vertices * (degree * degree) as f64;
        let by_multigrid = if divisions > 0 { mesh_multigrid_estimate(unknowns, degree) } else { f64::INFINITY };
        self.check_bytes(unknowns, memory_estimate(unknowns, degree, 2).min(by_multigrid), &at)?;
        let apart = Apart::new(&mesh);
        let undivided = Arc::new(MeshCells::new(mesh, degree));
        let apart = apart.map(|apart| {
            let mut rims = vec![BTreeSet::new(); apart.count()];
            for side in undivided.boundary_sides() {
                rims[apart.of_cell[side.cell] as usize].insert(side.piece);
            }
            (apart, rims)
        });
        let cells = (0..divisions).fold(undivided, |cells, _| Arc::new(cells.refined()));
        let grid = cells.grid();
        let refinement = match refine {
            Some(refine) if degree > MOST_ON_TRIANGLES => {
                return Err(problem
                    .error(refine, format!("degree {degree} on a mesh that is divided here and there"))
                    .help(
                        "quadrilaterals and triangles lie side by side there: degree = 1 or 2, or leave `refine` out",
                    ));
            }
            None if degree > MOST_ON_TRIANGLES => Refinement::default(),
            refine => self.refinement(refine, &grid)?,
        };
        let pieces = Pieces { groups: cells.groups().to_vec(), apart };
        let domain: Arc<dyn MembraneDomain<2>> = Arc::new(MeshDomain(cells.clone()));
        let on_request = refine.is_some_and(|refine| refine.negative_where.is_some());
        let divided = on_request.then(|| cells.graded(&[], 0, &*refinement.always)).flatten();
        let cells: Arc<dyn Cells<2>> = match divided {
            Some(divided) => Arc::new(divided),
            None => cells,
        };
        Ok(OnCells { grid, domain: DomainOnCells::new(domain, &*cells), cells, pieces, refinement })
    }

    /// What belongs to a membrane in the plane.
    fn in_the_plane(&self, at: &impl Location, what: &str) -> CaseError {
        self.problem
            .error(at, format!("{what} belongs to a membrane in the plane"))
            .help("space = \"plane\", or mesh.grid = { cells = [100] }")
    }
}
