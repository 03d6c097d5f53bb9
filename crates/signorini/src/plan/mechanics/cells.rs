//! Bodies of finite cells of a system, from shapes, surfaces and images.

use crate::expression::{Expression, Scope};
use crate::plan::memory_at_hand;
use crate::plan::planner::Planner;
use crate::plan::rigid;
use crate::problem::units::{LENGTH, NONE, PRESSURE};
use crate::problem::{
    CaseError, CellFunctions, CellIntegration, CellsBody, Composed, Contact, Geometry, IslandsKey, List,
    Shape as Stated, Space as In, Value,
};
use crate::processes;
use signorini_cells::description::{
    Built, Cells, Description, Geometry as Made, Part, Refinement, Scalar, Shape, build,
};
use signorini_cells::{CellsError, Elastic, End, Integration, Islands, Products, SolidMaterial, Space};
use signorini_geometry::rigid_shape::{ClosestPoints, Normals};
use signorini_geometry::{Aabb, Jet, Point, Real, Vector};
use signorini_solid::stiffness::NEARLY_INCOMPRESSIBLE;
use std::sync::Arc;

/// Degree of the functions where it is not stated.
pub const DEGREE: usize = 3;
/// Parts of each side of the box of the cells, between which a modulus that varies is looked at.
const SAMPLES: usize = 20;
/// Names of the sides of the grid by direction, the lower one first; in the plane the second direction is up.
const SIDES: [[&str; 2]; 3] = [["left", "right"], ["front", "back"], ["bottom", "top"]];

/// The name of the whole surface: the recovered boundary, and the sides of the grid.
pub(super) const SURFACE: &str = "surface";

