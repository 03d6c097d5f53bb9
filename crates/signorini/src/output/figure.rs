//! Numbers as people read them: with the digits that they have.

/// Decimals of a figure of which nobody knows how far it may be off.
const UNKNOWN: i32 = 6;
/// The most decimals.
const MOST: i32 = 9;

/// A value, with no more digits than what it may be off by leaves it: the last is of the order of that.
pub fn figure(value: f64, within: Option<f64>) -> String {
    let last = |within: f64| (-within.log10().floor()) as i32;
    let decimals = within.filter(|w| w.is_finite() && *w > 0.0).map_or(UNKNOWN, |w| last(w).min(MOST));
    if decimals >= 0 {
        return format!("{value:.*}", decimals as usize);
    }
    let unit = 10f64.powi(-decimals);
    // Zero has no sign.
    format!("{:.0}", (value / unit).round() * unit + 0.0)
}

#[cfg(test)]
mod tests {
    use super::figure;

    #[test]
    fn no_digit_is_told_that_a_figure_does_not_have() {
        assert_eq!(figure(11835.258326101, Some(5e-2)), "11835.26");
        assert_eq!(figure(11835.258326101, Some(30.0)), "11840");
        assert_eq!(figure(236.705166520, Some(1e-3)), "236.705");
        assert_eq!(figure(-0.5, Some(30.0)), "0");
        assert_eq!(figure(1.25, None), "1.250000");
        assert_eq!(figure(1.25, Some(0.0)), "1.250000");
        assert_eq!(figure(1.0 / 3.0, Some(1e-14)), "0.333333333");
    }
}
