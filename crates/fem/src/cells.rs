//! What a membrane is computed on: cells with functions, of which a boundary or a front may cut any.

pub use crate::boundary_side::BoundarySide;
use crate::cut::{CellPartition, CellRule, QuadraturePoint, cut_cell};
use crate::grid::Grid;
use crate::lagrange::{MAX_DEGREE, Tabulation};
use crate::mesh_cells::MeshCells;
use crate::reference::CellShape;
use signorini_geometry::{Aabb, Point, Vector};
use std::sync::Arc;

/// Cells along the longer side of the coarsest grid.
const COARSEST: usize = 8;

/// Two cells that share a side, or part of one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbours {
    pub cells: [usize; 2],
    /// Extent of the cells across the side.
    pub width: f64,
    /// Pairs of one kind differ in their place only.
    pub kind: Option<usize>,
}

/// A point of a side.
#[derive(Clone, Copy, Debug)]
pub struct SidePoint<const D: usize> {
    pub x: Point<D>,
    /// Derivative of the position along the side.
    pub tangent: Vector<D>,
    /// Unit normal, out of the cell.
    pub normal: Vector<D>,
}

/// Cells and the continuous functions on them.
///
/// Functions are known by position, also beyond their cell, where their polynomial goes on.
pub trait Cells<const D: usize>: Send + Sync {
    fn degree(&self) -> usize;
    fn count(&self) -> usize;
    /// The smallest box round a cell.
    fn bounds_of(&self, cell: usize) -> Aabb<D>;
    /// The least extent of a cell.
    fn size(&self, cell: usize) -> f64;
    fn volume(&self, cell: usize) -> f64;
    /// The cell that contains a point; where cells fill a box, the nearest one for a point outside.
    fn containing(&self, x: &Point<D>) -> Option<usize>;
    /// Whether the functions add up to one, as those of Lagrange do.
    fn sum_to_one(&self) -> bool {
        true
    }
    /// Number of functions.
    fn function_count(&self) -> usize;
    /// The functions that do not vanish in a cell, in the order of [`Cells::tabulate`].
    fn functions(&self, cell: usize, out: &mut Vec<u32>);
    fn tabulate(&self, cell: usize, x: &Point<D>, out: &mut Tabulation<D>);
    /// What the functions of a cell are beyond it, and whether they are the same within.
    fn extension<'a>(&'a self, cell: usize) -> Extension<'a, D> {
        own_extension(self, cell)
    }
    /// The sides of a cell between two corners, as places among its functions of degree 1.
    fn edges(&self, _cell: usize) -> &'static [[usize; 2]] {
        match D {
            1 => CellShape::Line.edges(),
            // Functions of a grid come row by row.
            _ => &[[0, 1], [2, 3], [0, 2], [1, 3]],
        }
    }
    /// The node of a function of degree 1.
    fn node(&self, function: usize) -> Point<D>;
    /// The same cells, each divided into `finer` ones in each direction where that is easy, with functions of degree 1.
    fn linear(&self, finer: usize) -> Arc<dyn Cells<D>>;
    /// The mesh, where the cells are those of one.
    fn mesh(self: Arc<Self>) -> Option<Arc<MeshCells>> {
        None
    }
    /// The outlines of the set where a function is negative that is linear between their corners, with that set on their
    /// left; none where the cells do not tell, or the set reaches beyond them.
    fn outlines(&self, _value: &dyn Fn(&Point<D>) -> f64) -> Option<Vec<Vec<Point<D>>>> {
        None
    }
    /// The grid whose cells these are, or are parts of.
    fn as_grid(&self) -> Option<&Grid<D>> {
        None
    }
    /// How often a cell was divided.
    fn divisions(&self, _cell: usize) -> usize {
        0
    }
    /// The same cells with functions of one degree more, where there are such.
    fn raised(&self) -> Option<Arc<dyn Cells<D>>>;
    /// Twice as many cells in each direction, with functions of the same degree, where a mesh is divided.
    fn halved(self: Arc<Self>) -> Option<Arc<dyn Cells<D>>> {
        None
    }
    /// Half as many cells in each direction, with functions of degree 1.
    fn coarser(&self) -> Option<Arc<dyn Cells<D>>>;
    /// Quadrature of a cell that is not cut.
    fn rule(&self, cell: usize) -> Vec<QuadraturePoint<D>>;
    /// Calls `visit` with every point of that quadrature and the functions there.
    fn for_each_point(&self, cell: usize, visit: &mut dyn FnMut(&QuadraturePoint<D>, &Tabulation<D>)) {
        let mut t = Tabulation::default();
        for p in self.rule(cell) {
            self.tabulate(cell, &p.x, &mut t);
            visit(&p, &t);
        }
    }
    /// Quadrature of a cell that is divided.
    fn cut(&self, cell: usize, partition: &CellPartition<'_, D>, order: usize) -> CellRule<D>;
    /// Cells of one kind differ in their place only.
    fn kind(&self, cell: usize) -> Option<usize>;
    /// One cell of each kind.
    fn kinds(&self) -> Vec<usize>;
    /// All pairs of neighbours.
    fn neighbours(&self) -> Vec<Neighbours>;
    /// Quadrature of what the polynomials of two neighbours are compared over, each point with the number of its cell in
    /// the pair: both cells, or as much of a larger one as reaches as far as the smaller.
    fn compared_over(&self, pair: &Neighbours) -> Vec<(usize, QuadraturePoint<D>)> {
        let of = |i: usize| self.rule(pair.cells[i]).into_iter().map(move |p| (i, p));
        of(0).chain(of(1)).collect()
    }
    /// Sides on the boundary of a domain that the cells fit.
    fn boundary_sides(&self) -> Vec<BoundarySide>;
    /// A point of a side, for `t` from 0 to 1.
    fn on_side(&self, side: &BoundarySide, t: f64) -> SidePoint<D>;
    /// A cell divided for display into `n` parts along each side.
    fn divided(&self, cell: usize, n: usize) -> Divided<D>;
}

