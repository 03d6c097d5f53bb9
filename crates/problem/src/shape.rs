//! Shapes of rigid bodies. Those with a closed form have their keys here, with what the keys say of where the shape stands,
//! and how they are read: a new one is its file in geometry, and its keys with one arm of [`Shape::closed_form`] here.

use super::{CaseError, Components, List, MeshFile, Problem, TriangleArrays, Value};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use signorini_geometry::Vector;
use signorini_geometry::rigid_shape::{self, Profile, RigidShape};
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// The body below a height, an expression of x and y.
    Height(Value),
    /// A half space bounded by a plane.
    Plane(Plane),
    /// A sphere; a circle in the plane.
    Sphere(Sphere),
    /// A box with flat sides, edges and corners; a rectangle in the plane.
    Box(BoxShape),
    /// An infinite circular cylinder.
    Cylinder(Cylinder),
    /// An infinite circular cone.
    Cone(Cone),
    /// An ellipsoid with semi-axes along the coordinate axes.
    Ellipsoid(Ellipsoid),
    /// A torus.
    Torus(Torus),
    /// A paraboloid of revolution.
    Paraboloid(Paraboloid),
    /// A body of revolution with a smooth profile.
    Revolution(Revolution),
    /// NURBS surfaces from a JSON file.
    Nurbs(SurfaceFile),
    /// A triangle mesh from an STL, OBJ or PLY file.
    Stl(SurfaceFile),
    /// Solids of a CAD program from a STEP file, with their exact faces, edges and corners.
    Step(StepFile),
    /// The boundary of a mesh of cells in space from a file, such as a rigid part of a deck. Curved faces become flat.
    File(MeshFile),
    /// A triangle mesh from arrays.
    Triangles(TriangleArrays),
    /// The body below measured heights on a grid of points, from CSV, NPY or 16-bit TIFF.
    HeightMap(HeightMap),
    /// The region in which an expression of x, y and z is negative.
    LevelSet(LevelSetShape),
    /// A shape supplied by a program.
    #[serde(skip_deserializing)]
    #[schemars(skip)]
    Custom(CustomShape),
}

/// A shape that a program supplies.
#[derive(Clone)]
pub struct CustomShape(pub Arc<dyn RigidShape>);

impl std::fmt::Debug for CustomShape {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("CustomShape")
    }
}

impl Serialize for CustomShape {
    /// No text states it.
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str("a shape of the program")
    }
}

impl Shape {
    /// The keys of a shape that has a closed form.
    pub fn closed_form(&self) -> Option<&dyn ClosedForm> {
        Some(match self {
            Shape::Plane(key) => key,
            Shape::Sphere(key) => key,
            Shape::Cylinder(key) => key,
            Shape::Cone(key) => key,
            Shape::Ellipsoid(key) => key,
            Shape::Torus(key) => key,
            Shape::Paraboloid(key) => key,
            Shape::Revolution(key) => key,
            _ => return None,
        })
    }
}

/// A shape with a closed form, as its keys state it.
pub trait ClosedForm {
    /// Where it stands.
    fn placement(&self) -> Placement<'_>;

    /// Reads it; errors that belong to no key of it are those of `shape`.
    ///
    /// # Errors
    /// Values that make no such shape.
    fn read(&self, reader: &dyn ShapeReader, shape: &Shape) -> Result<Arc<dyn RigidShape>, CaseError>;
}

/// Where a shape stands, by its keys.
pub struct Placement<'a> {
    /// As the key is called, and as messages call it.
    pub name: &'static str,
    pub noun: &'static str,
    /// What lies on the axis where the problem is round.
    pub place: Option<&'a List<Value>>,
    /// Of a shape that is one in space only: round about this axis.
    pub axis: Option<&'a List<Value>>,
    pub orientation: Orientation<'a>,
}

/// Where the surface of a shape looks.
pub enum Orientation<'a> {
    Anywhere,
    /// Along a direction, or against it where the sign is negative.
    Along(&'a List<Value>, f64),
    /// Everywhere about its place, with an axis where it has one.
    Round(Option<&'a List<Value>>),
}

impl Placement<'_> {
    fn of(name: &'static str) -> Self {
        Placement { name, noun: name, place: None, axis: None, orientation: Orientation::Anywhere }
    }
}

/// How keys of shapes are read: it depends on the space, and on what the shape lies beside.
pub trait ShapeReader {
    fn problem(&self) -> &Problem;
    fn place(&self, values: &List<Value>) -> Result<Vector<3>, CaseError>;
    /// A unit vector.
    fn direction(&self, values: &List<Value>) -> Result<Vector<3>, CaseError>;
    /// A positive length.
    fn length(&self, value: &Value) -> Result<f64, CaseError>;
    /// A positive angle.
    fn angle(&self, value: &Value) -> Result<f64, CaseError>;
    /// The unit vector along the axis of a cylinder.
    fn cylinder_axis(&self, key: &Cylinder, shape: &Shape) -> Result<Vector<3>, CaseError>;
    fn semi_axes(&self, key: &Ellipsoid) -> Result<[f64; 3], CaseError>;
    /// The spline through the points of a table.
    fn profile(&self, key: &Revolution) -> Result<Profile, CaseError>;
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Plane {
    /// A point of the plane, lengths.
    pub point: List<Value>,
    /// Normal, out of the body. Its length has no influence.
    pub normal: List<Value>,
}

impl ClosedForm for Plane {
    fn placement(&self) -> Placement<'_> {
        Placement { orientation: Orientation::Along(&self.normal, 1.0), ..Placement::of("plane") }
    }

