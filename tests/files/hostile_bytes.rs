//! Hostile bytes: the bodies of the fuzz targets, on inputs that are the same every time. See
//! `fuzz/README.md`.

#![cfg(all(feature = "mmap", target_endian = "little"))]

use leafless::error::{Damage, FormatError};
use leafless::octree::Cursor;
use leafless::{Error, Solid, SurfaceOptions, build_extended, file, measure, union};
use leafless_testkit::fuzz::layout::{
    BASE, BRICKS, CELL_SLABS, CUTS, File, GROUPS, LEVELS, MOMENTS, NUMBERS, PLACEMENTS, PLANES, REL, Repairs,
    SURFACES, Section, put,
};
use leafless_testkit::fuzz::{joined, read_in_all_ways, seeds, walk};
use leafless_testkit::{Aligned, Random, fuzz, on_all_processors, repeated};
use std::path::Path;

// ---- inputs ---------------------------------------------------------------------------------------------

/// A substitute for libFuzzer's own mutations.
fn blind(random: &mut Random, data: &mut [u8], size: usize, max: usize) -> usize {
    let mut bytes = data[..size].to_vec();
    for _ in 0..1 + random.index(3) {
        let at = random.index(bytes.len());
        match random.index(5) {
            _ if bytes.is_empty() => bytes.push(random.bits() as u8),
            0 => bytes[at] ^= 1 << random.index(8),
            1 => bytes[at] = [0, 1, 0x7F, 0x80, 0xFF][random.index(5)],
            2 => bytes.insert(at, random.bits() as u8),
            3 => drop(bytes.remove(at)),
            _ => bytes[at] = random.bits() as u8,
        }
    }
    bytes.truncate(max);
    data[..bytes.len()].copy_from_slice(&bytes);
    bytes.len()
}

/// The most bytes of a changed file.
const MOST: usize = 1 << 14;

/// Returns a file after one of the fuzzer's mutations.
fn mutated(bytes: &[u8], random: &mut Random) -> Vec<u8> {
    let mut data = bytes.to_vec();
    data.resize(MOST.max(bytes.len()), 0);
    let mut draw = Random(random.bits());
    let seed = random.bits() as u32;
    let size = fuzz::mutate_file(&mut data, bytes.len(), MOST, seed, &mut |data, size, max| {
        blind(&mut draw, data, size, max)
    });
    data.truncate(size);
    data
}

/// Returns two repaired copies of a file: one with right checksums only, one with right checksums and object
/// records.
fn resealed(bytes: &[u8]) -> Vec<Vec<u8>> {
    let only_checksums = Repairs { checksums: [true; 3], ..Repairs::NONE };
    let repairs = [only_checksums, Repairs { objects: true, ..only_checksums }];
    repairs.iter().filter_map(|repairs| File::parse(bytes).map(|file| file.assemble(repairs))).collect()
}

/// Files of a few hundred bytes, of different structure.
fn small_files() -> Vec<Vec<u8>> {
    let mut files = seeds::files();
    files.sort_by_key(Vec::len);
    let has = |bytes: &[u8], kind: u32| {
        let file = File::parse(bytes).unwrap();
        file.sections.iter().any(|section| section.kind() == kind)
    };
    // A file without elements, and files with raw bricks, with elements, with a dictionary, with metadata,
    // with an unknown section, with an application's section, with other objects, of a later version, with
    // channels, with cuts of one cell, and with splits.
    let mut chosen = vec![files[0].clone()];
    for kind in [BRICKS, PLANES, fuzz::layout::ENTRIES, fuzz::layout::METADATA, 17, 1 << 31] {
        chosen.extend(files.iter().find(|bytes| has(bytes, kind)).cloned());
    }
    let shares =
        |bytes: &[u8]| File::parse(bytes).unwrap().sections.iter().any(|section| section.same().is_some());
    chosen.extend(files.iter().find(|bytes| shares(bytes)).cloned());
    chosen.extend(files.iter().find(|bytes| bytes[10] > 4).cloned());
    chosen.extend(files.iter().find(|bytes| bytes[10] == 2).cloned());
    let cuts = |bytes: &[u8]| file::from_bytes(bytes).unwrap().view().cuts();
    for splits in [0..1, 1..u64::MAX] {
        let is_it = |bytes: &&Vec<u8>| cuts(bytes).is_some_and(|cuts| splits.contains(&cuts.splits));
        chosen.extend(files.iter().find(is_it).cloned());
    }
    assert_eq!(chosen.len(), 12);
    chosen
}

