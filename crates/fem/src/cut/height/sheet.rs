//! The functions whose zeros a box is resolved for: whether they have any there, and along which directions they are steep.

use crate::cut::roots::scan_roots;
use signorini_geometry::{Aabb, ImplicitShape, Point, Vector};

/// Least slope `|∂_k φ| / |∇φ|` along a height direction. Smaller ones need fewer boxes, but the height of a steep
/// surface is a poor function of its base: at 0.3 a torus of twice the radius of a cell is right to ten digits.
pub(super) const MIN_SLOPE: f64 = 0.3;
/// Slope below which a surface does not depend on a direction: rounding of gradients.
const CONSTANT: f64 = 1e-13;
/// Samples in each direction, ends included.
const SAMPLES: usize = 4;
/// Steps of the search for a surface that no sample shows.
const DESCENT_STEPS: usize = 12;

/// A function on a box, or on the box without some directions.
pub(super) enum Sheet<'a, const D: usize> {
    Given(&'a dyn ImplicitShape<D>),
    /// Another one with a coordinate held.
    Face {
        of: &'a Sheet<'a, D>,
        axis: usize,
        at: f64,
    },
    /// One sheet on the graph of another.
    Graph {
        of: &'a Sheet<'a, D>,
        graph: &'a Sheet<'a, D>,
        axis: usize,
        ends: [f64; 2],
    },
}

impl<const D: usize> Sheet<'_, D> {
    pub fn value(&self, x: &Point<D>) -> f64 {
        match self {
            Sheet::Given(shape) => shape.value(x),
            Sheet::Face { of, axis, at } => of.value(&with(x, *axis, *at)),
            Sheet::Graph { of, graph, axis, ends } => of.value(&with(x, *axis, height(graph, x, *axis, ends).0)),
        }
    }

    /// The components of the gradient along directions that the function does not know are without meaning.
    pub fn value_and_gradient(&self, x: &Point<D>) -> (f64, Vector<D>) {
        match self {
            Sheet::Given(shape) => shape.value_and_gradient(x),
            Sheet::Face { of, axis, at } => of.value_and_gradient(&with(x, *axis, *at)),
            Sheet::Graph { of, graph, axis, ends } => {
                let (t, free) = height(graph, x, *axis, ends);
                let y = with(x, *axis, t);
                let (value, gradient) = of.value_and_gradient(&y);
                if !free {
                    return (value, gradient);
                }
                let slope = graph.value_and_gradient(&y).1;
                (value, gradient - slope * (gradient[*axis] / slope[*axis]))
            }
        }
    }

    /// The roots on a line through `x` in direction `k`; see [`scan_roots`].
    pub fn roots(&self, x: &Point<D>, k: usize, ends: [f64; 2], pieces: usize) -> Vec<f64> {
        let scan = |f: &dyn Fn(f64) -> (f64, f64)| scan_roots(ends[0], ends[1], pieces, f);
        match self {
            Sheet::Given(shape) => {
                let mut found = Vec::new();
                shape.on_line(x, k, ends, &mut |f| found = scan(f));
                found
            }
            Sheet::Face { of, axis, at } => of.roots(&with(x, *axis, *at), k, ends, pieces),
            Sheet::Graph { .. } => scan(&|t| {
                let (value, gradient) = self.value_and_gradient(&with(x, k, t));
                (value, gradient[k])
            }),
        }
    }

    fn range(&self, b: &Aabb<D>) -> Option<[f64; 2]> {
        match self {
            Sheet::Given(shape) => shape.range(b),
            Sheet::Face { of, axis, at } => of.range(&Aabb::new(with(&b.min, *axis, *at), with(&b.max, *axis, *at))),
            Sheet::Graph { .. } => None,
        }
    }
}

/// A point with one coordinate replaced.
pub(super) fn with<const D: usize>(x: &Point<D>, axis: usize, at: f64) -> Point<D> {
    let mut y = *x;
    y[axis] = at;
    y
}

/// The height at which a sheet that is monotone along an axis vanishes, kept between the ends, and whether it lies there.
fn height<const D: usize>(sheet: &Sheet<'_, D>, x: &Point<D>, axis: usize, ends: &[f64; 2]) -> (f64, bool) {
    let [low, high] = ends.map(|t| sheet.value(&with(x, axis, t)));
    if (low < 0.0) == (high < 0.0) {
        return (if low.abs() < high.abs() { ends[0] } else { ends[1] }, false);
    }
    (sheet.roots(x, axis, *ends, 1).first().copied().unwrap_or(ends[1]), true)
}

/// Whether a function has zeros in a box.
pub(super) enum Crossing<const D: usize> {
    None,
    Some,
    /// Its zeros were found only by a search, which ended at this point of the other sign.
    Hidden(Point<D>),
}

