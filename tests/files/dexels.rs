//! Files of tri-dexel models: the vectors, round trips, damage, and tri-dexel files beside octree files.

#![cfg(feature = "std")]

// Its `main` is the program that writes the vectors.
use crate::make_vectors::dexel_vectors::{self, Dexels, ValidDexels};
use crate::make_vectors::{Way, number, put, seal};
use leafless::dexel::{DexelEditor, DexelEnds, DexelFormat, DexelNormals, TriDexelRef};
use leafless::error::FormatError;
use leafless::op::DexelOptions;
use leafless::{Control, Csg, Error, Frame, Metadata, TriDexel, dexelize, file, file::dexels};
use leafless_testkit::{Aligned, Random};
use std::path::{Path, PathBuf};

const CONTROL: Control<'static> =
    Control { threads: 1, max_nodes: None, max_bytes: None, max_splits: None, cancel: None, progress: None };

fn vector(of: &str, name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("format_spec/vectors").join(of).join(format!("{name}.lfl"))
}

/// Returns the format that a header's byte encodes.
fn format(form: u8) -> DexelFormat {
    DexelFormat {
        ends: if form & 1 != 0 { DexelEnds::Double } else { DexelEnds::Fixed },
        normals: [DexelNormals::None, DexelNormals::Bits16, DexelNormals::Bits32][(form >> 1 & 3) as usize],
        surfaces: form & 8 != 0,
        materials: form & 16 != 0,
    }
}

/// All bytes that encode a format.
fn forms() -> impl Iterator<Item = u8> {
    (0x20..=0xFFu8).filter(|form| form & 6 != 6)
}

#[track_caller]
fn refused<T>(result: Result<T, Error>) -> String {
    match result {
        Ok(_) => panic!("it was let in"),
        Err(error) => format!("{:?}", error.cause()),
    }
}

/// Checks a view of a read model against the expected model.
fn agrees(view: &TriDexelRef<'_>, model: &Dexels) {
    assert_eq!(view.frame(), &Frame::new(model.origin, model.edge, model.depth).unwrap());
    assert_eq!(view.format(), format(model.form()));
    assert_eq!(view.directions(), model.rays.each_ref().map(Option::is_some));
    let (origin, cell) = (view.frame().origin(), view.frame().cell_size());
    for axis in 0..3 {
        let (Some(rays), Some(expected)) = (view.rays(axis), &model.rays[axis]) else {
            assert!(view.rays(axis).is_none() && model.rays[axis].is_none());
            continue;
        };
        let count: usize = expected.values().map(Vec::len).sum();
        assert_eq!(rays.interval_count(), count as u64);
        let [us, vs] = rays.window();
        let size = us.len() * vs.len();
        let mut met = 0;
        // In a universe with many rays, only the rays of the window are queried.
        for (v, u) in vs.flat_map(|v| us.clone().map(move |u| (v, u))) {
            let list = expected.get(&[v, u]).map_or(&[][..], |list| list);
            assert_eq!(rays.dexels([u, v]).count(), list.len());
            met += usize::from(!list.is_empty());
            for (found, one) in rays.dexels([u, v]).zip(list) {
                for (k, end) in [found.start, found.end].into_iter().enumerate() {
                    // The exact place, and its coordinate rounded once (`dexel_ends` compares it with exact
                    // numbers).
                    assert_eq!(end.cells, Some(one.ends[k]));
                    let (rounded, along) = (origin[axis] + one.ends[k] * cell, one.ends[k] * cell);
                    assert!((end.at - rounded).abs() <= 2.0 * f64::EPSILON * (end.at.abs() + along));
                    let known = |known: bool, value: u32| (known && value != u32::MAX).then_some(value);
                    assert_eq!(end.surface, known(model.surfaces, one.surfaces[k]));
                    let code = one.normals[k];
                    let none = [true, code & 0xFFFF == 0x8080, code == 0x8000_8000][model.normals];
                    assert_eq!(end.normal.is_none(), none);
                    let length = end.normal.map_or(1.0, |n| n.iter().map(|c| c * c).sum::<f64>());
                    assert!((length - 1.0).abs() < 1e-12);
                }
                assert_eq!(found.material, if model.materials { one.material } else { 0 });
            }
        }
        assert_eq!(met, expected.len());
        let outside = [u32::MAX; 2];
        assert_eq!(rays.dexels(outside).count(), 0);
        let statistics = view.statistics(axis).unwrap();
        assert_eq!((statistics.intervals, statistics.rays), (count as u64, expected.len() as u64));
        assert_eq!(
            statistics.bytes,
            4 * (size as u64 + 1) + count as u64 * view.format().bytes_per_interval() as u64
        );
        let length: f64 = expected.values().flatten().map(|one| one.ends[1] - one.ends[0]).sum();
        let volume = length * cell.powi(3);
        assert!((statistics.volume - volume).abs() <= 1e-12 * volume);
    }
}

