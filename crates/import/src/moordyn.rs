//! Mooring lines of MoorDyn (`.txt`, `.dat`) at rest: ropes between fixed points, with their weight in water, above a flat seabed.
//!
//! A section begins with a line of dashes and its name; two lines name its columns and their units. Columns are found by name, so
//! both versions of the format are read. Water and bottom are those of the options.

use crate::ImportError;
use crate::case::names::Names;
use crate::case::quoted;
use signorini_geometry::Vector;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

/// What MoorDyn takes where the options are silent: density of the water, acceleration of gravity.
const WATER: f64 = 1025.0;
const GRAVITY: f64 = 9.8;

struct Row<'a> {
    line: usize,
    fields: Vec<&'a str>,
}

#[derive(Default)]
struct Table<'a> {
    columns: Vec<String>,
    rows: Vec<Row<'a>>,
}

struct File<'a> {
    path: &'a Path,
    tables: BTreeMap<&'static str, Table<'a>>,
}

/// A type of line: diameter, mass per length, axial stiffness.
struct Kind {
    diameter: f64,
    mass: f64,
    stiffness: f64,
    bends: bool,
}

/// The case of a file.
pub(crate) fn read(path: &Path) -> Result<String, ImportError> {
    let text =
        std::fs::read_to_string(path).map_err(|e| ImportError::new(path, None, format!("cannot be read: {e}")))?;
    let file = File::read(path, &text)?;
    let mut remarks = Vec::new();
    let options = file.options()?;
    let option = |names: &[&str]| names.iter().find_map(|n| options.get(&n.to_lowercase()).copied());
    let water = option(&["WtrDnsty", "rhoW", "rho"]).unwrap_or(WATER);
    let gravity = option(&["g", "gravity"]).unwrap_or(GRAVITY);
    let depth = option(&["WtrDpth", "depth"]).ok_or_else(|| {
        ImportError::new(
            path,
            None,
            "the options state no WtrDpth: expected the depth of the water, as in `200 WtrDpth`",
        )
    })?;
    let kinds = file.kinds()?;
    let points = file.points()?;
    if option(&["FrictionCoefficient"]).is_some_and(|mu| mu != 0.0) {
        remarks
            .push("the friction of the seabed is left out: at rest it depends on how the lines were laid".to_string());
    }
    let mut out = format!(
        "\nspace = \"3d\"\nunits = \"m-N-Pa\"\n\n[bodies.seabed.rigid]\nshape.plane = {{ point = [0, 0, {:?}], normal = [0, 0, 1] }}\n",
        -depth
    );
    let mut names = Names::default();
    names.take("seabed");
    let lines = file.table("LINES")?;
    for row in &lines.rows {
        let id = file.field(lines, row, &["ID", "Line"])?;
        let name = names.take(&format!("line_{id}"));
        let kind_name = file.field(lines, row, &["LineType"])?;
        let known = || format!("there is no line type `{kind_name}`; there are {}", listed(kinds.keys()));
        let kind = kinds.get(kind_name).ok_or_else(|| file.wrong(row, known()))?;
        let end = |columns: &[&str]| -> Result<Vector<3>, ImportError> {
            let id = file.field(lines, row, columns)?;
            let none = || file.wrong(row, format!("cannot be imported: the end `{id}` is no point with a fixed place"));
            points.get(id).copied().flatten().ok_or_else(none)
        };
        let (from, to) = (end(&["AttachA", "NodeAnch", "NodeA"])?, end(&["AttachB", "NodeFair", "NodeB"])?);
        if let Some(low) = [from, to].iter().find(|x| x[2] < -depth) {
            return Err(
                file.wrong(row, format!("an end of the line is at z = {}, below the seabed at {}", low[2], -depth))
            );
        }
        let length = file.positive(lines, row, &["UnstrLen"])?;
        let cells = file.positive(lines, row, &["NumSegs"])?;
        let area = std::f64::consts::PI * kind.diameter.powi(2) / 4.0;
        let weight = (kind.mass - water * area) * gravity;
        if kind.bends {
            remarks.push(format!("the bending stiffness of `{kind_name}` is left out"));
        }
        let points: Vec<String> =
            start(&from, &to, length, -depth).iter().map(|x| format!("{:?}", x.as_slice())).collect();
        let _ = write!(
            out,
            "\n[bodies.{name}.rope]\npath.points = [{}]\ncells = {}\nstiffness = {:?}\nunstrained_length = {length:?}\n
[supports.{name}_start]\non = \"{name}:start\"\ndisplacement = [0, 0, 0]\n
[supports.{name}_end]\non = \"{name}:end\"\ndisplacement = [0, 0, 0]\n
# {:?} kg/m in water of {water:?} kg/m3, {:?} m in diameter.
[loads.{name}_weight]\non = \"{name}\"\nbody_force = [0, 0, {:?}]\n
[contacts.{name}_seabed]\nbetween = [\"{name}\", \"seabed\"]\n",
            points.join(", "),
            cells as usize,
            kind.stiffness,
            kind.mass,
            kind.diameter,
            -weight
        );
    }
    if lines.rows.is_empty() {
        return Err(ImportError::new(path, None, "there are no lines"));
    }
    remarks.push("waves, currents, drag and all other motion; the seabed is rigid".into());
    remarks.dedup();
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let left_out = crate::case::left_out(&remarks);
    let head = format!("# Imported from {name}: the lines at rest.\n{left_out}\ntitle = {}", quoted(&name));
    Ok(head + &out + "\n[[steps]]\nto = 1.0\nincrements = 1\n")
}

/// Where a line begins: straight, or if it is longer than that through a point below such that it has its length. That point is
/// on the vertical plane of the ends, in the middle or, if that is too deep, on the seabed.
fn start(from: &Vector<3>, to: &Vector<3>, length: f64, seabed: f64) -> Vec<Vector<3>> {
    let chord = (to - from).norm();
    if length <= chord {
        return vec![*from, *to];
    }
    let across = Vector::<3>::new(to[0] - from[0], to[1] - from[1], 0.0);
    let at = |share: f64, z: f64| Vector::<3>::new(from[0] + share * across[0], from[1] + share * across[1], z);
    let way = |x: &Vector<3>| (x - from).norm() + (to - x).norm();
    // The way grows with the depth; where the seabed is too high, it grows from the middle to the end that is lower.
    let (mut low, mut high) = (0.0, 1.0);
    let top = from[2].min(to[2]);
    let below = |s: f64| at(0.5, top - s * (length + chord));
    let aside = if from[2] <= to[2] { 1.0 } else { 0.0 };
    let on_seabed = |s: f64| at(0.5 + s * (aside - 0.5), seabed);
    let is_deep = way(&at(0.5, seabed.min(top))) < length;
    let point = |s: f64| if is_deep { on_seabed(s) } else { below(s) };
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if way(&point(middle)) < length { low = middle } else { high = middle }
    }
    vec![*from, point(low), *to]
}

