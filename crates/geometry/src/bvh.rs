//! A bounding-volume hierarchy: deterministic, refitted in place, traversed alone or against another one.
//!
//! Splits are at the median of the longest side, into a left part whose size is a power of two: the layout follows from
//! the number of boxes alone, so that subtrees are built in parallel into their final places and the tree is the same
//! on any number of threads.

use crate::{Aabb, Point, Vector};

/// Boxes in a leaf.
const LEAF: usize = 4;
/// Subtrees from this size on are built in parallel.
const PARALLEL: usize = 4096;

#[derive(Clone, Copy, Debug)]
struct Node {
    boxes: [Aabb<3>; 2],
    children: [Child; 2],
}

/// A node (`count` is zero) or a leaf: a range of the order.
#[derive(Clone, Copy, Debug)]
struct Child {
    first: u32,
    count: u32,
}

/// A tree over numbered boxes.
#[derive(Clone, Debug)]
pub struct Bvh {
    nodes: Vec<Node>,
    order: Vec<u32>,
    root: Child,
    root_box: Aabb<3>,
}

/// The box of nothing.
fn empty() -> Aabb<3> {
    Aabb::new(Point::<3>::repeat(f64::INFINITY), Point::<3>::repeat(f64::NEG_INFINITY))
}

/// Squared distance from a point to a box.
#[inline]
fn squared_to(b: &Aabb<3>, p: &Point<3>) -> f64 {
    let d = (b.min - p).sup(&(p - b.max));
    let (x, y, z) = (d.x.max(0.0), d.y.max(0.0), d.z.max(0.0));
    x * x + y * y + z * z
}

/// Squared distance of two boxes.
#[inline]
fn squared_between(a: &Aabb<3>, b: &Aabb<3>) -> f64 {
    let d = (a.min - b.max).sup(&(b.min - a.max));
    let (x, y, z) = (d.x.max(0.0), d.y.max(0.0), d.z.max(0.0));
    x * x + y * y + z * z
}

/// Internal nodes of the tree over `n` boxes.
fn node_count(n: usize) -> usize {
    if n <= LEAF { 0 } else { n.div_ceil(LEAF) - 1 }
}

/// How many boxes go left: whole leaves, half of them rounded up to a power of two.
fn left_size(n: usize) -> usize {
    let leaves = n.div_ceil(LEAF);
    LEAF * (leaves / 2 + leaves % 2).next_power_of_two().min(leaves - 1)
}

fn child_of(n: usize, first_box: usize, first_node: usize) -> Child {
    if n <= LEAF {
        Child { first: first_box as u32, count: n as u32 }
    } else {
        Child { first: first_node as u32, count: 0 }
    }
}

impl Bvh {
    /// The tree over boxes, which are known by their position from then on.
    ///
    /// # Panics
    /// With more than 2³¹ boxes.
    pub fn new(boxes: &[Aabb<3>]) -> Self {
        assert!(boxes.len() < 1 << 31, "too many boxes");
        let n = boxes.len();
        let mut order: Vec<u32> = (0..n as u32).collect();
        let blank = Node { boxes: [empty(); 2], children: [Child { first: 0, count: 0 }; 2] };
        let mut nodes = vec![blank; node_count(n)];
        let centers: Vec<Point<3>> = boxes.iter().map(Aabb::center).collect();
        let root_box = build(boxes, &centers, &mut order, &mut nodes, 0, 0);
        Bvh { nodes, order, root: child_of(n, 0, 0), root_box }
    }

    /// Number of boxes.
    pub fn len(&self) -> usize {
        self.order.len()
    }

    /// Whether there is no box.
    pub fn is_empty(&self) -> bool {
        self.order.is_empty()
    }

    /// The box around everything.
    pub fn bounds(&self) -> &Aabb<3> {
        &self.root_box
    }