fn cells_agree(view: &TriDexelRef<'_>, vector: &ValidDexels) {
    let text = vector.facts();
    let mut asked = 0;
    for line in text.lines().filter_map(|line| line.strip_prefix("cell: ")) {
        let words: Vec<&str> = line.split(' ').collect();
        let cell = [0, 1, 2].map(|axis| words[axis].parse().unwrap());
        let said: Vec<bool> =
            words[3..].iter().filter(|&&word| word != "none").map(|&word| word == "in").collect();
        // Where directions differ, the highest axis decides.
        let expected = *said.last().unwrap();
        assert_eq!(view.contains_cell(cell), expected, "{}: {line}", vector.name);
        asked += 1;
    }
    assert!(asked > 15);
}

fn leaked(bytes: &[u8]) -> &'static [u8] {
    Box::leak(Box::new(Aligned::new(bytes))).bytes()
}

#[test]
fn valid_vectors_are_read_by_every_way_in() {
    let vectors = dexel_vectors::valid();
    assert!(vectors.len() > 10);
    for made in vectors {
        let path = vector("valid", made.name);
        println!("{}", path.display());
        let bytes = std::fs::read(&path).unwrap();
        assert!(bytes == made.bytes);
        let probe = file::probe(&path).unwrap();
        assert_eq!(probe, file::probe_bytes(&bytes).unwrap());
        assert_eq!(probe.frame, Frame::new(made.model.origin, made.model.edge, made.model.depth).unwrap());
        assert_eq!((probe.file_len, probe.elements, probe.bricks), (bytes.len() as u64, 0, 0));
        let said = probe.dexels.unwrap();
        assert_eq!(said.format, format(made.model.form()));
        let aligned = Aligned::new(&bytes);
        file::verify(aligned.bytes()).unwrap();
        file::verify_path(&path).unwrap();
        let owned = [
            dexels::from_bytes(&bytes).unwrap(),
            dexels::open(&path).unwrap(),
            dexels::from_static(leaked(&bytes)).unwrap(),
            #[cfg(feature = "mmap")]
            // SAFETY: nobody changes the vectors while tests run.
            unsafe { dexels::map(&path) }.unwrap(),
            #[cfg(feature = "mmap")]
            // SAFETY: as above.
            unsafe { dexels::map_verified(&path) }.unwrap(),
        ];
        let view = dexels::view(aligned.bytes()).unwrap();
        for axis in 0..3 {
            assert_eq!(said.directions[axis], view.rays(axis).is_some());
            assert_eq!(said.intervals[axis], view.rays(axis).map_or(0, |rays| rays.interval_count()));
            let rays = view
                .rays(axis)
                .map_or(0, |rays| rays.window().iter().map(|side| side.len() as u64).product());
            assert_eq!(said.rays[axis], rays);
        }
        for view in owned.iter().map(TriDexel::view).chain([&view]) {
            agrees(view, &made.model);
            cells_agree(view, &made);
            view.check().unwrap();
        }
        for model in &owned {
            assert!(model == &owned[0]);
            assert_eq!(model.metadata(), &made.model.metadata);
            assert_eq!(dexels::to_bytes(model).unwrap() == bytes, made.canonical, "{}", made.name);
        }
    }
}

