//! Of `path::read`.

use signorini_geometry::Point;
use signorini_rope::path::PathError;
use signorini_rope::testing::points;

#[test]
fn tables_are_read_and_faults_told_with_their_line() {
    for text in ["x,y,z\n0,0,0\n1, 2,3\n", "# belt\n0 0 0\n\n1  2 3", "\u{feff}0;0;0\r\n1;2;3\r\n", "0\t0\t0\n1\t2\t3"]
    {
        assert_eq!(points(text).unwrap(), [Point::<3>::zeros(), Point::<3>::new(1.0, 2.0, 3.0)], "{text:?}");
    }
    assert!(matches!(points("0,0,0\n1,2\n"), Err(PathError::File { line: 2, .. })));
    assert!(matches!(points("0,0,0\n1,a,2\n"), Err(PathError::File { line: 2, .. })));
    assert!(points("0;0;0\n1,5;2;3").unwrap_err().to_string().contains("decimals"));
}
