//! Files of a state of a system: its bodies, its contacts and its rigid bodies for ParaView, contacts as tables.

use super::OutputError;
use super::body_fields::STRESS;
use super::level::{CUBES, CUBES_IN_FILES};
use super::rigid;
use super::system::{RigidShown, SystemShown};
use super::vtk::with_units;
use crate::fields::{FieldArray, Fields};
use crate::plan::mechanics::MechanicsPlan;
use crate::report::UnitNames;
use signorini_fem::CellShape;
use signorini_mechanics::Samples;
use vtkio::model::{
    Attribute, Attributes, CellType, Cells, DataSet, Extent, ImageDataPiece, Piece, PolyDataPiece,
    UnstructuredGridPiece, VertexNumbers,
};

fn attributes(fields: &Fields) -> Vec<Attribute> {
    let attribute = |array: &FieldArray| match array.components {
        3 => Attribute::vectors(array.name).with_data(array.values.clone()),
        n => Attribute::scalars(array.name, n as u32).with_data(array.values.clone()),
    };
    fields.arrays.iter().map(attribute).collect()
}

fn topology<'a>(cells: impl Iterator<Item = &'a Vec<u32>> + Clone) -> VertexNumbers {
    let connectivity: Vec<u64> = cells.clone().flatten().map(|&k| u64::from(k)).collect();
    let offsets = cells
        .scan(0, |at, c| {
            *at += c.len() as u64;
            Some(*at)
        })
        .collect();
    VertexNumbers::XML { connectivity, offsets }
}

/// All bodies in one VTU; what a body does not have is zero there, and `body` tells them apart.
///
/// # Errors
/// What `vtkio` cannot write.
pub fn vtu(bodies: &[Fields], units: Option<&UnitNames>) -> Result<Vec<u8>, OutputError> {
    let mut all = Fields { name: "bodies".into(), ..Fields::default() };
    let mut body = Vec::new();
    for (number, fields) in bodies.iter().enumerate() {
        let (first, total) = (all.points.len(), all.points.len() + fields.points.len());
        all.points.extend(&fields.points);
        body.extend(std::iter::repeat_n(number as f64, fields.points.len()));
        let moved = |list: &[u32]| list.iter().map(|k| k + first as u32).collect::<Vec<_>>();
        all.cells.extend(fields.cells.iter().map(|(shape, list)| (*shape, moved(list))));
        for array in &fields.arrays {
            if !all.arrays.iter().any(|a| a.name == array.name) {
                let values = vec![0.0; first * array.components];
                all.arrays.push(FieldArray { name: array.name, components: array.components, values });
            }
        }
        for own in &mut all.arrays {
            match fields.arrays.iter().find(|a| a.name == own.name && a.components == own.components) {
                Some(array) => own.values.extend(&array.values),
                None => own.values.resize(total * own.components, 0.0),
            }
        }
    }
    let all = all.scalar("body", body);
    let kind = |shape: &Option<CellShape>| match shape {
        Some(CellShape::Line) => CellType::Line,
        Some(CellShape::Triangle) => CellType::Triangle,
        Some(CellShape::Quadrilateral) => CellType::Quad,
        Some(CellShape::Hexahedron) => CellType::Hexahedron,
        Some(CellShape::Tetrahedron) => CellType::Tetra,
        Some(CellShape::Wedge) => CellType::Wedge,
        None => CellType::Polygon,
    };
    let piece = UnstructuredGridPiece {
        points: all.points.iter().flatten().copied().collect::<Vec<f64>>().into(),
        cells: Cells {
            cell_verts: topology(all.cells.iter().map(|c| &c.1)),
            types: all.cells.iter().map(|c| kind(&c.0)).collect(),
        },
        data: Attributes { point: attributes(&all), cell: Vec::new() },
    };
    with_units("bodies", DataSet::inline(piece), units)
}

