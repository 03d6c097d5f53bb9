//! Certified closest points against brute force: dense sampling, then a search that only compares distances.
//!
//! The evaluators and the search are independent of the code under test. Each class runs a few hundred queries here;
//! `SIGNORINI_BRUTE_FORCE=1000` multiplies that.

mod shapes;
mod weights;

use shapes::{CURVES, Random, SURFACES, Sample, curve, surface};
use signorini_geometry::Point;
use signorini_geometry::closest::{Query, Step, Tracker, closest};
use signorini_geometry::shape::Shape;

fn multiplier() -> usize {
    std::env::var("SIGNORINI_BRUTE_FORCE").ok().and_then(|v| v.parse().ok()).unwrap_or(1)
}

/// All parameters of both partners: up to four.
struct Objective<'a> {
    a: &'a Sample,
    b: &'a Sample,
    /// Domain of each parameter that exists, and to which partner and slot it belongs.
    free: Vec<(usize, usize, [f64; 2])>,
}

impl<'a> Objective<'a> {
    fn new(a: &'a Sample, b: &'a Sample) -> Self {
        let mut free = Vec::new();
        for (which, sample) in [a, b].into_iter().enumerate() {
            for k in 0..sample.shape.dimension() {
                free.push((which, k, sample.domain[k]));
            }
        }
        Objective { a, b, free }
    }

    /// Shape parameters from the unit cube; triangles are folded.
    fn parameters(&self, z: &[f64]) -> [[f64; 2]; 2] {
        let mut q = [[0.0; 2]; 2];
        for (value, &(which, k, [low, high])) in z.iter().zip(&self.free) {
            q[which][k] = low + (high - low) * value;
        }
        for (which, sample) in [self.a, self.b].into_iter().enumerate() {
            if sample.triangle && q[which][0] + q[which][1] > 1.0 {
                q[which] = [1.0 - q[which][0], 1.0 - q[which][1]];
            }
        }
        q
    }

    fn distance(&self, z: &[f64]) -> f64 {
        let [p, q] = self.parameters(z);
        ((self.a.at)(p[0], p[1]) - (self.b.at)(q[0], q[1])).norm()
    }

    fn brute_force(&self, per_axis: usize, starts: usize) -> f64 {
        let n = self.free.len();
        let total = per_axis.pow(n as u32);
        let mut samples: Vec<(f64, Vec<f64>)> = (0..total)
            .map(|mut index| {
                let z: Vec<f64> = (0..n)
                    .map(|_| {
                        let i = index % per_axis;
                        index /= per_axis;
                        i as f64 / (per_axis - 1) as f64
                    })
                    .collect();
                (self.distance(&z), z)
            })
            .collect();
        samples.sort_by(|p, q| p.0.total_cmp(&q.0));
        samples.truncate(starts);
        samples.into_iter().map(|(d, z)| self.compass(d, z, 1.0 / per_axis as f64)).fold(f64::INFINITY, f64::min)
    }

    /// Compass search with growing and shrinking steps, along the axes and their diagonals.
    fn compass(&self, mut best: f64, mut z: Vec<f64>, mut step: f64) -> f64 {
        let n = z.len();
        while step > 1e-9 {
            let mut better = false;
            for code in 1..3usize.pow(n as u32) {
                let mut code = code;
                let mut next = z.clone();
                for value in &mut next {
                    let direction = [0.0, 1.0, -1.0][code % 3];
                    code /= 3;
                    *value = (*value + direction * step).clamp(0.0, 1.0);
                }
                let d = self.distance(&next);
                if d < best {
                    (best, z, better) = (d, next, true);
                }
            }
            step *= if better { 1.3 } else { 0.5 };
        }
        best
    }
}

