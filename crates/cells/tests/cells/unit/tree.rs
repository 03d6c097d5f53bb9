//! Of `tree`.

use signorini_cells::tree::CellTree;
use signorini_geometry::{Aabb, Point};

#[test]
fn leaves_fill_the_box_and_are_found() {
    let b = Aabb::new(Point::<2>::new(-1.0, 0.5), Point::<2>::new(2.0, 2.0));
    let mut tree = CellTree::new(b, [3, 2]).unwrap();
    for x in [Point::<2>::new(0.1, 0.7), Point::<2>::new(0.1, 0.7), Point::<2>::new(1.9, 1.9)] {
        let at = tree.leaf_at(&x);
        let leaf = tree.leaves()[at];
        assert_eq!(tree.refine(|l| *l == leaf), Ok(1));
    }
    assert_eq!(tree.leaves().len(), 6 + 9);
    let total: f64 = tree.leaves().iter().map(|l| l.bounds.volume()).sum();
    assert!((total - b.volume()).abs() < 1e-14);
    for (i, leaf) in tree.leaves().iter().enumerate() {
        assert_eq!(tree.leaf_at(&leaf.bounds.center()), i);
    }
    assert_eq!(tree.leaf_at(&Point::<2>::new(9.0, 9.0)), tree.leaf_at(&Point::<2>::new(1.99, 1.99)));
}
