//! Meshes of spline patches.

use crate::plan::placement::PlacementKeys;
use crate::plan::planner::Planner;
use crate::problem::{self, CaseError, List, Location, NurbsMesh};
use signorini_fem::Mesh;
use signorini_fem::nurbs::{NurbsError, NurbsPatch, mesh_of_patches};
use signorini_geometry::Point;

/// What of a file is read.
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct PatchesFile {
    patches: Vec<problem::NurbsPatch>,
}

/// A patch as it is stated, and where: whether its keys are those of the mesh.
struct Stated<'p> {
    patch: std::borrow::Cow<'p, problem::NurbsPatch>,
    from: From<'p>,
}

#[derive(Clone, Copy)]
enum From<'p> {
    Mesh,
    List(&'p problem::NurbsPatch),
    File(&'p String),
}

/// What helps where nothing is stated.
const ONE_WAY: &str =
    "give one patch by degree, knots and points, several by patches = [{ … }, …], or file = \"….json\"";

impl Planner<'_> {
    /// The mesh of patches, of the degree of the body where that is stated.
    pub(super) fn nurbs<const D: usize>(
        &self,
        name: &str,
        key: &NurbsMesh,
        degree: Option<&i64>,
    ) -> Result<Mesh<D>, CaseError> {
        let problem = self.problem;
        let stated = self.stated_patches(name, key)?;
        let of_mesh = key.cells.as_ref().map(|cells| self.cells_of_spans::<D>(cells)).transpose()?.unwrap_or([1; D]);
        let mut patches = Vec::with_capacity(stated.len());
        for (number, Stated { patch, from }) in stated.iter().enumerate() {
            let fail = |error: NurbsError| self.wrong_patch(key, *from, number, stated.len(), error);
            patches.push(read::<D>(patch).map_err(fail)?);
        }
        let own = patches.iter().map(NurbsPatch::degree).max().unwrap_or(1);
        let wanted = degree.map_or(own, |d| *d as usize);
        if let (true, Some(degree)) = (wanted < own, degree) {
            let message = format!("degree {degree} on a mesh of degree {own}");
            return Err(problem.error(degree, message).help(format!(
                "a lower degree cannot keep the shape: leave `degree` out, or give a number from {own} to 8"
            )));
        }
        let mut raised = Vec::with_capacity(patches.len());
        for (number, (patch, Stated { patch: of, from })) in patches.iter().zip(&stated).enumerate() {
            let mut cells = match &of.cells {
                Some(cells) => match from {
                    From::File(_) => {
                        counts::<D>(cells).map_err(|e| self.wrong_patch(key, *from, number, stated.len(), e))?
                    }
                    _ => self.cells_of_spans::<D>(cells)?,
                },
                None => of_mesh,
            };
            if self.halves {
                cells = cells.map(|n| 2 * n);
            }
            let fail = |error: NurbsError| self.wrong_patch(key, *from, number, stated.len(), error);
            raised.push(patch.raised(wanted, cells).map_err(fail)?);
        }
        let cells: usize = raised.iter().map(|p| p.lines.iter().map(|l| l.breaks().len() - 1).product::<usize>()).sum();
        if cells > 1_000_000 {
            return Err(problem.error(key, format!("{cells} cells are more than this program can handle")));
        }
        let joined = mesh_of_patches(&raised);
        let mut mesh = joined.map_err(|e| self.wrong_patch(key, stated[e.patch].from, e.patch, stated.len(), e))?;
        self.place_mesh(
            &mut mesh,
            &PlacementKeys { scale: &key.scale, rotate: &key.rotate, translate: &key.translate },
        )?;
        mesh.check().map_err(|e| {
            problem.error(key, format!("the mesh of `{name}`: {e}")).help(format!(
                "the map of the patch folds or is turned over there: if it is turned over everywhere, reverse the points (and \
                 knots) of one direction or change the order of the directions; {} and no two control points of a side coincide",
                if D == 2 { "the second direction is to the left of the first" } else { "the directions are right-handed" }
            ))
        })?;
        Ok(mesh)
    }

    /// The patches as they are stated: by the keys of the mesh, in a list, or in a file.
    fn stated_patches<'p>(&self, name: &str, key: &'p NurbsMesh) -> Result<Vec<Stated<'p>>, CaseError> {
        let problem = self.problem;
        let missing = |what: &str| Err(problem.error(key, format!("the patch of `{name}` {what}")).help(ONE_WAY));
        let any = key.degree.is_some() || key.knots.is_some() || key.points.is_some() || key.weights.is_some();
        let ways = usize::from(any) + usize::from(!key.patches.is_empty()) + usize::from(key.file.is_some());
        if ways != 1 {
            return missing(if ways == 0 { "is missing" } else { "is given in several ways" });
        }
        if let Some(file) = &key.file {
            let (path, bytes) = self.read_file(file)?;
            let wrong = |e: serde_json::Error| {
                problem.error(file, format!("`{}` is no NURBS mesh: {e}", path.display())).help(
                    "{\"degree\": [2, 1], \"knots\": [[…], […]], \"points\": [[x, y], …], \"weights\": […]}, or \
                     {\"patches\": [{…}, …]}",
                )
            };
            let value: serde_json::Value = serde_json::from_slice(&bytes).map_err(wrong)?;
            let list = match value.get("patches") {
                Some(_) => serde_json::from_value::<PatchesFile>(value).map_err(wrong)?.patches,
                None => vec![serde_json::from_value::<problem::NurbsPatch>(value).map_err(wrong)?],
            };
            if list.is_empty() {
                return Err(problem.error(file, format!("`{}` has no patches", path.display())));
            }
            let of = |patch| Stated { patch: std::borrow::Cow::Owned(patch), from: From::File(file) };
            return Ok(list.into_iter().map(of).collect());
        }
        if any {
            let (Some(degree), Some(knots), Some(points)) = (&key.degree, &key.knots, &key.points) else {
                return missing("is not complete");
            };
            let (degree, knots, points) = (degree.clone(), knots.clone(), points.clone());
            let patch =
                problem::NurbsPatch { name: None, degree, knots, points, weights: key.weights.clone(), cells: None };
            return Ok(vec![Stated { patch: std::borrow::Cow::Owned(patch), from: From::Mesh }]);
        }
        let of = |patch| Stated { patch: std::borrow::Cow::Borrowed(patch), from: From::List(patch) };
        Ok(key.patches.iter().map(of).collect())
    }

    /// The numbers of cells of each span.
    fn cells_of_spans<const D: usize>(&self, key: &List<i64>) -> Result<[usize; D], CaseError> {
        counts::<D>(key).map_err(|e| self.problem.error(key, e.message).help(e.help))
    }

    /// An error of a patch at the key that states it.
    fn wrong_patch(&self, key: &NurbsMesh, from: From<'_>, number: usize, of: usize, error: NurbsError) -> CaseError {
        let problem = self.problem;
        let message = match from {
            From::Mesh => error.message.clone(),
            _ if of == 1 => error.message.clone(),
            _ if error.message.contains("patch") => error.message.clone(),
            _ => format!("patch {number}: {}", error.message),
        };
        let at = |location: &dyn Location| problem.error(&location.key_in(problem), message.clone());
        let found = match (from, error.key) {
            (From::File(file), _) => problem.error(file, format!("`{}` in `{file}`: {message}", error.key)),
            (From::List(patch), "degree") => at(&patch.degree),
            (From::List(patch), "knots") => at(&patch.knots),
            (From::List(patch), "points") => at(&patch.points),
            (From::List(patch), "weights") => patch.weights.as_ref().map_or_else(|| at(patch), |w| at(w)),
            (From::List(patch), _) => patch.cells.as_ref().map_or_else(|| at(patch), |c| at(c)),
            (From::Mesh, "degree") => key.degree.as_ref().map_or_else(|| at(key), |d| at(d)),
            (From::Mesh, "knots") => key.knots.as_ref().map_or_else(|| at(key), |k| at(k)),
            (From::Mesh, "points") => key.points.as_ref().map_or_else(|| at(key), |p| at(p)),
            (From::Mesh, "weights") => key.weights.as_ref().map_or_else(|| at(key), |w| at(w)),
            (From::Mesh, _) => key.cells.as_ref().map_or_else(|| at(key), |c| at(c)),
        };
        found.help(error.help)
    }
}

