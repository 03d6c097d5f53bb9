//! Stiffness of cells, and the stress in them.
//!
//! `K = ∫ λ div u div v + 2μ ε(u):ε(v)`. On cells of degree one, and where the material hardly compresses, the
//! divergence is replaced by its projection on polynomials of one degree less, discontinuous from cell to cell (for
//! bilinear cells the mean dilatation of Nagtegaal, Parks & Rice 1974, for degree 2 the pair Q2/P1): the pressure has no
//! more unknowns than the displacement can follow, and nothing locks. Triangles and tetrahedra of degree one cannot be
//! helped in this way.

use crate::material::{Elastic, Space};
use nalgebra::{DMatrix, Matrix3};
use signorini_fem::hierarchic::{HierarchicBasis, Values};
use signorini_fem::rules::rule;
use signorini_fem::small::{determinant, inverse};
use signorini_fem::{CellShape, DofMap, Local, Mesh};
use signorini_geometry::Point;

/// Poisson's ratio from which the divergence is projected on cells of any degree.
const NEARLY_INCOMPRESSIBLE: f64 = 0.4;

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
        let n = basis.degree() + 1 + usize::from(map.order() > 1);
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

/// Whether the divergence is projected on a cell.
pub fn projects(basis: &HierarchicBasis, material: &Elastic, space: Space) -> bool {
    if space == Space::PlaneStress {
        return false;
    }
    let nearly = material.poissons_ratio > NEARLY_INCOMPRESSIBLE;
    if basis.shape().is_tensor() { basis.degree() == 1 || nearly } else { basis.degree() > 1 && nearly }
}

/// Stiffness matrix of a cell, row-major over (function, component), functions in the order and sign of the basis.
pub(crate) fn stiffness<const D: usize>(
    mesh: &Mesh<D>,
    cell: usize,
    table: &Table,
    basis: &HierarchicBasis,
    material: &Elastic,
    space: Space,
) -> DMatrix<f64> {
    let n = basis.len();
    let count = table.points.len();
    let (lambda, mu) = material.lame(space);
    // Gradients, and the hoop strain per radial displacement, at all points.
    let mut gradients = vec![DMatrix::<f64>::zeros(n, count); D];
    let mut hoop = DMatrix::<f64>::zeros(if space == Space::Axisymmetric { n } else { 0 }, count);
    let mut weights = vec![0.0; count];
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
            weights[q] *= std::f64::consts::TAU * x[0];
            for (a, value) in table.basis[q].value.iter().enumerate() {
                hoop[(a, q)] = value / x[0];
            }
        }
    }
    let scaled = |m: &DMatrix<f64>| {
        let mut m = m.clone();
        for (q, mut column) in m.column_iter_mut().enumerate() {
            column *= weights[q];
        }
        m
    };
    let mut stiffness = DMatrix::<f64>::zeros(n * D, n * D);
    let weighted: Vec<DMatrix<f64>> = gradients.iter().map(scaled).collect();
    let mut trace = DMatrix::<f64>::zeros(n, n);
    for i in 0..D {
        for j in 0..D {
            let product = &weighted[i] * gradients[j].transpose();
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
        let product = scaled(&hoop) * hoop.transpose();
        for a in 0..n {
            for b in 0..n {
                stiffness[(a * D, b * D)] += 2.0 * mu * product[(a, b)];
            }
        }
    }
    // Divergence of each unknown at the points.
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
    let weighted = scaled(&divergence);
    if projects(basis, material, space) {
        let psi = pressures::<D>(basis, table);
        let mass = scaled(&psi) * psi.transpose();
        let moments = &weighted * psi.transpose();
        if let Some(factor) = mass.cholesky() {
            let half = factor.l().solve_lower_triangular(&moments.transpose()).unwrap_or_default();
            stiffness += half.transpose() * half * lambda;
            return stiffness;
        }
    }
    stiffness += weighted * divergence.transpose() * lambda;
    stiffness
}

/// Polynomials on which the divergence is projected, at the quadrature points.
fn pressures<const D: usize>(basis: &HierarchicBasis, table: &Table) -> DMatrix<f64> {
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
        let x = table.points[q].0;
        (0..D).map(|k| x[k].powi(exponents[r][k] as i32)).product()
    })
}

/// Displacement, its gradient in space and the position at a point of a cell, from the unknowns of the body.
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
    for ((f, sign), (value, slope)) in dofs.cell(cell).iter().zip(basis.value.iter().zip(&basis.gradient)) {
        for i in 0..D {
            let unknown = sign * u[*f as usize * D + i];
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
