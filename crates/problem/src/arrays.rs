//! Arrays in place of files: grids of samples, meshes, triangles.

use super::{List, Named};
use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::ops::Deref;
use std::sync::Arc;

/// A list of numbers or of tuples of them, shared by all copies of a problem.
#[derive(Clone, Debug)]
pub struct Array<T>(Arc<Vec<T>>);

impl<T> Default for Array<T> {
    fn default() -> Self {
        Self(Arc::default())
    }
}

impl<T> Deref for Array<T> {
    type Target = [T];
    fn deref(&self) -> &[T] {
        &self.0
    }
}

impl<T> From<Vec<T>> for Array<T> {
    fn from(list: Vec<T>) -> Self {
        Self(Arc::new(list))
    }
}

impl<T: Serialize> Serialize for Array<T> {
    /// In texts; whoever looks for a part of a problem finds none in an array.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if serializer.is_human_readable() { self.0.serialize(serializer) } else { serializer.serialize_unit() }
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Array<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Vec::deserialize(deserializer).map(Self::from)
    }
}

impl<T: JsonSchema> JsonSchema for Array<T> {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> std::borrow::Cow<'static, str> {
        Vec::<T>::schema_name()
    }
    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        Vec::<T>::json_schema(generator)
    }
}

/// Values at the points of a grid over x and y, in the base units.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Grid2 {
    /// Position of the first value.
    pub origin: [f64; 2],
    /// Spacing of the columns (along x) and of the rows (along y).
    pub spacing: [f64; 2],
    /// The values, row by row from below. All rows have the same number of columns.
    pub values: Array<Vec<f64>>,
}

/// A mesh of a body: points, cells, and named parts.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeshArrays {
    /// Coordinates of the points in the base unit of length: two per point in the plane, three in space.
    pub points: Array<Vec<f64>>,
    /// The cells, by shape.
    pub cells: List<CellArrays>,
    /// Named groups, each a list of points. A side or cell belongs to a group if all its corners are in the list.
    #[serde(default)]
    pub groups: Named<Array<u32>>,
}

/// Cells of one shape.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CellArrays {
    /// `triangle`, `quadrilateral`, `tetrahedron`, `hexahedron` or `wedge`.
    pub shape: String,
    /// Points of each cell, counted from zero, in the order of Gmsh: first the corners; for curved cells then the nodes
    /// of edges, faces and interior, or of the edges only.
    pub nodes: Array<Vec<u32>>,
}

/// A closed triangulated surface.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TriangleArrays {
    /// Coordinates of the points, in the base unit of length.
    pub points: Array<[f64; 3]>,
    /// The corners of each triangle, counted from zero, counterclockwise as seen from outside.
    pub triangles: Array<[u32; 3]>,
}
