//! Where the joints of an OpenSim model put its bodies at the default values of the coordinates.

use super::pose::{Pose, about, of_angles};
use super::spline::{self, Ends};
use crate::ImportError;
use crate::xml::{File, child, text};
use roxmltree::Node;
use signorini_geometry::Vector;
use std::collections::HashMap;

/// Poses of frames and values of coordinates, by their names.
pub(super) struct Joints {
    frames: HashMap<String, Pose>,
    values: HashMap<String, f64>,
}

/// A joint: the bodies that it connects, and where its frames stand in them.
struct Joint {
    parent: (String, Pose),
    child: (String, Pose),
    /// The pose of its second frame in the first.
    moved: Pose,
}

/// The last part of a path such as `/bodyset/femur_r`.
fn last(path: &str) -> &str {
    path.rsplit('/').next().unwrap_or(path)
}

impl Joints {
    pub(super) fn read(file: &File, model: Node) -> Result<Self, ImportError> {
        let mut values = HashMap::new();
        for node in model.descendants().filter(|n| n.tag_name().name() == "Coordinate") {
            let value = child(node, "default_value").map_or(Ok(0.0), |n| file.number(n))?;
            values.insert(file.attribute(node, "name")?.to_string(), value);
        }
        let mut waiting = Vec::new();
        let set = child(model, "JointSet").and_then(|s| child(s, "objects"));
        for node in set.into_iter().flat_map(|n| n.children()).filter(Node::is_element) {
            waiting.push(joint(file, node, &values)?);
        }
        let mut frames = HashMap::from([("ground".to_string(), Pose::rest())]);
        // From the ground outwards; every round places a body.
        while let Some(k) = waiting.iter().position(|j: &Joint| frames.contains_key(&j.parent.0)) {
            let joint = waiting.swap_remove(k);
            let first = frames[&joint.parent.0].then(&joint.parent.1);
            let pose = first.then(&joint.moved).then(&joint.child.1.inverse());
            frames.insert(joint.child.0, pose);
        }
        Ok(Self { frames, values })
    }

    /// The pose of a body or the ground, by its name or path.
    pub(super) fn frame(&self, path: &str) -> Option<Pose> {
        self.frames.get(last(path)).copied()
    }

    /// The value of a coordinate, by its name or path.
    pub(super) fn value(&self, path: &str) -> Option<f64> {
        self.values.get(last(path)).copied()
    }
}

fn joint(file: &File, node: Node, values: &HashMap<String, f64>) -> Result<Joint, ImportError> {
    let end = |key: &str| -> Result<(String, Pose), ImportError> {
        let name = child(node, key).map(text).ok_or_else(|| file.wrong(node, format!("<{key}> is missing")))?;
        let own = child(node, "frames").into_iter().flat_map(|n| n.children()).filter(Node::is_element);
        let Some(frame) = own.into_iter().find(|n| n.attribute("name") == Some(&name)) else {
            return Ok((last(&name).to_string(), Pose::rest()));
        };
        let vector = |key: &str| child(frame, key).map_or(Ok([0.0; 3]), |n| file.vector(n));
        let rotation = of_angles("xyz", vector("orientation")?).unwrap_or_default();
        let parent = child(frame, "socket_parent").map(text).unwrap_or_default();
        Ok((last(&parent).to_string(), Pose { rotation, origin: Vector::<3>::from(vector("translation")?) }))
    };
    let own: Vec<f64> = child(node, "coordinates")
        .into_iter()
        .flat_map(|n| n.children())
        .filter_map(|n| values.get(n.attribute("name")?).copied())
        .collect();
    let q = |k: usize| own.get(k).copied().unwrap_or(0.0);
    let turned = |rotation| Pose { rotation, origin: Vector::<3>::zeros() };
    let angles = |sequence: &str, list: [f64; 3]| of_angles(sequence, list).unwrap_or_default();
    let moved = match node.tag_name().name() {
        "WeldJoint" => Pose::rest(),
        "PinJoint" => turned(about(&Vector::<3>::z(), q(0))),
        "SliderJoint" => Pose { origin: Vector::<3>::x() * q(0), ..Pose::rest() },
        "UniversalJoint" => turned(angles("xyz", [q(0), q(1), 0.0])),
        "BallJoint" | "GimbalJoint" => turned(angles("xyz", [q(0), q(1), q(2)])),
        "FreeJoint" => Pose { rotation: angles("xyz", [q(0), q(1), q(2)]), origin: Vector::<3>::new(q(3), q(4), q(5)) },
        "PlanarJoint" => Pose { rotation: about(&Vector::<3>::z(), q(0)), origin: Vector::<3>::new(q(1), q(2), 0.0) },
        "CustomJoint" => custom(file, node, values)?,
        other => {
            let valid = "valid are WeldJoint, PinJoint, SliderJoint, UniversalJoint, BallJoint, GimbalJoint, FreeJoint, \
                         PlanarJoint and CustomJoint";
            return Err(file.wrong(node, format!("the joint <{other}> does not exist here: {valid}")));
        }
    };
    Ok(Joint { parent: end("socket_parent_frame")?, child: end("socket_child_frame")?, moved })
}

