//! A body of finite cells: cells with functions, unknowns, and the quadrature of the material in them.
//!
//! The stiffness is `∫_B α ε(u):C:ε(v)`, `α = 1` in the material and `α_0` in the rest of the cells (Parvizian, Düster &
//! Rank, Comput. Mech. 41, 2007). Cells without material are left out. Unknown `D f + k` is component `k` of function `f`.

use crate::components::{PieceGraph, Pieces, faces_itself, is_narrow};
use crate::error::CellsError;
use crate::legendre::MAX_DEGREE;
use crate::region::{BoundaryPoint, Filling, Integration, MaterialRule, Region};
use crate::space::{LocalMode, Mode, Products, Tabulation, modes_of, support, tabulate};
use crate::tree::CellTree;
use rayon::prelude::*;
use signorini_fem::elastic::{Elastic, Space};
use signorini_geometry::{Aabb, Point, Vector};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// A function of position.
pub type Field<const D: usize> = Arc<dyn Fn(&Point<D>) -> f64 + Send + Sync>;

/// What is done with pieces of the body that do not hang together with the largest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Islands {
    /// An error tells of them.
    Refuse,
    Drop,
    /// Each is held by supports or contact of its own.
    Keep,
}

/// Whether a body without a boundary in the box of its cells is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Boundary {
    Expected,
    /// The body may fill the whole box.
    Optional,
}

/// How a body is made of cells.
#[derive(Clone)]
pub struct Discretisation<const D: usize> {
    /// Degree of the functions, 1 to 8.
    pub degree: usize,
    pub products: Products,
    pub integration: Integration,
    /// Stiffness outside the material relative to that inside; the error in the energy norm is about `0.1 √α`.
    pub fictitious: f64,
    pub pieces: Pieces,
    pub islands: Islands,
    pub boundary: Boundary,
    /// Times that cells are halved in which the boundary faces itself or turns by more than half a radian: where a pore or a
    /// gap is narrower than a cell, around tips, and at edges.
    pub refine_narrow: usize,
}

impl<const D: usize> Discretisation<D> {
    /// The defaults for a degree.
    pub fn of_degree(degree: usize) -> Self {
        Discretisation {
            degree,
            products: Products::Tensor,
            integration: Integration::Exact { points: None },
            fictitious: 1e-8,
            pieces: Pieces::Split,
            islands: Islands::Refuse,
            boundary: Boundary::Expected,
            refine_narrow: 0,
        }
    }
}

/// What the body is made of.
#[derive(Clone)]
pub struct Stuff<const D: usize> {
    pub elastic: Elastic,
    /// A factor of Young's modulus that varies in space, with its largest value.
    pub modulus: Option<(Field<D>, f64)>,
    pub space: Space,
}

/// A cell with material: a leaf, or one piece of the material in it.
#[derive(Clone, Debug)]
pub struct Cell<const D: usize> {
    /// Number of the leaf in the tree.
    pub leaf: usize,
    pub modes: Vec<LocalMode<D>>,
    /// Number of each of its functions in the body.
    pub functions: Vec<u32>,
    pub rule: MaterialRule<D>,
    /// Share of the material in the leaf.
    pub share: f64,
    /// The cell whose polynomials give the stress on the boundary in this one: itself, or a neighbour with more material
    /// where this one holds so little that its own stress is not controlled by its energy.
    pub stress_cell: usize,
}

/// A point of the recovered boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site<const D: usize> {
    /// Number of the cell.
    pub cell: usize,
    pub x: Point<D>,
    /// Length or area before the body deforms; around an axis, of the whole turn.
    pub weight: f64,
    /// Unit normal, out of the material.
    pub normal: Vector<D>,
}

/// What was found out about the body while it was made.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Findings {
    /// Cells in which the boundary faces itself: features as narrow as a cell.
    pub facing_cells: usize,
    /// Leaves whose material is in several pieces with unknowns of their own.
    pub split_leaves: usize,
    /// Functions that are copies of another one, for pieces of material that do not touch in its support.
    pub copies: usize,
    /// Volumes of pieces of the body that do not hang together, the largest first.
    pub parts: Vec<f64>,
    /// Volume of the pieces that were dropped.
    pub dropped: f64,
}

/// A body of finite cells.
#[derive(Clone)]
pub struct CellBody<const D: usize> {
    pub(crate) region: Arc<dyn Region<D>>,
    pub(crate) tree: CellTree<D>,
    pub(crate) discretisation: Discretisation<D>,
    pub(crate) stuff: Stuff<D>,
    pub(crate) cells: Vec<Cell<D>>,
    /// Cells of each leaf.
    of_leaf: Vec<Vec<usize>>,
    /// Every function, and which of its copies.
    functions: Vec<(Mode<D>, usize)>,
    findings: Findings,
}

