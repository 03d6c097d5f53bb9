//! Shapes as atlases of smooth charts, and the tree of cells on which closest points are bounded.
//!
//! Every curve and surface becomes a list of [`Piece`]s, each a [`Chart`] on `[-1, 1]^M` with bounds on its second and
//! third derivatives. A [`Cell`] is a box of parameters of one piece together with its Taylor expansion and the largest
//! error of that expansion in the box; all bounds of the closest-point search are made from cells. The upper part of
//! the tree is built once per shape; a search adds what it needs below.

mod atlas;
pub mod bernstein;
mod bounds;
mod cell;
pub mod chart;
mod horner;
pub mod net;
pub mod weights;

pub use atlas::Atlas;
pub use cell::Cell;
pub use chart::{Chart, CurveChart, Jet3, PointChart, SurfaceChart};

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
    /// The map to parameters this many times as large.
    pub fn scaled(&self, factor: [f64; M]) -> Self {
        let times = |x: &[f64; M]| std::array::from_fn(|k| x[k] * factor[k]);
        match self {
            ParameterMap::Projective { low, high, ratio } => {
                ParameterMap::Projective { low: times(low), high: times(high), ratio: *ratio }
            }
            ParameterMap::Bilinear(corners) => ParameterMap::Bilinear(corners.each_ref().map(times)),
        }
    }

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
