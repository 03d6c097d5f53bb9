//! The statement as it stands in a case file, key by key.
//!
//! Every variant is a table with one key, and unknown keys are refused, so an error is always reported at its own
//! line and column. What a key means, and in which unit it stands, is said here once.

use super::value::{OneOrMany, Value, Values};
use serde::Deserialize;
use std::collections::BTreeMap;
use toml::Spanned;

/// A whole case file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// Free text, repeated in the results.
    #[serde(default)]
    pub title: Option<String>,
    /// Base units; without them numbers are in any consistent units.
    #[serde(default)]
    pub units: Option<Spanned<UnitsKey>>,
    pub space: Spanned<Space>,
    /// Named numbers for expressions.
    #[serde(default)]
    pub constants: BTreeMap<String, Value>,
    /// Named functions of one argument, `t`.
    #[serde(default)]
    pub functions: BTreeMap<String, Spanned<FunctionKey>>,
    pub bodies: BTreeMap<String, Spanned<Body>>,
    #[serde(default)]
    pub supports: BTreeMap<String, Spanned<Support>>,
    #[serde(default)]
    pub loads: BTreeMap<String, Spanned<Load>>,
    #[serde(default)]
    pub contacts: BTreeMap<String, Spanned<Contact>>,
    #[serde(default)]
    pub steps: Vec<Spanned<Step>>,
    #[serde(default)]
    pub output: Output,
    /// What `signorini fit` is to find out from measurements.
    #[serde(default)]
    pub fit: Option<Spanned<FitKey>>,
}

/// Measurements of a contact, and what they are to tell.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FitKey {
    /// A CSV file with a line of names above its columns.
    pub data: Spanned<String>,
    /// Column of the time, of which loads and motions of the case are functions.
    pub time: Spanned<String>,
    /// Column of the radius of contact, or of its half length.
    #[serde(default)]
    pub radius: Option<Spanned<String>>,
    /// Column of the area of contact, in place of the radius.
    #[serde(default)]
    pub area: Option<Spanned<String>>,
    /// `adhesion`, and if wanted `tension`.
    #[serde(default)]
    pub unknown: Option<Spanned<Vec<Spanned<FitUnknown>>>>,
    /// Whether the scatter of the measurements is relative to their size.
    #[serde(default)]
    pub noise: Option<Noise>,
    /// Confidence of the intervals, 0.95 if left out.
    #[serde(default)]
    pub confidence: Option<Spanned<f64>>,
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum FitUnknown {
    Adhesion,
    Tension,
}

#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Noise {
    #[default]
    Relative,
    Absolute,
}

/// A named system of units, or the names of the base units.
#[derive(Clone, Debug)]
pub enum UnitsKey {
    System(String),
    Base(BaseUnits),
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BaseUnits {
    pub length: String,
    pub force: String,
    #[serde(default = "second")]
    pub time: String,
}

fn second() -> String {
    "s".into()
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

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Space {
    /// A string: one coordinate, x.
    Line,
    /// A round membrane: x is the radius.
    Axisymmetric,
    /// A membrane seen from above.
    Plane,
    PlaneStrain,
    PlaneStress,
    #[serde(rename = "3d")]
    ThreeD,
}

/// A function of one argument: a table, or an expression in `t`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FunctionKey {
    #[serde(default)]
    pub table: Option<Spanned<Table>>,
    #[serde(default)]
    pub expression: Option<Value>,
}

/// A piecewise linear function.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Table {
    pub t: Vec<f64>,
    pub value: Vec<f64>,
}

/// Things that occupy space.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Body {
    Membrane(Membrane),
    Rigid(Rigid),
    /// Elastic solids by finite elements.
    Solid(Solid),
    /// Solids on a background grid: implicit shapes, surfaces, images.
    Cells(toml::Table),
    Rope(toml::Table),
    Beam(toml::Table),
}

/// An elastic solid.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Solid {
    pub mesh: Spanned<SolidMesh>,
    /// Polynomial degree: 1 to 8 on quadrilaterals and hexahedra, 1 or 2 on other cells.
    #[serde(default)]
    pub degree: Option<Spanned<i64>>,
    pub material: Spanned<Material>,
    /// `small`, or `finite`.
    #[serde(default)]
    pub strain: Option<Spanned<String>>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SolidMesh {
    Box(BoxKey),
    Gmsh(GmshKey),
    Nurbs(toml::Table),
}

