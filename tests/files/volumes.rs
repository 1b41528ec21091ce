//! Volume files: what is read from them, every way in which they are refused, and the corpus of the fuzz
//! target `volumes`.

use leafless::error::VolumeFileError;
use leafless::exchange::{
    LengthUnit, MeshOptions, NrrdEncoding, RawVolume, SampleKind, VolumeFile, VolumeFormat, open_mesh,
    open_volume, read_raw_volume, read_volume, volume_data_file, write_nrrd, write_raw_volume,
};
use leafless::solid::{Band, Samples, VoxelGrid};
use leafless::{Control, Error, Frame, Rule, Solid, build, measure};
use leafless_testkit::volumes::{KINDS, Sampled, extents, grid};
use leafless_testkit::{Random, fuzz};

/// Returns the samples as numbers.
fn numbers(samples: &Samples<'_>, grid: &VoxelGrid) -> Vec<f64> {
    match samples {
        Samples::Bits(_) => write_raw_volume(samples, grid).unwrap().into_iter().map(f64::from).collect(),
        Samples::U8(values) => values.values().iter().map(|&v| v.into()).collect(),
        Samples::U16(values) => values.values().iter().map(|&v| v.into()).collect(),
        Samples::I16(values) => values.values().iter().map(|&v| v.into()).collect(),
        Samples::F32(values) => values.values().iter().map(|&v| v.into()).collect(),
    }
}

#[track_caller]
fn read(bytes: &[u8]) -> VolumeFile {
    read_volume(bytes, None).unwrap_or_else(|error| panic!("{error}"))
}

fn values(file: &VolumeFile) -> Vec<f64> {
    numbers(&file.samples, &file.grid)
}

#[track_caller]
fn refused(bytes: &[u8]) -> VolumeFileError {
    match read_volume(bytes, None) {
        Err(Error::VolumeFile(error)) => error,
        other => panic!("{other:?}"),
    }
}

fn same(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a == b || a.is_nan() && b.is_nan())
}

#[test]
fn what_is_written_comes_back() {
    let mut random = Random(31);
    for round in 0..60 {
        let extents = extents(&mut random, 70);
        let sampled = Sampled::random(&mut random, extents, round % KINDS);
        // Corners that halves of spacings do not round.
        let spacing = [0; 3].map(|_| f64::from(1 + random.below(64) as u32) / 64.0);
        let corner = [0; 3].map(|_| random.between(-64.0, 64.0).round() / 8.0);
        let grid = VoxelGrid::new(extents, corner, spacing).unwrap();
        let samples = sampled.samples();
        for encoding in [NrrdEncoding::Raw, NrrdEncoding::Gzip] {
            let file = read(&write_nrrd(&samples, &grid, encoding).unwrap());
            assert!(same(&values(&file), &sampled.values));
            assert_eq!((file.grid, file.placement, file.rounded), (grid, None, 0));
            assert_eq!(file.format, VolumeFormat::Nrrd);
        }
        let kind =
            [SampleKind::U8, SampleKind::U8, SampleKind::U16, SampleKind::I16, SampleKind::F32][sampled.kind];
        let bytes = write_raw_volume(&samples, &grid).unwrap();
        let layout = RawVolume { grid, kind, big_endian: false, skip: 0 };
        let (again, rounded) = read_raw_volume(&bytes, &layout).unwrap();
        assert!(same(&numbers(&again, &grid), &sampled.values) && rounded == 0);
    }
    // Any other grid moves by less than two last places, and only if its corner cannot be computed from any
    // origin.
    for _ in 0..100 {
        let grid = grid(&mut random, [2, 1, 1], false);
        let file = read(&write_nrrd(&vec![0u8; 2].into(), &grid, NrrdEncoding::Raw).unwrap());
        assert_eq!(file.grid.spacing(), grid.spacing());
        for axis in 0..3 {
            let (centre, half) = (grid.centre([0; 3])[axis], 0.5 * grid.spacing()[axis]);
            let origins = [centre, centre.next_down(), centre.next_up()];
            if origins.into_iter().any(|origin| origin - half == grid.corner()[axis]) {
                assert_eq!(file.grid.corner()[axis], grid.corner()[axis]);
            }
            let off = (file.grid.corner()[axis] - grid.corner()[axis]).abs();
            assert!(off <= 2.0 * f64::EPSILON * (grid.corner()[axis].abs() + grid.spacing()[axis]));
        }
    }
}

/// A type: its names, the bytes of three numbers, the resulting samples, and the number of rounded samples.
type Type = (SampleKind, &'static str, &'static str, Vec<Vec<u8>>, [f64; 3], u64);

