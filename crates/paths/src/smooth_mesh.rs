//! A smooth surface near the vertices of a triangle mesh, for paths that need curvatures.
//!
//! At every vertex a cubic height over its tangent plane is fitted to the rings of vertices around it, twice, the second time
//! over the plane of the first; its zero level is `f_i`. The surface is `Σ w_i f_i / Σ w_i = 0` with weights
//! `(1 - |x - v_i|²/ρ_i²)⁴` of radius `ρ_i` (a partition of unity: Ohtake et al., Multi-level partition of unity implicits,
//! 2003; jets: Cazals & Pouget, Estimating differential quantities using polynomial fitting of osculating jets, 2005). For
//! vertices on a surface its normals converge with order three and its curvatures with order two of the edges.

use crate::surface::foot;
use signorini_geometry::mesh::TriangleMesh;
use signorini_geometry::rigid_shape::{ClosestPoints, GapJet, Normals, RigidShape};
use signorini_geometry::shape::ShapeError;
use signorini_geometry::{Jet, Matrix, Point, Real, Vector};
use std::collections::{BTreeSet, HashMap};

/// Radius of the weights in edges of a vertex: every point of a triangle lies well inside that of each of its corners.
const RADIUS: f64 = 2.5;
/// Neighbours of a fit: twice its unknowns.
const NEIGHBOURS: usize = 18;
/// Coefficients of `u, v, u², uv, v², u³, u²v, uv², v³`.
const CUBIC: usize = 9;
/// Of the first five of them.
const QUADRATIC: usize = 5;

/// A fitted height over a plane.
#[derive(Clone, Copy, Debug)]
struct Patch {
    origin: Point<3>,
    /// Two unit vectors in the plane, and outward.
    frame: [Vector<3>; 3],
    radius: f64,
    coefficients: [f64; CUBIC],
    /// Mean square of what the fit leaves of its neighbours.
    left: f64,
}

/// A closed triangle mesh as a smooth body.
#[derive(Clone, Debug)]
pub struct SmoothMesh {
    patches: Vec<Patch>,
    grid: HashMap<[i64; 3], Vec<u32>>,
    cell: f64,
    /// Far from the surface the triangles themselves are as good.
    triangles: ClosestPoints,
}

impl SmoothMesh {
    /// # Errors
    /// A mesh that bounds no body; a vertex without enough neighbours for a fit.
    pub fn new(mesh: &TriangleMesh) -> Result<Self, ShapeError> {
        if !mesh.quality().has_inside() {
            return Err(ShapeError::new("mesh", "it is not closed, or its triangles do not agree about the outside"));
        }
        let vertices = mesh.vertices();
        let mut around: Vec<BTreeSet<u32>> = vec![BTreeSet::new(); vertices.len()];
        let mut normals = vec![Vector::<3>::zeros(); vertices.len()];
        for t in mesh.triangles() {
            let [a, b, c] = t.map(|v| vertices[v as usize]);
            let area = (b - a).cross(&(c - a));
            for k in 0..3 {
                let (here, next, last) = (t[k] as usize, t[(k + 1) % 3], t[(k + 2) % 3]);
                around[here].extend([next, last]);
                let (p, q) = (vertices[next as usize] - vertices[here], vertices[last as usize] - vertices[here]);
                // Exact for vertices on a sphere (Max 1999).
                normals[here] += area / (p.norm_squared() * q.norm_squared()).max(f64::MIN_POSITIVE);
            }
        }
        let mut patches = Vec::with_capacity(vertices.len());
        for (k, x) in vertices.iter().enumerate().filter(|(k, _)| !around[*k].is_empty()) {
            let edge = around[k].iter().map(|v| (vertices[*v as usize] - x).norm()).fold(0.0, f64::max);
            let points: Vec<Point<3>> = rings(&around, k).into_iter().map(|v| vertices[v as usize]).collect();
            let fitted = Patch::fit(x, &normals[k], RADIUS * edge, &points)
                .and_then(|first| Patch::fit(x, &first.normal(), RADIUS * edge, &points));
            let Some(patch) = fitted else {
                return Err(ShapeError::new(
                    "mesh",
                    format!("no smooth surface through vertex {k} and its neighbours"),
                ));
            };
            patches.push(patch);
        }
        let cell = patches.iter().map(|p| p.radius).fold(0.0, f64::max);
        let mut grid: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
        for (k, patch) in patches.iter().enumerate() {
            grid.entry(place(&patch.origin, cell)).or_default().push(k as u32);
        }
        let triangles = ClosestPoints { shape: mesh.clone().into(), normals: Normals::Outward };
        Ok(SmoothMesh { patches, grid, cell, triangles })
    }

