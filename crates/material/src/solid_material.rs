//! What a solid is made of.

use crate::elastic::Elastic;
use crate::law::StressLaw;
use signorini_geometry::Point;
use std::sync::Arc;

/// Constants and law at a reference position.
pub type ByPosition = Arc<dyn Fn(&Point<3>) -> (Elastic, StressLaw) + Send + Sync>;

/// Constants of small strain with a stress law: the same everywhere, or by position.
#[derive(Clone)]
pub struct SolidMaterial {
    elastic: Elastic,
    law: StressLaw,
    by_position: Option<ByPosition>,
}

impl From<(Elastic, StressLaw)> for SolidMaterial {
    fn from((elastic, law): (Elastic, StressLaw)) -> Self {
        SolidMaterial { elastic, law, by_position: None }
    }
}

/// Linear elastic.
impl From<Elastic> for SolidMaterial {
    fn from(elastic: Elastic) -> Self {
        (elastic, StressLaw::LinearElastic).into()
    }
}

impl SolidMaterial {
    /// A material that varies. The typical constants set scales, and by their Poisson's ratio whether the dilatation is
    /// projected; the typical law is of the kind that is everywhere.
    pub fn varying((elastic, law): (Elastic, StressLaw), by_position: ByPosition) -> Self {
        SolidMaterial { elastic, law, by_position: Some(by_position) }
    }

    /// The same with other typical constants.
    pub fn with_typical(self, elastic: Elastic) -> Self {
        SolidMaterial { elastic, ..self }
    }

    /// Typical constants.
    pub fn elastic(&self) -> &Elastic {
        &self.elastic
    }

    /// Typical law.
    pub fn law(&self) -> &StressLaw {
        &self.law
    }

    pub fn varies(&self) -> bool {
        self.by_position.is_some()
    }

    /// Constants and law at a reference position.
    pub fn at(&self, x: &Point<3>) -> (Elastic, StressLaw) {
        match &self.by_position {
            Some(of) => of(x),
            None => (self.elastic, self.law.clone()),
        }
    }

    /// Whether it is linear elastic, isotropic and the same everywhere.
    pub fn is_uniform_hooke(&self) -> bool {
        self.law == StressLaw::LinearElastic && !self.varies()
    }
}
