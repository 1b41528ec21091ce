//! Any bytes as a solid. Its contours are closed, and nothing contradicts their proven deviation.
#![no_main]

use leafless_testkit::fuzz;

libfuzzer_sys::fuzz_target!(|data: &[u8]| fuzz::contours(data));