/// Each type in both byte orders, with its samples.
#[test]
fn types_and_orders() {
    let grid = VoxelGrid::new([3, 1, 1], [0.0; 3], [1.0; 3]).unwrap();
    let list: [Type; 10] = [
        (
            SampleKind::I8,
            "signed char",
            "MET_CHAR",
            [-128i8, 0, 127].map(|v| v.to_le_bytes().to_vec()).to_vec(),
            [-128.0, 0.0, 127.0],
            0,
        ),
        (
            SampleKind::U8,
            "uint8_t",
            "MET_UCHAR",
            [0u8, 1, 255].map(|v| v.to_le_bytes().to_vec()).to_vec(),
            [0.0, 1.0, 255.0],
            0,
        ),
        (
            SampleKind::I16,
            "short",
            "MET_SHORT",
            [-32768i16, 258, 32767].map(|v| v.to_le_bytes().to_vec()).to_vec(),
            [-32768.0, 258.0, 32767.0],
            0,
        ),
        (
            SampleKind::U16,
            "unsigned short int",
            "MET_USHORT",
            [0u16, 258, 65535].map(|v| v.to_le_bytes().to_vec()).to_vec(),
            [0.0, 258.0, 65535.0],
            0,
        ),
        (
            SampleKind::I32,
            "int",
            "MET_INT",
            [-2147483648i32, 16_777_216, 16_777_217].map(|v| v.to_le_bytes().to_vec()).to_vec(),
            [-2147483648.0, 16_777_216.0, 16_777_216.0],
            1,
        ),
        (
            SampleKind::U32,
            "uint32",
            "MET_UINT",
            [0u32, 258, 4294967295].map(|v| v.to_le_bytes().to_vec()).to_vec(),
            [0.0, 258.0, 4294967296.0],
            1,
        ),
        (
            SampleKind::I64,
            "long long",
            "MET_LONG_LONG",
            [i64::MIN, 258, i64::MAX].map(|v| v.to_le_bytes().to_vec()).to_vec(),
            [-9223372036854775808.0, 258.0, 9223372036854775808.0],
            1,
        ),
        (
            SampleKind::U64,
            "ulonglong",
            "MET_ULONG_LONG",
            [0u64, 258, u64::MAX].map(|v| v.to_le_bytes().to_vec()).to_vec(),
            [0.0, 258.0, 18446744073709551616.0],
            1,
        ),
        (
            SampleKind::F32,
            "float",
            "MET_FLOAT",
            [0.1f32, -2.5, f32::INFINITY].map(|v| v.to_le_bytes().to_vec()).to_vec(),
            [0.1f32.into(), -2.5, f64::INFINITY],
            0,
        ),
        (
            SampleKind::F64,
            "double",
            "MET_DOUBLE",
            [0.1f64, -2.5, 1e300].map(|v| v.to_le_bytes().to_vec()).to_vec(),
            [0.1f32.into(), -2.5, f64::INFINITY],
            2,
        ),
    ];
    for (kind, nrrd, meta, numbers_in, expected, rounded) in list {
        for big in [false, true] {
            let bytes: Vec<u8> = numbers_in
                .iter()
                .flat_map(|number| if big { number.iter().rev().copied().collect() } else { number.clone() })
                .collect();
            let layout = RawVolume { grid, kind, big_endian: big, skip: 0 };
            let (samples, found) = read_raw_volume(&bytes, &layout).unwrap();
            assert_eq!((numbers(&samples, &grid), found), (expected.to_vec(), rounded), "{kind:?}");
            let order = if big { "big" } else { "little" };
            let header = format!(
                "NRRD0004\ntype: {nrrd}\ndimension: 3\nsizes: 3 1 1\nendian: {order}\nencoding: raw\n\n"
            );
            let file = read(&[header.as_bytes(), &bytes].concat());
            assert_eq!((values(&file), file.rounded, file.kind), (expected.to_vec(), rounded, kind));
            let order = if big { "True" } else { "False" };
            let header = format!(
                "ObjectType = Image\nNDims = 3\nDimSize = 3 1 1\nElementByteOrderMSB = {order}\nElementType = {meta}\nElementDataFile = LOCAL\n"
            );
            let file = read(&[header.as_bytes(), &bytes].concat());
            assert_eq!((values(&file), file.rounded, file.kind), (expected.to_vec(), rounded, kind));
            assert_eq!(file.format, VolumeFormat::MetaImage);
        }
    }
    // Bits, with a byte before them.
    let grid = VoxelGrid::new([10, 2, 1], [0.0; 3], [1.0; 3]).unwrap();
    let layout = RawVolume { grid, kind: SampleKind::Bit, big_endian: false, skip: 1 };
    let (samples, _) = read_raw_volume(&[9, 0b1000_0001, 0b10, 0, 0b1111_1101], &layout).unwrap();
    let set: Vec<usize> = (0..20).filter(|&i| numbers(&samples, &grid)[i] == 1.0).collect();
    assert_eq!(set, [0, 7, 9, 18]);
}

const NRRD: &str = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 3 2\nencoding: raw\n";
const META: &str = "ObjectType = Image\nNDims = 3\nDimSize = 2 3 2\nElementType = MET_UCHAR\n";
const DATA: &[u8] = &[1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12];

fn nrrd(fields: &str) -> Vec<u8> {
    [NRRD.as_bytes(), fields.as_bytes(), b"\n", DATA].concat()
}

fn meta(fields: &str) -> Vec<u8> {
    [META.as_bytes(), fields.as_bytes(), b"ElementDataFile = LOCAL\n", DATA].concat()
}

/// The grid's corner and spacing, and the rows of the map.
type Lies = ([f64; 3], [f64; 3], Option<[[f64; 4]; 3]>);