    /// How far vertices scatter about the fits to their neighbours, as a root mean square: the noise of a scan, and on a clean
    /// mesh what cubics leave of the surface.
    pub fn scatter(&self) -> f64 {
        (self.patches.iter().map(|p| p.left).sum::<f64>() / self.patches.len() as f64).sqrt()
    }

    /// Mean length of the longest edge at a vertex.
    pub fn edge(&self) -> f64 {
        self.patches.iter().map(|p| p.radius).sum::<f64>() / (RADIUS * self.patches.len() as f64)
    }
}

/// The vertices of the fewest rings that are enough for a fit.
fn rings(around: &[BTreeSet<u32>], vertex: usize) -> BTreeSet<u32> {
    let mut found = around[vertex].clone();
    while found.len() < NEIGHBOURS {
        let wider: BTreeSet<u32> =
            found.iter().flat_map(|v| around[*v as usize].iter().copied()).chain(found.iter().copied()).collect();
        if wider.len() == found.len() {
            break;
        }
        found = wider;
    }
    found.remove(&(vertex as u32));
    found
}

fn place(x: &Point<3>, cell: f64) -> [i64; 3] {
    [0, 1, 2].map(|k| (x[k] / cell).floor() as i64)
}

impl Patch {
    /// The height through a point, over the plane of a normal, that fits others best; with weights that fall off with the
    /// distance. Where there are few it is of degree two. `None` where there are too few for that.
    fn fit(origin: &Point<3>, normal: &Vector<3>, radius: f64, points: &[Point<3>]) -> Option<Self> {
        let n = normal.try_normalize(0.0)?;
        let mut across = Vector::<3>::zeros();
        across[n.iamin()] = 1.0;
        let e1 = (across - n * n.dot(&across)).normalize();
        let frame = [e1, n.cross(&e1), n];
        let unknowns = if points.len() > CUBIC { CUBIC } else { QUADRATIC };
        let mut matrix = nalgebra::DMatrix::<f64>::zeros(unknowns, unknowns);
        let mut rhs = nalgebra::DVector::<f64>::zeros(unknowns);
        for p in points {
            let d = (p - origin) / radius;
            let [u, v, w] = frame.map(|e| e.dot(&d));
            let row = [u, v, u * u, u * v, v * v, u * u * u, u * u * v, u * v * v, v * v * v];
            let weight = (-d.norm_squared()).exp();
            for i in 0..unknowns {
                rhs[i] += weight * row[i] * w;
                for j in 0..unknowns {
                    matrix[(i, j)] += weight * row[i] * row[j];
                }
            }
        }
        let solution = matrix.cholesky()?.solve(&rhs);
        let coefficients = std::array::from_fn(|k| if k < unknowns { solution[k] } else { 0.0 });
        let mut patch = Patch { origin: *origin, frame, radius, coefficients, left: 0.0 };
        // A mean that is left is the scatter of the vertex itself. Points beyond those that determine the fit tell it.
        let left: Vec<f64> = points.iter().map(|p| patch.height_above(p)).collect();
        let mean = left.iter().sum::<f64>() / left.len() as f64;
        let square: f64 = left.iter().map(|l| (l - mean).powi(2)).sum();
        patch.left = square / points.len().saturating_sub(unknowns + 1).max(1) as f64;
        Some(patch)
    }

    /// The normal at the vertex.
    fn normal(&self) -> Vector<3> {
        let [e1, e2, n] = &self.frame;
        n - e1 * self.coefficients[0] - e2 * self.coefficients[1]
    }

