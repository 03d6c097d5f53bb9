//! What a point of a surface meets of another body: the nearest point; beside an edge inside of that, the face that it looks at.
//!
//! The nearest point of a block that slides over a softer surface is, just behind its edge, one of its side wall. That would push
//! the surface aside, and as far as the block has come. A smooth surface cannot lie on a wall that stands across it, so the face
//! below is what such a point meets.

use crate::points::{Master, MasterProjection, Site, SlavePoint};
use signorini_geometry::{Looking, Point, Vector};

/// How much more a face looks at something than another one, by the cosines of their normals, that alone meets it: at a right angle
/// from 27 degrees on, while faces of a tip that are alike both meet what they touch.
pub(crate) const MUCH_MORE: f64 = 2.0;
/// The cosine from which on a face that is met is looked at, whatever stands beside it.
const SEEN: f64 = 1.0 / MUCH_MORE;
/// The cosine from which on no other face looks more, to speak of: eight degrees.
const FULLY: f64 = 0.99;
/// Share of what is missing to a cosine of one by which a face has to look more at a point on an edge than the mean of the faces
/// there: the faces of edges that a surface lies under, and not those of an edge that stands on it.
const MORE_THAN_MEAN: f64 = 0.5;

impl SlavePoint {
    /// What the point meets no farther than a reach; with `except`, a site of the same body, of that body elsewhere. A face beyond an
    /// edge counts `within` the distance of points of the slave: a surface may lie so far inside of another one there.
    pub(crate) fn met(
        &self,
        master: &dyn Master,
        (reach, within): (f64, f64),
        except: Option<&Site>,
    ) -> Option<MasterProjection> {
        let nearest = master.nearest(&self.x, reach + self.radius, except)?;
        if except.is_some() || self.tangent.is_some() {
            return Some(nearest);
        }
        Some(looked_at(master, (&self.x, self.outward), &nearest, within).unwrap_or(nearest))
    }
}

/// The face that a point of a surface with an outward normal looks at, where what is nearest is another one.
pub(crate) fn looked_at(
    master: &dyn Master,
    (x, outward): (&Point<3>, Option<Vector<3>>),
    nearest: &MasterProjection,
    within: f64,
) -> Option<MasterProjection> {
    let outward = outward?.try_normalize(0.0)?;
    let (gap, normal) = nearest.gap(x)?;
    let looks = -normal.dot(&outward);
    if looks >= FULLY {
        return None;
    }
    let mut looking = Looking { outward, least: SEEN.max(MUCH_MORE * looks), within };
    if gap.abs() <= looking.rounding() {
        // On an edge the normal is the mean of those of its faces.
        looking.least = SEEN.max(looks + MORE_THAN_MEAN * (1.0 - looks));
    } else if gap > 0.0 || looks >= SEEN {
        return None;
    }
    master.facing(x, &looking)
}
