//! The crates and what they use, as the manifests say: the picture and the table of docs/architecture.md.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::fs;
use std::path::PathBuf;

/// Names of crates, without `signorini-`, with those that each uses.
type Uses = BTreeMap<String, BTreeSet<String>>;

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A name as the picture and the table have it: that of the folder.
fn short(package: &str) -> String {
    match package {
        "signorini" | "signorini-cli" | "signorini-py" => package.to_string(),
        _ => package.trim_start_matches("signorini-").to_string(),
    }
}

/// What the manifests of the crates say, tests and benches left aside.
fn uses() -> Uses {
    let folders = fs::read_dir(root().join("crates")).expect("crates").filter_map(Result::ok);
    let mut out = Uses::new();
    for folder in folders {
        let Ok(manifest) = fs::read_to_string(folder.path().join("Cargo.toml")) else { continue };
        let manifest: toml::Table = manifest.parse().expect("a manifest");
        let own = manifest["package"]["name"].as_str().expect("a name");
        let used = manifest["dependencies"].as_table().into_iter().flat_map(|table| table.keys());
        out.insert(short(own), used.filter(|name| name.starts_with("signorini")).map(|name| short(name)).collect());
    }
    out
}

/// Whether a crate uses another one by way of others.
fn reaches(uses: &Uses, from: &str, to: &str) -> bool {
    uses[from].iter().any(|next| next == to || reaches(uses, next, to))
}

/// A row for each crate, above all that it uses and as near below those that use it as that allows.
fn rows(uses: &Uses) -> BTreeMap<&str, usize> {
    fn height<'a>(of: &'a str, uses: &'a Uses, known: &mut BTreeMap<&'a str, usize>) -> usize {
        if let Some(found) = known.get(of) {
            return *found;
        }
        let found = uses[of].iter().map(|used| height(used, uses, known) + 1).max().unwrap_or(0);
        known.insert(of, found);
        found
    }
    let mut known = BTreeMap::new();
    let top = uses.keys().map(|name| height(name, uses, &mut known)).max().unwrap_or(0);
    let mut out: BTreeMap<&str, usize> = BTreeMap::new();
    let mut order: Vec<&str> = known.keys().copied().collect();
    order.sort_by_key(|name| std::cmp::Reverse(known[name]));
    for name in order {
        let users = uses.iter().filter(|(_, used)| used.contains(name)).filter_map(|(user, _)| out.get(user.as_str()));
        let row = users.min().map_or(top, |lowest| lowest - 1);
        out.insert(name, row);
    }
    out
}

const WIDTH: f64 = 960.0;
const BOX: [f64; 2] = [112.0, 30.0];
const STEP: f64 = 84.0;

/// Where the places of each row stand: a crate takes more room than an arrow between crates.
fn abscissas(places: &[Vec<String>]) -> BTreeMap<&str, f64> {
    let room = |name: &String| if name.contains(' ') { 0.25 } else { 1.0 };
    let mut out = BTreeMap::new();
    for list in places {
        let whole: f64 = list.iter().map(room).sum();
        let mut done = 0.0;
        for name in list {
            out.insert(name.as_str(), WIDTH * (done + 0.5 * room(name)) / whole);
            done += room(name);
        }
    }
    out
}

