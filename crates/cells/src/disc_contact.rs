//! Contact by discs between bodies of a system, or within one (discrete cell to cell, DCTC, of Konyukhov, Lorenz &
//! Schweizerhof, Comput. Mech. 56, 2015).
//!
//! Disc or ball `i` stands for a part `w_i` of a boundary that was resampled evenly. Its centre is `c_i = X_i - χ n_i + u_i`,
//! so that it touches the boundary from within; as published it is `X_i + u_i`, which makes bodies meet a radius each too
//! early. Pairs repel with the energy `½ ε √(w_i w_j) ⟨χ_i + χ_j - |c_i - c_j|⟩²`: with `q = (c_i - c_j)/r`, overlap `o` and
//! `A = ε √(w_i w_j)`, force `A o q` on `i` and its opposite on `j`, tangent `A (q q - (o/r)(1 - q q))`. Forces of a pair
//! cancel to the last digit. They act on the points of the boundary, not on the centres: moments cancel as far as normals
//! oppose each other.
//!
//! Rules for the radius, with the largest spacing `s`: below `s/2` discs slip through between two others; the
//! larger it is the smoother is the contact (the force of a row of discs varies by `s²/16χ` along it); above half of the
//! thickness of the material centres of opposite faces cross. `χ = s` serves. Pairs that overlap before anything moves,
//! or within a body have normals that do not oppose each other (`n_i·n_j > -0.3`), are neighbours and do not touch.

use crate::spread::SAME_FACE;
use signorini_contact::Status;
use signorini_geometry::{Matrix, Point, Vector};
use signorini_mechanics::contact::Part;
use signorini_mechanics::interaction::{NotItsHistory, OuterIteration, penalty_factor};
use signorini_mechanics::{
    Assembler, Bodies, Body, ContactLaw, Drawn, Enforcement, Function, Interaction, InteractionUnknowns, Iterated,
    Passing, PlaceError, Sampling, Site, SiteResult,
};
use std::collections::BTreeMap;

/// Where the centres of discs are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Centres {
    /// A radius within the material: discs touch the boundary.
    Within,
    /// On the boundary, as published.
    OnBoundary,
}

/// How a surface is covered by discs. What is left out is found: the radius from the spacing, the spacing from the radius,
/// and without both from the functions of the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiscCovering {
    pub radius: Option<f64>,
    pub spacing: Option<f64>,
    pub centres: Centres,
}

/// What the discs of a surface are like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoverFindings {
    pub discs: usize,
    pub radius: f64,
    /// Largest distance between neighbours.
    pub spacing: f64,
    /// Least thickness of the material behind a disc; infinite where nothing lies behind.
    pub thickness: f64,
}

impl CoverFindings {
    /// Whether discs slip through between two others.
    pub fn is_too_small(&self) -> bool {
        self.radius < 0.5 * self.spacing
    }

    /// Whether centres of opposite faces of the material cross.
    pub fn is_too_large(&self) -> bool {
        self.radius >= 0.5 * self.thickness
    }
}

/// A disc or a ball.
struct Disc {
    site: Site,
    /// Normal and centre at the start.
    normal: Vector<3>,
    start: Point<3>,
    /// From the point of the boundary to the centre.
    arm: Vector<3>,
    /// Pressure per overlap.
    stiffness: f64,
}

/// The discs of a surface.
struct Surface {
    part: Part,
    discs: Vec<Disc>,
    radius: f64,
}

/// Contact by discs.
pub struct DiscPairs {
    name: String,
    surfaces: Vec<Surface>,
    /// A penalty.
    law: ContactLaw,
    /// What multiplies the stiffness of the bodies.
    factor: f64,
}

/// A contact that carries gives way by a hundredth of what the bodies do.
const STIFFER: f64 = 100.0;

/// A disc where it is now.
struct Now {
    x: Point<3>,
    centre: Point<3>,
    functions: Vec<Function>,
}

/// Two discs that overlap, by their places among the discs of all surfaces.
struct Overlap {
    pair: [usize; 2],
    depth: f64,
    distance: f64,
    /// Unit vector from the second to the first.
    q: Vector<3>,
    stiffness: f64,
}

