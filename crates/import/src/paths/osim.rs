//! Muscles, ligaments and other paths of OpenSim (`.osim`), at the default values of the coordinates.
//!
//! Bodies stand where the joints put them (`joints`). A wrap object may be in the way of every part of a path within its range.

use super::circle::Way;
use super::joints::{Joints, Values};
use super::pose::{Pose, of_angles};
use super::{Model, Shape, Track, Wrap};
use crate::ImportError;
use crate::xml::{File, child, children, text};
use roxmltree::{Document, Node};
use signorini_geometry::Vector;
use std::collections::HashMap;
use std::path::Path;

/// The first version whose joints name their frames.
const VERSION: f64 = 40000.0;

/// The case of a file.
pub(crate) fn read(path: &Path) -> Result<String, ImportError> {
    let content =
        std::fs::read_to_string(path).map_err(|e| ImportError::new(path, None, format!("cannot be read: {e}")))?;
    let document = Document::parse(&content)
        .map_err(|e| ImportError::new(path, e.pos().row as usize, format!("is no XML: {e}")))?;
    let file = File { path, document: &document };
    let root = document.root_element();
    let model = child(root, "Model").filter(|_| root.tag_name().name() == "OpenSimDocument");
    let model = model.ok_or_else(|| file.wrong(root, "expected <OpenSimDocument> with a <Model>"))?;
    let version: f64 = file.attribute(root, "Version")?.parse().unwrap_or(0.0);
    if version < VERSION {
        let message =
            format!("Version {version}: expected {VERSION} or later; open the model in OpenSim 4 and save it");
        return Err(file.wrong(root, message));
    }
    let joints = Joints::read(&file, model)?;
    let mut reader = Reader { file, joints, wraps: HashMap::new(), model: Model::default() };
    reader.model.title = model.attribute("name").map(str::to_string);
    let is_metre = |n: Node| text(n).eq_ignore_ascii_case("meters");
    let is_newton = |n: Node| text(n).eq_ignore_ascii_case("N");
    let si = child(model, "length_units").is_some_and(is_metre) && child(model, "force_units").is_some_and(is_newton);
    reader.model.units = si.then_some("m-N-Pa");
    if model.descendants().any(|n| n.tag_name().name() == "CoordinateCouplerConstraint") {
        let message = "coordinates that others determine (CoordinateCouplerConstraint) have their default values";
        reader.model.remarks.push(message.into());
    }
    reader.wrap_objects(model)?;
    for node in model.descendants().filter(|n| n.tag_name().name() == "GeometryPath") {
        reader.path(node)?;
    }
    reader.model.text(path)
}

/// A wrap object that is active: its number among the bodies, and the direction to the side on which paths pass.
#[derive(Clone)]
struct Object {
    body: usize,
    side: Option<(String, Vector<3>)>,
}

struct Reader<'a> {
    file: File<'a>,
    joints: Joints,
    wraps: HashMap<String, Object>,
    model: Model,
}

impl<'a> Reader<'a> {
    fn wrap_objects(&mut self, model: Node<'a, 'a>) -> Result<(), ImportError> {
        for set in model.descendants().filter(|n| n.tag_name().name() == "WrapObjectSet") {
            let Some(frame) = set.parent().filter(|_| child(set, "objects").is_some()) else { continue };
            let Some(objects) = child(set, "objects").filter(|o| o.children().any(|n| n.is_element())) else {
                continue;
            };
            let name = frame.attribute("name").unwrap_or_default();
            let pose =
                self.joints.frame(name).ok_or_else(|| self.file.wrong(set, format!("no joint places `{name}`")))?;
            for node in objects.children().filter(Node::is_element) {
                self.wrap_object(node, &pose)?;
            }
        }
        Ok(())
    }

