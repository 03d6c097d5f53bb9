//! What the points of a face add to residual and tangent: in the unknowns of bodies, and for each node.

use super::Mortar;
use super::face_terms::{FaceTerms, Traction};
use super::measured::NodeMeasure;
use crate::interaction::{Assembler, InteractionUnknowns};
use signorini_contact::Status;
use signorini_contact::law::Projected;
use signorini_geometry::{Matrix, Vector};
use signorini_solve::general::Entries;

/// What the nodes of a contact carry.
pub(super) struct NodeTractions<'a> {
    pub contact: &'a Mortar,
    /// The traction of each node.
    pub tractions: Vec<[f64; 3]>,
    /// Whether a node carries something, or may.
    pub acts: Vec<bool>,
}

impl NodeTractions<'_> {
    pub fn has_part_in(&self, shares: &[(u32, f64)]) -> bool {
        shares.iter().any(|(node, _)| self.acts[*node as usize])
    }

    /// The traction at a point with a normal, times its area.
    pub fn traction_at(&self, shares: &[(u32, f64)], normal: &Vector<3>) -> Traction {
        let mut out = Traction { pressure: 0.0, friction: Vector::<3>::zeros(), turning: Matrix::<3>::zeros() };
        for (node, share) in shares {
            let lambda = self.tractions[*node as usize];
            out.pressure += share * lambda[0];
            if self.contact.law.friction.is_none() || lambda[1..] == [0.0; 2] {
                continue;
            }
            let Some(axes) = self.contact.axes(*node, normal) else { continue };
            for i in 0..2 {
                out.friction += axes.e[i] * (share * lambda[1 + i]);
                out.turning += axes.by_normal[i] * (share * lambda[1 + i]);
            }
        }
        out
    }
}

/// A contact with the state of its nodes.
#[derive(Clone, Copy)]
pub(super) struct Assembly<'a> {
    pub contact: &'a Mortar,
    pub own: InteractionUnknowns<'a>,
    pub measures: &'a [NodeMeasure],
    pub projected: &'a [Projected],
}

impl<'a> Assembly<'a> {
    /// Number of a multiplier among all unknowns.
    fn row(&self, node: u32, component: usize) -> u32 {
        self.own.first + node * self.contact.law.slots().len() as u32 + component as u32
    }

    fn is_open(&self, node: u32) -> bool {
        self.projected[node as usize].status == Status::Open
    }

    /// The unknown traction of a node.
    fn traction(&self, node: u32) -> [f64; 3] {
        self.contact.law.multiplier(node as usize, self.own.multipliers)
    }

    fn acts(&self, node: u32) -> bool {
        !self.is_open(node) || self.traction(node) != [0.0; 3]
    }

    pub fn carried(&self) -> NodeTractions<'a> {
        let nodes = 0..self.projected.len() as u32;
        let tractions: Vec<[f64; 3]> = nodes.clone().map(|node| self.traction(node)).collect();
        let acts = nodes.map(|node| self.acts(node)).collect();
        NodeTractions { contact: self.contact, tractions, acts }
    }

    /// The equations of the nodes, without what other unknowns change in them.
    pub fn add_nodes(&self, out: &mut Assembler<'_>) {
        for (node, projected) in (0u32..).zip(self.projected) {
            let row = self.row(node, 0);
            self.contact.law.add_equations(node as usize, row, self.traction(node), Some(projected), out);
        }
    }

    /// Adds what a face adds.
    pub fn add(&self, terms: &FaceTerms, out: &mut Assembler<'_>) {
        terms.forces.iter().for_each(|(unknown, force)| out.residual[*unknown as usize] += force);
        terms.sizes.iter().for_each(|(unknown, size)| out.sizes[*unknown as usize] += size);
        if let Some(tangent) = &mut out.tangent {
            let (unknowns, values) = &terms.stiffness;
            if !unknowns.is_empty() {
                tangent.add_block(unknowns, values);
            }
            self.add_lines(terms, tangent);
        }
    }

    /// Adds what follows from rows and columns that do not change.
    pub fn add_linear(&self, terms: &FaceTerms, carried: &NodeTractions<'_>, out: &mut Assembler<'_>) {
        for line in &terms.pushes {
            let traction = carried.tractions[line.node as usize][line.slot];
            for (unknown, value) in line.entries.iter().filter(|_| traction != 0.0) {
                out.residual[*unknown as usize] += traction * value;
                out.sizes[*unknown as usize] += (traction * value).abs();
            }
        }
        if let Some(tangent) = &mut out.tangent {
            self.add_lines(terms, tangent);
        }
    }

    fn add_lines(&self, terms: &FaceTerms, tangent: &mut Entries) {
        let component = |slot: usize| self.contact.law.slots().iter().position(|s| *s == slot);
        for line in terms.pushes.iter().filter(|line| self.acts(line.node)) {
            let Some(i) = component(line.slot) else { continue };
            let column = self.row(line.node, i);
            line.entries.iter().for_each(|(unknown, value)| tangent.add(*unknown, column, *value));
        }
        // ζ_n = λ - c g and ζ_t = λ + c s: the scale of the equation has 1/c.
        let gaps = terms.gaps.iter().map(|line| (line, -1.0 / self.measures[line.node as usize].weight));
        let slips = terms.slips.iter().map(|line| (line, 1.0 / self.measures[line.node as usize].matched));
        for (line, mean) in gaps.chain(slips).filter(|(line, _)| !self.is_open(line.node)) {
            let k = line.node as usize;
            for (i, &slot) in self.contact.law.slots().iter().enumerate() {
                let factor = self.contact.law.areas[k] * mean * self.projected[k].derivative[slot][line.slot];
                if factor != 0.0 {
                    let row = self.row(line.node, i);
                    line.entries.iter().for_each(|(unknown, value)| tangent.add(row, *unknown, factor * value));
                }
            }
        }
    }
}
