//! Surfaces that are glued in all directions for ever (mesh tying), meshes of any kind on both sides.
//!
//! At the start every point of the slave that lies near the master is given a material point of it, and keeps its place
//! relative to that: `c = 0` (`joint`). By mortar with dual functions `ψ_k`,
//!
//! | symbol | meaning |
//! |---|---|
//! | `c_k = ∫ψ_k c / ∫ψ_k` | how far a node is from where it is held |
//! | `λ_k` | its traction, along the axes of space: a force `∫ψ_k λ_k·δc` |
//! | `(w/c)(Π(λ - s (λ - λ_0) - c c_k) - λ) = 0`, `Π(ζ) = ζ` | its equation, as of [`Contact`](crate::contact::Contact) |
//!
//! (Puso 2004; Popp, Gee & Wall 2010). At points `ψ_k` is one at its own point. Without a gap at the start the conditions are
//! linear in the displacements, whatever the strain.
//!
//! A node has no traction along an axis along which a support holds it, if a neighbour has one that may take its function:
//! nothing is then prescribed twice.

mod interaction;
mod joint;

use super::cover::{Nodes, Search};
use super::facing::Facing;
use super::no_surface;
use crate::body::{Body, BodyState, PlaceError};
use crate::contact_law::ContactLaw;
use crate::enforcement::Enforcement;
use crate::part::Part;
use crate::points::{Master, MasterProjection, MaterialPoint, Sampling, Site};
use crate::surface::{Local, Surface};
use joint::{Joint, MasterAt, MasterPoint, SlaveAt};
use signorini_contact::law::Tied;
use signorini_geometry::{Point, Vector};
use std::sync::OnceLock;

/// Two sides that are glued where they are near each other at the start.
pub struct Tie {
    pub name: String,
    slave: Part,
    master: Part,
    pub law: ContactLaw,
    sampled: Sampled,
    joints: Vec<Joint>,
    /// The area of each point or node, by the dual functions before supports take any.
    weight: Vec<f64>,
    /// For each axis the node that carries for a node, and the area of what it carries for.
    carrier: Vec<Vec<u32>>,
    carried: Vec<Vec<f64>>,
    /// Unknowns of the centre and the spin of a rigid master.
    rigid: [Option<u32>; 6],
    dimension: usize,
    linear: OnceLock<interaction::Lines>,
    is_linear: bool,
    /// What was found at the start.
    pub findings: TieFindings,
}

/// What a tie found at the start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TieFindings {
    /// Area of the slave, and of the part of it that is tied.
    pub area: f64,
    pub tied: f64,
    /// The largest distance of what is tied, the deepest penetration of it, and the distance up to which points are tied.
    pub farthest: f64,
    pub deepest: f64,
    pub within: f64,
    /// The least distance of what was tested; none where nothing faces the master.
    pub nearest: Option<f64>,
}

/// Where tractions are.
enum Sampled {
    /// At nodes of the slave faces, by mortar.
    Mortar { nodes: Nodes, search: Box<Search>, places: Vec<(usize, Local)> },
    /// At sites.
    Sites(Vec<Site>),
}

/// The distance up to which points are tied where none is stated, relative to the size of a face of the slave.
const NEAR: f64 = 0.1;
/// Distance that is rounding, relative to the size of the bodies.
const TOUCHES: f64 = 1e-12;

