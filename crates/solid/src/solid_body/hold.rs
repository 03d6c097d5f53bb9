//! What supports hold: functions on a place, at the values that fit a prescribed displacement best.

use super::SolidBody;
use super::projection::{functions, project};
use super::spatial::spatial;
use crate::body::Bodies;
use signorini_fem::Group;
use signorini_geometry::{Point, Vector};
use signorini_mechanics::pair::axis;
use signorini_mechanics::{Constraint, Hold, PlaceError};

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
        let all = functions(body, &group);
        if all.is_empty() {
            return Err(self.unsuitable(format!("`{}` has nothing that could be held", on.unwrap_or("all"))));
        }
        let wanted = |x: &Point<D>| {
            let x = spatial(x);
            Point::<D>::from_fn(|i, _| hold.displacement[i].map_or(0.0, |field| field(&x)))
        };
        let wanted = project(body, &group, &wanted);
        let mut is_vertex = vec![false; body.dofs.count()];
        body.vertex_unknowns().for_each(|k| is_vertex[k / D] = true);
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
        if let Some((n, field)) = &hold.along {
            let direction = Point::<D>::from_fn(|i, _| n[i]);
            let wanted = project(body, &group, &|x| direction * field(&spatial(x)));
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

/// Coefficients of the reference position: the vertices, and on cells with curved edges what fits edges and sides best.
pub(super) fn position<const D: usize>(bodies: &Bodies<D>) -> Vec<Point<D>> {
    let body = &bodies.list[0];
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
