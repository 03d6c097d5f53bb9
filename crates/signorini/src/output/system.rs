//! A state of a system of bodies as it is shown: fields of the bodies, points of the contacts.

use crate::fields::{FieldArray, Fields};
use crate::plan::mechanics::{Kind, MechanicsPlan};
use crate::problem::Body;
use crate::report::Carried;
use crate::report::vector;
use signorini_contact::{GapJet, Status};
use signorini_fem::CellShape;
use signorini_geometry::Vector;
use signorini_mechanics::{BodyFields, BodyState, IncrementResult, SiteResult, SystemState, rigid_body};
use signorini_paths::darboux::{Darboux, of_points};
use std::sync::Arc;

/// Rigid bodies are shown this far beyond the others, as a part of their largest extent.
pub const AROUND: f64 = 0.15;

/// A rope or beam as it is shown.
#[derive(Clone)]
pub struct CurveShown {
    pub name: String,
    pub radius: f64,
    /// Places of its points now, and length along it.
    pub points: Vec<Vector<3>>,
    pub arc: Vec<f64>,
    pub cells: Vec<[u32; 2]>,
    /// Axial force of each piece that is shown, and the number of cells.
    pub forces: Vec<f64>,
    pub elements: usize,
    /// Whether it carries tension only.
    pub is_rope: bool,
    /// Bending moment, shear force and torque of its points, where it has them: their sizes, the torque with its sign.
    pub bending_moments: Vec<f64>,
    pub shear_forces: Vec<f64>,
    pub torques: Vec<f64>,
    /// Length without tension, of a rope of straight elements.
    pub unstrained_length: Option<f64>,
}

/// A rigid body where it is.
#[derive(Clone)]
pub struct RigidShown {
    pub name: String,
    pub gap: Arc<dyn Fn(&Vector<3>) -> GapJet<3> + Send + Sync>,
    /// Its extent where it has one.
    pub size: f64,
    pub centre: Vector<3>,
    pub is_free: bool,
}

/// A contact as it is shown: its tested points.
#[derive(Clone)]
pub struct ContactShown {
    pub fields: Fields,
    pub carries: Carried,
}

/// A state as it is shown.
#[derive(Clone)]
pub struct SystemShown {
    pub time: f64,
    pub bodies: Vec<Fields>,
    pub contacts: Vec<ContactShown>,
    pub curves: Vec<CurveShown>,
    pub rigid: Vec<RigidShown>,
}

impl SystemShown {
    pub fn new(plan: &MechanicsPlan, state: &SystemState, result: &IncrementResult, time: f64) -> Self {
        let mut shown = SystemShown { time, ..Self::of_bodies(plan, &state.bodies) };
        for ((contact, tested), sites) in plan.system.contacts.iter().zip(&plan.contacts).zip(&result.sites) {
            let fields = of_contact(contact.name(), sites, contact.law().is_some(), tested.along_a_curve);
            let carries = tested.carries;
            shown.contacts.push(ContactShown { fields, carries });
        }
        shown
    }

    /// The bodies without their contacts.
    pub fn of_bodies(plan: &MechanicsPlan, state: &[BodyState]) -> Self {
        let mut shown =
            SystemShown { time: 0.0, bodies: Vec::new(), contacts: Vec::new(), curves: Vec::new(), rigid: Vec::new() };
        for ((body, kind), state) in plan.system.bodies.iter().zip(&plan.kinds).zip(state) {
            match kind {
                Kind::Curve { radius } => {
                    let fields = body.fields(state);
                    let is_rope = matches!(plan.head.problem.bodies.get(body.name()), Some(Body::Rope(_)));
                    shown.curves.push(CurveShown { is_rope, ..curve(body.name(), *radius, &fields) });
                    shown.bodies.push(of_body(body.name(), &fields));
                }
                Kind::Solid | Kind::Cells => shown.bodies.push(of_body(body.name(), &body.fields(state))),
                Kind::Rigid { shape, centre, is_free } => {
                    let pose = rigid_body::Pose::of(state);
                    let (rotation, shape, origin, now) = (pose.matrix(), Arc::clone(shape), *centre, pose.centre);
                    let gap = move |x: &Vector<3>| {
                        let found = shape.gap(&(origin + rotation.transpose() * (x - now)));
                        GapJet {
                            gap: found.gap,
                            normal: rotation * found.normal,
                            hessian: rotation * found.hessian * rotation.transpose(),
                        }
                    };
                    shown.rigid.push(RigidShown {
                        name: body.name().to_string(),
                        gap: Arc::new(gap),
                        size: body.size(),
                        centre: now,
                        is_free: *is_free,
                    });
                }
            }
        }
        shown
    }

