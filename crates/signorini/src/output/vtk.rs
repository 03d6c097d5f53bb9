//! Files for ParaView and pyvista: VTU fields, VTP outlines, and the PVD that puts them in time.

use super::OutputError;
use crate::report::UnitNames;
use crate::snapshot::{DisplayMesh, Snapshot};
use signorini_geometry::Point;
use vtkio::model::{
    Attribute, Attributes, ByteOrder, CellType, Cells, DataSet, PolyDataPiece, UnstructuredGridPiece, Version,
    VertexNumbers, Vtk,
};
use vtkio::xml::Compressor;

/// Level of compression, of nine.
const LEVEL: u32 = 6;

/// A data set as an XML file, with the units of its fields where the case states any: as VTK's own `UNITS_LABEL`.
pub fn with_units(title: &str, data: DataSet, units: Option<&UnitNames>) -> Result<Vec<u8>, OutputError> {
    let bytes = to_bytes(title, data)?;
    let Some(units) = units else { return Ok(bytes) };
    let mut text = String::from_utf8(bytes).map_err(|e| OutputError::Picture(format!("VTK: {e}")))?;
    let of_fields = [
        ("displacement", &units.length),
        ("gap", &units.length),
        ("contact_pressure", &units.pressure),
        ("friction_traction", &units.pressure),
        ("slip", &units.length),
        ("wear", &units.length),
        ("stress_xx_yy_zz_xy_yz_xz", &units.pressure),
        ("von_mises", &units.pressure),
        ("temperature", &units.temperature),
        ("floor", &units.length),
        ("ceiling", &units.length),
        ("Points", &units.length),
    ];
    for (name, unit) in of_fields {
        let Some(start) = text.find(&format!("Name=\"{name}\"")) else { continue };
        let Some(end) = text[start..].find("</DataArray>") else { continue };
        let key = format!(
            "<InformationKey name=\"UNITS_LABEL\" location=\"vtkDataArray\">{}</InformationKey>",
            super::page::escaped(unit)
        );
        text.insert_str(start + end, &key);
    }
    Ok(text.into_bytes())
}

/// A data set as an XML file.
pub fn to_bytes(title: &str, data: DataSet) -> Result<Vec<u8>, OutputError> {
    let vtk =
        Vtk { version: Version::Auto, title: title.into(), byte_order: ByteOrder::LittleEndian, data, file_path: None };
    let mut bytes = Vec::new();
    vtk.write_xml(&mut bytes).map_err(|e| OutputError::Picture(format!("VTK: {e}")))?;
    Ok(bytes)
}

/// A data set as an XML file with its arrays compressed by zlib, which ParaView and pyvista read.
pub fn to_compressed_bytes(title: &str, data: DataSet) -> Result<Vec<u8>, OutputError> {
    let vtk =
        Vtk { version: Version::Auto, title: title.into(), byte_order: ByteOrder::LittleEndian, data, file_path: None };
    let fail = |e: &dyn std::fmt::Display| OutputError::Picture(format!("VTK: {e}"));
    let file = vtk.try_into_xml_format(Compressor::ZLib, LEVEL).map_err(|e| fail(&e))?;
    let mut bytes = Vec::new();
    file.write(&mut bytes).map_err(|e| fail(&e))?;
    Ok(bytes)
}

/// Coordinates with `z` as the third, or the second in one dimension too: the membrane is drawn deflected along z.
fn coordinates<const D: usize>(points: &[Point<D>], z: impl Fn(usize) -> f64) -> Vec<f64> {
    points.iter().enumerate().flat_map(|(i, p)| [p[0], if D > 1 { p[1] } else { 0.0 }, z(i)]).collect()
}

/// The fields of a state on the undeflected membrane.
pub fn fields<const D: usize>(
    mesh: &DisplayMesh<D>,
    s: &Snapshot<D>,
    units: Option<&UnitNames>,
) -> Result<Vec<u8>, OutputError> {
    let connectivity: Vec<u64> = mesh.cells.iter().flatten().map(|&i| u64::from(i)).collect();
    let offsets: Vec<u64> = mesh
        .cells
        .iter()
        .scan(0, |at, c| {
            *at += c.len() as u64;
            Some(*at)
        })
        .collect();
    let kind = |corners: &Vec<u32>| match corners.len() {
        2 => CellType::Line,
        3 => CellType::Triangle,
        _ => CellType::Quad,
    };
    let types = mesh.cells.iter().map(kind).collect();
    let scalar = |name: &str, values: Vec<f64>| Attribute::scalars(name, 1).with_data(values);
    let vector: Vec<f64> = s.displacement.iter().flat_map(|u| [0.0, 0.0, *u]).collect();
    let mut point = vec![Attribute::vectors("displacement").with_data(vector)];
    if s.has_obstacles() {
        point.push(scalar("gap", s.gap.clone()));
        point.push(scalar("contact_pressure", s.pressure.clone()));
        point.push(scalar("contact_status", s.in_contact.iter().map(|c| f64::from(u8::from(*c))).collect()));
    }
    for (name, heights) in [("floor", &s.floor), ("ceiling", &s.ceiling)] {
        point.extend(heights.as_ref().map(|heights| scalar(name, heights.clone())));
    }
    let piece = UnstructuredGridPiece {
        points: coordinates(&mesh.points, |_| 0.0).into(),
        cells: Cells { cell_verts: VertexNumbers::XML { connectivity, offsets }, types },
        data: Attributes { point, cell: Vec::new() },
    };
    with_units("membrane", DataSet::inline(piece), units)
}

/// The contact outlines as closed lines; points in one dimension.
pub fn outlines<const D: usize>(s: &Snapshot<D>) -> Result<Vec<u8>, OutputError> {
    let points: Vec<Point<D>> = s.outlines.iter().flatten().copied().collect();
    let mut connectivity = Vec::new();
    let mut offsets = Vec::new();
    let mut first = 0u64;
    for outline in &s.outlines {
        let n = outline.len() as u64;
        connectivity.extend(first..first + n);
        if D > 1 {
            connectivity.push(first);
        }
        offsets.push(connectivity.len() as u64);
        first += n;
    }
    let zone: Vec<f64> = s.outlines.iter().enumerate().flat_map(|(i, o)| vec![i as f64; o.len()]).collect();
    let piece = PolyDataPiece {
        points: coordinates(&points, |_| 0.0).into(),
        lines: Some(VertexNumbers::XML { connectivity, offsets }),
        data: Attributes { point: vec![Attribute::scalars("front", 1).with_data(zone)], cell: Vec::new() },
        ..PolyDataPiece::default()
    };
    to_bytes("contact", DataSet::inline(piece))
}

/// A collection of files in time.
pub fn collection(entries: &[(f64, String)]) -> String {
    let mut text = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n  <Collection>\n",
    );
    for (time, file) in entries {
        text += &format!("    <DataSet timestep=\"{time}\" part=\"0\" file=\"{file}\"/>\n");
    }
    text + "  </Collection>\n</VTKFile>\n"
}
