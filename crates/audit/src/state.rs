//! Bodies and contacts as plain data: what is there, and where it is at a time with the forces that were told.
//!
//! Vectors have three components; a plane problem lies in z = 0, an axisymmetric one too, with x the radius and y the axis.

use crate::boundary::Boundary;
use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::rigid_shape::GapJet;
use signorini_geometry::{Aabb, Point, Vector};
use std::sync::Arc;

/// What does not change with time.
#[derive(Clone, Default)]
pub struct Setting {
    pub space: Space,
    pub bodies: Vec<Body>,
    pub contacts: Vec<Contact>,
}

/// In which directions forces and moments balance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Space {
    #[default]
    ThreeD,
    Plane,
    Axisymmetric,
}

impl Space {
    /// The directions along which the forces on a body sum to zero.
    pub fn directions(self) -> &'static [usize] {
        match self {
            Space::ThreeD => &[0, 1, 2],
            Space::Plane => &[0, 1],
            Space::Axisymmetric => &[1],
        }
    }

    /// The axes about which moments do.
    pub fn axes(self) -> &'static [usize] {
        match self {
            Space::ThreeD => &[0, 1, 2],
            Space::Plane => &[2],
            Space::Axisymmetric => &[],
        }
    }
}

#[derive(Clone)]
pub struct Body {
    pub name: String,
    pub form: Form,
    /// The force that rounding of its places leaves, about: none of a body that does not deform.
    pub rounding: f64,
}

#[derive(Clone)]
pub enum Form {
    Solid(Solid),
    Curve(Curve),
    Rigid(Rigid),
}

impl Form {
    /// The largest extent along the axes at the start; zero where there is no end.
    pub fn size(&self) -> f64 {
        let points = match self {
            Form::Solid(solid) => &solid.rest,
            Form::Curve(curve) => &curve.rest,
            Form::Rigid(rigid) => return rigid.size,
        };
        Aabb::around(points.iter().copied()).map_or(0.0, |bounds| bounds.size().max())
    }
}

/// A body that fills cells.
#[derive(Clone)]
pub struct Solid {
    /// Points before anything moves.
    pub rest: Vec<Point<3>>,
    /// Points around each cell: of a polygon, or 4 of a tetrahedron, 6 of a wedge, 8 of a hexahedron in space.
    pub cells: Vec<Vec<u32>>,
    pub boundary: Boundary,
    /// How many of these cells lie side by side in a cell of the solver.
    pub parts: f64,
    /// Whether cells are cut, so that what is shown of one may be much smaller than it.
    pub is_cut: bool,
    /// Strain beyond which the law or the theory is off; none where it holds for any.
    pub strain_limit: Option<f64>,
}

impl Solid {
    /// The size of the cell of the solver at a facet, and of what of it is shown there: the length of a facet in the plane, the
    /// side of a square of its area in space; of cut cells those of the largest.
    pub fn cell_at(&self, facet: usize) -> [f64; 2] {
        let part = if self.is_cut { self.boundary.largest } else { self.boundary.sides[facet] };
        [part * self.parts, part]
    }

    /// The size of the largest cell.
    pub fn largest_cell(&self) -> f64 {
        self.boundary.largest * self.parts
    }
}

/// A rope or beam.
#[derive(Clone)]
pub struct Curve {
    /// Points before anything moves, along the curve, and the pieces between them.
    pub rest: Vec<Point<3>>,
    pub pieces: Vec<[u32; 2]>,
    /// How many pieces lie in a cell of the solver.
    pub parts: f64,
    pub radius: f64,
    pub strain_limit: Option<f64>,
    /// Whether bending strains its section.
    pub bends: bool,
}

impl Curve {
    /// The length of the longest cell.
    pub fn longest_cell(&self) -> f64 {
        let length = |p: &[u32; 2]| (self.rest[p[1] as usize] - self.rest[p[0] as usize]).norm();
        self.parts * self.pieces.iter().map(length).fold(0.0, f64::max)
    }
}

/// A body that does not deform.
#[derive(Clone)]
pub struct Rigid {
    /// Gap of a point of space to the body where it starts.
    pub gap: Arc<dyn Fn(&Point<3>) -> GapJet<3> + Send + Sync>,
    /// Points on its surface at the start; none where it has no end.
    pub surface: Vec<Point<3>>,
    /// Balls that the body is made of, exactly: centre and radius.
    pub balls: Vec<(Point<3>, f64)>,
    pub centre: Point<3>,
    pub is_free: bool,
    /// Its extent; zero where it has no end.
    pub size: f64,
}

/// Two bodies that may touch, or one with itself.
#[derive(Clone)]
pub struct Contact {
    pub name: String,
    /// The one on which the forces that are told act, and the other.
    pub bodies: [usize; 2],
    pub law: Option<Law>,
    /// Whether the theory is that of slips much less than a cell.
    pub is_small_sliding: bool,
    pub carries: Carries,
    /// Penetration that was asked for.
    pub wanted_penetration: f64,
    /// Whether forces act at the places that are told, so that moments of them make sense.
    pub at_places: bool,
    pub surfaces: Surfaces,
}

