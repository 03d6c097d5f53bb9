//! What a state shows of a body or of a contact: points, cells and named arrays over the points.

use signorini_fem::CellShape;

/// A state that was kept.
#[derive(Clone, Debug)]
pub struct ShownState {
    pub time: f64,
    /// Of the bodies.
    pub bodies: Vec<Fields>,
    /// Of the contacts: the surface that is tested, or the edges of the zones.
    pub contacts: Vec<Fields>,
}

impl ShownState {
    /// The fields of a contact by its name.
    pub fn contact(&self, name: &str) -> Option<&Fields> {
        self.contacts.iter().find(|fields| fields.name == name)
    }
}

/// Points, the cells between them, and values at the points.
#[derive(Clone, Debug, Default)]
pub struct Fields {
    pub name: String,
    /// Places before the deformation, in space: z is zero in the plane.
    pub points: Vec<[f64; 3]>,
    /// Flat cells, each by its shape and its points in the order of VTK; a polygon of more than four points has none.
    pub cells: Vec<(Option<CellShape>, Vec<u32>)>,
    pub arrays: Vec<FieldArray>,
}

/// A named array.
#[derive(Clone, Debug)]
pub struct FieldArray {
    /// As in the files of fields.
    pub name: &'static str,
    /// Values of each point: 1, 3 of a vector, 6 of a symmetric tensor (xx, yy, zz, xy, yz, xz).
    pub components: usize,
    /// Point by point.
    pub values: Vec<f64>,
}

impl Fields {
    /// The values of an array by its name, point by point.
    pub fn array(&self, name: &str) -> Option<&[f64]> {
        self.arrays.iter().find(|array| array.name == name).map(|array| &array.values[..])
    }

    /// The largest value of an array of scalars; none where there is none.
    pub fn largest(&self, name: &str) -> Option<f64> {
        self.array(name)?.iter().copied().reduce(f64::max)
    }

    /// Adds an array of scalars.
    #[must_use]
    pub fn scalar(mut self, name: &'static str, values: Vec<f64>) -> Self {
        self.arrays.push(FieldArray { name, components: 1, values });
        self
    }

    /// Adds an array of vectors.
    #[must_use]
    pub fn vector(mut self, name: &'static str, values: Vec<f64>) -> Self {
        self.arrays.push(FieldArray { name, components: 3, values });
        self
    }
}
