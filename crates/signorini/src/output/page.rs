//! What all pictures have in common: the page, the scale of colours and its bar, the key, and several pictures on a sheet.

use super::chart::{FONT, tick_labels, ticks, viridis};
use plotters::style::RGBColor;
use std::fmt::Write as _;

/// Width and height of pages whose size nothing else says.
pub const SIZE: (f64, f64) = (900.0, 620.0);
/// Room to the left, for the title above, to the right for the colour bar, and below for the axes and the key.
pub const MARGIN: [f64; 4] = [84.0, 66.0, 140.0, 88.0];
/// The most that what is drawn of the plane takes on its page, along either side, and the least.
const MOST: [f64; 2] = [640.0, 560.0];
const LEAST: [f64; 2] = [300.0, 150.0];
/// Place of bodies without stress on the colour map.
const AT_REST: f64 = 0.45;
/// What is nearer to zero than this part of a scale is shown as zero.
const NOTHING: f64 = 1e-3;
/// Variations below this part of the size of what varies are those of rounding, and shown as none.
pub const ROUNDING: f64 = 1e-9;

/// The most width for the caption of a colour bar, beside what is drawn.
const CAPTION: f64 = 110.0;

pub fn css(c: RGBColor) -> String {
    format!("rgb({},{},{})", c.0, c.1, c.2)
}

/// A text as it is written into an SVG.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}

/// How something is shown, for keys.
#[derive(Clone, Copy)]
pub enum Sign {
    Area(RGBColor),
    Line(RGBColor),
    Dashes(RGBColor),
    Dot(RGBColor),
    Ring(RGBColor),
}

impl Sign {
    /// Draws it, 22 wide, left of its text on the line `y`.
    pub fn draw(self, svg: &mut String, x: f64, y: f64) {
        let middle = x + 11.0;
        let _ = match self {
            Sign::Area(c) => write!(
                svg,
                "<rect x=\"{x:.1}\" y=\"{:.1}\" width=\"22\" height=\"12\" fill=\"{}\" stroke=\"#555\"/>",
                y - 6.0,
                css(c)
            ),
            Sign::Line(c) => write!(svg, "<path d=\"M{x:.1} {y:.1}h22\" stroke=\"{}\" stroke-width=\"3\"/>", css(c)),
            Sign::Dashes(c) => write!(
                svg,
                "<path d=\"M{x:.1} {y:.1}h22\" stroke=\"{}\" stroke-width=\"2\" stroke-dasharray=\"5 4\"/>",
                css(c)
            ),
            Sign::Dot(c) => write!(svg, "<circle cx=\"{middle:.1}\" cy=\"{y:.1}\" r=\"4.5\" fill=\"{}\"/>", css(c)),
            Sign::Ring(c) => write!(
                svg,
                "<circle cx=\"{middle:.1}\" cy=\"{y:.1}\" r=\"4\" fill=\"white\" stroke=\"{}\" stroke-width=\"1.5\"/>",
                css(c)
            ),
        };
    }
}

/// A page that is being drawn.
pub struct Page {
    pub svg: String,
    pub size: (f64, f64),
}