fn lies(bytes: &[u8]) -> Lies {
    let file = read(bytes);
    assert!(same(&values(&file), &(1..=12).map(f64::from).collect::<Vec<_>>()));
    (file.grid.corner(), file.grid.spacing(), file.placement.map(|map| *map.rows()))
}

#[test]
fn places_of_nrrd() {
    let half = [-0.5; 3];
    assert_eq!(lies(&nrrd("")), (half, [1.0; 3], None));
    assert_eq!(lies(&nrrd("spacings: 1 2 0.5\n")), ([-0.5, -1.0, -0.25], [1.0, 2.0, 0.5], None));
    // From the first to the last sample, or over the full extent.
    assert_eq!(
        lies(&nrrd("axis mins: 0 1 2\naxis maxs: 1 2 3\n")),
        ([-0.5, 0.75, 1.5], [1.0, 0.5, 1.0], None)
    );
    let cells = "axismins: 0 1 2\naxismaxs: 1 2.5 3\ncenters: cell cell cell\n";
    assert_eq!(lies(&nrrd(cells)), ([0.0, 1.0, 2.0], [0.5, 0.5, 0.5], None));
    let space = "space: left-posterior-superior\nspace directions: (0.5,0,0) (0,0.25,0) (0,0,2)\nspace origin: (1,2,3)\n";
    assert_eq!(lies(&nrrd(space)), ([0.75, 1.875, 2.0], [0.5, 0.25, 2.0], None));
    let turned =
        "space dimension: 3\nspace directions: (0,2,0) (-3,0,0) (0,0,-1)\nspace origin: ( 1 , 2 , 3 )\n";
    let rows = [[0.0, -1.0, 0.0, 1.0], [1.0, 0.0, 0.0, 2.0], [0.0, 0.0, -1.0, 3.0]];
    assert_eq!(lies(&nrrd(turned)), ([-1.0, -1.5, -0.5], [2.0, 3.0, 1.0], Some(rows)));
    let oblique = "space directions: (3,4,0) (-4,3,0) (0,1e-30,2)\n";
    let rows = [[0.6, -0.8, 0.0, 0.0], [0.8, 0.6, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
    assert_eq!(lies(&nrrd(oblique)), ([-2.5, -2.5, -1.0], [5.0, 5.0, 2.0], Some(rows)));
    // The first sample lies at the place stated in the file.
    let file = read(&nrrd(turned));
    assert_eq!(file.placement.unwrap().apply(file.grid.centre([0; 3])), [1.0, 2.0, 3.0]);
    assert_eq!(file.placement.unwrap().apply(file.grid.centre([1, 2, 1])), [-5.0, 4.0, 2.0]);
    // Units, and axes of one sample.
    assert_eq!(read(&nrrd("space units: \"mm\" \"mm\" \"mm\"\n")).unit, Some(LengthUnit::Millimetre));
    assert_eq!(read(&nrrd("units: \"mm\" \"mm\" \"cm\"\n")).unit, None);
    let four = "NRRD0004\r\nType: uchar\r\nDimension: 4\r\nSizes: 1 2 3 2\r\nspace directions: none (1,0,0) (0,1,0) (0,0,1)\r\n\
        kinds: vector domain domain domain\r\nEncoding: RAW\r\n\r\n";
    let file = read(&[four.as_bytes(), DATA].concat());
    assert_eq!((file.grid.extents(), values(&file)[11]), ([2, 3, 2], 12.0));
    let two = "NRRD0001\ntype: uchar\ndimension: 2\nsizes: 4 3\nspacings: 2 3\nencoding: raw\n\n";
    assert_eq!(read(&[two.as_bytes(), DATA].concat()).grid.spacing(), [2.0, 3.0, 1.0]);
}

#[test]
fn places_of_metaimage() {
    assert_eq!(lies(&meta("")), ([-0.5; 3], [1.0; 3], None));
    let plain = "ElementSpacing = 1 2 0.5\nOffset = 1 2 3\nTransformMatrix = 1 0 0 0 1 0 0 0 1\nAnatomicalOrientation = RAI\n";
    assert_eq!(lies(&meta(plain)), ([0.5, 1.0, 2.75], [1.0, 2.0, 0.5], None));
    assert_eq!(lies(&meta("ElementSize = 1 2 0.5\n")).1, [1.0, 2.0, 0.5]);
    let turned = "ElementSpacing = 2 3 1\nPosition = 1 2 3\nOrientation = 0 1 0 -1 0 0 0 0 -1\n";
    let rows = [[0.0, -1.0, 0.0, 1.0], [1.0, 0.0, 0.0, 2.0], [0.0, 0.0, -1.0, 3.0]];
    assert_eq!(lies(&meta(turned)), ([-1.0, -1.5, -0.5], [2.0, 3.0, 1.0], Some(rows)));
    assert_eq!(read(&meta("DistanceUnits = mm\n")).unit, Some(LengthUnit::Millimetre));
    assert_eq!(values(&read(&meta("Comment = \u{e9}\nHeaderSize = 0\n")))[0], 1.0);
}

#[test]
fn encodings() {
    let text = "1 2,3\n4 5 6\t7 8 9 10 11 12\n";
    let ascii = NRRD.replace("raw", "text") + "\n" + text;
    assert_eq!(values(&read(ascii.as_bytes()))[11], 12.0);
    let ascii = META.to_string() + "BinaryData = False\nElementDataFile = LOCAL\n" + text;
    assert_eq!(values(&read(ascii.as_bytes()))[11], 12.0);
    let floats = "NRRD0004\ntype: float\ndimension: 3\nsizes: 1 1 3\nencoding: ascii\n\nnan -1e-3 inf";
    let found = values(&read(floats.as_bytes()));
    assert!(found[0].is_nan() && found[1] == f64::from(-1e-3f32) && found[2] == f64::INFINITY);

    let zlib = miniz_oxide::deflate::compress_to_vec_zlib(DATA, 9);
    let fields =
        format!("CompressedData = True\nCompressedDataSize = {}\nElementDataFile = LOCAL\n", zlib.len());
    let file = [META.as_bytes(), fields.as_bytes(), &zlib].concat();
    assert_eq!(values(&read(&file))[11], 12.0);
    // With bytes before the data, and no stated length.
    let fields = "CompressedData = True\nHeaderSize = 3\nElementDataFile = LOCAL\nabc";
    let file = [META.as_bytes(), fields.as_bytes(), &zlib].concat();
    assert_eq!(values(&read(&file))[11], 12.0);

    // Two gzip members, the first with a name. Its first byte and one line are skipped.
    let member = |data: &[u8], name: bool| {
        let flags = if name { 8 } else { 0 };
        let mut bytes = vec![0x1F, 0x8B, 8, flags, 0, 0, 0, 0, 0, 3];
        bytes.extend_from_slice(if name { b"a.raw\0" } else { b"" });
        bytes.extend(miniz_oxide::deflate::compress_to_vec(data, 6));
        bytes.extend(crc32fast::hash(data).to_le_bytes());
        bytes.extend((data.len() as u32).to_le_bytes());
        bytes
    };
    let header = NRRD.replace("raw", "gz") + "line skip: 1\nbyte skip: 1\n\na line\n";
    let (first, second) = (member(&[&[99], &DATA[..5]].concat(), true), member(&DATA[5..], false));
    let file = [header.as_bytes(), &first, &second].concat();
    assert_eq!(values(&read(&file)), (1..=12).map(f64::from).collect::<Vec<_>>());
    for at in header.len()..file.len() {
        // A member's header has bytes without meaning.
        let mut wrong = file.clone();
        wrong[at] ^= 1 << (at % 8);
        if let Ok(found) = read_volume(&wrong, None) {
            assert_eq!(values(&found), (1..=12).map(f64::from).collect::<Vec<_>>());
        }
    }
    let last = [NRRD.as_bytes(), b"byte skip: -1\n\nanything", DATA].concat();
    assert_eq!(values(&read(&last))[0], 1.0);
    assert_eq!(values(&read(&[nrrd(""), b"\n".to_vec()].concat()))[0], 1.0);
}

#[test]
fn samples_in_another_file() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name);
    std::fs::create_dir(place("data")).unwrap();
    std::fs::write(place("data/a.raw"), DATA).unwrap();
    std::fs::write(place("a.nhdr"), NRRD.to_string() + "data file: data/a.raw\n").unwrap();
    std::fs::write(place("a.mhd"), META.to_string() + "ElementDataFile = ./data/a.raw\n").unwrap();
    std::fs::write(place("whole.nrrd"), nrrd("")).unwrap();
    for name in ["a.nhdr", "a.mhd", "whole.nrrd"] {
        assert_eq!(values(&open_volume(place(name)).unwrap())[11], 12.0, "{name}");
    }
    let header = std::fs::read(place("a.mhd")).unwrap();
    assert_eq!(volume_data_file(&header).unwrap().as_deref(), Some("./data/a.raw"));
    assert_eq!(volume_data_file(&nrrd("")).unwrap(), None);
    assert_eq!(values(&read_volume(&header, Some(DATA)).unwrap())[11], 12.0);
    assert!(matches!(refused(&header), VolumeFileError::Missing { .. }));
    // Errors name the file with the problem.
    for (name, data, about) in [
        ("b.mhd", "b.raw", "b.raw"),
        ("c.mhd", "../c.raw", "c.mhd"),
        ("d.mhd", "/dev/zero", "d.mhd"),
        ("e.mhd", "data", "data"),
    ] {
        std::fs::write(place(name), META.to_string() + "ElementDataFile = " + data + "\n").unwrap();
        let error = open_volume(place(name)).unwrap_err();
        assert!(matches!(&error, Error::File { path, .. } if path.ends_with(about)), "{error}");
    }
}