#[test]
fn invalid_vectors_are_refused_where_they_say_and_for_the_reason_that_they_say() {
    let vectors = dexel_vectors::invalid();
    assert!(vectors.len() > 60);
    for made in vectors {
        let path = vector("invalid", &made.name);
        println!("{}", path.display());
        assert!(std::fs::read(&path).unwrap() == made.bytes);
        let (bytes, error) = (leaked(&made.bytes), made.error.as_str());
        match made.way {
            Way::Probing => assert_eq!(refused(file::probe_bytes(bytes)), error),
            _ => drop(file::probe(&path).unwrap()),
        }
        // One of the vectors is a file of an octree.
        if made.name == "section-unknown-windows" {
            assert_eq!(refused(file::from_bytes(bytes)), error);
            continue;
        }
        match made.way {
            Way::Probing | Way::Plain => assert_eq!(refused(dexels::view(bytes)), error),
            _ => drop(dexels::view(bytes).unwrap()),
        }
        match made.way {
            Way::Verification => drop(dexels::from_static(bytes).unwrap()),
            _ => assert_eq!(refused(dexels::from_static(bytes)), error),
        }
        #[cfg(feature = "mmap")]
        {
            // SAFETY: nobody changes the vectors while tests run.
            match (made.way, unsafe { dexels::map(&path) }) {
                (Way::Verification, mapped) => drop(mapped.unwrap()),
                (_, mapped) => assert_eq!(refused(mapped), error),
            }
            // SAFETY: as above.
            assert_eq!(refused(unsafe { dexels::map_verified(&path) }), error);
        }
        assert_eq!(refused(file::verify(bytes)), error);
        assert_eq!(refused(dexels::from_bytes(bytes)), error);
        assert_eq!(refused(dexels::open(&path)), error);
    }
}

#[test]
fn every_format_in_every_direction_comes_back() {
    let scratch = tempfile::tempdir().unwrap();
    let path = scratch.path().join("model.lfl");
    let mut intervals = 0;
    for (seed, form) in forms().enumerate() {
        let mut made = Dexels::random(seed as u64, 1 + seed as u8 % 6, form);
        if seed % 3 == 0 {
            made.metadata.insert("name", "by chance");
        }
        let bytes = made.bytes();
        let model = dexels::from_bytes(&bytes).unwrap();
        agrees(model.view(), &made);
        assert!(dexels::to_bytes(&model).unwrap() == bytes, "form {form:#x}");
        let mut written = vec![];
        dexels::write_to(&model, &mut written).unwrap();
        assert!(written == bytes);
        dexels::save(&model, &path).unwrap();
        assert!(std::fs::read(&path).unwrap() == bytes && dexels::open(&path).unwrap() == model);
        #[cfg(feature = "mmap")]
        {
            // SAFETY: the file is replaced by renaming.
            let mapped = unsafe { dexels::map(&path) }.unwrap();
            assert!(mapped == model && mapped.metadata() == model.metadata());
            assert!(dexels::to_bytes(&mapped).unwrap() == bytes);
        }
        intervals += model.view().interval_count();
    }
    assert!(intervals > 5_000, "{intervals}");
}

