//! A page of its sections, styles and scripts. Nothing in it is loaded from elsewhere.

use crate::charts::{Chart, histories, residuals};
use crate::folder::{Results, Told};
use crate::html::{escaped, json, prose, section};
use crate::scene::{Context, Scene, of_frames, scene};
use crate::sections::pictures::{Picture, pictures};
use crate::sections::{answers, asked, convergence, environment, others, results, verdict, warnings};
use serde::Serialize;
use signorini::report::TractionKind;

const PAGE: &str = include_str!("../assets/page.html");
const STYLE: &str = concat!(include_str!("../assets/libraries/uPlot.min.css"), include_str!("../assets/page.css"));
const SCRIPTS: [&str; 10] = [
    include_str!("../assets/libraries/uPlot.iife.min.js"),
    include_str!("../assets/colours.js"),
    include_str!("../assets/arrays.js"),
    include_str!("../assets/camera.js"),
    include_str!("../assets/renderer.js"),
    include_str!("../assets/normals.js"),
    include_str!("../assets/cut.js"),
    include_str!("../assets/controls.js"),
    include_str!("../assets/viewer.js"),
    include_str!("../assets/charts.js"),
];
const START: &str = include_str!("../assets/page.js");

/// What the scripts read.
#[derive(Serialize)]
struct Data<'a> {
    scene: Option<&'a Scene>,
    histories: &'a [Chart],
    residuals: Option<&'a Chart>,
}

/// What a page is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// A file that stays as it is.
    File,
    /// A server that tells the page when there is something new.
    Served,
}

/// The whole page of a folder.
pub fn page(results: &Results, purpose: Purpose) -> String {
    let context = context(results);
    let scene = match &results.told {
        Told::Answers(list) => of_frames(&[0.0], vec![vec![answers::pairs(list)]], Vec::new(), &context),
        _ => scene(&results.path, &context),
    };
    let (pictures, left) = pictures(results);
    let size = scene.as_ref().map_or(f64::INFINITY, Scene::size);
    let histories = histories(results, size);
    let residuals = residuals(results);
    let data = Data { scene: scene.as_ref(), histories: &histories, residuals: residuals.as_ref() };
    let title = results.title();
    let body = [
        verdict::verdict(results),
        warnings::warnings(results),
        view(scene.as_ref(), &pictures),
        results::results(results),
        others::others(results),
        charts("histories", "Histories", histories.len(), ""),
        charts("convergence", "Convergence", usize::from(residuals.is_some()), &convergence::table_of_steps(results)),
        gallery(&pictures, left),
        asked::whole(results),
        environment::environment(results),
        environment::cite(results),
    ];
    let fill = [
        ("{{title}}", escaped(&title)),
        ("{{style}}", STYLE.to_string()),
        ("{{asked}}", asked::short(results)),
        ("{{body}}", body.concat()),
        ("{{served}}", (purpose == Purpose::Served).to_string()),
        ("{{data}}", json(&data)),
        ("{{scripts}}", SCRIPTS.concat()),
        ("{{start}}", START.to_string()),
    ];
    filled(PAGE, &fill)
}

/// A template with its places filled; what stands in them is not read again.
fn filled(template: &str, fill: &[(&str, String)]) -> String {
    let mut out = String::with_capacity(fill.iter().map(|f| f.1.len()).sum::<usize>() + template.len());
    let mut rest = template;
    while let Some(start) = rest.find("{{") {
        out += &rest[..start];
        rest = &rest[start..];
        match fill.iter().find(|(place, _)| rest.starts_with(place)) {
            Some((place, text)) => {
                out += text;
                rest = &rest[place.len()..];
            }
            None => {
                out += "{{";
                rest = &rest[2..];
            }
        }
    }
    out + rest
}

/// Names of bodies and units, from case and summary.
pub fn context(results: &Results) -> Context<'_> {
    let table: Option<toml::Table> = results.case.as_ref().and_then(|text| text.parse().ok());
    let bodies = table.as_ref().and_then(|t| t.get("bodies")?.as_table());
    let is_rigid = |body: &toml::Value| body.get("rigid").is_some();
    let of_mechanics = bodies.is_some_and(|b| b.values().any(|body| !is_rigid(body) && body.get("parts").is_none()));
    // Files number deformable bodies, or all of them where none deforms, in the order of their names.
    let wanted = |body: &&toml::Value| !of_mechanics || !is_rigid(body);
    let names = bodies.into_iter().flatten().filter(|(_, body)| wanted(body)).map(|(name, _)| name.clone());
    let carries = results.steps().iter().flat_map(|s| s.contacts.values()).next_back();
    Context {
        bodies: names.collect(),
        units: results.summary().and_then(|s| s.units.as_ref()),
        carries: carries.map_or(TractionKind::Pressure, |c| c.carries),
        time: results.closest(),
    }
}

/// The view, and what stands in its place without WebGL.
fn view(scene: Option<&Scene>, pictures: &[Picture]) -> String {
    let main = pictures.first().map_or(String::new(), |p| p.html.clone());
    let Some(scene) = scene else {
        return if main.is_empty() { String::new() } else { section("view", "Picture", &main) };
    };
    let notes: String = scene.notes.iter().map(|n| format!("<p class=\"note\">{}</p>", prose(n))).collect();
    let none = "<p class=\"note\">This browser shows no WebGL, and the run stored no pictures.</p>";
    let fallback = if main.is_empty() { none } else { &main };
    let body = include_str!("../assets/view.html").replace("{{fallback}}", fallback) + &notes;
    section("view", "View", &body)
}

/// Places for charts, with what stands below them.
fn charts(id: &str, title: &str, count: usize, below: &str) -> String {
    let places: String = (0..count).map(|_| "<div class=\"chart\"></div>").collect();
    let places = if count == 0 { String::new() } else { format!("<div class=\"charts\">{places}</div>") };
    let script = if count == 0 {
        ""
    } else {
        "<noscript><p class=\"note\">Charts need JavaScript; the pictures show them too.</p></noscript>"
    };
    section(id, title, &(places + script + below))
}

/// The stored pictures but the main one, which stands with the view.
fn gallery(pictures: &[Picture], left: usize) -> String {
    let others: String = pictures.iter().skip(1).map(|p| p.html.as_str()).collect();
    let note = if left == 0 {
        String::new()
    } else {
        format!("<p class=\"note\">{left} more in the folder <code>pictures</code>.</p>")
    };
    let body = if others.is_empty() { note } else { format!("<div class=\"pictures\">{others}</div>{note}") };
    section("pictures", "Pictures", &body)
}
