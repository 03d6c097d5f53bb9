//! Meshes of VTK's unstructured grids (`.vtu`).
//!
//! Points and cells are counted from zero, as VTK does. An array of integers at the cells or points makes a group of each of its
//! values, `NAME=VALUE`; cells of one dimension less make groups of sides.

mod raw;

use crate::ImportError;
use crate::deck::{Deck, Element};
use crate::element::Kind;
use std::collections::BTreeMap;
use std::path::Path;
use vtkio::IOBuffer;
use vtkio::model::{Attribute, CellType, DataSet, Piece, UnstructuredGridPiece, Version};

/// Reads the mesh of a file.
pub(crate) fn read(file: &Path) -> Result<Deck, ImportError> {
    let wrong = |message: String| ImportError::new(file, None, message);
    let unreadable = |reason: String| wrong(format!("cannot be read as an unstructured grid of VTK: {reason}"));
    let bytes = std::fs::read(file).map_err(|e| wrong(format!("cannot be read: {e}")))?;
    let bytes = raw::in_base64(bytes).map_err(unreadable)?;
    let vtk = vtkio::Vtk::parse_xml(&bytes[..]).map_err(|e| unreadable(e.to_string()))?;
    let DataSet::UnstructuredGrid { pieces, .. } = vtk.data else {
        return Err(unreadable("it holds other data".into()));
    };
    let mut pieces: Vec<Piece<UnstructuredGridPiece>> = pieces;
    let count = pieces.len();
    let (Some(Piece::Inline(piece)), 1) = (pieces.pop(), count) else {
        return Err(wrong(format!("it has {count} pieces, expected one: merge them, with the points that they share")));
    };
    let old = matches!(vtk.version, Version::XML { major, minor } if (major, minor) < (2, 1));
    let mut deck = Deck { file: file.to_path_buf(), ..Deck::default() };
    points(*piece, old, &mut deck).map_err(wrong)?;
    Ok(deck)
}

/// A cell as the file states it: its kind, if it is not of a dimension below two, and its points.
struct Cell {
    kind: Option<Kind>,
    dimension: usize,
    points: Vec<u64>,
}

fn points(piece: UnstructuredGridPiece, old: bool, deck: &mut Deck) -> Result<(), String> {
    let values = piece.points.cast_into::<f64>().unwrap_or_default();
    if !values.len().is_multiple_of(3) {
        return Err(format!("it has {} coordinates, expected three of each point", values.len()));
    }
    for (k, x) in values.chunks_exact(3).enumerate() {
        if x.iter().any(|v| !v.is_finite()) {
            return Err(format!("the point {k} is at ({}, {}, {}), expected finite numbers", x[0], x[1], x[2]));
        }
        deck.nodes.insert(k as u64, [x[0], x[1], x[2]]);
    }
    let (connectivity, offsets) = piece.cells.cell_verts.into_xml();
    let types = piece.cells.types;
    if offsets.len() != types.len() {
        return Err(format!("it has {} cells by their offsets, but {} by their types", offsets.len(), types.len()));
    }
    let (mut cells, mut from) = (Vec::new(), 0);
    for (k, (to, kind)) in offsets.into_iter().zip(types).enumerate() {
        let to = usize::try_from(to).unwrap_or(usize::MAX);
        let points = connectivity
            .get(from..to)
            .ok_or_else(|| format!("the cell {k} has the points {from} to {to} of a list of {}", connectivity.len()))?;
        if let Some(point) = points.iter().find(|p| !deck.nodes.contains_key(p)) {
            return Err(format!(
                "the cell {k} has the point {point}, which does not exist; there are {}",
                deck.nodes.len()
            ));
        }
        cells.push(cell(kind, points, old).map_err(|found| {
            format!(
                "the cell {k} is {found}: cells are triangles, quadrilaterals, tetrahedra, hexahedra and wedges of order 1 or 2"
            )
        })?);
        from = to;
    }
    let dimension = cells.iter().map(|c| c.dimension).max().unwrap_or(0);
    for (k, cell) in cells.iter_mut().enumerate() {
        if let Some(kind) = cell.kind.filter(|_| cell.dimension == dimension) {
            let nodes = in_order(kind, &cell.points, deck);
            deck.elements.push(Element { number: k as u64, kind, nodes });
        }
    }
    for attribute in piece.data.cell {
        let Some((name, labels)) = labels(attribute, cells.len())? else { continue };
        for (value, list) in labels {
            let name = format!("{name}={value}");
            for k in list {
                let cell = &cells[k];
                let vertices = cell.kind.map_or(2, Kind::vertex_count).min(cell.points.len());
                if cell.dimension == dimension {
                    deck.element_sets.entry(&name).push(k as u64);
                } else if cell.dimension + 1 == dimension {
                    deck.surfaces.entry(&name).faces.push(cell.points[..vertices].to_vec());
                } else {
                    deck.node_sets.entry(&name).extend(&cell.points);
                }
            }
        }
    }
    for attribute in piece.data.point {
        let Some((name, labels)) = labels(attribute, deck.nodes.len())? else { continue };
        for (value, list) in labels {
            deck.node_sets.entry(&format!("{name}={value}")).extend(list.into_iter().map(|k| k as u64));
        }
    }
    Ok(())
}

