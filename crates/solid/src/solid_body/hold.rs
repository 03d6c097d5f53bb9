//! What supports hold: functions on a place, at the values that fit a prescribed displacement best.

use super::SolidBody;
use super::projection::{functions, project};
use super::spatial::spatial;
use crate::body::Bodies;
use signorini_fem::Group;
use signorini_fem::hierarchic::Values;
use signorini_geometry::{Point, Vector};
use signorini_mechanics::pair::axis;
use signorini_mechanics::{Constraint, Hold, PlaceError};
use std::collections::{BTreeMap, BTreeSet};

impl<const D: usize> SolidBody<D> {
    pub(super) fn constraints(
        &self,
        on: Option<&str>,
        hold: &Hold<'_>,
        u: &[f64],
    ) -> Result<Vec<Constraint>, PlaceError> {
        if hold.rotation.iter().any(Option::is_some) {
            return Err(self.unsuitable("a solid has no rotations that could be held: hold displacements of a group"));
        }
        let body = self.body();
        let group = match on {
            Some(_) => self.group(on)?.clone(),
            None => Group { cells: (0..body.mesh.cell_count() as u32).collect(), ..Group::default() },
        };
        let mut all = functions(body, &group);
        if all.is_empty() && group.between.is_empty() {
            return Err(self.unsuitable(format!("`{}` has nothing that could be held", on.unwrap_or("all"))));
        }
        if let Some(axes) = &hold.axes {
            return self.along_axes(&group, axes, &hold.displacement, u, on);
        }
        let wanted = |x: &Point<D>| {
            let x = spatial(x);
            Point::<D>::from_fn(|i, _| hold.displacement[i].map_or(0.0, |field| field(&x)))
        };
        let at = wanted;
        let mut wanted = project(body, &group, &at);
        let coupled = self.between(&group, &at, &mut all, &mut wanted);
        let is_vertex = self.vertex_functions();
        // The functions of the vertices add up to one: forces on them make the resultant.
        let reaction =
            |f: u32, along: Vector<3>| [along * f64::from(u8::from(is_vertex[f as usize])), Vector::<3>::zeros()];
        let mut out = Vec::new();
        for &f in &all {
            for i in (0..D).filter(|&i| hold.displacement[i].is_some()) {
                let unknown = D as u32 * f + i as u32;
                let value = wanted.get(&f).map_or(0.0, |c| c[i]);
                let (terms, violation) = (vec![(unknown, 1.0)], u[unknown as usize] - value);
                out.push(Constraint { terms, violation, reaction: reaction(f, axis(i)) });
            }
        }
        for Coupled { terms, value } in &coupled {
            for i in (0..D).filter(|&i| hold.displacement[i].is_some()) {
                let terms: Vec<(u32, f64)> = terms.iter().map(|(f, n)| (D as u32 * f + i as u32, *n)).collect();
                let moved: f64 = terms.iter().map(|(k, n)| n * u[*k as usize]).sum();
                let share: f64 = terms.iter().filter(|(k, _)| is_vertex[*k as usize / D]).map(|(_, n)| n).sum();
                let reaction = [axis(i) * share, Vector::<3>::zeros()];
                out.push(Constraint { terms, violation: moved - value[i], reaction });
            }
        }
        if !coupled.is_empty() && (hold.along.is_some() || hold.uniform != [false; 3]) {
            return Err(self.only_along_space(on.unwrap_or("all")));
        }
        if let Some((n, field)) = &hold.along {
            let direction = Point::<D>::from_fn(|i, _| n[i]);
            let at = |x: &Point<D>| direction * field(&spatial(x));
            let mut wanted = project(body, &group, &at);
            self.between(&group, &at, &mut all.clone(), &mut wanted);
            for &f in &all {
                let own = |i: usize| (D as u32 * f + i as u32, n[i]);
                let terms: Vec<(u32, f64)> = (0..D).map(own).filter(|t| t.1 != 0.0).collect();
                let violation = direction
                    .dot(&(Self::coefficients(u, f) - wanted.get(&f).copied().unwrap_or_else(Point::<D>::zeros)));
                out.push(Constraint { terms, violation, reaction: reaction(f, *n) });
            }
        }
        let first = all.iter().copied().find(|f| is_vertex[*f as usize]);
        for i in (0..D).filter(|i| hold.uniform[*i]) {
            // A constant is the same at all vertices, and nothing on edges and sides.
            for &f in all.iter().filter(|f| Some(**f) != first) {
                let [own, other] =
                    [Some(f), first.filter(|_| is_vertex[f as usize])].map(|f| f.map(|f| D as u32 * f + i as u32));
                let ends = own.into_iter().zip([1.0]).chain(other.into_iter().zip([-1.0]));
                let terms: Vec<(u32, f64)> = ends.collect();
                let violation = terms.iter().map(|(k, s)| s * u[*k as usize]).sum();
                out.push(Constraint { terms, violation, reaction: [Vector::<3>::zeros(); 2] });
            }
        }
        Ok(out)
    }
}