    fn wrap_object(&mut self, node: Node<'a, 'a>, frame: &Pose) -> Result<(), ImportError> {
        let name = self.file.attribute(node, "name")?.to_string();
        if child(node, "active").is_some_and(|n| text(n) == "false") {
            return Ok(());
        }
        let vector = |key: &str| child(node, key).map_or(Ok([0.0; 3]), |n| self.file.vector(n));
        let (angles, origin) = (vector("xyz_body_rotation")?, vector("translation")?);
        let rotation = of_angles("xyz", angles).unwrap_or_default();
        let pose = frame.then(&Pose { rotation, origin: Vector::<3>::from(origin) });
        let positive = |key: &str| -> Result<f64, ImportError> {
            let value = child(node, key).ok_or_else(|| self.file.wrong(node, format!("<{key}> is missing")))?;
            let number = self.file.number(value)?;
            if number > 0.0 { Ok(number) } else { Err(self.file.wrong(value, format!("{number}: expected > 0"))) }
        };
        let shape = match node.tag_name().name() {
            "WrapSphere" => Shape::Sphere(positive("radius")?),
            "WrapCylinder" => Shape::Cylinder(positive("radius")?),
            // Its outer radius is that of the circle in the middle of the tube, the inner one that of the tube.
            "WrapTorus" => Shape::Torus { major: positive("outer_radius")?, minor: positive("inner_radius")? },
            "WrapEllipsoid" => {
                let axes = child(node, "dimensions").ok_or_else(|| self.file.wrong(node, "<dimensions> is missing"))?;
                let found = self.file.vector(axes)?;
                if found.iter().any(|v| *v <= 0.0) {
                    return Err(self.file.wrong(axes, "expected three positive semi-axes"));
                }
                Shape::Ellipsoid(found)
            }
            other => {
                let valid = "valid are WrapSphere, WrapCylinder, WrapEllipsoid and WrapTorus";
                return Err(self.file.wrong(node, format!("the wrap object <{other}> does not exist here: {valid}")));
            }
        };
        let quadrant = child(node, "quadrant").map(text).unwrap_or_default();
        let side = match quadrant.trim_start_matches(['+', '-']) {
            "" | "all" => None,
            axis => {
                let valid = || self.file.wrong(node, format!("quadrant `{quadrant}`: valid are all, x, +x, -x, y, …"));
                let axis = ["x", "y", "z"].iter().position(|a| *a == axis).ok_or_else(valid)?;
                let sign = if quadrant.starts_with('-') { -1.0 } else { 1.0 };
                Some((quadrant.clone(), pose.direction(&(Vector::<3>::ith(axis, 1.0) * sign))))
            }
        };
        self.model.bodies.push(Wrap { name: name.clone(), shape, pose });
        self.wraps.insert(name, Object { body: self.model.bodies.len() - 1, side });
        Ok(())
    }

    /// The path of a muscle, unless it cannot be here, which is said.
    fn path(&mut self, node: Node<'a, 'a>) -> Result<(), ImportError> {
        let owner = node.parent().and_then(|n| n.attribute("name")).or(node.attribute("name")).unwrap_or("path");
        let mut track = Track { name: owner.to_string(), ..Track::default() };
        let objects = |set: &str| child(node, set).and_then(|s| child(s, "objects"));
        for point in objects("PathPointSet").into_iter().flat_map(|n| n.children()).filter(Node::is_element) {
            if let Some(x) = self.point(point)? {
                track.points.push(x);
            }
        }
        if track.points.len() < 2 {
            self.model.remarks.push(format!("`{owner}` is left out: it has less than two points"));
            return Ok(());
        }
        track.around = vec![Vec::new(); track.points.len() - 1];
        for wrap in objects("PathWrapSet").into_iter().flat_map(|n| children(n, "PathWrap")) {
            if child(wrap, "active").is_some_and(|n| text(n) == "false") {
                continue;
            }
            let name = child(wrap, "wrap_object").map(text).unwrap_or_default();
            // One that is not active has no number.
            let Some(object) = self.wraps.get(&name).cloned() else { continue };
            let range = child(wrap, "range").map_or(Ok(Vec::new()), |n| self.file.numbers(n))?;
            let end = |k: usize, other: usize| match range.get(k) {
                Some(number) if *number >= 1.0 => *number as usize - 1,
                _ => other,
            };
            let parts = end(0, 0)..end(1, track.points.len() - 1).min(track.points.len() - 1);
            if !self.lead(&mut track, parts, &object) {
                return Ok(());
            }
        }
        self.model.paths.push(track);
        Ok(())
    }

