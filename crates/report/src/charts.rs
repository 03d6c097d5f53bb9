//! Histories and residuals as charts of the page.

use crate::folder::{Results, Told};
use crate::naming::sentence;
use serde::Serialize;
use signorini::report::headed;
use std::collections::BTreeMap;

/// A chart: some series over one axis.
#[derive(Clone, Debug, Serialize)]
pub struct Chart {
    pub title: String,
    pub x_label: String,
    pub x: Vec<f64>,
    pub series: Vec<Series>,
    /// Whether the values are shown by their powers of ten.
    pub log: bool,
    /// A value that is told apart by a line across.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limit: Option<f64>,
}

/// Values over the axis; none where there is nothing.
#[derive(Clone, Debug, Serialize)]
pub struct Series {
    pub label: String,
    pub values: Vec<Option<f64>>,
}

/// Keys of `history.csv` that are shown, in this order, with their titles.
const SHOWN: [(&str, &str); 12] = [
    ("force", "Force"),
    ("area", "Contact area"),
    ("max_pressure", "Largest contact pressure"),
    ("radius", "Radius of the contact"),
    ("zones", "Contact zones"),
    ("displacement", "Displacement"),
    ("rotation", "Rotation"),
    ("moment", "Moment"),
    ("mean_stress", "Mean stress"),
    ("mean_strain", "Mean strain"),
    ("force_bounds", "Bounds of the normal force"),
    ("energy", "Energy"),
];
/// More lines than this are not told apart.
const LINES: usize = 8;
/// What is smaller than this part of the other components of a vector is rounding.
const ROUNDING: f64 = 1e-9;
/// More points than this are not seen on a chart.
const POINTS: usize = 2000;

/// The histories of a folder, of bodies of a size.
pub fn histories(results: &Results, size: f64) -> Vec<Chart> {
    let mut charts =
        results.text("history.csv").map_or_else(Vec::new, |text| of_history(&text, size, results.is_flat()));
    charts.extend(of_paths(results));
    charts.extend(results.text("fit.csv").and_then(|text| of_fit(&text)));
    charts.extend(results.text("pairs.csv").and_then(|text| of_pairs(&text)));
    charts
}

/// The heading and the columns of a table.
fn columns(text: &str) -> Option<(Vec<String>, Vec<Vec<Option<f64>>>)> {
    let mut reader = csv::ReaderBuilder::new().flexible(true).from_reader(text.as_bytes());
    let head: Vec<String> = reader.headers().ok()?.iter().map(String::from).collect();
    let mut columns = vec![Vec::new(); head.len()];
    for row in reader.records().filter_map(Result::ok) {
        for (k, column) in columns.iter_mut().enumerate() {
            let value = row.get(k).and_then(|v| v.parse::<f64>().ok()).filter(|v| v.is_finite());
            column.push(value);
        }
    }
    Some((head, columns))
}

fn of_history(text: &str, length: f64, is_flat: bool) -> Vec<Chart> {
    let Some((head, columns)) = columns(text) else { return Vec::new() };
    let Some(time) = head.iter().position(|h| h == "time") else { return Vec::new() };
    let x: Vec<f64> = columns[time].iter().map(|v| v.unwrap_or(f64::NAN)).collect();
    if x.len() < 2 || x.iter().any(|v| !v.is_finite()) {
        return Vec::new();
    }
    // By their title and unit, lines of vectors and of numbers.
    let mut groups: BTreeMap<(usize, String), Vec<Series>> = BTreeMap::new();
    for (heading, values) in head.iter().zip(&columns) {
        let (key, unit) = heading.strip_suffix(']').and_then(|h| h.split_once(" [")).unwrap_or((heading, ""));
        let (name, key) = key.rsplit_once(':').unwrap_or(("", key));
        let Some(order) = SHOWN.iter().position(|(shown, _)| is_of(key, shown)) else { continue };
        let component = key.strip_prefix(SHOWN[order].0).unwrap_or_default().replace('_', " ");
        let label = format!("{name}{component}").trim().to_string();
        let label = if label.is_empty() { SHOWN[order].1.to_string() } else { label };
        groups.entry((order, unit.to_string())).or_default().push(Series { label, values: values.clone() });
    }
    let size = |s: &Series| s.values.iter().flatten().fold(0.0f64, |m, v| m.max(v.abs()));
    let forces = groups.iter().filter(|((order, _), _)| SHOWN[*order].0 == "force").flat_map(|g| g.1);
    let largest_force = forces.map(size).fold(0.0, f64::max);
    let chart = |((order, unit), mut series): ((usize, String), Vec<Series>)| {
        let most = series.iter().map(size).fold(0.0, f64::max);
        if SHOWN[order].0 == "moment" && most <= ROUNDING * largest_force * length {
            return None;
        }
        series.retain(|s| size(s) > ROUNDING * most);
        series.sort_by(|a, b| size(b).total_cmp(&size(a)));
        series.truncate(LINES);
        series.sort_by(|a, b| a.label.cmp(&b.label));
        let is_constant = |s: &Series| s.values.windows(2).all(|w| w[0] == w[1]);
        if series.iter().all(is_constant) {
            return None;
        }
        let title = if is_flat && SHOWN[order].0 == "area" { "Contact length" } else { SHOWN[order].1 };
        let title = headed(title, &unit);
        Some(Chart { title, x_label: "t".into(), x: x.clone(), series, log: false, limit: None })
    };
    groups.into_iter().filter_map(chart).collect()
}

