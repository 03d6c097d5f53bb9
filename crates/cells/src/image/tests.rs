use super::*;

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
    let whole = [
        ("a.npy", npy),
        ("a.nrrd", nrrd.to_vec()),
        ("a.mha", mha.to_vec()),
        ("a.nii", nifti),
        ("a.tif", stack.into_inner()),
    ];
    let mut seed = 1u64;
    let mut random = |below: usize| {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 33) as usize % below
    };
    let (mut read, mut refused) = (0, 0);
    for (name, mut bytes) in whole {
        if name != "a.tif" {
            bytes.extend(floats(Endian::Little));
        }
        assert!(read_with(name, &bytes, &|_| Err(String::new())).is_ok(), "{name}");
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
            match read_with(name, &bytes, &|_| Ok(bytes.clone())) {
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
        assert!(npy::parse(&bytes[..bytes.len() - 1]).unwrap_err().to_string().contains("cut off"));
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
    let packed = String::from_utf8(text).unwrap().replace("raw", "gzip");
    assert!(nrrd::header(packed.as_bytes()).unwrap_err().to_string().contains("`gzip`"));

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
    assert!(nifti::parse(&[0x1f, 0x8b]).unwrap_err().to_string().contains("gunzip"));
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
    assert!(raw::parse(&floats(Endian::Little), &wrong).unwrap_err().to_string().contains("48 bytes, 72"));
    assert!(matches!(read(Path::new("a.dcm")), Err(ImageError::Ending { .. })));
}
