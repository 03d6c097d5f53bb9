//! Measurements, the fit through them, and what is left.

use super::{Estimate, Measurements};
use crate::output::OutputError;
use crate::output::chart::{FONT, failed, label, svg};
use crate::output::pictures::{padded, range, rounded};
use plotters::prelude::*;

const MEASURED: RGBColor = RGBColor(31, 81, 140);
const FITTED: RGBColor = RGBColor(213, 60, 40);

pub(super) fn draw(measured: &Measurements, estimate: &Estimate) -> Result<String, OutputError> {
    let mut order: Vec<usize> = (0..measured.time.len()).collect();
    order.sort_by(|&i, &j| measured.time[i].total_cmp(&measured.time[j]));
    let x = range(measured.time.iter().copied());
    let series = |values: &[f64]| -> Vec<(f64, f64)> { order.iter().map(|&i| (measured.time[i], values[i])).collect() };
    let [points, line, left] = [&measured.value, &estimate.fitted, &estimate.residuals].map(|v| series(v));
    svg((820, 640), |root| {
        let (upper, lower) = root.split_vertically(410);
        let ends = [
            (&upper, range(points.iter().chain(&line).map(|p| p.1)), measured.names[1].as_str()),
            (&lower, range(left.iter().map(|p| p.1).chain([0.0])), "residual"),
        ];
        for (k, (part, y, name)) in ends.into_iter().enumerate() {
            let mut chart = ChartBuilder::on(part)
                .margin(12)
                .x_label_area_size(40)
                .y_label_area_size(80)
                .build_cartesian_2d(padded(x), padded(y))
                .map_err(failed)?;
            chart
                .configure_mesh()
                .light_line_style(WHITE)
                .x_desc(&measured.names[0])
                .y_desc(name)
                .x_label_formatter(&|v| label(rounded(*v, x.1 - x.0)))
                .y_label_formatter(&|v| label(rounded(*v, y.1 - y.0)))
                .label_style((FONT, 15))
                .draw()
                .map_err(failed)?;
            if k == 0 {
                chart.draw_series(LineSeries::new(line.iter().copied(), FITTED.stroke_width(2))).map_err(failed)?;
                chart.draw_series(points.iter().map(|p| Circle::new(*p, 4, MEASURED.filled()))).map_err(failed)?;
            } else {
                let zero = [(padded(x).start, 0.0), (padded(x).end, 0.0)];
                chart.draw_series(LineSeries::new(zero, FITTED.stroke_width(2))).map_err(failed)?;
                chart.draw_series(left.iter().map(|p| Circle::new(*p, 4, MEASURED.filled()))).map_err(failed)?;
            }
        }
        Ok(())
    })
}