    /// How far a point lies above the fit.
    fn height_above(&self, p: &Point<3>) -> f64 {
        let [u, v, w] = self.frame.map(|e| e.dot(&((p - self.origin) / self.radius)));
        let row = [u, v, u * u, u * v, v * v, u * u * u, u * u * v, u * v * v, v * v * v];
        (w - self.coefficients.iter().zip(row).map(|(c, r)| c * r).sum::<f64>()) * self.radius
    }

    /// The weight and the level at a point; `None` out of reach.
    fn at(&self, x: &Point<3>) -> Option<[Jet<3>; 2]> {
        let d = (x - self.origin) / self.radius;
        let square = d.norm_squared();
        if square >= 1.0 {
            return None;
        }
        let c = Jet::<3>::constant;
        let scale = 1.0 / self.radius;
        let linear = |e: &Vector<3>| Jet { value: e.dot(&d), gradient: e * scale, hessian: Matrix::<3>::zeros() };
        let [u, v, w] = [0, 1, 2].map(|k| linear(&self.frame[k]));
        let k = &self.coefficients;
        let height = u * (c(k[0]) + u * (c(k[2]) + u * k[5] + v * k[6]) + v * k[3])
            + v * (c(k[1]) + v * (c(k[4]) + v * k[8] + u * k[7]));
        let inside = Jet {
            value: 1.0 - square,
            gradient: d * (-2.0 * scale),
            hessian: Matrix::<3>::identity() * (-2.0 * scale * scale),
        };
        let half = inside * inside;
        Some([half * half, (w - height) * self.radius])
    }
}

impl RigidShape for SmoothMesh {
    fn gap(&self, x: &Point<3>) -> GapJet<3> {
        if self.smooth_level(x).is_none() {
            return self.triangles.gap(x);
        }
        let Ok((y, level)) = foot(self, x) else { return self.triangles.gap(x) };
        let length = level.gradient.norm();
        let normal = level.gradient / length;
        let p = Matrix::<3>::identity() - normal * normal.transpose();
        let shape = p * level.hessian * p / length;
        let gap = (x - y).dot(&normal);
        // Far from the surface the foot may be another than the nearest one.
        if gap.abs() > 0.5 * self.cell {
            let by_triangles = self.triangles.gap(x);
            if (by_triangles.gap - gap).abs() > 0.5 * self.cell {
                return by_triangles;
            }
        }
        let hessian = (Matrix::<3>::identity() + shape * gap).try_inverse().map_or(shape, |inverse| shape * inverse);
        GapJet { gap, normal, hessian: (hessian + hessian.transpose()) * 0.5 }
    }

    fn level(&self, x: &Point<3>) -> Jet<3> {
        self.smooth_level(x).unwrap_or_else(|| {
            let GapJet { gap, normal, hessian } = self.triangles.gap(x);
            Jet { value: gap, gradient: normal, hessian }
        })
    }

    /// The origin: a mesh says no other.
    fn centre(&self) -> Point<3> {
        Point::<3>::zeros()
    }
}

