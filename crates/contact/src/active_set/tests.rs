//! Active sets of a few rows beside what they come to by hand, and beside all sets tried one by one.

use super::*;
use nalgebra::{DMatrix, DVector};

/// Bodies whose compliance is known.
struct Known(DMatrix<f64>);

impl Compliance for Known {
    fn solve_columns(&self, b: &mut [f64]) -> Result<(), SolveError> {
        for column in b.chunks_mut(self.size()) {
            column.copy_from_slice((&self.0 * DVector::from_column_slice(column)).as_slice());
        }
        Ok(())
    }
    fn solve_once(&self, b: &mut [f64]) -> Result<(), SolveError> {
        self.solve_columns(b)
    }
    fn solve_accurately(&self, b: &[f64]) -> Result<Vec<f64>, SolveError> {
        let mut out = b.to_vec();
        self.solve_columns(&mut out)?;
        Ok(out)
    }
    fn size(&self) -> usize {
        self.0.nrows()
    }
    fn entries(&self) -> f64 {
        self.0.len() as f64
    }
    fn block(&self, unknowns: &[u32]) -> Vec<f64> {
        unknowns.iter().flat_map(|j| unknowns.iter().map(|i| self.0[(*i as usize, *j as usize)])).collect()
    }
}

/// `gap + u_k ≥ 0`.
fn floor(k: u32, gap: f64) -> WeightedGap {
    WeightedGap { gap, weight: 1.0, terms: vec![(k, 1.0)], forces: Vec::new(), node: k }
}

fn solve(
    set: &mut ActiveSet,
    system: &Known,
    rows: &[WeightedGap],
    soft: Softness,
    springs: &[Spring],
    load: &[f64],
) -> Result<ContactState, ActiveSetError> {
    set.solve(system, rows, &vec![soft; rows.len()], springs, load, &mut |_, _| true)
}

/// A spring of stiffness 2 above a floor at -1.
fn one(load: f64, soft: Softness) -> ContactState {
    let system = Known(DMatrix::from_element(1, 1, 0.5));
    solve(&mut ActiveSet::default(), &system, &[floor(0, 1.0)], soft, &[], &[load]).unwrap()
}

#[test]
fn a_spring_carries_itself_or_is_carried() {
    let open = one(-1.0, Softness::default());
    assert_eq!((open.u[0], open.pressure[0], open.gap[0], open.active[0]), (-0.5, 0.0, 0.5, false));
    let closed = one(-3.0, Softness::default());
    assert!((closed.u[0] + 1.0).abs() < 1e-15 && (closed.pressure[0] - 1.0).abs() < 1e-15 && closed.active[0]);
}

/// `2 u = -3 + λ` and `1 + u + c (λ - s) = 0`.
#[test]
fn soft_rows_give_way_by_their_compliance_from_their_shift() {
    for (compliance, shift) in [(0.25, 0.0), (0.25, 1.0), (2.0, 0.4)] {
        let found = one(-3.0, Softness { compliance, shift });
        let pressure = (1.0 + 2.0 * compliance * shift) / (1.0 + 2.0 * compliance);
        assert!((found.pressure[0] - pressure).abs() < 1e-14, "{}", found.pressure[0]);
        assert!((found.gap[0] - compliance * (shift - pressure)).abs() < 1e-14);
        assert!((found.u[0] - 0.5 * (pressure - 3.0)).abs() < 1e-14);
    }
}

/// A string of eight springs, pressed on a floor that is not flat.
fn string() -> (Known, DMatrix<f64>, Vec<WeightedGap>, Vec<f64>) {
    let n = 8;
    let near = |i: usize, j: usize| match i.abs_diff(j) {
        0 => 2.0,
        1 => -1.0,
        _ => 0.0,
    };
    let stiffness = DMatrix::from_fn(n, n, near);
    let rows = (0..n as u32).map(|k| floor(k, 0.3 + 0.2 * (1.7 * f64::from(k)).sin())).collect();
    let load = (0..n).map(|k| -0.2 - 0.15 * (2.3 * k as f64).cos()).collect();
    (Known(stiffness.clone().try_inverse().unwrap()), stiffness, rows, load)
}

