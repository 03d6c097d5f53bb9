//! Reference cells: their vertices, edges and faces.
//!
//! Tensor directions run over `[-1, 1]`, triangles over `(0,0), (1,0), (0,1)`; a wedge is a triangle times a line.
//! Vertices are numbered as in Gmsh and VTK. Positions are arrays of three numbers; those beyond the dimension are zero.

/// A position in a reference cell or face.
pub type Local = [f64; 3];

/// The shape of a cell or of a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CellShape {
    Line,
    Triangle,
    Quadrilateral,
    Tetrahedron,
    Hexahedron,
    Wedge,
}

use CellShape::*;

impl CellShape {
    pub fn dimension(self) -> usize {
        match self {
            Line => 1,
            Triangle | Quadrilateral => 2,
            Tetrahedron | Hexahedron | Wedge => 3,
        }
    }

    /// Whether the shape is a product of lines, on which every degree is possible.
    pub fn is_tensor(self) -> bool {
        matches!(self, Line | Quadrilateral | Hexahedron)
    }

    pub fn name(self) -> &'static str {
        match self {
            Line => "line",
            Triangle => "triangle",
            Quadrilateral => "quadrilateral",
            Tetrahedron => "tetrahedron",
            Hexahedron => "hexahedron",
            Wedge => "wedge",
        }
    }

    pub fn vertices(self) -> &'static [Local] {
        match self {
            Line => &[[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
            Triangle => &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            Quadrilateral => &[[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]],
            Tetrahedron => &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            Hexahedron => &[
                [-1.0, -1.0, -1.0],
                [1.0, -1.0, -1.0],
                [1.0, 1.0, -1.0],
                [-1.0, 1.0, -1.0],
                [-1.0, -1.0, 1.0],
                [1.0, -1.0, 1.0],
                [1.0, 1.0, 1.0],
                [-1.0, 1.0, 1.0],
            ],
            Wedge => &[
                [0.0, 0.0, -1.0],
                [1.0, 0.0, -1.0],
                [0.0, 1.0, -1.0],
                [0.0, 0.0, 1.0],
                [1.0, 0.0, 1.0],
                [0.0, 1.0, 1.0],
            ],
        }
    }

    /// The function that is one at a vertex of a face and zero at the others, linear along straight edges.
    pub fn vertex_function(self, vertex: usize, s: &Local) -> f64 {
        let corner = &self.vertices()[vertex];
        match self {
            Triangle if vertex == 0 => 1.0 - s[0] - s[1],
            Triangle => corner[0] * s[0] + corner[1] * s[1],
            Line => 0.5 * (1.0 + corner[0] * s[0]),
            _ => 0.25 * (1.0 + corner[0] * s[0]) * (1.0 + corner[1] * s[1]),
        }
    }

    /// The derivatives of that function along both coordinates.
    pub fn vertex_slopes(self, vertex: usize, s: &Local) -> [f64; 2] {
        let [a, b, _] = self.vertices()[vertex];
        match self {
            Triangle if vertex == 0 => [-1.0, -1.0],
            Triangle => [a, b],
            Line => [0.5 * a, 0.0],
            _ => [0.25 * a * (1.0 + b * s[1]), 0.25 * b * (1.0 + a * s[0])],
        }
    }

    /// Pairs of vertices; edges of tensor shapes run along their positive axis.
    pub fn edges(self) -> &'static [[usize; 2]] {
        match self {
            Line => &[[0, 1]],
            Triangle => &[[0, 1], [1, 2], [0, 2]],
            Quadrilateral => &[[0, 1], [1, 2], [3, 2], [0, 3]],
            Tetrahedron => &[[0, 1], [1, 2], [0, 2], [0, 3], [2, 3], [1, 3]],
            Hexahedron => {
                &[[0, 1], [0, 3], [0, 4], [1, 2], [1, 5], [3, 2], [2, 6], [3, 7], [4, 5], [4, 7], [5, 6], [7, 6]]
            }
            Wedge => &[[0, 1], [0, 2], [0, 3], [1, 2], [1, 4], [2, 5], [3, 4], [3, 5], [4, 5]],
        }
    }

    /// The sides of one dimension less, by vertices: in the plane the cell lies to the left of them, in space their
    /// normal by the right-hand rule points outwards.
    pub fn sides(self) -> &'static [&'static [usize]] {
        match self {
            Line => &[&[0], &[1]],
            Triangle => &[&[0, 1], &[1, 2], &[2, 0]],
            Quadrilateral => &[&[0, 1], &[1, 2], &[2, 3], &[3, 0]],
            Tetrahedron => &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]],
            Hexahedron => &[&[0, 3, 2, 1], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]],
            Wedge => &[&[0, 2, 1], &[3, 4, 5], &[0, 1, 4, 3], &[1, 2, 5, 4], &[2, 0, 3, 5]],
        }
    }

    /// The shape of a side with this many vertices.
    pub fn of_side(vertices: usize) -> CellShape {
        match vertices {
            2 => Line,
            3 => Triangle,
            _ => Quadrilateral,
        }
    }

    /// The middle of the cell.
    pub fn centre(self) -> Local {
        let vertices = self.vertices();
        std::array::from_fn(|k| vertices.iter().map(|v| v[k]).sum::<f64>() / vertices.len() as f64)
    }

    /// How far a position lies beyond the cell, in its coordinates; negative inside.
    pub fn beyond(self, [a, b, c]: &Local) -> f64 {
        let triangle = (-a).max(-b).max(a + b - 1.0);
        match self {
            Line => a.abs() - 1.0,
            Triangle => triangle,
            Quadrilateral => a.abs().max(b.abs()) - 1.0,
            Tetrahedron => (-a).max(-b).max(-c).max(a + b + c - 1.0),
            Hexahedron => a.abs().max(b.abs()).max(c.abs()) - 1.0,
            Wedge => triangle.max(c.abs() - 1.0),
        }
    }

    /// The position in the cell of the point `s` of one of its sides, and its derivatives with respect to `s`.
    pub fn on_side(self, side: usize, s: &Local) -> (Local, [Local; 2]) {
        let corners: Vec<Local> = self.sides()[side].iter().map(|&v| self.vertices()[v]).collect();
        let [mut x, mut first, mut second] = [[0.0; 3]; 3];
        for k in 0..3 {
            let c = |i: usize| corners[i][k];
            match corners.len() {
                2 => {
                    x[k] = 0.5 * ((1.0 - s[0]) * c(0) + (1.0 + s[0]) * c(1));
                    first[k] = 0.5 * (c(1) - c(0));
                }
                3 => {
                    x[k] = c(0) + s[0] * (c(1) - c(0)) + s[1] * (c(2) - c(0));
                    (first[k], second[k]) = (c(1) - c(0), c(2) - c(0));
                }
                _ => {
                    // Sides of reference cells are parallelograms.
                    (first[k], second[k]) = (0.5 * (c(1) - c(0)), 0.5 * (c(3) - c(0)));
                    x[k] = 0.5 * (c(0) + c(2)) + s[0] * first[k] + s[1] * second[k];
                }
            }
        }
        (x, [first, second])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_look_outwards_and_edges_are_covered() {
        for shape in [Triangle, Quadrilateral, Tetrahedron, Hexahedron, Wedge] {
            let centre = shape.centre();
            for side in 0..shape.sides().len() {
                let middle = CellShape::of_side(shape.sides()[side].len()).centre();
                let (x, [a, b]) = shape.on_side(side, &middle);
                let outwards: f64 = if shape.dimension() == 2 {
                    (x[0] - centre[0]) * a[1] - (x[1] - centre[1]) * a[0]
                } else {
                    (0..3)
                        .map(|k| {
                            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                            (x[k] - centre[k]) * (a[i] * b[j] - a[j] * b[i])
                        })
                        .sum()
                };
                assert!(outwards > 0.1, "{shape:?} side {side}: {outwards}");
                let corners = shape.sides()[side];
                for k in 0..corners.len() {
                    let pair = [corners[k], corners[(k + 1) % corners.len()]];
                    assert!(shape.edges().iter().any(|e| *e == pair || [e[1], e[0]] == pair));
                }
            }
        }
    }
}
