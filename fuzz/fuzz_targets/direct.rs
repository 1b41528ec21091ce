//! Any bytes as a mesh that answers rays, points and distances without cells.
#![no_main]

#[allow(dead_code)]
#[path = "../bodies/direct.rs"]
mod direct;

libfuzzer_sys::fuzz_target!(|data: &[u8]| direct::direct(data));
