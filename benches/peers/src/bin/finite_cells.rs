//! Finite cells beside mlhp and nutils in one run, each on one thread: `cargo run --release --bin finite_cells` in this folder.
//! `PYTHON` is an interpreter that has both (`pip install mlhp nutils numpy`).
//!
//! Every run of a peer is set against the cheapest of ours with no larger error of the energy. Seconds are of the
//! processor, from the shape to the displacement.

use nalgebra::Matrix2;
use signorini_cells::shapes::ball;
use signorini_cells::*;
use signorini_geometry::{Aabb, Point, Vector};
use signorini_mechanics::{Part, PlacedLoad, Support, System, TimedLoad};
use std::process::Command;
use std::sync::Arc;

/// Seconds of the processor that this process has used, in hundredths.
fn processor() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").expect("Linux");
    let fields: Vec<&str> = stat.rsplit(')').next().unwrap_or("").split_whitespace().collect();
    let ticks = |k: usize| fields[k].parse::<f64>().expect("ticks");
    (ticks(11) + ticks(12)) / 100.0
}

/// Mean seconds of a run, repeated for a second, and what it gives.
fn timed<T>(run: impl Fn() -> T) -> (f64, T) {
    let begin = processor();
    let mut count = 0.0;
    loop {
        let out = run();
        count += 1.0;
        let seconds = processor() - begin;
        if seconds > 1.0 {
            return (seconds / count, out);
        }
    }
}

struct Ours {
    n: usize,
    degree: usize,
    products: Products,
    unknowns: usize,
    energy: f64,
    seconds: f64,
    /// Of the rules and stiffness matrices, and the quadrature points in them.
    integration: f64,
    points: usize,
}

fn setup<const D: usize>(degree: usize, products: Products) -> Discretisation<D> {
    Discretisation { fictitious: 1e-10, products, ..Discretisation::of_degree(degree) }
}

fn stuff<const D: usize>(space: Space, youngs_modulus: f64, poissons_ratio: f64) -> Stuff<D> {
    Stuff { elastic: Elastic { youngs_modulus, poissons_ratio }, modulus: None, space }
}

fn block<const D: usize>(size: f64, radius: f64, (n, degree, products): Cells, stuff: Stuff<D>) -> CellBody<D> {
    let hole = Domain::shape(ball(Point::<D>::zeros(), radius));
    let b = Aabb::new(Point::<D>::zeros(), Point::<D>::repeat(size));
    let tree = CellTree::new(b, [n; D]).expect("cells");
    CellBody::new(Arc::new(Domain::Complement(Box::new(hole))), tree, setup(degree, products), stuff).expect("a body")
}

/// How many in each direction, their degree, and the functions.
type Cells = (usize, usize, Products);

fn measured<const D: usize>(
    (n, degree, products): Cells,
    body: impl Fn() -> CellBody<D>,
    state: impl Fn(&mut System),
) -> Ours {
    let (seconds, (energy, unknowns)) = timed(|| {
        let body = body();
        let unknowns = body.unknowns();
        let sides = (0..D).flat_map(|axis| End::BOTH.map(|end| (side(axis, end), Place::Side { axis, end })));
        let body = CellSolid::new("cells", body, &sides.collect()).expect("sides");
        let mut system = System { bodies: vec![Box::new(body)], ..System::default() };
        state(&mut system);
        (energy(&mut system), unknowns)
    });
    let (integration, points) = timed(|| {
        let body = body();
        let _ = body.stiffness();
        // All full cells have one matrix.
        let full = (degree + 1).pow(D as u32);
        full + body.cells().iter().map(|c| c.rule.volume.len()).sum::<usize>()
    });
    Ours { n, degree, products, unknowns, energy, seconds, integration, points }
}

fn side(axis: usize, end: End) -> String {
    format!("{end:?} {axis}")
}

fn on(axis: usize, end: End) -> Part {
    Part { body: 0, group: Some(side(axis, end)) }
}

/// Holds the displacement across a side of the box.
fn hold(system: &mut System, axis: usize, end: End, value: f64) {
    let mut support = Support { part: on(axis, end), ..Support::default() };
    support.displacement[axis] = Some(Arc::new(move |_, _| value));
    system.supports.push(support);
}

fn pull(system: &mut System, axis: usize, traction: impl Fn(&Point<3>) -> Vector<3> + Send + Sync + 'static) {
    let load = TimedLoad::Traction(Arc::new(move |x, _| traction(x)));
    system.loads.push(PlacedLoad { name: "traction".into(), part: on(axis, End::High), load });
}

/// The strain energy of the solution.
fn energy(system: &mut System) -> f64 {
    system.prepare().expect("a system");
    let start = system.start();
    system.solve(&start, 1.0, &mut |_, _| true).expect("a solution").1.energy
}

fn plate(cells: Cells) -> Ours {
    let body = || block(4.0, 1.0, cells, stuff::<2>(Space::PlaneStress, 206_900.0, 0.29));
    measured(cells, body, |system| {
        (0..2).for_each(|axis| hold(system, axis, End::Low, 0.0));
        pull(system, 1, |_| Vector::<3>::new(0.0, 100.0, 0.0));
    })
}