/// The patch that is stated.
fn read<const D: usize>(patch: &problem::NurbsPatch) -> Result<NurbsPatch<D>, NurbsError> {
    let fail = |key, message: String, help: &str| NurbsError { key, patch: 0, message, help: help.into() };
    let directions = |found: usize, key| match found == D {
        true => Ok(()),
        false => {
            Err(fail(key, format!("expected {D} directions, found {found}"), "a patch in the plane has 2, in space 3"))
        }
    };
    directions(patch.degree.len(), "degree")?;
    directions(patch.knots.len(), "knots")?;
    let mut degree = [0; D];
    for (k, d) in patch.degree.iter().enumerate() {
        degree[k] = usize::try_from(*d).map_err(|_| fail("degree", format!("degree {d}"), "valid are 1 to 8"))?;
    }
    let mut points = Vec::with_capacity(patch.points.len());
    for (k, x) in patch.points.iter().enumerate() {
        if x.len() != D {
            let help = format!("give {D} coordinates");
            return Err(fail("points", format!("point {k} has {} coordinates", x.len()), &help));
        }
        points.push(Point::<D>::from_fn(|i, _| x[i]));
    }
    let knots = std::array::from_fn(|k| patch.knots[k].clone());
    let weights = patch.weights.as_ref().map(|w| w.to_vec());
    NurbsPatch::new(patch.name.as_deref().unwrap_or(""), degree, knots, points, weights)
}

fn counts<const D: usize>(cells: &List<i64>) -> Result<[usize; D], NurbsError> {
    let fail = |message: String, help: &str| NurbsError { key: "cells", patch: 0, message, help: help.into() };
    if cells.len() != D {
        return Err(fail(
            format!("expected {D} numbers of cells, found {}", cells.len()),
            "give for each direction into how many cells every span of knots is divided",
        ));
    }
    let mut out = [0; D];
    for (k, n) in cells.iter().enumerate() {
        match n {
            1..=10_000 => out[k] = *n as usize,
            other => return Err(fail(format!("{other} cells"), "give a number from 1 to 10000")),
        }
    }
    Ok(out)
}