/// A body in the equal boxes of an image as a VTI, values in the boxes.
///
/// # Errors
/// What `vtkio` cannot write.
pub fn vti(samples: &Samples, units: Option<&UnitNames>) -> Result<Vec<u8>, OutputError> {
    let attribute = |(name, components, values): &(String, usize, Vec<f64>)| {
        let name = if name == STRESS[0] { STRESS[1] } else { name };
        match components {
            3 => Attribute::vectors(name).with_data(values.clone()),
            n => Attribute::scalars(name, *n as u32).with_data(values.clone()),
        }
    };
    let extent = Extent::Ranges(samples.counts.map(|n| 0..=n as i32));
    let piece = ImageDataPiece {
        extent: extent.clone(),
        data: Attributes { point: Vec::new(), cell: samples.data.iter().map(attribute).collect() },
    };
    // Boxes without extent along z would have no size there.
    let spacing = samples.spacing.map(|h| if h > 0.0 { h as f32 } else { 1.0 });
    let data = DataSet::ImageData {
        extent,
        origin: samples.origin.map(|x| x as f32),
        spacing,
        meta: None,
        pieces: vec![Piece::Inline(Box::new(piece))],
    };
    with_units("volume", data, units)
}

/// The tested points of a contact as a VTP, with the faces between them where there are some.
///
/// # Errors
/// What `vtkio` cannot write.
pub fn vtp(fields: &Fields, units: Option<&UnitNames>) -> Result<Vec<u8>, OutputError> {
    let mut piece = PolyDataPiece {
        points: fields.points.iter().flatten().copied().collect::<Vec<f64>>().into(),
        data: Attributes { point: attributes(fields), cell: Vec::new() },
        ..PolyDataPiece::default()
    };
    if fields.cells.is_empty() {
        let single: Vec<Vec<u32>> = (0..fields.points.len() as u32).map(|k| vec![k]).collect();
        piece.verts = Some(topology(single.iter()));
    } else {
        let cells = Some(topology(fields.cells.iter().map(|c| &c.1)));
        let are_lines = fields.cells.iter().all(|c| c.0 == Some(CellShape::Line));
        *(if are_lines { &mut piece.lines } else { &mut piece.polys }) = cells;
    }
    with_units("contact", DataSet::inline(piece), units)
}

/// The tested points of a contact as a table, a line each.
pub fn csv(fields: &Fields) -> String {
    let mut head = vec!["x".to_string(), "y".into(), "z".into()];
    for array in &fields.arrays {
        match array.components {
            3 => head.extend(["x", "y", "z"].map(|c| format!("{}_{c}", array.name))),
            _ => head.push(array.name.to_string()),
        }
    }
    let mut text = head.join(",") + "\n";
    for (k, x) in fields.points.iter().enumerate() {
        let mut line: Vec<String> = x.iter().map(f64::to_string).collect();
        for array in &fields.arrays {
            let own = &array.values[k * array.components..(k + 1) * array.components];
            line.extend(own.iter().map(|v| if v.is_finite() { v.to_string() } else { String::new() }));
        }
        text += &(line.join(",") + "\n");
    }
    text
}

/// The names and VTP files of the rigid bodies, around what is shown.
///
/// # Errors
/// What `vtkio` cannot write.
pub fn rigid_files(plan: &MechanicsPlan, shown: &SystemShown) -> Result<Vec<(String, Vec<u8>)>, OutputError> {
    let in_space = plan.space == crate::problem::Space::ThreeD;
    let mut room = shown.room();
    if !in_space {
        room.iter_mut().for_each(|x| x.z = 0.0);
    }
    let file = |body: &RigidShown| {
        let file = if in_space {
            let (points, _, triangles) = body.surface(room, if body.is_free { CUBES_IN_FILES } else { CUBES });
            rigid::in_space(&points, &triangles)
        } else {
            rigid::in_plane(body.gap.as_ref(), room)
        };
        Ok((body.name.clone(), file?))
    };
    shown.rigid.iter().map(file).collect()
}
