//! Rigid bodies that solids press on: the gap to them and their outward normal, anywhere and at any time.

use super::located::LocatedExpression;
use super::placement::PlacementKeys;
use super::planner::Planner;
use super::rigid_shape::{self, ShapeKeys};
use crate::expression::Scope;
use crate::problem::units::{Dimension, LENGTH, NONE};
use crate::problem::{BoxShape, Cylinder, Ellipsoid, Motion, Placement, Rigid, Shape, Side, Space};
use crate::problem::{CaseError, List, Location, Problem, Value};
use crate::queries::geometry;
use crate::report::{Warning, WarningKind};
use signorini_geometry::height_field::{self, HeightField};
use signorini_geometry::implicit::Function;
use signorini_geometry::implicit_surface::ImplicitSurface;
use signorini_geometry::mesh::TriangleMesh;
use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::rigid_shape::{Block, ClosestPoints, GapJet, Normals, Polyhedron, RigidShape};
use signorini_geometry::shape::{Shape as Geometry, ShapeError};
use signorini_geometry::{Aabb, Jet, Point, Real, Vector};
use signorini_paths::smooth_mesh::SmoothMesh;
use std::sync::Arc;

/// A rigid body and how it moves.
#[derive(Clone)]
pub struct RigidBody {
    pub name: String,
    shape: Arc<dyn RigidShape>,
    inside: bool,
    /// Displacement along x, y, z as expressions of time; empty for a body at rest.
    pub displacement: Vec<LocatedExpression>,
    /// Rotation vector in radians, about the centre of the shape.
    pub rotation: Vec<LocatedExpression>,
    /// The box of the shape where it is stated; none of one without an end.
    pub bounds: Option<Aabb<3>>,
}

/// A shape that is a hole: touched from inside.
struct Hole(Arc<dyn RigidShape>);

impl RigidShape for Hole {
    fn gap(&self, x: &Point<3>) -> GapJet<3> {
        let found = self.0.gap(x);
        GapJet { gap: -found.gap, normal: -found.normal, hessian: -found.hessian }
    }

    fn around(&self, x: &Point<3>) -> Vec<GapJet<3>> {
        self.0.around(x)
    }

    fn centre(&self) -> Point<3> {
        self.0.centre()
    }
}

impl RigidBody {
    /// A body of a shape that is touched from outside.
    #[doc(hidden)]
    pub fn new(
        name: &str,
        shape: Arc<dyn RigidShape>,
        displacement: Vec<LocatedExpression>,
        rotation: Vec<LocatedExpression>,
    ) -> Self {
        Self { name: name.into(), shape, inside: false, displacement, rotation, bounds: None }
    }

    /// The shape from the side on which it is touched.
    pub fn touched(&self) -> Arc<dyn RigidShape> {
        if self.inside { Arc::new(Hole(Arc::clone(&self.shape))) } else { Arc::clone(&self.shape) }
    }

    /// Displacement and rotation vector at a time, each value by `evaluate`.
    pub fn motion_by(&self, evaluate: &dyn Fn(&LocatedExpression) -> f64) -> RigidMotion {
        let vector = |list: &[LocatedExpression]| Vector::<3>::from_fn(|k, _| list.get(k).map_or(0.0, evaluate));
        let rotation =
            if let [angle] = &self.rotation[..] { Vector::<3>::z() * evaluate(angle) } else { vector(&self.rotation) };
        RigidMotion::new(rotation, self.shape.centre(), vector(&self.displacement))
    }

    /// Whether it stays where it is.
    pub fn is_at_rest(&self) -> bool {
        self.displacement.is_empty() && self.rotation.is_empty()
    }

    /// Its shape where it is stated.
    pub fn shape(&self) -> &Arc<dyn RigidShape> {
        &self.shape
    }

    /// Its motion from where it is stated to where it is at a time.
    ///
    /// # Errors
    /// A motion that is not a number then.
    pub fn motion(&self, problem: &Problem, time: f64) -> Result<RigidMotion, CaseError> {
        let [moved, turned] = self.motion_at(problem, time)?;
        Ok(RigidMotion::new(turned, self.shape.centre(), moved))
    }

