//! The file format from outside: files round-trip, damaged files are refused, and a file on disk is always
//! either the old one or the new one.

#![cfg(feature = "std")]

use leafless::error::FormatError;
use leafless::lattice::Cube;
use leafless::octree::Cursor;
use leafless::query::{PointCursor, PointTable};
use leafless::{
    Control, Csg, Error, Frame, Metadata, Octree, OctreeRef, Rule, Tag, Verdict, build, compact, complement,
    difference, file, intersection, union, xor,
};
use leafless_testkit::Aligned;
use leafless_testkit::cubes::Cubes;
use std::path::Path;

// ---- trees ----------------------------------------------------------------------------------------------

fn mix(mut x: u64) -> u64 {
    x = (x ^ x >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    x = (x ^ x >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
    x ^ x >> 31
}

/// A different tree for every seed, with coarse and fine cells of every tag.
#[derive(Clone)]
struct Noise(u64);

impl Cubes for Noise {
    fn verdict(&self, cube: &Cube<'_>) -> Result<Verdict<()>, Error> {
        let cell = cube.cell;
        if cell.level == 0 {
            return Ok(Verdict::Partial(()));
        }
        let hash = cell.at.iter().fold(mix(self.0 + cell.level as u64), |hash, &a| mix(hash ^ a as u64));
        let split = if cell.level < 3 { 170 } else { 45 };
        Ok(match hash % 256 {
            die if die < split => Verdict::Partial(()),
            die => [Verdict::Empty, Verdict::Full, Verdict::Undecided][(die % 3) as usize],
        })
    }
}

/// 64³ bricks of 25 000 kinds in every block of 2^16: too many for one dictionary, few enough for several.
#[derive(Clone)]
struct ManyBricks;

impl Cubes for ManyBricks {
    fn verdict(&self, cube: &Cube<'_>) -> Result<Verdict<()>, Error> {
        let cell = cube.cell;
        if cell.level < 8 {
            return Ok(Verdict::Partial(()));
        }
        let morton = |at: [u32; 3], bits: u32| {
            (0..3 * bits).fold(0u64, |m, i| m | (at[i as usize % 3] as u64 >> (i / 3) & 1) << i)
        };
        let brick = morton(cell.at.map(|a| a >> 2), 6);
        let bit = morton(cell.at.map(|a| a & 3), 2);
        let value = mix((brick >> 16) * 100_000 + brick % 25_000);
        Ok(if value >> bit & 1 != 0 { Verdict::Full } else { Verdict::Empty })
    }
}

leafless_testkit::solid_of_cubes!(Noise, ManyBricks);

fn frame(depth: u8) -> Frame {
    Frame::new([0.1, -2.5, 1e3], 3.3, depth).unwrap()
}

fn noise(depth: u8, seed: u64, rule: Rule) -> Octree {
    build(&Noise(seed), &frame(depth), rule, &Control::threads(1)).unwrap()
}

fn facts() -> Metadata {
    let mut metadata = Metadata::new();
    metadata.insert("units", "mm");
    metadata.insert("name", "Flansch Ø 120");
    metadata
}

fn many_bricks() -> Octree {
    build(&ManyBricks, &frame(8), Rule::Certified, &Control::threads(1)).unwrap()
}

fn dictionary_coded() -> Octree {
    let ball = Csg::ball([1.7, -0.9, 1001.6], 1.5).unwrap();
    build(&ball, &frame(7), Rule::Certified, &Control::threads(1)).unwrap()
}

/// Trees of every shape of file.
fn trees() -> Vec<Octree> {
    let mut trees = vec![];
    for depth in 1..=9 {
        for tag in [Tag::Empty, Tag::Full, Tag::Partial] {
            trees.push(Octree::uniform(frame(depth), tag, Tag::Full).unwrap());
        }
        for seed in 0..4 {
            trees.push(noise(depth, seed, Rule::Certified));
            trees.push(noise(depth, seed, Rule::Inner).with_metadata(facts()));
        }
    }
    trees.push(Octree::uniform(frame(20), Tag::Full, Tag::Empty).unwrap());
    trees.push(dictionary_coded());
    trees.push(many_bricks());
    trees
}

/// A small file with elements, two-plane bricks and metadata.
fn small() -> Octree {
    let tree = noise(4, 7, Rule::Certified).with_metadata(facts());
    assert!(!tree.view().is_binary() && tree.view().element_count() > 0 && tree.view().brick_count() > 1);
    tree
}

/// Small files of different structure: elements on one and on two levels, one and two planes, a dictionary.
fn small_files() -> Vec<Vec<u8>> {
    // Faces away from the bricks' own: many bricks, of few kinds.
    let cuboid = leafless::Csg::cuboid([2.0; 3], [29.0; 3]).unwrap();
    let frame = Frame::new([0.0; 3], 32.0, 5).unwrap();
    let cuboid = build(&cuboid, &frame, Rule::Sampled, &Control::threads(1)).unwrap();
    let trees = [small(), noise(3, 1, Rule::Inner), noise(2, 1, Rule::Certified), cuboid];
    let files = trees.map(|tree| file::to_bytes(&tree).unwrap());
    assert!(file::probe_bytes(&files[3]).unwrap().sections.iter().any(|s| s.name == Some("brick indices")));
    files.into()
}

// ---- bytes ----------------------------------------------------------------------------------------------

fn number(bytes: &[u8], at: usize, length: usize) -> u64 {
    let mut raw = [0; 8];
    raw[..length].copy_from_slice(&bytes[at..at + length]);
    u64::from_le_bytes(raw)
}

/// Length of an entry of the section table, in bytes.
const ENTRY: usize = 48;

/// Returns the offset of the solid's record and the header fields that the record repeats, as (offset, offset
/// in the record, length).
fn mirrored(bytes: &[u8]) -> (usize, [(usize, usize, usize); 8]) {
    let start = number(bytes, 128 + 16, 8) as usize;
    (
        start,
        [
            (64, 12, 3),
            (70, 15, 1),
            (67, 16, 3),
            (104, 24, 8),
            (32, 32, 32),
            (72, 80, 8),
            (80, 88, 8),
            (88, 96, 8),
        ],
    )
}

/// Copies the header's fields into the solid's record.
fn mirror(bytes: &mut [u8]) {
    let (start, fields) = mirrored(bytes);
    for (from, to, length) in fields {
        bytes.copy_within(from..from + length, start + to);
    }
}

/// Repairs all checksums, as far as the offset fields allow.
fn seal(bytes: &mut [u8]) {
    let count = number(bytes, 96, 4) as usize;
    for i in 0..count.min(64) {
        let at = 128 + ENTRY * i;
        let Some(entry) = bytes.get(at..at + ENTRY) else { break };
        let (offset, length) = (number(entry, 16, 8), number(entry, 24, 8));
        let section = usize::try_from(offset).ok().zip(usize::try_from(offset.saturating_add(length)).ok());
        if let Some(section) = section.and_then(|(start, end)| bytes.get(start..end)) {
            let crc = crc32fast::hash(section).to_le_bytes();
            bytes[at + 40..at + 44].copy_from_slice(&crc);
        }
    }
    seal_head(bytes);
}

fn seal_head(bytes: &mut [u8]) {
    let end = 128usize.saturating_add((number(bytes, 96, 4) as usize).saturating_mul(ENTRY));
    if let Some(table) = bytes.get(128..end) {
        let crc = crc32fast::hash(table).to_le_bytes();
        bytes[100..104].copy_from_slice(&crc);
    }
    let crc = crc32fast::hash(&bytes[..124]).to_le_bytes();
    bytes[124..128].copy_from_slice(&crc);
}

/// Returns `bytes` after a change, with repaired checksums of header and table, or of all sections.
fn changed(bytes: &[u8], sections_too: bool, change: impl FnOnce(&mut Vec<u8>)) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    change(&mut bytes);
    if sections_too {
        seal(&mut bytes)
    } else {
        seal_head(&mut bytes)
    }
    bytes
}

fn put(bytes: &mut [u8], at: usize, value: u64, length: usize) {
    bytes[at..at + length].copy_from_slice(&value.to_le_bytes()[..length]);
}

#[track_caller]
fn format_error<T>(result: Result<T, Error>) -> FormatError {
    match result {
        Err(error) => match error.cause() {
            Error::Format(error) => *error,
            other => panic!("another error: {other}"),
        },
        Ok(_) => panic!("no error"),
    }
}

/// Runs everything that reads and makes trees on a tree that may be damaged. All calls must return.
fn exercise(tree: &OctreeRef<'_>) {
    read_all(tree);
    let control = Control::threads(1);
    let results = [
        union(tree, tree, &control),
        intersection(tree, tree, &control),
        difference(tree, tree, &control),
        xor(tree, tree, &control),
        complement(tree, &control),
        build(tree, tree.frame(), Rule::Certified, &control),
        compact(tree),
    ];
    for result in results.into_iter().flatten() {
        result.statistics();
    }
}

/// Runs queries and checks on a tree that may be damaged.
fn read_all(tree: &OctreeRef<'_>) {
    let frame = tree.frame();
    let (origin, edge) = (frame.origin(), frame.edge());
    let at = |t: [f64; 3]| [0, 1, 2].map(|axis| origin[axis] + t[axis] * edge);
    let mut points = vec![];
    for x in 0..7 {
        for y in 0..7 {
            for z in 0..7 {
                points.push(at([x, y, z].map(|i| i as f64 / 6.0)));
            }
        }
    }
    let mut answers = vec![leafless::Membership::Inside; points.len()];
    tree.contains_many(&points, &mut answers).unwrap();
    let mut cursor = PointCursor::new(tree);
    for (&point, &answer) in points.iter().zip(&answers) {
        assert_eq!(tree.contains(point), answer);
        assert_eq!(cursor.contains(point), answer);
    }
    for level in [0, 3, 6] {
        // For a damaged tree, a table may decide fewer points, and nothing else may differ.
        let table = PointTable::new(tree, level).unwrap();
        let known = points.iter().map(|&point| table.contains(point));
        known.zip(&answers).for_each(|(known, &answer)| {
            assert!(known == answer || known == leafless::Membership::Undecided)
        });
    }
    for (low, high) in [(0.0, 1.0), (0.3, 0.4), (0.5, 0.5), (-1.0, 2.0), (0.7, 1.5)] {
        tree.classify_box(at([low; 3]), at([high; 3])).unwrap();
    }
    for seed in 0..50 {
        let mut cursor = Cursor::new(tree);
        let mut step = 0;
        while cursor.descend((mix(seed * 100 + step) % 8) as u8) {
            step += 1;
        }
        while cursor.ascend() {
            assert!(cursor.node().is_some());
        }
    }
    let _ = tree.check();
}

fn write(path: &Path, bytes: &[u8]) {
    // Some file systems flush a file to disk if it is truncated and written again.
    let _ = std::fs::remove_file(path);
    std::fs::write(path, bytes).unwrap();
}

// ---- round trips ----------------------------------------------------------------------------------------

#[test]
fn every_way_in_gives_the_tree_back() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("tree.lfl");
    for tree in trees() {
        let bytes = file::to_bytes(&tree).unwrap();
        let mut written = vec![];
        file::write_to(&tree, &mut written).unwrap();
        assert_eq!(written, bytes);
        file::save(&tree, &path).unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), bytes);

        let same = |back: &Octree| {
            assert_eq!(back, &tree);
            assert_eq!(back.metadata(), tree.metadata());
            assert_eq!(back.statistics(), tree.statistics());
            back.view().check().unwrap();
            // However its bricks are coded and wherever they lie, the tree is written as the same file.
            assert_eq!(file::to_bytes(back).unwrap(), bytes);
        };
        same(&file::from_bytes(&bytes).unwrap());
        same(&file::open(&path).unwrap());
        #[cfg(feature = "mmap")]
        {
            // SAFETY: no other process uses the file.
            same(&unsafe { file::map(&path) }.unwrap());
            same(&unsafe { file::map_verified(&path) }.unwrap());
        }
        same(&compact(tree.view()).unwrap().with_metadata(tree.metadata().clone()));

        let aligned = Aligned::new(&bytes);
        let view = file::view(aligned.bytes()).unwrap();
        same(&compact(&view).unwrap().with_metadata(tree.metadata().clone()));
        file::verify(aligned.bytes()).unwrap();
        file::verify_path(&path).unwrap();
        // Bytes with the program's lifetime need no copy.
        same(&file::from_static(Box::leak(Box::new(Aligned::new(&bytes))).bytes()).unwrap());

        let probe = file::probe(&path).unwrap();
        assert_eq!(probe, file::probe_bytes(&bytes).unwrap());
        assert_eq!(probe, file::probe_from(&bytes[..]).unwrap());
        assert_eq!(probe.version, (0, 1));
        assert_eq!(&probe.frame, tree.frame());
        assert_eq!((probe.root, probe.exterior), (tree.view().root_tag(), tree.view().exterior()));
        assert_eq!(probe.binary, tree.view().is_binary());
        assert_eq!(probe.elements, tree.view().element_count());
        assert_eq!(probe.bricks, tree.view().brick_count());
        assert_eq!(probe.file_len, bytes.len() as u64);
        let last = probe.sections.last().unwrap();
        assert_eq!(last.offset + last.length, bytes.len() as u64);
    }
}