impl Page {
    /// A page with a title and, smaller, what else the picture says of itself.
    pub fn new(size: (f64, f64), title: &str, note: &str) -> Self {
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.0}\" height=\"{:.0}\"><rect width=\"100%\" height=\"100%\" fill=\"white\"/>",
            size.0, size.1
        );
        for (text, y, font) in [(title, 28.0, 19), (note, 48.0, 13)] {
            if !text.is_empty() {
                let _ = write!(
                    svg,
                    "<text x=\"{:.0}\" y=\"{y}\" font-family=\"{FONT}\" font-size=\"{font}\" text-anchor=\"middle\">{}</text>",
                    0.5 * size.0,
                    escaped(text)
                );
            }
        }
        Page { svg, size }
    }

    /// The size of a page for a part of the plane, as large as it can be drawn with one scale for both directions.
    pub fn size_for(extent: [f64; 2]) -> (f64, f64) {
        Self::size_within(extent, MOST)
    }

    /// The same where it takes no more than this along either side.
    pub fn size_within(extent: [f64; 2], most: [f64; 2]) -> (f64, f64) {
        let scale = (most[0] / extent[0]).min(most[1] / extent[1]);
        let room = [0, 1].map(|k| (extent[k] * scale).clamp(LEAST[k], most[k]));
        (room[0] + MARGIN[0] + MARGIN[2], room[1] + MARGIN[1] + MARGIN[3])
    }

    /// The left, top, right and bottom of what is between the margins.
    pub fn room(&self) -> [f64; 4] {
        [MARGIN[0], MARGIN[1], self.size.0 - MARGIN[2], self.size.1 - MARGIN[3]]
    }

    /// Adds what the signs in the picture mean, along its lower edge.
    pub fn key(&mut self, entries: &[(Sign, String)]) {
        let (mut x, mut y) = (MARGIN[0], self.size.1 - 16.0);
        for (sign, text) in entries {
            let width = 44.0 + text_width(text, 14.0);
            if x + width > self.size.0 && x > MARGIN[0] {
                (x, y) = (MARGIN[0], y - 18.0);
            }
            sign.draw(&mut self.svg, x, y);
            let _ = write!(
                self.svg,
                "<text x=\"{:.1}\" y=\"{y:.1}\" font-family=\"{FONT}\" font-size=\"14\" dominant-baseline=\"central\">{}</text>",
                x + 29.0,
                escaped(text)
            );
            x += width;
        }
    }

    /// Adds a colour bar with round values, and the ends of the values.
    pub fn bar(&mut self, scale: &Scale, title: &str) {
        if scale.is_empty() {
            return;
        }
        let [_, top, right, bottom] = self.room();
        let (x, top, bottom) = (right + 38.0, top + 36.0, bottom - 26.0);
        let svg = &mut self.svg;
        const BANDS: usize = 128;
        for k in 0..BANDS {
            let (from, to) = (k as f64 / BANDS as f64, (k + 1) as f64 / BANDS as f64);
            let y = bottom + (top - bottom) * to;
            let colour = css(viridis(0.5 * (from + to)));
            let height = (bottom - top) * (to - from) + if k == 0 { 0.0 } else { 0.6 };
            let _ = write!(svg, "<rect x=\"{x}\" y=\"{y:.2}\" width=\"18\" height=\"{height:.2}\" fill=\"{colour}\"/>");
        }
        let span = scale.high - scale.low;
        let values = ticks(scale.low, scale.high, ((bottom - top) / 60.0) as usize);
        for (value, name) in values.iter().zip(tick_labels(&values)) {
            let y = bottom + (top - bottom) * (value - scale.low) / span;
            let _ = write!(
                svg,
                "<path d=\"M{} {y:.2}h5\" stroke=\"#444\"/>\
                 <text x=\"{}\" y=\"{y:.2}\" font-family=\"{FONT}\" font-size=\"13\" dominant-baseline=\"central\">{name}</text>",
                x + 18.0,
                x + 27.0,
            );
        }
        let mut text = |y: f64, size: u32, content: &str| {
            let _ = write!(
                svg,
                "<text x=\"{}\" y=\"{y:.1}\" font-family=\"{FONT}\" font-size=\"{size}\" text-anchor=\"middle\">{content}</text>",
                x + 24.0,
            );
        };
        // A caption that is too wide has its unit on a line of its own.
        match title.rsplit_once(" [").filter(|_| text_width(title, 15.0) > CAPTION) {
            Some((name, unit)) => {
                text(top - 30.0, 15, &escaped(name));
                text(top - 13.0, 15, &format!("[{}", escaped(unit)));
            }
            None => text(top - 20.0, 15, &escaped(title)),
        }
        let ends = scale.ends;
        text(bottom + 20.0, 13, &format!("largest {}", three_digits(ends[1])));
        if ends[0].abs() > NOTHING * (ends[1] - ends[0]) && ends[0] < ends[1] {
            text(bottom + 37.0, 13, &format!("smallest {}", three_digits(ends[0])));
        }
    }

    /// The finished picture.
    pub fn finish(self) -> String {
        self.svg + "</svg>\n"
    }
}

/// About how wide a text is.
pub fn text_width(text: &str, size: f64) -> f64 {
    0.53 * size * text.chars().count() as f64
}

/// How values of a field become places on the colour map.
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    low: f64,
    high: f64,
    /// The least and the largest value, which may be beyond the scale.
    ends: [f64; 2],
}

impl Scale {
    /// From the smallest to the largest value that is defined; singular corners do not take the whole scale for themselves.
    pub fn of(values: &[f64]) -> Self {
        let mut sorted: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        let (Some(&smallest), Some(&largest)) = (sorted.first(), sorted.last()) else {
            return Scale { low: 0.0, high: 0.0, ends: [0.0; 2] };
        };
        let quantile = sorted[(0.997 * (sorted.len() - 1) as f64) as usize];
        // A field that is even but for rounding is shown as even.
        let even = largest - smallest <= ROUNDING * largest;
        let high = if largest > 1.5 * quantile { quantile } else { largest };
        Scale { low: if even { 0.0 } else { smallest }, high, ends: [if even { 0.0 } else { smallest }, largest] }
    }

