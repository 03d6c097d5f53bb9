//! What can be wrong with a body of finite cells.

use signorini_geometry::shape::ShapeError;
use signorini_solve::SolveError;

/// A body, support, load or contact that cannot be computed, with the values and what would do.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CellsError {
    #[error("the box with corners {corners:?} must have finite corners, the first below the second in each direction")]
    Box { corners: Vec<f64> },
    #[error("{cells:?} cells: there must be one at least in each direction")]
    NoCells { cells: Vec<usize> },
    #[error(
        "{cells} cells need about {needed:.1} GiB of memory, and {free:.1} GiB are free for them: use fewer or larger \
         cells, or a lower degree"
    )]
    Memory { cells: f64, needed: f64, free: f64 },
    #[error("degree {degree} is not between 1 and {most}")]
    Degree { degree: usize, most: usize },
    #[error("the fictitious stiffness {value} is not between 0 and 1; 1e-8 serves most bodies")]
    Fictitious { value: f64 },
    #[error("{name} = {value} {must}")]
    Value { name: &'static str, value: f64, must: &'static str },
    #[error("the shape has the value {value} at {at:?}; it must be finite everywhere in the box of the cells")]
    NotFinite { at: Vec<f64>, value: f64 },
    #[error(
        "the shape is negative nowhere in the box of the cells, so that there is no material: it must be negative inside \
         the body, and the box must hold the body"
    )]
    Nothing,
    #[error(
        "the shape is negative everywhere in the box of the cells, so that there is no boundary to hold, load or touch \
         but the sides of the box; where that is meant, say that the boundary is optional"
    )]
    Everything,
    #[error(
        "{count} pieces of the body do not hang together with the largest; the next has the volume {volume:.4e} and lies \
         about {at:?}. Drop them (`islands = \"drop\"`), hold each of them, or close the gaps"
    )]
    Islands { count: usize, volume: f64, at: Vec<f64> },
    #[error(
        "no part of the boundary lies in {place}: the cells with material lie between {low:.4?} and {high:.4?}; move the place, or the \
         body"
    )]
    EmptyPlace { place: String, low: Vec<f64>, high: Vec<f64> },
    #[error("direction {axis} is not one of the {dimension} of the body")]
    Axis { axis: usize, dimension: usize },
    #[error("a body around an axis must lie where the radius is not negative; its box begins at {radius}")]
    NegativeRadius { radius: f64 },
    #[error(
        "the surface of the STL is open: in the column about y = {y}, z = {z} its facets enclose {share:.1e} of the \
         section too much or too little. Close the holes of the surface, or use its shape as an image"
    )]
    OpenSurface { y: f64, z: f64, share: f64 },
    #[error(
        "the surface of triangles overlaps itself: about {at:.4?} it encloses the same place twice, or a cavity has its outside \
         inwards. Unite its parts, or turn the triangles of the cavity round"
    )]
    OverlappingSurface { at: Vec<f64> },
    #[error(
        "the threshold {threshold} leaves nothing or everything of the image: its values go from {least} to {most}, and \
         material is what lies above the threshold"
    )]
    Threshold { threshold: f64, least: f64, most: f64 },
    #[error(
        "voxel {voxel:?}, counted from zero along x, y, z, has the value {value}: all must be finite; replace it in the image"
    )]
    Voxel { voxel: Vec<usize>, value: f64 },
    #[error("{what} of shape {found:?} cannot be used: {must}")]
    Image { what: &'static str, found: Vec<usize>, must: &'static str },
    #[error(
        "nothing holds the body along {modes} of its rigid motions, so that it has no equilibrium: support it, or let \
         contact press it against something"
    )]
    Unsupported { modes: usize },
    #[error(
        "the stiffness is not positive near {at:?}: what little material a cell there holds is lost in rounding beside a \
         fictitious stiffness of {fictitious:.0e}, or a contact there softens more than the body resists. Try a larger \
         fictitious stiffness, a lower degree or larger cells; with contact a smaller step"
    )]
    NotPositive { at: Vec<f64>, fictitious: f64 },
    #[error("the contact did not converge in {iterations} iterations: the residual is {residual:.1e} of the forces")]
    NotConverged { iterations: usize, residual: f64 },
    #[error(
        "conjugate gradients reached a residual of {residual:.1e} in {iterations} iterations only; a direct solver or a \
         larger fictitious stiffness helps"
    )]
    Iterations { iterations: usize, residual: f64 },
    #[error(
        "no box of cells is given, and this geometry has no bounds of its own: state the corners of a box that holds it"
    )]
    NoBox,
    #[error("{count} parts of a {what}: there must be {least} at least")]
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
