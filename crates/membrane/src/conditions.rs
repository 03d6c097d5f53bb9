//! The contact conditions, checked at every quadrature point, and the sets on which they fail.

use crate::equilibrium::Equilibrium;
use crate::kinks::{Kink, kink};
use crate::obstacle::Side;
use crate::problem::Membrane;
use crate::quadrature::Cell;
use crate::scales::Scales;
use crate::zone::{Zone, contact_index, contact_of, is_free};
use signorini_geometry::Point;

/// Times the tolerance, a penetration that may be put up with where the grid cannot tell whether zones touch.
const NEARLY: f64 = 30.0;
/// Cells within which a place is beside a front.
const BESIDE: f64 = 4.0;

/// How far a state is from the contact conditions with one body.
#[derive(Clone, Copy, Debug)]
pub struct Extremes {
    /// Least gap anywhere in the free membrane, and away from the fronts.
    pub least_gap: f64,
    pub least_gap_outside: f64,
    /// Least and largest pressure in contact.
    pub least_pressure: f64,
    pub largest_pressure: f64,
}

impl Default for Extremes {
    fn default() -> Self {
        let (most, least) = (f64::INFINITY, f64::NEG_INFINITY);
        Self { least_gap: most, least_gap_outside: most, least_pressure: most, largest_pressure: least }
    }
}

impl Extremes {
    /// Takes a gap into account, which may be away from the fronts.
    pub fn add_gap(&mut self, gap: f64, outside: bool) {
        self.least_gap = self.least_gap.min(gap);
        if outside {
            self.least_gap_outside = self.least_gap_outside.min(gap);
        }
    }

    /// Takes a pressure in contact into account.
    pub fn add_pressure(&mut self, pressure: f64) {
        self.least_pressure = self.least_pressure.min(pressure);
        self.largest_pressure = self.largest_pressure.max(pressure);
    }
}

/// How far a state is from the contact conditions.
#[derive(Clone, Debug)]
pub struct Conditions<const D: usize> {
    /// With each body.
    pub extremes: Vec<Extremes>,
    /// Least gap away from the fronts.
    pub least_gap_outside: f64,
    /// The least there in multiples of the penetration that counts as none, and where.
    worst: f64,
    deepest: (Side, Point<D>),
    /// Least pressure with which a body would push where the free membrane penetrates it.
    pub least_pressure_below: f64,
    /// Least pressure in contact where no adhesion holds, and what valleys of the bodies need everywhere.
    pub least_pressure: f64,
    /// The sharpest kink of a body in contact.
    pub kink: Option<Kink<D>>,
    /// A point of a support that the zone covers although the body there lies apart from it.
    pub torn_from_support: Option<Point<D>>,
}

impl<const D: usize> Conditions<D> {
    /// Checks a state in which adhesion holds, or is left out.
    pub fn check<Z: Zone<D>>(equilibrium: &Equilibrium<D>, zone: &Z, scales: &Scales, adhering: bool) -> Self {
        let membrane = &equilibrium.membrane;
        let mut c = Self {
            extremes: vec![Extremes::default(); membrane.obstacles.0.len()],
            least_gap_outside: f64::INFINITY,
            worst: f64::INFINITY,
            deepest: (Side::Below, Point::zeros()),
            least_pressure_below: f64::INFINITY,
            least_pressure: f64::INFINITY,
            kink: None,
            torn_from_support: None,
        };
        for p in &equilibrium.quadrature.rim {
            if let (Some(support), Some((side, _))) = (&membrane.supports[p.piece], contact_of(p.region)) {
                let apart = (support.displacement.value(&p.x) - membrane.obstacles.height(side, &p.x)).abs();
                if apart > 1e-6 * scales.gap {
                    c.torn_from_support = Some(p.x);
                }
            }
        }
        let mut searched = None;
        equilibrium.for_each_point(|cell, region, x, _| {
            if is_free(region) {
                let Some((u, _)) = equilibrium.evaluate(cell, region, x) else { return };
                for side in membrane.obstacles.sides() {
                    let Some(i) = membrane.obstacles.index_at(side, x) else { continue };
                    let gap = side.sign() * (u - membrane.obstacles.0[i].height.value(x));
                    let own = &mut c.extremes[i];
                    own.add_gap(gap, false);
                    if gap < 0.0 {
                        c.least_pressure_below = c.least_pressure_below.min(membrane.pressure(side, x));
                    }
                    let relative = gap / scales.gap_tolerance(membrane.cells.size(cell));
                    if (gap < own.least_gap_outside || relative < c.worst) && is_apart(membrane, zone, x) {
                        let relative = match membrane.sizing {
                            None => relative,
                            Some(_) => gap / scales.gap_tolerance(membrane.cell_size(x)),
                        };
                        own.add_gap(gap, true);
                        c.least_gap_outside = c.least_gap_outside.min(gap);
                        if relative < c.worst {
                            c.worst = relative;
                            c.deepest = (side, *x);
                        }
                    }
                }
            } else if let Some((side, _)) = contact_of(region) {
                let pressure = membrane.pressure(side, x);
                if let Some(i) = membrane.obstacles.index_at(side, x) {
                    c.extremes[i].add_pressure(pressure);
                }
                // What is searched about the points of neighbours covers their cells: one of each is enough, where there are
                // neighbours on all sides.
                let first = searched.replace((cell, region)) != Some((cell, region));
                let search = first || !matches!(equilibrium.quadrature.cells[cell], Cell::Whole(_));
                let size = membrane.cells.size(cell);
                let kink = if search { kink(membrane, zone, side, x, size, adhering) } else { None };
                c.least_pressure = c.least_pressure.min(needed(membrane, side, x, pressure, kink, adhering));
                if kink.is_some_and(|k| c.kink.is_none_or(|worst| k.jump > worst.jump)) {
                    c.kink = kink;
                }
            }
        });
        c
    }

