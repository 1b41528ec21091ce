//! Any bytes as attributes, honest or not, and their uses, against dense arrays.
#![no_main]

use leafless_testkit::fuzz;

libfuzzer_sys::fuzz_target!(|data: &[u8]| fuzz::attributes(data));
