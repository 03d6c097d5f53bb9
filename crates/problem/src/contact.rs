//! Contacts: who may touch whom, by which method, with which law.

use super::body::Domain;
use super::{Components, List, Nothing, Value};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Who may touch whom.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// Two bodies, the one whose points are tested first.
    pub between: Option<List<String>>,
    /// A rope, beam or solid that may touch itself.
    pub within: Option<String>,
    /// Whether all bodies may touch each other.
    pub all: Option<bool>,
    /// How the contact is found; what fits the bodies if left out.
    pub method: Option<Method>,
    /// How far solids slide along each other: little, or any way.
    pub sliding: Option<Sliding>,
    /// What the surfaces hold each other with.
    pub adhesion: Option<Adhesion>,
    /// What resists sliding, between solids; none if left out.
    pub friction: Option<Friction>,
}

/// Laws of friction.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Friction {
    /// In proportion to the pressure.
    Coulomb(CoulombFriction),
    /// Up to a limit, whatever the pressure.
    Tresca(TrescaFriction),
    /// In proportion to the pressure, regularised by the velocity of slip: nothing sticks, it creeps.
    Viscous(ViscousFriction),
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ViscousFriction {
    /// The coefficient at high velocities.
    pub mu: Value,
    /// The velocity of slip at which 0.71 of it acts, a length per time.
    pub velocity: Value,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CoulombFriction {
    /// The coefficient; in space two where it depends on the direction: along `axis`, and across it.
    pub mu: Components,
    /// The first direction of two coefficients, projected on the surface; `"tangent"` is along a rope or beam.
    pub axis: Option<Components>,
    /// Which side carries the axis, `slave` if left out; while bodies slide little it is the same.
    pub on: Option<AxisOn>,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum AxisOn {
    /// The first body of the contact.
    Slave,
    /// The second one.
    Master,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TrescaFriction {
    /// The largest friction, a force per area.
    pub limit: Value,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Sliding {
    /// Bodies slide by much less than a cell.
    Small,
    /// Bodies slide as far as they like.
    Finite,
}

#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// The contact zone of a membrane as a level set with exact fronts.
    InequalityLevelSet(Box<LevelSetMethod>),
    /// The classical nodal method for a membrane, of degree 1.
    ActiveSet(ActiveSetMethod),
    /// Between solids: dual multipliers, integrated over exact segments.
    Mortar(SolidMethod),
    /// Between solids: at quadrature points.
    GaussPoint(SolidMethod),
    /// Between solids: at nodes.
    Node(SolidMethod),
    /// Of ropes and beams: at nodes of straight elements, at points of Gauss of smooth ones; between two of them where they
    /// cross and along lines.
    Curve(CurveMethod),
    /// Of finite cells: at points of the recovered boundary.
    CellSurface(SolidMethod),
    /// Of finite cells, or within a body of them: discs, in space balls, on both surfaces that repel each other.
    DiscreteCell(DiscMethod),
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DiscMethod {
    /// Radius of the discs, a length: half of their spacing at least, so that none slips through, and less than half of the
    /// thickness of the material; the spacing if left out.
    pub radius: Option<Value>,
    /// Least distance of discs, a length; half of the radius if left out, and without a radius what the functions can
    /// follow.
    pub spacing: Option<Value>,
    /// Where their centres are; `within` if left out.
    pub centres: Option<DiscCentres>,
    /// How hard they are; a hundred times as stiff as the bodies if left out.
    pub penalty: Option<Penalty>,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum DiscCentres {
    /// A radius below the surface, so that surfaces touch where they are.
    Within,
    /// On the surface, as published: bodies touch a radius each too early.
    OnBoundary,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LevelSetMethod {
    /// How the equilibrium beside a contact zone is formulated; `one_sided` if left out.
    pub formulation: Option<FormulationKey>,
    /// With `formulation = "published"`, the space of the multiplier in the contact zone; `h1` if left out.
    pub multiplier: Option<ZoneMultiplierKey>,
    /// With `multiplier = "h1"`, the length that weighs its gradients; the extent of the membrane if left out.
    pub multiplier_length: Option<Value>,
    /// With `formulation = "published"`, how fronts are moved; `exact` if left out.
    pub transport: Option<TransportKey>,
    /// The functions by which fronts move; `local` if left out, `fourier` in the published formulation.
    pub modes: Option<FrontModes>,
    /// With `modes = "fourier"`, how many of them each front has at most; where its cells tell fewer apart it has these, and the
    /// run says so.
    pub mode_count: Option<i64>,
    /// Degree of the fronts as curves; not available, it follows the degree of the membrane.
    pub front_degree: Option<i64>,
    /// Where the search for the zone begins, in the shapes of a domain.
    pub initial_zone: Option<Domain>,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum FormulationKey {
    /// The free membrane alone, held along the front by Nitsche's method: any degree, any path.
    OneSided,
    /// Both sides of the front with multipliers, as the method was published: degree 1 in the plane, 1 to 6 along a line or a
    /// radius.
    Published,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum ZoneMultiplierKey {
    /// With gradients: carries the line force along a front that is not at rest.
    H1,
    /// Without: oscillates along such a front, to show why not.
    L2,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum TransportKey {
    /// As curves.
    Exact,
    /// As a level set on the nodes, which becomes the distance to the moved front.
    Redistancing,
    /// As a level set on the nodes, carried along by the equation of Hamilton and Jacobi.
    HamiltonJacobi,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum FrontModes {
    /// Periodic splines, each of which moves a short piece: for fronts of any shape.
    Local,
    /// Sines and cosines of the arc length: few suffice where fronts are nearly circles.
    Fourier,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SolidMethod {
    /// How the conditions of contact are enforced; by multipliers if left out, at quadrature points by
    /// penalties, of cells after Nitsche.
    pub enforcement: Option<Enforcement>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CurveMethod {
    /// How the conditions of contact are enforced: between two curves by repeated penalties if left out.
    pub enforcement: Option<Enforcement>,
    /// Between two curves: forces where they cross, along lines, or both as they lie; both if left out.
    pub form: Option<CurveForm>,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum CurveForm {
    /// A force at each least distance.
    Point,
    /// Forces at points of Gauss of the first curve.
    Line,
    /// Both, by how far the curves lie along each other.
    Blend,
}

#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Enforcement {
    /// Exactly, by multipliers.
    Multiplier(Nothing),
    /// Exactly, by repeated penalties.
    AugmentedLagrangian(Nothing),
    /// Weakly and consistently, without multipliers.
    Nitsche(Nothing),
    /// Approximately, by springs.
    Penalty(Penalty),
}

/// A penalty is stated by what it may leave, never as a number of its own.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Penalty {
    /// The penetration to be left at the largest pressure, a length.
    pub wanted_penetration: Option<Value>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ActiveSetMethod {
    /// Where the iteration begins; `nested` if left out.
    pub start: Option<ActiveSetStart>,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum ActiveSetStart {
    /// From the solution on a coarser grid.
    Nested,
    /// From the membrane without contact.
    Cold,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Adhesion {
    /// Energy per area.
    pub energy: Value,
}