    /// Leads parts of a path around an object; whether the path can be here.
    fn lead(&mut self, track: &mut Track, parts: std::ops::Range<usize>, object: &Object) -> bool {
        let body = &self.model.bodies[object.body];
        let owner = &track.name;
        let mut remarks = Vec::new();
        let mut leave_out = false;
        for part in parts {
            let (from, to) = (track.points[part], track.points[part + 1]);
            let side = object.side.as_ref().map(|(_, direction)| *direction);
            let inside = body.contains(&from) || body.contains(&to);
            match body.way(&from, &to, side) {
                _ if inside => remarks.push(format!(
                    "`{owner}` is not led around `{}` between its points {} and {}, one of which lies inside of it",
                    body.name,
                    part + 1,
                    part + 2
                )),
                Some(Way::OtherSide | Way::Longer) => {
                    let (name, quadrant) = (&body.name, object.side.as_ref().map_or("", |(q, _)| q));
                    remarks.push(format!(
                        "`{owner}` is left out: OpenSim leads it by the longer way around `{name}`, on its side {quadrant}, between \
                         the points {} and {}; paths here are the shortest",
                        part + 1,
                        part + 2
                    ));
                    leave_out = true;
                    break;
                }
                Some(_) => track.around[part].push(object.body),
                None => {
                    track.around[part].push(object.body);
                    if let Some((quadrant, _)) = &object.side {
                        remarks.push(format!(
                            "`{}`: the side {quadrant} is not imposed; paths are the shortest, so see on which side they pass",
                            body.name
                        ));
                    }
                    if matches!(body.shape, Shape::Torus { .. }) {
                        let message = "is a torus here; OpenSim takes a cylinder that touches its circle";
                        remarks.push(format!("`{}` {message}", body.name));
                    }
                }
            }
        }
        for remark in remarks {
            if !self.model.remarks.contains(&remark) {
                self.model.remarks.push(remark);
            }
        }
        !leave_out
    }

    /// The place of a point; `None` of one that is not there at the default values.
    fn point(&self, node: Node<'a, 'a>) -> Result<Option<Vector<3>>, ImportError> {
        let kind = node.tag_name().name();
        let frame = child(node, "socket_parent_frame").map(text).unwrap_or_default();
        let wrong = |message: String| self.file.wrong(node, message);
        let pose = self.joints.frame(&frame).ok_or_else(|| wrong(format!("no joint places `{frame}`")))?;
        let coordinate = |key: &str| -> Result<f64, ImportError> {
            let name = child(node, key).map(text).unwrap_or_default();
            self.joints.value(&name).ok_or_else(|| wrong(format!("<{key}>: there is no coordinate `{name}`")))
        };
        let x = match kind {
            "PathPoint" | "ConditionalPathPoint" => {
                let location = child(node, "location").ok_or_else(|| wrong("<location> is missing".into()))?;
                if kind == "ConditionalPathPoint" {
                    let range = child(node, "range").map_or(Ok(Vec::new()), |n| self.file.numbers(n))?;
                    let &[low, high] = &range[..] else { return Err(wrong("<range>: expected two numbers".into())) };
                    if !(low..=high).contains(&coordinate("socket_coordinate")?) {
                        return Ok(None);
                    }
                }
                Vector::<3>::from(self.file.vector(location)?)
            }
            "MovingPathPoint" => {
                let mut x = Vector::<3>::zeros();
                for (k, axis) in ["x", "y", "z"].iter().enumerate() {
                    let function = child(node, &format!("{axis}_location"))
                        .ok_or_else(|| wrong(format!("<{axis}_location> is missing")))?;
                    let key = format!("socket_{axis}_coordinate");
                    // A constant has no coordinate.
                    let q =
                        if child(node, &key).is_some_and(|n| !text(n).is_empty()) { coordinate(&key)? } else { 0.0 };
                    x[k] = Values { file: &self.file }.of_parent(function, q)?;
                }
                x
            }
            other => {
                return Err(wrong(format!("<{other}>: valid are PathPoint, ConditionalPathPoint, MovingPathPoint")));
            }
        };
        Ok(Some(pose.point(&x)))
    }
}
