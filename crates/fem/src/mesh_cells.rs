//! Triangles and quadrilaterals of a mesh, straight or curved, as the cells of a membrane.
//!
//! A cell is cut in a unit square: a quadrilateral's own, and for a triangle the one that collapses onto it with one side
//! at the vertex that is farthest from what cuts it.

use crate::adjacency::Adjacency;
use crate::cell_map::CellMap;
use crate::cells::{
    BoundarySide, CellByCell, Cells, Divided, Extension, Neighbours, SidePoint, own_extension, quadrilaterals,
    whole_order,
};
use crate::cut::{CellPartition, CellRule, QuadraturePoint, cut_cell};
use crate::dofs::DofMap;
use crate::grid::Grid;
use crate::hierarchic::{HierarchicBasis, MAX_DEGREE, Mode, Values};
use crate::lagrange::Tabulation;
use crate::lists::Lists;
use crate::mesh::{Mesh, Side};
use crate::mesh_refinement::{PARTS, parts};
use crate::overlap::BULGE;
use crate::reference::{CellShape, Local};
use crate::rules::{Rule, rule};
use crate::small;
use nalgebra::{DMatrix, DVector};
use signorini_geometry::outline::outlines_between;
use signorini_geometry::{Aabb, ImplicitShape, Matrix, Point, Vector};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, OnceLock};

/// How far beyond its cell, in reference coordinates, a point still belongs to it.
const ON_THE_EDGE: f64 = 1e-9;

/// The cells of a plane mesh with functions of one degree.
pub struct MeshCells {
    mesh: Mesh<2>,
    dofs: DofMap,
    /// The vertex of each function that belongs to one.
    nodes: Vec<Point<2>>,
    degree: usize,
    /// For each cell whose map is not linear, its place in `bent`.
    bent_at: Vec<u32>,
    bent: Vec<Bent>,
    /// Rule of each map, tabulated.
    rules: Vec<Vec<RulePoint>>,
    buckets: Grid<2>,
    /// For each bucket, the cells and the boundary sides that reach into it, once these are asked for.
    cells_in: OnceLock<Lists<u32>>,
    sides_in: OnceLock<Lists<u32>>,
    adjacency: Adjacency,
    /// Sides on the boundary, cell by cell, and points along each.
    sides: Vec<BoundarySide>,
    drawn: Vec<[Point<2>; DRAWN + 1]>,
    groups: Vec<(String, Vec<usize>)>,
    pieces: usize,
    parent: Option<Parent>,
    /// The cells before some were divided, and how often each was; none where none was.
    whole: Option<Arc<MeshCells>>,
    levels: Vec<u8>,
}

/// The cells of which each was divided into four.
pub struct Parent {
    pub cells: Arc<MeshCells>,
    /// For each vertex function those of the parent at four vertices: its vertex is the mean of these, in the reference
    /// cell, and a function of degree 1 is there the mean of its values.
    pub nodes: Vec<[u32; 4]>,
}

/// The functions of three or four vertices.
pub struct CornerFunctions {
    list: [u32; 4],
    count: usize,
}

impl std::ops::Deref for CornerFunctions {
    type Target = [u32];
    fn deref(&self) -> &[u32] {
        &self.list[..self.count]
    }
}

/// What is to know about a cell whose map is not linear.
struct Bent {
    bounds: Aabb<2>,
    size: f64,
    volume: f64,
    /// Centre and inverse Jacobian there.
    centre: Point<2>,
    inverse: Matrix<2>,
    /// Whether the Jacobian is nowhere much smaller than on average.
    regular: bool,
}

const STRAIGHT: u32 = u32::MAX;

/// The highest degree of functions on triangles.
pub const MOST_ON_TRIANGLES: usize = 2;

/// Cells are near a place that is less than so many of their extents away.
const NEAR: f64 = 2.0;

/// Parts that a side of the boundary is drawn in.
const DRAWN: usize = 4;

impl MeshCells {
    /// Functions of the given degree on a mesh that [`Mesh::check`] accepts.
    ///
    /// # Panics
    /// If the degree is above 2 on a mesh with triangles.
    pub fn new(mesh: Mesh<2>, degree: usize) -> Self {
        let adjacency = Adjacency::new(&mesh);
        Self::with(mesh, adjacency, degree)
    }

