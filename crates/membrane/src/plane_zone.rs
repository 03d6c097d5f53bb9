//! Contact zones in the plane, bounded by smooth closed fronts.

use crate::ils::Solution;
use crate::mode_matrix::Clique;
use crate::multigrid;
use crate::obstacle::Side;
use crate::problem::Membrane;
use crate::published::{NodalLevelSet, Transport};
use crate::raster::Raster;
use crate::sizing::{self, Sizing};
use crate::zone::{Advance, Division, FrontFoot, FrontsInCell, ModeSpace, Zone, contact, contact_of, free};
use serde_json::{Value, json};
use signorini_fem::cut::RegionId;
use signorini_fem::{Cells, Grid, RefinedGrid};
use signorini_geometry::{Aabb, ClosedCurve, CurvePoint, ImplicitShape, PeriodicBasis, Point, Vector, polygon};
use signorini_solve::{Progress, SolveError};
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// Fewest knots of a front, which still draw a circle to 3e-5 of its radius.
const FEWEST_KNOTS: f64 = 5.0;
/// Knots of a circle that is put where penetration is too small for the raster.
const SEED_KNOTS: usize = 16;
/// Degree of a curve along a level set that is linear between nodes.
const LEVEL_SET_DEGREE: usize = 3;
/// A front that moves by less than this fraction of a cell keeps its parameter, and has so many knots for each mode: in the
/// space of its modes, on another parameter, a few hundredths of the short waves of a step would be left behind. Longer steps
/// begin anew there, so that what no mode sees of a front is what is left of its last, short steps.
const CLOSE: f64 = 0.01;
const SPLIT: usize = 2;
/// It gets a new parameter, too, once its length has changed, or its speed differs, by so much.
const STRETCH: f64 = 0.2;
/// After a longer step one on divided cells of degree 1 keeps its number of modes where these would have it differ by one, or by
/// this part of it.
const KEPT: f64 = 0.03;
/// Fronts that would move by less than this part of a cell have been there before.
const SAME: f64 = 1e-9;
/// The speed of a front between states of a path differs by this factor at most.
const CROWDED: f64 = 1.5;
/// Cells along the longer side of a grid on which fronts that meet are told apart, where the smallest cells are few.
const MOST_SAMPLES: usize = 2048;
/// Cells for each radius of curvature of a front, so that Newton's method converges as fast there as along straight ones; of
/// degree 1, whose modes are longer; and between fronts.
const CURVED: f64 = 5.0;
const CURVED_LINEAR: f64 = 8.0;
const BETWEEN: f64 = 3.0;
/// A front that bends within a cell is blunter than it would be on smaller ones: by this much times curvature and size.
const BLUNTED: f64 = 1.3;
/// A front of so many cells is long.
const LONG: f64 = 12.0;
/// A front that encloses less than this multiple of `h²` after a step has collapsed.
const COLLAPSED: f64 = 0.01;
/// Outlines that enclose less than this multiple of a cell are those of nodes, not of zones or holes.
const SHAPELESS: f64 = 4.0;
/// A step may not bring a tip farther than this many divided cells, beyond which the linear model says nothing.
const FARTHEST: f64 = 4.0;
/// A step may not bring a front nearer to its centre of curvature than this fraction of its radius of curvature.
const FOLD: f64 = 0.3;

/// Zones bounded by closed curves: outer fronts run counter-clockwise, the rims of holes clockwise.
#[derive(Clone, Debug)]
pub struct PlaneZone {
    curves: Vec<ClosedCurve>,
    /// What the zone that a curve bounds touches.
    sides: Vec<Side>,
    grid: Grid<2>,
    /// How long modes are where they differ in length.
    sizing: Option<Arc<Sizing<2>>>,
    /// The smallest box round each curve.
    boxes: Vec<Aabb<2>>,
    /// Absolute areas: of the curves round a point, the smallest decides where it lies.
    areas: Vec<f64>,
    hole: Vec<bool>,
    /// For each curve, its number among the outer fronts or among the holes.
    number: Vec<usize>,
    /// How many modes each curve has; see [`SPLIT`].
    mode_counts: Vec<usize>,
    near: NearFronts,
    /// For each row of cells, the columns whose centres a curve encloses: first, one behind the last, and the curve.
    rows: Vec<Vec<[u32; 3]>>,
}

/// Functions of the parameter of a front.
enum FrontModes {
    Splines(PeriodicBasis),
    /// One, and the cosine and sine of every wave number up to the highest.
    Waves {
        highest: usize,
    },
}

impl FrontModes {
    fn count(&self) -> usize {
        match self {
            FrontModes::Splines(basis) => basis.count,
            FrontModes::Waves { highest } => 2 * highest + 1,
        }
    }

    /// Calls `visit(mode, value, derivative)` for every function that does not vanish at a parameter.
    fn for_each_at(&self, s: f64, mut visit: impl FnMut(usize, f64, f64)) {
        match self {
            FrontModes::Splines(basis) => {
                let b = basis.bumps(s);
                // Few splines meet themselves round the curve: their bumps are added up.
                for i in 0..b.len.min(basis.count) {
                    let same = (i..b.len).step_by(basis.count);
                    let (value, slope) = same.fold((0.0, 0.0), |(v, d), k| (v + b.value[k], d + b.d1[k]));
                    visit(basis.index(&b, i), value, slope);
                }
            }
            FrontModes::Waves { highest } => {
                visit(0, 1.0, 0.0);
                for k in 1..=*highest {
                    let omega = std::f64::consts::TAU * k as f64;
                    let (sin, cos) = (omega * s).sin_cos();
                    visit(2 * k - 1, cos, -omega * sin);
                    visit(2 * k, sin, omega * cos);
                }
            }
        }
    }
}

/// The signed distance to one front near a cell.
struct FrontSheet<'a> {
    curve: &'a ClosedCurve,
    seeds: Vec<usize>,
}

impl FrontSheet<'_> {
    fn foot(&self, x: &Point<2>) -> (f64, CurvePoint) {
        self.curve.signed_distance(x, self.seeds.iter().copied())
    }
}

impl ImplicitShape<2> for FrontSheet<'_> {
    fn value(&self, x: &Point<2>) -> f64 {
        self.foot(x).0
    }
    fn gradient(&self, x: &Point<2>) -> Vector<2> {
        self.foot(x).1.normal
    }
    fn value_and_gradient(&self, x: &Point<2>) -> (f64, Vector<2>) {
        let (distance, foot) = self.foot(x);
        (distance, foot.normal)
    }
}

/// The signed distance to a front within a cell that it hardly bends in: to the parabola that touches it nearest to the
/// centre. Third order in the size of the cell.
struct Osculating {
    foot: Point<2>,
    normal: Vector<2>,
    curvature: f64,
}

impl ImplicitShape<2> for Osculating {
    fn value(&self, x: &Point<2>) -> f64 {
        self.value_and_gradient(x).0
    }
    fn gradient(&self, x: &Point<2>) -> Vector<2> {
        self.value_and_gradient(x).1
    }
    fn value_and_gradient(&self, x: &Point<2>) -> (f64, Vector<2>) {
        let d = x - self.foot;
        let tangent = Vector::<2>::new(self.normal[1], -self.normal[0]);
        let (along, bent) = (d.dot(&tangent), self.curvature * d.dot(&tangent));
        (d.dot(&self.normal) + 0.5 * bent * along, self.normal + bent * tangent)
    }
}

/// A zone whose fronts are taken for parabolas within cells that they hardly bend in.
pub(crate) struct Straightened<'a>(pub &'a PlaneZone);

/// Curvature times cell size up to which a front hardly bends.
const HARDLY: f64 = 0.1;