/// Three rotations about axes that turn with the body, and three translations in the frame of the parent.
fn custom(file: &File, node: Node, values: &HashMap<String, f64>) -> Result<Pose, ImportError> {
    let mut pose = Pose::rest();
    let transform = child(node, "SpatialTransform");
    for axis in transform.into_iter().flat_map(|n| n.children()).filter(Node::is_element) {
        let name = axis.attribute("name").unwrap_or_default();
        let direction = child(axis, "axis").map_or(Ok([0.0; 3]), |n| file.vector(n))?;
        let direction = Vector::<3>::from(direction);
        let coordinate = child(axis, "coordinates").map(text).unwrap_or_default();
        let mut q = 0.0;
        match coordinate.split_whitespace().collect::<Vec<_>>()[..] {
            [] => {}
            [name] => {
                let none = || file.wrong(axis, format!("there is no coordinate `{name}`"));
                q = *values.get(last(name)).ok_or_else(none)?;
            }
            _ => return Err(file.wrong(axis, "functions of several coordinates are not imported")),
        }
        let value = Values { file }.of_parent(axis, q)?;
        if name.starts_with("rotation") {
            pose.rotation *= about(&direction, value);
        } else {
            pose.origin += direction.try_normalize(0.0).unwrap_or_default() * value;
        }
    }
    Ok(pose)
}

/// Values of functions of a coordinate.
pub(super) struct Values<'a, 'f> {
    pub(super) file: &'a File<'f>,
}

impl Values<'_, '_> {
    /// The value of the function that an element contains; the coordinate itself without one.
    pub(super) fn of_parent(&self, parent: Node, q: f64) -> Result<f64, ImportError> {
        let is_function = |n: &Node| {
            let name = n.tag_name().name();
            name == "Constant" || name.ends_with("Function") || name.ends_with("Spline")
        };
        match parent.children().find(is_function) {
            Some(function) => self.of(function, q),
            None => match child(parent, "function") {
                Some(inner) => self.of_parent(inner, q),
                None => Ok(q),
            },
        }
    }

    fn of(&self, node: Node, q: f64) -> Result<f64, ImportError> {
        let numbers = |key: &str| child(node, key).map_or(Ok(Vec::new()), |n| self.file.numbers(n));
        match node.tag_name().name() {
            "Constant" => Ok(numbers("value")?.first().copied().unwrap_or(0.0)),
            "LinearFunction" | "PolynomialFunction" => {
                Ok(numbers("coefficients")?.into_iter().fold(0.0, |sum, c| sum * q + c))
            }
            "MultiplierFunction" => Ok(numbers("scale")?.first().copied().unwrap_or(1.0) * self.of_parent(node, q)?),
            "SimmSpline" | "NaturalCubicSpline" | "PiecewiseLinearFunction" => {
                let (x, y) = (numbers("x")?, numbers("y")?);
                if x.len() != y.len() || x.len() < 2 || !x.is_sorted_by(|a, b| a < b) {
                    return Err(self.file.wrong(node, "expected two or more ascending <x>, and as many <y>"));
                }
                let k = x.partition_point(|x| *x < q).clamp(1, x.len() - 1);
                let linear = y[k - 1] + (y[k] - y[k - 1]) * (q - x[k - 1]) / (x[k] - x[k - 1]);
                Ok(match node.tag_name().name() {
                    "SimmSpline" => spline::value(&x, &y, Ends::Fitted, q),
                    "NaturalCubicSpline" => spline::value(&x, &y, Ends::Natural, q),
                    _ => None,
                }
                .unwrap_or(linear))
            }
            other => Err(self.file.wrong(node, format!("the function <{other}> does not exist here"))),
        }
    }
}