/// Fails where brute force finds anything closer, or the answer is not consistent with itself.
fn check(a: &Sample, b: &Sample, per_axis: usize, starts: usize, label: &str) {
    let answer = closest(&a.shape, &b.shape, &Query::default());
    let size = a.shape.size().max(b.shape.size()).max(1e-3);
    let of =
        |sample: &Sample, p: &[f64]| (sample.at)(p.first().copied().unwrap_or(0.0), p.get(1).copied().unwrap_or(0.0));
    let (xa, xb) = (of(a, answer.closest.a.parameters()), of(b, answer.closest.b.parameters()));
    let context = || format!("{label}: {} against {}: {:?}", a.name, b.name, answer.closest);
    assert!(((xa - xb).norm() - answer.distance()).abs() <= 1e-12 * (size + answer.distance()), "{}", context());
    assert!(answer.certified_to.is_finite(), "{}", context());
    let brute = Objective::new(a, b).brute_force(per_axis, starts);
    assert!(
        answer.distance() <= brute + 1e-12 * (size + brute),
        "brute force finds {brute}, {} closer; {}",
        answer.distance() - brute,
        context()
    );
}

/// A query point: anywhere, near the shape, near a side or corner of its domain, or near a centre of curvature.
fn query_point(random: &mut Random, sample: &Sample) -> Point<3> {
    let pick = |random: &mut Random, k: usize| {
        let [low, high] = sample.domain[k];
        match random.below(4) {
            0 => low,
            1 => high,
            _ => random.between(low, high),
        }
    };
    let (mut u, mut v) = (pick(random, 0), pick(random, 1));
    if sample.triangle && u + v > 1.0 {
        (u, v) = (1.0 - u, 1.0 - v);
    }
    let x = (sample.at)(u, v);
    match random.below(5) {
        0 => random.vector(2.0),
        1 => x + random.vector(1e-3),
        2 => x + random.vector(0.3),
        3 => x,
        _ => {
            // Towards the centre of curvature of the first parameter line, and a little beside it.
            let h = 1e-3 * (sample.domain[0][1] - sample.domain[0][0]);
            let u = u.clamp(sample.domain[0][0] + h, sample.domain[0][1] - h);
            let (before, here, after) = ((sample.at)(u - h, v), (sample.at)(u, v), (sample.at)(u + h, v));
            let tangent = (after - before) / (2.0 * h);
            let bend = (after - here * 2.0 + before) / (h * h);
            let curvature = (bend - tangent * (bend.dot(&tangent) / tangent.norm_squared())) / tangent.norm_squared();
            let squared = curvature.norm_squared();
            if squared > 1e-2 { here + curvature / squared * (1.0 + random.between(-1e-3, 1e-3)) } else { here }
        }
    }
}

fn in_parallel(count: usize, f: impl Fn(usize) + Sync) {
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get());
    std::thread::scope(|scope| {
        for thread in 0..threads {
            let f = &f;
            scope.spawn(move || (thread..count).step_by(threads).for_each(f));
        }
    });
}

#[test]
fn points_and_curves() {
    in_parallel(CURVES * 60 * multiplier(), |k| {
        let mut random = Random(k as u64);
        let sample = curve(&mut random, k % CURVES);
        let p = query_point(&mut random, &sample);
        check(&Sample::point(p), &sample, 400, 6, &format!("point-curve {k}"));
    });
}

#[test]
fn points_and_surfaces() {
    in_parallel(SURFACES * 40 * multiplier(), |k| {
        let mut random = Random(1_000_000_007 + k as u64);
        let sample = surface(&mut random, k % SURFACES);
        let p = query_point(&mut random, &sample);
        check(&Sample::point(p), &sample, 40, 6, &format!("point-surface {k}"));
    });
}

#[test]
fn curves_and_curves() {
    in_parallel(CURVES * CURVES * 2 * multiplier(), |k| {
        let mut random = Random(2_000_000_011 + k as u64);
        let a = curve(&mut random, k % CURVES);
        let b = curve(&mut random, k / CURVES % CURVES);
        check(&a, &b, 60, 8, &format!("curve-curve {k}"));
    });
}

#[test]
fn curves_and_surfaces() {
    in_parallel(CURVES * SURFACES * multiplier(), |k| {
        let mut random = Random(3_000_000_019 + k as u64);
        let a = curve(&mut random, k % CURVES);
        let b = surface(&mut random, k / CURVES % SURFACES);
        check(&a, &b, 16, 8, &format!("curve-surface {k}"));
    });
}

