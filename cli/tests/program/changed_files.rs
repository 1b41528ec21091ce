//! Files changed by a mutator that knows the format, mostly with good checksums, through every command of the
//! program. Each run ends by itself with code 0, 1 or 2, and reports a problem in one line. A result made
//! from a file that `verify` accepts is good.

use crate::commands::{COMMANDS, attempt, vectors};
use crate::place::Place;
use leafless_testkit::{Random, fuzz};

/// A blind change of one byte.
fn blind(random: &mut Random, data: &mut [u8], size: usize) -> usize {
    if size > 0 {
        data[random.index(size)] = random.bits() as u8;
    }
    size
}

/// Runs commands on `files` changed files of the vectors. Returns the numbers of changed files, of good ones
/// among them, and of good results.
fn change(files: usize, seed: u64) -> [usize; 3] {
    let vectors: Vec<Vec<u8>> = vectors().iter().map(|path| std::fs::read(path).unwrap()).collect();
    let place = Place::new();
    let mut random = Random(seed);
    let [mut made, mut good, mut results] = [0; 3];
    while made < files {
        let original = &vectors[random.index(vectors.len())];
        let repairs = fuzz::repairs(&mut random);
        let mut draw = Random(random.bits());
        let mut any = |data: &mut [u8], size: usize, _: usize| blind(&mut draw, data, size);
        let Some(bytes) = fuzz::changed(original, &mut random, &mut any, &repairs) else { continue };
        made += 1;
        place.write("changed.lfl", &bytes);
        let path = place.path("changed.lfl");
        let is_good = place.run("verify changed.lfl").code == Some(0);
        good += usize::from(is_good);
        let command = COMMANDS[random.index(COMMANDS.len())];
        let _ = std::fs::remove_file(place.path("out.lfl"));
        attempt(&place, "160M", &path, [command].into_iter());
        if is_good && place.path("out.lfl").exists() {
            place.run("verify out.lfl").good();
            results += 1;
        }
        let left = place.files();
        assert!(
            left.iter().all(|name| name == "changed.lfl" || name.starts_with("out.")),
            "{command}: {left:?}"
        );
    }
    [made, good, results]
}

#[test]
fn changed_files_end_every_command_by_themselves() {
    let found = change(300, 1);
    println!("{found:?}");
    let [made, good, results] = found;
    assert!(good > made / 10 && results > 10, "{found:?}");
}

#[test]
#[ignore = "minutes"]
fn thousands_of_changed_files_end_every_command_by_themselves() {
    println!("{:?}", change(6000, 2));
}
