//! An eighth of a block with a spherical cavity under tension (Southwell & Gough 1926, Goodier 1933), with the exact
//! tractions on the far sides.

use super::case::Case;
use super::{material, reference};
use nalgebra::Matrix3;
use signorini_cells::shapes::ball;
use signorini_cells::*;
use signorini_geometry::jet::{Jet, Real};
use signorini_geometry::{Aabb, Point, Vector};
use std::sync::{Arc, OnceLock};

const NU: f64 = 0.3;

/// Displacements that fade away from the origin: `∇(1/r)`, `∇∂_zz(1/r)`, and a dipole of Papkovich and Neuber.
fn fading(which: usize, x: &Point<3>) -> [Jet<3>; 3] {
    let x: [Jet<3>; 3] = std::array::from_fn(|k| Jet::variable(x[k], k));
    let c = Jet::<3>::constant;
    let s = x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
    let (r3, r5, r7) = (s.powf(-1.5), s.powf(-2.5), s.powf(-3.5));
    let z = x[2];
    std::array::from_fn(|i| {
        let along = c(f64::from(u8::from(i == 2)));
        match which {
            0 => -x[i] * r3,
            1 => c(6.0) * z * along * r5 - c(15.0) * z * z * x[i] * r7 + c(3.0) * x[i] * r5,
            _ => (c(2.0 - 4.0 * (1.0 - NU)) * z * r3 * along) - c(3.0) * z * z * x[i] * r5,
        }
    })
}

fn stress_of(u: &[Jet<3>; 3]) -> Matrix3<f64> {
    let gradient = Matrix3::from_fn(|i, j| u[i].gradient[j]);
    Elastic { youngs_modulus: 1.0, poissons_ratio: NU }.stress(Space::Solid, &gradient)
}

/// The factors with which the fading fields leave no traction on the cavity under `σ_zz = 1`, and what they leave.
fn factors() -> (Vector<3>, f64) {
    let (mut matrix, mut rhs) = (Matrix3::zeros(), Vector::<3>::zeros());
    let points: Vec<Point<3>> = (0..12)
        .map(|i| {
            let (a, b) = (0.3 * f64::from(i), 0.1 + 0.25 * f64::from(i));
            Point::<3>::new(a.cos() * b.sin(), a.sin() * b.sin(), b.cos())
        })
        .collect();
    let tractions = |x: &Point<3>| {
        let fields: [Vector<3>; 3] = std::array::from_fn(|w| stress_of(&fading(w, x)) * x);
        (fields, Vector::<3>::new(0.0, 0.0, x[2]))
    };
    for x in &points {
        let (t, far) = tractions(x);
        for i in 0..3 {
            rhs[i] -= t[i].dot(&far);
            (0..3).for_each(|j| matrix[(i, j)] += t[i].dot(&t[j]));
        }
    }
    let found = matrix.lu().solve(&rhs).unwrap();
    let left = points.iter().map(|x| {
        let (t, far) = tractions(x);
        (far + t[0] * found[0] + t[1] * found[1] + t[2] * found[2]).norm()
    });
    (found, left.fold(0.0, f64::max))
}

fn stress(x: &Point<3>) -> Matrix3<f64> {
    static FACTORS: OnceLock<Vector<3>> = OnceLock::new();
    let f = FACTORS.get_or_init(|| factors().0);
    let mut s: Matrix3<f64> = (0..3).map(|w| stress_of(&fading(w, x)) * f[w]).sum();
    s[(2, 2)] += 1.0;
    s
}

fn block(n: usize, degree: usize, products: Products) -> CellBody<3> {
    let b = Aabb::new(Point::<3>::zeros(), Point::<3>::repeat(4.0));
    let domain = Domain::Complement(Box::new(Domain::shape(ball(Point::<3>::zeros(), 1.0))));
    let setup = Discretisation { fictitious: 1e-10, products, ..Discretisation::of_degree(degree) };
    CellBody::new(Arc::new(domain), CellTree::new(b, [n; 3]).unwrap(), setup, material(Space::Solid)).unwrap()
}