impl Division<2> for Straightened<'_> {
    fn fronts_in(&self, b: &Aabb<2>) -> FrontsInCell<'_, 2> {
        self.0.fronts_within(b, HARDLY)
    }
}

impl PlaneZone {
    /// Calls `visit(first, end, region)` for stretches of the cells of a row, by their centres; together they are the row.
    pub(crate) fn for_each_stretch(&self, row: usize, mut visit: impl FnMut(usize, usize, RegionId)) {
        let columns = self.grid.cells()[0];
        let mut ends: Vec<usize> = self.rows[row].iter().flat_map(|[a, b, _]| [*a as usize, *b as usize]).collect();
        ends.extend([0, columns]);
        ends.sort_unstable();
        ends.dedup();
        for pair in ends.windows(2) {
            let enclosing = self.enclosing(row, pair[0]);
            visit(pair[0], pair[1], self.region_within(enclosing.into_iter()));
        }
    }

    /// The grid that it is told apart on.
    pub(crate) fn grid(&self) -> &Grid<2> {
        &self.grid
    }

    /// The cells that fronts are near to, ascending.
    pub(crate) fn cells_near_fronts(&self) -> impl Iterator<Item = usize> + '_ {
        self.near.cells.iter().map(|&cell| cell as usize)
    }

    /// The curves round the centre of a cell.
    fn enclosing(&self, row: usize, column: usize) -> Vec<usize> {
        let column = column as u32;
        self.rows[row].iter().filter(|[a, b, _]| (*a..*b).contains(&column)).map(|r| r[2] as usize).collect()
    }

    /// The curves round the centre of a cell.
    fn around(&self, cell: usize) -> Vec<usize> {
        let [column, row] = self.grid.cell_index(cell);
        self.enclosing(row, column)
    }

    /// The region of a cell that no front is near to.
    pub(crate) fn region_away(&self, cell: usize) -> RegionId {
        self.region_within(self.around(cell).into_iter())
    }

    /// Pairs of curve and sample in or next to a cell.
    fn near(&self, cell: usize) -> &[(u32, u32)] {
        self.near.between(cell, cell)
    }

    /// The fronts in a box, taken for parabolas where their curvature times its size is less than `hardly`.
    fn fronts_within(&self, b: &Aabb<2>, hardly: f64) -> FrontsInCell<'_, 2> {
        let near = self.near_box(b);
        let mut far = self.around(self.grid.cell_containing(&b.center()));
        far.retain(|c| near.iter().all(|(n, _)| n != c));
        let mut found = FrontsInCell { sheets: vec![], fronts: vec![], features: vec![], region: Box::new(|_| 0) };
        for (c, seeds) in near {
            let sheet = FrontSheet { curve: &self.curves[c], seeds };
            let (distance, foot) = sheet.foot(&b.center());
            if distance.abs() > b.radius() {
                if self.encloses(c, distance) {
                    far.push(c);
                }
                continue;
            }
            if foot.curvature.abs() * b.radius() < hardly {
                let CurvePoint { position, normal, curvature, .. } = foot;
                found.sheets.push(Box::new(Osculating { foot: position, normal, curvature }));
            } else {
                let own = &self.boxes[c];
                if (0..2).all(|k| own.min[k] > b.min[k] && own.max[k] < b.max[k]) {
                    found.features.push(own.center());
                }
                found.sheets.push(Box::new(sheet));
            }
            found.fronts.push(c);
        }
        let fronts = found.fronts.clone();
        found.region = Box::new(move |values| {
            let close = fronts.iter().zip(values).filter(|&(&c, &v)| self.encloses(c, v)).map(|(&c, _)| c);
            self.region_within(far.iter().copied().chain(close))
        });
        found
    }

    /// The zone bounded by the given curves, which neither cross each other nor themselves, and what it touches there.
    pub fn new(grid: &Grid<2>, fronts: Vec<(Side, ClosedCurve)>) -> Self {
        let (sides, curves): (Vec<Side>, Vec<ClosedCurve>) = fronts.into_iter().unzip();
        let areas: Vec<f64> = curves.iter().map(|c| polygon::signed_area(c.samples())).collect();
        let hole: Vec<bool> = areas.iter().map(|a| *a < 0.0).collect();
        let mut counts = [0, 0];
        let number = hole
            .iter()
            .map(|&h| {
                counts[usize::from(h)] += 1;
                counts[usize::from(h)] - 1
            })
            .collect();
        let near = NearFronts::new(grid, &curves);
        // As many as can be told apart: its own, but for curves that follow a level set more closely.
        let most = |c: &ClosedCurve| match c.degree() {
            LEVEL_SET_DEGREE => c.knots().min(Self::knots(grid, polygon::perimeter(c.samples()) / grid.h())),
            _ => c.knots(),
        };
        let mode_counts = curves.iter().map(most).collect();
        let rows = rows_enclosed(grid, &curves);
        Self {
            boxes: curves.iter().map(|c| bounding_box(c.samples())).collect(),
            areas: areas.iter().map(|a| a.abs()).collect(),
            hole,
            number,
            mode_counts,
            near,
            rows,
            curves,
            sides,
            grid: grid.clone(),
            sizing: None,
        }
    }

    pub fn curves(&self) -> &[ClosedCurve] {
        &self.curves
    }

    /// The fronts, each with as many knots as modes.
    fn fronts(&self) -> Vec<(Side, ClosedCurve)> {
        let plain = |(c, &modes): (&ClosedCurve, &usize)| {
            if c.degree() != LEVEL_SET_DEGREE && c.knots() == SPLIT * modes {
                self.redrawn(c, modes)
            } else {
                c.clone()
            }
        };
        self.sides.iter().copied().zip(self.curves.iter().zip(&self.mode_counts).map(plain)).collect()
    }

    /// The same zone with other curves in the place of its own.
    fn with_curves(&self, grid: &Grid<2>, curves: Vec<ClosedCurve>) -> Self {
        Self { sizing: self.sizing.clone(), ..Self::new(grid, self.sides.iter().copied().zip(curves).collect()) }
    }

    /// The same zone without some of its curves.
    fn keeping(&self, grid: &Grid<2>, keep: impl Fn(usize) -> bool) -> Self {
        let kept: Vec<usize> = (0..self.curves.len()).filter(|&i| keep(i)).collect();
        let curves = kept.iter().map(|&i| (self.sides[i], self.curves[i].clone())).collect();
        let mode_counts = kept.iter().map(|&i| self.mode_counts[i]).collect();
        Self { mode_counts, sizing: self.sizing.clone(), ..Self::new(grid, curves) }
    }

    /// A curve with so many knots, as far from each other as its cells are large.
    fn redrawn(&self, curve: &ClosedCurve, knots: usize) -> ClosedCurve {
        match &self.sizing {
            None => curve.by_arc_length(knots),
            Some(sizing) => curve.evenly(knots, |x| 1.0 / sizing.at(x)),
        }
    }

    /// The length of a curve relative to the size of its cells.
    fn relative_length(&self, curve: &ClosedCurve) -> f64 {
        match &self.sizing {
            None => polygon::perimeter(curve.samples()) / self.grid.h(),
            Some(sizing) => {
                at_knots(curve).map(|p| p.speed / sizing.at(&p.position)).sum::<f64>() / curve.knots() as f64
            }
        }
    }

    /// The largest product of the curvature of one front and the size of the cells there.
    fn bend_of(&self, front: usize) -> f64 {
        let curve = &self.curves[front];
        match &self.sizing {
            None => curvatures(curve).fold(0.0, f64::max) * self.grid.h(),
            Some(sizing) => at_knots(curve).map(|p| p.curvature.abs() * sizing.at(&p.position)).fold(0.0, f64::max),
        }
    }

    /// The diameter of the disc that is as large as the smallest zone; infinite where there is none.
    pub(crate) fn smallest(&self) -> f64 {
        let areas = self.areas.iter().zip(&self.hole).filter(|(_, hole)| !**hole).map(|(area, _)| *area);
        2.0 * (areas.fold(f64::INFINITY, f64::min) / std::f64::consts::PI).sqrt()
    }

    /// Whether a curve is the rim of a hole.
    pub fn is_hole(&self, curve: usize) -> bool {
        self.hole[curve]
    }

    /// Degree of the front for a grid: `2 p + 1`, so that the geometry is as accurate as the slope jump, and at least 7,
    /// so that a few knots suffice for a round front.
    pub fn front_degree(grid: &Grid<2>) -> usize {
        (2 * grid.degree() + 1).max(7)
    }

    /// As many knots as the slope jump can tell apart modes on a front of the given length in cells. The front lives in the
    /// space of its modes: what they do not see they could not smooth either.
    fn knots(grid: &Grid<2>, relative: f64) -> usize {
        let (spacing, enough) = match grid.degree() {
            1 => (4.0, (relative / 2.0).clamp(FEWEST_KNOTS, 8.0)),
            2 => (1.5, relative.clamp(FEWEST_KNOTS, 12.0)),
            _ => (1.0, relative.clamp(FEWEST_KNOTS, 12.0)),
        };
        // A short front has as many modes as its shape needs, a very short one no more than it has cells.
        enough.max(relative / spacing).ceil() as usize
    }

    fn modes(&self, front: usize, space: ModeSpace) -> FrontModes {
        let curve = &self.curves[front];
        let most = self.mode_counts[front];
        match space {
            ModeSpace::Coarse(count) if count < most => FrontModes::Splines(PeriodicBasis { degree: 3, count }),
            ModeSpace::Coarse(_) | ModeSpace::Fine => {
                FrontModes::Splines(PeriodicBasis { degree: curve.degree(), count: most })
            }
            ModeSpace::Fourier(count) => {
                // Waves must be longer than the splines that draw them.
                let told_apart = if self.grid.degree() == 1 { most } else { most / 2 };
                FrontModes::Waves { highest: count.min(told_apart).max(1).div_ceil(2) - 1 }
            }
        }
    }

    fn seeds(&self, cell: usize, curve: usize) -> Vec<usize> {
        self.near(cell).iter().filter(|(c, _)| *c as usize == curve).map(|(_, s)| *s as usize).collect()
    }

    /// The curves near a box, each with its samples there.
    fn near_box(&self, b: &Aabb<2>) -> Vec<(usize, Vec<usize>)> {
        let inset = 1e-9 * self.grid.cell_size();
        let [low, high] = [b.min + inset, b.max - inset].map(|x| self.grid.cell_index(self.grid.cell_containing(&x)));
        let mut found: Vec<(usize, Vec<usize>)> = Vec::new();
        for j in low[1]..=high[1] {
            let row = self.near.between(self.grid.cell_at([low[0], j]), self.grid.cell_at([high[0], j]));
            for pairs in row.chunk_by(|a, b| a.0 == b.0) {
                let (c, seeds) = (pairs[0].0 as usize, pairs.iter().map(|pair| pair.1 as usize));
                match found.iter_mut().find(|(curve, _)| *curve == c) {
                    Some((_, all)) => all.extend(seeds),
                    None => found.push((c, seeds.collect())),
                }
            }
        }
        if low != high {
            for (_, seeds) in &mut found {
                seeds.sort_unstable();
                seeds.dedup();
            }
        }
        found
    }

    fn curves_near(&self, cell: usize) -> Vec<usize> {
        let mut found: Vec<usize> = self.near(cell).iter().map(|(c, _)| *c as usize).collect();
        found.dedup();
        found
    }

    /// The region inside the smallest of the curves that enclose a point.
    fn region_within(&self, enclosing: impl Iterator<Item = usize>) -> RegionId {
        match enclosing.min_by(|&a, &b| self.areas[a].total_cmp(&self.areas[b])) {
            None => free(0),
            Some(c) if self.hole[c] => free(1 + self.number[c]),
            Some(c) => contact(self.sides[c], self.number[c]),
        }
    }

    /// Whether a signed distance to a curve means that the curve encloses the point.
    fn encloses(&self, curve: usize, signed_distance: f64) -> bool {
        (signed_distance < 0.0) != self.hole[curve]
    }

    /// What cells at the fronts have to resolve, at samples that are so far from each other; distances between fronts as far
    /// as cells of a grid tell them apart.
    fn features(&self, grid: &Grid<2>, spacing: f64) -> Vec<Feature> {
        let mut features: Vec<Feature> = Vec::new();
        // For each feature its curve, and how far along it of how much.
        let mut ways: Vec<(usize, f64, f64)> = Vec::new();
        for (c, curve) in self.curves.iter().enumerate() {
            let (first, total) = (features.len(), polygon::perimeter(curve.samples()));
            let mut walked = 0.0;
            for (i, (a, b)) in polygon::edges(curve.samples()).enumerate() {
                let last = ways.last().filter(|_| features.len() > first).map_or(f64::NEG_INFINITY, |way| way.1);
                if walked - last >= spacing {
                    let curvature = curve.point(curve.sample_parameter(i)).curvature.abs().max(f64::MIN_POSITIVE);
                    features.push(Feature { place: *a, length: 0.0, curvature, apart: f64::INFINITY });
                    ways.push((c, walked, total));
                }
                walked += (b - a).norm();
            }
            // Each stands for half of the way to its neighbours.
            let n = features.len() - first;
            for k in 0..n {
                let next = (k + 1) % n;
                let step = (ways[first + next].1 - ways[first + k].1).rem_euclid(total.max(f64::MIN_POSITIVE));
                let step = if n == 1 { total } else { step };
                features[first + k].length += 0.5 * step;
                features[first + next].length += 0.5 * step;
            }
        }
        let mut within: HashMap<[i64; 2], Vec<usize>> = HashMap::new();
        let size = grid.cell_size();
        let cell = |x: &Point<2>| [0, 1].map(|k| ((x[k] - grid.bounds().min[k]) / size[k]).floor() as i64);
        for (k, feature) in features.iter().enumerate() {
            within.entry(cell(&feature.place)).or_default().push(k);
        }
        for k in 0..features.len() {
            let [i, j] = cell(&features[k].place);
            let around = (0..9).filter_map(|o| within.get(&[i + o % 3 - 1, j + o / 3 - 1])).flatten();
            let mut apart = f64::INFINITY;
            for &other in around {
                let distance = (features[k].place - features[other].place).norm();
                if distance < apart {
                    let ((c, s, total), (d, t, _)) = (ways[k], ways[other]);
                    let way = (s - t).abs().min(total - (s - t).abs());
                    // Along one curve, places far from each other on it count.
                    if c != d || way > 4.0 * distance {
                        apart = distance;
                    }
                }
            }
            features[k].apart = apart;
        }
        features
    }

    /// Displacement of a front by coefficients of the modes, as a function of its parameter.
    fn displacement<'a>(&self, front: usize, space: ModeSpace, step: &'a [f64]) -> impl Fn(f64) -> f64 + use<'a> {
        let modes = self.modes(front, space);
        let offset = self.mode_offsets(space)[front];
        move |s| {
            let mut sum = 0.0;
            modes.for_each_at(s, |mode, value, _| sum += value * step[offset + mode]);
            sum
        }
    }

    /// The fronts moved by `step` on the same parameter, without any check: for derivatives with respect to the shape.
    pub fn displaced(&self, space: ModeSpace, step: &[f64]) -> Self {
        let curves = self
            .curves
            .iter()
            .enumerate()
            .map(|(i, c)| {
                let w = self.displacement(i, space, step);
                c.offset(4 * c.knots(), |p| w(p.s))
            })
            .collect();
        self.with_curves(&self.grid, curves)
    }

    /// Whether the curves are simple, apart, and alternate between fronts and holes from the outside in.
    fn is_valid(curves: &[ClosedCurve]) -> bool {
        let boxes: Vec<Aabb<2>> = curves.iter().map(|c| bounding_box(c.samples())).collect();
        let simple = |c: &ClosedCurve| polygon::self_crossing(c.samples()).is_none();
        curves.iter().all(simple)
            && curves.iter().enumerate().all(|(i, a)| {
                let mut depth = 0;
                for (j, b) in curves.iter().enumerate() {
                    if i == j || (0..2).any(|k| boxes[i].max[k] < boxes[j].min[k] || boxes[j].max[k] < boxes[i].min[k])
                    {
                        continue;
                    }
                    let mut inside = a.samples().iter().map(|x| polygon::winding_number(b.samples(), x));
                    let first = inside.next().unwrap_or(0);
                    if inside.any(|w| w != first) {
                        return false;
                    }
                    depth += first;
                }
                depth == i32::from(a.is_hole())
            })
    }

    /// The fronts that are kept and those along outlines found on a raster; outlines too small to hold a front are dropped.
    fn from_outlines(
        grid: &Grid<2>,
        mut kept: Vec<(Side, ClosedCurve)>,
        side: Side,
        outlines: &[Vec<Point<2>>],
        least: f64,
    ) -> Self {
        for outline in outlines.iter().filter(|o| polygon::signed_area(o).abs() > least * grid.h().powi(2)) {
            let knots = Self::knots(grid, polygon::perimeter(outline) / grid.h());
            kept.push((side, ClosedCurve::along(outline, Self::front_degree(grid), knots)));
        }
        Self::new(grid, kept)
    }

    /// Joins the raster of a function to the zone by `combine`, or adds its outlines as curves of their own where they
    /// keep clear of the fronts.
    fn combined(
        &self,
        grid: &Grid<2>,
        side: Side,
        f: &mut dyn FnMut(&Point<2>) -> f64,
        reverse: bool,
        combine: fn(f64, f64) -> f64,
    ) -> Self {
        let other = Raster::of_function(grid, f);
        let mut outlines = other.outlines();
        if reverse {
            for outline in &mut outlines {
                outline.reverse();
            }
        }
        let clear = outlines
            .iter()
            .flatten()
            .all(|x| self.curves.iter().flat_map(|c| c.samples()).all(|y| (x - y).norm() > 0.75 * grid.h()));
        if clear {
            let zone = Self::from_outlines(grid, self.fronts(), side, &outlines, 1e-3);
            if Self::is_valid(&zone.curves) {
                return zone;
            }
        }
        let (own, others): (Vec<_>, Vec<_>) = self.fronts().into_iter().partition(|f| f.0 == side);
        let own: Vec<ClosedCurve> = own.into_iter().map(|f| f.1).collect();
        let mut raster = Raster::of_curves(grid, &own);
        raster.combine(&other, combine);
        Self::from_outlines(grid, others, side, &raster.outlines(), COLLAPSED)
    }
}