impl SmoothMesh {
    /// The blended level; none beyond the reach of all patches.
    fn smooth_level(&self, x: &Point<3>) -> Option<Jet<3>> {
        let [i, j, k] = place(x, self.cell);
        let (mut weights, mut sum) = (Jet::<3>::constant(0.0), Jet::<3>::constant(0.0));
        for cell in (0..27).map(|c| [i + c / 9 - 1, j + c / 3 % 3 - 1, k + c % 3 - 1]) {
            for &patch in self.grid.get(&cell).into_iter().flatten() {
                if let Some([weight, level]) = self.patches[patch as usize].at(x) {
                    weights = weights + weight;
                    sum = sum + weight * level;
                }
            }
        }
        (weights.value > 1e-6).then(|| sum / weights)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wrapping::{Anchor, Body, Route, Station, Wrapping};

    /// A cube blown up to an ellipsoid, each side divided into `n` by `n`.
    fn blown_up(n: usize, axes: [f64; 3]) -> TriangleMesh {
        let mut numbers: HashMap<[i64; 3], u32> = HashMap::new();
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        let m = n as i64;
        for side in 0..6 {
            let (axis, sign) = (side / 2, if side % 2 == 0 { 1 } else { -1 });
            let mut number = |i: i64, j: i64| {
                let mut x = [0; 3];
                (x[axis], x[(axis + 1) % 3], x[(axis + 2) % 3]) = (sign * m, 2 * i - m, 2 * j - m);
                *numbers.entry(x).or_insert_with(|| {
                    let way = Vector::<3>::from(x.map(|v| v as f64)).normalize();
                    vertices.push(way.component_mul(&Vector::<3>::from(axes)));
                    vertices.len() as u32 - 1
                })
            };
            for i in 0..m {
                for j in 0..m {
                    let [a, b, c, d] = [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)];
                    let two = if sign > 0 { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] };
                    triangles.extend(two);
                }
            }
        }
        TriangleMesh::new(vertices, &triangles).unwrap()
    }

    #[test]
    fn derivatives_of_the_level() {
        let mesh = SmoothMesh::new(&blown_up(6, [2.0, 1.5, 1.0])).unwrap();
        let x = Point::<3>::new(1.1, 0.7, 0.72);
        let at = mesh.level(&x);
        for k in 0..3 {
            let mut step = Vector::<3>::zeros();
            step[k] = 1e-5;
            let [up, down] = [mesh.level(&(x + step)), mesh.level(&(x - step))];
            assert!(((up.value - down.value) / 2e-5 - at.gradient[k]).abs() < 1e-8);
            assert!(((up.gradient - down.gradient) / 2e-5 - at.hessian.column(k)).norm() < 1e-6);
        }
        let found = mesh.gap(&Point::<3>::new(3.0, 0.0, 0.0));
        assert!((found.gap - 1.0).abs() < 0.02 && (found.normal.x - 1.0).abs() < 1e-2, "{found:?}");
    }

    /// The scatter is that of the vertices, and tends to zero with the edges on a clean mesh.
    #[test]
    fn the_noise_of_a_mesh_is_told() {
        let mut seed = 1u64;
        // Uniform, of unit variance.
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((seed >> 33) as f64 / (1u64 << 31) as f64 - 0.5) * 12.0f64.sqrt()
        };
        let clean = blown_up(16, [2.0, 1.5, 1.0]);
        let noisy: Vec<Point<3>> = clean.vertices().iter().map(|x| x + x.normalize() * (1e-2 * random())).collect();
        let noisy = SmoothMesh::new(&TriangleMesh::new(noisy, clean.triangles()).unwrap()).unwrap();
        let clean = SmoothMesh::new(&clean).unwrap();
        assert!((noisy.scatter() - 1e-2).abs() < 2e-3, "{}", noisy.scatter());
        let coarse = SmoothMesh::new(&blown_up(8, [2.0, 1.5, 1.0])).unwrap();
        assert!(clean.scatter() < 0.2 * coarse.scatter() && clean.scatter() < 1e-3, "{}", clean.scatter());
        assert!((clean.edge() / 0.2 - 1.0).abs() < 0.5, "{}", clean.edge());
    }

    /// The shortest path over the mesh of an ellipsoid tends to that over the ellipsoid.
    #[test]
    fn paths_over_meshes_converge() {
        let errors = [8, 16].map(|n| {
            let mesh = SmoothMesh::new(&blown_up(n, [2.0, 1.5, 1.0])).unwrap();
            let route = Route {
                start: Anchor::fixed(Point::<3>::new(-3.0, 0.5, 0.3)),
                stations: vec![Station::Around { body: 0, turns: 0 }],
                end: Anchor::fixed(Point::<3>::new(2.2, 1.6, -0.9)),
            };
            let path = Wrapping::new(route).solve(&[Body::fixed(&mesh)]).unwrap();
            (path.length - 5.488_014_095_081).abs()
        });
        assert!(errors[1] < 2e-4 && errors[0] > 4.0 * errors[1], "{errors:?}");
        let open =
            TriangleMesh::new(vec![Point::<3>::zeros(), Vector::<3>::x(), Vector::<3>::y()], &[[0, 1, 2]]).unwrap();
        assert!(SmoothMesh::new(&open).is_err());
    }
}