/// The crates in rows, with an arrow to each that is used and not reached through others.
fn picture(uses: &Uses) -> String {
    let row = rows(uses);
    let top = row.values().copied().max().unwrap_or(0);
    // Arrows run from row to row, over places between the crates.
    let mut places: Vec<Vec<String>> = vec![Vec::new(); top + 1];
    row.iter().for_each(|(name, row)| places[*row].push(name.to_string()));
    let mut ways: Vec<Vec<String>> = Vec::new();
    for (user, used) in uses {
        for to in used.iter().filter(|to| !used.iter().any(|by| reaches(uses, by, to))) {
            let mut way = vec![user.clone()];
            for between in (row[to.as_str()] + 1..row[user.as_str()]).rev() {
                let place = format!("{user} {to} {between}");
                places[between].push(place.clone());
                way.push(place);
            }
            way.push(to.clone());
            ways.push(way);
        }
    }
    let legs: Vec<(&str, &str)> =
        ways.iter().flat_map(|w| w.windows(2)).map(|w| (w[0].as_str(), w[1].as_str())).collect();
    // Each place near the mean of its neighbours, in sweeps up and down; the shortest arrows of all sweeps are drawn.
    let length = |places: &[Vec<String>]| {
        let at = abscissas(places);
        legs.iter().map(|(a, b)| (at[*a] - at[*b]).abs()).sum::<f64>()
    };
    let mut best = places.clone();
    for sweep in 0..40 {
        for k in 0..=top {
            let at = abscissas(&places);
            let mean = |name: &String| {
                let near = legs.iter().filter_map(|(a, b)| match name {
                    _ if a == name => Some(at[*b]),
                    _ if b == name => Some(at[*a]),
                    _ => None,
                });
                let near: Vec<f64> = near.collect();
                if near.is_empty() { at[name.as_str()] } else { near.iter().sum::<f64>() / near.len() as f64 }
            };
            let mut list = places[if sweep % 2 == 0 { top - k } else { k }].clone();
            list.sort_by(|a, b| mean(a).total_cmp(&mean(b)));
            places[if sweep % 2 == 0 { top - k } else { k }] = list;
            // Neighbours change places where that helps.
            for row in 0..places.len() {
                for k in 1..places[row].len() {
                    let before = length(&places);
                    places[row].swap(k - 1, k);
                    if length(&places) >= before {
                        places[row].swap(k - 1, k);
                    }
                }
            }
        }
        if length(&places) < length(&best) {
            best.clone_from(&places);
        }
    }
    let height = STEP * top as f64 + BOX[1] + 40.0;
    let x = abscissas(&best);
    let rows = best.iter().enumerate().flat_map(|(row, list)| list.iter().map(move |name| (name.as_str(), row)));
    let at: BTreeMap<&str, [f64; 2]> =
        rows.map(|(name, row)| (name, [x[name], height - 20.0 - 0.5 * BOX[1] - STEP * row as f64])).collect();
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{height}\" viewBox=\"0 0 {WIDTH} {height}\" \
         font-family=\"DejaVu Sans, sans-serif\" font-size=\"14\">\n<rect width=\"{WIDTH}\" height=\"{height}\" \
         fill=\"#ffffff\"/>\n<defs><marker id=\"tip\" viewBox=\"0 0 8 8\" refX=\"8\" refY=\"4\" markerWidth=\"8\" \
         markerHeight=\"8\" orient=\"auto\"><path d=\"M0 0L8 4L0 8z\" fill=\"#607080\"/></marker></defs>\n"
    );
    for way in &ways {
        let points: Vec<[f64; 2]> = way.iter().map(|name| at[name.as_str()]).collect();
        let mut path = format!("M{:.0} {:.0}", points[0][0], points[0][1] + 0.5 * BOX[1]);
        for (k, to) in points.iter().enumerate().skip(1) {
            let from = points[k - 1];
            let is_last = k + 1 == points.len();
            let [y0, y1] = [
                if k == 1 { from[1] + 0.5 * BOX[1] } else { from[1] },
                if is_last { to[1] - 0.5 * BOX[1] } else { to[1] },
            ];
            let middle = 0.5 * (y0 + y1);
            let _ = write!(path, "C{:.0} {middle:.0} {:.0} {middle:.0} {:.0} {y1:.0}", from[0], to[0], to[0]);
        }
        let _ = writeln!(out, "<path d=\"{path}\" fill=\"none\" stroke=\"#607080\" marker-end=\"url(#tip)\"/>");
    }
    for name in uses.keys() {
        let [x, y] = at[name.as_str()];
        let _ = writeln!(
            out,
            "<rect x=\"{:.0}\" y=\"{:.0}\" width=\"{}\" height=\"{}\" rx=\"5\" fill=\"#e6eef6\" stroke=\"#305070\"/>\
             <text x=\"{x:.0}\" y=\"{:.0}\" text-anchor=\"middle\">{name}</text>",
            x - 0.5 * BOX[0],
            y - 0.5 * BOX[1],
            BOX[0],
            BOX[1],
            y + 5.0
        );
    }
    out + "</svg>\n"
}

#[test]
fn the_picture_of_the_crates_is_that_of_their_manifests() {
    let (path, drawn) = (root().join("docs/architecture.svg"), picture(&uses()));
    if std::env::var_os("SIGNORINI_WRITE").is_some() {
        fs::write(&path, &drawn).expect("a file");
    }
    let stored = fs::read_to_string(&path).unwrap_or_default();
    let how = "SIGNORINI_WRITE=1 cargo test -p signorini --test validation architecture";
    assert!(stored == drawn, "the crates have changed; draw them anew: {how}");
}

#[test]
fn the_table_of_the_crates_is_that_of_their_manifests() {
    let text = fs::read_to_string(root().join("docs/architecture.md")).expect("the page");
    let rows = text.lines().filter_map(|line| line.strip_prefix("| **")?.split_once("**"));
    let told: Uses = rows
        .map(|(name, rest)| {
            let last = rest.split('|').nth(2).unwrap_or_default();
            (
                name.to_string(),
                last.split(',').map(|used| used.trim().to_string()).filter(|used| !used.is_empty()).collect(),
            )
        })
        .collect();
    assert_eq!(told, uses(), "the table of docs/architecture.md");
}

/// Files that the page names are there.
#[test]
fn the_files_that_the_page_names_exist() {
    let text = fs::read_to_string(root().join("docs/architecture.md")).expect("the page");
    let is_file = |word: &&str| word.contains('/') && (word.ends_with(".rs") || word.ends_with(".toml"));
    let names: Vec<&str> =
        text.split('`').skip(1).step_by(2).filter(is_file).filter(|word| !word.contains("NAME")).collect();
    assert!(names.len() > 50, "{}", names.len());
    let is_there = |name: &&&str| root().join("crates").join(name).exists() || root().join(name).exists();
    let missing: Vec<&&str> = names.iter().filter(|name| !is_there(name)).collect();
    assert!(missing.is_empty(), "{missing:?}");
}
