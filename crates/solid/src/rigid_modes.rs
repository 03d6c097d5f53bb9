//! Motions that nothing resists: the rigid modes of every connected part that the supports leave free.

use crate::body::Bodies;
use crate::material::Space;
use crate::supports::{Reduction, Support, SupportKind};
use nalgebra::{DMatrix, DVector};
use signorini_geometry::Point;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

/// A free rigid motion of a part of a body.
#[derive(Clone, Debug)]
pub struct FreeMode {
    pub body: String,
    /// The piece of its mesh, as [`signorini_fem::Mesh::pieces`] numbers them.
    pub piece: u32,
    /// In words, such as "to translate along x".
    pub motion: String,
    /// The unknown of the bodies that moves most, and does in no mode listed before.
    pub unknown: usize,
    /// The displacement of the vertices of the part, by unknowns of the bodies, the largest 1. On cells with curved
    /// edges, where other functions turn along, rotations have none.
    pub field: Option<Vec<(u32, f64)>>,
}

/// The free rigid modes of all bodies. Elastic beds hold as supports do.
pub fn free_modes<const D: usize>(bodies: &Bodies<D>, supports: &[Support], reduction: &Reduction<D>) -> Vec<FreeMode> {
    let mut out = Vec::new();
    // Directions in which beds hold, by the unknowns of the vertices on them.
    let mut on_beds: HashSet<usize> = HashSet::new();
    for (support, vertices) in supports.iter().zip(&reduction.reactions) {
        if let SupportKind::Spring(stiffness) = &support.kind {
            for i in (0..D).filter(|&i| stiffness[i] > 0.0) {
                on_beds.extend(vertices.iter().map(|f| *f as usize * D + i));
            }
        }
    }
    for body in &bodies.list {
        let curved = (0..body.mesh.cell_count()).any(|c| body.mesh.map(c).order() > 1);
        for (piece, part) in parts(body).into_iter().enumerate() {
            let functions: Vec<(u32, Point<D>)> = part
                .iter()
                .filter_map(|&node| Some((body.dofs.vertex(node)?, body.mesh.nodes()[node as usize])))
                .collect();
            let centre = functions.iter().map(|f| f.1).sum::<Point<D>>() / functions.len().max(1) as f64;
            let size = functions.iter().map(|f| (f.1 - centre).norm()).fold(f64::MIN_POSITIVE, f64::max);
            let modes = modes::<D>(bodies.space);
            let n = functions.len() * D;
            // Displacements of all modes, and their parts along what is held.
            let mut motion = DMatrix::<f64>::zeros(n, modes.len());
            for (row, (_, x)) in functions.iter().enumerate() {
                for (m, mode) in modes.iter().enumerate() {
                    let u = mode.at(&((x - centre) / size));
                    for i in 0..D {
                        motion[(row * D + i, m)] = u[i];
                    }
                }
            }
            // Held directions, and differences to the common displacement where points are tied.
            let mut held = DMatrix::<f64>::zeros(modes.len(), modes.len());
            let mut ties: HashMap<u32, Vec<f64>> = HashMap::new();
            for (row, (f, _)) in functions.iter().enumerate() {
                let unknown = |i: usize| body.first + *f as usize * D + i;
                let rows: Vec<&[(u32, f64)]> = (0..D).map(|i| reduction.row(unknown(i))).collect();
                // The projection of a motion on what the row space of T allows.
                let columns: BTreeSet<u32> = rows.iter().flat_map(|r| r.iter().map(|e| e.0)).collect();
                let values: Vec<Point<D>> =
                    (0..modes.len()).map(|m| Point::<D>::from_fn(|i, _| motion[(row * D + i, m)])).collect();
                let mut rest = values.clone();
                for column in columns {
                    let t = Point::<D>::from_fn(|i, _| rows[i].iter().find(|e| e.0 == column).map_or(0.0, |e| e.1));
                    for (r, v) in rest.iter_mut().zip(&values) {
                        *r -= t * (t.dot(v) / t.norm_squared());
                    }
                    if column < reduction.tied() {
                        let along: Vec<f64> = values.iter().map(|v| t.dot(v) / t.norm()).collect();
                        match ties.get(&column) {
                            None => {
                                ties.insert(column, along);
                            }
                            Some(first) => {
                                let difference: Vec<f64> = first.iter().zip(&along).map(|(a, b)| a - b).collect();
                                for a in 0..modes.len() {
                                    for b in 0..modes.len() {
                                        held[(a, b)] += difference[a] * difference[b];
                                    }
                                }
                            }
                        }
                    }
                }
                for a in 0..modes.len() {
                    for b in 0..modes.len() {
                        held[(a, b)] += rest[a].dot(&rest[b]);
                        for i in (0..D).filter(|&i| on_beds.contains(&unknown(i))) {
                            held[(a, b)] += values[a][i] * values[b][i];
                        }
                    }
                }
            }
            let eigen = held.symmetric_eigen();
            let limit = 1e-12 * functions.len() as f64;
            let mut used: Vec<(DMatrix<f64>, DVector<f64>)> = Vec::new();
            for k in 0..modes.len() {
                if eigen.eigenvalues[k] > limit {
                    continue;
                }
                let mut combination = eigen.eigenvectors.column(k).into_owned();
                let name = modes[combination.iamax()].name::<D>();
                let mut field = DMatrix::from_column_slice(n, 1, (&motion * &combination).as_slice());
                for (other, its) in &used {
                    // Modes before this one are held where they move most.
                    let at = other.iamax_full().0;
                    let factor = field[(at, 0)] / other[(at, 0)];
                    field -= other * factor;
                    combination -= its * factor;
                }
                let at = field.iamax_full().0;
                let turned = modes.iter().zip(&combination).any(|(m, c)| m.is_rotation() && c.abs() > 1e-12);
                let number = |row: usize| (body.first + functions[row / D].0 as usize * D + row % D) as u32;
                let values = || field.iter().enumerate().map(|(row, u)| (number(row), u / field[(at, 0)].abs()));
                out.push(FreeMode {
                    body: body.name.clone(),
                    piece: piece as u32,
                    motion: name,
                    unknown: number(at) as usize,
                    field: (!(turned && curved)).then(|| values().filter(|(_, u)| *u != 0.0).collect()),
                });
                used.push((field, combination));
            }
        }
    }
    out
}

