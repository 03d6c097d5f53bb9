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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_digit_is_told_that_a_figure_does_not_have() {
        assert_eq!(figure(11835.258326101, Some(5e-2)), "11835.26");
        assert_eq!(figure(11835.258326101, Some(30.0)), "11840");
        assert_eq!(figure(236.705166520, Some(1e-3)), "236.705");
        assert_eq!(figure(-0.5, Some(30.0)), "0");
        assert_eq!(figure(1.25, None), "1.250");
        assert_eq!(figure(1.25, Some(0.0)), "1.250");
        assert_eq!(figure(1.0 / 3.0, Some(1e-11)), "0.3333333333");
        assert_eq!(figure(1e-9, Some(1e-3)), "0.000");
        assert_eq!(figure(-1e-9, Some(1e-3)), "0.000");
        assert_eq!(figure(0.0, None), "0");
    }

    #[test]
    fn small_and_large_numbers_keep_their_digits() {
        assert_eq!(figure(1.2345678e-8, None), "1.235e-8");
        assert_eq!(figure(1.2345678e-8, Some(2e-10)), "1.23e-8");
        assert_eq!(figure(2.5e12, None), "2.500e12");
        assert_eq!(figure(-3.25e-3, None), "-0.003250");
        assert_eq!(figure(f64::NAN, None), "NaN");
        assert_eq!(told(26.0704, Some(9e-3), "N"), "26.070 ± 9e-3 N");
        assert_eq!(figures(&[-2e-16, 28.4182, -3e-2], None), "(0.00, 28.42, -0.03)");
        assert_eq!(figures(&[0.0, 26.0704], Some(9e-3)), "(0, 26.070)");
        assert_eq!(told_vector(&[0.0, -1e-3], Some(4e-17), "N"), "(0, -0.001000000000) ± 1e-12 N");
        assert_eq!(told(1.10557280900, Some(2e-12), ""), "1.105572809 ± 1e-9");
        assert_eq!(exact(std::f64::consts::PI, "mm"), "3.141593 mm");
        assert_eq!(exact(0.0, "mm"), "0 mm");
        assert_eq!(told(1.5, None, ""), "1.500");
    }
}
