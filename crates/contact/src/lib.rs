//! Contact: pairs, pressures, active sets, for any discretisation.
//!
//! Contact sees faces with positions and the functions that move them ([`surface`]); it does not know meshes.
//!
//! - [`multiplier`]: the nodes of the contact pressure and the normal field.
//! - [`mod@segments`]: where two surfaces, or a surface and a rigid body, face each other.
//! - [`mortar`]: weighted gaps with dual functions.
//! - [`kinematics`]: the gap of a pair with its variations, for any shape functions.
//! - [`obstacle`]: the closest point of a slave point, on faces, edges and vertices, or on a rigid body.
//! - [`points`]: the points under test, their rows, and the one assembler of residual and tangent.
//! - [`active_set`]: which nodes carry; [`mod@law`]: how they answer.
//! - [`friction`]: stick and slip.
//! - [`compliance`]: how rows answer to tractions, by columns or by products.
//! - [`balance`]: whether contact can hold free bodies against their loads.
//! - [`recovery`]: the pressure as it is shown; [`mod@zone`]: where the zone of contact ends.
//!
//! The gap is `(x_slave - x_master)·n` with the outward normal of the master, negative where the bodies penetrate; a
//! pressure is positive.

pub mod active_set;
pub mod balance;
pub mod compliance;
pub mod friction;
pub mod kinematics;
pub mod law;
pub mod mortar;
pub mod multiplier;
pub mod obstacle;
pub mod points;
pub mod recovery;
pub mod segments;
pub mod softness;
pub mod surface;
#[cfg(test)]
mod testing;
pub mod zone;

pub use active_set::{ActiveSet, ActiveSetError, ContactState};
pub use balance::unbalanced;
pub use compliance::{Compliance, Route};
pub use kinematics::{Kinematics, Partner, ShapeFunction};
pub use law::{Coulomb, Law, LawError, Status, Tresca, Viscous};
pub use mortar::{Shares, WeightedGap, compress, shares, shares_on_the_way, weighted_gaps, weightless};
pub use multiplier::{Given, PressureNodes};
pub use obstacle::{Faces, Obstacle, Rigid};
pub use points::{Measured, TestPoint, TestRow, Tests};
pub use recovery::{Pressed, recovered, unpressed};
pub use segments::{GapPoint, pieces, rigid_points, segments};
pub use signorini_geometry::rigid_shape::GapJet;
pub use softness::{Softness, Spring};
pub use surface::{ContactSurface, FacePoint, Moved, looks_at};
pub use zone::{ContactZone, NodeState, connected, zone};
