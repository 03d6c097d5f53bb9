//! A state sampled for files and pictures, whatever method found it.

use crate::fields::Fields;
use crate::plan::MembranePlan;
use crate::report::vector;
use signorini_fem::CellShape;
use signorini_geometry::Point;
use signorini_membrane::domain::CellStatus;
use signorini_membrane::history::Sample;
use signorini_membrane::obstacle::Side;
use signorini_membrane::problem::Membrane;
use std::collections::HashMap;

/// Samples along the longer side of the domain that pictures and files aim at.
const RESOLUTION: usize = 200;

/// Points and cells for display: lines in one dimension, in two what follows the boundary.
#[derive(Clone, Debug)]
pub struct DisplayMesh<const D: usize> {
    pub points: Vec<Point<D>>,
    /// Two to four points each.
    pub cells: Vec<Vec<u32>>,
}

impl<const D: usize> DisplayMesh<D> {
    pub fn new(plan: &MembranePlan<D>, membrane: &Membrane<D>) -> Self {
        let cells = &*plan.cells;
        let bounds = plan.grid.bounds();
        let longest = plan.grid.cells().into_iter().max().unwrap_or(1);
        let fine = (RESOLUTION / longest).clamp(1, 8).max(cells.degree().min(3));
        let mut mesh = Self { points: Vec::new(), cells: Vec::new() };
        // Points of neighbouring cells agree to round-off.
        let key = |x: &Point<D>| -> [i64; D] {
            std::array::from_fn(|k| ((x[k] - bounds.min[k]) / bounds.size()[k] * 1e9).round() as i64)
        };
        let mut number: HashMap<[i64; D], Option<u32>> = HashMap::new();
        for cell in (0..cells.count()).filter(|&c| plan.domain.status[c] != CellStatus::Outside) {
            let whole = plan.domain.status[cell] == CellStatus::Inside;
            let reach = 1.5 * cells.bounds_of(cell).size().max() / fine as f64;
            let divided = cells.divided(cell, fine);
            let inside: Vec<bool> = divided.points.iter().map(|x| whole || membrane.contains(x)).collect();
            for part in divided.parts.iter().filter(|part| part.iter().any(|&i| inside[i])) {
                // Corners beyond the boundary are drawn onto it.
                let ids: Option<Vec<u32>> = part
                    .iter()
                    .map(|&i| {
                        let x = divided.points[i];
                        *number.entry(key(&x)).or_insert_with(|| {
                            let x = if inside[i] { x } else { plan.domain.domain.pulled_inside(&x, reach)? };
                            mesh.points.push(x);
                            Some(mesh.points.len() as u32 - 1)
                        })
                    })
                    .collect();
                mesh.cells.extend(ids);
            }
        }
        mesh
    }
}

/// Fields at the points of a display mesh, and the edge of the contact.
#[derive(Clone, Debug)]
pub struct Snapshot<const D: usize> {
    pub time: f64,
    pub displacement: Vec<f64>,
    pub gap: Vec<f64>,
    pub pressure: Vec<f64>,
    pub in_contact: Vec<bool>,
    /// Heights of what lies below and above, where there is something.
    pub floor: Option<Vec<f64>>,
    pub ceiling: Option<Vec<f64>>,
    pub outlines: Vec<Vec<Point<D>>>,
    /// Which of their points lie within the membrane: beyond a free edge fronts mean nothing.
    pub within: Vec<Vec<bool>>,
}

fn heights<const D: usize>(mesh: &DisplayMesh<D>, membrane: &Membrane<D>, side: Side) -> Option<Vec<f64>> {
    mesh.points.iter().map(|x| membrane.obstacles.at(side, x).map(|o| o.height.value(x))).collect()
}

impl<const D: usize> Snapshot<D> {
    /// The lines of the fronts within the membrane; the first point of a closed one is its last too.
    pub fn fronts(&self) -> Vec<Vec<Point<D>>> {
        let mut lines = Vec::new();
        for (outline, within) in self.outlines.iter().zip(&self.within) {
            let n = outline.len();
            // From a point beyond on, so that no line is cut where the list begins.
            let start = within.iter().position(|w| !w).unwrap_or(0);
            let mut line: Vec<Point<D>> = Vec::new();
            for k in (0..=n).map(|k| (start + k) % n.max(1)) {
                if within[k] {
                    line.push(outline[k]);
                } else if !line.is_empty() {
                    lines.push(std::mem::take(&mut line));
                }
            }
            lines.extend((!line.is_empty()).then_some(line));
        }
        lines
    }

    /// Whether there is anything to touch.
    pub fn has_obstacles(&self) -> bool {
        self.floor.is_some() || self.ceiling.is_some()
    }

    pub fn new(
        mesh: &DisplayMesh<D>,
        membrane: &Membrane<D>,
        time: f64,
        outlines: Vec<Vec<Point<D>>>,
        sample: impl Fn(&Point<D>) -> Option<Sample>,
    ) -> Self {
        let n = mesh.points.len();
        let mut snapshot = Self {
            time,
            displacement: Vec::with_capacity(n),
            gap: Vec::with_capacity(n),
            pressure: Vec::with_capacity(n),
            in_contact: Vec::with_capacity(n),
            floor: heights(mesh, membrane, Side::Below),
            ceiling: heights(mesh, membrane, Side::Above),
            within: outlines.iter().map(|o| o.iter().map(|x| membrane.contains(x)).collect()).collect(),
            outlines,
        };
        for x in &mesh.points {
            let s = sample(x).unwrap_or(Sample { displacement: 0.0, in_contact: false, pressure: 0.0 });
            let gap = membrane.obstacles.least_gap(x, s.displacement).0;
            snapshot.displacement.push(s.displacement);
            snapshot.gap.push(if gap.is_finite() { gap } else { 0.0 });
            snapshot.pressure.push(s.pressure);
            snapshot.in_contact.push(s.in_contact);
        }
        snapshot
    }

    /// The fields of the membrane by its name.
    pub fn to_fields(&self, name: &str, mesh: &DisplayMesh<D>) -> Fields {
        let shape = |corners: usize| match corners {
            2 => CellShape::Line,
            3 => CellShape::Triangle,
            _ => CellShape::Quadrilateral,
        };
        let fields = Fields {
            name: name.into(),
            points: mesh.points.iter().map(vector).collect(),
            cells: mesh.cells.iter().map(|list| (Some(shape(list.len())), list.clone())).collect(),
            arrays: Vec::new(),
        }
        .vector("displacement", self.displacement.iter().flat_map(|u| [0.0, 0.0, *u]).collect());
        if !self.has_obstacles() {
            return fields;
        }
        let fields = fields
            .scalar("gap", self.gap.clone())
            .scalar("contact_pressure", self.pressure.clone())
            .scalar("contact_status", self.in_contact.iter().map(|c| f64::from(u8::from(*c))).collect());
        [("floor", &self.floor), ("ceiling", &self.ceiling)].into_iter().fold(fields, |fields, (name, heights)| {
            match heights {
                Some(heights) => fields.scalar(name, heights.clone()),
                None => fields,
            }
        })
    }

    /// The edges of all zones: closed lines, points in one dimension.
    pub fn edges(&self) -> Fields {
        let mut fields = Fields { name: "contact".into(), ..Fields::default() };
        for outline in &self.outlines {
            let first = fields.points.len() as u32;
            fields.points.extend(outline.iter().map(vector));
            let n = outline.len() as u32;
            if D > 1 {
                let line = |k: u32| (Some(CellShape::Line), vec![first + k, first + (k + 1) % n]);
                fields.cells.extend((0..n).map(line));
            }
        }
        fields
    }
}
