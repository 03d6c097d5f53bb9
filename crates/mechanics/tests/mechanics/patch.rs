//! A sheet on an elastic foundation, quadratic in both directions: a deformable partner with nothing but geometry.

use signorini_geometry::shape::SurfaceJet;
use signorini_geometry::{Matrix, Point, Vector};
use signorini_mechanics::body::*;

pub struct Sheet {
    pub name: String,
    /// Control points of a quadratic Bézier patch, or of a curve where only the first three count.
    pub nodes: Vec<Point<3>>,
    pub foundation: f64,
    /// 2: a surface; 1: a curve with a section of the radius.
    pub coordinates: usize,
    pub radius: f64,
}

fn bernstein(s: f64) -> [[f64; 3]; 3] {
    let r = 1.0 - s;
    [[r * r, 2.0 * r * s, s * s], [-2.0 * r, 2.0 * (r - s), 2.0 * s], [2.0, -4.0, 2.0]]
}

impl Sheet {
    fn count(&self) -> usize {
        if self.coordinates == 2 { 9 } else { 3 }
    }

    fn weights(&self, xi: [f64; 2]) -> Vec<[f64; 6]> {
        let (a, b) = (bernstein(xi[0]), bernstein(xi[1]));
        (0..self.count())
            .map(|k| {
                let (i, j) = (k % 3, k / 3);
                if self.coordinates == 1 {
                    return [a[0][i], a[1][i], 0.0, a[2][i], 0.0, 0.0];
                }
                [
                    a[0][i] * b[0][j],
                    a[1][i] * b[0][j],
                    a[0][i] * b[1][j],
                    a[2][i] * b[0][j],
                    a[1][i] * b[1][j],
                    a[0][i] * b[2][j],
                ]
            })
            .collect()
    }

    fn jet(&self, state: &BodyState, xi: [f64; 2]) -> SurfaceJet {
        let zero = Vector::<3>::zeros();
        let mut parts = [zero; 6];
        for (k, w) in self.weights(xi).iter().enumerate() {
            let x = Vector::<3>::from_fn(|i, _| self.nodes[k][i] + state.configuration[3 * k + i]);
            (0..6).for_each(|d| parts[d] += x * w[d]);
        }
        // Third derivatives of a product of quadratics: uuv and uvv.
        let (a, b) = (bernstein(xi[0]), bernstein(xi[1]));
        let (mut uuv, mut uvv) = (zero, zero);
        if self.coordinates == 2 {
            for k in 0..9 {
                let (i, j) = (k % 3, k / 3);
                let x = Vector::<3>::from_fn(|c, _| self.nodes[k][c] + state.configuration[3 * k + c]);
                uuv += x * (a[2][i] * b[1][j]);
                uvv += x * (a[1][i] * b[2][j]);
            }
        }
        let [x, u, v, uu, uv, vv] = parts;
        SurfaceJet { x, u, v, uu, uv, vv, uuu: zero, uuv, uvv, vvv: zero }
    }

    fn functions(&self, xi: [f64; 2]) -> Vec<Function> {
        let mut out = Vec::new();
        for (k, w) in self.weights(xi).iter().enumerate() {
            for i in 0..3 {
                let e = Vector::<3>::from_fn(|c, _| f64::from(u8::from(c == i)));
                out.push(Function {
                    unknown: (3 * k + i) as u32,
                    value: e * w[0],
                    slopes: [e * w[1], e * w[2]],
                    second: [e * w[3], e * w[4], e * w[5]],
                });
            }
        }
        out
    }
}

impl Body for Sheet {
    fn name(&self) -> &str {
        &self.name
    }

    fn unknowns(&self) -> usize {
        3 * self.count()
    }

    fn start(&self) -> BodyState {
        BodyState { configuration: vec![0.0; self.unknowns()], internal: Vec::new() }
    }

    fn advance(&self, state: &BodyState, step: &[f64], share: f64) -> BodyState {
        let configuration = state.configuration.iter().zip(step).map(|(u, s)| u + share * s).collect();
        BodyState { configuration, internal: Vec::new() }
    }

    fn internal(&self, state: &BodyState, order: Order, out: &mut Contribution) -> Result<f64, BodyError> {
        for (k, u) in state.configuration.iter().enumerate() {
            out.forces[k] += self.foundation * u;
            if order == Order::Second {
                out.add_block(&[k as u32], &[self.foundation]);
            }
        }
        Ok(0.5 * self.foundation * state.configuration.iter().map(|u| u * u).sum::<f64>())
    }

