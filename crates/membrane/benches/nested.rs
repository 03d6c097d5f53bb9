//! Time, memory and error of a round membrane on a flat floor, by multigrid from coarse to fine: from 1e4 unknowns to as many
//! as `SIGNORINI_LADDER` says (1e6 if it says nothing), one thread.
//!
//! `cargo bench -p signorini-membrane --bench nested`

use signorini_fem::Grid;
use signorini_geometry::{Aabb, Ellipse, Point, polygon};
use signorini_membrane::domain::{DomainOnCells, ImplicitDomain};
use signorini_membrane::field::Constant;
use signorini_membrane::multigrid::nested;
use signorini_membrane::obstacle::{Obstacle, Obstacles, Side};
use signorini_membrane::problem::{Measure, Membrane, Support};
use signorini_solve::Silent;
use std::sync::Arc;
use std::time::Instant;

const EXACT: f64 = 0.502_474_357_08;

fn membrane(n: usize) -> Membrane<2> {
    let bounds = Aabb::new(Point::<2>::new(-1.03, -1.03), Point::<2>::new(1.03, 1.03));
    let grid = Grid::new(bounds, [n, n], 1);
    let domain = Arc::new(ImplicitDomain(Ellipse { center: Point::zeros(), semi_axes: [1.0, 1.0] }));
    let floor = Obstacle { side: Side::Below, height: Arc::new(Constant(-0.1)), adhesion: None };
    Membrane {
        supports: vec![Some(Support { index: 0, displacement: Arc::new(Constant(0.0)) })],
        domain: DomainOnCells::new(domain, &grid),
        cells: Arc::new(grid.clone()),
        grid,
        measure: Measure::Plain,
        tension: Arc::new(Constant(1.0)),
        load: Arc::new(Constant(-1.0)),
        obstacles: Obstacles(vec![floor]),
        support_count: 1,
    }
}

/// The largest memory of this process so far, in bytes, where the system tells.
fn peak() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:")).unwrap_or("");
    line.split_whitespace().next().and_then(|kb| kb.parse::<f64>().ok()).unwrap_or(f64::NAN) * 1024.0
}

fn main() {
    let most: f64 = std::env::var("SIGNORINI_LADDER").ok().and_then(|v| v.parse().ok()).unwrap_or(1.2e6);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
    println!("{:>10} {:>9} {:>8} {:>9} {:>9} {:>11}", "unknowns", "s", "µs each", "MB peak", "B each", "radius off");
    let mut last: Option<(f64, f64)> = None;
    for n in [128usize, 256, 512, 1024, 1408, 2816, 4096, 8192] {
        if 0.56 * (n * n) as f64 > most {
            break;
        }
        let start = Instant::now();
        let found = pool.install(|| nested::solve(&membrane(n), f64::INFINITY, (0, 0.0), &mut Silent));
        let seconds = start.elapsed().as_secs_f64();
        let Ok(Ok(found)) = found else {
            println!("{n} x {n}: no state");
            return;
        };
        let area: f64 = found.zone.curves().iter().map(|c| polygon::signed_area(c.samples())).sum();
        let unknowns = found.level.unknowns() as f64;
        println!(
            "{unknowns:>10} {seconds:>9.3} {:>8.2} {:>9.0} {:>9.0} {:>11.1e}",
            1e6 * seconds / unknowns,
            peak() / 1e6,
            peak() / unknowns,
            (area / std::f64::consts::PI).sqrt() - EXACT
        );
        if let Some((u, s)) = last.replace((unknowns, seconds)) {
            println!("{:>10} exponent {:.2}", "", (seconds / s).ln() / (unknowns / u).ln());
        }
    }
}