impl Planner<'_> {
    /// A body of finite cells.
    pub(super) fn cells_body(&self, name: &str, key: &CellsBody, notes: &mut Vec<String>) -> Result<Built, CaseError> {
        let problem = self.problem;
        let grid = &key.mesh.grid;
        let mut corners: [Option<&List<Value>>; 2] = [grid.min.as_ref(), grid.max.as_ref()];
        if let (None, None, Geometry::Composed(Composed::Implicit(implicit))) = (corners[0], corners[1], &key.geometry)
        {
            corners = [implicit.min.as_ref(), implicit.max.as_ref()];
        }
        let bounds = match corners {
            [Some(min), Some(max)] => Some([self.position(min, LENGTH)?.into(), self.position(max, LENGTH)?.into()]),
            [None, None] => None,
            _ => return Err(problem.error(grid, "a box is given by two corners").help("min = [...], max = [...]")),
        };
        let around = match bounds {
            Some([min, max]) => Aabb::new(Point::<3>::from(min), Point::<3>::from(max)),
            None => Aabb::new(Point::<3>::repeat(-1.0), Point::<3>::repeat(1.0)),
        };
        let (material, modulus) = self.material_of_cells(key, &around)?;
        let elastic = *material.elastic();
        let of_image = matches!(&key.geometry, Geometry::Composed(Composed::Image(i)) if i.youngs_modulus.is_some());
        let constants = Self::hooke_constants(&key.material);
        if of_image && constants.is_none() {
            return Err(problem
                .error(&key.material, "the image states Young's modulus, which this material does not have alone")
                .help("material.linear_elastic, or with strain = \"finite\" material.neo_hooke"));
        }
        if let (Some(_), Some([at, _])) = (&modulus, constants) {
            if of_image {
                return Err(problem.error(at, "the image states the modulus too").help("give a constant value"));
            }
            if bounds.is_none() {
                let message = "Young's modulus varies, and the box of the cells is not stated";
                return Err(problem.error(at, message).help("mesh.grid = { min = [...], max = [...], ... }"));
            }
        }
        let geometry = match &key.geometry {
            Geometry::Shape(Stated::Stl(file)) => Made::Triangles(Arc::new(self.closed_mesh(file)?)),
            Geometry::Shape(Stated::Triangles(arrays)) => Made::Triangles(Arc::new(self.surface_of_arrays(arrays)?)),
            Geometry::Composed(Composed::Image(stated)) if stated.youngs_modulus.is_some() => {
                Made::Moduli(self.moduli(stated, elastic.youngs_modulus, notes)?)
            }
            other => Made::Shape(self.shape_of_cells(other, &around, notes)?),
        };
        let space = match self.space {
            In::ThreeD => Space::Solid,
            In::PlaneStress => Space::PlaneStress,
            In::Axisymmetric => Space::Axisymmetric,
            _ => Space::PlaneStrain,
        };
        let degree = match &key.degree {
            None => DEGREE,
            Some(n) if (1..=8).contains(n) => *n as usize,
            Some(n) => return Err(problem.error(n, format!("degree {n} is not between 1 and 8"))),
        };
        let ratio = elastic.poissons_ratio;
        if degree == 1 && space != Space::PlaneStress && ratio > NEARLY_INCOMPRESSIBLE {
            self.warn(format!("`{name}`: cells of degree 1 lock with Poisson's ratio {ratio}: use degree 2 or more"));
        }
        if degree == 1 && space != Space::PlaneStress && material.law().has_history() {
            self.warn(format!("`{name}`: cells of degree 1 lock where they yield: use degree 2 or more"));
        }
        let mut made = Description::new(name, geometry, space, self.grid_of_cells(key)?, degree, material);
        made.density = self.density(key.density.as_ref())?;
        made.bounds = bounds;
        made.modulus = modulus;
        made.processes = processes::several();
        let on_this_machine = made.processes.as_ref().map_or(1, |all| processes::started_here().min(all.count()));
        made.memory = processes::least(memory_at_hand() / on_this_machine as f64);
        made.refinement = self.refinement(key)?;
        if key.functions == Some(CellFunctions::Trunk) {
            made.products = Products::Trunk;
        }
        match &key.integration {
            None => {}
            Some(CellIntegration::Exact(exact)) => {
                let points = exact.points.as_ref().map(|n| self.between(n, 1, 40)).transpose()?;
                made.integration = Integration::Exact { points };
            }
            Some(CellIntegration::SubCells(cells)) => {
                made.integration = Integration::SubCells { subdivision: self.between(&cells.subdivision, 1, 200)? };
            }
        }
        if let Some(value) = &key.alpha {
            made.fictitious = self.reader.number(value, NONE)?;
        }
        made.islands = match key.islands {
            None | Some(IslandsKey::Refuse) => Islands::Refuse,
            Some(IslandsKey::Drop) => Islands::Drop,
            Some(IslandsKey::Keep) => Islands::Keep,
        };
        for (group, value) in &key.groups {
            let expression = self.reader.expression(value, NONE, self.places())?;
            if !expression.is_condition() {
                let message = format!("the group `{group}` must be a condition on the points of the surface");
                return Err(problem
                    .error(value, message)
                    .help("give a comparison:  z < 0.1,  or several:  x > 0 && z > 0.9"));
            }
            let holds = move |x: &Point<3>, _: &Vector<3>| {
                expression.evaluate(&Scope { position: [x.x, x.y, x.z], time: 0.0 }) > 0.0
            };
            made.places.insert(group.clone(), Part::Surface(Arc::new(holds)));
        }
        self.sides_that_are_used(name, &mut made);
        let wrong = |e: CellsError| {
            let group = |place: &str| key.groups.get(place.trim_matches('`')).map(|value| problem.key(value));
            let at = match &e {
                CellsError::Memory { .. } | CellsError::Box { .. } => problem.key(&key.mesh.grid),
                CellsError::Fictitious { .. } => {
                    key.alpha.as_ref().map_or_else(|| problem.key(&key.geometry), |value| problem.key(value))
                }
                CellsError::EmptyPlace { place, .. } => group(place).unwrap_or_else(|| problem.key(&key.geometry)),
                _ => problem.key(&key.geometry),
            };
            problem.error(&at, format!("`{name}`: {e}"))
        };
        let built = build(&made).map_err(wrong)?;
        let findings = &built.findings;
        if findings.dropped > 0.0 {
            let share = findings.dropped / (built.volume + findings.dropped);
            self.warn(format!(
                "`{name}`: pieces that are not connected to the largest one are removed, {share:.1e} of the volume"
            ));
        }
        let [low, high] = built.bounds;
        notes.push(format!(
            "`{name}`: {} cells with material in the box {low:?} to {high:?}, volume {:.6e}{}{}{}",
            built.cells,
            built.volume,
            if findings.facing_cells > 0 {
                format!(", {} cells contain two faces of it (refine.narrow divides them)", findings.facing_cells)
            } else {
                String::new()
            },
            if findings.split_leaves > 0 {
                format!(", {} of them in separate pieces", findings.split_leaves)
            } else {
                String::new()
            },
            if findings.dropped > 0.0 {
                format!(", islands of volume {:.3e} removed", findings.dropped)
            } else {
                String::new()
            },
        ));
        Ok(built)
    }

    /// Names of coordinates.
    pub(in crate::plan) fn places(&self) -> &'static [&'static str] {
        if self.space == In::ThreeD { &["x", "y", "z"] } else { &["x", "y"] }
    }

    pub(super) fn between(&self, n: &i64, least: i64, most: i64) -> Result<usize, CaseError> {
        if (least..=most).contains(n) {
            return Ok(*n as usize);
        }
        Err(self.problem.error(n, format!("{n} is not between {least} and {most}")))
    }

    /// What the cells are made of; of a Young's modulus that varies with the largest one at points of a box, and the factor of
    /// it.
    fn material_of_cells(
        &self,
        key: &CellsBody,
        around: &Aabb<3>,
    ) -> Result<(SolidMaterial, Option<(Scalar, f64)>), CaseError> {
        let material = self.material(key.strain.as_ref(), &key.material)?;
        let Some([modulus, ratio]) = Self::hooke_constants(&key.material) else { return Ok((material, None)) };
        let Some((most, factor)) = self.modulus_of_cells(modulus, around)? else {
            let constants = self.constants(modulus, ratio)?;
            return Ok(((constants, material.law().clone()).into(), None));
        };
        let constants = Elastic { youngs_modulus: most, poissons_ratio: self.poissons_ratio(ratio)? };
        Ok(((constants, material.law().clone()).into(), Some((factor, 1.0))))
    }

    /// The largest value of a modulus that varies at points of a box, and the modulus over it; none of a constant one.
    fn modulus_of_cells(&self, value: &Value, around: &Aabb<3>) -> Result<Option<(f64, Scalar)>, CaseError> {
        let expression = self.reader.expression(value, PRESSURE, self.places())?;
        if expression.constant().is_some() {
            return Ok(None);
        }
        let at = move |x: &Point<3>| expression.evaluate(&Scope { position: [x.x, x.y, x.z], time: 0.0 });
        let counts = [SAMPLES, SAMPLES, if self.space == In::ThreeD { SAMPLES } else { 0 }];
        let share = |k: usize, i: usize| i as f64 / counts[k].max(1) as f64;
        let mut most = 0.0f64;
        for (i, j, k) in (0..=counts[0])
            .flat_map(|i| (0..=counts[1]).map(move |j| (i, j)))
            .flat_map(|(i, j)| (0..=counts[2]).map(move |k| (i, j, k)))
        {
            let part = Vector::<3>::new(share(0, i), share(1, j), share(2, k));
            let x = around.min + around.size().component_mul(&part);
            let found = at(&x);
            if !(found > 0.0 && found.is_finite()) {
                let place: Vec<String> = x.iter().take(self.places().len()).map(|v| format!("{v:.6}")).collect();
                let message = format!("Young's modulus is {found} at ({})", place.join(", "));
                return Err(self
                    .problem
                    .error(value, message)
                    .help("give values above 0 in the whole box of the cells"));
            }
            most = most.max(found);
        }
        Ok(Some((most, Arc::new(move |x: &Point<3>| at(x) / most))))
    }

    fn grid_of_cells(&self, key: &CellsBody) -> Result<Cells, CaseError> {
        let grid = &key.mesh.grid;
        match (&grid.cells, &grid.cell_size) {
            (Some(list), None) => {
                let wanted = self.places().len();
                if list.len() != wanted {
                    let message = format!("expected {wanted} numbers of cells, found {}", list.len());
                    return Err(self.problem.error(list, message));
                }
                let mut count = [1; 3];
                for (c, n) in count.iter_mut().zip(list) {
                    *c = self.between(n, 1, 100_000)?;
                }
                Ok(Cells::Count(count))
            }
            (None, Some(size)) => Ok(Cells::Size(self.reader.positive(size, LENGTH)?)),
            _ => Err(self
                .problem
                .error(grid, "the number of cells is missing or given twice")
                .help("cells = [20, 20, 20], or cell_size = 0.1")),
        }
    }

    fn refinement(&self, key: &CellsBody) -> Result<Vec<Refinement>, CaseError> {
        let mut out = Vec::new();
        let Some(refine) = &key.mesh.grid.refine else { return Ok(out) };
        if let Some(levels) = &refine.narrow {
            out.push(Refinement::Narrow { levels: self.between(levels, 0, 8)? });
        }
        if let Some(levels) = &refine.boundary {
            out.push(Refinement::Boundary { levels: self.between(levels, 0, 8)? });
        }
        for near in &refine.near {
            let expression = self.reader.expression(&near.distance, LENGTH, self.places())?;
            let distance: Scalar =
                Arc::new(move |x| expression.evaluate(&Scope { position: [x.x, x.y, x.z], time: 0.0 }));
            let within = self.reader.number(&near.within, LENGTH)?;
            out.push(Refinement::Near { distance, within, levels: self.between(&near.levels, 0, 8)? });
        }
        Ok(out)
    }

    /// The axis of the side of a grid of cells that a word names, and on which end of it the side is.
    pub(super) fn side_of_cells(&self, side: &str) -> Option<(usize, End)> {
        let direction = SIDES.iter().position(|ends| ends.contains(&side))?;
        let axis = match (self.space, direction) {
            (In::ThreeD, k) => k,
            (_, 0) => 0,
            (_, 2) => 1,
            _ => return None,
        };
        Some((axis, if SIDES[direction][0] == side { End::Low } else { End::High }))
    }

    /// Sides of the grid that supports, loads or contacts name, and the whole surface where contacts name the body. A side that
    /// a support holds is where the body is cut off, by symmetry or at its base: nothing else touches it.
    fn sides_that_are_used(&self, name: &str, made: &mut Description) {
        let problem = self.problem;
        let of_body = |on: &String| {
            let (body, group) = on.split_once(':')?;
            (body.trim() == name).then(|| group.trim().to_string())
        };
        let held: Vec<String> = problem.supports.values().filter_map(|s| of_body(&s.on)).collect();
        let in_contacts = problem.contacts.values().flat_map(|c| c.between.iter().flatten());
        let places = problem.loads.values().map(|l| &l.on).chain(in_contacts);
        let used: Vec<String> = places.filter_map(of_body).chain(held.iter().cloned()).collect();
        let mut without = Vec::new();
        for word in SIDES.as_flattened() {
            let Some((axis, end)) = self.side_of_cells(word) else { continue };
            // A group of the case may have the name.
            let is_free = !made.places.contains_key(*word);
            if held.iter().any(|side| side == word) && is_free {
                without.push((axis, end));
            }
            if used.iter().any(|u| u == word) && is_free {
                made.places.insert((*word).to_string(), Part::Side { axis, end });
            }
        }
        let touches = |c: &Contact| {
            c.all == Some(true) || c.between.as_ref().is_some_and(|pair| pair.iter().any(|on| on.trim() == name))
        };
        if problem.contacts.values().any(touches) || used.iter().any(|u| u == SURFACE) {
            made.places.entry(SURFACE.to_string()).or_insert(Part::Whole { without });
        }
    }

    fn shape_of_cells(&self, key: &Geometry, around: &Aabb<3>, notes: &mut Vec<String>) -> Result<Shape, CaseError> {
        let problem = self.problem;
        let mut list = |parts: &List<Geometry>| {
            parts.iter().map(|g| self.shape_of_cells(g, around, notes)).collect::<Result<Vec<_>, _>>()
        };
        let composed = match key {
            Geometry::Shape(stated) => return self.plain_shape(stated, around),
            Geometry::Composed(composed) => composed,
        };
        Ok(match composed {
            Composed::Implicit(implicit) => {
                let expression = self.reader.expression(&implicit.negative_inside, LENGTH, self.places())?;
                Shape::Function(Arc::new(move |x| level(&expression, x)))
            }
            Composed::Box(corners) => {
                let [mut min, mut max] = [self.position(&corners.min, LENGTH)?, self.position(&corners.max, LENGTH)?];
                if self.space != In::ThreeD {
                    // The plane cuts it.
                    (min.z, max.z) = (-1.0, 1.0);
                }
                if (0..3).any(|k| min[k] >= max[k]) {
                    return Err(problem.error(corners, "the lower corner of the box is not below the upper one"));
                }
                Shape::Cuboid { min: min.into(), max: max.into() }
            }
            Composed::Image(stated) => {
                let image = self.image(stated, notes)?;
                let Some(threshold) = &stated.threshold else {
                    return Err(problem
                        .error(
                            stated,
                            "the image has neither `threshold` nor `youngs_modulus`, so the material region is not \
                             defined",
                        )
                        .help("threshold = 1200, the value above which there is material"));
                };
                let smoothing = stated.smoothing.as_ref().map_or(Ok(1.0), |v| self.reader.number(v, NONE))?;
                if smoothing < 0.0 {
                    return Err(problem
                        .error(stated, format!("the smoothing width of the image is {smoothing} voxels"))
                        .help("give 0 or more"));
                }
                Shape::Image { image, threshold: self.reader.number(threshold, NONE)?, smoothing }
            }
            Composed::Union(parts) => Shape::Union(list(parts)?),
            Composed::Intersection(parts) => Shape::Intersection(list(parts)?),
            Composed::Difference(parts) => Shape::Difference(list(parts)?),
            Composed::Offset(offset) => Shape::Offset {
                of: Box::new(self.shape_of_cells(&offset.of, around, notes)?),
                distance: self.reader.number(&offset.distance, LENGTH)?,
            },
        })
    }

    /// A shape of a rigid body.
    fn plain_shape(&self, stated: &Stated, around: &Aabb<3>) -> Result<Shape, CaseError> {
        let plane = self.space != In::ThreeD;
        match stated {
            Stated::Sphere(key) => {
                let center = self.position(&key.center, LENGTH)?.into();
                Ok(Shape::Ellipsoid { center, semi_axes: [self.reader.positive(&key.radius, LENGTH)?; 3] })
            }
            Stated::Ellipsoid(key) => {
                let mut semi_axes: [f64; 3] = self.position(&key.semi_axes, LENGTH)?.into();
                if plane {
                    semi_axes[2] = 1.0;
                }
                if semi_axes.iter().any(|a| *a <= 0.0) {
                    return Err(self.problem.error(&key.semi_axes, "all semi-axes must be positive"));
                }
                Ok(Shape::Ellipsoid { center: self.position(&key.center, LENGTH)?.into(), semi_axes })
            }
            Stated::Stl(file) => {
                let mesh = self.closed_mesh(file)?;
                Ok(Shape::Rigid(Arc::new(ClosestPoints { shape: mesh.into(), normals: Normals::Outward })))
            }
            Stated::LevelSet(key) => {
                // Where it is negative is all that matters: no distances from it.
                let expression = self.reader.expression(&key.negative_inside, LENGTH, self.places())?;
                Ok(Shape::Function(Arc::new(move |x| level(&expression, x))))
            }
            other if plane => Ok(Shape::Rigid(rigid::shape::<2>(self, other, around)?)),
            other => Ok(Shape::Rigid(rigid::shape::<3>(self, other, around)?)),
        }
    }
}

/// An expression with its derivatives.
fn level(expression: &Expression, x: &Point<3>) -> Jet<3> {
    let position = [0, 1, 2].map(|k| Jet::<3>::variable(x[k], k));
    expression.evaluate(&Scope { position, time: Jet::<3>::constant(0.0) })
}
