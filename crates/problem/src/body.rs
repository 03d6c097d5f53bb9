//! Deformable bodies: what they occupy, what they are computed on, and what they are made of.

use super::material::Material;
use super::{Beam, CellsBody, Components, List, MeshArrays, Named, Rigid, Rope, Value};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Things that occupy space.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Body {
    /// A film under tension, or a string.
    Membrane(Membrane),
    /// A body that does not deform.
    Rigid(Rigid),
    /// Elastic solids by finite elements.
    Solid(Solid),
    /// Elastic solids on a grid of cells: implicit shapes, surfaces, images.
    Cells(Box<CellsBody>),
    /// A rope, which carries tension only.
    Rope(Rope),
    /// A beam of any shape.
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
    /// The cells of the body.
    pub mesh: SolidMesh,
    /// Polynomial degree: 1 to 8 on quadrilaterals and hexahedra, 1 or 2 on other cells.
    pub degree: Option<i64>,
    /// What the body is made of.
    pub material: Material,
    /// `small`, or `finite`.
    pub strain: Option<String>,
    /// Edges in space that touch as curves, by names of your own: `between = ["rope", "block:rim"]`.
    #[serde(default)]
    pub edges: Named<SolidEdge>,
}

/// The edge along which two surfaces of a solid meet.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SolidEdge {
    /// Two groups of sides, such as `["top", "left"]`.
    pub between: List<String>,
    /// Radius of a rounding about the edge, which stands out from it by as much; 0, a sharp edge, if left out.
    pub radius: Option<Value>,
}

#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SolidMesh {
    /// A box of quadrilaterals or hexahedra.
    Box(BoxMesh),
    /// A mesh from a file.
    Gmsh(GmshMesh),
    /// A mesh from arrays.
    Arrays(MeshArrays),
    #[schemars(skip)]
    Nurbs(toml::Table),
}

/// A box of cells: even between two corners, or graded along axes; every point may be moved by a map.
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
    /// Expressions of x, y and z for the place of every point. Opposite sides that come to lie on each other are joined, and are
    /// no sides any more: a ring is closed.
    pub map: Option<List<Value>>,
}

/// One direction of a box: stretches that end at `to`, with so many cells, each `growth` times as long as the one before.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeshAxis {
    /// Where the direction begins, a length.
    pub from: Value,
    /// Where each stretch ends, lengths.
    pub to: List<Value>,
    /// Number of cells of each stretch.
    pub cells: List<i64>,
    /// Of each stretch the ratio of the length of a cell to that of the one before, 1 if left out.
    pub growth: Option<List<f64>>,
}

/// A film under tension.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Membrane {
    /// Where the membrane is; left out where the mesh of a file says it.
    pub domain: Option<Domain>,
    /// What the displacement is computed on.
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
    /// Where an expression is negative.
    Implicit(Implicit),
    /// An interval: a string, or the radii of a round membrane.
    Interval(Interval),
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Disc {
    /// Radius, a length.
    pub radius: Value,
    /// Centre, a length in each direction; the origin if left out.
    pub center: Option<List<Value>>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ellipse {
    /// Half the extent along x and y, lengths.
    pub semi_axes: List<Value>,
    /// Centre, a length in each direction; the origin if left out.
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
    /// The corners in order, each a length in each direction.
    pub points: List<List<Value>>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Implicit {
    /// An expression of x and y.
    pub negative_inside: Value,
    /// The lower corner of a box round the domain, lengths.
    pub min: List<Value>,
    /// The upper corner of the box, lengths.
    pub max: List<Value>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Interval {
    /// Where it begins, a length; 0 for a whole round membrane.
    pub from: Value,
    /// Where it ends, a length.
    pub to: Value,
}

#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Mesh {
    /// A uniform grid, which the boundary may cut.
    Grid(GridMesh),
    /// Triangles and quadrilaterals from a file, straight or curved; in the plane.
    Gmsh(DividedGmshMesh),
    /// A mesh from arrays, in the plane.
    Arrays(MeshArrays),
}

/// A background grid: a number of cells in each direction, or their size.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GridMesh {
    /// Number of cells in each direction.
    pub cells: Option<List<i64>>,
    /// Size of a cell, a length, in place of `cells`.
    pub cell_size: Option<Value>,
    /// Where cells are divided.
    pub refine: Option<Refine>,
}

/// Where cells are divided, in the plane.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Refine {
    /// How often cells are divided at most where fronts curve within a cell or come near each other; 8 if left out (5
    /// of degree 1), 0 for never.
    pub most: Option<i64>,
    /// How often cells are divided at all fronts; 0 if left out.
    pub fronts: Option<i64>,
    /// An expression of x and y: where it is negative, cells are divided `levels` times.
    pub negative_where: Option<Value>,
    /// How often cells are divided where `negative_where` is negative; 1 if left out.
    pub levels: Option<i64>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GmshMesh {
    /// A file .msh of version 2.2 or 4.1, ASCII or binary, found from the folder of the case.
    pub file: String,
    /// The physical group that is the body; all cells if left out.
    pub group: Option<String>,
    /// What one unit of length of the file is in base units, 1 if left out.
    pub scale: Option<Value>,
    /// Rotation vector in radians about the origin of the file, after scaling; in the plane one angle.
    pub turn: Option<Components>,
    /// Displacement after scaling and turning, lengths.
    #[serde(rename = "move")]
    pub moved: Option<List<Value>>,
}

/// A mesh from a file whose cells may be divided.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DividedGmshMesh {
    /// A file .msh of version 2.2 or 4.1, ASCII or binary, found from the folder of the case.
    pub file: String,
    /// The physical group that is the body; all cells if left out.
    pub group: Option<String>,
    /// What one unit of length of the file is in base units, 1 if left out.
    pub scale: Option<Value>,
    /// Rotation vector in radians about the origin of the file, after scaling; in the plane one angle.
    pub turn: Option<Components>,
    /// Displacement after scaling and turning, lengths.
    #[serde(rename = "move")]
    pub moved: Option<List<Value>>,
    /// How often every cell is divided into four, curved sides along their curves; 0 if left out. The meshes before each
    /// division are the coarser levels of a multigrid method.
    pub divisions: Option<i64>,
    /// Where single cells are divided, at degree 1 and 2.
    pub refine: Option<Refine>,
}
