//! Of `queries::points`.

use signorini::testing::read;
use signorini_geometry::Point;

#[test]
fn points_are_read_or_refused_with_their_place() {
    let expected = vec![Point::<3>::new(1.0, 2.5, -3.0), Point::<3>::new(4.0, 5.0, 6e-3)];
    for text in ["1,2.5,-3\n4,5,6e-3", "# c\nz;n;x;y\n-3;0;1;2,5\n6e-3;0;4;5\n", "X Y Z\n1 2.5 -3\n4 5 6e-3\n"] {
        assert_eq!(read(text.as_bytes()), Ok(expected.clone()), "{text}");
    }
    let head = |kind: &str, shape: &str| {
        let text = format!("{{'descr': '{kind}', 'fortran_order': True, 'shape': {shape}, }}\n");
        [&b"\x93NUMPY\x01\x00"[..], &(text.len() as u16).to_le_bytes(), text.as_bytes()].concat()
    };
    let columns = [1f64, 4.0, 2.5, 5.0, -3.0, 6e-3].map(f64::to_le_bytes).concat();
    assert_eq!(read(&[head("<f8", "(2, 3)"), columns.clone()].concat()), Ok(expected));
    for (bytes, words) in [
        (&b""[..], "contains no points"),
        (b"x,y,z\n", "contains no points"),
        (b"x,y\n1,2\n", "no columns x, y and z among x, y"),
        (b"1,2\n", "line 1: 2 numbers instead of 3"),
        (b"1,2,3\n1,2\n", "line 2: 2 entries"),
        (b"x,y,z\n1,a,3\n", "line 2, column 2: `a` is not a number"),
        (b"1,2,inf\n", "line 1: inf is not finite"),
        (&[head("<f8", "(3, 2)"), columns.clone()].concat(), "points are an array of (n, 3)"),
        (&[head("<f8", "(1, 3)"), [0.0, f64::NAN, 0.0].map(f64::to_le_bytes).concat()].concat(), "row 0: NaN"),
    ] {
        let error = read(bytes).unwrap_err();
        assert!(error.contains(words), "{words}: {error}");
    }
}