/// The target of a link counts, not the link's own place.
#[cfg(unix)]
#[test]
fn links_do_not_lead_out_of_the_folder() {
    use std::os::unix::fs::symlink;
    let all = tempfile::tempdir().unwrap();
    let place = |name: &str| all.path().join(name);
    for folder in ["in", "in/deep", "out", "other"] {
        std::fs::create_dir(place(folder)).unwrap();
    }
    std::fs::write(place("out/secret.raw"), DATA).unwrap();
    std::fs::write(place("in/a.raw"), DATA).unwrap();
    let headers = |folder: &str, name: &str, data: &str| {
        let of = |extension: &str| place(&format!("{folder}/{name}.{extension}"));
        std::fs::write(of("nhdr"), format!("{NRRD}data file: {data}\n")).unwrap();
        std::fs::write(of("mhd"), format!("{META}ElementDataFile = {data}\n")).unwrap();
        [of("nhdr"), of("mhd")]
    };
    let good = |path: &std::path::Path| {
        let file = open_volume(path).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(values(&file)[11], 12.0, "{path:?}");
    };
    // A link to a file outside, a link to a folder outside, and a link to such a link.
    symlink("../out/secret.raw", place("in/link.raw")).unwrap();
    symlink(place("out"), place("in/folder")).unwrap();
    symlink("../link.raw", place("in/deep/again.raw")).unwrap();
    for data in ["link.raw", "folder/secret.raw", "deep/again.raw", "./deep/../link.raw"] {
        for header in headers("in", "bad", data) {
            let error = open_volume(&header).unwrap_err();
            assert!(matches!(&error, Error::File { path, .. } if **path == *header), "{error}");
            assert!(
                matches!(error.cause(), Error::VolumeFile(VolumeFileError::Unsupported { .. })),
                "{error}"
            );
            assert!(error.to_string().contains("outside of the header's folder"), "{error}");
        }
    }
    // Links within the folder, and a folder that is reached by a link.
    symlink("../a.raw", place("in/deep/inside.raw")).unwrap();
    symlink(place("in"), place("way")).unwrap();
    for data in ["a.raw", "deep/inside.raw"] {
        for header in headers("in", "good", data) {
            good(&header);
            good(&place("way").join(header.file_name().unwrap()));
        }
    }
    // A header that is a link: the data file lies beside it, beside the header itself, or is a link as well.
    for header in headers("in", "linked", "a.raw") {
        let name = header.file_name().unwrap();
        let link = place("other").join(name);
        symlink(&header, &link).unwrap();
        good(&link);
        std::fs::write(place("other/a.raw"), DATA).unwrap();
        std::fs::rename(place("in/a.raw"), place("in/hidden.raw")).unwrap();
        good(&link);
        std::fs::remove_file(place("other/a.raw")).unwrap();
        std::fs::rename(place("in/hidden.raw"), place("in/a.raw")).unwrap();
        symlink(place("in/a.raw"), place("other/a.raw")).unwrap();
        good(&link);
        std::fs::remove_file(place("other/a.raw")).unwrap();
        symlink(place("out/secret.raw"), place("other/a.raw")).unwrap();
        assert!(open_volume(&link).is_err());
        std::fs::remove_file(place("other/a.raw")).unwrap();
    }
    // A missing file is named as in the header.
    symlink("nowhere.raw", place("in/dangling.raw")).unwrap();
    for data in ["none.raw", "dangling.raw"] {
        for header in headers("in", "missing", data) {
            let error = open_volume(&header).unwrap_err();
            let is_it = |path: &std::path::Path| path == place("in").join(data);
            assert!(matches!(&error, Error::File { path, .. } if is_it(path)), "{error}");
            assert!(
                matches!(error.cause(), Error::Io(cause) if cause.kind() == std::io::ErrorKind::NotFound)
            );
        }
    }
}

