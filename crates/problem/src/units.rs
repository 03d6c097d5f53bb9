//! Units: a quantity such as `"0.1 mm"` is turned into a number in the base units of the case.

use std::collections::BTreeMap;

/// Powers of length, force, time and temperature.
pub type Dimension = [i32; 4];

pub const NONE: Dimension = [0, 0, 0, 0];
pub const LENGTH: Dimension = [1, 0, 0, 0];
pub const FORCE_PER_LENGTH: Dimension = [-1, 1, 0, 0];
pub const PRESSURE: Dimension = [-2, 1, 0, 0];
/// Force per volume.
pub const PER_VOLUME: Dimension = [-3, 1, 0, 0];
pub const FORCE: Dimension = [0, 1, 0, 0];
pub const AREA: Dimension = [2, 0, 0, 0];
pub const ENERGY: Dimension = [1, 1, 0, 0];
pub const TIME: Dimension = [0, 0, 1, 0];
pub const FREQUENCY: Dimension = [0, 0, -1, 0];
pub const VELOCITY: Dimension = [1, 0, -1, 0];
pub const ACCELERATION: Dimension = [1, 0, -2, 0];
pub const MASS: Dimension = [-1, 1, 2, 0];
pub const MASS_PER_LENGTH: Dimension = [-2, 1, 2, 0];
pub const DENSITY: Dimension = [-4, 1, 2, 0];
pub const INERTIA: Dimension = [1, 1, 2, 0];
pub const TEMPERATURE: Dimension = [0, 0, 0, 1];
/// Heat per time.
pub const POWER: Dimension = [1, 1, -1, 0];
pub const HEAT_FLUX: Dimension = [-1, 1, -1, 0];
pub const HEAT_SOURCE: Dimension = [-2, 1, -1, 0];
pub const CONDUCTIVITY: Dimension = [0, 1, -1, -1];
/// Heat per time, area and difference of temperature: of films and of contacts.
pub const CONDUCTANCE: Dimension = [-1, 1, -1, -1];
/// Heat per mass and temperature.
pub const SPECIFIC_HEAT: Dimension = [2, 0, -2, -1];
/// Strain per temperature.
pub const EXPANSION: Dimension = [0, 0, 0, -1];

/// The base units of a case, in metres, newtons and seconds; temperatures are in steps of a kelvin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    pub length: f64,
    pub force: f64,
    pub time: f64,
    /// Zero of temperatures, in kelvin: that of kelvin or of degrees Celsius.
    pub zero: f64,
    /// Their names, and that of temperatures.
    pub names: [&'static str; 4],
}

const LENGTHS: [(&str, f64); 7] =
    [("m", 1.0), ("km", 1e3), ("cm", 1e-2), ("mm", 1e-3), ("um", 1e-6), ("nm", 1e-9), ("in", 0.0254)];
const FORCES: [(&str, f64); 7] =
    [("N", 1.0), ("kN", 1e3), ("MN", 1e6), ("mN", 1e-3), ("uN", 1e-6), ("nN", 1e-9), ("lbf", 4.4482216152605)];
const TIMES: [(&str, f64); 5] = [("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("min", 60.0), ("h", 3600.0)];
const PRESSURES: [(&str, f64); 8] =
    [("Pa", 1.0), ("hPa", 1e2), ("kPa", 1e3), ("MPa", 1e6), ("GPa", 1e9), ("mPa", 1e-3), ("bar", 1e5), ("mbar", 1e2)];
const ENERGIES: [(&str, f64); 6] = [("J", 1.0), ("kJ", 1e3), ("MJ", 1e6), ("mJ", 1e-3), ("uJ", 1e-6), ("nJ", 1e-9)];
const POWERS: [(&str, f64); 5] = [("W", 1.0), ("kW", 1e3), ("MW", 1e6), ("mW", 1e-3), ("uW", 1e-6)];
/// Scales of temperature with their zero, in kelvin.
const TEMPERATURES: [(&str, f64); 2] = [("K", 0.0), ("degC", 273.15)];

const MASSES: [(&str, f64); 4] = [("kg", 1.0), ("g", 1e-3), ("mg", 1e-6), ("t", 1e3)];

/// A name with the letter u for micro, which has two code points in Unicode: the micro sign and the Greek letter mu; and with
/// `deg` for degrees.
fn plain(name: &str) -> String {
    name.replace(['\u{b5}', '\u{3bc}'], "u").replace('°', "deg")
}

/// Whether a text is a unit.
pub fn is_unit(text: &str) -> bool {
    parse_unit(text).is_ok()
}

/// All named units with their size and dimension.
fn named() -> BTreeMap<&'static str, (f64, Dimension)> {
    let of = |list: &'static [(&'static str, f64)], d: Dimension| list.iter().map(move |&(n, v)| (n, (v, d)));
    of(&LENGTHS, LENGTH)
        .chain(of(&FORCES, FORCE))
        .chain(of(&TIMES, TIME))
        .chain(of(&PRESSURES, PRESSURE))
        .chain(of(&ENERGIES, ENERGY))
        .chain(of(&POWERS, POWER))
        .chain(of(&MASSES, MASS))
        .chain(TEMPERATURES.map(|(name, _)| (name, (1.0, TEMPERATURE))))
        .chain([("1", (1.0, NONE))])
        .collect()
}