/// Results of operations are written and read back, whatever the operands' formats.
#[test]
fn results_of_operations_come_back() {
    for form in [0xE0, 0xE1, 0xFC, 0xFD, 0x7B, 0x2A] {
        let [a, b] =
            [1, 2].map(|seed| dexels::from_static(leaked(&Dexels::random(seed, 4, form).bytes())).unwrap());
        let mut editor = DexelEditor::new(a.view()).unwrap();
        editor.subtract(b.view(), &CONTROL).unwrap();
        let difference = a.view().difference(b.view(), &CONTROL).unwrap();
        let results = [
            a.view().union(b.view(), &CONTROL).unwrap(),
            a.view().intersection(b.view(), &CONTROL).unwrap(),
            a.view().xor(b.view(), &CONTROL).unwrap(),
            a.view().complement(&CONTROL).unwrap(),
            a.view().with_material(5, &CONTROL).unwrap(),
            a.view().to_format(format(0x1D), &CONTROL).unwrap(),
            a.view().to_format(format(0), &CONTROL).unwrap(),
            editor.freeze(&CONTROL).unwrap(),
        ];
        assert!(results[7] == difference);
        for result in results {
            let bytes = dexels::to_bytes(&result).unwrap();
            let back = dexels::from_bytes(&bytes).unwrap();
            assert!(back == result && dexels::to_bytes(&back).unwrap() == bytes);
        }
        let (one, other) = (dexels::to_bytes(&difference).unwrap(), dexels::to_bytes(&a).unwrap());
        assert!(one != other);
    }
}

/// Dexelised solids come back, also where an interval begins at the universe's face.
#[test]
fn dexelized_solids_come_back() {
    let ball = Csg::ball([0.25, -0.5, 0.0], 0.9).unwrap();
    let frames = [Frame::new([-1.0; 3], 2.0, 5).unwrap(), Frame::new([0.1, -0.7, -0.9], 1.7, 4).unwrap()];
    for (form, frame) in forms().step_by(5).flat_map(|form| frames.map(|frame| (form, frame))) {
        let directions = [0, 1, 2].map(|axis| form >> (5 + axis) & 1 != 0);
        let options = DexelOptions { directions, format: format(form), ..DexelOptions::default() };
        let model = dexelize(&ball, &frame, &options, &CONTROL).unwrap();
        let bytes = dexels::to_bytes(&model).unwrap();
        assert_eq!(bytes[71], form);
        let back = dexels::from_bytes(&bytes).unwrap();
        assert!(back == model && dexels::to_bytes(&back).unwrap() == bytes);
        for axis in 0..3 {
            assert_eq!(back.view().statistics(axis), model.view().statistics(axis));
        }
        let complement = model.view().complement(&CONTROL).unwrap();
        assert!(dexels::from_bytes(&dexels::to_bytes(&complement).unwrap()).unwrap() == complement);
    }
}

#[test]
fn metadata_travel() {
    let model = dexels::from_bytes(&Dexels::random(3, 3, 0xE0).bytes()).unwrap();
    let mut metadata = Metadata::new();
    metadata.insert("name", "Flansch Ø 120");
    metadata.insert("units", "mm");
    let named = model.with_metadata(metadata.clone());
    let back = dexels::from_bytes(&dexels::to_bytes(&named).unwrap()).unwrap();
    assert_eq!(back.metadata(), &metadata);
    assert!(back == model);
    metadata.insert("source", "x".repeat(1 << 20));
    let error = dexels::to_bytes(&model.with_metadata(metadata));
    assert!(matches!(error, Err(Error::Argument { .. })), "{error:?}");
}

#[test]
fn files_that_end_early_or_late_are_refused() {
    let bytes = Dexels::random(5, 2, 0xFC).bytes();
    for length in 0..bytes.len() {
        let cut = leaked(&bytes[..length]);
        assert!(dexels::from_bytes(cut).is_err() && dexels::view(cut).is_err() && file::verify(cut).is_err());
    }
    let longer = [&bytes[..], &[0]].concat();
    assert!(matches!(dexels::from_bytes(&longer), Err(Error::Format(FormatError::Length { .. }))));
    let scratch = tempfile::tempdir().unwrap();
    let path = scratch.path().join("cut.lfl");
    for length in (0..bytes.len()).step_by(61) {
        std::fs::write(&path, &bytes[..length]).unwrap();
        assert!(matches!(dexels::open(&path), Err(Error::File { .. })));
        #[cfg(feature = "mmap")]
        // SAFETY: no other process uses the file.
        assert!(unsafe { dexels::map(&path) }.is_err());
    }
}

