//! Loads on a solid: in its volume, on its sides, following them at finite strain.
//!
//! A pressure `p` acts on the current area, `r = p ∫ N x_1 × x_2`; its derivative is that of the area normal, symmetric on
//! a closed surface (Bufler 1984). At small strain it acts on the reference area.

use super::projection::vertices;
use super::spatial::spatial;
use super::{SolidBody, axis};
use rayon::prelude::*;
use signorini_contact::{ContactSurface, FacePoint, ShapeFunction};
use signorini_fem::hierarchic::Values;
use signorini_fem::rules::rule;
use signorini_fem::small::determinant;
use signorini_geometry::{Point, Vector};
use signorini_material::Space;
use signorini_mechanics::{Contribution, Load, Order, PlaceError};
use std::f64::consts::TAU;

impl<const D: usize> SolidBody<D> {
    pub(super) fn add_load(
        &self,
        on: Option<&str>,
        load: &Load<'_>,
        u: &[f64],
        order: Order,
        out: &mut Contribution,
    ) -> Result<(), PlaceError> {
        match load {
            Load::BodyForce(force) => self.body_force(on, force, out),
            Load::Force(force) => self.resultant(on, force, out),
            Load::NodalForce(force) => self.nodal_force(on, force, out),
            Load::Traction(traction) => {
                self.on_sides(on, &mut |x, area, list| push::<D>(list, &(traction(x) * area), out)).map(|_| ())
            }
            Load::Pressure(pressure) if self.law().is_small_strain() => self.dead_pressure(on, pressure, out),
            Load::Pressure(pressure) => self.follower_pressure(on, pressure, u, order, out),
            Load::Springs(stiffness) => self.springs(on, stiffness, u, order, out),
            Load::Moment(moment) => self.moment(on, moment, u, order, out),
            Load::FollowerMoment(_) => {
                Err(self
                    .unsuitable("nothing of a solid tells how a moment turns with it: state a moment about fixed axes"))
            }
            Load::Tension(_) => Err(self.unsuitable("a tension pulls the end of a rope")),
        }
    }

    /// Visits quadrature points of the sides of a place at rest, with what they stand for and what moves them; the area.
    pub(super) fn on_sides(
        &self,
        on: Option<&str>,
        visit: &mut dyn FnMut(&Point<3>, f64, &[ShapeFunction]),
    ) -> Result<f64, PlaceError> {
        let mut area = 0.0;
        self.at_sides(on, &mut |point, w, list| {
            let part = w * self.bodies.measure(&point.x) * point.area_normal().norm();
            area += part;
            visit(&spatial(&point.x), part, list);
        })?;
        Ok(area)
    }

    fn at_sides(
        &self,
        on: Option<&str>,
        visit: &mut dyn FnMut(&FacePoint<D>, f64, &[ShapeFunction]),
    ) -> Result<(), PlaceError> {
        let group = self.group(on)?;
        if group.sides.is_empty() {
            return Err(self.unsuitable(format!("`{}` has no sides for a load per area", on.unwrap_or("boundary"))));
        }
        let surface = self.bodies.surface(0, group.sides.clone());
        for face in 0..surface.face_count() {
            for (s, w) in rule(surface.shape(face), self.body().degree + 3) {
                visit(&surface.at(face, &s), w, &surface.functions(face, &s));
            }
        }
        Ok(())
    }

    fn body_force(
        &self,
        on: Option<&str>,
        force: &dyn Fn(&Point<3>) -> Vector<3>,
        out: &mut Contribution,
    ) -> Result<(), PlaceError> {
        self.in_cells(on, "a force per volume", &mut |x, volume, list| {
            let value = force(x) * volume;
            list.for_each(|(f, v)| (0..D).for_each(|k| out.forces[D * f as usize + k] -= v * value[k]));
        })
    }

