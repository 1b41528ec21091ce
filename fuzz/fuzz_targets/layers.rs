//! Any bytes as a closed mesh that is stored with the planes of its facets.
#![no_main]

use leafless_testkit::fuzz;

libfuzzer_sys::fuzz_target!(|data: &[u8]| fuzz::layers(data));