impl Surface {
    fn new((part, body): (Part, &dyn Body), cover: &DiscCovering) -> Result<(Self, CoverFindings), PlaceError> {
        let on = part.group.as_deref();
        let spacing = match (cover.spacing, cover.radius) {
            (Some(spacing), _) => spacing,
            // Neighbours are at most two spacings apart.
            (None, Some(radius)) => 0.5 * radius,
            (None, None) => {
                let sites = body.sites(on, Sampling::Nodes)?;
                let start = body.start();
                let places: Vec<Point<3>> = sites.iter().map(|s| body.placed(&start, s).x).collect();
                nearest_distance(&places)
            }
        };
        let (sites, spacing) = body.spread_sites(on, spacing)?.ok_or_else(|| PlaceError::Unsuitable {
            body: body.name().to_string(),
            message: "contact by discs is for bodies of finite cells only".to_string(),
        })?;
        let radius = cover.radius.unwrap_or(spacing);
        let offset = if cover.centres == Centres::Within { radius } else { 0.0 };
        let start = body.start();
        let disc = |site: Site| {
            let placed = body.placed(&start, &site);
            let normal = placed.outward.unwrap_or_default();
            let arm = normal * -offset;
            Disc { site, normal, start: placed.x + arm, arm, stiffness: body.site_stiffness(&site) / site.weight }
        };
        let discs: Vec<Disc> = sites.into_iter().map(disc).collect();
        let findings = CoverFindings { discs: discs.len(), radius, spacing, thickness: thickness(&discs) };
        Ok((Surface { part, discs, radius }, findings))
    }
}

/// The median distance of points to the nearest other one.
fn nearest_distance(points: &[Point<3>]) -> f64 {
    let nearest = |x: &Point<3>| {
        let others = points.iter().map(|y| (x - y).norm()).filter(|d| *d > 0.0);
        others.fold(f64::INFINITY, f64::min)
    };
    let mut all: Vec<f64> = points.iter().map(nearest).collect();
    all.sort_by(f64::total_cmp);
    all.get(all.len() / 2).copied().unwrap_or(1.0)
}

/// Cosine within which a point lies straight behind another one: among discs there is hardly one exactly there.
const STRAIGHT: f64 = 0.95;

/// Least distance through the material to the other face of it.
fn thickness(discs: &[Disc]) -> f64 {
    let mut least = f64::INFINITY;
    for (i, a) in discs.iter().enumerate() {
        for b in &discs[..i] {
            let through = (b.start - b.arm) - (a.start - a.arm);
            let distance = through.norm();
            let along = STRAIGHT * distance;
            let behind = -through.dot(&a.normal) > along && through.dot(&b.normal) > along;
            if behind && a.normal.dot(&b.normal) <= SAME_FACE {
                least = least.min(distance);
            }
        }
    }
    least
}

impl DiscPairs {
    /// Contact of two surfaces, or of one with itself. What is found about the discs of each.
    ///
    /// # Errors
    /// Places that cannot be covered.
    pub fn new(
        name: &str,
        first: (Part, &dyn Body),
        second: Option<(Part, &dyn Body)>,
        cover: &DiscCovering,
        wanted: Option<f64>,
    ) -> Result<(Self, Vec<CoverFindings>), PlaceError> {
        let mut surfaces = Vec::new();
        let mut findings = Vec::new();
        for side in [Some(first), second].into_iter().flatten() {
            let (surface, found) = Surface::new(side, cover)?;
            surfaces.push(surface);
            findings.push(found);
        }
        let penalty = Enforcement::Penalty { wanted_penetration: wanted };
        let law = ContactLaw::new(penalty, Vec::new(), Vec::new());
        Ok((DiscPairs { name: name.to_string(), surfaces, law, factor: STIFFER }, findings))
    }

    fn discs(&self) -> impl Iterator<Item = (&Surface, &Disc)> {
        self.surfaces.iter().flat_map(|s| s.discs.iter().map(move |d| (s, d)))
    }