/// Pieces of material, and for each of them the copy of a function that it sees, if any.
type PiecesOfSupport = (Vec<usize>, Vec<Option<usize>>);

/// Least share of material in a cell whose own polynomials give the stress on its boundary.
const OWN_STRESS: f64 = 0.3;

impl<const D: usize> CellBody<D> {
    /// Makes the cells of a body on a tree.
    ///
    /// # Errors
    /// Constants out of range; a shape that is not finite, nowhere negative or without a boundary; islands.
    pub fn new(
        region: Arc<dyn Region<D>>,
        mut tree: CellTree<D>,
        discretisation: Discretisation<D>,
        stuff: Stuff<D>,
    ) -> Result<Self, CellsError> {
        check(&*region, &tree, &discretisation, &stuff)?;
        let rules_of = |tree: &CellTree<D>| -> Vec<MaterialRule<D>> {
            let one = |leaf: &crate::tree::Leaf<D>| {
                region.rule(&leaf.bounds, &discretisation.integration, discretisation.degree)
            };
            tree.leaves().par_iter().map(one).collect()
        };
        let mut rules = rules_of(&tree);
        for _ in 0..discretisation.refine_narrow {
            let narrow: Vec<bool> = rules.iter().map(is_narrow).collect();
            let mut number = 0;
            let refined = tree.refine(|_| {
                number += 1;
                narrow[number - 1]
            });
            if refined == 0 {
                break;
            }
            rules = rules_of(&tree);
        }
        if rules.iter().all(|r| r.filling == Filling::Void) {
            return Err(CellsError::Nothing);
        }
        if discretisation.boundary == Boundary::Expected && rules.iter().all(|r| r.filling == Filling::Full) {
            return Err(CellsError::Everything);
        }
        let mut findings =
            Findings { facing_cells: rules.iter().filter(|r| faces_itself(r)).count(), ..Findings::default() };
        let graph = PieceGraph::new(&*region, &tree, &rules, discretisation.pieces);
        findings.split_leaves = graph.leaves.iter().filter(|l| l.count > 1).count();
        let rules = rules_of_pieces(&tree, &graph, rules);
        let kept = kept_pieces(&tree, &graph, &rules, discretisation.islands, &mut findings)?;
        let mut body = CellBody {
            of_leaf: vec![Vec::new(); tree.leaves().len()],
            region,
            tree,
            discretisation,
            stuff,
            cells: Vec::new(),
            functions: Vec::new(),
            findings,
        };
        body.number(&graph, rules, &kept);
        Ok(body)
    }

    /// Makes a cell of every piece that is kept, and numbers the functions in the order of the cells.
    fn number(&mut self, graph: &PieceGraph<D>, rules: Vec<MaterialRule<D>>, kept: &[bool]) {
        let mut numbers: BTreeMap<(Mode<D>, usize), u32> = BTreeMap::new();
        let mut seen: BTreeMap<Mode<D>, PiecesOfSupport> = BTreeMap::new();
        let mut cell_of_piece = vec![usize::MAX; kept.len()];
        let whole: Vec<f64> = self.tree.leaves().iter().map(|l| l.bounds.volume()).collect();
        for (piece, rule) in rules.into_iter().enumerate().filter(|(p, _)| kept[*p]) {
            let leaf = graph.leaf_of(piece);
            let modes = modes_of(
                &self.tree,
                &self.tree.leaves()[leaf],
                self.discretisation.degree,
                self.discretisation.products,
            );
            let modes: Vec<(LocalMode<D>, usize)> = (modes.into_iter())
                .filter_map(|m| Some((m, self.copy_of(graph, leaf, piece, &m, &mut seen)?)))
                .collect();
            let functions = (modes.iter())
                .map(|&(m, copy)| {
                    let next = numbers.len() as u32;
                    *numbers.entry((m.mode, copy)).or_insert_with(|| {
                        self.functions.push((m.mode, copy));
                        next
                    })
                })
                .collect();
            cell_of_piece[piece] = self.cells.len();
            self.of_leaf[leaf].push(self.cells.len());
            let share = rule.measure(whole[leaf]) / whole[leaf];
            let modes = modes.into_iter().map(|m| m.0).collect();
            self.cells.push(Cell { leaf, modes, functions, rule, share, stress_cell: self.cells.len() });
        }
        let distinct: BTreeSet<Mode<D>> = self.functions.iter().map(|f| f.0).collect();
        self.findings.copies = self.functions.len() - distinct.len();
        for piece in (0..kept.len()).filter(|p| kept[*p]) {
            let cell = cell_of_piece[piece];
            if self.cells[cell].share >= OWN_STRESS || self.cells[cell].rule.boundary.is_empty() {
                continue;
            }
            // The best of the neighbours, or else of their neighbours.
            let next = &graph.touching[piece];
            let farther: Vec<usize> = next.iter().flat_map(|p| graph.touching[*p].iter().copied()).collect();
            for ring in [next, &farther] {
                let best = ring
                    .iter()
                    .map(|p| cell_of_piece[*p])
                    .filter(|c| *c != usize::MAX)
                    .max_by(|a, b| self.cells[*a].share.total_cmp(&self.cells[*b].share).then(b.cmp(a)));
                if let Some(best) = best
                    && self.cells[best].share >= OWN_STRESS
                {
                    self.cells[cell].stress_cell = best;
                    break;
                }
            }
        }
    }

