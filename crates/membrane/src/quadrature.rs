//! The cells of a membrane divided by its boundary and by the fronts of contact.

use crate::domain::CellStatus;
use crate::obstacle::Side;
use crate::problem::Membrane;
use crate::zone::{Division, NoZone, OUTSIDE, contact_of, is_free};
use rayon::prelude::*;
use signorini_fem::cells::SidePoint;
use signorini_fem::cut::{CellPartition, CellRule, QuadraturePoint, RegionId, scan_roots};
use signorini_fem::gauss_legendre;
use signorini_geometry::{Aabb, Point, Vector};

/// Sheets of fronts are tagged above those of the boundary.
const FRONT_TAG: u32 = 1 << 20;

/// What a cell consists of.
#[derive(Clone, Debug)]
pub enum Cell<const D: usize> {
    Outside,
    /// The whole cell lies in one region.
    Whole(RegionId),
    Cut(Box<CellRule<D>>),
}

/// A quadrature point of a front.
#[derive(Clone, Copy, Debug)]
pub struct FrontPoint<const D: usize> {
    pub cell: usize,
    pub x: Point<D>,
    pub weight: f64,
    /// Unit normal, out of the zone into the free membrane.
    pub normal: Vector<D>,
    pub front: usize,
    /// The zone within and the side that it touches, and the free region without.
    pub zone: usize,
    pub side: Side,
    pub free: RegionId,
}

/// A quadrature point of the membrane's boundary.
#[derive(Clone, Copy, Debug)]
pub struct RimPoint<const D: usize> {
    pub cell: usize,
    pub x: Point<D>,
    pub weight: f64,
    /// Unit normal, out of the membrane.
    pub normal: Vector<D>,
    pub piece: usize,
    /// The region inside.
    pub region: RegionId,
}

/// All quadrature of a membrane with a given contact zone.
#[derive(Clone, Debug)]
pub struct Quadrature<const D: usize> {
    pub cells: Vec<Cell<D>>,
    pub front: Vec<FrontPoint<D>>,
    pub rim: Vec<RimPoint<D>>,
}

/// Gauss points per direction and smooth piece in cut cells: enough for fronts that curve within a cell by as much as the
/// degree can show.
pub fn cut_order(degree: usize) -> usize {
    if degree == 1 { 4 } else { degree + 5 }
}

impl<const D: usize> Quadrature<D> {
    pub fn new<Z: Division<D>>(membrane: &Membrane<D>, zone: &Z) -> Self {
        Self::of_order(membrane, zone, cut_order(membrane.cells.degree()))
    }

    /// With so many Gauss points per direction and smooth piece in cut cells.
    pub fn of_order<Z: Division<D>>(membrane: &Membrane<D>, zone: &Z, order: usize) -> Self {
        let cells: Vec<Cell<D>> = (0..membrane.cells.count())
            .into_par_iter()
            .map(|cell| {
                if membrane.domain.status[cell] == CellStatus::Outside {
                    return Cell::Outside;
                }
                let b = membrane.cells.bounds_of(cell);
                let partition = partition(membrane, zone, cell, &b);
                if partition.sheets.is_empty() {
                    return Cell::Whole((partition.region)(&b.center(), &[]));
                }
                let mut rule = membrane.cells.cut(cell, &partition, order);
                if !rule.cut {
                    return rule.volumes.first().map_or(Cell::Outside, |(r, _)| match *r {
                        OUTSIDE => Cell::Outside,
                        region => Cell::Whole(region),
                    });
                }
                rule.volumes.retain(|(region, _)| *region != OUTSIDE);
                for p in rule.volumes.iter_mut().flat_map(|(_, points)| points) {
                    p.weight *= membrane.measure.weight(&p.x);
                }
                for p in &mut rule.surfaces {
                    p.weight *= membrane.measure.weight(&p.x);
                }
                Cell::Cut(Box::new(rule))
            })
            .collect();
        let mut quadrature = Self { cells, front: Vec::new(), rim: Vec::new() };
        quadrature.collect_surfaces();
        if membrane.domain.domain.is_fitted() {
            quadrature.add_sides(membrane, zone);
        }
        quadrature
    }

    fn collect_surfaces(&mut self) {
        for (cell, content) in self.cells.iter().enumerate() {
            let Cell::Cut(rule) = content else { continue };
            for p in &rule.surfaces {
                if p.tag >= FRONT_TAG {
                    if let (Some((side, zone)), true) = (contact_of(p.minus), is_free(p.plus)) {
                        self.front.push(FrontPoint {
                            cell,
                            x: p.x,
                            weight: p.weight,
                            normal: p.normal,
                            front: (p.tag - FRONT_TAG) as usize,
                            zone,
                            side,
                            free: p.plus,
                        });
                    }
                } else {
                    // The outside may lie on either side of a sheet that is the line through a polygon's edge.
                    let (region, normal) = if p.plus == OUTSIDE { (p.minus, p.normal) } else { (p.plus, -p.normal) };
                    let piece = p.tag as usize;
                    self.rim.push(RimPoint { cell, x: p.x, weight: p.weight, normal, piece, region });
                }
            }
        }
    }

