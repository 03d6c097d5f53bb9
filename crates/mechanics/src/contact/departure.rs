//! Slip of what met nothing in the last state: from where both sides departed in the increment.

use super::{Contact, Sides};
use crate::pair::Pair;
use crate::points::Master;
use signorini_geometry::Vector;

impl Contact {
    /// The slip of a site of a surface that met nothing in the last state, such as one that the end of the master has slid over since:
    /// how far what meets now has come along each other, by the motion of both sides.
    pub(super) fn count_from_departure(&self, sides: &Sides<'_>, master: &dyn Master, pair: &mut Pair) {
        let Some(departed) = &self.departed else { return };
        let mut came = Vector::<3>::zeros();
        if sides.master.0.is_rigid() {
            let Ok(before) = sides.master.0.master(self.master.group.as_deref(), &departed[1]) else { return };
            let moved = master.at(&pair.point).x - before.at(&pair.point).x;
            came -= moved - pair.normal * pair.normal.dot(&moved);
        }
        let sides = [sides.slave, sides.master].into_iter().zip(sides.first).zip(departed);
        let sides = sides.take(if self.is_within() { 1 } else { 2 });
        for (((body, state), first), before) in sides.filter(|(((body, _), _), _)| !body.is_rigid()) {
            let own = first..first + body.unknowns() as u32;
            for (unknown, slip) in pair.unknowns.iter().zip(&pair.slip).filter(|(unknown, _)| own.contains(unknown)) {
                let place = (unknown - first) as usize;
                came += slip * (state.configuration[place] - before.configuration[place]);
            }
        }
        pair.elastic = came;
        pair.d_elastic.clone_from(&pair.slip);
    }
}