    /// Which copy of a function a piece of material sees; none where finer functions say all that it says.
    fn copy_of(
        &self,
        graph: &PieceGraph<D>,
        leaf: usize,
        piece: usize,
        m: &LocalMode<D>,
        seen: &mut BTreeMap<Mode<D>, PiecesOfSupport>,
    ) -> Option<usize> {
        if self.discretisation.pieces == Pieces::Shared {
            return Some(0);
        }
        if m.factors.iter().all(|f| *f > 1) && m.mode.level == self.tree.leaves()[leaf].level {
            return Some(piece);
        }
        let (pieces, copies) = seen.entry(m.mode).or_insert_with(|| self.pieces_of_support(graph, leaf, m));
        pieces.iter().position(|p| *p == piece).and_then(|at| copies[at])
    }

    /// The pieces in the support of a function that is given on a leaf, and the copy that each of them sees.
    ///
    /// A copy on refined cells only, none of which touches a cell of its support that is not refined, is a sum of finer
    /// functions: those vanish nowhere but on sides of cells that are not refined.
    fn pieces_of_support(&self, graph: &PieceGraph<D>, leaf: usize, m: &LocalMode<D>) -> PiecesOfSupport {
        let leaf = &self.tree.leaves()[leaf];
        let cell = leaf.index.map(|i| i >> (leaf.level - m.mode.level));
        let mut pieces = Vec::new();
        let mut unrefined = Vec::new();
        for index in support(&self.tree, m.mode.level, &cell, &m.factors) {
            let b = self.tree.cell_box(m.mode.level, &index);
            if !self.tree.is_refined(m.mode.level, &index) {
                unrefined.push(b);
            }
            pieces.extend(self.leaves_in(&b).flat_map(|l| graph.start[l]..graph.start[l + 1]));
        }
        let copies = graph.connected(&pieces);
        let touches = |piece: &usize| {
            let own = self.tree.leaves()[graph.leaf_of(*piece)].bounds.scaled(1.0 + 1e-9);
            unrefined.iter().any(|b| (0..D).all(|k| own.min[k] <= b.max[k] && own.max[k] >= b.min[k]))
        };
        let needed: BTreeSet<usize> =
            pieces.iter().zip(&copies).filter(|(p, _)| touches(p)).map(|(_, copy)| *copy).collect();
        let copies = copies.into_iter().map(|c| needed.contains(&c).then_some(c)).collect();
        (pieces, copies)
    }