fn listed<'a>(names: impl Iterator<Item = &'a String>) -> String {
    let list: Vec<String> = names.map(|n| format!("`{n}`")).collect();
    if list.is_empty() { "none".into() } else { list.join(", ") }
}

impl<'a> File<'a> {
    fn read(path: &'a Path, text: &'a str) -> Result<Self, ImportError> {
        let mut tables: BTreeMap<&'static str, Table> = BTreeMap::new();
        let mut section: Option<&'static str> = None;
        let mut header = 0;
        for (k, line) in text.lines().enumerate() {
            if line.trim_start().starts_with("---") {
                (section, header) = (section_of(line), 0);
                continue;
            }
            let Some(name) = section else { continue };
            let fields: Vec<&str> =
                line.split(|c: char| c.is_whitespace() || c == ',').filter(|f| !f.is_empty()).collect();
            let table = tables.entry(name).or_default();
            if name != "OPTIONS" && header < 2 {
                if header == 0 {
                    table.columns = fields.iter().map(|f| f.to_lowercase()).collect();
                }
                header += 1;
            } else if !fields.is_empty() && !fields[0].starts_with('#') {
                table.rows.push(Row { line: k + 1, fields });
            }
        }
        for name in ["BODIES", "RODS"] {
            if let Some(row) = tables.get(name).and_then(|t| t.rows.first()) {
                let message = format!("cannot be imported: {} of MoorDyn do not exist here", name.to_lowercase());
                return Err(ImportError::new(path, row.line, message));
            }
        }
        Ok(Self { path, tables })
    }

    fn wrong(&self, row: &Row, message: impl Into<String>) -> ImportError {
        ImportError::new(self.path, row.line, message)
    }