/// Runs all queries and set operations on the tree, if the bytes contain one.
fn exercise(bytes: &[u8]) {
    fuzz::queries(&joined(bytes, &bytes[bytes.len() / 2..]));
    fuzz::set_algebra(&joined(bytes, bytes));
}

// ---- the seeds and corpora ------------------------------------------------------------------------------

/// The environment variable with the output folder of [`write_seeds`].
const SEEDS: &str = "LEAFLESS_SEEDS";

#[test]
#[ignore = "writes the seeds for the fuzzer"]
fn write_seeds() {
    let Some(directory) = std::env::var_os(SEEDS) else { panic!("{SEEDS} must name a directory") };
    let pairs = seeds::pairs();
    let inputs = [
        ("ways_in", &[seeds::files(), seeds::dexel_files()].concat()),
        ("queries", &pairs),
        ("set_algebra", &pairs),
        ("meshes", &fuzz::meshes::seeds()),
    ];
    for (target, inputs) in inputs {
        let directory = Path::new(&directory).join(target);
        std::fs::create_dir_all(&directory).unwrap();
        for (i, input) in inputs.iter().enumerate() {
            std::fs::write(directory.join(format!("seed-{i:03}")), input).unwrap();
        }
    }
}

#[test]
fn the_seeds_are_good() {
    for bytes in seeds::files() {
        assert!(read_in_all_ways(&bytes, true));
        // Split and assembled again, it is the same file.
        let parts = File::parse(&bytes).unwrap();
        assert_eq!(parts.clone().assemble(&Repairs::NONE), bytes);
        assert_eq!(parts.assemble(&Repairs::ALL), bytes);
    }
    for pair in seeds::pairs() {
        fuzz::queries(&pair);
        fuzz::set_algebra(&pair);
    }
}

#[test]
fn tri_dexel_models_are_read_whatever_was_done_to_them() {
    let mut random = Random(8);
    let (mut good, mut rounds) = (0, 0);
    for bytes in seeds::dexel_files() {
        assert!(read_in_all_ways(&bytes, true));
        let sections = file::probe_bytes(&bytes).unwrap().sections;
        for round in 0..150 {
            let mut changed = mutated(&bytes, &mut random);
            if round % 3 != 0 {
                // The contents of a section, with right checksums.
                changed.clone_from(&bytes);
                let section = &sections[random.index(sections.len())];
                for _ in 0..1 + random.index(3) {
                    let at = section.offset as usize + random.index(section.length as usize);
                    changed[at] = [0, 1, 0x7F, 0x80, 0xFF, random.bits() as u8][random.index(6)];
                }
                changed = resealed(&changed).swap_remove(0);
            }
            good += u32::from(read_in_all_ways(&changed, round % 16 == 0));
            rounds += 1;
        }
        for end in 0..bytes.len().min(700) {
            assert!(!read_in_all_ways(&bytes[..end], false));
        }
    }
    assert!(good > 50 && rounds - good > 500, "{good} of {rounds}");
}

#[test]
fn what_the_fuzzer_found_interesting() {
    type Body = fn(&[u8]);
    let targets: [(&str, Body); 4] = [
        ("ways_in", fuzz::ways_in),
        ("queries", fuzz::queries),
        ("set_algebra", fuzz::set_algebra),
        ("meshes", fuzz::meshes::meshes),
    ];
    for (target, body) in targets {
        let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus").join(target);
        let mut count = 0;
        for entry in std::fs::read_dir(&corpus).unwrap() {
            body(&std::fs::read(entry.unwrap().path()).unwrap());
            count += 1;
        }
        assert!(count > 100, "{target}: {count} inputs");
    }
}

// ---- every length, every byte, every bit ----------------------------------------------------------------

#[test]
fn files_cut_at_every_length() {
    for bytes in small_files() {
        for length in 0..bytes.len() {
            let cut = &bytes[..length];
            assert!(!read_in_all_ways(cut, true), "{length}");
            // An attacker who knows the length field and the checksums cuts the file like this.
            let mut shorter = cut.to_vec();
            if length >= 128 {
                put(&mut shorter, 24, length as u64, 8);
                let crc = crc32fast::hash(&shorter[..124]);
                put(&mut shorter, 124, crc.into(), 4);
                assert!(!read_in_all_ways(&shorter, false), "{length}");
            }
            // Also with its last section cut.
            if let Some(file) = File::parse(cut).filter(|file| length > 128 + 48 * file.sections.len()) {
                let bytes = file.assemble(&Repairs::FRAME);
                read_in_all_ways(&bytes, length % 8 == 0);
                exercise(&bytes);
            }
        }
        // Nothing may follow, either.
        for more in [1, 8, 64] {
            assert!(!read_in_all_ways(&[&bytes[..], &vec![0; more]].concat(), true));
        }
    }
}