#[test]
fn bricks_are_coded_as_the_rule_says() {
    let names = |tree: &Octree| -> Vec<&str> {
        let probe = file::probe_bytes(&file::to_bytes(tree).unwrap()).unwrap();
        probe.sections.iter().map(|section| section.name.unwrap()).collect()
    };
    let elements = ["objects", "level table", "planes", "rel", "base"];
    let coded = ["brick indices", "dictionary entries", "dictionary segments"];
    assert_eq!(names(&noise(2, 1, Rule::Inner)), ["objects", "level table", "bricks"]);
    let with_metadata = [&elements[..1], &["metadata"], &elements[1..], &["bricks"]].concat();
    assert_eq!(names(&small()), with_metadata);
    assert_eq!(names(&dictionary_coded()), [&elements[..], &coded].concat());
    let many = file::to_bytes(&many_bricks()).unwrap();
    let sections = file::probe_bytes(&many).unwrap().sections;
    // Two halves of 50 000 distinct bricks each: the largest segments for which this works.
    assert_eq!((many[68], many[69], sections[7].count), (1, 17, 2));
    assert_eq!(names(&Octree::uniform(frame(3), Tag::Full, Tag::Full).unwrap()), ["objects", "level table"]);
}

/// The numbers in a file are at their documented places. A change of this test is a change of the format.
#[test]
fn a_file_byte_by_byte() {
    // The lower x half of the universe, at depth 1: one brick.
    let half = leafless::Csg::cuboid([0.0; 3], [1.0, 2.0, 2.0]).unwrap();
    let frame = Frame::new([0.0; 3], 2.0, 1).unwrap();
    let tree = build(&half, &frame, Rule::Outer, &Control::threads(1)).unwrap();
    let tree = tree.with_proof(tree.proof().with_displacement(0.25).unwrap());
    let mut metadata = Metadata::new();
    metadata.insert("k", "v");
    let bytes = file::to_bytes(&tree.with_metadata(metadata)).unwrap();
    let mut expected = vec![0; 576 + 8];
    expected[..8].copy_from_slice(b"\x89LFL\r\n\x1a\n");
    put(&mut expected, 10, 1, 2);
    put(&mut expected, 12, 128, 4);
    put(&mut expected, 24, 584, 8);
    put(&mut expected, 56, 2f64.to_bits(), 8);
    expected[64..71].copy_from_slice(&[1, 1, 0, 1, 0, 0, 2]);
    put(&mut expected, 80, 1, 8);
    put(&mut expected, 96, 4, 4);
    put(&mut expected, 104, 0.25f64.to_bits(), 8);
    for (i, entry) in [
        [1, 0, 16, 1, 320, 128, 1],
        [2, 1, 1, 0, 448, 10, 10],
        [3, 4, 3, 1, 512, 48, 2],
        [7, 4, 1, 1, 576, 8, 1],
    ]
    .iter()
    .enumerate()
    {
        let fields = [(0, 4), (8, 1), (9, 1), (12, 4), (16, 8), (24, 8), (32, 8)];
        for (&value, (at, length)) in entry.iter().zip(fields) {
            put(&mut expected, 128 + ENTRY * i + at, value, length);
        }
    }
    // The object: a solid without a parent, which readers must understand, followed by the header's fields.
    put(&mut expected, 320, 1, 4);
    put(&mut expected, 324, u32::MAX.into(), 4);
    put(&mut expected, 328, 1, 4);
    expected[332..339].copy_from_slice(&[1, 1, 0, 2, 1, 0, 0]);
    put(&mut expected, 320 + 24, 0.25f64.to_bits(), 8);
    put(&mut expected, 320 + 56, 2f64.to_bits(), 8);
    put(&mut expected, 320 + 88, 1, 8);
    expected[448..458].copy_from_slice(b"\x01\0\0\0\x01\0\0\0kv");
    // One node at level 0, four FULL cells at level 1.
    put(&mut expected, 512, 1, 8);
    put(&mut expected, 512 + 24 + 8, 4, 8);
    // Octants 0, 2, 4, 6.
    put(&mut expected, 576, 0x55, 8);
    seal(&mut expected);
    assert_eq!(bytes, expected);
}

