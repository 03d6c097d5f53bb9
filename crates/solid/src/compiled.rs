//! What is compiled here once for the plane and once for space.
//!
//! The compiler shares what is marked `inline(never)` with the crates above, where this one has compiled it; what only those
//! call with a dimension each of them would compile again.

use crate::stiffness::displacement_at;
use crate::{Bodies, Contact, Model, SolidBody, facing, loads};

/// The entry points in `D` dimensions, by address.
fn entries<const D: usize>() -> Vec<*const ()> {
    vec![
        Bodies::<D>::new as *const (),
        Bodies::<D>::add as *const (),
        Bodies::<D>::surface as *const (),
        Contact::<D>::new as *const (),
        facing::<D> as *const (),
        loads::forces::<D> as *const (),
        loads::resultant::<D> as *const (),
        displacement_at::<D> as *const (),
        Model::<D>::new as *const (),
        Model::<D>::cost as *const (),
        Model::<D>::solve as *const (),
        Model::<D>::examine as *const (),
        Model::<D>::examine_again as *const (),
        Model::<D>::save as *const (),
        Model::<D>::restore as *const (),
        SolidBody::<D>::new as *const (),
        SolidBody::<D>::with_edges as *const (),
        SolidBody::<D>::into_body as *const (),
    ]
}

/// The entry points, by address: to name them is to compile them.
pub fn all() -> [Vec<*const ()>; 2] {
    [entries::<2>(), entries::<3>()]
}
