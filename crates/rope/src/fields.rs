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

/// Adds values of elements as values of the cells that show them.
pub fn add_element_data(fields: &mut BodyFields, name: &str, components: usize, values: Vec<f64>) {
    let count = fields.cells.len() * components / values.len().max(1);
    let of_cells = values.chunks(components).flat_map(|v| std::iter::repeat_n(v.to_vec(), count)).flatten().collect();
    fields.cell_data.push((name.to_string(), components, of_cells));
}
