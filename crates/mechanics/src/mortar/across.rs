//! Points of a slave face that see faces of another surface: what moves them, and what they add to residual and tangent.
//!
//! The measures are those of [`cut`](crate::pair), of all points of a slave face at once, in few variables: the displacements
//! of its functions and of those of the master faces across from it, and the averaged normals at its vertices.
//!
//! | symbol | meaning |
//! |---|---|
//! | `ν = Σ φ_c ν_c`, `n = -ν/|ν|` | averaged normal of the slave, and direction of the gap |
//! | `D = x_s - x_m = g n` | of a function: `∂D = d e_i`, and `∂D_,α = d_α e_i` on the master |
//! | `P = (1 - n⊗n)/|ν|` | `δn = -P δν` |
//! | `m, m^α` | dual basis of `n, ρ_1, ρ_2`: `g' = m·(δD - g δn)`, `η'^α = m^α·(δD - g δn)` |
//! | `F = T - p n` | forces `F·δD + g (P T)·δν` |
//!
//! Only the sums are then written in the unknowns that move the normals at the vertices.

use super::cover::{CoveredPoint, Seen};
use super::face_terms::{FaceTerms, Line, Traction, Wanted};
use super::measured::{Apart, Matched};
use super::terms::NodeTractions;
use crate::pair::axis;
use crate::points::Direction;
use crate::surface::{Local, Surface};
use signorini_contact::compress;
use signorini_geometry::{Matrix, Vector};
use std::collections::BTreeMap;

/// Two surfaces, and their first unknowns.
#[derive(Clone, Copy)]
pub(super) struct Surfaces<'a> {
    pub slave: &'a dyn Surface,
    pub master: &'a dyn Surface,
    pub first: [u32; 2],
}

/// What moves the points of a slave face and what they see.
struct Variables<'a> {
    face: usize,
    dimension: usize,
    /// The first unknown of every function, of the slave face and of each master face met.
    functions: Vec<u32>,
    /// Where the functions of each master face begin.
    masters: Vec<(usize, usize)>,
    corners: &'a [Direction],
    first: u32,
}

/// A function at a point: its place, how much it moves `D`, and `D_,α`.
type Mover = (usize, f64, [f64; 2]);

/// A point of the slave face, and what it sees.
struct FacePoint {
    /// `D`, its part along the normal, and that.
    apart: Vector<3>,
    gap: f64,
    normal: Vector<3>,
    /// `|ν|` and `P`.
    length: f64,
    turns: Matrix<3>,
    /// `m`, `m^1`, `m^2`.
    dual: [Vector<3>; 3],
    movers: Vec<Mover>,
    /// `φ_c`.
    corners: Vec<f64>,
}

/// A value for each variable: of functions, then of corners.
type Row = Vec<Vector<3>>;

impl<'a> Variables<'a> {
    fn new(sides: &Surfaces<'a>, face: usize) -> Self {
        let corners = sides.slave.corners(face);
        let dimension = sides.slave.dimension();
        Variables { face, dimension, functions: Vec::new(), masters: Vec::new(), corners, first: sides.first[0] }
    }

    fn len(&self) -> usize {
        self.functions.len() + self.corners.len()
    }

    /// What is seen at a point of the face; none where it looks along the master.
    fn sight(&mut self, sides: &Surfaces<'_>, (s, seen): (&Local, &Seen)) -> Option<FacePoint> {
        let face = self.face;
        let corners = sides.slave.vertex_functions(face, s);
        let averaged: Vector<3> = self.corners.iter().zip(&corners).map(|(c, share)| c.vector * *share).sum();
        let length = averaged.norm();
        let normal = -averaged / length;
        let own = sides.slave.point(face, s);
        let other = sides.master.point(seen.face, &seen.s);
        if self.functions.is_empty() {
            self.functions.extend(own.functions.iter().map(|f| sides.first[0] + f.unknown));
        }
        let known = self.masters.iter().find(|m| m.0 == seen.face);
        let start = known.map_or(self.functions.len(), |m| m.1);
        if known.is_none() {
            self.masters.push((seen.face, start));
            self.functions.extend(other.functions.iter().map(|f| sides.first[1] + f.unknown));
        }
        let basis = Matrix::<3>::from_columns(&[normal, other.tangents[0], other.tangents[1]]);
        let dual = basis.try_inverse()?;
        let moves = own.functions.iter().enumerate().map(|(k, f)| (k, f.value, [0.0; 2]));
        let opposite = other.functions.iter().zip(start..).map(|(f, k)| (k, -f.value, f.slopes.map(|v| -v)));
        Some(FacePoint {
            apart: own.x - other.x,
            gap: normal.dot(&(own.x - other.x)),
            normal,
            length,
            turns: (Matrix::<3>::identity() - normal * normal.transpose()) / length,
            dual: std::array::from_fn(|i| dual.row(i).transpose()),
            movers: moves.chain(opposite).collect(),
            corners,
        })
    }

