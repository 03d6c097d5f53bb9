//! Meshes of spline patches.

use super::{Array, Components, List, Value};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Patches of rational B-splines (NURBS), in the plane or in space. The spans between knots are the cells, and the displacement
/// has the functions of the patch. State one patch by its keys, several by `patches`, or a file.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NurbsMesh {
    /// A JSON file: one patch by the keys `degree`, `knots`, `points` and `weights`, or several in a list `patches`. The path is
    /// relative to the folder of the case.
    pub file: Option<String>,
    /// Degree in each direction, 1 to 8.
    pub degree: Option<List<i64>>,
    /// Knots of each direction, ascending. The first and the last are repeated `degree + 1` times.
    pub knots: Option<Array<Vec<f64>>>,
    /// Control points, the first direction fastest, in the base unit of length. There are as many in a direction as knots less
    /// `degree + 1`.
    pub points: Option<Array<Vec<f64>>>,
    /// Weights of the control points, greater than 0; 1 if left out.
    pub weights: Option<Array<f64>>,
    /// Several patches. Sides that coincide are joined: there control points, weights, knots and numbers of cells must be the same.
    #[serde(default)]
    pub patches: List<NurbsPatch>,
    /// Number of cells into which each span of knots is divided, in each direction; 1 if left out. The shape does not change.
    pub cells: Option<List<i64>>,
    /// Length of one unit of the control points in base units; 1 if left out.
    pub scale: Option<Value>,
    /// Rotation vector in radians about the origin, applied after scaling; one angle in the plane.
    pub rotate: Option<Components>,
    /// Translation, applied after scaling and rotation; lengths.
    pub translate: Option<List<Value>>,
}

/// A patch of rational B-splines.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NurbsPatch {
    /// A name: `NAME` is then the group of the cells of the patch, and `NAME_left` and so on those of its sides.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Degree in each direction, 1 to 8.
    pub degree: List<i64>,
    /// Knots of each direction, ascending. The first and the last are repeated `degree + 1` times.
    pub knots: Array<Vec<f64>>,
    /// Control points, the first direction fastest, in the base unit of length.
    pub points: Array<Vec<f64>>,
    /// Weights of the control points, greater than 0; 1 if left out.
    pub weights: Option<Array<f64>>,
    /// Number of cells into which each span of knots is divided, in each direction; that of the mesh if left out.
    pub cells: Option<List<i64>>,
}
