//! Bodies given by functions, as queries write them.

use super::fields::{FieldError, Fields};
use crate::expression::{Names, Scope, parse};
use serde_json::Value;
use signorini_geometry::grid_spline::GridSpline;
use signorini_geometry::implicit::{Function, ImplicitBody, Offset};
use signorini_geometry::implicit_surface::ImplicitSurface;
use signorini_geometry::jet::{Jet, Real};
use signorini_geometry::{Aabb, Point};
use std::sync::Arc;

/// How deep bodies may be nested.
const DEEPEST: usize = 16;

/// A body: `{"value": EXPRESSION}`, `{"union": [...]}`, `{"intersection": [...]}`, `{"difference": [A, B]}`,
/// `{"offset": BODY, "distance": d}` or `{"grid": {...}}`.
pub(super) fn implicit(
    path: &str,
    value: &Value,
    bounds: &Aabb<3>,
    cells: usize,
    depth: usize,
) -> Result<ImplicitBody<3>, FieldError> {
    let mut f = Fields::new(path, value)?;
    if depth > DEEPEST {
        return Err(FieldError { path: path.into(), message: format!("nested more than {DEEPEST} deep") });
    }
    const KINDS: [&str; 5] = ["value", "union", "intersection", "difference", "offset"];
    let kind = KINDS.into_iter().chain(["grid"]).find(|k| f.object.contains_key(*k));
    let parts = |f: &mut Fields<'_>, key: &'static str| -> Result<Vec<ImplicitBody<3>>, FieldError> {
        let entry = f.object.get(key).ok_or_else(|| f.error(key, "missing"))?;
        f.taken.push(key);
        let array = f.array_of(key, entry)?;
        if array.is_empty() {
            return Err(f.error(key, "empty"));
        }
        array
            .iter()
            .enumerate()
            .map(|(k, v)| implicit(&f.error(&format!("{key}[{k}]"), "").path, v, bounds, cells, depth + 1))
            .collect()
    };
    let body = match kind {
        Some("value") => {
            let text = f.text("value")?;
            let names = Names { variables: vec!["x", "y", "z"], ..Default::default() };
            let expression = parse(text, &names).map_err(|e| f.error("value", format!("`{text}`: {}", e.message)))?;
            let level = move |x: &Point<3>| {
                let position = [0, 1, 2].map(|k| Jet::<3>::variable(x[k], k));
                expression.evaluate(&Scope { position, time: Jet::<3>::constant(0.0) })
            };
            Function(level).into()
        }
        Some("union") => ImplicitBody::Union(parts(&mut f, "union")?),
        Some("intersection") => ImplicitBody::Intersection(parts(&mut f, "intersection")?),
        Some("difference") => {
            let two = parts(&mut f, "difference")?;
            let [a, b] = <[ImplicitBody<3>; 2]>::try_from(two)
                .map_err(|t| f.error("difference", format!("{} bodies instead of 2", t.len())))?;
            a.without(b)
        }
        Some("offset") => {
            let inner = f.required("offset")?;
            let distance = f.number("distance")?;
            let body = implicit(&f.error("offset", "").path, inner, bounds, cells, depth + 1)?;
            let surface = ImplicitSurface::new(body, *bounds, cells).map_err(|e| f.shape_error(&e))?;
            Offset { shape: Arc::new(surface), distance }.into()
        }
        Some("grid") => {
            let grid = f.required("grid")?;
            let mut g = Fields::new(&f.error("grid", "").path, grid)?;
            let (origin, spacing, count) = (g.point("origin")?, g.numbers("spacing")?, g.numbers("count")?);
            let spacing: [f64; 3] = g.fixed("spacing", spacing)?;
            let count: [f64; 3] = g.fixed("count", count)?;
            if count.iter().any(|n| n.fract() != 0.0 || !(4.0..=2000.0).contains(n)) {
                return Err(g.error("count", format!("{count:?}, not whole numbers from 4 to 2000")));
            }
            let values = g.numbers("values")?;
            let field =
                GridSpline::new(origin, spacing, count.map(|n| n as usize), values).map_err(|e| g.shape_error(&e))?;
            g.finish(&[])?;
            field.into()
        }
        _ => {
            return Err(FieldError {
                path: path.into(),
                message: format!("one of {}, expected grid", KINDS.join(", ")),
            });
        }
    };
    f.finish(&[])?;
    Ok(body)
}
