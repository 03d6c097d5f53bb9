//! Zones as numbers.

use super::PlaneZone;
use crate::obstacle::Side;
use crate::zone::Stored;
use serde_json::{Value, json};
use signorini_fem::Grid;
use signorini_geometry::ClosedCurve;

impl Stored<2> for PlaneZone {
    fn to_json(&self) -> Value {
        let curves = self.sides.iter().zip(&self.curves).zip(&self.mode_counts).map(|((side, c), modes)| {
            json!({
                "above": *side == Side::Above, "degree": c.degree(), "modes": modes, "coefficients": c.coefficients(),
            })
        });
        json!({"cells": self.grid.cells(), "degree": self.grid.degree(), "curves": curves.collect::<Vec<_>>()})
    }

    fn from_json(grid: &Grid<2>, value: &Value) -> Option<Self> {
        let cells: [usize; 2] = serde_json::from_value(value["cells"].clone()).ok()?;
        let degree = value["degree"].as_u64().filter(|d| (1..=8).contains(d))? as usize;
        let finer = cells[0].checked_div(grid.cells()[0]).filter(|n| (1..=256).contains(n))?;
        if cells != grid.cells().map(|n| n * finer) {
            return None;
        }
        let curve = |v: &Value| {
            let coefficients: Vec<[f64; 2]> = serde_json::from_value(v["coefficients"].clone()).ok()?;
            let side = if v["above"].as_bool()? { Side::Above } else { Side::Below };
            let modes = v["modes"].as_u64().filter(|&m| (1..=coefficients.len() as u64).contains(&m))? as usize;
            Some(((side, ClosedCurve::from_coefficients(v["degree"].as_u64()? as usize, coefficients)?), modes))
        };
        let curves = value["curves"].as_array()?.iter().map(curve).collect::<Option<Vec<_>>>()?;
        let (curves, mode_counts) = curves.into_iter().unzip();
        Some(Self { mode_counts, ..Self::new(&Grid::new(*grid.bounds(), cells, degree), curves) })
    }
}