#[test]
fn files_become_solids() {
    let control = Control::default();
    let turned = "space directions: (0,2,0) (-3,0,0) (0,0,-1)\nspace origin: (1,2,3)\n";
    for (fields, volume) in [("", 1.0), (turned, 6.0)] {
        let file = read(&nrrd(fields));
        // Voxels 7 to 12.
        let solid = file.solid(Some(Band::at_least(6.5).unwrap()), &control).unwrap();
        let bounds = solid.bounds().unwrap();
        let frame = Frame::aligned(bounds.min, bounds.max, 7).unwrap();
        let found = measure(&solid, &frame, 1e-3, &control).unwrap();
        assert!(found.volume.contains(6.0 * volume) && found.volume.width() < 1e-2, "{found:?}");
        // Half of the range, which no sample reaches.
        let none = file.solid(None, &control).unwrap();
        assert_eq!(build(&none, &frame, Rule::Outer, &control).unwrap().statistics().volume().upper, 0.0);
    }
}

#[test]
fn what_is_refused() {
    use VolumeFileError::*;
    let line = |bytes: &[u8]| match refused(bytes) {
        Syntax { line, .. } => line,
        other => panic!("{other}"),
    };
    assert_eq!(refused(b""), Empty);
    for bytes in [&b"NRRD"[..], b"\0\0\0\0", b"P5 2 2 255\n", b"ObjectType = Image\n", b"solid a\n"] {
        assert_eq!(refused(bytes), UnknownFormat);
    }
    assert_eq!(line(b"NRRD0006\ntype: uchar\n"), 1);
    for (field, wrong) in [
        ("sizes: 2 3 2", "sizes: 2 3"),
        ("sizes: 2 3 2", "sizes: 2 3 2 1"),
        ("sizes: 2 3 2", "sizes: 2 -3 2"),
        ("sizes: 2 3 2", "sizes: 0 3 2"),
        ("sizes: 2 3 2", "sizes: 2 3 1048577"),
        ("sizes: 2 3 2", "sizes: 2 3 99999999999999999999999"),
        ("type: uchar", "type: block"),
        ("encoding: raw", "encoding: rar"),
        ("dimension: 3", "dimension: 0"),
        ("dimension: 3", "dimension: 17"),
        ("dimension: 3", "dimension: 3\ndimension: 3"),
        ("dimension: 3", "dimension 3"),
        ("dimension: 3", "dimension: 3\nvoxels: many"),
        ("dimension: 3", "dimension: 3\nspacings: 1 nan 1"),
        ("dimension: 3", "dimension: 3\nspacings: 1 1"),
        ("dimension: 3", "dimension: 3\nspace: scanner-xyz-time"),
        ("dimension: 3", "dimension: 3\nspace dimension: 2"),
        ("dimension: 3", "dimension: 3\nspace directions: (1,0) (0,1)"),
        ("dimension: 3", "dimension: 3\nspace directions: (1,0,0) (0,1,0) none"),
        ("dimension: 3", "dimension: 3\nspace directions: (1,0,0) (0,1,0) (0,0,nan)"),
        ("dimension: 3", "dimension: 3\nbyte skip: -2"),
        ("dimension: 3", "dimension: 3\ndata file: "),
        ("dimension: 3", "dimension: 3\nspacings: -1 1 1"),
        ("dimension: 3", "dimension: 3\nspacings: 1 1 inf"),
        ("dimension: 3", "dimension: 3\naxis mins: 0 -inf 0"),
        ("dimension: 3", "dimension: 3\nthicknesses: 1 thin 1"),
        ("dimension: 3", "dimension: 3\nendian: middle"),
        ("encoding: raw", "encoding: ascii\nendian: middle"),
        ("dimension: 3", "dimension: 3\nspace: here-there-everywhere"),
        ("dimension: 3", "dimension: 3\nspace: scanner-xyz\nspace: scanner-xyz"),
        ("dimension: 3", "dimension: 3\nspace dimension: 3\nspace dimension: 3"),
        ("dimension: 3", "dimension: 3\nkinds: domain domain banana"),
        ("dimension: 3", "dimension: 3\nkinds: domain domain"),
        ("dimension: 3", "dimension: 3\ncenters: cell cell middle"),
        ("dimension: 3", "dimension: 3\nspace origin: (1,2,3)"),
        ("dimension: 3", "dimension: 3\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nspacings: 2 2 2"),
        ("dimension: 3", "dimension: 3\nspace directions: (1,0,0) (0,1,0) (0,0,1)\naxis mins: 0 nan nan"),
        (
            "dimension: 3",
            "dimension: 3\nspace directions: (1,0,0) (0,1,0) (0,0,1)\ncenters: cell cell middle",
        ),
    ] {
        let text = String::from_utf8(nrrd("")).unwrap().replace(field, wrong);
        assert!(line(text.as_bytes()) > 1, "{wrong}");
    }
    for (field, what) in
        [("type: uchar\n", "type"), ("sizes: 2 3 2\n", "sizes"), ("encoding: raw\n", "encoding")]
    {
        let text = String::from_utf8(nrrd("")).unwrap().replace(field, "");
        assert_eq!(refused(text.as_bytes()), Missing { what });
    }
    let short = String::from_utf8(nrrd("")).unwrap().replace("uchar", "short");
    assert_eq!(refused(short.as_bytes()), Missing { what: "endian" });
    for encoding in ["bzip2", "hex", "zrl"] {
        let text = String::from_utf8(nrrd("")).unwrap().replace("raw", encoding);
        assert!(matches!(refused(text.as_bytes()), Unsupported { .. }));
    }
    assert!(matches!(refused(&nrrd("data file: LIST\n")), Unsupported { .. }));
    assert!(matches!(refused(&nrrd("data file: a%03d.raw 1 9 1\n")), Unsupported { .. }));
    for place in
        ["spacings: 1 0 1\n", "spacings: 1 1 1e-300\n", "space directions: (1,0,0) (2,0,0) (0,0,1)\n"]
    {
        assert_eq!(refused(&nrrd(place)), Place, "{place}");
    }
    for place in [
        "space directions: (1,0,0) (0,0,0) (0,0,1)\n",
        "axis mins: 0 1 2\naxis maxs: 1 1 3\n",
        // Three times the first, rounded.
        "space directions: (0.1,0.2,0.7) (0.30000000000000004,0.6000000000000001,2.0999999999999996) (0,0,1)\n",
    ] {
        assert_eq!(refused(&nrrd(place)), Place, "{place}");
    }
    for place in [
        "ElementSpacing = 1 0 1\n",
        "ElementSize = 1 0 1\n",
        "TransformMatrix = 0 0 0 0 0 0 0 0 0\n",
        "TransformMatrix = 1 0 0 1 1e-15 0 0 0 1\n",
    ] {
        assert_eq!(refused(&meta(place)), Place, "{place}");
    }
    // Colours in a plane are no volume.
    let several = Unsupported { what: "samples of several numbers" };
    for kind in ["RGB-color", "rgbcolor", "vector", "complex", "list"] {
        assert_eq!(refused(&nrrd(&format!("kinds: {kind} domain space\n"))), several, "{kind}");
    }
    for kinds in ["domain Space time", "none ??? domain"] {
        assert_eq!(values(&read(&nrrd(&format!("kinds: {kinds}\n"))))[11], 12.0);
    }
    for space in ["RAS", "left-posterior-superior", "3D-right-handed", "ScannerXYZ"] {
        assert_eq!(values(&read(&nrrd(&format!("space: {space}\n"))))[11], 12.0);
    }
    // Axes with directions may state that they have no spacings.
    let nans = "space directions: (1,0,0) (0,1,0) (0,0,1)\nspacings: nan nan nan\n";
    assert_eq!(lies(&nrrd(nans)), ([-0.5; 3], [1.0; 3], None));
    for (field, wrong) in [
        ("NDims = 3", "NDims = 0"),
        ("NDims = 3", "NDims = 3\nnonsense"),
        ("DimSize = 2 3 2", "DimSize = 2 3"),
        ("MET_UCHAR", "MET_UCHAR_ARRAY"),
        ("ObjectType = Image", "ObjectType = Tube"),
        ("NDims = 3", "NDims = 3\nElementNumberOfChannels = 3"),
        ("NDims = 3", "NDims = 3\nCompressedData = perhaps"),
        ("NDims = 3", "NDims = 3\nElementSpacing = 1 nan 1"),
        ("NDims = 3", "NDims = 3\nTransformMatrix = 1 0 0 1"),
        ("NDims = 3", "NDims = 3\nHeaderSize = -3"),
        ("NDims = 3", "NDims = 3\nElementSpacing = -1 1 1"),
        ("NDims = 3", "NDims = 3\nElementSpacing = 1 inf 1"),
        ("NDims = 3", "NDims = 3\nElementSize = 1 -1 1"),
        ("NDims = 3", "NDims = 3\nElementSpacing = 1 1 1\nElementSize = 1 one 1"),
        ("NDims = 3", "NDims = 3\nOffset = 0 0 nan"),
        ("NDims = 3", "NDims = 3\nTransformMatrix = 1 0 0 0 1 0 0 0 inf"),
        ("NDims = 3", "NDims = 3\nBinaryDataByteOrderMSB = tomato"),
        ("NDims = 3", "NDims = 3\nElementByteOrderMSB = "),
        ("NDims = 3", "NDims = 3\nBinaryData = fish"),
        ("NDims = 3", "NDims = 3\nCompressedData = 10"),
        ("NDims = 3", "NDims = 3\nBinaryData = False\nCompressedData = True"),
    ] {
        let text = String::from_utf8(meta("")).unwrap().replace(field, wrong);
        assert!(line(text.as_bytes()) > 0, "{wrong}");
    }
    assert_eq!(refused(&nrrd("")[..NRRD.len() + 12]), Length { expected: 12, found: 11 });
    assert_eq!(refused(&[nrrd(""), vec![1]].concat()), Length { expected: 12, found: 13 });
    let text = NRRD.replace("raw", "ascii") + "\n1 2 3 4 5 6 7 8 9 10 11 256";
    assert_eq!(refused(text.as_bytes()), Sample { index: 11 });
    let text = NRRD.replace("raw", "ascii") + "\n1 2 3 4 5 6 7 8 9 10 11 12 13";
    assert_eq!(refused(text.as_bytes()), Sample { index: 12 });
}

