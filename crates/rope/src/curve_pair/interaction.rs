//! Contact between curves as an interaction of a system: assembly, results, history.

use super::contact::{CurveContact, CurveContactPoint};
use super::friction::{Tangential, followed};
use super::history::{ContactHistory, Predicted};
use super::search::{CurvePoint, Searched};
use signorini_contact::{Law, Status};
use signorini_geometry::Vector;
use signorini_mechanics::body::{Body, Order, PlaceError};
use signorini_mechanics::interaction::{
    Assembler, Bodies, Drawn, Interaction, InteractionUnknowns, Iterated, NotItsHistory, OuterIteration, Passing,
    penalty_factor,
};
use signorini_mechanics::passage::StatePath;
use signorini_mechanics::{ContactLaw, Curve, Enforcement, Part, SiteResult};

/// Of the second derivative of the squared distance, relative to that between straight lines, what is hardly any: nearest points
/// move fifty times as far as curves.
const FOCAL: f64 = 0.02;

impl CurveContact {
    /// One of the curves.
    fn curve<'a>(&self, at: Bodies<'a>, side: usize) -> Result<Box<dyn Curve + 'a>, PlaceError> {
        let part = &self.parts[side];
        let body = at.bodies[part.body].as_ref();
        body.curve(part.group.as_deref()).ok_or_else(|| PlaceError::Unsuitable {
            body: body.name().to_string(),
            message: "contact between curves is for ropes, beams and edges of solids".to_string(),
        })
    }

    /// Does something with both curves in a state and their first unknowns.
    fn with<T>(&self, at: Bodies<'_>, act: impl FnOnce([Searched<'_>; 2], [u32; 2]) -> T) -> Result<T, PlaceError> {
        let curves = [self.curve(at, 0)?, self.curve(at, 1)?];
        let configuration = |k: usize| &at.states[self.parts[k].body].configuration[..];
        let sides = [0, 1].map(|k| Searched { curve: curves[k].as_ref(), configuration: configuration(k) });
        Ok(act(sides, self.parts.each_ref().map(|part| part.body).map(|b| at.first[b])))
    }

    /// What is kept of a contact: with the traction as a multiplier, or so that the slip is that of the traction.
    fn kept(&self, c: &CurveContactPoint, rubs: Option<&Tangential>, sides: [Searched<'_>; 2]) -> ContactHistory {
        let before = c.kept;
        let mut kept = ContactHistory {
            key: c.key,
            force: c.force,
            traction: [0.0; 2],
            normal: c.pair.normal,
            stuck: Some(c.pair.stuck),
            slip: [0.0; 2],
        };
        let Some(rubs) = rubs else { return kept };
        let slipped = before.map_or([0.0; 2], |k| k.slip);
        kept.slip = [0, 1].map(|a| slipped[a] + rubs.slipped[a]);
        kept.traction = rubs.components;
        if let Enforcement::Penalty { .. } = self.law.enforcement {
            // What is viscous creeps below the limit too.
            kept.stuck = match rubs.slipped {
                [0.0, 0.0] => before.and_then(|k| k.stuck),
                _ => {
                    let feet = [0, 1].map(|k| {
                        let CurvePoint { element, xi, .. } = c.points[k];
                        sides[k].curve.foot(sides[k].configuration, element, xi, 1)
                    });
                    Some(followed(&c.pair, [&feet[0], &feet[1]], rubs.components, c.penalty))
                }
            };
        }
        kept
    }
}