/// The cells or points of each value of an array of integers. An array in which no value repeats numbers them and makes no
/// groups, unless it has one value only.
fn labels(attribute: Attribute, count: usize) -> Result<Option<(String, BTreeMap<i64, Vec<usize>>)>, String> {
    let Attribute::DataArray(array) = attribute else { return Ok(None) };
    if array.elem.num_comp() > 1 || matches!(array.data, IOBuffer::F32(_) | IOBuffer::F64(_) | IOBuffer::Bit(_)) {
        return Ok(None);
    }
    let Some(values) = array.data.cast_into::<i64>() else { return Ok(None) };
    if values.len() != count {
        return Err(format!("the array `{}` has {} values, expected {count}", array.name, values.len()));
    }
    let mut out: BTreeMap<i64, Vec<usize>> = BTreeMap::new();
    for (k, value) in values.iter().enumerate() {
        out.entry(*value).or_default().push(k);
    }
    Ok((out.len() < count || count == 1).then_some((array.name, out)))
}

/// What a cell is; in words if it cannot be one here.
fn cell(of: CellType, points: &[u64], old: bool) -> Result<Cell, String> {
    use CellType::*;
    let mut points = points.to_vec();
    let other = |name: &str| Err(format!("{name} of {} points", points.len()));
    let kind = match (of, points.len()) {
        (Vertex | PolyVertex, _) => return Ok(Cell { kind: None, dimension: 0, points }),
        (Line | PolyLine | QuadraticEdge | LagrangeCurve, 2..) => return Ok(Cell { kind: None, dimension: 1, points }),
        (Triangle | LagrangeTriangle, 3) => Kind::Triangle3,
        (Pixel, 4) => {
            points.swap(2, 3);
            Kind::Quadrilateral4
        }
        (Quad | LagrangeQuadrilateral, 4) => Kind::Quadrilateral4,
        (Tetra | LagrangeTetrahedron, 4) => Kind::Tetrahedron4,
        (Voxel, 8) => {
            points.swap(2, 3);
            points.swap(6, 7);
            Kind::Hexahedron8
        }
        (Hexahedron | LagrangeHexahedron, 8) => Kind::Hexahedron8,
        (Wedge | LagrangeWedge, 6) => Kind::Wedge6,
        (QuadraticTriangle | LagrangeTriangle, 6) => Kind::Triangle6,
        (QuadraticQuad, 8) => Kind::Quadrilateral8,
        (BiquadraticQuad | LagrangeQuadrilateral, 9) => Kind::Quadrilateral9,
        (QuadraticTetra | LagrangeTetrahedron, 10) => Kind::Tetrahedron10,
        (QuadraticHexahedron, 20) => Kind::Hexahedron20,
        (TriquadraticHexahedron, 27) => Kind::Hexahedron27,
        (LagrangeHexahedron, 27) => {
            // VTK before version 9 exchanged two of the upright edges.
            if old {
                points.swap(18, 19);
            }
            Kind::Hexahedron27
        }
        (QuadraticWedge, 15) => Kind::Wedge15,
        (BiquadraticQuadraticWedge | LagrangeWedge, 18) => Kind::Wedge18,
        (LagrangeTriangle | LagrangeQuadrilateral | LagrangeTetrahedron | LagrangeHexahedron | LagrangeWedge, _) => {
            return other("a Lagrange cell");
        }
        (Pyramid | QuadraticPyramid | LagrangePyramid, _) => return other("a pyramid"),
        (kind, _) => return other(&format!("a cell of VTK's type {} ({kind:?})", kind as u8)),
    };
    Ok(Cell { dimension: kind.dimension(), kind: Some(kind), points })
}

/// The nodes of a cell in the order of Gmsh. The first triangle of a wedge looks inward; files have it either way.
fn in_order(kind: Kind, points: &[u64], deck: &Deck) -> Vec<u64> {
    const TURNED: [usize; 18] = [3, 4, 5, 0, 1, 2, 9, 10, 11, 6, 7, 8, 12, 13, 14, 15, 16, 17];
    let mut points = points.to_vec();
    if kind.shape() == "wedge" {
        let x: [_; 4] = std::array::from_fn(|k| deck.nodes[&points[k]]);
        let [a, b, c]: [[f64; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|k| x[i + 1][k] - x[0][k]));
        let normal = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
        if (0..3).map(|k| normal[k] * c[k]).sum::<f64>() < 0.0 {
            points = TURNED[..points.len()].iter().map(|k| points[*k]).collect();
        }
    }
    kind.reordered_from_vtk(&points)
}
