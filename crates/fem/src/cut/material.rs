//! The partition that an implicit body makes: material (region 1) and the rest (region 0).

use super::partition::CellPartition;
use signorini_geometry::ImplicitShape;
use signorini_geometry::implicit::{Complement, ImplicitBody};

/// The shapes of a body as sheets, and its inside as a Boolean of their signs: edges are integrated as well as faces.
pub fn material<const D: usize>(body: &ImplicitBody<D>) -> CellPartition<'_, D> {
    let mut sheets: Vec<Box<dyn ImplicitShape<D> + '_>> = Vec::new();
    let signs = signs(body, true, &mut sheets);
    let tags = vec![0; sheets.len()];
    CellPartition {
        sheets,
        tags,
        features: Vec::new(),
        region: Box::new(move |_, values| u32::from(signs.holds(values))),
    }
}

/// The Boolean of signs, with complements at the shapes only: every sheet is negative on its material side, so that a
/// surface on a side between two cells belongs to the cell with the material.
fn signs<'a, const D: usize>(
    body: &'a ImplicitBody<D>,
    positive: bool,
    sheets: &mut Vec<Box<dyn ImplicitShape<D> + 'a>>,
) -> Signs {
    match body {
        ImplicitBody::Shape(shape) => {
            sheets.push(if positive { Box::new(&**shape) } else { Box::new(Complement(&**shape)) });
            Signs::Negative(sheets.len() - 1)
        }
        ImplicitBody::Complement(part) => signs(part, !positive, sheets),
        ImplicitBody::Union(parts) | ImplicitBody::Intersection(parts) => {
            let any = matches!(body, ImplicitBody::Union(_)) == positive;
            let parts = parts.iter().map(|p| signs(p, positive, sheets)).collect();
            if any { Signs::Any(parts) } else { Signs::All(parts) }
        }
    }
}

/// A Boolean of the signs of sheets.
enum Signs {
    Negative(usize),
    Any(Vec<Signs>),
    All(Vec<Signs>),
}

impl Signs {
    fn holds(&self, values: &[f64]) -> bool {
        match self {
            Signs::Negative(sheet) => values[*sheet] < 0.0,
            Signs::Any(parts) => parts.iter().any(|p| p.holds(values)),
            Signs::All(parts) => parts.iter().all(|p| p.holds(values)),
        }
    }
}
