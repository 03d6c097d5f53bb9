//! Which side of a contact is the slave.
//!
//! There is one contact condition for each node of the slave, and the master has to follow them all. It does where its faces are
//! the larger ones only if it is the stiffer body: forces that change from node to node, a distance `h/p` apart, move a body of
//! modulus `E` by about `h / (E p)` per pressure, so that the slave is to be the side with the smaller `E p / h`. On the other side
//! every second node may open, and pressures oscillate.

use super::{Kind, Numbers};
use crate::plan::planner::Planner;
use crate::problem::{self, Body, CaseError, Method, Shape};
use signorini_geometry::{Aabb, Point};
use signorini_mechanics::contact::Part;
use signorini_mechanics::surface::Surface;
use signorini_mechanics::{Sampling, System};

/// Two stiffnesses that differ by less are the same but for rounding.
const SAME: f64 = 1e-6;

/// The sides of a contact, slave first.
pub(super) struct Sides {
    pub parts: [Part; 2],
    /// Whether the slave is the second body of `between`.
    pub swapped: bool,
}

impl Planner<'_> {
    /// The slave and the master of a contact between two places.
    pub(super) fn sides(
        &self,
        key: &problem::Contact,
        on: [&String; 2],
        (numbers, system, kinds): (&Numbers, &System, &[Kind]),
    ) -> Result<Sides, CaseError> {
        let mut parts: [Part; 2] = [self.part(on[0], numbers)?, self.part(on[1], numbers)?];
        // A body of cells touches others with the sides of its grid too.
        for part in parts.iter_mut().filter(|_| on[0] != on[1]) {
            if matches!(kinds[part.body], Kind::Cells) && part.group.is_none() {
                part.group = Some(super::cells::SURFACE.to_string());
            }
        }
        for (part, on) in parts.iter().zip(on) {
            if part.group.is_some() {
                self.check_group(part, on, system)?;
            }
        }
        let swapped = match &key.slave {
            Some(slave) => self.is_second(slave, &parts, (on, system))?,
            None => self.is_better_swapped(key, &parts, (system, kinds)),
        };
        if swapped {
            parts.swap(0, 1);
        }
        Ok(Sides { parts, swapped })
    }

    /// Whether the slave that a case names is the second body of the contact.
    fn is_second(
        &self,
        slave: &String,
        parts: &[Part; 2],
        (on, system): ([&String; 2], &System),
    ) -> Result<bool, CaseError> {
        let wrong = |message: String, help: String| Err(self.problem.error(slave, message).help(help));
        let names = parts.each_ref().map(|part| system.bodies[part.body].name());
        let valid = format!("slave = \"{}\"  or  slave = \"{}\"", names[0], names[1]);
        if on[0] == on[1] || names[0] == names[1] {
            return wrong(
                "both sides are parts of one body".into(),
                "name the slave first, or leave `slave` out".into(),
            );
        }
        let Some(place) = names.iter().position(|name| *name == slave.trim()) else {
            return wrong(format!("the contact has no body `{}`", slave.trim()), valid);
        };
        let part = &parts[place];
        let body = system.bodies[part.body].as_ref();
        if body.sites(part.group.as_deref(), Sampling::Nodes).is_err() {
            let message = format!("`{}` has no points that could be tested: it can only be the master", body.name());
            return wrong(message, format!("slave = \"{}\"", names[1 - place]));
        }
        Ok(place == 1)
    }

    /// Whether the second side is the better slave.
    fn is_better_swapped(
        &self,
        key: &problem::Contact,
        parts: &[Part; 2],
        (system, kinds): (&System, &[Kind]),
    ) -> bool {
        let body = |part: &Part| system.bodies[part.body].as_ref();
        let is_edge = |part: &Part| body(part).curve(part.group.as_deref()).is_some();
        let is_disc = |part: &Part| match self.problem.bodies.get(body(part).name()) {
            Some(Body::Rigid(rigid)) => matches!(rigid.shape, Shape::Cylinder(_)),
            _ => false,
        };
        let has_points = |part: &Part| body(part).sites(part.group.as_deref(), Sampling::Nodes).is_ok();
        // A body without points of its own is touched by the other; and the faces of a body that deforms follow a rigid one better
        // than points on it follow them. Cells also one that is free, unless its points are asked for. A curve passes between the
        // points of a surface: its own are tested.
        let follows = match (&kinds[parts[0].body], &kinds[parts[1].body]) {
            (Kind::Solid | Kind::Cells, Kind::Curve { .. }) => !is_edge(&parts[0]),
            (Kind::Rigid { is_free, .. }, Kind::Cells) => !is_free || !matches!(key.method, Some(Method::Node(_))),
            (Kind::Rigid { is_free, .. }, Kind::Solid) => !is_free || is_disc(&parts[0]),
            _ => false,
        };
        if follows || !has_points(&parts[0]) {
            return has_points(&parts[1]);
        }
        // The slave wears, and carries the axes of friction: there the case chooses by its order. So it does of what is tied.
        let has_axes = matches!(&key.friction, Some(problem::Friction::Coulomb(law)) if law.axis.is_some());
        if key.wear.is_some() || has_axes || key.tied == Some(true) || parts[0].body == parts[1].body {
            return false;
        }
        let [first, second] = match (&kinds[parts[0].body], &kinds[parts[1].body]) {
            (Kind::Solid, Kind::Solid) => of_faces(system, parts),
            (Kind::Cells, Kind::Cells) if !matches!(key.method, Some(Method::Discs(_))) => {
                parts.each_ref().map(|part| of_points(system, part))
            }
            _ => return false,
        };
        first > (1.0 + SAME) * second
    }
}

