//! The measures of a mortar contact in a state: weighted gaps and slips of the nodes, and the points they are means of.

use super::Mortar;
use super::across::Surfaces;
use super::axes::Axes;
use super::cover::{CoveredPoint, FacingPart};
use super::measured::{Apart, Matched, Measured, MetPoint, NodeMeasure};
use super::rigid::OnRigid;
use crate::body::{Body, PlaceError};
use crate::interaction::Bodies;
use crate::pair::Pair;
use crate::part::Part;
use crate::points::{Master, MaterialPoint};
use crate::surface::{Local, Surface};
use rayon::prelude::*;
use signorini_geometry::Vector;

/// Both sides in a state.
pub(super) struct Sides<'a> {
    pub slave: Box<dyn Surface + 'a>,
    pub master: Opposite<'a>,
    /// First unknowns of both bodies.
    pub first: [u32; 2],
    /// The rotation vector of a rigid master at the last state.
    since: Vector<3>,
    friction: bool,
    bodies: [&'a dyn Body; 2],
}

/// What the slave side meets.
pub(super) enum Opposite<'a> {
    Surface(Box<dyn Surface + 'a>),
    Rigid(Box<dyn Master + 'a>),
}

/// The same, as the points of a face see it.
pub(super) enum Facing<'a> {
    Surfaces(Surfaces<'a>),
    OnRigid(OnRigid<'a>),
}

impl<'a> Sides<'a> {
    /// # Errors
    /// A place that is no surface, or a master that cannot be touched.
    pub fn new(contact: &Mortar, at: Bodies<'a>) -> Result<Self, PlaceError> {
        let (slave, state) = at.side(&contact.slave);
        let (master, other) = at.side(&contact.master);
        let bodies = [slave, master];
        let slave_surface = slave.surface(contact.slave.group.as_deref(), state);
        let slave_surface = slave_surface.ok_or_else(|| super::no_surface(slave, &contact.slave))?;
        let group = contact.master.group.as_deref();
        let master = match master.surface(group, other) {
            Some(surface) => Opposite::Surface(surface),
            None => Opposite::Rigid(master.master(group, other)?),
        };
        let first = [at.first[contact.slave.body], at.first[contact.master.body]];
        let friction = contact.law.is_tangential();
        Ok(Sides { slave: slave_surface, master, first, since: contact.turned, friction, bodies })
    }

    /// The cosine between the normals of both sides, as the mean about each node.
    pub fn slants(&self, measured: &Measured, nodes: usize) -> Vec<f64> {
        let Opposite::Surface(master) = &self.master else { return vec![1.0; nodes] };
        let mut sums = vec![[0.0; 2]; nodes];
        for (point, met) in measured.points() {
            let [u, v] = master.point(met.on.patch as usize, &met.on.xi).tangents;
            let cosine = met.normal.dot(&u.cross(&v).normalize()).abs();
            for (node, share) in &point.shares {
                let sum = &mut sums[*node as usize];
                (sum[0], sum[1]) = (sum[0] + share.abs() * cosine, sum[1] + share.abs());
            }
        }
        sums.into_iter().map(|[sum, all]| if sum > 0.0 { sum / all } else { 1.0 }).collect()
    }

    pub fn facing(&self) -> Facing<'_> {
        let (slave, first) = (self.slave.as_ref(), self.first);
        match &self.master {
            Opposite::Surface(master) => Facing::Surfaces(Surfaces { slave, master: master.as_ref(), first }),
            Opposite::Rigid(master) => {
                let (since, friction) = (self.since, self.friction);
                Facing::OnRigid(OnRigid { slave, master: master.as_ref(), first, since, friction })
            }
        }
    }

    /// What sees the master now.
    fn cover(&self, contact: &Mortar) -> FacingPart {
        match &self.master {
            Opposite::Surface(master) => {
                contact.nodes.cut(self.slave.as_ref(), master.as_ref(), &contact.search, &contact.merged)
            }
            Opposite::Rigid(_) => contact.nodes.whole(self.slave.as_ref(), &contact.search.facing, &contact.merged),
        }
    }

    /// What all points meet.
    pub fn measured(&self, contact: &Mortar) -> Measured {
        let cover = self.cover(contact);
        let matched = if self.friction { &contact.matched[..] } else { &[] };
        match self.facing() {
            Facing::Surfaces(surfaces) => {
                let of = |point: &CoveredPoint| {
                    let on = |face: usize, xi: Local| MaterialPoint { patch: face as u32, xi };
                    point.master.map(|m| MetPoint { gap: m.gap, normal: m.normal, on: on(m.face, m.s) })
                };
                let met = cover.points.iter().map(|list| list.iter().map(of).collect()).collect();
                let apart = matched.par_iter().map(|m| Some(surfaces.apart(m))).collect();
                let (arrived, came) = self.arrived(contact, &cover).into_iter().unzip();
                Measured { cover, met, apart, arrived, came, pairs: Vec::new(), matched: Vec::new(), lost: 0 }
            }
            Facing::OnRigid(sides) => {
                let (pairs, lost) = sides.pairs(&cover);
                let of =
                    |pair: &Option<Pair>| pair.as_ref().map(|p| MetPoint { gap: p.gap, normal: p.normal, on: p.point });
                let met = pairs.iter().map(|list| list.iter().map(of).collect()).collect();
                let matched: Vec<Option<Pair>> = matched.par_iter().map(|m| sides.matched(m)).collect();
                let of =
                    |pair: &Option<Pair>| pair.as_ref().map(|pair| Apart { normal: pair.normal, vector: pair.elastic });
                let apart = matched.iter().map(of).collect();
                Measured { cover, met, apart, arrived: Vec::new(), came: Vec::new(), pairs, matched, lost }
            }
        }
    }

    /// The covered points of nodes that the last state did not match, such as those that the end of the master has slid over since:
    /// how far the material points that face each other now have come along each other.
    fn arrived(&self, contact: &Mortar, cover: &FacingPart) -> Vec<(Matched, Apart)> {
        let Some(departed) = contact.departed.as_ref().filter(|_| self.friction && contact.small.is_none()) else {
            return Vec::new();
        };
        let sum = |all: &mut dyn Iterator<Item = &(u32, f64)>| {
            let mut out = vec![0.0; contact.whole.len()];
            all.for_each(|(node, share)| out[*node as usize] += share);
            out
        };
        let points = || cover.points.iter().flatten();
        let now = sum(&mut points().filter(|p| p.master.is_some()).flat_map(|p| &p.shares));
        let before = sum(&mut contact.matched.iter().flat_map(|m| &m.shares));
        let is_new: Vec<bool> =
            (0..now.len()).map(|k| contact.sees(k, now[k]) && !contact.sees(k, before[k])).collect();
        if !is_new.contains(&true) {
            return Vec::new();
        }
        let surface = |k: usize, part: &Part| self.bodies[k].surface(part.group.as_deref(), &departed[k]);
        let (Some(slave), Some(master)) = (surface(0, &contact.slave), surface(1, &contact.master)) else {
            return Vec::new();
        };
        let of = |point: &CoveredPoint| {
            let shares: Vec<_> = point.shares.iter().filter(|(node, _)| is_new[*node as usize]).copied().collect();
            let met = point.master.filter(|_| !shares.is_empty())?;
            let apart = slave.point(point.face, &point.s).x - master.point(met.face, &met.s).x;
            let on = MaterialPoint { patch: met.face as u32, xi: met.s };
            let came = Apart { normal: -slave.normal(point.face, &point.s).normalize(), vector: -apart };
            Some((Matched { face: point.face, s: point.s, on, shares }, came))
        };
        points().filter_map(of).collect()
    }

    /// The rotation vector of a rigid master.
    pub fn turn(&self) -> Vector<3> {
        match &self.master {
            Opposite::Surface(_) => Vector::<3>::zeros(),
            Opposite::Rigid(master) => master.at(&MaterialPoint::default()).turning.unwrap_or_default().turn,
        }
    }
}

impl Mortar {
    /// Gaps and slips of all nodes, from what their points meet.
    pub(super) fn measures(&self, measured: &Measured) -> Vec<NodeMeasure> {
        let mut out = vec![NodeMeasure::default(); self.whole.len()];
        for (point, met) in measured.points() {
            for (node, share) in &point.shares {
                let own = &mut out[*node as usize];
                own.weight += share;
                own.gap += share * met.gap;
                own.normal += met.normal * *share;
            }
        }
        let matched = self.matched.iter().zip(&measured.apart).filter_map(|(m, apart)| Some((m, apart.as_ref()?)));
        for (matched, apart) in matched.chain(measured.arrived.iter().zip(&measured.came)) {
            for (node, share) in &matched.shares {
                let Some(axes) = self.axes(*node, &apart.normal) else { continue };
                let own = &mut out[*node as usize];
                own.matched += share;
                (0..2).for_each(|i| own.slip[i] += share * axes.e[i].dot(&apart.vector));
            }
        }
        for own in &mut out {
            let mean = if own.weight > 0.0 { own.weight } else { 1.0 };
            own.gap /= mean;
            own.normal /= mean;
            own.slip = own.slip.map(|s| if own.matched > 0.0 { s / own.matched } else { 0.0 });
        }
        out
    }

    /// The axes of friction of a node at a point with a normal.
    pub(super) fn axes(&self, node: u32, normal: &Vector<3>) -> Option<Axes> {
        if self.nodes.is_plane() {
            return Some(Axes::in_plane(normal, if self.is_across() { 0 } else { 1 }));
        }
        Axes::in_space(normal, &self.memory[node as usize].along)
    }

    /// Those along which friction is unknown, with their places in the traction of a node.
    pub(super) fn axes_of(&self, node: u32, normal: &Vector<3>) -> Vec<(usize, Vector<3>)> {
        let slots = &self.law.slots()[1..];
        let axes = if slots.is_empty() { None } else { self.axes(node, normal) };
        axes.map_or(Vec::new(), |axes| slots.iter().map(|slot| (*slot, axes.e[slot - 1])).collect())
    }
}
