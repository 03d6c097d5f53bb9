//! Bodies of finite cells from plain data: what a case file states, without the dimension in a type.
//!
//! Positions have three components; in the plane and around an axis the third is left out, and shapes of space are cut at
//! `z = 0`.

mod shape;

use crate::body::CellBody;
use crate::cell::Findings;
use crate::cell_solid::CellSolid;
use crate::components::Pieces;
use crate::discretisation::{Boundary, CellMaterial, Discretisation, Islands};
use crate::error::CellsError;
use crate::facets::FacetBody;
use crate::image::ImageData;
use crate::moments::VolumePoints;
use crate::place::Place;
use crate::region::{BoundaryPoint, Filling, Integration, Region};
use crate::shapes::spatial;
use crate::space::Products;
use crate::tree::CellTree;
use crate::voxels::ModulusImage;
pub use shape::Shape;
use signorini_fem::cut::End;
use signorini_geometry::mesh::TriangleMesh;
use signorini_geometry::{Aabb, Point, Vector};
use signorini_material::{SolidMaterial, Space};
use signorini_mechanics::Body;
use signorini_mechanics::processes::Processes;
use std::any::Any;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A function of a position in space.
pub type Scalar = Arc<dyn Fn(&Point<3>) -> f64 + Send + Sync>;

/// Whether a point of the surface, with its outward normal, belongs to a place.
pub type Holds = Arc<dyn Fn(&Point<3>, &Vector<3>) -> bool + Send + Sync>;

/// Where material is.
#[derive(Clone)]
pub enum Geometry {
    /// Where a shape is negative.
    Shape(Shape),
    /// Inside a closed surface of triangles, in space only.
    Triangles(Arc<TriangleMesh>),
    /// Voxels with a factor of Young's modulus each; none where it is zero. They have no recovered boundary: only sides of
    /// the box can be places.
    Moduli(ImageData),
}

/// How many cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cells {
    /// In each direction.
    Count([usize; 3]),
    /// As many as keep their sides below a length.
    Size(f64),
}

/// Which cells are halved in every direction, and how often.
#[derive(Clone)]
pub enum Refinement {
    /// In which the boundary faces itself or turns by more than half a radian: pores, gaps and tips narrower than a cell.
    Narrow { levels: usize },
    /// That the boundary cuts.
    Boundary { levels: usize },
    /// That come within a distance of something, by a function that changes no faster than position: the distance of a
    /// point, the gap to a body that will be touched.
    Near { distance: Scalar, within: f64, levels: usize },
}

/// A part of the surface that has a name.
#[derive(Clone)]
pub enum Part {
    /// The material on a side of the box of the cells.
    Side { axis: usize, end: End },
    /// Points of the recovered boundary.
    Boundary(Holds),
    /// Points of the recovered boundary and of the material on sides of the box.
    Surface(Holds),
    /// The whole surface but these sides of the box, on which the body is cut off.
    Whole { without: Vec<(usize, End)> },
}

/// A body of finite cells.
#[derive(Clone)]
pub struct Description {
    pub name: String,
    pub geometry: Geometry,
    pub space: Space,
    /// Corners of the box of the cells; those of the geometry, if it has any, where they are left out.
    pub bounds: Option<[[f64; 3]; 2]>,
    pub cells: Cells,
    pub refinement: Vec<Refinement>,
    /// Degree of the functions, 1 to 8.
    pub degree: usize,
    pub products: Products,
    pub integration: Integration,
    /// Stiffness outside the material relative to that inside.
    pub fictitious: f64,
    pub pieces: Pieces,
    pub islands: Islands,
    pub material: SolidMaterial,
    /// Mass per volume.
    pub density: Option<f64>,
    /// A factor of all moduli, with its largest value.
    pub modulus: Option<(Scalar, f64)>,
    /// The whole recovered boundary is always there as `boundary`.
    pub places: BTreeMap<String, Part>,
    /// Memory in bytes that the body and its equations may take: the same on all processes.
    pub memory: f64,
    /// Those that make the same body together; all of them do.
    pub processes: Option<Arc<dyn Processes>>,
}

