//! The parts that a zone divides a membrane into, as numbers.

use crate::obstacle::Side;
use signorini_fem::cut::RegionId;

/// Beyond the membrane.
pub const OUTSIDE: RegionId = 0;
const BELOW: RegionId = 1 << 24;
const FREE: RegionId = 2 << 24;
const ABOVE: RegionId = 3 << 24;
const INDEX: RegionId = (1 << 24) - 1;

/// The region of the `k`-th connected zone of contact, which touches a body on one side.
pub fn contact(side: Side, k: usize) -> RegionId {
    k as u32
        | match side {
            Side::Below => BELOW,
            Side::Above => ABOVE,
        }
}

/// The region of the `k`-th connected part of the free membrane.
pub fn free(k: usize) -> RegionId {
    FREE | k as u32
}

/// The side that is touched and the number of the zone, if a region is one of contact.
pub fn contact_of(region: RegionId) -> Option<(Side, usize)> {
    let side = match region & !INDEX {
        BELOW => Side::Below,
        ABOVE => Side::Above,
        _ => return None,
    };
    Some((side, (region & INDEX) as usize))
}

/// The number of the zone, if a region is one of contact.
pub fn contact_index(region: RegionId) -> Option<usize> {
    contact_of(region).map(|c| c.1)
}

/// Whether a region is free membrane.
pub fn is_free(region: RegionId) -> bool {
    region & !INDEX == FREE
}
