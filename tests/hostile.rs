//! Hostile bytes: the bodies of the fuzz targets, on inputs that are the same every time. See `fuzz/README.md`.

#![cfg(all(feature = "mmap", target_endian = "little"))]

#[path = "../fuzz/bodies/mod.rs"]
mod bodies;

use bodies::layout::{File, Repairs};
use bodies::{Aligned, Random, joined, seeds};
use leafless::file;
use std::path::Path;

/// What stands in for libFuzzer's own mutations.
fn blind(random: &mut Random, data: &mut [u8], size: usize, max: usize) -> usize {
    let mut bytes = data[..size].to_vec();
    for _ in 0..1 + random.below(3) {
        let at = random.below(bytes.len());
        match random.below(5) {
            _ if bytes.is_empty() => bytes.push(random.next() as u8),
            0 => bytes[at] ^= 1 << random.below(8),
            1 => bytes[at] = [0, 1, 0x7F, 0x80, 0xFF][random.below(5)],
            2 => bytes.insert(at, random.next() as u8),
            3 => drop(bytes.remove(at)),
            _ => bytes[at] = random.next() as u8,
        }
    }
    bytes.truncate(max);
    data[..bytes.len()].copy_from_slice(&bytes);
    bytes.len()
}

/// The seeds and files that the fuzzer starts from, written for it where this variable says.
const SEEDS: &str = "LEAFLESS_SEEDS";

#[test]
#[ignore = "writes the seeds for the fuzzer"]
fn write_seeds() {
    let Some(directory) = std::env::var_os(SEEDS) else { return };
    let pairs = seeds::pairs();
    for (target, inputs) in [("ways_in", &seeds::files()), ("queries", &pairs), ("set_algebra", &pairs)] {
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
        file::verify(Aligned::new(&bytes).bytes()).unwrap();
        bodies::ways_in(&bytes);
        // Taken apart and put together, it is the same.
        let parts = File::parse(&bytes).unwrap();
        assert_eq!(parts.clone().assemble(&Repairs::NONE), bytes);
        assert_eq!(parts.assemble(&Repairs::FRAME), bytes);
    }
    println!("{:?}", seeds::files().iter().map(Vec::len).collect::<Vec<_>>());
    for pair in seeds::pairs() {
        bodies::queries(&pair);
        bodies::set_algebra(&pair);
    }
}

/// How far changed files get.
#[derive(Default, Debug)]
struct Reached {
    inputs: usize,
    viewed: usize,
    verified: usize,
}

#[test]
fn changed_files_get_past_the_checks() {
    let mut reached = Reached::default();
    let mut files = seeds::files();
    let mut random = Random(7);
    for round in 0..4000 {
        let i = random.below(files.len());
        let mut data = files[i].clone();
        let size = data.len();
        data.resize(1 << 14, 0);
        let mut draw = Random(random.next());
        let size = bodies::mutate_file(&mut data, size, 1 << 14, round, &mut |data, size, max| {
            blind(&mut draw, data, size, max)
        });
        data.truncate(size);
        bodies::ways_in(&data);
        bodies::queries(&joined(&data, &data));
        bodies::set_algebra(&joined(&data, &files[random.below(files.len())]));
        let aligned = Aligned::new(&data);
        reached.inputs += 1;
        reached.viewed += file::view(aligned.bytes()).is_ok() as usize;
        reached.verified += file::verify(aligned.bytes()).is_ok() as usize;
        // Changes add up.
        if file::view(aligned.bytes()).is_ok() && files.len() < 400 {
            files.push(data);
        }
    }
    println!("{reached:?}");
    assert!(reached.viewed > reached.inputs / 3 && reached.verified > reached.inputs / 8, "{reached:?}");
    assert!(reached.viewed - reached.verified > reached.inputs / 8, "{reached:?}");
}
