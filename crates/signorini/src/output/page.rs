//! What pictures of solids have in common: the page, the scale of colours and its bar.

use super::chart::{FONT, label, rounded, ticks, viridis};
use super::solid_fields::{SolidDisplay, SolidFields};
use plotters::style::RGBColor;
use signorini_geometry::Point;
use std::fmt::Write as _;

/// Width and height.
pub const SIZE: (f64, f64) = (900.0, 620.0);
/// Room to the left, for the title above, to the right for the colour bar, and below for the axes.
pub const MARGIN: [f64; 4] = [70.0, 52.0, 140.0, 64.0];
/// Place of bodies without stress on the colour map.
const AT_REST: f64 = 0.45;

/// Begins a page with a title.
pub fn start(title: &str) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\"><rect width=\"100%\" height=\"100%\" fill=\"white\"/>\
         <text x=\"{}\" y=\"28\" font-family=\"{FONT}\" font-size=\"19\" text-anchor=\"middle\">{title}</text>",
        SIZE.0,
        SIZE.1,
        0.5 * SIZE.0
    )
}

/// The left, top, right and bottom of what is between the margins.
pub fn room() -> [f64; 4] {
    [MARGIN[0], MARGIN[1], SIZE.0 - MARGIN[2], SIZE.1 - MARGIN[3]]
}

pub fn css(c: RGBColor) -> String {
    format!("rgb({},{},{})", c.0, c.1, c.2)
}

/// How values of a field become places on the colour map.
pub struct Scale {
    low: f64,
    high: f64,
    /// The largest value, which may be beyond the scale.
    largest: f64,
}

impl Scale {
    /// From the smallest to the largest value; singular corners do not take the whole scale for themselves.
    pub fn of(values: &[f64]) -> Self {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let (Some(&smallest), Some(&largest)) = (sorted.first(), sorted.last()) else {
            return Scale { low: 0.0, high: 0.0, largest: 0.0 };
        };
        let quantile = sorted[(0.997 * (sorted.len() - 1) as f64) as usize];
        // A field that is even but for rounding is shown as even.
        let even = largest - smallest <= 1e-9 * largest;
        let high = if largest > 1.5 * quantile { quantile } else { largest };
        Scale { low: if even { 0.0 } else { smallest }, high, largest }
    }

    /// From zero to a value.
    pub fn up_to(largest: f64) -> Self {
        Scale { low: 0.0, high: largest, largest }
    }

    /// Whether there is something to show at all.
    pub fn is_empty(&self) -> bool {
        self.largest <= 0.0
    }

    /// From 0 to 1.
    pub fn place(&self, value: f64) -> f64 {
        if self.is_empty() {
            return AT_REST;
        }
        ((value - self.low) / (self.high - self.low).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0)
    }

    /// A colour bar with round values, and the largest value where the scale ends before it.
    pub fn bar(&self, svg: &mut String, title: &str) {
        if self.is_empty() {
            return;
        }
        let (x, top, bottom) = (SIZE.0 - 105.0, 96.0, SIZE.1 - 90.0);
        const BANDS: usize = 128;
        for k in 0..BANDS {
            let (from, to) = (k as f64 / BANDS as f64, (k + 1) as f64 / BANDS as f64);
            let y = bottom + (top - bottom) * to;
            let colour = css(viridis(0.5 * (from + to)));
            let height = (bottom - top) * (to - from) + 0.6;
            let _ = write!(svg, "<rect x=\"{x}\" y=\"{y:.2}\" width=\"18\" height=\"{height:.2}\" fill=\"{colour}\"/>");
        }
        let span = self.high - self.low;
        for value in ticks(self.low, self.high, 6) {
            let y = bottom + (top - bottom) * (value - self.low) / span;
            let _ = write!(
                svg,
                "<path d=\"M{} {y:.2}h5\" stroke=\"#444\"/>\
                 <text x=\"{}\" y=\"{y:.2}\" font-family=\"{FONT}\" font-size=\"13\" dominant-baseline=\"central\">{}</text>",
                x + 18.0,
                x + 27.0,
                label(rounded(value, span))
            );
        }
        let _ = write!(
            svg,
            "<text x=\"{}\" y=\"{}\" font-family=\"{FONT}\" font-size=\"15\" text-anchor=\"middle\">{title}</text>",
            x + 18.0,
            top - 18.0
        );
        let most = format!("largest {}", three_digits(self.largest));
        let _ = write!(
            svg,
            "<text x=\"{}\" y=\"{}\" font-family=\"{FONT}\" font-size=\"13\" text-anchor=\"middle\">{most}</text>",
            x + 18.0,
            bottom + 22.0
        );
    }
}

/// Three digits.
fn three_digits(v: f64) -> String {
    if v == 0.0 {
        return "0".into();
    }
    let digits = (2 - v.abs().log10().floor() as i32).clamp(0, 6) as usize;
    if v.abs() >= 1e5 || v.abs() < 1e-3 { format!("{v:.2e}") } else { format!("{v:.digits$}") }
}

/// A round factor that makes displacements visible, or one.
pub fn magnification<const D: usize>(display: &SolidDisplay<D>, fields: &SolidFields<D>) -> f64 {
    let low = display.points.iter().fold(Point::<D>::repeat(f64::INFINITY), |l, x| l.inf(x));
    let high = display.points.iter().fold(Point::<D>::repeat(f64::NEG_INFINITY), |h, x| h.sup(x));
    let largest = fields.displacement.iter().map(|u| u.norm()).fold(0.0, f64::max);
    let wanted = 0.05 * (high - low).norm() / largest.max(f64::MIN_POSITIVE);
    if wanted < 2.0 || !wanted.is_finite() {
        return 1.0;
    }
    let power = 10f64.powf(wanted.log10().floor());
    [5.0, 2.0, 1.0].into_iter().map(|d| d * power).find(|m| *m <= wanted).unwrap_or(1.0)
}

/// What a picture of the stress is called.
pub fn stress_title(scale: &Scale, time: f64, factor: f64) -> String {
    let what = if scale.is_empty() { "Bodies at rest" } else { "Equivalent stress (von Mises)" };
    let magnified = if factor == 1.0 { String::new() } else { format!(", displacements × {factor}") };
    format!("{what}, t = {}{magnified}", label(time))
}
