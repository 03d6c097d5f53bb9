//! Of `image`.

use signorini_cells::image::{
    Endian, ImageError, Number, metaimage, nifti, npy, nrrd, raw, read, read_with, tiff_stack,
};
use signorini_geometry::Point;
use std::io::Write;
use std::path::Path;

/// 2 × 3 × 2 numbers 0, 1, 2, … in one format or another.
fn values() -> Vec<f64> {
    (0..12).map(f64::from).collect()
}

fn floats(endian: Endian) -> Vec<u8> {
    let bytes = |v: f64| {
        let v = v as f32;
        if endian == Endian::Little { v.to_le_bytes() } else { v.to_be_bytes() }
    };
    values().into_iter().flat_map(bytes).collect()
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

fn zlib(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

/// Bytes of every format with some of them changed, left out or doubled are read or refused, never more: some thousand of
/// what the fuzz targets try without end.
#[test]
fn damaged_files_are_read_or_refused() {
    use tiff::encoder::{TiffEncoder, colortype::Gray16};
    let mut stack = std::io::Cursor::new(Vec::new());
    TiffEncoder::new(&mut stack).unwrap().write_image::<Gray16>(2, 3, &[0, 1, 2, 3, 4, 5]).unwrap();
    let mut npy = b"\x93NUMPY\x01\x00".to_vec();
    let header = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3, 2), }\n";
    npy.extend((header.len() as u16).to_le_bytes());
    npy.extend(header.as_bytes());
    let nrrd = b"NRRD0004\ntype: float\ndimension: 3\nsizes: 2 3 2\nspacings: 1 1 1\nencoding: raw\nendian: little\n\n";
    let mha = b"ObjectType = Image\nNDims = 3\nDimSize = 2 3 2\nElementSpacing = 1 1 2\nElementType = MET_FLOAT\n\
        ElementDataFile = LOCAL\n";
    let mut nifti = vec![0u8; 352];
    for (at, value) in [(0, 348i16), (40, 3), (42, 2), (44, 3), (46, 2), (70, 16), (254, 1)] {
        nifti[at..at + 2].copy_from_slice(&value.to_le_bytes());
    }
    // Spacings, where the values begin, and the diagonal of the affine map.
    for (at, value) in [(80, 1.0f32), (84, 1.0), (88, 1.0), (108, 352.0), (280, 1.0), (300, 1.0), (320, 1.0)] {
        nifti[at..at + 4].copy_from_slice(&value.to_le_bytes());
    }
    nifti[344..348].copy_from_slice(b"n+1\0");
    let numbers = floats(Endian::Little);
    let with = |header: &[u8], numbers: &[u8]| [header, numbers].concat();
    let text = |header: &[u8], from: &str, to: &str| String::from_utf8_lossy(header).replace(from, to).into_bytes();
    let plain: String = values().iter().map(|v| format!("{v} ")).collect();
    let whole = [
        ("a.npy", with(&npy, &numbers)),
        ("a.nrrd", with(nrrd, &numbers)),
        ("b.nrrd", with(&text(nrrd, "raw", "gzip"), &gzip(&numbers))),
        ("c.nrrd", with(&text(nrrd, "raw", "text"), plain.as_bytes())),
        ("d.nhdr", text(nrrd, "endian", "data file: numbers\nendian")),
        ("a.mha", with(mha, &numbers)),
        ("b.mha", with(&text(mha, "NDims = 3", "NDims = 3\nCompressedData = True"), &zlib(&numbers))),
        ("a.nii", with(&nifti, &numbers)),
        ("b.nii.gz", gzip(&with(&nifti, &numbers))),
        ("a.tif", stack.into_inner()),
    ];
    let mut seed = 1u64;
    let mut random = |below: usize| {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 33) as usize % below
    };
    let (mut read, mut refused) = (0, 0);
    for (name, bytes) in whole {
        let read_whole = read_with(name, &bytes, &|_| Ok(numbers.clone())).unwrap();
        assert!(name == "a.tif" || read_whole.values == values(), "{name}");
        for _ in 0..1000 {
            let mut bytes = bytes.clone();
            for _ in 0..=random(4) {
                let at = random(bytes.len());
                match random(4) {
                    0 => bytes[at] = random(256) as u8,
                    1 => bytes[at] = b"0123456789-. ,()"[random(16)],
                    2 => bytes.truncate(at.max(1)),
                    _ => {
                        let end = (at + random(16)).min(bytes.len());
                        let again = bytes[at..end].to_vec();
                        bytes.splice(at..at, again);
                    }
                }
            }
            match read_with(name, &bytes, &|_| Ok(numbers.clone())) {
                Ok(image) => {
                    assert_eq!(image.count.iter().product::<usize>(), image.values.len(), "{name}");
                    let _ = image.voxels::<3>().map(|v| v.above(0.5, 1.0).is_ok());
                    read += 1;
                }
                Err(error) => {
                    assert!(!error.to_string().is_empty());
                    refused += 1;
                }
            }
        }
    }
    assert!(read > 100 && refused > 1000, "{read} {refused}");
}