    /// The unknowns that move each variable, by where they stand, and how.
    fn moves(&self, place: &dyn Fn(u32) -> usize) -> Vec<Vec<(usize, Vector<3>)>> {
        let of_function = |first: &u32| (0..self.dimension).map(|i| (place(first + i as u32), axis(i))).collect();
        let of_corner =
            |c: &Direction| c.functions.iter().map(|f| (place(self.first + f.unknown), f.value)).collect::<Vec<_>>();
        self.functions.iter().map(of_function).chain(self.corners.iter().map(of_corner)).collect()
    }

    /// All unknowns, in ascending order.
    fn unknowns(&self) -> Vec<u32> {
        let of_functions = self.functions.iter().flat_map(|f| (0..self.dimension as u32).map(move |i| f + i));
        let of_corners = self.corners.iter().flat_map(|c| c.functions.iter().map(|f| self.first + f.unknown));
        let mut out: Vec<u32> = of_functions.chain(of_corners).collect();
        out.sort_unstable();
        out.dedup();
        out
    }

    /// A row in the unknowns of both bodies, with `by` for what a value of a corner does to a function of it.
    fn written(&self, row: &[Vector<3>], by: impl Fn(&Vector<3>, &Vector<3>) -> f64) -> Vec<(u32, f64)> {
        let (of_functions, of_corners) = row.split_at(self.functions.len());
        let mut out = Vec::with_capacity(3 * row.len());
        for (unknown, v) in self.functions.iter().zip(of_functions) {
            out.extend((0..self.dimension).map(|i| (unknown + i as u32, v[i])));
        }
        for (corner, v) in self.corners.iter().zip(of_corners).filter(|(_, v)| **v != Vector::<3>::zeros()) {
            out.extend(corner.functions.iter().map(|f| (self.first + f.unknown, by(&f.value, v))));
        }
        compress(&mut out);
        out.retain(|e| e.1 != 0.0);
        out
    }

    fn entries(&self, row: &[Vector<3>]) -> Vec<(u32, f64)> {
        self.written(row, |f, v| f.dot(v))
    }

    /// The same of sizes.
    fn sizes(&self, row: &[Vector<3>]) -> Vec<(u32, f64)> {
        self.written(row, |f, v| f.abs().dot(v))
    }

    fn lines(&self, rows: Rows) -> Vec<Line> {
        let line = |((node, slot), row): ((u32, usize), Row)| Line { node, slot, entries: self.entries(&row) };
        rows.into_iter().map(line).collect()
    }
}

impl FacePoint {
    fn add_to_corners(&self, value: &Vector<3>, row: &mut Row, variables: &Variables<'_>) {
        self.corners.iter().zip(variables.functions.len()..).for_each(|(share, k)| row[k] += value * *share);
    }

    /// Adds a share of how the gap changes to a row.
    fn add_gap(&self, share: f64, row: &mut Row, variables: &Variables<'_>) {
        let [m, ..] = self.dual;
        self.movers.iter().for_each(|(k, d, _)| row[*k] += m * (share * d));
        self.add_to_corners(&(self.turns * m * (share * self.gap)), row, variables);
    }

    /// Adds the forces of friction to a row.
    fn add_force(&self, friction: &Vector<3>, row: &mut Row, variables: &Variables<'_>) {
        self.movers.iter().for_each(|(k, d, _)| row[*k] += friction * *d);
        self.add_to_corners(&(self.turns * friction * self.gap), row, variables);
    }
}

/// Rows of nodes, by component of the traction.
type Rows = BTreeMap<(u32, usize), Row>;

fn row_of<'a>(rows: &'a mut Rows, key: (u32, usize), variables: &Variables<'_>) -> &'a mut Row {
    rows.entry(key).or_insert_with(|| vec![Vector::<3>::zeros(); variables.len()])
}