    /// The boundary of a domain that the cells fit.
    fn add_sides<Z: Division<D>>(&mut self, membrane: &Membrane<D>, zone: &Z) {
        let cells = &*membrane.cells;
        let gauss = gauss_legendre(cut_order(cells.degree()));
        for side in cells.boundary_sides() {
            let divided = partition(membrane, zone, side.cell, &cells.bounds_of(side.cell));
            let region = |x: &Point<D>| {
                let values: Vec<f64> = divided.sheets.iter().map(|s| s.value(x)).collect();
                (divided.region)(x, &values)
            };
            let mut push = |p: SidePoint<D>, weight: f64, region: RegionId| {
                let weight = weight * membrane.measure.weight(&p.x);
                self.rim.push(RimPoint {
                    cell: side.cell,
                    x: p.x,
                    weight,
                    normal: p.normal,
                    piece: side.piece,
                    region,
                });
            };
            let at = |t: f64| cells.on_side(&side, t);
            if D == 1 {
                let corner = at(0.0);
                push(corner, 1.0, region(&corner.x));
                continue;
            }
            let mut breaks = vec![0.0, 1.0];
            for sheet in &divided.sheets {
                breaks.extend(scan_roots(0.0, 1.0, 9, |t| {
                    let p = at(t);
                    let (value, gradient) = sheet.value_and_gradient(&p.x);
                    (value, gradient.dot(&p.tangent))
                }));
            }
            breaks.sort_by(f64::total_cmp);
            for pair in breaks.windows(2).filter(|pair| pair[1] > pair[0]) {
                let width = pair[1] - pair[0];
                let here = region(&at(0.5 * (pair[0] + pair[1])).x);
                for &(t, w) in &gauss {
                    let p = at(pair[0] + t * width);
                    push(p, w * width * p.tangent.norm(), here);
                }
            }
        }
    }

    /// The volume points of a cell, region by region.
    pub fn volumes<'a>(
        &'a self,
        membrane: &'a Membrane<D>,
        cell: usize,
    ) -> Vec<(RegionId, std::borrow::Cow<'a, [QuadraturePoint<D>]>)> {
        match &self.cells[cell] {
            Cell::Outside => Vec::new(),
            Cell::Whole(region) => {
                let mut points = membrane.cells.rule(cell);
                for p in &mut points {
                    p.weight *= membrane.measure.weight(&p.x);
                }
                vec![(*region, points.into())]
            }
            Cell::Cut(rule) => rule.volumes.iter().map(|(r, points)| (*r, points.as_slice().into())).collect(),
        }
    }

    /// The regions present in a cell, also where they only touch it.
    pub fn regions(&self, cell: usize) -> Vec<RegionId> {
        match &self.cells[cell] {
            Cell::Outside => Vec::new(),
            Cell::Whole(region) => vec![*region],
            Cell::Cut(rule) => {
                let mut regions: Vec<RegionId> = rule.volumes.iter().map(|(r, _)| *r).collect();
                regions.extend(rule.surfaces.iter().flat_map(|p| [p.minus, p.plus]));
                regions.sort_unstable();
                regions.dedup();
                regions.retain(|r| *r != OUTSIDE);
                regions
            }
        }
    }
}

/// What divides a cell: the boundary of the membrane, then the fronts.
fn partition<'a, const D: usize, Z: Division<D>>(
    membrane: &'a Membrane<D>,
    zone: &'a Z,
    cell: usize,
    b: &Aabb<D>,
) -> CellPartition<'a, D> {
    let domain = &membrane.domain.domain;
    let crossed = membrane.domain.status[cell] == CellStatus::Crossed;
    let fronts = zone.fronts_in(b);
    let mut all = CellPartition {
        sheets: fronts.sheets,
        tags: fronts.fronts.iter().map(|&f| FRONT_TAG + f as u32).collect(),
        features: fronts.features,
        region: Box::new(|_, _| OUTSIDE),
    };
    let count = all.sheets.len();
    if crossed {
        let boundary = domain.boundary_in(b);
        all.sheets.extend(boundary.sheets);
        all.tags.extend(boundary.pieces);
        all.features.extend(boundary.features);
    }
    all.region = Box::new(move |x, values| {
        if crossed && !domain.contains(x, values.get(count..).unwrap_or(&[])) {
            return OUTSIDE;
        }
        (fronts.region)(values.get(..count).unwrap_or(&[]))
    });
    all
}

/// The area of a membrane.
pub fn area<const D: usize>(membrane: &Membrane<D>) -> f64 {
    let quadrature = Quadrature::new(membrane, &NoZone);
    let cells = (0..quadrature.cells.len()).flat_map(|cell| quadrature.volumes(membrane, cell));
    cells.flat_map(|(_, points)| points.iter().map(|p| p.weight).collect::<Vec<_>>()).sum()
}
