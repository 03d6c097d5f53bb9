//! Types of elements: their shape, the order of their nodes, and the numbers of their faces.

use std::fmt;

/// The shape of an element, with the number of its nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Triangle3,
    Triangle6,
    Quadrilateral4,
    Quadrilateral8,
    Quadrilateral9,
    Tetrahedron4,
    Tetrahedron10,
    Hexahedron8,
    Hexahedron20,
    Hexahedron27,
    Wedge6,
    Wedge15,
    Wedge18,
}

/// The space of a deck.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Space {
    Solid,
    PlaneStrain,
    PlaneStress,
    Axisymmetric,
}

impl Space {
    pub fn dimension(self) -> usize {
        if self == Space::Solid { 3 } else { 2 }
    }

    /// The value of the key `space` of a case.
    pub fn key(self) -> &'static str {
        match self {
            Space::Solid => "3d",
            Space::PlaneStrain => "plane_strain",
            Space::PlaneStress => "plane_stress",
            Space::Axisymmetric => "axisymmetric",
        }
    }
}

impl fmt::Display for Space {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.key())
    }
}

/// Abaqus, CalculiX and FEBio number the edges of a hexahedron around its bottom, its top, then upwards; Gmsh by vertices.
const HEXAHEDRON_EDGES: [usize; 12] = [8, 11, 16, 9, 17, 10, 18, 19, 12, 15, 13, 14];
const WEDGE_EDGES: [usize; 9] = [6, 8, 12, 7, 13, 14, 9, 11, 10];
const TETRAHEDRON_EDGES: [usize; 6] = [4, 5, 6, 7, 9, 8];

/// The vertices between which the nodes of order 2 lie, in the order of Gmsh.
const HEXAHEDRON_MIDDLES: [[usize; 2]; 12] =
    [[0, 1], [0, 3], [0, 4], [1, 2], [1, 5], [2, 3], [2, 6], [3, 7], [4, 5], [4, 7], [5, 6], [6, 7]];
const WEDGE_MIDDLES: [[usize; 2]; 9] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 4], [2, 5], [3, 4], [3, 5], [4, 5]];
const TETRAHEDRON_MIDDLES: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [3, 0], [2, 3], [1, 3]];
const QUADRILATERAL_MIDDLES: [[usize; 2]; 4] = [[0, 1], [1, 2], [2, 3], [3, 0]];
const TRIANGLE_MIDDLES: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];

/// Faces by vertices, in the order of Abaqus and CalculiX.
const TETRAHEDRON_FACES: [&[usize]; 4] = [&[0, 1, 2], &[0, 3, 1], &[1, 3, 2], &[2, 3, 0]];
const HEXAHEDRON_FACES: [&[usize]; 6] =
    [&[0, 1, 2, 3], &[4, 7, 6, 5], &[0, 4, 5, 1], &[1, 5, 6, 2], &[2, 6, 7, 3], &[3, 7, 4, 0]];
const WEDGE_FACES: [&[usize]; 5] = [&[0, 1, 2], &[3, 5, 4], &[0, 3, 4, 1], &[1, 4, 5, 2], &[2, 5, 3, 0]];
const TRIANGLE_FACES: [&[usize]; 3] = [&[0, 1], &[1, 2], &[2, 0]];
const QUADRILATERAL_FACES: [&[usize]; 4] = [&[0, 1], &[1, 2], &[2, 3], &[3, 0]];

impl Kind {
    /// The name of the shape in the arrays of a mesh.
    pub fn shape(self) -> &'static str {
        match self {
            Kind::Triangle3 | Kind::Triangle6 => "triangle",
            Kind::Quadrilateral4 | Kind::Quadrilateral8 | Kind::Quadrilateral9 => "quadrilateral",
            Kind::Tetrahedron4 | Kind::Tetrahedron10 => "tetrahedron",
            Kind::Hexahedron8 | Kind::Hexahedron20 | Kind::Hexahedron27 => "hexahedron",
            Kind::Wedge6 | Kind::Wedge15 | Kind::Wedge18 => "wedge",
        }
    }

    pub fn node_count(self) -> usize {
        match self {
            Kind::Triangle3 => 3,
            Kind::Quadrilateral4 | Kind::Tetrahedron4 => 4,
            Kind::Triangle6 | Kind::Wedge6 => 6,
            Kind::Quadrilateral8 | Kind::Hexahedron8 => 8,
            Kind::Tetrahedron10 => 10,
            Kind::Quadrilateral9 => 9,
            Kind::Wedge15 => 15,
            Kind::Wedge18 => 18,
            Kind::Hexahedron20 => 20,
            Kind::Hexahedron27 => 27,
        }
    }

    pub fn vertex_count(self) -> usize {
        match self.shape() {
            "triangle" => 3,
            "quadrilateral" | "tetrahedron" => 4,
            "wedge" => 6,
            _ => 8,
        }
    }

    pub fn dimension(self) -> usize {
        if matches!(self.shape(), "triangle" | "quadrilateral") { 2 } else { 3 }
    }

    /// The vertices of the edges in whose middle there are nodes, in the order of these nodes.
    pub fn edges(self) -> &'static [[usize; 2]] {
        match self {
            Kind::Hexahedron20 | Kind::Hexahedron27 => &HEXAHEDRON_MIDDLES,
            Kind::Wedge15 | Kind::Wedge18 => &WEDGE_MIDDLES,
            Kind::Tetrahedron10 => &TETRAHEDRON_MIDDLES,
            Kind::Quadrilateral8 | Kind::Quadrilateral9 => &QUADRILATERAL_MIDDLES,
            Kind::Triangle6 => &TRIANGLE_MIDDLES,
            _ => &[],
        }
    }

    /// The vertices of each face, in the order of Abaqus and CalculiX.
    pub fn faces(self) -> &'static [&'static [usize]] {
        match self.shape() {
            "triangle" => &TRIANGLE_FACES,
            "quadrilateral" => &QUADRILATERAL_FACES,
            "tetrahedron" => &TETRAHEDRON_FACES,
            "wedge" => &WEDGE_FACES,
            _ => &HEXAHEDRON_FACES,
        }
    }

    /// Nodes in the order of the deck, in that of Gmsh.
    pub fn reordered(self, nodes: &[u64]) -> Vec<u64> {
        // FEBio has the sides around first.
        self.with_middles(nodes, [24, 20, 23, 21, 22, 25, 26])
    }

    /// Nodes in the order of VTK, in that of Gmsh: like those of Abaqus, but for the sides, of which VTK has those across x first.
    pub fn reordered_from_vtk(self, nodes: &[u64]) -> Vec<u64> {
        self.with_middles(nodes, [24, 22, 20, 21, 23, 25, 26])
    }

    /// Nodes in the order of Gmsh; `middles` are those in the middle of the sides and of a hexahedron of 27 nodes.
    fn with_middles(self, nodes: &[u64], middles: [usize; 7]) -> Vec<u64> {
        let vertices = self.vertex_count();
        let rest: Vec<usize> = match self {
            Kind::Hexahedron20 => HEXAHEDRON_EDGES.to_vec(),
            Kind::Hexahedron27 => HEXAHEDRON_EDGES.into_iter().chain(middles).collect(),
            Kind::Wedge15 => WEDGE_EDGES.to_vec(),
            Kind::Wedge18 => WEDGE_EDGES.into_iter().chain([15, 17, 16]).collect(),
            Kind::Tetrahedron10 => TETRAHEDRON_EDGES.to_vec(),
            other => (vertices..other.node_count()).collect(),
        };
        (0..vertices).chain(rest).map(|k| nodes[k]).collect()
    }
}
