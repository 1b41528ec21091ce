//! Any bytes as 3MF packages and their parts.
#![no_main]

use leafless_testkit::fuzz;

libfuzzer_sys::fuzz_target!(|data: &[u8]| fuzz::packages::packages(data));
