//! Axes of a support: the directions of its components, which may turn about a line.

use signorini_geometry::{Point, Vector};

/// The directions along which the displacement of a place is prescribed, at the reference position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Axes {
    /// Three unit vectors, normal to each other, the same at all points.
    Rectangular([Vector<3>; 3]),
    /// Away from a line, around it by the right hand, along it: a point of the line and its unit vector.
    Cylindrical { point: Point<3>, axis: Vector<3> },
}

impl Axes {
    /// Rectangular axes: the first along `a`, the second in the plane of `a` and `b`; `None` if these are parallel.
    pub fn rectangular(a: &Vector<3>, b: &Vector<3>) -> Option<Self> {
        let third = a.cross(b).try_normalize(PARALLEL * a.norm() * b.norm())?;
        let first = a.normalize();
        Some(Axes::Rectangular([first, third.cross(&first), third]))
    }

    /// The unit vectors at a point; `None` on the line about which they turn.
    pub fn at(&self, x: &Point<3>) -> Option<[Vector<3>; 3]> {
        match self {
            Axes::Rectangular(axes) => Some(*axes),
            Axes::Cylindrical { point, axis } => {
                let from = x - point;
                let across = from - axis * axis.dot(&from);
                let first = across.try_normalize(PARALLEL * (x.norm() + point.norm()))?;
                Some([first, axis.cross(&first), *axis])
            }
        }
    }

    /// A displacement by its components along the axes; what is free counts nothing. `None` on the line about which they turn.
    pub fn vector(&self, x: &Point<3>, components: [Option<f64>; 3]) -> Option<Vector<3>> {
        let axes = self.at(x)?;
        Some(axes.iter().zip(components).map(|(e, c)| e * c.unwrap_or(0.0)).sum())
    }

    /// Vectors that span the directions whose component is held: in reduced row echelon form, so that the same space has the same
    /// vectors, and unit vectors of the coordinates where it holds them. `None` on the line about which they turn.
    pub fn span(&self, x: &Point<3>, held: [bool; 3]) -> Option<Vec<Vector<3>>> {
        let axes = self.at(x)?;
        let mut rows: Vec<Vector<3>> = (0..3).filter(|k| held[*k]).map(|k| axes[k]).collect();
        let mut done = 0;
        for column in 0..3 {
            let Some(pivot) =
                (done..rows.len()).max_by(|a, b| rows[*a][column].abs().total_cmp(&rows[*b][column].abs()))
            else {
                break;
            };
            // The rows are unit vectors normal to each other: what is smaller is zero but for rounding.
            if rows[pivot][column].abs() < PARALLEL {
                rows[done..].iter_mut().for_each(|row| row[column] = 0.0);
                continue;
            }
            rows.swap(done, pivot);
            let first = rows[done] / rows[done][column];
            rows[done] = first;
            for (_, row) in rows.iter_mut().enumerate().filter(|(k, _)| *k != done) {
                *row -= first * row[column];
            }
            done += 1;
        }
        rows.iter_mut().for_each(|row| row.iter_mut().filter(|v| v.abs() < PARALLEL).for_each(|v| *v = 0.0));
        Some(rows)
    }
}

/// Sine of an angle that is zero but for rounding.
const PARALLEL: f64 = 1e-12;