    /// The bodies that are no curves.
    pub fn solids(&self) -> impl Iterator<Item = &Fields> {
        self.bodies.iter().filter(|b| b.cells.iter().all(|c| c.1.len() > 2))
    }

    /// The corners of the box of what is shown, without bodies that reach beyond it.
    pub fn bounds(&self) -> [Vector<3>; 2] {
        let mut points: Vec<Vector<3>> = Vec::new();
        for c in &self.curves {
            let pad = Vector::<3>::repeat(c.radius);
            points.extend(c.points.iter().flat_map(|x| [x - pad, x + pad]));
        }
        points.extend(self.solids().flat_map(moved));
        let alone = points.is_empty();
        for r in self.rigid.iter().filter(|r| r.is_free || alone) {
            let pad = Vector::<3>::repeat(0.5 * r.size);
            points.extend([r.centre - pad, r.centre + pad]);
        }
        super::solid_state::bounds(points.iter())
    }

    /// The same with room for rigid bodies around.
    pub fn room(&self) -> [Vector<3>; 2] {
        let [low, high] = self.bounds();
        let pad = Vector::<3>::repeat(AROUND * (high - low).max());
        [low - pad, high + pad]
    }
}

/// The points of a body where they are now.
pub fn moved(fields: &Fields) -> Vec<Vector<3>> {
    let u = fields.array("displacement").unwrap_or_default();
    fields
        .points
        .iter()
        .zip(u.chunks(3))
        .map(|(x, u)| Vector::<3>::from(*x) + Vector::<3>::from_column_slice(u))
        .collect()
}

impl CurveShown {
    /// Cells without tension, of a rope.
    pub fn slack_cells(&self) -> usize {
        let pieces = self.forces.len() / self.elements.max(1);
        let slack = self.forces.iter().filter(|t| self.is_rope && **t == 0.0).count();
        slack / pieces.max(1)
    }
}

fn curve(name: &str, radius: f64, fields: &BodyFields) -> CurveShown {
    let cell = |name: &str| fields.cell_data.iter().find(|d| d.0 == name).map(|d| d.2.clone());
    let arc = fields.point_data.iter().find(|d| d.0 == "arc_length").map(|d| d.2.clone());
    let size = |values: &[f64]| values.iter().map(|v| v * v).sum::<f64>().sqrt();
    let sizes = |name: &str| -> Vec<f64> {
        let found = fields.point_data.iter().find(|d| d.0 == name);
        found.map_or_else(Vec::new, |(_, components, values)| values.chunks(*components).map(size).collect())
    };
    CurveShown {
        name: name.to_string(),
        radius,
        points: fields.points.iter().zip(&fields.displacement).map(|(x, u)| x + u).collect(),
        arc: arc.unwrap_or_default(),
        cells: fields.cells.iter().map(|c| [c[0], c[1]]).collect(),
        forces: cell("tension").or_else(|| cell("axial_force")).unwrap_or_default(),
        elements: cell("element").map_or(0, |list| list.last().map_or(0, |e| *e as usize + 1)),
        is_rope: false,
        bending_moments: sizes("bending_moment"),
        shear_forces: sizes("shear_force"),
        torques: fields.point_data.iter().find(|d| d.0 == "torque").map(|d| d.2.clone()).unwrap_or_default(),
        unstrained_length: cell("unstrained_length").map(|list| list.iter().sum()),
    }
}

/// Names of arrays as files of fields have them.
const NAMES: [&str; 8] =
    ["tension", "axial_force", "shear_force", "torque", "bending_moment", "arc_length", "element", "von_mises"];
/// What solids call their stress, and what files of fields do.
pub(super) const STRESS: [&str; 2] = ["stress", "stress_xx_yy_zz_xy_yz_xz"];