impl Description {
    /// With what serves most bodies.
    pub fn new(
        name: &str,
        geometry: Geometry,
        space: Space,
        cells: Cells,
        degree: usize,
        material: impl Into<SolidMaterial>,
    ) -> Self {
        let Discretisation { products, integration, fictitious, pieces, islands, .. } =
            Discretisation::<3>::of_degree(degree);
        Description {
            name: name.to_string(),
            geometry,
            space,
            bounds: None,
            cells,
            refinement: Vec::new(),
            degree,
            products,
            integration,
            fictitious,
            pieces,
            islands,
            material: material.into(),
            density: None,
            modulus: None,
            places: BTreeMap::new(),
            memory: f64::INFINITY,
            processes: None,
        }
    }
}

/// A body that was built, and what was found out about it.
pub struct Built {
    pub body: Box<dyn Body>,
    pub findings: Findings,
    /// Of the material; per thickness in the plane, of the whole turn around an axis.
    pub volume: f64,
    /// Cells with material.
    pub cells: usize,
    /// The box of the cells.
    pub bounds: [[f64; 3]; 2],
}

/// Builds a body.
///
/// # Errors
/// What cannot be computed, with what would do.
pub fn build(description: &Description) -> Result<Built, CellsError> {
    if description.space == Space::Solid { in_dimension::<3>(description) } else { in_dimension::<2>(description) }
}

fn in_dimension<const D: usize>(d: &Description) -> Result<Built, CellsError> {
    let given = d.bounds.map(|[min, max]| Aabb::new(Point::<3>::from(min), Point::<3>::from(max)));
    let whole = given.or_else(|| d.geometry.bounds()).ok_or(CellsError::NoBox)?;
    let bounds = Aabb::new(flat::<D>(&whole.min), flat::<D>(&whole.max));
    let count = d.cells.count(&bounds)?;
    let mut tree = CellTree::within(d.memory, bounds, count)?;
    let mut modulus = d.modulus.clone().map(|(factor, most)| in_body::<D>(factor, most));
    let mut optional = Boundary::Expected;
    let region: Arc<dyn Region<D>> = match &d.geometry {
        Geometry::Shape(shape) => Arc::new(shape.domain::<D>(&whole, count.iter().copied().max().unwrap_or(1))?),
        Geometry::Triangles(mesh) => of_space::<D>(Arc::new(FacetBody::new((**mesh).clone())?))?,
        Geometry::Moduli(image) => {
            if modulus.is_some() {
                let must = "must be given once, by the image or as a function";
                return Err(CellsError::Value { name: "modulus", value: f64::NAN, must });
            }
            let image = ModulusImage::new(image.clone().voxels::<D>()?)?;
            modulus = Some(image.modulus());
            Arc::new(image)
        }
    };
    // What fills its box has no boundary in it, and is meant where a place lies on a side of the box.
    let on_box = |p: &Part| matches!(p, Part::Side { .. } | Part::Surface(_) | Part::Whole { .. });
    if d.places.values().any(on_box) {
        optional = Boundary::Optional;
    }
    refine(&mut tree, &*region, d)?;
    let refine_narrow = (d.refinement.iter())
        .map(|r| if let Refinement::Narrow { levels } = r { *levels } else { 0 })
        .max()
        .unwrap_or(0);
    let setup = Discretisation {
        degree: d.degree,
        products: d.products,
        integration: d.integration,
        volume_points: match &d.geometry {
            // Fitted points lie outside of the material too, where a law that is not linear has nothing to say.
            Geometry::Shape(Shape::Image { .. }) | Geometry::Moduli(_) if d.material.law().is_linear() => {
                VolumePoints::Fitted
            }
            _ => VolumePoints::InMaterial,
        },
        fictitious: d.fictitious,
        pieces: d.pieces,
        islands: d.islands,
        boundary: optional,
        refine_narrow,
        memory: d.memory,
        processes: d.processes.clone(),
    };
    let body = CellBody::new(region, tree, setup, CellMaterial { solid: d.material.clone(), modulus, space: d.space })?;
    let (findings, volume, cells) = (body.findings().clone(), body.volume(), body.cells().len());
    let places = d.places.iter().map(|(name, part)| (name.clone(), part.place::<D>())).collect();
    let body = CellSolid::new(&d.name, body, &places)?.with_density(d.density);
    let bounds = [spatial(&bounds.min).into(), spatial(&bounds.max).into()];
    Ok(Built { body: Box::new(body), findings, volume, cells, bounds })
}

