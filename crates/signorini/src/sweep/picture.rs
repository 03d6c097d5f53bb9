//! The picture of a sweep: quantities over the varied key; of two keys in a grid a family of curves; else dots over every key.

use super::manifest::Manifest;
use super::record::Status;
use super::table::{Column, Table};
use super::vary::{Setting, Variation};
use crate::output::chart::{label, range, viridis};
use crate::output::colours::FRONT;
use crate::output::history::SERIES;
use crate::output::page::{Page, Sign, text_width};
use crate::output::panel::{Axis, Dots, Panel};
use plotters::style::RGBColor;

/// Quantities that are shown first, by the ends of their paths.
const FIRST: [&str; 12] = [
    "normal_force",
    "force_size",
    "area",
    "max_pressure",
    "max_slip",
    "length",
    "tension_limits.1",
    "displacement.z",
    "displacement.y",
    "displacement.x",
    "max_tension",
    "energy",
];
/// The most panels, and the most columns of dots.
const PANELS: usize = 4;
const KEYS: usize = 4;
/// The most curves that a key lists.
const LISTED: usize = 8;
/// Width and height of a panel.
const WIDE: (f64, f64) = (470.0, 300.0);
const SMALL: (f64, f64) = (330.0, 250.0);
/// The most letters of a key below an axis.
const LONGEST: usize = 34;
/// Room above the panels.
const TOP: f64 = 64.0;
/// Changes below this part of the size of a quantity are those of rounding.
const CHANGE: f64 = 1e-9;

/// A varied key as an axis.
struct Key {
    title: String,
    /// Where each run is along it.
    places: Vec<f64>,
    /// The words at the places 0, 1, …, of values that are no numbers.
    words: Vec<String>,
    log: bool,
}

impl Key {
    fn new(manifest: &Manifest, k: usize, variation: &Variation) -> Self {
        let mut words: Vec<String> = Vec::new();
        let mut place = |v: &Setting| match v {
            Setting::Number(v) => *v,
            Setting::Text(text) => {
                // Of a table without keys the name is enough.
                let word = text.trim_matches(|c: char| "{}=\"' ".contains(c));
                let known = words.iter().position(|w| w == word);
                known.unwrap_or_else(|| {
                    words.push(word.into());
                    words.len() - 1
                }) as f64
            }
        };
        let places: Vec<f64> = manifest.rows.iter().map(|row| place(&row[k])).collect();
        let log = variation.is_log() && places.iter().all(|v| *v > 0.0);
        Self { title: short(&variation.title()), places, words, log }
    }

    fn axis(&self) -> Axis<'_> {
        let (low, high) = range(self.places.iter().copied());
        if !self.words.is_empty() {
            return Axis::of_words(&self.title, &self.words);
        }
        match self.log {
            true => Axis { log: true, ..Axis::new(&self.title, (low / 1.1, high * 1.1)) },
            false => Axis::around(&self.title, (low, high)),
        }
    }

    /// The different places.
    fn distinct(&self) -> Vec<f64> {
        let mut places = self.places.clone();
        places.sort_by(f64::total_cmp);
        places.dedup();
        places
    }

    /// A place in words.
    fn name(&self, place: f64) -> String {
        match self.words.get(place as usize) {
            Some(word) if !self.words.is_empty() => word.clone(),
            _ => label(place),
        }
    }
}

/// The end of a long key, from one of its parts on.
fn short(title: &str) -> String {
    let long = |rest: &str| rest.chars().count() > LONGEST;
    let mut rest = title;
    while let Some((_, tail)) = rest.split_once('.').filter(|_| long(rest)) {
        rest = tail;
    }
    if rest.len() < title.len() { format!("…{rest}") } else { title.into() }
}

/// A quantity of all runs.
struct Quantity<'a> {
    column: &'a Column,
    values: Vec<Option<f64>>,
}

impl<'a> Quantity<'a> {
    /// Of the runs that are done; none of what is no number, or the same in all of them.
    fn new(column: &'a Column, done: &[bool]) -> Option<Self> {
        let value = |(value, done): (&serde_json::Value, &bool)| value.as_f64().filter(|_| *done);
        let values: Vec<Option<f64>> = column.values.iter().zip(done).map(value).collect();
        let numbers = || values.iter().flatten().copied().filter(|v| v.is_finite());
        let (low, high) = numbers().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        let count = numbers().count();
        let changes = high - low > CHANGE * high.abs().max(low.abs());
        (count == 1 || (count > 1 && changes)).then_some(Self { column, values })
    }

