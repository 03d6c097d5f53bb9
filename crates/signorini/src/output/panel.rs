//! Charts of curves, in fractions of a pixel: axes with round ticks, lines, areas, dots, marks and a key.

use super::chart::{FONT, label, rounded_range, tick_labels, ticks};
use super::page::{Sign, clip_to, css, escaped, text_width};
use plotters::style::RGBColor;
use std::fmt::Write as _;

/// Room to the left of a chart for its ticks and name, above, to the right, and below.
const MARGIN: [f64; 4] = [92.0, 12.0, 24.0, 52.0];

/// Ranges as small as this are those of zeros alone.
const ZERO: f64 = 1e-150;

/// An axis: what it shows from where to where.
pub struct Axis<'a> {
    pub name: &'a str,
    pub range: (f64, f64),
    /// Whether equal lengths are equal factors.
    pub log: bool,
    /// Words at 0, 1, … in place of numbers.
    pub words: &'a [String],
}

impl<'a> Axis<'a> {
    /// From one value to another.
    pub fn new(name: &'a str, range: (f64, f64)) -> Self {
        Axis { name, range, log: false, words: &[] }
    }

    /// A little beyond both values, where variations below those of rounding are none.
    pub fn around(name: &'a str, range: (f64, f64)) -> Self {
        let (low, high) = rounded_range(range);
        let pad = 0.05 * (high - low);
        Axis { name, range: (low - pad, high + pad), log: false, words: &[] }
    }

    /// From zero to a little above the largest value, or from a little below the smallest to zero, or both.
    pub fn from_zero(name: &'a str, (low, high): (f64, f64)) -> Self {
        let (low, high) = match (low.min(0.0), high.max(0.0)) {
            // Of nothing but zeros.
            (low, high) if high - low <= ZERO => (0.0, 1.0),
            range => rounded_range(range),
        };
        let pad = 0.06 * (high - low);
        let low = if low < 0.0 { low - pad } else { low };
        Axis { name, range: (low, if high > 0.0 { high + pad } else { high }), log: false, words: &[] }
    }

    /// With words at 0, 1, … in place of numbers.
    pub fn of_words(name: &'a str, words: &'a [String]) -> Self {
        Axis { name, range: (-0.5, words.len() as f64 - 0.5), log: false, words }
    }

    /// A share of the way along the axis.
    pub fn place(&self, v: f64) -> f64 {
        let (low, high) = self.range;
        if self.log { (v / low).ln() / (high / low).ln() } else { (v - low) / (high - low) }
    }

    /// Ticks, about one per 70 units of the page, with their names.
    pub fn ticks(&self, length: f64) -> Vec<(f64, String)> {
        let (low, high) = self.range;
        let wanted = (length / 70.0) as usize;
        if !self.words.is_empty() {
            // Of words too long for their room the end tells more than the beginning.
            let room = (length / self.words.len() as f64 / 7.5) as usize;
            let name = |word: &String| match word.chars().count() {
                count if count > room.max(4) => {
                    format!("…{}", word.chars().skip(count + 1 - room.max(4)).collect::<String>())
                }
                _ => word.clone(),
            };
            return self.words.iter().enumerate().map(|(k, word)| (k as f64, escaped(&name(word)))).collect();
        }
        if !self.log {
            // One tick alone tells no scale.
            let enough = (wanted..wanted + 4).map(|n| ticks(low, high, n)).find(|values| values.len() > 1);
            let values = enough.unwrap_or_else(|| ticks(low, high, wanted));
            let names = tick_labels(&values);
            return values.into_iter().zip(names).collect();
        }
        let (from, to) = ((low.log10() - 1e-9).ceil() as i32, (high.log10() + 1e-9).floor() as i32);
        // Within a decade or two the powers of ten alone are too few.
        if to - from < 2 {
            let all = (from - 1..=to).flat_map(|k| [1.0, 2.0, 5.0].map(|d| d * 10f64.powi(k)));
            let values: Vec<f64> = all.filter(|v| *v >= low * (1.0 - 1e-9) && *v <= high * (1.0 + 1e-9)).collect();
            return values.into_iter().map(|v| (v, label(v))).collect();
        }
        let every = ((to - from) as usize / wanted.max(1)).max(1);
        let name = |k: i32| if (0..4).contains(&k) { format!("{}", 10i32.pow(k as u32)) } else { format!("1e{k}") };
        (from..=to).step_by(every).map(|k| (10f64.powi(k), name(k))).collect()
    }
}

/// How dots are filled.
#[derive(Clone, Copy, PartialEq)]
pub enum Dots {
    Full,
    Open,
}