#[test]
fn every_changed_byte_is_noticed() {
    let good = Dexels::random(6, 2, 0xFD).bytes();
    for at in 0..good.len() {
        for bit in [0, 3, 7] {
            let mut bytes = good.clone();
            bytes[at] ^= 1 << bit;
            assert!(dexels::from_bytes(&bytes).is_err(), "byte {at}, bit {bit}");
        }
    }
}

#[test]
fn each_kind_of_file_is_refused_where_the_other_is_wanted() {
    let scratch = tempfile::tempdir().unwrap();
    let octree = vector("valid", "example");
    let dexel = vector("valid", "dexel-cuboid");
    let names = ["an octree", "a tri-dexel model"];
    let wrong = |found: usize| {
        let [found, wanted] = [names[found], names[1 - found]];
        format!("{:?}", Error::Format(FormatError::OtherModel { found, wanted }))
    };
    let [trees, models] = [&octree, &dexel].map(|path| leaked(&std::fs::read(path).unwrap()));
    assert_eq!(refused(dexels::view(trees)), wrong(0));
    assert_eq!(refused(dexels::from_bytes(trees)), wrong(0));
    assert_eq!(refused(dexels::from_static(trees)), wrong(0));
    assert_eq!(refused(dexels::open(&octree)), wrong(0));
    assert_eq!(refused(file::view(models)), wrong(1));
    assert_eq!(refused(file::from_bytes(models)), wrong(1));
    assert_eq!(refused(file::from_static(models)), wrong(1));
    assert_eq!(refused(file::open(&dexel)), wrong(1));
    #[cfg(feature = "mmap")]
    // SAFETY: nobody changes the vectors while tests run.
    unsafe {
        assert_eq!(refused(dexels::map(&octree)), wrong(0));
        assert_eq!(refused(dexels::map_verified(&octree)), wrong(0));
        assert_eq!(refused(file::map(&dexel)), wrong(1));
        assert_eq!(refused(file::map_verified(&dexel)), wrong(1));
    }
    let error = dexels::open(&octree).unwrap_err().to_string();
    assert!(error.contains("example.lfl") && error.contains("holds an octree"), "{error}");
    // The header alone is enough for the refusal, before the rest is read.
    let path = scratch.path().join("beginning.lfl");
    std::fs::write(&path, &models[..128]).unwrap();
    assert_eq!(refused(file::open(&path)), wrong(1));
    assert!(file::probe_bytes(trees).unwrap().dexels.is_none());
    for bytes in [trees, models] {
        file::verify(bytes).unwrap();
    }
}

/// Runs all queries on a model with unchecked arrays.
fn asked(model: &TriDexel) {
    let view = model.view();
    let sound = view.check().is_ok();
    let most = view.frame().cells() - 1;
    for axis in (0..3).filter_map(|axis| view.rays(axis)) {
        let [us, vs] = axis.window();
        for ray in [[us.start, vs.start], [us.end.saturating_sub(1), vs.end.saturating_sub(1)], [most; 2]] {
            let met = axis.dexels(ray).count();
            assert!(met as u64 <= axis.interval_count());
        }
    }
    for axis in 0..3 {
        if let Some(statistics) = view.statistics(axis) {
            assert!(statistics.bytes <= view.bytes());
        }
    }
    for cell in [[0; 3], [most; 3], [most / 2, 0, 1], [1, most, most / 2]] {
        view.contains_cell(cell);
    }
    assert!(model == &model.clone() || !sound);
    let operations = [
        view.union(view, &CONTROL),
        view.xor(view, &CONTROL),
        view.complement(&CONTROL),
        view.with_material(1, &CONTROL),
        view.to_format(DexelFormat::default(), &CONTROL),
        DexelEditor::new(view).and_then(|mut editor| {
            editor.intersect(view, &CONTROL)?;
            editor.freeze(&CONTROL)
        }),
    ];
    for result in operations {
        match result {
            Ok(result) => {
                assert!(sound);
                result.view().check().unwrap();
            }
            Err(error) => assert!(matches!(error, Error::DamagedRays { .. }) && !sound, "{error}"),
        }
    }
    assert_eq!(dexels::to_bytes(model).is_ok(), sound);
}

