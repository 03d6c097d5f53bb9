//! Triangles and quadrilaterals of a mesh, straight or curved, as the cells of a membrane.
//!
//! A cell is cut in a unit square: a quadrilateral's own, and for a triangle the one that collapses onto it with one side
//! at the vertex that is farthest from what cuts it.

use crate::cell_map::CellMap;
use crate::cells::{BoundarySide, Cells, Divided, Neighbours, SidePoint, quadrilaterals, whole_order};
use crate::cut::{CellPartition, CellRule, QuadraturePoint, cut_cell};
use crate::dofs::DofMap;
use crate::grid::Grid;
use crate::hierarchic::Values;
use crate::lagrange::Tabulation;
use crate::mesh::{Mesh, Side};
use crate::reference::{CellShape, Local};
use crate::rules::{Rule, rule};
use crate::small;
use signorini_geometry::{Aabb, ImplicitShape, Matrix, Point, Vector};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::Arc;

/// How far beyond its cell, in reference coordinates, a point still belongs to it.
const ON_THE_EDGE: f64 = 1e-9;
/// Buckets per cell of the grid in which points are looked up.
const BUCKET: f64 = 1.0;

/// The cells of a plane mesh with functions of one degree.
pub struct MeshCells {
    mesh: Mesh<2>,
    dofs: DofMap,
    /// The vertex of each function that belongs to one.
    nodes: Vec<Point<2>>,
    degree: usize,
    boxes: Vec<Aabb<2>>,
    sizes: Vec<f64>,
    volumes: Vec<f64>,
    /// Centre and inverse Jacobian there; and whether the map is linear.
    linear: Vec<(Point<2>, Matrix<2>, bool)>,
    /// Rule of each map, tabulated.
    rules: Vec<Vec<(f64, Values)>>,
    buckets: Grid<2>,
    /// For each bucket, the cells and the boundary sides that reach into it.
    cells_in: Vec<Vec<u32>>,
    sides_in: Vec<Vec<u32>>,
    neighbours: Vec<Neighbours>,
    sides: Vec<(BoundarySide, Side)>,
    groups: Vec<(String, Vec<usize>)>,
    pieces: usize,
}