    /// Between two values, where those that differ by less than rounding of `size` makes them differ are shown as even.
    pub fn between(low: f64, high: f64, size: f64) -> Self {
        let size = size.max(low.abs()).max(high.abs()).max(f64::MIN_POSITIVE.sqrt());
        if high - low > ROUNDING * size {
            // Colours do not tell ends from zero that are nearly there.
            let [low, high] = [low, high].map(|v| if v.abs() < NOTHING * (high - low) { 0.0 } else { v });
            return Scale { low, high, ends: [low, high] };
        }
        let even = if high.abs() <= ROUNDING * size { 0.0 } else { high };
        let (low, high) = if even == 0.0 { (0.0, size) } else { (even.min(0.0), even.max(0.0)) };
        Scale { low, high, ends: [even, even] }
    }

    /// Between two values that somebody chose; the least and the largest value may be beyond them.
    pub fn chosen([low, high]: [f64; 2], ends: [f64; 2]) -> Self {
        Scale { low, high, ends }
    }

    /// The same colours for values with other ends: those of what is drawn.
    #[must_use]
    pub fn with_ends(self, ends: [f64; 2]) -> Self {
        Scale { ends, ..self }
    }

    /// The values of both ends of the colour map.
    pub fn range(&self) -> [f64; 2] {
        [self.low, self.high]
    }

    /// The least and the largest value.
    pub fn ends(&self) -> [f64; 2] {
        self.ends
    }

    /// What holds for the values of both.
    pub fn with(&self, other: &Self) -> Self {
        let ends = [self.ends[0].min(other.ends[0]), self.ends[1].max(other.ends[1])];
        Scale { low: self.low.min(other.low), high: self.high.max(other.high), ends }
    }

    /// Whether there is something to show at all.
    pub fn is_empty(&self) -> bool {
        self.high <= self.low
    }

    /// From 0 to 1.
    pub fn place(&self, value: f64) -> f64 {
        if self.is_empty() {
            return AT_REST;
        }
        let place = (value - self.low) / (self.high - self.low);
        // What is not defined is where it grew beyond all bounds.
        if place.is_finite() { place.clamp(0.0, 1.0) } else { 1.0 }
    }
}

/// Three digits.
pub fn three_digits(v: f64) -> String {
    if v == 0.0 {
        return "0".into();
    }
    let digits = (2 - v.abs().log10().floor() as i32).clamp(0, 6) as usize;
    if v.abs() >= 1e5 || v.abs() < 1e-3 { format!("{v:.2e}") } else { format!("{v:.digits$}") }
}

/// Several pictures on one sheet, in rows of two that are equally wide; three in the last row where one would be left over.
pub fn sheet(pictures: &[String]) -> String {
    const WIDTH: f64 = 1520.0;
    // The first line of a picture states its size.
    let size = |text: &str| -> Option<(f64, f64)> {
        let number = |key: &str| text.split_once(key)?.1.split('"').next()?.parse::<f64>().ok();
        Some((number("width=\"")?, number("height=\"")?))
    };
    let sized: Vec<(&String, (f64, f64))> = pictures.iter().filter_map(|p| Some((p, size(p)?))).collect();
    let (mut body, mut y, mut rest) = (String::new(), 0.0, &sized[..]);
    while !rest.is_empty() {
        let count = if rest.len() == 3 { 3 } else { rest.len().min(2) };
        let (row, after) = rest.split_at(count);
        rest = after;
        // As high as lets the row fill its width.
        let height = WIDTH.min(900.0 * count as f64) / row.iter().map(|(_, (w, h))| w / h).sum::<f64>();
        let mut x = 0.0;
        for (text, (w, h)) in row {
            let inner = text.split_once('>').and_then(|(_, rest)| rest.rsplit_once("</svg>")).map_or("", |(t, _)| t);
            let width = height * w / h;
            let _ = write!(
                body,
                "<svg x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" viewBox=\"0 0 {w} {h}\">{inner}</svg>"
            );
            x += width;
        }
        y += height;
    }
    format!(
        "<svg width=\"{WIDTH}\" height=\"{y:.0}\" viewBox=\"0 0 {WIDTH} {y:.0}\" xmlns=\"http://www.w3.org/2000/svg\" \
         xmlns:xlink=\"http://www.w3.org/1999/xlink\"><rect width=\"100%\" height=\"100%\" fill=\"white\"/>{body}</svg>\n"
    )
}

/// Begins a group of which nothing outside an area is drawn; `</g>` ends it.
pub fn clip_to(svg: &mut String, area: [f64; 4]) {
    let [left, top, right, bottom] = area;
    // Named by what it is, so that several pictures on a sheet have the same only for the same area.
    let name = area.map(|v| format!("{v:.1}").replace('.', "p")).join("_");
    let _ = write!(
        svg,
        "<clipPath id=\"c{name}\"><rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{:.1}\" height=\"{:.1}\"/></clipPath>\
         <g clip-path=\"url(#c{name})\">",
        right - left,
        bottom - top
    );
}
