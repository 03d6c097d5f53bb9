//! What can be wrong with a body of finite cells.

use signorini_geometry::shape::ShapeError;
use signorini_solve::SolveError;

/// A body or a place of it that cannot be computed, with the values and what would do.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CellsError {
    #[error(
        "the corners of the box {corners:?} must be finite, and the first must be below the second in each direction"
    )]
    Box { corners: Vec<f64> },
    #[error("{cells:?} cells: at least one is required in each direction")]
    NoCells { cells: Vec<usize> },
    #[error(
        "{cells} cells require about {needed:.1} GiB of memory, but {free:.1} GiB are free: use fewer or larger \
         cells, or a lower degree"
    )]
    Memory { cells: f64, needed: f64, free: f64 },
    #[error("degree {degree} is not between 1 and {most}")]
    Degree { degree: usize, most: usize },
    #[error("the fictitious stiffness {value} is not between 0 and 1; 1e-8 is suitable for most bodies")]
    Fictitious { value: f64 },
    #[error("{name} = {value} {must}")]
    Value { name: &'static str, value: f64, must: &'static str },
    #[error("the shape has the value {value} at {at:?}; it must be finite everywhere in the box of the cells")]
    NotFinite { at: Vec<f64>, value: f64 },
    #[error(
        "the shape is negative nowhere in the box of the cells, so there is no material: it must be negative inside \
         the body, and the box must contain the body"
    )]
    Nothing,
    #[error(
        "the shape is negative everywhere in the box of the cells, so only the sides of the box can have supports, \
         loads or contact; if this is intended, declare the boundary as optional"
    )]
    Everything,
    #[error(
        "{count} pieces of the body are not connected to the largest one; the next one has the volume {volume:.4e} \
         and lies near {at:?}. Remove them (`islands = \"drop\"`), support each of them, or close the gaps"
    )]
    Islands { count: usize, volume: f64, at: Vec<f64> },
    #[error(
        "no part of the boundary lies in {place}: the cells with material lie between {low:.4?} and {high:.4?}; move \
         this region, or the body"
    )]
    EmptyPlace { place: String, low: Vec<f64>, high: Vec<f64> },
    #[error("direction {axis} is not one of the {dimension} directions of the body")]
    Axis { axis: usize, dimension: usize },
    #[error("the radius must not be negative in an axisymmetric body, but its box begins at {radius}")]
    NegativeRadius { radius: f64 },
    #[error(
        "the surface of the STL is open: in the column near y = {y}, z = {z} its facets enclose {share:.1e} of the \
         section too much or too little. Close the holes of the surface, or use its shape as an image"
    )]
    OpenSurface { y: f64, z: f64, share: f64 },
    #[error(
        "the triangulated surface overlaps itself: near {at:.4?} it encloses the same point twice, or the normals of \
         a cavity point outwards. Unite its parts, or reverse the triangles of the cavity"
    )]
    OverlappingSurface { at: Vec<f64> },
    #[error(
        "with the threshold {threshold} all or none of the image is material: its values are between {least} and \
         {most}, and material is above the threshold"
    )]
    Threshold { threshold: f64, least: f64, most: f64 },
    #[error(
        "voxel {voxel:?}, counted from zero along x, y, z, has the value {value}: all values must be finite; replace \
         it in the image"
    )]
    Voxel { voxel: Vec<usize>, value: f64 },
    #[error("{what} of shape {found:?} cannot be used: {must}")]
    Image { what: &'static str, found: Vec<usize>, must: &'static str },
    #[error(
        "the case has no box of cells, and this geometry has no bounds of its own: give the corners of a box around \
         it"
    )]
    NoBox,
    #[error("{count} parts of a {what}: at least {least} are required")]
    NoParts { what: &'static str, count: usize, least: usize },
    #[error("{what} in the plane: {remedy}")]
    InPlane { what: &'static str, remedy: &'static str },
    #[error(transparent)]
    Shape(#[from] ShapeError),
    #[error(transparent)]
    Solve(#[from] SolveError),
}

impl CellsError {
    /// An error where so many cells need more bytes than are free.
    pub(crate) fn check_memory(cells: f64, needed: f64, free: f64) -> Result<(), CellsError> {
        let gib = |bytes: f64| bytes / (1u64 << 30) as f64;
        if needed <= free {
            return Ok(());
        }
        Err(CellsError::Memory { cells, needed: gib(needed), free: gib(free) })
    }
}