impl MeshCells {
    /// Functions of the given degree on a mesh that [`Mesh::check`] accepts.
    ///
    /// # Panics
    /// If the degree is above 2 on a mesh with triangles.
    pub fn new(mesh: Mesh<2>, degree: usize) -> Self {
        let count = mesh.cell_count();
        let dofs = DofMap::new(&mesh, degree);
        let mut vertices = vec![Point::<2>::zeros(); dofs.count()];
        for node in (0..count).flat_map(|cell| mesh.vertices(cell)) {
            if let Some(function) = dofs.vertex(node) {
                vertices[function as usize] = mesh.nodes()[node as usize];
            }
        }
        let nodes = vertices;
        let mut rules: BTreeMap<usize, Vec<(f64, Values)>> = BTreeMap::new();
        let (mut boxes, mut sizes, mut volumes, mut linear) = (vec![], vec![], vec![], vec![]);
        let mut at = Values::default();
        for cell in 0..count {
            let map = mesh.map(cell);
            let table = rules.entry(mesh.map_number(cell)).or_insert_with(|| tabulated(map, degree));
            let volume: f64 =
                table.iter().map(|(w, at)| w * small::determinant(&mesh.jacobian(cell, at).1).abs()).sum();
            let corners: Vec<Point<2>> = mesh.cell_nodes(cell).iter().map(|&n| mesh.nodes()[n as usize]).collect();
            let vertices: Vec<Point<2>> = mesh.vertices(cell).map(|n| mesh.nodes()[n as usize]).collect();
            let longest =
                (0..vertices.len()).map(|i| (vertices[i] - vertices[(i + 1) % vertices.len()]).norm()).fold(0.0, f64::max);
            // The height of a triangle, the width of a quadrilateral.
            sizes.push(volume / longest * if vertices.len() == 3 { 2.0 } else { 1.0 });
            volumes.push(volume);
            let mut bounds = corners.iter().fold(Aabb::new(corners[0], corners[0]), |b, p| Aabb::new(b.min.inf(p), b.max.sup(p)));
            if map.order() > 1 {
                // A curved side bulges beyond its nodes by no more than it bulges at them.
                bounds = bounds.scaled(1.25);
            }
            boxes.push(bounds);
            map.tabulate(&map.shape().centre(), &mut at);
            let (x, jacobian) = mesh.jacobian(cell, &at);
            let straight = map.shape() == CellShape::Triangle
                && table.iter().all(|(_, at)| (mesh.jacobian(cell, at).1 - jacobian).norm() < 1e-13 * jacobian.norm());
            linear.push((x, small::inverse(&jacobian), straight));
        }
        let bounds = boxes.iter().fold(boxes[0], |a, b| Aabb::new(a.min.inf(&b.min), a.max.sup(&b.max)));
        let spacing = BUCKET * (volumes.iter().sum::<f64>() / count as f64).sqrt();
        let number = |k: usize| ((bounds.size()[k] / spacing).ceil() as usize).clamp(1, 4096);
        let buckets = Grid::new(bounds, [number(0), number(1)], 1);
        let mut cells_in = vec![Vec::new(); buckets.cell_count()];
        for (cell, b) in boxes.iter().enumerate() {
            for_each_bucket(&buckets, b, |bucket| cells_in[bucket].push(cell as u32));
        }
        let (groups, sides, pieces) = boundary(&mesh);
        let mut sides_in = vec![Vec::new(); buckets.cell_count()];
        for (k, (side, _)) in sides.iter().enumerate() {
            for_each_bucket(&buckets, &boxes[side.cell], |bucket| sides_in[bucket].push(k as u32));
        }
        let neighbours = neighbours(&mesh, &volumes);
        let maps = rules.keys().max().map_or(0, |m| m + 1);
        let rules = (0..maps).map(|m| rules.remove(&m).unwrap_or_default()).collect();
        Self {
            mesh,
            dofs,
            nodes,
            degree,
            boxes,
            sizes,
            volumes,
            linear,
            rules,
            buckets,
            cells_in,
            sides_in,
            neighbours,
            sides,
            groups,
            pieces,
        }
    }

    pub fn mesh(&self) -> &Mesh<2> {
        &self.mesh
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
        let mut sizes: Vec<f64> = (0..self.volumes.len())
            .map(|c| (self.volumes[c] * if self.mesh.shape(c) == CellShape::Triangle { 2.0 } else { 1.0 }).sqrt())
            .collect();
        sizes.sort_by(f64::total_cmp);
        let h = sizes[sizes.len() / 2];
        let number = |k: usize| ((self.bounds().size()[k] / h).round() as usize).clamp(1, 1 << 14);
        Grid::new(*self.bounds(), [number(0), number(1)], self.degree)
    }