/// Headers that announce more than the file contains, or more than memory holds.
#[test]
fn bombs() {
    for encoding in ["raw", "gzip", "ascii"] {
        for sizes in ["1048576 1048576 1048576", "1048576 1048576 1", "100 100 100"] {
            let header = format!(
                "NRRD0004\ntype: double\ndimension: 3\nsizes: {sizes}\nendian: big\nencoding: {encoding}\n\n"
            );
            let bytes = [header.as_bytes(), b"\x1F\x8B\x08\0\0\0\0\0\0\0\0\0\0"].concat();
            assert!(matches!(refused(&bytes), VolumeFileError::Length { .. }), "{encoding} {sizes}");
        }
    }
    let header = NRRD.to_string() + "byte skip: 18446744073709551615\n\n";
    let result = read_volume(&[header.as_bytes(), DATA].concat(), None);
    assert!(matches!(result, Err(Error::OutOfMemory | Error::VolumeFile(_))), "{result:?}");
    let header = NRRD.to_string() + "line skip: 18446744073709551615\n\n";
    assert!(matches!(refused(&[header.as_bytes(), DATA].concat()), VolumeFileError::Missing { .. }));
    // The compressed data are longer than stated.
    let zlib = miniz_oxide::deflate::compress_to_vec_zlib(&[7; 1000], 9);
    let header = META.to_string() + "CompressedData = True\nElementDataFile = LOCAL\n";
    let error = refused(&[header.as_bytes(), &zlib].concat());
    assert!(matches!(error, VolumeFileError::Damaged { .. }), "{error}");
}

