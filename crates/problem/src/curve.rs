//! Bodies that are curves: ropes and beams, the path along which they lie at the start, and their sections.

use super::{Components, List, Material, Value};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A rope: it carries tension only.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rope {
    /// Where it lies at the start.
    pub path: Path,
    /// Number of elements; 50 if left out.
    pub cells: Option<i64>,
    /// Force per strain, EA.
    pub stiffness: Value,
    /// Radius of its section, for contact; 0 if left out.
    pub radius: Option<Value>,
    /// Tension along the path at the start, a force.
    pub pretension: Option<Value>,
    /// Length without tension, in place of `pretension`; that of the path if both are left out.
    pub unstrained_length: Option<Value>,
    /// Straight elements, or smooth ones; straight if left out.
    pub continuity: Option<Continuity>,
    /// Moment per curvature, EI, of a smooth rope; 0 if left out.
    pub bending_stiffness: Option<Value>,
    /// Points of Gauss in each element of a smooth rope at which contact is tested; 4 if left out.
    pub contact_points: Option<i64>,
    /// Points of the path, lengths, at which the rope runs through a pulley without friction: its length is the same in all.
    /// Supports and loads know them as `ROPE:pulleys`, or one by one as `ROPE:pulley_1`. Of straight elements only.
    pub pulleys: Option<List<List<Value>>>,
    /// A winch at an end that a support holds. Of straight elements only.
    pub winch: Option<Winch>,
}

/// A winch pays rope out and takes it in.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Winch {
    /// The end of the rope at which it is.
    pub at: RopeEnd,
    /// The unstrained length paid out since the start, by `t`; negative where it is taken in.
    pub paid_out: Value,
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
    /// Cubic elements with common tangents.
    C1,
}

/// A beam, which bends, twists, shears and stretches by any amount.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Beam {
    /// Where it lies without stress.
    pub path: Path,
    /// Number of elements; 20 if left out.
    pub cells: Option<i64>,
    /// The shape of its section, or its stiffness.
    pub section: Section,
    /// What it is made of; left out where the section states its stiffness.
    pub material: Option<Material>,
    /// With shear and torsion, or free of torsion: for yarns and nets, round, straight at the start. With shear if left out.
    pub model: Option<BeamModel>,
    /// A direction near the first axis across the section at the start of the path.
    pub orientation: Option<List<Value>>,
    /// Radius that touches; that of a round section if left out.
    pub radius: Option<Value>,
    /// Points of Gauss in each element at which contact is tested; 4 if left out.
    pub contact_points: Option<i64>,
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
    /// Straight from point to point.
    Points(List<List<Value>>),
    /// A smooth curve through points.
    Spline(SplinePath),
    /// Points from a file, straight or as a spline.
    File(PathFile),
    /// An arc of a circle through three points.
    Arc(ArcPath),
    /// A helix.
    Helix(HelixPath),
    /// A curve by a parameter.
    Formula(FormulaPath),
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FormulaPath {
    /// The position by the parameter `u`, lengths.
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
    /// Whether the curve returns to its first point.
    pub closed: Option<bool>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PathFile {
    /// A CSV file with columns x, y, z, found from the folder of the case.
    pub file: String,
    /// Whether a spline leads through the points; it does not if left out.
    pub spline: Option<bool>,
    /// Whether the curve returns to its first point.
    pub closed: Option<bool>,
    /// What one unit of length of the file is in base units, 1 if left out.
    pub scale: Option<Value>,
    /// Rotation vector in radians about the origin of the file, after scaling.
    pub turn: Option<Components>,
    /// Displacement after scaling and turning, lengths.
    #[serde(rename = "move")]
    pub moved: Option<List<Value>>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ArcPath {
    /// Where it begins, a point between, and where it ends, lengths.
    pub points: List<List<Value>>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HelixPath {
    /// A point of the axis, at the height of the start; the origin if left out.
    pub center: Option<List<Value>>,
    /// Direction of the axis; z if left out.
    pub axis: Option<List<Value>>,
    /// A direction from the axis towards the start; any if left out.
    pub towards: Option<List<Value>>,
    /// Radius, a length.
    pub radius: Value,
    /// Advance along the axis in a turn, a length; 0 makes a circle.
    pub pitch: Value,
    /// Number of turns.
    pub turns: Value,
}

#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Section {
    /// A round section.
    Circle(CircleSection),
    /// A rectangle.
    Rectangle(RectangleSection),
    /// The stiffness itself.
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
    /// Along the first axis across the section, a length.
    pub width: Value,
    /// Along the second one, a length.
    pub height: Value,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SectionStiffness {
    /// Force per strain.
    #[serde(rename = "EA")]
    pub axial: Value,
    /// Force per shear along both axes; large if left out: `EA` then.
    #[serde(rename = "GA")]
    pub shear: Option<Components>,
    /// Moment per curvature about both axes, or one for both.
    #[serde(rename = "EI")]
    pub bending: Components,
    /// Moment per twist; `EI` if left out.
    #[serde(rename = "GJ")]
    pub torsion: Option<Value>,
}