    fn read(&self, reader: &dyn ShapeReader, _: &Shape) -> Result<Arc<dyn RigidShape>, CaseError> {
        Ok(Arc::new(rigid_shape::Plane { point: reader.place(&self.point)?, normal: reader.direction(&self.normal)? }))
    }
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sphere {
    /// Centre, lengths.
    pub center: List<Value>,
    /// Radius, a length.
    pub radius: Value,
}

impl ClosedForm for Sphere {
    fn placement(&self) -> Placement<'_> {
        Placement { place: Some(&self.center), orientation: Orientation::Round(None), ..Placement::of("sphere") }
    }

    fn read(&self, reader: &dyn ShapeReader, _: &Shape) -> Result<Arc<dyn RigidShape>, CaseError> {
        Ok(Arc::new(rigid_shape::Sphere { center: reader.place(&self.center)?, radius: reader.length(&self.radius)? }))
    }
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoxShape {
    /// Lower corner before the rotation, lengths.
    pub min: List<Value>,
    /// Upper corner before the rotation, lengths.
    pub max: List<Value>,
    /// Rotation vector in radians about the middle of the box; one angle in the plane. None if left out.
    pub rotate: Option<Components>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cylinder {
    /// A point of the axis, lengths.
    pub point: List<Value>,
    /// Direction of the axis. Left out in the plane, where the axis is normal to the plane.
    pub axis: Option<List<Value>>,
    /// Radius, a length.
    pub radius: Value,
}

impl ClosedForm for Cylinder {
    fn placement(&self) -> Placement<'_> {
        Placement {
            place: Some(&self.point),
            orientation: Orientation::Round(self.axis.as_ref()),
            ..Placement::of("cylinder")
        }
    }

    fn read(&self, reader: &dyn ShapeReader, shape: &Shape) -> Result<Arc<dyn RigidShape>, CaseError> {
        let (axis, point) = (reader.cylinder_axis(self, shape)?, reader.place(&self.point)?);
        Ok(Arc::new(rigid_shape::Cylinder { point, axis, radius: reader.length(&self.radius)? }))
    }
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cone {
    /// Apex, lengths.
    pub apex: List<Value>,
    /// Direction of the axis, into the body.
    pub axis: List<Value>,
    /// Half of the opening angle, in radians.
    pub half_angle: Value,
}

impl ClosedForm for Cone {
    fn placement(&self) -> Placement<'_> {
        let orientation = Orientation::Along(&self.axis, -1.0);
        Placement { place: Some(&self.apex), orientation, axis: Some(&self.axis), ..Placement::of("cone") }
    }

    fn read(&self, reader: &dyn ShapeReader, _: &Shape) -> Result<Arc<dyn RigidShape>, CaseError> {
        let half_angle = reader.angle(&self.half_angle)?;
        if half_angle >= FRAC_PI_2 {
            return Err(reader
                .problem()
                .error(&self.half_angle, format!("the half angle is {half_angle}"))
                .help("give an angle in radians between 0 and pi/2"));
        }
        let (apex, axis) = (reader.place(&self.apex)?, reader.direction(&self.axis)?);
        Ok(Arc::new(rigid_shape::Cone { apex, axis, half_angle }))
    }
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ellipsoid {
    /// Centre, lengths.
    pub center: List<Value>,
    /// Semi-axes, lengths.
    pub semi_axes: List<Value>,
}

impl ClosedForm for Ellipsoid {
    fn placement(&self) -> Placement<'_> {
        Placement { place: Some(&self.center), orientation: Orientation::Round(None), ..Placement::of("ellipsoid") }
    }

    fn read(&self, reader: &dyn ShapeReader, shape: &Shape) -> Result<Arc<dyn RigidShape>, CaseError> {
        let semi_axes = reader.semi_axes(self)?;
        if semi_axes.iter().any(|a| *a <= 0.0) {
            return Err(reader.problem().error(&self.semi_axes, "all semi-axes must be positive"));
        }
        let made = rigid_shape::Ellipsoid::new(reader.place(&self.center)?, semi_axes);
        Ok(Arc::new(made.map_err(|e| reader.problem().error(shape, e.to_string()))?))
    }
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Torus {
    /// Centre, lengths.
    pub center: List<Value>,
    /// Direction of the axis. Its length has no influence.
    pub axis: List<Value>,
    /// Radius of the centre line of the ring, a length.
    pub major_radius: Value,
    /// Radius of the cross-section, a length.
    pub minor_radius: Value,
}

impl ClosedForm for Torus {
    fn placement(&self) -> Placement<'_> {
        let orientation = Orientation::Round(Some(&self.axis));
        Placement { place: Some(&self.center), orientation, axis: Some(&self.axis), ..Placement::of("torus") }
    }

    fn read(&self, reader: &dyn ShapeReader, _: &Shape) -> Result<Arc<dyn RigidShape>, CaseError> {
        let (major, minor) = (reader.length(&self.major_radius)?, reader.length(&self.minor_radius)?);
        if minor >= major {
            let message = format!("the minor radius {minor} is not smaller than the major radius {major}");
            return Err(reader.problem().error(&self.minor_radius, message));
        }
        let (center, axis) = (reader.place(&self.center)?, reader.direction(&self.axis)?);
        Ok(Arc::new(rigid_shape::Torus { center, axis, major, minor }))
    }
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Paraboloid {
    /// Apex, lengths.
    pub apex: List<Value>,
    /// Direction of the axis, into the body.
    pub axis: List<Value>,
    /// Radius of curvature at the apex, a length.
    pub radius: Value,
}

impl ClosedForm for Paraboloid {
    fn placement(&self) -> Placement<'_> {
        let orientation = Orientation::Along(&self.axis, -1.0);
        Placement { place: Some(&self.apex), orientation, axis: Some(&self.axis), ..Placement::of("paraboloid") }
    }

    fn read(&self, reader: &dyn ShapeReader, shape: &Shape) -> Result<Arc<dyn RigidShape>, CaseError> {
        let (radius, apex) = (reader.length(&self.radius)?, reader.place(&self.apex)?);
        let made = rigid_shape::Paraboloid::new(apex, reader.direction(&self.axis)?, radius);
        Ok(Arc::new(made.map_err(|e| reader.problem().error(shape, e.to_string()))?))
    }
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Revolution {
    /// File with points of the profile: distance from the axis and position along it. They are interpolated by a
    /// spline.
    pub profile: String,
    /// Origin of the positions along the axis, lengths; the origin if left out.
    pub origin: Option<List<Value>>,
    /// Direction of the axis, towards increasing positions.
    pub axis: List<Value>,
}

impl ClosedForm for Revolution {
    fn placement(&self) -> Placement<'_> {
        let noun = "body of revolution";
        Placement { place: self.origin.as_ref(), axis: Some(&self.axis), noun, ..Placement::of("revolution") }
    }

    fn read(&self, reader: &dyn ShapeReader, _: &Shape) -> Result<Arc<dyn RigidShape>, CaseError> {
        let origin = self.origin.as_ref().map_or(Ok(Vector::<3>::zeros()), |o| reader.place(o))?;
        let axis = reader.direction(&self.axis)?;
        Ok(Arc::new(rigid_shape::Revolution { origin, axis, profile: reader.profile(self)? }))
    }
}

/// Heights on a grid, from a file.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HeightMap {
    /// The file. The path is relative to the folder of the case.
    pub file: String,
    /// Spacing of the columns (along x) and of the rows (along y).
    pub spacing: List<Value>,
    /// Position of the first height; the origin if left out.
    pub origin: Option<List<Value>>,
    /// Height of one unit of the file; 1 if left out.
    pub scale: Option<Value>,
    /// Angle in radians by which the map is rotated about its origin.
    pub rotate: Option<Value>,
    /// Translation, applied after rotation; lengths.
    pub translate: Option<List<Value>>,
}

