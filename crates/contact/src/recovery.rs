//! The pressure as it is shown: from the forces of the contact on the slave side, whatever method found them.
//!
//! On faces of degree 2 it is the projection `∫ p N_l = F_l` on the Lagrange functions of the active nodes, `F_l` the work
//! of the contact forces on `N_l`. This takes the ripple between vertices and mid-side nodes away, and needs no function
//! to have an integral of its own: those of the vertices of quadratic triangles have none. For other degrees the
//! multipliers at the nodes are as good, and on splines, whose functions have no nodes, they are means over a few faces.
//!
//! On the axis of a body of revolution the functions of degree 2 and more have no integral with the weight of the radius
//! either; there the pressure is the one whose slope along the radius vanishes.

use crate::multiplier::{MergedNode, PressureNodes};
use crate::surface::ContactSurface;
use signorini_basis::Local;
use signorini_basis::hierarchic::Values;
use signorini_basis::rules::rule;
use signorini_solve::SymmetricMatrix;
use signorini_solve::cholesky::Symbolic;

/// A point of the slave side, the area it stands for and the force it carries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pressed {
    pub face: usize,
    pub s: Local,
    pub area: f64,
    pub force: f64,
}

/// The points of a rule on all faces, without force.
pub fn unpressed<const D: usize>(slave: &dyn ContactSurface<D>, nodes: &PressureNodes<D>) -> Vec<Pressed> {
    let of_face = |face: usize| {
        rule(nodes.map(face).shape(), nodes.map(face).order() + 2).into_iter().map(move |(s, w)| {
            let at = slave.at(face, &s);
            Pressed { face, s, area: w * at.area_normal().norm() * slave.measure(&at.x), force: 0.0 }
        })
    };
    (0..nodes.face_count()).flat_map(of_face).collect()
}

/// A node on the axis, and its pressure as a combination of those of the other nodes of its face.
struct Even {
    node: u32,
    others: Vec<(u32, f64)>,
}

/// The nodes on the axis, on faces of degree 2 and more: `Σ p_k N_k' = 0` there.
fn even<const D: usize>(slave: &dyn ContactSurface<D>, nodes: &PressureNodes<D>) -> Vec<Even> {
    let mut out = Vec::new();
    let mut at = Values::default();
    for face in
        (0..nodes.face_count()).filter(|&f| D == 2 && nodes.map(f).order() > 1 && nodes.map(f).rational().is_none())
    {
        let list = nodes.of_face(face);
        let radii: Vec<f64> = list.iter().map(|(k, _)| slave.measure(&nodes.positions[*k as usize])).collect();
        let most = radii.iter().fold(0.0f64, |m, r| m.max(*r));
        for (place, s) in nodes.map(face).nodes().iter().enumerate() {
            if radii[place].abs() > 1e-9 * most {
                continue;
            }
            nodes.map(face).tabulate(s, &mut at);
            let own = at.gradient[place][0];
            let others = (list.iter().zip(&at.gradient).enumerate())
                .filter(|(k, _)| *k != place)
                .map(|(_, ((node, _), slope))| (*node, -slope[0] / own));
            out.push(Even { node: list[place].0, others: others.collect() });
        }
    }
    out
}

/// The recovered pressure of every node of a surface, from the forces at points, and the multipliers and states by node;
/// `given` are the nodes that share the function of another.
pub fn recovered<const D: usize>(
    slave: &dyn ContactSurface<D>,
    nodes: &PressureNodes<D>,
    points: &[Pressed],
    multiplier: &[f64],
    active: &[bool],
    given: &[MergedNode],
) -> Vec<f64> {
    let mut out = multiplier.to_vec();
    let mut known = vec![false; nodes.len()];
    given.iter().filter(|g| !g.weightless).for_each(|g| known[g.from as usize] = active[g.from as usize]);
    // Where the zone ends within the first face the slope says nothing.
    let mut even = even(slave, nodes);
    even.retain(|e| e.others.iter().all(|(k, _)| active[*k as usize] && !known[*k as usize]));
    project(nodes, points, active, &known, &even, &mut out);
    for e in &even {
        out[e.node as usize] = e.others.iter().map(|(k, c)| c * out[*k as usize]).sum();
    }
    // A projection may fall below zero where the zone ends.
    out.iter_mut().for_each(|p| *p = p.max(0.0));
    out
}

