//! The multiplier along the front: a space small enough to be stable however the front cuts the cells.
//!
//! In one dimension a front is a point and has one value. In the plane there is one unknown for each *vital* edge: of the
//! edges that the front crosses, those crossed nearest their middle come first, and an edge is vital if neither of
//! its ends belongs to a vital edge before it. Where the front crosses another edge the multiplier is the mean of the
//! unknowns that own its ends, and between two edges it is linear. (E. Béchet, N. Moës & B. Wohlmuth, Int. J. Numer.
//! Methods Eng. 78, 2009; the order of the edges is that of G. Hautefeuille, C. Annavarapu & J. Dolbow, ibid. 90, 2012.)

use crate::equilibrium::unknowns::{Unknowns, number_where};
use crate::problem::Membrane;
use crate::quadrature::{FrontPoint, Quadrature};
use crate::zone::{Zone, contact, contact_of, is_free};
use signorini_fem::cut::{QuadraturePoint, RegionId};
use signorini_fem::lagrange::Tabulation;
use signorini_geometry::Point;
use signorini_solve::{SolveError, Symbolic, SymmetricMatrix, dense};
use std::collections::BTreeMap;

/// Halvings that place the front on an edge.
const HALVINGS: usize = 48;

/// The unknowns of the multiplier and what they are at the quadrature points of the fronts.
#[derive(Clone, Debug)]
pub struct FrontMultipliers {
    pub count: usize,
    /// For each quadrature point of the fronts the unknowns and their shares, which add up to one.
    pub shares: Vec<Vec<(usize, f64)>>,
}

/// Where a front crosses an edge of a cell.
struct Crossing<const D: usize> {
    ends: [u32; 2],
    x: Point<D>,
    /// Distance of the crossing from the middle of the edge, as a part of its length.
    off_centre: f64,
    /// What the multiplier is there.
    shares: Vec<(usize, f64)>,
}

impl FrontMultipliers {
    pub fn new<const D: usize, Z: Zone<D>>(membrane: &Membrane<D>, zone: &Z, quadrature: &Quadrature<D>) -> Self {
        let points = &quadrature.front;
        if D == 1 {
            return Self { count: points.len(), shares: (0..points.len()).map(|i| vec![(i, 1.0)]).collect() };
        }
        let (mut crossings, of_cell) = crossings(membrane, zone, quadrature);
        let count = choose_vital(&mut crossings);
        let shares = points
            .iter()
            .map(|p| {
                let own = of_cell.get(&p.cell).map_or(&[][..], Vec::as_slice);
                shares_at(&crossings, own, &p.x)
            })
            .collect();
        Self { count, shares }
    }
}

/// All crossings of fronts with edges, and for each cell those of its edges.
fn crossings<const D: usize, Z: Zone<D>>(
    membrane: &Membrane<D>,
    zone: &Z,
    quadrature: &Quadrature<D>,
) -> (Vec<Crossing<D>>, BTreeMap<usize, Vec<usize>>) {
    let cells = &*membrane.cells;
    let touches = |x: &Point<D>| contact_of(zone.region_at(x)).is_some();
    let mut all: Vec<Crossing<D>> = Vec::new();
    let mut of_edge: BTreeMap<[u32; 2], Option<usize>> = BTreeMap::new();
    let mut of_cell: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    let mut in_contact: BTreeMap<u32, bool> = BTreeMap::new();
    let mut corners = Vec::new();
    let mut last = None;
    for cell in quadrature.front.iter().map(|p| p.cell) {
        if last.replace(cell) == Some(cell) || of_cell.contains_key(&cell) {
            continue;
        }
        cells.functions(cell, &mut corners);
        let mut own = Vec::new();
        for edge in cells.edges(cell) {
            let mut ends = edge.map(|i| corners[i]);
            ends.sort_unstable();
            let crossing = of_edge.entry(ends).or_insert_with(|| {
                let [a, b] = ends.map(|node| cells.node(node as usize));
                let [within, beyond] =
                    [0, 1].map(|k| *in_contact.entry(ends[k]).or_insert_with(|| touches(if k == 0 { &a } else { &b })));
                if within == beyond {
                    return None;
                }
                let (mut low, mut high) = (0.0, 1.0);
                for _ in 0..HALVINGS {
                    let middle = 0.5 * (low + high);
                    if touches(&(a + (b - a) * middle)) == within { low = middle } else { high = middle }
                }
                let x = a + (b - a) * low;
                all.push(Crossing { ends, x, off_centre: (low - 0.5f64).abs(), shares: Vec::new() });
                Some(all.len() - 1)
            });
            own.extend(*crossing);
        }
        of_cell.insert(cell, own);
    }
    (all, of_cell)
}

