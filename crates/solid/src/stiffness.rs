//! Stiffness of cells, and the stress in them.
//!
//! `K = ∫ λ div u div v + 2μ ε(u):ε(v)`. On cells of degree one, and where the material hardly compresses, the
//! divergence is replaced by its projection on polynomials of one degree less, discontinuous from cell to cell (for
//! bilinear cells the mean dilatation of Nagtegaal, Parks & Rice 1974, for degree 2 the pair Q2/P1): the pressure has no
//! more unknowns than the displacement can follow, and nothing locks. Splines of degree 2 and more have few functions for each
//! cell: there the polynomials are those of blocks of cells. Triangles and tetrahedra of degree one cannot be helped in this way.

use nalgebra::{DMatrix, Matrix3};
use signorini_fem::hierarchic::Values;
use signorini_fem::mesh::Window;
use signorini_fem::nurbs::macro_cells::macro_size;
use signorini_fem::rules::rule;
use signorini_fem::small::{determinant, inverse};
use signorini_fem::{CellBasis, CellShape, DofMap, Local, Mesh};
use signorini_geometry::Point;
use signorini_material::{Elastic, Space};

/// Poisson's ratio from which the divergence is projected on cells of any degree.
pub const NEARLY_INCOMPRESSIBLE: f64 = 0.4;

/// The place of a cell that is no part of a block.
pub(crate) const ALONE: Window = [[-1.0, 1.0]; 3];

/// Functions at the quadrature points of one shape of cells.
#[derive(Clone)]
pub(crate) struct Table {
    pub points: Vec<(Local, f64)>,
    pub map: Vec<Values>,
    pub basis: Vec<Values>,
}

impl Table {
    pub fn new<const D: usize>(mesh: &Mesh<D>, dofs: &DofMap, cell: usize) -> Self {
        let (map, basis) = (mesh.map(cell), dofs.basis(cell));
        // Straight cells are integrated exactly, or as well as is customary.
        let n = match map.rational() {
            Some(rational) if !rational.is_polynomial() => points_of_rational(mesh, cell),
            _ => basis.degree() + 1 + usize::from(map.order() > 1),
        };
        let points = rule(map.shape(), n);
        let tabulate = |f: &dyn Fn(&Local, &mut Values)| {
            (points.iter())
                .map(|(x, _)| {
                    let mut at = Values::default();
                    f(x, &mut at);
                    at
                })
                .collect()
        };
        let of_map = tabulate(&|x, at| map.tabulate(x, at));
        let of_basis = tabulate(&|x, at| basis.tabulate(x, at));
        Table { points, map: of_map, basis: of_basis }
    }
}

/// Error of the integrals of gradients, relative to their sum, that is none beside that of the functions.
const EXACT: f64 = 1e-10;
/// Points along each direction beyond the degree: with so many integrals are taken for exact, and fewer than that are used.
const MOST: usize = 6;

/// Points along each direction with which a constant stress on a span of a rational spline loads every function with the integral
/// of its gradient.
fn points_of_rational<const D: usize>(mesh: &Mesh<D>, cell: usize) -> usize {
    let map = mesh.map(cell);
    let mut at = Values::default();
    let mut integrals = |n: usize| {
        let mut out = vec![Point::<D>::zeros(); map.len()];
        for (x, w) in rule(map.shape(), n) {
            map.tabulate(&x, &mut at);
            let (_, jacobian) = mesh.jacobian(cell, &at);
            let weighted = inverse(&jacobian) * (w * determinant(&jacobian));
            for (sum, gradient) in out.iter_mut().zip(&at.gradient) {
                *sum += Point::<D>::from_fn(|i, _| (0..D).map(|k| gradient[k] * weighted[(k, i)]).sum());
            }
        }
        out
    };
    let exact = integrals(map.order() + MOST);
    let scale: f64 = exact.iter().map(|g| g.norm()).sum();
    let mut differs = |n: &usize| integrals(*n).iter().zip(&exact).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    (map.order() + 1..map.order() + MOST).find(|n| differs(n) <= EXACT * scale).unwrap_or(map.order() + MOST - 1)
}

/// Whether the divergence is projected: on each cell, or on the blocks of cells that smooth splines of degree 2 and more need.
///
/// A polynomial on a block of `m` cells has the error of cells `m` times as large, the pressure of splines by themselves `λ/μ` times
/// that of their cells. With errors of order `s` the projection is the better of the two beyond `λ/μ = m^s`: `s` is the degree
/// where the pressure is smooth, but below 2 at corners and at edges of contact, where the pressure would oscillate.
pub fn projects(basis: &CellBasis, material: &Elastic, space: Space) -> bool {
    if space == Space::PlaneStress {
        return false;
    }
    if basis.is_spline() && basis.degree() > 1 {
        let (lambda, mu) = material.lame(space);
        return lambda > mu * (macro_size(basis.degree()) as f64).powi(2);
    }
    let nearly = material.poissons_ratio > NEARLY_INCOMPRESSIBLE;
    if basis.shape().is_tensor() { basis.degree() == 1 || nearly } else { basis.degree() > 1 && nearly }
}

