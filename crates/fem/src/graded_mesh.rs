//! Meshes of the plane with cells divided where it matters, into four and again into four, and beside these into triangles
//! that lead over to larger cells.
//!
//! (Bank, Sherman & Weiser, *Refinement algorithms and data structures for regular local mesh refinement*, 1983.)

use crate::cell_map::CellMap;
use crate::hierarchic::Values;
use crate::mesh::{Mesh, Side};
use crate::mesh_refinement::{NONE_CURVED, on_side, place, vertices_of_parts};
use crate::reference::{CellShape, Local};
use std::collections::HashMap;

/// A side that does not lie on one of the undivided mesh.
const INNER: u8 = u8::MAX;

/// Where a cell comes from.
#[derive(Clone, Copy)]
struct Origin {
    /// The cell of the undivided mesh, and how often it was divided.
    cell: u32,
    level: u8,
    /// Which of its sides each side lies on.
    sides: [u8; 4],
    divided: bool,
}

/// All cells that divisions have led to, from those of the undivided mesh to the smallest.
struct Forest {
    mesh: Mesh<2>,
    origins: Vec<Origin>,
    /// The nodes in the middles of sides, by those at their ends.
    middles: HashMap<[u32; 2], u32>,
    at: Values,
}

impl Forest {
    fn middle(&self, a: u32, b: u32) -> Option<u32> {
        self.middles.get(&[a.min(b), a.max(b)]).copied()
    }

    /// The nodes in the middles of those sides of a cell beyond which cells were divided, and whether one of these was divided
    /// once more.
    fn hanging(&self, cell: usize) -> ([Option<u32>; 4], bool) {
        let vertices: Vec<u32> = self.mesh.vertices(cell).collect();
        let (mut found, mut uneven) = ([None; 4], false);
        for (side, out) in found.iter_mut().enumerate().take(vertices.len()) {
            let (a, b) = (vertices[side], vertices[(side + 1) % vertices.len()]);
            *out = self.middle(a, b);
            uneven |= out.is_some_and(|m| self.middle(a, m).is_some() || self.middle(m, b).is_some());
        }
        (found, uneven)
    }

    /// Divides a cell into four.
    fn divide(&mut self, cell: usize) {
        let shape = self.mesh.shape(cell);
        let bent = self.mesh.is_bent(cell);
        let corners: Vec<u32> = self.mesh.vertices(cell).collect();
        let sides = corners.len();
        let mut middles = [u32::MAX; 4];
        for (side, middle) in middles.iter_mut().enumerate().take(sides) {
            let (a, b) = (corners[side], corners[(side + 1) % sides]);
            *middle = self.middle(a, b).unwrap_or_else(|| {
                let (v, w) = (side as u8, ((side + 1) % sides) as u8);
                let x = self.mesh.corner(cell, bent, &[v, v, w, w], &mut self.at);
                let node = self.mesh.add_node(x);
                self.middles.insert([a.min(b), a.max(b)], node);
                node
            });
        }
        let mut centre = u32::MAX;
        if sides == 4 {
            let x = self.mesh.corner(cell, bent, &[0, 1, 2, 3], &mut self.at);
            centre = self.mesh.add_node(x);
        }
        let whole = vertices_of_parts(shape, &corners, &|side| middles[usize::from(side)], centre);
        let mesh = &self.mesh;
        let curved = if bent { mesh.curved_parts(cell, &whole, mesh.nodes(), &mut self.at) } else { NONE_CURVED };
        let map = self.mesh.map(cell).clone();
        let of = self.origins[cell];
        self.origins[cell].divided = true;
        let mut origins = [Origin { level: of.level + 1, sides: [INNER; 4], ..of }; 4];
        for side in 0..sides {
            on_side(shape, side).for_each(|(part, s)| origins[part].sides[s] = of.sides[side]);
        }
        for ((nodes, curved), origin) in whole.into_iter().zip(curved).zip(origins) {
            self.mesh.add_part(&map, &nodes[..sides], curved);
            self.origins.push(origin);
        }
    }

    /// Divides cells until neighbours differ by at most one division, and no triangle has two sides with hanging nodes.
    fn balance(&mut self) {
        loop {
            let too_large: Vec<usize> = self.leaves().filter(|&cell| self.is_too_large(cell)).collect();
            if too_large.is_empty() {
                return;
            }
            too_large.into_iter().for_each(|cell| self.divide(cell));
        }
    }

    fn is_too_large(&self, cell: usize) -> bool {
        let (hanging, uneven) = self.hanging(cell);
        let most = if self.mesh.shape(cell) == CellShape::Triangle { 1 } else { 3 };
        uneven || hanging.iter().flatten().count() > most
    }

