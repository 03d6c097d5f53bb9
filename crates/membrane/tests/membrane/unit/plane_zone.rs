//! Of `plane_zone`.

use signorini_fem::Grid;
use signorini_geometry::{Aabb, ClosedCurve, Point};
use signorini_membrane::method::ModeSpace;
use signorini_membrane::obstacle::Side;
use signorini_membrane::plane_zone::PlaneZone;
use signorini_membrane::sizing::Sizing;
use signorini_membrane::testing::{swept, wanted_knots, without_waves};
use signorini_membrane::zone::{Zone, ZoneFronts, ZoneMotion, ZoneSizes};
use std::sync::Arc;

/// Else it would go up and down with the length of the front, and the front with it.
#[test]
fn the_number_of_modes_stays_while_it_will_do() {
    let bounds = Aabb::new(Point::<2>::new(-1.0, -1.0), Point::<2>::new(1.0, 1.0));
    let grid = Grid::new(bounds, [40, 40], 1);
    let h = grid.h();
    let circle: Vec<Point<2>> = (0..48)
        .map(|i| std::f64::consts::TAU * f64::from(i) / 48.0)
        .map(|a| 0.5 * Point::<2>::new(a.cos(), a.sin()))
        .collect();
    let places = circle.iter().map(|x| (*x, std::f64::consts::PI / 48.0, h));
    let sizing = Arc::new(Sizing::new(places));
    let zone = PlaneZone::new(&grid, vec![(Side::Below, ClosedCurve::through(&circle, 7))]);
    let zone = zone.on_sizes(&grid, &sizing);
    let count = |zone: &PlaneZone| zone.mode_offsets(ModeSpace::Fine)[1];
    let moved = |by: f64| {
        let step = vec![by; count(&zone)];
        zone.advanced(&grid, ModeSpace::Fine, &step, 1.0).zone
    };
    let wanted = |zone: &PlaneZone| wanted_knots(&grid, zone);
    let modes = count(&zone);
    // Steps after which a front does not keep its parameter, and that would have it get one mode more or less.
    for (direction, other) in [(1.0, modes + 1), (-1.0, modes - 1)] {
        let steps = (1..40).map(|k| moved(0.05 * direction * f64::from(k) * h));
        let longer = steps.into_iter().find(|zone| wanted(zone) == other).expect("a mode more or less");
        assert_eq!(count(&longer), modes);
    }
    // A front that has become much longer gets what it wants.
    let far = moved(0.25);
    assert_eq!(count(&far), wanted(&far));
}

/// A circle with a wave on it.
fn waved(grid: &Grid<2>, radius: f64, waves: usize, height: f64) -> PlaneZone {
    let points: Vec<Point<2>> = (0..40 * waves)
        .map(|i| std::f64::consts::TAU * i as f64 / (40 * waves) as f64)
        .map(|a| (radius + height * (waves as f64 * a).cos()) * Point::<2>::new(a.cos(), a.sin()))
        .collect();
    PlaneZone::new(grid, vec![(Side::Below, ClosedCurve::through(&points, 7))]).on_grid(grid)
}

fn square(degree: usize) -> Grid<2> {
    Grid::new(Aabb::new(Point::<2>::new(-1.0, -1.0), Point::<2>::new(1.0, 1.0)), [40, 40], degree)
}

#[test]
fn fronts_go_on_the_way_that_they_went() {
    for (degree, part) in [(1, 0.06), (2, 0.03)] {
        let grid = square(degree);
        let [before, now, next] = [0.52, 0.5, 0.48].map(|radius| waved(&grid, radius, 4, 0.1 * (1.0 - radius)));
        let ahead = now.extrapolated(&grid, &[(&before, 1.0)]).expect("two fronts that are alike");
        let far = ahead.farthest_from(&next, &|_| 1.0).expect("as many fronts");
        let gone = now.farthest_from(&next, &|_| 1.0).expect("as many fronts");
        assert!((gone - 0.022).abs() < 1e-3 && far < part * gone, "degree {degree}: {far} after {gone}");
        assert!(now.farthest_from(&PlaneZone::empty(&grid), &|_| 1.0).is_none());
    }
}

/// What cells of degree 1 leave on a front differs from state to state, and would be there threefold.
#[test]
fn waves_as_short_as_cells_do_not_grow() {
    let more = |degree: usize| {
        let (grid, height, waves) = (square(degree), 1e-3, 8);
        let [before, now] = [(0.52, -height), (0.5, height)].map(|(r, height)| waved(&grid, r, waves, height));
        let ahead = now.extrapolated(&grid, &[(&before, 1.0)]).expect("two fronts that are alike");
        ahead.farthest_from(&waved(&grid, 0.48, waves, height), &|_| 1.0).expect("as many fronts") / height
    };
    assert!(more(1) < 1.3 && more(2) > 1.7, "{} {}", more(1), more(2));
    let wave = |length: usize| move |k: usize| (std::f64::consts::TAU * k as f64 / length as f64).cos();
    let values: Vec<f64> = (0..240).map(|k| 2.0 + wave(12)(k) + wave(24)(k)).collect();
    for (k, value) in without_waves(&values, 12).iter().enumerate() {
        assert!((value - 2.0 - 0.5 * wave(24)(k)).abs() < 1e-14);
    }
}

#[test]
fn tips_sweep_what_straight_fronts_do() {
    for (step, curvature) in [(0.1, 3.0), (2.0, 5.0), (-0.2, -40.0)] {
        let w = swept(step, curvature);
        assert!((w * (1.0 + 0.5 * curvature * w) - step).abs() < 1e-14 * step.abs().max(1.0), "{w}");
    }
    // Towards the centre of curvature, and on straight fronts, nothing changes.
    assert_eq!([swept(-0.1, 3.0), swept(0.1, -3.0), swept(0.3, 0.0)], [-0.1, 0.1, 0.3]);
}
