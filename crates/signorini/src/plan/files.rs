//! Files that a case names: height maps and closed surfaces.

use super::placement::PlacementKeys;
use super::planner::Planner;
use crate::problem::units::LENGTH;
use crate::problem::{self, CaseError, Location};
use crate::processes;
use crate::relief::{MovedHeight, Sampled};
use crate::report::Warning;
use signorini_geometry::mesh::TriangleMesh;
use std::collections::BTreeMap;

impl Planner<'_> {
    /// A file named in the case, beside the case; the files of the gallery are carried in the program.
    pub(super) fn read_file(&self, name: &String) -> Result<(std::path::PathBuf, Vec<u8>), CaseError> {
        let path = self.problem.source.folder().join(name);
        let read = match (self.problem.source.read(name), crate::gallery::asset(name)) {
            (Ok(bytes), _) => Ok((path, bytes)),
            (Err(_), Some(bytes)) => Ok((path, bytes.to_vec())),
            (Err(e), None) => Err(self.problem.error(name, format!("`{}`: cannot be read: {e}", path.display()))),
        };
        let (path, bytes) = processes::all(read)?;
        self.check_same(name, &bytes)?;
        Ok((path, bytes))
    }

    /// # Errors
    /// A file of which not all processes see the same bytes.
    pub(super) fn check_same(&self, name: &String, bytes: &[u8]) -> Result<(), CaseError> {
        if processes::agree(bytes) {
            return Ok(());
        }
        let message = format!("`{name}` is not the same for all processes");
        Err(self.problem.error(name, message).help("put it where all of them read the same file"))
    }

    /// The heights of a map.
    pub(super) fn height_map(&self, key: &problem::HeightMap) -> Result<MovedHeight<Sampled>, CaseError> {
        let (path, bytes) = self.read_file(&key.file)?;
        let spacing = self.reader.numbers::<2>(&key.spacing, LENGTH)?;
        if spacing.iter().any(|h| *h <= 0.0) {
            return Err(self.problem.error(&key.spacing, format!("the spacing {spacing:?} is not positive")));
        }
        let origin = key.origin.as_ref().map(|o| self.reader.numbers::<2>(o, LENGTH)).transpose()?.unwrap_or_default();
        let scale = key.scale.as_ref().map(|s| self.reader.number(s, LENGTH)).transpose()?.unwrap_or(1.0);
        let angle = key.rotate.as_ref().map(|t| self.reader.angle(t)).transpose()?.unwrap_or(0.0);
        let moved =
            key.translate.as_ref().map(|m| self.reader.numbers::<3>(m, LENGTH)).transpose()?.unwrap_or_default();
        let height = crate::height_map::read(&path, &bytes, [0.0; 2], spacing, scale)
            .map_err(|message| self.problem.error(&key.file, format!("`{}`: {message}", path.display())))?;
        Ok(MovedHeight { height, angle, shift: [origin[0] + moved[0], origin[1] + moved[1], moved[2]] })
    }

    /// A triangle mesh that bounds a body.
    pub(super) fn closed_mesh(&self, key: &problem::SurfaceFile) -> Result<TriangleMesh, CaseError> {
        let (path, bytes) = self.read_file(&key.file)?;
        let mut mesh =
            crate::mesh_file::parse(&path, &bytes).map_err(|e| self.problem.error(&key.file, e.to_string()))?;
        let keys = PlacementKeys { scale: &key.scale, rotate: &key.rotate, translate: &key.translate };
        if let Some(placement) = self.placement::<3>(&keys)? {
            let placed = mesh.vertices().iter().map(|x| placement.point(x)).collect();
            mesh = TriangleMesh::new(placed, mesh.triangles())
                .map_err(|e| self.problem.error(&key.file, e.to_string()))?;
        }
        if mesh.quality().has_inside() {
            return self.turned_outwards(mesh, &key.file, &format!("the surface in `{}`", key.file));
        }
        if let Some((closed, distance)) = crate::mesh_file::mended(&mesh) {
            let done = if distance > 0.0 {
                format!("corners at distances up to {distance:.1e} are joined")
            } else {
                "triangles with zero area are left out".to_string()
            };
            self.warn(format!("the surface in `{}` is not exactly closed: {done}", key.file));
            return self.turned_outwards(closed, &key.file, &format!("the surface in `{}`", key.file));
        }
        Err(self.not_closed(&mesh, &key.file, &format!("the surface in `{}`", key.file)))
    }

    /// A surface without an inside: how many edges are to blame, and where one of them is.
    pub(super) fn not_closed(&self, mesh: &TriangleMesh, at: &impl Location, what: &str) -> CaseError {
        let quality = mesh.quality();
        let mut uses: BTreeMap<[u32; 2], usize> = BTreeMap::new();
        let sides = |t: &[u32; 3]| [0, 1, 2].map(|k| [t[k].min(t[(k + 1) % 3]), t[k].max(t[(k + 1) % 3])]);
        mesh.triangles().iter().flat_map(sides).for_each(|side| *uses.entry(side).or_default() += 1);
        let wrong = uses.iter().find(|(_, count)| **count != 2).map(|(side, _)| {
            let [a, b] = side.map(|v| mesh.vertices()[v as usize]);
            let middle: Vec<String> = ((a + b) * 0.5).iter().map(|v| format!("{v:.4}")).collect();
            format!(", such as that at ({})", middle.join(", "))
        });
        let counts = [
            (quality.open_edges, "have one triangle"),
            (quality.branching_edges, "more than two"),
            (quality.flipped_edges, "two triangles with opposite orientation"),
        ];
        let told: Vec<String> =
            counts.iter().filter(|(n, _)| *n > 0).map(|(n, reason)| format!("{n} edges {reason}")).collect();
        let message = format!("{what} is not closed: {}{}", told.join(", "), wrong.unwrap_or_default());
        self.problem.error(at, message).help("a body needs a closed surface: close the holes, or use another shape")
    }

    /// Says something once.
    pub(super) fn warn(&self, message: String) {
        let warning = Warning::from(message);
        let mut warnings = self.warnings.borrow_mut();
        if !warnings.contains(&warning) {
            warnings.push(warning);
        }
    }

    /// A closed surface with its normals outwards: one whose volume is negative is turned round, and that is said.
    pub(super) fn turned_outwards(
        &self,
        mesh: TriangleMesh,
        at: &impl Location,
        what: &str,
    ) -> Result<TriangleMesh, CaseError> {
        let centre = mesh.bounds().center();
        let signed = |triangle: usize| {
            let [a, b, c] = mesh.corners(triangle).map(|x| x - centre);
            a.dot(&b.cross(&c)) / 6.0
        };
        let volume: f64 = (0..mesh.triangles().len()).map(signed).sum();
        if volume >= 0.0 {
            return Ok(mesh);
        }
        let warning =
            format!("{what} has its normals inwards (inside out), its volume is {volume:.4e}: they are reversed");
        self.warn(warning);
        let turned: Vec<[u32; 3]> = mesh.triangles().iter().map(|&[a, b, c]| [a, c, b]).collect();
        TriangleMesh::new(mesh.vertices().to_vec(), &turned).map_err(|e| self.problem.error(at, e.to_string()))
    }
}
