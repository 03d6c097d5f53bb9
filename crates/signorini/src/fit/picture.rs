//! Measurements, the fit through them, and what is left.

use super::{Estimate, Measurements};
use crate::output::OutputError;
use crate::output::chart::{Axes, axes, failed, padded, range, svg};
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
            let mut chart = axes(part, &Axes { x, y, x_name: &measured.names[0], y_name: name })?;
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