    fn table(&self, name: &str) -> Result<&Table<'a>, ImportError> {
        let none = || ImportError::new(self.path, None, format!("is no file of MoorDyn: it has no section {name}"));
        self.tables.get(name).ok_or_else(none)
    }

    fn field(&self, table: &Table, row: &Row<'a>, columns: &[&str]) -> Result<&'a str, ImportError> {
        let place = table.columns.iter().position(|c| columns.iter().any(|n| n.eq_ignore_ascii_case(c)));
        let none = || self.wrong(row, format!("the column {} is missing", columns[0]));
        row.fields.get(place.ok_or_else(none)?).copied().ok_or_else(none)
    }

    fn number(&self, table: &Table, row: &Row<'a>, columns: &[&str]) -> Result<f64, ImportError> {
        let text = self.field(table, row, columns)?;
        let number: Option<f64> = text.parse().ok().filter(|v: &f64| v.is_finite());
        number.ok_or_else(|| {
            self.wrong(row, format!("{}: `{text}` is no number; tables of values are not imported", columns[0]))
        })
    }

    fn positive(&self, table: &Table, row: &Row<'a>, columns: &[&str]) -> Result<f64, ImportError> {
        let number = self.number(table, row, columns)?;
        if number > 0.0 { Ok(number) } else { Err(self.wrong(row, format!("{}: {number}, expected > 0", columns[0]))) }
    }

    fn kinds(&self) -> Result<BTreeMap<String, Kind>, ImportError> {
        let table = self.table("LINE TYPES")?;
        let mut out = BTreeMap::new();
        for row in &table.rows {
            let name = self.field(table, row, &["TypeName", "Name", "LineType"])?.to_string();
            let has_bending = table.columns.iter().any(|c| c == "ei");
            let kind = Kind {
                diameter: self.positive(table, row, &["Diam", "Dia"])?,
                mass: self.positive(table, row, &["Mass/m", "MassDen", "MassDenInAir", "Mass/mInAir"])?,
                stiffness: self.positive(table, row, &["EA"])?,
                bends: has_bending && self.number(table, row, &["EI"])? != 0.0,
            };
            out.insert(name, kind);
        }
        Ok(out)
    }

    /// The places of points; none of those that may move.
    fn points(&self) -> Result<BTreeMap<String, Option<Vector<3>>>, ImportError> {
        let table = self.table("POINTS")?;
        let mut out = BTreeMap::new();
        for row in &table.rows {
            let id = self.field(table, row, &["ID", "Node", "Point"])?.to_string();
            let kind = self.field(table, row, &["Type", "Attachment"])?.to_lowercase();
            let is_fixed =
                ["fixed", "fix", "anchor", "vessel", "ves", "coupled", "cpld", "fairlead"].contains(&kind.as_str());
            let x = [["X"], ["Y"], ["Z"]].map(|c| self.number(table, row, &c));
            let [x, y, z] = x;
            let place = Vector::<3>::new(x?, y?, z?);
            out.insert(id, is_fixed.then_some(place));
        }
        Ok(out)
    }

    /// The numbers of the options, by their names.
    fn options(&self) -> Result<BTreeMap<String, f64>, ImportError> {
        let mut out = BTreeMap::new();
        for row in self.tables.get("OPTIONS").map_or(&[][..], |t| &t.rows) {
            let [value, name, ..] = row.fields[..] else { continue };
            match value.parse() {
                Ok(number) => drop(out.insert(name.to_lowercase(), number)),
                Err(_) if name.eq_ignore_ascii_case("WtrDpth") => {
                    let message = format!("WtrDpth: `{value}` is no number: seabeds from files are not imported");
                    return Err(self.wrong(row, message));
                }
                Err(_) => {}
            }
        }
        Ok(out)
    }
}

/// The section that a line of dashes begins.
fn section_of(line: &str) -> Option<&'static str> {
    let name = line.trim_matches(|c: char| c == '-' || c.is_whitespace()).to_uppercase();
    Some(match name.as_str() {
        "LINE TYPES" | "LINE DICTIONARY" => "LINE TYPES",
        "POINTS" | "POINT" | "POINT LIST" | "POINT PROPERTIES" | "CONNECTION PROPERTIES" | "NODE PROPERTIES" => {
            "POINTS"
        }
        "LINES" | "LINE LIST" | "LINE PROPERTIES" => "LINES",
        "OPTIONS" | "SOLVER OPTIONS" => "OPTIONS",
        "BODIES" | "BODY LIST" | "BODY PROPERTIES" => "BODIES",
        "RODS" | "ROD LIST" | "ROD PROPERTIES" => "RODS",
        _ => return None,
    })
}