    /// The leaves within a cell of some level: they follow each other.
    fn leaves_in(&self, b: &Aabb<D>) -> impl Iterator<Item = usize> + '_ {
        let corner = b.at(&Point::repeat(1e-9));
        let (first, b) = (self.tree.leaf_at(&corner), *b);
        (first..self.tree.leaves().len()).take_while(move |l| b.contains(&self.tree.leaves()[*l].bounds.center()))
    }

    pub fn tree(&self) -> &CellTree<D> {
        &self.tree
    }

    pub fn degree(&self) -> usize {
        self.discretisation.degree
    }

    pub fn space(&self) -> Space {
        self.stuff.space
    }

    pub fn elastic(&self) -> &Elastic {
        &self.stuff.elastic
    }

    /// Cells with material.
    pub fn cells(&self) -> &[Cell<D>] {
        &self.cells
    }

    pub fn findings(&self) -> &Findings {
        &self.findings
    }

    /// Number of scalar functions.
    pub fn function_count(&self) -> usize {
        self.functions.len()
    }

    /// Number of unknowns: `D` for each function.
    pub fn unknowns(&self) -> usize {
        D * self.functions.len()
    }

    /// The function of level and numbers, and its copy.
    pub fn mode(&self, function: usize) -> &Mode<D> {
        &self.functions[function].0
    }

    /// The middle of the support of a function.
    pub fn position(&self, function: usize) -> Point<D> {
        let mode = self.mode(function);
        let xi = Point::from_fn(|k, _| {
            let n = self.tree.count(mode.level, k);
            let id = mode.ids[k];
            if id <= n { id as f64 / n as f64 } else { (((id - n - 1) / (self.degree() - 1)) as f64 + 0.5) / n as f64 }
        });
        self.tree.bounds().at(&xi)
    }

    /// Whether a function is the product of functions of vertices.
    pub fn is_vertex(&self, function: usize) -> bool {
        let mode = self.mode(function);
        (0..D).all(|k| mode.ids[k] <= self.tree.count(mode.level, k))
    }

    /// The box of a cell.
    pub fn bounds_of(&self, cell: usize) -> &Aabb<D> {
        &self.tree.leaves()[self.cells[cell].leaf].bounds
    }

    /// The functions of a cell at a point, in the order of [`Cell::functions`]; beyond the cell their polynomials go on.
    pub fn functions_at(&self, cell: usize, x: &Point<D>, out: &mut Tabulation<D>) {
        let cell = &self.cells[cell];
        tabulate(&self.tree, &self.tree.leaves()[cell.leaf], self.degree(), &cell.modes, x, out);
    }

    /// The cell that contains a point of the material: of several pieces in a leaf the one with the nearest
    /// quadrature point.
    pub fn cell_at(&self, x: &Point<D>) -> Option<usize> {
        if !self.tree.bounds().contains(x) {
            return None;
        }
        let cells = &self.of_leaf[self.tree.leaf_at(x)];
        if let [only] = cells[..] {
            return Some(only);
        }
        let distance = |c: &usize| {
            let rule = &self.cells[*c].rule;
            rule.volume.iter().map(|p| (p.x - x).norm_squared()).fold(f64::INFINITY, f64::min)
        };
        cells.iter().copied().min_by(|a, b| distance(a).total_cmp(&distance(b)))
    }

    /// The factor of quadrature weights: 1, or the circumference around an axis.
    pub fn turn(&self, x: &Point<D>) -> f64 {
        if self.stuff.space == Space::Axisymmetric { std::f64::consts::TAU * x[0] } else { 1.0 }
    }

    /// The points of the recovered boundary in a place.
    pub fn sites(&self, place: &dyn Fn(&BoundaryPoint<D>) -> bool) -> Vec<Site<D>> {
        let of_cell = |(number, cell): (usize, &Cell<D>)| {
            let points: Vec<Site<D>> = (cell.rule.boundary.iter())
                .filter(|p| place(p))
                .map(|p| Site { cell: number, x: p.x, weight: p.weight * self.turn(&p.x), normal: p.normal })
                .collect();
            points
        };
        self.cells.iter().enumerate().flat_map(of_cell).collect()
    }

    /// Volume of the material; around an axis, of the whole turn.
    pub fn volume(&self) -> f64 {
        let mut sum = 0.0;
        self.for_each_volume_point(|_, x, w| {
            let _ = x;
            sum += w;
        });
        sum
    }

    /// Calls `visit` with the cell, the position and the weight of all quadrature points of the material.
    pub fn for_each_volume_point(&self, mut visit: impl FnMut(usize, &Point<D>, f64)) {
        for (number, cell) in self.cells.iter().enumerate() {
            for (x, w) in self.volume_points(cell) {
                visit(number, &x, w * self.turn(&x));
            }
        }
    }

    /// The quadrature points of the material in a cell.
    pub(crate) fn volume_points(&self, cell: &Cell<D>) -> Vec<(Point<D>, f64)> {
        if cell.rule.filling == Filling::Full {
            box_points(&self.tree.leaves()[cell.leaf].bounds, self.full_points())
        } else {
            cell.rule.volume.iter().map(|p| (p.x, p.weight)).collect()
        }
    }

    /// Gauss points in each direction of a full cell: exact for the stiffness; with a modulus that varies, and around an
    /// axis where `1/r` is no polynomial, a few more.
    pub(crate) fn full_points(&self) -> usize {
        let varies = self.stuff.modulus.is_some() || self.stuff.space == Space::Axisymmetric;
        self.degree() + if varies { 3 } else { 1 }
    }
}

