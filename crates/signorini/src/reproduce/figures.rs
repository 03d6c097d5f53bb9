//! What each figure shows and how it is computed.

use super::newton::membrane;
use super::plot::{Plot, Series};
use super::{Figure, Page, problem, solved};
use crate::plan::{Plan, plan};
use serde_json::Value;
use signorini_geometry::Point;
use signorini_membrane::kernel::solve_line;
use signorini_membrane::published::stages::{Stage, stages};
use signorini_solve::Silent;
use signorini_verify::order::fitted;
use std::path::Path;
use std::time::Instant;

/// The figures and the table, in the order of the publication.
pub const FIGURES: [Figure; 7] = [
    Figure {
        name: "axisymmetric",
        about: "a round membrane by its radius, with and without adhesion",
        make: axisymmetric,
    },
    Figure { name: "front_error", about: "error of the front and solves against mesh size", make: front_error },
    Figure { name: "front_evolution", about: "the front on its way from radius 0.77", make: front_evolution },
    Figure { name: "modes", about: "what each mode of the front has to do, on two meshes", make: modes },
    Figure { name: "convergence", about: "convergence, with its plateau and without", make: convergence },
    Figure { name: "cosine", about: "the cosine floor, up and down", make: cosine },
    Figure { name: "time", about: "time per solve, in total, and for a given error of the front", make: time },
];

/// Radius of contact at load 1 and depth 0.1, tension and radius 1.
const RADIUS: f64 = 0.502_474_357_083_085;
const METHOD: &str = "contacts.touch.method.inequality_level_set";
const CELLS: &str = "bodies.film.membrane.mesh.grid.cells";
const DEGREE: &str = "bodies.film.membrane.degree";

