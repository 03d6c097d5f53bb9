//! The kinematics of a contact pair: its gap and what the unknowns that move both partners change of it.
//!
//! One template for all pairs (Konyukhov & Schweizerhof 2013). Geometry supplies the measures at the closest points;
//! here the shape functions of the partners are inserted, whatever they are: low or high order, or splines. A pair knows
//! neither pressures nor penalties.

use signorini_geometry::Vector;
use signorini_geometry::measures::{Measures, PartnerJet, Variation};
use signorini_geometry::rigid_shape::GapJet;

/// A function that moves a point of a partner: the first of its unknowns, its value and its slopes along the
/// coordinates of the partner (those beyond the number of its coordinates are not read).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeFunction {
    pub unknown: u32,
    pub value: f64,
    pub slopes: [f64; 2],
}

/// A partner of a pair: its jet at the closest point and the functions that move it. A rigid partner has none.
#[derive(Clone, Copy, Debug)]
pub struct Partner<'a> {
    pub jet: PartnerJet<'a>,
    pub functions: &'a [ShapeFunction],
}

/// The gap of a pair and its variation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Kinematics {
    pub gap: f64,
    /// Unit vector along which the gap counts.
    pub normal: Vector<3>,
    /// Unknowns that the gap depends on, and its derivatives.
    pub unknowns: Vec<u32>,
    pub gradient: Vec<f64>,
    /// First unknown of every function that moves the partners apart, and how much it does: `δ(x_a - x_b)` at the points
    /// of the partners is the sum of these.
    pub apart: Vec<(u32, f64)>,
}

impl Kinematics {
    /// The pair of two partners at their closest points, with `normal` the unit vector along which the gap counts.
    /// `D` unknowns belong to each function; in the plane those along z are left out.
    ///
    /// `None` where the coordinates of the pair do not exist: on a focal set, or along parallel tangents.
    ///
    /// # Panics
    /// If `N` is not the number of coordinates of both partners.
    pub fn of_pair<const D: usize, const N: usize>(a: Partner<'_>, b: Partner<'_>, normal: Vector<3>) -> Option<Self> {
        let measures = Measures::<N>::new(a.jet, b.jet, normal)?;
        let of_a = a.jet.dimension();
        let zero = Vector::<3>::zeros();
        let mut out = Kinematics { gap: measures.gap, normal, ..Self::default() };
        for (partner, first, sign) in [(&a, 0, 1.0), (&b, of_a, -1.0)] {
            for f in partner.functions {
                out.apart.push((f.unknown, sign * f.value));
                for i in 0..D {
                    let along = axis(i) * sign;
                    let mut v = Variation::<N> { d: along * f.value, d_a: [zero; N], d_ab: [[zero; N]; N] };
                    for (slope, d_a) in f.slopes.iter().zip(&mut v.d_a[first..first + partner.jet.dimension()]) {
                        *d_a = along * *slope;
                    }
                    out.unknowns.push(f.unknown + i as u32);
                    out.gradient.push(measures.gap_variation(&v));
                }
            }
        }
        Some(out)
    }

    /// The pair of a point and a rigid body whose gap has a value and a gradient in the position of the point.
    pub fn of_rigid<const D: usize>(functions: &[ShapeFunction], rigid: &GapJet<D>) -> Self {
        let normal = Vector::<3>::from_fn(|k, _| if k < D { rigid.normal[k] } else { 0.0 });
        let mut out = Kinematics { gap: rigid.gap, normal, ..Self::default() };
        for f in functions {
            out.apart.push((f.unknown, f.value));
            for i in 0..D {
                out.unknowns.push(f.unknown + i as u32);
                out.gradient.push(f.value * rigid.normal[i]);
            }
        }
        out
    }
}

fn axis(i: usize) -> Vector<3> {
    let mut e = Vector::<3>::zeros();
    e[i] = 1.0;
    e
}
