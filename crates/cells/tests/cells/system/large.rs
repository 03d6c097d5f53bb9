//! A foam from an image, crushed with its pores closing, by iterations: time, memory and iterations over its size.

use super::*;
use signorini_cells::description::{Cells, Description, Geometry, Part as PlacePart, Refinement, Shape, build};
use signorini_cells::image::ImageData;
use signorini_cells::{End, Islands};
use signorini_contact::Coulomb;
use std::time::Instant;

/// A cube of voxels with pores about twelve voxels apart, at any size.
fn foam(n: usize) -> ImageData {
    let pores = (n as f64 / 12.0).round() as usize;
    let width = n as f64 / pores as f64;
    let mut seed = 3u64;
    let mut random = || {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 33) as f64 / (1u64 << 31) as f64
    };
    let mut values = vec![1000.0; n * n * n];
    for number in 0..pores.pow(3) {
        let middle: [f64; 3] = std::array::from_fn(|k| {
            ((number / pores.pow(k as u32) % pores) as f64 + 0.5 + 0.25 * (random() - 0.5)) * width
        });
        let size = width * (0.36 + 0.06 * random());
        // Flat pores close under less compression.
        let sizes = [size, size, 0.4 * size];
        let along: [Vec<f64>; 3] = std::array::from_fn(|k| {
            (0..n).map(|i| (-((i as f64 + 0.5 - middle[k]) / sizes[k]).powi(2)).exp()).collect()
        });
        let near = along.each_ref().map(|a| (0..n).filter(|i| a[*i] > 1e-4).collect::<Vec<usize>>());
        for &k in &near[2] {
            for &j in &near[1] {
                for &i in &near[0] {
                    values[(k * n + j) * n + i] -= 1400.0 * along[0][i] * along[1][j] * along[2][k];
                }
            }
        }
    }
    ImageData { count: vec![n; 3], spacing: vec![1.0 / n as f64; 3], origin: vec![0.0; 3], values }
}

/// Seconds of the processors so far: not those of other work beside.
fn processors() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields: Vec<f64> =
        stat.rsplit(')').next().unwrap_or("").split_whitespace().map(|f| f.parse().unwrap_or(0.0)).collect();
    fields.get(11..13).map_or(0.0, |t| (t[0] + t[1]) / 100.0)
}

/// Largest resident memory so far, in gibibytes.
fn memory() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|l| l.starts_with("VmHWM")).unwrap_or("0 0");
    line.split_whitespace().nth(1).and_then(|v| v.parse::<f64>().ok()).unwrap_or(0.0) / f64::from(1 << 20)
}

/// The most iterations, and how many sites are closed in the end.
fn crushed(
    n: usize,
    (travel, increments): (f64, usize),
    enforcement: Option<(Sampling, Enforcement)>,
    friction: Option<f64>,
) -> [usize; 2] {
    let begin = Instant::now();
    let shape = Shape::Image { image: foam(n), threshold: 550.0, smoothing: 1.0 };
    let mut d = Description::new("foam", Geometry::Shape(shape), Space::Solid, Cells::Count([n / 4; 3]), 2, ELASTIC);
    d.islands = Islands::Drop;
    for (name, end) in [("bottom", End::Low), ("top", End::High)] {
        d.places.insert(name.into(), PlacePart::Side { axis: 2, end });
    }
    let built = build(&d).unwrap();
    println!(
        "{n}: {} cells, volume {:.4}, built {:.1} s, {:?}, {:.2} GiB",
        built.cells,
        built.volume,
        processors(),
        begin.elapsed(),
        memory()
    );
    let contacts = enforcement.map(|(sampling, how)| {
        let itself = part(0, "boundary");
        let sides = ((itself.clone(), &*built.body), (itself, &*built.body));
        let mut contact = Contact::new("pores", sides.0, sides.1, sampling, how).unwrap();
        // Pores twice as far across close in several increments, if at all.
        contact.reach = 8.0 / n as f64;
        contact.pairing = Pairing::AtStart;
        contact.law.friction =
            friction.map(|mu| Box::new(Coulomb::isotropic(mu).unwrap()) as Box<dyn signorini_contact::Law>);
        println!("{n}: {} sites to test, {:?}, {:.2} GiB", contact.sites().len(), begin.elapsed(), memory());
        Box::new(contact) as Box<dyn Interaction>
    });
    let mut top = support(0, "top", [constant(0.0), constant(0.0), None]);
    top.displacement[2] = Some(Arc::new(move |_, t| -travel * t));
    let mut system = System {
        supports: vec![support(0, "bottom", [constant(0.0), constant(0.0), constant(0.0)]), top],
        bodies: vec![built.body],
        contacts: contacts.into_iter().collect(),
        solver: LinearSolver::Iterative,
        ..System::default()
    };
    system.prepare().unwrap();
    let mut told = |k: usize, r: f64| {
        println!("   {k}: {r:.2e}, {:?}", begin.elapsed());
        true
    };
    let (mut state, mut found) = (system.start(), IncrementResult::default());
    let (mut newton, mut most) = (0, 0);
    for k in 1..=increments {
        (state, found) = system.solve(&state, k as f64 / increments as f64, &mut told).unwrap();
        system.accept(&state).unwrap();
        let Solved::Iterative { most_iterations, .. } = found.solved else { panic!("{:?}", found.solved) };
        (newton, most) = (newton + found.iterations, most.max(most_iterations));
    }
    let sites = found.sites.first().map_or(0, Vec::len);
    let closed = found.sites.iter().flatten().filter(|s| s.pressure > 0.0).count();
    println!(
        "{n}: {} unknowns, {sites} sites, {closed} closed, {newton} of Newton, at most {most} iterations, force {:.6}, \
         {:.1} s of the processors, {:?}, {:.2} GiB",
        found.unknowns - sites * if friction.is_some() { 3 } else { 1 },
        -found.support_forces[1][0][2],
        processors(),
        begin.elapsed(),
        memory()
    );
    assert!(
        (found.support_forces[0][0] + found.support_forces[1][0]).norm() < 1e-8 * found.support_forces[1][0].norm()
    );
    [most, closed]
}