#[test]
fn a_copy_needs_no_alignment_but_a_view_does() {
    let tree = small();
    let bytes = file::to_bytes(&tree).unwrap();
    for shift in 1..8 {
        let shifted = Aligned::new(&[&[0u8; 8][..shift], &bytes].concat());
        assert_eq!(file::from_bytes(&shifted.bytes()[shift..]).unwrap(), tree);
        assert_eq!(format_error(file::view(&shifted.bytes()[shift..])), FormatError::Alignment);
        assert_eq!(format_error(file::verify(&shifted.bytes()[shift..])), FormatError::Alignment);
    }
}

#[test]
fn metadata_have_a_limit() {
    let with = |length: usize| {
        let mut metadata = Metadata::new();
        metadata.insert("k", "v".repeat(length - 9));
        small().with_metadata(metadata)
    };
    let largest = with(1 << 20);
    let back = file::from_bytes(&file::to_bytes(&largest).unwrap()).unwrap();
    assert_eq!(back.metadata(), largest.metadata());
    // One more byte in a file shifts everything after it.
    let mut bytes = file::to_bytes(&largest).unwrap();
    let probe = file::probe_bytes(&bytes).unwrap();
    let (entry, at) = (128 + ENTRY, probe.sections[1].offset as usize);
    assert_eq!((probe.sections[1].name, at % 64), (Some("metadata"), 0));
    let end = at + (1 << 20);
    bytes.splice(end..end, [&b"v"[..], &[0; 63]].concat());
    for (at, length) in [(entry + 24, 8), (entry + 32, 8), (at + 4, 4)] {
        let more = number(&bytes, at, length) + 1;
        put(&mut bytes, at, more, length);
    }
    let offsets = (2..probe.sections.len()).map(|i| 128 + ENTRY * i + 16);
    for at in offsets.chain([24]) {
        let further = number(&bytes, at, 8) + 64;
        put(&mut bytes, at, further, 8);
    }
    seal(&mut bytes);
    let length = FormatError::Field { name: "section length", value: (1 << 20) + 1 };
    assert_eq!(format_error(file::from_bytes(&bytes)), length);
    let refused = file::to_bytes(&with((1 << 20) + 1));
    assert!(matches!(refused, Err(Error::Argument { name: "metadata", .. })));
}

// ---- damaged files are refused --------------------------------------------------------------------------

#[test]
fn a_shorter_or_longer_file_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("cut.lfl");
    let bytes = file::to_bytes(&small()).unwrap();
    let head = 128 + ENTRY * file::probe_bytes(&bytes).unwrap().sections.len();
    let aligned = Aligned::new(&[&bytes[..], &[0; 8]].concat());
    for length in (0..bytes.len()).chain([bytes.len() + 1, bytes.len() + 8]) {
        let cut = &aligned.bytes()[..length];
        let is_length = |error| {
            assert!(matches!(error, FormatError::Length { .. }), "{length}: {error}");
        };
        is_length(format_error(file::view(cut)));
        is_length(format_error(file::verify(cut)));
        is_length(format_error(file::from_bytes(cut)));
        write(&path, cut);
        is_length(format_error(file::open(&path)));
        is_length(format_error(file::probe(&path)));
        #[cfg(feature = "mmap")]
        {
            // SAFETY: no other process uses the file.
            is_length(format_error(unsafe { file::map(&path) }));
            is_length(format_error(unsafe { file::map_verified(&path) }));
        }
        // Probing needs only the first bytes.
        assert_eq!(file::probe_bytes(cut).is_ok(), length >= head);
        assert_eq!(file::probe_from(cut).is_ok(), length >= head);
    }
}

