//! Contact of surfaces, for any discretisation: pairs, pressures, laws of friction.
//!
//! Contact sees faces with positions and the functions that move them ([`surface`]); it does not know meshes.
//!
//! - [`multiplier`]: the nodes of the contact pressure and the normal field.
//! - [`mod@segments`]: where two surfaces, or a surface and a rigid body, face each other.
//! - [`mortar`]: weighted gaps with dual functions.
//! - [`kinematics`]: the gap of a pair with its variations, for any shape functions.
//! - [`obstacle`]: the closest point of a slave point, on faces, edges and vertices, or on a rigid body.
//! - [`mod@law`] of friction.
//! - [`recovery`]: the pressure as it is shown; [`mod@zone`]: where the zone of contact ends.
//!
//! The gap is `(x_slave - x_master)·n` with the outward normal of the master, negative where the bodies penetrate; a
//! pressure is positive.

mod face_maps;
pub mod kinematics;
pub mod law;
pub mod mortar;
pub mod multiplier;
pub mod obstacle;
pub mod recovery;
pub mod segments;
pub mod surface;
#[cfg(test)]
mod testing;
pub mod zone;

pub use face_maps::FaceMaps;
pub use kinematics::{Kinematics, Partner, ShapeFunction};
pub use law::{Coulomb, Law, LawError, Status, Tresca, Viscous};
pub use mortar::{Shares, WeightedGap, compress, shares, shares_on_the_way, weighted_gaps, weightless};
pub use multiplier::{Given, PressureNodes};
pub use obstacle::{Faces, Obstacle, Rigid};
pub use recovery::{Pressed, recovered, unpressed};
pub use segments::{GapPoint, pieces, rigid_points, segments};
pub use signorini_geometry::rigid_shape::GapJet;
pub use surface::{ContactSurface, FacePoint, Moved, looks_at};
pub use zone::{ContactZone, NodeState, connected, zone};
