//! Shapes as atlases of smooth charts, and the tree of cells on which closest points are bounded.
//!
//! Every curve and surface becomes a list of [`Piece`]s, each a [`Chart`] on `[-1, 1]^M` with bounds on its second and
//! third derivatives. A [`Cell`] is a box of parameters of one piece together with its Taylor expansion and the largest
//! error of that expansion in the box; all bounds of the closest-point search are made from cells. The upper part of
//! the tree is built once per shape; a search adds what it needs below.

pub mod bernstein;
pub mod chart;
pub mod weights;

use crate::{Point, Vector};
pub use chart::{Bounds, Chart, CurveChart, Jet3, PointChart, SurfaceChart};

/// What lies behind one side of a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The next piece, with a continuous tangent and the same parameter lines.
    Smooth,
    /// The next piece, smooth as a shape but with other parameter lines.
    Inner,
    /// The next piece at an angle: an edge of the shape, or a vertex of a curve; the number counts them.
    Crease(u32),
    /// The boundary of the shape.
    Boundary(Border),
    /// A boundary of the parameters that is one smooth interior point of the shape.
    Pole,
    /// A boundary of the parameters that is a single point of the shape, a vertex.
    Collapsed(Border),
}

impl Side {
    /// Whether a minimiser may lie on this side without being a minimiser of the smooth continuation.
    pub fn is_smooth(self) -> bool {
        self == Side::Smooth
    }
}

/// Sides of the parameter domain of a shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Border {
    Start,
    End,
    U0,
    U1,
    V0,
    V1,
    /// The side `xi + eta = 1` of a triangle.
    Diagonal,
}

/// How the local parameters of a piece give those of the shape.
#[derive(Clone, Debug)]
pub enum ParameterMap<const M: usize> {
    /// In each direction from `low` at `s = -1` to `high` at `s = 1`, with `ratio` times the weight at the end
    /// ([`weights`]); affine where the ratio is one.
    Projective { low: [f64; M], high: [f64; M], ratio: [f64; M] },
    /// Corners at `(-1,-1), (1,-1), (1,1), (-1,1)`: quadrilateral parts of a triangle.
    Bilinear([[f64; M]; 4]),
}

impl<const M: usize> ParameterMap<M> {
    pub fn apply(&self, s: &[f64; M]) -> [f64; M] {
        match self {
            ParameterMap::Projective { low, high, ratio } => std::array::from_fn(|k| {
                // Exact at both ends.
                if s[k] == 1.0 {
                    high[k]
                } else if s[k] == -1.0 {
                    low[k]
                } else {
                    // Rounding must not lead out of the domain.
                    let (p, q) = (1.0 - s[k], ratio[k] * (1.0 + s[k]));
                    let value = (low[k] * p + high[k] * q) / (p + q);
                    value.clamp(low[k].min(high[k]), low[k].max(high[k]))
                }
            }),
            ParameterMap::Bilinear(corners) => {
                let (s, t) = (s[0], s[M - 1]);
                let weights = [
                    0.25 * (1.0 - s) * (1.0 - t),
                    0.25 * (1.0 + s) * (1.0 - t),
                    0.25 * (1.0 + s) * (1.0 + t),
                    0.25 * (1.0 - s) * (1.0 + t),
                ];
                std::array::from_fn(|k| (0..4).map(|i| weights[i] * corners[i][k]).sum())
            }
        }
    }
}

/// One direction of a projective map.
#[derive(Clone, Copy, Debug)]
pub struct Interval {
    pub from: f64,
    pub to: f64,
    pub ratio: f64,
}

impl Interval {
    /// The local parameter in `[-1, 1]`.
    pub fn local(&self, t: f64) -> f64 {
        let (p, q) = (t - self.from, self.ratio * (self.to - t));
        (p - q) / (p + q)
    }

    /// The first three derivatives of the local parameter.
    pub fn derivatives(&self, t: f64) -> [f64; 3] {
        let Interval { from, to, ratio } = *self;
        let d = (t - from) + ratio * (to - t);
        let bend = (1.0 - ratio) / d;
        let first = 2.0 * ratio * (to - from) / (d * d);
        [first, -2.0 * bend * first, 6.0 * bend * bend * first]
    }
}

