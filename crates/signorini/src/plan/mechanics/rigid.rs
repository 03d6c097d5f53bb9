//! Rigid bodies of a system, at rest, moved or free.

use super::{Kind, Wrong};
use crate::plan::planner::Planner;
use crate::plan::rigid as beside;
use crate::problem::units::{DENSITY, FREQUENCY, INERTIA, LENGTH, MASS, VELOCITY};
use crate::problem::{CaseError, Components, FreeMotion, KeyPath, Motion as Stated, Rigid, Shape, Side, Space};
use signorini_geometry::mass_properties::MassProperties;
use signorini_geometry::mesh::TriangleMesh;
use signorini_geometry::rigid_shape::{Block, RigidShape};
use signorini_geometry::{Aabb, Matrix, Point, Vector};
use signorini_mechanics::{Motion, RigidBody, RigidMass, RigidSite};
use std::sync::Arc;

/// What is around no body at all.
const NOWHERE: f64 = 1.0;
/// Distance of centres relative to the size of a body that is none.
const SAME_PLACE: f64 = 1e-9;

/// The mass of a body, with its centre.
struct Found {
    own: RigidMass,
    centre: Point<3>,
}

impl Planner<'_> {
    /// A rigid body, and what it is for results. `around` are the corners of the box of the deformable bodies.
    pub(super) fn rigid_body(
        &self,
        name: &str,
        key: &Rigid,
        around: Option<[Point<3>; 2]>,
        wrong: &Wrong,
    ) -> Result<(RigidBody, Kind), CaseError> {
        let [low, high] = around.unwrap_or([Point::<3>::repeat(-NOWHERE), Point::<3>::repeat(NOWHERE)]);
        let pad = Vector::<3>::repeat(0.5 * (high - low).amax().max(f64::MIN_POSITIVE));
        let around = Aabb::new(low - pad, high + pad);
        let found = match self.space {
            Space::ThreeD => beside::read::<3>(self, name, key, &around)?,
            _ => beside::read::<2>(self, name, key, &around)?,
        };
        let shape = found.touched();
        let is_free = matches!(key.motion, Some(Stated::Free(_)));
        let mut centre = shape.centre();
        let motion = match &key.motion {
            Some(Stated::Free(free)) => {
                centre = match &free.center {
                    Some(stated) => self.position(stated, LENGTH)?,
                    None => self.centre_of(name, key, shape.as_ref())?,
                };
                match self.space {
                    Space::Axisymmetric => Motion::FreeAlongAxis,
                    space => Motion::Free { plane: space != Space::ThreeD },
                }
            }
            _ => {
                let wrong = wrong.clone();
                let nowhere = Point::<3>::zeros();
                Motion::Prescribed(Arc::new(move |t| {
                    found.motion_by(&|placed| wrong.evaluate(&placed.expression, &placed.key, &nowhere, t))
                }))
            }
        };
        let (sites, size) = self.points_of(key, shape.as_ref(), low, high)?;
        let mut mass = None;
        if let Some(Stated::Free(free)) = &key.motion
            && let Some(found) = self.mass_of(name, key, free, shape.as_ref(), centre)?
        {
            centre = found.centre;
            mass = Some(found.own);
        }
        let body = RigidBody { name: name.to_string(), shape: Arc::clone(&shape), motion, centre, sites, size, mass };
        Ok((body, Kind::Rigid { shape, centre, is_free }))
    }

    /// Mass, moments of inertia and velocities of a free body; none of one without density and mass.
    fn mass_of(
        &self,
        name: &str,
        key: &Rigid,
        free: &FreeMotion,
        shape: &dyn RigidShape,
        place: Point<3>,
    ) -> Result<Option<Found>, CaseError> {
        let problem = self.problem;
        let (velocity, angular_velocity) = self.velocities_of(free)?;
        if let (Some(_), Some(mass)) = (&free.density, &free.mass) {
            return Err(problem
                .error(mass, format!("`{name}` has a density and a mass"))
                .help("leave one of them out"));
        }
        let density = free.density.as_ref().map(|value| self.reader.positive(value, DENSITY)).transpose()?;
        let stated = free.mass.as_ref().map(|value| self.reader.positive(value, MASS)).transpose()?;
        if density.is_none() && stated.is_none() {
            if let Some(inertia) = &free.inertia {
                return Err(problem
                    .error(&inertia.0, format!("`{name}` has moments of inertia and no mass"))
                    .help("add `mass`, or give a `density` in place of `inertia`"));
            }
            return Ok(None);
        }
        // A hole has no inside.
        let solid = if key.side == Some(Side::Inside) { None } else { self.solid_of(key, shape)? };
        let unknown = |at: KeyPath| {
            problem
                .error(&at, format!("volume and moments of inertia of `{name}` are not known for a shape of this kind"))
                .help("give `mass`, `inertia` and `center` in place of `density`; boxes, closed triangle meshes, spheres, ellipsoids, tori and closed bodies of revolution have them")
        };
        let mass = match (stated, density, &solid) {
            (Some(mass), _, _) => mass,
            (None, Some(density), Some(solid)) => density * solid.volume,
            (None, _, _) => return Err(unknown(free.density.as_ref().map_or(self.key(key), |d| self.key(d)))),
        };
        let centre = match (&free.center, &solid) {
            (Some(stated), Some(solid)) => {
                if (place - solid.centre).norm() > SAME_PLACE * shape.bounds().map_or(place.norm(), |b| b.size().norm())
                    && free.inertia.is_none()
                {
                    let at = solid.centre.iter().map(|x| format!("{x}")).collect::<Vec<_>>().join(", ");
                    return Err(problem
                        .error(stated, format!("with a mass the centre is the centre of mass, at ({at})"))
                        .help("leave `center` out, or give `inertia` about it"));
                }
                place
            }
            (Some(_), None) => place,
            (None, Some(solid)) => solid.centre,
            (None, None) => place,
        };
        let inertia = match (&free.inertia, &solid) {
            (Some(stated), _) => self.inertia_of(name, stated)?,
            (None, Some(solid)) => solid.inertia * (mass / solid.volume),
            // Nothing turns.
            (None, None) if self.space == Space::Axisymmetric => Matrix::<3>::zeros(),
            (None, None) => return Err(unknown(free.mass.as_ref().map_or(self.key(key), |m| self.key(m)))),
        };
        Ok(Some(Found { own: RigidMass { mass, inertia, velocity, angular_velocity }, centre }))
    }

    /// Velocity and angular velocity at the start.
    fn velocities_of(&self, free: &FreeMotion) -> Result<(Vector<3>, Vector<3>), CaseError> {
        let problem = self.problem;
        let velocity = free.velocity.as_ref().map(|v| self.position(v, VELOCITY)).transpose()?;
        let Some(stated) = &free.angular_velocity else {
            return Ok((velocity.unwrap_or_default(), Vector::<3>::zeros()));
        };
        let turning = match (self.space, &stated.0[..]) {
            (Space::ThreeD, _) => Vector::<3>::from(self.reader.numbers::<3>(&stated.0, FREQUENCY)?),
            (Space::Axisymmetric, _) => {
                return Err(problem.error(&stated.0, "around an axis a body moves along the axis only"));
            }
            (_, [value]) => Vector::<3>::z() * self.reader.number(value, FREQUENCY)?,
            _ => {
                return Err(problem
                    .error(&stated.0, "in the plane there is one angular velocity, about z")
                    .help("angular_velocity = 3.0"));
            }
        };
        Ok((velocity.unwrap_or_default(), turning))
    }

    /// Moments of inertia that are stated.
    fn inertia_of(&self, name: &str, stated: &Components) -> Result<Matrix<3>, CaseError> {
        let list: Vec<f64> =
            stated.0.iter().map(|value| self.reader.positive(value, INERTIA)).collect::<Result<_, _>>()?;
        match list[..] {
            [one] => Ok(Matrix::<3>::identity() * one),
            [x, y, z] if self.space == Space::ThreeD => {
                // No body is farther from one axis than from both others together.
                if x > y + z || y > z + x || z > x + y {
                    let message = format!("no body has the moments of inertia {x}, {y}, {z} of `{name}`");
                    return Err(self
                        .problem
                        .error(&stated.0, message)
                        .help("none of the three is larger than the sum of the others"));
                }
                Ok(Matrix::<3>::from_diagonal(&Vector::<3>::new(x, y, z)))
            }
            _ => Err(self
                .problem
                .error(&stated.0, format!("expected one moment of inertia, or three in space, found {}", list.len()))
                .help("inertia = [0.1, 0.2, 0.3], about the axes of space through the centre")),
        }
    }

    /// Volume, centre of mass and moments of inertia of a shape with density one; per thickness in the plane.
    fn solid_of(&self, key: &Rigid, shape: &dyn RigidShape) -> Result<Option<MassProperties>, CaseError> {
        let in_plane = !matches!(self.space, Space::ThreeD | Space::Axisymmetric);
        if key.smooth == Some(true) {
            return Ok(None);
        }
        Ok(match &key.shape {
            Shape::Stl(file) => Some(MassProperties::polyhedron(&self.closed_mesh(file)?)),
            Shape::File(file) => Some(MassProperties::polyhedron(&self.boundary_of_file(file)?)),
            Shape::Triangles(arrays) => Some(MassProperties::polyhedron(&self.surface_of_arrays(arrays)?)),
            Shape::Sphere(sphere) if in_plane => {
                let radius = self.reader.positive(&sphere.radius, LENGTH)?;
                Some(MassProperties::ellipse(shape.centre(), [radius; 2]))
            }
            Shape::Cylinder(cylinder) if in_plane => {
                let radius = self.reader.positive(&cylinder.radius, LENGTH)?;
                Some(MassProperties::ellipse(shape.centre(), [radius; 2]))
            }
            Shape::Ellipsoid(ellipsoid) if in_plane => {
                let semi_axes = self.reader.numbers::<2>(&ellipsoid.semi_axes, LENGTH)?;
                Some(MassProperties::ellipse(shape.centre(), semi_axes))
            }
            Shape::Box(_) => shape.mass_properties(),
            _ if in_plane => None,
            _ => shape.mass_properties(),
        })
    }

    /// The centre of a free body that states none: that of its volume where it is known, else of its shape. A surface from a file
    /// and a level set have no centre of their own.
    fn centre_of(&self, name: &str, key: &Rigid, shape: &dyn RigidShape) -> Result<Point<3>, CaseError> {
        if key.side != Some(Side::Inside)
            && let Ok(Some(solid)) = self.solid_of(key, shape)
        {
            return Ok(solid.centre);
        }
        let has_none = matches!(
            &key.shape,
            Shape::Nurbs(_)
                | Shape::Stl(_)
                | Shape::Step(_)
                | Shape::File(_)
                | Shape::Triangles(_)
                | Shape::LevelSet(_)
        );
        let acts = |on: &str| on == name || on.starts_with(&format!("{name}:"));
        let load = self.problem.loads.iter().find(|(_, load)| has_none && acts(&load.on));
        match load {
            Some((_, load)) => Err(self
                .problem
                .error(&load.on, format!("where the centre of `{name}` is, through which the load acts, is not known for a shape of this kind"))
                .help("give `motion.free.center`; closed triangle meshes have one")),
            None => Ok(shape.centre()),
        }
    }

    /// The points of a rigid body that are tested, and its size: a ball at its centre, a box at its corners, a triangle mesh
    /// at its vertices, a solid of a STEP file at the corners of its triangles, which lie on its faces.
    fn points_of(
        &self,
        key: &Rigid,
        shape: &dyn RigidShape,
        low: Point<3>,
        high: Point<3>,
    ) -> Result<(Vec<RigidSite>, f64), CaseError> {
        let outside = key.side != Some(Side::Inside);
        Ok(match &key.shape {
            Shape::Sphere(sphere) => {
                of_ball(self.position(&sphere.center, LENGTH)?, self.reader.positive(&sphere.radius, LENGTH)?, outside)
            }
            // A disc.
            Shape::Cylinder(cylinder) if !matches!(self.space, Space::ThreeD | Space::Axisymmetric) => of_ball(
                self.position(&cylinder.point, LENGTH)?,
                self.reader.positive(&cylinder.radius, LENGTH)?,
                outside,
            ),
            Shape::Box(stated) => {
                let body = match self.space {
                    Space::ThreeD => self.rigid_box::<3>(&key.shape, stated)?,
                    _ => self.rigid_box::<2>(&key.shape, stated)?,
                };
                of_block(&body, outside)
            }
            Shape::Stl(file) => of_mesh(&self.closed_mesh(file)?, outside),
            Shape::Step(_) => match shape.mesh() {
                Some(mesh) => of_mesh(mesh, outside),
                None => (Vec::new(), shape.bounds().map_or((high - low).norm(), |b| b.size().norm())),
            },
            Shape::File(file) => of_mesh(&self.boundary_of_file(file)?, outside),
            Shape::Triangles(arrays) => of_mesh(&self.surface_of_arrays(arrays)?, outside),
            _ => (Vec::new(), (high - low).norm()),
        })
    }
}