/// The lattice of samples of a box in some directions.
fn samples<const D: usize>(b: &Aabb<D>, axes: &[usize]) -> impl Iterator<Item = Point<D>> {
    let (b, axes) = (*b, axes.to_vec());
    (0..SAMPLES.pow(axes.len() as u32)).map(move |mut i| {
        let mut x = b.min;
        for &k in &axes {
            // The ends exactly.
            x[k] = match i % SAMPLES {
                0 => b.min[k],
                j if j + 1 == SAMPLES => b.max[k],
                j => b.min[k] + (b.max[k] - b.min[k]) * j as f64 / (SAMPLES - 1) as f64,
            };
            i /= SAMPLES;
        }
        x
    })
}

/// By bounds where they are known; then by samples; then by going down `|φ|` from the three smallest of them, along the
/// faces of the box where it would be left.
pub(super) fn crossing<const D: usize>(sheet: &Sheet<'_, D>, b: &Aabb<D>, axes: &[usize]) -> Crossing<D> {
    if let Some([low, high]) = sheet.range(b)
        && (low > 0.0 || high < 0.0)
    {
        return Crossing::None;
    }
    let mut smallest: Vec<(f64, Point<D>)> = Vec::with_capacity(4);
    let mut negative = None;
    for x in samples(b, axes) {
        let value = sheet.value(&x);
        if *negative.get_or_insert(value < 0.0) != (value < 0.0) {
            return Crossing::Some;
        }
        let at = smallest.iter().position(|s| value.abs() < s.0).unwrap_or(smallest.len());
        smallest.insert(at, (value.abs(), x));
        smallest.truncate(3);
    }
    let negative = negative == Some(true);
    for (_, mut x) in smallest {
        for _ in 0..DESCENT_STEPS {
            let (value, mut gradient) = sheet.value_and_gradient(&x);
            if (value < 0.0) != negative {
                return Crossing::Hidden(x);
            }
            for k in 0..D {
                let step = -value * gradient[k];
                let blocked = (x[k] <= b.min[k] && step < 0.0) || (x[k] >= b.max[k] && step > 0.0);
                if blocked || !axes.contains(&k) {
                    gradient[k] = 0.0;
                }
            }
            let square = gradient.norm_squared();
            if square == 0.0 || !square.is_finite() {
                break;
            }
            let next = b.clamp(&(x - gradient * (1.3 * value / square)));
            if (next - x).amax() <= 1e-12 * b.size().amax() {
                break;
            }
            x = next;
        }
    }
    Crossing::None
}

/// Slopes `∂_k φ / |∇φ|` of a sheet along each direction.
pub(super) struct Slopes<const D: usize> {
    /// The least; negative where the sign changes.
    pub least: Vector<D>,
    most: Vector<D>,
}

impl<const D: usize> Slopes<D> {
    pub fn is_constant(&self, k: usize) -> bool {
        self.most[k] <= CONSTANT
    }

    /// Whether lines along a direction give the volumes beside this sheet, and some direction its surface.
    pub fn allow(&self, k: usize, axes: &[usize]) -> bool {
        self.least[k] >= MIN_SLOPE || (self.is_constant(k) && axes.iter().any(|&a| self.least[a] >= MIN_SLOPE))
    }
}

/// What is done where no direction is steep.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum IfFlat {
    /// The box is divided: the first samples that show it are enough.
    Divide,
    /// The steepest of them is taken.
    TakeSteepest,
}

pub(super) fn slopes<const D: usize>(sheet: &Sheet<'_, D>, b: &Aabb<D>, axes: &[usize], flat: IfFlat) -> Slopes<D> {
    let (mut low, mut high) = (Vector::<D>::repeat(f64::INFINITY), Vector::<D>::repeat(f64::NEG_INFINITY));
    let slopes = |low: Vector<D>, high: Vector<D>| Slopes { least: low.sup(&-high), most: high.sup(&-low) };
    for x in samples(b, axes) {
        let gradient = sheet.value_and_gradient(&x).1;
        let norm = axes.iter().map(|&k| gradient[k] * gradient[k]).sum::<f64>().sqrt();
        let direction = gradient / norm.max(f64::MIN_POSITIVE);
        low = low.inf(&direction);
        high = high.sup(&direction);
        let so_far = slopes(low, high);
        let is_flat = |k: &usize| so_far.least[*k] < MIN_SLOPE && !so_far.is_constant(*k);
        if flat == IfFlat::Divide && axes.iter().all(is_flat) {
            break;
        }
    }
    slopes(low, high)
}

/// The direction with the largest of these, and that slope.
pub(super) fn steepest<const D: usize>(least: Vector<D>, axes: &[usize]) -> (f64, usize) {
    axes.iter().map(|&k| (least[k], k)).fold((f64::NEG_INFINITY, axes[0]), |a, c| if c.0 > a.0 { c } else { a })
}