    /// Displacement and rotation vector at a time; an error where the motion is not a number.
    fn motion_at(&self, problem: &Problem, time: f64) -> Result<[Vector<3>; 2], CaseError> {
        let at = |p: &LocatedExpression| p.expression.evaluate(&Scope { position: [f64::NAN; 3], time });
        if let Some(p) = self.displacement.iter().chain(&self.rotation).find(|p| !at(p).is_finite()) {
            let message = format!("`{}` is {} at t = {time}: not a finite number", p.key, at(p));
            return Err(problem.error(&p.key, message));
        }
        let vector = |list: &[LocatedExpression]| Vector::<3>::from_fn(|k, _| list.get(k).map_or(0.0, at));
        // In the plane the one rotation there is turns about the axis across it.
        let rotation =
            if let [angle] = &self.rotation[..] { Vector::<3>::z() * at(angle) } else { vector(&self.rotation) };
        Ok([vector(&self.displacement), rotation])
    }

    /// How far the body has come at a time along its way, where it is nearest to a position at the start: where sides slide
    /// little, a body that turns rubs by the angle times the distance from the axis, in the direction that it starts with.
    ///
    /// # Errors
    /// A motion that is not a number then.
    pub fn way_at(
        &self,
        problem: &Problem,
        time: f64,
    ) -> Result<impl Fn(&Point<3>) -> Vector<3> + Sync + Send + 'static, CaseError> {
        let [moved, turned] = self.motion_at(problem, time)?;
        let shape = Arc::clone(&self.shape);
        Ok(move |x: &Point<3>| {
            let found = shape.gap(x);
            moved + turned.cross(&(x - found.normal * found.gap - shape.centre()))
        })
    }

    /// The gap of a point with its derivatives at a time.
    ///
    /// # Errors
    /// A motion that is not a number then.
    pub fn gap_at(
        &self,
        problem: &Problem,
        time: f64,
    ) -> Result<impl Fn(&Point<3>) -> GapJet<3> + Sync + Send + 'static, CaseError> {
        let [moved, turned] = self.motion_at(problem, time)?;
        let back = RigidMotion::new(-turned, self.shape.centre(), Vector::<3>::zeros());
        let forth = RigidMotion::new(turned, self.shape.centre(), Vector::<3>::zeros());
        let (shape, inside) = (Arc::clone(&self.shape), self.inside);
        Ok(move |x: &Point<3>| {
            let found = shape.gap(&back.point(&(x - moved)));
            let turn = forth.rotation;
            let sign = if inside { -1.0 } else { 1.0 };
            GapJet {
                gap: sign * found.gap,
                normal: turn * found.normal * sign,
                hessian: turn * found.hessian * turn.transpose() * sign,
            }
        })
    }
}

/// Reads a rigid body; in the plane vectors have two components.
///
/// `around` is the box of the solids, within which a height is known.
pub(super) fn read<const D: usize>(
    planner: &Planner<'_>,
    name: &str,
    rigid: &Rigid,
    around: &Aabb<3>,
) -> Result<RigidBody, CaseError> {
    if let Some(side @ (Side::Below | Side::Above)) = &rigid.side {
        return Err(planner
            .problem
            .error(side, "`below` and `above` are for bodies in contact with a membrane")
            .help("the sides of other bodies are \"outside\" and \"inside\""));
    }
    let keys = BesideSolids::<D> { planner };
    keys.check_round(&rigid.shape)?;
    if rigid.smooth == Some(true) {
        return smooth_body::<D>(planner, name, rigid);
    }
    let shape = shape::<D>(planner, &rigid.shape, around)?;
    let inside = rigid.side.as_ref().is_some_and(|s| *s == Side::Inside);
    let [displacement, rotation] = motion::<D>(planner, rigid)?;
    let bounds = match &rigid.shape {
        Shape::LevelSet(key) => Some(Aabb::new(keys.vector(&key.min, LENGTH)?, keys.vector(&key.max, LENGTH)?)),
        Shape::Box(_) | Shape::Step(_) => shape.bounds(),
        stated => stated.closed_form().and_then(|_| shape.bounds()),
    };
    Ok(RigidBody { name: name.to_string(), shape, inside, displacement, rotation, bounds })
}

/// Reads a shape; a height is known in the box `around`.
pub(super) fn shape<const D: usize>(
    planner: &Planner<'_>,
    stated: &Shape,
    around: &Aabb<3>,
) -> Result<Arc<dyn RigidShape>, CaseError> {
    let keys = BesideSolids::<D> { planner };
    match rigid_shape::read(&keys, stated)? {
        Some((shape, _)) => Ok(shape),
        None => keys.without_closed_form(stated, around),
    }
}

/// Shapes beside solids: in the plane with two coordinates.
struct BesideSolids<'a, 'b, const D: usize> {
    planner: &'a Planner<'b>,
}

