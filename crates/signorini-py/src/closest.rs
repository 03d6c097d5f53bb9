//! Closest points of many pairs.

use crate::errors::{Failure, apart};
use crate::results::{numbers, reals, wholes};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use rayon::prelude::*;
use signorini::queries::{self, Query};
use signorini_geometry::Point;
use signorini_geometry::closest::{Certificate, Foot, Projection, Uniqueness, closest, signed_gap};
use signorini_geometry::shape::Shape;
use std::path::Path;

/// Pairs answered between two looks at the signals.
const BATCH: usize = 4096;

/// Partners of pairs: points as bytes, or texts of shapes. One alone is the partner of all others.
fn partners(py: Python<'_>, stated: &Bound<'_, PyAny>, side: &str, folder: &Path) -> PyResult<Vec<Shape>> {
    if let Ok(bytes) = stated.cast::<PyBytes>() {
        let words = bytes.as_bytes().chunks_exact(8).map(|word| <[u8; 8]>::try_from(word).unwrap_or_default());
        let values: Vec<f64> = words.map(f64::from_le_bytes).collect();
        return Ok(values.chunks_exact(3).map(|x| Shape::Point(Point::<3>::from_column_slice(x))).collect());
    }
    let texts: Vec<String> = stated.extract()?;
    let alone = texts.len() == 1;
    let build = |(k, text): (usize, &String)| {
        let path = if alone { side.to_string() } else { format!("{side}[{k}]") };
        queries::shape(text, folder).map_err(|error| Failure::from(error.within(&path)))
    };
    apart(py, || texts.par_iter().enumerate().map(build).collect())
}

/// The closest points of `a[k]` and `b[k]`; a partner that stands alone belongs to all pairs.
///
/// # Errors
/// Shapes that are wrong, by the path of their field; numbers of partners that do not fit.
#[pyfunction]
pub fn closest_points<'py>(
    py: Python<'py>,
    a: &Bound<'py, PyAny>,
    b: &Bound<'py, PyAny>,
    folder: &str,
    local_minima: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let folder = Path::new(folder);
    let (a, b) = (partners(py, a, "a", folder)?, partners(py, b, "b", folder)?);
    let count = if a.len() == 1 { b.len() } else { a.len() };
    if b.len() != 1 && b.len() != count {
        return Err(PyValueError::new_err(format!(
            "{} shapes `a` and {} shapes `b`: give one, or as many",
            a.len(),
            b.len()
        )));
    }
    let query = Query { local_minima, ..Query::default() };
    let pair = |k: usize| (&a[if a.len() == 1 { 0 } else { k }], &b[if b.len() == 1 { 0 } else { k }]);
    let mut found: Vec<(Projection, Option<f64>)> = Vec::with_capacity(count);
    while found.len() < count {
        py.check_signals()?;
        let batch = found.len()..count.min(found.len() + BATCH);
        let answers: Vec<_> = apart(py, || {
            let answer = |k: usize| {
                let (a, b) = pair(k);
                let projection = closest(a, b, &query);
                let gap = signed_gap(&projection.closest, b);
                (projection, gap)
            };
            Ok(batch.into_par_iter().map(answer).collect())
        })?;
        found.extend(answers);
    }
    answers(py, &found)
}

fn answers<'py>(py: Python<'py>, found: &[(Projection, Option<f64>)]) -> PyResult<Bound<'py, PyDict>> {
    let out = PyDict::new(py);
    let real = |of: &dyn Fn(&Projection) -> f64| reals(py, &found.iter().map(|(p, _)| of(p)).collect::<Vec<_>>());
    let whole = |of: &dyn Fn(&Projection) -> i64| wholes(py, &found.iter().map(|(p, _)| of(p)).collect::<Vec<_>>());
    let vector =
        |of: &dyn Fn(&Projection) -> [f64; 3]| reals(py, &found.iter().flat_map(|(p, _)| of(p)).collect::<Vec<_>>());
    out.set_item("distance", real(&|p| p.closest.distance)?)?;
    out.set_item("gap", numbers(py, found.iter().map(|(_, gap)| gap.unwrap_or(f64::NAN)), f64::to_le_bytes)?)?;
    out.set_item("point_a", vector(&|p| p.closest.a.point.into())?)?;
    out.set_item("point_b", vector(&|p| p.closest.b.point.into())?)?;
    out.set_item("normal", vector(&|p| p.closest.direction().map_or([f64::NAN; 3], Into::into))?)?;
    let parameters = |foot: &Foot| {
        let given = foot.parameters();
        [0, 1].map(|k| given.get(k).copied().unwrap_or(f64::NAN))
    };
    let both =
        |of: &dyn Fn(&Projection) -> [f64; 2]| reals(py, &found.iter().flat_map(|(p, _)| of(p)).collect::<Vec<_>>());
    out.set_item("parameters_a", both(&|p| parameters(&p.closest.a))?)?;
    out.set_item("parameters_b", both(&|p| parameters(&p.closest.b))?)?;
    out.set_item("element_a", whole(&|p| p.closest.a.element as i64)?)?;
    out.set_item("element_b", whole(&|p| p.closest.b.element as i64)?)?;
    out.set_item("lambda_min", real(&|p| p.closest.lambda_min)?)?;
    out.set_item("certified", whole(&|p| i64::from(p.certificate == Certificate::Complete))?)?;
    out.set_item("certified_to", real(&|p| p.certified_to)?)?;
    let word = |of: &dyn Fn(&Projection) -> String| found.iter().map(|(p, _)| of(p)).collect::<Vec<_>>();
    out.set_item("feature_a", word(&|p| p.closest.a.feature.kind.to_string()))?;
    out.set_item("feature_b", word(&|p| p.closest.b.feature.kind.to_string()))?;
    out.set_item("uniqueness", word(&|p| uniqueness(p.uniqueness).into()))?;
    let others: Vec<i64> = found.iter().map(|(p, _)| p.others.len() as i64).collect();
    out.set_item("others", wholes(py, &others)?)?;
    let listed = |of: &dyn Fn(&signorini_geometry::closest::ClosestPair) -> [f64; 3]| {
        reals(py, &found.iter().flat_map(|(p, _)| &p.others).flat_map(of).collect::<Vec<_>>())
    };
    out.set_item("others_a", listed(&|pair| pair.a.point.into())?)?;
    out.set_item("others_b", listed(&|pair| pair.b.point.into())?)?;
    let distances: Vec<f64> = found.iter().flat_map(|(p, _)| &p.others).map(|pair| pair.distance).collect();
    out.set_item("others_distance", reals(py, &distances)?)?;
    Ok(out)
}

fn uniqueness(found: Uniqueness) -> &'static str {
    match found {
        Uniqueness::Unique => "unique",
        Uniqueness::Multiple => "multiple",
        Uniqueness::Continuum { .. } => "continuum",
        Uniqueness::NearContinuum { .. } => "near-continuum",
    }
}