/// A body where an expression of x, y and z is negative, within a box.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LevelSetShape {
    /// An expression of x, y and z.
    pub negative_inside: Value,
    /// Lower corner of a box around the relevant part of the surface, lengths.
    pub min: List<Value>,
    /// The upper corner of the box, lengths.
    pub max: List<Value>,
    /// Number of grid cells along the longest side of the box, used for the search of closest points; 64 if left out.
    pub cells: Option<i64>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SurfaceFile {
    /// The file. The path is relative to the folder of the case.
    pub file: String,
    /// Length of one unit of the file in base units; 1 if left out.
    pub scale: Option<Value>,
    /// Rotation vector in radians about the origin of the file, applied after scaling; one angle in the plane.
    pub rotate: Option<Components>,
    /// Translation, applied after scaling and rotation; lengths.
    pub translate: Option<List<Value>>,
}

/// Solids of a STEP file (ISO 10303: AP203, AP214, AP242).
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StepFile {
    /// The file. The path is relative to the folder of the case.
    pub file: String,
    /// The name of one solid of the file, or its number, counted from 1; all solids if left out.
    pub solid: Option<StepSolid>,
    /// Length of one unit of the file in base units. If left out, the unit that the file states is converted where the case has
    /// `units`, else its numbers stay as they are.
    pub scale: Option<Value>,
    /// Rotation vector in radians about the origin of the file, applied after scaling.
    pub rotate: Option<Components>,
    /// Translation, applied after scaling and rotation; lengths.
    pub translate: Option<List<Value>>,
}

/// A solid of a file.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum StepSolid {
    Number(i64),
    Name(String),
}
