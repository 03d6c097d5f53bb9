//! Bodies of finite cells of a system, from shapes, surfaces and images.

use crate::expression::{Expression, Scope};
use crate::plan::memory_at_hand;
use crate::plan::planner::Planner;
use crate::plan::rigid;
use crate::problem::units::{LENGTH, NONE, PRESSURE};
use crate::problem::{
    CaseError, CellFunctions, CellIntegration, CellsBody, Composed, Geometry, ImageGeometry, IslandsKey, List,
    Material, Shape as Stated, Space as In, Value,
};
use signorini_cells::description::{
    Built, Cells, Description, Geometry as Made, Part, Refinement, Scalar, Shape, build,
};
use signorini_cells::image::raw::RawHeader;
use signorini_cells::image::{self, Endian, ImageData, Number};
use signorini_cells::{CellsError, Elastic, End, Integration, Islands, Products, Space};
use signorini_geometry::rigid_shape::{ClosestPoints, Normals};
use signorini_geometry::{Aabb, Jet, Point, Real, Vector};
use std::sync::Arc;

/// Degree of the functions where it is not stated.
pub const DEGREE: usize = 3;
/// Names of the sides of the grid by direction, the lower one first; in the plane the second direction is up.
const SIDES: [[&str; 2]; 3] = [["left", "right"], ["front", "back"], ["bottom", "top"]];

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
            _ => return Err(problem.error(grid, "a box has two corners").help("min = [...], max = [...]")),
        };
        let around = match bounds {
            Some([min, max]) => Aabb::new(Point::<3>::from(min), Point::<3>::from(max)),
            None => Aabb::new(Point::<3>::repeat(-1.0), Point::<3>::repeat(1.0)),
        };
        let elastic = self.elastic_of_cells(key)?;
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
        let mut made = Description::new(name, geometry, space, self.grid_of_cells(key)?, degree, elastic);
        made.bounds = bounds;
        made.memory = memory_at_hand();
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
        if let Some(value) = &key.fictitious {
            made.fictitious = self.reader.number(value, NONE)?;
        }
        made.islands = match key.islands {
            None | Some(IslandsKey::Refuse) => Islands::Refuse,
            Some(IslandsKey::Drop) => Islands::Drop,
            Some(IslandsKey::Keep) => Islands::Keep,
        };
        for (group, value) in &key.groups {
            let expression = self.reader.expression(value, NONE, self.places())?;
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
                    key.fictitious.as_ref().map_or_else(|| problem.key(&key.geometry), |value| problem.key(value))
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
            self.warn(format!("`{name}`: pieces apart from the largest are left out, {share:.1e} of the whole volume"));
        }
        let [low, high] = built.bounds;
        notes.push(format!(
            "`{name}`: {} cells with material in the box {low:?} to {high:?}, volume {:.6e}{}{}{}",
            built.cells,
            built.volume,
            if findings.facing_cells > 0 {
                format!(", {} cells see two faces of it (refine.narrow divides them)", findings.facing_cells)
            } else {
                String::new()
            },
            if findings.split_leaves > 0 {
                format!(", {} of them in pieces of their own", findings.split_leaves)
            } else {
                String::new()
            },
            if findings.dropped > 0.0 {
                format!(", islands of volume {:.3e} dropped", findings.dropped)
            } else {
                String::new()
            },
        ));
        Ok(built)
    }

    /// Names of coordinates.
    fn places(&self) -> &'static [&'static str] {
        if self.space == In::ThreeD { &["x", "y", "z"] } else { &["x", "y"] }
    }

    fn between(&self, n: &i64, least: i64, most: i64) -> Result<usize, CaseError> {
        if (least..=most).contains(n) {
            return Ok(*n as usize);
        }
        Err(self.problem.error(n, format!("{n} is not between {least} and {most}")))
    }

    fn elastic_of_cells(&self, key: &CellsBody) -> Result<Elastic, CaseError> {
        let Material::LinearElastic(constants) = &key.material else {
            return Err(self
                .problem
                .error(&key.material, "finite cells are linear elastic, at small strain")
                .help("material.linear_elastic = { youngs_modulus = …, poissons_ratio = … }"));
        };
        let youngs_modulus = self.reader.positive(&constants.youngs_modulus, PRESSURE)?;
        let poissons_ratio = self.reader.number(&constants.poissons_ratio, NONE)?;
        if !(poissons_ratio > -1.0 && poissons_ratio < 0.5) {
            return Err(self
                .problem
                .error(&constants.poissons_ratio, format!("Poisson's ratio is {poissons_ratio}"))
                .help("above -1 and below 0.5"));
        }
        Ok(Elastic { youngs_modulus, poissons_ratio })
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
                .error(grid, "the number of cells is not said, or said twice")
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

    /// Sides of the grid that supports, loads or contacts name.
    fn sides_that_are_used(&self, name: &str, made: &mut Description) {
        let problem = self.problem;
        let places = (problem.supports.values().map(|s| &s.on))
            .chain(problem.loads.values().map(|l| &l.on))
            .chain(problem.contacts.values().flat_map(|c| c.between.iter().flatten()));
        let used: Vec<String> = places
            .filter_map(|on| on.split_once(':'))
            .filter(|(b, _)| b.trim() == name)
            .map(|p| p.1.trim().into())
            .collect();
        for (direction, ends) in SIDES.iter().enumerate() {
            for (word, end) in ends.iter().zip([End::Low, End::High]) {
                let axis = match (self.space, direction) {
                    (In::ThreeD, k) => k,
                    (_, 0) => 0,
                    (_, 2) => 1,
                    _ => continue,
                };
                if used.iter().any(|u| u == word) && !made.places.contains_key(*word) {
                    made.places.insert((*word).to_string(), Part::Side { axis, end });
                }
            }
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
                        .error(stated, "the image says where material is by neither `threshold` nor `youngs_modulus`")
                        .help("threshold = 1200, the value above which there is material"));
                };
                let smoothing = stated.smoothing.as_ref().map_or(Ok(1.0), |v| self.reader.number(v, NONE))?;
                if smoothing < 0.0 {
                    return Err(problem
                        .error(stated, format!("the image is smoothed by {smoothing} voxels"))
                        .help("0 or more"));
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

    /// Factors of Young's modulus, voxel by voxel.
    fn moduli(&self, stated: &ImageGeometry, modulus: f64, notes: &mut Vec<String>) -> Result<ImageData, CaseError> {
        let mut image = self.image(stated, notes)?;
        let Some(value) = &stated.youngs_modulus else { return Ok(image) };
        if let Some(threshold) = &stated.threshold {
            return Err(self
                .problem
                .error(threshold, "the image says where material is in two ways")
                .help("`threshold` for a surface, or `youngs_modulus` for a modulus of every voxel"));
        }
        let expression = self.reader.expression(value, PRESSURE, &["value"])?;
        for v in &mut image.values {
            let found = expression.evaluate(&Scope { position: [*v, 0.0, 0.0], time: 0.0 });
            if !(found.is_finite() && found >= 0.0) {
                return Err(self.problem.error(value, format!("Young's modulus is {found} where the image is {v}")));
            }
            *v = found / modulus;
        }
        Ok(image)
    }

    /// An image with x first, in base units.
    fn image(&self, stated: &ImageGeometry, notes: &mut Vec<String>) -> Result<ImageData, CaseError> {
        let problem = self.problem;
        let dimension = self.places().len();
        let vector = |values: &List<Value>| self.position(values, LENGTH);
        // Files that a header names lie beside it.
        let folder = std::path::Path::new(&stated.file).parent().map(std::path::Path::to_path_buf).unwrap_or_default();
        let load = |name: &str| {
            let beside = folder.join(name).to_string_lossy().into_owned();
            self.read_file(&beside).map(|found| found.1).map_err(|e| e.message)
        };
        let told = |e: image::ImageError| problem.error(&stated.file, e.to_string());
        let read = match (&stated.numbers, &stated.counts) {
            (Some(numbers), Some(counts)) => {
                let (number, endian) = self.stored(numbers)?;
                let along = counts.iter().map(|n| self.between(n, 1, 1_000_000)).collect::<Result<Vec<_>, _>>()?;
                let n = along.len();
                // Counts are along x, y, z; in the file the last of `axes` runs fastest.
                let order: Vec<usize> =
                    stated.axes.as_deref().unwrap_or("zyx").chars().rev().filter_map(|c| "xyz".find(c)).collect();
                let is_order = order.len() == n && (0..n).all(|k| order.contains(&k));
                let count = (0..n).map(|k| along[if is_order { order[k] } else { k }]).collect();
                let header = RawHeader { count, spacing: Vec::new(), origin: vec![0.0; n], number, endian, skip: 0 };
                let (_, bytes) = self.read_file(&stated.file)?;
                image::raw::parse(&bytes, &header)
                    .map_err(|wrong| problem.error(&stated.file, format!("`{}`: {wrong}", stated.file)))?
            }
            (None, None) if problem.source.folder().join(&stated.file).is_dir() => {
                image::read(&problem.source.folder().join(&stated.file)).map_err(told)?
            }
            (None, None) => {
                let (_, first) = self.read_file(&stated.file)?;
                image::read_with(&stated.file, &first, &load).map_err(told)?
            }
            _ => {
                return Err(problem.error(stated, "a file without header needs both `numbers` and `counts`"));
            }
        };
        let mut image = self.in_order(stated, read)?;
        if stated.spacing.is_none() && image.spacing.is_empty() {
            return Err(problem
                .error(stated, format!("`{}` does not say how large its voxels are", stated.file))
                .help("spacing = [0.1, 0.1, 0.1], along x, y and z"));
        }
        if let Some(spacing) = &stated.spacing {
            let found = vector(spacing)?;
            if let Some(k) = (0..dimension).find(|k| found[*k] <= 0.0) {
                let message = format!("the extent of the voxels along {} is {}", ["x", "y", "z"][k], found[k]);
                return Err(problem.error(spacing, message).help("positive lengths"));
            }
            image.spacing = (0..dimension).map(|k| found[k]).collect();
        }
        if let Some(origin) = &stated.origin {
            let found = vector(origin)?;
            image.origin = (0..dimension).map(|k| found[k]).collect();
        }
        let (least, most) =
            image.values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(*v), b.max(*v)));
        let above = match &stated.threshold {
            Some(threshold) => {
                let threshold = self.reader.number(threshold, NONE)?;
                let share = image.values.iter().filter(|v| **v > threshold).count() as f64 / image.values.len() as f64;
                format!(", {:.1} % of them above the threshold", 100.0 * share)
            }
            None => String::new(),
        };
        notes.push(format!(
            "`{}`: {:?} voxels along x, y, z of size {:?} from {:?}; values from {least} to {most}{above}",
            stated.file, image.count, image.spacing, image.origin
        ));
        Ok(image)
    }

    /// How the numbers of a file without header are stored: `u8` to `f64`, with `be` at the end for the highest byte first.
    fn stored(&self, word: &String) -> Result<(Number, Endian), CaseError> {
        let (plain, endian) = word.strip_suffix("be").map_or((word.as_str(), Endian::Little), |w| (w, Endian::Big));
        let number = match plain {
            "u8" => Number::U8,
            "i8" => Number::I8,
            "u16" => Number::U16,
            "i16" => Number::I16,
            "u32" => Number::U32,
            "i32" => Number::I32,
            "u64" => Number::U64,
            "i64" => Number::I64,
            "f32" => Number::F32,
            "f64" => Number::F64,
            _ => {
                return Err(self.problem.error(word, format!("unknown kind of numbers `{word}`")).help(
                    "u8, i8, u16, i16, u32, i32, u64, i64, f32 or f64, with `be` at the end for the highest byte first",
                ));
            }
        };
        Ok((number, endian))
    }

    /// An image whose directions are in the order x, y, z, the first running fastest.
    fn in_order(&self, stated: &ImageGeometry, image: ImageData) -> Result<ImageData, CaseError> {
        let problem = self.problem;
        let dimension = self.places().len();
        let mut n = image.count.len();
        while n > dimension && image.count[n - 1] == 1 {
            n -= 1;
        }
        if n != dimension {
            let message =
                format!("`{}` has {n} directions, {:?} voxels: {dimension} are wanted", stated.file, image.count);
            return Err(problem.error(&stated.file, message));
        }
        let Some(axes) = &stated.axes else { return Ok(image) };
        let letters: Vec<char> = axes.chars().rev().collect();
        let place: Option<Vec<usize>> =
            ['x', 'y', 'z'].iter().take(n).map(|c| letters.iter().position(|l| l == c)).collect();
        let Some(place) = place.filter(|_| letters.len() == n) else {
            let known = if n == 3 { "zyx, xyz, yxz …" } else { "yx or xy" };
            return Err(problem.error(axes, format!("`{axes}` is no order of the directions")).help(known));
        };
        let mut strides = vec![1; n];
        (1..n).for_each(|k| strides[k] = strides[k - 1] * image.count[k - 1]);
        let pick = |list: &[f64]| place.iter().filter_map(|k| list.get(*k).copied()).collect::<Vec<f64>>();
        let count: Vec<usize> = place.iter().map(|k| image.count[*k]).collect();
        let values = (0..image.values.len())
            .map(|mut index| {
                let mut from = 0;
                for (c, k) in count.iter().zip(&place) {
                    from += index % c * strides[*k];
                    index /= c;
                }
                image.values[from]
            })
            .collect();
        Ok(ImageData { spacing: pick(&image.spacing), origin: pick(&image.origin), count, values })
    }
}

/// An expression with its derivatives.
fn level(expression: &Expression, x: &Point<3>) -> Jet<3> {
    let position = [0, 1, 2].map(|k| Jet::<3>::variable(x[k], k));
    expression.evaluate(&Scope { position, time: Jet::<3>::constant(0.0) })
}
