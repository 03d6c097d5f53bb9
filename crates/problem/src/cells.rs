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

/// An elastic body of finite cells. The cells do not follow its boundary.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CellsBody {
    /// The region filled with material: a shape, a set operation on shapes, or an image.
    pub geometry: Geometry,
    /// The grid of cells around the body.
    pub mesh: CellsMesh,
    /// Polynomial degree, 1 to 8; 3 if left out.
    pub degree: Option<i64>,
    /// Space of functions: all products of polynomials of the degree (`tensor`), or those of at most this total degree
    /// (`trunk`); `tensor` if left out.
    pub functions: Option<CellFunctions>,
    /// Quadrature of cut cells; `exact` if left out.
    pub integration: Option<CellIntegration>,
    /// Stiffness of the fictitious material outside the body, relative to that of the body; 1e-8 if left out.
    pub alpha: Option<Value>,
    /// Treatment of pieces that are not connected to the largest one; `refuse` if left out.
    pub islands: Option<IslandsKey>,
    /// The material of the body.
    pub material: Material,
    /// Strain measure: `small` or `finite`; `small` if left out.
    pub strain: Option<String>,
    /// Mass per volume; no mass if left out.
    pub density: Option<Value>,
    /// Velocity along each axis at the start, as expressions of position; at rest if left out.
    pub velocity: Option<List<Value>>,
    /// Parts of the surface, by names of your own: where an expression of x, y and z holds, such as `z > 0.9`. The
    /// recovered boundary is `boundary`; the sides of the grid are left, right, front, back, bottom and top. If contact
    /// names the whole body, it includes the boundary and the sides, except those with a support.
    #[serde(default)]
    pub groups: Named<Value>,
}

/// The region filled with material.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub enum Geometry {
    /// A shape as for a rigid body.
    Shape(Shape),
    Composed(Composed),
}

/// Geometry that rigid bodies do not have.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Composed {
    /// The region in which an expression of x, y and z is negative.
    Implicit(ImplicitGeometry),
    /// A box along the axes.
    Box(BoxGeometry),
    /// An image: TIFF stack, NPY, NRRD, MHA, NIfTI, or raw numbers without a header.
    Image(ImageGeometry),
    /// Union: the points inside at least one of the geometries.
    Union(List<Geometry>),
    /// Intersection: the points inside all geometries.
    Intersection(List<Geometry>),
    /// Difference: the first geometry without all others.
    Difference(List<Geometry>),
    /// Offset: the points nearer to a geometry than a distance; if the distance is negative, the points deeper inside
    /// it.
    Offset(OffsetGeometry),
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ImplicitGeometry {
    /// An expression of x, y and z.
    pub negative_inside: Value,
    /// Lower corner of a box around the region, lengths; that of the grid if left out.
    pub min: Option<List<Value>>,
    /// Upper corner of the box.
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
    /// The geometry that is offset.
    pub of: Box<Geometry>,
    /// The offset distance, a length.
    pub distance: Value,
}

/// A voxel image.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ImageGeometry {
    /// The image file. The path is relative to the folder of the case.
    pub file: String,
    /// Voxel size along x, y and z, lengths. If left out, it is read from the file, which must contain it.
    pub spacing: Option<List<Value>>,
    /// Corner of the first voxel, lengths. If left out, it is read from the file; the origin if the file has none.
    pub origin: Option<List<Value>>,
    /// Order of the directions in the file, the slowest first; `zyx` if left out.
    pub axes: Option<String>,
    /// Threshold: material is where the smoothly interpolated image is above this value.
    pub threshold: Option<Value>,
    /// Smoothing width of the image in voxels; 1 if left out.
    pub smoothing: Option<Value>,
    /// Young's modulus as a function of the voxel `value`; replaces the threshold. There is no material where it is
    /// zero.
    pub youngs_modulus: Option<Value>,
    /// For a file without header: number type, such as `u16` or `f32`. It requires `counts`.
    pub numbers: Option<String>,
    /// For a file without header: number of voxels along x, y and z.
    pub counts: Option<List<i64>>,
}

/// The grid of cells.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CellsMesh {
    /// A box of cells.
    pub grid: CellsGrid,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CellsGrid {
    /// Number of cells in each direction.
    pub cells: Option<List<i64>>,
    /// Size of a cell, a length; replaces `cells`.
    pub cell_size: Option<Value>,
    /// Lower corner, lengths; that of the geometry if left out.
    pub min: Option<List<Value>>,
    /// Upper corner, lengths; that of the geometry if left out.
    pub max: Option<List<Value>>,
    /// Refinement: which cells are divided.
    pub refine: Option<CellsRefine>,
}

/// Refinement: which cells are divided.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CellsRefine {
    /// Number of divisions of cells in which the boundary faces itself, as in pores, gaps and tips.
    pub narrow: Option<i64>,
    /// Number of divisions of cells that the boundary cuts.
    pub boundary: Option<i64>,
    /// Refinement near points, lines or other sets given by a distance.
    #[serde(default)]
    pub near: List<NearRefine>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NearRefine {
    /// A distance as an expression of x, y and z, such as `hypot(x, y)`.
    pub distance: Value,
    /// Cells nearer than this distance are divided, a length.
    pub within: Value,
    /// Number of divisions.
    pub levels: i64,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum CellFunctions {
    /// All products of polynomials of the degree.
    Tensor,
    /// Products of at most this total degree; fewer unknowns.
    Trunk,
}

#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CellIntegration {
    /// With height functions, accurate to round-off.
    Exact(ExactIntegration),
    /// With sub-cells, cut along chords.
    SubCells(SubCellIntegration),
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExactIntegration {
    /// Number of Gauss points in each direction of a smooth piece; four more than the degree if left out.
    pub points: Option<i64>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SubCellIntegration {
    /// Number of sub-cells in each direction of a cell.
    pub subdivision: i64,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum IslandsKey {
    /// Islands are an error, which states their volume and position.
    Refuse,
    /// Islands are removed.
    Drop,
    /// Islands are retained as separate bodies. Each needs a support or contact.
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
                    return Err(A::Error::custom("the geometry is empty"));
                };
                let found = if COMPOSED.contains(&key.as_str()) {
                    Composed::deserialize(OneKey { key: &key, map: &mut map }.into_enum()).map(Geometry::Composed)
                } else {
                    Shape::deserialize(OneKey { key: &key, map: &mut map }.into_enum()).map(Geometry::Shape)
                }?;
                match map.next_key::<String>()? {
                    None => Ok(found),
                    Some(other) => {
                        Err(A::Error::custom(format!("`{key}` and `{other}`: a geometry has exactly one key")))
                    }
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
        Err(A::Error::custom("a table is required"))
    }
    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, A::Error> {
        self.map.next_value_seed(seed)
    }
    fn tuple_variant<V: Visitor<'de>>(self, _: usize, _: V) -> Result<V::Value, A::Error> {
        self.unit_variant().and(Err(A::Error::custom("a table is required")))
    }
    fn struct_variant<V: Visitor<'de>>(self, _: &'static [&'static str], _: V) -> Result<V::Value, A::Error> {
        self.unit_variant().and(Err(A::Error::custom("a table is required")))
    }
}