#[test]
fn every_flipped_byte_is_found() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("flipped.lfl");
    for bytes in small_files() {
        let mut damaged = Aligned::new(&bytes);
        for at in 0..bytes.len() {
            for flip in [0x01, 0x80, 0xFF] {
                damaged.bytes_mut()[at] ^= flip;
                assert!(file::verify(damaged.bytes()).is_err(), "byte {at}");
                assert!(file::from_bytes(damaged.bytes()).is_err(), "byte {at}");
                write(&path, damaged.bytes());
                assert!(file::open(&path).is_err(), "byte {at}");
                // SAFETY: no other process uses the file.
                #[cfg(feature = "mmap")]
                assert!(unsafe { file::map_verified(&path) }.is_err(), "byte {at}");
                if let Ok(tree) = file::view(damaged.bytes()) {
                    exercise(&tree);
                }
                damaged.bytes_mut()[at] ^= flip;
            }
        }
        file::verify(damaged.bytes()).unwrap();
    }
}

/// Changes as an attacker makes them, with right checksums. An accepted file must be readable without a
/// panic, and anything written from it must be a good file.
#[test]
fn changes_with_right_checksums_never_panic() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("hostile.lfl");
    let mut let_in = [0; 2];
    for (f, bytes) in (0..).zip(small_files()) {
        let mut state = f;
        let mut random = |below: u64| {
            state += 1;
            mix(state) % below
        };
        for round in 0..3000 {
            let mut hostile = Aligned::new(&bytes);
            let all = hostile.bytes_mut();
            for _ in 0..1 + round % 3 {
                // Half of the changes are in header and table. Small numbers are the most dangerous.
                let end = if round % 2 == 0 { 128 + ENTRY * 5 } else { all.len() };
                let at = random(end as u64) as usize;
                all[at] = match random(4) {
                    0 => all[at] ^ 1 << random(8),
                    1 => random(8) as u8,
                    2 => 0xFF,
                    _ => random(256) as u8,
                };
            }
            // In most rounds, the solid's record repeats the changed header.
            if round % 8 != 0 && number(all, 128 + 16, 8) == number(&bytes, 128 + 16, 8) {
                mirror(all);
            }
            seal(all);
            let verdict = file::verify(hostile.bytes());
            let verified = verdict.is_ok();
            assert_eq!(file::from_bytes(hostile.bytes()).is_ok(), verified);
            let Ok(tree) = file::view(hostile.bytes()) else {
                assert!(!verified);
                continue;
            };
            let_in[verified as usize] += 1;
            if tree.frame().depth() <= 6 {
                exercise(&tree);
            }
            write(&path, hostile.bytes());
            // SAFETY: no other process uses the file.
            #[cfg(feature = "mmap")]
            if let Ok(tree) = unsafe { file::map(&path) } {
                tree.statistics();
                // The only part that readers in place never examine, and that writing corrects.
                let padding =
                    matches!(verdict, Err(Error::Format(FormatError::Field { name: "padding", .. })));
                match file::to_bytes(&tree) {
                    Ok(written) => {
                        assert!(verified || padding);
                        file::from_bytes(&written).unwrap();
                    }
                    Err(_) => assert!(!verified),
                }
            }
        }
    }
    assert!(let_in[0] > 1000 && let_in[1] > 100, "{let_in:?}");
}

/// A file of depth 20 in which all 64 elements of a level have the same 64 children. Without a memory of
/// visited elements, its links lead to 64^9 bricks.
fn shared_children() -> Vec<u8> {
    let (elements, bricks) = (1 + 64 * 8, 64);
    let mut bytes = file::to_bytes(&Octree::uniform(frame(20), Tag::Empty, Tag::Empty).unwrap()).unwrap();
    bytes.truncate(128);
    bytes[65] = 1;
    // Kind, element type, components, bytes of an element, count.
    let sections = [
        (1, 0, 16, 128, 1),
        (3, 4, 3, 24, 21),
        (4, 4, 2, 16, elements),
        (5, 2, 1, 2, elements),
        (6, 4, 1, 8, 1),
        (7, 4, 1, 8, bricks),
    ];
    bytes.resize(128 + ENTRY * sections.len(), 0);
    let mut at = [0; 6];
    for (i, &(kind, element, components, size, count)) in sections.iter().enumerate() {
        at[i] = bytes.len().next_multiple_of(64);
        bytes.resize(at[i] + size * count, 0);
        let fields = [
            (0, kind, 4),
            (8, element, 1),
            (9, components, 1),
            (12, 1, 4),
            (16, at[i], 8),
            (24, size * count, 8),
            (32, count, 8),
        ];
        for (field, value, length) in fields {
            put(&mut bytes, 128 + ENTRY * i + field, value as u64, length);
        }
    }
    for (field, value) in [(0, 1), (4, u32::MAX), (8, 1)] {
        put(&mut bytes, at[0] + field, value.into(), 4);
    }
    for n in 0..elements {
        put(&mut bytes, at[2] + 16 * n, !0, 8);
        put(&mut bytes, at[3] + 2 * n, 1 + 64 * (n as u64).div_ceil(64), 2);
    }
    for b in 0..bricks {
        put(&mut bytes, at[5] + 8 * b, 0xF0, 8);
    }
    for level in 0..10 {
        put(&mut bytes, at[1] + 48 * level, if level == 0 { 1 } else { 64 }, 8);
    }
    let length = bytes.len() as u64;
    for (field, value, size) in
        [(24, length, 8), (72, elements as u64, 8), (80, bricks as u64, 8), (96, sections.len() as u64, 4)]
    {
        put(&mut bytes, field, value, size);
    }
    mirror(&mut bytes);
    seal(&mut bytes);
    bytes
}

#[test]
fn shared_children_are_not_visited_again_and_again() {
    let bytes = Aligned::new(&shared_children());
    let tree = file::view(bytes.bytes()).unwrap();
    assert_eq!(tree.element_count() + tree.brick_count(), 577);
    assert!(matches!(file::verify(bytes.bytes()), Err(Error::Damaged(_))));
    read_all(&tree);
    let control = Control::threads(2);
    for result in [
        union(&tree, &tree, &control),
        intersection(&tree, &tree, &control),
        difference(&tree, &tree, &control),
        xor(&tree, &tree, &control),
        complement(&tree, &control),
        build(&tree, tree.frame(), Rule::Inner, &control),
        leafless::op::resolve(&tree, Rule::Outer, &control),
    ] {
        assert!(matches!(result, Err(Error::Damaged(_))));
    }
}

