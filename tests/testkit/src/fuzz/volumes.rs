//! Any bytes as a volume's file. The readers do not panic, allocate no more than they report, and each volume
//! read can be written, read again and built.

use leafless::exchange::{
    NrrdEncoding, RawVolume, SampleKind, VolumeFile, read_raw_volume, read_volume, volume_data_file,
    write_nrrd, write_raw_volume,
};
use leafless::solid::{Band, Samples, VoxelGrid};
use leafless::{Control, Frame, Rule, Solid, Volume, build};

/// Reads `data` as a file; as a header, up to the first zero byte, and the file of its samples; and as an
/// array of small extents.
pub fn volumes(data: &[u8]) {
    read(data, None);
    let zero = data.iter().position(|&byte| byte == 0).unwrap_or(data.len());
    let (header, rest) = data.split_at(zero);
    if let Ok(Some(name)) = volume_data_file(header) {
        assert!(header.windows(name.len()).any(|window| window == name.as_bytes()));
    }
    read(header, Some(rest.get(1..).unwrap_or(&[])));
    raw(data);
}

fn raw(data: &[u8]) {
    const KINDS: [SampleKind; 11] = [
        SampleKind::Bit,
        SampleKind::I8,
        SampleKind::U8,
        SampleKind::I16,
        SampleKind::U16,
        SampleKind::I32,
        SampleKind::U32,
        SampleKind::I64,
        SampleKind::U64,
        SampleKind::F32,
        SampleKind::F64,
    ];
    let [kind, x, y, z, skip, rest @ ..] = data else { return };
    let extents = [x, y, z].map(|&extent| 1 + u32::from(extent) % 80);
    let Ok(grid) = VoxelGrid::new(extents, [0.0; 3], [1.0; 3]) else { return };
    let kind = KINDS[usize::from(*kind) % KINDS.len()];
    let layout = RawVolume { grid, kind, big_endian: !x.is_multiple_of(2), skip: u64::from(skip % 8) };
    if let Ok((samples, _)) = read_raw_volume(rest, &layout) {
        check(&samples, &grid);
    }
}

fn read(bytes: &[u8], data: Option<&[u8]>) {
    let Ok(VolumeFile { samples, grid, .. }) = read_volume(bytes, data) else { return };
    let length = (bytes.len() + data.map_or(0, <[u8]>::len)) as u64;
    assert!(grid.count() <= 1032 * length);
    // Long volumes are only read.
    if grid.count() < 1 << 16 {
        check(&samples, &grid);
    }
}

/// Checks that the volume behaves like any other.
fn check(samples: &Samples<'static>, grid: &VoxelGrid) {
    let raw = write_raw_volume(samples, grid).unwrap();
    let encoding = if raw.len().is_multiple_of(2) { NrrdEncoding::Raw } else { NrrdEncoding::Gzip };
    let again = read_volume(&write_nrrd(samples, grid, encoding).unwrap(), None).unwrap();
    assert_eq!(write_raw_volume(&again.samples, &again.grid).unwrap(), raw);
    assert_eq!(again.grid.extents(), grid.extents());
    let middle = raw.get(raw.len() / 2).copied().unwrap_or(0);
    let control = Control::threads(1);
    let band = Band::at_least(f64::from(middle)).unwrap();
    let volume = Volume::new(samples.clone(), grid, band, &control).unwrap();
    let bounds = volume.bounds().unwrap();
    let own = grid.frame().ok().and_then(|frame| frame.with_depth(frame.depth().min(7)).ok());
    let other = Frame::around(bounds.min, bounds.max, 3).ok();
    for frame in [own, other].into_iter().flatten() {
        let tree = build(&volume, &frame, Rule::Certified, &control).unwrap();
        tree.view().check().unwrap();
    }
}

/// Small files of all kinds.
pub fn seeds() -> Vec<Vec<u8>> {
    let grid = VoxelGrid::with_first_sample([5, 4, 3], [1.0, -2.0, 0.5], [0.5; 3]).unwrap();
    let bytes: Vec<u8> = (0..60).map(|i| (i * 37 % 251) as u8).collect();
    let shorts: Vec<i16> = bytes.iter().map(|&b| (300 * i32::from(b) - 3000) as i16).collect();
    let singles: Vec<f32> = bytes.iter().map(|&b| f32::from(b) / 16.0).collect();
    let mut seeds = Vec::new();
    for samples in [Samples::from(bytes.clone()), shorts.into(), singles.into()] {
        for encoding in [NrrdEncoding::Raw, NrrdEncoding::Gzip] {
            seeds.push(write_nrrd(&samples, &grid, encoding).unwrap());
        }
    }
    let text = bytes.iter().map(u8::to_string).collect::<Vec<_>>().join(" ");
    let zlib = miniz_oxide::deflate::compress_to_vec_zlib(&bytes, 6);
    let nrrd = "NRRD0005\n# made by hand\ntype: unsigned short\ndimension: 4\nsizes: 1 5 2 3\nspacings: nan 1 2 3\n\
        axis mins: nan 0 1 -1e1\ncenters: none cell node cell\nkinds: vector domain domain domain\nkey:=value\n\
        endian: big\nunits: \"\" \"mm\" \"mm\" \"mm\"\nbyte skip: -1\nencoding: raw\n\n";
    let meta = "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nOffset = 1 2 3\n\
        TransformMatrix = 0 1 0 1 0 0 0 0 -1\nElementSpacing = 0.5 0.5 2\nDimSize = 5 4 3\n";
    let ascii = "NRRD0001\ntype: uchar\ndimension: 3\nsizes: 5 4 3\nencoding: ascii\n\n";
    let detached = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 5 4 3\nspace: right-anterior-superior\n\
        space directions: (0,1,0) (1,0,0) (0,0,-2)\nspace origin: (1,2,3)\nline skip: 1\nencoding: raw\ndata file: a.raw\n";
    let of = |parts: &[&[u8]]| parts.concat();
    seeds.push(of(&[nrrd.as_bytes(), &bytes]));
    seeds.push(of(&[ascii.as_bytes(), text.as_bytes()]));
    seeds.push(of(&[detached.as_bytes(), b"\0a line\n", &bytes]));
    seeds.push(of(&[meta.as_bytes(), b"ElementType = MET_UCHAR\nElementDataFile = LOCAL\n", &bytes]));
    let compressed = format!(
        "CompressedData = True\nCompressedDataSize = {}\nElementType = MET_CHAR\nElementDataFile = LOCAL\n",
        zlib.len()
    );
    seeds.push(of(&[meta.as_bytes(), compressed.as_bytes(), &zlib]));
    let there = "HeaderSize = 2\nElementType = MET_UCHAR\nElementDataFile = a.zraw\n";
    seeds.push(of(&[meta.as_bytes(), there.as_bytes(), b"\0xy", &bytes]));
    seeds.push([&[10, 4, 3, 2, 0][..], &[0; 5 * 4 * 3 * 8]].concat());
    seeds.push([&[0, 4, 3, 2, 0][..], &[0xA5; 12]].concat());
    seeds
}
