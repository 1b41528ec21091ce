//! Any bytes as tri-dexel models, and as triangles.
#![no_main]

use leafless_testkit::fuzz;

libfuzzer_sys::fuzz_target!(|data: &[u8]| fuzz::dexel_algebra::dexel_algebra(data));