fn loaded(body: &CellBody<3>) -> Case<3> {
    (0..3).fold(Case::new(body).symmetric(&[0, 1, 2]), |case, axis| {
        let normal = Vector::<3>::from_fn(|k, _| f64::from(u8::from(k == axis)));
        case.traction(Place::high(axis), move |x| stress(x) * normal)
    })
}

fn check(wanted: &dyn Fn(u64, u64, u64) -> bool) {
    let data = &reference()["cavity"];
    let exact = data["strain_energy"]["value"].as_f64().unwrap();
    let mut rows = 0;
    for row in data["table"].as_array().unwrap() {
        let [n, p, trunk] = ["n", "p", "trunk"].map(|k| row[k].as_u64().unwrap());
        if !wanted(n, p, trunk) {
            continue;
        }
        rows += 1;
        let products = if trunk == 1 { Products::Trunk } else { Products::Tensor };
        let body = block(n as usize, p as usize, products);
        assert_eq!(body.unknowns() as u64, row["ndof"].as_u64().unwrap());
        let error = 1.0 - loaded(&body).solve().unwrap().result.energy / exact;
        println!("{n} cells, degree {p}, {products:?}: {error:e} ({})", row["dU"]);
        assert!((error / row["dU"].as_f64().unwrap() - 1.0).abs() < 0.02, "{error:e}: {row}");
    }
    assert!(rows > 0);
}

#[test]
fn energies_are_those_of_an_independent_code() {
    assert!(factors().1 < 1e-13);
    assert!((stress(&Point::<3>::x())[(2, 2)] - 2.0454545454545454).abs() < 1e-12);
    check(&|n, p, trunk| n == 3 && p <= 3 && (trunk == 0 || p == 3) || (n == 6 && p == 1));
}

#[test]
#[ignore = "ten seconds: up to 20 thousand unknowns of degree 3"]
fn energies_of_finer_cells() {
    check(&|n, p, trunk| (n == 6 && p <= 3 && trunk == 0) || (n == 3 && p == 4));
}

/// Iterations with vertex stars, cut cells and a coarse level, in space.
#[test]
fn iterations_hardly_depend_on_grid_and_degree() {
    for (n, p) in [(3, 1), (3, 2), (5, 2)] {
        let body = block(n, p, Products::Tensor);
        let (iterations, condition) = loaded(&body).iterations();
        println!("{n} cells, degree {p}: {iterations} iterations, condition {condition:.1}");
        assert!(iterations <= 40 && condition < 25.0, "{iterations} {condition}");
    }
}

/// Cells of which only a sliver is material, along a side or in a corner.
#[test]
fn iterations_do_not_depend_on_small_cuts() {
    for (p, depth) in [(1, 1e-4), (2, 0.3), (2, 1e-2), (2, 1e-4)] {
        for normal in [Vector::<3>::x(), Vector::<3>::new(1.0, 0.3, 0.2).normalize()] {
            let b = Aabb::new(Point::<3>::zeros(), Point::<3>::repeat(1.0));
            let point = Point::<3>::new((2.0 + depth) / 3.0, 0.0, 0.0);
            let domain = Domain::shape(signorini_cells::shapes::HalfSpace { point, normal });
            let setup = Discretisation::of_degree(p);
            let tree = CellTree::new(b, [3; 3]).unwrap();
            let body = CellBody::new(Arc::new(domain), tree, setup, material(Space::Solid)).unwrap();
            let case = Case::new(&body).clamped(Place::low(0));
            let (iterations, condition) = case.body_force(|x| Vector::<3>::new(1.0, x[0], 0.5)).iterations();
            println!("cut {depth:e}, degree {p}: {iterations} iterations, condition {condition:.1}");
            assert!(iterations <= 42 && condition < 25.0, "{iterations} {condition}");
        }
    }
}
