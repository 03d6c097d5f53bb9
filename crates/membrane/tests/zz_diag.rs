#![allow(unused_imports, dead_code)]
// The derivatives of the method against central differences: slope jump and energy, with tension and load that vary.

use signorini_fem::Grid;
use signorini_geometry::{Aabb, ClosedCurve, Ellipse, Jet, Point, Real};
use signorini_membrane::adhesion::Branch;
use signorini_membrane::domain::{Domain, DomainOnCells, ImplicitDomain};
use signorini_membrane::equilibrium::{Elements, Equilibrium};
use signorini_membrane::field::{Constant, Formula, SharedField};
use signorini_membrane::front::Fronts;
use signorini_membrane::ils::{Reason, Rest, Start, solve};
use signorini_membrane::obstacle::{Obstacle, Obstacles, Side};
use signorini_membrane::plane_zone::PlaneZone;
use signorini_membrane::problem::{Measure, Membrane, Support};
use signorini_membrane::scales::Scales;
use signorini_membrane::zone::{ModeSpace, Zone, contact_index, is_free};
use signorini_solve::Silent;
use std::sync::Arc;

const SPACE: ModeSpace = ModeSpace::Fine;

/// A disc over a curved floor, with a tension and a load that vary; or all that upside down.
fn membrane(cells: usize, degree: usize, side: Side) -> Membrane<2> {
    let bounds = Aabb::new(Point::<2>::new(-1.03, -1.03), Point::<2>::new(1.03, 1.03));
    let grid = Grid::new(bounds, [cells, cells], degree);
    let domain: Arc<dyn Domain<2>> =
        Arc::new(ImplicitDomain(Ellipse { center: Point::zeros(), semi_axes: [1.0, 1.0] }));
    let c = |v: f64| Jet::<2>::constant(v);
    let up = c(side.sign());
    let height: SharedField<2> =
        Arc::new(Formula(move |[x, y]: [Jet<2>; 2]| up * (c(-0.1) - c(0.05) * x * x + c(0.03) * y * x - c(0.02) * y)));
    Membrane {
        domain: DomainOnCells::new(domain, &grid),
        cells: Arc::new(grid.clone()),
        grid,
        measure: Measure::Plain,
        tension: Arc::new(Formula(move |[x, y]: [Jet<2>; 2]| c(1.0) + c(0.4) * x + c(0.2) * y * y)),
        load: Arc::new(Formula(move |[x, y]: [Jet<2>; 2]| up * (c(-1.0) - c(0.3) * y + c(0.2) * x * y))),
        obstacles: Obstacles(vec![Obstacle { side, height, adhesion: None }]),
        supports: vec![Some(Support { index: 0, displacement: Arc::new(Constant(0.0)) })],
        support_count: 1,
        modes: Default::default(),
        formulation: Default::default(),
    }
}

/// An off-centre, bent front that is not the solution.
fn zone(membrane: &Membrane<2>) -> PlaneZone {
    zone_of(membrane, 0.45)
}

fn zone_of(membrane: &Membrane<2>, radius: f64) -> PlaneZone {
    let points: Vec<Point<2>> = (0..24)
        .map(|i| {
            let a = std::f64::consts::TAU * f64::from(i) / 24.0;
            let r = radius + 0.05 * (2.0 * a).cos() + 0.02 * (3.0 * a).sin();
            Point::<2>::new(0.07 + r * a.cos(), -0.04 + r * a.sin())
        })
        .collect();
    let side = membrane.obstacles.0[0].side;
    PlaneZone::new(&membrane.grid, vec![(side, ClosedCurve::through(&points, 9))])
}