impl Surfaces<'_> {
    /// What the points of a face add.
    pub fn terms(&self, carried: &NodeTractions<'_>, points: &[CoveredPoint], wanted: Wanted) -> FaceTerms {
        let contact = carried.contact;
        let Some(first) = points.first() else { return FaceTerms::default() };
        let mut variables = Variables::new(self, first.face);
        let mut sights = Vec::new();
        for point in points.iter().filter(|p| carried.has_part_in(&p.shares)) {
            let Some(seen) = &point.master else { continue };
            sights.extend(variables.sight(self, (&point.s, seen)).map(|sight| (point, sight)));
        }
        let mut sums = Sums::new(&variables, contact.law.is_tangential(), wanted == Wanted::Tangent);
        let (mut pushes, mut gaps) = (Rows::new(), Rows::new());
        for (point, sight) in &sights {
            sums.add(sight, &carried.traction_at(&point.shares, &sight.normal));
            if wanted == Wanted::Forces {
                continue;
            }
            for (node, share) in point.shares.iter().filter(|(node, _)| carried.acts[*node as usize]) {
                let pushed = row_of(&mut pushes, (*node, 0), &variables);
                sight.movers.iter().for_each(|(k, d, _)| pushed[*k] -= sight.normal * (share * d));
                sight.add_gap(*share, row_of(&mut gaps, (*node, 0), &variables), &variables);
                for (slot, e) in contact.axes_of(*node, &sight.normal) {
                    sight.add_force(&(e * *share), row_of(&mut pushes, (*node, slot), &variables), &variables);
                }
            }
        }
        FaceTerms {
            forces: variables.entries(&sums.forces),
            sizes: variables.sizes(&sums.sizes),
            stiffness: sums.stiffness(&variables),
            pushes: variables.lines(pushes),
            gaps: variables.lines(gaps),
            slips: Vec::new(),
        }
    }

    /// How far a matched point is apart now.
    pub fn apart(&self, matched: &Matched) -> Apart {
        let foot = self.master.point(matched.on.patch as usize, &matched.on.xi);
        Apart {
            normal: -self.slave.normal(matched.face, &matched.s).normalize(),
            vector: self.slave.point(matched.face, &matched.s).x - foot.x,
        }
    }

    /// How the points of a face that were matched at the last state change the slips of the nodes; with directions that stay
    /// where `is_linear`.
    pub fn slips(&self, carried: &NodeTractions<'_>, matched: &[Matched], is_linear: bool) -> FaceTerms {
        let Some(first) = matched.first() else { return FaceTerms::default() };
        let contact = carried.contact;
        let mut variables = Variables::new(self, first.face);
        let mut sights = Vec::new();
        for point in matched.iter().filter(|m| carried.has_part_in(&m.shares)) {
            let seen = Seen { face: point.on.patch as usize, s: point.on.xi, ..Seen::default() };
            sights.extend(variables.sight(self, (&point.s, &seen)).map(|sight| (point, sight)));
        }
        let mut rows = Rows::new();
        for (point, sight) in &sights {
            for (node, share) in point.shares.iter().filter(|(node, _)| carried.acts[*node as usize]) {
                let Some(axes) = contact.axes(*node, &sight.normal) else { continue };
                for &slot in &contact.law.slots()[1..] {
                    let row = row_of(&mut rows, (*node, slot), &variables);
                    let along = axes.e[slot - 1] * *share;
                    sight.movers.iter().for_each(|(k, d, _)| row[*k] += along * *d);
                    if !is_linear {
                        let by_normal = axes.by_normal[slot - 1].transpose() * sight.apart * *share;
                        sight.add_to_corners(&-(sight.turns * by_normal), row, &variables);
                    }
                }
            }
        }
        FaceTerms { slips: variables.lines(rows), ..FaceTerms::default() }
    }
}

/// Forces of the points of a face, and their derivatives block by block.
struct Sums {
    forces: Row,
    sizes: Row,
    /// Empty where no tangent is asked for.
    blocks: Vec<Matrix<3>>,
    /// The first corner, and the number of variables.
    corner: usize,
    n: usize,
    has_friction: bool,
}

impl Sums {
    fn new(variables: &Variables<'_>, has_friction: bool, wants_tangent: bool) -> Self {
        let n = variables.len();
        let zero = Vector::<3>::zeros();
        Sums {
            forces: vec![zero; n],
            sizes: vec![zero; n],
            blocks: vec![Matrix::<3>::zeros(); if wants_tangent { n * n } else { 0 }],
            corner: variables.functions.len(),
            n,
            has_friction,
        }
    }

