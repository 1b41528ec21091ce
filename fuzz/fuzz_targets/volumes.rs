//! Any bytes as files of volumes.
#![no_main]

use leafless_testkit::fuzz;

libfuzzer_sys::fuzz_target!(|data: &[u8]| fuzz::volumes::volumes(data));