#[test]
fn every_byte_and_the_first_bits_flipped() {
    let counts = on_all_processors(&small_files(), |bytes| {
        let (mut viewed, mut verified) = (0, 0);
        let bits = (0..128.min(bytes.len())).flat_map(|at| (0..8).map(move |bit| (at, 1u8 << bit)));
        let all =
            (0..bytes.len()).step_by(repeated(3, 1)).map(|at| (at, if at % 2 == 0 { 0xFF } else { 0x01 }));
        for (at, flip) in bits.chain(all) {
            let mut flipped = bytes.clone();
            flipped[at] ^= flip;
            assert!(!read_in_all_ways(&flipped, flip == 0xFF), "byte {at} ^ {flip:#x}");
            if file::view(Aligned::new(&flipped).bytes()).is_ok() {
                exercise(&flipped);
            }
            for sealed in resealed(&flipped) {
                let good = read_in_all_ways(&sealed, flip == 0xFF);
                if file::view(Aligned::new(&sealed).bytes()).is_ok() {
                    viewed += 1;
                    exercise(&sealed);
                }
                // A good file with right checksums is the file of another tree, to the byte. Every field
                // matters, except those reserved for later versions.
                if good {
                    verified += 1;
                    let written = file::to_bytes(&file::from_bytes(&sealed).unwrap()).unwrap();
                    let later = sealed[10..12] != written[10..12] || seeds::has_unknown_parts(&sealed);
                    assert!(later || written == sealed || sealed == *bytes, "byte {at} ^ {flip:#x}");
                }
            }
        }
        (viewed, verified)
    });
    let (viewed, verified) = counts.into_iter().fold((0, 0), |sum, part| (sum.0 + part.0, sum.1 + part.1));
    println!("{viewed} viewed, {verified} verified");
    assert!(viewed > 1000 && verified > 100, "{viewed} viewed, {verified} verified");
}

// ---- files of meshes ------------------------------------------------------------------------------------

#[test]
fn mesh_files_cut_and_changed() {
    let seeds = fuzz::meshes::seeds();
    let mut random = Random(13);
    let (mut read, mut inputs) = (0, 0);
    for seed in &seeds {
        (0..=seed.len()).for_each(|length| fuzz::meshes::meshes(&seed[..length]));
    }
    for _ in 0..30_000 {
        let mut data = seeds[random.index(seeds.len())].clone();
        for _ in 0..1 + random.index(3) {
            let (at, from) = (random.index(data.len()), random.index(data.len()));
            match random.index(4) {
                _ if data.is_empty() => {}
                // A word is replaced, or a line is lost or repeated.
                0 | 1 if data[at].is_ascii_digit() => data[at] = b"0123456789-. \n/"[random.index(15)],
                2 => {
                    let line = data.split_inclusive(|&b| b == b'\n').nth(from % 16).unwrap_or(&[]).to_vec();
                    let before = data[..at].iter().rposition(|&b| b == b'\n').map_or(0, |end| end + 1);
                    data.splice(before..before, line);
                }
                _ => {
                    let size = data.len();
                    data.resize(size + 4, 0);
                    let changed = blind(&mut random, &mut data, size, size + 4);
                    data.truncate(changed);
                }
            }
        }
        fuzz::meshes::meshes(&data);
        read += fuzz::meshes::READERS.iter().any(|(_, read)| read(&data).is_ok()) as usize;
        inputs += 1;
    }
    assert!(read > inputs / 8 && read < inputs / 2, "{read} of {inputs} were read");
}

// ---- links ----------------------------------------------------------------------------------------------

