//! Balance of rigid bodies that touch, as equations for the forces at their places:
//!
//! `Σ_i (n_i p_i + t_i) + f = 0` and `Σ_i (x_i - c) × (n_i p_i + t_i) + m = 0` for each body,
//!
//! with the normal force `p_i` and the friction `t_i` at place `x_i`, the loads `f` and their moment `m` about the middle `c`
//! of the places. Forces are in units of the largest load, moments of it times the size of the body.

use crate::groups::Group;
use crate::place::{Friction, Place};
use crate::state::{Setting, Space, State};
use nalgebra::{DMatrix, DVector, RowDVector};
use signorini_geometry::{Point, Vector};

/// Singular values relative to the largest below which equations are the same: an arm of so small a part of the bodies turns
/// them by less than what the check of balance lets pass (a part of 10⁻⁴ of the forces, at arms of 10⁻² of the distance).
const RANK: f64 = 1e-6;

/// The equations of balance of a group: `matrix · y + loads = 0` for the forces `y`.
pub struct Statics<'a> {
    pub places: Vec<Place<'a>>,
    /// The unknown of the normal force of each place; those of its friction follow.
    pub first: Vec<usize>,
    pub unknowns: usize,
    /// The typical force: the largest that is given; zero where none is.
    pub force: f64,
    matrix: DMatrix<f64>,
    loads: DVector<f64>,
}

impl<'a> Statics<'a> {
    /// For the forces at some places of a group.
    pub fn new(setting: &Setting, state: &State, group: &Group, places: Vec<Place<'a>>) -> Self {
        let space = setting.space;
        let directions: Vec<Vec<Vector<3>>> = places.iter().map(|p| p.directions(space)).collect();
        let mut unknowns = 0;
        let mut first = Vec::new();
        for list in &directions {
            first.push(unknowns);
            unknowns += list.len();
        }
        let members: Vec<Member> = group.members.iter().map(|k| Member::new(setting, state, *k, &places)).collect();
        let limits = places.iter().map(|p| if let Friction::Disc(limit) = p.friction { limit } else { 0.0 });
        let force = members.iter().map(|m| m.largest).chain(limits).fold(0.0, f64::max);
        let unit = if force > 0.0 { force } else { 1.0 };
        let rows = space.directions().len() + space.axes().len();
        let mut matrix = DMatrix::zeros(rows * members.len(), unknowns);
        let mut loads = DVector::zeros(rows * members.len());
        for (m, member) in members.iter().enumerate() {
            loads.rows_mut(m * rows, rows).copy_from(&(member.balance(space, &member.force, &member.moment) / unit));
            for ((place, list), start) in places.iter().zip(&directions).zip(&first) {
                let Some((x, sign)) = member.touched(setting, place) else { continue };
                for (j, direction) in list.iter().enumerate() {
                    let force = direction * sign;
                    let entries = member.balance(space, &force, &(x - member.centre).cross(&force));
                    matrix.view_mut((m * rows, start + j), (rows, 1)).copy_from(&entries);
                }
            }
        }
        Statics { places, first, unknowns, force, matrix, loads }
    }

    /// The equations that are not the same.
    pub fn independent(&self) -> Independent {
        let count = self.matrix.nrows();
        let of = |kept: &[usize], lack| {
            let right = -self.loads.select_rows(kept);
            Independent { rows: self.matrix.select_rows(kept), right, lack }
        };
        if self.matrix.is_empty() {
            return of(&[], self.loads.amax());
        }
        let svd = self.matrix.clone().svd(true, false);
        let Some(u) = svd.u else { return of(&[], f64::INFINITY) };
        let (values, most) = (&svd.singular_values, svd.singular_values.max());
        let kept: Vec<usize> = (0..values.len()).filter(|k| values[*k] > RANK * most).collect();
        let u = u.select_columns(&kept);
        let lack = (&self.loads - &u * u.tr_mul(&self.loads)).amax();
        // Those least like the ones before.
        let mut order = RowDVector::from_fn(count, |_, k| k);
        if kept.len() < count {
            self.matrix.transpose().col_piv_qr().p().permute_columns(&mut order);
        }
        of(&order.as_slice()[..kept.len()], lack)
    }

    /// How many equations there are, the same ones counted too.
    pub fn equations(&self) -> usize {
        self.matrix.nrows()
    }
}

/// Equations `rows · y = right` for the forces.
pub struct Independent {
    pub rows: DMatrix<f64>,
    pub right: DVector<f64>,
    /// The largest part of the loads that no forces at the places can hold.
    pub lack: f64,
}

/// A body of a group: what is given of the forces on it, with their moment about the middle of its places.
struct Member {
    body: usize,
    centre: Point<3>,
    /// The typical length: its size.
    length: f64,
    force: Vector<3>,
    moment: Vector<3>,
    /// The largest of these forces, and moments by the length.
    largest: f64,
}

impl Member {
    fn new(setting: &Setting, state: &State, body: usize, places: &[Place<'_>]) -> Self {
        let zero = Vector::<3>::zeros();
        let size = setting.bodies[body].form.size();
        let length = if size > 0.0 { size } else { 1.0 };
        let mut out = Member { body, centre: zero, length, force: zero, moment: zero, largest: 0.0 };
        let touched: Vec<(Point<3>, f64, Friction)> =
            places.iter().filter_map(|p| out.touched(setting, p).map(|(x, sign)| (x, sign, p.friction))).collect();
        out.centre = touched.iter().map(|t| t.0).sum::<Vector<3>>() / touched.len().max(1) as f64;
        for acting in state.forces.iter().filter(|a| a.body == body) {
            out.add(acting.force, acting.moment.unwrap_or(zero) - out.centre.cross(&acting.force));
        }
        for (x, sign, friction) in touched {
            if let Friction::Given(force) = friction {
                out.add(force * sign, (x - out.centre).cross(&(force * sign)));
            }
        }
        out
    }

    fn add(&mut self, force: Vector<3>, moment: Vector<3>) {
        self.force += force;
        self.moment += moment;
        self.largest = self.largest.max(force.norm()).max(moment.norm() / self.length);
    }

    /// What a force with its moment adds to the equations.
    fn balance(&self, space: Space, force: &Vector<3>, moment: &Vector<3>) -> DVector<f64> {
        let forces = space.directions().iter().map(|i| force[*i]);
        let moments = space.axes().iter().map(|i| moment[*i] / self.length);
        DVector::from_iterator(space.directions().len() + space.axes().len(), forces.chain(moments))
    }

    /// Where a place is on this body, and the sign with which its forces act on it.
    fn touched(&self, setting: &Setting, place: &Place<'_>) -> Option<(Point<3>, f64)> {
        match setting.contacts[place.contact].bodies {
            [first, _] if first == self.body => Some((place.touch.x, 1.0)),
            [_, second] if second == self.body => Some((place.touch.foot, -1.0)),
            _ => None,
        }
    }
}
