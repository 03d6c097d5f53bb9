//! Rigid bodies: at rest, moved as prescribed, or free.
//!
//! The configuration is the position of the centre and a unit quaternion (w, x, y, z); the unknowns of a free body are
//! three displacements of the centre and three spins, `R ← exp(θ) R`. Derivatives with respect to spins are the symmetric
//! second derivatives along geodesics; with a residual `r` the derivative of its spin components is that less `½ r ×`.

use crate::body::{
    Body, BodyError, BodyFields, BodyState, BoxOfMaterial, Carried, Constitution, Constraint, ContactSides,
    Contribution, Elimination, Hold, Kinematics, Load, PlaceError, Slack,
};
use crate::dynamics::{Inertial, Mass, SpinInertia};
use crate::pair::{any_tangent, axis};
use crate::points::{
    Anchor, Function, Master, MasterProjection, MaterialPoint, Order, RigidFoot, Sampling, SecondDerivative, Site,
    SlavePoint, Turning,
};
use crate::rotation;
use nalgebra::{Quaternion, Rotation3, UnitQuaternion};
use signorini_geometry::polyhedra::Placed;
use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::rigid_shape::{GapJet, RigidShape};
use signorini_geometry::{Looking, Matrix, Point, Vector};
use std::sync::Arc;

/// A motion by time.
pub type PrescribedMotion = Arc<dyn Fn(f64) -> RigidMotion + Send + Sync>;

/// How a rigid body moves.
#[derive(Clone)]
pub enum Motion {
    /// As given, or not at all.
    Prescribed(PrescribedMotion),
    /// Freely in space, or in the plane along x and y and about z.
    Free { plane: bool },
    /// Freely along y, the axis of a body of revolution.
    FreeAlongAxis,
}

/// A point of a rigid body that is tested for contact, or a ball about it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidSite {
    /// In the axes of the body.
    pub x: Point<3>,
    pub outward: Option<Vector<3>>,
    pub radius: f64,
    /// The area that it stands for.
    pub weight: f64,
}

/// What a free body resists to acceleration, and how fast it starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidMass {
    pub mass: f64,
    /// Moments of inertia about the centre, which is the centre of mass, along the axes of space as the body starts.
    pub inertia: Matrix<3>,
    /// Velocity of the centre, and angular velocity, at the start.
    pub velocity: Vector<3>,
    pub angular_velocity: Vector<3>,
}

/// A rigid body.
#[derive(Clone)]
pub struct RigidBody {
    pub name: String,
    pub shape: Arc<dyn RigidShape>,
    pub motion: Motion,
    /// The point that loads act on, and about which the body turns.
    pub centre: Point<3>,
    /// Its points that are tested for contact; none for a body that is only ever touched by others.
    pub sites: Vec<RigidSite>,
    pub size: f64,
    /// None of a body that only rests.
    pub mass: Option<RigidMass>,
}

/// Position and rotation of a rigid body.
#[derive(Clone, Copy, Debug)]
pub struct Pose {
    pub centre: Point<3>,
    pub rotation: UnitQuaternion<f64>,
    /// The rotation vector since the start, with the whole turns that bring it nearest to the one before.
    pub turn: Vector<3>,
    /// The rotation vectors of all motions since the start, summed: whole turns included, about whatever axes.
    pub turned: Vector<3>,
}

impl Pose {
    /// The pose that a state tells.
    pub fn of(state: &BodyState) -> Self {
        let (c, turn) = (&state.configuration, &state.internal);
        Pose {
            centre: Point::<3>::new(c[0], c[1], c[2]),
            rotation: UnitQuaternion::new_normalize(Quaternion::new(c[3], c[4], c[5], c[6])),
            turn: Vector::<3>::from_column_slice(&turn[..3]),
            turned: Vector::<3>::from_column_slice(&turn[turn.len() - 3..]),
        }
    }

    pub(crate) fn state(&self) -> BodyState {
        let q = self.rotation.quaternion();
        let configuration = vec![self.centre[0], self.centre[1], self.centre[2], q.w, q.i, q.j, q.k];
        BodyState { configuration, internal: [self.turn.as_slice(), self.turned.as_slice()].concat() }
    }