/// Stress about a hole of radius 1 under `σ_xx = 1` (Kirsch 1898).
fn stress(x: &Point<3>) -> Matrix2<f64> {
    let (r2, a) = (1.0 / x.xy().norm_squared(), x[1].atan2(x[0]));
    let r4 = r2 * r2;
    let radial = 0.5 * (1.0 - r2) + 0.5 * (1.0 - 4.0 * r2 + 3.0 * r4) * (2.0 * a).cos();
    let hoop = 0.5 * (1.0 + r2) - 0.5 * (1.0 + 3.0 * r4) * (2.0 * a).cos();
    let shear = -0.5 * (1.0 + 2.0 * r2 - 3.0 * r4) * (2.0 * a).sin();
    let turn = Matrix2::new(a.cos(), -a.sin(), a.sin(), a.cos());
    turn * Matrix2::new(radial, shear, shear, hoop) * turn.transpose()
}

fn kirsch(cells: Cells) -> Ours {
    let body = || block(4.0, 1.0, cells, stuff::<2>(Space::PlaneStrain, 1.0, 0.3));
    measured(cells, body, |system| {
        for axis in 0..2 {
            hold(system, axis, End::Low, 0.0);
            pull(system, axis, move |x| {
                let traction = stress(x).column(axis).into_owned();
                Vector::<3>::new(traction[0], traction[1], 0.0)
            });
        }
    })
}

fn cavity(cells: Cells) -> Ours {
    let body = || block(1.0, 0.6, cells, stuff::<3>(Space::Solid, 1.0, 0.3));
    measured(cells, body, |system| {
        (0..3).for_each(|axis| hold(system, axis, End::Low, 0.0));
        hold(system, 2, End::High, 1e-3);
    })
}

fn main() {
    // SAFETY: nothing else runs yet.
    unsafe { std::env::set_var("RAYON_NUM_THREADS", "1") };
    // Of the eighth of a block no energy is known: the least of fine cells, above the exact one by a few 1e-6 of it.
    let fine = cavity((6, 4, Products::Tensor)).energy;
    let both = |cells: &[(usize, usize)], run: fn(Cells) -> Ours| -> Vec<Ours> {
        let of = |products| cells.iter().map(move |&(n, p)| run((n, p, products)));
        of(Products::Tensor).chain(of(Products::Trunk)).collect()
    };
    let degrees = |n: usize, most: usize| (1..=most).map(move |p| (n, p));
    let in_plane: Vec<(usize, usize)> = degrees(4, 6).chain(degrees(8, 6)).collect();
    let problems = [
        ("plate", 0.455_227_877_571, both(&in_plane, plate)),
        ("Kirsch", 7.693_653_726_418_2, both(&in_plane, kirsch)),
        (
            "cavity",
            fine,
            both(
                &[
                    (3, 1),
                    (4, 1),
                    (3, 2),
                    (5, 1),
                    (4, 2),
                    (5, 2),
                    (3, 3),
                    (4, 3),
                    (10, 1),
                    (3, 4),
                    (5, 3),
                    (4, 4),
                    (3, 5),
                ],
                cavity,
            ),
        ),
    ];
    for (name, exact, runs) in &problems {
        for run in runs {
            println!(
                "{name:7} {:2}, degree {}, {:?}: {:6} unknowns, error {:9.2e}, {:.4} s, integration {:.4} s, {} points, {:.3} µs each",
                run.n,
                run.degree,
                run.products,
                run.unknowns,
                (run.energy / exact - 1.0).abs(),
                run.seconds,
                run.integration,
                run.points,
                1e6 * run.integration / run.points as f64
            );
        }
    }
    let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".into());
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/finite_cells.py");
    let out =
        Command::new(&python).arg(script).env("OMP_NUM_THREADS", "1").output().expect("Python with mlhp and nutils");
    for line in String::from_utf8_lossy(&out.stdout).lines().filter(|l| l.starts_with('{')) {
        let row: serde_json::Value = serde_json::from_str(line).expect("a line of JSON");
        let number = |key: &str| row[key].as_f64().unwrap_or(f64::NAN);
        let name = row["problem"].as_str().unwrap_or("");
        let Some((_, exact, runs)) = problems.iter().find(|p| p.0 == name) else { continue };
        let error = (number("energy") / exact - 1.0).abs();
        let good = runs.iter().filter(|r| (r.energy / exact - 1.0).abs() <= error);
        let best = good.min_by(|a, b| a.seconds.total_cmp(&b.seconds));
        print!(
            "{} {name}, {} cells, degree {}, {}: {} unknowns, error {error:.2e}, {:.4} s; integration {:.4} s, {} points, {:.2} µs each",
            row["tool"].as_str().unwrap_or(""),
            row["n"],
            row["p"],
            row["rule"].as_str().unwrap_or(""),
            row["unknowns"],
            number("seconds"),
            number("integration"),
            row["points"],
            1e6 * number("integration") / number("points")
        );
        match best {
            Some(own) => println!(
                "; ours {} cells, degree {}, {:?}: {:.4} s, {:.1} times less",
                own.n,
                own.degree,
                own.products,
                own.seconds,
                number("seconds") / own.seconds
            ),
            None => println!("; ours: none as good"),
        }
    }
    eprint!("{}", String::from_utf8_lossy(&out.stderr));
}
