//! A smooth surface near the vertices of a triangle mesh, for paths that need curvatures.
//!
//! At vertices a cubic height over the tangent plane is fitted to the vertices around (`fit`); its zero level is `f_i`. The
//! surface is `Σ w_i f_i / Σ w_i = 0` with weights `(1 - |x - v_i|²/r_i²)⁴` of the radius `r_i` of the fit (a partition of
//! unity: Ohtake et al., Multi-level partition of unity implicits, 2003; jets: Cazals & Pouget, Estimating differential
//! quantities using polynomial fitting of osculating jets, 2005). For vertices on a surface its normals converge with order
//! three and its curvatures with order two of the edges. Of vertices with noise fits are so wide that bias and noise of the
//! curvatures balance (`radius`): for edges `h` and noise `σ` the radius is as `(σ h)^(1/5)`, and the error as `(σ h)^(2/5)`.

mod fit;
mod radius;

use crate::surface::foot;
use fit::{CUBIC, NARROWEST, Vertices, cubic};
use radius::choose;
use signorini_geometry::mesh::TriangleMesh;
use signorini_geometry::rigid_shape::{ClosestPoints, GapJet, Normals, RigidShape};
use signorini_geometry::shape::ShapeError;
use signorini_geometry::{Jet, Matrix, Point, Real, Vector};
use std::collections::{BTreeSet, HashMap};

/// A fitted height over a plane.
#[derive(Clone, Copy, Debug)]
struct Patch {
    origin: Point<3>,
    /// Two unit vectors in the plane, and outward.
    frame: [Vector<3>; 3],
    radius: f64,
    coefficients: [f64; CUBIC],
}

/// A closed triangle mesh as a smooth body.
#[derive(Clone, Debug)]
pub struct SmoothMesh {
    patches: Vec<Patch>,
    /// Root mean squares: of the scatter of the vertices, of the normal curvature, and of its error.
    noise: f64,
    curvature: [f64; 2],
    /// Mean of the longest edge at a vertex, and the radius of fits in such edges.
    edge: f64,
    fit_radius: f64,
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
        let vertices = Vertices { at: vertices, around };
        let none = |vertex: usize| {
            ShapeError::new("mesh", format!("no smooth surface through vertex {vertex} and its neighbours"))
        };
        let fits = choose(&vertices, &normals).map_err(none)?;
        let mut patches = Vec::new();
        let centres = centres(&vertices, fits.wider);
        for &k in &centres {
            let (around, fit) = cubic(&vertices, k, &normals[k], fits.wider).ok_or_else(|| none(k))?;
            let coefficients = std::array::from_fn(|c| fit.coefficients.get(c).copied().unwrap_or(0.0));
            patches.push(Patch { origin: around.origin, frame: around.frame, radius: around.radius, coefficients });
        }
        let edge = centres.iter().map(|k| vertices.edge(*k)).sum::<f64>() / centres.len() as f64;
        let cell = patches.iter().map(|p| p.radius).fold(0.0, f64::max);
        let mut grid: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
        for (k, patch) in patches.iter().enumerate() {
            grid.entry(place(&patch.origin, cell)).or_default().push(k as u32);
        }
        let triangles = ClosestPoints { shape: mesh.clone().into(), normals: Normals::Outward };
        Ok(SmoothMesh {
            patches,
            noise: fits.noise,
            curvature: [fits.curvature, fits.error],
            edge,
            fit_radius: NARROWEST * fits.wider,
            grid,
            cell,
            triangles,
        })
    }

    /// How far vertices scatter about a smooth surface, as a root mean square: the noise of a scan, and on a clean mesh what
    /// the best of several fits leaves.
    pub fn scatter(&self) -> f64 {
        self.noise
    }

    /// The normal curvature and its error, of bias and noise, as root mean squares over the surface and all directions.
    pub fn curvature(&self) -> [f64; 2] {
        self.curvature
    }

    /// Mean length of the longest edge at a vertex.
    pub fn edge(&self) -> f64 {
        self.edge
    }

    /// Radius of the fits in these edges.
    pub fn fit_radius(&self) -> f64 {
        self.fit_radius
    }
}

/// Vertices about which to fit: all for the narrowest fits, and fewer for wider ones, so that as many of them overlap. What is
/// left out is so near to one with longer edges that this covers its triangles too.
fn centres(vertices: &Vertices<'_>, wider: f64) -> Vec<usize> {
    let used: Vec<usize> = (0..vertices.at.len()).filter(|k| !vertices.around[*k].is_empty()).collect();
    if wider <= 1.0 {
        return used;
    }
    let mut order: Vec<(usize, f64)> = used.iter().map(|k| (*k, (wider - 1.0) * vertices.edge(*k))).collect();
    order.sort_by(|a, b| b.1.total_cmp(&a.1));
    let cell = order[0].1;
    let mut grid: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
    for (k, apart) in order {
        let x = vertices.at[k];
        let is_near = |other: &usize| (vertices.at[*other] - x).norm() < apart;
        if !cells(&x, cell).any(|c| grid.get(&c).is_some_and(|list| list.iter().any(is_near))) {
            grid.entry(place(&x, cell)).or_default().push(k);
        }
    }
    let mut found: Vec<usize> = grid.into_values().flatten().collect();
    found.sort_unstable();
    found
}

/// The cell of a point with those around it.
fn cells(x: &Point<3>, cell: f64) -> impl Iterator<Item = [i64; 3]> {
    let [i, j, k] = place(x, cell);
    (0..27).map(move |c| [i + c / 9 - 1, j + c / 3 % 3 - 1, k + c % 3 - 1])
}

fn place(x: &Point<3>, cell: f64) -> [i64; 3] {
    [0, 1, 2].map(|k| (x[k] / cell).floor() as i64)
}

impl Patch {
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
        let height = c(k[0])
            + u * (c(k[1]) + u * (c(k[3]) + u * k[6] + v * k[7]) + v * k[4])
            + v * (c(k[2]) + v * (c(k[5]) + v * k[9] + u * k[8]));
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
        let (mut weights, mut sum) = (Jet::<3>::constant(0.0), Jet::<3>::constant(0.0));
        for cell in cells(x, self.cell) {
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