/// The methods that are compared: name, and the overrides that choose it.
fn methods() -> [(&'static str, Vec<String>); 4] {
    let level_set = |formulation: &str, degree: usize| {
        vec![format!("{METHOD}.formulation=\"{formulation}\""), format!("{DEGREE}={degree}")]
    };
    [
        ("published", level_set("published", 1)),
        ("one-sided, degree 1", level_set("one_sided", 1)),
        ("one-sided, degree 2", level_set("one_sided", 2)),
        ("active set", vec![format!("{DEGREE}=1"), "contacts.touch.method={active_set={}}".into()]),
    ]
}

/// The last step of a run and its contact.
fn last(summary: &Value) -> (&Value, &Value) {
    let step = summary["steps"].as_array().and_then(|s| s.last()).unwrap_or(&Value::Null);
    (step, &step["contacts"]["touch"])
}

fn figure(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

/// The radius of a disc of the area of contact.
fn radius(contact: &Value) -> f64 {
    (figure(&contact["area"]) / std::f64::consts::PI).sqrt()
}

fn line(name: impl Into<String>, points: Vec<(f64, f64)>) -> Series {
    Series { name: name.into(), points, marked: false }
}

fn marked(name: impl Into<String>, points: Vec<(f64, f64)>) -> Series {
    Series { name: name.into(), points, marked: true }
}

/// The radius at which adhesion holds the front, by halving: the slope jump of the closed solution grows with the radius.
fn exact_radius(energy: f64) -> f64 {
    let lacking = |r: f64| 0.25 * (1.0 - r * r) - 0.1 - (r * (2.0 * energy).sqrt() - 0.5 * r * r) * r.ln();
    let (mut low, mut high) = (0.4, 1.0 - 1e-9);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if (lacking(middle) > 0.0) == (lacking(low) > 0.0) { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

fn axisymmetric(_: &Path) -> Result<Page, String> {
    let mut page = Page::default();
    let mut plot = Plot {
        title: "Deflection under load 1 over a floor at -0.1".into(),
        x_name: "radius",
        y_name: "deflection",
        log: [false; 2],
        square: false,
        series: Vec::new(),
    };
    let mut rows = Vec::new();
    for energy in [0.0, 0.001, 0.01, 0.05, 0.1] {
        let set = [
            format!("{METHOD}.formulation=\"published\""),
            format!("{CELLS}=[20]"),
            format!("{DEGREE}=4"),
            format!("contacts.touch.adhesion.energy={energy:?}"),
        ];
        let problem = problem("axisymmetric", &set)?;
        let Plan::Line(plan) = plan(&problem).map_err(|e| e.one_line())? else {
            return Err("a membrane along its radius is wanted".into());
        };
        let membrane = plan.at(0.0);
        let found = solve_line(&membrane, &mut Silent);
        let Some(state) = found.equilibrium.filter(|_| found.reason.converged()) else {
            return Err(format!("no state was found for an energy of {energy}"));
        };
        let front = state.quadrature.front.first().map_or(f64::NAN, |p| p.x[0]);
        let exact = exact_radius(energy);
        rows.push(vec![
            format!("{energy}"),
            format!("{front:.10}"),
            format!("{exact:.10}"),
            format!("{:.1e}", (front - exact).abs()),
            found.iterations.to_string(),
        ]);
        let at = |i: i32| {
            let r = f64::from(i) / 200.0;
            state.displacement(&found.zone, &Point::<1>::new(r)).map(|u| (r, u))
        };
        plot.series.push(line(format!("adhesion {energy}"), (0..=200).filter_map(at).collect()));
    }
    page.plot("axisymmetric", plot);
    page.table(&["adhesion", "radius", "closed form", "error", "solves"], &rows);
    page.paragraph(
        "The published formulation with 20 cells of degree 4. The publication shows the solution with linear elements; the radii of the \
         closed form are the same.",
    );
    Ok(page)
}

fn front_error(scratch: &Path) -> Result<Page, String> {
    let mut page = Page::default();
    for (case, name, title, sizes) in [
        ("axisymmetric", "front_error_1d", "By the radius", &[10usize, 20, 40, 80, 160, 320][..]),
        ("flat_disc", "front_error_2d", "In the plane", &[20, 40, 80, 160][..]),
    ] {
        let mut plot = Plot {
            title: title.into(),
            x_name: "cells along the side",
            y_name: "error of the radius",
            log: [true; 2],
            square: false,
            series: Vec::new(),
        };
        let mut rows = Vec::new();
        for (method, set) in methods() {
            let mut points = Vec::new();
            let mut row = vec![method.to_string()];
            for &n in sizes {
                let cells = if case == "flat_disc" { format!("{CELLS}=[{n},{n}]") } else { format!("{CELLS}=[{n}]") };
                let summary = solved(scratch, case, &[set.clone(), vec![cells]].concat())?;
                let (step, contact) = last(&summary);
                let error = (radius(contact) - RADIUS).abs();
                points.push((n as f64, error));
                row.push(format!("{error:.1e} ({})", step["iterations"]));
            }
            let (h, errors): (Vec<f64>, Vec<f64>) = points.iter().map(|(n, e)| (1.0 / n, e.max(1e-16))).unzip();
            row.push(format!("{:.1}", fitted(&h, &errors)));
            rows.push(row);
            plot.series.push(marked(method, points));
        }
        page.plot(name, plot);
        let sizes: Vec<String> = sizes.iter().map(|n| n.to_string()).collect();
        let head: Vec<&str> = ["method"].into_iter().chain(sizes.iter().map(String::as_str)).chain(["order"]).collect();
        page.table(&head, &rows);
    }
    page.paragraph(
        "Error of the radius of contact, of the area of contact as a disc, and in brackets the solves. As in the publication the level set \
         has a front of second order with linear elements, and the active set one of first order that goes on by jumps, since its \
         front is made of nodes. Its solves are those of the finest grid of a nested iteration. The second degree of the one-sided \
         formulation, not in the publication, has order four.",
    );
    Ok(page)
}

fn disc(cells: usize, set: &[&str]) -> Result<Vec<String>, String> {
    let mut all = vec![
        format!("{METHOD}.formulation=\"published\""),
        format!("{CELLS}=[{cells},{cells}]"),
        format!("{DEGREE}=1"),
    ];
    all.extend(set.iter().map(|s| s.to_string()));
    Ok(all)
}

fn front_evolution(_: &Path) -> Result<Page, String> {
    let membrane = membrane(&problem("flat_disc", &disc(40, &[])?)?)?;
    let stages = stages(&membrane, 7, false).map_err(|e| e.to_string())?;
    let mut page = Page::default();
    let series = stages.iter().enumerate().map(|(i, s)| {
        let points = s.outline.iter().map(|[x, y]| (*x, *y)).collect();
        line(if i < 5 { format!("after {i} steps") } else { String::new() }, points)
    });
    page.plot(
        "front_evolution",
        Plot {
            title: "Fronts on 40 × 40 linear cells".into(),
            x_name: "x",
            y_name: "y",
            log: [false; 2],
            square: true,
            series: series.collect(),
        },
    );
    let rows: Vec<Vec<String>> = stages
        .iter()
        .enumerate()
        .map(|(i, s)| {
            vec![
                i.to_string(),
                format!("{:.6}", s.radius),
                format!("{:.1e}", (s.radius - RADIUS).abs()),
                format!("{:.1e}", s.slope_jump),
            ]
        })
        .collect();
    page.table(&["step", "mean radius", "off the closed form", "norm of the slope jump"], &rows);
    page.paragraph(
        "From the zone that the free membrane penetrates, of radius 0.7746, each step cut at 0.15 of the extent of the membrane. The \
         publication takes a limiter of its own, so the first steps differ. What is left in the end is the error of the mesh, and the slope jump that its modes do not see.",
    );
    Ok(page)
}

fn modes(_: &Path) -> Result<Page, String> {
    let mut page = Page::default();
    let implicit = |min: &str, max: &str| {
        format!("bodies.film.membrane.domain={{implicit={{negative_inside=\"x^2+y^2-1\",min={min},max={max}}}}}")
    };
    let mut series = Vec::new();
    let mut rows = Vec::new();
    for (name, bounds) in [
        ("symmetric mesh", implicit("[-1.03,-1.03]", "[1.03,1.03]")),
        ("unsymmetric mesh", implicit("[-1.11,-1.05]", "[1.03,1.09]")),
    ] {
        let membrane = membrane(&problem("flat_disc", &disc(40, &[&bounds])?)?)?;
        let stages = stages(&membrane, 8, true).map_err(|e| e.to_string())?;
        let waves: &[f64] = stages.last().map_or(&[], |s: &Stage| &s.waves);
        series.push(marked(name, waves.iter().enumerate().map(|(k, v)| (k as f64, v.max(1e-17))).collect()));
        let mut row = vec![name.to_string()];
        row.extend(waves.iter().map(|v| format!("{v:.0e}")));
        rows.push(row);
    }
    page.plot(
        "modes",
        Plot {
            title: "Slope jump left in each wave number, with the front at rest in its mean".into(),
            x_name: "wave number along the front",
            y_name: "amplitude of the slope jump",
            log: [false, true],
            square: false,
            series,
        },
    );
    let count = rows.iter().map(Vec::len).max().unwrap_or(1);
    let names: Vec<String> = (0..count.saturating_sub(1)).map(|k| k.to_string()).collect();
    let head: Vec<&str> = ["mesh"].into_iter().chain(names.iter().map(String::as_str)).collect();
    page.table(&head, &rows);
    page.paragraph(
        "The front is moved in its mean alone until that is at rest; what is left belongs to the mesh, since the exact front is a circle. On \
         a mesh with the symmetry of a square hardly anything but the fourth wave number has to do, and what the knots of the front, \
         whose number is odd, make of it; on one without symmetry all wave numbers have, but no more. So a few modes suffice on either, \
         which is what the publication draws from its figure.",
    );
    Ok(page)
}

fn convergence(scratch: &Path) -> Result<Page, String> {
    let mut page = Page::default();
    let mut series = Vec::new();
    let mut rows = Vec::new();
    for (transport, name) in
        [("exact", "as curves"), ("redistancing", "re-distanced on nodes"), ("hamilton_jacobi", "Hamilton and Jacobi")]
    {
        for n in [40, 80] {
            let key = format!("{METHOD}.transport=\"{transport}\"");
            let summary = solved(scratch, "flat_disc", &disc(n, &[&key])?)?;
            let (step, contact) = last(&summary);
            let history: Vec<f64> = step["residual_history"]
                .as_array()
                .map(|r| r.iter().map(figure).filter(|r| *r > 0.0).collect())
                .unwrap_or_default();
            let points = history.iter().enumerate().map(|(i, r)| (i as f64, *r)).collect();
            series.push(marked(format!("{name}, {n} × {n}"), points));
            rows.push(vec![
                name.to_string(),
                format!("{n} × {n}"),
                history.len().to_string(),
                format!("{:.1e}", history.last().unwrap_or(&f64::NAN)),
                format!("{:.1e}", (radius(contact) - RADIUS).abs()),
            ]);
        }
    }
    page.plot(
        "convergence",
        Plot {
            title: "Residual of the fronts".into(),
            x_name: "step",
            y_name: "slope jump in the modes, over its tolerance",
            log: [false, true],
            square: false,
            series,
        },
    );
    page.table(&["transport", "cells", "steps", "last residual", "error of the radius"], &rows);
    page.paragraph(
        "The publication moves the level set on the nodes of the mesh, and its residual comes to rest on a plateau: what is linear between \
         nodes shifts the front by a part of h² in every step, and the next step takes that back. With fronts that are curves nothing \
         shifts them, and the plateau is gone.",
    );
    Ok(page)
}

fn cosine(scratch: &Path) -> Result<Page, String> {
    let mut page = Page::default();
    let mut series = Vec::new();
    let mut rows = Vec::new();
    for (name, formulation, degree) in [("published", "published", 1), ("one-sided, degree 2", "one_sided", 2)] {
        let set = [
            format!("{METHOD}.formulation=\"{formulation}\""),
            format!("{DEGREE}={degree}"),
            format!("{CELLS}=[40,40]"),
            "loads.press.normal=\"-min(t,0.8-t)\"".into(),
            "steps=[{to=0.1},{to=0.7,increments=6}]".into(),
        ];
        let summary = solved(scratch, "cosine_disc", &set)?;
        let steps: Vec<&Value> = summary["steps"].as_array().map(|s| s.iter().collect()).unwrap_or_default();
        let area = |step: &Value| figure(&step["contacts"]["touch"]["area"]);
        let load = |step: &Value| figure(&step["time"]).min(0.8 - figure(&step["time"]));
        let (up, down) = steps.split_at(steps.len().div_ceil(2));
        let all = |part: &[&Value]| part.iter().map(|s| (load(s), area(s))).collect::<Vec<_>>();
        series.push(marked(format!("{name}, up"), all(up)));
        series.push(marked(format!("{name}, down"), all(down)));
        for step in up {
            let back = down.iter().find(|s| (load(s) - load(step)).abs() < 1e-9);
            let contact = &step["contacts"]["touch"];
            rows.push(vec![
                name.into(),
                format!("{:.1}", load(step)),
                contact["zones"].to_string(),
                contact["holes"].to_string(),
                format!("{:.6}", area(step)),
                back.map_or("–".into(), |s| format!("{:.0e}", (area(s) - area(step)).abs())),
                step["iterations"].to_string(),
            ]);
        }
    }
    page.plot(
        "cosine",
        Plot {
            title: "Area of contact on the cosine floor".into(),
            x_name: "load",
            y_name: "area of contact",
            log: [false; 2],
            square: false,
            series,
        },
    );
    page.table(&["formulation", "load", "zones", "holes", "area", "up against down", "solves"], &rows);
    page.paragraph(
        "The publication does not print the domain; this is the disc of radius 1, on which the history is the one it describes: four zones, a \
         ring, and the hole that closes at 0.3948. It admits small differences between the way up and the way down. So does its \
         formulation here, of the size of its error; those of the other formulation are as small as its own.",
    );
    Ok(page)
}

fn time(scratch: &Path) -> Result<Page, String> {
    let mut page = Page::default();
    let sizes = [40usize, 80, 160];
    let mut rows = Vec::new();
    let mut to_error = Vec::new();
    for (method, set) in methods() {
        let mut row = vec![method.to_string()];
        let mut reached: [Option<f64>; 2] = [None; 2];
        for n in sizes {
            let cells = format!("{CELLS}=[{n},{n}]");
            let begin = Instant::now();
            let summary = solved(scratch, "flat_disc", &[set.clone(), vec![cells]].concat())?;
            let seconds = begin.elapsed().as_secs_f64();
            let (step, contact) = last(&summary);
            let error = (radius(contact) - RADIUS).abs();
            let solves = figure(&step["iterations"]).max(1.0);
            row.push(format!("{seconds:.2} s, {:.0} ms each, {error:.0e}", 1e3 * seconds / solves));
            for (reached, bound) in reached.iter_mut().zip([1e-3, 1e-4]) {
                if error <= bound {
                    *reached = Some(reached.map_or(seconds, |s| s.min(seconds)));
                }
            }
        }
        rows.push(row);
        let said = reached.map(|s| s.map_or("not on these meshes".into(), |s| format!("{s:.2} s")));
        to_error.push([vec![method.to_string()], said.to_vec()].concat());
    }
    page.table(&["method", "40 × 40", "80 × 80", "160 × 160"], &rows);
    page.paragraph("Seconds of whole runs on this machine, checks, error estimate and files included; of one solve; error of the radius.");
    page.table(&["method", "to 1e-3", "to 1e-4"], &to_error);
    page.paragraph(
        "As in the publication a solve of the level set costs more than one of the active set on the same mesh, and less to a given error of \
         the front.",
    );
    Ok(page)
}
