//! The material as it is shown: boxes of full cells, and simplices of cut cells clipped at the boundary, so that what is
//! shown ends there.
//!
//! A cut cell is divided into boxes, and these along their diagonal into triangles or tetrahedra (Kuhn's, so that neighbours
//! fit). Where an edge leaves the material its end is found by bisection. Tetrahedra and wedges are hexahedra with corners
//! that coincide.

use crate::body::CellBody;
use crate::fields::{PointState, components};
use crate::region::Filling;
use crate::shapes::spatial;
use rayon::prelude::*;
use signorini_geometry::Point;
use signorini_material::von_mises;
use signorini_mechanics::BodyFields;
use std::collections::BTreeMap;

/// Points with their cells, and what lies between them.
pub(super) struct Shown<const D: usize> {
    points: Vec<(usize, Point<D>)>,
    cells: Vec<Vec<u32>>,
}

/// Halvings of an edge: to a thousandth of a millionth of it.
const HALVINGS: usize = 30;

impl<const D: usize> Shown<D> {
    /// As many boxes along each cell as its degree.
    pub fn new(body: &CellBody<D>) -> Self {
        let of_cells: Vec<Division<'_, D>> = (0..body.cells().len())
            .into_par_iter()
            .map(|cell| {
                let mut division = Division::new(body, cell);
                division.divide();
                division
            })
            .collect();
        let mut out = Shown { points: Vec::new(), cells: Vec::new() };
        for division in of_cells {
            let first = out.points.len() as u32;
            out.points.extend(division.points.iter().map(|x| (division.cell, *x)));
            out.cells.extend(division.cells.iter().map(|c| c.iter().map(|k| first + k).collect::<Vec<u32>>()));
        }
        out
    }

    /// What is shown of the points, of which `has_plastic_strain` tells whether they have one.
    pub fn fields(
        &self,
        shown: &(dyn Fn(usize, &Point<D>) -> PointState<D> + Sync),
        has_plastic_strain: bool,
    ) -> BodyFields {
        let states: Vec<PointState<D>> = self.points.par_iter().map(|(cell, x)| shown(*cell, x)).collect();
        let stress = states.iter().flat_map(|s| components(&s.stress)).collect();
        let equivalent = states.iter().map(|s| von_mises(&s.stress)).collect();
        let mut out = BodyFields {
            points: self.points.iter().map(|(_, x)| spatial(x)).collect(),
            displacement: states.iter().map(|s| spatial(&s.displacement)).collect(),
            cells: self.cells.clone(),
            point_data: vec![("stress".into(), 6, stress), ("von_mises".into(), 1, equivalent)],
            cell_data: Vec::new(),
        };
        if has_plastic_strain {
            out.point_data.push(("plastic_strain".into(), 1, states.iter().map(|s| s.plastic_strain).collect()));
        }
        out
    }
}

/// One cell while it is divided.
struct Division<'a, const D: usize> {
    body: &'a CellBody<D>,
    cell: usize,
    points: Vec<Point<D>>,
    cells: Vec<Vec<u32>>,
    /// Numbers of lattice points.
    lattice: BTreeMap<usize, u32>,
    /// Numbers of the points in which edges between lattice points leave the material.
    ends: BTreeMap<(usize, usize), u32>,
    /// Boxes along each side.
    boxes: usize,
}

impl<'a, const D: usize> Division<'a, D> {
    fn new(body: &'a CellBody<D>, cell: usize) -> Self {
        Division {
            body,
            cell,
            points: Vec::new(),
            cells: Vec::new(),
            lattice: BTreeMap::new(),
            ends: BTreeMap::new(),
            boxes: body.degree(),
        }
    }

    fn lattice_point(&self, number: usize) -> Point<D> {
        let n = self.boxes + 1;
        let at = |k: usize| (number / n.pow(k as u32) % n) as f64 / self.boxes as f64;
        self.body.bounds_of(self.cell).at(&Point::from_fn(|k, _| at(k)))
    }

    fn is_in(&self, x: &Point<D>) -> bool {
        self.body.region.contains(x) && self.body.is_of_cell(x, self.cell)
    }

