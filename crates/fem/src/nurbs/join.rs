//! Sides of patches that are the same side of two of them, or both ends of a patch that closes.
//!
//! Two sides whose corners coincide and that meet in the middle too are meant to be one. They are, if control points, weights up
//! to a factor, and knots up to a linear map are the same: then so are the functions.

use super::line::KnotLine;
use super::patch::{NurbsError, NurbsPatch};
use signorini_geometry::{Aabb, Point};

/// Positions closer than this part of the size of the body are one.
const SAME: f64 = 1e-9;
/// Knots and weights likewise.
const ALIKE: f64 = 1e-9;

/// A side of a patch: the direction across it, and whether it is at the upper end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct PatchSide {
    pub patch: usize,
    pub across: usize,
    pub upper: bool,
}

/// Two sides that are one. The axes of a side are the other directions, ascending.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JoinedSides {
    pub sides: [PatchSide; 2],
    /// How the axes of the second side lie on those of the first.
    turn: Turn,
}

/// Axes that change places, and then are reversed.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Turn {
    swapped: bool,
    reversed: [bool; 2],
}

impl Turn {
    fn all<const D: usize>() -> Vec<Turn> {
        let swaps: &[bool] = if D == 3 { &[false, true] } else { &[false] };
        let reversals: &[[bool; 2]] =
            if D == 3 { &[[false; 2], [true, false], [false, true], [true; 2]] } else { &[[false; 2], [true, false]] };
        let of = |swapped: &bool| {
            reversals.iter().map(|reversed| Turn { swapped: *swapped, reversed: *reversed }).collect::<Vec<_>>()
        };
        swaps.iter().flat_map(of).collect()
    }

    /// The place on the second side of a place on the first, of so many along the axes of the second.
    fn place(&self, [i, j]: [usize; 2], counts: [usize; 2]) -> [usize; 2] {
        let at = if self.swapped { [j, i] } else { [i, j] };
        std::array::from_fn(|a| if self.reversed[a] { counts[a] - 1 - at[a] } else { at[a] })
    }

    /// The axis of the second side that lies on one of the first.
    fn axis(&self, of_first: usize) -> usize {
        if self.swapped { 1 - of_first } else { of_first }
    }
}

impl PatchSide {
    /// All sides of a patch, low and high along each direction.
    pub fn all<const D: usize>(patch: usize) -> impl Iterator<Item = PatchSide> {
        (0..2 * D).map(move |k| PatchSide { patch, across: k / 2, upper: k % 2 == 1 })
    }

    fn axes<const D: usize>(&self) -> Vec<usize> {
        (0..D).filter(|k| *k != self.across).collect()
    }

    /// How many of a grid lie on the side along each of its axes.
    pub fn counts<const D: usize>(&self, grid: [usize; D]) -> [usize; 2] {
        let axes = self.axes::<D>();
        std::array::from_fn(|a| axes.get(a).map_or(1, |k| grid[*k]))
    }

    /// The number in a grid of a place on the side.
    pub fn number<const D: usize>(&self, grid: [usize; D], place: [usize; 2]) -> usize {
        let axes = self.axes::<D>();
        let mut index = [0; D];
        index[self.across] = if self.upper { grid[self.across] - 1 } else { 0 };
        axes.iter().zip(place).for_each(|(k, i)| index[*k] = i);
        (0..D).rev().fold(0, |number, k| number * grid[k] + index[k])
    }

    fn lines<'a, const D: usize>(&self, patch: &'a NurbsPatch<D>) -> Vec<&'a KnotLine> {
        self.axes::<D>().into_iter().map(|k| &patch.lines[k]).collect()
    }

    fn middle<const D: usize>(&self, patch: &NurbsPatch<D>) -> Point<D> {
        patch.at(&std::array::from_fn(|k| {
            let [from, to] = patch.lines[k].range();
            if k != self.across {
                0.5 * (from + to)
            } else if self.upper {
                to
            } else {
                from
            }
        }))
    }

    /// For messages.
    pub fn describe<const D: usize>(&self, patches: &[NurbsPatch<D>]) -> String {
        let side = crate::block::side_names(D)[self.across][usize::from(self.upper)];
        match patches[self.patch].name.as_str() {
            "" if patches.len() == 1 => format!("side `{side}`"),
            "" => format!("side `{side}` of patch {}", self.patch),
            name => format!("side `{side}` of patch `{name}`"),
        }
    }
}

impl JoinedSides {
    /// The numbers in two grids, one for each patch, of what is the same.
    pub fn pairs<const D: usize>(&self, grids: [[usize; D]; 2]) -> Vec<[usize; 2]> {
        let [a, b] = &self.sides;
        let [n, m] = a.counts(grids[0]);
        let counts = b.counts(grids[1]);
        let pair = |k: usize| {
            let place = [k % n, k / n];
            [a.number(grids[0], place), b.number(grids[1], self.turn.place(place, counts))]
        };
        (0..n * m).map(pair).collect()
    }
}

