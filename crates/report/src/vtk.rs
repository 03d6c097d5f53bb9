//! Files of fields as plain meshes: VTU and VTP, as runs write them.

use std::path::Path;
use vtkio::model::{Attribute, CellType, DataArray, DataSet, Piece, VertexNumbers};

/// Points, cells between them, and values at the points.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    pub points: Vec<[f64; 3]>,
    pub cells: Vec<Cell>,
    pub arrays: Vec<Array>,
}

/// A cell by its kind and its corners in the order of VTK.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell {
    pub kind: Kind,
    pub corners: Vec<u32>,
}

/// What a cell is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Vertex,
    Line,
    Polygon,
    Tetrahedron,
    Hexahedron,
    Wedge,
}

/// Values at the points, by a name.
#[derive(Clone, Debug)]
pub struct Array {
    pub name: String,
    pub components: usize,
    pub values: Vec<f64>,
}

impl Mesh {
    /// The values of an array by its name.
    pub fn array(&self, name: &str) -> Option<&Array> {
        self.arrays.iter().find(|array| array.name == name)
    }

    /// The values of an array of scalars.
    pub fn scalar(&self, name: &str) -> Option<&[f64]> {
        self.array(name).filter(|array| array.components == 1).map(|array| &array.values[..])
    }

    /// A vector of an array of vectors.
    pub fn vector(&self, name: &str, point: usize) -> Option<[f64; 3]> {
        let array = self.array(name).filter(|array| array.components == 3)?;
        array.values.get(3 * point..3 * point + 3)?.try_into().ok()
    }

    /// Reads a file; what is wrong with it in words.
    ///
    /// # Errors
    /// A file that is not there, is no VTK file, or contradicts itself.
    pub fn read(path: &Path) -> Result<Self, String> {
        let vtk = vtkio::Vtk::import(path).map_err(|e| e.to_string())?;
        let mut mesh = Self::default();
        match vtk.data {
            DataSet::UnstructuredGrid { pieces, .. } => {
                for piece in pieces {
                    let Piece::Inline(piece) = piece else { continue };
                    mesh.set_points(piece.points.cast_into::<f64>());
                    let kinds: Vec<Option<Kind>> = piece.cells.types.iter().map(|t| kind(*t)).collect();
                    let cells = lists(piece.cells.cell_verts);
                    mesh.cells.extend(
                        kinds.into_iter().zip(cells).filter_map(|(kind, corners)| Some(Cell { kind: kind?, corners })),
                    );
                    mesh.set_arrays(piece.data.point);
                }
            }
            DataSet::PolyData { pieces, .. } => {
                for piece in pieces {
                    let Piece::Inline(piece) = piece else { continue };
                    mesh.set_points(piece.points.cast_into::<f64>());
                    let of = [(piece.verts, Kind::Vertex), (piece.lines, Kind::Line), (piece.polys, Kind::Polygon)];
                    for (cells, kind) in of {
                        let lists = cells.map_or_else(Vec::new, lists);
                        mesh.cells.extend(lists.into_iter().map(|corners| Cell { kind, corners }));
                    }
                    mesh.set_arrays(piece.data.point);
                }
            }
            _ => return Err("it contains neither cells nor surfaces".into()),
        }
        let count = mesh.points.len();
        if mesh.cells.iter().flat_map(|c| &c.corners).any(|&k| k as usize >= count) {
            return Err("a cell has a corner that is not there".into());
        }
        mesh.arrays.retain(|array| array.values.len() == count * array.components);
        Ok(mesh)
    }

    fn set_points(&mut self, values: Option<Vec<f64>>) {
        let values = values.unwrap_or_default();
        self.points = values.chunks_exact(3).map(|x| [x[0], x[1], x[2]]).collect();
    }

    fn set_arrays(&mut self, attributes: Vec<Attribute>) {
        for attribute in attributes {
            let Attribute::DataArray(DataArray { name, elem, data }) = attribute else { continue };
            if let Some(values) = data.cast_into::<f64>() {
                self.arrays.push(Array { name, components: elem.num_comp().max(1) as usize, values });
            }
        }
    }
}

fn kind(of: CellType) -> Option<Kind> {
    Some(match of {
        CellType::Vertex => Kind::Vertex,
        CellType::Line => Kind::Line,
        CellType::Triangle | CellType::Quad | CellType::Polygon => Kind::Polygon,
        CellType::Tetra => Kind::Tetrahedron,
        CellType::Hexahedron => Kind::Hexahedron,
        CellType::Wedge => Kind::Wedge,
        _ => return None,
    })
}

/// The corners of the cells, one list each; those that contradict themselves are empty.
fn lists(numbers: VertexNumbers) -> Vec<Vec<u32>> {
    let (connectivity, offsets) = numbers.into_xml();
    let mut from = 0;
    let mut out = Vec::with_capacity(offsets.len());
    for to in offsets {
        let to = to as usize;
        out.push(connectivity.get(from..to).unwrap_or_default().iter().map(|&k| k as u32).collect());
        from = to.max(from);
    }
    out
}