/// A file cut at every length, and with every byte changed, gives a clear error and no panic.
#[test]
fn damaged_files() {
    let mut random = Random(32);
    for seed in fuzz::volumes::seeds() {
        for length in 0..seed.len() {
            fuzz::volumes::volumes(&seed[..length]);
            let mut changed = seed.clone();
            changed[length] = [0, b' ', b'9', b'\n', 0xFF, random.bits() as u8][random.below(6) as usize];
            fuzz::volumes::volumes(&changed);
        }
    }
}

/// Mutates seeds as a fuzzer does: leaves pieces out, repeats them, takes them from another file, and changes
/// bytes.
fn mutated(random: &mut Random, seeds: &[Vec<u8>]) -> Vec<u8> {
    let pick = |random: &mut Random| &seeds[random.below(seeds.len() as u64) as usize];
    let mut bytes = pick(random).clone();
    for _ in 0..1 + random.below(4) {
        let [from, to] = [0; 2].map(|_| random.below(bytes.len() as u64 + 1) as usize);
        let range = from.min(to)..from.max(to).min(from.min(to) + 12);
        match random.below(5) {
            0 => drop(bytes.drain(range)),
            1 => {
                let piece = bytes[range].to_vec();
                bytes.splice(to..to, piece);
            }
            2 => {
                let other = pick(random);
                let at = random.below(other.len() as u64) as usize;
                let piece = other[at..other.len().min(at + 30)].to_vec();
                bytes.splice(range, piece);
            }
            3 => bytes.iter_mut().skip(from).take(1).for_each(|byte| *byte ^= 1 << random.below(8)),
            _ => {
                let digit = b"0123456789-.e \n:="[random.below(17) as usize];
                bytes.splice(from..from, [digit]);
            }
        }
    }
    bytes
}

