//! Coefficients of constant and linear fields.
//!
//! The product functions of vertices span all fields that are linear in each direction, on refined cells too. A function of
//! a level vanishes at the vertices of coarser ones, so that its coefficient is the field at its vertex less what coarser
//! functions already make there.

use crate::body::CellBody;
use crate::space::Tabulation;
use signorini_geometry::Point;

/// Coefficients of the functions of a body.
pub(super) struct LinearFields<const D: usize> {
    /// Of the field that is one.
    pub one: Vec<f64>,
    /// Of the reference position.
    pub position: Vec<Point<D>>,
}

impl<const D: usize> LinearFields<D> {
    pub fn new(body: &CellBody<D>) -> Self {
        let n = body.function_count();
        let mut out = LinearFields { one: vec![0.0; n], position: vec![Point::<D>::zeros(); n] };
        let mut is_known = vec![false; n];
        let mut t = Tabulation::default();
        for (number, cell) in body.cells().iter().enumerate() {
            // Those of coarser levels come first.
            for (place, (mode, f)) in cell.modes.iter().zip(&cell.functions).enumerate() {
                let f = *f as usize;
                if is_known[f] || mode.factors.iter().any(|k| *k > 1) {
                    continue;
                }
                let x = body.position(f);
                body.functions_at(number, &x, &mut t);
                let (mut one, mut position) = (1.0, x);
                for ((coarser, g), value) in cell.modes[..place].iter().zip(&cell.functions).zip(&t.value) {
                    if coarser.mode.level < mode.mode.level {
                        one -= out.one[*g as usize] * value;
                        position -= out.position[*g as usize] * *value;
                    }
                }
                (out.one[f], out.position[f]) = (one, position);
                is_known[f] = true;
            }
        }
        out
    }
}