#[test]
fn surfaces_and_surfaces() {
    in_parallel(SURFACES * SURFACES * multiplier(), |k| {
        let mut random = Random(4_000_000_007 + k as u64);
        let a = surface(&mut random, k % SURFACES);
        let b = surface(&mut random, k / SURFACES % SURFACES);
        check(&a, &b, 7, 8, &format!("surface-surface {k}"));
    });
}

/// A point that wanders, followed with certificates, against a search at every step.
#[test]
fn tracked_points_are_those_of_a_search() {
    let steps = std::sync::atomic::AtomicUsize::new(0);
    let warm = std::sync::atomic::AtomicUsize::new(0);
    in_parallel((CURVES + SURFACES) * 3 * multiplier(), |k| {
        let mut random = Random(6_000_000_001 + k as u64);
        let kind = k % (CURVES + SURFACES);
        let sample = if kind < CURVES { curve(&mut random, kind) } else { surface(&mut random, kind - CURVES) };
        let mut tracker = Tracker::new(Query::default());
        let (mut p, mut velocity) = (query_point(&mut random, &sample), random.vector(0.002));
        for step in 0..60 {
            let before = p;
            p += velocity;
            velocity += random.vector(0.0003);
            let moved = (p - before).norm() * (1.0 + 1e-12);
            let (tracked, how) = tracker.closest(&Shape::Point(p), &sample.shape, [moved, 0.0]);
            let searched = closest(&Shape::Point(p), &sample.shape, &Query::default());
            let size = sample.shape.size() + p.norm();
            assert!(
                (tracked.distance() - searched.distance()).abs() <= 1e-13 * size,
                "{k} {}: step {step}",
                sample.name
            );
            if searched.effort > 0 {
                steps.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
                warm.fetch_add(usize::from(how == Step::Warm), std::sync::atomic::Ordering::Relaxed);
            }
        }
    });
    let (steps, warm) = (steps.into_inner(), warm.into_inner());
    assert!(2 * warm > steps, "{warm} warm of {steps}");
}

/// Two curves or surfaces, the second carried along a path.
#[test]
fn tracked_shapes_are_those_of_a_search() {
    in_parallel(60 * multiplier(), |k| {
        let mut random = Random(7_000_000_003 + k as u64);
        let fixed = surface(&mut random, 7 + k % (SURFACES - 7));
        let points: Vec<Point<3>> =
            (0..5).map(|i| Point::<3>::new(0.4 * i as f64 - 0.8, 0.0, 0.9) + random.vector(0.3)).collect();
        let velocity = random.vector(0.004);
        let mut tracker = Tracker::new(Query::default());
        for step in 0..20 {
            let moved: Vec<Point<3>> = points.iter().map(|p| p + velocity * f64::from(step)).collect();
            let curve: Shape = signorini_geometry::shape::Curve::bezier(&moved, None).unwrap().into();
            let motion = velocity.norm() * (1.0 + 1e-12);
            let (tracked, _) = tracker.closest(&curve, &fixed.shape, [motion, 0.0]);
            let searched = closest(&curve, &fixed.shape, &Query::default());
            assert!((tracked.distance() - searched.distance()).abs() <= 1e-12, "{k}: step {step}");
        }
    });
}

#[test]
fn swapping_the_partners_changes_nothing() {
    in_parallel(200, |k| {
        let mut random = Random(5_000_000_029 + k as u64);
        let a = curve(&mut random, k % CURVES).shape;
        let b = if k % 2 == 0 { Shape::Point(random.vector(1.0)) } else { surface(&mut random, k % SURFACES).shape };
        let there = closest(&a, &b, &Query::default());
        let back = closest(&b, &a, &Query::default());
        assert_eq!(there.distance(), back.distance(), "{k}");
        assert_eq!(there.closest.a, back.closest.b, "{k}");
    });
}