fn site_result(c: &CurveContactPoint, x: Vector<3>, rubs: Option<&Tangential>, law: Option<&dyn Law>) -> SiteResult {
    let mut out =
        SiteResult { x, normal: c.pair.normal, weight: c.weight, gap: Some(c.pair.gap), ..SiteResult::default() };
    if c.force == 0.0 {
        return out;
    }
    let share = c.share.0 / c.weight;
    out.pressure = -c.force * share;
    out.status = rubs.map_or(Status::Slip, |r| r.status);
    if let (Some(r), Some(law)) = (rubs, law) {
        let axes = [c.pair.axial, c.pair.circumferential()];
        // The traction of the law is that along the slip; on the slave acts its opposite.
        out.friction = -(axes[0] * r.components[0] + axes[1] * r.components[1]) * share;
        out.increment = axes[0] * r.slipped[0] + axes[1] * r.slipped[1];
        out.utilisation = law.utilisation(r.components, -c.force);
        let before = c.kept.map_or([0.0; 2], |k| k.slip);
        out.slip = (before[0] + r.slipped[0]).hypot(before[1] + r.slipped[1]);
    }
    out
}

/// Adds a contact to residual and tangent.
fn assemble(c: &CurveContactPoint, rubs: Option<&Tangential>, out: &mut Assembler<'_>) {
    let (pair, (share, slope)) = (&c.pair, c.share);
    let n = pair.unknowns.len();
    let force = c.acting(if out.tangent.is_some() { Order::Second } else { Order::First });
    for k in 0..n {
        let unknown = pair.unknowns[k] as usize;
        let pressed = share * force * pair.d_gap[k];
        let rubbed = rubs.map_or(0.0, |r| share * r.forces[k]);
        out.residual[unknown] += pressed + rubbed;
        out.sizes[unknown] += pressed.abs() + rubbed.abs();
    }
    let Some(tangent) = &mut out.tangent else { return };
    if force == 0.0 {
        return;
    }
    let mut block = vec![0.0; n * n];
    for k in 0..n {
        for l in 0..n {
            let pressed = c.penalty * pair.d_gap[k] * pair.d_gap[l] + c.geometric() * pair.d2_gap[k * n + l];
            let turned = (force * pair.d_gap[k] + rubs.map_or(0.0, |r| r.forces[k])) * slope * pair.d_parallel[l];
            block[k * n + l] = share * pressed + turned;
        }
    }
    tangent.add_block(&pair.unknowns, &block);
    if let Some(r) = rubs {
        let block: Vec<f64> = r.tangent.iter().map(|v| v * share).collect();
        tangent.add_block(&r.unknowns, &block);
    }
}

impl Interaction for CurveContact {
    fn name(&self) -> &str {
        &self.name
    }

    fn parts(&self) -> [&Part; 2] {
        self.parts.each_ref()
    }

    fn law(&self) -> &ContactLaw {
        &self.law
    }

    fn law_mut(&mut self) -> &mut ContactLaw {
        &mut self.law
    }

    fn stiffness(&self, bodies: &[Box<dyn Body>]) -> f64 {
        let of = |part: &Part| {
            let curve = bodies[part.body].curve(part.group.as_deref());
            let list = curve.iter().flat_map(|c| (0..c.elements()).map(|e| c.stiffness(e)));
            list.filter(|c| c.is_finite()).fold(0.0, f64::max)
        };
        self.parts.iter().map(of).fold(0.0, f64::max)
    }

    fn prepare(&mut self, bodies: &[Box<dyn Body>], _: f64) {
        let curves = self.parts.each_ref().map(|p| bodies[p.body].curve(p.group.as_deref()));
        if let [Some(slave), Some(master)] = curves {
            self.set_penalties([slave.as_ref(), master.as_ref()]);
        }
    }

    fn add_to(
        &self,
        at: Bodies<'_>,
        own: InteractionUnknowns<'_>,
        out: &mut Assembler<'_>,
    ) -> Result<usize, PlaceError> {
        let order = if out.tangent.is_some() { Order::Second } else { Order::First };
        self.with(at, |sides, first| {
            let (touches, lost) = self.touches(sides, first, order, &Predicted::list(own.prediction));
            for c in &touches {
                let rubs = self.tangential(c, sides, first, order);
                assemble(c, rubs.as_ref(), out);
            }
            lost
        })
    }