fn of_body(name: &str, fields: &BodyFields) -> Fields {
    let shape = |corners: usize| match corners {
        2 => Some(CellShape::Line),
        3 => Some(CellShape::Triangle),
        4 => Some(CellShape::Quadrilateral),
        8 => Some(CellShape::Hexahedron),
        _ => None,
    };
    let mut out = Fields {
        name: name.into(),
        points: fields.points.iter().map(vector).collect(),
        cells: fields.cells.iter().map(|c| (shape(c.len()), c.clone())).collect(),
        arrays: Vec::new(),
    }
    .vector("displacement", fields.displacement.iter().flat_map(vector).collect());
    let known = |name: &str| if name == STRESS[0] { Some(STRESS[1]) } else { NAMES.into_iter().find(|n| *n == name) };
    for (name, components, values) in &fields.point_data {
        if let Some(name) = known(name) {
            out.arrays.push(FieldArray { name, components: *components, values: values.clone() });
        }
    }
    // Values of cells as means of those around each point.
    for (name, components, values) in &fields.cell_data {
        let Some(name) = known(name) else { continue };
        let mut sums = vec![0.0; fields.points.len() * components];
        let mut counts = vec![0.0f64; fields.points.len()];
        for (cell, own) in fields.cells.iter().zip(values.chunks(*components)) {
            for &p in cell {
                counts[p as usize] += 1.0;
                own.iter().enumerate().for_each(|(k, v)| sums[p as usize * components + k] += v);
            }
        }
        let values = sums.iter().enumerate().map(|(k, s)| s / counts[k / components].max(1.0)).collect();
        out.arrays.push(FieldArray { name, components: *components, values });
    }
    out
}

/// The tested points of a contact. Of a curve, neighbours are joined by lines, and its curvature is told along and across
/// the normal of what it touches.
fn of_contact(name: &str, sites: &[SiteResult], rubs: bool, is_curve: bool) -> Fields {
    let status = |s: &SiteResult| f64::from(u8::from(s.status != Status::Open));
    let cells = if is_curve {
        (1..sites.len() as u32).map(|k| (Some(CellShape::Line), vec![k - 1, k])).collect()
    } else {
        Vec::new()
    };
    let mut fields =
        Fields { name: name.into(), points: sites.iter().map(|s| vector(&s.x)).collect(), cells, arrays: Vec::new() }
            .scalar("contact_pressure", sites.iter().map(|s| s.shown_pressure()).collect())
            .scalar("gap", sites.iter().map(|s| s.gap.unwrap_or(f64::NAN)).collect())
            .scalar("contact_status", sites.iter().map(status).collect())
            .scalar("weight", sites.iter().map(|s| s.weight).collect())
            .vector("normal", sites.iter().flat_map(|s| vector(&s.normal)).collect());
    if rubs {
        let word = |s: &SiteResult| match s.status {
            Status::Open => 0.0,
            Status::Stick => 1.0,
            Status::Slip => 2.0,
        };
        fields = fields
            .scalar("friction_status", sites.iter().map(word).collect())
            .vector("friction_traction", sites.iter().flat_map(|s| vector(&s.shown_friction())).collect())
            .vector("slip", sites.iter().flat_map(|s| vector(&s.increment)).collect())
            .scalar("friction_utilisation", sites.iter().map(|s| s.utilisation).collect());
    }
    if is_curve && sites.len() > 2 {
        let frames = frames(sites);
        let of = |value: &dyn Fn(&Darboux, &SiteResult) -> f64| -> Vec<f64> {
            frames.iter().zip(sites).map(|(f, s)| f.as_ref().map_or(0.0, |f| value(f, s))).collect()
        };
        fields = fields
            .scalar("normal_curvature", of(&|f, _| f.k_n))
            .scalar("geodesic_curvature", of(&|f, _| f.k_g))
            .scalar("tan_alpha", of(&|f, _| if f.k_g == 0.0 { 0.0 } else { f.tan_alpha() }))
            .vector(
                "tangent",
                frames.iter().flat_map(|f| vector(&f.map_or(Vector::<3>::zeros(), |f| f.tau))).collect(),
            );
        if rubs {
            fields = fields
                .scalar("pulling_traction", of(&|f, s| s.friction.dot(&f.tau)))
                .scalar("dragging_traction", of(&|f, s| s.friction.dot(&f.g)));
        }
    }
    fields
}

/// The frames of the sites of a curve that touch.
pub fn frames(sites: &[SiteResult]) -> Vec<Option<Darboux>> {
    let points: Vec<Vector<3>> = sites.iter().map(|s| s.x).collect();
    let normals: Vec<_> = sites.iter().map(|s| (s.status != Status::Open).then_some(s.normal)).collect();
    of_points(&points, &normals)
}
