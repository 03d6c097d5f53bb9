//! The statement as it stands in a case file, key by key.
//!
//! Every variant is a table with one key, and unknown keys are refused, so an error is always reported at its own
//! line and column. What a key means, and in which unit it stands, is said here once.

use super::value::{Literal, OneOrMany, Value, Values};
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;
use toml::Spanned;

/// A whole case file.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// Free text, repeated in the results.
    #[serde(default)]
    pub title: Option<String>,
    /// Base units; without them numbers are in any consistent units.
    #[serde(default)]
    #[schemars(with = "Option<UnitsKey>")]
    pub units: Option<Spanned<UnitsKey>>,
    /// In how many dimensions, and what the coordinates mean.
    #[schemars(with = "Space")]
    pub space: Spanned<Space>,
    /// Named numbers for expressions.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, Literal>")]
    pub constants: BTreeMap<String, Value>,
    /// Named functions of one argument, `t`.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, FunctionKey>")]
    pub functions: BTreeMap<String, Spanned<FunctionKey>>,
    /// The things that occupy space, by names of your own.
    #[schemars(with = "BTreeMap<String, Body>")]
    pub bodies: BTreeMap<String, Spanned<Body>>,
    /// What holds bodies, by names of your own.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, Support>")]
    pub supports: BTreeMap<String, Spanned<Support>>,
    /// What pushes and pulls bodies, by names of your own.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, Load>")]
    pub loads: BTreeMap<String, Spanned<Load>>,
    /// Which bodies may touch, by names of your own.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, Contact>")]
    pub contacts: BTreeMap<String, Spanned<Contact>>,
    /// The history, part by part; without steps one state is computed, at t = 0.
    #[serde(default)]
    #[schemars(with = "Vec<Step>")]
    pub steps: Vec<Spanned<Step>>,
    /// What to write.
    #[serde(default)]
    pub output: Output,
    /// What `signorini fit` is to find out from measurements.
    #[serde(default)]
    #[schemars(with = "Option<FitKey>")]
    pub fit: Option<Spanned<FitKey>>,
}

/// Measurements of a contact, and what they are to tell.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FitKey {
    /// A CSV file with a line of names above its columns.
    #[schemars(with = "String")]
    pub data: Spanned<String>,
    /// Column of the time, of which loads and motions of the case are functions.
    #[schemars(with = "String")]
    pub time: Spanned<String>,
    /// Column of the radius of contact, or of its half length.
    #[serde(default)]
    #[schemars(with = "Option<String>")]
    pub radius: Option<Spanned<String>>,
    /// Column of the area of contact, in place of the radius.
    #[serde(default)]
    #[schemars(with = "Option<String>")]
    pub area: Option<Spanned<String>>,
    /// `adhesion`, and if wanted `tension`.
    #[serde(default)]
    #[schemars(with = "Option<Vec<FitUnknown>>")]
    pub unknown: Option<Spanned<Vec<Spanned<FitUnknown>>>>,
    /// Whether the scatter of the measurements is relative to their size.
    #[serde(default)]
    pub noise: Option<Noise>,
    /// Confidence of the intervals, 0.95 if left out.
    #[serde(default)]
    #[schemars(with = "Option<f64>")]
    pub confidence: Option<Spanned<f64>>,
}

#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum FitUnknown {
    /// The energy of adhesion of the contact.
    Adhesion,
    /// The tension of the membrane.
    Tension,
}

#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Noise {
    /// In proportion to the measured value.
    #[default]
    Relative,
    /// The same for all values.
    Absolute,
}