    /// The pose after a displacement of the centre and a turn.
    pub(crate) fn moved(&self, displacement: &Vector<3>, turn: &Vector<3>) -> Pose {
        let rotation = UnitQuaternion::from_scaled_axis(*turn) * self.rotation;
        let turned = self.turned + turn;
        let turn = rotation::unwrapped(&rotation, &(self.turn + turn));
        Pose { centre: self.centre + displacement, rotation, turn, turned }
    }

    /// The rotation as a matrix.
    pub fn matrix(&self) -> Matrix<3> {
        self.rotation.to_rotation_matrix().into_inner()
    }
}

impl RigidBody {
    /// Number of an unknown by its component: 0..3 displacements, 3..6 spins.
    fn unknown(&self, component: usize) -> Option<u32> {
        match self.motion {
            Motion::Prescribed(_) => None,
            Motion::FreeAlongAxis => (component == 1).then_some(0),
            Motion::Free { plane: false } => Some(component as u32),
            Motion::Free { plane: true } => [Some(0), Some(1), None, None, None, Some(2)][component],
        }
    }

    /// The components that move, with their unknowns.
    fn components(&self) -> impl Iterator<Item = (usize, u32)> + '_ {
        (0..6).filter_map(|c| Some((c, self.unknown(c)?)))
    }

    /// The motion since the start.
    pub fn moved(&self, state: &BodyState) -> RigidMotion {
        let pose = Pose::of(state);
        let rotation = pose.matrix();
        RigidMotion { rotation, translation: pose.centre - rotation * self.centre, turn: pose.turn }
    }

    /// Functions of a point at `arm` from the centre, with its second derivatives.
    fn functions(&self, arm: &Vector<3>) -> (Vec<Function>, Vec<Function>, Vec<SecondDerivative>) {
        let (mut functions, mut spin, mut bends) = (Vec::new(), Vec::new(), Vec::new());
        for (c, unknown) in self.components() {
            let e = axis(c % 3);
            let value = if c < 3 { e } else { e.cross(arm) };
            functions.push(Function { unknown, value, ..Function::default() });
            if c < 3 {
                continue;
            }
            spin.push(Function { unknown, value: e, ..Function::default() });
            for (d, other) in self.components().filter(|(d, _)| *d >= c) {
                let f = axis(d % 3);
                let value = (e.cross(&f.cross(arm)) + f.cross(&e.cross(arm))) * 0.5;
                bends.push(SecondDerivative { unknowns: [unknown, other], value });
            }
        }
        (functions, spin, bends)
    }

    fn no_groups(&self, on: Option<&str>) -> Result<(), PlaceError> {
        match on {
            None | Some("boundary") => Ok(()),
            Some(group) => Err(PlaceError::Unknown {
                body: self.name.clone(),
                group: group.to_string(),
                known: vec!["boundary".to_string()],
            }),
        }
    }
}

impl Body for RigidBody {
    fn name(&self) -> &str {
        &self.name
    }

    fn unknowns(&self) -> usize {
        self.components().count()
    }

    fn start(&self) -> BodyState {
        let none = Vector::<3>::zeros();
        Pose { centre: self.centre, rotation: UnitQuaternion::identity(), turn: none, turned: none }.state()
    }

    fn advance(&self, state: &BodyState, step: &[f64], share: f64) -> BodyState {
        let pose = Pose::of(state);
        let mut parts = [0.0; 6];
        for (c, unknown) in self.components() {
            parts[c] = step[unknown as usize] * share;
        }
        if parts == [0.0; 6] {
            return state.clone();
        }
        let [displacement, spin] = [0, 3].map(|k| Vector::<3>::new(parts[k], parts[k + 1], parts[k + 2]));
        pose.moved(&displacement, &spin).state()
    }

    fn internal(&self, _: &BodyState, _: Order, _: &mut Contribution) -> Result<f64, BodyError> {
        Ok(0.0)
    }

