//! Time, memory and error of membranes by multigrid from coarse to fine: a round one on a flat floor, and a square one on a
//! cosine floor at f = 0.4, at degree 1, 2 and 4, and membranes on meshes whose cells are divided. From 1e3 unknowns to as
//! many as `SIGNORINI_LADDER` says (1e6 if it says nothing), beside the membrane alone, without contact, solved from nothing to
//! 1e-8, on `SIGNORINI_THREADS` threads (one if it says nothing), on grids of `SIGNORINI_DEGREE` alone if it says something.
//!
//! `cargo bench -p signorini-membrane --bench nested`
//!
//! What takes seconds is run three times and the fastest is told, here and of PETSc.
//!
//! With `SIGNORINI_PETSC` naming a Python that has petsc4py with hypre, numpy and scipy, PETSc solves the same problems at
//! degree 1 beside, from 1e5 nodes on: TAO tron and SNES vinewtonrsls on the same triangles, SNES on the same square grid.

#[path = "../tests/membrane/common/mod.rs"]
mod common;

use signorini_fem::{Cells, Grid, MeshCells};
use signorini_geometry::{Aabb, Ellipsoid, Jet, Point, Real};
use signorini_membrane::domain::{BoxDomain, Domain, DomainOnCells, ImplicitDomain};
use signorini_membrane::field::{Constant, Formula, SharedField};
use signorini_membrane::multigrid::{Hierarchy, OnGrid, OnMesh, Regular, nested};
use signorini_membrane::obstacle::{Obstacle, Obstacles, Side};
use signorini_membrane::plane_zone::PlaneZone;
use signorini_membrane::problem::{Measure, Membrane, Support};
use signorini_membrane::zone::Zone;
use signorini_solve::Silent;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

/// Nodes from which on PETSc runs beside.
const BESIDE: f64 = 1e5;

/// Radius of the zone on the flat floor.
const RADIUS: f64 = 0.502_474_357_08;

fn on_grid(
    [n, degree]: [usize; 2],
    half: f64,
    domain: Arc<dyn Domain<2>>,
    height: SharedField<2>,
    load: f64,
) -> Membrane<2> {
    let bounds = Aabb::new(Point::<2>::new(-half, -half), Point::<2>::new(half, half));
    let grid = Grid::new(bounds, [n, n], degree);
    let support = Some(Support { index: 0, displacement: Arc::new(Constant(0.0)) });
    Membrane {
        supports: vec![support; domain.pieces()],
        domain: DomainOnCells::new(domain, &grid),
        cells: Arc::new(grid.clone()),
        grid,
        sizing: None,
        measure: Measure::Plain,
        tension: Arc::new(Constant(1.0)),
        load: Arc::new(Constant(load)),
        obstacles: Obstacles(vec![Obstacle { side: Side::Below, height, adhesion: None }]),
        support_count: 1,
        modes: Default::default(),
        formulation: Default::default(),
    }
}

fn flat(n: [usize; 2]) -> Membrane<2> {
    let disc = Arc::new(ImplicitDomain(Ellipsoid { center: Point::zeros(), semi_axes: [1.0, 1.0] }));
    on_grid(n, 1.03, disc, Arc::new(Constant(-0.1)), -1.0)
}

fn waves(n: [usize; 2]) -> Membrane<2> {
    let cos = |v: Jet<2>| {
        let a = Jet::constant(std::f64::consts::TAU) * v;
        a.chain(a.value.cos(), -a.value.sin(), -a.value.cos())
    };
    let height = move |[x, y]: [Jet<2>; 2]| Jet::constant(-0.015) - Jet::constant(0.005) * cos(x) * cos(y);
    let square = BoxDomain(Aabb::new(Point::<2>::new(-1.0, -1.0), Point::<2>::new(1.0, 1.0)));
    on_grid(n, 1.0, Arc::new(square), Arc::new(Formula(height)), -0.4)
}

/// Forgets the largest memory of this process, where the system can.
fn forget_peak() {
    let _ = std::fs::write("/proc/self/clear_refs", "5");
}

/// The largest memory of this process since, in bytes, where the system tells.
fn peak() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:")).unwrap_or("");
    line.split_whitespace().next().and_then(|kb| kb.parse::<f64>().ok()).unwrap_or(f64::NAN) * 1024.0
}

/// The fastest of so many runs of what takes less than [`LONG`] seconds: others on the machine only make it slower.
const TIMES: usize = 3;
const LONG: f64 = 12.0;

fn best<T>(run: impl Fn() -> (T, f64)) -> (T, f64) {
    let (mut found, mut seconds) = run();
    for _ in 1..TIMES {
        if seconds < LONG {
            // Not two at once in memory.
            drop(found);
            let next = run();
            (found, seconds) = (next.0, seconds.min(next.1));
        }
    }
    (found, seconds)
}