#[test]
fn a_small_foam_by_iterations() {
    assert!(crushed(16, (0.15, 1), None, None)[0] <= 100);
}

#[test]
fn a_small_foam_closes_its_pores() {
    let penalty = Enforcement::Penalty { wanted_penetration: None };
    let [iterations, closed] = crushed(24, (0.4, 1), Some((Sampling::Nodes, penalty)), None);
    assert!(iterations <= 60 && closed >= 10, "{iterations} {closed}");
    let [iterations, closed] = crushed(24, (0.4, 1), Some((Sampling::Nodes, penalty)), Some(0.3));
    assert!(iterations <= 90 && closed >= 10, "{iterations} {closed}");
    for friction in [None, Some(0.3)] {
        let [iterations, closed] = crushed(24, (0.4, 1), Some((Sampling::Nodes, Enforcement::Nitsche)), friction);
        assert!(iterations <= 90 && closed >= 10, "{iterations} {closed}");
    }
}

#[test]
#[ignore = "10 s: the size is FOAM, 32 if left out, the travel TRAVEL, its parts INCREMENTS, friction FRICTION, a penalty PENALTY, at ALL points"]
fn a_foam_that_closes_its_pores() {
    let n = std::env::var("FOAM").ok().and_then(|v| v.parse().ok()).unwrap_or(32);
    let travel = std::env::var("TRAVEL").ok().and_then(|v| v.parse().ok()).unwrap_or(0.3);
    let increments = std::env::var("INCREMENTS").ok().and_then(|v| v.parse().ok()).unwrap_or(1);
    let friction = std::env::var("FRICTION").ok().and_then(|v| v.parse().ok());
    let penalty = Enforcement::Penalty { wanted_penetration: None };
    let how = if std::env::var("PENALTY").is_ok() { penalty } else { Enforcement::Nitsche };
    let sampling = if std::env::var("ALL").is_ok() { Sampling::GaussPoints } else { Sampling::Nodes };
    assert!(crushed(n, (travel, increments), Some((sampling, how)), friction)[0] <= 120);
}

/// What cells need is told before they are made, and is what their equations then take.
#[test]
fn cells_that_memory_does_not_hold_are_refused_before_they_are_made() {
    let ball = Shape::Ellipsoid { center: [0.0; 3], semi_axes: [1.0; 3] };
    let ball = |degree: usize, cells: usize| {
        let mut d = Description::new(
            "ball",
            Geometry::Shape(ball.clone()),
            Space::Solid,
            Cells::Count([cells; 3]),
            degree,
            ELASTIC,
        );
        d.bounds = Some([[0.0; 3], [1.1; 3]]);
        d
    };
    for (degree, cells) in [(1, 16), (2, 16), (3, 12)] {
        let mut d = ball(degree, cells);
        let mut system = System { bodies: vec![build(&d).unwrap().body], ..System::default() };
        system.solver = LinearSolver::Iterative;
        let taken = system.memory() / f64::from(1 << 30);
        d.memory = 1e6;
        let refused = build(&d).map(drop);
        let Err(CellsError::Memory { needed, free, .. }) = refused else { panic!("{refused:?}") };
        println!("degree {degree}: {needed} of {taken} GiB");
        assert!((free - 1e6 / f64::from(1 << 30)).abs() < 1e-12);
        assert!(needed < 1.5 * taken && needed > taken / 1.5);
    }
    // Neither the grid nor what is refined needs to be made for that.
    for (cells, levels) in [(100_000, 0), (4, 12)] {
        let mut d = ball(1, cells);
        d.refinement = vec![Refinement::Near { distance: Arc::new(|_| 0.0), within: 1.0, levels }];
        d.memory = 1e8;
        let refused = build(&d).map(drop);
        assert!(matches!(refused, Err(CellsError::Memory { .. })), "{refused:?}");
    }
}
