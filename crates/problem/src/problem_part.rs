//! How the way to a part of a problem is found: by where that part lies in memory.
//!
//! A reader of a problem holds references to its parts. Where one of them is wrong, the problem is walked through once until
//! the part at that address and of that type is met, and the keys on the way to it are its path. So no reader carries paths
//! along, and no plain type carries one in it.

use crate::key_path::KeyPath;
use crate::{Problem, walk};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// A part of a problem, of which errors tell. References are none: their address is not that of the part.
pub trait ProblemPart: Serialize + DeserializeOwned {}
impl<T: Serialize + DeserializeOwned> ProblemPart for T {}

/// The way to a part of a problem; none where the part is not in it.
pub fn find<T: ProblemPart>(problem: &Problem, part: &T) -> Option<KeyPath> {
    find_at(problem, walk::address(part), std::any::type_name::<T>())
}

/// Without parameters, so that the walk is compiled once.
fn find_at(problem: &Problem, address: usize, kind: &'static str) -> Option<KeyPath> {
    walk::find(problem, address, kind).map(KeyPath)
}