/// A named system of units, or the names of the base units.
#[derive(Clone, Debug)]
pub enum UnitsKey {
    System(String),
    Base(BaseUnits),
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BaseUnits {
    /// Unit of length, such as "mm".
    pub length: String,
    /// Unit of force, such as "N".
    pub force: String,
    /// Unit of time; "s" if left out.
    #[serde(default = "second")]
    pub time: String,
}

fn second() -> String {
    "s".into()
}

impl JsonSchema for UnitsKey {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Units".into()
    }
    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let base = generator.subschema_for::<BaseUnits>();
        schemars::json_schema!({ "anyOf": [{ "type": "string", "examples": ["mm-N-MPa"] }, base] })
    }
}

impl<'de> Deserialize<'de> for UnitsKey {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> serde::de::Visitor<'de> for Reader {
            type Value = UnitsKey;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a system such as \"mm-N-MPa\", or { length = \"mm\", force = \"N\", time = \"s\" }")
            }
            fn visit_str<E>(self, v: &str) -> Result<UnitsKey, E> {
                Ok(UnitsKey::System(v.to_string()))
            }
            fn visit_map<A: serde::de::MapAccess<'de>>(self, map: A) -> Result<UnitsKey, A::Error> {
                BaseUnits::deserialize(serde::de::value::MapAccessDeserializer::new(map)).map(UnitsKey::Base)
            }
        }
        deserializer.deserialize_any(Reader)
    }
}

#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Space {
    /// A string: one coordinate, x.
    Line,
    /// A round membrane: x is the radius.
    Axisymmetric,
    /// A membrane seen from above.
    Plane,
    /// A slice of a long body: no strain across.
    PlaneStrain,
    /// A thin plate: no stress across.
    PlaneStress,
    /// Space itself.
    #[serde(rename = "3d")]
    ThreeD,
}

/// A function of one argument: a table, or an expression in `t`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FunctionKey {
    /// Points of a piecewise linear function.
    #[serde(default)]
    #[schemars(with = "Option<Table>")]
    pub table: Option<Spanned<Table>>,
    /// An expression in t.
    #[serde(default)]
    #[schemars(with = "Option<Literal>")]
    pub expression: Option<Value>,
}

/// A piecewise linear function.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Table {
    /// Arguments, ascending.
    pub t: Vec<f64>,
    /// Values, one for each argument.
    pub value: Vec<f64>,
}

/// Things that occupy space.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Body {
    /// A film under tension, or a string.
    Membrane(Membrane),
    /// A body that does not deform.
    Rigid(Rigid),
    /// Elastic solids by finite elements.
    Solid(Solid),
    /// Solids on a background grid: implicit shapes, surfaces, images.
    #[schemars(skip)]
    Cells(toml::Table),
    #[schemars(skip)]
    Rope(toml::Table),
    #[schemars(skip)]
    Beam(toml::Table),
}

/// An elastic solid.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Solid {
    /// The cells of the body.
    #[schemars(with = "SolidMesh")]
    pub mesh: Spanned<SolidMesh>,
    /// Polynomial degree: 1 to 8 on quadrilaterals and hexahedra, 1 or 2 on other cells.
    #[serde(default)]
    #[schemars(with = "Option<i64>")]
    pub degree: Option<Spanned<i64>>,
    /// What the body is made of.
    #[schemars(with = "Material")]
    pub material: Spanned<Material>,
    /// `small`, or `finite`.
    #[serde(default)]
    #[schemars(with = "Option<String>")]
    pub strain: Option<Spanned<String>>,
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SolidMesh {
    /// A box of quadrilaterals or hexahedra.
    Box(BoxKey),
    /// A mesh from a file.
    Gmsh(GmshKey),
    #[schemars(skip)]
    Nurbs(toml::Table),
}