    /// Visits quadrature points of the cells of a place at rest, with what they stand for and the functions there with their
    /// values; `what` asks for cells.
    pub(super) fn in_cells(
        &self,
        on: Option<&str>,
        what: &str,
        visit: &mut dyn FnMut(&Point<3>, f64, &mut dyn Iterator<Item = (u32, f64)>),
    ) -> Result<(), PlaceError> {
        let body = self.body();
        let cells: Vec<u32> = match on {
            None => (0..body.mesh.cell_count() as u32).collect(),
            Some(name) => match &self.group(on)?.cells {
                list if list.is_empty() => return Err(self.unsuitable(format!("`{name}` has no cells for {what}"))),
                list => list.clone(),
            },
        };
        for cell in cells.into_iter().map(|c| c as usize) {
            let table = self.table(cell);
            for (q, (_, w)) in table.points.iter().enumerate() {
                let (x, jacobian) = body.mesh.jacobian(cell, &table.map[q]);
                let volume = w * determinant(&jacobian) * self.bodies.measure(&x);
                let functions = body.dofs.cell(cell).zip(&table.basis[q].value);
                visit(&spatial(&x), volume, &mut functions.map(|((f, sign), v)| (f, sign * v)));
            }
        }
        Ok(())
    }

    /// A resultant, spread evenly over the sides of a place, or else its cells, or its vertices; without a place over the
    /// whole body.
    fn resultant(&self, on: Option<&str>, force: &Vector<3>, out: &mut Contribution) -> Result<(), PlaceError> {
        let mut unit = Contribution::new(out.forces.len());
        let group = self.group(on)?;
        let total = if on.is_some() && !group.sides.is_empty() {
            self.on_sides(on, &mut |_, area, list| push::<D>(list, &(force * area), &mut unit))?
        } else if on.is_none() || !group.cells.is_empty() {
            self.body_force(on, &|_| *force, &mut unit)?;
            self.volume(on)?
        } else {
            let list: Vec<u32> = group.vertices.iter().filter_map(|v| self.body().dofs.vertex(*v)).collect();
            for f in &list {
                (0..D).for_each(|i| unit.forces[D * *f as usize + i] -= force[i]);
            }
            list.len() as f64
        };
        if total == 0.0 {
            return Err(self.unsuitable(format!("`{}` is empty", on.unwrap_or("all"))));
        }
        out.forces.iter_mut().zip(unit.forces).for_each(|(o, f)| *o += f / total);
        Ok(())
    }

    /// The same force on each node of a place; without a place on all vertices of the boundary.
    fn nodal_force(&self, on: Option<&str>, force: &Vector<3>, out: &mut Contribution) -> Result<(), PlaceError> {
        let body = self.body();
        let group = self.group(on)?;
        let (mut at, mut nodes) = (Values::default(), 0);
        for f in vertices(body, group).into_iter().filter_map(|v| body.dofs.vertex(v)) {
            (0..D).for_each(|i| out.forces[D * f as usize + i] -= force[i]);
            nodes += 1;
        }
        for between in &group.between {
            let cell = between.cell as usize;
            body.dofs.basis(cell).tabulate(&body.mesh.map(cell).nodes()[usize::from(between.place)], &mut at);
            for ((f, sign), value) in body.dofs.cell(cell).zip(&at.value) {
                (0..D).for_each(|i| out.forces[D * f as usize + i] -= sign * value * force[i]);
            }
            nodes += 1;
        }
        match nodes {
            0 => Err(self.unsuitable(format!("`{}` has no nodes for a force on each of them", on.unwrap_or("all")))),
            _ => Ok(()),
        }
    }

    fn volume(&self, on: Option<&str>) -> Result<f64, PlaceError> {
        let body = self.body();
        let all = (0..body.mesh.cell_count() as u32).collect();
        let cells = if on.is_none() { all } else { self.group(on)?.cells.clone() };
        let of = |cell: &u32| -> f64 {
            let table = self.table(*cell as usize);
            (table.points.iter().zip(&table.map))
                .map(|((_, w), at)| {
                    let (x, jacobian) = body.mesh.jacobian(*cell as usize, at);
                    w * determinant(&jacobian) * self.bodies.measure(&x)
                })
                .sum()
        };
        let parts: Vec<f64> = cells.par_iter().map(of).collect();
        Ok(parts.iter().sum())
    }

