//! What ropes and beams have in common as bodies that touch: the curve with its sections, and sites along it.

use crate::centreline::{Centreline, Closure, Continuity};
use crate::hermite::{gauss, lobatto};
use crate::place::{self, Part};
use signorini_geometry::shape::CurveJet;
use signorini_geometry::{Matrix, Point, Vector};
use signorini_mechanics::body::{Body, BodyState, Foot, Function, Master, PlaceError, Sampling, Site, SlavePoint};
use signorini_mechanics::curve::{Curve, CurveMaster, CurvePoint};

/// How a section turns.
#[derive(Clone, Debug)]
pub struct SectionMotion {
    /// Spin per unit of each unknown.
    pub spin: Vec<Function>,
    pub frame: Matrix<3>,
}

/// A body that is a curve.
pub trait CurveBody: Body {
    fn centreline(&self) -> &Centreline;

    /// Radius of the section about the curve that touches.
    fn radius(&self) -> f64;

    /// Points of Gauss of each element at which contact is tested.
    fn contact_points(&self) -> usize;

    /// How the section at a point turns: not at all, if the body does not know.
    fn section(&self, _configuration: &[f64], _element: usize, _xi: f64) -> SectionMotion {
        SectionMotion { spin: Vec::new(), frame: Matrix::<3>::identity() }
    }

    /// Second variations of the spin of a section, as [`Curve::spin_bends`].
    fn spin_bends(&self, _configuration: &[f64], _element: usize, _xi: f64) -> Vec<Vector<3>> {
        Vec::new()
    }
}

impl Curve for &dyn CurveBody {
    fn elements(&self) -> usize {
        self.centreline().elements()
    }

    fn closure(&self) -> Closure {
        self.centreline().closure
    }

    fn continuity(&self) -> Continuity {
        self.centreline().continuity
    }

    fn arc(&self, element: usize, xi: f64) -> f64 {
        self.centreline().arc(element, xi)
    }

    fn radius(&self) -> f64 {
        (**self).radius()
    }

    fn contact_points(&self) -> usize {
        (**self).contact_points()
    }

    fn jet(&self, configuration: &[f64], element: usize, xi: f64) -> CurveJet {
        self.centreline().jet(configuration, element, xi)
    }

    fn hull(&self, configuration: &[f64], element: usize) -> Vec<Point<3>> {
        self.centreline().hull(configuration, element)
    }

    fn spin_bends(&self, configuration: &[f64], element: usize, xi: f64) -> Vec<Vector<3>> {
        (**self).spin_bends(configuration, element, xi)
    }

    fn stiffness(&self, element: usize) -> f64 {
        self.site_stiffness(&Site { patch: element as u32, xi: [0.5, 0.0], weight: 1.0 })
    }

    fn foot(&self, configuration: &[f64], element: usize, xi: f64, coordinates: usize) -> Foot {
        let SectionMotion { spin, frame } = self.section(configuration, element, xi);
        let jet = self.centreline().jet(configuration, element, xi);
        let functions = self.centreline().functions(element, xi);
        let foot = CurvePoint { element, xi, coordinates }.foot(&jet, (**self).radius(), functions);
        Foot { spin, frame, ..foot }
    }
}

/// The points of a curve that are tested for contact.
///
/// # Errors
/// A place that is not there.
pub fn sites(body: &dyn CurveBody, on: Option<&str>, sampling: Sampling) -> Result<Vec<Site>, PlaceError> {
    let line = body.centreline();
    let node_site = |node: usize| {
        let tributary = |e: usize| 0.5 * line.lengths[e];
        let n = line.elements();
        let (patch, xi) = if node < n { (node, 0.0) } else { (n - 1, 1.0) };
        let before = match (node, line.closure) {
            (0, Closure::Closed) => tributary(n - 1),
            (0, Closure::Open) => 0.0,
            _ => tributary(node - 1),
        };
        let after = if node < n { tributary(node) } else { 0.0 };
        Site { patch: patch as u32, xi: [xi, 0.0], weight: before + after }
    };
    Ok(match (place::part(body.name(), line, on)?, sampling) {
        (Part::Nodes(nodes), _) => nodes.into_iter().map(|n| Site { weight: 1.0, ..node_site(n) }).collect(),
        (Part::Whole, Sampling::Nodes) => (0..line.nodes()).map(node_site).collect(),
        (Part::Whole, Sampling::GaussPoints) => {
            let rules = [gauss(body.contact_points()), lobatto(body.contact_points() + 1)];
            let last = line.elements() - 1;
            // Free ends touch first.
            let has_end = |e: usize| line.closure == Closure::Open && (e == 0 || e == last);
            (0..=last)
                .flat_map(|e| {
                    let (h, rule) = (line.lengths[e], &rules[usize::from(has_end(e))]);
                    rule.iter().map(move |(xi, w)| Site { patch: e as u32, xi: [*xi, 0.0], weight: w * h })
                })
                .collect()
        }
    })
}

/// A site where it is now.
pub fn placed(body: &dyn CurveBody, state: &BodyState, site: &Site) -> SlavePoint {
    let (element, xi) = (site.patch as usize, site.xi[0]);
    let line = body.centreline();
    let jet = line.jet(&state.configuration, element, xi);
    let SectionMotion { spin, frame } = body.section(&state.configuration, element, xi);
    SlavePoint {
        x: jet.x,
        outward: None,
        averaged: None,
        rests: false,
        tangent: Some(jet.d1),
        radius: body.radius(),
        functions: line.functions(element, xi),
        spin,
        spin_bends: body.spin_bends(&state.configuration, element, xi),
        frame,
        turn: None,
        bends: Vec::new(),
    }
}

/// The curve, where a place is all of it.
pub fn curve<'a, B: CurveBody>(body: &'a B, on: Option<&str>) -> Option<Box<dyn Curve + 'a>> {
    let is_whole = matches!(place::part(body.name(), body.centreline(), on), Ok(Part::Whole));
    is_whole.then(|| Box::new(body as &dyn CurveBody) as _)
}

/// The curve as it may be touched.
///
/// # Errors
/// A part of it.
pub fn master<'a, B: CurveBody>(
    body: &'a B,
    on: Option<&str>,
    state: &'a BodyState,
) -> Result<Box<dyn Master + 'a>, PlaceError> {
    if let Part::Nodes(_) = place::part(body.name(), body.centreline(), on)? {
        let message = "contact of a rope or beam is along its whole length: name it without a group".to_string();
        return Err(PlaceError::Unsuitable { body: body.name().to_string(), message });
    }
    Ok(Box::new(CurveMaster::new(Box::new(body as &dyn CurveBody), &state.configuration)))
}
