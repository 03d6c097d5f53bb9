//! A state of a system of bodies as it is shown: fields of the bodies, points of the contacts.

use super::body_fields::{of_body, of_solid};
use super::camera::bounds;
use super::level::surface;
use crate::fields::Fields;
use crate::plan::mechanics::{Kind, MechanicsPlan};
use crate::problem::{Body, Space};
use crate::report::TractionKind;
use crate::report::vector;
use signorini_contact::{GapJet, Status};
use signorini_fem::CellShape;
use signorini_geometry::Vector;
use signorini_mechanics::{
    BodyFields, BodyState, IncrementResult, SharedSite, ShownSurface, SiteResult, SystemState, rigid_body,
};
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

/// Half of the box around a body, in sizes: its centre may be off its middle.
const WHOLE: f64 = 0.75;

/// A rigid body where it is.
#[derive(Clone)]
pub struct RigidShown {
    pub name: String,
    pub gap: Arc<dyn Fn(&Vector<3>) -> GapJet<3> + Send + Sync>,
    /// Its extent where it has one.
    pub size: f64,
    pub centre: Vector<3>,
    pub is_free: bool,
    /// Its triangles: of a body of flat faces, or for pictures of a solid with curved ones.
    pub mesh: Option<(Vec<Vector<3>>, Vec<[u32; 3]>)>,
}

impl RigidShown {
    /// Its surface within a box: points, the normals at the corners of each triangle, and triangles. Of a body with triangles that lies in the
    /// box, or is free, its own triangles; of others those of `cubes` cubes along the box.
    pub fn surface(&self, room: [Vector<3>; 2], cubes: usize) -> (Vec<Vector<3>>, Vec<[Vector<3>; 3]>, Vec<[u32; 3]>) {
        let [low, high] = self.room(room);
        let lies_within = |x: &Vector<3>| (0..3).all(|i| low[i] <= x[i] && x[i] <= high[i]);
        if let Some((points, triangles)) = &self.mesh
            && (self.is_free || points.iter().all(lies_within))
        {
            let normal = |t: &[u32; 3]| {
                let [a, b, c] = t.map(|k| points[k as usize]);
                [(b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_default(); 3]
            };
            return (points.clone(), triangles.iter().map(normal).collect(), triangles.clone());
        }
        let (points, normals, triangles) = surface(self.gap.as_ref(), [low, high], cubes);
        let normals = triangles.iter().map(|t| t.map(|k| normals[k as usize])).collect();
        (points, normals, triangles)
    }

    /// The box in which it is drawn: a free body that is not much larger than what is shown is drawn whole, and as fine as its size
    /// asks for.
    pub fn room(&self, shown: [Vector<3>; 2]) -> [Vector<3>; 2] {
        let pad = Vector::<3>::repeat(WHOLE * self.size);
        let fits = self.size < (shown[1] - shown[0]).norm();
        if self.is_free && fits { [self.centre - pad, self.centre + pad] } else { shown }
    }
}

/// A contact as it is shown: its tested points, and the surface between them where it has one.
#[derive(Clone)]
pub struct ContactShown {
    pub fields: Fields,
    pub carries: TractionKind,
    pub surface: Option<ShownSurface>,
}

/// A state as it is shown.
#[derive(Clone)]
pub struct SystemShown {
    pub time: f64,
    pub bodies: Vec<Fields>,
    /// By body of the system, where the points of solids are that their fields tell; empty of others.
    pub placed: Vec<Vec<Vector<3>>>,
    pub contacts: Vec<ContactShown>,
    pub curves: Vec<CurveShown>,
    pub rigid: Vec<RigidShown>,
    /// In the plane, the intervals of surfaces that touch.
    pub zones: Vec<[Vector<3>; 2]>,
    /// The array of solids that colours tell.
    pub painted: &'static str,
}

impl SystemShown {
    pub fn new(plan: &MechanicsPlan, state: &SystemState, result: &IncrementResult, time: f64) -> Self {
        let mut shown = SystemShown { time, ..Self::of_bodies(plan, &state.bodies) };
        let contacts = plan.system.contacts.iter().zip(&plan.contacts);
        for (number, ((contact, tested), sites)) in contacts.zip(&result.sites).enumerate() {
            let surface = plan.system.surface(number, state).ok().flatten();
            let mut fields = of_contact(contact.name(), sites, contact.friction().is_some(), tested.along_a_curve);
            if let Some(surface) = &surface {
                add_faces(&mut fields, surface, plan.space == Space::ThreeD);
                shown.zones.extend(&surface.intervals);
            }
            shown.contacts.push(ContactShown { fields, carries: tested.carries, surface });
        }
        shown
    }

