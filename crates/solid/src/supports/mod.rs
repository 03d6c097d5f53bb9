//! Supports: what is prescribed, function by function, and the unknowns that remain.
//!
//! Every vector function of a supported group is constrained along one or more directions; the rest of its directions
//! stay free. `u = T y + c`, with `T` from the directions and `c` from the prescribed values, which may change with time
//! while `T` stays.

mod bed;
mod direction;
mod group;
mod prescribed;
mod statement;

pub(crate) use bed::beds;
pub(crate) use group::functions;
pub(crate) use prescribed::project;
pub use statement::{Displacement, Support, SupportError, SupportKind};

use crate::body::Bodies;
use direction::{Held, Source, axis, frame, list_rank};
use group::{common_normal, global, place, vertices};
use signorini_geometry::Point;
use std::collections::{BTreeMap, BTreeSet};

/// The unknowns that remain.
pub struct Reduction<const D: usize> {
    /// `T` in compressed rows.
    start: Vec<u32>,
    entries: Vec<(u32, f64)>,
    pub unknowns: usize,
    tied: u32,
    /// Constrained directions by function (first unknown / D).
    held: BTreeMap<u32, Vec<Held<D>>>,
    /// Vertices of every support with their function, for reactions.
    pub reactions: Vec<Vec<u32>>,
}

impl<const D: usize> Reduction<D> {
    pub fn new(bodies: &Bodies<D>, supports: &[Support]) -> Result<Self, SupportError> {
        let mut held: BTreeMap<u32, Vec<Held<D>>> = BTreeMap::new();
        let mut reactions = vec![Vec::new(); supports.len()];
        let mut tied = 0u32;
        for (number, support) in supports.iter().enumerate() {
            let body = &bodies.list[support.body];
            let all = functions(bodies, support);
            reactions[number] = vertices(bodies, support)
                .iter()
                .filter_map(|v| body.dofs.vertex(*v))
                .map(|f| global(bodies, support.body, f))
                .collect();
            let mut hold = |direction: Point<D>, source: &dyn Fn(u32) -> Source| {
                for &f in &all {
                    held.entry(f).or_default().push(Held { direction, source: source(f) });
                }
            };
            match &support.kind {
                SupportKind::Components(which) => {
                    for i in (0..D).filter(|&i| which[i]) {
                        hold(axis(i), &|_| Source::Prescribed { support: number });
                    }
                }
                SupportKind::Normal => {
                    let normal = common_normal(bodies, support)?;
                    hold(normal, &|_| Source::Prescribed { support: number });
                }
                SupportKind::Uniform(which) => {
                    let on_vertices: BTreeSet<u32> = reactions[number].iter().copied().collect();
                    for i in (0..D).filter(|&i| which[i]) {
                        let unknown = tied;
                        tied += 1;
                        hold(axis(i), &|f| Source::Tied { support: number, unknown, vertex: on_vertices.contains(&f) });
                    }
                }
                SupportKind::Spring(_) => {}
            }
        }
        let total = bodies.unknowns();
        let mut start = vec![0u32];
        let mut entries = Vec::new();
        let mut next = tied;
        for f in 0..(total / D) as u32 {
            let list = held.get(&f).map_or(&[][..], |l| &l[..]);
            let frame = frame(list);
            let free: Vec<(u32, Point<D>)> = frame[list_rank(list)..]
                .iter()
                .map(|direction| {
                    next += 1;
                    (next - 1, *direction)
                })
                .collect();
            for i in 0..D {
                for (unknown, direction) in &free {
                    if direction[i] != 0.0 {
                        entries.push((*unknown, direction[i]));
                    }
                }
                for h in list {
                    if let Source::Tied { unknown, vertex: true, .. } = h.source
                        && h.direction[i] != 0.0
                    {
                        entries.push((unknown, h.direction[i]));
                    }
                }
                start.push(entries.len() as u32);
            }
        }
        Ok(Reduction { start, entries, unknowns: next as usize, tied, held, reactions })
    }