    fn leaves(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.origins.len()).filter(|cell| !self.origins[*cell].divided)
    }

    /// Adds the triangles of a cell with hanging nodes to a mesh, each with the origin of its sides.
    fn add_triangles(&mut self, cell: usize, hanging: [Option<u32>; 4], out: &mut Mesh<2>, origins: &mut Vec<Origin>) {
        let of = self.origins[cell];
        let shape = self.mesh.shape(cell);
        let vertices: Vec<u32> = self.mesh.vertices(cell).collect();
        let n = vertices.len();
        let corner = |v: usize| (vertices[v % n], shape.vertices()[v % n]);
        let middle = |side: usize| {
            let (v, w) = (side as u8, ((side + 1) % n) as u8);
            hanging[side].map(|node| (node, place(shape, &[v, v, w, w])))
        };
        let on = |side: usize| of.sides[side % n];
        let bent = self.mesh.is_bent(cell);
        let mut triangles: Vec<([(u32, Local); 3], [u8; 4])> = Vec::new();
        if n == 3 {
            for (side, middle) in (0..3).filter_map(|side| Some((side, middle(side)?))) {
                let [a, b, c] = [0, 1, 2].map(|k| corner(side + k));
                triangles.push(([a, middle, c], [on(side), INNER, on(side + 2), INNER]));
                triangles.push(([middle, b, c], [on(side), on(side + 1), INNER, INNER]));
            }
        } else {
            let centre = (out.add_node(self.mesh.corner(cell, bent, &[0, 1, 2, 3], &mut self.at)), shape.centre());
            for side in 0..n {
                let along: Vec<_> =
                    [Some(corner(side)), middle(side), Some(corner(side + 1))].into_iter().flatten().collect();
                let fan = along.windows(2).map(|ends| [ends[0], ends[1], centre]);
                triangles.extend(fan.map(|corners| (corners, [on(side), INNER, INNER, INNER])));
            }
        }
        let map = CellMap::new(CellShape::Triangle, self.mesh.map(cell).order());
        for (corners, sides) in triangles {
            let places = corners.map(|(_, place)| place);
            let curved = bent.then(|| self.mesh.nodes_of_part(cell, &map, &places, &mut self.at));
            out.add_part(&map, &corners.map(|(node, _)| node), curved);
            origins.push(Origin { sides, ..of });
        }
    }
}

