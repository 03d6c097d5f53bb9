//! The mass of ropes and beams.

use crate::centreline::Centreline;
use crate::hermite::{FOUR, cubic};
use signorini_mechanics::Mass;

/// Mass and inertia against rotation of a section, per unstrained length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SectionMass {
    pub mass: f64,
    /// About the axis of the beam and the two axes across: `ρ J`, `ρ I_2`, `ρ I_3`.
    pub inertia: [f64; 3],
}

/// Half of each straight element at either of its nodes.
pub fn lumped(line: &Centreline, mass_per_length: f64) -> Mass {
    let mut at_node = vec![0.0; line.nodes()];
    for element in 0..line.elements() {
        line.ends(element).iter().for_each(|n| at_node[*n] += 0.5 * mass_per_length * line.lengths[element]);
    }
    let of = |(node, mass): (usize, f64)| (0..3).map(move |i| (vec![(3 * node + i) as u32], vec![mass]));
    Mass { blocks: at_node.into_iter().enumerate().flat_map(of).collect(), spins: Vec::new() }
}

/// `∫ μ H_a H_b` of the cubic functions of each element; nodes have so many unknowns, of which the first six are position and
/// derivative.
pub fn consistent(line: &Centreline, mass_per_length: f64, unknowns_of_node: usize) -> Mass {
    let of = |element: usize| {
        let h = line.lengths[element];
        let mut own = [[0.0; 4]; 4];
        for (xi, weight) in FOUR {
            let value = cubic(xi, h);
            for a in 0..4 {
                (0..4).for_each(|b| own[a][b] += mass_per_length * h * weight * value[a] * value[b]);
            }
        }
        let [first, last] = line.ends(element).map(|n| unknowns_of_node * n);
        // In the order r_1, t_1, r_2, t_2.
        let unknowns = (0..12).map(|k| (if k < 6 { first + k } else { last + k - 6 }) as u32).collect();
        let entry = |k: usize| if k / 12 % 3 == k % 12 % 3 { own[k / 12 / 3][k % 12 / 3] } else { 0.0 };
        (unknowns, (0..144).map(entry).collect())
    };
    Mass { blocks: (0..line.elements()).map(of).collect(), spins: Vec::new() }
}
