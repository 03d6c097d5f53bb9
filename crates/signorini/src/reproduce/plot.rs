//! Lines over axes that may be logarithmic, with a legend.

use crate::output::OutputError;
use crate::output::chart::{FONT, failed, label, padded, range, rounded, svg};
use crate::output::colours::{BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILION};
use plotters::prelude::*;

const COLORS: [RGBColor; 7] = [BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY, RGBColor(60, 60, 60)];

/// The drawing library knows whole units only: it draws that much larger than what is shown.
const FINE: u32 = 4;

/// A line.
pub struct Series {
    pub name: String,
    pub points: Vec<(f64, f64)>,
    /// Whether its points are marked.
    pub marked: bool,
}

/// Lines, and what their axes are.
pub struct Plot {
    pub title: String,
    pub x_name: &'static str,
    pub y_name: &'static str,
    /// Which of the axes are logarithmic.
    pub log: [bool; 2],
    /// Whether a unit is as long along both axes.
    pub square: bool,
    pub series: Vec<Series>,
}

impl Plot {
    /// The plot as SVG.
    ///
    /// # Errors
    /// A failure of the drawing library.
    pub fn draw(&self) -> Result<String, OutputError> {
        let scaled = |v: f64, log: bool| if log { v.log10() } else { v };
        let lines: Vec<Vec<(f64, f64)>> = self
            .series
            .iter()
            .map(|s| {
                let points = s.points.iter().map(|(x, y)| (scaled(*x, self.log[0]), scaled(*y, self.log[1])));
                points.filter(|(x, y)| x.is_finite() && y.is_finite()).collect()
            })
            .collect();
        let x = range(lines.iter().flatten().map(|p| p.0));
        let y = range(lines.iter().flatten().map(|p| p.1));
        let size = if self.square { (760, 760) } else { (860, 560) };
        let name = |v: f64, log: bool, span: f64| match log {
            false => label(rounded(v, span)),
            true if v.abs() < 3.5 && v > -0.5 => format!("{:.0}", 10f64.powf(v)),
            true if (v - v.round()).abs() < 1e-6 => format!("1e{}", v.round()),
            true => format!("{:.0e}", 10f64.powf(v)),
        };
        let text = svg((FINE * size.0, FINE * size.1), |root| {
            let mut chart = ChartBuilder::on(root)
                .margin(14 * FINE)
                .caption(&self.title, (FONT, 20 * FINE))
                .x_label_area_size(46 * FINE)
                .y_label_area_size(84 * FINE)
                .build_cartesian_2d(padded(x), padded(y))
                .map_err(failed)?;
            chart
                .configure_mesh()
                .light_line_style(WHITE)
                .bold_line_style(BLACK.mix(0.15).stroke_width(FINE))
                .axis_style(BLACK.stroke_width(FINE))
                .set_all_tick_mark_size(5 * FINE)
                .x_desc(self.x_name)
                .y_desc(self.y_name)
                .x_label_formatter(&|v| name(*v, self.log[0], x.1 - x.0))
                .y_label_formatter(&|v| name(*v, self.log[1], y.1 - y.0))
                .label_style((FONT, 15 * FINE))
                .draw()
                .map_err(failed)?;
            for (k, (series, points)) in self.series.iter().zip(&lines).enumerate() {
                let color = COLORS[k % COLORS.len()];
                let line = LineSeries::new(points.iter().copied(), color.stroke_width(2 * FINE));
                let drawn = chart.draw_series(line).map_err(failed)?;
                if !series.name.is_empty() {
                    let sample = move |(x, y)| {
                        PathElement::new([(x, y), (x + 22 * FINE as i32, y)], color.stroke_width(3 * FINE))
                    };
                    drawn.label(&series.name).legend(sample);
                }
                if series.marked {
                    let mark = |p: &(f64, f64)| Circle::new(*p, 4 * FINE, color.filled());
                    chart.draw_series(points.iter().map(mark)).map_err(failed)?;
                }
            }
            if self.series.iter().any(|s| !s.name.is_empty()) {
                chart
                    .configure_series_labels()
                    .position(emptiest_corner(&lines, x, y))
                    .legend_area_size(30 * FINE)
                    .margin(10 * FINE)
                    .background_style(WHITE.mix(0.85))
                    .border_style(BLACK.mix(0.3).stroke_width(FINE))
                    .label_font((FONT, 15 * FINE))
                    .draw()
                    .map_err(failed)?;
            }
            Ok(())
        })?;
        let drawn = format!("width=\"{}\" height=\"{}\"", FINE * size.0, FINE * size.1);
        Ok(text.replacen(&drawn, &format!("width=\"{}\" height=\"{}\"", size.0, size.1), 1))
    }
}

/// The corner of a chart that the lines pass least, for the legend.
fn emptiest_corner(lines: &[Vec<(f64, f64)>], x: (f64, f64), y: (f64, f64)) -> SeriesLabelPosition {
    let corners = [
        (SeriesLabelPosition::UpperRight, 1.0, 1.0),
        (SeriesLabelPosition::UpperLeft, 0.0, 1.0),
        (SeriesLabelPosition::LowerLeft, 0.0, 0.0),
        (SeriesLabelPosition::LowerRight, 1.0, 0.0),
    ];
    let near = |(_, cx, cy): &(SeriesLabelPosition, f64, f64)| {
        let relative = |v: f64, (lo, hi): (f64, f64)| (v - lo) / (hi - lo);
        // Lines are met between their points too.
        let along = lines.iter().flat_map(|l| l.windows(2)).flat_map(|w| {
            (0..10).map(move |k| {
                let t = f64::from(k) / 10.0;
                (w[0].0 + t * (w[1].0 - w[0].0), w[0].1 + t * (w[1].1 - w[0].1))
            })
        });
        along.filter(|p| (relative(p.0, x) - cx).abs() < 0.35 && (relative(p.1, y) - cy).abs() < 0.35).count()
    };
    corners.into_iter().min_by_key(near).map_or(SeriesLabelPosition::UpperRight, |c| c.0)
}
