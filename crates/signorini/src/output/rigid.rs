//! Rigid bodies as files for ParaView: their surface, in the plane their edge; there is one for each of them in each increment, so
//! that they are compressed, with points of single precision.

use super::OutputError;
use super::level::region;
use super::page::ROUNDING;
use super::vtk::to_compressed_bytes;
use signorini_contact::GapJet;
use signorini_geometry::Vector;
use vtkio::model::{DataSet, PolyDataPiece, VertexNumbers};

/// The distance to a rigid body, negative inside.
pub type Gap<'a> = &'a (dyn Fn(&Vector<3>) -> GapJet<3> + Sync);

/// A VTP of the edge of a rigid body in the plane, within a box.
///
/// # Errors
/// What `vtkio` cannot write.
pub fn in_plane(gap: Gap<'_>, corners: [Vector<3>; 2]) -> Result<Vec<u8>, OutputError> {
    let (points, lines) = joined(&region(gap, corners).1, ROUNDING * (corners[1] - corners[0]).max());
    let (mut piece, topology) = piece(&points, &lines);
    piece.lines = topology;
    to_compressed_bytes("rigid", DataSet::inline(piece))
}

/// A VTP of the surface of a rigid body, from its triangles.
///
/// # Errors
/// What `vtkio` cannot write.
pub fn in_space(points: &[Vector<3>], triangles: &[[u32; 3]]) -> Result<Vec<u8>, OutputError> {
    let (mut piece, topology) = piece(points, triangles);
    piece.polys = topology;
    to_compressed_bytes("rigid", DataSet::inline(piece))
}

/// Points, and what cells there are between them.
fn piece(points: &[Vector<3>], cells: &[impl AsRef<[u32]>]) -> (PolyDataPiece, Option<VertexNumbers>) {
    let connectivity: Vec<u64> = cells.iter().flat_map(|c| c.as_ref()).map(|&k| u64::from(k)).collect();
    let offsets: Vec<u64> = (cells.iter())
        .scan(0, |at, c| {
            *at += c.as_ref().len() as u64;
            Some(*at)
        })
        .collect();
    let points = points.iter().flat_map(|x| [x.x, x.y, x.z].map(|v| v as f32)).collect::<Vec<f32>>().into();
    (PolyDataPiece { points, ..PolyDataPiece::default() }, Some(VertexNumbers::XML { connectivity, offsets }))
}

/// Pieces with the points in which they meet, each once: points as near as `near` are one.
#[doc(hidden)]
pub fn joined(pieces: &[[Vector<3>; 2]], near: f64) -> (Vec<Vector<3>>, Vec<Vec<u32>>) {
    let mut numbers: std::collections::HashMap<[i64; 2], u32> = std::collections::HashMap::new();
    let (mut points, mut cells) = (Vec::new(), Vec::new());
    for ends in pieces {
        let cell = ends.map(|x| {
            let key = [x.x, x.y].map(|v| (v / near.max(f64::MIN_POSITIVE)).round() as i64);
            *numbers.entry(key).or_insert_with(|| {
                points.push(x);
                points.len() as u32 - 1
            })
        });
        // Where the edge passes through a corner of a square there are pieces without length.
        if cell[0] != cell[1] {
            cells.push(cell.to_vec());
        }
    }
    (points, cells)
}
