//! Spatial tendons of MuJoCo (MJCF), at the pose of the file.
//!
//! The rules are those of its XML reference: angles in degrees unless the compiler says otherwise, defaults by classes, frames
//! that only place what they contain. A sphere or cylinder between two sites is wrapped on the side of its `sidesite`; cylinders
//! are infinite.

use super::circle::Way;
use super::pose::{Pose, about, of_angles, of_quaternion};
use super::{Model, Shape, Track, Wrap};
use crate::ImportError;
use crate::xml::{File, children};
use nalgebra::Matrix3;
use roxmltree::{Document, Node};
use signorini_geometry::Vector;
use std::collections::HashMap;
use std::path::Path;

/// The case of a file.
pub(crate) fn read(path: &Path) -> Result<String, ImportError> {
    let text =
        std::fs::read_to_string(path).map_err(|e| ImportError::new(path, None, format!("cannot be read: {e}")))?;
    let document =
        Document::parse(&text).map_err(|e| ImportError::new(path, e.pos().row as usize, format!("is no XML: {e}")))?;
    let file = File { path, document: &document };
    let root = document.root_element();
    if root.tag_name().name() != "mujoco" {
        return Err(file.wrong(root, "expected <mujoco>, a model of MuJoCo"));
    }
    let mut reader = Reader { file, degrees: true, sequence: "xyz".into(), ..Reader::new(&document, path) };
    reader.model.title = root.attribute("model").map(str::to_string);
    for node in root.descendants().filter(Node::is_element) {
        if ["include", "replicate", "attach", "composite", "flexcomp"].contains(&node.tag_name().name()) {
            let message =
                "cannot be imported: write the model out by MuJoCo (mj_saveLastXML), which has no such elements";
            return Err(reader.file.wrong(node, message));
        }
    }
    for compiler in children(root, "compiler") {
        reader.degrees = compiler.attribute("angle").map_or(reader.degrees, |a| a != "radian");
        reader.sequence = compiler.attribute("eulerseq").unwrap_or(&reader.sequence).to_string();
        if compiler.attribute("coordinate").is_some_and(|c| c != "local") {
            return Err(reader.file.wrong(compiler, "coordinate: only `local` is read"));
        }
    }
    for default in children(root, "default") {
        reader.defaults(default, None);
    }
    for world in children(root, "worldbody") {
        reader.body(world, Pose::rest(), None)?;
    }
    for tendons in children(root, "tendon") {
        for tendon in children(tendons, "spatial") {
            reader.tendon(tendon)?;
        }
    }
    reader.model.text(path)
}

/// What a name of a site or geom stands for.
struct Placed<'a> {
    node: Node<'a, 'a>,
    pose: Pose,
    class: Option<String>,
}

struct Reader<'a> {
    file: File<'a>,
    degrees: bool,
    sequence: String,
    /// The elements of defaults by class and element, and the class that contains a class.
    defaults: HashMap<(String, String), Node<'a, 'a>>,
    within: HashMap<String, String>,
    sites: HashMap<String, Vector<3>>,
    geoms: HashMap<String, Placed<'a>>,
    wraps: HashMap<String, usize>,
    model: Model,
}

const MAIN: &str = "main";

impl<'a> Reader<'a> {
    fn new(document: &'a Document<'a>, path: &'a Path) -> Self {
        Self {
            file: File { path, document },
            degrees: true,
            sequence: String::new(),
            defaults: HashMap::new(),
            within: HashMap::new(),
            sites: HashMap::new(),
            geoms: HashMap::new(),
            wraps: HashMap::new(),
            model: Model::default(),
        }
    }

    fn defaults(&mut self, node: Node<'a, 'a>, outer: Option<&str>) {
        let class = node.attribute("class").unwrap_or(MAIN).to_string();
        if let Some(outer) = outer {
            self.within.insert(class.clone(), outer.to_string());
        }
        for element in node.children().filter(Node::is_element) {
            match element.tag_name().name() {
                "default" => self.defaults(element, Some(&class)),
                name => drop(self.defaults.insert((class.clone(), name.to_string()), element)),
            }
        }
    }