/// A box of cells: even between two corners, or graded along axes; every point may be moved by a map.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoxKey {
    /// The lower corner, a length.
    #[serde(default)]
    #[schemars(with = "Option<Vec<Literal>>")]
    pub min: Option<Values>,
    /// The upper corner, a length.
    #[serde(default)]
    #[schemars(with = "Option<Vec<Literal>>")]
    pub max: Option<Values>,
    /// Number of cells in each direction.
    #[serde(default)]
    #[schemars(with = "Option<Vec<i64>>")]
    pub cells: Option<Spanned<Vec<Spanned<i64>>>>,
    /// Graded directions, in place of `min`, `max` and `cells`.
    #[serde(default)]
    #[schemars(with = "Option<Vec<AxisKey>>")]
    pub axes: Option<Spanned<Vec<Spanned<AxisKey>>>>,
    /// Expressions of x, y and z for the place of every point.
    #[serde(default)]
    #[schemars(with = "Option<Vec<Literal>>")]
    pub map: Option<Values>,
}

/// One direction of a box: stretches that end at `to`, with so many cells, each `growth` times as long as the one before.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AxisKey {
    /// Where the direction begins, a length.
    #[schemars(with = "Literal")]
    pub from: Value,
    /// Where each stretch ends, lengths.
    #[schemars(with = "Vec<Literal>")]
    pub to: Values,
    /// Number of cells of each stretch.
    #[schemars(with = "Vec<i64>")]
    pub cells: Spanned<Vec<Spanned<i64>>>,
    /// Of each stretch the ratio of the length of a cell to that of the one before, 1 if left out.
    #[serde(default)]
    #[schemars(with = "Option<Vec<f64>>")]
    pub growth: Option<Spanned<Vec<f64>>>,
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Material {
    /// Isotropic and linear.
    LinearElastic(ElasticKey),
    #[schemars(skip)]
    NeoHooke(toml::Table),
    #[schemars(skip)]
    SaintVenantKirchhoff(toml::Table),
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ElasticKey {
    /// Young's modulus, a force per area.
    #[schemars(with = "Literal")]
    pub youngs_modulus: Value,
    /// Poisson's ratio, above -1 and below 0.5.
    #[schemars(with = "Literal")]
    pub poissons_ratio: Value,
}

/// A film under tension.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Membrane {
    /// Where the membrane is; left out where the mesh of a file says it.
    #[serde(default)]
    #[schemars(with = "Option<Domain>")]
    pub domain: Option<Spanned<Domain>>,
    /// What the displacement is computed on.
    #[schemars(with = "Mesh")]
    pub mesh: Spanned<Mesh>,
    /// Polynomial degree, 1 to 6.
    #[serde(default)]
    #[schemars(with = "Option<i64>")]
    pub degree: Option<Spanned<i64>>,
    /// Force per length; a value or an expression of position.
    #[schemars(with = "Literal")]
    pub tension: Value,
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Domain {
    /// A disc.
    Disc(Disc),
    /// An ellipse along the axes.
    Ellipse(EllipseKey),
    /// A rectangle along the axes.
    Rectangle(Rectangle),
    /// A polygon.
    Polygon(Polygon),
    /// Where an expression is negative.
    Implicit(Implicit),
    /// An interval: a string, or the radii of a round membrane.
    Interval(Interval),
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Disc {
    /// Radius, a length.
    #[schemars(with = "Literal")]
    pub radius: Value,
    /// Centre, a length in each direction; the origin if left out.
    #[serde(default)]
    #[schemars(with = "Option<Vec<Literal>>")]
    pub center: Option<Values>,
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EllipseKey {
    /// Half the extent along x and y, lengths.
    #[schemars(with = "Vec<Literal>")]
    pub semi_axes: Values,
    /// Centre, a length in each direction; the origin if left out.
    #[serde(default)]
    #[schemars(with = "Option<Vec<Literal>>")]
    pub center: Option<Values>,
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rectangle {
    /// The lower corner, lengths.
    #[schemars(with = "Vec<Literal>")]
    pub min: Values,
    /// The upper corner, lengths.
    #[schemars(with = "Vec<Literal>")]
    pub max: Values,
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Polygon {
    /// The corners in order, each a length in each direction.
    #[schemars(with = "Vec<Vec<Literal>>")]
    pub points: Spanned<Vec<Values>>,
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Implicit {
    /// An expression of x and y.
    #[schemars(with = "Literal")]
    pub negative_inside: Value,
    /// The lower corner of a box round the domain, lengths.
    #[schemars(with = "Vec<Literal>")]
    pub min: Values,
    /// The upper corner of the box, lengths.
    #[schemars(with = "Vec<Literal>")]
    pub max: Values,
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Interval {
    /// Where it begins, a length; 0 for a whole round membrane.
    #[schemars(with = "Literal")]
    pub from: Value,
    /// Where it ends, a length.
    #[schemars(with = "Literal")]
    pub to: Value,
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Mesh {
    /// A uniform grid, which the boundary may cut.
    Grid(GridKey),
    /// Triangles and quadrilaterals from a file, straight or curved; in the plane.
    Gmsh(DividedGmshKey),
}

/// A background grid: a number of cells in each direction, or their size.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GridKey {
    /// Number of cells in each direction.
    #[serde(default)]
    #[schemars(with = "Option<Vec<i64>>")]
    pub cells: Option<Spanned<Vec<Spanned<i64>>>>,
    /// Size of a cell, a length, in place of `cells`.
    #[serde(default)]
    #[schemars(with = "Option<Literal>")]
    pub cell_size: Option<Value>,
    /// Where cells are divided.
    #[serde(default)]
    #[schemars(with = "Option<RefineKey>")]
    pub refine: Option<Spanned<RefineKey>>,
}

/// Where cells are divided, in the plane.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RefineKey {
    /// How often cells are divided at most where fronts curve within a cell or come near each other; 8 if left out (5
    /// of degree 1), 0 for never.
    #[serde(default)]
    #[schemars(with = "Option<i64>")]
    pub most: Option<Spanned<i64>>,
    /// How often cells are divided at all fronts; 0 if left out.
    #[serde(default)]
    #[schemars(with = "Option<i64>")]
    pub fronts: Option<Spanned<i64>>,
    /// An expression of x and y: where it is negative, cells are divided `levels` times.
    #[serde(default)]
    #[schemars(with = "Option<Literal>")]
    pub negative_where: Option<Value>,
    /// How often cells are divided where `negative_where` is negative; 1 if left out.
    #[serde(default)]
    #[schemars(with = "Option<i64>")]
    pub levels: Option<Spanned<i64>>,
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GmshKey {
    /// A file .msh of version 2.2 or 4.1, ASCII or binary, found from the folder of the case.
    #[schemars(with = "String")]
    pub file: Spanned<String>,
    /// The physical group that is the body; all cells if left out.
    #[serde(default)]
    pub group: Option<String>,
}

/// A mesh from a file whose cells may be divided.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DividedGmshKey {
    /// A file .msh of version 2.2 or 4.1, ASCII or binary, found from the folder of the case.
    #[schemars(with = "String")]
    pub file: Spanned<String>,
    /// The physical group that is the body; all cells if left out.
    #[serde(default)]
    pub group: Option<String>,
    /// How often every cell is divided into four, curved sides along their curves; 0 if left out. The meshes before each
    /// division are the coarser levels of a multigrid method.
    #[serde(default)]
    #[schemars(with = "Option<i64>")]
    pub divisions: Option<Spanned<i64>>,
    /// Where single cells are divided, at degree 1 and 2.
    #[serde(default)]
    #[schemars(with = "Option<RefineKey>")]
    pub refine: Option<Spanned<RefineKey>>,
}

/// A body that does not deform.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rigid {
    /// The shape of its surface.
    #[schemars(with = "Shape")]
    pub shape: Spanned<Shape>,
    /// On which side of the surface the body is free to be touched; `outside` if left out.
    #[serde(default)]
    #[schemars(with = "Option<Side>")]
    pub side: Option<Spanned<Side>>,
    /// Where it lies beside a membrane; if left out a plane, a cone and a paraboloid tell it by their direction, a round
    /// body by its centre, and every other one lies below.
    #[serde(default)]
    #[schemars(with = "Option<Lies>")]
    pub lies: Option<Spanned<Lies>>,
    /// How it moves; it is at rest if left out.
    #[serde(default)]
    #[schemars(with = "Option<Motion>")]
    pub motion: Option<Spanned<Motion>>,
}

#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Lies {
    /// Under the membrane: it is seen from above.
    Below,
    /// Over the membrane: it is seen from below.
    Above,
}

#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// The body fills the shape.
    Outside,
    /// The shape is a hole in the body.
    Inside,
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// A floor seen from above: its height as an expression of x and y.
    Height(#[schemars(with = "Literal")] Value),
    /// A half space below a plane.
    Plane(PlaneKey),
    /// A ball.
    Sphere(SphereKey),
    /// A round cylinder without ends.
    Cylinder(CylinderKey),
    /// A round cone without end.
    Cone(ConeKey),
    /// An ellipsoid along the axes.
    Ellipsoid(EllipsoidKey),
    /// A ring.
    Torus(TorusKey),
    /// A paraboloid of revolution.
    Paraboloid(ParaboloidKey),
    /// NURBS surfaces from a JSON file.
    Nurbs(FileKey),
    /// A triangle mesh from an STL, OBJ or PLY file.
    Stl(FileKey),
    /// Measured heights on a grid of points, from CSV, NPY or 16-bit TIFF.
    HeightMap(HeightMapKey),
    /// Where an expression of x, y and z is negative.
    LevelSet(LevelSetShapeKey),
}

/// Heights on a grid, from a file.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HeightMapKey {
    /// The file, found from the folder of the case.
    #[schemars(with = "String")]
    pub file: Spanned<String>,
    /// Distance of the columns (along x) and of the rows (along y).
    #[schemars(with = "Vec<Literal>")]
    pub spacing: Values,
    /// Where the first height is.
    #[serde(default)]
    #[schemars(with = "Option<Vec<Literal>>")]
    pub origin: Option<Values>,
    /// The height that one unit of the file stands for.
    #[serde(default)]
    #[schemars(with = "Option<Literal>")]
    pub scale: Option<Value>,
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlaneKey {
    /// A point of the plane, lengths.
    #[schemars(with = "Vec<Literal>")]
    pub point: Values,
    /// The normal out of the body; its length does not matter.
    #[schemars(with = "Vec<Literal>")]
    pub normal: Values,
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SphereKey {
    /// Centre, lengths.
    #[schemars(with = "Vec<Literal>")]
    pub center: Values,
    /// Radius, a length.
    #[schemars(with = "Literal")]
    pub radius: Value,
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CylinderKey {
    /// A point of the axis, lengths.
    #[schemars(with = "Vec<Literal>")]
    pub point: Values,
    /// In the plane a cylinder stands across it.
    #[serde(default)]
    #[schemars(with = "Option<Vec<Literal>>")]
    pub axis: Option<Values>,
    /// Radius, a length.
    #[schemars(with = "Literal")]
    pub radius: Value,
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ConeKey {
    /// The tip, lengths.
    #[schemars(with = "Vec<Literal>")]
    pub apex: Values,
    /// Into the body.
    #[schemars(with = "Vec<Literal>")]
    pub axis: Values,
    /// In radians.
    #[schemars(with = "Literal")]
    pub half_angle: Value,
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EllipsoidKey {
    /// Centre, lengths.
    #[schemars(with = "Vec<Literal>")]
    pub center: Values,
    /// Half the extents, lengths.
    #[schemars(with = "Vec<Literal>")]
    pub semi_axes: Values,
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TorusKey {
    /// Centre, lengths.
    #[schemars(with = "Vec<Literal>")]
    pub center: Values,
    /// Direction of its axis; its length does not matter.
    #[schemars(with = "Vec<Literal>")]
    pub axis: Values,
    /// Radius of the ring's middle line, a length.
    #[schemars(with = "Literal")]
    pub major_radius: Value,
    /// Radius of its cross-section, a length.
    #[schemars(with = "Literal")]
    pub minor_radius: Value,
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ParaboloidKey {
    /// The lowest or highest point, lengths.
    #[schemars(with = "Vec<Literal>")]
    pub apex: Values,
    /// Into the body.
    #[schemars(with = "Vec<Literal>")]
    pub axis: Values,
    /// Of curvature at the apex.
    #[schemars(with = "Literal")]
    pub radius: Value,
}

/// A body where an expression of x, y and z is negative, within a box.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LevelSetShapeKey {
    /// An expression of x, y and z.
    #[schemars(with = "Literal")]
    pub negative_inside: Value,
    /// The lower corner of a box round what matters of it, lengths.
    #[schemars(with = "Vec<Literal>")]
    pub min: Values,
    /// The upper corner of the box, lengths.
    #[schemars(with = "Vec<Literal>")]
    pub max: Values,
    /// Cells of the grid from which closest points are searched, along the longest side; 64 if left out.
    #[serde(default)]
    #[schemars(with = "Option<i64>")]
    pub cells: Option<Spanned<i64>>,
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FileKey {
    /// The file, found from the folder of the case.
    #[schemars(with = "String")]
    pub file: Spanned<String>,
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Motion {
    /// At rest.
    Fixed(Nothing),
    /// Moved as stated.
    Prescribed(Prescribed),
    /// Moved by what acts on it; not available yet.
    Free(Nothing),
}

/// A table without keys.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Nothing {}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Prescribed {
    /// Displacement along each axis, lengths, as expressions of t.
    #[serde(default)]
    #[schemars(with = "Option<Vec<Literal>>")]
    pub displacement: Option<Values>,
    /// Rotation vector in radians, as expressions of t.
    #[serde(default)]
    #[schemars(with = "Option<Vec<Literal>>")]
    pub rotation: Option<Values>,
}

/// Where something is held or moved.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Support {
    /// `BODY` or `BODY:GROUP`.
    #[schemars(with = "String")]
    pub on: Spanned<String>,
    /// A value for a membrane, a vector with `"free"` where free for a solid.
    #[serde(default)]
    #[schemars(with = "Option<OneOrMany>")]
    pub displacement: Option<Spanned<OneOrMany>>,
    /// The displacement along the outward normal alone.
    #[serde(default)]
    #[schemars(with = "Option<Literal>")]
    pub normal: Option<Value>,
    /// All points share one displacement in the components that are not prescribed.
    #[serde(default)]
    #[schemars(with = "Option<bool>")]
    pub uniform: Option<Spanned<bool>>,
    /// Stiffness per area of an elastic bed.
    #[serde(default)]
    #[schemars(with = "Option<Vec<Literal>>")]
    pub spring: Option<Values>,
}

/// What pushes.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Load {
    /// A body, or `BODY:GROUP`.
    #[schemars(with = "String")]
    pub on: Spanned<String>,
    /// Force per area along +z for a membrane.
    #[serde(default)]
    #[schemars(with = "Option<Literal>")]
    pub normal: Option<Value>,
    /// Force per area along each axis.
    #[serde(default)]
    #[schemars(with = "Option<Vec<Literal>>")]
    pub traction: Option<Values>,
    /// Force per area against the outer normal.
    #[serde(default)]
    #[schemars(with = "Option<Literal>")]
    pub pressure: Option<Value>,
    /// A resultant force along each axis, spread evenly.
    #[serde(default)]
    #[schemars(with = "Option<Vec<Literal>>")]
    pub force: Option<Values>,
    /// Force per volume along each axis.
    #[serde(default)]
    #[schemars(with = "Option<Vec<Literal>>")]
    pub body_force: Option<Values>,
}

/// Who may touch whom.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// Two bodies, the one whose points are tested first.
    #[serde(default)]
    #[schemars(with = "Option<Vec<String>>")]
    pub between: Option<Spanned<Vec<Spanned<String>>>>,
    /// A body that may touch itself; not available yet.
    #[serde(default)]
    #[schemars(with = "Option<String>")]
    pub within: Option<Spanned<String>>,
    /// Whether all bodies may touch each other.
    #[serde(default)]
    #[schemars(with = "Option<bool>")]
    pub all: Option<Spanned<bool>>,
    /// How the contact is found; what fits the bodies if left out.
    #[serde(default)]
    #[schemars(with = "Option<Method>")]
    pub method: Option<Spanned<Method>>,
    /// How far solids slide along each other: little, or any way.
    #[serde(default)]
    #[schemars(with = "Option<Sliding>")]
    pub sliding: Option<Spanned<Sliding>>,
    /// What the surfaces hold each other with.
    #[serde(default)]
    pub adhesion: Option<Adhesion>,
    #[serde(default)]
    #[schemars(skip)]
    pub friction: Option<Spanned<toml::Value>>,
}

#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Sliding {
    /// Bodies slide by much less than a cell.
    Small,
    /// Bodies slide as far as they like.
    Finite,
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// The contact zone of a membrane as a level set with exact fronts.
    InequalityLevelSet(Box<LevelSetKey>),
    /// The classical nodal method for a membrane, of degree 1.
    ActiveSet(ActiveSetKey),
    /// Between solids: dual multipliers, integrated over exact segments.
    Mortar(EnforcedKey),
    /// Between solids: at quadrature points.
    GaussPoint(EnforcedKey),
    /// Between solids: at nodes.
    Node(EnforcedKey),
}

#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LevelSetKey {
    /// How the equilibrium beside a contact zone is formulated; `one_sided` if left out.
    #[serde(default)]
    #[schemars(with = "Option<FormulationKey>")]
    pub formulation: Option<Spanned<FormulationKey>>,
    /// With `formulation = "published"`, the space of the multiplier in the contact zone; `h1` if left out.
    #[serde(default)]
    #[schemars(with = "Option<ZoneMultiplierKey>")]
    pub multiplier: Option<Spanned<ZoneMultiplierKey>>,
    /// With `multiplier = "h1"`, the length that weighs its gradients; the extent of the membrane if left out.
    #[serde(default)]
    #[schemars(with = "Option<Literal>")]
    pub multiplier_length: Option<Value>,
    /// With `formulation = "published"`, how fronts are moved; `exact` if left out.
    #[serde(default)]
    #[schemars(with = "Option<TransportKey>")]
    pub transport: Option<Spanned<TransportKey>>,
    /// The functions by which fronts move; `local` if left out, `fourier` in the published formulation.
    #[serde(default)]
    #[schemars(with = "Option<FrontModes>")]
    pub modes: Option<Spanned<FrontModes>>,
    /// With `modes = "fourier"`, how many of them each front has at most; where its cells tell fewer apart it has these, and the
    /// run says so.
    #[serde(default)]
    #[schemars(with = "Option<i64>")]
    pub mode_count: Option<Spanned<i64>>,
    /// Degree of the fronts as curves; not available, it follows the degree of the membrane.
    #[serde(default)]
    #[schemars(with = "Option<i64>")]
    pub front_degree: Option<Spanned<i64>>,
    /// Where the search for the zone begins, in the shapes of a domain.
    #[serde(default)]
    #[schemars(with = "Option<Domain>")]
    pub initial_zone: Option<Spanned<Domain>>,
}

#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum FormulationKey {
    /// The free membrane alone, held along the front by Nitsche's method: any degree, any path.
    OneSided,
    /// Both sides of the front with multipliers, as the method was published: degree 1 in the plane, 1 to 6 along a line or a
    /// radius.
    Published,
}

#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum ZoneMultiplierKey {
    /// With gradients: carries the line force along a front that is not at rest.
    H1,
    /// Without: oscillates along such a front, to show why not.
    L2,
}

#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum TransportKey {
    /// As curves.
    Exact,
    /// As a level set on the nodes, which becomes the distance to the moved front.
    Redistancing,
    /// As a level set on the nodes, carried along by the equation of Hamilton and Jacobi.
    HamiltonJacobi,
}

#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum FrontModes {
    /// Periodic splines, each of which moves a short piece: for fronts of any shape.
    Local,
    /// Sines and cosines of the arc length: few suffice where fronts are nearly circles.
    Fourier,
}

#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EnforcedKey {
    /// How the conditions of contact are enforced; by multipliers if left out, at quadrature points by penalties.
    #[serde(default)]
    #[schemars(with = "Option<Enforcement>")]
    pub enforcement: Option<Spanned<Enforcement>>,
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Enforcement {
    /// Exactly, by multipliers.
    Multiplier(Nothing),
    /// Exactly, by repeated penalties.
    AugmentedLagrangian(Nothing),
    /// Weakly and consistently, without multipliers.
    Nitsche(Nothing),
    /// Approximately, by springs.
    Penalty(PenaltyKey),
}

/// A penalty is stated by what it may leave, never as a number of its own.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PenaltyKey {
    /// The penetration to be left at the largest pressure, a length.
    #[serde(default)]
    #[schemars(with = "Option<Literal>")]
    pub wanted_penetration: Option<Value>,
}