/// Derivatives of all functions at the quadrature points of a cell, in space.
struct Derivatives<const D: usize> {
    gradients: Vec<DMatrix<f64>>,
    /// Hoop strain per radial displacement, where there is one.
    hoop: DMatrix<f64>,
    /// Divergence of each unknown.
    divergence: DMatrix<f64>,
    weights: Vec<f64>,
    /// Mean of the squared radius over the square of the mean radius, over the section of the cell; 1 without an axis.
    spread: f64,
}

impl<const D: usize> Derivatives<D> {
    fn new(mesh: &Mesh<D>, cell: usize, table: &Table, basis: &CellBasis, space: Space) -> Self {
        let n = basis.len();
        let count = table.points.len();
        let mut gradients = vec![DMatrix::<f64>::zeros(n, count); D];
        let mut hoop = DMatrix::<f64>::zeros(if space == Space::Axisymmetric { n } else { 0 }, count);
        let mut weights = vec![0.0; count];
        // Area, and moments of the radius.
        let mut moments = [0.0; 3];
        for q in 0..count {
            let (x, jacobian) = mesh.jacobian(cell, &table.map[q]);
            weights[q] = table.points[q].1 * determinant(&jacobian);
            let inverse = inverse(&jacobian);
            for (a, gradient) in table.basis[q].gradient.iter().enumerate() {
                for i in 0..D {
                    gradients[i][(a, q)] = (0..D).map(|k| gradient[k] * inverse[(k, i)]).sum();
                }
            }
            if space == Space::Axisymmetric {
                (0..3).for_each(|k| moments[k] += weights[q] * x[0].powi(k as i32));
                weights[q] *= std::f64::consts::TAU * x[0];
                for (a, value) in table.basis[q].value.iter().enumerate() {
                    hoop[(a, q)] = value / x[0];
                }
            }
        }
        let mut divergence = DMatrix::<f64>::zeros(n * D, count);
        for q in 0..count {
            for a in 0..n {
                for i in 0..D {
                    divergence[(a * D + i, q)] = gradients[i][(a, q)];
                }
                if space == Space::Axisymmetric {
                    divergence[(a * D, q)] += hoop[(a, q)];
                }
            }
        }
        let spread = if space == Space::Axisymmetric { moments[0] * moments[2] / moments[1].powi(2) } else { 1.0 };
        Derivatives { gradients, hoop, divergence, weights, spread }
    }

    /// Columns times the weights of their points.
    fn weighted(&self, m: &DMatrix<f64>) -> DMatrix<f64> {
        let mut m = m.clone();
        for (q, mut column) in m.column_iter_mut().enumerate() {
            column *= self.weights[q];
        }
        m
    }
}

/// Stiffness matrix of a cell, row-major over (function, component), functions in the order and sign of the basis.
pub(crate) fn stiffness<const D: usize>(
    mesh: &Mesh<D>,
    cell: usize,
    table: &Table,
    basis: &CellBasis,
    material: &Elastic,
    space: Space,
) -> DMatrix<f64> {
    let n = basis.len();
    let (lambda, mu) = material.lame(space);
    let at = Derivatives::new(mesh, cell, table, basis, space);
    let mut stiffness = DMatrix::<f64>::zeros(n * D, n * D);
    let weighted: Vec<DMatrix<f64>> = at.gradients.iter().map(|m| at.weighted(m)).collect();
    let mut trace = DMatrix::<f64>::zeros(n, n);
    for i in 0..D {
        for j in 0..D {
            let product = &weighted[i] * at.gradients[j].transpose();
            if i == j {
                trace += &product;
            }
            // μ ∂_j u_i ∂_i v_j: rows of component j, columns of component i.
            for a in 0..n {
                for b in 0..n {
                    stiffness[(a * D + j, b * D + i)] += mu * product[(a, b)];
                }
            }
        }
    }
    for a in 0..n {
        for b in 0..n {
            for i in 0..D {
                stiffness[(a * D + i, b * D + i)] += mu * trace[(a, b)];
            }
        }
    }
    if space == Space::Axisymmetric {
        let product = at.weighted(&at.hoop) * at.hoop.transpose();
        for a in 0..n {
            for b in 0..n {
                stiffness[(a * D, b * D)] += 2.0 * mu * product[(a, b)];
            }
        }
        if basis.degree() == 1 {
            // Near the axis the radial slope of the axial displacement grows with the radius. Linear functions have its
            // mean: a constant weighted with r makes forces on the axis a quarter too small, and stresses there of first
            // order. With the mean of r² over the mean of r as weight all nodes balance quadratic fields exactly.
            let product = &weighted[0] * at.gradients[0].transpose();
            for a in 0..n {
                for b in 0..n {
                    stiffness[(a * D + 1, b * D + 1)] += (at.spread - 1.0) * mu * product[(a, b)];
                }
            }
        }
    }
    let weighted = at.weighted(&at.divergence);
    if projects(basis, material, space) {
        let psi = pressures::<D>(basis, table, &ALONE);
        let mass = at.weighted(&psi) * psi.transpose();
        let moments = &weighted * psi.transpose();
        if let Some(factor) = mass.cholesky() {
            let half = factor.l().solve_lower_triangular(&moments.transpose()).unwrap_or_default();
            stiffness += half.transpose() * half * lambda;
            return stiffness;
        }
    }
    stiffness += weighted * at.divergence.transpose() * lambda;
    stiffness
}