    fn divide(&mut self) {
        let n = self.boxes;
        let is_full = self.body.cells()[self.cell].rule.filling == Filling::Full;
        let inside: Vec<bool> =
            (0..(n + 1).pow(D as u32)).map(|i| is_full || self.is_in(&self.lattice_point(i))).collect();
        for i in 0..n.pow(D as u32) {
            let corner = |c: usize| -> usize {
                (0..D).map(|k| (i / n.pow(k as u32) % n + (c >> k & 1)) * (n + 1).pow(k as u32)).sum()
            };
            let corners: Vec<usize> = (0..1 << D).map(corner).collect();
            if corners.iter().all(|c| inside[*c]) {
                // Around each side.
                let order: &[usize] = if D == 2 { &[0, 1, 3, 2] } else { &[0, 1, 3, 2, 4, 5, 7, 6] };
                let cell = order.iter().map(|c| self.at_lattice(corners[*c])).collect();
                self.cells.push(cell);
            } else if corners.iter().any(|c| inside[*c]) {
                for path in paths::<D>() {
                    let simplex: Vec<usize> = path.iter().map(|c| corners[*c]).collect();
                    self.clip(&simplex, &inside);
                }
            }
        }
    }

    fn at_lattice(&mut self, number: usize) -> u32 {
        if let Some(known) = self.lattice.get(&number) {
            return *known;
        }
        self.points.push(self.lattice_point(number));
        let new = (self.points.len() - 1) as u32;
        self.lattice.insert(number, new);
        new
    }

    /// Where the edge from a point inside to one outside leaves the material.
    fn end(&mut self, from: usize, to: usize) -> u32 {
        if let Some(known) = self.ends.get(&(from, to)) {
            return *known;
        }
        let (mut low, mut high) = (self.lattice_point(from), self.lattice_point(to));
        for _ in 0..HALVINGS {
            let middle = (low + high) * 0.5;
            if self.is_in(&middle) { low = middle } else { high = middle }
        }
        self.points.push(low);
        let new = (self.points.len() - 1) as u32;
        self.ends.insert((from, to), new);
        new
    }

    /// The part of a simplex in the material.
    fn clip(&mut self, simplex: &[usize], inside: &[bool]) {
        let (kept, left): (Vec<usize>, Vec<usize>) = simplex.iter().partition(|c| inside[**c]);
        let own: Vec<u32> = kept.iter().map(|c| self.at_lattice(*c)).collect();
        let mut end = |a: usize, b: usize| self.end(kept[a], left[b]);
        let corners = match (D, kept.len()) {
            (_, 0) => return,
            (2, 1) => vec![own[0], end(0, 0), end(0, 1)],
            (2, 2) => vec![own[0], own[1], end(1, 0), end(0, 0)],
            (2, _) | (3, 4) => own,
            (_, 1) => vec![own[0], end(0, 0), end(0, 1), end(0, 2)],
            (_, 2) => vec![own[0], end(0, 0), end(0, 1), own[1], end(1, 0), end(1, 1)],
            _ => vec![own[0], own[1], own[2], end(0, 0), end(1, 0), end(2, 0)],
        };
        self.cells.push(self.oriented(corners));
    }

    /// A polygon counter-clockwise; a tetrahedron or a wedge as a hexahedron, the first face turned towards the rest.
    fn oriented(&self, mut corners: Vec<u32>) -> Vec<u32> {
        let x: Vec<_> = corners.iter().map(|k| spatial(&self.points[*k as usize])).collect();
        let across = (x[1] - x[0]).cross(&(x[2] - x[0]));
        if D == 2 {
            if across[2] < 0.0 {
                corners.reverse();
            }
            return corners;
        }
        let rest: signorini_geometry::Vector<3> = x[3..].iter().map(|y| y - x[0]).sum();
        if across.dot(&rest) < 0.0 {
            corners.swap(0, 1);
            if corners.len() == 6 {
                corners.swap(3, 4);
            }
        }
        match corners[..] {
            [a, b, c, d] => vec![a, b, c, c, d, d, d, d],
            [a, b, c, d, e, f] => vec![a, b, c, c, d, e, f, f],
            _ => corners,
        }
    }
}

/// The simplices of a box by its corners: from the first to the last, one direction after the other in every order.
fn paths<const D: usize>() -> Vec<Vec<usize>> {
    let orders: &[&[usize]] = match D {
        2 => &[&[0, 1], &[1, 0]],
        _ => &[&[0, 1, 2], &[1, 2, 0], &[2, 0, 1], &[0, 2, 1], &[2, 1, 0], &[1, 0, 2]],
    };
    let path = |order: &&[usize]| {
        let mut corner = 0;
        let mut out = vec![0];
        for k in *order {
            corner |= 1 << k;
            out.push(corner);
        }
        out
    };
    orders.iter().map(path).collect()
}