/// The tensor-product Gauss rule of a box.
pub(crate) fn box_points<const D: usize>(b: &Aabb<D>, order: usize) -> Vec<(Point<D>, f64)> {
    let gauss = signorini_geometry::rule::gauss_legendre(order);
    (0..order.pow(D as u32))
        .map(|mut i| {
            let mut weight = b.volume();
            let x = b.at(&Point::from_fn(|_, _| {
                let (t, w) = gauss[i % order];
                i /= order;
                weight *= w;
                t
            }));
            (x, weight)
        })
        .collect()
}

/// The points of a rule by piece, one rule a piece.
fn rules_of_pieces<const D: usize>(
    tree: &CellTree<D>,
    graph: &PieceGraph<D>,
    rules: Vec<MaterialRule<D>>,
) -> Vec<MaterialRule<D>> {
    let mut out = Vec::with_capacity(graph.touching.len());
    for (leaf, rule) in rules.into_iter().enumerate() {
        let pieces = &graph.leaves[leaf];
        if pieces.count == 1 {
            out.push(rule);
            continue;
        }
        let first = out.len();
        out.extend((0..pieces.count).map(|_| MaterialRule::empty(Filling::Cut)));
        // A surface point belongs to the material just below it.
        let depth = 0.02 * tree.leaves()[leaf].size();
        rule.volume.into_iter().for_each(|p| out[first + pieces.at(&p.x)].volume.push(p));
        for p in rule.boundary {
            out[first + pieces.at(&(p.x - p.normal * depth))].boundary.push(p);
        }
    }
    out
}

/// Which pieces are kept.
fn kept_pieces<const D: usize>(
    tree: &CellTree<D>,
    graph: &PieceGraph<D>,
    rules: &[MaterialRule<D>],
    islands: Islands,
    findings: &mut Findings,
) -> Result<Vec<bool>, CellsError> {
    let (part, count) = graph.parts();
    let mut volume = vec![0.0; count];
    let mut middle = vec![Point::<D>::zeros(); count];
    for (piece, rule) in rules.iter().enumerate() {
        let b = tree.leaves()[graph.leaf_of(piece)].bounds;
        let v = rule.measure(b.volume());
        volume[part[piece]] += v;
        middle[part[piece]] += b.center() * v;
    }
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|a, b| volume[*b].total_cmp(&volume[*a]).then(a.cmp(b)));
    findings.parts = order.iter().map(|p| volume[*p]).collect();
    // A piece of which no sample saw material holds none.
    let mut kept: Vec<bool> = rules.iter().map(|r| r.filling == Filling::Full || !r.volume.is_empty()).collect();
    if let [_, second, ..] = order[..] {
        match islands {
            Islands::Keep => {}
            Islands::Drop => {
                findings.dropped = findings.parts[1..].iter().sum();
                (0..kept.len()).for_each(|p| kept[p] &= part[p] == order[0]);
            }
            Islands::Refuse => {
                let at = (middle[second] / volume[second]).iter().copied().collect();
                return Err(CellsError::Islands { count: count - 1, volume: volume[second], at });
            }
        }
    }
    Ok(kept)
}

fn check<const D: usize>(
    region: &dyn Region<D>,
    tree: &CellTree<D>,
    discretisation: &Discretisation<D>,
    stuff: &Stuff<D>,
) -> Result<(), CellsError> {
    let degree = discretisation.degree;
    if !(1..=MAX_DEGREE).contains(&degree) {
        return Err(CellsError::Degree { degree, most: MAX_DEGREE });
    }
    if !(0.0..1.0).contains(&discretisation.fictitious) {
        return Err(CellsError::Fictitious { value: discretisation.fictitious });
    }
    let Elastic { youngs_modulus, poissons_ratio } = stuff.elastic;
    if !(youngs_modulus > 0.0 && youngs_modulus.is_finite()) {
        return Err(CellsError::Value { name: "youngs_modulus", value: youngs_modulus, must: "must be positive" });
    }
    if !(poissons_ratio > -1.0 && poissons_ratio < 0.5) {
        let must = "must lie between -1 and 0.5";
        return Err(CellsError::Value { name: "poissons_ratio", value: poissons_ratio, must });
    }
    if let Integration::SubCells { subdivision: 0 } = discretisation.integration {
        return Err(CellsError::Value { name: "subdivision", value: 0.0, must: "must be 1 or more" });
    }
    if stuff.space == Space::Axisymmetric && tree.bounds().min[0] < 0.0 {
        return Err(CellsError::NegativeRadius { radius: tree.bounds().min[0] });
    }
    for leaf in tree.leaves() {
        let b = &leaf.bounds;
        if let Some((x, value)) = [b.min, b.center(), b.max].iter().find_map(|x| Some((x, region.defect(x)?))) {
            return Err(CellsError::NotFinite { at: x.iter().copied().collect(), value });
        }
    }
    Ok(())
}
