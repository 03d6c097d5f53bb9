//! Meshes of solids: boxes and files.

use crate::expression::Scope;
use crate::plan::located::LocatedExpression;
use crate::plan::placement::PlacementKeys;
use crate::plan::planner::Planner;
use crate::problem::units::LENGTH;
use crate::problem::{self, CaseError, Problem};
use signorini_fem::block::{block, graded};
use signorini_fem::mesh::position;
use signorini_fem::{Mesh, Overlap};
use signorini_geometry::Point;

impl Planner<'_> {
    pub(super) fn block<const D: usize>(
        &self,
        name: &str,
        key: &problem::BoxMesh,
        degree: usize,
    ) -> Result<Mesh<D>, CaseError> {
        let problem = self.problem;
        let count = |n: &i64| match n {
            1..=10_000 => Ok(*n as usize),
            other => Err(problem.error(n, format!("{other} cells: give a number from 1 to 10000"))),
        };
        let mut axes: [Vec<f64>; D] = std::array::from_fn(|_| Vec::new());
        match (&key.min, &key.max, &key.cells, &key.axes) {
            (Some(min), Some(max), Some(cells), None) => {
                let (low, high) = (self.reader.numbers::<D>(min, LENGTH)?, self.reader.numbers::<D>(max, LENGTH)?);
                if cells.len() != D {
                    let found = cells.len();
                    return Err(problem.error(cells, format!("expected {D} numbers of cells, found {found}")));
                }
                for k in 0..D {
                    if low[k] >= high[k] {
                        return Err(problem.error(max, format!("`max` {:?} is not greater than `min` {:?}", high, low)));
                    }
                    axes[k] = vec![low[k]];
                    axes[k].extend(graded(low[k], high[k], count(&cells[k])?, 1.0));
                }
            }
            (None, None, None, Some(list)) => {
                if list.len() != D {
                    let found = list.len();
                    return Err(problem.error(list, format!("expected {D} axes, found {found}")));
                }
                for (k, axis) in list.iter().enumerate() {
                    axes[k] = self.axis(axis, &count)?;
                }
            }
            _ => {
                return Err(problem.error(key, format!("the box of `{name}` is missing or given twice")).help(
                    "give either min, max and cells, or axes = [{ from = 0, to = [1, 4], cells = [8, 6], growth = [1, \
                     1.2] }, …]",
                ));
            }
        }
        let cells: usize = axes.iter().map(|a| a.len() - 1).product();
        if cells > 20_000_000 {
            return Err(problem.error(key, format!("{cells} cells are more than this program can handle")));
        }
        let checked = |mesh: Mesh<D>| match mesh.check() {
            Ok(()) => Ok(mesh),
            Err(e) => Err(problem.error(key, format!("the mesh of `{name}`: {e}")).help(
                "every cell needs a positive volume; check the cell at the given position, and `map` if there is one",
            )),
        };
        let Some(map) = &key.map else { return checked(block::<D>(&axes, 1, |x| x)) };
        if map.len() != D {
            return Err(problem.error(map, format!("expected {D} expressions, found {}", map.len())));
        }
        let variables: &[&'static str] = if D == 2 { &["x", "y"] } else { &["x", "y", "z"] };
        let mut placed = Vec::new();
        for v in map {
            let expression = self.reader.expression(v, LENGTH, variables)?;
            placed.push(LocatedExpression { expression, key: self.key(v) });
        }
        let mut failure: Option<CaseError> = None;
        // The geometry is as curved as the displacement.
        let mesh = block::<D>(&axes, degree, |x| {
            let mut y = Point::<D>::zeros();
            for k in 0..D {
                match evaluate(problem, &placed[k], &x, 0.0) {
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
        key: &problem::BoxMesh,
        mesh: &Mesh<D>,
    ) -> Result<(), CaseError> {
        let Some(map) = &key.map else { return Ok(()) };
        let Some(Overlap { cells: [a, b], at }) = mesh.overlap() else { return Ok(()) };
        let message = format!("the mesh of `{name}`: its cells {a} and {b} overlap at {}", position(&at));
        Err(self.problem.error(map, message).help("`map` must not map two points to the same position"))
    }

    fn axis(
        &self,
        key: &problem::MeshAxis,
        count: &dyn Fn(&i64) -> Result<usize, CaseError>,
    ) -> Result<Vec<f64>, CaseError> {
        let problem = self.problem;
        let mut from = self.reader.number(&key.from, LENGTH)?;
        let (ends, cells) = (&key.to, &key.cells);
        let growth = key.growth.as_ref().map_or_else(|| vec![1.0; ends.len()], |g| g.0.clone());
        if ends.is_empty() || ends.len() != cells.len() || ends.len() != growth.len() {
            return Err(problem.error(
                key,
                format!("`to` has {} entries, `cells` {}, `growth` {}", ends.len(), cells.len(), growth.len()),
            ));
        }
        let mut out = vec![from];
        for ((end, n), g) in ends.iter().zip(cells).zip(growth) {
            let to = self.reader.number(end, LENGTH)?;
            if to <= from {
                return Err(problem.error(end, format!("the segment ends at {to}, not after {from}")));
            }
            if !(g.is_finite() && (1e-3..=1e3).contains(&g)) {
                return Err(problem.error(key, format!("a growth of {g}: give a number from 0.001 to 1000")));
            }
            out.extend(graded(from, to, count(n)?, g));
            from = to;
        }
        Ok(out)
    }

    pub(in crate::plan) fn gmsh<const D: usize>(
        &self,
        file: &String,
        group: Option<&str>,
        placement: &PlacementKeys,
    ) -> Result<Mesh<D>, CaseError> {
        let (path, bytes) = self.read_file(file)?;
        let fail = |message: String| self.problem.error(file, format!("`{}`: {message}", path.display()));
        let parsed = signorini_fem::gmsh::GmshFile::parse(&bytes).map_err(|e| fail(e.to_string()))?;
        let mut mesh = parsed.mesh::<D>(group).map_err(|e| fail(e.to_string()))?;
        self.place_mesh(&mut mesh, placement)?;
        let volume = if D == 2 { "area" } else { "volume" };
        mesh.check().map_err(|e| {
            fail(e.to_string())
                .help(format!("every cell needs a positive {volume}; check the cell at the given position"))
        })?;
        let Some(Overlap { cells, at }) = mesh.overlap() else { return Ok(mesh) };
        let of = |cell| parsed.origin::<D>(group, cell).unwrap_or_default();
        let [(first, from), (second, other)] = cells.map(of);
        let parts =
            if from == other { format!("{from} overlaps itself") } else { format!("{from} and {other} overlap") };
        let entity = if D == 2 { "Surface" } else { "Volume" };
        Err(fail(format!("{parts}: the elements {first} and {second} both cover {}", position(&at))).help(format!(
            "no two cells may overlap: in Gmsh unite them before meshing, for example with BooleanUnion{{ \
             {entity}{{1}}; Delete; }}{{ {entity}{{2}}; Delete; }}, or select one of them by `group`"
        )))
    }
}

/// The value of an expression at a point and time, or an error that names it.
fn evaluate<const D: usize>(
    problem: &Problem,
    placed: &LocatedExpression,
    x: &Point<D>,
    time: f64,
) -> Result<f64, CaseError> {
    let position = std::array::from_fn(|k| if k < D { x[k] } else { 0.0 });
    let value = placed.expression.evaluate(&Scope { position, time });
    if value.is_finite() {
        return Ok(value);
    }
    let at: Vec<String> = x.iter().map(|v| format!("{v:.6}")).collect();
    let message = format!("`{}` is {value} at ({}), t = {time}: not a finite number", placed.key, at.join(", "));
    Err(problem.error(&placed.key, message))
}
