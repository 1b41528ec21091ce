//! Any bytes as a mesh that answers rays, points and distances without cells.
#![no_main]

use leafless_testkit::fuzz;

libfuzzer_sys::fuzz_target!(|data: &[u8]| fuzz::direct(data));
