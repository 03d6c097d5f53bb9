//! Gap and slip of two points of curves, with first and second variations (Konyukhov & Schweizerhof 2013, ch. 5).
//!
//! The first point is the slave `A`, the second the master `B`. Each is either free along its curve (one coordinate, where
//! the distance is stationary) or fixed: a point of Gauss, or an end. Two free points are a crossing of curves, one free
//! point is line contact or an end on a curve, none is end against end: one template.
//!
//! | symbol | meaning |
//! |---|---|
//! | `D = x_A - x_B`, `n = D/|D|` | relative position; the normal points from the master to the slave |
//! | `g = |D| - R_A - R_B` | gap of the surfaces |
//! | `S = δD - (R_A θ_A + R_B θ_B) × n - g δn` | slip of the surface of A along that of B, axial and circumferential |
//! | `e = P [x_A - R_A m_A - x_B - R_B m_B]` | slip since material points touched, of both curves and angles of both sections |
//!
//! A rigid motion of both is no slip. A curve that does not know how its sections turn has one that turns with the normal:
//! its `R δn` takes the place of `R θ × n`, and slip about its axis is not counted. Second variations are exact for any gap.

use nalgebra::SVector;
use signorini_geometry::Vector;
use signorini_geometry::measures::{Measures, PartnerJet, Variation};
use signorini_geometry::shape::CurveJet;
use signorini_mechanics::body::{Foot, MaterialPoint, Order};
use signorini_mechanics::pair::axis;

/// Why two points of curves make no pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoPair {
    /// Both curves pass through the same point: there is no direction in which to part them.
    #[error("the centrelines intersect")]
    Meet,
    /// Parallel tangents, or a centre of curvature.
    #[error(
        "the closest points of the pair do not exist: tangents are parallel, or a point is at a centre of curvature"
    )]
    NoCoordinates,
}

/// Material points of both surfaces that were in touch: where along the curves, and in which direction in the axes of
/// their sections, away from the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stuck {
    pub points: [MaterialPoint; 2],
    pub directions: [Vector<3>; 2],
}

/// Gap, slip and variations in the unknowns of both bodies.
#[derive(Clone, Debug)]
pub struct CurvePair {
    pub gap: f64,
    pub normal: Vector<3>,
    /// Numbers of the system.
    pub unknowns: Vec<u32>,
    pub d_gap: Vec<f64>,
    /// Row by row; empty for [`Order::First`].
    pub d2_gap: Vec<f64>,
    /// How far the distance is from a valley, as [`parallel`], and its variation.
    pub parallel: f64,
    pub d_parallel: Vec<f64>,
    /// Unit tangent of the slave across the normal: the axial direction of slip.
    pub axial: Vector<3>,
    pub d_axial: Vec<Vector<3>>,
    /// Variations of the slip.
    pub slip: Vec<Vector<3>>,
    pub d_normal: Vec<Vector<3>>,
    /// Second variations of the slip, row by row; empty where they were not asked for.
    d_slip: Vec<Vector<3>>,
    pub stuck: Stuck,
}