    /// What it belongs to, such as a contact; empty for all.
    fn owner(&self) -> &'a str {
        let rest = ["contacts.", "probes.", "curves.", "paths.", "winding.", "ropes."];
        let rest = rest.iter().find_map(|group| self.column.name.strip_prefix(group));
        rest.map_or("", |rest| rest.split_once('.').map_or("", |(owner, _)| owner))
    }

    /// What it is called, without what it belongs to.
    fn kind(&self) -> String {
        let name = &self.column.name;
        let inner = match self.owner() {
            "" => name,
            owner => name.split_once(&format!("{owner}.")).map_or(name.as_str(), |(_, rest)| rest),
        };
        let inner = inner.strip_prefix("frames.-1.").unwrap_or(inner);
        let inner = if inner == "force_size" { "force" } else { inner };
        inner.replace(['_', '.'], " ")
    }

    fn title(&self, alone: bool) -> String {
        let owner = if alone && !self.owner().is_empty() { format!("{}: ", self.owner()) } else { String::new() };
        let unit = &self.column.unit;
        let unit = if unit.is_empty() { String::new() } else { format!(" [{unit}]") };
        format!("{owner}{}{unit}", self.kind())
    }

    fn axis<'b>(&self, name: &'b str, others: &[&Quantity], log: bool) -> Axis<'b> {
        let all = || others.iter().flat_map(|q| q.values.iter().flatten().copied());
        let (low, high) = range(all());
        match log && low > 0.0 && high > 20.0 * low {
            true => Axis { log: true, ..Axis::new(name, (low / 1.3, high * 1.3)) },
            false => Axis::around(name, (low, high)),
        }
    }
}

/// The picture of what the runs have recorded; none where there is nothing to show.
pub fn draw(manifest: &Manifest, table: &Table) -> Option<String> {
    let mut keys: Vec<Key> = manifest.vary.iter().enumerate().map(|(k, v)| Key::new(manifest, k, v)).collect();
    // A key with one value shows nothing beside others.
    if keys.iter().any(|key| key.distinct().len() > 1) {
        keys.retain(|key| key.distinct().len() > 1);
    }
    let chosen = chosen(table, !manifest.collect.is_empty());
    if chosen.is_empty() {
        return None;
    }
    let problem = crate::case::read(&manifest.case.display().to_string(), &manifest.text, &manifest.set).ok()?;
    let file = std::path::Path::new(problem.name()).file_name().map_or(problem.name().into(), |f| f.to_string_lossy());
    let failed = table.count(Status::Failed);
    let note = match failed {
        0 => format!("{} runs", manifest.rows.len()),
        n if keys.len() == 1 => format!("{} runs, {n} of them failed (red)", manifest.rows.len()),
        n => format!("{} runs, {n} of them failed", manifest.rows.len()),
    };
    let sheet = Sheet { title: file.into_owned(), note, keys, chosen, table };
    Some(match (sheet.keys.len(), manifest.sample) {
        (1, _) => sheet.curves(),
        (2, None) => sheet.family(),
        _ => sheet.dots(),
    })
}

/// Quantities that change, the main ones first; all that were asked for in their order.
fn chosen(table: &Table, asked: bool) -> Vec<Quantity<'_>> {
    // What a failed run reached last is of another time.
    let done: Vec<bool> = table.records.iter().map(|record| record.status == Status::Done).collect();
    let all: Vec<Quantity> = table.collected().iter().filter_map(|column| Quantity::new(column, &done)).collect();
    if asked {
        return all;
    }
    let has_normal = all.iter().any(|q| q.column.name.ends_with(".normal_force"));
    let ends = |q: &Quantity, end: &str| q.column.name == end || q.column.name.ends_with(&format!(".{end}"));
    let rank = |q: &Quantity| FIRST.iter().position(|end| ends(q, end)).unwrap_or(FIRST.len());
    let mut all: Vec<Quantity> = all.into_iter().filter(|q| !has_normal || !ends(q, "force_size")).collect();
    all.sort_by_key(rank);
    let main = all.iter().filter(|q| rank(q) < FIRST.len()).count();
    all.truncate(if main > 0 { main } else { PANELS });
    all
}

/// What a picture shows.
struct Sheet<'a> {
    title: String,
    note: String,
    keys: Vec<Key>,
    chosen: Vec<Quantity<'a>>,
    table: &'a Table,
}