impl Division<2> for PlaneZone {
    fn fronts_in(&self, b: &Aabb<2>) -> FrontsInCell<'_, 2> {
        self.fronts_within(b, 0.0)
    }
}

impl Zone<2> for PlaneZone {
    fn empty(grid: &Grid<2>) -> Self {
        Self::new(grid, Vec::new())
    }
    fn is_empty(&self) -> bool {
        self.curves.is_empty()
    }
    fn counts(&self) -> (usize, usize) {
        let holes = self.hole.iter().filter(|h| **h).count();
        (self.curves.len() - holes, holes)
    }
    fn side_of(&self, zone: usize) -> Side {
        let outer = (0..self.curves.len()).find(|&i| !self.hole[i] && self.number[i] == zone);
        outer.map_or(Side::Below, |i| self.sides[i])
    }
    fn holes_of(&self, zone: usize) -> usize {
        (0..self.curves.len())
            .filter(|&i| self.hole[i])
            .filter(|&i| {
                let x = &self.curves[i].samples()[0];
                let around = (0..self.curves.len())
                    .filter(|&j| j != i && polygon::winding_number(self.curves[j].samples(), x) != 0);
                contact_of(self.region_within(around)).is_some_and(|c| c.1 == zone)
            })
            .count()
    }

    fn foot(&self, front: usize, x: &Point<2>, space: ModeSpace) -> FrontFoot<2> {
        let seeds = self.seeds(self.grid.cell_containing(x), front);
        let foot = match seeds.is_empty() {
            true => self.curves[front].closest(x, 0..self.curves[front].samples().len()),
            false => self.curves[front].closest(x, seeds.into_iter()),
        };
        let offset = self.mode_offsets(space)[front];
        // The normal lies to the right of the direction of travel.
        let along = Vector::<2>::new(-foot.normal[1], foot.normal[0]) / foot.speed;
        let mut modes = Vec::new();
        self.modes(front, space).for_each_at(foot.s, |mode, value, slope| {
            modes.push((offset + mode, value, along * slope));
        });
        FrontFoot {
            position: foot.position,
            parameter: foot.s.rem_euclid(1.0),
            normal: foot.normal,
            curvature: foot.curvature,
            modes,
        }
    }
    fn front_count(&self) -> usize {
        self.curves.len()
    }
    fn mode_offsets(&self, space: ModeSpace) -> Vec<usize> {
        let mut offsets = vec![0];
        for i in 0..self.curves.len() {
            offsets.push(offsets[i] + self.modes(i, space).count());
        }
        offsets
    }
    fn stiffness(&self, space: ModeSpace, front: usize, weight: f64) -> Vec<Clique> {
        let offset = self.mode_offsets(space)[front];
        let modes = self.modes(front, space);
        let curve = &self.curves[front];
        let points = curve.samples().len();
        let at = |k: usize| {
            let s = curve.sample_parameter(k);
            let (mut numbers, mut slopes) = (Vec::new(), Vec::new());
            modes.for_each_at(s, |mode, _, slope| {
                numbers.push((offset + mode) as u32);
                slopes.push(slope);
            });
            let factor = weight / curve.point(s).speed / points as f64;
            let products = slopes.iter().flat_map(|a| slopes.iter().map(move |b| factor * a * b)).collect();
            (numbers, products)
        };
        (0..points).map(at).collect()
    }

