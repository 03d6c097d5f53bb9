//! Loads in the volume of the material and on places of its boundary, on the reference configuration; pressures at finite strain
//! on the current area `cof(F) N`, by the polynomials of each cell, so that their work is that of the volume.

use super::{CellSolid, normal_change, normal_now};
use crate::cell::Site;
use crate::shapes::spatial;
use crate::space::Tabulation;
use rayon::prelude::*;
use signorini_geometry::{Point, Vector};
use signorini_material::Space;
use signorini_mechanics::{Contribution, Load, Order, PlaceError};

impl<const D: usize> CellSolid<D> {
    pub(super) fn add_load(
        &self,
        on: Option<&str>,
        load: &Load<'_>,
        u: &[f64],
        order: Order,
        out: &mut Contribution,
    ) -> Result<(), PlaceError> {
        match load {
            Load::BodyForce(force) => {
                if let Some(place) = on {
                    return Err(self.unsuitable(format!("`{place}` has no volume for a force per volume")));
                }
                self.in_volume(force, out);
                Ok(())
            }
            Load::Force(force) if on.is_none() => {
                let density = force / self.body.volume();
                self.in_volume(&|_| density, out);
                Ok(())
            }
            Load::Force(force) => {
                let sites = self.points_of(self.surface(on)?);
                let density = force / sites.iter().map(|s| s.weight).sum::<f64>();
                self.on_sites(sites, &|_| density, out);
                Ok(())
            }
            Load::Traction(traction) => {
                self.on_sites(self.points_of(self.surface(on)?), &|s| traction(&spatial(&s.x)), out);
                Ok(())
            }
            Load::Pressure(pressure) if !self.body.law().is_small_strain() => {
                self.follower_pressure(self.points_of(self.surface(on)?), pressure, u, order, out);
                Ok(())
            }
            Load::Pressure(pressure) => {
                let push = |s: &Site<D>| spatial(&s.normal) * -pressure(&spatial(&s.x));
                self.on_sites(self.points_of(self.surface(on)?), &push, out);
                Ok(())
            }
            Load::Springs(stiffness) => {
                self.springs(self.points_of(self.surface(on)?), stiffness, u, order, out);
                Ok(())
            }
            Load::Moment(_) | Load::FollowerMoment(_) => {
                Err(self.unsuitable("moments on bodies of cells are not available: use tractions with this moment"))
            }
            Load::NodalForce(_) => Err(self.unsuitable("finite cells have no nodes: give a force")),
            Load::Tension(_) => Err(self.unsuitable("a tension acts on the end of a rope")),
        }
    }

    /// Minus a force at a point that the functions of a cell move.
    fn push(&self, cell: usize, values: &[f64], force: &Vector<3>, out: &mut [f64]) {
        for (f, value) in self.body.cells()[cell].functions.iter().zip(values) {
            for i in 0..D {
                if let Some(unknown) = self.unknown(*f, i) {
                    out[unknown as usize] -= value * force[i];
                }
            }
        }
    }

    fn in_volume(&self, force: &dyn Fn(&Point<3>) -> Vector<3>, out: &mut Contribution) {
        // Fields need not be shared between threads; the functions are what takes time.
        let mut parts: Vec<Vec<(Point<D>, Vector<3>)>> = Vec::with_capacity(self.body.cells().len());
        for cell in self.body.cells() {
            let points = self.body.volume_points(cell);
            let part = |(x, w): (Point<D>, f64)| (x, force(&spatial(&x)) * (w * self.body.turn(&x)));
            parts.push(points.into_iter().map(part).collect());
        }
        let of_cells: Vec<Vec<Vector<3>>> = (parts.par_iter().enumerate())
            .map(|(cell, points)| {
                let mut t = Tabulation::default();
                let mut sums = vec![Vector::<3>::zeros(); self.body.cells()[cell].functions.len()];
                for (x, force) in points {
                    self.body.functions_at(cell, x, &mut t);
                    sums.iter_mut().zip(&t.value).for_each(|(s, v)| *s += force * *v);
                }
                sums
            })
            .collect();
        for (cell, sums) in self.body.cells().iter().zip(&of_cells) {
            for (f, sum) in cell.functions.iter().zip(sums) {
                for i in 0..D {
                    if let Some(unknown) = self.unknown(*f, i) {
                        out.forces[unknown as usize] -= sum[i];
                    }
                }
            }
        }
    }