/// Cells that know what is beside each of them: of these a part can be taken.
pub trait CellByCell<const D: usize>: Cells<D> {
    /// Appends the pairs that a cell forms with neighbours of greater number.
    fn neighbours_of(&self, cell: usize, out: &mut Vec<Neighbours>);
    /// Appends the sides of a cell that lie on the boundary of a domain that the cells fit.
    fn sides_of(&self, cell: usize, out: &mut Vec<BoundarySide>);
}

/// The functions of a cell where they go on beyond it by themselves.
pub(crate) fn own_extension<'a, const D: usize, C: Cells<D> + ?Sized>(cells: &'a C, cell: usize) -> Extension<'a, D> {
    let mut t = Tabulation::default();
    let values = move |x: &Point<D>, out: &mut Vec<f64>| {
        cells.tabulate(cell, x, &mut t);
        out.clone_from(&t.value);
    };
    Extension { values: Box::new(values), is_own: true }
}

/// The functions of a cell, carried on beyond it.
pub struct Extension<'a, const D: usize> {
    /// Writes the values of all functions at a point.
    pub values: Box<dyn FnMut(&Point<D>, &mut Vec<f64>) + 'a>,
    /// Whether these are the functions themselves; otherwise polynomials close to them.
    pub is_own: bool,
}

/// Points, and segments, triangles or quadrilaterals between them.
#[derive(Clone, Debug, Default)]
pub struct Divided<const D: usize> {
    pub points: Vec<Point<D>>,
    pub parts: Vec<Vec<usize>>,
}

impl<const D: usize> Grid<D> {
    /// The grid as cells of any kind, compiled here.
    #[inline(never)]
    pub fn as_cells(&self) -> Arc<dyn Cells<D>> {
        Arc::new(self.clone())
    }
}

/// Grids in one dimension and two as cells, by address: to name them is to compile them here.
pub fn of_grids() -> [*const (); 2] {
    [Grid::<1>::as_cells as *const (), Grid::<2>::as_cells as *const ()]
}