/// Seconds for the membrane without contact.
fn alone<R: Regular>(membrane: &Membrane<2>) -> f64 {
    let start = Instant::now();
    let mut hierarchy = Hierarchy::<R>::new(membrane, &PlaneZone::empty(&membrane.grid)).expect("levels");
    while hierarchy.finest().relative_residual() > 1e-8 {
        hierarchy.cycle().expect("a cycle");
    }
    start.elapsed().as_secs_f64()
}

/// Rows of a table, one for each size.
struct Ladder<'a> {
    pool: &'a rayon::ThreadPool,
    figure: &'a dyn Fn(f64) -> f64,
    last: Option<(f64, f64)>,
}

impl Ladder<'_> {
    /// Solves one membrane, from the mesh on; whether there is a state.
    fn row<R: Regular>(&mut self, membrane: &(dyn Fn() -> Membrane<2> + Sync)) -> bool {
        forget_peak();
        let (found, seconds) = best(|| {
            let start = Instant::now();
            let solve = || nested::solve::<R>(&membrane(), f64::INFINITY, 32, (0, 0.0), &mut Silent);
            (self.pool.install(solve), start.elapsed().as_secs_f64())
        });
        let Ok(Ok(found)) = found else {
            println!("no state");
            return false;
        };
        let area: f64 = found.zone.curves().iter().map(|c| c.signed_area()).sum();
        let unknowns = found.level.unknowns() as f64;
        let memory = peak();
        let steps = found.steps;
        drop(found.level);
        let (_, alone) = best(|| ((), self.pool.install(|| alone::<R>(&membrane()))));
        println!(
            "{unknowns:>10} {seconds:>9.3} {:>8.2} {:>9.0} {:>9.0} {alone:>9.3}  {:.9e}  steps {steps:?}",
            1e6 * seconds / unknowns,
            memory / 1e6,
            memory / unknowns,
            (self.figure)(area),
        );
        if let Some((u, s)) = self.last.replace((unknowns, seconds)) {
            println!("{:>10} exponent {:.2}", "", (seconds / s).ln() / (unknowns / u).ln());
        }
        true
    }
}

/// PETSc on the same problem, one process for each run.
fn petsc(problem: &[&str]) {
    let Ok(python) = std::env::var("SIGNORINI_PETSC") else { return };
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/petsc.py");
    let run = || {
        let run = std::process::Command::new(&python).arg(script).args(problem).env("OMP_NUM_THREADS", "1").output();
        let (row, told) = match run {
            Ok(run) => [run.stdout, run.stderr].map(|text| String::from_utf8_lossy(&text).into_owned()).into(),
            Err(error) => (String::new(), error.to_string()),
        };
        let figures: serde_json::Value = serde_json::from_str(&row).unwrap_or_default();
        let seconds = figures["seconds"].as_f64().unwrap_or(f64::INFINITY);
        ((figures, told), seconds)
    };
    let ((figures, told), seconds) = best(run);
    let number = |key: &str| figures[key].as_f64();
    let name = format!("PETSc {}", problem[2]);
    match (number("unknowns"), number("megabytes")) {
        (Some(n), Some(mb)) => {
            let each = 1e6 * seconds / n;
            let off = number("front").map_or(String::new(), |off| format!("{off:.1e} "));
            println!("{n:>10} {seconds:>9.3} {each:>8.2} {mb:>9.0} {:>9.0} {:>9}  {off}{name}", 1e6 * mb / n, "")
        }
        _ => println!("{:>10} {name} did not run: {}", "", told.lines().last().unwrap_or("it said nothing")),
    }
}

/// Writes the triangles of all levels for PETSc: positions, corners, which nodes are held, and the parents of each.
fn write_levels(folder: &Path, finest: &Arc<MeshCells>) -> std::io::Result<()> {
    let mut levels = vec![finest.clone()];
    while let Some(coarser) = levels.last().and_then(|cells| cells.parent()).map(|parent| parent.cells.clone()) {
        levels.push(coarser);
    }
    for (level, cells) in levels.iter().rev().enumerate() {
        let write = |end: &str, bytes: Vec<u8>| std::fs::write(folder.join(format!("{level:02}.{end}")), bytes);
        let nodes = cells.function_count();
        let integers = |list: &mut dyn Iterator<Item = u32>| list.flat_map(u32::to_le_bytes).collect::<Vec<u8>>();
        let positions = (0..nodes).flat_map(|n| cells.node(n).data.0[0]);
        write("nodes", positions.flat_map(f64::to_le_bytes).collect())?;
        write("cells", integers(&mut (0..cells.count()).flat_map(|cell| cells.corner_functions(cell).to_vec())))?;
        let mut edge = vec![0u8; nodes];
        for side in cells.boundary_sides() {
            let corners = cells.corner_functions(side.cell);
            for end in [side.side, (side.side + 1) % corners.len()] {
                edge[corners[end] as usize] = 1;
            }
        }
        write("edge", edge)?;
        let parents = match cells.parent() {
            Some(parent) => parent.nodes.clone(),
            None => (0..nodes as u32).map(|n| [n; 4]).collect(),
        };
        write("parents", integers(&mut parents.into_iter().flatten()))?;
    }
    Ok(())
}