    fn hold(&self, _: Option<&str>, _: &Hold<'_>, _: &BodyState) -> Result<Vec<Constraint>, PlaceError> {
        Ok(Vec::new())
    }

    fn load(
        &self,
        _: Option<&str>,
        _: &Load<'_>,
        _: &BodyState,
        _: Order,
        _: &mut Contribution,
    ) -> Result<(), PlaceError> {
        Ok(())
    }

    fn sites(&self, _: Option<&str>, _: Sampling) -> Result<Vec<Site>, PlaceError> {
        let list = [[0.3, 0.4], [0.6, 0.55], [0.45, 0.2]];
        Ok(list.iter().map(|xi| Site { patch: 0, xi: *xi, weight: 0.7 }).collect())
    }

    fn placed(&self, state: &BodyState, site: &Site) -> SlavePoint {
        let jet = self.jet(state, site.xi);
        let normal = jet.u.cross(&jet.v);
        SlavePoint {
            x: jet.x,
            outward: (self.coordinates == 2).then_some(normal),
            tangent: Some(jet.u),
            radius: self.radius,
            functions: self.functions(site.xi),
            frame: Matrix::<3>::identity(),
            ..SlavePoint::default()
        }
    }

    fn master<'a>(&'a self, _: Option<&str>, state: &'a BodyState) -> Result<Box<dyn Master + 'a>, PlaceError> {
        Ok(Box::new(SheetMaster { sheet: self, state }))
    }

    fn site_stiffness(&self, _: &Site) -> f64 {
        self.foundation
    }

    fn rigid_modes(&self, _: &BodyState) -> [Vec<f64>; 6] {
        std::array::from_fn(|_| vec![0.0; self.unknowns()])
    }

    fn size(&self) -> f64 {
        1.0
    }

    fn fields(&self, _: &BodyState) -> BodyFields {
        BodyFields::default()
    }
}

impl Kinematics for Sheet {}

impl signorini_mechanics::Thermal for Sheet {}

impl Inertial for Sheet {}

impl Elimination for Sheet {}

impl ContactSides for Sheet {}

impl Slack for Sheet {}

impl BoxOfMaterial for Sheet {}

impl Constitution for Sheet {}

struct SheetMaster<'a> {
    sheet: &'a Sheet,
    state: &'a BodyState,
}

impl Master for SheetMaster<'_> {
    fn nearest(&self, x: &Point<3>, reach: f64, _: Option<&Site>) -> Option<MasterProjection> {
        let mut xi = [0.5; 2];
        let mut jet = self.sheet.jet(self.state, xi);
        for _ in 0..50 {
            let d = x - jet.x;
            if self.sheet.coordinates == 1 {
                xi[0] += d.dot(&jet.u) / (jet.u.dot(&jet.u) - d.dot(&jet.uu));
            } else {
                let a = nalgebra::Matrix2::new(
                    jet.u.dot(&jet.u) - d.dot(&jet.uu),
                    jet.u.dot(&jet.v) - d.dot(&jet.uv),
                    jet.u.dot(&jet.v) - d.dot(&jet.uv),
                    jet.v.dot(&jet.v) - d.dot(&jet.vv),
                );
                let step = a.try_inverse()? * nalgebra::Vector2::new(d.dot(&jet.u), d.dot(&jet.v));
                xi = [xi[0] + step[0], xi[1] + step[1]];
            }
            jet = self.sheet.jet(self.state, xi);
        }
        let surface = self.sheet.coordinates == 2;
        ((x - jet.x).norm() <= reach).then(|| {
            MasterProjection::Foot(Box::new(Foot {
                point: MaterialPoint { patch: 0, xi: [xi[0], xi[1], 0.0] },
                outward: surface.then(|| jet.u.cross(&jet.v).normalize()),
                jet,
                coordinates: self.sheet.coordinates,
                radius: self.sheet.radius,
                functions: self.sheet.functions(xi),
                spin: Vec::new(),
                spin_bends: Vec::new(),
                frame: Matrix::<3>::identity(),
            }))
        })
    }

    fn at(&self, point: &MaterialPoint) -> Anchor {
        let xi = [point.xi[0], point.xi[1]];
        let jet = self.sheet.jet(self.state, xi);
        Anchor {
            x: jet.x,
            tangent: jet.u,
            across: None,
            functions: self.sheet.functions(xi),
            spin: Vec::new(),
            frame: Matrix::<3>::identity(),
            turning: None,
        }
    }
}
