//! The measures of a mortar contact in a state: weighted gaps and slips of the nodes, and the pairs they are made of.

use super::Mortar;
use super::axes::Axes;
use super::cover::{Cover, CoveredPoint};
use crate::body::PlaceError;
use crate::interaction::Bodies;
use crate::pair::{AxisChoice, Encounter, NoPair, Pair, Stuck};
use crate::points::{Anchor, Master, MaterialPoint, Met, Order};
use crate::surface::{Local, Surface};
use signorini_geometry::Vector;

/// A point of the slave side with the point of the master that it was matched with at the last state.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Matched {
    pub face: usize,
    pub s: Local,
    /// Of a surface the face and its coordinates, of a rigid body the point in its own axes.
    pub on: MaterialPoint,
    pub shares: Vec<(u32, f64)>,
}

/// Both sides in a state.
pub(super) struct Sides<'a> {
    pub slave: Box<dyn Surface + 'a>,
    pub master: Opposite<'a>,
    /// First unknowns of both bodies.
    pub first: [u32; 2],
    /// The rotation vector of a rigid master at the last state.
    since: Vector<3>,
}

/// What the slave side meets.
pub(super) enum Opposite<'a> {
    Surface(Box<dyn Surface + 'a>),
    Rigid(Box<dyn Master + 'a>),
}

/// What separates a matched pair now, with the unknowns that change it.
#[derive(Clone)]
pub(super) struct Separation {
    pub unknowns: Vec<u32>,
    pub normal: Vector<3>,
    pub d_normal: Vec<Vector<3>>,
    pub vector: Vector<3>,
    pub d_vector: Vec<Vector<3>>,
}

/// A node in a state: means over the area of its dual function.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct NodeMeasure {
    /// Area of the part that sees the master, and of the part that did at the last state.
    pub weight: f64,
    pub matched: f64,
    pub gap: f64,
    pub slip: [f64; 2],
    pub normal: Vector<3>,
}

impl<'a> Sides<'a> {
    /// # Errors
    /// A place that is no surface, or a master that cannot be touched.
    pub fn new(contact: &Mortar, at: Bodies<'a>) -> Result<Self, PlaceError> {
        let (slave, state) = at.side(&contact.slave);
        let (master, other) = at.side(&contact.master);
        let slave_surface = slave.surface(contact.slave.group.as_deref(), state);
        let slave_surface = slave_surface.ok_or_else(|| super::no_surface(slave, &contact.slave))?;
        let group = contact.master.group.as_deref();
        let master = match master.surface(group, other) {
            Some(surface) => Opposite::Surface(surface),
            None => Opposite::Rigid(master.master(group, other)?),
        };
        let first = [at.first[contact.slave.body], at.first[contact.master.body]];
        Ok(Sides { slave: slave_surface, master, first, since: contact.turned })
    }

    /// What sees the master now.
    pub fn cover(&self, contact: &Mortar) -> Cover {
        match &self.master {
            Opposite::Surface(master) => {
                contact.nodes.cut(self.slave.as_ref(), master.as_ref(), &contact.search, &contact.folded)
            }
            Opposite::Rigid(_) => contact.nodes.whole(self.slave.as_ref(), &contact.search.facing, &contact.folded),
        }
    }

    /// The pair of a point; none where a rigid master is not met.
    ///
    /// # Errors
    /// Why there is no pair.
    pub fn pair(&self, point: &CoveredPoint, friction: bool, order: Order) -> Result<Pair, NoPair> {
        let slave = self.slave.placed(point.face, &point.s, friction && order == Order::Second);
        let met = match (&self.master, &point.master) {
            (Opposite::Surface(surface), Some((face, at))) => Met::Cut(Box::new(surface.met(*face, at))),
            (Opposite::Rigid(master), _) => {
                master.nearest(&slave.x, f64::INFINITY, None).ok_or(NoPair::NoCoordinates)?
            }
            _ => return Err(NoPair::NoCoordinates),
        };
        let axis = AxisChoice::Material;
        let since = [self.since; 2];
        Encounter { slave: &slave, met: &met, first: self.first, stuck: None, since, friction, axis }.measure(order)
    }

    /// The rotation vector of a rigid master.
    pub fn turn(&self) -> Vector<3> {
        match &self.master {
            Opposite::Surface(_) => Vector::<3>::zeros(),
            Opposite::Rigid(master) => master.at(&MaterialPoint::default()).turning.unwrap_or_default().turn,
        }
    }

    /// How far a matched pair is apart now.
    ///
    /// # Errors
    /// Why there is no pair.
    pub fn separation(&self, matched: &Matched) -> Result<Separation, NoPair> {
        let slave = self.slave.placed(matched.face, &matched.s, false);
        match &self.master {
            Opposite::Surface(surface) => {
                let averaged = slave.averaged.as_ref().ok_or(NoPair::NoCoordinates)?;
                let length = averaged.vector.norm();
                let normal = -averaged.vector / length;
                let foot = surface.met(matched.on.patch as usize, &matched.on.xi);
                let zero = Vector::<3>::zeros();
                let mut out = Separation {
                    unknowns: Vec::new(),
                    normal,
                    d_normal: Vec::new(),
                    vector: slave.x - foot.jet.x,
                    d_vector: Vec::new(),
                };
                let mut add = |unknown: u32, dn: Vector<3>, dv: Vector<3>| {
                    out.unknowns.push(unknown);
                    out.d_normal.push(dn);
                    out.d_vector.push(dv);
                };
                slave.functions.iter().for_each(|f| add(self.first[0] + f.unknown, zero, f.value));
                for f in &averaged.functions {
                    let dn = (normal * normal.dot(&f.value) - f.value) / length;
                    add(self.first[0] + f.unknown, dn, zero);
                }
                foot.functions.iter().for_each(|f| add(self.first[1] + f.unknown, zero, -f.value));
                Ok(out)
            }
            Opposite::Rigid(master) => {
                let met = master.nearest(&slave.x, f64::INFINITY, None).ok_or(NoPair::NoCoordinates)?;
                let stuck = Stuck { point: matched.on, ..Stuck::default() };
                let anchor: Anchor = master.at(&matched.on);
                let encounter = Encounter {
                    slave: &slave,
                    met: &met,
                    first: self.first,
                    stuck: Some((&stuck, &anchor)),
                    since: [self.since; 2],
                    friction: true,
                    axis: AxisChoice::Material,
                };
                let pair = encounter.measure(Order::First)?;
                Ok(Separation {
                    unknowns: pair.unknowns,
                    normal: pair.normal,
                    d_normal: pair.d_normal,
                    vector: pair.elastic,
                    d_vector: pair.d_elastic,
                })
            }
        }
    }
}

impl Mortar {
    /// Gaps and slips of all nodes, from the pairs of all points and the matched ones.
    pub(super) fn measures(
        &self,
        cover: &Cover,
        pairs: &[Vec<Option<Pair>>],
        separations: &[Option<Separation>],
    ) -> Vec<NodeMeasure> {
        let mut out = vec![NodeMeasure::default(); self.whole.len()];
        for (point, pair) in cover.points.iter().flatten().zip(pairs.iter().flatten()) {
            let Some(pair) = pair else { continue };
            for (node, share) in &point.shares {
                let own = &mut out[*node as usize];
                own.weight += share;
                own.gap += share * pair.gap;
                own.normal += pair.normal * *share;
            }
        }
        for (matched, apart) in self.matched.iter().zip(separations) {
            let Some(apart) = apart else { continue };
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
}
