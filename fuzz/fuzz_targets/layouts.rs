//! Any bytes as a container and items. Placements are proven, and no verdict contradicts points of the
//! solids.
#![no_main]

use leafless_testkit::fuzz;

libfuzzer_sys::fuzz_target!(|data: &[u8]| fuzz::layouts(data));
