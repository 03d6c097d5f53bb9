//! An edge from the mesh: its chain of cell edges, tangents at the vertices, and what moves the points of Bezier.

use super::{EdgeCurve, EdgeError, EdgeOf, Element, between, chain};
use crate::solid_body::faces::{Faces, NOTHING};
use crate::solid_body::{SolidBody, spatial};
use signorini_fem::Local;
use signorini_fem::rules::rule;
use signorini_geometry::Vector;
use signorini_mechanics::curve::Closure;
use std::collections::BTreeMap;

/// Points that tell the length of an edge.
const LENGTH_POINTS: usize = 6;

/// A point that is linear in the displacements: where it is at rest, and functions with their weights.
#[derive(Clone, Default)]
struct Linear {
    x: Vector<3>,
    weights: BTreeMap<u32, f64>,
}

impl Linear {
    fn add(&mut self, other: &Linear, share: f64) {
        self.x += other.x * share;
        other.weights.iter().for_each(|(f, w)| *self.weights.entry(*f).or_default() += w * share);
    }

    /// A sum with shares.
    fn sum(terms: &[(&Linear, f64)]) -> Linear {
        let mut out = Linear::default();
        terms.iter().for_each(|(term, share)| out.add(term, *share));
        out
    }
}

impl EdgeCurve {
    /// The edge along which two surfaces meet.
    ///
    /// # Errors
    /// Edges that are not there, that branch, turn or fall into pieces.
    pub(in crate::solid_body) fn new<const D: usize>(
        body: &SolidBody<D>,
        name: &str,
        stated: &EdgeOf,
    ) -> Result<Self, EdgeError> {
        let (links, closure) = chain::links(body, name, &stated.surfaces)?;
        let faces = &body.faces;
        let count = links.len();
        // Position and derivative along the unit length at both ends of each link.
        let lengths: Vec<f64> = links.iter().map(|l| length(faces, l.faces[0])).collect();
        let at = |e: usize, end: usize| linear(faces, links[e].faces[0], end as f64, lengths[e]);
        let own: Vec<[(Linear, Linear); 2]> = (0..count).map(|e| [at(e, 0), at(e, 1)]).collect();
        let mut tangents: Vec<[Linear; 2]> = own.iter().map(|[a, b]| [a.1.clone(), b.1.clone()]).collect();
        let inner = if closure == Closure::Closed { 0..count } else { 1..count };
        for e in inner {
            let before = (e + count - 1) % count;
            let (h, g) = (lengths[before], lengths[e]);
            let [arriving, leaving] = [&own[before][1].1, &own[e][0].1];
            chain::check_kink(name, &links[e], arriving.x, leaving.x)?;
            let mean = Linear::sum(&[(arriving, g / (h + g)), (leaving, h / (h + g))]);
            tangents[before][1] = mean.clone();
            tangents[e][0] = mean;
        }
        if closure == Closure::Open && count > 1 {
            // At an end the parabola goes on.
            for (e, end) in [(0, 0), (count - 1, 1)] {
                let other = tangents[e][1 - end].clone();
                tangents[e][end] = Linear::sum(&[(&own[e][0].1, 1.0), (&own[e][1].1, 1.0), (&other, -1.0)]);
            }
        }
        let elements = (0..count)
            .map(|e| {
                let third = lengths[e] / 3.0;
                let [start, end] = [&own[e][0].0, &own[e][1].0];
                let bezier = [
                    start.clone(),
                    Linear::sum(&[(start, 1.0), (&tangents[e][0], third)]),
                    Linear::sum(&[(end, 1.0), (&tangents[e][1], -third)]),
                    end.clone(),
                ];
                let mut functions: BTreeMap<u32, [f64; 4]> = BTreeMap::new();
                for (k, point) in bezier.iter().enumerate() {
                    point.weights.iter().for_each(|(f, w)| functions.entry(*f).or_default()[k] = *w);
                }
                let aside = [0, 1].map(|end| aside(faces, links[e].faces[0], end));
                let mut turning: BTreeMap<u32, [f64; 2]> = functions.keys().map(|f| (*f, [0.0; 2])).collect();
                for (k, vector) in aside.iter().enumerate() {
                    vector.weights.iter().for_each(|(f, w)| turning.entry(*f).or_default()[k] = *w);
                }
                Element {
                    aside: aside.each_ref().map(|v| v.x),
                    turning: turning.into_iter().collect(),
                    points: bezier.each_ref().map(|p| p.x),
                    functions: functions.into_iter().collect(),
                    length: lengths[e],
                    faces: links[e].faces,
                    depth: 0.5 * links[e].faces.iter().map(|f| faces.face(f.0).depth).fold(f64::INFINITY, f64::min),
                }
            })
            .collect();
        let mut starts = vec![0.0];
        lengths.iter().for_each(|h| starts.push(starts[starts.len() - 1] + h));
        Ok(EdgeCurve {
            elements,
            closure,
            radius: stated.radius,
            starts,
            youngs_modulus: body.body().material.youngs_modulus,
            degree: body.body().degree,
            first: 0,
        })
    }
}

/// A vector from an end of an edge into a face: towards its middle, by its coordinates.
fn aside<const D: usize>(faces: &Faces<D>, (face, ends): (u32, [Local; 2]), end: usize) -> Linear {
    let (middle, centre) = (between(&ends, 0.5), faces.face(face).shape.centre());
    let towards = [0, 1].map(|k| centre[k] - middle[k]);
    let at = faces.reference(face, &ends[end]);
    let mut out =
        Linear { x: spatial(&(at.tangents[0] * towards[0] + at.tangents[1] * towards[1])), ..Linear::default() };
    for (f, d) in faces.slopes(face, &ends[end]) {
        out.weights.insert(f, d[1] * towards[0] + d[2] * towards[1]);
    }
    out
}

/// Position and derivative per length at a place along an edge of a face.
fn linear<const D: usize>(faces: &Faces<D>, (face, ends): (u32, [Local; 2]), t: f64, length: f64) -> (Linear, Linear) {
    let s = between(&ends, t);
    let along = [0, 1].map(|k| (ends[1][k] - ends[0][k]) / length);
    let at = faces.reference(face, &s);
    let slope = at.tangents[0] * along[0] + at.tangents[1] * along[1];
    let [mut position, mut derivative] =
        [spatial(&at.x), spatial(&slope)].map(|x| Linear { x, weights: BTreeMap::new() });
    for (f, d) in faces.slopes(face, &s) {
        let slope = d[1] * along[0] + d[2] * along[1];
        // Functions of the rest of the face vanish along the edge up to rounding.
        for (list, value) in [(&mut position.weights, d[0]), (&mut derivative.weights, slope * length)] {
            if value.abs() > NOTHING {
                list.insert(f, value);
            }
        }
    }
    derivative.weights.values_mut().for_each(|w| *w /= length);
    (position, derivative)
}

/// Length of an edge at rest.
fn length<const D: usize>(faces: &Faces<D>, (face, ends): (u32, [Local; 2])) -> f64 {
    let along = |k: usize| ends[1][k] - ends[0][k];
    (rule(signorini_fem::CellShape::Line, LENGTH_POINTS).into_iter())
        .map(|(s, w)| {
            let at = faces.reference(face, &between(&ends, 0.5 * (1.0 + s[0])));
            0.5 * w * (at.tangents[0] * along(0) + at.tangents[1] * along(1)).norm()
        })
        .sum()
}
