//! Of `cable::element`.

use signorini_geometry::Vector;
use signorini_rope::cable::element::{Carries, Element, Forces};

fn nodes() -> [Vector<3>; 4] {
    [[0.0, 0.0, 0.0], [1.1, 0.3, -0.2], [1.0, 0.4, 0.3], [0.8, 0.7, 0.5]].map(Vector::<3>::from)
}

fn moved(x: &[Vector<3>; 4], step: &Forces, share: f64) -> [Vector<3>; 4] {
    std::array::from_fn(|n| x[n] + step.fixed_rows::<3>(3 * n) * share)
}

#[test]
fn forces_and_tangent_are_derivatives_of_the_energy() {
    for (bending, carries) in [(0.7, Carries::TensionAndCompression), (0.0, Carries::TensionOnly)] {
        let unstrained = [[0.0; 3], [1.0, 0.0, 0.0], [0.8, 0.0, 0.0], [1.0, 0.0, 0.0]].map(Vector::<3>::from);
        let element = Element::new(0.8, 30.0, bending, carries, &unstrained);
        let x = nodes();
        let (energy, forces) = element.forces(&x);
        let tangent = element.tangent(&x, &element.stresses(&x));
        assert!(energy > 0.0 && (tangent - tangent.transpose()).norm() < 1e-13 * tangent.norm());
        for seed in [0.3, 1.1, 2.9] {
            let v = Forces::from_fn(|k, _| (seed + 1.7 * k as f64).sin());
            let left = |e: f64| {
                let exact = element.forces(&moved(&x, &v, e)).0;
                (exact - energy - e * forces.dot(&v) - 0.5 * e * e * v.dot(&(tangent * v))).abs()
            };
            let order = (left(4e-3) / left(2e-3)).log2();
            assert!((order - 3.0).abs() < 0.2, "{order}");
            let e = 1e-6;
            let difference = (element.forces(&moved(&x, &v, e)).1 - element.forces(&moved(&x, &v, -e)).1) / (2.0 * e);
            assert!((difference - tangent * v).norm() < 1e-7 * difference.norm());
            let (p, m) = (element.stresses(&moved(&x, &v, e)), element.stresses(&moved(&x, &v, -e)));
            let rate = element.predicted(&x, &v);
            let now = element.stresses(&x);
            for k in 0..3 {
                let difference = (p.moments[k] - m.moments[k]) / (2.0 * e);
                assert!((difference - (rate.moments[k] - now.moments[k])).norm() < 1e-7 * (1.0 + difference.norm()));
            }
        }
    }
}

#[test]
fn forces_have_no_resultant_and_no_moment() {
    let x = nodes();
    let element = Element::new(
        0.8,
        30.0,
        0.7,
        Carries::TensionAndCompression,
        &[Vector::<3>::zeros(), Vector::<3>::x(), Vector::<3>::x() * 0.8, Vector::<3>::x()],
    );
    let f = element.forces(&x).1;
    let of = |n: usize| f.fixed_rows::<3>(3 * n).into_owned();
    assert!((of(0) + of(2)).norm() < 1e-13 * f.norm());
    let moment = (0..4).fold(Vector::<3>::zeros(), |m, n| m + x[n].cross(&of(n)));
    assert!(moment.norm() < 1e-13 * f.norm());
}