/// A box of cells: even between two corners, or graded along axes; every point may be moved by a map.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoxKey {
    #[serde(default)]
    pub min: Option<Values>,
    #[serde(default)]
    pub max: Option<Values>,
    #[serde(default)]
    pub cells: Option<Spanned<Vec<Spanned<i64>>>>,
    #[serde(default)]
    pub axes: Option<Spanned<Vec<Spanned<AxisKey>>>>,
    /// Expressions of x, y and z for the place of every point.
    #[serde(default)]
    pub map: Option<Values>,
}

/// One direction of a box: stretches that end at `to`, with so many cells, each `growth` times the one before.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AxisKey {
    pub from: Value,
    pub to: Values,
    pub cells: Spanned<Vec<Spanned<i64>>>,
    #[serde(default)]
    pub growth: Option<Spanned<Vec<f64>>>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Material {
    LinearElastic(ElasticKey),
    NeoHooke(toml::Table),
    SaintVenantKirchhoff(toml::Table),
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ElasticKey {
    pub youngs_modulus: Value,
    pub poissons_ratio: Value,
}

/// A film under tension.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Membrane {
    #[serde(default)]
    pub domain: Option<Spanned<Domain>>,
    pub mesh: Spanned<Mesh>,
    /// Polynomial degree, 1 to 6.
    #[serde(default)]
    pub degree: Option<Spanned<i64>>,
    /// Force per length; a value or an expression of position.
    pub tension: Value,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Domain {
    Disc(Disc),
    Ellipse(EllipseKey),
    Rectangle(Rectangle),
    Polygon(Polygon),
    Implicit(Implicit),
    Interval(Interval),
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Disc {
    pub radius: Value,
    #[serde(default)]
    pub center: Option<Values>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EllipseKey {
    pub semi_axes: Values,
    #[serde(default)]
    pub center: Option<Values>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rectangle {
    pub min: Values,
    pub max: Values,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Polygon {
    pub points: Spanned<Vec<Values>>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Implicit {
    pub negative_inside: Value,
    pub min: Values,
    pub max: Values,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Interval {
    pub from: Value,
    pub to: Value,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Mesh {
    Grid(GridKey),
    Gmsh(GmshKey),
}

/// A background grid: a number of cells in each direction, or their size.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GridKey {
    #[serde(default)]
    pub cells: Option<Spanned<Vec<Spanned<i64>>>>,
    #[serde(default)]
    pub cell_size: Option<Value>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GmshKey {
    pub file: Spanned<String>,
    #[serde(default)]
    pub group: Option<String>,
}

/// A body that does not deform.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rigid {
    pub shape: Spanned<Shape>,
    #[serde(default)]
    pub side: Option<Spanned<Side>>,
    #[serde(default)]
    pub motion: Option<Spanned<Motion>>,
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    Outside,
    Inside,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// A floor seen from above: its height as an expression of x and y.
    Height(Value),
    Plane(PlaneKey),
    Sphere(SphereKey),
    Cylinder(CylinderKey),
    Cone(ConeKey),
    Ellipsoid(EllipsoidKey),
    Torus(TorusKey),
    Paraboloid(ParaboloidKey),
    Nurbs(FileKey),
    Stl(FileKey),
    HeightMap(HeightMapKey),
    LevelSet(LevelSetShapeKey),
}

/// Heights on a grid, from a file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HeightMapKey {
    pub file: Spanned<String>,
    /// Distance of the columns (along x) and of the rows (along y).
    pub spacing: Values,
    /// Where the first height is.
    #[serde(default)]
    pub origin: Option<Values>,
    /// The height that one unit of the file stands for.
    #[serde(default)]
    pub scale: Option<Value>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlaneKey {
    pub point: Values,
    pub normal: Values,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SphereKey {
    pub center: Values,
    pub radius: Value,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CylinderKey {
    pub point: Values,
    /// In the plane a cylinder stands across it.
    #[serde(default)]
    pub axis: Option<Values>,
    pub radius: Value,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ConeKey {
    pub apex: Values,
    /// Into the body.
    pub axis: Values,
    /// In radians.
    pub half_angle: Value,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EllipsoidKey {
    pub center: Values,
    pub semi_axes: Values,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TorusKey {
    pub center: Values,
    pub axis: Values,
    pub major_radius: Value,
    pub minor_radius: Value,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ParaboloidKey {
    pub apex: Values,
    /// Into the body.
    pub axis: Values,
    /// Of curvature at the apex.
    pub radius: Value,
}

/// A body where an expression of x, y and z is negative, within a box.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LevelSetShapeKey {
    pub negative_inside: Value,
    pub min: Values,
    pub max: Values,
    /// Cells of the grid from which closest points are searched, along the longest side; 64 if left out.
    #[serde(default)]
    pub cells: Option<Spanned<i64>>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FileKey {
    pub file: Spanned<String>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Motion {
    Fixed(Nothing),
    Prescribed(Prescribed),
    Free(Nothing),
}

/// A table without keys.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Nothing {}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Prescribed {
    #[serde(default)]
    pub displacement: Option<Values>,
    #[serde(default)]
    pub rotation: Option<Values>,
}

/// Where something is held or moved.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Support {
    /// `BODY` or `BODY:GROUP`.
    pub on: Spanned<String>,
    /// A value for a membrane, a vector with `"free"` where free for a solid.
    #[serde(default)]
    pub displacement: Option<Spanned<OneOrMany>>,
    /// The displacement along the outward normal alone.
    #[serde(default)]
    pub normal: Option<Value>,
    /// All points share one displacement in the components that are not prescribed.
    #[serde(default)]
    pub uniform: Option<Spanned<bool>>,
    /// Stiffness per area of an elastic bed.
    #[serde(default)]
    pub spring: Option<Values>,
}

/// What pushes.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Load {
    pub on: Spanned<String>,
    /// Force per area along +z for a membrane.
    #[serde(default)]
    pub normal: Option<Value>,
    #[serde(default)]
    pub traction: Option<Values>,
    #[serde(default)]
    pub pressure: Option<Value>,
    #[serde(default)]
    pub force: Option<Values>,
    #[serde(default)]
    pub body_force: Option<Values>,
}

/// Who may touch whom.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// Two bodies, the one whose points are tested first.
    #[serde(default)]
    pub between: Option<Spanned<Vec<Spanned<String>>>>,
    #[serde(default)]
    pub within: Option<Spanned<String>>,
    #[serde(default)]
    pub all: Option<Spanned<bool>>,
    #[serde(default)]
    pub method: Option<Spanned<Method>>,
    /// How far solids slide along each other: little, or any way.
    #[serde(default)]
    pub sliding: Option<Spanned<Sliding>>,
    #[serde(default)]
    pub adhesion: Option<Adhesion>,
    #[serde(default)]
    pub friction: Option<Spanned<toml::Table>>,
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Sliding {
    Small,
    Finite,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    InequalityLevelSet(LevelSetKey),
    ActiveSet(ActiveSetKey),
    Mortar(EnforcedKey),
    GaussPoint(EnforcedKey),
    Node(EnforcedKey),
}

#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LevelSetKey {
    #[serde(default)]
    pub formulation: Option<Spanned<String>>,
    #[serde(default)]
    pub modes: Option<Spanned<String>>,
    #[serde(default)]
    pub front_degree: Option<Spanned<i64>>,
    /// Where the search for the zone begins, in the shapes of a domain.
    #[serde(default)]
    pub initial_zone: Option<Spanned<Domain>>,
}

#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EnforcedKey {
    #[serde(default)]
    pub enforcement: Option<Spanned<Enforcement>>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Enforcement {
    Multiplier(Nothing),
    AugmentedLagrangian(Nothing),
    Nitsche(Nothing),
    Penalty(PenaltyKey),
}

/// A penalty is stated by what it may leave, never as a number of its own.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PenaltyKey {
    #[serde(default)]
    pub wanted_penetration: Option<Value>,
}

#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ActiveSetKey {
    #[serde(default)]
    pub start: Option<Spanned<ActiveSetStart>>,
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum ActiveSetStart {
    Nested,
    Cold,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Adhesion {
    /// Energy per area.
    pub energy: Value,
}

/// A part of the history.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Step {
    /// Time at its end.
    pub to: Value,
    #[serde(default)]
    pub increments: Option<Spanned<i64>>,
    #[serde(default)]
    pub control: Option<Spanned<Control>>,
    #[serde(default)]
    pub events: Option<Spanned<f64>>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Control {
    Time(Nothing),
    /// Along the path of equilibria, through its folds.
    ArcLength(ArcKey),
    Area(AreaKey),
}

/// A step along a path of equilibria.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ArcKey {
    /// Length of an increment, where the area of the membrane and the time that the step takes have length one.
    pub size: Spanned<f64>,
}

/// A step in which the area of contact is given, and the time at which it is reached is sought.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AreaKey {
    /// Name of the contact.
    pub of: Spanned<String>,
    pub to: Value,
}

/// What to write.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Increments between written fields.
    #[serde(default)]
    pub every: Option<Spanned<i64>>,
    #[serde(default)]
    pub pictures: Option<bool>,
    /// Points whose histories are recorded.
    #[serde(default)]
    pub probes: BTreeMap<String, Values>,
}