    fn on_sites(&self, sites: &[Site<D>], traction: &dyn Fn(&Site<D>) -> Vector<3>, out: &mut Contribution) {
        let mut t = Tabulation::default();
        for site in sites {
            let force = traction(site) * site.weight;
            self.body.functions_at(site.cell, &site.x, &mut t);
            self.push(site.cell, &t.value, &force, &mut out.forces);
        }
    }

    fn follower_pressure(
        &self,
        sites: &[Site<D>],
        pressure: &dyn Fn(&Point<3>) -> f64,
        u: &[f64],
        order: Order,
        out: &mut Contribution,
    ) {
        let around = self.body.space() == Space::Axisymmetric;
        let mut t = Tabulation::default();
        // Points of a cell follow each other.
        for own in sites.chunk_by(|a, b| a.cell == b.cell) {
            let unknowns = self.body.unknowns_of(own[0].cell);
            let n = unknowns.len();
            let mut block = vec![0.0; if order == Order::Second { n * n } else { 0 }];
            for site in own {
                self.body.functions_at(site.cell, &site.x, &mut t);
                let (moved, gradient) = self.displacement(site.cell, &t, u);
                let size = site.weight * pressure(&spatial(&site.x));
                // The circumference grows with the radius.
                let wider = if around { 1.0 + moved[0] / site.x[0] } else { 1.0 };
                let normal = normal_now(&site.normal, &gradient);
                self.push(site.cell, &t.value, &(normal * (-size * wider)), &mut out.forces);
                if order == Order::First {
                    continue;
                }
                let mut change: Vec<Vector<3>> = Vec::with_capacity(n);
                for (value, slope) in t.value.iter().zip(&t.gradient) {
                    for i in 0..D {
                        let grown = if around && i == 0 { value / site.x[0] } else { 0.0 };
                        change.push(normal_change(&site.normal, &gradient, i, slope) * wider + normal * grown);
                    }
                }
                for row in (0..n).filter(|k| !self.is_zero[unknowns[*k] as usize]) {
                    for column in (0..n).filter(|k| !self.is_zero[unknowns[*k] as usize]) {
                        block[row * n + column] += size * t.value[row / D] * change[column][row % D];
                    }
                }
            }
            if order == Order::Second {
                out.add_block(&unknowns, &block);
            }
        }
    }

    /// Springs to the ground: force per displacement and reference area.
    fn springs(&self, sites: &[Site<D>], stiffness: &Vector<3>, u: &[f64], order: Order, out: &mut Contribution) {
        let mut t = Tabulation::default();
        // Points of a cell follow each other.
        for own in sites.chunk_by(|a, b| a.cell == b.cell) {
            let unknowns = self.body.unknowns_of(own[0].cell);
            let n = unknowns.len();
            let mut block = vec![0.0; if order == Order::Second { n * n } else { 0 }];
            for site in own {
                self.body.functions_at(site.cell, &site.x, &mut t);
                let moved = spatial(&self.displacement(site.cell, &t, u).0);
                let force = -stiffness.component_mul(&moved) * site.weight;
                self.push(site.cell, &t.value, &force, &mut out.forces);
                if order == Order::First {
                    continue;
                }
                for (a, v) in t.value.iter().enumerate() {
                    for (b, w) in t.value.iter().enumerate() {
                        for i in 0..D {
                            let [row, column] = [D * a + i, D * b + i];
                            let is_zero = [row, column].iter().any(|k| self.is_zero[unknowns[*k] as usize]);
                            let value = if is_zero { 0.0 } else { site.weight * stiffness[i] * v * w };
                            block[row * n + column] += value;
                        }
                    }
                }
            }
            if order == Order::Second {
                out.add_block(&unknowns, &block);
            }
        }
    }
}
