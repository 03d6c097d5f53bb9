//! Rigid bodies as files for ParaView: their surface, in the plane their edge.

use super::OutputError;
use super::level::{region, surface};
use super::page::ROUNDING;
use super::vtk::to_bytes;
use signorini_contact::GapJet;
use signorini_geometry::Vector;
use vtkio::model::{DataSet, PolyDataPiece, VertexNumbers};

/// The distance to a rigid body, negative inside.
pub type Gap<'a> = &'a (dyn Fn(&Vector<3>) -> GapJet<3> + Sync);

/// A VTP of a rigid body within a box, which has no extent along z in the plane.
///
/// # Errors
/// What `vtkio` cannot write.
pub fn file(gap: Gap<'_>, corners: [Vector<3>; 2], in_space: bool) -> Result<Vec<u8>, OutputError> {
    let (points, cells) = if in_space {
        let (points, _, triangles) = surface(gap, corners);
        (points, triangles.iter().map(|t| t.to_vec()).collect())
    } else {
        joined(&region(gap, corners).1, ROUNDING * (corners[1] - corners[0]).max())
    };
    let connectivity: Vec<u64> = cells.iter().flatten().map(|&k| u64::from(k)).collect();
    let offsets: Vec<u64> = (cells.iter())
        .scan(0, |at, c: &Vec<u32>| {
            *at += c.len() as u64;
            Some(*at)
        })
        .collect();
    let topology = Some(VertexNumbers::XML { connectivity, offsets });
    let mut piece = PolyDataPiece {
        points: points.iter().flat_map(|x| [x.x, x.y, x.z]).collect::<Vec<f64>>().into(),
        ..PolyDataPiece::default()
    };
    if in_space {
        piece.polys = topology
    } else {
        piece.lines = topology
    }
    to_bytes("rigid", DataSet::inline(piece))
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