#[test]
fn the_state_is_the_only_one_of_all_sets_that_is_admissible() {
    let (system, stiffness, rows, load) = string();
    let n = rows.len();
    let found = solve(&mut ActiveSet::default(), &system, &rows, Softness::default(), &[], &load).unwrap();
    let mut admissible = Vec::new();
    for set in 0..1usize << n {
        // Closed rows prescribe their unknown.
        let closed = |k: usize| set >> k & 1 == 1;
        let mut matrix = stiffness.clone();
        let mut rhs = DVector::from_column_slice(&load);
        for k in (0..n).filter(|&k| closed(k)) {
            matrix.row_mut(k).fill(0.0);
            matrix[(k, k)] = 1.0;
            rhs[k] = -rows[k].gap;
        }
        let u = matrix.lu().solve(&rhs).unwrap();
        let pressure = &stiffness * &u - DVector::from_column_slice(&load);
        if (0..n).all(|k| if closed(k) { pressure[k] >= 0.0 } else { rows[k].gap + u[k] >= 0.0 }) {
            admissible.push((u, pressure));
        }
    }
    let [(u, pressure)] = &admissible[..] else { panic!("{} admissible sets", admissible.len()) };
    assert!(found.active.iter().any(|a| *a) && !found.active.iter().all(|a| *a));
    for k in 0..n {
        assert!((found.u[k] - u[k]).abs() < 1e-13 && (found.pressure[k] - pressure[k]).abs() < 1e-13, "row {k}");
        assert!((found.gap[k] - (rows[k].gap + u[k])).abs() < 1e-13, "row {k}");
    }
}

#[test]
fn both_routes_find_the_same_state_and_a_saved_set_is_taken_up() {
    let (system, _, rows, load) = string();
    let by = |route: Route| {
        let mut set = ActiveSet { route: Some(route), ..ActiveSet::default() };
        let found = solve(&mut set, &system, &rows, Softness::default(), &[], &load).unwrap();
        assert_eq!(found.route, route);
        (found, set.save())
    };
    let ([columns, products], saved) = {
        let (a, saved) = by(Route::Columns);
        ([a, by(Route::Products).0], saved)
    };
    assert_eq!(columns.active, products.active);
    assert!(columns.pressure.iter().zip(&products.pressure).all(|(a, b)| (a - b).abs() < 1e-10));
    let mut again = ActiveSet::restored(saved);
    let found = solve(&mut again, &system, &rows, Softness::default(), &[], &load).unwrap();
    assert_eq!((found.iterations, &found.active), (1, &columns.active));
    assert!(columns.iterations > 1);
}

/// A body of two unknowns that only a spring at the first holds until contact does.
#[test]
fn springs_carry_nothing_where_contact_holds_and_free_bodies_are_named() {
    let stiffness = DMatrix::from_row_slice(2, 2, &[1.0 + 5.0, -1.0, -1.0, 1.0]);
    let system = Known(stiffness.try_inverse().unwrap());
    let springs = [Spring { unknown: 0, stiffness: 5.0 }];
    let rows = [floor(1, 0.2)];
    let solve = |load: [f64; 2]| solve(&mut ActiveSet::default(), &system, &rows, Softness::default(), &springs, &load);
    let held = solve([-2.0, -1.0]).unwrap();
    // All of the load on the floor, and the elastic part between the two unknowns under 2.
    assert!((held.pressure[0] - 3.0).abs() < 1e-12, "{}", held.pressure[0]);
    assert!((held.u[1] + 0.2).abs() < 1e-12 && (held.u[0] + 2.2).abs() < 1e-12, "{:?}", held.u);
    assert!(matches!(solve([2.0, 1.0]), Err(ActiveSetError::Free { .. })));
}
