//! Results that are not those of increments: paths, fits, scenes.

use crate::folder::{Results, Told};
use crate::html::{list, section, table};
use crate::naming::sentence;
use serde_json::Value;
use signorini::output::figure::{figure, told};
use signorini::report::Summary;
use signorini::report::headed;

/// Their tables.
pub fn others(results: &Results) -> String {
    let body = match &results.told {
        Told::Run(summary) => paths(summary),
        Told::Other(value) if value.get("adhesion_energy").is_some() => fit(value),
        Told::Other(value) => scene(value),
        Told::Unfinished(_) | Told::Answers(_) => String::new(),
    };
    section("found", "Results", &body)
}

fn paths(summary: &Summary) -> String {
    let length = summary.units.as_ref().map_or("", |u| u.length.as_str());
    let force = summary.units.as_ref().map_or("", |u| u.force.as_str());
    let of = &summary.of_paths;
    let mut out = String::new();
    let rows = of.paths.iter().filter_map(|p| {
        let (first, last) = (p.frames.first()?, p.frames.last()?);
        let bodies: Vec<String> = last.contacts.iter().map(|c| format!("`{}`", c.body)).collect();
        let limits = last.tension_limits.map_or("–".into(), |l| l.map(|v| figure(v, None)).join(" to "));
        Some(vec![
            format!("`{}`", p.name),
            figure(first.length, Some(1e-6)),
            figure(last.length, Some(1e-6)),
            bodies.join(", "),
            limits,
        ])
    });
    let head = [
        "path".into(),
        headed("length at first", length),
        headed("length at the end", length),
        "touches at the end".into(),
        headed("end tension that friction admits", force),
    ];
    out += &table("Shortest paths", &head, &rows.collect::<Vec<_>>());
    let rows = of.winding.iter().map(|w| {
        let stable = if w.stable { "neither slips nor bridges" } else { "slips or bridges" };
        let degrees = |v: f64| figure(v.to_degrees(), None);
        vec![
            format!("`{}`", w.name),
            figure(w.length, None),
            degrees(w.start_angle),
            figure(w.largest_slippage, None),
            stable.into(),
        ]
    });
    let head = [
        "yarn".into(),
        headed("length", length),
        headed("start angle", "°"),
        "largest slippage".into(),
        "state".into(),
    ];
    out += &table("Yarns", &head, &rows.collect::<Vec<_>>());
    let rows = of.ropes.iter().map(|r| {
        let used = r.utilisation.map_or("–".into(), |v| figure(v, None));
        vec![format!("`{}`", r.name), figure(r.length, None), used, r.verdict.clone()]
    });
    let head = ["rope".into(), headed("length", length), "use of friction".into(), "state".into()];
    out + &table("Ropes on given curves", &head, &rows.collect::<Vec<_>>())
}

fn fit(value: &Value) -> String {
    let mut entries = Vec::new();
    for key in ["adhesion_energy", "tension_factor"] {
        let found = &value[key];
        let Some(v) = found["value"].as_f64() else { continue };
        let interval = found["interval"].as_array().map_or(String::new(), |list| {
            let ends: Vec<String> = list.iter().filter_map(Value::as_f64).map(|v| figure(v, None)).collect();
            let confidence =
                value["confidence"].as_f64().map_or(String::new(), |c| format!(" with {:.0} %", 100.0 * c));
            format!(", between {}{confidence}", ends.join(" and "))
        });
        entries.push((sentence(key), told(v, None, "") + &interval));
    }
    for key in ["measurements", "correlation", "scatter"] {
        if let Some(v) = value[key].as_f64() {
            let text = if v.fract() == 0.0 { format!("{v:.0}") } else { figure(v, None) };
            entries.push((sentence(key), text));
        }
    }
    list(&entries)
}

fn scene(value: &Value) -> String {
    let kinds = value["contact_pair_kinds"].as_object().into_iter().flatten();
    let rows: Vec<Vec<String>> = kinds.map(|(kind, count)| vec![kind.clone(), count.to_string()]).collect();
    table("Kinds of the pair that is closest", &["kind".into(), "frames".into()], &rows)
}
