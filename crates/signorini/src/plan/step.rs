//! Solids from STEP files.

use super::placement::PlacementKeys;
use super::planner::Planner;
use crate::problem::{self, CaseError};
use signorini_geometry::rigid_shape::RigidShape;
use signorini_geometry::similarity::Similarity;
use signorini_geometry::trimmed::TrimmedSolids;
use signorini_import::step::{Pick, StepError, StepFile};
use std::sync::Arc;

/// Sizes of a body beyond which gaps between faces and edges are told: a thousandth of what contact of bodies of that size can be
/// resolved to.
const TOLD: f64 = 1e-6;

impl Planner<'_> {
    /// The solids of a STEP file that the key asks for, as one shape.
    pub(super) fn step_solids(&self, key: &problem::StepFile) -> Result<Arc<dyn RigidShape>, CaseError> {
        let problem = self.problem;
        let (path, bytes) = self.read_file(&key.file)?;
        let wrong = |error: StepError| {
            problem.error(&key.file, format!("`{}`: {error}", path.display())).help(error.help.clone())
        };
        let file = StepFile::new(&bytes).map_err(wrong)?;
        let keys = PlacementKeys { scale: &key.scale, rotate: &key.rotate, translate: &key.translate };
        let mut placement = self.placement::<3>(&keys)?.unwrap_or(Similarity::scaling(1.0));
        if key.scale.is_none() {
            match self.reader.units {
                Some(units) => placement.factor = file.metres() / units.length,
                None => self.warn(format!(
                    "one unit of length of `{}` is {} m; the case has no `units`, so its numbers are taken as they are",
                    key.file,
                    file.metres()
                )),
            }
        }
        let pick = match &key.solid {
            None => Pick::All,
            Some(problem::StepSolid::Name(name)) => Pick::Name(name.clone()),
            Some(problem::StepSolid::Number(n)) => Pick::Number(usize::try_from(*n).unwrap_or(0)),
        };
        let found = match (&key.solid, file.solids(&pick, &placement)) {
            (_, Ok(found)) => found,
            (Some(solid), Err(error)) if error.id.is_none() => {
                return Err(problem.error(solid, format!("`{}`: {error}", path.display())).help(error.help));
            }
            (_, Err(error)) => return Err(wrong(error)),
        };
        for (name, solid) in &found {
            let gap = solid.largest_gap();
            if gap > TOLD * solid.size() {
                self.warn(format!("edges of `{name}` in `{}` lie up to {gap:.1e} beside their faces", key.file));
            }
            if !solid.is_closed() {
                self.warn(format!(
                    "the surface of `{name}` in `{}` is open: the body is what lies behind its faces",
                    key.file
                ));
            }
        }
        let (names, mut solids): (Vec<String>, Vec<_>) = found.into_iter().unzip();
        if solids.len() == 1 {
            return Ok(Arc::new(solids.remove(0)));
        }
        let solids = TrimmedSolids::new(solids).map_err(|[i, j]| {
            let message = format!(
                "solids {} and {} of `{}` (`{}`, `{}`) touch or overlap",
                i + 1,
                j + 1,
                path.display(),
                names[i],
                names[j]
            );
            problem
                .error(&key.file, message)
                .help("fuse them in the CAD program, or choose one by its name or number:  solid = 1")
        })?;
        Ok(Arc::new(solids))
    }
}