impl<const M: usize> ParameterMap<M> {
    /// One direction of the map; triangles, whose directions depend on each other, have none.
    pub fn interval(&self, k: usize) -> Interval {
        match self {
            ParameterMap::Projective { low, high, ratio } => Interval { from: low[k], to: high[k], ratio: ratio[k] },
            ParameterMap::Bilinear(_) => unreachable!("the parameters of triangles are not mapped one by one"),
        }
    }
}

/// A chart with its place in the shape.
#[derive(Clone, Debug)]
pub struct Piece<const M: usize, C> {
    pub chart: C,
    pub map: ParameterMap<M>,
    /// Low and high side of each direction.
    pub sides: [[Side; 2]; M],
}

impl<const M: usize, C: Chart<M>> Piece<M, C> {
    pub fn new(chart: C, map: ParameterMap<M>, sides: [[Side; 2]; M]) -> Self {
        Piece { chart, map, sides }
    }
}

/// The piece number of cells that gather several pieces.
pub const GROUP: u32 = u32::MAX;

/// A box of parameters of one piece, or a group of pieces, with all that bounding needs.
///
/// With `t` in `[-1, 1]^M` the local coordinate of the cell, `x(t) = x + Σ j t + ½ Σ dd t t + R`, `|R| ≤ rho3`, and
/// `|x(t) - x - Σ j t| ≤ rho2`.
#[derive(Clone, Debug)]
#[repr(C)]
pub struct Cell<const M: usize> {
    /// A box that holds the cell, low and high corner; in the tree it is gathered from the leaves. It comes first, with
    /// what else is read of every cell that is looked at.
    pub hull: [Point<3>; 2],
    pub piece: u32,
    /// Numbers of the two halves; zero where the cell has not been split.
    pub children: [u32; 2],
    pub middle: [f64; M],
    pub half: [f64; M],
    pub x: Point<3>,
    pub j: [Vector<3>; M],
    pub dd: [[Vector<3>; M]; M],
    /// Lengths of `j` and `dd`.
    pub j_norm: [f64; M],
    pub dd_norm: [[f64; M]; M],
    /// `j_a · dd_bc`.
    pub j_dd: [[[f64; M]; M]; M],
    /// How far `j` moves over the cell.
    pub sigma: [f64; M],
    /// How far `j` moves beyond its linear expansion.
    pub eta: [f64; M],
    /// How far `dd` moves over the cell.
    pub tau: [[f64; M]; M],
    pub rho2: f64,
    pub rho3: f64,
    /// Unit normal at the middle of a surface cell, else zero.
    pub normal: Vector<3>,
}

impl<const M: usize> Cell<M> {
    fn new<C: Chart<M>>(number: u32, piece: &Piece<M, C>, middle: [f64; M], half: [f64; M]) -> Self {
        let jet = piece.chart.jet(&middle);
        let Bounds { hull, second, third } = &piece.chart.bounds(&middle, &half);
        let mut cell = Cell {
            piece: number,
            children: [0; 2],
            middle,
            half,
            x: jet.x,
            j: jet.d,
            dd: jet.dd,
            j_norm: [0.0; M],
            dd_norm: [[0.0; M]; M],
            j_dd: [[[0.0; M]; M]; M],
            sigma: [0.0; M],
            eta: [0.0; M],
            tau: [[0.0; M]; M],
            rho2: 0.0,
            rho3: 0.0,
            normal: Vector::<3>::zeros(),
            hull: [jet.x; 2],
        };
        if M == 2 {
            cell.normal = jet.d[0].cross(&jet.d[1]).try_normalize(0.0).unwrap_or_default();
        }
        for a in 0..M {
            cell.j[a] *= half[a];
            cell.j_norm[a] = cell.j[a].norm();
            for b in 0..M {
                let area = half[a] * half[b];
                cell.dd[a][b] *= area;
                cell.dd_norm[a][b] = if b < a { cell.dd_norm[b][a] } else { cell.dd[a][b].norm() };
                let mut tau = 0.0;
                for c in 0..M {
                    tau += third[a][b][c] * half[c];
                }
                let tau = tau * area;
                cell.tau[a][b] = tau;
                cell.eta[a] += 0.5 * tau;
                cell.sigma[a] += (second[a][b] * area).min(cell.dd_norm[a][b] + tau);
                cell.rho3 += tau / 6.0;
            }
            cell.rho2 += 0.5 * cell.sigma[a];
        }
        let mut extent = Vector::<3>::repeat(cell.rho2);
        for j in &cell.j {
            extent += j.abs();
        }
        // Rounding must not turn the box inside out.
        let low = (cell.x - extent).sup(&hull[0]);
        cell.hull = [low, (cell.x + extent).inf(&hull[1]).sup(&low)];
        for a in 0..M {
            for b in 0..M {
                for c in 0..M {
                    cell.j_dd[a][b][c] = cell.j[a].dot(&cell.dd[b][c]);
                }
            }
        }
        cell
    }