#[test]
fn npy_in_both_orders() {
    for (order, shape) in [("False", "(2, 3, 2)"), ("True", "(2, 3, 2)")] {
        let header = format!("{{'descr': '>f4', 'fortran_order': {order}, 'shape': {shape}, }}\n");
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.as_bytes());
        bytes.extend(floats(Endian::Big));
        let image = npy::parse(&bytes).unwrap();
        assert_eq!((image.count.as_slice(), image.values), (&[2, 3, 2][..], values()));
        assert!(npy::parse(&bytes[..bytes.len() - 1]).unwrap_err().to_string().contains("truncated"));
    }
    assert!(npy::parse(b"PK").unwrap_err().to_string().contains("numpy.save"));
}

#[test]
fn nrrd_and_metaimage_say_where_the_voxels_are() {
    let mut bytes = b"NRRD0004\ntype: float\ndimension: 3\nsizes: 2 3 2\nspace directions: (0.5,0,0) (0,1,0) (0,0,2)\n\
        space origin: (1,2,3)\nencoding: raw\nendian: little\n\n"
        .to_vec();
    let text = bytes.clone();
    bytes.extend(floats(Endian::Little));
    let header = nrrd::header(&bytes).unwrap();
    let image = header.decode(&bytes[header.data_start..]).unwrap();
    assert_eq!((image.values.clone(), image.spacing.clone()), (values(), vec![0.5, 1.0, 2.0]));
    assert_eq!(image.origin, [0.75, 1.5, 2.0]);
    let voxels = image.voxels::<3>().unwrap();
    assert_eq!(voxels.voxel_at(&Point::<3>::new(1.6, 3.1, 3.0)), 3);
    // Exchanged and mirrored directions, packed: the voxel at the far end along x is the first of the file.
    let text = String::from_utf8(text).unwrap();
    let turned = text.replace("(0.5,0,0) (0,1,0)", "(0,1,0) (-0.5,0,0)").replace("raw", "gzip");
    let image = read_with("a.nrrd", &[turned.as_bytes(), &gzip(&floats(Endian::Little))].concat(), &|_| unreachable!());
    let image = image.unwrap();
    assert_eq!((image.count, image.spacing, image.origin), (vec![3, 2, 2], vec![0.5, 1.0, 2.0], vec![-0.25, 1.5, 2.0]));
    assert_eq!(image.values[..6], [4.0, 2.0, 0.0, 5.0, 3.0, 1.0]);
    // What is not understood is not passed over; a header that promises what cannot be there is not believed.
    for (from, to, place) in [
        ("encoding: raw", "encoding: bzip2", "`encoding`"),
        ("endian", "byte skip: -1\nendian", "`byte skip`"),
        ("dimension: 3", "dimension: 4", "`dimension`"),
        ("(0,0,2)", "(0,0.1,2)", "the frame"),
        ("2 3 2", "2000 2000 2000", "the data"),
    ] {
        let wrong = text.replace("raw", "gzip").replace("gzip", if from.contains("raw") { "raw" } else { "gzip" });
        let bytes = [wrong.replace(from, to).as_bytes(), &gzip(&floats(Endian::Little))].concat();
        let told = read_with("a.nrrd", &bytes, &|_| unreachable!()).unwrap_err().to_string();
        assert!(told.contains(place), "{told}");
    }
    let none = text.replace("space directions: (0.5,0,0) (0,1,0) (0,0,2)\n", "");
    let image = read_with("a.nrrd", &[none.as_bytes(), &floats(Endian::Little)].concat(), &|_| unreachable!()).unwrap();
    assert!(image.spacing.is_empty() && image.voxels::<3>().is_err());

    let mut bytes = b"ObjectType = Image\nNDims = 3\nDimSize = 2 3 2\nElementSpacing = 0.5 1 2\nOffset = 1 2 3\n\
        BinaryDataByteOrderMSB = True\nElementType = MET_FLOAT\nElementDataFile = LOCAL\n"
        .to_vec();
    bytes.extend(floats(Endian::Big));
    let header = metaimage::header(&bytes).unwrap();
    let other = header.decode(&bytes[header.data_start..]).unwrap();
    assert_eq!((other.values, other.origin), (values(), vec![0.75, 1.5, 2.0]));
    let short = header.decode(&bytes[header.data_start..bytes.len() - 4]).unwrap_err();
    assert!(short.to_string().contains("44 bytes"), "{short}");
    assert!(metaimage::header(b"DimSize = 2\n").is_err());
}