    pub fn penetrates(&self) -> bool {
        self.worst < -1.0
    }

    /// Whether all that is wrong is a penetration not much larger than what counts as none, on cells that are not divided.
    pub fn nearly_hold(&self, scales: &Scales, membrane: &Membrane<D>) -> bool {
        let cell = membrane.cells.containing(&self.deepest.1);
        let divided = f64::from(1u32 << cell.map_or(0, |cell| membrane.cells.divisions(cell)));
        self.worst >= -NEARLY * divided.powi(2) && !self.pulls(scales) && self.torn_from_support.is_none()
    }

    /// The same where that penetration lies beside a front, and may be what the membrane sags between fronts a cell apart.
    pub fn nearly_hold_about<Z: Zone<D>>(&self, zone: &Z, scales: &Scales, membrane: &Membrane<D>) -> bool {
        let (side, deepest) = self.deepest;
        let cell = membrane.cell_size(&deepest);
        let sag = membrane.pressure(side, &deepest) * cell.powi(2) / (8.0 * membrane.tension.value(&deepest));
        let beside = || zone.outlines().iter().flatten().any(|x| (x - deepest).norm() < BESIDE * cell);
        let slight = -self.least_gap_outside < sag && !self.pulls(scales) && self.torn_from_support.is_none();
        (slight || self.nearly_hold(scales, membrane)) && beside()
    }

    /// Whether the contact conditions hold everywhere.
    pub fn hold(&self, scales: &Scales) -> bool {
        !self.penetrates() && !self.pulls(scales) && self.torn_from_support.is_none()
    }

    pub fn pulls(&self, scales: &Scales) -> bool {
        self.least_pressure < -scales.pressure_tolerance()
    }
}

/// Whether a body pushes about a point that it might touch.
pub fn pushes<const D: usize, Z: Zone<D>>(
    membrane: &Membrane<D>,
    zone: &Z,
    side: Side,
    x: &Point<D>,
    size: f64,
) -> bool {
    let kink = kink(membrane, zone, side, x, size, false);
    needed(membrane, side, x, membrane.pressure(side, x), kink, false) > 0.0
}

/// The pressure with which a body must push about a point of contact: that of the smooth body, as far as adhesion does not
/// provide it where it is negative, and that of kinks.
fn needed<const D: usize>(
    membrane: &Membrane<D>,
    side: Side,
    x: &Point<D>,
    pressure: f64,
    kink: Option<Kink<D>>,
    adhering: bool,
) -> f64 {
    let held = adhering && membrane.adhesive_slope(side, x).0 > 0.0;
    (if held { pressure.max(0.0) } else { pressure }) + kink.map_or(0.0, |k| k.pressure)
}

