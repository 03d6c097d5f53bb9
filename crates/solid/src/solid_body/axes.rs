//! What supports hold along axes of their own.
//!
//! Along axes that are the same at all points the coefficients of every function are held, as along those of space. Along axes
//! that turn the displacement is held at the points of a function each: the vertices, and at degree 2 the middles of edges, faces
//! and cells.

use super::SolidBody;
use super::projection::{functions, project, vertices};
use super::spatial::spatial;
use signorini_fem::cell_map::CellMap;
use signorini_fem::hierarchic::Values;
use signorini_fem::{Group, Local};
use signorini_geometry::{Point, Vector};
use signorini_mechanics::body::Field;
use signorini_mechanics::{Axes, Constraint, PlaceError};
use std::collections::{BTreeMap, BTreeSet};

/// A point, and the functions that do not vanish there with their values.
type At<const D: usize> = (Point<D>, Vec<(u32, f64)>);

impl<const D: usize> SolidBody<D> {
    /// The equations of a group that is held along axes.
    ///
    /// # Errors
    /// Axes that turn about a line with points of the group, or at degrees beyond 2; a group without anything to hold.
    pub(super) fn along_axes(
        &self,
        group: &Group,
        axes: &Axes,
        displacement: &[Option<Field<'_>>; 3],
        u: &[f64],
        on: Option<&str>,
    ) -> Result<Vec<Constraint>, PlaceError> {
        let body = self.body();
        let on = on.unwrap_or("all");
        let held = displacement.each_ref().map(Option::is_some);
        let undefined = |x: &Point<D>| {
            let at: Vec<String> = x.iter().map(|v| format!("{v}")).collect();
            self.unsuitable(format!("the point ({}) of `{on}` is on the line about which the axes turn", at.join(", ")))
        };
        let wanted = |x: &Point<D>| -> Point<D> {
            let x = spatial(x);
            let components = displacement.each_ref().map(|d| d.map(|field| field(&x)));
            let vector = axes.vector(&x, components).unwrap_or_default();
            Point::<D>::from_fn(|i, _| vector[i])
        };
        let is_vertex = self.vertex_functions();
        let mut out = Vec::new();
        let mut hold = |rows: &[Vector<3>], terms: &[(u32, f64)], lacking: &Point<D>| {
            let share: f64 = terms.iter().filter(|(f, _)| is_vertex[*f as usize]).map(|(_, n)| n).sum();
            for row in rows {
                let of = |(f, n): (u32, f64)| (0..D).map(move |i| (D as u32 * f + i as u32, n * row[i]));
                let terms: Vec<(u32, f64)> = terms.iter().copied().flat_map(of).filter(|t| t.1 != 0.0).collect();
                let violation = (0..D).map(|i| row[i] * lacking[i]).sum();
                if !terms.is_empty() {
                    out.push(Constraint { terms, violation, reaction: [row * share, Vector::<3>::zeros()] });
                }
            }
        };
        if let Axes::Rectangular(_) = axes {
            let rows = axes.span(&Vector::<3>::zeros(), held).unwrap_or_default();
            let (mut all, mut values) = (functions(body, group), project(body, group, &wanted));
            if !self.between(group, &wanted, &mut all, &mut values).is_empty() {
                return Err(self.only_along_space(on));
            }
            for f in all {
                let value = values.get(&f).copied().unwrap_or_else(Point::<D>::zeros);
                hold(&rows, &[(f, 1.0)], &(Self::coefficients(u, f) - value));
            }
            return Ok(out);
        }
        if body.dofs.is_spline() || body.degree > 2 {
            let what = if body.dofs.is_spline() { "NURBS".into() } else { format!("degree {}", body.degree) };
            return Err(self.unsuitable(format!("supports with cylindrical axes require degree 1 or 2, not {what}")));
        }
        for (x, terms) in self.held_points(group).ok_or_else(|| self.only_along_space(on))? {
            let rows = axes.span(&spatial(&x), held).ok_or_else(|| undefined(&x))?;
            let moved: Point<D> = terms.iter().map(|(f, n)| Self::coefficients(u, *f) * *n).sum();
            hold(&rows, &terms, &(moved - wanted(&x)));
        }
        Ok(out)
    }

    /// The points at which a group is held, with the functions there; `None` if a node in the middle of an edge is held without
    /// the ends of it, at degree 1.
    fn held_points(&self, group: &Group) -> Option<Vec<At<D>>> {
        let body = self.body();
        let mut out: BTreeMap<Vec<u32>, At<D>> = BTreeMap::new();
        let mut held = BTreeSet::new();
        for v in vertices(body, group) {
            if let Some(f) = body.dofs.vertex(v) {
                held.insert(f);
                out.insert(vec![f], (body.mesh.nodes()[v as usize], vec![(f, 1.0)]));
            }
        }
        let (mut at, mut of_map) = (Values::default(), Values::default());
        let mut point = |cell: usize, xi: &Local| {
            body.mesh.map(cell).tabulate(xi, &mut of_map);
            body.dofs.basis(cell).tabulate(xi, &mut at);
            let values = body.dofs.cell(cell).zip(&at.value).filter(|(_, n)| n.abs() > ZERO);
            let mut terms: Vec<(u32, f64)> = values.map(|((f, sign), n)| (f, sign * n)).collect();
            terms.sort_by_key(|(f, _)| *f);
            (body.mesh.position(cell, &of_map), terms)
        };
        if body.degree > 1 {
            let mut places: Vec<(usize, Local)> = Vec::new();
            for side in &group.sides {
                let (cell, number) = (side.cell as usize, side.side as usize);
                let of_side = CellMap::new(body.mesh.side_shape(*side), body.degree);
                places.extend(of_side.nodes().iter().map(|s| (cell, body.mesh.shape(cell).on_side(number, s).0)));
            }
            for cell in group.cells.iter().map(|c| *c as usize) {
                let of_cell = CellMap::new(body.mesh.shape(cell), body.degree);
                places.extend(of_cell.nodes().iter().map(|xi| (cell, *xi)));
            }
            for (cell, xi) in places {
                let (x, terms) = point(cell, &xi);
                out.insert(terms.iter().map(|(f, _)| *f).collect(), (x, terms));
            }
        }
        for between in &group.between {
            let cell = between.cell as usize;
            let (x, terms) = point(cell, &body.mesh.map(cell).nodes()[usize::from(between.place)]);
            match body.degree {
                1 if terms.iter().all(|(f, _)| held.contains(f)) => {}
                1 => return None,
                _ => drop(out.insert(terms.iter().map(|(f, _)| *f).collect(), (x, terms))),
            }
        }
        Some(out.into_values().collect())
    }
}

/// A function that vanishes at a point but for rounding.
const ZERO: f64 = 1e-12;