/// `E p / h` of two surfaces of faces: the geometric means over those faces of each that the box of the other one reaches, over all
/// where they are apart.
fn of_faces(system: &System, parts: &[Part; 2]) -> [f64; 2] {
    let starts = parts.each_ref().map(|part| system.bodies[part.body].start());
    let surface = |k: usize| system.bodies[parts[k].body].surface(parts[k].group.as_deref(), &starts[k]);
    let (Some(first), Some(second)) = (surface(0), surface(1)) else { return [0.0; 2] };
    let boxes = [first.as_ref(), second.as_ref()].map(boxes);
    let around = boxes.each_ref().map(|list| list.iter().copied().reduce(|a, b| a.joined(&b)));
    let stiffness = |k: usize, surface: &dyn Surface| {
        let reached = |face: &usize| around[1 - k].is_some_and(|other| !boxes[k][*face].is_apart(&other));
        let all = 0..boxes[k].len();
        let near: Vec<usize> = all.clone().filter(reached).collect();
        let of_face = |face: usize| surface.stiffness(face) * surface.depth(face) / surface.size(face);
        geometric_mean(if near.is_empty() {
            all.map(of_face).collect()
        } else {
            near.into_iter().map(of_face).collect()
        })
    };
    [stiffness(0, first.as_ref()), stiffness(1, second.as_ref())]
}

/// The box around each face and its neighbours: its own, larger by half of its size on every side.
fn boxes(surface: &dyn Surface) -> Vec<Aabb<3>> {
    let of_face = |face: usize| {
        let own = Aabb::around(surface.vertices_at_rest(face)).expect("a face has vertices");
        let margin = Point::<3>::repeat(0.5 * surface.size(face));
        Aabb::new(own.min - margin, own.max + margin)
    };
    (0..surface.face_count()).map(of_face).collect()
}

/// `E p / h` of the surface of a body of cells.
fn of_points(system: &System, part: &Part) -> f64 {
    let body = system.bodies[part.body].as_ref();
    let sites = body.sites(part.group.as_deref(), Sampling::GaussPoints).unwrap_or_default();
    let weighted = sites.iter().filter(|site| site.weight > 0.0);
    geometric_mean(weighted.map(|site| body.site_stiffness(site) / site.weight).collect())
}

fn geometric_mean(list: Vec<f64>) -> f64 {
    let count = list.len().max(1) as f64;
    (list.into_iter().map(f64::ln).sum::<f64>() / count).exp()
}
