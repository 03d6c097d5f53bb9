//! Rigid bodies: their shape, on which side they are touched, and how they move.

use super::{Components, List, Nothing, TriangleArrays, Value};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use signorini_geometry::rigid_shape::RigidShape;
use std::sync::Arc;

/// A body that does not deform.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rigid {
    /// The shape of its surface.
    pub shape: Shape,
    /// On which side of the surface the body is free to be touched; `outside` if left out.
    pub side: Option<Side>,
    /// Of a triangle mesh: a smooth surface through its vertices in place of flat triangles, for what slides or rolls on it;
    /// flat if left out. Paths always run on the smooth one.
    pub smooth: Option<bool>,
    /// Where it lies beside a membrane; if left out a plane, a cone and a paraboloid tell it by their direction, a round
    /// body by its centre, and every other one lies below.
    pub lies: Option<Lies>,
    /// How it moves; it is at rest if left out.
    pub motion: Option<Motion>,
}

impl Rigid {
    /// A body at rest that is touched from outside.
    pub fn new(shape: Shape) -> Self {
        Self { shape, side: None, smooth: None, lies: None, motion: None }
    }
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Lies {
    /// Under the membrane: it is seen from above.
    Below,
    /// Over the membrane: it is seen from below.
    Above,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// The body fills the shape.
    Outside,
    /// The shape is a hole in the body.
    Inside,
}

#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// A floor seen from above: its height as an expression of x and y.
    Height(Value),
    /// A half space below a plane.
    Plane(Plane),
    /// A ball.
    Sphere(Sphere),
    /// A round cylinder without ends.
    Cylinder(Cylinder),
    /// A round cone without end.
    Cone(Cone),
    /// An ellipsoid along the axes.
    Ellipsoid(Ellipsoid),
    /// A ring.
    Torus(Torus),
    /// A paraboloid of revolution.
    Paraboloid(Paraboloid),
    /// A body of revolution of a smooth profile.
    Revolution(Revolution),
    /// NURBS surfaces from a JSON file.
    Nurbs(SurfaceFile),
    /// A triangle mesh from an STL, OBJ or PLY file.
    Stl(SurfaceFile),
    /// A triangle mesh from arrays.
    Triangles(TriangleArrays),
    /// Measured heights on a grid of points, from CSV, NPY or 16-bit TIFF.
    HeightMap(HeightMap),
    /// Where an expression of x, y and z is negative.
    LevelSet(LevelSetShape),
    /// A shape of the program.
    #[serde(skip_deserializing)]
    #[schemars(skip)]
    Custom(CustomShape),
}

/// Heights on a grid, from a file.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HeightMap {
    /// The file, found from the folder of the case.
    pub file: String,
    /// Distance of the columns (along x) and of the rows (along y).
    pub spacing: List<Value>,
    /// Where the first height is.
    pub origin: Option<List<Value>>,
    /// The height that one unit of the file stands for.
    pub scale: Option<Value>,
    /// Angle in radians by which the map is turned about its origin.
    pub turn: Option<Value>,
    /// Displacement after turning, lengths.
    #[serde(rename = "move")]
    pub moved: Option<List<Value>>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Plane {
    /// A point of the plane, lengths.
    pub point: List<Value>,
    /// The normal out of the body; its length does not matter.
    pub normal: List<Value>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sphere {
    /// Centre, lengths.
    pub center: List<Value>,
    /// Radius, a length.
    pub radius: Value,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cylinder {
    /// A point of the axis, lengths.
    pub point: List<Value>,
    /// In the plane a cylinder stands across it.
    pub axis: Option<List<Value>>,
    /// Radius, a length.
    pub radius: Value,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Revolution {
    /// A table of points of the profile: distance from the axis, and place along it. A spline runs through them.
    pub profile: String,
    /// Where places along the axis are counted from, lengths; the origin if left out.
    pub origin: Option<List<Value>>,
    /// Along the axis, in the direction in which places increase.
    pub axis: List<Value>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cone {
    /// The tip, lengths.
    pub apex: List<Value>,
    /// Into the body.
    pub axis: List<Value>,
    /// In radians.
    pub half_angle: Value,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ellipsoid {
    /// Centre, lengths.
    pub center: List<Value>,
    /// Half the extents, lengths.
    pub semi_axes: List<Value>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Torus {
    /// Centre, lengths.
    pub center: List<Value>,
    /// Direction of its axis; its length does not matter.
    pub axis: List<Value>,
    /// Radius of the ring's middle line, a length.
    pub major_radius: Value,
    /// Radius of its cross-section, a length.
    pub minor_radius: Value,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Paraboloid {
    /// The lowest or highest point, lengths.
    pub apex: List<Value>,
    /// Into the body.
    pub axis: List<Value>,
    /// Of curvature at the apex.
    pub radius: Value,
}

/// A body where an expression of x, y and z is negative, within a box.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LevelSetShape {
    /// An expression of x, y and z.
    pub negative_inside: Value,
    /// The lower corner of a box round what matters of it, lengths.
    pub min: List<Value>,
    /// The upper corner of the box, lengths.
    pub max: List<Value>,
    /// Cells of the grid from which closest points are searched, along the longest side; 64 if left out.
    pub cells: Option<i64>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SurfaceFile {
    /// The file, found from the folder of the case.
    pub file: String,
    /// What one unit of length of the file is in base units, 1 if left out.
    pub scale: Option<Value>,
    /// Rotation vector in radians about the origin of the file, after scaling; in the plane one angle.
    pub turn: Option<Components>,
    /// Displacement after scaling and turning, lengths.
    #[serde(rename = "move")]
    pub moved: Option<List<Value>>,
}

#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Motion {
    /// At rest.
    Fixed(Nothing),
    /// Moved as stated.
    Prescribed(Prescribed),
    /// Moved by what acts on it.
    Free(FreeMotion),
}

/// A rigid body that moves freely: in space by six unknowns, in the plane by three.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FreeMotion {
    /// The point that forces act on and about which the body turns, lengths; the centre of the shape if left out.
    pub center: Option<List<Value>>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Prescribed {
    /// Displacement along each axis, lengths, as expressions of t.
    pub displacement: Option<List<Value>>,
    /// Rotation vector in radians, as expressions of t.
    pub rotation: Option<List<Value>>,
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