    /// Adapts the tree to boxes that have moved; their neighbourhoods should not have changed much.
    ///
    /// # Panics
    /// If the number of boxes has changed.
    pub fn refit(&mut self, boxes: &[Aabb<3>]) {
        assert_eq!(boxes.len(), self.order.len(), "a tree is refitted to as many boxes as it was built for");
        let of_leaf = |order: &[u32], c: Child| {
            order[c.first as usize..(c.first + c.count) as usize]
                .iter()
                .fold(empty(), |all, &k| all.joined(&boxes[k as usize]))
        };
        // Children come after their parents.
        for k in (0..self.nodes.len()).rev() {
            for side in 0..2 {
                let child = self.nodes[k].children[side];
                self.nodes[k].boxes[side] = if child.count > 0 {
                    of_leaf(&self.order, child)
                } else {
                    let [p, q] = self.nodes[child.first as usize].boxes;
                    p.joined(&q)
                };
            }
        }
        self.root_box = match self.nodes.first() {
            Some(node) => node.boxes[0].joined(&node.boxes[1]),
            None => of_leaf(&self.order, self.root),
        };
    }

    /// Visits boxes nearest first as long as they are nearer than the squared distance that `visit` returns, which
    /// starts at `limit`.
    pub fn nearest(&self, p: &Point<3>, limit: f64, mut visit: impl FnMut(usize) -> f64) {
        if self.order.is_empty() {
            return;
        }
        let mut best = limit;
        // The depth of the tree is at most 32.
        let mut stack = [(0.0, self.root); 64];
        stack[0].0 = squared_to(&self.root_box, p);
        let mut top = 1;
        while top > 0 {
            top -= 1;
            let (bound, child) = stack[top];
            if bound > best {
                continue;
            }
            if child.count > 0 {
                for &k in &self.order[child.first as usize..(child.first + child.count) as usize] {
                    best = best.min(visit(k as usize));
                }
                continue;
            }
            let node = &self.nodes[child.first as usize];
            let d = [squared_to(&node.boxes[0], p), squared_to(&node.boxes[1], p)];
            let near = usize::from(d[1] < d[0]);
            for side in [1 - near, near] {
                if d[side] <= best {
                    stack[top] = (d[side], node.children[side]);
                    top += 1;
                }
            }
        }
    }

    /// Visits every box that a ray may meet.
    pub fn along_ray(&self, from: &Point<3>, direction: &Vector<3>, mut visit: impl FnMut(usize)) {
        let inverse = direction.map(|x| 1.0 / x);
        let meets = |b: &Aabb<3>| {
            let (p, q) = ((b.min - from).component_mul(&inverse), (b.max - from).component_mul(&inverse));
            // Wider than rounding can make it narrower.
            let (near, far) = (p.inf(&q).max(), p.sup(&q).min());
            far >= 0.0 && near <= far + 1e-12 * (near.abs() + far)
        };
        let mut stack = vec![self.root];
        while let Some(child) = stack.pop() {
            if child.count > 0 {
                self.order[child.first as usize..(child.first + child.count) as usize]
                    .iter()
                    .for_each(|&k| visit(k as usize));
            } else if let Some(node) = self.nodes.get(child.first as usize) {
                stack.extend((0..2).filter(|&side| meets(&node.boxes[side])).map(|side| node.children[side]));
            }
        }
    }

    /// Visits pairs of boxes of two trees whose squared distance is below what `visit` returns, which starts at
    /// `limit`; nearer pairs tend to come first.
    pub fn nearest_pairs(&self, other: &Bvh, limit: f64, mut visit: impl FnMut(usize, usize) -> f64) {
        if self.order.is_empty() || other.order.is_empty() {
            return;
        }
        let mut best = limit;
        let start = squared_between(&self.root_box, &other.root_box);
        let mut stack = vec![(start, (self.root, self.root_box), (other.root, other.root_box))];
        while let Some((bound, (a, box_a), (b, box_b))) = stack.pop() {
            if bound > best {
                continue;
            }
            if a.count > 0 && b.count > 0 {
                for &i in &self.order[a.first as usize..(a.first + a.count) as usize] {
                    for &j in &other.order[b.first as usize..(b.first + b.count) as usize] {
                        best = best.min(visit(i as usize, j as usize));
                    }
                }
                continue;
            }
            // The larger one is opened.
            let open_a = b.count > 0 || (a.count == 0 && box_a.radius() >= box_b.radius());
            let mut next = [0, 1].map(|side| {
                if open_a {
                    let node = &self.nodes[a.first as usize];
                    let part = (node.children[side], node.boxes[side]);
                    (squared_between(&part.1, &box_b), part, (b, box_b))
                } else {
                    let node = &other.nodes[b.first as usize];
                    let part = (node.children[side], node.boxes[side]);
                    (squared_between(&box_a, &part.1), (a, box_a), part)
                }
            });
            if next[0].0 < next[1].0 {
                next.swap(0, 1);
            }
            stack.extend(next.into_iter().filter(|n| n.0 <= best));
        }
    }