/// Both sides at the start.
struct Start<'a> {
    slave: (&'a Part, &'a dyn Body, &'a BodyState),
    master: (&'a Part, &'a dyn Body, &'a BodyState),
    met: &'a dyn Master,
}

impl Tie {
    /// Glues a slave that deforms to a master of any kind. `within` is the distance up to which points are tied; none takes a
    /// tenth of the size of a face of the slave. Without `sampling` by mortar, which requires a slave with faces and a master with
    /// faces or a rigid one.
    ///
    /// # Errors
    /// A slave that is rigid or without points, sides without faces for mortar, Nitsche's method, or nothing that is near enough.
    pub fn new(
        name: &str,
        slave: (Part, &dyn Body),
        master: (Part, &dyn Body),
        (sampling, enforcement): (Option<Sampling>, Enforcement),
        within: Option<f64>,
    ) -> Result<Self, PlaceError> {
        let unsuitable = |body: &dyn Body, message: &str| PlaceError::Unsuitable {
            body: body.name().to_string(),
            message: message.to_string(),
        };
        if enforcement.takes_stress() {
            return Err(unsuitable(slave.1, "a tie is not enforced by Nitsche's method"));
        }
        if slave.1.is_rigid() {
            return Err(unsuitable(slave.1, "the slave of a tie must deform"));
        }
        let states = [slave.1.start(), master.1.start()];
        let met = master.1.master(master.0.group.as_deref(), &states[1])?;
        met.prepare();
        let start = Start {
            slave: (&slave.0, slave.1, &states[0]),
            master: (&master.0, master.1, &states[1]),
            met: met.as_ref(),
        };
        let (sampled, stiffness, size) = start.sampled(sampling)?;
        let within = within.unwrap_or(NEAR * size);
        let count = stiffness.len();
        let body_size = slave.1.size().max(if master.1.is_rigid() { 0.0 } else { master.1.size() });
        let mut law = ContactLaw::new(enforcement, stiffness, vec![0.0; count]);
        law.friction = Some(Box::new(Tied));
        let is_plane = match &sampled {
            Sampled::Mortar { nodes, .. } => nodes.is_plane(),
            Sampled::Sites(sites) => {
                let unknowns = sites.iter().flat_map(|s| slave.1.placed(&states[0], s).functions);
                !unknowns.into_iter().any(|f| f.value.z != 0.0)
            }
        };
        law.in_plane = is_plane.then_some(0);
        let dimension = if is_plane { 2 } else { 3 };
        let mut out = Tie {
            name: name.to_string(),
            slave: slave.0.clone(),
            master: master.0.clone(),
            law,
            sampled,
            joints: Vec::new(),
            weight: vec![0.0; count],
            carrier: Vec::new(),
            carried: Vec::new(),
            rigid: [None; 6],
            dimension,
            linear: OnceLock::new(),
            is_linear: slave.1.is_linear() && (master.1.is_linear() || master.1.is_rigid()),
            findings: TieFindings { within, ..TieFindings::default() },
        };
        if let Sampled::Mortar { search, .. } = &mut out.sampled {
            search.reach = within;
        }
        out.find(&start, TOUCHES * body_size, None);
        if out.joints.is_empty() {
            let nearest =
                out.findings.nearest.map_or(String::new(), |d| format!(", the nearest point is {d:.4e} away"));
            let message = format!("nothing of it faces the other side within {within:.4e}{nearest}");
            return Err(unsuitable(slave.1, &message));
        }
        Ok(out)
    }

    /// Finds the joints. `held` tells which nodes give their function along which axis to a neighbour.
    fn find(&mut self, start: &Start<'_>, touches: f64, held: Option<&[Vec<bool>]>) {
        let (mut joints, weight, carrier) = self.joints_with(start, touches, &vec![false; self.weight.len()]);
        let mut found: Vec<(Vec<Joint>, Vec<f64>, Vec<u32>)> = Vec::new();
        for flags in held.unwrap_or_default() {
            found.push(self.joints_with(start, touches, flags));
        }
        if found.is_empty() {
            (self.carrier, self.carried) = (vec![carrier; self.dimension], vec![weight.clone(); self.dimension]);
        } else {
            for (k, joint) in joints.iter_mut().enumerate() {
                joint.shares.extend(found.iter_mut().map(|f| std::mem::take(&mut f.0[k].shares[0])));
            }
            self.carrier = found.iter_mut().map(|f| std::mem::take(&mut f.2)).collect();
            self.carried = found.into_iter().map(|f| f.1).collect();
        }
        self.law.areas = super::weights(&weight);
        self.weight = weight;
        self.joints = joints;
        self.linear = OnceLock::new();
        self.rigid = start.unknowns_of_rigid();
    }

    /// The joints with the area of each node, and the node that carries for it, where nodes give their functions away.
    fn joints_with(&mut self, start: &Start<'_>, touches: f64, held: &[bool]) -> (Vec<Joint>, Vec<f64>, Vec<u32>) {
        let count = self.weight.len();
        let mut carrier: Vec<u32> = (0..count as u32).collect();
        let mut findings = TieFindings { within: self.findings.within, ..TieFindings::default() };
        let mut weight = vec![0.0; count];
        let joints: Vec<Joint> = match &self.sampled {
            Sampled::Mortar { nodes, search, .. } => {
                let found = start.of_faces(nodes, search, held, touches, &mut findings);
                found.1.iter().for_each(|g| carrier[g[0] as usize] = g[1]);
                found.0
            }
            Sampled::Sites(sites) => {
                findings.area = sites.iter().map(|s| s.weight).sum();
                let of = |(k, site): (usize, &Site)| start.of_site((k, site), touches, &mut findings);
                sites.iter().enumerate().filter_map(of).collect()
            }
        };
        for (node, share) in joints.iter().flat_map(|j| &j.shares[0]) {
            weight[*node as usize] += share;
        }
        findings.tied = weight.iter().sum();
        self.findings = findings;
        (joints, weight, carrier)
    }
}

impl<'a> Start<'a> {
    /// Where tractions are, the scale of trials of each place, and the size of a face.
    fn sampled(&self, sampling: Option<Sampling>) -> Result<(Sampled, Vec<f64>, f64), PlaceError> {
        let (part, body, state) = self.slave;
        let group = part.group.as_deref();
        let surface = body.surface(group, state);
        let size = surface.as_ref().map(|surface| mean_size(surface.as_ref()));
        if let Some(sampling) = sampling {
            let sites = body.sites(group, sampling)?;
            let stiffness = sites.iter().map(|s| body.site_stiffness(s) / s.weight).collect();
            let count = sites.len().max(1) as f64;
            let spacing = body.size() / count.sqrt();
            return Ok((Sampled::Sites(sites), stiffness, size.unwrap_or(spacing)));
        }
        let surface = surface.ok_or_else(|| no_surface(body, part))?;
        let (other_part, other, other_state) = self.master;
        if !other.is_rigid() && other.surface(other_part.group.as_deref(), other_state).is_none() {
            return Err(no_surface(other, other_part));
        }
        let nodes = Nodes::new(surface.faces().0);
        let places = nodes.places();
        let stiffness = places.iter().map(|(face, _)| surface.stiffness(*face)).collect();
        let facing = Facing::new((part, body), surface.as_ref(), (other_part, other))?;
        let search = Search { reach: 0.0, extra: 0, facing, at_rest: true };
        Ok((Sampled::Mortar { nodes, search: Box::new(search), places }, stiffness, size.unwrap_or(0.0)))
    }

    fn unknowns_of_rigid(&self) -> [Option<u32>; 6] {
        if !self.master.1.is_rigid() {
            return [None; 6];
        }
        match self.met.nearest(&Point::<3>::zeros(), f64::INFINITY, None) {
            Some(MasterProjection::Rigid(foot)) => foot.unknowns,
            _ => [None; 6],
        }
    }

    /// The joints of faces by mortar, and which node carries for which that has none of its own.
    fn of_faces(
        &self,
        nodes: &Nodes,
        search: &Search,
        held: &[bool],
        touches: f64,
        findings: &mut TieFindings,
    ) -> (Vec<Joint>, Vec<[u32; 2]>) {
        let (_, body, state) = self.slave;
        let Some(slave) = body.surface(self.slave.0.group.as_deref(), state) else { return Default::default() };
        let master = self.master.1.surface(self.master.0.group.as_deref(), self.master.2);
        findings.area = nodes.whole(slave.as_ref(), &Facing::default(), &vec![false; held.len()]).weight.iter().sum();
        let near = |face: usize, s: &Local| {
            let x = slave.point(face, s).x;
            self.met.nearest(&x, f64::INFINITY, None).and_then(|met| met.gap(&x))
        };
        let cover = match &master {
            Some(master) => nodes.cut(slave.as_ref(), master.as_ref(), search, held),
            None => {
                let is_near = |face: usize, s: &Local| near(face, s).is_some_and(|(gap, _)| gap.abs() <= search.reach);
                nodes.near(slave.as_ref(), &search.facing, held, &is_near)
            }
        };
        let mut joints = Vec::new();
        for point in cover.points.iter().flatten() {
            let (held_at, normal, gap) = match (&master, &point.master) {
                (Some(_), Some(seen)) => (MasterAt::Face(seen.face, seen.s), seen.normal, seen.gap),
                (Some(_), None) => continue,
                (None, _) => {
                    let Some((gap, normal)) = near(point.face, &point.s) else { continue };
                    let xi = slave.point(point.face, &point.s).x.into();
                    (MasterAt::Rigid(MaterialPoint { patch: 0, xi }), normal, gap)
                }
            };
            findings.take(gap);
            let mut joint = Joint {
                slave: SlaveAt::Face(point.face, point.s),
                master: held_at,
                offset: Vector::<3>::zeros(),
                normal,
                is_flipped: false,
                shares: vec![point.shares.clone()],
            };
            if let (MasterAt::Face(face, s), Some(master)) = (held_at, &master) {
                let at = MasterPoint::of_face(&master.point(face, &s), master.dimension());
                if !joint.begin_at(&slave.point(point.face, &point.s).x, &at, touches) {
                    continue;
                }
            }
            joints.push(joint);
        }
        if joints.is_empty() && findings.nearest.is_none() {
            let places = nodes.places();
            let gaps = places.iter().filter_map(|(face, s)| near(*face, s)).map(|(gap, _)| gap.abs());
            findings.nearest = gaps.reduce(f64::min);
        }
        (joints, cover.given.iter().map(|g| [g.from, g.to]).collect())
    }

    /// The joint of a site that is near the master.
    fn of_site(&self, (k, site): (usize, &Site), touches: f64, findings: &mut TieFindings) -> Option<Joint> {
        let (_, body, state) = self.slave;
        let placed = body.placed(state, site);
        let met = self.met.nearest(&placed.x, f64::INFINITY, None)?;
        let (gap, normal) = met.gap(&placed.x)?;
        findings.nearest = Some(findings.nearest.map_or(gap.abs(), |d: f64| d.min(gap.abs())));
        if gap.abs() > findings.within || site.weight <= 0.0 {
            return None;
        }
        findings.take(gap);
        let master = match &met {
            MasterProjection::Rigid(_) => MasterAt::Rigid(MaterialPoint { patch: 0, xi: placed.x.into() }),
            MasterProjection::Foot(foot) | MasterProjection::Cut(foot) | MasterProjection::Along(foot, _) => {
                MasterAt::Material(foot.point)
            }
        };
        let shares = vec![vec![(k as u32, site.weight)]];
        let mut joint =
            Joint { slave: SlaveAt::Site(k), master, offset: Vector::<3>::zeros(), normal, is_flipped: false, shares };
        if let MasterAt::Material(point) = master {
            let at = MasterPoint::of_anchor(self.met.at(&point));
            joint.begin_at(&placed.x, &at, touches).then_some(())?;
        }
        Some(joint)
    }
}

impl Joint {
    /// Takes the place of the slave point from the master at the start; whether the master has tangents that tell it.
    fn begin_at(&mut self, x: &Point<3>, master: &MasterPoint, touches: f64) -> bool {
        let d = x - master.x;
        let along = master.tangents.map(|[a, b]| a.cross(&b).dot(&self.normal));
        self.is_flipped = along.is_some_and(|along| along < 0.0);
        if d.norm() <= touches {
            return along != Some(0.0);
        }
        let Some(offset) = master.coordinates(&d) else { return false };
        self.offset = offset;
        true
    }
}

impl TieFindings {
    /// Takes the gap of a point that is tied.
    fn take(&mut self, gap: f64) {
        self.farthest = self.farthest.max(gap.abs());
        self.deepest = self.deepest.max(-gap);
        self.nearest = Some(self.nearest.map_or(gap.abs(), |d| d.min(gap.abs())));
    }
}

/// The mean size of the faces of a surface.
fn mean_size(surface: &dyn Surface) -> f64 {
    let count = surface.face_count();
    (0..count).map(|face| surface.size(face)).sum::<f64>() / count.max(1) as f64
}