    fn results(&self, at: Bodies<'_>, own: InteractionUnknowns<'_>) -> Result<Vec<SiteResult>, PlaceError> {
        self.with(at, |sides, first| {
            let (touches, _) = self.touches(sides, first, Order::First, &Predicted::list(own.prediction));
            let result = |c: &CurveContactPoint| {
                let CurvePoint { element, xi, .. } = c.points[0];
                let x = sides[0].curve.jet(sides[0].configuration, element, xi).x;
                let rubs = self.tangential(c, sides, first, Order::First);
                let found = site_result(c, x, rubs.as_ref(), self.law.friction.as_deref());
                SiteResult { radius: sides[0].curve.radius(), ..found }
            };
            touches.iter().map(result).collect()
        })
    }

    fn accept(&mut self, at: Bodies<'_>, _: InteractionUnknowns<'_>) -> Result<(), PlaceError> {
        self.history = self.with(at, |sides, first| {
            let (touches, _) = self.touches(sides, first, Order::First, &[]);
            let kept =
                |c: &CurveContactPoint| self.kept(c, self.tangential(c, sides, first, Order::First).as_ref(), sides);
            touches.iter().map(kept).collect()
        })?;
        self.law.accept(Vec::new());
        Ok(())
    }

    fn augment(
        &mut self,
        at: Bodies<'_>,
        _: InteractionUnknowns<'_>,
        found: &[SiteResult],
        around: OuterIteration,
    ) -> Result<f64, PlaceError> {
        match self.law.enforcement {
            Enforcement::Penalty { wanted_penetration: Some(wanted) } => Ok(match penalty_factor(found, wanted) {
                Some(factor) => {
                    self.penalties.point *= factor;
                    self.penalties.line *= factor;
                    (factor - 1.0).abs()
                }
                None => 0.0,
            }),
            Enforcement::Penalty { .. } => Ok(0.0),
            _ => {
                let touches: Vec<(CurveContactPoint, [f64; 2])> = self.with(at, |sides, first| {
                    let (touches, _) = self.touches(sides, first, Order::First, &[]);
                    let rubs = |c: &CurveContactPoint| self.tangential(c, sides, first, Order::First);
                    touches
                        .into_iter()
                        .map(|c| (rubs(&c).map_or([0.0; 2], |t| t.components), c))
                        .map(|(t, c)| (c, t))
                        .collect()
                })?;
                let most = touches.iter().map(|(c, _)| c.pressing() / c.weight).fold(0.0f64, f64::max);
                let mut change = 0.0f64;
                let mut history = Vec::with_capacity(touches.len());
                for (c, traction) in &touches {
                    let before = c.kept.map_or([0.0; 3], |k| [k.force, k.traction[0], k.traction[1]]);
                    let now = [c.force, traction[0], traction[1]];
                    let changed = (0..3).map(|i| (now[i] - before[i]).abs()).fold(0.0, f64::max);
                    // Gaps are known to the rounding of positions only.
                    let counts = changed > around.known * c.penalty && most > 0.0;
                    change = change.max(if counts { changed * c.share.0 / (c.weight * most) } else { 0.0 });
                    history.push(ContactHistory {
                        key: c.key,
                        force: c.force,
                        traction: *traction,
                        normal: c.pair.normal,
                        stuck: c.kept.and_then(|k| k.stuck),
                        slip: c.kept.map_or([0.0; 2], |k| k.slip),
                    });
                }
                self.history = history;
                Ok(change)
            }
        }
    }

    fn history(&self) -> [Vec<f64>; 2] {
        [
            self.history.iter().flat_map(|k| k.numbers()).collect(),
            vec![self.penalties.point, self.penalties.line, self.law.times[0]],
        ]
    }