/// The traction `σ n` at a point of a cell by each of its unknowns, (function, component) in the order and sign of the basis;
/// with the divergence projected where the stiffness has it so.
pub(crate) fn traction<const D: usize>(
    mesh: &Mesh<D>,
    cell: usize,
    table: &Table,
    basis: &CellBasis,
    (material, space): (&Elastic, Space),
    (xi, normal): (&Local, &Point<D>),
) -> Vec<Point<D>> {
    let (lambda, mu) = material.lame(space);
    let n = basis.len();
    let mut here = Table { points: vec![(*xi, 1.0)], map: vec![Values::default()], basis: vec![Values::default()] };
    mesh.map(cell).tabulate(xi, &mut here.map[0]);
    basis.tabulate(xi, &mut here.basis[0]);
    let at = Derivatives::new(mesh, cell, &here, basis, space);
    let mut divergence: Vec<f64> = at.divergence.iter().copied().collect();
    if projects(basis, material, space) {
        let whole = Derivatives::new(mesh, cell, table, basis, space);
        let psi = pressures::<D>(basis, table, &ALONE);
        let mass = whole.weighted(&psi) * psi.transpose();
        let moments = whole.weighted(&whole.divergence) * psi.transpose();
        if let Some(factor) = mass.cholesky() {
            divergence = (moments * factor.solve(&pressures::<D>(basis, &here, &ALONE))).iter().copied().collect();
        }
    }
    let mut out = vec![Point::<D>::zeros(); n * D];
    for a in 0..n {
        let gradient = Point::<D>::from_fn(|i, _| at.gradients[i][(a, 0)]);
        for i in 0..D {
            // 2 ε n of the function along a component: `∇φ·n e_i + n_i ∇φ`.
            let traction = &mut out[a * D + i];
            *traction = gradient * (mu * normal[i]) + normal * (lambda * divergence[a * D + i]);
            traction[i] += mu * gradient.dot(normal);
        }
    }
    out
}

/// Polynomials on which the divergence is projected, at the points of a cell with a place in a block of cells.
pub(crate) fn pressures<const D: usize>(basis: &CellBasis, table: &Table, place: &Window) -> DMatrix<f64> {
    let most = if basis.shape().is_tensor() { basis.degree() - 1 } else { 0 };
    let mut exponents = Vec::new();
    for i in 0..=most {
        for j in 0..=most - i {
            for k in 0..=if D == 3 { most - i - j } else { 0 } {
                exponents.push([i, j, k]);
            }
        }
    }
    DMatrix::from_fn(exponents.len(), table.points.len(), |r, q| {
        let (x, _) = table.points[q];
        let within = |k: usize| 0.5 * (place[k][0] * (1.0 - x[k]) + place[k][1] * (1.0 + x[k]));
        (0..D).map(|k| within(k).powi(exponents[r][k] as i32)).product()
    })
}

/// Displacement, its gradient in space and the position at a point of a cell, from the unknowns of the body.
#[inline(never)]
pub fn displacement_at<const D: usize>(
    mesh: &Mesh<D>,
    dofs: &DofMap,
    space: Space,
    cell: usize,
    xi: &Local,
    u: &[f64],
) -> (Point<D>, Point<D>, Matrix3<f64>) {
    let (mut map, mut basis) = (Values::default(), Values::default());
    mesh.map(cell).tabulate(xi, &mut map);
    dofs.basis(cell).tabulate(xi, &mut basis);
    let (x, jacobian) = mesh.jacobian(cell, &map);
    let inverse = inverse(&jacobian);
    let mut displacement = Point::<D>::zeros();
    let mut gradient = Matrix3::zeros();
    for ((f, sign), (value, slope)) in dofs.cell(cell).zip(basis.value.iter().zip(&basis.gradient)) {
        for i in 0..D {
            let unknown = sign * u[f as usize * D + i];
            displacement[i] += unknown * value;
            for j in 0..D {
                let along: f64 = (0..D).map(|k| slope[k] * inverse[(k, j)]).sum();
                gradient[(i, j)] += unknown * along;
            }
        }
    }
    if space == Space::Axisymmetric {
        // On the axis the hoop strain is the radial one.
        gradient[(2, 2)] = if x[0] > 1e-12 { displacement[0] / x[0] } else { gradient[(0, 0)] };
    }
    (x, displacement, gradient)
}

/// Whether a shape and degree lock when the material hardly compresses.
pub fn locks(shape: CellShape, degree: usize, material: &Elastic) -> bool {
    !shape.is_tensor() && degree == 1 && material.poissons_ratio > NEARLY_INCOMPRESSIBLE
}
