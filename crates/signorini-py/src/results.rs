//! Results as values of Python: texts, numbers as bytes that NumPy reads.

use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyBytes, PyDict, PyList};
use signorini::fields::{Fields, ShownState};
use signorini::output::Files;

/// Numbers as bytes, little end first.
pub fn numbers<'py, T: Copy, const N: usize>(
    py: Python<'py>,
    values: impl ExactSizeIterator<Item = T>,
    bytes: impl Fn(T) -> [u8; N],
) -> PyResult<Bound<'py, PyByteArray>> {
    PyByteArray::new_with(py, values.len() * N, |place| {
        place.chunks_exact_mut(N).zip(values).for_each(|(place, value)| place.copy_from_slice(&bytes(value)));
        Ok(())
    })
}

/// Real numbers as bytes.
pub fn reals<'py>(py: Python<'py>, values: &[f64]) -> PyResult<Bound<'py, PyByteArray>> {
    numbers(py, values.iter().copied(), f64::to_le_bytes)
}

/// Whole numbers as bytes.
pub fn wholes<'py>(py: Python<'py>, values: &[i64]) -> PyResult<Bound<'py, PyByteArray>> {
    numbers(py, values.iter().copied(), i64::to_le_bytes)
}

/// Files by their names.
pub fn files(py: Python<'_>, files: Files) -> PyResult<Bound<'_, PyDict>> {
    let out = PyDict::new(py);
    files.into_iter().try_for_each(|(name, content)| out.set_item(name, PyBytes::new(py, &content)))?;
    Ok(out)
}

/// The states of a run.
pub fn states<'py>(py: Python<'py>, states: &[ShownState]) -> PyResult<Bound<'py, PyList>> {
    let list = PyList::empty(py);
    for state in states {
        let out = PyDict::new(py);
        out.set_item("time", state.time)?;
        out.set_item("bodies", all(py, &state.bodies)?)?;
        out.set_item("contacts", all(py, &state.contacts)?)?;
        list.append(out)?;
    }
    Ok(list)
}

fn all<'py>(py: Python<'py>, list: &[Fields]) -> PyResult<Bound<'py, PyList>> {
    let out = PyList::empty(py);
    list.iter().try_for_each(|fields| out.append(one(py, fields)?))?;
    Ok(out)
}

fn one<'py>(py: Python<'py>, fields: &Fields) -> PyResult<Bound<'py, PyDict>> {
    let out = PyDict::new(py);
    let points: Vec<f64> = fields.points.iter().flatten().copied().collect();
    let corners: Vec<i64> = fields.cells.iter().flat_map(|(_, nodes)| nodes).map(|n| i64::from(*n)).collect();
    let ends = fields.cells.iter().scan(0, |end, (_, nodes)| {
        *end += nodes.len() as i64;
        Some(*end)
    });
    let offsets: Vec<i64> = std::iter::once(0).chain(ends).collect();
    out.set_item("name", &fields.name)?;
    out.set_item("points", reals(py, &points)?)?;
    out.set_item("connectivity", wholes(py, &corners)?)?;
    out.set_item("offsets", wholes(py, &offsets)?)?;
    let shapes: Vec<String> =
        fields.cells.iter().map(|(shape, _)| shape.map_or("Polygon".into(), |s| format!("{s:?}"))).collect();
    out.set_item("shapes", shapes)?;
    let arrays = PyDict::new(py);
    for array in &fields.arrays {
        arrays.set_item(array.name, (array.components, reals(py, &array.values)?))?;
    }
    out.set_item("arrays", arrays)?;
    Ok(out)
}