/// The centre of a ball or disc.
fn of_ball(x: Point<3>, radius: f64, outside: bool) -> (Vec<RigidSite>, f64) {
    let site = RigidSite { x, outward: None, radius, weight: 1.0 };
    (if outside { vec![site] } else { Vec::new() }, 2.0 * radius)
}

/// Corners, alike, with the direction from the middle.
fn of_block(body: &Block, outside: bool) -> (Vec<RigidSite>, f64) {
    let corners = body.corners();
    let (count, middle) = (corners.len(), body.centre());
    let site = |x: &Point<3>| {
        let outward = (x - middle).try_normalize(0.0);
        RigidSite { x: *x, outward, radius: 0.0, weight: body.surface() / count as f64 }
    };
    let size = 2.0 * (corners[0] - middle).norm();
    (if outside { corners.iter().map(site).collect() } else { Vec::new() }, size)
}

/// Vertices with their share of the area, and the mean normal of the faces around them.
fn of_mesh(mesh: &TriangleMesh, outside: bool) -> (Vec<RigidSite>, f64) {
    let mut normals = vec![Vector::<3>::zeros(); mesh.vertices().len()];
    let mut areas = vec![0.0; mesh.vertices().len()];
    for (k, triangle) in mesh.triangles().iter().enumerate() {
        let [a, b, c] = mesh.corners(k);
        let normal = (b - a).cross(&(c - a)) * 0.5;
        for &v in triangle {
            normals[v as usize] += normal;
            areas[v as usize] += normal.norm() / 3.0;
        }
    }
    let sites = (mesh.vertices().iter().zip(normals).zip(areas))
        .filter(|(_, area)| *area > 0.0)
        .map(|((x, normal), weight)| RigidSite { x: *x, outward: normal.try_normalize(0.0), radius: 0.0, weight })
        .collect();
    (if outside { sites } else { Vec::new() }, mesh.bounds().size().norm())
}