#[test]
fn whatever_the_arrays_say_reading_is_safe_and_operations_refuse() {
    let mut random = Random(1);
    let (mut let_in, mut sound) = (0, 0);
    for round in 0..1500 {
        let form = forms().nth(random.index(168)).unwrap();
        let mut bytes = Dexels::random(round, 1 + round as u8 % 4, form).bytes();
        let probe = file::probe_bytes(&bytes).unwrap();
        for _ in 0..1 + random.index(4) {
            let section = &probe.sections[random.index(probe.sections.len())];
            let (start, length) = (section.offset as usize, section.length as usize);
            let at = start + random.index(length);
            match random.index(4) {
                0 => bytes[at] ^= 1 << random.index(8),
                1 => bytes[start..start + length].fill([0, 0xFF, 0x7F, 0x80][random.index(4)]),
                2 => {
                    let four = start + random.index(length / 4 + 1) * 4;
                    let value = [0, u32::MAX as u64, 0x7FF0_0000, 0x8000_0000, random.index(100) as u64]
                        [random.index(5)];
                    if four + 4 <= start + length {
                        put(&mut bytes, four, value, 4);
                    }
                }
                _ => bytes[at] = random.index(256) as u8,
            }
        }
        seal(&mut bytes);
        let bytes = leaked(&bytes);
        let verified = file::verify(bytes);
        let copied = dexels::from_bytes(bytes);
        assert_eq!(verified.is_ok(), copied.is_ok());
        if let Ok(model) = dexels::from_static(bytes) {
            let_in += 1;
            asked(&model);
            if let Ok(copied) = &copied {
                sound += 1;
                asked(copied);
                assert!(copied == &model || form & 1 != 0);
                assert!(dexels::to_bytes(copied).unwrap() == bytes);
            }
        } else {
            assert!(copied.is_err());
        }
    }
    assert!(sound > 100 && let_in - sound > 300, "{let_in} {sound}");
}

/// Operations refuse rays that all claim all intervals, because their cost would be quadratic.
#[test]
fn rays_with_common_intervals_cost_nothing() {
    let depth = 10;
    let mut made = Dexels::new(depth, [true, false, false]);
    let ray: Vec<_> =
        Dexels::random(1, depth, 0x20).rays[0].as_ref().unwrap().values().next().unwrap().clone();
    for v in 0..1 << depth {
        for u in [0, (1 << depth) - 1] {
            made.rays[0].as_mut().unwrap().insert([v, u], ray.clone());
        }
    }
    let mut bytes = made.bytes();
    let section =
        file::probe_bytes(&bytes).unwrap().sections.into_iter().find(|section| section.kind == 33).unwrap();
    let all = file::probe_bytes(&bytes).unwrap().dexels.unwrap().intervals[0];
    for i in 0..section.count as usize {
        put(&mut bytes, section.offset as usize + 4 * i, if i % 2 == 0 { 0 } else { all }, 4);
    }
    seal(&mut bytes);
    let model = dexels::from_static(leaked(&bytes)).unwrap();
    assert!(section.count > 1 << 20 && number(&bytes, 72, 8) == all);
    assert_eq!(model.view().statistics(0).unwrap().rays, 1);
    asked(&model);
}
