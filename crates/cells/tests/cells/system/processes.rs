//! Several processes that make one body together, here threads.

use super::*;
use signorini_cells::description::{Cells, Description, Geometry, Shape, build};
use signorini_mechanics::processes::{CellBlock, DistributedMatrix, Processes};
use std::sync::{Barrier, Mutex};

/// One of several threads in place of processes.
struct Thread {
    rank: usize,
    told: Arc<(Mutex<Vec<Vec<f64>>>, Barrier)>,
}

impl Processes for Thread {
    fn rank(&self) -> usize {
        self.rank
    }

    fn count(&self) -> usize {
        self.told.0.lock().unwrap().len()
    }

    fn gather(&self, own: &[f64]) -> Vec<Vec<f64>> {
        let (lists, barrier) = &*self.told;
        lists.lock().unwrap()[self.rank] = own.to_vec();
        barrier.wait();
        let all = lists.lock().unwrap().clone();
        barrier.wait();
        all
    }

    fn sum(&self, values: &mut [f64]) {
        let all = self.gather(values);
        values.iter_mut().enumerate().for_each(|(k, value)| *value = all.iter().map(|list| list[k]).sum());
    }

    fn first_word(&self, _: Option<String>) -> Option<String> {
        unimplemented!()
    }

    fn matrix(&self, _: &[u32], _: &[CellBlock], _: &[(u32, u32, f64)]) -> Box<dyn DistributedMatrix> {
        unimplemented!()
    }
}

/// Forces at a state that stretches and bends, of all cells or of those that are kept.
fn forces(body: &dyn Body) -> (Vec<f64>, f64, Vec<(Vec<u32>, Vec<f64>)>) {
    let mut state = body.start();
    state.configuration.iter_mut().enumerate().for_each(|(k, u)| *u = 1e-3 * (1.3 * k as f64).sin());
    let mut out = Contribution::new(body.unknowns());
    let energy = body.internal(&state, Order::Second, &mut out).unwrap();
    (out.forces, energy, out.blocks)
}

/// Bodies that three processes make together are those of one to the last digit: full and cut cells, points of the volume and of the
/// boundary; and the
/// parts of their cells add up to the whole.
#[test]
fn processes_make_the_body_that_one_makes() {
    let shape = Shape::Ellipsoid { center: [0.03, 0.0, 0.0], semi_axes: [0.9, 0.7, 0.8] };
    let mut d = Description::new("ball", Geometry::Shape(shape), Space::Solid, Cells::Count([6; 3]), 2, ELASTIC);
    d.bounds = Some([[-1.0; 3], [1.0; 3]]);
    let one = build(&d).unwrap();
    let (whole, energy, blocks) = forces(&*one.body);
    let told = Arc::new((Mutex::new(vec![Vec::new(); 3]), Barrier::new(3)));
    let built: Vec<_> = std::thread::scope(|scope| {
        let make = |rank: usize| {
            let mut d = d.clone();
            d.processes = Some(Arc::new(Thread { rank, told: told.clone() }));
            scope.spawn(move || build(&d).unwrap())
        };
        let threads: Vec<_> = (0..3).map(make).collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).collect()
    });
    let (mut sum, mut total, mut count) = (vec![0.0; whole.len()], 0.0, 0);
    for (rank, mut made) in built.into_iter().enumerate() {
        assert_eq!((made.volume, made.cells), (one.volume, one.cells));
        assert_eq!(forces(&*made.body), (whole.clone(), energy, blocks.clone()));
        let keep: Vec<bool> = (0..made.cells).map(|cell| cell * 3 / made.cells == rank).collect();
        assert!(made.body.keep_cells(&keep));
        let (part, energy, blocks) = forces(&*made.body);
        sum.iter_mut().zip(part).for_each(|(sum, force)| *sum += force);
        total += energy;
        count += blocks.len();
    }
    let largest = whole.iter().fold(0.0f64, |m, f| m.max(f.abs()));
    assert!(sum.iter().zip(&whole).all(|(a, b)| (a - b).abs() < 1e-13 * largest) && count == blocks.len());
    assert!((total - energy).abs() < 1e-13 * energy);
}
