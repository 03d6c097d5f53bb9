//! Bodies of finite cells in systems of bodies.

mod bodies;
mod contacts;
mod descriptions;
mod discs;
mod finite;
mod friction;
mod images;
mod iterations;
mod large;
mod masters;
mod mixed;
mod pores;
mod processes;

use signorini_cells::{
    CellBody, CellMaterial, CellSolid, CellTree, CellsError, Discretisation, Domain, Elastic, Place, Region, Space,
};
use signorini_geometry::{Aabb, Point, Vector};
use signorini_mechanics::*;
use std::collections::BTreeMap;
use std::sync::Arc;

const ELASTIC: Elastic = Elastic { youngs_modulus: 1.0, poissons_ratio: 0.3 };

fn v(x: f64, y: f64, z: f64) -> Vector<3> {
    Vector::<3>::new(x, y, z)
}

/// The box from one corner to another.
fn aabb<const D: usize>(low: [f64; D], high: [f64; D]) -> Aabb<D> {
    Aabb::new(Point::<D>::from(low), Point::<D>::from(high))
}

fn material<const D: usize>(space: Space) -> CellMaterial<D> {
    CellMaterial { solid: ELASTIC.into(), modulus: None, space }
}

fn cells<const D: usize>(
    domain: Domain<D>,
    tree: CellTree<D>,
    degree: usize,
    space: Space,
) -> Result<CellBody<D>, CellsError> {
    let region: Arc<dyn Region<D>> = Arc::new(domain);
    CellBody::new(
        region,
        tree,
        Discretisation { fictitious: 1e-12, ..Discretisation::of_degree(degree) },
        material(space),
    )
}

fn named<const D: usize>(list: Vec<(&str, Place<D>)>) -> BTreeMap<String, Place<D>> {
    list.into_iter().map(|(name, place)| (name.to_string(), place)).collect()
}

fn solid<const D: usize>(
    name: &str,
    domain: Domain<D>,
    (b, n): (Aabb<D>, [usize; D]),
    degree: usize,
    space: Space,
    places: Vec<(&str, Place<D>)>,
) -> CellSolid<D> {
    let body = cells(domain, CellTree::new(b, n).unwrap(), degree, space).unwrap();
    CellSolid::new(name, body, &named(places)).unwrap()
}

fn part(body: usize, group: &str) -> Part {
    Part { body, group: (!group.is_empty()).then(|| group.to_string()) }
}

/// Holds the components of which a field is given, at that field times the time.
fn support(body: usize, group: &str, fields: [Option<Arc<dyn Fn(&Point<3>) -> f64 + Send + Sync>>; 3]) -> Support {
    let timed = |f: Arc<dyn Fn(&Point<3>) -> f64 + Send + Sync>| -> signorini_mechanics::system::TimeField {
        Arc::new(move |x, t| t * f(x))
    };
    let displacement = fields.map(|f| f.map(timed));
    Support {
        name: group.to_string(),
        part: part(body, group),
        displacement,
        rotation: [const { None }; 3],
        ..Support::default()
    }
}

fn constant(value: f64) -> Option<Arc<dyn Fn(&Point<3>) -> f64 + Send + Sync>> {
    Some(Arc::new(move |_| value))
}

fn solve(system: &mut System) -> (SystemState, IncrementResult) {
    system.prepare().unwrap();
    let start = system.start();
    system.solve(&start, 1.0, &mut |_, _| true).unwrap()
}

/// The largest difference between tangent and central differences of the residual, relative to the largest entry.
fn tangent_error(system: &System, state: &SystemState, h: f64, columns: usize) -> f64 {
    let (residual, matrix) = system.linearise(state, 1.0).unwrap();
    let n = residual.len();
    let scale = matrix.row_sizes().into_iter().fold(0.0, f64::max);
    let mut worst = 0.0f64;
    for j in (0..n).step_by((n / columns).max(1)) {
        let of = |h: f64| {
            let mut step = vec![0.0; n];
            step[j] = h;
            system.linearise(&system.advance(state, &step, 1.0), 1.0).unwrap().0
        };
        let (plus, minus) = (of(h), of(-h));
        for i in 0..n {
            worst = worst.max((matrix.get(i, j) - (plus[i] - minus[i]) / (2.0 * h)).abs() / scale);
        }
    }
    worst
}
