//! A patch of a body: rational B-splines over a square or a cube of parameters.

use super::line::KnotLine;
use signorini_basis::hierarchic::MAX_DEGREE;
use signorini_geometry::Point;

/// A patch; the first direction of its control points runs fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct NurbsPatch<const D: usize> {
    /// Empty, or for messages and groups.
    pub name: String,
    pub lines: [KnotLine; D],
    pub points: Vec<Point<D>>,
    pub weights: Vec<f64>,
}

/// What is wrong with a patch, by the keys of a case.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct NurbsError {
    /// `degree`, `knots`, `points`, `weights` or `cells`.
    pub key: &'static str,
    /// Number of the patch, where there are several.
    pub patch: usize,
    pub message: String,
    pub help: String,
}

fn wrong(key: &'static str, message: String, help: impl Into<String>) -> NurbsError {
    NurbsError { key, patch: 0, message, help: help.into() }
}

/// Names of the directions.
const DIRECTIONS: [&str; 3] = ["first", "second", "third"];

impl<const D: usize> NurbsPatch<D> {
    /// A patch from its parts; without weights all are 1.
    ///
    /// # Errors
    /// Degrees, knots, points and weights that make no spline that reaches its sides: for each its key and what is valid.
    pub fn new(
        name: &str,
        degree: [usize; D],
        knots: [Vec<f64>; D],
        points: Vec<Point<D>>,
        weights: Option<Vec<f64>>,
    ) -> Result<Self, NurbsError> {
        let mut counts = [0; D];
        let mut lines = Vec::with_capacity(D);
        for (k, (degree, knots)) in degree.into_iter().zip(knots).enumerate() {
            let direction = DIRECTIONS[k];
            if !(1..=MAX_DEGREE).contains(&degree) {
                return Err(wrong(
                    "degree",
                    format!("degree {degree} of the {direction} direction"),
                    format!("valid are 1 to {MAX_DEGREE}"),
                ));
            }
            check_knots(direction, degree, &knots)?;
            counts[k] = knots.len() - degree - 1;
            lines.push(KnotLine { degree, knots });
        }
        let count: usize = counts.iter().product();
        let by: Vec<String> = counts.iter().map(usize::to_string).collect();
        let by = by.join(" x ");
        if points.len() != count {
            let help = format!("degree and knots ask for {by} = {count} points, the first direction fastest");
            return Err(wrong("points", format!("{} control points", points.len()), help));
        }
        if let Some(k) = points.iter().position(|x| !x.iter().all(|v| v.is_finite())) {
            return Err(wrong("points", format!("point {k} is not finite"), "give finite coordinates"));
        }
        let weights = weights.unwrap_or_else(|| vec![1.0; count]);
        if weights.len() != count {
            let help = format!("give one weight for each of the {count} control points, in the same order");
            return Err(wrong("weights", format!("{} weights", weights.len()), help));
        }
        if let Some(k) = weights.iter().position(|w| !(*w > 0.0 && w.is_finite())) {
            return Err(wrong("weights", format!("weight {k} is {}", weights[k]), "weights are greater than 0"));
        }
        let lines = lines.try_into().map_err(|_| wrong("knots", "no directions".into(), "give knots"))?;
        Ok(NurbsPatch { name: name.into(), lines, points, weights })
    }

    /// Number of control points in each direction.
    pub fn counts(&self) -> [usize; D] {
        self.lines.each_ref().map(KnotLine::len)
    }

    /// The highest degree of its directions.
    pub fn degree(&self) -> usize {
        self.lines.iter().map(|line| line.degree).max().unwrap_or(1)
    }