    fn advanced(&self, grid: &Grid<2>, space: ModeSpace, step: &[f64], reach: f64) -> Advance<Self> {
        let (moved, mode_counts): (Vec<ClosedCurve>, Vec<usize>) = self
            .curves
            .iter()
            .enumerate()
            .map(|(i, c)| {
                let w = self.displacement(i, space, step);
                // Modes of degree 1 are as long as a step may be, and have no such tips.
                let tips = self.sizing.as_ref().filter(|_| grid.degree() > 1 && self.relative_length(c) >= LONG);
                let limited = |p: &CurvePoint| {
                    let (w, reach) = match tips {
                        None => (w(p.s), reach),
                        Some(sizing) => (swept(w(p.s), p.curvature), reach.min(FARTHEST * sizing.at(&p.position))),
                    };
                    // Towards the centre of curvature the front would fold.
                    let room = (1.0 - FOLD) / p.curvature.abs().max(f64::MIN_POSITIVE);
                    let (inward, outward) = if p.curvature > 0.0 { (room, reach) } else { (reach, room) };
                    w.clamp(-inward.min(reach), outward.min(reach))
                };
                let modes = self.mode_counts[i];
                let moved = c.offset(SPLIT * modes, limited);
                let wanted = Self::knots(grid, self.relative_length(&moved));
                let even = moved.unevenness() <= (1.0 + STRETCH) * c.unevenness();
                let farthest = (0..modes).map(|k| w(k as f64 / modes as f64).abs()).fold(0.0, f64::max);
                let differs = wanted.abs_diff(modes) as f64;
                if differs <= STRETCH * modes as f64 && even && farthest < CLOSE * grid.h() {
                    return (moved, modes);
                }
                // A number that goes up and down with every step is another problem each time, and at degree 1 much another.
                let linear = grid.degree() == 1 && self.sizing.is_some();
                let similar = linear && differs <= (KEPT * modes as f64).max(1.0);
                let kept = if similar { modes } else { wanted };
                (self.redrawn(&c.offset(4 * modes, limited), kept), kept)
            })
            .unzip();
        let collapsed = |c: &ClosedCurve| polygon::signed_area(c.samples()).abs() < COLLAPSED * grid.h().powi(2);
        let turned = moved.iter().zip(&self.hole).any(|(c, &hole)| c.is_hole() != hole);
        if !turned && !moved.iter().any(collapsed) && Self::is_valid(&moved) {
            let zone = Self { mode_counts, ..self.with_curves(grid, moved) };
            return Advance { zone, topology_changed: false };
        }
        let raster = if self.sizing.is_some() { sizing::coarsened(grid, MOST_SAMPLES) } else { grid.clone() };
        let grid = &raster;
        let zone = Side::BOTH.into_iter().fold(Self::empty(grid), |zone, side| {
            let of_side = self.sides.iter().zip(&moved).filter(|(s, _)| **s == side);
            let curves: Vec<ClosedCurve> = of_side.map(|(_, c)| c.clone()).collect();
            if curves.is_empty() {
                return zone;
            }
            let outlines = Raster::of_curves(grid, &curves).outlines();
            Self::from_outlines(grid, zone.fronts(), side, &outlines, COLLAPSED)
        });
        Advance { zone, topology_changed: true }
    }