/// A file of depth 20. One element is above eight levels of `width` elements each, and all elements of a
/// level have the same `width` children. Without a memory of visited elements, following the links leads to
/// width^9 bricks.
fn shared_children(width: usize) -> Vec<u8> {
    let uniform = seeds::trees().into_iter().find(|tree| tree.frame().depth() == 20).unwrap();
    let mut file = File::parse(&file::to_bytes(&uniform).unwrap()).unwrap();
    file.header[65] = 1;
    let elements = 1 + 8 * width;
    let branches = if width == 64 { !0u64 } else { (1 << width) - 1 };
    let planes = (0..elements).flat_map(|_| [branches, 0]).flat_map(u64::to_le_bytes).collect();
    let first_child = |n: usize| 1 + width * n.div_ceil(width);
    let rel = (0..elements).flat_map(|n| (first_child(n) as u16).to_le_bytes()).collect();
    let counts =
        (0..21).flat_map(|level| [[0, width, 1][(level % 2 == 0) as usize + (level == 0) as usize], 0, 0]);
    let levels = counts.take(60).chain([0; 3]).flat_map(|count| (count as u64).to_le_bytes()).collect();
    file.sections = vec![
        Section::new(PLANES, planes),
        Section::new(REL, rel),
        Section::new(BASE, vec![0; 8]),
        Section::new(BRICKS, [0xF0, 0, 0, 0, 0, 0, 0, 0].repeat(width)),
        Section::new(LEVELS, levels),
    ];
    file.assemble(&Repairs::FRAME)
}

#[test]
fn a_walk_meets_no_element_twice() {
    for width in [3, 64] {
        let aligned = Aligned::new(&shared_children(width));
        let tree = file::view(aligned.bytes()).unwrap();
        let entries = tree.element_count() + tree.brick_count();
        assert_eq!(entries, 1 + 9 * width as u64);
        let steps = walk(Cursor::new(&tree)).steps;
        assert!(steps > 8 * 9 && steps <= 1 + 72 * entries, "{steps} steps over {entries} entries");
        assert!(matches!(file::verify(aligned.bytes()), Err(Error::Damaged(Damage::Link { .. }))));
        exercise(aligned.bytes());
    }
}

#[test]
fn of_a_sound_tree_a_cursor_sees_all_in_any_order() {
    for tree in seeds::trees() {
        let mut random = Random(5);
        let mut cursor = Cursor::new(tree.view());
        for _ in 0..2000 {
            if random.one_in(3) {
                cursor.ascend();
            } else {
                cursor.descend(random.index(8) as u8);
            }
            let (cell, below) = (cursor.cell(), tree.frame().depth() - cursor.cell().level);
            let mut fresh = Cursor::new(tree.view());
            for level in (0..cell.level).rev() {
                let octant = (0..3).fold(0, |octant, axis| octant | (cell.at[axis] >> level & 1) << axis);
                assert!(fresh.descend(octant as u8));
            }
            assert_eq!((cursor.tag(), cursor.node()), (fresh.tag(), fresh.node()));
            let tag = tree.view().tag_at(cell.at.map(|a| a << below));
            assert!(cursor.node().is_some() || cursor.tag() == tag);
        }
    }
}

/// A caller may mistake parts of one tree for parts of another. Such parts lead nowhere.
#[test]
fn parts_of_another_tree_lead_nowhere() {
    use leafless::{Cell, Classifier, Verdict, Worker};
    let trees = seeds::trees();
    let on_frames = trees.iter().map(|tree| tree.view().on(tree.frame(), &fuzz::CONTROL).unwrap());
    let mut workers: Vec<_> = on_frames.map(|classifier| classifier.worker().unwrap()).collect();
    let mut parts = vec![];
    for worker in &mut workers {
        // Some parts on each level.
        let mut open = vec![(Cell::ROOT, worker.root().unwrap())];
        for _ in 0..40 {
            let Some((cell, verdict)) = open.pop() else { break };
            let Verdict::Partial(part) = verdict else { continue };
            parts.push(part);
            open.extend((0..8).map(|k| cell.child(k)).zip(worker.split(cell, &part).unwrap()));
        }
    }
    assert!(parts.len() > 100);
    for (tree, worker) in trees.iter().zip(&mut workers) {
        let mut nowhere = 0;
        for part in &parts {
            let children = worker.split(Cell::ROOT, part).unwrap();
            let planes = worker.split64(Cell::ROOT, part, &mut vec![]).unwrap();
            assert_eq!(planes.branch(), 0);
            nowhere += children.iter().all(|child| matches!(child, Verdict::Undecided)) as usize;
        }
        // A tree without elements and cuts has no place for a part.
        let has_places = tree.view().element_count() + tree.view().brick_count() > 0;
        assert!(has_places || tree.view().cuts().is_some() || nowhere == parts.len());
    }
}

