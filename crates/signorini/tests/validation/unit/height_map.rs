//! Of `height_map`.

use proptest::prelude::*;
use signorini::height_map::read;
use signorini_geometry::height_field::HeightField;
use signorini_geometry::{Jet, Vector};
use std::path::Path;
use tiff::encoder::colortype::{Gray16, Gray32Float, Gray64Float};

fn plane(i: usize, j: usize) -> f64 {
    2.0 * i as f64 - 3.0 * j as f64 + 100.0
}

fn npy_bytes(kind: &str, order: &str, values: &[u8]) -> Vec<u8> {
    let header = format!("{{'descr': '{kind}', 'fortran_order': {order}, 'shape': (5, 6), }}\n");
    let mut out = b"\x93NUMPY\x01\x00".to_vec();
    out.extend((header.len() as u16).to_le_bytes());
    out.extend(header.bytes());
    out.extend(values);
    out
}

fn tiff_bytes<C: tiff::encoder::colortype::ColorType>(number: impl Fn(f64) -> C::Inner) -> Vec<u8>
where
    [C::Inner]: tiff::encoder::TiffValue,
{
    let mut out = std::io::Cursor::new(Vec::new());
    let image: Vec<C::Inner> = (0..30).map(|k| number(plane(k % 6, k / 6))).collect();
    let mut encoder = tiff::encoder::TiffEncoder::new(&mut out).unwrap();
    encoder.write_image::<C>(6, 5, &image).unwrap();
    out.into_inner()
}

/// Five rows of six heights of a plane, in all formats.
fn files() -> Vec<(&'static str, Vec<u8>)> {
    let rows = |sep: &str| -> Vec<u8> {
        let line = |j| (0..6).map(|i| plane(i, j).to_string()).collect::<Vec<_>>().join(sep);
        format!("# a comment\n{}\n", (0..5).map(line).collect::<Vec<_>>().join("\n")).into_bytes()
    };
    let by_rows = |j: usize, i: usize| plane(i, j);
    let c: Vec<u8> = (0..30).flat_map(|k| by_rows(k / 6, k % 6).to_le_bytes()).collect();
    let f: Vec<u8> = (0..30).flat_map(|k| (by_rows(k % 5, k / 5) as i16).to_be_bytes()).collect();
    vec![
        ("map.csv", rows(",")),
        ("map.csv", rows("; ")),
        ("map.txt", rows(" ")),
        ("map.npy", npy_bytes("<f8", "False", &c)),
        ("map.npy", npy_bytes(">i2", "True", &f)),
        ("map.tif", tiff_bytes::<Gray16>(|v| v as u16)),
        ("map.tif", tiff_bytes::<Gray32Float>(|v| v as f32)),
        ("map.tiff", tiff_bytes::<Gray64Float>(|v| v)),
    ]
}

#[test]
fn all_formats_say_the_same() {
    for (name, bytes) in files() {
        let map = read(Path::new(name), &bytes, [1.0, 2.0], [0.5, 0.25], 0.1).unwrap();
        let jet =
            signorini_geometry::height_field::evaluate(&map, Jet::<3>::variable(2.2, 0), Jet::<3>::variable(2.6, 1));
        assert!((jet.value - 0.1 * (2.0 * 2.4 - 3.0 * 2.4 + 100.0)).abs() < 1e-12, "{name}: {}", jet.value);
        assert!((jet.gradient - Vector::<3>::new(0.4, -1.2, 0.0)).norm() < 1e-12, "{name}");
        let known = map.known_within().map(|corners| corners.map(|x| [x[0], x[1]]));
        assert_eq!(known, Some([[1.0, 2.0], [3.5, 3.0]]));
    }
}

#[test]
fn bad_maps_are_refused_in_words() {
    let read = |name: &str, bytes: &[u8]| read(Path::new(name), bytes, [0.0; 2], [1.0; 2], 1.0).unwrap_err();
    assert!(read("a.csv", b"1,2,3,4\n1,2,,4\n").contains("line 2, column 3: is empty"));
    assert!(read("a.csv", b"1,2,3,4\n1,2,x,4\n").contains("`x` is not a number"));
    assert!(read("a.csv", b"1,2,3,4\n1,2\n").contains("2 numbers where the lines before have 4"));
    assert!(read("a.csv", b"1 2 3 4\n").contains("1 rows"));
    assert!(read("a.csv", b"1;2;3;4\n1;2;3,125;4\n").contains("line 2: `3,125`"));
    assert!(read("a.csv", b"1 2 3 4\n1 2 nan 4\n1 2 3 4\n1 2 3 4\n").contains("row 2, column 3 is NaN"));
    assert!(read("a.npy", b"1 2 3 4\n").contains("not an NPY file"));
    assert!(read("a.npy", &npy_bytes("<f8", "False", &[0; 16])).contains("the file ends before"));
    assert!(read("a.npy", &npy_bytes("<c16", "False", &[0; 480])).contains("not supported"));
    assert!(read("a.tif", b"1 2 3 4\n").contains("TIFF"));
    assert!(read("a.xyz", b"").contains("valid are csv, npy and tif"));
    let mut out = std::io::Cursor::new(Vec::new());
    let mut encoder = tiff::encoder::TiffEncoder::new(&mut out).unwrap();
    encoder.write_image::<tiff::encoder::colortype::Gray8>(4, 4, &[0; 16]).unwrap();
    assert!(read("a.tif", &out.into_inner()).contains("16 bits"));
}

proptest! {
    #[test]
    fn damaged_files_do_no_harm(which in 0usize..6, cut in 0.0..1.0f64, changes in prop::collection::vec((0.0..1.0f64, any::<u8>()), 0..8)) {
        let (name, mut bytes) = files().swap_remove(which);
        for (at, value) in changes {
            let k = (at * bytes.len() as f64) as usize;
            bytes[k] = value;
        }
        bytes.truncate((cut * 2.0 * bytes.len() as f64) as usize);
        let _ = read(Path::new(name), &bytes, [0.0; 2], [1.0; 2], 1.0);
    }
}
