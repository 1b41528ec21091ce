//! Any bytes through every way in. No way panics, and all agree.

use super::{channels, dexels_in_all_ways, walk};
use crate::Aligned;
use leafless::error::FormatError;
use leafless::octree::Cursor;
use leafless::{Error, Octree, Tag, file};
use std::path::PathBuf;

/// Returns the outcome of an attempt as a comparable text.
fn outcome<T>(result: &Result<T, Error>) -> Result<(), String> {
    result.as_ref().map(|_| ()).map_err(|error| error.cause().to_string())
}

/// Reads `data` in every way. A real file costs more than all other ways, so that only some inputs become
/// one.
pub fn ways_in(data: &[u8]) {
    read_in_all_ways(data, crc32fast::hash(data).is_multiple_of(8));
}

/// Reads `data` in every way, including the ways that need a file if `as_a_file`. Returns whether it is
/// verified as good.
pub fn read_in_all_ways(data: &[u8], as_a_file: bool) -> bool {
    let aligned = Aligned::new(data);
    let bytes = aligned.bytes();
    let probed = file::probe_bytes(bytes);
    let viewed = file::view(bytes);
    let verified = outcome(&file::verify(bytes));
    let copied = file::from_bytes(bytes);
    let good_dexels = dexels_in_all_ways(data, as_a_file);
    if matches!(copied, Err(Error::Format(FormatError::OtherModel { .. }))) {
        assert!(viewed.is_err() && file::from_static(lasting(bytes)).is_err());
        assert!(verified.is_ok() == good_dexels && probed.is_ok() >= good_dexels);
        return good_dexels;
    }
    assert!(!good_dexels);
    match (&probed, file::probe_from(bytes)) {
        (Ok(a), Ok(b)) => assert_eq!(a, &b),
        (Err(a), Err(b)) => assert_eq!(a.to_string(), b.to_string()),
        (a, b) => panic!("{a:?} and {b:?}"),
    }
    // Each way in requires what the previous one requires, and more.
    assert_eq!(outcome(&copied), verified);
    if let Err(refused) = outcome(&viewed) {
        assert_eq!(verified, Err(refused));
    }
    if let (Err(refused), Err(again)) = (outcome(&probed), outcome(&viewed)) {
        assert!(refused == again || data.len() >= 128, "{refused}, {again}");
    }
    if let Ok(tree) = &viewed {
        let probe = probed.as_ref().expect("what can be viewed can be probed");
        assert_eq!(probe.file_len, data.len() as u64);
        assert_eq!(
            (&probe.frame, probe.root, probe.exterior),
            (tree.frame(), tree.root_tag(), tree.exterior())
        );
        assert_eq!((probe.elements, probe.bricks), (tree.element_count(), tree.brick_count()));
        assert_eq!((probe.binary, probe.proof), (tree.is_binary(), tree.proof()));
    }
    if let Ok(tree) = &copied {
        good(tree);
    }
    in_place(bytes, &copied);
    if as_a_file {
        through_a_file(data, &outcome(&probed), &outcome(&viewed), &verified);
    }
    verified.is_ok()
}

/// Returns the bytes with a static lifetime. Callers must drop all data read from them before the bytes.
fn lasting(bytes: &[u8]) -> &'static [u8] {
    // SAFETY: see above; all callers drop the data read before they return.
    #[allow(unsafe_code)]
    unsafe {
        std::slice::from_raw_parts(bytes.as_ptr(), bytes.len())
    }
}

/// Reads the bytes in place, unverified, with their channels.
fn in_place(bytes: &[u8], copied: &Result<Octree, Error>) {
    let bytes = lasting(bytes);
    match (file::from_static(bytes), copied) {
        (Ok(tree), Ok(copied)) => {
            assert!(&tree == copied && tree.channels() == copied.channels());
            channels(&tree, true);
        }
        (Ok(tree), Err(_)) => channels(&tree, false),
        (Err(error), copied) => assert!(copied.is_err(), "{error}"),
    }
}

/// Checks the laws of every verified tree.
fn good(tree: &Octree) {
    let written = file::to_bytes(tree).expect("a verified tree can be written");
    let back = file::from_bytes(&written).expect("what was written can be read");
    assert!(&back == tree && back.metadata() == tree.metadata() && back.proof() == tree.proof());
    assert_eq!(back.channels(), tree.channels());
    let metadata = |tree: &Octree| tree.channels().iter().map(|c| c.metadata().clone()).collect::<Vec<_>>();
    assert_eq!(metadata(&back), metadata(tree));
    assert_eq!(file::to_bytes(&back).expect("a verified tree can be written"), written);
    // The statistics agree with a walk over all cells.
    let walked = walk(Cursor::new(tree.view()));
    let statistics = tree.statistics();
    let depth = tree.frame().depth();
    assert_eq!(statistics.levels().len(), depth as usize + 1);
    let (mut lower, mut upper) = (0, 0);
    for (level, cells) in statistics.levels().iter().zip(walked.cells) {
        let found = [level.empty, level.nodes, level.partial, level.full];
        assert_eq!(found, cells, "level {}", level.level);
        let volume = 1u64 << (3 * (depth - level.level));
        lower += volume * cells[Tag::Full as usize];
        upper += volume * (cells[Tag::Full as usize] + cells[Tag::Partial as usize]);
    }
    assert_eq!(statistics.volume_cells(), (lower, upper));
}

/// Returns a path for this process alone, in memory where there is such a file system.
pub fn scratch_file() -> PathBuf {
    let memory = PathBuf::from("/dev/shm");
    let directory = if memory.is_dir() { memory } else { std::env::temp_dir() };
    let thread = std::thread::current().id();
    directory.join(format!("leafless-fuzz-{}-{thread:?}.lfl", std::process::id()))
}

/// Checks the ways in that need a file.
fn through_a_file(
    data: &[u8],
    probed: &Result<(), String>,
    viewed: &Result<(), String>,
    verified: &Result<(), String>,
) {
    let path = scratch_file();
    std::fs::write(&path, data).expect("a place for a file");
    let found = outcome(&file::probe(&path));
    // For a path, the length is known, too.
    assert!(&found == probed || (probed.is_ok() && viewed.is_err()), "{found:?}, {probed:?}");
    assert_eq!(&outcome(&file::open(&path)), verified);
    {
        // SAFETY: no other process uses the file, and it is removed only when the trees are gone.
        #[allow(unsafe_code)]
        let (mapped, scanned) = unsafe { (file::map(&path), file::map_verified(&path)) };
        assert_eq!(&outcome(&scanned), verified);
        if verified.is_ok() || viewed.is_err() {
            assert_eq!(&outcome(&mapped), viewed);
        }
        if let Ok(tree) = &mapped {
            // Statistics do not panic, whatever the level table contains.
            let statistics = tree.statistics();
            let _ = (statistics.volume(), statistics.nodes(), statistics.cells(Tag::Full));
            assert_eq!(tree, &tree.clone());
            assert!(file::to_bytes(tree).is_err() || tree.view().check().is_ok());
            channels(tree, verified.is_ok());
        }
        if let Ok(tree) = &scanned {
            good(tree);
        }
    }
    std::fs::remove_file(&path).expect("the file that was written");
}