/// What surfaces do besides keeping each other out and rubbing.
#[derive(Clone, Default)]
pub struct Surfaces {
    /// The largest traction against opening, and that along the surface without pressure.
    pub strength: [f64; 2],
    /// The largest gap across which they act.
    pub range: f64,
    /// The gap at a pressure of rough ones.
    pub gap_at: Option<Arc<dyn Fn(f64) -> f64 + Send + Sync>>,
    /// Depth that is worn off per pressure and slip.
    pub wear: f64,
}

impl Surfaces {
    /// Whether work goes into them besides that of friction.
    pub fn take_work(&self) -> bool {
        self.strength[0] > 0.0 || self.wear > 0.0 || self.gap_at.is_some()
    }
}

/// What pressure and friction of a contact are per.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carries {
    Force,
    LineLoad,
    Traction,
}

/// The most friction that there may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// The semi-axes of an ellipse, per pressure.
    PerPressure([f64; 2]),
    /// The same, where less acts below some velocity.
    AtMost([f64; 2]),
    /// Per area, whatever the pressure.
    Limit(f64),
}

/// Where everything is at a time, and the forces that were told.
#[derive(Clone, Default)]
pub struct State {
    pub time: f64,
    pub bodies: Vec<Placement>,
    /// Where the bodies were on their way to it, in states between which they moved straight on.
    pub way: Vec<Vec<Placement>>,
    /// Places of each contact that are tested.
    pub contacts: Vec<Vec<Touch>>,
    pub forces: Vec<Acting>,
    /// Energy that is stored in bodies; none where it is not told.
    pub stored: Option<f64>,
    /// Energy that friction took in the increment, as told, of each contact.
    pub dissipated: Vec<Option<f64>>,
    /// Energy that bodies took in the increment by plastic strain, as told.
    pub dissipated_in_bodies: f64,
    /// Whether bodies move with inertia: forces acted by their means in the increment.
    pub in_motion: bool,
}

/// Where a body is.
#[derive(Clone)]
pub enum Placement {
    /// Places of its points.
    Points(Vec<Point<3>>),
    /// Its motion since the start.
    Moved(RigidMotion),
}

impl Placement {
    /// The places of the points of a body that deforms.
    pub fn points(&self) -> &[Point<3>] {
        match self {
            Placement::Points(points) => points,
            Placement::Moved(_) => &[],
        }
    }

    /// The motion of a rigid body; that of one that deforms is none.
    pub fn motion(&self) -> RigidMotion {
        match self {
            Placement::Moved(motion) => *motion,
            Placement::Points(_) => RigidMotion::new(Vector::<3>::zeros(), Point::<3>::zeros(), Vector::<3>::zeros()),
        }
    }
}

/// A place of a contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Touch {
    /// Where the first body touches.
    pub x: Point<3>,
    /// Where the other one does.
    pub foot: Point<3>,
    /// Outward unit normal of the other body: pressure pushes the first along it.
    pub normal: Vector<3>,
    /// Area, length or number that it stands for.
    pub weight: f64,
    /// Part of it in contact.
    pub area: f64,
    pub is_closed: bool,
    pub slips: bool,
    pub pressure: f64,
    /// Friction on the first body, per weight.
    pub friction: Vector<3>,
    /// Where friction acts on a section that does not turn by itself, and how large it is there.
    pub on_centre_line: Option<(Point<3>, Vector<3>)>,
    /// Slip of the first body along the other in the increment.
    pub slip: Vector<3>,
    /// Depth that was worn off since the start. The foot is that on the worn surface.
    pub worn: f64,
}

impl Touch {
    /// The gap between the surfaces, worn as they are.
    pub fn gap(&self) -> f64 {
        (self.x - self.foot).dot(&self.normal)
    }

    /// Where the force acts, and the force on the first body.
    pub fn force(&self) -> (Point<3>, Vector<3>) {
        let (x, friction) = self.on_centre_line.unwrap_or((self.x, self.friction));
        (x, (self.normal * self.pressure + friction) * self.weight)
    }
}

/// What acts on a body beside its contacts.
#[derive(Clone, Debug, PartialEq)]
pub struct Acting {
    pub name: String,
    pub body: usize,
    pub force: Vector<3>,
    /// About the origin; none where it is not known.
    pub moment: Option<Vector<3>>,
    /// The work that it did in the increment, and how far that may be off as the force changed; none where it is not known.
    pub work: Option<[f64; 2]>,
    /// Whether its place moved as prescribed in the increment: the force may have been any on the way.
    pub drives: bool,
    /// Whether it is the reaction of a support, that is whatever holds its place.
    pub reacts: bool,
}