/// Found by fuzzing: point queries, and no other readers, followed a link that is right modulo 2^64.
#[test]
fn links_whose_sums_wrap_lead_to_the_same_for_all() {
    let bytes = seeds::files().into_iter().find(|bytes| bytes[64] == 3 && bytes[65] == 1).unwrap();
    let mut file = File::parse(&bytes).unwrap();
    file.section(BASE).unwrap().bytes = vec![0xFF; 8];
    for rel in [0, 1, 2, 3, 0xFFFF] {
        let mut file = file.clone();
        put(&mut file.section(REL).unwrap().bytes, 0, rel, 2);
        let bytes = file.assemble(&Repairs::FRAME);
        assert!(!read_in_all_ways(&bytes, true));
        file::view(Aligned::new(&bytes).bytes()).unwrap();
        exercise(&bytes);
    }
}

// ---- many changes ---------------------------------------------------------------------------------------

/// Numbers of changed files by the furthest step that they pass.
#[derive(Default, Debug)]
struct Reached {
    inputs: usize,
    viewed: usize,
    verified: usize,
}

/// Makes `count` files by the fuzzer's mutations, one from another, and runs every operation on them.
fn change_files(count: usize, seed: u64) -> Reached {
    let mut reached = Reached::default();
    let mut files = seeds::files();
    let originals = files.len();
    let mut random = Random(seed);
    for _ in 0..count {
        let base = random.index(files.len());
        let data = mutated(&files[base], &mut random);
        let verified = read_in_all_ways(&data, random.one_in(8));
        let viewed = file::view(Aligned::new(&data).bytes()).is_ok();
        if random.one_in(32) {
            fuzz::threads(&data);
        }
        fuzz::queries(&joined(&data, &random.bits().to_le_bytes().repeat(9)));
        fuzz::set_algebra(&joined(&data, &files[random.index(files.len())]));
        reached.inputs += 1;
        reached.viewed += viewed as usize;
        reached.verified += verified as usize;
        // Changes add up.
        if viewed {
            if files.len() < 500 {
                files.push(data);
            } else {
                let at = originals + random.index(files.len() - originals);
                files[at] = data;
            }
        }
    }
    reached
}

/// Makes `count` files by the same mutations without repairs. A file is accepted only if nothing was changed.
fn damage_files(count: usize, seed: u64) {
    let files = seeds::files();
    let mut random = Random(seed);
    for _ in 0..count {
        let original = &files[random.index(files.len())];
        let mut draw = Random(random.bits());
        let mut blind = |data: &mut [u8], size: usize, max: usize| blind(&mut draw, data, size, max);
        let data = fuzz::changed(original, &mut random, &mut blind, &Repairs::NONE).unwrap();
        let good = read_in_all_ways(&data, random.one_in(16));
        assert_eq!(good, &data == original);
    }
}

#[test]
fn changed_files_get_past_the_checks() {
    damage_files(1000, 1);
    let reached = change_files(2000, 7);
    println!("{reached:?}");
    assert!(reached.viewed > reached.inputs / 3 && reached.verified > reached.inputs / 8, "{reached:?}");
    assert!(reached.viewed - reached.verified > reached.inputs / 8, "{reached:?}");
}

#[test]
#[ignore = "a hundred thousand damaged and as many changed files"]
fn hundred_thousand() {
    damage_files(100_000, 2);
    println!("{:?}", change_files(100_000, 8));
}

/// Bytes with the program's lifetime are read in place, and their metadata, too.
#[test]
fn bytes_that_live_for_ever() {
    let files = seeds::files();
    let mut random = Random(9);
    for _ in 0..400 {
        let data = mutated(&files[random.index(files.len())], &mut random);
        let words: &'static [u64] = Aligned::new(&data).leak();
        let bytes = &bytemuck::cast_slice(words)[..data.len()];
        match (file::view(bytes), file::from_static(bytes)) {
            (Ok(view), Ok(tree)) => {
                assert_eq!(tree.view().brick_count(), view.brick_count());
                let _ = (tree.statistics(), file::to_bytes(&tree));
            }
            // The view is the solid's alone; channels have records and sections of their own.
            (Ok(_), Err(refused)) => {
                assert!(data[10] > 1 || matches!(refused, Error::Format(FormatError::Metadata)), "{refused}");
            }
            (Err(refused), Err(again)) => assert_eq!(refused.to_string(), again.to_string()),
            (Err(refused), Ok(_)) => panic!("{refused}"),
        }
    }
}

