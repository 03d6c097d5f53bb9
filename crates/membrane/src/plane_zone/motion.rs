//! Fronts that are moved by a step.

use super::topology::COLLAPSED;
use super::{FEWEST_KNOTS, LEVEL_SET_DEGREE, LONG, PlaneZone, SPLIT};
use crate::method::{ModeSpace, Transport};
use crate::obstacle::Side;
use crate::published::level_set::NodalLevelSet;
use crate::raster::Raster;
use crate::sizing;
use crate::zone::{Advance, Zone, ZoneMotion};
use signorini_fem::Grid;
use signorini_geometry::{ClosedCurve, CurvePoint, Point, polygon};

/// A front that moves by less than this fraction of a cell keeps its parameter; see [`SPLIT`].
const CLOSE: f64 = 0.01;
/// It gets a new parameter, too, once its length has changed, or its speed differs, by so much.
const STRETCH: f64 = 0.2;
/// After a longer step one on divided cells of degree 1 keeps its number of modes where these would have it differ by one, or by
/// this part of it.
const KEPT: f64 = 0.03;
/// Cells along the longer side of a grid on which fronts that meet are told apart, where the smallest cells are few.
const MOST_SAMPLES: usize = 2048;
/// A step may not bring a tip farther than this many divided cells, beyond which the linear model says nothing.
const FARTHEST: f64 = 4.0;
/// A step may not bring a front nearer to its centre of curvature than this fraction of its radius of curvature.
pub(super) const FOLD: f64 = 0.3;

/// How far a tip moves away from its centre of curvature to sweep as much area as a straight front does in a step: the load on
/// what is swept balances the slope jump.
pub fn swept(step: f64, curvature: f64) -> f64 {
    2.0 * step / (1.0 + (1.0 + 2.0 * (curvature * step).max(0.0)).sqrt())
}

impl ZoneMotion<2> for PlaneZone {
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

    fn extrapolated(&self, grid: &Grid<2>, before: &[(&Self, f64)]) -> Option<Self> {
        self.ahead(grid, before)
    }

    fn farthest_from(&self, other: &Self, size: &dyn Fn(&Point<2>) -> f64) -> Option<f64> {
        self.farthest_way(other, size)
    }
}
