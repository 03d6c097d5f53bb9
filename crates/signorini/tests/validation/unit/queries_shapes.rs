//! Of `queries::shapes`.

use signorini::testing::{KEPT, Shapes};
use std::path::Path;
use std::sync::Arc;

fn sphere(r: f64) -> String {
    format!(r#"{{"type": "sphere", "o": [0,0,0], "ex": [1,0,0], "ey": [0,1,0], "r": {r}, "range": [[0, 1], [0, 1]]}}"#)
}

#[test]
fn shapes_that_come_again_are_built_once_and_kept() {
    let mut shapes = Shapes::new(Path::new(""));
    let (twice, once) = (sphere(1.0), sphere(2.0));
    shapes.prepare([&*twice, &*once, &*twice].into_iter());
    let first = shapes.partner(&twice).unwrap();
    assert_eq!(shapes.kept(), 1);
    assert!(!Arc::ptr_eq(&shapes.partner(&once).unwrap(), &shapes.partner(&once).unwrap()));
    // More shapes than are kept, two at a time: the first one is used now and then, and stays.
    for k in 0..2 * KEPT {
        let other = sphere(3.0 + k as f64);
        shapes.prepare([&*other, &*other, &*twice].into_iter());
        assert!(Arc::ptr_eq(&shapes.partner(&other).unwrap(), &shapes.partner(&other).unwrap()));
    }
    assert_eq!(shapes.kept(), KEPT);
    assert!(Arc::ptr_eq(&shapes.partner(&twice).unwrap(), &first));
    // What is wrong is kept too, and said each time.
    let wrong = sphere(-1.0);
    shapes.prepare([&*wrong, &*wrong].into_iter());
    assert_eq!(shapes.partner(&wrong).unwrap_err().path, "r");
}
