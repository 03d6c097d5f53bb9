//! What can be wrong with a mesh file.

/// A mesh file that cannot be used, and where it is wrong.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GmshError {
    #[error("not a Gmsh mesh: it does not begin with $MeshFormat")]
    NotGmsh,
    #[error("version {found} of the format is not supported: save the mesh as version 4.1 or 2.2")]
    Version { found: String },
    #[error("line {line}: expected {wanted}, found `{found}`")]
    Malformed { line: usize, wanted: &'static str, found: String },
    #[error("the file ends within {section}")]
    Truncated { section: &'static str },
    #[error("{section}: {count} is not a valid number here")]
    Count { section: &'static str, count: i64 },
    #[error("element {element} is a {what}, which is not supported: use cells of order 1 or 2, and no pyramids")]
    Element { element: u64, what: String },
    /// `place` is the line of a text file, with what parts it from the rest; empty where there is none.
    #[error("{place}element {element} has the node {node}, which the file does not define")]
    NoNode { place: String, element: u64, node: u64 },
    #[error("node {node} appears twice")]
    Twice { node: u64 },
    #[error("there is no physical group `{group}` of dimension {dimension}; the file has {known}")]
    NoGroup { group: String, dimension: usize, known: String },
    #[error("the file has no cells of dimension {dimension}: {hint}")]
    NoCells { dimension: usize, hint: &'static str },
    #[error("node {node} is at z = {z}, but a plane mesh must lie in z = 0")]
    NotPlane { node: u64, z: f64 },
}