#[test]
fn each_field_is_checked() {
    let bytes = file::to_bytes(&small()).unwrap();
    let coded = small_files().pop().unwrap();
    let view = |bytes: Vec<u8>| {
        let aligned = Aligned::new(&bytes);
        file::view(aligned.bytes()).map(|_| ())
    };
    let field = |bytes: &[u8], at: usize, value: u64, length: usize| {
        format_error(view(changed(bytes, false, |bytes| put(bytes, at, value, length))))
    };
    let name = |bytes: &[u8], at: usize, value: u64, length: usize| match field(bytes, at, value, length) {
        FormatError::Field { name, .. } => name,
        other => panic!("byte {at}: {other}"),
    };
    assert_eq!(field(&bytes, 0, 0x88, 1), FormatError::Magic);
    assert_eq!(field(&bytes, 8, 1, 2), FormatError::Version { major: 1, minor: 1 });
    assert_eq!(field(&bytes, 10, 0, 2), FormatError::Version { major: 0, minor: 0 });
    assert_eq!(field(&bytes, 16, 4, 4), FormatError::Required { name: "flags", value: 4 });
    let length = FormatError::Length { expected: 5000, found: bytes.len() as u64 };
    assert_eq!(field(&bytes, 24, 5000, 8), length);
    let second = 128 + ENTRY;
    for (at, value, length, expected) in [
        (12, 136, 4, "header length"),
        (20, 1, 4, "optional flags"),
        (24, 200, 8, "file length"),
        (32, f64::NAN.to_bits(), 8, "origin"),
        (40, (-0f64).to_bits(), 8, "origin"),
        (48, f64::INFINITY.to_bits(), 8, "origin"),
        (56, (-1f64).to_bits(), 8, "edge"),
        (56, 0, 8, "edge"),
        (64, 0, 1, "depth"),
        (64, 21, 1, "depth"),
        (65, 4, 1, "root tag"),
        (65, 0, 1, "elements"),
        (66, 1, 1, "exterior"),
        (66, 5, 1, "exterior"),
        (67, 0, 1, "planes of a brick"),
        (67, 3, 1, "planes of a brick"),
        (68, 2, 1, "brick encoding"),
        (68, 1, 1, "segment shift"),
        (69, 63, 1, "segment shift"),
        (70, 4, 1, "proof"),
        (71, 1, 1, "reserved field"),
        (88, 1, 8, "dictionary entries"),
        (96, 0, 4, "section count"),
        (96, 4097, 4, "section count"),
        (104, f64::NAN.to_bits(), 8, "displacement"),
        (104, (-0f64).to_bits(), 8, "displacement"),
        (104, f64::INFINITY.to_bits(), 8, "displacement"),
        (112, 1, 1, "reserved field"),
        (123, 1, 1, "reserved field"),
        (128, 0, 4, "section kind"),
        (128 + 8, 7, 1, "element type"),
        (128 + 9, 0, 1, "element type"),
        (128 + 9, 8, 1, "section length"),
        (128 + 10, 1, 1, "section encoding"),
        (128 + 11, 1, 1, "reserved field"),
        (128 + 12, 3, 4, "section flags"),
        (128 + 12, 0, 4, "section flags"),
        (128 + 16, 0, 8, "section offset"),
        (128 + 16, u64::MAX - 63, 8, "section length"),
        (128 + 24, 1, 8, "section length"),
        (128 + 32, u64::MAX, 8, "section length"),
        (second, 1, 4, "section owner"),
        (second + 4, 1, 4, "section owner"),
        (second + 16, number(&bytes, 144, 8), 8, "section offset"),
        (second + 16, number(&bytes, second + 16, 8) + 8, 8, "section offset"),
        (second + 44, 1, 4, "shared section"),
    ] {
        assert_eq!(name(&bytes, at, value, length), expected, "byte {at} = {value:#x}");
    }
    for (at, value, expected) in [
        (69, 15, "segment shift"),
        (69, 16, "segment shift"),
        (69, 64, "segment shift"),
        (88, 0, "dictionary entries"),
    ] {
        assert_eq!(name(&coded, at, value, 1), expected);
    }
    assert_eq!(name(&coded, 88, number(&coded, 80, 8) + 1, 8), "dictionary entries");
    // A count in the header that differs from the sections.
    assert_eq!(field(&bytes, 72, 1 << 40, 8), FormatError::Section { name: "planes" });
    assert_eq!(field(&bytes, 80, 1, 8), FormatError::Section { name: "bricks" });
    assert_eq!(field(&bytes, 67, 1, 1), FormatError::Section { name: "bricks" });
    // Unknown and missing sections, and owners that do not exist.
    let last = 128 + ENTRY * (file::probe_bytes(&bytes).unwrap().sections.len() - 1);
    assert_eq!(field(&bytes, last, 20, 4), FormatError::Required { name: "section", value: 20 });
    let missing = changed(&bytes, false, |bytes| {
        put(bytes, last, 20, 4);
        put(bytes, last + 12, 0, 4);
    });
    assert_eq!(format_error(view(missing)), FormatError::Section { name: "bricks" });
    assert_eq!(field(&bytes, 128, 2, 4), FormatError::Section { name: "objects" });
    // Each byte of the solid's record repeats the header, or is 0.
    let (record, _) = mirrored(&bytes);
    for at in 0..128 {
        let other = changed(&bytes, true, |bytes| bytes[record + at] ^= 1);
        assert_eq!(format_error(view(other)), FormatError::Object, "byte {at}");
    }
    // Levels whose elements are not the stored elements.
    let levels = file::probe_bytes(&bytes).unwrap().sections[2].offset as usize;
    for level in [0, 2] {
        for nodes in [0, 2, u64::MAX] {
            let bytes = changed(&bytes, true, |bytes| put(bytes, levels + 24 * level, nodes, 8));
            assert!(matches!(view(bytes), Err(Error::Damaged(_))), "{nodes} nodes on level {level}");
        }
    }
    // Wrong levels with right sums: depth 5, elements on the levels 0 and 1, bricks on level 3.
    let sections = file::probe_bytes(&coded).unwrap().sections;
    let levels = sections.iter().find(|section| section.name == Some("level table")).unwrap().offset as usize;
    for (from, to, wrong) in [(1, 0, 0), (1, 3, 5), (3, 1, 5)] {
        let moved = changed(&coded, true, |bytes| {
            for (level, change) in [(from, -1), (to, 1)] {
                let at = levels + 24 * level;
                let nodes = number(bytes, at, 8).checked_add_signed(change).unwrap();
                put(bytes, at, nodes, 8);
            }
        });
        match view(moved) {
            Err(Error::Damaged(leafless::error::Damage::LevelTable { level })) => assert_eq!(level, wrong),
            other => panic!("a node moved from level {from} to {to}: {other:?}"),
        }
    }
}

#[test]
fn what_a_text_mode_transfer_does_is_recognised() {
    let bytes = file::to_bytes(&small()).unwrap();
    let replace = |from: &[u8], to: &[u8]| {
        let mut out = vec![];
        let mut rest = &bytes[..];
        while let Some(at) = rest.windows(from.len()).position(|window| window == from) {
            out.extend_from_slice(&rest[..at]);
            out.extend_from_slice(to);
            rest = &rest[at + from.len()..];
        }
        out.extend_from_slice(rest);
        out
    };
    for (from, to) in [("\r\n", "\n"), ("\n", "\r\n"), ("\n", "\r"), ("\r", "\n"), ("\r\n", "\r")] {
        let damaged = replace(from.as_bytes(), to.as_bytes());
        assert_eq!(format_error(file::from_bytes(&damaged)), FormatError::TextMode, "{from:?} to {to:?}");
    }
    for other in [&b"solid"[..], b"\x89PNG\r\n\x1a\n", b"\x89LFL then not"] {
        assert_eq!(format_error(file::from_bytes(other)), FormatError::Magic);
        assert_eq!(format_error(file::probe_from(other)), FormatError::Magic);
    }
}