fn refine<const D: usize>(tree: &mut CellTree<D>, region: &dyn Region<D>, d: &Description) -> Result<(), CellsError> {
    for refinement in &d.refinement {
        match refinement {
            Refinement::Narrow { .. } => {}
            Refinement::Boundary { levels } => {
                for _ in 0..*levels {
                    tree.refine(|l| region.rule(&l.bounds, &d.integration, d.degree).filling == Filling::Cut)?;
                }
            }
            Refinement::Near { distance, within, levels } => {
                for _ in 0..*levels {
                    tree.refine(|l| distance(&spatial(&l.bounds.center())).abs() <= within + l.bounds.radius())?;
                }
            }
        }
    }
    Ok(())
}

fn flat<const D: usize>(x: &Point<3>) -> Point<D> {
    Point::<D>::from_fn(|k, _| x[k])
}

fn in_body<const D: usize>(factor: Scalar, most: f64) -> (crate::cell::Field<D>, f64) {
    (Arc::new(move |x: &Point<D>| factor(&spatial(x))), most)
}

/// A region of space as one of the dimension of the body.
fn of_space<const D: usize>(region: Arc<dyn Region<3>>) -> Result<Arc<dyn Region<D>>, CellsError> {
    // The same type where `D` is 3.
    let any: Box<dyn Any> = Box::new(region);
    any.downcast::<Arc<dyn Region<D>>>().map(|r| *r).map_err(|_| CellsError::InPlane {
        what: "a surface of triangles",
        remedy: "use the body in space, or give its section by a shape",
    })
}

impl Geometry {
    /// The box of the geometry, where it has one.
    pub fn bounds(&self) -> Option<Aabb<3>> {
        match self {
            Geometry::Shape(shape) => shape.bounds(),
            Geometry::Triangles(mesh) => Some(*mesh.bounds()),
            Geometry::Moduli(image) => shape::image_bounds(image),
        }
    }
}

impl Cells {
    fn count<const D: usize>(self, bounds: &Aabb<D>) -> Result<[usize; D], CellsError> {
        match self {
            Cells::Count(count) => Ok(std::array::from_fn(|k| count[k])),
            Cells::Size(size) => {
                if !(size > 0.0 && size.is_finite()) {
                    return Err(CellsError::Value { name: "cell_size", value: size, must: "must be positive" });
                }
                Ok(std::array::from_fn(|k| ((bounds.size()[k] / size - 1e-9).ceil().max(1.0)) as usize))
            }
        }
    }
}

impl Part {
    fn place<const D: usize>(&self) -> Place<D> {
        let lifted = |holds: &Holds| {
            let holds = holds.clone();
            Arc::new(move |p: &BoundaryPoint<D>| holds(&spatial(&p.x), &spatial(&p.normal)))
        };
        match self {
            Part::Side { axis, end } => Place::Side { axis: *axis, end: *end },
            Part::Boundary(holds) => Place::Boundary(lifted(holds)),
            Part::Surface(holds) => Place::Surface(lifted(holds)),
            Part::Whole { without } => Place::Whole { without: without.clone() },
        }
    }
}