enum Mode {
    Translation(usize),
    /// In the plane of two axes.
    Rotation(usize, usize),
}

impl Mode {
    fn is_rotation(&self) -> bool {
        matches!(self, Mode::Rotation(..))
    }

    fn at<const D: usize>(&self, x: &Point<D>) -> Point<D> {
        let mut u = Point::<D>::zeros();
        match *self {
            Mode::Translation(i) => u[i] = 1.0,
            Mode::Rotation(i, j) => (u[i], u[j]) = (-x[j], x[i]),
        }
        u
    }

    fn name<const D: usize>(&self) -> String {
        let axis = ["x", "y", "z"];
        match *self {
            Mode::Translation(i) => format!("to translate along {}", axis[i]),
            Mode::Rotation(..) if D == 2 => "to rotate".into(),
            Mode::Rotation(i, j) => format!("to rotate about {}", axis[3 - i - j]),
        }
    }
}

fn modes<const D: usize>(space: Space) -> Vec<Mode> {
    match (space, D) {
        (Space::Axisymmetric, _) => vec![Mode::Translation(1)],
        (_, 2) => vec![Mode::Translation(0), Mode::Translation(1), Mode::Rotation(0, 1)],
        _ => vec![
            Mode::Translation(0),
            Mode::Translation(1),
            Mode::Translation(2),
            Mode::Rotation(1, 2),
            Mode::Rotation(2, 0),
            Mode::Rotation(0, 1),
        ],
    }
}

/// Vertices of every piece of a body.
fn parts<const D: usize>(body: &crate::body::Body<D>) -> Vec<Vec<u32>> {
    let mut lists: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
    for (cell, piece) in body.mesh.pieces().into_iter().enumerate() {
        lists.entry(piece).or_default().extend(body.mesh.vertices(cell));
    }
    lists.into_values().map(|list| list.into_iter().collect()).collect()
}
