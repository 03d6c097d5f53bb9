//! Contact of surfaces, for any discretisation: what of them faces each other, pressures, laws of friction.
//!
//! Contact sees faces with positions and the functions that move them ([`surface`]); it does not know meshes.
//!
//! - [`multiplier`]: the nodes of the contact pressure and the normal field.
//! - [`mod@segments`]: where two surfaces face each other; [`roles`]: which faces of one that touches itself are slave.
//! - [`mortar`]: dual functions of the pressure.
//! - [`mod@law`] of friction.
//! - [`recovery`]: the pressure as it is shown; [`mod@zone`]: where the zone of contact ends.
//!
//! The gap is `(x_slave - x_master)·n` with the outward normal of the master, negative where the bodies penetrate; a
//! pressure is positive.

mod face_maps;
mod face_point;
pub mod law;
pub mod mortar;
pub mod multiplier;
pub mod recovery;
pub mod roles;
pub mod segments;
pub mod surface;
#[cfg(test)]
mod testing;
pub mod zone;

pub use face_maps::{FaceForm, FaceMaps};
pub use face_point::FacePoint;
pub use law::{Coulomb, Law, LawError, Status, Tresca, Viscous};
pub use mortar::{DualWeights, compress, dual_weights_unmerged, shares, weightless};
pub use multiplier::{MergedNode, PressureNodes};
pub use recovery::{Pressed, recovered, unpressed};
pub use roles::{Sighting, slaves};
pub use segments::{GapPoint, Sight, pieces, segments, whole_faces};
pub use signorini_geometry::rigid_shape::GapJet;
pub use surface::{ContactSurface, Moved, ShapeFunction, SplineFace, is_facing};
pub use zone::{ContactZone, NodeState, connected, zone};
