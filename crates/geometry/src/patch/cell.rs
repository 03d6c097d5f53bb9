//! Cells: boxes of parameters with all that bounding needs.

use super::bounds::{Derivatives, Hull};
use super::{Chart, Piece};
use crate::{Point, Vector};

/// The piece number of cells that gather several pieces.
pub const GROUP: u32 = u32::MAX;

/// A box of parameters of one piece, or a group of pieces, of which only the box in space is known.
///
/// With `t` in `[-1, 1]^M` the local coordinate of the cell, `x(t) = x + Σ j t + ½ Σ dd t t + R`, `|R| ≤ rho3`, and
/// `|x(t) - x - Σ j t| ≤ rho2`.
#[derive(Clone, Debug)]
#[repr(C)]
pub struct Cell<const M: usize> {
    /// A box that holds the cell, low and high corner; in the tree it is gathered from the leaves. It comes first, with
    /// what else is read of every cell that is looked at.
    pub hull: Hull,
    pub piece: u32,
    /// Numbers of the two halves ([`super::Atlas::node`]); zero where the cell has not been split.
    pub children: [u32; 2],
    pub middle: [f64; M],
    pub half: [f64; M],
    pub x: Point<3>,
    pub j: [Vector<3>; M],
    pub dd: [[Vector<3>; M]; M],
    /// Lengths of `j` and `dd`.
    pub j_norm: [f64; M],
    pub dd_norm: [[f64; M]; M],
    /// `j_a · dd_bc`.
    pub j_dd: [[[f64; M]; M]; M],
    /// How far `j` moves over the cell.
    pub sigma: [f64; M],
    /// How far `j` moves beyond its linear expansion.
    pub eta: [f64; M],
    /// How far `dd` moves over the cell.
    pub tau: [[f64; M]; M],
    pub rho2: f64,
    pub rho3: f64,
    /// Unit normal at the middle of a surface cell, else zero.
    pub normal: Vector<3>,
}

impl<const M: usize> Cell<M> {
    pub(super) fn new<C: Chart<M>>(number: u32, piece: &Piece<M, C>, middle: [f64; M], half: [f64; M]) -> Self {
        let jet = piece.chart.jet(&middle);
        let (hull, Derivatives { second, third }) = &piece.chart.bounds(&middle, &half);
        let mut cell = Cell {
            piece: number,
            children: [0; 2],
            middle,
            half,
            x: jet.x,
            j: jet.d,
            dd: jet.dd,
            j_norm: [0.0; M],
            dd_norm: [[0.0; M]; M],
            j_dd: [[[0.0; M]; M]; M],
            sigma: [0.0; M],
            eta: [0.0; M],
            tau: [[0.0; M]; M],
            rho2: 0.0,
            rho3: 0.0,
            normal: Vector::<3>::zeros(),
            hull: [jet.x; 2],
        };
        if M == 2 {
            cell.normal = jet.d[0].cross(&jet.d[1]).try_normalize(0.0).unwrap_or_default();
        }
        for a in 0..M {
            cell.j[a] *= half[a];
            cell.j_norm[a] = cell.j[a].norm();
            for b in 0..M {
                let area = half[a] * half[b];
                cell.dd[a][b] *= area;
                cell.dd_norm[a][b] = if b < a { cell.dd_norm[b][a] } else { cell.dd[a][b].norm() };
                let mut tau = 0.0;
                for c in 0..M {
                    tau += third[a][b][c] * half[c];
                }
                let tau = tau * area;
                cell.tau[a][b] = tau;
                cell.eta[a] += 0.5 * tau;
                cell.sigma[a] += (second[a][b] * area).min(cell.dd_norm[a][b] + tau);
                cell.rho3 += tau / 6.0;
            }
            cell.rho2 += 0.5 * cell.sigma[a];
        }
        let mut extent = Vector::<3>::repeat(cell.rho2);
        for j in &cell.j {
            extent += j.abs();
        }
        // Rounding must not turn the box inside out.
        let low = (cell.x - extent).sup(&hull[0]);
        cell.hull = [low, (cell.x + extent).inf(&hull[1]).sup(&low)];
        for a in 0..M {
            for b in 0..M {
                for c in 0..M {
                    cell.j_dd[a][b][c] = cell.j[a].dot(&cell.dd[b][c]);
                }
            }
        }
        cell
    }

    /// A group of which only a box is known.
    pub(super) fn group(hull: Hull) -> Self {
        let radius = 0.5 * (hull[1] - hull[0]).norm();
        Cell {
            piece: GROUP,
            children: [0; 2],
            middle: [0.0; M],
            half: [0.0; M],
            x: (hull[0] + hull[1]) * 0.5,
            j: [Vector::<3>::zeros(); M],
            dd: [[Vector::<3>::zeros(); M]; M],
            j_norm: [0.0; M],
            dd_norm: [[0.0; M]; M],
            j_dd: [[[0.0; M]; M]; M],
            sigma: [0.0; M],
            eta: [0.0; M],
            tau: [[0.0; M]; M],
            rho2: radius,
            rho3: radius,
            normal: Vector::<3>::zeros(),
            hull,
        }
    }

    pub fn is_group(&self) -> bool {
        self.piece == GROUP
    }

    /// No point of the cell is farther from `x` than this.
    pub fn radius(&self) -> f64 {
        self.j_norm.iter().sum::<f64>() + self.rho2
    }

    /// The direction in which halving helps most: long, or strongly curved.
    pub(super) fn axis(&self) -> usize {
        let weight = |a: usize| self.j_norm[a] + 2.0 * self.sigma[a];
        (1..M).fold(0, |best, a| if weight(a) > weight(best) { a } else { best })
    }

    /// The parameter box, low and high.
    pub fn range(&self, a: usize) -> [f64; 2] {
        // Faces of the piece are hit exactly.
        [(self.middle[a] - self.half[a]).max(-1.0), (self.middle[a] + self.half[a]).min(1.0)]
    }
}