impl<const D: usize> Cells<D> for Grid<D> {
    fn degree(&self) -> usize {
        Grid::degree(self)
    }
    fn count(&self) -> usize {
        self.cell_count()
    }
    fn bounds_of(&self, cell: usize) -> Aabb<D> {
        self.cell_box(cell)
    }
    fn size(&self, _: usize) -> f64 {
        self.h()
    }
    fn volume(&self, _: usize) -> f64 {
        self.cell_size().iter().product()
    }
    fn containing(&self, x: &Point<D>) -> Option<usize> {
        Some(self.cell_containing(x))
    }
    fn function_count(&self) -> usize {
        self.node_count()
    }
    fn functions(&self, cell: usize, out: &mut Vec<u32>) {
        self.cell_nodes(cell, out);
    }
    fn tabulate(&self, cell: usize, x: &Point<D>, out: &mut Tabulation<D>) {
        self.basis().tabulate(&self.local(cell, x), &self.cell_size(), out);
    }
    fn node(&self, function: usize) -> Point<D> {
        Grid::node(self, function)
    }
    fn linear(&self, finer: usize) -> Arc<dyn Cells<D>> {
        Arc::new(Grid::new(*self.bounds(), self.cells().map(|n| n * finer), 1))
    }
    fn as_grid(&self) -> Option<&Grid<D>> {
        Some(self)
    }
    fn raised(&self) -> Option<Arc<dyn Cells<D>>> {
        let degree = Grid::degree(self) + 1;
        (degree <= MAX_DEGREE)
            .then(|| -> Arc<dyn Cells<D>> { Arc::new(Grid::new(*self.bounds(), self.cells(), degree)) })
    }
    fn coarser(&self) -> Option<Arc<dyn Cells<D>>> {
        let cells = self.cells();
        let enough = cells.iter().all(|n| n % 2 == 0) && cells.iter().any(|&n| n / 2 >= COARSEST);
        enough.then(|| -> Arc<dyn Cells<D>> { Arc::new(Grid::new(*self.bounds(), cells.map(|n| n / 2), 1)) })
    }
    fn rule(&self, cell: usize) -> Vec<QuadraturePoint<D>> {
        self.rule_in(&self.cell_box(cell))
    }
    fn cut(&self, cell: usize, partition: &CellPartition<'_, D>, order: usize) -> CellRule<D> {
        cut_cell(partition, &self.cell_box(cell), order)
    }
    fn kind(&self, _: usize) -> Option<usize> {
        Some(0)
    }
    fn kinds(&self) -> Vec<usize> {
        vec![0]
    }
    fn neighbours(&self) -> Vec<Neighbours> {
        let mut out = Vec::with_capacity(D * self.cell_count());
        (0..self.cell_count()).for_each(|cell| self.neighbours_of(cell, &mut out));
        out
    }
    fn boundary_sides(&self) -> Vec<BoundarySide> {
        let mut out = Vec::new();
        (0..self.cell_count()).for_each(|cell| self.sides_of(cell, &mut out));
        out
    }
    fn on_side(&self, side: &BoundarySide, t: f64) -> SidePoint<D> {
        on_box_side(&self.cell_box(side.cell), side.side, t)
    }
    fn divided(&self, cell: usize, n: usize) -> Divided<D> {
        divided_box(&self.cell_box(cell), n)
    }
}

impl<const D: usize> CellByCell<D> for Grid<D> {
    fn neighbours_of(&self, cell: usize, out: &mut Vec<Neighbours>) {
        let size = self.cell_size();
        let across = |k: usize| {
            let upper = self.upper_neighbour(cell, k)?;
            Some(Neighbours { cells: [cell, upper], width: size[k], kind: Some(k) })
        };
        out.extend((0..D).filter_map(across));
    }
    fn sides_of(&self, cell: usize, out: &mut Vec<BoundarySide>) {
        let (index, cells) = (self.cell_index(cell), self.cells());
        let outer = |side: &usize| index[side / 2] == if side % 2 == 1 { cells[side / 2] - 1 } else { 0 };
        out.extend((0..2 * D).filter(outer).map(|side| BoundarySide { cell, side, piece: side }));
    }
}

/// A box divided evenly.
pub(crate) fn divided_box<const D: usize>(b: &Aabb<D>, n: usize) -> Divided<D> {
    let points = (0..(n + 1).pow(D as u32))
        .map(|i| b.at(&Point::from_fn(|k, _| (i / (n + 1).pow(k as u32) % (n + 1)) as f64 / n as f64)));
    let parts = match D {
        1 => (0..n).map(|i| vec![i, i + 1]).collect(),
        _ => quadrilaterals(n),
    };
    Divided { points: points.collect(), parts }
}

/// The quadrilaterals between the points of a square lattice.
pub(crate) fn quadrilaterals(n: usize) -> Vec<Vec<usize>> {
    let corner = |i: usize| i / n * (n + 1) + i % n;
    (0..n * n).map(|i| [0, 1, n + 2, n + 1].map(|o| corner(i) + o).to_vec()).collect()
}

/// A point of a side of a box: lower and upper in each direction.
pub(crate) fn on_box_side<const D: usize>(b: &Aabb<D>, side: usize, t: f64) -> SidePoint<D> {
    let (k, upper) = (side / 2, side % 2 == 1);
    let mut normal = Vector::zeros();
    normal[k] = if upper { 1.0 } else { -1.0 };
    let mut x = b.min;
    x[k] = if upper { b.max[k] } else { b.min[k] };
    let mut tangent = Vector::zeros();
    if D > 1 {
        let along = 1 - k;
        tangent[along] = b.size()[along];
        x[along] += t * tangent[along];
    }
    SidePoint { x, tangent, normal }
}
