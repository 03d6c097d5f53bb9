//! How a beam starts: along a path, with sections that turn about it as little as can be.

use super::body::{Beam, NODE, NUMBERS};
use super::element::Element;
use crate::centreline::{Centreline, Closure, Continuity};
use crate::hermite;
use crate::path::Sampled;
use crate::quaternion::{self, Quaternion};
use crate::section::{SectionError, Stiffness};
use signorini_geometry::{Matrix, Vector};

/// A beam that cannot be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BeamError {
    #[error("a beam requires a smooth path: sample it with continuity C1")]
    NotSmooth,
    #[error("the orientation ({}, {}, {}) is parallel to the beam at its start: give a direction across it", at[0], at[1], at[2])]
    Orientation { at: [f64; 3] },
    #[error(
        "element {element} turns by {degrees:.1}° at the start, but at most 90° can be resolved: give more than \
         {cells} cells"
    )]
    TurnsTooMuch { element: usize, degrees: f64, cells: usize },
    #[error("radius {0}: valid are 0 and positive numbers")]
    Radius(f64),
    #[error(transparent)]
    Section(#[from] SectionError),
}

/// Axes along a curve that turn about it as little as can be (double reflection: Wang, Jüttler, Zheng & Liu 2008).
fn transport(axes: &Matrix<3>, from: &Vector<3>, to: &Vector<3>, tangent: &Vector<3>) -> Matrix<3> {
    let reflect = |v: Vector<3>, across: &Vector<3>| {
        let square = across.norm_squared();
        if square == 0.0 { v } else { v - across * (2.0 * across.dot(&v) / square) }
    };
    let first = to - from;
    let [d1, d2] = [0, 1].map(|k| reflect(axes.column(k).into_owned(), &first));
    let d2 = reflect(d2, &(tangent - d1));
    let d2 = (d2 - tangent * tangent.dot(&d2)).normalize();
    Matrix::<3>::from_columns(&[*tangent, d2, tangent.cross(&d2)])
}

impl Beam {
    /// A beam along a path. `orientation` is a direction near the section's axis `d_2` at the start; without one, that of
    /// the coordinate axis farthest from the tangent. `radius` is what touches; `contact_points` of each element are tested.
    ///
    /// # Errors
    /// A path with kinks, a direction along the beam, a stiffness that is not positive, elements that turn too much.
    pub fn new(
        name: &str,
        path: &Sampled,
        orientation: Option<Vector<3>>,
        stiffness: Stiffness,
        radius: f64,
    ) -> Result<Self, BeamError> {
        if path.continuity != Continuity::C1 {
            return Err(BeamError::NotSmooth);
        }
        if !(radius >= 0.0 && radius.is_finite()) {
            return Err(BeamError::Radius(radius));
        }
        let stiffness = stiffness.checked()?;
        let line = Centreline::new(path.lengths.clone(), path.closure, Continuity::C1, [NODE, NUMBERS]);
        let tangent = path.tangents[0];
        let direction = orientation.unwrap_or_else(|| quaternion::axis(tangent.iamin()));
        let across = direction - tangent * tangent.dot(&direction);
        if across.norm().is_nan() || across.norm() <= 1e-6 * direction.norm() {
            return Err(BeamError::Orientation { at: crate::path::array(&direction) });
        }
        let d2 = across.normalize();
        let mut axes = Matrix::<3>::from_columns(&[tangent, d2, tangent.cross(&d2)]);
        let (nodes, count) = (line.nodes(), line.elements());
        let mut start = vec![0.0; NUMBERS * nodes + 4 * count];
        for node in 0..nodes {
            start[NUMBERS * node..NUMBERS * node + 3].copy_from_slice(path.positions[node].as_slice());
            start[NUMBERS * node + 3..NUMBERS * node + 6].copy_from_slice(path.tangents[node].as_slice());
        }
        // Axes at the nodes and in the middles, one after the other.
        let mut frames = vec![axes];
        for e in 0..count {
            let x = line.nodal(&start, e);
            let h = line.lengths[e];
            let middle = hermite::sum(&hermite::cubic(0.5, h), &x);
            let along = hermite::sum(&hermite::cubic_first(0.5, h), &x).normalize();
            axes = transport(&axes, &x[0], &middle, &along);
            frames.push(axes);
            axes = transport(&axes, &middle, &x[2], &x[3].normalize());
            frames.push(axes);
        }
        if path.closure == Closure::Closed {
            untwist(&mut frames);
        }
        let quaternions: Vec<Quaternion> = frames.iter().map(quaternion::of_rotation).collect();
        let mut beam = Beam {
            name: name.to_string(),
            line,
            elements: Vec::new(),
            signs: Vec::new(),
            radius,
            contact_points: 4,
            start,
            mass: None,
        };
        for node in 0..nodes {
            beam.start[NUMBERS * node + 6..NUMBERS * (node + 1)].copy_from_slice(quaternions[2 * node].as_slice());
        }
        for e in 0..count {
            let at = beam.middle(e);
            beam.start[at..at + 4].copy_from_slice(quaternions[2 * e + 1].as_slice());
            let last = beam.line.ends(e)[1];
            let ends = [quaternions[2 * e], quaternions[2 * last]];
            let sign = |q: &Quaternion| if q.dot(&ends[0]) < 0.0 { -1.0 } else { 1.0 };
            let turn = 2.0 * ends[0].dot(&ends[1]).abs().min(1.0).acos();
            if turn > std::f64::consts::FRAC_PI_2 * (1.0 + 1e-9) {
                return Err(BeamError::TurnsTooMuch { element: e, degrees: turn.to_degrees(), cells: count });
            }
            beam.signs.push([sign(&ends[1]), sign(&quaternions[2 * e + 1])]);
            let nodes = beam.nodes_of(&beam.start, e);
            beam.elements.push(Element::new(beam.line.lengths[e], stiffness, &nodes));
        }
        Ok(beam)
    }
}

/// Turns the axes along a closed curve so that the last ones are the first ones.
fn untwist(frames: &mut [Matrix<3>]) {
    let last = frames.len() - 1;
    let (first, end) = (frames[0], frames[last]);
    let angle = end.column(1).dot(&first.column(2)).atan2(end.column(1).dot(&first.column(1)));
    for (k, frame) in frames.iter_mut().enumerate() {
        let d1: Vector<3> = frame.column(0).into_owned();
        let turn = quaternion::rotation(&quaternion::exponential(&(d1 * (-angle * k as f64 / last as f64))));
        *frame = turn * *frame;
    }
}
