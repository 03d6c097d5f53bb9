//! Meshes of solids: boxes and files.

use super::evaluate;
use crate::case::CaseError;
use crate::case::statement;
use crate::case::units::LENGTH;
use crate::plan::{Placed, Planner};
use signorini_fem::block::{block, graded};
use signorini_fem::mesh::position;
use signorini_fem::{Mesh, Overlap};
use signorini_geometry::Point;
use std::ops::Range;

impl Planner<'_> {
    pub(super) fn block<const D: usize>(
        &self,
        name: &str,
        key: &statement::BoxKey,
        span: Range<usize>,
        degree: usize,
    ) -> Result<Mesh<D>, CaseError> {
        let document = self.document;
        let count = |n: &toml::Spanned<i64>| match n.get_ref() {
            1..=10_000 => Ok(*n.get_ref() as usize),
            other => Err(document.error(n.span(), format!("{other} cells: give a number from 1 to 10000"))),
        };
        let mut axes: [Vec<f64>; D] = std::array::from_fn(|_| Vec::new());
        match (&key.min, &key.max, &key.cells, &key.axes) {
            (Some(min), Some(max), Some(cells), None) => {
                let (low, high) = (self.reader.numbers::<D>(min, LENGTH)?, self.reader.numbers::<D>(max, LENGTH)?);
                if cells.get_ref().len() != D {
                    let found = cells.get_ref().len();
                    return Err(document.error(cells.span(), format!("expected {D} numbers of cells, found {found}")));
                }
                for k in 0..D {
                    if low[k] >= high[k] {
                        return Err(
                            document.error(max.span(), format!("`max` {:?} does not lie beyond `min` {:?}", high, low))
                        );
                    }
                    axes[k] = vec![low[k]];
                    axes[k].extend(graded(low[k], high[k], count(&cells.get_ref()[k])?, 1.0));
                }
            }
            (None, None, None, Some(list)) => {
                if list.get_ref().len() != D {
                    let found = list.get_ref().len();
                    return Err(document.error(list.span(), format!("expected {D} axes, found {found}")));
                }
                for (k, axis) in list.get_ref().iter().enumerate() {
                    axes[k] = self.axis(axis, &count)?;
                }
            }
            _ => {
                return Err(document.error(span.clone(), format!("the box of `{name}` is not said, or said twice")).help(
                    "either min, max and cells, or axes = [{ from = 0, to = [1, 4], cells = [8, 6], growth = [1, 1.2] }, …]",
                ));
            }
        }
        let cells: usize = axes.iter().map(|a| a.len() - 1).product();
        if cells > 20_000_000 {
            return Err(document.error(span.clone(), format!("{cells} cells are more than this program can take")));
        }
        let checked = |mesh: Mesh<D>| match mesh.check() {
            Ok(()) => Ok(mesh),
            Err(e) => Err(document
                .error(span.clone(), format!("the mesh of `{name}`: {e}"))
                .help("every cell needs a positive volume; look at the place named, and at `map` where there is one")),
        };
        let Some(map) = &key.map else { return checked(block::<D>(&axes, 1, |x| x)) };
        let list = map.get_ref();
        if list.len() != D {
            return Err(document.error(map.span(), format!("expected {D} expressions, found {}", list.len())));
        }
        let variables: &[&'static str] = if D == 2 { &["x", "y"] } else { &["x", "y", "z"] };
        let mut placed = Vec::new();
        for (k, v) in list.iter().enumerate() {
            let expression = self.reader.expression(v, LENGTH, variables)?;
            placed.push(Placed { expression, span: v.span(), key: format!("bodies.{name}.solid.mesh.box.map[{k}]") });
        }
        let mut failure: Option<CaseError> = None;
        // The geometry is as curved as the displacement.
        let mesh = block::<D>(&axes, degree, |x| {
            let mut y = Point::<D>::zeros();
            for k in 0..D {
                match evaluate(document, &placed[k], &x, 0.0) {
                    Ok(v) => y[k] = v,
                    Err(error) => {
                        failure.get_or_insert(error);
                    }
                }
            }
            y
        });
        if let Some(error) = failure {
            return Err(error);
        }
        checked(mesh)
    }

    /// Refuses a box whose `map` brings cells over each other.
    pub(super) fn check_overlap<const D: usize>(
        &self,
        name: &str,
        key: &statement::BoxKey,
        mesh: &Mesh<D>,
    ) -> Result<(), CaseError> {
        let Some(map) = &key.map else { return Ok(()) };
        let Some(Overlap { cells: [a, b], at }) = mesh.overlap() else { return Ok(()) };
        let message = format!("the mesh of `{name}`: its cells {a} and {b} overlap at {}", position(&at));
        Err(self.document.error(map.span(), message).help("`map` must bring no two places to the same one"))
    }

    fn axis(
        &self,
        axis: &toml::Spanned<statement::AxisKey>,
        count: &dyn Fn(&toml::Spanned<i64>) -> Result<usize, CaseError>,
    ) -> Result<Vec<f64>, CaseError> {
        let document = self.document;
        let key = axis.get_ref();
        let mut from = self.reader.number(&key.from, LENGTH)?;
        let (ends, cells) = (key.to.get_ref(), key.cells.get_ref());
        let growth = key.growth.as_ref().map(|g| g.get_ref().clone()).unwrap_or(vec![1.0; ends.len()]);
        if ends.is_empty() || ends.len() != cells.len() || ends.len() != growth.len() {
            return Err(document.error(
                axis.span(),
                format!("`to` has {} entries, `cells` {}, `growth` {}", ends.len(), cells.len(), growth.len()),
            ));
        }
        let mut out = vec![from];
        for ((end, n), g) in ends.iter().zip(cells).zip(growth) {
            let to = self.reader.number(end, LENGTH)?;
            if to <= from {
                return Err(document.error(end.span(), format!("the stretch ends at {to}, not after {from}")));
            }
            if !(g.is_finite() && (1e-3..=1e3).contains(&g)) {
                return Err(document.error(axis.span(), format!("a growth of {g}: give a number from 0.001 to 1000")));
            }
            out.extend(graded(from, to, count(n)?, g));
            from = to;
        }
        Ok(out)
    }

    pub(in crate::plan) fn gmsh<const D: usize>(&self, key: &statement::GmshKey) -> Result<Mesh<D>, CaseError> {
        let (path, bytes) = self.read_file(&key.file)?;
        let fail = |message: String| self.document.error(key.file.span(), format!("`{}`: {message}", path.display()));
        let file = signorini_fem::gmsh::GmshFile::parse(&bytes).map_err(|e| fail(e.to_string()))?;
        let mesh = file.mesh::<D>(key.group.as_deref()).map_err(|e| fail(e.to_string()))?;
        let volume = if D == 2 { "area" } else { "volume" };
        mesh.check().map_err(|e| {
            fail(e.to_string()).help(format!("every cell needs a positive {volume}; look at the place named"))
        })?;
        let Some(Overlap { cells, at }) = mesh.overlap() else { return Ok(mesh) };
        let of = |cell| file.origin::<D>(key.group.as_deref(), cell).unwrap_or_default();
        let [(first, from), (second, other)] = cells.map(of);
        let parts =
            if from == other { format!("{from} overlaps itself") } else { format!("{from} and {other} overlap") };
        let entity = if D == 2 { "Surface" } else { "Volume" };
        Err(fail(format!("{parts}: the elements {first} and {second} both cover {}", position(&at))).help(format!(
            "a body covers each place once: in Gmsh unite them before meshing, for example with BooleanUnion{{ {entity}{{1}}; \
             Delete; }}{{ {entity}{{2}}; Delete; }}, or name the one that is meant by `group`"
        )))
    }
}