    fn with(mesh: Mesh<2>, adjacency: Adjacency, degree: usize) -> Self {
        let count = mesh.cell_count();
        let dofs = DofMap::new(&mesh, degree);
        let mut vertices = vec![Point::<2>::zeros(); dofs.count()];
        for node in (0..count).flat_map(|cell| mesh.vertices(cell)) {
            if let Some(function) = dofs.vertex(node) {
                vertices[function as usize] = mesh.nodes()[node as usize];
            }
        }
        let nodes = vertices;
        let mut rules: BTreeMap<usize, Vec<RulePoint>> = BTreeMap::new();
        let mut total = 0.0;
        let (mut bent_at, mut bent) = (Vec::with_capacity(count), Vec::new());
        let mut at = Values::default();
        let mut vertices: Vec<Point<2>> = Vec::new();
        for cell in 0..count {
            let map = mesh.map(cell);
            vertices.clear();
            vertices.extend(mesh.vertices(cell).map(|n| mesh.nodes()[n as usize]));
            if map.shape() == CellShape::Triangle && map.order() == 1 {
                total += 0.5 * small::determinant(&edges(&vertices));
                bent_at.push(STRAIGHT);
                continue;
            }
            let table = rules.entry(mesh.map_number(cell)).or_insert_with(|| tabulated(map, degree));
            let volume: f64 =
                table.iter().map(|p| p.weight * small::determinant(&mesh.jacobian(cell, &p.map).1).abs()).sum();
            // The height of a triangle; the width of a quadrilateral, less where a corner is nearly straight and slopes
            // are steep.
            let least = (map.nodes().iter())
                .map(|x| {
                    map.tabulate(x, &mut at);
                    small::determinant(&mesh.jacobian(cell, &at).1)
                })
                .fold(f64::INFINITY, f64::min);
            let size = least / longest(&vertices) * if vertices.len() == 3 { 1.0 } else { 4.0 };
            total += volume;
            map.tabulate(&map.shape().centre(), &mut at);
            let (centre, jacobian) = mesh.jacobian(cell, &at);
            if map.shape() == CellShape::Triangle
                && table.iter().all(|p| (mesh.jacobian(cell, &p.map).1 - jacobian).norm() < 1e-13 * jacobian.norm())
            {
                bent_at.push(STRAIGHT);
                continue;
            }
            let mut bounds = box_round(mesh.cell_nodes(cell).iter().map(|&n| mesh.nodes()[n as usize]));
            if map.order() > 1 {
                bounds = bounds.scaled(BULGE);
            }
            let regular = least > 0.2 * volume / if vertices.len() == 3 { 0.5 } else { 4.0 };
            bent_at.push(bent.len() as u32);
            bent.push(Bent { bounds, size, volume, centre, inverse: small::inverse(&jacobian), regular });
        }
        for cell in 0..count {
            rules.entry(mesh.map_number(cell)).or_insert_with(|| tabulated(mesh.map(cell), degree));
        }
        let maps = rules.keys().max().map_or(0, |m| m + 1);
        let rules = (0..maps).map(|m| rules.remove(&m).unwrap_or_default()).collect();
        let box_of = |cell: usize| bounds_of(&mesh, &bent_at, &bent, cell);
        let bounds = (1..count).map(box_of).fold(box_of(0), |a, b| Aabb::new(a.min.inf(&b.min), a.max.sup(&b.max)));
        // About one cell in each bucket.
        let spacing = (total / count as f64).sqrt();
        let number = |k: usize| ((bounds.size()[k] / spacing).ceil() as usize).clamp(1, 4096);
        let buckets = Grid::new(bounds, [number(0), number(1)], 1);
        let (groups, sides, pieces) = boundary(&mesh, &adjacency);
        let drawn = |side: &BoundarySide| {
            let of = Side { cell: side.cell as u32, side: side.side as u8 };
            std::array::from_fn(|i| mesh.on_side(of, &[2.0 * i as f64 / DRAWN as f64 - 1.0, 0.0, 0.0]).0)
        };
        let drawn = sides.iter().map(drawn).collect();
        Self {
            mesh,
            dofs,
            nodes,
            degree,
            bent_at,
            bent,
            rules,
            buckets,
            cells_in: OnceLock::new(),
            sides_in: OnceLock::new(),
            adjacency,
            sides,
            drawn,
            groups,
            pieces,
            parent: None,
            whole: None,
            levels: Vec::new(),
        }
    }

    /// The same functions on the mesh with every cell divided into four.
    pub fn refined(self: &Arc<Self>) -> Self {
        let mesh = self.mesh.refined(&self.adjacency);
        let mut fine = Self::with(mesh, self.adjacency.refined(&self.mesh), self.degree);
        let mut nodes = vec![[0; 4]; fine.nodes.len()];
        for cell in 0..fine.count() {
            let coarse = cell / PARTS;
            let corners = self.corner_functions(coarse);
            let part = parts(self.mesh.shape(coarse))[cell % PARTS];
            for (function, corner) in fine.corner_functions(cell).iter().zip(part) {
                nodes[*function as usize] = corner.map(|v| corners[usize::from(v)]);
            }
        }
        fine.parent = Some(Parent { cells: self.clone(), nodes });
        fine
    }

    /// The same functions on the mesh before any such division, with cells divided until those near each of the places are no
    /// larger than the size wanted there, at most so often, and as long as `also` says so of a cell's box and how often it was
    /// divided. None of a degree that triangles do not have, which lie beside divided cells.
    pub fn graded(
        self: &Arc<Self>,
        places: &[(Point<2>, f64)],
        most: usize,
        also: &dyn Fn(&Aabb<2>, usize) -> bool,
    ) -> Option<Self> {
        if self.degree > MOST_ON_TRIANGLES {
            return None;
        }
        if let Some(whole) = &self.whole {
            return whole.graded(places, most, also);
        }
        let about = |b: &Aabb<2>, extent: f64| {
            let reach = Point::<2>::repeat(NEAR * extent);
            Aabb::new(b.min - reach, b.max + reach)
        };
        let in_buckets = Lists::new(self.buckets.cell_count(), |visit| {
            places.iter().zip(0u32..).for_each(|((x, _), k)| visit(self.buckets.cell_containing(x), k));
        });
        let near: Vec<Vec<u32>> = (0..self.count())
            .map(|cell| {
                let reach = about(&self.bounds_of(cell), self.extent(cell));
                let mut near = Vec::new();
                for_each_bucket(&self.buckets, &reach, |bucket| near.extend_from_slice(in_buckets.of(bucket)));
                near.retain(|&k| reach.contains(&places[k as usize].0));
                near
            })
            .collect();
        let mut wanted = |mesh: &Mesh<2>, cell: usize, of: usize, level: usize| {
            let b = box_round(mesh.cell_nodes(cell).iter().map(|&n| mesh.nodes()[n as usize]));
            let extent = self.extent(of) / f64::from(1u32 << level);
            let reach = about(&b, extent);
            let mut near = near[of].iter().map(|&k| &places[k as usize]);
            (level < most && near.any(|(x, size)| extent > *size && reach.contains(x))) || also(&b, level)
        };
        let (mesh, levels) = self.mesh.graded(&mut wanted);
        Some(Self { whole: Some(self.clone()), levels, ..Self::new(mesh, self.degree) })
    }

    /// The cells of which each was divided into four of these.
    pub fn parent(&self) -> Option<&Parent> {
        self.parent.as_ref()
    }

    /// The functions of the vertices of a cell, in their order.
    pub fn corner_functions(&self, cell: usize) -> CornerFunctions {
        let mut list = [0; 4];
        let mut count = 0;
        for (at, node) in list.iter_mut().zip(self.mesh.vertices(cell)) {
            *at = self.dofs.vertex(node).unwrap_or(0);
            count += 1;
        }
        CornerFunctions { list, count }
    }