/// Whether a key is one of these, or a component of one.
fn is_of(key: &str, shown: &str) -> bool {
    let Some(rest) = key.strip_prefix(shown) else { return false };
    matches!(rest, "" | "_x" | "_y" | "_z" | "_xx" | "_yy" | "_zz" | "_least" | "_largest")
}

fn of_paths(results: &Results) -> Vec<Chart> {
    let Some(summary) = results.summary() else { return Vec::new() };
    let paths = &summary.of_paths.paths;
    let Some(first) = paths.first().filter(|p| p.frames.len() > 1) else { return Vec::new() };
    let x: Vec<f64> = first.frames.iter().map(|f| f.time).collect();
    let unit = |of: fn(&signorini::report::UnitNames) -> &String| summary.units.as_ref().map_or("", |u| of(u));
    let same = || paths.iter().filter(|p| p.frames.len() == x.len());
    let lengths =
        same().map(|p| Series { label: p.name.clone(), values: p.frames.iter().map(|f| Some(f.length)).collect() });
    let mut arms = Vec::new();
    for path in same() {
        let bodies = path.frames.iter().flat_map(|f| f.moment_arms.keys()).collect::<std::collections::BTreeSet<_>>();
        for body in bodies {
            for (k, axis) in ["x", "y", "z"].iter().enumerate() {
                let values = path.frames.iter().map(|f| Some(f.moment_arms.get(body)?.turn[k])).collect();
                arms.push(Series { label: format!("{} on {body} {axis}", path.name), values });
            }
        }
    }
    let size = |s: &Series| s.values.iter().flatten().fold(0.0f64, |m, v| m.max(v.abs()));
    let most = arms.iter().map(size).fold(0.0, f64::max);
    arms.retain(|s| size(s) > 1e-6 * most);
    arms.truncate(LINES);
    let chart = |title: &str, series: Vec<Series>| {
        let title = headed(title, unit(|u| &u.length));
        (!series.is_empty()).then(|| Chart {
            title,
            x_label: "t".into(),
            x: x.clone(),
            series,
            log: false,
            limit: None,
        })
    };
    [chart("Length", lengths.collect()), chart("Moment arm", arms)].into_iter().flatten().collect()
}

fn of_fit(text: &str) -> Option<Chart> {
    let (head, columns) = columns(text)?;
    let of = |name: &str| head.iter().position(|h| h == name).map(|k| columns[k].clone());
    let x: Vec<f64> = of("time")?.into_iter().collect::<Option<_>>()?;
    let mut order: Vec<usize> = (0..x.len()).collect();
    order.sort_by(|&a, &b| x[a].total_cmp(&x[b]));
    let series = ["measured", "fitted"].into_iter().filter_map(|name| {
        let values = of(name)?;
        Some(Series { label: name.into(), values: order.iter().map(|&k| values[k]).collect() })
    });
    let x = order.iter().map(|&k| x[k]).collect();
    let title = "Measured and fitted contact radius".into();
    Some(Chart { title, x_label: "load".into(), x, series: series.collect(), log: false, limit: None })
}

/// The gap of the closest pair of a scene.
fn of_pairs(text: &str) -> Option<Chart> {
    let (head, columns) = columns(text)?;
    let of = |name: &str| head.iter().position(|h| h == name).map(|k| &columns[k]);
    let (time, gap, contact) = (of("time")?, of("gap")?, of("contact")?);
    let rows = (0..time.len()).filter(|&k| contact[k] == Some(1.0));
    let (x, values): (Vec<f64>, Vec<Option<f64>>) = rows.filter_map(|k| Some((time[k]?, gap[k]))).unzip();
    let series = vec![Series { label: "closest pair".into(), values }];
    let title = "Gap".into();
    (x.len() > 1).then(|| Chart { title, x_label: "t".into(), x, series, log: false, limit: None })
}

/// Residuals of all iterations, relative to the tolerance, one after another.
pub fn residuals(results: &Results) -> Option<Chart> {
    let mut runs: Vec<Vec<f64>> = results.steps().iter().map(|s| s.residual_history.clone()).collect();
    if runs.iter().all(Vec::is_empty) && !matches!(results.told, Told::Other(_)) {
        // What the log of an unfinished run tells.
        let mut last = None;
        for i in &results.iterations {
            if last != Some(i.step) {
                runs.push(Vec::new());
                last = Some(i.step);
            }
            runs.last_mut()?.push(i.residual);
        }
    }
    let (mut x, mut values): (Vec<f64>, Vec<Option<f64>>) = (Vec::new(), Vec::new());
    for run in runs.iter().filter(|run| !run.is_empty()) {
        if let Some(last) = x.last() {
            // The line is broken between increments.
            x.push(last + 0.5);
            values.push(None);
        }
        for residual in run {
            x.push(x.last().map_or(1.0, |v: &f64| v.floor() + 1.0));
            values.push(Some(*residual).filter(|v| v.is_finite() && *v > 0.0));
        }
    }
    let first = x.len().saturating_sub(POINTS);
    let (x, values) = (x.split_off(first), values.split_off(first));
    if values.iter().flatten().count() < 2 {
        return None;
    }
    let series = vec![Series { label: sentence("residual"), values }];
    let title = "Residual / tolerance".into();
    Some(Chart {
        title,
        x_label: "iteration, all increments one after another".into(),
        x,
        series,
        log: true,
        limit: Some(1.0),
    })
}