/// Projects on faces of degree 2. What is `known` stays: functions that are hardly covered, or held by a support, say
/// nothing of their own.
fn project<const D: usize>(
    nodes: &PressureNodes<D>,
    points: &[Pressed],
    active: &[bool],
    known: &[bool],
    even: &[Even],
    out: &mut [f64],
) {
    let quadratic = |face: usize| nodes.map(face).order() == 2 && nodes.map(face).rational().is_none();
    // Every node is a combination of unknowns: one of its own, or those of other nodes.
    let mut combination: Vec<Vec<(u32, f64)>> = vec![Vec::new(); nodes.len()];
    let mut dependent = known.to_vec();
    even.iter().for_each(|e| dependent[e.node as usize] = true);
    let mut list = Vec::new();
    for (node, _) in (0..nodes.face_count()).filter(|&f| quadratic(f)).flat_map(|f| nodes.of_face(f)) {
        let k = *node as usize;
        if active[k] && !dependent[k] && combination[k].is_empty() {
            combination[k].push((list.len() as u32, 1.0));
            list.push(k);
        }
    }
    if list.is_empty() {
        return;
    }
    for e in even {
        let of = |(k, c): &(u32, f64)| combination[*k as usize].iter().map(|(i, v)| (*i, c * v)).collect::<Vec<_>>();
        combination[e.node as usize] = e.others.iter().flat_map(of).collect();
    }
    let mut rhs = vec![0.0; list.len()];
    let (mut cliques, mut matrices): (Vec<Vec<u32>>, Vec<Vec<f64>>) = Default::default();
    let mut place_of = vec![usize::MAX; nodes.face_count()];
    let mut at = Values::default();
    for p in points.iter().filter(|p| quadratic(p.face)) {
        if place_of[p.face] == usize::MAX {
            let own = nodes.of_face(p.face).iter().flat_map(|(k, _)| combination[*k as usize].iter().map(|c| c.0));
            let mut clique: Vec<u32> = own.collect();
            clique.sort_unstable();
            clique.dedup();
            place_of[p.face] = cliques.len();
            matrices.push(vec![0.0; clique.len() * clique.len()]);
            cliques.push(clique);
        }
        let (clique, matrix) = (&cliques[place_of[p.face]], &mut matrices[place_of[p.face]]);
        nodes.map(p.face).tabulate(&p.s, &mut at);
        let mut value = vec![0.0; clique.len()];
        let mut force = p.force;
        for ((node, _), v) in nodes.of_face(p.face).iter().zip(&at.value) {
            if known[*node as usize] {
                force -= p.area * v * out[*node as usize];
            }
            for (unknown, c) in &combination[*node as usize] {
                if let Ok(k) = clique.binary_search(unknown) {
                    value[k] += c * v;
                }
            }
        }
        for (a, va) in value.iter().enumerate() {
            rhs[clique[a] as usize] += force * va;
            for (b, vb) in value.iter().enumerate() {
                matrix[a * clique.len() + b] += p.area * va * vb;
            }
        }
    }
    let mut mass = SymmetricMatrix::from_cliques(list.len(), &cliques);
    for (clique, matrix) in cliques.iter().zip(&matrices) {
        mass.add(clique, matrix, 1.0);
    }
    // Functions that vanish on what is covered may leave the matrix singular; then the multipliers stand.
    if let Ok(found) = Symbolic::default().factor(mass).and_then(|factor| factor.solve(&rhs)) {
        for (k, combined) in combination.iter().enumerate().filter(|(_, c)| !c.is_empty()) {
            out[k] = combined.iter().map(|(unknown, c)| c * found[*unknown as usize]).sum();
        }
    }
}