    /// All pairs of boxes of two trees no farther apart than `reach`, in ascending order. With `reach` the sum of how
    /// far the two bodies may move, these are the pairs that can touch meanwhile.
    pub fn pairs_within(&self, other: &Bvh, boxes: (&[Aabb<3>], &[Aabb<3>]), reach: f64) -> Vec<(usize, usize)> {
        let limit = reach * reach;
        let mut pairs = Vec::new();
        self.nearest_pairs(other, limit, |i, j| {
            if squared_between(&boxes.0[i], &boxes.1[j]) <= limit {
                pairs.push((i, j));
            }
            limit
        });
        pairs.sort_unstable();
        pairs
    }
}

fn build(
    boxes: &[Aabb<3>],
    centers: &[Point<3>],
    order: &mut [u32],
    nodes: &mut [Node],
    first_box: usize,
    first_node: usize,
) -> Aabb<3> {
    let n = order.len();
    if n <= LEAF {
        return order.iter().fold(empty(), |all, &k| all.joined(&boxes[k as usize]));
    }
    let extent = order.iter().fold(empty(), |all, &k| {
        let c = centers[k as usize];
        Aabb::new(all.min.inf(&c), all.max.sup(&c))
    });
    let axis = extent.size().imax();
    let left = left_size(n);
    order.select_nth_unstable_by(left - 1, |&a, &b| {
        centers[a as usize][axis].total_cmp(&centers[b as usize][axis]).then(a.cmp(&b))
    });
    let (left_order, right_order) = order.split_at_mut(left);
    let (node, rest) = nodes.split_first_mut().expect("as many nodes as counted");
    let (left_nodes, right_nodes) = rest.split_at_mut(node_count(left));
    let (left_at, right_at) = (first_node + 1, first_node + 1 + node_count(left));
    node.children = [child_of(left, first_box, left_at), child_of(n - left, first_box + left, right_at)];
    let mut build_left = || build(boxes, centers, left_order, left_nodes, first_box, left_at);
    let mut build_right = || build(boxes, centers, right_order, right_nodes, first_box + left, right_at);
    let (p, q) =
        if n >= PARALLEL { rayon::join(&mut build_left, &mut build_right) } else { (build_left(), build_right()) };
    node.boxes = [p, q];
    p.joined(&q)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn boxes(n: usize, seed: u64) -> Vec<Aabb<3>> {
        let mut state = seed;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        (0..n)
            .map(|_| {
                let p = Point::<3>::new(next(), next(), next());
                Aabb::new(p, p + Point::<3>::new(next(), next(), next()) * 0.1)
            })
            .collect()
    }

    #[test]
    fn the_nearest_box_is_the_nearest() {
        for n in [0, 1, 3, 4, 5, 8, 9, 17, 100, 10_000] {
            let all = boxes(n, n as u64);
            let mut tree = Bvh::new(&all);
            for round in 0..2 {
                for p in [Point::<3>::new(0.5, 0.5, 0.5), Point::<3>::new(-1.0, 2.0, 0.3)] {
                    let mut best = f64::INFINITY;
                    tree.nearest(&p, f64::INFINITY, |k| {
                        best = best.min(squared_to(&all[k], &p));
                        best
                    });
                    let exact = all.iter().map(|b| squared_to(b, &p)).fold(f64::INFINITY, f64::min);
                    assert_eq!(best, exact, "{n} boxes, round {round}");
                }
                tree.refit(&all);
            }
        }
    }

    #[test]
    fn pairs_within_reach_are_all_pairs_within_reach() {
        let (a, b) = (boxes(300, 1), boxes(200, 2));
        let pairs = Bvh::new(&a).pairs_within(&Bvh::new(&b), (&a, &b), 0.05);
        let mut exact = Vec::new();
        for i in 0..300 {
            for j in 0..200 {
                if squared_between(&a[i], &b[j]) <= 0.0025 {
                    exact.push((i, j));
                }
            }
        }
        assert_eq!(pairs, exact);
    }

    #[test]
    fn the_tree_does_not_depend_on_threads() {
        let all = boxes(20_000, 5);
        let [one, two] = [1, 2].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| Bvh::new(&all).order)
        });
        assert_eq!(one, two);
    }
}