impl<const D: usize> SolidBody<D> {
    /// Whether a function is that of a vertex, or one of a spline.
    pub(super) fn vertex_functions(&self) -> Vec<bool> {
        let body = self.body();
        let mut out = vec![false; body.dofs.count()];
        body.unity_unknowns().for_each(|k| out[k / D] = true);
        out
    }

    pub(super) fn only_along_space(&self, on: &str) -> PlaceError {
        self.unsuitable(format!(
            "`{on}` has nodes in the middle of edges without the ends of these: they can only be held along the axes of space"
        ))
    }
}

/// A node whose displacement several functions make that are not held: `Σ N_f u_f = value`.
pub(super) struct Coupled<const D: usize> {
    terms: Vec<(u32, f64)>,
    value: Point<D>,
}

impl<const D: usize> SolidBody<D> {
    /// Adds what nodes in the middle of edges and faces hold: a function where all others there are held already.
    pub(super) fn between(
        &self,
        group: &Group,
        wanted: &dyn Fn(&Point<D>) -> Point<D>,
        held: &mut BTreeSet<u32>,
        values: &mut BTreeMap<u32, Point<D>>,
    ) -> Vec<Coupled<D>> {
        let body = self.body();
        let (mut at, mut of_map, mut out) = (Values::default(), Values::default(), Vec::new());
        for between in &group.between {
            let cell = between.cell as usize;
            let map = body.mesh.map(cell);
            let xi = map.nodes()[usize::from(between.place)];
            map.tabulate(&xi, &mut of_map);
            body.dofs.basis(cell).tabulate(&xi, &mut at);
            let mut value = wanted(&body.mesh.position(cell, &of_map));
            let mut terms = Vec::new();
            for ((f, sign), n) in body.dofs.cell(cell).zip(&at.value).filter(|(_, n)| n.abs() > 1e-12) {
                match held.contains(&f) {
                    true => value -= values.get(&f).copied().unwrap_or_else(Point::<D>::zeros) * (sign * n),
                    false => terms.push((f, sign * n)),
                }
            }
            match terms[..] {
                [] => {}
                [(f, n)] => {
                    held.insert(f);
                    values.insert(f, value / n);
                }
                _ => out.push(Coupled { terms, value }),
            }
        }
        out
    }
}

/// Coefficients of the reference position: the vertices, and on cells with curved edges what fits edges and sides best.
pub(super) fn position<const D: usize>(bodies: &Bodies<D>) -> Vec<Point<D>> {
    let body = &bodies.list[0];
    if body.dofs.is_spline() {
        return body.function_positions();
    }
    let mut out = vec![Point::<D>::zeros(); body.dofs.count()];
    for (node, x) in body.mesh.nodes().iter().enumerate() {
        if let Some(f) = body.dofs.vertex(node as u32) {
            out[f as usize] = *x;
        }
    }
    let curved = (0..body.mesh.cell_count()).any(|c| body.mesh.map(c).order() > 1);
    if curved && body.degree > 1 {
        let group = Group { sides: body.mesh.all_sides().collect(), ..Group::default() };
        for (f, x) in project(body, &group, &|x| *x) {
            out[f as usize] = x;
        }
    }
    out
}
