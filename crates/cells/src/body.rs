//! A body of finite cells: cells with functions, unknowns, and the quadrature of the material in them.
//!
//! The stiffness is `∫_B α ε(u):C:ε(v)`, `α = 1` in the material and `α_0` in the rest of the cells (Parvizian, Düster &
//! Rank, Comput. Mech. 41, 2007). Cells without material are left out. Unknown `D f + k` is component `k` of function `f`.

use crate::cell::{Cell, Findings, Site};
use crate::check::check;
use crate::components::{PieceGraph, faces_itself, is_narrow};
use crate::discretisation::{Boundary, CellMaterial, Discretisation};
use crate::error::CellsError;
use crate::kept_pieces::{kept_pieces, rules_of_pieces};
use crate::memory::check_memory;
use crate::moments::{VolumePoints, box_points};
use crate::region::{BoundaryPoint, Filling, Integration, Region};
use crate::rules::rules_of;
use crate::space::{Mode, Tabulation, tabulate};
use crate::tree::CellTree;
use signorini_geometry::{Aabb, Point};
use signorini_material::{Elastic, Space};
use std::sync::Arc;

/// A body of finite cells.
#[derive(Clone)]
pub struct CellBody<const D: usize> {
    pub(crate) region: Arc<dyn Region<D>>,
    pub(crate) tree: CellTree<D>,
    pub(crate) discretisation: Discretisation<D>,
    pub(crate) material: CellMaterial<D>,
    pub(crate) cells: Vec<Cell<D>>,
    /// Cells of each leaf.
    pub(crate) of_leaf: Vec<Vec<usize>>,
    /// Every function, and which of its copies.
    pub(crate) functions: Vec<(Mode<D>, usize)>,
    pub(crate) findings: Findings,
}

impl<const D: usize> CellBody<D> {
    /// Makes the cells of a body on a tree.
    ///
    /// # Errors
    /// Constants out of range; a shape that is not finite, nowhere negative or without a boundary; islands.
    pub fn new(
        region: Arc<dyn Region<D>>,
        mut tree: CellTree<D>,
        discretisation: Discretisation<D>,
        material: CellMaterial<D>,
    ) -> Result<Self, CellsError> {
        check(&*region, &tree, &discretisation, &material)?;
        let fits = discretisation.volume_points == VolumePoints::Fitted
            && material.modulus.is_none()
            && material.space != Space::Axisymmetric;
        let rule = |leaf: &crate::tree::Leaf<D>| {
            let mut rule = region.rule(&leaf.bounds, &discretisation.integration, discretisation.degree);
            // Points of cells in several pieces tell the pieces apart.
            if fits && !faces_itself(&rule) {
                rule.fit(&leaf.bounds, 2 * discretisation.degree + 1);
            }
            rule
        };
        let rules_of = |tree: &CellTree<D>| rules_of(tree, discretisation.processes.as_deref(), rule);
        let mut rules = rules_of(&tree);
        for _ in 0..discretisation.refine_narrow {
            let narrow: Vec<bool> = rules.iter().map(is_narrow).collect();
            let mut number = 0;
            let refined = tree.refine(|_| {
                number += 1;
                narrow[number - 1]
            })?;
            if refined == 0 {
                break;
            }
            check_memory(&*region, &tree, &discretisation)?;
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
        let mut rules = rules_of_pieces(&tree, &graph, rules);
        if fits {
            let alone = |piece: &usize| graph.leaves[graph.leaf_of(*piece)].count == 1;
            for piece in (0..rules.len()).filter(alone) {
                let b = tree.leaves()[graph.leaf_of(piece)].bounds;
                rules[piece].fit(&b, 2 * discretisation.degree + 1);
            }
        }
        let kept = kept_pieces(&tree, &graph, &rules, discretisation.islands, &mut findings)?;
        let mut body = CellBody {
            of_leaf: vec![Vec::new(); tree.leaves().len()],
            region,
            tree,
            discretisation,
            material,
            cells: Vec::new(),
            functions: Vec::new(),
            findings,
        };
        body.number(&graph, rules, &kept);
        Ok(body)
    }

    pub fn tree(&self) -> &CellTree<D> {
        &self.tree
    }

    pub fn degree(&self) -> usize {
        self.discretisation.degree
    }

    /// Gauss points along each direction of a smooth piece of a cut cell.
    pub fn points_along(&self) -> usize {
        let sub_cells = match self.discretisation.integration {
            Integration::SubCells { subdivision } => subdivision,
            _ => 1,
        };
        sub_cells * self.discretisation.integration.points(self.degree())
    }

    pub fn space(&self) -> Space {
        self.material.space
    }

    pub fn elastic(&self) -> &Elastic {
        self.material.elastic()
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
        self.nearest_of(self.tree.leaf_at(x), x)
    }

    /// Whether a point within the leaf of a cell belongs to it, and not to another piece of the material in that leaf.
    pub(crate) fn is_of_cell(&self, x: &Point<D>, cell: usize) -> bool {
        self.nearest_of(self.cells[cell].leaf, x) == Some(cell)
    }

    fn nearest_of(&self, leaf: usize, x: &Point<D>) -> Option<usize> {
        let cells = &self.of_leaf[leaf];
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
        if self.material.space == Space::Axisymmetric { std::f64::consts::TAU * x[0] } else { 1.0 }
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
        let varies = self.material.modulus.is_some() || self.material.space == Space::Axisymmetric;
        self.degree() + if varies { 3 } else { 1 }
    }
}