    fn transported(
        &self,
        grid: &Grid<2>,
        space: ModeSpace,
        step: &[f64],
        reach: f64,
        transport: Transport,
    ) -> Advance<Self> {
        let carried_from = match transport {
            Transport::Exact => return self.advanced(grid, space, step, reach),
            Transport::Redistancing => self.advanced(grid, space, step, reach).zone,
            Transport::HamiltonJacobi => self.clone(),
        };
        let zone = Side::BOTH.into_iter().fold(Self::empty(grid), |zone, side| {
            let fronts: Vec<usize> =
                (0..carried_from.curves.len()).filter(|&i| carried_from.sides[i] == side).collect();
            if fronts.is_empty() {
                return zone;
            }
            // The nearest front: its signed distance, negative in the zone, its number, and where along it.
            let nearest = |x: &Point<2>| {
                let of = |&i: &usize| {
                    let curve = &carried_from.curves[i];
                    let (distance, foot) = curve.signed_distance(x, 0..curve.samples().len());
                    (distance, i, foot.s)
                };
                let closer = |a: &(f64, usize, f64), b: &(f64, usize, f64)| a.0.abs().total_cmp(&b.0.abs());
                fronts.iter().map(of).min_by(closer).unwrap_or((f64::INFINITY, 0, 0.0))
            };
            let mut level_set = NodalLevelSet::of(grid, |x| nearest(x).0);
            if transport == Transport::HamiltonJacobi {
                let moved: Vec<_> = (0..self.curves.len()).map(|i| self.displacement(i, space, step)).collect();
                level_set = level_set.carried(|x| {
                    let (_, front, s) = nearest(x);
                    moved[front](s).clamp(-reach, reach)
                });
            }
            // A curve that follows the level set from node to node, not one of the modes.
            let outlines = level_set.outlines();
            let large = outlines.iter().filter(|o| polygon::signed_area(o).abs() > COLLAPSED * grid.h().powi(2));
            let along = |o: &Vec<Point<2>>| {
                let knots = (polygon::perimeter(o) / grid.h()).max(FEWEST_KNOTS).ceil() as usize;
                (side, ClosedCurve::along(o, LEVEL_SET_DEGREE, knots))
            };
            Self::new(grid, zone.fronts().into_iter().chain(large.map(along)).collect())
        });
        Advance { topology_changed: zone.counts() != self.counts(), zone }
    }

    // As finely as the zone is told, which may be on smaller cells than the next solve begins with.
    fn extrapolated(&self, grid: &Grid<2>, before: &[(&Self, f64)]) -> Option<Self> {
        if before.iter().any(|(zone, _)| zone.hole != self.hole || zone.sides != self.sides) {
            return None;
        }
        let mut moved = Vec::with_capacity(self.curves.len());
        let mut farthest = 0.0f64;
        for (i, now) in self.curves.iter().enumerate() {
            let ahead = |x: &Point<2>| -> f64 {
                let way = |zone: &Self| {
                    let then = &zone.curves[i];
                    then.signed_distance(x, 0..then.samples().len()).0
                };
                before.iter().map(|(zone, multiple)| multiple * way(zone)).sum()
            };
            // Fronts that have little to do with each other, or sharp ones, are better left where they are.
            let mut small = |p: &CurvePoint| {
                let w = ahead(&p.position);
                farthest = farthest.max(w.abs());
                w.abs() < 2.0 * grid.h() && -w * p.curvature < 1.0 - FOLD
            };
            if !(0..now.samples().len()).all(|k| small(&now.point(now.sample_parameter(k)))) {
                return None;
            }
            let n = 4 * now.knots();
            let mut ways: Vec<f64> = (0..n).map(|k| ahead(&now.position(k as f64 / n as f64))).collect();
            if self.grid.degree() == 1 {
                // Waves as short as the cells of a state come and go with these: from one state to another they only add up.
                ways = without_waves(&ways, n / self.mode_counts[i]);
            }
            let curve = now.offset(n, |p| ways[(p.s * n as f64).round() as usize % n]);
            // The next cells have sizes of their own, and modes too.
            moved.push(if now.unevenness() > CROWDED {
                curve
            } else {
                curve.by_arc_length(Self::knots(&self.grid, polygon::perimeter(curve.samples()) / self.grid.h()))
            });
        }
        if farthest < SAME * self.grid.h() {
            return Some(self.clone());
        }
        Self::is_valid(&moved).then(|| self.with_curves(&self.grid, moved))
    }

    fn farthest_from(&self, other: &Self, size: &dyn Fn(&Point<2>) -> f64) -> Option<f64> {
        if other.hole != self.hole || other.sides != self.sides {
            return None;
        }
        let of_curve = |(own, other): (&ClosedCurve, &ClosedCurve)| {
            let way = |x: &Point<2>| other.signed_distance(x, 0..other.samples().len()).0.abs() / size(x);
            own.samples().iter().map(way).fold(0.0, f64::max)
        };
        Some(self.curves.iter().zip(&other.curves).map(of_curve).fold(0.0, f64::max))
    }