    /// Calls `visit` with every function of a cell and the corners of the cell at which it does not end: its own corner, the
    /// two of its edge, all of them where it lives within.
    pub fn for_each_function_at_corners(&self, cell: usize, mut visit: impl FnMut(u32, &[usize])) {
        let shape = self.mesh.shape(cell);
        for (&function, mode) in self.dofs.functions(cell).iter().zip(self.dofs.basis(cell).modes()) {
            match *mode {
                Mode::Vertex(v) => visit(function, &[usize::from(v)]),
                Mode::Edge(e, _) => visit(function, &shape.edges()[usize::from(e)]),
                Mode::Side(..) | Mode::Interior => visit(function, &[0, 1, 2, 3][..shape.vertices().len()]),
            }
        }
    }

    /// For each function the one of degree 1 of the same vertex, in the numbers of [`MeshCells::new`] with that degree on the
    /// same mesh; none for functions of no vertex.
    pub fn functions_of_degree_one(&self) -> Vec<Option<u32>> {
        let mut out = vec![None; self.dofs.count()];
        let mut count = 0;
        for cell in 0..self.mesh.cell_count() {
            for &function in self.corner_functions(cell).iter() {
                out[function as usize].get_or_insert_with(|| {
                    count += 1;
                    count - 1
                });
            }
        }
        out
    }

    /// Functions of degree 1 on the same mesh, and on those of which its cells were divided.
    pub fn of_degree_one(&self) -> Self {
        match &self.parent {
            Some(parent) => Arc::new(parent.cells.of_degree_one()).refined(),
            None => Self::new(self.mesh.clone(), 1),
        }
    }

    /// The cell across a side of a cell.
    pub fn across(&self, cell: usize, side: usize) -> Option<usize> {
        self.adjacency.across(Side { cell: cell as u32, side: side as u8 })
    }

    /// Whether a cell is a triangle with straight sides.
    pub fn is_straight(&self, cell: usize) -> bool {
        self.bent(cell).is_none()
    }

