//! Any bytes as a container and items. Placements are proven, and no verdict contradicts points of the
//! solids.
#![no_main]

#[path = "../bodies/layouts.rs"]
mod layouts;

libfuzzer_sys::fuzz_target!(|data: &[u8]| layouts::layouts(data));