    /// How far discs overlap before anything moves; not positive where none do, or they are neighbours.
    pub fn overlap_at_start(&self) -> f64 {
        let at_rest = |(_, d): (&Surface, &Disc)| Now { x: d.start - d.arm, centre: d.start, functions: Vec::new() };
        let now: Vec<Now> = self.discs().map(at_rest).collect();
        // Surfaces that touch meet up to rounding.
        let rounding = 1e-9 * self.surfaces.iter().map(|s| s.radius).fold(0.0, f64::max);
        self.overlaps(&now).iter().map(|o| o.depth).fold(0.0, f64::max) - rounding
    }

    fn now(&self, at: Bodies<'_>) -> Vec<Now> {
        self.discs()
            .map(|(surface, disc)| {
                let body = surface.part.body;
                let mut placed = at.bodies[body].placed(&at.states[body], &disc.site);
                placed.functions.iter_mut().for_each(|f| f.unknown += at.first[body]);
                Now { x: placed.x, centre: placed.x + disc.arm, functions: placed.functions }
            })
            .collect()
    }

    /// Pairs that overlap: by a grid of boxes of the largest diameter.
    fn overlaps(&self, now: &[Now]) -> Vec<Overlap> {
        let all: Vec<(&Surface, &Disc)> = self.discs().collect();
        let edge = 2.0 * self.surfaces.iter().map(|s| s.radius).fold(f64::MIN_POSITIVE, f64::max);
        let place = |x: &Point<3>| -> [i64; 3] { std::array::from_fn(|k| (x[k] / edge).floor() as i64) };
        let mut boxes: BTreeMap<[i64; 3], Vec<usize>> = BTreeMap::new();
        now.iter().enumerate().for_each(|(i, n)| boxes.entry(place(&n.centre)).or_default().push(i));
        let mut out = Vec::new();
        for (i, own) in now.iter().enumerate() {
            let at = place(&own.centre);
            for neighbour in 0..27 {
                let key: [i64; 3] = std::array::from_fn(|k| at[k] + (neighbour / 3i64.pow(k as u32) % 3) - 1);
                for &j in boxes.get(&key).into_iter().flatten().filter(|j| **j > i) {
                    let ((sa, a), (sb, b)) = (all[i], all[j]);
                    let d = own.centre - now[j].centre;
                    let distance = d.norm();
                    let both = sa.radius + sb.radius;
                    let same_body = sa.part.body == sb.part.body;
                    let between = self.surfaces.len() == 1 || !std::ptr::eq(sa, sb);
                    let is_neighbour =
                        same_body && (a.normal.dot(&b.normal) > SAME_FACE || (a.start - b.start).norm() < both);
                    if distance < both && distance > 0.0 && between && !is_neighbour {
                        let stiffness =
                            self.factor * a.stiffness.min(b.stiffness) * (a.site.weight * b.site.weight).sqrt();
                        let (depth, q) = (both - distance, d / distance);
                        out.push(Overlap { pair: [i, j], depth, distance, q, stiffness });
                    }
                }
            }
        }
        out.sort_by_key(|o| o.pair);
        out
    }
}

impl Interaction for DiscPairs {
    fn name(&self) -> &str {
        &self.name
    }

    fn parts(&self) -> [&Part; 2] {
        [&self.surfaces[0].part, &self.surfaces[self.surfaces.len() - 1].part]
    }

    fn law(&self) -> &ContactLaw {
        &self.law
    }

    fn law_mut(&mut self) -> &mut ContactLaw {
        &mut self.law
    }

    fn stiffness(&self, _: &[Box<dyn Body>]) -> f64 {
        self.discs().map(|(_, d)| d.stiffness * d.site.weight).fold(0.0, f64::max)
    }

    fn prepare(&mut self, _: &[Box<dyn Body>], _: f64) {}