/// A chart that is being drawn.
pub struct Panel<'a> {
    svg: &'a mut String,
    area: [f64; 4],
    x: Axis<'a>,
    y: Axis<'a>,
    /// Where curves are on the page, so that the key can be elsewhere.
    taken: Vec<(f64, f64)>,
}

impl<'a> Panel<'a> {
    /// Axes in a part of a page: left, top, right and bottom, names and ticks included.
    pub fn new(svg: &'a mut String, part: [f64; 4], x: Axis<'a>, y: Axis<'a>) -> Self {
        let area = [part[0] + MARGIN[0], part[1] + MARGIN[1], part[2] - MARGIN[2], part[3] - MARGIN[3]];
        let [left, top, right, bottom] = area;
        let (mut grid, mut texts) = (String::new(), String::new());
        for (v, name) in x.ticks(right - left) {
            let at = left + (right - left) * x.place(v);
            let _ = write!(grid, "M{at:.2} {bottom:.1}V{top:.1}");
            let _ =
                write!(texts, "<text x=\"{at:.2}\" y=\"{:.1}\" text-anchor=\"middle\">{name}</text>", bottom + 19.0);
        }
        let mut widest = 0.0f64;
        for (v, name) in y.ticks(1.4 * (bottom - top)) {
            let at = bottom + (top - bottom) * y.place(v);
            let _ = write!(grid, "M{left:.1} {at:.2}H{right:.1}");
            let _ = write!(
                texts,
                "<text x=\"{:.1}\" y=\"{at:.2}\" text-anchor=\"end\" dominant-baseline=\"central\">{name}</text>",
                left - 8.0
            );
            widest = widest.max(text_width(&name, 14.0));
        }
        let _ = write!(svg, "<path d=\"{grid}\" fill=\"none\" stroke=\"#ddd\" stroke-width=\"1\"/>");
        let _ = write!(
            svg,
            "<path d=\"M{left:.1} {top:.1}V{bottom:.1}H{right:.1}\" fill=\"none\" stroke=\"#333\" stroke-width=\"1.2\"/>\
             <g font-family=\"{FONT}\" font-size=\"14\">{texts}</g>"
        );
        let (middle, centre) = (0.5 * (left + right), 0.5 * (top + bottom));
        let beside = left - 22.0 - widest;
        let _ = write!(
            svg,
            "<g font-family=\"{FONT}\" font-size=\"15\" text-anchor=\"middle\"><text x=\"{middle:.1}\" y=\"{:.1}\">{}</text>\
             <text transform=\"translate({beside:.1} {centre:.1}) rotate(-90)\">{}</text></g>",
            bottom + 41.0,
            escaped(x.name),
            escaped(y.name)
        );
        Panel { svg, area, x, y, taken: Vec::new() }
    }

    /// Where a point is on the page.
    pub fn at(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let [left, top, right, bottom] = self.area;
        (left + (right - left) * self.x.place(x), bottom + (top - bottom) * self.y.place(y))
    }

    fn path(&self, points: &[(f64, f64)]) -> String {
        let place = |p: &(f64, f64)| {
            let (x, y) = self.at(*p);
            // Far outside is outside.
            let [left, top, right, bottom] = self.area;
            let bound = |v: f64, low: f64, high: f64| v.clamp(low - 1e4, high + 1e4);
            format!("{:.2} {:.2}", bound(x, left, right), bound(y, top, bottom))
        };
        points.iter().map(place).collect::<Vec<_>>().join("L")
    }

    fn inside(&mut self, draw: impl FnOnce(&Self) -> String) {
        let element = draw(self);
        clip_to(self.svg, self.area);
        *self.svg += &element;
        *self.svg += "</g>";
    }

    /// A curve.
    pub fn line(&mut self, points: &[(f64, f64)], sign: Sign, width: f64) {
        if points.is_empty() {
            return;
        }
        let (colour, dashes) = match sign {
            Sign::Dashes(c) => (c, " stroke-dasharray=\"6 5\""),
            Sign::Area(c) | Sign::Line(c) | Sign::Dot(c) | Sign::Ring(c) => (c, ""),
        };
        self.inside(|panel| {
            format!(
                "<path d=\"M{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{width}\" stroke-linejoin=\"round\"{dashes}/>",
                panel.path(points),
                css(colour)
            )
        });
        // Curves are met between their points too.
        let places: Vec<(f64, f64)> = points.iter().map(|p| self.at(*p)).collect();
        for pair in places.windows(2) {
            let along = |t: f64| (pair[0].0 + t * (pair[1].0 - pair[0].0), pair[0].1 + t * (pair[1].1 - pair[0].1));
            let count = (((pair[1].0 - pair[0].0).hypot(pair[1].1 - pair[0].1) / 15.0) as usize).clamp(1, 50);
            self.taken.extend((0..count).map(|k| along(k as f64 / count as f64)));
        }
        self.taken.extend(places.last());
    }

