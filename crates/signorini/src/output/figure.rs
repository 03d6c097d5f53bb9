//! Numbers as people read them: with the digits that they have.

/// Digits after the first of a result of which nobody knows how far it may be off: cells leave seldom more than a tenth of
/// a percent.
const DIGITS: i32 = 3;
/// What is computed without cells, relative to its size.
const EXACT: f64 = 1e-6;
/// The most digits after the first that are told, however well a figure is known: people read no more, and conditions hold
/// to hardly more.
const MOST: i32 = 9;
/// Numbers below and from these powers of ten on are told by their power.
const PLAIN: std::ops::Range<i32> = -4..9;

fn power(v: f64) -> i32 {
    v.abs().log10().floor() as i32
}

/// A value, the last digit of the order of what it may be off by.
pub fn figure(value: f64, within: Option<f64>) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}").replace("-0", "0");
    }
    let within = within.filter(|w| w.is_finite() && *w > 0.0);
    let last = within.map_or(power(value) - DIGITS, |w| power(w).max(power(value) - MOST));
    if !PLAIN.contains(&power(value)) && last <= power(value) {
        return format!("{value:.*e}", (power(value) - last) as usize);
    }
    let text = match u32::try_from(last) {
        Err(_) => format!("{value:.*}", (-last) as usize),
        Ok(places) => {
            let unit = 10f64.powi(places as i32);
            format!("{:.0}", (value / unit).round() * unit)
        }
    };
    // Nothing is left of a value below what it may be off by, its sign neither.
    match text.strip_prefix('-') {
        Some(size) if size.chars().all(|c| c == '0' || c == '.') => size.to_string(),
        _ => text,
    }
}

/// The entries of a vector, all with the last digit of the largest: `(0.000, 26.070)`.
pub fn figures(values: &[f64], within: Option<f64>) -> String {
    let largest = values.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    let least = largest * 10f64.powi(-MOST);
    let within = within.map(|w| w.max(least)).filter(|w| *w > 0.0);
    let within = within.or((largest > 0.0).then(|| largest * 10f64.powi(-DIGITS)));
    let entries: Vec<String> = values.iter().map(|v| figure(*v, within)).collect();
    format!("({})", entries.join(", "))
}

/// A value with ± and its unit: `26.070 ± 9e-3 N`.
pub fn told(value: f64, within: Option<f64>, unit: &str) -> String {
    format!("{}{} {unit}", figure(value, within), error(value, within)).trim_end().to_string()
}

/// A value that is found without cells, with its unit: `1.570796 mm`.
pub fn exact(value: f64, unit: &str) -> String {
    format!("{} {unit}", figure(value, Some(EXACT * value.abs()))).trim_end().to_string()
}

/// A vector with ± and its unit: `(0, 26.070) ± 9e-3 N`.
pub fn told_vector(values: &[f64], within: Option<f64>, unit: &str) -> String {
    let largest = values.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    format!("{}{} {unit}", figures(values, within), error(largest, within)).trim_end().to_string()
}

/// The ± of a value, no smaller than its last digit.
fn error(value: f64, within: Option<f64>) -> String {
    let least = if value == 0.0 { 0.0 } else { 10f64.powi(power(value) - MOST) };
    within.filter(|w| *w > 0.0).map_or(String::new(), |w| format!(" ± {:.0e}", w.max(least)))
}