    fn add(&mut self, sight: &FacePoint, traction: &Traction) {
        let Traction { pressure, friction, .. } = traction;
        let force = friction - sight.normal * *pressure;
        let size = friction.abs() + sight.normal.abs() * pressure.abs();
        let turned = sight.turns * friction * sight.gap;
        for (k, d, _) in &sight.movers {
            self.forces[*k] += force * *d;
            self.sizes[*k] += size * d.abs();
        }
        if self.has_friction {
            for (share, k) in sight.corners.iter().zip(self.corner..) {
                self.forces[k] += turned * *share;
                self.sizes[k] += turned.abs() * *share;
            }
        }
        if !self.blocks.is_empty() {
            self.add_to_functions(sight, traction, &force);
            if self.has_friction {
                self.add_to_corners(sight, traction);
            }
        }
    }

    /// How the forces on functions change: the point across moves along the master, and the normal turns.
    fn add_to_functions(
        &mut self,
        sight: &FacePoint,
        Traction { pressure, turning, .. }: &Traction,
        force: &Vector<3>,
    ) {
        let turns = &sight.turns;
        let by_normal = turns * *pressure - turning * turns;
        let moved = [force * sight.dual[1].transpose(), force * sight.dual[2].transpose()];
        let turned = moved.map(|m| m * turns * sight.gap);
        for (k, d, slopes) in &sight.movers {
            let own = &mut self.blocks[k * self.n..(k + 1) * self.n];
            if *slopes != [0.0; 2] {
                let moved = moved[0] * slopes[0] + moved[1] * slopes[1];
                sight.movers.iter().for_each(|(l, e, _)| own[*l] += moved * *e);
            }
            let by_corner = by_normal * *d + turned[0] * slopes[0] + turned[1] * slopes[1];
            sight.corners.iter().zip(self.corner..).for_each(|(share, l)| own[l] += by_corner * *share);
        }
    }

    /// How the forces on normals at vertices change: `g P T` varies with the gap, with `P`, and with the axes of friction.
    fn add_to_corners(&mut self, sight: &FacePoint, Traction { friction, turning, .. }: &Traction) {
        let (turns, n, gap) = (&sight.turns, &sight.normal, sight.gap);
        let along = turns * friction;
        let opens = along * sight.dual[0].transpose();
        let by_turn = (n * along.transpose() + along * n.transpose() + turns * friction.dot(n)) / sight.length;
        let by_corner = opens * turns * gap + by_turn * gap - turns * turning * turns * gap;
        for (share, k) in sight.corners.iter().zip(self.corner..) {
            let own = &mut self.blocks[k * self.n..(k + 1) * self.n];
            sight.movers.iter().for_each(|(l, d, _)| own[*l] += opens * (share * d));
            sight.corners.iter().zip(self.corner..).for_each(|(other, l)| own[l] += by_corner * (share * other));
        }
    }

    /// The derivatives in the unknowns of both bodies; those have second derivatives of the normals too.
    fn stiffness(&self, variables: &Variables<'_>) -> (Vec<u32>, Vec<f64>) {
        if self.blocks.is_empty() {
            return Default::default();
        }
        let unknowns = variables.unknowns();
        let size = unknowns.len();
        let place = |u: u32| unknowns.partition_point(|k| *k < u);
        // Of each variable, by component, the unknowns that move it.
        let moves: Vec<Vec<(usize, Vector<3>)>> = variables.moves(&place);
        let mut half = vec![Vector::<3>::zeros(); self.n * size];
        for (blocks, row) in self.blocks.chunks(self.n).zip(half.chunks_mut(size)) {
            for (block, list) in blocks.iter().zip(&moves).filter(|(block, _)| **block != Matrix::<3>::zeros()) {
                list.iter().for_each(|(at, v)| row[*at] += block * v);
            }
        }
        let mut out = vec![0.0; size * size];
        let of_corner = |k: usize| self.has_friction || k < self.corner;
        for (k, (list, row)) in moves.iter().zip(half.chunks(size)).enumerate().filter(|(k, _)| of_corner(*k)) {
            for (at, v) in list {
                out[at * size..(at + 1) * size].iter_mut().zip(row).for_each(|(o, h)| *o += v.dot(h));
            }
            let bends = if k < self.corner { &[][..] } else { &variables.corners[k - self.corner].bends[..] };
            for bend in bends.iter().filter(|_| self.has_friction) {
                let [i, j] = bend.unknowns.map(|u| place(variables.first + u));
                let value = bend.value.dot(&self.forces[k]);
                out[i * size + j] += value;
                if i != j {
                    out[j * size + i] += value;
                }
            }
        }
        (unknowns, out)
    }
}
