//! Of `run::mechanics::recovered`.

use signorini::testing::recover;
use signorini_contact::Status;
use signorini_geometry::{Point, Vector};
use signorini_mechanics::SiteResult;

#[test]
fn alternating_shares_are_evened_out() {
    let site = |k: usize| SiteResult {
        x: Point::<3>::new(0.1 * k as f64, 0.0, 0.0),
        normal: Vector::<3>::y(),
        weight: 0.1,
        pressure: 2.0 + if k.is_multiple_of(2) { 1.5 } else { -1.5 },
        status: Status::Slip,
        ..SiteResult::default()
    };
    let mut sites: Vec<SiteResult> = (0..9).map(site).collect();
    recover(&mut sites);
    let told: Vec<f64> = sites[1..8].iter().map(SiteResult::shown_pressure).collect();
    assert!(told.iter().all(|p| (p - 2.0).abs() < 1e-12), "{told:?}");
    // Forces stay what they are.
    assert!((sites[0].force().y - 0.35).abs() < 1e-12);
}
