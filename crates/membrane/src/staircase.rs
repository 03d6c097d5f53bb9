//! The contact zone of the nodal method: a set of nodes, each with the cell of the dual grid round it.

use crate::active_set::NodalSolution;
use crate::problem::Membrane;
use crate::report::Component;
use signorini_geometry::Point;
use std::collections::BTreeMap;

/// Zones of nodes in contact.
pub struct Staircase<const D: usize> {
    pub components: Vec<Component<D>>,
    /// Edge of the zone, in one dimension the ends of each interval, in two the closed steps round it.
    pub outlines: Vec<Vec<Point<D>>>,
}

impl<const D: usize> Staircase<D> {
    pub fn new(membrane: &Membrane<D>, solution: &NodalSolution<D>) -> Self {
        let counts = membrane.grid.node_counts();
        let touches: Vec<bool> = solution.nodes.iter().map(|n| n.is_some_and(|n| n.contact.is_some())).collect();
        let (label, zones) = connected(&touches, &counts);
        let free: Vec<bool> = touches.iter().map(|t| !t).collect();
        let (hole_label, parts) = connected(&free, &counts);
        let mut components =
            vec![Component { obstacle: 0, area: 0.0, force: 0.0, centroid: Point::zeros(), holes: 0 }; zones];
        for (i, node) in solution.nodes.iter().enumerate() {
            if let (Some(node), Some(k)) = (node, label[i]) {
                let touched = node.contact.and_then(|side| membrane.obstacles.index_at(side, &membrane.grid.node(i)));
                components[k].obstacle = touched.unwrap_or(components[k].obstacle);
                components[k].area += node.share;
                components[k].force += node.reaction;
                components[k].centroid += node.share * membrane.grid.node(i);
            }
        }
        for c in &mut components {
            c.centroid /= c.area.max(f64::MIN_POSITIVE);
        }
        // A free part is a hole of the zone beside it, unless it reaches the edge of the membrane.
        let mut enclosed = vec![true; parts];
        let mut beside = vec![None; parts];
        for (i, part) in hole_label.iter().enumerate() {
            let Some(part) = *part else { continue };
            enclosed[part] &= solution.nodes[i].is_some_and(|n| n.inside) && !on_edge(i, &counts);
            for j in neighbours(i, &counts) {
                beside[part] = beside[part].or(label[j]);
            }
        }
        if D > 1 {
            for (_, zone) in enclosed.iter().zip(&beside).filter(|(e, _)| **e) {
                if let Some(k) = zone {
                    components[*k].holes += 1;
                }
            }
        }
        let outlines = if D == 1 { ends(membrane, &touches) } else { steps(membrane, &touches, &counts) };
        Self { components, outlines }
    }
}

fn on_edge<const D: usize>(i: usize, counts: &[usize; D]) -> bool {
    let mut rest = i;
    counts.iter().any(|&n| {
        let k = rest % n;
        rest /= n;
        k == 0 || k + 1 == n
    })
}

fn neighbours<const D: usize>(i: usize, counts: &[usize; D]) -> Vec<usize> {
    let mut found = Vec::new();
    let (mut rest, mut stride) = (i, 1);
    for &n in counts {
        let k = rest % n;
        rest /= n;
        if k > 0 {
            found.push(i - stride);
        }
        if k + 1 < n {
            found.push(i + stride);
        }
        stride *= n;
    }
    found
}

/// Labels the connected parts of a set of nodes.
fn connected<const D: usize>(set: &[bool], counts: &[usize; D]) -> (Vec<Option<usize>>, usize) {
    let mut label = vec![None; set.len()];
    let mut parts = 0;
    for start in 0..set.len() {
        if !set[start] || label[start].is_some() {
            continue;
        }
        label[start] = Some(parts);
        let mut open = vec![start];
        while let Some(i) = open.pop() {
            for j in neighbours(i, counts) {
                if set[j] && label[j].is_none() {
                    label[j] = Some(parts);
                    open.push(j);
                }
            }
        }
        parts += 1;
    }
    (label, parts)
}

fn ends<const D: usize>(membrane: &Membrane<D>, touches: &[bool]) -> Vec<Vec<Point<D>>> {
    let h = 0.5 * membrane.grid.cell_size();
    let mut found = Vec::new();
    let mut begin = None;
    for i in 0..touches.len() {
        let next = touches.get(i + 1).copied().unwrap_or(false);
        if touches[i] && begin.is_none() {
            begin = Some(membrane.grid.bounds().clamp(&(membrane.grid.node(i) - h)));
        }
        if touches[i] && !next {
            let end = membrane.grid.bounds().clamp(&(membrane.grid.node(i) + h));
            found.extend(begin.take().map(|b| vec![b, end]));
        }
    }
    found
}

/// The closed steps round the squares of the dual grid.
fn steps<const D: usize>(membrane: &Membrane<D>, touches: &[bool], counts: &[usize; D]) -> Vec<Vec<Point<D>>> {
    let (nx, ny) = (counts[0] as isize, counts[1] as isize);
    let set = |i: isize, j: isize| (0..nx).contains(&i) && (0..ny).contains(&j) && touches[(j * nx + i) as usize];
    // Directed sides with the zone on their left, from corner to corner of the dual grid.
    let mut next: BTreeMap<(isize, isize), Vec<(isize, isize)>> = BTreeMap::new();
    for j in 0..ny {
        for i in (0..nx).filter(|&i| set(i, j)) {
            let sides = [
                (!set(i, j - 1), (i, j), (i + 1, j)),
                (!set(i + 1, j), (i + 1, j), (i + 1, j + 1)),
                (!set(i, j + 1), (i + 1, j + 1), (i, j + 1)),
                (!set(i - 1, j), (i, j + 1), (i, j)),
            ];
            for (_, a, b) in sides.into_iter().filter(|s| s.0) {
                next.entry(a).or_default().push(b);
            }
        }
    }
    let size = membrane.grid.cell_size();
    let corner = |(i, j): (isize, isize)| {
        membrane.grid.bounds().min + Point::from_fn(|k, _| (if k == 0 { i as f64 } else { j as f64 } - 0.5) * size[k])
    };
    let mut loops = Vec::new();
    while let Some((&start, _)) = next.first_key_value() {
        let mut outline = Vec::new();
        let mut at = start;
        while let Some(list) = next.get_mut(&at) {
            let following = list.pop();
            if list.is_empty() {
                next.remove(&at);
            }
            outline.push(corner(at));
            match following {
                Some(b) => at = b,
                None => break,
            }
        }
        loops.push(outline);
    }
    loops
}