    /// What is between a curve and a height.
    pub fn fill(&mut self, points: &[(f64, f64)], base: f64, colour: RGBColor, opacity: f64) {
        let (Some(first), Some(last)) = (points.first(), points.last()) else { return };
        let (from, to) = ((first.0, base), (last.0, base));
        self.inside(|panel| {
            format!(
                "<path d=\"M{}L{}L{}Z\" fill=\"{}\" fill-opacity=\"{opacity}\"/>",
                panel.path(&[from]),
                panel.path(points),
                panel.path(&[to]),
                css(colour)
            )
        });
    }

    /// Dots at points.
    pub fn dots(&mut self, points: &[(f64, f64)], colour: RGBColor, radius: f64, dots: Dots) {
        let fill = if dots == Dots::Full { css(colour) } else { "white".into() };
        for p in points {
            let (x, y) = self.at(*p);
            let _ = write!(
                self.svg,
                "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{radius}\" fill=\"{fill}\" stroke=\"{}\" stroke-width=\"1.4\"/>",
                css(colour)
            );
            self.taken.push((x, y));
        }
    }

    /// An arrow from one point to another.
    pub fn arrow(&mut self, from: (f64, f64), to: (f64, f64), colour: RGBColor) {
        self.line(&[from, to], Sign::Line(colour), 1.4);
        let (a, b) = (self.at(from), self.at(to));
        let length = (b.0 - a.0).hypot(b.1 - a.1);
        if length > 8.0 {
            let (x, y) = ((b.0 - a.0) / length, (b.1 - a.1) / length);
            let back = |side: f64| (b.0 - 9.0 * x - 4.0 * side * y, b.1 - 9.0 * y + 4.0 * side * x);
            let (l, r) = (back(1.0), back(-1.0));
            let _ = write!(
                self.svg,
                "<path d=\"M{:.2} {:.2}L{:.2} {:.2}L{:.2} {:.2}Z\" fill=\"{}\"/>",
                b.0,
                b.1,
                l.0,
                l.1,
                r.0,
                r.1,
                css(colour)
            );
        }
    }

    /// A vertical line at a value, with a short text above it.
    pub fn mark(&mut self, x: f64, text: &str, colour: RGBColor) {
        let (at, _) = self.at((x, self.y.range.0));
        let [_, top, _, bottom] = self.area;
        let _ = write!(
            self.svg,
            "<path d=\"M{at:.2} {bottom:.1}V{top:.1}\" stroke=\"{0}\" stroke-width=\"1\" stroke-dasharray=\"3 3\"/>\
             <text x=\"{at:.2}\" y=\"{1:.1}\" font-family=\"{FONT}\" font-size=\"12\" fill=\"{0}\" text-anchor=\"middle\">{2}</text>",
            css(colour),
            top - 3.0,
            escaped(text)
        );
    }

    /// The key, in the corner of the chart that curves pass least.
    pub fn key(&mut self, entries: &[(Sign, String)]) {
        if entries.is_empty() {
            return;
        }
        let [left, top, right, bottom] = self.area;
        let width = 48.0 + entries.iter().map(|e| text_width(&e.1, 14.0)).fold(0.0, f64::max);
        let height = 20.0 * entries.len() as f64 + 8.0;
        let corners = [
            (right - width - 8.0, top + 8.0),
            (left + 8.0, top + 8.0),
            (right - width - 8.0, bottom - height - 8.0),
            (left + 8.0, bottom - height - 8.0),
            (0.5 * (left + right - width), top + 8.0),
            (0.5 * (left + right - width), bottom - height - 8.0),
        ];
        let met = |(x, y): &(f64, f64)| {
            let within =
                |p: &&(f64, f64)| p.0 > x - 6.0 && p.0 < x + width + 6.0 && p.1 > y - 6.0 && p.1 < y + height + 6.0;
            self.taken.iter().filter(within).count()
        };
        let Some((x, y)) = corners.into_iter().min_by_key(met) else { return };
        let _ = write!(
            self.svg,
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" fill=\"white\" fill-opacity=\"0.85\" stroke=\"#bbb\"/>"
        );
        for (k, (sign, text)) in entries.iter().enumerate() {
            let line = y + 14.0 + 20.0 * k as f64;
            sign.draw(self.svg, x + 8.0, line);
            let _ = write!(
                self.svg,
                "<text x=\"{:.1}\" y=\"{line:.1}\" font-family=\"{FONT}\" font-size=\"14\" dominant-baseline=\"central\">{}</text>",
                x + 38.0,
                escaped(text)
            );
        }
    }
}