    fn restore(&mut self, [kept, scales]: &[Vec<f64>; 2]) -> Result<(), NotItsHistory> {
        let [point, line, time] = scales[..] else { return Err(NotItsHistory { contact: self.name.clone() }) };
        if !kept.len().is_multiple_of(ContactHistory::NUMBERS) {
            return Err(NotItsHistory { contact: self.name.clone() });
        }
        self.history = ContactHistory::list(kept);
        self.penalties = super::contact::Penalties { point, line };
        self.law.times = [time; 2];
        Ok(())
    }
}

impl Iterated for CurveContact {
    fn unload(&mut self) {
        self.history.iter_mut().for_each(|k| (k.force, k.traction) = (0.0, [0.0; 2]));
    }

    /// Where a curve bends towards the other as sharply as they are apart, its nearest point is about to part in two.
    fn ill_conditioning(&self, at: Bodies<'_>) -> Option<String> {
        let name = |side: usize| at.bodies[self.parts[side].body].name();
        let worst = self.with(at, |sides, first| {
            let (touches, _) = self.touches(sides, first, Order::First, &[]);
            let bend = |c: &CurveContactPoint| {
                let jets =
                    [0, 1].map(|s| sides[s].curve.jet(sides[s].configuration, c.points[s].element, c.points[s].xi));
                let d = jets[0].x - jets[1].x;
                [(0, d), (1, -d)]
                    .map(|(s, d)| (1.0 + d.dot(&jets[s].d2) / jets[s].d1.norm_squared(), s, jets[s].x, d.norm()))
            };
            let closed = touches.iter().filter(|c| c.force < 0.0);
            closed.flat_map(bend).min_by(|p, q| p.0.total_cmp(&q.0))
        });
        let (left, side, x, apart) = worst.ok()?.filter(|w| w.0 < FOCAL)?;
        Some(format!(
            "contact `{}`: at ({:.4}, {:.4}, {:.4}) the curvature of `{}` towards `{}` has a radius of {:.3} times \
             the distance of their axes, {apart:.4}; below 1 the closest point is not defined; use thinner sections, \
             or stiffer ones",
            self.name,
            x[0],
            x[1],
            x[2],
            name(side),
            name(1 - side),
            1.0 / (1.0 - left)
        ))
    }

    fn prediction(&self) -> Vec<f64> {
        let closed = self.history.iter().filter(|k| k.force < 0.0);
        closed.flat_map(|k| Predicted { key: k.key, force: k.force, trial: k.traction }.numbers()).collect()
    }

    fn predict(&self, at: Bodies<'_>, own: InteractionUnknowns<'_>, step: &[f64], share: f64) -> Vec<f64> {
        let predicted = |c: &CurveContactPoint, rubs: Option<Tangential>| {
            // A new contact has no force that could turn.
            if c.force == 0.0 && c.predicted.is_none() {
                return None;
            }
            let change = |unknowns: &[u32], by: &dyn Fn(usize) -> f64| -> f64 {
                unknowns.iter().enumerate().map(|(k, u)| share * step[*u as usize] * by(k)).sum()
            };
            let force = c.trial + c.penalty * change(&c.pair.unknowns, &|k| c.pair.d_gap[k]);
            let trial =
                rubs.map_or([0.0; 2], |r| [0, 1].map(|a| r.trial[a] + change(&r.unknowns, &|k| r.d_trial[k][a])));
            (force < 0.0).then_some(Predicted { key: c.key, force, trial })
        };
        let found = self.with(at, |sides, first| {
            let (touches, _) = self.touches(sides, first, Order::First, &Predicted::list(own.prediction));
            let one = |c: &CurveContactPoint| predicted(c, self.rubbing(c, sides, first, Order::First));
            touches.iter().filter_map(one).flat_map(|p| p.numbers()).collect()
        });
        found.unwrap_or_default()
    }
}

impl Passing for CurveContact {
    fn free_way(&self, path: StatePath<'_>) -> Result<f64, PlaceError> {
        self.with(path.from, |from, _| self.with(path.to, |to, _| self.share_of_way(from, to)))?
    }
}

impl Drawn for CurveContact {}

impl signorini_mechanics::Conducting for CurveContact {}