impl<const D: usize> ShapeKeys for BesideSolids<'_, '_, D> {
    fn planner(&self) -> &Planner<'_> {
        self.planner
    }

    fn vector(&self, values: &List<Value>, dimension: Dimension) -> Result<Vector<3>, CaseError> {
        let list = self.planner.reader.numbers::<D>(values, dimension)?;
        Ok(Vector::<3>::from_fn(|k, _| if k < D { list[k] } else { 0.0 }))
    }

    fn cylinder_axis(&self, key: &Cylinder, shape: &Shape) -> Result<Vector<3>, CaseError> {
        let problem = self.planner.problem;
        match (&key.axis, D) {
            (Some(axis), 3) => self.direction(axis),
            (None, 2) => Ok(Vector::<3>::z()),
            (Some(axis), _) => {
                Err(problem.error(axis, "in the plane the axis of a cylinder is normal to the plane: leave `axis` out"))
            }
            (None, _) => Err(problem.error(shape, "missing key `axis`").help("axis = [0, 1, 0]")),
        }
    }

    fn semi_axes(&self, key: &Ellipsoid) -> Result<[f64; 3], CaseError> {
        let list = self.planner.reader.numbers::<D>(&key.semi_axes, LENGTH)?;
        // Long across the plane, so that closest points stay in it.
        let across = 10.0 * list.iter().fold(0.0, |a: f64, b| a.max(*b));
        Ok(std::array::from_fn(|k| if k < D { list[k] } else { across }))
    }
}

impl<const D: usize> BesideSolids<'_, '_, D> {
    fn check_in_space(&self, at: &impl Location, what: &str) -> Result<(), CaseError> {
        if D == 3 {
            return Ok(());
        }
        Err(self
            .planner
            .problem
            .error(at, format!("a {what} is a shape in space"))
            .help("in the plane: plane, box (a rectangle), sphere (a circle), cylinder, ellipsoid (an ellipse)"))
    }

    /// Shapes round an axis are shapes in space, which in the plane can be that of an axisymmetric problem.
    fn check_round(&self, shape: &Shape) -> Result<(), CaseError> {
        let Some(Placement { noun: what, place, axis: Some(axis), .. }) =
            shape.closed_form().map(|shape| shape.placement())
        else {
            return Ok(());
        };
        let place = place.unwrap_or(axis);
        if D == 3 || self.planner.space != Space::Axisymmetric {
            return self.check_in_space(shape, what);
        }
        match (self.vector(place, LENGTH)?[0] == 0.0, self.direction(axis)?[0] == 0.0) {
            (true, true) => Ok(()),
            (on_axis, _) => Err(self
                .planner
                .problem
                .error(if on_axis { axis } else { place }, format!("the {what} is not centred on the axis"))
                .help("in an axisymmetric problem its position is [0, z], and its axis [0, 1] or [0, -1]")),
        }
    }

