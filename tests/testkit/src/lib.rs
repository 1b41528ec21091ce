//! What more than one test program uses: slow and simple oracles, random trees and expressions, exact
//! numbers, the bodies of the fuzz targets, and access to the model files.

mod aligned;
pub mod csg;
pub mod cubes;
pub mod dense;
pub mod exact;
pub mod fuzz;
mod models;
mod random;
pub mod slabs;
pub mod surfaces;
pub mod volumes;
mod way;
pub mod zip;

pub use aligned::Aligned;
pub use dense::{
    Classical, Dense, DenseSolid, Shape, TAGS, assert_is, kleene, noise, pairs, pairs_of, positions, shapes,
    shapes_of,
};
pub use models::model;
pub use random::Random;
pub use way::Way;

use leafless::{Control, Frame};
use proptest::prelude::ProptestConfig;
use proptest::test_runner::RngSeed;

/// Returns the frame [0, 2^depth]³ with cells of edge 1, so that lattice coordinates are model coordinates.
pub fn lattice_frame(depth: u8) -> Frame {
    Frame::new([0.0; 3], (1u32 << depth) as f64, depth).unwrap()
}

/// Returns the results of `work` for all items, in order. It runs as many threads as there are processors,
/// for the few tests that take long.
pub fn on_all_processors<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
    let next = AtomicUsize::new(0);
    let threads = std::thread::available_parallelism().map_or(1, |count| count.get());
    let mut found: Vec<(usize, R)> = std::thread::scope(|scope| {
        let worker = || {
            let mut found = Vec::new();
            while let Some((i, item)) =
                Some(next.fetch_add(1, Relaxed)).and_then(|i| Some((i, items.get(i)?)))
            {
                found.push((i, work(item)));
            }
            found
        };
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(worker)).collect();
        workers
            .into_iter()
            .flat_map(|worker| worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
            .collect()
    });
    found.sort_by_key(|&(i, _)| i);
    found.into_iter().map(|(_, result)| result).collect()
}

/// Returns `most` with LEAFLESS_THOROUGH=1 and `few` without: a number of random repetitions, or the size of
/// a long test.
pub fn repeated<T>(few: T, most: T) -> T {
    if std::env::var_os("LEAFLESS_THOROUGH").is_some_and(|value| value == "1") { most } else { few }
}

/// Returns a control with one thread and no limits.
pub fn alone() -> Control<'static> {
    Control::threads(1)
}

/// Returns a configuration with this number of cases, or a fifth of it without LEAFLESS_THOROUGH=1. The cases
/// are the same in every run, unless PROPTEST_RNG_SEED is a number of the caller's choice. Failures print
/// their shrunk input; no file is written beside the sources.
pub fn cases(cases: u32) -> ProptestConfig {
    let mut config = ProptestConfig { failure_persistence: None, ..ProptestConfig::default() };
    config.cases = repeated(cases.div_ceil(5), cases);
    if std::env::var_os("PROPTEST_RNG_SEED").is_none() {
        config.rng_seed = RngSeed::Fixed(0);
    }
    config
}
