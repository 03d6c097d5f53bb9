//! Heights over a plane, fitted to the vertices around one of them.
//!
//! With `(u, v, w)` the coordinates in the frame of a vertex, in units of the radius of the fit, the height is a polynomial
//! `p(u, v)`, found by least squares with weights `exp(-(u² + v² + w²))`. Its coefficients are linear in the heights `w`: what
//! noise makes of them is known.

use nalgebra::{DMatrix, DVector};
use signorini_geometry::{Point, Vector};
use std::collections::BTreeSet;

/// Coefficients of a polynomial of degree two, three and four.
pub(super) const QUADRATIC: usize = 6;
pub(super) const CUBIC: usize = 10;
pub(super) const QUARTIC: usize = 15;
/// Vertices of the narrowest fit besides its own: twice its unknowns.
const NEIGHBOURS: f64 = 18.0;
/// Radius of the narrowest fits in edges of a vertex: every point of a triangle lies well inside that of each of its corners.
pub(super) const NARROWEST: f64 = 2.5;

/// The vertices of a mesh, and which of them are joined by edges.
pub(super) struct Vertices<'a> {
    pub at: &'a [Point<3>],
    pub around: Vec<BTreeSet<u32>>,
}

impl Vertices<'_> {
    /// The longest edge at a vertex.
    pub fn edge(&self, vertex: usize) -> f64 {
        let x = self.at[vertex];
        self.around[vertex].iter().map(|v| (self.at[*v as usize] - x).norm()).fold(0.0, f64::max)
    }

    /// A vertex with the fewest rings around it that are enough for the narrowest fit, times the square of how much wider it is.
    fn near(&self, vertex: usize, wider: f64) -> Vec<u32> {
        let enough = NEIGHBOURS * wider * wider;
        let mut found = BTreeSet::from([vertex as u32]);
        let mut last = vec![vertex as u32];
        while !last.is_empty() && (found.len() as f64) <= enough {
            let next = last.iter().flat_map(|v| self.around[*v as usize].iter().copied());
            let ring: BTreeSet<u32> = next.filter(|v| !found.contains(v)).collect();
            last = ring.iter().copied().collect();
            found.extend(ring);
        }
        found.into_iter().collect()
    }
}

/// The frame over a normal: two unit vectors across it, and itself.
fn frame(normal: &Vector<3>) -> Option<[Vector<3>; 3]> {
    let n = normal.try_normalize(0.0)?;
    let mut across = Vector::<3>::zeros();
    across[n.iamin()] = 1.0;
    let e1 = (across - n * n.dot(&across)).normalize();
    Some([e1, n.cross(&e1), n])
}

/// `1, u, v, u², uv, v², u³, u²v, uv², v³, u⁴, u³v, u²v², uv³, v⁴`.
pub(super) fn powers(u: f64, v: f64) -> [f64; QUARTIC] {
    let (uu, uv, vv) = (u * u, u * v, v * v);
    [1.0, u, v, uu, uv, vv, uu * u, uu * v, u * vv, v * vv, uu * uu, uu * uv, uu * vv, uv * vv, vv * vv]
}

/// The vertices of a fit in their frame.
pub(super) struct Around {
    pub origin: Point<3>,
    pub frame: [Vector<3>; 3],
    pub radius: f64,
    pub vertices: Vec<u32>,
    /// `u, v, w` of each.
    local: Vec<[f64; 3]>,
}

/// A polynomial height.
pub(super) struct Fit {
    /// Of the powers that it has.
    pub coefficients: DVector<f64>,
    /// Derivatives of the coefficients in the heights of the vertices, a column each.
    pub gain: DMatrix<f64>,
    /// Sum of the squares of what it leaves of the heights, and of how many independent scattered heights of a unit each that
    /// would be the mean.
    pub left: [f64; 2],
}

impl Around {
    /// Those around a vertex, over the plane of a normal, for a fit so much wider than the narrowest; `None` without a normal.
    pub fn new(vertices: &Vertices<'_>, vertex: usize, normal: &Vector<3>, wider: f64) -> Option<Self> {
        let (origin, frame) = (vertices.at[vertex], frame(normal)?);
        let radius = NARROWEST * wider * vertices.edge(vertex);
        let near = vertices.near(vertex, wider);
        let local = |v: &u32| frame.map(|e| e.dot(&(vertices.at[*v as usize] - origin)) / radius);
        Some(Around { origin, frame, radius, local: near.iter().map(local).collect(), vertices: near })
    }

    /// The polynomial with so many coefficients that fits best, or one of degree two where vertices are too few for it.
    pub fn fit(&self, wanted: usize) -> Option<Fit> {
        let count = self.local.len();
        let unknowns = if count > wanted { wanted } else { QUADRATIC };
        let rows = DMatrix::from_fn(count, unknowns, |i, k| powers(self.local[i][0], self.local[i][1])[k]);
        let weights: Vec<f64> = self.local.iter().map(|p| (-p.iter().map(|x| x * x).sum::<f64>()).exp()).collect();
        let weighted = DMatrix::from_fn(unknowns, count, |k, i| weights[i] * rows[(i, k)]);
        let gain = (&weighted * &rows).cholesky()?.solve(&weighted);
        let heights = DVector::from_fn(count, |i, _| self.local[i][2]);
        let coefficients = &gain * &heights;
        let left = heights - &rows * &coefficients;
        // tr (I - H)ᵀ(I - H) of the projection `H` that fits.
        let both = gain.dot(&rows.transpose());
        let twice = (rows.transpose() * &rows).dot(&(&gain * gain.transpose()));
        let freedom = count as f64 - 2.0 * both + twice;
        Some(Fit { coefficients, gain, left: [left.norm_squared() * self.radius * self.radius, freedom] })
    }

    /// The normal of a fit at the vertex.
    pub fn normal(&self, fit: &Fit) -> Vector<3> {
        let [e1, e2, n] = &self.frame;
        n - e1 * fit.coefficients[1] - e2 * fit.coefficients[2]
    }
}

/// The polynomial of degree three about a vertex over the plane of its own normal, which is that of a first fit.
pub(super) fn cubic(vertices: &Vertices<'_>, vertex: usize, normal: &Vector<3>, wider: f64) -> Option<(Around, Fit)> {
    let first = Around::new(vertices, vertex, normal, wider)?;
    let normal = first.normal(&first.fit(CUBIC)?);
    let around = Around::new(vertices, vertex, &normal, wider)?;
    let fit = around.fit(CUBIC)?;
    Some((around, fit))
}