    fn hold(&self, on: Option<&str>, hold: &Hold<'_>, state: &BodyState) -> Result<Vec<Constraint>, PlaceError> {
        hold.check_components(&self.name)?;
        self.no_groups(on)?;
        if matches!(self.motion, Motion::Prescribed(_)) {
            let message = "its motion is prescribed, so it has no free unknowns for a support".to_string();
            return Err(PlaceError::Unsuitable { body: self.name.clone(), message });
        }
        let pose = Pose::of(state);
        let rotation = pose.turn;
        let turn = rotation::of_spin(&rotation);
        let mut out = Vec::new();
        for i in 0..3 {
            if let (Some(field), Some(unknown)) = (hold.displacement[i], self.unknown(i)) {
                let violation = pose.centre[i] - self.centre[i] - field(&self.centre);
                out.push(Constraint::of_component(vec![(unknown, 1.0)], violation, i));
            }
            if let (Some(field), Some(_)) = (hold.rotation[i], self.unknown(3 + i)) {
                let terms = (3..6).filter_map(|c| Some((self.unknown(c)?, turn[(i, c - 3)])));
                let terms = terms.filter(|(_, v)| *v != 0.0).collect();
                out.push(Constraint::of_component(terms, rotation[i] - field(&self.centre), 3 + i));
            }
        }
        Ok(out)
    }

    fn load(
        &self,
        on: Option<&str>,
        load: &Load<'_>,
        state: &BodyState,
        order: Order,
        out: &mut Contribution,
    ) -> Result<(), PlaceError> {
        self.no_groups(on)?;
        let pose = Pose::of(state);
        let add = |c: usize, value: f64, out: &mut Contribution| {
            if let Some(unknown) = self.unknown(c) {
                out.forces[unknown as usize] -= value;
            }
        };
        match load {
            Load::Force(force) => (0..3).for_each(|i| add(i, force[i], out)),
            Load::Moment(moment) | Load::FollowerMoment(moment) => {
                let follows = matches!(load, Load::FollowerMoment(_));
                let moment = if follows { pose.matrix() * moment } else { *moment };
                (0..3).for_each(|i| add(3 + i, moment[i], out));
                if order == Order::Second {
                    // Derivative of -m, and the half that makes it symmetric where the residual vanishes.
                    let share = if follows { 0.5 } else { -0.5 };
                    let k = moment.cross_matrix() * share;
                    let spins: Vec<(usize, u32)> = self.components().filter(|(c, _)| *c >= 3).collect();
                    let unknowns: Vec<u32> = spins.iter().map(|s| s.1).collect();
                    let values: Vec<f64> =
                        spins.iter().flat_map(|r| spins.iter().map(move |c| k[(r.0 - 3, c.0 - 3)])).collect();
                    out.add_block(&unknowns, &values);
                }
            }
            Load::Springs(stiffness) => {
                let moved = pose.centre - self.centre;
                for i in 0..3 {
                    add(i, -stiffness[i] * moved[i], out);
                    if let (Some(unknown), Order::Second) = (self.unknown(i), order) {
                        out.add_block(&[unknown], &[stiffness[i]]);
                    }
                }
            }
            _ => {
                let message = "a rigid body has forces, moments and springs only".to_string();
                return Err(PlaceError::Unsuitable { body: self.name.clone(), message });
            }
        }
        Ok(())
    }

    fn sites(&self, on: Option<&str>, _: Sampling) -> Result<Vec<Site>, PlaceError> {
        self.no_groups(on)?;
        if self.sites.is_empty() {
            let message = "a rigid body of this shape has no slave points; name the other body first, which makes it \
                           the slave"
                .to_string();
            return Err(PlaceError::Unsuitable { body: self.name.clone(), message });
        }
        let site = |(k, s): (usize, &RigidSite)| Site { patch: k as u32, xi: [0.0; 2], weight: s.weight };
        Ok(self.sites.iter().enumerate().map(site).collect())
    }