impl Mesh<2> {
    /// The mesh with cells divided as long as `wanted` says so of a cell, called with a mesh, its number there, the cell of
    /// this mesh that it is a part of, and how often that was divided; and how often each cell of the new mesh was divided.
    /// Groups go over to the parts.
    pub fn graded(&self, wanted: &mut dyn FnMut(&Mesh<2>, usize, usize, usize) -> bool) -> (Self, Vec<u8>) {
        let origin = |cell: usize| Origin { cell: cell as u32, level: 0, sides: [0, 1, 2, 3], divided: false };
        let mut forest = Forest {
            mesh: self.clone(),
            origins: (0..self.cell_count()).map(origin).collect(),
            middles: HashMap::new(),
            at: Values::default(),
        };
        let mut cell = 0;
        while cell < forest.origins.len() {
            let Origin { cell: of, level, .. } = forest.origins[cell];
            if wanted(&forest.mesh, cell, of as usize, level.into()) {
                forest.divide(cell);
            }
            cell += 1;
        }
        forest.balance();
        let mut mesh = Mesh::new(forest.mesh.nodes().to_vec());
        let mut origins: Vec<Origin> = Vec::new();
        let leaves: Vec<usize> = forest.leaves().collect();
        for cell in leaves {
            let (hanging, _) = forest.hanging(cell);
            if hanging.iter().any(Option::is_some) {
                forest.add_triangles(cell, hanging, &mut mesh, &mut origins);
            } else {
                let map = forest.mesh.map(cell);
                mesh.add_cell(map.shape(), map.order(), forest.mesh.cell_nodes(cell));
                origins.push(forest.origins[cell]);
            }
        }
        let mut parts: Vec<Vec<u32>> = vec![Vec::new(); self.cell_count()];
        origins.iter().zip(0..).for_each(|(origin, part)| parts[origin.cell as usize].push(part));
        let sides_of = |cell: u32| &origins[cell as usize].sides;
        let on = |Side { cell, side }: Side| {
            let of_cell = parts[cell as usize].iter().flat_map(|&cell| (0..4).map(move |side| Side { cell, side }));
            of_cell.filter(move |s| sides_of(s.cell)[usize::from(s.side)] == side)
        };
        self.hand_groups_to(&mut mesh, |cell| parts[cell as usize].iter().copied(), on);
        (mesh, origins.iter().map(|origin| origin.level).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Group;
    use crate::rules::rule;
    use crate::small;
    use signorini_geometry::Point;

    fn area(mesh: &Mesh<2>) -> f64 {
        let mut at = Values::default();
        let mut sum = 0.0;
        for cell in 0..mesh.cell_count() {
            for (x, w) in rule(mesh.shape(cell), 9) {
                mesh.map(cell).tabulate(&x, &mut at);
                sum += w * small::determinant(&mesh.jacobian(cell, &at).1);
            }
        }
        sum
    }

    /// Length of the sides of a list.
    fn length(mesh: &Mesh<2>, sides: &[Side]) -> f64 {
        let part = |side: &Side| {
            let points = signorini_geometry::rule::gauss_legendre(16).into_iter();
            points.map(|(t, w)| 2.0 * w * mesh.on_side(*side, &[2.0 * t - 1.0, 0.0, 0.0]).1[0].norm()).sum::<f64>()
        };
        sides.iter().map(part).sum()
    }

    /// Two by two squares of side 1, halves of some of which are triangles, with the upper side of all bulging if they are of
    /// order 2.
    fn patch(triangles: [bool; 4], order: usize) -> Mesh<2> {
        let n = 2 * order + 1;
        let position = |i: usize, j: usize| {
            let [x, y] = [i, j].map(|k| k as f64 / order as f64);
            Point::<2>::new(x, y + if order == 2 { 0.05 * y * x * (2.0 - x) } else { 0.1 * x * y })
        };
        let mut mesh = Mesh::new((0..n * n).map(|k| position(k % n, k / n)).collect());
        for (square, halved) in triangles.into_iter().enumerate() {
            let at = |i: usize, j: usize| ((order * (square / 2) + j) * n + order * (square % 2) + i) as u32;
            let o = order;
            match (halved, order) {
                (false, 1) => mesh.add_cell(CellShape::Quadrilateral, 1, &[at(0, 0), at(1, 0), at(0, 1), at(1, 1)]),
                (false, _) => {
                    let nodes: Vec<u32> = (0..9).map(|k| at(k % 3, k / 3)).collect();
                    mesh.add_cell(CellShape::Quadrilateral, 2, &nodes)
                }
                (true, 1) => {
                    mesh.add_cell(CellShape::Triangle, 1, &[at(0, 0), at(o, 0), at(o, o)]);
                    mesh.add_cell(CellShape::Triangle, 1, &[at(0, 0), at(o, o), at(0, o)])
                }
                (true, _) => {
                    // Vertices, then the middles of the edges between the first two, the last two, the first and the last.
                    mesh.add_cell(
                        CellShape::Triangle,
                        2,
                        &[at(0, 0), at(2, 0), at(2, 2), at(1, 0), at(2, 1), at(1, 1)],
                    );
                    mesh.add_cell(CellShape::Triangle, 2, &[at(0, 0), at(2, 2), at(0, 2), at(1, 1), at(1, 2), at(0, 1)])
                }
            };
        }
        mesh.check().expect("a mesh");
        let upper = |side: &Side| (0..2).all(|k| mesh.on_side(*side, &[2.0 * k as f64 - 1.0, 0.0, 0.0]).0[1] > 1.99);
        let sides = mesh.boundary().into_iter().filter(upper).collect();
        let cells = (0..mesh.cell_count() as u32).collect();
        let film = Group { cells, sides, ..Group::default() };
        *mesh.group_mut("film") = film;
        mesh
    }

    #[test]
    fn graded_meshes_have_no_gaps() {
        let all = |halved: bool| [halved; 4];
        for triangles in [all(true), all(false), [true, false, false, true], [false, true, true, true]] {
            for order in [1, 2] {
                let mesh = patch(triangles, order);
                // At a corner, within, and on the curved side.
                for place in [[0.05, 0.07], [0.93, 1.1], [1.3, 2.0]] {
                    let place = Point::<2>::from(place);
                    let mut wanted = |mesh: &Mesh<2>, cell: usize, _: usize, level: usize| {
                        let corners: Vec<Point<2>> = mesh.vertices(cell).map(|n| mesh.nodes()[n as usize]).collect();
                        let centre = corners.iter().sum::<Point<2>>() / corners.len() as f64;
                        level < 5 && (centre - place).norm() < 1.2 / f64::from(1u32 << level)
                    };
                    let (graded, levels) = mesh.graded(&mut wanted);
                    let what = format!("{triangles:?}, order {order}, {place:?}");
                    graded.check().unwrap_or_else(|e| panic!("{what}: {e}"));
                    assert_eq!(levels.len(), graded.cell_count());
                    assert_eq!(levels.iter().max(), Some(&5), "{what}");
                    assert!(graded.cell_count() < 400, "{what}: {}", graded.cell_count());
                    let off = (area(&graded) - area(&mesh)).abs();
                    assert!(off < 1e-13, "{what}: area off by {off:e}");
                    // A node that hangs would leave sides of both cells without one across.
                    let (before, after) = (mesh.boundary(), graded.boundary());
                    assert!((length(&graded, &after) - length(&mesh, &before)).abs() < 1e-12, "{what}");
                    let (old, new) = (&mesh.groups()["film"], &graded.groups()["film"]);
                    assert!(new.sides.iter().all(|side| after.contains(side)));
                    assert!((length(&graded, &new.sides) - length(&mesh, &old.sides)).abs() < 1e-12, "{what}");
                    let mut cells = new.cells.clone();
                    cells.sort_unstable();
                    assert_eq!(cells, (0..graded.cell_count() as u32).collect::<Vec<u32>>());
                }
            }
        }
    }

    #[test]
    fn what_nobody_wants_divided_stays() {
        let mesh = patch([true, false, true, false], 2);
        let (same, levels) = mesh.graded(&mut |_, _, _, _| false);
        assert_eq!(same.cell_count(), mesh.cell_count());
        assert_eq!(levels, vec![0; mesh.cell_count()]);
        assert_eq!(same.groups(), mesh.groups());
    }
}
