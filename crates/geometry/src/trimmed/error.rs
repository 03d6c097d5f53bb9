//! What is wrong with the boundary of a body.

use crate::Point;

/// A refused body: which face and edge, what is wrong, and what helps.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{wrong}")]
pub struct SolidError {
    /// Numbers in the data.
    pub face: Option<usize>,
    pub edge: Option<usize>,
    pub wrong: Wrong,
}

/// Why a boundary bounds no body.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Wrong {
    #[error("there are no faces")]
    NoFaces,
    #[error("a face on a {noun} without edges has no end")]
    NoLoop { noun: &'static str },
    #[error("an edge lies {distance:.3e} beside the {noun} of its face, at {}", place(.at))]
    OffSurface { noun: &'static str, distance: f64, at: Point<3> },
    #[error("an edge ends {distance:.3e} beside its vertex, at {}", place(.at))]
    OffVertex { distance: f64, at: Point<3> },
    #[error("the surface has a gap: an edge has a face on one side only, at {}", place(.at))]
    Free { at: Point<3> },
    #[error("{count} faces meet at one edge, at {}", place(.at))]
    Branching { count: usize, at: Point<3> },
    #[error("two faces at one edge look to opposite sides of the surface, at {}", place(.at))]
    Flipped { at: Point<3> },
    #[error("the bounds of the face leave nothing of its {noun}, or run the wrong way around")]
    Empty { noun: &'static str },
    #[error("the surface looks inwards: its volume is {volume:.3e}")]
    Inward { volume: f64 },
}

impl SolidError {
    pub(super) fn face(face: usize, wrong: Wrong) -> Self {
        SolidError { face: Some(face), edge: None, wrong }
    }

    pub(super) fn edge(edge: usize, wrong: Wrong) -> Self {
        SolidError { face: None, edge: Some(edge), wrong }
    }

    /// What helps.
    pub fn help(&self) -> &'static str {
        match self.wrong {
            Wrong::OffSurface { .. } | Wrong::OffVertex { .. } | Wrong::Free { .. } => {
                "sew or heal the body in the CAD program, with a small tolerance, and export it again as a solid"
            }
            Wrong::Branching { .. } => "export bodies that touch along an edge as solids of their own",
            Wrong::Flipped { .. } | Wrong::Inward { .. } | Wrong::Empty { .. } => {
                "orient the faces of the body outwards in the CAD program, and export it again as a solid"
            }
            Wrong::NoFaces | Wrong::NoLoop { .. } => "export the body as a solid with all its faces",
        }
    }
}

fn place(x: &Point<3>) -> String {
    format!("({:.4}, {:.4}, {:.4})", x.x, x.y, x.z)
}
