//! The same bodies with finer functions: what changes with them is what the cells leave uncertain.

use super::{Opposite, PlannedBody, SolidPlan};
use signorini_fem::{Group, Halved, Side};

/// How the functions of a body are made finer.
enum Finer<const D: usize> {
    /// One degree more.
    Raised,
    /// Every cell divided: where there are no functions of a higher degree.
    Halved(Box<Halved<D>>),
}

/// The highest degree of the functions on cells that are not all tensor products, and on those that are.
const HIGHEST: [usize; 2] = [2, 8];

impl<const D: usize> PlannedBody<D> {
    fn can_be_raised(&self) -> bool {
        let tensor = (0..self.mesh.cell_count()).all(|cell| self.mesh.shape(cell).is_tensor());
        self.degree < HIGHEST[usize::from(tensor)]
    }

    /// By how much finer functions are more, about.
    fn growth(&self) -> f64 {
        let of_line = if self.can_be_raised() { 1.0 + 1.0 / self.degree as f64 } else { 2.0 };
        of_line.powi(D as i32)
    }

    fn finer(&self) -> Finer<D> {
        if self.can_be_raised() { Finer::Raised } else { Finer::Halved(Box::new(Halved::new(&self.mesh))) }
    }
}

impl<const D: usize> Finer<D> {
    fn body(&self, of: &PlannedBody<D>) -> PlannedBody<D> {
        match self {
            Self::Raised => {
                let mesh = of.raised.clone().unwrap_or_else(|| of.mesh.clone());
                PlannedBody { mesh, degree: of.degree + 1, ..of.clone() }
            }
            Self::Halved(halved) => PlannedBody { mesh: halved.mesh.clone(), raised: None, ..of.clone() },
        }
    }

    fn group(&self, of: &Group) -> Group {
        match self {
            Self::Raised => of.clone(),
            Self::Halved(halved) => halved.group(of),
        }
    }

    fn sides(&self, of: &[Side]) -> Vec<Side> {
        match self {
            Self::Raised => of.to_vec(),
            Self::Halved(halved) => halved.sides(of),
        }
    }
}

impl<const D: usize> SolidPlan<D> {
    /// By how much finer functions are more, about.
    pub fn growth(&self) -> f64 {
        self.bodies.iter().map(PlannedBody::growth).fold(1.0, f64::max)
    }

    /// The plan with functions of one degree more, on cells whose curves are too, or with cells of half the size.
    pub fn finer(&self) -> Self {
        let finer: Vec<Finer<D>> = self.bodies.iter().map(PlannedBody::finer).collect();
        let mut out = self.clone();
        out.bodies = self.bodies.iter().zip(&finer).map(|(body, finer)| finer.body(body)).collect();
        for support in &mut out.supports {
            support.group = finer[support.body].group(&support.group);
        }
        for load in &mut out.loads {
            load.group = finer[load.body].group(&load.group);
        }
        for contact in &mut out.contacts {
            contact.sides = finer[contact.body].sides(&contact.sides);
            if let Opposite::Body { body, sides, .. } = &mut contact.opposite {
                *sides = finer[*body].sides(sides);
            }
        }
        out
    }
}