/// What is measured.
#[derive(Clone, Copy, Debug)]
pub enum Wanted<'a> {
    Gap,
    /// With the second variations of the spins of both sections, as `Curve::spin_bends`.
    GapAndSlip([&'a [Vector<3>]; 2]),
}

/// One unknown at fixed coordinates.
struct Column {
    unknown: u32,
    side: usize,
    value: Vector<3>,
    slope: Vector<3>,
    second: Vector<3>,
    /// Which spin of the section it is, and that spin times the radius with its slope along the curve.
    spin: Option<usize>,
    lever: Vector<3>,
    lever_slope: Vector<3>,
}

fn columns(feet: [&Foot; 2], first: [u32; 2]) -> Vec<Column> {
    let zero = Vector::<3>::zeros();
    let mut out = Vec::new();
    for side in 0..2 {
        let foot = feet[side];
        out.extend(foot.functions.iter().map(|f| Column {
            unknown: first[side] + f.unknown,
            side,
            value: f.value,
            slope: f.slopes[0],
            second: f.second[0],
            spin: None,
            lever: zero,
            lever_slope: zero,
        }));
        out.extend(foot.spin.iter().enumerate().map(|(k, f)| Column {
            unknown: first[side] + f.unknown,
            side,
            value: zero,
            slope: zero,
            second: zero,
            spin: Some(k),
            lever: f.value * foot.radius,
            lever_slope: f.slopes[0] * foot.radius,
        }));
    }
    out
}

fn curve_jet(foot: &Foot) -> CurveJet {
    CurveJet { x: foot.jet.x, d1: foot.jet.u, d2: foot.jet.uu, d3: foot.jet.uuu }
}

/// `A_11 = |c_1'|² + D·c_1''`, `A_22 = |c_2'|² - D·c_2''` and `c_1'·c_2'`: the second derivatives of half the squared distance.
fn hessian(jets: &[CurveJet; 2], d: &Vector<3>) -> [f64; 3] {
    let [p, q] = jets;
    [p.d1.norm_squared() + d.dot(&p.d2), q.d1.norm_squared() - d.dot(&q.d2), p.d1.dot(&q.d1)]
}

/// `1 - (A_11 A_22 - A_12²)/(|c_1'|² |c_2'|²)` of the second derivatives of the distance: between straight lines the squared
/// cosine of their angle, and 1 where points are no nearer than their neighbours, such as along the valley between the
/// strands of a double helix or where a rod winds about another. Infinite beyond a centre of curvature.
pub fn parallel(feet: [&Foot; 2]) -> f64 {
    let jets = feet.map(curve_jet);
    let [a_11, a_22, a_12] = hessian(&jets, &(feet[0].jet.x - feet[1].jet.x));
    if a_11 > 0.0 && a_22 > 0.0 {
        1.0 - (a_11 * a_22 - a_12 * a_12) / (jets[0].d1.norm_squared() * jets[1].d1.norm_squared())
    } else {
        f64::INFINITY
    }
}

/// The measures of two points of curves; of a foot with one coordinate the distance must be stationary in it. `first` are
/// the first unknowns of both bodies in the system. `facing` is the normal of the same contact before: the axes of curves
/// that have passed through each other are then apart by a negative distance.
///
/// # Errors
/// Why there is no pair.
pub fn measure(
    feet: [&Foot; 2],
    first: [u32; 2],
    facing: Option<Vector<3>>,
    wanted: (Wanted<'_>, Order),
) -> Result<CurvePair, NoPair> {
    match feet[0].coordinates + feet[1].coordinates {
        0 => with::<0>(feet, first, facing, wanted),
        1 => with::<1>(feet, first, facing, wanted),
        _ => with::<2>(feet, first, facing, wanted),
    }
}

fn with<const N: usize>(
    feet: [&Foot; 2],
    first: [u32; 2],
    facing: Option<Vector<3>>,
    (wanted, order): (Wanted<'_>, Order),
) -> Result<CurvePair, NoPair> {
    let [a, b] = feet;
    let jets = [curve_jet(a), curve_jet(b)];
    let d = a.jet.x - b.jet.x;
    // Of lines without a section the normal is that of both tangents, at any distance.
    let is_sharp = N == 2 && a.radius + b.radius == 0.0;
    let across = jets[0].d1.cross(&jets[1].d1);
    let along = if is_sharp { across } else { d };
    let along = along.try_normalize(0.0).ok_or(if is_sharp { NoPair::NoCoordinates } else { NoPair::Meet })?;
    let normal = if facing.is_some_and(|f| f.dot(&along) < 0.0) { -along } else { along };
    let distance = d.dot(&normal);
    let partner = |side: usize| match feet[side].coordinates {
        0 => PartnerJet::Point(&jets[side].x),
        _ => PartnerJet::Curve(&jets[side]),
    };
    let measures = Measures::<N>::new(partner(0), partner(1), normal).ok_or(NoPair::NoCoordinates)?;
    if !measures.hessian().iter().all(|h| h.is_finite()) {
        return Err(NoPair::NoCoordinates);
    }
    // Where the coordinates of each side are among those of the pair.
    let of_side = |side: usize| (feet[side].coordinates == 1).then(|| if side == 0 { 0 } else { N - 1 });
    let columns = columns(feet, first);
    let zero = Vector::<3>::zeros();
    let signs = [1.0, -1.0];
    let variations: Vec<Variation<N>> = (columns.iter())
        .map(|c| {
            let own = of_side(c.side);
            let at = |k: usize, v: Vector<3>| if own == Some(k) { v * signs[c.side] } else { zero };
            Variation {
                d: c.value * signs[c.side],
                d_a: std::array::from_fn(|p| at(p, c.slope)),
                d_ab: std::array::from_fn(|p| std::array::from_fn(|q| if p == q { at(p, c.second) } else { zero })),
            }
        })
        .collect();
    let n = columns.len();
    let xi: Vec<SVector<f64, N>> = variations.iter().map(|v| measures.coordinate_variation(v)).collect();
    let d_xi: Vec<[f64; 2]> = xi.iter().map(|x| [0, 1].map(|side| of_side(side).map_or(0.0, |k| x[k]))).collect();

    // Tangents and their total variations.
    let d1 = jets.map(|j| j.d1);
    let lengths = d1.map(|t| t.norm());
    let units = [d1[0] / lengths[0], d1[1] / lengths[1]];
    let d_unit = |k: usize, side: usize| {
        let own = if columns[k].side == side { columns[k].slope } else { zero };
        let change = own + jets[side].d2 * d_xi[k][side];
        (change - units[side] * units[side].dot(&change)) / lengths[side]
    };
    let gap = distance - a.radius - b.radius;
    // Total variation of D.
    let moved: Vec<Vector<3>> = (0..n).map(|k| variations[k].d + d1[0] * d_xi[k][0] - d1[1] * d_xi[k][1]).collect();
    let d_normal: Vec<Vector<3>> = match is_sharp {
        false => moved.iter().map(|m| (m - normal * normal.dot(m)) / distance).collect(),
        true => {
            let cross = units[0].cross(&units[1]);
            let length = cross.dot(&normal);
            let change = |k: usize| d_unit(k, 0).cross(&units[1]) + units[0].cross(&d_unit(k, 1));
            (0..n).map(change).map(|c| (c - normal * normal.dot(&c)) / length).collect()
        }
    };
    let [a_11, a_22, a_12] = hessian(&jets, &d);
    let d_parallel = (0..n)
        .map(|k| {
            let c = &columns[k];
            let own = |side: usize, v: Vector<3>| if c.side == side { v } else { zero };
            let tangent = [0, 1].map(|s| own(s, c.slope) + jets[s].d2 * d_xi[k][s]);
            let bend = [0, 1].map(|s| own(s, c.second) + jets[s].d3 * d_xi[k][s]);
            let d_metric = [0, 1].map(|s| 2.0 * d1[s].dot(&tangent[s]));
            let d_own = [0, 1].map(|s| d_metric[s] + signs[s] * (moved[k].dot(&jets[s].d2) + d.dot(&bend[s])));
            let d_both = tangent[0].dot(&d1[1]) + d1[0].dot(&tangent[1]);
            let d_determinant = d_own[0] * a_22 + a_11 * d_own[1] - 2.0 * a_12 * d_both;
            let [p, q] = lengths.map(|l| l * l);
            ((a_11 * a_22 - a_12 * a_12) * (d_metric[0] / p + d_metric[1] / q) - d_determinant) / (p * q)
        })
        .collect();
    // The tangent across the normal; with coordinates both are orthogonal, but that of a point of Gauss may lean. Ends that
    // meet head on have hardly any tangent across, and are alike in all directions: one of space serves.
    let is_head_on = N == 0 && normal.dot(&units[0]).powi(2) > 0.5;
    let (from, d_from): (_, &dyn Fn(usize) -> Vector<3>) =
        if is_head_on { (axis(normal.iamin()), &|_| zero) } else { (units[0], &|k| d_unit(k, 0)) };
    let lean = normal.dot(&from);
    let across = from - normal * lean;
    let length = across.norm();
    let axial = across.try_normalize(0.0).unwrap_or(from);
    let d_axial = (0..n)
        .map(|k| {
            let (d, dn) = (d_from(k), d_normal[k]);
            let change = d - dn * lean - normal * (dn.dot(&from) + normal.dot(&d));
            if length > 0.0 { (change - axial * axial.dot(&change)) / length } else { zero }
        })
        .collect();
    // What turns with the normal: the gap, and sections that do not turn by themselves.
    // Both make the whole distance where no section turns by itself.
    let hinge = gap + feet.iter().filter(|f| f.spin.is_empty()).map(|f| f.radius).sum::<f64>();
    let leverage = if is_sharp { 1.0 } else { hinge / distance };
    let d_gap: Vec<f64> = variations.iter().map(|v| measures.gap_variation(v)).collect();
    let mut d_slip = Vec::new();
    if let (Wanted::GapAndSlip(bends), Order::Second) = (wanted, order) {
        // Of D, with its coordinates.
        let bent = |k: usize, l: usize| {
            let h = measures.coordinate_second_variation(&variations[k], &variations[l]);
            let mut sum = zero;
            for side in 0..2 {
                let Some(own) = of_side(side) else { continue };
                let (x, y) = (d_xi[k][side], d_xi[l][side]);
                sum += variations[k].d_a[own] * y + variations[l].d_a[own] * x;
                sum += (jets[side].d2 * (x * y) + d1[side] * h[own]) * signs[side];
            }
            sum
        };
        d_slip = vec![zero; n * n];
        for k in 0..n {
            for l in 0..n {
                let along = (0..2).fold(zero, |sum, side| {
                    of_side(side).map_or(sum, |own| sum + variations[k].d_a[own] * d_xi[l][side])
                });
                let turned = bent(k, l) - d_normal[k] * d_gap[l] - d_normal[l] * d_gap[k];
                let (p, q) = (&columns[k], &columns[l]);
                let spun = match (p.spin, q.spin) {
                    (Some(i), Some(j)) if p.side == q.side => {
                        let foot = feet[p.side];
                        // A rigid section varies by half the product of two spins.
                        let rigid = || foot.spin[j].value.cross(&foot.spin[i].value) * 0.5;
                        bends[p.side].get(i * foot.spin.len() + j).copied().unwrap_or_else(rigid) * foot.radius
                    }
                    _ => zero,
                } + p.lever_slope * d_xi[l][p.side];
                d_slip[k * n + l] = along
                    - spun.cross(&normal)
                    - p.lever.cross(&d_normal[l])
                    - d_normal[k] * d_gap[l]
                    - turned * leverage;
            }
        }
    }
    Ok(CurvePair {
        gap,
        normal,
        unknowns: columns.iter().map(|c| c.unknown).collect(),
        d_gap,
        d2_gap: if order == Order::Second { measures.gap_hessian(&variations) } else { Vec::new() },
        parallel: parallel([a, b]),
        d_parallel,
        axial,
        d_axial,
        slip: (0..n).map(|k| variations[k].d - columns[k].lever.cross(&normal) - d_normal[k] * hinge).collect(),
        d_normal,
        d_slip,
        stuck: Stuck {
            points: [a.point, b.point],
            directions: [a.frame.transpose() * -normal, b.frame.transpose() * normal],
        },
    })
}

impl CurvePair {
    /// `T · Δδ slip` of two unknowns, for a traction `T` across the normal: it is not symmetric.
    pub fn slip_hessian(&self, traction: &Vector<3>, k: usize, l: usize) -> f64 {
        traction.dot(&self.d_slip[k * self.unknowns.len() + l])
    }

    /// The circumferential direction of slip, `n × τ`.
    pub fn circumferential(&self) -> Vector<3> {
        self.normal.cross(&self.axial)
    }
}

/// Slip since material points touched: its vector, not yet projected, and its variations in the unknowns of both bodies.
pub fn elastic_slip(stuck: &Stuck, feet: [&Foot; 2], first: [u32; 2]) -> (Vector<3>, Vec<u32>, Vec<Vector<3>>) {
    let zero = Vector::<3>::zeros();
    // Sections that turn with the normal have arms along it, which are no slip.
    let arms: [Vector<3>; 2] = [0, 1].map(|s| match feet[s].spin.is_empty() {
        true => zero,
        false => feet[s].frame * stuck.directions[s] * feet[s].radius,
    });
    let e = feet[0].jet.x + arms[0] - feet[1].jet.x - arms[1];
    let columns = columns(feet, first);
    let signs = [1.0, -1.0];
    let radius = |side: usize| feet[side].radius;
    let d_e = columns
        .iter()
        .map(|c| {
            let turn = if radius(c.side) > 0.0 { c.lever.cross(&arms[c.side]) / radius(c.side) } else { zero };
            (c.value + turn) * signs[c.side]
        })
        .collect();
    (e, columns.iter().map(|c| c.unknown).collect(), d_e)
}