    fn group(hull: [Point<3>; 2], radius: f64) -> Self {
        Cell {
            piece: GROUP,
            children: [0; 2],
            middle: [0.0; M],
            half: [0.0; M],
            x: (hull[0] + hull[1]) * 0.5,
            j: [Vector::<3>::zeros(); M],
            dd: [[Vector::<3>::zeros(); M]; M],
            j_norm: [0.0; M],
            dd_norm: [[0.0; M]; M],
            j_dd: [[[0.0; M]; M]; M],
            sigma: [0.0; M],
            eta: [0.0; M],
            tau: [[0.0; M]; M],
            rho2: radius,
            rho3: radius,
            normal: Vector::<3>::zeros(),
            hull,
        }
    }

    pub fn is_group(&self) -> bool {
        self.piece == GROUP
    }

    /// No point of the cell is farther from `x` than this.
    pub fn radius(&self) -> f64 {
        self.j_norm.iter().sum::<f64>() + self.rho2
    }

    /// The direction in which halving helps most: long, or strongly curved.
    fn axis(&self) -> usize {
        let weight = |a: usize| self.j_norm[a] + 2.0 * self.sigma[a];
        (1..M).fold(0, |best, a| if weight(a) > weight(best) { a } else { best })
    }

    /// The parameter box, low and high.
    pub fn range(&self, a: usize) -> [f64; 2] {
        // Faces of the piece are hit exactly.
        [(self.middle[a] - self.half[a]).max(-1.0), (self.middle[a] + self.half[a]).min(1.0)]
    }
}

/// A shape as pieces and the tree over them; node 0 is the root.
#[derive(Clone, Debug)]
pub struct Atlas<const M: usize, C> {
    pub pieces: Vec<Piece<M, C>>,
    pub nodes: Vec<Cell<M>>,
    /// Size of the shape and its largest coordinate, to scale tolerances.
    pub size: f64,
    pub magnitude: f64,
}

/// Cells of a piece that are built with the shape; a search refines further where it must.
const CELLS_PER_PIECE: usize = 127;
/// Cells flatter than this share of their size are left to the search.
const FLATNESS: f64 = 0.06;

impl<const M: usize, C: Chart<M>> Atlas<M, C> {
    pub fn new(pieces: Vec<Piece<M, C>>) -> Self {
        let mut nodes: Vec<Cell<M>> = Vec::new();
        let roots: Vec<Cell<M>> =
            pieces.iter().enumerate().map(|(n, p)| Cell::new(n as u32, p, [0.0; M], [1.0; M])).collect();
        let (low, high) = extent(&roots);
        let size = (high - low).norm();
        let magnitude = low.amax().max(high.amax());
        let mut order: Vec<u32> = (0..pieces.len() as u32).collect();
        let mut places = vec![0u32; pieces.len()];
        nodes.reserve(2 * pieces.len());
        gather(&mut order, &roots, &mut nodes, &mut places);
        let mut atlas = Atlas { pieces, nodes, size, magnitude };
        for &place in &places {
            atlas.refine(place);
        }
        atlas.gather_hulls();
        atlas
    }

