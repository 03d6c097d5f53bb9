//! What the material of a body is like, point by point and as a whole.

use crate::body::BodyState;
use signorini_geometry::{Point, Vector};

/// A body that fills a box, such as a piece of a material from an image.
pub trait BoxOfMaterial {
    /// What a body in a box of cells is like in the middle of equal boxes that fill its own: none of other bodies.
    fn samples(&self, _state: &BodyState) -> Option<Samples> {
        None
    }

    /// What a body in a box of cells is like as a whole: none of other bodies.
    fn means(&self, _state: &BodyState) -> Option<Means> {
        None
    }
}

/// How the material of a body answers: elastic, unless a body says otherwise.
pub trait Constitution {
    /// The law of its stress, as it is called; none of bodies that have none by name.
    fn law_name(&self) -> Option<String> {
        None
    }

    /// Whether a change of its volume takes far more stress than a change of its shape, at finite strain.
    fn is_nearly_incompressible(&self) -> bool {
        false
    }

    /// Whether the stress of the body depends on the states before.
    fn is_inelastic(&self) -> bool {
        false
    }

    /// The internal numbers with which an increment starts from a state that was reached: those of the state itself of bodies
    /// without history.
    fn renewed(&self, state: &BodyState) -> Vec<f64> {
        state.internal.clone()
    }

    /// Energy that the body dissipated between the start of the increment and a state.
    fn dissipated(&self, _state: &BodyState) -> f64 {
        0.0
    }

    /// Displacement and stress at a point of the body, given before it deforms; none where the body is not, or has no volume.
    fn at(&self, _state: &BodyState, _x: &Point<3>) -> Option<PointValues> {
        None
    }

    /// Where the material itself is not stable in a state: none where it is everywhere.
    fn unstable_material(&self, _state: &BodyState) -> Option<UnstableMaterial> {
        None
    }
}

/// A point of a body in a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointValues {
    pub displacement: Vector<3>,
    /// Equivalent stress.
    pub von_mises: f64,
    /// None of a body without one.
    pub temperature: Option<f64>,
}

/// A point of which the material softens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnstableMaterial {
    /// Before the body deforms.
    pub x: Point<3>,
    /// Principal stretches, the largest first.
    pub stretches: [f64; 3],
}

/// Named arrays of a body in equal boxes side by side, as an image has them, the first direction fastest.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Samples {
    /// Lowest corner, before the body deforms.
    pub origin: [f64; 3],
    /// Sides of one box, and how many there are; zero along z in the plane.
    pub spacing: [f64; 3],
    pub counts: [usize; 3],
    /// Name, number of components, values box by box.
    pub data: Vec<(String, usize, Vec<f64>)>,
}

/// A body as a piece of a material that fills its box.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Means {
    /// Normal stresses along the axes, summed over the material and divided by the volume of the box.
    pub stress: [f64; 3],
    /// How far the material on opposite sides of the box moved apart, over their distance; none where there is none on one.
    pub strain: [Option<f64>; 3],
}