#[test]
fn pairs_stay_pairs_when_they_are_changed() {
    let pairs = seeds::pairs();
    let mut random = Random(3);
    let (mut inputs, mut on_one_lattice) = (0, 0);
    for round in 0..3000 {
        let pair = &pairs[random.index(pairs.len())];
        let mut data = pair.clone();
        data.resize(MOST.max(pair.len()), 0);
        let mut draw = Random(round);
        let size = fuzz::mutate_pair(&mut data, pair.len(), MOST, round as u32, &mut |data, size, max| {
            blind(&mut draw, data, size, max)
        });
        let Some((a, b)) = fuzz::halves(&data[..size]) else { continue };
        let (a, b) = (Aligned::new(a), Aligned::new(b));
        if let (Ok(a), Ok(b)) = (file::view(a.bytes()), file::view(b.bytes())) {
            on_one_lattice += (a.frame() == b.frame()) as usize;
        }
        inputs += 1;
    }
    assert!(inputs > 2900 && on_one_lattice > inputs / 3, "{on_one_lattice} of {inputs}");
}

/// The magic bytes of another kind of file are refused before anything else is examined.
#[test]
fn other_kinds_of_files_are_refused_at_once() {
    for bytes in [&b""[..], b"\x89", b"\x89PNG\r\n\x1a\n", &[0; 4096], b"solid x\nendsolid x\n"] {
        assert!(!read_in_all_ways(bytes, true));
    }
    let magic = |bytes: &[u8]| matches!(file::probe_bytes(bytes), Err(Error::Format(FormatError::Magic)));
    assert!(magic(b"solid x") && magic(&[0; 4096]) && !magic(b"\x89LFL"));
}

// ---- cuts -----------------------------------------------------------------------------------------------

/// Returns the file of a PARTIAL universe whose cut is a half-space.
fn a_plane() -> File {
    let is_it = |bytes: &&Vec<u8>| bytes[65] == 2 && bytes[10] == 4;
    File::parse(seeds::files().iter().find(is_it).unwrap()).unwrap()
}

/// Surfaces with long chains of maps are refused: comparing such surfaces would cost work and memory for each
/// pair.
#[test]
fn long_chains_of_maps_are_refused() {
    for (maps, is_good) in [(1u64, true), (64, true), (65, false), (20_000, false)] {
        let mut file = a_plane();
        let rows = [[1.0, 0.0, 0.0, 0.5], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0f64]];
        let map = |outer: u64| rows.as_flattened().iter().map(|c| c.to_bits()).chain([outer]);
        let bytes = (0..maps).flat_map(map).flat_map(u64::to_le_bytes).collect();
        let at = file.sections.iter().position(|section| section.is(NUMBERS)).unwrap() + 1;
        file.insert(at, Section::new(PLACEMENTS, bytes));
        put(&mut file.section(SURFACES).unwrap().bytes, 12, maps, 4);
        let bytes = file.assemble(&Repairs::FRAME);
        assert_eq!(read_in_all_ways(&bytes, true), is_good, "{maps} maps");
        let aligned = Aligned::new(&bytes);
        let solid = file::view(aligned.bytes()).unwrap();
        assert_eq!(solid.on(solid.frame(), &fuzz::CONTROL).is_ok(), is_good);
        exercise(&bytes);
    }
}

/// Found by changing bytes: if a surface's number was not finite, a mapped tree differed from its clone.
#[test]
fn numbers_that_are_none_do_not_make_a_tree_unlike_itself() {
    for bits in [f64::NAN.to_bits(), f64::INFINITY.to_bits(), (-0.0f64).to_bits(), 1] {
        let mut file = a_plane();
        put(&mut file.section(NUMBERS).unwrap().bytes, 0, bits, 8);
        let bytes = file.assemble(&Repairs::FRAME);
        read_in_all_ways(&bytes, true);
        exercise(&bytes);
    }
}