impl Sheet<'_> {
    /// Rows with a place along a key and a value, in the order of the places.
    fn points(&self, key: &Key, quantity: &Quantity, only: &dyn Fn(usize) -> bool) -> Vec<(f64, f64)> {
        let rows = quantity.values.iter().enumerate().filter(|(row, _)| only(*row));
        let mut points: Vec<(f64, f64)> = rows.filter_map(|(row, v)| Some((key.places[row], (*v)?))).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points
    }

    fn failed(&self, row: usize) -> bool {
        self.table.records[row].status == Status::Failed
    }

    /// Panels two by two, and a key of so many entries below.
    fn page(&self, panels: usize, entries: &[(Sign, String)]) -> Page {
        let columns = panels.clamp(1, 2);
        let width = WIDE.0 * columns as f64 + 20.0;
        let widths: f64 = entries.iter().map(|e| 44.0 + text_width(&e.1, 14.0)).sum();
        let lines = (widths / (width - 150.0)).ceil();
        let height = TOP + WIDE.1 * panels.div_ceil(columns) as f64 + 18.0 * lines + 8.0;
        Page::new((width, height), &self.title, &self.note)
    }

    fn part(k: usize) -> [f64; 4] {
        let (left, top) = (WIDE.0 * (k % 2) as f64, TOP - 12.0 + WIDE.1 * (k / 2) as f64);
        [left, top, left + WIDE.0, top + WIDE.1]
    }

    /// Quantities of one kind in one panel, over the only key.
    fn curves(&self) -> String {
        let key = &self.keys[0];
        let mut groups: Vec<(String, Vec<&Quantity>)> = Vec::new();
        for quantity in &self.chosen {
            match groups.iter_mut().find(|(kind, _)| *kind == quantity.title(false)) {
                Some((_, list)) => list.push(quantity),
                None => groups.push((quantity.title(false), vec![quantity])),
            }
        }
        groups.truncate(PANELS);
        let mut owners: Vec<&str> = Vec::new();
        groups.iter().flat_map(|(_, list)| list).for_each(|q| {
            if !owners.contains(&q.owner()) {
                owners.push(q.owner());
            }
        });
        let several = groups.iter().any(|(_, list)| list.len() > 1);
        let number = |q: &Quantity| owners.iter().position(|o| several && *o == q.owner()).unwrap_or(0);
        let colour = |q: &Quantity| SERIES[number(q) % SERIES.len()];
        let listed = owners.iter().enumerate().filter(|(_, o)| several && !o.is_empty());
        let entries: Vec<(Sign, String)> =
            listed.map(|(k, o)| (Sign::Line(SERIES[k % SERIES.len()]), o.to_string())).collect();
        let mut page = self.page(groups.len(), &entries);
        for (k, (_, list)) in groups.iter().enumerate() {
            let title = list[0].title(list.len() == 1);
            let axis = list[0].axis(&title, list, key.log);
            let mut panel = Panel::new(&mut page.svg, Self::part(k), key.axis(), axis);
            for row in (0..self.table.records.len()).filter(|row| self.failed(*row)) {
                panel.mark(key.places[row], "", FRONT);
            }
            for quantity in list {
                let points = self.points(key, quantity, &|_| true);
                curve(&mut panel, key, &points, colour(quantity));
            }
        }
        page.key(&entries);
        page.finish()
    }

    /// A curve for each value of one key over the other, which has more values.
    fn family(&self) -> String {
        let counts = [0, 1].map(|k| (self.keys[k].words.is_empty(), self.keys[k].distinct().len()));
        let (along, across) = if counts[1] > counts[0] { (1, 0) } else { (0, 1) };
        let (key, other) = (&self.keys[along], &self.keys[across]);
        let values = other.distinct();
        let colour = |k: usize| viridis(0.9 * k as f64 / (values.len() - 1).max(1) as f64);
        let every = values.len().div_ceil(LISTED);
        let last = other.title.rsplit_once('.').map_or(other.title.as_str(), |(_, end)| end);
        let (last, unit) = last.split_once(" [").map_or((last, ""), |(a, b)| (a, b.trim_end_matches(']')));
        let entry = |(k, v): (usize, &f64)| {
            (Sign::Line(colour(k)), format!("{last} = {} {unit}", other.name(*v)).trim_end().to_string())
        };
        let entries: Vec<(Sign, String)> = values.iter().enumerate().step_by(every).map(entry).collect();
        let shown = &self.chosen[..self.chosen.len().min(PANELS)];
        let mut page = self.page(shown.len(), &entries);
        for (k, quantity) in shown.iter().enumerate() {
            let title = quantity.title(true);
            let axis = quantity.axis(&title, &[quantity], key.log);
            let mut panel = Panel::new(&mut page.svg, Self::part(k), key.axis(), axis);
            for (k, value) in values.iter().enumerate() {
                let points = self.points(key, quantity, &|row| other.places[row] == *value);
                curve(&mut panel, key, &points, colour(k));
            }
        }
        page.key(&entries);
        page.finish()
    }

    /// Dots of every quantity over every key.
    fn dots(&self) -> String {
        let rows = &self.chosen[..self.chosen.len().min(3)];
        let columns = &self.keys[..self.keys.len().min(KEYS)];
        let size = (SMALL.0 * columns.len() as f64 + 20.0, TOP + SMALL.1 * rows.len() as f64);
        let mut page = Page::new(size, &self.title, &self.note);
        for (i, quantity) in rows.iter().enumerate() {
            for (k, key) in columns.iter().enumerate() {
                let (left, top) = (SMALL.0 * k as f64, TOP - 12.0 + SMALL.1 * i as f64);
                let title = if k == 0 { quantity.title(true) } else { String::new() };
                let axis = quantity.axis(&title, &[quantity], false);
                let mut panel = Panel::new(&mut page.svg, [left, top, left + SMALL.0, top + SMALL.1], key.axis(), axis);
                let points = self.points(key, quantity, &|_| true);
                panel.dots(&points, SERIES[0], if points.len() > 100 { 2.0 } else { 3.0 }, Dots::Full);
            }
        }
        page.finish()
    }
}

/// A line with dots; between words there is nothing.
fn curve(panel: &mut Panel, key: &Key, points: &[(f64, f64)], colour: RGBColor) {
    if key.words.is_empty() {
        panel.line(points, Sign::Line(colour), 2.0);
    }
    if points.len() <= 60 {
        panel.dots(points, colour, 3.2, Dots::Full);
    }
}
