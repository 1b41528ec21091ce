//! Any bytes as two solids that touch or nearly do. No answer contradicts another one.
#![no_main]

use leafless_testkit::fuzz;

libfuzzer_sys::fuzz_target!(|data: &[u8]| fuzz::contacts(data));
