//! The curve of a body: elements in a row, their numbers, and what moves a point of it.
//!
//! Smooth centrelines are cubic Hermite curves with position `r` and derivative `t` at each node; chains are straight from
//! node to node. Parameters of an element run from 0 to 1.

use crate::hermite;
use signorini_geometry::shape::CurveJet;
use signorini_geometry::{Point, Vector};
use signorini_mechanics::body::Function;
pub use signorini_mechanics::curve::{Closure, Continuity};

/// How the numbers of a body make a curve.
#[derive(Clone, Debug)]
pub struct Centreline {
    /// Length of each element in the reference configuration.
    pub lengths: Vec<f64>,
    pub closure: Closure,
    pub continuity: Continuity,
    /// Unknowns of a node: positions first, then derivatives.
    pub unknowns_per_node: usize,
    /// Numbers of a node in a configuration, in the same order.
    pub numbers_per_node: usize,
    /// Length of the curve up to each element.
    starts: Vec<f64>,
}

impl Centreline {
    /// A curve of elements of given lengths.
    pub fn new(lengths: Vec<f64>, closure: Closure, continuity: Continuity, numbers: [usize; 2]) -> Self {
        let mut starts = vec![0.0];
        lengths.iter().for_each(|h| starts.push(starts[starts.len() - 1] + h));
        let [unknowns_per_node, numbers_per_node] = numbers;
        Centreline { lengths, closure, continuity, unknowns_per_node, numbers_per_node, starts }
    }

    pub fn elements(&self) -> usize {
        self.lengths.len()
    }

    pub fn nodes(&self) -> usize {
        match self.closure {
            Closure::Open => self.elements() + 1,
            Closure::Closed => self.elements(),
        }
    }

    /// First and last node of an element.
    pub fn ends(&self, element: usize) -> [usize; 2] {
        [element, (element + 1) % self.nodes()]
    }

    /// Length along the curve, of the reference, at a parameter of an element.
    pub fn arc(&self, element: usize, xi: f64) -> f64 {
        self.starts[element] + xi * self.lengths[element]
    }

    /// Length of the curve.
    pub fn length(&self) -> f64 {
        self.starts[self.elements()]
    }

    fn vector(&self, configuration: &[f64], node: usize, at: usize) -> Vector<3> {
        let first = node * self.numbers_per_node + at;
        Vector::<3>::from_column_slice(&configuration[first..first + 3])
    }

    /// Position of a node.
    pub fn position(&self, configuration: &[f64], node: usize) -> Point<3> {
        self.vector(configuration, node, 0)
    }

    /// Derivative of the position at a node of a smooth curve.
    pub fn derivative(&self, configuration: &[f64], node: usize) -> Vector<3> {
        self.vector(configuration, node, 3)
    }

    /// `r_1 t_1 r_2 t_2` of an element of a smooth curve.
    pub fn nodal(&self, configuration: &[f64], element: usize) -> [Vector<3>; 4] {
        let [a, b] = self.ends(element);
        [
            self.position(configuration, a),
            self.derivative(configuration, a),
            self.position(configuration, b),
            self.derivative(configuration, b),
        ]
    }

    /// The first unknown of each vector of an element, with the shape function of that vector and its derivatives in the
    /// parameter.
    fn shapes(&self, element: usize, xi: f64) -> Vec<(usize, [f64; 3])> {
        let nodes = self.ends(element).map(|n| n * self.unknowns_per_node);
        match self.continuity {
            Continuity::C0 => vec![(nodes[0], [1.0 - xi, -1.0, 0.0]), (nodes[1], [xi, 1.0, 0.0])],
            Continuity::C1 => {
                let h = self.lengths[element];
                let (n, n1, n2) = (hermite::cubic(xi, h), hermite::cubic_first(xi, h), hermite::cubic_second(xi, h));
                let at = [nodes[0], nodes[0] + 3, nodes[1], nodes[1] + 3];
                (0..4).map(|k| (at[k], [n[k], n1[k], n2[k]])).collect()
            }
        }
    }

    /// What moves a point of the curve.
    pub fn functions(&self, element: usize, xi: f64) -> Vec<Function> {
        let zero = Vector::<3>::zeros();
        (self.shapes(element, xi).into_iter())
            .flat_map(|(first, [n, n1, n2])| {
                (0..3).map(move |i| {
                    let e = crate::quaternion::axis(i);
                    Function {
                        unknown: (first + i) as u32,
                        value: e * n,
                        slopes: [e * n1, zero],
                        second: [e * n2, zero, zero],
                    }
                })
            })
            .collect()
    }

    /// Position and derivatives in the parameter of an element.
    pub fn jet(&self, configuration: &[f64], element: usize, xi: f64) -> CurveJet {
        match self.continuity {
            Continuity::C0 => {
                let [a, b] = self.ends(element).map(|n| self.position(configuration, n));
                let zero = Vector::<3>::zeros();
                CurveJet { x: a + (b - a) * xi, d1: b - a, d2: zero, d3: zero }
            }
            Continuity::C1 => {
                let (x, h) = (self.nodal(configuration, element), self.lengths[element]);
                CurveJet {
                    x: hermite::sum(&hermite::cubic(xi, h), &x),
                    d1: hermite::sum(&hermite::cubic_first(xi, h), &x),
                    d2: hermite::sum(&hermite::cubic_second(xi, h), &x),
                    d3: hermite::sum(&hermite::cubic_third(h), &x),
                }
            }
        }
    }

    /// Points whose hull holds an element.
    pub fn hull(&self, configuration: &[f64], element: usize) -> Vec<Point<3>> {
        match self.continuity {
            Continuity::C0 => self.ends(element).map(|n| self.position(configuration, n)).to_vec(),
            Continuity::C1 => hermite::bezier(&self.nodal(configuration, element), self.lengths[element]).to_vec(),
        }
    }

    /// The nodes at the ends: none if it is closed.
    pub fn end_nodes(&self) -> Option<[usize; 2]> {
        match self.closure {
            Closure::Open => Some([0, self.nodes() - 1]),
            Closure::Closed => None,
        }
    }
}