/// Makes vital as many edges as do not share an end; the number of them.
fn choose_vital<const D: usize>(crossings: &mut [Crossing<D>]) -> usize {
    let mut order: Vec<usize> = (0..crossings.len()).collect();
    let rank = |c: &Crossing<D>| (c.off_centre, c.ends);
    order.sort_by(|&i, &j| {
        let (a, b) = (rank(&crossings[i]), rank(&crossings[j]));
        a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))
    });
    let mut owner: BTreeMap<u32, usize> = BTreeMap::new();
    let mut count = 0;
    for &i in &order {
        let ends = crossings[i].ends;
        if ends.iter().all(|node| !owner.contains_key(node)) {
            owner.extend(ends.map(|node| (node, count)));
            crossings[i].shares = vec![(count, 1.0)];
            count += 1;
        }
    }
    for c in crossings.iter_mut().filter(|c| c.shares.is_empty()) {
        // Of any edge left over at least one end is taken.
        let owners: Vec<usize> = c.ends.iter().filter_map(|node| owner.get(node).copied()).collect();
        c.shares = owners.iter().map(|&k| (k, 1.0 / owners.len() as f64)).collect();
    }
    count
}

/// The multiplier at a point of the front: linear between the two crossings of its cell whose chord is nearest to it.
fn shares_at<const D: usize>(crossings: &[Crossing<D>], own: &[usize], x: &Point<D>) -> Vec<(usize, f64)> {
    let mut best: Option<(f64, usize, usize, f64)> = None;
    for (n, &i) in own.iter().enumerate() {
        for &j in &own[n + 1..] {
            let (a, b) = (crossings[i].x, crossings[j].x);
            let chord = b - a;
            let t = ((x - a).dot(&chord) / chord.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
            let distance = (x - a - chord * t).norm();
            if best.is_none_or(|b| distance < b.0) {
                best = Some((distance, i, j, t));
            }
        }
    }
    if let Some((_, i, j, t)) = best {
        let weighed = |k: usize, w: f64| crossings[k].shares.iter().map(move |(u, s)| (*u, s * w));
        return weighed(i, 1.0 - t).chain(weighed(j, t)).collect();
    }
    // A front that keeps within a cell takes what is nearest.
    let distance = |c: &Crossing<D>| (c.x - x).norm();
    let nearest = crossings.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
    nearest.map_or_else(Vec::new, |c| c.shares.clone())
}

/// The constant of the inf-sup condition of the multiplier along the front,
/// `inf_μ sup_v ∫ μ [[v]] / (‖v‖_{H¹} √h ‖μ‖)`, for functions `v` on both sides: a space is stable while this keeps away
/// from zero on every mesh and for every cut.
///
/// # Errors
/// Equations that cannot be solved.
pub fn inf_sup<const D: usize, Z: Zone<D>>(membrane: &Membrane<D>, zone: &Z) -> Result<Option<f64>, SolveError> {
    let quadrature = Quadrature::new(membrane, zone);
    let space = FrontMultipliers::new(membrane, zone, &quadrature);
    let unknowns = number_where(membrane, &quadrature, |r| is_free(r) || contact_of(r).is_some());
    let (n, m) = (unknowns.count, space.count);
    if m == 0 {
        return Ok(None);
    }
    let mut locals: Vec<(Vec<u32>, Vec<f64>)> = Vec::new();
    let mut support = vec![0.0f64; n];
    let mut t = Tabulation::default();
    unknowns.for_each_rule(membrane, &quadrature, |cell, _, dofs, points| {
        let local = inner_product(membrane, cell, dofs.len(), points, 1.0);
        dofs.iter().enumerate().for_each(|(a, &i)| support[i as usize] += local[a * (dofs.len() + 1)]);
        locals.push((dofs.to_vec(), local));
    });
    // Functions with nothing of their support on their side do not count; the others are measured by their own size, so
    // that slivers do no harm.
    let scale: Vec<f64> = support.iter().map(|s| if *s > 0.0 { 1.0 / s.sqrt() } else { 0.0 }).collect();
    for (dofs, local) in &mut locals {
        let k = dofs.len();
        for (a, &i) in dofs.iter().enumerate() {
            for (b, &j) in dofs.iter().enumerate() {
                local[a * k + b] *= scale[i as usize] * scale[j as usize];
            }
        }
    }
    locals.extend((0..n).filter(|&i| scale[i] == 0.0).map(|i| (vec![i as u32], vec![1.0])));
    let factor = Symbolic::default().factor(SymmetricMatrix::of_cliques(n, &locals))?;
    let mut coupling = vec![0.0; n * m];
    let mut mass = vec![0.0; m * m];
    for (p, shares) in quadrature.front.iter().zip(&space.shares) {
        membrane.cells.tabulate(p.cell, &p.x, &mut t);
        for (region, sign) in [(p.free, 1.0), (contact(p.side, p.zone), -1.0)] {
            let Some(dofs) = unknowns.of(p.cell, region) else { continue };
            for &(k, s) in shares {
                for (v, &i) in t.value.iter().zip(dofs) {
                    coupling[k * n + i as usize] += sign * p.weight * s * v * scale[i as usize];
                }
            }
        }
        for &(k, s) in shares {
            for &(l, r) in shares {
                mass[k * m + l] += membrane.cells.size(p.cell) * p.weight * s * r;
            }
        }
    }
    let mut response = coupling.clone();
    factor.solve_columns(&mut response)?;
    let mut form = vec![0.0; m * m];
    for k in 0..m {
        for l in 0..m {
            let (a, b) = (&coupling[k * n..(k + 1) * n], &response[l * n..(l + 1) * n]);
            form[k * m + l] = a.iter().zip(b).map(|(a, b)| a * b).sum();
        }
    }
    Ok(dense::symmetric_eigen(&form, &mass).and_then(|(values, _)| values.first().map(|v| v.max(0.0).sqrt())))
}

/// The matrix of `∫_Γ μ v` for functions on one side of the fronts, by rows of the multiplier: unknown and entry.
pub(super) fn coupling<const D: usize>(
    membrane: &Membrane<D>,
    quadrature: &Quadrature<D>,
    space: &FrontMultipliers,
    unknowns: &Unknowns,
    region_of: impl Fn(&FrontPoint<D>) -> RegionId,
    weight: impl Fn(usize) -> f64,
) -> Vec<Vec<(u32, f64)>> {
    let mut rows: Vec<BTreeMap<u32, f64>> = vec![BTreeMap::new(); space.count];
    let mut t = Tabulation::default();
    for (i, (p, shares)) in quadrature.front.iter().zip(&space.shares).enumerate() {
        let Some(dofs) = unknowns.of(p.cell, region_of(p)) else { continue };
        let weight = p.weight * weight(i);
        membrane.cells.tabulate(p.cell, &p.x, &mut t);
        for &(k, s) in shares {
            for (v, &dof) in t.value.iter().zip(dofs) {
                *rows[k].entry(dof).or_insert(0.0) += weight * s * v;
            }
        }
    }
    rows.into_iter().map(|row| row.into_iter().collect()).collect()
}

/// `∫ l² ∇p·∇q + p q` of so many functions of a cell over some of its volume points, by the square of the length.
pub(super) fn inner_product<const D: usize>(
    membrane: &Membrane<D>,
    cell: usize,
    count: usize,
    points: &[QuadraturePoint<D>],
    gradient_weight: f64,
) -> Vec<f64> {
    let (mut t, mut local) = (Tabulation::default(), vec![0.0; count * count]);
    for p in points {
        membrane.cells.tabulate(cell, &p.x, &mut t);
        for a in 0..count {
            for b in 0..count {
                local[a * count + b] +=
                    p.weight * (gradient_weight * t.gradient[a].dot(&t.gradient[b]) + t.value[a] * t.value[b]);
            }
        }
    }
    local
}