    /// The same body with functions of a degree in all directions, not lower than its own, and each span of knots divided into
    /// as many cells.
    ///
    /// # Errors
    /// A lower degree, one above 8, no cells.
    pub fn raised(&self, degree: usize, cells: [usize; D]) -> Result<Self, NurbsError> {
        if degree < self.degree() || degree > MAX_DEGREE {
            let help = format!("valid are {} to {MAX_DEGREE}: a lower degree cannot keep the shape", self.degree());
            return Err(wrong("degree", format!("degree {degree} on a patch of degree {}", self.degree()), help));
        }
        if cells.contains(&0) {
            return Err(wrong("cells", "0 cells on a span of knots".into(), "give 1 or more for each direction"));
        }
        let mut counts = self.counts();
        // Weighted positions and weights.
        let mut controls: Vec<[f64; 4]> = (self.points.iter().zip(&self.weights))
            .map(|(x, w)| std::array::from_fn(|k| if k < D { x[k] * w } else { f64::from(u8::from(k == 3)) * w }))
            .collect();
        let mut lines = self.lines.clone();
        for k in 0..D {
            let raised = self.lines[k].raised(degree, cells[k]);
            if raised != self.lines[k] {
                let regular = || wrong("knots", "knots that cannot be refined".into(), "give other knots");
                let change = self.lines[k].change(&raised).ok_or_else(regular)?;
                let stride: usize = counts[..k].iter().product();
                let rest: usize = counts[k + 1..].iter().product();
                let (old, new) = (counts[k], raised.len());
                let mut next = vec![[0.0; 4]; stride * new * rest];
                for r in 0..rest {
                    for i in 0..new {
                        for j in (0..old).filter(|j| change[(i, *j)] != 0.0) {
                            for s in 0..stride {
                                let from = controls[(r * old + j) * stride + s];
                                let to = &mut next[(r * new + i) * stride + s];
                                (0..4).for_each(|c| to[c] += change[(i, j)] * from[c]);
                            }
                        }
                    }
                }
                controls = next;
                counts[k] = new;
                lines[k] = raised;
            }
        }
        let weights: Vec<f64> = controls.iter().map(|c| c[3]).collect();
        let points = controls.iter().map(|c| Point::<D>::from_fn(|k, _| c[k] / c[3])).collect();
        Ok(NurbsPatch { name: self.name.clone(), lines, points, weights })
    }

    /// The position at parameters within the knots.
    pub fn at(&self, t: &[f64; D]) -> Point<D> {
        let values: Vec<(usize, Vec<f64>)> = self.lines.iter().zip(t).map(|(line, t)| line.values(*t)).collect();
        let counts = self.counts();
        let (mut sum, mut weight) = (Point::<D>::zeros(), 0.0);
        let total: usize = values.iter().map(|v| v.1.len()).product();
        for mut i in 0..total {
            let (mut share, mut number, mut stride) = (1.0, 0, 1);
            for k in 0..D {
                let at = i % values[k].1.len();
                i /= values[k].1.len();
                share *= values[k].1[at];
                number += (values[k].0 + at) * stride;
                stride *= counts[k];
            }
            let w = share * self.weights[number];
            sum += self.points[number] * w;
            weight += w;
        }
        sum / weight
    }
}

fn check_knots(direction: &str, degree: usize, knots: &[f64]) -> Result<(), NurbsError> {
    let wrong = |message: String, help: String| Err(wrong("knots", message, help));
    if knots.len() < 2 * degree + 2 {
        let least = 2 * degree + 2;
        return wrong(
            format!("{} knots in the {direction} direction", knots.len()),
            format!("degree {degree} needs at least {least}: as many control points as knots less {}", degree + 1),
        );
    }
    if let Some(k) = knots.iter().position(|t| !t.is_finite()) {
        return wrong(format!("knot {k} of the {direction} direction is not finite"), "give finite knots".into());
    }
    if let Some(k) = knots.windows(2).position(|t| t[1] < t[0]) {
        return wrong(
            format!("knots of the {direction} direction decrease: {} after {}", knots[k + 1], knots[k]),
            "knots do not decrease".into(),
        );
    }
    let (first, last) = (knots[0], knots[knots.len() - 1]);
    let repeats = |t: f64| knots.iter().filter(|k| **k == t).count();
    if last <= first {
        return wrong(format!("all knots of the {direction} direction are {first}"), "give at least one span".into());
    }
    for end in [first, last] {
        if repeats(end) != degree + 1 {
            return wrong(
                format!("the {direction} direction begins or ends with {} times {end}", repeats(end)),
                format!(
                    "repeat the first and the last knot {} times: degree + 1, so that the patch reaches its sides",
                    degree + 1
                ),
            );
        }
    }
    if let Some(t) = knots.iter().find(|t| **t > first && **t < last && repeats(**t) > degree) {
        return wrong(
            format!("the inner knot {t} of the {direction} direction is repeated {} times", repeats(*t)),
            format!("at most {degree} times, the degree: the body would be cut there. Use two patches"),
        );
    }
    Ok(())
}