    fn add_to(&self, at: Bodies<'_>, _: InteractionUnknowns<'_>, out: &mut Assembler<'_>) -> Result<usize, PlaceError> {
        let now = self.now(at);
        for Overlap { pair: [i, j], depth, distance, q, stiffness } in self.overlaps(&now) {
            let force = q * (stiffness * depth);
            // How the unknowns change the distance of the centres.
            let columns: Vec<(u32, Vector<3>)> = (now[i].functions.iter().map(|f| (f.unknown, f.value)))
                .chain(now[j].functions.iter().map(|f| (f.unknown, -f.value)))
                .collect();
            for (unknown, d) in &columns {
                let value = -force.dot(d);
                out.residual[*unknown as usize] += value;
                out.sizes[*unknown as usize] += value.abs();
            }
            if let Some(tangent) = &mut out.tangent {
                let along = q * q.transpose();
                let local = (along - (Matrix::<3>::identity() - along) * (depth / distance)) * stiffness;
                let unknowns: Vec<u32> = columns.iter().map(|c| c.0).collect();
                let turned: Vec<Vector<3>> = columns.iter().map(|c| local * c.1).collect();
                let block: Vec<f64> = columns.iter().flat_map(|a| turned.iter().map(move |b| a.1.dot(b))).collect();
                tangent.add_block(&unknowns, &block);
            }
        }
        Ok(0)
    }

    fn results(&self, at: Bodies<'_>, _: InteractionUnknowns<'_>) -> Result<Vec<SiteResult>, PlaceError> {
        let now = self.now(at);
        let mut forces = vec![Vector::<3>::zeros(); now.len()];
        let mut deepest = vec![0.0f64; now.len()];
        for Overlap { pair, depth, q, stiffness, .. } in self.overlaps(&now) {
            for (disc, sign) in pair.into_iter().zip([1.0, -1.0]) {
                forces[disc] += q * (sign * stiffness * depth);
                deepest[disc] = deepest[disc].max(depth);
            }
        }
        // Of a surface that touches itself both sides are told, each for one half of the area that touches.
        let share = if self.surfaces.len() == 1 { 0.5 } else { 1.0 };
        let result = |(k, (_, disc)): (usize, (&Surface, &Disc))| {
            let size = forces[k].norm();
            let touches = deepest[k] > 0.0;
            SiteResult {
                x: now[k].x,
                normal: if size > 0.0 { forces[k] / size } else { -disc.normal },
                weight: share * disc.site.weight,
                gap: touches.then_some(-deepest[k]),
                pressure: size / disc.site.weight,
                status: if touches { Status::Slip } else { Status::Open },
                ..SiteResult::default()
            }
        };
        // Those of the first surface, on which the forces that are told act.
        Ok(self.discs().enumerate().take(self.surfaces[0].discs.len()).map(result).collect())
    }

    fn accept(&mut self, _: Bodies<'_>, _: InteractionUnknowns<'_>) -> Result<(), PlaceError> {
        Ok(())
    }

    fn augment(
        &mut self,
        _: Bodies<'_>,
        _: InteractionUnknowns<'_>,
        found: &[SiteResult],
        _: OuterIteration,
    ) -> Result<f64, PlaceError> {
        let wanted = match self.law.enforcement {
            Enforcement::Penalty { wanted_penetration } => wanted_penetration,
            _ => None,
        };
        let factor = wanted.and_then(|wanted| penalty_factor(found, wanted));
        self.factor *= factor.unwrap_or(1.0);
        Ok(factor.map_or(0.0, |f| (f - 1.0).abs()))
    }

    fn history(&self) -> [Vec<f64>; 2] {
        [Vec::new(), vec![self.factor]]
    }

    fn restore(&mut self, [sites, scales]: &[Vec<f64>; 2]) -> Result<(), NotItsHistory> {
        match (&sites[..], &scales[..]) {
            ([], [factor]) => {
                self.factor = *factor;
                Ok(())
            }
            _ => Err(NotItsHistory { contact: self.name.clone() }),
        }
    }
}

impl Iterated for DiscPairs {}

impl Passing for DiscPairs {}

impl Drawn for DiscPairs {}

impl signorini_mechanics::Conducting for DiscPairs {}