/// All sides that are one.
///
/// # Errors
/// Sides with common corners and a common middle whose control points, weights or knots differ.
pub fn joined_sides<const D: usize>(patches: &[NurbsPatch<D>]) -> Result<Vec<JoinedSides>, NurbsError> {
    let all: Vec<PatchSide> = (0..patches.len()).flat_map(PatchSide::all::<D>).collect();
    let bounds = Aabb::around(patches.iter().flat_map(|p| p.points.iter().copied()));
    let near = bounds.map_or(0.0, |bounds| SAME * bounds.size().norm());
    let mut out: Vec<JoinedSides> = Vec::new();
    for (k, a) in all.iter().enumerate() {
        for b in &all[k + 1..] {
            if out.iter().any(|j| j.sides.contains(a) || j.sides.contains(b)) {
                continue;
            }
            let [p, q] = [&patches[a.patch], &patches[b.patch]];
            if (a.middle(p) - b.middle(q)).norm() > near {
                continue;
            }
            let with = |turn: Turn| JoinedSides { sides: [*a, *b], turn };
            let corners = [[2; D]; 2];
            let of = |side: &PatchSide, patch: &NurbsPatch<D>, corner: usize| {
                let counts = patch.counts();
                let index: [usize; D] = std::array::from_fn(|k| (corner >> k & 1) * (counts[k] - 1));
                debug_assert_eq!(index[side.across] > 0, side.upper);
                patch.points[(0..D).rev().fold(0, |n, k| n * counts[k] + index[k])]
            };
            let meets = |turn: &Turn| {
                let pairs = with(*turn).pairs(corners);
                pairs.iter().all(|[i, j]| (of(a, p, *i) - of(b, q, *j)).norm() <= near)
            };
            let turns: Vec<Turn> = Turn::all::<D>().into_iter().filter(meets).collect();
            if turns.is_empty() {
                continue;
            }
            let mut failure = None;
            let mut fits = |turn: &Turn| match differs(patches, &with(*turn), near) {
                None => true,
                Some(e) => {
                    failure.get_or_insert(e);
                    false
                }
            };
            match turns.iter().copied().find(&mut fits) {
                Some(turn) => out.push(with(turn)),
                None => return Err(failure.unwrap_or_else(|| not_alike(patches, [a, b], "points", "they differ"))),
            }
        }
    }
    Ok(out)
}

fn not_alike<const D: usize>(
    patches: &[NurbsPatch<D>],
    [a, b]: [&PatchSide; 2],
    key: &'static str,
    how: &str,
) -> NurbsError {
    NurbsError {
        key,
        patch: b.patch,
        message: format!("{} meets {}, but {how}", b.describe(patches), a.describe(patches)),
        help: "sides that meet have the same control points, weights and knots, and as many cells".into(),
    }
}

/// What differs on two sides.
fn differs<const D: usize>(patches: &[NurbsPatch<D>], joined: &JoinedSides, near: f64) -> Option<NurbsError> {
    let [a, b] = &joined.sides;
    let [p, q] = [&patches[a.patch], &patches[b.patch]];
    let fail = |key, how: String| Some(not_alike(patches, [a, b], key, &how));
    let (lines, others) = (a.lines(p), b.lines(q));
    for (axis, line) in lines.iter().enumerate() {
        let own = joined.turn.axis(axis);
        let other = others[own];
        if line.len() != other.len() {
            return fail("knots", format!("it has {} control points along it instead of {}", other.len(), line.len()));
        }
        let share = |line: &KnotLine, k: usize| {
            let [from, to] = line.range();
            (line.knots[k] - from) / (to - from)
        };
        let n = line.knots.len();
        for k in 0..n {
            let there = if joined.turn.reversed[own] { 1.0 - share(other, n - 1 - k) } else { share(other, k) };
            if (share(line, k) - there).abs() > ALIKE {
                return fail("knots", format!("its knot {k} is at {there} of its range instead of {}", share(line, k)));
            }
        }
    }
    let pairs = joined.pairs([p.counts(), q.counts()]);
    let ratio = q.weights[pairs[0][1]] / p.weights[pairs[0][0]];
    for [i, j] in pairs {
        if (p.points[i] - q.points[j]).norm() > near {
            let [x, y] = [&p.points[i], &q.points[j]].map(crate::mesh::position);
            return fail("points", format!("its control point {j} is at {y} instead of {x}"));
        }
        let wanted = ratio * p.weights[i];
        if (q.weights[j] - wanted).abs() > ALIKE * wanted {
            return fail("weights", format!("its weight {j} is {} instead of {wanted}", q.weights[j]));
        }
    }
    None
}