    fn within(grid: &Grid<2>, sizing: &Arc<Sizing<2>>, outlines: &[(Side, Vec<Point<2>>)]) -> Self {
        let along = |(side, outline): &(Side, Vec<Point<2>>)| {
            let relative: f64 =
                polygon::edges(outline).map(|(a, b)| (b - a).norm() / sizing.at(&(0.5 * (a + b)))).sum();
            let knots = Self::knots(grid, relative);
            let degree = Self::front_degree(grid);
            (*side, ClosedCurve::evenly_along(outline, degree, knots, |x| 1.0 / sizing.at(x)))
        };
        let has_shape = |(_, outline): &&(Side, Vec<Point<2>>)| {
            let centre = outline.iter().sum::<Point<2>>() / outline.len() as f64;
            polygon::signed_area(outline).abs() > SHAPELESS * sizing.at(&centre).powi(2)
        };
        let curves = outlines.iter().filter(has_shape).map(along).collect();
        Self { sizing: Some(sizing.clone()), ..Self::new(grid, curves) }
    }
    fn united(&self, grid: &Grid<2>, side: Side, f: &mut dyn FnMut(&Point<2>) -> f64) -> Self {
        self.combined(grid, side, f, false, f64::min)
    }
    fn reduced(&self, grid: &Grid<2>, f: &mut dyn FnMut(&Point<2>) -> f64) -> Self {
        let both = Side::BOTH.iter().all(|side| self.sides.contains(side));
        Side::BOTH.into_iter().filter(|side| self.sides.contains(side)).fold(self.clone(), |zone, side| {
            let other = |x: &Point<2>| both && contact_of(self.region_at(x)).is_some_and(|c| c.0 != side);
            let mut own = |x: &Point<2>| if other(x) { 1.0 } else { f(x) };
            zone.combined(grid, side, &mut own, true, |zone, removed| zone.max(-removed))
        })
    }
    fn without(&self, grid: &Grid<2>, part: usize) -> Self {
        let Some(outer) = (0..self.curves.len()).find(|&i| !self.hole[i] && self.number[i] == part) else {
            return self.clone();
        };
        let within = |i: usize| {
            self.hole[i] && polygon::winding_number(self.curves[outer].samples(), &self.curves[i].samples()[0]) != 0
        };
        self.keeping(grid, |i| i != outer && !within(i))
    }
    fn filled(&self, grid: &Grid<2>, closes: &dyn Fn(Side, &[Point<2>], f64) -> bool) -> Option<Self> {
        let empty = |i: usize| {
            let hole = self.curves[i].samples();
            let within = |c: &ClosedCurve| polygon::winding_number(hole, &c.samples()[0]) != 0;
            (0..self.curves.len()).all(|j| j == i || !within(&self.curves[j]))
        };
        let closing =
            |i: usize| self.hole[i] && closes(self.sides[i], self.curves[i].samples(), self.areas[i]) && empty(i);
        let kept: Vec<bool> = (0..self.curves.len()).map(|i| !closing(i)).collect();
        kept.contains(&false).then(|| self.keeping(grid, |i| kept[i]))
    }
    fn seeded(&self, grid: &Grid<2>, side: Side, x: &Point<2>, radius: f64) -> Self {
        let circle: Vec<Point<2>> = (0..SEED_KNOTS)
            .map(|i| {
                let (sin, cos) = (std::f64::consts::TAU * i as f64 / SEED_KNOTS as f64).sin_cos();
                x + radius * Point::<2>::new(cos, sin)
            })
            .collect();
        let mut fronts = self.fronts();
        fronts.push((side, ClosedCurve::through(&circle, Self::front_degree(grid))));
        let zone = Self::new(grid, fronts);
        if Self::is_valid(&zone.curves) { zone } else { self.clone() }
    }
    fn distance(&self, x: &Point<2>, within: f64) -> f64 {
        let apart = |c: usize, s: usize| (self.curves[c].samples()[s] - x).norm();
        let Some(sizing) = &self.sizing else {
            let near = self.near(self.grid.cell_containing(x)).iter();
            return near.map(|&(c, s)| apart(c as usize, s as usize)).fold(f64::INFINITY, f64::min);
        };
        let reach = Point::<2>::repeat(within.min(sizing.at(x)));
        let near = self.near_box(&Aabb::new(x - reach, x + reach));
        near.into_iter()
            .flat_map(|(c, seeds)| seeds.into_iter().map(move |s| (c, s)))
            .map(|(c, s)| apart(c, s))
            .fold(f64::INFINITY, f64::min)
    }
    fn region_at(&self, x: &Point<2>) -> RegionId {
        let cell = self.grid.cell_containing(x);
        let near = self.curves_near(cell);
        let close = near.iter().copied().filter(|&c| {
            let (d, _) = self.curves[c].signed_distance(x, self.seeds(cell, c).into_iter());
            self.encloses(c, d)
        });
        let far = self.around(cell).into_iter().filter(|c| !near.contains(c)).collect::<Vec<_>>();
        self.region_within(far.into_iter().chain(close.collect::<Vec<_>>()))
    }
    fn by_multigrid(
        membrane: &Membrane<2>,
        at: (usize, f64),
        progress: &mut dyn Progress,
    ) -> Result<Option<Solution<2, Self>>, SolveError> {
        if membrane.cells.function_count() < multigrid::LARGE {
            return Ok(None);
        }
        multigrid::nested::solution(membrane, at, progress)
    }
    fn to_json(&self) -> Value {
        let curves = self.sides.iter().zip(&self.curves).zip(&self.mode_counts).map(|((side, c), modes)| {
            json!({
                "above": *side == Side::Above, "degree": c.degree(), "modes": modes, "coefficients": c.coefficients(),
            })
        });
        json!({"cells": self.grid.cells(), "degree": self.grid.degree(), "curves": curves.collect::<Vec<_>>()})
    }
    fn from_json(grid: &Grid<2>, value: &Value) -> Option<Self> {
        let cells: [usize; 2] = serde_json::from_value(value["cells"].clone()).ok()?;
        let degree = value["degree"].as_u64().filter(|d| (1..=8).contains(d))? as usize;
        let finer = cells[0].checked_div(grid.cells()[0]).filter(|n| (1..=256).contains(n))?;
        if cells != grid.cells().map(|n| n * finer) {
            return None;
        }
        let curve = |v: &Value| {
            let coefficients: Vec<[f64; 2]> = serde_json::from_value(v["coefficients"].clone()).ok()?;
            let side = if v["above"].as_bool()? { Side::Above } else { Side::Below };
            let modes = v["modes"].as_u64().filter(|&m| (1..=coefficients.len() as u64).contains(&m))? as usize;
            Some(((side, ClosedCurve::from_coefficients(v["degree"].as_u64()? as usize, coefficients)?), modes))
        };
        let curves = value["curves"].as_array()?.iter().map(curve).collect::<Option<Vec<_>>>()?;
        let (curves, mode_counts) = curves.into_iter().unzip();
        Some(Self { mode_counts, ..Self::new(&Grid::new(*grid.bounds(), cells, degree), curves) })
    }
    fn least_feature(&self) -> f64 {
        let features = self.features(&self.grid, 0.0);
        features.iter().map(|f| f.apart.min(1.0 / f.curvature)).fold(f64::INFINITY, f64::min)
    }
    fn on_grid(&self, grid: &Grid<2>) -> Self {
        let fit = |(c, &modes): (&ClosedCurve, &usize)| {
            let wanted = Self::knots(grid, polygon::perimeter(c.samples()) / grid.h());
            let degree = Self::front_degree(grid);
            // A front that has moved far enough for its knots to crowd gets new ones.
            let same = wanted == modes && c.degree() == degree;
            if same && (c.knots() == modes || c.unevenness() < CROWDED) {
                (c.clone(), modes)
            } else {
                (ClosedCurve::along(c.samples(), degree, wanted), wanted)
            }
        };
        let (curves, mode_counts) = self.curves.iter().zip(&self.mode_counts).map(fit).unzip();
        Self { mode_counts, sizing: None, ..self.with_curves(grid, curves) }
    }
    fn on_sizes(&self, grid: &Grid<2>, sizing: &Arc<Sizing<2>>) -> Self {
        let sized = Self { sizing: Some(sizing.clone()), grid: grid.clone(), ..self.clone() };
        let degree = Self::front_degree(grid);
        let fit = |c: &ClosedCurve| {
            let wanted = Self::knots(grid, sized.relative_length(c));
            if c.degree() == degree {
                return sized.redrawn(c, wanted);
            }
            ClosedCurve::evenly_along(c.samples(), degree, wanted, |x| 1.0 / sizing.at(x))
        };
        sized.with_curves(grid, self.curves.iter().map(fit).collect())
    }
    fn sizing(&self, grid: &Grid<2>, [least, most]: [usize; 2], finer: usize) -> Option<Sizing<2>> {
        let divided = |times: usize| grid.h() / f64::from(1u32 << times);
        let places = self.features(grid, divided(most));
        let wanted = |feature: &Feature| {
            let here = self.sizing.as_ref().map_or(self.grid.h(), |s| s.at(&feature.place));
            let blunted = (BLUNTED * feature.curvature * here).max(1.0);
            let curved = if grid.degree() == 1 { CURVED_LINEAR } else { CURVED };
            let size = (1.0 / (curved * feature.curvature * blunted)).min(feature.apart / BETWEEN);
            (size / f64::from(1u32 << finer)).clamp(divided(most), divided(least))
        };
        if places.iter().all(|f| wanted(f) >= grid.h()) {
            return None;
        }
        Some(Sizing::new(places.iter().map(|f| (f.place, f.length, wanted(f)))))
    }
    fn bend(&self) -> f64 {
        (0..self.curves.len()).map(|c| self.bend_of(c)).fold(0.0, f64::max)
    }
    fn fronts_are_long(&self) -> bool {
        self.curves.iter().all(|curve| self.relative_length(curve) >= LONG)
    }
    fn has_tips(&self, bend: f64) -> bool {
        let mut sharp = (0..self.curves.len()).filter(|c| self.bend_of(*c) >= bend).peekable();
        sharp.peek().is_some() && sharp.all(|c| self.relative_length(&self.curves[c]) >= LONG)
    }
    fn divided(
        &self,
        cells: &Arc<dyn Cells<2>>,
        sizing: &Sizing<2>,
        most: usize,
        also: &dyn Fn(&Aabb<2>, usize) -> bool,
    ) -> Option<Arc<dyn Cells<2>>> {
        let edges: Vec<_> = self.curves.iter().flat_map(|c| polygon::edges(c.samples())).collect();
        if let Some(mesh) = cells.clone().mesh() {
            let mut places = Vec::new();
            for (a, b) in edges {
                let size = sizing.largest(&(0.5 * (a + b)));
                let parts = ((b - a).norm() / size).ceil().max(1.0);
                places.extend((0..parts as usize).map(|k| (a + (b - a) * (k as f64 / parts), size)));
            }
            return Some(Arc::new(mesh.graded(&places, most, also)?));
        }
        let grid = cells.as_grid()?;
        let divisions: Vec<usize> =
            edges.iter().map(|(a, b)| sizing.divisions(&(0.5 * (*a + *b)), grid.h()).min(most)).collect();
        // Of each level the cells of that size within two of them from a front that wants smaller ones.
        let near: Vec<HashSet<[i64; 2]>> = (0..most)
            .map(|level| {
                let size = grid.cell_size() / f64::from(1u32 << level);
                let mut found = HashSet::new();
                for ((a, b), _) in edges.iter().copied().zip(&divisions).filter(|(_, times)| **times > level) {
                    let parts = ((b - a).norm() / size.min()).ceil().max(1.0);
                    for k in 0..parts as usize {
                        let x = a + (b - a) * (k as f64 / parts);
                        let at = [0, 1].map(|k| ((x[k] - grid.bounds().min[k]) / size[k]).floor() as i64);
                        for i in 0..25 {
                            found.insert([at[0] + i % 5 - 2, at[1] + i / 5 - 2]);
                        }
                    }
                }
                found
            })
            .collect();
        let wanted = |b: &Aabb<2>, level: usize| {
            let x = b.center();
            let size = b.size();
            let at = [0, 1].map(|k| ((x[k] - grid.bounds().min[k]) / size[k]).floor() as i64);
            near.get(level).is_some_and(|cells| cells.contains(&at)) || also(b, level)
        };
        Some(Arc::new(RefinedGrid::new(grid, wanted)))
    }
    fn sharpest(&self) -> f64 {
        self.curves.iter().flat_map(curvatures).fold(0.0, f64::max)
    }
    fn outlines(&self) -> Vec<Vec<Point<2>>> {
        self.curves.iter().map(|c| c.samples().to_vec()).collect()
    }
}