impl Units {
    /// One of the named systems: `m-N-Pa`, `mm-N-MPa`, `um-uN-MPa`.
    pub fn system(name: &str) -> Option<Self> {
        Some(match plain(name).as_str() {
            "m-N-Pa" => Self { length: 1.0, force: 1.0, time: 1.0, zero: 0.0, names: ["m", "N", "s", "K"] },
            "mm-N-MPa" => Self { length: 1e-3, force: 1.0, time: 1.0, zero: 0.0, names: ["mm", "N", "s", "K"] },
            "um-uN-MPa" => Self { length: 1e-6, force: 1e-6, time: 1.0, zero: 0.0, names: ["um", "uN", "s", "K"] },
            _ => return None,
        })
    }

    /// A system from the names of its base units.
    pub fn from_names([length, force, time, temperature]: [&str; 4]) -> Result<Self, String> {
        let find = |list: &[(&'static str, f64)], what: &str, name: &str| {
            list.iter().find(|(n, _)| *n == plain(name)).copied().ok_or_else(|| {
                let known: Vec<&str> = list.iter().map(|(n, _)| *n).collect();
                format!("`{name}` is not a unit of {what}; valid units are {}", known.join(", "))
            })
        };
        let (length, force, time) =
            (find(&LENGTHS, "length", length)?, find(&FORCES, "force", force)?, find(&TIMES, "time", time)?);
        let temperature = find(&TEMPERATURES, "temperature", temperature)?;
        Ok(Self {
            length: length.1,
            force: force.1,
            time: time.1,
            zero: temperature.1,
            names: [length.0, force.0, time.0, temperature.0],
        })
    }

    /// What the base unit of a dimension is called, such as `N/mm^2`.
    pub fn name_of(&self, dimension: Dimension) -> String {
        let power = |name: &str, p: i32| if p == 1 { name.to_string() } else { format!("{name}^{p}") };
        // Force first, as people write it.
        let parts = [1, 0, 2, 3].map(|k| (self.names[k], dimension[k]));
        let above: Vec<String> = parts.iter().filter(|(_, p)| *p > 0).map(|(n, p)| power(n, *p)).collect();
        let below: Vec<String> = parts.iter().filter(|(_, p)| *p < 0).map(|(n, p)| power(n, -p)).collect();
        match (above.is_empty(), below.is_empty()) {
            (true, true) => "1".into(),
            (_, true) => above.join("*"),
            (true, _) => format!("1/{}", below.join("/")),
            _ => format!("{}/{}", above.join("*"), below.join("/")),
        }
    }

    /// What the base unit of a dimension is called as people write it: `MPa` for a newton per square millimetre, `µm`.
    pub fn written(&self, dimension: Dimension) -> String {
        let [length, force, time, _] = dimension;
        let size = self.length.powi(length) * self.force.powi(force) * self.time.powi(time);
        let own = (PRESSURES.iter().map(|u| (u, PRESSURE)))
            .chain(ENERGIES.iter().map(|u| (u, ENERGY)))
            .chain(POWERS.iter().map(|u| (u, POWER)));
        let named = own.filter(|(_, d)| *d == dimension).find(|((_, v), _)| (v / size - 1.0).abs() < 1e-12);
        let name = named.map_or_else(|| self.name_of(dimension), |((name, _), _)| name.to_string());
        // A letter u before a unit is micro.
        let micro = |word: &str| match word.strip_prefix('u') {
            Some(rest) if !rest.is_empty() => format!("µ{rest}"),
            _ => word.to_string(),
        };
        let mut out = String::new();
        for word in name.split_inclusive(['*', '/']) {
            out += &micro(word);
        }
        out.replace("^2", "²").replace("^3", "³").replace('*', "·")
    }

    /// The factor that turns a number in `unit` into base units, and the dimension of the unit.
    pub fn factor(&self, unit: &str) -> Result<(f64, Dimension), String> {
        let (size, dimension) = parse_unit(unit)?;
        let base = self.length.powi(dimension[0]) * self.force.powi(dimension[1]) * self.time.powi(dimension[2]);
        Ok((size / base, dimension))
    }

    /// What is added to a temperature in `unit` to have it on the scale of the case; zero of all that is no temperature by
    /// itself, such as a heat capacity.
    pub fn shift(&self, unit: &str) -> f64 {
        let scale = TEMPERATURES.iter().find(|(name, _)| *name == plain(unit.trim()));
        scale.map_or(0.0, |(_, zero)| zero - self.zero)
    }
}

/// A unit without parentheses: what stands in them after a stroke is divided by, as in `W/(m K)`.
fn flat(text: &str) -> String {
    let mut out = String::new();
    let mut within = false;
    for c in text.trim().chars() {
        match c {
            '(' => within = true,
            ')' => within = false,
            '*' | '·' | ' ' if within => out.push('/'),
            _ => out.push(c),
        }
    }
    out
}

/// Reads a product of powers of named units, such as `N/m`, `uN/um^2` or `N*m`.
fn parse_unit(text: &str) -> Result<(f64, Dimension), String> {
    let names = named();
    let text = &flat(text);
    let (mut size, mut dimension) = (1.0, NONE);
    let mut sign = 1;
    let mut rest = text.trim();
    loop {
        let end = rest.find(['*', '/', '·']).unwrap_or(rest.len());
        let (word, power) = match rest[..end].trim().split_once('^') {
            Some((word, power)) => {
                let power = power.trim().parse::<i32>().ok().filter(|p| p.abs() <= 6);
                (word.trim(), power.ok_or_else(|| format!("`{}` has no integer exponent", rest[..end].trim()))?)
            }
            None => (rest[..end].trim(), 1),
        };
        let Some((value, d)) = names.get(plain(word).as_str()) else {
            let known: Vec<&str> = names.keys().copied().collect();
            return Err(format!("unknown unit `{word}`: {}", super::suggestion(word, &known)));
        };
        size *= value.powi(sign * power);
        for k in 0..4 {
            dimension[k] += sign * power * d[k];
        }
        let Some(operator) = rest[end..].chars().next() else { return Ok((size, dimension)) };
        sign = if operator == '/' { -1 } else { 1 };
        rest = &rest[end + operator.len_utf8()..];
    }
}

/// A dimension in words, with an example.
pub fn describe(dimension: Dimension) -> &'static str {
    match dimension {
        NONE => "a number without unit",
        LENGTH => "a length, such as mm",
        FORCE_PER_LENGTH => "a force per length, such as N/m",
        PRESSURE => "a force per area, such as Pa",
        FORCE => "a force, such as N",
        TIME => "a time, such as s",
        TEMPERATURE => "a temperature, such as K or degC",
        POWER => "a heat per time, such as W",
        HEAT_FLUX => "a heat per time and area, such as W/m^2",
        HEAT_SOURCE => "a heat per time and volume, such as W/m^3",
        CONDUCTIVITY => "a conductivity, such as W/(m K)",
        CONDUCTANCE => "a conductance per area, such as W/(m^2 K)",
        SPECIFIC_HEAT => "a specific heat, such as J/(kg K)",
        EXPANSION => "a strain per temperature, such as 1/K",
        DENSITY => "a mass per volume, such as kg/m^3",
        _ => "another dimension",
    }
}