/// Trees with only cell slabs have no surface records. The slabs of two such trees were once taken for equal.
#[test]
fn tables_without_records_are_not_taken_for_one() {
    let vectors = Path::new(env!("CARGO_MANIFEST_DIR")).join("format_spec/vectors/valid");
    let bytes = std::fs::read(vectors.join("cut-cell-slabs-alone.lfl")).unwrap();
    let mut file = File::parse(&bytes).unwrap();
    // As many slabs of other origins that face the other way.
    for slab in file.section(CELL_SLABS).unwrap().bytes.chunks_exact_mut(16) {
        slab[15] ^= 0x80;
    }
    for group in file.section(GROUPS).unwrap().bytes.chunks_exact_mut(24) {
        group[9] ^= 1;
    }
    let others = file.assemble(&Repairs::FRAME);
    let [own, others] = [&bytes, &others].map(|bytes| file::from_bytes(bytes).unwrap());
    let count = own.view().cuts().unwrap().surfaces;
    let both = union(own.view(), others.view(), &fuzz::CONTROL).unwrap();
    assert_eq!(both.view().cuts().unwrap().surfaces, 2 * count);
    both.view().check().unwrap();
}

/// Legal moments need not be the moments of any solid.
#[test]
fn moments_of_nothing_that_is() {
    let vectors = Path::new(env!("CARGO_MANIFEST_DIR")).join("format_spec/vectors/valid");
    let bytes = std::fs::read(vectors.join("cut-moments-exact.lfl")).unwrap();
    let file = File::parse(&bytes).unwrap();
    let some = [0.0, f64::from_bits(1), f64::MIN_POSITIVE, 1e-160, 0.1, 1.0, 3e7, 1e160, f64::MAX];
    let mut random = Random(4);
    for _ in 0..3000 {
        let mut draw = |least: f64| {
            let value = some[random.index(some.len())];
            if random.one_in(2) && value != 0.0 { (-value).max(least) } else { value }
        };
        let mut numbers = vec![draw(f64::MIN), draw(f64::MIN), draw(f64::MIN)];
        for moment in 0..10 {
            let least = if moment == 0 { 0.0 } else { f64::MIN };
            let mut ends = [draw(least), draw(least)];
            ends.sort_unstable_by(f64::total_cmp);
            numbers.extend(ends);
        }
        let mut file = file.clone();
        file.section(MOMENTS).unwrap().bytes = numbers.iter().flat_map(|c| c.to_le_bytes()).collect();
        let bytes = file.assemble(&Repairs::FRAME);
        let tree = file::from_bytes(&bytes).unwrap();
        let found = measure(&tree, tree.frame(), 0.0, &fuzz::CONTROL).unwrap();
        assert!(found.exact && [found.volume.lower, found.volume.upper] == numbers[3..5]);
        let tensors = [found.inertia_about_origin, found.inertia_about_centroid];
        let known = tensors.iter().flatten().flatten().chain(found.centroid.iter().flatten());
        known.for_each(|interval| assert!(interval.lower <= interval.upper, "{numbers:?}: {found:?}"));
        let again = build_extended(&tree, tree.frame(), &SurfaceOptions::default(), &fuzz::CONTROL).unwrap();
        assert!(again.view().moments() == tree.view().moments() && file::to_bytes(&tree).unwrap() == bytes);
    }
}

/// Changes every head, every count and every id of the cuts of small files, with right checksums.
#[test]
fn every_byte_of_cuts() {
    let with_cuts = |bytes: &Vec<u8>| bytes[10] == 4 && bytes.len() < 2500;
    let files: Vec<_> = seeds::files().into_iter().filter(with_cuts).collect();
    assert!(files.len() > 3);
    let counts = on_all_processors(&files, |bytes| {
        let file = File::parse(bytes).unwrap();
        let (mut good, mut all) = (0, 0);
        for kind in CUTS {
            let length = file.clone().section(kind).map_or(0, |section| section.bytes.len());
            for at in 0..length.min(160) {
                for value in [0, 1, 2, 3, 0x7F, 0x80, 0xAA, 0xF0, 0xFF] {
                    let mut file = file.clone();
                    file.section(kind).unwrap().bytes[at] = value;
                    let bytes = file.assemble(&Repairs::FRAME);
                    good += u32::from(read_in_all_ways(&bytes, false));
                    all += 1;
                    if (at + usize::from(value)) % 7 == 0 {
                        fuzz::queries(&joined(&bytes, &bytes[bytes.len() / 2..][..90]));
                    }
                }
            }
        }
        (good, all)
    });
    let (good, all) = counts.into_iter().fold((0, 0), |sum, part| (sum.0 + part.0, sum.1 + part.1));
    println!("{good} of {all} are good");
    assert!(good > 100 && all - good > 1000, "{good} of {all}");
}