#[test]
fn what_later_versions_may_add_is_skipped() {
    let tree = small();
    let bytes = file::to_bytes(&tree).unwrap();
    // A newer minor version with a flag and a field of its own.
    let newer = changed(&bytes, false, |bytes| {
        put(bytes, 10, 5, 2);
        put(bytes, 20, 8, 4);
        bytes[71] = 7;
        bytes[115] = 7;
    });
    assert_eq!(file::from_bytes(&newer).unwrap(), tree);
    assert_eq!(file::probe_bytes(&newer).unwrap().version, (0, 5));
    // A section of an unknown kind behind all others; its entry takes the place of padding.
    let sections = file::probe_bytes(&bytes).unwrap().sections;
    let table_end = 128 + ENTRY * sections.len();
    assert!(sections[0].offset as usize >= table_end + ENTRY);
    let offset = bytes.len().next_multiple_of(64);
    let with_flags = |flags: u64| {
        changed(&bytes, true, |bytes| {
            bytes.resize(offset, 0);
            bytes.extend_from_slice(b"colours!");
            let fields =
                [(0, 17, 4), (8, 0x102, 2), (12, flags, 4), (16, offset as u64, 8), (24, 8, 8), (32, 4, 8)];
            for (at, value, length) in fields {
                put(bytes, table_end + at, value, length);
            }
            let length = bytes.len() as u64;
            put(bytes, 24, length, 8);
            put(bytes, 96, sections.len() as u64 + 1, 4);
        })
    };
    let back = file::from_bytes(&with_flags(0)).unwrap();
    assert_eq!((&back, back.metadata()), (&tree, tree.metadata()));
    let section = *file::probe_bytes(&with_flags(0)).unwrap().sections.last().unwrap();
    assert_eq!((section.kind, section.name, section.count), (17, None, 4));
    let refused = format_error(file::from_bytes(&with_flags(1)));
    assert_eq!(refused, FormatError::Required { name: "section", value: 17 });
    // Its checksum counts although no reader uses the section.
    let mut damaged = with_flags(0);
    damaged[offset] ^= 1;
    let refused = format_error(file::from_bytes(&damaged));
    assert_eq!(refused, FormatError::Checksum { name: "an unknown section" });
}

#[test]
fn metadata_that_cannot_be_read_are_refused_by_all_who_read_them() {
    let bytes = file::to_bytes(&small()).unwrap();
    let metadata = file::probe_bytes(&bytes).unwrap().sections[1];
    assert_eq!(metadata.name, Some("metadata"));
    let last = (metadata.offset + metadata.length - 1) as usize;
    let damaged = changed(&bytes, true, |bytes| bytes[last] = 0xFF);
    assert_eq!(format_error(file::from_bytes(&damaged)), FormatError::Metadata);
    let aligned = Aligned::new(&damaged);
    assert_eq!(format_error(file::verify(aligned.bytes())), FormatError::Metadata);
    file::view(aligned.bytes()).unwrap();
    #[cfg(feature = "mmap")]
    {
        let file = tempfile::NamedTempFile::new().unwrap();
        write(file.path(), &damaged);
        // SAFETY: no other process uses the file.
        assert_eq!(format_error(unsafe { file::map(file.path()) }), FormatError::Metadata);
    }
}

// ---- the old file or the new one ------------------------------------------------------------------------

#[cfg(unix)]
mod save {
    use super::*;
    use std::fs;
    use std::os::unix::fs::{PermissionsExt, symlink};
    use std::path::PathBuf;
    use std::process::Command;