#[test]
fn mutated_files() {
    let (mut random, seeds) = (Random(33), fuzz::volumes::seeds());
    (0..4000).for_each(|_| fuzz::volumes::volumes(&mutated(&mut random, &seeds)));
}

#[test]
#[ignore = "takes a minute"]
fn a_million_mutated_files() {
    let (mut random, seeds) = (Random(34), fuzz::volumes::seeds());
    (0..1_000_000).for_each(|_| fuzz::volumes::volumes(&mutated(&mut random, &seeds)));
}

#[test]
fn seeds_of_the_fuzzer() {
    let seeds = fuzz::volumes::seeds();
    seeds.iter().for_each(|seed| fuzz::volumes::volumes(seed));
    let whole = seeds.iter().filter(|seed| read_volume(seed, None).is_ok()).count();
    assert_eq!(whole, 10);
}

#[test]
fn what_the_fuzzer_found_interesting() {
    let corpus = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus/volumes");
    let mut count = 0;
    for entry in std::fs::read_dir(&corpus).unwrap() {
        fuzz::volumes::volumes(&std::fs::read(entry.unwrap().path()).unwrap());
        count += 1;
    }
    assert!(count > 100, "{count} inputs");
}

#[test]
#[ignore = "writes the seeds for the fuzzer"]
fn write_seeds() {
    let folder = std::env::var_os("LEAFLESS_SEEDS").expect("LEAFLESS_SEEDS names a folder");
    let folder = std::path::Path::new(&folder).join("volumes");
    std::fs::create_dir_all(&folder).unwrap();
    for (k, seed) in fuzz::volumes::seeds().iter().enumerate() {
        std::fs::write(folder.join(format!("{k}")), seed).unwrap();
    }
}

/// Files that ITK 5 and pynrrd 1.1 write for samples x + 10 y + 100 z, and the placement that they state.
#[test]
fn files_of_other_programs() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files/foreign");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap();
        if !["nrrd", "nhdr", "mha", "mhd"].iter().any(|end| name.ends_with(end)) {
            continue;
        }
        let file = open_volume(&path).unwrap_or_else(|error| panic!("{error}"));
        let wraps = matches!(file.kind, SampleKind::U8);
        let found = values(&file);
        assert_eq!((file.grid.extents(), file.rounded), ([5, 4, 3], 0), "{name}");
        for (i, found) in (0..60).zip(found) {
            let [x, y, z] = [i % 5, i / 5 % 4, i / 20];
            let value = x + 10 * y + 100 * z;
            assert_eq!(found, f64::from(if wraps { value % 256 } else { value }), "{name}");
            let own = file.grid.centre([x as u32, y as u32, z as u32]);
            let at = file.placement.map_or(own, |map| map.apply(own));
            let [x, y, z] = [0.5 * f64::from(x), 0.25 * f64::from(y), 2.0 * f64::from(z)];
            let expected = match name {
                _ if name.contains("turned") => [1.0 - y, x - 2.0, 3.5 - z],
                "pynrrd-spacings.nrrd" => [x, y, z],
                _ => [1.0 + x, y - 2.0, 3.5 + z],
            };
            assert_eq!(at, expected, "{name}");
        }
        let has_unit = name.starts_with("pynrrd") && !name.contains("spacings");
        assert_eq!(file.unit, has_unit.then_some(LengthUnit::Millimetre), "{name}");
        count += 1;
    }
    assert_eq!(count, 25);
}

/// Endless devices are read no further than a gigabyte.
#[test]
#[cfg(target_os = "linux")]
fn devices_without_an_end_are_refused() {
    let cause = |error: Error| error.cause().to_string();
    let limit = "the limit of 1073741824 bytes was reached";
    assert_eq!(open_volume("/dev/zero").map(|_| ()).map_err(cause), Err(limit.into()));
    let options = MeshOptions::default();
    assert_eq!(open_mesh("/dev/zero", &options).map(|_| ()).map_err(cause), Err(limit.into()));
}
