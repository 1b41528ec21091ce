//! The set algebra of unverified trees.
#![no_main]

use leafless_testkit::fuzz;
use libfuzzer_sys::{fuzz_mutator, fuzz_target, fuzzer_mutate};

fuzz_target!(|data: &[u8]| fuzz::set_algebra(data));

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    fuzz::mutate_pair(data, size, max_size, seed, &mut fuzzer_mutate)
});