/// What the cells at a place along a front have to resolve.
struct Feature {
    place: Point<2>,
    /// The length of front that it stands for.
    length: f64,
    curvature: f64,
    /// The distance to another front, or to a part of the same one that is far along it; infinite beyond two cells.
    apart: f64,
}

/// The points of a curve at its knots.
fn at_knots(curve: &ClosedCurve) -> impl Iterator<Item = CurvePoint> + '_ {
    let knots = curve.knots();
    (0..knots).map(move |k| curve.point(k as f64 / knots as f64))
}

/// Values evenly round a curve without their waves of a length, given in values: they are gone, those twice as long are halved.
fn without_waves(values: &[f64], length: usize) -> Vec<f64> {
    let n = values.len();
    if length == 0 || 2 * length > n {
        return values.to_vec();
    }
    let bell: Vec<f64> =
        (0..2 * length).map(|k| 1.0 - (std::f64::consts::PI * k as f64 / length as f64).cos()).collect();
    let mean = |i: usize| bell.iter().enumerate().map(|(k, w)| w * values[(i + n + k - length) % n]).sum::<f64>();
    (0..n).map(|i| mean(i) / (2 * length) as f64).collect()
}

/// The curvatures of a curve at its samples, without their signs.
fn curvatures(curve: &ClosedCurve) -> impl Iterator<Item = f64> + '_ {
    (0..curve.samples().len()).map(|i| curve.point(curve.sample_parameter(i)).curvature.abs())
}

/// How far a tip moves away from its centre of curvature to sweep as much area as a straight front does in a step: the load on
/// what is swept balances the slope jump.
fn swept(step: f64, curvature: f64) -> f64 {
    2.0 * step / (1.0 + (1.0 + 2.0 * (curvature * step).max(0.0)).sqrt())
}

/// The smallest box round points.
fn bounding_box(points: &[Point<2>]) -> Aabb<2> {
    points.iter().fold(Aabb::new(points[0], points[0]), |b, p| Aabb::new(b.min.inf(p), b.max.sup(p)))
}

/// For cells near curves, pairs of curve and sample in or next to them.
#[derive(Clone, Debug)]
struct NearFronts {
    /// Ascending, and where the pairs of each begin and end.
    cells: Vec<u32>,
    begin: Vec<u32>,
    pairs: Vec<(u32, u32)>,
}

impl NearFronts {
    fn new(grid: &Grid<2>, curves: &[ClosedCurve]) -> Self {
        let (bounds, size, cells) = (grid.bounds(), grid.cell_size(), grid.cells());
        let mut all: Vec<(u32, u32, u32)> = Vec::new();
        for (c, curve) in curves.iter().enumerate() {
            for (s, (a, b)) in polygon::edges(curve.samples()).enumerate() {
                // Samples may be further from each other than the smallest cells are large.
                let parts = ((b - a).component_div(&size).amax().ceil()).max(1.0);
                for part in 0..parts as usize {
                    let x = a + (b - a) * (part as f64 / parts);
                    let at: [isize; 2] = std::array::from_fn(|k| ((x[k] - bounds.min[k]) / size[k]).floor() as isize);
                    let range = |k: usize| (at[k] - 1).max(0)..(at[k] + 2).min(cells[k] as isize);
                    for j in range(1) {
                        for i in range(0) {
                            all.push((grid.cell_at([i as usize, j as usize]) as u32, c as u32, s as u32));
                        }
                    }
                }
            }
        }
        all.sort_unstable();
        all.dedup();
        let mut near = Self { cells: Vec::new(), begin: vec![0], pairs: Vec::with_capacity(all.len()) };
        for (cell, curve, sample) in all {
            if near.cells.last() != Some(&cell) {
                near.cells.push(cell);
                near.begin.push(near.pairs.len() as u32);
            }
            near.pairs.push((curve, sample));
            if let Some(end) = near.begin.last_mut() {
                *end = near.pairs.len() as u32;
            }
        }
        near
    }