    /// The bodies without their contacts.
    pub fn of_bodies(plan: &MechanicsPlan, state: &[BodyState]) -> Self {
        let mut shown = SystemShown {
            time: 0.0,
            bodies: Vec::new(),
            placed: vec![Vec::new(); plan.system.bodies.len()],
            contacts: Vec::new(),
            curves: Vec::new(),
            rigid: Vec::new(),
            zones: Vec::new(),
            painted: "von_mises",
        };
        for (number, ((body, kind), state)) in plan.system.bodies.iter().zip(&plan.kinds).zip(state).enumerate() {
            match kind {
                Kind::Curve { radius } => {
                    let fields = body.fields(state);
                    let is_rope = matches!(plan.head.problem.bodies.get(body.name()), Some(Body::Rope(_)));
                    shown.curves.push(CurveShown { is_rope, ..curve(body.name(), *radius, &fields) });
                    shown.bodies.push(of_body(body.name(), &fields));
                }
                Kind::Solid | Kind::Cells => {
                    let fields = body.fields(state);
                    shown.placed[number] = fields.points.iter().zip(&fields.displacement).map(|(x, u)| x + u).collect();
                    shown.bodies.push(of_solid(body.name(), &fields));
                }
                Kind::Rigid { shape, centre, is_free } => {
                    let pose = rigid_body::Pose::of(state);
                    let (rotation, shape, origin, now) = (pose.matrix(), Arc::clone(shape), *centre, pose.centre);
                    let mesh = shape.mesh().map(|mesh| {
                        let placed = mesh.vertices().iter().map(|x| now + rotation * (x - origin));
                        (placed.collect(), mesh.triangles().to_vec())
                    });
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
                        mesh,
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
        bounds(points.iter())
    }

    /// Whether it is solids alone that are shown, with rigid bodies that are where they were put.
    pub fn is_of_solids(&self) -> bool {
        self.curves.is_empty() && self.solids().next().is_some()
    }

    /// Takes displacements this many times as large.
    pub fn magnify(&mut self, factor: f64) {
        let arrays = self.bodies.iter_mut().flat_map(|body| &mut body.arrays);
        let displacements = arrays.filter(|array| array.name == "displacement");
        displacements.flat_map(|array| &mut array.values).for_each(|u| *u *= factor);
    }

    /// The largest displacement of solids.
    pub fn largest_displacement(&self) -> f64 {
        let list = self.solids().filter_map(|body| body.array("displacement"));
        list.flat_map(|u| u.chunks(3)).map(|u| Vector::<3>::from_column_slice(u).norm()).fold(0.0, f64::max)
    }

    /// The corners of the box of solids before they deform.
    pub fn bounds_at_rest(&self) -> [Vector<3>; 2] {
        let points: Vec<Vector<3>> = self.solids().flat_map(|b| &b.points).map(|x| Vector::<3>::from(*x)).collect();
        bounds(points.iter())
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
    if sites.iter().any(|s| s.worn > 0.0) {
        fields = fields.scalar("wear", sites.iter().map(|s| s.worn).collect());
    }
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

/// The faces of a surface between the tested points. Points without a gap of their own, such as those on a support, take
/// that of a neighbour.
fn add_faces(fields: &mut Fields, surface: &ShownSurface, in_space: bool) {
    let shape = |corners: usize| match (in_space, corners) {
        (false, _) => CellShape::Line,
        (true, 3) => CellShape::Triangle,
        (true, _) => CellShape::Quadrilateral,
    };
    fields.cells = surface.faces.iter().map(|f| (Some(shape(f.len())), f.clone())).collect();
    surface.shared.iter().for_each(|shared| share(fields, shared));
    let Some(gap) = fields.arrays.iter_mut().find(|array| array.name == "gap") else { return };
    for face in &surface.faces {
        let known = face.iter().map(|&k| gap.values[k as usize]).find(|g| g.is_finite());
        for &k in face {
            let own = &mut gap.values[k as usize];
            *own = if own.is_nan() { known.unwrap_or(f64::NAN) } else { *own };
        }
    }
}

/// Shows a point that touches where another one does, with the same part of the friction that is available.
fn share(fields: &mut Fields, shared: &SharedSite) {
    let [to, from] = [shared.site, shared.with].map(|k| k as usize);
    let pressure = fields.array("contact_pressure").map_or(0.0, |p| p[from]);
    let gain = if shared.weightless || pressure == 0.0 { 0.0 } else { shared.pressure / pressure };
    for array in &mut fields.arrays {
        match array.name {
            "contact_pressure" => array.values[to] = shared.pressure,
            "friction_traction" => (0..3).for_each(|i| array.values[3 * to + i] = gain * array.values[3 * from + i]),
            "friction_utilisation" if shared.weightless => {}
            "gap" | "contact_status" | "friction_status" | "friction_utilisation" => {
                array.values[to] = array.values[from]
            }
            _ => {}
        }
    }
}

/// The frames of the sites of a curve that touch.
pub fn frames(sites: &[SiteResult]) -> Vec<Option<Darboux>> {
    let points: Vec<Vector<3>> = sites.iter().map(|s| s.x).collect();
    let normals: Vec<_> = sites.iter().map(|s| (s.status != Status::Open).then_some(s.normal)).collect();
    of_points(&points, &normals)
}