    /// The cells across the sides of a cell.
    pub fn beside(&self, cell: usize) -> impl Iterator<Item = usize> + '_ {
        self.adjacency.of(cell)
    }

    /// The smallest box round all cells.
    pub fn bounds(&self) -> &Aabb<2> {
        self.buckets.bounds()
    }

    /// The boundary's groups by name, each with its pieces.
    pub fn groups(&self) -> &[(String, Vec<usize>)] {
        &self.groups
    }

    /// Number of pieces of the boundary.
    pub fn pieces(&self) -> usize {
        self.pieces
    }

    /// A uniform grid over the mesh, with cells of the median size.
    pub fn grid(&self) -> Grid<2> {
        let mut sizes: Vec<f64> = (0..self.count()).map(|cell| self.extent(cell)).collect();
        let middle = sizes.len() / 2;
        let h = *sizes.select_nth_unstable_by(middle, f64::total_cmp).1;
        let number = |k: usize| ((self.bounds().size()[k] / h).round() as usize).clamp(1, 1 << 14);
        Grid::new(*self.bounds(), [number(0), number(1)], self.degree)
    }

    /// The side of a square as large as a cell, or as two triangles.
    fn extent(&self, cell: usize) -> f64 {
        (self.volume(cell) * if self.mesh.shape(cell) == CellShape::Triangle { 2.0 } else { 1.0 }).sqrt()
    }

    /// The point of the boundary that is closest to `x`, to a fraction of a cell, if there is one within `reach`.
    pub fn closest_on_boundary(&self, x: &Point<2>, reach: f64) -> Option<Point<2>> {
        let sides_in = self
            .sides_in
            .get_or_init(|| self.lists(|visit| self.sides.iter().zip(0..).for_each(|(side, k)| visit(side.cell, k))));
        let mut best: Option<(f64, Point<2>)> = None;
        let reach_vector = Point::<2>::repeat(reach);
        for_each_bucket(&self.buckets, &Aabb::new(x - reach_vector, x + reach_vector), |bucket| {
            for &k in sides_in.of(bucket) {
                let side = &self.sides[k as usize];
                for (i, pair) in self.drawn[k as usize].windows(2).enumerate() {
                    let (a, along) = (pair[0], pair[1] - pair[0]);
                    let t = ((x - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
                    // A curve is no farther from its chord than that is long.
                    let nearest = (x - a - t * along).norm() - along.norm();
                    if nearest > best.map_or(reach, |b| b.0) {
                        continue;
                    }
                    let y = self.on_side(side, (i as f64 + t) / DRAWN as f64).x;
                    let distance = (x - y).norm();
                    if distance <= reach && best.is_none_or(|(d, _)| distance < d) {
                        best = Some((distance, y));
                    }
                }
            }
        });
        best.map(|(_, y)| y)
    }

    /// Functions tabulated in the reference cell, with their slopes in space by the inverse Jacobian.
    fn slopes(&self, cell: usize, values: &Values, inverse: &Matrix<2>, out: &mut Tabulation<2>) {
        out.value.clear();
        out.gradient.clear();
        for ((value, g), (_, sign)) in values.value.iter().zip(&values.gradient).zip(self.dofs.cell(cell)) {
            out.value.push(sign * value);
            out.gradient.push(Vector::from_fn(|k, _| sign * (g[0] * inverse[(0, k)] + g[1] * inverse[(1, k)])));
        }
    }

    /// For each bucket the numbers that `all` visits with cells which reach into it.
    fn lists(&self, all: impl Fn(&mut dyn FnMut(usize, u32))) -> Lists<u32> {
        Lists::new(self.buckets.cell_count(), |visit| {
            all(&mut |cell, number| {
                for_each_bucket(&self.buckets, &self.bounds_of(cell), |bucket| visit(bucket, number))
            });
        })
    }

    fn bent(&self, cell: usize) -> Option<&Bent> {
        self.bent.get(self.bent_at[cell] as usize)
    }

    /// The corners of a triangle.
    fn corners(&self, cell: usize) -> [Point<2>; 3] {
        let nodes = self.mesh.cell_nodes(cell);
        [0, 1, 2].map(|k| self.mesh.nodes()[nodes[k] as usize])
    }

    /// Position and derivatives of the map of a cell at reference coordinates.
    fn at(&self, cell: usize, xi: &Local) -> (Point<2>, Matrix<2>) {
        if self.bent(cell).is_none() {
            let corners = self.corners(cell);
            let jacobian = edges(&corners);
            return (corners[0] + jacobian * Point::<2>::new(xi[0], xi[1]), jacobian);
        }
        let mut at = Values::default();
        self.mesh.map(cell).tabulate(xi, &mut at);
        self.mesh.jacobian(cell, &at)
    }

    /// Reference coordinates of a point in a cell or near it, and where there are none, far beyond a strongly curved cell,
    /// those of the linear map of its centre.
    fn local(&self, cell: usize, x: &Point<2>) -> Local {
        let Some(bent) = self.bent(cell) else {
            let corners = self.corners(cell);
            let first = small::inverse(&edges(&corners)) * (x - corners[0]);
            return [first[0], first[1], 0.0];
        };
        let middle = self.mesh.shape(cell).centre();
        let first = bent.inverse * (x - bent.centre);
        let linear: Local = [middle[0] + first[0], middle[1] + first[1], 0.0];
        // A cell with a nearly straight corner folds just beyond it: of two places for a point the one inside counts.
        let vertices = self.mesh.shape(cell).vertices().iter();
        let vertices = vertices.map(|v| [0, 1, 2].map(|k| middle[k] + 0.8 * (v[k] - middle[k])));
        let mut best: Option<(f64, Local)> = None;
        for start in [linear, middle].into_iter().chain(vertices) {
            let Some(xi) = self.newton(cell, x, start) else { continue };
            let beyond = self.mesh.shape(cell).beyond(&xi);
            if best.is_none_or(|(b, _)| beyond < b) {
                best = Some((beyond, xi));
            }
            if beyond < ON_THE_EDGE || bent.regular {
                break;
            }
        }
        best.map_or(linear, |(_, xi)| xi)
    }

    /// Newton's method for the place of a point; none where it fails or ends where the cell is folded over.
    fn newton(&self, cell: usize, x: &Point<2>, start: Local) -> Option<Local> {
        let mut xi = start;
        for _ in 0..30 {
            let (y, jacobian) = self.at(cell, &xi);
            let step = small::inverse(&jacobian) * (x - y);
            let length = step.norm();
            if !length.is_finite() {
                return None;
            }
            let factor = (0.5 / length).min(1.0);
            xi[0] += factor * step[0];
            xi[1] += factor * step[1];
            if length < 1e-14 {
                break;
            }
        }
        let (y, jacobian) = self.at(cell, &xi);
        let found = (x - y).norm() < 1e-10 * self.bounds_of(cell).radius() && small::determinant(&jacobian) > 0.0;
        found.then_some(xi)
    }

    /// How far a point lies beyond a cell, in reference coordinates.
    fn beyond(&self, cell: usize, x: &Point<2>) -> f64 {
        self.mesh.shape(cell).beyond(&self.local(cell, x))
    }
}

/// The edges of a triangle from its first corner, the derivatives of its linear map.
fn edges(corners: &[Point<2>]) -> Matrix<2> {
    Matrix::<2>::from_columns(&[corners[1] - corners[0], corners[2] - corners[0]])
}

/// The longest side of a polygon.
fn longest(vertices: &[Point<2>]) -> f64 {
    let side = |i: usize| (vertices[i] - vertices[(i + 1) % vertices.len()]).norm();
    (0..vertices.len()).map(side).fold(0.0, f64::max)
}

/// The smallest box round points.
fn box_round(points: impl Iterator<Item = Point<2>>) -> Aabb<2> {
    let nowhere = [f64::INFINITY, f64::NEG_INFINITY].map(Point::<2>::repeat);
    let [min, max] = points.fold(nowhere, |[min, max], x| [min.inf(&x), max.sup(&x)]);
    Aabb::new(min, max)
}

fn bounds_of(mesh: &Mesh<2>, bent_at: &[u32], bent: &[Bent], cell: usize) -> Aabb<2> {
    match bent.get(bent_at[cell] as usize) {
        Some(bent) => bent.bounds,
        None => box_round(mesh.vertices(cell).map(|n| mesh.nodes()[n as usize])),
    }
}

/// A point of a quadrature rule in a reference cell.
struct RulePoint {
    weight: f64,
    map: Values,
    functions: Values,
}

fn tabulated(map: &CellMap, degree: usize) -> Vec<RulePoint> {
    let basis = HierarchicBasis::new(map.shape(), degree);
    let points: Rule = rule(map.shape(), whole_order(degree) + usize::from(map.order() > 1));
    points
        .into_iter()
        .map(|(x, w)| {
            let mut point = RulePoint { weight: w, map: Values::default(), functions: Values::default() };
            map.tabulate(&x, &mut point.map);
            basis.tabulate(&x, &mut point.functions);
            point
        })
        .collect()
}

fn for_each_bucket(buckets: &Grid<2>, b: &Aabb<2>, mut visit: impl FnMut(usize)) {
    let [low, high] = [&b.min, &b.max].map(|x| buckets.cell_index(buckets.cell_containing(x)));
    for j in low[1]..=high[1] {
        for i in low[0]..=high[0] {
            visit(buckets.cell_at([i, j]));
        }
    }
}

type Boundary = (Vec<(String, Vec<usize>)>, Vec<BoundarySide>, usize);

/// The sides on the boundary, cell by cell. Those that belong to the same groups are one piece; pieces are numbered by the
/// names of their groups, so that those of a divided mesh have the same numbers.
fn boundary(mesh: &Mesh<2>, adjacency: &Adjacency) -> Boundary {
    let mut names: BTreeMap<Side, BTreeSet<&str>> = BTreeMap::new();
    for (name, group) in mesh.groups() {
        for side in group.sides.iter().filter(|side| adjacency.across(**side).is_none()) {
            names.entry(*side).or_default().insert(name);
        }
    }
    let free: Vec<Side> = mesh.all_sides().filter(|side| adjacency.across(*side).is_none()).collect();
    let none = BTreeSet::new();
    let of = |side: &Side| names.get(side).unwrap_or(&none);
    let pieces: BTreeSet<&BTreeSet<&str>> = free.iter().map(of).collect();
    let pieces: Vec<&BTreeSet<&str>> = pieces.into_iter().collect();
    let mut groups: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for (piece, names) in pieces.iter().enumerate() {
        names.iter().for_each(|name| groups.entry(name.to_string()).or_default().push(piece));
    }
    groups.entry("boundary".into()).or_insert_with(|| (0..pieces.len()).collect());
    let side = |side: &Side| {
        let piece = pieces.binary_search(&of(side)).unwrap_or(0);
        BoundarySide { cell: side.cell as usize, side: side.side as usize, piece }
    };
    (groups.into_iter().collect(), free.iter().map(side).collect(), pieces.len())
}

impl CellByCell<2> for MeshCells {
    fn neighbours_of(&self, cell: usize, out: &mut Vec<Neighbours>) {
        for side in 0..self.mesh.shape(cell).sides().len() {
            let side = Side { cell: cell as u32, side: side as u8 };
            if let Some(other) = self.adjacency.across(side).filter(|other| *other > cell) {
                let ends = self.mesh.side_vertices(side);
                let length = (self.mesh.nodes()[ends[0] as usize] - self.mesh.nodes()[ends[1] as usize]).norm();
                let width = 0.5 * (self.volume(cell) + self.volume(other)) / length;
                out.push(Neighbours { cells: [cell, other], width, kind: None });
            }
        }
    }
    fn sides_of(&self, cell: usize, out: &mut Vec<BoundarySide>) {
        let from = self.sides.partition_point(|side| side.cell < cell);
        out.extend(self.sides[from..].iter().take_while(|side| side.cell == cell));
    }
}

impl Cells<2> for MeshCells {
    fn degree(&self) -> usize {
        self.degree
    }
    fn count(&self) -> usize {
        self.bent_at.len()
    }
    fn bounds_of(&self, cell: usize) -> Aabb<2> {
        bounds_of(&self.mesh, &self.bent_at, &self.bent, cell)
    }
    fn size(&self, cell: usize) -> f64 {
        let of_triangle = || {
            let corners = self.corners(cell);
            small::determinant(&edges(&corners)) / longest(&corners)
        };
        self.bent(cell).map_or_else(of_triangle, |bent| bent.size)
    }
    fn volume(&self, cell: usize) -> f64 {
        let of_triangle = || 0.5 * small::determinant(&edges(&self.corners(cell)));
        self.bent(cell).map_or_else(of_triangle, |bent| bent.volume)
    }
    fn containing(&self, x: &Point<2>) -> Option<usize> {
        if (0..2).any(|k| x[k] < self.bounds().min[k] || x[k] > self.bounds().max[k]) {
            return None;
        }
        let inside = |cell: usize| {
            let b = self.bounds_of(cell);
            (0..2).all(|k| x[k] >= b.min[k] && x[k] <= b.max[k])
        };
        let mut best = (ON_THE_EDGE, None);
        let cells_in = self
            .cells_in
            .get_or_init(|| self.lists(|visit| (0..self.count()).for_each(|cell| visit(cell, cell as u32))));
        for &cell in cells_in.of(self.buckets.cell_containing(x)) {
            if !inside(cell as usize) {
                continue;
            }
            let beyond = self.beyond(cell as usize, x);
            if beyond < best.0 {
                best = (beyond, Some(cell as usize));
            }
        }
        best.1
    }
    fn sum_to_one(&self) -> bool {
        self.degree == 1
    }
    fn function_count(&self) -> usize {
        self.dofs.count()
    }
    fn functions(&self, cell: usize, out: &mut Vec<u32>) {
        out.clear();
        out.extend_from_slice(self.dofs.functions(cell));
    }
    fn edges(&self, cell: usize) -> &'static [[usize; 2]] {
        self.mesh.shape(cell).edges()
    }
    fn tabulate(&self, cell: usize, x: &Point<2>, out: &mut Tabulation<2>) {
        if self.degree == 1 && self.is_straight(cell) {
            let corners = self.corners(cell);
            let inverse = small::inverse(&edges(&corners));
            let (first, slopes) = (inverse * (x - corners[0]), inverse.transpose());
            out.value.clear();
            out.gradient.clear();
            out.value.extend([1.0 - first[0] - first[1], first[0], first[1]]);
            let [b, c] = [0, 1].map(|k| slopes.column(k).into_owned());
            out.gradient.extend([-b - c, b, c]);
            return;
        }
        let xi = self.local(cell, x);
        let inverse = small::inverse(&self.at(cell, &xi).1);
        let mut values = Values::default();
        self.dofs.basis(cell).tabulate(&xi, &mut values);
        self.slopes(cell, &values, &inverse, out);
    }
    fn extension<'a>(&'a self, cell: usize) -> Extension<'a, 2> {
        // The functions of a cell that is not affine may not be carried on: its map folds. Of their polynomials of the
        // same degree, those are taken that are closest in the mean square.
        let degree = self.degree;
        let Some(bent) = self.bent(cell) else { return own_extension(self, cell) };
        let (centre, scale) = (bent.centre, bent.bounds.radius());
        let monomials = move |x: &Point<2>| {
            let y = (x - centre) / scale;
            let powers = (0..=degree).flat_map(move |n| (0..=n).map(move |k| (n - k, k)));
            powers.map(|(i, j)| y[0].powi(i as i32) * y[1].powi(j as i32)).collect::<Vec<f64>>()
        };
        let m = (degree + 1) * (degree + 2) / 2;
        let n = self.dofs.cell(cell).len();
        let (mut mass, mut load) = (DMatrix::<f64>::zeros(m, m), DMatrix::<f64>::zeros(m, n));
        let mut t = Tabulation::default();
        for p in self.rule(cell) {
            self.tabulate(cell, &p.x, &mut t);
            let basis = DVector::from_vec(monomials(&p.x));
            mass.ger(p.weight, &basis, &basis, 1.0);
            load.ger(p.weight, &basis, &DVector::from_column_slice(&t.value), 1.0);
        }
        let coefficients = mass.cholesky().map_or_else(|| DMatrix::zeros(m, n), |factor| factor.solve(&load));
        let values = move |x: &Point<2>, out: &mut Vec<f64>| {
            let basis = monomials(x);
            out.clear();
            out.extend(coefficients.column_iter().map(|c| c.iter().zip(&basis).map(|(c, b)| c * b).sum::<f64>()));
        };
        Extension { values: Box::new(values), is_own: false }
    }
    fn node(&self, function: usize) -> Point<2> {
        self.nodes[function]
    }
    fn linear(&self, _: usize) -> Arc<dyn Cells<2>> {
        Arc::new(Self::new(self.mesh.clone(), 1))
    }
    fn raised(&self) -> Option<Arc<dyn Cells<2>>> {
        let most = if (0..self.count()).any(|cell| !self.mesh.shape(cell).is_tensor()) {
            MOST_ON_TRIANGLES
        } else {
            MAX_DEGREE
        };
        (self.degree < most).then(|| -> Arc<dyn Cells<2>> { Arc::new(Self::new(self.mesh.clone(), self.degree + 1)) })
    }
    fn coarser(&self) -> Option<Arc<dyn Cells<2>>> {
        let coarse = &self.parent()?.cells;
        Some(if self.degree == 1 { coarse.clone() } else { Arc::new(Self::new(coarse.mesh.clone(), 1)) })
    }
    fn mesh(self: Arc<Self>) -> Option<Arc<MeshCells>> {
        Some(self)
    }
    fn halved(self: Arc<Self>) -> Option<Arc<dyn Cells<2>>> {
        Some(Arc::new(self.refined()))
    }
    fn outlines(&self, value: &dyn Fn(&Point<2>) -> f64) -> Option<Vec<Vec<Point<2>>>> {
        let cells = (0..self.count()).map(|cell| self.mesh.vertices(cell).collect());
        let place = |vertex: u32| self.mesh.nodes()[vertex as usize];
        outlines_between(cells, |vertex| value(&place(vertex)), place, 1e-12 * self.bounds().radius())
    }
    fn divisions(&self, cell: usize) -> usize {
        self.levels.get(cell).map_or(0, |level| usize::from(*level))
    }
    fn for_each_point(&self, cell: usize, visit: &mut dyn FnMut(&QuadraturePoint<2>, &Tabulation<2>)) {
        let mut t = Tabulation::default();
        for point in &self.rules[self.mesh.map_number(cell)] {
            let (x, jacobian) = self.mesh.jacobian(cell, &point.map);
            let determinant = small::determinant(&jacobian);
            self.slopes(cell, &point.functions, &small::inverse(&jacobian), &mut t);
            visit(&QuadraturePoint { x, weight: point.weight * determinant.abs() }, &t);
        }
    }
    fn rule(&self, cell: usize) -> Vec<QuadraturePoint<2>> {
        self.rules[self.mesh.map_number(cell)]
            .iter()
            .map(|point| {
                let (x, jacobian) = self.mesh.jacobian(cell, &point.map);
                QuadraturePoint { x, weight: point.weight * small::determinant(&jacobian).abs() }
            })
            .collect()
    }
    fn cut(&self, cell: usize, partition: &CellPartition<'_, 2>, order: usize) -> CellRule<2> {
        let square = Square::new(self, cell, partition);
        let sheets = partition.sheets.iter().map(|sheet| {
            let drawn: Box<dyn ImplicitShape<2> + '_> = Box::new(Drawn { square: &square, sheet: &**sheet });
            drawn
        });
        let drawn = CellPartition {
            sheets: sheets.collect(),
            tags: partition.tags.clone(),
            features: partition.features.iter().map(|x| square.parameters(x)).collect(),
            region: Box::new(|s, values| (partition.region)(&square.at(s).0, values)),
        };
        let unit = Aabb::new(Point::<2>::zeros(), Point::<2>::repeat(1.0));
        let mut rule = cut_cell(&drawn, &unit, order);
        for p in rule.volumes.iter_mut().flat_map(|(_, points)| points) {
            let (x, jacobian) = square.at(&p.x);
            *p = QuadraturePoint { x, weight: p.weight * small::determinant(&jacobian).abs() };
        }
        for p in &mut rule.surfaces {
            let (x, j) = square.at(&p.x);
            // Nanson's formula: the cofactors take normal and length along, also where a triangle's side is collapsed.
            let turned = small::determinant(&j).signum()
                * Vector::<2>::new(
                    j[(1, 1)] * p.normal[0] - j[(1, 0)] * p.normal[1],
                    j[(0, 0)] * p.normal[1] - j[(0, 1)] * p.normal[0],
                );
            let length = turned.norm();
            (p.x, p.weight, p.normal) = (x, p.weight * length, turned / length.max(f64::MIN_POSITIVE));
        }
        rule
    }
    fn kind(&self, _: usize) -> Option<usize> {
        None
    }
    fn kinds(&self) -> Vec<usize> {
        Vec::new()
    }
    fn neighbours(&self) -> Vec<Neighbours> {
        let mut out = Vec::new();
        (0..self.count()).for_each(|cell| self.neighbours_of(cell, &mut out));
        out
    }
    fn boundary_sides(&self) -> Vec<BoundarySide> {
        self.sides.clone()
    }
    fn on_side(&self, side: &BoundarySide, t: f64) -> SidePoint<2> {
        let of = Side { cell: side.cell as u32, side: side.side as u8 };
        let (x, [along, _]) = self.mesh.on_side(of, &[2.0 * t - 1.0, 0.0, 0.0]);
        let tangent = 2.0 * along;
        SidePoint { x, tangent, normal: Vector::<2>::new(tangent[1], -tangent[0]).normalize() }
    }
    fn divided(&self, cell: usize, n: usize) -> Divided<2> {
        let at = |i: usize, j: usize| [i as f64 / n as f64, j as f64 / n as f64];
        if self.mesh.shape(cell) != CellShape::Triangle {
            let points = (0..=n).flat_map(|j| (0..=n).map(move |i| at(i, j).map(|t| 2.0 * t - 1.0)));
            let points = points.map(|[a, b]| self.at(cell, &[a, b, 0.0]).0).collect();
            return Divided { points, parts: quadrilaterals(n) };
        }
        // Rows of n + 1, n, ... 1 points.
        let points = (0..=n).flat_map(|j| (0..=n - j).map(move |i| at(i, j)));
        let points = points.map(|[a, b]| self.at(cell, &[a, b, 0.0]).0).collect();
        let number = |i: usize, j: usize| j * (n + 1) - j * j.saturating_sub(1) / 2 + i;
        let mut parts = Vec::new();
        for j in 0..n {
            for i in 0..n - j {
                parts.push(vec![number(i, j), number(i + 1, j), number(i, j + 1)]);
                if i + j + 1 < n {
                    parts.push(vec![number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)]);
                }
            }
        }
        Divided { points, parts }
    }
}