    /// The point of the boundary that is closest to `x`, to a fraction of a cell, if there is one within `reach`.
    pub fn closest_on_boundary(&self, x: &Point<2>, reach: f64) -> Option<Point<2>> {
        const PARTS: usize = 4;
        let mut best: Option<(f64, Point<2>)> = None;
        let reach_vector = Point::<2>::repeat(reach);
        for_each_bucket(&self.buckets, &Aabb::new(x - reach_vector, x + reach_vector), |bucket| {
            for &k in &self.sides_in[bucket] {
                let side = &self.sides[k as usize].0;
                for i in 0..PARTS {
                    let [a, b] = [i, i + 1].map(|j| self.on_side(side, j as f64 / PARTS as f64).x);
                    let along = b - a;
                    let t = ((x - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
                    let y = self.on_side(side, (i as f64 + t) / PARTS as f64).x;
                    let distance = (x - y).norm();
                    if distance <= reach && best.is_none_or(|(d, _)| distance < d) {
                        best = Some((distance, y));
                    }
                }
            }
        });
        best.map(|(_, y)| y)
    }

    fn at(&self, cell: usize, xi: &Local) -> (Point<2>, Matrix<2>) {
        let mut at = Values::default();
        self.mesh.map(cell).tabulate(xi, &mut at);
        self.mesh.jacobian(cell, &at)
    }

    /// Reference coordinates of a point in a cell or near it: by Newton's method, and where that fails, far beyond a
    /// strongly curved cell, by the linear map of its centre.
    fn local(&self, cell: usize, x: &Point<2>) -> Local {
        let (centre, inverse, straight) = &self.linear[cell];
        let middle = self.mesh.shape(cell).centre();
        let first = inverse * (x - centre);
        let start: Local = [middle[0] + first[0], middle[1] + first[1], 0.0];
        if *straight {
            return start;
        }
        let mut xi = start;
        for _ in 0..30 {
            let (y, jacobian) = self.at(cell, &xi);
            let step = small::inverse(&jacobian) * (x - y);
            let length = step.norm();
            if !length.is_finite() {
                return start;
            }
            let factor = (0.5 / length).min(1.0);
            xi[0] += factor * step[0];
            xi[1] += factor * step[1];
            if length < 1e-14 {
                return xi;
            }
        }
        let (y, _) = self.at(cell, &xi);
        if (x - y).norm() < 1e-10 * self.sizes[cell] { xi } else { start }
    }

    /// How far a point lies beyond a cell, in reference coordinates.
    fn beyond(&self, cell: usize, x: &Point<2>) -> f64 {
        let [a, b, _] = self.local(cell, x);
        match self.mesh.shape(cell) {
            CellShape::Triangle => (-a).max(-b).max(a + b - 1.0),
            _ => a.abs().max(b.abs()) - 1.0,
        }
    }
}

fn tabulated(map: &CellMap, degree: usize) -> Vec<(f64, Values)> {
    let points: Rule = rule(map.shape(), whole_order(degree) + usize::from(map.order() > 1));
    points
        .into_iter()
        .map(|(x, w)| {
            let mut at = Values::default();
            map.tabulate(&x, &mut at);
            (w, at)
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

type Boundary = (Vec<(String, Vec<usize>)>, Vec<(BoundarySide, Side)>, usize);

/// The sides on the boundary. Those that belong to the same groups are one piece.
fn boundary(mesh: &Mesh<2>) -> Boundary {
    let mut names: BTreeMap<Side, BTreeSet<&str>> = BTreeMap::new();
    for (name, group) in mesh.groups() {
        for side in &group.sides {
            names.entry(*side).or_default().insert(name);
        }
    }
    let mut pieces: BTreeMap<BTreeSet<&str>, usize> = BTreeMap::new();
    let mut groups: BTreeMap<String, BTreeSet<usize>> = BTreeMap::new();
    let sides: Vec<(BoundarySide, Side)> = mesh
        .boundary()
        .into_iter()
        .map(|side| {
            let of = names.get(&side).cloned().unwrap_or_default();
            let next = pieces.len();
            let piece = *pieces.entry(of.clone()).or_insert(next);
            for name in of {
                groups.entry(name.to_string()).or_default().insert(piece);
            }
            (BoundarySide { cell: side.cell as usize, side: side.side as usize, piece }, side)
        })
        .collect();
    groups.entry("boundary".into()).or_insert_with(|| (0..pieces.len()).collect());
    let groups = groups.into_iter().map(|(name, pieces)| (name, pieces.into_iter().collect())).collect();
    (groups, sides, pieces.len())
}

fn neighbours(mesh: &Mesh<2>, volumes: &[f64]) -> Vec<Neighbours> {
    let mut open: HashMap<[u32; 2], usize> = HashMap::new();
    let mut pairs = Vec::new();
    for side in mesh.all_sides() {
        let ends = mesh.side_vertices(side);
        let key = [ends[0].min(ends[1]), ends[0].max(ends[1])];
        let cell = side.cell as usize;
        if let Some(other) = open.insert(key, cell) {
            let length = (mesh.nodes()[ends[0] as usize] - mesh.nodes()[ends[1] as usize]).norm();
            let width = 0.5 * (volumes[cell] + volumes[other]) / length;
            pairs.push(Neighbours { cells: [other, cell], width, kind: None });
        }
    }
    pairs
}

impl Cells<2> for MeshCells {
    fn degree(&self) -> usize {
        self.degree
    }
    fn count(&self) -> usize {
        self.boxes.len()
    }
    fn bounds_of(&self, cell: usize) -> Aabb<2> {
        self.boxes[cell]
    }
    fn size(&self, cell: usize) -> f64 {
        self.sizes[cell]
    }
    fn volume(&self, cell: usize) -> f64 {
        self.volumes[cell]
    }
    fn containing(&self, x: &Point<2>) -> Option<usize> {
        if (0..2).any(|k| x[k] < self.bounds().min[k] || x[k] > self.bounds().max[k]) {
            return None;
        }
        let inside = |cell: usize| (0..2).all(|k| x[k] >= self.boxes[cell].min[k] && x[k] <= self.boxes[cell].max[k]);
        let mut best = (ON_THE_EDGE, None);
        for &cell in &self.cells_in[self.buckets.cell_containing(x)] {
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
    fn function_count(&self) -> usize {
        self.dofs.count()
    }
    fn functions(&self, cell: usize, out: &mut Vec<u32>) {
        out.clear();
        out.extend(self.dofs.cell(cell).iter().map(|(f, _)| f));
    }
    fn tabulate(&self, cell: usize, x: &Point<2>, out: &mut Tabulation<2>) {
        let xi = self.local(cell, x);
        let inverse = small::inverse(&self.at(cell, &xi).1);
        let mut values = Values::default();
        self.dofs.basis(cell).tabulate(&xi, &mut values);
        out.value.clear();
        out.gradient.clear();
        for ((value, g), (_, sign)) in values.value.iter().zip(&values.gradient).zip(self.dofs.cell(cell)) {
            out.value.push(sign * value);
            out.gradient.push(Vector::from_fn(|k, _| sign * (g[0] * inverse[(0, k)] + g[1] * inverse[(1, k)])));
        }
    }
    fn node(&self, function: usize) -> Point<2> {
        self.nodes[function]
    }
    fn linear(&self, _: usize) -> Arc<dyn Cells<2>> {
        Arc::new(Self::new(self.mesh.clone(), 1))
    }
    fn coarser(&self) -> Option<Arc<dyn Cells<2>>> {
        None
    }
    fn rule(&self, cell: usize) -> Vec<QuadraturePoint<2>> {
        self.rules[self.mesh.map_number(cell)]
            .iter()
            .map(|(w, at)| {
                let (x, jacobian) = self.mesh.jacobian(cell, at);
                QuadraturePoint { x, weight: w * small::determinant(&jacobian).abs() }
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
        self.neighbours.clone()
    }
    fn boundary_sides(&self) -> Vec<BoundarySide> {
        self.sides.iter().map(|(side, _)| *side).collect()
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
            let farthest = (0..3)
                .max_by(|&a, &b| distance(&vertices[a]).total_cmp(&distance(&vertices[b])))
                .unwrap_or(0);
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
                let edges =
                    Matrix::<2>::new(b[0] - a[0], apex[0] - a[0], b[1] - a[1], apex[1] - a[1]);
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
        let (x, jacobian) = self.square.at(s);
        jacobian.transpose() * self.sheet.gradient(&x)
    }
}