    fn dead_pressure(
        &self,
        on: Option<&str>,
        pressure: &dyn Fn(&Point<3>) -> f64,
        out: &mut Contribution,
    ) -> Result<(), PlaceError> {
        self.at_sides(on, &mut |point, w, list| {
            let size = -w * self.bodies.measure(&point.x) * pressure(&spatial(&point.x));
            push::<D>(list, &(spatial(&point.area_normal()) * size), out);
        })
    }

    fn follower_pressure(
        &self,
        on: Option<&str>,
        pressure: &dyn Fn(&Point<3>) -> f64,
        u: &[f64],
        order: Order,
        out: &mut Contribution,
    ) -> Result<(), PlaceError> {
        let around = self.bodies.space == Space::Axisymmetric;
        self.at_sides(on, &mut |point, w, list| {
            let size = w * pressure(&spatial(&point.x));
            let mut now = *point;
            for f in list {
                let own = Point::<D>::from_fn(|i, _| u[f.unknown as usize + i]);
                now.x += own * f.value;
                (0..D - 1).for_each(|a| now.tangents[a] += own * f.slopes[a]);
            }
            let measure = if around { TAU * now.x[0] } else { 1.0 };
            let normal = spatial(&now.area_normal());
            push::<D>(list, &(normal * (-size * measure)), out);
            if order == Order::First {
                return;
            }
            // Derivative of the area normal in each unknown.
            let [x1, x2] = now.tangents.each_ref().map(spatial);
            let mut change = Vec::with_capacity(D * list.len());
            for f in list {
                for i in 0..D {
                    let e = axis(i);
                    let turned = if D == 2 {
                        e.cross(&Vector::<3>::z()) * f.slopes[0]
                    } else {
                        e.cross(&x2) * f.slopes[0] + x1.cross(&e) * f.slopes[1]
                    };
                    let wider = if around && i == 0 { TAU * f.value } else { 0.0 };
                    change.push(turned * measure + normal * wider);
                }
            }
            let n = change.len();
            let block: Vec<f64> =
                (0..n * n).map(|k| size * list[k / n / D].value * change[k % n][(k / n) % D]).collect();
            out.add_block(&unknowns::<D>(list), &block);
        })
    }

    /// Springs to the ground: force per displacement and reference area.
    fn springs(
        &self,
        on: Option<&str>,
        stiffness: &Vector<3>,
        u: &[f64],
        order: Order,
        out: &mut Contribution,
    ) -> Result<(), PlaceError> {
        self.on_sides(on, &mut |_, area, list| {
            let mut moved = Vector::<3>::zeros();
            for f in list {
                (0..D).for_each(|i| moved[i] += f.value * u[f.unknown as usize + i]);
            }
            push::<D>(list, &(-stiffness.component_mul(&moved) * area), out);
            if order == Order::Second {
                let n = D * list.len();
                let entry = |r: usize, c: usize| {
                    let diagonal = if r % D == c % D { stiffness[r % D] } else { 0.0 };
                    area * diagonal * list[r / D].value * list[c / D].value
                };
                let block: Vec<f64> = (0..n * n).map(|k| entry(k / n, k % n)).collect();
                out.add_block(&unknowns::<D>(list), &block);
            }
        })
        .map(|_| ())
    }
}

fn unknowns<const D: usize>(list: &[ShapeFunction]) -> Vec<u32> {
    list.iter().flat_map(|f| (0..D as u32).map(move |i| f.unknown + i)).collect()
}

/// A force at a point that functions move.
fn push<const D: usize>(list: &[ShapeFunction], force: &Vector<3>, out: &mut Contribution) {
    for f in list {
        (0..D).for_each(|i| out.forces[f.unknown as usize + i] -= f.value * force[i]);
    }
}
