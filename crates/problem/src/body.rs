//! Deformable bodies: what they occupy, what they are computed on, and what they are made of.

use super::material::Material;
use super::{Beam, CellsBody, Components, List, MeshArrays, Named, NurbsMesh, Rigid, Rope, Thermal, Value};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A body.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[allow(clippy::large_enum_variant, reason = "a problem has few bodies, and their parts are found by their addresses")]
pub enum Body {
    /// An elastic membrane under tension, or a string.
    Membrane(Membrane),
    /// A rigid body.
    Rigid(Rigid),
    /// An elastic solid, meshed with finite elements.
    Solid(Solid),
    /// An elastic solid of finite cells: implicit shapes, surfaces, images.
    Cells(Box<CellsBody>),
    /// A rope, which carries tension only.
    Rope(Rope),
    /// A geometrically exact beam.
    Beam(Beam),
}

impl Body {
    /// The key of its kind.
    pub fn kind(&self) -> &'static str {
        match self {
            Body::Membrane(_) => "membrane",
            Body::Rigid(_) => "rigid",
            Body::Solid(_) => "solid",
            Body::Cells(_) => "cells",
            Body::Rope(_) => "rope",
            Body::Beam(_) => "beam",
        }
    }
}

/// An elastic solid.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Solid {
    /// The mesh of the body.
    pub mesh: SolidMesh,
    /// Polynomial degree: 1 to 8 on quadrilaterals and hexahedra, 1 or 2 on other cells. If left out, the order of the
    /// mesh. That of NURBS is raised without a change of their shape.
    pub degree: Option<i64>,
    /// The material of the body.
    pub material: Material,
    /// Strain measure: `small` or `finite`; `small` if left out.
    pub strain: Option<String>,
    /// Mass per volume; no mass if left out.
    pub density: Option<Value>,
    /// Thermal expansion, conduction and temperature; none if left out.
    pub thermal: Option<Thermal>,
    /// Velocity along each axis at the start, as expressions of position; at rest if left out.
    pub velocity: Option<List<Value>>,
    /// Edges in space that are in contact as curves, by names of your own: `between = ["rope", "block:rim"]`.
    #[serde(default)]
    pub edges: Named<SolidEdge>,
}

/// The edge along which two surfaces of a solid meet.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SolidEdge {
    /// Two groups of sides, such as `["top", "left"]`.
    pub between: List<String>,
    /// Radius of a rounding around the edge, which extends beyond the edge by this radius; 0 (a sharp edge) if left
    /// out.
    pub radius: Option<Value>,
}

#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SolidMesh {
    /// A box of quadrilaterals or hexahedra.
    Box(BoxMesh),
    /// A mesh from a file.
    Gmsh(GmshMesh),
    /// A mesh from a file of Gmsh (`.msh`), CalculiX or Abaqus (`.inp`), FEBio (`.feb`) or VTK (`.vtu`), by the ending of its
    /// name.
    File(MeshFile),
    /// A mesh from arrays.
    Arrays(MeshArrays),
    /// Patches of NURBS: the exact shape, with smooth functions.
    Nurbs(NurbsMesh),
}

/// A box of cells, uniform between two corners or graded along the axes. A map may move every point.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoxMesh {
    /// The lower corner, a length.
    pub min: Option<List<Value>>,
    /// The upper corner, a length.
    pub max: Option<List<Value>>,
    /// Number of cells in each direction.
    pub cells: Option<List<i64>>,
    /// Graded directions, in place of `min`, `max` and `cells`.
    pub axes: Option<List<MeshAxis>>,
    /// Map of the box: expressions of x, y and z for the new position of every point. Opposite sides that coincide
    /// after mapping are joined and are no longer sides, so a ring is closed.
    pub map: Option<List<Value>>,
}

/// One direction of a graded box: segments that end at `to`, each with its number of cells. Each cell is `growth` times
/// as long as the one before.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeshAxis {
    /// Start of the direction, a length.
    pub from: Value,
    /// End of each segment, lengths.
    pub to: List<Value>,
    /// Number of cells of each segment.
    pub cells: List<i64>,
    /// Ratio of the length of a cell to that of the cell before it, for each segment; 1 if left out.
    pub growth: Option<List<f64>>,
}

/// An elastic membrane under tension.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Membrane {
    /// The domain of the membrane. Left out if the mesh is read from a file.
    pub domain: Option<Domain>,
    /// The mesh or background grid.
    pub mesh: Mesh,
    /// Polynomial degree, 1 to 6.
    pub degree: Option<i64>,
    /// Force per length; a value or an expression of position.
    pub tension: Value,
}