#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ActiveSetKey {
    /// Where the iteration begins; `nested` if left out.
    #[serde(default)]
    #[schemars(with = "Option<ActiveSetStart>")]
    pub start: Option<Spanned<ActiveSetStart>>,
}

#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum ActiveSetStart {
    /// From the solution on a coarser grid.
    Nested,
    /// From the membrane without contact.
    Cold,
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Adhesion {
    /// Energy per area.
    #[schemars(with = "Literal")]
    pub energy: Value,
}

/// A part of the history.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Step {
    /// Time at its end.
    #[schemars(with = "Literal")]
    pub to: Value,
    /// Number of increments, 1 if left out.
    #[serde(default)]
    #[schemars(with = "Option<i64>")]
    pub increments: Option<Spanned<i64>>,
    /// What is prescribed along the step; the time if left out.
    #[serde(default)]
    #[schemars(with = "Option<Control>")]
    pub control: Option<Spanned<Control>>,
    /// Changes of topology and jumps are located to so much of the time; they are not sought if left out.
    #[serde(default)]
    #[schemars(with = "Option<f64>")]
    pub events: Option<Spanned<f64>>,
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Control {
    /// The time.
    Time(Nothing),
    /// Along the path of equilibria, through its folds.
    ArcLength(ArcKey),
    /// The area of contact.
    Area(AreaKey),
}

/// A step along a path of equilibria.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ArcKey {
    /// Length of an increment, where the area of the membrane and the time that the step takes have length one.
    #[schemars(with = "f64")]
    pub size: Spanned<f64>,
}

/// A step in which the area of contact is given, and the time at which it is reached is sought.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AreaKey {
    /// Name of the contact.
    #[schemars(with = "String")]
    pub of: Spanned<String>,
    /// The area at the end of the step.
    #[schemars(with = "Literal")]
    pub to: Value,
}

/// What to write.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Increments between written fields.
    #[serde(default)]
    #[schemars(with = "Option<i64>")]
    pub every: Option<Spanned<i64>>,
    /// Whether pictures are drawn; they are if left out.
    #[serde(default)]
    pub pictures: Option<bool>,
    /// Points whose histories are recorded.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, Vec<Literal>>")]
    pub probes: BTreeMap<String, Values>,
}