    /// The row of `T` of an unknown of the bodies.
    pub fn row(&self, unknown: usize) -> &[(u32, f64)] {
        &self.entries[self.start[unknown] as usize..self.start[unknown + 1] as usize]
    }

    /// The first so many unknowns are common displacements of uniform supports.
    pub fn tied(&self) -> u32 {
        self.tied
    }

    /// The supports that constrain a vector function, and along which directions.
    pub fn constraints(&self, function: u32) -> impl Iterator<Item = (usize, Point<D>)> {
        self.held.get(&function).into_iter().flatten().map(|h| match h.source {
            Source::Prescribed { support } | Source::Tied { support, .. } => (support, h.direction),
        })
    }

    /// Whether an unknown of the bodies is prescribed.
    pub fn is_held(&self, unknown: usize) -> bool {
        self.row(unknown).is_empty()
    }

    /// `T y + c`.
    pub fn expand(&self, y: &[f64], offset: &[f64]) -> Vec<f64> {
        (0..offset.len())
            .map(|i| offset[i] + self.row(i).iter().map(|(k, c)| c * y[*k as usize]).sum::<f64>())
            .collect()
    }

    /// `Tᵀ f`.
    pub fn restrict(&self, f: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.unknowns];
        for (i, value) in f.iter().enumerate() {
            for (k, c) in self.row(i) {
                out[*k as usize] += c * value;
            }
        }
        out
    }

    /// The displacement `c` that the supports prescribe.
    pub fn offset(
        &self,
        bodies: &Bodies<D>,
        supports: &[Support],
        displacement: Displacement<'_, D>,
    ) -> Result<Vec<f64>, SupportError> {
        let mut coefficients: Vec<BTreeMap<u32, Point<D>>> = Vec::new();
        for (number, support) in supports.iter().enumerate() {
            coefficients.push(match support.kind {
                SupportKind::Components(_) | SupportKind::Normal => {
                    project(bodies, support, &|x| displacement(number, x))
                }
                _ => BTreeMap::new(),
            });
        }
        // Values of the same point are the same up to the round-off of the fields that they come from.
        let sizes: Vec<f64> = coefficients.iter().map(|c| c.values().map(|u| u.amax()).fold(0.0, f64::max)).collect();
        let mut offset = vec![0.0; bodies.unknowns()];
        for (&f, list) in &self.held {
            let mut known: Vec<(Point<D>, f64)> = Vec::new();
            let mut value = Point::<D>::zeros();
            let mut size = 0.0f64;
            for h in list {
                let Source::Prescribed { support } = h.source else { continue };
                size = size.max(sizes[support]);
                let wanted = coefficients[support].get(&f).map_or(0.0, |c| {
                    if supports[support].kind == SupportKind::Normal { c[0] } else { h.direction.dot(c) }
                });
                let mut rest = h.direction;
                for (b, _) in &known {
                    rest -= b * b.dot(&rest);
                }
                if rest.norm() > 1e-9 {
                    let along = (wanted - h.direction.dot(&value)) / rest.norm();
                    let unit = rest.normalize();
                    value += unit * along;
                    known.push((unit, along));
                } else if (h.direction.dot(&value) - wanted).abs() > 1e-9 * size {
                    let first = list.iter().find_map(|o| match o.source {
                        Source::Prescribed { support: s } if s != support => Some(s),
                        _ => None,
                    });
                    return Err(SupportError::Contradiction {
                        first: supports[first.unwrap_or(support)].name.clone(),
                        second: supports[support].name.clone(),
                        position: place(bodies, f),
                        a: h.direction.dot(&value),
                        b: wanted,
                    });
                }
            }
            for i in 0..D {
                offset[f as usize * D + i] = value[i];
            }
        }
        Ok(offset)
    }
}