    fn placed(&self, state: &BodyState, site: &Site) -> SlavePoint {
        let pose = Pose::of(state);
        let frame = pose.matrix();
        let own = &match (self.sites.get(site.patch as usize), self.shape.features()) {
            (None, Some(features)) => {
                let x = features.position(features.feature(site.patch as usize - self.sites.len()));
                RigidSite { x, outward: None, radius: 0.0, weight: site.weight }
            }
            _ => self.sites[site.patch as usize],
        };
        let arm = frame * (own.x - self.centre);
        let (functions, spin, bends) = self.functions(&arm);
        SlavePoint {
            x: pose.centre + arm,
            outward: own.outward.map(|n| frame * n),
            averaged: None,
            rests: site.patch as usize >= self.sites.len(),
            tangent: None,
            radius: own.radius,
            turn: Some(pose.turn),
            functions,
            spin,
            spin_bends: Vec::new(),
            frame,
            bends,
        }
    }

    fn master<'a>(&'a self, on: Option<&str>, state: &'a BodyState) -> Result<Box<dyn Master + 'a>, PlaceError> {
        self.no_groups(on)?;
        Ok(Box::new(RigidMaster { body: self, pose: Pose::of(state) }))
    }

    fn site_stiffness(&self, _: &Site) -> f64 {
        f64::INFINITY
    }

    fn rigid_modes(&self, state: &BodyState) -> [Vec<f64>; 6] {
        let centre = Pose::of(state).centre;
        std::array::from_fn(|mode| {
            let mut out = vec![0.0; self.unknowns()];
            for (c, unknown) in self.components() {
                let e = axis(mode % 3);
                let moves = if mode < 3 { e } else { e.cross(&centre) };
                let turns = if mode < 3 { Vector::<3>::zeros() } else { e };
                out[unknown as usize] = if c < 3 { moves[c] } else { turns[c - 3] };
            }
            out
        })
    }

    fn size(&self) -> f64 {
        self.size
    }

    fn fields(&self, _: &BodyState) -> BodyFields {
        BodyFields::default()
    }
}

impl Kinematics for RigidBody {
    fn prescribe(&self, time: f64, state: &mut BodyState) {
        if let Motion::Prescribed(motion) = &self.motion {
            let motion = motion(time);
            let rotation = Rotation3::from_matrix_unchecked(motion.rotation);
            let rotation = UnitQuaternion::from_rotation_matrix(&rotation);
            let (centre, turn) = (motion.point(&self.centre), motion.turn);
            *state = Pose { centre, rotation, turn, turned: turn }.state();
        }
    }

    fn between(&self, from: &BodyState, to: &BodyState, share: f64) -> BodyState {
        let [from, to] = [from, to].map(Pose::of);
        let turn = rotation::unwrapped(&(to.rotation * from.rotation.inverse()), &(to.turned - from.turned));
        from.moved(&((to.centre - from.centre) * share), &(turn * share)).state()
    }

    fn is_rigid(&self) -> bool {
        true
    }

    fn spins(&self) -> Vec<[u32; 3]> {
        match self.motion {
            Motion::Free { plane: false } => vec![[3, 4, 5]],
            _ => Vec::new(),
        }
    }
}

impl crate::heat::Thermal for RigidBody {}

impl Inertial for RigidBody {
    fn mass(&self, _: &[Option<&str>]) -> Result<Option<Mass>, PlaceError> {
        let Some(own) = &self.mass else { return Ok(None) };
        let moves = self.components().filter(|(c, _)| *c < 3);
        let mut blocks: Vec<_> = moves.map(|(_, unknown)| (vec![unknown], vec![own.mass])).collect();
        let mut spins = Vec::new();
        match self.motion {
            Motion::Free { plane: false } => {
                spins.push(SpinInertia { unknowns: [3, 4, 5], inertia: own.inertia });
            }
            // About one axis a rotation is a number like a displacement.
            Motion::Free { plane: true } => blocks.push((vec![2], vec![own.inertia[(2, 2)]])),
            Motion::FreeAlongAxis | Motion::Prescribed(_) => {}
        }
        Ok(Some(Mass { blocks, spins }))
    }

    fn orientation(&self, state: &BodyState, _: [u32; 3]) -> Matrix<3> {
        Pose::of(state).matrix()
    }

