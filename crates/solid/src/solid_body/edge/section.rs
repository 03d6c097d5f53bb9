//! How the section of an edge turns: with its tangent, and with one of the faces about it.
//!
//! The section has the axes `t`, `m`, `b = t × m`: `t` along the tangent `a`, and `m` along the part across it of a vector `w`
//! that runs from the edge into the first face. Both vectors are linear in the displacements, and so is the spin in a change of
//! them,
//!
//! ```text
//! ω = t × δa/|a| + t (b·δw - (t·w/|a|) b·δa)/(m·w).
//! ```

use signorini_geometry::{Matrix, Vector};

/// The two vectors, and what changes them.
pub(super) struct Section {
    a: f64,
    w: Vector<3>,
    t: Vector<3>,
    m: Vector<3>,
    b: Vector<3>,
}

/// A change of both vectors.
#[derive(Clone, Copy)]
pub(super) struct Change {
    pub a: Vector<3>,
    pub w: Vector<3>,
}

impl Section {
    pub fn new(a: Vector<3>, w: Vector<3>) -> Section {
        let t = a.normalize();
        let m = (w - t * t.dot(&w)).normalize();
        Section { a: a.norm(), w, t, m, b: t.cross(&m) }
    }

    pub fn frame(&self) -> Matrix<3> {
        Matrix::<3>::from_columns(&[self.t, self.m, self.b])
    }

    /// `(b·δw - (t·w/|a|) b·δa)/(m·w)`.
    fn twist(&self, change: &Change) -> f64 {
        let lean = self.t.dot(&self.w) / self.a;
        (self.b.dot(&change.w) - lean * self.b.dot(&change.a)) / self.m.dot(&self.w)
    }

    /// The spin by a change.
    pub fn spin(&self, change: &Change) -> Vector<3> {
        self.t.cross(&change.a) / self.a + self.t * self.twist(change)
    }

    /// How the spin by a change changes with another one.
    pub fn bend(&self, change: &Change, other: &Change) -> Vector<3> {
        let spin = self.spin(other);
        let [dt, dm, db] = [self.t, self.m, self.b].map(|e| spin.cross(&e));
        let d_a = self.t.dot(&other.a);
        let lean = self.t.dot(&self.w) / self.a;
        let d_lean = (dt.dot(&self.w) + self.t.dot(&other.w)) / self.a - lean * d_a / self.a;
        let across = self.m.dot(&self.w);
        let d_across = dm.dot(&self.w) + self.m.dot(&other.w);
        let twist = self.twist(change);
        let d_twist = (db.dot(&change.w) - d_lean * self.b.dot(&change.a) - lean * db.dot(&change.a)) / across
            - twist * d_across / across;
        (dt.cross(&change.a) - self.t.cross(&change.a) * (d_a / self.a)) / self.a + dt * twist + self.t * d_twist
    }
}
