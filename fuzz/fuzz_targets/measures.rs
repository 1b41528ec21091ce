//! Any bytes as scenes of unit cells and queries, against integer counts.
#![no_main]

use leafless_testkit::fuzz;

libfuzzer_sys::fuzz_target!(|data: &[u8]| fuzz::measures(data));