/// The zone with the parts added where the free membrane penetrates a body that can push, and the parts removed where
/// a body would have to pull.
pub fn corrected<const D: usize, Z: Zone<D>>(
    equilibrium: &Equilibrium<D>,
    zone: &Z,
    conditions: &Conditions<D>,
    scales: &Scales,
    adhering: bool,
) -> Z {
    let membrane = &equilibrium.membrane;
    let samples = membrane.samples();
    let grid = &samples;
    let mut result = zone.clone();
    if conditions.pulls(scales) {
        // First what pulls: added parts may then grow into its place.
        result = result.reduced(grid, &mut |x| match contact_of(zone.region_at(x)) {
            Some((side, _)) => {
                let kink = kink(membrane, zone, side, x, grid.h(), adhering);
                let needed = needed(membrane, side, x, membrane.pressure(side, x), kink, adhering);
                (needed - scales.pressure_tolerance()) / scales.pressure
            }
            None => 1.0,
        });
    }
    if conditions.torn_from_support.is_some() {
        let h = grid.h();
        let rim: Vec<Point<D>> =
            equilibrium.quadrature.rim.iter().filter(|p| membrane.supports[p.piece].is_some()).map(|p| p.x).collect();
        result =
            result.reduced(grid, &mut |x| rim.iter().map(|y| (x - y).norm()).fold(f64::INFINITY, f64::min) - 1.5 * h);
    }
    if conditions.penetrates() {
        let reach = 2.0 * grid.h();
        let penetration = |side: Side, x: &Point<D>| {
            let Some(x) = inside(membrane, x, reach) else { return 1.0 };
            if contact_index(zone.region_at(&x)).is_some() {
                return 1.0;
            }
            let Some(u) = equilibrium.displacement(zone, &x) else { return 1.0 };
            let gap = membrane.obstacles.gap(side, &x, u);
            if gap < 0.0 && !is_apart(membrane, zone, &x) {
                return 1.0;
            }
            let size = if gap < 0.0 { membrane.cell_size(&x) } else { grid.h() };
            let gap = (gap + 0.5 * scales.gap_tolerance(size)) / scales.gap;
            gap.max(-membrane.pressure(side, &x) / scales.pressure)
        };
        let before = result.counts();
        for side in membrane.obstacles.sides() {
            result = result.united(grid, side, &mut |x| penetration(side, x));
        }
        if result.counts() == before {
            // Too small for the raster to see.
            let (side, x) = conditions.deepest;
            result = result.seeded(grid, side, &x, 0.5 * grid.h());
        }
    }
    result
}

/// The least gap of a membrane without contact, on which side, and where it is: from the lowest quadrature point downhill.
pub fn least_free_gap<const D: usize, Z: Zone<D>>(free: &Equilibrium<D>, zone: &Z) -> (f64, Side, Point<D>) {
    let obstacles = &free.membrane.obstacles;
    let mut best = (f64::INFINITY, Point::zeros());
    let mut side = Side::Below;
    free.for_each_point(|cell, region, x, _| {
        if let Some((u, _)) = free.evaluate(cell, region, x).filter(|_| is_free(region)) {
            let (gap, of) = obstacles.least_gap(x, u);
            if gap < best.0 {
                best = (gap, *x);
                side = of;
            }
        }
    });
    let bounds = free.membrane.grid.bounds();
    let mut step = 0.5 * free.membrane.grid.h();
    let least = 1e-8 * free.membrane.grid.h();
    while step > least && best.0.is_finite() {
        let around = (0..2 * D).map(|k| {
            let mut x = best.1;
            x[k / 2] += if k % 2 == 0 { step } else { -step };
            bounds.clamp(&x)
        });
        let lower = around.filter_map(|x| Some((obstacles.gap(side, &x, free.displacement(zone, &x)?), x)));
        match lower.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|a| a.0 < best.0) {
            Some(lower) => best = lower,
            None => step *= 0.5,
        }
    }
    (best.0, side, best.1)
}

/// Whether a point is further from all fronts than half of its cell.
fn is_apart<const D: usize, Z: Zone<D>>(membrane: &Membrane<D>, zone: &Z, x: &Point<D>) -> bool {
    let band = 0.5 * membrane.cell_size(x);
    zone.distance(x, band) > band
}

/// The point itself if it belongs to the membrane, or a near one that does.
fn inside<const D: usize>(membrane: &Membrane<D>, x: &Point<D>, reach: f64) -> Option<Point<D>> {
    if membrane.contains(x) { Some(*x) } else { membrane.domain.domain.pulled_inside(x, reach) }
}
