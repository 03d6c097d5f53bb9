//! Of `admissible`.

use signorini_mechanics::body::Constraint;
use signorini_mechanics::system::{Held, Holder};
use signorini_mechanics::testing::Admissible;

#[test]
fn what_may_move_satisfies_the_equations_of_supports() {
    let held = |terms: &[(u32, f64)]| Held {
        by: Holder::Support(0),
        constraint: Constraint { terms: terms.to_vec(), ..Constraint::default() },
    };
    let single = [held(&[(1, 1.0)])];
    // The third says the same as the first two.
    let coupled = [
        held(&[(0, 1.0), (2, 0.5), (3, -2.0)]),
        held(&[(2, 1.0), (3, 0.3), (1, 4.0), (5, 0.1)]),
        held(&[(0, 1.0), (2, 1.5), (3, -1.7), (5, 0.1)]),
    ];
    let found = Admissible::new(6, &single, &coupled);
    assert_eq!(found.columns, 3);
    let v = found.expand(&[0.7, -1.1, 0.4]);
    assert_eq!(found.coordinates(&|k| v[k]), [0.7, -1.1, 0.4]);
    assert_eq!(v[1], 0.0);
    for h in &coupled {
        let sum: f64 = h.constraint.terms.iter().map(|(u, f)| f * v[*u as usize]).sum();
        assert!(sum.abs() < 1e-14, "{sum}");
    }
    let w = [0.3, 0.2, -0.9, 1.4, 0.6, -0.1];
    let (left, right): (f64, f64) = (
        v.iter().zip(&w).map(|(a, b)| a * b).sum(),
        found.gather(&w).iter().zip([0.7, -1.1, 0.4]).map(|(a, b)| a * b).sum(),
    );
    assert!((left - right).abs() < 1e-14);
}
