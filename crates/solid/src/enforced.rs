//! Rows that give way as the enforcement of their contact asks, with the outer iterations of those that need them.

use crate::contact::Enforcement;
use crate::model::Model;
use signorini_contact::{ActiveSetError, ContactState, Softness, WeightedGap};

/// Finds the state of rows that give way as they are told.
pub(crate) type SolveRows<'a> =
    &'a mut dyn FnMut(&[Softness], &mut dyn FnMut(usize, usize) -> bool) -> Result<ContactState, ActiveSetError>;

/// The most outer iterations of a penalty that is adjusted, or of an augmented Lagrangian.
const MOST_OUTER: usize = 60;

/// The stiffest penalty of an augmented Lagrangian, as a multiple of the stiffness of the cells: beyond it the penetration
/// is less than the round-off of the compliances.
const MOST_STIFFNESS: f64 = 1e8;

impl<const D: usize> Model<D> {
    /// The contact state of rows that give way as the enforcement asks, with outer iterations where it does; and how
    /// they gave way in the end.
    pub(crate) fn solve_enforced(
        &self,
        rows: &[WeightedGap],
        ends: &[usize],
        report: &mut dyn FnMut(usize, usize) -> bool,
        solve: SolveRows<'_>,
    ) -> Result<(ContactState, Vec<Softness>), ActiveSetError> {
        let mut soft = vec![Softness::default(); rows.len()];
        let range = |k: usize| if k == 0 { 0..ends[0] } else { ends[k - 1]..ends[k] };
        // Multiples of the stiffness of the cells.
        let mut factor = vec![100.0; self.contacts.len()];
        // The penetration that augmented Lagrangians left the last time.
        let mut left = vec![f64::INFINITY; self.contacts.len()];
        let mut total = 0;
        for outer in 0..MOST_OUTER {
            for (k, contact) in self.contacts.iter().enumerate() {
                let factor = match contact.enforcement {
                    Enforcement::Multiplier => continue,
                    Enforcement::Nitsche => contact.nitsche_factor(),
                    _ => factor[k],
                };
                for (row, stiffness) in range(k).zip(&contact.stiffness) {
                    soft[row].compliance = rows[row].weight / (factor * stiffness);
                }
            }
            let mut found = solve(&soft, report)?;
            total += found.iterations;
            found.iterations = total;
            let mut again = false;
            for (k, contact) in self.contacts.iter().enumerate() {
                let deepest = |rows_of: &mut dyn Iterator<Item = usize>| {
                    rows_of.map(|r| -found.gap[r] / rows[r].weight).fold(0.0, f64::max)
                };
                match contact.enforcement {
                    Enforcement::Penalty { wanted_penetration: Some(wanted) } => {
                        let reached = deepest(&mut range(k));
                        if reached > 0.0 && !(0.98..=1.02).contains(&(reached / wanted)) {
                            factor[k] *= reached / wanted;
                            again = true;
                        }
                    }
                    Enforcement::AugmentedLagrangian => {
                        let moved = found.u.iter().fold(0.0f64, |m, u| m.max(u.abs()));
                        let mut open = range(k).filter(|&r| found.active[r]);
                        let worst = open.by_ref().map(|r| (found.gap[r] / rows[r].weight).abs()).fold(0.0, f64::max);
                        if worst > 1e-11 * moved {
                            range(k).for_each(|r| soft[r].shift = found.pressure[r]);
                            // More conditions than the surface can follow converge slowly at one penalty.
                            if worst > 0.25 * left[k] {
                                factor[k] = (10.0 * factor[k]).min(MOST_STIFFNESS);
                            }
                            left[k] = worst;
                            again = true;
                        }
                    }
                    _ => {}
                }
            }
            if !again || outer + 1 == MOST_OUTER {
                return if again { Err(ActiveSetError::TooMany { iterations: total }) } else { Ok((found, soft)) };
            }
        }
        Err(ActiveSetError::TooMany { iterations: total })
    }
}