/// PETSc on the triangles of a mesh and of those that it was divided from.
fn petsc_on_mesh(cells: &Arc<MeshCells>) {
    if std::env::var_os("SIGNORINI_PETSC").is_none() {
        return;
    }
    let folder = std::env::temp_dir().join(format!("signorini-levels-{}", std::process::id()));
    let written = std::fs::create_dir_all(&folder).and_then(|()| write_levels(&folder, cells));
    match (written, folder.to_str()) {
        (Ok(()), Some(path)) => ["tron", "vinewtonrsls"].into_iter().for_each(|how| petsc(&["mesh", path, how])),
        (written, _) => println!("{:>10} PETSc did not run: {written:?}", ""),
    }
    let _ = std::fs::remove_dir_all(&folder);
}

fn head(name: &str) {
    println!(
        "{:>10} {:>9} {:>8} {:>9} {:>9} {:>9}  {name}",
        "unknowns", "s", "µs each", "MB peak", "B each", "alone s"
    );
}

/// A number that is asked for by the environment.
fn asked(name: &str, usual: f64) -> f64 {
    std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(usual)
}

fn main() {
    let most = asked("SIGNORINI_LADDER", 1.2e6);
    let threads = asked("SIGNORINI_THREADS", 1.0) as usize;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
    let radius = |area: f64| (area / std::f64::consts::PI).sqrt() - RADIUS;
    type Case<'a> = (&'a str, f64, fn([usize; 2]) -> Membrane<2>, &'a dyn Fn(f64) -> f64);
    let cases: [Case; 2] = [
        ("disc on a flat floor: radius off", 0.56, flat, &radius),
        ("square on a cosine floor: area", 1.0, waves, &|area| area),
    ];
    let only = asked("SIGNORINI_DEGREE", 0.0) as usize;
    type Divided<'a> = (usize, &'a str, f64, &'a dyn Fn(f64) -> f64, fn(usize) -> Arc<MeshCells>);
    let divided: [Divided; 3] = [
        (1, "disc on a flat floor, triangles of a file", 434.0, &radius, |k| common::cells("triangles_2_12", 1, k)),
        (2, "disc on a flat floor, triangles of a file", 434.0, &radius, |k| common::cells("triangles_2_12", 2, k)),
        (4, "square on a flat floor, skew quadrilaterals", 64.0, &|area| area, |k| common::quadrilaterals(4, k)),
    ];
    for (degree, name, first, figure, cells) in divided.into_iter().filter(|_| only == 0) {
        head(&format!("degree {degree}, {name}, every cell divided"));
        let mut ladder = Ladder { pool: &pool, figure, last: None };
        let nodes = |divisions: usize| first * 4f64.powi(divisions as i32) * (degree * degree) as f64;
        for divisions in (2..).take_while(|d| nodes(*d) < most) {
            ladder.row::<OnMesh>(&|| common::on_mesh(cells(divisions)));
            if degree == 1 && nodes(divisions) > BESIDE {
                petsc_on_mesh(&cells(divisions));
            }
        }
    }
    for degree in [1, 2, 4].into_iter().filter(|d| only == 0 || *d == only) {
        for (name, share, membrane, figure) in &cases {
            head(&format!("degree {degree}, {name}"));
            let mut ladder = Ladder { pool: &pool, figure, last: None };
            let sizes =
                [16usize, 32, 64, 128, 256, 512, 1024, 1408, 2816, 4096, 8192, 16384].map(|n| n / degree / 8 * 8);
            for n in sizes.into_iter().filter(|n| *n > 0) {
                let more = share * ((n * degree) as f64).powi(2) <= most;
                if !more || !ladder.row::<OnGrid>(&|| membrane([n, degree])) {
                    break;
                }
                if degree == 1 && name.starts_with("square") && (n * n) as f64 > BESIDE {
                    ["hypre", "mg"].into_iter().for_each(|how| petsc(&["grid", &n.to_string(), how]));
                }
            }
        }
    }
}