/// The unit square drawn onto a cell.
struct Square<'a> {
    cells: &'a MeshCells,
    cell: usize,
    /// For a triangle, the vertices: the first takes a whole side of the square.
    corners: Option<[Local; 3]>,
}

impl<'a> Square<'a> {
    fn new(cells: &'a MeshCells, cell: usize, partition: &CellPartition<'_, 2>) -> Self {
        let shape = cells.mesh.shape(cell);
        let corners = (shape == CellShape::Triangle).then(|| {
            let vertices = shape.vertices();
            let distance = |v: &Local| {
                let x = cells.at(cell, v).0;
                partition.sheets.iter().map(|s| s.value(&x).abs()).fold(f64::INFINITY, f64::min)
            };
            let farthest =
                (0..3).max_by(|&a, &b| distance(&vertices[a]).total_cmp(&distance(&vertices[b]))).unwrap_or(0);
            [0, 1, 2].map(|k| vertices[(farthest + k) % 3])
        });
        Self { cells, cell, corners }
    }

    /// Reference coordinates of a point of the square, and their derivatives.
    fn reference(&self, s: &Point<2>) -> (Local, Matrix<2>) {
        match &self.corners {
            None => ([2.0 * s[0] - 1.0, 2.0 * s[1] - 1.0, 0.0], Matrix::<2>::identity() * 2.0),
            Some([apex, a, b]) => {
                let mut xi = [0.0; 3];
                let mut derivatives = Matrix::<2>::zeros();
                for k in 0..2 {
                    let base = a[k] + s[0] * (b[k] - a[k]);
                    xi[k] = base + s[1] * (apex[k] - base);
                    derivatives[(k, 0)] = (1.0 - s[1]) * (b[k] - a[k]);
                    derivatives[(k, 1)] = apex[k] - base;
                }
                (xi, derivatives)
            }
        }
    }

