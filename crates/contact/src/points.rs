//! Slave points under test, and the rows of pressures and gaps that they make.
//!
//! A row is a pressure unknown with its gap: that of a node or a quadrature point, or the mean gap of a dual function over
//! many points. Rows are linear combinations of the gaps of points, so one assembler serves all of them: with the
//! pressures `λ` of the rows, the force on a point is `p = Σ λ share`.

use crate::kinematics::Kinematics;
use crate::mortar::{Shares, WeightedGap, compress};
use crate::multiplier::Given;
use crate::multiplier::PressureNodes;
use crate::obstacle::Obstacle;
use crate::recovery::unpressed;
use crate::segments::GapPoint;
use crate::surface::{ContactSurface, looks_at};
use rayon::prelude::*;
use signorini_basis::Local;
use signorini_basis::rules::rule;
use signorini_geometry::Point;

/// A point of the slave side, and how much its gap counts in which rows.
#[derive(Clone, Debug, PartialEq)]
pub struct TestPoint {
    pub face: usize,
    pub s: Local,
    /// Rows, with weights (area included).
    pub shares: Vec<(u32, f64)>,
}

/// A row of a pressure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TestRow {
    /// Number of the pressure node, or of the quadrature point.
    pub number: u32,
    /// Area.
    pub weight: f64,
    /// Face and coordinates of a row that is one point.
    pub place: Option<(usize, Local)>,
}

/// The points and the rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tests {
    pub points: Vec<TestPoint>,
    pub rows: Vec<TestRow>,
}

impl Tests {
    /// One row for each pressure node, at the node, with the area of its Lagrange function; none for the nodes given.
    pub fn at_nodes<const D: usize>(slave: &dyn ContactSurface<D>, nodes: &PressureNodes<D>, given: &[Given]) -> Self {
        let mut weight = vec![0.0; nodes.len()];
        let mut place: Vec<Option<(usize, Local)>> = vec![None; nodes.len()];
        let mut at = signorini_basis::hierarchic::Values::default();
        for p in unpressed(slave, nodes) {
            nodes.map(p.face).tabulate(&p.s, &mut at);
            for ((node, _), v) in nodes.of_face(p.face).iter().zip(&at.value) {
                weight[*node as usize] += p.area * v;
            }
        }
        for face in 0..nodes.face_count() {
            for ((node, _), s) in nodes.of_face(face).iter().zip(nodes.map(face).nodes()) {
                place[*node as usize].get_or_insert((face, s));
            }
        }
        given.iter().for_each(|g| weight[g.from as usize] = 0.0);
        let mut out = Tests::default();
        for (node, place) in place.into_iter().enumerate() {
            if let Some((face, s)) = place {
                out.add(node as u32, face, s, weight[node]);
            }
        }
        out
    }

    /// One row for each quadrature point.
    pub fn at_quadrature_points<const D: usize>(slave: &dyn ContactSurface<D>) -> Self {
        let mut out = Tests::default();
        for face in 0..slave.face_count() {
            for (s, w) in rule(slave.shape(face), slave.degree(face) + 2) {
                let point = slave.at(face, &s);
                let weight = w * point.area_normal().norm() * slave.measure(&point.x);
                out.add(out.rows.len() as u32, face, s, weight);
            }
        }
        out
    }

    /// One row for each dual function, over the points of the segments.
    pub fn in_the_mean<const D: usize>(points: &[Vec<GapPoint<D>>], shares: &Shares) -> Self {
        let mut out = Tests::default();
        let mut row = vec![None; shares.weight.len()];
        for (node, &weight) in shares.weight.iter().enumerate() {
            if weight > 0.0 {
                row[node] = Some(out.rows.len() as u32);
                out.rows.push(TestRow { number: node as u32, weight, place: None });
            }
        }
        for (face, list) in points.iter().enumerate() {
            for (p, of_point) in list.iter().zip(&shares.of_point[face]) {
                let shares = of_point.iter().filter_map(|(node, v)| Some((row[*node as usize]?, *v))).collect();
                out.points.push(TestPoint { face, s: p.s, shares });
            }
        }
        out
    }

    fn add(&mut self, number: u32, face: usize, s: Local, weight: f64) {
        if weight > 0.0 {
            self.points.push(TestPoint { face, s, shares: vec![(self.rows.len() as u32, weight)] });
            self.rows.push(TestRow { number, weight, place: Some((face, s)) });
        }
    }

    /// Measures the gaps of all points no farther from the obstacle than `reach`; points that look away from it cannot
    /// touch it.
    pub fn measure<const D: usize>(
        &self,
        slave: &dyn ContactSurface<D>,
        obstacle: &dyn Obstacle<D>,
        reach: f64,
    ) -> Measured {
        let kinematics = (self.points.par_iter())
            .map(|point| {
                let functions = slave.functions(point.face, &point.s);
                let at = slave.at(point.face, &point.s);
                let found = obstacle.meet(&at.x, &functions)?;
                let looks = looks_at(&at.area_normal(), &Point::<D>::from_fn(|k, _| found.normal[k]));
                (found.gap.abs() <= reach && looks).then_some(found)
            })
            .collect();
        Measured { kinematics }
    }
}

/// The gaps of test points at one configuration.
#[derive(Clone, Debug)]
pub struct Measured {
    kinematics: Vec<Option<Kinematics>>,
}

impl Measured {
    /// Whether a point of the tests met something.
    pub fn meets(&self, point: usize) -> bool {
        self.kinematics[point].is_some()
    }

    /// The pair of a point of the tests, if it met something.
    pub fn pair(&self, point: usize) -> Option<&Kinematics> {
        self.kinematics[point].as_ref()
    }

    /// The rows: weighted gaps and their derivatives; those that meet something, with their place in the list of the
    /// tests.
    pub fn rows(&self, tests: &Tests) -> Vec<(usize, WeightedGap)> {
        let mut rows: Vec<WeightedGap> = (tests.rows.iter())
            .map(|row| WeightedGap { gap: 0.0, weight: 0.0, terms: Vec::new(), forces: Vec::new(), node: row.number })
            .collect();
        for (point, found) in tests.points.iter().zip(&self.kinematics) {
            let Some(found) = found else { continue };
            for (number, share) in &point.shares {
                let row = &mut rows[*number as usize];
                row.gap += share * found.gap;
                row.weight += share;
                let terms = found.unknowns.iter().zip(&found.gradient).filter(|(_, d)| **d != 0.0);
                row.terms.extend(terms.map(|(unknown, d)| (*unknown, share * d)));
            }
        }
        rows.iter_mut().for_each(|row| compress(&mut row.terms));
        rows.into_iter().enumerate().filter(|(_, row)| row.weight > 0.0 && !row.terms.is_empty()).collect()
    }
}