fn moments(membrane: &Membrane<2>, elements: &mut Elements<2>, zone: &PlaneZone, modes: &PlaneZone) -> Vec<f64> {
    let equilibrium = Equilibrium::solve(membrane, zone, elements).expect("an equilibrium");
    let n = *modes.mode_offsets(SPACE).last().unwrap();
    let mut b = vec![0.0; n];
    for (p, rho) in equilibrium.quadrature.front.iter().zip(equilibrium.slope_jump()) {
        for (i, v) in modes.frame(p.front, &p.x, SPACE).modes {
            b[i] += p.weight * rho * v;
        }
    }
    b
}
#[test]
fn dump() {
    fn co(x: Jet<2>) -> Jet<2> {
        let v = 6.283185307179586 * x.value;
        let (s, c0) = v.sin_cos();
        x.chain(c0, -6.283185307179586 * s, -6.283185307179586f64.powi(2) * c0)
    }
    for degree in [1usize, 2, 3] {
        for cells in [16usize, 32] {
            let mut membrane = membrane(cells, degree, Side::Below);
            let c = |v: f64| Jet::<2>::constant(v);
            membrane.tension = Arc::new(Constant(1.0));
            membrane.load = Arc::new(Constant(-0.22));
            if std::env::var("COS").is_ok() {
                membrane.obstacles.0[0].height =
                    Arc::new(Formula(move |[x, y]: [Jet<2>; 2]| c(-0.015) - c(0.005) * co(x) * co(y)));
            }
            let mut elements = Elements::new(&membrane);
            let s = solve::<2, PlaneZone>(&membrane, &mut elements, Start::Free, Rest::Final, (0, 0.0), &mut Silent);
            println!("{degree} {cells} {:?} {} {:?}", s.reason, s.iterations, s.residuals);
            let zone = s.zone.clone();
            let eq = s.equilibrium.as_ref().unwrap();
            let n = *zone.mode_offsets(SPACE).last().unwrap();
            let mut a = vec![0.0; n * n];
            let mut m = vec![0.0; n * n];
            for p in &eq.quadrature.front {
                let f = zone.frame(p.front, &p.x, SPACE).modes;
                let r = membrane.pressure(p.side, &p.x) / membrane.tension.value(&p.x);
                for (i, v) in &f {
                    for (j, w) in &f {
                        a[i * n + j] += p.weight * r * v * w;
                        m[i * n + j] += p.weight * v * w;
                    }
                }
            }
            let e = 1e-5 * membrane.grid.h();
            let mut jac = vec![0.0; n * n];
            for k in 0..n {
                let mut st = vec![0.0; n];
                st[k] = e;
                let up = moments(&membrane, &mut elements, &zone.displaced(SPACE, &st), &zone);
                st[k] = -e;
                let down = moments(&membrane, &mut elements, &zone.displaced(SPACE, &st), &zone);
                for i in 0..n {
                    jac[i * n + k] = (up[i] - down[i]) / (2.0 * e);
                }
            }
            let rates = signorini_membrane::shape_rate::ShapeRate::new(eq, &elements, &zone, SPACE);
            let mut ex = vec![0.0; n * n];
            for k in 0..n {
                let mut st = vec![0.0; n];
                st[k] = 1.0;
                let col = rates.of_moments(&st).unwrap();
                for i in 0..n {
                    ex[i * n + k] = col[i];
                }
            }
            // One exact Newton step from a disturbed zone.
    let st: Vec<f64> = (0..n).map(|i| 1e-3 * membrane.grid.h() * (1.0 + (0.9 * i as f64).sin())).collect();
    let off = zone.advanced(&membrane.grid, SPACE, &st, 1.0).zone;
    let norm = |v: &[f64]| v.iter().map(|x| x*x).sum::<f64>().sqrt();
    for kind in 0..3 {
        let mut z = off.clone();
        let mut line = String::new();
        for _ in 0..4 {
            let b = moments(&membrane, &mut elements, &z, &z);
            line += &format!(" {:.2e}", norm(&b));
            let e = Equilibrium::solve(&membrane, &z, &mut elements).unwrap();
            let r = signorini_membrane::shape_rate::ShapeRate::new(&e, &elements, &z, SPACE);
            let nn = b.len();
            if nn != n { line += "modes changed"; break; }
            let mut m = vec![0.0; n*n];
            for k in 0..n { let mut st = vec![0.0; n]; st[k] = 1.0; for (i, v) in r.of_moments(&st).unwrap().into_iter().enumerate() { m[i*n+k] = v; } }
            if kind == 2 { m = a.clone(); }
            let d: Vec<f64> = signorini_solve::dense::solve(&m, &b).unwrap().iter().map(|v| -v).collect();
            z = if kind == 1 { z.displaced(SPACE, &d) } else { z.advanced(&membrane.grid, SPACE, &d, 1.0).zone };
            if kind == 1 { let bb = moments(&membrane, &mut elements, &z, &off); line += &format!(" -> {:.2e}", norm(&bb)); break; }
        }
        println!("   kind {kind}: {line}");
    }
    let out = format!("{{\"n\":{n},\"a\":{a:?},\"m\":{m:?},\"j\":{jac:?},\"x\":{ex:?}}}");
            std::fs::write(format!("/tmp/u/jac_{degree}_{cells}.json"), out).unwrap();
        }
    }
}
