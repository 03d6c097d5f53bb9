//! Contacts: who may touch whom, by which method, with which law.

use super::body::Domain;
use super::{Components, ContactHeat, List, Nothing, Value};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A contact between bodies.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// The two bodies. Contact forces are told as they act on the first.
    pub between: Option<List<String>>,
    /// The body of `between` whose points are tested, and whose faces carry the pressure. If left out, the program chooses: the
    /// side with the smaller modulus over the distance of its nodes; the first body where it wears, is tied, or carries an axis
    /// of friction.
    pub slave: Option<String>,
    /// The rope, beam or solid that is in contact with itself.
    pub self_contact: Option<String>,
    /// Whether contact is possible between all bodies.
    pub all: Option<bool>,
    /// Contact discretisation. If left out, it is chosen by the kinds of the bodies.
    pub method: Option<Method>,
    /// Sliding of solids on each other and on rigid bodies; any distance if left out.
    pub sliding: Option<Sliding>,
    /// Whether the surfaces are tied: glued in all directions for ever, where they are near each other at the start. Gaps of the
    /// mesh stay as they are.
    pub tied: Option<bool>,
    /// Distance at the start up to which surfaces are tied, a length; a tenth of the size of a face of the slave if left out.
    pub tie_distance: Option<Value>,
    /// Adhesion of the surfaces: they attract each other as they close and as they part.
    pub adhesion: Option<Adhesion>,
    /// Cohesion of solids: what touches at the start is bonded until the bond breaks.
    pub cohesion: Option<Cohesion>,
    /// Rough surfaces of solids: the pressure as a function of the gap. If left out, bodies do not penetrate each other.
    pub compliance: Option<Compliance>,
    /// Friction law; frictionless if left out.
    pub friction: Option<Friction>,
    /// Coefficient of restitution of rigid bodies that strike, from 0 to 1; 0 if left out.
    pub restitution: Option<f64>,
    /// Wear of solids by Archard's law: the depth that is worn off per pressure and slip, one over a pressure.
    pub wear: Option<Value>,
    /// Heat through the contact, and that of its friction; no heat if left out.
    pub heat: Option<ContactHeat>,
}

/// Surfaces that hold each other with a traction which falls with the opening, until an energy is spent.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cohesion {
    /// The largest traction against opening, a force per area.
    pub strength: Value,
    /// Energy of separation, an energy per area.
    pub energy: Value,
    /// The largest traction along the surface; as `strength` if left out. The energy is the same.
    pub shear_strength: Option<Value>,
    /// How the traction falls; `linear` if left out.
    pub softening: Option<SofteningKey>,
    /// Opening at which the strength is reached, a length; 0 if left out: the bond is rigid until it begins to break.
    pub opening: Option<Value>,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum SofteningKey {
    /// In proportion to the opening.
    Linear,
    /// Exponentially with the opening.
    Exponential,
}

