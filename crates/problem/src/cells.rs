//! Bodies of finite cells: a shape that lies anywhere in a grid of cells.

use super::{List, Material, Named, Shape, Value};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::StrDeserializer;
use serde::de::{
    DeserializeSeed, Deserializer, EnumAccess, Error, IntoDeserializer, MapAccess, VariantAccess, Visitor,
};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::fmt;

/// An elastic body on a grid of cells that need not follow its shape.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CellsBody {
    /// Where material is: a shape, shapes put together, an image.
    pub geometry: Geometry,
    /// The cells around it.
    pub mesh: CellsMesh,
    /// Degree of the functions, 1 to 8; 3 if left out.
    pub degree: Option<i64>,
    /// All products of functions of the degree, or those of at most that degree; products if left out.
    pub functions: Option<CellFunctions>,
    /// How cut cells are integrated; exactly if left out.
    pub integration: Option<CellIntegration>,
    /// Stiffness outside of the material relative to that inside; 1e-8 if left out.
    pub fictitious: Option<Value>,
    /// What becomes of pieces that do not hang together with the largest; refused if left out.
    pub islands: Option<IslandsKey>,
    /// What the body is made of: linear elastic.
    pub material: Material,
    /// Parts of the surface by names of your own: where an expression of x, y and z holds, such as `z > 0.9`. The recovered
    /// boundary is `boundary`, the sides of the grid are left, right, front, back, bottom and top. The body as a whole touches
    /// others with both, but for the sides that a support names.
    #[serde(default)]
    pub groups: Named<Value>,
}

/// Where material is.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub enum Geometry {
    /// A shape of a rigid body.
    Shape(Shape),
    Composed(Composed),
}

/// Geometry that no rigid body has.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Composed {
    /// Where an expression of x, y and z is negative.
    Implicit(ImplicitGeometry),
    /// A box along the axes.
    Box(BoxGeometry),
    /// An image: TIFF stack, NPY, NRRD, MHA, NIfTI, or numbers without a header.
    Image(ImageGeometry),
    /// What lies in one of several.
    Union(List<Geometry>),
    /// What lies in all of several.
    Intersection(List<Geometry>),
    /// The first without all others.
    Difference(List<Geometry>),
    /// What is nearer than a distance to another, or deeper in it where the distance is negative.
    Offset(OffsetGeometry),
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ImplicitGeometry {
    /// An expression of x, y and z.
    pub negative_inside: Value,
    /// The lower corner of a box around it, lengths; that of the mesh if left out.
    pub min: Option<List<Value>>,
    /// The upper corner.
    pub max: Option<List<Value>>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoxGeometry {
    /// The lower corner, lengths.
    pub min: List<Value>,
    /// The upper corner, lengths.
    pub max: List<Value>,
}

#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OffsetGeometry {
    /// The geometry.
    pub of: Box<Geometry>,
    /// The distance, a length.
    pub distance: Value,
}

/// An image of voxels.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ImageGeometry {
    /// The file, found from the folder of the case.
    pub file: String,
    /// Extent of a voxel along x, y and z, lengths; what the file says if left out, and it must say it.
    pub spacing: Option<List<Value>>,
    /// The corner of the first voxel, lengths; what the file says, or the origin, if left out.
    pub origin: Option<List<Value>>,
    /// The order of the directions in the file, the one that runs slowest first; `zyx` if left out.
    pub axes: Option<String>,
    /// Material is where the image, interpolated smoothly, is above this.
    pub threshold: Option<Value>,
    /// Voxels by which the image is smoothed; 1 if left out.
    pub smoothing: Option<Value>,
    /// In place of a threshold: Young's modulus by the `value` of a voxel; no material where it is zero.
    pub youngs_modulus: Option<Value>,
    /// Of a file without header: the type of its numbers, such as `u16`, `f32`; then `counts` too.
    pub numbers: Option<String>,
    /// Of a file without header: the number of voxels along x, y and z.
    pub counts: Option<List<i64>>,
}

/// The grid of cells.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CellsMesh {
    /// Cells of a box.
    pub grid: CellsGrid,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CellsGrid {
    /// Number of cells in each direction.
    pub cells: Option<List<i64>>,
    /// Size of a cell, a length, in place of `cells`.
    pub cell_size: Option<Value>,
    /// The lower corner, lengths; that of the geometry if left out.
    pub min: Option<List<Value>>,
    /// The upper corner.
    pub max: Option<List<Value>>,
    /// Where cells are divided.
    pub refine: Option<CellsRefine>,
}