#[test]
fn nifti_scales_its_values() {
    let mut bytes = vec![0u8; 352];
    bytes[0..4].copy_from_slice(&348i32.to_le_bytes());
    for (at, value) in [(40, 3i16), (42, 2), (44, 3), (46, 2), (70, 16), (254, 1)] {
        bytes[at..at + 2].copy_from_slice(&value.to_le_bytes());
    }
    let numbers = [
        (80, 0.5f32),
        (84, 1.0),
        (88, 2.0),
        (108, 352.0),
        (112, 2.0),
        (116, 1.0),
        (280, 0.5),
        (292, 1.0),
        (300, 1.0),
        (308, 2.0),
        (320, 2.0),
        (324, 3.0),
    ];
    for (at, value) in numbers {
        bytes[at..at + 4].copy_from_slice(&value.to_le_bytes());
    }
    bytes[344..348].copy_from_slice(b"n+1\0");
    bytes.extend(floats(Endian::Little));
    let image = nifti::parse(&bytes).unwrap();
    assert_eq!(image.values, values().iter().map(|v| 2.0 * v + 1.0).collect::<Vec<f64>>());
    assert_eq!((image.count, image.origin), (vec![2, 3, 2], vec![0.75, 1.5, 2.0]));
    let packed = gzip(&bytes);
    assert_eq!(nifti::parse(&packed).unwrap().origin, [0.75, 1.5, 2.0]);
    assert!(nifti::parse(&packed[..packed.len() / 2]).unwrap_err().to_string().contains("compressed"));
    // As ITK writes it: x and y the other way round; then the same by a half turn about z.
    let mirrored: &[(usize, f32)] = &[(280, -0.5), (292, 1.0), (300, -1.0), (308, 2.0)];
    let turned: &[(usize, f32)] = &[(256, 0.0), (260, 0.0), (264, 1.0), (268, 1.0), (272, 2.0), (276, 3.0), (76, 1.0)];
    for (codes, numbers) in [([0i16, 1], mirrored), ([1, 0], turned)] {
        let mut bytes = bytes.clone();
        bytes[252..254].copy_from_slice(&codes[0].to_le_bytes());
        bytes[254..256].copy_from_slice(&codes[1].to_le_bytes());
        for (at, value) in numbers {
            bytes[*at..at + 4].copy_from_slice(&value.to_le_bytes());
        }
        let image = nifti::parse(&bytes).unwrap();
        assert_eq!((image.origin, image.spacing), (vec![0.25, -0.5, 2.0], vec![0.5, 1.0, 2.0]));
        assert_eq!(image.values[..6], [11.0, 9.0, 7.0, 5.0, 3.0, 1.0]);
    }
    assert!(nifti::parse(&bytes[..200]).is_err());
}

#[test]
fn stacks_of_pictures_and_raw_numbers() {
    use tiff::encoder::{TiffEncoder, colortype::Gray16};
    let mut file = std::io::Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut file).unwrap();
    for layer in 0..2u16 {
        let numbers: Vec<u16> = (0..6).map(|i| 6 * layer + i).collect();
        encoder.write_image::<Gray16>(2, 3, &numbers).unwrap();
    }
    let image = tiff_stack::parse(file.get_ref()).unwrap();
    assert_eq!((image.count, image.values), (vec![2, 3, 2], values()));
    assert!(tiff_stack::parse(b"none").is_err());
    // Layers of a folder, the tenth behind the ninth.
    let folder = std::env::temp_dir().join(format!("signorini-layers-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    for layer in [9u16, 10] {
        let mut file = std::io::Cursor::new(Vec::new());
        TiffEncoder::new(&mut file).unwrap().write_image::<Gray16>(2, 1, &[layer, 0]).unwrap();
        std::fs::write(folder.join(format!("s{layer}.tif")), file.into_inner()).unwrap();
    }
    let image = read(&folder);
    std::fs::remove_dir_all(&folder).unwrap();
    assert_eq!(image.unwrap().values, [9.0, 0.0, 10.0, 0.0]);
    let header = raw::RawHeader {
        count: vec![2, 3, 2],
        spacing: vec![1.0; 3],
        origin: vec![0.0; 3],
        number: Number::F32,
        endian: Endian::Little,
        skip: 0,
    };
    assert_eq!(raw::parse(&floats(Endian::Little), &header).unwrap().values, values());
    let wrong = raw::RawHeader { count: vec![2, 3, 3], ..header };
    assert!(raw::parse(&floats(Endian::Little), &wrong).unwrap_err().to_string().contains("48 bytes, but 72"));
    assert!(matches!(read(Path::new("a.dcm")), Err(ImageError::Ending { .. })));
}
