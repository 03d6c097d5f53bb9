//! Bodies that are curves: ropes and beams, the path along which they lie at the start, and their sections.

use super::{Components, List, Material, Value};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A rope: it carries tension only.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rope {
    /// Initial position of the rope.
    pub path: Path,
    /// Number of elements; 50 if left out.
    pub cells: Option<i64>,
    /// Axial stiffness EA, a force.
    pub stiffness: Value,
    /// Radius of the section, used in contact; 0 if left out.
    pub radius: Option<Value>,
    /// Initial tension along the path, a force.
    pub pretension: Option<Value>,
    /// Unstrained length; replaces `pretension`. The length of the path if both are left out.
    pub unstrained_length: Option<Value>,
    /// Straight elements (`C0`) or smooth ones (`C1`); `C0` if left out.
    pub continuity: Option<Continuity>,
    /// Bending stiffness EI of a smooth rope; 0 if left out.
    pub bending_stiffness: Option<Value>,
    /// Number of Gauss points in each element of a smooth rope at which contact is tested; 4 if left out.
    pub contact_points: Option<i64>,
    /// Points of the path, lengths, at which the rope runs through a pulley without friction. The tension is the same
    /// on both sides. Supports and loads name them `ROPE:pulleys`, or one by one `ROPE:pulley_1`. Only for straight
    /// elements.
    pub pulleys: Option<List<List<Value>>>,
    /// A winch at a supported end. Only for straight elements.
    pub winch: Option<Winch>,
    /// Mass per length; no mass if left out.
    pub mass_per_length: Option<Value>,
    /// Velocity along each axis at the start, as expressions of position; at rest if left out.
    pub velocity: Option<List<Value>>,
}

/// A winch, which pays out rope and takes it in.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Winch {
    /// The end of the rope with the winch.
    pub at: RopeEnd,
    /// Unstrained length paid out since the start, as an expression of `t`; negative if rope is taken in.
    pub length: Value,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum RopeEnd {
    Start,
    End,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
pub enum Continuity {
    /// Straight elements, joined at nodes.
    C0,
    /// Cubic elements with common tangents at nodes.
    C1,
}

/// A geometrically exact beam with bending, torsion, shear and extension.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Beam {
    /// The stress-free path of the beam.
    pub path: Path,
    /// Number of elements; 20 if left out.
    pub cells: Option<i64>,
    /// The shape of its section, or its stiffness.
    pub section: Section,
    /// Material. Left out if the section gives the stiffness.
    pub material: Option<Material>,
    /// With shear and torsion, or free of torsion. The latter is for yarns and nets: round sections, initially
    /// straight. `shear` if left out.
    pub model: Option<BeamModel>,
    /// A direction near the first axis of the section at the start of the path.
    pub orientation: Option<List<Value>>,
    /// Radius used in contact; that of a circular section if left out.
    pub radius: Option<Value>,
    /// Number of Gauss points in each element at which contact is tested; 4 if left out.
    pub contact_points: Option<i64>,
    /// Mass per volume, of a section with a shape; no mass if left out.
    pub density: Option<Value>,
    /// Velocity along each axis at the start, as expressions of position; at rest if left out.
    pub velocity: Option<List<Value>>,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum BeamModel {
    /// Geometrically exact, with shear and torsion (Simo and Reissner).
    Shear,
    /// Without shear and torsion.
    TorsionFree,
}

#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Path {
    /// Straight segments from point to point.
    Points(List<List<Value>>),
    /// A spline through points.
    Spline(SplinePath),
    /// Points from a file, joined by straight segments or a spline.
    File(PathFile),
    /// An arc of a circle through three points.
    Arc(ArcPath),
    /// A helix.
    Helix(HelixPath),
    /// A parametric curve.
    Formula(FormulaPath),
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FormulaPath {
    /// Position as expressions of the parameter `u`, lengths.
    pub position: List<Value>,
    /// The first value of `u`.
    pub from: Value,
    /// The last one.
    pub to: Value,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SplinePath {
    /// Points in order, lengths.
    pub points: List<List<Value>>,
    /// Whether the curve is closed.
    pub closed: Option<bool>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PathFile {
    /// A CSV file with columns x, y, z. The path is relative to the folder of the case.
    pub file: String,
    /// Whether the points are joined by a spline; false if left out.
    pub spline: Option<bool>,
    /// Whether the curve is closed.
    pub closed: Option<bool>,
    /// Length of one unit of the file in base units; 1 if left out.
    pub scale: Option<Value>,
    /// Rotation vector in radians about the origin of the file, applied after scaling.
    pub rotate: Option<Components>,
    /// Translation, applied after scaling and rotation; lengths.
    pub translate: Option<List<Value>>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ArcPath {
    /// Start point, a point between, and end point, lengths.
    pub points: List<List<Value>>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HelixPath {
    /// A point of the axis, at the height of the start; the origin if left out.
    pub center: Option<List<Value>>,
    /// Direction of the axis; z if left out.
    pub axis: Option<List<Value>>,
    /// A direction from the axis towards the start point; any if left out.
    pub towards: Option<List<Value>>,
    /// Radius, a length.
    pub radius: Value,
    /// Pitch: advance along the axis per turn, a length; 0 for a circle.
    pub pitch: Value,
    /// Number of turns.
    pub turns: Value,
}

#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Section {
    /// A circular section.
    Circle(CircleSection),
    /// A rectangle.
    Rectangle(RectangleSection),
    /// The stiffness of the section.
    Stiffness(SectionStiffness),
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CircleSection {
    /// Radius, a length.
    pub radius: Value,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RectangleSection {
    /// Width along the first axis of the section, a length.
    pub width: Value,
    /// Height along the second axis of the section, a length.
    pub height: Value,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SectionStiffness {
    /// Axial stiffness, a force.
    #[serde(rename = "EA")]
    pub axial: Value,
    /// Shear stiffness along both axes, forces; large if left out: `EA` then.
    #[serde(rename = "GA")]
    pub shear: Option<Components>,
    /// Bending stiffness about both axes; one value for both is allowed.
    #[serde(rename = "EI")]
    pub bending: Components,
    /// Torsional stiffness; `EI` if left out.
    #[serde(rename = "GJ")]
    pub torsion: Option<Value>,
}