/// Where cells are divided.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CellsRefine {
    /// How often cells are divided in which the boundary faces itself: pores, gaps and tips.
    pub narrow: Option<i64>,
    /// How often cells are divided that the boundary cuts.
    pub boundary: Option<i64>,
    /// Cells near something.
    #[serde(default)]
    pub near: List<NearRefine>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NearRefine {
    /// A distance by x, y and z, such as `hypot(x, y)`.
    pub distance: Value,
    /// Cells that come within this distance, a length.
    pub within: Value,
    /// How often they are divided.
    pub levels: i64,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum CellFunctions {
    /// All products of functions of the degree.
    Tensor,
    /// Products of at most the degree: fewer unknowns.
    Trunk,
}

#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CellIntegration {
    /// By height functions, up to rounding.
    Exact(ExactIntegration),
    /// By sub-cells, cut along chords.
    SubCells(SubCellIntegration),
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExactIntegration {
    /// Points of Gauss in each direction of a smooth piece; four more than the degree if left out.
    pub points: Option<i64>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SubCellIntegration {
    /// Sub-cells in each direction of a cell.
    pub subdivision: i64,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum IslandsKey {
    /// They are an error, with their volume and place.
    Refuse,
    /// They are left out.
    Drop,
    /// They are bodies of their own, which something must hold.
    Keep,
}

/// The keys of [`Composed`].
const COMPOSED: [&str; 7] = ["implicit", "box", "image", "union", "intersection", "difference", "offset"];

impl JsonSchema for Geometry {
    fn schema_name() -> Cow<'static, str> {
        "Geometry".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let (shape, composed) = (generator.subschema_for::<Shape>(), generator.subschema_for::<Composed>());
        json_schema!({ "anyOf": [composed, shape] })
    }
}

impl<'de> Deserialize<'de> for Geometry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = Geometry;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str(
                    "a shape such as sphere = { … }, or implicit, box, image, union, intersection, difference, offset",
                )
            }
            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Geometry, A::Error> {
                let Some(key) = map.next_key::<String>()? else {
                    return Err(A::Error::custom("a geometry is missing"));
                };
                let found = if COMPOSED.contains(&key.as_str()) {
                    Composed::deserialize(OneKey { key: &key, map: &mut map }.into_enum()).map(Geometry::Composed)
                } else {
                    Shape::deserialize(OneKey { key: &key, map: &mut map }.into_enum()).map(Geometry::Shape)
                }?;
                match map.next_key::<String>()? {
                    None => Ok(found),
                    Some(other) => Err(A::Error::custom(format!("`{key}` and `{other}`: a geometry has one key"))),
                }
            }
        }
        deserializer.deserialize_map(Reader)
    }
}

/// A variant whose name was read, its content still to come.
struct OneKey<'a, A> {
    key: &'a str,
    map: &'a mut A,
}

impl<'de, A: MapAccess<'de>> OneKey<'_, A> {
    fn into_enum(self) -> serde::de::value::EnumAccessDeserializer<Self> {
        serde::de::value::EnumAccessDeserializer::new(self)
    }
}

impl<'de, A: MapAccess<'de>> EnumAccess<'de> for OneKey<'_, A> {
    type Error = A::Error;
    type Variant = Self;
    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Self), A::Error> {
        let name: StrDeserializer<'_, A::Error> = self.key.into_deserializer();
        Ok((seed.deserialize(name)?, self))
    }
}

impl<'de, A: MapAccess<'de>> VariantAccess<'de> for OneKey<'_, A> {
    type Error = A::Error;
    fn unit_variant(self) -> Result<(), A::Error> {
        Err(A::Error::custom("a table is missing"))
    }
    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, A::Error> {
        self.map.next_value_seed(seed)
    }
    fn tuple_variant<V: Visitor<'de>>(self, _: usize, _: V) -> Result<V::Value, A::Error> {
        self.unit_variant().and(Err(A::Error::custom("a table is missing")))
    }
    fn struct_variant<V: Visitor<'de>>(self, _: &'static [&'static str], _: V) -> Result<V::Value, A::Error> {
        self.unit_variant().and(Err(A::Error::custom("a table is missing")))
    }
}