    fn refine(&mut self, root: u32) {
        let mut queue = std::collections::VecDeque::from([root]);
        let mut count = 1;
        while let Some(node) = queue.pop_front() {
            let cell = &self.nodes[node as usize];
            if M == 0 || count + 2 > CELLS_PER_PIECE || cell.rho2 <= FLATNESS * (cell.radius() - cell.rho2) {
                continue;
            }
            let halves = self.halve(cell);
            let first = self.nodes.len() as u32;
            self.nodes[node as usize].children = [first, first + 1];
            self.nodes.extend(halves);
            queue.extend([first, first + 1]);
            count += 2;
        }
    }

    /// Boxes from the leaves upwards: those of large cells are far too wide. Children come after their parents.
    fn gather_hulls(&mut self) {
        for k in (0..self.nodes.len()).rev() {
            let [left, right] = self.nodes[k].children;
            if left == 0 {
                continue;
            }
            let [p, q] = [left, right].map(|c| self.nodes[c as usize].hull);
            let node = &mut self.nodes[k];
            node.hull = [p[0].inf(&q[0]), p[1].sup(&q[1])];
            if node.is_group() {
                node.x = (node.hull[0] + node.hull[1]) * 0.5;
                let radius = 0.5 * (node.hull[1] - node.hull[0]).norm();
                (node.rho2, node.rho3) = (radius, radius);
            }
        }
        let [low, high] = self.nodes[0].hull;
        self.size = (high - low).norm();
        self.magnitude = low.amax().max(high.amax());
    }

    /// The cell over any box of parameters of a piece.
    pub fn cell(&self, piece: u32, middle: [f64; M], half: [f64; M]) -> Cell<M> {
        Cell::new(piece, &self.pieces[piece as usize], middle, half)
    }

    /// The two halves of a cell of one piece.
    pub fn halve(&self, cell: &Cell<M>) -> [Cell<M>; 2] {
        let axis = cell.axis();
        let piece = &self.pieces[cell.piece as usize];
        [-0.5, 0.5].map(|side| {
            let (mut middle, mut half) = (cell.middle, cell.half);
            middle[axis] += side * half[axis];
            half[axis] *= 0.5;
            Cell::new(cell.piece, piece, middle, half)
        })
    }

    /// The cell pressed onto its low or high side in one direction.
    pub fn face(&self, cell: &Cell<M>, axis: usize, high: bool) -> Cell<M> {
        let (mut middle, mut half) = (cell.middle, cell.half);
        middle[axis] = cell.range(axis)[usize::from(high)];
        half[axis] = 0.0;
        Cell::new(cell.piece, &self.pieces[cell.piece as usize], middle, half)
    }
}

fn extent<const M: usize>(cells: &[Cell<M>]) -> (Point<3>, Point<3>) {
    let mut low = Point::<3>::repeat(f64::INFINITY);
    let mut high = -low;
    for cell in cells {
        (low, high) = (low.inf(&cell.hull[0]), high.sup(&cell.hull[1]));
    }
    (low, high)
}

/// Builds the groups over the roots of the pieces by halving at the median; returns the number of the node.
fn gather<const M: usize>(order: &mut [u32], roots: &[Cell<M>], nodes: &mut Vec<Cell<M>>, places: &mut [u32]) -> u32 {
    let number = nodes.len() as u32;
    if let [piece] = order {
        nodes.push(roots[*piece as usize].clone());
        places[*piece as usize] = number;
        return number;
    }
    let cells: Vec<Cell<M>> = order.iter().map(|&p| roots[p as usize].clone()).collect();
    let (low, high) = extent(&cells);
    let middle = (low + high) * 0.5;
    let radius = cells.iter().map(|c| (c.x - middle).norm() + c.radius()).fold(0.0, f64::max);
    nodes.push(Cell::group([low, high], radius.min(0.5 * (high - low).norm())));
    let axis = (high - low).imax();
    order.sort_by(|&a, &b| {
        let key = |p: u32| roots[p as usize].x[axis];
        key(a).total_cmp(&key(b)).then(a.cmp(&b))
    });
    let (left, right) = order.split_at_mut(order.len() / 2);
    let first = gather(left, roots, nodes, places);
    let second = gather(right, roots, nodes, places);
    nodes[number as usize].children = [first, second];
    number
}
