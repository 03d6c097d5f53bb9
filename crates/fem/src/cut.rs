//! Quadrature on cells that implicit surfaces divide into regions.
//!
//! Dimension reduction after R. Saye, *High-order quadrature methods for implicitly defined surfaces and volumes in
//! hyperrectangles*, SIAM J. Sci. Comput. 37 (2015): a *height direction* is chosen along which every surface is a
//! graph over the rest of the cell, the base is broken where a surface meets the two faces normal to it, and on each
//! line in the height direction the surfaces are single roots. The roots carry the surface rule with the weight
//! `|∇φ| / |∂_k φ|`; the segments between them carry the volume rules. All weights are positive. Where no direction
//! serves, the cell is split.
//!
//! One pass yields the rules of *all* regions, so the volumes of a cell's parts add up to the cell to round-off.
//!
//! [`cut_cell`] is the rule of lines and of the plane; [`height`] does the same by recursion over the dimension, in
//! space too, with the curves in which surfaces intersect; [`simplices`] cuts sub-cells along chords.

pub mod height;
mod material;
mod partition;
mod plane;
mod roots;
pub mod simplices;

pub use height::{End, height_functions};
pub use material::material;
pub use partition::{CellPartition, CellRule, Partition, QuadraturePoint, RegionId, SurfacePoint};
pub use plane::cut_cell;
pub use roots::scan_roots;
pub use simplices::{space_tree, sub_cells};
