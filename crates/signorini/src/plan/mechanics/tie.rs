//! Tied contact between bodies of a system.

use super::{ContactInfo, Kind};
use crate::plan::planner::Planner;
use crate::problem::units::LENGTH;
use crate::problem::{self, CaseError, Method};
use signorini_mechanics::contact::Part;
use signorini_mechanics::{AxisChoice, Enforcement as Kept, Interaction, Sampling, System, Tie};

/// Part of the slave that is tied from which on nothing is told of the rest.
const ALL: f64 = 1.0 - 1e-6;

impl Planner<'_> {
    /// A contact with `tied = true`; none of any other.
    pub(super) fn tied(
        &self,
        name: &str,
        key: &problem::Contact,
        [slave, master]: [&Part; 2],
        (system, kinds): (&System, &[Kind]),
    ) -> Result<Option<(Box<dyn Interaction>, ContactInfo)>, CaseError> {
        let problem = self.problem;
        if key.tied != Some(true) {
            return match &key.tie_distance {
                Some(at) => Err(problem.error(at, "`tie_distance` of a contact that is not tied").help("tied = true")),
                None => Ok(None),
            };
        }
        self.refuse_beside_tie(key)?;
        // What deforms is the slave.
        let is_rigid = |part: &Part| matches!(kinds[part.body], Kind::Rigid { .. });
        let [slave, master] = if is_rigid(slave) { [master, slave] } else { [slave, master] };
        // Gaps turn with the faces of a solid, which finite cells do not have.
        let on_cells = matches!((&kinds[slave.body], &kinds[master.body]), (Kind::Solid, Kind::Cells));
        let [slave, master] = if on_cells { [master, slave] } else { [slave, master] };
        let fits = |part: &&Part| matches!(kinds[part.body], Kind::Solid | Kind::Cells | Kind::Rigid { .. });
        let body = |part: &Part| system.bodies[part.body].as_ref();
        if let Some(part) = [slave, master].into_iter().find(|part| !fits(part)) {
            let message = format!(
                "`{}` is a rope or beam: ties are for solids, finite cells and rigid bodies",
                body(part).name()
            );
            return Err(problem
                .error(key, message)
                .help("a support or load of the same place, or friction of a high limit"));
        }
        if is_rigid(slave) || slave.body == master.body {
            let message = match is_rigid(slave) {
                true => format!("contact `{name}` ties two rigid bodies: one of the two has to deform"),
                false => format!("contact `{name}` ties a body to itself: a tie is between two bodies"),
            };
            return Err(problem.error(key, message).help("make one rigid body of both, or one mesh"));
        }
        let by_mortar = matches!(kinds[slave.body], Kind::Solid) && !matches!(kinds[master.body], Kind::Cells);
        let at_points = if matches!(kinds[slave.body], Kind::Cells) { "cell_surface" } else { "gauss_point" };
        let (sampling, enforcement, otherwise, word) = match &key.method {
            None if by_mortar => (None, None, Kept::Multiplier, "mortar"),
            Some(Method::Mortar(k)) if by_mortar => (None, k.enforcement.as_ref(), Kept::Multiplier, "mortar"),
            Some(method @ Method::Mortar(_)) => {
                return Err(problem
                    .error(method, "a tie by mortar is between solids, or of a solid to a rigid body")
                    .help("leave the method out"));
            }
            Some(Method::Node(k)) => (Some(Sampling::Nodes), k.enforcement.as_ref(), Kept::Multiplier, "node"),
            Some(Method::GaussPoint(k) | Method::CellSurface(k)) => {
                (Some(Sampling::GaussPoints), k.enforcement.as_ref(), Kept::AugmentedLagrangian, at_points)
            }
            None => (Some(Sampling::GaussPoints), None, Kept::AugmentedLagrangian, at_points),
            Some(other) => {
                return Err(problem
                    .error(other, "this method is not for ties")
                    .help("method.mortar = {}, method.node = {} or method.gauss_point = {}"));
            }
        };
        let kept = self.kept(enforcement, otherwise, "tie")?;
        if let Some(problem::Enforcement::Penalty(problem::Penalty { penetration: Some(at) })) = enforcement {
            return Err(problem.error(at, "a tie has no penetration").help("enforcement.penalty = {}"));
        }
        let within = key.tie_distance.as_ref().map(|v| self.reader.positive(v, LENGTH)).transpose()?;
        let side = |part: &Part| (part.clone(), system.bodies[part.body].as_ref());
        let tie = Tie::new(name, side(slave), side(master), (sampling, kept), within).map_err(|e| {
            problem.error(key, format!("contact `{name}`: {e}")).help(
                "tie_distance = … : points of the slave that are at most so far from the master at the start are tied",
            )
        })?;
        let found = tie.findings;
        let mut notes = Vec::new();
        let share = found.tied / found.area.max(f64::MIN_POSITIVE);
        if share < ALL {
            notes.push(format!(
                "contact `{name}`: {:.1} % of the slave is tied; the rest is farther than {:.3e} from the master, or does \
                 not face it, and is free",
                100.0 * share,
                found.within
            ));
        }
        if found.farthest > GAP * found.within {
            notes.push(format!("contact `{name}`: gaps of up to {:.3e} at the start stay as they are", found.farthest));
        }
        let tied_overlap = Some(found.deepest);
        Ok(Some((Box::new(tie), ContactInfo { notes, tied_overlap, ..ContactInfo::by(word, AxisChoice::Material) })))
    }

    /// Refuses what a tie leaves no room for.
    fn refuse_beside_tie(&self, key: &problem::Contact) -> Result<(), CaseError> {
        let stated = [
            ("friction", key.friction.as_ref().map(|k| self.key(k))),
            ("adhesion", key.adhesion.as_ref().map(|k| self.key(k))),
            ("cohesion", key.cohesion.as_ref().map(|k| self.key(k))),
            ("compliance", key.compliance.as_ref().map(|k| self.key(k))),
            ("wear", key.wear.as_ref().map(|k| self.key(k))),
            ("sliding", key.sliding.as_ref().map(|k| self.key(k))),
        ];
        match stated.into_iter().find_map(|(name, at)| at.map(|at| (name, at))) {
            Some((name, at)) => Err(self
                .problem
                .error(&at, format!("`{name}` of surfaces that are tied"))
                .help("leave it out, or use `cohesion` for a bond that may break")),
            None => Ok(()),
        }
    }
}

/// Gap at the start, relative to the distance up to which points are tied, of which nothing is told.
const GAP: f64 = 1e-6;