    /// Those of all cells of a row from one to another, cell by cell.
    fn between(&self, first: usize, last: usize) -> &[(u32, u32)] {
        let from = self.cells.partition_point(|&cell| (cell as usize) < first);
        let to = from + self.cells[from..].partition_point(|&cell| cell as usize <= last);
        &self.pairs[self.begin[from] as usize..self.begin[to] as usize]
    }
}

/// For each row of cells the stretches whose centres a curve encloses, by the crossings of the curve with the line through
/// these.
fn rows_enclosed(grid: &Grid<2>, curves: &[ClosedCurve]) -> Vec<Vec<[u32; 3]>> {
    let cells = grid.cells();
    let mut rows = vec![Vec::new(); cells[1]];
    let (bounds, size) = (grid.bounds(), grid.cell_size());
    for (c, curve) in curves.iter().enumerate() {
        let mut crossings = vec![Vec::new(); cells[1]];
        for (a, b) in polygon::edges(curve.samples()) {
            let row = |y: f64| ((y - bounds.min[1]) / size[1] - 0.5).ceil().max(0.0) as usize;
            let (low, high) = (a[1].min(b[1]), a[1].max(b[1]));
            for j in row(low)..row(high).min(cells[1]) {
                let y = bounds.min[1] + (j as f64 + 0.5) * size[1];
                crossings[j].push(a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]));
            }
        }
        for (row, mut xs) in rows.iter_mut().zip(crossings) {
            xs.sort_by(f64::total_cmp);
            for pair in xs.chunks_exact(2) {
                let column = |x: f64| ((x - bounds.min[0]) / size[0] - 0.5).ceil().max(0.0) as usize;
                let (from, to) = (column(pair[0]), column(pair[1]).min(cells[0]));
                if from < to {
                    row.push([from as u32, to as u32, c as u32]);
                }
            }
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Else it would go up and down with the length of the front, and the front with it.
    #[test]
    fn the_number_of_modes_stays_while_it_will_do() {
        let bounds = Aabb::new(Point::<2>::new(-1.0, -1.0), Point::<2>::new(1.0, 1.0));
        let grid = Grid::new(bounds, [40, 40], 1);
        let h = grid.h();
        let circle: Vec<Point<2>> = (0..48)
            .map(|i| std::f64::consts::TAU * f64::from(i) / 48.0)
            .map(|a| 0.5 * Point::<2>::new(a.cos(), a.sin()))
            .collect();
        let places = circle.iter().map(|x| (*x, std::f64::consts::PI / 48.0, h));
        let sizing = Arc::new(Sizing::new(places));
        let zone = PlaneZone::new(&grid, vec![(Side::Below, ClosedCurve::through(&circle, 7))]);
        let zone = zone.on_sizes(&grid, &sizing);
        let count = |zone: &PlaneZone| zone.mode_offsets(ModeSpace::Fine)[1];
        let moved = |by: f64| {
            let step = vec![by; count(&zone)];
            zone.advanced(&grid, ModeSpace::Fine, &step, 1.0).zone
        };
        let wanted = |zone: &PlaneZone| PlaneZone::knots(&grid, zone.relative_length(&zone.curves[0]));
        let modes = count(&zone);
        // Steps after which a front does not keep its parameter, and that would have it get one mode more or less.
        for (direction, other) in [(1.0, modes + 1), (-1.0, modes - 1)] {
            let steps = (1..40).map(|k| moved(0.05 * direction * f64::from(k) * h));
            let longer = steps.into_iter().find(|zone| wanted(zone) == other).expect("a mode more or less");
            assert_eq!(count(&longer), modes);
        }
        // A front that has become much longer gets what it wants.
        let far = moved(0.25);
        assert_eq!(count(&far), wanted(&far));
    }

    /// A circle with a wave on it.
    fn waved(grid: &Grid<2>, radius: f64, waves: usize, height: f64) -> PlaneZone {
        let points: Vec<Point<2>> = (0..40 * waves)
            .map(|i| std::f64::consts::TAU * i as f64 / (40 * waves) as f64)
            .map(|a| (radius + height * (waves as f64 * a).cos()) * Point::<2>::new(a.cos(), a.sin()))
            .collect();
        PlaneZone::new(grid, vec![(Side::Below, ClosedCurve::through(&points, 7))]).on_grid(grid)
    }

    fn square(degree: usize) -> Grid<2> {
        Grid::new(Aabb::new(Point::<2>::new(-1.0, -1.0), Point::<2>::new(1.0, 1.0)), [40, 40], degree)
    }

    #[test]
    fn fronts_go_on_the_way_that_they_went() {
        for (degree, part) in [(1, 0.06), (2, 0.03)] {
            let grid = square(degree);
            let [before, now, next] = [0.52, 0.5, 0.48].map(|radius| waved(&grid, radius, 4, 0.1 * (1.0 - radius)));
            let ahead = now.extrapolated(&grid, &[(&before, 1.0)]).expect("two fronts that are alike");
            let far = ahead.farthest_from(&next, &|_| 1.0).expect("as many fronts");
            let gone = now.farthest_from(&next, &|_| 1.0).expect("as many fronts");
            assert!((gone - 0.022).abs() < 1e-3 && far < part * gone, "degree {degree}: {far} after {gone}");
            assert!(now.farthest_from(&PlaneZone::empty(&grid), &|_| 1.0).is_none());
        }
    }

    /// What cells of degree 1 leave on a front differs from state to state, and would be there threefold.
    #[test]
    fn waves_as_short_as_cells_do_not_grow() {
        let more = |degree: usize| {
            let (grid, height, waves) = (square(degree), 1e-3, 8);
            let [before, now] = [(0.52, -height), (0.5, height)].map(|(r, height)| waved(&grid, r, waves, height));
            let ahead = now.extrapolated(&grid, &[(&before, 1.0)]).expect("two fronts that are alike");
            ahead.farthest_from(&waved(&grid, 0.48, waves, height), &|_| 1.0).expect("as many fronts") / height
        };
        assert!(more(1) < 1.3 && more(2) > 1.7, "{} {}", more(1), more(2));
        let wave = |length: usize| move |k: usize| (std::f64::consts::TAU * k as f64 / length as f64).cos();
        let values: Vec<f64> = (0..240).map(|k| 2.0 + wave(12)(k) + wave(24)(k)).collect();
        for (k, value) in without_waves(&values, 12).iter().enumerate() {
            assert!((value - 2.0 - 0.5 * wave(24)(k)).abs() < 1e-14);
        }
    }

    #[test]
    fn tips_sweep_what_straight_fronts_do() {
        for (step, curvature) in [(0.1, 3.0), (2.0, 5.0), (-0.2, -40.0)] {
            let w = swept(step, curvature);
            assert!((w * (1.0 + 0.5 * curvature * w) - step).abs() < 1e-14 * step.abs().max(1.0), "{w}");
        }
        // Towards the centre of curvature, and on straight fronts, nothing changes.
        assert_eq!([swept(-0.1, 3.0), swept(0.1, -3.0), swept(0.3, 0.0)], [-0.1, 0.1, 0.3]);
    }
}