    fn names(directory: &Path) -> Vec<String> {
        let entries = fs::read_dir(directory).unwrap();
        let mut names: Vec<_> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    fn mode(path: &Path) -> u32 {
        fs::metadata(path).unwrap().permissions().mode() & 0o7777
    }

    fn set_mode(path: &Path, mode: u32) {
        fs::set_permissions(path, fs::Permissions::from_mode(mode)).unwrap();
    }

    #[track_caller]
    fn io_error(result: Result<(), Error>) -> std::io::Error {
        match result {
            Err(Error::File { error, .. }) => match *error {
                Error::Io(error) => error,
                other => panic!("{other:?}"),
            },
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn permissions() {
        let directory = tempfile::tempdir().unwrap();
        let (plain, path) = (directory.path().join("plain"), directory.path().join("tree.lfl"));
        fs::File::create(&plain).unwrap();
        file::save(&small(), &path).unwrap();
        assert_eq!(mode(&path), mode(&plain), "those of any new file");
        for kept in [0o600, 0o640, 0o666, 0o755] {
            set_mode(&path, kept);
            file::save(&dictionary_coded(), &path).unwrap();
            assert_eq!(mode(&path), kept);
        }
        assert_eq!(file::open(&path).unwrap(), dictionary_coded());
        assert_eq!(names(directory.path()), ["plain", "tree.lfl"]);
    }

    #[test]
    fn symbolic_links_are_followed() {
        let directory = tempfile::tempdir().unwrap();
        let at = |name: &str| directory.path().join(name);
        fs::create_dir(at("other")).unwrap();
        symlink("other/tree.lfl", at("link")).unwrap();
        symlink("link", at("second")).unwrap();
        // First to a new file, then to an existing file.
        for tree in [small(), dictionary_coded()] {
            file::save(&tree, at("second")).unwrap();
            assert_eq!(file::open(at("other/tree.lfl")).unwrap(), tree);
            assert!(fs::symlink_metadata(at("link")).unwrap().is_symlink());
            assert!(fs::symlink_metadata(at("second")).unwrap().is_symlink());
        }
        assert_eq!(names(&at("other")), ["tree.lfl"]);
        symlink("b", at("a")).unwrap();
        symlink("a", at("b")).unwrap();
        io_error(file::save(&small(), at("a")));
        assert_eq!(names(directory.path()), ["a", "b", "link", "other", "second"]);
    }

    #[test]
    fn targets_that_cannot_be_written_to() {
        let directory = tempfile::tempdir().unwrap();
        io_error(file::save(&small(), directory.path()));
        io_error(file::save(&small(), directory.path().join("missing/tree.lfl")));
        io_error(file::verify_path(directory.path().join("missing/tree.lfl")));
        io_error(file::save(&small(), ""));
        assert!(names(directory.path()).is_empty());
    }

    #[test]
    fn devices_and_pipes_are_written_to_directly() {
        file::save(&small(), "/dev/null").unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
        if Path::new("/dev/full").exists() {
            let full = io_error(file::save(&small(), "/dev/full"));
            assert_eq!(full.kind(), std::io::ErrorKind::StorageFull);
        }
        let directory = tempfile::tempdir().unwrap();
        let pipe = directory.path().join("pipe");
        assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let (tree, reader) = (dictionary_coded(), pipe.clone());
        let reader = std::thread::spawn(move || file::open(reader));
        file::save(&tree, &pipe).unwrap();
        assert_eq!(reader.join().unwrap().unwrap(), tree);
        let path = pipe.clone();
        let verifier = std::thread::spawn(move || file::verify_path(path));
        file::save(&tree, &pipe).unwrap();
        verifier.join().unwrap().unwrap();
        // Piped input may be cut short or continue, too.
        let bytes = file::to_bytes(&tree).unwrap();
        for sent in [bytes[..bytes.len() - 1].to_vec(), [&bytes[..], b"x"].concat()] {
            let (path, same) = (pipe.clone(), pipe.clone());
            let reader = std::thread::spawn(move || file::open(path));
            fs::write(&pipe, &sent).unwrap();
            let error = format_error(reader.join().unwrap());
            assert!(matches!(error, FormatError::Length { .. }));
            let verifier = std::thread::spawn(move || file::verify_path(same));
            fs::write(&pipe, sent).unwrap();
            assert_eq!(format_error(verifier.join().unwrap()), error);
        }
        #[cfg(feature = "mmap")]
        // SAFETY: it is refused.
        assert_eq!(format_error(unsafe { file::map(&pipe) }), FormatError::NotRegular);
        assert_eq!(names(directory.path()), ["pipe"]);
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn open_files_are_appended_to() {
        use std::io::Write;
        use std::os::fd::AsRawFd;
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("output");
        let mut output = fs::File::create(&path).unwrap();
        output.write_all(b"before").unwrap();
        let bytes = file::to_bytes(&small()).unwrap();
        for name in ["/proc/self/fd", "/dev/fd"] {
            file::save(&small(), format!("{name}/{}", output.as_raw_fd())).unwrap();
        }
        assert_eq!(fs::read(&path).unwrap(), [b"before", &bytes[..], &bytes].concat());
        assert_eq!(names(directory.path()), ["output"]);
    }

    #[test]
    #[cfg(feature = "mmap")]
    fn a_mapped_file_can_be_replaced() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("tree.lfl");
        let (old, new) = (dictionary_coded(), small());
        file::save(&old, &path).unwrap();
        // SAFETY: the file is only ever replaced.
        let mapped = unsafe { file::map(&path) }.unwrap();
        std::thread::scope(|scope| {
            let saver = scope.spawn(|| {
                for i in 0..40 {
                    file::save(if i % 2 == 0 { &new } else { &old }, &path).unwrap();
                }
            });
            while !saver.is_finished() {
                let now = file::open(&path).unwrap();
                assert!(now == old || now == new);
                mapped.view().check().unwrap();
            }
        });
        assert_eq!(mapped, old);
        // Also without the others.
        file::save(&mapped, &path).unwrap();
        assert_eq!((&mapped, file::open(&path).unwrap()), (&old, old.clone()));
        assert_eq!(names(directory.path()), ["tree.lfl"]);
    }

    /// True if the file system supports files without names.
    #[cfg(target_os = "linux")]
    fn has_unnamed_files(directory: &Path) -> bool {
        use rustix::fs::{Mode, OFlags, open};
        open(directory, OFlags::TMPFILE | OFlags::RDWR, Mode::from_raw_mode(0o600)).is_ok()
    }

    #[test]
    fn other_contents_are_replaced_as_a_whole() {
        use std::io::{Read, Write};
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("text");
        for text in ["first", "second"] {
            let old = fs::read(&path).ok();
            file::replace(&path, |file| {
                file.write_all(text.as_bytes())?;
                assert_eq!(fs::read(&path).ok(), old);
                // A process killed at this moment leaves nothing behind.
                #[cfg(target_os = "linux")]
                if has_unnamed_files(directory.path()) {
                    assert_eq!(names(directory.path()).len(), usize::from(old.is_some()));
                }
                Ok(())
            })
            .unwrap();
            assert_eq!(fs::read(&path).unwrap(), text.as_bytes());
        }
        let error = io_error(file::replace(&path, |file| {
            file.write_all(b"third")?;
            Ok(std::io::empty().read_exact(&mut [0])?)
        }));
        assert_eq!(error.kind(), std::io::ErrorKind::UnexpectedEof);
        assert_eq!(
            (fs::read(&path).unwrap(), names(directory.path())),
            (b"second".to_vec(), vec!["text".into()])
        );
    }

    // The other cases need a process of their own, with limits, another user, or another working directory.

    const TASK: &str = "LEAFLESS_TEST_SAVE";

    /// Runs [`child`] with `task` in `directory`.
    fn run_child(directory: &Path, task: &str, command: impl FnOnce(&Path) -> Command) {
        let program = std::env::current_exe().unwrap();
        let mut command = command(&program);
        command
            .args(["--exact", "octrees::save::child", "--nocapture"])
            .env(TASK, task)
            .current_dir(directory);
        let output = command.output().unwrap();
        let text =
            String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && text.contains("the child was here"), "{text}");
    }

    /// The process that other tests start. By itself it does nothing.
    #[test]
    fn child() {
        let Ok(task) = std::env::var(TASK) else { return };
        match task.as_str() {
            "relative" => {
                file::save(&small(), "tree.lfl").unwrap();
                file::save(&small(), "./tree.lfl").unwrap();
                file::save(&small(), "other/../tree.lfl").unwrap();
            }
            "limited" => {
                let bytes = file::to_bytes(&dictionary_coded()).unwrap();
                assert!(bytes.len() > 4096, "more than the limit");
                let error = io_error(file::save(&dictionary_coded(), "tree.lfl"));
                assert_eq!(error.kind(), std::io::ErrorKind::FileTooLarge);
            }
            "abandoned" => {
                // A thread that never returns from its save.
                let (send, receive) = std::sync::mpsc::channel();
                std::thread::spawn(move || {
                    let saved = file::replace("tree.lfl", |file| {
                        std::io::Write::write_all(file, b"new")?;
                        send.send(()).unwrap();
                        std::thread::sleep(std::time::Duration::from_millis(100));
                        Ok(())
                    });
                    panic!("{saved:?}");
                });
                receive.recv().unwrap();
                file::abandon_saves();
                std::thread::sleep(std::time::Duration::from_millis(300));
            }
            "read-only" => {
                let error = io_error(file::save(&dictionary_coded(), "tree.lfl"));
                assert_eq!(error.kind(), std::io::ErrorKind::PermissionDenied);
                let error = io_error(file::save(&dictionary_coded(), "new.lfl"));
                assert_eq!(error.kind(), std::io::ErrorKind::PermissionDenied);
            }
            "read-only file" => {
                let error = io_error(file::save(&dictionary_coded(), "tree.lfl"));
                assert_eq!(error.kind(), std::io::ErrorKind::PermissionDenied);
            }
            "unreadable directory" => file::save(&dictionary_coded(), "tree.lfl").unwrap(),
            other => panic!("{other}"),
        }
        println!("the child was here");
    }

    #[test]
    fn relative_paths() {
        let directory = tempfile::tempdir().unwrap();
        fs::create_dir(directory.path().join("other")).unwrap();
        run_child(directory.path(), "relative", |program| Command::new(program));
        assert_eq!(names(directory.path()), ["other", "tree.lfl"]);
        assert_eq!(file::open(directory.path().join("tree.lfl")).unwrap(), small());
    }

    #[test]
    fn abandoned_saves_leave_the_old_file() {
        let directory = tempfile::tempdir().unwrap();
        fs::write(directory.path().join("tree.lfl"), "old").unwrap();
        run_child(directory.path(), "abandoned", |program| Command::new(program));
        assert_eq!(names(directory.path()), ["tree.lfl"]);
        assert_eq!(fs::read(directory.path().join("tree.lfl")).unwrap(), b"old");
    }

    #[test]
    fn a_disk_that_fills_up_leaves_the_old_file() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("tree.lfl");
        file::save(&small(), &path).unwrap();
        run_child(directory.path(), "limited", |program| {
            let mut shell = Command::new("sh");
            shell.args(["-c", "trap '' XFSZ; ulimit -f 4; exec \"$0\" \"$@\""]).arg(program);
            shell
        });
        assert_eq!(names(directory.path()), ["tree.lfl"]);
        assert_eq!(file::open(&path).unwrap(), small());
    }

    /// Returns a command that runs the test program as a user whom permissions bind.
    fn unprivileged(directory: &Path, program: &Path) -> Command {
        use std::os::unix::process::CommandExt;
        let mut command = Command::new(program);
        if fs::write(directory.join("probe"), "").is_ok() {
            // Permissions do not bind this user.
            fs::remove_file(directory.join("probe")).unwrap();
            command.uid(65534).gid(65534);
        }
        command
    }

    /// Returns a directory and a copy of the test program in it. Every user can reach both.
    fn open_directory() -> (tempfile::TempDir, PathBuf, PathBuf) {
        let outer = tempfile::tempdir().unwrap();
        set_mode(outer.path(), 0o755);
        let (program, inner) = (outer.path().join("program"), outer.path().join("inner"));
        fs::copy(std::env::current_exe().unwrap(), &program).unwrap();
        set_mode(&program, 0o755);
        fs::create_dir(&inner).unwrap();
        file::save(&small(), inner.join("tree.lfl")).unwrap();
        (outer, program, inner)
    }

    #[test]
    fn a_read_only_directory_leaves_the_old_file() {
        let (_outer, program, inner) = open_directory();
        set_mode(&inner.join("tree.lfl"), 0o666);
        set_mode(&inner, 0o555);
        run_child(&inner, "read-only", |_| unprivileged(&inner, &program));
        assert_eq!(names(&inner), ["tree.lfl"]);
        assert_eq!(file::open(inner.join("tree.lfl")).unwrap(), small());
        set_mode(&inner, 0o755);
    }

    #[test]
    fn a_read_only_file_is_not_replaced() {
        let (_outer, program, inner) = open_directory();
        set_mode(&inner.join("tree.lfl"), 0o444);
        set_mode(&inner, 0o555);
        run_child(&inner, "read-only file", |_| {
            let command = unprivileged(&inner, &program);
            set_mode(&inner, 0o777);
            command
        });
        assert_eq!(names(&inner), ["tree.lfl"]);
        assert_eq!(file::open(inner.join("tree.lfl")).unwrap(), small());
        set_mode(&inner, 0o755);
    }

    #[test]
    fn a_directory_that_cannot_be_read_is_enough() {
        let (_outer, program, inner) = open_directory();
        set_mode(&inner.join("tree.lfl"), 0o666);
        set_mode(&inner, 0o555);
        run_child(&inner, "unreadable directory", |_| {
            let command = unprivileged(&inner, &program);
            set_mode(&inner, 0o333);
            command
        });
        set_mode(&inner, 0o755);
        assert_eq!(names(&inner), ["tree.lfl"]);
        assert_eq!(file::open(inner.join("tree.lfl")).unwrap(), dictionary_coded());
    }
}

/// Each refusal of a path begins with the path as given, and contains no other name and no number.
#[test]
fn errors_name_the_file() {
    fn text<T>(result: Result<T, Error>) -> String {
        result.err().unwrap().to_string()
    }
    let directory = tempfile::tempdir().unwrap();
    let missing = directory.path().join("missing.lfl");
    let expected = format!("{}: No such file or directory", missing.display());
    let short = directory.path().join("short.lfl");
    std::fs::write(&short, b"leafless").unwrap();
    let is_named = |text: String| {
        assert!(
            text.starts_with(&format!("{}: ", short.display())) && text.matches("short.lfl").count() == 1,
            "{text}"
        );
    };
    #[cfg(unix)]
    {
        assert_eq!(text(file::open(&missing)), expected);
        assert_eq!(text(file::probe(&missing)), expected);
        assert_eq!(text(leafless::exchange::open_mesh(&missing, &Default::default())), expected);
        #[cfg(feature = "scene")]
        assert_eq!(text(leafless::scene::open_scene(&missing)), expected);
        #[cfg(feature = "mmap")]
        // SAFETY: there is no such file.
        unsafe {
            assert_eq!(text(file::map(&missing)), expected);
            assert_eq!(text(file::map_verified(&missing)), expected);
        }
        // The error does not mention the temporary file beside it.
        let tree = small();
        let path = directory.path().join("no/part.lfl");
        assert_eq!(text(file::save(&tree, &path)), format!("{}: No such file or directory", path.display()));
    }
    is_named(text(file::open(&short)));
    is_named(text(file::probe(&short)));
    is_named(text(leafless::exchange::open_mesh(&short, &Default::default())));
    #[cfg(feature = "scene")]
    is_named(text(leafless::scene::open_scene(&short)));
    #[cfg(feature = "mmap")]
    // SAFETY: nobody changes the file.
    unsafe {
        is_named(text(file::map(&short)));
        is_named(text(file::map_verified(&short)));
        let folder = text(file::map(directory.path()));
        assert!(folder.starts_with(&format!("{}: only a regular", directory.path().display())), "{folder}");
    }
}

/// An error about different frames names both frames.
#[test]
fn frames_that_differ_are_told() {
    let tree = |x: f64, depth| {
        let frame = leafless::Frame::new([x, 0.0, 0.5], 4.0, depth).unwrap();
        leafless::Octree::uniform(frame, leafless::Tag::Full, leafless::Tag::Full).unwrap()
    };
    let refused = leafless::union(tree(0.0, 3).view(), tree(1.0, 4).view(), &Default::default());
    assert_eq!(
        refused.unwrap_err().to_string(),
        "different frames: origin [0.0, 0.0, 0.5], edge 4, depth 3 and origin [1.0, 0.0, 0.5], edge 4, depth 4; \
         give both the same bounds and depth"
    );
}
