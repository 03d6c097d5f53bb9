//! Load curves.

use crate::ImportError;
use crate::curve::{Curve, JUMP};
use crate::xml::{File, child, children, text};
use roxmltree::Node;
use std::collections::BTreeMap;

/// Load curves by their numbers; what is wrong with those that cannot be read is told where they are used.
pub(super) type Curves = BTreeMap<String, Result<Curve, ImportError>>;

/// All load curves of a file.
pub(super) fn read(file: &File, root: Node) -> Result<Curves, ImportError> {
    let mut out = Curves::new();
    for section in children(root, "LoadData") {
        for node in section.children().filter(|n| ["load_controller", "loadcurve"].contains(&n.tag_name().name())) {
            out.insert(file.attribute(node, "id")?.to_string(), curve(file, node));
        }
    }
    Ok(out)
}

fn curve(file: &File, node: Node) -> Result<Curve, ImportError> {
    let is_controller = node.tag_name().name() == "load_controller";
    let kind = node.attribute("type").unwrap_or("loadcurve");
    if is_controller && kind != "loadcurve" {
        return Err(
            file.wrong(node, format!("cannot be imported: a controller of type `{kind}`; valid is `loadcurve`"))
        );
    }
    // Version 2.5 has the interpolation as its type.
    let interpolate = match (is_controller, child(node, "interpolate")) {
        (true, Some(n)) => text(n),
        (true, None) => "LINEAR".to_string(),
        (false, _) => node.attribute("type").unwrap_or("linear").to_string(),
    };
    let extend = child(node, "extend").map_or_else(|| node.attribute("extend").unwrap_or("CONSTANT").to_string(), text);
    if !extend.eq_ignore_ascii_case("CONSTANT") {
        return Err(file.wrong(node, format!("cannot be imported: the extension {extend}; valid is CONSTANT")));
    }
    let mut points = Vec::new();
    for entry in node.descendants().filter(|n| ["pt", "point", "loadpoint"].contains(&n.tag_name().name())) {
        match file.numbers(entry)?[..] {
            [t, v] => points.push([t, v]),
            _ => return Err(file.wrong(entry, "expected a time and a value")),
        }
    }
    match interpolate.to_uppercase().as_str() {
        "LINEAR" => Ok(Curve::through(points)),
        // Through two points a smooth curve is a line.
        "SMOOTH" if points.len() <= 2 => Ok(Curve::through(points)),
        "STEP" => {
            let length = points.last().map_or(1.0, |p| p[0]) - points.first().map_or(0.0, |p| p[0]);
            let mut out = Curve::default();
            for (k, [t, v]) in points.iter().enumerate() {
                if let Some([before, _]) = k.checked_sub(1).map(|k| points[k]) {
                    out.push(before + JUMP * length, *v);
                }
                out.push(*t, *v);
            }
            Ok(out)
        }
        other => Err(file.wrong(
            node,
            format!(
                "cannot be imported: the interpolation {other} of {} points; valid are LINEAR and STEP",
                points.len()
            ),
        )),
    }
}

/// The value of an element with its load curve.
pub(super) fn value(file: &File, node: Node, curves: &Curves) -> Result<Curve, ImportError> {
    let factor = file.number(node)?;
    Ok(scale_of(file, node, curves)?.map_or_else(|| Curve::constant(factor), |curve| curve.scaled(factor)))
}

/// The load curve that an element names.
pub(super) fn scale_of(file: &File, node: Node, curves: &Curves) -> Result<Option<Curve>, ImportError> {
    let Some(id) = node.attribute("lc").filter(|id| *id != "0") else { return Ok(None) };
    match curves.get(id) {
        Some(Ok(curve)) => Ok(Some(curve.clone())),
        Some(Err(error)) => Err(error.clone()),
        None => Err(file.wrong(node, format!("there is no load curve {id}"))),
    }
}