    fn at(&self, s: &Point<2>) -> (Point<2>, Matrix<2>) {
        let (xi, derivatives) = self.reference(s);
        let (x, jacobian) = self.cells.at(self.cell, &xi);
        (x, jacobian * derivatives)
    }

    /// The point of the square for a point of the cell.
    fn parameters(&self, x: &Point<2>) -> Point<2> {
        let xi = self.cells.local(self.cell, x);
        match &self.corners {
            None => Point::<2>::new(0.5 * (1.0 + xi[0]), 0.5 * (1.0 + xi[1])),
            Some([apex, a, b]) => {
                let edges = Matrix::<2>::new(b[0] - a[0], apex[0] - a[0], b[1] - a[1], apex[1] - a[1]);
                let st = small::inverse(&edges) * Vector::<2>::new(xi[0] - a[0], xi[1] - a[1]);
                // Along the base, and towards the apex.
                Point::<2>::new(st[0] / (1.0 - st[1]).max(f64::MIN_POSITIVE), st[1])
            }
        }
    }
}

/// A surface in the coordinates of the unit square.
struct Drawn<'a> {
    square: &'a Square<'a>,
    sheet: &'a dyn ImplicitShape<2>,
}

impl ImplicitShape<2> for Drawn<'_> {
    fn value(&self, s: &Point<2>) -> f64 {
        self.sheet.value(&self.square.at(s).0)
    }
    fn gradient(&self, s: &Point<2>) -> Vector<2> {
        self.value_and_gradient(s).1
    }
    fn value_and_gradient(&self, s: &Point<2>) -> (f64, Vector<2>) {
        let (x, jacobian) = self.square.at(s);
        let (value, gradient) = self.sheet.value_and_gradient(&x);
        (value, jacobian.transpose() * gradient)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cut::RegionId;
    use signorini_geometry::{Ellipsoid, ImplicitShape};

    /// A curved triangle, and beside it a curved quadrilateral with a straight corner, as mesh generators put them at
    /// round edges: three of its corners lie on one circle, the Jacobian at the middle one nearly vanishes.
    fn cells(degree: usize) -> MeshCells {
        let on_circle = |angle: f64| Point::<2>::new(angle.cos(), angle.sin());
        let [a, b, c] = [0.6, 0.75, 0.9].map(on_circle);
        let inner = Point::<2>::new(0.6, 0.6);
        let beside = Point::<2>::new(0.75, 0.3);
        let mut nodes = vec![a, b, c, inner, beside];
        nodes.extend([on_circle(0.675), on_circle(0.825), 0.5 * (a + inner), 0.5 * (c + inner)]);
        nodes.push(0.25 * (a + b + c + inner));
        nodes.extend([0.5 * (inner + beside) + Point::<2>::new(-0.01, 0.01), 0.5 * (beside + a)]);
        let mut mesh = Mesh::<2>::new(nodes);
        // Tensor order: from `inner` along the side to a, then to c.
        mesh.add_cell(CellShape::Quadrilateral, 2, &[3, 7, 0, 8, 9, 5, 2, 6, 1]);
        mesh.add_cell(CellShape::Triangle, 2, &[3, 4, 0, 10, 11, 7]);
        mesh.check().unwrap();
        MeshCells::new(mesh, degree)
    }

    #[test]
    fn places_are_found_again_also_beside_a_straight_corner() {
        let cells = cells(2);
        assert!(!cells.bent[0].regular && cells.bent[1].regular);
        for cell in 0..2 {
            for (xi, _) in rule(cells.mesh.shape(cell), 9) {
                let x = cells.at(cell, &xi).0;
                let found = cells.local(cell, &x);
                assert!((found[0] - xi[0]).abs() + (found[1] - xi[1]).abs() < 1e-9, "{cell}: {xi:?} {found:?}");
                assert_eq!(cells.containing(&x), Some(cell));
            }
        }
        assert_eq!(cells.containing(&Point::<2>::new(0.0, 0.0)), None);
    }

    #[test]
    fn functions_know_positions_and_their_slopes() {
        // Straight cells, within and a little beyond: functions of degree 1 add up to the position.
        let corners = [[0.0, 0.0], [1.0, 0.1], [1.2, 0.9], [0.1, 1.1], [1.9, 0.3]].map(Point::<2>::from);
        let mut mesh = Mesh::<2>::new(corners.to_vec());
        mesh.add_cell(CellShape::Quadrilateral, 1, &[0, 1, 3, 2]);
        mesh.add_cell(CellShape::Triangle, 1, &[1, 4, 2]);
        mesh.check().unwrap();
        let straight = MeshCells::new(mesh, 1);
        let (mut numbers, mut t) = (Vec::new(), Tabulation::default());
        for (cell, x) in [(0, [0.5, 0.6]), (0, [-0.05, 0.5]), (1, [1.3, 0.4]), (1, [1.5, 0.9])] {
            let x = Point::<2>::from(x);
            straight.functions(cell, &mut numbers);
            straight.tabulate(cell, &x, &mut t);
            let (mut position, mut slopes) = (Point::<2>::zeros(), Matrix::<2>::zeros());
            for ((&f, value), gradient) in numbers.iter().zip(&t.value).zip(&t.gradient) {
                position += *value * straight.node(f as usize);
                slopes += straight.node(f as usize) * gradient.transpose();
            }
            assert!((position - x).norm() < 1e-13, "cell {cell}: {position:?} at {x:?}");
            assert!((slopes - Matrix::<2>::identity()).norm() < 1e-12, "cell {cell}: {slopes:?}");
        }
        // Curved cells: slopes are those of the values.
        let curved = cells(2);
        for cell in 0..2 {
            let x = curved.at(cell, &curved.mesh.shape(cell).centre()).0;
            curved.tabulate(cell, &x, &mut t);
            let slopes = t.gradient.clone();
            for k in 0..2 {
                let values = [-1e-6, 1e-6].map(|d| {
                    let mut y = x;
                    y[k] += d;
                    curved.tabulate(cell, &y, &mut t);
                    t.value.clone()
                });
                for (i, slope) in slopes.iter().enumerate() {
                    let difference = (values[1][i] - values[0][i]) / 2e-6;
                    assert!((difference - slope[k]).abs() < 1e-6 * slope.norm().max(1.0), "cell {cell}, {i}");
                }
            }
        }
    }

    #[test]
    fn parts_of_a_cut_cell_add_up_and_fluxes_balance() {
        let cells = cells(1);
        // Each cuts off another part, the first at the vertex that the triangle and the quadrilateral share.
        for (center, radius) in [([0.62, 0.6], 0.07), ([0.75, 0.3], 0.2), ([0.0, 0.0], 0.93)] {
            let disc = Ellipsoid { center: center.into(), semi_axes: [radius; 2] };
            let partition = CellPartition {
                sheets: vec![Box::new(&disc)],
                tags: vec![0],
                features: Vec::new(),
                region: Box::new(|_, v| RegionId::from(v[0] < 0.0)),
            };
            for cell in 0..2 {
                let rule = cells.cut(cell, &partition, 14);
                let total: f64 = rule.volumes.iter().flat_map(|(_, points)| points).map(|p| p.weight).sum();
                let error = (total - cells.volume(cell)).abs() / cells.volume(cell);
                assert!(error < 1e-9, "{center:?}, cell {cell}: area {error:e}");
                for p in &rule.surfaces {
                    let y = (p.x - disc.center) / radius;
                    assert!((y.norm() - 1.0).abs() < 1e-9 && (p.normal - y).norm() < 1e-7 && p.minus == 1);
                }
            }
            // The part of the circle within the cells closes the boundary of what is inside.
            let mut flux = Vector::<2>::zeros();
            for cell in 0..2 {
                for p in &cells.cut(cell, &partition, 14).surfaces {
                    flux += p.weight * p.normal;
                }
            }
            for side in cells.boundary_sides() {
                let n = 4000;
                for i in 0..n {
                    let p = cells.on_side(&side, (i as f64 + 0.5) / n as f64);
                    if disc.value(&p.x) < 0.0 {
                        flux += p.normal * (p.tangent.norm() / n as f64);
                    }
                }
            }
            assert!(flux.norm() < 2e-4, "{center:?}: {flux:?}");
        }
    }

    #[test]
    fn sides_in_the_same_groups_are_one_piece() {
        let mut mesh = cells(1).mesh;
        mesh.group_mut("arc").sides = vec![Side { cell: 0, side: 1 }, Side { cell: 0, side: 2 }];
        let cells = MeshCells::new(mesh, 1);
        assert_eq!(cells.pieces(), 2);
        let names: Vec<(&str, usize)> = cells.groups().iter().map(|(n, p)| (n.as_str(), p.len())).collect();
        assert_eq!(names, [("arc", 1), ("boundary", 2)]);
    }
}
