//! A curve as it is shown: smooth elements are cut into straight pieces.

use crate::centreline::{Centreline, Closure, Continuity};
use signorini_mechanics::body::BodyFields;

/// Pieces into which a smooth element is cut.
const PIECES: usize = 4;

fn pieces(line: &Centreline) -> usize {
    match line.continuity {
        Continuity::C0 => 1,
        Continuity::C1 => PIECES,
    }
}

/// Points, displacements and cells of a curve, with the number of the element of each cell and the length along the curve.
pub fn of_curve(line: &Centreline, start: &[f64], now: &[f64]) -> BodyFields {
    let count = pieces(line);
    let mut fields = BodyFields::default();
    let mut arc = Vec::new();
    let mut put = |e: usize, k: usize| {
        let xi = k as f64 / count as f64;
        let reference = line.jet(start, e, xi).x;
        fields.points.push(reference);
        fields.displacement.push(line.jet(now, e, xi).x - reference);
        arc.push(line.arc(e, xi));
    };
    for e in 0..line.elements() {
        (0..count).for_each(|k| put(e, k));
    }
    if line.closure == Closure::Open {
        put(line.elements() - 1, count);
    }
    let points = fields.points.len() as u32;
    let cells = (line.elements() * count) as u32;
    fields.cells = (0..cells).map(|k| vec![k, (k + 1) % points]).collect();
    fields.point_data.push(("arc_length".to_string(), 1, arc));
    add_element_data(&mut fields, "element", 1, (0..line.elements()).map(|e| e as f64).collect());
    fields
}

/// Adds values along the elements, each by its number and `ξ`, as values of points: at nodes the mean of both sides.
pub fn add_point_data(
    fields: &mut BodyFields,
    (line, name, components): (&Centreline, &str, usize),
    of: impl Fn(usize, f64) -> Vec<f64>,
) {
    let count = pieces(line);
    let points = fields.points.len();
    let mut sums = vec![0.0; points * components];
    let mut counts = vec![0.0; points];
    for e in 0..line.elements() {
        for k in 0..=count {
            let point = (e * count + k) % points;
            counts[point] += 1.0;
            let values = of(e, k as f64 / count as f64);
            values.iter().enumerate().for_each(|(i, v)| sums[point * components + i] += v);
        }
    }
    let values = sums.iter().enumerate().map(|(k, sum)| sum / counts[k / components]).collect();
    fields.point_data.push((name.to_string(), components, values));
}

/// A polynomial through values at points.
pub fn through<const N: usize>(points: [f64; N], values: [f64; N], xi: f64) -> f64 {
    let weight =
        |k: usize| (0..N).filter(|j| *j != k).map(|j| (xi - points[j]) / (points[k] - points[j])).product::<f64>();
    (0..N).map(|k| weight(k) * values[k]).sum()
}

/// Adds values of elements as values of the cells that show them.
pub fn add_element_data(fields: &mut BodyFields, name: &str, components: usize, values: Vec<f64>) {
    let count = fields.cells.len() * components / values.len().max(1);
    let of_cells = values.chunks(components).flat_map(|v| std::iter::repeat_n(v.to_vec(), count)).flatten().collect();
    fields.cell_data.push((name.to_string(), components, of_cells));
}
