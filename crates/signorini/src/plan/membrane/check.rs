//! Checks the fields of a membrane where they will be used.

use super::MembranePlan;
use crate::plan::located::{LocatedExpression, field};
use crate::problem::CaseError;
use signorini_fem::cut::QuadraturePoint;
use signorini_geometry::{Jet, Point, Real};
use signorini_membrane::field::SharedField;
use signorini_membrane::obstacle::Side;
use signorini_membrane::problem::Membrane;

impl<const D: usize> MembranePlan<D> {
    /// Checks the fields of a membrane where they will be used: finite values, positive tension, a floor below the
    /// supports.
    pub fn check_fields(&self, membrane: &Membrane<D>, time: f64) -> Result<(), CaseError> {
        let quadrature = (self.kernel.quadrature)(membrane);
        let mut failure: Option<CaseError> = None;
        let wrong = |p: &LocatedExpression, x: &Point<D>, v: f64, what: &str| {
            let at: Vec<String> = x.iter().map(|c| format!("{c:.6}")).collect();
            self.head.problem.error(&p.key, format!("`{}` is {v} at ({}), t = {time}: {what}", p.key, at.join(", ")))
        };
        let finite = "it must be finite everywhere in the membrane";
        let fields: Vec<(&LocatedExpression, SharedField<D>, bool)> =
            std::iter::once((&self.tension, membrane.tension.clone(), true))
                .chain(self.loads.values().map(|l| (l, field(&l.expression, time), false)))
                .chain(self.contacts.iter().zip(&membrane.obstacles.0).flat_map(|(c, o)| {
                    let adhesion = c.adhesion.iter().zip(&o.adhesion).map(|(placed, e)| (placed, e.clone(), true));
                    std::iter::once((&c.height, o.height.clone(), true)).chain(adhesion)
                }))
                .collect();
        for cell in 0..quadrature.cells.len() {
            for (_, points) in quadrature.volumes(membrane, cell) {
                for p in points.iter() {
                    for (i, (placed, f, derivatives)) in fields.iter().enumerate() {
                        let jet = if *derivatives { f.jet(&p.x) } else { Jet::constant(f.value(&p.x)) };
                        if !jet.value.is_finite() {
                            failure.get_or_insert_with(|| wrong(placed, &p.x, jet.value, finite));
                        } else if !jet.is_finite() {
                            failure.get_or_insert_with(|| {
                                wrong(placed, &p.x, jet.value, "its derivatives are not finite there")
                            });
                        } else if i == 0 && jet.value <= 0.0 {
                            failure
                                .get_or_insert_with(|| wrong(placed, &p.x, jet.value, "the tension must be positive"));
                        } else if jet.value < 0.0 && placed.key.ends_with("energy") {
                            failure.get_or_insert_with(|| {
                                wrong(placed, &p.x, jet.value, "the adhesion energy must not be negative")
                            });
                        }
                    }
                }
            }
            if let Some(error) = failure {
                return Err(error);
            }
        }
        for contact in &self.contacts {
            let Some([low, high]) = contact.height.expression.as_height().and_then(|r| r.known_within()) else {
                continue;
            };
            let shift = contact.displacement_at(time);
            let slack = 1e-9 * (high - low).max();
            for cell in 0..quadrature.cells.len() {
                for (_, points) in quadrature.volumes(membrane, cell) {
                    let beyond = |p: &&QuadraturePoint<D>| {
                        (0..D).any(|k| p.x[k] - shift[k] < low[k] - slack || p.x[k] - shift[k] > high[k] + slack)
                    };
                    if let Some(p) = points.iter().find(beyond) {
                        let at: Vec<String> = p.x.iter().map(|c| format!("{c:.6}")).collect();
                        let message = format!(
                            "the height map does not reach the membrane at ({}), t = {time}: it covers x from {:.6} to {:.6}, y \
                             from {:.6} to {:.6}",
                            at.join(", "),
                            low[0] + shift[0],
                            high[0] + shift[0],
                            low[1] + shift[1],
                            high[1] + shift[1]
                        );
                        return Err(self
                            .head
                            .problem
                            .error(&contact.height.key, message)
                            .help("use a larger map (check `origin` and `spacing`), or move it less"));
                    }
                }
            }
        }
        if membrane.obstacles.sides().count() == 2 {
            for cell in 0..quadrature.cells.len() {
                for (_, points) in quadrature.volumes(membrane, cell) {
                    for p in points.iter() {
                        let [low, high] = Side::BOTH.map(|side| membrane.obstacles.height(side, &p.x));
                        let ceiling = membrane.obstacles.index_at(Side::Above, &p.x).map(|i| &self.contacts[i]);
                        if let (true, Some(ceiling)) = (low >= high, ceiling) {
                            let what = format!(
                                "the height of the body below reaches {low} there, and there is no space left for the \
                                 membrane"
                            );
                            return Err(wrong(&ceiling.height, &p.x, high, &what).help("raise this body"));
                        }
                    }
                }
            }
        }
        for p in &quadrature.rim {
            let Some(support) = &membrane.supports[p.piece] else { continue };
            let planned = &self.supports[support.index];
            let held = support.displacement.value(&p.x);
            if !held.is_finite() {
                return Err(wrong(&planned.displacement, &p.x, held, finite));
            }
            for (contact, obstacle) in self.contacts.iter().zip(&membrane.obstacles.0) {
                let height = obstacle.height.value(&p.x);
                let slack = 1e-9 * (height.abs() + held.abs() + membrane.size() * 1e-6);
                if obstacle.side.sign() * (held - height) < -slack {
                    let (place, help) = match obstacle.side {
                        Side::Below => (
                            "above",
                            "lower the body there, or raise the support; for a body above the membrane:  side = \
                             \"above\"",
                        ),
                        Side::Above => (
                            "below",
                            "raise the body there, or lower the support; for a body below the membrane:  side = \
                             \"below\"",
                        ),
                    };
                    let what = format!(
                        "`{}` lies {place} the displacement {held} prescribed by the support `{}`",
                        contact.body, planned.name
                    );
                    return Err(wrong(&contact.height, &p.x, height, &what).help(help));
                }
            }
        }
        Ok(())
    }
}
