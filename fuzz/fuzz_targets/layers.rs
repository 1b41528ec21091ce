//! Any bytes as a closed mesh that is stored with the planes of its facets.
#![no_main]

#[allow(dead_code)]
#[path = "../bodies/direct.rs"]
mod direct;

libfuzzer_sys::fuzz_target!(|data: &[u8]| direct::layers(data));