    fn initial_velocity(&self) -> Vec<f64> {
        let mut out = vec![0.0; self.unknowns()];
        if let Some(own) = &self.mass {
            for (c, unknown) in self.components() {
                out[unknown as usize] = if c < 3 { own.velocity[c] } else { own.angular_velocity[c - 3] };
            }
        }
        out
    }
}

impl Elimination for RigidBody {}

impl ContactSides for RigidBody {
    fn polyhedron<'a>(&'a self, state: &BodyState) -> Option<Placed<'a>> {
        // A body without sites is a hole: other bodies are within it.
        let features = self.shape.features().filter(|_| !self.sites.is_empty())?;
        let pose = Pose::of(state);
        Some(Placed { features, rotation: pose.matrix(), origin: self.centre, centre: pose.centre })
    }

    fn carried(&self, state: &BodyState, x: &Point<3>) -> Option<Carried> {
        let pose = Pose::of(state);
        let (functions, spin, bends) = self.functions(&(x - pose.centre));
        Some(Carried { functions, spin, bends, frame: pose.matrix() })
    }
}

impl Slack for RigidBody {}

impl BoxOfMaterial for RigidBody {}

impl Constitution for RigidBody {}

struct RigidMaster<'a> {
    body: &'a RigidBody,
    pose: Pose,
}

impl RigidMaster<'_> {
    /// A place of the shape that the point `own`, in the axes of the body, sees with a gap.
    fn met(&self, own: &Point<3>, rotation: &Matrix<3>, jet: GapJet<3>) -> MasterProjection {
        let foot = own - jet.normal * jet.gap;
        MasterProjection::Rigid(Box::new(RigidFoot {
            point: MaterialPoint { patch: 0, xi: foot.into() },
            jet: GapJet {
                gap: jet.gap,
                normal: rotation * jet.normal,
                hessian: rotation * jet.hessian * rotation.transpose(),
            },
            shape: Arc::clone(&self.body.shape),
            origin: self.body.centre,
            centre: self.pose.centre,
            rotation: *rotation,
            unknowns: std::array::from_fn(|c| self.body.unknown(c)),
        }))
    }

    /// A point in the axes of the body, and the rotation of these.
    fn seen(&self, x: &Point<3>) -> (Point<3>, Matrix<3>) {
        let rotation = self.pose.matrix();
        (self.body.centre + rotation.transpose() * (x - self.pose.centre), rotation)
    }
}

impl Master for RigidMaster<'_> {
    fn nearest(&self, x: &Point<3>, reach: f64, _: Option<&Site>) -> Option<MasterProjection> {
        let (own, rotation) = self.seen(x);
        let jet = self.body.shape.gap(&own);
        (jet.gap.abs() <= reach).then(|| self.met(&own, &rotation, jet))
    }

    fn facing(&self, x: &Point<3>, looking: &Looking) -> Option<MasterProjection> {
        let (own, rotation) = self.seen(x);
        let looking = Looking { outward: rotation.transpose() * looking.outward, ..*looking };
        self.body.shape.facing(&own, &looking).map(|jet| self.met(&own, &rotation, jet))
    }

    fn gap(&self, x: &Point<3>, reach: f64, _: Option<&Site>) -> Option<f64> {
        let gap = self.body.shape.gap(&self.seen(x).0).gap;
        (gap.abs() <= reach).then_some(gap)
    }

    fn places(&self, x: &Point<3>) -> Vec<MasterProjection> {
        let (own, rotation) = self.seen(x);
        let around = self.body.shape.around(&own);
        let all = std::iter::once(self.body.shape.gap(&own)).chain(around);
        all.map(|jet| self.met(&own, &rotation, jet)).collect()
    }

    fn at(&self, point: &MaterialPoint) -> Anchor {
        let own = Point::<3>::from(point.xi);
        let frame = self.pose.matrix();
        let normal = self.body.shape.gap(&own).normal;
        Anchor {
            x: self.pose.centre + frame * (own - self.body.centre),
            tangent: frame * any_tangent(&normal),
            across: None,
            functions: Vec::new(),
            spin: Vec::new(),
            frame,
            turning: Some(Turning { turn: self.pose.turn, about: self.pose.centre, normal: frame * normal }),
        }
    }
}