    /// Shapes from files and functions.
    fn without_closed_form(&self, shape: &Shape, around: &Aabb<3>) -> Result<Arc<dyn RigidShape>, CaseError> {
        let planner = self.planner;
        let problem = planner.problem;
        let wrong = |error: ShapeError| problem.error(shape, error.to_string());
        Ok(match shape {
            Shape::Stl(key) => {
                self.check_in_space(shape, "triangulated surface")?;
                polyhedron(planner.closed_mesh(key)?)
            }
            Shape::Step(key) => {
                self.check_in_space(shape, "solid of a STEP file")?;
                planner.step_solids(key)?
            }
            Shape::File(key) => {
                self.check_in_space(shape, "triangulated surface")?;
                polyhedron(planner.boundary_of_file(key)?)
            }
            Shape::Triangles(key) => {
                self.check_in_space(shape, "triangulated surface")?;
                polyhedron(planner.surface_of_arrays(key)?)
            }
            Shape::Box(key) => Arc::new(planner.rigid_box::<D>(shape, key)?),
            Shape::Custom(custom) => Arc::clone(&custom.0),
            Shape::Nurbs(key) => {
                self.check_in_space(shape, "NURBS surface")?;
                let (path, bytes) = planner.read_file(&key.file)?;
                let value: serde_json::Value = serde_json::from_slice(&bytes)
                    .map_err(|e| problem.error(&key.file, format!("`{}` is not JSON: {e}", path.display())))?;
                let surface = geometry::shape("surface", &value, path.parent().unwrap_or(std::path::Path::new("")))
                    .map_err(|e| problem.error(&key.file, format!("`{}`: {e}", path.display())))?;
                if !matches!(surface, Geometry::Surface(_)) {
                    return Err(problem.error(&key.file, format!("`{}` is not a surface", path.display())));
                }
                let keys = PlacementKeys { scale: &key.scale, rotate: &key.rotate, translate: &key.translate };
                let surface = match planner.placement::<3>(&keys)? {
                    Some(placement) => placement.shape(&surface).unwrap_or(surface),
                    None => surface,
                };
                Arc::new(ClosestPoints { shape: surface, normals: Normals::Outward })
            }
            Shape::LevelSet(key) => {
                let (low, high) = (self.vector(&key.min, LENGTH)?, self.vector(&key.max, LENGTH)?);
                let cells = match &key.cells {
                    None => 64,
                    Some(n) if (2..=512).contains(n) => *n as usize,
                    Some(n) => return Err(problem.error(n, "give a number of cells from 2 to 512")),
                };
                let variables: &[&'static str] = if D == 2 { &["x", "y"] } else { &["x", "y", "z"] };
                let expression = planner.reader.expression(&key.negative_inside, LENGTH, variables)?;
                let field = move |x: &Point<3>| {
                    let position = [0, 1, 2].map(|k| Jet::<3>::variable(x[k], k));
                    expression.evaluate(&Scope { position, time: Jet::<3>::constant(0.0) })
                };
                let bounds = flat_box::<D>(low, high);
                let wrong = |error: ShapeError| match error.field {
                    "box" => problem.error(&key.max, error.to_string()),
                    "value" => problem.error(&key.negative_inside, format!("`negative_inside`: {}", error.message)),
                    _ => wrong(error),
                };
                Arc::new(ImplicitSurface::new(Function(field).into(), bounds, cells).map_err(wrong)?)
            }
            Shape::Height(value) => {
                // The body below the height: z - h(x, y), or y - h(x) in the plane.
                let variables: &[&'static str] = if D == 2 { &["x"] } else { &["x", "y"] };
                let height = planner.reader.expression(value, LENGTH, variables)?;
                let up = D - 1;
                let field = move |x: &Point<3>| {
                    let position = [0, 1, 2].map(|k| Jet::<3>::variable(x[k], k));
                    position[up] - height.evaluate(&Scope { position, time: Jet::<3>::constant(0.0) })
                };
                let surface = ImplicitSurface::new(Function(field).into(), *around, 64)
                    .map_err(|e| wrong(e).help("the height must cross a box around the solids of twice their size"))?;
                Arc::new(surface)
            }
            Shape::HeightMap(key) => {
                self.check_in_space(shape, "height map")?;
                let map = planner.height_map(key)?;
                // Beyond its rectangle the map is not known.
                let [low, high] = map.known_within().unwrap_or([Vector::<2>::zeros(); 2]);
                let bounds = Aabb::new(
                    Point::<3>::new(around.min[0].max(low[0]), around.min[1].max(low[1]), around.min[2]),
                    Point::<3>::new(around.max[0].min(high[0]), around.max[1].min(high[1]), around.max[2]),
                );
                if (0..2).any(|k| bounds.min[k] >= bounds.max[k]) {
                    let misses = ShapeError::new("height_map", "it does not lie below the solids".to_string());
                    return Err(wrong(misses).help("check `origin`"));
                }
                let field = move |x: &Point<3>| {
                    let [x, y, z] = [0, 1, 2].map(|k| Jet::<3>::variable(x[k], k));
                    z - height_field::evaluate(&map, x, y)
                };
                let surface = ImplicitSurface::new(Function(field).into(), bounds, 96).map_err(|e| {
                    wrong(e).help("the heights must lie within a box around the solids of twice their size")
                })?;
                Arc::new(surface)
            }
            _ => return Err(planner.unavailable(shape, "this shape in contact with a solid")),
        })
    }
}

impl Planner<'_> {
    /// A box; a rectangle in the plane.
    pub(super) fn rigid_box<const D: usize>(&self, shape: &Shape, key: &BoxShape) -> Result<Block, CaseError> {
        let problem = self.problem;
        if self.space == Space::Axisymmetric {
            return Err(problem
                .error(shape, "a box is not round about the axis")
                .help("around an axis: plane, sphere, cylinder, torus, or a body of revolution"));
        }
        let [low, high] = [&key.min, &key.max].map(|list| self.reader.numbers::<D>(list, LENGTH));
        let (low, high) = (low?, high?);
        if let Some(k) = (0..D).find(|k| low[*k] >= high[*k]) {
            let axis = ["x", "y", "z"][k];
            return Err(problem
                .error(&key.max, format!("the box ends at {axis} = {} and begins at {axis} = {}", high[k], low[k]))
                .help("`max` is larger than `min` along each axis"));
        }
        let turn = key.rotate.as_ref().map_or(Ok(Vector::<3>::zeros()), |turn| self.rotation_vector::<D>(turn))?;
        let along = |by: &dyn Fn(usize) -> f64| Vector::<3>::from_fn(|k, _| if k < D { by(k) } else { 0.0 });
        let (middle, edges) = (along(&|k| 0.5 * (low[k] + high[k])), along(&|k| high[k] - low[k]));
        let made = match D {
            2 => Block::rectangle(middle, [edges[0], edges[1]], turn[2]),
            _ => Block::new(middle, edges, RigidMotion::new(turn, middle, Vector::<3>::zeros()).rotation),
        };
        made.map_err(|error| problem.error(shape, error.to_string()))
    }
}

/// The body within a triangle mesh; beside one that is not closed.
fn polyhedron(mesh: TriangleMesh) -> Arc<dyn RigidShape> {
    match Polyhedron::new(mesh.clone()) {
        Some(shape) => Arc::new(shape),
        None => Arc::new(ClosestPoints { shape: mesh.into(), normals: Normals::Outward }),
    }
}

/// The smooth surface through the vertices of a mesh; how far they scatter about it is told.
pub(super) fn smooth_body<const D: usize>(
    planner: &Planner<'_>,
    name: &str,
    rigid: &Rigid,
) -> Result<RigidBody, CaseError> {
    let mesh = match &rigid.shape {
        Shape::Stl(key) => planner.closed_mesh(key)?,
        Shape::File(key) => planner.boundary_of_file(key)?,
        Shape::Triangles(key) => planner.surface_of_arrays(key)?,
        other => {
            return Err(planner
                .problem
                .error(other, "only triangle meshes can be smoothed")
                .help("leave `smooth` out; this shape has no facets"));
        }
    };
    let smooth = SmoothMesh::new(&mesh).map_err(|e| planner.problem.error(&rigid.shape, e.to_string()))?;
    let [curvature, error] = smooth.curvature();
    let message = format!(
        "the vertices of `{name}` scatter by {:.3e} about the smooth surface, which is {:.2} % of an edge; with fits \
         over {:.1} edges the curvatures, {curvature:.3e} on average, are known to ±{error:.1e}",
        smooth.scatter(),
        100.0 * smooth.scatter() / smooth.edge(),
        smooth.fit_radius()
    );
    planner.warnings.borrow_mut().push(Warning::new(WarningKind::Scatter, message));
    let inside = rigid.side.as_ref().is_some_and(|s| *s == Side::Inside);
    let [displacement, rotation] = motion::<D>(planner, rigid)?;
    let bounds = Some(*mesh.bounds());
    Ok(RigidBody { name: name.to_string(), shape: Arc::new(smooth), inside, displacement, rotation, bounds })
}

/// How a rigid body moves: displacement and rotation, each empty for one at rest.
fn motion<const D: usize>(planner: &Planner<'_>, rigid: &Rigid) -> Result<[Vec<LocatedExpression>; 2], CaseError> {
    let problem = planner.problem;
    let (mut displacement, mut rotation) = (Vec::new(), Vec::new());
    match &rigid.motion {
        None | Some(Motion::Fixed(_)) => {}
        // A free body has its motion from the system that it is part of.
        Some(Motion::Free(_)) => {}
        Some(Motion::Prescribed(motion)) => {
            if let Some(values) = &motion.rotation {
                let wanted = if D == 2 { 1 } else { 3 };
                if values.len() != wanted {
                    let found = values.len();
                    return Err(problem
                        .error(values, format!("expected {wanted} components of the rotation, found {found}"))
                        .help("in the plane [angle], in space a rotation vector, in radians"));
                }
                for v in values {
                    rotation.push(LocatedExpression {
                        expression: planner.reader.expression(v, NONE, &["t"])?,
                        key: planner.key(v),
                    });
                }
            }
            if let Some(values) = &motion.displacement {
                if values.len() != D {
                    let found = values.len();
                    return Err(problem.error(values, format!("expected {D} components, found {found}")));
                }
                for v in values {
                    displacement.push(LocatedExpression {
                        expression: planner.reader.expression(v, LENGTH, &["t"])?,
                        key: planner.key(v),
                    });
                }
            }
        }
    }
    Ok([displacement, rotation])
}

/// In the plane bodies reach across it on both sides, so that closest points stay in it.
pub(super) fn flat_box<const D: usize>(low: Vector<3>, high: Vector<3>) -> Aabb<3> {
    let (mut low, mut high) = (low, high);
    if D == 2 {
        let depth = 0.1 * (high - low).norm();
        (low[2], high[2]) = (-depth, depth);
    }
    Aabb::new(low, high)
}