#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Domain {
    /// A disc.
    Disc(Disc),
    /// An ellipse along the axes.
    Ellipse(Ellipse),
    /// A rectangle along the axes.
    Rectangle(Rectangle),
    /// A polygon.
    Polygon(Polygon),
    /// The region in which an expression is negative.
    Implicit(Implicit),
    /// An interval: a string, or the range of the radius of an axisymmetric membrane.
    Interval(Interval),
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Disc {
    /// Radius, a length.
    pub radius: Value,
    /// Centre, lengths; the origin if left out.
    pub center: Option<List<Value>>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ellipse {
    /// Semi-axes along x and y, lengths.
    pub semi_axes: List<Value>,
    /// Centre, lengths; the origin if left out.
    pub center: Option<List<Value>>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rectangle {
    /// The lower corner, lengths.
    pub min: List<Value>,
    /// The upper corner, lengths.
    pub max: List<Value>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Polygon {
    /// The corners in order, lengths.
    pub points: List<List<Value>>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Implicit {
    /// An expression of x and y.
    pub negative_inside: Value,
    /// Lower corner of a box around the domain, lengths.
    pub min: List<Value>,
    /// Upper corner of the box, lengths.
    pub max: List<Value>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Interval {
    /// Start of the interval, a length; 0 for a whole disc.
    pub from: Value,
    /// End of the interval, a length.
    pub to: Value,
}

#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Mesh {
    /// A uniform background grid. The boundary may cut its cells.
    Grid(GridMesh),
    /// Triangles and quadrilaterals from a Gmsh file, straight or curved, in the plane.
    Gmsh(DividedGmshMesh),
    /// A mesh from arrays, in the plane.
    Arrays(MeshArrays),
}

/// A background grid, given by the number of cells in each direction or by their size.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GridMesh {
    /// Number of cells in each direction.
    pub cells: Option<List<i64>>,
    /// Size of a cell, a length; replaces `cells`.
    pub cell_size: Option<Value>,
    /// Refinement: which cells are divided.
    pub refine: Option<Refine>,
}

/// Refinement of a grid in the plane: which cells are divided.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Refine {
    /// Maximum number of divisions where fronts curve within a cell or come close to each other; 8 if left out (5 at
    /// degree 1), 0 for none.
    pub most: Option<i64>,
    /// Number of divisions of the cells at all fronts; 0 if left out.
    pub fronts: Option<i64>,
    /// An expression of x and y. Where it is negative, cells are divided `levels` times.
    pub negative_where: Option<Value>,
    /// Number of divisions of cells in which `negative_where` is negative; 1 if left out.
    pub levels: Option<i64>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GmshMesh {
    /// A .msh file of version 2.2 or 4.1, ASCII or binary. The path is relative to the folder of the case.
    pub file: String,
    /// The physical group that forms the body; all cells if left out.
    pub group: Option<String>,
    /// Length of one unit of the file in base units; 1 if left out.
    pub scale: Option<Value>,
    /// Rotation vector in radians about the origin of the file, applied after scaling; one angle in the plane.
    pub rotate: Option<Components>,
    /// Translation, applied after scaling and rotation; lengths.
    pub translate: Option<List<Value>>,
}

/// A mesh from a file of Gmsh or from a deck of another program. Sets of nodes, sets of elements and surfaces of a deck are
/// groups of the mesh; so are the values of arrays of integers of a .vtu file, as `NAME=VALUE`.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeshFile {
    /// A .msh, .inp, .feb or .vtu file. The path is relative to the folder of the case.
    pub file: String,
    /// The set of elements, part or physical group that forms the body; all cells if left out.
    pub group: Option<String>,
    /// The number of a node of a deck: only the connected part that contains it forms the body.
    pub connected_to: Option<i64>,
    /// Further groups by the numbers of their nodes in the deck. A group holds all faces and edges whose nodes are all in it.
    #[serde(default)]
    pub nodes: Named<List<i64>>,
    /// Further groups of faces: an element or a set of elements of the deck and the number of the face, such as `"12 S3"`.
    #[serde(default)]
    pub sides: Named<List<String>>,
    /// Nodes of a surface of a deck that are moved onto another of its surfaces, to close gaps of the mesh.
    #[serde(default)]
    pub adjust: List<MeshAdjustment>,
    /// Length of one unit of the file in base units; 1 if left out.
    pub scale: Option<Value>,
    /// Rotation vector in radians about the origin of the file, applied after scaling; one angle in the plane.
    pub rotate: Option<Components>,
    /// Translation, applied after scaling and rotation; lengths.
    pub translate: Option<List<Value>>,
}

/// Nodes of a surface that are moved to their closest points on another one.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeshAdjustment {
    /// The surface of the deck whose nodes are moved.
    pub surface: String,
    /// The surface of the deck onto which they are moved, where it is in the deck.
    pub to: String,
    /// Only nodes at most this far from it, on either side, a length in the unit of the deck; all if left out.
    pub within: Option<f64>,
    /// Only nodes of this set of the deck.
    pub nodes: Option<String>,
}

/// A mesh from a file whose cells may be divided.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DividedGmshMesh {
    /// A .msh file of version 2.2 or 4.1, ASCII or binary. The path is relative to the folder of the case.
    pub file: String,
    /// The physical group that forms the body; all cells if left out.
    pub group: Option<String>,
    /// Length of one unit of the file in base units; 1 if left out.
    pub scale: Option<Value>,
    /// Rotation vector in radians about the origin of the file, applied after scaling; one angle in the plane.
    pub rotate: Option<Components>,
    /// Translation, applied after scaling and rotation; lengths.
    pub translate: Option<List<Value>>,
    /// How often every cell is divided into four; 0 if left out. Curved sides are divided along their curves. The
    /// meshes before each division are the coarser levels of a multigrid method.
    pub divisions: Option<i64>,
    /// Local refinement: which cells are divided, at degree 1 and 2.
    pub refine: Option<Refine>,
}