    /// An attribute of an element, or of the defaults of its class.
    fn attribute(&self, node: Node<'a, 'a>, name: &str, class: Option<&str>) -> Option<&'a str> {
        if let Some(value) = node.attribute(name) {
            return Some(value);
        }
        let mut class = node.attribute("class").or(class).unwrap_or(MAIN).to_string();
        // Every class is within another one at most once.
        for _ in 0..=self.within.len() {
            let element = self.defaults.get(&(class.clone(), node.tag_name().name().to_string()));
            if let Some(value) = element.and_then(|n| n.attribute(name)) {
                return Some(value);
            }
            class = self.within.get(&class)?.clone();
        }
        None
    }

    fn numbers(&self, node: Node<'a, 'a>, name: &str, class: Option<&str>) -> Result<Option<Vec<f64>>, ImportError> {
        let Some(text) = self.attribute(node, name, class) else { return Ok(None) };
        let parse = |t: &str| {
            let number: Option<f64> = t.parse().ok().filter(|v: &f64| v.is_finite());
            number.ok_or_else(|| self.file.wrong(node, format!("{name}: expected numbers, found `{t}`")))
        };
        text.split_whitespace().map(parse).collect::<Result<Vec<_>, _>>().map(Some)
    }

    fn exactly<const N: usize>(
        &self,
        node: Node<'a, 'a>,
        name: &str,
        class: Option<&str>,
    ) -> Result<Option<[f64; N]>, ImportError> {
        let Some(list) = self.numbers(node, name, class)? else { return Ok(None) };
        let count = list.len();
        let wrong = |_| self.file.wrong(node, format!("{name}: expected {N} numbers, found {count}"));
        <[f64; N]>::try_from(list).map(Some).map_err(wrong)
    }

    fn vector(&self, node: Node<'a, 'a>, name: &str, class: Option<&str>) -> Result<Option<Vector<3>>, ImportError> {
        Ok(self.exactly::<3>(node, name, class)?.map(Vector::<3>::from))
    }

    /// The pose of an element in the frame that contains it.
    fn pose(&self, node: Node<'a, 'a>, class: Option<&str>) -> Result<Pose, ImportError> {
        let origin = self.vector(node, "pos", class)?.unwrap_or_else(Vector::<3>::zeros);
        let angle = |v: f64| if self.degrees { v.to_radians() } else { v };
        let wrong = |name: &str, what: &str| self.file.wrong(node, format!("{name}: {what}"));
        let mut rotation = Matrix3::identity();
        if let Some(q) = self.exactly::<4>(node, "quat", class)? {
            rotation = of_quaternion(q).ok_or_else(|| wrong("quat", "the quaternion is zero"))?;
        }
        if let Some([x, y, z, a]) = self.exactly::<4>(node, "axisangle", class)? {
            rotation = about(&Vector::<3>::new(x, y, z), angle(a));
        }
        if let Some(angles) = self.exactly::<3>(node, "euler", class)? {
            rotation = of_angles(&self.sequence, angles.map(angle))
                .ok_or_else(|| wrong("euler", &format!("eulerseq `{}` has to be three of xyzXYZ", self.sequence)))?;
        }
        if let Some([a, b, c, d, e, f]) = self.exactly::<6>(node, "xyaxes", class)? {
            let (x, y) = (Vector::<3>::new(a, b, c), Vector::<3>::new(d, e, f));
            let x = x.try_normalize(0.0).ok_or_else(|| wrong("xyaxes", "the axes are zero"))?;
            let y = (y - x * x.dot(&y)).try_normalize(0.0).ok_or_else(|| wrong("xyaxes", "the axes are parallel"))?;
            rotation = Matrix3::from_columns(&[x, y, x.cross(&y)]);
        }
        if let Some(z) = self.vector(node, "zaxis", class)? {
            rotation = onto(&z).ok_or_else(|| wrong("zaxis", "the axis is zero"))?;
        }
        Ok(Pose { rotation, origin })
    }

    /// What a body, the world or a frame contains.
    fn body(&mut self, node: Node<'a, 'a>, pose: Pose, class: Option<&str>) -> Result<(), ImportError> {
        let class = node.attribute("childclass").or(class);
        for inner in node.children().filter(Node::is_element) {
            match inner.tag_name().name() {
                // A frame or body has no defaults.
                "body" | "frame" => {
                    let own = self.pose(inner, None)?;
                    self.body(inner, pose.then(&own), class)?;
                }
                "site" => {
                    let own = self.placed(inner, class)?;
                    if let Some(name) = inner.attribute("name") {
                        self.sites.insert(name.to_string(), pose.then(&own).origin);
                    }
                }
                "geom" => {
                    if let Some(name) = inner.attribute("name") {
                        let placed = Placed { node: inner, pose, class: class.map(str::to_string) };
                        self.geoms.insert(name.to_string(), placed);
                    }
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// The pose of a site or geom, which may be stated by two points of its axis.
    fn placed(&self, node: Node<'a, 'a>, class: Option<&str>) -> Result<Pose, ImportError> {
        let Some([a, b, c, d, e, f]) = self.exactly::<6>(node, "fromto", class)? else { return self.pose(node, class) };
        let (from, to) = (Vector::<3>::new(a, b, c), Vector::<3>::new(d, e, f));
        let rotation =
            onto(&(from - to)).ok_or_else(|| self.file.wrong(node, "fromto: the two points are the same"))?;
        Ok(Pose { rotation, origin: (from + to) * 0.5 })
    }

    /// The body that a geom is, by its number.
    fn wrap(&mut self, by: Node<'a, 'a>, name: &str) -> Result<usize, ImportError> {
        if let Some(known) = self.wraps.get(name) {
            return Ok(*known);
        }
        let none = || self.file.wrong(by, format!("there is no geom `{name}`"));
        let placed = self.geoms.get(name).ok_or_else(none)?;
        let (node, class) = (placed.node, placed.class.as_deref());
        let size = self.numbers(node, "size", class)?.unwrap_or_default();
        let radius = size.first().copied().filter(|r| *r > 0.0);
        let radius = radius.ok_or_else(|| self.file.wrong(node, "size: expected a positive radius"))?;
        let shape = match self.attribute(node, "type", class).unwrap_or("sphere") {
            "sphere" => Shape::Sphere(radius),
            "cylinder" => Shape::Cylinder(radius),
            other => return Err(self.file.wrong(node, format!("type `{other}`: tendons wrap spheres and cylinders"))),
        };
        let pose = placed.pose.then(&self.placed(node, class)?);
        self.model.bodies.push(Wrap { name: name.to_string(), shape, pose });
        let number = self.model.bodies.len() - 1;
        self.wraps.insert(name.to_string(), number);
        Ok(number)
    }

    fn site(&self, by: Node<'a, 'a>, name: &str) -> Result<Vector<3>, ImportError> {
        self.sites.get(name).copied().ok_or_else(|| self.file.wrong(by, format!("there is no site `{name}`")))
    }

    fn tendon(&mut self, node: Node<'a, 'a>) -> Result<(), ImportError> {
        let count = self.model.paths.len() + 1;
        let name = node.attribute("name").map_or_else(|| format!("tendon_{count}"), str::to_string);
        let mut tracks = vec![Track { name: name.clone(), ..Track::default() }];
        let mut between: Vec<(usize, Option<Vector<3>>)> = Vec::new();
        for step in node.children().filter(Node::is_element) {
            match step.tag_name().name() {
                "site" => {
                    let x = self.site(step, self.file.attribute(step, "site")?)?;
                    let Some(track) = tracks.last_mut() else { continue };
                    if let Some(last) = track.points.last() {
                        let mut around = Vec::new();
                        for (body, side) in between.drain(..) {
                            match self.model.bodies[body].way(last, &x, side) {
                                Some(Way::Straight | Way::Shorter) => around.push(body),
                                // MuJoCo draws it straight through.
                                Some(Way::Inside) => self.model.remarks.push(format!(
                                    "line {}: `{name}` begins or ends inside `{}` and is not led around it, as in MuJoCo",
                                    self.file.line(step),
                                    self.model.bodies[body].name
                                )),
                                _ => {
                                    self.model.remarks.push(format!(
                                        "line {}: `{name}` is left out: it passes `{}` by the longer way, on the side of its \
                                         sidesite; paths here are the shortest",
                                        self.file.line(step),
                                        self.model.bodies[body].name
                                    ));
                                    return Ok(());
                                }
                            }
                        }
                        track.around.push(around);
                    }
                    track.points.push(x);
                }
                "geom" => {
                    let body = self.wrap(step, self.file.attribute(step, "geom")?)?;
                    let side = match step.attribute("sidesite") {
                        None => None,
                        Some(site) => {
                            let x = self.site(step, site)?;
                            let own = &self.model.bodies[body];
                            if own.contains(&x) {
                                let message = format!(
                                    "cannot be imported: the sidesite `{site}` lies inside `{}`: paths inside of bodies do not exist here",
                                    own.name
                                );
                                return Err(self.file.wrong(step, message));
                            }
                            Some(x - own.pose.origin)
                        }
                    };
                    between.push((body, side));
                }
                "pulley" => {
                    let divisor = step.attribute("divisor").unwrap_or("1");
                    let number = tracks.iter().filter(|t| !t.points.is_empty()).count() + 1;
                    self.model.remarks.push(format!(
                        "line {}: the branches of `{name}` at its pulleys are paths of their own; MuJoCo divides the length of the \
                         branch {number} by {divisor}",
                        self.file.line(step)
                    ));
                    tracks.push(Track { name: format!("{name}_branch_{number}"), ..Track::default() });
                }
                other => return Err(self.file.wrong(step, format!("<{other}>: valid are site, geom and pulley"))),
            }
        }
        tracks.retain(|t| !t.points.is_empty());
        if let Some(short) = tracks.iter().find(|t| t.points.len() < 2) {
            return Err(self.file.wrong(node, format!("`{}` has one site only", short.name)));
        }
        if !between.is_empty() {
            return Err(self.file.wrong(node, format!("`{name}` ends with a geom; expected a site after it")));
        }
        self.model.paths.extend(tracks);
        Ok(())
    }
}

/// The least rotation that takes the axis z to a direction.
fn onto(direction: &Vector<3>) -> Option<Matrix3<f64>> {
    let z = direction.try_normalize(0.0)?;
    let axis = Vector::<3>::z().cross(&z);
    let angle = axis.norm().atan2(z.z);
    Some(if axis.norm() > 0.0 { about(&axis, angle) } else { about(&Vector::<3>::x(), angle) })
}
