//! Any bytes as tri-dexel models, and as triangles.
#![no_main]

#[path = "../bodies/dexel_algebra.rs"]
mod dexel_algebra;

libfuzzer_sys::fuzz_target!(|data: &[u8]| dexel_algebra::dexel_algebra(data));