/// The pressure of rough surfaces.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Compliance {
    /// A pressure at any gap, which falls exponentially.
    Exponential(ExponentialCompliance),
    /// A power of the penetration.
    Power(PowerCompliance),
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExponentialCompliance {
    /// The pressure where the gap is zero.
    pub pressure: Value,
    /// The gap over which the pressure falls to 1/e, a length.
    pub length: Value,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PowerCompliance {
    /// The pressure at the penetration given.
    pub pressure: Value,
    /// The penetration at which this pressure acts, a length.
    pub penetration: Value,
    /// Exponent of the penetration, 1 or more; 1 if left out.
    pub exponent: Option<Value>,
}

/// Friction laws.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Friction {
    /// Coulomb friction: the limit is proportional to the pressure.
    Coulomb(CoulombFriction),
    /// Tresca friction: the limit does not depend on the pressure.
    Tresca(TrescaFriction),
    /// Coulomb friction, regularised by the slip velocity. There is no stick; contact points creep.
    Viscous(ViscousFriction),
    /// Rate-and-state friction of Dieterich and Ruina, regularised at rest. Only for solids and finite cells, and for rigid bodies
    /// in contact with them. There is no stick; contact points creep.
    RateAndState(RateAndStateFriction),
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RateAndStateFriction {
    /// Coefficient of friction of steady slip at `velocity`.
    pub mu: Value,
    /// Direct effect: change of the coefficient per logarithm of the velocity at a constant state.
    pub a: Value,
    /// Effect of the state: change of the coefficient per logarithm of the state. Steady friction falls with the velocity if it is
    /// larger than `a`.
    pub b: Value,
    /// Reference velocity, a length per time.
    pub velocity: Value,
    /// Slip over which the state changes, a length.
    pub distance: Value,
    /// How the state changes; `aging` if left out.
    pub evolution: Option<StateEvolution>,
    /// State at the start, a time; that of steady slip at `velocity` if left out.
    pub state: Option<Value>,
}

/// How the state of rate-and-state friction changes.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum StateEvolution {
    /// With time also at rest (Dieterich).
    Aging,
    /// By slip alone (Ruina).
    Slip,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ViscousFriction {
    /// Coefficient of friction at high slip velocities.
    pub mu: Value,
    /// Slip velocity at which 0.71 of the friction limit is reached, a length per time.
    pub velocity: Value,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CoulombFriction {
    /// Coefficient of friction; a single one may be an expression of `t`. In space two if it depends on the direction: along
    /// `axis` and across it.
    pub mu: Components,
    /// Direction of the first of two coefficients, projected on the surface. `"tangent"` is the direction along a rope
    /// or beam.
    pub axis: Option<Components>,
    /// The side to which the axis is attached; `slave` if left out.
    pub on: Option<AxisOn>,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum AxisOn {
    /// The slave, the first body of the contact.
    Slave,
    /// The master, the second body.
    Master,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TrescaFriction {
    /// Friction limit, a force per area.
    pub limit: Value,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Sliding {
    /// The sliding distance is much smaller than a cell: gap and slip are linear in the displacements. For contact by mortar
    /// between solids of small strain, and of these with rigid bodies that do not move freely.
    Small,
    /// Any sliding distance: gap and slip are measured in the current configuration.
    Finite,
}

#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// For membranes: the contact zone as a level set with exact fronts.
    InequalityLevelSet(Box<LevelSetMethod>),
    /// For membranes: the classical nodal active set method, of degree 1.
    ActiveSet(ActiveSetMethod),
    /// Between solids, or of a solid with a rigid body: mortar with dual multipliers, integrated over exact segments.
    Mortar(SolidMethod),
    /// At quadrature points.
    GaussPoint(SolidMethod),
    /// At nodes.
    Node(SolidMethod),
    /// For ropes and beams: at the nodes of straight elements, at Gauss points of smooth elements. Between two of them,
    /// at crossing points and along lines.
    Curve(CurveMethod),
    /// For finite cells: at points of the recovered boundary.
    CellSurface(SolidMethod),
    /// For finite cells, or self-contact of them: discs (in space balls) on both surfaces, which repel each other.
    Discs(DiscMethod),
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DiscMethod {
    /// Radius of the discs, a length; the spacing if left out. At least half the spacing, so that no disc slips
    /// through, and less than half the thickness of the material.
    pub radius: Option<Value>,
    /// Smallest distance between discs, a length. If left out, half of the radius; without a radius, the distance that
    /// the functions can resolve.
    pub spacing: Option<Value>,
    /// Position of the disc centres; `within` if left out.
    pub centres: Option<DiscCentres>,
    /// Penalty between discs. If left out, a hundred times the stiffness of the bodies.
    pub penalty: Option<Penalty>,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum DiscCentres {
    /// One radius below the surface. The surfaces themselves come into contact.
    Within,
    /// On the surface, as published. Bodies are in contact one radius too early each.
    OnBoundary,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LevelSetMethod {
    /// Formulation of the equilibrium next to a contact zone; `one_sided` if left out.
    pub formulation: Option<FormulationKey>,
    /// With `formulation = "published"`: function space of the multiplier in the contact zone; `h1` if left out.
    pub multiplier: Option<ZoneMultiplierKey>,
    /// With `multiplier = "h1"`: length that weights the gradients of the multiplier; the size of the membrane if left
    /// out.
    pub multiplier_length: Option<Value>,
    /// With `formulation = "published"`: transport of the fronts; `exact` if left out.
    pub transport: Option<TransportKey>,
    /// Functions that describe the motion of fronts; `local` if left out, `fourier` with `formulation = "published"`.
    pub modes: Option<FrontModes>,
    /// With `modes = "fourier"`: maximum number of modes per front. If the cells of a front resolve fewer, fewer are
    /// used, with a warning.
    pub mode_count: Option<i64>,
    /// Polynomial degree of the fronts; not available. The fronts have the degree of the membrane.
    pub front_degree: Option<i64>,
    /// Initial contact zone of the iteration, given as a domain.
    pub initial_zone: Option<Domain>,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum FormulationKey {
    /// Only the free part of the membrane is solved for; Nitsche's method prescribes its displacement on the front. Any
    /// degree and any load path.
    OneSided,
    /// Both sides of the front with multipliers, as published: degree 1 in the plane, 1 to 6 on a line or an
    /// axisymmetric membrane.
    Published,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum ZoneMultiplierKey {
    /// With gradients (H1). It carries the line force along a front that is not in equilibrium.
    H1,
    /// Without gradients (L2). It oscillates along such a front; for comparison.
    L2,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum TransportKey {
    /// As curves.
    Exact,
    /// As a level set on the nodes, reinitialised to the distance to the moved front.
    Redistancing,
    /// As a level set on the nodes, transported by the Hamilton-Jacobi equation.
    HamiltonJacobi,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum FrontModes {
    /// Periodic splines with local support, for fronts of any shape.
    Local,
    /// Sines and cosines of the arc length. A few are sufficient for nearly circular fronts.
    Fourier,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SolidMethod {
    /// Enforcement of the contact conditions. If left out: `multiplier`; `penalty` at quadrature points; `nitsche` for
    /// finite cells.
    pub enforcement: Option<Enforcement>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CurveMethod {
    /// Enforcement of the contact conditions. If left out, `augmented_lagrangian` between two curves.
    pub enforcement: Option<Enforcement>,
    /// Contact between two curves: at crossing points, along lines, or blended; `blend` if left out.
    pub form: Option<CurveForm>,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum CurveForm {
    /// A point force at each closest point.
    Point,
    /// A line load at Gauss points of the first curve.
    Line,
    /// Both, blended by how well the curves are aligned.
    Blend,
}

#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Enforcement {
    /// Lagrange multipliers. The contact conditions hold exactly.
    Multiplier(Nothing),
    /// Penalties with updated multipliers. The contact conditions hold exactly.
    AugmentedLagrangian(Nothing),
    /// Nitsche's method: consistent, without multipliers.
    Nitsche(Nothing),
    /// Penalties. The contact conditions hold approximately.
    Penalty(Penalty),
}

/// A penalty is given by the penetration that it admits, not by a stiffness.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Penalty {
    /// Penetration at the largest pressure, a length.
    pub penetration: Option<Value>,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ActiveSetMethod {
    /// Initial state of the iteration; `nested` if left out.
    pub start: Option<ActiveSetStart>,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum ActiveSetStart {
    /// The solution on a coarser grid.
    Nested,
    /// The membrane without contact.
    Cold,
}

#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Adhesion {
    /// Adhesion energy, an energy per area.
    pub energy: Value,
    /// For solids: the largest attraction, a force per area. Membranes adhere at the front of the zone.
    pub strength: Option<Value>,
    /// For solids: how the attraction falls with the gap; `linear` if left out.
    pub softening: Option<SofteningKey>,
}
