//! Any bytes as expressions of half-spaces, against exact arithmetic.
#![no_main]

use leafless_testkit::fuzz;

libfuzzer_sys::fuzz_target!(|data: &[u8]| fuzz::csg(data));
