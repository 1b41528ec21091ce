//! Any bytes as a scene.
#![no_main]

use leafless_testkit::fuzz;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    fuzz::scenes::scenes(data);
});
